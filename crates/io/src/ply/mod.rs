//! PLY: surfaces with numbers on their points, as text and as binary of either byte order.
//!
//! Read are the elements `vertex` (`x`, `y`, `z`; every other number becomes a field) and `face`
//! (`vertex_indices` or `vertex_index`); other elements are skipped and told. Polygons of more than four corners are
//! cut into triangles from their first corner.

mod header;
mod read;
mod write;

use souple_table::Entry;

use crate::cursor::{Encoding, Endian};
use crate::format::Format;
use crate::holds::{HeldFields, Holds, Shapes};

const HOLDS: Holds = Holds { shapes: Shapes::Facets, fields: HeldFields::PointScalars, ..Holds::BARE };

pub(crate) static PLY: Entry<Format> = Entry {
    name: "ply",
    summary: "PLY surface with numbers on its points; reads text and both binaries, writes little-endian binary",
    source: "Turk 1994, The PLY Polygon File Format",
    parameters: &[],
    build: Format {
        extensions: &["ply"],
        family: &[],
        parts: &[],
        recognises,
        read: Some(read::read),
        write: Some(|output, out| write::write(output, Encoding::Binary(Endian::Little), out)),
        holds: HOLDS,
    },
};

pub(crate) static PLY_TEXT: Entry<Format> = Entry {
    name: "ply_text",
    summary: "PLY surface; writes text that reads back as the same bits",
    source: "Turk 1994, The PLY Polygon File Format",
    parameters: &[],
    build: Format {
        extensions: &[],
        family: &["ply"],
        parts: &[],
        recognises,
        read: Some(read::read),
        write: Some(|output, out| write::write(output, Encoding::Text, out)),
        holds: HOLDS,
    },
};

fn recognises(bytes: &[u8]) -> bool {
    bytes.starts_with(b"ply\n") || bytes.starts_with(b"ply\r\n")
}

#[cfg(test)]
mod tests;
