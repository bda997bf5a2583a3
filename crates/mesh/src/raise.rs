//! Linear meshes raised to those with nodes between the corners.

use std::collections::BTreeMap;

use souple_math::Vec3;

use crate::{CellBlock, ElementKind, Mesh, NodePlace};

impl Mesh {
    /// The mesh of cells with the same corners and nodes in the middles of edges, and of faces and cells up to `most`, where there is
    /// such an element ([`ElementKind::with_middles`]). Points are shared by all cells and facets around them, and follow those there
    /// were: middles of edges in the order of their ends, then of faces, then of cells. A point joins the groups that hold all corners of
    /// the part it is the middle of. Cells that are not linear keep their nodes. Beyond edges, cells that share a face fit where all of them
    /// have elements with a node in it, as in meshes of one kind.
    ///
    /// Edges are straight; `place` gives a middle from its edge's ends, for those who know the curve. Middles of faces and cells lie where
    /// the curves around them put them: where the element with nodes on edges alone has its middle.
    pub fn raised(&self, most: NodePlace, place: impl Fn([Vec3; 2]) -> Vec3) -> Self {
        let linear = || self.blocks.iter().chain(&self.facet_blocks).filter(|block| block.kind.is_linear());
        let mut parts: Vec<Part> = Vec::new();
        for block in linear() {
            let kind = block.kind.with_middles(most);
            parts.extend(block.cells().flat_map(|nodes| middles(kind, nodes)));
        }
        parts.sort_unstable();
        parts.dedup();
        let first = self.points.len();
        let number = |part: &Part| {
            let at = parts.binary_search(part).unwrap_or_else(|_| unreachable!("collected above"));
            (first + at) as u32
        };
        let mut points = self.points.clone();
        let of_edges = parts.partition_point(|part| part.0 == NodePlace::Edge);
        points.extend(
            parts[..of_edges]
                .iter()
                .map(|Part(_, [a, b, ..])| place([a, b].map(|end| self.points[*end as usize]))),
        );
        points.resize(first + parts.len(), Vec3::ZERO);
        let mut is_placed = vec![false; parts.len() - of_edges];
        for block in linear().filter(|_| of_edges < parts.len()) {
            let (kind, curved) = (block.kind.with_middles(most), block.kind.with_middles(NodePlace::Edge));
            for nodes in block.cells() {
                let around: Vec<Vec3> = (nodes.iter().copied())
                    .chain(middles(curved, nodes).map(|part| number(&part)))
                    .map(|point| points[point as usize])
                    .collect();
                for (part, xi) in middles(kind, nodes).zip(&kind.element().nodes[nodes.len()..]) {
                    let point = number(&part) as usize;
                    // the first cell places what it shares: others would by the same curves, to rounding
                    if part.0 > NodePlace::Edge
                        && !std::mem::replace(&mut is_placed[point - first - of_edges], true)
                    {
                        points[point] = curved.position(&around, Vec3::from_array(*xi));
                    }
                }
            }
        }
        let raise = |block: &CellBlock| {
            if !block.kind.is_linear() {
                return block.clone();
            }
            let kind = block.kind.with_middles(most);
            let with_middles = |nodes: &[u32]| {
                let middles = middles(kind, nodes).map(|part| number(&part));
                nodes.iter().copied().chain(middles).collect::<Vec<_>>()
            };
            CellBlock { kind, nodes: block.cells().flat_map(with_middles).collect() }
        };
        let mut groups = self.groups.clone();
        for group in groups.values_mut() {
            let holds = |end: &u32| group.points.binary_search(end).is_ok();
            let joined: Vec<u32> =
                parts.iter().filter(|part| part.corners().iter().all(holds)).map(number).collect();
            group.points.extend(joined);
        }
        Self {
            blocks: self.blocks.iter().map(raise).collect(),
            facet_blocks: self.facet_blocks.iter().map(raise).collect(),
            points,
            groups,
        }
    }

    /// The mesh whose cells are the facets of this one: a surface read from a file as a body of its own. Groups of
    /// facets become groups of cells.
    pub fn facets_as_cells(&self) -> Self {
        let groups: BTreeMap<_, _> = self
            .groups
            .iter()
            .map(|(name, group)| {
                let mut group = group.clone();
                group.cells = std::mem::take(&mut group.facets);
                (name.clone(), group)
            })
            .collect();
        Self {
            points: self.points.clone(),
            blocks: self.facet_blocks.clone(),
            facet_blocks: Vec::new(),
            groups,
        }
    }

    /// Turns surface cells whose normals point to negative z, and returns their numbers: a plane body is seen from
    /// above.
    pub fn face_up(&mut self) -> Vec<u32> {
        let points = &self.points;
        let (mut cell, mut turned) = (0, Vec::new());
        for block in &mut self.blocks {
            let kind = block.kind;
            for nodes in block.nodes.chunks_exact_mut(kind.node_count()) {
                let positions: Vec<Vec3> = nodes.iter().map(|node| points[*node as usize]).collect();
                let up: f64 = (kind.default_rule().points.iter())
                    .map(|p| kind.jacobian(&positions, p.position).columns[2].z * p.weight)
                    .sum();
                if up < 0.0 {
                    let mirrored: Vec<u32> =
                        kind.mirrored().iter().map(|node| nodes[usize::from(*node)]).collect();
                    nodes.copy_from_slice(&mirrored);
                    turned.push(cell);
                }
                cell += 1;
            }
        }
        turned
    }
}

