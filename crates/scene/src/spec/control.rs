//! Controls of a network: modules that make and break connections, and modules that turn a parameter.

use souple_formal::{Condition, Formula, ParseError};
use souple_table::{Range, Value};

use crate::diagnostic::{Code, Site};
use crate::keys::{Key, Keys, Shape};
use crate::reader::Reader;

/// What controls may refer to, before their inputs.
pub const VARIABLES: [&str; 2] = ["t", "previous"];
/// Inputs of a control, at most.
pub const INPUTS: usize = 14;
/// Numbers of a state that a table is over, at most.
pub const STATES: usize = 4;

static INPUT: Keys = Keys::new(
    "control_input",
    "what a control reads of masses, where they are at the start of a period",
    &[
        Key::new("of", Shape::Text, "a group, a part or a port: their mean").required(),
        Key::new(
            "quantity",
            Shape::Choice(&["position", "velocity", "speed", "distance"]),
            "of the mean; `distance` [m] is that from the mean of `to`, `speed` [m/s] how fast the mean is",
        )
        .required(),
        Key::new("to", Shape::Text, "of distances: the other group"),
        Key::new("component", Shape::Choice(&["x", "y", "z"]), "of positions and velocities"),
    ],
);

static STATE: Keys = Keys::new(
    "control_state",
    "a number of the state that a table of commands is over",
    &[Key::new("value", Shape::Text, "a formula of the inputs").required()],
);

pub(super) static CONTROL: Keys = Keys::new(
    "control",
    "what makes and breaks links or crowds, turns a parameter of their law, or commands an actuator while the world runs",
    &[
        Key::new("links", Shape::Text, "the `name` of the tables of links"),
        Key::new("crowds", Shape::Text, "or that of crowds or encounters"),
        Key::new("actuator", Shape::Text, "or the name of an actuator, which `value` commands [N]"),
        Key::new(
            "connects",
            Shape::Text,
            "a condition on t, previous (1 while connected) and the inputs: what it drives acts while it holds",
        ),
        Key::number(
            "ramp",
            "s",
            Range::NOT_NEGATIVE,
            "of `connects`: how long it takes from nothing to the whole",
        )
        .or(Value::Number(0.0)),
        Key::new("parameter", Shape::Text, "what is turned"),
        Key::new(
            "value",
            Shape::Text,
            "its value, or the command of an actuator, in its SI unit: a formula of t, previous and the inputs",
        ),
        Key::new(
            "plan",
            Shape::Text,
            "or a file of the commands of an actuator, as `souple sweep` plans them, relative to the scene file",
        ),
        Key::new(
            "feedback",
            Shape::Boolean,
            "of `plan`: whether the gains of the file, where it has some, answer to deviations from the planned motion; they do where left out",
        ),
        Key::new(
            "table",
            Shape::Text,
            "or a file of the commands of an actuator over a state space, as `souple sweep` makes them, relative to the scene file",
        ),
        Key::new(
            "states",
            Shape::Named(&STATE),
            "of `table`: the numbers that its columns are of, by their names; the inputs themselves where left out",
        ),
        Key::new(
            "lookup",
            Shape::Choice(&["linear", "nearest"]),
            "of `table`: commands between entries by linear interpolation, or those of the nearest entry; `linear` where left out",
        ),
        Key::new("inputs", Shape::Named(&INPUT), "what it reads, by the names that it uses"),
    ],
);

/// A control as it is written.
pub struct ControlSpec {
    pub name: String,
    /// What it drives.
    pub of: Driven<String>,
    pub drives: Option<Drives>,
    pub inputs: Vec<InputSpec>,
    pub site: Site,
}

/// Links, crowds or an actuator, by what controls call them.
#[derive(Clone, Debug, PartialEq)]
pub enum Driven<N> {
    Links(N),
    Crowds(N),
    Actuator(N),
}

