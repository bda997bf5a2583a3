//! The battery of materials: every law of the table against its derivatives, its symmetries, independent
//! numbers, and input that no element should ever have.

// F, P, Q as in the equations
#![allow(non_snake_case)]

use pulp::{Arch, Simd, WithSimd};
use souple_math::{Dual, Lanes, Mat3, Real, Vec3, exponential};
use souple_models::materials::{
    AnyLaw, Lame, Law, LawVisitor, Material, MaterialLaw, MooneyRivlin, NeoHookean, Ogden, Parameters,
    StVenantKirchhoff, StableNeoHookean, TABLE, cauchy_stress,
};
use souple_table::{Value, Values};

use crate::common;

const YOUNGS_MODULUS: f64 = 1e7;

/// A material of the table, from values as a scene gives them.
fn material(name: &str, youngs_modulus: f64, poissons_ratio: f64) -> Material {
    common::material_of(TABLE.find(name).unwrap(), youngs_modulus, poissons_ratio)
}

/// Runs the body for every law of the table (the type) at several ratios of Poisson (the material).
macro_rules! for_every_law {
    (|$material:ident, $Law:ident| $body:block) => {{
        struct Body(Material);
        impl LawVisitor for Body {
            type Output = ();
            fn visit<$Law: Law>(self, _: $Law) {
                let $material = self.0;
                $body
            }
        }
        for (law, ratio) in
            AnyLaw::ALL.iter().flat_map(|law| [0.3, 0.47, 0.0, -0.3].map(|ratio| (law, ratio)))
        {
            law.visit(Body(material(law.entry().name, YOUNGS_MODULUS, ratio)));
        }
    }};
}

/// Numbers between -1 and 1 from a fixed seed (Knuth's linear congruence).
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    fn vector(&mut self) -> Vec3 {
        Vec3::new(self.next(), self.next(), self.next())
    }

    fn matrix(&mut self) -> Mat3 {
        Mat3::from_columns(self.vector(), self.vector(), self.vector())
    }

    fn rotation(&mut self) -> Mat3 {
        exponential(self.vector() * 3.0)
    }
}

/// Stretches where every law has derivatives: at rest, large, compressed to a hundredth, inverted.
const STRETCHES: [[f64; 3]; 9] = [
    [1.0, 1.0, 1.0],
    [1.0 + 1e-9, 1.0, 1.0 - 1e-9],
    [1.3, 0.9, 0.7],
    [3.0, 0.8, 0.5],
    [0.7, 0.6, 0.5],
    [0.4, 0.3, 0.1],
    [1.0, 0.9, -0.5],
    [1.1, 1.0, 0.0],
    [2.0, 1.5, -1.2],
];

/// The stretches along the axes, turned, and between two rotations.
fn examples() -> Vec<Mat3> {
    let mut numbers = Numbers(1);
    let turned = |[a, b, c]: [f64; 3]| {
        let stretch = Mat3::from_diagonal(Vec3::new(a, b, c));
        let (left, right) = (numbers.rotation(), numbers.rotation());
        [stretch, left * stretch, (left * stretch).mul_transpose(&right)]
    };
    STRETCHES.into_iter().flat_map(turned).collect()
}

/// The size of the stiffness at `F` [Pa]: what the error of a stress is to be compared with.
fn stiffness<L: Law>(parameters: &L::Parameters<f64>, F: &Mat3) -> f64 {
    let point = L::at(parameters, F);
    let differential = |i: usize| {
        let mut unit = Mat3::ZERO;
        unit.columns[i / 3][i % 3] = 1.0;
        L::stress_differential(parameters, &point, &unit).largest_entry()
    };
    (0..9).map(differential).fold(YOUNGS_MODULUS, f64::max)
}

fn dual(F: &Mat3, dF: &Mat3) -> Mat3<Dual> {
    let entry = |column: usize, row: usize| Dual::new(F.entry(row, column), dF.entry(row, column));
    Mat3 { columns: [0, 1, 2].map(|column| Vec3::from_array([0, 1, 2].map(|row| entry(column, row)))) }
}

fn derivative(P: &Mat3<Dual>) -> Mat3 {
    Mat3 { columns: P.columns.map(|column| Vec3::from_array(column.to_array().map(|x| x.derivative))) }
}

fn parameters_in_duals<L: Law>(material: &Material) -> L::Parameters<Dual> {
    L::Parameters::unpack(|i| Dual::constant(material.parameters[i]))
}

