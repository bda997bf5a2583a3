//! Whether cells fit each other: what a mesh holds that would tear, overlap or lock in computation.
//!
//! Neighbouring cells of a good mesh share whole faces and lie on opposite sides of them. Cells on the same side of a
//! face overlap: a node was moved through the opposite face, which no order of nodes repairs. Points that coincide
//! (a crack) or lie on a face or edge that does not have them (hanging nodes) let a mesh gape where it looks whole.

use souple_math::Vec3;
use souple_table::in_number;

use crate::sets::Sets;
use crate::{Aabb, AabbTree, Cell, Feature, Mesh, TriangleSurface, closest_point_on_triangle};

/// What [`Mesh::conformity`] found.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Conformity {
    /// Pairs of volume cells that lie on the same side of a common face, lower number first.
    pub overlapping: Vec<[u32; 2]>,
    /// Pairs of cells of a surface that have the same corners, lower number first.
    pub twins: Vec<[u32; 2]>,
    /// Cells of quadrilaterals on whose other side two triangles are, and the cells of those.
    pub split: Vec<(u32, [u32; 2])>,
    /// Points on the boundary that coincide, lower number first.
    pub coincident: Vec<[u32; 2]>,
    /// Points on an edge or a face of the boundary that has them not as corners.
    pub hanging: Vec<HangingPoint>,
    /// Parts of volume cells joined by whole faces that share only points or edges with each other: they turn there freely. How
    /// many more these are than parts that share nothing.
    pub hinged_parts: usize,
    /// Points at which the boundary of volume cells is no manifold: cells there share a point or an edge alone.
    pub pinched: Vec<u32>,
    /// Cells that are nearly flat, with their aspect ratio: flattest first.
    pub slivers: Vec<(u32, f64)>,
}

/// A point that lies on a face without belonging to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HangingPoint {
    pub point: u32,
    /// The cell of that face.
    pub cell: u32,
}

/// Points closer than this part of an edge count as one place: far above the rounding of coordinates in single
/// precision, far below the size of any cell that is meant.
const TOUCHING: f64 = 1e-6;

/// Aspect ratio (1 for the regular cell) beyond which a cell is nearly flat: its part of the stiffness matrix is then
/// worse conditioned by the square of it, and steps grow shorter by it.
const SLIVER: f64 = 1e3;

impl Conformity {
    /// One line for each kind of fault, with how many there are and the place of the first.
    pub fn messages(&self, mesh: &Mesh) -> Vec<String> {
        let mut messages = self.problems(mesh);
        messages.extend(self.hinges());
        if let Some((cell, ratio)) = self.slivers.first() {
            let count = self.slivers.len();
            let cells = in_number(count, "cell has", "cells have");
            messages.push(format!(
                "{cells} nearly no volume, the flattest is cells[{cell}] with an aspect ratio of {ratio:.1e}"
            ));
        }
        messages
    }

    /// Cells that lie on the same side of a common face, or on each other, in words; of the former, the one that was rewound was inverted.
    pub fn overlap(&self, rewound_cells: &[u32]) -> Option<String> {
        if let Some([a, b]) = self.twins.first() {
            let pairs = in_number(self.twins.len(), "such pair", "such pairs");
            return Some(format!("cells[{a}] and cells[{b}] overlap: they have the same corners ({pairs})"));
        }
        let &[a, b] = self.overlapping.first()?;
        let was_inverted = |cell: u32| rewound_cells.binary_search(&cell).is_ok();
        let which = match (was_inverted(a), was_inverted(b)) {
            (true, false) => format!("; cells[{a}] is inverted"),
            (false, true) => format!("; cells[{b}] is inverted"),
            _ => String::new(),
        };
        Some(format!(
            "cells[{a}] and cells[{b}] overlap: both lie on the same side of their common face{which} ({})",
            in_number(self.overlapping.len(), "such pair", "such pairs")
        ))
    }

    /// What hangs on points and edges alone, in words.
    pub fn hinges(&self) -> Option<String> {
        if self.hinged_parts > 0 {
            return Some(format!(
                "{} with the rest, hanging on points or edges and turning there freely; a smaller size of cells may join them",
                in_number(
                    self.hinged_parts,
                    "part of the body shares no face",
                    "parts of the body share no face"
                )
            ));
        }
        let first = self.pinched.first()?;
        Some(format!(
            "the boundary meets itself at {}, the first is points[{first}]: cells there share a point or an edge alone",
            in_number(self.pinched.len(), "point", "points")
        ))
    }

