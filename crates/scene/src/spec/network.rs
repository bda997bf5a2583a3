//! Networks of masses and interactions: what stands for a body where matter is points and links.

mod actuator;
mod constraints;
mod contours;
mod faces;
mod fill;
mod fusible;
mod kept;
mod objects;

pub use actuator::ActuatorSpec;
pub use constraints::{ConstraintKind, ConstraintSpec, Guided};
pub use contours::{ContourSpec, Way};
pub use faces::{FacesForm, FacesSpec};
pub use fill::{FillSpec, Filled};
pub use fusible::FusibleSpec;
pub use kept::FileSpec;

use std::iter::repeat_n;

use souple_math::Vec3;
use souple_models::network::{BuildLink, LINKS, Span};
use souple_models::solids::Quadrature;
use souple_table::{Range, Value};

use super::body::{Body, Damping, MassKind, Placement, ROTATION, TangentKind};
use super::boundary::{LOAD, Load, PIN, Pin, SPRING, Spring};
use super::control::{CONTROL, ControlSpec};
use super::parts::{Assembly, CONNECTIONS_KEY, PART, PARTS_SUMMARY, PORTS_KEY, Standing, numbers_of};
use super::region::{Region, RegionKind};
use super::skin::BODY_SKIN;
use super::start::{START, StartSpec};
use super::units::Space;
use super::view::{VIEW, ViewSpec};
use crate::diagnostic::{Code, Site};
use crate::keys::{EntryShape, Key, Keys, NOWHERE, Shape, outlines};
use crate::reader::{Chosen, Reader};

const LINK: EntryShape =
    EntryShape { tag: "name", kind: "link", outlines: || outlines(&LINKS), instead: &[], elsewhere: NOWHERE };

/// Masses of a network, at most.
pub(super) const MASSES_MAX: f64 = 1e8;

/// Places of a lattice that a condition is asked about, at most: those where it holds are kept one by one.
const ASKED_MAX: f64 = 1e7;

static LINE: Keys = Keys::new(
    "mass_line",
    "masses at equal distances on a line",
    &[
        Key::vector("from", "m", "the first").required(),
        Key::vector("to", "m", "the last").required(),
        Key::integer("count", Range::closed(2.0, MASSES_MAX), "how many, both ends included").required(),
    ],
);

static RING: Keys = Keys::new(
    "mass_ring",
    "masses at equal distances on a circle, the first where the axis turns x, or y where it is x, to",
    &[
        Key::vector("centre", "m", "of the circle").or(Value::Vector([0.0; 3])),
        Key::number("radius", "m", Range::POSITIVE, "of the circle").required(),
        Key::vector("axis", "", "the circle is counted counterclockwise seen against it")
            .or(Value::Vector([0.0, 0.0, 1.0])),
        Key::integer("count", Range::closed(1.0, MASSES_MAX), "how many").required(),
    ],
);

static POLYGON: Keys = Keys::new(
    "mass_polygon",
    "masses at equal distances on a closed line from corner to corner",
    &[
        Key::new("corners", Shape::Vectors, "of the line, which closes by itself").in_unit("m").required(),
        Key::integer("count", Range::closed(3.0, MASSES_MAX), "how many").required(),
    ],
);

static LATTICE: Keys = Keys::new(
    "mass_lattice",
    "masses on a square or cubic lattice; x counts fastest, then y",
    &[
        Key::vector("origin", "m", "the first").or(Value::Vector([0.0; 3])),
        Key::number("spacing", "m", Range::POSITIVE, "between neighbours").required(),
        Key::new("counts", Shape::Vector, "how many along x, y and z").required(),
        Key::new(
            "within",
            Shape::Condition(&["x", "y", "z"]),
            "only where this holds, before the network is placed",
        ),
    ],
);

pub(super) static MASSES: Keys = Keys::new(
    "mass_group",
    "masses of one kind, a group of the network's points",
    &[
        Key::new("positions", Shape::Vectors, "where they start, one by one").in_unit("m"),
        Key::new("line", Shape::Table(&LINE), "they start on a line"),
        Key::new("ring", Shape::Table(&RING), "they start on a circle"),
        Key::new("polygon", Shape::Table(&POLYGON), "they start on a closed line from corner to corner"),
        Key::new("lattice", Shape::Table(&LATTICE), "they start on a lattice"),
        Key::new("fill", Shape::Table(&fill::FILL), "they fill a shape"),
        Key::new("from", Shape::Table(&kept::FROM_FILE), "they start where a file has points"),
        Key::number("mass", "kg", Range::MODERATE, "of each").required(),
        Key::new("fixed", Shape::Boolean, "they stay where they are, whatever pulls")
            .or(Value::Boolean(false)),
        Key::vector("velocity", "m/s", "at the start, over that of the network").or(Value::Vector([0.0; 3])),
        Key::number("drag", "N s/m", Range::NOT_NEGATIVE, "of each against a medium at rest")
            .or(Value::Number(0.0)),
    ],
);

