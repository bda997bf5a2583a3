//! What a run leaves, and how it goes on: its folder, snapshots, recordings away from where they were made.

use std::path::Path;

use serde_json::Value;

use crate::common::{Answer, CUBE, Folder, command, souple, souple_in};

/// Names of the files below a folder of the test.
fn below(folder: &Folder, name: &str) -> Vec<String> {
    let prefix = format!("{name}/");
    folder.files().iter().filter_map(|file| file.strip_prefix(&prefix)).map(str::to_owned).collect()
}

fn last_hash(report: &Value) -> &Value {
    report["hashes"].as_array().and_then(|hashes| hashes.last()).map_or(&Value::Null, |last| &last["hash"])
}

/// A second run into a folder leaves what it would leave in an empty one, and the files of others.
#[test]
fn results_are_replaced_as_a_set() {
    let folder = Folder::new("replaced");
    let first = folder.write("first.toml", CUBE);
    let second = folder.write("second.toml", CUBE.replace("probes.place", "probes.spot"));
    let (out, clean) = (folder.at("out"), folder.at("clean"));
    let rich = ["--frames", "10", "--snapshot-every", "5", "--quiet"];
    souple(["run", &first, "--out", &out].iter().chain(&rich)).ends(0);
    assert!(below(&folder, "out").contains(&"snapshot_00000005.souple".to_owned()));
    std::fs::write(folder.path().join("out/notes.txt"), "mine").expect("a file is written");
    std::fs::write(folder.path().join("out/frames/mine.vtu"), "mine").expect("a file is written");
    // what is refused before its first step removes nothing
    let before = below(&folder, "out");
    souple(["run", &first, "--out", &out, "--duration", "1 ms"]).ends(2);
    souple(["run", &first, "--out", &out, "--set", "bodies.cube.material.density=-1"]).ends(2);
    assert_eq!(below(&folder, "out"), before);
    for target in [&out, &clean] {
        souple(["run", &second, "--out", target, "--frames", "2", "--quiet"]).ends(0);
    }
    let mut expected = below(&folder, "clean");
    expected.extend(["notes.txt".to_owned(), "frames/mine.vtu".to_owned()]);
    expected.sort();
    assert_eq!(below(&folder, "out"), expected);
    assert!(expected.contains(&"spot.svg".to_owned()) && !expected.contains(&"place.svg".to_owned()));
}

/// A file that no run wrote is not written over.
#[test]
fn foreign_results_are_not_overwritten() {
    let folder = Folder::new("foreign");
    let scene = folder.write("cube.toml", CUBE);
    std::fs::create_dir(folder.path().join("out")).expect("a folder");
    folder.write("out/report.json", "mine");
    let answer = souple(["run", &scene, "--quiet", "--out", &folder.at("out")]).ends(2);
    assert!(
        answer.stderr.contains("report.json` would be overwritten, and no run has written it"),
        "{answer:#?}"
    );
    assert_eq!(below(&folder, "out"), ["report.json"]);
}

/// A resumed run ends where the scene ends, with the bits of the unbroken run; into the folder of the first part it
/// does not go, which it would replace.
#[test]
fn resumed_runs_end_with_their_scene() {
    let folder = Folder::new("resumed");
    let scene = folder.write("cube.toml", CUBE);
    let (out, rest) = (folder.at("out"), folder.at("rest"));
    let whole = ["run", &scene, "--json", "--quiet", "--out", &out, "--snapshot-every", "4", "--seed", "9"];
    let unbroken = souple(whole).ends(0).json();
    let snapshot = folder.at("out/snapshot_00000004.souple");
    let resume = ["run", &scene, "--json", "--quiet", "--resume", &snapshot];
    let report = souple(resume.iter().chain(&["--out", &rest])).ends(0).json();
    assert_eq!((&report["first_step"], &report["steps"], &report["seed"]), (&4.into(), &6.into(), &9.into()));
    assert_eq!(last_hash(&report), last_hash(&unbroken));
    let longer = souple(resume.iter().chain(&["--steps", "8"])).ends(0).json();
    assert_eq!(longer["steps"], 8);
    let before = below(&folder, "out");
    let answer = souple(resume.iter().chain(&["--out", &out])).ends(2);
    assert!(answer.stderr.contains("choose a folder without results"), "{answer:#?}");
    assert_eq!(below(&folder, "out"), before);
    let end = folder.at("out/snapshot_00000010.souple");
    let answer = souple(["run", &scene, "--json", "--quiet", "--resume", &end]).ends(0);
    assert!(answer.stderr.contains("nothing is left to run"), "{answer:#?}");
    assert_eq!(answer.json()["steps"], 0);
}

