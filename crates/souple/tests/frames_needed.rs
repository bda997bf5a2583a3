//! `souple check --accuracy`: how many frames a body takes.

use serde_json::Value;

use crate::common::{scenes, souple};

/// What is told of a body, as JSON.
fn needed(scene: &str, body: &str, accuracy: &str, settings: &[&str]) -> Value {
    let scene = scenes().join(scene).display().to_string();
    let settings = settings.iter().flat_map(|setting| ["--set", setting]);
    let call = ["check", &scene, "--accuracy", accuracy, "--json"];
    souple(call.into_iter().chain(settings)).ends(0).json()["frames_needed"][body].clone()
}

/// Frames and errors of what was compared.
fn compared(needed: &Value) -> Vec<(u64, f64)> {
    let tried = needed["tried"].as_array().unwrap_or_else(|| panic!("{needed}"));
    tried.iter().filter_map(|of| Some((of["frames"].as_u64()?, of["error"].as_f64()?))).collect()
}

/// More frames are tried until the accuracy is met, and the first that meet it are what it takes.
#[test]
fn frames_are_added_until_they_do() {
    let cells = "bodies.bar.mesh.cells=[20, 2, 2]";
    let needed = needed("frames_cantilever", "bar", "0.2", &[cells]);
    let compared = compared(&needed);
    assert!(compared.windows(2).all(|pair| pair[0].0 < pair[1].0), "{needed}");
    let (last, before) = compared.split_last().expect("tries");
    assert!(last.1 <= 0.2 && before.iter().all(|(_, error)| *error > 0.2), "{needed}");
    assert_eq!(needed["enough"], last.0, "{needed}");
}

/// What the body hangs on is held: heavier organs change the motions of the scene, and not those of the tissue between them.
#[test]
fn motions_are_those_of_the_body() {
    let of = |settings: &[&str]| compared(&needed("tied_organs", "tissue", "50%", settings));
    let heavy = of(&["bodies.upper.material.density=3000", "bodies.lower.material.density=3000"]);
    let light = of(&[]);
    assert!(!light.is_empty());
    assert_eq!(heavy, light);
}

/// A body that floats has six motions without a frequency, which are left out whatever the scale of the others is.
#[test]
fn no_scale_of_frequencies_is_taken_for_granted() {
    let of = |modulus: &str| {
        let modulus = format!("bodies.bar.material.youngs_modulus=\"{modulus}\"");
        compared(&needed("frames_spinning", "bar", "90%", &[&modulus, "world.period=\"1 us\""]))
    };
    let (soft, stiff) = (of("50 Pa"), of("5 GPa"));
    assert!(!soft.is_empty() && soft.len() == stiff.len(), "{soft:?} {stiff:?}");
    for (soft, stiff) in soft.iter().zip(&stiff) {
        assert_eq!(soft.0, stiff.0);
        // each is a ratio of frequencies that the iteration knows to 1e-10
        assert!((soft.1 - stiff.1).abs() < 1e-8, "{soft:?} {stiff:?}");
    }
}

/// Frames that cannot carry the body are told as such, and are not the reason why others do not do.
#[test]
fn what_is_refused_is_told_of_that_try_alone() {
    let shown = "bodies.bar.frames.shown=11";
    let needed = needed("frames_led", "bar", "0.1%", &[shown]);
    let tried = needed["tried"].as_array().unwrap_or_else(|| panic!("{needed}"));
    let refused = |of: &Value| of["refused"].as_str().map(str::to_owned);
    assert_eq!(tried[0]["times"], 0.5);
    assert!(refused(&tried[0]).is_some_and(|why| why.contains("no frame 11")), "{needed}");
    assert!(compared(&needed).len() >= 2, "{needed}");
    let scene = scenes().join("frames_led").display().to_string();
    let told = souple(["check", &scene, "--accuracy", "0.1%", "--set", shown]).ends(0).stdout;
    let line = told.lines().find(|line| line.contains("softest motions")).expect("a line").to_owned();
    assert!(line.contains("0.5 times as many do not do"), "{line}");
    assert!(line.ends_with("0.1 % takes more, or other weights"), "{line}");
}
