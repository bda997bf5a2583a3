//! The released program from outside: every shipped scene is valid, runs, keeps what it promises, and repeats its bits.

mod program;

use std::path::Path;

use program::{Run, scenes, scratch, souple};
use serde_json::Value;

/// Steps compared bit for bit; a snapshot is taken in their middle.
const STEPS: u64 = 20;

/// What is legal and doubtful in a scene, and said.
const WARNS: &[(&str, &str)] = &[
    ("fibre_tube", "inverted elements have no energy"),
    ("half_turn_two_meshes", "32 quadrilateral faces"),
    ("mixed_beam", "32 quadrilateral faces"),
    ("octree_rod", "nearly incompressible"),
    ("octree_rods", "`bodies.rod.material`"),
    ("octree_rods", "`bodies.together.material`"),
    ("rubber_as_text", "inverted elements have no energy"),
    ("tissues", "inverted elements have no energy"),
    ("tissues", "the stiffness at rest jumps"),
    ("two_slopes", "turned inside out is at rest too"),
];

/// The warnings of a scene are those that it is known for.
fn assert_warnings(name: &str, warnings: &Value) {
    let said: Vec<&str> =
        warnings.as_array().into_iter().flatten().filter_map(|text| text.as_str()).collect();
    let known: Vec<&str> = WARNS.iter().filter(|(scene, _)| *scene == name).map(|(_, text)| *text).collect();
    let fits = said.len() == known.len() && said.iter().zip(&known).all(|(said, known)| said.contains(known));
    assert!(fits, "{name} warns {said:?}");
}

/// Each scene is valid, and warns of nothing but what it is known for.
#[test]
fn every_scene_is_valid() {
    for scene in scenes() {
        let answer = souple(&["check", &format!("scenes/{scene}"), "--json"]);
        assert_eq!(answer.status, Some(0), "{scene}: {}", answer.errors);
        let document = answer.json();
        assert_eq!(document["valid"], true, "{scene}");
        assert_warnings(&scene, &document["warnings"]);
    }
}

/// Every scene ends with status 0 (its `expect` lines hold), finite energies and probes, and complete files.
#[test]
fn every_scene_runs() {
    let folder = scratch("every_scene_runs");
    for scene in scenes() {
        let out = folder.join(&scene);
        let run = souple(&[
            "run",
            &format!("scenes/{scene}"),
            "--out",
            &out.to_string_lossy(),
            "--json",
            "--quiet",
        ]);
        assert_eq!(run.status, Some(0), "{scene}: {}", run.errors);
        let report = run.json();
        assert_eq!(report["status"], "done", "{scene}");
        let expectations = report["expectations"].as_array().expect("the report has expectations");
        // of a whole run none is left without a judgement
        let hold = expectations.iter().all(|expectation| expectation["status"] == "holds");
        assert!(!expectations.is_empty() && hold, "{scene}: {expectations:#?}");
        for part in ["energy", "momentum", "probes", "counts", "stages_ms", "solver"] {
            assert_finite(&format!("{scene}: {part}"), &report[part]);
        }
        let written: Value =
            serde_json::from_str(&read(&out.join("report.json"))).expect("report.json is JSON");
        assert_eq!(written["hashes"], report["hashes"], "{scene}: report.json is not the report printed");
        assert!(read(&out.join("probes.csv")).lines().count() > 1, "{scene}: no rows in probes.csv");
    }
}

/// All numbers below a value; `null` stands for one that is not finite, but for the frequency of what does not swing.
fn assert_finite(name: &str, value: &Value) {
    match value {
        Value::Null => panic!("{name} is not finite"),
        Value::Array(list) => list.iter().for_each(|value| assert_finite(name, value)),
        Value::Object(object) => {
            let numbers = object.iter().filter(|(key, _)| *key != "frequency");
            numbers.for_each(|(key, value)| assert_finite(&format!("{name}.{key}"), value));
        }
        _ => {}
    }
}

/// The bits of a state do not depend on the number of threads, nor on a stop between two steps, and come again when
/// a recording is replayed.
#[test]
fn every_scene_repeats_its_bits() {
    let folder = scratch("every_scene_repeats_its_bits");
    for scene in scenes() {
        let (out, record) = (folder.join(&scene), folder.join(format!("{scene}.recording")));
        let (out, record) = (out.to_string_lossy(), record.to_string_lossy());
        let path = format!("scenes/{scene}");
        let steps = STEPS.to_string();
        let half = (STEPS / 2).to_string();
        let run =
            |more: &[&str]| souple(&[&["run", &path, "--json", "--quiet", "--frames", "0"], more].concat());

        let writes = ["--out", &out, "--record", &record, "--snapshot-every", &half];
        let one = run(&[&["--steps", &steps, "--threads", "1", "--hash-every", "5"][..], &writes].concat());
        let four = run(&["--steps", &steps, "--threads", "4", "--hash-every", "5"]);
        let hashes = hashes_of(&scene, &one);
        assert!(hashes.len() > 3, "{scene}: {hashes:?}");
        assert_eq!(hashes, hashes_of(&scene, &four), "{scene}: four threads give other bits than one");

        let snapshot = Path::new(&*out).join(format!("snapshot_{:08}.souple", STEPS / 2));
        let resumed = run(&["--steps", &half, "--threads", "2", "--resume", &snapshot.to_string_lossy()]);
        let resumed = hashes_of(&scene, &resumed);
        assert_eq!(resumed.last(), hashes.last(), "{scene}: resumed from a snapshot it ends with other bits");

        let replayed = souple(&["replay", &record, "--verify", "--quiet"]);
        assert_eq!(replayed.status, Some(0), "{scene}: {}", replayed.errors);
    }
}

/// `(step, hash)` of a run that was not asked to meet its expectations, since it stops early.
fn hashes_of(scene: &str, run: &Run) -> Vec<(u64, String)> {
    let report = run.json();
    assert_eq!(report["status"], "done", "{scene}: {}", run.errors);
    let hashes = report["hashes"].as_array().expect("the report has hashes");
    hashes
        .iter()
        .map(|entry| {
            (
                entry["step"].as_u64().unwrap_or(u64::MAX),
                entry["hash"].as_str().unwrap_or_default().to_owned(),
            )
        })
        .collect()
}

fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}
