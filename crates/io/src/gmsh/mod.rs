//! Gmsh meshes: versions 1 (`$NOD`/`$ELM`), 2.x and 4.1, as text and as binary of either byte order.
//!
//! Physical groups become groups: volumes as cells, surfaces as facets, curves and points as the points that
//! they touch. A group without a name is called by its kind and number: `volume_3`, `surface_1`.

mod assembly;
mod element_type;
mod version_1;
mod version_2;
mod version_4;
mod write;

use souple_table::Entry;

use crate::Dataset;
use crate::cursor::{Cursor, Encoding, Endian};
use crate::error::{Fault, quoted};
use crate::format::Format;
use crate::holds::{HeldFields, Holds};

use assembly::Assembly;

pub(crate) static GMSH: Entry<Format> = Entry {
    name: "gmsh",
    summary: "Gmsh mesh with physical groups; reads versions 1, 2.x and 4.1, writes 4.1 as text",
    source: "Gmsh reference manual, MSH file format version 4.1",
    parameters: &[],
    build: Format {
        extensions: &["msh"],
        family: &[],
        parts: &[],
        recognises,
        read: Some(read),
        write: Some(|output, out| write::version_4(output, Encoding::Text, out)),
        holds: Holds { fields: HeldFields::None, ..Holds::ALL },
    },
};

pub(crate) static GMSH_BINARY: Entry<Format> = Entry {
    name: "gmsh_binary",
    summary: "Gmsh mesh; writes version 4.1 as binary: small and exact",
    source: "Gmsh reference manual, MSH file format version 4.1",
    parameters: &[],
    build: Format {
        extensions: &[],
        family: &["msh"],
        parts: &[],
        recognises,
        read: Some(read),
        write: Some(|output, out| write::version_4(output, Encoding::Binary(Endian::Little), out)),
        holds: Holds { fields: HeldFields::None, ..Holds::ALL },
    },
};

pub(crate) static GMSH_2: Entry<Format> = Entry {
    name: "gmsh_2",
    summary: "Gmsh mesh; writes version 2.2 as text, for older programs: one group for each cell",
    source: "Gmsh reference manual, MSH file format version 2",
    parameters: &[],
    build: Format {
        extensions: &["msh2"],
        family: &["msh"],
        parts: &[],
        recognises,
        read: Some(read),
        write: Some(|output, out| write::version_2(output, Encoding::Text, out)),
        holds: Holds { fields: HeldFields::None, ..Holds::ALL },
    },
};

fn recognises(bytes: &[u8]) -> bool {
    let starts: [&[u8]; 3] = [b"$MeshFormat", b"$NOD", b"$Comments"];
    starts.iter().any(|start| bytes.trim_ascii_start().starts_with(start))
}

/// Reads any version.
pub(crate) fn read(bytes: &[u8]) -> Result<Dataset, Fault> {
    let mut cursor = Cursor::new(bytes);
    let mut assembly = Assembly::default();
    let mut format = None;
    while let Some(section) = open_section(&mut cursor)? {
        match (section, format) {
            (b"NOD" | b"ELM", _) => version_1::read_section(&mut cursor, section, &mut assembly)?,
            (b"MeshFormat", None) => format = Some(read_format(&mut cursor)?),
            (b"PhysicalNames", _) => read_names(&mut cursor, &mut assembly)?,
            (b"Nodes" | b"Elements" | b"Entities", Some(format)) => {
                cursor.encoding = format.encoding;
                if format.major == 2 {
                    version_2::read_section(&mut cursor, section, &mut assembly)?;
                } else {
                    version_4::read_section(&mut cursor, section, format.size_width, &mut assembly)?;
                }
                cursor.encoding = Encoding::Text;
            }
            (b"Nodes" | b"Elements" | b"Entities" | b"MeshFormat", _) => {
                return Err(cursor.fault(
                    "the section",
                    quoted(section),
                    "one section $MeshFormat before all others",
                ));
            }
            _ => skip_section(&mut cursor, section, &mut assembly)?,
        }
        close_section(&mut cursor, section)?;
    }
    assembly.finish(&cursor)
}

/// What `$MeshFormat` says.
#[derive(Clone, Copy, Debug)]
struct MeshFormat {
    major: u32,
    encoding: Encoding,
    /// Bytes of a binary count.
    size_width: usize,
}

