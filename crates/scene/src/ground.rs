//! Balls that stand for ground and walls.

use souple_mesh::{BoundingBox, Mesh};

/// Of each point of a network with these radii, none of other bodies, whether it stands for ground or a wall: a ball whose radius is more than
/// a hundred times what all smaller ones together span, which no link joins. Where others touch it, it is nearly a plane, and
/// pictures make no more room for it than for one.
pub fn grounds(mesh: &Mesh, radii: &[f64]) -> Vec<bool> {
    if radii.is_empty() {
        return Vec::new();
    }
    let mut is_ground = vec![false; radii.len()];
    // masses without a size span nothing
    let mut order: Vec<usize> = (0..radii.len()).filter(|point| radii[*point] > 0.0).collect();
    order.sort_by(|a, b| radii[*a].total_cmp(&radii[*b]));
    let mut span = BoundingBox::EMPTY;
    let first = order.iter().position(|point| {
        let is_larger = span != BoundingBox::EMPTY && radii[*point] > MUCH_LARGER * span.diagonal();
        span = span.union(BoundingBox::of([mesh.points[*point]]).grown(radii[*point]));
        is_larger
    });
    order[first.unwrap_or(order.len())..].iter().for_each(|point| is_ground[*point] = true);
    mesh.cells().flat_map(|cell| cell.nodes).for_each(|point| is_ground[*point as usize] = false);
    is_ground
}

/// In diagonals of what all smaller balls span: a radius of ten kilometres under an object of some metres is some thousand.
const MUCH_LARGER: f64 = 100.0;

#[cfg(test)]
mod tests {
    use souple_math::Vec3;

    use super::*;

    /// Two small balls on one of ten kilometres and beside another; neither masses without a size nor a kernel that its
    /// dermis lies around.
    #[test]
    fn grounds_are_much_larger_than_all_else() {
        let grounds_of = |places: &[[f64; 3]], radii: &[f64]| {
            let points = places.iter().map(|place| Vec3::from_array(*place)).collect();
            grounds(&Mesh { points, ..Mesh::default() }, radii)
        };
        let places = [[0.0, 0.0, 0.5], [0.0, 0.0, -1e4], [1.0, 0.0, 0.5], [1e4 + 9.0, 0.0, 0.0]];
        assert_eq!(grounds_of(&places, &[0.5, 5e3, 0.5, 5e3]), [false, true, false, true]);
        assert_eq!(grounds_of(&places, &[0.0; 4]), [false; 4]);
        assert_eq!(grounds_of(&[[0.0; 3], [0.0, 0.0, 1.1]], &[1.0, 0.1]), [false; 2]);
        // a nail without a size beside balls, and a marble beside a large one
        assert_eq!(grounds_of(&places[..3], &[0.0, 0.5, 0.5]), [false; 3]);
        assert_eq!(grounds_of(&places[..2], &[0.01, 0.5]), [false; 2]);
    }
}
