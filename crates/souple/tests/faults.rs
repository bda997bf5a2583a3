//! Faulty scenes, requests and files through the program: each its exit status, its words, no panic, nothing
//! half-written.
//!
//! Faulty meshes have a file of their own, `mesh_faults.rs`.

use crate::common::{Answer, CUBE, Folder, assert_errors, souple, souple_in};

/// What is asked, and how it must end.
struct Fault<'a> {
    name: &'a str,
    arguments: &'a [&'a str],
    status: i32,
    /// What the message must contain, in any case of letters.
    words: &'a str,
}

/// Runs each fault in a folder; with `--out out` added to runs, that folder must not hold anything afterwards.
#[track_caller]
fn assert_refused(folder: &Folder, faults: &[Fault]) {
    let mut failures = Vec::new();
    for fault in faults {
        let before = folder.files();
        let answer = souple_in(folder.path(), fault.arguments);
        let words = fault.words.to_lowercase();
        let is_met = answer.status == Some(fault.status)
            && answer.stderr.to_lowercase().contains(&words)
            && !answer.stderr.contains("panicked")
            && folder.files() == before;
        if !is_met {
            failures.push(format!(
                "{}: wanted {} with `{}`, got {:?} with\n{}\nnew files: {:?}",
                fault.name,
                fault.status,
                fault.words,
                answer.status,
                answer.stderr,
                folder.files().iter().filter(|file| !before.contains(file)).collect::<Vec<_>>()
            ));
        }
    }
    assert!(failures.is_empty(), "{} of {}:\n{}", failures.len(), faults.len(), failures.join("\n"));
}

/// A text of which a part, which must be there, is replaced.
#[track_caller]
fn changed(text: &str, from: &str, to: &str) -> String {
    assert!(text.contains(from), "`{from}` is not in the scene");
    text.replace(from, to)
}

/// What the cube is made of, density apart.
const MATERIAL: &str = "\"neo_hookean\", youngs_modulus = \"20 kPa\", poissons_ratio = 0.3";

