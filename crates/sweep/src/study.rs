//! What a study asks for: a scene, what is the same in all runs, what varies, and the graphs to draw.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use souple_io::csv_cells;
use toml::{Table, Value};

use crate::SweepError;
use crate::fit::Fit;
use crate::motion::Motion;
use crate::place::Written;
use crate::state_space::Tabulation;

/// A study, read from a TOML file.
#[derive(Clone, Debug)]
pub struct Study {
    pub title: String,
    /// Scene file, or a folder with a `scene.toml`.
    pub scene: PathBuf,
    /// `path=value` of every run.
    pub settings: Vec<String>,
    /// Periods of each run; to the end of the scene where `None`.
    pub steps: Option<u64>,
    pub runs: Vec<Plan>,
    pub graphs: Vec<Graph>,
    /// What is looked for, in the place of runs.
    pub fit: Option<Fit>,
    /// What motion is sought, in the place of runs.
    pub motion: Option<Motion>,
    /// What table of commands is sought, in the place of runs.
    pub tabulation: Option<Tabulation>,
    pub(crate) written: Written,
}

/// What a plan is of.
enum Sought {
    Motion(Motion),
    Table(Tabulation),
}

impl Sought {
    fn read(value: &Value, folder: &Path) -> Result<Self, SweepError> {
        let Value::Table(table) = value else {
            return Err(SweepError::value("plan", value.to_string(), "a table"));
        };
        match table.get("kind").and_then(Value::as_str) {
            Some("state_space") => Tabulation::read(table).map(Self::Table),
            _ => Motion::read(table, folder).map(Self::Motion),
        }
    }
}

/// One run: what it has of its own.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// Paths of the scene and their values: sorted, or in the order of the table.
    pub values: Vec<(String, Value)>,
}

/// A curve of a result over a value, one for each value of `lines`.
#[derive(Clone, Debug)]
pub struct Graph {
    pub name: String,
    /// That of the study where `None`.
    pub title: Option<String>,
    /// A path that varies, or a result.
    pub x: String,
    /// A result: `PROBE`, `PROBE.x`, `PROBE.max`, `wall_seconds`.
    pub y: String,
    pub lines: Option<String>,
    pub logarithmic: [bool; 2],
}

/// Most runs of a study.
const MOST_RUNS: usize = 100_000;

const KEYS: &[&str] = &["title", "scene", "settings", "steps", "vary", "table", "graphs", "fit", "plan"];
const GRAPH_KEYS: &[&str] = &["title", "x", "y", "lines", "logarithmic"];

impl Study {
    /// # Errors
    /// The file cannot be read, is no TOML, or asks for something that cannot be.
    pub fn read(path: &Path) -> Result<Self, SweepError> {
        Self::parse(path, &read(path)?, read)
    }

    /// Reads the text of a study, of which `path` is the name and the folder, and its table, if it has one, by `table`.
    ///
    /// # Errors
    /// It is no TOML, asks for something that cannot be, or what `table` fails with.
    pub fn parse(
        path: &Path,
        text: &str,
        table: impl FnOnce(&Path) -> Result<String, SweepError>,
    ) -> Result<Self, SweepError> {
        let written = Written::new(path, text);
        Self::of_text(path, text, table, written.clone()).map_err(|error| written.placed(error))
    }

