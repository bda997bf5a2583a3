//! The linear solver of the implicit steppers: chosen from `souple_solve::solvers::TABLE`, kept between solves, and
//! what is done where the tangent is not positive definite.
//!
//! Nothing of earlier solves enters later bits: orders and patches refer to a reference configuration that lives in
//! State, values to the matrix at hand, and every solve starts from zero or from the velocities of State.

use std::sync::Arc;

use souple_math::Vec3;
use souple_solve::krylov::{Settings, Stop, conjugate_gradient};
use souple_solve::precondition::{BlockRole, Geometry};
use souple_solve::{BlockMatrix, LinearOperator, Pattern, SolveError, reduce, solvers};
use souple_table::{Parameter, Range, Value, Values};

use crate::force::Scratch;
use crate::implicit::Rates;
use crate::kinematics::{Kinematics, UnknownKind};
use crate::reference_factor::ReferenceFactor;
use crate::steppers::StepError;
use crate::system::{Surroundings, System};
use crate::tangent::is_lasting;

/// A linear system that could not be solved.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{error}")]
pub struct LinearError {
    pub error: SolveError,
    /// The velocity block where it failed, or where most was left to solve.
    pub block: Option<usize>,
}

impl LinearError {
    /// Whether it may come of a matrix that is not positive definite.
    pub fn may_be_indefinite(&self) -> bool {
        matches!(
            self.error,
            SolveError::NotPositiveDefinite { .. }
                | SolveError::Singular { .. }
                | SolveError::NotConverged { .. }
        )
    }

    /// Whether the system was given with a number that is not finite, or came to one.
    pub fn is_not_finite(&self) -> bool {
        match self.error {
            SolveError::NotFinite { .. } => true,
            SolveError::NotConverged { relative_residual, .. } => !relative_residual.is_finite(),
            _ => false,
        }
    }
}

impl From<SolveError> for LinearError {
    fn from(error: SolveError) -> Self {
        let block = match error {
            SolveError::NotPositiveDefinite { block, .. }
            | SolveError::Singular { block, .. }
            | SolveError::NotFinite { block, .. } => Some(block),
            _ => None,
        };
        Self { error, block }
    }
}

impl From<LinearError> for StepError {
    fn from(LinearError { error, block }: LinearError) -> Self {
        Self::Linear { error: error.to_string(), block }
    }
}

/// How linear systems are solved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Direct where a factor is cheap, conjugate gradients otherwise; where the matrix is not symmetric GMRES if a
    /// symmetric one near it is known, and LU of small ones.
    Auto,
    Cg,
    Direct,
    Gmres,
    Bicgstab,
}

