//! `<DataArray>`: numbers as text, as base64 or appended, plain or compressed, of any type and byte order.

use std::cell::Cell;
use std::io::Read;

use super::base64;
use super::xml::{Document, Element};
use crate::cursor::{Endian, parse};
use crate::error::{Fault, quoted};

/// How the binary data of a file is to be read.
#[derive(Clone, Copy, Debug)]
pub(super) struct Layout<'a> {
    pub endian: Endian,
    /// Bytes of the lengths before binary data: 4 or 8.
    pub header_width: usize,
    pub compression: Compression,
    pub appended: Option<Appended<'a>>,
    /// Bytes of memory that the arrays of the file may still become.
    pub room: &'a Cell<usize>,
}

/// What all arrays of a file of this length may become in memory [bytes]. Compressed zeros are a thousandth of what they stand
/// for, and bytes become numbers of eight: without a bound a small file fills any memory. Meshes with their fields stay
/// below a tenth of it.
pub(super) fn most_memory(file_length: usize) -> usize {
    const ALWAYS: usize = 1 << 30;
    const PER_BYTE: usize = 64;
    file_length.saturating_mul(PER_BYTE).max(ALWAYS)
}

/// How many numbers an array must have.
#[derive(Clone, Copy, Debug)]
pub(super) struct Length {
    pub tuples: usize,
    pub components: usize,
}

impl Length {
    fn check(self, array: &Array<'_>, found: usize) -> Result<(), Fault> {
        if self.tuples.checked_mul(self.components) == Some(found) {
            return Ok(());
        }
        let expected = format!("{} x {}", self.tuples, self.components);
        Err(array.fault("the number of values", found.to_string(), expected))
    }
}

/// An element `<DataArray>`.
struct Array<'a> {
    document: &'a Document<'a>,
    element: &'a Element<'a>,
    name: &'a str,
}

impl Array<'_> {
    fn fault(&self, what: &str, found: impl Into<String>, expected: impl Into<String>) -> Fault {
        self.fault_at(self.element.position, what, found, expected)
    }

    fn fault_at(
        &self,
        position: usize,
        what: &str,
        found: impl Into<String>,
        expected: impl Into<String>,
    ) -> Fault {
        self.document.fault(position, format!("{what} of the array `{}`", self.name), found, expected)
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Compression {
    None,
    Zlib,
}

/// The data behind the underscore of `<AppendedData>`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Appended<'a> {
    pub bytes: &'a [u8],
    pub base64: bool,
    /// In the file.
    pub position: usize,
    /// Bytes that no array has claimed yet: arrays that all lie on the same bytes could fill any memory.
    pub unclaimed: &'a Cell<usize>,
}

/// Type of the numbers of an array.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum NumberType {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    I64,
    U64,
    F32,
    F64,
}

impl NumberType {
    const XML_NAMES: [(&'static str, Self); 10] = [
        ("Int8", Self::I8),
        ("UInt8", Self::U8),
        ("Int16", Self::I16),
        ("UInt16", Self::U16),
        ("Int32", Self::I32),
        ("UInt32", Self::U32),
        ("Int64", Self::I64),
        ("UInt64", Self::U64),
        ("Float32", Self::F32),
        ("Float64", Self::F64),
    ];

    pub fn from_xml(name: &str) -> Option<Self> {
        Self::XML_NAMES.iter().find(|known| known.0 == name).map(|known| known.1)
    }

    pub fn width(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::I64 | Self::U64 | Self::F64 => 8,
        }
    }
}

/// What an array is read as: real or whole numbers.
pub(super) trait Number: Sized + Copy {
    const EXPECTED: &'static str;
    fn from_f64(value: f64) -> Self;
    /// Whole numbers above `i64::MAX` are no index of anything: they saturate and are refused where they are used.
    fn from_i64(value: i64) -> Self;
    fn parse(word: &[u8]) -> Option<Self>;
}

