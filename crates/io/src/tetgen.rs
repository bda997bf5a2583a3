//! TetGen: tetrahedra in `.node`, `.ele` and, where there are any, triangles in `.face`, all of one stem.
//!
//! Numbers of regions and of boundary markers become the groups `volume_N`, `surface_N` and `point_N`; writing, groups
//! of such names keep their number and others get the next free one. Tetrahedra of ten nodes are read by their
//! corners.

use std::collections::{BTreeMap, BTreeSet};
use std::io::Write;

use souple_math::Vec3;
use souple_mesh::{ElementKind, Group};
use souple_table::Entry;

use crate::cursor::{Cursor, open_end, parse};
use crate::dataset::{Facets, Output, tidy_groups};
use crate::error::{Fault, Place, quoted};
use crate::format::{Format, WriteError};
use crate::holds::{HeldFields, HeldGroups, Holds, Shapes};
use crate::parts::{self, Part};
use crate::{Dataset, IoError};

pub(crate) static TETGEN: Entry<Format> = Entry {
    name: "tetgen",
    summary: "TetGen tetrahedra: .node, .ele and .face of one stem, with a number for each region and boundary",
    source: "Si, TetGen user's manual, file formats",
    parameters: &[],
    build: Format {
        extensions: PARTS,
        family: &[],
        parts: PARTS,
        recognises: |_| false,
        read: Some(read),
        write: Some(write),
        holds: Holds {
            shapes: Shapes::Tetrahedra,
            groups: HeldGroups::OneNumber,
            fields: HeldFields::None,
            ..Holds::ALL
        },
    },
};

const PARTS: &[&str] = &["node", "ele", "face"];

/// Markers and regions are below this: they may be written as real numbers, which are exact so far.
const MARKERS_BELOW: i64 = 9_000_000_000_000_000;

pub(crate) fn read(joined: &[u8]) -> Result<Dataset, Fault> {
    let files = parts::split(joined)?;
    let find = |extension: &str| files.iter().find(|part| part.extension == extension);
    let missing = |extension: &str| {
        let subject = format!("the .{extension} file");
        Fault::new(Place::Line(1), subject, "missing", "one beside the others, of the same stem")
    };
    let mut reader = Reader::default();
    let nodes = find("node").ok_or_else(|| missing("node"))?;
    let elements = find("ele").ok_or_else(|| missing("ele"))?;
    if let Some(part) = files.iter().find(|part| !PARTS.contains(&part.extension)) {
        let expected = format!("one of {}", PARTS.join(", "));
        return Err(Fault::new(Place::Line(1), "a part", format!("`{}`", part.extension), expected));
    }
    reader.read_nodes(nodes).map_err(|fault| parts::in_part("node", fault))?;
    reader.read_elements(elements).map_err(|fault| parts::in_part("ele", fault))?;
    if let Some(faces) = find("face") {
        reader.read_faces(faces).map_err(|fault| parts::in_part("face", fault))?;
    }
    tidy_groups(&mut reader.dataset.mesh);
    for Part { extension, bytes } in files {
        reader.dataset.notes.extend(open_end(bytes, &format!("the last line of the .{extension} file")));
    }
    Ok(reader.dataset)
}

/// The numbers of a table: a head of counts, then lines of numbers.
struct Rows<'a> {
    cursor: Cursor<'a>,
    place: Place,
}

impl<'a> Rows<'a> {
    fn of(part: &Part<'a>) -> Self {
        Self { cursor: Cursor::new(part.bytes), place: Place::Line(1) }
    }

