//! Second derivatives from the values at irregular neighbours: `Δu` and `grad div u` as `Σ_j C_j (u_j - u_i)`.
//!
//! With the arm `l_j` to a neighbour, its length `l` and direction `n`, and `d` the dimension of space:
//!
//! - `legacy`: `Δu = 2/Σl Σ (u_j - u_i)/l` and `grad div u = 2/Σl Σ n n·(u_j - u_i)/l`, as printed. The first is the mean second
//!   derivative over directions, `Δu/d` of a set that is the same in all directions; the second is, of such a set,
//!   `R = (Δu + 2 grad div u)/(d (d + 2))`, no `grad div` at all.
//! - `corrected`: `Δu` is `d` times that, and `grad div u = ½ (d (d + 2) R - Δu)`. Exact of quadratic fields where directions are
//!   spread evenly and arms are met by opposite ones; a set that leans to one side sees gradients besides.
//! - `least_squares`: the quadratic field that fits the neighbours best, weighted by `1/l²`: exact of every quadratic field on every
//!   set that tells its derivatives.
//!
//! (Debunne 2000, 3 §1-2; Fujiwara 1995; what the second one computes, its cure and the third are the specification's, 2.5.)

#![allow(non_snake_case)]

use souple_math::{Mat3, Vec3};

/// How second derivatives are made of neighbours.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operators {
    Legacy,
    Corrected,
    LeastSquares,
}

/// What a neighbour's relative displacement adds to the operators [1/m²].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coefficient {
    pub laplacian: f64,
    pub grad_div: Mat3,
}

impl Operators {
    /// Coefficients for arms in a space of two (`z` is left out) or three dimensions; `None` where the arms do not tell all
    /// second derivatives.
    pub fn of(self, arms: &[Vec3], dimension: usize) -> Option<Vec<Coefficient>> {
        let d = dimension as f64;
        let total: f64 = arms.iter().map(|arm| arm.length()).sum();
        match self {
            Self::Legacy | Self::Corrected if arms.is_empty() => None,
            Self::Legacy => Some(arms.iter().map(|arm| averaged(*arm, total, 1.0)).collect()),
            Self::Corrected => Some(
                arms.iter()
                    .map(|arm| {
                        let Coefficient { laplacian, grad_div: R } = averaged(*arm, total, 1.0);
                        let laplacian = d * laplacian;
                        let grad_div = (R * (d * (d + 2.0))).plus_diagonal(-laplacian) * 0.5;
                        Coefficient { laplacian, grad_div }
                    })
                    .collect(),
            ),
            Self::LeastSquares => least_squares(arms, dimension),
        }
    }
}

fn averaged(arm: Vec3, total: f64, scale: f64) -> Coefficient {
    let length = arm.length();
    let laplacian = scale * 2.0 / (total * length);
    let n = arm * (1.0 / length);
    Coefficient { laplacian, grad_div: n.outer(n) * laplacian }
}

/// Unknowns of a quadratic field without its value: three slopes and six second derivatives.
const MOST: usize = 9;
/// Pivots below this part of the greatest: the arms do not tell that derivative.
const SINGULAR: f64 = 1e-9;

/// `P_j`: what slopes and second derivatives add to a value at an arm; second derivatives by pairs of axes.
fn row(arm: Vec3, dimension: usize, row: &mut [f64; MOST]) {
    let x = arm.to_array();
    row[..dimension].copy_from_slice(&x[..dimension]);
    for (slot, (a, b)) in pairs(dimension).enumerate() {
        row[dimension + slot] = x[a] * x[b] * if a == b { 0.5 } else { 1.0 };
    }
}

fn pairs(dimension: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..dimension).flat_map(move |a| (a..dimension).map(move |b| (a, b)))
}

/// `c = W P (Pᵀ W P)⁻¹ b` with the moments `b` of each operator.
fn least_squares(arms: &[Vec3], dimension: usize) -> Option<Vec<Coefficient>> {
    let unknowns = dimension + dimension * (dimension + 1) / 2;
    // of size one, for the pivots to be compared
    let size = arms.iter().map(|arm| arm.length()).sum::<f64>() / arms.len().max(1) as f64;
    let mut rows = vec![[0.0; MOST]; arms.len()];
    let mut normal = [[0.0; MOST]; MOST];
    for (arm, own) in arms.iter().zip(&mut rows) {
        let arm = *arm * (1.0 / size);
        row(arm, dimension, own);
        let weight = 1.0 / arm.length_sq();
        for a in 0..unknowns {
            for b in 0..unknowns {
                normal[a][b] += weight * own[a] * own[b];
            }
        }
    }
    let inverse = inverse(normal, unknowns)?;
    let coefficients = arms.iter().zip(&rows).map(|(arm, own)| {
        let weight = size * size / arm.length_sq();
        let second = |wanted: (usize, usize)| {
            let slot = dimension + pairs(dimension).position(|pair| pair == wanted).unwrap_or_default();
            let sum: f64 = (0..unknowns).map(|a| own[a] * inverse[a][slot]).sum();
            weight * sum / (size * size)
        };
        let laplacian = (0..dimension).map(|axis| second((axis, axis))).sum();
        // (grad div u)_a = Σ_b ∂_ab u_b
        let mut entries = [[0.0; 3]; 3];
        for (a, b) in pairs(dimension) {
            entries[a][b] = second((a, b));
            entries[b][a] = entries[a][b];
        }
        Coefficient { laplacian, grad_div: Mat3::from_rows(entries) }
    });
    Some(coefficients.collect())
}

