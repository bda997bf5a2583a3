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
//! it is that at rest.
//!
//! Curvature is linear in the angles, and these are all of `x`: forces and stiffness are exact derivatives. Rest angles are those of the
//! rest shape, so that a curved shell keeps its curve.
//!
//! Source: Flores & Oñate 2005 (slopes from patches of four triangles); Grinspun, Gingold, Reusken & Zorin 2006; Tamstorf & Grinspun
//! 2013 (derivatives of the angle).

use std::any::Any;
use std::collections::BTreeMap;

use souple_engine::state::Pair;
use souple_engine::tangent::add_block;
use souple_engine::{Configuration, Declaration, Energy, Force, Scratch, TangentWeights};
use souple_math::{Mat3, Vec3, exponential};
use souple_mesh::{ElementKind, Mesh};
use souple_solve::BlockMatrix;

use crate::materials::Oriented;

/// Own edges and the other edges of three neighbours.
const FOLDS: usize = 9;
/// Corners of a triangle, of its neighbours, and of theirs.
const ROWS: usize = 12;
/// A patch of four triangles tells no curvature where its six points are this near to a conic.
const CONDITION: f64 = 1e6;

/// What a triangle of a shell resists bending with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plate {
    /// Moments per curvature `(κ₁₁, κ₂₂, 2 κ₁₂)`, symmetric and positive definite [N m].
    pub rigidity: Mat3,
    /// Direction of the first axis; the second is across it, counterclockwise seen against the normal. Brought into the plane.
    pub first: Vec3,
    /// Curvature that it has beside that of the rest shape, `(κ₁₁, κ₂₂, 2 κ₁₂)` [1/m].
    pub natural: Vec3,
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
}

/// A surface that resists bending.
pub struct BendingDescription<'a> {
    pub name: String,
    /// Rest shape, of tri3; point `i` is row `first_row + i`.
    pub mesh: &'a Mesh,
    pub first_row: usize,
    /// Of each cell.
    pub plates: &'a [Plate],
    /// Of each point: edges of the border between two such keep the slope that they have at rest, in space.
    pub clamped: &'a [bool],
}

/// An edge at which the surface is folded, from `rows[0]` to `rows[1]`, with the corners opposite to it on both sides: that of the
/// triangle that runs round the edge this way, then the other.
#[derive(Clone, Debug)]
struct Fold {
    rows: [u32; 4],
    /// Where the last corner stands from the first, where that is no point: at a clamped edge [m].
    held: Option<Vec3>,
    /// [rad]
    rest: f64,
}

/// How an angle changes with one of its triangles.
struct Flap {
    /// Slope of the angle by the opposite corner: the normal over the height [1/m].
    apex: Vec3,
    /// Where the foot of the height is along the edge, from 0 to 1.
    foot: f64,
    edge: Vec3,
    side: Vec3,
    /// Twice the area as a vector, and the sign that turns it to the side of the normal.
    area: Vec3,
    sign: f64,
}

impl Flap {
    fn new(edge: Vec3, side: Vec3, sign: f64) -> Self {
        let area = edge.cross(side);
        let apex = area * (sign * edge.length() / area.length_sq());
        Self { apex, foot: edge.dot(side) / edge.length_sq(), edge, side, area, sign }
    }

    /// Adds the slopes by the ends of the edge and the opposite corner, which is number `corner`.
    fn add_gradient(&self, corner: usize, gradient: &mut [Vec3; 4]) {
        gradient[corner] += self.apex;
        gradient[1] -= self.apex * self.foot;
        gradient[0] -= self.apex * (1.0 - self.foot);
    }

