//! Every dependency may be used under a licence of the list, by its SPDX expression.

use serde_json::Value;

use crate::failure::Failure;
use crate::tree::{Tree, answer, typed};

/// Licences that ask for no more than their text and a notice; MPL-2.0 asks it of its own files only.
const ALLOWED: [&str; 12] = [
    "MIT",
    "Apache-2.0",
    "BSD-2-Clause",
    "BSD-3-Clause",
    "0BSD",
    "Zlib",
    "ISC",
    "MPL-2.0",
    "Unicode-3.0",
    "CC0-1.0",
    "BSL-1.0",
    "Unlicense",
];
/// Exceptions that only permit more than their licence.
const EXCEPTIONS: [&str; 1] = ["LLVM-exception"];

pub fn check(tree: &Tree) -> Result<(), Failure> {
    let mut command = tree.cargo(&["metadata", "--format-version", "1", "--locked"]);
    let (status, text) = answer(&mut command, "install Rust with rustup")?;
    if !status.success() {
        return Err(Failure::Command { command: typed(&command), status });
    }
    let fail = |what: String| Failure::Answer { command: typed(&command), what };
    let metadata: Value = serde_json::from_str(&text).map_err(|error| fail(error.to_string()))?;
    let packages = metadata["packages"].as_array().ok_or_else(|| fail("no list of packages".to_owned()))?;
    let faults = packages.iter().filter_map(fault).collect();
    Failure::unless_empty(faults)?;
    println!("{} packages", packages.len());
    Ok(())
}

/// What is wrong with one package of `cargo metadata`.
fn fault(package: &Value) -> Option<String> {
    let place = format!("{} {}", package["name"].as_str()?, package["version"].as_str()?);
    let Some(expression) = package["license"].as_str() else {
        return Some(format!("{place} states no licence; accepted are {}", ALLOWED.join(", ")));
    };
    match permits(expression) {
        Some(true) => None,
        Some(false) => Some(format!("{place} is under `{expression}`; accepted are {}", ALLOWED.join(", "))),
        None => Some(format!("{place}: the licence `{expression}` is no SPDX expression")),
    }
}

/// Whether the expression leaves a choice that is on the list; `None` if it cannot be read.
fn permits(expression: &str) -> Option<bool> {
    // old manifests write a slash for OR
    let spaced = expression.replace('(', " ( ").replace(')', " ) ").replace('/', " OR ");
    let mut words = spaced.split_whitespace().peekable();
    let permitted = any(&mut words)?;
    words.next().is_none().then_some(permitted)
}

type Words<'a> = std::iter::Peekable<std::str::SplitWhitespace<'a>>;

// any = all { "OR" all }
fn any(words: &mut Words) -> Option<bool> {
    let mut permitted = all(words)?;
    while words.next_if_eq(&"OR").is_some() {
        permitted |= all(words)?;
    }
    Some(permitted)
}

// all = one { "AND" one }
fn all(words: &mut Words) -> Option<bool> {
    let mut permitted = one(words)?;
    while words.next_if_eq(&"AND").is_some() {
        permitted &= one(words)?;
    }
    Some(permitted)
}

// one = "(" any ")" | licence [ "WITH" exception ]
fn one(words: &mut Words) -> Option<bool> {
    let word = words.next()?;
    if word == "(" {
        let permitted = any(words)?;
        return (words.next()? == ")").then_some(permitted);
    }
    if ["AND", "OR", "WITH", ")"].contains(&word) {
        return None;
    }
    let mut permitted = ALLOWED.contains(&word);
    if words.next_if_eq(&"WITH").is_some() {
        permitted &= EXCEPTIONS.contains(&words.next()?);
    }
    Some(permitted)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `OR` leaves a choice, `AND` does not and binds tighter, a slash is an old `OR`.
    #[test]
    fn expressions() {
        for good in [
            "MIT",
            "MIT/Apache-2.0",
            "GPL-3.0-only OR MIT",
            "(MIT OR Apache-2.0) AND Unicode-3.0",
            "Apache-2.0 WITH LLVM-exception OR GPL-2.0-only",
            "MIT OR GPL-3.0-only AND LGPL-3.0-only",
        ] {
            assert_eq!(permits(good), Some(true), "{good}");
        }
        for bad in [
            "GPL-3.0-only",
            "MIT AND GPL-3.0-only",
            "Apache-2.0 WITH Unknown-exception",
            "(GPL-2.0-only OR AGPL-3.0-only)",
        ] {
            assert_eq!(permits(bad), Some(false), "{bad}");
        }
        for broken in ["", "MIT OR", "(MIT", "MIT MIT", "OR MIT", "MIT WITH"] {
            assert_eq!(permits(broken), None, "{broken}");
        }
    }

    #[test]
    fn a_package_without_a_licence_is_named() {
        let package = serde_json::json!({"name": "thing", "version": "1.0.0", "license": null});
        assert!(fault(&package).is_some_and(|text| text.starts_with("thing 1.0.0 states no licence")));
    }
}
