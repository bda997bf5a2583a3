//! The linear solvers by name, for scene files.
//!
//! A [`LinearSolver`] is built for a pattern, updated with each new matrix, and asked to solve. `auto` takes
//! the direct factor where the matrix is stiff and a factor is cheaper than some hundred products with it
//! (small or thin bodies, chains), and conjugate gradients otherwise.

use std::sync::Arc;

use souple_math::Vec3;
use souple_table::{Entry, Parameter, Range, Table, Value, Values};

use crate::krylov::{
    BicgstabWorkspace, ConjugateGradientWorkspace, GmresWorkspace, Report, Settings, Stop, bicgstab,
    conjugate_gradient, gmres,
};
use crate::precondition::{self, BlockRole, Choice, Geometry, weight_of_the_diagonal};
use crate::{
    BlockMatrix, DirectSolver, LinearOperator, LuSolver, Pattern, Preconditioner, SolveError, ordering,
    reduce,
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
    ///
    /// # Errors
    /// The places do not fit or are not finite; the old ones stay.
    fn follow(&mut self, _coordinates: &[Vec3]) -> Result<(), SolveError> {
        Ok(())
    }

    /// Changes the wanted true relative residual of the next solves.
    fn set_tolerance(&mut self, tolerance: f64);

    /// Changes how many iterations the next solves may take; nothing of it where there are none.
    fn limit_iterations(&mut self, _at_most: usize) {}

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
    Table { kind: "solver", entries: &[&AUTO, &CONJUGATE_GRADIENT, &DIRECT, &LU, &GMRES, &BICGSTAB] };

const TOLERANCE: Parameter =
    Parameter::number("tolerance", "", Range::open(0.0, 1.0), "wanted true residual |b - A x| / |b|")
        .or(Value::Number(1e-8));
const MAX_ITERATIONS: Parameter =
    Parameter::integer("max_iterations", Range::at_least(1.0), "iterations before giving up")
        .or(Value::Integer(10_000));
const PRECONDITIONERS: &[&str] =
    &["auto", "rigid_modes", "incomplete_cholesky", "block_jacobi", "lagged_factor", "none"];
const PRECONDITIONER: Parameter =
    Parameter::choice("preconditioner", PRECONDITIONERS, "what makes iterations few").or(Value::Text("auto"));
const GENERAL_PRECONDITIONER: Parameter =
    Parameter::choice("preconditioner", PRECONDITIONERS, "what makes iterations few; symmetric part only")
        .or(Value::Text("block_jacobi"));

static AUTO: Entry<Build> = Entry {
    name: "auto",
    summary: "direct where the matrix is stiff and a factor cheap (small or thin bodies), cg otherwise",
    source: "measured on the reference bar (examples/beam.rs)",
    parameters: &[TOLERANCE, MAX_ITERATIONS, PRECONDITIONER],
    build: Build {
        needs: Needs::PositiveDefinite,
        build: |values, matrix, geometry| {
            let mut auto = Auto {
                values: values.clone(),
                pattern: Arc::clone(matrix.pattern()),
                coordinates: geometry.coordinates.map(<[Vec3]>::to_vec),
                roles: geometry.roles.map(<[BlockRole]>::to_vec),
                worth: None,
                direct: None,
                iterative: None,
                is_direct: false,
                per_row: Vec::new(),
                followed: Vec::new(),
            };
            auto.update(matrix)?;
            Ok(Box::new(auto))
        },
    },
};

static LU: Entry<Build> = Entry {
    name: "lu",
    summary: "sparse LU factor with partial pivoting, for tangents that are not symmetric; several times `direct`",
    source: "kernels and order: faer",
    parameters: &[TOLERANCE],
    build: Build {
        needs: Needs::Regular,
        build: |values, matrix, _| {
            let mut solver = LuSolver::analyse(matrix.pattern())?;
            solver.factorize(matrix)?;
            Ok(Box::new(Direct::new("lu", Factors::Lu(solver), values, matrix.block_count())))
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
    Ok(Box::new(Direct::new("direct", Factors::Cholesky(solver), values, matrix.block_count())))
}

/// Chooses for each matrix anew, from its numbers alone.
struct Auto {
    values: Values,
    pattern: Arc<Pattern>,
    coordinates: Option<Vec<Vec3>>,
    roles: Option<Vec<BlockRole>>,
    /// Whether a factor is cheap on this pattern, once asked.
    worth: Option<bool>,
    direct: Option<Box<dyn LinearSolver>>,
    iterative: Option<Box<dyn LinearSolver>>,
    /// What serves the last matrix.
    is_direct: bool,
    per_row: Vec<f64>,
    /// Where blocks are now, if that was said after their places in `coordinates`.
    followed: Vec<Vec3>,
}

/// Systems of fewer blocks are factorised whatever the weight of their diagonal.
const TINY: usize = 64;

impl Auto {
    fn current(&mut self) -> Option<&mut Box<dyn LinearSolver>> {
        if self.is_direct { self.direct.as_mut() } else { self.iterative.as_mut() }
    }

    fn make(&mut self, matrix: &BlockMatrix) -> Result<(), SolveError> {
        let geometry = Geometry { coordinates: self.coordinates.as_deref(), roles: self.roles.as_deref() };
        if self.is_direct {
            let order = ordering::best(&self.pattern, geometry.coordinates)?;
            self.direct = Some(build_direct(&self.values, matrix, order)?);
        } else {
            let preconditioner = preconditioner_name(&self.values);
            self.iterative = Some(build_cg(preconditioner, &self.values, matrix, geometry)?);
        }
        Ok(())
    }

    fn prefers_direct(&mut self, matrix: &BlockMatrix) -> Result<bool, SolveError> {
        if self.pattern.block_count() < TINY {
            return Ok(true);
        }
        let weight = weight_of_the_diagonal(matrix, &mut self.per_row);
        if Choice::by_weight(weight) != Choice::RigidModes {
            return Ok(false);
        }
        let worth = match self.worth {
            Some(worth) => worth,
            None => direct_is_worth_it(&self.pattern, self.coordinates.as_deref())?,
        };
        self.worth = Some(worth);
        Ok(worth)
    }
}

impl LinearSolver for Auto {
    fn update(&mut self, matrix: &BlockMatrix) -> Result<(), SolveError> {
        crate::matrix::check_pattern(&self.pattern, matrix.pattern())?;
        self.is_direct = self.prefers_direct(matrix)?;
        if self.current().is_none() {
            self.make(matrix)?;
            if self.followed.is_empty() {
                return Ok(());
            }
        }
        let Self { direct, iterative, followed, is_direct, .. } = self;
        let Some(solver) = (if *is_direct { direct } else { iterative }) else { return Ok(()) };
        if !followed.is_empty() {
            // also where it was made only now: what came before must not show
            solver.follow(followed)?;
        }
        solver.update(matrix)
    }

    fn rebuild(&mut self, matrix: &BlockMatrix) -> Result<(), SolveError> {
        self.update(matrix)?;
        self.current().map_or(Ok(()), |solver| solver.rebuild(matrix))
    }

    fn follow(&mut self, coordinates: &[Vec3]) -> Result<(), SolveError> {
        crate::error::check_length("coordinates", coordinates.len(), self.pattern.block_count())?;
        self.followed.clear();
        self.followed.extend_from_slice(coordinates);
        Ok(())
    }

    fn set_tolerance(&mut self, tolerance: f64) {
        for solver in [&mut self.direct, &mut self.iterative].into_iter().flatten() {
            solver.set_tolerance(tolerance);
        }
    }

    fn limit_iterations(&mut self, at_most: usize) {
        for solver in [&mut self.direct, &mut self.iterative].into_iter().flatten() {
            solver.limit_iterations(at_most);
        }
    }

    fn solve(
        &mut self,
        operator: &dyn LinearOperator,
        b: &[Vec3],
        x: &mut [Vec3],
    ) -> Result<Report, SolveError> {
        match self.current() {
            Some(solver) => solver.solve(operator, b, x),
            None => Err(SolveError::NoFactor { method: "auto" }),
        }
    }

    fn name(&self) -> &'static str {
        if self.is_direct { "direct" } else { "cg" }
    }

    fn bytes(&self) -> usize {
        let places = (self.coordinates.as_ref().map_or(0, Vec::capacity) + self.followed.capacity())
            * size_of::<Vec3>();
        let made = [&self.direct, &self.iterative].into_iter().flatten();
        made.map(|solver| solver.bytes()).sum::<usize>() + places + 8 * self.per_row.capacity()
    }
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

    fn follow(&mut self, coordinates: &[Vec3]) -> Result<(), SolveError> {
        self.preconditioner.follow(coordinates)
    }

    fn set_tolerance(&mut self, tolerance: f64) {
        self.settings.tolerance = tolerance;
    }

    fn limit_iterations(&mut self, at_most: usize) {
        self.settings.max_iterations = at_most;
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
    name: &'static str,
    factors: Factors,
    residual: Vec<Vec3>,
    tolerance: f64,
}

enum Factors {
    Cholesky(DirectSolver),
    Lu(LuSolver),
}

impl Factors {
    fn solve(&self, b: &mut [Vec3]) -> Result<(), SolveError> {
        match self {
            Self::Cholesky(solver) => solver.solve(b),
            Self::Lu(solver) => solver.solve(b),
        }
    }
}

impl Direct {
    fn new(name: &'static str, factors: Factors, values: &Values, block_count: usize) -> Self {
        let residual = vec![Vec3::ZERO; block_count];
        Self { name, factors, residual, tolerance: values.number("tolerance") }
    }
}

/// Corrections of a direct solution by its residual before rounding is blamed.
const REFINEMENTS: usize = 3;

impl LinearSolver for Direct {
    fn update(&mut self, matrix: &BlockMatrix) -> Result<(), SolveError> {
        match &mut self.factors {
            Factors::Cholesky(solver) => solver.factorize(matrix),
            Factors::Lu(solver) => solver.factorize(matrix),
        }
    }

    fn rebuild(&mut self, matrix: &BlockMatrix) -> Result<(), SolveError> {
        self.update(matrix)
    }

    fn set_tolerance(&mut self, tolerance: f64) {
        self.tolerance = tolerance;
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
        self.factors.solve(x)?;
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
                self.factors.solve(&mut self.residual)?;
                reduce::add_scaled(x, 1.0, &self.residual);
                iterations += 1;
                continue;
            };
            return Report { iterations, relative_residual, stop }.checked(self.name, &settings);
        }
    }

    fn name(&self) -> &'static str {
        self.name
    }

    fn bytes(&self) -> usize {
        match &self.factors {
            Factors::Cholesky(solver) => solver.bytes(),
            Factors::Lu(solver) => solver.bytes(),
        }
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
