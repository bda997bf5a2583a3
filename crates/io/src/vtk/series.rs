//! A series of VTU files in time, listed in a `.pvd` file that ParaView opens as one.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use super::xml::{Document, escape};
use crate::dataset::Output;
use crate::error::{Fault, quoted};
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

    /// Names of the files that the next frame writes, its own first.
    pub fn next_names(&self) -> [String; 2] {
        [self.frame_name(self.times.len()), format!("{}.pvd", self.name)]
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

/// The frames of one part of a series: of one body.
#[derive(Clone, Debug, PartialEq)]
pub struct SeriesPart {
    /// What the list calls it by its attributes `group` and `part`, `0` where it says nothing; of several that it calls the same,
    /// the later ones with their number.
    pub name: String,
    /// Times [s] and files, in the order of time.
    pub frames: Vec<(f64, PathBuf)>,
}

/// The frames that a `.pvd` file lists, part by part.
///
/// # Errors
/// The file cannot be read, or is no list of frames with finite times.
pub fn read_series(path: &Path) -> Result<Vec<SeriesPart>, IoError> {
    let bytes = std::fs::read(path).map_err(|source| IoError::Read { path: path.to_owned(), source })?;
    read_series_bytes(path, &bytes)
}

/// The same from the content of the file, which would stand at `path`.
///
/// # Errors
/// The content is no list of frames with finite times.
pub fn read_series_bytes(path: &Path, bytes: &[u8]) -> Result<Vec<SeriesPart>, IoError> {
    let folder = path.parent().unwrap_or(Path::new("."));
    parts(bytes, folder).map_err(|fault| IoError::content(path, fault))
}

fn parts(bytes: &[u8], folder: &Path) -> Result<Vec<SeriesPart>, Fault> {
    let document = Document::parse(bytes, "AppendedData")?;
    let mut parts: Vec<SeriesPart> = Vec::new();
    let mut number_of: HashMap<String, usize> = HashMap::new();
    let mut named_at: HashMap<(String, u64), usize> = HashMap::new();
    for element in document.elements.iter().filter(|element| element.name == "DataSet") {
        let attribute = |key: &str| {
            let missing = || {
                let subject = format!("the attribute `{key}`");
                document.fault(element.position, subject, "missing", "a time and a file")
            };
            element.attribute(key).ok_or_else(missing)
        };
        let (time, file) = (attribute("timestep")?, attribute("file")?);
        let time = time.parse().ok().filter(|time: &f64| time.is_finite()).ok_or_else(|| {
            let found = quoted(time.as_bytes());
            document.fault(element.position, "the time of a frame", found, "a finite number")
        })?;
        let part = element.attribute("part").filter(|part| !part.is_empty()).unwrap_or("0");
        let mut name = match element.attribute("group").unwrap_or_default() {
            "" => part.to_owned(),
            group => format!("{group} {part}"),
        };
        // several files of one time are several bodies, also where nothing tells them apart
        let alike = named_at.entry((name.clone(), (time + 0.0).to_bits())).or_default();
        *alike += 1;
        if *alike > 1 {
            name = format!("{name} ({alike})");
        }
        let number = *number_of.entry(name.clone()).or_insert(parts.len());
        if number == parts.len() {
            parts.push(SeriesPart { name, frames: Vec::new() });
        }
        parts[number].frames.push((time, folder.join(file)));
    }
    if parts.is_empty() {
        return Err(document.fault(0, "the number of frames", "0", "elements <DataSet>, one or more"));
    }
    parts.iter_mut().for_each(|part| part.frames.sort_by(|a, b| a.0.total_cmp(&b.0)));
    Ok(parts)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::read_mesh;
    use crate::testing::{TemporaryFolder, mixed_mesh};

    /// A series lists its frames with their times, and each frame is a mesh.
    #[test]
    fn series_of_frames() {
        let folder = TemporaryFolder::new("series");
        let mesh = mixed_mesh();
        let mut series = Series::new(folder.path(""), "run & hide");
        for time in [0.0, 0.1, 0.2] {
            let frame = series.push(time, &Output::new(&mesh)).unwrap();
            assert_eq!(read_mesh(&frame).unwrap().0, mesh);
        }
        let list = std::fs::read_to_string(series.path()).unwrap();
        assert!(list.contains("timestep=\"0.1\" part=\"0\" file=\"run &amp; hide_0001.vtu\""), "{list}");
        assert_eq!(list.matches("<DataSet").count(), series.len());
        let [SeriesPart { name, frames }] = &read_series(&series.path()).unwrap()[..] else { panic!() };
        assert_eq!(frames.iter().map(|frame| frame.0).collect::<Vec<_>>(), [0.0, 0.1, 0.2]);
        assert!(name == "0" && frames.iter().all(|frame| frame.1.is_file()));
        for (from, to) in
            [("\"0.1\"", "\"nan\""), ("file=", "fill="), ("DataSet", "Datum"), ("<VTKFile", "<VTK")]
        {
            std::fs::write(folder.path("bad.pvd"), list.replace(from, to)).unwrap();
            assert!(read_series(&folder.path("bad.pvd")).is_err(), "{from}");
        }
    }

    /// Files of one time are those of several parts, whose frames stand in the order of time whatever that of the list.
    #[test]
    fn series_of_parts() {
        let file = |time: f64, of: &str, file: &str| {
            format!("<DataSet timestep=\"{time}\" {of} file=\"{file}\"/>\n")
        };
        let list = [
            file(0.5, "part=\"0\"", "a1"),
            file(0.5, "part=\"1\"", "b1"),
            file(0.0, "group=\"\" part=\"1\"", "b0"),
            file(0.0, "", "a0"),
            file(0.5, "", "d1"),
            file(0.0, "part=\"0\"", "d0"),
            file(0.0, "group=\"skin\" part=\"1\"", "c0"),
        ];
        let text = format!("<VTKFile><Collection>{}</Collection></VTKFile>", list.concat());
        let part = |name: &str, files: &[(f64, &str)]| SeriesPart {
            name: name.to_owned(),
            frames: files.iter().map(|(time, file)| (*time, Path::new("run").join(file))).collect(),
        };
        let read = read_series_bytes(Path::new("run/list.pvd"), text.as_bytes()).unwrap();
        let expected = [
            part("0", &[(0.0, "a0"), (0.5, "a1")]),
            part("1", &[(0.0, "b0"), (0.5, "b1")]),
            part("0 (2)", &[(0.0, "d0"), (0.5, "d1")]),
            part("skin 1", &[(0.0, "c0")]),
        ];
        assert_eq!(read, expected);
    }
}
