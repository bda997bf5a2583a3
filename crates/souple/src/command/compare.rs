//! `souple compare`: two results field by field.
//!
//! Without a tolerance the differences are told and the status is 0. With one, a field that differs by more, or that
//! only one of the two has, ends with status 1.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};
use souple_engine::State;

use super::{End, Refusal, print_json, print_line, print_note};

#[derive(clap::Args)]
pub struct Arguments {
    /// A snapshot (.souple), or a file with fields (VTU, VTK) or a mesh alone
    a: PathBuf,
    /// Another of the same kind
    b: PathBuf,
    /// Largest relative difference of a field (norm of the difference over norm of the first) that is accepted: beyond
    /// it, or where a field is in one result only, the status is 1; 0 wants equal numbers
    #[arg(long, value_name = "RELATIVE", value_parser = parse_tolerance)]
    tolerance: Option<f64>,
    #[arg(long)]
    pub json: bool,
}

/// A field of a result.
struct Named {
    name: String,
    numbers: Vec<f64>,
}

pub fn compare(arguments: &Arguments) -> Result<End, Refusal> {
    let (a, b) = (read(&arguments.a)?, read(&arguments.b)?);
    let mut rows = Vec::new();
    for field in &a {
        let Some(other) = b.iter().find(|other| other.name == field.name) else {
            rows.push(json!({"field": field.name, "only_in": arguments.a.display().to_string()}));
            continue;
        };
        rows.push(difference(field, other));
    }
    for field in b.iter().filter(|field| !a.iter().any(|other| other.name == field.name)) {
        rows.push(json!({"field": field.name, "only_in": arguments.b.display().to_string()}));
    }
    let mut differing = Vec::new();
    if let Some(tolerance) = arguments.tolerance {
        for row in &mut rows {
            let is_within = row["relative"].as_f64().is_some_and(|relative| relative <= tolerance);
            row["within_tolerance"] = json!(is_within);
            if !is_within {
                differing.push(row["field"].as_str().unwrap_or_default().to_owned());
            }
        }
    }
    let end = if differing.is_empty() { End::Done } else { End::Failed };
    if let (End::Failed, Some(tolerance)) = (&end, arguments.tolerance) {
        let fields = differing.join(", ");
        print_note(format_args!("the results differ by more than {tolerance:e} in {fields}"));
    }
    if arguments.json {
        print_json(&Value::Array(rows));
        return Ok(end);
    }
    for row in &rows {
        let name = row["field"].as_str().unwrap_or_default();
        match row["largest"].as_f64() {
            Some(largest) => print_line(format_args!(
                "{name}: largest difference {largest:e} at {}, rms {:e}, relative {:e}",
                row["at"],
                row["rms"].as_f64().unwrap_or_default(),
                row["relative"].as_f64().unwrap_or_default()
            )),
            None => print_line(format_args!("{name}: {}", why_not_compared(row))),
        }
    }
    Ok(end)
}

/// Why the numbers of a field are not held against each other, in words.
fn why_not_compared(row: &Value) -> String {
    match (row["only_in"].as_str(), row["lengths"].as_array().map(Vec::as_slice)) {
        (Some(only), _) => format!("only in {only}"),
        (None, Some([a, b])) => format!("{a} numbers in the first, {b} in the second"),
        (None, _) => "differences that are not finite".to_owned(),
    }
}

fn parse_tolerance(text: &str) -> Result<f64, String> {
    let number: f64 = text.parse().map_err(|_| "a number such as 1e-9 is wanted".to_owned())?;
    if number >= 0.0 && number.is_finite() { Ok(number) } else { Err("it must be 0 or above".to_owned()) }
}

/// Largest and root-mean-square difference, and the Euclidean norm of it relative to that of the first.
fn difference(a: &Named, b: &Named) -> Value {
    if a.numbers.len() != b.numbers.len() {
        return json!({"field": a.name, "lengths": [a.numbers.len(), b.numbers.len()]});
    }
    let differences: Vec<f64> = a.numbers.iter().zip(&b.numbers).map(|(a, b)| (a - b).abs()).collect();
    let (at, largest) = differences
        .iter()
        .enumerate()
        .fold((0, 0.0), |best, (i, d)| if *d > best.1 || d.is_nan() { (i, *d) } else { best });
    // a sum of nothing is -0
    let norm = |numbers: &[f64]| numbers.iter().fold(0.0, |sum, n| sum + n * n).sqrt();
    let (difference, scale) = (norm(&differences), norm(&a.numbers));
    let count = differences.len().max(1) as f64;
    json!({
        "field": a.name,
        "largest": largest,
        "at": at,
        "rms": difference / count.sqrt(),
        "relative": if scale > 0.0 { difference / scale } else { difference },
    })
}

fn read(path: &Path) -> Result<Vec<Named>, Refusal> {
    let name = path.display().to_string();
    let refuse = |message: String| {
        Refusal::request("result", name.clone(), "a snapshot (.souple) or a file with fields", message)
    };
    if path.extension().is_some_and(|extension| extension == "souple") {
        let bytes =
            std::fs::read(path).map_err(|error| refuse(format!("`{name}` cannot be read: {error}")))?;
        let start = bytes.iter().position(|byte| *byte == b'\n').map_or(0, |end| end + 1);
        let state =
            State::from_bytes(&bytes[start..]).map_err(|error| refuse(format!("`{name}`: {error}")))?;
        let fields = state.fields();
        return Ok(fields
            .iter()
            .map(|(name, field)| Named { name: name.clone(), numbers: field.numbers() })
            .collect());
    }
    let dataset = souple_io::read_dataset(path).map_err(|error| match error {
        souple_io::IoError::Extension { found, expected, .. } => {
            let message = format!("`{name}`: results of the extension `{found}` cannot be compared");
            let expected = format!("a snapshot (.souple), or a mesh with or without fields: {expected}");
            Refusal::request("result", name.clone(), expected, message)
        }
        other => other.into(),
    })?;
    let positions = dataset.mesh.points.iter().flat_map(|point| point.to_array()).collect();
    let mut fields = vec![Named { name: "positions".to_owned(), numbers: positions }];
    fields.extend(
        dataset
            .point_fields
            .into_iter()
            .chain(dataset.cell_fields)
            .map(|field| Named { name: field.name, numbers: field.values }),
    );
    Ok(fields)
}
