//! Skins in scenes: they outgrow where they began, say where their space ends, go from meshes to formulas, and dress bodies
//! of frames and networks, which others touch.

use std::path::{Path, PathBuf};

use souple_engine::{Interruption, StepError, World};
use souple_scene::spec::quantity::QUANTITIES;
use souple_scene::{Scene, SkinInfo, read_text};
use souple_skin::strategy::TERMS;
use souple_skin::target::{Combine, PARTS, WARPS};

fn scene_in(folder: &Path, text: &str) -> Scene {
    read_text("skins.toml", text, folder, &[]).unwrap_or_else(|errors| panic!("{errors}"))
}

fn started(text: &str) -> (World, Vec<SkinInfo>) {
    let scene = scene_in(Path::new("."), text);
    (scene.model.start(scene.state), scene.skins)
}

fn steps(world: &mut World, count: usize) -> Result<(), String> {
    (0..count).try_for_each(|_| world.step().map_err(|error| error.to_string()))
}

/// A ball that is blown up, with voxels of 0.1 m, its grid from `origin`.
fn balloon(origin: &str, start: &str, low: &str, high: &str) -> String {
    format!(
        r#"
        format = 1
        [world]
        period = "0.1 s"
        [skins.ball]
        voxel = 0.1
        origin = {origin}
        domain = [{low}, {high}]
        terms = [{{ term = "pressure", speed = "0.5" }}]
        [[skins.ball.start]]
        part = "formula"
        formula = "{start}"
        low = {low}
        high = {high}
        "#
    )
}

/// A skin's step is broken off between its sub-steps, and goes on from where the world stood.
#[test]
fn steps_of_skins_are_broken_off() {
    let text = balloon("[0, 0, 0]", "0.5 - sqrt(x^2 + y^2 + z^2)", "[-0.6, -0.6, -0.6]", "[0.6, 0.6, 0.6]");
    let (mut world, _) = started(&text);
    let interruption = Interruption::default();
    world.heed(&interruption);
    let before = world.state().hash();
    interruption.wish();
    assert_eq!(world.step().unwrap_err().error, StepError::Interrupted);
    assert_eq!(world.state().hash(), before);
    interruption.withdraw();
    let (mut undisturbed, _) = started(&text);
    steps(&mut world, 1).and_then(|()| steps(&mut undisturbed, 1)).expect("they grow");
    assert_eq!(world.state().hash(), undisturbed.state().hash());
}

/// A skin that starts where its target is not is told; one that meets it, and one that no target draws, are not.
#[test]
fn starts_beside_the_target_are_told() {
    let told = |at: &str, term: &str| {
        let ball = |centre: &str| format!("part = \"point\"\nat = {centre}\nradius = 0.5\n");
        let text = format!(
            "format = 1\n[world]\nperiod = 1\n[skins.ball]\nvoxel = 0.1\nterms = [{{ {term} }}]\n\
             [[skins.ball.start]]\n{}[[skins.ball.parts]]\n{}",
            ball("[0, 0, 0]"),
            ball(at)
        );
        let warnings = scene_in(Path::new("."), &text).warnings;
        warnings.iter().filter(|warning| warning.contains("starts beside its target")).count()
    };
    let attraction = "term = \"attraction\", strength = 1";
    assert_eq!([told("[3, 0, 0]", attraction), told("[0.8, 0, 0]", attraction)], [1, 0]);
    assert_eq!(told("[3, 0, 0]", "term = \"tension\", strength = 0.1"), 0);
    assert_eq!(told("[3, 0, 0]", "term = \"speed\", formula = \"0.01*abs(g)\""), 0);
}

/// Voxels that are larger than what a skin begins as show nothing of it, and are refused with a size that would.
#[test]
fn voxels_larger_than_the_target_are_refused() {
    let text = balloon("[0, 0, 0]", "0.5 - sqrt(x^2 + y^2 + z^2)", "[-0.6, -0.6, -0.6]", "[0.6, 0.6, 0.6]");
    let text = text.replace("voxel = 0.1", "voxel = 10");
    let refused = read_text("skins.toml", &text, Path::new("."), &[]).err().expect("it is read").to_string();
    assert!(
        refused.contains("voxels of 10 m do not show what it begins as, in a box of [1.2, 1.2, 1.2] m"),
        "{refused}"
    );
}

