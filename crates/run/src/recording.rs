//! A run that can be had again: its scene, its commands, its hashes.

use std::path::Path;

use serde_json::{Value, json};
use souple_engine::{Command, Edit, World};
use souple_io::IoError;
use souple_math::Vec3;

use crate::Options;

/// What is needed to repeat a run bit for bit, and to see whether it was.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Recording {
    /// The scene file as it was named.
    pub scene: String,
    pub scene_sha256: String,
    /// `path=value` given on the command line.
    pub settings: Vec<String>,
    pub seed: u64,
    /// Periods stepped.
    pub steps: u64,
    pub commands: Vec<Command>,
    /// `(period, hash)`
    pub hashes: Vec<(u64, String)>,
}

/// A file that is no recording.
#[derive(Debug, thiserror::Error)]
pub enum RecordingError {
    #[error("`{path}` cannot be read: {source}")]
    Unreadable { path: String, source: std::io::Error },
    #[error("`{path}` is no recording: {problem}")]
    Malformed { path: String, problem: String },
}

/// Where a repetition departs from its recording.
#[derive(Clone, Debug, PartialEq)]
pub struct Divergence {
    pub period: u64,
    pub recorded: String,
    /// `None`: the repetition has no state of that period.
    pub replayed: Option<String>,
}

impl Recording {
    pub(crate) fn new(options: &Options, scene_sha256: &str, seed: u64) -> Self {
        Self {
            scene: options.scene_name.clone(),
            scene_sha256: scene_sha256.to_owned(),
            seed: options.seed.unwrap_or(seed),
            ..Self::default()
        }
    }

    pub(crate) fn push_hash(&mut self, world: &World) {
        let period = world.state().period;
        if self.hashes.last().is_none_or(|(last, _)| *last != period) {
            self.hashes.push((period, world.state().hash()));
        }
    }

    pub(crate) fn finish(&mut self, world: &World) {
        self.steps = world.state().period - self.hashes.first().map_or(0, |first| first.0);
        self.commands = world.log().to_vec();
    }

    /// The first hash that differs from that of a repetition, or that the repetition does not have.
    pub fn first_divergence(&self, replayed: &Self) -> Option<Divergence> {
        self.hashes.iter().find_map(|(period, recorded)| {
            let other = replayed.hashes.iter().find(|(other, _)| other == period).map(|(_, hash)| hash);
            (other != Some(recorded)).then(|| Divergence {
                period: *period,
                recorded: recorded.clone(),
                replayed: other.cloned(),
            })
        })
    }

    /// # Errors
    /// The file cannot be written.
    pub fn write(&self, path: &Path) -> Result<(), IoError> {
        let hashes: Vec<Value> =
            self.hashes.iter().map(|(step, hash)| json!({"step": step, "hash": hash})).collect();
        let document = json!({
            "souple_recording": 1,
            "scene": self.scene,
            "scene_sha256": self.scene_sha256,
            "settings": self.settings,
            "seed": self.seed,
            "steps": self.steps,
            "commands": self.commands.iter().map(command_to_json).collect::<Vec<_>>(),
            "hashes": hashes,
        });
        souple_io::write_file(path, |out| writeln!(out, "{document:#}"))
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
        if document["souple_recording"] != 1 {
            return Err("it does not say `\"souple_recording\": 1`".to_owned());
        }
        let string = |key: &str| {
            let value = document[key].as_str().map(str::to_owned);
            value.ok_or_else(|| format!("`{key}` is missing or not a text"))
        };
        let list =
            |key: &str| document[key].as_array().ok_or_else(|| format!("`{key}` is missing or not a list"));
        let number =
            |key: &str| document[key].as_u64().ok_or_else(|| format!("`{key}` is missing or not a count"));
        let settings = list("settings")?.iter().map(|value| value.as_str().map(str::to_owned));
        if list("hashes")?.is_empty() {
            return Err("`hashes` is empty: nothing could be compared".to_owned());
        }
        let hash = |entry: &Value| Some((entry["step"].as_u64()?, entry["hash"].as_str()?.to_owned()));
        Ok(Self {
            scene: string("scene")?,
            scene_sha256: string("scene_sha256")?,
            settings: settings
                .collect::<Option<_>>()
                .ok_or("`settings` holds something that is not a text")?,
            seed: number("seed")?,
            steps: number("steps")?,
            commands: list("commands")?.iter().map(command_from_json).collect::<Result<_, _>>()?,
            hashes: list("hashes")?
                .iter()
                .map(hash)
                .collect::<Option<_>>()
                .ok_or("`hashes` holds a wrong entry")?,
        })
    }
}

/// A command as it stands in a recording.
pub fn command_to_json(command: &Command) -> Value {
    let edit = match &command.edit {
        Edit::SetParameter { system, force, parameter, value } => {
            json!({"kind": "set_parameter", "system": system, "force": force, "parameter": parameter, "value": value})
        }
        Edit::Pin { system, block } => json!({"kind": "pin", "system": system, "block": block}),
        Edit::Unpin { system, block } => json!({"kind": "unpin", "system": system, "block": block}),
        Edit::SetVelocity { system, block, velocity } => {
            json!({"kind": "set_velocity", "system": system, "block": block, "velocity": velocity.to_array()})
        }
    };
    json!({"period": command.period, "edit": edit})
}

/// # Errors
/// Says what is missing or of the wrong kind.
pub fn command_from_json(value: &Value) -> Result<Command, String> {
    let edit = &value["edit"];
    let count = |value: &Value, key: &str| {
        value[key].as_u64().ok_or_else(|| format!("a command has no count `{key}`"))
    };
    let text = |key: &str| {
        edit[key].as_str().map(str::to_owned).ok_or_else(|| format!("a command has no text `{key}`"))
    };
    let system = count(edit, "system")? as usize;
    let block =
        || count(edit, "block").and_then(|block| u32::try_from(block).map_err(|error| error.to_string()));
    let edit = match edit["kind"].as_str() {
        Some("set_parameter") => Edit::SetParameter {
            system,
            force: text("force")?,
            parameter: text("parameter")?,
            value: edit["value"].as_f64().ok_or("a command has no number `value`")?,
        },
        Some("pin") => Edit::Pin { system, block: block()? },
        Some("unpin") => Edit::Unpin { system, block: block()? },
        Some("set_velocity") => {
            let number = |i: usize| edit["velocity"][i].as_f64().ok_or("a velocity is three numbers");
            let velocity = Vec3::new(number(0)?, number(1)?, number(2)?);
            Edit::SetVelocity { system, block: block()?, velocity }
        }
        other => return Err(format!("there is no command of kind {other:?}")),
    };
    Ok(Command { period: count(value, "period")?, edit })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commands_survive_their_text() {
        let edits = [
            Edit::SetParameter { system: 1, force: "a".into(), parameter: "k".into(), value: 0.1 },
            Edit::Pin { system: 0, block: 7 },
            Edit::Unpin { system: 0, block: 7 },
            Edit::SetVelocity { system: 0, block: 2, velocity: Vec3::new(0.1, -2.0, 3e-7) },
        ];
        for edit in edits {
            let command = Command { period: 12, edit };
            assert_eq!(command_from_json(&command_to_json(&command)), Ok(command));
        }
        assert!(command_from_json(&json!({"period": 1, "edit": {"kind": "fly", "system": 0}})).is_err());
    }
}
