//! Values of a scene are found again from a curve that they give.

use std::path::Path;

use souple_engine::Interruption;
use souple_sweep::{Search, Study};

/// Stiffness and viscosity of Maxwell's link, from the relaxation `f_n = A q B^(n-1)` of the specification (§8.1), whose values are
/// `k = 1000` and `z = 100`.
#[test]
fn relaxation_gives_stiffness_and_viscosity() {
    let study = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/rheometer/identify.toml");
    let study = Study::read(&study).unwrap();
    let (fit, stop) = (study.fit.as_ref().expect("a fit"), Interruption::default());
    let found = Search { study: &study, fit, count: 2, stop: &stop }.run(&mut |_, _| {}).unwrap();
    assert!(found.has_converged, "{found:?}");
    for ((value, error), expected) in found.values.iter().zip([1000.0, 100.0]) {
        // the last step was no longer than a millionth of the range, of ln 1e4
        assert!((value / expected - 1.0).abs() < 1e-6 * 1e4_f64.ln(), "{value} of {expected}");
        assert!(error.is_some());
    }
    assert!(found.residual < 1e-4 && found.explained > 0.999_999, "{found:?}");
    assert_eq!(found.curve.len(), 25);
}

/// A probe that is not there is named with those that are.
#[test]
fn wrong_probes_are_named() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/rheometer");
    let text = std::fs::read_to_string(folder.join("identify.toml")).unwrap().replace("pull.x", "push.x");
    let study =
        Study::parse(&folder.join("identify.toml"), &text, |_| Ok("0.1, 1\n0.2, 2\n".to_owned())).unwrap();
    let (fit, stop) = (study.fit.as_ref().expect("a fit"), Interruption::default());
    let error =
        Search { study: &study, fit, count: 1, stop: &stop }.run(&mut |_, _| {}).unwrap_err().to_string();
    assert!(error.contains("`fit.probe` is push; expected a probe: ") && error.contains("pull"), "{error}");
}
