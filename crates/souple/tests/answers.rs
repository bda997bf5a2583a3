//! What is answered where the work itself goes wrong: full disks, folders that are taken, runs that blow up, surfaces that
//! enclose nothing.

use crate::common::{CUBE, Folder, souple, souple_in};

/// What a run came to is told, though the disk is too full to record it.
#[cfg(target_os = "linux")]
#[test]
fn full_disks_do_not_silence_a_run() {
    let folder = Folder::new("full");
    let scene = folder.write("cube.toml", CUBE);
    let told = souple(["run", &scene, "--record", "/dev/full"]).ends(1);
    assert!(told.stdout.starts_with("failed: 10 steps, 0.1000 s simulated"), "{told:#?}");
    assert!(told.stdout.contains("place = ["), "{told:#?}");
    assert!(
        told.stderr.contains("the recording is lost") && told.stderr.contains("disk is full"),
        "{told:#?}"
    );
    let report = souple(["run", &scene, "--record", "/dev/full", "--json", "--quiet"]).ends(1).json();
    assert_eq!((report["status"].as_str(), report["steps"].as_u64()), (Some("failed"), Some(10)));
    assert!(report["error"]["message"].to_string().contains("disk is full"), "{report:#}");
    // the words of a picture are those of any file
    souple(["run", &scene, "--quiet", "--out", &folder.at("run")]).ends(0);
    for name in ["full.png", "full.gif", "full.apng"] {
        std::os::unix::fs::symlink("/dev/full", folder.path().join(name)).expect("a link");
        let arguments = ["render", "run", "--out", name, "--quiet", "--size", "64,64"];
        let told = souple_in(folder.path(), arguments).ends(1);
        assert!(told.stderr.contains("the disk is full"), "{told:#?}");
    }
}

/// A trace that cannot be written is refused before the run; one that is lost for all that takes nothing from what the run came to, and a run
/// that fails leaves its trace.
#[cfg(target_os = "linux")]
#[test]
fn lost_traces_are_told() {
    let folder = Folder::new("traces");
    let scene = folder.write("cube.toml", CUBE);
    let trace = folder.at("missing/trace.json");
    let errors = souple(["run", &scene, "--trace", &trace, "--json"]).ends(2).json();
    let error = &errors["errors"][0];
    assert_eq!((error["code"].as_str(), error["value"].as_str()), (Some("trace"), Some(trace.as_str())));
    let lost = souple(["run", &scene, "--trace", "/dev/full", "--json", "--quiet"]).ends(1);
    let report = lost.json();
    assert_eq!((report["status"].as_str(), report["steps"].as_u64()), (Some("done"), Some(10)));
    assert!(report["errors"][0]["message"].to_string().contains("the trace is lost"), "{report:#}");
    assert!(lost.stderr.contains("the trace is lost"), "{lost:#?}");
    let kept = folder.at("trace.json");
    souple(["run", &scene, "--trace", &kept, "--record", "/dev/full", "--quiet"]).ends(1);
    let text = std::fs::read_to_string(&kept).expect("a trace");
    let document: serde_json::Value = serde_json::from_str(&text).expect("a document");
    let events = document["traceEvents"].as_array().expect("events");
    assert_eq!(events.iter().filter(|event| event["name"] == "step").count(), 10);
}

/// A folder that a run cannot have is refused in one sentence, which does not ask for what it refuses.
#[test]
fn folders_are_refused_in_one_sentence() {
    let folder = Folder::new("refused");
    let scene = folder.write("cube.toml", CUBE);
    folder.write("file", "mine");
    for (name, content) in [("foreign/report.json", "{}"), ("listed/files.txt", "mine")] {
        let path = folder.path().join(name);
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("it is made");
        std::fs::write(path, content).expect("a file is written");
    }
    for (out, words) in [
        ("file", "is a file, and results go into a folder"),
        ("foreign", "report.json` would be overwritten, and no run has written it"),
        ("listed", "files.txt` is no list of what a run has written"),
    ] {
        let refused = souple(["run", &scene, "--quiet", "--out", &folder.at(out)]).ends(2);
        assert!(refused.stderr.contains(words) && !refused.stderr.contains("= expected"), "{refused:#?}");
    }
    // the folder of another run is cleared, which is said, one file as one
    souple(["run", &scene, "--quiet", "--out", &folder.at("out")]).ends(0);
    let one = folder.write("one.toml", CUBE.replace("A cube", "One cube"));
    let next = souple(["run", &one, "--steps", "1", "--out", &folder.at("out")]).ends(0);
    assert!(next.stderr.contains("files of an earlier run in"), "{next:#?}");
    assert!(next.stdout.starts_with("done: 1 step, "), "{next:#?}");
}

