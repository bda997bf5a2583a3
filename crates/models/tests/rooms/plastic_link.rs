//! (b) A link that yields: its memory moves once a step, whatever the stepper evaluates.

use souple_math::Vec3;

use super::forces::{PlasticLink, Push};
use super::{points, stepper, world};

/// Pulled far beyond its limit and let go by an opposite push, the link keeps the same plastic stretch under
/// symplectic Euler, Runge–Kutta methods and implicit formulas with Newton, to the order of the step.
#[test]
fn the_same_plastic_stretch_under_every_stepper() {
    let (stiffness, limit, mass, thrust) = (100.0, 5.0, 1.0, 8.0);
    let plastic_after = |name: &str, timestep: f64| {
        let forces: Vec<Box<dyn souple_engine::Force>> = vec![
            Box::new(PlasticLink { stiffness, limit }),
            Box::new(Push { row: 0, force: Vec3::X * thrust }),
        ];
        let mut world = world(points(&[Vec3::ZERO], &[mass], forces, stepper(name)), timestep);
        for _ in 0..(0.3 / timestep).round() as usize {
            world.step().unwrap();
        }
        let state = &world.state().systems[0];
        (state.memory[0], state.q[0].x)
    };
    // reference: elastic until k x = limit, then constant acceleration (thrust - limit)/m
    let reference = plastic_after("rk4", 1e-5);
    assert!(reference.0 > 0.02, "the link has yielded: {reference:?}");
    for name in ["symplectic_euler", "rk2", "rk4", "backward_euler", "bdf2", "newmark"] {
        let coarse = (plastic_after(name, 2e-3).0 - reference.0).abs();
        let fine = (plastic_after(name, 1e-3).0 - reference.0).abs();
        // memory moves at one end of the step, at most the last step's way apart: h thrust t / m
        let unsure = 1e-5 * thrust * 0.3 / mass;
        let is_first_order = fine < 0.7 * coarse + unsure;
        assert!(fine < 1e-3 * thrust * 0.3 / mass && is_first_order, "{name}: {coarse:e} {fine:e}");
    }
}
