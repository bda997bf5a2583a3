//! Iterative methods and preconditioners against dense answers and their defining properties.
#![allow(non_snake_case, reason = "symbols of the mathematics")]

use souple_math::{Mat3, Vec3};
use souple_solve::krylov::{
    BicgstabWorkspace, ConjugateGradientWorkspace, GmresWorkspace, Report, Settings, Stop, bicgstab,
    conjugate_gradient, gmres,
};
use souple_solve::precondition::{
    self, BlockJacobi, BlockRole, Geometry, Identity, IncompleteCholesky, LaggedFactor, RigidModes,
    RigidModesSettings, Smoother,
};
use souple_solve::{BlockMatrix, LinearOperator, Pattern, Preconditioner, SolveError, reduce};
use souple_table::Values;

use crate::common::{chain, dense_solve, distance, noise, norm, on_threads, truss};

fn every_preconditioner(
    matrix: &BlockMatrix,
    places: &[Vec3],
) -> Vec<(&'static str, Box<dyn Preconditioner>)> {
    let build = |entry: &souple_table::Entry<precondition::Build>| {
        let values = entry.values(Values::new()).unwrap();
        (entry.name, (entry.build)(&values, matrix, Geometry::points(places)).unwrap())
    };
    precondition::TABLE.entries.iter().map(|entry| build(entry)).collect()
}

fn cg(
    matrix: &BlockMatrix,
    preconditioner: &dyn Preconditioner,
    b: &[Vec3],
    x: &mut [Vec3],
    tolerance: f64,
) -> Report {
    let settings = Settings { tolerance, max_iterations: 2000 };
    conjugate_gradient(matrix, preconditioner, b, x, &settings, &mut ConjugateGradientWorkspace::default())
}

/// A start near the solution saves iterations; one that is worse than zero costs none.
#[test]
fn good_starts_are_taken_and_bad_ones_left() {
    let truss = truss([8, 4, 3], 200.0);
    let b = noise(truss.places.len(), 5);
    let expected = dense_solve(&truss.matrix, &b);
    let jacobi = BlockJacobi::new(&truss.matrix).unwrap();
    let from = |start: Vec<Vec3>| {
        let mut x = start;
        let report = cg(&truss.matrix, &jacobi, &b, &mut x, 1e-9);
        assert!(report.converged() && distance(&x, &expected) < 1.01e-9 * norm(&b));
        report.iterations
    };
    let zero = from(vec![Vec3::ZERO; b.len()]);
    let near = from(expected.iter().zip(noise(b.len(), 7)).map(|(x, noise)| *x + noise * 1e-5).collect());
    let far = from(expected.iter().map(|x| *x * -3.0).collect());
    assert!(near < zero, "{near} of {zero}");
    assert_eq!(far, zero);
}

/// Several threads ask one preconditioner at once, each of which shares out the work of its own application: none waits for itself, and the bits
/// are those of one after another.
#[test]
fn preconditioners_serve_several_at_once() {
    use rayon::prelude::*;
    let truss = truss([48, 6, 6], 300.0);
    let count = truss.places.len();
    let loads: Vec<Vec<Vec3>> = (0..8).map(|number| noise(count, number)).collect();
    for (name, preconditioner) in every_preconditioner(&truss.matrix, &truss.places) {
        let answer = |load: &Vec<Vec3>| {
            let mut z = vec![Vec3::ZERO; count];
            preconditioner.apply(load, &mut z);
            z
        };
        let expected: Vec<Vec<Vec3>> = loads.iter().map(answer).collect();
        // again and again: what waits for itself does so where work happens to be handed on
        on_threads(4, || {
            for _ in 0..200 {
                let at_once: Vec<Vec<Vec3>> = loads.par_iter().map(answer).collect();
                assert_eq!(at_once, expected, "{name}");
            }
        });
    }
}

