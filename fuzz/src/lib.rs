//! What every fuzz target of a mesh reader does.

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
    // a format may refuse names that it cannot hold; OBJ drops points that only cells use
    if write(&output, &mut written).is_err() || format == "obj" {
        return;
    }
    let again = read_dataset_bytes(format, &written).expect("what was written can be read");
    assert_eq!(again.mesh.points, mesh.points);
    let count = |mesh: &souple_mesh::Mesh| (mesh.cell_count(), mesh.facet_count(), mesh.groups.len());
    assert_eq!(count(&again.mesh), count(mesh));
}
