//! Probes: what is measured along a run.

use souple_formal::Formula;
use souple_math::Vec3;
use souple_table::{Range, Value};

use super::boundary::LOAD_VARIABLES;
use super::quantity::{
    ContourQuantity, NAMES, PointQuantity, QUANTITIES, Quantity, QuantityEntry, Rank, Reduction, Subject,
};
use super::region::Region;
use crate::diagnostic::{Code, Site};
use crate::keys::{Key, Keys, Shape, one_of};
use crate::reader::Reader;

pub(crate) const COMPONENT: Key =
    Key::new("component", Shape::Choice(&["x", "y", "z", "length"]), "one number of a vector");

pub(crate) static AGAINST: Keys = Keys::new(
    "against",
    "what the values at points are the differences from: a `formula` or a `body`, one of them",
    &[
        Key::new(
            "formula",
            Shape::VectorFormula(LOAD_VARIABLES),
            "of the place where a point rests and of time, in the unit of the quantity",
        ),
        Key::new("body", Shape::Text, "another, whose shape at rest holds the points: its value there"),
    ],
);

pub(crate) static PROBE: Keys = Keys::new(
    "probe",
    "a quantity measured at the end of every period",
    &[
        Key::new("quantity", Shape::Choice(NAMES), "what is measured").required(),
        Key::new("body", Shape::Text, "whose; not for quantities of the world"),
        Key::new("region", Shape::Region, "where; the whole body where left out"),
        COMPONENT,
        Key::new(
            "reduce",
            Shape::Choice(&["mean", "sum", "min", "max", "mean_magnitude"]),
            "how the values of a region become one",
        ),
        Key::new("against", Shape::Table(&AGAINST), "what the values at points are the differences from"),
        Key::new("skin", Shape::Text, "whose, for quantities of skins; a body's skin has the body's name"),
        Key::new(
            "contact",
            Shape::Text,
            "only what this contact does, by its name, or that of a crowd or of a constraint of a network with a sense, balls or faces: `NETWORK.NAME` (for quantities of contacts)",
        ),
        Key::new(
            "constraint",
            Shape::Text,
            "only what this constraint of a network does, `NETWORK.NAME` (for constraint_force)",
        ),
        Key::new("hand", Shape::Text, "whose, for quantities of hands and their tools"),
        Key::new(
            "bone",
            Shape::Text,
            "which of those that frames of the body follow, for quantities of bones",
        ),
        Key::integer(
            "level",
            Range::NOT_NEGATIVE,
            "of a body with levels: only this one, counted from 0, the coarsest",
        ),
        Key::vector(
            "about",
            "m",
            "the place that moments are taken about, and that levels are near to; the centre of mass of the body where left out, of a bone and of levels the origin",
        ),
        Key::new("contour", Shape::Text, "of the network, for quantities of contours"),
        Key::new("from", Shape::Text, "the contour that `contour.apart` is counted from"),
        Key::number("within", "m", Range::POSITIVE, "how far apart masses count as neighbours"),
        Key::number(
            "since",
            "s",
            Range::NOT_NEGATIVE,
            "the date from which on `min` and `max` of reports are taken",
        )
        .or(Value::Number(0.0)),
        Key::new(
            "over",
            Shape::Text,
            "another probe, whose values this one's are drawn over; over time where left out",
        ),
    ],
);

/// A quantity measured along the run.
#[derive(Clone, Debug)]
pub struct Probe {
    pub name: String,
    pub quantity: &'static QuantityEntry,
    pub body: Option<String>,
    pub region: Option<Region>,
    pub component: Option<Component>,
    pub reduction: Reduction,
    pub against: Option<Against>,
    pub contact: Option<String>,
    /// Only this constraint.
    pub constraint: Option<String>,
    pub skin: Option<String>,
    pub hand: Option<String>,
    pub bone: Option<String>,
    /// Only this level of a body.
    pub level: Option<usize>,
    /// The place that moments are taken about [m]; the centre of mass where `None`.
    pub about: Option<Vec3>,
    pub contour: Option<String>,
    /// Another contour.
    pub from: Option<String>,
    /// How far apart masses count as neighbours [m].
    pub within: Option<f64>,
    /// The date from which on extremes are taken [s].
    pub since: f64,
    /// The probe whose values its plot is over; over time where `None`.
    pub over: Option<String>,
    pub site: Site,
}

