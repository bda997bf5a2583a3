//! A run that can be had again, anywhere: its scene with all texts, its commands, its hashes.
//!
//! Texts are in the recording itself; meshes and surfaces, which may be large, are named with their SHA-256 and with
//! where they were, from the recording and from the root of the disk.

use std::collections::BTreeMap;
use std::path::{Component, Path, PathBuf};

use serde_json::{Value, json};
use souple_engine::{Command, Fingerprint, World};
use souple_io::IoError;
use souple_scene::inputs::{InputFile, InputText, Inputs, sha256};

use crate::command::{command_from_json, command_to_json};
use crate::machine::{binary, instruction_set};
use crate::session::Change;

/// What is needed to repeat a run bit for bit, and to see whether it was.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Recording {
    /// The scene file as it was named.
    pub scene: String,
    pub scene_sha256: String,
    /// All that the scene was read from.
    pub inputs: Inputs,
    /// The program and its version.
    pub binary: String,
    /// The instructions it used.
    pub isa: String,
    pub seed: u64,
    /// Periods stepped.
    pub steps: u64,
    pub commands: Vec<Command>,
    /// Values of the scene set along the way.
    pub changes: Vec<Change>,
    pub hashes: Vec<Hashed>,
    /// Where each of the files in `inputs` was, when it was recorded: several ways to name the same place.
    places: Vec<Vec<PathBuf>>,
}

/// The hash of a state.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Hashed {
    pub period: u64,
    pub fingerprint: Fingerprint,
}

/// Adds the hash of a world's state, unless there is one of its period.
pub(crate) fn add_hash(hashes: &mut Vec<Hashed>, world: &World) {
    let period = world.state().period;
    if hashes.last().is_none_or(|last| last.period != period) {
        hashes.push(Hashed { period, fingerprint: world.state().fingerprint() });
    }
}

/// A recording that cannot be played.
#[derive(Debug, thiserror::Error)]
pub enum RecordingError {
    #[error("`{path}` cannot be read: {source}")]
    Unreadable { path: String, source: std::io::Error },
    #[error("`{path}` is no recording: {problem}")]
    Malformed { path: String, problem: String },
    #[error(
        "the file `{file}` has changed since the recording was made: SHA-256 {found}, recorded {recorded}; bring back the file as it was, or record the run anew"
    )]
    FileChanged { file: String, found: String, recorded: String },
    #[error("the file `{file}` of the recorded scene is not there; looked for {}", .looked.join(" and "))]
    FileMissing { file: String, looked: Vec<String> },
}

/// Where a repetition departs from its recording.
#[derive(Clone, Debug, PartialEq)]
pub struct Divergence {
    pub period: u64,
    pub recorded: String,
    /// `None`: the repetition has no state of that period.
    pub replayed: Option<String>,
    /// Fields that differ, in declared order.
    pub fields: Vec<String>,
}

impl Recording {
    pub(crate) fn new(scene: &str, scene_sha256: &str, inputs: Inputs, seed: u64) -> Self {
        Self {
            scene: scene.to_owned(),
            scene_sha256: scene_sha256.to_owned(),
            inputs,
            binary: binary(),
            isa: instruction_set().to_owned(),
            seed,
            ..Self::default()
        }
    }

    pub(crate) fn push_hash(&mut self, world: &World) {
        add_hash(&mut self.hashes, world);
    }

    pub(crate) fn finish(&mut self, world: &World) {
        self.steps = world.state().period - self.hashes.first().map_or(0, |first| first.period);
        self.commands = world.log().to_vec();
    }

    /// The first hash that differs from that of a repetition, or that the repetition does not have.
    pub fn first_divergence(&self, replayed: &Self) -> Option<Divergence> {
        self.hashes.iter().find_map(|Hashed { period, fingerprint: recorded }| {
            let other = replayed.hashes.iter().find(|other| other.period == *period);
            let other = other.map(|other| &other.fingerprint);
            let field = |(name, hash): &(String, String)| {
                let same = other?.fields.iter().any(|(other, value)| other == name && value == hash);
                (!same).then(|| name.clone())
            };
            (other.map(|other| &other.hash) != Some(&recorded.hash)).then(|| Divergence {
                period: *period,
                recorded: recorded.hash.clone(),
                replayed: other.map(|other| other.hash.clone()),
                fields: recorded.fields.iter().filter_map(field).collect(),
            })
        })
    }

    /// Why bits may differ here from those recorded; `None` on the same program and instructions.
    pub fn other_machine(&self) -> Option<String> {
        let (binary, isa) = (binary(), instruction_set());
        (self.binary != binary || self.isa != isa).then(|| {
            format!(
                "recorded by {} on {}, this is {binary} on {isa}: equal bits are promised for one program on one instruction set",
                self.binary, self.isa
            )
        })
    }

