//! Bending of surfaces: what makes a membrane of triangles a thin shell.
//!
//! The energy is quadratic in the change of curvature, `E = ½ ∫ Δκ · D Δκ dA` with `κ = (B₁₁, B₂₂, 2 B₁₂)`,
//! `B_ij = n · ∂²r/∂a_i∂a_j`, and flexural rigidities `D` along axes of the material. What stretches the surface is left to its
//! membrane force.
//!
//! Where triangles meet, the surface is folded by an angle `θ` (positive towards the normals). Each triangle, with its three
//! neighbours laid out flat around it, sees the one constant curvature that folds its edges by the angles found there, and with that how
//! far it is turned at the middle of an edge. Both sides of an edge are heard in equal parts, so that the slope there is one,
//! `φ_T + φ_N = θ`, and the curvature of a triangle is
//!
//! `κ_T = 1/A Σ_e l_e φ_e m_e ⊗ m_e`, `m_e` the direction out of the triangle across the edge.
//!
//! This is exact where the curvature is constant, and forces of a constant moment balance, on any mesh: displacements converge as the
//! square of the size of triangles. Sharing `θ` by halves or areas has the second property alone, and ends at another answer on meshes
//! whose edges are no symmetric pattern. At a free edge the slope is the one without a moment across; at a clamped one
//! it is that at rest, to a plane that what leads the edge may turn.
//!
//! Curvature is linear in the angles, and these are all of `x`: forces and stiffness are exact derivatives. Rest angles are those of the
//! rest shape, so that a curved shell keeps its curve, and those that natural curvatures fold it by: where these are one, all is at rest
//! with it, up to free edges. An angle is told up to whole turns; memory keeps on which it is, one number for each fold.
//!
//! What damps bending has moments in proportion to the rate of the curvature, in [`BendingDamping`].
//!
//! Source: Flores & Oñate 2005 (slopes from patches of four triangles); Grinspun, Gingold, Reusken & Zorin 2006; Tamstorf & Grinspun
//! 2013 (derivatives of the angle).

mod damping;
mod fold;
mod surface;

use std::any::Any;
use std::sync::Arc;

use souple_engine::state::Pair;
use souple_engine::tangent::add_block;
use souple_engine::{Configuration, Declaration, Energy, Force, Motion, Scratch, TangentWeights};
use souple_math::{Mat3, Vec3};
use souple_mesh::ElementKind;
use souple_solve::BlockMatrix;

use super::SolidDescription;
use crate::materials::Oriented;
use fold::{Angle, Flap, Fold, Turned};
use surface::{Surface, Turn, ascending};

pub use damping::BendingDamping;
pub use surface::{BorderEdge, border_edges, lies_across, plane_axes};

/// Own edges and the other edges of three neighbours.
const FOLDS: usize = 9;
/// Corners of a triangle, of its neighbours, and of theirs.
const ROWS: usize = 12;

/// What a triangle of a shell resists bending with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plate {
    /// Moments per curvature `(κ₁₁, κ₂₂, 2 κ₁₂)`, symmetric and positive definite [N m].
    pub rigidity: Mat3,
    /// Direction of the first axis; the second is across it, counterclockwise seen against the normal. Brought into the plane.
    pub first: Vec3,
    /// Curvature that it has beside that of the rest shape, `(κ₁₁, κ₂₂, 2 κ₁₂)` [1/m].
    pub natural: Vec3,
    /// Moments per rate of the curvature, symmetric and not negative [N m s].
    pub viscosity: Mat3,
}

/// The rigidities of a plate of two axes [N m].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rigidities {
    /// `D₁₁`: bending along the first axis.
    pub along: f64,
    /// `D₂₂`: bending along the second.
    pub across: f64,
    /// `D₁₂`: moment along one axis of bending along the other.
    pub coupling: f64,
    /// `D₆₆`: moment of twist per `2 κ₁₂`.
    pub twist: f64,
}

impl Rigidities {
    /// Whether every curvature costs energy.
    pub fn are_definite(&self) -> bool {
        self.along > 0.0 && self.twist > 0.0 && self.along * self.across > self.coupling * self.coupling
    }

