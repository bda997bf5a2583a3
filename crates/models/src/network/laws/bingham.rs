//! Bingham's paste, and what Maxwell's fluid is made of.

use souple_math::Real;
use souple_table::{Parameter, Range};

use crate::network::kernel::InLanes;
use crate::network::law::{LinkEntry, LinkLaw, MEMORY, Reach, Response};

/// A spring in series with a damper beside a slider; traction positive, `q = D - S`:
/// `f = k q` between the thresholds, `f = (z k q + k Te Qe)/(k Te + z)` beyond; then `S = D - f/k`.
///
/// Without thresholds it is Maxwell's fluid, `f = k z/(k Te + z) (D - S)`.
#[derive(Clone, Copy, Debug)]
pub struct Bingham {
    /// [N/m]
    pub stiffness: f64,
    /// [N s/m]
    pub viscosity: f64,
    /// In traction and, negative, in compression [N].
    pub yields: [f64; 2],
    /// [s]
    pub timestep: f64,
}

impl LinkLaw for Bingham {
    fn memory_len(&self) -> usize {
        1
    }

    fn begin(&self, rest: f64, length: f64, memory: &mut [f64]) {
        memory[0] = rest;
        if self.viscosity == 0.0 {
            // nothing holds up what lies beyond a threshold: it has flowed before, and the heat of that is none of the run's
            let mut own = [rest, 0.0, 0.0, 0.0, 0.0];
            self.respond(&Reach { length, before: length, rest }, &mut own);
            memory[0] = own[0];
        }
    }

    #[inline(always)]
    fn respond<R: Real>(&self, reach: &Reach<R>, memory: &mut [R; MEMORY]) -> Response<R> {
        let (k, kt) = (self.stiffness, self.stiffness * self.timestep);
        let share = 1.0 / (kt + self.viscosity);
        let q = reach.length - memory[0];
        let elastic = q * k;
        let flowing = |threshold: f64| (q * (self.viscosity * k) + kt * threshold) * share;
        let [traction, compression] = self.yields;
        let pushed = elastic.select_less(q.splat(compression), flowing(compression), elastic);
        let force = q.splat(traction).select_less(elastic, flowing(traction), pushed);
        let moved = (elastic - force) * (1.0 / k);
        memory[0] += moved;
        Response { push: -force, stored: force * force * (0.5 / k), heat: force * moved }
    }

    fn is_conservative(&self) -> bool {
        false
    }

    // the elastic branch; of Maxwell's fluid, which has none, 2 k z/(2 z + k Te)
    fn stiffest(&self) -> f64 {
        if self.yields == [0.0; 2] {
            let (k, z) = (self.stiffness, self.viscosity);
            return 2.0 * k * z / (2.0 * z + k * self.timestep);
        }
        self.stiffness
    }
}

pub(super) const STIFFNESS: Parameter =
    Parameter::number("stiffness", "N/m", Range::POSITIVE, "k of the spring");
pub(super) const VISCOSITY: Parameter =
    Parameter::number("viscosity", "N s/m", Range::NOT_NEGATIVE, "z of the damper");

pub const ENTRY: LinkEntry = LinkEntry {
    name: "bingham",
    summary: "elastic below a threshold, flows beyond it: paste",
    source: "Jimenez 1993, P2-V.3.3",
    parameters: &[
        STIFFNESS,
        VISCOSITY,
        Parameter::number("traction", "N", Range::NOT_NEGATIVE, "Qe: flows when pulled by more"),
        Parameter::number("compression", "N", Range::NOT_NEGATIVE, "flows when pushed by more"),
    ],
    build: |making| {
        let number = |name| making.values.number(name);
        Ok(Box::new(InLanes(Bingham {
            stiffness: number("stiffness"),
            viscosity: number("viscosity"),
            yields: [number("traction"), -number("compression")],
            timestep: making.timestep,
        })))
    },
};

#[cfg(test)]
mod tests {
    use super::*;

    const TE: f64 = 1.0 / 300.0;

    /// Tensions along a course of lengths that goes to and fro.
    fn tensions(law: &Bingham) -> Vec<(f64, f64)> {
        let mut memory = [0.0; MEMORY];
        law.begin(1.0, 1.0, &mut memory[..law.memory_len()]);
        let mut before = 1.0;
        let step = |n: i32| {
            let length = 1.0 + 0.05 * (0.02 * f64::from(n)).sin() + 0.01 * (0.31 * f64::from(n)).sin();
            let reach = Reach { length, before, rest: 1.0 };
            before = length;
            (length, -law.respond(&reach, &mut memory).push)
        };
        (1..=600).map(step).collect()
    }

    /// Without viscosity a paste is elastic and perfectly plastic: `f = clamp(k (D - S), ±Qe)`, `S = D - f/k`.
    #[test]
    fn paste_without_viscosity_is_plastic() {
        let law = Bingham { stiffness: 1000.0, viscosity: 0.0, yields: [10.0, -10.0], timestep: TE };
        let mut rest = 1.0;
        for (length, found) in tensions(&law) {
            let elastic = 1000.0 * (length - rest);
            let expected = elastic.clamp(-10.0, 10.0);
            if expected != elastic {
                rest = length - expected / 1000.0;
            }
            assert!((found - expected).abs() < 1e-12, "{found} for {expected}");
        }
    }

    /// Without thresholds it is Maxwell's fluid: `f = A (D - D^r) + B f^r`.
    #[test]
    fn paste_without_thresholds_is_maxwells() {
        let (k, z) = (1000.0, 100.0);
        let law = Bingham { stiffness: k, viscosity: z, yields: [0.0, 0.0], timestep: TE };
        let (a, b) = (k * z / (k * TE + z), z / (k * TE + z));
        let (mut before, mut force) = (1.0, 0.0);
        for (length, found) in tensions(&law) {
            force = a * (length - before) + b * force;
            before = length;
            // a metre rounds to 2e-16 m, times k, and 1/(1 - B) = 31 steps remember it
            assert!((found - force).abs() < 1e-11, "{found} for {force}");
        }
    }
}
