//! Values of a scene are found again from a curve that they give.

use std::path::Path;

use souple_engine::Interruption;
use souple_sweep::{Ending, Found, Search, Study, SweepError};

/// Stiffness and viscosity of Maxwell's link, from the relaxation `f_n = A q B^(n-1)` of the specification (§8.1), whose values are
/// `k = 1000` and `z = 100`.
#[test]
fn relaxation_gives_stiffness_and_viscosity() {
    let study = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/rheometer/identify.toml");
    let study = Study::read(&study).unwrap();
    let (fit, stop) = (study.fit.as_ref().expect("a fit"), Interruption::default());
    let found = Search { study: &study, fit, count: 2, stop: &stop }.run(&mut |_, _| {}).unwrap();
    let found = found.expect("not interrupted");
    assert_eq!(found.ending, Ending::Converged, "{found:?}");
    for ((value, error), expected) in found.values.iter().zip([1000.0, 100.0]) {
        // the last step was no longer than a millionth of the range, of ln 1e4
        assert!((value / expected - 1.0).abs() < 1e-6 * 1e4_f64.ln(), "{value} of {expected}");
        assert!(error.is_some());
    }
    assert!(found.residual < 1e-4 && found.explained.is_some_and(|share| share > 0.999_999), "{found:?}");
    assert_eq!(found.curve.len(), 25);
}

/// The study of the rheometer with some words in the place of others, and a curve.
fn search(changes: &[(&str, &str)], curve: &str, stop: &Interruption) -> Result<Option<Found>, SweepError> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/rheometer/identify.toml");
    let mut text = std::fs::read_to_string(&path).unwrap();
    for (from, to) in changes {
        assert!(text.contains(from), "{from}");
        text = text.replace(from, to);
    }
    let study = Study::parse(&path, &text, |_| Ok(curve.to_owned()))?;
    let fit = study.fit.as_ref().expect("a fit");
    Search { study: &study, fit, count: 1, stop }.run(&mut |_, _| {})
}

const CURVE: &str = "0.1, 1\n0.2, 2\n";

/// Probes and values of which there is nothing to be found are named, with what would do.
#[test]
fn what_cannot_be_sought_is_named() {
    let viscosity = "networks.sample.links[0].law.viscosity\" = { start = 20, min = 1, max = 1e4 }";
    let doubled = "settings = [\n    \"networks.sample.links[0].law.viscosity = 3\",";
    for (from, to, curve, words) in [
        (
            "settings = [",
            doubled,
            CURVE,
            "viscosity = 3`, of what `fit.values` looks for; expected settings of other",
        ),
        ("pull.x", "push.x", CURVE, "`fit.probe` is push; expected a probe: "),
        ("pull.x", "pull", CURVE, "`fit.probe` is pull, a vector; expected a component of it: pull.x"),
        ("\"pull.x\"", "\"pull.x\"\nover = \"way\"", CURVE, "`fit.over` is way; expected a probe: "),
        (
            "pull.x",
            "pull.x",
            "0.1, 1\n10, 2\n",
            "`fit.curve` is a curve with a point at 1e1; expected points from 0e0 to ",
        ),
        (
            viscosity,
            "networks.sample.masses.lead.mass\" = { start = 20, min = 1, max = 1e4 }",
            CURVE,
            "`fit.values.\"networks.sample.masses.lead.mass\"` is a value that changes nothing at 2e1",
        ),
    ] {
        let error = search(&[(from, to)], curve, &Interruption::default()).unwrap_err().to_string();
        assert!(error.contains(words), "{error}");
    }
}

/// An interruption before the first run has ended finds nothing, and is no fault of the study.
#[test]
fn interruptions_are_no_faults() {
    let stop = Interruption::default();
    stop.wish();
    assert!(search(&[], CURVE, &stop).unwrap().is_none());
}
