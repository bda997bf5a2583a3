//! Three spaces: *unknowns* move, *rows* follow them linearly, *samples* read rows.
//!
//! An unknown is a point (3 velocities), a rigid frame (6), an affine frame (12), a quadratic frame (30) or a floating
//! frame (6 and one for each of its modes). Its configuration is a run of [`Vec3`] *free rows*: a point is its position; a frame is its
//! origin and its three axes, so that a material point `x = Σ weight · row` and a deformation gradient
//! `F = Σ row ⊗ gradient` are linear in rows whatever carries them. Its velocity is a run of *blocks* of three:
//! 1, 2 (linear, angular), 4, 10, or 2 and those of amplitudes, three to a block.
//!
//! The rigid reduction happens here and nowhere else: axes `aₖ` turn with `ȧₖ = ω × aₖ`, forces come back as
//! the torque `Σ aₖ × fₖ`. So does that of modes: of each amplitude `u` a floating frame has the three rows `bₖ = u aₖ`,
//! and `x = c + Σ sₖ aₖ + Σ φₖ bₖ = c + R (s + u φ)` is linear in rows with weights that never change; they move with
//! `ḃₖ = ω × bₖ + u̇ aₖ`, and forces come back as `Σ bₖ × fₖ` and `Σ aₖ · fₖ`. A row of a mode moves with two blocks, all
//! others with one.
//!
//! After the free rows stand *derived* rows (hanging nodes, ghosts, attachments), each a weighted sum of
//! earlier rows. Positions and velocities run forward through them; forces run back transposed, unless a
//! row's [`Feedback`] says that it gives nothing back.

use std::ops::Range;
use std::slice;
use std::sync::OnceLock;

use souple_math::{Mat3, Vec3, exponential, logarithm, orthonormalised};
use souple_solve::reduce;

/// What an unknown is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UnknownKind {
    Point,
    RigidFrame,
    AffineFrame,
    /// An affine frame with the six rows of the products of its coordinates.
    QuadraticFrame,
    /// A rigid frame and the amplitudes of shapes that turn with it.
    FloatingFrame {
        modes: u32,
    },
}

/// Rows of a frame that turns or stretches: its origin and its axes.
const ROWS_OF_FRAME: usize = 4;
/// Rows of a quadratic frame: a constant, three linear and six quadratic ones.
const ROWS_OF_QUADRATIC: usize = 10;
/// Blocks of a frame that turns: linear and angular.
const BLOCKS_OF_RIGID: usize = 2;

impl UnknownKind {
    /// Free rows of its configuration.
    pub fn row_count(self) -> usize {
        match self {
            Self::Point => 1,
            Self::RigidFrame | Self::AffineFrame => ROWS_OF_FRAME,
            Self::QuadraticFrame => ROWS_OF_QUADRATIC,
            Self::FloatingFrame { modes } => ROWS_OF_FRAME + 3 * modes as usize,
        }
    }

    /// Blocks of three of its velocity.
    pub fn block_count(self) -> usize {
        match self {
            Self::Point => 1,
            Self::RigidFrame => BLOCKS_OF_RIGID,
            Self::AffineFrame => ROWS_OF_FRAME,
            Self::QuadraticFrame => ROWS_OF_QUADRATIC,
            Self::FloatingFrame { modes } => BLOCKS_OF_RIGID + (modes as usize).div_ceil(3),
        }
    }

    /// Whether it has axes that turn.
    pub fn turns(self) -> bool {
        matches!(self, Self::RigidFrame | Self::FloatingFrame { .. })
    }

    /// Amplitudes of modes.
    fn mode_count(self) -> usize {
        match self {
            Self::FloatingFrame { modes } => modes as usize,
            Self::Point | Self::RigidFrame | Self::AffineFrame | Self::QuadraticFrame => 0,
        }
    }

