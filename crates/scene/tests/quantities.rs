//! Quantities of probes against answers known by hand.

use std::path::Path;

use souple_engine::World;
use souple_math::Vec3;
use souple_scene::spec::quantity::QUANTITIES;
use souple_scene::{Measurement, ProbeInfo, read_text};

const CUBE: &str = r#"
format = 1
[world]
period = "1 ms"
gravity = [0, -10, 0]
[bodies.cube]
mesh = { generate = "box", size = [1, 1, 1], cells = [2, 2, 2], element = "hex8" }
material = { name = "neo_hookean", youngs_modulus = "1 MPa", poissons_ratio = 0.3, density = 1000 }
"#;

fn start(text: &str) -> (World, Vec<ProbeInfo>) {
    let scene =
        read_text("scene.toml", text, Path::new("."), &[]).unwrap_or_else(|errors| panic!("{errors}"));
    (scene.model.start(scene.state), scene.probes)
}

fn value(world: &mut World, probes: &[ProbeInfo], name: &str) -> Vec3 {
    let probe = probes.iter().find(|probe| probe.name == name).unwrap_or_else(|| panic!("no probe {name}"));
    match probe.measure(world) {
        Measurement::Vector(vector) => vector,
        Measurement::Number(number) => Vec3::new(number, 0.0, 0.0),
    }
}

fn probe(name: &str, quantity: &str, more: &str) -> String {
    format!("[probes.{name}]\nbody = \"cube\"\nquantity = \"{quantity}\"\n{more}\n")
}

/// A cube led by `u = t (x, −2y, 3z)` against the formula of two thirds of that and against a finer cube led by half
/// of it, whose trilinear cells carry a linear field exactly: what is left is a third and a half of it.
#[test]
fn values_against_a_formula_and_another_body() {
    let led = |body: &str, factor: f64| {
        let formula = format!("[{factor} * t * x, {factor} * -2 * t * y, {factor} * 3 * t * z]");
        format!("[[bodies.{body}.pins]]\nregion = {{ all = true }}\nmotion = {{ formula = \"{formula}\" }}\n")
    };
    let fine = CUBE.split("[bodies.cube]").nth(1).expect("a body").replace("[2, 2, 2]", "[3, 3, 3]");
    let formula = "against = { formula = \"[2 / 3 * t * x, -4 / 3 * t * y, 2 * t * z]\" }\n";
    let body = "against = { body = \"fine\" }\n";
    let text = [
        CUBE.to_owned(),
        led("cube", 1.0),
        format!("[bodies.fine]{fine}"),
        led("fine", 0.5),
        probe("formula", "displacement", formula),
        probe("body", "displacement", body),
        probe("far", "displacement", &format!("{body}component = \"length\"\nreduce = \"max\"")),
        probe("mean", "displacement", &format!("{body}component = \"y\"\nreduce = \"mean_magnitude\"")),
        probe("speed", "velocity", body),
    ];
    let (mut world, probes) = start(&text.concat());
    for _ in 0..2 {
        world.step().expect("a step");
    }
    let t = 2e-3;
    // means of x, y, z over the points are one half
    let close = |a: Vec3, b: Vec3| assert!((a - b).length() < 1e-14, "{a:?} {b:?}");
    let mean = Vec3::new(0.5, -1.0, 1.5);
    close(value(&mut world, &probes, "formula"), mean * (t / 3.0));
    close(value(&mut world, &probes, "body"), mean * (t / 2.0));
    close(value(&mut world, &probes, "far"), Vec3::new(14.0_f64.sqrt() * t / 2.0, 0.0, 0.0));
    close(value(&mut world, &probes, "mean"), Vec3::new(t / 2.0, 0.0, 0.0));
    // velocities are differences of positions over 1 ms: a thousand times their rounding
    assert!((value(&mut world, &probes, "speed") - mean * 0.5).length() < 1e-11);
}

/// Formulas that a probe is held against may be quantities, in the dimension of what is measured.
#[test]
fn values_are_held_against_quantities() {
    let held = probe("gap", "displacement", "against = { formula = [\"1 cm\", 0, 0] }\n")
        + &probe("speed", "velocity", "against = { formula = [\"1 cm/s\", 0, 0] }\n");
    let (mut world, probes) = start(&format!("{CUBE}{held}"));
    // means of values that are all the same, but for the rounding of their sum
    for name in ["gap", "speed"] {
        let apart = value(&mut world, &probes, name) - Vec3::new(-0.01, 0.0, 0.0);
        assert!(apart.length() < 1e-16, "{name}: {apart:?}");
    }
}

