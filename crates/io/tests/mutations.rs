//! Mesh files of every format with faults put in by machine: a mesh or an error, never a panic; what is read can be
//! written and read again.
//!
//! `SOUPLE_MUTATION_SECONDS=600 cargo test -p souple-io mutations` goes on for ten minutes.

use std::path::Path;

use souple_io::{FORMATS, Field, Format, Output, Shapes, read_dataset_bytes};
use souple_math::Vec3;
use souple_mesh::{ElementKind, Group, Mesh};

use crate::mutator::{Mutator, guard, repeat};
use souple_table::Entry;

/// A tetrahedron and a hexahedron with facets, a group and a field.
fn mesh() -> Mesh {
    let corners =
        [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1], [2, 0, 0]];
    let points = corners.map(|corner| Vec3::from_array(corner.map(f64::from))).to_vec();
    let mut mesh = Mesh::new(points, ElementKind::Hex8, (0..8).collect());
    mesh.push_cell(ElementKind::Tet4, &[1, 8, 2, 5]);
    mesh.push_facet(ElementKind::Tri3, &[1, 8, 5]);
    mesh.push_facet(ElementKind::Quad4, &[0, 3, 2, 1]);
    mesh.groups.insert("floor".into(), Group { points: vec![0, 8], cells: vec![1], facets: vec![1] });
    mesh
}

/// The tetrahedron alone, with a facet and a group.
fn tetrahedron() -> Mesh {
    let points = [[1, 0, 0], [2, 0, 0], [1, 1, 0], [1, 0, 1]];
    let points = points.map(|corner| Vec3::from_array(corner.map(f64::from))).to_vec();
    let mut mesh = Mesh::new(points, ElementKind::Tet4, (0..4).collect());
    mesh.push_facet(ElementKind::Tri3, &[0, 1, 3]);
    mesh.groups.insert("floor".into(), Group { points: vec![0], cells: vec![0], facets: vec![0] });
    mesh
}

/// Good files of a format: with and without what it may hold.
fn seeds(entry: &Entry<Format>) -> Vec<Vec<u8>> {
    let mesh = if entry.build.holds.shapes == Shapes::Tetrahedra { tetrahedron() } else { mesh() };
    let speeds = [Field::new("speed", 1, vec![0.5; mesh.points.len()])];
    let mut bare = mesh.clone();
    bare.groups.clear();
    bare.facet_blocks.clear();
    let outputs =
        [Output { point_fields: &speeds, ..Output::new(&mesh) }, Output::new(&mesh), Output::new(&bare)];
    let written = entry.build.write.into_iter().flat_map(|write| {
        outputs.iter().filter_map(move |output| {
            let mut content = Vec::new();
            write(output, &mut content).ok().map(|()| content)
        })
    });
    let own: &[&str] = match entry.name {
        "stl" => &[
            "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n",
        ],
        "obj" => &[
            "# a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvn 0 0 1\ng floor\nf 1//1 2//1 3//1\nf -1 -2 -3\nf 1/2/3 3 4\n",
        ],
        _ => &[],
    };
    let mut seeds: Vec<Vec<u8>> = own.iter().map(|text| text.as_bytes().to_vec()).chain(written).collect();
    if entry.name == "stl" {
        // binary: a header of 80 bytes, a count, facets of 50 bytes
        let mut binary = vec![b' '; 80];
        binary.extend(1_u32.to_le_bytes());
        binary.extend(
            [0.0_f32, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]
                .iter()
                .flat_map(|x| x.to_le_bytes()),
        );
        binary.extend([0, 0]);
        seeds.push(binary);
    }
    seeds
}

/// What is read refers to points that exist, validates without a panic, and comes back the same from its own writer.
fn read_and_write_back(format: &str, content: &[u8]) -> bool {
    let Ok(dataset) = read_dataset_bytes(format, content) else { return false };
    let mesh = &dataset.mesh;
    let mut nodes = mesh.cells().chain(mesh.facets()).flat_map(|cell| cell.nodes.iter());
    assert!(nodes.all(|node| (*node as usize) < mesh.points.len()));
    let mut validated = mesh.clone();
    if validated.validate().is_ok() {
        let _ = validated.conformity().messages(&validated);
    }
    let Some(write) = FORMATS.find(format).expect("a format of the table").build.write else { return true };
    let output = Output {
        point_fields: &dataset.point_fields,
        cell_fields: &dataset.cell_fields,
        ..Output::new(mesh)
    };
    output.check().expect("what was read can be written");
    let mut written = Vec::new();
    // a format may refuse names that it cannot hold
    if write(&output, &mut written).is_err() {
        return true;
    }
    let again = read_dataset_bytes(format, &written).expect("what was written can be read").mesh;
    let count = |mesh: &Mesh| (mesh.cell_count(), mesh.facet_count(), mesh.groups.len());
    match format {
        // OBJ drops points that only cells use; STL knows triangles by their corners, which may fall together when
        // they are rounded
        "obj" | "stl" | "stl_text" => {}
        // one group of each point, cell and facet is numbered
        "tetgen" => assert_eq!(
            (&again.points, &again.blocks, &again.facet_blocks),
            (&mesh.points, &mesh.blocks, &mesh.facet_blocks)
        ),
        _ => {
            assert_eq!(again.points, mesh.points);
            assert_eq!(count(&again), count(mesh));
        }
    }
    true
}