/// Choice of solver and its limits.
#[derive(Clone, Debug, PartialEq)]
pub struct SolverSettings {
    pub method: Method,
    /// Name of a preconditioner of `souple_solve::precondition::TABLE`.
    pub preconditioner: &'static str,
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
            preconditioner: AUTOMATIC,
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
const AUTOMATIC: &str = "auto";
/// All that needs no more of a matrix than its diagonal blocks.
const WITHOUT_MATRIX: &str = "block_jacobi";
/// Not of the solvers' table: it needs the model ([`ReferenceFactor`]).
const REFERENCE_FACTOR: &str = "reference_factor";
/// `lagged_factor` is not among them: it would carry factors of earlier steps into later bits.
const PRECONDITIONERS: &[&str] =
    &[AUTOMATIC, "rigid_modes", "incomplete_cholesky", WITHOUT_MATRIX, REFERENCE_FACTOR];

pub const SOLVER: Parameter = Parameter::choice(
    "solver",
    &["auto", "cg", "direct", "gmres", "bicgstab"],
    "linear solver; `auto`: direct where a factor is cheap, else `cg`; where the tangent is not symmetric `gmres` (or LU)",
)
.or(Value::Text("auto"));

pub const PRECONDITIONER: Parameter = Parameter::choice(
    "preconditioner",
    PRECONDITIONERS,
    "what makes the iterations few; `auto`: the cheaper the more inertia outweighs stiffness; `reference_factor`, for `auto` and `cg`: the \
     factor of where all stood first, turned with frames and points, and products without a matrix",
)
.or(Value::Text(AUTOMATIC));

pub const TOLERANCE: Parameter = Parameter::number(
    "solver_tolerance",
    "",
    Range::open(0.0, 1.0),
    "true relative residual at which a linear solve stops",
)
.or(Value::Number(1e-8));

pub const MAX_ITERATIONS: Parameter = Parameter::integer(
    "solver_iterations",
    Range::closed(1.0, 1e9),
    "iterations before a linear solve is given up",
)
.or(Value::Integer(10_000));

pub const MATRIX_FREE: Parameter = Parameter::boolean(
    "matrix_free",
    "tangent products element by element, without a stored matrix: least memory (block Jacobi or `reference_factor`)",
)
.or(Value::Boolean(false));

impl SolverSettings {
    /// From the completed values of an entry that declares the parameters above.
    pub fn from_values(values: &Values) -> Self {
        let of = |name: &str| values.text(name);
        let method =
            METHODS.iter().find(|(name, _)| *name == of("solver")).map_or(Method::Auto, |entry| entry.1);
        let given = PRECONDITIONERS.iter().find(|name| **name == of("preconditioner"));
        Self {
            method,
            preconditioner: given.copied().unwrap_or(AUTOMATIC),
            tolerance: values.number("solver_tolerance"),
            max_iterations: values.integer("solver_iterations") as usize,
            matrix_free: values.boolean("matrix_free"),
        }
    }

    /// The preconditioner of the solvers' table.
    fn of_table(&self) -> &'static str {
        if self.preconditioner == REFERENCE_FACTOR { AUTOMATIC } else { self.preconditioner }
    }

    /// The preconditioner that takes the place of the chosen one where no matrix is stored; `None` where it stays.
    pub fn preconditioner_instead(&self) -> Option<&'static str> {
        let without_matrix = [AUTOMATIC, WITHOUT_MATRIX, REFERENCE_FACTOR];
        let stays = !self.matrix_free || without_matrix.contains(&self.preconditioner);
        (!stays).then_some(WITHOUT_MATRIX)
    }
}

/// Below this many blocks a matrix without symmetry is factorised; an LU factor is dear.
const LU_BELOW: usize = 800;
/// Multiples of the diagonal tried where a matrix is not positive definite.
const SHIFTS: [f64; 7] = [1e-4, 1e-3, 1e-2, 0.1, 1.0, 10.0, 100.0];
/// Residual at which a solve that rounding ended still counts where Newton's method judges what it is worth.
const STAGNATED_BUT_JUDGED: f64 = 0.1;
/// Multiples of the wanted residual at which it still counts where nothing comes after it.
const STAGNATED_AT_MOST: f64 = 100.0;
/// Iterations on a matrix that is not symmetric, where another can be taken: GMRES until it starts over. Of a definite
/// matrix with friction the preconditioned iteration takes some tens, and one that takes more loses these few.
const PATIENCE: usize = 60;
/// Iterations with the factor of the reference configuration that cost more than a matrix and a factor of its own: products of one
/// iteration take a tenth to a thirtieth of an assembly, as measured on bars of frames.
const WORTH_A_MATRIX: usize = 100;

/// What comes of a solution.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Use {
    /// A direction of Newton's method, which judges it by what it does to residuals.
    Direction,
    /// It is taken as it is.
    Answer,
}

/// What is wanted where the matrix turns out not to be positive definite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Indefinite {
    /// Any direction in which the potential falls: a truncated one, or that of a shifted matrix.
    Descend,
    /// The solution all the same.
    Solve,
    /// An error, and soon where the matrix is not symmetric: whoever asks has another matrix to take.
    Refuse,
}

