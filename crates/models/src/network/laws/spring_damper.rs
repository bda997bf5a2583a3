//! Spring, damper and both in parallel: the links that most networks are made of.

use souple_math::Real;
use souple_table::{Parameter, Range, Value};

use crate::network::kernel::InLanes;
use crate::network::law::{LinkEntry, LinkLaw, MEMORY, Reach, Response};

/// `φ = -K (D - L0) - Z (D - D^r)`: Kelvin–Voigt's visco-elastic solid along a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpringDamper {
    /// `K = k` [N/m].
    pub stiffness: f64,
    /// `Z = z / Te` [N/m].
    pub damping: f64,
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

    fn registers(&self) -> &[&'static str] {
        &["stiffness", "damping"]
    }

    fn with_register(&self, register: usize, value: f64, timestep: f64) -> Option<Self> {
        Some(match register {
            0 => Self { stiffness: value, ..*self },
            _ => Self { damping: value / timestep, ..*self },
        })
    }
}

/// A spring and damper whose length at rest is some of what it was made with.
#[derive(Clone, Copy, Debug, PartialEq)]
struct TunedSpring {
    law: SpringDamper,
    /// Of the length it was made with.
    length: f64,
}

impl LinkLaw for TunedSpring {
    #[inline(always)]
    fn respond<R: Real>(&self, reach: &Reach<R>, memory: &mut [R; MEMORY]) -> Response<R> {
        self.law.respond(&Reach { rest: reach.rest * self.length, ..*reach }, memory)
    }

    fn is_conservative(&self) -> bool {
        self.law.is_conservative()
    }

    fn stiffest(&self) -> f64 {
        self.law.stiffest()
    }

    fn registers(&self) -> &[&'static str] {
        &["stiffness", "damping", "length"]
    }

    fn with_register(&self, register: usize, value: f64, timestep: f64) -> Option<Self> {
        Some(match register {
            2 => Self { length: value, ..*self },
            _ => Self { law: self.law.with_register(register, value, timestep)?, ..*self },
        })
    }
}

const STIFFNESS: Parameter = Parameter::number("stiffness", "N/m", Range::NOT_NEGATIVE, "k");
const DAMPING: Parameter = Parameter::number("damping", "N s/m", Range::NOT_NEGATIVE, "z");
const SOURCE: &str = "Jimenez 1993, P2-I.3.2.B";

pub const SPRING_DAMPER: LinkEntry = LinkEntry {
    name: "spring_damper",
    summary: "spring and damper in parallel (Kelvin-Voigt): holds its length and calms down; rotation is not damped",
    source: SOURCE,
    parameters: &[STIFFNESS, DAMPING.or(Value::Number(0.0))],
    build: |making| {
        Ok(Box::new(InLanes(SpringDamper {
            stiffness: making.values.number("stiffness"),
            damping: making.values.number("damping") / making.timestep,
        })))
    },
};

pub const SPRING: LinkEntry = LinkEntry {
    name: "spring",
    summary: "linear spring: keeps energy",
    source: SOURCE,
    parameters: &[STIFFNESS],
    build: |making| {
        Ok(Box::new(InLanes(SpringDamper { stiffness: making.values.number("stiffness"), damping: 0.0 })))
    },
};

pub const DAMPER: LinkEntry = LinkEntry {
    name: "damper",
    summary: "linear damper: resists changes of length, not rotation",
    source: SOURCE,
    parameters: &[DAMPING],
    build: |making| {
        Ok(Box::new(InLanes(SpringDamper {
            stiffness: 0.0,
            damping: making.values.number("damping") / making.timestep,
        })))
    },
};

pub const TUNED_SPRING: LinkEntry = LinkEntry {
    name: "tuned_spring",
    summary: "spring and damper whose length at rest may be driven: a muscle, a winch, a string that is tuned",
    source: "Jimenez 1993, P2-VI.3.3",
    parameters: &[
        STIFFNESS,
        DAMPING.or(Value::Number(0.0)),
        Parameter::number("length", "", Range::NOT_NEGATIVE, "at rest, of what it was made with")
            .or(Value::Number(1.0)),
    ],
    build: |making| {
        let law = SpringDamper {
            stiffness: making.values.number("stiffness"),
            damping: making.values.number("damping") / making.timestep,
        };
        Ok(Box::new(InLanes(TunedSpring { law, length: making.values.number("length") })))
    },
};
