//! Wavefront OBJ: surfaces of triangles and quadrilaterals, with their groups.
//!
//! Normals, textures and materials are not read. Polygons of more corners are cut into triangles; a note
//! says so.

use std::io::Write;

use souple_math::Vec3;
use souple_mesh::Mesh;
use souple_table::{Entry, counted};

use crate::cursor::parse;
use crate::dataset::{Output, tidy_groups};
use crate::error::{Fault, Place, quoted};
use crate::facets::{Origin, Polygons, SurfacePart, check_end};
use crate::format::{Format, WriteError};
use crate::holds::{HeldGroups, Holds, Shapes};
use crate::{Dataset, IoError};

pub(crate) static OBJ: Entry<Format> = Entry {
    name: "obj",
    summary: "Wavefront OBJ surface: triangles and quadrilaterals in groups",
    source: "Wavefront, Object Files (.obj), 1992",
    parameters: &[],
    build: Format {
        extensions: &["obj"],
        family: &[],
        parts: &[],
        recognises: |_| false,
        read: Some(read),
        write: Some(write),
        holds: Holds { shapes: Shapes::Facets, groups: HeldGroups::OfFacets, ..Holds::BARE },
    },
};

/// Statements that change nothing of the geometry.
const WITHOUT_GEOMETRY: &[&[u8]] = &[
    b"vn",
    b"vt",
    b"vp",
    b"s",
    b"mg",
    b"usemtl",
    b"mtllib",
    b"usemap",
    b"maplib",
    b"l",
    b"p",
    b"bevel",
    b"c_interp",
    b"d_interp",
    b"lod",
    b"shadow_obj",
    b"trace_obj",
];

/// Of those what a file has of looks, in the words of a note.
const LOOKS: [(&str, &[&[u8]]); 3] = [
    ("normals", &[b"vn"]),
    ("texture coordinates", &[b"vt"]),
    ("materials", &[b"usemtl", b"mtllib", b"usemap", b"maplib"]),
];

/// Most groups that one facet is in.
const MOST_GROUPS: usize = 16;

/// With which editors of Windows begin a text.
const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

/// The group of facets that are in no other.
const DEFAULT: &str = "default";

#[derive(Default)]
struct Reader {
    mesh: Mesh,
    facet_count: u32,
    /// Groups of the facets that follow.
    groups: Vec<String>,
    /// Lines of more groups than are read.
    crowded: usize,
    /// Corners of the facet at hand.
    corners: Vec<u32>,
    polygons: Polygons,
    /// Which of [`LOOKS`] there are.
    has_looks: [bool; LOOKS.len()],
}

pub(crate) fn read(bytes: &[u8]) -> Result<Dataset, Fault> {
    let mut reader = Reader::default();
    // a backslash joins a line with the next
    let mut joined: Vec<u8> = Vec::new();
    let text = bytes.strip_prefix(BYTE_ORDER_MARK).unwrap_or(bytes);
    for (index, line) in text.split(|byte| *byte == b'\n').enumerate() {
        let line = line.strip_suffix(b"\r").unwrap_or(line);
        if let Some(start) = line.strip_suffix(b"\\") {
            joined.extend_from_slice(start);
            joined.push(b' ');
            continue;
        }
        joined.extend_from_slice(line);
        reader.statement(&joined, index + 1)?;
        joined.clear();
    }
    if !joined.is_empty() {
        let place = Place::Line(crate::cursor::line_of(bytes, bytes.len()));
        return Err(Fault::cut_off(place, "the line that a backslash continues", "another line"));
    }
    let mut dataset = reader.finish(bytes)?;
    check_end(bytes, &dataset.mesh, &mut dataset.notes)?;
    Ok(dataset)
}

