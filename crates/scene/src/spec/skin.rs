//! Skins: what they are drawn to, what moves them, how fine they are.

use souple_formal::Formula;
use souple_math::Vec3;
use souple_models::loads::TIME_VARIABLES;
use souple_skin::strategy::{BuildTerm, TERMS};
use souple_skin::target::{BuildPart, BuildWarp, Combine, PARTS, WARPS};
use souple_table::{Entry, Range, Table, Value, Values};

use crate::diagnostic::{Code, Site};
use crate::keys::{EntryShape, Key, Keys, NOWHERE, Others, Shape, outlines};
use crate::reader::{Chosen, Reader};

const PART: EntryShape = EntryShape {
    tag: "name",
    kind: "skin part",
    outlines: || outlines(&PARTS),
    instead: &[],
    elsewhere: NOWHERE,
};
const TERM: EntryShape = EntryShape {
    tag: "name",
    kind: "skin term",
    outlines: || outlines(&TERMS),
    instead: &[],
    elsewhere: NOWHERE,
};
const WARP: EntryShape = EntryShape {
    tag: "name",
    kind: "skin warp",
    outlines: || outlines(&WARPS),
    instead: &[],
    elsewhere: NOWHERE,
};

static SKIN_WARP: Keys = Keys {
    name: "skin_warp",
    summary: "a warp of a part; its parameters stand beside",
    keys: &[Key::new("warp", Shape::Entry(WARP), "what it does").required()],
    others: Others::ParametersOf("warp"),
};

static SKIN_PART: Keys = Keys {
    name: "skin_part",
    summary: "a potential that a skin is drawn to; its parameters stand beside",
    keys: &[
        Key::new("part", Shape::Entry(PART), "what it is").required(),
        Key::new("combine", Shape::Choice(Combine::NAMES), "how it joins the parts before it")
            .or(Value::Text("blend")),
        Key::new("during", Shape::Numbers, "two times: it is there from the first to before the second")
            .in_unit("s"),
        Key::new("motion", Shape::VectorFormula(&TIME_VARIABLES), "moves it: numbers, or formulas of time")
            .in_unit("m"),
        Key::new("warps", Shape::Tables(&SKIN_WARP), "applied in this order"),
    ],
    others: Others::ParametersOf("part"),
};

static SKIN_TERM: Keys = Keys {
    name: "skin_term",
    summary: "a term of a skin's speed; its parameters stand beside",
    keys: &[Key::new("term", Shape::Entry(TERM), "what it does").required()],
    others: Others::ParametersOf("term"),
};

const VOXEL: Key =
    Key::number("voxel", "m", Range::POSITIVE, "distance between nodes of a skin's grid").required();
const ORIGIN: Key = Key::vector("origin", "m", "a node of the grid").or(Value::Vector([0.0; 3]));
const ISO: Key =
    Key::number("iso", "", Range::ANY, "value of the potential on the skin").or(Value::Number(0.5));
const REDISTANCE: Key = Key::number(
    "redistance",
    "",
    Range::closed(0.0, 0.5),
    "share of the way that the values around a skin go back to distances in a sub-step",
)
.or(Value::Number(0.25));
const TERMS_KEY: Key =
    Key::new("terms", Shape::Tables(&SKIN_TERM), "what moves the skin: their speeds add up");
const DOMAIN: Key =
    Key::new("domain", Shape::Corners, "box in which the skin begins; around its parts where left out")
        .in_unit("m");

/// Formats of surfaces that a run may write.
const FORMATS: &[&str] = &["obj", "ply", "stl"];
const WRITE: Key =
    Key::new("write", Shape::Texts, "formats that a run writes its surface in beside VTU: obj, ply, stl");

pub(crate) static SKIN: Keys = Keys::new(
    "skin",
    "a surface with behaviour of its own: the zero level of a potential on a sparse grid",
    &[
        VOXEL,
        ORIGIN,
        ISO,
        REDISTANCE,
        DOMAIN,
        WRITE,
        Key::new("parts", Shape::Tables(&SKIN_PART), "what it is drawn to"),
        Key::new("start", Shape::Tables(&SKIN_PART), "what it begins as; its `parts` where left out"),
        TERMS_KEY,
    ],
);

