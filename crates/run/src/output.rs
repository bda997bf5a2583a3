//! The folder of a run. What a run writes there is replaced as a set by the next one; all else stays untouched.
//!
//! The folder itself is locked while a run has it; the system takes the lock away with the process that held it.
//!
//! `files.txt` lists what was written, each file before it is: also a run that was killed leaves a folder that the
//! next one can clear. A file that is not listed is nobody's but the user's: where a run would write over one, it
//! refuses to start.

use std::collections::BTreeSet;
use std::fs::{self, File, TryLockError};
use std::io::Write;
use std::path::{Component, Path, PathBuf};

use souple_io::IoError;

/// The list of what runs have written.
pub const MANIFEST: &str = "files.txt";
const HEADER: &str = "files written by `souple run`, which the next run into this folder replaces";
/// The folder of frames within the folder of a run.
pub const FRAMES: &str = "frames";

/// A folder that a run cannot have.
#[derive(Debug, thiserror::Error)]
pub enum OutputError {
    #[error("the folder `{}` cannot be made: {source}", .path.display())]
    Folder { path: PathBuf, source: std::io::Error },
    #[error(
        "`{}` is a file, and results go into a folder; choose another name, it is made if missing",
        .path.display()
    )]
    NoFolder { path: PathBuf },
    #[error(
        "`{}` would be overwritten, and no run has written it: `{MANIFEST}` of its folder does not list it; move it away, or choose a folder without it",
        .path.display()
    )]
    Foreign { path: PathBuf },
    #[error(
        "`{}` is no list of what a run has written, and a run would put its own there; move it away, or choose a folder without it",
        .path.display()
    )]
    ForeignList { path: PathBuf },
    #[error(
        "`{}` holds results of an earlier run (`{example}`), which a resumed run would replace by its own part; choose a folder without results",
        .folder.display()
    )]
    WouldLoseResults { folder: PathBuf, example: String },
    #[error(
        "another run is writing into `{}`; wait for its end or choose another folder",
        .path.display()
    )]
    InUse { path: PathBuf },
    #[error("line {line} of `{}` is `{found}`, no file within the folder", .path.display())]
    List { path: PathBuf, line: usize, found: String },
    #[error("`{}`, of an earlier run, cannot be removed: {source}", .path.display())]
    NotRemoved { path: PathBuf, source: std::io::Error },
    #[error(transparent)]
    Io(#[from] IoError),
}

/// What a run may write, and whether it goes on with an earlier one.
pub struct Plan<'a> {
    /// Whether a file of this name, relative to the folder, may be written.
    pub writes: &'a dyn Fn(&str) -> bool,
    /// Files of the earlier run that stay: a resumed run keeps the snapshots up to its own.
    pub keeps: Option<&'a dyn Fn(&str) -> bool>,
}

/// The folder of a run, cleared of the run before.
pub struct OutputFolder {
    root: PathBuf,
    listed: BTreeSet<String>,
    list: File,
    replaced: usize,
    /// Holds the lock.
    _folder: Option<File>,
}

impl OutputFolder {
    /// # Errors
    /// The folder cannot be had or another run has it, or a file in it must not be replaced; nothing has been removed
    /// then.
    pub fn open(root: &Path, plan: &Plan) -> Result<Self, OutputError> {
        make_folder(root)?;
        let folder = locked(root)?;
        let listed = read_list(root)?;
        for name in present(root) {
            if (plan.writes)(&name) && !listed.contains(&name) {
                return Err(OutputError::Foreign { path: root.join(name) });
            }
        }
        let frames = root.join(FRAMES);
        if frames.exists() && !frames.is_dir() {
            return Err(OutputError::Foreign { path: frames });
        }
        let stays = |name: &String| plan.keeps.is_some_and(|keeps| keeps(name));
        if plan.keeps.is_some()
            && let Some(name) = listed.iter().find(|name| !stays(name) && root.join(name).exists())
        {
            let (folder, example) = (root.to_owned(), name.clone());
            return Err(OutputError::WouldLoseResults { folder, example });
        }
        let (kept, old): (BTreeSet<String>, BTreeSet<String>) = listed.into_iter().partition(stays);
        let mut replaced = 0;
        for name in &old {
            let path = root.join(name);
            match fs::remove_file(&path) {
                Ok(()) => replaced += 1,
                Err(source) if source.kind() != std::io::ErrorKind::NotFound => {
                    return Err(OutputError::NotRemoved { path, source });
                }
                Err(_) => {}
            }
        }
        if old.iter().any(|name| name.starts_with(FRAMES)) {
            // stays where it holds files of others
            let _ = fs::remove_dir(root.join(FRAMES));
        }
        let path = root.join(MANIFEST);
        souple_io::write_file(&path, |out| {
            writeln!(out, "{HEADER}")?;
            kept.iter().try_for_each(|name| writeln!(out, "{name}"))
        })?;
        let list = File::options().append(true).open(&path);
        let list = list.map_err(|source| IoError::Write { path, source })?;
        Ok(Self { root: root.to_owned(), listed: kept, list, replaced, _folder: folder })
    }