    /// Adds how those slopes change with the points.
    fn add_hessian(&self, corner: usize, hessian: &mut [[Mat3; 4]; 4]) {
        let (length, size) = (self.edge.length(), self.area.length_sq());
        // δu = s |e|/|N|² (I - 2 N Nᵀ/|N|²) δN + s N/|N|² (e/|e|)·δe,  δN = e × δp - p × δe
        let turning =
            (Mat3::IDENTITY - self.area.outer(self.area) * (2.0 / size)) * (self.sign * length / size);
        let by_side = turning * self.edge.cross_matrix();
        let lengthening = self.area.outer(self.edge) * (self.sign / (size * length));
        let by_edge = lengthening - turning * self.side.cross_matrix();
        // δa = ((p - 2 a e)·δe + e·δp) / |e|²
        let foot_by_edge = (self.side - self.edge * (2.0 * self.foot)) / self.edge.length_sq();
        let foot_by_side = self.edge / self.edge.length_sq();
        let second_by_edge = -(by_edge * self.foot) - self.apex.outer(foot_by_edge);
        let second_by_side = -(by_side * self.foot) - self.apex.outer(foot_by_side);
        let of_ends = [
            (corner, by_edge, by_side),
            (1, second_by_edge, second_by_side),
            (0, -(by_edge + second_by_edge), -(by_side + second_by_side)),
        ];
        for (row, by_edge, by_side) in of_ends {
            hessian[row][1] += by_edge;
            hessian[row][corner] += by_side;
            hessian[row][0] -= by_edge + by_side;
        }
    }
}

/// Slopes by the corner of a clamped edge that is no point belong to the point that it goes with.
fn carry<T: Copy + std::ops::AddAssign + Default>(entries: &mut [T; 4]) {
    let moved = std::mem::take(&mut entries[3]);
    entries[0] += moved;
}

impl Fold {
    fn corners(&self, positions: &[Vec3]) -> [Vec3; 4] {
        let [a, b, c] = [0, 1, 2].map(|corner| positions[self.rows[corner] as usize]);
        [a, b, c, self.held.map_or_else(|| positions[self.rows[3] as usize], |offset| a + offset)]
    }

    fn flaps(&self, positions: &[Vec3]) -> [Flap; 2] {
        let [a, b, c, d] = self.corners(positions);
        [Flap::new(b - a, c - a, 1.0), Flap::new(b - a, d - a, -1.0)]
    }

    /// The angle, and its slope by each corner.
    fn angle(&self, positions: &[Vec3]) -> Angle {
        let [own, other] = self.flaps(positions);
        let mut gradient = [Vec3::ZERO; 4];
        own.add_gradient(2, &mut gradient);
        other.add_gradient(3, &mut gradient);
        let (normal, beyond) = (own.area, -other.area);
        let sine = beyond.cross(normal).dot(own.edge) / own.edge.length();
        if self.held.is_some() {
            carry(&mut gradient);
        }
        Angle { value: libm::atan2(sine, normal.dot(beyond)) - self.rest, gradient }
    }

    fn hessian(&self, positions: &[Vec3]) -> [[Mat3; 4]; 4] {
        let [own, other] = self.flaps(positions);
        let mut hessian = [[Mat3::ZERO; 4]; 4];
        own.add_hessian(2, &mut hessian);
        other.add_hessian(3, &mut hessian);
        if self.held.is_some() {
            for row in &mut hessian {
                let moved = std::mem::replace(&mut row[3], Mat3::ZERO);
                row[0] += moved;
            }
            let moved = std::mem::replace(&mut hessian[3], [Mat3::ZERO; 4]);
            for (entry, moved) in hessian[0].iter_mut().zip(moved) {
                *entry += moved;
            }
        }
        hessian
    }

    /// How many of its corners are points.
    fn point_count(&self) -> usize {
        if self.held.is_some() { 3 } else { 4 }
    }
}

/// An angle since rest and its slopes.
#[derive(Clone, Copy, Debug)]
struct Angle {
    value: f64,
    gradient: [Vec3; 4],
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
    /// `A D` [N m³].
    stiffness: Mat3,
    /// [1/m]
    natural: Vec3,
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

/// Whether blocks have what the moments add where edges turn.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Part {
    Whole,
    /// Without it there is no negative curvature.
    OfCurvature,
}

