//! Surfaces of meshes: the boundary, the cells one by one, what a cut leaves.

use std::borrow::Cow;
use std::collections::{HashMap, HashSet};
use std::sync::Arc;

use souple_math::Vec3;
use souple_mesh::{Cell, ElementKind, Mesh, creases, facet_triangles, polygon_triangles, vertex_normals};

use super::surface::{Laid, Paint, Surface};
use super::texture::Texture;
use super::tubes::along;

/// A place between two points of a mesh: `x = (1 - share) x_from + share x_to`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Between {
    pub from: u32,
    pub to: u32,
    pub share: f64,
}

impl Between {
    /// A point of the mesh.
    pub fn at(point: u32) -> Self {
        Self { from: point, to: point, share: 0.0 }
    }

    /// The value there, of those at the points of the mesh.
    pub fn of<T: Copy + std::ops::Mul<f64, Output = T> + std::ops::Add<Output = T>>(
        &self,
        values: &[T],
    ) -> T {
        let from = values[self.from as usize];
        // a point of the mesh keeps its bits
        if self.from == self.to {
            from
        } else {
            from * (1.0 - self.share) + values[self.to as usize] * self.share
        }
    }
}

/// A half-space that is cut away.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cut {
    /// A point of the plane [m].
    pub point: Vec3,
    /// Towards what is cut away; of any length.
    pub normal: Vec3,
}

/// A surface made of a mesh, with the points and cells that it came from.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeshSurface {
    pub surface: Surface,
    /// Where on the mesh each point is.
    pub points: Vec<Between>,
    /// Cell (for a mesh without cells: facet) that each triangle bounds.
    pub cells: Vec<u32>,
    /// Points in the middle of two of the mesh, numbered after those of the mesh: within curved cells that a cut opens.
    middles: Vec<[u32; 2]>,
}

impl MeshSurface {
    /// The boundary of a mesh, or its facets if it has no cells; quadrilaterals keep their four edges.
    pub fn of(mesh: &Mesh) -> Self {
        let mut of = Self::default();
        let mut numbers = HashMap::new();
        if mesh.cell_count() == 0 {
            for (facet, view) in mesh.facets().enumerate() {
                of.push_face(mesh, (view.kind, view.nodes), facet as u32, &mut numbers);
            }
            return of;
        }
        if mesh.dimension() < 3 {
            for (cell, view) in mesh.cells().enumerate() {
                of.push_face(mesh, (view.kind, view.nodes), cell as u32, &mut numbers);
            }
            return of;
        }
        let boundary = mesh.faces().boundary;
        let mut faces = boundary.iter().peekable();
        for (cell, view) in mesh.cells().enumerate() {
            while let Some(face) = faces.next_if(|face| face.cell as usize == cell) {
                let (kind, nodes) = view.face_nodes(face.face.into());
                of.push_face(mesh, (kind, &nodes.collect::<Vec<_>>()), face.cell, &mut numbers);
            }
        }
        of
    }

    /// All faces of all cells, each cell with points of its own, to be moved apart by [`MeshSurface::explode`].
    pub fn of_cells(mesh: &Mesh) -> Self {
        Self::of_cells_where(mesh, |_| true)
    }

    /// The same of the cells that a cut leaves whole or more than half of, of a mesh whose points stand at `positions`: what
    /// is taken apart is not sliced.
    pub fn of_cells_left(mesh: &Mesh, positions: &[Vec3], cut: Cut) -> Self {
        let height = |node: &u32| (positions[*node as usize] - cut.point).dot(cut.normal);
        Self::of_cells_where(mesh, |cell| cell.nodes.iter().map(height).sum::<f64>() <= 0.0)
    }