/// By Gauss and Jordan with pivots; `None` of a singular matrix.
fn inverse(mut m: [[f64; MOST]; MOST], size: usize) -> Option<[[f64; MOST]; MOST]> {
    let mut out = [[0.0; MOST]; MOST];
    (0..size).for_each(|at| out[at][at] = 1.0);
    let largest = m.iter().flatten().fold(0.0_f64, |a, b| a.max(b.abs()));
    for column in 0..size {
        let pivot = (column..size).max_by(|a, b| m[*a][column].abs().total_cmp(&m[*b][column].abs()))?;
        let height = m[pivot][column].abs();
        if height.is_nan() || height <= SINGULAR * largest {
            return None;
        }
        m.swap(column, pivot);
        out.swap(column, pivot);
        let scale = 1.0 / m[column][column];
        for at in 0..size {
            m[column][at] *= scale;
            out[column][at] *= scale;
        }
        for other in (0..size).filter(|other| *other != column) {
            let factor = m[other][column];
            for at in 0..size {
                m[other][at] -= factor * m[column][at];
                out[other][at] -= factor * out[column][at];
            }
        }
    }
    Some(out)
}

/// Weights of the neighbours in the gradient that fits them best, `G = Σ (u_j - u_i) ⊗ g_j` with
/// `g_j = w_j (Σ w l lᵀ)⁻¹ l_j` and `w = 1/l²`; `None` where arms lie in a plane, or on a line of the plane.
pub fn gradient_weights(arms: &[Vec3], dimension: usize) -> Option<Vec<Vec3>> {
    let mut moments = moments(arms);
    if dimension == 2 {
        moments.columns[2] = Vec3::AXES[2];
    }
    let inverse = moments.try_inverse().filter(|inverse| inverse.is_finite())?;
    // of a sum of unit matrices the inverse is of the size of one over their number
    (inverse.largest_entry() * SINGULAR < 1.0).then(|| weighted(arms, &inverse))
}

/// The same where arms may lie in a plane or on a line: the least gradient that fits them, to a part of a billion.
pub fn least_gradient_weights(arms: &[Vec3]) -> Vec<Vec3> {
    let moments = moments(arms);
    let inverse = moments.plus_diagonal(SINGULAR * moments.trace()).try_inverse();
    inverse.map_or_else(|| vec![Vec3::ZERO; arms.len()], |inverse| weighted(arms, &inverse))
}

fn moments(arms: &[Vec3]) -> Mat3 {
    let mut moments = Mat3::ZERO;
    arms.iter().for_each(|arm| moments += arm.outer(*arm) * (1.0 / arm.length_sq()));
    moments
}

