//! Two levels: the rigid motions of patches of the body, solved exactly, and a smoother for the rest.
//!
//! What one-level methods are slow at is carrying a load along a body from patch to patch; patches that move
//! rigidly do just that. With `Z` the rigid motions of all patches and `E = Zᵀ A Z`,
//!
//! `M⁻¹ = Z E⁻¹ Zᵀ + Pᵀ S P`,  `P = I − A Z E⁻¹ Zᵀ`,
//!
//! the balancing combination (Mandel 1993; compared in Tang, Nabben, Vuik & Erlangga 2009), symmetric positive
//! definite for any starting vector. `A Z` is formed once per update, so applying `P` costs less than a product
//! with `A`. Directions that a matrix constrains ([`BlockMatrix::constrain`]) are read off the matrix and
//! take no part in the motions; motions that a patch cannot tell apart (its points on a line) are dropped.

use std::sync::Arc;

use souple_math::{Mat3, Vec3};

use super::local::{constrained_directions, range_projector};
use super::{BlockJacobi, BlockRole, Geometry, IncompleteCholesky, Preconditioner};
use crate::kernel::{self, Kernel, RowLoop};
use crate::matrix::check_pattern;
use crate::partition::{ByCoupling, Geometric, aggregates};
use crate::spare::Spare;
use crate::{BlockMatrix, DirectSolver, Pattern, SolveError, reduce};

/// What smooths between coarse corrections.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Smoother {
    /// Cheap, works on many threads.
    BlockJacobi,
    /// Half the iterations, though serial.
    IncompleteCholesky,
}

/// How the two levels are made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RigidModesSettings {
    pub smoother: Smoother,
    /// Blocks per patch at most; `None`: chosen by the size of the system.
    pub patch_size: Option<usize>,
}

impl Default for RigidModesSettings {
    fn default() -> Self {
        Self { smoother: Smoother::IncompleteCholesky, patch_size: None }
    }
}

/// The two-level preconditioner.
pub struct RigidModes {
    pattern: Arc<Pattern>,
    smoother: Box<dyn Preconditioner>,
    roles: Option<Vec<BlockRole>>,
    patch_count: usize,
    /// Patch of each block.
    patch_of: Vec<u32>,
    places: Vec<Vec3>,
    /// Motion of each block with its patch, `u = T t + R ω`.
    motions: Vec<Motion>,
    /// Members of patch `p` are `members[member_starts[p] .. member_starts[p + 1]]`.
    member_starts: Vec<u32>,
    members: Vec<u32>,
    /// Rows of `A Z`: blocks for translation and rotation of each patch near a row.
    row_starts: Vec<u32>,
    row_columns: Vec<u32>,
    row_blocks: Vec<Mat3>,
    /// The same by columns, transposed.
    column_starts: Vec<u32>,
    column_rows: Vec<u32>,
    mirror: Vec<u32>,
    column_blocks: Vec<Mat3>,
    /// Projector onto the motions that a degenerate patch can tell apart.
    degenerate: Vec<(usize, [[f64; 6]; 6])>,
    coarse: BlockMatrix,
    coarse_solver: DirectSolver,
    scratch: Spare<Scratch>,
}

/// How a block follows its patch.
#[derive(Clone, Copy, Debug)]
enum Motion {
    /// `u = t + ω × arm`.
    Free { arm: Vec3 },
    /// `u = T t + R ω`: frames and constrained points.
    General { T: Mat3, R: Mat3 },
}

impl Motion {
    fn matrices(&self) -> (Mat3, Mat3) {
        match *self {
            Self::Free { arm } => (Mat3::IDENTITY, -arm.cross_matrix()),
            Self::General { T, R } => (T, R),
        }
    }
}

#[derive(Default)]
struct Scratch {
    coarse: Vec<Vec3>,
    correction: Vec<Vec3>,
    fine: Vec<Vec3>,
}