    /// Of the block `part` of such an unknown: the components that are amplitudes of no mode, because modes are no multiple
    /// of three. They have no inertia, and are to be held.
    pub fn idle_components(self, part: usize) -> [bool; 3] {
        let modes = self.mode_count();
        let first = |part: usize| 3 * (part - BLOCKS_OF_RIGID);
        let is_idle =
            |component: usize| modes > 0 && part >= BLOCKS_OF_RIGID && first(part) + component >= modes;
        [0, 1, 2].map(is_idle)
    }
}

/// Whether a derived row returns the forces on it to the rows that carry it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Feedback {
    /// `f_parent += weight · f_row`: virtual work and momentum are conserved.
    Transpose,
    /// One-way interpolation (the ghosts of Debunne 2000): not conservative.
    None,
}

/// Consecutive unknowns of one kind.
#[derive(Clone, Debug)]
struct Run {
    kind: UnknownKind,
    first_row: usize,
    first_block: usize,
    count: usize,
}

/// A row that is `Σ weight · parent` over earlier rows.
#[derive(Clone, Debug, PartialEq)]
pub struct DerivedRow {
    pub parents: Vec<(u32, f64)>,
    pub feedback: Feedback,
}

/// How a free row moves with its velocity block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Carrier {
    /// `ẋ = v`: points, origins, affine axes.
    Translation,
    /// `ẋ = ω × x`: axes of rigid frames.
    Rotation,
    /// `ẋ = ω × x + u̇ a`: rows of modes, `x = u a`; the block is that of `ω`.
    Mode {
        /// The free row of `a`.
        axis: u32,
        /// The block and the component of `u`.
        amplitude: u32,
        component: u8,
    },
}

/// How a free row follows velocity blocks, or their displacements: the derivative by each block that moves it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RowMaps {
    pub first: (u32, Mat3),
    /// Of rows of modes: that by the block of the amplitude.
    pub second: Option<(u32, Mat3)>,
}

impl RowMaps {
    pub fn iter(&self) -> impl Iterator<Item = (u32, &Mat3)> {
        let first = (self.first.0, &self.first.1);
        std::iter::once(first).chain(self.second.iter().map(|(block, map)| (*block, map)))
    }

    /// What the row does where blocks are `delta`.
    pub fn apply(&self, delta: &[Vec3]) -> Vec3 {
        self.iter().map(|(block, map)| *map * delta[block as usize]).sum()
    }

    /// Adds what a force on the row is on blocks.
    pub fn add_transposed(&self, force: Vec3, blocks: &mut [Vec3]) {
        for (block, map) in self.iter() {
            blocks[block as usize] += map.transpose_apply(force);
        }
    }
}

/// What a force on a free row adds to the tangent because the row's maps turn with the frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Geometric {
    /// On the diagonal of the angular block.
    pub turn: (u32, Mat3),
    /// Of rows of modes: between the angular block and that of the amplitude, and transposed the other way.
    pub coupling: Option<(u32, Mat3)>,
}

/// The map between unknowns and rows.
#[derive(Clone, Debug, Default)]
pub struct Kinematics {
    runs: Vec<Run>,
    /// Per free row: the velocity block that moves it, and how.
    carriers: Vec<(u32, Carrier)>,
    block_count: usize,
    /// Per free row: itself, with weight 1; made where it is asked for, which no method does that knows points alone.
    identity: OnceLock<Vec<(u32, f64)>>,
    /// Per derived row: its weights over free rows; what positions follow.
    forward: Weights,
    /// Per derived row: the free rows that receive its force, and the weights.
    backward: Weights,
    /// Whether some derived row keeps the force on it.
    is_one_way: bool,
}

/// Weights over free rows, of one derived row after the other.
#[derive(Clone, Debug, Default)]
struct Weights {
    entries: Vec<(u32, f64)>,
    /// Per derived row: where its entries end, and those of the next begin.
    ends: Vec<usize>,
}

impl Weights {
    fn push(&mut self, entries: &[(u32, f64)]) {
        self.entries.extend_from_slice(entries);
        self.ends.push(self.entries.len());
    }

