//! Modules: networks of parts are the flat networks of the same masses and links, and what joins parts wrongly is refused.

use std::path::Path;

use souple_scene::{MODULES, Scene, read_text};

const HEAD: &str = "format = 1\n[world]\nperiod = \"10 ms\"\n[systems.main]\nstepper = \"t_simulation\"\n";

fn scene_with(text: &str, settings: &[&str]) -> Result<Scene, String> {
    let settings: Vec<String> = settings.iter().map(|setting| (*setting).to_owned()).collect();
    read_text("parts.toml", &format!("{HEAD}{text}"), Path::new("."), &settings)
        .map_err(|faults| faults.to_string())
}

fn scene(text: &str) -> Result<Scene, String> {
    scene_with(text, &[])
}

fn refused(text: &str, words: &[&str]) {
    let message = scene(text).err().expect("the scene is refused");
    for word in words {
        assert!(message.contains(word), "`{word}` is not in:\n{message}");
    }
}

/// A dumb-bell, and a hook whose end needs a mass.
const MODULES_TEXT: &str = r#"
[modules.dumbbell]
parameters = { mass = 2, stiffness = "$soft", length = 1 }
[modules.dumbbell.masses.ends]
positions = [[0, 0, 0], ["$length", 0, 0]]
mass = "$mass"
[[modules.dumbbell.links]]
law = { name = "spring", stiffness = "$stiffness" }
of = ["ends"]
chain = true
[modules.dumbbell.ports]
left = { kind = "M", of = "ends", mass = 0 }
right = { kind = "M", of = "ends", mass = -1 }

[modules.hook]
[modules.hook.masses.nail]
positions = [[0, 0, 0]]
mass = 1
fixed = true
[[modules.hook.links]]
law = { name = "spring", stiffness = 7 }
of = ["load", "nail"]
all = true
[modules.hook.ports]
load = { kind = "L" }

[modules.pair.modules.a]
module = "dumbbell"
[modules.pair.modules.b]
module = "dumbbell"
translate = [0, 1, 0]
parameters = { mass = 3 }
[modules.pair.modules.nail]
module = "hook"
translate = [0, -1, 0]
[modules.pair]
connections = [{ M = "a.left", L = "nail.load" }]
[[modules.pair.links]]
law = { name = "spring", stiffness = 11 }
of = ["a.right", "b.right"]
all = true
[modules.pair.ports]
far = { kind = "M", of = "b.left" }
"#;

const PAIRS: &str = r#"
[parameters]
soft = 100
[networks.n.modules.one]
module = "pair"
velocity = [0.1, 0, 0]
[networks.n.modules.two]
module = "pair"
rotate = { axis = [0, 0, 1], angle = "90 deg" }
translate = [5, 0, 0]
[[networks.n.links]]
law = { name = "spring", stiffness = 13 }
of = ["one.far", "two.far"]
all = true
"#;

/// The same, written flat: links of one law of both parts in one table.
const FLAT: &str = r#"
[networks.n.masses.one_nails]
positions = [[0, 0, 0], [1, 0, 0]]
mass = 2
velocity = [0.1, 0, 0]
[networks.n.masses.one_b]
positions = [[0, 1, 0], [1, 1, 0]]
mass = 3
velocity = [0.1, 0, 0]
[networks.n.masses.one_nail]
positions = [[0, -1, 0]]
mass = 1
fixed = true
velocity = [0.1, 0, 0]
[networks.n.masses.two_a]
positions = [[5, 0, 0], [5, 1, 0]]
mass = 2
[networks.n.masses.two_b]
positions = [[4, 0, 0], [4, 1, 0]]
mass = 3
[networks.n.masses.two_nail]
positions = [[6, 0, 0]]
mass = 1
fixed = true
[[networks.n.links]]
law = { name = "spring", stiffness = 13 }
from = [2]
to = [7]
[[networks.n.links]]
law = { name = "spring", stiffness = 11 }
from = [1, 6]
to = [3, 8]
[[networks.n.links]]
law = { name = "spring", stiffness = 100 }
from = [0, 2, 5, 7]
to = [1, 3, 6, 8]
[[networks.n.links]]
law = { name = "spring", stiffness = 7 }
from = [0, 5]
to = [4, 9]
"#;

