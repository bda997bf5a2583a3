//! Links that flow: Maxwell's fluid, Bingham's paste, Burger's material.

use souple_math::Real;
use souple_table::{Parameter, Range, Value};

use crate::network::kernel::InLanes;
use crate::network::law::{LinkEntry, LinkLaw, MEMORY, Reach, Response};

/// A spring in series with a damper beside a slider; traction positive, `q = D - S`:
/// `f = k q` between the thresholds, `f = (z k q + k Te Qe)/(k Te + z)` beyond; then `S = D - f/k`.
///
/// Without thresholds it is Maxwell's fluid, `f = k z/(k Te + z) (D - S)`.
#[derive(Clone, Copy, Debug)]
struct Bingham {
    stiffness: f64,
    viscosity: f64,
    /// In traction and, negative, in compression [N].
    yields: [f64; 2],
    timestep: f64,
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

/// A spring beside Maxwell's and Kelvin–Voigt's links in series: `f = k3 (D - S) + Q`, where with `V = D - D^r`
/// `Q = B V + C V^r + D Q^r + E Q^rr`.
#[derive(Clone, Copy, Debug)]
struct Burger {
    /// `k1`, `z1` of the Kelvin–Voigt link.
    solid: [f64; 2],
    /// `k2`, `z2` of Maxwell's.
    fluid: [f64; 2],
    /// `k3` [N/m].
    beside: f64,
    timestep: f64,
    coefficients: [f64; 4],
}

const LENGTH: usize = 0;
const MOVED: usize = 1;
const FORCE: usize = 2;
const FORCE_BEFORE: usize = 3;
/// Elongation of the Kelvin–Voigt link.
const DELAYED: usize = 4;

impl Burger {
    fn new([k1, z1]: [f64; 2], [k2, z2]: [f64; 2], beside: f64, te: f64) -> Self {
        let delta = te * k2 * z2 + (te * k1 + z1) * (te * k2 + z2);
        let coefficients = [
            k2 * z2 * (te * k1 + z1) / delta,
            -k2 * z1 * z2 / delta,
            (te * k2 * (z2 + z1) + z2 * (te * k1 + 2.0 * z1)) / delta,
            -z1 * z2 / delta,
        ];
        Self { solid: [k1, z1], fluid: [k2, z2], beside, timestep: te, coefficients }
    }
}

impl LinkLaw for Burger {
    fn memory_len(&self) -> usize {
        5
    }

    fn begin(&self, _: f64, length: f64, memory: &mut [f64]) {
        memory.fill(0.0);
        memory[LENGTH] = length;
    }

    #[inline(always)]
    fn respond<R: Real>(&self, reach: &Reach<R>, memory: &mut [R; MEMORY]) -> Response<R> {
        let ([b, c, d, e], te) = (self.coefficients, self.timestep);
        let ([k1, z1], [k2, z2]) = (self.solid, self.fluid);
        let moved = reach.length - memory[LENGTH];
        let series = moved * b + memory[MOVED] * c + memory[FORCE] * d + memory[FORCE_BEFORE] * e;
        // k1 x + z1 (x - x^r)/Te = Q
        let delayed = (series * te + memory[DELAYED] * z1) * (1.0 / (k1 * te + z1));
        let crept = delayed - memory[DELAYED];
        let elongation = reach.length - reach.rest;
        let force = elongation * self.beside + series;
        *memory = [reach.length, moved, series, memory[FORCE], delayed];
        Response {
            push: -force,
            stored: elongation * elongation * (0.5 * self.beside)
                + series * series * (0.5 / k2)
                + delayed * delayed * (0.5 * k1),
            heat: crept * crept * (z1 / te) + series * series * (te / z2),
        }
    }

    fn is_conservative(&self) -> bool {
        false
    }

    // k3 + 1/(1/(k1 + 2 z1/Te) + (2 z2 + k2 Te)/(2 k2 z2))
    fn stiffest(&self) -> f64 {
        let ([k1, z1], [k2, z2], te) = (self.solid, self.fluid, self.timestep);
        self.beside + 1.0 / (1.0 / (k1 + 2.0 * z1 / te) + (2.0 * z2 + k2 * te) / (2.0 * k2 * z2))
    }
}

const STIFFNESS: Parameter = Parameter::number("stiffness", "N/m", Range::POSITIVE, "k of the spring");
const VISCOSITY: Parameter = Parameter::number("viscosity", "N s/m", Range::NOT_NEGATIVE, "z of the damper");

pub const MAXWELL: LinkEntry = LinkEntry {
    name: "maxwell",
    summary: "spring and damper in series: bounces when struck, flows when pulled slowly",
    source: "Jimenez 1993, P2-V.3.2.A",
    parameters: &[STIFFNESS, VISCOSITY],
    build: |making| {
        Ok(Box::new(InLanes(Bingham {
            stiffness: making.values.number("stiffness"),
            viscosity: making.values.number("viscosity"),
            yields: [0.0; 2],
            timestep: making.timestep,
        })))
    },
};

pub const BINGHAM: LinkEntry = LinkEntry {
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

pub const BURGER: LinkEntry = LinkEntry {
    name: "burger",
    summary: "Maxwell's and Kelvin-Voigt's links in series, beside a spring: springs, creeps and flows",
    source: "Jimenez 1993, P2-V.3.2.B, with the sign of its last coefficient mended",
    parameters: &[
        Parameter::number("solid_stiffness", "N/m", Range::POSITIVE, "k1 of the Kelvin-Voigt link"),
        Parameter::number("solid_viscosity", "N s/m", Range::POSITIVE, "z1 of the Kelvin-Voigt link"),
        Parameter::number("fluid_stiffness", "N/m", Range::POSITIVE, "k2 of Maxwell's link"),
        Parameter::number("fluid_viscosity", "N s/m", Range::POSITIVE, "z2 of Maxwell's link"),
        Parameter::number("stiffness", "N/m", Range::NOT_NEGATIVE, "k3 of the spring beside them")
            .or(Value::Number(0.0)),
    ],
    build: |making| {
        let number = |name| making.values.number(name);
        let solid = [number("solid_stiffness"), number("solid_viscosity")];
        let fluid = [number("fluid_stiffness"), number("fluid_viscosity")];
        Ok(Box::new(InLanes(Burger::new(solid, fluid, number("stiffness"), making.timestep))))
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
