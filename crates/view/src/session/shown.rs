//! What is drawn of a body: its surface or its links and balls, the points they stand on, and on demand its inside.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::sync::OnceLock;

use souple_mesh::{Mesh, OpeningSurface, Span, TriangleSurface};
use souple_scene::BodyInfo;

/// A body as pages see it.
pub struct Shown {
    /// Points of the mesh as pages count them: those on its surface, or all of a body without one, then the others; without balls
    /// that stand for ground and walls.
    pub points: Vec<u32>,
    /// How many of them are drawn while nobody looks inside.
    pub outer_count: usize,
    /// Corners among `points`.
    pub triangles: Vec<[u32; 3]>,
    /// Those of its elements on the surface, ends among `points`.
    pub edges: Vec<[u32; 2]>,
    /// When each of these is there; none where all stay.
    pub edge_spans: Vec<Span>,
    /// Both sides of its triangles are seen.
    pub is_sheet: bool,
    /// Ends among `points`, in the order of the cells; curved ones in straight pieces.
    pub links: Vec<[u32; 2]>,
    /// When each point of the mesh is of no cell any more [s]; empty where none ever is.
    loose_at: Vec<f64>,
    outer_cells: CellsAbout,
    all_cells: OnceLock<CellsAbout>,
}

/// The cells of a body, for cuts and for taking it apart.
pub struct Inside {
    /// Corners among [`Shown::points`] and the cell.
    pub tetrahedra: Vec<([u32; 4], u32)>,
    /// Faces of each cell.
    pub triangles: Vec<([u32; 3], u32)>,
}

impl Shown {
    pub fn new(body: &BodyInfo) -> Self {
        let mesh = &body.mesh;
        let TriangleSurface { triangles, mesh_points, .. } = &body.surface.surface;
        let mut points = mesh_points.clone();
        let mut is_listed = vec![false; mesh.points.len()];
        points.iter().for_each(|point| is_listed[*point as usize] = true);
        points.extend((0..mesh.points.len() as u32).filter(|point| !is_listed[*point as usize]));
        let grounds = souple_scene::grounds(mesh, &body.radii);
        points.retain(|point| grounds.get(*point as usize) != Some(&true));
        let outer_count = if has_inside(mesh) { mesh_points.len() } else { points.len() };
        let outer_cells = CellsAbout::new(mesh, &points[..outer_count]);
        let mut shown = Self {
            points,
            outer_count,
            triangles: triangles.clone(),
            edges: Vec::new(),
            edge_spans: Vec::new(),
            is_sheet: mesh.dimension() == 2,
            links: Vec::new(),
            loose_at: loose_at(body),
            outer_cells,
            all_cells: OnceLock::new(),
        };
        let number = shown.numbers(mesh);
        let numbered = |pair: [u32; 2]| pair.map(|point| number[point as usize]);
        if body.surface.opens() {
            (shown.edges, shown.edge_spans) = opening_edges(&body.surface);
        } else {
            shown.edges = mesh.boundary_edges().into_iter().map(numbered).collect();
        }
        if let Some(faces) = &body.faces {
            let of_points = faces.triangles.iter().map(|corners| corners.map(|point| number[point as usize]));
            shown.triangles = of_points.collect();
            shown.edges =
                souple_mesh::creases(&faces.triangles, &mesh.points).into_iter().map(numbered).collect();
            // they need not close
            shown.is_sheet = true;
        }
        if mesh.dimension() == 1 {
            // corners stand first, what is between them after
            let along = |nodes: &[u32]| [&nodes[..1], &nodes[2..], &nodes[1..2]].concat();
            let links = |nodes: &[u32]| {
                along(nodes).windows(2).map(|pair| numbered([pair[0], pair[1]])).collect::<Vec<_>>()
            };
            shown.links = mesh.cells().flat_map(|cell| links(cell.nodes)).collect();
        }
        shown
    }

    /// How many points are drawn.
    pub fn count(&self, with_inside: bool) -> usize {
        if with_inside { self.points.len() } else { self.outer_count }
    }

