//! Faces between cells: the boundary, and whether the mesh is conforming.
//!
//! A face of two cells is inside, a face of one is on the boundary. A face of three or more, or a quadrilateral
//! that meets two triangles, is a fault: fields would tear or overlap there.

use souple_math::Vec3;

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

/// Points of a face ascending, padded.
type Key = [u32; 4];
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
                    let nodes = many[0].key.iter().copied().filter(|node| *node != NO_POINT).collect();
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

    /// Points of a face in order, normal outward; none for a cell that is not in the mesh.
    fn face_corners(&self, cell: u32, face: u8) -> Vec<u32> {
        self.cell(cell).map_or_else(Vec::new, |cell| cell.face_nodes(face.into()).1.collect())
    }

    /// The boundary as triangles, oriented outward; quadrilaterals are cut at the corner of lowest number.
    pub fn boundary_surface(&self) -> TriangleSurface {
        let mut triangles = Vec::new();
        let mut cells = Vec::new();
        for BoundaryFace { cell, face } in self.faces().boundary {
            let corners = self.face_corners(cell, face);
            for triangle in cut(&corners) {
                triangles.push(triangle);
                cells.push(cell);
            }
        }
        TriangleSurface::from_mesh(&self.points, &triangles, cells)
    }

    /// Facets read from a file as triangles, for meshes that are surfaces only. `None` if there are no facets.
    pub fn facet_surface(&self) -> Option<TriangleSurface> {
        let mut triangles = Vec::new();
        let mut facets = Vec::new();
        for (facet, view) in self.facets().enumerate() {
            for triangle in cut(view.nodes) {
                triangles.push(triangle);
                facets.push(facet as u32);
            }
        }
        (!triangles.is_empty()).then(|| TriangleSurface::from_mesh(&self.points, &triangles, facets))
    }
}

/// `∫ N_a dA` over a triangle or a bilinear quadrilateral for each of its corners [m²]; they add up to its area.
pub fn face_node_areas(corners: &[Vec3]) -> Vec<f64> {
    let kind = if corners.len() == 3 { ElementKind::Tri3 } else { ElementKind::Quad4 };
    let mut areas = vec![0.0; corners.len()];
    // exact where the face is flat; the area of a warped one is no polynomial
    let rule = kind.rule_of_degree(3).unwrap_or_else(|| kind.default_rule());
    for point in &rule.points {
        let (shape, gradients) = (kind.shape(point.position), kind.shape_gradients(point.position));
        let tangent =
            |axis: usize| -> Vec3 { corners.iter().zip(&*gradients).map(|(x, g)| *x * g[axis]).sum() };
        let area = tangent(0).cross(tangent(1)).length() * point.weight;
        areas.iter_mut().zip(&*shape).for_each(|(total, share)| *total += area * share);
    }
    areas
}

/// A polygon as triangles around its corner of lowest number.
fn cut(corners: &[u32]) -> impl Iterator<Item = [u32; 3]> + '_ {
    let n = corners.len();
    let first = (0..n).min_by_key(|corner| corners[*corner]).unwrap_or(0);
    (1..n.saturating_sub(1))
        .map(move |k| [corners[first], corners[(first + k) % n], corners[(first + k + 1) % n]])
}

fn face_key(cell: Cell<'_>, face: usize) -> Key {
    let (_, nodes) = cell.face_nodes(face);
    let mut key = [NO_POINT; 4];
    for (slot, node) in key.iter_mut().zip(nodes) {
        *slot = node;
    }
    key.sort_unstable();
    key
}

/// Quadrilaterals of the boundary whose halves, along either diagonal, are triangles of the boundary.
fn split_quadrilaterals(mesh: &Mesh, single: &[&FaceUse]) -> Vec<SplitQuadrilateral> {
    let find = |mut triangle: [u32; 3]| {
        triangle.sort_unstable();
        let key = [triangle[0], triangle[1], triangle[2], NO_POINT];
        single.binary_search_by_key(&key, |face| face.key).ok().map(|at| single[at].cell)
    };
    let mut split = Vec::new();
    for quadrilateral in single.iter().filter(|face| face.key[3] != NO_POINT) {
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
