//! Reads VTK XML unstructured grids (`.vtu`): text, base64 and appended data, either byte order, zlib or plain.

use std::cell::Cell;

use souple_table::Entry;

use super::array::{self, Appended, Compression, Layout, Length};
use super::grid::Grid;
use super::vtu_write;
use super::xml::{Document, Element};
use crate::Dataset;
use crate::cursor::Endian;
use crate::dataset::Field;
use crate::error::{Fault, Place};
use crate::format::{Format, wrong_start};
use crate::holds::Holds;

pub(crate) static VTU: Entry<Format> = Entry {
    name: "vtu",
    summary: "VTK XML unstructured grid with fields, for ParaView; written as appended raw data",
    source: "VTK file formats, XML",
    parameters: &[],
    build: Format {
        extensions: &["vtu"],
        family: &[],
        parts: &[],
        recognises,
        read: Some(read),
        write: Some(vtu_write::write),
        holds: Holds::ALL,
    },
};

fn recognises(bytes: &[u8]) -> bool {
    let start = bytes.trim_ascii_start();
    start.starts_with(b"<VTKFile") || (start.starts_with(b"<?xml") && find(start, b"<VTKFile").is_some())
}

fn find(bytes: &[u8], word: &[u8]) -> Option<usize> {
    bytes.windows(word.len()).position(|window| window == word)
}

/// Most components of a field: a tensor has nine, a few hundred modes may stand in one array.
const MOST_COMPONENTS: usize = 1024;

pub(crate) fn read(bytes: &[u8]) -> Result<Dataset, Fault> {
    if !recognises(bytes) {
        return Err(wrong_start(bytes, "VTU", "<VTKFile or <?xml"));
    }
    let document = Document::parse(bytes, "AppendedData")?;
    let root =
        document.elements.iter().position(|element| element.name == "VTKFile" && element.parent.is_none());
    let root =
        root.ok_or_else(|| document.fault(0, "the element <VTKFile>", "missing", "one of them around all"))?;
    let file = &document.elements[root];
    expect(&document, file, "type", None, &["UnstructuredGrid"])?;
    let endian =
        match expect(&document, file, "byte_order", Some("LittleEndian"), &["LittleEndian", "BigEndian"])? {
            "BigEndian" => Endian::Big,
            _ => Endian::Little,
        };
    let header_width = match expect(&document, file, "header_type", Some("UInt32"), &["UInt32", "UInt64"])? {
        "UInt64" => 8,
        _ => 4,
    };
    let compressors = ["", "vtkZLibDataCompressor"];
    let compression = match expect(&document, file, "compressor", Some(""), &compressors)? {
        "" => Compression::None,
        _ => Compression::Zlib,
    };
    let unclaimed = Cell::new(0);
    let appended = appended(&document, root, &unclaimed)?;
    let room = Cell::new(array::most_memory(bytes.len()));
    let layout = Layout { endian, header_width, compression, appended, room: &room };

    let grid_element = document.child(root, "UnstructuredGrid")?;
    let piece = document.child(grid_element, "Piece")?;
    if let Some((_, second)) = document.children(grid_element, "Piece").nth(1) {
        return Err(document.fault(second.position, "the number of pieces", "2 or more", "one <Piece>"));
    }
    let place = document.place(document.elements[piece].position);
    read_piece(&document, piece, &layout)?.into_dataset(place)
}

/// An attribute, one of a few values.
fn expect<'b>(
    document: &Document<'_>,
    element: &'b Element<'_>,
    key: &str,
    default: Option<&'b str>,
    accepted: &[&str],
) -> Result<&'b str, Fault> {
    let value = element.attribute(key).or(default).unwrap_or("missing");
    if accepted.contains(&value) {
        return Ok(value);
    }
    let names: Vec<_> = accepted.iter().filter(|name| !name.is_empty()).copied().collect();
    let subject = format!("the attribute `{key}` of <{}>", element.name);
    Err(document.fault(element.position, subject, format!("`{value}`"), names.join(" or ")))
}