/// `‖x − x*‖ ≤ ‖r‖ / λ_min`, and `λ_min = 1`; the residual reported is the true one.
#[test]
fn conjugate_gradients_with_every_preconditioner() {
    let mut truss = truss([8, 4, 3], 200.0);
    let mut projectors = vec![Mat3::IDENTITY; truss.places.len()];
    projectors[..12].fill(Mat3::ZERO);
    projectors[40] = Mat3::from_diagonal(Vec3::new(1.0, 0.0, 1.0));
    truss.matrix.constrain(&projectors, truss.matrix.mean_diagonal()).unwrap();
    let b = noise(truss.places.len(), 5);
    let expected = dense_solve(&truss.matrix, &b);
    for (name, preconditioner) in every_preconditioner(&truss.matrix, &truss.places) {
        let mut x = noise(truss.places.len(), 9);
        let report = cg(&truss.matrix, &*preconditioner, &b, &mut x, 1e-9);
        assert!(report.converged(), "{name}: {report:?}");
        assert!(distance(&x, &expected) < 1.01e-9 * norm(&b), "{name}");
        let mut r = vec![Vec3::ZERO; x.len()];
        let residual = truss.matrix.residual(&b, &x, &mut r).sqrt() / norm(&b);
        assert!((residual - report.relative_residual).abs() < 1e-3 * residual, "{name}");
        // a solution needs no iteration
        assert_eq!(cg(&truss.matrix, &*preconditioner, &b, &mut x, 1e-8).iterations, 0, "{name}");
    }
}

/// `u · M⁻¹ v = v · M⁻¹ u` and `u · M⁻¹ u > 0`, to rounding.
#[test]
fn preconditioners_are_symmetric_and_positive() {
    let truss = truss([7, 5, 3], 30.0);
    let count = truss.places.len();
    for (name, preconditioner) in every_preconditioner(&truss.matrix, &truss.places) {
        for seed in 0..5 {
            let (u, v) = (noise(count, seed), noise(count, seed + 10));
            let (mut Mu, mut Mv) = (u.clone(), v.clone());
            let uMu = preconditioner.apply_dot(&u, &mut Mu);
            let vMv = preconditioner.apply_dot(&v, &mut Mv);
            assert!(uMu > 0.0 && vMv > 0.0, "{name}");
            let difference = reduce::dot(&u, &Mv) - reduce::dot(&v, &Mu);
            assert!(difference.abs() < 1e-12 * (uMu * vMv).sqrt(), "{name}: {difference:e}");
        }
    }
}

/// Updated with new values, a preconditioner is the one built afresh, bit for bit.
#[test]
fn rebuilt_equals_built() {
    let (first, second) = (truss([6, 4, 3], 30.0), truss([6, 4, 3], 500.0));
    let r = noise(72, 1);
    let updated = every_preconditioner(&first.matrix, &first.places);
    let built = every_preconditioner(&second.matrix, &second.places);
    for ((name, mut updated), (_, built)) in updated.into_iter().zip(built) {
        updated.rebuild(&second.matrix).unwrap();
        let (mut z, mut expected) = (r.clone(), r.clone());
        updated.apply(&r, &mut z);
        built.apply(&r, &mut expected);
        assert_eq!(z, expected, "{name}");
    }
}

/// Without fill there is nothing incomplete: on a chain the factors are exact to single precision.
#[test]
fn incomplete_cholesky_of_a_chain_is_complete() {
    let matrix = chain(50, 1.0, 0.5);
    let factor = IncompleteCholesky::new(&matrix).unwrap();
    let x = noise(50, 2);
    let mut b = x.clone();
    matrix.apply(&x, &mut b);
    let mut z = b.clone();
    factor.apply(&b, &mut z);
    assert_eq!(factor.shift(), 0.0);
    // κ ≤ 9 for this chain
    assert!(distance(&z, &x) < 9.0 * f64::from(f32::EPSILON) * norm(&x));
}

/// The order changes which factor is made, not what it is: on a chain eliminated from both ends nothing fills in,
/// so the factors are exact again; an order that is none is refused.
#[test]
fn incomplete_cholesky_in_a_given_order() {
    let matrix = chain(50, 1.0, 0.5);
    let order: Vec<u32> = (0..25).flat_map(|i| [i, 49 - i]).collect();
    let factor = IncompleteCholesky::with_order(&matrix, order.clone()).unwrap();
    let x = noise(50, 2);
    let mut b = x.clone();
    matrix.apply(&x, &mut b);
    let mut z = b.clone();
    factor.apply(&b, &mut z);
    assert!(distance(&z, &x) < 9.0 * f64::from(f32::EPSILON) * norm(&x));
    let mut twice = order;
    twice[3] = twice[7];
    let error = IncompleteCholesky::with_order(&matrix, twice).unwrap_err();
    assert!(matches!(error, SolveError::NoPermutation { block_count: 50, .. }));
}

