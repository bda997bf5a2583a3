//! The force between two things that touch: a penalty normal to the contact, Coulomb friction along it.
//!
//! With the gap `g`, the normal `n` from the other thing to the point, the penetration `p = -g > 0`, its rate
//! `ṗ = -n·v` for the relative velocity `v`, and the elastic stretch `s = (I - n nᵀ) (x - anchor)`:
//!
//! `N = k p (1 + d ṗ)₊` (Hunt & Crossley 1975: continuous at touch, never pulling),
//! `T = -k_t s` while `k_t |s| ≤ μ N` (sticking), else `T = -μ N s/|s|` (sliding).
//!
//! The anchor is memory. As a step is taken it is drawn along so that the stretch stays within what friction
//! can hold (return mapping); a point that touches nothing draws its anchor with it. Friction thus acts from
//! the first moment of a touch, in explicit and in implicit steps.

use souple_engine::{Editable, ParameterError, TangentWeights};
use souple_math::{Mat3, Real, Vec3};

use crate::loads::{Fit, LoadError, editable, not_negative, set_number};

/// Numbers of a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactLaw {
    /// Normal stiffness `k` of a point of share 1 [N/m].
    pub stiffness: f64,
    /// Hunt–Crossley damping `d` [s/m]: a collision at speed `u` gives back about `1 - 2/3 d u` of it.
    pub damping: f64,
    /// Coulomb's `μ`.
    pub friction: f64,
    /// Stiffness `k_t` of sticking, of a point of share 1 [N/m].
    pub tangential_stiffness: f64,
    /// Distance at which touching starts [m]: half the thickness of what is not drawn.
    pub thickness: f64,
}

/// What a contact gives [N], and how friction acts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactForce<R = f64> {
    pub normal: Vec3<R>,
    pub friction: Vec3<R>,
    /// `s` within what friction can hold [m].
    pub stretch: Vec3<R>,
    pub sliding: bool,
}

impl<R: Real> ContactForce<R> {
    pub fn total(&self) -> Vec3<R> {
        self.normal + self.friction
    }
}

/// `-∂f/∂x` [N/m] and `-∂f/∂v` [N s/m] of a contact with the normal force lagged: symmetric, positive semidefinite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LaggedStiffness {
    pub position: Mat3,
    pub velocity: Mat3,
}

impl LaggedStiffness {
    /// `a ∂f/∂x + b ∂f/∂v`.
    pub fn weighted(&self, weights: TangentWeights) -> Mat3 {
        self.position * -weights.position + self.velocity * -weights.velocity
    }
}

/// `E A / L`: the stiffness with which a column of the body of area `A` [m²] and length `L` [m] behind a point
/// resists [N/m]. Stiffer contacts cost steps, softer ones show penetration.
pub fn penalty_stiffness(youngs_modulus: f64, area: f64, length: f64) -> f64 {
    youngs_modulus * area / length
}

/// How one point of a contact stands.
#[derive(Clone, Copy, Debug)]
pub struct Approach<R> {
    /// Distance of the surfaces, thickness taken off [m]; negative: touching.
    pub gap: R,
    /// Unit, from the other thing to the point.
    pub normal: Vec3<R>,
    /// From the anchor to the point [m].
    pub from_anchor: Vec3<R>,
    /// Of the point relative to the other thing [m/s].
    pub velocity: Vec3<R>,
}

impl<R: Real> Approach<R> {
    /// `s = (I - n nᵀ) (x - anchor)`.
    fn stretch(&self) -> Vec3<R> {
        self.from_anchor - self.normal * self.normal.dot(self.from_anchor)
    }
}

impl ContactLaw {
    /// # Errors
    /// A number is negative or not finite.
    pub fn check(&self) -> Result<(), LoadError> {
        let fields = [
            ("stiffness", self.stiffness),
            ("damping", self.damping),
            ("friction", self.friction),
            ("tangential_stiffness", self.tangential_stiffness),
            ("thickness", self.thickness),
        ];
        fields.into_iter().try_for_each(|(field, value)| not_negative(field, value).map(|_| ()))
    }

    /// The stiffness of a touching point of share 1 in the direction where it is highest [N/m].
    pub(super) fn stiffest(&self) -> f64 {
        let sticking = if self.friction > 0.0 { self.tangential_stiffness } else { 0.0 };
        self.stiffness.max(sticking)
    }

    /// Whether a contact is minus the gradient of its energy.
    pub fn is_conservative(&self) -> bool {
        self.friction == 0.0 && self.damping == 0.0
    }

