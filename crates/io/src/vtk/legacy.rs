//! Legacy VTK (`.vtk`): unstructured grids and polygonal surfaces, text or binary, versions 1 to 5.1.

use std::fmt::Arguments;
use std::io::Write;

use souple_mesh::CellBlock;
use souple_table::Entry;

use super::array::{self, Number, NumberType};
use super::grid::Grid;
use super::{GROUP_PREFIX, POLYGON, cell_type_of};
use crate::cursor::{Cursor, Encoding, Endian, open_end};
use crate::dataset::{Field, Output};
use crate::error::{Fault, quoted};
use crate::format::{Format, WriteError, wrong_start};
use crate::holds::Holds;
use crate::{Dataset, IoError};

pub(crate) static VTK_LEGACY: Entry<Format> = Entry {
    name: "vtk",
    summary: "legacy VTK unstructured grid or polygons with fields; written as text",
    source: "VTK file formats, simple legacy formats",
    parameters: &[],
    build: Format {
        extensions: &["vtk"],
        family: &[],
        parts: &[],
        recognises,
        read: Some(read),
        write: Some(write),
        holds: Holds::ALL,
    },
};

const START: &[u8] = b"# vtk DataFile";

fn recognises(bytes: &[u8]) -> bool {
    bytes.starts_with(START)
}

/// Most components of a field.
const MOST_COMPONENTS: usize = 1024;

/// What the values that follow belong to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Owner {
    Points,
    Cells,
}

struct Reader<'a> {
    cursor: Cursor<'a>,
    encoding: Encoding,
    grid: Grid,
    /// Owner and number of tuples of the fields that follow.
    owner: Option<(Owner, usize)>,
    has_points: bool,
    has_cells: bool,
    has_types: bool,
}

pub(crate) fn read(bytes: &[u8]) -> Result<Dataset, Fault> {
    if !recognises(bytes) {
        return Err(wrong_start(bytes, "VTK", "# vtk DataFile Version"));
    }
    let mut cursor = Cursor::new(bytes);
    cursor.line();
    cursor.line();
    let word = cursor.expect_word(format_args!("the encoding"), "ASCII or BINARY")?;
    let encoding = match word.to_ascii_uppercase().as_slice() {
        b"ASCII" => Encoding::Text,
        b"BINARY" => Encoding::Binary(Endian::Big),
        _ => return Err(cursor.fault("the encoding", quoted(word), "ASCII or BINARY")),
    };
    let mut reader = Reader {
        cursor,
        encoding,
        grid: Grid::default(),
        owner: None,
        has_points: false,
        has_cells: false,
        has_types: false,
    };
    while let Some(word) = reader.cursor.word() {
        reader.section(word)?;
    }
    let mut dataset = reader.finish()?;
    if encoding == Encoding::Text {
        dataset.notes.extend(open_end(bytes, "the last line"));
    }
    Ok(dataset)
}

impl<'a> Reader<'a> {
    fn section(&mut self, word: &[u8]) -> Result<(), Fault> {
        match word.to_ascii_uppercase().as_slice() {
            b"DATASET" => self.dataset_kind(),
            b"POINTS" => self.points(),
            b"CELLS" => self.cells(None),
            b"POLYGONS" => self.cells(Some(POLYGON)),
            b"CELL_TYPES" => self.types(),
            b"POINT_DATA" => self.start_fields(Owner::Points),
            b"CELL_DATA" => self.start_fields(Owner::Cells),
            b"SCALARS" => self.scalars(),
            b"VECTORS" | b"NORMALS" => self.field_of(3),
            b"TENSORS" => self.field_of(9),
            b"FIELD" => self.field_list(),
            b"METADATA" => {
                self.skip_metadata();
                Ok(())
            }
            _ => {
                let expected = "POINTS, CELLS, CELL_TYPES, POLYGONS, POINT_DATA, CELL_DATA, SCALARS, VECTORS, \
                                NORMALS, TENSORS, FIELD or METADATA";
                Err(self.cursor.fault("the section", quoted(word), expected))
            }
        }
    }

    fn dataset_kind(&mut self) -> Result<(), Fault> {
        let expected = "UNSTRUCTURED_GRID or POLYDATA";
        let kind = self.cursor.expect_word(format_args!("the kind of data set"), expected)?;
        match kind.to_ascii_uppercase().as_slice() {
            b"UNSTRUCTURED_GRID" | b"POLYDATA" => Ok(()),
            _ => Err(self.cursor.fault("the kind of data set", quoted(kind), expected)),
        }
    }

    fn once(&self, seen: bool, section: &str) -> Result<(), Fault> {
        if seen { Err(self.cursor.fault(section, "given twice", "one such section")) } else { Ok(()) }
    }

