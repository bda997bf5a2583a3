//! Sounds of runs: files that players know, and what is said of those that are too loud or silent.

use std::path::{Path, PathBuf};

use souple_run::{Control, Options, Outcome, Status};

/// A mass of 1 kg between two springs swings a hundred times in a second, by 1.6 mm.
const SCENE: &str = r#"
format = 1
[world]
period = 0.000125
[systems.main]
stepper = "t_simulation"
[networks.net.masses.ends]
positions = [[-1, 0, 0], [1, 0, 0]]
mass = 1
fixed = true
[networks.net.masses.free]
positions = [[0, 0, 0]]
mass = 1
velocity = [0, 0, 1]
[[networks.net.links]]
law = { name = "spring", stiffness = 2e5 }
along = [0, 0, 1]
reach = 1
[probes.up]
body = "net"
region = "free"
quantity = "displacement"
component = "z"
[probes.across]
body = "net"
region = "free"
quantity = "displacement"
component = "x"
[run]
duration = "0.1 s"
frames = 0
"#;

fn run(name: &str, sounds: &str) -> (Outcome, PathBuf) {
    let scene =
        souple_scene::read_text("net.toml", &format!("{SCENE}{sounds}"), Path::new("."), &[]).unwrap();
    let folder = std::env::temp_dir().join(format!("souple_sounds_{name}_{}", std::process::id()));
    let options = Options { out: Some(folder.clone()), ..Options::default() };
    (souple_run::run(scene, &options, &mut |_| Control::Continue).unwrap(), folder)
}

fn int16(bytes: &[u8]) -> Vec<f64> {
    let sample = |pair: &[u8]| f64::from(i16::from_le_bytes([pair[0], pair[1]])) / 32767.0;
    bytes[44..].chunks(2).map(sample).collect()
}

/// Samples are what the probe reads, first and last included, by the gain given; the loudest is at 0.9 without one.
#[test]
fn samples_are_what_probes_read() {
    let (outcome, folder) = run(
        "plain",
        "[sounds.given]\nprobes = [\"up\"]\ngain = 500\n[sounds.found]\nprobes = [\"up\", \"across\"]\n\
         [sounds.half]\nprobes = [\"up\"]\nevery = 2\nsamples = \"float32\"\n",
    );
    let read = |name: &str| std::fs::read(folder.join(name)).unwrap();
    let values = &outcome.traces.iter().find(|trace| trace.name == "up").unwrap().values;
    assert_eq!(values.len(), 801);
    let given = int16(&read("given.wav"));
    assert_eq!(given.len(), 801);
    for (sample, value) in given.iter().zip(values) {
        assert!((sample - 500.0 * value).abs() <= 0.5 / 32767.0 + 1e-12);
    }
    let found = int16(&read("found.wav"));
    assert!(found.iter().skip(1).step_by(2).all(|sample| *sample == 0.0), "nothing moves across");
    let loudest = found.iter().fold(0.0, |most: f64, sample| most.max(sample.abs()));
    assert!((loudest - 0.9).abs() <= 0.5 / 32767.0);
    // 401 floats behind 58 bytes, at 4 kHz
    let half = read("half.wav");
    assert_eq!((half.len(), &half[24..28]), (58 + 4 * 401, &4000_u32.to_le_bytes()[..]));
    assert!(outcome.report.warnings.iter().all(|warning| !warning.contains("sound")));
    std::fs::remove_dir_all(folder).unwrap();
}

/// A run that fails writes no sound, which would be scaled by what it failed of; one that is interrupted writes what there is, and says so.
#[test]
fn sounds_of_runs_that_do_not_end_are_told() {
    let sounds = "[sounds.heard]\nprobes = [\"up\"]\n";
    for (status, setting, words) in [
        (
            Status::Failed,
            Some("world.gravity=[0, \"1/max(0, 0.01 - t)\", 0]"),
            "sound `heard` is not written: the run failed at 0.0",
        ),
        (Status::Interrupted, None, "sound `heard` ends at 0.0"),
    ] {
        let settings: Vec<String> = setting.into_iter().map(str::to_owned).collect();
        let text = format!("{SCENE}{sounds}");
        let scene = souple_scene::read_text("net.toml", &text, Path::new("."), &settings).unwrap();
        let folder =
            std::env::temp_dir().join(format!("souple_sounds_{}_{}", status.as_str(), std::process::id()));
        let options = Options { out: Some(folder.clone()), ..Options::default() };
        let mut watch = |progress: &souple_run::Progress| {
            if setting.is_none() && progress.step == 20 { Control::Stop } else { Control::Continue }
        };
        let outcome = souple_run::run(scene, &options, &mut watch).unwrap();
        assert_eq!(outcome.report.status, status, "{:?}", outcome.report.failure);
        let warnings = &outcome.report.warnings;
        assert!(warnings.iter().any(|warning| warning.starts_with(words)), "{warnings:?}");
        assert_eq!(folder.join("heard.wav").exists(), status == Status::Interrupted);
        assert_eq!(outcome.report.sounds.len(), usize::from(status == Status::Interrupted));
        std::fs::remove_dir_all(folder).unwrap();
    }
}

/// What is beyond full scale is told, with a gain that would hold it; so is silence.
#[test]
fn loud_and_silent_sounds_are_told() {
    let (outcome, folder) = run(
        "loud",
        "[sounds.loud]\nprobes = [\"up\"]\ngain = 1000\n[sounds.silent]\nprobes = [\"across\"]\n",
    );
    let told = |words: &str| {
        let found = outcome.report.warnings.iter().find(|warning| warning.contains(words));
        found.unwrap_or_else(|| panic!("{words} in {:?}", outcome.report.warnings)).clone()
    };
    assert!(told("`silent` is silent").contains("nothing but zero"));
    let loud = told("`loud`");
    assert!(loud.contains("of 801 samples are beyond full scale") && loud.contains("a gain of"), "{loud}");
    let samples = int16(&std::fs::read(folder.join("loud.wav")).unwrap());
    assert!(samples.contains(&1.0) && samples.iter().all(|sample| sample.abs() <= 1.0));
    std::fs::remove_dir_all(folder).unwrap();
}
