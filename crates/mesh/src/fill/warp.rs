//! Where the surface cuts edges of the lattice, and the lattice points that are moved onto it.
//!
//! A cut closer to a lattice point than a fraction `α` of its edge would make a sliver: the point is moved onto
//! the cut instead, and its edges are then cut no more. `α` is 0.24999 on long edges and 0.41189 on short ones,
//! for which the dihedral angles of the uniform lattice stay between 10.7° and 164.8° (Labelle & Shewchuk 2007,
//! Table 1, a proof by exhaustion with interval arithmetic).

use rayon::prelude::*;
use souple_math::Vec3;

use super::lattice::{Background, Place, Side};
use super::pinched;
use crate::implicit::Shape;

/// Fractions of the edge within which a cut moves its end.
const ALPHA_LONG: f64 = 0.24999;
const ALPHA_SHORT: f64 = 0.41189;
/// Of edges between cubes of two sizes: between the two, nothing is proven of it.
const ALPHA_HALVED: f64 = 0.3;

/// How exactly cuts are found, relative to the edge. The bounds on angles hold wherever a cut is.
const CUT_TOLERANCE: f64 = 1e-7;

/// An edge of the lattice with its ends on both sides of the surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cut {
    /// Lower number first.
    pub ends: [u32; 2],
    pub position: Vec3,
    /// From the first end, relative to the edge.
    fraction: f64,
}

/// The lattice after points have moved: sides of its points and the cuts that are left, ascending by ends.
pub(super) struct Warped {
    pub sides: Vec<Side>,
    pub cuts: Vec<Cut>,
}

/// Along how many axes the ends of an edge are apart: one of a long edge, three of a short one, two of an edge between cubes of
/// two sizes.
pub(super) fn axes_apart(a: Place, b: Place) -> usize {
    (0..3).filter(|axis| a[*axis] != b[*axis]).count()
}

/// Length of an edge, in halves of the smallest cube's edge, and that of the cubes that it belongs to; of an edge between cubes
/// of two sizes, the smaller ones.
fn lengths(a: Place, b: Place) -> [f64; 2] {
    let apart = [0, 1, 2].map(|axis| f64::from(a[axis].abs_diff(b[axis])));
    let length_sq: f64 = apart.iter().map(|d| d * d).sum();
    let cube = apart.into_iter().fold(0.0, f64::max);
    [length_sq.sqrt(), if axes_apart(a, b) == 3 { 2.0 * cube } else { cube }]
}

/// The smallest cube at each point, by its edge as in [`lengths`].
fn smallest_cubes(background: &Background) -> Vec<f64> {
    let mut smallest = vec![f64::INFINITY; background.points.len()];
    for tet in &background.tets {
        for (i, a) in tet.iter().enumerate() {
            for b in &tet[i + 1..] {
                let [_, cube] = lengths(background.places[*a as usize], background.places[*b as usize]);
                for end in [a, b] {
                    let least = &mut smallest[*end as usize];
                    *least = least.min(cube);
                }
            }
        }
    }
    smallest
}

/// Finds the cuts and moves points onto them, in the order of their numbers; points that would be pinched go back.
pub(super) fn warp(background: &mut Background, shape: &dyn Shape) -> Warped {
    let mut sides: Vec<Side> = background.values.iter().map(|value| Side::of(*value)).collect();
    let mut cuts = find_cuts(background, &sides, shape);
    let edges_of = incidence(background.points.len(), &cuts);
    let smallest = smallest_cubes(background);
    let mut moved: Vec<(u32, Vec3)> = Vec::new();
    for point in 0..background.points.len() {
        let edges = &edges_of.items[edges_of.starts[point] as usize..edges_of.starts[point + 1] as usize];
        let mut nearest: Option<(f64, Vec3)> = None;
        for edge in edges {
            let Cut { ends, position, fraction } = cuts[*edge as usize];
            if ends.iter().any(|end| sides[*end as usize] == Side::On) {
                continue;
            }
            let [a, b] = ends.map(|end| background.places[end as usize]);
            let from_here = if ends[0] as usize == point { fraction } else { 1.0 - fraction };
            let alpha = match axes_apart(a, b) {
                1 => ALPHA_LONG,
                2 => ALPHA_HALVED,
                _ => ALPHA_SHORT,
            };
            let [length, cube] = lengths(a, b);
            // the smaller cubes at a point are not to be flattened by what is cut off the larger ones
            let alpha = alpha * (smallest[point] / cube).min(1.0);
            if from_here < alpha && nearest.is_none_or(|(least, _)| from_here * length < least) {
                nearest = Some((from_here * length, position));
            }
        }
        if let Some((_, position)) = nearest {
            moved.push((point as u32, background.points[point]));
            background.points[point] = position;
            sides[point] = Side::On;
        }
    }
    let released = pinched::release(background, &mut sides);
    for point in &released {
        if let Ok(index) = moved.binary_search_by_key(point, |(point, _)| *point) {
            background.points[*point as usize] = moved[index].1;
        }
    }
    cuts.retain(|cut| cut.ends.iter().all(|end| sides[*end as usize] != Side::On));
    if !released.is_empty() {
        cut_in_middle(&mut cuts, background, &sides, &released);
    }
    Warped { sides, cuts }
}

