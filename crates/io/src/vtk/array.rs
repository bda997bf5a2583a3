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

/// The numbers of a `<DataArray>`.
pub(super) fn read<T: Number>(
    document: &Document<'_>,
    element: &Element<'_>,
    layout: &Layout<'_>,
) -> Result<Vec<T>, Fault> {
    let name = element.attribute("Name").unwrap_or("without a name");
    let subject = |what: &str| format!("{what} of the array `{name}`");
    let type_name = element.attribute("type").unwrap_or("missing");
    let number_type = NumberType::from_xml(type_name).ok_or_else(|| {
        let expected = "Int8 to UInt64, Float32 or Float64";
        document.fault(element.position, subject("the type"), type_name, expected)
    })?;
    let bytes = match element.attribute("format").unwrap_or("ascii") {
        "ascii" => return read_text(document, element, name),
        "binary" => {
            let (bytes, end) = base64::decode(element.text).map_err(|bad| {
                let position = element.text_position + bad.offset;
                document.fault(
                    position,
                    subject("the base64 text"),
                    "a broken group",
                    "groups of four letters",
                )
            })?;
            if end != element.text.len() {
                let stray = &element.text[end..(end + 1).min(element.text.len())];
                let position = element.text_position + end;
                return Err(document.fault(
                    position,
                    subject("the base64 text"),
                    quoted(stray),
                    "A-Z a-z 0-9 + / =",
                ));
            }
            bytes
        }
        "appended" => appended(document, element, layout, name)?,
        other => {
            let expected = "ascii, binary or appended";
            return Err(document.fault(
                element.position,
                subject("the format"),
                format!("`{other}`"),
                expected,
            ));
        }
    };
    let bytes = content(&bytes, layout).map_err(|(found, expected)| {
        document.fault(element.position, subject("the data"), found, expected)
    })?;
    if bytes.len() % number_type.width() != 0 {
        let expected = format!("a multiple of {}, the width of {type_name}", number_type.width());
        return Err(document.fault(
            element.position,
            subject("the length in bytes"),
            bytes.len().to_string(),
            expected,
        ));
    }
    Ok(decode(&bytes, number_type, layout.endian))
}

fn read_text<T: Number>(document: &Document<'_>, element: &Element<'_>, name: &str) -> Result<Vec<T>, Fault> {
    let words = element.text.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
    words
        .map(|word| {
            T::parse(word).ok_or_else(|| {
                let offset = word.as_ptr() as usize - element.text.as_ptr() as usize;
                let position = element.text_position + offset;
                document.fault(position, format!("a value of the array `{name}`"), quoted(word), T::EXPECTED)
            })
        })
        .collect()
}

/// The bytes of the appended data from the offset of the array on, decoded if they are base64.
fn appended(
    document: &Document<'_>,
    element: &Element<'_>,
    layout: &Layout<'_>,
    name: &str,
) -> Result<Vec<u8>, Fault> {
    let Some(appended) = layout.appended else {
        let subject = format!("the data of the array `{name}`");
        return Err(document.fault(
            element.position,
            subject,
            "missing",
            "an element <AppendedData> with it",
        ));
    };
    let given = element.attribute("offset").unwrap_or("missing");
    let offset = given.parse().ok().filter(|offset| *offset <= appended.bytes.len()).ok_or_else(|| {
        let expected =
            format!("a number of at most {}, the length of the appended data", appended.bytes.len());
        document.fault(element.position, format!("the offset of the array `{name}`"), given, expected)
    })?;
    let bytes = &appended.bytes[offset..];
    // only as far as the length before the data reaches: the rest belongs to other arrays
    let extent = if appended.base64 { base64_extent(bytes, layout) } else { raw_extent(bytes, layout) };
    let extent = extent.min(bytes.len());
    let unclaimed = appended.unclaimed.get();
    if extent > unclaimed {
        let subject = format!("the data of the array `{name}`");
        let found = format!("{extent} bytes, which other arrays have already");
        return Err(document.fault(
            element.position,
            subject,
            found,
            format!("at most {unclaimed} bytes of its own"),
        ));
    }
    appended.unclaimed.set(unclaimed - extent);
    if !appended.base64 {
        return Ok(bytes[..extent].to_vec());
    }
    base64::decode(&bytes[..extent]).map(|decoded| decoded.0).map_err(|bad| {
        let position = appended.position + offset + bad.offset;
        let subject = format!("the base64 text of the array `{name}`");
        document.fault(position, subject, "a broken group", "groups of four letters")
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

/// The content behind the header, decompressed; or what was found and what is expected.
fn content(bytes: &[u8], layout: &Layout<'_>) -> Result<Vec<u8>, (String, String)> {
    let width = layout.header_width;
    let number = |index: usize| -> Result<usize, (String, String)> {
        bytes.get(index * width..(index + 1) * width).map(|bytes| header_number(bytes, layout)).ok_or_else(
            || {
                let expected = format!("a header of {} bytes", (index + 1) * width);
                (format!("cut off after {} bytes", bytes.len()), expected)
            },
        )
    };
    let piece = |start: usize, length: usize| {
        start.checked_add(length).and_then(|end| bytes.get(start..end)).ok_or_else(|| {
            let left = bytes.len() - start.min(bytes.len());
            (format!("cut off after {left} bytes"), format!("{length} bytes, as its header says"))
        })
    };
    if layout.compression == Compression::None {
        // an array of nothing may have no header
        return if bytes.is_empty() { Ok(Vec::new()) } else { Ok(piece(width, number(0)?)?.to_vec()) };
    }
    if bytes.is_empty() {
        return Ok(Vec::new());
    }
    let (blocks, block_size, last_size) = (number(0)?, number(1)?, number(2)?);
    let mut plain = Vec::new();
    let mut start =
        blocks.checked_add(3).and_then(|numbers| numbers.checked_mul(width)).unwrap_or(usize::MAX);
    piece(0, start)?;
    for block in 0..blocks {
        let size = if block + 1 == blocks && last_size > 0 { last_size } else { block_size };
        let packed = piece(start, number(3 + block)?)?;
        start += packed.len();
        let before = plain.len();
        // no more than was promised, so that a small file cannot fill the memory
        let mut inflater = flate2::read::ZlibDecoder::new(packed).take(size as u64);
        let result = inflater.read_to_end(&mut plain);
        if result.is_err() || plain.len() - before != size {
            let found = format!("a broken block of {} compressed bytes", packed.len());
            return Err((found, format!("zlib data of {size} bytes")));
        }
    }
    Ok(plain)
}
