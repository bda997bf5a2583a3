//! Tools and what is worn that cannot work as they are written: said, with the place.

use std::path::Path;

use souple_scene::read_text;

const HELD: &str = r#"format = 1
[world]
period = "1 ms"
[systems.main]
stepper = "backward_euler"
[bodies.bar]
mesh = { generate = "bar", size = [1, 0.1, 0.1], cells = [10, 2, 2], element = "hex8" }
material = { name = "neo_hookean", youngs_modulus = "10 kPa", poissons_ratio = 0.3, density = 1000 }
[[bodies.bar.pins]]
region = "x_min"
[hands.right]
device = { name = "emulated", mass = "0.4 kg" }
tool = { name = "sphere", centre = [0.5, 0.16, 0.05], radius = 0.02 }
body = "bar"
touch = { detect = "triangles" }
coupling = { stiffness = "400 N/m", damping = 2, limit = "5 N" }
motion = { times = [0, 0.1], offsets = [[0, 0, 0], [0, -0.02, 0]] }
"#;

fn warnings(text: &str) -> Vec<String> {
    read_text("scene.toml", text, Path::new("."), &[]).unwrap_or_else(|errors| panic!("{errors}")).warnings
}

#[track_caller]
fn assert_says_alone(text: &str, words: &str) {
    let said = warnings(text);
    assert!(said.len() == 1 && said[0].contains(words) && said[0].contains("scene.toml:"), "{said:?}");
}

/// A tool that starts inside its body touches nothing, nor one whose middle does where triangles are touched; one outside does. A shape as well as a hand's
/// tool.
#[test]
fn tools_inside_are_told() {
    assert_eq!(warnings(HELD), Vec::<String>::new());
    assert_says_alone(
        &HELD.replace("[0.5, 0.16, 0.05]", "[0.5, 0.05, 0.05]"),
        "the tool of hand `right` starts inside body `bar`",
    );
    assert_says_alone(
        &HELD.replace("[0.5, 0.16, 0.05]", "[0.5, 0.09, 0.05]"),
        "the tool of hand `right` starts with its middle inside body `bar`",
    );
    // where it is led to as it starts counts
    let led = HELD.replace("[[0, 0, 0], [0, -0.02, 0]]", "[[0, -0.11, 0], [0, -0.12, 0]]");
    assert_says_alone(&led, "starts inside body `bar`");
    let shape = |centre: &str| {
        let hands = HELD.find("[hands.right]").unwrap_or(HELD.len());
        format!(
            "{}[shapes.ball]\nshape = {{ name = \"sphere\", centre = {centre}, radius = 0.02 }}\n[[contacts]]\nbody = \"bar\"\nshape = \"ball\"\n",
            &HELD[..hands]
        )
    };
    // points are pushed out whichever side they are on
    for outside in ["[0.55, 0.13, 0.05]", "[0.55, 0.09, 0.05]"] {
        assert_eq!(warnings(&shape(outside)), Vec::<String>::new());
    }
    assert_says_alone(&shape("[0.55, 0.05, 0.05]"), "shape `ball` starts inside body `bar`");
}

/// `k T v` at 0.2 m/s is 0.08 N of the 5 N; with 40 kN/m it would be 8 N, and 2 MN/m are beyond what an arm of 0.4 kg bears.
#[test]
fn couplings_that_are_too_stiff_are_told() {
    let of =
        |stiffness: &str| HELD.replace("stiffness = \"400 N/m\"", &format!("stiffness = \"{stiffness}\""));
    assert_eq!(warnings(&of("20 kN/m")), Vec::<String>::new());
    assert_says_alone(&of("40 kN/m"), "take less than 25000 N/m");
    // a move of 2 ms in a run of a hundred seconds is between dates that are 50 ms apart; a smooth one is half as fast again halfway
    for (how, words) in [("", "at 0.5 m/s"), ("interpolation = \"smooth\", ", "at 0.75 m/s")] {
        let short = format!(
            "motion = {{ {how}times = [0, 10.01, 10.012], offsets = [[0, 0, 0], [0, 0, 0], [0, -0.001, 0]] }}"
        );
        let long = of("20 kN/m")
            .replace("motion = { times = [0, 0.1], offsets = [[0, 0, 0], [0, -0.02, 0]] }", &short);
        assert_says_alone(&format!("{long}[run]\nduration = \"100 s\"\n"), words);
    }
    let said = warnings(&of("2 MN/m"));
    assert!(said.iter().any(|told| told.contains("too stiff for an arm of 0.4 kg")), "{said:?}");
}

