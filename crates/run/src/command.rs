//! Commands as text, in recordings and snapshots.

use serde_json::{Value, json};
use souple_engine::{Command, Edit, Grip, Held, HeldTool, Tool};
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
        Edit::Push { system, blocks, velocity } => json!({
            "kind": "push", "system": system, "first": blocks.start, "end": blocks.end,
            "velocity": velocity.to_array(),
        }),
        Edit::Grab { system, hand, grip } => {
            let held = |held: &Held| json!([held.row, held.share, held.offset.to_array()]);
            let Grip { points, place, stiffness, damping } = grip;
            json!({
                "kind": "grab", "system": system, "hand": hand, "place": place.to_array(),
                "stiffness": stiffness, "damping": damping, "points": points.iter().map(held).collect::<Vec<_>>(),
            })
        }
        Edit::Touch { system, hand, tool } => {
            let Tool { shape, values, place, stiffness, rows, spans, held } = tool;
            json!({
                "kind": "touch", "system": system, "hand": hand, "shape": shape, "values": values,
                "place": place.to_array(), "stiffness": stiffness, "rows": rows,
                "spans": spans_to_json(spans), "held": held.as_ref().map(held_tool_to_json),
            })
        }
        Edit::MoveHand { system, hand, place } => {
            json!({"kind": "move_hand", "system": system, "hand": hand, "place": place.to_array()})
        }
        Edit::Lead { system, force, place } => {
            json!({"kind": "lead", "system": system, "force": force, "place": place.to_array()})
        }
        Edit::Release { system, hand } => json!({"kind": "release", "system": system, "hand": hand}),
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
    let index = |key: &str| {
        count(edit, key).and_then(|index| u32::try_from(index).map_err(|error| error.to_string()))
    };
    let block = || index("block");
    let vector = |key: &str| vector_of(&edit[key], key);
    let number = |key: &str| edit[key].as_f64().ok_or_else(|| format!("a command has no number `{key}`"));
    let edit = match edit["kind"].as_str() {
        Some("set_parameter") => Edit::SetParameter {
            system,
            force: text("force")?,
            parameter: text("parameter")?,
            value: number("value")?,
        },
        Some("pin") => Edit::Pin { system, block: block()? },
        Some("unpin") => Edit::Unpin { system, block: block()? },
        Some("pin_at") => Edit::PinAt { system, block: block()?, position: vector("position")? },
        Some("set_velocity") => Edit::SetVelocity { system, block: block()?, velocity: vector("velocity")? },
        Some("push") => {
            Edit::Push { system, blocks: index("first")?..index("end")?, velocity: vector("velocity")? }
        }
        Some("grab") => {
            let points = edit["points"].as_array().ok_or("a command has no list `points`")?;
            let points = points.iter().map(held_from_json).collect::<Result<_, String>>()?;
            let (stiffness, damping) = (number("stiffness")?, number("damping")?);
            let grip = Grip { points, place: vector("place")?, stiffness, damping };
            Edit::Grab { system, hand: index("hand")?, grip }
        }
        Some("touch") => {
            let rows = edit["rows"].as_array().ok_or("a command has no list `rows`")?;
            let row = |row: &Value| row.as_u64().and_then(|row| u32::try_from(row).ok());
            let rows: Option<Vec<u32>> = rows.iter().map(row).collect();
            let values = edit["values"].as_array().ok_or("a command has no list `values`")?;
            let tool = Tool {
                shape: text("shape")?,
                values: values.iter().map(tool_value_from_json).collect::<Result<_, String>>()?,
                place: vector("place")?,
                stiffness: number("stiffness")?,
                rows: rows.ok_or("`rows` of a command holds something that is not a row")?,
                spans: spans_from_json(&edit["spans"])?,
                held: if edit["held"].is_null() { None } else { Some(held_tool_from_json(&edit["held"])?) },
            };
            Edit::Touch { system, hand: index("hand")?, tool }
        }
        Some("move_hand") => Edit::MoveHand { system, hand: index("hand")?, place: vector("place")? },
        Some("lead") => Edit::Lead { system, force: text("force")?, place: vector("place")? },
        Some("release") => Edit::Release { system, hand: index("hand")? },
        other => return Err(format!("there is no command of kind {other:?}")),
    };
    Ok(Command { period: count(value, "period")?, edit })
}

fn vector_of(value: &Value, key: &str) -> Result<Vec3, String> {
    let number =
        |i: usize| value[i].as_f64().ok_or_else(|| format!("`{key}` of a command is not three numbers"));
    Ok(Vec3::new(number(0)?, number(1)?, number(2)?))
}

fn held_tool_to_json(held: &HeldTool) -> Value {
    let HeldTool { places, triangles, spans, friction, mass, spring, damper, limit } = held;
    json!({
        "places": places.iter().map(|place| place.to_array()).collect::<Vec<_>>(), "triangles": triangles,
        "spans": spans_to_json(spans), "friction": friction, "mass": mass, "spring": spring, "damper": damper, "limit": limit,
    })
}

