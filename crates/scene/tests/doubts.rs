//! What a scene is warned of, and contradictions that it is refused for with both places.

use std::path::Path;

use souple_scene::read_text;

const BAR: &str = r#"format = 1
[world]
period = "10 ms"
[systems.main]
stepper = "backward_euler"
[bodies.bar]
mesh = { generate = "bar", size = [1, 0.1, 0.1], cells = [4, 1, 1], element = "hex8" }
material = { name = "neo_hookean", youngs_modulus = "10 MPa", poissons_ratio = 0.3, density = 1000 }
[[bodies.bar.pins]]
region = "x_min"
"#;

fn warnings(text: &str) -> Vec<String> {
    read_text("scene.toml", text, Path::new("."), &[]).unwrap_or_else(|errors| panic!("{errors}")).warnings
}

#[track_caller]
fn assert_refused(text: &str, words: &[&str]) {
    match read_text("scene.toml", text, Path::new("."), &[]) {
        Ok(scene) => panic!("accepted with {:?}", scene.warnings),
        Err(errors) => {
            let said = errors.to_string();
            assert!(words.iter().all(|word| said.contains(word)), "wanted {words:?} in\n{said}");
        }
    }
}

/// Magnitudes that look like a slip of units, and ratios at which linear elements lock; usual ones say nothing.
#[test]
fn unusual_magnitudes_are_told() {
    assert_eq!(warnings(BAR), Vec::<String>::new());
    for (from, to, words) in [
        ("10 MPa", "10 Pa", "did you mean kPa or MPa?"),
        ("10 MPa", "1e15 Pa", "more than that of any matter; is the unit right?"),
        ("density = 1000", "density = 1e-3", "did you mean g/cm^3?"),
        ("density = 1000", "density = 1e6", "did you mean kg/m^3?"),
        ("poissons_ratio = 0.3", "poissons_ratio = 0.49", "lock"),
        ("size = [1, 0.1, 0.1]", "size = [1000, 100, 100]", "did you mean mm"),
        ("size = [1, 0.1, 0.1]", "size = [1e-6, 1e-7, 1e-7]", "is the scale right?"),
    ] {
        let said = warnings(&BAR.replace(from, to));
        let is_told = said.iter().any(|warning| warning.contains(words) && warning.contains("scene.toml:"));
        assert!(is_told, "{to}: {said:?}");
    }
}

/// Detection beside the steps that has nothing to detect is told, and what may be chosen.
#[test]
fn detection_of_nothing_is_told() {
    let late = |kind: &str| {
        BAR.replace("period = \"10 ms\"", &format!("period = \"10 ms\"\ncollisions = \"{kind}\""))
    };
    let said = warnings(&late("one_period_late"));
    assert!(said.len() == 1 && said[0].contains("scene.toml:4:"), "{said:?}");
    assert!(said[0].contains("nothing is detected here beside the steps"));
    assert_eq!(warnings(&late("every_step")), Vec::<String>::new());
    assert_refused(&late("late"), &["every_step", "one_period_late"]);
    let touched = r#"[shapes.ball]
shape = { name = "sphere", centre = [0.5, 0.3, 0.05], radius = 0.1 }
[[contacts]]
body = "bar"
shape = "ball"
detect = "triangles"
"#;
    assert_eq!(warnings(&format!("{}{touched}", late("one_period_late"))), Vec::<String>::new());
}

/// Crowds that State lists are old as soon as a mass moves, and make all else that was found beside the steps so: that is told. Crowds that are
/// no pairs leave the rest as it is.
#[test]
fn crowds_that_are_never_late_are_told() {
    let said = |stepper: &str, kind: &str| -> Vec<String> {
        let text = format!(
            "format = 1\n[world]\nperiod = \"1 ms\"\ncollisions = \"{kind}\"\n[systems.main]\nstepper = \"{stepper}\"\n\
             [networks.n.masses.nail]\npositions = [[0, 0, 0]]\nmass = 1\nfixed = true\n\
             [networks.n.masses.bob]\npositions = [[0.09, 0, 0]]\nmass = 1\n\
             [[networks.n.crowds]]\nname = \"touch\"\nlaw = {{ name = \"ball\", threshold = 0.1, stiffness = 100 }}\n"
        );
        warnings(&text).into_iter().filter(|warning| warning.contains("searches the crowd")).collect()
    };
    let told = said("backward_euler", "one_period_late");
    assert!(told.len() == 1 && told[0].contains("scene.toml:4:") && told[0].contains("`main`"), "{told:?}");
    assert_eq!(said("t_simulation", "one_period_late"), Vec::<String>::new());
    assert_eq!(said("backward_euler", "every_step"), Vec::<String>::new());
}

