//! Which cell carries a point, and with what reference coordinates: the inverse isoparametric map.
//!
//! A carried point is `x = Σ N_a(ξ) x_a` at all times: probes, skins and attachments are made of this.

use souple_math::Vec3;

use crate::{Aabb, AabbTree, ElementKind, MAX_NODES, Mesh, TriangleSurface, closest_point_on_triangle};

/// A point carried by a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Location {
    pub cell: u32,
    pub kind: ElementKind,
    /// Coordinates `ξ` in the reference cell; slightly outside of it for an extrapolated point.
    pub reference: Vec3,
    /// How far the point asked for is from the mesh, zero inside [m].
    pub distance: f64,
}

impl Location {
    /// Weights of the nodes of the cell.
    pub fn weights(&self) -> impl std::ops::Deref<Target = [f64]> + use<> {
        self.kind.shape(self.reference)
    }
}

/// Points count as inside down to this slack in reference coordinates, so that none falls between two cells.
const INSIDE: f64 = -1e-9;

/// Points outside by more than this in reference coordinates are carried by their closest point on the boundary:
/// farther out, the polynomials of a cell say nothing.
const EXTRAPOLATION: f64 = -1.0;

/// Finds cells of a mesh.
#[derive(Debug)]
pub struct CellLocator<'a> {
    mesh: &'a Mesh,
    cells: AabbTree,
    surface: TriangleSurface,
    triangles: AabbTree,
    /// Numbers of the first cells of the blocks.
    offsets: Vec<u32>,
}

impl<'a> CellLocator<'a> {
    /// For a mesh that has passed [`Mesh::validate`].
    pub fn new(mesh: &'a Mesh) -> Self {
        let bounds = |kind: ElementKind, nodes: &[u32]| {
            let bounds = Aabb::of(nodes.iter().map(|node| mesh.points[*node as usize]));
            // faces of linear cells bulge, but never out of the box of their nodes; rounding does. A curved edge leaves it by
            // an eighth of its extent at most, a face by twice that, as long as its determinant keeps its sign
            let margin = if kind.is_linear() { 1e-9 } else { 0.25 };
            bounds.grown(margin * bounds.diagonal())
        };
        let boxes: Vec<Aabb> = mesh.cells().map(|cell| bounds(cell.kind, cell.nodes)).collect();
        let surface = mesh.boundary_surface();
        let triangle_boxes: Vec<Aabb> =
            (0..surface.triangles.len() as u32).map(|triangle| Aabb::of(surface.corners(triangle))).collect();
        Self {
            mesh,
            cells: AabbTree::build(&boxes),
            triangles: AabbTree::build(&triangle_boxes),
            surface,
            offsets: mesh.block_offsets(),
        }
    }

    /// The cell that contains a point: of several, the one in which it lies deepest, then the lowest number.
    pub fn containing(&self, point: Vec3) -> Option<Location> {
        let mut best: Option<(f64, Location)> = None;
        self.cells.overlapping(Aabb { low: point, high: point }, |cell| {
            let Some((location, slack)) = self.reference_in(cell, point) else { return };
            let better = best.is_none_or(|(deepest, kept)| {
                slack > deepest || (slack == deepest && location.cell < kept.cell)
            });
            if slack >= INSIDE && better {
                best = Some((slack, location));
            }
        });
        best.map(|(_, location)| location)
    }

    /// The cell that carries a point: the one that contains it, or outside the mesh the one behind the closest
    /// point of the boundary, extrapolated if the point is near, else carrying that closest point.
    /// `None` for a point that is not finite or a mesh without cells.
    pub fn carrier(&self, point: Vec3) -> Option<Location> {
        if !point.is_finite() {
            return None;
        }
        if let Some(inside) = self.containing(point) {
            return Some(inside);
        }
        let closest = |triangle: u32| {
            let corners = self.surface.corners(triangle);
            let (weights, _) = closest_point_on_triangle(point, corners);
            corners[0] * weights[0] + corners[1] * weights[1] + corners[2] * weights[2]
        };
        let (triangle, distance_sq) =
            self.triangles.nearest(point, f64::INFINITY, |t| (point - closest(t)).length_sq())?;
        let cell = self.surface.cells[triangle as usize];
        let near = self.reference_in(cell, point).filter(|(_, slack)| *slack >= EXTRAPOLATION);
        let (location, _) = near.or_else(|| self.reference_in(cell, closest(triangle)))?;
        Some(Location { distance: distance_sq.sqrt(), ..location })
    }

    /// Reference coordinates of a point in a given cell and their slack; `None` where Newton finds none.
    fn reference_in(&self, cell: u32, point: Vec3) -> Option<(Location, f64)> {
        let block_index = self.offsets.partition_point(|offset| *offset <= cell) - 1;
        let block = &self.mesh.blocks[block_index];
        let n = block.kind.node_count();
        let first = (cell - self.offsets[block_index]) as usize * n;
        let mut buffer = [Vec3::ZERO; MAX_NODES];
        let positions = self.mesh.positions_into(&block.nodes[first..first + n], &mut buffer);
        let reference = inverse_map(block.kind, positions, point)?;
        let slack = (block.kind.element().slack)(reference);
        Some((Location { cell, kind: block.kind, reference, distance: 0.0 }, slack))
    }
}

