//! Energy of multitudes: it does not jump where pairs come and go, and what yields or tears accounts for it.

use std::path::Path;

use souple_run::{Control, Options, Outcome, Status, run};

fn go(text: &str, settings: &[&str]) -> Outcome {
    let settings: Vec<String> = settings.iter().map(|setting| (*setting).to_owned()).collect();
    let scene = souple_scene::read_text("crowd", text, Path::new("."), &settings);
    let scene = scene.unwrap_or_else(|errors| panic!("{errors}"));
    run(scene, &Options::default(), &mut |_| Control::Continue).expect("a run")
}

/// Greatest less least of what a scene has in all, with what it gave off.
fn span(outcome: &Outcome) -> f64 {
    let probe = outcome.report.probes.iter().find(|probe| probe.name == "energy").expect("the probe");
    probe.max[0] - probe.min[0]
}

/// A ball flies through the range of another at 1 m/s.
const PASSING: &str = r#"
format = 1
[world]
period = "1 ms"
[systems.main]
stepper = "t_simulation"
[networks.n.masses.held]
positions = [[0, 0, 0]]
mass = 1
fixed = true
[networks.n.masses.ball]
positions = [[-2, 1.05, 0]]
mass = 1
velocity = [1, 0, 0]
[[networks.n.crowds]]
law = { name = "cohesion", distance = 1, peak = 1.2, range = 1.5, cohesion = 4 }
of = ["held", "ball"]
[probes.energy]
quantity = "energy.total"
[run]
duration = "4 s"
"#;

/// What a pair stores counts from the range, of a law that ends there and of one that is cut there: of half a joule no more goes astray than
/// the scheme's error, which falls with the step. Counted from rest, the well's depth would: 0.2 J and 0.4 J.
#[test]
fn energy_is_that_of_before_where_pairs_come_and_go() {
    // the well of Lennard-Jones is shallow at the cut: 2 (1/2.4)^2 of its depth, and its force is 2 % of the strongest
    let cut = [
        r#"networks.n.crowds[0].law={ name = "lennard_jones", depth = 0.2, distance = 1, exponent = 2 }"#,
        "networks.n.crowds[0].range=2",
    ];
    for settings in [&[][..], &cut] {
        let outcome = go(PASSING, settings);
        assert_eq!(outcome.report.status, Status::Done);
        assert!(span(&outcome) < 5e-3, "{settings:?}: {}", span(&outcome));
    }
}

const STRETCHED: &str = r#"
format = 1
[world]
period = "1 ms"
[systems.main]
stepper = "t_simulation"
[networks.n.masses.ends]
positions = [[0, 0, 0], [1.1, 0, 0]]
mass = 1
[[networks.n.links]]
law = { name = "elasto_plastic", stiffness = 1000, hardening = 250, traction = 10 }
all = true
rest_length = 1
[probes.heat]
quantity = "energy.dissipated"
[run]
duration = "0.002 s"
"#;

/// A link that begins beyond its threshold has yielded before: the first steps give no heat of that off.
#[test]
fn what_has_yielded_before_gives_no_heat() {
    let slider =
        r#"networks.n.links[0].law={ name = "rheological", network = "spring(1000 N/m) - slider(10 N)" }"#;
    let paste = r#"networks.n.links[0].law={ name = "bingham", stiffness = 1000, viscosity = 0, traction = 10, compression = 10 }"#;
    for law in [None, Some(slider), Some(paste)] {
        let outcome = go(STRETCHED, law.as_slice());
        let heat = &outcome.report.probes[0];
        // the ends approach by F h²/2m in a step, times the force: 10 N 1e-5 m; what it would have yielded with is 2 J
        assert!(heat.last[0].abs() < 1e-3, "{law:?}: {}", heat.last[0]);
    }
}

const HEAT: &str = include_str!("../../../scenes/heat/scene.toml");

