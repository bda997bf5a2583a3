//! A series of VTU files in time, listed in a `.pvd` file that ParaView opens as one.

use std::path::{Path, PathBuf};

use super::xml::escape;
use crate::dataset::Output;
use crate::{IoError, write_dataset, write_file};

/// Writes frames `name_0000.vtu`, `name_0001.vtu`, … and keeps `name.pvd` complete after each.
#[derive(Clone, Debug)]
pub struct Series {
    folder: PathBuf,
    name: String,
    /// Time [s] of each frame.
    times: Vec<f64>,
}

impl Series {
    /// A series without frames; nothing is written yet.
    pub fn new(folder: impl Into<PathBuf>, name: impl Into<String>) -> Self {
        Self { folder: folder.into(), name: name.into(), times: Vec::new() }
    }

    /// The list of frames.
    pub fn path(&self) -> PathBuf {
        self.folder.join(format!("{}.pvd", self.name))
    }

    /// Number of frames so far.
    pub fn len(&self) -> usize {
        self.times.len()
    }

    pub fn is_empty(&self) -> bool {
        self.times.is_empty()
    }

    /// Writes one frame at a time [s] and the list with it; returns the path of the frame.
    ///
    /// # Errors
    /// The data are faulty or a file cannot be written; the list then names only complete frames.
    pub fn push(&mut self, time: f64, output: &Output<'_>) -> Result<PathBuf, IoError> {
        let frame = self.folder.join(self.frame_name(self.times.len()));
        write_dataset(&frame, output)?;
        self.times.push(time);
        match self.write_list(&self.path()) {
            Ok(()) => Ok(frame),
            Err(error) => {
                self.times.pop();
                Err(error)
            }
        }
    }

    fn frame_name(&self, index: usize) -> String {
        format!("{}_{index:04}.vtu", self.name)
    }

    fn write_list(&self, path: &Path) -> Result<(), IoError> {
        write_file(path, |out| {
            writeln!(out, "<?xml version=\"1.0\"?>")?;
            writeln!(out, "<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">")?;
            writeln!(out, "  <Collection>")?;
            for (index, time) in self.times.iter().enumerate() {
                let file = escape(&self.frame_name(index));
                writeln!(out, "    <DataSet timestep=\"{time:?}\" part=\"0\" file=\"{file}\"/>")?;
            }
            writeln!(out, "  </Collection>\n</VTKFile>")
        })
    }
}
