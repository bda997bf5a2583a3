//! What is cut open is touched inside: tools, points and other bodies meet the surface of the cells which are left.

use std::path::Path;

use souple_math::Vec3;
use souple_run::{Options, Session};

/// A block of 2 cm, of two meshes, whose upper half goes after 20 ms; a ball goes down into it at 0.2 m/s.
fn block(detection: &str, contact: &str) -> Session {
    let text = format!(
        r#"
format = 1
[world]
period = "5 ms"
collisions = "{detection}"
[systems.main]
stepper = {{ name = "staggered", halvings = 4 }}
[bodies.block]
mesh = {{ generate = "bar", size = [0.02, 0.02, 0.02], cells = [4, 4, 4], element = "tet4" }}
material = {{ name = "linear", youngs_modulus = "5 kPa", poissons_ratio = 0.3, density = 1000 }}
damping = {{ rayleigh_mass = 20 }}
[bodies.block.levels]
coarser = [{{ mesh = {{ generate = "bar", size = [0.02, 0.02, 0.02], cells = [2, 2, 2], element = "tet4" }} }}]
fixed = "1"
cuts = [{{ region = {{ box = [[-1, -1, 0.01], [1, 1, 1]] }}, time = 0.02 }}]
[[bodies.block.pins]]
region = "z_min"
[shapes.ball]
shape = {{ name = "sphere", centre = [0.011, 0.0085, 0.032], radius = 0.006 }}
motion = {{ formula = [0, 0, "-0.2 * t"] }}
[[contacts]]
name = "ball"
body = "block"
shape = "ball"
{contact}
"#
    );
    let scene = souple_scene::read_text("block.toml", &text, Path::new("."), &[]).unwrap();
    Session::start(scene, &Options::default()).unwrap()
}

/// Of all contacts on the block [N].
fn force(session: &Session) -> Vec3 {
    let mut sum = Vec3::ZERO;
    session.world.visit_forces(0, &mut |force, at| {
        force.visit_contacts(at, &mut |point| sum += point.normal_force + point.friction);
    });
    sum
}

const CONTACTS: [&str; 3] = [
    "detect = \"points\"\nstiffness = \"20 N/m\"",
    "detect = \"triangles\"\nstiffness = \"20 N/m\"",
    "detect = \"triangles\"\nresponse = \"imposed\"",
];

/// The ball, 6 mm above the block at first, is where its top was after 30 ms and at the face that the cut has opened after 80 ms.
/// Between them it feels nothing, whatever it detects and whenever; beyond it is pushed up.
#[test]
fn tools_touch_what_is_left() {
    for contact in CONTACTS {
        for detection in ["every_step", "one_period_late"] {
            let mut session = block(detection, contact);
            for step in 1..=21 {
                session.world.step().unwrap();
                let (time, pressed) = (session.world.time(), -force(&session).z);
                if time < 0.0799 {
                    assert_eq!(pressed, 0.0, "{contact}, {detection}, {time} s");
                }
                // two periods deep in it, also where all is told one period late
                if time > 0.0951 {
                    assert!(pressed > 0.0, "{contact}, {detection}, step {step}: {pressed} N");
                }
            }
        }
    }
}

/// One that presses when the ground goes is let go, and touches the new face; a run that goes on from any state of the other has the
/// same bits.
#[test]
fn runs_resumed_after_a_cut_touch_the_same() {
    for contact in CONTACTS {
        for detection in ["every_step", "one_period_late"] {
            let mut session = block(detection, contact);
            let states: Vec<_> = (0..21)
                .map(|_| {
                    session.world.step().unwrap();
                    session.world.state().clone()
                })
                .collect();
            for from in [2, 4, 5, 17] {
                let mut resumed = block(detection, contact);
                resumed.world.resume_edited(states[from].clone(), Vec::new()).unwrap();
                for state in &states[from + 1..] {
                    resumed.world.step().unwrap();
                    assert!(resumed.world.state() == state, "{contact}, {detection}, from {from}");
                }
            }
        }
    }
}

/// A die lies on a block, whose upper half goes under it; it falls by that, and bears its weight on the face that is left.
#[test]
fn bodies_touch_what_is_left() {
    let text = r#"
format = 1
[world]
period = "5 ms"
gravity = [0, 0, -9.81]
collisions = "DETECTION"
[systems.main]
stepper = { name = "staggered", halvings = 4 }
[bodies.block]
mesh = { generate = "bar", size = [0.02, 0.02, 0.02], cells = [4, 4, 4], element = "tet4" }
material = { name = "linear", youngs_modulus = "5 kPa", poissons_ratio = 0.3, density = 1000 }
damping = { rayleigh_mass = 20 }
[bodies.block.levels]
coarser = [{ mesh = { generate = "bar", size = [0.02, 0.02, 0.02], cells = [2, 2, 2], element = "tet4" } }]
fixed = "1"
cuts = [{ region = { box = [[-1, -1, 0.01], [1, 1, 1]] }, time = 0.2 }]
[[bodies.block.pins]]
region = "z_min"
[bodies.die]
mesh = { generate = "bar", size = [0.01, 0.01, 0.01], cells = [1, 1, 1], element = "tet4" }
material = { name = "linear", youngs_modulus = "5 kPa", poissons_ratio = 0.3, density = 1000 }
damping = { rayleigh_mass = 20 }
translate = [0.0052, 0.0048, 0.0201]
[[contacts]]
name = "die"
body = "die"
other = "block"
stiffness = "20 N/m"
damping = 0.05
"#;
    for detection in ["every_step", "one_period_late"] {
        let text = text.replace("DETECTION", detection);
        let scene = souple_scene::read_text("die.toml", &text, Path::new("."), &[]).unwrap();
        let mut session = Session::start(scene, &Options::default()).unwrap();
        let lowest = |session: &Session| {
            let positions = &session.world.rows(0).positions[session.bodies[1].rows.clone()];
            positions.iter().map(|x| x.z).fold(f64::INFINITY, f64::min)
        };
        let heights: Vec<f64> = (0..120)
            .map(|_| {
                session.world.step().unwrap();
                lowest(&session)
            })
            .collect();
        // it sinks in by less than its weight on one of its points would; the block gives way under its own, `ρ g h² / 2E`, and under
        // that of the die by less than a column as wide would
        let given = |height: f64| 1e-3 * 9.81 / 20.0 + (1e3 * 9.81 * height / 2.0 + 98.1) * height / 5e3;
        assert!((heights[39] - 0.02).abs() < given(0.02), "{detection}: {}", heights[39]);
        assert!((heights[119] - 0.01).abs() < given(0.01), "{detection}: {}", heights[119]);
    }
}
