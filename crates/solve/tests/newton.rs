//! Newton on small problems whose behaviour is known.
#![allow(non_snake_case, reason = "symbols of the mathematics")]

use std::convert::Infallible;

use souple_math::{Mat3, Vec3};
use souple_solve::newton::{NewtonProblem, Settings, Stop, Trial, Workspace, newton};
use souple_solve::{BlockMatrix, LinearOperator, krylov, reduce};

use crate::common::{chain, dense_solve};

/// Masses on a chain with hardening springs to ground: `Φ = q·A q/2 + Σ c q⁴/4 − b·q`, refused beyond `|q| = limit`.
struct Hardening {
    stiffness: BlockMatrix,
    load: Vec<Vec3>,
    cubic: f64,
    limit: f64,
    /// Whether Newton sees `Φ`, or must do with the residual.
    has_merit: bool,
    /// Without `Φ`: whether Newton knows that there is one.
    is_gradient: bool,
    /// Factor on the tangent: −1 makes directions climb.
    tangent: f64,
    accepted: Vec<Vec3>,
    current: Vec<Vec3>,
}

impl Hardening {
    fn new(load: f64) -> Self {
        let count = 12;
        Self {
            stiffness: chain(count, 1.0, 0.1),
            load: vec![Vec3::new(load, -0.5 * load, 0.2 * load); count],
            cubic: 3.0,
            limit: f64::INFINITY,
            has_merit: true,
            is_gradient: false,
            tangent: 1.0,
            accepted: vec![Vec3::ZERO; count],
            current: vec![Vec3::ZERO; count],
        }
    }

    fn cubes(v: Vec3) -> Vec3 {
        Vec3::from_array(v.to_array().map(|x| x * x * x))
    }
}

impl NewtonProblem for Hardening {
    type Error = Infallible;

    fn block_count(&self) -> usize {
        self.load.len()
    }

    fn residual(&mut self, out: &mut [Vec3]) -> Result<Trial, Infallible> {
        self.stiffness.residual(&self.load, &self.current, out);
        for (r, q) in out.iter_mut().zip(&self.current) {
            *r -= Self::cubes(*q) * self.cubic;
        }
        Ok(Trial::Admissible)
    }

    fn direction(
        &mut self,
        residual: &[Vec3],
        out: &mut [Vec3],
    ) -> Result<Option<krylov::Report>, Infallible> {
        let mut tangent = self.stiffness.clone();
        for (block, q) in self.accepted.iter().enumerate() {
            let squares = Vec3::from_array(q.to_array().map(|x| 3.0 * self.cubic * x * x));
            tangent.add(block, block, &Mat3::from_diagonal(squares)).unwrap();
        }
        tangent.scale(self.tangent);
        out.copy_from_slice(&dense_solve(&tangent, residual));
        Ok(None)
    }

    fn try_step(&mut self, direction: &[Vec3], fraction: f64) -> Result<Trial, Infallible> {
        for ((current, accepted), d) in self.current.iter_mut().zip(&self.accepted).zip(direction) {
            *current = *accepted + *d * fraction;
        }
        let far = self.current.iter().any(|q| q.largest_component() > self.limit);
        Ok(if far { Trial::TooLong } else { Trial::Admissible })
    }

    fn accept(&mut self) -> Result<(), Infallible> {
        self.accepted.copy_from_slice(&self.current);
        Ok(())
    }

    fn is_gradient(&self) -> bool {
        self.is_gradient
    }

    fn merit(&mut self) -> Result<Option<f64>, Infallible> {
        let mut Aq = self.current.clone();
        let quadratic = 0.5 * self.stiffness.apply_dot(&self.current, &mut Aq);
        let quartic: f64 = self.current.iter().flat_map(|q| q.to_array()).map(|x| x.powi(4) / 4.0).sum();
        let merit = quadratic + self.cubic * quartic - reduce::dot(&self.load, &self.current);
        Ok(self.has_merit.then_some(merit))
    }
}

/// Near the solution `‖r_{k+1}‖ ≤ C ‖r_k‖²` with one `C`, by merit, by slopes and by residual alike.
#[test]
fn convergence_is_quadratic() {
    for (has_merit, is_gradient) in [(true, false), (false, true), (false, false)] {
        let mut problem = Hardening { has_merit, is_gradient, ..Hardening::new(2.0) };
        let mut workspace = Workspace::default();
        let settings = Settings { relative_tolerance: 1e-13, ..Settings::default() };
        let report = newton(&mut problem, &settings, &mut workspace).unwrap();
        assert!(report.converged() && report.iterations < 12, "{report:?}");
        let residuals = workspace.residuals();
        assert_eq!(residuals.len(), report.iterations + 1);
        let last = &residuals[residuals.len() - 4..];
        // q ≈ 0.9, so C ≤ |∂²r| |A⁻¹|² / 2 ≈ 9 · 0.9 / (9 · 0.8)² is well below 1
        assert!(last.windows(2).all(|pair| pair[1] <= pair[0] * pair[0] + 1e-14), "{residuals:?}");
        assert!(workspace.fractions().ends_with(&[1.0, 1.0]));
    }
}

/// A full step that leaves the domain is shortened, not taken.
#[test]
fn steps_that_are_too_long_are_shortened() {
    let mut problem = Hardening { limit: 3.0, ..Hardening::new(2.0) };
    let mut workspace = Workspace::default();
    let report = newton(&mut problem, &Settings::default(), &mut workspace).unwrap();
    assert!(report.converged(), "{report:?}");
    assert!(workspace.fractions()[0] < 1.0);
    assert!(problem.accepted.iter().all(|q| q.largest_component() <= 3.0));
}

/// Every other ending is told, and leaves the best configuration accepted and current.
#[test]
fn every_ending_is_told() {
    let solve = |mut problem: Hardening, settings: &Settings| {
        let report = newton(&mut problem, settings, &mut Workspace::default()).unwrap();
        assert_eq!(problem.accepted, problem.current);
        report
    };
    let climbing = Hardening { tangent: -1.0, ..Hardening::new(2.0) };
    assert_eq!(solve(climbing, &Settings::default()).stop, Stop::NotDescent);
    let climbing = Hardening { tangent: -1.0, has_merit: false, is_gradient: true, ..Hardening::new(2.0) };
    assert_eq!(solve(climbing, &Settings::default()).stop, Stop::NotDescent);
    let climbing = Hardening { tangent: -1.0, has_merit: false, ..Hardening::new(2.0) };
    assert_eq!(solve(climbing, &Settings::default()).stop, Stop::NoDecrease);
    let one_step = Settings { max_iterations: 1, ..Settings::default() };
    assert_eq!(solve(Hardening::new(2.0), &one_step).stop, Stop::IterationLimit);
    let mut bad = Hardening::new(f64::INFINITY);
    let report = newton(&mut bad, &Settings::default(), &mut Workspace::default()).unwrap();
    assert_eq!(report.stop, Stop::BadStart);
    assert_eq!(solve(Hardening::new(0.0), &Settings::default()).stop, Stop::Converged);
}
