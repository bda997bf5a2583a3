//! What no file may say: a path of somebody's machine, a registry others cannot reach; the head that every source
//! file has; and that every file of tests is part of a program.

use crate::failure::Failure;
use crate::tree::Tree;

/// Roots of paths that exist on one machine only. In two pieces, since this file is read as well.
const PRIVATE_ROOTS: [&str; 4] =
    [concat!("/", "work/"), concat!("/", "root/"), concat!("/", "home/"), concat!("/", "Users/")];
/// Where packages of lock files come from.
const REGISTRIES: [&str; 2] =
    ["registry+https://github.com/rust-lang/crates.io-index", "https://registry.npmjs.org/"];

pub fn check(tree: &Tree) -> Result<(), Failure> {
    let mut faults = Vec::new();
    let files = tree.files()?;
    for file in &files {
        let Some(text) = tree.read_if_text(file)? else { continue };
        faults.extend(private_paths(&text).map(|(line, path)| {
            format!("{file}:{line}: `{path}` is a path of one machine; write it relative to the project")
        }));
        if file.ends_with("Cargo.lock") || file.ends_with("package-lock.json") {
            faults.extend(foreign_sources(&text).map(|(line, source)| {
                format!(
                    "{file}:{line}: `{source}` is no public registry; accepted are {}",
                    REGISTRIES.join(", ")
                )
            }));
        }
        if file.ends_with(".rs") {
            faults.extend(head_fault(file, &text).map(|what| format!("{file}:1: {what}")));
        }
    }
    for file in &files {
        let Some((package, name)) = test_file(file) else { continue };
        let program = format!("{package}/tests/all.rs");
        if !files.contains(&program) {
            continue;
        }
        let taken = tree.read(&program)?.lines().any(|line| line == format!("mod {name};"));
        let apart = tree.read(&format!("{package}/Cargo.toml"))?.contains(&format!("\nname = \"{name}\"\n"));
        if !taken && !apart {
            faults.push(format!("{file}:1: nothing runs these tests; write `mod {name};` in {program}"));
        }
    }
    Failure::unless_empty(faults)?;
    println!("{} files", files.len());
    Ok(())
}

/// The folder of the package and the name of a file or a folder of tests.
fn test_file(file: &str) -> Option<(&str, &str)> {
    let (package, path) = file.strip_suffix(".rs")?.split_once("/tests/")?;
    let name = path.strip_suffix("/mod").or_else(|| path.strip_suffix("/main")).unwrap_or(path);
    (name != "all" && !name.contains('/')).then_some((package, name))
}

/// Lines (from 1) with the paths on them that start at a private root.
fn private_paths(text: &str) -> impl Iterator<Item = (usize, &str)> {
    text.lines().enumerate().flat_map(|(line, content)| {
        PRIVATE_ROOTS.iter().filter_map(move |root| {
            let at =
                content.match_indices(root).map(|(at, _)| at).find(|at| starts_a_path(&content[..*at]))?;
            let path = content[at..].split([' ', '"', '`', ')', '\'']).next().unwrap_or_default();
            Some((line + 1, path))
        })
    })
}

/// Whether a slash behind this text is the first of its path.
fn starts_a_path(before: &str) -> bool {
    !before.ends_with(|c: char| c.is_alphanumeric() || "_.-/)}*~".contains(c))
}

/// Lines (from 1) of a lock file with a source that others cannot reach.
fn foreign_sources(text: &str) -> impl Iterator<Item = (usize, &str)> {
    text.lines().enumerate().filter_map(|(line, content)| {
        let content = content.trim_start();
        let source = content.strip_prefix("source = ").or_else(|| content.strip_prefix("\"resolved\": "))?;
        let source = source.trim_matches(|c: char| "\",".contains(c));
        let known = REGISTRIES.iter().any(|registry| source.starts_with(registry));
        (!known).then_some((line + 1, source))
    })
}

/// A source file starts by saying what it is for; a crate in one sentence on one line.
fn head_fault(file: &str, text: &str) -> Option<&'static str> {
    let mut lines = text.lines();
    let first = lines.next().unwrap_or_default();
    if !first.starts_with("//! ") {
        return Some("the file does not start with `//! ` and what it is for");
    }
    let is_crate = file.ends_with("src/lib.rs") || file.ends_with("src/main.rs");
    let goes_on = lines.next().is_some_and(|line| line.starts_with("//! "));
    (is_crate && (goes_on || !first.ends_with('.'))).then_some("a crate's head is one sentence on one line")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn private_paths_are_found() {
        let path = format!("{}me/scene.toml", PRIVATE_ROOTS[2]);
        let text = format!("first\nfile = \"{path}\"\n");
        assert_eq!(private_paths(&text).collect::<Vec<_>>(), [(2, path.as_str())]);
        // a folder of that name within a path is nobody's
        let harmless = format!("frame{}x out{}y a.{}z", PRIVATE_ROOTS[0], PRIVATE_ROOTS[1], PRIVATE_ROOTS[2]);
        assert_eq!(private_paths(&harmless).count(), 0);
    }

    #[test]
    fn foreign_registries_are_found() {
        let good = "source = \"registry+https://github.com/rust-lang/crates.io-index\"\nname = \"a\"\n";
        assert_eq!(foreign_sources(good).count(), 0);
        let bad = format!("{good}source = \"registry+https://mirror.example/index\"\n");
        assert_eq!(foreign_sources(&bad).collect::<Vec<_>>(), [(3, "registry+https://mirror.example/index")]);
        let package = "  \"resolved\": \"https://mirror.example/three.tgz\",";
        assert_eq!(foreign_sources(package).count(), 1);
    }

    #[test]
    fn files_of_tests() {
        assert_eq!(test_file("crates/a/tests/b.rs"), Some(("crates/a", "b")));
        assert_eq!(test_file("crates/a/tests/rooms/mod.rs"), Some(("crates/a", "rooms")));
        assert_eq!(test_file("crates/a/tests/rooms/edit.rs"), None);
        assert_eq!(test_file("crates/a/tests/all.rs"), None);
        assert_eq!(test_file("crates/a/src/b.rs"), None);
    }

    #[test]
    fn heads() {
        assert_eq!(head_fault("a/src/lib.rs", "//! One sentence.\n//!\n//! More.\n"), None);
        assert!(head_fault("a/src/lib.rs", "//! One sentence on\n//! two lines.\n").is_some());
        assert_eq!(head_fault("a/src/other.rs", "//! A sentence on\n//! two lines.\n"), None);
        assert!(head_fault("a/src/other.rs", "use std::fs;\n").is_some());
    }
}
