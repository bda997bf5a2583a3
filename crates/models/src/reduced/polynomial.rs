//! Bodies that move as one polynomial of where their matter rests.

use std::any::Any;

use souple_engine::state::Pair;
use souple_engine::{
    CellField, Configuration, Declaration, Energy, Force, Mass, Scratch, TangentWeights, UnknownKind,
};
use souple_math::{Mat3, Vec3};
use souple_solve::{BlockMatrix, dense};

use crate::frames::Sample;
use crate::materials::{Material, Oriented};

/// Terms of a quadratic polynomial of three coordinates.
const MOST_TERMS: usize = 10;

/// How far a polynomial goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Degree {
    /// `Z = (1, u, v, w)`: twelve numbers, one strain all over the body.
    Affine,
    /// `Z = (1, u, v, w, uv, uw, vw, u², v², w²)`: thirty numbers, strains that vary linearly.
    Quadratic,
}

impl Degree {
    /// The unknown that has a row for each term.
    pub fn kind(self) -> UnknownKind {
        match self {
            Self::Affine => UnknownKind::AffineFrame,
            Self::Quadratic => UnknownKind::QuadraticFrame,
        }
    }

    /// Terms of the polynomial.
    pub fn term_count(self) -> usize {
        self.kind().row_count()
    }
}

/// `x = R Z(P)` of the coordinates `(u, v, w) = (P - c)/L`, by which rows are all lengths of the body's size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Polynomial {
    pub degree: Degree,
    /// `c` [m].
    pub centre: Vec3,
    /// `L` [m].
    pub length: f64,
}

impl Polynomial {
    /// `Z(P)`; terms that are not there are zero.
    pub fn terms(&self, point: Vec3) -> [f64; MOST_TERMS] {
        let Vec3 { x: u, y: v, z: w } = (point - self.centre) / self.length;
        match self.degree {
            Degree::Affine => [1.0, u, v, w, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
            Degree::Quadratic => [1.0, u, v, w, u * v, u * w, v * w, u * u, v * v, w * w],
        }
    }

    /// `∂Z/∂P` [1/m].
    pub fn gradients(&self, point: Vec3) -> [Vec3; MOST_TERMS] {
        let Vec3 { x: u, y: v, z: w } = (point - self.centre) / self.length;
        let mut gradients = [Vec3::ZERO; MOST_TERMS];
        gradients[1..4].copy_from_slice(&Vec3::AXES);
        if self.degree == Degree::Quadratic {
            gradients[4] = Vec3::new(v, u, 0.0);
            gradients[5] = Vec3::new(w, 0.0, u);
            gradients[6] = Vec3::new(0.0, w, v);
            gradients[7] = Vec3::new(2.0 * u, 0.0, 0.0);
            gradients[8] = Vec3::new(0.0, 2.0 * v, 0.0);
            gradients[9] = Vec3::new(0.0, 0.0, 2.0 * w);
        }
        gradients.map(|gradient| gradient / self.length)
    }

    /// Rows of the body at rest: where `P` is `Σ row Z(P)`.
    pub fn rest(&self) -> impl Iterator<Item = Vec3> {
        let axes = Vec3::AXES.map(|axis| axis * self.length);
        let linear = std::iter::once(self.centre).chain(axes);
        linear.chain(std::iter::repeat(Vec3::ZERO)).take(self.degree.term_count())
    }

    /// Adds `M_jk = Σ m Z_j Z_k` of points of some mass to the rows from `first_row` on.
    pub fn add_mass(&self, points: impl Iterator<Item = (Vec3, f64)>, first_row: u32, mass: &mut Mass) {
        let count = self.degree.term_count();
        let mut sums = [[0.0; MOST_TERMS]; MOST_TERMS];
        for (point, m) in points {
            let terms = self.terms(point);
            for (sums, a) in sums.iter_mut().zip(terms) {
                sums.iter_mut().zip(terms).for_each(|(sum, b)| *sum += m * a * b);
            }
        }
        for (a, sums) in (first_row..).zip(&sums[..count]) {
            (first_row..).zip(&sums[..count]).for_each(|(b, sum)| mass.add(a, b, *sum));
        }
    }
}

/// What a body of a polynomial is made of.
pub struct PolynomialDescription<'a> {
    pub name: String,
    pub polynomial: Polynomial,
    /// Row of the constant term; the others follow.
    pub first_row: u32,
    /// Where strain is taken, cell after cell.
    pub samples: &'a [Sample],
    pub materials: &'a [Material],
    /// Index into `materials` for each cell.
    pub material_of_cell: &'a [u16],
    /// The axes of the law of each cell as columns; none: those of the world.
    pub axes: &'a [Mat3],
}

