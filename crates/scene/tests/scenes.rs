//! Scenes from text to motion.

use std::path::Path;

use souple_engine::World;
use souple_math::Vec3;
use souple_scene::{Measurement, ProbeInfo, Scene, read_file, read_text};

fn folder() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn scene_with(text: &str, overrides: &[&str]) -> Scene {
    let overrides: Vec<String> = overrides.iter().map(|&text| text.to_owned()).collect();
    read_text("scene.toml", text, folder(), &overrides).unwrap_or_else(|errors| panic!("{errors}"))
}

fn scene(text: &str) -> Scene {
    scene_with(text, &[])
}

/// A world after some periods, and its probes.
fn run(scene: Scene, periods: usize) -> (World, Vec<ProbeInfo>) {
    let mut world = scene.model.start(scene.state);
    for _ in 0..periods {
        world.step().unwrap_or_else(|error| panic!("{error}"));
    }
    (world, scene.probes)
}

fn vector(probes: &[ProbeInfo], name: &str, world: &mut World) -> Vec3 {
    let probe = probes.iter().find(|probe| probe.name == name).unwrap_or_else(|| panic!("no probe {name}"));
    match probe.measure(world) {
        Measurement::Vector(vector) => vector,
        Measurement::Number(number) => panic!("{name} is the number {number}"),
    }
}

fn number(probes: &[ProbeInfo], name: &str, world: &mut World) -> f64 {
    let probe = probes.iter().find(|probe| probe.name == name).unwrap_or_else(|| panic!("no probe {name}"));
    match probe.measure(world) {
        Measurement::Number(number) => number,
        Measurement::Vector(vector) => panic!("{name} is the vector {vector:?}"),
    }
}

/// The scene of the contract falls by gravity and is held by its pins.
#[test]
fn the_clamped_bar_sags() {
    let path = folder().join("tests/bar.toml");
    let scene = read_file(&path, &[]).unwrap_or_else(|errors| panic!("{errors}"));
    let bar = scene.bodies[0].clone();
    assert_eq!((bar.name.as_str(), bar.rows.clone()), ("bar", 0..31 * 4 * 4));
    let (mut world, probes) = run(scene, 5);
    let tip = vector(&probes, "tip", &mut world);
    // within twice the deflection of a beam under its weight, w L⁴ / 8 E I with I = a⁴ / 12
    let sag = 1000.0 * 9.81 * 0.01 / (8.0 * 1e7 * 0.1_f64.powi(4) / 12.0);
    assert!(tip.y < 0.0 && tip.y > -2.0 * sag, "{tip:?}");
    let clamped = bar.mesh.points.iter().position(|point| point.x == 0.0).expect("a point of the clamp");
    assert_eq!(world.rows(0).positions[clamped], bar.mesh.points[clamped]);
}

const CUBE: &str = r#"
format = 1
[parameters]
stiffness = "20 kPa"
rate = 2.0
[world]
period = "10 ms"
[systems.slow]
stepper = "backward_euler"
newton_tolerance = 1e-12
[bodies.cube]
mesh = { generate = "box", size = [1, 1, 1], cells = [2, 2, 2], element = "hex8" }
material = { name = "neo_hookean", youngs_modulus = "$stiffness", poissons_ratio = "$rate / 10", density = 1000 }
translate = [0, 3, 0]
"#;

/// `static` under a force on one face: the reaction of the other face is its opposite, to the tolerance of
/// equilibrium relative to the load.
#[test]
fn reactions_balance_loads() {
    let text = CUBE.replace("\"backward_euler\"", "\"static\"").replace("1e-12", "1e-10")
        + r#"
[[bodies.cube.pins]]
region = "x_min"
[[bodies.cube.loads]]
region = "x_max"
force = [0, "-10 N", "$rate + 1"]
[probes.hold]
body = "cube"
region = "x_min"
quantity = "reaction"
[probes.move]
body = "cube"
region = { union = ["x_max", { nearest = [1, 4, 1] }] }
quantity = "displacement"
component = "y"
"#;
    let (mut world, probes) = run(scene(&text), 1);
    let hold = vector(&probes, "hold", &mut world);
    assert!((hold - Vec3::new(0.0, 10.0, -3.0)).length() < 1e-8 * 10.0, "{hold:?}");
    assert!(number(&probes, "move", &mut world) < 0.0);
}