    fn of(&self, derived: usize) -> &[(u32, f64)] {
        let start = derived.checked_sub(1).map_or(0, |before| self.ends[before]);
        &self.entries[start..self.ends[derived]]
    }

    fn len(&self) -> usize {
        self.ends.len()
    }

    fn bytes(&self) -> usize {
        size_of::<(u32, f64)>() * self.entries.capacity() + size_of::<usize>() * self.ends.capacity()
    }
}

/// `Σ weight · row`.
fn weighted(weights: &[(u32, f64)], rows: &[Vec3]) -> Vec3 {
    weights.iter().map(|&(row, weight)| rows[row as usize] * weight).sum()
}

/// A derived row that cannot be.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum KinematicsError {
    #[error(
        "derived row {row} hangs on row {parent}, which does not come before it; order rows so that each follows its parents, without cycles"
    )]
    NotEarlier { row: usize, parent: u32 },
    #[error("derived row {row} has weight {weight} on row {parent}; weights are finite numbers")]
    BadWeight { row: usize, parent: u32, weight: f64 },
    #[error("derived row {row} hangs on nothing; give it at least one parent")]
    Orphan { row: usize },
}

impl Kinematics {
    /// Appends `count` unknowns of a kind; their free rows and velocity blocks follow those before.
    ///
    /// # Panics
    /// After derived rows were added: free rows come first.
    pub fn add_unknowns(&mut self, kind: UnknownKind, count: usize) -> UnknownRange {
        assert!(self.forward.len() == 0, "free rows come before derived rows");
        let (first_row, first_block) = (self.carriers.len(), self.block_count);
        self.carriers.reserve_exact(count * kind.row_count());
        for unknown in 0..count {
            let block = (first_block + unknown * kind.block_count()) as u32;
            match kind {
                UnknownKind::Point => self.carriers.push((block, Carrier::Translation)),
                UnknownKind::RigidFrame => {
                    self.carriers.push((block, Carrier::Translation));
                    self.carriers.extend([(block + 1, Carrier::Rotation); 3]);
                }
                UnknownKind::AffineFrame | UnknownKind::QuadraticFrame => {
                    let rows = 0..kind.row_count() as u32;
                    self.carriers.extend(rows.map(|k| (block + k, Carrier::Translation)));
                }
                UnknownKind::FloatingFrame { modes } => {
                    let axes = self.carriers.len() as u32 + 1;
                    self.carriers.push((block, Carrier::Translation));
                    self.carriers.extend([(block + 1, Carrier::Rotation); 3]);
                    for mode in 0..modes {
                        let (amplitude, component) =
                            (block + BLOCKS_OF_RIGID as u32 + mode / 3, (mode % 3) as u8);
                        let row = |k| (block + 1, Carrier::Mode { axis: axes + k, amplitude, component });
                        self.carriers.extend((0..3).map(row));
                    }
                }
            }
        }
        self.identity = OnceLock::new();
        self.block_count += count * kind.block_count();
        self.runs.push(Run { kind, first_row, first_block, count });
        UnknownRange { rows: first_row..self.carriers.len(), blocks: first_block..self.block_count }
    }

    /// Appends a derived row and returns its index.
    ///
    /// # Errors
    /// A parent does not come before it, a weight is not finite, or there is no parent.
    pub fn add_derived_row(&mut self, derived: DerivedRow) -> Result<u32, KinematicsError> {
        let row = self.row_count();
        if derived.parents.is_empty() {
            return Err(KinematicsError::Orphan { row });
        }
        for &(parent, weight) in &derived.parents {
            if parent as usize >= row {
                return Err(KinematicsError::NotEarlier { row, parent });
            }
            if !weight.is_finite() {
                return Err(KinematicsError::BadWeight { row, parent, weight });
            }
        }
        let forward = compose(&derived.parents, |parent| self.forward(parent));
        let backward = match derived.feedback {
            Feedback::Transpose => compose(&derived.parents, |parent| self.backward(parent)),
            Feedback::None => Vec::new(),
        };
        self.forward.push(&forward);
        self.backward.push(&backward);
        self.is_one_way |= derived.feedback == Feedback::None;
        Ok(row as u32)
    }