impl Use {
    /// The residual at which rounding may end a solve to `tolerance`.
    fn stagnated_at_most(self, tolerance: f64) -> f64 {
        match self {
            Self::Direction => STAGNATED_BUT_JUDGED,
            Self::Answer => STAGNATED_AT_MOST * tolerance,
        }
    }
}

/// What is asked of [`LinearSolver::solve_by_reference`].
#[derive(Clone, Copy, Debug)]
pub struct ByReference {
    pub indefinite: Indefinite,
    pub used_as: Use,
    /// As [`LinearSystem::tolerance`].
    pub tolerance: f64,
}

/// A linear system and what is known of it.
pub struct LinearSystem<'a> {
    /// The matrix, or its diagonal blocks where `operator` is given. Where it is not positive definite its
    /// diagonal may be raised.
    pub matrix: &'a mut BlockMatrix,
    /// The matrix by its products.
    pub operator: Option<&'a dyn LinearOperator>,
    /// A symmetric matrix to precondition with, where `matrix` is not symmetric and such a one is known.
    pub nearby: Option<&'a BlockMatrix>,
    pub symmetric: bool,
    pub kinematics: &'a Kinematics,
    /// The configuration that orders and patches refer to: free rows, by components.
    pub reference: &'a [f64],
    /// Places of the blocks now.
    pub positions: &'a [Vec3],
    pub indefinite: Indefinite,
    pub used_as: Use,
    /// Wanted true relative residual where it may be looser than that of the settings: solutions of a symmetric
    /// matrix are directions of descent all the same, and along those of others the residual falls, at the rate
    /// `1 - tolerance`.
    pub tolerance: f64,
}

impl LinearSystem<'_> {
    /// The residual at which rounding may end a solve to `tolerance` or the system's own.
    fn stagnated_at_most(&self, tolerance: f64) -> f64 {
        self.used_as.stagnated_at_most(tolerance.max(self.tolerance))
    }
}

/// What a solve did.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Solved {
    pub iterations: u32,
    /// Whether it is of a matrix made definite in place of the exact one.
    pub made_definite: bool,
    /// True relative residual; of the direction's own equation where that had to be shifted.
    pub residual: f64,
}

/// A solver of the table, and what it was made for.
struct Made {
    name: &'static str,
    preconditioner: &'static str,
    pattern: Arc<Pattern>,
    reference: Vec<f64>,
    solver: Box<dyn solvers::LinearSolver>,
}

/// What became of the factor of a reference configuration.
enum Reference {
    Made(Box<ReferenceFactor>),
    /// It has none: the matrix is not positive definite there.
    None {
        reference: Vec<f64>,
        rates: Rates,
    },
}

/// A solver with its structures and buffers.
pub struct LinearSolver {
    settings: SolverSettings,
    reference: Option<Reference>,
    symmetric: Option<Made>,
    general: Option<Made>,
    mass: Option<Made>,
    /// Diagonal that shifts are multiples of.
    diagonal: Vec<f64>,
}

impl LinearSolver {
    pub fn new(settings: SolverSettings) -> Self {
        Self { settings, reference: None, symmetric: None, general: None, mass: None, diagonal: Vec::new() }
    }

    pub fn is_matrix_free(&self) -> bool {
        self.settings.matrix_free
    }

    /// Whether the solver that was chosen solves symmetric systems only.
    pub fn wants_symmetry(&self) -> bool {
        matches!(self.settings.method, Method::Cg | Method::Direct)
    }

    /// Whether symmetric systems are to be solved by products and the factor of the reference configuration. Where the choice is free
    /// it is taken for frames, whose matrix is dear, in linearised steps, if all forces are in that factor: contact is not.
    pub fn takes_reference_factor(&self, system: &System, used_as: Use) -> bool {
        let by_choice = || {
            !self.settings.matrix_free
                && self.settings.method == Method::Auto
                && used_as == Use::Answer
                && system.kinematics.has_frames_alone()
                && system.forces.iter().all(|force| is_lasting(force.as_ref()))
        };
        match self.settings.preconditioner {
            REFERENCE_FACTOR => matches!(self.settings.method, Method::Auto | Method::Cg),
            AUTOMATIC => by_choice(),
            _ => false,
        }
    }