/// What the values of a probe are the differences from.
#[derive(Clone, Debug)]
pub enum Against {
    /// Of [`LOAD_VARIABLES`], the place where a point rests and time, in the unit of the quantity.
    Formula { formulas: Box<[Formula; 3]>, site: Site },
    /// The same quantity of another body, where the points lie in its shape at rest.
    Body { name: String, site: Site },
}

/// One number of a vector.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Component {
    Axis(usize),
    Length,
}

impl Component {
    pub fn of(self, vector: Vec3) -> f64 {
        match self {
            Self::Axis(axis) => vector[axis],
            Self::Length => vector.length(),
        }
    }

    pub(crate) fn read(reader: &Reader) -> Option<Self> {
        reader.has("component").then(|| match reader.choice("component") {
            "x" => Self::Axis(0),
            "y" => Self::Axis(1),
            "z" => Self::Axis(2),
            _ => Self::Length,
        })
    }
}

impl Against {
    fn read(reader: &Reader, quantity: Quantity) -> Option<Self> {
        let written = reader.written(&["formula", "body"]);
        let [key] = written.as_slice() else {
            let message = format!("`against` names {} things", written.len());
            reader.log().add(
                Code::WrongType,
                &reader.site(),
                message,
                "a `formula` or a `body`, one of them",
            );
            return None;
        };
        match *key {
            "formula" => {
                let formulas = reader.vector_formula_in(key, quantity.unit)?;
                Some(Self::Formula { formulas: Box::new(formulas), site: reader.site_of(key) })
            }
            _ => Some(Self::Body { name: reader.maybe_text(key)?, site: reader.site_of(key) }),
        }
    }
}

impl Probe {
    pub(crate) fn read(name: String, reader: &Reader) -> Self {
        let known = reader.has("quantity").then(|| QUANTITIES.find(reader.choice("quantity")).ok()).flatten();
        // of a quantity left out or misspelt, which is reported, nothing more can be said
        let quantity = known.unwrap_or(QUANTITIES.entries[0]);
        let component = Component::read(reader);
        let reduction = match reader.has("reduce").then(|| reader.choice("reduce")) {
            Some("mean") => Reduction::Mean,
            Some("sum") => Reduction::Sum,
            Some("min") => Reduction::Min,
            Some("max") => Reduction::Max,
            Some(_) => Reduction::MeanMagnitude,
            None => quantity.build.reduction,
        };
        let against = reader.table("against");
        if known.is_some() {
            against.iter().for_each(|against| check_against(against, quantity));
            check_keys(reader, quantity);
            check_reduction(reader, quantity, component, reduction);
        }
        Self {
            name,
            quantity,
            body: reader.maybe_text("body"),
            region: Region::read(reader, "region"),
            component,
            reduction,
            against: against.as_ref().and_then(|against| Against::read(against, quantity.build)),
            contact: reader.maybe_text("contact"),
            constraint: reader.maybe_text("constraint"),
            skin: reader.maybe_text("skin"),
            hand: reader.maybe_text("hand"),
            bone: reader.maybe_text("bone"),
            level: reader.maybe_integer("level").map(|level| level as usize),
            about: reader.maybe_vector("about"),
            contour: reader.maybe_text("contour"),
            from: reader.maybe_text("from"),
            within: reader.maybe_number("within"),
            since: reader.number("since"),
            over: reader.maybe_text("over"),
            site: reader.site(),
        }
    }

    /// Whether a value is a number or a vector of three.
    pub fn rank(&self) -> Rank {
        if self.component.is_some() { Rank::Number } else { self.quantity.build.rank }
    }

