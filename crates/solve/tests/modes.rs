//! Eigenpairs of chains and free bodies.

use std::f64::consts::PI;

use souple_math::Vec3;
use souple_solve::modes::{Settings, lowest_modes};
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
