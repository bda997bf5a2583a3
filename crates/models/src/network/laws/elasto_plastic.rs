//! Elasto-plastic links with hardening and rupture: a spring in series with a slider beside a second spring.

use souple_engine::LinkState;
use souple_math::Real;
use souple_table::{Parameter, Range, Value};

use crate::network::kernel::InLanes;
use crate::network::law::{LinkEntry, LinkError, LinkLaw, MEMORY, Reach, Response};

/// What yielding one way does to the threshold of the other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Hardening {
    Independent,
    /// Both grow alike.
    Isotropic,
    /// The elastic range moves as a whole: what a slider beside a spring really does.
    Kinematic,
}

/// Traction positive, `q = D - S`: elastic `f = k q` between the thresholds `S2 < q < S1`; beyond them along the slope
/// `B = k k'/(k + k')`, after which the rest length `S` has moved so that unloading is elastic again. Torn at `q >= S3`, it
/// pulls no more, but still pushes.
#[derive(Clone, Copy, Debug)]
struct ElastoPlastic {
    /// `C = k` [N/m].
    elastic: f64,
    /// `B` [N/m].
    plastic: f64,
    /// `Qe` in traction and, negative, in compression [N].
    yields: [f64; 2],
    /// Elastic elongation at which it tears [m]; infinite for never.
    tears: f64,
    hardening: Hardening,
}

/// `S`
const REST: usize = 0;
/// By how much `S1` and `S2` have grown: what the law has for thresholds may be driven.
const TRACTION: usize = 1;
const COMPRESSION: usize = 2;
/// 1 once torn.
const TORN: usize = 3;

impl LinkLaw for ElastoPlastic {
    fn memory_len(&self) -> usize {
        4
    }

    // what it begins beyond its thresholds has yielded before: the heat of that is none of the run's
    fn begin(&self, rest: f64, length: f64, memory: &mut [f64]) {
        let mut own = [rest, 0.0, 0.0, 0.0, 0.0];
        self.respond(&Reach { length, before: length, rest }, &mut own);
        memory.copy_from_slice(&own[..4]);
    }

    #[inline(always)]
    fn respond<R: Real>(&self, reach: &Reach<R>, memory: &mut [R; MEMORY]) -> Response<R> {
        let [rest, grown1, grown2, torn, _] = *memory;
        let q = reach.length - rest;
        let (zero, c) = (q.zero(), 1.0 / self.elastic);
        let [first1, first2] = self.yields.map(|force| force * c);
        let (s1, s2) = (grown1 + first1, grown2 + first2);
        let s3 = zero.select_less(torn, zero, q.splat(self.tears));
        // f = A S1 + B q,  A = C - B
        let beyond = |threshold: R| threshold * (self.elastic - self.plastic) + q * self.plastic;
        let (pulled, pushed) = (beyond(s1), beyond(s2));
        let (new_s1, new_s2) = (pulled * c, pushed * c);
        let yielded = s1.select_less(q, pulled, q.select_less(s2, pushed, q * self.elastic));
        let force = q.select_less(s3, yielded, zero);
        // a torn link keeps its rest length; one that yielded has it where unloading ends
        let moved = s1.select_less(q, reach.length - new_s1, q.select_less(s2, reach.length - new_s2, rest));
        let (own1, own2) = (s1.select_less(q, new_s1, s1), q.select_less(s2, new_s2, s2));
        let (next1, next2) = match self.hardening {
            Hardening::Independent => (own1, own2),
            Hardening::Isotropic => (q.select_less(s2, -new_s2, own1), s1.select_less(q, -new_s1, own2)),
            Hardening::Kinematic => {
                (q.select_less(s2, s1 + new_s2 - s2, own1), s1.select_less(q, s2 + new_s1 - s1, own2))
            }
        };
        memory[REST] = q.select_less(s3, moved, rest);
        memory[TRACTION] = q.select_less(s3, next1 - first1, grown1);
        memory[COMPRESSION] = q.select_less(s3, next2 - first2, grown2);
        memory[TORN] = q.select_less(s3, torn, q.splat(1.0));
        let slipped = memory[REST] - rest;
        // what is torn gives off all that it held
        let held = yielded * yielded * (0.5 * c) + yielded * (moved - rest);
        let heat = q.select_less(s3, force * slipped, zero.select_less(torn, zero, held));
        Response { push: -force, stored: force * force * (0.5 * c), heat }
    }

    fn is_conservative(&self) -> bool {
        false
    }

    // yielded, its rest length is another
    fn state(&self, rest: f64, memory: &[f64]) -> LinkState {
        match (memory[TORN] > 0.0, memory[REST] == rest) {
            (true, _) => LinkState::Apart,
            (false, true) => LinkState::In(0),
            (false, false) => LinkState::In(1),
        }
    }

