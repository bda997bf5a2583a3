//! Scenes with faults put in by machine: each gives a scene or a diagnostic, never a panic, and none takes long.
//!
//! `SOUPLE_MUTATION_SECONDS=600 cargo test -p souple-scene --test mutations` goes on for ten minutes.

#[path = "../../../fuzz/src/mutator.rs"]
mod mutator;

use std::path::{Path, PathBuf};

use mutator::{Mutator, guard, repeat};
use souple_scene::spec::mesh::MeshSpec;
use souple_scene::{Spec, read_spec, read_text};
use souple_table::Value;

fn here() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// The shipped scenes, the faulty ones, and one that uses most keys, each cell count brought down.
fn seeds() -> Vec<Vec<u8>> {
    let mut paths: Vec<PathBuf> = Vec::new();
    for folder in ["../../scenes", "tests/faults"] {
        let entries = std::fs::read_dir(here().join(folder)).expect("a folder of scenes");
        for entry in entries.map(|entry| entry.expect("an entry").path()) {
            paths.push(if entry.is_dir() { entry.join("scene.toml") } else { entry });
        }
    }
    paths.sort();
    let read = |path: &PathBuf| std::fs::read_to_string(path).expect("a scene");
    let mut texts: Vec<String> = paths.iter().map(read).collect();
    texts.push(include_str!("everything.toml").to_owned());
    texts.iter().map(|text| small(text).into_bytes()).collect()
}

/// A text whose meshes are of one cell each way.
fn small(text: &str) -> String {
    let shrunk =
        text.lines().map(|line| match line.find("cells = [").filter(|_| line.contains("generate")) {
            Some(at) => {
                let end = line[at..].find(']').map_or(line.len(), |end| at + end + 1);
                format!("{}cells = [1, 1, 1]{}\n", &line[..at], &line[end..])
            }
            None => format!("{line}\n"),
        });
    shrunk.collect()
}

/// All keys and names of the scene format, out of its schema.
fn words() -> Vec<Vec<u8>> {
    fn collect(value: &serde_json::Value, words: &mut Vec<String>) {
        match value {
            serde_json::Value::Object(map) => {
                if let Some(properties) = map.get("properties").and_then(|value| value.as_object()) {
                    words.extend(properties.keys().cloned());
                }
                for key in ["const", "enum"] {
                    match map.get(key) {
                        Some(serde_json::Value::String(word)) => words.push(word.clone()),
                        Some(serde_json::Value::Array(list)) => {
                            words.extend(list.iter().filter_map(|word| word.as_str().map(str::to_owned)));
                        }
                        _ => {}
                    }
                }
                map.values().for_each(|value| collect(value, words));
            }
            serde_json::Value::Array(list) => list.iter().for_each(|value| collect(value, words)),
            _ => {}
        }
    }
    let mut words = Vec::new();
    collect(&souple_scene::schema(), &mut words);
    words.sort();
    words.dedup();
    assert!(words.len() > 100, "{words:?}");
    words.into_iter().map(String::into_bytes).collect()
}

/// Whether all meshes of a scene are generated and of a few cells.
fn is_tiny(spec: &Spec) -> bool {
    let count = |mesh: &MeshSpec| match mesh {
        MeshSpec::Generated(chosen) => match chosen.values.get("cells") {
            Some(Value::Vector(cells)) => cells.iter().product(),
            Some(Value::Integer(cells)) => (cells as f64).powi(3),
            _ => f64::INFINITY,
        },
        MeshSpec::File { .. } | MeshSpec::Shape { .. } | MeshSpec::Filled { .. } => f64::INFINITY,
    };
    let cells: f64 = spec.bodies.iter().map(|body| body.mesh.as_ref().map_or(f64::INFINITY, count)).sum();
    cells <= 64.0
}

/// Keys, values and their readers: three thousand mutated texts.
#[test]
fn mutated_scenes_are_read_or_refused() {
    let (seeds, words) = (seeds(), words());
    let folder = here().join("tests/faults");
    let mut read = 0;
    let cases = repeat(3000, |seed| {
        let content = Mutator::new(seed, words.clone()).mutated(&seeds);
        let Ok(text) = std::str::from_utf8(&content) else { return };
        guard(seed, &content, 5.0, || {
            read += u64::from(read_spec("mutated.toml", text, &folder, &[]).is_ok());
        });
    });
    println!("{read} of {cases} mutated texts are scenes");
    // a mutator whose texts were all refused at the first glance would prove little
    assert!(read > cases / 50, "{read} of {cases}");
}

/// Models, states and probes of those mutated texts whose meshes are tiny.
#[test]
fn mutated_scenes_compile_or_are_refused() {
    let folder = here().join("tests/faults");
    let is_good = |seed: &Vec<u8>| {
        let text = String::from_utf8_lossy(seed);
        read_spec("seed.toml", &text, &folder, &[]).is_ok_and(|spec| is_tiny(&spec))
    };
    let (mut seeds, words) = (seeds(), words());
    seeds.retain(is_good);
    assert!(seeds.len() > 10, "{} seeds", seeds.len());
    let (mut compiled, mut tried) = (0, 0);
    let cases = repeat(1500, |seed| {
        // other seeds than those of the reader
        let content = Mutator::new(seed ^ (1 << 40), words.clone()).mutated(&seeds);
        let Ok(text) = std::str::from_utf8(&content) else { return };
        guard(seed, &content, 20.0, || {
            if !read_spec("mutated.toml", text, &folder, &[]).is_ok_and(|spec| is_tiny(&spec)) {
                return;
            }
            tried += 1;
            let Ok(scene) = read_text("mutated.toml", text, &folder, &[]) else { return };
            compiled += 1;
            let mut world = scene.model.start(scene.state);
            for probe in &scene.probes {
                let _ = probe.measure(&mut world);
            }
        });
    });
    println!("{compiled} of {tried} tiny scenes out of {cases} mutated texts compile");
    assert!(compiled > cases / 50, "{compiled} of {cases}");
}

/// Values set from the command line: paths and values mutated.
#[test]
fn mutated_overrides_are_met_or_refused() {
    let text = small(include_str!("everything.toml"));
    let seeds: Vec<Vec<u8>> = [
        "bodies.soft.material.youngs_modulus=20 kPa",
        "world.period=5ms",
        "bodies.soft.pins[0].axes=xy",
        "probes.pull.region={ nearest = [1, 0, 0] }",
        "parameters.load=3",
        "systems.main.stepper.name=static",
    ]
    .map(|text| text.as_bytes().to_vec())
    .into();
    let words = words();
    let folder = here();
    let cases = repeat(1000, |seed| {
        let content = Mutator::new(seed, words.clone()).mutated(&seeds);
        let Ok(setting) = std::str::from_utf8(&content) else { return };
        guard(seed, &content, 5.0, || {
            let _ = read_spec("everything.toml", &text, Path::new(&folder), &[setting.to_owned()]);
        });
    });
    println!("{cases} mutated overrides");
}

/// The seed that uses most keys is a scene.
#[test]
fn the_richest_seed_is_valid() {
    let scene = read_text("everything.toml", include_str!("everything.toml"), &here(), &[]);
    let scene = scene.unwrap_or_else(|errors| panic!("{errors}"));
    assert!(scene.probes.len() > 10 && scene.bodies.len() == 3);
}