/// From both ends as from one: exact on a chain, about as few iterations on a truss, the same bits for any number of
/// threads.
#[test]
fn incomplete_cholesky_from_both_ends() {
    let matrix = chain(1500, 1.0, 0.5);
    let x = noise(1500, 2);
    let mut b = x.clone();
    matrix.apply(&x, &mut b);
    let mut z = b.clone();
    IncompleteCholesky::new(&matrix).unwrap().apply(&b, &mut z);
    assert!(distance(&z, &x) < 9.0 * f64::from(f32::EPSILON) * norm(&x));

    let truss = truss([40, 6, 6], 300.0);
    let count = truss.places.len();
    let b = noise(count, 3);
    let solved = |factor: &IncompleteCholesky| {
        let mut x = vec![Vec3::ZERO; count];
        let report = cg(&truss.matrix, factor, &b, &mut x, 1e-8);
        assert!(report.converged() && factor.shift() == 0.0);
        (x, report.iterations)
    };
    let from_both = || solved(&IncompleteCholesky::with_coordinates(&truss.matrix, &truss.places).unwrap());
    let natural = (0..count as u32).collect();
    let (_, from_one) = solved(&IncompleteCholesky::with_order(&truss.matrix, natural).unwrap());
    let one = on_threads(1, from_both);
    assert!(one.1.abs_diff(from_one) <= 1 + from_one / 10, "{} against {from_one}", one.1);
    assert!(one == on_threads(2, from_both) && one == on_threads(5, from_both));
}

/// A numbering that jumps about in the body is replaced by a sweep: as few iterations as with a local one.
#[test]
fn shuffled_numbering_costs_no_iterations() {
    let truss = truss([60, 3, 3], 1e5);
    let count = truss.places.len();
    // 337 has no factor in common with 540
    let renumber = |i: usize| i * 337 % count;
    let pattern = truss.matrix.pattern();
    let links: Vec<[u32; 2]> = (0..count)
        .flat_map(|row| {
            pattern.row(row).iter().map(move |&c| [renumber(row) as u32, renumber(c as usize) as u32])
        })
        .collect();
    let shuffled = Pattern::from_cliques(count, links.iter().map(|link| &link[..])).unwrap();
    let mut matrix = BlockMatrix::zeros(std::sync::Arc::new(shuffled));
    let mut places = vec![Vec3::ZERO; count];
    for row in 0..count {
        places[renumber(row)] = truss.places[row];
        for slot in pattern.slots(row) {
            let column = pattern.columns()[slot] as usize;
            matrix.add(renumber(row), renumber(column), &truss.matrix.values()[slot]).unwrap();
        }
    }
    let b = vec![Vec3::Y; count];
    let iterations = |matrix: &BlockMatrix, places: &[Vec3]| {
        let settings = RigidModesSettings { patch_size: Some(27), ..RigidModesSettings::default() };
        let modes = RigidModes::new(matrix, Geometry::points(places), settings).unwrap();
        let mut b = b.clone();
        b[renumber(7)] = Vec3::X;
        let mut x = vec![Vec3::ZERO; count];
        let report = cg(matrix, &modes, &b, &mut x, 1e-8);
        assert!(report.converged());
        report.iterations
    };
    assert!(iterations(&matrix, &places).abs_diff(iterations(&truss.matrix, &truss.places)) <= 3);
}

/// Kershaw's matrix is positive definite, yet its incomplete factor has a negative pivot.
#[test]
fn incomplete_cholesky_survives_breakdown() {
    let links: [&[u32]; 4] = [&[0, 1], &[1, 2], &[2, 3], &[0, 3]];
    let mut matrix = BlockMatrix::zeros(std::sync::Arc::new(Pattern::from_cliques(4, links).unwrap()));
    for (row, column, entry) in [(0, 1, -2.0), (1, 2, -2.0), (2, 3, -2.0), (0, 3, 2.0)] {
        matrix.add(row, column, &(Mat3::IDENTITY * entry)).unwrap();
        matrix.add(column, row, &(Mat3::IDENTITY * entry)).unwrap();
    }
    matrix.add_scaled_diagonal(3.0, &[1.0; 4]).unwrap();
    let factor = IncompleteCholesky::new(&matrix).unwrap();
    assert!(factor.shift() > 0.0);
    let b = noise(4, 1);
    let mut x = vec![Vec3::ZERO; 4];
    let report = cg(&matrix, &factor, &b, &mut x, 1e-10);
    assert!(report.converged() && report.iterations <= 12);
    assert!(distance(&x, &dense_solve(&matrix, &b)) < 1e-8);
}