/// A skin that grows past the domain it began in gets a larger grid, and its radius is what its speed makes of it.
#[test]
fn a_skin_grows_out_of_its_domain() {
    let text = balloon("[0, 0, 0]", "0.5 - sqrt(x^2 + y^2 + z^2)", "[-0.6, -0.6, -0.6]", "[0.6, 0.6, 0.6]");
    let (mut world, skins) = started(&text);
    let before = skins[0].view(&world).grid.keys.len();
    steps(&mut world, 20).expect("it grows");
    let view = skins[0].view(&world);
    assert!(view.grid.keys.len() > before, "{} of {before}", view.grid.keys.len());
    assert_eq!((view.measures().euler, view.measures().components), (2, 1));
    let radius = (0.75 * view.measures().volume / std::f64::consts::PI).cbrt();
    // slopes are of second order: a hundredth of a voxel for each of the ten it went, and its chords
    assert!((radius - 1.5).abs() < 0.03, "{radius}");
    assert_eq!(view.checked(), 21);
}

/// What a skin pulls and presses with gives loose masses neither momentum nor spin, and its pressure keeps their volume.
#[test]
fn a_skin_gives_no_momentum() {
    let text = include_str!("../../../scenes/skin_drop/scene.toml");
    let pressed = text.replace("push = { tension = 1.0 }", "push = { tension = 1.0, pressure = 1000 }");
    assert_ne!(pressed, text);
    for text in [text, &pressed] {
        let (mut world, skins) = started(text);
        let (before, volume) = (world.momentum(), skins[0].view(&world).measures().volume);
        steps(&mut world, 200).expect("it steps");
        let (after, now) = (world.momentum(), skins[0].view(&world).measures().volume);
        // roundings of 200 periods of four steps, beside momenta of 0.03 kg m/s on an arm of 0.1 m
        assert!((after.0 - before.0).length() < 1e-14, "{after:?} after {before:?}");
        assert!((after.1 - before.1).length() < 1e-14, "{after:?} after {before:?}");
        let is_kept = (now / volume - 1.0).abs() < 0.04;
        assert!(is_kept || text != pressed, "{now} m³ of {volume}");
    }
}

/// At the end of the space of keys a skin ends in words, not in a hole.
#[test]
fn a_skin_at_the_end_of_its_space_says_so() {
    // the last block begins at node 8 · 1,048,573: a little before it is the ball, seen from an origin so far away
    let origin = format!("[{}, 0, 0]", -0.1 * 8.0 * 1_048_572.0);
    let text =
        balloon(&origin, "0.5 - sqrt((x + 2)^2 + y^2 + z^2)", "[-2.6, -0.6, -0.6]", "[-1.4, 0.6, 0.6]");
    let (mut world, _) = started(&text);
    let error = steps(&mut world, 60).expect_err("there is no more space");
    assert!(error.contains("left its space"), "{error}");
}

/// A folder of its own for a test, gone when it ends.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("souple_skins_{name}_{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        Self(folder)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        std::fs::remove_dir_all(&self.0).expect("the folder again");
    }
}

/// A ring of triangles as OBJ.
fn ring() -> String {
    let (around, across) = (32, 16);
    let mut text = String::new();
    for i in 0..around {
        for k in 0..across {
            let (a, b) = (
                std::f64::consts::TAU * f64::from(i) / f64::from(around),
                std::f64::consts::TAU * f64::from(k) / f64::from(across),
            );
            let r = 0.6 + 0.2 * b.cos();
            text += &format!("v {} {} {}\n", r * a.cos(), r * a.sin(), 0.2 * b.sin());
        }
    }
    let at = |i: i32, k: i32| 1 + (i % around) * across + k % across;
    for i in 0..around {
        for k in 0..across {
            text += &format!("f {} {} {}\n", at(i, k), at(i + 1, k), at(i + 1, k + 1));
            text += &format!("f {} {} {}\n", at(i, k), at(i + 1, k + 1), at(i, k + 1));
        }
    }
    text
}