/// A body that is pinned nearly whole, as by a region in other units.
#[test]
fn bodies_pinned_whole_are_told() {
    let whole = HELD.replace("region = \"x_min\"", "region = { box = [[0, -1, -1], [1000, 100, 100]] }");
    assert_says_alone(&whole, "are pinned along all axes");
    // of two the pin is named that holds more: line 11, behind one of the end in lines 9 and 10
    let second =
        "region = \"x_min\"\n[[bodies.bar.pins]]\nregion = { box = [[0, -1, -1], [1000, 100, 100]] }";
    let said = warnings(&HELD.replace("region = \"x_min\"", second));
    assert!(said.len() == 1 && said[0].contains("scene.toml:11"), "{said:?}");
    // a patch whose ends are all there is of it is driven by them
    let driven = HELD.replace("cells = [10, 2, 2]", "cells = [1, 2, 2]").replace(
        "region = \"x_min\"",
        "region = \"x_min\"\n[[bodies.bar.pins]]\nregion = \"x_max\"\nmotion = { formula = [\"0.1*t\", 0, 0] }",
    );
    assert_eq!(warnings(&driven), Vec::<String>::new());
}

const LAYERED: &str = r#"format = 1
[world]
period = "10 ms"
[systems.main]
stepper = { name = "staggered", halvings = 9 }
[bodies.bar]
mesh = { generate = "bar", size = [1, 0.1, 0.1], cells = [20, 2, 2], element = "tet4" }
material = { name = "stable_neo_hookean", youngs_modulus = "100 kPa", poissons_ratio = 0.3, density = 1000 }
levels = { count = 2, budget = 1e9 }
"#;

/// A budget that the coarsest mesh keeps and the finest beside a cut does not.
#[test]
fn budgets_that_cuts_exceed_are_told() {
    let of = |budget: f64, cuts: &str| LAYERED.replace("budget = 1e9", &format!("budget = {budget}{cuts}"));
    let cuts = ", cuts = [{ region = { box = [[0.4, -1, -1], [0.5, 0.05, 1]] }, time = 0.1 }]";
    assert_eq!(warnings(&of(1e9, cuts)), Vec::<String>::new());
    let said = warnings(&of(1.0, ""));
    assert!(said.len() == 1 && said[0].contains("with the coarsest mesh alone"), "{said:?}");
    let mut words = said[0].split_whitespace().skip_while(|word| *word != "evaluates");
    let least: f64 = words.nth(1).and_then(|number| number.parse().ok()).unwrap_or(0.0);
    assert_eq!(warnings(&of(least, "")), Vec::<String>::new());
    assert_says_alone(&of(least, cuts), "once all of its cuts are made");
}

/// A dress in millimetres beside a body in metres.
#[test]
fn dresses_of_another_size_are_told() {
    let of = |size: &str| {
        let mesh =
            format!("mesh = {{ generate = \"bar\", size = {size}, cells = [30, 3, 3], element = \"tet4\" }}");
        format!("{LAYERED}[bodies.bar.levels.dress]\n{mesh}\n")
            .replace("levels = { count = 2, budget = 1e9 }", "[bodies.bar.levels]\ncount = 2")
    };
    assert_eq!(warnings(&of("[1, 0.1, 0.1]")), Vec::<String>::new());
    assert_says_alone(&of("[1000, 100, 100]"), "the dress of body `bar` is 1010 m across");
}

