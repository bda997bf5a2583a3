//! The smaller commands: meshes, lists, comparisons.

use serde_json::Value;

use crate::common::{self, CUBE, Folder, souple, souple_in};

fn names(kind: &str) -> Vec<String> {
    let list = souple(["list", kind, "--json"]).ends(0).json();
    let entries = list.as_array().expect("a list").iter();
    entries.map(|entry| entry["name"].as_str().expect("a name").to_owned()).collect()
}

/// What is listed can be written in a scene: every stepper, solver, preconditioner and material of the tables.
#[test]
fn listed_names_are_accepted() {
    let folder = Folder::new("listed");
    let scene = folder.write("cube.toml", CUBE);
    for (kind, key) in [
        ("steppers", "systems.main.stepper"),
        ("solvers", "systems.main.solver"),
        ("preconditioners", "systems.main.preconditioner"),
        ("materials", "bodies.cube.material.name"),
        ("elements", "bodies.cube.mesh.element"),
    ] {
        // boxes are filled with volumes
        let flat = ["edge2", "edge3", "tri3", "tri6", "quad4", "quad8", "quad9"];
        for name in names(kind).iter().filter(|name| !flat.contains(&name.as_str())) {
            // `static` refuses bodies that are not held, by its own words
            let answer = souple(["check", &scene, "--set", &format!("{key}={name}")]);
            let is_refused = answer.stderr.contains("unknown") || answer.stderr.contains("there is no");
            assert!(!is_refused, "{kind} {name}: {answer:#?}");
        }
    }
    for quantity in names("quantities") {
        let answer = souple(["check", &scene, "--set", &format!("probes.place.quantity={quantity}")]);
        assert!(!answer.stderr.contains("there is no choice"), "{quantity}: {answer:#?}");
    }
}

/// What is listed as function or unit can be used.
#[test]
fn listed_functions_and_units_work() {
    let functions = names("functions");
    assert!(functions.contains(&"smoothstep".to_owned()) && functions.contains(&"pi".to_owned()));
    for unit in names("units") {
        assert!(souple::formal::parse_unit(&unit).is_ok(), "{unit}");
    }
    assert!(souple(["list", "units"]).ends(0).stdout.contains("Pa"));
    souple(["describe", "smoothstep"]).ends(0);
}

/// Lengths with units, as in scenes; a wrong unit is told.
#[test]
fn meshes_are_generated_with_units() {
    let folder = Folder::new("units");
    let make = |size: &str| {
        souple(["mesh", "generate", "box", &folder.at("box.msh"), size, "cells=2,2,2", "--json"])
    };
    let volume = |size: &str| make(size).ends(0).json()["volume"].as_f64().expect("a volume");
    for size in ["size=1,0.1,0.2", "size=100cm,10 cm,200 mm", "size=[1, 0.1, 20 cm]"] {
        assert!((volume(size) - 0.02).abs() < 1e-15, "{size}");
    }
    let answer = make("size=1 kg,1,1").ends(2);
    assert!(answer.stderr.contains("kg"), "{answer:#?}");
}

/// Surfaces have a quality too: closed or not, with the worst triangle.
#[test]
fn surfaces_are_measured() {
    let folder = Folder::new("surfaces");
    let corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
    let closed = folder.write("closed.obj", format!("{corners}f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"));
    let measured = souple(["mesh", "quality", &closed, "--json"]).ends(0).json();
    assert_eq!((&measured["closed"], &measured["triangles"]), (&true.into(), &4.into()));
    let number = |key: &str| measured[key].as_f64().unwrap_or(f64::NAN);
    assert!((number("enclosed_volume") - 1.0 / 6.0).abs() < 1e-15, "{measured:#}");
    assert!((number("smallest_angle_degrees") - 45.0).abs() < 1e-12, "{measured:#}");
    let open = folder.write("open.obj", format!("{corners}f 1 3 2\nf 1 2 4\nf 1 4 3\n"));
    let measured = souple(["mesh", "quality", &open, "--json"]).ends(0).json();
    assert_eq!((&measured["closed"], &measured["enclosed_volume"]), (&false.into(), &Value::Null));
    assert!(measured["problem"].is_string());
}

