//! `docs/reference/`: a page for each kind of thing, from the program's own tables.

use std::collections::BTreeMap;
use std::fs;

use serde_json::Value;

use crate::failure::Failure;
use crate::program;
use crate::tree::{Tree, answer, typed};

const FOLDER: &str = "docs/reference";

/// Writes all pages.
pub fn make(tree: &Tree) -> Result<(), Failure> {
    let folder = tree.root.join(FOLDER);
    fs::create_dir_all(&folder).map_err(|error| Failure::File { path: folder.clone(), error })?;
    for (file, text) in pages(tree)? {
        let path = tree.root.join(&file);
        fs::write(&path, text).map_err(|error| Failure::File { path, error })?;
    }
    check(tree)
}

/// The pages are what the tables say.
pub fn check(tree: &Tree) -> Result<(), Failure> {
    let pages = pages(tree)?;
    let remedy = "`cargo xtask reference` writes them";
    let stale = pages.iter().filter(|(file, text)| tree.read(file).ok().as_ref() != Some(*text));
    let mut faults: Vec<String> =
        stale.map(|(file, _)| format!("{file} is not what the tables say; {remedy}")).collect();
    let kept = tree.files()?;
    let left = kept.iter().filter(|file| file.starts_with(FOLDER) && !pages.contains_key(*file));
    faults.extend(left.map(|file| format!("{file} is of no table; remove it")));
    println!("{} pages", pages.len());
    Failure::unless_empty(faults)
}

/// Text of each page by its file.
fn pages(tree: &Tree) -> Result<BTreeMap<String, String>, Failure> {
    let kinds = ask(tree, &["list", "--json"])?;
    let kinds: Vec<&str> = kinds.as_array().into_iter().flatten().filter_map(Value::as_str).collect();
    let mut pages = BTreeMap::new();
    let mut index = "# Reference\n\nWhat there is, from the tables of the program; `souple list KIND` and `souple describe NAME` print the same.\n\
                     These pages are written by `cargo xtask reference`.\n\n| kind | |\n|---|---|\n"
        .to_owned();
    for kind in kinds {
        let entries = ask(tree, &["list", kind, "--json"])?;
        let entries = entries.as_array().cloned().unwrap_or_default();
        let names: Vec<String> =
            entries.iter().map(|entry| format!("`{}`", entry["name"].as_str().unwrap_or_default())).collect();
        index += &format!("| [{}]({kind}.md) | {} |\n", kind.replace('_', " "), names.join(", "));
        pages.insert(format!("{FOLDER}/{kind}.md"), page(kind, &entries));
    }
    pages.insert(format!("{FOLDER}/README.md"), index);
    Ok(pages)
}

fn ask(tree: &Tree, arguments: &[&str]) -> Result<Value, Failure> {
    let mut command = program::souple(tree, arguments);
    let (_, text) = answer(&mut command, program::REMEDY)?;
    serde_json::from_str(&text)
        .map_err(|error| Failure::Answer { command: typed(&command), what: error.to_string() })
}

fn page(kind: &str, entries: &[Value]) -> String {
    let mut title = kind.replace('_', " ");
    title[..1].make_ascii_uppercase();
    let mut page = format!("# {title}\n");
    let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
    for entry in entries {
        page += &format!("\n## `{}`\n\n{}\n\n", text(&entry["name"]), sentence(&text(&entry["summary"])));
        // laws are printed as the program reads them
        if let Some(letters) = entry["letters"].as_str() {
            page += &format!("As text, with {letters}:\n\n");
        }
        if let Some(written) = entry["text"].as_str() {
            page += &format!("```text\n{written}\n```\n\n");
        }
        if !text(&entry["source"]).is_empty() {
            page += &format!("Source: {}\n", sentence(&text(&entry["source"])));
        }
        let parameters = entry["parameters"].as_array().cloned().unwrap_or_default();
        if parameters.is_empty() {
            continue;
        }
        page += "\n| parameter | what | accepted | default |\n|---|---|---|---|\n";
        for parameter in &parameters {
            // a bar would begin another cell
            let cell = |key: &str| text(&parameter[key]).replace('|', "\\|");
            let default = match cell("default") {
                none if none.is_empty() => String::new(),
                value => format!("`{value}`"),
            };
            page +=
                &format!("| `{}` | {} | {} | {default} |\n", cell("name"), cell("summary"), cell("expected"));
        }
    }
    page
}

/// With a capital, and a stop at its end.
fn sentence(text: &str) -> String {
    let mut letters = text.chars();
    let first: String = letters.next().into_iter().flat_map(char::to_uppercase).collect();
    let whole = format!("{first}{}", letters.as_str());
    if whole.ends_with('.') { whole } else { format!("{whole}.") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_has_every_entry_and_parameter() {
        let entry = serde_json::json!({
            "name": "plane", "summary": "everything below |z|", "source": "analytic",
            "parameters": [{"name": "point", "summary": "a | b", "unit": "m", "expected": "a vector", "default": null}],
            "text": "z; z = 1", "letters": "`z` for the height",
        });
        let page = page("contact_shapes", &[entry]);
        let expected = "# Contact shapes\n\n## `plane`\n\nEverything below |z|.\n\nAs text, with `z` for the height:\n\n```text\nz; z = 1\n```\n\nSource: Analytic.\n\n\
                        | parameter | what | accepted | default |\n|---|---|---|---|\n| `point` | a \\| b | a vector |  |\n";
        assert_eq!(page, expected);
    }
}