pub(crate) static BODY_SKIN: Keys = Keys::new(
    "body_skin",
    "a skin that dresses a body: the density of its points, or its surface",
    &[
        VOXEL,
        ORIGIN,
        ISO,
        REDISTANCE,
        DOMAIN,
        WRITE,
        Key::number(
            "radius",
            "m",
            Range::POSITIVE,
            "of the body's points as particles, half the distance between them; where left out the skin dresses the body's surface, which networks have not",
        ),
        Key::new("group", Shape::Text, "only the points of this group, as particles"),
        Key::number(
            "offset",
            "m",
            Range::ANY,
            "outward from the body's surface; a voxel where left out, so that the skin covers the body",
        ),
        TERMS_KEY,
        Key::new("push", Shape::Table(&SKIN_PUSH), "what it does to the body's points"),
    ],
);

static SKIN_PUSH: Keys = Keys::new(
    "skin_push",
    "what a skin does to the particles it dresses",
    &[
        Key::number("tension", "N/m", Range::NOT_NEGATIVE, "of its surface").or(Value::Number(0.0)),
        Key::number("pressure", "Pa", Range::NOT_NEGATIVE, "outward, for each relative loss of its volume")
            .or(Value::Number(0.0)),
    ],
);

/// What a skin does to the particles it dresses.
#[derive(Clone, Debug, PartialEq)]
pub struct PushSpec {
    /// [N/m]
    pub tension: f64,
    /// [Pa]
    pub pressure: f64,
    /// Of the particles [m].
    pub radius: Option<f64>,
    /// Whose points they are; empty: all.
    pub group: String,
}

/// A part of a target.
pub struct PartSpec {
    pub part: Option<Chosen<BuildPart>>,
    pub combine: Combine,
    /// [s]
    pub during: [f64; 2],
    /// Of time [m].
    pub motion: Option<[Formula; 3]>,
    pub warps: Vec<Chosen<BuildWarp>>,
    pub site: Site,
}

/// A skin.
pub struct SkinSpec {
    pub name: String,
    /// [m]
    pub voxel: f64,
    /// [m]
    pub origin: Vec3,
    pub iso: f64,
    pub redistance: f64,
    /// [m]
    pub domain: Option<[Vec3; 2]>,
    pub parts: Vec<PartSpec>,
    pub start: Vec<PartSpec>,
    pub terms: Vec<Chosen<BuildTerm>>,
    pub push: Option<PushSpec>,
    /// Extensions of formats that a run writes it in.
    pub formats: Vec<String>,
    pub site: Site,
}

impl PartSpec {
    fn read(reader: &Reader) -> Self {
        let during = match reader.numbers("during")[..] {
            [] => [f64::NEG_INFINITY, f64::INFINITY],
            [from, until] if from < until => [from, until],
            _ => {
                let site = reader.site_of("during");
                let message = "these are not two times that grow";
                reader.log().add(Code::OutOfRange, &site, message, "two times, the second after the first");
                [f64::NEG_INFINITY, f64::INFINITY]
            }
        };
        Self {
            part: reader.entry("part", &PARTS),
            combine: Combine::named(reader.choice("combine")),
            during,
            motion: reader.maybe_vector_formula("motion"),
            warps: reader.tables("warps").iter().filter_map(|warp| warp.entry("warp", &WARPS)).collect(),
            site: reader.site(),
        }
    }

    /// A part as if it were written so.
    fn written<B>(table: &'static Table<B>, name: &str, values: Values, site: &Site) -> Option<Chosen<B>> {
        let entry: &'static Entry<B> = table.find(name).ok()?;
        let values = entry.values(values).ok()?;
        Some(Chosen { entry, values, site: site.clone(), written: Vec::new(), texts: Vec::new() })
    }
}

/// Corners in their order, lowest first.
fn domain(reader: &Reader) -> Option<[Vec3; 2]> {
    let [low, high] = reader.corners("domain")?;
    let size = high - low;
    if size.to_array().into_iter().all(|along| along > 0.0) {
        return Some([low, high]);
    }
    let message = format!("this box goes from {:?} to {:?}", low.to_array(), high.to_array());
    let expected = "the lowest corner, then the highest";
    reader.log().add(Code::OutOfRange, &reader.site_of("domain"), message, expected);
    None
}

