//! Two bodies' closed surfaces against each other: points of each against triangles of the other.
//!
//! A pair is a point and what it is nearest to, found at the start of a step and kept through it, so that the
//! force is smooth within the step: the plane of a triangle, or, from outside, an edge or a corner. Its memory
//! is the anchor of friction, in barycentric coordinates of the triangle; a point that goes on to another
//! triangle takes it along.
//!
//! Decided on purpose: a point exactly on the surface takes the plane of its triangle; one that passes an edge
//! from outside without thickness is found inside at the next step; a triangle squeezed to a line has no plane
//! and pushes nobody, its neighbours do.

use std::any::Any;

use souple_engine::tangent::add_block;
use souple_engine::{
    Configuration, Declaration, Editable, Energy, Force, Pair, ParameterError, Scratch, TangentWeights,
};
use souple_math::{Dual, Mat3, Real, Vec3};
use souple_mesh::{MeshError, SignedDistance, TriangleSurface};
use souple_solve::BlockMatrix;

use crate::loads::{LoadError, not_negative};

use super::law::Approach;
use super::shape_contact::{derivative, dual};
use super::{ContactForce, ContactLaw};

/// The closed surface of a body and where its points stand among rows.
#[derive(Clone, Debug)]
pub struct ContactSurface {
    /// At the start, closed, outward.
    pub surface: TriangleSurface,
    /// Row of each of its points.
    pub rows: Vec<u32>,
    /// Share of the law's stiffness of each of its points: 1, or its area over the mean area.
    pub shares: Vec<f64>,
}

/// A contact of surfaces that cannot be.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SurfaceContactError {
    #[error("surface {side} of the contact: {error}")]
    Surface { side: char, error: Box<MeshError> },
    #[error("surface {side} of the contact: {error}")]
    Number { side: char, error: LoadError },
    #[error(transparent)]
    Law(#[from] LoadError),
    #[error("both surfaces of the contact move row {row}; a body does not touch itself here")]
    SharedRow { row: u32 },
}

/// Points of each of two bodies against the triangles of the other, see [`ContactLaw`].
#[derive(Debug)]
pub struct SurfaceContact {
    name: String,
    /// Surfaces with their rows and shares.
    sides: [Side; 2],
    law: ContactLaw,
    /// Distance up to which a point makes a pair, outside and inside [m].
    reach: f64,
}

#[derive(Debug)]
struct Side {
    distance: SignedDistance,
    rows: Vec<u32>,
    shares: Vec<f64>,
}

/// One point that touches a triangle of the other body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceTouch {
    /// Row of the point, rows of the triangle.
    pub rows: [u32; 4],
    /// Weights of the triangle's corners at the nearest point.
    pub weights: [f64; 3],
    /// How deep the point is, thickness included [m].
    pub penetration: f64,
    /// Unit, out of the triangle.
    pub normal: Vec3,
    /// Forces on the point [N]; the triangle bears their opposite.
    pub force: ContactForce,
}

/// What of a triangle a point is nearest to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Region {
    Face,
    /// From this corner to the next.
    Edge(usize),
    Corner(usize),
}

/// Kinds of region in the number of a pair: face, edges, corners.
const REGIONS: u64 = 7;

/// What a pair's numbers mean: the point, the triangle, and where on it.
#[derive(Clone, Copy, Debug)]
struct Place {
    /// Rows of the point and of the triangle's corners.
    rows: [u32; 4],
    region: Region,
    share: f64,
}

impl SurfaceContact {
    /// `reach` is how far a point may come in one step [m]: about the length of an edge.
    ///
    /// # Errors
    /// A surface is not closed, has not as many rows and shares as points, shares a row with the other; a
    /// number is negative or not finite.
    pub fn new(
        name: impl Into<String>,
        a: ContactSurface,
        b: ContactSurface,
        law: ContactLaw,
        reach: f64,
    ) -> Result<Self, SurfaceContactError> {
        law.check()?;
        not_negative("reach", reach)?;
        let mut others = b.rows.clone();
        others.sort_unstable();
        if let Some(&row) = a.rows.iter().find(|row| others.binary_search(row).is_ok()) {
            return Err(SurfaceContactError::SharedRow { row });
        }
        let sides = [Side::new(a, 'a')?, Side::new(b, 'b')?];
        Ok(Self { name: name.into(), sides, law, reach })
    }

