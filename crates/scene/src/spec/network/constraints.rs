//! Constraints between masses: geometric relations that forces keep.

use souple_engine::ImpactLaw;
use souple_formal::Formula;
use souple_math::Vec3;
use souple_models::network::{Augmented, Sense};
use souple_table::{Range, Value};

use super::Join;
use super::faces::{FACES, FacesSpec};
use crate::diagnostic::{Code, Site};
use crate::keys::{Key, Keys, Shape};
use crate::reader::Reader;
use crate::spec::boundary::{LOAD_VARIABLES, MOTION, MotionSpec, TURNING};

static ROD: Keys = Keys::new(
    "constraint_rod",
    "pairs of masses at one distance: all that `chain`, `loop`, `all`, `paired`, `reach`, or `from` and `to` say, which is one of them",
    &[
        super::CHAIN,
        super::LOOP,
        super::ALL,
        super::PAIRED,
        super::REACH,
        super::FROM,
        super::TO,
        Key::number(
            "length",
            "m",
            Range::POSITIVE,
            "of each; how long it is where its ends rest where left out",
        ),
    ],
);

static JOINT: Keys = Keys::new(
    "constraint_joint",
    "pairs of masses at one place, named as those of rods are",
    &[super::CHAIN, super::LOOP, super::ALL, super::PAIRED, super::REACH, super::FROM, super::TO],
);

const MOVES: Key = Key::new("motion", Shape::Table(&MOTION), "how it moves; it stays where left out");

static NAIL: Keys = Keys::new(
    "constraint_nail",
    "a place for each mass: where it rests, or `place`",
    &[Key::vector("place", "m", "for all of them"), MOVES],
);

static LINE: Keys = Keys::new(
    "constraint_line",
    "a straight line that masses stay on",
    &[
        Key::vector("place", "m", "on it; where each mass rests where left out"),
        Key::vector("direction", "", "along it").required(),
        MOVES,
    ],
);

static PLANE: Keys = Keys::new(
    "constraint_plane",
    "a plane that masses stay on",
    &[
        Key::vector("place", "m", "on it; where each mass rests where left out"),
        Key::vector("normal", "", "across it").required(),
        MOVES,
    ],
);

static SURFACE: Keys = Keys::new(
    "constraint_surface",
    "a surface that masses stay on, or a curve",
    &[
        Key::new("zero", Shape::Formula(LOAD_VARIABLES), "what vanishes on the surface").required(),
        Key::new(
            "also_zero",
            Shape::Formula(LOAD_VARIABLES),
            "what vanishes on a second one: masses stay on the curve where both do",
        ),
    ],
);

static ACCELERATION: Keys = Keys::new(
    "constraint_acceleration",
    "an acceleration of each mass, whatever else pulls",
    &[
        Key::new(
            "formula",
            Shape::VectorFormula(LOAD_VARIABLES),
            "of the place where a mass rests and of time",
        )
        .in_unit("m/s^2")
        .required(),
        Key::new("axes", Shape::Axes, "those along which it is told; all three where left out"),
    ],
);

const PART: Key = Key::new("part", Shape::Formula(&["t"]), "of what is enclosed at rest, which is kept")
    .or(Value::Number(1.0));

static AREA: Keys = Keys::new(
    "constraint_area",
    "the area within the closed line of all masses in the order of their numbers",
    &[Key::vector("normal", "", "the line is seen against it").or(Value::Vector([0.0, 0.0, 1.0])), PART],
);

static VOLUME: Keys = Keys::new(
    "constraint_volume",
    "the volume within a closed surface of triangles",
    &[
        Key::new(
            "triangles",
            Shape::Vectors,
            "three numbers of masses within the group, counterclockwise seen from outside",
        )
        .required(),
        PART,
    ],
);

static DIRECTION: Keys = Keys::new(
    "constraint_direction",
    "the direction from the first to the second of pairs of masses, named as those of rods are",
    &[
        super::CHAIN,
        super::LOOP,
        super::ALL,
        super::PAIRED,
        super::REACH,
        super::FROM,
        super::TO,
        Key::vector("along", "", "where they point at the start; as each rests where left out"),
        Key::new("rotation", Shape::Table(&TURNING), "how that turns; it stays where left out"),
    ],
);

