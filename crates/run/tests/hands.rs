//! Hands: their runs repeat, go on from snapshots, and what was led against the clock replays without one.

use std::path::Path;

use souple_haptics::{Between, Coupling, Moving, Port, Smoothing, TICK, Tick};
use souple_math::Vec3;
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

/// The greatest change of the force on a person from one millisecond to the next, over the force (V-43): the hand goes into an elastic body
/// of 200 N/m at 20 mm/s, and a world of 10 ms tells where its tool is, in balance between the body and the coupling of 400 N/m.
fn greatest_step_of_force(between: Between) -> f64 {
    let (body, speed, period) = (200.0, 0.02, 10_u64);
    let coupling = Coupling { damping: 0.0, ..Coupling::DEFAULT };
    let port = Port { coupling, passive: false };
    let (mut state, mut smoothing) = (Port::start(), Smoothing::new(between, 0.01));
    let mut greatest = 0.0_f64;
    for tick in 0..500 {
        let now = tick as f64 * 1e-3;
        if tick % period == 0 {
            let share = coupling.stiffness / (coupling.stiffness + body);
            let tool = Moving { place: Vec3::X * (share * speed * now), velocity: Vec3::X * (share * speed) };
            smoothing.tell(tick / period, tool, now);
        }
        let before = state.force.length();
        port.tick(&mut state, Some(Vec3::X * (speed * now)), TICK, smoothing.at(now));
        if tick > 100 {
            greatest = greatest.max((state.force.length() - before).abs() / before);
        }
    }
    greatest
}

/// Shown evenly between what the world tells, the tool changes the force by at most 5 % from one update to the next; told and held, which
/// is what `between = "hold"` of a hand does, it makes it jump by more.
#[test]
fn forces_do_not_jump_between_periods() {
    let (even, held) = (greatest_step_of_force(Between::Interpolate), greatest_step_of_force(Between::Hold));
    assert!(even < 0.05, "{even}");
    assert!(held > 0.05, "{held}");
}

/// A hand that presses a wall of 200 N/m by four centimetres and comes back, again and again, joined by spring and damper to a tool that a
/// world of 10 ms tells of up to six milliseconds late: the greatest change of the force in a millisecond [N], and the least that is in the account
/// of energy [J].
fn pressed_late(passive: bool) -> (f64, f64) {
    let (body, depth, omega) = (200.0, 0.02, std::f64::consts::TAU / 1.2);
    let port = Port { coupling: Coupling { limit: 50.0, ..Coupling::DEFAULT }, passive };
    let share = port.coupling.stiffness / (port.coupling.stiffness + body);
    let hand = |time: f64| {
        let (sine, cosine) = (omega * time).sin_cos();
        Moving { place: Vec3::X * (depth * (1.0 - cosine)), velocity: Vec3::X * (depth * omega * sine) }
    };
    let (mut state, mut smoothing) = (Port::start(), Smoothing::new(Between::Interpolate, 0.01));
    let (mut step, mut greatest, mut least) = (1_u64, 0.0_f64, 0.0_f64);
    for tick in 0..6000_u64 {
        let now = tick as f64 * TICK;
        if tick >= 10 * step + step * 5 % 7 {
            let Moving { place, velocity } = hand(step as f64 * 0.01);
            smoothing.tell(step, Moving { place: place * share, velocity: velocity * share }, now);
            step += 1;
        }
        let before = state.force;
        port.tick(&mut state, Some(hand(now).place), TICK, smoothing.at(now));
        least = least.min(state.energy);
        if tick > 100 {
            greatest = greatest.max((state.force - before).length());
        }
    }
    (greatest, least)
}

/// However late messages of the world come, the force on a hand changes by what spring and damper make of how hand and tool move, and the
/// controller takes as much as is put in.
#[test]
fn late_messages_do_not_jump() {
    let (speed, acceleration) =
        (0.02 * std::f64::consts::TAU / 1.2, 0.02 * (std::f64::consts::TAU / 1.2).powi(2));
    // k (v + v') T + c (a + a') T, as hand and tool may be at any phase
    let Coupling { stiffness, damping, .. } = Coupling::DEFAULT;
    let bound = 2.0 * (stiffness * speed + damping * acceleration) * TICK;
    let (greatest, _) = pressed_late(false);
    assert!(greatest <= bound, "{greatest} {bound}");
    // a tool that stood still for a tick would be felt by this
    assert!(bound < damping * speed);
    // |F| |a| T² of a tick: the speed at the next tick is not known
    let (_, least) = pressed_late(true);
    assert!(least >= -stiffness * 0.04 * acceleration * TICK * TICK, "{least}");
}

const PRESS: &str = include_str!("../../../scenes/held_press/scene.toml");