/// What a control does.
pub enum Drives {
    Connection {
        holds: Condition,
        /// [s]
        ramp: f64,
    },
    Parameter {
        name: String,
        value: Formula,
    },
    /// Of an actuator [N].
    Command(Formula),
    /// The file of the commands of an actuator, period by period.
    Plan {
        file: String,
        site: Site,
        feedback: Feedback,
    },
    /// The commands of an actuator over a state space; none at all where there is no file yet.
    Table {
        file: Option<(String, Site)>,
        states: Vec<StateSpec>,
        lookup: Lookup,
    },
}

/// A number of the state that a table is over.
#[derive(Clone, Debug)]
pub struct StateSpec {
    pub name: String,
    /// Of the inputs; the input of its name where `None`.
    pub value: Option<Formula>,
}

/// What a table says between its entries.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lookup {
    /// Commands, interpolated linearly along each axis.
    Linear,
    /// The command of the nearest entry.
    Nearest,
}

/// What is made of the gains of a plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Feedback {
    /// They answer to deviations from the planned motion.
    AsPlanned,
    /// They are left aside: commands alone.
    Without,
}

/// What a control reads.
pub struct InputSpec {
    pub of: String,
    pub to: String,
    pub quantity: &'static str,
    /// Of x, y, z.
    pub component: Option<usize>,
    pub site: Site,
}

impl ControlSpec {
    pub(super) fn read(name: String, reader: &Reader) -> Self {
        let inputs = reader.named("inputs");
        let names: Vec<&str> = inputs.iter().map(|(name, _)| name.as_str()).collect();
        let refuse = |key: &str, message: String, expected: &str| {
            reader.log().add(Code::Conflict, &reader.site_of(key), message, expected);
        };
        if names.len() > INPUTS {
            refuse("inputs", format!("{} inputs", names.len()), &format!("at most {INPUTS}"));
        }
        for taken in names.iter().filter(|name| VARIABLES.contains(name)) {
            refuse("inputs", format!("`{taken}` is what controls know already"), "another name");
        }
        let variables: Vec<&str> = VARIABLES.iter().chain(&names).copied().collect();
        let wrong = |key: &str, error: &ParseError| {
            let expected = format!("a formula of {}", variables.join(", "));
            reader.log().add(
                Code::BadFormula,
                &reader.site_of_part(key, error.span()),
                error.without_place(),
                expected,
            );
        };
        let is_of_actuator = reader.has("actuator");
        if reader.has("ramp") && !reader.has("connects") {
            refuse("ramp", format!("control `{name}` connects nothing"), "`ramp` beside `connects`");
        }
        let drives = match reader.written(&["connects", "parameter", "value", "plan", "table"])[..] {
            ["value"] if is_of_actuator => Formula::compile(&reader.text("value"), &variables)
                .map(Drives::Command)
                .map_err(|error| wrong("value", &error))
                .ok(),
            ["plan"] if is_of_actuator => {
                let is_without = reader.has("feedback") && !reader.boolean("feedback");
                let feedback = if is_without { Feedback::Without } else { Feedback::AsPlanned };
                Some(Drives::Plan { file: reader.text("plan"), site: reader.site_of("plan"), feedback })
            }
            ["table"] if is_of_actuator => {
                let states = states(reader, &names);
                if states.is_empty() || states.len() > STATES {
                    refuse(
                        "table",
                        format!("a state of {} numbers", states.len()),
                        &format!("1 to {STATES}"),
                    );
                }
                let is_nearest = reader.has("lookup") && reader.choice("lookup") == "nearest";
                Some(Drives::Table {
                    file: Some((reader.text("table"), reader.site_of("table"))),
                    states,
                    lookup: if is_nearest { Lookup::Nearest } else { Lookup::Linear },
                })
            }
            _ if is_of_actuator => {
                let message = format!("control `{name}` commands an actuator");
                refuse("actuator", message, "value, plan or table, alone");
                None
            }
            ["connects"] => Condition::compile(&reader.text("connects"), &variables)
                .map(|holds| Drives::Connection { holds, ramp: reader.number("ramp") })
                .map_err(|error| wrong("connects", &error))
                .ok(),
            ["parameter", "value"] => Formula::compile(&reader.text("value"), &variables)
                .map(|value| Drives::Parameter { name: reader.text("parameter"), value })
                .map_err(|error| wrong("value", &error))
                .ok(),
            _ => {
                refuse(
                    "parameter",
                    format!("control `{name}` does not say what it does"),
                    "connects, or parameter and value; with an actuator value, plan or table",
                );
                None
            }
        };
        if reader.has("feedback") && !reader.has("plan") {
            refuse(
                "feedback",
                format!("control `{name}` has no plan"),
                "`plan` beside it, whose gains it is about",
            );
        }
        if let Some(key) =
            ["states", "lookup"].into_iter().find(|key| reader.has(key) && !reader.has("table"))
        {
            refuse(key, format!("control `{name}` has no table"), "`table` beside it");
        }
        let inputs = inputs.iter().map(|(name, input)| InputSpec::read(name, input)).collect();
        let written = reader.written(&["links", "crowds", "actuator"]);
        let of = match written[..] {
            ["actuator"] => Driven::Actuator(reader.text("actuator")),
            ["crowds"] => Driven::Crowds(reader.text("crowds")),
            ["links"] => Driven::Links(reader.text("links")),
            [] => {
                let message = format!("control `{name}` does not say what it drives");
                reader.log().add(
                    Code::MissingKey,
                    &reader.site(),
                    message,
                    "links, crowds or actuator: a name",
                );
                Driven::Links(String::new())
            }
            _ => {
                refuse(
                    written[written.len() - 1],
                    format!("control `{name}` drives several things"),
                    "one of links, crowds, actuator",
                );
                Driven::Links(String::new())
            }
        };
        Self { name, of, drives, inputs, site: reader.site() }
    }
}

