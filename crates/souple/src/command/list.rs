//! `souple list` and `souple describe`: what there is, from the tables.

use serde_json::{Value, json};
use souple_table::{Entry, Parameter, Table};

use super::{End, Refusal, did_you_mean, print_json, print_line};

#[derive(clap::Args)]
pub struct ListArguments {
    /// materials, elements, steppers, solvers, preconditioners, generators, shapes, formats
    kind: String,
    #[arg(long)]
    pub json: bool,
}

#[derive(clap::Args)]
pub struct DescribeArguments {
    /// Name of a material, an element, a stepper, …
    name: String,
    #[arg(long)]
    pub json: bool,
}

/// An entry of any table, its constructor forgotten.
struct Page {
    kind: &'static str,
    name: &'static str,
    summary: &'static str,
    source: &'static str,
    parameters: &'static [Parameter],
}

fn pages_of<B>(table: &'static Table<B>) -> Vec<Page> {
    let page = |entry: &&'static Entry<B>| Page {
        kind: table.kind,
        name: entry.name,
        summary: entry.summary,
        source: entry.source,
        parameters: entry.parameters,
    };
    table.entries.iter().map(page).collect()
}

/// Every table, under the plural that `list` takes.
fn tables() -> Vec<(&'static str, Vec<Page>)> {
    vec![
        ("materials", pages_of(&souple_models::materials::TABLE)),
        ("elements", pages_of(&souple_mesh::ELEMENTS)),
        ("steppers", pages_of(&souple_engine::steppers::TABLE)),
        ("solvers", pages_of(&souple_solve::solvers::TABLE)),
        ("preconditioners", pages_of(&souple_solve::precondition::TABLE)),
        ("generators", pages_of(&souple_mesh::GENERATORS)),
        ("shapes", pages_of(&souple_models::contact::SHAPES)),
        ("formats", pages_of(&souple_io::FORMATS)),
    ]
}

pub fn list(arguments: &ListArguments) -> Result<End, Refusal> {
    let tables = tables();
    let kinds: Vec<&str> = tables.iter().map(|(plural, _)| *plural).collect();
    let wanted = arguments.kind.as_str();
    let found = tables
        .iter()
        .find(|(plural, pages)| *plural == wanted || pages.iter().any(|page| page.kind == wanted));
    let Some((_, pages)) = found else {
        let message = format!("there is no kind `{wanted}`{}", did_you_mean(wanted, kinds.iter().copied()));
        return Err(Refusal::request(
            "unknown_kind",
            wanted,
            format!("one of {}", kinds.join(", ")),
            message,
        ));
    };
    if arguments.json {
        print_json(&Value::Array(pages.iter().map(to_json).collect()));
        return Ok(End::Done);
    }
    let width = pages.iter().map(|page| page.name.len()).max().unwrap_or(0);
    for page in pages {
        print_line(format_args!("{:width$}  {}", page.name, page.summary));
    }
    Ok(End::Done)
}

pub fn describe(arguments: &DescribeArguments) -> Result<End, Refusal> {
    let tables = tables();
    let pages: Vec<&Page> = tables.iter().flat_map(|(_, pages)| pages).collect();
    let found: Vec<&&Page> = pages.iter().filter(|page| page.name == arguments.name).collect();
    if found.is_empty() {
        let hint = did_you_mean(&arguments.name, pages.iter().map(|page| page.name));
        let message = format!("nothing is called `{}`{hint}", arguments.name);
        return Err(Refusal::request(
            "unknown_name",
            &arguments.name,
            "a name that `souple list` prints",
            message,
        ));
    }
    if arguments.json {
        print_json(&Value::Array(found.iter().map(|page| to_json(page)).collect()));
        return Ok(End::Done);
    }
    for page in found {
        print_line(format_args!("{} ({})", page.name, page.kind));
        print_line(format_args!("  {}", page.summary));
        print_line(format_args!("  source: {}", page.source));
        for parameter in page.parameters {
            let default = parameter.default.map(|value| format!(", default {value}")).unwrap_or_default();
            print_line(format_args!("  {}: {}", parameter.name, parameter.summary));
            print_line(format_args!("      {}{default}", parameter.expected()));
        }
    }
    Ok(End::Done)
}

fn to_json(page: &Page) -> Value {
    let parameters: Vec<Value> = page
        .parameters
        .iter()
        .map(|parameter| {
            json!({
                "name": parameter.name,
                "summary": parameter.summary,
                "unit": parameter.unit,
                "expected": parameter.expected(),
                "default": parameter.default.map(|value| value.to_string()),
            })
        })
        .collect();
    json!({
        "kind": page.kind,
        "name": page.name,
        "summary": page.summary,
        "source": page.source,
        "parameters": parameters,
    })
}