    fn points(&mut self) -> Result<(), Fault> {
        self.once(self.has_points, "POINTS")?;
        self.has_points = true;
        let count = self.count(format_args!("the number of points"))?;
        let number_type = self.number_type(format_args!("the type of the points"))?;
        self.grid.coordinates = self.values(count, 3, number_type, format_args!("the coordinates"))?;
        Ok(())
    }

    /// `CELLS count size`, then `n node…` for each; from version 5 on offsets and connectivity apart.
    fn cells(&mut self, all_of_type: Option<i64>) -> Result<(), Fault> {
        self.once(self.has_cells, "CELLS or POLYGONS")?;
        self.has_cells = true;
        let count = self.count(format_args!("the number of cells"))?;
        let size = self.count(format_args!("the length of the list of cells"))?;
        let mut ahead = self.cursor.clone();
        if ahead.word() == Some(b"OFFSETS") {
            self.cursor = ahead;
            let number_type = self.number_type(format_args!("the type of the offsets"))?;
            self.grid.offsets = self.values(count, 1, number_type, format_args!("the offsets"))?;
            // the first offset is the start of the first cell
            if count > 0 && self.grid.offsets.remove(0) != 0 {
                return Err(self.cursor.fault("the first offset", "not zero", "0"));
            }
            let word = self.cursor.expect_word(format_args!("the connectivity"), "CONNECTIVITY")?;
            if word != b"CONNECTIVITY" {
                return Err(self.cursor.fault("the section", quoted(word), "CONNECTIVITY"));
            }
            let number_type = self.number_type(format_args!("the type of the connectivity"))?;
            self.grid.connectivity = self.values(size, 1, number_type, format_args!("the connectivity"))?;
        } else {
            let list: Vec<i64> = self.values(size, 1, NumberType::I32, format_args!("the list of cells"))?;
            self.split(&list, count)?;
        }
        if let Some(number) = all_of_type {
            self.grid.types = vec![number; self.grid.offsets.len()];
            self.has_types = true;
        }
        Ok(())
    }

    fn split(&mut self, list: &[i64], count: usize) -> Result<(), Fault> {
        let mut rest = list;
        while let [node_count, tail @ ..] = rest {
            let cell = self.grid.offsets.len();
            let length = usize::try_from(*node_count)
                .ok()
                .filter(|length| *length <= tail.len())
                .ok_or_else(|| {
                    let subject = format!("the number of nodes of cell {cell}");
                    self.cursor.fault(subject, node_count.to_string(), format!("0 to {}", tail.len()))
                })?;
            self.grid.connectivity.extend_from_slice(&tail[..length]);
            self.grid.offsets.push(self.grid.connectivity.len() as i64);
            rest = &tail[length..];
        }
        let found = self.grid.offsets.len();
        if found != count {
            return Err(self.cursor.fault(
                "the number of cells in the list",
                found.to_string(),
                count.to_string(),
            ));
        }
        Ok(())
    }

    fn types(&mut self) -> Result<(), Fault> {
        self.once(self.has_types, "CELL_TYPES")?;
        self.has_types = true;
        let count = self.count(format_args!("the number of cell types"))?;
        self.grid.types = self.values(count, 1, NumberType::I32, format_args!("the cell types"))?;
        Ok(())
    }

    fn start_fields(&mut self, owner: Owner) -> Result<(), Fault> {
        let count = self.count(format_args!("the number of tuples"))?;
        let expected = match owner {
            Owner::Points => self.grid.coordinates.len() / 3,
            Owner::Cells => self.grid.offsets.len(),
        };
        if count != expected {
            return Err(self.cursor.fault("the number of tuples", count.to_string(), expected.to_string()));
        }
        self.owner = Some((owner, count));
        Ok(())
    }

    /// `SCALARS name type [components]`, `LOOKUP_TABLE name`.
    fn scalars(&mut self) -> Result<(), Fault> {
        let name = self.name()?;
        let number_type = self.number_type(format_args!("the type of `{name}`"))?;
        let mut ahead = self.cursor.clone();
        let mut components = 1;
        if let Some(count) = ahead.word().and_then(crate::cursor::parse::<usize>) {
            components = count;
            self.cursor = ahead.clone();
        } else {
            ahead = self.cursor.clone();
        }
        if ahead.word() == Some(b"LOOKUP_TABLE") {
            ahead.word();
            self.cursor = ahead;
        }
        self.read_field(name, components, number_type)
    }

    fn field_of(&mut self, components: usize) -> Result<(), Fault> {
        let name = self.name()?;
        let number_type = self.number_type(format_args!("the type of `{name}`"))?;
        self.read_field(name, components, number_type)
    }

