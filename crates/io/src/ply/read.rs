//! Reads PLY files.

use souple_math::Vec3;

use super::header::{self, Element, Header, Property, Scalar};
use super::recognises;
use crate::Dataset;
use crate::cursor::{Cursor, Encoding, Endian, open_end};
use crate::dataset::Field;
use crate::error::Fault;
use crate::facets::{Polygons, check_facets};
use crate::format::wrong_start;

pub(super) fn read(bytes: &[u8]) -> Result<Dataset, Fault> {
    if !recognises(bytes) {
        return Err(wrong_start(bytes, "PLY", "a line `ply`"));
    }
    let mut cursor = Cursor::new(bytes);
    let Header { encoding, elements } = header::read(&mut cursor)?;
    for (name, subject) in [("vertex", "the element vertex"), ("face", "the element face")] {
        let count = elements.iter().filter(|element| element.name == name).count();
        if count != 1 {
            return Err(cursor.fault(subject, format!("given {count} times"), "one of it"));
        }
    }
    cursor.encoding = encoding;
    let mut dataset = Dataset::default();
    for element in &elements {
        let least = element.least_bytes(encoding);
        cursor.check_count(element.count, least, format_args!("the number of {}", element.name))?;
        match element.name.as_str() {
            "vertex" => read_points(&mut cursor, element, &mut dataset)?,
            "face" => read_faces(&mut cursor, element, &mut dataset)?,
            _ => {
                for item in 0..element.count {
                    for property in &element.properties {
                        read_numbers(
                            &mut cursor,
                            property,
                            format_args!("{} {item}", element.name),
                            &mut |_| {},
                        )?;
                    }
                }
                if element.count > 0 {
                    dataset
                        .notes
                        .push(format!("{} elements `{}` were left out", element.count, element.name));
                }
            }
        }
    }
    check_facets(&cursor, &dataset.mesh)?;
    if encoding == Encoding::Text {
        cursor.skip_space();
        dataset.notes.extend(open_end(bytes, "the last line"));
    }
    if !cursor.rest().is_empty() {
        dataset.notes.push(format!("{} bytes behind the last element were left out", cursor.rest().len()));
    }
    Ok(dataset)
}

fn read_points(cursor: &mut Cursor<'_>, element: &Element, dataset: &mut Dataset) -> Result<(), Fault> {
    let place_of = |name: &str| {
        let fits = |property: &Property| property.name == name && property.count.is_none();
        element.properties.iter().position(fits)
    };
    let axes = ["x", "y", "z"].map(place_of);
    if let Some(axis) = axes.iter().position(Option::is_none) {
        let subject = format!("the property {} of vertex", ["x", "y", "z"][axis]);
        return Err(cursor.fault(subject, "missing", "a number of each vertex"));
    }
    // what is left are fields; the same name twice would be one field too long
    let mut fields: Vec<Option<Field>> = Vec::new();
    for (place, property) in element.properties.iter().enumerate() {
        let known = fields.iter().flatten().any(|field| field.name == property.name);
        let is_field = property.count.is_none() && !axes.contains(&Some(place)) && !known;
        fields.push(is_field.then(|| Field::new(property.name.clone(), 1, Vec::new())));
    }
    for point in 0..element.count {
        let mut position = [0.0; 3];
        for (place, property) in element.properties.iter().enumerate() {
            let axis = axes.iter().position(|axis| *axis == Some(place));
            let mut value = f64::NAN;
            read_numbers(
                cursor,
                property,
                format_args!("{} of vertex {point}", property.name),
                &mut |number| {
                    value = number;
                },
            )?;
            if let Some(axis) = axis {
                if !value.is_finite() {
                    let subject = format!("{} of vertex {point}", property.name);
                    return Err(cursor.fault(subject, value.to_string(), "a finite number"));
                }
                position[axis] = value;
            } else if let Some(field) = &mut fields[place] {
                field.values.push(value);
            }
        }
        dataset.mesh.points.push(Vec3::from_array(position));
    }
    dataset.point_fields = fields.into_iter().flatten().collect();
    Ok(())
}