/// `P : δF = δΨ` and `δP = ∂P/∂F : δF`, exactly differentiated by dual numbers. Not of Ogden's law: principal axes have no
/// derivative where stretches are equal, though what is made of them has; central differences judge it.
#[test]
fn derivatives_agree_with_dual_numbers() {
    for_every_law!(|material, L| {
        if material.law == MaterialLaw::Known(AnyLaw::Ogden) {
            return;
        }
        let (parameters, in_duals) = (material.parameters_of::<L>(), parameters_in_duals::<L>(&material));
        let mut numbers = Numbers(2);
        for F in examples() {
            let dF = numbers.matrix();
            let (P, point) = (L::stress(&parameters, &F), L::at(&parameters, &F));
            // some tens of operations, each wrong by 1e-16 of its terms; these exceed their sum by |F|²
            let rounding = 1e-13 * stiffness::<L>(&parameters, &F) * (1.0 + F.dot(&F));

            let energy = L::energy_density(&in_duals, &dual(&F, &dF)).derivative;
            let work = P.dot(&dF);
            assert!(
                (energy - work).abs() <= rounding,
                "{:?} {F:?}: δΨ = {energy}, P : δF = {work}",
                material.law
            );

            let expected = derivative(&L::stress(&in_duals, &dual(&F, &dF)));
            let measured = L::stress_differential(&parameters, &point, &dF);
            let error = (expected - measured).largest_entry();
            assert!(
                error <= rounding,
                "{:?} {F:?}: δP is wrong by {error:e} Pa of {rounding:e}",
                material.law
            );
        }
    });
}

/// The same by central differences: their error falls as the square of the step, by 4 when it is halved.
#[test]
fn derivatives_agree_with_differences() {
    for_every_law!(|material, L| {
        let parameters = material.parameters_of::<L>();
        let mut numbers = Numbers(3);
        for F in examples() {
            let dF = numbers.matrix();
            let work = L::stress(&parameters, &F).dot(&dF);
            let dP = L::stress_differential(&parameters, &L::at(&parameters, &F), &dF);
            let errors = |h: f64| {
                let (plus, minus) = (F + dF * h, F - dF * h);
                let energy = |F: &Mat3| L::energy_density(&parameters, F);
                let stress = |F: &Mat3| L::stress(&parameters, F);
                (
                    ((energy(&plus) - energy(&minus)) * (0.5 / h) - work).abs(),
                    ((stress(&plus) - stress(&minus)) * (0.5 / h) - dP).largest_entry(),
                )
            };
            let (coarse, fine) = (errors(2e-4), errors(1e-4));
            // rounding of Ψ and P over the step
            let noise = 1e-14 / 1e-4 * stiffness::<L>(&parameters, &F) * (1.0 + F.dot(&F));
            for (what, coarse, fine) in [("Ψ", coarse.0, fine.0), ("P", coarse.1, fine.1)] {
                let bound = 0.3 * coarse + noise;
                assert!(fine <= bound, "{:?} {what} {F:?}: error {coarse:e} -> {fine:e}", material.law);
            }
            // the error itself is small too: a wrong derivative would stay at its size
            assert!(fine.1 <= 1e-4 * stiffness::<L>(&parameters, &F), "{:?} {F:?}: {fine:?}", material.law);
        }
    });
}

/// `δ₁F : δ₂P = δ₂F : δ₁P`: the tangent is a second derivative.
#[test]
fn tangent_is_symmetric() {
    for_every_law!(|material, L| {
        let parameters = material.parameters_of::<L>();
        let mut numbers = Numbers(4);
        for F in examples() {
            let (one, two) = (numbers.matrix(), numbers.matrix());
            let point = L::at(&parameters, &F);
            let differential = |dF: &Mat3| L::stress_differential(&parameters, &point, dF);
            let difference = one.dot(&differential(&two)) - two.dot(&differential(&one));
            let rounding = 1e-13 * stiffness::<L>(&parameters, &F);
            assert!(difference.abs() <= rounding, "{:?} {F:?}: {difference:e}", material.law);
        }
    });
}

/// The blocks written in closed form are the contraction of the differential.
#[test]
fn tangent_blocks_contract_the_differential() {
    for_every_law!(|material, L| {
        let parameters = material.parameters_of::<L>();
        let mut numbers = Numbers(5);
        for F in examples() {
            let (g_a, g_b) = (numbers.vector(), numbers.vector());
            let point = L::at(&parameters, &F);
            let column = |u: Vec3| L::stress_differential(&parameters, &point, &u.outer(g_b)) * g_a;
            let expected = Mat3 { columns: Vec3::AXES.map(column) };
            let measured = L::tangent_block(&parameters, &point, g_a, g_b);
            let error = (expected - measured).largest_entry();
            let rounding = 1e-13 * stiffness::<L>(&parameters, &F);
            assert!(error <= rounding, "{:?} {F:?}: {error:e}", material.law);
        }
    });
}

