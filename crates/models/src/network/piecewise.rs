//! Characteristics of straight pieces, by absolute values or by tests (Jimenez 1993, P2-II.3).

use souple_math::Real;
use souple_table::{Parameter, Range, Value};

use super::law::{LinkError, LinkLaw, MEMORY, Reach, Response};

/// A force of straight pieces, less `Z (D - D^r)` below the last threshold.
#[derive(Clone, Debug, PartialEq)]
pub struct Piecewise {
    form: Form,
    /// The last threshold [m].
    last: f64,
    /// Where the stored energy counts from [m].
    zero: f64,
    /// `z/Te` [N/m].
    damping: f64,
    steepest: f64,
    /// See [`LinkLaw::range`].
    range: f64,
}

/// How pieces are told apart.
#[derive(Clone, Debug, PartialEq)]
enum Form {
    /// `φ = a0 D + C + Σ a_i |D - E_i|`: continuous, without a test.
    AbsoluteValues { linear: f64, constant: f64, bends: Vec<(f64, f64)> },
    /// `φ = p_i D + b_i` for `E_i < D <= E_{i+1}`: jumps at thresholds are exact.
    Tests(Vec<Piece>),
}

/// A straight piece: `φ = p D + b`, `∫ φ dD = p D²/2 + b D + c`.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Piece {
    /// It holds beyond [m].
    from: f64,
    slope: f64,
    constant: f64,
    integral: f64,
}

impl Piece {
    fn push(&self, length: f64) -> f64 {
        self.slope * length + self.constant
    }
}

impl Piecewise {
    /// Pieces of these slopes [N/m] between these thresholds [m], with `φ(E*) = f*` [m, N]; the stored energy counts from `E*`.
    ///
    /// # Errors
    /// There is not one slope more than thresholds, or thresholds do not ascend.
    pub fn new(
        thresholds: &[f64],
        slopes: &[f64],
        (zero, force): (f64, f64),
        damping: f64,
    ) -> Result<Self, LinkError> {
        check(thresholds, slopes)?;
        // a_i = (p_i - p_{i-1})/2,  a0 = (p_0 + p_n)/2,  C from φ(E*) = f*
        let bends: Vec<(f64, f64)> =
            thresholds.iter().zip(slopes.windows(2)).map(|(e, p)| (*e, 0.5 * (p[1] - p[0]))).collect();
        let linear = 0.5 * (slopes[0] + slopes[slopes.len() - 1]);
        let constant = force - linear * zero - bends.iter().map(|(e, a)| a * (zero - e).abs()).sum::<f64>();
        let form = Form::AbsoluteValues { linear, constant, bends };
        Ok(Self::of(form, thresholds, slopes, &[], zero, damping))
    }

    /// The same with jumps of the force [N] where a length passes a threshold.
    ///
    /// # Errors
    /// As of [`Piecewise::new`], or there are not as many jumps as thresholds.
    pub fn with_jumps(
        thresholds: &[f64],
        slopes: &[f64],
        jumps: &[f64],
        zero: f64,
        damping: f64,
    ) -> Result<Self, LinkError> {
        check(thresholds, slopes)?;
        if jumps.len() != thresholds.len() {
            return Err(LinkError::Unfit {
                parameter: "jumps",
                value: format!("{jumps:?}"),
                expected: format!("there are {} thresholds, and a jump at each", thresholds.len()),
            });
        }
        let first = Piece { from: f64::NEG_INFINITY, slope: slopes[0], constant: 0.0, integral: 0.0 };
        let mut pieces = vec![first];
        for ((from, slope), jump) in thresholds.iter().zip(&slopes[1..]).zip(jumps) {
            let before = pieces[pieces.len() - 1];
            let constant = before.push(*from) + jump - slope * from;
            pieces.push(Piece { from: *from, slope: *slope, constant, integral: 0.0 });
        }
        let there = pieces.iter().rev().find(|piece| piece.from < zero).unwrap_or(&first).push(zero);
        pieces.iter_mut().for_each(|piece| piece.constant -= there);
        for i in 1..pieces.len() {
            let (before, own) = (pieces[i - 1], pieces[i]);
            let half = 0.5 * (before.slope - own.slope) * own.from * own.from;
            pieces[i].integral = before.integral + half + (before.constant - own.constant) * own.from;
        }
        Ok(Self::of(Form::Tests(pieces), thresholds, slopes, jumps, zero, damping))
    }

