//! What frames hold of networks, frames and skins, of the inside of bodies, and of tools.

use crate::client::{Page, World};
use serde_json::json;

/// Two rows of masses joined by links that tear when pulled by more than 1 N; the upper row is led away.
const TEARING: &str = r#"
    format = 1
    [world]
    period = "10 ms"
    [systems.main]
    stepper = "t_simulation"
    steps_per_period = 10
    [networks.net.masses.lower]
    lattice = { spacing = 0.1, counts = [4, 1, 1] }
    mass = "10 g"
    [networks.net.masses.upper]
    lattice = { origin = [0, 0.1, 0], spacing = 0.1, counts = [4, 1, 1] }
    mass = "10 g"
    [[networks.net.links]]
    law = { name = "elasto_plastic", stiffness = 100, hardening = 10, traction = "0.5 N", rupture = "1 N" }
    of = ["lower", "upper"]
    reach = 0.11
    [[networks.net.pins]]
    region = "lower"
    [[networks.net.pins]]
    region = "upper"
    motion = { times = [0, 0.5], offsets = [[0, 0, 0], [0, 0.1, 0]] }
"#;

/// Four masses of a square of a decimetre, a line around them and a cross on the first.
const OUTLINED: &str = r#"
    format = 1
    [world]
    period = "10 ms"
    [systems.main]
    stepper = "t_simulation"
    [networks.net.masses.corners]
    positions = [[0, 0, 0], [0.1, 0, 0], [0.1, 0, 0.1], [0, 0, 0.1]]
    mass = "10 g"
    [networks.net.contours.around]
    skin = "corners"
    [networks.net.contours.mark]
    cross = [0, 1, 2, 3]
    radius = 0.05
"#;

/// A block that two frames carry, held at neither end.
const CARRIED: &str = r#"
    format = 1
    [world]
    period = "10 ms"
    [bodies.bar]
    mesh = { generate = "bar", size = [0.4, 0.1, 0.1], cells = [4, 1, 1], element = "hex8" }
    material = { name = "stable_neo_hookean", youngs_modulus = "50 kPa", poissons_ratio = 0.3, density = 1000 }
    [bodies.bar.frames]
    kind = "rigid"
    placement = { name = "grid", counts = [2, 1, 1] }
"#;

/// A ball that wears a skin and lies still.
const WORN: &str = r#"
    format = 1
    [world]
    period = "10 ms"
    [bodies.ball]
    mesh = { generate = "sphere", radius = 0.1, cells = 4, element = "hex8" }
    material = { name = "stable_neo_hookean", youngs_modulus = "50 kPa", poissons_ratio = 0.3, density = 1000 }
    [bodies.ball.skin]
    voxel = 0.025
    radius = 0.03
    terms = [{ term = "attraction", strength = 2.0 }]
"#;

/// A ball of skin that is drawn to two balls, and after two seconds to a ring.
const CHANGING: &str = r#"
    format = 1
    [world]
    period = "10 ms"
    [skins.shape]
    voxel = 0.08
    terms = [{ term = "attraction", strength = 4.0 }, { term = "tension", strength = 0.01 }]
    [[skins.shape.start]]
    part = "point"
    at = [0, 0, 0]
    radius = 0.7
    [[skins.shape.parts]]
    part = "formula"
    formula = "0.5*clamp(1 - sqrt((abs(x) - 0.6)^2 + y^2 + z^2)/0.35, -1, 1)"
    low = [-1, -0.4, -0.4]
    high = [1, 0.4, 0.4]
    during = [0, 2]
    [[skins.shape.parts]]
    part = "formula"
    formula = "0.5*clamp(1 - sqrt((sqrt(x^2 + y^2) - 0.65)^2 + z^2)/0.3, -1, 1)"
    low = [-1, -1, -0.3]
    high = [1, 1, 0.3]
    during = [2, 60]
"#;

/// A soft block on a floor, with nothing but its weight.
const BLOCK: &str = r#"
    format = 1
    [world]
    period = "10 ms"
    [bodies.block]
    mesh = { generate = "box", size = [0.2, 0.1, 0.2], cells = [4, 2, 4], element = "hex8" }
    material = { name = "stable_neo_hookean", youngs_modulus = "20 kPa", poissons_ratio = 0.3, density = 1000 }
    damping = { rayleigh_mass = 5 }
    [[bodies.block.pins]]
    region = { box = [[-1, -1e-9, -1], [1, 1e-9, 1]] }