/// An edit before a snapshot is in the snapshot: what goes on from it, through another edit, ends with the bits of
/// the unbroken run.
#[test]
fn snapshots_hold_edits() {
    use souple::engine::{Command, Edit};
    use souple::run::{Control, Options, read_snapshot, run};

    let folder = Folder::new("edited");
    let scene = || souple::scene::read_text("cube", CUBE, Path::new("."), &[]).expect("a scene");
    let commands = vec![
        Command { period: 2, edit: Edit::Pin { system: 0, block: 0 } },
        Command { period: 5, edit: Edit::Pin { system: 0, block: 7 } },
        Command { period: 8, edit: Edit::Unpin { system: 0, block: 0 } },
    ];
    let out = folder.path().join("out");
    let options = Options {
        out: Some(out.clone()),
        commands,
        snapshot_every: Some(5),
        frames: Some(0),
        ..Options::default()
    };
    let go = |options: &Options| run(scene(), options, &mut |_| Control::Continue).expect("a run");
    let unbroken = go(&options);
    let snapshot = read_snapshot(&out.join("snapshot_00000005.souple"), &unbroken.report.scene_sha256);
    let snapshot = snapshot.expect("a snapshot");
    assert_eq!(snapshot.commands.len(), 1, "edits up to the snapshot");
    let resumed = go(&Options { out: None, resume: Some(snapshot), ..options.clone() });
    assert_eq!(resumed.report.hashes.last(), unbroken.report.hashes.last());
    assert_eq!(resumed.world.log(), unbroken.world.log());
    let unedited = go(&Options { out: None, commands: Vec::new(), ..options });
    assert_ne!(unedited.report.hashes.last(), unbroken.report.hashes.last());
    // a recording of it replays its edits
    let recording = folder.path().join("edited.json");
    unbroken.recording.write(&recording).expect("a file");
    souple(["replay", &folder.at("edited.json"), "--verify", "--quiet"]).ends(0);
}

/// Times that are not whole periods are told with the figures.
#[test]
fn durations_are_told() {
    let folder = Folder::new("durations");
    let scene = folder.write("cube.toml", CUBE);
    let answer = souple(["run", &scene, "--json", "--quiet", "--duration", "34 ms"]).ends(0);
    assert!(answer.stderr.contains("a duration of 0.034 s is 3.400000 periods of 0.01 s"), "{answer:#?}");
    assert_eq!(answer.json()["steps"], 3);
    let odd = folder.write("odd.toml", CUBE.replace("100 ms", "34 ms"));
    let checked = souple(["check", &odd, "--json"]).ends(0).json();
    assert_eq!(checked["steps"], 3);
    assert!(checked["warnings"].to_string().contains("3.400000 periods"), "{checked:#}");
}

/// A scene with an include, a mesh file, and a mesh file for its contact shape, in a folder of its own.
fn compound(folder: &Folder) {
    for name in ["elsewhere", "scene", "scene/meshes", "tools"] {
        std::fs::create_dir(folder.path().join(name)).expect("a folder");
    }
    let mesh = folder.at("scene/meshes/bar.msh");
    souple(["mesh", "generate", "bar", &mesh, "size=1,20cm,20cm", "cells=4,1,1", "element=hex8"]).ends(0);
    souple(["mesh", "generate", "sphere", &folder.at("tools/ball.msh"), "radius=5cm", "cells=4"]).ends(0);
    folder.write(
        "scene/material.toml",
        "[bodies.bar]\nmaterial = { name = \"linear\", youngs_modulus = \"20 kPa\", poissons_ratio = 0.3, density = 1000 }\n",
    );
    folder.write(
        "scene/scene.toml",
        r#"
format = 1
include = ["material.toml"]
[world]
period = "10 ms"
gravity = [0, -9.81, 0]
[bodies.bar]
mesh = { file = "meshes/bar.msh" }
[[bodies.bar.pins]]
region = { box = [[-1e-9, -1, -1], [1e-9, 1, 1]] }
[shapes.ball]
shape = { name = "closed_surface", surface = "../tools/ball.msh" }
motion = { formula = "[0.8, -0.06, 0.1]" }
[[contacts]]
name = "on_ball"
body = "bar"
shape = "ball"
[run]
duration = "50 ms"
"#,
    );
}

