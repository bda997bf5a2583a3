//! The command line as a contract: exit statuses, one JSON document, errors in one form, clean interruption.

use std::io::PipeReader;
use std::path::Path;
use std::process::Stdio;

use serde_json::Value;

use crate::common::{Answer, CUBE, Folder, assert_errors, assert_report, command, souple};

/// A folder with a small scene.
fn cube() -> (Folder, String) {
    let folder = Folder::new("contract");
    let scene = folder.write("cube.toml", CUBE);
    (folder, scene)
}

#[track_caller]
fn assert_keys(document: &Value, keys: &[&str]) {
    for key in keys {
        assert!(document.get(key).is_some(), "`{key}` is not in {document:#}");
    }
}

/// The entries of a list that is not empty, each with all keys.
#[track_caller]
fn assert_list(document: &Value, keys: &[&str]) {
    let list = document.as_array().unwrap_or_else(|| panic!("not a list: {document:#}"));
    assert!(!list.is_empty());
    list.iter().for_each(|entry| assert_keys(entry, keys));
}

/// `run --json` is the report, the same that stands in `report.json`; counts, probes and hashes are what they say.
#[test]
fn run_reports() {
    let (folder, scene) = cube();
    let out = folder.at("out");
    let answer = souple(["run", &scene, "--json", "--out", &out, "--hash-every", "3", "--seed", "5"]).ends(0);
    let report = answer.json();
    assert_report(&report);
    let written = std::fs::read_to_string(folder.path().join("out/report.json")).expect("report.json");
    assert_eq!(serde_json::from_str::<Value>(&written).expect("a document"), report);
    assert_eq!(
        (&report["status"], &report["steps"], &report["seed"]),
        (&"done".into(), &10.into(), &5.into())
    );
    assert_eq!((&report["counts"]["points"], &report["counts"]["hex8"]), (&27.into(), &8.into()));
    let steps: Vec<u64> = report["hashes"]
        .as_array()
        .expect("hashes")
        .iter()
        .map(|entry| entry["step"].as_u64().expect("a step"))
        .collect();
    assert_eq!(steps, [0, 3, 6, 9, 10]);
    let place = &report["probes"]["place"];
    assert_keys(place, &["unit", "first", "last", "min", "max"]);
    // backward Euler from rest falls h² g n (n + 1)/2
    let fall = place["first"][1].as_f64().expect("a number") - place["last"][1].as_f64().expect("a number");
    assert!((fall - 1e-4 * 9.81 * 55.0).abs() < 1e-9, "{fall}");
    for name in ["initial", "final"] {
        assert_keys(&report["energy"][name], &["total", "kinetic", "forces"]);
        assert_keys(&report["momentum"][name], &["linear", "angular"]);
    }
    let files = folder.files();
    for wanted in
        ["probes.csv", "place.svg", "last.png", "report.json", "frames/cube.pvd", "frames/cube_0005.vtu"]
    {
        assert!(files.contains(&format!("out/{wanted}")), "{wanted} is not among {files:?}");
    }
}

/// `--quiet` says nothing at all when all is well; without it there are lines on standard output alone.
#[test]
fn quiet_is_quiet() {
    let (_folder, scene) = cube();
    let answer = souple(["run", &scene, "--quiet"]).ends(0);
    assert_eq!((answer.stdout.as_str(), answer.stderr.as_str()), ("", ""));
    let answer = souple(["run", &scene]).ends(0);
    assert!(answer.stdout.contains("done: 10 steps") && answer.stdout.contains("place = "), "{answer:#?}");
    assert_eq!(answer.stderr, "");
}