static ANGLE: Keys = Keys::new(
    "constraint_angle",
    "angles at masses between the segments to two others",
    &[
        Key::new(
            "corners",
            Shape::Vectors,
            "three numbers of masses within the group for each, the second of which is at the corner",
        )
        .required(),
        Key::new("value", Shape::Formula(&["t"]), "how wide they are; as each rests where left out")
            .in_unit("rad"),
        Key::vector(
            "axis",
            "",
            "about which they are counted, counterclockwise seen against it; within half a turn, whatever the plane, where left out",
        ),
    ],
);

static AUGMENTED: Keys = Keys::new(
    "constraint_augmented",
    "forces of an augmented Lagrangian, which keep what is constrained in the end; numbers are per metre, square metre, cubic metre or radian of what it is off by",
    &[
        Key::number("stiffness", "", Range::NOT_NEGATIVE, "`c` of the force `−∇g (λ + c g + z ġ)`")
            .required(),
        Key::number("damping", "", Range::NOT_NEGATIVE, "`z` [s]").or(Value::Number(0.0)),
        Key::number("rate", "", Range::NOT_NEGATIVE, "`k` of `λ' = k g` [1/s]").required(),
    ],
);

static BALLS: Keys = Keys::new(
    "constraint_balls",
    "balls that keep out of each other: all masses of a group, or those of one group and those of another, but for pairs that a rod or a joint holds",
    &[Key::number("diameter", "m", Range::POSITIVE, "nearer than which the centres of no two come")
        .required()],
);

const KINDS: &[&str] = &[
    "rod",
    "joint",
    "direction",
    "angle",
    "nail",
    "line",
    "plane",
    "surface",
    "acceleration",
    "area",
    "volume",
    "rigid",
    "balls",
    "faces",
];

/// Of a constraint with a sense.
const OF_SIDED: [&str; 3] = ["restitution", "friction", "radius"];

const SENSES: &[&str] = &["at_least", "at_most"];

pub(super) static CONSTRAINT: Keys = Keys::new(
    "constraint",
    "geometric relations of masses, kept by forces that are solved for in each step",
    &[
        Key::new("name", Shape::Text, "what its force is called after the network's name; by its number where left out"),
        Key::new(
            "of",
            Shape::Texts,
            "the groups whose masses it is of, one or two of `rod`, `joint`, `direction` and `balls`, none of `faces`; all masses where left out",
        ),
        Key::new("rod", Shape::Table(&ROD), "pairs at one distance"),
        Key::new("joint", Shape::Table(&JOINT), "pairs at one place"),
        Key::new("direction", Shape::Table(&DIRECTION), "segments between two masses along a direction"),
        Key::new("angle", Shape::Table(&ANGLE), "angles between two segments"),
        Key::new("nail", Shape::Table(&NAIL), "each at a place"),
        Key::new("line", Shape::Table(&LINE), "each on a straight line"),
        Key::new("plane", Shape::Table(&PLANE), "each on a plane"),
        Key::new("surface", Shape::Table(&SURFACE), "each where formulas vanish"),
        Key::new("acceleration", Shape::Table(&ACCELERATION), "each accelerated as told"),
        Key::new("area", Shape::Table(&AREA), "an area that they enclose"),
        Key::new("volume", Shape::Table(&VOLUME), "a volume that they enclose"),
        Key::new(
            "rigid",
            Shape::Boolean,
            "each group is a rigid body: as many rods as hold its masses, which is three of each but six in all",
        ),
        Key::new("balls", Shape::Table(&BALLS), "none nearer to another than a diameter"),
        Key::new("faces", Shape::Tables(&FACES), "bodies with faces, none of which enters another"),
        Key::new(
            "sense",
            Shape::Choice(SENSES),
            "of a rod, a plane or a surface that holds from one side alone: masses at least, or at most, that far from each other, on the side of the normal or where the formula is positive, or on the other",
        ),
        Key::number(
            "restitution",
            "",
            Range::closed(0.0, 1.0),
            "of what has a sense, of balls and of faces: part of the velocity of approach that masses part with",
        )
        .or(Value::Number(0.0)),
        Key::number("friction", "", Range::NOT_NEGATIVE, "of the same, Coulomb's coefficient")
            .or(Value::Number(0.0)),
        Key::number(
            "radius",
            "m",
            Range::NOT_NEGATIVE,
            "of planes and surfaces with a sense: how far from them masses stay; of a surface in the unit of its formula",
        )
        .or(Value::Number(0.0)),
        Key::number(
            "time",
            "s",
            Range::NOT_NEGATIVE,
            "of the critically damped motion by which what does not hold at the start comes to hold; within a step where it is 0",
        )
        .or(Value::Number(0.0)),
        Key::number(
            "yields_at",
            "",
            Range::POSITIVE,
            "of a rod [N], an angle [N m], an area [N/m] or a volume [Pa], in which it may be written: the most that keeps it; beyond that it gives way, and stays as it was moulded",
        ),
        Key::new("augmented", Shape::Table(&AUGMENTED), "kept by an augmented Lagrangian, and not exactly"),
    ],
);