    pub fn row_count(&self) -> usize {
        self.carriers.len() + self.forward.len()
    }

    pub fn free_row_count(&self) -> usize {
        self.carriers.len()
    }

    pub fn block_count(&self) -> usize {
        self.block_count
    }

    /// Whether every unknown is a point and every row is an unknown: the maps are the identity.
    pub fn is_trivial(&self) -> bool {
        self.forward.len() == 0 && !self.has_frames()
    }

    pub fn has_frames(&self) -> bool {
        self.runs.iter().any(|run| run.kind != UnknownKind::Point)
    }

    /// Whether every unknown is a frame.
    pub fn has_frames_alone(&self) -> bool {
        self.has_frames() && self.runs.iter().all(|run| run.kind != UnknownKind::Point || run.count == 0)
    }

    /// Whether some frame turns: rigid and floating ones do.
    pub fn has_turning_frames(&self) -> bool {
        self.runs.iter().any(|run| run.kind.turns())
    }

    /// Whether every row returns the forces on it; where one does not, momentum is not conserved.
    pub fn is_conservative(&self) -> bool {
        !self.is_one_way
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        size_of::<(u32, Carrier)>() * self.carriers.capacity()
            + self.identity.get().map_or(0, |identity| size_of::<(u32, f64)>() * identity.capacity())
            + self.forward.bytes()
            + self.backward.bytes()
    }

    /// Unknowns as (kind, blocks), in order.
    pub fn unknowns(&self) -> impl Iterator<Item = (UnknownKind, Range<usize>)> {
        self.runs.iter().flat_map(|run| {
            let size = run.kind.block_count();
            (0..run.count)
                .map(move |i| (run.kind, run.first_block + i * size..run.first_block + (i + 1) * size))
        })
    }

    /// Weights of a row over free rows, as positions follow them.
    pub fn forward(&self, row: usize) -> &[(u32, f64)] {
        self.itself(row).unwrap_or_else(|| self.forward.of(row - self.carriers.len()))
    }

    /// Free rows that receive the force on a row.
    pub fn backward(&self, row: usize) -> &[(u32, f64)] {
        self.itself(row).unwrap_or_else(|| self.backward.of(row - self.carriers.len()))
    }

    /// A free row as weights over free rows; `None` of a derived one.
    fn itself(&self, row: usize) -> Option<&[(u32, f64)]> {
        let free = self.carriers.len();
        let made = || (0..free as u32).map(|row| (row, 1.0)).collect();
        (row < free).then(|| slice::from_ref(&self.identity.get_or_init(made)[row]))
    }

    /// The velocity block that moves a free row; of a row of a mode the angular one.
    pub fn block_of(&self, free_row: u32) -> u32 {
        self.carriers[free_row as usize].0
    }

    /// All velocity blocks that move a free row.
    pub fn blocks_of(&self, free_row: u32) -> impl Iterator<Item = u32> {
        let (block, carrier) = self.carriers[free_row as usize];
        let second = match carrier {
            Carrier::Mode { amplitude, .. } => Some(amplitude),
            Carrier::Translation | Carrier::Rotation => None,
        };
        std::iter::once(block).chain(second)
    }

    /// Whether two blocks move a free row.
    pub fn is_of_mode(&self, free_row: u32) -> bool {
        matches!(self.carriers[free_row as usize].1, Carrier::Mode { .. })
    }

    /// The first free row that a velocity block moves; `None` beyond the last block.
    pub fn row_of_block(&self, block: u32) -> Option<u32> {
        let row = self.carriers.partition_point(|(own, _)| *own < block);
        (self.carriers.get(row)?.0 == block).then_some(row as u32)
    }

    /// The position block of a point unknown, or `None` for rows of frames and derived rows.
    pub fn point_block(&self, row: u32) -> Option<u32> {
        let run = self.runs.iter().find(|run| {
            run.kind == UnknownKind::Point
                && (run.first_row..run.first_row + run.count).contains(&(row as usize))
        })?;
        Some((run.first_block + row as usize - run.first_row) as u32)
    }