/// A motion that is elsewhere at the start tears, and is told; gravity that is not finite then is refused.
#[test]
fn starts_are_at_rest() {
    let led = |offset: &str| {
        format!(
            "{BAR}[[bodies.bar.pins]]\nregion = \"x_max\"\nmotion = {{ formula = [\"{offset}\", 0, 0] }}\n"
        )
    };
    assert_eq!(warnings(&led("t")), Vec::<String>::new());
    let said = warnings(&led("0.5 + t"));
    assert!(said.len() == 1 && said[0].contains("5.000e-1 m away from its points"), "{said:?}");
    let heavy =
        |y: &str| BAR.replace("[systems.main]", &format!("gravity = [0, \"{y}\", 0]\n[systems.main]"));
    assert_eq!(warnings(&heavy("-9.81 * t")), Vec::<String>::new());
    assert_refused(&heavy("1/t"), &["gravity is", "at t = 0"]);
}

/// Rotations are angles, also as key frames.
#[test]
fn rotations_are_angles() {
    let turned = |angle: &str| {
        format!(
            "{BAR}[[bodies.bar.pins]]\nregion = \"x_max\"\n\
             rotation = {{ times = [0, 1], offsets = [[0, 0, 0], [\"{angle}\", 0, 0]] }}\n"
        )
    };
    assert_eq!(warnings(&turned("30 deg")), Vec::<String>::new());
    assert_refused(&turned("50 cm"), &["50 cm"]);
}

/// A solver that cannot solve what the scene makes of it is replaced, and that is said.
#[test]
fn replaced_solvers_are_told() {
    let with = |stepper: &str| BAR.replace("stepper = \"backward_euler\"", &format!("stepper = {stepper}"));
    let viscous = "\n[bodies.bar.damping]\nviscosity = \"1 Pa s\"\n";
    let cg = with("{ name = \"backward_euler\", solver = \"cg\" }");
    assert_eq!(warnings(&cg), Vec::<String>::new());
    let said = warnings(&(cg + viscous));
    assert!(said.len() == 1 && said[0].contains("`gmres` takes its place"), "{said:?}");
    let free = with("{ name = \"backward_euler\", matrix_free = true, preconditioner = \"rigid_modes\" }");
    let said = warnings(&free);
    assert!(said.len() == 1 && said[0].contains("`block_jacobi` takes its place"), "{said:?}");
}

/// Two pins of one point with different targets; the same target twice, or other axes, contradict nothing.
#[test]
fn contradicting_pins_are_refused() {
    let with = |pin: &str| format!("{BAR}[[bodies.bar.pins]]\n{pin}\n");
    let both = ["bodies.bar.pins[1]", "`bodies.bar.pins[0]` (scene.toml:"];
    let led = "motion = { times = [0, 1], offsets = [[0, 0, 0], [0.1, 0, 0]] }";
    assert_refused(&with(&format!("region = \"x_min\"\n{led}")), &both);
    assert_refused(&with("region = \"x_min\"\nmotion = { formula = [0, \"t\", 0] }"), &both);
    for pin in [
        "region = \"x_min\"".to_owned(),
        "region = \"x_min\"\nmotion = { formula = [0, \"0 * t\", 0] }".to_owned(),
        format!("region = \"x_min\"\naxes = \"yz\"\n{led}"),
        format!("region = \"x_max\"\n{led}"),
    ] {
        assert_eq!(warnings(&with(&pin)), Vec::<String>::new(), "{pin}");
    }
}