/// A constraint on masses.
pub struct ConstraintSpec {
    /// Empty: it goes by its number.
    pub name: String,
    /// Names of groups; none for all masses.
    pub of: Vec<String>,
    pub kind: Option<ConstraintKind>,
    /// [s]
    pub time: f64,
    pub augmented: Option<Augmented>,
    /// The greatest multiplier; none where `None`.
    pub yields_at: Option<f64>,
    /// From which side it holds; from both where `None`.
    pub sense: Option<Sense>,
    pub law: ImpactLaw,
    /// [m]
    pub radius: f64,
    pub site: Site,
    /// Of what is said of its kind.
    pub kind_site: Site,
}

/// What is related.
pub enum ConstraintKind {
    /// At a length [m], that at rest where `None`.
    Rod(Join, Option<f64>),
    Joint(Join),
    /// Along a direction, that at rest where `None`, turned by rotation vectors [rad].
    Direction(Join, Option<Vec3>, Option<MotionSpec>),
    /// Of three masses each [rad], that at rest where `None`, and the axis about which it is.
    Angle(Vec<[u32; 3]>, Option<Formula>, Option<Vec3>),
    Nail(Guided),
    Line(Guided, Vec3),
    Plane(Guided, Vec3),
    /// Of [`LOAD_VARIABLES`].
    Surface(Vec<Formula>),
    /// [m/s²]
    Acceleration([Formula; 3], [bool; 3]),
    /// Seen against a normal, and the part of what it is at rest that is kept, of time.
    Area(Vec3, Formula),
    /// Of triangles, and the part likewise.
    Volume(Vec<[u32; 3]>, Formula),
    /// Each group by rods.
    Rigid,
    /// Of a diameter [m].
    Balls(f64),
    Faces(Vec<FacesSpec>),
}

/// What guides masses.
pub struct Guided {
    /// Where each mass rests where `None` [m].
    pub place: Option<Vec3>,
    pub motion: Option<MotionSpec>,
}

impl Guided {
    fn read(reader: &Reader) -> Self {
        let motion = reader.table("motion").and_then(|table| MotionSpec::read(&table));
        Self { place: reader.maybe_vector("place"), motion }
    }
}