/// Numbers of the state of a table, by formulas of these inputs; the inputs themselves where there are none.
fn states(reader: &Reader, inputs: &[&str]) -> Vec<StateSpec> {
    if !reader.has("states") {
        return inputs.iter().map(|name| StateSpec { name: (*name).to_owned(), value: None }).collect();
    }
    let read = |(name, state): (String, Reader)| {
        let value = Formula::compile(&state.text("value"), inputs);
        if let Err(error) = &value {
            let (site, expected) =
                (state.site_of_part("value", error.span()), format!("a formula of {}", inputs.join(", ")));
            state.log().add(Code::BadFormula, &site, error.without_place(), expected);
        }
        Some(StateSpec { name, value: Some(value.ok()?) })
    };
    reader.named("states").into_iter().filter_map(read).collect()
}

impl<N: AsRef<str>> Driven<N> {
    pub fn name(&self) -> &str {
        match self {
            Self::Links(name) | Self::Crowds(name) | Self::Actuator(name) => name.as_ref(),
        }
    }

    /// In words.
    pub fn noun(&self) -> &'static str {
        match self {
            Self::Links(_) => "links",
            Self::Crowds(_) => "crowds",
            Self::Actuator(_) => "actuators",
        }
    }

    /// Whether it is this, and has a name.
    pub fn is<M: AsRef<str>>(&self, other: &Driven<M>) -> bool {
        self.noun() == other.noun() && self.name() == other.name() && !self.name().is_empty()
    }
}

impl InputSpec {
    fn read(name: &str, reader: &Reader) -> Self {
        let quantity = reader.choice("quantity");
        let component = reader.has("component").then(|| match reader.choice("component") {
            "x" => 0,
            "y" => 1,
            _ => 2,
        });
        let (of, to) = (reader.text("of"), reader.text("to"));
        let refuse = |key: &str, message: String, expected: &str| {
            reader.log().add(Code::Conflict, &reader.site_of(key), message, expected);
        };
        match (quantity, component, to.is_empty()) {
            ("position" | "velocity", None, _) => {
                refuse(
                    "quantity",
                    format!("input `{name}` is a vector"),
                    "component = \"x\", \"y\" or \"z\"",
                );
            }
            ("distance", _, true) => {
                refuse("quantity", format!("input `{name}` is a distance from nothing"), "to = \"a group\"");
            }
            _ => {}
        }
        Self { of, to, quantity, component, site: reader.site() }
    }
}
