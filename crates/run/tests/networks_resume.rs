//! Networks go on from a snapshot as though nothing had happened, whatever they remember.

use std::fmt::Write as _;
use std::path::Path;

use souple_engine::World;
use souple_run::{Control, Options, Outcome, read_snapshot, run};

/// Pairs of masses side by side, of which one end is fixed and the other swings. Further off grains fall into a trough and
/// stick there; a string sounds.
const HEAD: &str = r#"
format = 1
[world]
period = "5 ms"
gravity = [0, 0, -9.81]
[systems.main]
stepper = "t_simulation"
steps_per_period = 5
[networks.net]
account = true
[networks.net.masses.grains]
lattice = { origin = [0, 3.02, 0.06], spacing = 0.095, counts = [4, 4, 4] }
mass = 0.05
[networks.net.masses.ground]
lattice = { origin = [-0.03, 2.98, 0], spacing = 0.1, counts = [5, 5, 1] }
mass = 1
fixed = true
[[networks.net.crowds]]
of = ["grains"]
law = { name = "cohesion", hard = 0.095, distance = 0.1, peak = 0.105, range = 0.12, repulsion = 2000, cohesion = 300, damping = 1 }
friction = { static = 0.6, kinetic = 0.5, stiffness = 800, damping = 0.5, hook_viscosity = 100, speed = 0.01 }
[[networks.net.crowds]]
of = ["grains", "ground"]
law = { name = "finite_state", states = { free = "max(0, 2000 * (0.1 - D))", stuck = "2000 * (0.1 - D) - V" }, transitions = { "free -> stuck" = "D < 0.099", "stuck -> free" = "D > 0.106" } }
range = 0.12
[networks.net.masses.wax]
lattice = { origin = [0, 6, 0.06], spacing = 0.1, counts = [3, 3, 3] }
mass = 0.05
[[networks.net.crowds]]
of = ["wax"]
law = { name = "cohesion", hard = 0.095, distance = 0.1, peak = 0.105, range = 0.12, repulsion = 2000, cohesion = 30, damping = 1 }
fusible = { capacity = 2, conductance = 1, softening = 300, melting = 320, stiffness = 300, damping = 0.2, reach = 0.11, temperature = "290 + 300 * (z - 0.06)", heating = "if(t < 0.2, 150, -150)" }
[shapes.wall]
shape = { name = "plane", point = [-0.06, 0, 0], normal = [1, 0, 0.2] }
[[contacts]]
body = "net"
region = "grains"
shape = "wall"
stiffness = 1000
friction = 0.5
thickness = 0.04
[networks.net.masses.string]
line = { from = [0, 5, 0], to = [1, 5, 0], count = 9 }
mass = 0.01
[[networks.net.links]]
of = ["string"]
law = { name = "spring_damper", stiffness = 400, damping = 0.001 }
along = [0, 0, 1]
reach = 0.13
[[networks.net.pins]]
region = { union = [{ nearest = [0, 5, 0] }, { nearest = [1, 5, 0] }] }
[networks.net.start]
velocity = [0, 0, "if(y > 4.9, 0.5, 0)"]
[probes.pickup]
body = "net"
region = { nearest = [0.25, 5, 0] }
quantity = "velocity"
component = "z"
[probes.energy]
quantity = "energy.balance"
[sounds.string]
probes = ["pickup"]
gain = 1
[run]
duration = "0.6 s"
frames = 0
"#;

/// Links that remember, each on its own pair: what they were strained to, which state they are in, what flows on, what was torn.
const LAWS: &[&str] = &[
    r#"{ name = "elasto_plastic", stiffness = 400, hardening = 100, traction = 4 }"#,
    r#"{ name = "elasto_plastic", stiffness = 400, hardening = 100, traction = 4, rupture = 6 }"#,
    r#"{ name = "elasto_plastic", stiffness = 400, hardening = 100, traction = 4, rupture = 4.5 }"#,
    r#"{ name = "maxwell", stiffness = 400, viscosity = 60 }"#,
    r#"{ name = "bingham", stiffness = 400, viscosity = 20, traction = 3, compression = 3 }"#,
    r#"{ name = "burger", solid_stiffness = 400, solid_viscosity = 10, fluid_stiffness = 600, fluid_viscosity = 200 }"#,
    r#"{ name = "rheological", network = "spring(400) - (slider(3) | spring(100)) - (spring(900) | damper(10))" }"#,
    r#"{ name = "finite_state", states = { low = "4 - 50 * (D - L0)", high = "-4 - 50 * (D - L0)" }, transitions = { "low -> high" = "D > 0.503", "high -> low" = "D < 0.499" }, entries = { high = "L0 = D" } }"#,
    r#"{ name = "conditional", stiffness = 400, states = { firm = "SUP, L, 0.01 -> slip", slip = "L0=D; ANY -> firm" } }"#,
    r#"{ name = "conditional", stiffness = 400, damping = 1, states = { held = "CHK, 400; SUP, L, 0.012 -> gone", gone = "CHK, 0; CHS, L -> held" } }"#,
    r#"{ name = "formula", push = "-400 * (D - L0) - 2 * V * (1 + 100 * abs(D - D_before))" }"#,
];

