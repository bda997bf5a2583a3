//! Energy that grows without work is told, with the date and where; work is not.

use std::path::Path;

use souple_run::{Cause, Control, Options, Outcome, Status, run};

fn go(text: &str, settings: &[&str]) -> Outcome {
    let settings: Vec<String> = settings.iter().map(|setting| (*setting).to_owned()).collect();
    let scene = souple_scene::read_text("watched", text, Path::new("."), &settings);
    let scene = scene.unwrap_or_else(|errors| panic!("{errors}"));
    run(scene, &Options::default(), &mut |_| Control::Continue).expect("a run")
}

fn told(outcome: &Outcome) -> Vec<&String> {
    outcome.report.warnings.iter().filter(|warning| warning.starts_with("energy grew without work")).collect()
}

const LATTICE: &str = include_str!("../../../scenes/network_lattice/scene.toml");

/// A step four times as long as the links bear: it is warned of once, or ends the run, with the network's name.
#[test]
fn blow_up_is_told() {
    assert!(told(&go(LATTICE, &[])).is_empty());
    let long = ["systems.main.steps_per_period=1", "run.duration=\"0.4 s\""];
    let warned = go(LATTICE, &long);
    assert_eq!(warned.report.status, Status::Done);
    let told = told(&warned);
    assert!(told.len() == 1 && told[0].contains("most of it is in `lattice`"), "{told:?}");
    let stopped = go(LATTICE, &[&long[..], &["run.monitor.stop=true"]].concat());
    assert_eq!(stopped.report.status, Status::Failed);
    let failure = stopped.report.failure.expect("why it stopped");
    assert!(
        matches!(&failure.cause, Cause::Between(message) if message.starts_with("energy grew without work"))
    );
    assert!(stopped.report.steps < warned.report.steps);
}

/// A cube at rest.
const CUBE: &str = r#"
format = 1
[world]
period = "1 ms"
[systems.main]
stepper = "symplectic_euler"
[bodies.cube]
mesh = { generate = "box", size = [0.1, 0.1, 0.1], cells = [2, 2, 2], element = "tet4" }
material = { name = "neo_hookean", youngs_modulus = "100 kPa", poissons_ratio = 0.4, density = 1000 }
[[bodies.cube.pins]]
region = "x_min"
[run]
duration = "0.3 s"
monitor = { growth = 0.1 }
"#;

/// What rests shakes in its last digits, which is no growth.
#[test]
fn rest_is_no_growth() {
    let outcome = go(CUBE, &[]);
    assert_eq!(outcome.report.steps, 300);
    assert!(told(&outcome).is_empty(), "{:?}", outcome.report.warnings);
}

/// A mass on a spring, driven where it swings by itself: by the end of its spring, or by a force.
const DRIVEN: &str = r#"
format = 1
[world]
period = "10 ms"
[systems.main]
stepper = "t_simulation"
steps_per_period = 10
[networks.swing.masses.hand]
positions = [[0, 0, 0]]
mass = 1
[networks.swing.masses.bob]
positions = [[1, 0, 0]]
mass = 1
[[networks.swing.links]]
law = { name = "spring", stiffness = 100 }
all = true
[run]
duration = "20 s"
monitor = { growth = 0.1 }
"#;

#[test]
fn work_is_no_growth() {
    let held = "[[networks.swing.pins]]\nregion = \"hand\"\n";
    let led = "motion = { formula = [\"0.01 * sin(10 * t)\", 0, 0] }\n";
    let places = "[[networks.swing.loads]]\nregion = \"bob\"\n";
    for (drive, what) in [
        (format!("{held}{led}"), "led"),
        (format!("{held}{places}force = [\"sin(10 * t)\", 0, 0]\n"), "a force of time"),
        (format!("{held}{places}force = [\"sin(10 * t) + 0.001 * y\", 0, 0]\n"), "a force without energy"),
    ] {
        let outcome = go(&format!("{DRIVEN}{drive}"), &[]);
        let [from, to] = [&outcome.report.energy.0, &outcome.report.energy.1].map(|energy| energy.total());
        assert!(to > from + 10.0, "{what}: it takes in {from} to {to} J");
        assert!(told(&outcome).is_empty(), "{what}: {:?}", told(&outcome));
    }
}

/// Nothing moves in the first second; then an end is led, or a force acts: what begins late is no growth either.
#[test]
fn late_starts_are_no_growth() {
    let held = "[[networks.swing.pins]]\nregion = \"hand\"\n";
    let led = "motion = { formula = [\"if(t < 1, 0, 0.01 * (1 - cos(10 * (t - 1))))\", 0, 0] }\n";
    let force = "[[networks.swing.loads]]\nregion = \"bob\"\nforce = [\"if(t < 1, 0, sqrt(t - 1))\", 0, 0]\n";
    for drive in [format!("{held}{led}"), format!("{held}{force}")] {
        let outcome = go(&format!("{DRIVEN}{drive}"), &["run.duration=\"3 s\""]);
        // of the load too, which is below zero
        assert!(outcome.report.energy.1.total().abs() > 1e-4, "{drive}: nothing moves");
        assert!(told(&outcome).is_empty(), "{drive}: {:?}", told(&outcome));
    }
}

/// A load without a value before the start is watched from the start on.
#[test]
fn formulas_begin_at_the_start() {
    let drive = "[[networks.swing.pins]]\nregion = \"hand\"\n[[networks.swing.loads]]\nregion = \"bob\"\nforce = [\"sqrt(t)\", 0, 0]\n";
    let outcome = go(&format!("{DRIVEN}{drive}"), &["run.duration=\"3 s\""]);
    assert!(told(&outcome).is_empty(), "{:?}", told(&outcome));
}

/// What has no kinetic energy is not watched, and what does work unseen is named.
#[test]
fn what_cannot_be_watched_is_said() {
    let watch = "run.monitor={ growth = 1 }";
    let without_inertia = ["systems.main.stepper=static".to_owned()];
    let read = souple_scene::read_text("watched", CUBE, Path::new("."), &without_inertia);
    let refused = read.err().expect("no inertia").to_string();
    assert!(refused.contains("`run.monitor` watches what moves"), "{refused}");
    let wax = include_str!("../../../scenes/heat/scene.toml");
    let scene = souple_scene::read_text("watched", wax, Path::new("."), &[watch.to_owned()]).unwrap();
    let is_said = |warning: &String| warning.contains("does not know the work of bonds that set in");
    assert!(scene.warnings.iter().any(is_said), "{:?}", scene.warnings);
}
