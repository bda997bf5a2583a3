//! A stop that is the stiffer the deeper.

use souple_math::Real;
use souple_table::{Parameter, Range};

use super::stop::{STIFFNESS, THRESHOLD};
use crate::network::kernel::InLanes;
use crate::network::law::{LinkEntry, LinkLaw, MEMORY, Reach, Response};

/// `φ = K d (e^{(S - D)/d} - 1)` for `D < S`: the stiffer the deeper.
#[derive(Clone, Copy, Debug)]
struct ExponentialStop {
    threshold: f64,
    stiffness: f64,
    /// `d` [m].
    depth: f64,
}

impl LinkLaw for ExponentialStop {
    #[inline(always)]
    fn respond<R: Real>(&self, reach: &Reach<R>, _: &mut [R; MEMORY]) -> Response<R> {
        let zero = reach.length.zero();
        let depth = (-(reach.length - self.threshold)).max(zero);
        let scaled = depth * (1.0 / self.depth);
        let grown = scaled.exp() - 1.0;
        let force = self.stiffness * self.depth;
        // ∫ φ dD = K d² (e^x - 1 - x)
        Response { push: grown * force, stored: (grown - scaled) * (force * self.depth), heat: zero }
    }

    fn is_conservative(&self) -> bool {
        true
    }

    fn stiffest(&self) -> f64 {
        // at a depth of d, twice of which a stop is hardly meant to see
        self.stiffness * std::f64::consts::E
    }

    fn range(&self) -> f64 {
        self.threshold
    }

    fn rest_distance(&self) -> Option<f64> {
        Some(self.threshold)
    }
}

pub const ENTRY: LinkEntry = LinkEntry {
    name: "exponential_stop",
    summary: "pushes while closer than the threshold, the stiffer the deeper",
    source: "Jimenez 1993, P2-III.1.1, with the sign mended",
    parameters: &[
        THRESHOLD,
        STIFFNESS,
        Parameter::number("depth", "m", Range::POSITIVE, "d: over which the stiffness grows e times"),
    ],
    build: |making| {
        Ok(Box::new(InLanes(ExponentialStop {
            threshold: making.values.number("threshold"),
            stiffness: making.values.number("stiffness"),
            depth: making.values.number("depth"),
        })))
    },
};