/// Objects within objects move bit for bit as the flat network of their masses and links does, where they are placed without
/// being turned; forces on a mass are summed, whatever ports they come by, and its position goes to all.
#[test]
fn nested_modules_are_the_flat_network() {
    // turns are rotations of rounded angles: without one, every bit is the same
    let upright = PAIRS.replace("rotate = { axis = [0, 0, 1], angle = \"90 deg\" }\n", "");
    let flat = FLAT
        .replace("[[5, 0, 0], [5, 1, 0]]", "[[5, 0, 0], [6, 0, 0]]")
        .replace("[[4, 0, 0], [4, 1, 0]]", "[[5, 1, 0], [6, 1, 0]]")
        .replace("[[6, 0, 0]]", "[[5, -1, 0]]");
    let run = |text: &str| {
        let scene = scene(text).unwrap_or_else(|message| panic!("{message}"));
        let mut world = scene.model.start(scene.state);
        (0..200).for_each(|_| world.step().unwrap());
        world.state().systems[0].clone()
    };
    let (nested, flat) = (run(&format!("{MODULES_TEXT}{upright}")), run(&flat));
    assert_eq!(nested.q, flat.q);
    assert_eq!(nested.v, flat.v);
    assert!(nested.v.iter().any(|v| v.length() > 0.01), "something moves");
}

/// Where parts are turned, places and velocities are, but for rounding.
#[test]
fn parts_are_turned_and_moved() {
    let nested = scene(&format!("{MODULES_TEXT}{PAIRS}")).unwrap_or_else(|message| panic!("{message}"));
    let flat = scene(FLAT).unwrap();
    let (a, b) = (&nested.bodies[0].mesh, &flat.bodies[0].mesh);
    for (p, q) in a.points.iter().zip(&b.points) {
        assert!((*p - *q).length() < 1e-14, "{p:?} is not {q:?}");
    }
    assert_eq!(a.cell_count(), b.cell_count());
    // one force for all links of a law, wherever the module stands
    assert_eq!(nested.model.systems[0].forces.len(), 4);
    assert_eq!(a.groups["one.a.ends"].points, [0, 1]);
    assert_eq!(a.groups["two"].points, [5, 6, 7, 8, 9]);
    assert_eq!(a.groups["two.far"].points, [7]);
}

/// Parameters of a part, of a module and of the scene, from the command line too.
#[test]
fn parameters_are_put_in_from_the_inside_out() {
    let text = format!("{MODULES_TEXT}{PAIRS}");
    let masses =
        |settings: &[&str]| scene_with(&text, settings).unwrap().model.systems[0].mass.diagonal.clone();
    assert_eq!(masses(&[])[..4], [2.0, 2.0, 3.0, 3.0]);
    assert_eq!(masses(&["modules.dumbbell.parameters.mass=5"])[..4], [5.0, 5.0, 3.0, 3.0]);
    assert_eq!(masses(&["modules.pair.modules.b.parameters.mass=6"])[..4], [2.0, 2.0, 6.0, 6.0]);
}

/// A network serves as a module of another; one that has what no part has does not.
#[test]
fn objects_are_modules() {
    let object = "[networks.o.masses.m]\npositions = [[0, 0, 0], [0, 1, 0]]\nmass = 1\n[[networks.o.links]]\n\
                  law = { name = \"spring\", stiffness = 5 }\nchain = true\n";
    let text = format!("{object}[networks.n.modules.p]\nmodule = \"o\"\ntranslate = [3, 0, 0]\n");
    let read = scene(&text).unwrap_or_else(|message| panic!("{message}"));
    assert_eq!(read.bodies[1].mesh.points[1].to_array(), [3.0, 1.0, 0.0]);
    refused(&format!("{text}[[networks.o.pins]]\nregion = \"m\"\n"), &["network `o` has `pins`", "no part"]);
}