/// Loads on pinned points and attachments between pinned bodies move nothing, which is said.
#[test]
fn idle_loads_and_attachments_are_told() {
    let load = format!("{BAR}[[bodies.bar.loads]]\nregion = \"x_min\"\nforce = [1, 0, 0]\n");
    assert!(warnings(&load)[0].contains("moves nothing"));
    let second =
        BAR[BAR.find("[bodies.bar]").expect("a body")..].replace("bar]", "other]").replace("bar.", "other.");
    let second = second.replace("density = 1000 }", "density = 1000 }\ntranslate = [0, 0.1, 0]");
    let attached = format!(
        "{BAR}{second}[[attachments]]\nfrom = \"other\"\nregion = \"x_min\"\nto = \"bar\"\nstiffness = 100\n"
    );
    let moving = warnings(&attached);
    assert!(moving.is_empty(), "{moving:?}");
    let pinned = attached.replace("region = \"x_min\"\n[", "region = { all = true }\n[");
    let said = warnings(&pinned);
    assert!(
        said.iter().any(|w| w.contains("these springs move nothing") && w.contains("bodies.other.pins[0]")),
        "{said:?}"
    );
}

/// Formulas that are not finite at the start are refused with the point; a root has no finite slope at zero.
#[test]
fn formulas_must_be_finite_at_the_start() {
    let load =
        |force: &str| format!("{BAR}[[bodies.bar.loads]]\nregion = \"x_max\"\nforce = [{force}, 0, 0]\n");
    assert_refused(&load("\"1 / t\""), &["the load on point", "at t = 0"]);
    assert_refused(&load("\"ln(-x)\""), &["at (1, "]);
    assert!(warnings(&load("\"1 / (1 + t)\"")).is_empty());
    let led = BAR.to_owned() + "motion = { formula = [\"sqrt(t)\", 0, 0] }\n";
    assert_refused(&led, &["the velocity of point"]);
}

/// A static body needs six rigid motions held: pins on a face do, on an edge they leave a turn, on a point three.
#[test]
fn free_static_bodies_are_refused() {
    let with = |pins: &str| {
        BAR.replace("\"backward_euler\"", "\"static\"")
            .replace("[[bodies.bar.pins]]\nregion = \"x_min\"\n", pins)
    };
    let pin = |region: &str| with(&format!("[[bodies.bar.pins]]\nregion = {region}\n"));
    assert!(warnings(&pin("\"x_min\"")).is_empty());
    assert_refused(&with(""), &["6 of 6 rigid motions", "3 shifts and 3 turns"]);
    assert_refused(&pin("{ points = [0] }"), &["3 of 6", "0 shifts and 3 turns"]);
    assert_refused(&pin("{ box = [[-1, -1, -1], [0, 0, 1]] }"), &["1 of 6", "0 shifts and 1 turns"]);
    assert_refused(&(pin("\"x_min\"") + "axes = \"x\"\n"), &["3 of 6", "2 shifts and 1 turns"]);
    let sprung = with("[[bodies.bar.springs]]\nregion = \"x_min\"\nstiffness = 10\n");
    assert!(warnings(&sprung).is_empty());
    // a floor that is touched holds what stands on it; one that is not may come to
    let floor = |height: f64, friction: f64| {
        with("")
            + &format!(
                "[shapes.floor]\nshape = {{ name = \"plane\", point = [0, {height}, 0] }}\n[[contacts]]\nbody = \"bar\"\nshape = \"floor\"\nfriction = {friction}\n"
            )
    };
    assert!(warnings(&floor(0.0, 0.5)).is_empty());
    assert!(warnings(&floor(0.0, 0.0))[0].contains("3 of 6"));
    assert!(warnings(&floor(-1.0, 0.5))[0].contains("unless a contact holds it"));
}

/// A straight bar that turns about itself stands as it stood: held at both ends it is held, at one it has two turns left.
#[test]
fn turns_that_move_nothing_need_no_hold() {
    let pinned = |region: &str| {
        BAR.replace("\"backward_euler\"", "\"static\"")
            .replace(
                "\"bar\", size = [1, 0.1, 0.1], cells = [4, 1, 1], element = \"hex8\"",
                "\"line\", from = [0, 0, 0], to = [1, 2, 3], cells = 4",
            )
            .replace("neo_hookean", "linear")
            .replace("region = \"x_min\"", region)
            + "[bodies.bar.section]\nname = \"bar\"\narea = \"1 cm^2\"\n"
    };
    assert!(warnings(&pinned("region = { points = [0, 4] }")).is_empty());
    assert_refused(&pinned("region = { points = [0] }"), &["2 of 5 rigid motions", "0 shifts and 2 turns"]);
}

