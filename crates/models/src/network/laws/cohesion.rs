//! Cohesion of three or four pieces.

use souple_table::{Parameter, Range, Value};

use crate::network::kernel::InLanes;
use crate::network::law::{LinkEntry, LinkError, Making};
use crate::network::piecewise::{DAMPING, Piecewise};

pub const ENTRY: LinkEntry = LinkEntry {
    name: "cohesion",
    summary: "pushes when close, pulls when further, fades beyond: grains that stick, break and stick again",
    source: "Jimenez 1993, P2-III.1.2",
    parameters: &[
        Parameter::number("distance", "m", Range::POSITIVE, "S: at rest"),
        Parameter::number("hard", "m", Range::NOT_NEGATIVE, "S1: steeper repulsion below; 0 for none")
            .or(Value::Number(0.0)),
        Parameter::number("peak", "m", Range::POSITIVE, "S2: of the strongest pull"),
        Parameter::number("range", "m", Range::POSITIVE, "S3: no force beyond"),
        Parameter::number("repulsion", "N/m", Range::NOT_NEGATIVE, "k_r below S1, of a law with one")
            .or(Value::Number(0.0)),
        Parameter::number("cohesion", "N/m", Range::POSITIVE, "k_a about the distance at rest"),
        DAMPING,
    ],
    build: |making| Ok(Box::new(InLanes(cohesion(making)?))),
};

// -k_r below S1, -k_a to S2 through zero at S, +k_a (S2 - S)/(S3 - S2) to S3, nothing beyond
fn cohesion(making: &Making) -> Result<Piecewise, LinkError> {
    let number = |name| making.values.number(name);
    let (hard, distance, peak, range) = (number("hard"), number("distance"), number("peak"), number("range"));
    let ascends = |parameter, low: f64, high: f64, than: &str| {
        let expected = format!("it must be greater than {than}, {low}");
        let error = LinkError::Unfit { parameter, value: high.to_string(), expected };
        if low < high { Ok(()) } else { Err(error) }
    };
    ascends("distance", hard, distance, "`hard`")?;
    ascends("peak", distance, peak, "`distance`")?;
    ascends("range", peak, range, "`peak`")?;
    let pull = number("cohesion");
    let fade = pull * (peak - distance) / (range - peak);
    let damping = number("damping") / making.timestep;
    if hard == 0.0 {
        let repulsion = number("repulsion");
        if repulsion > 0.0 {
            return Err(LinkError::Unfit {
                parameter: "repulsion",
                value: repulsion.to_string(),
                expected: "it acts below `hard`, which is none: give that too, or leave this out".to_owned(),
            });
        }
        return Piecewise::new(&[peak, range], &[-pull, fade, 0.0], (distance, 0.0), damping);
    }
    Piecewise::new(&[hard, peak, range], &[-number("repulsion"), -pull, fade, 0.0], (distance, 0.0), damping)
}
