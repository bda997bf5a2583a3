//! Incompressibility as a property: the volume of every cell, or about every point, is kept by a multiplier beside a penalty.
//!
//! Volumes `V_k = Σ s_ke V_e` of a body, each of the shares `s_ke` of cells, are to stay what they are at rest. With
//! `g_k = V_k/V_k⁰ - 1` the augmented Lagrangian of the constraint adds
//!
//! `E = Σ V_k⁰ (λ_k g_k + c/2 g_k²)`, `f_a = -∂E/∂x_a = -Σ (λ_k + c g_k) ∂V_k/∂x_a`,
//! `δf_a = -Σ (c/V_k⁰ (∂V_k·δ) ∂V_k/∂x_a + (λ_k + c g_k) δ ∂V_k/∂x_a)`
//!
//! to the elastic force of the body, whatever its law: symmetric, and exact at held multipliers. `λ_k` [Pa] is a mean stress, positive where
//! it pulls together what has grown. It takes over from the penalty `c` [Pa]:
//!
//! - `λ ← λ + c g` between solves of one and the same step, until all `|g|` are below a tolerance: steppers that solve equations;
//! - `λ' = c g/τ` from step to step, Platt and Barr's `λ' = g` in units of the penalty: explicit steppers. Of an oscillator with the mass
//!   `m` and the damping `γ m` the characteristic `s³ + γ s² + c/m (s + 1/τ)` is that of a stable motion where `γ τ > 1`,
//!   so the body is to have that much `rayleigh_mass`.
//!
//! What multipliers store as they move on, `V⁰ ∫ g dλ`, is booked as made: at once where they take over from step to step, by the mean of both
//! ends of the step where it solves for them.
//!
//! With one volume for each cell (`s = 1`) hexahedra are those of Simo & Taylor with a constant pressure, and prisms and
//! pyramids like them. Tetrahedra with linear shape functions have more cells than a third of what moves, and lock so: of these each shares
//! out its volume evenly to its corners, and volumes about points are kept (Bonet & Burton). The law's own resistance to change of volume stays,
//! sample by sample, and holds down what these few volumes leave free: it is to be moderate (Poisson's ratio of 0.3, not of 0.49).
//!
//! The volume of a cell is a polynomial of its nodes, `V_e = Σ_q w_q det J_q` with `J = Σ x_a ⊗ ∂N_a/∂ξ`, its first slopes
//! `Σ_q w_q cof(J_q) ∂N_a/∂ξ` and its second `δx × J (∂N_a/∂ξ × ∂N_b/∂ξ)`.
//!
//! Source: Platt & Barr 1988, Constraint methods for flexible models; Simo & Taylor 1991, Comput. Methods Appl. Mech. Eng. 85;
//! Bonet & Burton 1998, Commun. Numer. Meth. Eng. 14.

use std::any::Any;

use souple_engine::state::Pair;
use souple_engine::tangent::add_block;
use souple_engine::{
    Adapted, CellField, Configuration, Curvature, Declaration, Editable, Energy, Force, LawChanges,
    ParameterError, Scratch, TangentWeights, Unmet,
};
use souple_math::{Mat3, Vec3};
use souple_mesh::{ElementKind, Mesh};
use souple_solve::BlockMatrix;

use super::Quadrature;
use super::cellwise::{Cellwise, map_into, sum_of};

/// How volume is kept.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Incompressibility {
    /// `c` [Pa].
    pub penalty: f64,
    pub multipliers: Multipliers,
    pub pressures: Pressures,
}

/// When multipliers take over from the penalty.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Multipliers {
    /// Between solves of a step, until no volume is farther from what it is to be than this share of itself.
    Solved { tolerance: f64 },
    /// From step to step, in this time [s].
    Relaxed { time: f64 },
}

/// What volumes are kept.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Pressures {
    /// About points of `tet4`, of other cells one by one.
    #[default]
    ByElement,
    /// Of every cell.
    Cells,
    /// About every point.
    Points,
}