    fn of_cells_where(mesh: &Mesh, keeps: impl Fn(&Cell<'_>) -> bool) -> Self {
        let mut of = Self::default();
        for (cell, view) in mesh.cells().enumerate().filter(|(_, view)| keeps(view)) {
            let mut numbers = HashMap::new();
            if view.kind.dimension() < 3 {
                of.push_face(mesh, (view.kind, view.nodes), cell as u32, &mut numbers);
                continue;
            }
            for face in 0..view.kind.faces().len() {
                let (kind, nodes) = view.face_nodes(face);
                of.push_face(mesh, (kind, &nodes.collect::<Vec<_>>()), cell as u32, &mut numbers);
            }
        }
        of
    }

    /// The boundary of what a cut leaves of a mesh whose points stand at `positions`, the section with it.
    pub fn cut(mesh: &Mesh, positions: &[Vec3], cut: Cut) -> Self {
        let normal = cut.normal.try_normalised().unwrap_or(Vec3::Z);
        let heights: Vec<f64> = positions.iter().map(|x| (*x - cut.point).dot(normal)).collect();
        let whole = Self::of(mesh);
        let mut clipper = Clipper {
            heights,
            positions: positions.to_vec(),
            normal,
            left: Self::default(),
            numbers: HashMap::new(),
        };
        for (triangle, corners) in whole.surface.triangles.iter().enumerate() {
            let corners = corners.map(|corner| whole.points[corner as usize].from);
            clipper.clip(corners, whole.surface.edges[triangle], whole.cells[triangle]);
        }
        for (cell, view) in mesh.cells().enumerate() {
            let is_left = |node: &u32| clipper.is_left(*node);
            if view.nodes.iter().any(is_left) && !view.nodes.iter().all(is_left) {
                clipper.section(&view, cell as u32);
            }
        }
        let mut left = clipper.left;
        left.move_to(positions);
        left
    }

    /// Moves the cells of [`MeshSurface::of_cells`] apart: each away from the middle of all by `amount` times its
    /// distance.
    pub fn explode(&mut self, amount: f64) {
        let all: Vec3 = self.surface.points.iter().copied().sum::<Vec3>()
            * (1.0 / self.surface.points.len().max(1) as f64);
        self.move_cells(|_, middle| (middle - all) * amount);
    }

    /// Shrinks the cells of [`MeshSurface::of_cells`], each about its own middle, by `amount` of its size.
    pub fn shrink(&mut self, amount: f64) {
        self.move_cells(|point, middle| (middle - point) * amount);
    }

    /// Moves every point by what `shift` gives for it and the middle of its cell.
    fn move_cells(&mut self, shift: impl Fn(Vec3, Vec3) -> Vec3) {
        let mut middles: HashMap<u32, (Vec3, f64)> = HashMap::new();
        let mut cell_of = vec![0; self.surface.points.len()];
        for (corners, cell) in self.surface.triangles.iter().zip(&self.cells) {
            corners.iter().for_each(|corner| cell_of[*corner as usize] = *cell);
        }
        for (point, cell) in self.surface.points.iter().zip(&cell_of) {
            let (sum, count) = middles.entry(*cell).or_insert((Vec3::ZERO, 0.0));
            (*sum, *count) = (*sum + *point, *count + 1.0);
        }
        for (point, cell) in self.surface.points.iter_mut().zip(&cell_of) {
            let (sum, count) = middles[cell];
            *point += shift(*point, sum * (1.0 / count));
        }
    }

    /// A face as triangles, its own edges drawn: a straight one around its first corner, a curved one cut at the
    /// middles of its sides.
    fn push_face(
        &mut self,
        mesh: &Mesh,
        (kind, nodes): (ElementKind, &[u32]),
        cell: u32,
        numbers: &mut HashMap<u32, u32>,
    ) {
        if kind.dimension() == 1 {
            // a triangle without area: its drawn edge is all that is seen of it
            for pair in along(nodes).windows(2) {
                self.push(mesh, &[pair[0], pair[1], pair[1]], cell, numbers);
                if let Some(edges) = self.surface.edges.last_mut() {
                    *edges = [true, false, false];
                }
            }
            return;
        }
        if kind.is_linear() {
            self.push(mesh, nodes, cell, numbers);
            return;
        }
        let [corners, middles, _] = kind.by_place(nodes);
        for triangle in facet_triangles(kind, nodes) {
            let first = self.surface.triangles.len();
            self.push(mesh, &triangle, cell, numbers);
            for edges in &mut self.surface.edges[first..] {
                // half a side of the face runs between a corner and the middle of an edge
                *edges = [0, 1, 2].map(|k| {
                    let [a, b] = [triangle[k], triangle[(k + 1) % 3]];
                    let is_half = |a: u32, b: u32| corners.contains(&a) && middles.contains(&b);
                    is_half(a, b) || is_half(b, a)
                });
            }
        }
    }

    /// A polygon as triangles around its corner of the lowest number, as the cells on both sides of it have it; one that no solid is
    /// beside is cut within.
    fn push(&mut self, mesh: &Mesh, nodes: &[u32], cell: u32, numbers: &mut HashMap<u32, u32>) {
        let corners: Vec<u32> = nodes
            .iter()
            .map(|node| {
                *numbers.entry(*node).or_insert_with(|| {
                    self.points.push(Between::at(*node));
                    self.surface.points.push(mesh.points[*node as usize]);
                    self.points.len() as u32 - 1
                })
            })
            .collect();
        let lowest = (0..nodes.len()).min_by_key(|corner| nodes[*corner]).unwrap_or(0);
        let corners: Vec<u32> = (0..corners.len()).map(|k| corners[(lowest + k) % corners.len()]).collect();
        let count = corners.len();
        let is_sheet = mesh.cell_count() == 0 || mesh.dimension() < 3;
        let around = (1..count.saturating_sub(1)).map(|k| [0, k, k + 1]);
        let places: Vec<[usize; 3]> = if is_sheet && count > 3 {
            let own: Vec<u32> = (0..count as u32).collect();
            let position = |place: u32| mesh.points[nodes[(lowest + place as usize) % count] as usize];
            let within = polygon_triangles(&own, position).into_iter();
            within.map(|triangle| triangle.map(|place| place as usize)).collect()
        } else {
            around.collect()
        };
        for places in places {
            let is_side = |k: usize| {
                let (from, to) = (places[k], places[(k + 1) % 3]);
                (from + 1) % count == to || (to + 1) % count == from
            };
            self.surface.triangles.push(places.map(|place| corners[place]));
            self.surface.edges.push([0, 1, 2].map(is_side));
            self.cells.push(cell);
        }
    }

    /// Moves the points to positions of all points of the mesh [m].
    pub fn move_to(&mut self, positions: &[Vec3]) {
        let positions = self.with_middles(positions);
        for (point, source) in self.surface.points.iter_mut().zip(&self.points) {
            *point = source.of(&positions);
        }
    }

    /// Lays a texture on, by where each point of the mesh rests [m].
    pub fn texture(&mut self, texture: &Arc<Texture>, rest: &[Vec3]) {
        let rest = self.with_middles(rest);
        let places: Vec<Vec3> = self.points.iter().map(|point| point.of(&rest)).collect();
        let normals = vertex_normals(&places, &self.surface.triangles);
        self.surface.texture = Some(Laid { texture: Arc::clone(texture), places, normals });
    }

    /// Lays blood over the paint, of a thickness for each point of the mesh [m].
    pub fn cover(&mut self, film: &[f64]) {
        let film = self.with_middles(film);
        self.surface.film = self.points.iter().map(|point| point.of(&film)).collect();
    }

    /// Paints by a value for each point of the mesh.
    pub fn paint_points(&mut self, values: &[f64]) {
        let values = self.with_middles(values);
        self.surface.paint = Paint::PointScalar(self.points.iter().map(|point| point.of(&values)).collect());
    }

    /// Values of the points of the mesh, those of the middles after them.
    fn with_middles<'a, T>(&self, values: &'a [T]) -> Cow<'a, [T]>
    where
        T: Copy + std::ops::Mul<f64, Output = T> + std::ops::Add<Output = T>,
    {
        if self.middles.is_empty() {
            return Cow::Borrowed(values);
        }
        let middle = |[a, b]: &[u32; 2]| Between { from: *a, to: *b, share: 0.5 }.of(values);
        Cow::Owned(values.iter().copied().chain(self.middles.iter().map(middle)).collect())
    }

