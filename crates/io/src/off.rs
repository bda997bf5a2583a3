//! OFF: surfaces as text, points and polygons by number.
//!
//! Colours and normals (`COFF`, `NOFF`) are read over; polygons of more than four corners are cut into triangles.

use std::io::Write;

use souple_math::Vec3;
use souple_table::{Entry, counted};

use crate::Dataset;
use crate::cursor::{Cursor, parse};
use crate::dataset::Output;
use crate::error::{Fault, Place, quoted};
use crate::facets::{Polygons, SurfacePart, check_end, check_facets};
use crate::format::{Format, WriteError};
use crate::holds::{Holds, Shapes};

pub(crate) static OFF: Entry<Format> = Entry {
    name: "off",
    summary: "OFF surface: triangles and quadrilaterals as text",
    source: "Geomview manual, OFF files",
    parameters: &[],
    build: Format {
        extensions: &["off"],
        family: &[],
        parts: &[],
        recognises,
        read: Some(read),
        write: Some(write),
        holds: Holds { shapes: Shapes::Facets, ..Holds::BARE },
    },
};

/// Kinds of OFF files whose points begin with `x y z`.
const KINDS: [&[u8]; 4] = [b"OFF", b"COFF", b"NOFF", b"CNOFF"];

fn recognises(bytes: &[u8]) -> bool {
    let word = bytes.split(u8::is_ascii_whitespace).next().unwrap_or_default();
    KINDS.contains(&word)
}

/// Lines that say something, without their comments, with their places.
struct Lines<'a> {
    cursor: Cursor<'a>,
}

impl<'a> Lines<'a> {
    fn next(&mut self) -> Option<(Place, Vec<&'a [u8]>)> {
        loop {
            let place = self.cursor.place();
            let line = self.cursor.line()?;
            let content = line.split(|byte| *byte == b'#').next().unwrap_or_default();
            let words: Vec<_> =
                content.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty()).collect();
            if !words.is_empty() {
                return Some((place, words));
            }
        }
    }

    fn expect(&mut self, subject: &str, expected: &str) -> Result<(Place, Vec<&'a [u8]>), Fault> {
        self.next().ok_or_else(|| Fault::cut_off(self.cursor.place(), subject, expected))
    }
}

pub(crate) fn read(bytes: &[u8]) -> Result<Dataset, Fault> {
    let mut lines = Lines { cursor: Cursor::new(bytes) };
    let (place, mut words) = lines.expect("the kind of the OFF file", "OFF")?;
    if !KINDS.contains(&words[0]) || words.get(1) == Some(&&b"BINARY"[..]) {
        let expected = "OFF, COFF, NOFF or CNOFF, as text";
        return Err(Fault::new(place, "the kind of the OFF file", quoted(&words.join(&b' ')), expected));
    }
    // colours may be left out, as writers do; a point of a kind with normals that has none is cut off, or not meant as one
    let (numbers, lengths): (_, &[usize]) = match words[0] {
        b"NOFF" => ("x, y, z and a normal", &[6, 9, 10]),
        b"COFF" => ("x, y, z and a colour", &[1, 2, 3, 6, 7, 9, 10]),
        b"CNOFF" => ("x, y, z, a normal and a colour", &[6, 9, 10]),
        _ => ("x, y and z", &[1, 2, 3, 6, 7, 9, 10]),
    };
    // the counts stand behind the kind or on the next line
    words.remove(0);
    let (place, counts) = if words.is_empty() { lines.expect("the counts", COUNTS)? } else { (place, words) };
    let [point_count, facet_count] = read_counts(&lines.cursor, place, &counts)?;

    let mut dataset = Dataset::default();
    for point in 0..point_count {
        let (place, words) = lines.expect(&format!("point {point} of {point_count}"), numbers)?;
        // with a normal, a colour of three or four numbers, or both; a facet among points has another length
        if !lengths.contains(&words.len()) {
            let found = counted(words.len() as u64, "number");
            return Err(Fault::new(place, format!("point {point} of {point_count}"), found, numbers));
        }
        let mut position = [0.0; 3];
        for (axis, coordinate) in position.iter_mut().enumerate() {
            let word = words.get(axis).copied().unwrap_or_default();
            *coordinate = parse(word).filter(|number: &f64| number.is_finite()).ok_or_else(|| {
                let subject = format!("{} of point {point}", ["x", "y", "z"][axis]);
                Fault::new(place, subject, quoted(word), "a finite number")
            })?;
        }
        dataset.mesh.points.push(Vec3::from_array(position));
    }
    let mut polygons = Polygons::default();
    let mut corners = Vec::new();
    for facet in 0..facet_count {
        let (place, words) =
            lines.expect(&format!("facet {facet} of {facet_count}"), "a count and corners")?;
        read_corners(place, facet, &words, point_count, &mut corners)?;
        polygons.push(&mut dataset.mesh, &corners);
    }
    check_facets(&lines.cursor, &dataset.mesh)?;
    dataset.notes = polygons.notes();
    if let Some((place, words)) = lines.next() {
        let subject = format!("a facet behind the last of {facet_count}");
        return Err(Fault::new(
            place,
            subject,
            quoted(&words.join(&b' ')),
            "as many facets as the head says",
        ));
    }
    check_end(bytes, &dataset.mesh, &mut dataset.notes)?;
    Ok(dataset)
}

const COUNTS: &str = "the numbers of points, facets and edges";

