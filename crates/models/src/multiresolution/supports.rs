//! Where a body is held, and which levels hold it there as the finest does.
//!
//! A coarse mesh may have two points where the finest has a whole patch: a hinge in the place of a clamp. There finer points stay at work.

use souple_math::{Mat3, Vec3, eigen_symmetric};

use super::links::Hierarchy;
use super::matter::Matter;

/// What one pin holds.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Support {
    /// Points of all meshes, by their numbers: those of the finest first, then those of the others from coarse to fine.
    pub points: Vec<u32>,
    pub axes: [bool; 3],
}

/// The radius of gyration of the held points of a level about each axis is at least this part of that of the finest mesh's.
const REACH: f64 = 0.5;
/// What is left of a length, of itself, below which it is rounding.
const ROUNDING: f64 = 1e-9;

/// All that holds a body.
#[derive(Clone, Debug, Default)]
pub struct Supports {
    /// Of each point, whether it is held along each axis; empty where nothing holds the body.
    pub held: Vec<[bool; 3]>,
    /// Of each level, whether it holds the body as the finest does.
    pub holds: Vec<bool>,
    /// Of each point, whether finer ones are always in its place, because its level does not hold what is held there.
    pub gives_way: Vec<bool>,
    /// Whether the finest mesh cannot move as one.
    pub is_fast: bool,
}

impl Supports {
    pub fn new(hierarchy: &Hierarchy, matter: &Matter, supports: &[Support]) -> Self {
        let mut made = Self {
            held: Vec::new(),
            holds: vec![true; hierarchy.level_count()],
            gives_way: vec![false; hierarchy.point_count()],
            is_fast: false,
        };
        if supports.is_empty() {
            return made;
        }
        made.held = vec![[false; 3]; hierarchy.point_count()];
        for support in supports {
            for point in &support.points {
                let held = &mut made.held[*point as usize];
                (0..3).for_each(|axis| held[axis] |= support.axes[axis]);
            }
            made.stay_fine(hierarchy, matter, support);
        }
        let finest = hierarchy.levels[hierarchy.finest()].clone();
        made.is_fast = holds_still(&hierarchy.rest[finest.clone()], &made.held[finest]);
        made
    }

    /// From the coarsest level on to the first that holds a support: what is around it gives way to finer points.
    fn stay_fine(&mut self, hierarchy: &Hierarchy, matter: &Matter, support: &Support) {
        let places = |level: usize| -> Vec<Vec3> {
            let of_level = hierarchy.levels[level].clone();
            let points = support.points.iter().map(|point| *point as usize);
            points.filter(|point| of_level.contains(point)).map(|point| hierarchy.rest[point]).collect()
        };
        let finest = places(hierarchy.finest());
        for level in 0..hierarchy.finest() {
            if holds_as(&places(level), &finest) {
                return;
            }
            self.holds[level] = false;
            for point in &support.points {
                let is_of_level = hierarchy.levels[level].contains(&(*point as usize));
                self.gives_way[*point as usize] |= is_of_level;
            }
            // tetrahedra that stand for held matter
            let tets = &hierarchy.tets[hierarchy.tets_of_level[hierarchy.finest()].clone()];
            for (cell, tet) in tets.iter().enumerate() {
                let Some(sample) = matter.slots[matter.slot_of_cell[level][cell] as usize] else { continue };
                if tet.corners.iter().any(|corner| support.points.binary_search(corner).is_ok()) {
                    let corners = hierarchy.tets[sample.tet as usize].corners;
                    corners.iter().for_each(|corner| self.gives_way[*corner as usize] = true);
                }
            }
        }
    }
}

/// `Σ (|y|² 1 - y yᵀ) / n` for `y = x - x̄`: about an axis `a` through the middle, `aᵀ J a` is the square of the radius of gyration [m²].
fn gyration(places: &[Vec3]) -> Mat3 {
    let share = 1.0 / places.len() as f64;
    let middle = places.iter().copied().sum::<Vec3>() * share;
    places
        .iter()
        .map(|place| *place - middle)
        .fold(Mat3::ZERO, |sum, y| sum + (Mat3::IDENTITY * y.length_sq() - y.outer(y)) * share)
}

/// Whether points resist turns about every axis as those of the finest mesh do: `J ≥ REACH² J_finest`.
fn holds_as(places: &[Vec3], finest: &[Vec3]) -> bool {
    if places.is_empty() || finest.is_empty() {
        return finest.is_empty();
    }
    let wanted = gyration(finest) * (REACH * REACH);
    let least = eigen_symmetric(&(gyration(places) + wanted * -1.0)).values;
    least.to_array().into_iter().all(|value| value >= -ROUNDING * wanted.trace())
}

/// Whether points held along axes hinder all six motions of a body that is rigid.
fn holds_still(places: &[Vec3], held: &[[bool; 3]]) -> bool {
    let size = places.iter().map(|place| (*place - places[0]).length()).fold(f64::MIN_POSITIVE, f64::max);
    let mut found: Vec<[f64; 6]> = Vec::new();
    for (place, axes) in places.iter().zip(held) {
        let arm = (*place - places[0]) * (1.0 / size);
        for axis in (0..3).filter(|axis| axes[*axis]) {
            let ([x, y, z], [u, v, w]) =
                (Vec3::AXES[axis].to_array(), arm.cross(Vec3::AXES[axis]).to_array());
            let mut row = [x, y, z, u, v, w];
            // the second time takes what rounding has left of the first
            for other in found.iter().chain(&found) {
                let share: f64 = row.iter().zip(other).map(|(a, b)| a * b).sum();
                row.iter_mut().zip(other).for_each(|(value, other)| *value -= share * other);
            }
            let length = row.iter().map(|value| value * value).sum::<f64>().sqrt();
            if length > ROUNDING.sqrt() {
                found.push(row.map(|value| value / length));
            }
            if found.len() == 6 {
                return true;
            }
        }
    }
    false
}

#[cfg(test)]
mod tests {
    use souple_math::Vec3;

    use super::{holds_as, holds_still};

    fn patch(cells: usize, size: f64) -> Vec<Vec3> {
        let at = |i: usize| size * i as f64 / cells as f64;
        (0..=cells).flat_map(|i| (0..=cells).map(move |j| Vec3::new(at(i), at(j), 0.0))).collect()
    }

    /// The radius of gyration of the corners of a square is more than that of the whole, that of two of them about their line is none.
    #[test]
    fn two_points_are_a_hinge() {
        let finest = patch(8, 1.0);
        assert!(holds_as(&patch(1, 1.0), &finest));
        assert!(holds_as(&finest, &finest));
        let corners = patch(1, 1.0);
        assert!(!holds_as(&corners[..2], &finest));
        assert!(holds_as(&corners[..3], &finest));
        assert!(!holds_as(&corners[..1], &finest));
        assert!(!holds_as(&[], &finest));
        // a patch that is far smaller gives way far sooner: (1/4)² of the square of its radius
        assert!(!holds_as(&patch(1, 0.25), &finest));
        // what is a hinge on the finest mesh may be one
        assert!(holds_as(&corners[..2], &finest[..9]));
        assert!(holds_as(&corners[..1], &finest[..1]));
    }

    #[test]
    fn three_points_hold_a_body() {
        let places = patch(1, 1.0);
        let all = [true; 3];
        assert!(holds_still(&places[..3], &[all; 3]));
        assert!(!holds_still(&places[..2], &[all; 2]));
        // a body that rests on a floor slides
        assert!(!holds_still(&places, &[[false, false, true]; 4]));
        assert!(!holds_still(&places, &[[false; 3]; 4]));
    }
}
