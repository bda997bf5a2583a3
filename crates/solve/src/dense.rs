//! Small dense symmetric eigenproblems.

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