/// Quadrature of the volume of a kind of cell.
struct Shape {
    kind: ElementKind,
    weights: Vec<f64>,
    /// `∂N_a/∂ξ`, sample after sample.
    gradients: Vec<Vec3>,
}

/// Compressed lists.
#[derive(Default)]
struct Lists<T> {
    starts: Vec<u32>,
    entries: Vec<T>,
}

impl<T> Lists<T> {
    fn new(lists: impl IntoIterator<Item = Vec<T>>) -> Self {
        let (mut starts, mut entries) = (vec![0], Vec::new());
        for list in lists {
            entries.extend(list);
            starts.push(entries.len() as u32);
        }
        Self { starts, entries }
    }

    fn of(&self, number: usize) -> &[T] {
        &self.entries[self.starts[number] as usize..self.starts[number + 1] as usize]
    }

    fn len(&self) -> usize {
        self.starts.len() - 1
    }

    fn bytes(&self) -> usize {
        4 * self.starts.len() + size_of_val(self.entries.as_slice())
    }
}

/// A part of a volume: a share of a cell, or the other way round.
#[derive(Clone, Copy)]
struct Share {
    /// The cell of a volume; the volume of a cell.
    of: u32,
    part: f64,
}

/// The elastic force of a body whose volume is kept.
pub struct Incompressible {
    inner: Box<dyn Force>,
    rules: Incompressibility,
    cells: Cellwise,
    shapes: Vec<Shape>,
    shape_of_cell: Vec<u8>,
    /// Cells of each volume.
    volumes: Lists<Share>,
    /// Volumes of each cell.
    of_cell: Lists<Share>,
    /// Rows that each volume reads, and where the nodes of its cells, one after the other, stand among these.
    volume_rows: Lists<u32>,
    volume_places: Lists<u16>,
    /// `V_k⁰` [m³].
    at_rest: Vec<f64>,
    rest: Vec<Vec3>,
    first_row: usize,
}

struct VolumeScratch {
    inner: Scratch,
    /// `∂V_e/∂x_a` of the nodes of all cells [m²].
    slopes: Vec<Vec3>,
    parts: Vec<Vec3>,
    /// Of each volume.
    pulls: Vec<f64>,
    blocks: Vec<Mat3>,
    own: Vec<Vec3>,
}

fn of(scratch: &mut Scratch) -> &mut VolumeScratch {
    scratch.downcast_mut().unwrap_or_else(|| unreachable!("made by this force's own new_scratch"))
}

/// Own numbers of memory before the multipliers, after those of the elastic force: what multipliers that moved on took from what is stored [J].
const HEAT: usize = 0;
const MULTIPLIERS: usize = 1;

/// Own memory by what it is of: `λ_k`, and of multipliers that are solved for, `λ_k` and `g_k` where the last step ended.
struct Remembered<'a> {
    heat: &'a mut f64,
    multipliers: &'a mut [f64],
    last_multipliers: &'a mut [f64],
    last_growths: &'a mut [f64],
}

