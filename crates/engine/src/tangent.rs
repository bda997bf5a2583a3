//! The matrix of an implicit step over velocity blocks, assembled from what forces say over rows.
//!
//! With rows `x(q)`, `δx = T δ`, row velocities `ẋ` with `δẋ = D δ`, and the unbalanced row force
//! `g = b M (ẋ - p) - f`, the residual is `r = Tᵀ g` and its derivative
//!
//! `A = ∂(Tᵀ)g + Tᵀ (b M D - ∂f/∂x T - ∂f/∂v D)`,
//!
//! for points alone, `D = a`, `a b M - ∂f/∂x - a ∂f/∂v`, with the [`Rates`] `a` and `b`. In statics both are zero.

use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

use souple_math::{Mat3, Vec3, eigen_symmetric};
use souple_solve::{BlockMatrix, LinearOperator, Pattern, PatternBuilder};

use crate::force::{Configuration, Declaration, Force, Scratch, TangentWeights};
use crate::frame_mass::FrameMass;
use crate::implicit::Rates;
use crate::kinematics::{Geometric, Kinematics, RowMaps};
use crate::state::{Pair, SystemState};
use crate::system::{Rows, Surroundings, System};

/// Matrices of a system, kept between steps; patterns change only when what is coupled does.
#[derive(Debug, Default)]
pub struct Tangent {
    /// `(force, a, b)` of the pairs that the row pattern was made for.
    pattern_pairs: Option<Vec<(u64, u64, u64)>>,
    /// `∂f/∂x` over rows; for points alone the whole system matrix.
    rows: Option<BlockMatrix>,
    /// `∂f/∂v` over rows, apart where `T` and `D` differ by more than a factor.
    row_velocities: Option<BlockMatrix>,
    /// Over velocity blocks, where rows are more than points.
    blocks: Option<BlockMatrix>,
    mass: Option<BlockMatrix>,
    diagonal: Option<BlockMatrix>,
    /// `g` on free rows.
    unbalanced: Vec<Vec3>,
    /// The matrix with symmetric stand-ins of what is not symmetric, for points alone.
    symmetric: Option<BlockMatrix>,
    /// Forces that are not [`is_lasting`] are left out.
    is_of_lasting: bool,
}

/// Which tangent is assembled of forces whose tangent is symmetric.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Curvature {
    /// As it is.
    Exact,
    /// With what is negative of it turned round, part by part ([`Force::add_definite_blocks`]), or left out, of what turns of frames add.
    Definite,
}

/// A system matrix and what is known to precondition it with.
pub struct Assembled<'a> {
    pub matrix: &'a mut BlockMatrix,
    /// Symmetric and near the matrix, where that is not symmetric itself.
    pub symmetric: Option<&'a mut BlockMatrix>,
    /// Whether anything of it was turned round to be definite.
    pub turned: bool,
}

/// Where the matrix is taken.
pub struct Linearisation<'a> {
    pub system: &'a System,
    pub state: &'a SystemState,
    pub around: Surroundings<'a>,
    pub rows: &'a Rows,
    /// Configuration and velocity of the unknowns at the rows.
    pub q: &'a [Vec3],
    pub v: &'a [Vec3],
    pub rates: Rates,
    /// `g` over rows.
    pub unbalanced: &'a [Vec3],
}

impl Linearisation<'_> {
    fn velocity_maps(&self, free_row: u32) -> RowMaps {
        let kinematics = &self.system.kinematics;
        if !self.rates.has_velocity() {
            return RowMaps { first: (kinematics.block_of(free_row), Mat3::ZERO), second: None };
        }
        kinematics.velocity_maps(free_row, self.q, self.v, self.rates.velocity)
    }

    /// `g` over free rows as turns of rigid frames see it: without forces whose tangent leaves out what stress adds.
    fn turned_into(&self, scratches: &mut [Scratch], out: &mut [Vec3]) {
        out.copy_from_slice(self.unbalanced);
        for (index, force) in self.system.forces.iter().enumerate() {
            if force.leaves_out_stress() {
                // g = M a - f
                let view = self.system.view(index, self.rows, self.state, &self.around);
                force.add_force(&view, &mut scratches[index], out);
            }
        }
        self.system.kinematics.return_forces(out);
    }
}

