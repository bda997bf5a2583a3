//! A solid written as text: where a formula of `x`, `y`, `z` is negative.

use souple_formal::Formula;
use souple_math::Vec3;
use souple_table::{Parameter, Values};

use super::{Body, BodyEntry, BuildBody, Shape};
use crate::{BoundingBox, MeshError};

pub(super) static FORMULA: BodyEntry = BodyEntry {
    name: "formula",
    summary: "where a formula of x, y, z is negative",
    source: "own",
    parameters: &[
        Parameter::text("formula", "negative inside, such as \"x^2 + y^2 + z^2 - 0.01\"; x, y, z in metres"),
        Parameter::vector("low", "m", "lowest corner of a box around everything inside"),
        Parameter::vector("high", "m", "highest corner of that box"),
    ],
    build: build as BuildBody,
};

/// Where a formula of position is negative, within a box.
pub struct FormulaShape {
    formula: Formula,
    bounds: BoundingBox,
}

impl FormulaShape {
    /// Names of the variables, in the order of the coordinates.
    pub const VARIABLES: &'static [&'static str] = &["x", "y", "z"];

    pub fn new(formula: Formula, bounds: BoundingBox) -> Self {
        Self { formula, bounds }
    }
}

impl Shape for FormulaShape {
    fn value(&self, point: Vec3) -> f64 {
        self.formula.evaluate(&point.to_array())
    }

    fn range(&self, within: BoundingBox) -> Option<[f64; 2]> {
        self.formula.range(&[0, 1, 2].map(|axis: usize| [within.low[axis], within.high[axis]]))
    }

    fn bounds(&self) -> BoundingBox {
        self.bounds
    }
}

fn build(values: &Values) -> Result<Body, MeshError> {
    let text = values.text("formula");
    let formula = Formula::compile(text, FormulaShape::VARIABLES).map_err(|error| MeshError::Parameter {
        name: "formula",
        value: format!("\"{text}\""),
        expected: format!("a formula of x, y, z: {error}"),
    })?;
    let [low, high] = ["low", "high"].map(|name| Vec3::from_array(values.vector(name)));
    if (0..3).any(|axis| low[axis] >= high[axis]) {
        let value = format!("{:?}", high.to_array());
        let expected = format!("a corner above the lowest one, {:?}, in every coordinate", low.to_array());
        return Err(MeshError::Parameter { name: "high", value, expected });
    }
    Ok(Body { shape: Box::new(FormulaShape::new(formula, BoundingBox { low, high })), parts: Vec::new() })
}