    /// Whether they are the same along any axes.
    pub fn are_isotropic(&self) -> bool {
        let Self { along, across, coupling, twist } = *self;
        let rounding = 1e-12 * along;
        (along - across).abs() <= rounding && (twist - 0.5 * (along - coupling)).abs() <= rounding
    }

    /// `h³/12` times what resists rates of strain in plane stress, `2 η Ė` of the viscosity `η` [Pa s]: `along` and `across` are moments
    /// per rate of the curvature [N m s].
    pub fn of_viscosity(viscosity: f64, thickness: f64) -> Self {
        let of_rate = 2.0 * viscosity * thickness.powi(3) / 12.0;
        Self { along: of_rate, across: of_rate, coupling: 0.0, twist: 0.5 * of_rate }
    }

    pub fn matrix(&self) -> Mat3 {
        let Self { along, across, coupling, twist } = *self;
        Mat3::from_rows([[along, coupling, 0.0], [coupling, across, 0.0], [0.0, 0.0, twist]])
    }
}

/// `h³/12` times the stiffness in plane stress of a law at rest, in the plane of two directions across each other:
/// `E h³ / 12 (1 - ν²)` along of an isotropic law. `None` of a law without stiffness across the plane.
pub fn rigidity_of_law(law: &Oriented, [first, second]: [Vec3; 2], thickness: f64) -> Option<Mat3> {
    let normal = first.cross(second);
    let symmetric = |a: Vec3, b: Vec3| a.outer(b).symmetric_part();
    let in_plane = [symmetric(first, first), symmetric(second, second), symmetric(first, second)];
    let across = [symmetric(normal, normal), symmetric(first, normal), symmetric(second, normal)];
    let stress = |strains: &[Mat3; 3]| {
        strains.each_ref().map(|strain| law.stress_differential(&Mat3::IDENTITY, strain))
    };
    let (by_plane, by_across) = (stress(&in_plane), stress(&across));
    let table = |rows: &[Mat3; 3], columns: &[Mat3; 3]| {
        Mat3::from_rows(std::array::from_fn(|i| std::array::from_fn(|j| rows[i].dot(&columns[j]))))
    };
    // no stress across: C_pp - C_pn C_nn⁻¹ C_np
    let condensed = table(&across, &by_across).try_inverse()?;
    let coupling = table(&in_plane, &by_across);
    let plane = table(&in_plane, &by_plane) - (coupling * condensed).mul_transpose(&coupling);
    Some(plane * (thickness.powi(3) / 12.0))
}

/// Why a surface cannot resist bending.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BendingError {
    #[error("cell {cell} is a {kind}; bending is told by how triangles meet: cells must be tri3")]
    Kind { cell: usize, kind: ElementKind },
    #[error("cell {cell} has no area at rest; every triangle must have some")]
    Flat { cell: usize },
    #[error("the edge of points {edge:?} is of more than two cells; a surface has at most two at an edge")]
    Branches { edge: [u32; 2] },
    #[error(
        "the cells on both sides of the edge of points {edge:?} run round it the same way; normals must point to one side"
    )]
    Turned { edge: [u32; 2] },
    #[error("no two cells share an edge and none is clamped; a surface must have a place to bend at")]
    Nowhere,
    #[error("the edge of points {edge:?} is not on the border of the surface; only such can be clamped")]
    Inside { edge: [u32; 2] },
}

/// An edge of the border that keeps the slope that it has at rest: to a plane across it that stays as it is in space, or is turned.
#[derive(Clone, Debug)]
pub struct Clamp {
    pub edge: [u32; 2],
    /// What turns that plane, by [`Motion::turn`], as it leads the ends of the edge.
    pub leader: Option<Arc<dyn Motion>>,
}

/// How a surface of triangles resists bending.
#[derive(Clone, Copy)]
pub struct BendingDescription<'a> {
    /// Of each cell.
    pub plates: &'a [Plate],
    pub clamps: &'a [Clamp],
}

/// A triangle that is bent as its folds say.
#[derive(Clone, Debug)]
struct Bent {
    fold_count: u8,
    row_count: u8,
    folds: [u32; FOLDS],
    /// Curvature per angle of each fold, `(κ₁₁, κ₂₂, 2 κ₁₂)` [1/m].
    curvature: [Vec3; FOLDS],
    /// Which of `rows` the corners of each fold are.
    corners: [[u8; 4]; FOLDS],
    rows: [u32; ROWS],
}

