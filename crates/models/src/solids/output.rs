//! What can be read off a solid: stress and energy per cell.

use souple_engine::CellField;
use souple_math::{Mat3, Vec3};

use super::SolidForce;
use crate::materials::cauchy_stress;

impl SolidForce {
    /// Fields of one cell at row positions.
    pub(super) fn field_of_cell(&self, cell: usize, positions: &[Vec3]) -> Option<CellField> {
        let (batch, chunk, slot) = self.place(cell)?;
        let kind = batch.kind;
        let material = self.material(cell);
        let rows = chunk.rows_of(slot, kind.node_count());
        let now: Vec<Vec3> = rows.map(|row| positions[row as usize]).collect();
        let mut sum = CellField {
            deformation: Mat3::ZERO,
            stress: Mat3::ZERO,
            cauchy: Mat3::ZERO,
            von_mises: 0.0,
            energy_density: 0.0,
            volume: 0.0,
            current_volume: 0.0,
        };
        let points = &self.quadrature().rule(kind).points;
        for (sample, point) in points.iter().enumerate() {
            let (inverse, volume) = chunk.sample_of(slot, sample, points.len());
            let F = kind.jacobian(&now, point.position) * inverse;
            let P = material.stress(&F);
            sum.deformation += F * volume;
            sum.stress += P * volume;
            sum.cauchy += cauchy_stress(&P, &F).unwrap_or(Mat3::ZERO) * volume;
            sum.energy_density += material.energy_density(&F) * volume;
            sum.volume += volume;
        }
        let mean = 1.0 / sum.volume;
        let cauchy = sum.cauchy * mean;
        let deviator = cauchy.plus_diagonal(-cauchy.trace() / 3.0);
        Some(CellField {
            deformation: sum.deformation * mean,
            stress: sum.stress * mean,
            cauchy,
            von_mises: (1.5 * deviator.dot(&deviator)).sqrt(),
            energy_density: sum.energy_density * mean,
            volume: sum.volume,
            // by the rule that is exact for the determinant, whatever the samples of the law
            current_volume: kind
                .default_rule()
                .points
                .iter()
                .map(|point| point.weight * kind.jacobian(&now, point.position).determinant())
                .sum(),
        })
    }
}