    /// `FIELD name count`, then `name components tuples type` and values for each.
    fn field_list(&mut self) -> Result<(), Fault> {
        self.name()?;
        let count = self.count(format_args!("the number of arrays"))?;
        for _ in 0..count {
            let mut name = self.name()?;
            if name == "METADATA" {
                self.skip_metadata();
                name = self.name()?;
            }
            let components = self.count(format_args!("the number of components of `{name}`"))?;
            let tuples = self.count(format_args!("the number of tuples of `{name}`"))?;
            let number_type = self.number_type(format_args!("the type of `{name}`"))?;
            match self.owner {
                Some((_, expected)) if expected != tuples => {
                    let subject = format!("the number of tuples of `{name}`");
                    return Err(self.cursor.fault(subject, tuples.to_string(), expected.to_string()));
                }
                Some(_) => self.read_field(name, components, number_type)?,
                // a field of the whole data set, such as the time
                None => {
                    self.values::<f64>(
                        tuples,
                        components,
                        number_type,
                        format_args!("the values of `{name}`"),
                    )?;
                }
            }
        }
        Ok(())
    }

    fn read_field(&mut self, name: String, components: usize, number_type: NumberType) -> Result<(), Fault> {
        let Some((owner, tuples)) = self.owner else {
            return Err(self.cursor.fault(
                format!("the field `{name}`"),
                "of nothing",
                "POINT_DATA or CELL_DATA before",
            ));
        };
        if !(1..=MOST_COMPONENTS).contains(&components) {
            let subject = format!("the number of components of `{name}`");
            return Err(self.cursor.fault(
                subject,
                components.to_string(),
                format!("1 to {MOST_COMPONENTS}"),
            ));
        }
        let values = self.values(tuples, components, number_type, format_args!("the values of `{name}`"))?;
        let fields = match owner {
            Owner::Points => &mut self.grid.point_fields,
            Owner::Cells => &mut self.grid.cell_fields,
        };
        fields.push(Field::new(name, components, values));
        Ok(())
    }

    fn values<T: Number>(
        &mut self,
        tuples: usize,
        components: usize,
        number_type: NumberType,
        subject: Arguments<'_>,
    ) -> Result<Vec<T>, Fault> {
        let cursor = &mut self.cursor;
        let count = tuples.saturating_mul(components);
        match self.encoding {
            Encoding::Text => {
                cursor.check_count(count as u64, 2, subject)?;
                let value = |_| {
                    let word = cursor.expect_word(subject, T::EXPECTED)?;
                    T::parse(word).ok_or_else(|| cursor.fault(subject.to_string(), quoted(word), T::EXPECTED))
                };
                (0..count).map(value).collect()
            }
            Encoding::Binary(endian) => {
                // the data begin on the next line
                cursor.line();
                let position = cursor.position();
                let length = count.saturating_mul(number_type.width());
                cursor.encoding = self.encoding;
                let bytes = cursor.take(length, subject)?;
                cursor.encoding = Encoding::Text;
                debug_assert_eq!(cursor.position(), position + length);
                Ok(array::decode(bytes, number_type, endian))
            }
        }
    }

    fn count(&mut self, subject: Arguments<'_>) -> Result<usize, Fault> {
        let count = self.cursor.size(8, subject)?;
        self.cursor.check_count(count, 1, subject)
    }

    /// A name, its spaces written as `%20`.
    fn name(&mut self) -> Result<String, Fault> {
        let word = self.cursor.expect_word(format_args!("the name of a field"), "a word")?;
        let text = std::str::from_utf8(word)
            .map_err(|_| self.cursor.fault("the name of a field", quoted(word), "a word in UTF-8"))?;
        Ok(decoded_name(text))
    }

    fn number_type(&mut self, subject: Arguments<'_>) -> Result<NumberType, Fault> {
        let expected = "char, short, int, long, vtktypeint64 (or unsigned), vtkIdType, float or double";
        let word = self.cursor.expect_word(subject, expected)?;
        Ok(match word.to_ascii_lowercase().as_slice() {
            b"char" | b"signed_char" => NumberType::I8,
            b"unsigned_char" => NumberType::U8,
            b"short" => NumberType::I16,
            b"unsigned_short" => NumberType::U16,
            b"int" | b"vtkidtype" | b"vtktypeint32" => NumberType::I32,
            b"unsigned_int" | b"vtktypeuint32" => NumberType::U32,
            b"long" | b"vtktypeint64" => NumberType::I64,
            b"unsigned_long" | b"vtktypeuint64" => NumberType::U64,
            b"float" => NumberType::F32,
            b"double" => NumberType::F64,
            _ => return Err(self.cursor.fault(subject.to_string(), quoted(word), expected)),
        })
    }