impl Reader {
    fn statement(&mut self, line: &[u8], number: usize) -> Result<(), Fault> {
        let place = Place::Line(number);
        let content = line.split(|byte| *byte == b'#').next().unwrap_or_default();
        let mut words = content.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
        let Some(keyword) = words.next() else { return Ok(()) };
        match keyword {
            b"v" => {
                let point = read_point(words, place)?;
                if self.mesh.points.len() >= u32::MAX as usize {
                    return Err(Fault::new(place, "the number of points", "2^32", "fewer"));
                }
                self.mesh.points.push(point);
            }
            b"f" => self.facet(words, place)?,
            b"g" | b"o" => {
                let names = words.by_ref().take(MOST_GROUPS);
                let names = names.map(|word| String::from_utf8_lossy(word).into_owned());
                self.groups = names.filter(|name| name != DEFAULT).collect();
                self.crowded += usize::from(words.next().is_some());
            }
            other if WITHOUT_GEOMETRY.contains(&other) => {
                for (has, (_, keywords)) in self.has_looks.iter_mut().zip(LOOKS) {
                    *has |= keywords.contains(&other);
                }
            }
            other => {
                let expected = "v, f, g, o, vn, vt, s, usemtl, mtllib, l, p or a comment";
                return Err(Fault::new(place, "the statement", quoted(other), expected));
            }
        }
        Ok(())
    }

    /// `f point/texture/normal …`, numbers from 1, or from the latest back if negative.
    fn facet<'a>(&mut self, words: impl Iterator<Item = &'a [u8]>, place: Place) -> Result<(), Fault> {
        let count = self.mesh.points.len();
        self.corners.clear();
        for word in words {
            let number = word.split(|byte| *byte == b'/').next().unwrap_or_default();
            let index = match parse::<i64>(number) {
                Some(number) if number > 0 => Some(number - 1),
                Some(number) if number < 0 => number.checked_add(count as i64),
                _ => None,
            };
            let corner =
                index.and_then(|index| u32::try_from(index).ok()).filter(|corner| (*corner as usize) < count);
            self.corners.push(corner.ok_or_else(|| {
                let expected = format!("1 to {count}, or -{count} to -1: a point given before");
                Fault::new(place, "a corner of the facet", quoted(word), expected)
            })?);
        }
        if self.corners.len() < 3 {
            let found = self.corners.len().to_string();
            return Err(Fault::new(place, "the number of corners", found, "3 or more"));
        }
        let made = self.polygons.push(&mut self.mesh, &self.corners) as u32;
        for name in &self.groups {
            // the name is there already, but for the first facet of each group
            if !self.mesh.groups.contains_key(name) {
                self.mesh.groups.insert(name.clone(), Default::default());
            }
            if let Some(group) = self.mesh.groups.get_mut(name) {
                group.facets.extend(self.facet_count..self.facet_count + made);
            }
        }
        self.facet_count += made;
        Ok(())
    }

    fn finish(mut self, bytes: &[u8]) -> Result<Dataset, Fault> {
        if self.facet_count == 0 {
            let place = Place::Line(crate::cursor::line_of(bytes, bytes.len()));
            let found = format!("none ({})", counted(self.mesh.points.len() as u64, "point"));
            return Err(Fault::new(place, "the number of facets", found, "points (v) and facets (f)"));
        }
        tidy_groups(&mut self.mesh);
        let mut notes = self.polygons.notes();
        if self.crowded > 0 {
            notes.push(format!(
                "{} of more than {MOST_GROUPS} groups: those behind were left out",
                counted(self.crowded as u64, "line")
            ));
        }
        let looks = LOOKS.iter().zip(self.has_looks).filter(|(_, has)| *has).map(|((name, _), _)| *name);
        let looks = looks.collect::<Vec<_>>().join(", ");
        let unread = (!looks.is_empty()).then(|| format!("without what the file has of looks: {looks}"));
        Ok(Dataset { mesh: self.mesh, notes, unread, ..Dataset::default() })
    }
}

/// `v x y z [w or colours]`
fn read_point<'a>(mut words: impl Iterator<Item = &'a [u8]>, place: Place) -> Result<Vec3, Fault> {
    let mut position = [0.0; 3];
    for (axis, coordinate) in ["x", "y", "z"].iter().zip(&mut position) {
        let subject = || format!("{axis} of the point");
        let word = words.next().ok_or_else(|| Fault::new(place, subject(), "missing", "a finite number"))?;
        *coordinate = parse(word)
            .filter(|number: &f64| number.is_finite())
            .ok_or_else(|| Fault::new(place, subject(), quoted(word), "a finite number"))?;
    }
    Ok(Vec3::from_array(position))
}