// which masses are joined
const CHAIN: Key = Key::new("chain", Shape::Boolean, "each mass of a group with the next");
const LOOP: Key = Key::new("loop", Shape::Boolean, "the same, and the last with the first");
const ALL: Key = Key::new("all", Shape::Boolean, "every pair");
const PAIRED: Key =
    Key::new("paired", Shape::Boolean, "each mass of a group with that of its number in the other");
const REACH: Key =
    Key::number("reach", "m", Range::POSITIVE, "every pair that is at most so far apart at rest");
const FROM: Key = Key::new("from", Shape::Integers, "first ends: numbers within the first group");
const TO: Key = Key::new("to", Shape::Integers, "second ends: numbers within the last group");

pub(super) static LINK_TABLE: Keys = Keys::new(
    "links",
    "links of one law: all that `chain`, `loop`, `all`, `paired`, `reach`, or `from` and `to` say, which is one of them",
    &[
        Key::new("law", Shape::Entry(LINK), "what they do").required(),
        Key::new("name", Shape::Text, "what controls call them"),
        Key::new(
            "of",
            Shape::Texts,
            "the group, or the two, whose masses they join; all masses where left out; a part or a port stands for its masses",
        ),
        CHAIN,
        LOOP,
        ALL,
        PAIRED,
        REACH,
        FROM,
        TO,
        Key::number(
            "rest_length",
            "m",
            Range::NOT_NEGATIVE,
            "of each; how long it is where its ends rest where left out",
        ),
        Key::vector(
            "along",
            "",
            "the axis that `D` is counted along, with its sign, and forces act along; the line between the ends where left out",
        ),
    ],
);

static FRICTION: Keys = Keys::new(
    "crowd_friction",
    "dry friction of balls: a hook while they stick, Coulomb's force while they slide",
    &[
        Key::number("static", "", Range::NOT_NEGATIVE, "of the normal force, at which the hook tears")
            .required(),
        Key::number("kinetic", "", Range::NOT_NEGATIVE, "of the normal force, while sliding").required(),
        Key::number("stiffness", "N/m", Range::POSITIVE, "of the hook").required(),
        Key::number("damping", "N s/m", Range::NOT_NEGATIVE, "of the hook").or(Value::Number(0.0)),
        Key::number("speed", "m/s", Range::POSITIVE, "of sliding, below which it ends").required(),
        Key::number(
            "fall",
            "m/s",
            Range::POSITIVE,
            "speed over which the coefficient falls from `static` to `kinetic` once it slides, as under a bow; at once where left out",
        ),
        Key::number(
            "growth",
            "s/m",
            Range::NOT_NEGATIVE,
            "of the coefficient with the speed of sliding, as of a wet film under a ski",
        )
        .or(Value::Number(0.0)),
        Key::new(
            "speeds",
            Shape::Numbers,
            "of sliding, growing from 0, at which `coefficients` are known: instead of `kinetic`, `fall` and `growth`",
        )
        .in_unit("m/s"),
        Key::new("coefficients", Shape::Numbers, "one for each of `speeds`, straight lines between them"),
        Key::number(
            "hook_viscosity",
            "N s/m",
            Range::POSITIVE,
            "of a damper in series with the hook, which creeps then; a spring alone where left out",
        ),
    ],
);

pub(super) static CROWD: Keys = Keys::new(
    "crowd",
    "a law between all masses that are near each other at any time",
    &[
        Key::new("law", Shape::Entry(LINK), "what they do to each other").required(),
        Key::new("name", Shape::Text, "what controls call it"),
        Key::new(
            "of",
            Shape::Texts,
            "the group, or the two, that act on each other; all masses where left out; a part or a port stands for its masses",
        ),
        Key::number("range", "m", Range::POSITIVE, "no force beyond; that of the law where left out"),
        Key::new("friction", Shape::Table(&FRICTION), "what holds them across"),
        Key::new(
            "fusible",
            Shape::Table(&fusible::FUSIBLE),
            "bonds that melt and set, with temperatures of its masses",
        ),
    ],
);