    /// The factor of a reference configuration, made if it is not there; `None` where it has none.
    pub fn reference_factor(
        &mut self,
        system: &System,
        reference: &[f64],
        rates: Rates,
        around: &Surroundings,
        scratches: &mut [Scratch],
    ) -> Option<&mut ReferenceFactor> {
        let is_of = |kept: &Reference| match kept {
            Reference::Made(factor) => factor.is_of(reference, rates),
            Reference::None { reference: known, rates: of } => known == reference && *of == rates,
        };
        if !self.reference.as_ref().is_some_and(is_of) {
            self.reference = None;
            let made = ReferenceFactor::new(system, reference, rates, around, scratches);
            self.reference = Some(made.map_or_else(
                |_| Reference::None { reference: reference.to_vec(), rates },
                |factor| Reference::Made(Box::new(factor)),
            ));
        }
        match self.reference.as_mut() {
            Some(Reference::Made(factor)) => Some(factor),
            _ => None,
        }
    }

    /// The model has changed: what was made of it is no longer.
    pub fn forget_reference(&mut self) {
        self.reference = None;
    }

    /// Solves `A x = b` from the `x` given, symmetric and known by its products, with the factor of the reference configuration as it has
    /// turned; `None` where the matrix itself is needed.
    pub fn solve_by_reference(
        &mut self,
        operator: &dyn LinearOperator,
        wanted: &ByReference,
        b: &[Vec3],
        x: &mut [Vec3],
    ) -> Option<Solved> {
        let Some(Reference::Made(factor)) = self.reference.as_mut() else { return None };
        let settings = Settings {
            tolerance: wanted.tolerance.max(self.settings.tolerance),
            max_iterations: self.settings.max_iterations.min(WORTH_A_MATRIX),
        };
        let mut workspace = std::mem::take(&mut factor.workspace);
        let report = conjugate_gradient(operator, &**factor, b, x, &settings, &mut workspace);
        factor.workspace = workspace;
        let stagnated_at_most = wanted.used_as.stagnated_at_most(settings.tolerance);
        let solved = Solved {
            iterations: report.iterations as u32,
            residual: report.relative_residual,
            ..Solved::default()
        };
        let counts = match report.stop {
            Stop::Converged => true,
            Stop::Stagnated => report.relative_residual <= stagnated_at_most,
            Stop::Indefinite { .. } => wanted.indefinite == Indefinite::Descend && reduce::dot(x, b) > 0.0,
            _ => false,
        };
        counts.then_some(solved)
    }

    /// Bytes of factors and preconditioners.
    pub fn bytes(&self) -> usize {
        let made = [&self.symmetric, &self.general, &self.mass].into_iter().flatten();
        let reference = match &self.reference {
            Some(Reference::Made(factor)) => factor.bytes(),
            Some(Reference::None { reference, .. }) => 8 * reference.capacity(),
            None => 0,
        };
        made.map(|made| made.solver.bytes() + 8 * made.reference.len()).sum::<usize>()
            + reference
            + 8 * self.diagonal.len()
    }

