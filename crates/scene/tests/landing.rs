//! What gives way while contacts push it: legs that are pressed, trusses that meet, what goes on from state.

use souple_engine::World;
use souple_math::Vec3;

use crate::worlds::{assert_goes_on, dissipated, started};

/// A leg between a floor and a plate that is led down flows as fast as the plate comes, under its limit, which both of them bear.
#[test]
fn pressed_legs_flow() {
    let text = r#"
format = 1
[world]
period = "1 ms"
[systems.main]
stepper = "t_simulation"
[networks.leg.masses.ends]
positions = [[0, 0, 0], [0, 0, 1]]
mass = 1
[[networks.leg.constraints]]
name = "leg"
rod = { chain = true }
yields_at = 7
[[networks.leg.constraints]]
name = "floor"
of = ["ends"]
plane = { place = [0, 0, 0], normal = [0, 0, 1] }
sense = "at_least"
[[networks.leg.constraints]]
name = "plate"
of = ["ends"]
plane = { place = [0, 0, 1.005], normal = [0, 0, 1], motion = { formula = [0, 0, "-0.2 * t"] } }
sense = "at_most"
"#;
    let mut world = started(text, &[]);
    for step in 1..=200 {
        world.step().unwrap_or_else(|error| panic!("step {step}: {error}"));
        let q = &world.state().systems[0].q;
        let plate = 1.005 - 0.2e-3 * f64::from(step);
        assert!(q[0].z.abs() < 1e-10 && (q[1].z - plate.min(1.0)).abs() < 1e-10, "{step}: {q:?}");
    }
    // 1 kg is brought to 0.2 m/s by the plate, at 200 N within a step; what the plate gives is not given off
    let taken = 7.0 * 0.035;
    let mut flow = 0.0;
    world.visit_forces(0, &mut |force, at| {
        if force.name() == "leg.leg" {
            flow = -at.memory[0];
        }
    });
    // gaps are closed to 1e-7 of 0.2 mm
    assert!((flow - taken).abs() < 7.0 * 2e-10, "{flow} {taken}");
}

/// Two trusses that meet in free space keep their momentum, and what they give off is what they lose.
#[test]
fn trusses_that_collide_keep_momentum() {
    let text = r#"
format = 1
[world]
period = "1 ms"
[systems.main]
stepper = "t_simulation"
[networks.pair.masses.left]
positions = [[0, 0, 0], [0.5, 0, 0], [0.5, 0.5, 0.1], [0, 0.5, 0]]
velocity = [1, 0.1, 0]
mass = 0.3
[networks.pair.masses.right]
positions = [[0.61, 0.2, 0], [1.1, 0.1, 0], [1.1, 0.6, 0], [0.61, 0.55, 0.1]]
velocity = [-1, 0, 0.1]
mass = 0.2
[[networks.pair.constraints]]
name = "left_rods"
of = ["left"]
rod = { all = true }
yields_at = 5
[[networks.pair.constraints]]
name = "right_rods"
of = ["right"]
rod = { all = true }
yields_at = 8
[[networks.pair.constraints]]
balls = { diameter = 0.1 }
friction = 0.2
"#;
    let mut world = started(text, &[]);
    let momentum = |world: &World| -> Vec3 {
        let v = &world.state().systems[0].v;
        v.iter().enumerate().map(|(mass, v)| *v * if mass < 4 { 0.3 } else { 0.2 }).sum()
    };
    let before = momentum(&world);
    for step in 0..300 {
        world.step().unwrap_or_else(|error| panic!("step {step}: {error}"));
        // velocities are differences of places, each known to 2e-16 over a step of 1e-3
        assert!((momentum(&world) - before).length() < 1e-11, "step {step}");
    }
    assert!(dissipated(&mut world) > 0.1);
}

/// A frame that is braced twice and lands on a corner.
const FRAME: &str = r#"
format = 1
[world]
period = "1 ms"
gravity = [0, -10, 0]
[systems.main]
stepper = "t_simulation"
[networks.frame.masses.joints]
positions = [[0, 0.01, 0], [0.5, 0.2, 0], [-0.2, 0.5, 0.1], [0.3, 0.7, 0], [-0.3, 1, 0], [0.1, 1.1, 0]]
velocity = [0, -2, 0]
mass = 0.5
[[networks.frame.constraints]]
name = "rods"
rod = { from = [0, 0, 1, 0, 1, 2, 2, 3, 2, 3, 4], to = [1, 2, 3, 3, 2, 3, 4, 5, 5, 4, 5] }
yields_at = 40
[[networks.frame.constraints]]
name = "floor"
plane = { place = [0, 0, 0], normal = [0, 1, 0] }
sense = "at_least"
friction = 0.4
"#;

/// A run that goes on from its state makes the same bits, and so do any number of threads.
#[test]
fn landings_go_on_from_state() {
    assert_goes_on(FRAME, 60);
}