pub(crate) static NETWORK: Keys = Keys::new(
    "network",
    "masses and what acts between them; names what bodies name, for pins, probes and contacts",
    &[
        Key::new("masses", Shape::Named(&MASSES), "groups of masses, in the order of their numbers"),
        Key::new("links", Shape::Tables(&LINK_TABLE), "what acts between masses"),
        Key::new("crowds", Shape::Tables(&CROWD), "what acts between masses wherever they come near"),
        Key::new(
            "constraints",
            Shape::Tables(&constraints::CONSTRAINT),
            "geometric relations of masses, kept by forces that are solved for",
        ),
        Key::new("objects", Shape::Named(&objects::OBJECT), "groups of masses as layers of things"),
        Key::new(
            "encounters",
            Shape::Tables(&objects::ENCOUNTER),
            "what objects do to each other where they meet",
        ),
        Key::new("contours", Shape::Named(&contours::CONTOUR), "where objects end, for probes and pictures"),
        Key::new("modules", Shape::Named(&PART), PARTS_SUMMARY),
        PORTS_KEY,
        CONNECTIONS_KEY,
        Key::new("views", Shape::Named(&VIEW), "what links may see in the place of masses"),
        Key::new("actuators", Shape::Named(&actuator::ACTUATOR), "forces on masses that controls command"),
        Key::new(
            "controls",
            Shape::Named(&CONTROL),
            "what drives links, crowds, the parameters of their laws, and actuators",
        ),
        Key::new(
            "space",
            Shape::Choice(&["physical", "algorithmic"]),
            "that its masses, drags, group velocities and laws are written in: `algorithmic` counts time in steps",
        )
        .or(Value::Text("physical")),
        Key::new("account", Shape::Boolean, "links without memory keep account of the heat they give off")
            .or(Value::Boolean(false)),
        Key::new("rotate", Shape::Table(&ROTATION), "turns the start, before it is translated"),
        Key::vector("translate", "m", "moves the start").or(Value::Vector([0.0; 3])),
        Key::vector("velocity", "m/s", "at the start").or(Value::Vector([0.0; 3])),
        Key::vector("angular_velocity", "rad/s", "at the start, about the mean of the masses' places")
            .or(Value::Vector([0.0; 3])),
        Key::new(
            "start",
            Shape::Table(&START),
            "how its masses stand and move at the start, by where they rest",
        ),
        Key::new("system", Shape::Text, "the system it steps in"),
        Key::new("pins", Shape::Tables(&PIN), "masses that are held or led"),
        Key::new("loads", Shape::Tables(&LOAD), "forces on masses"),
        Key::new("springs", Shape::Tables(&SPRING), "springs from masses to where they start"),
        Key::new("skin", Shape::Table(&BODY_SKIN), "a skin that dresses its masses, see `skins`"),
    ],
);

/// Masses and what acts between them.
pub struct Network {
    pub masses: Vec<MassGroup>,
    pub links: Vec<LinkTable>,
    pub crowds: Vec<CrowdSpec>,
    pub constraints: Vec<ConstraintSpec>,
    /// Numbers of the masses of parts and ports.
    pub presented: Vec<(String, std::ops::Range<u32>)>,
    pub actuators: Vec<ActuatorSpec>,
    pub controls: Vec<ControlSpec>,
    /// What links may see in the place of masses: numbers behind those of masses, see [`Network::seen`].
    pub views: Vec<ViewSpec>,
    /// Of its masses and laws as they are written; they are physical from then on.
    pub space: Space,
    pub contours: Vec<ContourSpec>,
    /// Links without memory keep account of the heat they give off.
    pub keeps_account: bool,
}

/// Masses of one kind.
pub struct MassGroup {
    pub name: String,
    pub places: Places,
    /// What moves them of the parts they are in, innermost first.
    pub placements: Vec<Placement>,
    /// Of each [kg].
    pub mass: f64,
    pub is_fixed: bool,
    /// [m/s]
    pub velocity: Vec3,
    /// Of each against a medium at rest [N s/m].
    pub drag: f64,
    pub site: Site,
}

/// Where masses start: told, not made, so that they can be counted before there is memory for them.
pub enum Places {
    /// One by one [m].
    Listed(Vec<Vec3>),
    /// At equal distances on a line, both ends included.
    Line { from: Vec3, to: Vec3, count: u64 },
    /// At equal distances on a circle.
    Ring { centre: Vec3, first: Vec3, axis: Vec3, count: u64 },
    /// x counts fastest, then y.
    Lattice { origin: Vec3, spacing: f64, counts: [u64; 3] },
    /// Wherever a shape has room.
    Filled(Box<FillSpec>),
    /// Where a file has points.
    File(Box<FileSpec>),
}