/// Writes the facets; a mesh with cells and without facets gives its boundary.
fn write(output: &Output<'_>, out: &mut dyn Write) -> Result<(), WriteError> {
    let part = SurfacePart::of(output);
    writeln!(out, "# souple surface{}", part.origin.remark())?;
    part.positions.iter().try_for_each(|position| write_point(*position, out))?;
    let memberships = memberships(output, &part)?;
    let mut current: &[&str] = &[];
    for (facet, groups) in part.facets.iter().zip(&memberships) {
        if groups != current {
            // a group line without names means the default group
            writeln!(out, "g {}", if groups.is_empty() { DEFAULT.to_owned() } else { groups.join(" ") })?;
            current = groups;
        }
        write_facet(facet.corners(), out)?;
    }
    Ok(())
}

/// Names of the groups of each facet; none for a boundary.
fn memberships<'a>(output: &Output<'a>, part: &SurfacePart) -> Result<Vec<Vec<&'a str>>, IoError> {
    let mut memberships = vec![Vec::new(); part.facets.len()];
    if part.origin == Origin::Boundary {
        return Ok(memberships);
    }
    for (name, group) in &output.mesh.groups {
        let breaks = |letter: char| letter.is_whitespace() || matches!(letter, '#' | '\\');
        if !group.facets.is_empty() && (name.is_empty() || name.contains(breaks) || name == DEFAULT) {
            let expected = "a word without spaces, # and \\, which is not `default`, in an OBJ file";
            return Err(IoError::request("the name of a group", format!("`{name}`"), expected));
        }
        for facet in &group.facets {
            let count = memberships.len();
            let list = memberships.get_mut(*facet as usize).ok_or_else(|| {
                IoError::request(
                    format!("a facet of the group `{name}`"),
                    facet,
                    format!("a number below {count}"),
                )
            })?;
            list.push(name.as_str());
        }
    }
    if let Some((facet, names)) = memberships.iter().enumerate().find(|(_, names)| names.len() > MOST_GROUPS)
    {
        let subject = format!("the number of groups of facet {facet}");
        let expected = format!("at most {MOST_GROUPS} in an OBJ file");
        return Err(IoError::request(subject, names.len(), expected));
    }
    Ok(memberships)
}

fn write_point(position: Vec3, out: &mut dyn Write) -> std::io::Result<()> {
    let [x, y, z] = position.to_array();
    writeln!(out, "v {x:?} {y:?} {z:?}")
}