    /// The free row that a velocity block translates: a point, an origin, an affine axis; `None` for the
    /// angular block of a frame that turns and for amplitudes.
    pub fn point_block_row(&self, block: u32) -> Option<u32> {
        let block = block as usize;
        let size = |run: &Run| run.kind.block_count();
        let holds = |run: &&Run| (run.first_block..run.first_block + run.count * size(run)).contains(&block);
        let run = self.runs.iter().find(holds)?;
        let (unknown, part) = ((block - run.first_block) / size(run), (block - run.first_block) % size(run));
        let translates = !run.kind.turns() || part == 0;
        translates.then(|| (run.first_row + unknown * run.kind.row_count() + part) as u32)
    }

    /// Positions of all rows from the configuration `q` (free rows), and their velocities `ẋ = T(q) v`.
    pub fn rows_into(&self, q: &[Vec3], v: &[Vec3], positions: &mut [Vec3], velocities: &mut [Vec3]) {
        let (free_positions, positions) = positions.split_at_mut(q.len());
        let (free_velocities, velocities) = velocities.split_at_mut(q.len());
        reduce::copy(free_positions, q);
        self.free_velocities_into(q, v, free_velocities);
        // in one go, for weights take longer to come from memory than rows
        reduce::for_each_rows_pair(
            positions,
            velocities,
            &|first, positions: &mut [Vec3], velocities: &mut [Vec3]| {
                for (at, (position, velocity)) in positions.iter_mut().zip(velocities).enumerate() {
                    let weights = self.forward.of(first + at);
                    *position = weighted(weights, free_positions);
                    *velocity = weighted(weights, free_velocities);
                }
            },
        );
    }

    /// [`Kinematics::rows_into`] of the free rows and of these derived ones alone.
    pub fn some_rows_into(
        &self,
        q: &[Vec3],
        v: &[Vec3],
        which: &[u32],
        positions: &mut [Vec3],
        velocities: &mut [Vec3],
    ) {
        reduce::copy(&mut positions[..q.len()], q);
        self.free_velocities_into(q, v, &mut velocities[..q.len()]);
        self.derive_some_rows(which, positions);
        self.derive_some_rows(which, velocities);
    }

    /// Velocities of all rows, `ẋ = T(q) v`.
    pub fn velocities_into(&self, q: &[Vec3], v: &[Vec3], rows: &mut [Vec3]) {
        self.free_velocities_into(q, v, &mut rows[..q.len()]);
        self.derive_rows(rows);
    }

    /// [`Kinematics::velocities_into`] of the free rows alone.
    pub fn free_velocities_into(&self, q: &[Vec3], v: &[Vec3], rows: &mut [Vec3]) {
        if !self.has_frames() {
            reduce::copy(&mut rows[..v.len()], v);
            return;
        }
        for (row, &(block, carrier)) in self.carriers.iter().enumerate() {
            rows[row] = match carrier {
                Carrier::Translation => v[block as usize],
                Carrier::Rotation => v[block as usize].cross(q[row]),
                Carrier::Mode { axis, amplitude, component } => {
                    let rate = v[amplitude as usize][usize::from(component)];
                    v[block as usize].cross(q[row]) + q[axis as usize] * rate
                }
            };
        }
    }

    /// Fills derived rows from the free rows before them.
    pub fn derive_rows(&self, rows: &mut [Vec3]) {
        let (free, derived) = rows.split_at_mut(self.carriers.len());
        reduce::for_each_rows(derived, &|first, chunk: &mut [Vec3]| {
            for (at, row) in chunk.iter_mut().enumerate() {
                *row = weighted(self.forward.of(first + at), free);
            }
        });
    }

    /// [`Kinematics::derive_rows`] of these alone.
    pub fn derive_some_rows(&self, which: &[u32], rows: &mut [Vec3]) {
        let free = self.carriers.len();
        for row in which {
            rows[*row as usize] = weighted(self.forward.of(*row as usize - free), &rows[..free]);
        }
    }