fn parts(reader: &Reader, key: &str) -> Vec<PartSpec> {
    let parts: Vec<PartSpec> = reader.tables(key).iter().map(PartSpec::read).collect();
    if let Some(first) = parts.first().filter(|first| !first.combine.adds()) {
        let message = format!("nothing stands before the first of `{key}` that it could be combined with");
        reader.log().add(Code::Conflict, &first.site, message, "blend or union for the first part");
    }
    parts
}

impl SkinSpec {
    /// What all skins have, without parts.
    fn bare(name: String, reader: &Reader) -> Self {
        let formats = reader.texts("write");
        if let Some(unknown) = formats.iter().find(|format| !FORMATS.contains(&format.as_str())) {
            let message = format!("`{unknown}` is no format of surfaces that a run writes");
            reader.log().add(Code::UnknownName, &reader.site_of("write"), message, FORMATS.join(", "));
        }
        Self {
            formats,
            push: None,
            name,
            voxel: reader.number("voxel"),
            origin: reader.vector("origin"),
            iso: reader.number("iso"),
            redistance: reader.number("redistance"),
            domain: domain(reader),
            parts: Vec::new(),
            start: Vec::new(),
            terms: reader.tables("terms").iter().filter_map(|term| term.entry("term", &TERMS)).collect(),
            site: reader.site(),
        }
    }

    pub(crate) fn read(name: String, reader: &Reader) -> Self {
        let skin =
            Self { parts: parts(reader, "parts"), start: parts(reader, "start"), ..Self::bare(name, reader) };
        if skin.parts.is_empty() && skin.start.is_empty() {
            let message = "this skin has neither `parts` that it is drawn to nor a `start`";
            reader.log().add(
                Code::MissingKey,
                &skin.site,
                message,
                "[[skins.NAME.parts]] or [[skins.NAME.start]]",
            );
        }
        skin
    }

    /// The skin of a network, whose masses are particles: it has no surface.
    pub(crate) fn of_network(network: &str, reader: &Reader) -> Self {
        if !reader.has("radius") {
            let message =
                format!("the skin of network `{network}` dresses masses, and has no `radius` of them");
            reader.log().add(Code::MissingKey, &reader.site(), message, "radius = LENGTH");
        }
        Self::of_body(network, reader)
    }

    /// The skin of a body, which has the body's name.
    pub(crate) fn of_body(body: &str, reader: &Reader) -> Self {
        let push = reader.table("push").map(|push| PushSpec {
            tension: push.number("tension"),
            pressure: push.number("pressure"),
            radius: reader.maybe_number("radius"),
            group: reader.text("group"),
        });
        let bare = Self { push, ..Self::bare(body.to_owned(), reader) };
        let group = reader.text("group");
        if !group.is_empty() && !reader.has("radius") {
            let message = "the points of a group are dressed as particles, and no `radius` is given";
            reader.log().add(Code::MissingKey, &reader.site_of("group"), message, "radius = LENGTH beside");
        }
        let mut values = Values::new();
        let (part, text) = match reader.maybe_number("radius") {
            Some(radius) => {
                values.set("radius".to_owned(), Value::Number(radius));
                values.set("group".to_owned(), Value::Text(&group));
                ("particles", "from")
            }
            None => {
                let offset = reader.maybe_number("offset").unwrap_or(bare.voxel);
                values.set("offset".to_owned(), Value::Number(offset));
                ("surface", "body")
            }
        };
        if reader.has("radius") && reader.has("offset") {
            let message =
                "an `offset` is that of a skin on the body's surface, and a `radius` dresses its points";
            reader.log().add(Code::Conflict, &reader.site_of("offset"), message, "one of radius, offset");
        }
        values.set(text.to_owned(), Value::Text(body));
        let part = PartSpec {
            part: PartSpec::written(&PARTS, part, values, &bare.site),
            combine: Combine::Blend,
            during: [f64::NEG_INFINITY, f64::INFINITY],
            motion: None,
            warps: Vec::new(),
            site: bare.site.clone(),
        };
        Self { parts: vec![part], ..bare }
    }
}