/// What no number of halvings makes stable is the material's, or the step's.
#[test]
fn moduli_beyond_all_steps_are_named() {
    let text = LAYERED.replace("100 kPa", "1e15 Pa");
    let errors = match read_text("scene.toml", &text, Path::new("."), &[]) {
        Ok(scene) => panic!("accepted with {:?}", scene.warnings),
        Err(errors) => errors.to_string(),
    };
    assert!(errors.contains("youngs_modulus") && errors.contains("is its unit right?"), "{errors}");
}

/// Of bodies with levels the step that is forecast is the one by which steps are refused: a scene with as many halvings as come below it is built, with one less
/// it is not.
#[test]
fn intervals_are_forecast_as_they_are_refused() {
    let of = |halvings: f64| {
        let text = LAYERED.replace("halvings = 9", &format!("halvings = {halvings}"));
        read_text("scene.toml", &text, Path::new("."), &[])
    };
    let scene = of(9.0).unwrap_or_else(|errors| panic!("{errors}"));
    let mut world = scene.model.start(scene.state);
    let longest = world.with_system(0, souple_engine::stability::forecast).longest_step;
    let enough = (1e-2 / longest).log2().ceil();
    assert!((1.0..9.0).contains(&enough), "{longest}");
    assert!(of(enough).is_ok_and(|scene| scene.warnings.is_empty()));
    let refused = of(enough - 1.0).err().map(|errors| errors.to_string()).unwrap_or_default();
    assert!(refused.contains(&format!("some points need {longest:.3e} s")), "{longest} {refused}");
}

/// Dates that come after a run, or before its first step is over.
#[test]
fn dates_without_effect_are_told() {
    // only a duration that is written is one to end before
    let run = "\n[run]\nduration = 1\n";
    let levels = |keys: &str| LAYERED.replace("budget = 1e9", keys) + run;
    let cut = |time: f64| {
        levels(&format!("cuts = [{{ region = {{ box = [[0.4, -1, -1], [0.5, 0.05, 1]] }}, time = {time} }}]"))
    };
    assert_eq!(warnings(&cut(0.5)), Vec::<String>::new());
    assert_says_alone(&cut(1.5), "a cut of body `bar` is made at 1.5 s, after the `run.duration` of 1 s");
    assert_eq!(warnings(&levels("settled = 0.5")), Vec::<String>::new());
    assert_says_alone(&levels("settled = 0.001"), "settled at 0.001 s, and its first step ends at 0.01 s");
    assert_says_alone(
        &levels("settled = 1.5"),
        "has settled at 1.5 s, and not before the `run.duration` of 1 s",
    );
    let lost = |keys: &str| HELD.replace("mass = \"0.4 kg\"", &format!("mass = \"0.4 kg\", {keys}")) + run;
    assert_eq!(warnings(&lost("lost_at = 0.5")), Vec::<String>::new());
    for too_late in ["lost_at = 2", "lost_at = 2, lost_for = 0.1"] {
        assert_says_alone(&lost(too_late), "is lost at 2 s, after the `run.duration` of 1 s");
    }
}

/// Tools and moves in millimetres beside a body in metres, and the other way about.
#[test]
fn tools_of_another_scale_are_told() {
    let of = |centre: &str, radius: f64| {
        HELD.replace("[0.5, 0.16, 0.05], radius = 0.02", &format!("{centre}, radius = {radius}"))
    };
    for usual in [0.01, 1.0] {
        assert_eq!(
            warnings(&of(&format!("[0.5, {}, 0.05]", 0.1 + 2.0 * usual), usual)),
            Vec::<String>::new()
        );
    }
    assert_says_alone(&of("[0.5, 100, 0.05]", 90.0), "the tool of hand `right` is 180 m thick");
    assert_says_alone(
        &of("[0.5, 0.11, 0.05]", 0.0002),
        "m across, and body `bar`, which it touches, is 1.01 m across",
    );
    let led = HELD.replace("[0, -0.02, 0]]", "[0, -200, 0]]").replace("times = [0, 0.1]", "times = [0, 100]");
    assert_says_alone(&led, "moves by up to 200 m, and body `bar`");
}
