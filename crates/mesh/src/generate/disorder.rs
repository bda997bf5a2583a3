//! Points moved at random, the same for the same seed: meshes without an order that hides what is wrong with an element.

use souple_math::Vec3;
use souple_table::{Parameter, Range, Value, Values};

/// Moves of points, one after another.
#[derive(Clone, Copy)]
pub(super) struct Disorder {
    /// The longest of them.
    amount: f64,
    state: u64,
}

impl Disorder {
    pub(super) const NONE: Self = Self { amount: 0.0, state: 0 };

    /// Of cells of cubes and rectangles. Points are moved by less than 0.2 in coordinates in which edges are one, so two of them
    /// come nearer to each other by less than 0.4 along any direction. A tetrahedron from half a face to the centre of its cube is the thinnest
    /// of all cells: between two parallel planes through all its nodes there is 0.408 at least. A pyramid is turned over nowhere
    /// unless such a half of it is; and `∂x/∂ξ` of squares, cubes and prisms is the identity and no more than 0.4 √3 < 1.
    pub(super) const PARAMETER: Parameter = Parameter {
        name: "disorder",
        summary: "how far points inside are moved at most, at random, over the edges of the regular cells; sides stay as they are, and no cell is turned over",
        range: Range::closed(0.0, 0.2),
        ..Self::OF_TRIANGLES
    };

    /// Of equilateral triangles.
    pub(super) const OF_TRIANGLES: Parameter = Parameter::number(
        "disorder",
        "",
        Range::closed(0.0, 0.25),
        "how far points inside are moved at most, at random, over the edge; up to 0.12 no angle is obtuse",
    )
    .or(Value::Number(0.0));

    pub(super) const SEED: Parameter =
        Parameter::integer("seed", Range::NOT_NEGATIVE, "which of the random moves").or(Value::Integer(1));

    pub(super) fn from_values(values: &Values) -> Self {
        Self { amount: values.number("disorder"), state: values.integer("seed") as u64 }
    }

    /// Evenly from 0 to 1 (Steele, Lea & Flood 2014, "Fast splittable pseudorandom number generators").
    fn uniform(&mut self) -> f64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut mixed = self.state;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((mixed ^ (mixed >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Evenly over a disc across z.
    pub(super) fn next_in_plane(&mut self) -> Vec3 {
        let (radius, angle) = (self.uniform().sqrt(), std::f64::consts::TAU * self.uniform());
        Vec3::new(radius * libm::cos(angle), radius * libm::sin(angle), 0.0) * self.amount
    }

    /// Evenly over a ball.
    pub(super) fn next_in_space(&mut self) -> Vec3 {
        let (radius, height) = (libm::cbrt(self.uniform()), 1.0 - 2.0 * self.uniform());
        let (across, angle) = ((1.0 - height * height).sqrt(), std::f64::consts::TAU * self.uniform());
        Vec3::new(across * libm::cos(angle), across * libm::sin(angle), height) * (radius * self.amount)
    }
}
