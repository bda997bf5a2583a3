//! What every format must do: read back what it wrote, refuse what it cannot hold.

use super::*;
use souple_math::Vec3;
use souple_mesh::ElementKind;

use crate::testing::{
    TemporaryFolder, mixed_mesh, quadratic_mesh, real_input, surface_mesh, survives_faults, tetrahedra_mesh,
};
use crate::{Digits, Facets, Field, HeldFields, HeldGroups, Precision, Shapes};

/// Content as the format of that name writes it.
fn written(format: &str, output: &Output<'_>) -> Vec<u8> {
    let mut bytes = Vec::new();
    (FORMATS.find(format).unwrap().build.write.unwrap())(output, &mut bytes).unwrap();
    bytes
}

fn read_back(format: &str, output: &Output<'_>) -> Dataset {
    read_dataset_bytes(format, &written(format, output)).unwrap()
}

fn names(fits: fn(&Format) -> bool) -> impl Iterator<Item = &'static str> {
    FORMATS.entries.iter().filter(move |entry| fits(&entry.build)).map(|entry| entry.name)
}

/// Formats that hold every kind of cell.
fn volume_formats() -> impl Iterator<Item = &'static str> {
    names(|format| format.holds.shapes == Shapes::All)
}

/// Formats that are read and written.
fn round_trips() -> impl Iterator<Item = &'static Entry<Format>> {
    FORMATS.entries.iter().copied().filter(|entry| entry.build.read.is_some() && entry.build.write.is_some())
}

/// An extension that a file of the format may bear.
fn extension(entry: &Entry<Format>) -> &'static str {
    [entry.build.extensions, entry.build.family].concat()[0]
}

/// A mesh with everything that a format holds, and nothing else.
fn held_mesh(holds: &Holds) -> Mesh {
    let mut mesh = match holds.shapes {
        Shapes::All => mixed_mesh(),
        Shapes::Tetrahedra => tetrahedra_mesh(),
        Shapes::Facets => surface_mesh(),
        Shapes::Triangles => {
            let whole = surface_mesh();
            let mut mesh = Mesh { points: whole.points.clone(), ..Mesh::default() };
            let triangles = whole.facets().filter(|facet| facet.kind == ElementKind::Tri3);
            mesh.push_facet(ElementKind::Tri3, &[0, 1, 2]);
            mesh.push_facet(ElementKind::Tri3, &[0, 2, 3]);
            triangles.for_each(|facet| mesh.push_facet(facet.kind, facet.nodes));
            mesh
        }
    };
    if holds.groups == HeldGroups::None {
        mesh.groups.clear();
    }
    if holds.digits == Digits::Single {
        let single = |p: &Vec3| Vec3::from_array(p.to_array().map(|x| f64::from(x as f32)));
        mesh.points = mesh.points.iter().map(single).collect();
    }
    mesh
}

/// By the table: what a format says it holds comes back as the same bits and in the same order, in memory and by
/// file, and nothing is said to be lost.
#[test]
fn every_format_gives_back_what_it_holds() {
    let folder = TemporaryFolder::new("table");
    for entry in round_trips() {
        let mesh = held_mesh(&entry.build.holds);
        let output = Output::new(&mesh);
        let back = read_back(entry.name, &output);
        assert_eq!(back.mesh, mesh, "{}", entry.name);
        assert_eq!(entry.build.holds.losses(entry.name, &output), named_numbers(entry), "{}", entry.name);
        for extension in entry.build.extensions.iter().chain(entry.build.family) {
            // a dot in the stem, letters of the other case
            for name in [format!("mesh.{extension}"), format!("a.b.{}", extension.to_uppercase())] {
                let path = folder.path(name);
                assert_eq!(format_for(entry.name, &path).unwrap(), entry.name);
                write_dataset_as(entry.name, &path, &output).unwrap();
                assert_eq!(read_mesh(&path).unwrap().0, mesh, "{} as {}", entry.name, path.display());
            }
        }
        // where the name of the file would stand for another format it is refused
        for other in ["a.xyz", "a", if entry.name == "obj" { "a.off" } else { "a.obj" }] {
            let error = format_for(entry.name, Path::new(other)).unwrap_err();
            assert!(matches!(&error, IoError::Request { .. }), "{}: {error}", entry.name);
        }
    }
}

