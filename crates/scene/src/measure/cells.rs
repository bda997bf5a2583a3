//! Quantities of cells: means over each cell.

use souple_engine::{Configuration, Force, World};
use souple_math::eigen_symmetric;

use super::CellPart;
use crate::spec::quantity::CellQuantity;

/// Values and rest volumes of the cells of a part.
pub fn measure(quantity: CellQuantity, part: &CellPart, world: &World) -> (Vec<f64>, Vec<f64>) {
    let Some((solid, at)) = world.force_named(part.system, &part.solid) else {
        return (vec![f64::NAN], vec![1.0]);
    };
    part.cells.iter().filter_map(|cell| value(quantity, solid, *cell as usize, &at)).unzip()
}

/// The value of one cell and its rest volume.
fn value(quantity: CellQuantity, solid: &dyn Force, cell: usize, at: &Configuration) -> Option<(f64, f64)> {
    // what needs no stress
    let of_law = match quantity {
        CellQuantity::Law => solid.adapted_law(cell, at),
        CellQuantity::Excess => solid.adapted(cell, at).map(|adapted| adapted.excess),
        _ => None,
    };
    if let Some(of_law) = of_law {
        return Some((of_law, solid.rest_volume(cell)?));
    }
    let field = solid.cell_field_at(cell, at)?;
    // eigenvalues fall; those of FᵀF are the squares of the stretches
    let principal_stress = || eigen_symmetric(&field.cauchy).values;
    let stretch_sq = || eigen_symmetric(&field.deformation.transpose_mul(&field.deformation)).values;
    let value = match quantity {
        CellQuantity::VonMises => field.von_mises,
        // tension is positive in stresses, compression in pressures
        CellQuantity::Pressure => -field.cauchy.trace() / 3.0,
        CellQuantity::MaxPrincipalStress => principal_stress().x,
        CellQuantity::MinPrincipalStress => principal_stress().z,
        CellQuantity::MaxPrincipalStretch => stretch_sq().x.max(0.0).sqrt(),
        CellQuantity::MinPrincipalStretch => stretch_sq().z.max(0.0).sqrt(),
        CellQuantity::StrainEnergy => field.energy_density * field.volume,
        CellQuantity::StrainEnergyDensity => field.energy_density,
        CellQuantity::Volume => field.current_volume,
        CellQuantity::Law | CellQuantity::Excess => return None,
        CellQuantity::VolumeRatio => field.current_volume / field.volume,
    };
    Some((value, field.volume))
}