/// A body attached to a held one is held by it: by springs without length at three points off a line.
#[test]
fn attachments_hold_static_bodies() {
    let second = BAR[BAR.find("[bodies.bar]").expect("a body")..BAR.find("[[bodies").expect("pins")]
        .replace("bar]", "other]")
        .replace("density = 1000 }", "density = 1000 }\ntranslate = [0, 0.1, 0]");
    let text = |region: &str| {
        let joined =
            format!("[[attachments]]\nfrom = \"other\"\nregion = {region}\nto = \"bar\"\nstiffness = 100\n");
        BAR.replace("\"backward_euler\"", "\"static\"") + &second + &joined
    };
    assert!(warnings(&text("\"y_min\"")).is_empty());
    assert_refused(&text("{ points = [0] }"), &["body `bar` and body `other`", "3 of 12"]);
}

/// Names that cannot be those of files are refused by body and by probe.
#[test]
fn names_of_files() {
    for name in ["../x", "", " ", "a/b", "a\\\\b", ".x", "a\\u0001b", "a:b", &"x".repeat(101)] {
        assert_refused(&BAR.replace("bodies.bar", &format!("bodies.\"{name}\"")), &["cannot name a file"]);
        let probe = format!("{BAR}[probes.\"{name}\"]\nbody = \"bar\"\nquantity = \"position\"\n");
        assert_refused(&probe, &["cannot name a file"]);
    }
    assert!(warnings(&BAR.replace("bodies.bar", "bodies.\"größer 2-b_c\"")).is_empty());
}

/// Pulled to where its exponential overflows a body is told by its force, whatever the stepper, not by what became of it in a
/// linear solve or a line search.
#[test]
fn laws_that_overflow_are_named() {
    // Fung's, which ends at E:E near 700/b: steps of a tenth of the length lead beyond
    let pulled = |stepper: &str, b: &str| {
        format!(
            r#"format = 1
[world]
period = 0.1
[systems.main]
stepper = "{stepper}"
[bodies.b]
mesh = {{ generate = "box", size = [1, 1, 1], cells = [1, 1, 1], element = "hex8" }}
material = {{ name = "hyperelastic", energy = "c/2*(exp(b*dot(E, E)) - 1) + k/2*(J - 1)^2", parameters = {{ c = "10 kPa", b = {b}, k = "100 kPa" }}, density = 1000 }}
[[bodies.b.pins]]
region = "x_min"
[[bodies.b.pins]]
region = "x_max"
motion = {{ formula = ["t", 0, 0] }}
"#
        )
    };
    for stepper in ["static", "quasi_static", "backward_euler", "newmark", "symplectic_euler"] {
        for b in ["500", "5000"] {
            let scene =
                read_text("scene.toml", &pulled(stepper, b), Path::new("."), &[]).expect("a pulled cube");
            let mut world = scene.model.start(scene.state);
            let error = (0..20).find_map(|_| world.step().err()).expect("an exponential that overflows");
            let said = error.to_string();
            let is_told = said.contains("force `b.material` is not finite or too large")
                && !said.contains("buckle")
                && !said.contains("linear solve");
            assert!(is_told, "{stepper}, b = {b}: {said}");
        }
    }
}

/// A motion that ends on the way is told as that, with the point that is led, whatever became of the step.
#[test]
fn motions_that_end_are_told() {
    for stepper in ["static", "backward_euler", "symplectic_euler", "rk4"] {
        let led = "[[bodies.bar.pins]]\nregion = \"x_max\"\nmotion = { formula = [\"1e-6/(t - 0.05) + 2e-5\", 0, 0] }\n";
        let text = format!("{}{led}", BAR.replace("backward_euler", stepper).replace("10 MPa", "10 kPa"));
        let scene =
            read_text("scene.toml", &text, Path::new("."), &[]).unwrap_or_else(|errors| panic!("{errors}"));
        let mut world = scene.model.start(scene.state);
        let error = (0..8).find_map(|_| world.step().err()).expect("a motion without a value");
        let said = error.to_string();
        assert!(
            said.contains("the motion of what is led is not finite or too large to compute with ([inf, 0.0, 0.0] at time 0.05"),
            "{stepper}: {said}"
        );
    }
}