    /// The words of the next line that says something.
    fn next(&mut self) -> Option<Vec<&'a [u8]>> {
        loop {
            self.place = self.cursor.place();
            let line = self.cursor.line()?;
            let content = line.split(|byte| *byte == b'#').next().unwrap_or_default();
            let words: Vec<_> =
                content.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty()).collect();
            if !words.is_empty() {
                return Some(words);
            }
        }
    }

    fn expect(&mut self, subject: &str, expected: &str) -> Result<Vec<&'a [u8]>, Fault> {
        self.next().ok_or_else(|| Fault::cut_off(self.cursor.place(), subject, expected))
    }

    /// Refuses what follows the last of `count` rows.
    fn end(&mut self, what: &str, count: usize) -> Result<(), Fault> {
        match self.next() {
            None => Ok(()),
            Some(words) => {
                let subject = format!("a line behind the last of {count} {what}");
                Err(self.fault(subject, quoted(&words.join(&b' ')), "as many lines as the head says"))
            }
        }
    }

    fn fault(
        &self,
        subject: impl Into<String>,
        found: impl Into<String>,
        expected: impl Into<String>,
    ) -> Fault {
        Fault::new(self.place, subject, found, expected)
    }

    /// The head: a count that the rest can hold, then small whole numbers, zero where they are left out.
    fn head(&mut self, what: &str, least: usize) -> Result<(usize, [u64; 3]), Fault> {
        let subject = format!("the number of {what}");
        let words = self.expect(&subject, "a head of counts")?;
        let number = |rows: &Self, index: usize| match words.get(index) {
            None => Ok(0),
            Some(word) => parse::<u64>(word).ok_or_else(|| {
                let which = if index == 0 { subject.clone() } else { format!("count {index} of the head") };
                rows.fault(which, quoted(word), "a whole number of at least 0")
            }),
        };
        let count = self.cursor.check_count(number(self, 0)?, least, format_args!("{subject}"));
        // the cursor stands on the next line already
        let count = count.map_err(|fault| Fault { place: self.place, ..fault })?;
        Ok((count, [number(self, 1)?, number(self, 2)?, number(self, 3)?]))
    }

    fn index(&self, words: &[&[u8]], place: usize, subject: &str) -> Result<u64, Fault> {
        let word = words.get(place).copied().unwrap_or_default();
        parse(word).ok_or_else(|| self.fault(subject, quoted(word), "a whole number of at least 0"))
    }

    /// A marker or a region; TetGen writes regions as real numbers. Zero is none.
    fn marker(&self, words: &[&[u8]], place: usize, subject: &str) -> Result<i64, Fault> {
        let Some(word) = words.get(place) else { return Ok(0) };
        match parse::<f64>(word) {
            Some(number) if number.fract() == 0.0 && number.abs() < MARKERS_BELOW as f64 => Ok(number as i64),
            _ => Err(self.fault(subject, quoted(word), "a whole number")),
        }
    }
}

#[derive(Default)]
struct Reader {
    dataset: Dataset,
    /// Number of the first point, 0 or 1.
    first: u64,
}

impl Reader {
    fn group(&mut self, kind: &str, number: i64) -> Option<&mut Group> {
        (number != 0).then(|| self.dataset.mesh.groups.entry(name_of(kind, number)).or_default())
    }

    /// `number x y z [attributes] [marker]`
    fn read_nodes(&mut self, part: &Part<'_>) -> Result<(), Fault> {
        let mut rows = Rows::of(part);
        // fewest bytes: `0 0 0 0` and its end
        let (count, [dimension, attributes, _]) = rows.head("points", 8)?;
        if dimension != 3 {
            return Err(rows.fault("the dimension", dimension.to_string(), "3"));
        }
        for index in 0..count {
            let words = rows.expect(&format!("point {index} of {count}"), "a number, x, y and z")?;
            let number = rows.index(&words, 0, "the number of a point")?;
            if index == 0 {
                self.first = number;
            }
            if number != self.first + index as u64 || self.first > 1 {
                let expected =
                    format!("{}: points are numbered on from 0 or 1", self.first.min(1) + index as u64);
                return Err(rows.fault("the number of a point", number.to_string(), expected));
            }
            let mut position = [0.0; 3];
            for (axis, coordinate) in position.iter_mut().enumerate() {
                let word = words.get(axis + 1).copied().unwrap_or_default();
                *coordinate = parse(word).filter(|number: &f64| number.is_finite()).ok_or_else(|| {
                    let subject = format!("{} of point {number}", ["x", "y", "z"][axis]);
                    rows.fault(subject, quoted(word), "a finite number")
                })?;
            }
            self.dataset.mesh.points.push(Vec3::from_array(position));
            let after = usize::try_from(attributes).unwrap_or(usize::MAX).saturating_add(4);
            let marker = rows.marker(&words, after, "the marker of a point")?;
            if let Some(group) = self.group("point", marker) {
                group.points.push(index as u32);
            }
        }
        rows.end("points", count)
    }

