//! A characteristic through measured points.

use souple_table::{Parameter, Range, Value};

use crate::network::kernel::InLanes;
use crate::network::law::{LinkEntry, LinkError};
use crate::network::piecewise::{DAMPING, Piecewise, ascends, can_be};

pub const ENTRY: LinkEntry = LinkEntry {
    name: "measured_curve",
    summary: "force over length through measured points, straight between them",
    source: "Jimenez 1993, P2-II.3: from knots and the slopes beyond them",
    parameters: &[
        Parameter::numbers(
            "lengths",
            "m",
            Range::ANY,
            "of the points, ascending, two at least; below 0 of links along an axis only",
        ),
        Parameter::numbers("pushes", "N", Range::ANY, "the pushing force at each"),
        Parameter::number("before", "N/m", Range::ANY, "slope before the first point").or(Value::Number(0.0)),
        Parameter::number("beyond", "N/m", Range::ANY, "slope beyond the last point").or(Value::Number(0.0)),
        DAMPING,
    ],
    build: |making| {
        let values = making.values;
        let (lengths, pushes) = (values.numbers("lengths"), values.numbers("pushes"));
        can_be("lengths", lengths, making.least_length())?;
        ascends("lengths", lengths)?;
        if lengths.len() < 2 {
            return Err(LinkError::Unfit {
                parameter: "lengths",
                value: format!("{lengths:?}"),
                expected: "a curve goes through two points at least".to_owned(),
            });
        }
        if lengths.len() != pushes.len() {
            return Err(LinkError::Unfit {
                parameter: "pushes",
                value: format!("{pushes:?}"),
                expected: format!("a point has a length and a force: {} lengths are given", lengths.len()),
            });
        }
        let between = lengths.windows(2).zip(pushes.windows(2)).map(|(d, f)| (f[1] - f[0]) / (d[1] - d[0]));
        let slopes: Vec<f64> =
            [values.number("before")].into_iter().chain(between).chain([values.number("beyond")]).collect();
        let damping = values.number("damping") / making.timestep;
        Ok(Box::new(InLanes(Piecewise::new(lengths, &slopes, rest(lengths, pushes), damping)?)))
    },
};

/// Where the curve changes its sign first; its first point where it does not.
fn rest(lengths: &[f64], pushes: &[f64]) -> (f64, f64) {
    if pushes[0] == 0.0 {
        return (lengths[0], 0.0);
    }
    let mut ways = lengths.windows(2).zip(pushes.windows(2));
    let crossing = ways.find(|(_, f)| f[0] != 0.0 && f[0] * f[1] <= 0.0);
    crossing.map_or((lengths[0], pushes[0]), |(d, f)| (d[0] + (d[1] - d[0]) * f[0] / (f[0] - f[1]), 0.0))
}