/// The cube changed in one place, the status and the words that answer it.
const SCENES: &[(&str, &str, &str, &str)] = &[
    ("unknown_key", "gravity", "gravty", "did you mean `gravity`"),
    ("unknown_table", "[world]", "[[wrold]]\n[world]", "wrold"),
    ("wrong_unit", "20 kPa", "20 kN", "kN"),
    ("unknown_unit", "10 ms", "10 parsec", "parsec"),
    ("wrong_type", "\"10 ms\"", "[1, 2]", "world.period"),
    ("missing_density", ", density = 1000", "", "density"),
    ("missing_format", "format = 1\n", "", "format"),
    ("other_format", "format = 1\n", "format = 2\n", "format"),
    ("missing_period", "period = \"10 ms\"\n", "", "period"),
    ("zero_density", "density = 1000", "density = 0", "density"),
    ("negative_density", "density = 1000", "density = -1", "density"),
    ("incompressible", "poissons_ratio = 0.3", "poissons_ratio = 0.5", "0.5"),
    ("negative_modulus", "20 kPa", "-20 kPa", "youngs_modulus"),
    ("negative_period", "\"10 ms\"", "\"-10 ms\"", "world.period"),
    ("zero_period", "\"10 ms\"", "0", "world.period"),
    ("not_a_number", "poissons_ratio = 0.3", "poissons_ratio = nan", "poissons_ratio"),
    ("infinite", "density = 1000", "density = inf", "density"),
    ("infinite_size", "size = [1, 1, 1]", "size = [inf, 1, 1]", "size"),
    ("flat_size", "size = [1, 1, 1]", "size = [1, 0, 1]", "size"),
    ("absurd_cells", "cells = [2, 2, 2]", "cells = [1000000, 1000000, 1000000]", "cells"),
    ("more_cells_than_numbers", "cells = [2, 2, 2]", "cells = [1e300, 1e300, 1e300]", "cells"),
    ("negative_cells", "cells = [2, 2, 2]", "cells = [-2, 2, 2]", "cells"),
    ("half_cells", "cells = [2, 2, 2]", "cells = [2.5, 2, 2]", "cells"),
    ("unknown_element", "hex8", "hex9", "did you mean `hex8`"),
    ("unknown_generator", "\"box\"", "\"bx\"", "`box`"),
    ("unknown_material", "neo_hookean", "neo_hokean", "did you mean `neo_hookean`"),
    ("unknown_body", "body = \"cube\"", "body = \"cub\"", "did you mean `cube`"),
    ("unknown_quantity", "\"position\"", "\"posture\"", "posture"),
    ("negative_duration", "\"100 ms\"", "\"-1 s\"", "run.duration"),
    ("absurd_duration", "\"100 ms\"", "1e300", "duration"),
    ("absurd_frames", "frames = 5", "frames = 99999999999999999999", "frames"),
    ("two_bodies", "[probes.place]", "[bodies.cube]\nmesh = 1\n[probes.place]", "cube"),
    ("unclosed", "[bodies.cube]", "[bodies.cube", "bodies.cube"),
    ("unclosed_text", "\"10 ms\"", "\"10 ms", "string"),
    (
        "pin_on_nothing",
        "[probes.place]",
        "[[bodies.cube.pins]]\nregion = { sphere = { centre = [9, 9, 9], radius = 1 } }\n[probes.place]",
        "point",
    ),
    (
        "pin_on_no_group",
        "[probes.place]",
        "[[bodies.cube.pins]]\nregion = { group = \"x_mim\" }\n[probes.place]",
        "did you mean `x_min`",
    ),
    (
        "bad_formula",
        "[probes.place]",
        "[[bodies.cube.loads]]\nregion = \"x_min\"\nforce = [\"1 +\", 0, 0]\n[probes.place]",
        "force",
    ),
    (
        "unknown_stepper",
        "[probes.place]",
        "[systems.main]\nstepper = \"verlt\"\n[probes.place]",
        "did you mean `verlet`",
    ),
    (
        "zero_steps",
        "[probes.place]",
        "[systems.main]\nstepper = \"verlet\"\nsteps_per_period = 0\n[probes.place]",
        "steps_per_period",
    ),
    (
        "negative_friction",
        "[probes.place]",
        "[shapes.floor]\nshape = { name = \"plane\" }\n[[contacts]]\nbody = \"cube\"\nshape = \"floor\"\nfriction = -1\n[probes.place]",
        "friction",
    ),
    (
        "unknown_shape",
        "[probes.place]",
        "[shapes.floor]\nshape = { name = \"plain\" }\n[probes.place]",
        "did you mean `plane`",
    ),
    (
        "missing_mesh",
        "generate = \"box\", size = [1, 1, 1], cells = [2, 2, 2], element = \"hex8\"",
        "file = \"nowhere.msh\"",
        "nowhere.msh",
    ),
    ("missing_include", "title", "include = [\"nowhere.toml\"]\ntitle", "nowhere.toml"),
    ("own_include", "title", "include = [\"own_include.toml\"]\ntitle", "own_include.toml"),
    (
        "pins_of_two_minds",
        "[probes.place]",
        "[[bodies.cube.pins]]\nregion = \"x_min\"\n[[bodies.cube.pins]]\nregion = \"x_min\"\nmotion = { formula = [\"t\", 0, 0] }\n[probes.place]",
        "`bodies.cube.pins[0]` (pins_of_two_minds.toml:",
    ),
    (
        "static_without_pins",
        "[probes.place]",
        "[systems.main]\nstepper = \"static\"\n[probes.place]",
        "6 of 6 rigid motions are held by nothing",
    ),
    (
        "static_on_a_hinge",
        "[probes.place]",
        "[systems.main]\nstepper = \"static\"\n[[bodies.cube.pins]]\nregion = { box = [[0, 0, 0], [0, 0, 1]] }\n[probes.place]",
        "1 of 6 rigid motions",
    ),
    (
        "quasi_static_without_pins",
        "[probes.place]",
        "[systems.main]\nstepper = \"quasi_static\"\n[probes.place]",
        "6 of 6 rigid motions are held by nothing",
    ),
    (
        "newmark_that_blows_up",
        "[probes.place]",
        "[systems.main]\nstepper = { name = \"newmark\", gamma = 0.8, beta = 0.3 }\n[probes.place]",
        "stable for beta of at least 0.4",
    ),
    (
        "newmark_that_gains",
        "[probes.place]",
        "[systems.main]\nstepper = { name = \"newmark\", gamma = 0.4 }\n[probes.place]",
        "between 0.5 and 1",
    ),
    (
        "bdf2_with_a_stranger",
        "[probes.place]",
        "[systems.main]\nstepper = { name = \"bdf2\", gamma = 0.6 }\n[probes.place]",
        "gamma",
    ),
    (
        "mooney_that_gives_way",
        MATERIAL,
        "\"mooney_rivlin\", c10 = 1e3, c01 = -2e3, bulk_modulus = 1e5",
        "must be above 0",
    ),
    ("mooney_without_volume", MATERIAL, "\"mooney_rivlin\", c10 = 1e3, c01 = 1e3", "bulk_modulus"),
    ("mooney_by_young", MATERIAL, "\"mooney_rivlin\", youngs_modulus = 1e5", "youngs_modulus"),
    ("mooney_in_metres", MATERIAL, "\"mooney_rivlin\", c10 = \"1 m\", c01 = 0, bulk_modulus = 1e5", "Pa"),
    (
        "ogden_of_one_half",
        MATERIAL,
        "\"ogden\", mu = [1e3, 2e3], alpha = [2], bulk_modulus = 1e5",
        "they go in pairs",
    ),
    ("ogden_of_zero", MATERIAL, "\"ogden\", mu = [1e3], alpha = [0], bulk_modulus = 1e5", "alpha[0] is 0"),
    (
        "ogden_of_a_number",
        MATERIAL,
        "\"ogden\", mu = 1e3, alpha = [2], bulk_modulus = 1e5",
        "a list of numbers",
    ),
    ("ogden_of_nothing", MATERIAL, "\"ogden\", mu = [], alpha = [], bulk_modulus = 1e5", "the list is empty"),
    (
        "ogden_of_four",
        MATERIAL,
        "\"ogden\", mu = [1, 1, 1, 1], alpha = [1, 2, 3, 4], bulk_modulus = 1e5",
        "3 at most",
    ),
    (
        "ogden_of_a_text",
        MATERIAL,
        "\"ogden\", mu = [\"1 kPa\", \"2 m\"], alpha = [1, 2], bulk_modulus = 1e5",
        "mu[1]",
    ),
    (
        "ogden_that_gives_way",
        MATERIAL,
        "\"ogden\", mu = [1e3], alpha = [-2], bulk_modulus = 1e5",
        "must be above 0",
    ),
    (
        "load_without_a_start",
        "[probes.place]",
        "[[bodies.cube.loads]]\nregion = \"x_min\"\nforce = [\"1 / t\", 0, 0]\n[probes.place]",
        "the load on point 0, at (0, 0, 0), is (inf, 0, 0) at t = 0",
    ),
    (
        "load_outside_its_range",
        "[probes.place]",
        "[[bodies.cube.loads]]\nregion = \"x_max\"\nforce = [0, \"sqrt(-x)\", 0]\n[probes.place]",
        "at (1, 0, 0)",
    ),
    (
        "motion_without_a_start",
        "[probes.place]",
        "[[bodies.cube.pins]]\nregion = \"x_min\"\nmotion = { formula = [\"sqrt(t)\", 0, 0] }\n[probes.place]",
        "the velocity of point 0",
    ),
    (
        "shape_without_a_start",
        "[probes.place]",
        "[shapes.floor]\nshape = { name = \"plane\" }\nmotion = { formula = [0, \"ln(t)\", 0] }\n[[contacts]]\nbody = \"cube\"\nshape = \"floor\"\n[probes.place]",
        "the motion of shape `floor` is not finite",
    ),
    ("body_named_as_a_path", "[bodies.cube]", "[bodies.\"../cube\"]", "cannot name a file"),
    ("probe_without_a_name", "[probes.place]", "[probes.\"\"]", "cannot name a file"),
    (
        "probe_about_nothing",
        "quantity = \"position\"",
        "quantity = \"position\"\nabout = [0, 0, 0]",
        "is of no place",
    ),
    (
        "limits_crossed",
        "[run]",
        "[[expect]]\nprobe = \"place\"\ncomponent = \"y\"\nmin = 2\nmax = 1\n[run]",
        "at least 2 and at most 1",
    ),
    (
        "picture_along_up",
        "[run]",
        "[picture]\ndirection = [0, 1, 0]\nup = [0, -1, 0]\n[run]",
        "along what is up",
    ),
    ("expect_of_nothing", "[run]", "[[expect]]\nprobe = \"plaice\"\nmax = 1\n[run]", "did you mean `place`"),
];

