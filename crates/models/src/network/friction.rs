//! Dry friction between balls, which have no surface: a hook between virtual points while they stick, Coulomb's force while
//! they slide.
//!
//! The pair feels a torque `D |F_t|` that no ball can bear, since balls do not spin: small against bodies made of many.

use souple_math::Vec3;

/// Numbers of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Friction {
    /// `K_t` of the hook [N/m].
    pub stiffness: f64,
    /// `Z_t = z_t/Te` of the hook [N/m].
    pub damping: f64,
    /// `μ_s`: the hook tears when it pulls by more of the normal force.
    pub sticking: f64,
    /// `μ_c` while sliding.
    pub sliding: f64,
    /// Below this displacement across in a step, sliding ends, `V_s = v_s Te` [m].
    pub slow: f64,
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
        let Some(u) = d.try_normalised().filter(|_| normal > 0.0) else {
            return Grip { force: Vec3::ZERO, next: Hook::FREE, heat: 0.0, stored: 0.0 };
        };
        let moved = d - before;
        let across = moved - u * moved.dot(u);
        let mut next = hook;
        if hook.phase != Phase::Stick {
            let is_slow = across.length() <= self.slow;
            next = Hook { phase: if is_slow { Phase::Stick } else { Phase::Slide }, began: d };
        }
        if next.phase == Phase::Stick {
            // D_acc = -(w0 - (w0·u) u),  F_t = -K_t D_acc - Z_t V_tg
            let stretch = next.began * -1.0 + u * next.began.dot(u);
            let force = -(stretch * self.stiffness) - across * self.damping;
            if force.length() < self.sticking * normal {
                let stored = 0.5 * self.stiffness * stretch.length_sq();
                let heat = self.damping * across.length_sq();
                return Grip { force, next, heat, stored };
            }
            next.phase = Phase::Slide;
        }
        let force = across.try_normalised().map_or(Vec3::ZERO, |along| along * (-self.sliding * normal));
        Grip { force, next, heat: -force.dot(across), stored: 0.0 }
    }
}
