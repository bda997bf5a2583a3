//! Elements that change their law to and fro are told of.

use std::path::Path;

use souple_run::{Control, Options, Outcome, run};

const BAR: &str = include_str!("../../../scenes/adaptive_bar/scene.toml");

fn go(settings: &[&str]) -> Outcome {
    let settings: Vec<String> = settings.iter().map(|setting| (*setting).to_owned()).collect();
    let scene = souple_scene::read_text("adaptive_bar", BAR, Path::new("."), &settings);
    let scene = scene.unwrap_or_else(|errors| panic!("{errors}"));
    run(scene, &Options::default(), &mut |_| Control::Continue).expect("a run")
}

/// Where elements may return, those of the bar at rest go over what leads to the other law under either, in every period: that is told once,
/// with what to change. Those that keep their second law, as the scene has it, come to rest.
#[test]
fn wavering_elements_are_told() {
    let told = |outcome: &Outcome| -> Vec<String> {
        let of = |warning: &&String| warning.starts_with("elements waver");
        outcome.report.warnings.iter().filter(of).cloned().collect()
    };
    let coarse = ["bodies.bar.mesh.cells=[12, 2, 2]", "run.duration=\"1 s\""];
    let returning = go(&[&coarse[..], &["bodies.bar.adapt.back=0.8"]].concat());
    let said = told(&returning);
    assert!(
        said.len() == 1 && said[0].contains("body `bar`") && said[0].contains("`adapt.back = 0`"),
        "{:?}",
        returning.report.warnings
    );
    // twice a period, an even number of changes is none at its end
    let twice =
        go(&[&coarse[..], &["bodies.bar.adapt.back=0.8", "systems.main.steps_per_period=2"]].concat());
    assert_eq!(told(&twice).len(), 1, "{:?}", twice.report.warnings);
    // beside volumes that are kept so loosely that they do not move it
    let kept = go(&[
        &coarse[..],
        &["bodies.bar.adapt.back=0.8", "bodies.bar.incompressible={ penalty = 1, tolerance = 0.5 }"],
    ]
    .concat());
    assert_eq!(told(&kept).len(), 1, "{:?}", kept.report.warnings);
    assert!(told(&go(&coarse)).is_empty());
}

/// A bar that moves is fed by its changes of law: what they gave is told at the end, and not of one that only seeks its equilibria.
#[test]
fn energy_given_at_changes_is_told() {
    let told = |settings: &[&str]| {
        let coarse = ["bodies.bar.mesh.cells=[12, 2, 2]", "run.duration=\"0.3 s\""];
        let outcome = go(&[&coarse[..], settings].concat());
        let of = |warning: &&String| warning.starts_with("changes of law have given body `bar`");
        outcome.report.warnings.iter().filter(of).count()
    };
    let moving =
        ["systems.main.stepper=\"verlet\"", "world.period=\"5 ms\"", "systems.main.steps_per_period=60"];
    assert_eq!(told(&[&moving[..], &["bodies.bar.adapt.back=0.8"]].concat()), 1);
    assert_eq!(told(&[]), 0);
}