impl Number for f64 {
    const EXPECTED: &'static str = "a number";
    fn from_f64(value: f64) -> Self {
        value
    }
    fn from_i64(value: i64) -> Self {
        value as f64
    }
    fn parse(word: &[u8]) -> Option<Self> {
        parse(word)
    }
}

impl Number for i64 {
    const EXPECTED: &'static str = "a whole number";
    /// Whole numbers written as reals are taken, others become -1: no index of anything.
    fn from_f64(value: f64) -> Self {
        if value.fract() == 0.0 { value as i64 } else { -1 }
    }
    fn from_i64(value: i64) -> Self {
        value
    }
    fn parse(word: &[u8]) -> Option<Self> {
        parse(word)
    }
}

/// Numbers of one type from bytes, a multiple of its width.
pub(super) fn decode<T: Number>(bytes: &[u8], number_type: NumberType, endian: Endian) -> Vec<T> {
    bytes
        .chunks_exact(number_type.width())
        .map(|chunk| {
            let mut wide = [0u8; 8];
            for (slot, byte) in wide.iter_mut().zip(chunk) {
                *slot = *byte;
            }
            if endian == Endian::Big {
                wide[..chunk.len()].reverse();
            }
            let [a, b, c, d, ..] = wide;
            match number_type {
                NumberType::I8 => T::from_i64(i64::from(a as i8)),
                NumberType::U8 => T::from_i64(i64::from(a)),
                NumberType::I16 => T::from_i64(i64::from(i16::from_le_bytes([a, b]))),
                NumberType::U16 => T::from_i64(i64::from(u16::from_le_bytes([a, b]))),
                NumberType::I32 => T::from_i64(i64::from(i32::from_le_bytes([a, b, c, d]))),
                NumberType::U32 => T::from_i64(i64::from(u32::from_le_bytes([a, b, c, d]))),
                NumberType::I64 => T::from_i64(i64::from_le_bytes(wide)),
                NumberType::U64 => T::from_i64(i64::try_from(u64::from_le_bytes(wide)).unwrap_or(i64::MAX)),
                NumberType::F32 => T::from_f64(f64::from(f32::from_le_bytes([a, b, c, d]))),
                NumberType::F64 => T::from_f64(f64::from_le_bytes(wide)),
            }
        })
        .collect()
}

/// The numbers of a `<DataArray>`, as many as there must be: what a header promises is held against that before any of it is
/// made.
pub(super) fn read<T: Number>(
    document: &Document<'_>,
    element: &Element<'_>,
    layout: &Layout<'_>,
    wanted: Length,
) -> Result<Vec<T>, Fault> {
    let array = Array { document, element, name: element.attribute("Name").unwrap_or("without a name") };
    let type_name = element.attribute("type").unwrap_or("missing");
    let number_type = NumberType::from_xml(type_name)
        .ok_or_else(|| array.fault("the type", type_name, "Int8 to UInt64, Float32 or Float64"))?;
    let stored = match element.attribute("format").unwrap_or("ascii") {
        "ascii" => {
            let values = read_text(&array)?;
            wanted.check(&array, values.len())?;
            return Ok(values);
        }
        "binary" => inline(&array)?,
        "appended" => appended(&array, layout)?,
        other => {
            return Err(array.fault("the format", format!("`{other}`"), "ascii, binary or appended"));
        }
    };
    let of_data = |(found, expected): Mismatch| array.fault("the data", found, expected);
    let packed = Packed::of(&stored, layout).map_err(of_data)?;
    let length = packed.length();
    if length % number_type.width() != 0 {
        let expected = format!("a multiple of {}, the width of {type_name}", number_type.width());
        return Err(array.fault("the length in bytes", length.to_string(), expected));
    }
    let count = length / number_type.width();
    wanted.check(&array, count)?;
    take_room(&array, layout, count)?;
    let plain = packed.unpacked(layout.compression).map_err(of_data)?;
    Ok(decode(&plain, number_type, layout.endian))
}