/// Every command with `--json` gives one document, with the keys of the contract.
#[test]
fn one_document_each() {
    let (folder, scene) = cube();
    let json = |arguments: &[&str]| souple(arguments.iter().chain(&["--json"])).ends(0).json();

    let check = json(&["check", &scene]);
    assert_keys(&check, &["valid", "title", "scene", "counts", "systems", "steps", "forecast", "warnings"]);
    let system =
        ["name", "stepper", "timestep_seconds", "shortest_interval_seconds", "longest_stable_step_seconds"];
    assert_list(&check["systems"], &system);
    assert_keys(&check["forecast"], &["seconds_per_step", "load", "wall_seconds", "measured_steps", "bytes"]);

    let page = ["kind", "name", "summary", "source", "parameters"];
    for kind in
        ["materials", "elements", "steppers", "solvers", "preconditioners", "generators", "shapes", "formats"]
            .into_iter()
            .chain(["quantities", "functions", "units"])
    {
        assert_list(&json(&["list", kind]), &page);
    }
    let laws = json(&["list", "materials"]);
    for law in ["linear", "corotational", "st_venant_kirchhoff", "neo_hookean", "stable_neo_hookean"] {
        assert!(laws.as_array().is_some_and(|laws| laws.iter().any(|entry| entry["name"] == law)), "{law}");
        let described = json(&["describe", law]);
        assert_list(&described, &page);
        assert_list(&described[0]["parameters"], &["name", "summary", "unit", "expected", "default"]);
    }

    // tables of scenes that have no table of entries
    for (name, key) in
        [("actuators", "largest"), ("marks", "whitening_pressure"), ("modes", "count"), ("controls", "value")]
    {
        let described = json(&["describe", name]);
        assert_list(&described, &page);
        let keys = described[0]["parameters"].as_array().expect("a list");
        assert!(keys.iter().any(|known| known["name"] == key), "{name}: {described}");
    }

    assert_keys(&json(&["schema"]), &["$schema", "title", "$defs"]);
    let cases = json(&["verify", "--list"]);
    assert_list(&cases, &["id", "capabilities", "what", "scene", "reference", "tolerance", "source"]);
    assert_list(&json(&["bench", "--list"]), &["name"]);
    let rows = json(&["verify", "cantilever_tet4_linear_n3"]);
    let keys =
        ["measured", "reference", "tolerance", "unit", "pass", "seconds", "source", "id", "capabilities"];
    assert_list(&rows, &keys);
    assert_eq!(rows[0]["pass"], true);

    let mesh = folder.at("ball.vtu");
    let generated = json(&["mesh", "generate", "sphere", &mesh, "radius=1", "cells=3", "element=hex8"]);
    let converted = json(&["mesh", "convert", &mesh, &folder.at("ball.msh")]);
    let measured = json(&["mesh", "quality", &folder.at("ball.msh")]);
    for document in [&generated, &converted, &measured] {
        assert_keys(document, &["points", "cells", "volume", "bounds", "smallest_scaled_jacobian", "notes"]);
        assert_keys(document, &["volume_of_kinds"]);
        assert_eq!(document["points"], generated["points"]);
    }

    let surface = folder.at("ball.stl");
    json(&["mesh", "convert", &mesh, &surface]);
    let mended = json(&["mesh", "repair", &surface, &folder.at("ball.obj")]);
    assert_keys(&mended, &["points", "triangles", "closed", "enclosed_volume", "repairs", "faults", "notes"]);

    let recording = folder.at("run.json");
    let out = folder.at("out");
    let run = ["run", &scene, "--quiet", "--record", &recording, "--out", &out, "--snapshot-every", "5"];
    souple(run).ends(0);
    assert_keys(&json(&["replay", &recording, "--verify"]), &["same", "hashes", "divergence"]);
    assert_report(&json(&["replay", &recording]));

    let norms = ["field", "largest", "rms", "relative"];
    let (five, ten) = (folder.at("out/snapshot_00000005.souple"), folder.at("out/snapshot_00000010.souple"));
    assert_list(&json(&["compare", &five, &ten]), &norms);
    let (first, last) = (folder.at("out/frames/cube_0000.vtu"), folder.at("out/frames/cube_0005.vtu"));
    let compared = json(&["compare", &first, &last]);
    assert_list(&compared, &norms);
    let same = json(&["compare", &last, &last]);
    assert!(same.as_array().is_some_and(|rows| rows.iter().all(|row| row["largest"] == 0.0)), "{same:#}");
}

