//! Bodies of particles of an octree: how many levels, what forces, who decides which level is at work.

use souple_formal::Formula;
use souple_models::particles::Operators;
use souple_models::particles::octree::{
    MOST_LEVELS, OctreeChoice, OctreeOperators, PLACE_VARIABLES, Variant,
};
use souple_table::{Range, Value};

use crate::diagnostic::{Code, Site};
use crate::keys::{Key, Keys, Shape};
use crate::reader::Reader;

pub(crate) static OCTREE: Keys = Keys::new(
    "octree",
    "the points of a lattice of cubes as particles, grouped by eight where little happens",
    &[
        Key::integer(
            "levels",
            Range::closed(1.0, MOST_LEVELS as f64),
            "in all; each groups the particles of the one before by eight",
        )
        .or(Value::Integer(3)),
        Key::new(
            "operators",
            Shape::Choice(&["legacy", "corrected", "least_squares", "energy"]),
            "how forces come of neighbours, as of the formulation `particles`",
        )
        .or(Value::Text("energy")),
        Key::new(
            "variant",
            Shape::Choice(&["adaptive", "hierarchical"]),
            "divided particles give way to their daughters, or stay for what they feel of their own level",
        )
        .or(Value::Text("adaptive")),
        Key::number(
            "refine",
            "",
            Range::POSITIVE,
            "a particle divides above this: spacing times the Laplacian of the displacement",
        )
        .or(Value::Number(0.02)),
        Key::number(
            "coarsen",
            "",
            Range::NOT_NEGATIVE,
            "and is grouped with its sisters below this of all of them",
        )
        .or(Value::Number(0.005)),
        Key::new(
            "fixed",
            Shape::Formula(&PLACE_VARIABLES),
            "the level at a place, counted from 0, the coarsest; then there is no criterion, and neighbours differ by one at most",
        ),
    ],
);

/// The octree of a body as specified.
pub struct OctreeSpec {
    pub levels: usize,
    pub operators: OctreeOperators,
    pub variant: Variant,
    pub refine: f64,
    pub coarsen: f64,
    pub fixed: Option<Formula>,
    pub site: Site,
}

impl OctreeSpec {
    pub(crate) fn read(reader: &Reader) -> Self {
        let (refine, coarsen) = (reader.number("refine"), reader.number("coarsen"));
        if coarsen >= refine {
            let message = "particles would come and go in every step";
            reader.log().add(
                Code::Conflict,
                &reader.site_of("coarsen"),
                message,
                format!("below `refine`, {refine}"),
            );
        }
        let operators = match reader.choice("operators") {
            "legacy" => OctreeOperators::Strong(Operators::Legacy),
            "corrected" => OctreeOperators::Strong(Operators::Corrected),
            "least_squares" => OctreeOperators::Strong(Operators::LeastSquares),
            _ => OctreeOperators::Energy,
        };
        let variant = if reader.choice("variant") == "hierarchical" {
            Variant::Hierarchical
        } else {
            Variant::Adaptive
        };
        if variant == Variant::Hierarchical && operators == OctreeOperators::Energy {
            let message = "an energy is of whole neighbourhoods, and divided particles see a part of theirs";
            let expected = "`operators = \"legacy\"`, or another but `energy`";
            reader.log().add(Code::Conflict, &reader.site_of("variant"), message, expected);
        }
        Self {
            levels: reader.maybe_integer("levels").unwrap_or(3) as usize,
            operators,
            variant,
            refine,
            coarsen,
            fixed: reader.maybe_formula("fixed"),
            site: reader.site(),
        }
    }

    /// Whether particles see finer and coarser ones.
    pub fn is_adaptive(&self) -> bool {
        self.variant == Variant::Adaptive
    }

    pub fn choice(&self) -> OctreeChoice {
        match &self.fixed {
            Some(level) => OctreeChoice::Fixed(level.clone()),
            None => OctreeChoice::Adaptive { refine: self.refine, coarsen: self.coarsen },
        }
    }
}
