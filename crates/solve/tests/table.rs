//! The solvers of the scene format, each by its name.

use souple_math::Vec3;
use souple_solve::precondition::Geometry;
use souple_solve::solvers::{self, LinearSolver};
use souple_solve::{BlockMatrix, SolveError};
use souple_table::{Value, Values};

use crate::common::{chain, dense_solve, distance, noise, norm, truss};

fn build(name: &str, values: Values, matrix: &BlockMatrix, places: &[Vec3]) -> Box<dyn LinearSolver> {
    let entry = solvers::TABLE.find(name).unwrap();
    (entry.build.build)(&entry.values(values).unwrap(), matrix, Geometry::points(places)).unwrap()
}

/// Each solver meets its tolerance on the first matrix and on the next: `‖x − x*‖ ≤ ‖r‖` as `λ_min = 1`.
#[test]
fn every_solver_solves() {
    let (first, second) = (truss([6, 4, 3], 40.0), truss([6, 4, 3], 90.0));
    let b = noise(72, 4);
    for entry in solvers::TABLE.entries {
        let mut solver = build(entry.name, Values::new(), &first.matrix, &first.places);
        for matrix in [&first.matrix, &second.matrix] {
            solver.update(matrix).unwrap();
            let mut x = vec![Vec3::ZERO; 72];
            let report = solver.solve(matrix, &b, &mut x).unwrap();
            assert!(report.relative_residual <= 1e-8);
            assert!(distance(&x, &dense_solve(matrix, &b)) < 1.01e-8 * norm(&b), "{}", entry.name);
        }
        assert!(solver.bytes() > 0);
    }
}

/// `auto` factors what is stiff and thin, and iterates on what is thick or held by its inertia; it changes its
/// mind with the matrix.
#[test]
fn auto_chooses_by_weight_and_work() {
    let places: Vec<Vec3> = (0..3000).map(|i| Vec3::X * f64::from(i)).collect();
    let (stiff, light) = (chain(3000, 1.0, 1e-3), chain(3000, 1.0, 1.0));
    let mut solver = build("auto", Values::new(), &stiff, &places);
    assert_eq!(solver.name(), "direct");
    // inertia 1 on a diagonal of 2 + 1
    solver.update(&light).unwrap();
    assert_eq!(solver.name(), "cg");
    let mut x = vec![Vec3::ZERO; 3000];
    assert!(solver.solve(&light, &noise(3000, 1), &mut x).unwrap().relative_residual <= 1e-8);
    solver.update(&stiff).unwrap();
    assert_eq!(solver.name(), "direct");
    let thick = truss([18, 18, 18], 1.0);
    assert_eq!(build("auto", Values::new(), &thick.matrix, &thick.places).name(), "cg");
}

/// What a solver has met before does not show in its answers: places followed while a factor served count for the
/// preconditioner made later.
#[test]
fn auto_forgets_what_it_met_before() {
    let truss = truss([40, 3, 3], 1e3);
    let count = truss.places.len();
    let mut light = truss.matrix.clone();
    light.add_scaled_diagonal(1e3, &vec![1.0; count]).unwrap();
    let moved: Vec<Vec3> = truss.places.iter().map(|p| *p + Vec3::Y * (0.01 * p.x * p.x)).collect();
    let values = || Values::new().with("preconditioner", Value::Text("rigid_modes"));
    let b = noise(count, 6);
    let solved = |matrices: &[&BlockMatrix]| {
        let mut solver = build("auto", values(), matrices[0], &truss.places);
        for matrix in matrices {
            solver.follow(&moved).unwrap();
            solver.update(matrix).unwrap();
        }
        let mut x = vec![Vec3::ZERO; count];
        solver.solve(&light, &b, &mut x).unwrap();
        (solver.name(), x)
    };
    assert_eq!(build("auto", values(), &truss.matrix, &truss.places).name(), "direct");
    assert_eq!(solved(&[&light]).0, "cg");
    assert!(solved(&[&truss.matrix, &light]) == solved(&[&light]));
}

#[test]
fn failures_are_typed() {
    let matrix = chain(40, 1.0, 0.0);
    let places = vec![Vec3::ZERO; 40];
    let values =
        Values::new().with("max_iterations", Value::Integer(2)).with("preconditioner", Value::Text("none"));
    let mut solver = build("cg", values, &matrix, &places);
    let mut x = vec![Vec3::ZERO; 40];
    let error = solver.solve(&matrix, &noise(40, 1), &mut x).unwrap_err();
    assert!(matches!(error, SolveError::NotConverged { method: "cg", iterations: 2, .. }));
    let error = solver.solve(&matrix, &noise(39, 1), &mut x).unwrap_err();
    assert_eq!(error, SolveError::Length { what: "the right-hand side", given: 39, expected: 40 });
    let error = solver.solve(&matrix, &[Vec3::X * f64::NAN; 40], &mut x).unwrap_err();
    assert_eq!(error, SolveError::NotFinite { what: "the right-hand side", block: 0 });
    assert_eq!(solvers::TABLE.find("cgg").unwrap_err().nearest.as_deref(), Some("cg"));
}