/// Bodies fall alike: between two frames of a fall the positions differ by the fall, and the norms say so.
#[test]
fn compare_measures() {
    let (folder, scene) = cube();
    souple(["run", &scene, "--quiet", "--out", &folder.at("out"), "--frames", "1"]).ends(0);
    let (first, last) = (folder.at("out/frames/cube_0000.vtu"), folder.at("out/frames/cube_0001.vtu"));
    let rows = souple(["compare", &first, &last, "--json"]).ends(0).json();
    let rows = rows.as_array().expect("rows");
    let row = rows.iter().find(|row| row["field"] == "positions").expect("positions");
    let fall = 1e-4 * 9.81 * 55.0;
    // single precision in the frames: half a unit in the last place of numbers up to 1
    let largest = row["largest"].as_f64().expect("a number");
    assert!((largest - fall).abs() < 2.0 * f64::from(f32::EPSILON), "{largest} for {fall}");
    // one component of three differs
    let rms = row["rms"].as_f64().expect("a number");
    assert!((rms - fall / 3.0_f64.sqrt()).abs() < 2.0 * f64::from(f32::EPSILON), "{rms}");
}

/// Wrong requests of every command: status 2, and with `--json` `{errors: […]}` with all keys.
#[test]
fn wrong_requests_have_one_form() {
    let (folder, _scene) = cube();
    let broken = folder.write("broken.toml", CUBE.replace("gravity", "gravty"));
    let missing = folder.at("missing");
    let calls: &[&[&str]] = &[
        &["run", &broken],
        &["run", &missing],
        &["run"],
        &["check", &broken],
        &["list", "materals"],
        &["describe", "neo_hokean"],
        &["verify", "cantilever_tet4_liner_n3"],
        &["bench", "implicit_beam_n7"],
        &["replay", &missing],
        &["compare", &missing, &missing],
        &["mesh", "generate", "barr", "out.msh"],
        &["mesh", "quality", &missing],
        &["mesh", "convert", &missing, "out.msh"],
        &["frobnicate"],
        &["schema", "extra"],
    ];
    for call in calls {
        let plain = souple(call.iter()).ends(2);
        assert!(plain.stdout.is_empty() && !plain.stderr.is_empty(), "{plain:#?}");
        let answer = souple(call.iter().chain(&["--json"])).ends(2);
        assert_errors(&answer.json());
    }
}

/// A scene's errors carry file, line and column, all of them at once.
#[test]
fn errors_name_their_place() {
    let folder = Folder::new("places");
    let text = CUBE.replace("gravity", "gravty").replace("20 kPa", "20 kN");
    let scene = folder.write("two.toml", text);
    let document = souple(["check", &scene, "--json"]).ends(2).json();
    let errors = document["errors"].as_array().expect("errors");
    let places: Vec<(u64, &str)> = errors
        .iter()
        .map(|error| (error["line"].as_u64().expect("a line"), error["path"].as_str().expect("a path")))
        .collect();
    assert_eq!(places, [(5, "world.gravty"), (8, "bodies.cube.material.youngs_modulus")]);
    assert!(errors.iter().all(|error| error["file"] == scene.as_str()), "{document:#}");
}

/// What is not known is answered with the nearest name.
#[test]
fn nearest_names() {
    let cases: &[(&[&str], &str)] = &[
        (&["list", "materals"], "did you mean `materials`?"),
        (&["describe", "neo_hokean"], "did you mean `neo_hookean`?"),
        (&["describe", "tet5"], "did you mean `tet4`?"),
        (&["verify", "cantilever_tet4_liner_n3"], "did you mean `cantilever_tet4_linear_n3`?"),
        (&["bench", "implicit_bean_n3"], "did you mean `implicit_beam_n3`?"),
        (&["mesh", "generate", "sphrere", "out.msh"], "did you mean `sphere`?"),
        (&["rum"], "run"),
        (&["run", "x.toml", "--stepps", "3"], "--steps"),
    ];
    for (call, words) in cases {
        let answer = souple(*call).ends(2);
        assert!(answer.stderr.contains(words), "{words}: {answer:#?}");
    }
}

