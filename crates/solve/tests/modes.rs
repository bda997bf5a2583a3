//! Eigenpairs of chains and free bodies.

use std::f64::consts::PI;

use souple_math::{Mat3, Vec3};
use souple_solve::modes::{Settings, lowest_modes};
use souple_solve::ritz::{pairs_within, vanishing};
use souple_solve::{BlockMatrix, LinearOperator, SolveError, reduce};

use crate::common::{chain, truss};

/// One mass per block.
fn lumped(stiffness: &BlockMatrix, masses: &[f64]) -> BlockMatrix {
    let mut mass = BlockMatrix::zeros(stiffness.pattern().clone());
    mass.add_scaled_diagonal(1.0, masses).unwrap();
    mass
}

/// A chain of `n` masses `m` and springs `k` between walls has `ω² = 4 k/m sin²(jπ / 2(n+1))`, here each in three
/// directions; shapes are orthonormal in the mass.
#[test]
fn chain_frequencies() {
    let (n, k, m) = (60, 1500.0, 0.2);
    let stiffness = chain(n, k, 0.0);
    let settings = Settings { count: 9, ..Settings::default() };
    let modes = lowest_modes(&stiffness, &lumped(&stiffness, &vec![m; n]), None, &settings).unwrap();
    for (index, value) in modes.eigenvalues.iter().enumerate() {
        let j = (index / 3 + 1) as f64;
        let exact = 4.0 * k / m * (j * PI / (2 * (n + 1)) as f64).sin().powi(2);
        // an eigenvalue errs by the square of the residual, and by the rounding of K: ε ω²max / ω²
        assert!((value / exact - 1.0).abs() < 1e-12 * 4.0 * k / m / exact, "{index}: {value} {exact}");
    }
    for (i, a) in modes.shapes.iter().enumerate() {
        for (j, b) in modes.shapes.iter().enumerate() {
            let product = m * reduce::dot(a, b);
            assert!((product - f64::from(u8::from(i == j))).abs() < 1e-10);
        }
    }
    assert!(modes.residuals.iter().all(|residual| *residual <= 1e-10));
}

/// A free body has six motions without energy; a negative shift makes them accessible.
#[test]
fn free_body_has_six_rigid_modes() {
    let truss = truss([5, 3, 3], 40.0);
    let count = truss.places.len();
    let mut stiffness = truss.matrix.clone();
    stiffness.add_scaled_diagonal(-1.0, &vec![1.0; count]).unwrap();
    let mass = lumped(&stiffness, &vec![1.0; count]);
    let singular = lowest_modes(&stiffness, &mass, None, &Settings::default());
    assert!(matches!(singular, Err(SolveError::Singular { .. })));
    let settings = Settings { count: 8, shift: -1.0, ..Settings::default() };
    let modes = lowest_modes(&stiffness, &mass, Some(&truss.places), &settings).unwrap();
    assert!(modes.eigenvalues[..6].iter().all(|value| value.abs() < 1e-9));
    assert!(modes.eigenvalues[6] > 0.1);
    for (shape, value) in modes.shapes.iter().zip(&modes.eigenvalues) {
        let mut force = vec![Vec3::ZERO; count];
        stiffness.apply(shape, &mut force);
        reduce::add_scaled(&mut force, -value, shape);
        assert!(reduce::norm(&force) < 1e-7);
    }
}

/// All unknowns can be asked for, not one more; blocks without mass do not count.
#[test]
fn counts_are_checked() {
    let stiffness = chain(3, 1.0, 0.0);
    let settings = |count| Settings { count, ..Settings::default() };
    let all = lowest_modes(&stiffness, &lumped(&stiffness, &[1.0; 3]), None, &settings(9)).unwrap();
    assert!((all.eigenvalues[8] - (2.0 + 2.0_f64.sqrt())).abs() < 1e-12);
    let error =
        lowest_modes(&stiffness, &lumped(&stiffness, &[1.0, 0.0, 1.0]), None, &settings(7)).unwrap_err();
    assert_eq!(error, SolveError::TooManyModes { wanted: 7, available: 6 });
}