/// Balancing is exact on the coarse space: `M⁻¹ A Z = Z`. Here `Z` holds whole-body rigid motions, for a body
/// with a pinned face, a sliding point, and patches of one line of points.
#[test]
fn rigid_modes_invert_rigid_motions_exactly() {
    for shape in [[8, 4, 3], [40, 1, 1], [6, 6, 1], [1, 1, 1]] {
        let mut truss = truss(shape, 200.0);
        let count = truss.places.len();
        let normal = Vec3::new(1.0, 2.0, -2.0) / 3.0;
        let mut projectors = vec![Mat3::IDENTITY; count];
        if count > 20 {
            projectors[0] = Mat3::ZERO;
            projectors[17] = Mat3::IDENTITY - normal.outer(normal);
            truss.matrix.constrain(&projectors, 31.0).unwrap();
        }
        for smoother in [Smoother::BlockJacobi, Smoother::IncompleteCholesky] {
            let settings = RigidModesSettings { smoother, patch_size: Some(10) };
            let modes = RigidModes::new(&truss.matrix, Geometry::points(&truss.places), settings).unwrap();
            for (t, w) in
                Vec3::AXES.map(|axis| (axis, Vec3::ZERO)).into_iter().chain(Vec3::AXES.map(|w| (w, w)))
            {
                let motion = |(place, S): (&Vec3, &Mat3)| *S * (t + w.cross(*place));
                let motion: Vec<Vec3> = truss.places.iter().zip(&projectors).map(motion).collect();
                let (mut force, mut z) = (motion.clone(), motion.clone());
                truss.matrix.apply(&motion, &mut force);
                modes.apply(&force, &mut z);
                let error = distance(&z, &motion) / norm(&motion);
                assert!(error < 1e-10, "{shape:?} {smoother:?}: {error:e} for {t:?} {w:?}");
            }
        }
    }
}

/// A rigid frame's blocks move with `t + ω × x` and `ω`: roles make their motion part of the coarse space.
#[test]
fn rigid_modes_know_frames() {
    // block 0: origin of a frame, block 1: its rotation, blocks 2..6: points held by springs to the frame
    let origin = Vec3::new(1.0, 0.0, 0.5);
    let mut places = vec![origin, origin];
    places.extend([Vec3::X, Vec3::Y, Vec3::Z, Vec3::new(1.0, 1.0, 1.0)]);
    let everything: [&[u32]; 1] = [&[0, 1, 2, 3, 4, 5]];
    let mut matrix = BlockMatrix::zeros(std::sync::Arc::new(Pattern::from_cliques(6, everything).unwrap()));
    for point in 2..6 {
        let arm = places[point] - origin;
        // energy 50 |u_p − u_o − ω × arm|²
        let gradients = [(0, -Mat3::IDENTITY), (1, arm.cross_matrix()), (point, Mat3::IDENTITY)];
        for (a, G) in gradients {
            for (b, H) in gradients {
                matrix.add(a, b, &(G.transpose() * H * 100.0)).unwrap();
            }
        }
    }
    matrix.add_scaled_diagonal(1.0, &[1.0; 6]).unwrap();
    let mut roles = [BlockRole::Point; 6];
    roles[1] = BlockRole::Rotation;
    let geometry = Geometry { coordinates: Some(&places), roles: Some(&roles) };
    let settings = RigidModesSettings { smoother: Smoother::BlockJacobi, patch_size: Some(6) };
    let modes = RigidModes::new(&matrix, geometry, settings).unwrap();
    let (t, w) = (Vec3::new(0.3, -1.0, 0.2), Vec3::new(0.5, 0.7, -0.4));
    let mut motion: Vec<Vec3> = places.iter().map(|place| t + w.cross(*place)).collect();
    motion[1] = w;
    let (mut force, mut z) = (motion.clone(), motion.clone());
    matrix.apply(&motion, &mut force);
    modes.apply(&force, &mut z);
    assert!(distance(&z, &motion) < 1e-12 * norm(&motion));
}