/// A recording plays from any folder; changed and missing files are told by name; every file the scene reads is in its
/// fingerprint.
#[test]
fn recordings_hold_their_scene() {
    let folder = Folder::new("recorded");
    compound(&folder);
    let run = ["run", "scene", "--quiet", "--json", "--hash-every", "1", "--record", "elsewhere/run.json"];
    let recorded = souple_in(folder.path(), run).ends(0).json();
    let replay = |from: &str, file: &str| -> Answer {
        souple_in(&folder.path().join(from), ["replay", file, "--verify", "--quiet"])
    };
    replay("tools", "../elsewhere/run.json").ends(0);
    // texts are within: the scene and what it includes may be gone
    for file in ["scene/scene.toml", "scene/material.toml"] {
        std::fs::rename(folder.path().join(file), folder.path().join("elsewhere/hidden")).expect("a move");
        replay("scene", "../elsewhere/run.json").ends(0);
        std::fs::rename(folder.path().join("elsewhere/hidden"), folder.path().join(file)).expect("a move");
    }
    for file in ["scene/meshes/bar.msh", "tools/ball.msh", "scene/material.toml"] {
        let path = folder.path().join(file);
        let content = std::fs::read(&path).expect("a file");
        // the very same mesh, and other bytes
        std::fs::write(&path, [&content[..], b"\n"].concat()).expect("a file is written");
        let report = souple_in(folder.path(), ["run", "scene", "--quiet", "--json"]).ends(0).json();
        assert_ne!(report["scene_sha256"], recorded["scene_sha256"], "{file}");
        if !file.ends_with(".toml") {
            let answer = replay("elsewhere", "run.json").ends(2);
            let told =
                answer.stderr.contains(file) && answer.stderr.contains("has changed since the recording");
            assert!(told, "{answer:#?}");
            std::fs::remove_file(&path).expect("it is removed");
            let answer = replay("elsewhere", "run.json").ends(2);
            assert!(answer.stderr.contains("is not there; looked for"), "{answer:#?}");
        }
        std::fs::write(&path, content).expect("a file is written");
    }
    replay("elsewhere", "run.json").ends(0);
}

/// A replay that departs names the step and the first field; one on another machine says what that means.
#[test]
fn divergence_is_told_by_field() {
    let folder = Folder::new("diverged");
    let scene = folder.write("cube.toml", CUBE);
    let recording = folder.at("run.json");
    souple(["run", &scene, "--quiet", "--hash-every", "1", "--record", &recording]).ends(0);
    let text = std::fs::read_to_string(&recording).expect("the recording");
    let mut document: Value = serde_json::from_str(&text).expect("JSON");
    assert!(document["binary"].is_string() && document["isa"].is_string());
    document["isa"] = "abacus".into();
    for entry in document["hashes"].as_array_mut().expect("hashes").iter_mut().skip(3) {
        entry["hash"] = "0123456789abcdef".into();
        entry["fields"]["systems[0].v"] = "0123456789abcdef".into();
    }
    let other = folder.write("other.json", document.to_string());
    let answer = souple(["replay", &other, "--verify", "--quiet"]).ends(1);
    assert!(answer.stderr.contains("differs at step 3, first in `systems[0].v`"), "{answer:#?}");
    assert!(answer.stderr.contains("on abacus, this is souple"), "{answer:#?}");
    let told = souple(["replay", &other, "--verify", "--quiet", "--json"]).ends(1).json();
    assert_eq!(told["divergence"]["fields"], serde_json::json!(["systems[0].v"]));
}

/// A mesh file given on the command line is relative to where the program runs; the system that a scene does not
/// write can be set.
#[test]
fn settings_are_of_the_command_line() {
    let folder = Folder::new("settings_files");
    compound(&folder);
    let other = folder.at("elsewhere/other.msh");
    souple(["mesh", "generate", "bar", &other, "size=1,20cm,20cm", "cells=8,1,1", "element=hex8"]).ends(0);
    let points = |from: &str, setting: &str| {
        let scene = folder.at("scene");
        let call = ["run", &scene, "--quiet", "--json", "--steps", "1", "--set", setting];
        souple_in(&folder.path().join(from), call).ends(0).json()["counts"]["points"].clone()
    };
    assert_eq!(points("elsewhere", "bodies.bar.mesh.file=other.msh"), 36);
    assert_eq!(points(".", "bodies.bar.mesh.file=elsewhere/other.msh"), 36);
    assert_eq!(points(".", "systems.main.steps_per_period=2"), 20);
    let recording = folder.at("run.json");
    let run =
        ["run", "../scene", "--quiet", "--set", "bodies.bar.mesh.file=other.msh", "--record", &recording];
    souple_in(&folder.path().join("elsewhere"), run).ends(0);
    souple_in(folder.path(), ["replay", "run.json", "--verify", "--quiet"]).ends(0);
}