/// What a probe cannot be held against is refused where it stands.
#[test]
fn what_nothing_is_held_against() {
    let small =
        CUBE.split("[bodies.cube]").nth(1).expect("a body").replace("size = [1, 1, 1]", "size = [0.5, 1, 1]");
    let refusals = [
        ("displacement", "against = { body = \"small\" }", "is outside of body `small`"),
        ("displacement", "against = { body = \"smal\" }", "there is no body `smal` (did you mean `small`?)"),
        // where it stands
        ("displacement", "against = { body = \"smal\" }", "probes.gap.against.body: "),
        ("penetration", "against = { body = \"small\" }", "probes.gap.against.body: "),
        ("displacement", "against = { formula = [0, \"1/x\", 0] }", "(0, inf, 0) at t = 0"),
        ("displacement", "against = { formula = [\"1 kg\", 0, 0] }", "a length [m]"),
        ("displacement", "against = {}", "`against` names 0 things"),
        ("displacement", "against = { formula = [0, 0, 0], body = \"small\" }", "`against` names 2 things"),
        ("displacement", "against = { formula = \"[0, w, 0]\" }", "`w`"),
        ("reaction", "against = { body = \"small\" }", "`reaction` is not carried"),
        ("penetration", "against = { formula = [0, 0, 0] }", "`penetration` is no vector at points"),
        ("volume", "against = { formula = [0, 0, 0] }", "`volume` is no vector at points"),
        ("displacement", "reduce = \"mean_magnitude\"", "no least, greatest or magnitude"),
    ];
    for (quantity, more, message) in refusals {
        let text =
            format!("{CUBE}[bodies.small]{small}translate = [0.1, 0, 0]\n{}", probe("gap", quantity, more));
        let read = read_text("scene.toml", &text, Path::new("."), &[]);
        let errors = read.err().map(|errors| errors.to_string()).unwrap_or_default();
        assert!(errors.contains(message), "{more}: {errors}");
    }
}

/// A body led as a whole by `½ a t²` upward: the reaction is `m (a − g)`, whatever the mass matrix; to the tolerance of
/// the solve for the consistent one, and the rounding of velocities over a step of 1 ms (10⁻¹⁶/10⁻³ relative).
#[test]
fn reactions_bear_weight_and_inertia() {
    for mass in ["lumped", "consistent"] {
        let led =
            "[[bodies.cube.pins]]\nregion = { all = true }\nmotion = { formula = [0, \"1.5 * t^2\", 0] }\n";
        let text = format!("{CUBE}mass = \"{mass}\"\n{led}{}", probe("hold", "reaction", ""));
        let (mut world, probes) = start(&text);
        for _ in 0..3 {
            world.step().expect("a step");
        }
        let hold = value(&mut world, &probes, "hold");
        assert!((hold - Vec3::new(0.0, 13_000.0, 0.0)).length() < 1e-6, "{mass}: {hold:?}");
    }
}

/// A cube held at one side alone, before anything moved: the pins feel the weight of what they hold, and a consistent
/// mass hands them the inertia of the free neighbours too, so that the sum is that of the whole row of masses.
#[test]
fn held_points_feel_their_neighbours() {
    let text = format!(
        "{CUBE}mass = \"consistent\"\n[[bodies.cube.pins]]\nregion = \"y_max\"\n{}",
        probe("hold", "reaction", "")
    );
    let (mut world, probes) = start(&text);
    let hold = value(&mut world, &probes, "hold");
    // M a = f + r with a = 0 at pins: 0 < r < weight, for the free part falls and pulls no more than its mass
    assert!(hold.y > 0.0 && hold.y < 10_000.0 && hold.x.abs() + hold.z.abs() < 1e-9 * 10_000.0, "{hold:?}");
}