impl RigidModes {
    /// Patches by coordinates, or by coupling where every block is a point of unknown place (then rotations
    /// are unknown too and only translations serve).
    ///
    /// # Errors
    /// The coordinates do not fit the matrix, or it is not positive definite.
    pub fn new(
        matrix: &BlockMatrix,
        geometry: Geometry<'_>,
        settings: RigidModesSettings,
    ) -> Result<Self, SolveError> {
        let pattern = Arc::clone(matrix.pattern());
        let count = pattern.block_count();
        geometry.check(count)?;
        let patch_size = settings.patch_size.unwrap_or_else(|| default_patch_size(count)).max(1);
        let (patch_of, patch_count) = match geometry.coordinates {
            Some(coordinates) => aggregates(&mut Geometric { coordinates }, count, patch_size),
            None => aggregates(&mut ByCoupling::new(&pattern), count, patch_size),
        };
        let (member_starts, members) = group(&patch_of, patch_count);

        // rows of A Z: patches of the neighbours
        let (mut row_starts, mut row_columns) = (vec![0], Vec::new());
        let mut near: Vec<u32> = Vec::new();
        for row in 0..count {
            near.clear();
            near.extend(pattern.row(row).iter().map(|&column| patch_of[column as usize]));
            near.sort_unstable();
            near.dedup();
            row_columns.extend(near.iter().flat_map(|&patch| [2 * patch, 2 * patch + 1]));
            row_starts.push(row_columns.len() as u32);
        }
        let (column_starts, column_rows, mirror) = transpose(&row_starts, &row_columns, 2 * patch_count);

        let mut near_patches: Vec<[u32; 4]> = (0..count)
            .flat_map(|row| {
                let own = patch_of[row];
                let others = &row_columns[row_starts[row] as usize..row_starts[row + 1] as usize];
                others.iter().step_by(2).map(move |&other| [2 * own, 2 * own + 1, other, other + 1])
            })
            .filter(|clique| clique[0] <= clique[2])
            .collect();
        near_patches.sort_unstable();
        near_patches.dedup();
        let coarse_pattern =
            Arc::new(Pattern::from_cliques(2 * patch_count, near_patches.iter().map(|clique| &clique[..]))?);

        let places = match geometry.coordinates {
            Some(coordinates) => coordinates.to_vec(),
            None => vec![Vec3::ZERO; count],
        };
        let coarse_places = geometry.coordinates.map(|coordinates| {
            let centres = centroids(&member_starts, &members, coordinates);
            centres.into_iter().flat_map(|centre| [centre, centre]).collect::<Vec<_>>()
        });
        let coarse_solver = DirectSolver::analyse(&coarse_pattern, coarse_places.as_deref())?;
        let smoother: Box<dyn Preconditioner> = match settings.smoother {
            Smoother::BlockJacobi => Box::new(BlockJacobi::new(matrix)?),
            Smoother::IncompleteCholesky => Box::new(match geometry.coordinates {
                Some(coordinates) => IncompleteCholesky::with_coordinates(matrix, coordinates)?,
                None => IncompleteCholesky::new(matrix)?,
            }),
        };
        let scratch = Scratch {
            coarse: vec![Vec3::ZERO; 2 * patch_count],
            correction: vec![Vec3::ZERO; 2 * patch_count],
            fine: vec![Vec3::ZERO; count],
        };
        let mut modes = Self {
            smoother,
            roles: geometry.roles.map(<[BlockRole]>::to_vec),
            patch_count,
            places,
            motions: vec![Motion::Free { arm: Vec3::ZERO }; count],
            member_starts,
            members,
            row_blocks: vec![Mat3::ZERO; row_columns.len()],
            column_blocks: vec![Mat3::ZERO; row_columns.len()],
            row_starts,
            row_columns,
            column_starts,
            column_rows,
            mirror,
            degenerate: Vec::new(),
            coarse: BlockMatrix::zeros(coarse_pattern),
            coarse_solver,
            scratch: Spare::new(scratch),
            patch_of,
            pattern,
        };
        modes.update_coarse(matrix)?;
        Ok(modes)
    }

    /// Patches made.
    pub fn patch_count(&self) -> usize {
        self.patch_count
    }

    fn patch(&self, patch: usize) -> &[u32] {
        &self.members[self.member_starts[patch] as usize..self.member_starts[patch + 1] as usize]
    }

    fn update_coarse(&mut self, matrix: &BlockMatrix) -> Result<(), SolveError> {
        self.place_motions(matrix);
        self.fill_rows(matrix);
        self.fill_coarse()?;
        self.coarse_solver.factorize(&self.coarse)
    }

