//! What moves a skin: terms that add up to the speed along its outward normal.
//!
//! `v_n = α (G − iso) − β κ + γ_A (A0 − A)/A0 + γ_V (V0 − V)/V0 + …`, each term one entry of [`TERMS`].

use souple_formal::Formula;
use souple_math::Vec3;
use souple_table::{Entry, Parameter, Range, Table, Value, Values};

/// A skin as a whole, for terms that look at all of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Whole {
    /// [s]
    pub time: f64,
    /// [m²]
    pub area: f64,
    /// [m³]
    pub volume: f64,
    /// At the start.
    pub rest_area: f64,
    pub rest_volume: f64,
}

/// What a skin's size gains for each metre that all of it moves outward.
struct Growth {
    /// [m²/m]
    area: f64,
    /// [m³/m]
    volume: f64,
}

impl Whole {
    /// `dV/ds = A`, and the area's as of a ball: `dA/ds = 2 A/R` with `R = 3 V/A`.
    fn growth(&self) -> Growth {
        let of_ball = 2.0 / 3.0 * self.area * self.area / self.volume;
        Growth { area: if self.volume > 0.0 { of_ball } else { 0.0 }, volume: self.area }
    }
}

/// The surface points of a skin, with the target's potential less its iso value there.
#[derive(Clone, Copy, Debug)]
pub struct SurfacePoints<'a> {
    pub points: &'a [Vec3],
    /// Zero without a target.
    pub excess: &'a [f64],
}

/// One term of the speed, positive outward [m/s].
pub trait Term: Send + Sync {
    /// The same everywhere.
    fn uniform(&self, _whole: &Whole) -> f64 {
        0.0
    }

    /// What it would need at a moment at which its speed is no number.
    fn expected(&self, _whole: &Whole) -> String {
        "a formula that has a number at that time".to_owned()
    }

    /// How fast the term at a point answers a change of the whole skin's size that it made itself [1/s]: by what speed for each
    /// metre that the whole skin moves. It limits sub-steps.
    fn answer(&self, _point: Vec3, _excess: f64, _whole: &Whole) -> f64 {
        0.0
    }

    /// Whether it looks at the skin's area or volume.
    fn looks_at_size(&self) -> bool {
        false
    }

    /// Whether it depends on time.
    fn is_timed(&self) -> bool {
        false
    }

    /// How much the speed at a point changes with the potential there [m/s]. With the slope of the target it limits sub-steps.
    fn stiffness(&self, _point: Vec3, _excess: f64, _whole: &Whole) -> f64 {
        0.0
    }

    /// Whether [`Term::add_at`] adds anything.
    fn varies(&self) -> bool {
        self.needs_target()
    }

    /// `out += speed` at each point.
    fn add_at(&self, _at: SurfacePoints, _whole: &Whole, _out: &mut [f64]) {}

    /// `β` of a term `−β κ` [m²/s].
    fn tension(&self) -> f64 {
        0.0
    }

    /// Whether it needs a target.
    fn needs_target(&self) -> bool {
        false
    }

    /// Whether it draws the skin together where the target is not.
    fn draws_to_target(&self) -> bool {
        false
    }
}

/// Why a term cannot be made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("`{parameter}` of the term `{term}`: {message}")]
pub struct TermError {
    pub term: &'static str,
    pub parameter: &'static str,
    pub message: String,
}

/// Constructor of a term from completed values.
pub type BuildTerm = fn(&Values) -> Result<Box<dyn Term>, TermError>;
type TermEntry = Entry<BuildTerm>;

/// All terms of the speed of a skin.
pub static TERMS: Table<BuildTerm> = Table {
    kind: "skin term",
    entries: &[&ATTRACTION, &TENSION, &CONSTANT_AREA, &CONSTANT_VOLUME, &PRESSURE, &SPEED],
};

const SOURCE: &str = "Desbrun & Cani-Gascuel 1998, Active implicit surface for animation";

/// A formula, or `None` for an empty text.
fn formula(
    values: &Values,
    term: &'static str,
    parameter: &'static str,
    variables: &[&str],
) -> Result<Option<Formula>, TermError> {
    let text = values.text(parameter).trim();
    if text.is_empty() {
        return Ok(None);
    }
    Formula::compile(text, variables).map(Some).map_err(|error| TermError {
        term,
        parameter,
        message: error.to_string(),
    })
}

