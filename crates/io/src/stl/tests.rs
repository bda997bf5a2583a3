//! Text and binary agree; faults and strange surfaces.

use super::*;
use crate::testing::{real_input, survives_faults};

const TEXT: &str = "solid a b\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n\
                    endfacet\nfacet normal nan 0 0\nouter loop\nvertex 1 0 0\nvertex 1 1 0\nvertex -0 1 0\nendloop\n\
                    endfacet\nendsolid a b\n";

fn binary() -> Vec<u8> {
    let mut bytes = vec![b'x'; 80];
    bytes.extend(2u32.to_le_bytes());
    let triangles: [[f32; 9]; 2] =
        [[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0], [1.0, 0.0, 0.0, 1.0, 1.0, 0.0, -0.0, 1.0, 0.0]];
    for triangle in triangles {
        bytes.extend([0u8; 12]);
        bytes.extend(triangle.iter().flat_map(|number| number.to_le_bytes()));
        bytes.extend([0u8; 2]);
    }
    bytes
}

#[test]
fn text_and_binary_agree() {
    let (text, binary) = (read(TEXT.as_bytes()).unwrap(), read(&binary()).unwrap());
    assert_eq!(text.mesh, binary.mesh);
    assert_eq!((text.mesh.points.len(), text.mesh.facet_count()), (4, 2));
}

/// What has no triangles left in numbers of 4 bytes is refused before it is written; as text it is written.
#[test]
fn triangles_that_are_lost_in_four_bytes() {
    let mut mesh = read(TEXT.as_bytes()).unwrap().mesh;
    mesh.points.iter_mut().for_each(|point| *point = *point * 1e-200);
    let mut bytes = Vec::new();
    let Err(WriteError::Request(error)) = write_binary(&Output::new(&mesh), &mut bytes) else { panic!() };
    let message = error.to_string();
    assert!(
        bytes.is_empty() && message.starts_with("the largest coordinate is 1e-200; expected"),
        "{message}"
    );
    write_text(&Output::new(&mesh), &mut bytes).unwrap();
    assert_eq!(read(&bytes).unwrap().mesh, mesh);
}

/// Words of a text are of either case, its first one too; a binary file may begin with the same word, and have bytes behind it.
#[test]
fn what_begins_with_solid() {
    let text = read(TEXT.as_bytes()).unwrap();
    assert_eq!(read(TEXT.to_uppercase().as_bytes()), Ok(text.clone()));
    let mut named = binary();
    named[..10].copy_from_slice(b"solid name");
    assert_eq!(read(&named).unwrap().mesh, text.mesh);
    named.extend([0; 2]);
    assert_eq!(read(&named).unwrap().mesh, text.mesh);
}

#[test]
fn cuts_are_faults() {
    let bytes = binary();
    assert!((0..bytes.len()).all(|length| read(&bytes[..length]).is_err()));
    let end = TEXT.find("endsolid").unwrap();
    assert!((0..end).all(|length| read(&TEXT.as_bytes()[..length]).is_err()));
}

#[test]
fn no_fault_panics() {
    survives_faults("stl", TEXT.as_bytes(), read);
    survives_faults("stl", &binary(), read);
}

#[test]
fn real_surfaces() {
    for name in ["circle_knot_ascii.stl", "pliers_binary.stl"] {
        let Some(bytes) = real_input(name) else { return };
        let mesh = read(&bytes).unwrap().mesh;
        // a closed surface of triangles has about half as many points as triangles
        assert!(mesh.points.len() < mesh.facet_count(), "{name}");
    }
}

/// A closed surface has nothing to tell; one that is open, turned or longer than it says has.
#[test]
fn strange_surfaces_are_told() {
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(Vec3::from_array);
    let tetrahedron = Mesh::new(corners.to_vec(), ElementKind::Tet4, vec![0, 1, 2, 3]);
    let mut bytes = Vec::new();
    write_binary(&Output::new(&tetrahedron), &mut bytes).unwrap();
    assert!(read(&bytes).unwrap().notes.is_empty());
    bytes.extend([0; 7]);
    assert_eq!(read(&bytes).unwrap().notes, ["behind the last triangle 7 bytes were left out"]);
    let notes = read(TEXT.replace("normal 0 0 1", "normal 0 0 -1").as_bytes()).unwrap().notes;
    assert_eq!(notes.len(), 2, "{notes:?}");
    assert!(notes[0].starts_with("1 triangles have a normal against") && notes[1].starts_with("4 edges"));
}

#[test]
fn faults_name_place_value_and_range() {
    let fault = |from: &str, to: &str| {
        assert!(TEXT.contains(from), "{from}");
        read(TEXT.replacen(from, to, 1).as_bytes()).unwrap_err().to_string()
    };
    assert!(fault("vertex 1 0 0", "vertex 1 nan 0").starts_with("line 5: a coordinate of a vertex is NaN"));
    assert!(fault("vertex 1 0 0", "vertex 1 0").contains("\"vertex\"; expected a number"));
    assert!(fault("endloop", "vertex 2 2 2\nendloop").contains("expected endloop"));
    assert!(fault("outer loop", "inner loop").contains("line 3: the next word is \"inner\"; expected outer"));
    let mut absurd = binary();
    absurd[80..84].copy_from_slice(&u32::MAX.to_le_bytes());
    let message = read(&absurd).unwrap_err().to_string();
    assert!(message.contains("expected 214748364834 bytes for 4294967295 triangles"), "{message}");
    let mut infinite = binary();
    infinite[96..100].copy_from_slice(&f32::INFINITY.to_le_bytes());
    assert!(read(&infinite).unwrap_err().to_string().starts_with("byte 84: a corner of triangle 0 is [inf"));
    assert!(
        read(b"solid nothing\nendsolid nothing\n").unwrap_err().to_string().contains("expected 1 or more")
    );
}
