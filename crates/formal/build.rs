//! Says by which sources laws are derived: what was derived by others is not taken for the same.

use std::env;
use std::fs;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};

/// What a derivation is made of: this crate, the algebra it computes constants with, and the versions of what both use.
const SOURCES: [&str; 3] = ["src", "../math/src", "../../Cargo.lock"];

fn main() {
    let here = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").expect("cargo names the folder of the crate"));
    let mut hasher = DefaultHasher::new();
    for source in SOURCES {
        let path = here.join(source);
        println!("cargo::rerun-if-changed={}", path.display());
        hash(&path, &mut hasher);
    }
    println!("cargo::rustc-env=SOUPLE_DERIVATION={:016x}", hasher.finish());
}

/// Names and contents of all files at a path, in the order of their names.
fn hash(path: &Path, hasher: &mut DefaultHasher) {
    let Ok(folder) = fs::read_dir(path) else {
        path.file_name().hash(hasher);
        let content = fs::read(path);
        content.unwrap_or_else(|error| panic!("{}: {error}", path.display())).hash(hasher);
        return;
    };
    let mut entries: Vec<PathBuf> = folder.flatten().map(|entry| entry.path()).collect();
    entries.sort();
    entries.iter().for_each(|entry| hash(entry, hasher));
}
