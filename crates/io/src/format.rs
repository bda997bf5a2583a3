//! The table of file formats, and reading and writing by it.

use std::io::Write;
use std::path::{Path, PathBuf};

use souple_mesh::Mesh;
use souple_table::{Entry, Table};

use crate::beside::write_files;
use crate::dataset::Output;
use crate::encoding::Content;
use crate::error::{Fault, Place, quoted};
use crate::holds::Holds;
use crate::{Dataset, IoError, gltf, gmsh, obj, off, parts, ply, stl, tetgen, vtk, write_file};

/// Reads a whole content.
pub type Read = fn(&[u8]) -> Result<Dataset, Fault>;

/// Writes a whole content.
pub type WriteInto = fn(&Output<'_>, &mut dyn Write) -> Result<(), WriteError>;

/// A file format: how it is found, read, written, and what it has room for.
#[derive(Clone, Copy, Debug)]
pub struct Format {
    /// File name extensions that stand for it, in lower case, without the dot.
    pub extensions: &'static [&'static str],
    /// Extensions that stand for another format of its family, whose reader takes it too.
    pub family: &'static [&'static str],
    /// Extensions of the files that one mesh is kept in, for formats of several; `read` and `write` then take
    /// them joined (see `parts.rs`). Empty for formats of one file.
    pub parts: &'static [&'static str],
    /// Whether content begins like this format.
    pub recognises: fn(&[u8]) -> bool,
    pub read: Option<Read>,
    pub write: Option<WriteInto>,
    /// What of a mesh the writer keeps.
    pub holds: Holds,
}

