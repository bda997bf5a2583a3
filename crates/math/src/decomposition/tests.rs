//! Decompositions multiply back, agree with iterations, and never give what is no rotation.

use pulp::{Arch, Simd, WithSimd};

use super::*;
use crate::{Dual, Lanes, exponential};

const EPSILON: f64 = f64::EPSILON;

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

/// Singular values, signed as ours: regular, close to each other, equal, inverted, nearly and wholly singular.
const SINGULAR_VALUES: [[f64; 3]; 18] = [
    [1.0, 1.0, 1.0],
    [1.1, 1.0, 0.9],
    [1.0 + 1e-9, 1.0, 1.0 - 1e-9],
    [1.0 + 1e-15, 1.0, 1.0],
    [3.0, 0.5, 0.1],
    [1.0, 1.0, -0.5],
    [1.0, 0.8, -0.6],
    [1.0, 1.0, -1.0],
    [2.0, 1.0, -1.0 + 1e-9],
    [1.0, 1.0, 0.0],
    [1.0, 1.0, 1e-9],
    [1.0, 1.0, -1e-9],
    [1.0, 1e-6, 1e-12],
    [1e6, 1.0, -1e-6],
    [1.0, 1e-16, 0.0],
    [1.0, 0.0, 0.0],
    [1.0, 1e-9, -1e-9],
    [0.0, 0.0, 0.0],
];

/// Random, aligned with the axes, and turned, at three scales.
fn examples() -> Vec<Mat3> {
    let mut numbers = Numbers(1);
    let mut examples: Vec<Mat3> = (0..2000).map(|_| numbers.matrix()).collect();
    for [a, b, c] in SINGULAR_VALUES {
        let diagonal = Mat3::from_diagonal(Vec3::new(a, b, c));
        examples.extend([diagonal, Mat3::from_diagonal(Vec3::new(c, b, a))]);
        for _ in 0..50 {
            let turned = numbers.rotation() * diagonal * numbers.rotation().transpose();
            examples.extend([turned, turned * 1e-200, turned * 1e200, diagonal * numbers.rotation()]);
        }
    }
    examples
}

fn assert_rotation(R: &Mat3, of: &Mat3) {
    let error = (R.transpose_mul(R) - Mat3::IDENTITY).largest_entry();
    assert!(error <= 16.0 * EPSILON && R.determinant() > 0.0, "error {error:e}, {R:?} of {of:?}");
}

/// `R` is proper and `RᵀF` symmetric, to rounding of the largest entry, for every kind of matrix; of all proper
/// rotations `R` has the largest `tr(RᵀF)`: no sum of two eigenvalues of `S` is negative.
#[test]
fn polar_is_proper_and_symmetric() {
    for F in examples() {
        let Polar { rotation, stretch } = polar(&F);
        assert_rotation(&rotation, &F);
        let rounding = 16.0 * EPSILON * F.largest_entry();
        let skew = rotation.transpose_mul(&F).axial_vector().largest_component();
        assert!(skew <= rounding, "skew {skew:e} of {F:?}");
        assert!((rotation * stretch - F).largest_entry() <= 2.0 * rounding, "{F:?}");
        let values = eigen_symmetric(&(stretch * (1.0 / F.largest_entry().max(1e-300)))).values;
        assert!(values.y + values.z >= -32.0 * EPSILON, "{values:?} of {F:?}");
    }
}

/// `F = Q₁ D Q₂ᵀ` has the polar rotation `Q₁ Q₂ᵀ`; its condition is `s₁/(s₂ + s₃)`.
#[test]
fn polar_of_known_rotation() {
    let mut numbers = Numbers(2);
    for [a, b, c] in SINGULAR_VALUES.into_iter().filter(|[a, b, c]| b + c > 1e-6 * a) {
        for _ in 0..200 {
            let (left, right) = (numbers.rotation(), numbers.rotation());
            let F = left * Mat3::from_diagonal(Vec3::new(a, b, c)).mul_transpose(&right);
            let error = (polar(&F).rotation - left.mul_transpose(&right)).largest_entry();
            assert!(error <= 16.0 * EPSILON * (1.0 + a / (b + c)), "error {error:e} of {a} {b} {c}");
        }
    }
}

