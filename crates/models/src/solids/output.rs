//! What can be read off a solid: stress and energy per cell.

use souple_engine::CellField;
use souple_math::{Mat3, Vec3};

use super::geometry::{AnyElement, Geometry};
use super::layout::LANES;
use super::section::Completed;
use super::{Section, SolidForce, turned};
use crate::materials::{MaterialLaw, cauchy_stress, von_mises};

impl SolidForce {
    /// Fields of one cell at row positions.
    pub(super) fn field_of_cell(&self, cell: usize, positions: &[Vec3]) -> Option<CellField> {
        let (batch, chunk, slot) = self.place(cell)?;
        let kind = batch.kind;
        let material = self.oriented(cell);
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
        let mut current_volume = 0.0;
        let samples = self.quadrature().rule(kind).points.len();
        for (sample, reference) in batch.reference.chunks_exact(now.len()).enumerate() {
            let (inverse, volume) = chunk.sample_of(slot, sample, samples);
            let gradient = AnyElement::gradient(&now, reference) * inverse;
            let (F, is_slack) = self.completed(cell, gradient);
            sum.deformation += F * volume;
            sum.volume += volume;
            if is_slack {
                // its matter is at rest, wherever its ends are
                current_volume += volume;
                continue;
            }
            let P = material.stress(&F);
            sum.stress += P * volume;
            sum.cauchy += cauchy_stress(&P, &F).unwrap_or(Mat3::ZERO) * volume;
            sum.energy_density += material.energy_density(&F) * volume;
            current_volume += F.determinant() * volume;
        }
        let mean = 1.0 / sum.volume;
        let cauchy = sum.cauchy * mean;
        Some(CellField {
            deformation: sum.deformation * mean,
            stress: sum.stress * mean,
            cauchy,
            von_mises: von_mises(&cauchy),
            energy_density: sum.energy_density * mean,
            volume: sum.volume,
            // by the rule that is exact for the determinant, whatever the samples of the law
            current_volume: if self.section == Section::Solid {
                let rule = if kind.is_linear() { kind.default_rule() } else { kind.mass_rule() };
                rule.points
                    .iter()
                    .map(|point| point.weight * kind.jacobian(&now, point.position).determinant())
                    .sum()
            } else {
                current_volume
            },
        })
    }

    /// Volume of a cell at rest [m³].
    pub(super) fn rest_volume_of(&self, cell: usize) -> Option<f64> {
        let (batch, chunk, slot) = self.place(cell)?;
        let samples = self.quadrature().rule(batch.kind).points.len();
        Some((0..samples).map(|sample| chunk.volume_of(slot, sample, samples)).sum())
    }

    /// The deformation gradient with what the section says of the directions across, of bars in their own frame; and whether
    /// it is that of a cable that is slack.
    pub(super) fn completed(&self, cell: usize, F: Mat3) -> (Mat3, bool) {
        if self.section == Section::Solid {
            return (F, false);
        }
        let number = usize::from(self.material_of_cell[cell]);
        let numbers = match (&self.materials[number].law, self.axes.get(cell)) {
            (MaterialLaw::Text(_), Some(axes)) => turned::numbers(axes).to_vec(),
            _ => self.materials[number].parameters.to_vec(),
        };
        let parameters: Vec<f64> = numbers.iter().flat_map(|number| [*number; LANES]).collect();
        let entries: [f64; 9] = std::array::from_fn(|e| F.columns[e / 3].to_array()[e % 3]);
        let row = entries.map(|entry| [entry; LANES]);
        let completed = Completed::new(self.section, self.row_laws[number].as_ref(), &parameters, row);
        let entry = |i: usize| completed.F[i][0];
        let column = |i: usize| Vec3::new(entry(3 * i), entry(3 * i + 1), entry(3 * i + 2));
        (Mat3::from_columns(column(0), column(1), column(2)), completed.is_slack(0))
    }
}