    /// Where the files of the scene are now, for a recording at `path`: beside it as they were, or where they were.
    ///
    /// # Errors
    /// A file is missing or has changed.
    pub fn locate_files(&self, path: &Path) -> Result<BTreeMap<PathBuf, PathBuf>, RecordingError> {
        let folder = path.parent().unwrap_or(Path::new(""));
        let mut found = BTreeMap::new();
        for (file, places) in self.inputs.files.iter().zip(&self.places) {
            let candidates: Vec<PathBuf> = places.iter().map(|place| folder.join(place)).collect();
            let mut changed = None;
            let place = candidates.iter().find(|place| {
                let hash = std::fs::read(place).ok().map(|bytes| sha256(&bytes));
                let same = hash.as_ref() == Some(&file.sha256);
                changed = changed.take().or(hash.filter(|_| !same));
                same
            });
            let name = file.path.display().to_string();
            match (place, changed) {
                (Some(place), _) => {
                    found.insert(file.path.clone(), place.clone());
                }
                (None, Some(found)) => {
                    let recorded = file.sha256.clone();
                    return Err(RecordingError::FileChanged { file: name, found, recorded });
                }
                (None, None) => {
                    let looked = candidates.iter().map(|place| format!("`{}`", place.display())).collect();
                    return Err(RecordingError::FileMissing { file: name, looked });
                }
            }
        }
        Ok(found)
    }

    /// # Errors
    /// The file cannot be written.
    pub fn write(&self, path: &Path) -> Result<(), IoError> {
        let document = self.to_json(path.parent().unwrap_or(Path::new("")));
        souple_io::write_file(path, |out| writeln!(out, "{document:#}"))
    }

    /// The recording as it stands in a file of a folder.
    pub fn to_json(&self, folder: &Path) -> Value {
        let hashes: Vec<Value> = self.hashes.iter().map(hashed_to_json).collect();
        let text = |text: &InputText| json!({"name": text.name, "folder": text.folder, "text": text.text});
        let file = |file: &InputFile| json!({"path": file.path, "sha256": file.sha256, "places": places_of(&file.path, folder)});
        json!({
            "souple_recording": VERSION,
            "scene": self.scene,
            "scene_sha256": self.scene_sha256,
            "binary": self.binary,
            "isa": self.isa,
            "seed": self.seed,
            "steps": self.steps,
            "settings": self.inputs.settings,
            "texts": self.inputs.texts.iter().map(text).collect::<Vec<_>>(),
            "files": self.inputs.files.iter().map(file).collect::<Vec<_>>(),
            "commands": self.commands.iter().map(command_to_json).collect::<Vec<_>>(),
            "changes": self.changes.iter().map(change_to_json).collect::<Vec<_>>(),
            "hashes": hashes,
        })
    }

    /// # Errors
    /// The file cannot be read or is no recording.
    pub fn read(path: &Path) -> Result<Self, RecordingError> {
        let name = path.display().to_string();
        let text = std::fs::read_to_string(path)
            .map_err(|source| RecordingError::Unreadable { path: name.clone(), source })?;
        Self::parse(&text).map_err(|problem| RecordingError::Malformed { path: name, problem })
    }

    fn parse(text: &str) -> Result<Self, String> {
        let document: Value = serde_json::from_str(text).map_err(|error| error.to_string())?;
        match document["souple_recording"].as_u64() {
            Some(VERSION) => {}
            Some(other) => {
                return Err(format!("it is of version {other}, this program plays version {VERSION}"));
            }
            None => return Err(format!("it does not say `\"souple_recording\": {VERSION}`")),
        }
        let number =
            |key: &str| document[key].as_u64().ok_or_else(|| format!("`{key}` is missing or not a count"));
        if list(&document, "hashes")?.is_empty() {
            return Err("`hashes` is empty: nothing could be compared".to_owned());
        }
        let setting = |value: &Value| value.as_str().map(str::to_owned);
        let text = |entry: &Value| {
            Ok(InputText {
                name: string(entry, "name")?,
                folder: string(entry, "folder")?.into(),
                text: string(entry, "text")?,
            })
        };
        let file = |entry: &Value| {
            Ok(InputFile { path: string(entry, "path")?.into(), sha256: string(entry, "sha256")? })
        };
        let places = |entry: &Value| {
            let place = |place: &Value| place.as_str().map(PathBuf::from);
            let places: Option<Vec<PathBuf>> = list(entry, "places")?.iter().map(place).collect();
            places.ok_or("`places` holds something that is not a text".to_owned())
        };
        let files = list(&document, "files")?;
        let settings: Option<Vec<String>> = list(&document, "settings")?.iter().map(setting).collect();
        let texts: Vec<InputText> =
            list(&document, "texts")?.iter().map(text).collect::<Result<_, String>>()?;
        if texts.is_empty() {
            return Err("`texts` is empty: there is no scene".to_owned());
        }
        Ok(Self {
            scene: string(&document, "scene")?,
            scene_sha256: string(&document, "scene_sha256")?,
            inputs: Inputs {
                texts,
                files: files.iter().map(file).collect::<Result<_, String>>()?,
                settings: settings.ok_or("`settings` holds something that is not a text")?,
            },
            binary: string(&document, "binary")?,
            isa: string(&document, "isa")?,
            seed: number("seed")?,
            steps: number("steps")?,
            commands: list(&document, "commands")?.iter().map(command_from_json).collect::<Result<_, _>>()?,
            changes: list(&document, "changes")?.iter().map(change_from_json).collect::<Result<_, _>>()?,
            hashes: list(&document, "hashes")?
                .iter()
                .map(hashed_from_json)
                .collect::<Option<_>>()
                .ok_or("`hashes` holds a wrong entry")?,
            places: files.iter().map(places).collect::<Result<_, String>>()?,
        })
    }
}

