//! Sparse products and constraints against their dense definitions.
#![allow(non_snake_case, reason = "symbols of the mathematics")]

use souple_math::{Mat3, Vec3};
use souple_solve::{BlockMatrix, LinearOperator, Pattern, SolveError, reduce};

use crate::common::{chain, distance, flat, noise, norm, on_threads, truss};

/// `y = A x` and `r = b − A x` equal the dense sums, to the rounding of 81 products per row.
#[test]
fn product_equals_dense_product() {
    let matrix = truss([5, 4, 3], 7.0).matrix;
    let count = matrix.block_count();
    let (x, b) = (noise(count, 1), noise(count, 2));
    let dense: Vec<f64> = {
        let x = flat(&x);
        matrix.to_dense().iter().map(|row| row.iter().zip(&x).map(|(a, x)| a * x).sum()).collect()
    };
    let mut y = vec![Vec3::ZERO; count];
    let curvature = matrix.apply_dot(&x, &mut y);
    let tolerance = 100.0 * f64::EPSILON * 81.0 * 7.0;
    assert!(flat(&y).iter().zip(&dense).all(|(y, dense)| (y - dense).abs() < tolerance));
    assert!((curvature - reduce::dot(&x, &y)).abs() < tolerance * count as f64);
    let mut r = vec![Vec3::ZERO; count];
    let r_sq = matrix.residual(&b, &x, &mut r);
    let expected: Vec<Vec3> = b.iter().zip(&y).map(|(b, y)| *b - *y).collect();
    assert!(distance(&r, &expected) < tolerance * count as f64);
    assert!((r_sq - norm(&expected).powi(2)).abs() < tolerance * r_sq);
}

/// `S A S + s (I − S)`: constrained directions decouple, the matrix stays symmetric, free blocks are untouched.
#[test]
fn constraints_decouple_directions() {
    let mut matrix = truss([3, 3, 3], 5.0).matrix;
    let free = matrix.clone();
    let normal = Vec3::new(1.0, 2.0, -2.0) / 3.0;
    let mut projectors = vec![Mat3::IDENTITY; 27];
    projectors[4] = Mat3::ZERO;
    projectors[13] = Mat3::IDENTITY - normal.outer(normal);
    matrix.constrain(&projectors, 11.0).unwrap();
    assert!(matrix.asymmetry() < 1e-14);
    assert_eq!(matrix.diagonal_block(4), Mat3::IDENTITY * 11.0);
    assert_eq!(matrix.block(0, 1), free.block(0, 1));
    // A n = s n at the block that slides, nothing elsewhere
    let mut x = vec![Vec3::ZERO; 27];
    x[13] = normal;
    let mut y = vec![Vec3::ZERO; 27];
    matrix.apply(&x, &mut y);
    x[13] = normal * 11.0;
    assert!(distance(&x, &y) < 1e-13);
}

#[test]
fn misfits_are_named() {
    let mut matrix = chain(4, 1.0, 1.0);
    let other = BlockMatrix::zeros(std::sync::Arc::new(Pattern::diagonal(4).unwrap()));
    assert!(matches!(matrix.add_scaled(1.0, &other), Err(SolveError::OtherPattern { given_blocks: 4, .. })));
    assert_eq!(matrix.add(0, 2, &Mat3::IDENTITY), Err(SolveError::NoSlot { row: 0, column: 2 }));
    let error = matrix.constrain(&[Mat3::IDENTITY; 3], 1.0).unwrap_err();
    assert_eq!(error, SolveError::Length { what: "projectors", given: 3, expected: 4 });
    matrix.add(2, 2, &(Mat3::IDENTITY * f64::NAN)).unwrap();
    assert_eq!(matrix.check_finite(), Err(SolveError::NotFinite { what: "the matrix", block: 2 }));
}

/// Products and curvatures have the same bits for any number of threads.
#[test]
fn same_bits_for_any_thread_count() {
    let matrix = truss([40, 20, 20], 3.0).matrix;
    let x = noise(matrix.block_count(), 3);
    let product = || {
        let mut y = vec![Vec3::ZERO; x.len()];
        let curvature = matrix.apply_dot(&x, &mut y);
        (y, curvature.to_bits())
    };
    let one = on_threads(1, product);
    assert_eq!(one, on_threads(2, product));
    assert_eq!(one, on_threads(5, product));
}