    /// Generalised forces `Tᵀ f` on velocity blocks; `rows` is consumed as scratch.
    pub fn forces_into(&self, q: &[Vec3], rows: &mut [Vec3], blocks: &mut [Vec3]) {
        self.return_forces(rows);
        blocks.fill(Vec3::ZERO);
        for (row, &(block, carrier)) in self.carriers.iter().enumerate() {
            blocks[block as usize] += match carrier {
                Carrier::Translation => rows[row],
                Carrier::Rotation | Carrier::Mode { .. } => q[row].cross(rows[row]),
            };
            if let Carrier::Mode { axis, amplitude, component } = carrier {
                blocks[amplitude as usize][usize::from(component)] += q[axis as usize].dot(rows[row]);
            }
        }
    }

    /// Gives forces on derived rows back to the free rows that carry them, which add them to their own.
    pub fn return_forces(&self, rows: &mut [Vec3]) {
        let (free, derived) = rows.split_at_mut(self.carriers.len());
        for (index, force) in derived.iter().enumerate() {
            // most derived rows are only looked at
            if *force != Vec3::ZERO {
                for &(row, weight) in self.backward.of(index) {
                    free[row as usize] += *force * weight;
                }
            }
        }
    }

    /// Moves a configuration by a displacement of its velocity blocks: points, affine axes and amplitudes add, rotations
    /// advance by the exponential map from the left.
    pub fn retract(&self, q: &mut [Vec3], displacement: &[Vec3]) {
        self.retract_scaled(q, displacement, 1.0);
    }

    /// [`Kinematics::retract`] by `scale · displacement`.
    pub fn retract_scaled(&self, q: &mut [Vec3], displacement: &[Vec3], scale: f64) {
        if self.is_trivial() {
            reduce::add_scaled(q, scale, displacement);
            return;
        }
        for run in &self.runs {
            for unknown in 0..run.count {
                let row = run.first_row + unknown * run.kind.row_count();
                let block = run.first_block + unknown * run.kind.block_count();
                match run.kind {
                    UnknownKind::Point => q[row] += displacement[block] * scale,
                    UnknownKind::AffineFrame | UnknownKind::QuadraticFrame => {
                        for k in 0..run.kind.row_count() {
                            q[row + k] += displacement[block + k] * scale;
                        }
                    }
                    UnknownKind::RigidFrame | UnknownKind::FloatingFrame { .. } => {
                        q[row] += displacement[block] * scale;
                        let axes = axes_at(q, row);
                        let turned = orthonormalised(&(exponential(displacement[block + 1] * scale) * axes));
                        let amplitudes = &displacement[block + BLOCKS_OF_RIGID..];
                        for mode in 0..run.kind.mode_count() {
                            let u = amplitude_at(q, row, mode) + amplitudes[mode / 3][mode % 3] * scale;
                            let first = row + ROWS_OF_FRAME + 3 * mode;
                            q[first..first + 3].copy_from_slice(&turned.columns.map(|axis| axis * u));
                        }
                        q[row + 1..row + 4].copy_from_slice(&turned.columns);
                    }
                }
            }
        }
    }

    /// The displacement that [`Kinematics::retract`]s `from` to `to`.
    pub fn difference(&self, to: &[Vec3], from: &[Vec3], displacement: &mut [Vec3]) {
        for run in &self.runs {
            for unknown in 0..run.count {
                let row = run.first_row + unknown * run.kind.row_count();
                let size = run.kind.block_count();
                let block = run.first_block + unknown * size;
                match run.kind {
                    UnknownKind::Point => displacement[block] = to[row] - from[row],
                    UnknownKind::AffineFrame | UnknownKind::QuadraticFrame => {
                        for k in 0..size {
                            displacement[block + k] = to[row + k] - from[row + k];
                        }
                    }
                    UnknownKind::RigidFrame | UnknownKind::FloatingFrame { .. } => {
                        displacement[block] = to[row] - from[row];
                        displacement[block + 1] =
                            logarithm(&axes_at(to, row).mul_transpose(&axes_at(from, row)));
                        let blocks = block + BLOCKS_OF_RIGID..block + size;
                        displacement[blocks].fill(Vec3::ZERO);
                        for mode in 0..run.kind.mode_count() {
                            displacement[block + BLOCKS_OF_RIGID + mode / 3][mode % 3] =
                                amplitude_at(to, row, mode) - amplitude_at(from, row, mode);
                        }
                    }
                }
            }
        }
    }

