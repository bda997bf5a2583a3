//! Networks of springs, dampers and sliders in series and in parallel, as one link between two masses.
//!
//! Over a step of `Te` seconds, with traction positive and `q = D - S`:
//!
//! - spring: `Q = k q`, it stores `k q²/2`;
//! - damper: `Q = z (q - q₋₁)/Te`, it gives off `z (q - q₋₁)²/Te`;
//! - slider: `q = q₋₁` while `-Qc < Q < Qt`, any `q` at these efforts; it gives off `Q (q - q₋₁)`;
//! - in parallel `Q = Σ Qᵢ` at the same `q`, in series `q = Σ qᵢ` at the same `Q`.
//!
//! What is between the elements of a series has no mass: the step is solved for it exactly ([`curve`]). Dampers and sliders
//! remember their `q`.

mod curve;
mod text;

use curve::Curve;

pub use text::read;

use super::written::WRITTEN_MEMORY;

/// Most sliders of a network.
const SLIDERS: usize = WRITTEN_MEMORY / 2;

/// Relaxation times after which dampers bear a millionth of what they did; more would be lost in rounding beside what
/// sliders hold.
const FOR_EVER: f64 = 1e6;

/// A network, or a part of one.
#[derive(Clone, Debug, PartialEq)]
pub enum Network {
    Spring {
        /// [N/m]
        stiffness: f64,
    },
    Damper {
        /// [N s/m]
        viscosity: f64,
        /// Where its deformation is remembered.
        memory: usize,
    },
    Slider {
        /// `Qc`, `Qt` [N].
        yields: [f64; 2],
        memory: usize,
    },
    Series(Vec<Network>),
    Parallel(Vec<Network>),
}

/// Energies of a step [J].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Account {
    pub stored: f64,
    pub heat: f64,
}

/// What a network does in a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outcome {
    /// Traction positive [N].
    pub effort: f64,
    /// `∂Q/∂q` [N/m].
    pub slope: f64,
    pub account: Account,
}

impl Network {
    /// Its parts; none of an element.
    fn parts(&self) -> &[Self] {
        match self {
            Self::Series(parts) | Self::Parallel(parts) => parts,
            _ => &[],
        }
    }

    /// Deformations that it remembers.
    pub fn memory_len(&self) -> usize {
        match self {
            Self::Damper { .. } | Self::Slider { .. } => 1,
            _ => self.parts().iter().map(Self::memory_len).sum(),
        }
    }

    fn slider_count(&self) -> usize {
        match self {
            Self::Slider { .. } => 1,
            _ => self.parts().iter().map(Self::slider_count).sum(),
        }
    }

    /// Effort per deformation of a quick change, `spring` and `damper` being those of theirs; a slider does not move.
    fn impedance(&self, damper: &impl Fn(f64) -> f64) -> f64 {
        match self {
            Self::Spring { stiffness } => *stiffness,
            Self::Damper { viscosity, .. } => damper(*viscosity),
            Self::Slider { .. } => f64::INFINITY,
            Self::Parallel(parts) => parts.iter().map(|part| part.impedance(damper)).sum(),
            Self::Series(parts) => 1.0 / parts.iter().map(|part| 1.0 / part.impedance(damper)).sum::<f64>(),
        }
    }

    /// Its transfer function at the highest frequency that steps of `timestep` seconds carry, `K + 2Z` of a spring beside a
    /// damper [N/m]; infinite where sliders bridge it.
    pub fn stiffest(&self, timestep: f64) -> f64 {
        self.impedance(&|viscosity| 2.0 * viscosity / timestep)
    }

    /// Effort over deformation at the end of a step that `memory` stands at the start of.
    fn curve(&self, timestep: f64, memory: &[f64]) -> Curve {
        let sum = |parts: &[Self], add: fn(&Curve, &Curve) -> Curve| {
            let first = parts[0].curve(timestep, memory);
            parts[1..].iter().fold(first, |sum, part| add(&sum, &part.curve(timestep, memory)))
        };
        match self {
            Self::Spring { stiffness } => Curve::line(*stiffness, 0.0),
            Self::Damper { viscosity, memory: own } => Curve::line(viscosity / timestep, memory[*own]),
            Self::Slider { yields: [compression, traction], memory: own } => {
                Curve::slider(memory[*own], -compression, *traction)
            }
            Self::Parallel(parts) => sum(parts, Curve::beside),
            Self::Series(parts) => sum(parts, Curve::behind),
        }
    }

