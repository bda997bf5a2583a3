//! Spring and damper in parallel: the link that most networks are made of.

use souple_math::Real;
use souple_table::{Parameter, Range, Value};

use crate::network::kernel::InLanes;
use crate::network::law::{LinkEntry, LinkLaw, MEMORY, Making, Reach, Response};

/// `φ = -K (D - L0) - Z (D - D^r)`: Kelvin–Voigt's visco-elastic solid along a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpringDamper {
    /// `K = k` [N/m].
    pub stiffness: f64,
    /// `Z = z / Te` [N/m].
    pub damping: f64,
}

impl SpringDamper {
    /// From the values of an entry that has them; nothing where it has not.
    pub(super) fn made(making: &Making) -> Self {
        let number = |name| match making.values.get(name) {
            Some(Value::Number(number)) => number,
            _ => 0.0,
        };
        Self { stiffness: number("stiffness"), damping: number("damping") / making.timestep }
    }
}

impl LinkLaw for SpringDamper {
    #[inline(always)]
    fn respond<R: Real>(&self, reach: &Reach<R>, _: &mut [R; MEMORY]) -> Response<R> {
        let elongation = reach.length - reach.rest;
        let moved = reach.length - reach.before;
        Response {
            push: moved * -self.damping - elongation * self.stiffness,
            stored: elongation * elongation * (0.5 * self.stiffness),
            heat: moved * moved * self.damping,
        }
    }

    fn is_conservative(&self) -> bool {
        self.damping == 0.0
    }

    fn stiffest(&self) -> f64 {
        self.stiffness + 2.0 * self.damping
    }
}

pub(super) const STIFFNESS: Parameter = Parameter::number("stiffness", "N/m", Range::NOT_NEGATIVE, "k");
pub(super) const DAMPING: Parameter = Parameter::number("damping", "N s/m", Range::NOT_NEGATIVE, "z");
pub(super) const SOURCE: &str = "Jimenez 1993, P2-I.3.2.B";

pub const ENTRY: LinkEntry = LinkEntry {
    name: "spring_damper",
    summary: "spring and damper in parallel (Kelvin-Voigt): holds its length and calms down; rotation is not damped",
    source: SOURCE,
    parameters: &[STIFFNESS, DAMPING.or(Value::Number(0.0))],
    build: |making| Ok(Box::new(InLanes(SpringDamper::made(making)))),
};
