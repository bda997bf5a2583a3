//! Small dense symmetric eigenproblems.

/// Buffers of [`take_absolute`].
#[derive(Debug, Default)]
pub struct Workspace {
    reduced: Vec<f64>,
    vectors: Vec<f64>,
}

/// Eigenvalues down to minus this share of the mean diagonal are rounding: those of rigid motions.
const ROUNDING: f64 = 1e-12;

/// Replaces the symmetric `n × n` matrix `a = Σ λ v vᵀ` by its absolute value `Σ |λ| v vᵀ`. Returns whether it had negative
/// eigenvalues; if not, or where it is not finite, not a bit of it changes.
pub fn take_absolute(n: usize, a: &mut [f64], workspace: &mut Workspace) -> bool {
    let Workspace { reduced, vectors } = workspace;
    let rounding = ROUNDING * (0..n).map(|i| a[n * i + i].abs()).sum::<f64>() / n as f64;
    reduced.clear();
    reduced.extend_from_slice(a);
    if !rounding.is_finite() || is_definite(n, reduced, rounding) {
        return false;
    }
    reduced.copy_from_slice(a);
    vectors.resize(n * n, 0.0);
    eigen(n, reduced, vectors);
    if !(0..n).any(|i| reduced[n * i + i] < -rounding) {
        return false;
    }
    // |A| = A - 2 Σ min(λ, 0) v vᵀ
    for (i, v) in vectors.chunks_exact(n).enumerate() {
        let twice = 2.0 * reduced[n * i + i].min(0.0);
        for (row, v_row) in a.chunks_exact_mut(n).zip(v) {
            row.iter_mut().zip(v).for_each(|(entry, v_column)| *entry -= twice * v_row * v_column);
        }
    }
    true
}

/// Whether `A + shift I` has a Cholesky factor; `a` is overwritten.
fn is_definite(n: usize, a: &mut [f64], shift: f64) -> bool {
    for j in 0..n {
        let (above, rows) = a.split_at_mut(n * (j + 1));
        let row_j = &mut above[n * j..];
        let pivot = row_j[j] + shift - row_j[..j].iter().map(|l| l * l).sum::<f64>();
        // NaN is none
        if pivot.is_nan() || pivot <= 0.0 {
            return false;
        }
        let root = pivot.sqrt();
        row_j[j] = root;
        for row in rows.chunks_exact_mut(n) {
            let product: f64 = row[..j].iter().zip(&row_j[..j]).map(|(l, k)| l * k).sum();
            row[j] = (row[j] - product) / root;
        }
    }
    true
}

/// Eigenvalues and eigenvectors (one per row of `vectors`) of the symmetric `n × n` matrix `a` (rows), by
/// Jacobi's cyclic rotations. `a` ends up diagonal, its diagonal the eigenvalues.
pub(crate) fn eigen(n: usize, a: &mut [f64], vectors: &mut [f64]) {
    vectors.fill(0.0);
    for i in 0..n {
        vectors[n * i + i] = 1.0;
    }
    for _ in 0..40 {
        let off: f64 =
            (0..n).flat_map(|i| (0..i).map(move |j| n * i + j)).map(|place| a[place] * a[place]).sum();
        let all: f64 = a.iter().map(|entry| entry * entry).sum();
        if off <= 1e-34 * all {
            break;
        }
        for p in 0..n {
            for q in p + 1..n {
                if a[n * p + q] == 0.0 {
                    continue;
                }
                // tan of the angle that makes a_pq vanish
                let theta = 0.5 * (a[n * q + q] - a[n * p + p]) / a[n * p + q];
                let t = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
                let c = 1.0 / (t * t + 1.0).sqrt();
                let s = t * c;
                let turn = |u: &mut f64, v: &mut f64| (*u, *v) = (c * *u - s * *v, s * *u + c * *v);
                for k in 0..n {
                    let (mut u, mut v) = (a[n * k + p], a[n * k + q]);
                    turn(&mut u, &mut v);
                    (a[n * k + p], a[n * k + q]) = (u, v);
                }
                for table in [&mut *a, &mut *vectors] {
                    let (upper, lower) = table.split_at_mut(n * q);
                    upper[n * p..n * p + n].iter_mut().zip(&mut lower[..n]).for_each(|(u, v)| turn(u, v));
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `Q diag(λ) Qᵀ` with two negative eigenvalues has them turned round and nothing else; what has none keeps its bits.
    #[test]
    fn negative_eigenvalues_turn_round() {
        let n = 6;
        // I - 2 w wᵀ is orthogonal
        let w: Vec<f64> = (0..n).map(|i| (i + 1) as f64 / 91f64.sqrt()).collect();
        let q = |i: usize, k: usize| f64::from(u8::from(i == k)) - 2.0 * w[i] * w[k];
        let matrix = |lambda: [f64; 6]| -> Vec<f64> {
            let entry = |i: usize, j: usize| (0..n).map(|k| q(i, k) * lambda[k] * q(j, k)).sum();
            (0..n * n).map(|place| entry(place / n, place % n)).collect()
        };
        let mut workspace = Workspace::default();
        let mut a = matrix([-3.0, 2.0, 0.0, -0.5, 7.0, 1e-3]);
        assert!(take_absolute(n, &mut a, &mut workspace));
        for (entry, wanted) in a.iter().zip(matrix([3.0, 2.0, 0.0, 0.5, 7.0, 1e-3])) {
            // rounding of sums of n terms of size 7
            assert!((entry - wanted).abs() < 1e-14 * n as f64, "{entry} {wanted}");
        }
        let semidefinite = matrix([4.0, 2.0, 0.0, 0.0, 7.0, 1e-3]);
        let mut kept = semidefinite.clone();
        assert!(!take_absolute(n, &mut kept, &mut workspace));
        assert_eq!(kept, semidefinite);
        let mut broken = vec![f64::NAN; n * n];
        assert!(!take_absolute(n, &mut broken, &mut workspace));
    }

    /// The chain `tridiag(−1, 2, −1)` has the eigenvalues `4 sin²(kπ / 2(n+1))`.
    #[test]
    fn eigenvalues_of_a_chain() {
        let n = 9;
        let mut a = vec![0.0; n * n];
        for i in 0..n {
            a[n * i + i] = 2.0;
            if i + 1 < n {
                a[n * i + i + 1] = -1.0;
                a[n * (i + 1) + i] = -1.0;
            }
        }
        let mut vectors = vec![0.0; n * n];
        eigen(n, &mut a, &mut vectors);
        let mut values: Vec<f64> = (0..n).map(|i| a[n * i + i]).collect();
        values.sort_by(f64::total_cmp);
        for (k, value) in values.iter().enumerate() {
            let sine = ((k + 1) as f64 * std::f64::consts::PI / (2 * (n + 1)) as f64).sin();
            // rounding of n sweeps on entries of size 4
            assert!((value - 4.0 * sine * sine).abs() < 1e-14 * n as f64);
        }
    }
}