/// A coarse slab that is pressed after a tenth of a second.
const SOON: [&str; 2] =
    ["bodies.slab.mesh.cells=[8, 8, 3]", "hands.right.motion.times=[0, 0.02, 0.1, 0.5, 1, 1.1]"];

/// The same slab of two meshes, refined where it is pressed.
const OF_LEVELS: [&str; 4] = [
    "systems.main.stepper={ name = \"staggered\", halvings = 5 }",
    "systems.main.steps_per_period=1",
    "bodies.slab.damping={ rayleigh_mass = 20, viscosity = \"1 Pa s\" }",
    "bodies.slab.levels={ count = 2, refine = 0.1, coarsen = 0.04 }",
];

fn press(settings: &[&str]) -> Scene {
    let settings: Vec<String> = settings.iter().map(|setting| (*setting).to_owned()).collect();
    read_text("held_press", PRESS, Path::new("."), &settings).unwrap_or_else(|error| panic!("{error}"))
}

/// Which points are held, how they are led and what they bear is in State: a run that goes on from a snapshot in the midst of pressing ends
/// with the same bits, of a body of one mesh and of one with levels.
#[test]
fn points_are_held_on_from_snapshots() {
    let of_levels: Vec<&str> = SOON.into_iter().chain(OF_LEVELS).collect();
    for settings in [&SOON[..], &of_levels[..]] {
        let run_on = |options: &Options| {
            let outcome = run(press(settings), options, &mut |_| Control::Continue).expect("a run");
            assert!(outcome.report.failure.is_none(), "{:?}", outcome.report.failure);
            outcome
        };
        let whole = run_on(&Options { steps: Some(60), ..Options::default() });
        let half = run_on(&Options { steps: Some(30), ..Options::default() });
        let pressed = half.traces.iter().find(|trace| trace.name == "on_slab").and_then(|trace| trace.last());
        assert!(pressed.is_some_and(|force| force[2] < -1e-3), "{pressed:?}");
        let (binary, isa) = (souple_run::binary(), souple_run::instruction_set());
        let state = half.world.state().clone();
        let resume = Snapshot { state, commands: Vec::new(), seed: 0, binary, isa: isa.to_owned() };
        let rest = run_on(&Options { steps: Some(30), resume: Some(resume), ..Options::default() });
        assert_eq!(whole.report.hashes.last(), rest.report.hashes.last());
    }
}

/// Where nothing leads points, and which keys say nothing, is said.
#[test]
fn wrong_holds() {
    let refused = |text: &str, setting: &str, expected: &str| {
        let read = read_text("scene", text, Path::new("."), &[setting.to_owned()]);
        let error = read.err().map(|error| error.to_string()).unwrap_or_default();
        assert!(error.contains(expected), "{setting}: {error}");
    };
    let imposed = |more: &str| format!("hands.right.touch={{ response = \"imposed\"{more} }}");
    // the cube's stepper leads no points, also where nothing is said of what is between device and tool
    let without = |line: &str| !line.starts_with("mass =") && !line.starts_with("coupling =");
    let cube: String = CUBE.lines().filter(|line| without(line)).flat_map(|line| [line, "\n"]).collect();
    refused(&cube, &imposed(", detect = \"triangles\""), "`hands.right` moves the points that it holds");
    refused(PRESS, &imposed(""), "displacements are imposed on triangles");
    refused(PRESS, &imposed(", detect = \"triangles\", friction = 0.5"), "`friction` says nothing");
    refused(PRESS, "hands.right.touch={ detect = \"triangles\", residual = 0 }", "`residual` says nothing");
    refused(PRESS, &imposed(", detect = \"triangles\", fraction = 1.5"), "1.5");
    refused(
        PRESS,
        &imposed(", detect = \"triangles\", fraction = 0"),
        "between 0 and 1, the lower end excluded",
    );
    refused(PRESS, &imposed(", detect = \"triangles\", residual = 0.02"), "less than the radius");
    // nothing is between this tool and its device
    refused(PRESS, "hands.right.mass=\"50 g\"", "`mass` says nothing to `response = \"imposed\"`");
    refused(PRESS, "hands.right.coupling.stiffness=100", "`stiffness` says nothing");
    refused(PRESS, "hands.right.coupling.damping=0", "`damping` says nothing");
    refused(PRESS, "hands.right.touch={ detect = \"triangles\" }", "holds no points");
}

/// A tool that begins in a body is told of, of those that hold points as of others.
#[test]
fn tools_that_begin_inside_are_told() {
    for response in ["penalty", "imposed"] {
        let deep = "hands.right.tool.centre=[0.0515, 0.0485, 0.05]";
        let touch = format!("hands.right.touch={{ detect = \"triangles\", response = \"{response}\" }}");
        let mut settings = vec![SOON[0], deep, &touch];
        if response == "penalty" {
            settings.push("probes.jump.quantity=\"hand.jump\"");
        }
        let warnings = press(&settings).warnings;
        assert!(warnings.iter().any(|warning| warning.contains("deep inside")), "{response}: {warnings:?}");
    }
}