/// Puts the numbers of an array to the account of the file.
fn take_room(array: &Array<'_>, layout: &Layout<'_>, count: usize) -> Result<(), Fault> {
    let (size, room) = (count.saturating_mul(size_of::<f64>()), layout.room.get());
    if size > room {
        let found = format!("{size} bytes in memory");
        let expected = format!("at most {room} bytes, what is left for a file of this length");
        return Err(array.fault("the size", found, expected));
    }
    layout.room.set(room - size);
    Ok(())
}

fn read_text<T: Number>(array: &Array<'_>) -> Result<Vec<T>, Fault> {
    let element = array.element;
    let words = element.text.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
    words
        .map(|word| {
            T::parse(word).ok_or_else(|| {
                let offset = word.as_ptr() as usize - element.text.as_ptr() as usize;
                array.fault_at(element.text_position + offset, "a value", quoted(word), T::EXPECTED)
            })
        })
        .collect()
}

/// The base64 text of the element, decoded.
fn inline(array: &Array<'_>) -> Result<Vec<u8>, Fault> {
    let Element { text, text_position, .. } = *array.element;
    let (bytes, end) = base64::decode(text).map_err(|bad| {
        array.fault_at(
            text_position + bad.offset,
            "the base64 text",
            "a broken group",
            "groups of four letters",
        )
    })?;
    if let Some(stray) = text.get(end..end + 1) {
        return Err(array.fault_at(
            text_position + end,
            "the base64 text",
            quoted(stray),
            "A-Z a-z 0-9 + / =",
        ));
    }
    Ok(bytes)
}

/// The bytes of the appended data from the offset of the array on, decoded if they are base64.
fn appended(array: &Array<'_>, layout: &Layout<'_>) -> Result<Vec<u8>, Fault> {
    let Some(appended) = layout.appended else {
        return Err(array.fault("the data", "missing", "an element <AppendedData> with it"));
    };
    let given = array.element.attribute("offset").unwrap_or("missing");
    let offset = given.parse().ok().filter(|offset| *offset <= appended.bytes.len()).ok_or_else(|| {
        let expected =
            format!("a number of at most {}, the length of the appended data", appended.bytes.len());
        array.fault("the offset", given, expected)
    })?;
    let bytes = &appended.bytes[offset..];
    // only as far as the length before the data reaches: the rest belongs to other arrays
    let extent = if appended.base64 { base64_extent(bytes, layout) } else { raw_extent(bytes, layout) };
    let extent = extent.min(bytes.len());
    let unclaimed = appended.unclaimed.get();
    if extent > unclaimed {
        let found = format!("{extent} bytes, which other arrays have already");
        return Err(array.fault("the data", found, format!("at most {unclaimed} bytes of its own")));
    }
    appended.unclaimed.set(unclaimed - extent);
    if !appended.base64 {
        return Ok(bytes[..extent].to_vec());
    }
    base64::decode(&bytes[..extent]).map(|decoded| decoded.0).map_err(|bad| {
        let position = appended.position + offset + bad.offset;
        array.fault_at(position, "the base64 text", "a broken group", "groups of four letters")
    })
}

/// Length of the header and the data of one array, as the header says.
fn raw_extent(bytes: &[u8], layout: &Layout<'_>) -> usize {
    let width = layout.header_width;
    let number = |index: usize| -> usize {
        bytes.get(index * width..(index + 1) * width).map_or(0, |bytes| header_number(bytes, layout))
    };
    match layout.compression {
        Compression::None => width.saturating_add(number(0)),
        Compression::Zlib => {
            let blocks = number(0).min(bytes.len() / width);
            let data = (0..blocks).fold(0usize, |sum, block| sum.saturating_add(number(3 + block)));
            ((3 + blocks) * width).saturating_add(data)
        }
    }
}