/// A body without loads keeps its momentum: that of a translation, and of a turn about its centre.
#[test]
fn bodies_start_with_their_velocities() {
    let text = CUBE.to_owned()
        + r#"
velocity = [0, 0, 2]
angular_velocity = [0, 0.01, 0]
[probes.momentum]
quantity = "momentum"
[probes.place]
body = "cube"
quantity = "position"
[probes.volume]
body = "cube"
quantity = "volume"
[probes.energy]
quantity = "energy.kinetic"
"#;
    let (mut world, probes) = run(scene(&text), 0);
    let momentum = vector(&probes, "momentum", &mut world);
    assert!((momentum - Vec3::new(0.0, 0.0, 2000.0)).length() < 1e-9, "{momentum:?}");
    let place = vector(&probes, "place", &mut world);
    assert!((place - Vec3::new(0.5, 3.5, 0.5)).length() < 1e-12, "{place:?}");
    assert!((number(&probes, "volume", &mut world) - 1.0).abs() < 1e-12);
    // ½ m v², and ½ I ω² with an inertia below m · ½
    let energy = number(&probes, "energy", &mut world);
    assert!(energy > 2000.0 && energy < 2000.0 + 0.5 * 500.0 * 1e-4, "{energy}");
}

/// Pins lead by key frames along one axis and by a formula along another; the third stays free.
#[test]
fn pins_lead_axis_by_axis() {
    let text = CUBE.to_owned()
        + r#"
[[bodies.cube.pins]]
region = "all_of_it"
axes = "x"
motion = { times = [0, "20 ms"], offsets = [[0, 0, 0], [0.01, 9, 9]] }
[[bodies.cube.pins]]
region = { all = true }
axes = "y"
motion = { formula = [0, "0.1 * sin(t) + 0 * x", 0] }
[probes.corner]
body = "cube"
region = { points = [0] }
quantity = "displacement"
"#;
    let text = text.replace("\"all_of_it\"", "{ half_space = { point = [2, 0, 0], normal = [1, 0, 0] } }");
    let (mut world, probes) = run(scene(&text), 1);
    let corner = vector(&probes, "corner", &mut world);
    assert!((corner - Vec3::new(0.005, 0.1 * 0.01_f64.sin(), 0.0)).length() < 1e-12, "{corner:?}");
}

/// Points start displaced and moving as formulas of their rest places say; formulas that are not finite there are refused.
#[test]
fn formulas_at_the_start() {
    let start = r#"
[bodies.cube.start]
displacement = ["0.1 * x * y", 0, "0.05 * sin(z)"]
velocity = [0, "2 * x - z", 1]
"#;
    let made = scene(&(CUBE.to_owned() + start));
    let (rest, state) = (made.bodies[0].mesh.points.clone(), &made.state.systems[0]);
    for ((x, q), v) in rest.iter().zip(&state.q).zip(&state.v) {
        let displacement = Vec3::new(0.1 * x.x * x.y, 0.0, 0.05 * x.z.sin());
        assert!((*q - *x - displacement).length() < 1e-15);
        assert!((*v - Vec3::new(0.0, 2.0 * x.x - x.z, 1.0)).length() < 1e-15);
    }
    let refused = |more: &str| {
        read_text("start.toml", &(CUBE.to_owned() + more), folder(), &[]).err().unwrap().to_string()
    };
    let pole = refused("[bodies.cube.start]\nvelocity = [\"1 / x\", 0, 0]");
    assert!(pole.contains("bodies.cube.start") && pole.contains("finite at every point"), "{pole}");
    let time = refused("[bodies.cube.start]\nvelocity = [\"t\", 0, 0]");
    assert!(time.contains("there are: x, y, z"), "{time}");
}

