//! How the surface runs through a cell: marching cubes with a table made by rule.
//!
//! A face of a cell is cut by what its four signs say and nothing else: each run of inside corners around it is cut off
//! by itself. Both cells at a face therefore cut it alike, also where the signs alternate, and the surface closes. The cuts
//! of the six faces join into loops, each becomes triangles. A triangle's edge that is no cut runs through the cell, never
//! along a face, where the other cell might draw it too: so each edge has two triangles, and the surface is a manifold.

use std::sync::LazyLock;

/// The triangles of one pattern of signs: edges of the cell, counterclockwise seen from outside (where values are
/// negative).
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Case {
    pub triangles: Vec<[u8; 3]>,
    /// Edges cut, a bit for each.
    pub edges: u16,
}

/// For each pattern: bit `x + 2y + 4z` is set where that corner is inside.
pub static CASES: LazyLock<Vec<Case>> = LazyLock::new(|| (0..256).map(case).collect());

/// The edge along an axis whose lower corner is this.
pub const fn edge_number(axis: usize, corner: usize) -> usize {
    // the other two coordinates in their order
    let others = match axis {
        0 => corner >> 1,
        1 => (corner & 1) | (corner >> 2) << 1,
        _ => corner & 3,
    };
    4 * axis + others
}

/// Axis and lower corner of an edge.
pub const fn edge_place(edge: usize) -> (usize, usize) {
    let (axis, others) = (edge / 4, edge % 4);
    let corner = match axis {
        0 => others << 1,
        1 => (others & 1) | (others >> 1) << 2,
        _ => others,
    };
    (axis, corner)
}

/// Corners of the six faces, counterclockwise seen from outside of the cell.
const FACES: [[usize; 4]; 6] =
    [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];

fn edge_between(a: usize, b: usize) -> usize {
    let axis = (a ^ b).trailing_zeros() as usize;
    edge_number(axis, a.min(b))
}

/// Faces an edge is on, a bit for each.
fn faces_of(edge: usize) -> u8 {
    let (axis, low) = edge_place(edge);
    let high = low | 1 << axis;
    (0..6).filter(|f| FACES[*f].contains(&low) && FACES[*f].contains(&high)).map(|f| 1 << f).sum()
}

fn case(signs: usize) -> Case {
    let inside = |corner: usize| signs >> corner & 1 == 1;
    // where a cut that enters an edge goes on
    let mut next = [usize::MAX; 12];
    for face in FACES {
        for start in 0..4 {
            let at = |k: usize| face[(start + k) % 4];
            if inside(at(0)) || !inside(at(1)) {
                continue;
            }
            let end = (1..4).find(|k| inside(at(*k)) && !inside(at(k + 1))).expect("a run ends");
            next[edge_between(at(0), at(1))] = edge_between(at(end), at(end + 1));
        }
    }
    let mut case = Case::default();
    for start in 0..12 {
        let mut loop_edges = Vec::new();
        let mut edge = start;
        while next[edge] != usize::MAX {
            loop_edges.push(edge);
            case.edges |= 1 << edge;
            edge = std::mem::replace(&mut next[edge], usize::MAX);
        }
        if !loop_edges.is_empty() {
            let triangles = triangulate(&loop_edges).expect("each loop has triangles without edges on faces");
            case.triangles.extend(triangles);
        }
    }
    case
}

/// Triangles of a loop none of whose inner edges lies on a face of the cell.
fn triangulate(polygon: &[usize]) -> Option<Vec<[u8; 3]>> {
    let n = polygon.len();
    if n < 3 {
        return Some(Vec::new());
    }
    let is_free = |a: usize, b: usize| faces_of(a) & faces_of(b) == 0;
    // the triangle on the edge from the last to the first
    (1..n - 1).find_map(|middle| {
        let (a, b, c) = (polygon[0], polygon[middle], polygon[n - 1]);
        if (middle > 1 && !is_free(a, b)) || (middle < n - 2 && !is_free(b, c)) {
            return None;
        }
        let mut triangles = vec![[a as u8, b as u8, c as u8]];
        triangles.extend(triangulate(&polygon[..=middle])?);
        triangles.extend(triangulate(&polygon[middle..])?);
        Some(triangles)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_have_their_numbers() {
        for edge in 0..12 {
            let (axis, corner) = edge_place(edge);
            assert_eq!(edge_number(axis, corner), edge);
            assert_eq!(faces_of(edge).count_ones(), 2);
        }
    }

    /// Every cut edge is cut once, and the triangles of all patterns have the cell's edges and no others.
    #[test]
    fn triangles_use_the_edges_that_are_cut() {
        for (signs, case) in CASES.iter().enumerate() {
            let mut used = 0u16;
            case.triangles.iter().flatten().for_each(|edge| used |= 1 << edge);
            assert_eq!(used, case.edges);
            for edge in 0..12 {
                let (axis, low) = edge_place(edge);
                let cut = signs >> low & 1 != signs >> (low | 1 << axis) & 1;
                assert_eq!(cut, used >> edge & 1 == 1, "pattern {signs}, edge {edge}");
            }
            assert!(case.triangles.len() <= 5);
        }
    }

    /// One inside corner is cut off by a triangle that looks away from it.
    #[test]
    fn triangles_look_outward() {
        let case = &CASES[1];
        assert_eq!(case.triangles.len(), 1);
        let middle = |edge: u8| {
            let (axis, corner) = edge_place(edge.into());
            let mut place = [corner & 1, corner >> 1 & 1, corner >> 2].map(|c| c as f64);
            place[axis] += 0.5;
            souple_math::Vec3::from_array(place)
        };
        let [a, b, c] = case.triangles[0].map(middle);
        assert!((b - a).cross(c - a).dot(souple_math::Vec3::new(1.0, 1.0, 1.0)) > 0.0);
    }
}