    /// The force on a point whose stiffness is `share` times that of the law; `None` where nothing touches.
    pub fn force<R: Real>(
        &self,
        share: f64,
        approach: &Approach<R>,
        value: impl Fn(R) -> f64,
    ) -> Option<ContactForce<R>> {
        if value(approach.gap) >= 0.0 {
            return None;
        }
        let n = approach.normal;
        // N = k p (1 + d ṗ)₊
        let pressed = -approach.gap * (self.stiffness * share);
        let slowing = -n.dot(approach.velocity) * self.damping + 1.0;
        let magnitude = if value(slowing) > 0.0 { pressed * slowing } else { pressed.zero() };
        let normal = n * magnitude;
        let none = n * magnitude.zero();
        let stiffness = self.tangential_stiffness * share;
        if self.friction == 0.0 || stiffness == 0.0 {
            return Some(ContactForce { normal, friction: none, stretch: none, sliding: false });
        }
        let stretch = approach.stretch();
        let limit = magnitude * self.friction;
        let length_sq = stretch.length_sq();
        let sliding = stiffness * stiffness * value(length_sq) > value(limit) * value(limit);
        let held = if sliding { stretch * (limit / (length_sq.sqrt() * stiffness)) } else { stretch };
        Some(ContactForce { normal, friction: held * (magnitude.splat(-stiffness)), stretch: held, sliding })
    }

    /// How the force falls with displacement and with velocity, the normal force that limits friction held fixed and
    /// the normal with it; `None` where nothing touches.
    ///
    /// What is left out is what makes the tangent of friction lose its symmetry: a slider's friction grows as it is
    /// pressed on, but it is not pressed on as it slides.
    pub fn lagged_stiffness(&self, share: f64, approach: &Approach<f64>) -> Option<LaggedStiffness> {
        let force = self.force(share, approach, |number| number)?;
        let n = approach.normal;
        let along_normal = n.outer(n);
        // ∂N/∂p = k (1 + d ṗ)₊,  ∂N/∂ṗ = k p d
        let pressed = -approach.gap * self.stiffness * share;
        let magnitude = n.dot(force.normal);
        let damping = if magnitude > 0.0 { pressed * self.damping } else { 0.0 };
        // sticking: k_t across the normal; sliding: μN/|s| across the stretch too
        let stretch = approach.stretch();
        let mut across_normal = Mat3::IDENTITY + along_normal * -1.0;
        let mut friction = self.tangential_stiffness * share;
        if self.friction == 0.0 {
            friction = 0.0;
        } else if force.sliding {
            friction = self.friction * magnitude / stretch.length();
            across_normal += stretch.outer(stretch) * (-1.0 / stretch.length_sq());
        }
        Some(LaggedStiffness {
            position: along_normal * (magnitude / -approach.gap) + across_normal * friction,
            velocity: along_normal * damping,
        })
    }

    /// `½ k p² + |T|²/(2 k_t)` of a touching point [J].
    pub fn stored(&self, share: f64, approach: &Approach<f64>) -> f64 {
        self.force(share, approach, |number| number).map_or(0.0, |force| {
            let pressed = 0.5 * self.stiffness * approach.gap * approach.gap;
            share * (pressed + 0.5 * self.tangential_stiffness * force.stretch.length_sq())
        })
    }

    /// The stretch that the anchor is left with, and the heat of the step that ends so [J].
    ///
    /// `remembered` is the stretch left by the step before. Friction's heat is its work less what its spring
    /// stores, `½ (T₀ + T₁)·(s - s₀) - Δ(½ k_t s²)`: nothing while sticking, `T |s - s₀|` while sliding, the
    /// spring's energy as a touch ends.
    pub fn advance(
        &self,
        share: f64,
        approach: &Approach<f64>,
        remembered: Vec3,
        timestep: f64,
    ) -> (Vec3, f64) {
        let (stretch, damped) = match self.force(share, approach, |number| number) {
            Some(force) => {
                let pressed = -self.stiffness * share * approach.gap;
                let rate = -approach.normal.dot(approach.velocity);
                (force.stretch, (force.normal.dot(approach.normal) - pressed) * rate * timestep)
            }
            None => (Vec3::ZERO, 0.0),
        };
        let moved = approach.stretch() - remembered;
        let work = 0.5 * (remembered + stretch).dot(moved);
        let stored = 0.5 * (stretch.length_sq() - remembered.length_sq());
        (stretch, damped + self.tangential_stiffness * share * (work - stored))
    }

    pub(super) fn editable(&self) -> Vec<Editable> {
        vec![
            editable("stiffness", "N/m", self.stiffness),
            editable("damping", "s/m", self.damping),
            editable("friction", "", self.friction),
            editable("tangential_stiffness", "N/m", self.tangential_stiffness),
            editable("thickness", "m", self.thickness),
        ]
    }

    pub(super) fn set_parameter(
        &mut self,
        force: &str,
        name: &str,
        value: f64,
    ) -> Result<(), ParameterError> {
        let numbers = &mut [
            ("stiffness", &mut self.stiffness, Fit::NotNegative),
            ("damping", &mut self.damping, Fit::NotNegative),
            ("friction", &mut self.friction, Fit::NotNegative),
            ("tangential_stiffness", &mut self.tangential_stiffness, Fit::NotNegative),
            ("thickness", &mut self.thickness, Fit::NotNegative),
        ];
        set_number(force, numbers, name, value)
    }
}