impl Bent {
    /// `Σ curvature · angle` of what `angle` gives for a fold.
    fn curvature(&self, angle: impl Fn(usize) -> f64) -> Vec3 {
        self.folds().map(|(fold, curvature)| curvature * angle(fold)).sum()
    }

    fn folds(&self) -> impl Iterator<Item = (usize, Vec3)> {
        let count = usize::from(self.fold_count);
        self.folds[..count].iter().zip(&self.curvature).map(|(fold, curvature)| (*fold as usize, *curvature))
    }

    fn rows(&self) -> &[u32] {
        &self.rows[..usize::from(self.row_count)]
    }

    /// How the curvature changes with each of its rows.
    fn slopes(&self, folds: &[Fold], angles: &[Angle]) -> [Mat3; ROWS] {
        let mut slopes = [Mat3::ZERO; ROWS];
        for ((fold, curvature), corners) in self.folds().zip(&self.corners) {
            for corner in 0..folds[fold].point_count() {
                slopes[usize::from(corners[corner])] += curvature.outer(angles[fold].gradient[corner]);
            }
        }
        slopes
    }
}

/// The folds of a surface and what they tell of its curvature, with what resists that: shared by what resists it and what damps it.
struct Shell {
    folds: Vec<Fold>,
    bent: Vec<Bent>,
    /// Of each triangle, `A D` [N m³].
    stiffness: Vec<Mat3>,
    /// Of each triangle [N m³ s]; none where nothing is damped.
    viscosity: Vec<Mat3>,
    /// What turns clamps, each once.
    leaders: Vec<Arc<dyn Motion>>,
}

impl Shell {
    fn new(solid: &SolidDescription, description: &BendingDescription) -> Result<Self, BendingError> {
        let BendingDescription { plates, clamps } = *description;
        let mut leaders: Vec<Arc<dyn Motion>> = Vec::new();
        let of_clamps: Vec<([u32; 2], Option<u32>)> =
            clamps.iter().map(|clamp| (ascending(clamp), number_of(clamp, &mut leaders))).collect();
        let surface = Surface::new(solid.mesh, plates, of_clamps.into_iter())?;
        let folds = surface.folds(|point| solid.first_row as u32 + point);
        if folds.is_empty() {
            return Err(BendingError::Nowhere);
        }
        let triangles = 0..surface.triangles.len();
        let estimates: Vec<[Option<Turn>; 3]> =
            triangles.clone().map(|triangle| surface.estimates(triangle)).collect();
        let bent = triangles.map(|cell| surface.bent(cell, &estimates, &folds)).collect();
        let resistances = || surface.triangles.iter().map(surface::Triangle::resistance);
        let is_damped = plates.iter().any(|plate| plate.viscosity != Mat3::ZERO);
        let viscosity = resistances().filter(|_| is_damped).map(|[_, viscosity]| viscosity).collect();
        let stiffness = resistances().map(|[stiffness, _]| stiffness).collect();
        Ok(Self { folds, bent, stiffness, viscosity, leaders })
    }

    fn turned(&self, leader: u32, at: &Configuration) -> Turned {
        Turned::of(self.leaders[leader as usize].as_ref(), at.time, at.load)
    }

    /// Brings the scratch to the angles at a configuration, from -π to π.
    fn fold(&self, at: &Configuration, scratch: &mut BendingScratch) {
        let BendingScratch { leaders, angles, .. } = scratch;
        leaders.clear();
        leaders.extend((0..self.leaders.len() as u32).map(|number| self.turned(number, at)));
        angles.clear();
        let led = |number: u32| leaders[number as usize];
        angles.extend(self.folds.iter().map(|fold| fold.angle(at.positions, led)));
    }