    pub fn law(&self) -> &ContactLaw {
        &self.law
    }

    /// Points that touch, with the forces on them.
    pub fn touches(&self, at: &Configuration) -> Vec<SurfaceTouch> {
        at.pairs.iter().filter_map(|pair| self.touch(pair, at)).collect()
    }

    fn touch(&self, pair: &Pair, at: &Configuration) -> Option<SurfaceTouch> {
        let place = self.place(pair);
        let (approach, weights) = self.approach(&place, pair, at)?;
        let force = self.law.force(place.share, &approach, |number| number)?;
        let (rows, penetration, normal) = (place.rows, -approach.gap, approach.normal);
        Some(SurfaceTouch { rows, weights, penetration, normal, force })
    }

    /// Normal force and friction on the first body [N]; the second bears their opposite.
    pub fn total(&self, at: &Configuration) -> (Vec3, Vec3) {
        let (mut normal, mut friction) = (Vec3::ZERO, Vec3::ZERO);
        for pair in at.pairs {
            let Some(touch) = self.touch(pair, at) else { continue };
            let sign = if self.point(pair).0 == 0 { 1.0 } else { -1.0 };
            normal += touch.force.normal * sign;
            friction += touch.force.friction * sign;
        }
        (normal, friction)
    }

    fn approach(&self, place: &Place, pair: &Pair, at: &Configuration) -> Option<(Approach<f64>, [f64; 3])> {
        approach(place, &Corners::at(place, at), pair, self.law.thickness, |number| number)
    }

    /// Which body a pair's point is of, and its number there: those of the second follow those of the first.
    fn point(&self, pair: &Pair) -> (usize, usize) {
        let (point, first) = (pair.a as usize, self.sides[0].rows.len());
        if point < first { (0, point) } else { (1, point - first) }
    }

    fn place(&self, pair: &Pair) -> Place {
        let (side, point) = self.point(pair);
        let (points, other) = (&self.sides[side], &self.sides[1 - side]);
        let [a, b, c] =
            other.distance.surface().triangles[(pair.b / REGIONS) as usize].map(|p| other.rows[p as usize]);
        let region = match (pair.b % REGIONS) as usize {
            0 => Region::Face,
            edge @ 1..=3 => Region::Edge(edge - 1),
            corner => Region::Corner(corner - 4),
        };
        Place { rows: [points.rows[point], a, b, c], region, share: points.shares[point] }
    }

    /// Forces on the point and the three corners; `None` where the pair does not touch.
    fn forces<R: Real>(
        &self,
        place: &Place,
        corners: &Corners<R>,
        pair: &Pair,
        value: impl Fn(R) -> f64,
    ) -> Option<[Vec3<R>; 4]> {
        let (approach, weights) = approach(place, corners, pair, self.law.thickness, &value)?;
        let force = self.law.force(place.share, &approach, &value)?;
        let total = force.total();
        let [a, b, c] = weights.map(|weight| -(total * weight));
        if force.friction.to_array().into_iter().all(|number| value(number) == 0.0) {
            return Some([total, a, b, c]);
        }
        // the couple (x - c) × T that friction at the point and at the triangle would leave
        let [x, p, q, r] = corners.positions;
        let nearest = p * weights[0] + q * weights[1] + r * weights[2];
        let turned = turn([p, q, r], -(x - nearest).cross(force.friction), value);
        Some([total, a + turned[0], b + turned[1], c + turned[2]])
    }

    fn change(
        &self,
        place: &Place,
        pair: &Pair,
        at: &Configuration,
        deltas: [Vec3; 4],
        weights: TangentWeights,
    ) -> [Vec3; 4] {
        let values = Corners::at(place, at);
        let corners = Corners {
            positions: std::array::from_fn(|i| dual(values.positions[i], deltas[i] * weights.position)),
            velocities: std::array::from_fn(|i| dual(values.velocities[i], deltas[i] * weights.velocity)),
        };
        let forces = self.forces(place, &corners, pair, |number: Dual| number.value);
        forces.map_or([Vec3::ZERO; 4], |forces| forces.map(derivative))
    }
}