/// Edges come back from formats of every kind of cell, surface cells as facets from all but those of tetrahedra; what a format
/// has no room for is refused before a file is there.
#[test]
fn lines_and_sheets_come_back_or_are_refused() {
    let folder = TemporaryFolder::new("lines");
    let points: Vec<Vec3> = (0..5).map(|k| Vec3::new(f64::from(k), f64::from(k * k), 0.5)).collect();
    for (kind, nodes) in [
        (ElementKind::Edge2, vec![0, 1, 1, 4]),
        (ElementKind::Edge3, vec![0, 2, 1, 2, 4, 3]),
        (ElementKind::Tri3, vec![0, 1, 2, 2, 3, 4]),
        (ElementKind::Quad4, vec![0, 1, 3, 2]),
    ] {
        let mut mesh = Mesh::new(points.clone(), kind, nodes);
        mesh.groups.insert("all".into(), souple_mesh::Group { cells: vec![0], ..Default::default() });
        for entry in round_trips() {
            let shapes = entry.build.holds.shapes;
            let path = folder.path(format!("{kind}_{}.{}", entry.name, extension(entry)));
            let output = Output::new(&mesh);
            let written = write_dataset_as(entry.name, &path, &output);
            let is_kept = match kind.dimension() {
                1 => shapes == Shapes::All,
                _ => shapes != Shapes::Tetrahedra,
            };
            assert_eq!(written.is_ok(), is_kept, "{kind} {}: {written:?}", entry.name);
            if !is_kept {
                assert!(!path.exists(), "{kind} {}", entry.name);
                continue;
            }
            let dataset = read_back(entry.name, &output);
            let back = dataset.mesh;
            if shapes == Shapes::All {
                let (blocks, group) = match kind.dimension() {
                    1 => (&back.blocks, &back.groups["all"].cells),
                    _ => (&back.facet_blocks, &back.groups["all"].facets),
                };
                assert_eq!((blocks, &back.points), (&mesh.blocks, &mesh.points), "{kind} {}", entry.name);
                assert_eq!(group, &[0], "{kind} {}", entry.name);
                assert!(dataset.notes.is_empty(), "{:?}", dataset.notes);
            } else {
                assert!(back.facet_count() > 0, "{kind} {}", entry.name);
            }
        }
    }
    // a tetrahedron with an edge beside it
    let mut mixed = tetrahedra_mesh();
    mixed.push_cell(ElementKind::Edge2, &[0, 4]);
    let losses = Holds::ALL.losses("vtu", &Output::new(&mixed));
    assert_eq!(losses.len(), 1, "{losses:?}");
    assert!(losses[0].contains("1 edges: beside other elements"), "{losses:?}");
}

/// What the reader would refuse is not written, and an older file stays as it is.
#[test]
fn nothing_is_written_that_cannot_be_read() {
    let folder = TemporaryFolder::new("verified");
    let path = folder.path("a.stl");
    let mesh = held_mesh(&FORMATS.find("stl").unwrap().build.holds);
    let back = write_and_read_back("stl", &path, &Output::new(&mesh)).unwrap();
    assert_eq!(back.unwrap().mesh, read_mesh(&path).unwrap().0);
    let older = std::fs::read(&path).unwrap();
    // rounded to 4 bytes all corners are one
    let small = Mesh { points: mesh.points.iter().map(|p| *p * 1e-60).collect(), ..mesh.clone() };
    let error = write_and_read_back("stl", &path, &Output::new(&small)).unwrap_err();
    assert!(matches!(&error, IoError::Request { .. }), "{error}");
    assert_eq!(std::fs::read(&path).unwrap(), older);
    assert!(write_and_read_back("gltf", &folder.path("a.glb"), &Output::new(&mesh)).unwrap().is_none());
    let tets = tetrahedra_mesh();
    let back = write_and_read_back("tetgen", &folder.path("a.ele"), &Output::new(&tets)).unwrap();
    assert_eq!((back.unwrap().mesh, folder.path("a.node").is_file()), (tets, true));
}