/// Adds what the forces on a turning frame add to the tangent, of a definite one the part that pulls back into the turn; whether any was left out.
fn add_geometric(of_frame: Option<(u32, Mat3)>, curvature: Curvature, blocks: &mut BlockMatrix) -> bool {
    let Some((block, geometric)) = of_frame else { return false };
    let (part, is_cut) = match curvature {
        Curvature::Exact => (geometric, false),
        Curvature::Definite => {
            let eigen = eigen_symmetric(&geometric.symmetric_part());
            let values = eigen.values.to_array();
            let rounding = f64::EPSILON * values.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
            let kept = Mat3::from_diagonal(Vec3::from_array(values.map(|value| value.max(0.0))));
            let axes = &eigen.vectors;
            (*axes * kept * axes.transpose(), values.iter().any(|value| *value < -rounding))
        }
    };
    add_block(blocks, block as usize, block as usize, &part);
    is_cut
}

/// Adds what the forces on a turning frame add between its turn and an amplitude, which no definite matrix has; whether any was left out.
fn add_coupling(
    turn: u32,
    of_amplitude: Option<(u32, Mat3)>,
    curvature: Curvature,
    blocks: &mut BlockMatrix,
) -> bool {
    let Some((amplitude, coupling)) = of_amplitude else { return false };
    if curvature == Curvature::Definite {
        return coupling != Mat3::ZERO;
    }
    add_block(blocks, turn as usize, amplitude as usize, &coupling);
    add_block(blocks, amplitude as usize, turn as usize, &coupling.transpose());
    false
}

impl Tangent {
    /// Of the forces alone that are [`is_lasting`].
    pub fn of_lasting_forces() -> Self {
        Self { is_of_lasting: true, ..Self::default() }
    }

    /// The matrix at a linearisation, constrained directions replaced by the identity scaled like the rest.
    pub fn assemble(&mut self, at: &Linearisation, scratches: &mut [Scratch]) -> &mut BlockMatrix {
        self.assemble_with(Curvature::Exact, at, scratches).0
    }

    /// The matrix, and whether anything of it was turned round to be definite.
    fn assemble_with(
        &mut self,
        curvature: Curvature,
        at: &Linearisation,
        scratches: &mut [Scratch],
    ) -> (&mut BlockMatrix, bool) {
        let system = at.system;
        self.update_patterns(system, &at.state.pairs);
        let trivial = system.kinematics.is_trivial();
        let mut rows = self.rows.take().unwrap_or_else(|| unreachable!("patterns were just made"));
        rows.set_zero();
        let weights =
            TangentWeights { position: -1.0, velocity: if trivial { -at.rates.velocity } else { 0.0 } };
        let mut turned = self.add_row_blocks(curvature, at, weights, scratches, &mut rows);
        if trivial {
            // A = a b M - ∂f/∂x - a ∂f/∂v
            add_mass(system, at.rates.inertia(), &mut rows);
            constrain(system, &mut rows);
            return (self.rows.insert(rows), turned);
        }
        let kinematics = &system.kinematics;
        let mut blocks = self.blocks.take().unwrap_or_else(|| unreachable!("patterns were just made"));
        blocks.set_zero();
        // each serves as many pairs as rows are coupled with its own
        let free_rows = 0..kinematics.free_row_count() as u32;
        let position_maps: Vec<RowMaps> =
            free_rows.clone().map(|row| kinematics.position_maps(row, at.q)).collect();
        let velocity_maps: Vec<RowMaps> = free_rows.map(|row| at.velocity_maps(row)).collect();
        let position_map = |row: u32| position_maps[row as usize];
        let velocity_map = |row: u32| velocity_maps[row as usize];
        // -Tᵀ ∂f/∂x T
        transform_rows(kinematics, &rows, &mut blocks, &position_map, &position_map);
        if at.rates.has_velocity() && system.forces.iter().any(|force| force.declaration().velocity_terms) {
            // -Tᵀ ∂f/∂v D
            let mut damping =
                self.row_velocities.take().unwrap_or_else(|| BlockMatrix::zeros(rows.pattern().clone()));
            damping.set_zero();
            let weights = TangentWeights { position: 0.0, velocity: -1.0 };
            turned |= self.add_row_blocks(curvature, at, weights, scratches, &mut damping);
            transform_rows(kinematics, &damping, &mut blocks, &position_map, &velocity_map);
            self.row_velocities = Some(damping);
        }
        // b Tᵀ M D
        let rate = at.rates.acceleration;
        for (row, mass) in system.mass.diagonal.iter().enumerate().filter(|(_, mass)| **mass != 0.0) {
            let scaled = |left: &Mat3, right: &Mat3| left.transpose_mul(right) * (mass * rate);
            add_congruent(kinematics, &mut blocks, (row, row), &position_map, &velocity_map, scaled);
        }
        for &(a, b, mass) in &system.mass.couplings {
            let scaled = |left: &Mat3, right: &Mat3| left.transpose_mul(right) * (mass * rate);
            for pair in [(a as usize, b as usize), (b as usize, a as usize)] {
                add_congruent(kinematics, &mut blocks, pair, &position_map, &velocity_map, scaled);
            }
        }
        self.rows = Some(rows);
        // ∂(Tᵀ) g
        if kinematics.has_turning_frames() {
            let mut unbalanced = std::mem::take(&mut self.unbalanced);
            unbalanced.resize(at.unbalanced.len(), Vec3::ZERO);
            at.turned_into(scratches, &mut unbalanced);
            // rows of a frame follow each other
            let mut of_frame: Option<(u32, Mat3)> = None;
            for (row, g) in unbalanced[..kinematics.free_row_count()].iter().enumerate() {
                let Some(Geometric { turn: (block, part), coupling }) =
                    kinematics.geometric(row as u32, at.q, *g)
                else {
                    continue;
                };
                turned |= add_coupling(block, coupling, curvature, &mut blocks);
                of_frame = match of_frame {
                    Some((last, sum)) if last == block => Some((last, sum + part)),
                    done => {
                        turned |= add_geometric(done, curvature, &mut blocks);
                        Some((block, part))
                    }
                };
            }
            turned |= add_geometric(of_frame, curvature, &mut blocks);
            self.unbalanced = unbalanced;
        }
        constrain(system, &mut blocks);
        (self.blocks.insert(blocks), turned)
    }