/// A mesh with a hole becomes a formula without one, and back: the Euler characteristic goes from 0 to 2 to 0.
#[test]
fn a_mesh_becomes_a_formula_and_back() {
    let folder = Folder::new("ring");
    std::fs::write(folder.0.join("ring.obj"), ring()).expect("a file");
    let text = r#"
        format = 1
        [world]
        period = "50 ms"
        [skins.shape]
        voxel = 0.06
        origin = [0.013, 0.021, 0.007]
        domain = [[-1, -1, -1], [1, 1, 1]]
        start = [{ part = "mesh", file = "ring.obj" }]
        terms = [{ term = "attraction", strength = 2.0 }]
        [[skins.shape.parts]]
        part = "formula"
        formula = "0.5*clamp((0.6 - sqrt(x^2 + y^2 + z^2))/0.3, -1, 1)"
        low = [-0.7, -0.7, -0.7]
        high = [0.7, 0.7, 0.7]
        during = [-1, 2]
        [[skins.shape.parts]]
        part = "mesh"
        file = "ring.obj"
        during = [2, 10]
    "#;
    let scene = scene_in(&folder.0, text);
    let (mut world, skins) = (scene.model.start(scene.state), scene.skins);
    let euler = |world: &World| skins[0].view(world).measures().euler;
    assert_eq!(euler(&world), 0);
    steps(&mut world, 38).expect("it becomes a ball");
    assert_eq!(euler(&world), 2);
    steps(&mut world, 42).expect("it becomes a ring");
    assert_eq!(euler(&world), 0);
}

/// Closed parts of one mesh that overlap are one target: a skin begins around both, and rests there from within, where a wall of
/// one in the other would stop it.
#[test]
fn parts_of_a_mesh_that_overlap_are_joined() {
    let cube = |first: usize, low: f64, high: f64| {
        let corner = |k: usize| {
            let at = |bit: usize| if k >> bit & 1 == 1 { 0.5 } else { -0.5 };
            let x = if k & 1 == 1 { high } else { low };
            format!("v {x} {} {}\n", at(1), at(2))
        };
        let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let side = |corners: [usize; 4]| {
            let [a, b, c, d] = corners.map(|corner| corner + first);
            format!("f {a} {b} {c}\nf {a} {c} {d}\n")
        };
        (0..8).map(corner).chain(sides.map(side)).collect::<String>()
    };
    let folder = Folder::new("joined");
    let text = format!("{}{}", cube(1, -0.7, 0.3), cube(9, -0.2, 0.8));
    std::fs::write(folder.0.join("two.obj"), text).expect("a file");
    let scene = |start: &str| {
        format!(
            r#"
            format = 1
            [world]
            period = "50 ms"
            [skins.shape]
            voxel = 0.05
            origin = [0.013, 0.021, 0.007]
            domain = [[-1, -1, -1], [1, 1, 1]]
            {start}
            parts = [{{ part = "mesh", file = "two.obj" }}]
            terms = [{{ term = "attraction", strength = 2.0 }}]
            "#
        )
    };
    let small = r#"start = [{ part = "formula", formula = "0.2 - sqrt(x^2 + y^2 + z^2)", low = [-1, -1, -1], high = [1, 1, 1] }]"#;
    for (start, count) in [("", 0), (small, 80)] {
        let scene = scene_in(&folder.0, &scene(start));
        let (mut world, skins) = (scene.model.start(scene.state), scene.skins);
        steps(&mut world, count).expect("it grows");
        let measures = skins[0].view(&world).measures();
        assert_eq!((measures.euler, measures.components), (2, 1));
        // edges are cut by a part of a voxel
        assert!((measures.volume - 1.5).abs() < 0.02 * 1.5, "{measures:?}");
    }
}

/// A body that frames carry wears a skin, which goes where it goes.
#[test]
fn frames_wear_a_skin() {
    let text = r#"
        format = 1
        [world]
        period = "10 ms"
        [systems.main]
        stepper = "backward_euler"
        [bodies.bar]
        mesh = { generate = "bar", size = [0.4, 0.1, 0.1], cells = [8, 2, 2], element = "hex8" }
        material = { name = "stable_neo_hookean", youngs_modulus = "50 kPa", poissons_ratio = 0.3, density = 1000 }
        frames = { kind = "affine", placement = { name = "line", count = 4, from = [0, 0.05, 0.05], to = [0.4, 0.05, 0.05] } }
        velocity = [0.3, 0, 0]
        [bodies.bar.skin]
        voxel = 0.02
        terms = [{ term = "attraction", strength = 4.0 }]
    "#;
    let (mut world, skins) = started(text);
    steps(&mut world, 30).expect("it flies");
    let (surface, _) = skins[0].surface(&world);
    let mean = surface.points.iter().map(|point| point.x).sum::<f64>() / surface.points.len() as f64;
    // 90 mm further than its middle was, and less than a voxel behind: what draws it there goes with its distance
    assert!((mean - 0.29).abs() < 0.02, "{mean}");
    assert_eq!(skins[0].view(&world).measures().euler, 2);
}