/// Quadratic cells and facets of every kind come back from the formats that hold all kinds, node for node.
#[test]
fn quadratic_cells_come_back() {
    let mesh = quadratic_mesh();
    assert_eq!(mesh.blocks.iter().map(|block| block.kind.node_count()).collect::<Vec<_>>(), [20, 13, 15, 10]);
    for format in volume_formats() {
        assert_eq!(read_back(format, &Output::new(&mesh)).mesh, mesh, "{format}");
    }
    // surface formats cut them into triangles and say so
    for entry in round_trips().filter(|entry| entry.build.holds.is_surface()) {
        let output = Output::new(&mesh);
        let losses = entry.build.holds.losses(entry.name, &output);
        assert!(losses.iter().any(|loss| loss.contains("2 curved facets")), "{losses:?}");
        // four of the triangle, six of the quadrilateral
        assert_eq!(read_back(entry.name, &output).mesh.facet_count(), 10, "{}", entry.name);
    }
}

/// Gmsh numbers the middles of edges by the lowest corner: 1-2, 1-3, 1-4 (hexahedra 1-2, 1-4, 1-5, 2-3, …), as its
/// manual draws them; the last two of a tetrahedron are 4-3 and 4-2.
#[test]
fn gmsh_order_of_middle_nodes() {
    let mesh = quadratic_mesh();
    let text = String::from_utf8(written("gmsh_2", &Output::new(&mesh))).unwrap();
    let rows: Vec<Vec<usize>> = text
        .lines()
        .filter_map(|line| {
            line.split_whitespace().map(|word| word.parse().ok()).collect::<Option<Vec<usize>>>()
        })
        .collect();
    let edges: [(usize, &[[usize; 2]]); 4] = [
        (11, &[[0, 1], [1, 2], [2, 0], [3, 0], [2, 3], [1, 3]]),
        (
            17,
            &[[0, 1], [0, 3], [0, 4], [1, 2], [1, 5], [2, 3], [2, 6], [3, 7], [4, 5], [4, 7], [5, 6], [6, 7]],
        ),
        (18, &[[0, 1], [0, 2], [0, 3], [1, 2], [1, 4], [2, 5], [3, 4], [3, 5], [4, 5]]),
        (19, &[[0, 1], [0, 3], [0, 4], [1, 2], [1, 4], [2, 3], [2, 4], [3, 4]]),
    ];
    let shift = Vec3::new(0.01, 1.0 / 300.0, -0.02);
    for (element_type, edges) in edges {
        let row = rows.iter().find(|row| row.len() > 12 && row[1] == element_type).unwrap();
        let nodes = &row[5..];
        let corners = nodes.len() - edges.len();
        let point = |k: usize| mesh.points[nodes[k] - 1];
        for (k, [a, b]) in edges.iter().enumerate() {
            let expected = (point(*a) + point(*b)) * 0.5 + shift;
            assert!((point(corners + k) - expected).length() < 1e-15, "type {element_type}, edge {k}");
        }
    }
}

/// Names of groups that a number stands for are told even where they come back.
fn named_numbers(entry: &Entry<Format>) -> Vec<String> {
    match entry.build.holds.groups {
        HeldGroups::OneNumber => vec![format!(
            "the format `{}` does not keep 3 groups by name: each point, cell and facet has one number, that of its first group",
            entry.name
        )],
        _ => Vec::new(),
    }
}

