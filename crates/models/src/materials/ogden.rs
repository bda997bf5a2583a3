//! Ogden's elasticity, decoupled: rubber and soft tissue up to the largest stretches, by powers of the principal ones.
//!
//! Up to three terms, as in Ogden's own fit of rubber to sevenfold stretch. It needs the principal axes, which makes it the
//! dearest law; `mooney_rivlin` (exponents 2 and -2) and `neo_hookean` (2) do without.
//!
//! A term of negative exponent is written by the ratios of areas, `s₁^-a = (s₂ s₃)^a / J^a`: like that of positive exponent
//! it is then a smooth function of `C` or `cof C` times a power of `J` that grows as an element is flattened and inverted.

use souple_math::{Mat3, Real, Vec3, svd};
use souple_table::{Entry, Parameter, Range};

use super::invariants::cofactor_differential;
use super::isochoric::{Power, Volume};
use super::{AnyLaw, BULK_MODULUS, Build, DENSITY, Lame, Law, Material, MaterialError, Parameters};

/// `Ψ = Σ_p μ_p/α_p (s̄₁^α_p + s̄₂^α_p + s̄₃^α_p - 3) + k/2 (J - 1)²` with `s̄ = J^(-1/3) s`.
#[derive(Clone, Copy, Debug)]
pub struct Ogden;

/// The most terms.
const TERMS: usize = 3;

pub(super) const ENTRY: Entry<Build> = Entry {
    name: "ogden",
    summary: "decoupled powers of the principal stretches, up to three terms: rubber and tissue at the largest stretches; \
              below 5 % of the rest length, area or volume its powers go on smoothly: flat and inverted elements stay \
              finite and are pushed back; one shrunk to a line or point feels no push from its shape",
    source: "Ogden 1972, Large deformation isotropic elasticity; decoupled form after Holzapfel 2000, §6.5",
    parameters: &[
        Parameter::numbers(
            "mu",
            "Pa",
            Range::ANY,
            "μ_p: one for each term, three at most; the shear modulus is Σ μ_p α_p / 2",
        ),
        Parameter::numbers(
            "alpha",
            "",
            Range::closed(-20.0, 20.0),
            "α_p: exponents, one for each term, none 0",
        ),
        BULK_MODULUS,
        DENSITY,
    ],
    build: |values| {
        let (mu, alpha, bulk) =
            (values.numbers("mu"), values.numbers("alpha"), values.number("bulk_modulus"));
        if mu.len() > TERMS {
            let message = format!("mu has {} terms; there may be {TERMS} at most", mu.len());
            return Err(MaterialError::of("mu", message));
        }
        if alpha.len() != mu.len() {
            let message =
                format!("alpha has {} terms and mu has {}; they go in pairs", alpha.len(), mu.len());
            return Err(MaterialError::of("alpha", message));
        }
        if let Some(term) = alpha.iter().position(|alpha| *alpha == 0.0) {
            let message =
                format!("alpha[{term}] is 0, of which no energy comes; an exponent is any other number");
            return Err(MaterialError::of("alpha", message));
        }
        let shear = 0.5 * mu.iter().zip(alpha).map(|(mu, alpha)| mu * alpha).sum::<f64>();
        if shear <= 0.0 {
            let message = format!(
                "the sum of mu times alpha is {} Pa, so the body would give way under the least shear; it must be above 0",
                2.0 * shear
            );
            return Err(MaterialError::of("mu", message));
        }
        let term = |p: usize| match (mu.get(p), alpha.get(p)) {
            (Some(mu), Some(alpha)) => Term { weight: mu / alpha, exponent: *alpha },
            _ => Term { weight: 0.0, exponent: 1.0 },
        };
        let numbers = Numbers { terms: [term(0), term(1), term(2)], bulk };
        let small_strain = Lame::from_shear_bulk(shear, bulk);
        Ok(Material::known(AnyLaw::Ogden, numbers, small_strain, values.number("density")))
    },
};

/// One of the powers.
#[derive(Clone, Copy, Debug)]
pub struct Term<R> {
    /// `μ/α` [Pa].
    pub weight: R,
    /// `α`.
    pub exponent: R,
}

/// The law's numbers; terms that are not there weigh nothing.
#[derive(Clone, Copy, Debug)]
pub struct Numbers<R> {
    pub terms: [Term<R>; TERMS],
    /// `k` [Pa].
    pub bulk: R,
}

