//! The exponential stop by straight pieces.

use souple_table::{Parameter, Range};

use super::stop::{DAMPING, STIFFNESS, THRESHOLD};
use crate::network::kernel::InLanes;
use crate::network::law::{LinkEntry, LinkError};
use crate::network::piecewise::Piecewise;

pub const ENTRY: LinkEntry = LinkEntry {
    name: "exponential_pieces",
    summary: "the exponential stop by straight pieces, as few as an error allows: the stiffer the deeper, without an exponential",
    source: "Jimenez 1993, P2-III.1.1: by multi-linear approximation",
    parameters: &[
        THRESHOLD,
        STIFFNESS,
        Parameter::number("depth", "m", Range::POSITIVE, "d: over which the stiffness grows e times"),
        Parameter::number("error", "N", Range::POSITIVE, "greatest difference from the exponential"),
        Parameter::number(
            "deepest",
            "m",
            Range::POSITIVE,
            "as far in it holds; the last piece goes on beyond",
        ),
        DAMPING,
    ],
    build: |making| {
        let number = |name| making.values.number(name);
        let (threshold, depth, deepest) = (number("threshold"), number("depth"), number("deepest"));
        let (knots, slopes) = exponential_pieces(number("stiffness"), depth, number("error"), deepest)?;
        // from the deepest piece outwards: D = S - x
        let thresholds: Vec<f64> = knots.iter().rev().map(|knot| threshold - knot).collect();
        let slopes: Vec<f64> = slopes.iter().rev().map(|slope| -slope).chain([0.0]).collect();
        let damping = number("damping") / making.timestep;
        Ok(Box::new(InLanes(Piecewise::new(&thresholds, &slopes, (threshold, 0.0), damping)?)))
    },
};

/// Pieces of an exponential, at most.
const PIECES: usize = 64;

/// Depths from 0 on where chords of `f(x) = K d (e^{x/d} - 1)` meet [m], and their slopes [N/m], so that none is further
/// than an error from the curve.
///
/// A chord of a convex curve is furthest from it where the curve has its slope: over `[a, b]` with
/// `s = (f(b) - f(a))/(b - a)` that is at `x = d ln(s/K)`.
///
/// # Errors
/// It takes more than [`PIECES`].
fn exponential_pieces(
    stiffness: f64,
    depth: f64,
    error: f64,
    deepest: f64,
) -> Result<(Vec<f64>, Vec<f64>), LinkError> {
    let f = |x: f64| stiffness * depth * ((x / depth).exp() - 1.0);
    let slope = |a: f64, b: f64| (f(b) - f(a)) / (b - a);
    let off = |a: f64, b: f64| {
        let s = slope(a, b);
        let x = depth * (s / stiffness).ln();
        f(a) + s * (x - a) - f(x)
    };
    let (mut knots, mut slopes, mut from) = (vec![0.0], Vec::new(), 0.0);
    while from < deepest {
        let mut to = deepest;
        // what overflows is too far off
        let is_off = |to: f64| !off(from, to).is_finite() || off(from, to) > error;
        if is_off(to) {
            // the longest chord that is near enough: its distance grows with its length
            let (mut near, mut far) = (from, to);
            while far - near > 1e-12 * deepest {
                let middle = 0.5 * (near + far);
                if is_off(middle) { far = middle } else { near = middle }
            }
            to = near;
        }
        if knots.len() == PIECES || to <= from {
            let expected = format!("at most {PIECES} pieces: a greater error, or a smaller `deepest`");
            return Err(LinkError::Unfit { parameter: "error", value: error.to_string(), expected });
        }
        slopes.push(slope(from, to));
        knots.push(to);
        from = to;
    }
    // beyond the deepest the last piece goes on
    knots.pop();
    Ok((knots, slopes))
}

#[cfg(test)]
mod tests {
    use souple_table::{Value, Values};

    use super::*;
    use crate::network::Span;
    use crate::network::law::{Making, Moment, Reach};

    /// Pieces stay within their error of the exponential, reach it somewhere, grow stiffer with depth, and halving their number
    /// takes four times the error, as chords do.
    #[test]
    fn pieces_follow_the_exponential() {
        let (k, d, deepest) = (1000.0, 0.02, 0.08);
        let f = |x: f64| k * d * ((x / d).exp() - 1.0);
        let mut counts = Vec::new();
        for error in [16.0, 4.0, 1.0, 0.25] {
            let values = Values::new()
                .with("threshold", Value::Number(1.0))
                .with("stiffness", Value::Number(k))
                .with("depth", Value::Number(d))
                .with("error", Value::Number(error))
                .with("deepest", Value::Number(deepest));
            let values = ENTRY.values(values).unwrap();
            let law =
                (ENTRY.build)(&Making { values: &values, timestep: 1e-3, span: Span::Distance, driven: &[] })
                    .unwrap();
            let push = |x: f64| {
                let reach = Reach { length: 1.0 - x, before: 1.0 - x, rest: 1.0 };
                law.respond(&reach, &Moment::of(0.0), &[]).push
            };
            let worst = (0..=800).map(|i| {
                let x = deepest * f64::from(i) / 800.0;
                push(x) - f(x)
            });
            let worst: Vec<f64> = worst.collect();
            let most = worst.iter().copied().fold(0.0, f64::max);
            let rounding = 1e-9;
            assert!(worst.iter().all(|off| *off >= -rounding && *off <= error + rounding), "{error}: {most}");
            assert!(most > 0.5 * error, "{error}: {most}");
            assert!(push(-0.01).abs() < rounding, "outside");
            let (knots, slopes) = exponential_pieces(k, d, error, deepest).unwrap();
            assert!(slopes.is_sorted_by(|a, b| a < b));
            assert_eq!(knots.len(), slopes.len());
            counts.push(slopes.len() as f64);
        }
        for pair in counts.windows(2) {
            assert!((pair[1] / pair[0] - 2.0).abs() < 0.8, "{counts:?}");
        }
        assert!(exponential_pieces(k, d, 1e-9, deepest).is_err());
    }
}
