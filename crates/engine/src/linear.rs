//! Which linear solver serves the implicit steppers, with structures and buffers kept between solves.

use souple_math::Vec3;
use souple_solve::krylov::{
    BicgstabWorkspace, ConjugateGradientWorkspace, GmresWorkspace, Report, Settings, Stop, bicgstab,
    conjugate_gradient, gmres,
};
use souple_solve::precondition::{
    BlockJacobi, Geometry, IncompleteCholesky, Preconditioner, RigidModes, RigidModesSettings,
};
use souple_solve::{BlockMatrix, DirectSolver, LinearOperator, SolveError};
use souple_table::{Parameter, Range, Value, Values};

use crate::steppers::StepError;

/// A linear system that could not be solved.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error(transparent)]
pub struct LinearError(#[from] pub SolveError);

impl From<LinearError> for StepError {
    fn from(error: LinearError) -> Self {
        Self::Linear(error.to_string())
    }
}

/// How linear systems are solved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Direct for few unknowns, conjugate gradients with rigid modes for many, GMRES where the matrix is not
    /// symmetric.
    Auto,
    Cg,
    Direct,
    Gmres,
    Bicgstab,
}

/// What makes iterations few.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PreconditionerKind {
    BlockJacobi,
    IncompleteCholesky,
    /// A coarse space of rigid modes per aggregate.
    RigidModes,
}

/// Choice of solver and its limits.
#[derive(Clone, Debug, PartialEq)]
pub struct SolverSettings {
    pub method: Method,
    pub preconditioner: PreconditionerKind,
    /// Wanted true relative residual.
    pub tolerance: f64,
    pub max_iterations: usize,
    /// Products with the tangent element by element, without a stored matrix.
    pub matrix_free: bool,
}

impl Default for SolverSettings {
    fn default() -> Self {
        Self {
            method: Method::Auto,
            preconditioner: PreconditionerKind::RigidModes,
            tolerance: 1e-8,
            max_iterations: 10_000,
            matrix_free: false,
        }
    }
}

const METHODS: [(&str, Method); 5] = [
    ("auto", Method::Auto),
    ("cg", Method::Cg),
    ("direct", Method::Direct),
    ("gmres", Method::Gmres),
    ("bicgstab", Method::Bicgstab),
];
const PRECONDITIONERS: [(&str, PreconditionerKind); 3] = [
    ("block_jacobi", PreconditionerKind::BlockJacobi),
    ("incomplete_cholesky", PreconditionerKind::IncompleteCholesky),
    ("rigid_modes", PreconditionerKind::RigidModes),
];

pub const SOLVER: Parameter = Parameter::choice(
    "solver",
    &["auto", "cg", "direct", "gmres", "bicgstab"],
    "linear solver; `auto`: direct for few unknowns, `cg` for many, `gmres` where the tangent is not symmetric",
)
.or(Value::Text("auto"));

pub const PRECONDITIONER: Parameter = Parameter::choice(
    "preconditioner",
    &["rigid_modes", "incomplete_cholesky", "block_jacobi"],
    "what makes the iterations few",
)
.or(Value::Text("rigid_modes"));

pub const TOLERANCE: Parameter = Parameter::number(
    "solver_tolerance",
    "",
    Range::open(0.0, 1.0),
    "true relative residual at which a linear solve stops",
)
.or(Value::Number(1e-8));

pub const MAX_ITERATIONS: Parameter =
    Parameter::integer("solver_iterations", Range::closed(1.0, 1e9), "iterations before a linear solve is given up")
        .or(Value::Integer(10_000));

pub const MATRIX_FREE: Parameter = Parameter::boolean(
    "matrix_free",
    "tangent products element by element, without a stored matrix: least memory (block Jacobi only)",
)
.or(Value::Boolean(false));

impl SolverSettings {
    /// From the completed values of an entry that declares the parameters above.
    pub fn from_values(values: &Values) -> Self {
        let of = |name: &str| values.text(name);
        let method = METHODS.iter().find(|(name, _)| *name == of("solver")).map_or(Method::Auto, |entry| entry.1);
        let preconditioner = PRECONDITIONERS
            .iter()
            .find(|(name, _)| *name == of("preconditioner"))
            .map_or(PreconditionerKind::RigidModes, |entry| entry.1);
        Self {
            method,
            preconditioner,
            tolerance: values.number("solver_tolerance"),
            max_iterations: values.integer("solver_iterations") as usize,
            matrix_free: values.boolean("matrix_free"),
        }
    }

