//! Force over length in straight pieces, with jumps or without.

use souple_table::{Parameter, Range, Value};

use crate::network::kernel::InLanes;
use crate::network::law::LinkEntry;
use crate::network::piecewise::{DAMPING, Piecewise, can_be};

pub const ENTRY: LinkEntry = LinkEntry {
    name: "piecewise_linear",
    summary: "force over length in straight pieces: dead zones, saturation, relays",
    source: "Jimenez 1993, P2-II.3: by absolute values, and by tests where there are jumps",
    parameters: &[
        Parameter::numbers(
            "thresholds",
            "m",
            Range::ANY,
            "lengths at which the slope changes, ascending; below 0 of links along an axis only",
        ),
        Parameter::numbers("slopes", "N/m", Range::ANY, "of the pushing force, one more than thresholds"),
        Parameter::numbers(
            "jumps",
            "N",
            Range::ANY,
            "of the pushing force where a length passes each threshold; none where left out",
        )
        .or(Value::Numbers(&[])),
        Parameter::number(
            "zero",
            "m",
            Range::ANY,
            "the length without force; below 0 of links along an axis only",
        ),
        DAMPING,
    ],
    build: |making| {
        let values = making.values;
        let (thresholds, slopes) = (values.numbers("thresholds"), values.numbers("slopes"));
        let (zero, damping) = (values.number("zero"), values.number("damping") / making.timestep);
        can_be("thresholds", thresholds, making.least_length())?;
        can_be("zero", &[zero], making.least_length())?;
        let law = match values.numbers("jumps") {
            [] => Piecewise::new(thresholds, slopes, (zero, 0.0), damping),
            jumps => Piecewise::with_jumps(thresholds, slopes, jumps, zero, damping),
        };
        Ok(Box::new(InLanes(law?)))
    },
};