/// A conversion tells what the written file holds, and what was lost.
#[test]
fn conversions_count_what_was_written() {
    let folder = Folder::new("conversions");
    let (mesh, surface) = (folder.at("box.msh"), folder.at("box.stl"));
    souple(["mesh", "generate", "box", &mesh, "size=1,1,1", "cells=1,1,1", "element=hex8"]).ends(0);
    let told = souple(["mesh", "convert", &mesh, &surface, "--json"]).ends(0).json();
    let again = souple(["mesh", "convert", &surface, &folder.at("again.stl"), "--json"]).ends(0).json();
    assert_eq!((&told["cells"], &told["facets"]), (&again["cells"], &again["facets"]));
    assert!(told["notes"].to_string().contains("does not keep 1 cells"), "{told:#}");
    // glTF is only written: the boundary of what was read is told, which it holds
    let told = souple(["mesh", "convert", &mesh, &folder.at("box.glb"), "--json"]).ends(0).json();
    assert_eq!((&told["facets"], &told["closed"]), (&12.into(), &true.into()), "{told:#}");
}

/// A format that shares its extension is written by its name; one of another extension is refused.
#[test]
fn conversions_take_a_format() {
    let folder = Folder::new("formats");
    let convert = |to: &str, format: &str| {
        souple_in(folder.path(), ["mesh", "convert", "bar.msh", to, "--format", format, "--json"])
    };
    souple_in(folder.path(), ["mesh", "generate", "bar", "bar.msh", "size=1,1,1", "cells=2,1,1"]).ends(0);
    for (file, format, start) in [
        ("binary.msh", "gmsh_binary", &b"$MeshFormat\n4.1 1 8"[..]),
        ("text.ply", "ply_text", b"ply\nformat ascii"),
        ("text.stl", "stl_text", b"solid"),
    ] {
        convert(file, format).ends(0);
        let written = std::fs::read(folder.path().join(file)).expect("the mesh just written");
        assert!(written.starts_with(start), "{format}");
    }
    let refused = convert("bar.obj", "vtu").ends(2);
    assert!(refused.stderr.contains("`obj`; expected vtu for the format `vtu`"), "{}", refused.stderr);
    assert!(convert("other.msh", "gmsh_7").ends(2).stderr.contains("gmsh_2"));
}