/// `ξ` with `x(ξ) = point`, by Newton from the middle of the cell.
fn inverse_map(kind: ElementKind, positions: &[Vec3], point: Vec3) -> Option<Vec3> {
    let nodes = kind.element().nodes;
    let mut xi = nodes.iter().map(|node| Vec3::from_array(*node)).sum::<Vec3>() / nodes.len() as f64;
    let size = Aabb::of(positions.iter().copied()).diagonal();
    // rounding of coordinates far from the origin limits what can be reached
    let reachable = 1e-13 * size + 4.0 * f64::EPSILON * point.largest_component();
    for _ in 0..30 {
        let residual = kind.position(positions, xi) - point;
        let step = kind.jacobian(positions, xi).try_inverse()? * residual;
        // ξ -= (∂x/∂ξ)⁻¹ (x(ξ) - point)
        xi -= step;
        if !xi.is_finite() || xi.largest_component() > 1e6 {
            return None;
        }
        if residual.length() <= reachable || step.largest_component() <= 1e-14 {
            return Some(xi);
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use souple_table::{Value, Values};

    use super::*;
    use crate::generate;

    const ELEMENTS: [&str; 5] = ["tet4", "hex8", "prism6", "pyramid5", "mixed"];

    /// A ball: its cells are neither affine nor aligned.
    fn ball(element: &str) -> Mesh {
        let values = Values::new()
            .with("radius", Value::Number(1.0))
            .with("cells", Value::Integer(8))
            .with("element", Value::Text(element));
        generate("sphere", values).unwrap()
    }

    fn carried(mesh: &Mesh, location: &Location) -> Vec3 {
        let cell = mesh.cell(location.cell).unwrap();
        let weights = location.weights();
        cell.nodes
            .iter()
            .zip(weights.iter())
            .map(|(node, weight)| mesh.points[*node as usize] * *weight)
            .sum()
    }

    /// Every point of a quadrature rule is found in its own cell, at its own reference coordinates.
    #[test]
    fn points_of_cells_are_found_in_them() {
        for element in ELEMENTS {
            let mesh = ball(element);
            let locator = CellLocator::new(&mesh);
            let mut buffer = [Vec3::ZERO; MAX_NODES];
            for (index, cell) in mesh.cells().enumerate() {
                let positions = mesh.positions_into(cell.nodes, &mut buffer);
                for sample in &cell.kind.default_rule().points {
                    let point = cell.kind.position(positions, sample.position);
                    let found = locator.containing(point).unwrap();
                    assert_eq!(found.cell, index as u32, "{element}");
                    // rounding 1e-16 through the inverse of the Jacobian, whose condition is below 1e4 here
                    assert!((found.reference - sample.position).length() < 1e-11, "{element} {found:?}");
                }
            }
        }
    }

    /// Points of the mesh itself, on corners of many cells, are found with all weight on themselves.
    #[test]
    fn nodes_are_found() {
        for element in ELEMENTS {
            let mesh = ball(element);
            let locator = CellLocator::new(&mesh);
            for point in &mesh.points {
                let location = locator.carrier(*point).unwrap();
                assert!(
                    (carried(&mesh, &location) - *point).length() < 1e-8,
                    "{element} {point:?} {location:?}"
                );
            }
        }
    }

    /// A point near the boundary is extrapolated exactly, one far away is carried by the closest boundary point.
    #[test]
    fn points_outside() {
        for element in ELEMENTS {
            let values = Values::new()
                .with("size", Value::Vector([4.0, 1.0, 1.0]))
                .with("cells", Value::Vector([4.0, 1.0, 1.0]))
                .with("element", Value::Text(element));
            let mesh = generate("box", values).unwrap();
            let locator = CellLocator::new(&mesh);
            let near = Vec3::new(-0.1, 0.4, 0.3);
            let location = locator.carrier(near).unwrap();
            assert!((carried(&mesh, &location) - near).length() < 1e-12, "{element}");
            assert!((location.distance - 0.1).abs() < 1e-14);
            assert!(locator.containing(near).is_none());
            let far = Vec3::new(-100.0, 0.4, 0.3);
            let location = locator.carrier(far).unwrap();
            assert!((carried(&mesh, &location) - Vec3::new(0.0, 0.4, 0.3)).length() < 1e-12, "{element}");
            assert_eq!(locator.carrier(Vec3::new(f64::NAN, 0.0, 0.0)), None);
        }
    }

    /// Every point of a box is in some cell: none falls into the gaps between them.
    #[test]
    fn cells_leave_no_gaps() {
        let mesh = ball("mixed");
        let locator = CellLocator::new(&mesh);
        for i in 0..1000 {
            let at = |i: usize| -0.45 + 0.1 * i as f64;
            let point = Vec3::new(at(i % 10), at(i / 10 % 10), at(i / 100));
            assert!(locator.containing(point).is_some(), "{point:?}");
        }
    }
}