/// Why a writer stopped: what it was given, or the system.
#[derive(Debug, thiserror::Error)]
pub enum WriteError {
    #[error(transparent)]
    System(#[from] std::io::Error),
    #[error(transparent)]
    Request(#[from] IoError),
}

/// All formats of meshes.
pub static FORMATS: Table<Format> = Table {
    kind: "mesh format",
    entries: &[
        &gmsh::GMSH,
        &gmsh::GMSH_BINARY,
        &gmsh::GMSH_2,
        &vtk::VTU,
        &vtk::VTK_LEGACY,
        &tetgen::TETGEN,
        &obj::OBJ,
        &ply::PLY,
        &ply::PLY_TEXT,
        &off::OFF,
        &stl::STL,
        &stl::STL_TEXT,
        &gltf::GLTF,
    ],
};

/// The mesh of a file and what a user should know about how it was read.
///
/// # Errors
/// The file cannot be opened, its extension is unknown, its content is faulty.
pub fn read_mesh(path: &Path) -> Result<(Mesh, Vec<String>), IoError> {
    let dataset = read_dataset(path)?;
    Ok((dataset.mesh, dataset.notes))
}

/// Like [`read_mesh`], of a file in one part whose content is at hand; its path says which format it is of.
///
/// # Errors
/// No format knows it, or it is faulty.
pub fn read_mesh_content(path: &Path, bytes: &[u8]) -> Result<(Mesh, Vec<String>), IoError> {
    let dataset = read_content(path, bytes)?;
    Ok((dataset.mesh, dataset.notes))
}

/// The files that a mesh is read from: that of the path, then those that stand beside it where a format has several.
pub fn files_of_mesh(path: &Path) -> Vec<PathBuf> {
    let parts = by_extension(path).map_or(&[][..], |entry| entry.build.parts);
    let mut files = vec![path.to_owned()];
    files.extend(parts::others_of(path, parts));
    files
}

/// The mesh and the fields of a file; the format goes by the extension, or by the content where that says more.
///
/// # Errors
/// The file cannot be opened, its extension is unknown, its content is faulty.
pub fn read_dataset(path: &Path) -> Result<Dataset, IoError> {
    if let Ok(Entry { build: format @ Format { read: Some(read), .. }, .. }) = by_extension(path)
        && !format.parts.is_empty()
    {
        let bytes = parts::read_joined(path, format.parts)?;
        return read(&bytes).map_err(|fault| IoError::content(path, fault));
    }
    let bytes = std::fs::read(path).map_err(|source| IoError::Read { path: path.to_owned(), source })?;
    read_content(path, &bytes)
}

fn read_content(path: &Path, bytes: &[u8]) -> Result<Dataset, IoError> {
    let refuse = |fault| IoError::content(path, fault);
    let content = Content::of(bytes, |bytes| by_content(bytes).is_some()).map_err(refuse)?;
    let bytes = content.bytes;
    let entry = match (by_extension(path), by_content(bytes)) {
        // the extension rules while the content agrees or says nothing
        (Ok(named), found) if (named.build.recognises)(bytes) || found.is_none() => named,
        (_, Some(found)) => found,
        (Ok(named), None) => named,
        (Err(_), None) => return Err(unknown_extension(path, |format| format.read.is_some())),
    };
    let read = entry.build.read.ok_or_else(|| {
        let what = format!("the format of {}", path.display());
        IoError::request(what, format!("{}, which cannot be read", entry.name), readable())
    })?;
    let mut dataset = content.read(read).map_err(refuse)?;
    if by_extension(path).map_or(true, |named| !std::ptr::eq(named, entry)) {
        dataset.notes.insert(0, format!("the content was recognised as the format `{}`", entry.name));
    }
    Ok(dataset)
}

/// The format that knows content for its own.
fn by_content(bytes: &[u8]) -> Option<&'static Entry<Format>> {
    FORMATS.entries.iter().copied().find(|entry| (entry.build.recognises)(bytes))
}

/// The content of a file, already in memory, in the format of that name.
///
/// # Errors
/// The format is unknown or has no reader; the content is faulty (its path is then `<memory>`).
pub fn read_mesh_bytes(format: &str, bytes: &[u8]) -> Result<(Mesh, Vec<String>), IoError> {
    let dataset = read_dataset_bytes(format, bytes)?;
    Ok((dataset.mesh, dataset.notes))
}

/// Like [`read_mesh_bytes`], with the fields.
///
/// # Errors
/// The format is unknown or has no reader; the content is faulty (its path is then `<memory>`).
pub fn read_dataset_bytes(format: &str, bytes: &[u8]) -> Result<Dataset, IoError> {
    let entry = FORMATS.find(format)?;
    let expected = readable();
    let read =
        entry.build.read.ok_or(IoError::Unsupported { format: entry.name, action: "read", expected })?;
    Content::of(bytes, entry.build.recognises)
        .and_then(|content| content.read(read))
        .map_err(|fault| IoError::content(Path::new("<memory>"), fault))
}

/// Writes a mesh, the format by the extension.
///
/// # Errors
/// The extension is unknown, the mesh is faulty or has what the format cannot hold, the file cannot be written.
pub fn write_mesh(path: &Path, mesh: &Mesh) -> Result<(), IoError> {
    write_dataset(path, &Output::new(mesh))
}

/// Writes a mesh with fields, the format by the extension.
///
/// # Errors
/// The extension is unknown, the mesh is faulty or has what the format cannot hold, the file cannot be written.
pub fn write_dataset(path: &Path, output: &Output<'_>) -> Result<(), IoError> {
    write_with(by_extension(path)?, path, output)
}

/// Writes a mesh with fields in the format of that name.
///
/// # Errors
/// The format is unknown, the mesh is faulty or has what the format cannot hold, the file cannot be written.
pub fn write_dataset_as(format: &str, path: &Path, output: &Output<'_>) -> Result<(), IoError> {
    write_with(FORMATS.find(format)?, path, output)
}

/// Writes like [`write_dataset_as`], once what will be in the file has been read back; what was read, `None` where the format is
/// only written.
///
/// # Errors
/// Those of [`write_dataset_as`], or the format's own reader refuses the content: nothing is written then.
pub fn write_and_read_back(
    format: &str,
    path: &Path,
    output: &Output<'_>,
) -> Result<Option<Dataset>, IoError> {
    let entry = FORMATS.find(format)?;
    let content = content_of(entry, path, output)?;
    let read_back = |read: Read| read(&content).map_err(|fault| IoError::content(path, fault));
    let dataset = entry.build.read.map(read_back).transpose()?;
    if entry.build.parts.is_empty() {
        write_file(path, |out| out.write_all(&content))?;
    } else {
        write_files(&parts::split_for(path, &content))?;
    }
    Ok(dataset)
}

fn write_with(entry: &'static Entry<Format>, path: &Path, output: &Output<'_>) -> Result<(), IoError> {
    if !entry.build.parts.is_empty() {
        return write_files(&parts::split_for(path, &content_of(entry, path, output)?));
    }
    let write = checked_writer(entry, output)?;
    let mut refusal = None;
    let written = write_file(path, |out| match write(output, out) {
        Ok(()) => Ok(()),
        Err(WriteError::System(error)) => Err(error),
        Err(WriteError::Request(error)) => {
            refusal = Some(error);
            Err(std::io::ErrorKind::InvalidInput.into())
        }
    });
    match refusal {
        Some(error) => Err(error),
        None => written,
    }
}

/// What the file or the files of that path will hold.
fn content_of(entry: &'static Entry<Format>, path: &Path, output: &Output<'_>) -> Result<Vec<u8>, IoError> {
    let mut content = Vec::new();
    match checked_writer(entry, output)?(output, &mut content) {
        Ok(()) => Ok(content),
        Err(WriteError::System(source)) => Err(IoError::write(path, source)),
        Err(WriteError::Request(error)) => Err(error),
    }
}

/// The writer of a format, for a mesh that it can be asked to write.
fn checked_writer(entry: &'static Entry<Format>, output: &Output<'_>) -> Result<WriteInto, IoError> {
    let write = writer_of(entry)?;
    output.check()?;
    entry.build.holds.check(entry.name, output)?;
    Ok(write)
}

fn writer_of(entry: &'static Entry<Format>) -> Result<WriteInto, IoError> {
    entry.build.write.ok_or_else(|| IoError::Unsupported {
        format: entry.name,
        action: "written",
        expected: format!("one of {}", names_where(|format| format.write.is_some())),
    })
}

/// What a file of the format will not hold of a mesh, in words; nothing where all of it is kept.
///
/// # Errors
/// The format is unknown.
pub fn losses(format: &str, output: &Output<'_>) -> Result<Vec<String>, IoError> {
    let entry = FORMATS.find(format)?;
    Ok(entry.build.holds.losses(entry.name, output))
}

/// The name of the format that a file's extension stands for.
///
/// # Errors
/// The extension is unknown.
fn format_of(path: &Path) -> Result<&'static str, IoError> {
    Ok(by_extension(path)?.name)
}