    /// Motions about each patch's centre, in lengths of its radius so that turns and shifts weigh alike.
    fn place_motions(&mut self, matrix: &BlockMatrix) {
        let centres = centroids(&self.member_starts, &self.members, &self.places);
        for patch in 0..self.patch_count {
            let members = self.member_starts[patch] as usize..self.member_starts[patch + 1] as usize;
            let arm = |block: u32| self.places[block as usize] - centres[patch];
            let largest = self.members[members.clone()].iter().map(|&block| arm(block).length_sq());
            let radius = largest.fold(0.0, f64::max).sqrt();
            let per_radius = if radius > 0.0 { 1.0 / radius } else { 0.0 };
            for &block in &self.members[members] {
                let role = self.roles.as_ref().map_or(BlockRole::Point, |roles| roles[block as usize]);
                let motion = match role {
                    BlockRole::Point => Motion::Free { arm: arm(block) * per_radius },
                    BlockRole::Axis(axis) => {
                        Motion::General { T: Mat3::ZERO, R: -(axis * per_radius).cross_matrix() }
                    }
                    BlockRole::Rotation => Motion::General { T: Mat3::ZERO, R: Mat3::IDENTITY * per_radius },
                };
                self.motions[block as usize] = match constrained_directions(matrix, block as usize) {
                    None => motion,
                    Some(S) => {
                        let (T, R) = motion.matrices();
                        Motion::General { T: S * T, R: S * R }
                    }
                };
            }
        }

        // G = Σ Bᵀ B with B = [T R]: singular where motions coincide
        self.degenerate.clear();
        for patch in 0..self.patch_count {
            let mut gram = [[0.0; 6]; 6];
            for &block in self.patch(patch) {
                let (T, R) = self.motions[block as usize].matrices();
                let ([a, b, c], [d, e, f]) = (T.columns, R.columns);
                let columns = [a, b, c, d, e, f];
                for (i, j) in (0..36).map(|k| (k / 6, k % 6)) {
                    gram[i][j] += columns[i].dot(columns[j]);
                }
            }
            if let Some(projector) = range_projector(&gram) {
                self.degenerate.push((patch, projector));
            }
        }
    }

    /// `A Z`, by rows and by columns.
    fn fill_rows(&mut self, matrix: &BlockMatrix) {
        let Self { pattern, patch_of, motions, row_starts, row_columns, row_blocks, .. } = self;
        row_blocks.fill(Mat3::ZERO);
        for row in 0..pattern.block_count() {
            let first = row_starts[row] as usize;
            let near = &row_columns[first..row_starts[row + 1] as usize];
            for slot in pattern.slots(row) {
                let column = pattern.columns()[slot] as usize;
                let patch = 2 * patch_of[column];
                let place = first + near.iter().position(|&other| other == patch).unwrap_or(0);
                let A = matrix.values()[slot];
                match &motions[column] {
                    Motion::Free { arm } => {
                        row_blocks[place] += A;
                        row_blocks[place + 1] += minus_times_cross(&A, *arm);
                    }
                    Motion::General { T, R } => {
                        row_blocks[place] += A * *T;
                        row_blocks[place + 1] += A * *R;
                    }
                }
            }
        }
        for (block, &entry) in self.column_blocks.iter_mut().zip(&self.mirror) {
            *block = self.row_blocks[entry as usize].transpose();
        }
    }

    /// `E = Zᵀ (A Z)`, with ones for the motions that are dropped.
    fn fill_coarse(&mut self) -> Result<(), SolveError> {
        self.coarse.set_zero();
        for patch in 0..self.patch_count {
            for &row in
                &self.members[self.member_starts[patch] as usize..self.member_starts[patch + 1] as usize]
            {
                let (T, R) = self.motions[row as usize].matrices();
                let entries =
                    self.row_starts[row as usize] as usize..self.row_starts[row as usize + 1] as usize;
                for entry in entries {
                    let column = self.row_columns[entry] as usize;
                    let AZ = &self.row_blocks[entry];
                    self.coarse.add(2 * patch, column, &T.transpose_mul(AZ))?;
                    self.coarse.add(2 * patch + 1, column, &R.transpose_mul(AZ))?;
                }
            }
        }
        if !self.degenerate.is_empty() {
            self.drop_degenerate();
        }
        Ok(())
    }

    /// `E ← Q E Q + s (I − Q)` with the projectors `Q` of degenerate patches.
    fn drop_degenerate(&mut self) {
        let mut projectors: Vec<Option<&[[f64; 6]; 6]>> = vec![None; self.patch_count];
        for (patch, projector) in &self.degenerate {
            projectors[*patch] = Some(projector);
        }
        let scale = self.coarse.mean_diagonal();
        let scale = if scale > 0.0 { scale } else { 1.0 };
        let pattern = Arc::clone(self.coarse.pattern());
        for row in 0..self.patch_count {
            for slot in pattern.slots(2 * row).step_by(2) {
                let column = pattern.columns()[slot] as usize / 2;
                if projectors[row].is_none() && projectors[column].is_none() {
                    continue;
                }
                // columns of a patch are neighbours in both of its rows, which have the same columns
                let below = slot + pattern.slots(2 * row).len();
                let slots = [[slot, slot + 1], [below, below + 1]];
                let values = self.coarse.values_mut();
                let mut block = [[0.0; 6]; 6];
                for (i, j) in (0..36).map(|k| (k / 6, k % 6)) {
                    block[i][j] = values[slots[i / 3][j / 3]].entry(i % 3, j % 3);
                }
                let mut projected = block;
                if let Some(Q) = projectors[row] {
                    projected = multiply(Q, &projected);
                }
                if let Some(Q) = projectors[column] {
                    projected = multiply(&projected, Q);
                }
                if let Some(Q) = projectors[row].filter(|_| row == column) {
                    for (i, j) in (0..36).map(|k| (k / 6, k % 6)) {
                        projected[i][j] += scale * (f64::from(u8::from(i == j)) - Q[i][j]);
                    }
                }
                for (i, j) in (0..36).map(|k| (k / 6, k % 6)) {
                    values[slots[i / 3][j / 3]].columns[j % 3][i % 3] = projected[i][j];
                }
            }
        }
    }