#[test]
fn mutated_mesh_files_are_read_or_refused() {
    let words: Vec<Vec<u8>> =
        include_str!("words.txt").lines().map(|word| word.as_bytes().to_vec()).collect();
    let seeds: Vec<(&str, Vec<Vec<u8>>)> = FORMATS
        .entries
        .iter()
        .filter(|entry| entry.build.read.is_some())
        .map(|entry| (entry.name, seeds(entry)))
        .collect();
    let mut read = 0;
    let cases = repeat(4000, |seed| {
        let (format, seeds) = &seeds[(seed % seeds.len() as u64) as usize];
        let content = Mutator::new(seed, words.clone()).mutated(seeds);
        guard(seed, &content, 5.0, || read += u64::from(read_and_write_back(format, &content)));
    });
    println!("{read} of {cases} mutated files are meshes");
    assert!(read > cases / 50, "{read} of {cases}");
}

/// Tables of particles: what is read has numbers, and a line for each.
#[test]
fn mutated_particles_are_read_or_refused() {
    let seeds: Vec<Vec<u8>> = [
        "x, y, z\n0, 0, 0\n1, 0.5, -2e-3\n",
        "x,y,z,radius\n0,0,0,0.1\n0.2,0,0,0.1\n",
        "radius, z, y, x, vx, vy, vz, from, until\n0.1, 0, 0, 0, 1, 0, 0, -inf, 2\n0.1, 0, 0, 1, 0, 0, 0, 2, inf\n",
    ]
    .map(|text| text.as_bytes().to_vec())
    .into();
    let words: Vec<Vec<u8>> = ["x", "y", "z", "radius", "vx", "vy", "vz", "from", "until", ",", "\n"]
        .map(|word| word.as_bytes().to_vec())
        .into();
    let mut read = 0;
    let cases = repeat(4000, |seed| {
        let content = Mutator::new(seed, words.clone()).mutated(&seeds);
        guard(seed, &content, 5.0, || {
            let Ok(rows) = souple_io::read_particle_bytes("mutated.csv", &content) else { return };
            assert!(rows.iter().all(|row| !row.position.x.is_nan() && !row.during[0].is_nan()));
            read += 1;
        });
    });
    println!("{read} of {cases} mutated tables are particles");
    assert!(read > cases / 50, "{read} of {cases}");
}

/// Lists of frames: what is read has finite times.
#[test]
fn mutated_series_are_read_or_refused() {
    let seeds: Vec<Vec<u8>> = [
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n\
         <DataSet timestep=\"0.0\" part=\"0\" file=\"a_0000.vtu\"/>\n\
         <DataSet timestep=\"0.1\" part=\"0\" file=\"a &amp; b.vtu\"/>\n</Collection>\n</VTKFile>\n",
        "<VTKFile><Collection><DataSet timestep='1e-3' file='x.vtu'></DataSet><!-- > --></Collection></VTKFile>",
    ]
    .map(|text| text.as_bytes().to_vec())
    .into();
    let words: Vec<Vec<u8>> =
        ["DataSet", "Collection", "VTKFile", "timestep", "file", "amp", "&#65;", "/>", "<!--", "?>"]
            .map(|word| word.as_bytes().to_vec())
            .into();
    let mut read = 0;
    let cases = repeat(4000, |seed| {
        let content = Mutator::new(seed, words.clone()).mutated(&seeds);
        guard(seed, &content, 5.0, || {
            let Ok(parts) = souple_io::read_series_bytes(Path::new("run/mutated.pvd"), &content) else {
                return;
            };
            assert!(!parts.is_empty() && parts.iter().all(|part| !part.frames.is_empty()));
            assert!(parts.iter().flat_map(|part| &part.frames).all(|(time, _)| time.is_finite()));
            read += 1;
        });
    });
    println!("{read} of {cases} mutated lists are series");
    assert!(read > cases / 50, "{read} of {cases}");
}
