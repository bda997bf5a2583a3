//! What README and `docs/` show is run: commands by a shell, scenes by `souple check`.
//!
//! The word behind a block's language says what is done with it: `sh run` runs its lines in the root of the project,
//! with the released program in the path; `toml scene` is a complete scene; `toml part` is laid over the last complete
//! scene of its page. Examples in Rust are compiled with the crate `souple-tests`.

use std::fs;
use std::path::PathBuf;
use std::process::Command;

use crate::failure::Failure;
use crate::program;
use crate::tree::{Tree, run};

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
    Ok(())
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
}