/// Bending of a surface of triangles, by angles at its edges (thin shells of docs/theory.md).
pub struct Bending {
    name: String,
    folds: Vec<Fold>,
    bent: Vec<Bent>,
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
    angles: Vec<Angle>,
    /// By each fold [N m].
    moments: Vec<f64>,
    /// Along a direction: of angles, then of moments.
    rates: [Vec<f64>; 2],
}

impl BendingScratch {
    fn of(scratch: &mut Scratch) -> &mut Self {
        scratch.downcast_mut().unwrap_or_else(|| unreachable!("made by this force's own new_scratch"))
    }
}

impl Bending {
    /// # Errors
    /// Cells that are no triangles with area, or do not make an oriented surface with a place to bend at.
    pub fn new(description: &BendingDescription) -> Result<Self, BendingError> {
        let BendingDescription { name, mesh, first_row, plates, clamped } = description;
        let surface = Surface::new(mesh, plates, clamped)?;
        let row = |point: u32| *first_row as u32 + point;
        let folds: Vec<Fold> = surface.folds.iter().map(|fold| surface.fold(fold, row)).collect();
        if folds.is_empty() {
            return Err(BendingError::Nowhere);
        }
        let estimates: Vec<[Option<Turn>; 3]> =
            (0..surface.triangles.len()).map(|triangle| surface.estimates(triangle)).collect();
        let bent = (0..surface.triangles.len()).map(|cell| surface.bent(cell, &estimates, &folds)).collect();
        let is_internal = folds.iter().all(|fold| fold.held.is_none());
        Ok(Self { name: name.clone(), folds, bent, is_internal })
    }

    /// The slopes that clamped edges hold, where points are at `place` by their rows.
    pub fn clamps(&self, place: impl Fn(u32) -> Vec3) -> impl Iterator<Item = HeldSlope> {
        self.folds.iter().filter(|fold| fold.held.is_some()).map(move |fold| {
            let [a, b, c, _] = fold.rows;
            let flap = Flap::new(place(b) - place(a), place(c) - place(a), 1.0);
            let ends = [(c, 1.0), (b, -flap.foot), (a, flap.foot - 1.0)];
            HeldSlope { ends, normal: flap.apex }
        })
    }

    /// Angles, and with what moments the surface resists them.
    fn resist(&self, positions: &[Vec3], scratch: &mut BendingScratch) {
        let BendingScratch { angles, moments, .. } = scratch;
        angles.clear();
        angles.extend(self.folds.iter().map(|fold| fold.angle(positions)));
        moments.clear();
        moments.resize(self.folds.len(), 0.0);
        for bent in &self.bent {
            let moment = bent.stiffness * (bent.curvature(|fold| angles[fold].value) - bent.natural);
            bent.folds().for_each(|(fold, curvature)| moments[fold] += curvature.dot(moment));
        }
    }