    fn of(form: Form, thresholds: &[f64], slopes: &[f64], jumps: &[f64], zero: f64, damping: f64) -> Self {
        let greatest = |numbers: &[f64]| numbers.iter().fold(0.0, |most: f64, number| most.max(number.abs()));
        let (steepest, last) = (greatest(slopes), thresholds.last().copied());
        let law = Self { form, last: last.unwrap_or(0.0), zero, damping, steepest, range: f64::INFINITY };
        let Some(last) = last else { return law };
        // of sums that cancel rounding remains: of the sizes of what is added up
        let (slope, push, sizes) = match &law.form {
            Form::AbsoluteValues { linear, constant, bends } => {
                let slope = linear + bends.iter().map(|(_, share)| share).sum::<f64>();
                let steep = linear.abs() + bends.iter().map(|(_, share)| share.abs()).sum::<f64>();
                let far = |(bend, share): &(f64, f64)| share.abs() * (last.abs() + bend.abs());
                let high = linear.abs() * last.abs() + constant.abs() + bends.iter().map(far).sum::<f64>();
                (slope, law.elastic(last), [steep, high])
            }
            Form::Tests(pieces) => {
                let piece = pieces[pieces.len() - 1];
                let high = pieces.iter().map(|piece| piece.constant.abs()).sum::<f64>();
                (piece.slope, piece.push(last), [steepest, high + greatest(jumps)])
            }
        };
        let [is_level, is_free] = [(slope, sizes[0]), (push, sizes[1])]
            .map(|(number, size)| number.abs() <= 8.0 * f64::EPSILON * size);
        let ends = is_level && is_free;
        Self { range: if ends { last } else { f64::INFINITY }, ..law }
    }

    /// `a0`, `C` and the `a_i` of the form by absolute values.
    pub fn coefficients(&self) -> Option<(f64, f64, Vec<f64>)> {
        match &self.form {
            Form::AbsoluteValues { linear, constant, bends } => {
                Some((*linear, *constant, bends.iter().map(|(_, share)| *share).collect()))
            }
            Form::Tests(_) => None,
        }
    }

    #[inline(always)]
    fn elastic<R: Real>(&self, length: R) -> R {
        match &self.form {
            Form::AbsoluteValues { linear, constant, bends } => {
                let mut push = length * *linear + *constant;
                for &(bend, share) in bends {
                    push += (length - bend).abs() * share;
                }
                push
            }
            Form::Tests(pieces) => {
                let mut push = length * pieces[0].slope + pieces[0].constant;
                for piece in &pieces[1..] {
                    let own = length * piece.slope + piece.constant;
                    push = length.splat(piece.from).select_less(length, own, push);
                }
                push
            }
        }
    }

    /// `∫ φ dD`, but for a constant.
    #[inline(always)]
    fn integral<R: Real>(&self, length: R) -> R {
        match &self.form {
            Form::AbsoluteValues { linear, constant, bends } => {
                let mut sum = length * length * (0.5 * linear) + length * *constant;
                for &(bend, share) in bends {
                    let beyond = length - bend;
                    sum += beyond * beyond.abs() * (0.5 * share);
                }
                sum
            }
            Form::Tests(pieces) => {
                let of = |piece: &Piece| {
                    length * length * (0.5 * piece.slope) + length * piece.constant + piece.integral
                };
                let mut sum = of(&pieces[0]);
                for piece in &pieces[1..] {
                    sum = length.splat(piece.from).select_less(length, of(piece), sum);
                }
                sum
            }
        }
    }
}

/// # Errors
/// There is not one slope more than thresholds, or thresholds do not ascend.
fn check(thresholds: &[f64], slopes: &[f64]) -> Result<(), LinkError> {
    if slopes.len() != thresholds.len() + 1 {
        return Err(LinkError::Unfit {
            parameter: "slopes",
            value: format!("{slopes:?}"),
            expected: format!("{} thresholds part {} pieces", thresholds.len(), thresholds.len() + 1),
        });
    }
    ascends("thresholds", thresholds)
}

/// # Errors
/// They do not.
pub fn ascends(parameter: &'static str, lengths: &[f64]) -> Result<(), LinkError> {
    if lengths.is_sorted_by(|a, b| a < b) {
        return Ok(());
    }
    Err(LinkError::Unfit {
        parameter,
        value: format!("{lengths:?}"),
        expected: "each must be greater than the one before".to_owned(),
    })
}

