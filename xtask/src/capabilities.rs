//! `docs/capabilities.md` tells the truth: every capability once, and what a row names exists.
//!
//! A row is `| id | what | status | scene | check |`. The status begins with `works`, `partly` or `not yet` and may
//! go on after a colon. Scenes are folders of `scenes/`. A check is a test, `path/to/file.rs::test_name`, or a row of
//! `souple verify`, `verify:row_id`; several are separated by commas. All names stand in backticks.

use std::collections::BTreeMap;

use serde_json::Value;

use crate::failure::Failure;
use crate::tree::Tree;

pub const FILE: &str = "docs/capabilities.md";

/// The families of capabilities with how many each has, numbered from 1.
const FAMILIES: [(&str, usize); 5] = [("FAU", 92), ("DEB", 56), ("JIM", 99), ("BOS", 9), ("DC", 8)];

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Status {
    Works,
    Partly,
    NotYet,
}

struct Row<'a> {
    /// From 1.
    line: usize,
    id: &'a str,
    status: &'a str,
    scenes: Vec<&'a str>,
    checks: Vec<&'a str>,
}

pub fn check(tree: &Tree) -> Result<(), Failure> {
    let text = tree.read(FILE)?;
    let scene_exists = |scene: &str| tree.root.join("scenes").join(scene).is_dir();
    let test_exists = |file: &str, name: &str| tree.read(file).is_ok_and(|source| has_test(&source, name));
    let mut faults = faults(&text, &scene_exists, &test_exists);
    for file in tree.files()?.iter().filter(|file| file.starts_with("scenes/") && file.ends_with(".toml")) {
        let scene = tree.read(file)?;
        faults.extend(overclaims(&text, file, &shown(&scene)));
    }
    Failure::unless_empty(faults)?;
    let mut counts = BTreeMap::new();
    for status in rows(&text).filter_map(|row| status_of(row.status)) {
        *counts.entry(status).or_insert(0) += 1;
    }
    println!("{counts:?}");
    Ok(())
}

/// Rows of the tables: lines whose first cell is an id of a family.
fn rows(text: &str) -> impl Iterator<Item = Row<'_>> {
    text.lines().enumerate().filter_map(|(index, line)| {
        let cells: Vec<&str> = line.strip_prefix('|')?.strip_suffix('|')?.split('|').map(str::trim).collect();
        let (family, _) = cells[0].split_once('-')?;
        let known = FAMILIES.iter().any(|(name, _)| *name == family);
        let cell = |i: usize| cells.get(i).copied().unwrap_or_default();
        known.then(|| Row {
            line: index + 1,
            id: cells[0],
            status: cell(2),
            scenes: quoted(cell(3)),
            checks: quoted(cell(4)),
        })
    })
}

/// What stands in backticks.
fn quoted(cell: &str) -> Vec<&str> {
    cell.split('`').skip(1).step_by(2).collect()
}

fn status_of(cell: &str) -> Option<Status> {
    match cell.split_once(':').map_or(cell, |(word, _)| word).trim() {
        "works" => Some(Status::Works),
        "partly" => Some(Status::Partly),
        "not yet" => Some(Status::NotYet),
        _ => None,
    }
}

fn faults(
    text: &str,
    scene_exists: &dyn Fn(&str) -> bool,
    test_exists: &dyn Fn(&str, &str) -> bool,
) -> Vec<String> {
    let mut faults = id_faults(text);
    for row in rows(text) {
        let mut say = |what: String| faults.push(format!("{FILE}:{}: {} {what}", row.line, row.id));
        match (status_of(row.status), row.checks.is_empty()) {
            (None, _) => say(format!("has the status `{}`; accepted are works, partly, not yet", row.status)),
            (Some(Status::Works | Status::Partly), true) => {
                say("names no check; without one it is `not yet`".to_owned());
            }
            (Some(Status::NotYet), false) => say("is `not yet`, but names a check".to_owned()),
            _ => {}
        }
        for scene in row.scenes.iter().filter(|scene| !scene_exists(scene)) {
            say(format!("names the scene `{scene}`, but there is no folder scenes/{scene}"));
        }
        for check in &row.checks {
            match check.split_once("::") {
                Some((file, name)) if !test_exists(file, name) => {
                    say(format!("names the test `{name}`, but {file} has no such test"));
                }
                None if !check.starts_with("verify:") => {
                    say(format!("names the check `{check}`; accepted are `file.rs::test` and `verify:row`"));
                }
                _ => {}
            }
        }
    }
    faults
}

