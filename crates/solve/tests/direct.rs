//! Direct factors against dense elimination, and matrices that have none.
#![allow(non_snake_case, reason = "symbols of the mathematics")]

use std::sync::Arc;

use souple_math::{Mat3, Vec3};
use souple_solve::direct::Factor;
use souple_solve::{BlockMatrix, DirectSolver, LuSolver, Pattern, SolveError};

use crate::common::{chain, dense_solve, distance, noise, norm, truss};

/// `‖x − x*‖ ≤ κ n ε ‖x*‖` with `κ ≤ ‖A‖₁` (the smallest eigenvalue is 1).
#[test]
fn solutions_equal_dense_ones() {
    let truss = truss([6, 4, 3], 50.0);
    let b = noise(truss.places.len(), 5);
    let expected = dense_solve(&truss.matrix, &b);
    let rows = truss.matrix.to_dense();
    let largest_row =
        rows.iter().map(|row| row.iter().map(|entry| entry.abs()).sum::<f64>()).fold(0.0, f64::max);
    let tolerance = largest_row * rows.len() as f64 * f64::EPSILON * norm(&expected);
    for coordinates in [Some(&truss.places[..]), None] {
        for factor in [Factor::Cholesky, Factor::Ldlt] {
            let mut solver = DirectSolver::analyse_for(factor, truss.matrix.pattern(), coordinates).unwrap();
            // twice, since buffers are re-used
            for scale in [3.0, 1.0] {
                let mut matrix = truss.matrix.clone();
                matrix.scale(scale);
                solver.factorize(&matrix).unwrap();
            }
            let mut x = b.clone();
            solver.solve(&mut x).unwrap();
            assert!(distance(&x, &expected) < tolerance);
            assert_eq!(solver.negative_pivots(), 0);
        }
    }
    let mut solver = LuSolver::analyse(truss.matrix.pattern()).unwrap();
    solver.factorize(&truss.matrix).unwrap();
    let mut x = b.clone();
    solver.solve(&mut x).unwrap();
    assert!(distance(&x, &expected) < tolerance);
}

/// A factor in single precision solves to its precision times the condition, whatever the size of the right-hand side, and takes less than
/// half the memory; a matrix of which single precision would keep too little stays whole.
#[test]
fn rounded_factors_are_nearly_whole() {
    let factor_of = |stiffness: f64| {
        let truss = truss([6, 4, 3], stiffness);
        let mut solver = DirectSolver::analyse(truss.matrix.pattern(), Some(&truss.places)).unwrap();
        assert!(solver.into_rounded().is_err(), "there is no factor yet");
        solver = DirectSolver::analyse(truss.matrix.pattern(), Some(&truss.places)).unwrap();
        solver.factorize(&truss.matrix).unwrap();
        (truss, solver)
    };
    let (truss, solver) = factor_of(50.0);
    let whole = solver.bytes();
    let Ok(rounded) = solver.into_rounded() else { panic!("the matrix is well conditioned") };
    assert!(2 * rounded.bytes() < whole);
    let rows = truss.matrix.to_dense();
    // the smallest eigenvalue is 1
    let condition =
        rows.iter().map(|row| row.iter().map(|entry| entry.abs()).sum::<f64>()).fold(0.0, f64::max);
    for size in [1e-60, 1.0, 1e60] {
        let b: Vec<Vec3> = noise(truss.places.len(), 5).into_iter().map(|b| b * size).collect();
        let expected = dense_solve(&truss.matrix, &b);
        let mut x = b.clone();
        rounded.solve(&mut x);
        let off = distance(&x, &expected) / norm(&expected);
        assert!(off < condition * f64::from(f32::EPSILON), "{size}: {off}");
        assert!(off > f64::EPSILON, "{size}: {off} is no single precision");
    }
    let mut nothing = vec![Vec3::ZERO; truss.places.len()];
    rounded.solve(&mut nothing);
    assert!(nothing.iter().all(|x| *x == Vec3::ZERO));
    let (_, solver) = factor_of(1e8);
    let Err(solver) = solver.into_rounded() else { panic!("1e-8 of the diagonal is left in the pivots") };
    let mut x = noise(truss.places.len(), 5);
    solver.solve(&mut x).unwrap();
}

/// A matrix that is not symmetric, against dense elimination (diagonally dominant: κ < 10).
#[test]
fn lu_solves_what_is_not_symmetric() {
    let mut matrix = truss([4, 3, 3], 0.5).matrix;
    for (slot, block) in matrix.values_mut().iter_mut().enumerate() {
        let turn = Vec3::new(0.01, 0.02, -0.03) * (slot % 7) as f64;
        *block += turn.cross_matrix();
    }
    let b = noise(36, 8);
    let mut solver = LuSolver::analyse(matrix.pattern()).unwrap();
    solver.factorize(&matrix).unwrap();
    let mut x = b.clone();
    solver.solve(&mut x).unwrap();
    let expected = dense_solve(&matrix, &b);
    assert!(distance(&x, &expected) < 1e-12 * norm(&expected));
}

