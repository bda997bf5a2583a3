//! The Lennard-Jones family: a deep well at one distance, smooth on both sides.

use souple_math::Real;
use souple_table::{Parameter, Range, Value};

use crate::network::kernel::InLanes;
use crate::network::law::{LinkEntry, LinkLaw, MEMORY, Reach, Response};

/// `V = -E0 [2 (r0/D)^n - (r0/D)^2n]`, `φ = E0 (2n/r0) [(r0/D)^(2n+1) - (r0/D)^(n+1)]`.
#[derive(Clone, Copy, Debug)]
struct LennardJones {
    /// `E0` [J].
    depth: f64,
    /// `r0` [m].
    distance: f64,
    exponent: u32,
}

impl LinkLaw for LennardJones {
    #[inline(always)]
    fn respond<R: Real>(&self, reach: &Reach<R>, _: &mut [R; MEMORY]) -> Response<R> {
        let ratio = reach.length.splat(self.distance) / reach.length;
        let mut power = ratio;
        for _ in 1..self.exponent {
            power = power * ratio;
        }
        let force = self.depth * 2.0 * f64::from(self.exponent) / self.distance;
        Response {
            push: (power - 1.0) * power * ratio * force,
            stored: (power - 2.0) * power * self.depth,
            heat: power.zero(),
        }
    }

    fn is_conservative(&self) -> bool {
        true
    }

    fn rest_distance(&self) -> Option<f64> {
        Some(self.distance)
    }

    // 2 n² E0 / r0², at rest
    fn stiffest(&self) -> f64 {
        2.0 * self.depth * (f64::from(self.exponent) / self.distance).powi(2)
    }
}

pub const ENTRY: LinkEntry = LinkEntry {
    name: "lennard_jones",
    summary: "a well of potential at one distance: cohesion and exclusion in one smooth law",
    source: "Jimenez 1993, P2-III.1.2",
    parameters: &[
        Parameter::number("depth", "J", Range::POSITIVE, "E0: energy to part a pair"),
        Parameter::number("distance", "m", Range::POSITIVE, "r0: at rest"),
        Parameter::integer("exponent", Range::closed(1.0, 24.0), "n of attraction; repulsion has 2n")
            .or(Value::Integer(6)),
    ],
    build: |making| {
        Ok(Box::new(InLanes(LennardJones {
            depth: making.values.number("depth"),
            distance: making.values.number("distance"),
            exponent: making.values.integer("exponent") as u32,
        })))
    },
};