/// Faulty scenes: refused by `run` and by `check` alike, before anything is written.
#[test]
fn faulty_scenes() {
    assert!(SCENES.len() >= 40);
    let folder = Folder::new("faulty_scenes");
    for (name, from, to, _) in SCENES {
        folder.write(&format!("{name}.toml"), changed(CUBE, from, to));
    }
    folder.write("empty.toml", "");
    folder.write("garbage.toml", garbage(400));
    folder.write("zeros.toml", [0; 64]);
    let mut files: Vec<(String, &str)> =
        SCENES.iter().map(|(name, _, _, words)| (format!("{name}.toml"), *words)).collect();
    files.extend(
        [("empty.toml", "format"), ("garbage.toml", "UTF-8"), ("zeros.toml", "zeros.toml")]
            .map(|(f, w)| (f.to_owned(), w)),
    );
    files.extend(
        [("nowhere.toml", "nowhere.toml"), (".", "."), ("nowhere", "nowhere")]
            .map(|(f, w)| (f.to_owned(), w)),
    );
    for (file, words) in &files {
        let check = ["check", file.as_str()];
        let run = ["run", file.as_str(), "--out", "out"];
        let calls = [&check[..], &run[..]].map(|arguments| Fault { name: file, arguments, status: 2, words });
        // a duration is no matter of the scene's validity: `check` answers it with a forecast
        let calls = if file.starts_with("absurd_duration") { &calls[1..] } else { &calls[..] };
        assert_refused(&folder, calls);
    }
}

