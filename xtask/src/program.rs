//! The released program: building it, asking it, its validation cases.

use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

use crate::capabilities;
use crate::failure::Failure;
use crate::tree::{Tree, answer, run, typed};

pub const REMEDY: &str = "build it first: `cargo xtask test build`";

pub fn build(tree: &Tree) -> Result<(), Failure> {
    run(
        &mut tree.cargo(&["build", "--release", "--package", "souple", "--locked"]),
        "install Rust with rustup",
    )
}

/// The folder of the released program.
pub fn folder(tree: &Tree) -> PathBuf {
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| PathBuf::from("target"), PathBuf::from);
    tree.root.join(target).join("release")
}

pub fn souple(tree: &Tree, arguments: &[&str]) -> Command {
    let mut command =
        Command::new(folder(tree).join(Path::new("souple").with_extension(std::env::consts::EXE_EXTENSION)));
    command.args(arguments).current_dir(&tree.root);
    command
}

/// The validation cases that `docs/capabilities.md` names prove what it says, and claim no more: asked of their
/// list, which costs nothing, so that a wrong claim is told before they run.
pub fn claims(tree: &Tree) -> Result<(), Failure> {
    let capabilities = tree.read(capabilities::FILE)?;
    rows(tree, &["verify", "--list", "--json"], |rows| capabilities::unproven(&capabilities, rows))
}

/// Runs all validation cases: every row passes.
pub fn verify(tree: &Tree) -> Result<(), Failure> {
    rows(tree, &["verify", "--json"], |rows| rows.iter().filter_map(row_fault).collect())
}

/// Runs all validation cases with the fault that each must find.
pub fn mutations(tree: &Tree) -> Result<(), Failure> {
    rows(tree, &["verify", "--mutations", "--json"], |rows| rows.iter().filter_map(blindness).collect())
}

/// Benches whose baselines are promises: about laws and elements, networks, levels and tools, what is shown 25 times a second, and which of two ways
/// is the cheaper.
const SPEED: [&str; 24] = [
    "law_text_tensor",
    "law_text_table",
    "law_text_reworded",
    "law_text_scalar",
    "law_ready",
    "tet4_forces",
    "hex8_forces",
    "prism6_forces",
    "pyramid5_forces",
    "tangents",
    "formal",
    "accuracy",
    "explicit_or_implicit",
    "adaptive",
    "contours_500",
    "view_network",
    "springs_lattice_100k",
    "springs_lattice_1m",
    "string_audio",
    "balls_100k",
    "balls_1m_peak",
    "adaptive_saving",
    "octree_rod",
    "tool_detection_10k",
];

/// Every figure of these benches is as good as its baseline.
pub fn speed(tree: &Tree) -> Result<(), Failure> {
    run(souple(tree, &["bench", "--hold"]).args(SPEED), REMEDY)
}

/// Runs cases and asks for the faults of their rows.
fn rows(
    tree: &Tree,
    arguments: &[&str],
    faults: impl FnOnce(&[Value]) -> Vec<String>,
) -> Result<(), Failure> {
    let mut command = souple(tree, arguments);
    let (status, text) = answer(&mut command, REMEDY)?;
    let fail = |what: String| Failure::Answer { command: typed(&command), what };
    let rows: Value = serde_json::from_str(&text).map_err(|error| fail(error.to_string()))?;
    let rows = rows.as_array().ok_or_else(|| fail("no list of rows".to_owned()))?;
    Failure::unless_empty(faults(rows))?;
    if !status.success() {
        return Err(Failure::Command { command: typed(&command), status });
    }
    println!("{} rows", rows.len());
    Ok(())
}

fn field(row: &Value, name: &str) -> String {
    match &row[name] {
        Value::String(text) => text.clone(),
        other => other.to_string(),
    }
}

/// A row that did not pass, in words.
fn row_fault(row: &Value) -> Option<String> {
    if row["pass"] == Value::Bool(true) {
        return None;
    }
    let field = |name| field(row, name);
    let id = field("id");
    if row["problem"].is_string() {
        return Some(format!("{id} failed: {}: {}", field("what"), field("problem")));
    }
    let wanted = match row["wanted"].as_str() {
        None | Some("near") => {
            format!("the reference is {} within {}", field("reference"), field("tolerance"))
        }
        Some(relation) => format!("{relation} {} is wanted", field("reference")),
    };
    let (what, measured, unit) = (field("what"), field("measured"), field("unit"));
    Some(format!("{id} failed: {what}: {measured} {unit} was measured, {wanted}"))
}

/// A row that its mutation does not make fail, in words.
fn blindness(row: &Value) -> Option<String> {
    let field = |name| field(row, name);
    let (id, mutation) = (field("id"), field("mutation"));
    if row["problem"].is_string() && row["has_run"] != Value::Bool(true) {
        Some(format!("{id} has no number under its mutation {mutation}: {}", field("problem")))
    } else if row["pass"] == Value::Bool(true) {
        Some(format!("{id} still holds under its mutation {mutation}: {} was measured", field("measured")))
    } else {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failed_row_is_told_in_words() {
        let mut row = serde_json::json!({
            "id": "bar_tip", "what": "tip of the bar", "measured": 1.5, "unit": "m", "reference": 1.0,
            "tolerance": 0.1, "pass": false,
        });
        let text = "bar_tip failed: tip of the bar: 1.5 m was measured, the reference is 1.0 within 0.1";
        assert_eq!(row_fault(&row).as_deref(), Some(text));
        row["wanted"] = "at most".into();
        let text = "bar_tip failed: tip of the bar: 1.5 m was measured, at most 1.0 is wanted";
        assert_eq!(row_fault(&row).as_deref(), Some(text));
        row["problem"] = "no such probe".into();
        assert_eq!(row_fault(&row).as_deref(), Some("bar_tip failed: tip of the bar: no such probe"));
        row["pass"] = Value::Bool(true);
        assert_eq!(row_fault(&row), None);
    }

    #[test]
    fn a_mutation_must_be_seen() {
        let mut row = serde_json::json!({"id": "bar_tip", "measured": 1.5, "mutation": "x=2", "pass": false});
        assert_eq!(blindness(&row), None);
        row["pass"] = Value::Bool(true);
        let holds = "bar_tip still holds under its mutation x=2: 1.5 was measured";
        assert_eq!(blindness(&row).as_deref(), Some(holds));
        row["pass"] = Value::Bool(false);
        row["problem"] = "no such key".into();
        let broken = "bar_tip has no number under its mutation x=2: no such key";
        assert_eq!(blindness(&row).as_deref(), Some(broken));
        row["has_run"] = Value::Bool(true);
        row["problem"] = "blew up".into();
        assert_eq!(blindness(&row), None);
    }
}