    /// `T` of a free row: the derivatives of its position by the displacements of its blocks.
    pub fn position_maps(&self, free_row: u32, q: &[Vec3]) -> RowMaps {
        let (block, carrier) = self.carriers[free_row as usize];
        match carrier {
            Carrier::Translation => RowMaps { first: (block, Mat3::IDENTITY), second: None },
            // δa = δθ × a
            Carrier::Rotation => {
                RowMaps { first: (block, -q[free_row as usize].cross_matrix()), second: None }
            }
            // δb = δθ × b + δu a
            Carrier::Mode { axis, amplitude, component } => RowMaps {
                first: (block, -q[free_row as usize].cross_matrix()),
                second: Some((amplitude, by_component(q[axis as usize], component))),
            },
        }
    }

    /// `D` of a free row: the derivatives of its velocity `T(q) v(q)` by the displacements of its blocks, where
    /// `v = rate · difference(q, q_start)` as a one-step implicit method has it; on what only translates a constant may be
    /// added to that.
    pub fn velocity_maps(&self, free_row: u32, q: &[Vec3], v: &[Vec3], rate: f64) -> RowMaps {
        let (block, carrier) = self.carriers[free_row as usize];
        // δ(ω × x) = ω × (δθ × x) + rate (J⁻¹ δθ) × x
        let turning = || {
            let omega = v[block as usize];
            let x = q[free_row as usize].cross_matrix();
            let inverse_jacobian = left_jacobian_inverse(omega * (1.0 / rate));
            -(omega.cross_matrix() * x) - (x * inverse_jacobian) * rate
        };
        match carrier {
            Carrier::Translation => RowMaps { first: (block, Mat3::IDENTITY * rate), second: None },
            Carrier::Rotation => RowMaps { first: (block, turning()), second: None },
            // δ(ω × b + u̇ a), with δb = δθ × b + δu a, δa = δθ × a, δu̇ = rate δu
            Carrier::Mode { axis, amplitude, component } => {
                let a = q[axis as usize];
                let u_rate = v[amplitude as usize][usize::from(component)];
                let by_amplitude = v[block as usize].cross(a) + a * rate;
                RowMaps {
                    first: (block, turning() - a.cross_matrix() * u_rate),
                    second: Some((amplitude, by_component(by_amplitude, component))),
                }
            }
        }
    }

    /// What a force `f` on a free row adds to the tangent of generalised forces, `∂(Tᵀ f)`; `None` of rows that only translate.
    pub fn geometric(&self, free_row: u32, q: &[Vec3], force: Vec3) -> Option<Geometric> {
        let (block, carrier) = self.carriers[free_row as usize];
        // δ(x × f) = (δθ × x) × f = f × (x × δθ)
        let turn = || (block, force.cross_matrix() * q[free_row as usize].cross_matrix());
        match carrier {
            Carrier::Translation => None,
            Carrier::Rotation => Some(Geometric { turn: turn(), coupling: None }),
            // δ(b × f) has δu (a × f) besides, and δ(a · f) = δθ · (a × f)
            Carrier::Mode { axis, amplitude, component } => {
                let by_amplitude = by_component(q[axis as usize].cross(force), component);
                Some(Geometric { turn: turn(), coupling: Some((amplitude, by_amplitude)) })
            }
        }
    }

