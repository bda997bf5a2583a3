//! Files as other programs write them, and their faults.

use souple_mesh::ElementKind;

use super::*;
use crate::Output;
use crate::testing::{surface_mesh, survives_faults};

/// With colours, normals in single precision, an element of no use, a pentagon.
const TEXT: &str = "ply\nformat ascii 1.0\ncomment by hand\nobj_info none\nelement vertex 5\nproperty float x\n\
                    property float y\nproperty float z\nproperty uchar red\nelement face 3\n\
                    property list uchar int vertex_index\nproperty float quality\nelement edge 1\n\
                    property int vertex1\nproperty int vertex2\nend_header\n0 0 0 255\n1 0 0 0\n1 1 0 7\n0 1 0 8\n\
                    -1 0.5 0 9\n3 0 1 2 0.5\n4 0 1 2 3 0.5\n5 0 1 2 3 4 1e-3\n0 1\n";

#[test]
fn text_by_hand() {
    let dataset = read::read(TEXT.as_bytes()).unwrap();
    let facets: Vec<_> = dataset.mesh.facets().map(|facet| facet.nodes.to_vec()).collect();
    let pentagon = [[0, 1, 2], [0, 2, 3], [0, 3, 4]].map(|corners| corners.to_vec());
    assert_eq!(facets[..2], [vec![0, 1, 2], vec![0, 1, 2, 3]]);
    assert_eq!(facets[2..], pentagon);
    assert_eq!(dataset.point_fields[0].values, [255.0, 0.0, 7.0, 8.0, 9.0]);
    assert_eq!(dataset.notes.len(), 2, "{:?}", dataset.notes);
}

/// The same numbers from types of every width, in both orders of bytes.
#[test]
fn binary_of_every_type() {
    let types = ["char", "uchar", "short", "ushort", "int", "uint", "float", "double"];
    for endian in [Endian::Little, Endian::Big] {
        for (index, name) in types.iter().enumerate() {
            let order = if endian == Endian::Little { "little" } else { "big" };
            let mut bytes = format!(
                "ply\nformat binary_{order}_endian 1.0\nelement vertex 3\nproperty {name} x\nproperty {name} y\n\
                 property double z\nelement face 1\nproperty list ushort uchar vertex_indices\nend_header\n"
            )
            .into_bytes();
            let number = |value: u8| -> Vec<u8> {
                let v = f64::from(value);
                let mut little = match index {
                    0 | 1 => vec![value],
                    2 | 3 => u16::from(value).to_le_bytes().to_vec(),
                    4 | 5 => u32::from(value).to_le_bytes().to_vec(),
                    6 => (v as f32).to_le_bytes().to_vec(),
                    _ => v.to_le_bytes().to_vec(),
                };
                if endian == Endian::Big {
                    little.reverse();
                }
                little
            };
            for [x, y] in [[0, 0], [100, 0], [0, 100]] {
                bytes.extend(number(x));
                bytes.extend(number(y));
                bytes.extend([0; 8]);
            }
            bytes.extend(if endian == Endian::Little { [3, 0] } else { [0, 3] });
            bytes.extend([0, 1, 2]);
            let mesh = read::read(&bytes).unwrap().mesh;
            let expected = [[0.0, 0.0, 0.0], [100.0, 0.0, 0.0], [0.0, 100.0, 0.0]];
            assert!(mesh.points.iter().map(|p| p.to_array()).eq(expected), "{name} {endian:?}");
            assert!((0..bytes.len()).all(|length| read::read(&bytes[..length]).is_err()));
        }
    }
}

#[test]
fn big_endian_is_written_too() {
    let mesh = surface_mesh();
    let mut bytes = Vec::new();
    write::write(&Output::new(&mesh), Encoding::Binary(Endian::Big), &mut bytes).unwrap();
    let back = read::read(&bytes).unwrap().mesh;
    assert_eq!((back.points, back.facet_blocks), (mesh.points, mesh.facet_blocks));
}

#[test]
fn faults_name_line_value_and_range() {
    let fault = |from: &str, to: &str| {
        assert!(TEXT.contains(from), "{from}");
        read::read(TEXT.replacen(from, to, 1).as_bytes()).unwrap_err().to_string()
    };
    let cases = [
        ("ascii 1.0", "ascii 2.0", "line 2: the version of the PLY format is \"2.0\"; expected 1.0"),
        ("format ascii", "format utf8", "expected ascii, binary_little_endian or binary_big_endian"),
        ("float x", "real x", "line 6: the type of a property is \"real\""),
        ("property float z\n", "", "the property z of vertex is missing"),
        ("list uchar int", "list float int", "the type of the count of a list is \"float\""),
        ("vertex_index\n", "corners\n", "expected vertex_indices or vertex_index"),
        ("element vertex 5", "element vertex 99999999999", "the rest of the file has room for"),
        ("element vertex 5", "element vertex -5", "the number of vertex is \"-5\""),
        ("element face 3", "element fase 3", "the element face is given 0 times"),
        ("1 1 0 7", "1 nan 0 7", "line 19: y of vertex 2 is NaN; expected a finite number"),
        ("1 1 0 7", "1 one 0 7", "line 19: y of vertex 2 is \"one\"; expected a number"),
        ("3 0 1 2 0.5", "3 0 1 5 0.5", "a corner of facet 0 is 5; expected the number of a point: below 5"),
        ("3 0 1 2 0.5", "3 0 1 -2 0.5", "vertex_index of face 0 is -2"),
        ("3 0 1 2 0.5", "2 0 1 0.5", "is 2 corners; expected 3 or more"),
        ("3 0 1 2 0.5", "1e18 0 1 2", "the rest of the file has room for"),
        ("end_header\n", "", "expected format, element, property"),
        ("ply\n", "plx\n", "the start of the PLY file"),
    ];
    for (from, to, words) in cases {
        let message = fault(from, to);
        assert!(message.contains(words), "{from} -> {to}: {message}");
    }
}

#[test]
fn no_fault_panics() {
    survives_faults("ply", TEXT.as_bytes(), read::read);
    assert_eq!(surface_mesh().count_of(ElementKind::Tet4), 0);
}
