//! How well shaped cells are, and what the worst of a mesh are.
//!
//! Every measure is 1 for the regular cell of its kind (all edges equal), except angles.

use souple_math::Vec3;

use crate::measure::volume_rule;
use crate::{Cell, ElementKind, Face, MAX_NODES, Mesh, QuadraturePoint};

/// Shape of one cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CellQuality {
    /// [m³]
    pub volume: f64,
    /// Longest edge × surface / volume, relative to the regular cell: 1 at best, ∞ for a flat cell.
    pub aspect_ratio: f64,
    /// Least determinant of the unit edge vectors at a corner, relative to the regular cell: 0 for a flat corner,
    /// negative for an inverted one. Corners of three edges count, which leaves out the apex of a pyramid. On a
    /// quadratic cell, times the least ratio, over its quadrature points, of its Jacobian determinant to that of the cell
    /// of straight edges: 1 where no edge is bent, negative where bending turns the cell inside out.
    pub scaled_jacobian: f64,
    /// Least angle between two faces, inside the cell [rad].
    pub smallest_dihedral: f64,
    /// Greatest angle between two faces, inside the cell [rad].
    pub largest_dihedral: f64,
}

/// Counts of values in bins of equal width.
#[derive(Clone, Debug, PartialEq)]
pub struct Histogram {
    pub low: f64,
    pub high: f64,
    pub counts: Vec<usize>,
    pub mean: f64,
}

/// Quality of a whole mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct QualitySummary {
    pub cell_count: usize,
    /// [m³]
    pub volume: Histogram,
    pub aspect_ratio: Histogram,
    pub scaled_jacobian: Histogram,
    /// [rad]
    pub smallest_dihedral: Histogram,
    /// Cell of least scaled Jacobian.
    pub worst_cell: u32,
}

impl Histogram {
    /// Values that are not finite are left out of bins and mean. Without values, all is zero.
    pub fn of(values: &[f64], bins: usize) -> Self {
        let finite = || values.iter().copied().filter(|value| value.is_finite());
        let count = finite().count();
        let mut counts = vec![0; bins.max(1)];
        if count == 0 {
            return Self { low: 0.0, high: 0.0, counts, mean: 0.0 };
        }
        let low = finite().fold(f64::INFINITY, f64::min);
        let high = finite().fold(f64::NEG_INFINITY, f64::max);
        let last = counts.len() - 1;
        for value in finite() {
            let bin = (value - low) / (high - low) * counts.len() as f64;
            // one value only: 0/0 goes to the first bin
            counts[(bin as usize).min(last)] += 1;
        }
        Self { low, high, counts, mean: finite().sum::<f64>() / count as f64 }
    }
}

impl Mesh {
    /// Shapes of all cells, in their order.
    pub fn quality(&self) -> Vec<CellQuality> {
        let regular: Vec<Shape> =
            ElementKind::ALL.iter().map(|kind| Shape::of(*kind, &kind.regular())).collect();
        let mut buffer = [Vec3::ZERO; MAX_NODES];
        let relative = |cell: Cell<'_>| {
            let shape = Shape::of(cell.kind, self.positions_into(cell.nodes, &mut buffer));
            let ideal = &regular[cell.kind as usize];
            CellQuality {
                volume: self.cell_volume(cell),
                aspect_ratio: shape.slenderness(self.cell_volume(cell)) / ideal.slenderness(ideal.volume),
                scaled_jacobian: shape.corner / ideal.corner,
                smallest_dihedral: shape.dihedrals.0,
                largest_dihedral: shape.dihedrals.1,
            }
        };
        self.cells().map(relative).collect()
    }

    /// Numbers of dihedral angles of all cells, in bins of equal width from 0 to π.
    pub fn dihedral_histogram(&self, bins: usize) -> Vec<usize> {
        let mut counts = vec![0; bins.max(1)];
        let mut buffer = [Vec3::ZERO; MAX_NODES];
        for cell in self.cells() {
            let positions = self.positions_into(cell.nodes, &mut buffer);
            let normals: Vec<Vec3> =
                cell.kind.faces().iter().map(|face| area_vector(face, positions)).collect();
            for angle in edge_angles(cell.kind, &normals, positions) {
                let bin = angle / std::f64::consts::PI * counts.len() as f64;
                let last = counts.len() - 1;
                counts[(bin as usize).min(last)] += 1;
            }
        }
        counts
    }

    /// Histograms of `bins` bins over all cells.
    pub fn quality_summary(&self, bins: usize) -> QualitySummary {
        let cells = self.quality();
        let histogram = |measure: fn(&CellQuality) -> f64| {
            Histogram::of(&cells.iter().map(measure).collect::<Vec<_>>(), bins)
        };
        let jacobian = |cell: &usize| cells[*cell].scaled_jacobian;
        let worst = (0..cells.len()).min_by(|a, b| jacobian(a).total_cmp(&jacobian(b)));
        QualitySummary {
            cell_count: cells.len(),
            volume: histogram(|cell| cell.volume),
            aspect_ratio: histogram(|cell| cell.aspect_ratio),
            scaled_jacobian: histogram(|cell| cell.scaled_jacobian),
            smallest_dihedral: histogram(|cell| cell.smallest_dihedral),
            worst_cell: worst.unwrap_or(0) as u32,
        }
    }
}

