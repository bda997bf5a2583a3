//! What every format must do: read back what it wrote, refuse what it cannot hold.

use super::*;
use crate::testing::{TemporaryFolder, mixed_mesh, real_input, survives_faults};
use crate::{Facets, Field, Precision};

/// Content as the format of that name writes it.
fn written(format: &str, output: &Output<'_>) -> Vec<u8> {
    let mut bytes = Vec::new();
    (FORMATS.find(format).unwrap().build.write.unwrap())(output, &mut bytes).unwrap();
    bytes
}

fn read_back(format: &str, output: &Output<'_>) -> Dataset {
    read_dataset_bytes(format, &written(format, output)).unwrap()
}

const VOLUME_FORMATS: [&str; 5] = ["gmsh", "gmsh_binary", "gmsh_2", "vtu", "vtk"];

/// Points, cells, facets and groups come back as the same bits and in the same order.
#[test]
fn meshes_round_trip() {
    let mut mesh = mixed_mesh();
    mesh.groups.insert("empty".into(), Default::default());
    for format in VOLUME_FORMATS {
        assert_eq!(read_back(format, &Output::new(&mesh)).mesh, mesh, "{format}");
    }
}

/// The same without groups, without facets, and for a mesh of nothing but facets.
#[test]
fn plain_meshes_round_trip() {
    let whole = mixed_mesh();
    let bare = Mesh { groups: Default::default(), facet_blocks: Vec::new(), ..whole.clone() };
    let surface = Mesh { groups: Default::default(), blocks: Vec::new(), ..whole };
    for format in VOLUME_FORMATS {
        for mesh in [&bare, &surface] {
            assert_eq!(&read_back(format, &Output::new(mesh)).mesh, mesh, "{format}");
        }
    }
}

fn fields(mesh: &Mesh) -> (Vec<Field>, Vec<Field>) {
    let velocity = (0..3 * mesh.points.len()).map(|index| (index as f64).sqrt() - 2.0).collect();
    let stress = (0..9 * mesh.cell_count()).map(|index| 1e5 / (1.0 + index as f64)).collect();
    (vec![Field::new("velocity <m/s>", 3, velocity)], vec![Field::new("stress", 9, stress)])
}

#[test]
fn fields_round_trip() {
    let mesh = mixed_mesh();
    let (point_fields, cell_fields) = fields(&mesh);
    let output = Output {
        point_fields: &point_fields,
        cell_fields: &cell_fields,
        facets: Facets::LeftOut,
        ..Output::new(&mesh)
    };
    output.check().unwrap();
    for format in ["vtu", "vtk"] {
        let back = read_back(format, &output);
        assert_eq!((&back.point_fields, &back.cell_fields), (&point_fields, &cell_fields), "{format}");
        assert_eq!(back.mesh.facet_count(), 0);
    }
    // single precision: half a unit in the last place of 24 bits
    let single = read_back("vtu", &Output { precision: Precision::Single, ..output });
    for (read, wrote) in single.cell_fields[0].values.iter().zip(&cell_fields[0].values) {
        assert!((read - wrote).abs() <= wrote.abs() * 2f64.powi(-24));
    }
}

#[test]
fn other_positions_are_written() {
    let mesh = mixed_mesh();
    let moved: Vec<_> = mesh.points.iter().map(|point| *point * 2.0).collect();
    for format in VOLUME_FORMATS {
        let back = read_back(format, &Output { positions: Some(&moved), ..Output::new(&mesh) });
        assert_eq!(back.mesh.points, moved, "{format}");
    }
}

#[test]
fn faulty_output_is_refused() {
    let folder = TemporaryFolder::new("refused");
    let mesh = mixed_mesh();
    let short = [Field::new("speed", 1, vec![0.0; 3])];
    let refused = |format: &str, output: &Output<'_>| {
        let path = folder.path("file");
        let error = write_dataset_as(format, &path, output).unwrap_err();
        assert!(matches!(error, IoError::Request { .. }), "{format}: {error}");
        assert!(!path.exists());
    };
    let mut far = mesh.clone();
    far.groups.get_mut("tail").unwrap().cells.push(99);
    let mut lost = mesh.clone();
    lost.blocks[0].nodes[0] = 12;
    for format in VOLUME_FORMATS {
        refused(format, &Output { point_fields: &short, ..Output::new(&mesh) });
        refused(format, &Output { positions: Some(&mesh.points[1..]), ..Output::new(&mesh) });
        refused(format, &Output::new(&far));
        refused(format, &Output::new(&lost));
    }
    let mut twice = mesh.clone();
    twice.groups.get_mut("tail").unwrap().cells = vec![0];
    refused("gmsh_2", &Output::new(&twice));
    assert_eq!(read_back("gmsh", &Output::new(&twice)).mesh, twice);
    let mut quoted = mesh;
    quoted.groups.insert("a \"name\"".into(), Default::default());
    refused("gmsh", &Output::new(&quoted));
    assert_eq!(read_back("vtu", &Output::new(&quoted)).mesh, quoted);
    assert!(matches!(write_mesh(&folder.path("a.stl"), &quoted), Err(IoError::Unsupported { .. })));
}