    /// The points that are drawn at a time [s], of the mesh. What is of no cell any more and falls alone is not seen, and must not be
    /// what a picture makes room for and colours reach to: another stands for it, of those that are of one the longest.
    pub fn points_at(&self, time: f64, with_inside: bool) -> Cow<'_, [u32]> {
        let points = &self.points[..self.count(with_inside)];
        let is_loose = |point: u32| self.loose_at.get(point as usize).is_some_and(|date| *date <= time);
        if !points.iter().any(|point| is_loose(*point)) {
            return Cow::Borrowed(points);
        }
        let date = |point: &u32| self.loose_at[*point as usize];
        let longest = points.iter().copied().max_by(|a, b| date(a).total_cmp(&date(b)));
        let seen = |point: &u32| longest.filter(|_| is_loose(*point)).unwrap_or(*point);
        Cow::Owned(points.iter().map(seen).collect())
    }

    pub fn cells_about(&self, body: &BodyInfo, with_inside: bool) -> &CellsAbout {
        if !with_inside {
            return &self.outer_cells;
        }
        self.all_cells.get_or_init(|| CellsAbout::new(&body.mesh, &self.points))
    }

    /// The mean at each point that is drawn of what the cells about it have; `values` are those of [`Shown::cells_about`].
    pub fn means(&self, values: &[f64], with_inside: bool) -> Vec<f32> {
        let about = if with_inside { self.all_cells.get() } else { Some(&self.outer_cells) };
        // who has values has asked for the cells
        about.map_or_else(Vec::new, |about| about.means(values))
    }

    /// The number that each point of the mesh has among `points`.
    fn numbers(&self, mesh: &Mesh) -> Vec<u32> {
        let mut numbers = vec![0; mesh.points.len()];
        for (number, point) in self.points.iter().enumerate() {
            numbers[*point as usize] = number as u32;
        }
        numbers
    }

    /// `None` of what has no inside. Curved cells count by their corners.
    pub fn inside(&self, mesh: &Mesh) -> Option<Inside> {
        if !has_inside(mesh) {
            return None;
        }
        let number = self.numbers(mesh);
        let mut inside = Inside { tetrahedra: Vec::new(), triangles: Vec::new() };
        for (cell, view) in mesh.cells().enumerate().filter(|(_, view)| view.kind.dimension() == 3) {
            let apex = view.nodes[0];
            for face in 0..view.kind.faces().len() {
                let corners: Vec<u32> = view.face_corners(face).collect();
                let numbered = |corner: usize| number[corners[corner] as usize];
                for k in 1..corners.len() - 1 {
                    let triangle = [numbered(0), numbered(k), numbered(k + 1)];
                    inside.triangles.push((triangle, cell as u32));
                    if !corners.contains(&apex) {
                        let [a, b, c] = triangle;
                        inside.tetrahedra.push(([number[apex as usize], a, b, c], cell as u32));
                    }
                }
            }
        }
        Some(inside)
    }
}

/// When each point of a body is of no cell any more [s], infinite where that is never; empty where no cell goes.
fn loose_at(body: &BodyInfo) -> Vec<f64> {
    if body.cut_at.is_empty() {
        return Vec::new();
    }
    let mut dates = vec![f64::NEG_INFINITY; body.mesh.points.len()];
    for (cell, date) in body.mesh.cells().zip(&body.cut_at) {
        cell.nodes.iter().for_each(|node| dates[*node as usize] = dates[*node as usize].max(*date));
    }
    dates
}

/// The sides of the triangles of a surface that opens, each from when the first of its triangles is there until the last is gone.
fn opening_edges(surface: &OpeningSurface) -> (Vec<[u32; 2]>, Vec<Span>) {
    let mut edges: BTreeMap<[u32; 2], Span> = BTreeMap::new();
    for (corners, span) in surface.surface.triangles.iter().zip(&surface.spans) {
        for k in 0..3 {
            let (a, b) = (corners[k], corners[(k + 1) % 3]);
            let known = edges.entry([a.min(b), a.max(b)]).or_insert(*span);
            *known = Span { from: known.from.min(span.from), until: known.until.max(span.until) };
        }
    }
    edges.into_iter().unzip()
}

/// Whether there are cells with a volume; edges, sheets and loose masses are all outside.
pub fn has_inside(mesh: &Mesh) -> bool {
    mesh.dimension() == 3 && mesh.cell_count() > 0
}

/// The cells about each of some points of a mesh.
pub struct CellsAbout {
    /// Each once.
    pub cells: Vec<u32>,
    /// Where those of each point begin in `of_points`, and the end of the last.
    starts: Vec<u32>,
    /// Places in `cells`.
    of_points: Vec<u32>,
}

impl CellsAbout {
    fn new(mesh: &Mesh, points: &[u32]) -> Self {
        let mut number = vec![u32::MAX; mesh.points.len()];
        for (index, point) in points.iter().enumerate() {
            number[*point as usize] = index as u32;
        }
        let mut cells = Vec::new();
        let mut pairs = Vec::new();
        for (cell, view) in mesh.cells().enumerate() {
            let listed = view.nodes.iter().map(|node| number[*node as usize]);
            let before = pairs.len();
            pairs.extend(listed.filter(|point| *point != u32::MAX).map(|point| (point, cells.len() as u32)));
            if pairs.len() > before {
                cells.push(cell as u32);
            }
        }
        pairs.sort_unstable();
        let mut starts = vec![0; points.len() + 1];
        pairs.iter().for_each(|(point, _)| starts[*point as usize + 1] += 1);
        for point in 1..starts.len() {
            starts[point] += starts[point - 1];
        }
        Self { cells, starts, of_points: pairs.into_iter().map(|(_, cell)| cell).collect() }
    }

    /// The mean at each point of what the cells about it have; `values` are those of `cells`, not a number where they have none.
    fn means(&self, values: &[f64]) -> Vec<f32> {
        let mean = |range: &[u32]| {
            let about = &self.of_points[range[0] as usize..range[1] as usize];
            let of_cells = about.iter().map(|cell| values[*cell as usize]).filter(|value| !value.is_nan());
            let (sum, count) = of_cells.fold((0.0, 0_u32), |(sum, count), value| (sum + value, count + 1));
            (sum / f64::from(count.max(1))) as f32
        };
        self.starts.windows(2).map(mean).collect()
    }
}
