//! Bodies whose points hang on others: what is joined so is one body.

use std::path::Path;

use souple_engine::World;
use souple_math::Vec3;
use souple_scene::{BodyInfo, read_text};

const MATTER: &str = r#"material = { name = "neo_hookean", youngs_modulus = "100 kPa", poissons_ratio = 0.3, density = 1000 }"#;

fn read(text: &str) -> Result<(World, Vec<BodyInfo>), String> {
    let scene = read_text("hanging", text, Path::new("."), &[]).map_err(|faults| faults.to_string())?;
    Ok((scene.model.start(scene.state), scene.bodies))
}

/// A bar along x in halves of 0.4 m, the second on the first.
fn halves(stepper: &str, cells: [[u32; 3]; 2], more: &str) -> String {
    let bar = |name: &str, cells: [u32; 3], place: f64, more: &str| {
        format!(
            "[bodies.{name}]\nmesh = {{ generate = \"bar\", size = [0.4, 0.2, 0.2], cells = {cells:?}, element = \"hex8\" }}\n\
             {MATTER}\ntranslate = [{place}, 0, 0]\n{more}\n"
        )
    };
    format!(
        "format = 1\n[world]\nperiod = \"1 ms\"\n[systems.main]\nstepper = {stepper}\n{}{}\
         [[attachments]]\nfrom = \"second\"\nregion = \"x_min\"\nto = \"first\"\n",
        bar("first", cells[0], 0.0, more),
        bar("second", cells[1], 0.4, more),
    )
}

fn positions(world: &World, body: &BodyInfo) -> Vec<Vec3> {
    world.rows(body.system).positions[body.rows.clone()].to_vec()
}

/// Halves of one mesh go where the bar in one piece goes, in statics and in implicit steps, to the solvers' tolerance.
#[test]
fn halves_of_one_mesh_are_one_bar() {
    let whole = |stepper: &str, gravity: &str| {
        format!(
            "format = 1\n[world]\nperiod = \"1 ms\"\n{gravity}\n[systems.main]\nstepper = {stepper}\n[bodies.bar]\n\
             mesh = {{ generate = \"bar\", size = [0.8, 0.2, 0.2], cells = [8, 2, 2], element = \"hex8\" }}\n{MATTER}\n\
             [[bodies.bar.pins]]\nregion = \"x_min\"\n"
        )
    };
    let gravity = "gravity = [0, -9.81, 2]";
    for stepper in [
        r#"{ name = "static", newton_tolerance = 1e-12, solver = "direct" }"#,
        r#"{ name = "backward_euler", newton_tolerance = 1e-12, solver = "direct" }"#,
        r#"{ name = "backward_euler", newton_tolerance = 1e-12, solver = "cg", solver_tolerance = 1e-13 }"#,
        r#"{ name = "newmark", newton_tolerance = 1e-12, solver = "direct" }"#,
        "\"verlet\"",
    ] {
        let joined =
            halves(stepper, [[4, 2, 2], [4, 2, 2]], "").replace("[systems", &format!("{gravity}\n[systems"));
        let pinned = format!("{joined}[[bodies.first.pins]]\nregion = \"x_min\"\n");
        let (mut one, bodies_of_one) = read(&whole(stepper, gravity)).expect(stepper);
        let (mut two, bodies_of_two) = read(&pinned).expect(stepper);
        for _ in 0..20 {
            one.step().expect(stepper);
            two.step().expect(stepper);
        }
        let all = positions(&one, &bodies_of_one[0]);
        let rest = &bodies_of_one[0].mesh.points;
        let moved = all.iter().zip(rest).map(|(x, rest)| (*x - *rest).length()).fold(0.0, f64::max);
        for body in &bodies_of_two {
            for (x, rest_of) in positions(&two, body).iter().zip(&body.mesh.points) {
                let same =
                    rest.iter().position(|other| (*other - *rest_of).length() < 1e-9).expect("a point there");
                // residuals of 1e-12 and masses of 1e-8, which explicit steps solve for, over the largest motion
                assert!((*x - all[same]).length() < 1e-6 * moved, "{stepper}: {x:?} and {:?}", all[same]);
            }
        }
    }
}

/// A finer half on a coarser one: an even stretch of the whole stays even, since what the coarse side sees is what the fine one has.
#[test]
fn even_stretches_stay_even() {
    let stepper = r#"{ name = "static", newton_tolerance = 1e-12, solver = "direct" }"#;
    let text = halves(stepper, [[2, 1, 1], [4, 2, 2]], "");
    let led = "motion = { times = [0, 1], offsets = [[0.08, 0, 0], [0.08, 0, 0]] }";
    // ends led apart, sides free to slide: held where they would turn
    let axes = |body: &str, region: &str, axes: &str| {
        format!("[[bodies.{body}.pins]]\nregion = \"{region}\"\naxes = {axes}\n")
    };
    let pins = ["first", "second"].map(|body| {
        let z = "region = { intersection = [\"z_min\", { half_space = { point = [0.41, 0, 0], normal = [-1, 0, 0] } }] }";
        let y = z.replace("z_min", "y_min");
        match body {
            "first" => axes(body, "x_min", "\"x\"") + &axes(body, "y_min", "\"y\"") + &axes(body, "z_min", "\"z\""),
            _ => format!(
                "[[bodies.second.pins]]\nregion = \"x_max\"\naxes = \"x\"\n{led}\n[[bodies.second.pins]]\n{y}\naxes = \"y\"\n\
                 [[bodies.second.pins]]\n{z}\naxes = \"z\"\n"
            ),
        }
    });
    let (mut world, bodies) = read(&format!("{text}{}", pins.concat())).unwrap();
    world.step().unwrap();
    let stretch = 1.0 + 0.08 / 0.8;
    let narrow = {
        let last = positions(&world, &bodies[0]);
        let (x, rest) = last.iter().zip(&bodies[0].mesh.points).find(|(_, rest)| rest.y > 0.1).unwrap();
        x.y / rest.y
    };
    for body in &bodies {
        for (x, rest) in positions(&world, body).iter().zip(&body.mesh.points) {
            let even = Vec3::new(stretch * rest.x, narrow * rest.y, narrow * rest.z);
            assert!((*x - even).length() < 1e-9, "{}: {x:?} in the place of {even:?}", body.name);
        }
    }
}