/// The text behind the underscore, once the end of the file has been seen.
fn appended<'a>(
    document: &Document<'a>,
    root: usize,
    unclaimed: &'a Cell<usize>,
) -> Result<Option<Appended<'a>>, Fault> {
    let Some((_, element)) = document.children(root, "AppendedData").next() else { return Ok(None) };
    let end = element.text_position + element.text.len();
    if !element.text.trim_ascii_end().ends_with(b"</VTKFile>") {
        return Err(Fault::cut_off(
            Place::Byte(end),
            "the end of the appended data",
            "</AppendedData></VTKFile>",
        ));
    }
    let base64 = expect(document, element, "encoding", Some("base64"), &["raw", "base64"])? == "base64";
    let start = element.text.iter().position(|byte| *byte == b'_');
    let space = start.is_some_and(|start| element.text[..start].iter().all(u8::is_ascii_whitespace));
    let (Some(start), true) = (start, space) else {
        return Err(document.fault(
            element.position,
            "the start of the appended data",
            "missing",
            "an underscore",
        ));
    };
    let bytes = &element.text[start + 1..];
    unclaimed.set(bytes.len());
    Ok(Some(Appended { bytes, base64, position: element.text_position + start + 1, unclaimed }))
}

fn read_piece(document: &Document<'_>, piece: usize, layout: &Layout<'_>) -> Result<Grid, Fault> {
    let element = &document.elements[piece];
    let count = |key: &str| -> Result<usize, Fault> {
        let given = element.attribute(key).unwrap_or("missing");
        given
            .parse()
            .map_err(|_| document.fault(element.position, format!("`{key}`"), given, "a whole number"))
    };
    let (point_count, cell_count) = (count("NumberOfPoints")?, count("NumberOfCells")?);

    let points = document.child(piece, "Points")?;
    let points = &document.elements[document.child(points, "DataArray")?];
    let coordinates =
        array::read::<f64>(document, points, layout, Length { tuples: point_count, components: 3 })?;

    let cells = document.child(piece, "Cells")?;
    let list = |name: &str, tuples: usize| -> Result<Vec<i64>, Fault> {
        let mut arrays = document.children(cells, "DataArray");
        let found = arrays.find(|(_, element)| element.attribute("Name") == Some(name));
        let (_, element) = found.ok_or_else(|| {
            let position = document.elements[cells].position;
            document.fault(position, format!("the array `{name}` of the cells"), "missing", "a <DataArray>")
        })?;
        array::read(document, element, layout, Length { tuples, components: 1 })
    };
    let offsets = list("offsets", cell_count)?;
    // an offset that is no length of anything is refused with the others
    let node_count = offsets.last().and_then(|end| usize::try_from(*end).ok()).unwrap_or(0);
    let connectivity = list("connectivity", node_count)?;
    let types = list("types", cell_count)?;

    let fields = |section: &str, tuples: usize| -> Result<Vec<Field>, Fault> {
        let Some((section, _)) = document.children(piece, section).next() else { return Ok(Vec::new()) };
        document
            .children(section, "DataArray")
            .filter(|(_, element)| element.attribute("type") != Some("String"))
            .map(|(_, element)| read_field(document, element, layout, tuples))
            .collect()
    };
    let (point_fields, cell_fields) = (fields("PointData", point_count)?, fields("CellData", cell_count)?);
    Ok(Grid { coordinates, connectivity, offsets, types, point_fields, cell_fields })
}

fn read_field(
    document: &Document<'_>,
    element: &Element<'_>,
    layout: &Layout<'_>,
    tuples: usize,
) -> Result<Field, Fault> {
    let name = element.attribute("Name").unwrap_or_default();
    let given = element.attribute("NumberOfComponents").unwrap_or("1");
    // VTK writes 0 for arrays of single numbers at times
    let components: usize =
        given.parse().ok().filter(|count| *count <= MOST_COMPONENTS).ok_or_else(|| {
            let subject = format!("the number of components of the array `{name}`");
            document.fault(element.position, subject, given, format!("1 to {MOST_COMPONENTS}"))
        })?;
    let components = components.max(1);
    let values = array::read::<f64>(document, element, layout, Length { tuples, components })?;
    Ok(Field::new(name, components, values))
}

#[cfg(test)]
mod tests;
