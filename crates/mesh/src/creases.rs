//! Which sides of triangles are seen as edges.

use souple_math::Vec3;

/// Sine of the angle between two triangles of one plane, at most: far above rounding of normals, far below what is seen.
const FLAT: f64 = 1e-6;

/// Sides of triangles, each once, its lower number first, but for those between two that lie in one plane: these are of one face. A side of one triangle or of
/// more than two is seen, as is that of a triangle without area.
pub fn creases(triangles: &[[u32; 3]], points: &[Vec3]) -> Vec<[u32; 2]> {
    let sides = |corners: &[u32; 3]| {
        let [a, b, c] = corners.map(|corner| points[corner as usize]);
        let normal = (b - a).cross(c - a).try_normalised();
        let [a, b, c] = *corners;
        [[a, b], [b, c], [c, a]].map(|[from, to]| ([from.min(to), from.max(to)], normal))
    };
    let mut all: Vec<([u32; 2], Option<Vec3>)> = triangles.iter().flat_map(sides).collect();
    all.sort_by_key(|(ends, _)| *ends);
    let is_seen = |same: &&[([u32; 2], Option<Vec3>)]| match same {
        [(_, Some(one)), (_, Some(other))] => one.cross(*other).length() > FLAT || one.dot(*other) < 0.0,
        _ => true,
    };
    all.chunk_by(|a, b| a.0 == b.0).filter(is_seen).map(|same| same[0].0).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of a roof of two squares, each cut in two, the cuts are not seen.
    #[test]
    fn cuts_of_faces_are_not_seen() {
        let points = [
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [1.0, 1.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, 0.0, 1.0],
            [1.0, 0.0, 1.0],
        ]
        .map(|[x, y, z]| Vec3::new(x, y, z));
        let seen = creases(&[[0, 1, 2], [0, 2, 3], [0, 5, 1], [0, 4, 5]], &points);
        assert_eq!(seen, [[0, 1], [0, 3], [0, 4], [1, 2], [1, 5], [2, 3], [4, 5]]);
        // a sheet folded on itself has its fold
        assert_eq!(creases(&[[0, 1, 2], [2, 1, 0]], &points).len(), 3);
    }
}