/// A sample with `∂Z/∂P` there.
struct Strained {
    volume: f64,
    cell: u32,
    gradients: [Vec3; MOST_TERMS],
}

/// Elastic forces of a body of a polynomial, any law: `F = Σ row ⊗ ∂Z/∂P`, `f = -Σ V P(F) ∂Z/∂P`.
pub struct PolynomialForce {
    name: String,
    first_row: u32,
    term_count: usize,
    samples: Vec<Strained>,
    /// Of each cell: its first sample, and behind the last cell the count of them.
    starts: Vec<u32>,
    materials: Vec<Material>,
    material_of_cell: Vec<u16>,
    axes: Vec<Mat3>,
}

impl PolynomialForce {
    pub fn new(description: &PolynomialDescription) -> Self {
        let PolynomialDescription { polynomial, samples, .. } = description;
        let strained = samples.iter().map(|sample| Strained {
            volume: sample.volume,
            cell: sample.cell,
            gradients: polynomial.gradients(sample.position),
        });
        let end = |cell: usize| samples.partition_point(|sample| (sample.cell as usize) < cell) as u32;
        Self {
            name: description.name.clone(),
            first_row: description.first_row,
            term_count: polynomial.degree.term_count(),
            samples: strained.collect(),
            starts: (0..=description.material_of_cell.len()).map(end).collect(),
            materials: description.materials.to_vec(),
            material_of_cell: description.material_of_cell.to_vec(),
            axes: description.axes.to_vec(),
        }
    }

    fn material(&self, cell: u32) -> Oriented<'_> {
        let material = &self.materials[usize::from(self.material_of_cell[cell as usize])];
        material.along(self.axes.get(cell as usize))
    }

    /// The rows of the terms.
    fn rows(&self) -> std::ops::Range<usize> {
        self.first_row as usize..self.first_row as usize + self.term_count
    }

    /// `Σ row ⊗ ∂Z/∂P`.
    fn gradient(&self, rows: &[Vec3], sample: &Strained) -> Mat3 {
        rows.iter().zip(&sample.gradients).skip(1).fold(Mat3::ZERO, |sum, (row, g)| sum + row.outer(*g))
    }

    /// `out += scale V P ∂Z/∂P`.
    fn spread(&self, sample: &Strained, stress: &Mat3, scale: f64, out: &mut [Vec3]) {
        let weighted = *stress * (scale * sample.volume);
        for (out, gradient) in out[self.rows()].iter_mut().zip(&sample.gradients).skip(1) {
            *out += weighted * *gradient;
        }
    }

    /// Whether anything was turned round to be definite.
    fn assemble(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        definite: Option<&mut dense::Workspace>,
        matrix: &mut BlockMatrix,
    ) -> bool {
        if weights.position == 0.0 {
            return false;
        }
        let (mut turned, mut definite) = (false, definite);
        let mut blocks = [[Mat3::ZERO; MOST_TERMS]; MOST_TERMS];
        for sample in &self.samples {
            let F = self.gradient(&at.positions[self.rows()], sample);
            let mut tangents = tangents_at(&self.material(sample.cell), &F);
            if let Some(workspace) = definite.as_deref_mut() {
                turned |= dense::take_absolute(9, tangents.as_flattened_mut(), workspace);
            }
            self.add_sample(sample, &tangents, -weights.position * sample.volume, &mut blocks);
        }
        for (a, line) in self.rows().zip(&blocks) {
            for (b, block) in self.rows().zip(line) {
                // rows of its own clique
                let _ = matrix.add(a, b, block);
            }
        }
        turned
    }

    /// `blocks[a][b] += scale Σ_l (∂P/∂F_jl ∂Z_a/∂P) ∂Z_b/∂P_l`, column `j`.
    fn add_sample(
        &self,
        sample: &Strained,
        tangents: &[[f64; 9]; 9],
        scale: f64,
        blocks: &mut [[Mat3; MOST_TERMS]; MOST_TERMS],
    ) {
        let gradients = &sample.gradients[..self.term_count];
        for (line, g_a) in blocks.iter_mut().zip(gradients).skip(1) {
            // of entry (j, l) of F: ∂P g_a
            let pushes = tangents.map(|tangent| matrix_of(&tangent) * *g_a * scale);
            for (block, g_b) in line.iter_mut().zip(gradients).skip(1) {
                for (entry, push) in pushes.iter().enumerate() {
                    block.columns[entry % 3] += *push * g_b[entry / 3];
                }
            }
        }
    }
}