/// Letters of the base64 text of one array: header and data in one stream, or each with padding of its own.
fn base64_extent(text: &[u8], layout: &Layout<'_>) -> usize {
    let letters = |bytes: usize| bytes.div_ceil(3).saturating_mul(4);
    let width = layout.header_width;
    let decoded =
        |letters: usize| base64::decode(&text[..letters.min(text.len() / 4 * 4)]).unwrap_or_default().0;
    let number = |header: &[u8], index: usize| -> usize {
        header.get(index * width..(index + 1) * width).map_or(0, |bytes| header_number(bytes, layout))
    };
    match layout.compression {
        Compression::None => {
            let data = number(&decoded(letters(width)), 0);
            let apart = text.get(letters(width) - 1) == Some(&b'=');
            if apart {
                letters(width).saturating_add(letters(data))
            } else {
                letters(width.saturating_add(data))
            }
        }
        Compression::Zlib => {
            let blocks = number(&decoded(letters(3 * width)), 0).min(text.len());
            let header = decoded(letters((3 + blocks) * width));
            let data = (0..blocks).fold(0usize, |sum, block| sum.saturating_add(number(&header, 3 + block)));
            letters((3 + blocks) * width).saturating_add(letters(data))
        }
    }
}

fn header_number(bytes: &[u8], layout: &Layout<'_>) -> usize {
    let number_type = if layout.header_width == 4 { NumberType::U32 } else { NumberType::U64 };
    let value: i64 = decode(bytes, number_type, layout.endian)[0];
    usize::try_from(value).unwrap_or(usize::MAX)
}

/// What was found and what is expected.
type Mismatch = (String, String);

/// The data of an array as its header says: pieces, each with its length when it is unpacked.
struct Packed<'a> {
    pieces: Vec<(usize, &'a [u8])>,
}

impl<'a> Packed<'a> {
    fn of(bytes: &'a [u8], layout: &Layout<'_>) -> Result<Self, Mismatch> {
        // an array of nothing may have no header
        if bytes.is_empty() {
            return Ok(Self { pieces: Vec::new() });
        }
        let width = layout.header_width;
        let number = |index: usize| -> Result<usize, Mismatch> {
            let number = bytes.get(index * width..(index + 1) * width);
            number.map(|bytes| header_number(bytes, layout)).ok_or_else(|| {
                let expected = format!("a header of {} bytes", (index + 1) * width);
                (format!("cut off after {} bytes", bytes.len()), expected)
            })
        };
        let piece = |start: usize, length: usize| {
            start.checked_add(length).and_then(|end| bytes.get(start..end)).ok_or_else(|| {
                let left = bytes.len() - start.min(bytes.len());
                (format!("cut off after {left} bytes"), format!("{length} bytes, as its header says"))
            })
        };
        if layout.compression == Compression::None {
            let length = number(0)?;
            return Ok(Self { pieces: vec![(length, piece(width, length)?)] });
        }
        let (blocks, block_size, last_size) = (number(0)?, number(1)?, number(2)?);
        let mut start =
            blocks.checked_add(3).and_then(|numbers| numbers.checked_mul(width)).unwrap_or(usize::MAX);
        piece(0, start)?;
        let mut pieces = Vec::with_capacity(blocks);
        for block in 0..blocks {
            let size = if block + 1 == blocks && last_size > 0 { last_size } else { block_size };
            let packed = piece(start, number(3 + block)?)?;
            start += packed.len();
            pieces.push((size, packed));
        }
        Ok(Self { pieces })
    }

    /// Bytes of all pieces when they are unpacked.
    fn length(&self) -> usize {
        self.pieces.iter().fold(0, |sum: usize, (size, _)| sum.saturating_add(*size))
    }

    fn unpacked(&self, compression: Compression) -> Result<Vec<u8>, Mismatch> {
        let mut plain = Vec::new();
        for (size, packed) in &self.pieces {
            if compression == Compression::None {
                plain.extend_from_slice(packed);
                continue;
            }
            let before = plain.len();
            // no more than was promised
            let mut inflater = flate2::read::ZlibDecoder::new(*packed).take(*size as u64);
            let result = inflater.read_to_end(&mut plain);
            if result.is_err() || plain.len() - before != *size {
                let found = format!("a broken block of {} compressed bytes", packed.len());
                return Err((found, format!("zlib data of {size} bytes")));
            }
        }
        Ok(plain)
    }
}
