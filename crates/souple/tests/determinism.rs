//! Equal bits: for any number of threads, across snapshots, in replays, with the checks of debug builds, on a scene of each
//! kind of model. On every shipped scene they are compared by the released program, in `tests/end_to_end`.

use serde_json::Value;

use crate::common::{CUBE, Folder, scenes, souple};

/// A scene of each kind of model and of each stepper.
const SCENES: &[&str] = &[
    "cantilever",
    "clay_bar",
    "cohesive_heap",
    "collision",
    "frames_spinning",
    "hand_on_cube",
    "levels_cube",
    "mixed_bar",
    "modal_spinning",
    "network_friction",
    "octree_cube",
    "particles_cube",
    "polynomial_spinning",
    "rigid_contacts",
    "skin_drop",
    "soft_block",
    "two_steppers",
];

/// Steps of each scene: an even number, so that there is a middle.
fn steps_of(name: &str) -> u64 {
    match name {
        // the balls meet after 300 steps: friction between them is part of what must be the same
        "collision" => 600,
        // statics, of which one step says all and the second starts from its end
        "cantilever" | "mixed_bar" => 2,
        _ => 6,
    }
}

fn scene(name: &str) -> String {
    scenes().join(name).display().to_string()
}

fn hashes(report: &Value) -> Vec<(u64, String)> {
    let list = report["hashes"].as_array().expect("hashes");
    list.iter()
        .map(|entry| {
            (entry["step"].as_u64().expect("a step"), entry["hash"].as_str().expect("a hash").to_owned())
        })
        .collect()
}

/// The same hash of every step with 1, 2 and 4 threads.
#[test]
fn threads_do_not_matter() {
    for name in SCENES {
        let (steps, path) = (steps_of(name).to_string(), scene(name));
        let with = |threads: &str| {
            let call = [
                "run",
                &path,
                "--json",
                "--quiet",
                "--steps",
                &steps,
                "--hash-every",
                "1",
                "--threads",
                threads,
            ];
            let report = souple(call).ends(0).json();
            assert_eq!(report["threads"].to_string(), threads);
            hashes(&report)
        };
        let single = with("1");
        assert_eq!(single.len() as u64, steps_of(name) + 1, "{name}");
        assert_ne!(single[0].1, single[1].1, "{name} does not move");
        for threads in ["2", "4"] {
            assert_eq!(single, with(threads), "{name} with {threads} threads");
        }
    }
}

/// A run stopped in the middle and resumed from its snapshot ends with the bits of the unbroken run, also with
/// another number of threads.
#[test]
fn snapshots_resume() {
    for name in SCENES {
        let folder = Folder::new("resume");
        let (steps, path) = (steps_of(name), scene(name));
        let out = folder.at("out");
        let (half, whole) = ((steps / 2).to_string(), steps.to_string());
        let unbroken =
            ["run", &path, "--json", "--quiet", "--steps", &whole, "--frames", "0", "--threads", "1"];
        let unbroken =
            souple(unbroken.into_iter().chain(["--out", &out, "--snapshot-every", &half])).ends(0).json();
        let snapshot = folder.at(&format!("out/snapshot_{:08}.souple", steps / 2));
        let resumed =
            ["run", &path, "--json", "--quiet", "--steps", &half, "--resume", &snapshot, "--threads", "2"];
        let resumed = souple(resumed).ends(0).json();
        let (unbroken, resumed) = (hashes(&unbroken), hashes(&resumed));
        assert_eq!(resumed.first().map(|first| first.0), Some(steps / 2), "{name}");
        assert_eq!(resumed.last(), unbroken.last(), "{name}");
    }
}

/// What was recorded replays bit for bit; a changed hash is found, and the first step that differs named.
#[test]
fn recordings_replay() {
    for name in SCENES {
        let folder = Folder::new("replay");
        let (steps, path) = (steps_of(name), scene(name));
        let recording = folder.at("run.json");
        let whole = steps.to_string();
        souple(["run", &path, "--quiet", "--steps", &whole, "--hash-every", "1", "--record", &recording])
            .ends(0);
        souple(["replay", &recording, "--verify", "--quiet"]).ends(0);

        let text = std::fs::read_to_string(&recording).expect("the recording");
        let mut document: Value = serde_json::from_str(&text).expect("a recording is JSON");
        let middle = steps as usize / 2;
        for entry in document["hashes"].as_array_mut().expect("hashes").iter_mut().skip(middle) {
            entry["hash"] = Value::from("0123456789abcdef");
        }
        let tampered = folder.write("tampered.json", document.to_string());
        let answer = souple(["replay", &tampered, "--verify", "--quiet"]).ends(1);
        assert!(
            answer.stderr.contains(&format!("differs at step {middle}, in none of its fields:")),
            "{name}: {answer:#?}"
        );
        let answer = souple(["replay", &tampered, "--verify", "--quiet", "--json"]).ends(1).json();
        assert_eq!(
            (&answer["same"], &answer["divergence"]["step"]),
            (&false.into(), &middle.into()),
            "{name}"
        );
    }
}

/// A recording holds the settings of its run: the replay is of the scene as it was changed.
#[test]
fn recordings_keep_settings() {
    let folder = Folder::new("settings");
    let scene = folder.write("cube.toml", CUBE);
    let recording = folder.at("run.json");
    let set = "bodies.cube.material.youngs_modulus=30 kPa";
    souple(["run", &scene, "--quiet", "--set", set, "--seed", "7", "--record", &recording]).ends(0);
    souple(["replay", &recording, "--verify", "--quiet"]).ends(0);
    let answer = souple(["replay", &recording, "--quiet", "--json"]).ends(0).json();
    assert_eq!((&answer["seed"], &answer["steps"]), (&7.into(), &10.into()));
    // the scene has changed on disk since: the recording plays its own, and says so
    folder.write("cube.toml", CUBE.replace("20 kPa", "21 kPa"));
    let answer = souple(["replay", &recording, "--verify", "--quiet"]).ends(0);
    assert!(answer.stderr.contains("cube.toml` has changed since"), "{answer:#?}");
}

/// A replay that has no state of a recorded step is no success: nothing was compared there.
#[test]
fn replays_compare_every_hash() {
    let folder = Folder::new("compared");
    let scene = folder.write("cube.toml", CUBE);
    let recording = folder.at("run.json");
    souple(["run", &scene, "--quiet", "--record", &recording]).ends(0);
    let text = std::fs::read_to_string(&recording).expect("the recording");
    let shortened = folder.write("shortened.json", text.replace("\"steps\": 10", "\"steps\": 5"));
    let answer = souple(["replay", &shortened, "--verify", "--quiet"]).ends(1);
    assert!(answer.stderr.contains("differs at step 10"), "{answer:#?}");
    let mut document: Value = serde_json::from_str(&text).expect("a recording is JSON");
    document["hashes"] = serde_json::json!([]);
    let empty = folder.write("empty.json", document.to_string());
    let answer = souple(["replay", &empty, "--verify", "--quiet"]).ends(2);
    assert!(answer.stderr.contains("nothing could be compared"), "{answer:#?}");
    // what begins in the middle cannot be played from the start
    let snapshots = ["run", &scene, "--quiet", "--out", &folder.at("out"), "--snapshot-every", "5"];
    souple(snapshots).ends(0);
    let snapshot = folder.at("out/snapshot_00000005.souple");
    souple(["run", &scene, "--quiet", "--resume", &snapshot, "--record", &recording]).ends(2);
}