    /// Up to the next empty line.
    fn skip_metadata(&mut self) {
        self.cursor.line();
        while self.cursor.line().is_some_and(|line| !line.trim_ascii().is_empty()) {}
    }

    fn finish(self) -> Result<Dataset, Fault> {
        let parts = [(self.has_points, "POINTS"), (self.has_cells, "CELLS"), (self.has_types, "CELL_TYPES")];
        if let Some((_, section)) = parts.iter().find(|part| !part.0) {
            return Err(Fault::cut_off(
                self.cursor.place(),
                format!("the section {section}"),
                "points and cells",
            ));
        }
        self.grid.into_dataset(self.cursor.place())
    }
}

fn decoded_name(text: &str) -> String {
    let mut pieces = text.split('%');
    let mut bytes = pieces.next().unwrap_or_default().as_bytes().to_vec();
    for piece in pieces {
        match piece.get(..2).and_then(|digits| u8::from_str_radix(digits, 16).ok()) {
            Some(byte) => {
                bytes.push(byte);
                bytes.extend_from_slice(&piece.as_bytes()[2..]);
            }
            None => {
                bytes.push(b'%');
                bytes.extend_from_slice(piece.as_bytes());
            }
        }
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

fn encoded_name(text: &str) -> String {
    let plain = |byte: u8| byte.is_ascii_graphic() && byte != b'%';
    text.bytes()
        .map(|byte| if plain(byte) { char::from(byte).to_string() } else { format!("%{byte:02X}") })
        .collect()
}

/// Writes version 3.0 as text; numbers read back as the same bits.
fn write(output: &Output<'_>, out: &mut dyn Write) -> Result<(), WriteError> {
    writeln!(out, "# vtk DataFile Version 3.0\nsouple\nASCII\nDATASET UNSTRUCTURED_GRID")?;
    writeln!(out, "POINTS {} double", output.mesh.points.len())?;
    for position in output.positions() {
        let [x, y, z] = position.to_array();
        writeln!(out, "{x:?} {y:?} {z:?}")?;
    }
    let cell_count = output.cell_count();
    let size: usize = output.blocks().map(|block| block.len() + block.nodes.len()).sum();
    writeln!(out, "CELLS {cell_count} {size}")?;
    for nodes in output.blocks().flat_map(CellBlock::cells) {
        write!(out, "{}", nodes.len())?;
        nodes.iter().try_for_each(|node| write!(out, " {node}"))?;
        writeln!(out)?;
    }
    writeln!(out, "CELL_TYPES {cell_count}")?;
    for block in output.blocks() {
        let number = cell_type_of(block.kind);
        let number = number.ok_or_else(|| IoError::request("an element", block.kind, "one that VTK has"))?;
        (0..block.len()).try_for_each(|_| writeln!(out, "{number}"))?;
    }
    let (on_points, on_cells) = group_fields(output)?;
    let lists = [
        ("POINT_DATA", output.point_fields, on_points, output.mesh.points.len()),
        ("CELL_DATA", output.cell_fields, on_cells, cell_count),
    ];
    for (section, fields, groups, tuples) in lists {
        let count = fields.len() + groups.len();
        if count == 0 {
            continue;
        }
        writeln!(out, "{section} {tuples}\nFIELD fields {count}")?;
        for field in fields.iter().chain(&groups) {
            let name = if field.name.is_empty() { "unnamed".to_owned() } else { encoded_name(&field.name) };
            writeln!(out, "{name} {} {tuples} double", field.components)?;
            for tuple in field.values.chunks(field.components) {
                tuple.iter().try_for_each(|value| write!(out, "{value:?} "))?;
                writeln!(out)?;
            }
        }
    }
    Ok(())
}

/// Groups as fields of 0 and 1, on points and on cells.
fn group_fields(output: &Output<'_>) -> Result<(Vec<Field>, Vec<Field>), IoError> {
    let (mut on_points, mut on_cells) = (Vec::new(), Vec::new());
    let field = |name: &str, marks: Vec<u8>| {
        Field::new(format!("{GROUP_PREFIX}{name}"), 1, marks.into_iter().map(f64::from).collect())
    };
    for marked in super::group_marks(output)? {
        on_points.extend(marked.on_points.map(|marks| field(marked.name, marks)));
        on_cells.extend(marked.on_cells.map(|marks| field(marked.name, marks)));
    }
    Ok((on_points, on_cells))
}

#[cfg(test)]
mod tests;