/// Scaled Jacobian of one cell of given nodes, as in [`CellQuality`].
pub(crate) fn scaled_jacobian(kind: ElementKind, positions: &[Vec3]) -> f64 {
    least_corner(kind, positions) / least_corner(kind, &kind.regular())
}

/// Measures of a cell as it is.
struct Shape {
    longest_edge: f64,
    surface: f64,
    volume: f64,
    /// Least determinant of unit edges at a corner.
    corner: f64,
    /// Least and greatest angle between faces [rad].
    dihedrals: (f64, f64),
}

impl Shape {
    fn of(kind: ElementKind, positions: &[Vec3]) -> Self {
        let along = |[a, b]: [u8; 2]| positions[usize::from(b)] - positions[usize::from(a)];
        let longest_edge = kind.edges().iter().map(|edge| along(*edge).length()).fold(0.0, f64::max);
        let normals: Vec<Vec3> = kind.faces().iter().map(|face| area_vector(face, positions)).collect();
        let rule = volume_rule(kind);
        Self {
            longest_edge,
            surface: normals.iter().map(|normal| normal.length()).sum(),
            volume: rule
                .points
                .iter()
                .map(|p| p.weight * kind.jacobian(positions, p.position).determinant())
                .sum(),
            corner: least_corner(kind, positions) * bending(kind, positions),
            dihedrals: dihedrals(kind, &normals, positions),
        }
    }

    fn slenderness(&self, volume: f64) -> f64 {
        self.longest_edge * self.surface / volume
    }
}

/// Area times outward normal of a face: half the sum of the cross products around its corners.
fn area_vector(face: &Face, positions: &[Vec3]) -> Vec3 {
    let nodes = &face.nodes[..face.kind.corner_count()];
    let at =
        |place: usize| positions[usize::from(nodes[place % nodes.len()])] - positions[usize::from(nodes[0])];
    (1..nodes.len().saturating_sub(1)).map(|place| at(place).cross(at(place + 1)) * 0.5).sum()
}

/// Least ratio of the Jacobian determinant to that of the cell of the same corners and straight edges.
fn bending(kind: ElementKind, positions: &[Vec3]) -> f64 {
    if kind.is_linear() {
        return 1.0;
    }
    let (straight, corners) = (kind.corners(), &positions[..kind.corner_count()]);
    let ratio = |point: &QuadraturePoint| {
        kind.jacobian(positions, point.position).determinant()
            / straight.jacobian(corners, point.position).determinant()
    };
    kind.full_rule().points.iter().map(ratio).fold(f64::INFINITY, f64::min)
}

/// Angles between the two faces at each edge, inside the cell: `π` less the angle between the outward normals, and above π where a
/// warped face makes the edge a valley.
fn edge_angles<'a>(
    kind: ElementKind,
    normals: &'a [Vec3],
    positions: &'a [Vec3],
) -> impl Iterator<Item = f64> + 'a {
    kind.edges().iter().filter_map(move |edge| {
        let mut sides =
            (0..normals.len()).filter(|f| edge.iter().all(|n| kind.faces()[*f].nodes.contains(n)));
        let (first, second) = (sides.next()?, sides.next()?);
        let (u, v) = (normals[first], normals[second]);
        let [a, b] = *edge;
        // along the edge as the first face goes around: there `u x v` points where the edge is a ridge
        let face = &kind.faces()[first];
        let corners = &face.nodes[..face.kind.corner_count()];
        let place = corners.iter().position(|node| *node == a)?;
        let forward = corners[(place + 1) % corners.len()] == b;
        let [from, to] = if forward { [a, b] } else { [b, a] };
        let along = positions[usize::from(to)] - positions[usize::from(from)];
        let turn = u.cross(v);
        let sine = if turn.dot(along) < 0.0 { -turn.length() } else { turn.length() };
        Some(std::f64::consts::PI - libm::atan2(sine, u.dot(v)))
    })
}

fn dihedrals(kind: ElementKind, normals: &[Vec3], positions: &[Vec3]) -> (f64, f64) {
    edge_angles(kind, normals, positions)
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(least, greatest), angle| {
            (least.min(angle), greatest.max(angle))
        })
}