    /// What is wrong between cells, in the same way: without what is wrong with single ones.
    pub fn problems(&self, mesh: &Mesh) -> Vec<String> {
        let at = |point: u32| {
            let x = mesh.points[point as usize];
            format!("({}, {}, {})", x.x, x.y, x.z)
        };
        let mut messages: Vec<String> = self.overlap(&[]).into_iter().collect();
        if let Some((cell, [a, b])) = self.split.first() {
            let faces = in_number(
                self.split.len(),
                "quadrilateral face meets two triangles",
                "quadrilateral faces meet two triangles each",
            );
            messages.push(format!(
                "the mesh is not conforming: {faces}, the first is of \
                 cells[{cell}] against cells[{a}] and cells[{b}]"
            ));
        }
        if let Some([a, b]) = self.coincident.first() {
            let pairs = in_number(
                self.coincident.len(),
                "pair of points coincides and is not joined",
                "pairs of points coincide and are not joined",
            );
            let place = at(*a);
            messages.push(format!(
                "{pairs}, the first is points[{a}] and points[{b}] at \
                 {place}"
            ));
        }
        if let Some(HangingPoint { point, cell }) = self.hanging.first() {
            let points = in_number(
                self.hanging.len(),
                "point hangs on a face that has it not as a corner",
                "points hang on faces that have them not as corners",
            );
            let place = at(*point);
            messages.push(format!(
                "the mesh is not conforming: {points}, the first is \
                 points[{point}] at {place} on a face of cells[{cell}]"
            ));
        }
        messages
    }
}

impl Mesh {
    /// Looks at all faces, at the points of the boundary, and at the shapes of cells. The mesh must have passed
    /// [`Mesh::validate`].
    pub fn conformity(&self) -> Conformity {
        let boundary = self.boundary_surface();
        let (coincident, hanging) = boundary_faults(&boundary);
        let split: Vec<(u32, [u32; 2])> =
            self.faces().split.iter().map(|split| (split.cell, split.triangle_cells)).collect();
        Conformity {
            overlapping: self.overlapping_cells(),
            twins: self.twins(),
            hinged_parts: self.hinged_parts(&split),
            // beside quadrilaterals that meet triangles the boundary has edges of three
            pinched: if self.dimension() == 3 && split.is_empty() {
                boundary.pinched_points().iter().map(|point| boundary.mesh_points[*point as usize]).collect()
            } else {
                Vec::new()
            },
            split,
            coincident,
            hanging,
            slivers: self.slivers(),
        }
    }

    /// How many parts of volume cells hang on the others by points or edges alone; those that meet with two triangles on a
    /// quadrilateral do not.
    fn hinged_parts(&self, split: &[(u32, [u32; 2])]) -> usize {
        if self.dimension() != 3 {
            return 0;
        }
        let mut joined = Sets::new(self.cell_count());
        let mut uses: Vec<([u32; 4], u32)> = Vec::new();
        for (number, cell) in self.cells().enumerate() {
            for face in 0..cell.kind.faces().len() {
                let mut key = around_face(cell, face);
                key.sort_unstable();
                uses.push((key, number as u32));
            }
        }
        uses.sort_unstable();
        let mut parts = self.cell_count();
        let same = uses.windows(2).filter(|pair| pair[0].0 == pair[1].0).map(|pair| [pair[0].1, pair[1].1]);
        let across = split.iter().flat_map(|(cell, others)| others.map(|other| [*cell, other]));
        for [a, b] in same.chain(across) {
            parts -= usize::from(joined.join(a, b));
        }
        parts.saturating_sub(self.components().1)
    }

    /// Cells that go around a common face in the same direction, each pair once.
    fn overlapping_cells(&self) -> Vec<[u32; 2]> {
        // a cell of a surface may go either way round, and its neighbour with it
        if self.dimension() != 3 {
            return Vec::new();
        }
        let mut uses: Vec<([u32; 4], [u32; 4], u32)> = Vec::new();
        for (number, cell) in self.cells().enumerate() {
            for face in 0..cell.kind.faces().len() {
                let around = around_face(cell, face);
                let mut key = around;
                key.sort_unstable();
                uses.push((key, around, number as u32));
            }
        }
        uses.sort_unstable();
        let mut overlapping = Vec::new();
        for same in uses.chunk_by(|a, b| a.0 == b.0) {
            // uses are sorted: those in the same direction stand together
            for pair in same.windows(2).filter(|pair| pair[0].1 == pair[1].1) {
                overlapping.push([pair[0].2, pair[1].2]);
            }
        }
        overlapping.sort_unstable();
        overlapping.dedup();
        overlapping
    }