fn read_counts(cursor: &Cursor<'_>, place: Place, words: &[&[u8]]) -> Result<[usize; 2], Fault> {
    let mut counts = [0; 2];
    // fewest bytes: `0 0 0` and its end; `3 0 1 2` and its end
    for (index, (count, (name, least))) in counts.iter_mut().zip([("points", 6), ("facets", 8)]).enumerate() {
        let subject = format!("the number of {name}");
        let word = words.get(index).copied().unwrap_or_default();
        let number = parse(word).ok_or_else(|| {
            Fault::new(place, subject.clone(), quoted(word), "a whole number of at least 0")
        })?;
        let checked = cursor.check_count(number, least, format_args!("{subject}"));
        // the cursor stands on the next line already
        *count = checked.map_err(|fault| Fault { place, ..fault })?;
    }
    Ok(counts)
}

/// `count corner corner … [colour]`
fn read_corners(
    place: Place,
    facet: usize,
    words: &[&[u8]],
    point_count: usize,
    corners: &mut Vec<u32>,
) -> Result<(), Fault> {
    let subject = || format!("the number of corners of facet {facet}");
    let count: usize = parse(words[0])
        .filter(|count| *count >= 3)
        .ok_or_else(|| Fault::new(place, subject(), quoted(words[0]), "3 or more"))?;
    corners.clear();
    if words.len() - 1 < count {
        let found = format!("{count}, but the line has {}", words.len() - 1);
        return Err(Fault::new(place, subject(), found, "as many corners as the line has"));
    }
    for word in &words[1..=count] {
        let corner =
            parse(word).filter(|corner: &u32| (*corner as usize) < point_count).ok_or_else(|| {
                let expected = format!("the number of a point: below {point_count}");
                Fault::new(place, format!("a corner of facet {facet}"), quoted(word), expected)
            })?;
        corners.push(corner);
    }
    Ok(())
}

fn write(output: &Output<'_>, out: &mut dyn Write) -> Result<(), WriteError> {
    let part = SurfacePart::of(output);
    writeln!(out, "OFF\n# souple surface{}", part.origin.remark())?;
    writeln!(out, "{} {} 0", part.positions.len(), part.facets.len())?;
    for position in &part.positions {
        let [x, y, z] = position.to_array();
        writeln!(out, "{x:?} {y:?} {z:?}")?;
    }
    for facet in &part.facets {
        write!(out, "{}", facet.corners().len())?;
        facet.corners().iter().try_for_each(|corner| write!(out, " {corner}"))?;
        writeln!(out)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::survives_faults;

    const TEXT: &str = "OFF # a tent\n\n4 3 5\n0 0 0\n1 0 0 # right\n1 1 0\n0.5 0.5 1e0\n3 0 1 3\n3 1 2 3 255 0 0\n\
                        4 0 1 2 3\n";

    #[test]
    fn text_by_hand() {
        let dataset = read(TEXT.as_bytes()).unwrap();
        let facets: Vec<_> = dataset.mesh.facets().map(|facet| facet.nodes.to_vec()).collect();
        assert_eq!(facets, [vec![0, 1, 3], vec![1, 2, 3], vec![0, 1, 2, 3]]);
        assert!(dataset.notes.is_empty(), "{:?}", dataset.notes);
        let coloured =
            TEXT.replace("OFF # a tent\n\n4 3 5", "COFF 4 3 5").replace("0 0 0\n", "0 0 0 1 1 1 1\n");
        assert_eq!(read(coloured.as_bytes()).unwrap().mesh, dataset.mesh);
    }

    #[test]
    fn faults_name_line_value_and_range() {
        for (from, to, words) in [
            ("OFF", "4OFF", "line 1: the kind of the OFF file is \"4OFF\""),
            ("OFF #", "OFF BINARY #", "expected OFF, COFF, NOFF or CNOFF, as text"),
            ("4 3 5", "4", "line 3: the number of facets is \"\""),
            ("4 3 5", "99999999999 3 5", "the rest of the file has room for"),
            ("4 3 5", "4 -3 5", "the number of facets is \"-3\""),
            ("4 3 5", "4 4 5", "facet 3 of 4 is missing"),
            ("4 3 5", "5 2 5", "line 8: point 4 of 5 is 4 numbers; expected x, y and z"),
            (
                "OFF # a tent\n\n4 3 5",
                "NOFF 5 2 5",
                "point 0 of 5 is 3 numbers; expected x, y, z and a normal",
            ),
            ("4 3 5", "3 4 5", "line 7: the number of corners of facet 0 is \"0.5\""),
            ("1 1 0", "1 inf 0", "line 6: y of point 2 is \"inf\"; expected a finite number"),
            ("1 1 0", "1 1", "line 6: z of point 2 is \"\""),
            (
                "3 0 1 3",
                "3 0 1 4",
                "line 8: a corner of facet 0 is \"4\"; expected the number of a point: below 4",
            ),
            ("3 0 1 3", "3 0 1 -1", "a corner of facet 0 is \"-1\""),
            ("3 0 1 3", "9 0 1 3", "is 9, but the line has 3"),
            ("3 0 1 3", "2 0 1", "expected 3 or more"),
            ("4 3 5\n", "4 2 5\n", "line 10: a facet behind the last of 2"),
        ] {
            assert!(TEXT.contains(from), "{from}");
            let message = match read(TEXT.replacen(from, to, 1).as_bytes()) {
                Err(fault) => fault.to_string(),
                Ok(dataset) => panic!("{from} -> {to}: {dataset:?}"),
            };
            assert!(message.contains(words), "{from} -> {to}: {message}");
        }
    }

    #[test]
    fn no_fault_panics() {
        survives_faults("off", TEXT.as_bytes(), read);
    }
}
