//! A preconditioner for what turns more than it stretches: the factor of the step's matrix where all stood first, turned with
//! what carries it.
//!
//! Matter that has been turned resists as it did, in turned directions: with a rotation `R` of each unknown, `A ≈ R A₀ Rᵀ`, so a
//! residual is turned back, solved for with the factor of `A₀`, and the solution is turned on. No matrix is assembled after the
//! first. Stretch, contact and what else `A` has beside `A₀` costs iterations (Courtecuisse, Allard, Duriez & Cotin 2010,
//! "Asynchronous preconditioners for efficient solving of non-linear deformations"; there the factor is of some earlier step).
//!
//! `A₀` depends on the model, on the rates of the formula and on a reference configuration that lives in State, so that a run that is
//! resumed has the bits of one that was not.

use std::sync::Arc;

use souple_math::{Mat3, Vec3, polar};
use souple_solve::krylov::ConjugateGradientWorkspace;
use souple_solve::{
    BlockMatrix, DirectSolver, LinearOperator, Pattern, Preconditioner, RoundedFactor, SolveError,
};

use crate::force::Scratch;
use crate::implicit::Rates;
use crate::kinematics::{Kinematics, UnknownKind};
use crate::state::SystemState;
use crate::system::{Rows, Surroundings, System};
use crate::tangent::{Linearisation, Tangent};

/// The factor of `A₀`, in single precision where that keeps enough of it: what it lacks costs no more than a part of an iteration.
enum Factor {
    Rounded(Box<RoundedFactor>),
    Whole(Box<DirectSolver>),
}

/// The factor of `A₀`, and how unknowns have turned since.
pub struct ReferenceFactor {
    factor: Factor,
    pattern: Arc<Pattern>,
    /// Free rows of the reference configuration.
    reference: Vec<Vec3>,
    rates: Rates,
    /// Of every block.
    turns: Vec<Mat3>,
    /// A third of the trace of every diagonal block of `A₀`.
    diagonal: Vec<f64>,
    pub workspace: ConjugateGradientWorkspace,
}

impl ReferenceFactor {
    /// # Errors
    /// `A₀` is not positive definite.
    pub fn new(
        system: &System,
        reference: &[f64],
        rates: Rates,
        around: &Surroundings,
        scratches: &mut [Scratch],
    ) -> Result<Self, SolveError> {
        let kinematics = &system.kinematics;
        let reference: Vec<Vec3> = bytemuck::cast_slice(reference).to_vec();
        let at_rest = vec![Vec3::ZERO; kinematics.block_count()];
        let row = || vec![Vec3::ZERO; kinematics.row_count()];
        let mut rows = Rows { positions: row(), velocities: row(), time: 0.0 };
        system.place_rows(&reference, &at_rest, 0.0, &mut rows);
        // forces whose tangent reads memory or couples what they meet are not asked: nothing of a later state may come in
        let driven = vec![0.0; around.driven.len()];
        let memory: usize = system.forces.iter().map(|force| force.memory_len()).sum();
        let at = Linearisation {
            system,
            state: &SystemState { memory: vec![0.0; memory], ..SystemState::default() },
            around: Surroundings { driven: &driven, load: 1.0, ..*around },
            rows: &rows,
            q: &reference,
            v: &at_rest,
            rates,
            unbalanced: &row(),
        };
        let mut tangent = Tangent::of_lasting_forces();
        let matrix = tangent.assemble(&at, scratches);
        let mut block_positions = Vec::new();
        system.block_positions_into(&rows.positions, &mut block_positions);
        let mut factor = DirectSolver::analyse(matrix.pattern(), Some(&block_positions))?;
        factor.factorize(matrix)?;
        let diagonal = (0..matrix.block_count()).map(|block| matrix.diagonal_block(block).trace() / 3.0);
        let (diagonal, pattern) = (diagonal.collect(), Arc::clone(matrix.pattern()));
        let factor =
            factor.into_rounded().map_or_else(Factor::Whole, |rounded| Factor::Rounded(Box::new(rounded)));
        Ok(Self {
            diagonal,
            pattern,
            turns: vec![Mat3::IDENTITY; matrix.block_count()],
            workspace: ConjugateGradientWorkspace::new(matrix.block_count()),
            reference,
            rates,
            factor,
        })
    }

