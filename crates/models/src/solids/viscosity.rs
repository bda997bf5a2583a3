//! Kelvin–Voigt damping: stress proportional to the rate of strain, none in rigid motion.

use std::any::Any;

use souple_engine::state::Pair;
use souple_engine::tangent::add_block;
use souple_engine::{Configuration, Declaration, Energy, Force, Scratch, TangentWeights};
use souple_math::{Mat3, Vec3};
use souple_solve::BlockMatrix;

use super::layout::FlatCell;
use super::{SolidDescription, nodes_of};

/// `P = F S`, `S = 2 η Ė`, `Ė = sym(Fᵀ Ḟ)`, with the viscosity `η` [Pa s]: dissipates `2 η Ė:Ė` per volume.
pub struct Viscosity {
    name: String,
    cells: Vec<Cell>,
    /// `2 η` [Pa s].
    modulus: f64,
}

/// A cell's rows and its samples: shape gradients `∂N_a/∂X` and volume.
struct Cell {
    rows: Vec<u32>,
    samples: Vec<Sample>,
}

struct Sample {
    gradients: Vec<Vec3>,
    volume: f64,
}

impl Viscosity {
    /// # Errors
    /// A cell is flat or inverted at rest.
    pub fn new(description: &SolidDescription, viscosity: f64) -> Result<Self, FlatCell> {
        let mesh = description.mesh;
        let mut cells = Vec::with_capacity(mesh.cell_count());
        for (index, cell) in mesh.cells().enumerate() {
            let corners: Vec<Vec3> = cell.nodes.iter().map(|node| mesh.points[*node as usize]).collect();
            let mut samples = Vec::new();
            for (sample, point) in description.quadrature.rule(cell.kind).points.iter().enumerate() {
                let jacobian = cell.kind.jacobian(&corners, point.position);
                let determinant = jacobian.determinant();
                let flat = FlatCell { kind: cell.kind, cell: index as u32, sample, determinant };
                let inverse = jacobian.try_inverse().filter(|_| determinant > 0.0).ok_or(flat)?;
                let reference = cell.kind.shape_gradients(point.position);
                let gradients = reference.iter().map(|g| inverse.transpose_apply(*g)).collect();
                samples.push(Sample { gradients, volume: determinant * point.weight });
            }
            cells.push(Cell { rows: nodes_of(&cell, description.first_row), samples });
        }
        Ok(Self { name: description.name.clone(), cells, modulus: 2.0 * viscosity })
    }

    /// `S = 2 η sym(Fᵀ Ḟ)`.
    fn stress(&self, F: &Mat3, rate: &Mat3) -> Mat3 {
        F.transpose_mul(rate).symmetric_part() * self.modulus
    }
}

impl Cell {
    /// `Σ x_a ⊗ ∂N_a/∂X`.
    fn gradient(&self, sample: &Sample, values: &[Vec3]) -> Mat3 {
        self.rows
            .iter()
            .zip(&sample.gradients)
            .fold(Mat3::ZERO, |sum, (row, g)| sum + values[*row as usize].outer(*g))
    }
}

impl Force for Viscosity {
    fn name(&self) -> &str {
        &self.name
    }

    fn declaration(&self) -> Declaration {
        Declaration {
            conservative: false,
            velocity_terms: true,
            symmetric_tangent: false,
            ..Declaration::ELASTIC
        }
    }

    fn energy(&self, _: &Configuration, _: &mut Scratch) -> Energy {
        Energy::default()
    }

    fn add_force(&self, at: &Configuration, _: &mut Scratch, out: &mut [Vec3]) {
        for cell in &self.cells {
            for sample in &cell.samples {
                let F = cell.gradient(sample, at.positions);
                let rate = cell.gradient(sample, at.velocities);
                let P = F * self.stress(&F, &rate) * sample.volume;
                for (row, g) in cell.rows.iter().zip(&sample.gradients) {
                    out[*row as usize] -= P * *g;
                }
            }
        }
    }

    fn add_differential(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        delta: &[Vec3],
        _: &mut Scratch,
        out: &mut [Vec3],
    ) {
        for cell in &self.cells {
            for sample in &cell.samples {
                let F = cell.gradient(sample, at.positions);
                let rate = cell.gradient(sample, at.velocities);
                let d = cell.gradient(sample, delta);
                // a (δF S + F 2η sym(δFᵀ Ḟ)) + b F 2η sym(Fᵀ δḞ)
                let by_position = d * self.stress(&F, &rate) + F * self.stress(&d, &rate);
                let by_velocity = F * self.stress(&F, &d);
                let dP = (by_position * weights.position + by_velocity * weights.velocity) * sample.volume;
                for (row, g) in cell.rows.iter().zip(&sample.gradients) {
                    out[*row as usize] -= dP * *g;
                }
            }
        }
    }

    fn visit_cliques(&self, _: &[Pair], visit: &mut dyn FnMut(&[u32])) {
        self.cells.iter().for_each(|cell| visit(&cell.rows));
    }

    fn add_blocks(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        _: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) {
        for cell in &self.cells {
            for sample in &cell.samples {
                let F = cell.gradient(sample, at.positions);
                let rate = cell.gradient(sample, at.velocities);
                let S = self.stress(&F, &rate);
                for (b, g_b) in cell.rows.iter().zip(&sample.gradients) {
                    let by_axis = Vec3::AXES.map(|axis| {
                        let d = axis.outer(*g_b);
                        let by_position = d * S + F * self.stress(&d, &rate);
                        let by_velocity = F * self.stress(&F, &d);
                        (by_position * weights.position + by_velocity * weights.velocity) * -sample.volume
                    });
                    for (a, g_a) in cell.rows.iter().zip(&sample.gradients) {
                        let block = Mat3 { columns: by_axis.map(|dP| dP * *g_a) };
                        add_block(matrix, *a as usize, *b as usize, &block);
                    }
                }
            }
        }
    }

    fn bytes(&self) -> usize {
        let cell = |cell: &Cell| {
            4 * cell.rows.len()
                + cell.samples.iter().map(|sample| 24 * sample.gradients.len() + 8).sum::<usize>()
        };
        self.cells.iter().map(cell).sum()
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}