    /// Each triangle with a matrix of its own: of its stiffness or viscosity.
    fn with<'a>(&'a self, matrices: &'a [Mat3]) -> impl Iterator<Item = (&'a Bent, &'a Mat3)> {
        self.bent.iter().zip(matrices)
    }

    /// Moments by each fold of what triangles resist, `C κ` of the curvature that `angles` fold them by.
    fn moments_into(&self, matrices: &[Mat3], angles: &[f64], moments: &mut Vec<f64>) {
        moments.clear();
        moments.resize(self.folds.len(), 0.0);
        for (bent, matrix) in self.with(matrices) {
            let moment = *matrix * bent.curvature(|fold| angles[fold]);
            bent.folds().for_each(|(fold, curvature)| moments[fold] += curvature.dot(moment));
        }
    }

    /// `Σ κ·C κ` of the curvature that `angles` fold triangles by.
    fn product(&self, matrices: &[Mat3], angles: &[f64]) -> f64 {
        let of_triangle = |(bent, matrix): (&Bent, &Mat3)| {
            let curvature = bent.curvature(|fold| angles[fold]);
            curvature.dot(*matrix * curvature)
        };
        self.with(matrices).map(of_triangle).sum()
    }

    /// `Σ κ̇·C κ̇` of what is damped [W].
    fn power(&self, at: &Configuration) -> f64 {
        let rate = |fold: usize| self.folds[fold].rate(at, |number| self.turned(number, at));
        let of_triangle = |(bent, matrix): (&Bent, &Mat3)| {
            let curvature = bent.curvature(rate);
            curvature.dot(*matrix * curvature)
        };
        self.with(&self.viscosity).map(of_triangle).sum()
    }

    /// `out -= M_e ∂θ_e/∂x`.
    fn push(&self, angles: &[Angle], moments: &[f64], out: &mut [Vec3]) {
        for ((fold, angle), moment) in self.folds.iter().zip(angles).zip(moments) {
            for corner in 0..fold.point_count() {
                out[fold.rows[corner] as usize] -= angle.gradient[corner] * *moment;
            }
        }
    }

    /// How fast each angle changes where rows move by `delta`.
    fn turning_into(&self, angles: &[Angle], delta: &[Vec3], turning: &mut Vec<f64>) {
        turning.clear();
        turning.extend(self.folds.iter().zip(angles).map(|(fold, angle)| {
            let moved = |corner: usize| angle.gradient[corner].dot(delta[fold.rows[corner] as usize]);
            (0..fold.point_count()).map(moved).sum::<f64>()
        }));
    }

    /// Adds `weight (∂κ/∂x)ᵀ C ∂κ/∂x` of each triangle to the blocks.
    fn add_curvature_blocks(
        &self,
        matrices: &[Mat3],
        angles: &[Angle],
        weight: f64,
        matrix: &mut BlockMatrix,
    ) {
        for (bent, of_curvature) in self.with(matrices) {
            let slopes = bent.slopes(&self.folds, angles);
            for (row, slope) in bent.rows().iter().zip(&slopes) {
                let left = slope.transpose_mul(of_curvature) * weight;
                for (column, slope) in bent.rows().iter().zip(&slopes) {
                    add_block(matrix, *row as usize, *column as usize, &(left * *slope));
                }
            }
        }
    }

    /// Adds `weight Σ M_e ∂²θ_e/∂x²` to the blocks.
    fn add_turning_blocks(
        &self,
        scratch: &BendingScratch,
        positions: &[Vec3],
        weight: f64,
        matrix: &mut BlockMatrix,
    ) {
        for (fold, moment) in self.folds.iter().zip(&scratch.moments) {
            let hessian = fold.hessian(positions, |number| scratch.leaders[number as usize]);
            for (a, blocks) in hessian.iter().enumerate().take(fold.point_count()) {
                for (b, block) in blocks.iter().enumerate().take(fold.point_count()) {
                    let block = *block * (weight * moment);
                    add_block(matrix, fold.rows[a] as usize, fold.rows[b] as usize, &block);
                }
            }
        }
    }

    fn new_scratch(&self) -> Scratch {
        let count = self.folds.len();
        let numbers = || Vec::with_capacity(count);
        Box::new(BendingScratch {
            leaders: Vec::with_capacity(self.leaders.len()),
            angles: Vec::with_capacity(count),
            turned: numbers(),
            moments: numbers(),
            turning: numbers(),
            resisting: numbers(),
        })
    }

    fn bytes(&self) -> usize {
        size_of_val(self.folds.as_slice())
            + size_of_val(self.bent.as_slice())
            + size_of::<Mat3>() * (self.stiffness.len() + self.viscosity.len())
    }
}