impl ConstraintSpec {
    pub(super) fn read(reader: &Reader) -> Self {
        let of = reader.texts("of");
        let written = reader.written(KINDS);
        let kind = match written[..] {
            ["faces"] => ConstraintKind::faces(&of, reader),
            ["rigid"] => ConstraintKind::rigid(reader),
            [kind] => reader.table(kind).and_then(|table| ConstraintKind::read(kind, &of, &table)),
            _ => {
                let message = match written.len() {
                    0 => "it is not said what is constrained".to_owned(),
                    _ => format!("a constraint is of one kind, this is {}", written.join(" and ")),
                };
                reader.log().add(
                    Code::WrongType,
                    &reader.site(),
                    message,
                    format!("one of {}", KINDS.join(", ")),
                );
                None
            }
        };
        let augmented = reader.table("augmented").map(|table| Augmented {
            stiffness: table.number("stiffness"),
            damping: table.number("damping"),
            rate: table.number("rate"),
        });
        let refuse = |key: &str, message: &str, expected: &str| {
            reader.log().add(Code::Conflict, &reader.site_of(key), message, expected);
        };
        if augmented.is_some() && reader.has("time") {
            refuse("time", "an augmented Lagrangian has times of its own", "`time` or `augmented`");
        }
        if let Some(ConstraintKind::Acceleration(..)) = kind {
            for key in reader.written(&["time", "augmented"]) {
                refuse(key, "an acceleration is told, and held at once", "`acceleration` alone");
            }
        }
        let sense = reader.has("sense").then(|| match reader.choice("sense") {
            "at_most" => Sense::AtMost,
            _ => Sense::AtLeast,
        });
        check_sense(kind.as_ref(), sense, reader, &refuse);
        let yields_at = limit(kind.as_ref(), reader, &refuse);
        let law =
            ImpactLaw { restitution: reader.number("restitution"), friction: reader.number("friction") };
        let kind_site = written.first().map_or_else(|| reader.site(), |kind| reader.site_of(kind));
        Self {
            name: reader.text("name"),
            of,
            kind,
            time: reader.number("time"),
            augmented,
            yields_at,
            sense,
            law,
            radius: reader.number("radius"),
            site: reader.site(),
            kind_site,
        }
    }

    /// The name of its force, by its number in the network of a body.
    pub fn force_name(&self, body: &str, index: usize) -> String {
        match &self.name[..] {
            "" => format!("{body}.constraints[{index}]"),
            name => format!("{body}.{name}"),
        }
    }

    /// Whether it holds from one side alone, by forces that push and do not pull.
    pub fn is_sided(&self) -> bool {
        self.sense.is_some() || self.kind.as_ref().is_some_and(ConstraintKind::keeps_apart)
    }

    /// The groups that it names.
    pub fn groups(&self) -> impl Iterator<Item = &String> {
        let faces = match &self.kind {
            Some(ConstraintKind::Faces(bodies)) => &bodies[..],
            _ => &[],
        };
        self.of.iter().chain(faces.iter().flat_map(|bodies| &bodies.of))
    }
}

/// Refuses senses of what has no sides, and what only sides have.
fn check_sense(
    kind: Option<&ConstraintKind>,
    sense: Option<Sense>,
    reader: &Reader,
    refuse: &impl Fn(&str, &str, &str),
) {
    let Some(kind) = kind else { return };
    let has_sides = match kind {
        ConstraintKind::Rod(..) | ConstraintKind::Plane(..) => true,
        ConstraintKind::Surface(zeros) => zeros.len() == 1,
        _ => false,
    };
    if sense.is_some() && !has_sides {
        refuse(
            "sense",
            "this constraint has no two sides",
            "`sense` of a rod, a plane or a surface of one formula",
        );
    }
    let keeps_apart = kind.keeps_apart();
    if sense.is_none() && !keeps_apart {
        for key in reader.written(&OF_SIDED) {
            refuse(key, "this constraint holds from both sides", "a `sense`, `balls` or `faces`");
        }
    } else {
        for key in reader.written(&["time", "augmented"]) {
            refuse(
                key,
                "what holds from one side holds at once",
                "a constraint without `sense`, or no such key",
            );
        }
    }
    let is_rod = matches!(kind, ConstraintKind::Rod(..));
    if (is_rod || keeps_apart) && reader.has("radius") {
        refuse(
            "radius",
            "masses are kept from each other",
            "`length` of the rod, `diameter` of the balls, or `radius` within `faces`",
        );
    }
    if is_rod && sense == Some(Sense::AtMost) && reader.number("friction") > 0.0 {
        refuse("friction", "a string has nothing to rub on", "friction of what keeps masses apart");
    }
}