    /// Cells of a surface with the same corners, each with the next such.
    fn twins(&self) -> Vec<[u32; 2]> {
        if self.dimension() != 2 {
            return Vec::new();
        }
        let corners = |(number, cell): (usize, Cell<'_>)| {
            let mut corners = [u32::MAX; 4];
            let count = cell.kind.corner_count();
            corners[..count].copy_from_slice(&cell.nodes[..count]);
            corners.sort_unstable();
            (corners, number as u32)
        };
        let mut all: Vec<([u32; 4], u32)> = self.cells().enumerate().map(corners).collect();
        all.sort_unstable();
        let mut twins: Vec<[u32; 2]> =
            all.windows(2).filter(|pair| pair[0].0 == pair[1].0).map(|pair| [pair[0].1, pair[1].1]).collect();
        twins.sort_unstable();
        twins
    }

    fn slivers(&self) -> Vec<(u32, f64)> {
        let quality = self.quality();
        let mut slivers: Vec<(u32, f64)> = quality
            .iter()
            .enumerate()
            .filter(|(_, quality)| quality.aspect_ratio > SLIVER)
            .map(|(cell, quality)| (cell as u32, quality.aspect_ratio))
            .collect();
        slivers.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
        slivers
    }
}

/// Corners of a face in its outward order from the lowest on; a triangle's fourth is beyond all points.
fn around_face(cell: Cell<'_>, face: usize) -> [u32; 4] {
    let mut around = [u32::MAX; 4];
    let mut count = 0;
    for node in cell.face_corners(face) {
        around[count] = node;
        count += 1;
    }
    let lowest = (0..count).min_by_key(|corner| around[*corner]).unwrap_or(0);
    around[..count].rotate_left(lowest);
    around
}

/// Points of a boundary that coincide, and those that hang on its triangles; in numbers of the mesh.
fn boundary_faults(surface: &TriangleSurface) -> (Vec<[u32; 2]>, Vec<HangingPoint>) {
    let count = surface.triangles.len() as u32;
    let tolerance = |triangle: u32| {
        let [a, b, c] = surface.corners(triangle);
        let longest_sq = (b - a).length_sq().max((c - b).length_sq()).max((a - c).length_sq());
        TOUCHING * longest_sq.sqrt()
    };
    let boxes: Vec<Aabb> =
        (0..count).map(|triangle| Aabb::of(surface.corners(triangle)).grown(tolerance(triangle))).collect();
    let tree = AabbTree::build(&boxes);
    let (mut coincident, mut hanging) = (Vec::new(), Vec::new());
    for (number, position) in surface.points.iter().enumerate() {
        let number = number as u32;
        let mut hangs_on: Option<u32> = None;
        let mut has_twin = false;
        tree.overlapping(Aabb { low: *position, high: *position }, |triangle| {
            let nodes = surface.triangles[triangle as usize];
            if nodes.contains(&number) {
                return;
            }
            let corners = surface.corners(triangle);
            let (weights, feature) = closest_point_on_triangle(*position, corners);
            let closest: Vec3 = corners.iter().zip(weights).map(|(corner, weight)| *corner * weight).sum();
            // rounding may leave a weight of 1 - 1e-16 on an edge: a corner as near counts first
            let near = tolerance(triangle);
            let twin = (0..3).find(|corner| (corners[*corner] - *position).length() <= near);
            if let Some(corner) = twin {
                has_twin = true;
                let twin = nodes[corner];
                if number < twin {
                    coincident
                        .push([surface.mesh_points[number as usize], surface.mesh_points[twin as usize]]);
                }
            } else if (closest - *position).length() <= near && !matches!(feature, Feature::Corner(_)) {
                let cell = surface.cells[triangle as usize];
                hangs_on = Some(hangs_on.map_or(cell, |lowest: u32| lowest.min(cell)));
            }
        });
        // a point of a crack lies on the faces of its twin too: that is one fault
        if let (Some(cell), false) = (hangs_on, has_twin) {
            hanging.push(HangingPoint { point: surface.mesh_points[number as usize], cell });
        }
    }
    coincident.sort_unstable();
    coincident.dedup();
    (coincident, hanging)
}

#[cfg(test)]
mod tests {
    use souple_table::{Value, Values};

    use super::*;
    use crate::{ElementKind, generate};

