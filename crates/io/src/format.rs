//! The table of file formats, and reading and writing by it.

use std::io::Write;
use std::path::{Path, PathBuf};

use souple_mesh::Mesh;
use souple_table::{Entry, Table};

use crate::beside::write_files;
use crate::dataset::Output;
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

/// The files that a mesh is read from: that of the path, then those that stand beside it where a format has several.
pub fn files_of_mesh(path: &Path) -> Vec<PathBuf> {
    let parts = by_extension(path).map_or(&[][..], |entry| entry.build.parts);
    let mut files = vec![path.to_owned()];
    files.extend(parts::others_of(path, parts));
    files
}

/// The mesh of a file whose content is already in memory; `path` says its extension and is named in errors.
///
/// # Errors
/// The extension is unknown, the content is faulty.
pub fn read_mesh_content(path: &Path, bytes: &[u8]) -> Result<(Mesh, Vec<String>), IoError> {
    let dataset = read_content(path, bytes)?;
    Ok((dataset.mesh, dataset.notes))
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
    let by_content = FORMATS.entries.iter().copied().find(|entry| (entry.build.recognises)(bytes));
    let entry = match (by_extension(path), by_content) {
        // the extension rules while the content agrees or says nothing
        (Ok(named), found) if (named.build.recognises)(bytes) || found.is_none() => named,
        (_, Some(found)) => found,
        (Ok(named), None) => named,
        (Err(_), None) => return Err(unknown_extension(path, |format| format.read.is_some())),
    };
    let read = entry.build.read.ok_or(IoError::Unsupported {
        format: entry.name,
        action: "read",
        expected: readable(),
    })?;
    let mut dataset = read(bytes).map_err(|fault| IoError::content(path, fault))?;
    if by_extension(path).map_or(true, |named| !std::ptr::eq(named, entry)) {
        dataset.notes.insert(0, format!("the content was recognised as the format `{}`", entry.name));
    }
    Ok(dataset)
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
    read(bytes).map_err(|fault| IoError::content(Path::new("<memory>"), fault))
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

fn write_with(entry: &'static Entry<Format>, path: &Path, output: &Output<'_>) -> Result<(), IoError> {
    let write = entry.build.write.ok_or_else(|| IoError::Unsupported {
        format: entry.name,
        action: "written",
        expected: format!("one of {}", names_where(|format| format.write.is_some())),
    })?;
    output.check()?;
    entry.build.holds.check(entry.name, output)?;
    let mut refusal = None;
    let mut content = |out: &mut dyn Write| match write(output, out) {
        Ok(()) => Ok(()),
        Err(WriteError::System(error)) => Err(error),
        Err(WriteError::Request(error)) => {
            refusal = Some(error);
            Err(std::io::ErrorKind::InvalidInput.into())
        }
    };
    let written = if entry.build.parts.is_empty() {
        write_file(path, content)
    } else {
        let mut joined = Vec::new();
        let made = content(&mut joined).map_err(|source| IoError::write(path, source));
        made.and_then(|()| write_files(&parts::split_for(path, &joined)))
    };
    match refusal {
        Some(error) => Err(error),
        None => written,
    }
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
pub fn format_of(path: &Path) -> Result<&'static str, IoError> {
    Ok(by_extension(path)?.name)
}

/// The name of the format, where a file of that path can be read again: by its extension, or by what it begins with where the
/// format is one of several that share an extension.
///
/// # Errors
/// The format is unknown, or has other extensions.
pub fn format_for(format: &str, path: &Path) -> Result<&'static str, IoError> {
    let entry = FORMATS.find(format)?;
    let known = entry.build.extensions;
    let found = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    if known.is_empty() || known.contains(&found.as_str()) {
        return Ok(entry.name);
    }
    let expected = format!("{} for the format `{}`", known.join(" or "), entry.name);
    Err(IoError::request(format!("the extension of {}", path.display()), format!("`{found}`"), expected))
}

fn by_extension(path: &Path) -> Result<&'static Entry<Format>, IoError> {
    let extension = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    FORMATS
        .entries
        .iter()
        .copied()
        .find(|entry| entry.build.extensions.contains(&extension.as_str()))
        .ok_or_else(|| unknown_extension(path, |format| format.write.is_some()))
}

/// The extensions that would be known are those of formats that fit what is wanted.
fn unknown_extension(path: &Path, fits: impl Fn(&Format) -> bool) -> IoError {
    let found = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
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
