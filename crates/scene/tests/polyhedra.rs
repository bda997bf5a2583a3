//! Bodies with faces in scenes: momenta, bits, what is refused.

use std::sync::LazyLock;

use souple_engine::World;
use souple_math::Vec3;

use crate::worlds::{DIE, T_SIMULATION, assert_goes_on, read, started, stepped};

/// Two dice and a ball that fly into each other where nothing else pulls.
static FLYING: LazyLock<String> =
    LazyLock::new(|| format!("{T_SIMULATION}steps_per_period = 5\n{DIE}{DICE}"));

const DICE: &str = r#"
[networks.space.modules.one]
module = "die"
rotate = { axis = [1, 0.3, 0.2], angle = "40 deg" }
velocity = [1, 0.1, 0]
[networks.space.modules.two]
module = "die"
rotate = { axis = [0, 0.3, 1], angle = "70 deg" }
translate = [0.5, 0.09, 0.05]
[networks.space.masses.ball]
positions = [[0.25, 0.5, 0.02]]
velocity = [0, -0.8, 0]
mass = 0.3
[[networks.space.constraints]]
of = ["one", "two"]
rigid = true
[[networks.space.constraints]]
name = "faces"
faces = [{ of = ["one", "two"], hull = true }, { of = ["ball"], radius = 0.06 }]
friction = 0.3
restitution = 0.4
"#;

/// `Σ m v` and `Σ m x × v`, with the velocities of the steps that led here, and how fast anything is off the others.
fn momenta(world: &World) -> [Vec3; 2] {
    let rows = world.rows(0);
    let masses = std::iter::once(0.3).chain(std::iter::repeat(0.1));
    let each = || masses.clone().zip(rows.positions.iter().zip(&rows.velocities));
    let linear = each().map(|(mass, (_, velocity))| *velocity * mass).sum();
    let angular = each().map(|(mass, (place, velocity))| place.cross(*velocity) * mass).sum();
    [linear, angular]
}

/// Whatever edges, corners, faces and a ball do to each other, with friction: no momentum is made. Forces go to masses by where they are touched at the start of
/// a step, so that what turns is kept too, but for friction at the centre of the ball, which lies by its radius beside: without friction to rounding.
#[test]
fn momenta_are_kept() {
    for friction in ["0", "0.3"] {
        let setting = format!("networks.space.constraints[1].friction={friction}");
        let mut world = started(&FLYING, &[&setting]);
        let [linear, angular] = momenta(&world);
        let mut collided = false;
        for step in 0..120 {
            let before = world.rows(0).velocities[1];
            world.step().unwrap_or_else(|error| panic!("{step}: {error}"));
            collided |= (world.rows(0).velocities[1] - before).length() > 0.1;
            let [now, turning] = momenta(&world);
            assert!((now - linear).length() < 1e-11, "{step}: {now:?} {linear:?}");
            if friction == "0" {
                // gaps and places of a step that differ by its way, each to what it is solved to
                assert!((turning - angular).length() < 1e-7, "{step}: {turning:?} {angular:?}");
            }
        }
        assert!(collided);
    }
}

/// Nothing enters anything in any step, and what is lost of the energy is counted.
#[test]
fn nothing_is_entered() {
    let mut world = started(&FLYING, &[]);
    let mut least = 0.0_f64;
    for _ in 0..120 {
        world.step().unwrap();
        world.visit_forces(0, &mut |force, at| {
            let Some(unilateral) = force.unilateral() else { return };
            for contact in 0..unilateral.contact_count(at.pairs) {
                if unilateral.force(contact, at.memory, at.pairs) != Vec3::ZERO {
                    least = least.min(unilateral.gap(contact, at.pairs, at.positions, at.time));
                }
            }
        });
    }
    // 1e-7 of the way of a step, 2 mm
    assert!(least > -1e-9, "{least}");
}

/// A run that goes on from its state makes the same bits, and so do any number of threads; detection beside the steps has them search anew.
#[test]
fn bodies_go_on_from_state() {
    let world = assert_goes_on(&FLYING, 20);
    let late = stepped(started(&FLYING, &["world.collisions=one_period_late"]), 40);
    assert!(world.state().systems[0].q == late.state().systems[0].q);
}

