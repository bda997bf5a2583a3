//! Mooney–Rivlin elasticity, decoupled: rubber at moderate stretch, with two shear moduli and a bulk modulus.
//!
//! Isochoric invariants bear the shape and `J` the volume, so that no pressure comes of shear; rubber and soft tissue are
//! hundreds of times stiffer against change of volume. Two constants fit stretches up to about two; for more take `ogden`,
//! for one constant `neo_hookean`, which is cheaper.

use souple_math::{Mat3, Real};
use souple_table::{Entry, Parameter, Range};

use super::invariants::cofactor_differential;
use super::isochoric::Volume;
use super::{AnyLaw, BULK_MODULUS, Build, DENSITY, Lame, Law, Material, MaterialError, Parameters};

/// `Ψ = c₁₀ (Ī₁ - 3) + c₀₁ (Ī₂ - 3) + k/2 (J - 1)²` with `Ī₁ = J^(-2/3) tr C`, `Ī₂ = J^(-4/3) tr cof C`.
#[derive(Clone, Copy, Debug)]
pub struct MooneyRivlin;

pub(super) const ENTRY: Entry<Build> = Entry {
    name: "mooney_rivlin",
    summary: "decoupled: rubber at moderate stretch, nearly incompressible; below 5 % of the rest volume the powers of J go \
              on smoothly: flat and inverted elements stay finite and are pushed back; one shrunk to a line or point feels \
              no push from its shape",
    source: "Mooney 1940; Rivlin 1948; decoupled form after Holzapfel 2000, Nonlinear Solid Mechanics, §6.5",
    parameters: &[
        Parameter::number(
            "c10",
            "Pa",
            Range::ANY,
            "c₁₀: of the first invariant; the shear modulus is 2 (c₁₀ + c₀₁)",
        ),
        Parameter::number("c01", "Pa", Range::ANY, "c₀₁: of the second invariant"),
        BULK_MODULUS,
        DENSITY,
    ],
    build: |values| {
        let [c10, c01, bulk] = ["c10", "c01", "bulk_modulus"].map(|name| values.number(name));
        let shear = 2.0 * (c10 + c01);
        if shear <= 0.0 {
            let message = format!(
                "c10 + c01 is {} Pa, so the body would give way under the least shear; their sum must be above 0",
                c10 + c01
            );
            return Err(MaterialError::of("c01", message));
        }
        let small_strain = Lame::from_shear_bulk(shear, bulk);
        let numbers = Numbers { c10, c01, bulk };
        Ok(Material::known(AnyLaw::MooneyRivlin, numbers, small_strain, values.number("density")))
    },
};

/// The law's numbers [Pa].
#[derive(Clone, Copy, Debug)]
pub struct Numbers<R> {
    pub c10: R,
    pub c01: R,
    pub bulk: R,
}

impl<R: Copy> Parameters<R> for Numbers<R> {
    const NAMES: &'static [&'static str] = &["c10", "c01", "bulk"];

    #[inline(always)]
    fn unpack(mut number: impl FnMut(usize) -> R) -> Self {
        Self { c10: number(0), c01: number(1), bulk: number(2) }
    }

    #[inline(always)]
    fn pack(self, mut put: impl FnMut(usize, R)) {
        put(0, self.c10);
        put(1, self.c01);
        put(2, self.bulk);
    }
}

/// One deformation and the derivatives of the energy by the invariants `I₁ = tr C`, `I₂ = tr cof C` and `J`.
#[derive(Clone, Copy, Debug)]
pub struct Point<R> {
    F: Mat3<R>,
    /// `C = FᵀF`.
    C: Mat3<R>,
    /// `cof F = ∂J/∂F`.
    cofactor: Mat3<R>,
    /// `½ ∂I₂/∂F = I₁ F - F C`.
    second: Mat3<R>,
    I1: R,
    /// `∂Ψ/∂I₁`, `∂Ψ/∂I₂`, `∂Ψ/∂J`.
    slopes: [R; 3],
    /// `∂²Ψ/∂I₁∂J`, `∂²Ψ/∂I₂∂J`, `∂²Ψ/∂J²`.
    curvatures: [R; 3],
}