/// The closed form and the iteration give the same rotation wherever the closed form trusts itself, which it does for
/// strains up to 60 % whatever the rotation; half turns, flat and inverted matrices are among the examples.
#[test]
fn closed_form_agrees_with_iteration() {
    let mut numbers = Numbers(6);
    let strained: Vec<Mat3> = (0..20_000)
        .map(|i| {
            let values = numbers.vector() * 0.6 + Vec3::new(1.0, 1.0, 1.0);
            // every other one turned by exactly half a turn
            let half = exponential(numbers.vector().try_normalised().unwrap() * std::f64::consts::PI);
            let rotation = if i % 2 == 0 { half } else { numbers.rotation() };
            let stretch = numbers.rotation();
            rotation * stretch * Mat3::from_diagonal(values).mul_transpose(&stretch)
        })
        .collect();
    let trusted = |F: &Mat3| {
        let scaled = F.scaled(inverse_of_largest(F));
        let (rotation, trust) = closed_form(&scaled);
        let Vec3 { x, y, z } = svd(F).values;
        let error = (rotation - iterated(&scaled)).largest_entry();
        let bound = 16.0 * EPSILON * (1.0 + x / (y + z));
        assert!(!trust.all_positive() || error <= bound, "error {error:e} of {F:?}");
        trust.all_positive()
    };
    assert!(strained.iter().all(trusted));
    let among_examples = examples().iter().filter(|F| trusted(F)).count();
    assert!(among_examples > examples().len() / 3, "{among_examples}");
}

/// `F = U diag(s) Vᵀ` with rotations, falling sizes and the sign of the determinant on the last.
#[test]
fn svd_rebuilds() {
    for F in examples() {
        let Svd { left, values, right } = svd(&F);
        assert_rotation(&left, &F);
        assert_rotation(&right, &F);
        let scale = F.largest_entry();
        let rebuilt = left * Mat3::from_diagonal(values).mul_transpose(&right);
        assert!((rebuilt - F).largest_entry() <= 24.0 * EPSILON * scale, "{F:?}");
        let slack = 8.0 * EPSILON * scale;
        assert!(values.x >= values.y - slack && values.y >= values.z.abs() - slack && values.y >= -slack);
    }
}

/// The derivative of the rotation in dual numbers is `R [ω]×`, `ω = H 2 axial(Rᵀ δF)`, at the identity too.
#[test]
fn polar_differentiates() {
    let mut numbers = Numbers(3);
    let examples = [[1.0, 1.0, 1.0], [1.2, 1.0, 0.7], [1.0, 0.9, -0.3], [1.0, 1.0, 0.0]];
    for [a, b, c] in examples {
        let diagonal = Mat3::from_diagonal(Vec3::new(a, b, c));
        let turned = numbers.rotation() * diagonal.mul_transpose(&numbers.rotation());
        for F in [diagonal, turned] {
            let dF = numbers.matrix();
            let Polar { rotation, stretch } = polar(&F);
            let omega = turn_of_stretch(&stretch, 1e-12) * (rotation.transpose_mul(&dF).axial_vector() * 2.0);
            let expected = rotation * omega.cross_matrix();

            let dual = |column: usize, row: usize| Dual::new(F.entry(row, column), dF.entry(row, column));
            let columns = [0, 1, 2].map(|column| Vec3::from_array([0, 1, 2].map(|row| dual(column, row))));
            let measured =
                polar(&Mat3 { columns }).rotation.columns.map(|u| u.to_array().map(|x| x.derivative));
            let measured = Mat3 { columns: measured.map(Vec3::from_array) };
            assert!((measured - expected).largest_entry() < 1e-12, "{measured:?} for {expected:?}");
        }
    }
}

/// Calls its check with groups of matrices and their polar rotations in lanes.
struct InLanes<'a, C>(&'a [Mat3], C);