    /// Points of `words` from the second on.
    fn corners<const N: usize>(
        &self,
        rows: &Rows<'_>,
        words: &[&[u8]],
        what: &str,
    ) -> Result<[u32; N], Fault> {
        let mut corners = [0; N];
        let count = self.dataset.mesh.points.len() as u64;
        for (place, corner) in corners.iter_mut().enumerate() {
            let subject = format!("a corner of {what} {}", String::from_utf8_lossy(words[0]));
            let number = rows.index(words, place + 1, &subject)?;
            *corner = number.checked_sub(self.first).filter(|corner| *corner < count).ok_or_else(|| {
                let expected =
                    format!("a point: {} to {}", self.first, (self.first + count).saturating_sub(1));
                rows.fault(subject, number.to_string(), expected)
            })? as u32;
        }
        Ok(corners)
    }

    /// `number corners… [middles of edges] [region]`
    fn read_elements(&mut self, part: &Part<'_>) -> Result<(), Fault> {
        let mut rows = Rows::of(part);
        let (count, [node_count, attributes, _]) = rows.head("tetrahedra", 10)?;
        if !matches!(node_count, 4 | 10) {
            return Err(rows.fault(
                "the number of nodes of a tetrahedron",
                node_count.to_string(),
                "4 or 10",
            ));
        }
        for index in 0..count {
            let words =
                rows.expect(&format!("tetrahedron {index} of {count}"), "a number and its corners")?;
            let corners: [u32; 4] = self.corners(&rows, &words, "tetrahedron")?;
            self.dataset.mesh.push_cell(ElementKind::Tet4, &corners);
            let region = if attributes > 0 {
                rows.marker(&words, node_count as usize + 1, "the region of a tetrahedron")?
            } else {
                0
            };
            if let Some(group) = self.group("volume", region) {
                group.cells.push(index as u32);
            }
        }
        if node_count == 10 {
            self.dataset.notes.push("tetrahedra of ten nodes were read by their corners".to_owned());
        }
        rows.end("tetrahedra", count)
    }

    /// `number corners… [marker]`
    fn read_faces(&mut self, part: &Part<'_>) -> Result<(), Fault> {
        let mut rows = Rows::of(part);
        let (count, [markers, _, _]) = rows.head("triangles", 8)?;
        for index in 0..count {
            let words = rows.expect(&format!("triangle {index} of {count}"), "a number and its corners")?;
            let corners: [u32; 3] = self.corners(&rows, &words, "triangle")?;
            self.dataset.mesh.push_facet(ElementKind::Tri3, &corners);
            let marker = if markers > 0 { rows.marker(&words, 4, "the marker of a triangle")? } else { 0 };
            if let Some(group) = self.group("surface", marker) {
                group.facets.push(index as u32);
            }
        }
        rows.end("triangles", count)
    }
}

/// A number for each group that has members: its own where the group is called as one of that number is when it is read
/// (`volume_7`), else the next that is free.
fn numbers<'a>(
    output: &'a Output<'_>,
    kind: &str,
    members: impl Fn(&Group) -> &[u32],
) -> BTreeMap<&'a str, i64> {
    let groups = output.mesh.groups.iter().filter(|(_, group)| !members(group).is_empty());
    let own = |name: &str| -> Option<i64> {
        let number: i64 = name.strip_prefix(kind)?.strip_prefix('_')?.parse().ok()?;
        let is_read = number != 0 && number.unsigned_abs() < MARKERS_BELOW.unsigned_abs();
        (is_read && name_of(kind, number) == name).then_some(number)
    };
    let mut numbers: BTreeMap<&str, i64> =
        groups.clone().filter_map(|(name, _)| Some((name.as_str(), own(name)?))).collect();
    let taken: BTreeSet<i64> = numbers.values().copied().collect();
    let free = (1..).filter(|number| !taken.contains(number));
    for ((name, _), free) in groups.filter(|(name, _)| own(name).is_none()).zip(free) {
        numbers.insert(name, free);
    }
    numbers
}

/// What a group of a number is called.
fn name_of(kind: &str, number: i64) -> String {
    format!("{kind}_{number}")
}