    fn stiffest(&self) -> f64 {
        self.elastic
    }
}

pub const ENTRY: LinkEntry = LinkEntry {
    name: "elasto_plastic",
    summary: "elastic up to a threshold, then yields and hardens; may tear, and then still resists compression",
    source: "Jimenez 1993, P2-V.2.3",
    parameters: &[
        Parameter::number("stiffness", "N/m", Range::POSITIVE, "k: elastic"),
        Parameter::number(
            "hardening",
            "N/m",
            Range::NOT_NEGATIVE,
            "k': of hardening; 0 for perfect plasticity",
        )
        .or(Value::Number(0.0)),
        Parameter::number("traction", "N", Range::POSITIVE, "Qe: yields when pulled by more"),
        Parameter::number(
            "compression",
            "N",
            Range::NOT_NEGATIVE,
            "yields when pushed by more; as traction where 0",
        )
        .or(Value::Number(0.0)),
        Parameter::number("rupture", "N", Range::NOT_NEGATIVE, "tears when pulled by more; 0 for never")
            .or(Value::Number(0.0)),
        Parameter::choice(
            "mode",
            &["independent", "isotropic", "kinematic"],
            "what hardening one way does to the other threshold",
        )
        .or(Value::Text("independent")),
    ],
    build: |making| {
        let number = |name| making.values.number(name);
        let (k, hardening, traction) = (number("stiffness"), number("hardening"), number("traction"));
        let (compression, rupture) = (number("compression"), number("rupture"));
        if rupture > 0.0 && rupture <= traction {
            return Err(LinkError::Unfit {
                parameter: "rupture",
                value: rupture.to_string(),
                expected: format!(
                    "it must be greater than `traction`, {traction}, for the link to yield at all"
                ),
            });
        }
        Ok(Box::new(InLanes(ElastoPlastic {
            elastic: k,
            plastic: k * hardening / (k + hardening),
            yields: [traction, -if compression > 0.0 { compression } else { traction }],
            tears: if rupture > 0.0 { rupture / k } else { f64::MAX },
            hardening: match making.values.text("mode") {
                "isotropic" => Hardening::Isotropic,
                "kinematic" => Hardening::Kinematic,
                _ => Hardening::Independent,
            },
        })))
    },
};

#[cfg(test)]
mod tests {
    use super::*;

    /// Length, tension, and `S`, `S1`, `S2` after it: k = 1000, k' = 250, Qe = 10 N both ways, S = 1, independent hardening.
    const TABLE: [[f64; 5]; 17] = [
        [1.000, 0.0, 1.0, 0.01, -0.01],
        [1.005, 5.0, 1.0, 0.01, -0.01],
        [1.010, 10.0, 1.0, 0.01, -0.01],
        [1.015, 11.0, 1.004, 0.011, -0.01],
        [1.020, 12.0, 1.008, 0.012, -0.01],
        [1.030, 14.0, 1.016, 0.014, -0.01],
        [1.025, 9.0, 1.016, 0.014, -0.01],
        [1.020, 4.0, 1.016, 0.014, -0.01],
        [1.015, -1.0, 1.016, 0.014, -0.01],
        [1.010, -6.0, 1.016, 0.014, -0.01],
        [1.000, -11.2, 1.0112, 0.014, -0.0112],
        [0.990, -13.2, 1.0032, 0.014, -0.0132],
        [0.980, -15.2, 0.9952, 0.014, -0.0152],
        [0.990, -5.2, 0.9952, 0.014, -0.0152],
        [1.000, 4.8, 0.9952, 0.014, -0.0152],
        [1.010, 14.16, 0.99584, 0.01416, -0.0152],
        [1.030, 18.16, 1.01184, 0.01816, -0.0152],
    ];

    /// The loop of the specification's §8.1, with what the link remembers on the way.
    #[test]
    fn loop_of_the_table() {
        let law = ElastoPlastic {
            elastic: 1000.0,
            plastic: 200.0,
            yields: [10.0, -10.0],
            tears: f64::MAX,
            hardening: Hardening::Independent,
        };
        let mut memory = [0.0; MEMORY];
        law.begin(1.0, 1.0, &mut memory[..4]);
        let mut before = 1.0;
        for [length, tension, rest, traction, compression] in TABLE {
            let found = -law.respond(&Reach { length, before, rest: 1.0 }, &mut memory).push;
            // lengths of a metre round to 2e-16 m, sixteen times over, in forces times 1000 N/m
            assert!((found - tension).abs() < 1e-12, "{found} N at {length} m");
            for (found, expected) in memory.iter().zip([rest, traction - 0.01, compression + 0.01]) {
                assert!((found - expected).abs() < 1e-14, "{memory:?} at {length} m");
            }
            before = length;
        }
    }
}