/// At rest: no energy, no stress, and the tangent of linear elasticity `δP = μ (δF + δFᵀ) + λ tr(δF) I`.
#[test]
fn rest_is_linear_elasticity() {
    for_every_law!(|material, L| {
        let parameters = material.parameters_of::<L>();
        let lame = material.small_strain;
        // moduli of rest are of the size of Young's, times 1 / (1 - 2 ν)
        let rounding = 1e-15 * (lame.longitudinal_modulus() + YOUNGS_MODULUS);
        let energy = L::energy_density(&parameters, &Mat3::IDENTITY);
        let stress = L::stress(&parameters, &Mat3::IDENTITY).largest_entry();
        assert!(energy.abs() <= rounding && stress <= rounding, "{:?}: {energy:e} {stress:e}", material.law);

        let point = L::at(&parameters, &Mat3::IDENTITY);
        let mut numbers = Numbers(6);
        for _ in 0..20 {
            let dF = numbers.matrix();
            let expected = (dF + dF.transpose()) * lame.mu + Mat3::IDENTITY * (lame.lambda * dF.trace());
            let error = (L::stress_differential(&parameters, &point, &dF) - expected).largest_entry();
            assert!(error <= 10.0 * rounding, "{:?}: {error:e}", material.law);
        }
    });
}

/// A law that says that it is linear has one tangent everywhere and `P = ∂P/∂F : (F - I)`, and a law that has says so.
#[test]
fn linear_laws_say_so() {
    for_every_law!(|material, L| {
        let parameters = material.parameters_of::<L>();
        let rest = L::at(&parameters, &Mat3::IDENTITY);
        let mut worst: f64 = 0.0;
        for F in examples() {
            let linear = L::stress_differential(&parameters, &rest, &(F - Mat3::IDENTITY));
            let scale = stiffness::<L>(&parameters, &F) * (1.0 + F.dot(&F));
            worst = worst.max((L::stress(&parameters, &F) - linear).largest_entry() / scale);
        }
        assert_eq!(worst <= 1e-13, L::LINEAR, "{:?}: {worst:e}", material.law);
    });
}

/// A rotation of the body changes no energy and turns the stress: `Ψ(QF) = Ψ(F)`, `P(QF) = Q P(F)`. A law that
/// says it is not objective shows it.
#[test]
fn rotation_changes_no_energy() {
    for_every_law!(|material, L| {
        let parameters = material.parameters_of::<L>();
        let mut numbers = Numbers(7);
        let mut worst: f64 = 0.0;
        for F in examples() {
            let Q = numbers.rotation();
            let scale = stiffness::<L>(&parameters, &F) * (1.0 + F.dot(&F));
            let energies = (L::energy_density(&parameters, &F), L::energy_density(&parameters, &(Q * F)));
            let stress = Q * L::stress(&parameters, &F) - L::stress(&parameters, &(Q * F));
            worst = worst.max((energies.0 - energies.1).abs().max(stress.largest_entry()) / scale);
        }
        assert_eq!(worst <= 1e-13, L::OBJECTIVE, "{:?}: {worst:e}", material.law);
    });
}

/// Rotations of the rest shape change no energy (the material has no direction): `Ψ(FQ) = Ψ(F)`, `P(FQ) = P(F) Q`.
#[test]
fn isotropic_laws_see_no_direction() {
    for_every_law!(|material, L| {
        let parameters = material.parameters_of::<L>();
        let mut numbers = Numbers(8);
        for F in examples().into_iter().filter(|_| L::OBJECTIVE) {
            let Q = numbers.rotation();
            let scale = stiffness::<L>(&parameters, &F) * (1.0 + F.dot(&F));
            let stress = L::stress(&parameters, &F) * Q - L::stress(&parameters, &(F * Q));
            assert!(stress.largest_entry() <= 1e-13 * scale, "{:?} {F:?}", material.law);
        }
    });
}

