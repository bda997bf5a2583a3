//! Iterations and milliseconds of each way to solve one implicit step of the reference bar.
//!
//! A bar of 1 × 0.1 × 0.1 m, clamped at `x = 0`, 10 n × n × n cells of six tetrahedra, E = 10 MPa, ν = 0.3,
//! ρ = 1000 kg/m³: `(M + h² K) x = h² f` with lumped mass, h = 10 ms, gravity, to a true relative residual of
//! 1e-6. `cargo run --release --example beam -- 6 12`.

use std::sync::Arc;
use std::time::Instant;

use souple_math::{Mat3, Vec3};
use souple_solve::krylov::{ConjugateGradientWorkspace, Settings, conjugate_gradient};
use souple_solve::precondition::{
    BlockJacobi, Geometry, IncompleteCholesky, LaggedFactor, RigidModes, RigidModesSettings, Smoother,
};
use souple_solve::solvers::direct_is_worth_it;
use souple_solve::{BlockMatrix, DirectSolver, LinearOperator, Pattern, Preconditioner, reduce};

struct Bar {
    coordinates: Vec<Vec3>,
    system: BlockMatrix,
    right_hand_side: Vec<Vec3>,
}

/// Six tetrahedra around the diagonal of a unit cell, as corners `x + 2 y + 4 z` (Kuhn 1960).
const KUHN: [[usize; 4]; 6] =
    [[0, 1, 3, 7], [0, 3, 2, 7], [0, 2, 6, 7], [0, 6, 4, 7], [0, 4, 5, 7], [0, 5, 1, 7]];

fn bar(n: usize) -> Bar {
    let (nx, ny, nz) = (10 * n, n, n);
    let node = |i: usize, j: usize, k: usize| (k * (ny + 1) + j) * (nx + 1) + i;
    let mut coordinates = vec![Vec3::ZERO; (nx + 1) * (ny + 1) * (nz + 1)];
    for (k, j, i) in triples(nz + 1, ny + 1, nx + 1) {
        coordinates[node(i, j, k)] = Vec3::new(i as f64, j as f64, k as f64) * (0.1 / n as f64);
    }
    let mut tets: Vec<[u32; 4]> = Vec::new();
    for (k, j, i) in triples(nz, ny, nx) {
        let corner = |c: usize| node(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2)) as u32;
        tets.extend(KUHN.map(|tet| tet.map(corner)));
    }
    let pattern =
        Pattern::from_cliques(coordinates.len(), tets.iter().map(|tet| &tet[..])).expect("corners exist");

    let (young, poisson, density, h) = (1e7, 0.3, 1000.0, 0.01);
    let (lambda, mu) =
        (young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson)), young / (2.0 * (1.0 + poisson)));
    let mut system = BlockMatrix::zeros(Arc::new(pattern));
    let mut masses = vec![0.0; coordinates.len()];
    for tet in &tets {
        let [p, q, r, s] = tet.map(|corner| coordinates[corner as usize]);
        let edges = Mat3::from_columns(q - p, r - p, s - p);
        let volume = edges.determinant() / 6.0;
        let inverse = edges.try_inverse().expect("cells are not flat");
        let others = [inverse.row(0), inverse.row(1), inverse.row(2)];
        let gradients = [-(others[0] + others[1] + others[2]), others[0], others[1], others[2]];
        for (&a, g) in tet.iter().zip(gradients) {
            masses[a as usize] += density * volume / 4.0;
            for (&b, d) in tet.iter().zip(gradients) {
                // K_ab = V (λ g dᵀ + μ d gᵀ + μ g·d I)
                let block = (g.outer(d) * lambda + d.outer(g) * mu).plus_diagonal(mu * g.dot(d));
                system.add(a as usize, b as usize, &(block * (volume * h * h))).expect("corners are coupled");
            }
        }
    }
    system.add_scaled_diagonal(1.0, &masses).expect("one mass per node");
    let clamped = |place: &Vec3| place.x == 0.0;
    let projector = |place: &Vec3| if clamped(place) { Mat3::ZERO } else { Mat3::IDENTITY };
    let projectors: Vec<Mat3> = coordinates.iter().map(projector).collect();
    system.constrain(&projectors, system.mean_diagonal()).expect("one projector per node");
    let load = |(mass, place)| if clamped(place) { Vec3::ZERO } else { Vec3::Y * (-9.81 * h * h * mass) };
    let right_hand_side = masses.iter().zip(&coordinates).map(load).collect();
    Bar { coordinates, system, right_hand_side }
}