struct Attraction(f64);

impl Term for Attraction {
    // α (G − iso)
    fn add_at(&self, at: SurfacePoints, _: &Whole, out: &mut [f64]) {
        out.iter_mut().zip(at.excess).for_each(|(out, excess)| *out += self.0 * excess);
    }

    fn stiffness(&self, _: Vec3, _: f64, _: &Whole) -> f64 {
        self.0
    }

    fn needs_target(&self) -> bool {
        true
    }

    fn draws_to_target(&self) -> bool {
        self.0 > 0.0
    }
}

static ATTRACTION: TermEntry = Entry {
    name: "attraction",
    summary: "to the target: alpha (G - iso)",
    source: SOURCE,
    parameters: &[Parameter::number(
        "strength",
        "m/s",
        Range::NOT_NEGATIVE,
        "alpha, speed where the potential is one more than its iso value",
    )],
    build: |values| Ok(Box::new(Attraction(values.number("strength")))),
};

struct Tension(f64);

impl Term for Tension {
    fn tension(&self) -> f64 {
        self.0
    }
}

static TENSION: TermEntry = Entry {
    name: "tension",
    summary: "of the surface: -beta kappa, makes the area smaller; a sphere shrinks as R^2 = R0^2 - 4 beta t",
    source: SOURCE,
    parameters: &[Parameter::number("strength", "m^2/s", Range::NOT_NEGATIVE, "beta")],
    build: |values| Ok(Box::new(Tension(values.number("strength")))),
};

const TIME: &[&str] = &["t"];

/// What is held constant.
#[derive(Clone, Copy)]
enum Held {
    Area,
    Volume,
}

struct Constant {
    rate: f64,
    /// Of time; what it was at the start where `None`.
    goal: Option<Formula>,
    held: Held,
}

impl Constant {
    fn goal(&self, whole: &Whole) -> f64 {
        let rest = match self.held {
            Held::Area => whole.rest_area,
            Held::Volume => whole.rest_volume,
        };
        self.goal.as_ref().map_or(rest, |goal| goal.evaluate(&[whole.time]))
    }
}

impl Term for Constant {
    // γ (goal − now)/goal
    fn uniform(&self, whole: &Whole) -> f64 {
        let now = match self.held {
            Held::Area => whole.area,
            Held::Volume => whole.volume,
        };
        let goal = self.goal(whole);
        if goal > 0.0 && goal.is_finite() { self.rate * (goal - now) / goal } else { f64::NAN }
    }

    fn expected(&self, whole: &Whole) -> String {
        let unit = match self.held {
            Held::Area => "m²",
            Held::Volume => "m³",
        };
        format!("a goal above 0, which is {} {unit}", self.goal(whole))
    }

    fn answer(&self, _: Vec3, _: f64, whole: &Whole) -> f64 {
        let goal = self.goal(whole);
        if goal <= 0.0 {
            return 0.0;
        }
        let Growth { area, volume } = whole.growth();
        let change = match self.held {
            Held::Area => area,
            Held::Volume => volume,
        };
        self.rate * change / goal
    }

    fn looks_at_size(&self) -> bool {
        self.rate != 0.0
    }

    fn is_timed(&self) -> bool {
        self.goal.is_some()
    }
}

static CONSTANT_AREA: TermEntry = Entry {
    name: "constant_area",
    summary: "gamma_A (A0 - A)/A0: the area goes to that of the start, or to one given",
    source: SOURCE,
    parameters: &[
        Parameter::number("rate", "m/s", Range::NOT_NEGATIVE, "gamma_A"),
        Parameter::text("area", "A0 [m^2], above 0, as a formula of t; empty: that of the start")
            .or(Value::Text("")),
    ],
    build: |values| {
        let goal = formula(values, "constant_area", "area", TIME)?;
        Ok(Box::new(Constant { rate: values.number("rate"), goal, held: Held::Area }))
    },
};

