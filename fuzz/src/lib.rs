//! What the fuzz targets do.

pub mod law;

use std::path::Path;

use souple_formal::law::EnergyLaw;
use souple_formal::tape::{Part, Tape};
use souple_formal::{Condition, Formula, parse_quantity, parse_unit};
use souple_io::{FORMATS, NumberTable, Output, read_dataset_bytes, read_particle_bytes, read_series_bytes};
use souple_scene::PlanFile;
use souple_sweep::Study;

/// Reads a content; what is read must refer to points that exist, validate without a panic, and come back the
/// same from the format's own writer.
pub fn read_and_write_back(format: &str, content: &[u8]) {
    let Ok(dataset) = read_dataset_bytes(format, content) else { return };
    let mesh = &dataset.mesh;
    let mut nodes = mesh.cells().chain(mesh.facets()).flat_map(|cell| cell.nodes.iter());
    assert!(nodes.all(|node| (*node as usize) < mesh.points.len()));
    let _ = mesh.clone().validate();
    let Some(write) = FORMATS.find(format).expect("a format of the table").build.write else { return };
    let output = Output {
        point_fields: &dataset.point_fields,
        cell_fields: &dataset.cell_fields,
        ..Output::new(mesh)
    };
    output.check().expect("what was read can be written");
    let mut written = Vec::new();
    // a format may refuse names that it cannot hold
    if write(&output, &mut written).is_err() {
        return;
    }
    let again = read_dataset_bytes(format, &written).expect("what was written can be read");
    let count = |mesh: &souple_mesh::Mesh| (mesh.cell_count(), mesh.facet_count(), mesh.groups.len());
    // OBJ drops points that only cells use; STL knows triangles by their corners, which may fall together when they
    // are rounded; TetGen numbers one group of each point, cell and facet
    match format {
        "obj" | "stl" => {}
        "tetgen" => assert_eq!(
            (again.mesh.points, again.mesh.blocks, again.mesh.facet_blocks),
            (mesh.points.clone(), mesh.blocks.clone(), mesh.facet_blocks.clone())
        ),
        _ => {
            assert_eq!(again.mesh.points, mesh.points);
            assert_eq!(count(&again.mesh), count(mesh));
        }
    }
}

/// Reads a content as a scene, key by key; nothing is built, for a mesh may be as large as a text says.
pub fn read_scene(content: &[u8]) {
    let Ok(text) = std::str::from_utf8(content) else { return };
    // no folder: files that a text names are not looked for beside this program
    match souple_scene::read_spec("fuzzed.toml", text, Path::new("/nonexistent"), &[]) {
        Ok(_) => {}
        Err(errors) => {
            // what is said must be sayable, for people and for programs
            assert!(!errors.0.is_empty());
            let _ = (errors.to_string(), errors.to_json());
        }
    }
}

/// Reads a content as a list of frames.
pub fn read_series(content: &[u8]) {
    let Ok(parts) = read_series_bytes(Path::new("fuzzed.pvd"), content) else { return };
    assert!(!parts.is_empty() && parts.iter().all(|part| !part.frames.is_empty()));
    assert!(parts.iter().flat_map(|part| &part.frames).all(|(time, _)| time.is_finite()));
}

/// Reads a content as a study, what stands behind a line `--- table` as its table; each run has a value for each path.
pub fn read_study(content: &[u8]) {
    let Ok(text) = std::str::from_utf8(content) else { return };
    let (study, table) = text.split_once("\n--- table\n").unwrap_or((text, ""));
    let Ok(study) = Study::parse(Path::new("fuzzed.toml"), study, |_| Ok(table.to_owned())) else { return };
    let count = study.paths().count();
    assert!(study.runs.iter().all(|run| run.values.len() == count));
}

/// Reads a content as a table of numbers and as a plan of steps of 10 ms: each row has a number for each head, columns are found by their
/// names, and so are commands.
pub fn read_table(content: &[u8]) {
    let Ok(text) = std::str::from_utf8(content) else { return };
    match NumberTable::read(text, &["value"]) {
        Err(fault) => assert!(!fault.to_string().is_empty()),
        Ok(table) => {
            let columns = 0..table.heads.len();
            assert!(!columns.is_empty());
            for column in columns {
                let (name, found) = (table.name(column), table.column_of(table.name(column), 0));
                assert!(found.is_some_and(|first| first <= column && table.name(first) == name));
                let _ = table.unit(column);
            }
            let is_row = |numbers: &Vec<f64>| {
                let may_be = |(column, number): (usize, &f64)| {
                    number.is_finite() || (table.name(column) == "value" && number.is_infinite())
                };
                numbers.len() == table.heads.len() && numbers.iter().enumerate().all(may_be)
            };
            assert!(table.rows.iter().all(|(line, numbers)| *line > 1 && is_row(numbers)));
        }
    }
    let Ok(plan) = PlanFile::read(text, 0.01) else { return };
    for (_, name) in plan.names() {
        let Ok(column) = plan.column_of_commands(name) else { continue };
        assert!(plan.column(column).count() > 0 && plan.column(column).all(f64::is_finite));
    }
}