"#;

/// The same by explicit steps, of which a tool on a spring takes part.
fn explicit_block() -> String {
    let system =
        "[systems.main]\n    stepper = \"symplectic_euler\"\n    steps_per_period = 10\n    [bodies.block]";
    BLOCK.replacen("[bodies.block]", system, 1)
}

/// A cube on a wall, of small cells there and of large ones elsewhere.
const LEVELS: &str = r#"
    format = 1
    [world]
    period = "10 ms"
    gravity = [0, 0, -9.81]
    [systems.main]
    stepper = { name = "staggered", halvings = 5 }
    [bodies.cube]
    mesh = { generate = "bar", size = [0.1, 0.1, 0.1], cells = [4, 4, 4], element = "tet4" }
    material = { name = "st_venant_kirchhoff", youngs_modulus = "20 kPa", poissons_ratio = 0.3, density = 1000 }
    damping = { rayleigh_mass = 50 }
    [bodies.cube.levels]
    coarser = [{ mesh = { generate = "bar", size = [0.1, 0.1, 0.1], cells = [2, 2, 2], element = "tet4" } }]
    fixed = "if(x < 0.05, 1, 0)"
    [[bodies.cube.pins]]
    region = "x_min"
"#;

/// All links hold at first, and none when their ends have been led away.
#[test]
fn links_tear() {
    let world = World::of(TEARING);
    let mut page = Page::open(&world);
    let scene = page.document("scene");
    assert_eq!(scene["bodies"][0]["links"], 4);
    assert_eq!(scene["bodies"][0]["is_network"], true);
    assert_eq!(page.frame().point_counts, [8]);
    assert!(page.frame_where(|frame| frame.torn == 4).time > 0.04);
    page.wish(json!({"do": "reset"}));
    assert!(page.frame_where(|frame| frame.torn == 0).time < 0.5);
}

/// Links whose law is written in the scene are apart in a state without force that nothing leads out of.
#[test]
fn written_links_end() {
    let law = r#"law = { name = "elasto_plastic", stiffness = 100, hardening = 10, traction = "0.5 N", rupture = "1 N" }"#;
    let written = r#"law = { name = "finite_state", states = { whole = "-100 * (D - L0)", slack = "0", gone = "0" }, transitions = { "whole -> slack" = "D > 1.1 * L0", "slack -> whole" = "D < L0", "slack -> gone" = "D > 1.5 * L0" } }"#;
    assert!(TEARING.contains(law));
    let world = World::of(&TEARING.replace(law, written));
    let mut page = Page::open(&world);
    // slack from 0.05 s on, and gone from 0.25 s
    let ended = page.frame_where(|frame| frame.torn == 4);
    assert!(ended.time > 0.2, "{ended:?}");
}

/// Frames that carry a body are in every frame, and the weight of one of them can be asked for.
#[test]
fn frames_are_shown() {
    let world = World::of(CARRIED);
    let mut page = Page::open(&world);
    assert_eq!(page.frame().frame_counts, [2]);
    let scene = page.document("scene");
    let fields = scene["fields"].as_array().unwrap();
    let titles: Vec<_> = fields.iter().filter(|field| !field["title"].is_null()).collect();
    assert!(titles.len() == 1 && titles[0]["title"] == "influence of frame 0", "{titles:?}");
    page.wish(json!({"do": "colour", "field": "influence"}));
    let of_first = page.frame_where(|frame| frame.field_count == 1).values[0].clone();
    page.wish(json!({"do": "influence", "body": 0, "frame": 1}));
    let told = page.document_where("influence", |told| told["bodies"][0]["shown"] == 1);
    assert_eq!((&told["title"], &told["bodies"][0]["frames"]), (&json!("influence of frame 1"), &json!(2)));
    // of two frames each has what the other leaves
    let is_rest = |(one, other): (&f32, &f32)| (one + other - 1.0).abs() < 1e-6;
    page.frame_where(|frame| frame.values[0].iter().zip(&of_first).all(is_rest));
    for (wish, reason) in [
        (json!({"do": "influence", "body": 0, "frame": 2}), "has no frame 2; it has 2"),
        (json!({"do": "influence", "body": 1, "frame": 0}), "no body 1"),
    ] {
        page.wish(wish);
        let refused = page.document_where("refused", |refused| refused["about"] == "influence");
        assert!(refused["message"].as_str().unwrap().contains(reason), "{refused}");
    }
    page.wish(json!({"do": "reset"}));
    page.document_where("influence", |told| told["bodies"][0]["shown"] == 1);
    page.wish(json!({"do": "arrows", "of": "velocity"}));
    page.wish(json!({"do": "arrows", "of": "nothing"}));
    let refused = page.document_where("refused", |refused| refused["about"] == "arrows");
    assert!(refused["message"].as_str().unwrap().contains("contact_force"), "{refused}");
    assert_eq!(page.frame_where(|frame| frame.field_count == 1 && frame.arrow_count == 1).frame_counts, [2]);
}