    /// What a plot is over is another probe, of one number or of as many.
    pub(crate) fn check_over(&self, reader: &Reader, probes: &[Self]) {
        let Some(name) = &self.over else { return };
        let refuse = |code: Code, message: String, expected: String| {
            reader.log().add(code, &reader.site_of("over"), message, expected);
        };
        let others = || probes.iter().filter(|other| other.name != self.name);
        match others().find(|other| other.name == *name) {
            Some(other) if other.rank() == Rank::Vector && self.rank() == Rank::Number => {
                let message = format!("probe `{name}` gives a vector, and `{}` a number", self.name);
                refuse(Code::Conflict, message, "a probe with a `component`".to_owned());
            }
            Some(_) => {}
            None => {
                let known: Vec<&str> = others().map(|other| other.name.as_str()).collect();
                let hint = crate::keys::did_you_mean(name, known.iter().copied());
                let message = format!("there is no other probe `{name}`{hint}");
                refuse(Code::UnknownName, message, one_of(&known));
            }
        }
    }
}

fn refuse(reader: &Reader, key: &str, message: String, expected: &str) {
    reader.log().add(Code::Conflict, &reader.site_of(key), message, expected);
}

/// Keys that a quantity needs, and those that it cannot have.
fn check_keys(reader: &Reader, entry: &QuantityEntry) {
    let (name, quantity) = (entry.name, entry.build);
    match quantity.subject {
        Subject::Skin(_) => {
            for key in reader.written(&["body", "region"]) {
                refuse(reader, key, format!("`{name}` is of a skin"), "no body and no region");
            }
            if !reader.has("skin") {
                refuse(
                    reader,
                    "quantity",
                    format!("`{name}` is of a skin, and none is named"),
                    "skin = \"…\"",
                );
            }
        }
        Subject::Hand(_) => {
            for key in reader.written(&["body", "region"]) {
                refuse(reader, key, format!("`{name}` is of a hand"), "no body and no region");
            }
            if !reader.has("hand") {
                let message = format!("`{name}` is of a hand, and none is named");
                refuse(reader, "quantity", message, "hand = \"…\"");
            }
        }
        Subject::World(_) => {
            for key in reader.written(&["body", "region"]) {
                refuse(reader, key, format!("`{name}` is of the whole world"), "no body and no region");
            }
        }
        Subject::BodyOrWorld(_) => {
            if reader.has("region") && !reader.has("body") {
                refuse(
                    reader,
                    "region",
                    format!("`{name}` of a region is of a body, and none is named"),
                    "body = \"…\"",
                );
            }
        }
        Subject::Levels(_) | Subject::Contour(_) | Subject::Bone(_)
            if reader.has("region") && !quantity.is_of_active_points() =>
        {
            refuse(reader, "region", format!("`{name}` is of a whole body"), "no region");
        }
        Subject::Points(_)
        | Subject::Cells(_)
        | Subject::Body(_)
        | Subject::Levels(_)
        | Subject::Masses(_)
        | Subject::Bone(_)
        | Subject::Contour(_) => {
            if !reader.has("body") {
                refuse(
                    reader,
                    "quantity",
                    format!("`{name}` is of a body, and none is named"),
                    "body = \"…\"",
                );
            }
        }
    }
    if quantity.rank == Rank::Number && reader.has("component") {
        refuse(reader, "component", format!("`{name}` is a number without components"), "no component");
    }
    if reader.has("contact") && !quantity.is_of_contact() {
        refuse(
            reader,
            "contact",
            format!("`{name}` is of no contact"),
            "a quantity of contacts, such as \"contact_force\"",
        );
    }
    if reader.has("constraint") && quantity.subject != Subject::Points(PointQuantity::ConstraintForce) {
        refuse(
            reader,
            "constraint",
            format!("`{name}` is of no constraint that holds from both sides"),
            "\"constraint_force\", or a quantity of contacts with `contact`",
        );
    }
    if reader.has("skin") && !matches!(quantity.subject, Subject::Skin(_)) {
        refuse(
            reader,
            "skin",
            format!("`{name}` is of no skin"),
            "a quantity of skins, such as \"skin.area\"",
        );
    }
    if reader.has("hand") && !matches!(quantity.subject, Subject::Hand(_)) {
        refuse(
            reader,
            "hand",
            format!("`{name}` is of no hand"),
            "a quantity of hands, such as \"hand.force\"",
        );
    }
    let is_of_bone = matches!(quantity.subject, Subject::Bone(_));
    if reader.has("bone") != is_of_bone {
        let (key, message) = match is_of_bone {
            true => ("quantity", format!("`{name}` is of a bone, and none is named")),
            false => ("bone", format!("`{name}` is of no bone")),
        };
        refuse(reader, key, message, "`bone` with bone.force and bone.torque only");
    }
    if reader.has("level") && !matches!(quantity.subject, Subject::Levels(_)) {
        refuse(
            reader,
            "level",
            format!("`{name}` is of no level"),
            "a quantity of levels, such as \"levels.active\"",
        );
    }
    let is_of_contour = matches!(quantity.subject, Subject::Contour(_));
    let is_apart = matches!(quantity.subject, Subject::Contour(ContourQuantity::Apart));
    for (key, wanted) in [("contour", is_of_contour), ("from", is_apart)] {
        if wanted != reader.has(key) {
            let message = match wanted {
                true => format!("`{name}` is of a contour, and `{key}` names none"),
                false => format!("`{name}` has no `{key}`"),
            };
            let expected = "`contour` with quantities of contours, `from` with contour.apart";
            refuse(reader, if wanted { "quantity" } else { key }, message, expected);
        }
    }
    if quantity.is_of_neighbours() != reader.has("within") {
        let message = match reader.has("within") {
            true => format!("`{name}` knows no neighbours"),
            false => format!("`{name}` is of neighbours, and is not told how near they are"),
        };
        refuse(
            reader,
            "within",
            message,
            "within = \"…\" with masses.parts, neighbours, spacing, kept and relief only",
        );
    }
    if reader.has("about") && !quantity.has_place() {
        let expected = "a moment, such as \"torque\", or \"levels.nearness\"";
        refuse(reader, "about", format!("`{name}` is of no place"), expected);
    }
}

