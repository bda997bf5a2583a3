//! The linear solvers by name, for scene files.
//!
//! A [`LinearSolver`] is built for a pattern, updated with each new matrix, and asked to solve. `auto` takes
//! the direct factor where that is cheaper than some hundred products with the matrix (small or thin bodies,
//! chains) and conjugate gradients with `rigid_modes` otherwise.

use std::sync::Arc;

use souple_math::Vec3;
use souple_table::{Entry, Parameter, Range, Table, Value, Values};

use crate::krylov::{
    BicgstabWorkspace, ConjugateGradientWorkspace, GmresWorkspace, Report, Settings, Stop, bicgstab,
    conjugate_gradient, gmres,
};
use crate::precondition::{self, Geometry};
use crate::{
    BlockMatrix, DirectSolver, LinearOperator, Pattern, Preconditioner, SolveError, ordering, reduce,
};

/// What a solver asks of the matrix.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Needs {
    /// Symmetric and positive definite.
    PositiveDefinite,
    /// Nothing but being regular (its preconditioner asks the symmetric part to be positive definite).
    Regular,
}

/// Solves one linear system after another on the same pattern.
pub trait LinearSolver: Send + Sync {
    /// Follows the matrix of the next solves.
    ///
    /// # Errors
    /// The matrix has another pattern, or cannot be factorised.
    fn update(&mut self, matrix: &BlockMatrix) -> Result<(), SolveError>;

    /// Forgets all that came from earlier matrices; see [`Preconditioner::rebuild`].
    ///
    /// # Errors
    /// As for [`LinearSolver::update`].
    fn rebuild(&mut self, matrix: &BlockMatrix) -> Result<(), SolveError>;

    /// Takes note of new places of the blocks; counts from the next update.
    fn follow(&mut self, _coordinates: &[Vec3]) {}

    /// Solves `A x = b` from the `x` given; `operator` is the matrix of the last update, stored or not.
    ///
    /// # Errors
    /// The arrays do not fit, or the tolerance was missed ([`SolveError::NotConverged`] says why).
    fn solve(
        &mut self,
        operator: &dyn LinearOperator,
        b: &[Vec3],
        x: &mut [Vec3],
    ) -> Result<Report, SolveError>;

    /// The name in the table, `auto` resolved.
    fn name(&self) -> &'static str;

    /// Bytes held.
    fn bytes(&self) -> usize;
}

/// Constructor of a table entry.
#[derive(Clone, Copy, Debug)]
pub struct Build {
    pub needs: Needs,
    pub build: BuildSolver,
}