/// A line around a square has its four sides; a cross has two bars of two arms, there and back, before and behind.
#[test]
fn contours_are_shown() {
    let world = World::of(OUTLINED);
    let frame = Page::open(&world).frame();
    let wanted = 4.0 * 0.1 + 2.0 * 2.0 * 2.0 * 2.0 * 0.05;
    assert!((frame.contour_length - wanted).abs() < 1e-6, "{} m", frame.contour_length);
}

/// A skin comes with triangles in every frame; the body under it is said to be hidden.
#[test]
fn skins_are_shown() {
    let world = World::of(WORN);
    let mut page = Page::open(&world);
    let scene = page.document("scene");
    assert_eq!(scene["bodies"][0]["is_worn"], true);
    assert_eq!(scene["skins"][0]["worn_by"], 0);
    assert!(page.frame().skin_triangles[0] > 100);
}

/// Triangles come as they are in each frame, also where the skin has become two, and then a ring.
#[test]
fn skins_that_part_and_open_are_shown() {
    let world = World::of(CHANGING);
    let mut page = Page::open(&world);
    assert!(page.frame_where(|frame| frame.skin_euler == [2]).time < 2.0);
    assert!(page.frame_where(|frame| frame.skin_euler == [4]).time < 2.1);
    assert!(page.frame_where(|frame| frame.skin_euler == [0]).time > 2.0);
}

/// Who looks inside gets the cells once and all points from then on; who looks away, those of the surface.
#[test]
fn the_inside_comes_on_demand() {
    let world = World::of(BLOCK);
    let mut page = Page::open(&world);
    let scene = page.document("scene");
    let (all, outer) = (scene["bodies"][0]["points"].clone(), scene["bodies"][0]["surface_points"].clone());
    assert_eq!((all.as_u64(), outer.as_u64()), (Some(75), Some(66)));
    assert_eq!(page.frame().point_counts, [66]);
    // two triangles in each of 64 squares, which four edges go round, two squares to an edge
    assert_eq!(page.surfaces[0], [66, 128, 128]);
    page.wish(json!({"do": "inside", "is_shown": true}));
    page.frame_where(|frame| frame.point_counts == [75]);
    // six tetrahedra and twelve triangles of each of 32 cells
    assert_eq!(page.insides, [[192, 384]]);
    page.wish(json!({"do": "inside", "is_shown": false}));
    page.frame_where(|frame| frame.point_counts == [66]);
}

