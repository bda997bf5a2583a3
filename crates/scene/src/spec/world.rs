//! The world, its systems, and what a run does by default.

use souple_engine::Detection;
use souple_engine::steppers::{self, BuildStepper};
use souple_formal::Formula;
use souple_math::Vec3;
use souple_models::loads::TIME_VARIABLES;
use souple_table::{Range, Value};

use super::boundary::{MOTION, MotionSpec, TURNING};
use crate::diagnostic::{Code, Site};
use crate::keys::{EntryShape, Key, Keys, NOWHERE, Others, Shape, outlines};
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
        Key::new(
            "collisions",
            Shape::Choice(&COLLISIONS),
            "when collisions are detected: by every step, which waits for it, or beside the steps of a period, on a thread of its own, for the next one",
        )
        .or(Value::Text(COLLISIONS[0])),
        Key::new("frame", Shape::Table(&FRAME), "a moving frame that all of the scene is seen from"),
    ],
);

const COLLISIONS: [&str; 2] = ["every_step", "one_period_late"];

pub(crate) static FRAME: Keys = Keys::new(
    "frame",
    "how the frame moves in a world at rest: carried by `motion`, turned by `rotation` about the `pivot`",
    &[
        Key::new("motion", Shape::Table(&MOTION), "where its pivot goes; it stays where left out"),
        Key::new("rotation", Shape::Table(&TURNING), "how it turns; it keeps its axes where left out"),
        Key::vector("pivot", "m", "where it turns").or(Value::Vector([0.0; 3])),
    ],
);

const STEPPER: EntryShape = EntryShape {
    tag: "name",
    kind: "stepper",
    outlines: || outlines(&steppers::TABLE),
    instead: &[],
    elsewhere: NOWHERE,
};

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
        Key::number("duration", "s", Range::POSITIVE, "simulated time").or(Value::Number(1.0)),
        Key::integer("frames", Range::closed(0.0, 1e6), "pictures of the state written along the way")
            .or(Value::Integer(30)),
        Key::integer("seed", Range::at_least(0.0), "of the random generators").or(Value::Integer(0)),
        Key::new("monitor", Shape::Table(&MONITOR), "watches energy that grows without work"),
    ],
);

static MONITOR: Keys = Keys::new(
    "monitor",
    "tells when there is more energy than work from outside can account for: a step that is too long makes it",
    &[
        Key::number(
            "growth",
            "",
            Range::POSITIVE,
            "how much more it may be, in the greatest kinetic energy of the first half of the time",
        )
        .or(Value::Number(1.0)),
        Key::new("stop", Shape::Boolean, "ends the run there as failed; it is warned of where left out")
            .or(Value::Boolean(false)),
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
    pub detection: Detection,
    pub detection_site: Site,
    /// How the frame moves that everything is seen from; `None`: it is at rest.
    pub frame: Option<FrameSpec>,
    pub site: Site,
}

/// A frame of reference that moves.
#[derive(Clone, Debug)]
pub struct FrameSpec {
    pub motion: Option<MotionSpec>,
    pub motion_site: Site,
    /// Rotation vector about the pivot [rad].
    pub rotation: Option<MotionSpec>,
    pub rotation_site: Site,
    /// [m]
    pub pivot: Vec3,
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
    /// Whether the scene tells it.
    pub has_duration: bool,
    pub frames: u64,
    pub seed: u64,
    pub monitor: Option<MonitorSpec>,
}

impl RunSpec {
    /// Of the scene, where it tells one: the command line may take another [s].
    pub fn written_duration(&self) -> Option<f64> {
        self.has_duration.then_some(self.duration)
    }
}

/// What of a run's energy is watched.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MonitorSpec {
    pub growth: f64,
    pub stops: bool,
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
            detection: match reader.choice("collisions") {
                late if late == COLLISIONS[1] => Detection::OnePeriodLate,
                _ => Detection::EveryStep,
            },
            detection_site: reader.site_of("collisions"),
            frame: reader.table("frame").map(|frame| FrameSpec::read(&frame)),
            site: reader.site(),
        }
    }
}

impl FrameSpec {
    fn read(reader: &Reader) -> Self {
        let motion = |key| reader.table(key).and_then(|table| MotionSpec::read(&table));
        let frame = Self {
            motion: motion("motion"),
            motion_site: reader.site_of("motion"),
            rotation: motion("rotation"),
            rotation_site: reader.site_of("rotation"),
            pivot: reader.vector("pivot"),
            site: reader.site(),
        };
        for (spec, site) in [(&frame.motion, &frame.motion_site), (&frame.rotation, &frame.rotation_site)] {
            if let Some(MotionSpec::KeyFrames { is_smooth: false, .. }) = spec {
                let message = "straight lines between key frames jump in velocity, and a frame that does is no place to be";
                reader.log().add(Code::Conflict, site, message, "`interpolation = \"smooth\"`, or a formula");
            }
        }
        frame
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
        let stepper =
            Some(Chosen { entry, values, site: site.clone(), written: Vec::new(), texts: Vec::new() });
        Self { name: DEFAULT_SYSTEM.to_owned(), stepper, steps_per_period: 1, site }
    }
}

impl RunSpec {
    pub(crate) fn read(reader: &Reader) -> Self {
        Self {
            duration: reader.number("duration"),
            has_duration: reader.has("duration"),
            frames: reader.maybe_integer("frames").unwrap_or(0) as u64,
            seed: reader.maybe_integer("seed").unwrap_or(0) as u64,
            monitor: reader.table("monitor").map(|monitor| MonitorSpec {
                growth: monitor.number("growth"),
                stops: monitor.boolean("stop"),
            }),
        }
    }
}

impl Default for RunSpec {
    fn default() -> Self {
        Self { duration: 1.0, has_duration: false, frames: 30, seed: 0, monitor: None }
    }
}