/// Links of one law.
pub struct LinkTable {
    /// What controls call them, with the part that they are of; empty where nothing drives them.
    pub name: String,
    pub law: Option<Chosen<BuildLink>>,
    /// Names of groups: none, one or two.
    pub of: Vec<String>,
    pub join: Option<Join>,
    /// [m]
    pub rest_length: Option<f64>,
    pub span: Span,
    /// It is of a module: links of its law, wherever the module is placed, are computed together.
    pub is_of_part: bool,
    pub site: Site,
}

/// A law between all masses that are near.
pub struct CrowdSpec {
    /// What controls call it.
    pub name: String,
    /// Name of the force; by its number where `None`.
    pub force: Option<String>,
    pub law: Option<Chosen<BuildLink>>,
    /// Names of groups: none, one or two.
    pub of: Vec<String>,
    /// Groups that would meet beside these if layers did not keep them from it.
    pub kept_apart: Vec<[String; 2]>,
    /// That of the law where `None` [m].
    pub range: Option<f64>,
    pub friction: Option<FrictionSpec>,
    pub fusible: Option<FusibleSpec>,
    pub site: Site,
}

impl CrowdSpec {
    /// The name of its force, by its number in the network of a body.
    pub fn force_name(&self, body: &str, index: usize) -> String {
        self.force.clone().unwrap_or_else(|| format!("{body}.crowds[{index}]"))
    }
}

/// Dry friction of balls.
#[derive(Clone, Debug, PartialEq)]
pub struct FrictionSpec {
    pub sticking: f64,
    pub sliding: f64,
    /// [N/m]
    pub stiffness: f64,
    /// [N s/m]
    pub damping: f64,
    /// [m/s]
    pub speed: f64,
    /// [m/s]
    pub fall: Option<f64>,
    /// [s/m]
    pub growth: f64,
    /// Speeds [m/s] and coefficients.
    pub curve: Option<Vec<[f64; 2]>>,
    /// [N s/m]
    pub hook_viscosity: Option<f64>,
}

/// Which masses links join.
#[derive(Clone, Debug, PartialEq)]
pub enum Join {
    Chain,
    Loop,
    All,
    Paired,
    /// At most so far apart at the start [m].
    Reach(f64),
    /// First and second ends.
    Ends(Vec<u32>, Vec<u32>),
}

impl Network {
    /// A network as a body: its masses are points, its links are cells.
    pub(crate) fn body(name: String, reader: &Reader) -> Body {
        let Assembly { masses, links, crowds, presented, views } = Assembly::read(reader);
        let mut network = Self {
            masses,
            links,
            crowds,
            constraints: reader.tables("constraints").iter().map(ConstraintSpec::read).collect(),
            presented,
            views,
            actuators: reader
                .named("actuators")
                .into_iter()
                .map(|(name, actuator)| ActuatorSpec::read(name, &actuator))
                .collect(),
            controls: reader
                .named("controls")
                .into_iter()
                .map(|(name, control)| ControlSpec::read(name, &control))
                .collect(),
            space: if reader.choice("space") == "algorithmic" { Space::Algorithmic } else { Space::Physical },
            contours: reader
                .named("contours")
                .into_iter()
                .filter_map(|(name, contour)| ContourSpec::read(name, &contour))
                .collect(),
            keeps_account: reader.boolean("account"),
        };
        let groups: Vec<&str> = network.masses.iter().map(|group| group.name.as_str()).collect();
        let of_objects = objects::crowds(&name, &groups, reader);
        network.crowds.extend(of_objects);
        for crowd in network.crowds.iter().filter(|crowd| crowd.fusible.is_some()) {
            if network.space == Space::Algorithmic {
                let message = "`fusible` is in SI units, and the network counts time in steps";
                reader.log().add(Code::Conflict, &crowd.site, message, "space = \"physical\"");
            }
        }
        for constraint in network.constraints.iter().filter(|_| network.space == Space::Algorithmic) {
            let message = "`constraints` are in SI units, and the network counts time in steps";
            reader.log().add(Code::Conflict, &constraint.site, message, "space = \"physical\"");
        }
        for actuator in network.actuators.iter().filter(|_| network.space == Space::Algorithmic) {
            let message = "`actuators` are in SI units, and the network counts time in steps";
            reader.log().add(Code::Conflict, &actuator.site, message, "space = \"physical\"");
        }
        network.check_constraints(reader);
        network.check_contours(reader);
        network.check_count(reader);
        let held = network.masses.iter().filter(|group| group.is_fixed).map(MassGroup::pin);
        let pins = held.chain(reader.tables("pins").iter().map(Pin::read)).collect();
        Body {
            name,
            mesh: None,
            split: None,
            material: None,
            section: None,
            bending: None,
            inelasticity: None,
            incompressible: None,
            axes: None,
            material_fields: Vec::new(),
            regions: Vec::new(),
            mass: MassKind::Lumped,
            quadrature: Quadrature::Default,
            formulation: None,
            tangent: TangentKind::Exact,
            adapt: None,
            damping: Damping::default(),
            drag: 0.0,
            placement: Placement::read(reader),
            velocity: reader.vector("velocity"),
            angular_velocity: reader.vector("angular_velocity"),
            start: reader.table("start").map(|table| StartSpec::read(&table)),
            system: reader.text("system"),
            pins,
            loads: reader.tables("loads").iter().map(Load::read).collect(),
            springs: reader.tables("springs").iter().map(Spring::read).collect(),
            frames: None,
            modes: None,
            polynomial: None,
            levels: None,
            octree: None,
            marks: None,
            texture: None,
            network: Some(network),
            site: reader.site(),
        }
    }