/// A step that cannot be made fails the work, not the request: status 1, the report says `failed` and why, and the
/// files of what was computed are whole.
#[test]
fn a_refused_step_is_reported() {
    let folder = Folder::new("refused");
    // explicit steps a hundred times longer than is stable
    let text = CUBE.replace("[bodies.cube]", "[systems.main]\nstepper = \"symplectic_euler\"\n[bodies.cube]");
    let text = text.replace("20 kPa", "20 GPa").replace("\"100 ms\"", "\"100 s\"");
    let text = text.replace("material =", "velocity = [0, 0, 0]\nangular_velocity = [0, 3, 1]\nmaterial =");
    let scene = folder.write("fast.toml", text);
    let answer = souple(["run", &scene, "--json", "--out", &folder.at("out")]).ends(1);
    assert!(answer.stderr.contains("is longer than symplectic_euler bears"), "{answer:#?}");
    let report = answer.json();
    assert_report(&report);
    assert_eq!(report["status"], "failed");
    assert!(report["steps"].as_u64().is_some_and(|steps| steps < 10_000));
    let warnings = report["warnings"].as_array().expect("warnings");
    assert!(warnings.iter().any(|text| text.to_string().contains("main")), "{report:#}");
    let error = &report["error"];
    assert_keys(error, &["message", "step", "place", "force", "body", "point", "position"]);
    assert_eq!(error["body"], "cube", "{error:#}");
    let message = error["message"].as_str().expect("a message");
    assert!(message.contains("of body `cube`"), "{message}");
    assert!(answer.stderr.contains(&format!("error: {message}")), "{answer:#?}");
    assert_complete(&folder, "failed");
}

/// What a run leaves is whole: a report of this status, a series whose frames are all there and can be read, no
/// file that is still being written.
#[track_caller]
fn assert_complete(folder: &Folder, status: &str) {
    let files = folder.files();
    assert!(!files.iter().any(|name| name.ends_with(".part")), "{files:?}");
    let report = std::fs::read_to_string(folder.path().join("out/report.json")).expect("report.json");
    let report: Value = serde_json::from_str(&report).expect("a whole report");
    assert_eq!(report["status"], status);
    let series = std::fs::read_to_string(folder.path().join("out/frames/cube.pvd")).expect("cube.pvd");
    assert!(series.trim_end().ends_with("</VTKFile>"), "{series}");
    let frames: Vec<&str> =
        series.split("file=\"").skip(1).filter_map(|rest| rest.split('"').next()).collect();
    assert!(frames.len() >= 2, "{series}");
    for frame in frames {
        let path = folder.at(&format!("out/frames/{frame}"));
        souple(["compare", &path, &path]).ends(0);
    }
    let probes = std::fs::read_to_string(folder.path().join("out/probes.csv")).expect("probes.csv");
    let steps = report["steps"].as_u64().expect("steps") as usize;
    assert_eq!(probes.lines().count(), steps + 2, "a line of names, one before the first step, one for each");
}

/// Ctrl-C, and the system's wish to end, end a run with 130 after complete files: report, series, probes, and a
/// recording that replays.
#[cfg(unix)]
#[test]
fn interruption_leaves_complete_files() {
    for signal in ["-INT", "-TERM"] {
        interrupt(signal);
    }
}

#[cfg(unix)]
fn interrupt(signal: &str) {
    let folder = Folder::new("interrupted");
    let scene = folder.write("long.toml", CUBE.replace("\"100 ms\"", "\"10000 s\""));
    let (out, recording) = (folder.at("out"), folder.at("run.json"));
    let call = ["run", &scene, "--json", "--out", &out, "--frames", "100000", "--record", &recording];
    let report = ended_by(signal, &call, &folder.path().join("out/frames/cube_0002.vtu"));
    assert!(report["steps"].as_u64().is_some_and(|steps| steps > 0 && steps < 1_000_000));
    assert_complete(&folder, "interrupted");
    souple(["replay", &recording, "--verify", "--quiet"]).ends(0);
}