    fn add_part(
        &self,
        part: Part,
        at: &Configuration,
        weights: TangentWeights,
        scratch: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) {
        if weights.position == 0.0 {
            return;
        }
        let scratch = BendingScratch::of(scratch);
        self.resist(at.positions, scratch);
        for bent in &self.bent {
            let slopes = bent.slopes(&self.folds, &scratch.angles);
            for (row, slope) in bent.rows().iter().zip(&slopes) {
                let left = slope.transpose_mul(&bent.stiffness) * -weights.position;
                for (column, slope) in bent.rows().iter().zip(&slopes) {
                    add_block(matrix, *row as usize, *column as usize, &(left * *slope));
                }
            }
        }
        if part == Part::OfCurvature {
            return;
        }
        for (fold, moment) in self.folds.iter().zip(&scratch.moments) {
            let hessian = fold.hessian(at.positions);
            for (a, blocks) in hessian.iter().enumerate().take(fold.point_count()) {
                for (b, block) in blocks.iter().enumerate().take(fold.point_count()) {
                    let block = *block * (-weights.position * moment);
                    add_block(matrix, fold.rows[a] as usize, fold.rows[b] as usize, &block);
                }
            }
        }
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

    fn new_scratch(&self) -> Scratch {
        let count = self.folds.len();
        Box::new(BendingScratch {
            angles: Vec::with_capacity(count),
            moments: Vec::with_capacity(count),
            rates: [Vec::with_capacity(count), Vec::with_capacity(count)],
        })
    }

    // E = ½ Σ_T A Δκ · D Δκ
    fn energy(&self, at: &Configuration, scratch: &mut Scratch) -> Energy {
        let scratch = BendingScratch::of(scratch);
        self.resist(at.positions, scratch);
        let of_triangle = |bent: &Bent| {
            let change = bent.curvature(|fold| scratch.angles[fold].value) - bent.natural;
            0.5 * change.dot(bent.stiffness * change)
        };
        Energy { stored: self.bent.iter().map(of_triangle).sum(), dissipated: 0.0 }
    }

    // f = -Σ_e M_e ∂θ_e/∂x
    fn add_force(&self, at: &Configuration, scratch: &mut Scratch, out: &mut [Vec3]) {
        let scratch = BendingScratch::of(scratch);
        self.resist(at.positions, scratch);
        for ((fold, angle), moment) in self.folds.iter().zip(&scratch.angles).zip(&scratch.moments) {
            for corner in 0..fold.point_count() {
                out[fold.rows[corner] as usize] -= angle.gradient[corner] * *moment;
            }
        }
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
        self.resist(at.positions, scratch);
        let BendingScratch { angles, moments, rates: [turning, resisting] } = scratch;
        turning.clear();
        turning.extend(self.folds.iter().zip(angles.iter()).map(|(fold, angle)| {
            let moved = |corner: usize| angle.gradient[corner].dot(delta[fold.rows[corner] as usize]);
            (0..fold.point_count()).map(moved).sum::<f64>()
        }));
        resisting.clear();
        resisting.resize(self.folds.len(), 0.0);
        for bent in &self.bent {
            let moment = bent.stiffness * bent.curvature(|fold| turning[fold]);
            bent.folds().for_each(|(fold, curvature)| resisting[fold] += curvature.dot(moment));
        }
        for (number, fold) in self.folds.iter().enumerate() {
            let hessian = fold.hessian(at.positions);
            for a in 0..fold.point_count() {
                let turned: Vec3 =
                    (0..fold.point_count()).map(|b| hessian[a][b] * delta[fold.rows[b] as usize]).sum();
                let change = angles[number].gradient[a] * resisting[number] + turned * moments[number];
                out[fold.rows[a] as usize] -= change * weights.position;
            }
        }
    }

    fn visit_cliques(&self, _pairs: &[Pair], visit: &mut dyn FnMut(&[u32])) {
        self.bent.iter().for_each(|bent| visit(bent.rows()));
    }

    fn add_blocks(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        scratch: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) {
        self.add_part(Part::Whole, at, weights, scratch, matrix);
    }

    fn add_definite_blocks(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        scratch: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) -> bool {
        self.add_part(Part::OfCurvature, at, weights, scratch, matrix);
        BendingScratch::of(scratch).moments.iter().any(|moment| *moment != 0.0)
    }

    fn bytes(&self) -> usize {
        size_of_val(self.folds.as_slice()) + size_of_val(self.bent.as_slice())
    }

    fn scratch_bytes(&self, scratch: &Scratch) -> usize {
        scratch.downcast_ref().map_or(0, |BendingScratch { angles, moments, rates }| {
            size_of::<Angle>() * angles.capacity()
                + 8 * (moments.capacity() + rates.iter().map(Vec::capacity).sum::<usize>())
        })
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}

/// How far a triangle is turned at the middle of an edge, per angle of some folds.
type Turn = Vec<(u32, f64)>;

/// A side of a triangle at rest.
struct Side {
    length: f64,
    /// Along it and out of the triangle, in the triangle's axes.
    along: [f64; 2],
    out: [f64; 2],
    /// Where the opposite corner is from its middle, along and out [m].
    apex: [f64; 2],
    /// `None`: a free edge.
    fold: Option<u32>,
}

impl Side {
    /// `K_uv` of directions as a row of `(K₁₁, K₂₂, 2 K₁₂)`.
    fn row(u: [f64; 2], v: [f64; 2]) -> Vec3 {
        Vec3::new(u[0] * v[0], u[1] * v[1], 0.5 * (u[0] * v[1] + u[1] * v[0]))
    }

    /// `m ⊗ m` as `(κ₁₁, κ₂₂, 2 κ₁₂)`.
    fn bend(&self) -> Vec3 {
        let [x, y] = self.out;
        Vec3::new(x * x, y * y, 2.0 * x * y)
    }

    /// How much less than at the middle of the edge a triangle with a corner at `apex` slopes outwards, where the surface has
    /// a constant curvature: a row of `(K₁₁, K₂₂, 2 K₁₂)`.
    fn lag(&self, [along, out]: [f64; 2]) -> Vec3 {
        let [tt, tm, mm] = [(self.along, self.along), (self.along, self.out), (self.out, self.out)]
            .map(|(u, v)| Self::row(u, v));
        // the plane through both ends, `K_tt l²/8` high, and the corner
        let rise = tt * (0.5 * along * along - self.length * self.length / 8.0)
            + tm * (along * out)
            + mm * (0.5 * out * out);
        -(rise / out)
    }
}

/// A triangle at rest in its own axes.
struct Triangle {
    area: f64,
    sides: [Side; 3],
    rigidity: Mat3,
    natural: Vec3,
}

/// Which triangles meet at an edge: the one that runs round it from the first point to the second, and the other.
struct Meeting {
    edge: [u32; 2],
    own: (usize, usize),
    /// `None`: it is clamped.
    other: Option<(usize, usize)>,
}

/// The rest shape of a surface as bending sees it.
struct Surface<'a> {
    mesh: &'a Mesh,
    corners: Vec<[u32; 3]>,
    triangles: Vec<Triangle>,
    folds: Vec<Meeting>,
}

impl<'a> Surface<'a> {
    fn new(mesh: &'a Mesh, plates: &[Plate], clamped: &[bool]) -> Result<Self, BendingError> {
        let mut corners = Vec::with_capacity(mesh.cell_count());
        for (number, cell) in mesh.cells().enumerate() {
            match cell.nodes {
                [a, b, c] if cell.kind == ElementKind::Tri3 => corners.push([*a, *b, *c]),
                _ => return Err(BendingError::Kind { cell: number, kind: cell.kind }),
            }
        }
        let folds = meetings(&corners, clamped)?;
        let mut fold_of_side = vec![[None; 3]; corners.len()];
        for (number, fold) in folds.iter().enumerate() {
            for (triangle, side) in [Some(fold.own), fold.other].into_iter().flatten() {
                fold_of_side[triangle][side] = Some(number as u32);
            }
        }
        let mut triangles = Vec::with_capacity(corners.len());
        for (cell, (nodes, plate)) in corners.iter().zip(plates).enumerate() {
            let places = nodes.map(|point| mesh.points[point as usize]);
            let triangle = Triangle::new(places, plate, fold_of_side[cell]);
            triangles.push(triangle.ok_or(BendingError::Flat { cell })?);
        }
        Ok(Self { mesh, corners, triangles, folds })
    }

