//! Every shipped scene is in the table of the validation cases, and expectations are judged and reported. That scenes are valid
//! and run, and that what they expect is observed, is tested from outside, in `tests/end_to_end`.

use crate::common::{self, scene_names, scenes, souple};

/// The folder and the table of the validation cases hold the same scenes.
#[test]
fn every_scene_is_in_the_table() {
    let folders = scene_names();
    let mut table: Vec<&str> = souple::verify::scenes::SCENES.iter().map(|(name, _)| *name).collect();
    table.sort_unstable();
    assert_eq!(folders, table);
    for name in folders {
        let text = std::fs::read_to_string(scenes().join(&name).join("scene.toml"));
        let text = text.unwrap_or_else(|error| panic!("{name}/scene.toml: {error}"));
        assert_eq!(
            Some(text.as_str()),
            souple::verify::scenes::text(&name),
            "{name} is not what was compiled"
        );
    }
}

/// Each scene says what it shows, and expects something.
#[test]
fn every_scene_says_what_it_shows() {
    for (name, text) in souple::verify::scenes::SCENES {
        for wanted in ["title = ", "description = ", "shows = ", "[[expect]]", "[run]"] {
            assert!(text.contains(wanted), "{name} has no `{wanted}`");
        }
    }
}

/// An `expect` line that does not hold ends a whole run with status 1 and says so; a run cut before its moment
/// does not judge it.
#[test]
fn expectations_are_judged_at_their_moment() {
    let folder = common::Folder::new("expectations");
    let wrong = "[[expect]]\nprobe = \"place\"\ncomponent = \"y\"\nvalue = 7\ntolerance = 0.1\n";
    let scene = folder.write("wrong.toml", format!("{}{wrong}", common::CUBE));
    let whole = souple(["run", &scene, "--quiet"]).ends(1);
    assert!(whole.stderr.contains("not as expected: place"), "{whole:#?}");
    souple(["run", &scene, "--quiet", "--steps", "5"]).ends(0);
    let timed = folder.write("timed.toml", format!("{}{wrong}time = \"50 ms\"\n", common::CUBE));
    souple(["run", &timed, "--quiet", "--steps", "4"]).ends(0);
    souple(["run", &timed, "--quiet", "--steps", "5"]).ends(1);
    // a moment after the scene's end never comes; the line is not passed over in silence, not even by --quiet
    let never = folder.write("never.toml", format!("{}{wrong}time = \"1 s\"\n", common::CUBE));
    let answer = souple(["run", &never, "--quiet"]).ends(0);
    let told = "expectations: 0 of 1 hold, 1 not judged: the run ended at 0.1 s";
    assert!(answer.stderr.contains(told), "{answer:#?}");
}

/// The report holds each expectation with what became of it; a changed scene may fail them, unless it must not.
#[test]
fn expectations_are_reported() {
    let folder = common::Folder::new("reported");
    let line = |rest: &str| format!("[[expect]]\nprobe = \"place\"\ncomponent = \"y\"\n{rest}\n");
    let text =
        format!("{}{}{}", common::CUBE, line("min = 0.44\nmax = 0.5"), line("max = 2\ntime = \"1 s\""));
    let scene = folder.write("scene.toml", text);
    let out = folder.at("out");
    let report = souple(["run", &scene, "--json", "--quiet", "--out", &out]).ends(0).json();
    let expectations = report["expectations"].as_array().expect("a list");
    assert_eq!(expectations.len(), 2);
    assert_eq!(
        (&expectations[0]["status"], &expectations[1]["status"]),
        (&"holds".into(), &"not judged".into())
    );
    // backward Euler falls h² g n (n + 1)/2 from 0.5
    let fallen = 0.5 - 1e-4 * 9.81 * 55.0;
    assert!(expectations[0]["value"].as_f64().is_some_and(|value| (value - fallen).abs() < 1e-9));
    assert!(expectations[1]["value"].is_null() && expectations[1]["reason"] == "the run ended at 0.1 s");
    let told = std::fs::read_to_string(folder.path().join("out/expect.txt")).expect("expect.txt");
    assert!(told.starts_with("1 of 2 hold, 1 not judged: the run ended at 0.1 s\nholds "), "{told}");
    let up = ["run", &scene, "--quiet", "--set", "world.gravity=[0,9.81,0]"];
    let answer = souple(up).ends(0);
    assert!(answer.stderr.contains("warning: not as expected: place.y"), "{answer:#?}");
    souple(up.iter().chain(&["--expect", "strict"])).ends(1);
    souple(["run", &scene, "--quiet", "--expect", "warn"]).ends(0);
}
