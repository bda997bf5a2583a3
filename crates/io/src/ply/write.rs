//! Writes PLY files.

use std::io::Write;

use crate::IoError;
use crate::cursor::{Encoding, Endian};
use crate::dataset::{Field, Output};
use crate::facets::SurfacePart;
use crate::format::WriteError;

/// Doubles on the points, 4-byte numbers of corners; fields of one number each are properties of the points.
pub(super) fn write(output: &Output<'_>, encoding: Encoding, out: &mut dyn Write) -> Result<(), WriteError> {
    let part = SurfacePart::of(output);
    let fields: Vec<&Field> = output.point_fields.iter().filter(|field| field.components == 1).collect();
    for (index, field) in fields.iter().enumerate() {
        let taken = ["x", "y", "z"].contains(&field.name.as_str())
            || fields[..index].iter().any(|other| other.name == field.name);
        if field.name.is_empty()
            || field.name.contains(|c: char| c.is_whitespace() || c.is_control())
            || taken
        {
            let expected = "a word without spaces, once, and not x, y or z in a PLY file";
            return Err(IoError::request("the name of a field", format!("`{}`", field.name), expected).into());
        }
    }
    let name = match encoding {
        Encoding::Text => "ascii",
        Encoding::Binary(Endian::Little) => "binary_little_endian",
        Encoding::Binary(Endian::Big) => "binary_big_endian",
    };
    write!(out, "ply\nformat {name} 1.0\ncomment souple surface{}\n", part.origin.remark())?;
    writeln!(out, "element vertex {}", part.positions.len())?;
    for name in ["x", "y", "z"].into_iter().chain(fields.iter().map(|field| field.name.as_str())) {
        writeln!(out, "property double {name}")?;
    }
    writeln!(out, "element face {}", part.facets.len())?;
    writeln!(out, "property list uchar int vertex_indices\nend_header")?;

    for (position, point) in part.positions.iter().zip(&part.points) {
        let values = fields.iter().map(|field| field.values[*point as usize]);
        let mut separator = "";
        for value in position.to_array().into_iter().chain(values) {
            match encoding {
                Encoding::Text => write!(out, "{separator}{value:?}")?,
                Encoding::Binary(Endian::Little) => out.write_all(&value.to_le_bytes())?,
                Encoding::Binary(Endian::Big) => out.write_all(&value.to_be_bytes())?,
            }
            separator = " ";
        }
        if encoding == Encoding::Text {
            writeln!(out)?;
        }
    }
    for facet in &part.facets {
        let corners = facet.corners();
        match encoding {
            Encoding::Text => write!(out, "{}", corners.len())?,
            Encoding::Binary(_) => out.write_all(&[corners.len() as u8])?,
        }
        for corner in corners {
            let number = i32::try_from(*corner).map_err(std::io::Error::other)?;
            match encoding {
                Encoding::Text => write!(out, " {number}")?,
                Encoding::Binary(Endian::Little) => out.write_all(&number.to_le_bytes())?,
                Encoding::Binary(Endian::Big) => out.write_all(&number.to_be_bytes())?,
            }
        }
        if encoding == Encoding::Text {
            writeln!(out)?;
        }
    }
    Ok(())
}
