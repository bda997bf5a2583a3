//! `crates/models/src/materials/derived/` and `crates/models/src/solids/derived/`: laws, and laws on elements, as Rust, derived from
//! their texts by the program.

use std::fs;
use std::io::Write;
use std::process::{Command, Stdio};

use crate::cargo::TOOLCHAIN;
use crate::failure::Failure;
use crate::program;
use crate::tree::{Tree, answer, typed};

/// Folders, and whether their files are of laws on elements: `<law>_<element>.rs`, or `<law>_<element>_box.rs` of boxes.
const FOLDERS: [(&str, bool); 2] =
    [("crates/models/src/materials/derived", false), ("crates/models/src/solids/derived", true)];

/// Files there that are written by hand.
const BY_HAND: [&str; 3] = ["mod", "kernel", "boxes"];

/// Writes every file anew: an empty one of its name is enough to begin with.
pub fn make(tree: &Tree) -> Result<(), Failure> {
    for (file, text) in kernels(tree)? {
        let path = tree.root.join(&file);
        fs::write(&path, text).map_err(|error| Failure::File { path, error })?;
    }
    check(tree)
}

/// The files are what the program derives.
pub fn check(tree: &Tree) -> Result<(), Failure> {
    let kernels = kernels(tree)?;
    let stale = kernels.iter().filter(|(file, text)| tree.read(file).ok().as_ref() != Some(text));
    let faults: Vec<String> = stale
        .map(|(file, _)| format!("{file} is not what its law says; `cargo xtask kernels` writes it"))
        .collect();
    println!("{} kernels", kernels.len());
    Failure::unless_empty(faults)
}

/// The files and their texts.
fn kernels(tree: &Tree) -> Result<Vec<(String, String)>, Failure> {
    let mut all = Vec::new();
    for (folder, has_elements) in FOLDERS {
        let path = tree.root.join(folder);
        let entries = fs::read_dir(&path).map_err(|error| Failure::File { path, error })?;
        let mut names: Vec<String> = entries
            .filter_map(|entry| {
                entry.ok()?.file_name().into_string().ok()?.strip_suffix(".rs").map(str::to_owned)
            })
            .filter(|name| !BY_HAND.contains(&name.as_str()))
            .collect();
        names.sort_unstable();
        for name in names {
            let mut arguments = vec!["derive", "--emit", "kernel", "--law"];
            if has_elements {
                let (pair, map) = name.strip_suffix("_box").map_or((&*name, "general"), |pair| (pair, "box"));
                let (law, element) = pair.rsplit_once('_').unwrap_or((pair, ""));
                arguments.extend([law, "--element", element, "--map", map]);
            } else {
                arguments.push(&name);
            }
            let (_, text) = answer(&mut program::souple(tree, &arguments), program::REMEDY)?;
            all.push((format!("{folder}/{name}.rs"), formatted(tree, &text)?));
        }
    }
    Ok(all)
}

/// As `cargo fmt` has it.
fn formatted(tree: &Tree, text: &str) -> Result<String, Failure> {
    let mut command = Command::new("rustfmt");
    command.args(["--edition", "2024"]).current_dir(&tree.root);
    command.stdin(Stdio::piped()).stdout(Stdio::piped());
    let missing = |error| Failure::Missing { command: "rustfmt".to_owned(), error, remedy: TOOLCHAIN };
    let mut child = command.spawn().map_err(missing)?;
    if let Some(mut input) = child.stdin.take() {
        input.write_all(text.as_bytes()).map_err(missing)?;
    }
    let output = child.wait_with_output().map_err(missing)?;
    if !output.status.success() {
        return Err(Failure::Command { command: typed(&command), status: output.status });
    }
    Ok(String::from_utf8_lossy(&output.stdout).into_owned())
}