impl Incompressible {
    /// Of the elastic force of a mesh whose points are the rows from `first_row`.
    pub fn new(inner: Box<dyn Force>, mesh: &Mesh, first_row: usize, rules: Incompressibility) -> Self {
        let cells = Cellwise::new(mesh, first_row);
        let mut shapes: Vec<Shape> = Vec::new();
        let shape_of_cell = mesh.cells().map(|cell| {
            let known = shapes.iter().position(|shape| shape.kind == cell.kind);
            known.unwrap_or_else(|| {
                shapes.push(Shape::new(cell.kind));
                shapes.len() - 1
            }) as u8
        });
        let shape_of_cell = shape_of_cell.collect();
        let volumes = volumes_of(mesh, rules.pressures);
        let mut of_cell = vec![Vec::new(); mesh.cell_count()];
        let (mut volume_rows, mut volume_places) = (Vec::new(), Vec::new());
        for (number, own) in volumes.iter().enumerate() {
            own.iter().for_each(|share| {
                of_cell[share.of as usize].push(Share { of: number as u32, part: share.part });
            });
            let nodes = || own.iter().flat_map(|share| cells.rows(share.of as usize));
            let mut rows: Vec<u32> = nodes().copied().collect();
            rows.sort_unstable();
            rows.dedup();
            let place = |row: &u32| rows.partition_point(|other| other < row) as u16;
            volume_places.push(nodes().map(place).collect());
            volume_rows.push(rows);
        }
        let mut force = Self {
            inner,
            rules,
            cells,
            shapes,
            shape_of_cell,
            volumes: Lists::new(volumes),
            of_cell: Lists::new(of_cell),
            volume_rows: Lists::new(volume_rows),
            volume_places: Lists::new(volume_places),
            at_rest: Vec::new(),
            rest: mesh.points.clone(),
            first_row,
        };
        let at_rest = |volume: usize| {
            let of_share = |share: &Share| share.part * force.cell_volume(share.of as usize, force.rest_of());
            force.volumes.of(volume).iter().map(of_share).sum()
        };
        force.at_rest = (0..force.volumes.len()).map(at_rest).collect();
        force
    }

    /// Number of volumes that are kept.
    pub fn volume_count(&self) -> usize {
        self.volumes.len()
    }
}

/// The cells of each volume.
fn volumes_of(mesh: &Mesh, pressures: Pressures) -> Vec<Vec<Share>> {
    let is_shared = |kind: ElementKind| match pressures {
        Pressures::ByElement => kind == ElementKind::Tet4,
        Pressures::Cells => false,
        Pressures::Points => true,
    };
    let mut volumes = Vec::new();
    let mut about: Vec<Vec<Share>> = vec![Vec::new(); mesh.points.len()];
    for (number, cell) in mesh.cells().enumerate() {
        let of = number as u32;
        if is_shared(cell.kind) {
            let corners = cell.kind.corner_count();
            let part = 1.0 / corners as f64;
            cell.nodes[..corners].iter().for_each(|node| about[*node as usize].push(Share { of, part }));
        } else {
            volumes.push(vec![Share { of, part: 1.0 }]);
        }
    }
    volumes.extend(about.into_iter().filter(|shares| !shares.is_empty()));
    volumes
}

impl Shape {
    fn new(kind: ElementKind) -> Self {
        // exact for the volume of linear cells, and of quadratic ones with straight sides
        let rule = Quadrature::Full.rule(kind);
        let gradients = rule.points.iter().flat_map(|point| kind.shape_gradients(point.position).to_vec());
        Self {
            kind,
            weights: rule.points.iter().map(|point| point.weight).collect(),
            gradients: gradients.collect(),
        }
    }

    /// Weights, and `∂N_a/∂ξ` of the nodes.
    fn samples(&self) -> impl Iterator<Item = (f64, &[Vec3])> {
        self.weights.iter().copied().zip(self.gradients.chunks_exact(self.kind.node_count()))
    }
}

/// Positions of rows from one on.
#[derive(Clone, Copy)]
struct Placed<'a> {
    positions: &'a [Vec3],
    first_row: usize,
}

impl Placed<'_> {
    /// `J = Σ x_a ⊗ ∂N_a/∂ξ`.
    fn jacobian(&self, rows: &[u32], gradients: &[Vec3]) -> Mat3 {
        let mut J = Mat3::ZERO;
        for (row, gradient) in rows.iter().zip(gradients) {
            J += self.positions[*row as usize - self.first_row].outer(*gradient);
        }
        J
    }
}