/// What cannot be filled is refused by its cause, and a size that is none is named.
#[test]
fn fillings_that_cannot_be() {
    let folder = Folder::new("fillings");
    let plate: Vec<String> =
        ["0 0 0", "1 0 0", "1 1 0", "0 1 0", "0 0 1e-3", "1 0 1e-3", "1 1 1e-3", "0 1 1e-3"]
            .iter()
            .map(|point| format!("v {point}\n"))
            .chain(
                ["1 4 3 2", "5 6 7 8", "1 2 6 5", "2 3 7 6", "3 4 8 7", "4 1 5 8"]
                    .iter()
                    .map(|f| format!("f {f}\n")),
            )
            .collect();
    folder.write("plate.obj", plate.concat());
    folder.write("sheet.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    let lid = plate.concat().replace("f 5 6 7 8\n", "").replace("1e-3", "1");
    folder.write("open.obj", lid);
    for (input, parameters, words) in [
        ("plate.obj", &["count=1000"][..], "1000 cells cannot be had"),
        ("sheet.obj", &["size=0.1"], "the surface is flat"),
        ("torus", &["count=0"], "`size` is missing or 0, and so is `count`"),
        ("torus", &["size=0.05", "growth=1e9"], "growth"),
        ("torus", &["size=0.05", "size_inside=0"], "the size of cells is 0 m at"),
        ("torus", &["size=0.05", "size_inside=1", "size_everywhere=1"], "expected one of them"),
        (
            "formula",
            &["formula=1", "low=-1,-1,-1", "high=1,1,1", "size=0.2"],
            "its least value there is 1, and inside it is below 0",
        ),
    ] {
        let call = ["mesh", "fill", input, "out.msh"].into_iter().chain(parameters.iter().copied());
        let refused = souple_in(folder.path(), call).ends(2);
        assert!(refused.stderr.contains(words), "{input} {parameters:?}: {}", refused.stderr);
    }
    // a box without its lid has most of an inside: it is filled, and what is not certain is said
    let open = souple_in(folder.path(), ["mesh", "fill", "open.obj", "out.msh", "size=0.1"]).ends(0);
    assert!(open.stdout.contains("the inside is not certain"), "{}", open.stdout);
}

/// A surface is mended, what was done is counted and said, and what is left; what is no surface, and parameters out of range, are
/// refused.
#[test]
fn surfaces_are_mended() {
    let folder = Folder::new("mended");
    let points = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n";
    let sides = "f 1 4 3 2\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
    // a lid, its copy turned over, a side turned over
    let broken =
        format!("{points}g lid\nf 5 8 7 6\nf 5 6 7 8\ng sides\n{}", sides.replace("1 2 6 5", "1 5 6 2"));
    folder.write("broken.obj", broken);
    folder.write("open.obj", format!("{points}{sides}"));
    folder.write("whole.obj", format!("{points}g sides\n{sides}g lid\nf 5 6 7 8\n"));
    let mend = |from: &str, to: &str, more: &[&str]| {
        let call = ["mesh", "repair", from, to].into_iter().chain(more.iter().copied());
        souple_in(folder.path(), call)
    };
    let answer = mend("broken.obj", "out.ply", &["scale=2", "--json"]).ends(0).json();
    // of the lid the copy comes first
    let (volume, repairs) =
        (answer["enclosed_volume"].as_f64().expect("a closed surface"), &answer["repairs"]);
    assert!((volume - 8.0).abs() < 1e-12 && answer["closed"] == true, "{answer:#}");
    assert_eq!((&repairs["doubled_triangles"], &repairs["turned_triangles"]), (&2.into(), &4.into()));
    let said = mend("broken.obj", "out.ply", &[]).ends(0).stdout;
    for words in
        ["  mended   2 triangles were dropped: others have the same corners", "without the groups lid, sides"]
    {
        assert!(said.contains(words), "{said}");
    }
    // what is in order stays as it is, with its quadrilaterals and its groups
    let said = mend("whole.obj", "out.obj", &["scale=2"]).ends(0).stdout;
    for words in ["there was nothing to mend", "6 facets", "groups   lid, sides", "encloses 8 m³"] {
        assert!(said.contains(words), "{said}");
    }
    // four open edges, of a hole that measures most of the box
    let open = mend("open.obj", "out.obj", &["--json"]).ends(0).json();
    assert_eq!((&open["closed"], &open["faults"]["open_edges"]), (&false.into(), &4.into()));
    let left = &open["repairs"]["left"];
    let size = left["largest_hole"].as_f64().expect("a size");
    assert!(left["holes"] == 1 && (size - (2.0_f64 / 3.0).sqrt()).abs() < 1e-15, "{left:#}");
    let said = mend("open.obj", "out.obj", &[]).ends(0).stdout;
    for line in [
        "  fault    4 edges have one triangle only",
        "  left     1 hole is left: 0.8165 of the surface's diagonal",
        "  note     nothing was mended",
    ] {
        assert!(said.contains(line), "{said}");
    }
    let closed = mend("open.obj", "out.obj", &["hole=1", "--json"]).ends(0).json();
    assert_eq!((&closed["closed"], &closed["repairs"]["closed_holes"]), (&true.into(), &1.into()));

    souple_in(folder.path(), ["mesh", "generate", "bar", "bar.msh", "size=1,1,1", "cells=2,1,1"]).ends(0);
    folder.write("line.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 4 0 0\nf 1 2 3\nf 2 3 4\nf 1 3 4\n");
    folder.write("huge.obj", "v 0 0 0\nv 1e200 0 0\nv 0 1e200 0\nf 1 2 3\n");
    folder.write("tiny.obj", "v 0 0 0\nv 1e-200 0 0\nv 0 1e-200 0\nf 1 2 3\n");
    for (from, to, more, words) in [
        ("bar.msh", "new.obj", &[][..], "`bar.msh` holds cells"),
        ("line.obj", "new.obj", &[], "none of its triangles has an area"),
        ("huge.obj", "new.obj", &[], "1e200 m long"),
        ("tiny.obj", "new.obj", &[], "1e-200 m long"),
        ("open.obj", "new.obj", &["scale=1e-320"], "e-320 m long"),
        ("open.obj", "new.obj", &["hole=2"], "between 0 and 1"),
        ("open.obj", "new.obj", &["holes=1"], "did you mean `hole`?"),
        ("open.obj", "open.obj", &[], "would be lost"),
        ("open.obj", "new.xyz", &[], "xyz"),
    ] {
        let refused = mend(from, to, more).ends(2);
        assert!(refused.stderr.contains(words), "{from} {more:?}: {}", refused.stderr);
    }
    assert!(!folder.path().join("new.obj").exists());
}

/// What is accepted is said once, in a line of its own or in the message.
#[test]
fn refusals_say_once_what_is_expected() {
    let folder = Folder::new("once");
    folder.write("flat.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    for (call, words) in [
        (&["torus", "out.msh", "size=5kg"][..], "a length [m] is wanted"),
        (&["torus", "out.msh", "size=5kg"], "expected a number of at least 0 [m]"),
        (&["torus", "out.msh"], "expected one of them above 0"),
        (&["torus", "out.msh", "count=1e12"], "must be a whole number between 0 and 50000000"),
        (&["flat.obj", "out.msh", "size=0.1"], "it measures 1 x 1 x 0 m"),
        (&["flat.obj", "out.msh", "size=0.1"], "expected one that encloses something"),
        (&["torus", "out.msh", "size=1e-7"], "cells of 1e-7 m in a box of"),
    ] {
        let refused =
            souple_in(folder.path(), ["mesh", "fill"].into_iter().chain(call.iter().copied())).ends(2);
        assert!(refused.stderr.contains(words), "{call:?}: {}", refused.stderr);
        assert!(refused.stderr.matches("expected").count() <= 1, "{call:?}: {}", refused.stderr);
    }
}

/// A study is run into its database, table and graphs; what it asks for in vain is named.
#[test]
fn studies_are_swept() {
    let folder = Folder::new("study");
    let scene = common::scenes().join("block_on_springs");
    let study = format!(
        "scene = {:?}\nsteps = 5\n[vary]\n\"world.period\" = [\"10 ms\", \"5 ms\"]\n[graphs.place]\nx = \"world.period\"\ny = \"place.x\"\n",
        scene.display().to_string()
    );
    folder.write("study.toml", &study);
    let answer = souple_in(folder.path(), ["sweep", "study.toml", "--json", "--jobs", "1"]).ends(0).json();
    assert_eq!((&answer["made"], &answer["held"]), (&2.into(), &0.into()));
    assert_eq!(
        folder.files(),
        ["study.csv", "study.place.png", "study.place.svg", "study.sqlite", "study.toml"]
    );
    let again = souple_in(folder.path(), ["sweep", "study.toml", "--json"]).ends(0).json();
    assert_eq!((&again["made"], &again["held"], &again["table"]), (&0.into(), &2.into(), &answer["table"]));
    folder.write("wrong.toml", study.replace("place.x", "nowhere"));
    let wrong = souple_in(folder.path(), ["sweep", "wrong.toml"]).ends(2);
    assert!(
        wrong.stderr.contains("`graphs.place.y` is `nowhere`; expected one of world.period, place.x"),
        "{}",
        wrong.stderr
    );
}

/// A fit writes the curve it found, again over its own, and over nothing else; a curve that is not there is told as one.
#[test]
fn fits_write_over_their_own_alone() {
    let folder = Folder::new("fit_out");
    let study = common::scenes().join("rheometer/identify.toml");
    let sweep =
        |out: &str| souple(["sweep", &study.display().to_string(), "--quiet", "--out", &folder.at(out)]);
    sweep("found.csv").ends(0);
    sweep("found.csv").ends(0);
    for (name, text) in [
        ("notes.txt", "do not lose, this, text\n"),
        ("study.sqlite", "SQLite format 3\0\x10"),
        ("mine.csv", "day,measured,by whom\n1,2,3\n"),
    ] {
        folder.write(name, text);
        let refused = sweep(name).ends(2);
        assert!(refused.stderr.contains("expected a new file in `--out`"), "{}", refused.stderr);
        assert_eq!(std::fs::read_to_string(folder.at(name)).unwrap(), text);
    }
    let scene = common::scenes().join("rheometer").display().to_string();
    let missing = format!(
        "scene = {scene:?}\n[fit]\nprobe = \"pull.x\"\ncurve = \"nope.csv\"\n[fit.values]\na = {{ start = 1, min = 0, max = 2 }}\n"
    );
    folder.write("missing.toml", missing);
    let refused = souple_in(folder.path(), ["sweep", "missing.toml"]).ends(2);
    assert!(refused.stderr.contains("`fit.curve` is nope.csv: "), "{}", refused.stderr);
}

/// Without a tolerance a comparison tells; with one it judges.
#[test]
fn comparisons_judge_by_a_tolerance() {
    let folder = Folder::new("tolerance");
    let scene = folder.write("cube.toml", CUBE);
    souple(["run", &scene, "--quiet", "--frames", "1", "--out", &folder.at("out")]).ends(0);
    let (first, last) = (folder.at("out/frames/cube_0000.vtu"), folder.at("out/frames/cube_0001.vtu"));
    souple(["compare", &first, &last]).ends(0);
    souple(["compare", &last, &last, "--tolerance", "0"]).ends(0);
    let answer = souple(["compare", &first, &last, "--tolerance", "1e-6", "--json"]).ends(1);
    let rows = answer.json();
    let row =
        rows.as_array().expect("rows").iter().find(|row| row["field"] == "positions").expect("positions");
    assert_eq!(row["within_tolerance"], false);
    assert!(answer.stderr.contains("differ by more than 1e-6 in positions"), "{answer:#?}");
    souple(["compare", &first, &last, "--tolerance", "-1"]).ends(2);
}

/// The page of the command line names every command, every option of `run`, `replay` and `compare`, every kind of list
/// and every key of the report.
#[test]
fn the_page_of_the_command_line_is_complete() {
    let page = include_str!("../../../docs/command-line.md");
    let mut missing = Vec::new();
    let mut want = |word: String| {
        if !page.contains(&word) {
            missing.push(word);
        }
    };
    let help = souple(["--help"]).ends(0).stdout;
    let (_, commands) = help.split_once("Commands:").expect("a list of commands");
    for line in commands.lines().skip(1).take_while(|line| !line.trim().is_empty()) {
        want(format!("`{}", line.split_whitespace().next().unwrap_or_default()));
    }
    for command in ["run", "replay", "compare", "modes"] {
        let help = souple([command, "--help"]).ends(0).stdout;
        let options = help.split_whitespace().filter(|word| word.starts_with("--"));
        let options = options.map(|word| word.trim_matches(|c: char| !c.is_alphanumeric() && c != '-'));
        options.filter(|option| *option != "--help").for_each(|option| want(option.to_owned()));
    }
    let kinds = souple(["list", "nothing", "--json"]).ends(2).json();
    let kinds = kinds["errors"][0]["expected"].as_str().expect("kinds").replace("one of ", "");
    kinds.split(", ").for_each(|kind| want(format!("`{kind}`")));
    common::REPORT_KEYS.iter().for_each(|key| want(format!("`{key}`")));
    assert!(missing.is_empty(), "docs/command-line.md does not name {missing:?}");
}

/// The surface of particles says which it leaves out, and shows those that are there at the time asked for.
#[test]
fn particles_are_dressed_and_what_is_left_out_is_said() {
    let folder = Folder::new("dressed");
    let dress = |table: &str, more: &[&str]| {
        let input = folder.write("particles.csv", table);
        let out = folder.at("skin.ply");
        let mut call = vec!["mesh", "skin", &input, &out, "--json"];
        call.extend(more);
        souple(call)
    };
    let notes = |table: &str, more: &[&str]| dress(table, more).ends(0).json()["notes"].to_string();
    let pair = "x,y,z,radius\n0,0,0,0.01\n0.02,0,0,0.02\n";
    assert!(notes(pair, &[]).contains("1 of 2 particles are outside"));
    assert_eq!(notes(pair, &["iso=0.25"]), "[]");
    let row: String = (0..8).map(|i| format!("{},0,0\n", 0.01 * f64::from(i))).collect();
    let row = format!("x,y,z\n{row}");
    assert!(notes(&row, &["radius=0.008", "voxel=0.02"]).contains("larger than 2 radii"));
    let refusal = |table: &str, more: &[&str]| dress(table, more).ends(2).json()["errors"].to_string();
    assert!(refusal(&row, &[]).contains("`radius` is missing"));
    let alone = refusal("x,y,z\n0,0,0\n", &["radius=0.01"]);
    assert!(alone.contains("0.318 at most") && alone.contains("an `iso` below 0.318"));
    // two that are there one after the other, and the second moves
    let two = "x,y,z,radius,vx,from,until\n0,0,0,0.01,0,-inf,1\n0,0,0,0.01,1,1,inf\n";
    let middle = |time: &str| {
        let document = dress(two, &["iso=0.2", time]).ends(0).json();
        let bounds = |corner: usize| document["bounds"][corner][0].as_f64().expect("a number");
        0.5 * (bounds(0) + bounds(1))
    };
    assert!(middle("time=0").abs() < 1e-3 && (middle("time=2") - 2.0).abs() < 1e-3);
}