/// Iterations hardly grow with the length of a bar, where those of one level grow in proportion.
#[test]
fn rigid_modes_do_not_mind_length() {
    let iterations = |length: usize, two_levels: bool| {
        let mut truss = truss([length, 3, 3], 1e6);
        let mut projectors = vec![Mat3::IDENTITY; truss.places.len()];
        projectors[..9].fill(Mat3::ZERO);
        truss.matrix.constrain(&projectors, truss.matrix.mean_diagonal()).unwrap();
        let b: Vec<Vec3> =
            truss.places.iter().map(|p| if p.x > 0.0 { Vec3::Y } else { Vec3::ZERO }).collect();
        let preconditioner: Box<dyn Preconditioner> = if two_levels {
            let settings = RigidModesSettings { patch_size: Some(36), ..RigidModesSettings::default() };
            Box::new(RigidModes::new(&truss.matrix, Geometry::points(&truss.places), settings).unwrap())
        } else {
            Box::new(IncompleteCholesky::new(&truss.matrix).unwrap())
        };
        let mut x = vec![Vec3::ZERO; b.len()];
        let report = cg(&truss.matrix, &*preconditioner, &b, &mut x, 1e-8);
        assert!(report.converged(), "{report:?}");
        report.iterations
    };
    assert!(iterations(80, false) > 3 * iterations(80, true));
    assert!(iterations(160, true) <= iterations(40, true) + 10);
}

/// A direction of negative curvature is returned as such, and `x` is no worse than the start.
#[test]
fn indefinite_matrices_are_reported() {
    let matrix = chain(30, 1.0, -0.5);
    let b = noise(30, 4);
    let settings = Settings { tolerance: 1e-10, max_iterations: 500 };
    let mut workspace = ConjugateGradientWorkspace::new(30);
    let mut x = vec![Vec3::ZERO; 30];
    let report = conjugate_gradient(&matrix, &Identity, &b, &mut x, &settings, &mut workspace);
    let Stop::Indefinite { curvature } = report.stop else { panic!("{report:?}") };
    let p = workspace.direction().to_vec();
    let mut Ap = p.clone();
    let pAp = matrix.apply_dot(&p, &mut Ap);
    assert!(pAp < 0.0 && (curvature - pAp / reduce::dot(&p, &p)).abs() < 1e-12);
    let mut Ax = x.clone();
    let energy = 0.5 * matrix.apply_dot(&x, &mut Ax) - reduce::dot(&b, &x);
    assert!(energy <= 0.0);
    let error = report.checked("cg", &settings).unwrap_err();
    assert!(matches!(error, SolveError::NotConverged { stop: Stop::Indefinite { .. }, .. }));

    let negative = chain(3, -1.0, -1.0);
    assert!(matches!(BlockJacobi::new(&negative), Err(SolveError::NotPositiveDefinite { block: 0, .. })));
    assert!(matches!(IncompleteCholesky::new(&negative), Err(SolveError::NotPositiveDefinite { .. })));
}

/// Numbers that are not finite, spent iterations and an empty right-hand side each end in their own way.
#[test]
fn every_ending_is_told() {
    let matrix = chain(200, 1.0, 0.0);
    let b = noise(200, 4);
    let mut workspace = ConjugateGradientWorkspace::new(200);
    let few = Settings { tolerance: 1e-10, max_iterations: 3 };
    let mut x = vec![Vec3::ZERO; 200];
    let report = conjugate_gradient(&matrix, &Identity, &b, &mut x, &few, &mut workspace);
    assert_eq!((report.stop, report.iterations), (Stop::IterationLimit, 3));
    let impossible = Settings { tolerance: 1e-18, max_iterations: 10_000 };
    let report = conjugate_gradient(&matrix, &Identity, &b, &mut x, &impossible, &mut workspace);
    assert_eq!(report.stop, Stop::Stagnated);
    assert!(report.relative_residual < 1e-12);
    let report = conjugate_gradient(&matrix, &Identity, &[Vec3::ZERO; 200], &mut x, &few, &mut workspace);
    assert_eq!((report.stop, x), (Stop::Converged, vec![Vec3::ZERO; 200]));
    let mut x = vec![Vec3::X * f64::NAN; 200];
    let report = conjugate_gradient(&matrix, &Identity, &b, &mut x, &few, &mut workspace);
    assert_eq!(report.stop, Stop::NotFinite);
}

