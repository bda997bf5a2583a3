//! Linear meshes raised to quadratic ones.

use std::collections::BTreeMap;

use souple_math::Vec3;

use crate::{CellBlock, ElementKind, Mesh, Order};

impl Mesh {
    /// The mesh of quadratic cells with the same corners: one point more in the middle of each edge, shared by all
    /// cells and facets of that edge, after the points there were and in the order of their edges' ends. A point joins
    /// the groups that hold both ends of its edge. Cells that are quadratic already keep their nodes.
    ///
    /// Edges are straight; `place` gives a middle from its edge's ends, for those who know the curve.
    pub fn raised(&self, place: impl Fn([Vec3; 2]) -> Vec3) -> Self {
        let mut edges: Vec<[u32; 2]> = Vec::new();
        for block in self.blocks.iter().chain(&self.facet_blocks).filter(|block| is_linear(block.kind)) {
            for nodes in block.cells() {
                edges.extend(block.kind.edges().iter().map(|edge| ends(nodes, *edge)));
            }
        }
        edges.sort_unstable();
        edges.dedup();
        let first = self.points.len() as u32;
        let middle = |edge: [u32; 2]| {
            let at = edges.binary_search(&edge).unwrap_or_else(|_| unreachable!("collected above"));
            first + at as u32
        };
        let raise = |block: &CellBlock| {
            if !is_linear(block.kind) {
                return block.clone();
            }
            let with_middles = |nodes: &[u32]| {
                let middles = block.kind.edges().iter().map(|edge| middle(ends(nodes, *edge)));
                nodes.iter().copied().chain(middles).collect::<Vec<_>>()
            };
            CellBlock {
                kind: block.kind.of_order(Order::Quadratic),
                nodes: block.cells().flat_map(with_middles).collect(),
            }
        };
        let middles = edges.iter().map(|edge| place(edge.map(|end| self.points[end as usize])));
        let mut groups = self.groups.clone();
        for group in groups.values_mut() {
            let holds = |end: &u32| group.points.binary_search(end).is_ok();
            let joined: Vec<u32> =
                edges.iter().filter(|edge| edge.iter().all(holds)).map(|edge| middle(*edge)).collect();
            group.points.extend(joined);
        }
        Self {
            points: self.points.iter().copied().chain(middles).collect(),
            blocks: self.blocks.iter().map(raise).collect(),
            facet_blocks: self.facet_blocks.iter().map(raise).collect(),
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

fn is_linear(kind: ElementKind) -> bool {
    kind.order() == Order::Linear
}

/// Points at the ends of an edge of a cell, ascending.
fn ends(nodes: &[u32], [a, b]: [u8; 2]) -> [u32; 2] {
    let mut ends = [nodes[usize::from(a)], nodes[usize::from(b)]];
    ends.sort_unstable();
    ends
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
            let mut mesh = linear.raised(|[a, b]| (a + b) * 0.5);
            mesh.validate().unwrap();
            mesh.faces().conforming().unwrap();
            assert_eq!(mesh.faces().boundary, linear.faces().boundary, "{element}");
            assert!((mesh.volume() - 2.0).abs() < 1e-13, "{element} {}", mesh.volume());
            assert!((mesh.boundary_surface().area() - 10.0).abs() < 1e-12, "{element}");
            // a side of 2 x 2 squares: 9 corners, 12 edges, and diagonals where squares are cut in two
            let on_side = mesh.groups["x_min"].points.len();
            assert!(on_side == 21 || on_side == 25, "{element}: {on_side}");
            assert!(mesh.groups["x_min"].points.iter().all(|point| mesh.points[*point as usize].x == 0.0));
            assert_eq!(mesh.raised(|_| unreachable!("no linear cell is left")), mesh);
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
        let mut mesh = linear.raised(|[a, b]| (a + b) * 0.5);
        let corners = linear.blocks[0].nodes[8..].to_vec();
        mesh.blocks[0].nodes.truncate(20);
        mesh.push_cell(ElementKind::Hex8, &corners);
        assert!(mesh.faces().neighbours.is_empty());
        assert_eq!(mesh.faces().boundary.len(), 12);
    }
}
