//! Writes small good files of every format for the fuzzer to start from: `seeds FOLDER` fills `FOLDER/<target>`.

use std::path::Path;

use souple_io::{FORMATS, Field, Output, write_dataset_as};
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
    for entry in FORMATS.entries.iter().filter(|entry| entry.build.write.is_some()) {
        let target = entry.name.split('_').next().unwrap_or(entry.name);
        let place = Path::new(&folder).join(target);
        std::fs::create_dir_all(&place)?;
        let output = if target == "gmsh" { Output { point_fields: &[], ..output } } else { output };
        write_dataset_as(entry.name, &place.join(format!("seed_{}", entry.name)), &output)?;
    }
    Ok(())
}