    /// [`Tangent::assemble`], and where forces are not symmetric the same with [`Force::add_symmetric_blocks`].
    pub fn assemble_with_symmetric(
        &mut self,
        curvature: Curvature,
        at: &Linearisation,
        scratches: &mut [Scratch],
    ) -> Assembled<'_> {
        let system = at.system;
        let has_symmetry = |force: &dyn Force| force.declaration().symmetric_tangent;
        let all_symmetric = system.forces.iter().all(|force| has_symmetry(force.as_ref()));
        if all_symmetric || !system.kinematics.is_trivial() {
            let (matrix, turned) = self.assemble_with(curvature, at, scratches);
            return Assembled { matrix, symmetric: None, turned };
        }
        self.update_patterns(system, &at.state.pairs);
        let weights = TangentWeights { position: -1.0, velocity: -at.rates.velocity };
        let mut matrix = self.rows.take().unwrap_or_else(|| unreachable!("patterns were just made"));
        matrix.set_zero();
        let mut turned = false;
        for (index, force) in system.forces.iter().enumerate() {
            if has_symmetry(force.as_ref()) {
                let view = system.view(index, at.rows, at.state, &at.around);
                turned |= add_blocks_of(
                    force.as_ref(),
                    curvature,
                    &view,
                    weights,
                    &mut scratches[index],
                    &mut matrix,
                );
            }
        }
        add_mass(system, at.rates.inertia(), &mut matrix);
        let known = self.symmetric.take().filter(|known| Arc::ptr_eq(known.pattern(), matrix.pattern()));
        let mut symmetric = known.unwrap_or_else(|| BlockMatrix::zeros(Arc::clone(matrix.pattern())));
        symmetric.values_mut().copy_from_slice(matrix.values());
        for (index, force) in system.forces.iter().enumerate() {
            if !has_symmetry(force.as_ref()) {
                let view = system.view(index, at.rows, at.state, &at.around);
                force.add_blocks(&view, weights, &mut scratches[index], &mut matrix);
                force.add_symmetric_blocks(&view, weights, &mut scratches[index], &mut symmetric);
            }
        }
        constrain(system, &mut matrix);
        constrain(system, &mut symmetric);
        let symmetric = Some(self.symmetric.insert(symmetric));
        Assembled { matrix: self.rows.insert(matrix), symmetric, turned }
    }

    /// The diagonal blocks alone, for preconditioning products without a matrix; for points only: rows of
    /// frames and derived rows have their diagonal taken from the full matrix.
    pub fn assemble_diagonal(&mut self, at: &Linearisation, scratches: &mut [Scratch]) -> &mut BlockMatrix {
        let system = at.system;
        if !system.kinematics.is_trivial() {
            return self.assemble(at, scratches);
        }
        let mut diagonal = self.diagonal.take().unwrap_or_else(|| {
            let pattern = Pattern::diagonal(system.kinematics.block_count());
            BlockMatrix::zeros(Arc::new(pattern.unwrap_or_else(|error| panic!("too many points: {error}"))))
        });
        diagonal.set_zero();
        self.add_row_blocks(
            Curvature::Exact,
            at,
            TangentWeights { position: -1.0, velocity: -at.rates.velocity },
            scratches,
            &mut diagonal,
        );
        add_mass(system, at.rates.inertia(), &mut diagonal);
        constrain(system, &mut diagonal);
        self.diagonal.insert(diagonal)
    }

    /// Whether anything was turned round to be definite.
    fn add_row_blocks(
        &self,
        curvature: Curvature,
        at: &Linearisation,
        weights: TangentWeights,
        scratches: &mut [Scratch],
        matrix: &mut BlockMatrix,
    ) -> bool {
        let mut turned = false;
        for (index, force) in at.system.forces.iter().enumerate() {
            if self.is_of_lasting && !is_lasting(force.as_ref()) {
                continue;
            }
            let view = at.system.view(index, at.rows, at.state, &at.around);
            turned |= add_blocks_of(force.as_ref(), curvature, &view, weights, &mut scratches[index], matrix);
        }
        turned
    }

    /// Forces have come or gone: what is coupled is asked for again.
    pub fn forget_patterns(&mut self) {
        self.pattern_pairs = None;
    }

    fn update_patterns(&mut self, system: &System, pairs: &[Pair]) {
        let changes = system.has_pairs();
        let coupling = if changes { pairs } else { &[] };
        let keys = || coupling.iter().map(Pair::key);
        if self.pattern_pairs.as_ref().is_some_and(|known| known.iter().copied().eq(keys())) {
            return;
        }
        let kinematics = &system.kinematics;
        let mut over_rows = PatternBuilder::new(kinematics.row_count());
        let mut over_blocks = PatternBuilder::new(kinematics.block_count());
        let mut clique_blocks = Vec::new();
        let mut add = |rows: &[u32]| {
            over_rows
                .add_clique(rows)
                .unwrap_or_else(|error| panic!("a force couples rows that are not there: {error}"));
            if !kinematics.is_trivial() {
                clique_blocks.clear();
                clique_blocks.extend(rows.iter().flat_map(|&row| {
                    let (forward, backward) =
                        (kinematics.forward(row as usize), kinematics.backward(row as usize));
                    forward.iter().chain(backward).flat_map(|&(free, _)| kinematics.blocks_of(free))
                }));
                clique_blocks.sort_unstable();
                clique_blocks.dedup();
                over_blocks
                    .add_clique(&clique_blocks)
                    .unwrap_or_else(|error| panic!("rows move with no block: {error}"));
            }
        };
        for (index, force) in system.forces.iter().enumerate() {
            force.visit_cliques(&pairs[crate::state::pairs_of(pairs, index)], &mut add);
        }
        for &(a, b, _) in &system.mass.couplings {
            add(&[a, b]);
        }
        for row in rows_with_blocks(system) {
            add(&[row as u32]);
        }
        let build = |builder: PatternBuilder| {
            Arc::new(builder.build().unwrap_or_else(|error| panic!("the matrix is too large: {error}")))
        };
        self.rows = Some(BlockMatrix::zeros(build(over_rows)));
        self.row_velocities = None;
        self.blocks = (!kinematics.is_trivial()).then(|| BlockMatrix::zeros(build(over_blocks)));
        self.pattern_pairs = Some(keys().collect());
    }

    /// The buffer for `TᵀMT`; give it back with [`Tangent::put_mass_matrix`].
    pub fn take_mass_matrix(&mut self, system: &System) -> BlockMatrix {
        self.mass.take().unwrap_or_else(|| {
            let kinematics = &system.kinematics;
            let mut builder = PatternBuilder::new(kinematics.block_count());
            let mut add = |rows: &[usize]| {
                let blocks: Vec<u32> = rows
                    .iter()
                    .flat_map(|&row| {
                        kinematics.forward(row).iter().flat_map(|&(free, _)| kinematics.blocks_of(free))
                    })
                    .collect();
                builder
                    .add_clique(&blocks)
                    .unwrap_or_else(|error| panic!("rows move with no block: {error}"));
            };
            rows_with_blocks(system).for_each(|row| add(&[row]));
            system.mass.couplings.iter().for_each(|&(a, b, _)| add(&[a as usize, b as usize]));
            let pattern =
                builder.build().unwrap_or_else(|error| panic!("the mass matrix is too large: {error}"));
            BlockMatrix::zeros(Arc::new(pattern))
        })
    }

    pub fn put_mass_matrix(&mut self, matrix: BlockMatrix) {
        self.mass = Some(matrix);
    }

    /// Bytes of matrices held.
    pub fn bytes(&self) -> usize {
        let held =
            [&self.rows, &self.row_velocities, &self.blocks, &self.mass, &self.diagonal, &self.symmetric];
        let keys = size_of::<(u64, u64, u64)>() * self.pattern_pairs.as_ref().map_or(0, Vec::capacity);
        held.into_iter().flatten().map(BlockMatrix::bytes).sum::<usize>()
            + keys
            + 24 * self.unbalanced.capacity()
    }
}

