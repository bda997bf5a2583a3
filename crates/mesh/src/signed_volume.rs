//! Volumes of cells as they stand, for who looks at all of them again and again.
//!
//! A cell with straight edges fills what its faces enclose: `3 V = Σ ∫ x·n dA`. Seen from its first node a flat triangle `a b c` encloses
//! `[a b c]/6`, and a bilinear face half of what its two pairs of triangles do, `((a × b)·(c + d) + (a + b)·(c × d))/12`; nothing is enclosed by
//! triangles that have that node, and half a tetrahedron by quadrilaterals. A hexahedron takes six triple products that way, where its rule has eight Jacobians.

use souple_math::Vec3;

use crate::measure::volume_rule;
use crate::{ElementKind, MAX_NODES};

/// Volume of cells of one kind [m³], see [`crate::Mesh::cell_volume`]: the same up to rounding.
#[derive(Clone, Debug)]
pub struct SignedVolume {
    node_count: usize,
    form: Form,
}

#[derive(Clone, Debug)]
enum Form {
    Tetrahedron,
    Hexahedron,
    /// Of faces between the corners of another linear kind, outward.
    Faces {
        triangles: Vec<[u8; 3]>,
        /// The other corners of quadrilaterals that have the first node.
        at_first: Vec<[u8; 3]>,
        quadrilaterals: Vec<[u8; 4]>,
    },
    /// Weights of a rule, and at each of its points gradients of all shape functions.
    Samples(Vec<(f64, Vec<Vec3>)>),
}

/// `6 V` of a tetrahedron, or `12 V` of half of one, from the first node.
fn pyramid([a, b, c]: [Vec3; 3]) -> f64 {
    a.cross(b).dot(c)
}

/// `12 V` between the first node and a bilinear face.
fn bent([a, b, c, d]: [Vec3; 4]) -> f64 {
    a.cross(b).dot(c + d) + (a + b).dot(c.cross(d))
}

/// Where the nodes of a cell are, from the first of them.
fn from_first<const N: usize>(nodes: &[u32], places: &[Vec3]) -> [Vec3; N] {
    let place = |node: usize| places[nodes[node] as usize];
    let first = place(0);
    std::array::from_fn(|node| place(node) - first)
}

impl SignedVolume {
    /// `None` of a kind that fills no space.
    pub fn of(kind: ElementKind) -> Option<Self> {
        if kind.dimension() < 3 {
            return None;
        }
        let form = match kind {
            ElementKind::Tet4 => Form::Tetrahedron,
            ElementKind::Hex8 => Form::Hexahedron,
            _ if kind.is_linear() => Form::of_faces(kind),
            _ => Form::of_samples(kind),
        };
        Some(Self { node_count: kind.node_count(), form })
    }

    /// Of a cell between nodes at their places [m³]: negative where it is inside out.
    #[inline]
    pub fn at(&self, nodes: &[u32], places: &[Vec3]) -> f64 {
        match &self.form {
            Form::Tetrahedron => {
                let [_, a, b, c] = from_first(nodes, places);
                pyramid([a, b, c]) / 6.0
            }
            Form::Hexahedron => {
                let [_, b, c, d, e, f, g, h] = from_first(nodes, places);
                let at_first = pyramid([d, c, b]) + pyramid([b, f, e]) + pyramid([e, h, d]);
                (at_first + bent([e, f, g, h]) + bent([b, c, g, f]) + bent([c, d, h, g])) / 12.0
            }
            Form::Faces { triangles, at_first, quadrilaterals } => {
                let mut own = [Vec3::ZERO; MAX_NODES];
                let first = places[nodes[0] as usize];
                own.iter_mut().zip(nodes).for_each(|(own, node)| *own = places[*node as usize] - first);
                let place = |node: u8| own[usize::from(node)];
                let flat: f64 = triangles.iter().map(|nodes| pyramid(nodes.map(place))).sum();
                let half: f64 = at_first.iter().map(|nodes| pyramid(nodes.map(place))).sum();
                let bent: f64 = quadrilaterals.iter().map(|nodes| bent(nodes.map(place))).sum();
                (2.0 * flat + half + bent) / 12.0
            }
            Form::Samples(samples) => self.by_samples(samples, nodes, places),
        }
    }

    // V = Σ w det Σ x ⊗ ∂N/∂ξ
    fn by_samples(&self, samples: &[(f64, Vec<Vec3>)], nodes: &[u32], places: &[Vec3]) -> f64 {
        let mut own = [Vec3::ZERO; MAX_NODES];
        let own = &mut own[..self.node_count];
        own.iter_mut().zip(nodes).for_each(|(own, node)| *own = places[*node as usize]);
        let determinant = |gradients: &[Vec3]| {
            let mut columns = [Vec3::ZERO; 3];
            for (place, gradient) in own.iter().zip(gradients) {
                (0..3).for_each(|axis| columns[axis] += *place * gradient[axis]);
            }
            pyramid(columns)
        };
        samples.iter().map(|(weight, gradients)| weight * determinant(gradients)).sum()
    }
}

impl Form {
    fn of_faces(kind: ElementKind) -> Self {
        let (mut triangles, mut at_first, mut quadrilaterals) = (Vec::new(), Vec::new(), Vec::new());
        for face in kind.faces() {
            let first = face.nodes.iter().position(|node| *node == 0);
            match (&face.nodes[..], first) {
                (&[a, b, c], None) => triangles.push([a, b, c]),
                (&[a, b, c, d], None) => quadrilaterals.push([a, b, c, d]),
                (&[_, _, _, _], Some(at)) => {
                    at_first.push([1, 2, 3].map(|after: usize| face.nodes[(at + after) % 4]));
                }
                _ => {}
            }
        }
        Self::Faces { triangles, at_first, quadrilaterals }
    }

    fn of_samples(kind: ElementKind) -> Self {
        let points = volume_rule(kind).points.iter();
        Self::Samples(
            points
                .map(|point| (point.weight, kind.shape_gradients(point.position).iter().copied().collect()))
                .collect(),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Mesh;

    /// As the rule has it, of every kind, of cells that are bent, far from the origin, and turned over.
    #[test]
    fn volumes_are_those_of_the_rule() {
        for kind in ElementKind::ALL.iter().copied() {
            let Some(form) = SignedVolume::of(kind) else {
                assert!(kind.dimension() < 3);
                continue;
            };
            let nodes: Vec<u32> = (0..kind.node_count() as u32).collect();
            let shaken = |(number, node): (usize, &[f64; 3])| {
                let shake = |axis: usize| 0.11 * (1.7 * number as f64 + 2.3 * axis as f64).sin();
                Vec3::new(5.0 + node[0] + shake(0), node[1] + shake(1) - 3.0, node[2] + shake(2))
            };
            let places: Vec<Vec3> = kind.element().nodes.iter().enumerate().map(shaken).collect();
            for mirror in [1.0, -1.0] {
                let places: Vec<Vec3> =
                    places.iter().map(|place| Vec3::new(place.x, place.y, mirror * place.z)).collect();
                let mesh = Mesh::new(places, kind, nodes.clone());
                let (found, by_rule) = (form.at(&nodes, &mesh.points), mesh.cell_volumes()[0]);
                assert!(mirror * found > 0.0, "{}: {found}", kind.name());
                // products of lengths up to 7 m are rounded
                assert!((found - by_rule).abs() < 1e-12, "{}: {found}, by the rule {by_rule}", kind.name());
            }
        }
    }
}