impl<R: Copy> Parameters<R> for Numbers<R> {
    const NAMES: &'static [&'static str] =
        &["weight_1", "exponent_1", "weight_2", "exponent_2", "weight_3", "exponent_3", "bulk"];

    #[inline(always)]
    fn unpack(mut number: impl FnMut(usize) -> R) -> Self {
        Self {
            terms: [
                Term { weight: number(0), exponent: number(1) },
                Term { weight: number(2), exponent: number(3) },
                Term { weight: number(4), exponent: number(5) },
            ],
            bulk: number(6),
        }
    }

    #[inline(always)]
    fn pack(self, mut put: impl FnMut(usize, R)) {
        for (p, term) in self.terms.into_iter().enumerate() {
            put(2 * p, term.weight);
            put(2 * p + 1, term.exponent);
        }
        put(2 * TERMS, self.bulk);
    }
}

/// Squared stretch or area below which a power goes on as its Taylor polynomial of degree two: lengths and areas of a
/// twentieth.
const SMALLEST_SQUARE: f64 = 0.0025;

/// `τ(e) = e^m` at the squares `e` of three stretches or areas, and its two derivatives.
struct Powers<R> {
    /// `m - 1`.
    less: R,
    /// The squares, not below the smallest, and their logarithms.
    squares: [R; 3],
    bounded: [R; 3],
    logarithms: [R; 3],
    value: [R; 3],
    first: [R; 3],
    /// At the bounded squares, and below them.
    second: [R; 3],
}

impl<R: Real> Powers<R> {
    // below the smallest: τ + τ' y + τ''/2 y², y = e - e₀
    #[inline(always)]
    fn at(m: R, squares: [R; 3]) -> Self {
        let (zero, less) = (m.zero(), m - 1.0);
        let mut powers = Self {
            less,
            squares,
            bounded: squares,
            logarithms: [zero; 3],
            value: [zero; 3],
            first: [zero; 3],
            second: [zero; 3],
        };
        for i in 0..3 {
            let bounded = squares[i].max(m.splat(SMALLEST_SQUARE));
            let (logarithm, inverse, y) = (bounded.ln(), m.one() / bounded, squares[i] - bounded);
            let value = (m * logarithm).exp();
            let slope = m * value * inverse;
            let second = less * slope * inverse;
            powers.bounded[i] = bounded;
            powers.logarithms[i] = logarithm;
            powers.value[i] = value + (slope + second * y * 0.5) * y;
            powers.first[i] = slope + second * y;
            powers.second[i] = second;
        }
        powers
    }

    /// `(τ'(e_i) - τ'(e_j))/(e_i - e_j)`, without loss where they are close: with `a/b = exp(2 δ)` it is
    /// `m (m - 1) √(ab)^(m - 2) sinh((m - 1) δ)/((m - 1) sinh δ)`.
    #[inline(always)]
    fn quotient(&self, m: R, i: usize, j: usize) -> R {
        let (a, b) = (self.bounded[i], self.bounded[j]);
        let mean = (self.logarithms[i] + self.logarithms[j]) * 0.5;
        let delta = (self.logarithms[i] - self.logarithms[j]) * 0.5;
        let scaled = self.less * delta;
        let ratio = sinh_over_argument(scaled * scaled) / sinh_over_argument(delta * delta);
        let close = m * self.less * ((self.less - 1.0) * mean).exp() * ratio;
        // of what is above the smallest square, and of what is below
        let apart = self.squares[i] - self.squares[j];
        let is_apart = m.splat(CLOSE) - delta.abs();
        let denominator = apart.abs().select_less(m.splat(f64::MIN_POSITIVE), m.one(), apart);
        let far = (self.first[i] - self.first[j]) / denominator;
        let above = apart.abs().select_less(m.splat(f64::MIN_POSITIVE), m.one(), (a - b) / denominator);
        let below = m.one() - above;
        // both second derivatives are that of the smallest square where there is a part below
        let lowest = a.select_less(b, self.second[i], self.second[j]);
        is_apart.select_less(m.zero(), far, close * above + lowest * below)
    }
}

/// Below this `δ` quotients are taken by the series, above it as they are: what cancels there is a digit.
const CLOSE: f64 = 0.1;

/// `sinh(x)/x` by `x²`, to rounding for `|x| ≤ 1`: the terms left out begin with `x¹⁶/17!`.
#[inline(always)]
fn sinh_over_argument<R: Real>(square: R) -> R {
    let mut sum = square.one();
    for n in (1..8).rev() {
        let n = f64::from(n);
        sum = sum * square * (1.0 / (2.0 * n * (2.0 * n + 1.0))) + 1.0;
    }
    sum
}