/// Rows whose diagonal block may hold something besides forces: unknowns, and derived rows of a mass of their own.
fn rows_with_blocks(system: &System) -> impl Iterator<Item = usize> {
    let free = system.kinematics.free_row_count();
    (0..system.kinematics.row_count()).filter(move |row| *row < free || system.mass.diagonal[*row] != 0.0)
}

/// Whether the tangent of a force follows from where the rows are, whatever was before, and is symmetric.
pub fn is_lasting(force: &dyn Force) -> bool {
    let Declaration { changing_pattern, symmetric_tangent, .. } = force.declaration();
    !force.tangent_reads_memory() && !changing_pattern && symmetric_tangent
}

fn add_blocks_of(
    force: &dyn Force,
    curvature: Curvature,
    at: &Configuration,
    weights: TangentWeights,
    scratch: &mut Scratch,
    matrix: &mut BlockMatrix,
) -> bool {
    if curvature == Curvature::Definite && force.declaration().symmetric_tangent {
        return force.add_definite_blocks(at, weights, scratch, matrix);
    }
    force.add_blocks(at, weights, scratch, matrix);
    false
}

fn add_mass(system: &System, scale: f64, matrix: &mut BlockMatrix) {
    if scale == 0.0 {
        return;
    }
    for (row, mass) in system.mass.diagonal.iter().enumerate() {
        add_block(matrix, row, row, &(Mat3::IDENTITY * (mass * scale)));
    }
    for &(a, b, mass) in &system.mass.couplings {
        let block = Mat3::IDENTITY * (mass * scale);
        add_block(matrix, a as usize, b as usize, &block);
        add_block(matrix, b as usize, a as usize, &block);
    }
}