/// What a constraint bears, in the unit of its multiplier; refuses limits of what has several of these, and what else would say how a constraint is kept.
fn limit(kind: Option<&ConstraintKind>, reader: &Reader, refuse: &impl Fn(&str, &str, &str)) -> Option<f64> {
    let kind = kind.filter(|_| reader.has("yields_at"))?;
    for key in reader.written(&["time", "augmented", "sense"]) {
        refuse(
            key,
            "what gives way holds at once, exactly and from both sides",
            "`yields_at`, or no such key",
        );
    }
    let unit = match kind {
        ConstraintKind::Rod(..) => "N",
        ConstraintKind::Angle(..) => "N m",
        ConstraintKind::Area(..) => "N/m",
        ConstraintKind::Volume(..) => "Pa",
        _ => {
            refuse(
                "yields_at",
                "this constraint does not give way",
                "`yields_at` of a rod, an angle, an area or a volume",
            );
            return None;
        }
    };
    reader.maybe_number_in("yields_at", unit)
}

impl ConstraintKind {
    /// Whether it is of what keeps out of each other, wherever it comes near.
    fn keeps_apart(&self) -> bool {
        matches!(self, Self::Balls(_) | Self::Faces(_))
    }

    fn rigid(reader: &Reader) -> Option<Self> {
        // what is no boolean has been told
        if reader.reading("rigid")?.boolean()? {
            return Some(Self::Rigid);
        }
        let message = "it is said that nothing is constrained, by `rigid = false`";
        reader.log().add(Code::Conflict, &reader.site_of("rigid"), message, "`rigid = true`");
        None
    }

    fn faces(of: &[String], reader: &Reader) -> Option<Self> {
        if !of.is_empty() {
            let message = "each of the bodies says which groups it is of";
            reader.log().add(Code::Conflict, &reader.site_of("of"), message, "`of` within `faces`");
            return None;
        }
        let tables = reader.tables("faces");
        if tables.is_empty() {
            let message = "there are no faces";
            reader.log().add(
                Code::EmptyRegion,
                &reader.site_of("faces"),
                message,
                "a table for each form of bodies",
            );
        }
        let bodies: Vec<FacesSpec> = tables.iter().filter_map(FacesSpec::read).collect();
        // what is missing has been told
        (bodies.len() == tables.len() && !bodies.is_empty()).then_some(Self::Faces(bodies))
    }

    fn read(kind: &str, of: &[String], reader: &Reader) -> Option<Self> {
        Some(match kind {
            "rod" | "joint" | "direction" | "balls" if of.len() > 2 => {
                let message = format!("`{kind}` is between one group and itself, or two groups");
                reader.log().add(Code::Conflict, &reader.site(), message, "one group in `of`, or two");
                return None;
            }
            "rod" => Self::Rod(Join::read(reader, of, &reader.site())?, reader.maybe_number("length")),
            "joint" => Self::Joint(Join::read(reader, of, &reader.site())?),
            "direction" => {
                let rotation = reader.table("rotation").and_then(|table| MotionSpec::read(&table));
                Self::Direction(
                    Join::read(reader, of, &reader.site())?,
                    maybe_axis(reader, "along")?,
                    rotation,
                )
            }
            "angle" => {
                let value = match reader.has("value") {
                    true => Some(reader.maybe_formula("value")?),
                    false => None,
                };
                Self::Angle(corners(reader)?, value, maybe_axis(reader, "axis")?)
            }
            "nail" => Self::Nail(Guided::read(reader)),
            "line" => Self::Line(Guided::read(reader), axis(reader, "direction")?),
            "plane" => Self::Plane(Guided::read(reader), axis(reader, "normal")?),
            "surface" => {
                let zeros = ["zero", "also_zero"].map(|key| reader.maybe_formula(key));
                Self::Surface(zeros.into_iter().flatten().collect())
            }
            "acceleration" => {
                Self::Acceleration(reader.maybe_vector_formula("formula")?, reader.axes("axes"))
            }
            "balls" => Self::Balls(reader.maybe_number("diameter")?),
            "area" => Self::Area(axis(reader, "normal")?, part(reader)?),
            _ => Self::Volume(triangles(reader, &[1])?, part(reader)?),
        })
    }
}

