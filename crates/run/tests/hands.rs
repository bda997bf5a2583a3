//! Hands: their runs repeat, go on from snapshots, and what was led against the clock replays without one.

use std::path::Path;

use souple_run::{Control, Options, Session, Snapshot, run, run_in_time};
use souple_scene::{Scene, read_text};

const CUBE: &str = include_str!("../../../scenes/hand_on_cube/scene.toml");

fn scene(settings: &[&str]) -> Scene {
    let settings: Vec<String> = settings.iter().map(|setting| (*setting).to_owned()).collect();
    read_text("hand_on_cube", CUBE, Path::new("."), &settings).unwrap_or_else(|error| panic!("{error}"))
}

fn fingerprint(options: &Options) -> (Vec<(u64, String)>, souple_engine::State) {
    let outcome = run(scene(&[]), options, &mut |_| Control::Continue).expect("a run");
    assert!(outcome.report.failure.is_none());
    (outcome.report.hashes, outcome.world.state().clone())
}

/// Arm, port and tool are in State: a run that goes on from a snapshot in the midst of pressing ends with the same bits.
#[test]
fn hands_go_on_from_snapshots() {
    let whole = fingerprint(&Options { steps: Some(120), ..Options::default() });
    let half = fingerprint(&Options { steps: Some(60), ..Options::default() });
    let (binary, isa) = (souple_run::binary(), souple_run::instruction_set());
    let resume = Snapshot { state: half.1, commands: Vec::new(), seed: 0, binary, isa: isa.to_owned() };
    let rest = fingerprint(&Options { steps: Some(60), resume: Some(resume), ..Options::default() });
    assert_eq!(whole.0.last(), rest.0.last());
}

/// What devices did against the clock are commands: the same world comes of them without devices.
#[test]
fn what_was_led_replays() {
    let quick = ["hands.right.motion.formula=[0, 0, \"-0.025 * smoothstep(0, 0.1, t)\"]"];
    let mut session = Session::start(scene(&quick), &Options::default()).expect("a session");
    let in_time = run_in_time(&mut session, 0.3, &mut |_| Control::Continue).expect("a run in time");
    let periods = in_time.world.periods;
    assert!((1..=30).contains(&periods));
    assert!(in_time.served.toll.periods.count() > 0);
    let commands = session.world.log().to_vec();
    assert!(!commands.is_empty());
    let options = Options { steps: Some(periods), commands, ..Options::default() };
    let outcome = run(scene(&quick), &options, &mut |_| Control::Continue).expect("a replay");
    assert_eq!(outcome.world.state(), session.world.state());
}

/// A scene without hands is refused.
#[test]
fn nobody_is_there() {
    let text = "format = 1\n[world]\nperiod = \"10 ms\"\n[bodies.a]\nmesh = { generate = \"box\", size = [1, 1, 1], \
                cells = [1, 1, 1], element = \"hex8\" }\nmaterial = { name = \"linear\", youngs_modulus = 1e3, \
                poissons_ratio = 0.3, density = 1 }\n";
    let scene = read_text("bare", text, Path::new("."), &[]).unwrap_or_else(|error| panic!("{error}"));
    let mut session = Session::start(scene, &Options::default()).expect("a session");
    assert!(run_in_time(&mut session, 0.1, &mut |_| Control::Continue).is_err());
}

/// What a hand cannot be is said with its place.
#[test]
fn wrong_hands() {
    let refused = |setting: &str, expected: &str| {
        let read = read_text("hand_on_cube", CUBE, Path::new("."), &[setting.to_owned()]);
        let error = read.err().map(|error| error.to_string()).unwrap_or_default();
        assert!(error.contains(expected), "{setting}: {error}");
    };
    refused("hands.right.body=\"cub\"", "there is no body `cub`");
    refused("hands.right.device=\"emulate\"", "there is no device `emulate`");
    refused("hands.right.device.mass=0", "above 0");
    refused("probes.force.hand=\"left\"", "there is no hand `left`");
    refused("probes.force.body=\"cube\"", "is of a hand");
    refused("hands.right.motion.formula=[0, 0, \"1/t\"]", "not finite");
    refused("hands.right.region={ nearest = [0.05, 0.05, 0.05] }", "no point on the surface");
}