impl Side {
    fn new(side: ContactSurface, name: char) -> Result<Self, SurfaceContactError> {
        let expected = side.surface.points.len();
        for (field, found) in [("rows", side.rows.len()), ("shares", side.shares.len())] {
            if found != expected {
                let error = LoadError::Count { field, found, expected, of: "the surface's points" };
                return Err(SurfaceContactError::Number { side: name, error });
            }
        }
        for (index, share) in side.shares.iter().enumerate() {
            not_negative(format!("shares[{index}]"), *share)
                .map_err(|error| SurfaceContactError::Number { side: name, error })?;
        }
        let distance = SignedDistance::new(side.surface)
            .map_err(|error| SurfaceContactError::Surface { side: name, error: Box::new(error) })?;
        Ok(Self { distance, rows: side.rows, shares: side.shares })
    }
}

/// Positions and velocities of a point and the corners of a triangle.
struct Corners<R> {
    positions: [Vec3<R>; 4],
    velocities: [Vec3<R>; 4],
}

impl Corners<f64> {
    fn at(place: &Place, at: &Configuration) -> Self {
        Self {
            positions: place.rows.map(|row| at.positions[row as usize]),
            velocities: place.rows.map(|row| at.velocities[row as usize]),
        }
    }
}

/// How the point stands to the triangle, and the weights of the corners at the nearest point; `None` where
/// there is no direction: a triangle squeezed to a line, a point on the edge or corner itself.
///
/// In the plane of a triangle the weights may leave `[0, 1]` during a step: the plane goes on.
fn approach<R: Real>(
    place: &Place,
    corners: &Corners<R>,
    pair: &Pair,
    thickness: f64,
    value: impl Fn(R) -> f64,
) -> Option<(Approach<R>, [R; 3])> {
    let [x, a, b, c] = corners.positions;
    let ends = [a, b, c];
    let (zero, one) = (x.x.zero(), x.x.one());
    let (offset, weights) = match place.region {
        Region::Face => {
            // areas of the triangles of the projection of x with two corners each
            let across = (b - a).cross(c - a);
            let double_area_sq = across.length_sq();
            let area = |q: Vec3<R>, r: Vec3<R>| (q - x).cross(r - x).dot(across) / double_area_sq;
            (across, [area(b, c), area(c, a), area(a, b)])
        }
        Region::Edge(edge) => {
            let (from, to) = (edge, (edge + 1) % 3);
            let along = ends[to] - ends[from];
            let t = (x - ends[from]).dot(along) / along.length_sq();
            let mut weights = [zero; 3];
            (weights[from], weights[to]) = (one - t, t);
            (x - (ends[from] + along * t), weights)
        }
        Region::Corner(corner) => {
            let mut weights = [zero; 3];
            weights[corner] = one;
            (x - ends[corner], weights)
        }
    };
    let length = offset.length();
    if !value(length).is_normal() || !weights.into_iter().all(|weight| value(weight).is_finite()) {
        return None;
    }
    let normal = offset * (one / length);
    let distance = if place.region == Region::Face { normal.dot(x - a) } else { length };
    let anchor = ends[0] * one.splat(pair.memory[ANCHOR])
        + ends[1] * one.splat(pair.memory[ANCHOR + 1])
        + ends[2] * one.splat(pair.memory[ANCHOR + 2]);
    let [v, va, vb, vc] = corners.velocities;
    let velocity = v - (va * weights[0] + vb * weights[1] + vc * weights[2]);
    Some((Approach { gap: distance - thickness, normal, from_anchor: x - anchor, velocity }, weights))
}

/// Forces on three corners of no sum and moment `M`: those of a rigid turn, `h_i = (I⁻¹ M) × r_i` with
/// `I = Σ |r|² - r rᵀ` about the middle. None for a triangle squeezed to a line.
fn turn<R: Real>(corners: [Vec3<R>; 3], moment: Vec3<R>, value: impl Fn(R) -> f64) -> [Vec3<R>; 3] {
    let middle = (corners[0] + corners[1] + corners[2]) * moment.x.splat(1.0 / 3.0);
    let arms = corners.map(|corner| corner - middle);
    let mut inertia = arms[0].outer(arms[0]).scaled(-moment.x.one()).plus_diagonal(arms[0].length_sq());
    for arm in &arms[1..] {
        inertia += arm.outer(*arm).scaled(-moment.x.one()).plus_diagonal(arm.length_sq());
    }
    let (determinant, size) = (inertia.determinant(), inertia.trace());
    if value(determinant) <= 1e-18 * value(size).powi(3) {
        return [moment * moment.x.zero(); 3];
    }
    let rotation = (inertia.cofactor().transpose() * moment) * (moment.x.one() / determinant);
    arms.map(|arm| rotation.cross(arm))
}