/// The key frames of the solids' specification (its Code 14): led by 0.4 m within a second along one axis alone, held there
/// until t = 1001 s, then back. Across, the led points are free: the bar narrows while it is long, and is as it was at last.
#[test]
fn key_frames_lead_hold_and_return() {
    const LED: &str = r#"format = 1
[world]
period = "500 ms"
[systems.main]
stepper = "quasi_static"
[bodies.bar]
mesh = { generate = "bar", size = [4, 1, 1], cells = [4, 1, 1], element = "hex8" }
material = { name = "linear", youngs_modulus = "1 MPa", poissons_ratio = 0.3, density = 1000 }
[[bodies.bar.pins]]
region = "x_min"
axes = "x"
[[bodies.bar.pins]]
region = { points = [0] }
[[bodies.bar.pins]]
region = { box = [[-0.1, -0.1, 0.9], [0.1, 0.1, 1.1]] }
axes = "y"
[[bodies.bar.pins]]
region = "x_max"
axes = "x"
motion = { times = [0, 1, 1001, 1002], offsets = [[0, 7, 7], [0.4, 7, 7], [0.4, 7, 7], [0, 7, 7]] }
[probes.end]
body = "bar"
region = { nearest = [4, 1, 1] }
quantity = "displacement"
"#;
    let scene = scene(LED);
    let mut world = scene.model.start(scene.state);
    let mut ends = Vec::new();
    for period in 1..=2004 {
        world.step().unwrap_or_else(|error| panic!("{error}"));
        if [1, 2, 1000, 2002, 2003, 2004].contains(&period) {
            ends.push(vector(&scene.probes, "end", &mut world));
        }
    }
    // linear between keys; a strain of a tenth narrows by three hundredths of a metre
    for (end, led) in ends.iter().zip([0.2, 0.4, 0.4, 0.4, 0.2, 0.0]) {
        let expected = Vec3::new(led, -0.3 * led / 4.0, -0.3 * led / 4.0);
        assert!((*end - expected).length() < 1e-6, "{ends:?}");
    }
}

/// A motion that is away from rest at the start is no tear in a static scene: all points are led there together, in as
/// many load steps as wanted. A homogeneous stretch by half is `(1.5)` along and what the law makes of it across.
#[test]
fn statics_lead_from_rest() {
    const PULLED: &str = r#"format = 1
[world]
period = "1 s"
[bodies.bar]
mesh = { generate = "bar", size = [1, 0.1, 0.1], cells = [8, 1, 1], element = "hex8" }
material = { name = "neo_hookean", youngs_modulus = "1 MPa", poissons_ratio = 0.3, density = 1000 }
[[bodies.bar.pins]]
region = "x_min"
axes = "x"
[[bodies.bar.pins]]
region = "y_min"
axes = "y"
[[bodies.bar.pins]]
region = "z_min"
axes = "z"
[[bodies.bar.pins]]
region = "x_max"
axes = "x"
motion = { formula = [0.5, 0, 0] }
[probes.middle]
body = "bar"
region = { nearest = [0.5, 0.1, 0.1] }
quantity = "displacement"
[probes.end]
body = "bar"
region = "x_max"
quantity = "displacement"
"#;
    let pulled = |steps: usize| {
        let stepper = format!("systems.main.stepper={{ name = \"static\", load_steps = {steps} }}");
        let (mut world, probes) = run(scene_with(PULLED, &[&stepper]), 0);
        assert_eq!(vector(&probes, "end", &mut world), Vec3::ZERO, "at rest to begin with");
        world.step().unwrap_or_else(|error| panic!("{error}"));
        vector(&probes, "middle", &mut world)
    };
    let (at_once, in_four) = (pulled(1), pulled(4));
    // Newton's tolerance is 1e-9 of the forces, some 1e-9 of the stretch
    assert!(
        (at_once.x - 0.25).abs() < 1e-8 && (at_once - in_four).length() < 1e-8,
        "{at_once:?} {in_four:?}"
    );
}

/// What `--set` changes is what the scene would say: same model, other hash.
#[test]
fn overrides_change_the_scene() {
    let written = CUBE.replace("20 kPa", "40 kPa") + "velocity = [0, 0, 2]\n";
    let set = ["parameters.stiffness=40 kPa", "bodies.cube.velocity=[0, 0, 2]"];
    let (a, b) = (scene(&written), scene_with(CUBE, &set));
    assert_eq!(a.state, b.state);
    assert_ne!(a.scene_sha256, b.scene_sha256);
    assert_eq!(a.scene_sha256, scene(&written).scene_sha256);
}

/// Two cubes side by side, attached where they touch: a pull on one moves both, and their momentum together is
/// the impulse, to the tolerance of the solve.
#[test]
fn attached_bodies_move_together() {
    let second = CUBE[CUBE.find("[bodies.cube]").expect("a body")..]
        .replace("cube", "other")
        .replace("[0, 3, 0]", "[1, 3, 0]");
    let text = format!(
        "{CUBE}{second}{}",
        r#"
[[bodies.other.loads]]
region = "x_max"
force = [1, 0, 0]
[[attachments]]
from = "other"
region = "x_min"
to = "cube"
stiffness = "1 MN/m"
damping = "10 N s/m"
[probes.first]
body = "cube"
quantity = "velocity"
[probes.momentum]
quantity = "momentum"
"#
    );
    let (mut world, probes) = run(scene(&text), 20);
    let momentum = vector(&probes, "momentum", &mut world);
    assert!((momentum - Vec3::new(0.2, 0.0, 0.0)).length() < 1e-6, "{momentum:?}");
    assert!(vector(&probes, "first", &mut world).x > 1e-5);
}