    fn of_text(
        path: &Path,
        text: &str,
        table: impl FnOnce(&Path) -> Result<String, SweepError>,
        written: Written,
    ) -> Result<Self, SweepError> {
        let document: Table = text.parse().map_err(|error: toml::de::Error| SweepError::Syntax {
            path: path.to_owned(),
            message: error.to_string(),
        })?;
        refuse_unknown("", &document, KEYS)?;
        let folder = path.parent().unwrap_or(Path::new("."));
        let scene =
            folder.join(text_of(&document, "scene")?.ok_or_else(|| missing("scene", "a scene file"))?);
        let fit = document.get("fit");
        if let (Some(_), Some(other)) =
            (fit, ["vary", "table", "graphs"].into_iter().find(|key| document.contains_key(*key)))
        {
            return Err(SweepError::value(other, "there beside `fit`", "a study of runs, or one of a fit"));
        }
        let plan = document.get("plan").map(|plan| Sought::read(plan, folder)).transpose()?;
        let others = ["vary", "table", "graphs", "fit", "steps"];
        if let (Some(_), Some(other)) = (&plan, others.into_iter().find(|key| document.contains_key(*key))) {
            return Err(SweepError::value(other, "there beside `plan`", "a study of a plan alone"));
        }
        let mut table = Some(table);
        let mut table = |path: &Path| match table.take() {
            Some(table) => table(path),
            None => unreachable!("a study names one file"),
        };
        let fit = fit.map(|fit| Fit::read(fit, folder, &mut table)).transpose()?;
        let runs = match (document.get("vary"), document.get("table")) {
            (None, None) if fit.is_some() || plan.is_some() => Vec::new(),
            (Some(vary), None) => products(vary)?,
            (None, Some(_)) => {
                let path = folder.join(text_of(&document, "table")?.unwrap_or_default());
                rows(&path, &table(&path)?)?
            }
            (Some(_), Some(_)) => {
                return Err(SweepError::value("vary", "there beside `table`", "one of them"));
            }
            (None, None) => {
                return Err(missing(
                    "vary",
                    "a table of paths with lists of values, a `table` file, a `fit`, or a `plan`",
                ));
            }
        };
        let steps = match document.get("steps") {
            None => None,
            Some(Value::Integer(steps @ 1..)) => Some(*steps as u64),
            Some(other) => {
                return Err(SweepError::value("steps", other.to_string(), "a whole number above 0"));
            }
        };
        let settings = settings(&document)?;
        let sought = |setting: &&String| {
            let path = setting.split('=').next().unwrap_or_default().trim();
            fit.iter().flat_map(|fit| &fit.unknowns).any(|unknown| unknown.path == path)
        };
        if let Some(setting) = settings.iter().find(sought) {
            let found = format!("`{setting}`, of what `fit.values` looks for");
            return Err(SweepError::value("settings", found, "settings of other values"));
        }
        let (motion, tabulation) = match plan {
            Some(Sought::Motion(motion)) => (Some(motion), None),
            Some(Sought::Table(tabulation)) => (None, Some(tabulation)),
            None => (None, None),
        };
        Ok(Self {
            title: text_of(&document, "title")?.unwrap_or_default().to_owned(),
            scene: if scene.is_dir() { scene.join("scene.toml") } else { scene },
            settings,
            steps,
            runs,
            graphs: graphs(&document)?,
            fit,
            motion,
            tabulation,
            written,
        })
    }

    /// Paths that vary, in the order of the values of each run.
    pub fn paths(&self) -> impl Iterator<Item = &str> {
        self.runs.first().into_iter().flat_map(|plan| plan.values.iter().map(|(path, _)| path.as_str()))
    }
}

impl Plan {
    /// As `souple run --set` takes them.
    pub fn settings(&self) -> Vec<String> {
        self.values.iter().map(|(path, value)| format!("{path}={value}")).collect()
    }
}

fn read(path: &Path) -> Result<String, SweepError> {
    std::fs::read_to_string(path).map_err(|source| SweepError::Read { path: path.to_owned(), source })
}

fn missing(path: &str, expected: &str) -> SweepError {
    SweepError::value(path, "missing", expected)
}

fn refuse_unknown(within: &str, table: &Table, known: &[&str]) -> Result<(), SweepError> {
    match table.keys().find(|key| !known.contains(&key.as_str())) {
        None => Ok(()),
        Some(key) => Err(SweepError::value(
            format!("{within}{key}"),
            "unknown",
            format!("one of {}", known.join(", ")),
        )),
    }
}

fn text_of<'a>(table: &'a Table, key: &str) -> Result<Option<&'a str>, SweepError> {
    match table.get(key) {
        None => Ok(None),
        Some(Value::String(text)) => Ok(Some(text)),
        Some(other) => Err(SweepError::value(key, other.to_string(), "a text")),
    }
}

/// `settings = ["path=value", …]`.
fn settings(document: &Table) -> Result<Vec<String>, SweepError> {
    let expected = "a list of texts, as `--set` takes them";
    let Some(value) = document.get("settings") else { return Ok(Vec::new()) };
    let Value::Array(list) = value else {
        return Err(SweepError::value("settings", value.to_string(), expected));
    };
    let texts = list.iter().map(|entry| {
        let text =
            entry.as_str().ok_or_else(|| SweepError::value("settings", entry.to_string(), expected))?;
        Ok(text.to_owned())
    });
    texts.collect()
}