static CONSTANT_VOLUME: TermEntry = Entry {
    name: "constant_volume",
    summary: "gamma_V (V0 - V)/V0: the volume goes to that of the start, or to one given",
    source: SOURCE,
    parameters: &[
        Parameter::number("rate", "m/s", Range::NOT_NEGATIVE, "gamma_V"),
        Parameter::text("volume", "V0 [m^3], above 0, as a formula of t; empty: that of the start")
            .or(Value::Text("")),
    ],
    build: |values| {
        let goal = formula(values, "constant_volume", "volume", TIME)?;
        Ok(Box::new(Constant { rate: values.number("rate"), goal, held: Held::Volume }))
    },
};

struct Pressure(Formula);

impl Term for Pressure {
    fn uniform(&self, whole: &Whole) -> f64 {
        self.0.evaluate(&[whole.time])
    }

    fn is_timed(&self) -> bool {
        true
    }
}

static PRESSURE: TermEntry = Entry {
    name: "pressure",
    summary: "a speed that is the same everywhere, outward where positive",
    source: SOURCE,
    parameters: &[Parameter::text("speed", "[m/s] as a formula of t")],
    build: |values| {
        let speed = formula(values, "pressure", "speed", TIME)?;
        let missing =
            || TermError { term: "pressure", parameter: "speed", message: "it is empty".to_owned() };
        Ok(Box::new(Pressure(speed.ok_or_else(missing)?)))
    },
};

struct Speed(Formula);

const SPEED_VARIABLES: &[&str] = &["x", "y", "z", "t", "g", "area", "volume"];
/// Where `t`, `g`, `area` and `volume` stand among them.
const AT_TIME: usize = 3;
const POTENTIAL: usize = 4;
const AREA: usize = 5;
const VOLUME: usize = 6;

fn speed_values(p: Vec3, excess: f64, whole: &Whole) -> [f64; SPEED_VARIABLES.len()] {
    [p.x, p.y, p.z, whole.time, excess, whole.area, whole.volume]
}

impl Term for Speed {
    fn varies(&self) -> bool {
        true
    }

    fn needs_target(&self) -> bool {
        self.0.depends_on(POTENTIAL)
    }

    fn add_at(&self, at: SurfacePoints, whole: &Whole, out: &mut [f64]) {
        for ((out, p), excess) in out.iter_mut().zip(at.points).zip(at.excess) {
            *out += self.0.evaluate(&speed_values(*p, *excess, whole));
        }
    }

    fn stiffness(&self, point: Vec3, excess: f64, whole: &Whole) -> f64 {
        let change = self.0.differentiate(&speed_values(point, excess, whole), POTENTIAL).derivative;
        // a formula without a slope here has none that could be followed
        if change.is_finite() { change.abs() } else { 0.0 }
    }

    // -(∂v/∂A dA/ds + ∂v/∂V dV/ds): what grows by its own growth runs away, and is not overshot
    fn answer(&self, point: Vec3, excess: f64, whole: &Whole) -> f64 {
        if !self.looks_at_size() {
            return 0.0;
        }
        let values = speed_values(point, excess, whole);
        let slope = |of: usize| self.0.differentiate(&values, of).derivative;
        let Growth { area, volume } = whole.growth();
        let change = -(slope(AREA) * area + slope(VOLUME) * volume);
        if change.is_finite() { change.max(0.0) } else { 0.0 }
    }

    fn looks_at_size(&self) -> bool {
        self.0.depends_on(AREA) || self.0.depends_on(VOLUME)
    }

    fn is_timed(&self) -> bool {
        self.0.depends_on(AT_TIME)
    }
}

static SPEED: TermEntry = Entry {
    name: "speed",
    summary: "a speed written as text, outward where positive",
    source: "own",
    parameters: &[Parameter::text(
        "formula",
        "[m/s] of x, y, z [m], t [s], g (the target's potential less its iso value), area [m^2], volume [m^3]",
    )],
    build: |values| {
        let speed = formula(values, "speed", "formula", SPEED_VARIABLES)?;
        let missing = || TermError { term: "speed", parameter: "formula", message: "it is empty".to_owned() };
        Ok(Box::new(Speed(speed.ok_or_else(missing)?)))
    },
};