/// Ids that are missing, doubled, or not on the list.
fn id_faults(text: &str) -> Vec<String> {
    let mut lines_of = BTreeMap::<&str, Vec<usize>>::new();
    for row in rows(text) {
        lines_of.entry(row.id).or_default().push(row.line);
    }
    let mut faults = Vec::new();
    for (family, count) in FAMILIES {
        for number in 1..=count {
            let id = format!("{family}-{number}");
            match lines_of.remove(id.as_str()).as_deref() {
                None => faults.push(format!("{FILE}: {id} is missing")),
                Some([_]) => {}
                Some(lines) => faults.push(format!("{FILE}: {id} stands on the lines {lines:?}")),
            }
        }
    }
    let unknown =
        lines_of.into_iter().map(|(id, lines)| format!("{FILE}:{}: there is no capability {id}", lines[0]));
    faults.extend(unknown);
    faults
}

/// The ids in the list `shows` of a scene.
fn shown(scene: &str) -> Vec<&str> {
    let list = scene.lines().position(|line| line.starts_with("shows")).map(|line| scene.lines().skip(line));
    let Some(lines) = list else { return Vec::new() };
    let mut ids = Vec::new();
    for line in lines {
        ids.extend(line.split('"').skip(1).step_by(2));
        if line.trim_end().ends_with(']') {
            break;
        }
    }
    ids
}

/// Ids that `claimant` claims to show, but the table does not know or calls `not yet`.
fn overclaims(text: &str, claimant: &str, ids: &[&str]) -> Vec<String> {
    let status = |id: &str| rows(text).find(|row| row.id == id).and_then(|row| status_of(row.status));
    ids.iter()
        .filter(|id| matches!(status(id), None | Some(Status::NotYet)))
        .map(|id| format!("{claimant} claims to show {id}, which {FILE} does not know or calls `not yet`"))
        .collect()
}

/// Whether a source has a function of this name marked as a test.
fn has_test(source: &str, name: &str) -> bool {
    let mut is_marked = false;
    for line in source.lines().map(str::trim) {
        if line.starts_with("#[test]") {
            is_marked = true;
        } else if let Some((_, signature)) = line.split_once("fn ") {
            if is_marked && signature.split(['(', '<']).next() == Some(name) {
                return true;
            }
            is_marked = false;
        }
    }
    false
}