/// Bodies that hang on nothing, single blocks and parts that do not touch are all systems.
#[test]
fn unusual_shapes() {
    for count in [0, 1, 2, 100] {
        let mut matrix = BlockMatrix::zeros(Arc::new(Pattern::diagonal(count).unwrap()));
        matrix.add_scaled_diagonal(4.0, &vec![1.0; count]).unwrap();
        for coordinates in [None, Some(vec![Vec3::X; count])] {
            let mut solver = DirectSolver::analyse(matrix.pattern(), coordinates.as_deref()).unwrap();
            solver.factorize(&matrix).unwrap();
            let mut x = vec![Vec3::Y; count];
            solver.solve(&mut x).unwrap();
            assert_eq!(x, vec![Vec3::Y * 0.25; count]);
        }
    }
}

/// A free body has no stiffness against rigid motions: singular, hence not positive definite, to rounding.
#[test]
fn singular_and_indefinite_matrices_are_refused() {
    let truss = truss([8, 3, 3], 10.0);
    let mut free = truss.matrix.clone();
    free.add_scaled_diagonal(-1.0, &[1.0; 72]).unwrap();
    let mut solver = DirectSolver::analyse(free.pattern(), Some(&truss.places)).unwrap();
    assert!(matches!(solver.factorize(&free), Err(SolveError::NotPositiveDefinite { .. })));
    assert_eq!(
        solver.solve(&mut [Vec3::ZERO; 72]),
        Err(SolveError::NoFactor { method: "the direct solver" })
    );

    let mut flat = chain(6, 1.0, 1.0);
    flat.values_mut()[0] = Mat3::from_diagonal(Vec3::new(3.0, 0.0, 3.0));
    let slot = flat.pattern().slot(0, 1).unwrap();
    flat.values_mut()[slot] = Mat3::ZERO;
    let slot = flat.pattern().slot(1, 0).unwrap();
    flat.values_mut()[slot] = Mat3::ZERO;
    let mut ldlt = DirectSolver::analyse_for(Factor::Ldlt, flat.pattern(), None).unwrap();
    assert!(matches!(ldlt.factorize(&flat), Err(SolveError::Singular { block: 0, .. })));
    let mut lu = LuSolver::analyse(flat.pattern()).unwrap();
    assert!(matches!(lu.factorize(&flat), Err(SolveError::Singular { .. })));
}

/// Sylvester: the pivots of `A − σ` count the eigenvalues below `σ`; those of the chain are `4 sin²`, each three
/// times.
#[test]
fn negative_pivots_count_eigenvalues() {
    let n = 20;
    for sigma in [0.1, 0.93, 2.5] {
        let below = (1..=n)
            .filter(|&k| 4.0 * (k as f64 * std::f64::consts::PI / (2 * (n + 1)) as f64).sin().powi(2) < sigma)
            .count();
        let shifted = chain(n, 1.0, -sigma);
        let mut solver = DirectSolver::analyse_for(Factor::Ldlt, shifted.pattern(), None).unwrap();
        solver.factorize(&shifted).unwrap();
        assert_eq!(solver.negative_pivots(), 3 * below);
        let b = noise(n, 1);
        let mut x = b.clone();
        solver.solve(&mut x).unwrap();
        let expected = dense_solve(&shifted, &b);
        assert!(distance(&x, &expected) < 1e-11 * norm(&expected));
    }
}

#[test]
fn bad_numbers_are_named() {
    let mut matrix = chain(5, 1.0, 1.0);
    let places = vec![Vec3::X * f64::NAN; 5];
    let error = DirectSolver::analyse(matrix.pattern(), Some(&places)).unwrap_err();
    assert_eq!(error, SolveError::NotFinite { what: "a coordinate", block: 0 });
    let error = DirectSolver::analyse(matrix.pattern(), Some(&places[..2])).unwrap_err();
    assert_eq!(error, SolveError::Length { what: "coordinates", given: 2, expected: 5 });
    let mut solver = DirectSolver::analyse(matrix.pattern(), None).unwrap();
    matrix.add(3, 3, &(Mat3::IDENTITY * f64::INFINITY)).unwrap();
    assert_eq!(solver.factorize(&matrix), Err(SolveError::NotFinite { what: "the matrix", block: 3 }));
}