/// What belongs to an exponent: areas bear negative ones, lengths positive ones. A function and no closure, which
/// would not be compiled for the processor's instructions.
#[inline(always)]
fn by_sign<R: Real>(exponent: R, area: R, length: R) -> R {
    exponent.select_less(exponent.zero(), area, length)
}

/// One term at one deformation: `T = Σ τ`, its derivatives by the squared stretches `c`, and the power of the volume.
struct TermAt<R> {
    powers: Powers<R>,
    /// `m = |α|/2`.
    half: R,
    /// `p = J^(-α/3)`, or by areas `J^(-2 |α|/3)`.
    volume: Power<R>,
    sum: R,
    /// `t_i = ∂T/∂c_i`.
    slopes: [R; 3],
}

impl<R: Real> TermAt<R> {
    #[inline(always)]
    fn of(term: &Term<R>, squares: &[R; 3], areas: &[R; 3], volume: &Volume<R>) -> Self {
        let exponent = term.exponent;
        let size = exponent.abs();
        let half = size * 0.5;
        let mut arguments = *squares;
        for i in 0..3 {
            arguments[i] = by_sign(exponent, areas[i], squares[i]);
        }
        let powers = Powers::at(half, arguments);
        let third = size * (1.0 / 3.0);
        let volume = volume.power(by_sign(exponent, third * 2.0, third));
        let f = powers.first;
        let mut slopes = f;
        for [i, j, k] in PAIRS {
            slopes[i] = by_sign(exponent, f[j] * squares[k] + f[k] * squares[j], f[i]);
        }
        let sum = powers.value[0] + powers.value[1] + powers.value[2];
        Self { powers, half, volume, sum, slopes }
    }
}

/// One deformation and what differentials at it share; vectors and matrices with indices of principal axes.
#[derive(Clone, Copy, Debug)]
pub struct Point<R> {
    /// Principal axes at rest, `F = U diag(s) Nᵀ`.
    N: Mat3<R>,
    /// `B = F N`.
    B: Mat3<R>,
    F: Mat3<R>,
    cofactor: Mat3<R>,
    /// `g_i = Σ w p t_i`: `P = 2 B diag(g) Nᵀ + Ψ_J cof F`.
    g: Vec3<R>,
    /// `2 B diag(Σ w p' t_i) Nᵀ`, the derivative of that by `J`.
    H: Mat3<R>,
    /// `Σ w p ∂t_i/∂c_j`: (0,0), (1,1), (2,2), then (0,1), (1,2), (2,0).
    curvatures: [R; 6],
    /// `Σ w p (t_i - t_j)/(c_i - c_j)`: (0,1), (1,2), (2,0).
    quotients: [R; 3],
    /// `∂Ψ/∂J` and `∂²Ψ/∂J²`.
    volume: R,
    volume_second: R,
}

/// Pairs of axes with the third.
const PAIRS: [[usize; 3]; 3] = [[0, 1, 2], [1, 2, 0], [2, 0, 1]];

/// `F` seen from its principal axes: those, `c`, the squared areas across them, and `J`.
#[inline(always)]
fn principal<R: Real>(F: &Mat3<R>) -> (Mat3<R>, [R; 3], [R; 3], R) {
    let decomposed = svd(F);
    let [x, y, z] = decomposed.values.to_array();
    let c = [x * x, y * y, z * z];
    (decomposed.right, c, [c[1] * c[2], c[2] * c[0], c[0] * c[1]], F.determinant())
}

/// `B diag(d) Nᵀ`.
#[inline(always)]
fn composed<R: Real>(B: &Mat3<R>, d: Vec3<R>, N: &Mat3<R>) -> Mat3<R> {
    let [a, b, c] = B.columns;
    Mat3::from_columns(a * d.x, b * d.y, c * d.z).mul_transpose(N)
}

impl Law for Ogden {
    type Parameters<R: Real> = Numbers<R>;
    type Point<R: Real> = Point<R>;