fn write_facet(nodes: &[u32], out: &mut dyn Write) -> std::io::Result<()> {
    write!(out, "f")?;
    nodes.iter().try_for_each(|node| write!(out, " {}", node + 1))?;
    writeln!(out)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{real_input, survives_faults};
    use souple_mesh::ElementKind;

    const SURFACE: &str = "# a lid\nmtllib x.mtl\nv 0 0 0\nv 1 0 0 # c\nv 1 1 0\nv 0 1 0\nv 0.5 0.5 1e0\nvn 0 0 1\n\
                           g lid top\nf 1//1 2/1/1 3 4\ng side\nf -5 -4 \\\n -1\ns off\n";

    #[test]
    fn facets_and_groups() {
        let dataset = read(SURFACE.as_bytes()).unwrap();
        let facets: Vec<_> = dataset.mesh.facets().map(|facet| facet.nodes.to_vec()).collect();
        assert_eq!(facets, [vec![0, 1, 2, 3], vec![0, 1, 4]]);
        assert_eq!(dataset.mesh.groups["top"].facets, [0]);
        assert_eq!(dataset.mesh.groups["side"].facets, [1]);
        assert!(dataset.notes.is_empty(), "{:?}", dataset.notes);
        assert_eq!(dataset.unread.unwrap(), "without what the file has of looks: normals, materials");
    }

    #[test]
    fn round_trip() {
        let mesh = read(SURFACE.as_bytes()).unwrap().mesh;
        let mut bytes = Vec::new();
        write(&Output::new(&mesh), &mut bytes).unwrap();
        assert_eq!(read(&bytes).unwrap().mesh, mesh);
    }

    #[test]
    fn polygons_are_cut_and_degenerate_facets_left_out() {
        let text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv -1 1 0\ng a\nf 1 2 3 4 5\ng b\nf 1 1 2\nf 1 2 2 1\nf 1 2 3\n";
        let dataset = read(text.as_bytes()).unwrap();
        assert_eq!(dataset.mesh.count_of(ElementKind::Tet4), 0);
        assert_eq!(dataset.mesh.facet_count(), 4);
        assert_eq!(
            (&dataset.mesh.groups["a"].facets[..], &dataset.mesh.groups["b"].facets[..]),
            (&[0, 1, 2][..], &[3][..])
        );
        assert_eq!(dataset.notes.len(), 2);
    }

    /// Names that the reader takes for something else are refused, and more groups than it reads.
    #[test]
    fn groups_that_cannot_be_held_are_refused() {
        let mesh = read(SURFACE.as_bytes()).unwrap().mesh;
        let refused = |names: Vec<String>| {
            let mut mesh = mesh.clone();
            let group = souple_mesh::Group { facets: vec![0], ..Default::default() };
            mesh.groups = names.into_iter().map(|name| (name, group.clone())).collect();
            let mut bytes = Vec::new();
            match write(&Output::new(&mesh), &mut bytes) {
                Err(error) => Some(error.to_string()),
                Ok(()) => {
                    assert_eq!(read(&bytes).unwrap().mesh, mesh);
                    None
                }
            }
        };
        for name in ["", "two words", "a#b", "a\\", "default"] {
            let message = refused(vec![name.to_owned()]).unwrap();
            assert!(
                message.starts_with(&format!("the name of a group is `{name}`; expected a word")),
                "{message}"
            );
        }
        let many = |count: usize| (0..count).map(|k| format!("g{k:02}")).collect::<Vec<String>>();
        assert_eq!(refused(many(MOST_GROUPS)), None);
        let message = refused(many(MOST_GROUPS + 1)).unwrap();
        assert!(message.contains("the number of groups of facet 0 is 17; expected at most 16"), "{message}");
        let notes = read(SURFACE.replace("g lid top", &format!("g {}", many(17).join(" "))).as_bytes())
            .unwrap()
            .notes;
        assert_eq!(notes, ["1 line of more than 16 groups: those behind were left out"]);
    }

    #[test]
    fn faults_name_line_value_and_range() {
        for (text, line, found) in [
            ("v 0 0\n", 1, "missing"),
            ("v 0 nan 0\n", 1, "\"nan\""),
            ("v 0 0 0\nf 1 2 3\n", 2, "\"2\""),
            ("v 0 0 0\nf 1 1\n", 2, "2"),
            ("v 0 0 0\nf 0 0 0\n", 2, "\"0\""),
            ("v 0 0 0\n\n\u{1}rubbish\n", 3, "\"\\u{1}rubbish\""),
            ("v 0 0 0\n", 2, "none (1 point)"),
        ] {
            let fault = read(text.as_bytes()).unwrap_err();
            assert_eq!((fault.place, fault.found.as_str()), (Place::Line(line), found), "{text:?}");
        }
    }

    /// A tent cut off: within its last line with a point that no facet has come to, behind a line, and within the last number
    /// of all, which only the missing end of the line tells.
    #[test]
    fn cut_off_files() {
        let whole = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\nf 2 3 4\n";
        let cut = |length: usize| read(&whole.as_bytes()[..length]);
        let at = |text: &str| whole.find(text).unwrap() + text.len();
        assert!(cut(whole.len()).unwrap().notes.is_empty());
        let fault = cut(at("f 1 2 3")).unwrap_err().to_string();
        assert!(fault.contains("line 5") && fault.contains("1 point is in no facet"), "{fault}");
        let notes = cut(at("f 1 2 3\n")).unwrap().notes;
        assert!(notes[0].contains("1 point is in no facet, the first is points[3]"), "{notes:?}");
        let notes = cut(whole.len() - 1).unwrap().notes;
        assert_eq!(notes, ["the last line has no end: the file may be cut off"]);
    }

    #[test]
    fn no_fault_panics() {
        survives_faults("obj", SURFACE.as_bytes(), read);
    }

    /// Counts of statements `v` and `f` of the files as found.
    #[test]
    fn real_surfaces() {
        for (name, points, facets) in
            [("liver-smooth.obj", 2194, 4384), ("frog.obj", 2397, 4790), ("malleus.obj", 1876, 3748)]
        {
            let Some(bytes) = real_input(name) else { return };
            let mesh = read(&bytes).unwrap().mesh;
            assert_eq!((mesh.points.len(), mesh.facet_count()), (points, facets), "{name}");
        }
    }
}