/// Positions that are not numbers of 4 bytes come back rounded to them, and that is told.
#[test]
fn digits_are_kept_as_declared() {
    for entry in round_trips().filter(|entry| entry.build.holds.digits == Digits::Single) {
        let exact = held_mesh(&Holds { digits: Digits::All, ..entry.build.holds });
        let back = read_back(entry.name, &Output::new(&exact)).mesh;
        for (read, wrote) in back.points.iter().zip(&exact.points) {
            // half a unit in the last place of 24 bits
            let near = |(a, b): (f64, f64)| (a - b).abs() <= b.abs() * 2f64.powi(-24);
            assert!(read.to_array().into_iter().zip(wrote.to_array()).all(near), "{}", entry.name);
        }
        let losses = entry.build.holds.losses(entry.name, &Output::new(&exact));
        assert!(losses.iter().any(|loss| loss.contains("rounded")), "{losses:?}");
    }
}

/// Surface formats write the boundary of a mesh of cells, facing outward, and say so.
#[test]
fn surface_formats_write_the_boundary() {
    let tetrahedra = tetrahedra_mesh();
    let mesh = Mesh { facet_blocks: Vec::new(), groups: Default::default(), ..tetrahedra };
    let volume = mesh.volume();
    for entry in round_trips().filter(|entry| entry.build.holds.is_surface()) {
        let surface = read_back(entry.name, &Output::new(&mesh)).mesh.facet_surface().unwrap();
        surface.check_closed().unwrap();
        // positions of 4 bytes: each coordinate of order one is off by 2⁻²⁴, the volume by a few of them
        assert!((surface.enclosed_volume() - volume).abs() < 20.0 * 2f64.powi(-24), "{}", entry.name);
        let losses = entry.build.holds.losses(entry.name, &Output::new(&mesh));
        assert!(losses[0].contains("2 cells: their boundary is written"), "{losses:?}");
    }
}

#[test]
fn scalars_on_the_points_of_a_surface() {
    let mesh = surface_mesh();
    let fields = [Field::new("quality", 1, vec![0.1, -0.0, 1e300, f64::INFINITY, 5e-324, 3.0])];
    for name in names(|format| format.holds.fields == HeldFields::PointScalars) {
        let back = read_back(name, &Output { point_fields: &fields, ..Output::new(&mesh) });
        assert_eq!(back.point_fields, fields, "{name}");
    }
}

