//! The angle at a mass between the segments to two others, which is told.

use std::f64::consts::{PI, TAU};

use souple_formal::Formula;
use souple_math::{Mat3, Vec3};

use super::{Relation, first_row};

/// Sine below which segments count as in one line: half the digits of a direction are rounding then.
const IN_LINE: f64 = 1e-7;

/// `g = θ − θ₀(t)` of the angle `θ` from `u = x_a − x_b` to `w = x_c − x_b`. Its multiplier is the couple that opens it [N m].
///
/// About an axis `n` it is that of what of `u` and `w` is across `n`, counterclockwise seen against it, and told beyond whole turns: `g` is the least of
/// what is off by them. Without an axis it is between 0 and π, and has no gradient at either end.
#[derive(Clone, Debug)]
pub struct Angle {
    /// `a`, the corner `b`, and `c`.
    pub rows: [u32; 3],
    /// Of length 1.
    pub axis: Option<Vec3>,
    /// Of time [rad].
    pub angle: Formula,
}

/// Segments across an axis, as they stand.
struct Legs {
    axis: Vec3,
    u: Vec3,
    w: Vec3,
}

impl Angle {
    fn legs(&self, positions: &[Vec3]) -> Legs {
        let [a, b, c] = self.rows.map(|row| positions[row as usize]);
        let (u, w) = (a - b, c - b);
        match self.axis {
            Some(axis) => {
                let flat = |leg: Vec3| leg - axis * axis.dot(leg);
                Legs { axis, u: flat(u), w: flat(w) }
            }
            // no axis where they are in one line: there is no direction in which the angle changes smoothly
            None => Legs { axis: u.cross(w).try_normalised().unwrap_or(Vec3::ZERO), u, w },
        }
    }

    /// Whether there is an angle, and a direction that opens it: no segment along the axis and, without one, none in line with the other, up to
    /// a ten-millionth of their lengths.
    pub fn is_defined(&self, positions: &[Vec3]) -> bool {
        let [a, b, c] = self.rows.map(|row| positions[row as usize]);
        let (u, w) = (a - b, c - b);
        let crossed = |v: Vec3, by: Vec3| v.cross(by).length() > IN_LINE * v.length() * by.length();
        match self.axis {
            Some(axis) => crossed(u, axis) && crossed(w, axis),
            None => crossed(u, w),
        }
    }

    /// The angle as it stands [rad].
    pub fn at(&self, positions: &[Vec3]) -> f64 {
        let Legs { axis, u, w } = self.legs(positions);
        axis.dot(u.cross(w)).atan2(u.dot(w))
    }
}

impl Relation for Angle {
    fn rows(&self) -> &[u32] {
        &self.rows
    }

    fn value(&self, positions: &[Vec3], time: f64) -> Vec3 {
        let off = self.at(positions) - self.angle.evaluate(&[time]);
        let whole_turns = if self.axis.is_some() { TAU * (off / TAU).round() } else { 0.0 };
        Vec3::X * (off - whole_turns)
    }

    fn period(&self) -> f64 {
        if self.axis.is_some() { TAU } else { 0.0 }
    }

    // ∂θ/∂u = −n × u/|u|², ∂θ/∂w = n × w/|w|²; how n turns with both changes nothing
    fn add_gradients(&self, positions: &[Vec3], _time: f64, gradients: &mut Vec<Mat3>) {
        let Legs { axis, u, w } = self.legs(positions);
        let turned = |leg: Vec3| {
            let square = leg.length_sq();
            if square > 0.0 { axis.cross(leg) / square } else { Vec3::ZERO }
        };
        let (of_a, of_c) = (-turned(u), turned(w));
        gradients.extend([of_a, -(of_a + of_c), of_c].map(first_row));
    }

    fn time_rate(&self, _positions: &[Vec3], time: f64) -> Vec3 {
        Vec3::X * -self.angle.differentiate(&[time], 0).derivative
    }

    fn magnitude(&self, _positions: &[Vec3], time: f64) -> Vec3 {
        Vec3::X * (PI + self.angle.evaluate(&[time]).abs())
    }

    fn is_lost_between(&self, from: &[Vec3], to: &[Vec3]) -> Option<&'static str> {
        let across = |positions: &[Vec3]| {
            let Legs { u, w, .. } = self.legs(positions);
            u.cross(w)
        };
        (self.axis.is_none() && across(from).dot(across(to)) <= 0.0).then_some(
            "gives way until its segments are in one line, where no direction opens it: tell its `axis`",
        )
    }

    fn describe(&self) -> String {
        "an angle".to_owned()
    }
}