/// Differences are of vectors at points, and those from another body of what its cells carry.
fn check_against(reader: &Reader, entry: &QuantityEntry) {
    let Quantity { rank, subject, .. } = entry.build;
    let is_carried = matches!(
        subject,
        Subject::Points(PointQuantity::Displacement | PointQuantity::Position | PointQuantity::Velocity)
    );
    if rank != Rank::Vector || !matches!(subject, Subject::Points(_)) {
        let message = format!("`{}` is no vector at points", entry.name);
        let site =
            reader.written(&["formula", "body"]).first().map_or(reader.site(), |key| reader.site_of(key));
        reader.log().add(Code::Conflict, &site, message, "a vector at points, such as \"displacement\"");
    } else if reader.has("body") && !is_carried {
        let message = format!("`{}` is not carried from point to point by cells", entry.name);
        refuse(reader, "body", message, "displacement, position or velocity, or a `formula`");
    }
}

fn check_reduction(
    reader: &Reader,
    entry: &QuantityEntry,
    component: Option<Component>,
    reduction: Reduction,
) {
    let quantity = entry.build;
    let is_one_value = !matches!(quantity.subject, Subject::Points(_) | Subject::Cells(_));
    if is_one_value && reader.has("reduce") {
        refuse(reader, "reduce", format!("`{}` is one value already", entry.name), "no `reduce`");
    } else if quantity.rank == Rank::Vector
        && component.is_none()
        && matches!(reduction, Reduction::Min | Reduction::Max | Reduction::MeanMagnitude)
    {
        let expected = "`mean`, `sum`, or a component: `component = \"length\"` is that of the vector";
        refuse(reader, "reduce", "a vector has no least, greatest or magnitude".to_owned(), expected);
    }
}
