//! Dry friction between balls, which have no surface: a hook between virtual points while they stick, Coulomb's force while
//! they slide, or one that depends on the speed.
//!
//! The pair feels a torque `D |F_t|` that no ball can bear, since balls do not spin: small against bodies made of many.

use souple_math::Vec3;

/// Numbers of a surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Friction {
    /// `K_t` of the hook [N/m].
    pub stiffness: f64,
    /// `Z_t = z_t/Te` of the hook [N/m].
    pub damping: f64,
    /// `μ_s`: the hook tears when it pulls by more of the normal force.
    pub sticking: f64,
    /// While sliding, by how fast.
    pub slide: Slide,
    /// `z/(k Te + z)` of a hook that is a spring and a damper in series: what it keeps of its stretch in a step. One of a spring
    /// alone.
    pub hold: f64,
    /// Below this displacement across in a step, sliding ends, `V_s = v_s Te` [m].
    pub slow: f64,
}

/// The tangential force of a pair that slides, as a share of the normal force, by its displacement across in a step.
#[derive(Clone, Debug, PartialEq)]
pub enum Slide {
    /// `μ_c`, at any speed.
    Coulomb(f64),
    /// `μ_c + (μ_s - μ_c) e^{-|v|/v_b} + c |v|`: falls from the static coefficient, as under a bow, and rises again where a film
    /// is sheared, as under a ski.
    Stribeck {
        kinetic: f64,
        sticking: f64,
        /// `v_b Te` [m].
        fall: f64,
        /// `c/Te` [1/m].
        growth: f64,
    },
    /// Through points (displacement in a step [m], coefficient), straight on beyond the last.
    Curve(Vec<[f64; 2]>),
}

impl Slide {
    /// The coefficient at a displacement in a step [m].
    pub fn coefficient(&self, slip: f64) -> f64 {
        match self {
            Self::Coulomb(kinetic) => *kinetic,
            Self::Stribeck { kinetic, sticking, fall, growth } => {
                kinetic + (sticking - kinetic) * libm::exp(-slip / fall) + growth * slip
            }
            Self::Curve(points) => {
                let next = points.partition_point(|[at, _]| *at <= slip).clamp(1, points.len() - 1);
                let ([from, start], [to, end]) = (points[next - 1], points[next]);
                (start + (end - start) * (slip - from) / (to - from)).max(0.0)
            }
        }
    }
}

/// Whether a pair is free, sticks or slides: what it remembers beside `D0 u0`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    Free,
    Stick,
    Slide,
}

/// What friction remembers of a pair.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hook {
    pub phase: Phase,
    /// `D0 u0` when sticking began [m].
    pub began: Vec3,
}

/// What friction does to a pair.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grip {
    /// On the first ball [N].
    pub force: Vec3,
    pub next: Hook,
    /// Given off in the step [J].
    pub heat: f64,
    /// In the hook [J].
    pub stored: f64,
}

impl Hook {
    pub const FREE: Self = Self { phase: Phase::Free, began: Vec3::ZERO };

    /// From the numbers of a pair.
    pub fn from_numbers([phase, x, y, z]: [f64; 4]) -> Self {
        let phase = match phase {
            1.0 => Phase::Stick,
            2.0 => Phase::Slide,
            _ => Phase::Free,
        };
        Self { phase, began: Vec3::new(x, y, z) }
    }

    pub fn numbers(self) -> [f64; 4] {
        let phase = match self.phase {
            Phase::Free => 0.0,
            Phase::Stick => 1.0,
            Phase::Slide => 2.0,
        };
        [phase, self.began.x, self.began.y, self.began.z]
    }
}

impl Friction {
    /// Of a pair at `d = D u` that was at `before`, pressed together by `normal`.
    pub fn grip(&self, hook: Hook, d: Vec3, before: Vec3, normal: f64) -> Grip {
        match d.try_normalised() {
            Some(u) if normal > 0.0 => self.grip_along(u, hook, d, before, normal),
            _ => Grip { force: Vec3::ZERO, next: Hook::FREE, heat: 0.0, stored: 0.0 },
        }
    }

    /// The same with `u` known and a pressure that is positive.
    #[inline]
    pub(super) fn grip_along(&self, u: Vec3, hook: Hook, d: Vec3, before: Vec3, normal: f64) -> Grip {
        let moved = d - before;
        let across = moved - u * moved.dot(u);
        let mut next = hook;
        if hook.phase != Phase::Stick {
            let is_slow = across.length() <= self.slow;
            next = Hook { phase: if is_slow { Phase::Stick } else { Phase::Slide }, began: d };
        }
        if next.phase == Phase::Stick {
            // D_acc = -B (w0 - (w0·u) u),  F_t = -K_t D_acc - Z_t V_tg
            let stretch = (next.began * -1.0 + u * next.began.dot(u)) * self.hold;
            let force = -(stretch * self.stiffness) - across * self.damping;
            if force.length() < self.sticking * normal {
                // what flowed out of the spring of a hook in series is where the hook begins now
                next.began = u * next.began.dot(u) - stretch;
                let stored = 0.5 * self.stiffness * stretch.length_sq();
                let flowed = self.stiffness * stretch.length_sq() * (1.0 / self.hold - 1.0);
                let heat = self.damping * across.length_sq() + flowed;
                return Grip { force, next, heat, stored };
            }
            next.phase = Phase::Slide;
        }
        let slip = across.length();
        let force = match across.try_normalised() {
            Some(along) => along * (-self.slide.coefficient(slip) * normal),
            None => Vec3::ZERO,
        };
        Grip { force, next, heat: -force.dot(across), stored: 0.0 }
    }
}