/// Results that cannot be held against each other are told in words.
#[test]
fn comparisons_are_told_in_words() {
    let folder = Folder::new("compared");
    for (file, cells) in [("a.vtu", "cells=1,1,1"), ("b.vtu", "cells=2,1,1")] {
        souple(["mesh", "generate", "box", &folder.at(file), "size=1,1,1", cells]).ends(0);
    }
    let compare = |a: &str, b: &str| souple_in(folder.path(), ["compare", a, b]);
    let told = compare("a.vtu", "b.vtu").ends(0);
    assert_eq!(told.stdout, "positions: 24 numbers in the first, 36 in the second\n");
    folder.write("a.txt", "");
    let refused = compare("a.txt", "a.vtu").ends(2);
    assert!(refused.stderr.contains("snapshot (.souple)") && refused.stderr.contains("vtu"), "{refused:#?}");
    folder.write("cube.toml", CUBE);
    for (out, frames) in [("c", "1"), ("d", "0")] {
        let arguments = ["run", "cube.toml", "--quiet", "--out", out, "--frames", frames];
        souple_in(folder.path(), arguments).ends(0);
    }
    std::fs::copy(folder.path().join("c/frames/cube_0001.vtu"), folder.path().join("c.vtu"))
        .expect("a frame");
    let told = compare("c.vtu", "a.vtu").ends(0);
    assert!(told.stdout.contains("displacement: only in c.vtu\n") && !told.stdout.contains('{'), "{told:#?}");
}

/// A quantity of another dimension in a load is a wrong unit, not a formula that cannot be read.
#[test]
fn units_of_loads_are_told() {
    let folder = Folder::new("units");
    for (load, words) in [
        ("traction = [\"1 m\", 0, 0]", "`1 m` is a length [m], but a pressure"),
        ("pressure = \"3 mm\"", "`3 mm` is a length [m], but a pressure"),
        ("force = [0, \"3 kPa\", 0]", "`3 kPa` is a pressure"),
    ] {
        let text = format!("{CUBE}[[bodies.cube.loads]]\nregion = \"x_max\"\n{load}\n");
        let answer = souple(["check", &folder.write("load.toml", text)]).ends(2);
        assert!(answer.stderr.contains(words), "{answer:#?}");
    }
}

/// Springs of one coupling say once what they all say.
#[test]
fn couplings_warn_once() {
    let folder = Folder::new("couplings");
    let second = "[systems.slow]\nstepper = \"backward_euler\"\n[systems.fast]\nstepper = \"symplectic_euler\"\nsteps_per_period = 10\n\
         [bodies.other]\nsystem = \"fast\"\ntranslate = [2, 0, 0]\n\
         mesh = { generate = \"box\", size = [1, 1, 1], cells = [2, 2, 2], element = \"hex8\" }\n\
         material = { name = \"neo_hookean\", youngs_modulus = \"20 kPa\", poissons_ratio = 0.3, density = 1000 }\n\
         [[couplings]]\nfrom = \"other\"\nregion = \"x_min\"\nto = \"cube\"\nstiffness = 1000\n\
         [bodies.cube]\nsystem = \"slow\"";
    let scene = folder.write("two.toml", CUBE.replace("[bodies.cube]", second));
    let report = souple(["run", &scene, "--quiet", "--json"]).ends(0).json();
    let warnings: Vec<&str> =
        report["warnings"].as_array().into_iter().flatten().filter_map(|warning| warning.as_str()).collect();
    let of_coupling: Vec<_> = warnings.iter().filter(|warning| warning.contains("may make energy")).collect();
    assert_eq!(of_coupling.len(), 1, "{warnings:#?}");
    // a face of 2 x 2 squares
    assert!(
        of_coupling[0].contains("couplings[0]") && of_coupling[0].contains("8 springs more"),
        "{warnings:#?}"
    );
}