/// Constrained directions become `scale · I`, with the mean diagonal as the scale so that the matrix stays
/// as well conditioned as it was.
pub fn constrain(system: &System, matrix: &mut BlockMatrix) {
    if system.constraints.is_empty() {
        return;
    }
    let mean = matrix.mean_diagonal().abs();
    let scale = if mean > 0.0 { mean } else { 1.0 };
    let constrained =
        system.constraints.iter().map(|constraint| (constraint.block as usize, constraint.free));
    matrix
        .constrain_blocks(constrained, scale)
        .unwrap_or_else(|error| panic!("constraints name blocks: {error}"));
}

/// `matrix[a, b] += block`; blocks outside the pattern are dropped, so that a matrix of the diagonal alone
/// can be assembled by the same text.
#[inline]
pub fn add_block(matrix: &mut BlockMatrix, a: usize, b: usize, block: &Mat3) {
    if let Some(slot) = matrix.pattern().slot(a, b) {
        matrix.add_at(slot, block);
    }
}

/// `blocks += Leftᵀ rows Right`, expanding derived rows.
fn transform_rows(
    kinematics: &Kinematics,
    rows: &BlockMatrix,
    blocks: &mut BlockMatrix,
    left_map: &dyn Fn(u32) -> RowMaps,
    right_map: &dyn Fn(u32) -> RowMaps,
) {
    let (pattern, of_blocks) = (rows.pattern().clone(), blocks.pattern().clone());
    let free_rows = kinematics.free_row_count();
    for a in 0..pattern.block_count() {
        // rows of modes move with two blocks, and are expanded like derived ones
        let is_free = a < free_rows && !kinematics.is_of_mode(a as u32);
        let left = if is_free { left_map(a as u32).first.1 } else { Mat3::IDENTITY };
        // columns of free rows ascend, and so do the columns of their blocks: no place is looked for twice
        let mut places = if is_free { of_blocks.slots(kinematics.block_of(a as u32) as usize) } else { 0..0 };
        for slot in pattern.slots(a) {
            let (b, value) = (pattern.columns()[slot] as usize, rows.values()[slot]);
            // derived rows that no force acts on would be expanded for nothing
            if value == Mat3::ZERO {
                continue;
            }
            if is_free && b < free_rows && !kinematics.is_of_mode(b as u32) {
                let column = kinematics.block_of(b as u32);
                while places.start < places.end && of_blocks.columns()[places.start] < column {
                    places.start += 1;
                }
                if places.start < places.end && of_blocks.columns()[places.start] == column {
                    blocks.add_at(places.start, &left.transpose_mul(&(value * right_map(b as u32).first.1)));
                }
                continue;
            }
            let product = |left: &Mat3, right: &Mat3| left.transpose_mul(&(value * *right));
            add_congruent(kinematics, blocks, (a, b), left_map, right_map, product);
        }
    }
}

