//! Slips of a scene of a network: what is misspelt, empty or of no size that can be computed with is refused with its place, and contradictions are told.

use crate::worlds::{DIE, T_SIMULATION, read, started};

/// A mass on a spring.
const SPRING: &str = r#"
[networks.net.masses.post]
positions = [[0, 0, 0]]
mass = 1
fixed = true
[networks.net.masses.free]
positions = [[1, 0, 0], [2, 0, 1]]
mass = 1
[[networks.net.links]]
law = { name = "spring", stiffness = 3 }
chain = true
of = ["free"]
[[networks.net.constraints]]
rod = { chain = true }
of = ["free"]
[run]
duration = 1
"#;

fn refusal(setting: &str) -> String {
    match read(&format!("{T_SIMULATION}{SPRING}"), &[setting]) {
        Ok(_) => panic!("{setting} is taken"),
        Err(message) => message,
    }
}

/// A parameter that a law does not name, or that acts nowhere, would change nothing; one that is no number makes no law.
#[test]
fn parameters_that_laws_make_nothing_of_are_refused() {
    let law = |law: &str| format!("networks.net.links[0].law={{ {law} }}");
    for (law, place, words) in [
        (
            law("name = \"formula\", push = \"-k*(D - L0)\", parameters = { k = 3, kk = 2 }"),
            "law.parameters",
            "`parameters.kk` changes nothing: `push` names `k` alone",
        ),
        (
            law("name = \"formula\", energy = \"2*(D - L0)^2\", parameters = { k = 3 }"),
            "law.parameters",
            "`parameters.k` changes nothing: `energy` names no parameter",
        ),
        (
            law(
                "name = \"rheological\", network = \"spring(k) | damper(2*z)\", parameters = { k = \"5 N/m\", z = 1, Q = 2 }",
            ),
            "law.parameters",
            "`parameters.Q` changes nothing: `network` names `k`, `z` alone",
        ),
        (
            law(
                "name = \"finite_state\", states = { on = \"-k*(D - L0)\", off = \"0\" }, transitions = { \"on -> off\" = \"D > far\" }, parameters = { k = 1, far = 2, near = 1 }",
            ),
            "law.parameters",
            "`parameters.near` changes nothing: its formulas name `k`, `far` alone",
        ),
        (
            law(
                "name = \"conditional\", states = { held = 'CHK, k; SUP, L, far -> torn', torn = 'LN; VN' }, parameters = { k = 5, far = 1, fare = 2 }",
            ),
            "law.parameters",
            "`parameters.fare` changes nothing: its states name `k`, `far` alone",
        ),
        (
            law("name = \"cohesion\", distance = 1, peak = 1.1, range = 1.5, repulsion = 10, cohesion = 1"),
            "law",
            "`repulsion` is 10, but it acts below `hard`, which is none",
        ),
        (
            law("name = \"formula\", push = \"-k*(D - L0)\", parameters = { k = nan }"),
            "law.parameters",
            "NaN is no finite number",
        ),
    ] {
        let message = refusal(&law);
        assert!(message.contains(place) && message.contains(words), "{law}: {message}");
    }
}

/// Units of parameters are those of their places in formulas, and what is wrong is shown there with what is wanted.
#[test]
fn parameters_have_the_units_of_their_place() {
    let formula = |k: &str| {
        format!(
            "networks.net.links[0].law={{ name = \"formula\", push = \"-k*(D - L0)\", parameters = {{ k = {k} }} }}"
        )
    };
    let states = |far: &str, loss: &str| {
        format!(
            "networks.net.links[0].law={{ name = \"finite_state\", states = {{ on = \"-k*(D - L0)\", off = \"0\" }}, transitions = {{ \"on -> off\" = \"D > far\" }}, \
             losses = {{ on = \"{loss}\" }}, parameters = {{ k = \"3 N/m\", far = {far} }} }}"
        )
    };
    for taken in [formula("3"), formula("\"3 N/m\""), states("\"2 m\"", "k*V*D"), states("2", "0.1*k")] {
        assert!(read(&format!("{T_SIMULATION}{SPRING}"), &[&taken]).is_ok(), "{taken}");
    }
    for (law, words) in [
        (formula("\"3 N\""), ["law.push", "an energy or torque", "a force", "`k` is a force"]),
        (states("\"2 s\"", "0"), ["law.transitions", "`far`", "a length", "`far` is a time"]),
        (states("2", "k*D"), ["law.losses.on", "is a force", "a power", "`k` is a stiffness"]),
    ] {
        let message = refusal(&law);
        assert!(words.iter().all(|words| message.contains(words)), "{law}: {message}");
    }
}

/// Numbers whose squares are none, and times and groups of nothing.
#[test]
fn numbers_of_no_size_are_refused() {
    for (setting, words) in [
        ("networks.net.masses.free.mass=1e300", "1e300 is out of range"),
        ("networks.net.masses.free.mass=1e300", "a number above 0, 1e100 at most [kg]"),
        ("networks.net.links[0].law.stiffness=1e308", "`stiffness` is 1e308: too large to compute with"),
        ("networks.net.masses.free.positions=[[1e200, 0, 0], [2, 0, 0]]", "mass 1 starts at (1e200, 0, 0) m"),
        ("run.duration=0", "0 is out of range"),
        ("networks.net.masses.free.positions=[]", "`free` is a group of no masses"),
        ("networks.net.constraints[0].rod={}", "links join masses in one way, these say none"),
        (
            "networks.net.masses.free.line={ from = [0, 0, 0], to = [1, 0, 0], count = 2 }",
            "these say positions and line",
        ),
    ] {
        let message = refusal(setting);
        assert!(message.contains(words), "{setting}: {message}");
    }
}

/// Masses that start towards each other are no rigid body, and are told; those that turn together are one.
#[test]
fn bodies_that_start_apart_are_told() {
    const DICE: &str = r#"
[networks.space.modules.one]
module = "die"
rotate = { axis = [1, 0.3, 0.2], angle = "40 deg" }
velocity = [1, 0.1, 0]
[networks.space.modules.two]
module = "die"
translate = [0.5, 0.1, 0]
[[networks.space.constraints]]
rigid = true
[run]
duration = 1
"#;
    let dice = format!("{T_SIMULATION}{DIE}{DICE}");
    let warnings = |settings: &[&str]| -> Vec<String> {
        let scene = read(&dice, settings).unwrap_or_else(|message| panic!("{message}"));
        scene.warnings.into_iter().filter(|warning| warning.contains("rigid")).collect()
    };
    let told = warnings(&[]);
    assert!(
        told.len() == 1 && told[0].contains("one body of all masses of the network, and masses"),
        "{told:?}"
    );
    assert!(told[0].contains("`of`, with the groups that are bodies of their own"), "{told:?}");
    let alike = ["networks.space.modules.two.velocity=[1, 0.1, 0]"];
    assert_eq!(warnings(&alike), Vec::<String>::new());
    assert_eq!(warnings(&["networks.space.constraints[0].of=[\"one\", \"two\"]"]), Vec::<String>::new());
    // what the rods take away is gone after a step
    let mut world = started(&dice, &[]);
    world.step().unwrap();
    let velocities = &world.rows(0).velocities;
    let mean = velocities.iter().copied().sum::<souple_math::Vec3>() / 16.0;
    assert!((mean.x - 0.5).abs() < 1e-12, "{mean:?}");
}