/// What has a point in its middle: what it is, and the points at its corners, ascending and padded.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Part(NodePlace, [u32; MOST_CORNERS]);

/// Of a hexahedron.
const MOST_CORNERS: usize = 8;
const NO_POINT: u32 = u32::MAX;

impl Part {
    fn corners(&self) -> &[u32] {
        &self.1[..self.1.partition_point(|corner| *corner != NO_POINT)]
    }
}

/// The parts of a cell in whose middles the nodes of an element beyond its corners are.
fn middles(kind: ElementKind, corners: &[u32]) -> impl Iterator<Item = Part> + '_ {
    kind.middles().iter().enumerate().map(move |(middle, part)| {
        let mut own = [NO_POINT; MOST_CORNERS];
        for (slot, corner) in own.iter_mut().zip(part) {
            *slot = corners[usize::from(*corner)];
        }
        own.sort_unstable();
        Part(kind.place(kind.corner_count() + middle), own)
    })
}

#[cfg(test)]
mod tests {
    use souple_table::{Value, Values};

    use super::*;
    use crate::generate;

    /// Raising adds one point for each edge and changes neither volume nor boundary; the mesh stays conforming.
    #[test]
    fn raised_meshes_are_the_same_shape() {
        for element in ["tet4", "hex8", "prism6", "pyramid5", "mixed"] {
            let values = Values::new()
                .with("size", Value::Vector([2.0, 1.0, 1.0]))
                .with("cells", Value::Vector([4.0, 2.0, 2.0]))
                .with("element", Value::Text(element));
            let linear = generate("box", values).unwrap();
            let mut mesh = linear.raised(NodePlace::Edge, |[a, b]| (a + b) * 0.5);
            mesh.validate().unwrap();
            mesh.faces().conforming().unwrap();
            assert_eq!(mesh.faces().boundary, linear.faces().boundary, "{element}");
            assert!((mesh.volume() - 2.0).abs() < 1e-13, "{element} {}", mesh.volume());
            assert!((mesh.boundary_surface().area() - 10.0).abs() < 1e-12, "{element}");
            // a side of 2 x 2 squares: 9 corners, 12 edges, and diagonals where squares are cut in two
            let on_side = mesh.groups["x_min"].points.len();
            assert!(on_side == 21 || on_side == 25, "{element}: {on_side}");
            assert!(mesh.groups["x_min"].points.iter().all(|point| mesh.points[*point as usize].x == 0.0));
            assert_eq!(mesh.raised(NodePlace::Edge, |_| unreachable!("no linear cell is left")), mesh);
        }
    }

    /// Raised to the middles of faces and of cells too: those are shared, lie among the curves around them and join the groups of their
    /// corners.
    #[test]
    fn middles_of_faces_and_cells() {
        let values = Values::new()
            .with("size", Value::Vector([2.0, 1.0, 1.0]))
            .with("cells", Value::Vector([4.0, 2.0, 2.0]))
            .with("element", Value::Text("hex8"));
        let linear = generate("box", values).unwrap();
        let mut mesh = linear.raised(NodePlace::Inside, |[a, b]| (a + b) * 0.5);
        assert_eq!(mesh.blocks[0].kind, ElementKind::Hex27);
        // a grid of half the size
        assert_eq!(mesh.points.len(), 9 * 5 * 5);
        assert_eq!(mesh.groups["x_min"].points.len(), 5 * 5);
        mesh.validate().unwrap();
        mesh.faces().conforming().unwrap();
        assert_eq!(mesh.faces().boundary, linear.faces().boundary);
        let is_on_grid = |p: &Vec3| (*p * 4.0).to_array().iter().all(|x| (x - x.round()).abs() < 1e-12);
        assert!(mesh.points.iter().all(is_on_grid));
        assert!((mesh.boundary_surface().area() - 10.0).abs() < 1e-12);
        // edges along x bulge by the same: so do the middles between them
        let bulge = |[a, b]: [Vec3; 2]| {
            let along = (a.x - b.x).abs();
            (a + b) * 0.5 + Vec3::Y * (0.1 * along)
        };
        let bent = linear.raised(NodePlace::Inside, bulge);
        for (straight, bent) in mesh.points.iter().zip(&bent.points).skip(linear.points.len()) {
            let is_between = ((straight.x * 4.0).round() as i64) % 2 == 1;
            let expected = if is_between { 0.05 } else { 0.0 };
            assert!((bent.y - straight.y - expected).abs() < 1e-12, "{straight:?} {bent:?}");
        }
    }

    /// A quadratic cell beside a linear one does not fit: both faces are boundary.
    #[test]
    fn orders_do_not_mix_across_a_face() {
        let values = Values::new()
            .with("size", Value::Vector([2.0, 1.0, 1.0]))
            .with("cells", Value::Vector([2.0, 1.0, 1.0]))
            .with("element", Value::Text("hex8"));
        let linear = generate("box", values).unwrap();
        let mut mesh = linear.raised(NodePlace::Edge, |[a, b]| (a + b) * 0.5);
        let corners = linear.blocks[0].nodes[8..].to_vec();
        mesh.blocks[0].nodes.truncate(20);
        mesh.push_cell(ElementKind::Hex8, &corners);
        assert!(mesh.faces().neighbours.is_empty());
        assert_eq!(mesh.faces().boundary.len(), 12);
    }
}