/// The number of what turns a clamp among the leaders, to which it is added where it is a new one.
fn number_of(clamp: &Clamp, leaders: &mut Vec<Arc<dyn Motion>>) -> Option<u32> {
    let leader = clamp.leader.as_ref()?;
    let known = leaders.iter().position(|known| Arc::ptr_eq(known, leader));
    Some(known.unwrap_or_else(|| {
        leaders.push(Arc::clone(leader));
        leaders.len() - 1
    }) as u32)
}

/// Bending of a surface of triangles, by angles at its edges (thin shells of docs/theory.md).
pub struct Bending {
    name: String,
    shell: Arc<Shell>,
    is_internal: bool,
}

/// A slope that is held: `Σ weight · x` does not move along the normal.
pub struct HeldSlope {
    /// Rows and their weights: the corner opposite to the edge, against where its height meets the edge.
    pub ends: [(u32, f64); 3],
    pub normal: Vec3,
}

/// Angles and moments, kept between calls.
struct BendingScratch {
    leaders: Vec<Turned>,
    angles: Vec<Angle>,
    /// What folds are turned by, or how fast [rad], [rad/s].
    turned: Vec<f64>,
    /// By each fold [N m].
    moments: Vec<f64>,
    /// Along a direction: of angles, then of moments.
    turning: Vec<f64>,
    resisting: Vec<f64>,
}

impl BendingScratch {
    fn of(scratch: &mut Scratch) -> &mut Self {
        scratch.downcast_mut().unwrap_or_else(|| unreachable!("made by a shell's own new_scratch"))
    }

    fn bytes(&self) -> usize {
        let Self { leaders, angles, turned, moments, turning, resisting } = self;
        let numbers = [turned, moments, turning, resisting].map(Vec::capacity);
        size_of::<Turned>() * leaders.capacity()
            + size_of::<Angle>() * angles.capacity()
            + 8 * numbers.into_iter().sum::<usize>()
    }
}

impl Bending {
    /// Of the mesh of a membrane, under the name that is told there.
    ///
    /// # Errors
    /// Cells that are no triangles with area, or do not make an oriented surface with a place to bend at; clamps that are not on its border.
    pub fn new(solid: &SolidDescription, description: &BendingDescription) -> Result<Self, BendingError> {
        let shell = Shell::new(solid, description)?;
        let is_internal = description.clamps.is_empty();
        Ok(Self { name: solid.name.clone(), shell: Arc::new(shell), is_internal })
    }

    /// What damps it, under a name of its own; `None` where no plate is damped.
    pub fn damping(&self, name: String) -> Option<BendingDamping> {
        let is_damped = !self.shell.viscosity.is_empty();
        is_damped.then(|| BendingDamping::new(name, Arc::clone(&self.shell), self.is_internal))
    }

    /// The slopes that clamped edges hold, where points are at `place` by their rows.
    pub fn clamps(&self, place: impl Fn(u32) -> Vec3) -> impl Iterator<Item = HeldSlope> {
        self.shell.folds.iter().filter(|fold| fold.held.is_some()).map(move |fold| {
            let [a, b, c, _] = fold.rows;
            let flap = Flap::new(place(b) - place(a), place(c) - place(a), 1.0);
            let ends = [(c, 1.0), (b, -flap.foot), (a, flap.foot - 1.0)];
            HeldSlope { ends, normal: flap.apex }
        })
    }

    /// Angles, and with what moments the surface resists them.
    fn resist(&self, at: &Configuration, scratch: &mut BendingScratch) {
        let Shell { folds, stiffness, .. } = &*self.shell;
        self.shell.fold(at, scratch);
        let BendingScratch { angles, turned, moments, .. } = scratch;
        turned.clear();
        turned.extend(
            folds
                .iter()
                .zip(angles.iter())
                .zip(at.memory)
                .map(|((fold, angle), before)| Fold::continued(angle.value, *before) - fold.rest),
        );
        self.shell.moments_into(stiffness, turned, moments);
    }
}