    /// Files of the run before that are gone.
    pub fn replaced(&self) -> usize {
        self.replaced
    }

    /// Lists a file as the run's own, by its name relative to the folder, and gives its path.
    ///
    /// # Errors
    /// The list cannot be written.
    pub fn claim(&mut self, name: &str) -> Result<PathBuf, OutputError> {
        if self.listed.insert(name.to_owned()) {
            let written = self.list.write_all(format!("{name}\n").as_bytes());
            written.map_err(|source| IoError::Write { path: self.root.join(MANIFEST), source })?;
        }
        Ok(self.root.join(name))
    }

    /// The folder of frames, made if missing.
    ///
    /// # Errors
    /// It cannot be made.
    pub fn frames(&self) -> Result<PathBuf, OutputError> {
        let path = self.root.join(FRAMES);
        make_folder(&path)?;
        Ok(path)
    }
}

/// A folder that no other run can have while this is open; `None` where the system locks no folders.
fn locked(path: &Path) -> Result<Option<File>, OutputError> {
    let Ok(folder) = File::open(path) else { return Ok(None) };
    match folder.try_lock() {
        Ok(()) => Ok(Some(folder)),
        Err(TryLockError::WouldBlock) => Err(OutputError::InUse { path: path.to_owned() }),
        Err(TryLockError::Error(_)) => Ok(None),
    }
}

fn make_folder(path: &Path) -> Result<(), OutputError> {
    if path.exists() && !path.is_dir() {
        return Err(OutputError::NoFolder { path: path.to_owned() });
    }
    fs::create_dir_all(path).map_err(|source| OutputError::Folder { path: path.to_owned(), source })
}

/// The names in the list of a folder; none where there is no list.
fn read_list(root: &Path) -> Result<BTreeSet<String>, OutputError> {
    let path = root.join(MANIFEST);
    let text = match fs::read_to_string(&path) {
        Ok(text) => text,
        Err(error) if error.kind() == std::io::ErrorKind::InvalidData => {
            return Err(OutputError::ForeignList { path });
        }
        Err(_) => return Ok(BTreeSet::new()),
    };
    let mut lines = text.lines();
    if lines.next() != Some(HEADER) {
        return Err(OutputError::ForeignList { path });
    }
    let mut names = BTreeSet::new();
    for (index, name) in lines.enumerate() {
        let is_within = Path::new(name).components().all(|part| matches!(part, Component::Normal(_)));
        if name.is_empty() || !is_within {
            return Err(OutputError::List { path, line: index + 2, found: name.to_owned() });
        }
        names.insert(name.to_owned());
    }
    Ok(names)
}

