//! Faces between cells: the boundary, and whether the mesh is conforming.
//!
//! A face of two cells is inside, a face of one is on the boundary. A face of three or more, or a quadrilateral
//! that meets two triangles, is a fault: fields would tear or overlap there.

use souple_math::Vec3;

use crate::polygon::{fan, polygon_triangles};
use crate::{Cell, ElementKind, Mesh, MeshError, TriangleSurface};

/// A face that belongs to one cell only.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BoundaryFace {
    pub cell: u32,
    /// Number of the face in its element.
    pub face: u8,
}

/// A quadrilateral on whose other side two triangles are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SplitQuadrilateral {
    pub cell: u32,
    pub triangle_cells: [u32; 2],
}

/// All faces of a mesh, sorted by their role.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FaceReport {
    /// In the order of cells, then of the faces of their elements.
    pub boundary: Vec<BoundaryFace>,
    /// Cells that share a face, lower number first.
    pub neighbours: Vec<[u32; 2]>,
    /// Faces of three cells or more: the cells, and the points ascending.
    pub overused: Vec<(Vec<u32>, Vec<u32>)>,
    pub split: Vec<SplitQuadrilateral>,
}

/// Corners of a face ascending, padded, and its kind: faces of the same corners and of another order do not fit, for
/// the middle nodes of one have nothing to follow on the other.
type Key = ([u32; 4], ElementKind);
const NO_POINT: u32 = u32::MAX;

struct FaceUse {
    key: Key,
    cell: u32,
    face: u8,
}

impl FaceReport {
    /// # Errors
    /// The first fault of conformity, naming the cells.
    pub fn conforming(&self) -> Result<(), MeshError> {
        if let Some((cells, nodes)) = self.overused.first() {
            return Err(MeshError::FaceUsedTooOften { cells: cells.clone(), nodes: nodes.clone() });
        }
        match self.split.first() {
            Some(&SplitQuadrilateral { cell, triangle_cells }) => {
                Err(MeshError::QuadrilateralMeetsTriangles { cell, triangle_cells })
            }
            None => Ok(()),
        }
    }
}

impl Mesh {
    /// Sorts the faces of all cells into boundary, inside and faults.
    pub fn faces(&self) -> FaceReport {
        let mut uses = self.face_uses();
        uses.sort_unstable_by_key(|face| (face.key, face.cell, face.face));
        let mut report = FaceReport::default();
        let mut single: Vec<&FaceUse> = Vec::new();
        for same in uses.chunk_by(|a, b| a.key == b.key) {
            match same {
                [one] => single.push(one),
                [a, b] => report.neighbours.push([a.cell, b.cell]),
                many => {
                    let nodes = many[0].key.0.iter().copied().filter(|node| *node != NO_POINT).collect();
                    report.overused.push((many.iter().map(|face| face.cell).collect(), nodes));
                }
            }
        }
        report.neighbours.sort_unstable();
        report.split = split_quadrilaterals(self, &single);
        report.boundary =
            single.iter().map(|face| BoundaryFace { cell: face.cell, face: face.face }).collect();
        report.boundary.sort_unstable_by_key(|face| (face.cell, face.face));
        report
    }

    fn face_uses(&self) -> Vec<FaceUse> {
        let mut uses = Vec::new();
        for (cell, view) in self.cells().enumerate() {
            for face in 0..view.kind.faces().len() {
                uses.push(FaceUse { key: face_key(view, face), cell: cell as u32, face: face as u8 });
            }
        }
        uses
    }

    /// Corners of a face in order, normal outward; none for a cell that is not in the mesh.
    fn face_corners(&self, cell: u32, face: u8) -> Vec<u32> {
        self.cell(cell).map_or_else(Vec::new, |cell| cell.face_corners(face.into()).collect())
    }

    /// The boundary as triangles, oriented outward; of a mesh of surface cells, these cells; of edges, nothing.
    /// Quadrilaterals are cut at the corner of lowest number, curved faces at the middles of their sides.
    pub fn boundary_surface(&self) -> TriangleSurface {
        let mut triangles = Vec::new();
        let mut cells = Vec::new();
        self.visit_boundary_triangles(&mut |cell, corners| {
            cells.extend(corners.iter().map(|_| cell));
            triangles.extend(corners);
        });
        TriangleSurface::from_mesh(&self.points, &triangles, cells)
    }

    /// Visits the triangles of each face of the boundary, or of each surface cell.
    pub(crate) fn visit_boundary_triangles(&self, visit: &mut dyn FnMut(u32, Vec<[u32; 3]>)) {
        self.visit_boundary(&mut |cell, kind, nodes| visit(cell, facet_triangles(kind, nodes)));
    }

    /// Visits the triangles of each face between two cells, the lower number first, which they face away from.
    pub(crate) fn visit_inner_triangles(&self, visit: &mut dyn FnMut([u32; 2], Vec<[u32; 3]>)) {
        let mut uses = self.face_uses();
        uses.sort_unstable_by_key(|face| (face.key, face.cell, face.face));
        let by_number = self.cells_by_number();
        for same in uses.chunk_by(|a, b| a.key == b.key) {
            let [first, second] = same else { continue };
            let Some(view) = by_number.get(first.cell) else { continue };
            let (kind, nodes) = view.face_nodes(first.face.into());
            visit([first.cell, second.cell], facet_triangles(kind, &nodes.collect::<Vec<_>>()));
        }
    }