// Ψ = c₁₀ p I₁ + c₀₁ p² I₂ + k/2 (J - 1)² with p = J^(-2/3)
#[inline(always)]
fn point<R: Real>(numbers: &Numbers<R>, F: &Mat3<R>) -> Point<R> {
    let Numbers { c10, c01, bulk } = *numbers;
    let (C, cofactor) = (F.transpose_mul(F), F.cofactor());
    let (I1, I2, J) = (C.trace(), cofactor.dot(&cofactor), F.columns[0].dot(cofactor.columns[0]));
    let volume = Volume::at(J);
    let (p, q) = (volume.power(J.splat(2.0 / 3.0)), volume.power(J.splat(4.0 / 3.0)));
    Point {
        F: *F,
        C,
        cofactor,
        second: F.scaled(I1) - *F * C,
        I1,
        slopes: [c10 * p.value, c01 * q.value, c10 * p.first * I1 + c01 * q.first * I2 + bulk * (J - 1.0)],
        curvatures: [c10 * p.first, c01 * q.first, c10 * p.second * I1 + c01 * q.second * I2 + bulk],
    }
}

impl Law for MooneyRivlin {
    type Parameters<R: Real> = Numbers<R>;
    type Point<R: Real> = Point<R>;

    #[inline(always)]
    fn at<R: Real>(numbers: &Numbers<R>, F: &Mat3<R>) -> Point<R> {
        point(numbers, F)
    }

    #[inline(always)]
    fn energy_density<R: Real>(numbers: &Numbers<R>, F: &Mat3<R>) -> R {
        let Numbers { c10, c01, bulk } = *numbers;
        let cofactor = F.cofactor();
        let J = F.columns[0].dot(cofactor.columns[0]);
        let (volume, dJ) = (Volume::at(J), J - 1.0);
        let first = volume.power(J.splat(2.0 / 3.0)).value * F.dot(F) - 3.0;
        let second = volume.power(J.splat(4.0 / 3.0)).value * cofactor.dot(&cofactor) - 3.0;
        c10 * first + c01 * second + bulk * dJ * dJ * 0.5
    }

    // P = 2 Ψ₁ F + 2 Ψ₂ (I₁ F - F C) + Ψ_J cof F
    #[inline(always)]
    fn stress<R: Real>(numbers: &Numbers<R>, F: &Mat3<R>) -> Mat3<R> {
        let point = point(numbers, F);
        let [first, second, volume] = point.slopes;
        F.scaled(first * 2.0) + point.second.scaled(second * 2.0) + point.cofactor.scaled(volume)
    }

    // δP = 2 Ψ₁ δF + 2 Ψ₂ δ(I₁ F - F C) + Ψ_J δ(cof F)
    //    + δJ (2 Ψ₁_J F + 2 Ψ₂_J (I₁ F - F C)) + (Ψ₁_J δI₁ + Ψ₂_J δI₂ + Ψ_JJ δJ) cof F
    #[inline(always)]
    fn stress_differential<R: Real>(_: &Numbers<R>, point: &Point<R>, dF: &Mat3<R>) -> Mat3<R> {
        let Point { F, C, cofactor, second, I1, slopes, curvatures } = point;
        let (dI1, dI2, dJ) = (F.dot(dF) * 2.0, second.dot(dF) * 2.0, cofactor.dot(dF));
        let A = F.transpose_mul(dF);
        let d_second = F.scaled(dI1) + dF.scaled(*I1) - *dF * *C - *F * (A + A.transpose());
        let pressure = curvatures[0] * dI1 + curvatures[1] * dI2 + curvatures[2] * dJ;
        dF.scaled(slopes[0] * 2.0)
            + d_second.scaled(slopes[1] * 2.0)
            + F.scaled(curvatures[0] * dJ * 2.0)
            + second.scaled(curvatures[1] * dJ * 2.0)
            + cofactor.scaled(pressure)
            + cofactor_differential(F, dF).scaled(slopes[2])
    }
}