/// Cuts the edges of points that were released in their middle: where they were cut, they would have been moved.
fn cut_in_middle(cuts: &mut Vec<Cut>, background: &Background, sides: &[Side], released: &[u32]) {
    let is_released = |point: &u32| released.binary_search(point).is_ok();
    cuts.retain(|cut| !cut.ends.iter().any(is_released));
    for tet in background.tets.iter().filter(|tet| tet.iter().any(is_released)) {
        for (i, a) in tet.iter().enumerate() {
            for b in &tet[i + 1..] {
                let both = [sides[*a as usize], sides[*b as usize]];
                let is_cut = both.contains(&Side::Inside) && both.contains(&Side::Outside);
                if is_cut && (is_released(a) || is_released(b)) {
                    let ends = [*a.min(b), *a.max(b)];
                    let [from, to] = ends.map(|end| background.points[end as usize]);
                    cuts.push(Cut { ends, position: (from + to) * 0.5, fraction: 0.5 });
                }
            }
        }
    }
    cuts.sort_unstable_by_key(|cut| cut.ends);
    cuts.dedup_by_key(|cut| cut.ends);
}

fn find_cuts(background: &Background, sides: &[Side], shape: &dyn Shape) -> Vec<Cut> {
    let mut edges: Vec<[u32; 2]> = Vec::new();
    for tet in &background.tets {
        for (i, a) in tet.iter().enumerate() {
            for b in &tet[i + 1..] {
                let both = [sides[*a as usize], sides[*b as usize]];
                if both.contains(&Side::Inside) && both.contains(&Side::Outside) {
                    edges.push([*a.min(b), *a.max(b)]);
                }
            }
        }
    }
    edges.par_sort_unstable();
    edges.dedup();
    let cut = |ends: &[u32; 2]| {
        let [a, b] = ends.map(|end| background.points[end as usize]);
        let values = ends.map(|end| background.values[end as usize]);
        let fraction = root(|t| shape.value(a + (b - a) * t), values);
        Cut { ends: *ends, position: a + (b - a) * fraction, fraction }
    };
    edges.par_iter().map(cut).collect()
}

/// Where a function of `[0, 1]` with ends of opposite signs passes zero: the false position method with Illinois'
/// correction, halved where it does not shrink the bracket fast enough.
fn root(function: impl Fn(f64) -> f64, [mut low_value, mut high_value]: [f64; 2]) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    for step in 0..60 {
        let width: f64 = high - low;
        if width <= CUT_TOLERANCE {
            break;
        }
        let secant = low - low_value * width / (high_value - low_value);
        // every third step halves: at most 3 log2(1/tolerance) steps whatever the function
        let middle = if step % 3 == 2 || !secant.is_finite() { 0.5 * (low + high) } else { secant };
        let middle = middle.clamp(low + 0.25 * CUT_TOLERANCE, high - 0.25 * CUT_TOLERANCE);
        let value = function(middle);
        if value == 0.0 {
            return middle;
        }
        if (value < 0.0) == (low_value < 0.0) {
            (low, low_value) = (middle, value);
            high_value *= 0.5;
        } else {
            (high, high_value) = (middle, value);
            low_value *= 0.5;
        }
    }
    0.5 * (low + high)
}

/// Cuts at each point.
struct Incidence {
    starts: Vec<u32>,
    items: Vec<u32>,
}

fn incidence(point_count: usize, cuts: &[Cut]) -> Incidence {
    let mut starts = vec![0_u32; point_count + 1];
    for end in cuts.iter().flat_map(|cut| cut.ends) {
        starts[end as usize + 1] += 1;
    }
    for point in 0..point_count {
        starts[point + 1] += starts[point];
    }
    let mut next = starts.clone();
    let mut items = vec![0; 2 * cuts.len()];
    for (index, cut) in cuts.iter().enumerate() {
        for end in cut.ends {
            items[next[end as usize] as usize] = index as u32;
            next[end as usize] += 1;
        }
    }
    Incidence { starts, items }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The root is found to the tolerance, for tame and for wild functions.
    #[test]
    fn roots() {
        type Case = (fn(f64) -> f64, f64);
        let cases: [Case; 4] = [
            (|t| t - 0.3, 0.3),
            (|t| 0.999 - t, 0.999),
            (|t| (t - 0.5).powi(9), 0.5),
            (|t| if t < 0.123 { -1e-9 } else { 1e6 }, 0.123),
        ];
        for (function, expected) in cases {
            let found = root(function, [function(0.0), function(1.0)]);
            // where a power is flat its value is zero to rounding over 1e-35 only
            assert!((found - expected).abs() <= CUT_TOLERANCE, "{found} for {expected}");
        }
    }
}