/// What is no number, and matter that is inside out, is told when a run is over: of frames, whose points see nothing of it, too.
#[test]
fn what_is_doubtful_of_a_run_is_told() {
    let folder = Folder::new("doubts");
    let warnings = |text: String| {
        let scene = folder.write("doubt.toml", text);
        souple(["run", &scene, "--json", "--quiet"]).json()["warnings"].to_string()
    };
    let clean = warnings(CUBE.to_owned());
    assert!(!clean.contains("inside out") && !clean.contains("is no number"), "{clean}");
    // one end is led through the other
    let pins = "[[bodies.cube.pins]]\nregion = \"x_min\"\n[[bodies.cube.pins]]\nregion = \"x_max\"\n\
                motion = { formula = \"[-30*t, 0, 0]\" }\n[systems.main]\nstepper = \"static\"\n";
    let soft = CUBE.replace("neo_hookean", "linear");
    assert!(soft.contains("\"linear\""), "{soft}");
    let through = warnings(format!("{soft}{pins}"));
    assert!(through.contains("of body `cube`") && through.contains("inside out at the end"), "{through}");
}

/// A solid that has blown up, its numbers still finite, is no result.
#[test]
fn blown_up_solids_are_failures() {
    let folder = Folder::new("burst");
    // beyond the longest stable step, for as long as numbers last
    let text = CUBE.replace("[bodies.cube]", "[systems.main]\nstepper = \"symplectic_euler\"\n[bodies.cube]");
    let text =
        text.replace("20 kPa", "2 GPa").replace("material =", "angular_velocity = [0, 3, 1]\nmaterial =");
    let scene = folder.write("fast.toml", text);
    let finite = |steps: &str| {
        let report = souple(["run", &scene, "--json", "--quiet", "--steps", steps]).json();
        let is_finite = !report["error"]["message"].to_string().contains("not finite");
        (is_finite, report)
    };
    let reports: Vec<_> = ["2", "3", "4", "5", "6"].into_iter().map(finite).collect();
    let blown = reports.iter().find(|(_, report)| report["error"].to_string().contains("has blown up"));
    let (_, report) = blown.unwrap_or_else(|| panic!("{reports:#?}"));
    assert_eq!(report["status"], "failed");
    let message = report["error"]["message"].to_string();
    assert!(message.contains("body `cube`") && message.contains("an implicit stepper"), "{report:#}");
    // one that is torn apart by its spin, under a stepper that is implicit already
    let text = CUBE.replace(
        "[bodies.cube]",
        "[systems.main]\nstepper = { name = \"backward_euler\", newton = \"one\" }\n[bodies.cube]",
    );
    let text =
        text.replace("20 kPa", "1 Pa").replace("material =", "angular_velocity = [0, 3e5, 0]\nmaterial =");
    let scene = folder.write("implicit.toml", text);
    let report = souple(["run", &scene, "--json", "--quiet", "--steps", "3"]).ends(1).json();
    let message = report["error"]["message"].to_string();
    assert!(message.contains("has blown up") && !message.contains("an implicit stepper"), "{report:#}");
}

