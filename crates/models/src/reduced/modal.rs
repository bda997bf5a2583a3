//! What resists amplitudes of modes, and what takes energy from them.

use std::any::Any;

use souple_engine::state::Pair;
use souple_engine::{CellField, Configuration, Declaration, Energy, Force, Scratch, TangentWeights};
use souple_math::{Mat3, Vec3};
use souple_solve::BlockMatrix;

use super::ROWS_OF_FRAME;
use crate::materials::Material;
use crate::solids::{FlatCell, SolidDescription, SolidForce};

/// The first row of a mode, `b = u a` along the first axis of the frame: `u` and its rate are all that modes are asked for.
fn row_of_mode(first_row: u32, mode: usize) -> usize {
    first_row as usize + ROWS_OF_FRAME + 3 * mode
}

/// `f = -ω² u` on the amplitudes of a body's modes, whose norm is `φ·Mφ = 1`.
///
/// With `b = u a` of the first axis `E = ½ ω² |b|²`: linear in rows, and no torque on the frame, however it has turned.
pub struct ModalStiffness {
    name: String,
    /// Row of the frame's origin.
    first_row: u32,
    /// `ω_i²` [1/s²].
    eigenvalues: Vec<f64>,
    /// What is read off the cells of the mesh.
    cells: SolidForce,
    materials: Vec<Material>,
    material_of_cell: Vec<u16>,
    axes: Vec<Mat3>,
}

impl ModalStiffness {
    /// Of the body of a description, whose points are rows.
    ///
    /// # Errors
    /// A cell is flat or inverted at rest.
    pub fn new(
        description: &SolidDescription,
        first_row: u32,
        eigenvalues: &[f64],
    ) -> Result<Self, FlatCell> {
        Ok(Self {
            name: description.name.clone(),
            first_row,
            eigenvalues: eigenvalues.to_vec(),
            cells: SolidForce::new(description)?,
            materials: description.materials.to_vec(),
            material_of_cell: description.material_of_cell.to_vec(),
            axes: description.axes.to_vec(),
        })
    }

    /// Rows of the modes with what resists there.
    fn springs(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        let rows = (0..).map(|mode| row_of_mode(self.first_row, mode));
        rows.zip(self.eigenvalues.iter().copied())
    }
}

impl Force for ModalStiffness {
    fn name(&self) -> &str {
        &self.name
    }

    fn declaration(&self) -> Declaration {
        Declaration::ELASTIC
    }

    fn energy(&self, at: &Configuration, _: &mut Scratch) -> Energy {
        let stored = self.springs().map(|(row, k)| 0.5 * k * at.positions[row].length_sq()).sum();
        Energy { stored, dissipated: 0.0 }
    }

    fn add_force(&self, at: &Configuration, _: &mut Scratch, out: &mut [Vec3]) {
        self.springs().for_each(|(row, k)| out[row] -= at.positions[row] * k);
    }

    fn add_differential(
        &self,
        _: &Configuration,
        weights: TangentWeights,
        delta: &[Vec3],
        _: &mut Scratch,
        out: &mut [Vec3],
    ) {
        self.springs().for_each(|(row, k)| out[row] -= delta[row] * (k * weights.position));
    }

    fn visit_cliques(&self, _: &[Pair], visit: &mut dyn FnMut(&[u32])) {
        self.springs().for_each(|(row, _)| visit(&[row as u32]));
    }

    fn reads_cliques_alone(&self) -> bool {
        true
    }

    fn add_blocks(
        &self,
        _: &Configuration,
        weights: TangentWeights,
        _: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) {
        for (row, k) in self.springs() {
            // a row of its own cliques
            let _ = matrix.add(row, row, &(Mat3::IDENTITY * (-k * weights.position)));
        }
    }

    fn cell_field(&self, cell: usize, positions: &[Vec3]) -> Option<CellField> {
        let seen = self.cells.cell_field(cell, positions)?;
        let first = self.first_row as usize + 1;
        // strains are small in the frame, and the law may know no turns: R P(Rᵀ F)
        let R = Mat3::from_columns(positions[first], positions[first + 1], positions[first + 2]);
        let material = self.materials[usize::from(self.material_of_cell[cell])].along(self.axes.get(cell));
        let field = material.field(&(R.transpose() * seen.deformation), seen.volume);
        Some(CellField {
            deformation: seen.deformation,
            stress: R * field.stress,
            cauchy: (R * field.cauchy).mul_transpose(&R),
            ..field
        })
    }