#[test]
fn wrong_connections_are_refused() {
    let with = |text: &str| format!("{MODULES_TEXT}[parameters]\nsoft = 1\n{text}");
    let two = "[networks.n.modules.a]\nmodule = \"dumbbell\"\n[networks.n.modules.h]\nmodule = \"hook\"\n[networks.n]\n";
    let joined = |connections: &str| with(&format!("{two}connections = [{connections}]\n"));
    assert!(scene(&joined(r#"{ M = "a.left", L = "h.load" }"#)).is_ok());
    refused(&joined(r#"{ M = "a.left", L = "a.right" }"#), &["`a.right` is an M point", "M to M"]);
    refused(&joined(r#"{ M = "h.load", L = "h.load" }"#), &["`h.load` is an L point", "not a mass"]);
    refused(
        &joined(r#"{ M = "a.left", L = "h.load" }, { M = "a.right", L = "h.load" }"#),
        &["`h.load` is joined to `a.left` and to `a.right`", "two M on one L"],
    );
    refused(&with(two), &["port L `h.load` is joined to no M", "end without a mass"]);
    refused(&joined(r#"{ M = "a.lft", L = "h.load" }"#), &["shows no port `lft`", "left, right"]);
    refused(&joined(r#"{ M = "a.left", L = "h.lood" }"#), &["no port L `h.lood`", "did you mean `h.load`"]);
    // what is inside a module with ports is its own affair
    refused(&joined(r#"{ M = "a.ends", L = "h.load" }"#), &["shows no port `ends`"]);
    refused(
        &with(
            "[modules.a.modules.b]\nmodule = \"b\"\n[modules.b.modules.a]\nmodule = \"a\"\n[networks.n.modules.a]\nmodule = \"a\"\n",
        ),
        &["hold each other in a circle", "n -> a -> b -> a"],
    );
    refused(
        &with("[networks.n.modules.a]\nmodule = \"dumbell\"\n"),
        &["no module `dumbell`", "did you mean `dumbbell`"],
    );
    refused(
        &with("[networks.n.modules.a]\nmodule = \"dumbbell\"\nparameters = { mess = 1 }\n"),
        &["no parameter `mess`", "did you mean `mass`", "parts.toml:"],
    );
    refused(
        &with(
            "[networks.n.modules.a]\nmodule = \"dumbbell\"\nmasses.m = { positions = [[0, 0, 0]], mass = 1 }\n",
        ),
        &["has `masses` beside those of module `dumbbell`"],
    );
    // a value that does not fit is told where the module says it
    refused(
        &with("[networks.n.modules.a]\nmodule = \"dumbbell\"\nparameters = { mass = -1 }\n"),
        &["networks.n.modules.a.masses.ends.mass", "-1"],
    );
    refused(
        &with("[modules.x]\nmases = 1\n[networks.n.modules.a]\nmodule = \"dumbbell\"\n"),
        &["no key `mases`"],
    );
}

/// Every module of the catalogue is a network, its text says the parameters that its entry tells, with the same defaults, and
/// all of them are used.
#[test]
fn the_catalogue_is_what_it_says() {
    for entry in MODULES.entries {
        let name = entry.name;
        let held = matches!(name, "wall" | "box");
        let balls = "[networks.n.masses.balls]\npositions = [[0, 0, 0.2]]\nmass = 1\n";
        let joined = "[networks.n]\nconnections = [{ M = \"balls\", L = \"m.contents\" }]\n";
        let more = if held { format!("{balls}{joined}") } else { String::new() };
        let part =
            |parameters: &str| format!("[networks.n.modules.m]\nmodule = \"{name}\"\n{parameters}\n{more}");
        let plain = scene(&part("")).unwrap_or_else(|message| panic!("{name}: {message}"));
        let defaults: Vec<String> = (entry.parameters.iter())
            .map(|parameter| format!("{} = {}", parameter.name, parameter.default.expect("a default")))
            .collect();
        let told = scene(&part(&format!("parameters = {{ {} }}", defaults.join(", "))));
        let told = told.unwrap_or_else(|message| panic!("{name}: {message}"));
        assert_eq!(plain.state.systems[0].q, told.state.systems[0].q, "{name}");
        assert_eq!(plain.model.systems[0].mass, told.model.systems[0].mass, "{name}");
        assert_eq!(plain.bodies[0].mesh.blocks, told.bodies[0].mesh.blocks, "{name}");
        let count = entry.build.lines().next().unwrap_or_default().matches('=').count() - 1;
        assert_eq!(count, entry.parameters.len(), "{name}");
        for parameter in entry.parameters {
            assert!(entry.build.contains(&format!("${}", parameter.name)), "{name}: {}", parameter.name);
        }
    }
}