/// A cube that lies on a floor by `d`: each of nine points is pressed by `k d` times its share, so the sum is `9 k d`;
/// nothing is tangential, and moments about two places differ by the lever between them.
#[test]
fn contacts_press_by_their_depth() {
    let (stiffness, depth) = (1e5, 1e-3);
    let contact = format!(
        "translate = [0, -{depth}, 0]\n[shapes.floor]\nshape = {{ name = \"plane\" }}\n[[contacts]]\nname = \"stand\"\n\
         body = \"cube\"\nshape = \"floor\"\nregion = \"y_min\"\nstiffness = {stiffness}\nfriction = 0.5\n"
    );
    let text = format!(
        "{CUBE}{contact}{}{}{}{}{}",
        probe("normal", "contact_force.normal", "contact = \"stand\""),
        probe("tangential", "contact_force.tangential", ""),
        probe("depth", "penetration", ""),
        probe("own", "contact_torque", ""),
        probe("about", "contact_torque", "about = [0, 0, 0]"),
    );
    let (mut world, probes) = start(&text);
    let total = 9.0 * stiffness * depth;
    let rounding = 1e-12 * total;
    let normal = value(&mut world, &probes, "normal");
    assert!((normal - Vec3::new(0.0, total, 0.0)).length() < rounding, "{normal:?}");
    assert!(value(&mut world, &probes, "tangential").length() < rounding);
    assert!((value(&mut world, &probes, "depth").x - depth).abs() < 1e-15);
    // the moments about two places differ by the lever between them: the centre of mass and the origin
    let (own, about) = (value(&mut world, &probes, "own"), value(&mut world, &probes, "about"));
    let lever = Vec3::new(0.5, 0.5 - depth, 0.5);
    assert!((about - own - lever.cross(normal)).length() < rounding, "{own:?} {about:?}");
}

/// A cube that turns about z through its centre at `ω`: its angular momentum is `I ω` about its centre and the same
/// about any place, since its momentum is zero; moving at `v` besides, `m c × v` is added about the origin.
#[test]
fn momenta_of_a_spinning_cube() {
    let moving = "velocity = [0, 2, 0]\nangular_velocity = [0, 0, 3]\n";
    let probes = [
        probe("mass", "mass", ""),
        probe("centre", "centre_of_mass", ""),
        probe("linear", "momentum", ""),
        probe("spin", "angular_momentum", ""),
        probe("orbit", "angular_momentum", "about = [0, 0, 0]"),
        "[probes.world]\nquantity = \"angular_momentum\"\n".to_owned(),
        "[probes.elsewhere]\nquantity = \"angular_momentum\"\nabout = [0.5, 0.5, 0.5]\n".to_owned(),
    ];
    let (mut world, probes) = start(&format!("{CUBE}{moving}{}", probes.concat()));
    let mut read = |name: &str| value(&mut world, &probes, name);
    let close = |a: Vec3, b: Vec3| assert!((a - b).length() < 1e-9, "{a:?} {b:?}");
    close(read("mass"), Vec3::new(1000.0, 0.0, 0.0));
    close(read("centre"), Vec3::new(0.5, 0.5, 0.5));
    close(read("linear"), Vec3::new(0.0, 2000.0, 0.0));
    // lumped: points at 0, ½, 1 with weights ¼, ½, ¼ in each direction, so Σ m (x−½)² = m/8 and I = m/4
    let spin = Vec3::new(0.0, 0.0, 1000.0 / 4.0 * 3.0);
    close(read("spin"), spin);
    close(read("elsewhere"), spin);
    let orbit = spin + Vec3::new(0.5, 0.5, 0.5).cross(Vec3::new(0.0, 2000.0, 0.0));
    close(read("orbit"), orbit);
    close(read("world"), orbit);
}

/// A body turned as a whole by its pins about an axis through the origin and then stopped: the torque is that of the
/// weight, `−c × m g`, about the origin, and none about its centre of mass.
#[test]
fn torques_bear_the_weight() {
    let held = "[[bodies.cube.pins]]\nregion = { all = true }\n";
    let text = format!(
        "{CUBE}{held}{}{}",
        probe("own", "torque", ""),
        probe("about", "torque", "about = [0, 0, 0]")
    );
    let (mut world, probes) = start(&text);
    let weight = 10_000.0;
    assert!(value(&mut world, &probes, "own").length() < 1e-10 * weight);
    let about = value(&mut world, &probes, "about");
    let expected = Vec3::new(0.5, 0.5, 0.5).cross(Vec3::new(0.0, weight, 0.0));
    assert!((about - expected).length() < 1e-10 * weight, "{about:?}");
}

/// A bar stretched by its pins to `F = diag(1.2, 1, 1)`: stretches, volume ratio and their places among the principal
/// values; `linear` gives the stress `σ = λ tr ε + 2 μ ε`.
#[test]
fn stretched_cells() {
    let text = CUBE.replace("neo_hookean", "linear")
        + "[[bodies.cube.pins]]\nregion = { all = true }\nmotion = { formula = [\"0.2 * x\", 0, 0] }\n"
        + &["max_principal_stretch", "min_principal_stretch", "volume_ratio", "max_principal_stress"]
            .map(|quantity| probe(quantity, quantity, ""))
            .concat()
        + &probe("min_principal_stress", "min_principal_stress", "reduce = \"max\"");
    let (mut world, probes) = start(&text);
    let mut read = |name: &str| value(&mut world, &probes, name).x;
    assert!((read("max_principal_stretch") - 1.2).abs() < 1e-12);
    assert!((read("min_principal_stretch") - 1.0).abs() < 1e-12);
    assert!((read("volume_ratio") - 1.2).abs() < 1e-12);
    assert!(read("max_principal_stress") > read("min_principal_stress"));
}