impl Incompressible {
    fn rest_of(&self) -> Placed<'_> {
        Placed { positions: &self.rest, first_row: self.first_row }
    }

    fn shape(&self, cell: usize) -> &Shape {
        &self.shapes[usize::from(self.shape_of_cell[cell])]
    }

    fn cell_volume(&self, cell: usize, placed: Placed) -> f64 {
        let of_sample = |(weight, gradients): (f64, &[Vec3])| {
            weight * placed.jacobian(self.cells.rows(cell), gradients).determinant()
        };
        self.shape(cell).samples().map(of_sample).sum()
    }

    /// `g_k`, without slopes.
    fn growth(&self, volume: usize, positions: &[Vec3]) -> f64 {
        let placed = Placed { positions, first_row: 0 };
        let of_share = |share: &Share| share.part * self.cell_volume(share.of as usize, placed);
        self.volumes.of(volume).iter().map(of_share).sum::<f64>() / self.at_rest[volume] - 1.0
    }

    fn own<'a>(&self, memory: &'a [f64]) -> &'a [f64] {
        &memory[self.inner.memory_len()..]
    }

    fn multipliers<'a>(&self, memory: &'a [f64]) -> &'a [f64] {
        &self.own(memory)[MULTIPLIERS..][..self.volumes.len()]
    }

    /// How many numbers of memory a volume has.
    fn numbers_of_volume(&self) -> usize {
        match self.rules.multipliers {
            Multipliers::Solved { .. } => 3,
            Multipliers::Relaxed { .. } => 1,
        }
    }

    /// Of its own memory.
    fn remembered<'a>(&self, own: &'a mut [f64]) -> Remembered<'a> {
        let (heat, numbers) = own.split_at_mut(MULTIPLIERS);
        let (multipliers, last) = numbers.split_at_mut(self.volumes.len());
        let (last_multipliers, last_growths) = last.split_at_mut(last.len() / 2);
        Remembered { heat: &mut heat[HEAT], multipliers, last_multipliers, last_growths }
    }

    /// Books what multipliers that a step has solved for have stored as they moved on, `V⁰ ∫ g dλ` by the mean of both ends of the step:
    /// what steps by the trapezoidal rule have neither taken from motion nor given to it.
    fn book_solved(&self, positions: &[Vec3], own: &mut [f64]) {
        let Remembered { heat, multipliers, last_multipliers, last_growths } = self.remembered(own);
        *heat -= sum_of(self.volumes.len(), |volume| {
            let growth = 0.5 * (last_growths[volume] + self.growth(volume, positions));
            self.at_rest[volume] * (multipliers[volume] - last_multipliers[volume]) * growth
        });
        last_multipliers.copy_from_slice(multipliers);
        map_into(last_growths, |volume, _| self.growth(volume, positions));
    }

    /// Moves multipliers on by `c g h/τ`, and books what that stores at once, `V⁰ δλ g`.
    fn relax(&self, positions: &[Vec3], share: f64, own: &mut [f64]) {
        let gain = self.rules.penalty * share;
        let Remembered { heat, multipliers, .. } = self.remembered(own);
        *heat -= gain
            * sum_of(self.volumes.len(), |volume| {
                self.at_rest[volume] * self.growth(volume, positions).powi(2)
            });
        map_into(multipliers, |volume, multiplier| multiplier + gain * self.growth(volume, positions));
    }

    /// The memory of the elastic force, and its own.
    fn split<'a>(&self, memory: &'a mut [f64]) -> (&'a mut [f64], &'a mut [f64]) {
        memory.split_at_mut(self.inner.memory_len())
    }

    fn view<'a>(&self, at: &Configuration<'a>) -> Configuration<'a> {
        // one that advances in place is shown none
        let memory = if at.memory.is_empty() { at.memory } else { &at.memory[..self.inner.memory_len()] };
        Configuration { memory, ..*at }
    }

    /// `∂V_e/∂x_a` of all cells.
    fn look(&self, positions: &[Vec3], slopes: &mut Vec<Vec3>) {
        let placed = Placed { positions, first_row: 0 };
        self.cells.fill(slopes, |cell, slopes| {
            slopes.fill(Vec3::ZERO);
            for (weight, gradients) in self.shape(cell).samples() {
                let cofactor = placed.jacobian(self.cells.rows(cell), gradients).cofactor() * weight;
                slopes.iter_mut().zip(gradients).for_each(|(slope, gradient)| *slope += cofactor * *gradient);
            }
        });
    }

    /// `V_e = ⅓ Σ ∂V_e/∂x_a · (x_a - x_0)`: a volume is of the third degree.
    fn volume_by_slopes(&self, cell: usize, positions: &[Vec3], slopes: &[Vec3]) -> f64 {
        let (rows, slopes) = (self.cells.rows(cell), &slopes[self.cells.places(cell)]);
        let origin = positions[rows[0] as usize];
        rows.iter().zip(slopes).map(|(row, slope)| slope.dot(positions[*row as usize] - origin)).sum::<f64>()
            / 3.0
    }

    /// `g_k`.
    fn growth_by_slopes(&self, volume: usize, positions: &[Vec3], slopes: &[Vec3]) -> f64 {
        let of_share =
            |share: &Share| share.part * self.volume_by_slopes(share.of as usize, positions, slopes);
        self.volumes.of(volume).iter().map(of_share).sum::<f64>() / self.at_rest[volume] - 1.0
    }

    /// `λ_k + c g_k` of all volumes.
    fn pulls(&self, at: &Configuration, slopes: &[Vec3], pulls: &mut Vec<f64>) {
        let multipliers = self.multipliers(at.memory);
        pulls.resize(multipliers.len(), 0.0);
        map_into(pulls, |volume, _| {
            multipliers[volume] + self.rules.penalty * self.growth_by_slopes(volume, at.positions, slopes)
        });
    }

    /// `Σ s_ke π_k` over the volumes of a cell.
    fn of_cell(&self, cell: usize, of_volume: &[f64]) -> f64 {
        self.of_cell.of(cell).iter().map(|share| share.part * of_volume[share.of as usize]).sum()
    }

    /// `a ∂f_i/∂x_j` of what volumes pull with, on the nodes of a cell.
    fn curved_blocks(&self, cell: usize, placed: Placed, pull: f64, blocks: &mut [Mat3]) {
        let (rows, nodes) = (self.cells.rows(cell), self.cells.rows(cell).len());
        for (weight, gradients) in self.shape(cell).samples() {
            let J = placed.jacobian(rows, gradients) * (weight * pull);
            for a in 0..nodes {
                for b in 0..a {
                    // δx × w
                    let w = J * gradients[a].cross(gradients[b]);
                    let turn = Mat3::from_columns(
                        Vec3::new(0.0, -w.z, w.y),
                        Vec3::new(w.z, 0.0, -w.x),
                        Vec3::new(-w.y, w.x, 0.0),
                    );
                    blocks[a * nodes + b] += turn;
                    blocks[b * nodes + a] += turn.transpose();
                }
            }
        }
    }

    /// `matrix -= a c/V_k⁰ ∂V_k ⊗ ∂V_k`.
    fn add_products(&self, scale: f64, slopes: &[Vec3], own: &mut Vec<Vec3>, matrix: &mut BlockMatrix) {
        for volume in 0..self.volumes.len() {
            let rows = self.volume_rows.of(volume);
            own.clear();
            own.resize(rows.len(), Vec3::ZERO);
            let mut places = self.volume_places.of(volume).iter();
            for share in self.volumes.of(volume) {
                for (slope, place) in slopes[self.cells.places(share.of as usize)].iter().zip(&mut places) {
                    own[usize::from(*place)] += *slope * share.part;
                }
            }
            let scale = scale * self.rules.penalty / self.at_rest[volume];
            for (row, a) in rows.iter().zip(own.iter()) {
                for (column, b) in rows.iter().zip(own.iter()) {
                    add_block(matrix, *row as usize, *column as usize, &(a.outer(*b) * -scale));
                }
            }
        }
    }

    /// Its own blocks; whether any were turned round.
    fn assemble(
        &self,
        curvature: Curvature,
        at: &Configuration,
        scale: f64,
        scratch: &mut VolumeScratch,
        matrix: &mut BlockMatrix,
    ) -> bool {
        if scale == 0.0 {
            return false;
        }
        let VolumeScratch { slopes, pulls, blocks, own, .. } = scratch;
        self.look(at.positions, slopes);
        self.pulls(at, slopes, pulls);
        let placed = Placed { positions: at.positions, first_row: 0 };
        let turned = self.cells.add_blocks(curvature, blocks, matrix, |cell, blocks| {
            self.curved_blocks(cell, placed, -scale * self.of_cell(cell, pulls), blocks);
        });
        self.add_products(scale, slopes, own, matrix);
        turned
    }

    /// A field of the elastic force, with the mean stress that volumes add.
    fn with_mean_stress(
        &self,
        cell: usize,
        positions: &[Vec3],
        field: CellField,
        multipliers: &[f64],
    ) -> CellField {
        let of_share = |share: &Share| {
            let volume = share.of as usize;
            let multiplier = multipliers.get(volume).copied().unwrap_or(0.0);
            share.part * (multiplier + self.rules.penalty * self.growth(volume, positions))
        };
        let pull: f64 = self.of_cell.of(cell).iter().map(of_share).sum();
        // mean over the cell of cof F = cof J J₀ᵀ/det J₀
        let (rows, placed) = (self.cells.rows(cell), Placed { positions, first_row: 0 });
        let mut cofactor = Mat3::ZERO;
        for (weight, gradients) in self.shape(cell).samples() {
            let [now, rest] = [placed, self.rest_of()].map(|placed| placed.jacobian(rows, gradients));
            cofactor += now.cofactor().mul_transpose(&rest) * weight;
        }
        let stress = field.stress + cofactor * (pull / self.cell_volume(cell, self.rest_of()));
        CellField { stress, cauchy: field.cauchy.plus_diagonal(pull), ..field }
    }
}