    /// `c ← E⁻¹ Q c`.
    fn solve_coarse(&self, c: &mut [Vec3]) {
        for (patch, Q) in &self.degenerate {
            let (shift, turn) = (c[2 * patch].to_array(), c[2 * patch + 1].to_array());
            let given = [shift[0], shift[1], shift[2], turn[0], turn[1], turn[2]];
            let kept: [f64; 6] = std::array::from_fn(|i| (0..6).map(|j| Q[i][j] * given[j]).sum());
            c[2 * patch] = Vec3::new(kept[0], kept[1], kept[2]);
            c[2 * patch + 1] = Vec3::new(kept[3], kept[4], kept[5]);
        }
        if self.coarse_solver.solve(c).is_err() {
            // a failed update leaves no factor; the smoother alone is a poor preconditioner, but a valid one
            c.fill(Vec3::ZERO);
        }
    }

    /// `c = Zᵀ r`.
    fn restrict(&self, r: &[Vec3], c: &mut [Vec3]) {
        for (patch, c) in c.chunks_exact_mut(2).enumerate() {
            let (mut shift, mut turn) = (Vec3::ZERO, Vec3::ZERO);
            for &block in self.patch(patch) {
                let force = r[block as usize];
                match &self.motions[block as usize] {
                    Motion::Free { arm } => {
                        shift += force;
                        turn += arm.cross(force);
                    }
                    Motion::General { T, R } => {
                        shift += T.transpose() * force;
                        turn += R.transpose() * force;
                    }
                }
            }
            (c[0], c[1]) = (shift, turn);
        }
    }

    /// `z += Z c`.
    fn prolong(&self, c: &[Vec3], z: &mut [Vec3]) {
        reduce::for_each_chunk(z, &|first, z: &mut [Vec3]| {
            for ((z, motion), &patch) in z.iter_mut().zip(&self.motions[first..]).zip(&self.patch_of[first..])
            {
                let (shift, turn) = (c[2 * patch as usize], c[2 * patch as usize + 1]);
                *z += match motion {
                    Motion::Free { arm } => shift + turn.cross(*arm),
                    Motion::General { T, R } => *T * shift + *R * turn,
                };
            }
        });
    }
}

impl Preconditioner for RigidModes {
    fn update(&mut self, matrix: &BlockMatrix) -> Result<(), SolveError> {
        check_pattern(&self.pattern, matrix.pattern())?;
        self.smoother.update(matrix)?;
        self.update_coarse(matrix)
    }

    fn follow(&mut self, coordinates: &[Vec3]) -> Result<(), SolveError> {
        Geometry::points(coordinates).check(self.places.len())?;
        self.places.copy_from_slice(coordinates);
        Ok(())
    }

    fn apply(&self, r: &[Vec3], z: &mut [Vec3]) {
        self.scratch.lend(|scratch| {
            let Scratch { coarse, correction, fine } = scratch;
            let count = 2 * self.patch_count;
            coarse.resize(count, Vec3::ZERO);
            correction.resize(count, Vec3::ZERO);
            fine.resize(self.places.len(), Vec3::ZERO);
            // y = E⁻¹ Zᵀ r
            self.restrict(r, coarse);
            self.solve_coarse(coarse);
            // z = S (r − A Z y)
            reduce::for_each_chunk(fine, &|first, fine: &mut [Vec3]| {
                kernel::run(Subtract {
                    starts: &self.row_starts,
                    columns: &self.row_columns,
                    blocks: &self.row_blocks,
                    first,
                    minuend: Some(r),
                    x: coarse,
                    y: fine,
                });
            });
            self.smoother.apply(fine, z);
            // z += Z (y − E⁻¹ (A Z)ᵀ z)
            kernel::run(Subtract {
                starts: &self.column_starts,
                columns: &self.column_rows,
                blocks: &self.column_blocks,
                first: 0,
                minuend: None,
                x: z,
                y: correction,
            });
            self.solve_coarse(correction);
            reduce::add_scaled(coarse, 1.0, correction);
            self.prolong(coarse, z);
        });
    }

