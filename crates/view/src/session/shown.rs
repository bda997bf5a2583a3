//! What is drawn of a body: its surface or its links and balls, the points they stand on, and on demand its inside.

use std::sync::OnceLock;

use souple_mesh::{Mesh, TriangleSurface};
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
    /// Both sides of its triangles are seen.
    pub is_sheet: bool,
    /// Ends among `points`, in the order of the cells; curved ones in straight pieces.
    pub links: Vec<[u32; 2]>,
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
        let TriangleSurface { triangles, mesh_points, .. } = &body.surface;
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
            is_sheet: mesh.dimension() == 2,
            links: Vec::new(),
            outer_cells,
            all_cells: OnceLock::new(),
        };
        let number = shown.numbers(mesh);
        let numbered = |pair: [u32; 2]| pair.map(|point| number[point as usize]);
        shown.edges = mesh.boundary_edges().into_iter().map(numbered).collect();
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

    /// The mean at each point of what the cells about it have; `values` are those of `cells`.
    fn means(&self, values: &[f64]) -> Vec<f32> {
        let mean = |range: &[u32]| {
            let about = &self.of_points[range[0] as usize..range[1] as usize];
            let sum: f64 = about.iter().map(|cell| values[*cell as usize]).sum();
            (sum / about.len().max(1) as f64) as f32
        };
        self.starts.windows(2).map(mean).collect()
    }
}