    /// The edges of the elements on the boundary, or of surface cells, each once, as pairs of points: those of
    /// [`Mesh::boundary_surface`] without what cuts faces into triangles. Curved edges are two pieces.
    pub fn boundary_edges(&self) -> Vec<[u32; 2]> {
        let mut edges = Vec::new();
        self.visit_boundary(&mut |_, kind, nodes| {
            let [corners, middles, _] = kind.by_place(nodes);
            let n = corners.len();
            for k in 0..n {
                let ends = [corners[k], corners[(k + 1) % n]];
                match middles.get(k) {
                    Some(middle) => edges.extend([[ends[0], *middle], [*middle, ends[1]]]),
                    None => edges.push(ends),
                }
            }
        });
        edges.iter_mut().for_each(|edge| edge.sort_unstable());
        edges.sort_unstable();
        edges.dedup();
        edges
    }

    /// Visits the faces of the boundary, or the surface cells: the cell, the kind and the nodes.
    fn visit_boundary(&self, visit: &mut dyn FnMut(u32, ElementKind, &[u32])) {
        if self.dimension() == 2 {
            self.cells().enumerate().for_each(|(cell, view)| visit(cell as u32, view.kind, view.nodes));
            return;
        }
        let by_number = self.cells_by_number();
        for BoundaryFace { cell, face } in self.faces().boundary {
            let Some(view) = by_number.get(cell) else { continue };
            let (kind, nodes) = view.face_nodes(face.into());
            visit(cell, kind, &nodes.collect::<Vec<_>>());
        }
    }

    /// Facets read from a file as triangles, for meshes that are surfaces only: quadrilaterals are cut within. `None` if there are
    /// no facets.
    pub fn facet_surface(&self) -> Option<TriangleSurface> {
        let mut triangles = Vec::new();
        let mut facets = Vec::new();
        for (facet, view) in self.facets().enumerate() {
            let cut = if view.kind.is_linear() {
                polygon_triangles(view.nodes, |node| self.points[node as usize])
            } else {
                facet_triangles(view.kind, view.nodes)
            };
            for triangle in cut {
                triangles.push(triangle);
                facets.push(facet as u32);
            }
        }
        (!triangles.is_empty()).then(|| TriangleSurface::from_mesh(&self.points, &triangles, facets))
    }
}

/// `∫ N_a dA` over a face for each of its nodes [m²], over a side [m], over a cell [m³]; they add up to its measure.
/// Negative shares are right: a traction on a face of eight nodes pulls its corners back.
pub fn node_measures(kind: ElementKind, nodes: &[Vec3]) -> Vec<f64> {
    let mut measures = vec![0.0; nodes.len()];
    // exact where the face is flat and straight; the area of a warped one is no polynomial
    let rule = if kind.is_linear() {
        kind.rule_of_degree(3).unwrap_or_else(|| kind.default_rule())
    } else {
        kind.mass_rule()
    };
    for point in &rule.points {
        let measure = kind.jacobian(nodes, point.position).determinant() * point.weight;
        let shape = kind.shape(point.position);
        measures.iter_mut().zip(&*shape).for_each(|(total, share)| *total += measure * share);
    }
    measures
}

/// A face as triangles: a triangle or quadrilateral around its corner of lowest number; of a curved one, the corners
/// cut off at the middles of the sides, and what is left between those; one with a node in its middle around that.
pub fn facet_triangles(kind: ElementKind, nodes: &[u32]) -> Vec<[u32; 3]> {
    let [corners, middles, inside] = kind.by_place(nodes);
    if kind.dimension() != 2 {
        return Vec::new();
    }
    if middles.is_empty() {
        return around_lowest(corners).collect();
    }
    let n = corners.len();
    if let [centre] = *inside {
        let halves = (0..n).flat_map(|k| [[corners[k], middles[k]], [middles[k], corners[(k + 1) % n]]]);
        return halves.map(|[from, to]| [centre, from, to]).collect();
    }
    let cut_off = (0..n).map(|k| [middles[(k + n - 1) % n], corners[k], middles[k]]);
    cut_off.chain(around_lowest(middles)).collect()
}

/// A face as triangles around its corner of lowest number, as the cells on both sides of it have it.
fn around_lowest(corners: &[u32]) -> impl Iterator<Item = [u32; 3]> + '_ {
    fan(corners).map(|places| places.map(|place| corners[place]))
}

fn face_key(cell: Cell<'_>, face: usize) -> Key {
    let mut key = [NO_POINT; 4];
    for (slot, node) in key.iter_mut().zip(cell.face_corners(face)) {
        *slot = node;
    }
    key.sort_unstable();
    (key, cell.kind.faces()[face].kind)
}

/// Quadrilaterals of the boundary whose halves, along either diagonal, are triangles of the boundary.
fn split_quadrilaterals(mesh: &Mesh, single: &[&FaceUse]) -> Vec<SplitQuadrilateral> {
    let find = |mut triangle: [u32; 3]| {
        triangle.sort_unstable();
        let key = [triangle[0], triangle[1], triangle[2], NO_POINT];
        single.binary_search_by_key(&key, |face| face.key.0).ok().map(|at| single[at].cell)
    };
    let mut split = Vec::new();
    for quadrilateral in single.iter().filter(|face| face.key.0[3] != NO_POINT) {
        let corners = mesh.face_corners(quadrilateral.cell, quadrilateral.face);
        let [a, b, c, d] = [corners[0], corners[1], corners[2], corners[3]];
        let halves = [[[a, b, c], [a, c, d]], [[a, b, d], [b, c, d]]];
        for [one, other] in halves {
            if let (Some(one), Some(other)) = (find(one), find(other)) {
                split.push(SplitQuadrilateral { cell: quadrilateral.cell, triangle_cells: [one, other] });
            }
        }
    }
    split.sort_unstable_by_key(|fault| fault.cell);
    split
}