fn text() -> String {
    let mut text = HEAD.to_owned();
    for (number, law) in LAWS.iter().enumerate() {
        let y = 0.2 * number as f64;
        let pair = format!(
            "[networks.net.masses.fixed{number}]\npositions = [[0, {y}, 0]]\nmass = 1\nfixed = true\n\
             [networks.net.masses.free{number}]\npositions = [[0.5, {y}, 0]]\nmass = 0.2\nvelocity = [0.9, 0, 0]\n\
             [[networks.net.links]]\nname = \"law{number}\"\nlaw = {law}\nof = [\"fixed{number}\", \"free{number}\"]\nall = true\n"
        );
        text.push_str(&pair);
    }
    // what is driven is remembered too: a connection that latches
    let _ = write!(
        text,
        "[[networks.net.links]]\nname = \"latch\"\nlaw = {{ name = \"spring\", stiffness = 90 }}\nof = [\"fixed0\", \"free3\"]\nall = true\n\
         [networks.net.controls.latch]\nlinks = \"latch\"\nconnects = \"previous > 0 and speed < 1.1\"\n\
         inputs.speed = {{ of = \"free3\", quantity = \"speed\" }}\n"
    );
    text
}

fn go(options: &Options) -> Outcome {
    let scene = souple_scene::read_text("net.toml", &text(), Path::new("."), &[]).unwrap();
    run(scene, options, &mut |_| Control::Continue).unwrap()
}

fn with_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(work)
}

/// From any snapshot, by any number of threads: the same hashes, the same probes, the same sound.
#[test]
fn networks_resume_with_all_they_remember() {
    let folder = std::env::temp_dir().join(format!("souple_networks_resume_{}", std::process::id()));
    let options = Options {
        out: Some(folder.clone()),
        // of which the dates of the snapshots are no multiples
        hash_every: Some(12),
        snapshot_every: Some(40),
        ..Options::default()
    };
    let whole = with_threads(1, || go(&options));
    for period in [40_u64, 80] {
        let path = folder.join(format!("snapshot_{period:08}.souple"));
        let snapshot = read_snapshot(&path, &whole.report.scene_sha256).unwrap();
        let resumed = with_threads(3, || {
            go(&Options { out: None, snapshot_every: None, resume: Some(snapshot), ..options.clone() })
        });
        let from = |outcome: &Outcome| -> Vec<_> {
            outcome.report.hashes.iter().filter(|hash| hash.0 > period).cloned().collect()
        };
        assert_eq!(from(&whole), from(&resumed), "hashes after {period}");
        assert_eq!(whole.world.state(), resumed.world.state());
        for (trace, again) in whole.traces.iter().zip(&resumed.traces) {
            let heard = &trace.values[period as usize..];
            assert_eq!(heard, again.values, "what `{}` reads from {period} on", trace.name);
        }
    }
    std::fs::remove_dir_all(folder).unwrap();
}

/// The snapshots are worth something: by the first of them each law remembers what it did not at the start.
#[test]
fn memories_are_in_use() {
    let at = |steps: u64| go(&Options { steps: Some(steps), ..Options::default() }).world;
    let [start, middle, end] = [0, 40, 120].map(at);
    let ranges = start.model().systems[0].memory_ranges();
    let memory = |world: &World, range: &std::ops::Range<usize>| {
        world.state().systems[0].memory[range.clone()].to_vec()
    };
    let forces = &start.model().systems[0].forces;
    let same = |number: &usize| memory(&start, &ranges[*number]) == memory(&middle, &ranges[*number]);
    let idle: Vec<&str> = (0..forces.len()).filter(same).map(|number| forces[number].name()).collect();
    // a formula and a spring have no memory, gravity neither; what balls on the ground remember is kept, below
    assert_eq!(idle, ["net.links[11]", "net.links[12]", "net.crowds[1]", "gravity"]);
    let kept = |world: &World| world.state().systems[0].kept.clone();
    let keeping = kept(&middle).counts.iter().filter(|count| **count > 0).count();
    assert!(
        keeping == 3 && kept(&middle) != kept(&end),
        "{keeping}: grains stick to each other and to the ground, wax to itself"
    );
    assert_ne!(start.state().driven, end.state().driven, "the latch never opened");
}