/// A scene that reads well but whose first step is refused is called so by `check`, which ends with 1.
#[test]
fn refused_first_steps_are_found() {
    let folder = Folder::new("first_step");
    folder.write("cube.toml", changed(CUBE, "gravity = [0, -9.81, 0]", "gravity = [0, -1e308, 0]"));
    let answer = souple_in(folder.path(), ["check", "cube.toml", "--json"]).ends(1);
    let document = answer.json();
    assert_eq!(document["valid"], false);
    assert_errors(&document);
    assert!(document["errors"][0]["message"].to_string().contains("system `main`"), "{document:#}");
}

/// Bytes without pattern, the same each time (a linear congruential generator).
fn garbage(count: usize) -> Vec<u8> {
    let mut state = 2_463_534_242_u32;
    let mut next = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 24) as u8
    };
    (0..count).map(|_| next()).collect()
}

/// Names of bodies and probes become names of files: none leaves the folder of the run.
#[test]
fn names_stay_in_the_folder() {
    let folder = Folder::new("names");
    for (index, name) in ["../evil", "/evil", "a/b", "..", "a\\\\b", ".hidden", ""].iter().enumerate() {
        let body = folder.write(
            &format!("body{index}.toml"),
            CUBE.replace("[bodies.cube]", &format!("[bodies.\"{name}\"]"))
                .replace("body = \"cube\"", &format!("body = \"{name}\"")),
        );
        let probe = folder.write(
            &format!("probe{index}.toml"),
            CUBE.replace("[probes.place]", &format!("[probes.\"{name}\"]")),
        );
        for (kind, scene) in [("body", &body), ("probe", &probe)] {
            let arguments = ["run", scene, "--out", "run/out", "--quiet"];
            assert_refused(
                &folder,
                &[Fault { name: &format!("{kind} `{name}`"), arguments: &arguments, status: 2, words: kind }],
            );
        }
    }
}

/// Texts nested ten thousand deep end in an error, not in an overflow of the stack.
#[test]
fn deep_nesting() {
    let folder = Folder::new("nesting");
    let deep = 20_000;
    folder.write("lists.toml", format!("{CUBE}\n[deep]\nx = {}", "[".repeat(deep)));
    folder
        .write("closed_lists.toml", format!("{CUBE}\n[deep]\nx = {}{}", "[".repeat(deep), "]".repeat(deep)));
    folder.write("keys.toml", format!("{CUBE}\n[deep]\nx{} = 1", ".x".repeat(deep)));
    let with_force = |force: &str| {
        let load =
            format!("[[bodies.cube.loads]]\nregion = \"x_min\"\nforce = [\"{force}\", 0, 0]\n[probes.place]");
        CUBE.replace("[probes.place]", &load)
    };
    folder.write("parentheses.toml", with_force(&format!("{}1{}", "(".repeat(deep), ")".repeat(deep))));
    folder.write("signs.toml", with_force(&format!("{}1", "-".repeat(deep))));
    folder.write("powers.toml", with_force(&format!("{}1", "2^".repeat(deep))));
    folder.write("calls.toml", with_force(&format!("{}1{}", "sin(".repeat(deep), ")".repeat(deep))));
    for file in ["lists", "closed_lists", "keys", "parentheses", "signs", "powers", "calls"] {
        let file = format!("{file}.toml");
        let arguments = ["check", file.as_str()];
        assert_refused(&folder, &[Fault { name: &file, arguments: &arguments, status: 2, words: &file }]);
    }
    // a long sum is no nesting: it is only long
    folder.write("sum.toml", with_force(&format!("{}1", "1+".repeat(deep))));
    let answer = souple_in(folder.path(), ["check", "sum.toml"]);
    assert!(matches!(answer.status, Some(0 | 2)), "{answer:#?}");
}