/// Deformations that no element should have: zero, flat, needles, mirrored, nearly so, tiny, very large.
fn degenerate() -> Vec<Mat3> {
    let mut numbers = Numbers(9);
    let needle = numbers.vector().outer(numbers.vector());
    let diagonal = |a, b, c| Mat3::from_diagonal(Vec3::new(a, b, c));
    let mut degenerate = vec![
        Mat3::ZERO,
        -Mat3::ZERO,
        -Mat3::IDENTITY,
        diagonal(1.0, 1.0, -1.0),
        diagonal(-1.0, 1.0, 1.0),
        diagonal(1.0, 1.0, 0.0),
        diagonal(0.0, 1.0, 0.0),
        diagonal(1.0, 1e-160, -1e-160),
        diagonal(1.0, 0.5, -0.5),
        diagonal(-1.0, -2.0, -3.0),
        diagonal(5e-324, 0.0, 0.0),
        needle,
        needle + Mat3::from_diagonal(Vec3::new(1e-17, 0.0, -1e-17)),
        Mat3::from_rows([[1.0; 3]; 3]),
    ];
    for scale in [1e-300, 1e-150, 1e-9, 1e9, 1e20] {
        degenerate.extend([Mat3::IDENTITY * scale, numbers.matrix() * scale, needle * scale]);
    }
    degenerate
}

/// Energy, stress, differential and block are finite for every `F` that is not so large that a twelfth power of it
/// (the energy of an inverted neo-Hookean element) overflows; a twentieth under Yeoh's law, which has the third power of an invariant
/// that grows as the fourth of an inverted element.
#[test]
fn degenerate_deformations_stay_finite() {
    for_every_law!(|material, L| {
        let parameters = material.parameters_of::<L>();
        let mut numbers = Numbers(10);
        let highest = if material.law == MaterialLaw::Known(AnyLaw::Yeoh) { 20 } else { 12 };
        for F in degenerate().into_iter().filter(|F| F.largest_entry().powi(highest).is_finite()) {
            let point = L::at(&parameters, &F);
            let finite = L::energy_density(&parameters, &F).is_finite()
                && L::stress(&parameters, &F).is_finite()
                && L::stress_differential(&parameters, &point, &numbers.matrix()).is_finite()
                && L::tangent_block(&parameters, &point, numbers.vector(), numbers.vector()).is_finite();
            assert!(finite, "{:?} {F:?}", material.law);
        }
    });
}

/// What the entries say of an element turned inside out along one axis: all laws but St. Venant–Kirchhoff push it
/// back (`∂Ψ/∂s < 0` for stretches `s ≤ 0`), that one balances at the mirror image.
#[test]
fn inverted_elements_are_pushed_back() {
    let push = |law: AnyLaw, s: f64| {
        let material = material(law.entry().name, YOUNGS_MODULUS, 0.3);
        material.stress(&Mat3::from_diagonal(Vec3::new(1.0, 1.0, s))).entry(2, 2)
    };
    for s in [0.0, -1e-12, -0.01, -0.5, -0.999, -1.0, -3.0] {
        for law in AnyLaw::ALL.iter().filter(|law| **law != AnyLaw::StVenantKirchhoff) {
            let stress = push(*law, s);
            assert!(stress < -0.1 * YOUNGS_MODULUS, "{law:?} at {s}: {stress}");
        }
    }
    assert_eq!(push(AnyLaw::StVenantKirchhoff, -1.0), 0.0);
}

/// St. Venant–Kirchhoff gives way below the stretch `1/√3`: `P = (λ + 2μ)(s³ - s)/2` has its minimum there.
#[test]
fn st_venant_kirchhoff_limit_point() {
    let lame = Lame::from_young_poisson(YOUNGS_MODULUS, 0.3);
    let slope = |s: f64| {
        let F = Mat3::from_diagonal(Vec3::new(s, 1.0, 1.0));
        let unit = Mat3::from_diagonal(Vec3::X);
        StVenantKirchhoff::stress_differential(&lame, &StVenantKirchhoff::at(&lame, &F), &unit).entry(0, 0)
    };
    let limit = 1.0 / 3f64.sqrt();
    assert!(slope(limit).abs() <= 4e-15 * YOUNGS_MODULUS);
    assert!(slope(limit + 1e-3) > 0.0 && slope(limit - 1e-3) < 0.0);
}

