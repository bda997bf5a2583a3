//! What a hyperelastic law is: energy, stress and tangent of one deformation gradient, without indices.
//!
//! Laws are written once over [`Real`]: plain numbers, SIMD lanes (parameters may differ from lane to lane)
//! and dual numbers, which check the derivatives.

use souple_math::{Mat3, Real, Vec3};

/// A hyperelastic law. Implementors are empty types: kernels are instantiated per law.
///
/// `F` is the deformation gradient (no unit, entry `(i, j) = ∂xᵢ/∂Xⱼ`); every function is finite for every
/// `F`, inverted and singular ones included, as long as a twelfth power of its entries (a twentieth under Yeoh's law) does not overflow.
pub trait Law: Copy + Send + Sync + 'static {
    /// The numbers of the law, one set per element.
    type Parameters<R: Real>: Parameters<R>;
    /// What the differentials and blocks at one `F` share.
    type Point<R: Real>: Copy;

    /// Whether a rotation of the body leaves its energy as it is: `Ψ(QF) = Ψ(F)`.
    const OBJECTIVE: bool = true;
    /// Whether `P` is linear in `F - I`, without stress at rest: cells of one shape then share one stiffness.
    const LINEAR: bool = false;

    fn at<R: Real>(parameters: &Self::Parameters<R>, F: &Mat3<R>) -> Self::Point<R>;

    /// `Ψ(F)`, zero at rest [J per m³ of the rest shape].
    fn energy_density<R: Real>(parameters: &Self::Parameters<R>, F: &Mat3<R>) -> R;

    /// First Piola–Kirchhoff stress `P = ∂Ψ/∂F` [Pa].
    fn stress<R: Real>(parameters: &Self::Parameters<R>, F: &Mat3<R>) -> Mat3<R>;

    /// `δP = ∂P/∂F : δF` [Pa].
    fn stress_differential<R: Real>(
        parameters: &Self::Parameters<R>,
        point: &Self::Point<R>,
        dF: &Mat3<R>,
    ) -> Mat3<R>;

    /// `K` with `K u = (∂P/∂F : (u ⊗ g_b)) g_a`: the stiffness between two nodes whose shape functions have the
    /// gradients `g_a`, `g_b` [1/m], per rest volume [Pa/m²]. The force on `a` is `-P g_a`, its derivative `-K`.
    #[inline(always)]
    fn tangent_block<R: Real>(
        parameters: &Self::Parameters<R>,
        point: &Self::Point<R>,
        g_a: Vec3<R>,
        g_b: Vec3<R>,
    ) -> Mat3<R> {
        // written out: a closure would not be compiled with the processor's instructions
        let [x, y, z] = Mat3::identity(g_a.x).columns;
        Mat3::from_columns(
            Self::stress_differential(parameters, point, &x.outer(g_b)) * g_a,
            Self::stress_differential(parameters, point, &y.outer(g_b)) * g_a,
            Self::stress_differential(parameters, point, &z.outer(g_b)) * g_a,
        )
    }
}

/// Numbers of a law, stored by the kernels as one block of lanes per number.
pub trait Parameters<R>: Copy {
    /// Their names in packed order; the length is the count.
    const NAMES: &'static [&'static str];

    /// `number(i)` for the `i`-th of [`Self::NAMES`].
    fn unpack(number: impl FnMut(usize) -> R) -> Self;

    /// Calls `put(i, number)` for each in packed order.
    fn pack(self, put: impl FnMut(usize, R));
}

/// Lamé's parameters of small strain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lame<R = f64> {
    /// Shear modulus [Pa].
    pub mu: R,
    /// First parameter [Pa]; negative for negative Poisson ratios.
    pub lambda: R,
}

impl Lame {
    /// From Young's modulus [Pa] and Poisson's ratio, between -1 and 0.5.
    pub fn from_young_poisson(youngs_modulus: f64, poissons_ratio: f64) -> Self {
        // μ = E / 2(1 + ν),  λ = E ν / (1 + ν)(1 - 2ν)
        let mu = 0.5 * youngs_modulus / (1.0 + poissons_ratio);
        Self { mu, lambda: 2.0 * mu * poissons_ratio / (1.0 - 2.0 * poissons_ratio) }
    }

    /// From the shear and the bulk modulus [Pa].
    pub fn from_shear_bulk(shear: f64, bulk: f64) -> Self {
        Self { mu: shear, lambda: bulk - 2.0 / 3.0 * shear }
    }

    /// Pull of a slender rod over cross-section and strain, `E = μ(3λ + 2μ)/(λ + μ)` [Pa].
    pub fn youngs_modulus(&self) -> f64 {
        self.mu * (3.0 * self.lambda + 2.0 * self.mu) / (self.lambda + self.mu)
    }

    /// Narrowing of the rod over its strain, `ν = λ/2(λ + μ)`.
    pub fn poissons_ratio(&self) -> f64 {
        0.5 * self.lambda / (self.lambda + self.mu)
    }

    /// Stiffness against longitudinal waves, `λ + 2μ` [Pa]: the fastest waves run at `√((λ + 2μ)/ρ)`.
    pub fn longitudinal_modulus(&self) -> f64 {
        self.lambda + 2.0 * self.mu
    }

    /// Stiffness against change of volume, `λ + 2μ/3` [Pa].
    pub fn bulk_modulus(&self) -> f64 {
        self.lambda + 2.0 / 3.0 * self.mu
    }
}

impl<R: Copy> Parameters<R> for Lame<R> {
    const NAMES: &'static [&'static str] = &["mu", "lambda"];

    #[inline(always)]
    fn unpack(mut number: impl FnMut(usize) -> R) -> Self {
        Self { mu: number(0), lambda: number(1) }
    }

    #[inline(always)]
    fn pack(self, mut put: impl FnMut(usize, R)) {
        put(0, self.mu);
        put(1, self.lambda);
    }
}