/// Version of the layout; the first had no texts, the second no changes.
const VERSION: u64 = 3;

fn string(entry: &Value, key: &str) -> Result<String, String> {
    let value = entry[key].as_str().map(str::to_owned);
    value.ok_or_else(|| format!("`{key}` is missing or not a text"))
}

fn list<'a>(entry: &'a Value, key: &str) -> Result<&'a Vec<Value>, String> {
    entry[key].as_array().ok_or_else(|| format!("`{key}` is missing or not a list"))
}

fn change_to_json(change: &Change) -> Value {
    json!({"period": change.period, "setting": change.setting})
}

fn change_from_json(entry: &Value) -> Result<Change, String> {
    let period = entry["period"].as_u64().ok_or("a change has no count `period`")?;
    Ok(Change { period, setting: string(entry, "setting")? })
}

fn hashed_to_json(hashed: &Hashed) -> Value {
    let fields = hashed.fingerprint.fields.iter().map(|(name, hash)| (name.clone(), json!(hash)));
    let fields: serde_json::Map<String, Value> = fields.collect();
    json!({"step": hashed.period, "hash": hashed.fingerprint.hash, "fields": fields})
}

fn hashed_from_json(entry: &Value) -> Option<Hashed> {
    let field = |(name, hash): (&String, &Value)| Some((name.clone(), hash.as_str()?.to_owned()));
    let fields: Option<Vec<_>> = entry["fields"].as_object()?.iter().map(field).collect();
    let fingerprint = Fingerprint { hash: entry["hash"].as_str()?.to_owned(), fields: fields? };
    Some(Hashed { period: entry["step"].as_u64()?, fingerprint })
}

/// The place of a file from the folder of a recording, and from the root.
fn places_of(path: &Path, folder: &Path) -> Vec<PathBuf> {
    let absolute = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let from_folder = match (path.canonicalize(), folder.canonicalize()) {
        (Ok(path), Ok(folder)) => Some(relative(&path, &folder)),
        _ => None,
    };
    from_folder.into_iter().chain([absolute]).collect()
}

/// `path` as seen from `folder`, both absolute and without links.
fn relative(path: &Path, folder: &Path) -> PathBuf {
    let shared = path.components().zip(folder.components()).take_while(|(a, b)| a == b).count();
    let up = folder.components().skip(shared).map(|_| Component::ParentDir);
    up.chain(path.components().skip(shared)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_seen_from_a_folder() {
        let seen = |path: &str, folder: &str| relative(Path::new(path), Path::new(folder));
        assert_eq!(seen("/a/b/c.msh", "/a/b"), Path::new("c.msh"));
        assert_eq!(seen("/a/b/c.msh", "/a/d/e"), Path::new("../../b/c.msh"));
    }

    /// The first field that differs is named, and a repetition without the step is a divergence.
    #[test]
    fn divergence_names_fields() {
        let hashed = |period: u64, hash: &str, v: &str| Hashed {
            period,
            fingerprint: Fingerprint {
                hash: hash.to_owned(),
                fields: vec![("q".to_owned(), "1".to_owned()), ("v".to_owned(), v.to_owned())],
            },
        };
        let recording = |hashes: Vec<Hashed>| Recording { hashes, ..Recording::default() };
        let recorded = recording(vec![hashed(0, "a", "2"), hashed(1, "b", "2")]);
        assert_eq!(recorded.first_divergence(&recorded), None);
        let other = recording(vec![hashed(0, "a", "2"), hashed(1, "c", "3")]);
        let divergence = recorded.first_divergence(&other).unwrap();
        assert_eq!((divergence.period, divergence.fields), (1, vec!["v".to_owned()]));
        let short = recording(vec![hashed(0, "a", "2")]);
        assert_eq!(recorded.first_divergence(&short).unwrap().replayed, None);
    }
}