    /// Deforms the whole to `deformation` within a step; `memory` becomes that of its end.
    pub fn deform(&self, deformation: f64, timestep: f64, memory: &mut [f64]) -> Outcome {
        let curve = self.curve(timestep, memory);
        let effort = curve.efforts(deformation).low;
        let account = self.follow(deformation, effort, timestep, memory);
        Outcome { effort, slope: curve.slope(deformation), account }
    }

    /// Largest viscosity [N s/m] and smallest stiffness [N/m] of its elements.
    fn slowest(&self) -> (f64, f64) {
        match self {
            Self::Spring { stiffness } => (0.0, *stiffness),
            Self::Damper { viscosity, .. } => (*viscosity, f64::INFINITY),
            Self::Slider { .. } => (0.0, f64::INFINITY),
            Self::Series(parts) | Self::Parallel(parts) => {
                parts.iter().map(Self::slowest).fold((0.0, f64::INFINITY), |(z, k), (own_z, own_k)| {
                    (f64::max(z, own_z), f64::min(k, own_k))
                })
            }
        }
    }

    /// What it remembers when it has been held at `deformation` for ever.
    pub fn rest_at(&self, deformation: f64, memory: &mut [f64]) {
        memory.fill(0.0);
        let (viscosity, stiffness) = self.slowest();
        // dampers without a spring relax at once, and sliders without dampers slip at once: any time will do
        let is_slow = viscosity > 0.0 && stiffness.is_finite();
        let relaxation = if is_slow { viscosity / stiffness } else { 1.0 };
        self.deform(deformation, FOR_EVER * relaxation, memory);
    }

    /// Hands the deformation and effort of a part down to its elements.
    fn follow(&self, deformation: f64, effort: f64, timestep: f64, memory: &mut [f64]) -> Account {
        match self {
            Self::Spring { stiffness } => {
                Account { stored: 0.5 * stiffness * deformation * deformation, heat: 0.0 }
            }
            Self::Damper { viscosity, memory: own } => {
                let moved = deformation - std::mem::replace(&mut memory[*own], deformation);
                Account { stored: 0.0, heat: viscosity * moved * moved / timestep }
            }
            Self::Slider { memory: own, .. } => {
                let moved = deformation - std::mem::replace(&mut memory[*own], deformation);
                Account { stored: 0.0, heat: effort * moved }
            }
            Self::Parallel(parts) => parts.iter().fold(Account::default(), |sum, part| {
                // what stands still may bear any effort of an interval, and neither moves nor heats: the least will do
                let efforts = part.curve(timestep, memory).efforts(deformation);
                let own = efforts.nearest(0.0);
                sum.plus(part.follow(deformation, own, timestep, memory))
            }),
            Self::Series(parts) => {
                let anchor = |part: &Self, memory: &[f64]| {
                    let reached = part.curve(timestep, memory).deformations(effort);
                    (reached, if reached.low.is_finite() { reached.low } else { reached.high })
                };
                // what slips takes what the others leave, the first of them as much as it can
                let mut left = deformation - parts.iter().map(|part| anchor(part, memory).1).sum::<f64>();
                parts.iter().fold(Account::default(), |sum, part| {
                    let (reached, at) = anchor(part, memory);
                    let own = reached.nearest(at + left);
                    left -= own - at;
                    sum.plus(part.follow(own, effort, timestep, memory))
                })
            }
        }
    }
}

impl Account {
    fn plus(self, other: Self) -> Self {
        Self { stored: self.stored + other.stored, heat: self.heat + other.heat }
    }
}

#[cfg(test)]
mod tests;