    fn krylov(&self) -> Settings {
        Settings { tolerance: self.tolerance, max_iterations: self.max_iterations }
    }
}

/// Below this many blocks `auto` factorises: the factor then costs less than the set-up of an iteration.
const DIRECT_BELOW: usize = 800;
/// Vectors kept by GMRES between restarts.
const GMRES_RESTART: usize = 60;

/// A solver with its structures and buffers.
pub struct LinearSolver {
    settings: SolverSettings,
    preconditioner: Option<Box<dyn Preconditioner>>,
    diagonal: Option<BlockJacobi>,
    direct: Option<DirectSolver>,
    cg: ConjugateGradientWorkspace,
    gmres: Option<GmresWorkspace>,
    bicgstab: Option<BicgstabWorkspace>,
}

impl LinearSolver {
    pub fn new(settings: SolverSettings) -> Self {
        Self {
            settings,
            preconditioner: None,
            diagonal: None,
            direct: None,
            cg: ConjugateGradientWorkspace::new(0),
            gmres: None,
            bicgstab: None,
        }
    }

    pub fn is_matrix_free(&self) -> bool {
        self.settings.matrix_free
    }

    /// Bytes of factors and preconditioners.
    pub fn bytes(&self) -> usize {
        let preconditioner = self.preconditioner.as_ref().map_or(0, |preconditioner| preconditioner.bytes());
        let diagonal = self.diagonal.as_ref().map_or(0, Preconditioner::bytes);
        preconditioner + diagonal + self.direct.as_ref().map_or(0, DirectSolver::bytes)
    }

    /// Solves `A x = b` from `x`; returns iterations and the true relative residual.
    ///
    /// # Errors
    /// The method broke down or missed its tolerance.
    pub fn solve(
        &mut self,
        matrix: &BlockMatrix,
        positions: &[Vec3],
        symmetric: bool,
        b: &[Vec3],
        x: &mut [Vec3],
    ) -> Result<(u32, f64), LinearError> {
        let method = match self.settings.method {
            Method::Auto if !symmetric => Method::Gmres,
            Method::Auto if matrix.pattern().block_count() < DIRECT_BELOW => Method::Direct,
            Method::Auto => Method::Cg,
            chosen => chosen,
        };
        match method {
            Method::Direct if symmetric => match self.solve_direct(matrix, positions, b, x) {
                // not positive definite: the direction of least residual is still worth having
                Err(LinearError(SolveError::NotPositiveDefinite { .. })) => self.iterate_general(matrix, b, x),
                solved => solved,
            },
            Method::Auto | Method::Cg => self.solve_cg(matrix, positions, b, x),
            Method::Bicgstab => {
                self.update_diagonal(matrix)?;
                let preconditioner = self.diagonal.as_ref().unwrap_or_else(|| unreachable!("just updated"));
                let workspace = self.bicgstab.get_or_insert_with(|| BicgstabWorkspace::new(b.len()));
                let settings = self.settings.krylov();
                finish("bicgstab", bicgstab(matrix, preconditioner, b, x, &settings, workspace), &settings)
            }
            Method::Direct | Method::Gmres => self.iterate_general(matrix, b, x),
        }
    }

    /// Solves with products alone; `diagonal` holds the diagonal blocks.
    ///
    /// # Errors
    /// The iteration broke down or missed its tolerance.
    pub fn solve_matrix_free(
        &mut self,
        operator: &dyn LinearOperator,
        diagonal: &BlockMatrix,
        symmetric: bool,
        b: &[Vec3],
        x: &mut [Vec3],
    ) -> Result<(u32, f64), LinearError> {
        self.update_diagonal(diagonal)?;
        let preconditioner = self.diagonal.as_ref().unwrap_or_else(|| unreachable!("just updated"));
        let settings = self.settings.krylov();
        if symmetric {
            let report = conjugate_gradient(operator, preconditioner, b, x, &settings, &mut self.cg);
            return finish("cg", truncated(report, x), &settings);
        }
        let workspace = self.gmres.get_or_insert_with(|| GmresWorkspace::new(b.len(), GMRES_RESTART));
        finish("gmres", gmres(operator, preconditioner, b, x, &settings, workspace), &settings)
    }

