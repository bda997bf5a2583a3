//! Where a body's rest shape comes from: a generator, a file, a shape that is filled.

use souple_mesh::fill::{Options, PARAMETERS};
use souple_mesh::implicit::{BuildBody, SHAPES};
use souple_mesh::tissue::{Tissue, TissueForm};
use souple_mesh::{Build, GENERATORS};
use souple_table::{Kind, Parameter, Range, Value, Values};

use super::body::BODY;
use super::region::Region;
use crate::diagnostic::{Code, Site};
use crate::document::Content;
use crate::keys::{EntryShape, Key, Keys, NOWHERE, Need, Others, Shape, outlines};
use crate::reader::{Chosen, Reader, choose};
use crate::values::Reading;

const SCALE: Key =
    Key::number("scale", "", Range::POSITIVE, "metres in one unit of the file").or(Value::Number(1.0));

static MESH_FILE: Keys = Keys::new(
    "mesh_file",
    "a mesh from a file",
    &[Key::new("file", Shape::Text, "relative to the scene file that names it").required(), SCALE],
);

const BODY_SHAPE: EntryShape = EntryShape {
    tag: "name",
    kind: "body shape",
    outlines: || outlines(&SHAPES),
    instead: &[],
    elsewhere: NOWHERE,
};

static MESH_SHAPE: Keys = Keys {
    name: "mesh_shape",
    summary: "a shape filled with cells; the shape's own parameters stand beside",
    keys: &[
        Key::new("shape", Shape::Entry(BODY_SHAPE), "what is filled").required(),
        filling(0),
        filling(1),
        filling(2),
        filling(3),
        filling(4),
        filling(5),
        filling(6),
    ],
    others: Others::ParametersOf("shape"),
};

static MESH_FILL: Keys = Keys::new(
    "mesh_fill",
    "what a surface encloses, filled with cells",
    &[
        Key::new("fill", Shape::Text, "a surface, relative to the scene file that names it").required(),
        SCALE,
        filling(0),
        filling(1),
        filling(2),
        filling(3),
        filling(4),
        filling(5),
        filling(6),
    ],
);

const CELLS_OF_TISSUE: Range = Range::closed(1.0, 200.0);

static MESH_TISSUE: Keys = Keys::new(
    "mesh_tissue",
    "tissue built between two other bodies, and attached to both",
    &[
        Key::new(
            "tissue",
            Shape::Choice(&["ligament", "sheet", "pad", "strap"]),
            "ligament: of square section, from the middle of one region to that of the other; sheet: as wide as the regions; \
             pad: fills the gap before the faces of the first; strap: lies on outer faces of both, over all of each region and between",
        )
        .required(),
        Key::new("from", Shape::Text, "the body that it begins on").required(),
        Key::new("from_region", Shape::Region, "where on that").required(),
        Key::new("to", Shape::Text, "the body that it ends on").required(),
        Key::new("to_region", Shape::Region, "where on that").required(),
        Key::number(
            "thickness",
            "m",
            Range::POSITIVE,
            "of a ligament its sides, of a sheet or strap that of it, of a pad the widest gap that it fills",
        )
        .required(),
        Key::integer("along", CELLS_OF_TISSUE, "cells from one end to the other").or(Value::Integer(4)),
        Key::integer("across", CELLS_OF_TISSUE, "cells over the width; not of a pad")
            .or(Value::Integer(2)),
        Key::integer("through", CELLS_OF_TISSUE, "cells through the thickness; not of a pad")
            .or(Value::Integer(2)),
        Key::number(
            "strength",
            "Pa",
            Range::POSITIVE,
            "tension under which an end tears off, point by point; never where left out",
        ),
    ],
);

// all of them stand above
const _: () = assert!(PARAMETERS.len() == 7);

/// A parameter of fillings as a key.
const fn filling(index: usize) -> Key {
    let Parameter { name, summary, kind, unit, range, default } = PARAMETERS[index];
    let shape = match kind {
        Kind::Number => Shape::Number,
        Kind::Integer => Shape::Integer,
        Kind::Boolean => Shape::Boolean,
        Kind::Vector => Shape::Vector,
        Kind::Numbers => Shape::Numbers,
        Kind::Text => Shape::Text,
        Kind::Choice(choices) => Shape::Choice(choices),
        Kind::Texts => Shape::Values,
    };
    let need = match default {
        Some(value) => Need::Default(value),
        None => Need::Required,
    };
    Key { name, summary, shape, unit, range, need }
}

pub(crate) const MESH: EntryShape = EntryShape {
    tag: "generate",
    kind: "mesh generator",
    outlines: || outlines(&GENERATORS),
    instead: &[&MESH_FILE, &MESH_SHAPE, &MESH_FILL, &MESH_TISSUE],
    elsewhere: NOWHERE,
};

/// Where a body's rest shape comes from.
pub enum MeshSpec {
    Generated(Chosen<Build>),
    File {
        file: String,
        scale: f64,
        site: Site,
    },
    /// A shape known by name, or a formula.
    Shape {
        shape: Chosen<BuildBody>,
        options: Options,
    },
    /// What the surface of a file encloses.
    Filled {
        file: String,
        scale: f64,
        options: Options,
        site: Site,
    },
    /// What reaches from one body to another.
    Tissue(Box<TissueSpec>),
}

/// Tissue between two bodies.
pub struct TissueSpec {
    pub shape: Tissue,
    pub from: TissueEnd,
    pub to: TissueEnd,
    /// Tension under which its ends tear off [Pa]; infinite where they never do.
    pub strength: f64,
    pub site: Site,
}