    fn bytes(&self) -> usize {
        let blocks = self.row_blocks.len() + self.column_blocks.len() + self.coarse.values().len();
        let motions = self.motions.len() * (size_of::<Motion>() + 2 * size_of::<Vec3>() + 8);
        self.smoother.bytes()
            + 72 * blocks
            + 12 * self.row_columns.len()
            + motions
            + self.coarse_solver.bytes()
    }
}

/// `y = b − B x` for rows `first ..` of a block matrix given by compressed rows; `b = 0` where there is none.
struct Subtract<'a> {
    starts: &'a [u32],
    columns: &'a [u32],
    blocks: &'a [Mat3],
    first: usize,
    minuend: Option<&'a [Vec3]>,
    x: &'a [Vec3],
    y: &'a mut [Vec3],
}

impl RowLoop for Subtract<'_> {
    type Output = ();

    #[inline(always)]
    fn run<K: Kernel>(self, kernel: K) {
        for (row, y) in (self.first..).zip(self.y) {
            let entries = self.starts[row] as usize..self.starts[row + 1] as usize;
            let product = kernel.row(&self.blocks[entries.clone()], &self.columns[entries], self.x);
            *y = self.minuend.map_or(Vec3::ZERO, |b| b[row]) - product;
        }
    }
}

/// Blocks per patch where nothing else is asked: fewer patches for small systems, where the coarse solve weighs.
fn default_patch_size(block_count: usize) -> usize {
    if block_count < 6000 { 50 } else { 75 }
}

/// `−A [arm]×`: the columns are `−A (arm × e)`.
#[inline(always)]
fn minus_times_cross(A: &Mat3, arm: Vec3) -> Mat3 {
    let [a, b, c] = A.columns;
    // −[arm]× has the columns e × arm: (0, −z, y), (z, 0, −x), (−y, x, 0)
    Mat3::from_columns(c * arm.y - b * arm.z, a * arm.z - c * arm.x, b * arm.x - a * arm.y)
}

fn multiply(a: &[[f64; 6]; 6], b: &[[f64; 6]; 6]) -> [[f64; 6]; 6] {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..6).map(|k| a[i][k] * b[k][j]).sum()))
}

fn centroids(member_starts: &[u32], members: &[u32], places: &[Vec3]) -> Vec<Vec3> {
    let patches = member_starts.windows(2).map(|range| &members[range[0] as usize..range[1] as usize]);
    let centre = |patch: &[u32]| {
        let sum: Vec3 = patch.iter().map(|&block| places[block as usize]).sum();
        if patch.is_empty() { Vec3::ZERO } else { sum / patch.len() as f64 }
    };
    patches.map(centre).collect()
}

/// Members of each part, ascending: starts and members.
fn group(part_of: &[u32], part_count: usize) -> (Vec<u32>, Vec<u32>) {
    let mut starts = vec![0_u32; part_count + 1];
    part_of.iter().for_each(|&part| starts[part as usize + 1] += 1);
    for part in 0..part_count {
        starts[part + 1] += starts[part];
    }
    let mut next = starts.clone();
    let mut members = vec![0; starts[part_count] as usize];
    for (block, &part) in part_of.iter().enumerate() {
        members[next[part as usize] as usize] = block as u32;
        next[part as usize] += 1;
    }
    (starts, members)
}

/// Compressed columns of a structure in compressed rows: starts, rows, and the entry each comes from.
fn transpose(starts: &[u32], columns: &[u32], column_count: usize) -> (Vec<u32>, Vec<u32>, Vec<u32>) {
    let mut column_starts = vec![0_u32; column_count + 1];
    columns.iter().for_each(|&column| column_starts[column as usize + 1] += 1);
    for column in 0..column_count {
        column_starts[column + 1] += column_starts[column];
    }
    let mut next = column_starts.clone();
    let (mut rows, mut mirror) = (vec![0; columns.len()], vec![0; columns.len()]);
    for row in 0..starts.len() - 1 {
        for entry in starts[row]..starts[row + 1] {
            let place = &mut next[columns[entry as usize] as usize];
            rows[*place as usize] = row as u32;
            mirror[*place as usize] = entry;
            *place += 1;
        }
    }
    (column_starts, rows, mirror)
}
