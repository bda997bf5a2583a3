//! Wavefront OBJ: surfaces of triangles and quadrilaterals, with their groups.
//!
//! Normals, textures and materials are not read. Polygons of more corners are cut into triangles from their
//! first corner, which is right for convex ones; a note says so.

use std::collections::BTreeMap;
use std::io::Write;

use souple_math::Vec3;
use souple_mesh::{CellBlock, ElementKind, Mesh};
use souple_table::Entry;

use crate::cursor::parse;
use crate::dataset::{Facets, Output, tidy_groups};
use crate::error::{Fault, Place, quoted};
use crate::format::{Format, WriteError};
use crate::{Dataset, IoError};

pub(crate) static OBJ: Entry<Format> = Entry {
    name: "obj",
    summary: "Wavefront OBJ surface: triangles and quadrilaterals in groups",
    source: "Wavefront, Object Files (.obj), 1992",
    parameters: &[],
    build: Format { extensions: &["obj"], recognises: |_| false, read: Some(read), write: Some(write) },
};

/// Statements that change nothing of the geometry.
const WITHOUT_GEOMETRY: &[&str] = &[
    "vn", "vt", "vp", "s", "mg", "usemtl", "mtllib", "usemap", "maplib", "l", "p", "bevel", "c_interp", "d_interp",
    "lod", "shadow_obj", "trace_obj",
];

/// Facets and corners of one statement `f`.
fn read_corners<'a>(
    words: impl Iterator<Item = &'a [u8]>,
    line: usize,
    point_count: usize,
) -> Result<Vec<u32>, Fault> {
    let mut corners = Vec::new();
    for word in words {
        // "point/texture/normal": numbers from 1, or from the end if negative
        let number = word.split(|byte| *byte == b'/').next().unwrap_or_default();
        let index = match parse::<i64>(number) {
            Some(number) if number > 0 => Some(number - 1),
            Some(number) if number < 0 => number.checked_add(point_count as i64),
            _ => None,
        };
        let corner = index.and_then(|index| u32::try_from(index).ok()).filter(|corner| (*corner as usize) < point_count);
        let corner = corner.ok_or_else(|| {
            let expected = format!("1 to {point_count}, or -{point_count} to -1, the points so far");
            Fault::new(Place::Line(line), "a corner of the facet", quoted(word), expected)
        })?;
        if !corners.contains(&corner) {
            corners.push(corner);
        }
    }
    Ok(corners)
}

pub(crate) fn read(bytes: &[u8]) -> Result<Dataset, Fault> {
    let mut dataset = Dataset::default();
    let mesh = &mut dataset.mesh;
    let mut groups: Vec<String> = Vec::new();
    let (mut cut, mut degenerate) = (0usize, 0usize);
    let mut skipped: BTreeMap<String, usize> = BTreeMap::new();
    let mut lines = LogicalLines { rest: bytes, line: 0 };
    while let Some((line, content)) = lines.next() {
        let content = content.split(|byte| *byte == b'#').next().unwrap_or_default();
        let mut words = content.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
        let Some(keyword) = words.next() else { continue };
        match keyword {
            b"v" => mesh.points.push(read_point(words, line)?),
            b"g" | b"o" => {
                groups = words.map(|word| String::from_utf8_lossy(word).into_owned()).take(MOST_GROUPS).collect();
                groups.retain(|name| name != "default");
            }
            b"f" => {
                let given = words.clone().count();
                let corners = read_corners(words, line, mesh.points.len())?;
                if given < 3 {
                    return Err(Fault::new(Place::Line(line), "the number of corners", given.to_string(), "3 or more"));
                }
                let first = mesh.facet_count_of_last();
                match corners.as_slice() {
                    [_, _, _] => mesh.push_facet(ElementKind::Tri3, &corners),
                    [_, _, _, _] => mesh.push_facet(ElementKind::Quad4, &corners),
                    [start, others @ ..] if others.len() > 3 => {
                        cut += 1;
                        for pair in others.windows(2) {
                            mesh.push_facet(ElementKind::Tri3, &[*start, pair[0], pair[1]]);
                        }
                    }
                    _ => degenerate += 1,
                }
                let _ = first;
            }
            other => {
                let keyword = String::from_utf8_lossy(other).into_owned();
                if !WITHOUT_GEOMETRY.contains(&keyword.as_str()) {
                    let expected = "v, f, g, o, vn, vt, s, usemtl, mtllib, l, p or a comment";
                    return Err(Fault::new(Place::Line(line), "the statement", quoted(other), expected));
                }
                *skipped.entry(keyword).or_default() += 1;
            }
        }
    }
    let _ = (groups, cut, degenerate, skipped);
    Ok(dataset)
}