/// A cube laid on a floor rests there: the floor bears its weight.
#[test]
fn a_cube_rests_on_a_floor() {
    let text = CUBE
        .replace("period = \"10 ms\"", "period = \"50 ms\"\ngravity = [0, -10, 0]")
        .replace("20 kPa", "1 MPa")
        .replace("1e-12", "1e-8")
        + r#"
damping = { rayleigh_mass = "20 /s", viscosity = "100 Pa s" }
[shapes.floor]
shape = { name = "plane", point = [0, 3, 0] }
[[contacts]]
name = "stand"
body = "cube"
shape = "floor"
friction = 0.5
[probes.stand]
body = "cube"
quantity = "contact_force"
contact = "stand"
"#;
    let (mut world, probes) = run(scene(&text), 40);
    let force = vector(&probes, "stand", &mut world);
    assert!((force - Vec3::new(0.0, 10_000.0, 0.0)).length() < 1.0, "{force:?}");
}

/// Two cubes fly into each other: their momentum together stays what it was, to the tolerance of the solve.
#[test]
fn cubes_collide() {
    let second = CUBE[CUBE.find("[bodies.cube]").expect("a body")..]
        .replace("cube", "other")
        .replace("[0, 3, 0]", "[1.01, 3.1, 0.1]");
    let contact = "[[contacts]]\nname = \"crash\"\nbody = \"cube\"\nother = \"other\"\n";
    let probes = "[probes.momentum]\nquantity = \"momentum\"\n[probes.other]\nbody = \"other\"\nquantity = \"velocity\"\n\
                  [probes.crash]\nbody = \"cube\"\nquantity = \"contact_force\"\ncomponent = \"x\"\n";
    let text = format!("{CUBE}velocity = [1, 0, 0]\n{second}{contact}{probes}");
    let (mut world, probes) = run(scene(&text), 10);
    let momentum = vector(&probes, "momentum", &mut world);
    assert!((momentum - Vec3::new(1000.0, 0.0, 0.0)).length() < 1e-6 * 1000.0, "{momentum:?}");
    assert!(vector(&probes, "other", &mut world).x > 0.0);
    assert!(number(&probes, "crash", &mut world) < 0.0);
}

/// Two systems of different rates, joined by coupling springs.
#[test]
fn systems_are_coupled() {
    let second = CUBE[CUBE.find("[bodies.cube]").expect("a body")..]
        .replace("cube", "other")
        .replace("[0, 3, 0]", "[1, 3, 0]");
    let text = format!(
        "{CUBE}system = \"slow\"\nvelocity = [0.01, 0, 0]\n{second}system = \"fast\"\n{}",
        r#"
[systems.fast]
stepper = "symplectic_euler"
steps_per_period = 50
[[couplings]]
from = "other"
region = "x_min"
to = "cube"
stiffness = "1 kN/m"
damping = "10 N s/m"
[probes.other]
body = "other"
quantity = "velocity"
"#
    );
    let scene = scene(&text);
    assert_eq!(scene.model.couplings.len(), 9);
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
    let (mut world, probes) = run(scene, 20);
    assert!(vector(&probes, "other", &mut world).x > 0.0);
}

