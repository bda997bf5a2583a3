//! Stabilised bi-conjugate gradients for non-symmetric operators.
//!
//! van der Vorst 1992, preconditioned from the right so that its residual is the true one. Two products per
//! iteration and little memory; where it stagnates, [`super::gmres`] usually does not.

use souple_math::Vec3;

use super::{Report, Settings, Stop};
use crate::{LinearOperator, Preconditioner, reduce};

/// How often the recurrence may restart from the true residual.
const RESTARTS: usize = 16;

/// Vectors that one solve needs.
#[derive(Clone, Debug, Default)]
pub struct BicgstabWorkspace {
    vectors: [Vec<Vec3>; 8],
}

impl BicgstabWorkspace {
    pub fn new(block_count: usize) -> Self {
        let mut workspace = Self::default();
        workspace.resize(block_count);
        workspace
    }

    fn resize(&mut self, block_count: usize) {
        for vector in &mut self.vectors {
            vector.resize(block_count, Vec3::ZERO);
        }
    }
}

/// Solves `A x = b`, starting from the `x` given. On any stop `x` is the iterate of smallest residual seen.
pub fn bicgstab(
    operator: &(impl LinearOperator + ?Sized),
    preconditioner: &(impl Preconditioner + ?Sized),
    b: &[Vec3],
    x: &mut [Vec3],
    settings: &Settings,
    workspace: &mut BicgstabWorkspace,
) -> Report {
    workspace.resize(operator.block_count());
    let [r, shadow, p, v, t, preconditioned, y, best] = &mut workspace.vectors;

    let b_norm = reduce::norm(b);
    if b_norm == 0.0 {
        x.fill(Vec3::ZERO);
        return Report { iterations: 0, relative_residual: 0.0, stop: Stop::Converged };
    }
    let target = settings.tolerance * b_norm;

    let mut best_norm = operator.residual(b, x, r).sqrt();
    best.copy_from_slice(x);
    let mut iterations = 0;
    let mut restarts = 0;
    let stop = loop {
        // restart from the true residual
        let residual_norm = operator.residual(b, x, r).sqrt();
        if !residual_norm.is_finite() {
            break Stop::NotFinite;
        }
        if residual_norm <= best_norm {
            best_norm = residual_norm;
            best.copy_from_slice(x);
        }
        if residual_norm <= target {
            break Stop::Converged;
        }
        if restarts > RESTARTS {
            break Stop::Stagnated;
        }
        restarts += 1;
        shadow.copy_from_slice(r);
        p.copy_from_slice(r);
        let mut rho = residual_norm * residual_norm;
        let inner = loop {
            if iterations == settings.max_iterations {
                break Stop::IterationLimit;
            }
            iterations += 1;

            // v = A M⁻¹ p, α = ρ / shadow·v
            preconditioner.apply(p, preconditioned);
            operator.apply(preconditioned, v);
            let projection = reduce::dot(shadow, v);
            let alpha = rho / projection;
            if !alpha.is_finite() {
                break Stop::Breakdown;
            }
            // s = r − α v (kept in r), x += α M⁻¹ p
            reduce::add_scaled(r, -alpha, v);
            reduce::add_scaled(x, alpha, preconditioned);
            if reduce::norm(r) <= target {
                break Stop::Converged;
            }

            // t = A M⁻¹ s, ω = t·s / t·t
            preconditioner.apply(r, y);
            operator.apply(y, t);
            let omega = reduce::dot(t, r) / reduce::dot(t, t);
            if !omega.is_finite() || omega == 0.0 {
                break Stop::Breakdown;
            }
            // x += ω M⁻¹ s, r = s − ω t
            reduce::add_scaled(x, omega, y);
            reduce::add_scaled(r, -omega, t);
            if reduce::norm(r) <= target {
                break Stop::Converged;
            }

            // β = (ρ_new/ρ)(α/ω), p = r + β (p − ω v)
            let rho_new = reduce::dot(shadow, r);
            let beta = (rho_new / rho) * (alpha / omega);
            if !beta.is_finite() || beta == 0.0 {
                break Stop::Breakdown;
            }
            rho = rho_new;
            reduce::for_each_chunk(p, &|first, p: &mut [Vec3]| {
                for ((p, r), v) in p.iter_mut().zip(&r[first..]).zip(&v[first..]) {
                    *p = *r + (*p - *v * omega) * beta;
                }
            });
        };
        if inner == Stop::IterationLimit {
            let residual_norm = operator.residual(b, x, r).sqrt();
            if residual_norm <= best_norm {
                best_norm = residual_norm;
                best.copy_from_slice(x);
            }
            break if residual_norm <= target { Stop::Converged } else { Stop::IterationLimit };
        }
    };
    x.copy_from_slice(best);
    Report { iterations, relative_residual: best_norm / b_norm, stop }
}
