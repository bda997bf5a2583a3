//! Matter that melts and sets: masses with a temperature, and bonds between them whose stiffness depends on it.
//!
//! Heat flows between masses that are near, and to and from what is around:
//! `c dθ_i/dt = Σ_j g (θ_j − θ_i) + q(x_i, t) + e(x_i, t) (θ_a(x_i, t) − θ_i)`, a step at a time from the temperatures at its start.
//! A bond pushes its ends apart by `φ = −s k (D − L0) − s Z (D − D^r)`, with `s = (θ_m − θ)/(θ_m − θ_s)` of the mean temperature `θ` of its
//! ends, between 1, where matter is solid, and 0, where it has melted. There it is gone. Ends that are nearer than the reach below
//! the melting point set: they get a bond at the length that they have, which pushes nothing, so that neither melting nor setting is a jump of forces.
//! A bond that is drawn beyond the range of its crowd tears, and gives off what it stored.

use souple_formal::Formula;
use souple_math::Vec3;

use super::law::Reach;

/// What fusible matter is made of.
#[derive(Clone, Debug)]
pub struct Fusible {
    /// `c` of each mass [J/K].
    pub capacity: f64,
    /// `g` of two masses nearer than the reach [W/K].
    pub conductance: f64,
    /// `θ_s`, from which on bonds soften [K].
    pub softening: f64,
    /// `θ_m`, at which none is left [K].
    pub melting: f64,
    /// `k` of a cold bond [N/m].
    pub stiffness: f64,
    /// `Z = z/Te` of a cold bond [N/m].
    pub damping: f64,
    /// Nearer than this masses set and conduct heat [m].
    pub reach: f64,
    /// `q` of `x, y, z, t` [W].
    pub heating: Option<Formula>,
    /// `e` of `x, y, z, t` [W/K] and `θ_a` of the same [K].
    pub exchange: Option<[Formula; 2]>,
    /// At the start, of each mass of the first group, then of a second [K].
    pub temperatures: Vec<f64>,
}

/// The rest length of a pair that is not bonded.
pub const MOLTEN: f64 = 0.0;

/// What a bond does.
#[derive(Clone, Copy, Debug)]
pub struct Bond {
    /// Positive when it pushes its ends apart [N].
    pub push: f64,
    /// [J]
    pub stored: f64,
    /// Given off since the step before [J].
    pub heat: f64,
    /// `∂φ/∂D` and `∂φ/∂D^r` [N/m].
    pub slopes: [f64; 2],
    /// Length at rest from this step on [m]; [`MOLTEN`] where there is no bond.
    pub rest: f64,
}

impl Fusible {
    /// `s`: how much of a bond is left at a mean temperature of its ends.
    pub fn firmness(&self, mean: f64) -> f64 {
        ((self.melting - mean) / (self.melting - self.softening)).clamp(0.0, 1.0)
    }

    /// What a pair does whose bond rests at `rest`, its ends at `mean` in the mean.
    pub fn bond(&self, reach: &Reach, mean: f64, rest: f64) -> Bond {
        let firmness = self.firmness(mean);
        let sets = rest == MOLTEN && reach.length < self.reach;
        let rest = match firmness > 0.0 {
            false => MOLTEN,
            true if sets => reach.length,
            true => rest,
        };
        if rest == MOLTEN {
            return Bond { push: 0.0, stored: 0.0, heat: 0.0, slopes: [0.0; 2], rest };
        }
        let (k, z) = (firmness * self.stiffness, firmness * self.damping);
        let (elongation, moved) = (reach.length - rest, reach.length - reach.before);
        // while it sets, its rest length goes with its ends
        let elastic = if sets { 0.0 } else { -k };
        Bond {
            push: -k * elongation - z * moved,
            stored: 0.5 * k * elongation * elongation,
            heat: z * moved * moved,
            slopes: [elastic - z, z],
            rest,
        }
    }

    /// What a bond takes of the bound `4M` on its masses [N/m].
    pub fn stiffest(&self) -> f64 {
        self.stiffness + 2.0 * self.damping
    }

    /// What flows into a mass from around it [W].
    fn inflow(&self, place: Vec3, time: f64, temperature: f64) -> f64 {
        let at = [place.x, place.y, place.z, time];
        let heating = self.heating.as_ref().map_or(0.0, |heating| heating.evaluate(&at));
        let exchanged = self.exchange.as_ref().map_or(0.0, |[exchange, ambient]| {
            exchange.evaluate(&at) * (ambient.evaluate(&at) - temperature)
        });
        heating + exchanged
    }

    /// Moves temperatures on by a step: `flows` are what came from neighbours [W].
    pub fn advance(
        &self,
        timestep: f64,
        time: f64,
        places: impl Iterator<Item = Vec3>,
        flows: &[f64],
        temperatures: &mut [f64],
    ) {
        for ((temperature, flow), place) in temperatures.iter_mut().zip(flows).zip(places) {
            *temperature += timestep / self.capacity * (flow + self.inflow(place, time, *temperature));
        }
    }