/// Masses of a network that wear a skin are touched by another body, and bear what pushes on them: momentum and angular momentum of
/// both stay, but for what is on its way for a step.
#[test]
fn a_skin_is_touched() {
    let text = std::fs::read_to_string(
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/skin_touched/scene.toml"),
    )
    .expect("the scene");
    let (mut world, _) = started(&text);
    let (before, spin) = world.momentum();
    let mut worst = 0.0_f64;
    let mut energy = f64::INFINITY;
    for _ in 0..800 {
        world.step().unwrap_or_else(|error| panic!("{error}"));
        worst = worst.max((world.momentum().0 - before).length());
        energy = energy.min(world.energy().kinetic);
    }
    let left = (world.momentum().0 - before).length();
    assert!(left < 1e-9 * before.length(), "{left} of {}", before.length());
    // roundings of forces a hundred times as large as what is left of them, with arms of a quarter of a metre
    let turned = (world.momentum().1 - spin).length();
    assert!(turned < 1e-9 * 0.25 * before.length(), "{turned} of {spin:?}");
    // it was on its way: they did touch, and by no more than the impulse of the contact in a quarter of a millisecond
    assert!(worst > 1e-6 && worst < 0.02 * before.length(), "{worst}");
    assert!(energy < 0.9 * 0.125, "{energy}");
}

/// The skin of a body with levels begins on the points that are at work in its first step, coarse ones: it does not jump from
/// the finest ones to them.
#[test]
fn a_skin_begins_on_the_points_at_work() {
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/skin_levels/scene.toml");
    let (mut world, skins) = started(&std::fs::read_to_string(scene).expect("the scene"));
    let volume = |world: &World| skins[0].view(world).measures().volume;
    let before = volume(&world);
    steps(&mut world, 1).expect("it steps");
    // its target at the start is that of the first step: tension alone moves it, by less than a twentieth of a voxel of 8 mm
    let moved = (volume(&world) - before).abs() / skins[0].view(&world).measures().area;
    assert!(moved < 0.05 * 0.008, "{moved}");
}

/// A thread of the target between nodes is told of, and so is a part that outruns the skin; what is thick and slow is not. What a
/// step takes is known without making it.
#[test]
fn what_a_grid_does_not_see_is_told() {
    let scene = |term: &str, thread: f64, speed: f64| {
        let text = format!(
            r#"
            format = 1
            [world]
            period = "10 ms"
            [skins.ball]
            voxel = 0.1
            domain = [[-1, -1, -1], [1, 1, 1]]
            terms = [{{ {term} }}]
            [[skins.ball.start]]
            part = "formula"
            formula = "0.5 - sqrt(x^2 + y^2 + z^2)"
            low = [-1, -1, -1]
            high = [1, 1, 1]
            [[skins.ball.parts]]
            part = "formula"
            formula = "0.5*clamp(max(0.4 - hypot(hypot(x, y), z), min({thread} - hypot(y - 0.05, z - 0.05), 0.9 - abs(x)))/0.2, -1, 1)"
            low = [-1, -1, -1]
            high = [1, 1, 1]
            motion = ["{speed}*t", 0, 0]
            "#
        );
        started(&text)
    };
    let attraction = "term = \"attraction\", strength = 1";
    let led = |term: &str, thread: f64, speed: f64| {
        let (world, skins) = scene(term, thread, speed);
        skins[0].doubts(&world, 1.0).join("; ")
    };
    let doubts = |thread: f64, speed: f64| led(attraction, thread, speed);
    assert_eq!(doubts(0.2, 0.1), "");
    let thin = doubts(0.045, 0.1);
    assert!(thin.contains("thinner than a voxel of 0.1 m near"), "{thin}");
    // half of the strength, where the potential is one half above its iso value
    let fast = doubts(0.2, 0.6);
    assert!(fast.contains("parts[0]") && fast.contains("follows at 0.500 m/s at most"), "{fast}");
    // a speed that levels off is what it is there, not by its slope, which is all but nothing
    let levels = "term = \"speed\", formula = \"0.5*tanh(g/0.05)\"";
    assert_eq!(led(levels, 0.2, 0.4), "");
    assert!(led(levels, 0.2, 0.6).contains("follows at 0.500 m/s at most"));
    let (world, skins) = scene(attraction, 0.2, 0.1);
    let cost = skins[0].cost(&world).expect("a step is made");
    let blocks = skins[0].view(&world).grid.keys.len();
    assert!(cost.nodes > 0 && cost.triangles > 100 && cost.seconds > 0.0);
    // two states of 512 values in 32 bits and a key for each block at least
    assert!(cost.bytes > 2 * blocks * (4 * 512 + 8), "{cost:?}");
    assert_eq!(world.time(), 0.0);
}

