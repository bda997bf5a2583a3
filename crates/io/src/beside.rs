//! Writing beside and renaming: a reader of the final name never sees half a file.

use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use crate::IoError;

/// Writes `path` by `content`, complete or not at all.
///
/// The content goes to a hidden file of the same folder, is forced to the disk and renamed. After a failure
/// the hidden file is removed and an older file of that name stands as it was.
///
/// # Errors
/// The disk is full, the folder is missing or not writable, or any other failure of the system.
pub fn write_file(
    path: &Path,
    content: impl FnOnce(&mut dyn Write) -> std::io::Result<()>,
) -> Result<(), IoError> {
    // a device or a pipe is written as it is: renaming would put a file in its place
    if let Ok(target) = fs::metadata(path)
        && !target.is_file()
        && !target.is_dir()
    {
        return write_through(path, content).map_err(|source| IoError::write(path, source));
    }
    let temporary = name_beside(path)
        .ok_or_else(|| IoError::request("the path", format!("`{}`", path.display()), "the name of a file"))?;
    write_and_rename(path, &temporary, content).map_err(|source| {
        // the first failure is the one to report; the hidden file may not even exist
        let _ = fs::remove_file(&temporary);
        IoError::write(path, source)
    })
}

/// Whether [`write_file`] can be expected to write a file: tried with an empty one beside, which is removed again.
///
/// # Errors
/// It is a folder, or the folder that it is to be in is missing or not writable.
pub fn may_be_written(path: &Path) -> Result<(), IoError> {
    match fs::metadata(path) {
        Ok(target) if target.is_dir() => {
            return Err(IoError::write(path, std::io::ErrorKind::IsADirectory.into()));
        }
        // what a device or a pipe takes is known when it is written
        Ok(target) if !target.is_file() => return Ok(()),
        _ => {}
    }
    let temporary = name_beside(path)
        .ok_or_else(|| IoError::request("the path", format!("`{}`", path.display()), "the name of a file"))?;
    let tried = fs::File::create_new(&temporary).and_then(|_| fs::remove_file(&temporary));
    tried.map_err(|source| IoError::write(path, source))
}

/// Writes several files that belong together: all are complete beside before the first is renamed.
///
/// # Errors
/// Those of [`write_file`]; files not yet renamed stand as they were.
pub(crate) fn write_files(files: &[(PathBuf, Vec<u8>)]) -> Result<(), IoError> {
    let mut pairs: Vec<(&Path, PathBuf)> = Vec::with_capacity(files.len());
    let result = files.iter().try_for_each(|(path, content)| {
        let temporary = name_beside(path).ok_or_else(|| {
            IoError::request("the path", format!("`{}`", path.display()), "the name of a file")
        })?;
        pairs.push((path, temporary.clone()));
        write_synced(&temporary, |out| out.write_all(content)).map_err(|source| IoError::write(path, source))
    });
    let result = result.and_then(|()| {
        pairs.iter().try_for_each(|(path, temporary)| {
            fs::rename(temporary, path).map_err(|source| IoError::write(path, source))
        })
    });
    if result.is_err() {
        for (_, temporary) in &pairs {
            // the first failure is the one to report; renamed ones are gone already
            let _ = fs::remove_file(temporary);
        }
    }
    result
}

fn write_and_rename(
    path: &Path,
    temporary: &Path,
    content: impl FnOnce(&mut dyn Write) -> std::io::Result<()>,
) -> std::io::Result<()> {
    write_synced(temporary, content)?;
    fs::rename(temporary, path)
}

fn write_synced(
    path: &Path,
    content: impl FnOnce(&mut dyn Write) -> std::io::Result<()>,
) -> std::io::Result<()> {
    let mut writer = BufWriter::with_capacity(1 << 16, File::create_new(path)?);
    content(&mut writer)?;
    // a full disk may show only here, when the buffers go out
    writer.into_inner().map_err(|error| error.into_error())?.sync_all()
}

fn write_through(
    path: &Path,
    content: impl FnOnce(&mut dyn Write) -> std::io::Result<()>,
) -> std::io::Result<()> {
    let mut writer = BufWriter::with_capacity(1 << 16, File::options().write(true).open(path)?);
    content(&mut writer)?;
    writer.flush()
}

/// `.name.process-count.part`, different for each writer of each process.
fn name_beside(path: &Path) -> Option<PathBuf> {
    static COUNT: AtomicU64 = AtomicU64::new(0);
    let count = COUNT.fetch_add(1, Ordering::Relaxed);
    let mut name = std::ffi::OsString::from(".");
    name.push(path.file_name()?);
    name.push(format!(".{}-{count}.part", std::process::id()));
    Some(path.with_file_name(name))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::TemporaryFolder;

    /// What can be written is known before, and leaves nothing behind.
    #[test]
    fn what_can_be_written_is_known_before() {
        let folder = TemporaryFolder::new("may_be_written");
        assert!(may_be_written(&folder.path("new")).is_ok());
        assert_eq!(fs::read_dir(folder.path(".")).unwrap().count(), 0);
        assert!(may_be_written(&folder.path(".")).is_err());
        assert!(may_be_written(&folder.path("missing/new")).is_err());
        assert!(may_be_written(Path::new("..")).is_err());
    }

    /// A failed write leaves the old file and no other; a good one replaces it.
    #[test]
    fn all_or_nothing() {
        let folder = TemporaryFolder::new("beside");
        let path = folder.path("file.txt");
        write_file(&path, |out| out.write_all(b"old")).unwrap();
        let full = write_file(&path, |out| {
            out.write_all(b"half of the n")?;
            Err(std::io::ErrorKind::StorageFull.into())
        });
        assert!(matches!(full, Err(IoError::DiskFull { .. })));
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(fs::read_dir(path.parent().unwrap()).unwrap().count(), 1);
        write_file(&path, |out| out.write_all(b"new")).unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"new");
    }

    #[test]
    fn missing_folder_is_named() {
        let folder = TemporaryFolder::new("beside_missing");
        let error = write_file(&folder.path("no/such/file"), |_| Ok(())).unwrap_err();
        assert!(matches!(error, IoError::NotWritable { .. }), "{error}");
        assert!(matches!(write_file(Path::new("/"), |_| Ok(())), Err(IoError::Request { .. })));
    }

    /// Devices are written, not replaced: by a link, so that a fault here harms no device of the machine.
    #[cfg(target_os = "linux")]
    #[test]
    fn devices_stay_what_they_are() {
        let folder = TemporaryFolder::new("beside_device");
        let (full, null) = (folder.path("full"), folder.path("null"));
        std::os::unix::fs::symlink("/dev/full", &full).unwrap();
        std::os::unix::fs::symlink("/dev/null", &null).unwrap();
        assert!(matches!(write_file(&full, |out| out.write_all(b"x")), Err(IoError::DiskFull { .. })));
        write_file(&null, |out| out.write_all(b"x")).unwrap();
        assert!(full.is_symlink() && null.is_symlink());
    }

    /// `/dev/full` refuses every byte as a full disk does.
    #[cfg(target_os = "linux")]
    #[test]
    fn full_device_is_a_full_disk() {
        let error =
            File::options().write(true).open("/dev/full").and_then(|mut f| f.write_all(b"x")).unwrap_err();
        assert!(matches!(IoError::write(Path::new("out.vtu"), error), IoError::DiskFull { .. }));
    }
}