const SKIN: &str = r#"[skins.ball]
voxel = 0.1
[[skins.ball.parts]]
part = "point"
at = [0, 0, 0]
radius = 0.5
[[skins.ball.terms]]
term = "attraction"
strength = 1.0
"#;

const CHANGING: &str = r#"[bodies.cube.adapt]
material = { name = "st_venant_kirchhoff", youngs_modulus = "1 MPa", poissons_ratio = 0.3, density = 1000 }
volume = 0.1
"#;

const LAYERED: &str = r#"
format = 1
[world]
period = "1 ms"
[systems.main]
stepper = { name = "staggered", halvings = 2 }
[bodies.cube]
mesh = { generate = "box", size = [1, 1, 1], cells = [4, 4, 4], element = "tet4" }
material = { name = "neo_hookean", youngs_modulus = "1 MPa", poissons_ratio = 0.3, density = 1000 }
[bodies.cube.levels]
count = 2
refine = 0.1
coarsen = 0.03
[bodies.cube.levels.dress]
mesh = { generate = "box", size = [1, 1, 1], cells = [8, 8, 8], element = "tet4" }
blend = "20 ms"
"#;

const GROUPED: &str = r#"
format = 1
[world]
period = "1 ms"
[systems.main]
stepper = { name = "staggered", halvings = 2 }
[bodies.cube]
mesh = { generate = "box", size = [1, 1, 1], cells = [3, 3, 3], element = "hex8" }
material = { name = "linear", youngs_modulus = "1 kPa", poissons_ratio = 0.3, density = 1000 }
mass = "uniform"
octree = { levels = 2 }
"#;

const FELT: &str = r#"[hands.right]
device = { name = "emulated", mass = "0.4 kg", stiffness = "300 N/m", damping = 8 }
tool = { name = "sphere", centre = [0.5, 1.3, 0.5], radius = 0.2 }
mass = "50 g"
body = "cube"
region = "y_max"
motion = { formula = [0, "-0.1 * t", 0] }
"#;

const HOLDING: &str = r#"touch = { detect = "triangles", response = "imposed" }
[systems.main]
stepper = "symplectic_euler"
"#;

const ON_A_BONE: &str = r#"[bones.hand]
[bodies.cube.frames]
kind = "rigid"
placement = { name = "grid", counts = [2, 2, 2] }
bones = [{ bone = "hand", frames = [0, 1] }]
"#;

const BALLS: &str = r#"
format = 1
[world]
period = "10 ms"
[systems.main]
stepper = "t_simulation"
[networks.cube.masses.balls]
fill = { shape = { name = "sphere", centre = [0, 0, 0], radius = 2 }, spacing = 1 }
mass = 1
[[networks.cube.crowds]]
law = { name = "ball", threshold = 1, stiffness = 1000, damping = 5 }
fusible = { capacity = 1, conductance = 1, softening = 300, melting = 320, stiffness = 10, damping = 0.02, reach = 1, temperature = "290" }
[networks.cube.contours.trace]
scan = ["balls"]
radius = 0.7
step = 0.03
[networks.cube.contours.frontier]
frontier = ["balls"]
radius = 0.7
step = 0.05
"#;

/// A mass that couples points takes along what is led with the whole of its acceleration, however long the step: a cube that is led by `t²` at
/// one end is shorter by `ρ a L²/2E`.
#[test]
fn what_is_led_takes_along_what_its_mass_couples() {
    for stepper in [
        "{ name = \"backward_euler\", newton_tolerance = 1e-11 }",
        "{ name = \"backward_euler\", newton = \"one\" }",
        "\"bdf2\"",
        "\"newmark\"",
    ] {
        let text =
            CUBE.replace("neo_hookean", "linear").replace("poissons_ratio = 0.3", "poissons_ratio = 0");
        let text = text.replace("gravity = [0, -10, 0]", "").replace("[2, 2, 2]", "[1, 1, 1]");
        let text = format!(
            r#"{text}mass = "consistent"
damping = {{ rayleigh_stiffness = 0.04 }}
[[bodies.cube.pins]]
region = "y_min"
motion = {{ formula = "[0, t^2, 0]" }}
[systems.main]
stepper = {stepper}
[probes.top]
body = "cube"
region = "y_max"
quantity = "displacement"
"#
        );
        let (mut world, probes) = start(&text);
        (0..400).for_each(|_| world.step().unwrap());
        let stretch = value(&mut world, &probes, "top").y - world.time().powi(2);
        // 1000 kg/m³ · 2 m/s² · 1 m² / (2 · 1 MPa); of the swing, damped to its limit at 50 per second, nothing is left
        assert!((stretch / -1e-3 - 1.0).abs() < 1e-3, "{stepper}: {stretch}");
    }
}

