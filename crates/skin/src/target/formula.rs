//! A potential written as text.

use souple_formal::Formula;
use souple_math::Vec3;
use souple_mesh::BoundingBox;
use souple_table::{Entry, Parameter};

use super::{Between, ISO, Moment, PartEntry, PartError, PartScratch, Potential, UNKNOWN};

const VARIABLES: &[&str] = &["x", "y", "z", "t"];

struct Text {
    formula: Formula,
    bounds: BoundingBox,
}

impl Potential for Text {
    fn new_scratch(&self) -> PartScratch {
        Box::new(0.0_f64)
    }

    fn place(&self, at: &Moment, scratch: &mut PartScratch) -> Result<(), String> {
        if let Some(time) = scratch.downcast_mut::<f64>() {
            *time = at.time;
        }
        Ok(())
    }

    fn value(&self, p: Vec3, scratch: &PartScratch) -> f64 {
        let time = scratch.downcast_ref::<f64>().copied().unwrap_or(0.0);
        ISO + self.formula.evaluate(&[p.x, p.y, p.z, time])
    }

    fn range(&self, within: BoundingBox, scratch: &PartScratch) -> Between {
        let time = scratch.downcast_ref::<f64>().copied().unwrap_or(0.0);
        let along = |axis: usize| [within.low[axis], within.high[axis]];
        let range = self.formula.range(&[along(0), along(1), along(2), [time; 2]]);
        range.map_or(UNKNOWN, |range| range.map(|value| ISO + value))
    }

    // told by the user, whatever the level
    fn bounds(&self, _: f64, _: &PartScratch) -> Option<BoundingBox> {
        Some(self.bounds)
    }
}

pub(super) static FORMULA: PartEntry = Entry {
    name: "formula",
    summary: "a potential as text: positive inside, negative outside",
    source: "own",
    parameters: &[
        Parameter::text("formula", "of x, y, z [m] and t [s], such as \"0.01 - x^2 - y^2 - z^2\""),
        Parameter::vector("low", "m", "lowest corner of a box around everything inside"),
        Parameter::vector("high", "m", "highest corner of that box"),
    ],
    build: |values, _| {
        let text = values.text("formula");
        let formula = Formula::compile(text, VARIABLES).map_err(|error| PartError {
            parameter: "formula",
            value: format!("\"{text}\""),
            expected: format!("a formula of x, y, z, t: {error}"),
        })?;
        let [low, high] = ["low", "high"].map(|name| Vec3::from_array(values.vector(name)));
        if (0..3).any(|axis| low[axis] >= high[axis]) {
            return Err(PartError {
                parameter: "high",
                value: format!("{:?}", high.to_array()),
                expected: format!("a corner above the lowest one, {:?}, in every coordinate", low.to_array()),
            });
        }
        Ok(Box::new(Text { formula, bounds: BoundingBox { low, high } }))
    },
};