fn least_corner(kind: ElementKind, positions: &[Vec3]) -> f64 {
    let reference: Vec<Vec3> = kind.element().nodes.iter().map(|node| Vec3::from_array(*node)).collect();
    let mut least = f64::INFINITY;
    for corner in 0..kind.corner_count() as u8 {
        let other_end = |edge: &[u8; 2]| match *edge {
            [a, b] if a == corner => Some(b),
            [a, b] if b == corner => Some(a),
            _ => None,
        };
        let ends: Vec<u8> = kind.edges().iter().filter_map(other_end).collect();
        let [a, b, c] = ends[..] else { continue };
        let triple = |nodes: &[Vec3]| {
            let along = |end: u8| (nodes[usize::from(end)] - nodes[usize::from(corner)]).try_normalised();
            let [a, b, c] = [a, b, c].map(|end| along(end).unwrap_or(Vec3::ZERO));
            a.dot(b.cross(c))
        };
        // the reference cell says which order of the three edges is positive
        least = least.min(triple(positions) * triple(&reference).signum());
    }
    least
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A hexahedron of which an edge is pushed inward beyond its diagonal has a valley there: more than a half turn inside.
    #[test]
    fn edges_that_are_valleys() {
        let mut points: Vec<Vec3> = ElementKind::Hex8.regular();
        let largest = |points: &[Vec3]| {
            Mesh::new(points.to_vec(), ElementKind::Hex8, (0..8).collect()).quality()[0].largest_dihedral
        };
        assert!((largest(&points) - std::f64::consts::FRAC_PI_2).abs() < 1e-12);
        for (pushed, across) in [(2, 0), (6, 4)] {
            points[pushed] = points[across] + (points[pushed] - points[across]) * 0.35;
        }
        // a full turn less the angle between (0.65, -0.35) and (-0.35, 0.65)
        let expected = 2.0 * std::f64::consts::PI - libm::acos(-0.455 / 0.545);
        assert!((largest(&points) - expected).abs() < 1e-12, "{}", largest(&points));
    }

    /// The regular cell of each kind has aspect ratio 1 and scaled Jacobian 1; its dihedral angles are known.
    #[test]
    fn regular_cells_are_perfect() {
        let expected = [
            (ElementKind::Tet4, (1.0_f64 / 3.0).acos()),
            (ElementKind::Hex8, 0.5_f64 * std::f64::consts::PI),
            (ElementKind::Prism6, std::f64::consts::FRAC_PI_3),
            (ElementKind::Pyramid5, (1.0_f64 / 3.0).sqrt().acos()),
        ];
        let quadratic =
            expected.map(|(kind, smallest)| (kind.with_middles(crate::NodePlace::Edge), smallest));
        for (kind, smallest) in expected.into_iter().chain(quadratic) {
            let points = kind.regular();
            for [a, b] in kind.edges() {
                assert!(((points[usize::from(*a)] - points[usize::from(*b)]).length() - 1.0).abs() < 1e-15);
            }
            let nodes = (0..kind.node_count() as u32).collect();
            let quality = Mesh::new(points, kind, nodes).quality()[0];
            assert!((quality.aspect_ratio - 1.0).abs() < 1e-14, "{kind} {quality:?}");
            assert!((quality.scaled_jacobian - 1.0).abs() < 1e-14, "{kind} {quality:?}");
            assert!((quality.smallest_dihedral - smallest).abs() < 1e-14, "{kind} {quality:?}");
        }
    }

    /// Pulling a middle node a quarter of the edge outward and more bends the cell until it turns inside out.
    #[test]
    fn bent_cells_lose_quality() {
        for (shift, is_good) in [(0.0, true), (0.05, true), (0.6, false)] {
            let mut points = ElementKind::Tet10.regular();
            // the middle of the edge 01 is moved along that edge
            points[4] += Vec3::X * shift;
            let jacobian =
                Mesh::new(points, ElementKind::Tet10, (0..10).collect()).quality()[0].scaled_jacobian;
            assert_eq!(jacobian > 0.0, is_good, "{shift}: {jacobian}");
            assert!(
                jacobian < 1.0 + 1e-14 && (shift > 0.0) == (jacobian < 1.0 - 1e-3),
                "{shift}: {jacobian}"
            );
        }
    }

    /// Stretching a cube by `s` along one axis: surface (2 + 4s), volume s, longest edge s.
    #[test]
    fn aspect_ratio_of_a_stretched_cube() {
        let stretch = 3.0;
        let regular = ElementKind::Hex8.element().regular;
        let points = regular.iter().map(|[x, y, z]| Vec3::new(stretch * x, *y, *z)).collect();
        let quality = Mesh::new(points, ElementKind::Hex8, (0..8).collect()).quality()[0];
        assert!((quality.aspect_ratio - (2.0 + 4.0 * stretch) / 6.0).abs() < 1e-14);
        assert!((quality.scaled_jacobian - 1.0).abs() < 1e-15);
    }

    #[test]
    fn histogram_counts_every_finite_value() {
        let histogram = Histogram::of(&[0.0, 0.1, 0.9, 1.0, f64::NAN], 2);
        assert_eq!((histogram.counts, histogram.low, histogram.high), (vec![2, 2], 0.0, 1.0));
        assert_eq!(histogram.mean, 0.5);
        assert_eq!(Histogram::of(&[2.0, 2.0], 3).counts, vec![2, 0, 0]);
        assert_eq!(Histogram::of(&[], 3).counts, vec![0; 3]);
    }
}