/// A vector that has a direction, made of length 1.
fn axis(reader: &Reader, key: &str) -> Option<Vec3> {
    let axis = reader.vector(key).try_normalised();
    if axis.is_none() && reader.has(key) {
        let expected = "a vector that is not zero, such as [0, 0, 1]";
        reader.log().add(Code::Conflict, &reader.site_of(key), "an axis of no length", expected);
    }
    axis
}

/// The same where it is written; `None` where that is refused.
fn maybe_axis(reader: &Reader, key: &str) -> Option<Option<Vec3>> {
    if reader.has(key) { axis(reader, key).map(Some) } else { Some(None) }
}

fn part(reader: &Reader) -> Option<Formula> {
    if reader.has("part") { reader.maybe_formula("part") } else { Some(Formula::constant(1.0)) }
}

/// Lists of three different numbers of masses.
fn triples(reader: &Reader, key: &str) -> Option<Vec<[u32; 3]>> {
    let is_number = |x: f64| x >= 0.0 && x.fract() == 0.0 && x <= f64::from(u32::MAX);
    let mut triples = Vec::new();
    if !reader.has(key) {
        return Some(triples);
    }
    // what is no list of three numbers has been told
    for (index, corners) in reader.maybe_vectors(key)?.into_iter().enumerate() {
        let corners = corners.to_array();
        let [a, b, c] = corners;
        if !corners.into_iter().all(is_number) || a == b || b == c || c == a {
            let message = format!("{key}[{index}] is {}", listed(corners));
            let expected = "three different numbers of masses";
            reader.log().add(Code::OutOfRange, &reader.site_of(key), message, expected);
            return None;
        }
        triples.push(corners.map(|corner| corner as u32));
    }
    Some(triples)
}

/// Numbers as they are written: without a point where they are whole.
fn listed(numbers: [f64; 3]) -> String {
    let [a, b, c] = numbers;
    format!("[{a}, {b}, {c}]")
}

fn corners(reader: &Reader) -> Option<Vec<[u32; 3]>> {
    let corners = triples(reader, "corners")?;
    if corners.is_empty() && reader.has("corners") {
        let expected = "three numbers of masses, such as [[0, 1, 2]]";
        reader.log().add(Code::OutOfRange, &reader.site_of("corners"), "there are no corners", expected);
        return None;
    }
    Some(corners)
}

/// Numbers of a surface, whose sides are each met in the opposite direction by as many others as are allowed.
pub(super) fn triangles(reader: &Reader, others: &[usize]) -> Option<Vec<[u32; 3]>> {
    let refuse = |message: String, expected: &str| {
        reader.log().add(Code::OutOfRange, &reader.site_of("triangles"), message, expected);
        None
    };
    let triangles = triples(reader, "triangles")?;
    let sides = |[a, b, c]: [u32; 3]| [[a, b], [b, c], [c, a]];
    let mut met = std::collections::HashMap::new();
    triangles.iter().flat_map(|corners| sides(*corners)).for_each(|side| *met.entry(side).or_insert(0) += 1);
    for side in triangles.iter().flat_map(|corners| sides(*corners)) {
        let [a, b] = side;
        let opposite = met.get(&[b, a]).copied().unwrap_or(0);
        if met[&side] != 1 {
            let message = format!("the side from mass {a} to mass {b} is of {} triangles", met[&side]);
            return refuse(message, "triangles that are all counterclockwise seen from outside");
        }
        if !others.contains(&opposite) {
            let message = format!("the side from mass {a} to mass {b} is not met by one other triangle");
            return refuse(
                message,
                "a closed surface, all of whose triangles are counterclockwise seen from outside",
            );
        }
    }
    if triangles.is_empty() && reader.has("triangles") {
        return refuse("there are no triangles".to_owned(), "three numbers of masses for each");
    }
    Some(triangles)
}