/// A mesh without cells, with empty groups, without groups, without facets: for formats of volumes.
#[test]
fn plain_meshes_round_trip() {
    let whole = mixed_mesh();
    let bare = Mesh { groups: Default::default(), facet_blocks: Vec::new(), ..whole.clone() };
    let surface = Mesh { groups: Default::default(), blocks: Vec::new(), ..whole.clone() };
    let mut empty_group = whole;
    empty_group.groups.insert("empty".into(), Default::default());
    for format in volume_formats() {
        for mesh in [&bare, &surface, &empty_group] {
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
    for format in volume_formats() {
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
    for format in volume_formats() {
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
    assert!(matches!(read_mesh_bytes("gltf", b"glTF"), Err(IoError::Unsupported { .. })));
    // what a format has no room for at all
    let nothing = Mesh { points: vec![Vec3::ZERO], ..Mesh::default() };
    for name in names(|format| format.holds.is_surface()) {
        refused(name, &Output::new(&nothing));
    }
    refused("tetgen", &Output::new(&mixed_mesh()));
    let huge = Mesh { points: surface_mesh().points.iter().map(|p| *p * 1e39).collect(), ..surface_mesh() };
    refused("stl", &Output::new(&huge));
    refused("gltf", &Output::new(&huge));
    for name in ["two words", "x", ""] {
        let fields = [Field::new(name, 1, vec![0.0; 6])];
        refused("ply", &Output { point_fields: &fields, ..Output::new(&surface_mesh()) });
    }
}

/// Every format refuses nothing, garbage and another format's content.
#[test]
fn garbage_is_refused() {
    let mesh = mixed_mesh();
    let vtu = written("vtu", &Output::new(&mesh));
    let gmsh = written("gmsh", &Output::new(&mesh));
    for entry in FORMATS.entries {
        if entry.build.read.is_none() {
            continue;
        }
        let other: &[u8] = if entry.build.extensions == ["vtu"] { &gmsh } else { &vtu };
        for garbage in [b"".as_slice(), b"\n\n", b"\xff\xfe\x00garbage \x80\n\x01", b"{\"a\": 1}", other] {
            assert!(read_mesh_bytes(entry.name, garbage).is_err(), "{} takes {garbage:?}", entry.name);
        }
    }
}

/// Cut anywhere, a file is refused, or its missing end is told; else it has lost whole sections behind its points and cells, and
/// no more.
#[test]
fn cuts_are_refused_or_told() {
    for entry in round_trips() {
        let mesh = held_mesh(&entry.build.holds);
        let bytes = written(entry.name, &Output::new(&mesh));
        for length in 0..bytes.len() {
            let Ok(cut) = read_mesh_bytes(entry.name, &bytes[..length]) else { continue };
            if cut.1.iter().any(|note| note.contains("has no end: the file may be cut off")) {
                continue;
            }
            let what = format!("{} cut at {length} of {}", entry.name, bytes.len());
            // an end mark may miss its line end; what has no mark is cut behind a line
            assert!(cut.0 == mesh || bytes[..length].ends_with(b"\n"), "{what}");
            assert_eq!((&cut.0.points, &cut.0.blocks), (&mesh.points, &mesh.blocks), "{what}");
            // OBJ says nowhere how many facets it has, and the facets of TetGen have a file of their own
            if !matches!(entry.name, "obj" | "tetgen") {
                assert_eq!(cut.0.facet_blocks, mesh.facet_blocks, "{what}");
            }
        }
    }
}

#[test]
fn no_fault_panics() {
    for entry in round_trips() {
        let read = entry.build.read.unwrap();
        survives_faults(entry.name, &written(entry.name, &Output::new(&held_mesh(&entry.build.holds))), read);
    }
}

/// A count that a file cannot hold is refused before memory is asked for: in every format, every number that a
/// header may take is made absurd.
#[test]
fn absurd_counts_are_refused() {
    // a number that is no count may be as large as it likes: then the mesh is no larger than its file
    let try_one = |name: &str, bytes: &[u8]| {
        if let Ok((mesh, _)) = read_mesh_bytes(name, bytes) {
            let size = mesh.points.len() + mesh.cell_count() + mesh.facet_count();
            assert!(size <= bytes.len(), "{name}: {size} points and cells of {} bytes", bytes.len());
        }
    };
    for entry in round_trips() {
        let bytes = written(entry.name, &Output::new(&held_mesh(&entry.build.holds)));
        let is_text = bytes.iter().all(u8::is_ascii);
        for at in 0..bytes.len().min(4000) {
            let starts_number =
                is_text && bytes[at].is_ascii_digit() && (at == 0 || !bytes[at - 1].is_ascii_digit());
            if starts_number {
                let end = at + bytes[at..].iter().take_while(|byte| byte.is_ascii_digit()).count();
                for absurd in ["18446744073709551615", "4294967295", "99999999999999999999999", "-1"] {
                    let changed = [&bytes[..at], absurd.as_bytes(), &bytes[end..]].concat();
                    try_one(entry.name, &changed);
                }
            } else if !is_text && at + 8 <= bytes.len() {
                for width in [4, 8] {
                    let mut changed = bytes.clone();
                    changed[at..at + width].fill(0xff);
                    try_one(entry.name, &changed);
                    changed[at + width - 1] = 0x7f;
                    try_one(entry.name, &changed);
                }
            }
        }
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