/// Within a space that holds eigenvectors their pairs are found, whatever else is in it and however its fields mix them; what is to be kept
/// apart is, and what depends on what is there counts once.
#[test]
fn pairs_within_a_space() {
    let (n, k, m) = (20, 1500.0, 0.2);
    let stiffness = chain(n, k, 0.0);
    let mass = lumped(&stiffness, &vec![m; n]);
    let sine = |j: usize| -> Vec<Vec3> {
        (1..=n).map(|i| Vec3::new((i as f64 * j as f64 * PI / (n + 1) as f64).sin(), 0.0, 0.0)).collect()
    };
    let sum =
        |a: &[Vec3], s: f64, b: &[Vec3]| -> Vec<Vec3> { a.iter().zip(b).map(|(a, b)| *a + *b * s).collect() };
    let exact = |j: usize| 4.0 * k / m * (j as f64 * PI / (2 * (n + 1)) as f64).sin().powi(2);
    // 1 + 3, 1 - 2·3, 5, and the sum of the first two
    let fields = [sum(&sine(1), 1.0, &sine(3)), sum(&sine(1), -2.0, &sine(3)), sine(5)];
    let repeated = [&fields[..], &[sum(&fields[0], 1.0, &fields[1])]].concat();
    // rounding of sums of n terms of the largest eigenvalue
    let tolerance = n as f64 * f64::EPSILON * 4.0 * k / m;
    let found = pairs_within(&stiffness, &mass, &repeated, &[]).unwrap();
    assert_eq!(found.eigenvalues.len(), 3);
    for (value, j) in found.eigenvalues.iter().zip([1, 3, 5]) {
        assert!((value - exact(j)).abs() < tolerance, "{j}: {value}");
    }
    let across = pairs_within(&stiffness, &mass, &repeated, &[sine(3)]).unwrap();
    assert_eq!(across.eigenvalues.len(), 2);
    for (value, j) in across.eigenvalues.iter().zip([1, 5]) {
        assert!((value - exact(j)).abs() < tolerance, "{j}: {value}");
    }
    assert!(across.shapes.iter().all(|shape| (m * reduce::dot(shape, &sine(3))).abs() < 1e-12));
    let short = [vec![Vec3::ZERO; n - 1]];
    assert!(matches!(pairs_within(&stiffness, &mass, &short, &[]), Err(SolveError::Length { .. })));
}

/// Of `1, x, x², x³` at 0, 1, 2, 3 those combinations that vanish at 0 and 1 are the multiples of `x(x-1)` and of `x²(x-1)`.
#[test]
fn combinations_that_vanish() {
    let power = |j: i32| -> Vec<Vec3> { (0..4).map(|i| Vec3::new(f64::from(i).powi(j), 0.0, 1.0)).collect() };
    let fields: Vec<Vec<Vec3>> = (0..4).map(power).collect();
    let along = Mat3::from_columns(Vec3::ZERO, Vec3::AXES[1], Vec3::AXES[2]);
    let found = vanishing(&fields, &[(0, along), (1, along)]);
    assert_eq!(found.len(), 2);
    for field in &found {
        assert!(field[0].x == 0.0 && field[1].x == 0.0);
        // a x(x-1) + b x²(x-1): 2a + 4b and 6a + 18b
        let b = (field[3].x - 3.0 * field[2].x) / 6.0;
        let a = (field[2].x - 4.0 * b) / 2.0;
        assert!((2.0 * a + 4.0 * b - field[2].x).abs() < 1e-12 && a.abs() + b.abs() > 0.1);
        // what is free there stays as the coefficients say
        assert!((field[0].z - field[3].z).abs() < 1e-12);
    }
    assert_eq!(vanishing(&fields, &[]).len(), 4);
}