/// Every format refuses nothing, garbage and another format's content.
#[test]
fn garbage_is_refused() {
    let mesh = mixed_mesh();
    let vtu = written("vtu", &Output::new(&mesh));
    let gmsh = written("gmsh", &Output::new(&mesh));
    for entry in FORMATS.entries {
        let other: &[u8] = if entry.build.extensions == ["vtu"] { &gmsh } else { &vtu };
        for garbage in [b"".as_slice(), b"\n\n", b"\xff\xfe\x00garbage \x80\n\x01", b"{\"a\": 1}", other] {
            assert!(read_mesh_bytes(entry.name, garbage).is_err(), "{} takes {garbage:?}", entry.name);
        }
    }
}

/// Cut anywhere before the last line, a file is refused, never taken for a small mesh.
#[test]
fn cuts_are_refused() {
    let mesh = mixed_mesh();
    for format in VOLUME_FORMATS {
        let bytes = written(format, &Output::new(&mesh));
        // legacy VTK has no end mark: a cut right behind a section, or within the last number, is not seen
        let last = match format {
            "vtk" => bytes.windows(10).position(|window| window == b"CELL_TYPES").unwrap(),
            _ => bytes.trim_ascii_end().len(),
        };
        for length in 0..last {
            assert!(read_mesh_bytes(format, &bytes[..length]).is_err(), "{format} cut at {length} of {last}");
        }
    }
}

#[test]
fn no_fault_panics() {
    let mesh = mixed_mesh();
    for format in VOLUME_FORMATS {
        let read = FORMATS.find(format).unwrap().build.read.unwrap();
        survives_faults(format, &written(format, &Output::new(&mesh)), read);
    }
}

#[test]
fn extension_and_content_choose() {
    let folder = TemporaryFolder::new("choose");
    let mesh = mixed_mesh();
    for name in ["a.msh", "a.MSH2", "a.vtu", "a.vtk"] {
        let path = folder.path(name);
        write_mesh(&path, &mesh).unwrap();
        assert_eq!(read_mesh(&path).unwrap(), (mesh.clone(), Vec::new()), "{name}");
    }
    // content rules where it is certain, and that is said
    let strange = folder.path("really_a_vtu.msh");
    std::fs::copy(folder.path("a.vtu"), &strange).unwrap();
    let (read, notes) = read_mesh(&strange).unwrap();
    assert_eq!((read, notes.len()), (mesh.clone(), 1));
    assert!(matches!(write_mesh(&folder.path("a.xyz"), &mesh), Err(IoError::Extension { .. })));
    assert!(matches!(read_mesh(&folder.path("absent.vtu")), Err(IoError::Read { .. })));
    assert!(matches!(read_mesh_bytes("vtx", b""), Err(IoError::UnknownFormat(_))));
}

/// The tetrahedra and hexahedra of the files as found.
#[test]
fn real_meshes() {
    for (name, format, points, cells) in [
        ("Armadillo_Tetra_4406.vtu", "vtu", 1446, 4406),
        ("liver.msh", "gmsh", 181, 596),
        ("cylinder_8x30x6.msh", "gmsh", 1446, 6750),
    ] {
        let Some(bytes) = real_input(name) else { return };
        let (mut mesh, notes) = read_mesh_bytes(format, &bytes).unwrap();
        assert_eq!((mesh.points.len(), mesh.cell_count()), (points, cells), "{name}: {notes:?}");
        mesh.validate().unwrap();
    }
}

/// A series lists its frames with their times, and each frame is a mesh.
#[test]
fn series_of_frames() {
    let folder = TemporaryFolder::new("series");
    let mesh = mixed_mesh();
    let mut series = crate::Series::new(folder.path(""), "run & hide");
    for time in [0.0, 0.1, 0.2] {
        let frame = series.push(time, &Output::new(&mesh)).unwrap();
        assert_eq!(read_mesh(&frame).unwrap().0, mesh);
    }
    let list = std::fs::read_to_string(series.path()).unwrap();
    assert!(list.contains("timestep=\"0.1\" part=\"0\" file=\"run &amp; hide_0001.vtu\""), "{list}");
    assert_eq!(list.matches("<DataSet").count(), series.len());
}