impl Force for Incompressible {
    fn name(&self) -> &str {
        self.inner.name()
    }

    fn acts_within(&self) -> bool {
        self.inner.acts_within()
    }

    fn declaration(&self) -> Declaration {
        self.inner.declaration()
    }

    fn leaves_out_stress(&self) -> bool {
        self.inner.leaves_out_stress()
    }

    fn memory_len(&self) -> usize {
        self.inner.memory_len() + MULTIPLIERS + self.numbers_of_volume() * self.volumes.len()
    }

    fn initial_memory(&self, memory: &mut [f64]) {
        let (inner, own) = self.split(memory);
        self.inner.initial_memory(inner);
        own.fill(0.0);
    }

    fn new_scratch(&self) -> Scratch {
        Box::new(VolumeScratch {
            inner: self.inner.new_scratch(),
            slopes: Vec::new(),
            parts: Vec::new(),
            pulls: Vec::new(),
            blocks: Vec::new(),
            own: Vec::new(),
        })
    }

    fn energy(&self, at: &Configuration, scratch: &mut Scratch) -> Energy {
        let VolumeScratch { inner, slopes, .. } = of(scratch);
        let Energy { stored, dissipated } = self.inner.energy(&self.view(at), inner);
        self.look(at.positions, slopes);
        let (heat, multipliers) = (self.own(at.memory)[HEAT], self.multipliers(at.memory));
        let of_volume = |volume: usize| {
            let g = self.growth_by_slopes(volume, at.positions, slopes);
            self.at_rest[volume] * g * (multipliers[volume] + 0.5 * self.rules.penalty * g)
        };
        Energy { stored: stored + sum_of(self.volumes.len(), of_volume), dissipated: dissipated + heat }
    }