/// # Errors
/// A length is below the least that links have.
pub fn can_be(parameter: &'static str, lengths: &[f64], least: f64) -> Result<(), LinkError> {
    if lengths.iter().all(|length| *length >= least) {
        return Ok(());
    }
    Err(LinkError::Unfit {
        parameter,
        value: if let [only] = lengths { only.to_string() } else { format!("{lengths:?}") },
        expected: "the length of a link in space is never below 0; of one `along` an axis it has a sign"
            .to_owned(),
    })
}

impl LinkLaw for Piecewise {
    #[inline(always)]
    fn respond<R: Real>(&self, reach: &Reach<R>, _: &mut [R; MEMORY]) -> Response<R> {
        let length = reach.length;
        let (moved, zero) = (length - reach.before, length.zero());
        let braked = length.select_less(length.splat(self.last), moved * self.damping, zero);
        Response {
            push: self.elastic(length) - braked,
            stored: self.integral(length.splat(self.zero)) - self.integral(length),
            heat: braked * moved,
        }
    }

    fn is_conservative(&self) -> bool {
        self.damping == 0.0
    }

    fn stiffest(&self) -> f64 {
        self.steepest + 2.0 * self.damping
    }

    fn rest_distance(&self) -> Option<f64> {
        self.range.is_finite().then_some(self.zero)
    }

    /// The last threshold, where the last piece is level and without force.
    fn range(&self) -> f64 {
        self.range
    }
}

/// Of laws that are made of pieces.
pub const DAMPING: Parameter =
    Parameter::number("damping", "N s/m", Range::NOT_NEGATIVE, "z, below the last threshold")
        .or(Value::Number(0.0));

#[cfg(test)]
mod tests {
    use super::*;
    use crate::network::InLanes;
    use crate::network::kernel::LinkKernel;
    use crate::network::law::Moment;

    /// Both forms are one characteristic, and its energy, to rounding.
    #[test]
    fn both_forms_agree() {
        // the example of the specification, §2.8.3
        let (thresholds, slopes) = ([0.9, 1.2, 1.6], [-10.0, -2.0, 1.0, 0.0]);
        let smooth = InLanes(Piecewise::new(&thresholds, &slopes, (0.0, 0.0), 3.0).unwrap());
        let tested = InLanes(Piecewise::with_jumps(&thresholds, &slopes, &[0.0; 3], 0.0, 3.0).unwrap());
        assert_eq!(smooth.0.range(), tested.0.range());
        for step in 0..=2000 {
            let length = f64::from(step) * 1e-3;
            let reach = Reach { length, before: length - 1e-3, rest: 1.0 };
            let [a, b] = [&smooth, &tested].map(|law| law.respond(&reach, &Moment::of(0.0), &[]));
            // 9.6 N of a sum of a dozen terms
            assert!((a.push - b.push).abs() <= 1e-14 * 9.6, "{length}: {} and {}", a.push, b.push);
            assert!((a.stored - b.stored).abs() <= 1e-14 * 20.0, "{length}: {} and {}", a.stored, b.stored);
            assert_eq!(a.heat, b.heat);
        }
    }

    /// Up to a threshold, and at it, the force is that before the jump; beyond it the whole jump is there, and the energy has a
    /// bend and no step.
    #[test]
    fn jumps_are_exact() {
        let law =
            InLanes(Piecewise::with_jumps(&[1.0, 1.5], &[0.0, -4.0, 0.0], &[-3.0, 5.0], 0.5, 0.0).unwrap());
        let at =
            |length: f64| law.respond(&Reach { length, before: length, rest: 1.0 }, &Moment::of(0.0), &[]);
        assert_eq!([0.2, 1.0].map(|length| at(length).push), [0.0, 0.0]);
        assert_eq!(
            [1.0f64.next_up(), 1.25, 1.5].map(|length| (at(length).push * 1e9).round()),
            [-3e9, -4e9, -5e9]
        );
        assert_eq!(law.range(), 1.5);
        assert_eq!(at(1.6).push, 0.0);
        // ∫ of -3 - 4 (D - 1) over half a metre
        assert!((at(1.5).stored - 2.0).abs() < 1e-14 && (at(2.0).stored - 2.0).abs() < 1e-14);
        assert_eq!(at(1.0).stored, 0.0);
    }
}
