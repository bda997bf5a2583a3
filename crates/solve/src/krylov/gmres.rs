//! Restarted generalised minimal residuals for non-symmetric operators.
//!
//! Saad & Schultz 1986, preconditioned from the right so that its residual is the true one; Arnoldi with
//! modified Gram–Schmidt, done twice where cancellation asks for it.

use souple_math::Vec3;

use super::{Report, Settings, Stop};
use crate::{LinearOperator, Preconditioner, reduce};

/// Basis and small triangular system of one solve.
#[derive(Clone, Debug)]
pub struct GmresWorkspace {
    restart: usize,
    /// Orthonormal basis of the Krylov space, `restart + 1` vectors.
    basis: Vec<Vec<Vec3>>,
    preconditioned: Vec<Vec3>,
    /// Column `j` of the triangular factor is `triangle[j]`.
    triangle: Vec<Vec<f64>>,
    rotations: Vec<(f64, f64)>,
    right_hand_side: Vec<f64>,
}

impl GmresWorkspace {
    /// `restart`: directions kept before starting over, at least one.
    pub fn new(block_count: usize, restart: usize) -> Self {
        let restart = restart.max(1);
        Self {
            restart,
            basis: vec![vec![Vec3::ZERO; block_count]; restart + 1],
            preconditioned: vec![Vec3::ZERO; block_count],
            triangle: (0..restart).map(|column| vec![0.0; column + 2]).collect(),
            rotations: vec![(1.0, 0.0); restart],
            right_hand_side: vec![0.0; restart + 1],
        }
    }

    /// Vectors held.
    pub fn vector_count(&self) -> usize {
        self.basis.len() + 1
    }

    fn resize(&mut self, block_count: usize) {
        for vector in self.basis.iter_mut().chain(std::iter::once(&mut self.preconditioned)) {
            vector.resize(block_count, Vec3::ZERO);
        }
    }
}

/// Solves `A x = b`, starting from the `x` given. The residual never grows, so `x` is the best iterate.
pub fn gmres(
    operator: &(impl LinearOperator + ?Sized),
    preconditioner: &(impl Preconditioner + ?Sized),
    b: &[Vec3],
    x: &mut [Vec3],
    settings: &Settings,
    workspace: &mut GmresWorkspace,
) -> Report {
    workspace.resize(operator.block_count());
    let b_norm = reduce::norm(b);
    if b_norm == 0.0 {
        x.fill(Vec3::ZERO);
        return Report { iterations: 0, relative_residual: 0.0, stop: Stop::Converged };
    }
    let target = settings.tolerance * b_norm;
    let mut iterations = 0;
    let mut last_norm = f64::INFINITY;
    loop {
        let residual_norm = operator.residual(b, x, &mut workspace.basis[0]).sqrt();
        let stop = if !residual_norm.is_finite() {
            Some(Stop::NotFinite)
        } else if residual_norm <= target {
            Some(Stop::Converged)
        } else if iterations == settings.max_iterations {
            Some(Stop::IterationLimit)
        } else if residual_norm > (1.0 - 1e-6) * last_norm {
            // a whole cycle without progress: the next would repeat it
            Some(Stop::Stagnated)
        } else {
            None
        };
        if let Some(stop) = stop {
            return Report { iterations, relative_residual: residual_norm / b_norm, stop };
        }
        last_norm = residual_norm;
        cycle(operator, preconditioner, x, residual_norm, target, settings, workspace, &mut iterations);
    }
}

/// One cycle of at most `restart` directions; `basis[0]` is the residual on entry.
#[expect(clippy::too_many_arguments, reason = "the state of one solve, passed to its only helper")]
fn cycle(
    operator: &(impl LinearOperator + ?Sized),
    preconditioner: &(impl Preconditioner + ?Sized),
    x: &mut [Vec3],
    residual_norm: f64,
    target: f64,
    settings: &Settings,
    workspace: &mut GmresWorkspace,
    iterations: &mut usize,
) {
    let GmresWorkspace { restart, basis, preconditioned, triangle, rotations, right_hand_side: g } =
        workspace;
    scale(&mut basis[0], 1.0 / residual_norm);
    g.fill(0.0);
    g[0] = residual_norm;
    let mut used = 0;
    while used < *restart && *iterations < settings.max_iterations {
        let (known, unknown) = basis.split_at_mut(used + 1);
        let w = &mut unknown[0];
        // w = A M⁻¹ vⱼ
        preconditioner.apply(&known[used], preconditioned);
        operator.apply(preconditioned, w);
        *iterations += 1;

        // hᵢ = vᵢ·w, w −= hᵢ vᵢ, twice if most of w went away
        let column = &mut triangle[used];
        column.fill(0.0);
        let before = reduce::norm(w);
        let mut after = before;
        for _ in 0..2 {
            for (h, v) in column.iter_mut().zip(known.iter()) {
                let projection = reduce::dot(v, w);
                *h += projection;
                reduce::add_scaled(w, -projection, v);
            }
            after = reduce::norm(w);
            if after > 0.5 * before {
                break;
            }
        }
        if !after.is_finite() {
            break;
        }
        column[used + 1] = after;

        // Givens rotations keep the Hessenberg matrix triangular
        for (row, &(c, s)) in rotations[..used].iter().enumerate() {
            (column[row], column[row + 1]) =
                (c * column[row] + s * column[row + 1], c * column[row + 1] - s * column[row]);
        }
        let length = libm::hypot(column[used], column[used + 1]);
        if length == 0.0 {
            // A M⁻¹ vⱼ vanished: a singular operator adds nothing in this direction
            break;
        }
        let (c, s) = (column[used] / length, column[used + 1] / length);
        rotations[used] = (c, s);
        (column[used], column[used + 1]) = (length, 0.0);
        (g[used], g[used + 1]) = (c * g[used], -s * g[used]);
        used += 1;
        if g[used].abs() <= target || after <= f64::EPSILON * before {
            break;
        }
        scale(w, 1.0 / after);
    }

    // y = R⁻¹ g, x += M⁻¹ V y
    for row in (0..used).rev() {
        let known: f64 = (row + 1..used).map(|column| triangle[column][row] * g[column]).sum();
        g[row] = (g[row] - known) / triangle[row][row];
    }
    let Some((combination, others)) = basis[..used.max(1)].split_first_mut() else { return };
    scale(combination, g[0] * f64::from(u8::from(used > 0)));
    for (weight, v) in g[1..].iter().zip(others) {
        reduce::add_scaled(combination, *weight, v);
    }
    preconditioner.apply(combination, preconditioned);
    reduce::add_scaled(x, 1.0, preconditioned);
}

fn scale(y: &mut [Vec3], s: f64) {
    reduce::for_each_chunk(y, &|_, y: &mut [Vec3]| {
        for y in y {
            *y = *y * s;
        }
    });
}