impl Force for Bending {
    fn name(&self) -> &str {
        &self.name
    }

    fn acts_within(&self) -> bool {
        true
    }

    // what a clamp turns is held by no other matter
    fn declaration(&self) -> Declaration {
        Declaration { internal: self.is_internal, ..Declaration::ELASTIC }
    }

    /// The angle of each fold, which goes on beyond half a turn [rad].
    fn memory_len(&self) -> usize {
        self.shell.folds.len()
    }

    // whole turns alone are told by it
    fn tangent_reads_memory(&self) -> bool {
        false
    }

    fn initial_memory(&self, memory: &mut [f64]) {
        memory.iter_mut().zip(&self.shell.folds).for_each(|(angle, fold)| *angle = fold.flat);
    }

    fn new_scratch(&self) -> Scratch {
        self.shell.new_scratch()
    }

    // E = ½ Σ_T A Δκ · D Δκ
    fn energy(&self, at: &Configuration, scratch: &mut Scratch) -> Energy {
        let scratch = BendingScratch::of(scratch);
        self.resist(at, scratch);
        let stored = 0.5 * self.shell.product(&self.shell.stiffness, &scratch.turned);
        Energy { stored, dissipated: 0.0 }
    }

    // f = -Σ_e M_e ∂θ_e/∂x
    fn add_force(&self, at: &Configuration, scratch: &mut Scratch, out: &mut [Vec3]) {
        let scratch = BendingScratch::of(scratch);
        self.resist(at, scratch);
        self.shell.push(&scratch.angles, &scratch.moments, out);
    }

    fn add_differential(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        delta: &[Vec3],
        scratch: &mut Scratch,
        out: &mut [Vec3],
    ) {
        if weights.position == 0.0 {
            return;
        }
        let scratch = BendingScratch::of(scratch);
        self.resist(at, scratch);
        let BendingScratch { leaders, angles, moments, turning, resisting, .. } = scratch;
        self.shell.turning_into(angles, delta, turning);
        self.shell.moments_into(&self.shell.stiffness, turning, resisting);
        for (number, fold) in self.shell.folds.iter().enumerate() {
            let hessian = fold.hessian(at.positions, |number| leaders[number as usize]);
            for a in 0..fold.point_count() {
                let turned: Vec3 =
                    (0..fold.point_count()).map(|b| hessian[a][b] * delta[fold.rows[b] as usize]).sum();
                let change = angles[number].gradient[a] * resisting[number] + turned * moments[number];
                out[fold.rows[a] as usize] -= change * weights.position;
            }
        }
    }

    fn visit_cliques(&self, _pairs: &[Pair], visit: &mut dyn FnMut(&[u32])) {
        self.shell.bent.iter().for_each(|bent| visit(bent.rows()));
    }

    fn add_blocks(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        scratch: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) {
        if weights.position != 0.0 {
            self.add_definite_blocks(at, weights, scratch, matrix);
            let scratch = BendingScratch::of(scratch);
            self.shell.add_turning_blocks(scratch, at.positions, -weights.position, matrix);
        }
    }

    // where moments turn with edges there may be negative curvature, and is no other
    fn add_definite_blocks(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        scratch: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) -> bool {
        let scratch = BendingScratch::of(scratch);
        self.resist(at, scratch);
        let (stiffness, angles) = (&self.shell.stiffness, &scratch.angles);
        self.shell.add_curvature_blocks(stiffness, angles, -weights.position, matrix);
        scratch.moments.iter().any(|moment| *moment != 0.0)
    }

    fn advance_memory(&self, at: &Configuration, _timestep: f64, memory: &mut [f64], _pairs: &mut [Pair]) {
        let led = |number: u32| self.shell.turned(number, at);
        for (fold, angle) in self.shell.folds.iter().zip(memory) {
            *angle = Fold::continued(fold.angle(at.positions, led).value, *angle);
        }
    }

    fn advances_in_place(&self) -> bool {
        true
    }

    fn bytes(&self) -> usize {
        self.shell.bytes()
    }

    fn scratch_bytes(&self, scratch: &Scratch) -> usize {
        scratch.downcast_ref().map_or(0, BendingScratch::bytes)
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}