/// Faults beyond a screenful are counted, and all there with `--json`.
#[test]
fn many_faults_are_cut() {
    let folder = Folder::new("many");
    let wrong: String = (0..50).map(|key| format!("wrong_{key} = 1\n")).collect();
    let scene = folder.write("scene.toml", format!("{wrong}{CUBE}"));
    let answer = souple(["check", &scene]).ends(2);
    assert!(answer.stderr.contains("… and 30 more"), "{answer:#?}");
    let document = souple(["check", &scene, "--json"]).ends(2).json();
    assert_eq!(document["errors"].as_array().map(Vec::len), Some(50));
}

/// Energy that the exchange between two systems makes stands with the other energies.
#[test]
fn couplings_report_their_energy() {
    let folder = Folder::new("couplings");
    let second = "[bodies.other]\nsystem = \"slow\"\ntranslate = [0, 1, 0]\nmesh = { generate = \"box\", size = [1, 1, 1], cells = [2, 2, 2], element = \"hex8\" }\nmaterial = { name = \"neo_hookean\", youngs_modulus = \"20 kPa\", poissons_ratio = 0.3, density = 1000 }\n";
    let systems = "[systems.fast]\nstepper = \"symplectic_euler\"\nsteps_per_period = 10\n[systems.slow]\nstepper = \"backward_euler\"\n";
    let coupling = "[[couplings]]\nfrom = \"cube\"\nto = \"other\"\nregion = { group = \"y_max\" }\nstiffness = \"100 N/m\"\ndamping = \"5 N s/m\"\n";
    let text = CUBE.replace("[bodies.cube]", &format!("{systems}[bodies.cube]\nsystem = \"fast\""));
    let text =
        text.replace("[probes.place]", &format!("velocity = [0, 0, 1]\n{second}{coupling}[probes.place]"));
    let scene = folder.write("two.toml", text);
    let report = souple(["run", &scene, "--quiet", "--json"]).ends(0).json();
    let made = |end: &str| report["energy"][end]["couplings"]["couplings[0]"]["made"].as_f64();
    assert_eq!(made("initial"), Some(0.0), "{:#}", report["energy"]);
    assert!(made("final").is_some_and(|made| made.is_finite() && made != 0.0), "{:#}", report["energy"]);
}

/// The stages of a step, and what goes on beside them, make up the time of the run.
#[test]
fn stages_add_up() {
    let folder = Folder::new("stages");
    let scene = folder.write("cube.toml", CUBE);
    let report = souple(["run", &scene, "--quiet", "--json"]).ends(0).json();
    let stages = report["stages_ms"].as_object().expect("stages");
    let keys: Vec<&str> = stages.keys().map(String::as_str).collect();
    let steps = ["pairs", "forces", "assembly", "solve", "advance", "fields"];
    assert_eq!(keys, [&steps[..], &["measure", "inside_out", "write"]].concat());
    let sum: f64 = stages.values().filter_map(Value::as_f64).sum();
    let wall = 1e3 * report["wall_seconds"].as_f64().expect("seconds");
    // stages are parts of the whole, and do not overlap
    assert!(sum > 0.0 && sum <= wall, "{sum} of {wall} ms");
    assert!(stages["advance"].as_f64().is_some_and(|advance| advance > 0.0));
}

/// Derivatives of forces are timed apart: as matrices where these are stored, as products where they are not.
#[test]
fn derivatives_are_timed() {
    let folder = Folder::new("derivatives");
    let scene = folder.write("cube.toml", CUBE);
    for matrix_free in ["false", "true"] {
        let stepper = format!(
            "systems.main.stepper={{ name = \"backward_euler\", solver = \"cg\", preconditioner = \"block_jacobi\", matrix_free = {matrix_free} }}"
        );
        let report = souple(["run", &scene, "--quiet", "--json", "--set", &stepper]).ends(0).json();
        let stage = |name: &str| report["stages_ms"][name].as_f64().expect("a stage");
        let derivatives = report["derivatives_ms"].as_f64().expect("derivatives");
        let (assembly, solve) = (stage("assembly"), stage("solve"));
        assert!(assembly <= derivatives && derivatives <= assembly + solve, "{report:#}");
        assert_eq!(derivatives > assembly, matrix_free == "true", "{report:#}");
    }
}