    pub fn mass_count(&self) -> u64 {
        self.masses.iter().map(|group| group.places.count()).sum()
    }

    /// Of an actuator [N].
    pub fn largest(&self, actuator: &str) -> f64 {
        let found = self.actuators.iter().find(|other| other.name == actuator);
        found.map_or(f64::INFINITY, |actuator| actuator.largest)
    }

    /// The masses that a point of view sees, one by one; a mean sees them as one.
    pub fn seen(&self, view: &ViewSpec) -> std::ops::Range<u32> {
        self.numbers_of(&view.of).unwrap_or(0..0)
    }

    /// What each mass has of its group, in the order of the masses' numbers.
    pub fn of_each<'a, T: Clone + 'a>(
        &'a self,
        of: impl Fn(&MassGroup) -> T + 'a,
    ) -> impl Iterator<Item = T> + 'a {
        self.masses.iter().flat_map(move |group| repeat_n(of(group), group.places.count() as usize))
    }

    /// The numbers of the masses of a group, a part or a port.
    pub fn numbers_of(&self, name: &str) -> Option<std::ops::Range<u32>> {
        numbers_of(&self.masses, &self.presented, name)
    }

    /// The names of what pushes masses of a body apart, or from one side: crowds, constraints with a sense, balls and faces.
    pub fn names_of_contacts(&self, body: &str) -> Vec<String> {
        let crowds = self.crowds.iter().enumerate().map(|(index, crowd)| crowd.force_name(body, index));
        let constraints = self.constraints.iter().enumerate().filter(|(_, it)| it.is_sided());
        crowds.chain(constraints.map(|(index, it)| it.force_name(body, index))).collect()
    }

    /// The names of constraints that hold from both sides.
    pub fn names_of_constraints(&self, body: &str) -> Vec<String> {
        let constraints = self.constraints.iter().enumerate().filter(|(_, it)| !it.is_sided());
        constraints.map(|(index, it)| it.force_name(body, index)).collect()
    }

    fn check_count(&self, reader: &Reader) {
        if let Some((message, expected)) = self.too_many() {
            reader.log().add(Code::TooLarge, &reader.site_of("masses"), message, expected);
        }
    }

    /// What is said of more masses than a network may have, and what would be taken; masses of files and fillings count once they have places.
    pub fn too_many(&self) -> Option<(String, String)> {
        let count = self.mass_count();
        (count as f64 > MASSES_MAX).then(|| {
            let expected = format!("at most {MASSES_MAX:.0e} masses in all groups together");
            (format!("the network has {count} masses"), expected)
        })
    }

    fn check_constraints(&self, reader: &Reader) {
        let groups = self.masses.iter().map(|group| group.name.as_str());
        let known: Vec<&str> = groups.chain(self.presented.iter().map(|(name, _)| name.as_str())).collect();
        for (constraint, name) in
            self.constraints.iter().flat_map(|it| it.groups().map(move |name| (it, name)))
        {
            if !known.contains(&name.as_str()) {
                let hint = crate::keys::did_you_mean(name, known.iter().copied());
                let message = format!("there is no group of masses `{name}`{hint}");
                reader.log().add(Code::UnknownName, &constraint.site, message, crate::keys::one_of(&known));
                continue;
            }
            let Some(numbers) = self.numbers_of(name) else { continue };
            if u64::from(numbers.end) > self.mass_count() {
                let message = format!("constraints are between masses, and `{name}` is points of view");
                reader.log().add(Code::Conflict, &constraint.site, message, "groups, parts or ports");
            }
        }
    }

    fn check_contours(&self, reader: &Reader) {
        let known: Vec<&str> = self.masses.iter().map(|group| group.name.as_str()).collect();
        for (contour, name) in
            self.contours.iter().flat_map(|it| it.groups().iter().map(move |name| (it, name)))
        {
            if !known.contains(&name.as_str()) {
                let hint = crate::keys::did_you_mean(name, known.iter().copied());
                let message = format!("there is no group of masses `{name}`{hint}");
                let expected = crate::keys::one_of(&known);
                reader.log().add(Code::UnknownName, &contour.site, message, expected);
            }
        }
    }
}