    /// Solves with a mass matrix, to rounding.
    ///
    /// # Errors
    /// A mass is zero or negative.
    pub fn solve_mass(matrix: &BlockMatrix, b: &[Vec3], x: &mut [Vec3]) -> Result<(u32, f64), LinearError> {
        let preconditioner = BlockJacobi::new(matrix)?;
        let mut workspace = ConjugateGradientWorkspace::new(b.len());
        let settings = Settings { tolerance: 1e-13, max_iterations: 1000 };
        let report = conjugate_gradient(matrix, &preconditioner, b, x, &settings, &mut workspace);
        finish("cg", report, &settings)
    }

    fn solve_direct(
        &mut self,
        matrix: &BlockMatrix,
        positions: &[Vec3],
        b: &[Vec3],
        x: &mut [Vec3],
    ) -> Result<(u32, f64), LinearError> {
        let fits = self.direct.as_ref().is_some_and(|direct| **direct.pattern() == **matrix.pattern());
        if !fits {
            self.direct = Some(DirectSolver::analyse(matrix.pattern(), Some(positions))?);
        }
        let direct = self.direct.as_mut().unwrap_or_else(|| unreachable!("just analysed"));
        direct.factorize(matrix)?;
        x.copy_from_slice(b);
        direct.solve(x)?;
        let mut residual = vec![Vec3::ZERO; b.len()];
        let norm = matrix.residual(b, x, &mut residual).sqrt();
        let scale = souple_solve::reduce::norm(b);
        Ok((1, if scale > 0.0 { norm / scale } else { 0.0 }))
    }

    fn solve_cg(
        &mut self,
        matrix: &BlockMatrix,
        positions: &[Vec3],
        b: &[Vec3],
        x: &mut [Vec3],
    ) -> Result<(u32, f64), LinearError> {
        let updated = match self.preconditioner.as_mut() {
            Some(preconditioner) => preconditioner.update(matrix).is_ok(),
            None => false,
        };
        if !updated {
            self.preconditioner = Some(self.settings.preconditioner.build(matrix, positions)?);
        }
        let preconditioner = self.preconditioner.as_ref().unwrap_or_else(|| unreachable!("just built"));
        let settings = self.settings.krylov();
        let report = conjugate_gradient(matrix, preconditioner.as_ref(), b, x, &settings, &mut self.cg);
        finish("cg", truncated(report, x), &settings)
    }

    fn iterate_general(&mut self, matrix: &BlockMatrix, b: &[Vec3], x: &mut [Vec3]) -> Result<(u32, f64), LinearError> {
        self.update_diagonal(matrix)?;
        let preconditioner = self.diagonal.as_ref().unwrap_or_else(|| unreachable!("just updated"));
        let workspace = self.gmres.get_or_insert_with(|| GmresWorkspace::new(b.len(), GMRES_RESTART));
        let settings = self.settings.krylov();
        finish("gmres", gmres(matrix, preconditioner, b, x, &settings, workspace), &settings)
    }

    fn update_diagonal(&mut self, matrix: &BlockMatrix) -> Result<(), LinearError> {
        let updated = self.diagonal.as_mut().is_some_and(|diagonal| diagonal.update(matrix).is_ok());
        if !updated {
            self.diagonal = Some(BlockJacobi::new(matrix)?);
        }
        Ok(())
    }
}

impl PreconditionerKind {
    fn build(self, matrix: &BlockMatrix, positions: &[Vec3]) -> Result<Box<dyn Preconditioner>, SolveError> {
        Ok(match self {
            Self::BlockJacobi => Box::new(BlockJacobi::new(matrix)?),
            Self::IncompleteCholesky => Box::new(IncompleteCholesky::new(matrix)?),
            Self::RigidModes => {
                Box::new(RigidModes::new(matrix, Geometry::points(positions), RigidModesSettings::default())?)
            }
        })
    }
}

/// A direction of negative curvature ends conjugate gradients early; what was reached is still a direction
/// of descent for Newton's method (truncated Newton, Nocedal & Wright 2006, §7.1), unless nothing was.
fn truncated(mut report: Report, x: &[Vec3]) -> Report {
    let moved = x.iter().any(|block| *block != Vec3::ZERO);
    if matches!(report.stop, Stop::Indefinite { .. } | Stop::Stagnated) && moved {
        report.stop = Stop::Converged;
    }
    report
}

fn finish(method: &'static str, report: Report, settings: &Settings) -> Result<(u32, f64), LinearError> {
    let report = report.checked(method, settings)?;
    Ok((report.iterations as u32, report.relative_residual))
}