    /// The other triangle at a fold and its side there.
    fn beyond(&self, fold: u32, triangle: usize) -> Option<(usize, usize)> {
        let Meeting { own, other, .. } = self.folds[fold as usize];
        if own.0 == triangle { other } else { Some(own) }
    }

    fn fold(&self, meeting: &Meeting, row: impl Fn(u32) -> u32) -> Fold {
        let opposite = |(triangle, side): (usize, usize)| self.corners[triangle][(side + 2) % 3];
        let [a, b] = meeting.edge;
        let c = opposite(meeting.own);
        let mut fold = Fold { rows: [a, b, c, c], held: None, rest: 0.0 };
        match meeting.other {
            Some(other) => fold.rows[3] = opposite(other),
            None => {
                // half a turn about the edge lays the triangle out beyond it
                let [a, b, c] = [a, b, c].map(|point| self.mesh.points[point as usize]);
                let axis = (b - a) / (b - a).length();
                fold.held = Some(exponential(axis * std::f64::consts::PI) * (c - a));
            }
        }
        fold.rest = fold.angle(&self.mesh.points).value;
        fold.rows = fold.rows.map(row);
        fold
    }

    /// How far a triangle is turned at its edges where its curvature is constant over its neighbours: exact then. `None` at free
    /// edges, and where its neighbours do not tell a curvature.
    fn estimates(&self, number: usize) -> [Option<Turn>; 3] {
        let triangle = &self.triangles[number];
        let largest = triangle.rigidity.largest_entry();
        // angles by curvature; at a free edge there is no moment across it
        let rows = triangle.sides.each_ref().map(|side| match side.fold {
            Some(fold) => match self.beyond(fold, number) {
                Some(beyond) => side.lag(side.apex) - side.lag(self.apex_beyond(beyond)),
                None => side.lag(side.apex),
            },
            None => (triangle.rigidity * side.bend()) * (side.length / largest),
        });
        let angles = Mat3::from_rows(rows.map(Vec3::to_array));
        let Some(curvature) = angles.try_inverse() else { return [None, None, None] };
        if curvature.largest_entry() * angles.largest_entry() > CONDITION {
            return [None, None, None];
        }
        triangle.sides.each_ref().map(|side| {
            side.fold?;
            let by_side = curvature.transpose_apply(side.lag(side.apex)).to_array();
            let share = |(side, turn): (&Side, f64)| side.fold.map(|fold| (fold, turn));
            Some(triangle.sides.iter().zip(by_side).filter_map(share).collect())
        })
    }