    #[inline(always)]
    fn at<R: Real>(numbers: &Numbers<R>, F: &Mat3<R>) -> Point<R> {
        let (N, c, areas, J) = principal(F);
        let at = Volume::at(J);
        let zero = J.zero();
        let (mut g, mut h) = ([zero; 3], [zero; 3]);
        let (mut curvatures, mut quotients) = ([zero; 6], [zero; 3]);
        let (mut volume, mut volume_second) = (numbers.bulk * (J - 1.0), numbers.bulk);
        for term in &numbers.terms {
            if term.weight.is_all_zero() {
                continue;
            }
            let exponent = term.exponent;
            let TermAt { powers, half, volume: p, sum, slopes } = TermAt::of(term, &c, &areas, &at);
            let (weight, weight_first) = (term.weight * p.value, term.weight * p.first);
            volume += weight_first * sum;
            volume_second += term.weight * p.second * sum;
            for [i, j, k] in PAIRS {
                g[i] += weight * slopes[i];
                h[i] += weight_first * slopes[i];
                // by areas t_i = τ'(d_j) c_k + τ'(d_k) c_j with d_i = c_j c_k
                let second = powers.second;
                let around = second[j] * c[k] * c[k] + second[k] * c[j] * c[j];
                curvatures[i] += weight * by_sign(exponent, around, second[i]);
                let across = powers.first[k] + second[k] * areas[k];
                curvatures[3 + i] += weight * by_sign(exponent, across, zero);
                // (d_j - d_i) = c_k (c_i - c_j)
                let quotient = powers.quotient(half, i, j);
                quotients[i] +=
                    weight * by_sign(exponent, quotient * c[k] * c[k] - powers.first[k], quotient);
            }
        }
        let B = *F * N;
        Point {
            H: composed(&B, Vec3::from_array(h) * J.splat(2.0), &N),
            N,
            B,
            F: *F,
            cofactor: F.cofactor(),
            g: Vec3::from_array(g),
            curvatures,
            quotients,
            volume,
            volume_second,
        }
    }

    #[inline(always)]
    fn energy_density<R: Real>(numbers: &Numbers<R>, F: &Mat3<R>) -> R {
        let (_, c, areas, J) = principal(F);
        let (at, dJ) = (Volume::at(J), J - 1.0);
        let mut energy = numbers.bulk * dJ * dJ * 0.5;
        for term in &numbers.terms {
            if !term.weight.is_all_zero() {
                let TermAt { volume, sum, .. } = TermAt::of(term, &c, &areas, &at);
                energy += term.weight * (volume.value * sum - 3.0);
            }
        }
        energy
    }

    // P = 2 F N diag(g) Nᵀ + Ψ_J cof F
    #[inline(always)]
    fn stress<R: Real>(numbers: &Numbers<R>, F: &Mat3<R>) -> Mat3<R> {
        let (N, c, areas, J) = principal(F);
        let at = Volume::at(J);
        let (mut g, mut pressure) = ([J.zero(); 3], numbers.bulk * (J - 1.0));
        for term in &numbers.terms {
            if term.weight.is_all_zero() {
                continue;
            }
            let TermAt { volume, sum, slopes, .. } = TermAt::of(term, &c, &areas, &at);
            pressure += term.weight * volume.first * sum;
            for i in 0..3 {
                g[i] += term.weight * volume.value * slopes[i];
            }
        }
        composed(&(*F * N), Vec3::from_array(g) * J.splat(2.0), &N) + F.cofactor().scaled(pressure)
    }

    // δP = 2 (δB diag(g) + B Z) Nᵀ + δJ H + (H : δF + Ψ_JJ δJ) cof F + Ψ_J δ(cof F),  δB = δF N,  A = Nᵀ δC N,
    // Z_ii = Σ_j ∂g_i/∂c_j A_jj,  Z_ij = (g_i - g_j)/(c_i - c_j) A_ij
    #[inline(always)]
    fn stress_differential<R: Real>(_: &Numbers<R>, point: &Point<R>, dF: &Mat3<R>) -> Mat3<R> {
        let Point { N, B, F, cofactor, g, H, curvatures: k, quotients, volume, volume_second } = point;
        let dB = *dF * *N;
        let half = B.transpose_mul(&dB);
        let A = half + half.transpose();
        let [a, b, c] = A.diagonal().to_array();
        let [ab, bc, ca] =
            [A.entry(0, 1) * quotients[0], A.entry(1, 2) * quotients[1], A.entry(2, 0) * quotients[2]];
        let Z = Mat3::from_columns(
            Vec3::new(k[0] * a + k[3] * b + k[5] * c, ab, ca),
            Vec3::new(ab, k[3] * a + k[1] * b + k[4] * c, bc),
            Vec3::new(ca, bc, k[5] * a + k[4] * b + k[2] * c),
        );
        let [x, y, z] = dB.columns;
        let turned = Mat3::from_columns(x * g.x, y * g.y, z * g.z) + *B * Z;
        let dJ = cofactor.dot(dF);
        turned.mul_transpose(N) * 2.0
            + H.scaled(dJ)
            + cofactor.scaled(H.dot(dF) + *volume_second * dJ)
            + cofactor_differential(F, dF).scaled(*volume)
    }
}