/// The name of the format, where a file of that path can be read again: its extension stands for it, or for one of its family.
///
/// # Errors
/// The format is unknown, or has other extensions.
fn format_for(format: &str, path: &Path) -> Result<&'static str, IoError> {
    let entry = FORMATS.find(format)?;
    let known = [entry.build.extensions, entry.build.family].concat();
    let found = extension_of(path);
    if known.contains(&found.as_str()) {
        return Ok(entry.name);
    }
    let expected = format!("{} for the format `{}`", known.join(" or "), entry.name);
    Err(IoError::request(format!("the extension of {}", path.display()), format!("`{found}`"), expected))
}

/// The name of the format that a mesh would be written in, the one named or that of the extension: before the work of which it is the
/// result.
///
/// # Errors
/// No mesh can be written there: the format is unknown, is not written, or the folder is missing.
pub fn writable_format(format: Option<&str>, path: &Path) -> Result<&'static str, IoError> {
    let name = match format {
        Some(name) => format_for(name, path)?,
        None => format_of(path)?,
    };
    let entry = FORMATS.find(name)?;
    writer_of(entry)?;
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() && !folder.is_dir() => {
            Err(IoError::write(path, std::io::ErrorKind::NotFound.into()))
        }
        _ => Ok(entry.name),
    }
}

/// In lower case, without the dot; empty where there is none.
fn extension_of(path: &Path) -> String {
    path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase()
}

fn by_extension(path: &Path) -> Result<&'static Entry<Format>, IoError> {
    let extension = extension_of(path);
    FORMATS
        .entries
        .iter()
        .copied()
        .find(|entry| entry.build.extensions.contains(&extension.as_str()))
        .ok_or_else(|| unknown_extension(path, |format| format.write.is_some()))
}

/// The extensions that would be known are those of formats that fit what is wanted.
fn unknown_extension(path: &Path, fits: impl Fn(&Format) -> bool) -> IoError {
    let found = extension_of(path);
    let fitting = FORMATS.entries.iter().filter(|entry| fits(&entry.build));
    let known: Vec<&str> = fitting.flat_map(|entry| entry.build.extensions).copied().collect();
    let expected = format!("one of {}", known.join(", "));
    IoError::Extension { path: path.to_owned(), found, expected }
}

fn readable() -> String {
    format!("one of {}", names_where(|format| format.read.is_some()))
}

fn names_where(fits: impl Fn(&Format) -> bool) -> String {
    let names: Vec<_> =
        FORMATS.entries.iter().filter(|entry| fits(&entry.build)).map(|entry| entry.name).collect();
    names.join(", ")
}

/// The fault of content that does not begin like its format.
pub(crate) fn wrong_start(bytes: &[u8], format: &str, expected: &str) -> Fault {
    let start = &bytes[..bytes.len().min(24)];
    Fault::new(Place::Byte(0), format!("the start of the {format} file"), quoted(start), expected)
}

#[cfg(test)]
mod tests;