/// Requests that cannot be met, of a scene that is in order.
#[test]
fn faulty_requests() {
    let folder = Folder::new("requests");
    folder.write("cube.toml", CUBE);
    folder.write("other.toml", CUBE.replace("20 kPa", "30 kPa"));
    folder.write("file", "a file");
    folder.write("garbage.souple", garbage(300));
    folder.write("garbage.json", garbage(300));
    folder.write("no.json", "{}");
    let run =
        ["run", "cube.toml", "--quiet", "--out", "made", "--snapshot-every", "5", "--record", "run.json"];
    souple_in(folder.path(), run).ends(0);
    let snapshot = std::fs::read(folder.path().join("made/snapshot_00000005.souple")).expect("a snapshot");
    for (name, end) in [
        ("cut_header", 10),
        ("cut_line", 90),
        ("cut_half", snapshot.len() / 2),
        ("cut_end", snapshot.len() - 1),
    ] {
        folder.write(&format!("{name}.souple"), &snapshot[..end]);
    }
    folder.write("longer.souple", [&snapshot[..], &[0; 8]].concat());
    folder.write("header.souple", "souple snapshot 2 {\"scene_sha256\": \"1234\"}\n");
    folder.write("old.souple", "souple snapshot of scene 1234 state 5678\n");
    folder.write("empty.souple", "");
    let recording = std::fs::read_to_string(folder.path().join("run.json")).expect("a recording");
    folder.write("cut.json", &recording[..recording.len() / 2]);
    folder.write("version.json", changed(&recording, "\"souple_recording\": 3", "\"souple_recording\": 1"));
    folder.write("steps.json", changed(&recording, "\"steps\": 10", "\"steps\": -10"));
    folder.write("altered.json", changed(&recording, "20 kPa", "21 kPa"));
    folder.write(
        "commands.json",
        changed(
            &recording,
            "\"commands\": []",
            "\"commands\": [{\"period\": 1, \"edit\": {\"kind\": \"fly\", \"system\": 0}}]",
        ),
    );
    folder.write("force.json", changed(&recording, "\"commands\": []", "\"commands\": [{\"period\": 1, \"edit\": {\"kind\": \"set_parameter\", \"system\": 0, \"force\": \"no\", \"parameter\": \"k\", \"value\": 1}}]"));
    folder.write(
        "system.json",
        changed(
            &recording,
            "\"commands\": []",
            "\"commands\": [{\"period\": 1, \"edit\": {\"kind\": \"pin\", \"system\": 7, \"block\": 0}}]",
        ),
    );
    folder.write("block.json", changed(&recording, "\"commands\": []", "\"commands\": [{\"period\": 1, \"edit\": {\"kind\": \"pin\", \"system\": 0, \"block\": 4000000000}}]"));
    let resume = |file: &'static str| ["run", "cube.toml", "--resume", file, "--out", "out"];
    let cases: &[(&[&str], i32, &str)] = &[
        (&["run", "cube.toml", "--out", "out", "--steps", "-1"], 2, "--steps"),
        (&["run", "cube.toml", "--out", "out", "--steps", "1.5"], 2, "--steps"),
        (&["run", "cube.toml", "--out", "out", "--steps", "99999999999999999999"], 2, "--steps"),
        (&["run", "cube.toml", "--out", "out", "--steps", "1", "--duration", "1 s"], 2, "--duration"),
        (&["run", "cube.toml", "--out", "out", "--duration", "-1"], 2, "a time above 0"),
        (&["run", "cube.toml", "--out", "out", "--duration", "0"], 2, "a time above 0"),
        (&["run", "cube.toml", "--out", "out", "--duration", "nan"], 2, "a time above 0"),
        (&["run", "cube.toml", "--out", "out", "--duration", "5 kg"], 2, "kg"),
        (&["run", "cube.toml", "--out", "out", "--duration", "1e300"], 2, "at most 1e12"),
        (&["run", "cube.toml", "--out", "out", "--duration", "4 ms"], 2, "no step would be made"),
        (&["run", "cube.toml", "--out", "out", "--threads", "0"], 2, "1 to 1024"),
        (&["run", "cube.toml", "--out", "out", "--threads", "100000"], 2, "1 to 1024"),
        (&["run", "cube.toml", "--out", "out", "--frames", "-1"], 2, "--frames"),
        (&["run", "cube.toml", "--out", "out", "--hash-every", "0"], 2, "--hash-every"),
        (&["run", "cube.toml", "--out", "out", "--snapshot-every", "0"], 2, "--snapshot-every"),
        (&["run", "cube.toml", "--snapshot-every", "1"], 2, "--out"),
        (&["run", "cube.toml", "--out", "out", "--seed", "-1"], 2, "--seed"),
        (
            &["run", "cube.toml", "--out", "out", "--set", "bodies.cube.materal.density=1"],
            2,
            "did you mean `material`",
        ),
        (&["run", "cube.toml", "--out", "out", "--set", "bodies.cube.material.density"], 2, "--set"),
        (&["run", "cube.toml", "--out", "out", "--set", "world.period=abc"], 2, "world.period"),
        (&["run", "cube.toml", "--out", "out", "--set", "world.period=-1"], 2, "world.period"),
        (&["run", "cube.toml", "other.toml"], 2, "other.toml"),
        (&["run", "cube.toml", "--out", "file"], 2, "file"),
        (&["run", "cube.toml", "--out", "file/below"], 1, "file/below"),
        (&["run", "cube.toml", "--quiet", "--record", "nowhere/run.json"], 1, "nowhere/run.json"),
        (&["run", "cube.toml", "--quiet", "--record", "made"], 1, "made"),
        (&["run", "cube.toml", "--quiet", "--record", "file/run.json"], 1, "file/run.json"),
        (&resume("nowhere.souple"), 2, "nowhere.souple"),
        (&resume("garbage.souple"), 2, "garbage.souple"),
        (&resume("empty.souple"), 2, "no line that names its scene"),
        (&resume("header.souple"), 2, "of another scene"),
        (&resume("old.souple"), 2, "no line that names its scene"),
        (&resume("cut_header.souple"), 2, "cut_header.souple"),
        (&resume("cut_line.souple"), 2, "cut_line.souple"),
        (&resume("cut_half.souple"), 2, "cut_half.souple"),
        (&resume("cut_end.souple"), 2, "cut_end.souple"),
        (&resume("longer.souple"), 2, "longer.souple"),
        (&resume("made"), 2, "made"),
        (
            &["run", "other.toml", "--out", "out", "--resume", "made/snapshot_00000005.souple"],
            2,
            "of another scene",
        ),
        (
            &[
                "run",
                "cube.toml",
                "--out",
                "out",
                "--set",
                "world.period=5 ms",
                "--resume",
                "made/snapshot_00000005.souple",
            ],
            2,
            "of another scene",
        ),
        (&["replay", "nowhere.json", "--out", "out"], 2, "nowhere.json"),
        (&["replay", "garbage.json", "--out", "out"], 2, "garbage.json"),
        (&["replay", "no.json", "--out", "out"], 2, "souple_recording"),
        (&["replay", "cut.json", "--out", "out"], 2, "cut.json"),
        (&["replay", "version.json", "--out", "out"], 2, "it is of version 1, this program plays version 3"),
        (&["replay", "steps.json", "--out", "out"], 2, "`steps`"),
        (&["replay", "altered.json", "--out", "out"], 2, "the recording was changed"),
        (&["replay", "commands.json", "--out", "out"], 2, "fly"),
        (&["replay", "cube.toml", "--out", "out"], 2, "cube.toml"),
        (&["compare", "garbage.souple", "garbage.souple"], 2, "garbage.souple"),
        (&["compare", "made/snapshot_00000005.souple", "cut_half.souple"], 2, "cut_half.souple"),
        (&["compare", "cube.toml", "cube.toml"], 2, "cube.toml"),
        (&["compare", "made", "made"], 2, "made"),
        (&["mesh", "generate", "box", "out.msh", "size=1,1", "cells=1,1,1"], 2, "size"),
        (&["mesh", "generate", "box", "out.msh", "size=1,1,1", "cells=0,1,1"], 2, "cells"),
        (&["mesh", "generate", "box", "out.msh", "size=1,1,1", "cells=1e9,1e9,1e9"], 2, "cells"),
        (&["mesh", "generate", "box", "out.msh", "size=1,1,1", "cells=1,1,1", "colour=red"], 2, "colour"),
        (&["mesh", "generate", "box", "out.msh", "size=1,1,1", "cells=1,1,1", "element"], 2, "`=`"),
        (&["mesh", "generate", "box", "out.xyz", "size=1,1,1", "cells=1,1,1"], 2, "xyz"),
        (&["mesh", "generate", "box", "out", "size=1,1,1", "cells=1,1,1"], 2, "out"),
        (&["mesh", "generate", "box", "nowhere/out.msh", "size=1,1,1", "cells=1,1,1"], 1, "nowhere/out.msh"),
        (&["mesh", "convert", "cube.toml", "out.msh"], 2, "cube.toml"),
        (&["list", "rubber"], 2, "materials"),
        (&["describe", "nothing_like_it"], 2, "nothing_like_it"),
    ];
    let faults: Vec<Fault> = cases
        .iter()
        .map(|(arguments, status, words)| {
            let name = arguments.last().copied().unwrap_or_default();
            Fault { name, arguments, status: *status, words }
        })
        .collect();
    assert_refused(&folder, &faults);
    // commands that name what the scene does not have are met on the way: the report tells of the run up to them
    for file in ["force.json", "system.json", "block.json"] {
        let answer = souple_in(folder.path(), ["replay", file, "--quiet", "--json"]).ends(1);
        let report = answer.json();
        assert_eq!((&report["status"], &report["steps"]), (&"failed".into(), &1.into()), "{file}");
        assert!(report["error"]["message"].to_string().contains("before period 1"), "{file}: {report:#}");
    }
}