/// `blocks[i, j] += w_ai w_bj product(Left_i, Right_j)` over the free rows `i` that receive the force on
/// row `a` and the free rows `j` that carry row `b`.
pub fn add_congruent(
    kinematics: &Kinematics,
    blocks: &mut BlockMatrix,
    (a, b): (usize, usize),
    left_map: &dyn Fn(u32) -> RowMaps,
    right_map: &dyn Fn(u32) -> RowMaps,
    product: impl Fn(&Mat3, &Mat3) -> Mat3,
) {
    for &(i, weight_i) in kinematics.backward(a) {
        let of_i = left_map(i);
        for &(j, weight_j) in kinematics.forward(b) {
            let of_j = right_map(j);
            for (row, left) in of_i.iter() {
                for (column, right) in of_j.iter() {
                    let value = product(left, right) * (weight_i * weight_j);
                    add_block(blocks, row as usize, column as usize, &value);
                }
            }
        }
    }
}

/// The matrix of [`Tangent::assemble`], known by its products alone.
pub struct TangentOperator<'a> {
    at: &'a Linearisation<'a>,
    part: Part,
    buffers: Mutex<(&'a mut [Scratch], &'a mut OperatorBuffers)>,
}

/// What of a matrix products are with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    Whole,
    /// `(A + Aᵀ)/2` where turning frames are all that breaks symmetry.
    Symmetric,
}

/// Vectors and maps of [`TangentOperator`], kept between steps; only where rows are more than points.
pub struct OperatorBuffers {
    free: Vec<Vec3>,
    row_positions: Vec<Vec3>,
    row_velocities: Vec<Vec3>,
    row_force: Vec<Vec3>,
    row_inertia: Vec<Vec3>,
    /// `D` of every free row.
    velocity_maps: Vec<RowMaps>,
    /// `∂(Tᵀ) g` of every block.
    geometric: Vec<Mat3>,
    /// The same between the turn of a frame and an amplitude.
    couplings: Vec<(u32, u32, Mat3)>,
    /// Derived rows that forces of no pairs or masses look at; the others are there to be seen.
    derived: Vec<u32>,
    /// Made by the first product, with `derived`.
    mass: Option<FrameMass>,
    /// Wall seconds that products have taken since they were asked for last.
    seconds: f64,
}

impl OperatorBuffers {
    pub fn new(system: &System) -> Self {
        let trivial = system.kinematics.is_trivial();
        let rows = || vec![Vec3::ZERO; if trivial { 0 } else { system.kinematics.row_count() }];
        Self {
            free: vec![Vec3::ZERO; system.kinematics.block_count()],
            row_positions: rows(),
            row_velocities: rows(),
            row_force: rows(),
            row_inertia: rows(),
            velocity_maps: Vec::new(),
            geometric: Vec::new(),
            couplings: Vec::new(),
            derived: Vec::new(),
            mass: None,
            seconds: 0.0,
        }
    }

    /// Wall seconds that products have taken since this was asked last.
    pub fn take_seconds(&mut self) -> f64 {
        std::mem::take(&mut self.seconds)
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let Self { free, row_positions, row_velocities, row_force, row_inertia, .. } = self;
        let buffers = [free, row_positions, row_velocities, row_force, row_inertia];
        buffers.into_iter().map(|buffer| size_of::<Vec3>() * buffer.capacity()).sum::<usize>()
            + size_of::<RowMaps>() * self.velocity_maps.capacity()
            + size_of::<Mat3>() * self.geometric.capacity()
            + size_of::<(u32, u32, Mat3)>() * self.couplings.capacity()
            + 4 * self.derived.capacity()
            + self.mass.as_ref().map_or(0, FrameMass::bytes)
    }

    /// Derived rows that have to be placed for forces to be asked; `None` where that is all of them.
    pub fn rows_at_work(&mut self, system: &System) -> Option<&[u32]> {
        let suffices = system.forces.iter().all(|force| force.reads_cliques_alone());
        if system.kinematics.is_trivial() || system.has_pairs() || !suffices {
            return None;
        }
        self.learn(system);
        Some(&self.derived)
    }

