//! What all implicit formulas of time have in common.

/// How velocities and accelerations at the end of a step follow from the displacement `d = difference(q', q)` in it:
///
/// `v' = a d + v₀` over velocity blocks, `ẍ' = b (ẋ' - p)` over rows,
///
/// where `v₀` and `p` follow from what was before the step. Backward Euler has `a = b = 1/h`, `v₀ = 0` and `p = v`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rates {
    /// `a` [1/s]; zero where nothing moves in time.
    pub velocity: f64,
    /// `b` [1/s]; zero where mass does not resist.
    pub acceleration: f64,
}

impl Rates {
    /// `v' = 0`: equilibrium without time.
    pub const STATIC: Self = Self { velocity: 0.0, acceleration: 0.0 };

    /// `v' = d/h`, without inertia.
    pub fn creeping(timestep: f64) -> Self {
        Self { velocity: 1.0 / timestep, acceleration: 0.0 }
    }

    /// `v' = d/h`, `ẍ' = (ẋ' - ẋ)/h`.
    pub fn backward_euler(timestep: f64) -> Self {
        Self { velocity: 1.0 / timestep, acceleration: 1.0 / timestep }
    }

    pub fn has_inertia(&self) -> bool {
        self.acceleration != 0.0
    }

    pub fn has_velocity(&self) -> bool {
        self.velocity != 0.0
    }

    /// `∂ẍ'/∂d` of a point [1/s²].
    pub fn inertia(&self) -> f64 {
        self.velocity * self.acceleration
    }

    /// The factor `c` for which `½ c |ẋ' - p|²` has the gradient `ẍ'` by `d`.
    pub fn potential(&self) -> f64 {
        self.acceleration / self.velocity
    }
}