    /// Where the corner beyond an edge is from the edge's middle, laid out flat, along and out as this side sees it.
    fn apex_beyond(&self, (triangle, side): (usize, usize)) -> [f64; 2] {
        self.triangles[triangle].sides[side].apex.map(|coordinate| -coordinate)
    }

    /// How far a triangle is turned at an edge of its own, after both sides have been heard.
    fn turn(&self, number: usize, side: usize, fold: u32, estimates: &[[Option<Turn>; 3]]) -> Turn {
        let Some((other, beyond)) = self.beyond(fold, number) else { return vec![(fold, 1.0)] };
        let own = estimates[number][side].iter().map(|turn| (turn, 1.0));
        // φ_T = θ - φ_N
        let others = estimates[other][beyond].iter().map(|turn| (turn, -1.0));
        let heard: Vec<(&Turn, f64)> = own.chain(others).collect();
        if heard.is_empty() {
            let [own, other] = [number, other].map(|triangle| self.triangles[triangle].area);
            return vec![(fold, own / (own + other))];
        }
        let share = 1.0 / heard.len() as f64;
        let mut turn = Turn::new();
        for (estimate, sign) in heard {
            turn.extend(estimate.iter().map(|(fold, angle)| (*fold, sign * share * angle)));
            if sign < 0.0 {
                turn.push((fold, share));
            }
        }
        turn
    }

    fn bent(&self, number: usize, estimates: &[[Option<Turn>; 3]], folds: &[Fold]) -> Bent {
        let triangle = &self.triangles[number];
        let mut bent = Bent {
            fold_count: 0,
            row_count: 0,
            folds: [0; FOLDS],
            curvature: [Vec3::ZERO; FOLDS],
            corners: [[0; 4]; FOLDS],
            rows: [0; ROWS],
            stiffness: triangle.rigidity * triangle.area,
            natural: triangle.natural,
        };
        for (index, side) in triangle.sides.iter().enumerate() {
            let bend = side.bend() * (side.length / triangle.area);
            let Some(fold) = side.fold else {
                bent.leave_free(side.bend());
                continue;
            };
            for (fold, angle) in self.turn(number, index, fold, estimates) {
                bent.add_fold(fold, bend * angle, &folds[fold as usize]);
            }
        }
        bent
    }
}

impl Bent {
    fn add_fold(&mut self, number: u32, curvature: Vec3, fold: &Fold) {
        let count = usize::from(self.fold_count);
        if let Some(known) = self.folds[..count].iter().position(|known| *known == number) {
            self.curvature[known] += curvature;
            return;
        }
        self.folds[count] = number;
        self.curvature[count] = curvature;
        self.corners[count] = fold.rows.map(|row| self.add_row(row));
        self.fold_count += 1;
    }