/// An included file gives what the including one does not say.
#[test]
fn included_files_are_below() {
    let folder = std::env::temp_dir().join(format!("souple_include_{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    std::fs::write(folder.join("base.toml"), CUBE).expect("a file");
    let over = "include = [\"base.toml\"]\n[world]\nperiod = \"20 ms\"\n[bodies.cube]\nmaterial = { name = \"linear\", youngs_modulus = 1, poissons_ratio = 0, density = 1 }\n";
    let scene = read_text("over.toml", over, &folder, &[]);
    std::fs::remove_dir_all(&folder).expect("the folder again");
    let scene = scene.unwrap_or_else(|errors| panic!("{errors}"));
    assert_eq!(scene.model.period, 0.02);
    assert_eq!(scene.model.systems[0].name, "slow");
    assert_eq!(scene.model.systems[0].mass.diagonal.iter().sum::<f64>(), 1.0);
}

/// The loads of a face, of its area and of the volume: what holds the cube carries their totals.
#[test]
fn loads_of_faces_and_volumes_have_their_totals() {
    let total = |load: &str| {
        // points and faces keep their places within the strain of 1e-7, and forces of 1e7 Pa m² round to 1e-9 N
        let text = CUBE.replace("\"backward_euler\"", "\"static\"").replace("20 kPa", "20 MPa")
            + "[[bodies.cube.pins]]\nregion = \"y_min\"\n[[bodies.cube.loads]]\n"
            + load
            + "\n[probes.hold]\nbody = \"cube\"\nregion = \"y_min\"\nquantity = \"reaction\"\n";
        let (mut world, probes) = run(scene(&text), 1);
        vector(&probes, "hold", &mut world)
    };
    for (load, expected) in [
        ("region = \"y_max\"\ntraction = [\"3 Pa\", 1, 0]", Vec3::new(-3.0, -1.0, 0.0)),
        // one cell of eight
        ("region = { cells = [3] }\nbody_force = [0, 0, \"8 N/m^3\"]", Vec3::new(0.0, 0.0, -1.0)),
        // by the points: the trapezium rule is exact for a linear field
        ("region = { all = true }\nbody_force = [\"2 * x\", 0, 0]", Vec3::new(-1.0, 0.0, 0.0)),
        ("region = \"y_max\"\npressure = \"1 Pa\"", Vec3::new(0.0, 1.0, 0.0)),
    ] {
        let hold = total(load);
        assert!((hold - expected).length() < 1e-6 * expected.length(), "{load}: {hold:?}");
    }
}

/// A pin that turns leads its points around the pivot: a quarter turn of a face in its plane.
#[test]
fn pins_turn_about_their_pivot() {
    let text = CUBE.to_owned()
        + r#"
[[bodies.cube.pins]]
region = { all = true }
rotation = { formula = "[0, 0, pi / 2 * t / 0.05]" }
motion = { formula = "[0, 0, t]" }
pivot = [0, 3, 0]
[probes.corner]
body = "cube"
region = { nearest = [1, 3, 0] }
quantity = "position"
"#;
    let (mut world, probes) = run(scene(&text), 5);
    let corner = vector(&probes, "corner", &mut world);
    // sine and cosine of a right angle, to rounding
    assert!((corner - Vec3::new(0.0, 4.0, 0.05)).length() < 1e-14, "{corner:?}");
}

/// Gravity as a formula of time: a free cube follows its second integral to the first order of the stepper.
#[test]
fn gravity_may_vary() {
    let text = CUBE.replace("[systems.slow]", "gravity = [0, \"10 * t\", 0]\n[systems.slow]")
        + "[probes.middle]\nbody = \"cube\"\nregion = { nearest = [0.5, 3.5, 0.5] }\nquantity = \"velocity\"\n";
    let (mut world, probes) = run(scene(&text), 10);
    let speed = vector(&probes, "middle", &mut world).y;
    // backward Euler sums g at the ends of steps: h Σ 10 i h = 10 h² 55
    assert!((speed - 10.0 * 1e-4 * 55.0).abs() < 1e-9, "{speed}");
}

/// A ball that hangs on nothing but soft springs and is pressed from all sides is in equilibrium from the first step on: what is left
/// is rounding of forces that balance, and no reason to refuse a step.
#[test]
fn balanced_bodies_stay_in_equilibrium() {
    let text = r#"
        format = 1
        [world]
        period = "1 ms"
        [systems.main]
        stepper = "quasi_static"
        [bodies.ball]
        mesh = { generate = "sphere", radius = 0.1, cells = 4, element = "hex8" }
        material = { name = "ogden", mu = [20e3], alpha = [2], bulk_modulus = "100 kPa", density = 1000 }
        damping = { viscosity = 100 }
        [[bodies.ball.springs]]
        region = { all = true }
        stiffness = 0.001
        [[bodies.ball.loads]]
        region = "surface"
        pressure = "20 kPa"
        "#;
    let (world, _) = run(scene(text), 70);
    // seventy periods of a millisecond, none refused
    assert!((world.time() - 0.07).abs() < 1e-12, "{}", world.time());
}