/// What is joined and free keeps both momenta, and its energy as its stepper promises.
#[test]
fn joined_bodies_keep_their_momenta() {
    for (stepper, mass) in
        [("\"symplectic_euler\"", "lumped"), ("\"verlet\"", "consistent"), ("\"rk4\"", "lumped")]
    {
        let more = format!("mass = \"{mass}\"\nvelocity = [0.1, 0, 0]\n");
        let text = halves(stepper, [[2, 1, 1], [4, 2, 2]], &more)
            .replace("velocity = [0.1, 0, 0]\n\n[[att", "velocity = [0, 0.3, 0]\n\n[[att");
        let (mut world, _) = read(&text).unwrap();
        let (start, energy) = (world.momentum(), world.energy().total());
        for _ in 0..200 {
            world.step().unwrap();
        }
        let end = world.momentum();
        // masses are solved for to 1e-10 in each step
        assert!((end.0 - start.0).length() < 1e-8 * start.0.length(), "{stepper}: {start:?} {end:?}");
        let scale = start.1.length() + 0.4 * start.0.length();
        assert!((end.1 - start.1).length() < 1e-6 * scale, "{stepper}: {start:?} {end:?}");
        assert!((world.energy().total() / energy - 1.0).abs() < 0.05, "{stepper}");
    }
}

/// What cannot hang is refused in words.
#[test]
fn what_cannot_hang_is_refused() {
    let stepper = "\"backward_euler\"";
    let text = halves(stepper, [[2, 1, 1], [4, 2, 2]], "");
    let back = "[[attachments]]\nfrom = \"first\"\nregion = \"x_max\"\nto = \"second\"\n";
    let rows = |text: &str| text.replace("to = \"first\"", "to = \"first\"\nhold = \"rows\"");
    for (scene, said) in [
        (format!("{text}[[bodies.second.pins]]\nregion = \"x_min\"\n"), "9 points of body `second` that are pinned hang on body `first`"),
        (format!("{text}{back}"), "hangs on what hangs on it"),
        (rows(&text).replace("translate = [0.4,", "translate = [0.5,"), "m away from body `first`, and rows hold what touches"),
        (format!("{}stiffness = 100\n", rows(&text)), "rows have neither stiffness"),
        (
            rows(&text).replace("[bodies.second]", "[bodies.second.frames]\nplacement = { name = \"grid\", counts = [2, 1, 1] }\n[bodies.second]"),
            "is no body of points alone",
        ),
    ] {
        let refused = read(&scene).err().unwrap_or_default();
        assert!(refused.contains(said), "{said}: {refused}\n{scene}");
    }
    // springs are free to do as before
    let springs = text.replace("to = \"first\"", "to = \"first\"\nhold = \"springs\"");
    assert!(read(&springs).is_ok_and(|(_, bodies)| bodies.iter().all(|body| body.hanging_count() == 0)));
    assert!(read(&text).is_ok_and(|(_, bodies)| bodies[1].hanging_count() == 9));
}

/// In equilibrium nothing bears more than it can: what would is gone within the step, and each half hangs on what is left; where nothing
/// is left there is no rest.
#[test]
fn what_tears_in_statics_is_gone_at_once() {
    let scene = |strength: f64, more: &str| {
        let stepper = r#"{ name = "static", newton_tolerance = 1e-11, solver = "direct" }"#;
        let halves = halves(stepper, [[4, 2, 2], [4, 2, 2]], "")
            .replace("[systems", "gravity = [0, -9.81, 0]\n[systems");
        let probes = "[probes.carried]\nbody = \"first\"\nregion = \"x_min\"\nquantity = \"reaction\"\ncomponent = \"y\"\n";
        format!(
            "{halves}hold = \"springs\"\nstrength = {strength:?}\n[[bodies.first.pins]]\nregion = \"x_min\"\n{more}{probes}"
        )
    };
    let below = "[[bodies.second.springs]]\nregion = \"x_max\"\nstiffness = 1000\ndistribution = \"total\"\n";
    // 1000 kg/m³ of 0.4 x 0.2 x 0.2 m, with what of the other half hangs on the joint
    let weight = 16.0 * 9.81;
    for (strength, holds) in [(1e9, true), (1.0, false)] {
        let text = scene(strength, below);
        let scene = read_text("torn", &text, Path::new("."), &[]).unwrap_or_else(|faults| panic!("{faults}"));
        let probe = scene.probes[0].clone();
        let mut world = scene.model.start(scene.state);
        world.step().unwrap();
        let carried = probe.measure(&mut world).numbers()[0];
        let own = (carried - weight).abs() < 1e-6 * weight;
        assert_eq!(own, !holds, "{carried} N of {weight}");
    }
    let (mut world, _) = read(&scene(1.0, "")).unwrap();
    let refused = world.step().unwrap_err().to_string();
    assert!(refused.contains("`attachments[0]` gave way"), "{refused}");
}
