//! The world, its systems, and what a run does by default.

use souple_engine::steppers::{self, BuildStepper};
use souple_formal::Formula;
use souple_models::loads::TIME_VARIABLES;
use souple_table::{Range, Value};

use crate::diagnostic::Site;
use crate::keys::{EntryShape, Key, Keys, Others, Shape, outlines};
use crate::reader::{Chosen, Reader};

/// Most steps a system makes in a period.
const STEPS_MAX: f64 = 1e6;
/// Longest run [periods] that is still counted exactly by times in `f64`.
pub const PERIODS_MAX: f64 = 1e15;

pub(crate) static WORLD: Keys = Keys::new(
    "world",
    "what all systems share",
    &[
        Key::number(
            "period",
            "s",
            Range::POSITIVE,
            "all systems meet at the ends of periods; frames and probes too",
        )
        .required(),
        Key::new(
            "gravity",
            Shape::VectorFormula(&TIME_VARIABLES),
            "acceleration of everything that has mass: numbers, or formulas of time; none where left out",
        )
        .in_unit("m/s^2"),
    ],
);

const STEPPER: EntryShape =
    EntryShape { tag: "name", kind: "stepper", outlines: || outlines(&steppers::TABLE), instead: &[] };

pub(crate) static SYSTEM: Keys = Keys {
    name: "system",
    summary: "bodies that step together; the stepper's parameters stand beside it or in its table",
    keys: &[
        Key::new("stepper", Shape::Entry(STEPPER), "how the system steps in time").required(),
        Key::integer("steps_per_period", Range::closed(1.0, STEPS_MAX), "steps in a period of the world")
            .or(Value::Integer(1)),
    ],
    others: Others::ParametersOf("stepper"),
};

pub(crate) static RUN: Keys = Keys::new(
    "run",
    "what `souple run` does unless told otherwise",
    &[
        Key::number("duration", "s", Range::NOT_NEGATIVE, "simulated time").or(Value::Number(1.0)),
        Key::integer("frames", Range::closed(0.0, 1e6), "pictures of the state written along the way")
            .or(Value::Integer(30)),
        Key::integer("seed", Range::at_least(0.0), "of the random generators").or(Value::Integer(0)),
    ],
);

/// What all systems share.
#[derive(Clone, Debug)]
pub struct WorldSpec {
    /// [s]
    pub period: f64,
    pub period_site: Site,
    /// Of the time; `None`: there is none [m/s²].
    pub gravity: Option<[Formula; 3]>,
    pub gravity_site: Site,
    pub site: Site,
}

/// Bodies that step together.
pub struct SystemSpec {
    pub name: String,
    pub stepper: Option<Chosen<BuildStepper>>,
    pub steps_per_period: u32,
    pub site: Site,
}

/// Defaults of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RunSpec {
    /// [s]
    pub duration: f64,
    pub frames: u64,
    pub seed: u64,
}

/// The system where none is written.
pub const DEFAULT_SYSTEM: &str = "main";
/// How it steps.
pub const DEFAULT_STEPPER: &str = "backward_euler";

impl WorldSpec {
    pub(crate) fn read(reader: &Reader) -> Self {
        Self {
            period: reader.number("period"),
            period_site: reader.site_of("period"),
            gravity: reader.maybe_vector_formula("gravity"),
            gravity_site: reader.site_of("gravity"),
            site: reader.site(),
        }
    }
}

impl SystemSpec {
    pub(crate) fn read(name: String, reader: &Reader) -> Self {
        let stepper = reader.entry("stepper", &steppers::TABLE);
        if !reader.has("stepper") {
            reader.refuse_others();
        }
        let steps_per_period = reader.maybe_integer("steps_per_period").unwrap_or(1) as u32;
        Self { name, stepper, steps_per_period, site: reader.site() }
    }

    /// Backward Euler, one step per period.
    ///
    /// # Panics
    /// If the stepper's table lacks it: a bug.
    pub(crate) fn default_system(site: Site) -> Self {
        let entry = steppers::TABLE.find(DEFAULT_STEPPER).expect("the default stepper is in its table");
        let values = entry.values(souple_table::Values::new()).expect("the default stepper needs no values");
        let stepper = Some(Chosen { entry, values, site: site.clone(), written: Vec::new() });
        Self { name: DEFAULT_SYSTEM.to_owned(), stepper, steps_per_period: 1, site }
    }
}

impl RunSpec {
    pub(crate) fn read(reader: &Reader) -> Self {
        Self {
            duration: reader.number("duration"),
            frames: reader.maybe_integer("frames").unwrap_or(0) as u64,
            seed: reader.maybe_integer("seed").unwrap_or(0) as u64,
        }
    }
}

impl Default for RunSpec {
    fn default() -> Self {
        Self { duration: 1.0, frames: 30, seed: 0 }
    }
}