/// A body with marks shows what a tool does to it as it looks: its field brings its colours, in which numbers from -1 to 1 stand.
#[test]
fn surfaces_whiten_under_tools() {
    let pressed = r#"
    [bodies.block.marks]
    whitening_pressure = "10 Pa"
    [shapes.ball]
    shape = { name = "sphere", centre = [0.1, 0.11, 0.1], radius = 0.03 }
    [[contacts]]
    name = "ball"
    body = "block"
    shape = "ball"
    "#;
    let world = World::of(&format!("{BLOCK}{pressed}"));
    let mut page = Page::open(&world);
    let scene = page.document("scene");
    let fields = scene["fields"].as_array().unwrap();
    let named = |name: &str| fields.iter().find(|field| field["name"] == name).unwrap();
    let scale = &named("tissue")["scale"];
    assert_eq!((&scale["low"], &scale["high"]), (&json!(-1.0), &json!(1.0)));
    assert_eq!(scale["colours"].as_str().map(str::len), Some(6 * 256));
    for name in ["tissue", "whitening", "burn"] {
        assert_eq!(named(name)["is_here"], true, "{name}");
    }
    assert!(named("whitening")["scale"].is_null());
    page.wish(json!({"do": "colour", "field": "tissue"}));
    let white = |frame: &crate::client::Frame| {
        frame.values.first().is_some_and(|all| all.iter().any(|value| *value > 0.9))
    };
    let values = page.frame_where(white).values[0].clone();
    // only where it is touched
    assert!(values.iter().filter(|value| **value == 0.0).count() > values.len() / 2, "{values:?}");
}

/// Blood comes along with how bodies look, and the texture of a body once, before its first frame.
#[test]
fn blood_and_textures_are_shown() {
    let torn = r#"
    [bodies.block.texture]
    pattern = "spots"
    size = "2 cm"
    [bodies.block.marks]
    whitening_pressure = "1 GPa"
    [bodies.block.marks.bleeding]
    pressure = 0
    rate = "1 mm/s"
    [shapes.ball]
    shape = { name = "sphere", centre = [0.1, 0.11, 0.1], radius = 0.03 }
    [[contacts]]
    name = "ball"
    body = "block"
    shape = "ball"
    "#;
    let world = World::of(&format!("{BLOCK}{torn}"));
    let mut page = Page::open(&world);
    let scene = page.document("scene");
    let fields = scene["fields"].as_array().unwrap();
    let number = |name: &str| fields.iter().position(|field| field["name"] == name).unwrap();
    assert_eq!(fields[number("tissue")]["over"], number("blood"));
    assert!(fields[number("whitening")]["over"].is_null());
    assert_eq!(fields[number("blood")]["is_here"], true);
    page.wish(json!({"do": "colour", "field": "tissue"}));
    let bleeds = |frame: &crate::client::Frame| {
        frame.values.len() == 2 && frame.values[1].iter().any(|film| *film > 1e-5)
    };
    page.frame_where(bleeds);
    // spots are the second pattern
    assert_eq!(page.textures, [[0, 2, 0, 0]]);
}

/// Colours tell the cells of a surface apart, then those of the inside: by kind, by law, by the mesh at work.
#[test]
fn cells_are_told_apart() {
    let region = r#"
    [bodies.block.regions.side]
    region = { box = [[-1, -1, -1], [0.05, 1, 1]] }
    material = { name = "corotational", youngs_modulus = "80 kPa", poissons_ratio = 0.3, density = 1000 }
    "#;
    let world = World::of(&format!("{BLOCK}{region}"));
    let mut page = Page::open(&world);
    let scene = page.document("scene");
    let names = |field: &str| {
        let fields = scene["fields"].as_array().expect("there are fields");
        let found = fields.iter().find(|entry| entry["name"] == field).expect("the field is there");
        assert_eq!(found["of"], "cells");
        let classes = found["classes"].as_array().expect("they have names");
        classes.iter().map(|class| class["name"].as_str().unwrap_or("").to_owned()).collect::<Vec<_>>()
    };
    assert_eq!(names("law"), ["stable_neo_hookean", "corotational (side)"]);
    assert!(names("level").is_empty());
    let is_here = |field: &str| {
        let fields = scene["fields"].as_array().expect("there are fields");
        fields.iter().find(|entry| entry["name"] == field).map(|entry| entry["is_here"] == true)
    };
    for (field, here) in
        [("law", true), ("element", true), ("von_mises", true), ("level", false), ("link_force", false)]
    {
        assert_eq!(is_here(field), Some(here), "{field}");
    }
    let hex = names("element").iter().position(|name| name == "hex").expect("a kind of its own");

    page.wish(json!({"do": "colour", "field": "element"}));
    let triangles = scene["bodies"][0]["surface_triangles"].as_u64().expect("a number") as usize;
    let frame = page.frame_where(|frame| !frame.values.is_empty());
    assert_eq!(frame.values[0], vec![hex as f32; triangles]);

    page.wish(json!({"do": "colour", "field": "law"}));
    page.wish(json!({"do": "inside", "is_shown": true}));
    let frame = page.frame_where(|frame| frame.values.first().is_some_and(|values| values.len() > triangles));
    // the block is four cells long, and one layer of eight has the other law
    let of_cells = &frame.values[0][triangles..];
    assert_eq!(of_cells.len(), 32);
    assert_eq!(of_cells.iter().filter(|law| **law == 1.0).count(), 8);
}