/// A fault within a text points at its character, in every kind of string, behind parameters that were put in, on the command line.
#[test]
fn faults_in_texts_point_at_their_characters() {
    let law = |energy: &str| {
        BAR.replace(
            "name = \"neo_hookean\", youngs_modulus = \"10 MPa\", poissons_ratio = 0.3",
            &format!("name = \"hyperelastic\", energy = {energy}, parameters = {{ mu = \"1 MPa\" }}"),
        )
    };
    let load = |force: &str| format!("{BAR}[[bodies.bar.loads]]\nregion = \"x_max\"\nforce = {force}\n");
    let parameters = "[parameters]\nbig = 1000\n";
    for (text, read) in [
        (law("\"mu*dot(E, E) + mue*tr(E)^2\""), "mue"),
        (law("'mu*dot(E, E) + mu*lg(J)^2'"), "lg"),
        (law("\"\"\"\nmu*dot(E, E)\n  + mu*I9^2\"\"\""), "I9"),
        (law("\"mu*dot(E, E) + mu*\\u0041^2\""), "\\u0041"),
        (load("[\"1 + 2*sim(t)\", 0, 0]"), "sim"),
        (load("\"[0, 0, 3*q]\""), "q"),
        (load("['select(x > 0, 1, 2)', 0, 0]"), "select"),
        (format!("{}{parameters}", load("[\"$big * sim(t)\", 0, 0]")), "sim"),
        (format!("{}{parameters}", load("[\"$big * t + $bog\", 0, 0]")), "$bog"),
    ] {
        let errors =
            read_text("scene.toml", &text, Path::new("."), &[]).err().unwrap_or_else(|| panic!("{read}"));
        let [error] = &errors.0[..] else { panic!("{read}: not one error, but\n{errors}") };
        let line = text.lines().nth(error.line - 1).unwrap_or_default();
        let from: String = line.chars().skip(error.column - 1).collect();
        assert!(from.starts_with(read) && error.value == read, "`{read}`: {errors}");
    }
    // laws of links with their parameters, states, transitions, entries and memory, and heights are built from their texts later
    let link = |law: &str| {
        format!(
            "format = 1\n[world]\nperiod = 0.01\n[systems.main]\nstepper = \"t_simulation\"\n\
             [networks.n.masses.bob]\npositions = [[0, 0, 0], [1, 0, 0]]\nmass = 1\n\
             [[networks.n.links]]\nlaw = {law}\nof = [\"bob\", \"bob\"]\nall = true\nrest_length = 1\n"
        )
    };
    // one of five keys is written otherwise
    let finite_state = |key: &str| {
        let keys = [
            "states = { a = \"0\", b = \"k\" }",
            "transitions = { \"a -> b\" = \"D < 1\" }",
            "entries = { b = \"k = 1\" }",
            "memory = { k = \"0\" }",
            "parameters = { c = \"1\" }",
        ];
        let name = |key: &str| key.split(' ').next().map(str::to_owned);
        let keys = keys.map(|known| if name(known) == name(key) { key } else { known });
        link(&format!("{{ name = \"finite_state\", {} }}", keys.join(", ")))
    };
    let conditional = |first: &str, more: &str| {
        let more = if more.is_empty() { String::new() } else { format!(", {more}") };
        link(&format!("{{ name = \"conditional\", states = {{ {first}, b = \"VN\" }}{more} }}"))
    };
    let height = |formula: &str| {
        format!(
            "format = 1\n[world]\nperiod = 0.01\n[systems.main]\nstepper = \"t_simulation\"\n\
             [networks.n.masses.bob]\nmass = 1\n\
             fill = {{ shape = {{ name = \"height\", height = {formula} }}, spacing = 0.5, box = [[-1, -1, 0], [1, 1, 1]] }}\n"
        )
    };
    for (text, read) in [
        (link("{ name = \"formula\", push = \"3*(D - L0) + kk*V\" }"), "kk"),
        (link("{ name = \"formula\", push = \"-k*D\", parameters = { k = \"2 + qq\" } }"), "qq"),
        (link("{ name = \"rheological\", network = \"spring(3) - spong(2)\" }"), "spong"),
        (height("\"0.1*sim(x)\""), "sim"),
        (finite_state("entries = { b = \"L0 = D; k = 2*zz\" }"), "zz"),
        (finite_state("states = { a = \"0\", b = \"3*(D - L0) + yy\" }"), "yy"),
        (finite_state("transitions = { \"a -> b\" = \"D < xx\" }"), "xx"),
        (finite_state("memory = { k = \"1 + ww\" }"), "ww"),
        (finite_state("parameters = { c = \"2*vv\" }"), "vv"),
        (conditional("a = \"LN; SUP, L, 3*qq -> b\"", ""), "qq"),
        (conditional("a = \"LN;  CHK,  7*pp; SUP, L, 1 -> b\"", ""), "pp"),
        (conditional("a = 'SUP, L, far -> b'", "parameters = { far = \"1 + oo\" }"), "oo"),
        (conditional("a = 'CDX -> b'", "external = \"t - nn\""), "nn"),
        (
            BAR.replace(
                "[[bodies.bar.pins]]",
                "[bodies.bar.material_fields.density]\nvalue = \"1e3*(1 + zz)\"\n[[bodies.bar.pins]]",
            ),
            "zz",
        ),
    ] {
        let errors =
            read_text("scene.toml", &text, Path::new("."), &[]).err().unwrap_or_else(|| panic!("{read}"));
        let told = errors.0.iter().find(|error| error.value == read && !error.message.contains("byte"));
        let Some(error) = told else { panic!("`{read}`: {errors}") };
        let line = text.lines().nth(error.line - 1).unwrap_or_default();
        let from: String = line.chars().skip(error.column - 1).collect();
        assert!(from.starts_with(read), "`{read}`: {errors}");
    }
    // a parameter of a law whose unit is not the one that its place asks for
    for text in [
        link(
            "{ name = \"rheological\", network = \"spring(k) - damper(2)\", parameters = { k = \"3 kg\" } }",
        ),
        conditional("a = 'CHK, k; SUP, L, 1 -> b'", "parameters = { k = \"3 kg\" }"),
    ] {
        let errors = read_text("scene.toml", &text, Path::new("."), &[]).err().expect("no stiffness");
        let Some(error) = errors.0.iter().find(|error| error.path.ends_with("law.parameters.k")) else {
            panic!("not told at the parameter: {errors}")
        };
        let line = text.lines().nth(error.line - 1).unwrap_or_default();
        let from: String = line.chars().skip(error.column - 1).collect();
        assert!(from.trim_start_matches('"').starts_with("3 kg"), "{errors}");
    }
    // every fault of a law at once
    let both = law("\"mu*dot(E, E)\"").replace("{ mu = \"1 MPa\" }", "{ mu = \"1 MPq\", k = \"3 kPz\" }");
    let errors = read_text("scene.toml", &both, Path::new("."), &[]).err().expect("no such units");
    let values: Vec<&str> = errors.0.iter().map(|error| error.value.as_str()).collect();
    assert_eq!(values, ["MPq", "kPz"], "{errors}");
    let set = ["bodies.bar.loads=[{ region = \"x_max\", force = [\"3*q\", 0, 0] }]".to_owned()];
    let errors = read_text("scene.toml", BAR, Path::new("."), &set).err().expect("no `q`");
    assert_eq!(errors.0[0].value, "q", "{errors}");
}

