//! The rooms of the floor, each proved by a small permanent test before anything is built on it:
//! (a) a rigid frame and tetrahedra in one implicit solve, (b) a plastic link under three kinds of stepper,
//! (c) a ghost of a ghost, (d) a sticking pair, (e) two systems at 1:17, (f) an edit and its replay,
//! (g) a field that pushes points. And what each stepper makes of energy, and forecasts of stability, against what is
//! known of them.

mod edit;
mod energy;
mod field;
mod floating_frame;
mod forces;
mod frame_and_tets;
mod ghosts;
mod implicit_formulas;
mod interruption;
mod material_axes;
mod plastic_link;
mod polynomial;
mod stability;
mod sticking_pair;
mod two_rates;

use souple_engine::{Force, Kinematics, Mass, Model, State, Stepper, System, UnknownKind, World};
use souple_math::Vec3;

/// A system of points at rest.
fn points(
    positions: &[Vec3],
    masses: &[f64],
    forces: Vec<Box<dyn Force>>,
    stepper: Box<dyn Stepper>,
) -> (System, Vec<Vec3>) {
    let mut kinematics = Kinematics::default();
    kinematics.add_unknowns(UnknownKind::Point, positions.len());
    let mut mass = Mass::new(positions.len());
    mass.diagonal.copy_from_slice(masses);
    let system = System {
        name: "main".into(),
        kinematics,
        mass,
        forces,
        constraints: vec![],
        stepper,
        steps_per_period: 1,
    };
    (system, positions.to_vec())
}

/// A world of one system.
fn world((system, q): (System, Vec<Vec3>), period: f64) -> World {
    let state = State { systems: vec![system.initial_state(q)], ..State::default() };
    Model { period, systems: vec![system], ..Model::default() }.start(state)
}

fn stepper(name: &str) -> Box<dyn Stepper> {
    stepper_with(name, &[], "")
}

/// A stepper that solves `newton = "full"` or `"one"`.
fn stepper_of(name: &str, newton: &str) -> Box<dyn Stepper> {
    stepper_with(name, &[], newton)
}

/// A stepper with these numbers, that solves `newton = "full"` or `"one"`; with the default of that where it is empty.
fn stepper_with(name: &str, given: &[(&'static str, f64)], newton: &str) -> Box<dyn Stepper> {
    let entry = souple_engine::steppers::TABLE.find(name).unwrap();
    let number = |values: souple_table::Values, (name, number): &(&'static str, f64)| {
        values.with(*name, souple_table::Value::Number(*number))
    };
    let mut values = given.iter().fold(souple_table::Values::new(), number);
    if !newton.is_empty() {
        values.set("newton", souple_table::Value::Text(newton));
    }
    (entry.build)(&entry.values(values).unwrap())
}
