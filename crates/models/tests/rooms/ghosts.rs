//! (c) A ghost of a ghost, with both kinds of feedback.

use souple_engine::{DerivedRow, Feedback, Kinematics, Mass, System, UnknownKind};
use souple_math::Vec3;

use super::forces::Spring;
use super::{stepper, world};

/// Four points; row 4 is the middle of points 0 and 1, row 5 that of row 4 and point 2. A spring pulls row 5 to
/// point 3.
fn system(feedback: Feedback, name: &str) -> (System, Vec<Vec3>) {
    let mut kinematics = Kinematics::default();
    kinematics.add_unknowns(UnknownKind::Point, 4);
    let middle =
        kinematics.add_derived_row(DerivedRow { parents: vec![(0, 0.5), (1, 0.5)], feedback }).unwrap();
    let parents = vec![(middle, 0.5), (2, 0.5)];
    let ghost = kinematics.add_derived_row(DerivedRow { parents, feedback: Feedback::Transpose }).unwrap();
    let mut mass = Mass::new(kinematics.row_count());
    mass.diagonal[..4].fill(1.0);
    let spring = Spring { a: ghost, b: 3, stiffness: 50.0, damping: 0.0 };
    let q = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::new(2.0, 3.0, 1.0)];
    let stepper = stepper(name);
    let forces: Vec<Box<dyn souple_engine::Force>> = vec![Box::new(spring)];
    (
        System {
            name: "main".into(),
            kinematics,
            mass,
            forces,
            constraints: vec![],
            stepper,
            steps_per_period: 1,
        },
        q,
    )
}

/// With transposed feedback all the way momentum is conserved to rounding; a row that gives nothing back
/// takes exactly its share away, and says so.
#[test]
fn feedback_decides_over_momentum() {
    for name in ["symplectic_euler", "rk4", "backward_euler"] {
        for (feedback, share) in [(Feedback::Transpose, 0.0), (Feedback::None, 0.5)] {
            let (system, q) = system(feedback, name);
            assert_eq!(system.kinematics.is_conservative(), feedback == Feedback::Transpose);
            let mut world = world((system, q), 1e-3);
            for _ in 0..100 {
                world.step().unwrap();
            }
            let v = &world.state().systems[0].v;
            let (ghosts, pulled) = (v[0] + v[1] + v[2], v[3]);
            // the ghost returns all of the pull, or all but the half that goes to the middle row
            let balance = ghosts + pulled * (1.0 - share);
            assert!(
                balance.length() < 1e-12 * pulled.length().max(1.0),
                "{name} {feedback:?}: {balance:?} of {pulled:?}"
            );
        }
    }
}