    fn add_row(&mut self, row: u32) -> u8 {
        if let Some(known) = self.rows().iter().position(|known| *known == row) {
            return known as u8;
        }
        self.rows[usize::from(self.row_count)] = row;
        self.row_count += 1;
        self.row_count - 1
    }

    /// The slope across a free edge is the one of least energy: `D - D g gᵀ D / (g·D g)`.
    fn leave_free(&mut self, bend: Vec3) {
        let moment = self.stiffness * bend;
        let resistance = bend.dot(moment);
        // nothing is left where the other edges are free too
        if resistance > 1e-12 * self.stiffness.largest_entry() {
            self.stiffness -= moment.outer(moment) * (1.0 / resistance);
        }
    }
}

impl Triangle {
    fn new(places: [Vec3; 3], plate: &Plate, fold_of_side: [Option<u32>; 3]) -> Option<Self> {
        let [first, second] = plane_axes(places, plate.first)?;
        let side = |index: usize| {
            let [a, b, c] = [0, 1, 2].map(|corner| places[(index + corner) % 3]);
            let length = (b - a).length();
            let (along, normal) = ((b - a) / length, first.cross(second));
            let (out, apex) = (along.cross(normal), c - (a + b) * 0.5);
            let flat = |v: Vec3| [v.dot(first), v.dot(second)];
            let (fold, apex) = (fold_of_side[index], [apex.dot(along), apex.dot(out)]);
            Side { length, along: flat(along), out: flat(out), apex, fold }
        };
        let [a, b, c] = places;
        let area = 0.5 * (b - a).cross(c - a).length();
        let Plate { rigidity, natural, .. } = *plate;
        Some(Self { area, sides: [side(0), side(1), side(2)], rigidity, natural })
    }
}

/// Two directions across each other in the plane of a triangle, the first as near to `first` as may be; where that is straight across the
/// plane, along the first edge. `None` of a triangle without area.
pub fn plane_axes([a, b, c]: [Vec3; 3], first: Vec3) -> Option<[Vec3; 2]> {
    let normal = (b - a).cross(c - a).try_normalised()?;
    let in_plane = first - normal * first.dot(normal);
    // a direction this near to the normal is lost in rounding
    let wanted = if in_plane.length() > 1e-6 * first.length() { in_plane } else { b - a };
    let first = wanted.try_normalised()?;
    Some([first, normal.cross(first)])
}

/// Where triangles meet, and where the border is clamped, by ascending points of edges.
fn meetings(corners: &[[u32; 3]], clamped: &[bool]) -> Result<Vec<Meeting>, BendingError> {
    let mut users: BTreeMap<[u32; 2], Vec<(usize, usize)>> = BTreeMap::new();
    for (triangle, nodes) in corners.iter().enumerate() {
        for side in 0..3 {
            let [a, b] = [nodes[side], nodes[(side + 1) % 3]];
            users.entry([a.min(b), a.max(b)]).or_default().push((triangle, side));
        }
    }
    let from = |(triangle, side): (usize, usize)| corners[triangle][side];
    let mut found = Vec::new();
    for ([low, high], users) in users {
        let edge = |user: (usize, usize)| if from(user) == low { [low, high] } else { [high, low] };
        let is_clamped = [low, high].iter().all(|point| clamped.get(*point as usize) == Some(&true));
        match users[..] {
            [own] if is_clamped => found.push(Meeting { edge: edge(own), own, other: None }),
            [_] => {}
            [own, other] if from(own) == from(other) => {
                return Err(BendingError::Turned { edge: [low, high] });
            }
            [own, other] => found.push(Meeting { edge: edge(own), own, other: Some(other) }),
            _ => return Err(BendingError::Branches { edge: [low, high] }),
        }
    }
    Ok(found)
}
