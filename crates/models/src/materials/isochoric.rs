//! What decoupled laws share: powers of the volume that take it out of the stretches, `J^(-1/3) s`, and the energy of the
//! volume itself, `k/2 (J - 1)²`.

use souple_math::Real;

/// The ratio of volumes below which `J` in the powers goes on as a positive function that vanishes towards minus infinity:
/// energy, stress and tangent stay continuous, and the powers grow all the way, so that flat and inverted elements are
/// pushed back.
const SMALLEST_VOLUME: f64 = 0.05;

/// `ln m(J)` and its two derivatives, `m = J` down to the smallest volume `J₀`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Volume<R> {
    logarithm: R,
    first: R,
    second: R,
}

/// `p(J) = m(J)^-n` and its two derivatives.
#[derive(Clone, Copy, Debug)]
pub(super) struct Power<R> {
    pub value: R,
    pub first: R,
    pub second: R,
}

impl<R: Real> Volume<R> {
    // m = J₁ (1 - x)/(1 - 2x + 2x²) with J₁ = max(J, J₀), x = (J - J₁)/J₁ ≤ 0: value, slope and curvature 1, 1, 0 at x = 0
    #[inline(always)]
    pub(super) fn at(J: R) -> Self {
        let bounded = J.max(J.splat(SMALLEST_VOLUME));
        let inverse = J.one() / bounded;
        let x = (J - bounded) * inverse;
        let (above, below) = (-x + 1.0, (x - 1.0) * x * 2.0 + 1.0);
        let (above_slope, below_slope) = (-J.one() / above, (x * 4.0 - 2.0) / below);
        let (slope, curvature) = (
            above_slope - below_slope,
            below_slope * below_slope - above_slope * above_slope - J.splat(4.0) / below,
        );
        Self {
            logarithm: bounded.ln() + (above / below).ln(),
            first: slope * inverse,
            second: curvature * inverse * inverse,
        }
    }

    // p = exp(-n L),  p' = -n L' p,  p'' = (n² L'² - n L'') p
    #[inline(always)]
    pub(super) fn power(&self, n: R) -> Power<R> {
        let value = (-n * self.logarithm).exp();
        let rate = n * self.first;
        Power { value, first: -rate * value, second: (rate * rate - n * self.second) * value }
    }
}