/// What cannot be looked at is told as well: a target without a number, without an inside, or that does not end in its box.
#[test]
fn what_cannot_be_forecast_is_told() {
    let doubts = |formula: &str| {
        let text = format!(
            r#"
            format = 1
            [world]
            period = "10 ms"
            [skins.ball]
            voxel = 0.1
            terms = [{{ term = "attraction", strength = 1 }}]
            [[skins.ball.start]]
            part = "formula"
            formula = "0.5 - sqrt(x^2 + y^2 + z^2)"
            low = [-0.6, -0.6, -0.6]
            high = [0.6, 0.6, 0.6]
            [[skins.ball.parts]]
            part = "formula"
            formula = "{formula}"
            low = [-0.6, -0.6, -0.6]
            high = [0.6, 0.6, 0.6]
            "#
        );
        let (world, skins) = started(&text);
        skins[0].doubts(&world, 1.0)
    };
    assert_eq!(doubts("0.5 - sqrt(x^2 + y^2 + z^2)"), [""; 0]);
    // no number from half of the run on
    let lost = doubts("0.5 - sqrt(x^2 + y^2 + z^2) + 0*sqrt(0.5 - t)");
    assert!(lost.len() == 1 && lost[0].contains("expected a number at t = 0.53125 s"), "{lost:?}");
    let empty = doubts("-1 - x^2");
    assert!(empty.len() == 1 && empty[0].contains("at t = 0 s its target is inside nowhere"), "{empty:?}");
    let open = doubts("0.5 - sqrt(x^2 + y^2)");
    assert!(open.len() == 1 && open[0].contains("it was not looked at"), "{open:?}");
    assert!(open[0].contains("on the border"), "{open:?}");
}

/// The pages name every part, term, warp, way to combine and quantity of skins that the program has, and no other.
#[test]
fn pages_name_what_skins_have() {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/scene-format.md");
    let page = std::fs::read_to_string(page).expect("the page of scenes");
    let section =
        page.split("\n## ").find(|section| section.starts_with("`skins`")).expect("a section of skins");
    let is_named =
        |name: &str| section.contains(&format!("`{name}`")) || section.contains(&format!("`\"{name}\"`"));
    let warps: Vec<&str> = WARPS.entries.iter().map(|entry| entry.name).collect();
    let known =
        PARTS.entries.iter().map(|entry| entry.name).chain(TERMS.entries.iter().map(|entry| entry.name));
    for name in known.chain(Combine::NAMES.iter().copied()) {
        assert!(is_named(name), "`{name}` is not on the page");
    }
    for name in warps {
        assert!(is_named(name) || section.contains(&format!("\"{name}\"")), "`{name}` is not on the page");
    }
    let quantities: Vec<&str> =
        QUANTITIES.entries.iter().map(|entry| entry.name).filter(|name| name.starts_with("skin.")).collect();
    for name in &quantities {
        assert!(is_named(name), "`{name}` is not on the page");
    }
    for named in section.split('`').filter(|text| text.starts_with("skin.")) {
        assert!(quantities.contains(&named), "there is no `{named}`");
    }
}