/// Memory of a pair: barycentric anchor, and the stretch left by the last step.
const ANCHOR: usize = 0;
const STRETCH: usize = 3;

/// Barycentric coordinates of the projection of `x` on a triangle's plane, of its nearest point where it has none.
fn barycentric(x: Vec3, corners: [Vec3; 3]) -> [f64; 3] {
    let [a, b, c] = corners;
    let across = (b - a).cross(c - a);
    let area = |q: Vec3, r: Vec3| (q - x).cross(r - x).dot(across) / across.length_sq();
    let weights = [area(b, c), area(c, a), area(a, b)];
    if weights.iter().all(|weight| weight.is_finite()) {
        return weights;
    }
    souple_mesh::closest_point_on_triangle(x, corners).0
}

fn anchored(weights: [f64; 3], stretch: Vec3) -> [f64; 8] {
    [weights[0], weights[1], weights[2], stretch.x, stretch.y, stretch.z, 0.0, 0.0]
}

/// Surfaces as they stand, for the search of pairs.
struct Moved {
    sides: [SignedDistance; 2],
    positions: Vec<Vec3>,
}

impl Moved {
    fn place(&mut self, sides: &[Side; 2], positions: &[Vec3]) {
        for (moved, side) in self.sides.iter_mut().zip(sides) {
            self.positions.clear();
            self.positions.extend(side.rows.iter().map(|row| positions[*row as usize]));
            moved.move_points(&self.positions);
        }
    }
}

impl Force for SurfaceContact {
    fn name(&self) -> &str {
        &self.name
    }

    fn declaration(&self) -> Declaration {
        let conservative = self.law.is_conservative();
        Declaration {
            conservative,
            velocity_terms: self.law.damping > 0.0,
            symmetric_tangent: conservative,
            internal: true,
            changing_pattern: true,
        }
    }

    fn memory_len(&self) -> usize {
        1
    }

    fn new_scratch(&self) -> Scratch {
        let sides = [self.sides[0].distance.clone(), self.sides[1].distance.clone()];
        Box::new(Moved { sides, positions: Vec::new() })
    }

    fn energy(&self, at: &Configuration, _scratch: &mut Scratch) -> Energy {
        let stored = |pair: &Pair| {
            let place = self.place(pair);
            self.approach(&place, pair, at)
                .map_or(0.0, |(approach, _)| self.law.stored(place.share, &approach))
        };
        Energy { stored: at.pairs.iter().map(stored).sum(), dissipated: at.memory[0] }
    }

    fn add_force(&self, at: &Configuration, _scratch: &mut Scratch, out: &mut [Vec3]) {
        for pair in at.pairs {
            let place = self.place(pair);
            let Some(forces) = self.forces(&place, &Corners::at(&place, at), pair, |number| number) else {
                continue;
            };
            for (row, force) in place.rows.iter().zip(forces) {
                out[*row as usize] += force;
            }
        }
    }

    fn add_differential(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        delta: &[Vec3],
        _scratch: &mut Scratch,
        out: &mut [Vec3],
    ) {
        for pair in at.pairs {
            let place = self.place(pair);
            let changes = self.change(&place, pair, at, place.rows.map(|row| delta[row as usize]), weights);
            for (row, change) in place.rows.iter().zip(changes) {
                out[*row as usize] += change;
            }
        }
    }

    fn visit_cliques(&self, pairs: &[Pair], visit: &mut dyn FnMut(&[u32])) {
        pairs.iter().for_each(|pair| visit(&self.place(pair).rows));
    }

    fn add_blocks(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        _: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) {
        for pair in at.pairs {
            let place = self.place(pair);
            for (b, column_row) in place.rows.iter().enumerate() {
                let columns = Vec3::AXES.map(|unit| {
                    let mut deltas = [Vec3::ZERO; 4];
                    deltas[b] = unit;
                    self.change(&place, pair, at, deltas, weights)
                });
                for (a, row) in place.rows.iter().enumerate() {
                    let block = Mat3::from_columns(columns[0][a], columns[1][a], columns[2][a]);
                    add_block(matrix, *row as usize, *column_row as usize, &block);
                }
            }
        }
    }