/// Surfaces that enclose nothing, files of another scale and sizes that contradict each other are told as such.
#[test]
fn fillings_are_refused_in_words() {
    let folder = Folder::new("fillings");
    let square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n";
    folder.write("flat.obj", square);
    // a corner of a cube: three of its sides
    folder.write(
        "open.obj",
        &(square.to_owned() + "v 0 0 1\nv 1 0 1\nv 0 1 1\nf 1 5 2\nf 2 5 6\nf 1 4 5\nf 4 7 5\n"),
    );
    souple(["mesh", "generate", "box", &folder.at("large.stl"), "size=900,900,900", "cells=1,1,1"]).ends(0);
    let fill = |arguments: &[&str]| {
        let call = ["mesh", "fill"].into_iter().chain(arguments.iter().copied());
        souple_in(folder.path(), call).ends(2)
    };
    for (arguments, words) in [
        (&["flat.obj", "a.msh", "size=0.1"][..], &["the surface is flat", "1 x 1 x 0 m"][..]),
        (&["open.obj", "a.msh", "size=0.1"], &["the surface has holes", "6 edges"]),
        (&["large.stl", "a.msh", "size=0.5"], &["in a box of 900 x 900 x 900 m", "scale=0.001"]),
        (
            &["liver", "a.msh", "size=0.02", "growth=0.5", "largest=0.01"],
            &["`largest` is 0.01 m", "at least the size"],
        ),
        (&["liver", "a.msh", "size=0.02", "largest=0.03"], &["`largest` is 0.03 m", "`growth` above 0"]),
        (&["liver", "a.msh", "count=3000", "largest=0.001"], &["`largest` is 0.001 m"]),
    ] {
        let refused = fill(arguments);
        assert!(words.iter().all(|word| refused.stderr.contains(word)), "{words:?}: {refused:#?}");
    }
}

/// A cut that leaves nothing is drawn, and said.
#[test]
fn empty_cuts_are_said() {
    let folder = Folder::new("cut");
    folder.write("cube.toml", CUBE);
    souple_in(folder.path(), ["run", "cube.toml", "--quiet", "--out", "run"]).ends(0);
    let cut = |plane: &str| {
        let call = ["render", "run", "--out", "a.png", "--size", "64,64", "--cut", plane];
        souple_in(folder.path(), call).ends(0)
    };
    let told = cut("1,0,0,-0.5").stderr;
    assert!(
        told.contains("the cut leaves nothing") && told.contains("1.0000 m, and what lies beyond -0.5000 m"),
        "{told}"
    );
    assert!(!cut("1,0,0,0.5").stderr.contains("leaves nothing"));
}

/// How often a hand's force was at its limit, and its device lost, is told where it was, in words and numbers.
#[test]
fn hands_at_their_limit_and_lost_devices_are_told() {
    let pressed = r#"format = 1
[world]
period = "5 ms"
[systems.main]
stepper = "backward_euler"
[bodies.bar]
mesh = { generate = "bar", size = [1, 0.1, 0.1], cells = [4, 1, 1], element = "hex8" }
material = { name = "neo_hookean", youngs_modulus = "10 kPa", poissons_ratio = 0.3, density = 1000 }
[[bodies.bar.pins]]
region = "x_min"
[hands.right]
device = { name = "emulated", mass = "0.4 kg", lost_at = "0.2 s" }
tool = { name = "sphere", centre = [0.5, 0.13, 0.05], radius = 0.02 }
body = "bar"
touch = { detect = "triangles" }
coupling = { stiffness = "400 N/m", damping = 2, limit = "0.25 N" }
motion = { times = [0, 0.05], offsets = [[0, 0, 0], [0, -0.05, 0]] }
[run]
duration = "0.4 s"
"#;
    let folder = Folder::new("lost");
    let scene = folder.write("pressed.toml", pressed);
    let told = souple(["haptics", &scene]).ends(0).stdout;
    assert!(told.contains("hand right: its force was at the limit of 0.25 N in "), "{told}");
    assert!(told.contains("hand right: its device was lost in ") && told.contains("first at 0.2"), "{told}");
    let report = souple(["haptics", &scene, "--json", "--quiet"]).ends(0).json();
    let hand = &report["hands"]["right"];
    let number = |key: &str| hand[key].as_f64().unwrap_or_else(|| panic!("{key} of {hand:#}"));
    assert_eq!(number("limit_n"), 0.25);
    // it is pushed against the bar for a part of the half of the time in which it is there
    assert!(number("share_at_limit") > 0.01 && number("share_at_limit") < 0.6, "{hand:#}");
    assert!(number("share_lost") > 0.2 && number("share_lost") < 0.6, "{hand:#}");
    assert!(number("first_lost_seconds") >= 0.199, "{hand:#}");
    let held =
        folder.write("held.toml", pressed.replace(", lost_at = \"0.2 s\"", "").replace("0.25 N", "50 N"));
    let told = souple(["haptics", &held, "--duration", "0.1 s"]).ends(0).stdout;
    assert!(!told.contains("at the limit") && !told.contains("was lost"), "{told}");
}