    /// Solves `A x = b`, symmetric systems by iteration from the `x` given, all others from zero.
    ///
    /// # Errors
    /// The method broke down or missed its tolerance.
    pub fn solve(&mut self, system: LinearSystem, b: &[Vec3], x: &mut [Vec3]) -> Result<Solved, LinearError> {
        let mut system = system;
        let (method, symmetric) = (self.settings.method, system.symmetric);
        if !symmetric || matches!(method, Method::Gmres | Method::Bicgstab) {
            let solved = self.solve_general(&mut system, b, x)?;
            // xᵀ A x along a solution is xᵀ b
            let curvature = reduce::dot(x, b);
            if system.indefinite == Indefinite::Refuse && curvature < 0.0 {
                let stop = Stop::Indefinite { curvature: curvature / reduce::dot(x, x) };
                return Err(LinearError::from(SolveError::NotConverged {
                    method: self.general.as_ref().map_or("gmres", |made| made.name),
                    iterations: solved.iterations as usize,
                    relative_residual: solved.residual,
                    tolerance: self.settings.tolerance,
                    stop,
                }));
            }
            return Ok(solved);
        }
        let failed = match self.solve_symmetric(&mut system, b, x) {
            Err(error @ (SolveError::NotPositiveDefinite { .. } | SolveError::NotConverged { .. })) => error,
            solved => return Ok(solved?),
        };
        let found_indefinite = match &failed {
            SolveError::NotConverged { stop, .. } => {
                matches!(stop, Stop::Indefinite { .. } | Stop::PreconditionerIndefinite)
            }
            _ => true,
        };
        match system.indefinite {
            Indefinite::Refuse => Err(failed.into()),
            _ if !found_indefinite => Err(failed.into()),
            Indefinite::Solve => Ok(self.solve_general(&mut system, b, x)?),
            Indefinite::Descend => Ok(self.descend(&mut system, failed, b, x)?),
        }
    }

    /// Solves with a mass matrix, to rounding.
    ///
    /// # Errors
    /// A mass is zero or negative.
    pub fn solve_mass(
        &mut self,
        matrix: &BlockMatrix,
        b: &[Vec3],
        x: &mut [Vec3],
    ) -> Result<Solved, LinearError> {
        let settings = SolverSettings { tolerance: 1e-13, max_iterations: 1000, ..SolverSettings::default() };
        let made = prepare(&mut self.mass, ("cg", "block_jacobi"), &settings, matrix, &[], None)?;
        x.fill(Vec3::ZERO);
        Ok(judged(made.solver.solve(matrix, b, x), STAGNATED_AT_MOST * settings.tolerance)?)
    }

    fn solve_symmetric(
        &mut self,
        system: &mut LinearSystem,
        b: &[Vec3],
        x: &mut [Vec3],
    ) -> Result<Solved, SolveError> {
        let choice = match (system.operator, self.settings.method) {
            (Some(_), _) => ("cg", WITHOUT_MATRIX),
            (None, Method::Cg) => ("cg", self.settings.of_table()),
            (None, Method::Direct) => ("direct", AUTOMATIC),
            (None, _) => ("auto", self.settings.of_table()),
        };
        let made = prepare(
            &mut self.symmetric,
            choice,
            &self.settings,
            system.matrix,
            system.reference,
            Some((system.kinematics, system.positions)),
        )?;
        made.solver.set_tolerance(system.tolerance.max(self.settings.tolerance));
        judged(
            made.solver.solve(system.operator.unwrap_or(&*system.matrix), b, x),
            system.stagnated_at_most(self.settings.tolerance),
        )
    }