    /// The acceleration that a free row has while velocity blocks stay as they are: `ω × (ω × x)`, and `2 u̇ ω × a` of rows of modes.
    pub fn bias(&self, free_row: u32, q: &[Vec3], v: &[Vec3]) -> Vec3 {
        let (block, carrier) = self.carriers[free_row as usize];
        let omega = v[block as usize];
        let centripetal = || omega.cross(omega.cross(q[free_row as usize]));
        match carrier {
            Carrier::Translation => Vec3::ZERO,
            Carrier::Rotation => centripetal(),
            Carrier::Mode { axis, amplitude, component } => {
                let rate = v[amplitude as usize][usize::from(component)];
                centripetal() + omega.cross(q[axis as usize]) * (2.0 * rate)
            }
        }
    }

    /// Whether a row moves with a translation of the whole: 1 for points and origins, 0 for axes, and what
    /// the weights make of it for derived rows.
    pub fn translation_weight(&self, row: usize) -> f64 {
        if row < self.carriers.len() {
            return if self.is_axis(row as u32) { 0.0 } else { 1.0 };
        }
        self.forward(row).iter().map(|&(free, weight)| if self.is_axis(free) { 0.0 } else { weight }).sum()
    }

    fn is_axis(&self, free_row: u32) -> bool {
        self.runs
            .iter()
            .find(|run| {
                let rows = run.first_row..run.first_row + run.count * run.kind.row_count();
                rows.contains(&(free_row as usize))
            })
            .is_some_and(|run| !(free_row as usize - run.first_row).is_multiple_of(run.kind.row_count()))
    }
}

/// Where unknowns stand.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownRange {
    pub rows: Range<usize>,
    pub blocks: Range<usize>,
}

/// Axes of the frame whose origin is that row.
fn axes_at(q: &[Vec3], origin: usize) -> Mat3 {
    Mat3::from_columns(q[origin + 1], q[origin + 2], q[origin + 3])
}

/// The amplitude of a mode of the frame whose origin is that row: `u = ⅓ Σ aₖ · bₖ`.
fn amplitude_at(q: &[Vec3], origin: usize, mode: usize) -> f64 {
    let first = origin + ROWS_OF_FRAME + 3 * mode;
    (0..3).map(|k| q[origin + 1 + k].dot(q[first + k])).sum::<f64>() / 3.0
}

/// The derivative of `u a` by a block of which `u` is one component.
fn by_component(a: Vec3, component: u8) -> Mat3 {
    a.outer(Vec3::AXES[usize::from(component)])
}

/// Weights over free rows of `Σ weight · parent`, parents expanded, each free row once, in order.
fn compose<'a>(parents: &[(u32, f64)], expansion: impl Fn(usize) -> &'a [(u32, f64)]) -> Vec<(u32, f64)> {
    let mut sum: Vec<(u32, f64)> = Vec::new();
    for &(parent, weight) in parents {
        for &(free, share) in expansion(parent as usize) {
            match sum.binary_search_by_key(&free, |entry| entry.0) {
                Ok(at) => sum[at].1 += weight * share,
                Err(at) => sum.insert(at, (free, weight * share)),
            }
        }
    }
    sum
}

/// `J⁻¹(θ)` with `log(exp(δ) exp(θ)) = θ + J⁻¹(θ) δ + O(δ²)`:
/// `I - [θ]×/2 + (1/θ² - (1 + cos θ)/(2 θ sin θ)) [θ]×²`.
fn left_jacobian_inverse(theta: Vec3) -> Mat3 {
    let angle_sq = theta.length_sq();
    // series below the switch: 1/12 + θ²/720, error θ⁴/30240
    let quadratic = if angle_sq < 1e-4 {
        1.0 / 12.0 + angle_sq / 720.0
    } else {
        let angle = angle_sq.sqrt();
        1.0 / angle_sq - (1.0 + libm::cos(angle)) / (2.0 * angle * libm::sin(angle))
    };
    let skew = theta.cross_matrix();
    Mat3::IDENTITY - skew * 0.5 + (skew * skew) * quadratic
}

#[cfg(test)]
mod tests;
