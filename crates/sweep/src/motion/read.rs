//! What a study says of a motion.

use std::path::Path;

use toml::{Table, Value};

use super::{Cost, KeyState, Kind, Motion, Quantity, Spacetime, When, Windows};
use crate::SweepError;
use crate::fit::{Wanted, as_number, as_quantity, is_moderate, refuse_unknown};

const KEYS: &[&str] =
    &["kind", "keys", "weights", "tolerance", "iterations", "windows", "start", "starts", "seed"];
const LINEAR_QUADRATIC_KEYS: &[&str] =
    &["kind", "keys", "weights", "tolerance", "iterations", "costs", "duration"];
const KEY_KEYS: &[&str] = &["time", "from", "until", "probe", "value", "least", "most"];
const WEIGHTED_KEY_KEYS: &[&str] = &["time", "probe", "value", "weight"];
const COST_KEYS: &[&str] = &["probe", "value", "weight"];
const WINDOW_KEYS: &[&str] = &["from", "until"];
const SLIDING_KEYS: &[&str] = &["length", "overlap"];
const WEIGHT: &str = "a number above 0, 1e100 at most";
/// Starts, at most.
const MOST_STARTS: usize = 10_000;

impl Motion {
    /// # Errors
    /// A key is missing or unknown, or has a value that cannot be.
    pub(crate) fn read(table: &Table, folder: &Path) -> Result<Self, SweepError> {
        let found = |key: &str| table.get(key).map_or("missing".to_owned(), Value::to_string);
        let kind = match table.get("kind").and_then(Value::as_str) {
            Some("spacetime") => {
                refuse_unknown("plan.", table, KEYS)?;
                Kind::Spacetime(Spacetime::read(table, folder)?)
            }
            Some("linear_quadratic") => {
                refuse_unknown("plan.", table, LINEAR_QUADRATIC_KEYS)?;
                Kind::linear_quadratic(table)?
            }
            _ => {
                let expected = "\"spacetime\", \"linear_quadratic\" or \"state_space\"";
                return Err(SweepError::value("plan.kind", found("kind"), expected));
            }
        };
        let keys = match table.get("keys") {
            Some(Value::Array(keys)) if !keys.is_empty() => keys.as_slice(),
            None if matches!(&kind, Kind::LinearQuadratic { costs, duration: Some(_) } if !costs.is_empty()) => {
                &[]
            }
            _ => {
                let expected = match kind {
                    Kind::Spacetime(_) => "tables `[[plan.keys]]`",
                    Kind::LinearQuadratic { .. } => {
                        "tables `[[plan.keys]]`, or `[[plan.costs]]` and a `duration`"
                    }
                };
                return Err(SweepError::value("plan.keys", found("keys"), expected));
            }
        };
        let keys = keys.iter().enumerate().map(|(index, key)| KeyState::read(&kind, index, key));
        let keys = keys.collect::<Result<_, _>>()?;
        let tolerance = match table.get("tolerance") {
            None => 1e-6,
            Some(value) => {
                as_number(value).filter(|share| *share > 0.0 && *share < 1.0).ok_or_else(|| {
                    SweepError::value("plan.tolerance", found("tolerance"), "a number above 0, below 1")
                })?
            }
        };
        let weights = match table.get("weights") {
            None => Vec::new(),
            Some(Value::Table(weights)) => weights.iter().map(weight).collect::<Result<_, _>>()?,
            Some(_) => {
                return Err(SweepError::value("plan.weights", found("weights"), "a table of controls"));
            }
        };
        Ok(Self { kind, keys, weights, tolerance, iterations: count(table, "iterations", 100, usize::MAX)? })
    }
}

fn weight((name, value): (&String, &Value)) -> Result<(String, f64), SweepError> {
    let weight = as_number(value).filter(|weight| *weight > 0.0 && is_moderate(weight));
    let place = format!("plan.weights.\"{name}\"");
    let weight = weight.ok_or_else(|| SweepError::value(place, value.to_string(), WEIGHT))?;
    Ok((name.clone(), weight))
}

/// A whole number above 0.
fn count(table: &Table, key: &str, usual: usize, most: usize) -> Result<usize, SweepError> {
    match table.get(key) {
        None => Ok(usual),
        Some(Value::Integer(count @ 1..)) if *count as usize <= most => Ok(*count as usize),
        Some(other) => {
            let expected = match most {
                usize::MAX => "a whole number above 0".to_owned(),
                most => format!("a whole number above 0, {most} at most"),
            };
            Err(SweepError::value(format!("plan.{key}"), other.to_string(), expected))
        }
    }
}

