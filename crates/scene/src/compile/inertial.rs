//! Gravity, and the forces of a moving frame: what acts on all mass of a system.

use souple_engine::{Force, Kinematics, Mass};
use souple_math::Vec3;
use souple_models::loads::{FictitiousForce, Gravity};

use super::{Draft, boundary::constant_vector, motion};
use crate::diagnostic::Code;

/// Gravity of the whole system, and what it feels of the frame that it is seen from.
pub fn add(
    draft: &Draft,
    index: usize,
    mass: &Mass,
    kinematics: &Kinematics,
    forces: &mut Vec<Box<dyn Force>>,
) {
    let world = &draft.spec.world;
    let timestep = world.period / f64::from(draft.spec.systems[index].steps_per_period);
    let frame = world
        .frame
        .as_ref()
        .and_then(|frame| motion::frame(draft.log, frame, timestep, draft.spec.run.duration));
    if let Some(gravity) = gravity(draft, mass, kinematics) {
        forces.push(Box::new(match &frame {
            Some(frame) => gravity.seen_from(frame.clone()),
            None => gravity,
        }));
    }
    if let Some(frame) = frame {
        forces.push(Box::new(FictitiousForce::new("frame", frame, mass, kinematics)));
    }
}

fn gravity(draft: &Draft, mass: &Mass, kinematics: &Kinematics) -> Option<Gravity> {
    let world = &draft.spec.world;
    let formulas = world.gravity.as_ref()?;
    let refuse = |code: Code, message: String, expected: &str| {
        draft.log.add(code, &world.gravity_site, message, expected);
        None
    };
    match constant_vector(formulas) {
        None => {
            let [x, y, z] = [0, 1, 2].map(|axis: usize| formulas[axis].evaluate(&[0.0]));
            if ![x, y, z].into_iter().all(f64::is_finite) {
                let message = format!("gravity is ({x}, {y}, {z}) at t = 0");
                return refuse(Code::NotFinite, message, "formulas that are finite at the start");
            }
            Some(Gravity::varying("gravity", formulas.clone(), mass, kinematics))
        }
        Some(Vec3::ZERO) => None,
        Some(constant) => match Gravity::new("gravity", constant, mass, kinematics) {
            Ok(gravity) => Some(gravity),
            Err(error) => refuse(Code::OutOfRange, error.to_string(), "finite numbers"),
        },
    }
}