    /// `out += M x` over rows.
    pub fn add_mass_product(&mut self, system: &System, x: &[Vec3], out: &mut [Vec3]) {
        match self.mass_of(system) {
            Some(mass) => mass.add_scaled_product(1.0, x, out),
            None => system.mass.add_product(x, out),
        }
    }

    /// `½ ẋᵀ M ẋ` [J].
    pub fn kinetic_energy(&mut self, system: &System, velocities: &[Vec3]) -> f64 {
        match self.mass_of(system) {
            Some(mass) => mass.kinetic_energy(velocities),
            None => system.mass.kinetic_energy(velocities),
        }
    }

    /// The mass in tiles, where there are frames.
    fn mass_of(&mut self, system: &System) -> Option<&mut FrameMass> {
        if !system.kinematics.has_frames() {
            return None;
        }
        self.learn(system);
        self.mass.as_mut()
    }

    fn learn(&mut self, system: &System) {
        if self.mass.is_none() {
            self.derived = derived_rows_at_work(system);
            self.mass = Some(FrameMass::new(&system.mass, &system.kinematics));
        }
    }

    /// What all products at a linearisation have in common.
    fn prepare(&mut self, at: &Linearisation, part: Part, scratches: &mut [Scratch]) {
        let kinematics = &at.system.kinematics;
        if kinematics.is_trivial() {
            return;
        }
        self.learn(at.system);
        // derived rows that are not looked at keep nothing of solves before
        self.row_positions.fill(Vec3::ZERO);
        self.row_velocities.fill(Vec3::ZERO);
        self.velocity_maps.clear();
        if at.rates.has_velocity() {
            let free_rows = 0..kinematics.free_row_count() as u32;
            self.velocity_maps.extend(free_rows.map(|row| at.velocity_maps(row)));
        }
        self.geometric.clear();
        self.couplings.clear();
        if kinematics.has_turning_frames() {
            self.geometric.resize(kinematics.block_count(), Mat3::ZERO);
            at.turned_into(scratches, &mut self.row_force);
            for (row, g) in self.row_force[..kinematics.free_row_count()].iter().enumerate() {
                if let Some(Geometric { turn: (block, geometric), coupling }) =
                    kinematics.geometric(row as u32, at.q, *g)
                {
                    self.geometric[block as usize] += match part {
                        Part::Whole => geometric,
                        Part::Symmetric => geometric.symmetric_part(),
                    };
                    self.couplings.extend(coupling.map(|(amplitude, part)| (block, amplitude, part)));
                }
            }
        }
    }

    /// Fills derived rows that are looked at.
    fn derive(at: &Linearisation, derived: &[u32], rows: &mut [Vec3]) {
        let kinematics = &at.system.kinematics;
        if at.system.has_pairs() && !at.state.pairs.is_empty() {
            kinematics.derive_rows(rows);
        } else {
            kinematics.derive_some_rows(derived, rows);
        }
    }
}

/// Derived rows with a mass, and those that forces couple whatever the pairs.
fn derived_rows_at_work(system: &System) -> Vec<u32> {
    let free = system.kinematics.free_row_count() as u32;
    let mut rows: Vec<u32> = rows_with_blocks(system).map(|row| row as u32).collect();
    for force in &system.forces {
        force.visit_cliques(&[], &mut |clique| rows.extend(clique.iter().filter(|row| **row >= free)));
    }
    rows.extend(system.mass.couplings.iter().flat_map(|&(a, b, _)| [a, b]));
    rows.retain(|row| *row >= free);
    rows.sort_unstable();
    rows.dedup();
    rows
}

impl<'a> TangentOperator<'a> {
    pub fn new(
        at: &'a Linearisation<'a>,
        part: Part,
        scratches: &'a mut [Scratch],
        buffers: &'a mut OperatorBuffers,
    ) -> Self {
        buffers.prepare(at, part, scratches);
        Self { at, part, buffers: Mutex::new((scratches, buffers)) }
    }

    /// `out = A δ` before constraints are imposed.
    pub fn apply_unconstrained(&self, delta: &[Vec3], out: &mut [Vec3]) {
        let mut buffers = self.buffers.lock().unwrap_or_else(PoisonError::into_inner);
        let (scratches, buffers) = &mut *buffers;
        let clock = Instant::now();
        self.product(delta, out, scratches, buffers);
        buffers.seconds += clock.elapsed().as_secs_f64();
    }

