//! Characteristics of straight pieces: any curve from a few numbers, and the cohesion laws made of three or four.

use souple_math::Real;
use souple_table::{Parameter, Range, Value};

use crate::network::kernel::InLanes;
use crate::network::law::{LinkEntry, LinkError, LinkLaw, MEMORY, Making, Reach, Response};

/// `φ = a0 D + C + Σ a_i |D - E_i| - Z (D - D^r)`, damped below the last threshold only: continuous, without a test.
#[derive(Clone, Debug, PartialEq)]
pub struct Piecewise {
    linear: f64,
    constant: f64,
    /// `(E_i, a_i)`.
    bends: Vec<(f64, f64)>,
    /// Where the stored energy counts from [m].
    zero: f64,
    /// `z/Te` [N/m].
    damping: f64,
    steepest: f64,
}

impl Piecewise {
    /// Pieces of these slopes [N/m] between these thresholds [m], with `φ(zero) = 0`.
    ///
    /// # Errors
    /// There is not one slope more than thresholds, or thresholds do not ascend.
    pub fn new(thresholds: &[f64], slopes: &[f64], zero: f64, damping: f64) -> Result<Self, LinkError> {
        if slopes.len() != thresholds.len() + 1 {
            return Err(LinkError::Unfit {
                parameter: "slopes",
                value: format!("{slopes:?}"),
                expected: format!("{} thresholds part {} pieces", thresholds.len(), thresholds.len() + 1),
            });
        }
        if !thresholds.is_sorted_by(|a, b| a < b) {
            return Err(LinkError::Unfit {
                parameter: "thresholds",
                value: format!("{thresholds:?}"),
                expected: "each must be greater than the one before".to_owned(),
            });
        }
        // a_i = (p_i - p_{i-1})/2,  a0 = (p_0 + p_n)/2,  C from φ(zero) = 0
        let bends: Vec<(f64, f64)> =
            thresholds.iter().zip(slopes.windows(2)).map(|(e, p)| (*e, 0.5 * (p[1] - p[0]))).collect();
        let linear = 0.5 * (slopes[0] + slopes[slopes.len() - 1]);
        let constant = -linear * zero - bends.iter().map(|(e, a)| a * (zero - e).abs()).sum::<f64>();
        let steepest = slopes.iter().fold(0.0, |steepest: f64, slope| steepest.max(slope.abs()));
        Ok(Self { linear, constant, bends, zero, damping, steepest })
    }

    /// `a0`, `C` and the `a_i`.
    pub fn coefficients(&self) -> (f64, f64, Vec<f64>) {
        (self.linear, self.constant, self.bends.iter().map(|(_, a)| *a).collect())
    }

    #[inline(always)]
    fn elastic<R: Real>(&self, length: R) -> R {
        let mut push = length * self.linear + self.constant;
        for &(bend, share) in &self.bends {
            push += (length - bend).abs() * share;
        }
        push
    }

    /// `∫ φ dD`, but for a constant.
    #[inline(always)]
    fn integral<R: Real>(&self, length: R) -> R {
        let mut sum = length * length * (0.5 * self.linear) + length * self.constant;
        for &(bend, share) in &self.bends {
            let beyond = length - bend;
            sum += beyond * beyond.abs() * (0.5 * share);
        }
        sum
    }
}

impl LinkLaw for Piecewise {
    #[inline(always)]
    fn respond<R: Real>(&self, reach: &Reach<R>, _: &mut [R; MEMORY]) -> Response<R> {
        let length = reach.length;
        let (moved, zero) = (length - reach.before, length.zero());
        let range = length.splat(self.bends.last().map_or(0.0, |(bend, _)| *bend));
        let braked = length.select_less(range, moved * self.damping, zero);
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
        self.range().is_finite().then_some(self.zero)
    }

    /// The last threshold, where the last piece is level and without force.
    fn range(&self) -> f64 {
        let last = self.bends.last().map_or(f64::INFINITY, |(bend, _)| *bend);
        let slope = self.linear + self.bends.iter().map(|(_, share)| share).sum::<f64>();
        // of sums of slopes that cancel rounding remains
        let rounding = 8.0 * f64::EPSILON * self.steepest;
        let ends = slope.abs() <= rounding && self.elastic(last).abs() <= rounding * (1.0 + last);
        if ends { last } else { f64::INFINITY }
    }
}

const DAMPING: Parameter =
    Parameter::number("damping", "N s/m", Range::NOT_NEGATIVE, "z, below the last threshold")
        .or(Value::Number(0.0));

pub const PIECEWISE_LINEAR: LinkEntry = LinkEntry {
    name: "piecewise_linear",
    summary: "force over length in straight pieces: measured curves, dead zones, saturation",
    source: "Jimenez 1993, P2-II.3",
    parameters: &[
        Parameter::numbers(
            "thresholds",
            "m",
            Range::ANY,
            "lengths at which the slope changes, ascending; below 0 of links along an axis only",
        ),
        Parameter::numbers("slopes", "N/m", Range::ANY, "of the pushing force, one more than thresholds"),
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
        let least = making.least_length();
        let too_low = |parameter, value: String| LinkError::Unfit {
            parameter,
            value,
            expected: "the length of a link in space is never below 0; of one `along` an axis it has a sign"
                .to_owned(),
        };
        if thresholds.iter().any(|threshold| *threshold < least) {
            return Err(too_low("thresholds", format!("{thresholds:?}")));
        }
        if zero < least {
            return Err(too_low("zero", format!("{zero}")));
        }
        Ok(Box::new(InLanes(Piecewise::new(thresholds, slopes, zero, damping)?)))
    },
};

pub const COHESION: LinkEntry = LinkEntry {
    name: "cohesion",
    summary: "pushes when close, pulls when further, fades beyond: grains that stick, break and stick again",
    source: "Jimenez 1993, P2-III.1.2",
    parameters: &[
        Parameter::number("distance", "m", Range::POSITIVE, "S: at rest"),
        Parameter::number("hard", "m", Range::NOT_NEGATIVE, "S1: steeper repulsion below; 0 for none")
            .or(Value::Number(0.0)),
        Parameter::number("peak", "m", Range::POSITIVE, "S2: of the strongest pull"),
        Parameter::number("range", "m", Range::POSITIVE, "S3: no force beyond"),
        Parameter::number("repulsion", "N/m", Range::NOT_NEGATIVE, "k_r below S1").or(Value::Number(0.0)),
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
        return Piecewise::new(&[peak, range], &[-pull, fade, 0.0], distance, damping);
    }
    Piecewise::new(&[hard, peak, range], &[-number("repulsion"), -pull, fade, 0.0], distance, damping)
}
