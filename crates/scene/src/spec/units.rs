//! The two spaces of parameters: physical, in SI units, and algorithmic, where time is counted in steps.
//!
//! In the algorithmic space force and length are what they are and a step is one: `M = m/Te²`, `K = k`, `Z = z/Te`,
//! `V = v Te`, `G = g Te²`. A number of a unit `kg^a m^b s^c = N^a m^(b - a) s^(c + 2a)` is `Te^(c + 2a)` times its
//! algorithmic one in SI units.

use souple_formal::parse_unit;
use souple_table::Value;

use super::Spec;
use super::network::FrictionSpec;
use crate::reader::Chosen;

/// In which space the numbers of a network are written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Space {
    #[default]
    Physical,
    Algorithmic,
}

/// What an algorithmic number of this unit is to be multiplied with to be in SI units.
pub fn from_algorithmic(unit: &str, timestep: f64) -> f64 {
    let dimension = parse_unit(unit).map(|unit| unit.dimension);
    dimension
        .map_or(1.0, |dimension| timestep.powi(i32::from(dimension.time) + 2 * i32::from(dimension.mass)))
}

impl Spec {
    /// Turns algorithmic numbers of networks into SI units, now that it is known how long their steps are.
    pub(super) fn make_physical(&mut self) {
        let Self { bodies, systems, world, .. } = self;
        for body in bodies {
            let Some(network) = body.network.as_mut().filter(|network| network.space == Space::Algorithmic)
            else {
                continue;
            };
            let steps =
                systems.iter().find(|system| system.name == body.system).map_or(1, |s| s.steps_per_period);
            let timestep = world.period / f64::from(steps);
            let of = |unit: &str| from_algorithmic(unit, timestep);
            for group in &mut network.masses {
                group.mass *= of("kg");
                group.drag *= of("N s/m");
                group.velocity = group.velocity * of("m/s");
            }
            for table in &mut network.links {
                table.law.iter_mut().for_each(|law| make_law_physical(law, timestep));
            }
            for crowd in &mut network.crowds {
                crowd.law.iter_mut().for_each(|law| make_law_physical(law, timestep));
                crowd.friction.iter_mut().for_each(|friction| make_friction_physical(friction, timestep));
            }
        }
    }
}

/// All of it by name, so that no number is left out.
fn make_friction_physical(friction: &mut FrictionSpec, timestep: f64) {
    let FrictionSpec {
        sticking: _,
        sliding: _,
        stiffness,
        damping,
        speed,
        fall,
        growth,
        curve,
        hook_viscosity,
    } = friction;
    let of = |unit: &str| from_algorithmic(unit, timestep);
    *stiffness *= of("N/m");
    *damping *= of("N s/m");
    *speed *= of("m/s");
    fall.iter_mut().for_each(|fall| *fall *= of("m/s"));
    *growth *= of("s/m");
    curve.iter_mut().flatten().for_each(|[speed, _]| *speed *= of("m/s"));
    hook_viscosity.iter_mut().for_each(|viscosity| *viscosity *= of("N s/m"));
}

fn make_law_physical<B>(law: &mut Chosen<B>, timestep: f64) {
    for parameter in law.entry.parameters {
        let factor = from_algorithmic(parameter.unit, timestep);
        match law.values.get(parameter.name) {
            Some(Value::Number(number)) => {
                let value = Value::Number(number * factor);
                law.values.set(parameter.name, value);
            }
            Some(Value::Numbers(numbers)) => {
                let numbers: Vec<f64> = numbers.iter().map(|number| number * factor).collect();
                law.values.set(parameter.name, Value::Numbers(&numbers));
            }
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The table of the two spaces: mass, stiffness, viscosity, gravity, velocity, force.
    #[test]
    fn spaces_are_those_of_the_source() {
        let h = 0.25;
        let of = |unit| from_algorithmic(unit, h);
        assert_eq!([of("kg"), of("N/m"), of("N s/m")], [h * h, 1.0, h]);
        assert_eq!(
            [of("m/s^2"), of("m/s"), of("N"), of("m"), of("")],
            [1.0 / (h * h), 1.0 / h, 1.0, 1.0, 1.0]
        );
    }
}