impl MassGroup {
    /// What holds masses that are fixed.
    fn pin(&self) -> Pin {
        let region = Region { kind: RegionKind::Group(self.name.clone()), site: self.site.clone() };
        Pin {
            bone: None,
            region: Some(region),
            axes: [true; 3],
            motion: None,
            rotation: None,
            pivot: Vec3::ZERO,
            site: self.site.clone(),
        }
    }

    /// Where one of them starts [m].
    pub fn place(&self, index: u64) -> Vec3 {
        self.placements.iter().fold(self.places.place(index), |place, placement| placement.place(place))
    }

    /// The same masses in parts that stand so, innermost first.
    pub(super) fn standing(mut self, standing: &[Standing]) -> Self {
        self.placements = standing.iter().map(|standing| standing.placement.clone()).collect();
        let moved =
            |velocity: Vec3, standing: &Standing| standing.placement.turn(velocity) + standing.velocity;
        self.velocity = standing.iter().fold(self.velocity, moved);
        self
    }

    pub(super) fn read(name: String, reader: &Reader) -> Self {
        let written = reader.written(&["positions", "line", "ring", "polygon", "lattice", "fill", "from"]);
        let places = match written[..] {
            ["positions"] => {
                let positions = reader.maybe_vectors("positions");
                if positions.as_ref().is_some_and(Vec::is_empty) {
                    let message = format!("`{name}` is a group of no masses");
                    let site = reader.site_of("positions");
                    reader.log().add(Code::EmptyRegion, &site, message, "at least one place");
                }
                Some(Places::Listed(positions.unwrap_or_default()))
            }
            ["line"] => reader.table("line").map(|line| Places::on_line(&line)),
            ["ring"] => reader.table("ring").and_then(|ring| Places::on_ring(&ring)),
            ["polygon"] => reader.table("polygon").and_then(|polygon| Places::on_polygon(&polygon)),
            ["lattice"] => reader.table("lattice").and_then(|lattice| Places::on_lattice(&lattice)),
            ["fill"] => reader.table("fill").map(|fill| Places::Filled(Box::new(FillSpec::read(&fill)))),
            ["from"] => reader.table("from").map(|file| Places::File(Box::new(FileSpec::read(&file)))),
            _ => {
                let message = format!("masses start in one way, these say {}", in_words(&written));
                reader.log().add(
                    Code::WrongType,
                    &reader.site(),
                    message,
                    "one of positions, line, ring, polygon, lattice, fill, from",
                );
                None
            }
        };
        Self {
            name,
            places: places.unwrap_or(Places::Listed(Vec::new())),
            placements: Vec::new(),
            mass: reader.number("mass"),
            is_fixed: reader.boolean("fixed"),
            velocity: reader.vector("velocity"),
            drag: reader.number("drag"),
            site: reader.site(),
        }
    }
}

impl Places {
    fn on_line(reader: &Reader) -> Self {
        let count = reader.maybe_integer("count").unwrap_or(2) as u64;
        Self::Line { from: reader.vector("from"), to: reader.vector("to"), count }
    }

    fn on_ring(reader: &Reader) -> Option<Self> {
        let Some(axis) = reader.vector("axis").try_normalised() else {
            let message = "an axis of no length";
            reader.log().add(Code::Conflict, &reader.site_of("axis"), message, "a vector that is not zero");
            return None;
        };
        // across the axis, towards x where it is not x itself
        let towards = if axis.x.abs() < 0.999 { Vec3::X } else { Vec3::Y };
        let first = (towards - axis * towards.dot(axis)).try_normalised()? * reader.number("radius");
        let count = reader.maybe_integer("count").unwrap_or(1) as u64;
        Some(Self::Ring { centre: reader.vector("centre"), first, axis, count })
    }

