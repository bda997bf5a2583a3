//! Scenes with faults put in by machine: each gives a scene or a diagnostic, never a panic, and none takes long.
//!
//! `SOUPLE_MUTATION_SECONDS=600 cargo test -p souple-scene mutations` goes on for ten minutes.

#[path = "../../../fuzz/src/mutator.rs"]
mod mutator;

use std::path::{Path, PathBuf};

use mutator::{Mutator, guard, repeat};
use souple_scene::spec::mesh::MeshSpec;
use souple_scene::spec::skin::SkinSpec;
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
        MeshSpec::File { .. } | MeshSpec::Shape { .. } | MeshSpec::Filled { .. } | MeshSpec::Tissue(_) => {
            f64::INFINITY
        }
    };
    // skins are stepped by a test of their own
    if !spec.skins.is_empty() {
        return false;
    }
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

/// Whether a scene has skins alone, whose domains have a few thousand nodes.
fn has_small_skins(spec: &Spec) -> bool {
    let is_small = |skin: &SkinSpec| {
        skin.domain.is_some_and(|[low, high]| {
            let nodes: f64 =
                ((high - low) * skin.voxel.recip()).to_array().iter().map(|c| c + 16.0).product();
            nodes < 5e4
        })
    };
    spec.bodies.is_empty() && !spec.skins.is_empty() && spec.skins.iter().all(is_small)
}

/// Skins start, step and split, or say why not, whatever their targets, terms and times are.
#[test]
fn mutated_skins_step_or_say_why() {
    let folder = here().join("tests/faults");
    let domain = "domain = [[-1, -1, -1], [1, 1, 1]]\nvoxel = 0.25";
    let seeds: Vec<Vec<u8>> = [
        format!("format = 1\n[world]\nperiod = \"10 ms\"\n[skins.a]\n{domain}\nparts = [{{ part = \"point\", at = [0.2, 0, 0], radius = 0.5 }}, {{ part = \"segment\", from = [0, 0, 0], to = [0, 0.3, 0], radius = 0.3, combine = \"union\", warps = [{{ warp = \"twist\", rate = 2 }}] }}]\nterms = [{{ term = \"attraction\", strength = 2 }}, {{ term = \"tension\", strength = 0.01 }}]\n"),
        format!("format = 1\n[world]\nperiod = \"10 ms\"\n[skins.a]\n{domain}\nstart = [{{ part = \"formula\", formula = \"0.7 - sqrt(x^2 + y^2 + z^2)\", low = [-1, -1, -1], high = [1, 1, 1] }}]\nterms = [{{ term = \"constant_volume\", rate = 4 }}, {{ term = \"constant_area\", rate = 1, area = \"6 + sin(t)\" }}, {{ term = \"pressure\", speed = \"0.1*t\" }}, {{ term = \"speed\", formula = \"x*y - volume\" }}]\n"),
        format!("format = 1\n[world]\nperiod = \"10 ms\"\n[skins.a]\n{domain}\nparts = [{{ part = \"shape\", shape = \"torus\", scale = 1, during = [-1, 0.01] }}, {{ part = \"point\", at = [0, 0, 0], radius = 0.5, during = [0.01, 9], motion = [\"t\", 0, 0] }}]\nterms = [{{ term = \"attraction\", strength = 2 }}]\n"),
    ]
    .map(String::into_bytes)
    .into();
    let words = words();
    let (mut stepped, mut tried) = (0, 0);
    let cases = repeat(600, |seed| {
        let content = Mutator::new(seed ^ (1 << 41), words.clone()).mutated(&seeds);
        let Ok(text) = std::str::from_utf8(&content) else { return };
        guard(seed, &content, 60.0, || {
            if !read_spec("mutated.toml", text, &folder, &[]).is_ok_and(|spec| has_small_skins(&spec)) {
                return;
            }
            tried += 1;
            let Ok(scene) = read_text("mutated.toml", text, &folder, &[]) else { return };
            let mut world = scene.model.start(scene.state);
            stepped += u64::from((0..2).all(|_| world.step().is_ok()));
        });
    });
    println!("{stepped} of {tried} small skins out of {cases} mutated texts step");
    assert!(stepped > cases / 50, "{stepped} of {cases}");
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
