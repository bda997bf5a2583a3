//! Laws as text are kept between runs of the program, where the environment says, and change nothing.

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::common::{Answer, Folder, command};

const SCENE: &str = r#"
format = 1
[world]
period = "10 ms"
gravity = [0, -9.81, 0]
[bodies.bar]
mesh = { generate = "bar", size = [1, 0.1, 0.1], cells = [6, 1, 1], element = "hex8" }
material = { name = "hyperelastic", energy = "mu/2*(I1 - 3) - mu*log(J) + k/2*log(J)^2", parameters = { mu = "1 MPa", k = "2 MPa" }, density = 1000 }
[[bodies.bar.pins]]
region = { box = [[-1e-9, -1, -1], [1e-9, 1, 1]] }
[probes.stress]
body = "bar"
region = { nearest = [0, 0, 0] }
quantity = "von_mises"
"#;

/// Hashes and probes of a run whose laws are kept at `cache`.
fn run(folder: &Folder, cache: &str) -> [Value; 2] {
    let mut command = command();
    let arguments =
        ["run", &folder.at("scene.toml"), "--steps", "5", "--hash-every", "1", "--json", "--quiet"];
    command.args(arguments).args(["--out", &folder.at("out")]).env("SOUPLE_CACHE", cache);
    let output = command.output().expect("the program starts");
    let report = Answer::of(format!("souple run, laws kept at {cache}"), output).ends(0).json();
    ["hashes", "probes"].map(|part| report[part].clone())
}

fn files(folder: &str) -> Vec<Vec<u8>> {
    let Ok(entries) = fs::read_dir(folder) else { return Vec::new() };
    entries.map(|entry| fs::read(entry.expect("an entry").path()).expect("a file")).collect()
}

/// The first run keeps the law, the next one finds it, and with none kept all is the same to the bit; a damaged file is mended.
#[test]
fn a_run_with_a_kept_law_is_the_same() {
    let folder = Folder::new("kept_laws");
    fs::write(folder.at("scene.toml"), SCENE).expect("a scene");
    let (cache, laws) = (folder.at("cache"), folder.at("cache/laws"));
    let without = run(&folder, "off");
    assert!(without[0].as_array().is_some_and(|hashes| hashes.len() >= 5), "{without:?}");
    assert!(!Path::new(&cache).exists() && !Path::new("off").exists());
    assert_eq!(run(&folder, &cache), without);
    let kept = files(&laws);
    assert_eq!(kept.len(), 1);
    assert_eq!(run(&folder, &cache), without);
    assert_eq!(files(&laws), kept);
    let file = fs::read_dir(&laws).expect("the laws").next().expect("a law").expect("an entry").path();
    fs::write(&file, &kept[0][..kept[0].len() - 3]).expect("a file");
    assert_eq!(run(&folder, &cache), without);
    assert_eq!(files(&laws), kept, "it is mended");
}