/// A matrix from its numbers by columns.
fn matrix_of(numbers: &[f64; 9]) -> Mat3 {
    let column = |k: usize| Vec3::new(numbers[3 * k], numbers[3 * k + 1], numbers[3 * k + 2]);
    Mat3::from_columns(column(0), column(1), column(2))
}

/// `∂P/∂F`: for each entry of `F`, by columns, the numbers of `P` by columns.
fn tangents_at(material: &Oriented, F: &Mat3) -> [[f64; 9]; 9] {
    std::array::from_fn(|entry| {
        let unit = Vec3::AXES[entry % 3].outer(Vec3::AXES[entry / 3]);
        let change = material.stress_differential(F, &unit);
        std::array::from_fn(|number| change.columns[number / 3][number % 3])
    })
}

impl Force for PolynomialForce {
    fn name(&self) -> &str {
        &self.name
    }

    fn declaration(&self) -> Declaration {
        // small strain knows a rest orientation: a rotated body feels a torque
        let internal = self.materials.iter().all(|material| material.law.is_objective());
        Declaration { internal, ..Declaration::ELASTIC }
    }

    fn new_scratch(&self) -> Scratch {
        Box::new(dense::Workspace::default())
    }

    fn energy(&self, at: &Configuration, _: &mut Scratch) -> Energy {
        let rows = &at.positions[self.rows()];
        let density =
            |sample: &Strained| self.material(sample.cell).energy_density(&self.gradient(rows, sample));
        let stored = self.samples.iter().map(|sample| sample.volume * density(sample)).sum();
        Energy { stored, dissipated: 0.0 }
    }

    fn add_force(&self, at: &Configuration, _: &mut Scratch, out: &mut [Vec3]) {
        for sample in &self.samples {
            let F = self.gradient(&at.positions[self.rows()], sample);
            self.spread(sample, &self.material(sample.cell).stress(&F), -1.0, out);
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
        if weights.position == 0.0 {
            return;
        }
        for sample in &self.samples {
            let [F, dF] = [at.positions, delta].map(|rows| self.gradient(&rows[self.rows()], sample));
            let change = self.material(sample.cell).stress_differential(&F, &dF);
            self.spread(sample, &change, -weights.position, out);
        }
    }

    fn visit_cliques(&self, _: &[Pair], visit: &mut dyn FnMut(&[u32])) {
        let mut rows = [0; MOST_TERMS];
        rows.iter_mut().zip(self.first_row..).for_each(|(own, row)| *own = row);
        visit(&rows[..self.term_count]);
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
        self.assemble(at, weights, None, matrix);
    }

    fn add_definite_blocks(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        scratch: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) -> bool {
        self.assemble(at, weights, scratch.downcast_mut(), matrix)
    }

    fn cell_field(&self, cell: usize, positions: &[Vec3]) -> Option<CellField> {
        let [start, end] = [*self.starts.get(cell)?, *self.starts.get(cell + 1)?].map(|at| at as usize);
        let material = self.material(cell as u32);
        let (mut volume, mut current_volume, mut energy, mut mean) = (0.0, 0.0, 0.0, Mat3::ZERO);
        for sample in &self.samples[start..end] {
            let F = self.gradient(&positions[self.rows()], sample);
            volume += sample.volume;
            current_volume += sample.volume * F.determinant();
            energy += sample.volume * material.energy_density(&F);
            mean += F * sample.volume;
        }
        let field = material.field(&(mean * (1.0 / volume)), volume);
        Some(CellField { energy_density: energy / volume, current_volume, ..field })
    }

    fn bytes(&self) -> usize {
        size_of::<Strained>() * self.samples.capacity()
            + 4 * self.starts.capacity()
            + 2 * self.material_of_cell.capacity()
            + size_of::<Mat3>() * self.axes.capacity()
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}
