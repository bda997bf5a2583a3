//! Contacts of scenes: their stiffness where none is given, and bodies that start inside what they touch.

use std::path::Path;

use souple_engine::{Detected, Edit, HeldTool, Tool, World};
use souple_math::Vec3;
use souple_models::contact::{ContactLaw, ShapeContact, SurfaceContact};
use souple_scene::{Scene, read_text};

const BLOCK: &str = r#"format = 1
[world]
period = "10 ms"
[bodies.block]
mesh = { generate = "box", size = [1, 1, 1], cells = [2, 2, 2], element = "hex8" }
material = { name = "neo_hookean", youngs_modulus = "1 MPa", poissons_ratio = 0.3, density = 1000 }
"#;

fn scene(text: &str) -> Scene {
    read_text("scene.toml", text, Path::new("."), &[]).unwrap_or_else(|errors| panic!("{errors}"))
}

fn law(scene: &Scene) -> ContactLaw {
    let forces = scene.model.systems[0].forces.iter();
    let of = |force: &dyn std::any::Any| {
        let shape = force.downcast_ref::<ShapeContact>().map(ShapeContact::law);
        shape.or_else(|| force.downcast_ref::<SurfaceContact>().map(SurfaceContact::law)).copied()
    };
    forces.map(|force| force.as_any()).find_map(of).expect("a contact")
}

fn on_floor(height: f64) -> String {
    format!(
        "{BLOCK}[shapes.floor]\nshape = {{ name = \"plane\", point = [0, {height}, 0] }}\n[[contacts]]\nname = \
         \"floor\"\nbody = \"block\"\nshape = \"floor\"\nregion = \"y_min\"\n"
    )
}

/// `E √A` of the points that touch, with the modulus of the cells behind them: nine points have the face of one square
/// metre and half of the lower cells of the sides; a lower half that is four times as stiff counts alone.
#[test]
fn stiffness_is_that_of_the_matter_behind() {
    let width = (2.0_f64 / 9.0).sqrt();
    assert!((law(&scene(&on_floor(0.0))).stiffness - 1e6 * width).abs() < 1e-9 * 1e6);
    let layered = on_floor(0.0)
        + "[bodies.block.regions.sole]\nregion = { half_space = { point = [0, 0.5, 0], normal = [0, 1, 0] } }\nmaterial = \
           { name = \"neo_hookean\", youngs_modulus = \"4 MPa\", poissons_ratio = 0.3, density = 1000 }\n";
    assert!((law(&scene(&layered)).stiffness - 4e6 * width).abs() < 1e-9 * 4e6);
}

/// Two bodies give way in series, the same whichever is named first.
#[test]
fn stiffness_between_bodies_is_symmetric() {
    let other = BLOCK[BLOCK.find("[bodies.block]").expect("a body")..]
        .replace("block", "other")
        .replace("1 MPa", "3 MPa")
        .replace("density = 1000 }", "density = 1000 }\ntranslate = [0, 1.1, 0]");
    let pair = |first: &str, second: &str| {
        let contact = format!("[[contacts]]\nname = \"pair\"\nbody = \"{first}\"\nother = \"{second}\"\n");
        law(&scene(&format!("{BLOCK}{other}{contact}"))).stiffness
    };
    // 2 E₁ E₂ / (E₁ + E₂) √A, six square metres over 26 points
    let expected = 1.5e6 * (6.0_f64 / 26.0).sqrt();
    for stiffness in [pair("block", "other"), pair("other", "block")] {
        assert!((stiffness - expected).abs() < 1e-9 * expected, "{stiffness} for {expected}");
    }
}

/// A start on the floor or a little in it is a touch; half an element deep is told with the place.
#[test]
fn starts_deep_inside_are_told() {
    for height in [-0.1, 0.0, 0.1] {
        let warnings = scene(&on_floor(height)).warnings;
        assert!(warnings.is_empty(), "{height}: {warnings:?}");
    }
    let warnings = scene(&on_floor(0.45)).warnings;
    assert!(warnings.iter().any(|said| said.contains("9 points start deep inside")), "{warnings:?}");
    assert!(warnings.iter().any(|said| said.contains("by 0.4500 m")), "{warnings:?}");
}

/// A world in which nothing is detected any more, since its tool was let go of, goes on as one that begins with its state: nothing is looked for
/// beside the steps of either.
#[test]
fn worlds_go_on_alike_after_tools_are_let_go_of() {
    let text = r#"format = 1
[world]
period = "10 ms"
collisions = "one_period_late"
[systems.main]
stepper = "symplectic_euler"
[networks.n.masses.corners]
positions = [[0, 0, 0], [0, 0, 1], [1, 0, 0]]
velocity = [0, 0.1, 0]
mass = 1
[[networks.n.links]]
law = { name = "spring", stiffness = 10 }
of = ["corners"]
chain = true
"#;
    let new = || {
        let scene = scene(text);
        scene.model.start(scene.state)
    };
    let steps = |world: &mut World| {
        for _ in 0..3 {
            world.step().unwrap();
        }
    };
    let held = HeldTool {
        places: vec![Vec3::ZERO, Vec3::Z, Vec3::X],
        triangles: vec![[0, 1, 2]],
        spans: Vec::new(),
        friction: 0.3,
        mass: 0.03,
        spring: 300.0,
        damper: 6.0,
        limit: 10.0,
    };
    let tool = Tool {
        shape: "sphere".to_owned(),
        values: vec![("radius".to_owned(), vec![0.1])],
        place: Vec3::new(0.3, 0.5, 0.3),
        stiffness: 100.0,
        rows: vec![0, 1, 2],
        spans: Vec::new(),
        held: Some(held),
    };
    let mut world = new();
    world.edit(Edit::Touch { system: 0, hand: 0, tool }).unwrap();
    steps(&mut world);
    assert!(world.state().systems[0].detected != Detected::default());
    world.edit(Edit::Release { system: 0, hand: 0 }).unwrap();
    steps(&mut world);
    assert_eq!(world.state().systems[0].detected, Detected::default());
    let mut resumed = new();
    resumed.resume_edited(world.state().clone(), world.log().to_vec()).unwrap();
    steps(&mut world);
    steps(&mut resumed);
    assert!(world.state() == resumed.state());
}
