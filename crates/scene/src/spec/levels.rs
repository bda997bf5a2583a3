//! Bodies of several meshes: how many, how coarse, who decides which one is at work.

use souple_formal::Formula;
use souple_models::multiresolution::{
    Choice, Coupling, Criterion, Loops, MOST, Measure, PLACE_VARIABLES, Stiffness,
};
use souple_table::{Range, Value};

use super::mesh::{MESH, MeshSpec};
use super::region::Region;
use crate::diagnostic::{Code, Site};
use crate::keys::{Key, Keys, Shape};
use crate::reader::Reader;

static COARSER: Keys = Keys::new(
    "coarser_mesh",
    "a coarser mesh of a body",
    &[Key::new("mesh", Shape::Entry(MESH), "its shape at rest, of tetrahedra").required()],
);

static DRESS: Keys = Keys::new(
    "dress",
    "a surface that is shown in the place of the body's own, and follows whichever mesh is at work",
    &[
        Key::new("mesh", Shape::Entry(MESH), "whose boundary it is; the body's own where left out"),
        Key::number("blend", "s", Range::NOT_NEGATIVE, "in which what would jump as levels change fades")
            .or(Value::Number(0.12)),
        Key::number(
            "most",
            "m",
            Range::POSITIVE,
            "that a node moves by from one period to the next as levels change; what is left fades longer",
        ),
    ],
);

static CUT: Keys = Keys::new(
    "cut",
    "matter that is cut through: from its date on it carries nothing, whichever mesh is at work",
    &[
        Key::new(
            "region",
            Shape::Region,
            "cells of the body's own mesh of which all nodes, or the centre, are inside",
        )
        .required(),
        Key::number("time", "s", Range::NOT_NEGATIVE, "its date; steps that begin then or later find it cut")
            .or(Value::Number(0.0)),
    ],
);

pub(crate) static LEVELS: Keys = Keys::new(
    "levels",
    "coarser meshes of the body, one of which is at work wherever its own mesh need not be",
    &[
        Key::integer(
            "count",
            Range::closed(1.0, MOST as f64),
            "meshes in all, the body's own included; the others fill its surface, each coarser than the one before",
        )
        .or(Value::Integer(3)),
        Key::number(
            "ratio",
            "",
            Range::closed(1.2, 8.0),
            "length of the edges of a mesh over those of the next finer one",
        )
        .or(Value::Number(2.0)),
        Key::new(
            "cells",
            Shape::Integers,
            "tetrahedra wanted of each coarser mesh, from coarse to fine, within a fifth, in the place of `count` and `ratio`",
        ),
        Key::new("coarser", Shape::Tables(&COARSER), "the coarser meshes, from coarse to fine, in the place of `count`"),
        Key::new(
            "coupling",
            Shape::Choice(&["transpose", "one_way"]),
            "forces on points that follow return to those that they follow, or are lost",
        )
        .or(Value::Text("transpose")),
        Key::new(
            "loops",
            Shape::Choice(&["activated", "lagged"]),
            "with `coupling = \"one_way\"`: corners of the tetrahedron that carries a subdivided point are active, or they follow, and where two points follow each other both are a tick late",
        )
        .or(Value::Text("activated")),
        Key::new(
            "stiffness",
            Shape::Choice(&["own", "as_finest", "as_held"]),
            "of the coarser meshes: as their tetrahedra are, too stiff, or with moduli by which each yields to the body's softest loads as the finest does, free or as pins hold it",
        )
        .or(Value::Text("own")),
        Key::new(
            "criterion",
            Shape::Choice(&["jump", "laplacian"]),
            "what is measured around a point: how the deformation gradient varies, or the Laplacian of the displacement",
        )
        .or(Value::Text("jump")),
        Key::number("refine", "", Range::NOT_NEGATIVE, "finer points take the place of a point above this variation")
            .or(Value::Number(0.1)),
        Key::number("coarsen", "", Range::NOT_NEGATIVE, "they go when it is below this around all of them")
            .or(Value::Number(0.025)),
        Key::number(
            "settled",
            "s",
            Range::NOT_NEGATIVE,
            "date until which the finest mesh alone is at work; the variation that the body's own loads have made by then is not counted",
        ),
        Key::new(
            "fixed",
            Shape::Formula(&PLACE_VARIABLES),
            "the level at a place, counted from 0, the coarsest, in the place of a criterion",
        ),
        Key::new("dress", Shape::Table(&DRESS), "the surface that is shown"),
        Key::new("cuts", Shape::Tables(&CUT), "what is cut through, and when"),
        Key::number("budget", "", Range::POSITIVE, "stresses that a step may evaluate; without it, any number"),
    ],
);