/// A program asked to end while it waits writes nothing half: see `contract.rs`. Here: before its first step it has
/// touched nothing.
#[cfg(unix)]
#[test]
fn a_folder_that_cannot_be_cleared_is_told() {
    let folder = Folder::new("cleared");
    let scene = folder.write("cube.toml", CUBE);
    souple(["run", &scene, "--quiet", "--frames", "0", "--out", &folder.at("out")]).ends(0);
    // a folder in the place of a file that is to be removed
    let path = folder.path().join("out/probes.csv");
    std::fs::remove_file(&path).expect("it is removed");
    std::fs::create_dir(&path).expect("a folder");
    let mut again = command();
    again.args(["run", &scene, "--quiet", "--out", &folder.at("out")]);
    let answer = Answer::of("again".to_owned(), again.output().expect("the program starts")).ends(1);
    assert!(answer.stderr.contains("probes.csv"), "{answer:#?}");
}

/// What cannot be written after the first step ends the run as failed, with its cause, and costs nothing else.
#[cfg(target_os = "linux")]
#[test]
fn a_frame_that_cannot_be_written_costs_no_report() {
    let folder = Folder::new("kept");
    let scene = folder.write("cube.toml", CUBE);
    let program = env!("CARGO_BIN_EXE_souple");
    // the folder of frames goes away while the run is on, at its tenth of many steps
    let script = format!(
        "{program} run {scene} --quiet --json --steps 100000 --frames 100000 --out out & run=$!; \
         until test -e out/frames/cube_0010.vtu; do sleep 0.01; done; mv out/frames out/gone; wait $run"
    );
    let output = std::process::Command::new("sh").args(["-c", &script]).current_dir(folder.path()).output();
    let answer = Answer::of(script, output.expect("a shell")).ends(1);
    assert!(answer.stderr.contains("error: after step") && answer.stderr.contains("frames"), "{answer:#?}");
    let told = answer.json();
    let text = std::fs::read_to_string(folder.path().join("out/report.json")).expect("a report");
    let written: Value = serde_json::from_str(&text).expect("JSON");
    for report in [&told, &written] {
        assert_eq!(report["status"], "failed");
        assert!(report["error"]["message"].to_string().contains("frames/cube"), "{report:#}");
        assert!(report["steps"].as_u64().is_some_and(|steps| steps >= 10));
    }
    let left = below(&folder, "out");
    for file in ["probes.csv", "place.svg", "last.png"] {
        assert!(left.contains(&file.to_owned()), "{file}: {left:?}");
    }
}

/// A command that does not fit ends the run where it stands, with all that was computed.
#[test]
fn a_command_that_does_not_fit_costs_no_report() {
    use souple::engine::{Command, Edit};
    use souple::run::{Control, Options, Status, run};

    let folder = Folder::new("late_edit");
    let scene = souple::scene::read_text("cube", CUBE, Path::new("."), &[]).expect("a scene");
    let out = folder.path().join("out");
    let edit = Edit::Pin { system: 0, block: 999_999 };
    let options = Options {
        out: Some(out.clone()),
        commands: vec![Command { period: 5, edit }],
        frames: Some(0),
        ..Options::default()
    };
    let outcome = run(scene, &options, &mut |_| Control::Continue).expect("a run");
    assert_eq!((outcome.report.status, outcome.report.steps), (Status::Failed, 5));
    let message = outcome.report.failure.expect("a cause").message();
    assert!(message.starts_with("after step 5: command before period 5"), "{message}");
    assert!(out.join("report.json").is_file() && out.join("probes.csv").is_file());
    assert_eq!(outcome.traces[0].times.len(), 6);
}

/// Two runs do not write into one folder; one that was killed leaves it free, and the next says what it replaces.
#[cfg(unix)]
#[test]
fn a_folder_belongs_to_one_run() {
    let folder = Folder::new("shared_folder");
    let scene = folder.write("cube.toml", CUBE);
    let out = folder.at("out");
    let mut long = command();
    long.args(["run", &scene, "--quiet", "--steps", "100000000", "--frames", "0", "--out", &out]);
    let mut child = long.spawn().expect("the program starts");
    while !folder.path().join("out/files.txt").is_file() {
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    let refused = souple(["run", &scene, "--quiet", "--out", &out]).ends(2);
    assert!(refused.stderr.contains("another run is writing into"), "{refused:#?}");
    child.kill().expect("the first run is killed");
    child.wait().expect("it has ended");
    souple(["run", &scene, "--quiet", "--frames", "0", "--out", &out]).ends(0);
    let again = souple(["run", &scene, "--frames", "0", "--out", &out]).ends(0);
    assert!(again.stderr.contains("files of an earlier run in"), "{again:#?}");
}