    fn solve_general(
        &mut self,
        system: &mut LinearSystem,
        b: &[Vec3],
        x: &mut [Vec3],
    ) -> Result<Solved, SolveError> {
        let is_stored = system.operator.is_none();
        let automatic = match system.nearby {
            Some(_) => AUTOMATIC,
            None => WITHOUT_MATRIX,
        };
        let given = self.settings.of_table();
        let preconditioner = if given == AUTOMATIC || !is_stored { automatic } else { given };
        let is_small = system.matrix.pattern().block_count() < LU_BELOW;
        let patience = match system.indefinite {
            Indefinite::Refuse if !system.symmetric => PATIENCE.min(self.settings.max_iterations),
            _ => self.settings.max_iterations,
        };
        let name = match self.settings.method {
            Method::Bicgstab => "bicgstab",
            Method::Direct if is_stored => "lu",
            Method::Auto if is_stored && is_small && system.nearby.is_none() => "lu",
            _ => "gmres",
        };
        let mut attempt = |name: &'static str, preconditioner: &'static str| {
            let made = prepare(
                &mut self.general,
                (name, preconditioner),
                &self.settings,
                system.nearby.filter(|_| name != "lu").unwrap_or(&*system.matrix),
                system.reference,
                Some((system.kinematics, system.positions)),
            )?;
            x.fill(Vec3::ZERO);
            made.solver.set_tolerance(system.tolerance.max(self.settings.tolerance));
            made.solver.limit_iterations(patience);
            judged(
                made.solver.solve(system.operator.unwrap_or(&*system.matrix), b, x),
                system.stagnated_at_most(self.settings.tolerance),
            )
        };
        let attempted = attempt(name, preconditioner);
        match &attempted {
            _ if system.indefinite == Indefinite::Refuse => attempted,
            Err(SolveError::NotPositiveDefinite { .. } | SolveError::NotConverged { .. })
                if is_stored && is_small && name == "gmres" && self.settings.method == Method::Auto =>
            {
                attempt("lu", preconditioner)
            }
            Err(SolveError::NotPositiveDefinite { .. }) => attempt(name, "none"),
            _ => attempted,
        }
    }

    /// A direction of descent where the matrix is not positive definite: where conjugate gradients were stopped
    /// by negative curvature (Nocedal & Wright 2006, §7.1), and if they had not begun, that of a shifted
    /// matrix (§3.4).
    fn descend(
        &mut self,
        system: &mut LinearSystem,
        failed: SolveError,
        b: &[Vec3],
        x: &mut [Vec3],
    ) -> Result<Solved, SolveError> {
        if let SolveError::NotConverged {
            iterations, relative_residual, stop: Stop::Indefinite { .. }, ..
        } = failed
            && reduce::dot(x, b) > 0.0
        {
            return Ok(Solved {
                iterations: iterations as u32,
                residual: relative_residual,
                ..Solved::default()
            });
        }
        let mean = system.matrix.mean_diagonal().abs();
        if system.operator.is_some() {
            // products cannot be shifted here: the steepest direction, in the scale of the diagonal
            x.iter_mut().zip(b).for_each(|(x, b)| *x = *b * (1.0 / mean));
            return Ok(Solved { residual: 1.0, ..Solved::default() });
        }
        let pattern = Arc::clone(system.matrix.pattern());
        self.diagonal.clear();
        self.diagonal.extend(
            (0..pattern.block_count()).map(|row| (system.matrix.diagonal_block(row).trace() / 3.0).max(mean)),
        );
        let mut last = failed;
        let mut before = 0.0;
        for shift in SHIFTS {
            // A + σ diag(A)
            for (row, diagonal) in self.diagonal.iter().enumerate() {
                let block = &mut system.matrix.values_mut()[pattern.diagonal_slot(row)];
                *block = block.plus_diagonal((shift - before) * diagonal);
            }
            before = shift;
            x.fill(Vec3::ZERO);
            match self.solve_symmetric(system, b, x) {
                Err(SolveError::NotConverged {
                    iterations,
                    relative_residual,
                    stop: Stop::Indefinite { .. },
                    ..
                }) if reduce::dot(x, b) > 0.0 => {
                    return Ok(Solved {
                        iterations: iterations as u32,
                        residual: relative_residual,
                        ..Solved::default()
                    });
                }
                Err(error) => last = error,
                solved => return solved,
            }
        }
        Err(last)
    }
}