/// A bone carries the weight of the body whose frames follow it, and its torque is that which keeps the body from turning, about any place.
#[test]
fn bones_carry_what_follows_them() {
    let probes = r#"
[probes.force]
body = "cube"
bone = "hand"
quantity = "bone.force"
[probes.torque]
body = "cube"
bone = "hand"
quantity = "bone.torque"
about = [0.2, 1, -0.7]
[probes.centre]
body = "cube"
quantity = "centre_of_mass"
[systems.main]
stepper = { name = "static", newton_tolerance = 1e-11, solver = "direct" }
"#;
    let pinned = "[[bodies.cube.pins]]\nregion = \"x_min\"\nbone = \"hand\"\n";
    let carried = [
        ("rigid", ON_A_BONE.to_owned()),
        ("affine", ON_A_BONE.replace("rigid", "affine")),
        ("pinned", format!("[bones.hand]\n{pinned}")),
        ("both", format!("{ON_A_BONE}{pinned}")),
    ];
    for (kind, carried) in carried {
        let (mut world, probes) = start(&format!("{CUBE}{carried}{probes}"));
        world.step().unwrap();
        let [force, torque, centre] =
            ["force", "torque", "centre"].map(|name| value(&mut world, &probes, name));
        let weight = Vec3::new(0.0, -1e4, 0.0);
        // what is left unbalanced of the weight
        assert!((force + weight).length() < 1e-6 * weight.length(), "{kind}: {force:?}");
        let of_weight = (centre - Vec3::new(0.2, 1.0, -0.7)).cross(weight);
        assert!(
            (torque + of_weight).length() < 1e-6 * of_weight.length(),
            "{kind}: {torque:?} for {of_weight:?}"
        );
    }
}

/// Every quantity of the table can be measured, and gives what its rank says; none is not finite at rest.
#[test]
fn every_quantity_is_measured() {
    let skin = format!("{CUBE}{SKIN}");
    let changing = CUBE.replace("neo_hookean", "linear") + CHANGING;
    let cube = "body = \"cube\"";
    let felt = format!("{CUBE}{FELT}");
    let held = format!("{CUBE}{}{HOLDING}", FELT.replace("mass = \"50 g\"\n", ""));
    let led = format!("{CUBE}{ON_A_BONE}");
    let marked = format!("{CUBE}[bodies.cube.marks.bleeding]\n");
    let probed = [
        (CUBE, ""),
        (CUBE, cube),
        (&skin, "skin = \"ball\""),
        (&changing, cube),
        (LAYERED, cube),
        (GROUPED, cube),
        (&marked, cube),
        (&felt, "hand = \"right\""),
        (&held, "hand = \"right\""),
        (&led, "body = \"cube\"\nbone = \"hand\""),
        (BALLS, "body = \"cube\""),
        (BALLS, "body = \"cube\"\nwithin = 1.3"),
        (BALLS, "body = \"cube\"\ncontour = \"trace\""),
        (BALLS, "body = \"cube\"\ncontour = \"trace\"\nfrom = \"frontier\""),
    ];
    for entry in QUANTITIES.entries {
        let scene = |(scene, of)| format!("{scene}[probes.q]\n{of}\nquantity = \"{}\"\n", entry.name);
        let text =
            probed.map(scene).into_iter().find(|text| read_text("s", text, Path::new("."), &[]).is_ok());
        let (mut world, probes) = start(&text.unwrap_or_else(|| panic!("nothing has {}", entry.name)));
        let measured = probes[0].measure(&mut world);
        assert!(measured.numbers().iter().all(|number| number.is_finite()), "{}: {measured:?}", entry.name);
        assert_eq!(matches!(measured, Measurement::Vector(_)), probes[0].gives_vector(), "{}", entry.name);
    }
}
