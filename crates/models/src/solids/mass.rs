//! Mass of a body from its shape and densities.
//!
//! Densities are per measure of a cell: of a section, the density times its thickness or area.

use souple_engine::Mass;
use souple_math::Vec3;
use souple_mesh::{Cell, MAX_NODES, Mesh, QuadratureRule, VoronoiCells};

/// Adds the mass of every cell to those of its nodes' rows. Call [`Mass::seal`] when all bodies are in.
///
/// Of linear cells these are the row sums of the consistent mass, `∫ρ N_a dV`: a quarter of the cell for the corners of a
/// tetrahedron. Row sums of quadratic cells are negative at corners; there the diagonal of the consistent mass is scaled
/// to the mass of the cell (Hinton, Rock & Zienkiewicz 1976): `m_a = m ∫N_a² dV / Σ_b ∫N_b² dV`.
pub fn lumped_mass(mesh: &Mesh, first_row: usize, density_of_cell: &dyn Fn(usize) -> f64, mass: &mut Mass) {
    for (index, cell) in mesh.cells().enumerate() {
        let density = density_of_cell(index);
        if cell.kind.is_linear() {
            over_samples(mesh, cell, 2, |shape, volume| {
                for (node, weight) in cell.nodes.iter().zip(shape) {
                    let row = node + first_row as u32;
                    mass.add(row, row, density * volume * weight);
                }
            });
            continue;
        }
        let (mut total, mut diagonal) = (0.0, [0.0; MAX_NODES]);
        over_samples(mesh, cell, 4, |shape, volume| {
            total += volume;
            diagonal.iter_mut().zip(shape).for_each(|(sum, weight)| *sum += volume * weight * weight);
        });
        let scale = density * total / diagonal.iter().sum::<f64>();
        for (node, share) in cell.nodes.iter().zip(diagonal) {
            let row = node + first_row as u32;
            mass.add(row, row, share * scale);
        }
    }
}

/// Adds the whole mass in equal parts to the points of the cells, whatever their share of the volume: what one simulates
/// to compare with programs that know no other mass. Call [`Mass::seal`] when all bodies are in.
pub fn uniform_mass(mesh: &Mesh, first_row: usize, density_of_cell: &dyn Fn(usize) -> f64, mass: &mut Mass) {
    let mut of_points = Mass::new(mesh.points.len());
    lumped_mass(mesh, 0, density_of_cell, &mut of_points);
    // points of no cell have no part
    let count = of_points.diagonal.iter().filter(|share| **share > 0.0).count();
    let share = of_points.diagonal.iter().sum::<f64>() / count as f64;
    for (point, _) in of_points.diagonal.iter().enumerate().filter(|(_, own)| **own > 0.0) {
        let row = (first_row + point) as u32;
        mass.add(row, row, share);
    }
}

/// Adds to each point the mass of all that is nearer to it than to any other, within the body (Debunne 2000, 4 §4.2); `None`, and nothing
/// is added, of cells other than linear tetrahedra and triangles. Call [`Mass::seal`] when all bodies are in.
#[must_use]
pub fn voronoi_mass(
    mesh: &Mesh,
    first_row: usize,
    density_of_cell: &dyn Fn(usize) -> f64,
    mass: &mut Mass,
) -> Option<()> {
    for part in VoronoiCells::of(mesh)?.parts {
        let row = part.point + first_row as u32;
        mass.add(row, row, density_of_cell(part.element as usize) * part.volume);
    }
    Some(())
}

/// Adds `∫ρ N_a N_b dV` of every cell. Call [`Mass::seal`] when all bodies are in.
pub fn consistent_mass(
    mesh: &Mesh,
    first_row: usize,
    density_of_cell: &dyn Fn(usize) -> f64,
    mass: &mut Mass,
) {
    for (index, cell) in mesh.cells().enumerate() {
        let density = density_of_cell(index);
        // over all samples before rows: one coupling for each pair of nodes, not one for each sample
        let mut own = [[0.0; MAX_NODES]; MAX_NODES];
        over_samples(mesh, cell, 4, |shape, volume| {
            for (own, weight_a) in own.iter_mut().zip(shape) {
                for (own, weight_b) in own.iter_mut().zip(shape) {
                    *own += density * volume * weight_a * weight_b;
                }
            }
        });
        for (own, a) in own.iter().zip(cell.nodes) {
            for (own, b) in own.iter().zip(cell.nodes) {
                mass.add(a + first_row as u32, b + first_row as u32, *own);
            }
        }
    }
}

/// Calls `add(N, V)` at the samples of a rule of the given degree, or of the finest there is.
fn over_samples(mesh: &Mesh, cell: Cell<'_>, degree: usize, mut add: impl FnMut(&[f64], f64)) {
    let finest = || cell.kind.rules().last().unwrap_or_else(|| cell.kind.default_rule());
    let rule: &QuadratureRule = cell.kind.rule_of_degree(degree).unwrap_or_else(finest);
    let mut buffer = [Vec3::ZERO; MAX_NODES];
    let positions = mesh.positions_into(cell.nodes, &mut buffer);
    for point in &rule.points {
        let volume = cell.kind.jacobian(positions, point.position).determinant() * point.weight;
        add(&cell.kind.shape(point.position), volume);
    }
}