/// A step that lasts longer than anybody waits is broken off by the system's wish to end: what was before it is told.
#[cfg(unix)]
#[test]
fn interruption_breaks_long_steps_off() {
    let folder = Folder::new("long-step");
    let endless = "[systems.main]\nstepper = \"symplectic_euler\"\nsteps_per_period = 1000000\n";
    let text = format!("{CUBE}{endless}").replace("[2, 2, 2]", "[10, 10, 10]");
    let (scene, out) = (folder.write("endless.toml", text), folder.at("out"));
    // its first state is written before its first step
    let begun = folder.path().join("out/frames/cube_0000.vtu");
    let report = ended_by("-TERM", &["run", &scene, "--json", "--out", &out], &begun);
    assert_eq!(report["steps"], 0);
}

/// The report of a call that is ended by a signal when a file is there.
#[cfg(unix)]
fn ended_by(signal: &str, call: &[&str], file: &Path) -> Value {
    let mut command = command();
    command.args(call);
    let call = format!("{command:?}");
    let child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("the program starts");
    for _ in 0..600 {
        if file.exists() {
            break;
        }
        std::thread::sleep(std::time::Duration::from_millis(50));
    }
    assert!(file.exists(), "no frame within half a minute");
    let sent = std::process::Command::new("kill").args([signal, &child.id().to_string()]).status();
    assert!(sent.expect("kill").success());
    let answer = Answer::of(call, child.wait_with_output().expect("an end")).ends(130);
    let report = answer.json();
    assert_report(&report);
    assert_eq!(report["status"], "interrupted");
    report
}

/// The writing end of a pipe that nobody reads.
fn broken_pipe() -> Stdio {
    let (reader, writer): (PipeReader, _) = std::io::pipe().expect("a pipe");
    drop(reader);
    writer.into()
}

/// A reader that has gone away, of either stream, is no panic and changes no status.
#[test]
fn broken_pipes_do_not_panic() {
    let (folder, scene) = cube();
    let broken = folder.write("broken.toml", CUBE.replace("gravity", "gravty"));
    let calls: &[(&[&str], i32)] = &[
        (&["list", "materials"], 0),
        (&["describe", "neo_hookean", "--json"], 0),
        (&["schema"], 0),
        (&["verify", "--list"], 0),
        (&["bench", "--list"], 0),
        (&["run", &scene], 0),
        (&["check", &scene], 0),
        (&["--help"], 0),
        (&["--version"], 0),
        (&["run", &broken], 2),
        (&["run", &broken, "--json"], 2),
        (&["list", "materals"], 2),
        (&["frobnicate"], 2),
    ];
    for (call, status) in calls {
        let output = command().args(*call).stdout(broken_pipe()).stderr(Stdio::piped()).output();
        Answer::of(format!("{call:?}, nobody reading"), output.expect("the program starts")).ends(*status);
        let ended = command().args(*call).stdout(Stdio::null()).stderr(broken_pipe()).status();
        assert_eq!(
            ended.expect("the program starts").code(),
            Some(*status),
            "{call:?}, nobody reading its errors"
        );
    }
}

/// Output that cannot be written for another reason is lost work: status 1, and it is said.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_under_standard_output_is_told() {
    let full = || std::fs::File::options().write(true).open("/dev/full").expect("/dev/full");
    let (_folder, scene) = cube();
    for call in [&["list", "materials"][..], &["schema"], &["run", &scene, "--json"], &["check", &scene]] {
        let output = command().args(call).stdout(full()).stderr(Stdio::piped()).output();
        let answer =
            Answer::of(format!("{call:?} to a full disk"), output.expect("the program starts")).ends(1);
        assert!(answer.stderr.contains("standard output cannot be written"), "{answer:#?}");
    }
}

/// Help and version are no errors; a greeting names what to try.
#[test]
fn help_and_version() {
    let help = souple(["--help"]).ends(0).stdout;
    for name in ["run", "check", "list", "describe", "schema", "verify", "bench", "replay", "compare", "mesh"]
    {
        assert!(help.lines().any(|line| line.trim_start().starts_with(name)), "{name} is not in\n{help}");
        souple([name, "--help"]).ends(0);
    }
    assert_eq!(souple(["--version"]).ends(0).stdout.trim(), format!("souple {}", env!("CARGO_PKG_VERSION")));
}