/// Reads a content as a table of particles and dresses them, where they are few.
pub fn dress_particles(content: &[u8]) {
    let Ok(rows) = read_particle_bytes("fuzzed.csv", content) else { return };
    let particles: Vec<_> = rows.iter().map(|row| (row.position, row.radius.unwrap_or(0.1))).collect();
    let radii = particles.iter().map(|(_, radius)| *radius);
    let (smallest, largest) = (radii.clone().fold(f64::INFINITY, f64::min), radii.fold(0.0, f64::max));
    // a few nodes for each particle: what is larger is the caller's wish
    if particles.len() > 100 || largest > 4.0 * smallest {
        return;
    }
    if let Ok(souple_skin::Dressed { surface, normals, .. }) = souple_skin::dress(&particles, smallest, 0.5) {
        assert_eq!(normals.len(), surface.points.len());
        let mut audit = souple_skin::polygons::Audit::default();
        audit.check(surface.points.len(), &surface.triangles).expect("a closed surface");
    }
}

/// Reads a content as a scene and steps it twice, where it has skins alone, in small domains.
pub fn step_skins(content: &[u8]) {
    let Ok(text) = std::str::from_utf8(content) else { return };
    let folder = Path::new("/nonexistent");
    let Ok(spec) = souple_scene::read_spec("fuzzed.toml", text, folder, &[]) else { return };
    let is_small = |skin: &souple_scene::spec::skin::SkinSpec| {
        skin.domain.is_some_and(|[low, high]| {
            let nodes: f64 =
                ((high - low) * skin.voxel.recip()).to_array().iter().map(|c| c + 16.0).product();
            nodes < 1e5
        })
    };
    if !spec.bodies.is_empty() || spec.skins.is_empty() || !spec.skins.iter().all(is_small) {
        return;
    }
    let Ok(scene) = souple_scene::read_text("fuzzed.toml", text, folder, &[]) else { return };
    let mut world = scene.model.start(scene.state);
    // a step may be refused, in words
    let _ = (0..2).try_for_each(|_| world.step().map_err(|error| error.to_string()));
}

/// Reads a content as all that a formula, a condition, a quantity or a unit may be, and computes with it.
pub fn read_formula(content: &[u8]) {
    let Ok(text) = std::str::from_utf8(content) else { return };
    let variables = ["x", "y", "z", "t"];
    let values = [0.1, 0.2, -0.3, 0.4];
    if let Ok(formula) = Formula::compile(text, &variables) {
        let _ = formula.evaluate(&values);
        for by in 0..variables.len() {
            let _ = formula.differentiate(&values, by);
        }
    }
    let _ = Formula::compile_vector::<3>(text, &variables);
    if let Ok(condition) = Condition::compile(text, &variables) {
        let _ = condition.holds(&values);
    }
    let _ = (parse_quantity(text), parse_unit(text));
}

/// Reads a content as a law and derives, tries and compiles it.
pub fn read_law(content: &[u8]) {
    if let Ok(text) = std::str::from_utf8(content) {
        law::try_law(text);
    }
}

/// Takes a content for a kept tape; one that is taken runs within its memory.
pub fn run_tape(mut content: &[u8]) {
    let Ok(tape) = Tape::restore(&mut content, [&[9], &[9]], &[9]) else { return };
    let mut memory = vec![0.5; tape.memory_len()];
    tape.prepare(&mut memory);
    tape.run_here(Part::All, 8, &mut memory);
}

/// Stress of each law of [`law::LAW_SEEDS`], as a kept tape.
pub fn tape_seeds() -> Vec<Vec<u8>> {
    let laws = law::LAW_SEEDS.iter().filter_map(|text| EnergyLaw::compile(&law::law_of_lines(text)).ok());
    laws.map(|law| {
        let mut bytes = Vec::new();
        Tape::compile(&law, &[law.stress]).store(&mut bytes);
        bytes
    })
    .collect()
}