/// The levels of a body as specified.
pub struct LevelsSpec {
    pub count: usize,
    pub ratio: f64,
    /// Tetrahedra of each coarser mesh, from coarse to fine; by `count` and `ratio` where empty.
    pub cells: Vec<usize>,
    pub coarser: Vec<MeshSpec>,
    pub coupling: Coupling,
    pub loops: Loops,
    pub stiffness: Stiffness,
    pub criterion: Criterion,
    pub fixed: Option<Formula>,
    pub budget: Option<f64>,
    pub dress: Option<DressSpec>,
    pub cuts: Vec<CutSpec>,
    pub site: Site,
}

/// Matter that is cut through, as specified.
pub struct CutSpec {
    /// `None` where it was refused.
    pub region: Option<Region>,
    /// [s]
    pub time: f64,
    pub site: Site,
}

/// A display surface as specified.
pub struct DressSpec {
    /// Whose boundary it is, where not the body's own.
    pub mesh: Option<MeshSpec>,
    /// [s]
    pub blend: f64,
    /// [m]
    pub most: Option<f64>,
    pub site: Site,
}

impl LevelsSpec {
    pub(crate) fn read(reader: &Reader) -> Self {
        let coarser: Vec<MeshSpec> = reader.tables("coarser").iter().filter_map(MeshSpec::read).collect();
        if reader.has("coarser") {
            for key in reader.written(&["count", "ratio", "cells"]) {
                let message = format!("`{key}` is of meshes that are made, and these are given");
                reader.log().add(Code::Conflict, &reader.site_of(key), message, "`coarser` alone");
            }
        }
        let cells = reader.maybe_indices("cells");
        if reader.has("cells") {
            for key in reader.written(&["count", "ratio"]) {
                let message = format!("`{key}` and `cells` both say how coarse the meshes are");
                reader.log().add(Code::Conflict, &reader.site_of(key), message, "`cells` alone");
            }
        }
        if let Some(cells) = &cells {
            let rises = cells.windows(2).all(|pair| pair[0] < pair[1]);
            if !(rises && (1..MOST).contains(&cells.len()) && cells.iter().all(|count| *count >= 1)) {
                let message = format!("{cells:?} are no numbers of tetrahedra from coarse to fine");
                let expected = format!("1 to {} rising numbers of at least 1, as [28, 172]", MOST - 1);
                reader.log().add(Code::OutOfRange, &reader.site_of("cells"), message, expected);
            }
        }
        let measure =
            if reader.choice("criterion") == "laplacian" { Measure::Laplacian } else { Measure::Jump };
        let criterion = Criterion {
            measure,
            refine: reader.number("refine"),
            coarsen: reader.number("coarsen"),
            settled: reader.maybe_number("settled"),
        };
        if criterion.flickers() {
            let message = "points would come and go in every step";
            let expected = format!("at most half of `refine`, {}", 0.5 * criterion.refine);
            reader.log().add(Code::Conflict, &reader.site_of("coarsen"), message, expected);
        }
        if reader.has("fixed") {
            for key in reader.written(&["criterion", "refine", "coarsen", "settled", "budget"]) {
                let message = format!("`{key}` is of levels that change, and `fixed` says what they are");
                reader.log().add(Code::Conflict, &reader.site_of(key), message, "`fixed` alone");
            }
        }
        let loops = if reader.choice("loops") == "lagged" { Loops::Lagged } else { Loops::Activated };
        if loops == Loops::Lagged && reader.choice("coupling") != "one_way" {
            let message = "points that are late give nothing back to those that they follow";
            reader.log().add(Code::Conflict, &reader.site_of("loops"), message, "`coupling = \"one_way\"`");
        }
        Self {
            count: reader.maybe_integer("count").unwrap_or(3) as usize,
            ratio: reader.number("ratio"),
            cells: cells.unwrap_or_default().into_iter().map(|count| count as usize).collect(),
            coarser,
            coupling: if reader.choice("coupling") == "one_way" {
                Coupling::OneWay
            } else {
                Coupling::Transpose
            },
            loops,
            stiffness: match reader.choice("stiffness") {
                "as_finest" => Stiffness::AsFinest,
                "as_held" => Stiffness::AsHeld,
                _ => Stiffness::Own,
            },
            criterion,
            fixed: reader.maybe_formula("fixed"),
            budget: reader.maybe_number("budget"),
            dress: reader.table("dress").map(|dress| DressSpec {
                mesh: dress.has("mesh").then(|| MeshSpec::read(&dress)).flatten(),
                blend: dress.number("blend"),
                most: dress.maybe_number("most"),
                site: dress.site(),
            }),
            cuts: reader
                .tables("cuts")
                .iter()
                .map(|cut| CutSpec {
                    region: Region::read(cut, "region"),
                    time: cut.number("time"),
                    site: cut.site(),
                })
                .collect(),
            site: reader.site(),
        }
    }

    pub fn choice(&self) -> Choice {
        match &self.fixed {
            Some(level) => Choice::Fixed(level.clone()),
            None => Choice::Adaptive(self.criterion),
        }
    }
}
