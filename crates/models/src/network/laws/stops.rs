//! Balls and bubbles: links that act only while two points are too close, or too far apart.

use souple_math::Real;
use souple_table::{Parameter, Range, Value};

use crate::network::kernel::InLanes;
use crate::network::law::{LinkEntry, LinkLaw, MEMORY, Reach, Response};

/// On which side of the threshold a stop acts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Zone {
    /// Below: a ball that nothing enters.
    Inside,
    /// Above: a bubble that nothing leaves.
    Outside,
}

/// With the depth `p` beyond the threshold and its growth in a step `p - p^r`: `f = K p + Z (p - p^r)`, a push in a ball
/// and a pull in a bubble, while `p > 0`.
#[derive(Clone, Copy, Debug)]
struct Stop {
    zone: Zone,
    /// `S` [m].
    threshold: f64,
    /// [N/m]
    stiffness: f64,
    /// `z/Te` [N/m].
    damping: f64,
    /// Whether damping may hold back what leaves.
    pulls: bool,
}

impl Stop {
    #[inline(always)]
    fn depth<R: Real>(&self, length: R) -> R {
        match self.zone {
            Zone::Inside => -(length - self.threshold),
            Zone::Outside => length - self.threshold,
        }
    }
}

impl LinkLaw for Stop {
    #[inline(always)]
    fn respond<R: Real>(&self, reach: &Reach<R>, _: &mut [R; MEMORY]) -> Response<R> {
        let (depth, before) = (self.depth(reach.length), self.depth(reach.before));
        let zero = depth.zero();
        let grown = depth - before;
        let mut force = depth * self.stiffness + grown * self.damping;
        if !self.pulls {
            force = force.max(zero);
        }
        let force = zero.select_less(depth, force, zero);
        let elastic = depth.max(zero) * self.stiffness;
        let push = match self.zone {
            Zone::Inside => force,
            Zone::Outside => -force,
        };
        Response { push, stored: elastic * depth.max(zero) * 0.5, heat: (force - elastic) * grown }
    }

    fn is_conservative(&self) -> bool {
        self.damping == 0.0
    }

    fn stiffest(&self) -> f64 {
        self.stiffness + 2.0 * self.damping
    }

    fn range(&self) -> f64 {
        match self.zone {
            Zone::Inside => self.threshold,
            Zone::Outside => f64::INFINITY,
        }
    }

    fn rest_distance(&self) -> Option<f64> {
        (self.zone == Zone::Inside).then_some(self.threshold)
    }
}

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

const THRESHOLD: Parameter =
    Parameter::number("threshold", "m", Range::POSITIVE, "S: the distance at which it begins to act");
const STIFFNESS: Parameter = Parameter::number("stiffness", "N/m", Range::NOT_NEGATIVE, "k of the zone");
const DAMPING: Parameter =
    Parameter::number("damping", "N s/m", Range::NOT_NEGATIVE, "z in the zone").or(Value::Number(0.0));
const PULLS: Parameter =
    Parameter::boolean("pulls", "whether damping may hold back what leaves").or(Value::Boolean(false));
const SOURCE: &str = "Jimenez 1993, P2-III.1.1";

pub const BALL: LinkEntry = LinkEntry {
    name: "ball",
    summary: "pushes while closer than the threshold: points with a volume that nothing enters",
    source: SOURCE,
    parameters: &[THRESHOLD, STIFFNESS, DAMPING, PULLS],
    build: |making| Ok(Box::new(InLanes(stop(making, Zone::Inside)))),
};

pub const BUBBLE: LinkEntry = LinkEntry {
    name: "bubble",
    summary: "pulls while further than the threshold: a hollow that nothing leaves",
    source: SOURCE,
    parameters: &[THRESHOLD, STIFFNESS, DAMPING, PULLS],
    build: |making| Ok(Box::new(InLanes(stop(making, Zone::Outside)))),
};

pub const EXPONENTIAL_STOP: LinkEntry = LinkEntry {
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

fn stop(making: &crate::network::law::Making, zone: Zone) -> Stop {
    let values = making.values;
    Stop {
        zone,
        threshold: values.number("threshold"),
        stiffness: values.number("stiffness"),
        damping: values.number("damping") / making.timestep,
        pulls: values.boolean("pulls"),
    }
}
