//! What the fuzz targets do.

use std::path::Path;

use souple_formal::{Condition, Formula, parse_quantity, parse_unit};
use souple_io::{FORMATS, Output, read_dataset_bytes};

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