fn read_format(cursor: &mut Cursor<'_>) -> Result<MeshFormat, Fault> {
    let version: f64 = cursor.parse(format_args!("the version"), "a version: 2.2 or 4.1")?;
    let major = match version {
        version if (2.0..3.0).contains(&version) => 2,
        4.1 => 4,
        _ => {
            let found = format!("{version}");
            return Err(cursor.fault("the version of the Gmsh format", found, "1, 2.0 to 2.2, or 4.1"));
        }
    };
    let file_type = cursor.int(format_args!("the file type"))?;
    let size_width = cursor.int(format_args!("the data size"))?;
    let size_width = match size_width {
        4 | 8 => size_width as usize,
        _ => return Err(cursor.fault("the data size", size_width.to_string(), "4 or 8")),
    };
    let encoding = match file_type {
        0 => Encoding::Text,
        1 => {
            cursor.line();
            cursor.encoding = Encoding::Binary(Endian::Little);
            let mark = cursor.take(4, format_args!("the mark of the byte order"))?;
            let endian = match mark {
                [1, 0, 0, 0] => Endian::Little,
                [0, 0, 0, 1] => Endian::Big,
                _ => {
                    return Err(cursor.fault(
                        "the mark of the byte order",
                        format!("{mark:?}"),
                        "the number 1",
                    ));
                }
            };
            cursor.encoding = Encoding::Text;
            Encoding::Binary(endian)
        }
        _ => return Err(cursor.fault("the file type", file_type.to_string(), "0 (text) or 1 (binary)")),
    };
    Ok(MeshFormat { major, encoding, size_width })
}

/// `dimension tag "name"` for each group.
fn read_names(cursor: &mut Cursor<'_>, assembly: &mut Assembly) -> Result<(), Fault> {
    let count = cursor.size(8, format_args!("the number of physical names"))?;
    cursor.check_count(count, 6, format_args!("the number of physical names"))?;
    cursor.line();
    for _ in 0..count {
        let dimension = cursor.int(format_args!("the dimension of a physical name"))?;
        if !(0..=3).contains(&dimension) {
            return Err(cursor.fault(
                "the dimension of a physical name",
                dimension.to_string(),
                "0, 1, 2 or 3",
            ));
        }
        let tag = cursor.int(format_args!("the number of a physical name"))?;
        let place = cursor.place();
        let line = cursor.line().unwrap_or_default().trim_ascii();
        let name = line.strip_prefix(b"\"").and_then(|line| line.strip_suffix(b"\""));
        let name = name.and_then(|name| std::str::from_utf8(name).ok()).ok_or_else(|| {
            Fault::new(place, "a physical name", quoted(line), "a name in quotes, in UTF-8")
        })?;
        assembly.name_group(dimension as u8, tag, name);
    }
    Ok(())
}

/// `$Name` of the next section; `None` at the end of the file.
fn open_section<'a>(cursor: &mut Cursor<'a>) -> Result<Option<&'a [u8]>, Fault> {
    cursor.skip_space();
    let place = cursor.place();
    let Some(line) = cursor.line() else { return Ok(None) };
    match line.trim_ascii_end().strip_prefix(b"$") {
        Some(name) if !name.is_empty() && !name.starts_with(b"End") => Ok(Some(name)),
        _ => Err(Fault::new(place, "the start of a section", quoted(line), "$ and the name of a section")),
    }
}

fn closing_word(section: &[u8]) -> Vec<u8> {
    let end: &[u8] = if matches!(section, b"NOD" | b"ELM") { b"$END" } else { b"$End" };
    [end, section].concat()
}

fn close_section(cursor: &mut Cursor<'_>, section: &[u8]) -> Result<(), Fault> {
    let closing = closing_word(section);
    let expected = String::from_utf8_lossy(&closing).into_owned();
    let word = cursor.expect_word(format_args!("the end of the section"), &expected)?;
    if word == closing {
        return Ok(());
    }
    Err(cursor.fault("the end of the section", quoted(word), expected))
}

/// Up to the closing word of a section that holds no mesh.
fn skip_section(cursor: &mut Cursor<'_>, section: &[u8], assembly: &mut Assembly) -> Result<(), Fault> {
    assembly.leave_out(section);
    let closing = closing_word(section);
    let rest = cursor.rest();
    match rest.windows(closing.len()).position(|window| window == closing) {
        Some(length) => {
            cursor.seek(cursor.position() + length);
            Ok(())
        }
        None => {
            let expected = String::from_utf8_lossy(&closing).into_owned();
            Err(Fault::cut_off(cursor.place(), "the end of the section", expected))
        }
    }
}

#[cfg(test)]
mod tests;