fn read_faces(cursor: &mut Cursor<'_>, element: &Element, dataset: &mut Dataset) -> Result<(), Fault> {
    let is_corners = |property: &Property| {
        property.count.is_some() && matches!(property.name.as_str(), "vertex_indices" | "vertex_index")
    };
    let Some(corners_at) = element.properties.iter().position(is_corners) else {
        return Err(cursor.fault("the list of corners of face", "missing", "vertex_indices or vertex_index"));
    };
    let (mut corners, mut outside) = (Vec::new(), None);
    let mut polygons = Polygons::default();
    for face in 0..element.count {
        corners.clear();
        for (place, property) in element.properties.iter().enumerate() {
            let subject = format_args!("{} of face {face}", property.name);
            if place != corners_at {
                read_numbers(cursor, property, subject, &mut |_| {})?;
                continue;
            }
            read_numbers(cursor, property, subject, &mut |number| {
                let is_index = number >= 0.0 && number < f64::from(u32::MAX) && number.fract() == 0.0;
                if is_index {
                    corners.push(number as u32);
                } else {
                    outside = Some(number);
                }
            })?;
            if let Some(number) = outside {
                return Err(cursor.fault(
                    subject.to_string(),
                    number.to_string(),
                    "the number of a vertex, from 0",
                ));
            }
            if corners.len() < 3 {
                return Err(cursor.fault(
                    subject.to_string(),
                    format!("{} corners", corners.len()),
                    "3 or more",
                ));
            }
        }
        polygons.push(&mut dataset.mesh, &corners);
    }
    dataset.notes.extend(polygons.notes());
    Ok(())
}

/// The number of a property, or all numbers of its list.
fn read_numbers(
    cursor: &mut Cursor<'_>,
    property: &Property,
    subject: std::fmt::Arguments<'_>,
    take: &mut dyn FnMut(f64),
) -> Result<(), Fault> {
    let count = match property.count {
        None => 1,
        Some(count_type) => {
            let count = read_number(cursor, count_type, subject)?;
            if !(count >= 0.0 && count.fract() == 0.0) {
                return Err(cursor.fault(
                    format!("the length of {subject}"),
                    count.to_string(),
                    "a whole number",
                ));
            }
            let least = match cursor.encoding {
                Encoding::Text => 2,
                Encoding::Binary(_) => property.value.width(),
            };
            cursor.check_count(count as u64, least, subject)?
        }
    };
    for _ in 0..count {
        take(read_number(cursor, property.value, subject)?);
    }
    Ok(())
}

/// Whole numbers of 4 bytes are exact in `f64`.
fn read_number(
    cursor: &mut Cursor<'_>,
    scalar: Scalar,
    subject: std::fmt::Arguments<'_>,
) -> Result<f64, Fault> {
    let Encoding::Binary(endian) = cursor.encoding else {
        return cursor.double(subject);
    };
    let mut bytes = [0; 8];
    let taken = cursor.take(scalar.width(), subject)?;
    bytes[..taken.len()].copy_from_slice(taken);
    if endian == Endian::Big {
        bytes[..taken.len()].reverse();
    }
    let [a, b, c, d, ..] = bytes;
    Ok(match scalar {
        Scalar::Int8 => f64::from(a as i8),
        Scalar::Uint8 => f64::from(a),
        Scalar::Int16 => f64::from(i16::from_le_bytes([a, b])),
        Scalar::Uint16 => f64::from(u16::from_le_bytes([a, b])),
        Scalar::Int32 => f64::from(i32::from_le_bytes([a, b, c, d])),
        Scalar::Uint32 => f64::from(u32::from_le_bytes([a, b, c, d])),
        Scalar::Float32 => f64::from(f32::from_le_bytes([a, b, c, d])),
        Scalar::Float64 => f64::from_le_bytes(bytes),
    })
}