/// A snapshot with any byte changed is refused: none of its numbers may be taken for another.
#[test]
fn damaged_snapshots_are_refused() {
    let folder = Folder::new("damaged");
    let scene = folder.write("cube.toml", CUBE);
    souple(["run", &scene, "--quiet", "--out", &folder.at("out"), "--snapshot-every", "5", "--frames", "0"])
        .ends(0);
    let snapshot = std::fs::read(folder.path().join("out/snapshot_00000005.souple")).expect("a snapshot");
    let header = snapshot.iter().position(|byte| *byte == b'\n').expect("a header") + 1;
    let beginning = header..(header + 200).min(snapshot.len());
    for at in beginning.step_by(3).chain((header + 200..snapshot.len()).step_by(97)) {
        for flip in [0xff, 0x01] {
            let mut damaged = snapshot.clone();
            damaged[at] ^= flip;
            let damaged = folder.write("damaged.souple", damaged);
            let answer = souple(["run", &scene, "--quiet", "--steps", "2", "--resume", &damaged]);
            let is_refused = answer.status == Some(2) && !answer.stderr.contains("panicked");
            assert!(is_refused && answer.stderr.contains("damaged.souple"), "byte {at}: {answer:#?}");
        }
    }
}

/// A recording with any byte changed is refused, replayed or found to differ, never a panic.
#[test]
fn damaged_recordings_do_not_panic() {
    let folder = Folder::new("damaged_recordings");
    folder.write("cube.toml", CUBE);
    souple_in(folder.path(), ["run", "cube.toml", "--quiet", "--record", "run.json"]).ends(0);
    let recording = std::fs::read(folder.path().join("run.json")).expect("a recording");
    for at in (0..recording.len()).step_by(5) {
        for byte in [b'"', b'}', 0xff] {
            let mut damaged = recording.clone();
            damaged[at] = byte;
            folder.write("damaged.json", damaged);
            let answer = souple_in(folder.path(), ["replay", "damaged.json", "--quiet", "--verify"]);
            assert!(
                matches!(answer.status, Some(0..=2)) && !answer.stderr.contains("panicked"),
                "{at}: {answer:#?}"
            );
        }
    }
}