    /// What of a mass cannot be, in words: a temperature that there is not, or heat that comes from nowhere.
    pub fn fault(&self, temperature: f64, place: Vec3, time: f64) -> Option<String> {
        let at = [place.x, place.y, place.z, time];
        let value = |formula: &Formula| formula.evaluate(&at);
        let is_well = |value: f64| value.is_finite() && value >= 0.0;
        if let Some(heating) = self.heating.as_ref().map(value).filter(|heating| !heating.is_finite()) {
            return Some(format!("a mass is heated by {heating} W; finite numbers are accepted"));
        }
        if let Some([exchange, ambient]) = self.exchange.as_ref().map(|both| both.each_ref().map(value)) {
            if !is_well(exchange) {
                return Some(format!(
                    "a mass exchanges {exchange} W/K with what is around it; numbers from 0 W/K are accepted, below heat would run from cold to warm"
                ));
            }
            if !is_well(ambient) {
                return Some(format!("what is around a mass has {ambient} K; numbers from 0 K are accepted"));
            }
        }
        (!is_well(temperature)).then(|| {
            format!(
                "the temperature of a mass has come to {temperature:.4e} K, and there is none but from 0 K on: take shorter steps or a greater `capacity`, \
                 or heat and cool less"
            )
        })
    }

    /// `Te (Σ g + e)/c` of a mass with so many neighbours: beyond 1 temperatures swing from step to step.
    pub fn share(&self, timestep: f64, neighbours: usize, place: Vec3) -> f64 {
        let at = [place.x, place.y, place.z, 0.0];
        let exchange = self.exchange.as_ref().map_or(0.0, |[exchange, _]| exchange.evaluate(&at));
        timestep * (self.conductance * neighbours as f64 + exchange) / self.capacity
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wax() -> Fusible {
        Fusible {
            capacity: 2.0,
            conductance: 0.5,
            softening: 300.0,
            melting: 340.0,
            stiffness: 100.0,
            damping: 4.0,
            reach: 1.2,
            heating: None,
            exchange: None,
            temperatures: Vec::new(),
        }
    }

    fn at(length: f64, before: f64) -> Reach {
        Reach { length, before, rest: 2.0 }
    }

    /// A bond sets at the length it has, pulls in proportion to what is left of it, and is gone above the melting point.
    #[test]
    fn bonds_set_soften_and_melt() {
        let wax = wax();
        let set = wax.bond(&at(1.1, 1.1), 290.0, MOLTEN);
        assert_eq!((set.rest, set.push, set.stored), (1.1, 0.0, 0.0));
        // too far apart to set
        assert_eq!(wax.bond(&at(1.3, 1.3), 290.0, MOLTEN).rest, MOLTEN);
        // stretched and growing: whole, half, none
        for (mean, share) in [(290.0, 1.0), (320.0, 0.5), (340.0, 0.0), (400.0, 0.0)] {
            let bond = wax.bond(&at(1.3, 1.2), mean, 1.1);
            assert!((bond.push + share * (100.0 * 0.2 + 4.0 * 0.1)).abs() < 1e-12, "{mean}: {}", bond.push);
            assert!((bond.stored - share * 2.0).abs() < 1e-12);
            assert_eq!(bond.rest == MOLTEN, share == 0.0);
        }
        // the force goes to nothing where it sets and where it melts
        assert!(wax.bond(&at(1.3, 1.2), 340.0 - 1e-9, 1.1).push.abs() < 1e-8);
        assert!(wax.bond(&at(1.1, 1.0), 340.0 - 1e-9, MOLTEN).push.abs() < 1e-8);
    }

    /// `∂φ/∂D` and `∂φ/∂D^r` are those of the push.
    #[test]
    fn slopes_are_those_of_the_push() {
        let (wax, h) = (wax(), 1e-6);
        // of a bond that stands, and of one that is just setting
        for (rest, length, before) in [(1.1, 1.3, 1.2), (MOLTEN, 1.1, 1.0)] {
            let push = |length: f64, before: f64| wax.bond(&at(length, before), 312.0, rest).push;
            let slopes = wax.bond(&at(length, before), 312.0, rest).slopes;
            // the push is linear: differences carry rounding alone, ε |φ|/h
            let bound = 1e-15 * 30.0 / h;
            let by_length = (push(length + h, before) - push(length - h, before)) / (2.0 * h);
            let by_before = (push(length, before + h) - push(length, before - h)) / (2.0 * h);
            assert!((slopes[0] - by_length).abs() < bound, "{rest}: {slopes:?}, {by_length}");
            assert!((slopes[1] - by_before).abs() < bound, "{rest}: {slopes:?}, {by_before}");
        }
    }
}