/// Files in a folder and in its folder of frames, relative to it.
fn present(root: &Path) -> Vec<String> {
    let names = |folder: &Path| -> Vec<String> {
        let entries = fs::read_dir(folder).into_iter().flatten().flatten();
        entries.filter_map(|entry| entry.file_name().into_string().ok()).collect()
    };
    let mut all = names(root);
    all.retain(|name| name != FRAMES);
    all.extend(names(&root.join(FRAMES)).into_iter().map(|name| format!("{FRAMES}/{name}")));
    all.sort();
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Temporary(PathBuf);

    impl Temporary {
        fn new(name: &str) -> Self {
            let path = std::env::temp_dir().join(format!("souple_output_{name}_{}", std::process::id()));
            fs::create_dir_all(&path).unwrap();
            Self(path)
        }

        fn write(&self, name: &str) {
            fs::write(self.0.join(name), name).unwrap();
        }

        fn names(&self) -> Vec<String> {
            present(&self.0)
        }
    }

    impl Drop for Temporary {
        fn drop(&mut self) {
            let _ = fs::remove_dir_all(&self.0);
        }
    }

    const ANY: Plan = Plan { writes: &|_| true, keeps: None };

    /// The files of a run are gone in the next, those of others stay; a list that was tampered with is refused.
    #[test]
    fn files_are_replaced_as_a_set() {
        let folder = Temporary::new("set");
        let plan = Plan { writes: &|name| name != "notes.txt" && name != MANIFEST, keeps: None };
        let mut first = OutputFolder::open(&folder.0, &plan).unwrap();
        first.frames().unwrap();
        for name in ["report.json", "old.svg", "frames/a_0000.vtu"] {
            fs::write(first.claim(name).unwrap(), "x").unwrap();
        }
        folder.write("notes.txt");
        drop(first);
        let mut second = OutputFolder::open(&folder.0, &plan).unwrap();
        fs::write(second.claim("report.json").unwrap(), "y").unwrap();
        assert_eq!(second.replaced(), 3);
        assert_eq!(folder.names(), [MANIFEST, "notes.txt", "report.json"]);
        drop(second);
        fs::write(folder.0.join(MANIFEST), format!("{HEADER}\n../outside\n")).unwrap();
        let refused = OutputFolder::open(&folder.0, &plan);
        assert!(matches!(refused, Err(OutputError::List { line: 2, .. })));
    }

    /// A file of somebody else that would be written over stops the run, and nothing is removed.
    #[test]
    fn foreign_files_are_not_touched() {
        let folder = Temporary::new("foreign");
        let mut first = OutputFolder::open(&folder.0, &Plan { writes: &|_| false, keeps: None }).unwrap();
        fs::write(first.claim("probes.csv").unwrap(), "x").unwrap();
        folder.write("report.json");
        drop(first);
        let plan = Plan { writes: &|name| name != MANIFEST, keeps: None };
        assert!(matches!(OutputFolder::open(&folder.0, &plan), Err(OutputError::Foreign { .. })));
        assert_eq!(folder.names(), [MANIFEST, "probes.csv", "report.json"]);
        folder.write(MANIFEST);
        assert!(matches!(OutputFolder::open(&folder.0, &ANY), Err(OutputError::ForeignList { .. })));
    }

    /// A resumed run keeps what it goes on from, and does not take the place of other results.
    #[test]
    fn resumed_runs_lose_nothing() {
        let folder = Temporary::new("resumed");
        let plan = Plan { writes: &|name| name != MANIFEST, keeps: None };
        let mut first = OutputFolder::open(&folder.0, &plan).unwrap();
        fs::write(first.claim("snapshot_1.souple").unwrap(), "x").unwrap();
        drop(first);
        let keeps = |name: &str| name.starts_with("snapshot");
        let resumed = Plan { keeps: Some(&keeps), ..plan };
        let mut second = OutputFolder::open(&folder.0, &resumed).unwrap();
        assert_eq!(folder.names(), [MANIFEST, "snapshot_1.souple"]);
        fs::write(second.claim("report.json").unwrap(), "x").unwrap();
        drop(second);
        assert!(matches!(OutputFolder::open(&folder.0, &resumed), Err(OutputError::WouldLoseResults { .. })));
        assert_eq!(folder.names(), [MANIFEST, "report.json", "snapshot_1.souple"]);
    }

    /// Two runs do not share a folder; when the first is over, however it ended, the next one has it.
    #[test]
    #[cfg(unix)]
    fn a_folder_has_one_run_at_a_time() {
        let folder = Temporary::new("locked");
        let mut first = OutputFolder::open(&folder.0, &ANY).unwrap();
        fs::write(first.claim("report.json").unwrap(), "x").unwrap();
        assert!(matches!(OutputFolder::open(&folder.0, &ANY), Err(OutputError::InUse { .. })));
        assert_eq!(folder.names(), [MANIFEST, "report.json"]);
        drop(first);
        let plan = Plan { writes: &|name| name != MANIFEST, keeps: None };
        assert_eq!(OutputFolder::open(&folder.0, &plan).unwrap().replaced(), 1);
    }
}