    fn add_force(&self, at: &Configuration, scratch: &mut Scratch, out: &mut [Vec3]) {
        let VolumeScratch { inner, slopes, parts, pulls, .. } = of(scratch);
        self.inner.add_force(&self.view(at), inner, out);
        self.look(at.positions, slopes);
        self.pulls(at, slopes, pulls);
        self.cells.fill(parts, |cell, parts| {
            let pull = self.of_cell(cell, pulls);
            let slopes = &slopes[self.cells.places(cell)];
            parts.iter_mut().zip(slopes).for_each(|(part, slope)| *part = *slope * -pull);
        });
        self.cells.gather(parts, out);
    }

    fn add_differential(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        delta: &[Vec3],
        scratch: &mut Scratch,
        out: &mut [Vec3],
    ) {
        let VolumeScratch { inner, slopes, parts, pulls, .. } = of(scratch);
        self.inner.add_differential(&self.view(at), weights, delta, inner, out);
        if weights.position == 0.0 {
            return;
        }
        self.look(at.positions, slopes);
        self.pulls(at, slopes, pulls);
        let placed = Placed { positions: at.positions, first_row: 0 };
        let change = Placed { positions: delta, first_row: 0 };
        // c/V_k⁰ Σ s_ke ∂V_e·δ
        let grown = |volume: &Share| {
            let of_share = |share: &Share| {
                let (rows, slopes) =
                    (self.cells.rows(share.of as usize), &slopes[self.cells.places(share.of as usize)]);
                let moved = rows.iter().zip(slopes).map(|(row, slope)| slope.dot(delta[*row as usize]));
                share.part * moved.sum::<f64>()
            };
            let volume = volume.of as usize;
            self.rules.penalty / self.at_rest[volume]
                * self.volumes.of(volume).iter().map(of_share).sum::<f64>()
        };
        self.cells.fill(parts, |cell, parts| {
            let rows = self.cells.rows(cell);
            let change_of_pull: f64 =
                self.of_cell.of(cell).iter().map(|share| share.part * grown(share)).sum();
            let slopes = &slopes[self.cells.places(cell)];
            let pull = self.of_cell(cell, pulls);
            parts.iter_mut().zip(slopes).for_each(|(part, slope)| *part = *slope * -change_of_pull);
            for (weight, gradients) in self.shape(cell).samples() {
                let [J, dJ] = [placed, change].map(|placed| placed.jacobian(rows, gradients));
                let change = cofactor_differential(&J, &dJ) * (-weight * pull);
                parts.iter_mut().zip(gradients).for_each(|(part, gradient)| *part += change * *gradient);
            }
            parts.iter_mut().for_each(|part| *part = *part * weights.position);
        });
        self.cells.gather(parts, out);
    }

