//! Tables: one per kind of thing, read by scenes, command line, reference pages, schema and tests.
//!
//! An [`Entry`] names a thing, says what it is for and where it comes from, declares its [`Parameter`]s and
//! carries its constructor. Adding a thing is one file in its room and one line in its [`Table`].

mod parameter;
mod value;

pub use parameter::{Kind, MODERATE, Parameter, Range};
pub use value::{Value, ValueError, Values, counted, four_digits, in_number, readable, with_unit};

/// One thing: its name, its page in the reference, its constructor `B` (usually a function pointer).
#[derive(Debug)]
pub struct Entry<B> {
    /// As written in scene files: `snake_case`, the standard term of the field.
    pub name: &'static str,
    /// One line: what it is and when to take it.
    pub summary: &'static str,
    /// Where the mathematics comes from.
    pub source: &'static str,
    pub parameters: &'static [Parameter],
    pub build: B,
}

impl<B> Entry<B> {
    /// `given` completed by defaults and checked against kinds and ranges.
    ///
    /// # Errors
    /// Names the parameter that is unknown, missing, of the wrong kind or out of range.
    pub fn values(&self, given: Values) -> Result<Values, ValueError> {
        given.completed(self.parameters)
    }
}

/// All things of one kind.
#[derive(Debug)]
pub struct Table<B: 'static> {
    /// The kind, singular: `material`, `stepper`.
    pub kind: &'static str,
    pub entries: &'static [&'static Entry<B>],
}

/// A name that is in no entry of a table.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("there is no {kind} `{name}`{}; there are: {}", did_you_mean(.nearest), .known.join(", "))]
pub struct UnknownName {
    pub kind: &'static str,
    pub name: String,
    pub nearest: Option<String>,
    pub known: Vec<String>,
}

fn did_you_mean(nearest: &Option<String>) -> String {
    nearest.as_ref().map(|name| format!(" (did you mean `{name}`?)")).unwrap_or_default()
}

impl<B> Table<B> {
    /// # Errors
    /// The name is unknown; the error holds the nearest one.
    pub fn find(&self, name: &str) -> Result<&'static Entry<B>, UnknownName> {
        self.entries.iter().copied().find(|entry| entry.name == name).ok_or_else(|| UnknownName {
            kind: self.kind,
            name: name.to_owned(),
            nearest: nearest(name, self.names()).map(str::to_owned),
            known: self.names().map(str::to_owned).collect(),
        })
    }

    pub fn names(&self) -> impl Iterator<Item = &'static str> {
        self.entries.iter().map(|entry| entry.name)
    }
}

/// The candidate with the fewest edits to `name`, if a third of its letters or fewer differ and two or more stay as they are, or if
/// only capitals make the difference: of one letter every other one is a single edit away.
pub fn nearest<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let edits = |candidate: &str| {
        if candidate.to_lowercase() == name.to_lowercase() {
            return Some(0);
        }
        let (own, other) = (name.chars().count(), candidate.chars().count());
        let distance = edit_distance(name, candidate);
        (3 * distance <= other.max(3) + 2 && distance + 2 <= own.max(other)).then_some(distance)
    };
    let near = candidates.into_iter().filter_map(|candidate| Some((edits(candidate)?, candidate)));
    near.min_by_key(|(distance, _)| *distance).map(|(_, candidate)| candidate)
}

/// Insertions, deletions, substitutions and swaps of neighbours between two words.
fn edit_distance(a: &str, b: &str) -> usize {
    let (a, b): (Vec<char>, Vec<char>) = (a.chars().take(64).collect(), b.chars().take(64).collect());
    let width = b.len() + 1;
    let mut table = vec![0; (a.len() + 1) * width];
    for i in 0..=a.len() {
        for j in 0..=b.len() {
            table[i * width + j] = if i == 0 || j == 0 {
                i + j
            } else {
                let substitution = usize::from(a[i - 1] != b[j - 1]);
                let mut best = (table[(i - 1) * width + j] + 1)
                    .min(table[i * width + j - 1] + 1)
                    .min(table[(i - 1) * width + j - 1] + substitution);
                if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                    best = best.min(table[(i - 2) * width + j - 2] + 1);
                }
                best
            };
        }
    }
    table[a.len() * width + b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nearest_name_survives_a_typo_and_refuses_nonsense() {
        let names = ["neo_hookean", "st_venant_kirchhoff", "linear"];
        assert_eq!(nearest("neo_hokean", names), Some("neo_hookean"));
        assert_eq!(nearest("lienar", names), Some("linear"));
        assert_eq!(nearest("zebra", names), None);
    }

    /// Where nothing is alike nothing is offered, however short the words are.
    #[test]
    fn short_names_are_near_where_letters_stay() {
        let names = ["F", "J", "I1", "I1_bar", "mu", "K"];
        for unlike in ["a", "m", "q", "nu", "I9", "x1"] {
            assert_eq!(nearest(unlike, names), None, "{unlike}");
        }
        for (written, meant) in [("k", "K"), ("MU", "mu"), ("f", "F"), ("I_1", "I1"), ("I1bar", "I1_bar")] {
            assert_eq!(nearest(written, names), Some(meant));
        }
        // what differs in capitals alone is nearest
        assert_eq!(nearest("Lambda", ["lambda1", "lambda", "lamda"]), Some("lambda"));
    }
}
