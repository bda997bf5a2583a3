//! Kelvin–Voigt damping of bending: moments in proportion to the rate of the curvature, none in rigid motion.

use std::any::Any;
use std::sync::Arc;

use souple_engine::state::Pair;
use souple_engine::tangent::add_block;
use souple_engine::{Configuration, Declaration, Energy, Force, Scratch, TangentWeights};
use souple_math::{Mat3, Vec3};
use souple_solve::BlockMatrix;

use super::{BendingScratch, ROWS, Shell};

/// `f = -Σ_T A (∂κ/∂x)ᵀ C κ̇` with moments `C κ̇` of the rate of the curvature [N m s]. Memory keeps account of the heat,
/// `∫ Σ_T A κ̇·C κ̇ dt` [J].
pub struct BendingDamping {
    name: String,
    shell: Arc<Shell>,
    is_internal: bool,
}

impl BendingDamping {
    pub(super) fn new(name: String, shell: Arc<Shell>, is_internal: bool) -> Self {
        Self { name, shell, is_internal }
    }

    /// Angles and their rates, and what moments these have.
    fn resist(&self, at: &Configuration, scratch: &mut BendingScratch) {
        self.shell.fold(at, scratch);
        let BendingScratch { angles, turned, moments, .. } = scratch;
        self.shell.turning_into(angles, at.velocities, turned);
        turned.iter_mut().zip(angles.iter()).for_each(|(rate, angle)| *rate += angle.drift);
        self.shell.moments_into(&self.shell.viscosity, turned, moments);
    }

    /// How the rate of the curvature of a triangle changes where its rows move, as they are moving: `Σ_e g_e (∂²θ_e/∂x² v)`.
    fn turning_slopes(
        &self,
        triangle: usize,
        (at, scratch): (&Configuration, &BendingScratch),
    ) -> [Mat3; ROWS] {
        let bent = &self.shell.bent[triangle];
        let mut slopes = [Mat3::ZERO; ROWS];
        for ((number, curvature), corners) in bent.folds().zip(&bent.corners) {
            let fold = &self.shell.folds[number];
            let hessian = fold.hessian(at.positions, |leader| scratch.leaders[leader as usize]);
            for b in 0..fold.point_count() {
                let turned: Vec3 = (0..fold.point_count())
                    .map(|a| hessian[a][b].transpose_apply(at.velocities[fold.rows[a] as usize]))
                    .sum();
                slopes[usize::from(corners[b])] += curvature.outer(turned);
            }
        }
        slopes
    }
}

impl Force for BendingDamping {
    fn name(&self) -> &str {
        &self.name
    }

    fn acts_within(&self) -> bool {
        true
    }

    fn declaration(&self) -> Declaration {
        Declaration {
            conservative: false,
            velocity_terms: true,
            symmetric_tangent: false,
            internal: self.is_internal,
            ..Declaration::ELASTIC
        }
    }

    fn memory_len(&self) -> usize {
        1
    }

    // it is an account of heat
    fn tangent_reads_memory(&self) -> bool {
        false
    }

    fn new_scratch(&self) -> Scratch {
        self.shell.new_scratch()
    }

    fn energy(&self, at: &Configuration, _: &mut Scratch) -> Energy {
        Energy { stored: 0.0, dissipated: at.memory[0] }
    }

    fn add_force(&self, at: &Configuration, scratch: &mut Scratch, out: &mut [Vec3]) {
        let scratch = BendingScratch::of(scratch);
        self.resist(at, scratch);
        self.shell.push(&scratch.angles, &scratch.moments, out);
    }

    // δf = -Σ_e (δM_e ∂θ_e/∂x + M_e ∂²θ_e/∂x² δx),  δM = C (b ∂κ/∂x δ + a δ(κ̇))
    fn add_differential(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        delta: &[Vec3],
        scratch: &mut Scratch,
        out: &mut [Vec3],
    ) {
        let scratch = BendingScratch::of(scratch);
        self.resist(at, scratch);
        let BendingScratch { leaders, angles, moments, turning, resisting, .. } = scratch;
        self.shell.turning_into(angles, delta, turning);
        turning.iter_mut().for_each(|turning| *turning *= weights.velocity);
        if weights.position != 0.0 {
            for ((fold, turning), moment) in self.shell.folds.iter().zip(turning.iter_mut()).zip(&*moments) {
                let hessian = fold.hessian(at.positions, |number| leaders[number as usize]);
                for a in 0..fold.point_count() {
                    let turned: Vec3 =
                        (0..fold.point_count()).map(|b| hessian[a][b] * delta[fold.rows[b] as usize]).sum();
                    *turning += weights.position * turned.dot(at.velocities[fold.rows[a] as usize]);
                    out[fold.rows[a] as usize] -= turned * (weights.position * moment);
                }
            }
        }
        self.shell.moments_into(&self.shell.viscosity, turning, resisting);
        self.shell.push(angles, resisting, out);
    }

    fn visit_cliques(&self, _pairs: &[Pair], visit: &mut dyn FnMut(&[u32])) {
        self.shell.bent.iter().for_each(|bent| visit(bent.rows()));
    }

    fn add_blocks(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        scratch: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) {
        self.add_symmetric_blocks(at, weights, scratch, matrix);
        if weights.position == 0.0 {
            return;
        }
        let scratch = BendingScratch::of(scratch);
        for (number, bent) in self.shell.bent.iter().enumerate() {
            let slopes = bent.slopes(&self.shell.folds, &scratch.angles);
            let turning = self.turning_slopes(number, (at, scratch));
            for (row, slope) in bent.rows().iter().zip(&slopes) {
                let left = slope.transpose_mul(&self.shell.viscosity[number]) * -weights.position;
                for (column, turning) in bent.rows().iter().zip(&turning) {
                    add_block(matrix, *row as usize, *column as usize, &(left * *turning));
                }
            }
        }
        self.shell.add_turning_blocks(scratch, at.positions, -weights.position, matrix);
    }

    // that of rates, which never pushes on
    fn add_symmetric_blocks(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        scratch: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) {
        let scratch = BendingScratch::of(scratch);
        self.resist(at, scratch);
        self.shell.add_curvature_blocks(&self.shell.viscosity, &scratch.angles, -weights.velocity, matrix);
    }

    // heat: ∫ κ̇·C κ̇ dA dt
    fn advance_memory(&self, at: &Configuration, timestep: f64, memory: &mut [f64], _pairs: &mut [Pair]) {
        memory[0] += timestep * self.shell.power(at);
    }

    fn bytes(&self) -> usize {
        0
    }

    fn scratch_bytes(&self, scratch: &Scratch) -> usize {
        scratch.downcast_ref().map_or(0, BendingScratch::bytes)
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}