/// Every combination of the lists, the last one running fastest.
fn products(vary: &Value) -> Result<Vec<Plan>, SweepError> {
    let Value::Table(paths) = vary else {
        return Err(SweepError::value("vary", vary.to_string(), "a table of paths with lists of values"));
    };
    let mut plans = vec![Plan { values: Vec::new() }];
    for (path, value) in paths {
        let Value::Array(values) = value else {
            return Err(SweepError::value(format!("vary.\"{path}\""), value.to_string(), "a list of values"));
        };
        let count = plans.len().saturating_mul(values.len());
        if values.is_empty() || count > MOST_RUNS {
            let found = format!("a list of {}, {count} runs in all", values.len());
            return Err(SweepError::value(
                format!("vary.\"{path}\""),
                found,
                format!("1 to {MOST_RUNS} runs"),
            ));
        }
        if let Some(again) = values.iter().enumerate().find(|(place, value)| values[..*place].contains(value))
        {
            let found = format!("{} twice", again.1);
            return Err(SweepError::value(format!("vary.\"{path}\""), found, "different values"));
        }
        let with = |plan: &Plan, value: &Value| Plan {
            values: plan.values.iter().cloned().chain([(path.clone(), value.clone())]).collect(),
        };
        plans = plans.iter().flat_map(|plan| values.iter().map(move |value| with(plan, value))).collect();
    }
    Ok(plans)
}

/// A file of values with commas, paths at the head: a run for each line. A value is read as TOML, or as text where it is none;
/// lists stand in quotes.
fn rows(path: &Path, text: &str) -> Result<Vec<Plan>, SweepError> {
    let place = |line: usize| format!("{}, line {}", path.display(), line + 1);
    let mut lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
    let (first, head) =
        lines.next().ok_or_else(|| SweepError::value(place(0), "empty", "paths with commas"))?;
    let cells_of = |number: usize, line: &str| {
        csv_cells(line)
            .ok_or_else(|| SweepError::value(place(number), "a quote that is not closed", "quotes in pairs"))
    };
    let paths = cells_of(first, head)?;
    let mut known = BTreeSet::new();
    if let Some(path) = paths.iter().find(|path| path.is_empty() || !known.insert(*path)) {
        let found = if path.is_empty() { "an empty path".to_owned() } else { format!("`{path}` twice") };
        return Err(SweepError::value(place(first), found, "different paths with commas"));
    }
    let mut plans = Vec::new();
    for (number, line) in lines {
        let values = cells_of(number, line)?;
        if values.len() != paths.len() {
            let found = format!("{} values", values.len());
            return Err(SweepError::value(
                place(number),
                found,
                format!("{}, one for each path", paths.len()),
            ));
        }
        let values = paths.iter().cloned().zip(values.iter().map(|value| value_of(value))).collect();
        plans.push(Plan { values });
    }
    if plans.is_empty() || plans.len() > MOST_RUNS {
        let found = format!("{} lines of values", plans.len());
        return Err(SweepError::value(path.display().to_string(), found, format!("1 to {MOST_RUNS} runs")));
    }
    Ok(plans)
}

fn value_of(text: &str) -> Value {
    let parsed: Option<Table> = format!("value = {text}").parse().ok();
    parsed.and_then(|mut table| table.remove("value")).unwrap_or_else(|| Value::String(text.to_owned()))
}