fn weighted(arms: &[Vec3], inverse: &Mat3) -> Vec<Vec3> {
    arms.iter().map(|arm| *inverse * *arm * (1.0 / arm.length_sq())).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The operators on the quadratic field of one component `u_k = x_a x_b`: of each, `Δ` and `grad div`.
    fn on_quadratic(
        operators: Operators,
        arms: &[Vec3],
        dimension: usize,
        [k, a, b]: [usize; 3],
    ) -> [Vec3; 2] {
        let coefficients = operators.of(arms, dimension).unwrap();
        let mut sums = [Vec3::ZERO; 2];
        for (arm, Coefficient { laplacian, grad_div }) in arms.iter().zip(&coefficients) {
            let x = arm.to_array();
            let u = Vec3::AXES[k] * (x[a] * x[b]);
            sums[0] += u * *laplacian;
            sums[1] += *grad_div * u;
        }
        sums
    }

    /// `Δ` and `grad div` of that field.
    fn exact([k, a, b]: [usize; 3]) -> [Vec3; 2] {
        let twice = if a == b { 2.0 } else { 0.0 };
        // ∂_k of everything: of x_a x_b, the other variable's direction
        let mut grad_div = Vec3::ZERO;
        if a == k {
            grad_div += Vec3::AXES[b];
        }
        if b == k {
            grad_div += Vec3::AXES[a];
        }
        [Vec3::AXES[k] * twice, grad_div]
    }

    fn around(dimension: usize) -> Vec<Vec3> {
        let reach = |axis: usize| if axis < dimension { -1..=1 } else { 0..=0 };
        let mut arms = Vec::new();
        for x in reach(0) {
            for y in reach(1) {
                arms.extend(reach(2).map(|z| Vec3::new(f64::from(x), f64::from(y), f64::from(z))));
            }
        }
        arms.retain(|arm| *arm != Vec3::ZERO);
        arms
    }

    fn axes(dimension: usize) -> Vec<Vec3> {
        (0..dimension).flat_map(|axis| [Vec3::AXES[axis], -Vec3::AXES[axis]]).collect()
    }

    /// V-04, the table of 2.5.3: what the printed operators give of second derivatives on regular sets.
    #[test]
    fn legacy_operators_average_directions() {
        // set, Δ of x² over 2, then of grad div's x component the parts of u_x,xx, u_x,yy and u_y,xy
        let rows = [
            (axes(2), 2, [0.5, 0.5, 0.0, 0.0]),
            (around(2), 2, [0.5, 0.35355, 0.14645, 0.2929]),
            (axes(3), 3, [1.0 / 3.0, 1.0 / 3.0, 0.0, 0.0]),
            (around(3), 3, [1.0 / 3.0, 0.17292, 0.08021, 0.16043]),
        ];
        for (arms, dimension, [laplacian, xx, yy, cross]) in rows {
            let on = |field| on_quadratic(Operators::Legacy, &arms, dimension, field);
            let (of_xx, of_yy, of_cross) = (on([0, 0, 0]), on([0, 1, 1]), on([1, 0, 1]));
            assert!(
                (of_xx[0].x / 2.0 - laplacian).abs() < 1e-12,
                "a third of it in space, half in the plane"
            );
            for (measured, printed) in
                [(of_xx[1].x / 2.0, xx), (of_yy[1].x / 2.0, yy), (of_cross[1].x, cross)]
            {
                assert!((measured - printed).abs() < 1e-4, "{measured} {printed}");
            }
        }
    }

    /// The mean fourth moments of the icosahedron's corners and its opposite faces' middles are those of the sphere.
    fn isotropic() -> Vec<Vec3> {
        let golden = 0.5 * (1.0 + 5.0_f64.sqrt());
        let mut arms = Vec::new();
        for (one, other) in [(1.0, golden), (-1.0, golden), (1.0, -golden), (-1.0, -golden)] {
            arms.extend([Vec3::new(0.0, one, other), Vec3::new(one, other, 0.0), Vec3::new(other, 0.0, one)]);
        }
        arms
    }

    /// Corrected operators are exact of quadratic fields on sets that are the same in all directions.
    #[test]
    fn corrected_operators_are_exact_on_isotropic_sets() {
        let octagon = (0..8).map(|i| {
            let angle = f64::from(i) * std::f64::consts::FRAC_PI_4;
            Vec3::new(angle.cos(), angle.sin(), 0.0)
        });
        for (arms, dimension) in [(isotropic(), 3), (octagon.collect(), 2)] {
            for field in fields(dimension) {
                let measured = on_quadratic(Operators::Corrected, &arms, dimension, field);
                for (measured, exact) in measured.iter().zip(exact(field)) {
                    assert!((*measured - exact).length() < 1e-12, "{field:?} {measured:?} {exact:?}");
                }
            }
        }
    }

    fn fields(dimension: usize) -> impl Iterator<Item = [usize; 3]> {
        let all = move |k| (0..dimension).flat_map(move |a| (a..dimension).map(move |b| [k, a, b]));
        (0..dimension).flat_map(all)
    }

    /// Without any symmetry: each axis by a frequency of its own.
    fn random(count: usize, dimension: usize) -> Vec<Vec3> {
        let number = |i: usize, frequency: f64| ((i as f64 + 0.3) * frequency).sin();
        let flat = if dimension == 2 { 0.0 } else { 1.0 };
        (0..count)
            .map(|i| Vec3::new(number(i, 12.9898), number(i, 78.233), flat * number(i, 37.719)))
            .collect()
    }

    /// Least squares are exact of all quadratic fields on sets without any symmetry, and see neither values nor slopes.
    #[test]
    fn least_squares_are_exact_on_every_set() {
        for (arms, dimension) in [(random(14, 3), 3), (random(9, 2), 2)] {
            for field in fields(dimension) {
                let measured = on_quadratic(Operators::LeastSquares, &arms, dimension, field);
                for (measured, exact) in measured.iter().zip(exact(field)) {
                    assert!((*measured - exact).length() < 1e-10, "{field:?} {measured:?} {exact:?}");
                }
            }
            let coefficients = Operators::LeastSquares.of(&arms, dimension).unwrap();
            let slope: Vec3 = arms.iter().zip(&coefficients).map(|(arm, c)| *arm * c.laplacian).sum();
            assert!(slope.length() < 1e-11, "{slope:?}");
        }
        // six neighbours on the axes do not tell mixed derivatives
        assert_eq!(Operators::LeastSquares.of(&axes(3), 3), None);
    }

    /// Gradients by least squares are exact of linear fields.
    #[test]
    fn gradients_are_exact_of_linear_fields() {
        for (arms, dimension) in [(random(7, 3), 3), (random(5, 2), 2)] {
            let weights = gradient_weights(&arms, dimension).unwrap();
            let slope = Vec3::new(0.3, -1.2, if dimension == 2 { 0.0 } else { 0.7 });
            let found: Vec3 = arms.iter().zip(&weights).map(|(arm, g)| *g * arm.dot(slope)).sum();
            assert!((found - slope).length() < 1e-12, "{found:?}");
        }
    }
}