/// A bond that is drawn beyond the range of its crowd gives off what it stored there, 100 N/m (1.499 - 1)²/2, under steppers that have lists of pairs in
/// State as under others.
#[test]
fn a_bond_that_tears_gives_off_what_it_stored() {
    for stepper in ["t_simulation", "backward_euler", "rk4"] {
        let outcome = go(
            HEAT,
            &[
                &format!("systems.main.stepper=\"{stepper}\""),
                "networks.pair.pins[0].motion={ times = [0, 0.001, 1], offsets = [[0, 0, 0], [0, 0, 0], [0.999, 0, 0]] }",
                r#"networks.pair.crowds[0].fusible.heating="0""#,
                r#"probes.pair={ quantity = "energy.dissipated" }"#,
                "run.duration=\"1 s\"",
                "expect=[]",
            ],
        );
        let heat = outcome.report.probes.iter().find(|probe| probe.name == "pair").expect("the probe");
        // a step before it tears it is shorter by up to a centimetre
        assert!((heat.last[0] - 12.45).abs() < 0.51, "{stepper}: {}", heat.last[0]);
    }
}

/// Temperatures that there are not, and heat from nowhere, are refused in words when they come to be.
#[test]
fn heat_that_cannot_be_ends_the_run() {
    let rod = "networks.rod.crowds[0].fusible";
    let around =
        |exchange: &str| vec![format!("{rod}.exchange=\"{exchange}\""), format!("{rod}.ambient=\"300\"")];
    for (settings, words) in [
        (vec![format!("{rod}.heating=\"-1e5\"")], "the temperature of a mass has come to -"),
        (vec![format!("{rod}.conductance=1000")], "the temperature of a mass has come to -"),
        (vec![format!("{rod}.heating=\"1/(t - 0.02)\"")], "a mass is heated by inf W"),
        (vec![format!("{rod}.heating=\"if(t > 0.5, ln(-1), 0)\"")], "a mass is heated by NaN W"),
        (around("if(t > 0.5, -1, 1)"), "a mass exchanges -1 W/K with what is around it"),
    ] {
        let settings: Vec<&str> = settings.iter().map(String::as_str).collect();
        let outcome = go(HEAT, &settings);
        assert_eq!(outcome.report.status, Status::Failed, "{settings:?}");
        let message = outcome.report.failure.expect("why it stopped").message();
        assert!(message.contains(words) && message.contains("of body `rod`"), "{settings:?}: {message}");
    }
}

const FRUIT: &str = include_str!("../../../scenes/fruit/scene.toml");

/// What layers keep apart is never near: a run looks at the same pairs with and without them, and all moves alike.
#[test]
fn layers_keep_apart_what_is_never_near() {
    let fallen =
        |layers: &str| go(FRUIT, &[&format!("networks.scene.encounters[0].layers={layers}"), "expect=[]"]);
    let last = |outcome: &Outcome, name: &str| {
        outcome.report.probes.iter().find(|probe| probe.name == name).expect("the probe").last[0]
    };
    let (apart, all) = (fallen("outermost"), fallen("all"));
    for probe in ["pairs", "parts"] {
        assert!(last(&apart, probe) == last(&all, probe), "{probe}");
    }
    assert!((last(&apart, "height") - last(&all, "height")).abs() < 1e-12);
    // 263 masses of the inner layers and 234 stones
    assert!(last(&all, "interactions") - last(&apart, "interactions") == 263.0 * 234.0);
}

/// A ball that goes by more than the range in a step is told to have passed through, once; one that goes by less, or along with
/// the other, is not.
#[test]
fn balls_that_jump_over_others_are_told() {
    let told = |speed: &str, held: &str| -> Vec<String> {
        let ball = format!("networks.n.masses.ball.velocity={speed}");
        let other = format!("networks.n.masses.held.velocity={held}");
        let settings = [ball.as_str(), &other, "networks.n.masses.held.fixed=false", "run.duration=\"5 ms\""];
        let mut warnings = go(PASSING, &settings).report.warnings;
        warnings.retain(|warning| warning.contains("passed through each other"));
        warnings
    };
    // the range is 1.5 m, a step 1 ms
    assert!(told("[1490, 0, 0]", "[0, 0, 0]").is_empty());
    assert!(told("[1510, 0, 0]", "[100, 0, 0]").is_empty());
    let said = told("[1510, 0, 0]", "[0, 0, 0]");
    assert!(
        said.len() == 1 && said[0].contains("crowd `n.crowds[0]`") && said[0].contains("2 balls"),
        "{said:?}"
    );
}