    /// Whether it is that of a reference configuration and of rates.
    pub fn is_of(&self, reference: &[f64], rates: Rates) -> bool {
        self.rates == rates && bytemuck::cast_slice::<Vec3, f64>(&self.reference) == reference
    }

    /// Takes note of how unknowns have turned.
    pub fn follow(&mut self, kinematics: &Kinematics, q: &[Vec3]) {
        let Self { pattern, reference, turns, .. } = self;
        let axes = |q: &[Vec3], row: usize| Mat3::from_columns(q[row + 1], q[row + 2], q[row + 3]);
        let mut row = 0;
        for (kind, blocks) in kinematics.unknowns() {
            let turn = match kind {
                UnknownKind::Point => turn_of_point(kinematics, pattern, blocks.start, reference, q),
                UnknownKind::RigidFrame | UnknownKind::FloatingFrame { .. } => {
                    axes(q, row).mul_transpose(&axes(reference, row))
                }
                UnknownKind::AffineFrame | UnknownKind::QuadraticFrame => {
                    polar(&axes(q, row).mul_transpose(&axes(reference, row))).rotation
                }
            };
            // amplitudes are those of shapes that turn along
            let turning = if matches!(kind, UnknownKind::FloatingFrame { .. }) { 2 } else { blocks.len() };
            turns[blocks.start..blocks.start + turning].fill(turn);
            row += kind.row_count();
        }
    }

    /// A third of the trace of a diagonal block, as it was in the reference configuration.
    pub fn diagonal(&self) -> &[f64] {
        &self.diagonal
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let factor = match &self.factor {
            Factor::Rounded(factor) => factor.bytes(),
            Factor::Whole(factor) => factor.bytes(),
        };
        factor
            + size_of::<Vec3>() * self.reference.capacity()
            + size_of::<Mat3>() * self.turns.capacity()
            + 8 * self.diagonal.capacity()
            + 4 * size_of::<Vec3>() * self.turns.len()
    }
}

/// The rotation that comes closest to what the points coupled with a point have done about it.
fn turn_of_point(
    kinematics: &Kinematics,
    pattern: &Pattern,
    block: usize,
    reference: &[Vec3],
    q: &[Vec3],
) -> Mat3 {
    let row_of = |block: u32| kinematics.point_block_row(block).map(|row| row as usize);
    let Some(own) = row_of(block as u32) else { return Mat3::IDENTITY };
    let mut moved = Mat3::ZERO;
    for row in pattern.row(block).iter().filter_map(|block| row_of(*block)) {
        moved += (q[row] - q[own]).outer(reference[row] - reference[own]);
    }
    polar(&moved).rotation
}

impl Preconditioner for ReferenceFactor {
    fn update(&mut self, _: &BlockMatrix) -> Result<(), SolveError> {
        Ok(())
    }

    // R A₀⁻¹ Rᵀ
    fn apply(&self, r: &[Vec3], z: &mut [Vec3]) {
        for ((z, r), turn) in z.iter_mut().zip(r).zip(&self.turns) {
            *z = turn.transpose_apply(*r);
        }
        match &self.factor {
            Factor::Rounded(factor) => factor.solve(z),
            Factor::Whole(factor) => {
                if factor.solve(z).is_err() {
                    z.copy_from_slice(r);
                    return;
                }
            }
        }
        for (z, turn) in z.iter_mut().zip(&self.turns) {
            *z = *turn * *z;
        }
    }

    fn bytes(&self) -> usize {
        Self::bytes(self)
    }
}
