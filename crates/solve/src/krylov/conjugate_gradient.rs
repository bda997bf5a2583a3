//! Preconditioned conjugate gradients.
//!
//! Hestenes & Stiefel 1952; for symmetric positive definite operators and preconditioners. Vector updates
//! are fused, so an iteration passes over memory as seldom as it can.

use souple_math::Vec3;

use super::{Report, Settings, Stop};
use crate::{LinearOperator, Preconditioner, reduce};

/// How often the recurrence may restart from the true residual before rounding is blamed.
const RESTARTS: usize = 8;

/// Vectors that one solve needs; keep it between solves and nothing is allocated.
#[derive(Clone, Debug, Default)]
pub struct ConjugateGradientWorkspace {
    residual: Vec<Vec3>,
    preconditioned: Vec<Vec3>,
    direction: Vec<Vec3>,
    product: Vec<Vec3>,
}

impl ConjugateGradientWorkspace {
    pub fn new(block_count: usize) -> Self {
        let mut workspace = Self::default();
        workspace.resize(block_count);
        workspace
    }

    fn resize(&mut self, block_count: usize) {
        for vector in [&mut self.residual, &mut self.preconditioned, &mut self.direction, &mut self.product] {
            vector.resize(block_count, Vec3::ZERO);
        }
    }

    /// The last search direction: after [`Stop::Indefinite`], one of negative or zero curvature.
    pub fn direction(&self) -> &[Vec3] {
        &self.direction
    }

    /// `b − A x` of the `x` returned.
    pub fn residual(&self) -> &[Vec3] {
        &self.residual
    }
}

/// Solves `A x = b`, starting from the `x` given, or from zero where that is nearer by the residual.
///
/// On [`Stop::Indefinite`] and on [`Stop::IterationLimit`] `x` is the best iterate so far: each one
/// minimises the energy `x · A x / 2 − b · x` over all directions searched.
pub fn conjugate_gradient(
    operator: &(impl LinearOperator + ?Sized),
    preconditioner: &(impl Preconditioner + ?Sized),
    b: &[Vec3],
    x: &mut [Vec3],
    settings: &Settings,
    workspace: &mut ConjugateGradientWorkspace,
) -> Report {
    workspace.resize(operator.block_count());
    let ConjugateGradientWorkspace { residual: r, preconditioned: z, direction: p, product: Ap } = workspace;

    let b_norm = reduce::norm(b);
    let report = |iterations, residual_norm: f64, stop| {
        let relative_residual = if b_norm > 0.0 { residual_norm / b_norm } else { residual_norm };
        Report { iterations, relative_residual, stop }
    };
    if b_norm == 0.0 {
        x.fill(Vec3::ZERO);
        return report(0, 0.0, Stop::Converged);
    }

    // r = b − A x, which takes no product where x is zero
    let mut residual_norm = if x.iter().all(|x| *x == Vec3::ZERO) {
        r.copy_from_slice(b);
        b_norm
    } else {
        operator.residual(b, x, r).sqrt()
    };
    if residual_norm > b_norm {
        x.fill(Vec3::ZERO);
        r.copy_from_slice(b);
        residual_norm = b_norm;
    }
    if !(residual_norm.is_finite() && b_norm.is_finite()) {
        return report(0, residual_norm, Stop::NotFinite);
    }
    let target = settings.tolerance * b_norm;
    let mut iterations = 0;
    for _ in 0..=RESTARTS {
        if residual_norm <= target {
            return report(iterations, residual_norm, Stop::Converged);
        }
        let before = residual_norm;
        let stop = descend(operator, preconditioner, x, [r, z, p, Ap], target, settings, &mut iterations);
        // the recurrence drifts from the residual it stands for: only the true one counts
        residual_norm = operator.residual(b, x, r).sqrt();
        match stop {
            _ if !residual_norm.is_finite() => return report(iterations, residual_norm, Stop::NotFinite),
            Stop::Converged if residual_norm > target && residual_norm > 0.5 * before => break,
            Stop::Converged => {}
            _ if residual_norm <= target => return report(iterations, residual_norm, Stop::Converged),
            stop => return report(iterations, residual_norm, stop),
        }
    }
    let stop = if residual_norm <= target { Stop::Converged } else { Stop::Stagnated };
    report(iterations, residual_norm, stop)
}

/// Iterates until the recurrence's residual is below `target`; `r` is `b − A x` on entry.
fn descend(
    operator: &(impl LinearOperator + ?Sized),
    preconditioner: &(impl Preconditioner + ?Sized),
    x: &mut [Vec3],
    [r, z, p, Ap]: [&mut [Vec3]; 4],
    target: f64,
    settings: &Settings,
    iterations: &mut usize,
) -> Stop {
    // z = M⁻¹ r, p = z
    let mut rz = preconditioner.apply_dot(r, z);
    p.copy_from_slice(z);
    loop {
        if !rz.is_finite() {
            return Stop::NotFinite;
        }
        if rz <= 0.0 {
            return Stop::PreconditionerIndefinite;
        }
        if *iterations == settings.max_iterations {
            return Stop::IterationLimit;
        }
        *iterations += 1;

        // α = r·z / p·Ap
        let curvature = operator.apply_dot(p, Ap);
        if curvature.is_nan() {
            return Stop::NotFinite;
        }
        if curvature <= 0.0 {
            return Stop::Indefinite { curvature: curvature / reduce::dot(p, p) };
        }
        let alpha = rz / curvature;

        // x += α p, r −= α Ap
        let residual_sq = reduce::sum_mut_pair(0, x, r, &|first, x: &mut [Vec3], r: &mut [Vec3]| {
            for (((x, r), p), Ap) in x.iter_mut().zip(r.iter_mut()).zip(&p[first..]).zip(&Ap[first..]) {
                *x += *p * alpha;
                *r -= *Ap * alpha;
            }
            reduce::dot_chunk(r, r)
        });
        if residual_sq.sqrt() <= target {
            return Stop::Converged;
        }

        // z = M⁻¹ r, β = (r·z)new / (r·z)old, p = z + β p
        let rz_new = preconditioner.apply_dot(r, z);
        let beta = rz_new / rz;
        rz = rz_new;
        reduce::for_each_chunk(p, &|first, p: &mut [Vec3]| {
            for (p, z) in p.iter_mut().zip(&z[first..]) {
                *p = *z + *p * beta;
            }
        });
    }
}