    fn on_polygon(reader: &Reader) -> Option<Self> {
        let (corners, count) = (reader.vectors("corners"), reader.maybe_integer("count")?);
        let sides = || (0..corners.len()).map(|i| (corners[i], corners[(i + 1) % corners.len()]));
        let length: f64 = sides().map(|(a, b)| (b - a).length()).sum();
        if corners.len() < 3 || !(length > 0.0 && length.is_finite()) {
            let message = format!("a polygon of {} corners, {length} m long", corners.len());
            reader.log().add(
                Code::OutOfRange,
                &reader.site_of("corners"),
                message,
                "three corners or more that are apart",
            );
            return None;
        }
        let step = length / count as f64;
        let mut places = Vec::with_capacity(count as usize);
        let mut before = 0.0;
        for (a, b) in sides() {
            let side = (b - a).length();
            // the place at the end of a side is the first of the next
            while places.len() < count as usize && places.len() as f64 * step < before + side * (1.0 - 1e-12)
            {
                places.push(a + (b - a) * ((places.len() as f64 * step - before) / side));
            }
            before += side;
        }
        Some(Self::Listed(places))
    }

    fn on_lattice(reader: &Reader) -> Option<Self> {
        let counts = reader.vector("counts");
        let is_count = |number: f64| number >= 1.0 && number.fract() == 0.0;
        let most = if reader.has("within") { ASKED_MAX } else { MASSES_MAX };
        if !counts.to_array().into_iter().all(is_count) || counts.x * counts.y * counts.z > most {
            let message = format!("a lattice of ({}, {}, {}) masses", counts.x, counts.y, counts.z);
            let expected = format!("three whole numbers from 1, at most {most:.0e} masses together");
            reader.log().add(Code::OutOfRange, &reader.site_of("counts"), message, expected);
            return None;
        }
        let counts = counts.to_array().map(|count| count as u64);
        let lattice =
            Self::Lattice { origin: reader.vector("origin"), spacing: reader.number("spacing"), counts };
        if !reader.has("within") {
            return Some(lattice);
        }
        let within = reader.maybe_condition("within")?;
        let places = (0..lattice.count()).map(|index| lattice.place(index));
        let kept: Vec<Vec3> = places.filter(|place| within.holds(&place.to_array())).collect();
        if kept.is_empty() {
            let message = format!("none of the {} masses of this lattice is within", lattice.count());
            let expected = "a condition that holds at some of them";
            reader.log().add(Code::EmptyRegion, &reader.site_of("within"), message, expected);
            return None;
        }
        Some(Self::Listed(kept))
    }

    pub fn count(&self) -> u64 {
        match self {
            Self::Listed(places) => places.len() as u64,
            Self::Line { count, .. } | Self::Ring { count, .. } => *count,
            Self::Lattice { counts: [x, y, z], .. } => x * y * z,
            Self::Filled(fill) => fill.places().len() as u64,
            Self::File(file) => file.places().len() as u64,
        }
    }

    /// Where one of them starts [m].
    pub fn place(&self, index: u64) -> Vec3 {
        match self {
            Self::Listed(places) => places[index as usize],
            Self::Filled(fill) => fill.places()[index as usize],
            Self::File(file) => file.places()[index as usize],
            Self::Line { from, to, count } => *from + (*to - *from) * (index as f64 / (count - 1) as f64),
            Self::Ring { centre, first, axis, count } => {
                let angle = std::f64::consts::TAU * index as f64 / *count as f64;
                *centre + *first * angle.cos() + axis.cross(*first) * angle.sin()
            }
            Self::Lattice { origin, spacing, counts: [x, y, _] } => {
                let steps = [index % x, index / x % y, index / (x * y)];
                *origin + Vec3::from_array(steps.map(|step| step as f64)) * *spacing
            }
        }
    }
}

/// Keys that are written of those that say the same.
fn in_words(written: &[&str]) -> String {
    if written.is_empty() { "none".to_owned() } else { written.join(" and ") }
}

