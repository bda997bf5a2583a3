//! The head of a PLY file: its encoding, its elements, their properties.

use crate::cursor::{Cursor, Encoding, Endian, parse};
use crate::error::{Fault, Place, quoted};

/// Type of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Scalar {
    Int8,
    Uint8,
    Int16,
    Uint16,
    Int32,
    Uint32,
    Float32,
    Float64,
}

/// Both names of each type.
const SCALARS: [(&[u8], &[u8], Scalar); 8] = [
    (b"char", b"int8", Scalar::Int8),
    (b"uchar", b"uint8", Scalar::Uint8),
    (b"short", b"int16", Scalar::Int16),
    (b"ushort", b"uint16", Scalar::Uint16),
    (b"int", b"int32", Scalar::Int32),
    (b"uint", b"uint32", Scalar::Uint32),
    (b"float", b"float32", Scalar::Float32),
    (b"double", b"float64", Scalar::Float64),
];

impl Scalar {
    pub fn width(self) -> usize {
        match self {
            Self::Int8 | Self::Uint8 => 1,
            Self::Int16 | Self::Uint16 => 2,
            Self::Int32 | Self::Uint32 | Self::Float32 => 4,
            Self::Float64 => 8,
        }
    }

    pub fn is_integer(self) -> bool {
        !matches!(self, Self::Float32 | Self::Float64)
    }
}

/// What one item of an element has, in order.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Property {
    pub name: String,
    pub value: Scalar,
    /// Type of the count, for a list.
    pub count: Option<Scalar>,
}

#[derive(Clone, Debug)]
pub(super) struct Element {
    pub name: String,
    pub count: u64,
    pub properties: Vec<Property>,
}

impl Element {
    /// Fewest bytes of one item.
    pub fn least_bytes(&self, encoding: Encoding) -> usize {
        let least = |property: &Property| match encoding {
            // a digit and what parts it from the next
            Encoding::Text => 2,
            Encoding::Binary(_) => property.count.unwrap_or(property.value).width(),
        };
        self.properties.iter().map(least).sum()
    }
}

#[derive(Clone, Debug)]
pub(super) struct Header {
    pub encoding: Encoding,
    pub elements: Vec<Element>,
}

const MOST_ELEMENTS: usize = 64;
const MOST_PROPERTIES: usize = 256;

/// The head; the cursor stands behind it then.
pub(super) fn read(cursor: &mut Cursor<'_>) -> Result<Header, Fault> {
    let mut encoding = None;
    let mut elements: Vec<Element> = Vec::new();
    // the first line is `ply`
    cursor.line();
    loop {
        let place = cursor.place();
        let Some(line) = cursor.line() else {
            return Err(Fault::cut_off(place, "the head", "a line end_header"));
        };
        let words: Vec<&[u8]> = line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty()).collect();
        match words.as_slice() {
            [] | [b"comment" | b"obj_info", ..] => {}
            [b"format", name, version] => encoding = Some(read_format(place, name, version)?),
            [b"element", name, count] => {
                if elements.len() == MOST_ELEMENTS {
                    return Err(Fault::new(
                        place,
                        "the number of elements",
                        "more",
                        format!("at most {MOST_ELEMENTS}"),
                    ));
                }
                let count = parse(count).ok_or_else(|| {
                    Fault::new(
                        place,
                        format!("the number of {}", text(name)),
                        quoted(count),
                        "a whole number of at least 0",
                    )
                })?;
                elements.push(Element { name: text(name), count, properties: Vec::new() });
            }
            [b"property", words @ ..] => {
                let property = read_property(place, words)?;
                let Some(element) = elements.last_mut() else {
                    return Err(Fault::new(
                        place,
                        "a property",
                        "before any element",
                        "a line `element` first",
                    ));
                };
                if element.properties.len() == MOST_PROPERTIES {
                    let expected = format!("at most {MOST_PROPERTIES}");
                    return Err(Fault::new(place, "the number of properties", "more", expected));
                }
                element.properties.push(property);
            }
            [b"end_header"] => break,
            _ => {
                let expected = "format, element, property, comment, obj_info or end_header";
                return Err(Fault::new(place, "a line of the head", quoted(line), expected));
            }
        }
    }
    match encoding {
        Some(encoding) => Ok(Header { encoding, elements }),
        None => Err(cursor.fault("the line `format`", "missing", "one before end_header")),
    }
}

fn text(word: &[u8]) -> String {
    String::from_utf8_lossy(word).into_owned()
}

fn read_format(place: Place, name: &[u8], version: &[u8]) -> Result<Encoding, Fault> {
    if version != b"1.0" {
        return Err(Fault::new(place, "the version of the PLY format", quoted(version), "1.0"));
    }
    match name {
        b"ascii" => Ok(Encoding::Text),
        b"binary_little_endian" => Ok(Encoding::Binary(Endian::Little)),
        b"binary_big_endian" => Ok(Encoding::Binary(Endian::Big)),
        _ => {
            let expected = "ascii, binary_little_endian or binary_big_endian";
            Err(Fault::new(place, "the PLY encoding", quoted(name), expected))
        }
    }
}

/// `type name`, or `list count-type value-type name`.
fn read_property(place: Place, words: &[&[u8]]) -> Result<Property, Fault> {
    let scalar = |word: &[u8]| {
        let found = SCALARS.iter().find(|(old, new, _)| *old == word || *new == word);
        found.map(|found| found.2).ok_or_else(|| {
            let expected = "char, uchar, short, ushort, int, uint, float or double";
            Fault::new(place, "the type of a property", quoted(word), expected)
        })
    };
    match words {
        [b"list", count, value, name] => {
            let count_type = scalar(count)?;
            if !count_type.is_integer() {
                let expected = "a whole type: uchar, ushort, uint, …";
                return Err(Fault::new(place, "the type of the count of a list", quoted(count), expected));
            }
            Ok(Property { name: text(name), value: scalar(value)?, count: Some(count_type) })
        }
        [value, name] => Ok(Property { name: text(name), value: scalar(value)?, count: None }),
        _ => {
            let found = quoted(&words.join(&b' '));
            Err(Fault::new(place, "a property", found, "a type and a name, or list, two types and a name"))
        }
    }
}
