//! Matter that a press turns inside out is told, though it mends itself before the end.

use std::path::Path;

use souple_run::{Control, Options, Outcome, Status, run};

/// A bar of four cells whose end is led through its other one and, where that is asked for, back.
fn go(stepper: &str, motion: &str) -> Outcome {
    let text = format!(
        "format = 1\n[world]\nperiod = \"1 ms\"\n[systems.main]\n{stepper}\n[bodies.bar]\n\
         mesh = {{ generate = \"bar\", size = [1, 0.1, 0.1], cells = [4, 1, 1], element = \"hex8\" }}\n\
         material = {{ name = \"linear\", youngs_modulus = \"10 kPa\", poissons_ratio = 0.3, density = 1000 }}\n\
         [[bodies.bar.pins]]\nregion = \"x_min\"\n[[bodies.bar.pins]]\nregion = \"x_max\"\nmotion = {{ {motion} }}\n\
         [run]\nduration = \"40 ms\"\n"
    );
    let scene = souple_scene::read_text("folded", &text, Path::new("."), &[]);
    let scene = scene.unwrap_or_else(|errors| panic!("{errors}"));
    let outcome = run(scene, &Options::default(), &mut |_| Control::Continue).expect("a run");
    assert_eq!(outcome.report.status, Status::Done);
    outcome
}

fn told(outcome: &Outcome) -> Vec<&String> {
    outcome.report.warnings.iter().filter(|warning| warning.contains("inside out")).collect()
}

const IMPLICIT: &str = "stepper = \"backward_euler\"";
const THERE: &str = "times = [0, 0.01], offsets = [[0, 0, 0], [-1.6, 0, 0]]";
const AND_BACK: &str = "times = [0, 0.01, 0.02], offsets = [[0, 0, 0], [-1.6, 0, 0], [0, 0, 0]]";

/// What mends itself is told with its dates, in words and in the report; nothing is where the end stays on its side.
#[test]
fn what_mends_itself_is_told() {
    let little = go(IMPLICIT, "times = [0, 0.01], offsets = [[0, 0, 0], [-0.01, 0, 0]]");
    assert!(told(&little).is_empty() && little.report.folds.is_empty(), "{:?}", told(&little));
    let outcome = go(IMPLICIT, AND_BACK);
    let [fold] = &outcome.report.folds[..] else { panic!("{:?}", outcome.report.folds) };
    assert_eq!((fold.body.as_str(), fold.of, fold.at_end), ("bar", 4, 0));
    assert!((1..=4).contains(&fold.most) && fold.first_cell < 4, "{fold:?}");
    // the end is beyond its neighbours before it is half of the way there
    assert!(fold.from <= fold.time && fold.time <= fold.until, "{fold:?}");
    assert!(0.0 < fold.from && fold.from < 0.01 && 0.01 <= fold.until && fold.until < 0.04, "{fold:?}");
    let [said] = &told(&outcome)[..] else { panic!("{:?}", outcome.report.warnings) };
    assert!(said.contains("of 4 cells of body `bar`") && said.contains("none at the end"), "{said}");
    let report = outcome.report.to_json();
    let of_bar = &report["inside_out"]["bar"];
    assert_eq!(of_bar["most"].as_u64(), Some(fold.most as u64), "{of_bar}");
    assert_eq!((of_bar["cells"].as_u64(), of_bar["at_end"].as_u64()), (Some(4), Some(0)), "{of_bar}");
    let dates = ["at_seconds", "from_seconds", "until_seconds"].map(|key| of_bar[key].as_f64());
    assert_eq!(dates, [fold.time, fold.from, fold.until].map(Some));
}

/// What is still so at the end is told so: the close look after the last glance counts the same cells.
#[test]
fn what_stays_is_told() {
    let outcome = go(IMPLICIT, THERE);
    let [fold] = &outcome.report.folds[..] else { panic!("{:?}", outcome.report.folds) };
    assert!(fold.at_end >= 1 && fold.at_end <= fold.most, "{fold:?}");
    assert!((fold.until - 0.04).abs() < 1e-12, "{fold:?}");
    let [said] = &told(&outcome)[..] else { panic!("{:?}", outcome.report.warnings) };
    assert!(said.contains("inside out at the end"), "{said}");
}

/// Explicit steps are looked at after each 16th evaluation of forces, by dates of the world: of one step a period after each 16th, of
/// eight after each second.
#[test]
fn explicit_steps_are_looked_at_now_and_then() {
    let wide = "times = [0, 0.01, 0.03, 0.036], offsets = [[0, 0, 0], [-1.6, 0, 0], [-1.6, 0, 0], [0, 0, 0]]";
    for (steps, every) in [(1, 16.0), (8, 2.0)] {
        let stepper = format!("stepper = \"symplectic_euler\"\nsteps_per_period = {steps}");
        let outcome = go(&stepper, wide);
        let [fold] = &outcome.report.folds[..] else { panic!("{:?}", outcome.report.folds) };
        assert_eq!(fold.at_end, 0, "{fold:?}");
        for date in [fold.from, fold.time, fold.until] {
            let glances = 1e3 * date / every;
            assert!((glances - glances.round()).abs() < 1e-9, "{date} s: {fold:?}");
        }
    }
}
