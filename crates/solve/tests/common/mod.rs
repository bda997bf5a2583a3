//! Matrices whose answers are known, and dense elimination to compare with.
#![allow(dead_code, reason = "each test file uses its part")]

use std::sync::Arc;

use souple_math::{Mat3, Vec3};
use souple_solve::{BlockMatrix, Pattern};

/// A truss on a grid of `nx × ny × nz` points: springs to all 26 neighbours, and a mass on every point.
pub struct Truss {
    pub places: Vec<Vec3>,
    pub matrix: BlockMatrix,
}

/// Springs of stiffness `k / length` and masses 1: the smallest eigenvalue is 1, rigid motions feel masses only.
pub fn truss([nx, ny, nz]: [usize; 3], k: f64) -> Truss {
    let place = |i: usize| Vec3::new((i / (ny * nz)) as f64, (i / nz % ny) as f64, (i % nz) as f64);
    let places: Vec<Vec3> = (0..nx * ny * nz).map(place).collect();
    let mut links = Vec::new();
    for (a, p) in places.iter().enumerate() {
        for step in 14..27 {
            let q =
                *p + Vec3::new((step / 9) as f64 - 1.0, (step / 3 % 3) as f64 - 1.0, (step % 3) as f64 - 1.0);
            let inside = |x: f64, n: usize| x >= 0.0 && x < n as f64;
            if inside(q.x, nx) && inside(q.y, ny) && inside(q.z, nz) {
                links.push([a as u32, ((q.x as usize * ny + q.y as usize) * nz + q.z as usize) as u32]);
            }
        }
    }
    let pattern = Pattern::from_cliques(places.len(), links.iter().map(|link| &link[..])).unwrap();
    let mut matrix = BlockMatrix::zeros(Arc::new(pattern));
    for &[a, b] in &links {
        let (a, b) = (a as usize, b as usize);
        let d = places[b] - places[a];
        let block = d.outer(d) * (k / d.length_sq() / d.length());
        matrix.add(a, a, &block).unwrap();
        matrix.add(b, b, &block).unwrap();
        matrix.add(a, b, &-block).unwrap();
        matrix.add(b, a, &-block).unwrap();
    }
    matrix.add_scaled_diagonal(1.0, &vec![1.0; places.len()]).unwrap();
    Truss { places, matrix }
}

/// `tridiag(−k I, (2 k + shift) I, −k I)`.
pub fn chain(count: usize, k: f64, shift: f64) -> BlockMatrix {
    let links: Vec<[u32; 2]> = (1..count as u32).map(|i| [i - 1, i]).collect();
    let pattern = Pattern::from_cliques(count, links.iter().map(|link| &link[..])).unwrap();
    let mut matrix = BlockMatrix::zeros(Arc::new(pattern));
    for i in 0..count {
        matrix.add(i, i, &(Mat3::IDENTITY * (2.0 * k + shift))).unwrap();
        if i > 0 {
            matrix.add(i, i - 1, &(Mat3::IDENTITY * -k)).unwrap();
            matrix.add(i - 1, i, &(Mat3::IDENTITY * -k)).unwrap();
        }
    }
    matrix
}

/// A fixed vector without symmetry, entries in (−1, 1).
pub fn noise(count: usize, seed: u64) -> Vec<Vec3> {
    let mut state = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
    let mut next = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    };
    (0..count).map(|_| Vec3::new(next(), next(), next())).collect()
}

pub fn flat(x: &[Vec3]) -> Vec<f64> {
    x.iter().flat_map(|entry| entry.to_array()).collect()
}

/// `A⁻¹ b` by Gaussian elimination with pivoting.
pub fn dense_solve(matrix: &BlockMatrix, b: &[Vec3]) -> Vec<Vec3> {
    let mut a = matrix.to_dense();
    let mut x = flat(b);
    let n = x.len();
    for k in 0..n {
        let pivot = (k..n).max_by(|&i, &j| a[i][k].abs().total_cmp(&a[j][k].abs())).unwrap();
        a.swap(k, pivot);
        x.swap(k, pivot);
        for i in k + 1..n {
            let factor = a[i][k] / a[k][k];
            if factor != 0.0 {
                let row = a[k].clone();
                a[i][k..].iter_mut().zip(&row[k..]).for_each(|(entry, above)| *entry -= factor * above);
                x[i] -= factor * x[k];
            }
        }
    }
    for k in (0..n).rev() {
        let known: f64 = (k + 1..n).map(|j| a[k][j] * x[j]).sum();
        x[k] = (x[k] - known) / a[k][k];
    }
    x.chunks(3).map(|entry| Vec3::new(entry[0], entry[1], entry[2])).collect()
}

pub fn distance(a: &[Vec3], b: &[Vec3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (*a - *b).length_sq()).sum::<f64>().sqrt()
}

pub fn norm(a: &[Vec3]) -> f64 {
    a.iter().map(|a| a.length_sq()).sum::<f64>().sqrt()
}

/// Runs `work` on a pool of so many threads.
pub fn on_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(work)
}