/// The logarithm goes on smoothly below its smallest volume: energy, stress and stiffness of a shrinking cube have
/// no jump there, and above it they are `Ψ = μ/2 (3 s² - 3) - 3 μ ln s + 9/2 λ (ln s)²` to rounding.
#[test]
fn neo_hookean_continues() {
    let lame = Lame::from_young_poisson(YOUNGS_MODULUS, 0.3);
    let at = |s: f64| {
        let F = Mat3::IDENTITY * s;
        let point = NeoHookean::at(&lame, &F);
        [
            NeoHookean::energy_density(&lame, &F),
            NeoHookean::stress(&lame, &F).entry(0, 0),
            NeoHookean::stress_differential(&lame, &point, &Mat3::from_diagonal(Vec3::X)).entry(0, 0),
        ]
    };
    let smallest = 0.05f64.cbrt();
    for (above, below) in at(smallest * (1.0 + 1e-9)).into_iter().zip(at(smallest * (1.0 - 1e-9))) {
        // a relative step of 2e-9 times the logarithmic derivative, some tens at most
        assert!((above - below).abs() <= 1e-7 * above.abs(), "{above} {below}");
    }
    for s in [smallest * 1.0001, 0.5, 0.9, 1.0, 1.5, 4.0] {
        let expected =
            1.5 * lame.mu * (s * s - 1.0) - 3.0 * lame.mu * ln(s) + 4.5 * lame.lambda * ln(s).powi(2);
        let error = (at(s)[0] - expected).abs();
        assert!(error <= 1e-15 * (expected.abs() + YOUNGS_MODULUS * s * s) * 8.0, "{s}: {error:e}");
    }
}

/// The logarithm that the laws use, the same bits on every machine.
fn ln(s: f64) -> f64 {
    Real::ln(s)
}

/// The energy of the paper, eq. 14, with the moduli of its §3.4, less its value at rest.
#[test]
fn stable_neo_hookean_is_the_papers() {
    let lame = Lame::from_young_poisson(YOUNGS_MODULUS, 0.4);
    let (mu, lambda) = (4.0 / 3.0 * lame.mu, lame.lambda + 5.0 / 6.0 * lame.mu);
    let alpha = 1.0 + mu / lambda - mu / (4.0 * lambda);
    let energy = |F: &Mat3| {
        let (I, J) = (F.transpose_mul(F).trace(), F.determinant());
        mu / 2.0 * (I - 3.0) + lambda / 2.0 * (J - alpha).powi(2) - mu / 2.0 * ln(I + 1.0)
    };
    for F in examples() {
        let expected = energy(&F) - energy(&Mat3::IDENTITY);
        let measured = StableNeoHookean::energy_density(&lame, &F);
        assert!(
            (expected - measured).abs() <= 1e-14 * (YOUNGS_MODULUS + expected.abs()),
            "{expected} {measured}"
        );
    }
}

/// Stresses and energies of an independent implementation.
#[test]
fn reference_stresses() {
    let data: serde_json::Value = serde_json::from_str(include_str!("data/element_stress.json")).unwrap();
    let matrix = |value: &serde_json::Value| {
        Mat3::from_rows([0, 1, 2].map(|row| [0, 1, 2].map(|column| value[row][column].as_f64().unwrap())))
    };
    let [youngs_modulus, poissons_ratio] =
        ["youngs_modulus", "poissons_ratio"].map(|name| data[name].as_f64().unwrap());
    let mut compared = 0;
    for case in data["cases"].as_array().unwrap() {
        let F = matrix(&case["F"]);
        for (name, expected) in case["laws"].as_object().unwrap() {
            let material = material(name, youngs_modulus, poissons_ratio);
            let P = matrix(&expected["P"]);
            let energy = expected["energy_density"].as_f64().unwrap();
            let error = (material.stress(&F) - P).largest_entry();
            assert!(error <= 1e-11 * P.largest_entry(), "{name} {}: {error:e}", case["name"]);
            let error = (material.energy_density(&F) - energy).abs();
            assert!(error <= 1e-11 * energy, "{name} {}: {error:e}", case["name"]);
            compared += 1;
        }
    }
    assert_eq!(compared, 12);
}

