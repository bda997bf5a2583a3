//! What can be read off a solid: stress and energy per cell.

use souple_math::{Mat3, Vec3};

use super::SolidForce;
use crate::materials::cauchy_stress;

/// Means over the volume of a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CellField {
    /// Deformation gradient.
    pub deformation: Mat3,
    /// First Piola–Kirchhoff stress [Pa].
    pub stress: Mat3,
    /// Cauchy stress [Pa]; zero where the cell has no volume.
    pub cauchy: Mat3,
    /// `√(3/2 s:s)` of the deviator `s` of the Cauchy stress [Pa].
    pub von_mises: f64,
    /// Stored energy per rest volume [J/m³].
    pub energy_density: f64,
    /// Rest volume [m³].
    pub volume: f64,
}

impl SolidForce {
    /// Fields of one cell at row positions.
    pub fn cell_field(&self, cell: usize, positions: &[Vec3]) -> Option<CellField> {
        let view = self.mesh().cell(cell as u32)?;
        let material = self.material(cell);
        let at = |place: &dyn Fn(usize) -> Vec3| -> Vec<Vec3> {
            view.nodes.iter().map(|node| place(*node as usize)).collect()
        };
        let rest = at(&|node| self.mesh().points[node]);
        let now = at(&|node| positions[self.rows().start + node]);
        let mut sum = CellField {
            deformation: Mat3::ZERO,
            stress: Mat3::ZERO,
            cauchy: Mat3::ZERO,
            von_mises: 0.0,
            energy_density: 0.0,
            volume: 0.0,
        };
        for point in &self.quadrature().rule(view.kind).points {
            let jacobian = view.kind.jacobian(&rest, point.position);
            let volume = jacobian.determinant() * point.weight;
            let F = view.kind.jacobian(&now, point.position) * jacobian.try_inverse()?;
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
        })
    }
}