impl Spacetime {
    fn read(table: &Table, folder: &Path) -> Result<Self, SweepError> {
        let start = match table.get("start") {
            None => None,
            Some(Value::String(file)) => Some(folder.join(file)),
            Some(other) => {
                return Err(SweepError::value("plan.start", other.to_string(), "a file of planned commands"));
            }
        };
        let starts = count(table, "starts", 1, MOST_STARTS)?;
        let seed = match table.get("seed") {
            None => 1,
            Some(Value::Integer(seed @ 0..)) => *seed as u64,
            Some(other) => {
                return Err(SweepError::value(
                    "plan.seed",
                    other.to_string(),
                    "a whole number of at least 0",
                ));
            }
        };
        if starts == 1 && table.contains_key("seed") {
            return Err(SweepError::value(
                "plan.seed",
                "there beside one start",
                "a seed of several `starts`",
            ));
        }
        Ok(Self { windows: Windows::read(table.get("windows"))?, start, starts, seed })
    }
}

impl Windows {
    fn read(value: Option<&Value>) -> Result<Self, SweepError> {
        let expected = "a list of `{ from = …, until = … }`, or `{ length = …, overlap = … }`";
        match value {
            None => Ok(Self::Whole),
            Some(Value::Array(list)) if !list.is_empty() => {
                let spans = list.iter().enumerate().map(|(index, value)| {
                    let entry = Entry::read(format!("plan.windows[{index}]"), value, WINDOW_KEYS)?;
                    entry.span()
                });
                Ok(Self::Each(spans.collect::<Result<_, _>>()?))
            }
            Some(value @ Value::Table(_)) => {
                let entry = Entry::read("plan.windows".to_owned(), value, SLIDING_KEYS)?;
                let length = entry.seconds("length").filter(|length| *length > 0.0);
                let length = length.ok_or_else(|| entry.fault("length", "seconds above 0"))?;
                let overlap = match entry.get("overlap") {
                    None => None,
                    Some(_) => {
                        let overlap = entry.seconds("overlap").filter(|it| (0.0..length).contains(it));
                        let expected = "seconds from 0 to below the length";
                        Some(overlap.ok_or_else(|| entry.fault("overlap", expected))?)
                    }
                };
                Ok(Self::Sliding { length, overlap })
            }
            Some(other) => Err(SweepError::value("plan.windows", other.to_string(), expected)),
        }
    }
}

impl Kind {
    fn linear_quadratic(table: &Table) -> Result<Self, SweepError> {
        let duration = match table.get("duration") {
            None => None,
            Some(value) => {
                let seconds =
                    as_quantity(value, "s").filter(|seconds| *seconds > 0.0 && is_moderate(seconds));
                Some(seconds.ok_or_else(|| {
                    SweepError::value("plan.duration", value.to_string(), "seconds above 0, 1e100 at most")
                })?)
            }
        };
        let costs = match table.get("costs") {
            None => &[],
            Some(Value::Array(costs)) => costs.as_slice(),
            Some(value) => {
                return Err(SweepError::value("plan.costs", value.to_string(), "tables `[[plan.costs]]`"));
            }
        };
        let costs = costs.iter().enumerate().map(|(index, cost)| Cost::read(index, cost));
        Ok(Self::LinearQuadratic { costs: costs.collect::<Result<_, _>>()?, duration })
    }
}

/// A table of a list, with its place in messages.
struct Entry<'a> {
    place: String,
    table: Option<&'a Table>,
}

impl<'a> Entry<'a> {
    fn read(place: String, value: &'a Value, keys: &[&str]) -> Result<Self, SweepError> {
        let table = value.as_table();
        if let Some(table) = table {
            refuse_unknown(&format!("{place}."), table, keys)?;
        }
        Ok(Self { place, table })
    }