#[test]
fn wrong_bodies_are_refused() {
    let faces = |tables: &str| format!("networks.space.constraints=[{{ faces = [{tables}] }}]");
    let other = |constraint: &str| format!("networks.space.constraints=[{{ {constraint} }}]");
    for (setting, words) in [
        (faces("{ of = [\"one\"], hull = true }"), "none of the 1 bodies meets another"),
        (faces("{ of = [\"one\", \"ball\"], radius = 0.01 }"), "none of the 2 bodies meets another"),
        (faces("{ of = [\"one\", \"one\"], hull = true }"), "none of the 2 bodies meets another"),
        (faces("{ of = [\"one\", \"ball\"], hull = true }"), "the masses of `ball` rest in one plane"),
        (faces("{ of = [\"one\", \"three\"], hull = true }"), "there is no group of masses `three`"),
        (faces("{ of = [\"one\", \"two\"] }"), "or balls of a radius: of these this has none"),
        (faces("{ of = [\"one\", \"two\"], hull = false }"), "of these this has `hull = false`"),
        (faces("{ of = [\"one\", \"two\"], hull = true, radius = 1 }"), "of these this has hull and radius"),
        (faces("{ of = [\"one\", \"two\"], radius = 0 }"), "radius"),
        (
            faces("{ of = [\"one\", \"two\"], triangles = [[0, 1, 9]] }"),
            "`triangles` are of mass 9, and `one` has 8",
        ),
        (faces("{ of = [\"one\", \"two\"], triangles = [[0, 1, 1]] }"), "triangles[0] is [0, 1, 1]"),
        (faces("{ of = [\"one\", \"two\"], triangles = [] }"), "there are no triangles"),
        (
            faces("{ of = [\"one\", \"two\"], triangles = [[0, 1, 2], [0, 1, 3]] }"),
            "the side from mass 0 to mass 1 is of 2 triangles",
        ),
        (
            faces("{ of = [\"one\"], hull = true }, { of = [\"ball\"], radius = 0.5 }"),
            "`ball` begins within `one`, by mass ",
        ),
        (
            other("faces = [{ of = [\"one\", \"two\"], hull = true }], of = [\"one\"]"),
            "each of the bodies says",
        ),
        (
            other("faces = [{ of = [\"one\", \"two\"], hull = true }], sense = \"at_least\""),
            "has no two sides",
        ),
        (
            other("faces = [{ of = [\"one\", \"two\"], hull = true }], time = 1"),
            "what holds from one side holds at once",
        ),
        (other("faces = []"), "there are no faces"),
        (other("rigid = false"), "it is said that nothing is constrained, by `rigid = false`"),
        (other("rigid = true, of = [\"ball\"]"), "one mass alone is held by nothing"),
        (other("rigid = true, yields_at = 1"), "this constraint does not give way"),
    ] {
        match read(&FLYING, &[&setting]) {
            Ok(_) => panic!("{setting} is taken"),
            Err(message) => assert!(message.contains(words), "{setting}: {message}"),
        }
    }
}

/// What is of a wrong type is told once, as that.
#[test]
fn wrong_types_are_told_once() {
    for constraint in ["rigid = \"yes\"", "faces = [{ of = [\"one\", \"two\"], hull = 1 }]"] {
        let setting = format!("networks.space.constraints=[{{ {constraint} }}]");
        let Err(message) = read(&FLYING, &[&setting]) else { panic!("{setting} is taken") };
        // an empty line is between two errors
        assert!(message.contains("true or false") && !message.contains("\n\n"), "{message}");
    }
}

/// A scene of what is in a room, where things fall.
fn room(holds: &str) -> String {
    let stepper = "[systems.main]\nstepper = \"t_simulation\"\nsteps_per_period = 5\n";
    format!("format = 1\n[world]\nperiod = \"10 ms\"\ngravity = [0, 0, -10]\n{stepper}{holds}")
}

/// A hollow of triangles that do not close is met from its outer side alone.
#[test]
fn a_sheet_is_met_from_outside() {
    let falling = room(
        r#"
[networks.room.masses.plate]
positions = [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]
mass = 1
fixed = true
[networks.room.masses.ball]
positions = [[0.3, 0.1, 0.5]]
mass = 1
[[networks.room.constraints]]
faces = [{ of = ["plate"], triangles = [[0, 1, 2], [0, 2, 3]] }, { of = ["ball"], radius = 0.1 }]
restitution = 0.5
"#,
    );
    let height = |settings: &[&str], periods: u32| {
        let mut world = started(&falling, settings);
        for _ in 0..periods {
            world.step().unwrap();
        }
        world.rows(0).positions[4].z
    };
    // it falls by 0.4 m, and comes to a quarter of that again
    let top = (25..45).map(|periods| height(&[], periods)).fold(0.0, f64::max);
    // the way of a step at the impact, and the half of one that velocities are late by
    assert!((top - 0.2).abs() < 2.0 * 2e-3 * 2.9, "{top}");
    // from behind it passes, as it would if nothing were there
    let through = "networks.room.constraints[0].faces[0].triangles=[[0, 2, 1], [0, 3, 2]]";
    let fallen = height(&[through], 60);
    assert!((fallen - (0.5 - 5.0 * 0.36)).abs() < 2e-3 * 6.0, "{fallen}");
}