/// What could not be read is told once: nothing is said of what it is not.
#[test]
fn faults_are_told_once() {
    for pins in [
        "motion = { times = [0, 1], offsets = [[0, 0, 0], [\"1 cm\", \"1 N\", 0]] }",
        "motion = { formula = [\"$qq\", 0, 0] }",
        "motion = { times = [0, \"$qq\"], offsets = [[0, 0, 0], [0, 0, 0]] }",
    ] {
        let text = format!("{BAR}[[bodies.bar.pins]]\nregion = \"x_max\"\n{pins}\n");
        let errors = read_text("scene.toml", &text, Path::new("."), &[]).err().expect(pins);
        assert_eq!(errors.0.len(), 1, "{errors}");
    }
}

const PRESSED: &str = r#"format = 1
[world]
period = "10 ms"
[systems.main]
stepper = "symplectic_euler"
steps_per_period = 20
[bodies.slab]
mesh = { generate = "box", size = [0.1, 0.1, 0.04], cells = [4, 4, 2], element = "tet4" }
material = { name = "stable_neo_hookean", youngs_modulus = "2 kPa", poissons_ratio = 0.35, density = 1000 }
[[bodies.slab.pins]]
region = "z_min"
[hands.right]
device = "emulated"
tool = { name = "sphere", centre = [0.03, 0.05, 0.07], radius = 0.02 }
body = "slab"
region = "z_max"
touch = { detect = "triangles", response = "imposed" }
"#;

