//! Commands as text, in recordings and snapshots.

use serde_json::{Value, json};
use souple_engine::{Command, Edit};
use souple_math::Vec3;

/// A command as it stands in recordings and snapshots.
pub fn command_to_json(command: &Command) -> Value {
    let edit = match &command.edit {
        Edit::SetParameter { system, force, parameter, value } => {
            json!({"kind": "set_parameter", "system": system, "force": force, "parameter": parameter, "value": value})
        }
        Edit::Pin { system, block } => json!({"kind": "pin", "system": system, "block": block}),
        Edit::PinAt { system, block, position } => {
            json!({"kind": "pin_at", "system": system, "block": block, "position": position.to_array()})
        }
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
    let vector = |key: &str| {
        let number = |i: usize| {
            edit[key][i].as_f64().ok_or_else(|| format!("`{key}` of a command is not three numbers"))
        };
        Ok::<_, String>(Vec3::new(number(0)?, number(1)?, number(2)?))
    };
    let edit = match edit["kind"].as_str() {
        Some("set_parameter") => Edit::SetParameter {
            system,
            force: text("force")?,
            parameter: text("parameter")?,
            value: edit["value"].as_f64().ok_or("a command has no number `value`")?,
        },
        Some("pin") => Edit::Pin { system, block: block()? },
        Some("unpin") => Edit::Unpin { system, block: block()? },
        Some("pin_at") => Edit::PinAt { system, block: block()?, position: vector("position")? },
        Some("set_velocity") => Edit::SetVelocity { system, block: block()?, velocity: vector("velocity")? },
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
            // numbers that a reader rounding twice would not give back
            Edit::PinAt { system: 0, block: 7, position: Vec3::new(1.0 / 3.0, 5e-324, -8.41e21) },
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
