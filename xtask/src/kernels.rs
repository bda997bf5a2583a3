//! `crates/models/src/materials/derived/`: laws as Rust, derived from their texts by the program.

use std::fs;

use crate::failure::Failure;
use crate::program;
use crate::tree::{Tree, answer};

const FOLDER: &str = "crates/models/src/materials/derived";

/// Writes the file of each law that has one: an empty file of its name is enough to begin with.
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
    println!("{} laws", kernels.len());
    Failure::unless_empty(faults)
}

/// The file of each law and its text.
fn kernels(tree: &Tree) -> Result<Vec<(String, String)>, Failure> {
    let folder = tree.root.join(FOLDER);
    let entries = fs::read_dir(&folder).map_err(|error| Failure::File { path: folder.clone(), error })?;
    let mut names: Vec<String> = entries
        .filter_map(|entry| {
            entry.ok()?.file_name().into_string().ok()?.strip_suffix(".rs").map(str::to_owned)
        })
        .filter(|name| name != "mod")
        .collect();
    names.sort_unstable();
    let kernel = |name: &String| {
        let mut command = program::souple(tree, &["derive", "--law", name, "--emit", "kernel"]);
        let (_, text) = answer(&mut command, program::REMEDY)?;
        Ok((format!("{FOLDER}/{name}.rs"), text))
    };
    names.iter().map(kernel).collect()
}