    /// Draws no edge between triangles that lie in one plane: they are of one face.
    pub fn hide_flat_edges(&mut self) {
        let Surface { points, triangles, edges, .. } = &mut self.surface;
        let seen: HashSet<[u32; 2]> = creases(triangles, points).into_iter().collect();
        edges.resize(triangles.len(), [true; 3]);
        for (corners, marks) in triangles.iter().zip(edges) {
            for (at, mark) in marks.iter_mut().enumerate() {
                let (from, to) = (corners[at], corners[(at + 1) % 3]);
                *mark &= seen.contains(&[from.min(to), from.max(to)]);
            }
        }
    }

    /// Paints by a value for each cell of the mesh.
    pub fn paint_cells(&mut self, values: &[f64]) {
        self.surface.paint =
            Paint::TriangleScalar(self.cells.iter().map(|cell| values[*cell as usize]).collect());
    }
}

/// Makes what lies at or below height zero.
struct Clipper {
    /// Of each point of the mesh, and each middle, over the plane [m].
    heights: Vec<f64>,
    /// [m]
    positions: Vec<Vec3>,
    /// Of the plane.
    normal: Vec3,
    left: MeshSurface,
    /// Points made so far, by the two points of the mesh they lie between.
    numbers: HashMap<[u32; 2], u32>,
}

