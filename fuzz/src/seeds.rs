//! Writes what the fuzzer starts from: `seeds FOLDER` fills `FOLDER/<target>` with small good files of every format, with
//! the shipped scenes and the faulty ones, and writes the keys of scenes to `dictionaries/scene`, the words of laws to `dictionaries/law`.

use std::path::Path;

use souple_formal::FUNCTIONS;
use souple_formal::law::{LAW_FUNCTIONS, QUANTITIES};
use souple_io::{FORMATS, Field, Output, write_file};
use souple_math::Vec3;
use souple_mesh::{ElementKind, Group, Mesh};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::env::args().nth(1).ok_or("expected a folder")?;
    let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(Vec3::from_array);
    let mut mesh = Mesh::new(points.to_vec(), ElementKind::Tet4, vec![0, 1, 2, 3]);
    mesh.push_facet(ElementKind::Tri3, &[0, 2, 1]);
    mesh.groups.insert("floor".into(), Group { points: vec![0], cells: vec![0], facets: vec![0] });
    let fields = [Field::new("speed", 1, vec![0.0, 1.0, 2.0, 3.0])];
    let output = Output { point_fields: &fields, ..Output::new(&mesh) };
    for entry in FORMATS.entries.iter().filter(|entry| entry.build.read.is_some()) {
        let target = entry.name.split('_').next().unwrap_or(entry.name);
        let place = Path::new(&folder).join(target);
        std::fs::create_dir_all(&place)?;
        let output = if target == "gmsh" { Output { point_fields: &[], ..output } } else { output };
        let Some(write) = entry.build.write else { continue };
        // in memory: formats of several files are fuzzed joined
        let mut content = Vec::new();
        write(&output, &mut content)?;
        write_file(&place.join(format!("seed_{}", entry.name)), |out| out.write_all(&content))?;
    }
    copy_scenes(&Path::new(&folder).join("scene"))?;
    copy_scenes(&Path::new(&folder).join("skin"))?;
    let particles = Path::new(&folder).join("particles");
    std::fs::create_dir_all(&particles)?;
    std::fs::write(particles.join("columns"), "x, y, z, radius, from\n0, 0, 0, 0.1, -1\n0.2, 0, 0, 0.1, 0\n")?;
    let series = Path::new(&folder).join("series");
    std::fs::create_dir_all(&series)?;
    souple_io::Series::new(&series, "frames").push(0.5, &Output::new(&mesh))?;
    // the frame itself is no list
    std::fs::remove_file(series.join("frames_0000.vtu"))?;
    let studies = Path::new(&folder).join("study");
    std::fs::create_dir_all(&studies)?;
    let vary = "scene = \"x.toml\"\nsteps = 20\n[vary]\n\"a.b\" = [1, 2.5]\nc = [\"tet4\", [1, 2]]\n\
                [graphs.g]\nx = \"a.b\"\ny = \"tip.y\"\nlines = \"c\"\nlogarithmic = \"xy\"\n";
    std::fs::write(studies.join("vary"), vary)?;
    let table = "scene = \"x.toml\"\ntable = \"runs.csv\"\n--- table\na.b,c\n1,\"[1, 2]\"\n5 kPa,tet4\n";
    std::fs::write(studies.join("table"), table)?;
    let tables = Path::new(&folder).join("table");
    std::fs::create_dir_all(&tables)?;
    std::fs::write(tables.join("plan"), "time [s],n.drive [N],\"a, b\" [m]\n0,1,2\n0.01,-3,4e-5\n")?;
    std::fs::write(tables.join("value"), "x [m],value\n0,inf\n\n1,2.5\n")?;
    write_formulas(&Path::new(&folder).join("formula"))?;
    let laws = Path::new(&folder).join("law");
    std::fs::create_dir_all(&laws)?;
    for (index, law) in souple_fuzz::law::LAW_SEEDS.iter().enumerate() {
        std::fs::write(laws.join(index.to_string()), law)?;
    }
    let tapes = Path::new(&folder).join("tape");
    std::fs::create_dir_all(&tapes)?;
    for (index, bytes) in souple_fuzz::tape_seeds().into_iter().enumerate() {
        std::fs::write(tapes.join(index.to_string()), bytes)?;
    }
    let mut words = Vec::new();
    collect_words(&souple_scene::schema(), &mut words);
    words.sort();
    words.dedup();
    let lines: String = words.iter().map(|word| format!("{word:?}\n")).collect();
    std::fs::write(Path::new("dictionaries").join("scene"), lines)?;
    let words = QUANTITIES.iter().chain(LAW_FUNCTIONS).map(|word| word.name).chain(FUNCTIONS.iter().map(|entry| entry.name));
    let lines: String = words.map(|word| format!("{word:?}\n")).collect();
    std::fs::write(Path::new("dictionaries").join("law"), lines)?;
    Ok(())
}

/// All scenes of the repository, from its folder `fuzz`.
fn copy_scenes(place: &Path) -> std::io::Result<()> {
    std::fs::create_dir_all(place)?;
    for folder in ["../scenes", "../crates/scene/tests", "../crates/scene/tests/faults"] {
        for entry in std::fs::read_dir(folder)? {
            let path = entry?.path();
            let (name, file) = match path.is_dir() {
                true => (path.file_name().map(ToOwned::to_owned), path.join("scene.toml")),
                false => (path.file_stem().map(ToOwned::to_owned), path),
            };
            if let Some(name) = name.filter(|_| file.extension().is_some_and(|e| e == "toml") && file.exists()) {
                std::fs::copy(&file, place.join(name))?;
            }
        }
    }
    Ok(())
}

fn write_formulas(place: &Path) -> std::io::Result<()> {
    std::fs::create_dir_all(place)?;
    let formulas = ["100 * sin(2 * pi * t) + 0 * x", "[0, -10 * exp(-t), max(x, y)^2]", "x > 0.5 and (y < z or not (t >= 1))", "10 kPa", "1.5e-3 kg m^2/s"];
    formulas.iter().enumerate().try_for_each(|(index, text)| std::fs::write(place.join(index.to_string()), text))
}

/// All keys of a JSON Schema and all words that they may hold.
fn collect_words(schema: &serde_json::Value, words: &mut Vec<String>) {
    match schema {
        serde_json::Value::Object(map) => {
            if let Some(properties) = map.get("properties").and_then(|value| value.as_object()) {
                words.extend(properties.keys().cloned());
            }
            let texts = ["const", "enum"].into_iter().filter_map(|key| map.get(key));
            let single = |value: &serde_json::Value| value.as_str().map(str::to_owned);
            for text in texts {
                words.extend(single(text));
                words.extend(text.as_array().into_iter().flatten().filter_map(single));
            }
            map.values().for_each(|value| collect_words(value, words));
        }
        serde_json::Value::Array(items) => items.iter().for_each(|item| collect_words(item, words)),
        _ => {}
    }
}