    fn get(&self, key: &str) -> Option<&'a Value> {
        self.table.and_then(|table| table.get(key))
    }

    fn has(&self, key: &str) -> bool {
        self.get(key).is_some()
    }

    fn fault(&self, key: &str, expected: &str) -> SweepError {
        let found = self.get(key).map_or("missing".to_owned(), Value::to_string);
        SweepError::value(format!("{}.{key}", self.place), found, expected)
    }

    fn number(&self, key: &str) -> Option<f64> {
        self.get(key).and_then(as_number).filter(is_moderate)
    }

    fn seconds(&self, key: &str) -> Option<f64> {
        self.get(key).and_then(|value| as_quantity(value, "s")).filter(is_moderate)
    }

    fn probe(&self) -> Result<Wanted, SweepError> {
        let probe = self.get("probe").and_then(Value::as_str);
        let expected = "a probe of the scene, with .x, .y or .z of a vector";
        let probe = probe.ok_or_else(|| self.fault("probe", expected))?;
        Ok(Wanted::read(format!("{}.probe", self.place), probe))
    }

    fn value(&self) -> Result<f64, SweepError> {
        self.measured("value")
    }

    /// A number of the probe, which may have a unit that [`Quantity::check`] has to look at.
    fn measured(&self, key: &str) -> Result<f64, SweepError> {
        let number = match self.get(key) {
            Some(Value::String(text)) => {
                souple_formal::parse_quantity(text).ok().map(|quantity| quantity.value).filter(is_moderate)
            }
            _ => self.number(key),
        };
        number.ok_or_else(|| self.fault(key, "a finite number, 1e100 at most, or one with its unit"))
    }

    /// Numbers of the probe that have a unit.
    fn quantities(&self) -> Vec<Quantity> {
        let with_unit = ["value", "least", "most"].into_iter().filter_map(|key| {
            let text = self.get(key)?.as_str()?.to_owned();
            Some(Quantity { key: format!("{}.{key}", self.place), text })
        });
        with_unit.collect()
    }

    fn weight(&self) -> Result<f64, SweepError> {
        let weight = self.number("weight").filter(|weight| *weight > 0.0);
        weight.ok_or_else(|| self.fault("weight", WEIGHT))
    }

    /// `from` and `until`, the first before the second [s].
    fn span(&self) -> Result<[f64; 2], SweepError> {
        let from = self.seconds("from").filter(|from| *from >= 0.0);
        let from = from.ok_or_else(|| self.fault("from", "seconds of at least 0"))?;
        let until = self.seconds("until").filter(|until| *until > 0.0);
        let until = until.ok_or_else(|| self.fault("until", "seconds above 0"))?;
        if from > until {
            let found = format!("from {from} s until {until} s");
            return Err(SweepError::value(self.place.clone(), found, "`from` before `until`"));
        }
        Ok([from, until])
    }

    /// A `time`, or `from` and `until`.
    fn when(&self) -> Result<When, SweepError> {
        if !self.has("from") && !self.has("until") {
            let time = self.seconds("time").filter(|time| *time > 0.0);
            return time.map(When::At).ok_or_else(|| self.fault("time", "seconds above 0"));
        }
        if self.has("time") {
            return Err(self.fault("time", "a `time`, or `from` and `until`"));
        }
        self.span().map(When::During)
    }

    /// A `value`, or `least` and `most` or one of them.
    fn band(&self) -> Result<[f64; 2], SweepError> {
        if !self.has("least") && !self.has("most") {
            return self.value().map(|value| [value; 2]);
        }
        if self.has("value") {
            return Err(self.fault("value", "a `value`, or `least` and `most` or one of them"));
        }
        let side = |key: &str, open: f64| match self.get(key) {
            None => Ok(open),
            Some(_) => self.measured(key),
        };
        let band = [side("least", f64::NEG_INFINITY)?, side("most", f64::INFINITY)?];
        if band[0] > band[1] {
            let found = format!("at least {} and at most {}", band[0], band[1]);
            return Err(SweepError::value(self.place.clone(), found, "`least` below `most`"));
        }
        Ok(band)
    }
}

impl Cost {
    fn read(index: usize, value: &Value) -> Result<Self, SweepError> {
        let entry = Entry::read(format!("plan.costs[{index}]"), value, COST_KEYS)?;
        Ok(Self {
            probe: entry.probe()?,
            value: entry.value()?,
            weight: entry.weight()?,
            quantities: entry.quantities(),
        })
    }
}

impl KeyState {
    fn read(kind: &Kind, index: usize, value: &Value) -> Result<Self, SweepError> {
        let keys = match kind {
            Kind::Spacetime(_) => KEY_KEYS,
            Kind::LinearQuadratic { .. } => WEIGHTED_KEY_KEYS,
        };
        let entry = Entry::read(format!("plan.keys[{index}]"), value, keys)?;
        Ok(Self {
            probe: entry.probe()?,
            when: entry.when()?,
            band: entry.band()?,
            weight: entry.get("weight").map(|_| entry.weight()).transpose()?,
            quantities: entry.quantities(),
        })
    }
}