    fn find_pairs(&self, at: &Configuration, scratch: &mut Scratch, found: &mut Vec<Pair>) {
        let Some(moved) = scratch.downcast_mut::<Moved>() else {
            unreachable!("scratch is made by new_scratch")
        };
        moved.place(&self.sides, at.positions);
        let mut first = 0;
        for (side, other) in [(0, 1), (1, 0)] {
            let surface = &moved.sides[other];
            let bounds = surface.surface().bounds().grown(self.reach + self.law.thickness);
            for (point, row) in self.sides[side].rows.iter().enumerate() {
                let x = at.positions[*row as usize];
                if !bounds.contains(x) {
                    continue;
                }
                let Some(closest) = surface.closest_within(x, self.reach + self.law.thickness) else {
                    continue;
                };
                let corners = surface.surface().corners(closest.triangle);
                let region = region_code(x, corners, closest.weights, closest.distance);
                let mut pair = Pair::new(first + point, 0, [0.0; 8]);
                pair.b = u64::from(closest.triangle) * REGIONS + region;
                pair.memory = self.taken_along(&pair, at, x, corners);
                found.push(pair);
            }
            first += self.sides[side].rows.len();
        }
    }

    fn advance_memory(&self, at: &Configuration, timestep: f64, memory: &mut [f64], pairs: &mut [Pair]) {
        for (before, pair) in at.pairs.iter().zip(pairs) {
            let place = self.place(before);
            let remembered =
                Vec3::new(before.memory[STRETCH], before.memory[STRETCH + 1], before.memory[STRETCH + 2]);
            let Some((approach, _)) = self.approach(&place, before, at) else { continue };
            let (stretch, heat) = self.law.advance(place.share, &approach, remembered, timestep);
            memory[0] += heat;
            let [x, triangle @ ..] = Corners::at(&place, at).positions;
            pair.memory = anchored(barycentric(x - stretch, triangle), stretch);
        }
    }

    fn editable(&self) -> Vec<Editable> {
        self.law.editable()
    }

    fn set_parameter(&mut self, name: &str, value: f64) -> Result<(), ParameterError> {
        self.law.set_parameter(&self.name, name, value)
    }

    fn bytes(&self) -> usize {
        self.sides
            .iter()
            .map(|side| 12 * side.rows.len() + 72 * side.distance.surface().triangles.len())
            .sum()
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}

impl SurfaceContact {
    /// Memory of a pair found at `x`: the anchor of the pair that the point had before, carried over to the
    /// triangle it is nearest to now, or the point itself.
    fn taken_along(&self, pair: &Pair, at: &Configuration, x: Vec3, corners: [Vec3; 3]) -> [f64; 8] {
        let start = at.pairs.partition_point(|old| old.a < pair.a);
        let Some(old) = at.pairs.get(start).filter(|old| old.a == pair.a) else {
            return anchored(barycentric(x, corners), Vec3::ZERO);
        };
        let [_, triangle @ ..] = self.place(old).rows.map(|row| at.positions[row as usize]);
        let anchor = (0..3).map(|corner| triangle[corner] * old.memory[ANCHOR + corner]).sum();
        let stretch = Vec3::new(old.memory[STRETCH], old.memory[STRETCH + 1], old.memory[STRETCH + 2]);
        anchored(barycentric(anchor, corners), stretch)
    }
}

/// A point this close to the prism over a triangle, in parts of its size, is over the triangle itself: points
/// over the edges of a flat part are on its plane, not on an edge.
const OVER: f64 = 1e-6;

/// Where the nearest point lies, as part of a pair's number: from outside, weights of zero are corners it is
/// away from; from inside, and on the surface itself, the plane serves.
fn region_code(x: Vec3, corners: [Vec3; 3], weights: [f64; 3], distance: f64) -> u64 {
    if distance <= 0.0 || barycentric(x, corners).iter().all(|weight| *weight >= -OVER) {
        return 0;
    }
    match weights.map(|weight| weight == 0.0) {
        [false, false, false] => 0,
        [false, false, true] => 1,
        [true, false, false] => 2,
        [false, true, false] => 3,
        [false, true, true] => 4,
        [true, false, true] => 5,
        _ => 6,
    }
}