fn held_tool_from_json(value: &Value) -> Result<HeldTool, String> {
    let list = |key: &str| value[key].as_array().ok_or_else(|| format!("a held tool has no list `{key}`"));
    let number = |key: &str| value[key].as_f64().ok_or_else(|| format!("a held tool has no number `{key}`"));
    let corner = |corner: &Value| corner.as_u64().and_then(|corner| u32::try_from(corner).ok());
    let triangle =
        |triangle: &Value| Some([corner(&triangle[0])?, corner(&triangle[1])?, corner(&triangle[2])?]);
    let triangles: Option<Vec<[u32; 3]>> = list("triangles")?.iter().map(triangle).collect();
    Ok(HeldTool {
        places: list("places")?.iter().map(|place| vector_of(place, "places")).collect::<Result<_, _>>()?,
        triangles: triangles.ok_or("`triangles` of a held tool holds something that is not three corners")?,
        spans: spans_from_json(&value["spans"])?,
        friction: number("friction")?,
        mass: number("mass")?,
        spring: number("spring")?,
        damper: number("damper")?,
        limit: number("limit")?,
    })
}

/// `[from, until]` of each, null where it is there from ever or for ever.
fn spans_to_json(spans: &[[f64; 2]]) -> Value {
    let date = |date: f64| if date.is_finite() { json!(date) } else { Value::Null };
    spans.iter().map(|[from, until]| json!([date(*from), date(*until)])).collect()
}

/// # Errors
/// Something is no pair of dates. A recording of before surfaces opened has none.
fn spans_from_json(value: &Value) -> Result<Vec<[f64; 2]>, String> {
    let Some(spans) = value.as_array() else {
        return if value.is_null() { Ok(Vec::new()) } else { Err("`spans` of a tool is no list".to_owned()) };
    };
    let date = |date: &Value, open: f64| if date.is_null() { Some(open) } else { date.as_f64() };
    let span = |span: &Value| match span.as_array()?.as_slice() {
        [from, until] => Some([date(from, f64::NEG_INFINITY)?, date(until, f64::INFINITY)?]),
        _ => None,
    };
    let spans: Option<Vec<[f64; 2]>> = spans.iter().map(span).collect();
    spans.ok_or_else(|| "`spans` of a tool holds something that is not two dates".to_owned())
}

/// `[row, share, offset]`.
fn held_from_json(value: &Value) -> Result<Held, String> {
    let wrong = || "a point of a command is not `[row, share, offset]`".to_owned();
    let row = value[0].as_u64().and_then(|row| u32::try_from(row).ok()).ok_or_else(wrong)?;
    let share = value[1].as_f64().ok_or_else(wrong)?;
    Ok(Held { row, share, offset: vector_of(&value[2], "offset")? })
}

/// `[name, numbers]`.
fn tool_value_from_json(value: &Value) -> Result<(String, Vec<f64>), String> {
    let wrong = || "a value of a tool is not `[name, numbers]`".to_owned();
    let name = value[0].as_str().ok_or_else(wrong)?;
    let numbers = value[1].as_array().ok_or_else(wrong)?.iter().map(Value::as_f64);
    Ok((name.to_owned(), numbers.collect::<Option<_>>().ok_or_else(wrong)?))
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
            Edit::Grab {
                system: 0,
                hand: 3,
                grip: Grip::on(
                    &[4, 1],
                    &[Vec3::X, Vec3::new(0.1, 0.7, -1.0 / 3.0), Vec3::Y, Vec3::Z, Vec3::Y],
                    0.3,
                    1e-3,
                ),
            },
            Edit::Touch {
                system: 1,
                hand: 0,
                tool: Tool {
                    shape: "capsule".into(),
                    values: vec![("radius".into(), vec![0.1]), ("to".into(), vec![0.0, 1.0 / 3.0, -5e-324])],
                    place: Vec3::new(0.1, 0.7, -1.0 / 3.0),
                    stiffness: 1e3 / 7.0,
                    rows: vec![0, 7, 3],
                    spans: Vec::new(),
                    held: None,
                },
            },
            Edit::Touch {
                system: 0,
                hand: 1,
                tool: Tool {
                    shape: "sphere".into(),
                    values: vec![("radius".into(), vec![0.1])],
                    place: Vec3::X,
                    stiffness: 1e3 / 7.0,
                    rows: vec![0, 7, 3],
                    spans: vec![[f64::NEG_INFINITY, f64::INFINITY], [0.1 / 3.0, f64::INFINITY], [0.0, 0.7]],
                    held: Some(HeldTool {
                        places: vec![Vec3::ZERO, Vec3::X * (1.0 / 3.0), Vec3::Y],
                        triangles: vec![[0, 1, 2]],
                        spans: vec![[f64::NEG_INFINITY, 0.7]],
                        friction: 0.3,
                        mass: 0.1 / 3.0,
                        spring: 270.0,
                        damper: 5.4,
                        limit: 13.7,
                    }),
                },
            },
            Edit::Push { system: 0, blocks: 2..7, velocity: Vec3::new(0.1, -2.0, 3e-7) },
            Edit::MoveHand { system: 0, hand: 3, place: Vec3::new(0.1, -2.0, 3e-7) },
            Edit::Lead { system: 0, force: "hands.right".into(), place: Vec3::new(0.1, -2.0, 3e-7) },
            Edit::Release { system: 0, hand: 3 },
        ];
        for edit in edits {
            let command = Command { period: 12, edit };
            assert_eq!(command_from_json(&command_to_json(&command)), Ok(command));
        }
        assert!(command_from_json(&json!({"period": 1, "edit": {"kind": "fly", "system": 0}})).is_err());
    }
}