/// DEB-51: colours tell which mesh is at work where, arrows how points are displaced, how they move and what pushes them, and
/// a hand what it pulls with.
#[test]
fn levels_arrows_and_forces_are_shown() {
    let world = World::of(LEVELS);
    let mut page = Page::open(&world);
    let scene = page.document("scene");
    let fields = scene["fields"].as_array().expect("there are fields");
    let level = fields.iter().find(|field| field["name"] == "level").expect("the field is there");
    assert_eq!(level["is_here"], true);
    let names = |of: &serde_json::Value| {
        of.as_array().into_iter().flatten().map(|one| one["name"].clone()).collect::<Vec<_>>()
    };
    assert_eq!(names(&level["classes"]), ["0, coarsest", "1, finest"]);
    page.wish(json!({"do": "colour", "field": "level"}));
    // the first step divides
    let frame = page.frame_where(|frame| !frame.values.is_empty() && frame.time > 0.0);
    let of_level = |level: f32| frame.values[0].iter().filter(|value| **value == level).count();
    // the half at the wall is fine, the other coarse
    assert!(of_level(0.0) > 0 && of_level(1.0) > 0, "{:?}", frame.values[0]);
    assert_eq!(of_level(0.0) + of_level(1.0), frame.values[0].len());
    assert_eq!(names(&scene["arrows"]), ["displacement", "velocity", "contact_force"]);
    for name in names(&scene["arrows"]) {
        page.wish(json!({"do": "arrows", "of": name}));
        page.frame_where(|frame| frame.arrow_count == 1);
        page.wish(json!({"do": "arrows", "of": null}));
        page.frame_where(|frame| frame.arrow_count == 0);
    }
    page.wish(json!({"do": "grab", "hand": 0, "body": 0, "points": [0, 1, 2], "strength": 1}));
    page.frame_where(|frame| frame.hands == 1);
}

/// Bodies that frames carry, or meshes of several sizes, fly when they are thrown; points of theirs that could not be held
/// are refused in words.
#[test]
fn what_carries_a_body_is_thrown() {
    let coarse = r#"
    [bodies.bar.levels]
    coarser = [{ mesh = { generate = "bar", size = [0.4, 0.1, 0.1], cells = [2, 1, 1], element = "tet4" } }]
    fixed = "0"
    "#;
    let fine = CARRIED.split("[bodies.bar.frames]").next().expect("a body stands before its frames");
    let of_levels = fine
        .replace(
            "[world]",
            "[systems.main]\n    stepper = { name = \"staggered\", halvings = 6 }\n    [world]",
        )
        .replace("hex8", "tet4");
    for (scene, reason) in
        [(CARRIED.to_owned(), "frames carry"), (format!("{of_levels}{coarse}"), "has levels")]
    {
        let world = World::of(&scene);
        let mut page = Page::open(&world);
        page.document("scene");
        let start = page.frame();
        page.wish(json!({"do": "throw", "body": 0, "velocity": [0, 1, 0]}));
        let flown = page.frame_where(|frame| frame.time > start.time + 0.2);
        assert!(flown.height[0] > start.height[0] + 0.05, "{start:?} {flown:?}");
        page.wish(json!({"do": "pin", "body": 0, "points": [0]}));
        let refused = page.document("refused")["message"].as_str().expect("words").to_owned();
        assert!(refused.contains(reason), "{refused}");
    }
}