/// From completed values, for a matrix and the places of its blocks.
pub type BuildSolver = fn(&Values, &BlockMatrix, Geometry<'_>) -> Result<Box<dyn LinearSolver>, SolveError>;

/// All linear solvers.
pub static TABLE: Table<Build> =
    Table { kind: "solver", entries: &[&AUTO, &CONJUGATE_GRADIENT, &DIRECT, &GMRES, &BICGSTAB] };

const TOLERANCE: Parameter =
    Parameter::number("tolerance", "", Range::open(0.0, 1.0), "wanted true residual |b - A x| / |b|")
        .or(Value::Number(1e-8));
const MAX_ITERATIONS: Parameter =
    Parameter::integer("max_iterations", Range::at_least(1.0), "iterations before giving up")
        .or(Value::Integer(10_000));
const PRECONDITIONERS: &[&str] =
    &["rigid_modes", "incomplete_cholesky", "block_jacobi", "lagged_factor", "none"];
const PRECONDITIONER: Parameter =
    Parameter::choice("preconditioner", PRECONDITIONERS, "what makes iterations few")
        .or(Value::Text("rigid_modes"));
const GENERAL_PRECONDITIONER: Parameter =
    Parameter::choice("preconditioner", PRECONDITIONERS, "what makes iterations few; symmetric part only")
        .or(Value::Text("block_jacobi"));

static AUTO: Entry<Build> = Entry {
    name: "auto",
    summary: "direct where a factor is cheap (small or thin), cg with rigid_modes otherwise",
    source: "measured on the reference bar (examples/beam.rs)",
    parameters: &[TOLERANCE, MAX_ITERATIONS],
    build: Build {
        needs: Needs::PositiveDefinite,
        build: |values, matrix, geometry| {
            let order = ordering::best(matrix.pattern(), geometry.coordinates)?;
            if order.work * WORK_PER_BLOCK <= WORTH_A_FACTOR * 9.0 * matrix.pattern().slot_count() as f64 {
                return build_direct(values, matrix, order);
            }
            build_cg("rigid_modes", values, matrix, geometry)
        },
    },
};

/// Multiplications of 3×3 blocks in scalars.
const WORK_PER_BLOCK: f64 = 27.0;
/// Multiplications that a direct factor may cost, in those of a product with the matrix. Iterations with
/// `rigid_modes` cost about 110 products; a factor multiplies some four times faster than a product.
const WORTH_A_FACTOR: f64 = 440.0;

static CONJUGATE_GRADIENT: Entry<Build> = Entry {
    name: "cg",
    summary: "preconditioned conjugate gradients, for symmetric positive definite systems",
    source: "Hestenes & Stiefel 1952",
    parameters: &[TOLERANCE, MAX_ITERATIONS, PRECONDITIONER],
    build: Build {
        needs: Needs::PositiveDefinite,
        build: |values, matrix, geometry| build_cg(preconditioner_name(values), values, matrix, geometry),
    },
};

static DIRECT: Entry<Build> = Entry {
    name: "direct",
    summary: "sparse Cholesky factor in a nested-dissection order; exact, memory grows faster than the mesh",
    source: "George 1973; kernels: faer",
    parameters: &[TOLERANCE],
    build: Build {
        needs: Needs::PositiveDefinite,
        build: |values, matrix, geometry| {
            let order = ordering::best(matrix.pattern(), geometry.coordinates)?;
            build_direct(values, matrix, order)
        },
    },
};

static GMRES: Entry<Build> = Entry {
    name: "gmres",
    summary: "restarted minimal residuals, for tangents that are not symmetric; steady",
    source: "Saad & Schultz 1986",
    parameters: &[
        TOLERANCE,
        MAX_ITERATIONS,
        GENERAL_PRECONDITIONER,
        Parameter::integer("restart", Range::closed(1.0, 1000.0), "directions kept before starting over")
            .or(Value::Integer(60)),
    ],
    build: Build {
        needs: Needs::Regular,
        build: |values, matrix, geometry| {
            let restart = usize::try_from(values.integer("restart")).unwrap_or(1);
            let method = Method::Gmres(GmresWorkspace::new(matrix.block_count(), restart));
            build_iterative("gmres", method, preconditioner_name(values), values, matrix, geometry)
        },
    },
};

static BICGSTAB: Entry<Build> = Entry {
    name: "bicgstab",
    summary: "stabilised bi-conjugate gradients, for tangents that are not symmetric; little memory",
    source: "van der Vorst 1992",
    parameters: &[TOLERANCE, MAX_ITERATIONS, GENERAL_PRECONDITIONER],
    build: Build {
        needs: Needs::Regular,
        build: |values, matrix, geometry| {
            let method = Method::Bicgstab(BicgstabWorkspace::new(matrix.block_count()));
            build_iterative("bicgstab", method, preconditioner_name(values), values, matrix, geometry)
        },
    },
};

fn preconditioner_name(values: &Values) -> &'static str {
    let given = values.text("preconditioner");
    PRECONDITIONERS.iter().find(|name| **name == given).copied().unwrap_or("none")
}

fn build_cg(
    preconditioner: &str,
    values: &Values,
    matrix: &BlockMatrix,
    geometry: Geometry<'_>,
) -> Result<Box<dyn LinearSolver>, SolveError> {
    let method = Method::ConjugateGradient(ConjugateGradientWorkspace::new(matrix.block_count()));
    build_iterative("cg", method, preconditioner, values, matrix, geometry)
}

fn build_iterative(
    name: &'static str,
    method: Method,
    preconditioner: &str,
    values: &Values,
    matrix: &BlockMatrix,
    geometry: Geometry<'_>,
) -> Result<Box<dyn LinearSolver>, SolveError> {
    let entry = precondition::TABLE.find(preconditioner).expect("the choices are names of the table");
    let defaults = entry.values(Values::new()).expect("preconditioners have defaults for all parameters");
    let preconditioner = (entry.build)(&defaults, matrix, geometry)?;
    let settings = Settings {
        tolerance: values.number("tolerance"),
        max_iterations: usize::try_from(values.integer("max_iterations")).unwrap_or(usize::MAX),
    };
    Ok(Box::new(Iterative { name, method, preconditioner, settings, block_count: matrix.block_count() }))
}

fn build_direct(
    values: &Values,
    matrix: &BlockMatrix,
    order: ordering::Order,
) -> Result<Box<dyn LinearSolver>, SolveError> {
    let mut solver = DirectSolver::with_order(crate::direct::Factor::Cholesky, matrix.pattern(), order)?;
    solver.factorize(matrix)?;
    let residual = vec![Vec3::ZERO; matrix.block_count()];
    Ok(Box::new(Direct { solver, residual, tolerance: values.number("tolerance") }))
}

enum Method {
    ConjugateGradient(ConjugateGradientWorkspace),
    Gmres(GmresWorkspace),
    Bicgstab(BicgstabWorkspace),
}