impl Clipper {
    fn is_left(&self, point: u32) -> bool {
        self.heights[point as usize] <= 0.0
    }

    /// A point of the mesh, or where the edge between two of them meets the plane.
    fn point(&mut self, from: u32, to: u32) -> u32 {
        let key = [from.min(to), from.max(to)];
        *self.numbers.entry(key).or_insert_with(|| {
            let [from, to] = key;
            let (a, b) = (self.heights[from as usize], self.heights[to as usize]);
            let share = if from == to { 0.0 } else { a / (a - b) };
            self.left.points.push(Between { from, to, share });
            // positions follow by `move_to`
            self.left.surface.points.push(Vec3::ZERO);
            self.left.points.len() as u32 - 1
        })
    }

    /// What of a triangle lies below, its edges kept and none drawn along the plane.
    fn clip(&mut self, corners: [u32; 3], edges: [bool; 3], cell: u32) {
        let (mut polygon, mut drawn) = (Vec::with_capacity(4), Vec::with_capacity(4));
        for k in 0..3 {
            let (a, b) = (corners[k], corners[(k + 1) % 3]);
            match (self.is_left(a), self.is_left(b)) {
                (true, true) => {
                    polygon.push(self.point(a, a));
                    drawn.push(edges[k]);
                }
                (true, false) => {
                    polygon.extend([self.point(a, a), self.point(a, b)]);
                    drawn.extend([edges[k], true]);
                }
                (false, true) => {
                    polygon.push(self.point(a, b));
                    drawn.push(edges[k]);
                }
                (false, false) => {}
            }
        }
        self.push(&polygon, &drawn, cell);
    }

    /// The section of a cell, as those of the tetrahedra between a point of it and the triangles of its faces, which are those of the
    /// boundary: of a cell with straight edges its corner of the lowest number, of a curved one a point within.
    fn section(&mut self, cell: &Cell<'_>, number: u32) {
        if cell.kind.dimension() != 3 {
            return;
        }
        let faces: Vec<(ElementKind, Vec<u32>)> = (0..cell.kind.faces().len())
            .map(|face| cell.face_nodes(face))
            .map(|(kind, nodes)| (kind, nodes.collect()))
            .collect();
        let apex = if cell.kind.is_linear() {
            cell.nodes.iter().copied().min()
        } else {
            self.point_within(cell, &faces)
        };
        let Some(apex) = apex else { return };
        for (kind, nodes) in faces.iter().filter(|(_, nodes)| !nodes.contains(&apex)) {
            for [a, b, c] in facet_triangles(*kind, nodes) {
                self.section_tetrahedron([apex, a, b, c], &faces, number);
            }
        }
    }