/// A tool presses the top of a block down, is seen by all pages, and is gone when its page lets go; what it did is
/// repeated from the recording.
#[test]
fn tools_press() {
    let world = World::of(BLOCK);
    let (mut page, mut other) = (Page::open(&world), Page::open(&world));
    let hello = page.document("hello");
    assert!(hello["tools"].as_array().unwrap().iter().any(|tool| tool["name"] == "finger"), "{hello}");
    let touch = |tool: &str| {
        json!({
            "do": "touch", "hand": 0, "tool": tool, "size": 0.1, "place": [0.1, 0.15, 0.1], "direction": [0, 1, 0],
            "strength": 1,
        })
    };
    page.wish(touch("spoon"));
    let refused = page.document_where("refused", |refused| refused["about"] == "touch");
    assert!(refused["message"].as_str().unwrap().contains("ball, finger, block, plate"), "{refused}");
    let start = page.frame().height[0];
    page.wish(touch("plate"));
    // its lower side, 25 mm below its middle, from above the block to 25 mm into it
    page.wish(json!({"do": "move", "hand": 0, "offset": [0, -0.05, 0]}));
    let pressed = other.frame_where(|frame| frame.tools == 1 && frame.height[0] < start - 2e-3);
    assert_eq!(other.tool_count, 1);
    page.wish(json!({"do": "release", "hand": 0}));
    other.frame_where(|frame| frame.tools == 0 && frame.time > pressed.time + 0.1);
    page.wish(json!({"do": "pause"}));
    page.document_where("status", |status| status["mode"] == "paused");
    world.assert_replayed();
}

/// Hands let go in any order, of points and of tools: what those after them press and remember stays theirs.
#[test]
fn hands_let_go_in_any_order() {
    let world = World::of(&explicit_block());
    let mut page = Page::open(&world);
    page.document("scene");
    page.frame();
    page.wish(json!({"do": "grab", "hand": 0, "body": 0, "points": [12], "strength": 1}));
    for (hand, x) in [(1, 0.05), (2, 0.15)] {
        page.wish(json!({
            "do": "touch", "hand": hand, "tool": "ball", "size": 0.08, "place": [x, 0.15, 0.1], "direction": [0, 1, 0],
            "strength": 0.5,
        }));
        page.wish(json!({"do": "move", "hand": hand, "offset": [0, -0.3, 0]}));
    }
    let begun = page.frame_where(|frame| frame.hands == 3);
    page.frame_where(|frame| frame.time > begun.time + 2.0);
    page.wish(json!({"do": "release", "hand": 0}));
    let released = page.frame_where(|frame| frame.hands == 2);
    // the ball of either hand, which is the first that is told by then, stays pressed in
    let without_points = page.frame_where(|frame| frame.time > released.time + 1.0);
    page.wish(json!({"do": "release", "hand": 1}));
    let released = page.frame_where(|frame| frame.hands == 1);
    let last = page.frame_where(|frame| frame.time > released.time + 1.0);
    for frame in [without_points, last] {
        let [stands, led, force] = frame.first_hand;
        assert!(stands[1] > 0.03 && led[1] < 0.0, "{:?}", frame.first_hand);
        // half the weight of 4 kg is what its spring gives
        assert!((force[1] + 2.0 * 9.81).abs() < 0.05 * 2.0 * 9.81, "{force:?}");
    }
    page.wish(json!({"do": "pause"}));
    page.document_where("status", |status| status["mode"] == "paused");
    world.assert_replayed();
}

/// A ball on a spring is led right through a block: the block stops it on its way, bears what the spring gives at most, and
/// what they did is repeated from the recording (DEB-44, DEB-46).
#[test]
fn held_tools_do_not_pass() {
    let world = World::of(&explicit_block());
    let mut page = Page::open(&world);
    page.document("scene");
    let start = page.frame().height[0];
    page.wish(json!({
        "do": "touch", "hand": 0, "tool": "ball", "size": 0.1, "place": [0.1, 0.16, 0.1], "direction": [0, 1, 0],
        "strength": 1,
    }));
    let above = page.frame_where(|frame| frame.tools == 1).first_hand;
    assert!((above[0][1] - 0.16).abs() < 1e-6 && above[2] == [0.0; 3], "{above:?}");
    // its middle from above the block, whose upper side is at 100 mm, to below it
    page.wish(json!({"do": "move", "hand": 0, "offset": [0, -0.3, 0]}));
    let through = page.frame_where(|frame| frame.first_hand[1][1] < -0.139);
    let pressed = page.frame_where(|frame| frame.time > through.time + 0.5);
    let [stands, led, force] = pressed.first_hand;
    assert!(stands[1] > 0.05 && led[1] < -0.139, "{:?}", pressed.first_hand);
    assert!(pressed.height[0] < start - 1e-3);
    // what the spring gives at most is the weight of 4 kg; the ball has come to rest under it
    assert!((force[1] + 4.0 * 9.81).abs() < 0.05 * 4.0 * 9.81, "{force:?}");
    page.wish(json!({"do": "release", "hand": 0}));
    let released = page.frame_where(|frame| frame.tools == 0);
    let risen = page.frame_where(|frame| frame.time > released.time + 0.5);
    assert!(risen.height[0] > pressed.height[0] + 1e-3, "{} {}", risen.height[0], pressed.height[0]);
    page.wish(json!({"do": "pause"}));
    page.document_where("status", |status| status["mode"] == "paused");
    world.assert_replayed();
}

