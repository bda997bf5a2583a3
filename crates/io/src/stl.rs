//! STL: triangles, each with corners of its own; equal corners become one point. Text and binary.
//!
//! What is strange about a surface is told as it is read: triangles without area, stored normals that point against
//! the order of the corners, edges that two triangles do not share, bytes behind the last triangle.

use std::collections::HashMap;
use std::io::Write;

use souple_math::Vec3;
use souple_mesh::{ElementKind, Mesh};
use souple_table::{Entry, counted, in_number};

use crate::cursor::Cursor;
use crate::dataset::Output;
use crate::error::{Fault, Place, quoted};
use crate::facets::SurfacePart;
use crate::format::{Format, WriteError};
use crate::holds::{Digits, Holds};
use crate::{Dataset, IoError};

pub(crate) static STL: Entry<Format> = Entry {
    name: "stl",
    summary: "STL surface; reads text and binary and joins equal corners to points, writes binary",
    source: "3D Systems, StereoLithography Interface Specification, 1988",
    parameters: &[],
    build: Format {
        extensions: &["stl"],
        family: &[],
        parts: &[],
        recognises: is_binary,
        read: Some(read),
        write: Some(write_binary),
        holds: Holds { digits: Digits::Single, ..Holds::BARE },
    },
};

pub(crate) static STL_TEXT: Entry<Format> = Entry {
    name: "stl_text",
    summary: "STL surface; writes text whose corners read back as the same bits",
    source: "3D Systems, StereoLithography Interface Specification, 1988",
    parameters: &[],
    build: Format {
        extensions: &[],
        family: &["stl"],
        parts: &[],
        recognises: |_| false,
        read: Some(read),
        write: Some(write_text),
        holds: Holds::BARE,
    },
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
    /// Triangles whose stored normal points against the order of their corners.
    against: usize,
}

impl Joiner {
    fn point(&mut self, position: Vec3) -> u32 {
        *self.points.entry(position.key()).or_insert_with(|| {
            self.mesh.points.push(position);
            self.mesh.points.len() as u32 - 1
        })
    }

    fn triangle(&mut self, normal: Vec3, corners: [Vec3; 3]) {
        let [a, b, c] = corners;
        // a normal of zeros or NaN says nothing
        self.against += usize::from(normal.dot((b - a).cross(c - a)) < 0.0);
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
        let open = self.mesh.facet_surface().map_or(0, |surface| {
            surface.edge_uses().iter().filter(|(_, forward, backward)| forward != backward).count()
        });
        let told = [
            (self.degenerate, "triangles with equal corners were left out"),
            (self.against, "triangles have a normal against the order of their corners, which was taken"),
            (open, "edges are not shared by two triangles of opposite direction: the surface is not closed"),
        ];
        let notes = told.into_iter().filter(|(count, _)| *count > 0);
        let notes = notes.map(|(count, what)| format!("{count} {what}")).collect();
        Ok(Dataset { mesh: self.mesh, notes, ..Dataset::default() })
    }
}

/// Whether the length is that of the triangles counted: comments begin with anything, with "solid" as well.
fn is_binary(bytes: &[u8]) -> bool {
    let count = bytes
        .get(80..HEAD)
        .map(|count| u32::from_le_bytes([count[0], count[1], count[2], count[3]]) as usize);
    count.is_some_and(|count| bytes.len() == HEAD + count * TRIANGLE)
}

pub(crate) fn read(bytes: &[u8]) -> Result<Dataset, Fault> {
    let starts = |word: &[u8]| {
        let start = bytes.trim_ascii_start().get(..word.len());
        start.is_some_and(|start| start.eq_ignore_ascii_case(word))
    };
    // the count of a binary file with bytes behind it has a zero, which no text has
    let is_text = starts(b"solid") && !bytes[..bytes.len().min(HEAD)].contains(&0);
    if is_binary(bytes) || !is_text { read_binary(bytes) } else { read_text(bytes) }
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
        let expected = format!("{length} bytes for {}", counted(count as u64, "triangle"));
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
        joiner.triangle(corner(0), corners);
    }
    let mut dataset = joiner.finish(Place::Byte(80))?;
    if bytes.len() > length {
        dataset.notes.push(format!(
            "behind the last triangle {} left out",
            in_number(bytes.len() - length, "byte was", "bytes were")
        ));
    }
    Ok(dataset)
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
        let mut normal = [0.0; 3];
        for component in &mut normal {
            // normals follow from the corners; some programs write them as NaN
            *component = cursor.double(format_args!("the normal of a facet"))?;
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
        joiner.triangle(Vec3::from_array(normal), corners);
    }
}

/// Corners of the triangles to write, with their unit normals; a triangle without area has a normal of zeros.
fn triangles(output: &Output<'_>) -> Vec<(Vec3, [Vec3; 3])> {
    let part = SurfacePart::of(output);
    let with_normal = |corners: [u32; 3]| {
        let [a, b, c] = corners.map(|corner| part.positions[corner as usize]);
        ((b - a).cross(c - a).try_normalised().unwrap_or(Vec3::ZERO), [a, b, c])
    };
    part.triangles().map(with_normal).collect()
}

fn write_binary(output: &Output<'_>, out: &mut dyn Write) -> Result<(), WriteError> {
    let triangles = triangles(output);
    let largest =
        output.positions().iter().flat_map(|p| p.to_array()).fold(0.0, |most: f64, x| most.max(x.abs()));
    if largest > f64::from(f32::MAX) {
        let expected = "at most 3.4e38, the largest number of 4 bytes (the format `stl_text` takes more)";
        return Err(IoError::request("a coordinate", format!("{largest:e}"), expected).into());
    }
    let rounded = |corner: Vec3| corner.to_array().map(|c| c as f32);
    let is_lost = |[a, b, c]: [[f32; 3]; 3]| a == b || b == c || c == a;
    if !triangles.is_empty() && triangles.iter().all(|(_, corners)| is_lost(corners.map(rounded))) {
        let expected = "one that has triangles left in numbers of 4 bytes, which end at 1.4e-45 and have seven digits (the format `stl_text` \
                        takes more)";
        return Err(IoError::request("the largest coordinate", format!("{largest:e}"), expected).into());
    }
    let count = u32::try_from(triangles.len())
        .map_err(|_| IoError::request("the number of triangles", triangles.len(), "less than 2^32"))?;
    // the head must not begin with "solid"
    let mut head = [b' '; 80];
    head[..14].copy_from_slice(b"souple surface");
    out.write_all(&head)?;
    out.write_all(&count.to_le_bytes())?;
    for (normal, corners) in triangles {
        for vector in [normal].iter().chain(&corners) {
            for component in vector.to_array() {
                out.write_all(&(component as f32).to_le_bytes())?;
            }
        }
        out.write_all(&[0; 2])?;
    }
    Ok(())
}

fn write_text(output: &Output<'_>, out: &mut dyn Write) -> Result<(), WriteError> {
    writeln!(out, "solid souple")?;
    for (normal, corners) in triangles(output) {
        let [x, y, z] = normal.to_array();
        writeln!(out, "facet normal {x:e} {y:e} {z:e}\nouter loop")?;
        for corner in corners {
            let [x, y, z] = corner.to_array();
            writeln!(out, "vertex {x:?} {y:?} {z:?}")?;
        }
        writeln!(out, "endloop\nendfacet")?;
    }
    Ok(writeln!(out, "endsolid souple")?)
}

#[cfg(test)]
mod tests;