/// Motion that leaves the range of numbers ends the work with status 1, names the system, and leaves a whole report
/// of the state before.
#[test]
fn overflow_is_refused() {
    let folder = Folder::new("overflow");
    folder.write("cube.toml", CUBE);
    // a duration that is written says how long periods may be
    let without = "run.duration=";
    for setting in
        ["world.gravity=[0, -1e308, 0]", "bodies.cube.velocity=[1e308, 0, 0]", "world.period=1e160"]
    {
        let run = [
            "run",
            "cube.toml",
            "--json",
            "--out",
            "out",
            "--steps",
            "5",
            "--set",
            without,
            "--set",
            setting,
        ];
        let answer = souple_in(folder.path(), run).ends(1);
        assert!(answer.stderr.contains("system `main`"), "{setting}: {answer:#?}");
        let document = answer.json();
        assert_eq!((&document["status"], &document["steps"]), (&"failed".into(), &0.into()), "{setting}");
        let report = std::fs::read_to_string(folder.path().join("out/report.json")).expect("a report");
        assert_eq!(serde_json::from_str::<serde_json::Value>(&report).expect("JSON"), document, "{setting}");
        assert!(!folder.files().iter().any(|file| file.ends_with(".part")), "{setting}");
    }
    for (setting, words) in [
        ("bodies.cube.mesh.size=[1e-200, 1e-200, 1e-200]", "flat"),
        ("bodies.cube.translate=[1e300, 0, 0]", "lost in the rounding"),
        ("bodies.cube.material.youngs_modulus=1e305", "is the unit right?"),
        ("bodies.cube.material.density=1e305", "is the unit right?"),
        ("world.period=1e160", "at most twice the `duration`"),
    ] {
        let answer = souple_in(folder.path(), ["run", "cube.toml", "--set", setting]).ends(2);
        assert!(answer.stderr.contains(words), "{setting}: {answer:#?}");
    }
}