/// A line for each group whose name is lost: what it is called when the file is read.
pub(crate) fn renamed(output: &Output<'_>) -> Vec<String> {
    // of several groups of a member the first is written: another may have none left
    let of = |kind: &'static str, count: usize, members: fn(&Group) -> &[u32]| {
        // a group with members that are not there has been refused
        let left = marks(output, kind, count, members).unwrap_or_default();
        let mut numbers = numbers(output, kind, members);
        numbers.retain(|_, number| left.contains(number));
        (kind, numbers)
    };
    let mesh = output.mesh;
    let kinds = [
        of("point", mesh.points.len(), |group| &group.points),
        of("volume", mesh.cell_count(), |group| &group.cells),
        of("surface", mesh.facet_count(), |group| &group.facets),
    ];
    let mut lines = Vec::new();
    for name in output.mesh.groups.keys() {
        let given =
            kinds.iter().filter_map(|(kind, numbers)| Some(name_of(kind, *numbers.get(name.as_str())?)));
        let given: Vec<String> = given.filter(|given| given != name).collect();
        if !given.is_empty() {
            lines.push(format!("the group `{name}` is called {} in the file", given.join(" and ")));
        }
    }
    lines
}

/// The number of the group of each member, zero for none.
fn marks(
    output: &Output<'_>,
    kind: &str,
    count: usize,
    members: impl Fn(&Group) -> &[u32] + Copy,
) -> Result<Vec<i64>, IoError> {
    let mut marks = vec![0; count];
    for (name, number) in numbers(output, kind, members) {
        for member in members(&output.mesh.groups[name]) {
            let slot = marks.get_mut(*member as usize).ok_or_else(|| {
                let subject = format!("a member of the group `{name}`");
                IoError::request(subject, member, format!("a number below {count}"))
            })?;
            // of several groups the first by name is kept
            if *slot == 0 {
                *slot = number;
            }
        }
    }
    Ok(marks)
}

/// All parts, joined.
fn write(output: &Output<'_>, out: &mut dyn Write) -> Result<(), WriteError> {
    let mesh = output.mesh;
    let point_marks = marks(output, "point", mesh.points.len(), |group| &group.points)?;
    let regions = marks(output, "volume", mesh.cell_count(), |group| &group.cells)?;
    let any = |marks: &[i64]| u8::from(marks.iter().any(|mark| *mark != 0));

    parts::begin(out, 0, "node")?;
    writeln!(out, "{} 3 0 {}", mesh.points.len(), any(&point_marks))?;
    for (index, (position, mark)) in output.positions().iter().zip(&point_marks).enumerate() {
        let [x, y, z] = position.to_array();
        write!(out, "{} {x:?} {y:?} {z:?}", index + 1)?;
        write_mark(out, any(&point_marks), *mark)?;
    }
    parts::begin(out, 1, "ele")?;
    writeln!(out, "{} 4 {}", mesh.cell_count(), any(&regions))?;
    for (index, (cell, region)) in mesh.cells().zip(&regions).enumerate() {
        write!(out, "{}", index + 1)?;
        cell.nodes.iter().try_for_each(|node| write!(out, " {}", node + 1))?;
        write_mark(out, any(&regions), *region)?;
    }
    // always there: an older one of the stem must not be taken for a part of this mesh
    let facet_count = if output.facets == Facets::Written { mesh.facet_count() } else { 0 };
    let markers = marks(output, "surface", mesh.facet_count(), |group| &group.facets)?;
    parts::begin(out, 2, "face")?;
    writeln!(out, "{facet_count} {}", any(&markers))?;
    for (index, (facet, marker)) in mesh.facets().zip(&markers).take(facet_count).enumerate() {
        write!(out, "{}", index + 1)?;
        facet.nodes.iter().try_for_each(|node| write!(out, " {}", node + 1))?;
        write_mark(out, any(&markers), *marker)?;
    }
    Ok(())
}

fn write_mark(out: &mut dyn Write, written: u8, mark: i64) -> std::io::Result<()> {
    if written > 0 { writeln!(out, " {mark}") } else { writeln!(out) }
}

#[cfg(test)]
mod tests;