/// The solver in `slot`, made anew if it was made for something else, following `matrix`.
fn prepare<'a>(
    slot: &'a mut Option<Made>,
    (name, preconditioner): (&'static str, &'static str),
    settings: &SolverSettings,
    matrix: &BlockMatrix,
    reference: &[f64],
    places: Option<(&Kinematics, &[Vec3])>,
) -> Result<&'a mut Made, SolveError> {
    let fits = |made: &Made| {
        (made.name, made.preconditioner) == (name, preconditioner)
            && (Arc::ptr_eq(&made.pattern, matrix.pattern()) || made.pattern == *matrix.pattern())
            && made.reference == reference
    };
    if !slot.as_ref().is_some_and(fits) {
        *slot = None;
        let solver =
            build((name, preconditioner), settings, matrix, reference, places.map(|places| places.0))?;
        let pattern = Arc::clone(matrix.pattern());
        *slot = Some(Made { name, preconditioner, pattern, reference: reference.to_vec(), solver });
    }
    let made = slot.as_mut().unwrap_or_else(|| unreachable!("just made"));
    if let Some((_, positions)) = places {
        made.solver.follow(positions)?;
    }
    made.solver.update(matrix)?;
    Ok(made)
}

fn build(
    (name, preconditioner): (&'static str, &'static str),
    settings: &SolverSettings,
    matrix: &BlockMatrix,
    reference: &[f64],
    kinematics: Option<&Kinematics>,
) -> Result<Box<dyn solvers::LinearSolver>, SolveError> {
    let entry =
        solvers::TABLE.find(name).unwrap_or_else(|error| panic!("the table has this solver: {error}"));
    let declares = |name: &str| entry.parameters.iter().any(|parameter| parameter.name == name);
    let mut values = Values::new().with("tolerance", Value::Number(settings.tolerance));
    if declares("max_iterations") {
        values.set("max_iterations", Value::Integer(settings.max_iterations as i64));
    }
    if declares("preconditioner") {
        values.set("preconditioner", Value::Text(preconditioner));
    }
    let values =
        entry.values(values).unwrap_or_else(|error| panic!("checked with the stepper's own: {error}"));
    let places = kinematics.map(|kinematics| places(kinematics, reference));
    let geometry = places.as_ref().map_or_else(Geometry::default, |(coordinates, roles)| Geometry {
        coordinates: Some(coordinates),
        roles: roles.as_deref(),
    });
    (entry.build.build)(&values, matrix, geometry)
}

/// Places and roles of all velocity blocks in a configuration.
fn places(kinematics: &Kinematics, reference: &[f64]) -> (Vec<Vec3>, Option<Vec<BlockRole>>) {
    let row = |row: usize| Vec3::new(reference[3 * row], reference[3 * row + 1], reference[3 * row + 2]);
    let mut places = Vec::with_capacity(kinematics.block_count());
    let mut roles = Vec::with_capacity(kinematics.block_count());
    let mut first = 0;
    for (kind, blocks) in kinematics.unknowns() {
        places.extend(blocks.clone().map(|_| row(first)));
        roles.push(BlockRole::Point);
        match kind {
            UnknownKind::Point => {}
            UnknownKind::RigidFrame => roles.push(BlockRole::Rotation),
            // a rigid motion moves no amplitude
            UnknownKind::FloatingFrame { .. } => {
                roles.push(BlockRole::Rotation);
                roles.extend(blocks.skip(2).map(|_| BlockRole::Axis(Vec3::ZERO)));
            }
            UnknownKind::AffineFrame | UnknownKind::QuadraticFrame => {
                roles.extend((1..kind.row_count()).map(|axis| BlockRole::Axis(row(first + axis))));
            }
        }
        first += kind.row_count();
    }
    (places, kinematics.has_frames().then_some(roles))
}

/// Counts a solve that only rounding ended, where its residual is no more than `at_most`.
fn judged(
    solved: Result<souple_solve::krylov::Report, SolveError>,
    at_most: f64,
) -> Result<Solved, SolveError> {
    match solved {
        Ok(report) => Ok(Solved {
            iterations: report.iterations as u32,
            residual: report.relative_residual,
            ..Solved::default()
        }),
        Err(SolveError::NotConverged { iterations, relative_residual, stop: Stop::Stagnated, .. })
            if relative_residual <= at_most =>
        {
            Ok(Solved { iterations: iterations as u32, residual: relative_residual, ..Solved::default() })
        }
        Err(error) => Err(error),
    }
}
