//! Burger's material: springs, creeps and flows.

use souple_math::Real;
use souple_table::{Parameter, Range, Value};

use crate::network::kernel::InLanes;
use crate::network::law::{LinkEntry, LinkLaw, MEMORY, Reach, Response};

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

pub const ENTRY: LinkEntry = LinkEntry {
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
