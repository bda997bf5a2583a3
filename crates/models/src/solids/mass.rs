//! Mass of a body from its shape and densities.

use souple_engine::Mass;
use souple_math::Vec3;
use souple_mesh::{Mesh, QuadratureRule};

/// Adds `∫ρ N_a dV` of every cell to the mass of row `first_row + a`: the row sums of the consistent mass, and
/// a quarter of the cell for the corners of a tetrahedron. Call [`Mass::seal`] when all bodies are in.
pub fn lumped_mass(mesh: &Mesh, first_row: usize, density_of_cell: &dyn Fn(usize) -> f64, mass: &mut Mass) {
    over_samples(mesh, 2, |cell, nodes, shape, volume| {
        let row_mass = density_of_cell(cell) * volume;
        for (node, weight) in nodes.iter().zip(shape) {
            let row = node + first_row as u32;
            mass.add(row, row, row_mass * weight);
        }
    });
}

/// Adds `∫ρ N_a N_b dV` of every cell. Call [`Mass::seal`] when all bodies are in.
pub fn consistent_mass(
    mesh: &Mesh,
    first_row: usize,
    density_of_cell: &dyn Fn(usize) -> f64,
    mass: &mut Mass,
) {
    over_samples(mesh, 4, |cell, nodes, shape, volume| {
        let sample_mass = density_of_cell(cell) * volume;
        for (a, weight_a) in nodes.iter().zip(shape) {
            for (b, weight_b) in nodes.iter().zip(shape) {
                let (a, b) = (a + first_row as u32, b + first_row as u32);
                mass.add(a, b, sample_mass * weight_a * weight_b);
            }
        }
    });
}

/// Calls `add(cell, nodes, N, V)` at the samples of a rule of the given degree, or of the finest there is.
fn over_samples(mesh: &Mesh, degree: usize, mut add: impl FnMut(usize, &[u32], &[f64], f64)) {
    for (index, cell) in mesh.cells().enumerate() {
        let finest = || cell.kind.rules().last().unwrap_or_else(|| cell.kind.default_rule());
        let rule: &QuadratureRule = cell.kind.rule_of_degree(degree).unwrap_or_else(finest);
        let corners: Vec<Vec3> = cell.nodes.iter().map(|node| mesh.points[*node as usize]).collect();
        for point in &rule.points {
            let volume = cell.kind.jacobian(&corners, point.position).determinant() * point.weight;
            add(index, cell.nodes, &cell.kind.shape(point.position), volume);
        }
    }
}
