//! `souple mesh`: generate, convert, quality.

use std::path::{Path, PathBuf};

use serde_json::{Value as Json, json};
use souple_mesh::Mesh;
use souple_table::{Kind, Value, Values};

use super::{End, Refusal, print_json, print_line};

#[derive(clap::Args)]
pub struct Arguments {
    #[command(subcommand)]
    action: Action,
}

#[derive(clap::Subcommand)]
enum Action {
    /// Makes a mesh: `souple mesh generate bar out.msh size=1,0.1,0.1 cells=30,3,3 element=tet4`
    Generate {
        /// A name that `souple list generators` prints
        generator: String,
        out: PathBuf,
        /// NAME=VALUE; vectors as three numbers with commas
        parameters: Vec<String>,
        #[arg(long)]
        json: bool,
    },
    /// Reads one format and writes another, by extension
    Convert {
        input: PathBuf,
        out: PathBuf,
        #[arg(long)]
        json: bool,
    },
    /// Measures volume, quality and conformity, and says what is wrong
    Quality {
        input: PathBuf,
        #[arg(long)]
        json: bool,
    },
}

impl Arguments {
    pub fn wants_json(&self) -> bool {
        match &self.action {
            Action::Generate { json, .. } | Action::Convert { json, .. } | Action::Quality { json, .. } => {
                *json
            }
        }
    }
}

pub fn mesh(arguments: Arguments) -> Result<End, Refusal> {
    match arguments.action {
        Action::Generate { generator, out, parameters, json } => {
            let mesh = generate(&generator, &parameters)?;
            write(&out, &mesh)?;
            report(&mesh, &[], json)
        }
        Action::Convert { input, out, json } => {
            let (mesh, notes) = read(&input)?;
            write(&out, &mesh)?;
            report(&mesh, &notes, json)
        }
        Action::Quality { input, json } => {
            let (mut mesh, mut notes) = read(&input)?;
            let repairs = mesh.validate();
            let refuse = |error: souple_mesh::MeshError| {
                Refusal::request(
                    "mesh",
                    input.display().to_string(),
                    "a mesh that can be computed with",
                    error.to_string(),
                )
            };
            notes.extend(repairs.map_err(refuse)?.messages());
            report(&mesh, &notes, json)
        }
    }
}

fn generate(name: &str, parameters: &[String]) -> Result<Mesh, Refusal> {
    let entry = souple_mesh::GENERATORS
        .find(name)
        .map_err(|error| Refusal::request("unknown_generator", name, "a generator", error.to_string()))?;
    let mut values = Values::new();
    for text in parameters {
        let refuse =
            |message: &str| Refusal::request("parameter", text, "NAME=VALUE", format!("`{text}`: {message}"));
        let (key, value) = text.split_once('=').ok_or_else(|| refuse("there is no `=`"))?;
        let kind =
            entry.parameters.iter().find(|parameter| parameter.name == key).map(|parameter| parameter.kind);
        let numbers: Option<Vec<f64>> = value.split(',').map(|number| number.trim().parse().ok()).collect();
        let value = match (kind, numbers.as_deref()) {
            (Some(Kind::Integer), Some([number])) if number.fract() == 0.0 => Value::Integer(*number as i64),
            (Some(Kind::Vector), Some([x, y, z])) => Value::Vector([*x, *y, *z]),
            (Some(Kind::Number), Some([number])) => Value::Number(*number),
            _ => Value::Text(value),
        };
        values.set(key.to_owned(), value);
    }
    souple_mesh::generate(name, values).map_err(|error| {
        Refusal::request("generate", name, "parameters that `souple describe` prints", error.to_string())
    })
}

fn read(path: &Path) -> Result<(Mesh, Vec<String>), Refusal> {
    Ok(souple_io::read_mesh(path)?)
}

fn write(path: &Path, mesh: &Mesh) -> Result<(), Refusal> {
    Ok(souple_io::write_mesh(path, mesh)?)
}

fn report(mesh: &Mesh, notes: &[String], as_json: bool) -> Result<End, Refusal> {
    let conforming = mesh.faces().conforming().err().map(|error| error.to_string());
    let quality = mesh.quality();
    let smallest =
        |pick: fn(&souple_mesh::CellQuality) -> f64| quality.iter().map(pick).fold(f64::INFINITY, f64::min);
    let bounds = mesh.bounds();
    let kinds: serde_json::Map<String, Json> = mesh
        .blocks
        .iter()
        .map(|block| (block.kind.name().to_owned(), json!(mesh.count_of(block.kind))))
        .collect();
    let document = json!({
        "points": mesh.points.len(),
        "cells": kinds,
        "facets": mesh.facet_count(),
        "groups": mesh.groups.keys().collect::<Vec<_>>(),
        "components": mesh.components().1,
        "volume": mesh.volume(),
        "bounds": [bounds.low.to_array(), bounds.high.to_array()],
        "smallest_scaled_jacobian": (!quality.is_empty()).then(|| smallest(|cell| cell.scaled_jacobian)),
        "conforming": conforming.is_none(),
        "problem": conforming,
        "notes": notes,
    });
    if as_json {
        print_json(&document);
    } else if let Json::Object(entries) = &document {
        for (name, value) in entries {
            print_line(format_args!("{name}: {value}"));
        }
    }
    Ok(End::Done)
}