/// In lanes of any width, with parameters of their own: the scalar answers to rounding.
#[test]
fn lanes_agree_with_scalar() {
    struct InLanes<L>(Material, std::marker::PhantomData<L>);
    impl<L: Law> WithSimd for InLanes<L> {
        type Output = ();
        #[inline(always)]
        fn with_simd<S: Simd>(self, simd: S) {
            let width = S::F64_LANES;
            let load = |numbers: &[f64]| Lanes::load(simd, numbers);
            let store = |lanes: Lanes<S>, lane: usize| {
                let mut numbers = vec![0.0; width];
                lanes.store(&mut numbers);
                numbers[lane]
            };
            let mut numbers = Numbers(11);
            for group in examples().chunks_exact(width) {
                // the moduli grow from lane to lane
                let grown = |i: usize, lane: usize| self.0.parameters[i] * (1.0 + lane as f64 / 8.0);
                let pack = |matrices: &[Mat3]| {
                    let entry = |row, column| {
                        load(&matrices.iter().map(|F| F.entry(row, column)).collect::<Vec<_>>())
                    };
                    Mat3 {
                        columns: [0, 1, 2]
                            .map(|column| Vec3::from_array([0, 1, 2].map(|row| entry(row, column)))),
                    }
                };
                let unpack = |P: &Mat3<Lanes<S>>, lane: usize| Mat3 {
                    columns: P.columns.map(|c| Vec3::from_array(c.to_array().map(|x| store(x, lane)))),
                };
                let differentials: Vec<Mat3> = group.iter().map(|_| numbers.matrix()).collect();
                let parameters = L::Parameters::<Lanes<S>>::unpack(|i| {
                    load(&(0..width).map(|lane| grown(i, lane)).collect::<Vec<_>>())
                });
                let (F, dF) = (pack(group), pack(&differentials));
                let energy = L::energy_density(&parameters, &F);
                let P = L::stress(&parameters, &F);
                let dP = L::stress_differential(&parameters, &L::at(&parameters, &F), &dF);
                for (lane, (F, dF)) in group.iter().zip(&differentials).enumerate() {
                    let parameters = L::Parameters::<f64>::unpack(|i| grown(i, lane));
                    let scale = stiffness::<L>(&parameters, F) * (1.0 + F.dot(F));
                    let energy_error = (store(energy, lane) - L::energy_density(&parameters, F)).abs();
                    let P_error = (unpack(&P, lane) - L::stress(&parameters, F)).largest_entry();
                    let expected = L::stress_differential(&parameters, &L::at(&parameters, F), dF);
                    let dP_error = (unpack(&dP, lane) - expected).largest_entry();
                    let error = energy_error.max(P_error).max(dP_error);
                    assert!(error <= 1e-13 * scale, "{:?} {F:?}: {error:e}", self.0.law);
                }
            }
        }
    }
    for_every_law!(|material, L| {
        Arch::default().dispatch(InLanes::<L>(material.clone(), std::marker::PhantomData));
        InLanes::<L>(material, std::marker::PhantomData).with_simd(pulp::Scalar::new());
    });
}

/// Numbers go through their packed form unchanged, in the order of their names, within the width of a material.
#[test]
fn parameters_pack() {
    for_every_law!(|material, L| {
        let names = <L::Parameters<f64> as Parameters<f64>>::NAMES;
        let mut packed = vec![f64::NAN; names.len()];
        material.parameters_of::<L>().pack(|i, number| packed[i] = number);
        assert_eq!(packed, material.parameters[..names.len()]);
        assert!(material.parameters[names.len()..].iter().all(|number| *number == 0.0));
    });
}

/// Each entry builds its own law, and carries what the reference pages print.
#[test]
fn entries_are_complete() {
    for law in AnyLaw::ALL {
        let material = material(law.entry().name, YOUNGS_MODULUS, 0.3);
        assert_eq!(material.law, MaterialLaw::Known(*law));
        assert_eq!(material.density, 1000.0);
    }
    for entry in TABLE.entries {
        assert!(!entry.summary.is_empty() && !entry.source.is_empty());
        assert!(entry.parameters.iter().all(|parameter| !parameter.summary.is_empty()));
    }
    // and the law as text
    assert_eq!(TABLE.entries.len(), AnyLaw::ALL.len() + 1);
}

/// Values outside the physics are refused by name.
#[test]
fn bad_parameters_are_refused() {
    let good = [("youngs_modulus", 1e6), ("poissons_ratio", 0.3), ("density", 1000.0)];
    let bad = [
        ("youngs_modulus", 0.0),
        ("youngs_modulus", -1.0),
        ("youngs_modulus", f64::NAN),
        ("youngs_modulus", f64::INFINITY),
        ("poissons_ratio", 0.5),
        ("poissons_ratio", -1.0),
        ("poissons_ratio", 0.7),
        ("density", 0.0),
        ("density", -5.0),
    ];
    let has_modulus = |law: &&AnyLaw| law.entry().parameters[0].name == "youngs_modulus";
    for entry in AnyLaw::ALL.iter().filter(has_modulus).map(|law| law.entry()) {
        for (name, number) in bad {
            let values = good.iter().fold(Values::new(), |values, (n, x)| values.with(*n, Value::Number(*x)));
            let error = entry.values(values.with(name, Value::Number(number))).unwrap_err();
            assert_eq!(error.parameter(), name);
        }
        assert_eq!(entry.values(Values::new()).unwrap_err().parameter(), "youngs_modulus");
    }
}