/// Runs the program by a shell that allows files of at most this many blocks of 512 or 1024 bytes: what a disk
/// does that is full.
#[cfg(target_os = "linux")]
fn with_small_files(folder: &Folder, blocks: u32, arguments: &str) -> Answer {
    // the signal is ignored, so that writes fail with an error as they do on a full disk
    let script =
        format!("trap '' XFSZ; ulimit -f {blocks}; exec {} {arguments}", env!("CARGO_BIN_EXE_souple"));
    let output = std::process::Command::new("sh").args(["-c", &script]).current_dir(folder.path()).output();
    Answer::of(script, output.expect("a shell"))
}

/// A disk that is full ends the work with status 1, names the file, and leaves no half of it.
#[cfg(target_os = "linux")]
#[test]
fn full_disks_are_told() {
    let folder = Folder::new("full");
    folder.write("cube.toml", changed(CUBE, "cells = [2, 2, 2]", "cells = [6, 6, 6]"));
    let before = folder.files();
    let answer = with_small_files(&folder, 1, "run cube.toml --quiet --frames 2 --out out").ends(1);
    assert!(answer.stderr.contains("out/"), "{answer:#?}");
    let left: Vec<String> = folder.files().into_iter().filter(|file| !before.contains(file)).collect();
    assert!(!left.iter().any(|file| file.ends_with(".part") || file.ends_with(".vtu")), "{left:?}");
    let answer = with_small_files(&folder, 1, "mesh generate box out.msh size=1,1,1 cells=9,9,9").ends(1);
    assert!(answer.stderr.contains("out.msh"), "{answer:#?}");
    let answer =
        with_small_files(&folder, 1, "run cube.toml --quiet --hash-every 1 --record run.json").ends(1);
    assert!(answer.stderr.contains("run.json"), "{answer:#?}");
    let left = folder.files();
    assert!(!left.iter().any(|file| file.contains("out.msh") || file.contains("run.json")), "{left:?}");
    // all but the picture fits: what was written before is whole, and what was not is not there
    let answer = with_small_files(&folder, 40, "run cube.toml --quiet --frames 0 --out most");
    assert!(matches!(answer.status, Some(0 | 1)), "{answer:#?}");
    assert!(!folder.files().iter().any(|file| file.ends_with(".part")));
}

/// A file that is no regular file is written as it is, not replaced: `/dev/full` is full, `/dev/null` takes all.
#[cfg(target_os = "linux")]
#[test]
fn devices_are_written_not_replaced() {
    let folder = Folder::new("devices");
    folder.write("cube.toml", CUBE);
    // by a link, so that a program that replaces what it is given harms no device of this machine
    let (full, null) = (folder.path().join("full.json"), folder.path().join("null.json"));
    std::os::unix::fs::symlink("/dev/full", &full).expect("a link");
    std::os::unix::fs::symlink("/dev/null", &null).expect("a link");
    let answer = souple_in(folder.path(), ["run", "cube.toml", "--quiet", "--record", "full.json"]).ends(1);
    assert!(answer.stderr.contains("full.json"), "{answer:#?}");
    souple_in(folder.path(), ["run", "cube.toml", "--quiet", "--record", "null.json"]).ends(0);
    for link in [full, null] {
        assert!(std::fs::symlink_metadata(link).expect("the link").is_symlink());
    }
}