fn graphs(document: &Table) -> Result<Vec<Graph>, SweepError> {
    let Some(value) = document.get("graphs") else { return Ok(Vec::new()) };
    let Value::Table(graphs) = value else {
        return Err(SweepError::value("graphs", value.to_string(), "tables `[graphs.NAME]`"));
    };
    let graph = |(name, value): (&String, &Value)| {
        let within = format!("graphs.{name}.");
        let Value::Table(table) = value else {
            return Err(SweepError::value(format!("graphs.{name}"), value.to_string(), "a table"));
        };
        refuse_unknown(&within, table, GRAPH_KEYS)?;
        let is_plain = |character: char| character.is_ascii_alphanumeric() || "_-".contains(character);
        if name.is_empty() || !name.chars().all(is_plain) {
            return Err(SweepError::value(
                format!("graphs.{name}"),
                "no name of a file",
                "letters, digits, _ and -",
            ));
        }
        let needed = |key: &str, expected: &str| -> Result<String, SweepError> {
            Ok(text_of(table, key)?.ok_or_else(|| missing(&format!("{within}{key}"), expected))?.to_owned())
        };
        let logarithmic = text_of(table, "logarithmic")?.unwrap_or_default();
        if !["", "x", "y", "xy"].contains(&logarithmic) {
            return Err(SweepError::value(format!("{within}logarithmic"), logarithmic, "x, y or xy"));
        }
        Ok(Graph {
            name: name.clone(),
            title: text_of(table, "title")?.map(str::to_owned),
            x: needed("x", "a path that varies, or a result")?,
            y: needed("y", "a result: a probe, PROBE.x, wall_seconds")?,
            lines: text_of(table, "lines")?.map(str::to_owned),
            logarithmic: ["x", "y"].map(|axis| logarithmic.contains(axis)),
        })
    };
    graphs.iter().map(graph).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const TABLE: &str = "a.b,c.d[0]\n1,\"[1, 2]\"\n\n5 kPa,tet4\n";

    fn study(text: &str) -> Result<Study, SweepError> {
        with_table(text, TABLE)
    }

    fn with_table(text: &str, table: &str) -> Result<Study, SweepError> {
        Study::parse(Path::new("study.toml"), text, |path| {
            assert_eq!(path, Path::new("runs.csv"));
            Ok(table.to_owned())
        })
    }

    /// All combinations, the last list running fastest, as settings of a scene.
    #[test]
    fn every_combination() {
        let read =
            study("scene = \"x.toml\"\n[vary]\n\"a.b\" = [1, 2.5]\n\"c\" = [\"tet4\", [1, 2]]\n").unwrap();
        let settings: Vec<Vec<String>> = read.runs.iter().map(Plan::settings).collect();
        assert_eq!(
            settings,
            [
                ["a.b=1", "c=\"tet4\""],
                ["a.b=1", "c=[1, 2]"],
                ["a.b=2.5", "c=\"tet4\""],
                ["a.b=2.5", "c=[1, 2]"]
            ]
        );
    }

    /// A table has a run for each line; what is no TOML is text.
    #[test]
    fn runs_from_a_table() {
        let read = study("scene = \"x.toml\"\ntable = \"runs.csv\"\n").unwrap();
        let settings: Vec<Vec<String>> = read.runs.iter().map(Plan::settings).collect();
        assert_eq!(settings, [["a.b=1", "c.d[0]=[1, 2]"], ["a.b=\"5 kPa\"", "c.d[0]=\"tet4\""]]);
    }

    /// What SQLite would refuse after the first run, and what would swallow the rest of a line, is refused with its line.
    #[test]
    fn faults_of_a_table_are_named() {
        let text = "scene = \"x.toml\"\ntable = \"runs.csv\"\n";
        for (table, words) in [
            ("a.b,c,a.b\n1,2,3\n", "`runs.csv, line 1` is `a.b` twice; expected different paths"),
            ("\n\na.b,\n1,2\n", "`runs.csv, line 3` is an empty path"),
            ("a.b,c\n1,\"[1, 2]\n", "`runs.csv, line 2` is a quote that is not closed"),
            ("a.b,\"c\n1,2\n", "`runs.csv, line 1` is a quote that is not closed"),
            ("a.b,c\n1\n", "`runs.csv, line 2` is 1 values; expected 2"),
            ("a.b,c\n", "0 lines of values"),
            ("", "`runs.csv, line 1` is empty"),
        ] {
            let message = with_table(text, table).map(|_| ()).unwrap_err().to_string();
            assert!(message.contains(words), "{table:?}: {message}");
        }
    }

    #[test]
    fn faults_are_named() {
        for (text, words) in [
            ("scene = 1\n", "`scene` is 1; expected a text"),
            ("scene = \"x\"\n", "`vary` is missing"),
            ("scene = \"x\"\n[vary]\na = 1\n", "`vary.\"a\"` is 1; expected a list"),
            ("scene = \"x\"\n[vary]\na = []\n", "a list of 0"),
            ("scene = \"x\"\nrepeat = 2\n", "`repeat` is unknown; expected one of title, scene"),
            ("scene = \"x\"\nsteps = 0\n[vary]\na = [1]\n", "`steps` is 0; expected a whole number above 0"),
            ("scene = \"x\"\n[vary]\na = [1]\n[graphs.g]\nx = \"a\"\n", "`graphs.g.y` is missing"),
            (
                "scene = \"x\"\n[vary]\na = [1]\n[graphs.g]\nx = \"a\"\ny = \"b\"\nlogarithmic = \"z\"\n",
                "x, y or xy",
            ),
            ("scene = \n", "TOML parse error at line 1"),
        ] {
            let message = study(text).map(|_| ()).unwrap_err().to_string();
            assert!(message.contains(words), "{text}: {message}");
        }
    }
}