    /// The middle of two nodes that lie on no common face, which is within the cell: of all such the nearest to its own middle.
    fn point_within(&mut self, cell: &Cell<'_>, faces: &[(ElementKind, Vec<u32>)]) -> Option<u32> {
        let is_through = |a: u32, b: u32| {
            a != b && !faces.iter().any(|(_, nodes)| nodes.contains(&a) && nodes.contains(&b))
        };
        let at = |node: u32| self.positions[node as usize];
        let own: Vec3 = cell.nodes.iter().map(|node| at(*node)).sum::<Vec3>() / cell.nodes.len() as f64;
        let off = |[a, b]: &[u32; 2]| ((at(*a) + at(*b)) * 0.5 - own).length_sq();
        let pairs = cell.nodes.iter().flat_map(|a| cell.nodes.iter().map(|b| [*a, *b]));
        let through = pairs.filter(|[a, b]| is_through(*a, *b));
        let [a, b] = through.min_by(|p, q| off(p).total_cmp(&off(q)))?;
        let [from, to] = [a as usize, b as usize];
        self.left.middles.push([a, b]);
        self.heights.push(0.5 * (self.heights[from] + self.heights[to]));
        self.positions.push((self.positions[from] + self.positions[to]) * 0.5);
        Some(self.positions.len() as u32 - 1)
    }

    /// The section of a part of a cell, the edges drawn that lie in `faces` of the cell.
    fn section_tetrahedron(&mut self, nodes: [u32; 4], faces: &[(ElementKind, Vec<u32>)], cell: u32) {
        let (below, above): (Vec<u32>, Vec<u32>) = nodes.iter().partition(|node| self.is_left(**node));
        // around: from each point below to each above, so that neighbours share a point of the tetrahedron
        let mut around: Vec<[u32; 2]> = match (below.as_slice(), above.as_slice()) {
            ([a], [x, y, z]) => vec![[*a, *x], [*a, *y], [*a, *z]],
            ([a, b, c], [x]) => vec![[*a, *x], [*b, *x], [*c, *x]],
            ([a, b], [x, y]) => vec![[*a, *x], [*b, *x], [*b, *y], [*a, *y]],
            _ => return,
        };
        let mut polygon: Vec<u32> = around.iter().map(|[from, to]| self.point(*from, *to)).collect();
        let corners: Vec<Vec3> =
            polygon.iter().map(|point| self.left.points[*point as usize].of(&self.positions)).collect();
        // outward is towards what was cut away; by both halves, of which one may have no area
        let turn = |k: usize| (corners[k] - corners[0]).cross(corners[k + 1] - corners[0]).dot(self.normal);
        if (1..corners.len() - 1).map(turn).sum::<f64>() < 0.0 {
            polygon.reverse();
            around.reverse();
        }
        let count = around.len();
        let is_of_cell = |k: usize| {
            let ends = [around[k], around[(k + 1) % count]];
            faces.iter().any(|(_, face)| ends.as_flattened().iter().all(|node| face.contains(node)))
        };
        let drawn: Vec<bool> = (0..count).map(is_of_cell).collect();
        self.push(&polygon, &drawn, cell);
    }

    /// A convex polygon as triangles around its first corner; `drawn`: its edges from each corner to the next.
    fn push(&mut self, polygon: &[u32], drawn: &[bool], cell: u32) {
        for k in 1..polygon.len().saturating_sub(1) {
            let last = k + 2 == polygon.len();
            self.left.surface.triangles.push([polygon[0], polygon[k], polygon[k + 1]]);
            self.left.surface.edges.push([k == 1 && drawn[0], drawn[k], last && drawn[k + 1]]);
            self.left.cells.push(cell);
        }
    }
}