impl Join {
    /// Which of the keys that join masses of the groups `of` is written; `whole` is blamed where none is.
    fn read(reader: &Reader, of: &[String], whole: &Site) -> Option<Self> {
        let refuse = |key: &str, message: &str, expected: &str| {
            reader.log().add(Code::Conflict, &reader.site_of(key), message, expected);
        };
        let written = reader.written(&["chain", "loop", "all", "paired", "reach", "from", "to"]);
        match written[..] {
            [key @ ("chain" | "loop")] if of.len() == 2 => {
                refuse(key, "a chain is of one group", "one group in `of`");
                None
            }
            ["paired"] if of.len() != 2 => {
                refuse("paired", "pairs are of two groups", "two groups in `of`");
                None
            }
            [key @ ("chain" | "loop" | "all" | "paired")] if !reader.boolean(key) => {
                refuse(key, &format!("`{key} = false` joins nothing"), "true, or another way to join");
                None
            }
            ["chain"] => Some(Join::Chain),
            ["loop"] => Some(Join::Loop),
            ["paired"] => Some(Join::Paired),
            ["all"] => Some(Join::All),
            ["reach"] => reader.maybe_number("reach").map(Join::Reach),
            ["from", "to"] => {
                let ends = reader.maybe_indices("from").zip(reader.maybe_indices("to"));
                if ends.as_ref().is_some_and(|(from, to)| from.len() != to.len()) {
                    refuse(
                        "to",
                        "a link has two ends: `from` and `to` are not as many",
                        "lists of one length",
                    );
                }
                ends.map(|(from, to)| Join::Ends(from, to))
            }
            _ => {
                let message = format!("links join masses in one way, these say {}", in_words(&written));
                let expected = "one of chain, loop, all, paired, reach, or from and to";
                reader.log().add(Code::Conflict, whole, message, expected);
                None
            }
        }
    }
}

impl LinkTable {
    pub(super) fn read(reader: &Reader) -> Self {
        let of = reader.texts("of");
        let refuse = |key: &str, message: &str, expected: &str| {
            reader.log().add(Code::Conflict, &reader.site_of(key), message, expected);
        };
        if of.len() > 2 {
            refuse("of", "a link has two ends", "one group or two");
        }
        let join = Join::read(reader, &of, &reader.site_of("law"));
        let axis = reader.maybe_vector("along").map(Vec3::try_normalised);
        if axis == Some(None) {
            refuse("along", "an axis of no length", "a vector that is not zero, such as [0, 0, 1]");
        }
        Self {
            name: reader.text("name"),
            law: reader.entry("law", &LINKS),
            of,
            join,
            rest_length: reader.maybe_number("rest_length"),
            span: axis.flatten().map_or(Span::Distance, Span::Along),
            is_of_part: false,
            site: reader.site(),
        }
    }
}

impl CrowdSpec {
    pub(super) fn read(reader: &Reader) -> Self {
        let of = reader.texts("of");
        if of.len() > 2 {
            reader.log().add(
                Code::Conflict,
                &reader.site_of("of"),
                "a pair has two ends",
                "one group or two",
            );
        }
        let friction = reader.table("friction").map(|table| FrictionSpec::read(&table));
        Self {
            name: reader.text("name"),
            force: None,
            law: reader.entry("law", &LINKS),
            of,
            kept_apart: Vec::new(),
            range: reader.maybe_number("range"),
            friction,
            fusible: reader.table("fusible").map(|table| FusibleSpec::read(&table)),
            site: reader.site(),
        }
    }
}

impl FrictionSpec {
    fn read(reader: &Reader) -> Self {
        Self {
            sticking: reader.number("static"),
            sliding: reader.number("kinetic"),
            stiffness: reader.number("stiffness"),
            damping: reader.number("damping"),
            speed: reader.number("speed"),
            fall: reader.maybe_number("fall"),
            growth: reader.number("growth"),
            curve: Self::curve(reader),
            hook_viscosity: reader.maybe_number("hook_viscosity"),
        }
    }

    /// `None` where none is written, or it was refused.
    fn curve(reader: &Reader) -> Option<Vec<[f64; 2]>> {
        let written = reader.written(&["speeds", "coefficients"]);
        let [key, ..] = written[..] else { return None };
        let (speeds, coefficients) = (reader.numbers("speeds"), reader.numbers("coefficients"));
        let is_good = speeds.len() == coefficients.len()
            && speeds.len() >= 2
            && speeds[0] == 0.0
            && speeds.is_sorted_by(|a, b| a < b)
            && coefficients.iter().all(|coefficient| *coefficient >= 0.0);
        let others = reader.written(&["fall", "growth"]);
        if !is_good || !others.is_empty() {
            let message = "a curve of sliding is no function of the speed";
            let expected = "two speeds or more, growing from 0, as many coefficients of at least 0, and no `fall` or `growth`";
            reader.log().add(Code::Conflict, &reader.site_of(key), message, expected);
            return None;
        }
        Some(speeds.into_iter().zip(coefficients).map(|(speed, coefficient)| [speed, coefficient]).collect())
    }
}