/// A closed surface that is inside out is a vessel: what is thrown within it stays there.
#[test]
fn what_is_inside_out_holds_what_is_within() {
    let thrown = room(
        r#"
[networks.room.masses.box]
positions = [[-1, -1, 0], [1, -1, 0], [-1, 1, 0], [1, 1, 0], [-1, -1, 1], [1, -1, 1], [-1, 1, 1], [1, 1, 1]]
mass = 1
fixed = true
[networks.room.masses.die]
lattice = { origin = [-0.1, -0.1, 0.4], spacing = 0.2, counts = [2, 2, 2] }
velocity = [4, 3, 2]
mass = 0.1
[networks.room.masses.ball]
positions = [[0.5, -0.5, 0.3]]
velocity = [3, -4, 1]
mass = 1
[[networks.room.constraints]]
of = ["die"]
rigid = true
[[networks.room.constraints]]
faces = [{ of = ["box"], triangles = [
    [3, 2, 0], [1, 3, 0], [7, 5, 4], [6, 7, 4], [5, 1, 0], [4, 5, 0], [7, 6, 2], [3, 7, 2], [6, 4, 0], [2, 6, 0], [7, 3, 1], [5, 7, 1],
] }, { of = ["die"], hull = true }, { of = ["ball"], radius = 0.1 }]
friction = 0.3
restitution = 0.8
"#,
    );
    let mut world = started(&thrown, &[]);
    let mut turned = false;
    for step in 0..200 {
        world.step().unwrap();
        let rows = world.rows(0);
        for (row, place) in rows.positions.iter().enumerate().skip(8) {
            let radius = if row == 16 { 0.1 } else { 0.0 };
            let left = (1.0 - place.x.abs()).min(1.0 - place.y.abs()).min(place.z.min(1.0 - place.z));
            // 1e-7 of the way of a step
            assert!(left - radius > -1e-8, "period {step}: row {row} at {place:?}");
        }
        turned |= rows.velocities[16].x < 0.0;
    }
    assert!(turned);
}

/// Bodies of several shapes that are thrown at a fixed one any way: what comes apart has no more energy than it came with, whatever meets what.
#[test]
fn no_energy_is_made() {
    const SHAPES: [&str; 3] = [
        "[[-0.1, -0.1, -0.1], [0.1, -0.1, -0.1], [0.1, 0.1, -0.1], [-0.1, 0.1, -0.1], [-0.1, -0.1, 0.1], [0.1, -0.1, 0.1], [0.1, 0.1, 0.1], [-0.1, 0.1, 0.1]]",
        "[[-0.15, -0.15, -0.08], [0.15, -0.15, -0.08], [0.15, 0.15, -0.08], [-0.15, 0.15, -0.08], [0, 0, 0.22]]",
        "[[-0.02, -0.02, -0.1], [0.02, -0.02, -0.1], [0, 0.03, -0.1], [0, 0, 0.2]]",
    ];
    for (index, shape) in SHAPES.iter().enumerate() {
        for throw in 0..12 {
            let turn = f64::from(throw) + 0.37 * index as f64;
            let [a, b, c] = [turn.sin(), (2.3 * turn).cos(), (1.7 * turn).sin()];
            let scene = format!(
                r#"
format = 1
[world]
period = "10 ms"
[systems.main]
stepper = "t_simulation"
steps_per_period = 5
[networks.space.modules.target]
module = "target"
rotate = {{ axis = [{b}, {c}, {a}], angle = "{} rad" }}
[networks.space.modules.thrown]
module = "thrown"
rotate = {{ axis = [{a}, {b}, {c}], angle = "{turn} rad" }}
translate = [{}, {}, 0.5]
velocity = [0, 0, -2]
[modules.target.masses.corners]
positions = {}
mass = 1
fixed = true
[modules.thrown.masses.corners]
positions = {shape}
mass = 0.1
[[networks.space.constraints]]
of = ["thrown"]
rigid = true
[[networks.space.constraints]]
faces = [{{ of = ["target", "thrown"], hull = true }}]
friction = 0.3
"#,
                1.9 * turn,
                0.1 * c,
                0.1 * a,
                SHAPES[(index + throw as usize) % 3],
            );
            let mut world = started(&scene, &[]);
            let energy = |world: &World| {
                let speeds = world.rows(0).velocities.iter().map(|velocity| velocity.length_sq());
                0.05 * speeds.sum::<f64>()
            };
            let before = energy(&world);
            for step in 0..50 {
                world
                    .step()
                    .unwrap_or_else(|error| panic!("shape {index}, throw {throw}, step {step}: {error}"));
                let now = energy(&world);
                // to what impacts are solved to
                assert!(
                    now <= before * (1.0 + 1e-5),
                    "shape {index}, throw {throw}, step {step}: {now} of {before}"
                );
            }
        }
    }
}
