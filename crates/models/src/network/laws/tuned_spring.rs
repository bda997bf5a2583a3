//! A spring whose length at rest may be driven.

use souple_math::Real;
use souple_table::{Parameter, Range, Value};

use super::spring_damper::{DAMPING, STIFFNESS, SpringDamper};
use crate::network::kernel::InLanes;
use crate::network::law::{LinkEntry, LinkLaw, MEMORY, Reach, Response};

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
}

pub const ENTRY: LinkEntry = LinkEntry {
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
        let law = SpringDamper::made(making);
        Ok(Box::new(InLanes(TunedSpring { law, length: making.values.number("length") })))
    },
};