struct Iterative {
    name: &'static str,
    method: Method,
    preconditioner: Box<dyn Preconditioner>,
    settings: Settings,
    block_count: usize,
}

impl LinearSolver for Iterative {
    fn update(&mut self, matrix: &BlockMatrix) -> Result<(), SolveError> {
        self.preconditioner.update(matrix)
    }

    fn rebuild(&mut self, matrix: &BlockMatrix) -> Result<(), SolveError> {
        self.preconditioner.rebuild(matrix)
    }

    fn follow(&mut self, coordinates: &[Vec3]) {
        self.preconditioner.follow(coordinates);
    }

    fn solve(
        &mut self,
        operator: &dyn LinearOperator,
        b: &[Vec3],
        x: &mut [Vec3],
    ) -> Result<Report, SolveError> {
        check_system(self.block_count, operator, b, x)?;
        let (preconditioner, settings) = (&*self.preconditioner, &self.settings);
        let report = match &mut self.method {
            Method::ConjugateGradient(workspace) => {
                conjugate_gradient(operator, preconditioner, b, x, settings, workspace)
            }
            Method::Gmres(workspace) => gmres(operator, preconditioner, b, x, settings, workspace),
            Method::Bicgstab(workspace) => bicgstab(operator, preconditioner, b, x, settings, workspace),
        };
        report.checked(self.name, settings)
    }

    fn name(&self) -> &'static str {
        self.name
    }

    fn bytes(&self) -> usize {
        let vectors = match &self.method {
            Method::ConjugateGradient(_) => 4,
            Method::Gmres(workspace) => workspace.vector_count(),
            Method::Bicgstab(_) => 8,
        };
        self.preconditioner.bytes() + vectors * self.block_count * size_of::<Vec3>()
    }
}

struct Direct {
    solver: DirectSolver,
    residual: Vec<Vec3>,
    tolerance: f64,
}

/// Corrections of a direct solution by its residual before rounding is blamed.
const REFINEMENTS: usize = 3;

impl LinearSolver for Direct {
    fn update(&mut self, matrix: &BlockMatrix) -> Result<(), SolveError> {
        self.solver.factorize(matrix)
    }

    fn rebuild(&mut self, matrix: &BlockMatrix) -> Result<(), SolveError> {
        self.update(matrix)
    }

    fn solve(
        &mut self,
        operator: &dyn LinearOperator,
        b: &[Vec3],
        x: &mut [Vec3],
    ) -> Result<Report, SolveError> {
        check_system(self.residual.len(), operator, b, x)?;
        let b_norm = reduce::norm(b);
        x.copy_from_slice(b);
        self.solver.solve(x)?;
        let settings = Settings { tolerance: self.tolerance, max_iterations: REFINEMENTS };
        let mut iterations = 1;
        loop {
            let norm = operator.residual(b, x, &mut self.residual).sqrt();
            let relative_residual = if b_norm > 0.0 { norm / b_norm } else { norm };
            let stop = if relative_residual <= self.tolerance {
                Stop::Converged
            } else if !relative_residual.is_finite() {
                Stop::NotFinite
            } else if iterations > REFINEMENTS {
                Stop::Stagnated
            } else {
                // x += A⁻¹ (b − A x)
                self.solver.solve(&mut self.residual)?;
                reduce::add_scaled(x, 1.0, &self.residual);
                iterations += 1;
                continue;
            };
            return Report { iterations, relative_residual, stop }.checked("direct", &settings);
        }
    }

    fn name(&self) -> &'static str {
        "direct"
    }

    fn bytes(&self) -> usize {
        self.solver.bytes()
    }
}

fn check_system(
    block_count: usize,
    operator: &dyn LinearOperator,
    b: &[Vec3],
    x: &[Vec3],
) -> Result<(), SolveError> {
    crate::error::check_length("the operator", operator.block_count(), block_count)?;
    crate::error::check_length("the right-hand side", b.len(), block_count)?;
    crate::error::check_length("the unknowns", x.len(), block_count)?;
    match b.iter().position(|entry| !entry.is_finite()) {
        Some(block) => Err(SolveError::NotFinite { what: "the right-hand side", block }),
        None => Ok(()),
    }
}

/// Whether `auto` would take the direct factor for this pattern.
///
/// # Errors
/// The memory for the analysis cannot be had.
pub fn direct_is_worth_it(pattern: &Arc<Pattern>, coordinates: Option<&[Vec3]>) -> Result<bool, SolveError> {
    let order = ordering::best(pattern, coordinates)?;
    Ok(order.work * WORK_PER_BLOCK <= WORTH_A_FACTOR * 9.0 * pattern.slot_count() as f64)
}