/// Rows of the table that lean on a row of `souple verify` which does not exist or does not name them, and rows of
/// `souple verify` that claim what the table does not.
pub fn unproven(text: &str, verify_rows: &[Value]) -> Vec<String> {
    let mut faults = Vec::new();
    for row in verify_rows {
        let ids: Vec<&str> =
            row["capabilities"].as_array().into_iter().flatten().filter_map(Value::as_str).collect();
        faults.extend(overclaims(text, &format!("the row {} of `souple verify`", row["id"]), &ids));
    }
    for row in rows(text) {
        for id in row.checks.iter().filter_map(|check| check.strip_prefix("verify:")) {
            let found = verify_rows.iter().find(|verify_row| verify_row["id"] == id);
            let names_it = |verify_row: &Value| {
                verify_row["capabilities"]
                    .as_array()
                    .is_some_and(|ids| ids.iter().any(|named| *named == row.id))
            };
            let what = match found {
                None => "which `souple verify` does not have",
                Some(verify_row) if !names_it(verify_row) => "which does not name it",
                Some(_) => continue,
            };
            faults.push(format!("{FILE}:{}: {} leans on the row `{id}`, {what}", row.line, row.id));
        }
    }
    faults
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A table in which all is right: nothing is there yet.
    fn complete() -> String {
        FAMILIES
            .iter()
            .flat_map(|(family, count)| {
                (1..=*count).map(move |n| format!("| {family}-{n} | x | not yet | | |\n"))
            })
            .collect()
    }

    fn faults_of(text: &str) -> Vec<String> {
        let is_bar = |scene: &str| scene == "bar";
        let is_patch = |file: &str, name: &str| (file, name) == ("crates/a/tests/b.rs", "patch");
        faults(text, &is_bar, &is_patch)
    }

    /// The complete table with the row of FAU-7 replaced.
    fn with(row: &str) -> String {
        complete().replace("| FAU-7 | x | not yet | | |", row)
    }

    #[test]
    fn true_tables_pass() {
        assert_eq!(faults_of(&complete()), [""; 0]);
        let proven = "| FAU-7 | x | works | `bar` | `crates/a/tests/b.rs::patch`, `verify:hooke` |";
        assert_eq!(faults_of(&with(proven)), [""; 0]);
        assert_eq!(faults_of(&with("| FAU-7 | x | partly: 3D only | | `verify:hooke` |")), [""; 0]);
    }

    #[test]
    fn each_lie_is_found() {
        for (row, wrong) in [
            ("", "FAU-7 is missing"),
            ("| FAU-7 | x | not yet | | |\n| FAU-7 | x | not yet | | |", "FAU-7 stands on the lines"),
            ("| FAU-7 | x | not yet | | |\n| FAU-93 | x | not yet | | |", "there is no capability FAU-93"),
            ("| FAU-7 | x | nearly | | |", "has the status `nearly`"),
            ("| FAU-7 | x | works | `bar` | |", "names no check"),
            ("| FAU-7 | x | not yet | | `verify:hooke` |", "names a check"),
            ("| FAU-7 | x | works | `rab` | `verify:hooke` |", "no folder scenes/rab"),
            ("| FAU-7 | x | works | | `crates/a/tests/b.rs::hctap` |", "has no such test"),
            ("| FAU-7 | x | works | | `by hand` |", "names the check `by hand`"),
        ] {
            let found = faults_of(&with(row));
            assert!(found.len() == 1 && found[0].contains(wrong), "{row}: {found:?}");
        }
    }

    /// A helper is no test, nor is a function that a test stands before.
    #[test]
    fn tests_are_told_from_helpers() {
        let source =
            "#[test]\nfn first() {}\nfn helper() {}\n/// law\n#[test]\n#[cfg(unix)]\npub fn second<T>() {}\n";
        assert!(has_test(source, "first") && has_test(source, "second"));
        assert!(!has_test(source, "helper") && !has_test(source, "fir"));
    }

    #[test]
    fn verify_rows_must_name_what_they_prove() {
        let text = with("| FAU-7 | x | works | | `verify:hooke` |");
        let row = |id: &str, capability: &str| serde_json::json!({"id": id, "capabilities": [capability]});
        assert_eq!(unproven(&text, &[row("hooke", "FAU-7")]), [""; 0]);
        assert!(
            unproven(&text, &[row("hooke", "FAU-8")]).iter().any(|fault| fault.contains("does not name it"))
        );
        assert!(unproven(&text, &[row("other", "FAU-7")])[0].contains("does not have"));
        assert!(unproven(&text, &[row("other", "FAU-8")])[0].contains("claims to show FAU-8"));
    }

    #[test]
    fn scenes_claim_what_the_table_knows() {
        let scene = "format = 1\nshows = [\"FAU-7\", \"FAU-8\",\n  \"FAU-93\"]\ntitle = \"bar\"\n";
        assert_eq!(shown(scene), ["FAU-7", "FAU-8", "FAU-93"]);
        let text = with("| FAU-7 | x | works | `bar` | `verify:hooke` |");
        assert_eq!(overclaims(&text, "bar", &shown(scene)).len(), 2);
        assert_eq!(shown("format = 1\n"), [""; 0]);
    }
}
