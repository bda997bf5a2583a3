//! STL: triangles, each with corners of its own; equal corners become one point. Text and binary; read only.

use std::collections::HashMap;

use souple_math::Vec3;
use souple_mesh::{ElementKind, Mesh};
use souple_table::Entry;

use crate::Dataset;
use crate::cursor::Cursor;
use crate::error::{Fault, Place, quoted};
use crate::format::Format;

pub(crate) static STL: Entry<Format> = Entry {
    name: "stl",
    summary: "STL surface, text or binary; equal corners are joined to points",
    source: "3D Systems, StereoLithography Interface Specification, 1988",
    parameters: &[],
    build: Format { extensions: &["stl"], recognises: |_| false, read: Some(read), write: None },
};

/// Bytes before the triangles of a binary file: a comment and their count.
const HEAD: usize = 84;
/// Bytes of a triangle: normal, three corners, attribute.
const TRIANGLE: usize = 50;

/// Joins corners of equal coordinates.
#[derive(Default)]
struct Joiner {
    mesh: Mesh,
    points: HashMap<[u64; 3], u32>,
    degenerate: usize,
}

impl Joiner {
    fn point(&mut self, position: Vec3) -> u32 {
        // adding zero makes one of the two zeros
        let key = position.to_array().map(|coordinate| (coordinate + 0.0).to_bits());
        *self.points.entry(key).or_insert_with(|| {
            self.mesh.points.push(position);
            self.mesh.points.len() as u32 - 1
        })
    }

    fn triangle(&mut self, corners: [Vec3; 3]) {
        let [a, b, c] = corners.map(|corner| self.point(corner));
        if a == b || b == c || c == a {
            self.degenerate += 1;
        } else {
            self.mesh.push_facet(ElementKind::Tri3, &[a, b, c]);
        }
    }

    fn finish(self, place: Place) -> Result<Dataset, Fault> {
        if self.mesh.facet_blocks.is_empty() {
            return Err(Fault::new(place, "the number of triangles", "0", "1 or more"));
        }
        let mut notes = Vec::new();
        if self.degenerate > 0 {
            notes.push(format!("{} triangles with equal corners were left out", self.degenerate));
        }
        Ok(Dataset { mesh: self.mesh, notes, ..Dataset::default() })
    }
}

pub(crate) fn read(bytes: &[u8]) -> Result<Dataset, Fault> {
    // binary files may begin with "solid" too: their length tells them
    let count = bytes
        .get(80..HEAD)
        .map(|count| u32::from_le_bytes([count[0], count[1], count[2], count[3]]) as usize);
    let binary = count.is_some_and(|count| bytes.len() == HEAD + count * TRIANGLE);
    if binary || !bytes.trim_ascii_start().starts_with(b"solid") {
        read_binary(bytes)
    } else {
        read_text(bytes)
    }
}

fn read_binary(bytes: &[u8]) -> Result<Dataset, Fault> {
    let Some(count) = bytes.get(80..HEAD) else {
        let found = format!("{} bytes", bytes.len());
        return Err(Fault::new(
            Place::Byte(bytes.len()),
            "the STL file",
            found,
            "\"solid\", or 84 bytes and triangles",
        ));
    };
    let count = u32::from_le_bytes([count[0], count[1], count[2], count[3]]) as usize;
    let length = HEAD + count * TRIANGLE;
    // some programs append a few bytes; a missing one means a cut
    if bytes.len() < length {
        let found = format!("cut off after {} bytes", bytes.len());
        let expected = format!("{length} bytes for {count} triangles");
        return Err(Fault::new(Place::Byte(bytes.len()), "the list of triangles", found, expected));
    }
    let mut joiner = Joiner::default();
    for (index, triangle) in bytes[HEAD..length].chunks_exact(TRIANGLE).enumerate() {
        let number = |offset: usize| {
            let bytes = [0, 1, 2, 3].map(|byte| triangle[offset + byte]);
            f64::from(f32::from_le_bytes(bytes))
        };
        let corner = |offset: usize| Vec3::new(number(offset), number(offset + 4), number(offset + 8));
        let corners = [12, 24, 36].map(corner);
        if let Some(corner) = corners.iter().find(|corner| !corner.is_finite()) {
            let place = Place::Byte(HEAD + index * TRIANGLE);
            let found = format!("{:?}", corner.to_array());
            return Err(Fault::new(
                place,
                format!("a corner of triangle {index}"),
                found,
                "finite coordinates",
            ));
        }
        joiner.triangle(corners);
    }
    joiner.finish(Place::Byte(80))
}

fn read_text(bytes: &[u8]) -> Result<Dataset, Fault> {
    let mut cursor = Cursor::new(bytes);
    let mut joiner = Joiner::default();
    let expect = |cursor: &mut Cursor<'_>, wanted: &str| {
        let word = cursor.expect_word(format_args!("the next word"), wanted)?;
        if word.eq_ignore_ascii_case(wanted.as_bytes()) {
            return Ok(());
        }
        Err(cursor.fault("the next word", quoted(word), wanted))
    };
    cursor.skip_space();
    // "solid" and a name
    cursor.line();
    loop {
        let word = cursor.expect_word(format_args!("the end of the solid"), "endsolid")?;
        let spaced = word.eq_ignore_ascii_case(b"end");
        if spaced {
            expect(&mut cursor, "solid")?;
        }
        if spaced || word.eq_ignore_ascii_case(b"endsolid") {
            cursor.line();
            cursor.skip_space();
            if cursor.rest().is_empty() {
                return joiner.finish(cursor.place());
            }
            expect(&mut cursor, "solid")?;
            cursor.line();
            continue;
        }
        if !word.eq_ignore_ascii_case(b"facet") {
            return Err(cursor.fault("the next word", quoted(word), "facet, endsolid or end solid"));
        }
        expect(&mut cursor, "normal")?;
        for _ in 0..3 {
            // normals follow from the corners; some programs write them as NaN
            cursor.double(format_args!("the normal of a facet"))?;
        }
        expect(&mut cursor, "outer")?;
        expect(&mut cursor, "loop")?;
        let mut corners = [Vec3::new(0.0, 0.0, 0.0); 3];
        for corner in &mut corners {
            expect(&mut cursor, "vertex")?;
            let mut position = [0.0; 3];
            for coordinate in &mut position {
                *coordinate = cursor.finite(format_args!("a coordinate of a vertex"))?;
            }
            *corner = Vec3::from_array(position);
        }
        expect(&mut cursor, "endloop")?;
        expect(&mut cursor, "endfacet")?;
        joiner.triangle(corners);
    }
}

#[cfg(test)]
mod tests {
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
}