impl<C: FnMut(&[Mat3], &[Mat3])> WithSimd for InLanes<'_, C> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, simd: S) {
        for group in self.0.chunks_exact(S::F64_LANES) {
            let entry = |row, column| {
                let numbers: Vec<f64> = group.iter().map(|F| F.entry(row, column)).collect();
                Lanes::load(simd, &numbers)
            };
            let columns = [0, 1, 2].map(|column| Vec3::from_array([0, 1, 2].map(|row| entry(row, column))));
            let Polar { rotation, .. } = polar(&Mat3 { columns });
            let mut stored = vec![Mat3::ZERO; S::F64_LANES];
            for (column, row) in (0..9).map(|i| (i / 3, i % 3)) {
                for (R, number) in stored.iter_mut().zip(rotation.entry(row, column).as_slice()) {
                    R.columns[column][row] = *number;
                }
            }
            (self.1)(group, &stored);
        }
    }
}

/// In lanes of any width: the scalar answer to rounding, which grows with the condition `s₁/(s₂ + s₃)`.
#[test]
fn lanes_agree_with_scalar() {
    let check = |group: &[Mat3], rotations: &[Mat3]| {
        for (R, F) in rotations.iter().zip(group) {
            assert_rotation(R, F);
            let Vec3 { x, y, z } = svd(F).values;
            if y + z > 1e-6 * x {
                let error = (*R - polar(F).rotation).largest_entry();
                assert!(error <= 16.0 * EPSILON * (1.0 + x / (y + z)), "error {error:e} of {F:?}");
            }
        }
    };
    Arch::default().dispatch(InLanes(&examples(), check));
    InLanes(&examples(), check).with_simd(pulp::Scalar::new());
}

/// A lane gives the same bits whatever its neighbours, also where some of them need the iteration and some do not.
#[test]
fn lanes_do_not_depend_on_each_other() {
    let mut mixed = examples();
    let count = mixed.len();
    // regular beside singular
    (0..count / 2).step_by(2).for_each(|i| mixed.swap(i, count - 1 - i));
    Arch::default().dispatch(InLanes(&mixed, |group: &[Mat3], rotations: &[Mat3]| {
        for (F, among_others) in group.iter().zip(rotations) {
            let alone = vec![*F; group.len()];
            Arch::default().dispatch(InLanes(&alone, |_: &[Mat3], rotations: &[Mat3]| {
                assert_eq!(rotations[0], *among_others, "{F:?}");
            }));
        }
    }));
}

/// `A = V diag Vᵀ`, falling, for random and repeated eigenvalues.
#[test]
fn eigen_rebuilds() {
    let mut numbers = Numbers(4);
    for i in 0..2000 {
        let A = if i % 2 == 0 {
            numbers.matrix().symmetric_part()
        } else {
            let ([a, b, c], Q) = (SINGULAR_VALUES[i % SINGULAR_VALUES.len()], numbers.rotation());
            (Q * Mat3::from_diagonal(Vec3::new(a, b, c))).mul_transpose(&Q).symmetric_part()
        };
        let Eigen { values, vectors } = eigen_symmetric(&A);
        assert_rotation(&vectors, &A);
        let rebuilt = vectors * Mat3::from_diagonal(values).mul_transpose(&vectors);
        assert!((rebuilt - A).largest_entry() <= 16.0 * EPSILON * A.largest_entry());
        assert!(values.x >= values.y && values.y >= values.z);
    }
}

/// The projection keeps the positive part of the spectrum and nothing else; semidefinite matrices stay as they are.
#[test]
fn projection_is_nearest() {
    let mut numbers = Numbers(5);
    for _ in 0..500 {
        let Q = numbers.rotation();
        let (values, with) = (numbers.vector(), |v: Vec3| (Q * Mat3::from_diagonal(v)).mul_transpose(&Q));
        let positive = with(values.max_components(Vec3::ZERO));
        let projected = project_psd(&with(values));
        assert!((projected - positive).largest_entry() <= 16.0 * EPSILON);
        assert!((project_psd(&positive) - positive).largest_entry() <= 16.0 * EPSILON);
    }
}

/// Input that is not finite ends, without panic.
#[test]
fn not_finite_input_returns() {
    for bad in [f64::NAN, f64::INFINITY] {
        let F = Mat3::from_diagonal(Vec3::new(1.0, bad, 2.0));
        let _ = (polar(&F), svd(&F), eigen_symmetric(&F), project_psd(&F));
    }
}