    fn visit_cliques(&self, pairs: &[Pair], visit: &mut dyn FnMut(&[u32])) {
        self.inner.visit_cliques(pairs, visit);
        (0..self.volumes.len()).for_each(|volume| visit(self.volume_rows.of(volume)));
    }

    fn add_blocks(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        scratch: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) {
        let scratch = of(scratch);
        self.inner.add_blocks(&self.view(at), weights, &mut scratch.inner, matrix);
        self.assemble(Curvature::Exact, at, weights.position, scratch, matrix);
    }

    fn add_definite_blocks(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        scratch: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) -> bool {
        let scratch = of(scratch);
        let turned = self.inner.add_definite_blocks(&self.view(at), weights, &mut scratch.inner, matrix);
        self.assemble(Curvature::Definite, at, weights.position, scratch, matrix) | turned
    }

    fn advance_memory(&self, at: &Configuration, timestep: f64, memory: &mut [f64], pairs: &mut [Pair]) {
        self.inner.advance_memory(&self.view(at), timestep, self.split(memory).0, pairs);
    }

    // nothing of its own is read there
    fn advances_in_place(&self) -> bool {
        self.inner.memory_len() == 0 || self.inner.advances_in_place()
    }

    fn give_way(&self, at: &Configuration, memory: &mut [f64]) -> bool {
        self.inner.give_way(&self.view(at), self.split(memory).0)
    }