const LEFT: &str = r#"[hands.left]
device = "emulated"
tool = { name = "sphere", centre = [0.08, 0.05, 0.07], radius = 0.02 }
body = "slab"
region = { box = [[0.06, -1, 0.039], [1, 1, 1]] }
touch = { detect = "triangles", response = "imposed" }
"#;

/// DEB-45: a tool that imposes displacements is told where pins hold what it may touch, and where another such tool may hold the same points; with
/// regions of their own, or where one of them pushes, there is nothing to tell.
#[test]
fn who_holds_points_already_is_told() {
    let told = |text: &str| -> Vec<String> {
        warnings(text).into_iter().filter(|warning| warning.contains("may")).collect()
    };
    assert_eq!(told(PRESSED), Vec::<String>::new());
    // 25 points of the lower face
    let whole = told(&PRESSED.replace("region = \"z_max\"\n", ""));
    assert!(whole.len() == 1 && whole[0].contains("pins hold 25 points of body `slab`"), "{whole:?}");
    assert!(whole[0].contains("`hands.right`") && whole[0].contains("scene.toml:"), "{whole:?}");
    let slides = PRESSED.replace("region = \"z_min\"", "region = \"x_min\"\naxes = \"x\"");
    // 5 by 3 points there, of which 5 are of the upper face
    let partly = told(&slides);
    assert!(partly.len() == 1 && partly[0].contains("hold 5 points"), "{partly:?}");
    assert!(partly[0].contains("5 of them along some axes only"), "{partly:?}");
    let two = format!("{PRESSED}{LEFT}");
    // 2 by 5 points of the upper face
    let both = told(&two);
    assert!(both.len() == 1 && both[0].contains("it may hold 10 points of body `slab`"), "{both:?}");
    assert!(both[0].contains("`hands.right`") && both[0].contains("`hands.left`"), "{both:?}");
    let apart = "region = { box = [[-1, -1, 0.039], [0.055, 1, 1]] }";
    assert_eq!(told(&two.replace("region = \"z_max\"", apart)), Vec::<String>::new());
    let pushes = LEFT.replace(", response = \"imposed\"", "");
    assert_eq!(told(&format!("{PRESSED}{pushes}")), Vec::<String>::new());
}

/// A cut through all cells of a body leaves nothing that could be seen or touched, which is told; one through some of them is not.
#[test]
fn cuts_through_everything_are_told() {
    let body = |region: &str, time: &str| {
        let text = BAR
            .replace("\"backward_euler\"", "{ name = \"staggered\", halvings = 9 }")
            .replace("hex8", "tet4")
            .replace("neo_hookean", "stable_neo_hookean");
        let cuts = format!(
            "[bodies.bar.levels]\ncount = 1\ncuts = [{{ region = {region} }}, {{ region = {{ box = [[0.4, -1, -1], [2, 2, 2]] }}{time} }}]\n"
        );
        text + &cuts
    };
    assert_eq!(warnings(&body("{ box = [[0.4, -1, -1], [0.8, 1, 1]] }", "")), Vec::<String>::new());
    let said = warnings(&body("{ box = [[-1, -1, -1], [0.6, 1, 1]] }", ", time = 0.3"));
    assert!(
        said.iter().any(|told| told.contains("through all of its") && told.contains("from 0.3 s on")),
        "{said:?}"
    );
}