/// Convection makes a chain non-symmetric; both general methods agree with elimination: `‖x − x*‖ ≤ ‖r‖ / 0.5`,
/// the symmetric part being at least 0.5.
#[test]
fn general_methods_solve_what_is_not_symmetric() {
    let mut matrix = truss([6, 4, 3], 20.0).matrix;
    for row in 0..72 {
        for slot in matrix.pattern().clone().slots(row) {
            let column = matrix.pattern().columns()[slot] as usize;
            let sign = (column as f64 - row as f64).signum() * f64::from(u8::from(column != row));
            let turn = Vec3::new(1.0, -0.5, 2.0).cross_matrix();
            matrix.values_mut()[slot] +=
                Mat3::IDENTITY * (3.0 * sign) + turn * f64::from(u8::from(column == row));
        }
    }
    let b = noise(72, 6);
    let expected = dense_solve(&matrix, &b);
    let settings = Settings { tolerance: 1e-10, max_iterations: 2000 };
    let jacobi = BlockJacobi::new(&truss([6, 4, 3], 20.0).matrix).unwrap();
    for restart in [5, 30, 100] {
        let mut x = noise(72, 7);
        let report = gmres(&matrix, &jacobi, &b, &mut x, &settings, &mut GmresWorkspace::new(72, restart));
        assert!(report.converged(), "{report:?}");
        assert!(distance(&x, &expected) < 2e-10 * norm(&b));
    }
    let mut x = noise(72, 7);
    let report = bicgstab(&matrix, &jacobi, &b, &mut x, &settings, &mut BicgstabWorkspace::new(72));
    assert!(report.converged(), "{report:?}");
    assert!(distance(&x, &expected) < 2e-10 * norm(&b));

    // a singular system that has no solution ends, and says so
    let mut singular = chain(4, 0.0, 1.0);
    singular.values_mut()[0] = Mat3::ZERO;
    let b = vec![Vec3::X; 4];
    let mut x = vec![Vec3::ZERO; 4];
    let report = gmres(&singular, &Identity, &b, &mut x, &settings, &mut GmresWorkspace::new(4, 10));
    assert_eq!(report.stop, Stop::Stagnated);
    let mut x = vec![Vec3::ZERO; 4];
    let report = bicgstab(&singular, &Identity, &b, &mut x, &settings, &mut BicgstabWorkspace::new(4));
    assert!(!report.converged() && x.iter().all(|entry| entry.is_finite()));
}

/// An old factor still serves; it is renewed when its period is over.
#[test]
fn lagged_factor_is_renewed_in_time() {
    let (old, new) = (truss([6, 4, 3], 100.0), truss([6, 4, 3], 130.0));
    let b = noise(72, 3);
    let mut lagged = LaggedFactor::new(&old.matrix, Some(&old.places), 3).unwrap();
    let mut counts = Vec::new();
    for _ in 0..3 {
        lagged.update(&new.matrix).unwrap();
        let mut x = vec![Vec3::ZERO; 72];
        counts.push(cg(&new.matrix, &lagged, &b, &mut x, 1e-8).iterations);
    }
    assert!(counts[0] > 1 && counts[0] <= 12 && counts[2] == 1, "{counts:?}");
    assert_eq!(lagged.age(), 0);
}

/// The whole solve has the same bits for any number of threads.
#[test]
fn same_bits_for_any_thread_count() {
    let truss = truss([40, 16, 16], 1e4);
    let b = noise(truss.places.len(), 3);
    for smoother in [Smoother::BlockJacobi, Smoother::IncompleteCholesky] {
        let solve = || {
            let settings = RigidModesSettings { smoother, patch_size: None };
            let modes = RigidModes::new(&truss.matrix, Geometry::points(&truss.places), settings).unwrap();
            let mut x = vec![Vec3::ZERO; b.len()];
            let report = cg(&truss.matrix, &modes, &b, &mut x, 1e-6);
            (x, report.iterations)
        };
        let one = on_threads(1, solve);
        assert_eq!(one, on_threads(2, solve));
        assert_eq!(one, on_threads(5, solve));
    }
}