/// Where tissue ends.
pub struct TissueEnd {
    pub body: String,
    pub region: Region,
    pub body_site: Site,
}

impl MeshSpec {
    pub fn site(&self) -> &Site {
        match self {
            Self::Generated(chosen) => &chosen.site,
            Self::Shape { shape, .. } => &shape.site,
            Self::File { site, .. } | Self::Filled { site, .. } => site,
            Self::Tissue(tissue) => &tissue.site,
        }
    }

    /// Where a parameter of a generator or a shape is written, or the whole.
    pub fn site_of(&self, parameter: &str) -> &Site {
        match self {
            Self::Generated(chosen) => chosen.site_of(parameter),
            Self::Shape { shape, .. } => shape.site_of(parameter),
            Self::File { .. } | Self::Filled { .. } | Self::Tissue(_) => self.site(),
        }
    }

    /// Tissue, where that is what it is.
    pub fn tissue(&self) -> Option<&TissueSpec> {
        if let Self::Tissue(tissue) = self { Some(tissue) } else { None }
    }

    /// `{ generate = "bar", … }`, `{ file = "bar.msh" }`, `{ shape = "liver", … }`, `{ fill = "liver.stl", … }`, or
    /// the file alone.
    pub(crate) fn read(reader: &Reader) -> Option<Self> {
        let reading = reader.reading("mesh")?;
        let site = reading.site();
        let Content::Table(table) = &reading.node.content else {
            return match &reading.node.content {
                Content::Text(file) => Some(Self::File { file: file.clone(), scale: 1.0, site }),
                _ => choose(&reading, &MESH, &GENERATORS, &[], &BODY).map(Self::Generated),
            };
        };
        let tags = ["generate", "file", "shape", "fill", "tissue"];
        let written: Vec<&str> = tags.into_iter().filter(|tag| table.get(tag).is_some()).collect();
        match written[..] {
            ["generate"] => choose(&reading, &MESH, &GENERATORS, &[], &BODY).map(Self::Generated),
            ["file"] => {
                let table = Reader::open(&reading, &MESH_FILE)?;
                let site = table.site_of("file");
                Some(Self::File { file: table.maybe_text("file")?, scale: table.number("scale"), site })
            }
            ["shape"] => {
                let table = Reader::open(&reading, &MESH_SHAPE)?;
                let options = read_options(&table, &reading);
                let shape = table.entry("shape", &SHAPES)?;
                Some(Self::Shape { shape, options: options? })
            }
            ["fill"] => {
                let table = Reader::open(&reading, &MESH_FILL)?;
                let (site, options) = (table.site_of("fill"), read_options(&table, &reading)?);
                let (file, scale) = (table.maybe_text("fill")?, table.number("scale"));
                Some(Self::Filled { file, scale, options, site })
            }
            ["tissue"] => {
                let table = Reader::open(&reading, &MESH_TISSUE)?;
                read_tissue(&table, site).map(|tissue| Self::Tissue(Box::new(tissue)))
            }
            _ => {
                let says = if written.is_empty() { "none".to_owned() } else { written.join(" and ") };
                let message = format!("a mesh says one of {}, this one says {says}", tags.join(", "));
                let expected = "{ generate = \"bar\", … }, { file = \"…\" }, { shape = \"liver\", … }, \
                                { fill = \"…\", … } or { tissue = \"ligament\", … }";
                reading.refuse(Code::MissingKey, message, expected)
            }
        }
    }
}

fn read_tissue(table: &Reader, site: Site) -> Option<TissueSpec> {
    let end = |body: &str, region: &str| {
        let region = Region::read(table, region)?;
        Some(TissueEnd { body: table.maybe_text(body)?, region, body_site: table.site_of(body) })
    };
    let (from, to) = (end("from", "from_region"), end("to", "to_region"));
    let cells = |key: &str| table.maybe_integer(key).map(|count| count as usize);
    let form = match table.choice("tissue") {
        "sheet" => TissueForm::Sheet,
        "pad" => TissueForm::Pad,
        "strap" => TissueForm::Strap,
        _ => TissueForm::Ligament,
    };
    if form == TissueForm::Pad {
        for key in ["across", "through"].into_iter().filter(|key| table.has(key)) {
            let message = format!("a pad has the cells of the faces that it begins on, and no `{key}`");
            table.log().add(Code::Conflict, &table.site_of(key), message, "`along` alone");
        }
    }
    let shape = Tissue {
        form,
        thickness: table.maybe_number("thickness")?,
        along: cells("along")?,
        across: cells("across")?,
        through: cells("through")?,
    };
    let strength = table.maybe_number("strength").unwrap_or(f64::INFINITY);
    Some(TissueSpec { shape, from: from?, to: to?, strength, site })
}

fn read_options(table: &Reader, whole: &Reading) -> Option<Options> {
    let mut values = Values::new();
    let mut is_good = true;
    for parameter in PARAMETERS {
        if let Some(reading) = table.reading(parameter.name) {
            is_good &= reading.parameter(parameter, &mut values).is_some();
        }
    }
    if !is_good {
        return None;
    }
    let options =
        values.completed(PARAMETERS).map_err(Into::into).and_then(|values| Options::from_values(&values));
    let refuse = |error: souple_mesh::MeshError| {
        whole.refuse(Code::OutOfRange, error.to_string(), "such as size = \"5 mm\" or count = 10000")
    };
    options.map_or_else(refuse, Some)
}