    fn augment(&self, positions: &[Vec3], memory: &mut [f64]) -> Option<Unmet> {
        let Multipliers::Solved { tolerance } = self.rules.multipliers else { return None };
        let (mut off, mut at) = (0.0, 0);
        for volume in 0..self.volumes.len() {
            let growth = self.growth(volume, positions).abs();
            // what is no number is off most
            if growth.is_nan() || growth > off {
                (off, at) = (growth, volume);
            }
        }
        if off <= tolerance {
            return None;
        }
        map_into(self.remembered(self.split(memory).1).multipliers, |volume, multiplier| {
            multiplier + self.rules.penalty * self.growth(volume, positions)
        });
        let row = self.volume_rows.of(at)[0] as usize;
        Some(Unmet { what: "a volume that is kept", off, wanted: tolerance, row })
    }

    fn ends_steps(&self) -> bool {
        true
    }

    fn end_step(&self, positions: &[Vec3], timestep: f64, memory: &mut [f64]) -> bool {
        let (inner, own) = self.split(memory);
        let jumped = self.inner.ends_steps() && self.inner.end_step(positions, timestep, inner);
        match self.rules.multipliers {
            Multipliers::Solved { .. } => self.book_solved(positions, own),
            Multipliers::Relaxed { time } => self.relax(positions, timestep / time, own),
        }
        jumped
    }

    fn editable(&self) -> Vec<Editable> {
        self.inner.editable()
    }

    fn set_parameter(&mut self, name: &str, value: f64) -> Result<(), ParameterError> {
        self.inner.set_parameter(name, value)
    }

    /// As if no multiplier had taken over yet.
    fn cell_field(&self, cell: usize, positions: &[Vec3]) -> Option<CellField> {
        let field = self.inner.cell_field(cell, positions)?;
        Some(self.with_mean_stress(cell, positions, field, &[]))
    }

    fn cell_field_at(&self, cell: usize, at: &Configuration) -> Option<CellField> {
        let field = self.inner.cell_field_at(cell, &self.view(at))?;
        Some(self.with_mean_stress(cell, at.positions, field, self.multipliers(at.memory)))
    }

    fn rest_volume(&self, cell: usize) -> Option<f64> {
        self.inner.rest_volume(cell)
    }

    fn adapted_law(&self, cell: usize, at: &Configuration) -> Option<f64> {
        self.inner.adapted_law(cell, &self.view(at))
    }

    fn adapted(&self, cell: usize, at: &Configuration) -> Option<Adapted> {
        self.inner.adapted(cell, &self.view(at))
    }

    fn law_changes(&self, at: &Configuration) -> Option<LawChanges> {
        self.inner.law_changes(&self.view(at))
    }

    fn bytes(&self) -> usize {
        let shapes: usize =
            self.shapes.iter().map(|shape| 8 * shape.weights.len() + 24 * shape.gradients.len()).sum();
        self.inner.bytes()
            + self.cells.bytes()
            + self.volumes.bytes()
            + self.of_cell.bytes()
            + self.volume_rows.bytes()
            + self.volume_places.bytes()
            + 24 * self.rest.len()
            + 8 * self.at_rest.len()
            + self.shape_of_cell.len()
            + shapes
    }

    fn scratch_bytes(&self, scratch: &Scratch) -> usize {
        scratch.downcast_ref().map_or(0, |VolumeScratch { inner, slopes, parts, pulls, blocks, own }| {
            24 * (slopes.capacity() + parts.capacity() + own.capacity())
                + 8 * pulls.capacity()
                + size_of::<Mat3>() * blocks.capacity()
                + self.inner.scratch_bytes(inner)
        })
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}

/// `δ cof J`.
fn cofactor_differential(J: &Mat3, dJ: &Mat3) -> Mat3 {
    let ([a, b, c], [da, db, dc]) = (J.columns, dJ.columns);
    Mat3::from_columns(db.cross(c) + b.cross(dc), dc.cross(a) + c.cross(da), da.cross(b) + a.cross(db))
}
