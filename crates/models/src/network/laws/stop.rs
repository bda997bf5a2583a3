//! What balls and bubbles are made of: links that act only while two points are too close, or too far apart.

use souple_math::Real;
use souple_table::{Parameter, Range, Value};

use crate::network::law::{LinkLaw, MEMORY, Making, Reach, Response};

/// On which side of the threshold a stop acts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Zone {
    /// Below: a ball that nothing enters.
    Inside,
    /// Above: a bubble that nothing leaves.
    Outside,
}

/// With the depth `p` beyond the threshold and its growth in a step `p - p^r`: `f = K p + Z (p - p^r)`, a push in a ball
/// and a pull in a bubble, while `p > 0`.
#[derive(Clone, Copy, Debug)]
pub struct Stop {
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
    /// From the values of an entry with [`PARAMETERS`].
    pub fn made(making: &Making, zone: Zone) -> Self {
        let values = making.values;
        Self {
            zone,
            threshold: values.number("threshold"),
            stiffness: values.number("stiffness"),
            damping: values.number("damping") / making.timestep,
            pulls: values.boolean("pulls"),
        }
    }

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

pub const THRESHOLD: Parameter =
    Parameter::number("threshold", "m", Range::POSITIVE, "S: the distance at which it begins to act");
pub const STIFFNESS: Parameter = Parameter::number("stiffness", "N/m", Range::NOT_NEGATIVE, "k of the zone");
pub const DAMPING: Parameter =
    Parameter::number("damping", "N s/m", Range::NOT_NEGATIVE, "z in the zone").or(Value::Number(0.0));
const PULLS: Parameter =
    Parameter::boolean("pulls", "whether damping may hold back what leaves").or(Value::Boolean(false));
/// Of both.
pub const PARAMETERS: &[Parameter] = &[THRESHOLD, STIFFNESS, DAMPING, PULLS];
pub const SOURCE: &str = "Jimenez 1993, P2-III.1.1";
