//! Where the keys of a study stand in its text.

use std::path::{Path, PathBuf};

use souple_scene::path::{Step, steps};
use toml::de::{DeArray, DeTable};

use crate::SweepError;

/// A study as it is written, for what is wrong with it to be found.
#[derive(Clone, Debug)]
pub(crate) struct Written {
    path: PathBuf,
    text: String,
}

impl Written {
    pub fn new(path: &Path, text: &str) -> Self {
        Self { path: path.to_owned(), text: text.to_owned() }
    }

    /// The error of a value of the study, with where that is written; others as they are.
    pub fn placed(&self, error: SweepError) -> SweepError {
        let SweepError::Value { path, .. } = &error else { return error };
        let Some((line, column)) = place_of(&self.text, path) else { return error };
        SweepError::At { path: self.path.clone(), line, column, error: Box::new(error) }
    }
}

/// Line and column, from 1, of what a path such as `plan.keys[2].probe` leads to: of the last of its keys that is there, `None` where none is, or
/// it is no path.
fn place_of(text: &str, path: &str) -> Option<(usize, usize)> {
    let table = DeTable::parse(text).ok()?;
    let mut at = None;
    let (mut tables, mut items) = (Some(table.get_ref()), None::<&DeArray>);
    for step in steps(path)? {
        let (start, value) = match step {
            Step::Key(name) => {
                let found = tables.and_then(|table| table.iter().find(|(key, _)| key.get_ref() == name));
                let Some((key, value)) = found else { break };
                (key.span().start, value)
            }
            Step::Item(index) => {
                let Some(value) = items.and_then(|items| items.get(index)) else { break };
                (value.span().start, value)
            }
        };
        at = Some(start);
        tables = value.get_ref().as_table();
        items = value.get_ref().as_array();
    }
    let before = text.get(..at?)?;
    let line = before.rsplit('\n').next().unwrap_or_default();
    Some((before.matches('\n').count() + 1, line.chars().count() + 1))
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "scene = \"s.toml\"\n[plan]\nkind = \"spacetime\"\nweights = { \"a.b\" = 0 }\n\n[[plan.keys]]\ntime = 1\n\n[[plan.keys]]\n  probe = \"x\"\n";

    /// Keys of tables, of items of lists and in quotes are found; of what is missing, the table that lacks it.
    #[test]
    fn keys_are_found_by_their_paths() {
        for (path, place) in [
            ("scene", Some((1, 1))),
            ("plan.kind", Some((3, 1))),
            ("plan.weights.\"a.b\"", Some((4, 13))),
            ("plan.keys[0].time", Some((7, 1))),
            ("plan.keys[1].probe", Some((10, 3))),
            ("plan.keys[1].time", Some((9, 1))),
            ("other", None),
            ("runs.csv, line 1", None),
            ("", None),
            ("plan.keys[x]", None),
            ("é\"[", None),
        ] {
            assert_eq!(place_of(TEXT, path), place, "{path}");
        }
    }
}