    fn bytes(&self) -> usize {
        8 * self.eigenvalues.capacity()
            + self.cells.bytes()
            + 2 * self.material_of_cell.capacity()
            + size_of::<Mat3>() * self.axes.capacity()
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}

/// `f = -z u̇` on amplitudes, seen from the frame: turning takes no part. With `b = u a` the force is `-z (a·ḃ) a`.
/// Memory keeps account of the heat, `∫ z u̇² dt` [J].
pub struct ModalDamping {
    name: String,
    first_row: u32,
    /// `z_i` [1/s].
    rates: Vec<f64>,
}

impl ModalDamping {
    /// `z_i = β ω_i² + 2 ζ ω_i` of proportional damping by stiffness, `β` [s], and of a damping ratio `ζ` that all modes have.
    pub fn new(name: String, first_row: u32, eigenvalues: &[f64], seconds: f64, ratio: f64) -> Self {
        let rate = |eigenvalue: &f64| seconds * eigenvalue + 2.0 * ratio * eigenvalue.max(0.0).sqrt();
        Self { name, first_row, rates: eigenvalues.iter().map(rate).collect() }
    }

    /// Of each mode: the rows of its axis and of itself, and `z`.
    fn dampers(&self) -> impl Iterator<Item = ([usize; 2], f64)> + '_ {
        let axis = self.first_row as usize + 1;
        let rows = (0..).map(move |mode| [axis, row_of_mode(self.first_row, mode)]);
        rows.zip(self.rates.iter().copied())
    }
}

impl Force for ModalDamping {
    fn name(&self) -> &str {
        &self.name
    }

    fn acts_within(&self) -> bool {
        true
    }

    fn declaration(&self) -> Declaration {
        // the way of the force turns with the axis: ∂f/∂a has no counterpart on the axis
        Declaration {
            conservative: false,
            velocity_terms: true,
            symmetric_tangent: false,
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

    fn energy(&self, at: &Configuration, _: &mut Scratch) -> Energy {
        Energy { stored: 0.0, dissipated: at.memory[0] }
    }

    fn add_force(&self, at: &Configuration, _: &mut Scratch, out: &mut [Vec3]) {
        for ([axis, row], z) in self.dampers() {
            let a = at.positions[axis];
            out[row] -= a * (z * a.dot(at.velocities[row]));
        }
    }

    // δf = -z ((a·δḃ) a + (δa·ḃ) a + (a·ḃ) δa)
    fn add_differential(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        delta: &[Vec3],
        _: &mut Scratch,
        out: &mut [Vec3],
    ) {
        for ([axis, row], z) in self.dampers() {
            let (a, rate) = (at.positions[axis], at.velocities[row]);
            out[row] -= a * (z * weights.velocity * a.dot(delta[row]));
            out[row] -= (a * delta[axis].dot(rate) + delta[axis] * a.dot(rate)) * (z * weights.position);
        }
    }

    fn visit_cliques(&self, _: &[Pair], visit: &mut dyn FnMut(&[u32])) {
        self.dampers().for_each(|(rows, _)| visit(&rows.map(|row| row as u32)));
    }

    fn reads_cliques_alone(&self) -> bool {
        true
    }

    fn add_blocks(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        _: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) {
        for ([axis, row], z) in self.dampers() {
            let (a, rate) = (at.positions[axis], at.velocities[row]);
            let by_axis = a.outer(rate) + Mat3::IDENTITY * a.dot(rate);
            // rows of its own cliques
            let _ = matrix.add(row, row, &(a.outer(a) * (-z * weights.velocity)));
            let _ = matrix.add(row, axis, &(by_axis * (-z * weights.position)));
        }
    }

    // the tangent without what turns with the axis, which is of the size of u u̇
    fn add_symmetric_blocks(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        scratch: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) {
        self.add_blocks(at, TangentWeights { position: 0.0, ..weights }, scratch, matrix);
    }

    // heat: ∫ z u̇² dt
    fn advance_memory(&self, at: &Configuration, timestep: f64, memory: &mut [f64], _pairs: &mut [Pair]) {
        let power: f64 = self
            .dampers()
            .map(|([axis, row], z)| z * at.positions[axis].dot(at.velocities[row]).powi(2))
            .sum();
        memory[0] += timestep * power;
    }

    fn bytes(&self) -> usize {
        8 * self.rates.capacity()
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}