/// Pins bear what they hold: a tool on a surface that is pinned feels nothing.
#[test]
fn pins_are_not_felt() {
    let felt = |pins: &str| {
        let scene = press(&[SOON[0], SOON[1], pins]);
        let options = Options { steps: Some(30), ..Options::default() };
        let outcome = run(scene, &options, &mut |_| Control::Continue).expect("a run");
        let last = |name: &str| {
            let trace = outcome.traces.iter().find(|trace| trace.name == name).expect("a trace");
            trace.last().expect("a value").to_vec()
        };
        (last("on_slab"), last("depth")[0])
    };
    let (free, _) = felt("bodies.slab.pins=[{ region = \"z_min\" }]");
    assert!(free[2] < -1e-3, "{free:?}");
    let (pinned, depth) = felt("bodies.slab.pins=[{ region = \"z_min\" }, { region = \"z_max\" }]");
    assert!(depth > 1e-3 && pinned.iter().all(|part| *part == 0.0), "{pinned:?} {depth}");
}

/// Without the controller, whose part in the force is not one of the world; and all that the slab bears is felt.
const FREELY: [&str; 2] = [
    "hands.right.passive=false",
    "hands.right.touch={ detect = \"triangles\", response = \"imposed\", weigh = \"alike\" }",
];

/// What devices are given and what the world told, against the clock: the greatest force told [N], all ticks, and the periods made.
fn felt_in_time(settings: &[&str], duration: f64) -> (Session, f64, Vec<Tick>, u64) {
    let settings: Vec<&str> = SOON.iter().chain(settings).copied().collect();
    let mut session = Session::start(press(&settings), &Options::default()).expect("a session");
    let in_time = run_in_time(&mut session, duration, &mut |_| Control::Continue).expect("a run in time");
    let told = in_time.traces.iter().find(|trace| trace.name == "on_slab").expect("a trace");
    let length = |force: &[f64]| Vec3::new(force[0], force[1], force[2]).length();
    let periods = in_time.world.periods;
    let peak = (0..=periods as usize).filter_map(|step| told.value(step)).map(length).fold(0.0, f64::max);
    (session, peak, in_time.served.ticks.into_iter().next().expect("a hand"), periods)
}

/// Against the clock a person feels the force of the points held, evenly from one that is told to the next: never more than the world has told, and
/// from moment to moment no further than between two of these in a period, or than it fades. What was led replays without a clock.
#[test]
fn held_points_are_felt_against_the_clock() {
    let (session, peak, ticks, periods) = felt_in_time(&FREELY, 1.0);
    let greatest = ticks.iter().map(|tick| tick.force.length()).fold(0.0, f64::max);
    assert!(peak > 1e-2 && greatest > 0.5 * peak && greatest < peak * (1.0 + 1e-9), "{greatest} of {peak}");
    // up against a ball that comes down
    assert!(ticks.iter().all(|tick| tick.force.z >= -0.1 * peak));
    for pair in ticks.windows(2) {
        let (step, time) = ((pair[1].force - pair[0].force).length(), pair[1].time - pair[0].time);
        assert!(step <= peak * (2.0 / 10e-3 + 1.0 / 0.2) * time + 1e-12, "{step} in {time} s of {peak}");
    }
    let commands = session.world.log().to_vec();
    let options = Options { steps: Some(periods), commands, ..Options::default() };
    let settings: Vec<&str> = SOON.into_iter().chain(FREELY).collect();
    let outcome = run(press(&settings), &options, &mut |_| Control::Continue).expect("a replay");
    assert_eq!(outcome.world.state(), session.world.state());
}

/// A device that is lost in the midst of pressing gives no force at once; when it is back the force grows within 200 ticks to what it is.
#[test]
fn held_points_are_felt_again() {
    let lost = ["hands.right.device.lost_at=0.5", "hands.right.device.lost_for=0.2", FREELY[0], FREELY[1]];
    let (_, peak, ticks, _) = felt_in_time(&lost, 1.2);
    let felt = ticks.iter().position(|tick| tick.force != Vec3::ZERO).expect("a force");
    let gone = ticks[felt..].iter().position(|tick| tick.force == Vec3::ZERO).expect("a loss");
    let after = &ticks[felt + gone..];
    let back = after.iter().position(|tick| tick.force != Vec3::ZERO).expect("a return");
    assert!(back > 1);
    for (count, tick) in after[back..].iter().enumerate() {
        let share = (count as f64 + 1.0) / 200.0;
        assert!(
            tick.force.length() <= peak * share.min(1.0) * (1.0 + 1e-9),
            "{count}: {:?} of {peak}",
            tick.force
        );
    }
}
