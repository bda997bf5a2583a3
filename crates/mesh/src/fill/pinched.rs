//! Points of the surface at which a filling would hang together by a point or an edge alone.
//!
//! A lattice point that is moved onto the surface may have inside on several sides of it with outside between: what is
//! filled would then be hinged there, and its boundary no manifold. Such a point is not moved after all: it stays in its place in
//! the lattice, on the side where the shape has it. Around points inside and around cuts the filling is a ball and half a
//! ball whatever the signs are, and each round leaves fewer points on the surface, so rounds end.

use super::lattice::{Background, Side};

/// A point of the curve in which the surface leaves a small ball: a point on the surface, twice, or the ends of a cut edge.
type Corner = [u32; 2];

/// Takes points off the surface until the filling is like half a ball around each that is left on it; those that were taken
/// off, ascending.
pub(super) fn release(background: &Background, sides: &mut [Side]) -> Vec<u32> {
    let around = Around::of(background, sides);
    let mut released = Vec::new();
    let mut candidates: Vec<u32> =
        (0..sides.len() as u32).filter(|point| sides[*point as usize] == Side::On).collect();
    while !candidates.is_empty() {
        let mut next = Vec::new();
        for point in candidates {
            let tets = around.tets(point);
            if sides[point as usize] != Side::On || is_half_ball(point, tets, background, sides) {
                continue;
            }
            let is_inside = background.values[point as usize] < 0.0;
            sides[point as usize] = if is_inside { Side::Inside } else { Side::Outside };
            released.push(point);
            next.extend(tets.iter().flat_map(|tet| background.tets[*tet as usize]));
        }
        next.sort_unstable();
        next.dedup();
        candidates = next;
    }
    released.sort_unstable();
    released
}

/// Whether what is filled around a point on the surface is like half a ball, or nothing, or a whole one: its surface leaves a
/// small ball in one closed curve that does not meet itself.
fn is_half_ball(point: u32, tets: &[u32], background: &Background, sides: &[Side]) -> bool {
    let mut curve: Vec<[Corner; 2]> = Vec::with_capacity(tets.len());
    for tet in tets {
        let others = background.tets[*tet as usize].into_iter().filter(|node| *node != point);
        curve.extend(segment(others, sides));
    }
    // a triangle on the surface with filling on both sides is inside of it
    curve.sort_unstable();
    let once: Vec<[Corner; 2]> =
        curve.chunk_by(|a, b| a == b).filter(|same| same.len() == 1).map(|same| same[0]).collect();
    is_one_cycle(&once)
}

/// The part of the curve in one tetrahedron, of which three corners are given.
fn segment(others: impl Iterator<Item = u32>, sides: &[Side]) -> Option<[Corner; 2]> {
    let (mut inside, mut on, mut outside) = (Vec::new(), Vec::new(), Vec::new());
    for node in others {
        match sides[node as usize] {
            Side::Inside => inside.push(node),
            Side::On => on.push(node),
            Side::Outside => outside.push(node),
        }
    }
    let cut = |p: u32, r: u32| [p.min(r), p.max(r)];
    let [a, b] = match (&inside[..], &on[..], &outside[..]) {
        ([_], [a, b], _) => [[*a, *a], [*b, *b]],
        ([p], [a], [r]) => [[*a, *a], cut(*p, *r)],
        ([p], _, [r, s]) => [cut(*p, *r), cut(*p, *s)],
        ([p, q], _, [r]) => [cut(*p, *r), cut(*q, *r)],
        _ => return None,
    };
    Some([a.min(b), a.max(b)])
}

/// Whether segments are one closed curve through each of its points once, or none at all.
fn is_one_cycle(segments: &[[Corner; 2]]) -> bool {
    let Some([start, first]) = segments.first() else { return true };
    let mut ends: Vec<[Corner; 2]> = segments.iter().flat_map(|[a, b]| [[*a, *b], [*b, *a]]).collect();
    ends.sort_unstable();
    if ends.chunk_by(|a, b| a[0] == b[0]).any(|of_one| of_one.len() != 2) {
        return false;
    }
    let (mut before, mut here, mut steps) = (*start, *first, 1);
    while here != *start {
        let at = ends.partition_point(|[corner, _]| *corner < here);
        let next = if ends[at][1] == before { ends[at + 1][1] } else { ends[at][1] };
        (before, here) = (here, next);
        steps += 1;
    }
    steps == segments.len()
}

/// Tetrahedra of the lattice at each point on the surface.
struct Around {
    starts: Vec<u32>,
    tets: Vec<u32>,
}

impl Around {
    fn of(background: &Background, sides: &[Side]) -> Self {
        let on_surface = |node: &u32| sides[*node as usize] == Side::On;
        let mut starts = vec![0_u32; sides.len() + 1];
        for node in background.tets.iter().flatten().copied().filter(on_surface) {
            starts[node as usize + 1] += 1;
        }
        for point in 0..sides.len() {
            starts[point + 1] += starts[point];
        }
        let mut next = starts.clone();
        let mut tets = vec![0; starts[sides.len()] as usize];
        for (index, tet) in background.tets.iter().enumerate() {
            for node in tet.iter().copied().filter(on_surface) {
                tets[next[node as usize] as usize] = index as u32;
                next[node as usize] += 1;
            }
        }
        Self { starts, tets }
    }

    fn tets(&self, point: u32) -> &[u32] {
        let [from, to] = [point, point + 1].map(|at| self.starts[at as usize] as usize);
        &self.tets[from..to]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One closed curve is one; two of them, a figure of eight and an open one are not.
    #[test]
    fn curves() {
        let of = |pairs: &[[u32; 2]]| -> Vec<[Corner; 2]> {
            pairs.iter().map(|pair| pair.map(|corner| [corner; 2])).collect()
        };
        assert!(is_one_cycle(&[]));
        assert!(is_one_cycle(&of(&[[0, 1], [1, 2], [0, 2]])));
        assert!(!is_one_cycle(&of(&[[0, 1], [1, 2], [0, 2], [3, 4], [4, 5], [3, 5]])));
        assert!(!is_one_cycle(&of(&[[0, 1], [1, 2], [0, 2], [0, 4], [4, 5], [0, 5]])));
        assert!(!is_one_cycle(&of(&[[0, 1], [1, 2]])));
    }
}