/// A block of 4 x 2 x 2 cells of six tetrahedra and two meshes, a quarter of which is cut off after a second.
const CUT: &str = r#"
    format = 1
    [world]
    period = "10 ms"
    [systems.main]
    stepper = { name = "staggered", halvings = 4 }
    [bodies.block]
    mesh = { generate = "bar", size = [0.08, 0.04, 0.04], cells = [4, 2, 2], element = "tet4" }
    material = { name = "linear", youngs_modulus = "2 kPa", poissons_ratio = 0.3, density = 1000 }
    [bodies.block.levels]
    coarser = [{ mesh = { generate = "bar", size = [0.08, 0.04, 0.04], cells = [2, 1, 1], element = "tet4" } }]
    cuts = [{ region = { box = [[0.06, -1, -1], [1, 1, 1]] }, time = 1 }]
    [[bodies.block.pins]]
    region = "x_min"
"#;

/// DEB-54: pages are told of each triangle and edge of a surface that opens when it is there, and of each cell when it goes; classes are
/// those of all triangles, whatever the time; and a run begun anew is the same.
#[test]
fn surfaces_open_where_cells_are_cut() {
    let world = World::of(CUT);
    let mut page = Page::open(&world);
    let scene = page.document("scene");
    page.wish(json!({"do": "colour", "field": "element"}));
    page.wish(json!({"do": "inside", "is_shown": true}));
    let triangles = scene["bodies"][0]["surface_triangles"].as_u64().expect("a number") as usize;
    let frame = page.frame_where(|frame| {
        frame.time > 1.0 && frame.values.first().is_some_and(|all| all.len() > triangles)
    });
    let cells = scene["bodies"][0]["cells"].as_u64().expect("a number") as usize;
    assert_eq!(frame.values[0].len(), triangles + cells);
    let [of_triangles, of_edges] = &page.spans[0];
    assert_eq!([of_triangles.len(), of_edges.len()], [triangles, page.surfaces[0][2] as usize]);
    let there = |spans: &[[f64; 2]], time: f64| {
        spans.iter().filter(|[from, until]| *from <= time && time < *until).count()
    };
    // two triangles to a square: of 4 x 2 x 2 cells 40 squares, of 3 x 2 x 2 cells 32; three edges to two triangles
    for (time, count) in [(0.0, 80), (0.999, 80), (1.0, 64), (9.0, 64)] {
        assert_eq!([there(of_triangles, time), there(of_edges, time)], [count, count * 3 / 2], "{time} s");
    }
    assert_eq!(page.dates[0].iter().filter(|date| **date == 1.0).count(), cells / 4);
    assert_eq!(page.dates[0].iter().filter(|date| date.is_infinite()).count(), cells - cells / 4);
}

/// DEB-54: of a display surface the triangles on cells that are cut go, and the walls of the cut come.
#[test]
fn dresses_open_where_cells_are_cut() {
    let world = World::of(&format!("{CUT}[bodies.block.levels.dress]\n"));
    let mut page = Page::open(&world);
    let triangles = |frame: &crate::client::Frame| frame.skin_triangles.clone();
    assert_eq!(triangles(&page.frame_where(|frame| frame.time < 0.995)), [80]);
    assert_eq!(triangles(&page.frame_where(|frame| frame.time > 1.005)), [64]);
}