    fn product(
        &self,
        delta: &[Vec3],
        out: &mut [Vec3],
        scratches: &mut [Scratch],
        buffers: &mut OperatorBuffers,
    ) {
        let (at, system) = (self.at, self.at.system);
        let kinematics = &system.kinematics;
        if kinematics.is_trivial() {
            return self.product_of_points(delta, out, scratches);
        }
        let OperatorBuffers { row_positions, row_velocities, row_force, row_inertia, velocity_maps, .. } =
            buffers;
        // δx = T δ,  δẋ = D δ
        kinematics.free_velocities_into(at.q, delta, row_positions);
        OperatorBuffers::derive(at, &buffers.derived, row_positions);
        for (velocity, maps) in row_velocities.iter_mut().zip(&*velocity_maps) {
            *velocity = maps.apply(delta);
        }
        if at.rates.has_velocity() {
            OperatorBuffers::derive(at, &buffers.derived, row_velocities);
        }
        // Tᵀ (b M δẋ - ∂f/∂x δx - ∂f/∂v δẋ), or of what is not symmetric half and of its transpose Dᵀ (b M δx - ∂f/∂v δx) half
        row_force.fill(Vec3::ZERO);
        row_inertia.fill(Vec3::ZERO);
        let is_halved = self.part == Part::Symmetric && at.rates.has_velocity();
        let share = if is_halved { 0.5 } else { 1.0 };
        if let Some(mass) = buffers.mass.as_mut().filter(|_| at.rates.has_inertia()) {
            let rate = share * at.rates.acceleration;
            mass.add_scaled_product(rate, row_velocities, row_force);
            if is_halved {
                mass.add_scaled_product(rate, row_positions, row_inertia);
            }
        }
        for (index, force) in system.forces.iter().enumerate() {
            let view = at.system.view(index, at.rows, at.state, &at.around);
            let position = TangentWeights { position: -1.0, velocity: 0.0 };
            force.add_differential(&view, position, row_positions, &mut scratches[index], row_force);
            if at.rates.has_velocity() && force.declaration().velocity_terms {
                let velocity = TangentWeights { position: 0.0, velocity: -share };
                force.add_differential(&view, velocity, row_velocities, &mut scratches[index], row_force);
                if is_halved {
                    force.add_differential(
                        &view,
                        velocity,
                        row_positions,
                        &mut scratches[index],
                        row_inertia,
                    );
                }
            }
        }
        kinematics.forces_into(at.q, row_force, out);
        if is_halved {
            kinematics.return_forces(row_inertia);
            for (maps, force) in velocity_maps.iter().zip(&*row_inertia) {
                maps.add_transposed(*force, out);
            }
        }
        for ((out, geometric), delta) in out.iter_mut().zip(&buffers.geometric).zip(delta) {
            *out += *geometric * *delta;
        }
        for (turn, amplitude, coupling) in &buffers.couplings {
            let (turn, amplitude) = (*turn as usize, *amplitude as usize);
            out[turn] += *coupling * delta[amplitude];
            out[amplitude] += coupling.transpose_apply(delta[turn]);
        }
    }
}

impl TangentOperator<'_> {
    // a b M δ - ∂f/∂x δ - a (∂f/∂v) δ with the rates a of velocities and b of accelerations
    fn product_of_points(&self, delta: &[Vec3], out: &mut [Vec3], scratches: &mut [Scratch]) {
        let (at, system) = (self.at, self.at.system);
        out.fill(Vec3::ZERO);
        let inertia = at.rates.inertia();
        if inertia > 0.0 {
            system.mass.add_scaled_product(inertia, delta, out);
        }
        let weights = TangentWeights { position: -1.0, velocity: -at.rates.velocity };
        for (index, force) in system.forces.iter().enumerate() {
            let view = at.system.view(index, at.rows, at.state, &at.around);
            force.add_differential(&view, weights, delta, &mut scratches[index], out);
        }
    }
}

impl LinearOperator for TangentOperator<'_> {
    fn block_count(&self) -> usize {
        self.at.system.kinematics.block_count()
    }

    fn apply(&self, x: &[Vec3], y: &mut [Vec3]) {
        let mut buffers = self.buffers.lock().unwrap_or_else(PoisonError::into_inner);
        let (scratches, buffers) = &mut *buffers;
        let mut free = std::mem::take(&mut buffers.free);
        free.copy_from_slice(x);
        self.at.system.project_free(&mut free);
        let clock = Instant::now();
        self.product(&free, y, scratches, buffers);
        buffers.seconds += clock.elapsed().as_secs_f64();
        buffers.free = free;
        // S A S + (I - S)
        for constraint in &self.at.system.constraints {
            let block = constraint.block as usize;
            y[block] = constraint.free * y[block] + constraint.constrained() * x[block];
        }
    }
}