/// Numbers of Mooney's and Ogden's laws that make no body are refused by name, whether alone or beside each other.
#[test]
fn bad_numbers_of_rubber_are_refused() {
    let refused = |name: &str, given: &[(&'static str, Value)]| {
        let entry = TABLE.find(name).unwrap();
        let rest = Values::new().with("density", Value::Number(1e3));
        let values = given.iter().fold(rest, |values, (name, value)| values.with(*name, *value));
        match entry.values(values) {
            Err(error) => error.parameter().to_owned(),
            Ok(values) => (entry.build)(&values).unwrap_err().path().join("."),
        }
    };
    let (number, numbers) = (Value::Number, Value::Numbers);
    let mooney = |c10, c01, k| {
        refused("mooney_rivlin", &[("c10", number(c10)), ("c01", number(c01)), ("bulk_modulus", number(k))])
    };
    assert_eq!(mooney(1e3, -2e3, 1e6), "c01");
    assert_eq!(mooney(f64::NAN, 1e3, 1e6), "c10");
    assert_eq!(mooney(1e3, 1e3, 0.0), "bulk_modulus");
    let ogden = |mu, alpha| {
        refused("ogden", &[("mu", numbers(mu)), ("alpha", numbers(alpha)), ("bulk_modulus", number(1e6))])
    };
    assert_eq!(ogden(&[1e3], &[]), "alpha");
    assert_eq!(ogden(&[1e3, 2e3], &[2.0]), "alpha");
    assert_eq!(ogden(&[1e3], &[0.0]), "alpha");
    assert_eq!(ogden(&[1e3], &[21.0]), "alpha");
    assert_eq!(ogden(&[1e3], &[-2.0]), "mu");
    assert_eq!(ogden(&[1.0; 4], &[2.0; 4]), "mu");
    assert_eq!(ogden(&[f64::INFINITY], &[2.0]), "mu");
}

/// Mooney's law is Ogden's with the exponents 2 and -2, for every deformation, degenerate ones included: energy, stress and
/// tangent to rounding.
#[test]
fn mooney_rivlin_is_ogden_of_two() {
    let (c10, c01, bulk) = (3e6, 0.7e6, 2e7);
    let number = Value::Number;
    let of = |name: &str, values: Values| {
        let entry = TABLE.find(name).unwrap();
        let values = values.with("bulk_modulus", number(bulk)).with("density", number(1e3));
        (entry.build)(&entry.values(values).unwrap()).unwrap()
    };
    let mooney = of("mooney_rivlin", Values::new().with("c10", number(c10)).with("c01", number(c01)));
    let (mu, alpha) = ([2.0 * c10, -2.0 * c01], [2.0, -2.0]);
    let ogden =
        of("ogden", Values::new().with("mu", Value::Numbers(&mu)).with("alpha", Value::Numbers(&alpha)));
    assert!((mooney.small_strain.mu - ogden.small_strain.mu).abs() <= 1e-15 * c10);
    let (p, q) = (mooney.parameters_of::<MooneyRivlin>(), ogden.parameters_of::<Ogden>());
    let mut numbers = Numbers(12);
    for F in examples().into_iter().chain(degenerate().into_iter().take(14)) {
        let dF = numbers.matrix();
        let scale = stiffness::<MooneyRivlin>(&p, &F) * (1.0 + F.dot(&F));
        let energies = [mooney.energy_density(&F), ogden.energy_density(&F)];
        assert!((energies[0] - energies[1]).abs() <= 1e-13 * scale, "{F:?}: {energies:?}");
        let error = (mooney.stress(&F) - ogden.stress(&F)).largest_entry();
        assert!(error <= 1e-13 * scale, "{F:?}: {error:e} of {scale:e}");
        let differential = MooneyRivlin::stress_differential(&p, &MooneyRivlin::at(&p, &F), &dF);
        let error = (differential - Ogden::stress_differential(&q, &Ogden::at(&q, &F), &dF)).largest_entry();
        assert!(error <= 1e-13 * scale, "{F:?}: {error:e} of {scale:e}");
    }
}

/// The powers of decoupled laws go on smoothly where stretches, areas and volumes fall below a twentieth: energy, stress
/// and tangent have no jump there, along shrinking to a plane, a line and a point.
#[test]
fn decoupled_laws_continue() {
    fn check<L: Law>(material: &Material) {
        let parameters = material.parameters_of::<L>();
        type Shrink = fn(f64) -> Vec3;
        let shrunk: [(f64, Shrink); 3] = [
            (0.05, |s| Vec3::new(1.0, 1.0, s)),
            (0.05, |s| Vec3::new(3.0, s, s)),
            (0.05_f64.cbrt(), |s| Vec3::new(s, s, s)),
        ];
        let mut numbers = Numbers(13);
        for (limit, stretches) in shrunk {
            let dF = numbers.matrix();
            let at = |s: f64| {
                let F = Mat3::from_diagonal(stretches(s));
                let tangent = L::stress_differential(&parameters, &L::at(&parameters, &F), &dF);
                (L::energy_density(&parameters, &F), L::stress(&parameters, &F), tangent)
            };
            let (above, below) = (at(limit * (1.0 + 1e-9)), at(limit * (1.0 - 1e-9)));
            // a step of 2e-9 of the stretch times a derivative, some hundreds of the tangent beside the limits
            let scale = stiffness::<L>(&parameters, &Mat3::from_diagonal(stretches(limit)));
            let jumps = [
                (above.0 - below.0).abs(),
                (above.1 - below.1).largest_entry(),
                (above.2 - below.2).largest_entry(),
            ];
            for (what, jump) in ["energy", "stress", "tangent"].into_iter().zip(jumps) {
                assert!(jump <= 1e-6 * scale, "{:?} at {limit}: {what} jumps by {jump:e}", material.law);
            }
        }
    }
    check::<MooneyRivlin>(&material("mooney_rivlin", YOUNGS_MODULUS, 0.3));
    check::<Ogden>(&material("ogden", YOUNGS_MODULUS, 0.3));
}

/// `K = E / 3(1 - 2ν)`, `M = E (1 - ν) / (1 + ν)(1 - 2ν)`.
#[test]
fn moduli() {
    for ratio in [-0.9, -0.3, 0.0, 0.3, 0.499] {
        let lame = Lame::from_young_poisson(1.0, ratio);
        let (bulk, longitudinal) =
            (1.0 / (3.0 * (1.0 - 2.0 * ratio)), (1.0 - ratio) / ((1.0 + ratio) * (1.0 - 2.0 * ratio)));
        // and back, but for the digits that a small 1 + ν or 1 - 2ν does not have
        assert!((lame.youngs_modulus() - 1.0).abs() <= 1e-12, "{}", lame.youngs_modulus());
        assert!((lame.poissons_ratio() - ratio).abs() <= 1e-12, "{}", lame.poissons_ratio());
        // 1 - 2ν loses the digits that it does not have
        assert!((lame.bulk_modulus() - bulk).abs() <= 1e-14 * longitudinal);
        assert!((lame.longitudinal_modulus() - longitudinal).abs() <= 1e-14 * longitudinal);
    }
    // V-02: μ falls from E/2 to E/3 while λ rises from 0 beyond all bounds
    let of = |ratio: f64| Lame::from_young_poisson(1.0, ratio);
    assert_eq!((of(0.0).mu, of(0.0).lambda), (0.5, 0.0));
    assert!((of(0.5 - 1e-9).mu - 1.0 / 3.0).abs() < 1e-9 && of(0.5 - 1e-9).lambda > 1e8);
    // ν = λ/2(λ + μ) = 50/101
    let hundred = of(50.0 / 101.0);
    assert!((hundred.lambda / hundred.mu - 100.0).abs() < 1e-11, "{}", hundred.lambda / hundred.mu);
}

/// `σ = P Fᵀ / J` is symmetric for objective laws, and absent where there is no volume.
#[test]
fn cauchy_stress_is_symmetric() {
    let material = material("neo_hookean", YOUNGS_MODULUS, 0.3);
    for F in examples().into_iter().filter(|F| F.determinant().abs() > 1e-3) {
        let sigma = cauchy_stress(&material.stress(&F), &F).unwrap();
        assert!(
            sigma.axial_vector().largest_component()
                <= 1e-13 * sigma.largest_entry() + 1e-15 * YOUNGS_MODULUS
        );
    }
    assert_eq!(cauchy_stress(&Mat3::IDENTITY, &Mat3::ZERO), None);
}