    fn cube(element: &'static str) -> Mesh {
        let values = Values::new()
            .with("size", Value::Vector([1.0, 1.0, 1.0]))
            .with("cells", Value::Vector([2.0, 2.0, 2.0]))
            .with("element", Value::Text(element));
        generate("box", values).expect("a cube")
    }

    /// Two meshes side by side, their points not joined.
    fn beside(a: &Mesh, b: &Mesh, offset: Vec3) -> Mesh {
        let mut both = a.clone();
        let first = both.points.len() as u32;
        both.points.extend(b.points.iter().map(|point| *point + offset));
        for cell in b.cells() {
            let nodes: Vec<u32> = cell.nodes.iter().map(|node| node + first).collect();
            both.push_cell(cell.kind, &nodes);
        }
        both.groups.clear();
        both
    }

    /// Generated meshes have no fault, in every kind of element.
    #[test]
    fn generated_meshes_are_conforming() {
        for element in ["tet4", "hex8", "prism6", "pyramid5"] {
            assert_eq!(cube(element).conformity(), Conformity::default(), "{element}");
        }
    }

    /// Two cubes of 3 × 3 points on a common side: nine pairs coincide, and none is told as hanging besides.
    #[test]
    fn cracks_are_found() {
        let cube = cube("hex8");
        let found = beside(&cube, &cube, Vec3::X).conformity();
        assert_eq!((found.coincident.len(), found.hanging.len()), (9, 0), "{found:?}");
    }

    /// A cube of one cell beside one of eight: the five points of the side that are no corners hang.
    #[test]
    fn hanging_points_are_found() {
        let mut coarse = cube("hex8");
        coarse.blocks.clear();
        let corner = |x: f64, y: f64, z: f64| {
            let place = Vec3::new(x, y, z);
            coarse.points.iter().position(|point| *point == place).expect("a corner") as u32
        };
        let nodes = [
            corner(0.0, 0.0, 0.0),
            corner(1.0, 0.0, 0.0),
            corner(1.0, 1.0, 0.0),
            corner(0.0, 1.0, 0.0),
            corner(0.0, 0.0, 1.0),
            corner(1.0, 0.0, 1.0),
            corner(1.0, 1.0, 1.0),
            corner(0.0, 1.0, 1.0),
        ];
        coarse.groups.clear();
        coarse.push_cell(ElementKind::Hex8, &nodes);
        coarse.remove_loose_points();
        let mesh = beside(&coarse, &cube("hex8"), Vec3::X);
        let found = mesh.conformity();
        assert_eq!((found.coincident.len(), found.hanging.len()), (4, 5), "{found:?}");
        assert_eq!(found.messages(&mesh).len(), 2);
    }

    /// Cells of a surface may go round either way, as files have them; the same one twice is told.
    #[test]
    fn twins_are_found() {
        let points = vec![Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::Y];
        for second in [[0, 2, 3], [0, 3, 2]] {
            let mut mesh = Mesh::new(points.clone(), ElementKind::Tri3, vec![0, 1, 2]);
            mesh.push_cell(ElementKind::Tri3, &second);
            assert_eq!(mesh.conformity().overlap(&[]), None);
            mesh.push_cell(ElementKind::Tri3, &[2, 1, 0]);
            let told = mesh.conformity().overlap(&[]).expect("the first triangle is there twice");
            assert!(told.starts_with("cells[0] and cells[2] overlap: they have the same corners"), "{told}");
        }
    }

    /// A node pushed through the opposite face: rewinding makes the volume positive, the overlap stays and is found.
    #[test]
    fn inverted_cells_overlap() {
        let mut mesh = Mesh::new(
            vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z, -Vec3::Z],
            ElementKind::Tet4,
            vec![0, 1, 2, 3, 0, 2, 1, 4],
        );
        assert!(mesh.validate().expect("in order").rewound_cells.is_empty());
        assert!(mesh.conformity().overlapping.is_empty());
        mesh.points[4] = Vec3::new(0.1, 0.1, 0.5);
        assert_eq!(mesh.validate().expect("positive after rewinding").rewound_cells, [1]);
        assert_eq!(mesh.conformity().overlapping, [[0, 1]]);
    }

    /// A tetrahedron squeezed to `h` has an aspect ratio that grows as `1/h`: told from 10³ on.
    #[test]
    fn slivers_are_found() {
        let squeezed = |height: f64| {
            let points = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::new(0.3, 0.3, height)];
            Mesh::new(points, ElementKind::Tet4, vec![0, 1, 2, 3]).conformity().slivers.len()
        };
        assert_eq!((squeezed(0.1), squeezed(1e-4)), (0, 1));
    }
}