fn triples(a: usize, b: usize, c: usize) -> impl Iterator<Item = (usize, usize, usize)> {
    (0..a * b * c).map(move |index| (index / c / b, index / c % b, index % c))
}

/// Milliseconds of the fastest of several runs of `work`.
fn milliseconds(runs: usize, mut work: impl FnMut()) -> f64 {
    let once = |_| {
        let start = Instant::now();
        work();
        start.elapsed().as_secs_f64() * 1e3
    };
    (0..runs).map(once).fold(f64::INFINITY, f64::min)
}

fn main() {
    let given: Vec<usize> = std::env::args().skip(1).filter_map(|text| text.parse().ok()).collect();
    for n in if given.is_empty() { vec![3, 6] } else { given } {
        report(n);
    }
}

fn report(n: usize) {
    let bar = bar(n);
    let count = bar.coordinates.len();
    println!("n = {n}: {count} points, {} blocks", bar.system.pattern().slot_count());
    let mut y = vec![Vec3::ZERO; count];
    let product = milliseconds(20, || bar.system.apply(&bar.right_hand_side, &mut y));
    println!("  product {product:.3} ms");

    let mut jacobi = BlockJacobi::new(&bar.system).expect("positive definite");
    iterate(&bar, "block_jacobi", &mut jacobi);
    let mut incomplete = IncompleteCholesky::new(&bar.system).expect("positive definite");
    iterate(&bar, "incomplete_cholesky", &mut incomplete);
    println!("    shift {}", incomplete.shift());
    for smoother in [Smoother::BlockJacobi, Smoother::IncompleteCholesky] {
        let settings = RigidModesSettings { smoother, patch_size: None };
        let geometry = Geometry::points(&bar.coordinates);
        let mut modes = RigidModes::new(&bar.system, geometry, settings).expect("positive definite");
        iterate(&bar, &format!("rigid_modes, {smoother:?}"), &mut modes);
    }
    let mut lagged = LaggedFactor::new(&bar.system, Some(&bar.coordinates), 1000).expect("positive definite");
    iterate(&bar, "lagged_factor, same matrix", &mut lagged);
    direct(&bar);
}

fn iterate(bar: &Bar, name: &str, preconditioner: &mut dyn Preconditioner) {
    let count = bar.coordinates.len();
    let settings = Settings { tolerance: 1e-6, max_iterations: 10_000 };
    let mut workspace = ConjugateGradientWorkspace::new(count);
    let mut x = vec![Vec3::ZERO; count];
    let update = milliseconds(5, || preconditioner.update(&bar.system).expect("positive definite"));
    let mut z = vec![Vec3::ZERO; count];
    let apply = milliseconds(10, || preconditioner.apply(&bar.right_hand_side, &mut z));
    let mut iterations = 0;
    let solve = milliseconds(3, || {
        x.fill(Vec3::ZERO);
        let b = &bar.right_hand_side;
        let report = conjugate_gradient(&bar.system, &*preconditioner, b, &mut x, &settings, &mut workspace);
        assert!(report.converged(), "{name}: {report:?}");
        iterations = report.iterations;
    });
    println!(
        "  {name:34} update {update:8.2}  apply {apply:7.3}  solve {solve:8.2}  total {:8.2} ms, {iterations} iterations",
        update + solve
    );
}

fn direct(bar: &Bar) {
    let start = Instant::now();
    let mut solver =
        DirectSolver::analyse(bar.system.pattern(), Some(&bar.coordinates)).expect("coordinates fit");
    let analysis = start.elapsed().as_secs_f64() * 1e3;
    let factor = milliseconds(3, || solver.factorize(&bar.system).expect("positive definite"));
    let mut x = bar.right_hand_side.clone();
    let solve = milliseconds(3, || {
        x.copy_from_slice(&bar.right_hand_side);
        solver.solve(&mut x).expect("factorised");
    });
    let mut r = vec![Vec3::ZERO; x.len()];
    let residual =
        bar.system.residual(&bar.right_hand_side, &x, &mut r).sqrt() / reduce::norm(&bar.right_hand_side);
    println!(
        "  direct: analyse {analysis:.1}  factor {factor:.2}  solve {solve:.2} ms, \
         {} nonzeros, residual {residual:.1e}",
        solver.factor_nonzeros()
    );
    let direct = direct_is_worth_it(bar.system.pattern(), Some(&bar.coordinates)).expect("coordinates fit");
    println!("  auto takes {}", if direct { "direct" } else { "cg with rigid_modes" });
}
