//! What README and `docs/` show is run: commands by a shell, scenes by `souple check`; and every key is explained.
//!
//! The word behind a block's language says what is done with it: `sh run` runs its lines in the root of the project,
//! with the released program in the path; `toml scene` is a complete scene; `toml part` is laid over the last complete
//! scene of its page. Examples in Rust are compiled with the crate `souple-tests`.

use std::collections::HashSet;
use std::fs;
use std::path::PathBuf;
use std::process::Command;

use serde_json::Value;

use crate::failure::Failure;
use crate::program;
use crate::tree::{Tree, answer, run, typed};

const FORMAT_PAGE: &str = "docs/scene-format.md";

/// A fenced block of a page.
#[derive(Debug, PartialEq)]
struct Block {
    /// What stands behind the fence: the language and what to do with the block.
    info: String,
    /// Line of the fence, from 1.
    line: usize,
    text: String,
}

pub fn check(tree: &Tree) -> Result<(), Failure> {
    let folder = program::folder(tree).join("snippets");
    fs::create_dir_all(&folder).map_err(|error| Failure::File { path: folder.clone(), error })?;
    let pages = tree
        .files()?
        .into_iter()
        .filter(|file| file.ends_with(".md") && (file.starts_with("docs/") || file == "README.md"));
    let mut count = 0;
    for page in pages {
        let mut base = None;
        for block in blocks(&tree.read(&page)?) {
            let place = format!("{page}:{}", block.line);
            let name = place.replace(['/', ':', '.'], "_");
            match block.info.as_str() {
                "sh run" => run_commands(tree, &place, &block.text)?,
                "toml scene" => {
                    let path = folder.join(format!("{name}.toml"));
                    check_scene(tree, &place, &path, &block.text)?;
                    base = Some(format!("{name}.toml"));
                }
                "toml part" => {
                    let Some(base) = &base else {
                        return Err(Failure::Faults(vec![format!(
                            "{place}: no `toml scene` stands before this part"
                        )]));
                    };
                    let text = format!("include = [\"{base}\"]\n{}", block.text);
                    check_scene(tree, &place, &folder.join(format!("{name}.toml")), &text)?;
                }
                _ => continue,
            }
            count += 1;
        }
    }
    println!("{count} snippets");
    check_keys(tree)
}

/// Every key of the JSON Schema stands in the page of the scene format.
fn check_keys(tree: &Tree) -> Result<(), Failure> {
    let mut command = program::souple(tree, &["schema"]);
    let (_, text) = answer(&mut command, program::REMEDY)?;
    let fail =
        |error: serde_json::Error| Failure::Answer { command: typed(&command), what: error.to_string() };
    let schema: Value = serde_json::from_str(&text).map_err(fail)?;
    let page = tree.read(FORMAT_PAGE)?;
    Failure::unless_empty(unexplained(&schema, &page))
}

/// Keys of the tables of a schema that a page does not mention.
fn unexplained(schema: &Value, page: &str) -> Vec<String> {
    let words: HashSet<&str> = page.split(|c: char| !(c.is_alphanumeric() || c == '_')).collect();
    let tables = schema["$defs"].as_object().into_iter().flatten();
    let keys = tables.flat_map(|(table, definition)| {
        definition["properties"]
            .as_object()
            .into_iter()
            .flat_map(|keys| keys.keys())
            .map(move |key| (table, key))
    });
    keys.filter(|(_, key)| !words.contains(key.as_str()))
        .map(|(table, key)| format!("{FORMAT_PAGE} does not explain the key `{key}` of the table `{table}`"))
        .collect()
}

fn run_commands(tree: &Tree, place: &str, commands: &str) -> Result<(), Failure> {
    println!("{place}");
    let path = std::env::var_os("PATH").unwrap_or_default();
    let folders = std::iter::once(program::folder(tree)).chain(std::env::split_paths(&path));
    let path = std::env::join_paths(folders).unwrap_or(path);
    let mut shell = Command::new("sh");
    shell.args(["-e", "-c", commands]).env("PATH", path).current_dir(&tree.root);
    run(&mut shell, "the commands of the documentation need a shell named `sh`")
}

fn check_scene(tree: &Tree, place: &str, path: &PathBuf, text: &str) -> Result<(), Failure> {
    println!("{place}");
    fs::write(path, text).map_err(|error| Failure::File { path: path.clone(), error })?;
    run(program::souple(tree, &["check"]).arg(path), program::REMEDY)
}

/// The fenced blocks of a page.
fn blocks(page: &str) -> Vec<Block> {
    let mut blocks = Vec::new();
    let mut open: Option<Block> = None;
    for (index, line) in page.lines().enumerate() {
        match (&mut open, line.strip_prefix("```")) {
            (None, Some(info)) => {
                open = Some(Block { info: info.trim().to_owned(), line: index + 1, text: String::new() });
            }
            (Some(_), Some(_)) => blocks.extend(open.take()),
            (Some(block), None) => {
                block.text += line;
                block.text.push('\n');
            }
            (None, None) => {}
        }
    }
    blocks
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_of_a_page() {
        let page = "text\n```sh run\nsouple list\nsouple check\n```\nmore\n```\nplain\n```\n";
        let block =
            |info: &str, line, text: &str| Block { info: info.to_owned(), line, text: text.to_owned() };
        assert_eq!(
            blocks(page),
            [block("sh run", 2, "souple list\nsouple check\n"), block("", 7, "plain\n")]
        );
    }

    #[test]
    fn keys_without_a_word_are_found() {
        let schema = serde_json::json!({"$defs": {"bar": {"properties": {"mesh": {}, "mesh_file": {}}}}});
        assert_eq!(unexplained(&schema, "`mesh`, or a `mesh_file`"), [""; 0]);
        assert_eq!(unexplained(&schema, "the mesh").len(), 1);
    }
}
