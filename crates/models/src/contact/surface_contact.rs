//! Two bodies' closed surfaces against each other: points of each against triangles of the other.
//!
//! A pair is a point and what it is nearest to, found at the start of a step and kept while the step is solved, so that
//! the force is smooth meanwhile: the plane of a triangle, or, from outside, an edge or a corner. Points within reach
//! make pairs; what has come farther than that since is searched again ([`Force::pairs_are_stale`]). Its memory
//! is the anchor of friction, in barycentric coordinates of the triangle; a point that goes on to another
//! triangle takes it along.
//!
//! Decided on purpose: a point exactly on the surface takes the plane of its triangle; one that passes an edge
//! from outside without thickness is found inside at the next step; a triangle squeezed to a line has no plane
//! and pushes nobody, its neighbours do.

mod geometry;

use std::any::Any;

use souple_engine::tangent::add_block;
use souple_engine::{
    Configuration, Declaration, Editable, Energy, Force, Pair, ParameterError, Scratch, TangentWeights,
};
use souple_math::{Dual, Mat3, Real, Vec3};
use souple_mesh::{
    ClosestPoint, MeshError, OpeningSurface, SignedDistance, TriangleSurface, closest_point_on_triangle,
};
use souple_solve::BlockMatrix;

use crate::loads::{LoadError, not_negative};

use super::law::Approach;
use super::opening::Shares;
use super::shape_contact::{derivative, dual};
use super::{ContactForce, ContactLaw};
use geometry::{Corners, OVER, REGIONS, Region, approach, barycentric, corner_areas, region_code, turn};

/// The closed surface of a body and where its points stand among rows.
#[derive(Clone, Debug)]
pub struct ContactSurface {
    /// At the start, closed at any time, outward.
    pub surface: OpeningSurface,
    /// Row of each of its points.
    pub rows: Vec<u32>,
    /// Share of the law's stiffness of each of its points at the start: 1, or its area over the mean area.
    pub shares: Vec<f64>,
    /// The same from the dates on at which the surface opens, ascending.
    pub later: Vec<Shares>,
}

impl ContactSurface {
    /// The largest share that each point ever has.
    pub fn largest_shares(&self) -> impl Iterator<Item = f64> {
        self.shares.iter().enumerate().map(|(point, share)| {
            let later = self.later.iter().map(|shares| shares.of_points[point]);
            later.fold(*share, f64::max)
        })
    }
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
    /// Distance up to which a point outside makes a pair [m].
    reach: f64,
}

#[derive(Debug)]
struct Side {
    /// Of all points that are ever on the surface.
    rows: Vec<u32>,
    /// Corners of all triangles that ever are, among those points.
    triangles: Vec<[u32; 3]>,
    /// From the start, then from each date on at which it opens.
    phases: Vec<Phase>,
}

/// A surface from one date to the next.
#[derive(Debug)]
struct Phase {
    /// [s]
    from: f64,
    /// `None` where nothing is left.
    distance: Option<SignedDistance>,
    /// Numbers that its points and its triangles have among all, ascending.
    points: Vec<u32>,
    triangles: Vec<u32>,
    /// Of all points.
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

/// What a pair's numbers mean: the point, the triangle, and where on it.
#[derive(Clone, Copy, Debug)]
struct Place {
    /// Rows of the point and of the triangle's corners.
    rows: [u32; 4],
    region: Region,
    share: f64,
}

impl SurfaceContact {
    /// `reach` is how far points may come towards each other before pairs are searched again [m]: about the length of
    /// an edge.
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
        self.each_touch(at).collect()
    }

    fn each_touch(&self, at: &Configuration) -> impl Iterator<Item = SurfaceTouch> {
        at.pairs.iter().filter_map(|pair| self.touch(pair, at))
    }

    fn touch(&self, pair: &Pair, at: &Configuration) -> Option<SurfaceTouch> {
        let place = self.place(pair, at.time);
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
        approach(place.region, &Corners::at(place.rows, at), anchor(pair), self.law.thickness, |number| {
            number
        })
    }

    /// Which body a pair's point is of, and its number there: those of the second follow those of the first.
    fn point(&self, pair: &Pair) -> (usize, usize) {
        let (point, first) = (pair.a as usize, self.sides[0].rows.len());
        if point < first { (0, point) } else { (1, point - first) }
    }

    fn place(&self, pair: &Pair, time: f64) -> Place {
        let (side, point) = self.point(pair);
        let region = Region::from_code(pair.b % REGIONS);
        Place { rows: self.rows(pair), region, share: self.sides[side].phase(time).shares[point] }
    }

    /// Rows of the point of a pair and of the corners of its triangle.
    fn rows(&self, pair: &Pair) -> [u32; 4] {
        let (side, point) = self.point(pair);
        let other = &self.sides[1 - side];
        let [a, b, c] = other.triangles[(pair.b / REGIONS) as usize].map(|p| other.rows[p as usize]);
        [self.sides[side].rows[point], a, b, c]
    }

    /// How often each surface has opened by a time [s].
    fn opened(&self, time: f64) -> [usize; 2] {
        [0, 1].map(|side| self.sides[side].opened(time))
    }

    /// Forces on the point and the three corners; `None` where the pair does not touch.
    fn forces<R: Real>(
        &self,
        place: &Place,
        corners: &Corners<R>,
        pair: &Pair,
        value: impl Fn(R) -> f64,
    ) -> Option<[Vec3<R>; 4]> {
        let (approach, weights) = approach(place.region, corners, anchor(pair), self.law.thickness, &value)?;
        let force = self.law.force(place.share, &approach, &value)?;
        let total = force.total();
        let [a, b, c] = weights.map(|weight| -(total * weight));
        // a friction that is zero just now has a derivative all the same
        if self.law.friction == 0.0 {
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
        let values = Corners::at(place.rows, at);
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
        let ContactSurface { surface, rows, shares, later } = side;
        let number = |error| SurfaceContactError::Number { side: name, error };
        let expected = surface.surface.points.len();
        let of_phases = [&shares].into_iter().chain(later.iter().map(|shares| &shares.of_points));
        let counts = of_phases.clone().map(|shares| ("shares", shares.len()));
        for (field, found) in [("rows", rows.len())].into_iter().chain(counts) {
            if found != expected {
                return Err(number(LoadError::Count { field, found, expected, of: "the surface's points" }));
            }
        }
        for shares in of_phases {
            for (index, share) in shares.iter().enumerate() {
                not_negative(format!("shares[{index}]"), *share).map_err(number)?;
            }
        }
        let first = Shares { from: f64::NEG_INFINITY, of_points: shares };
        let phases = [first].into_iter().chain(later).map(|shares| Phase::new(&surface, shares));
        let phases: Result<Vec<Phase>, MeshError> = phases.collect();
        let phases =
            phases.map_err(|error| SurfaceContactError::Surface { side: name, error: Box::new(error) })?;
        let is_inside_out =
            phases.iter().filter_map(|phase| phase.distance.as_ref()).any(SignedDistance::was_reoriented);
        let mut triangles = surface.surface.triangles;
        if is_inside_out {
            triangles.iter_mut().for_each(|corners| corners.swap(1, 2));
        }
        Ok(Self { rows, triangles, phases })
    }

    /// How often it has opened by a time [s].
    fn opened(&self, time: f64) -> usize {
        self.phases[1..].iter().take_while(|phase| phase.from <= time).count()
    }

    fn phase(&self, time: f64) -> &Phase {
        &self.phases[self.opened(time)]
    }
}

impl Phase {
    /// # Errors
    /// The surface is open then, or has a triangle without area.
    fn new(whole: &OpeningSurface, Shares { from, of_points: shares }: Shares) -> Result<Self, MeshError> {
        // a body that is cut from the start on is never seen whole
        let time = if from.is_finite() { from } else { f64::max(from, 0.0) };
        let (surface, points) = whole.part(time);
        let triangles = whole.at(time).map(|triangle| triangle as u32).collect();
        // what opens is a boundary of cells, whose parts may touch
        let distance = match whole.opens() {
            true if surface.triangles.is_empty() => None,
            true => Some(SignedDistance::of_boundary(surface)?),
            false => Some(SignedDistance::new(surface)?),
        };
        Ok(Self { from, distance, points, triangles, shares })
    }

    /// Its number of a triangle among all.
    fn triangle(&self, of_all: u64) -> Option<u32> {
        self.triangles.binary_search(&u32::try_from(of_all).ok()?).ok().map(|place| place as u32)
    }

    fn bytes(&self) -> usize {
        self.distance.as_ref().map_or(0, SignedDistance::bytes)
            + 4 * (self.points.capacity() + self.triangles.capacity())
            + size_of::<f64>() * self.shares.capacity()
    }
}

/// Memory of a pair: barycentric anchor, and the stretch left by the last step.
const ANCHOR: usize = 0;
const STRETCH: usize = 3;

fn anchor(pair: &Pair) -> [f64; 3] {
    std::array::from_fn(|i| pair.memory[ANCHOR + i])
}

fn anchored(weights: [f64; 3], stretch: Vec3) -> [f64; 8] {
    [weights[0], weights[1], weights[2], stretch.x, stretch.y, stretch.z, 0.0, 0.0]
}

/// Surfaces as they stand, for the search of pairs.
struct Moved {
    sides: [Option<SignedDistance>; 2],
    /// How often each has opened.
    opened: [usize; 2],
    positions: Vec<Vec3>,
}

impl Moved {
    /// Surfaces that have opened otherwise since are taken anew.
    fn open(&mut self, sides: &[Side; 2], opened: [usize; 2]) {
        for (side, (moved, whole)) in self.sides.iter_mut().zip(sides).enumerate() {
            if self.opened[side] != opened[side] {
                moved.clone_from(&whole.phases[opened[side]].distance);
            }
        }
        self.opened = opened;
    }

    fn place(&mut self, sides: &[Side; 2], positions: &[Vec3]) {
        for (number, (moved, side)) in self.sides.iter_mut().zip(sides).enumerate() {
            let Some(moved) = moved else { continue };
            let points = side.phases[self.opened[number]].points.iter();
            self.positions.clear();
            self.positions.extend(points.map(|point| positions[side.rows[*point as usize] as usize]));
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
        let sides = [0, 1].map(|side| self.sides[side].phases[0].distance.clone());
        Box::new(Moved { sides, opened: [0; 2], positions: Vec::new() })
    }

    fn energy(&self, at: &Configuration, _scratch: &mut Scratch) -> Energy {
        let stored = |pair: &Pair| {
            let place = self.place(pair, at.time);
            self.approach(&place, pair, at)
                .map_or(0.0, |(approach, _)| self.law.stored(place.share, &approach))
        };
        Energy { stored: at.pairs.iter().map(stored).sum(), dissipated: at.memory[0] }
    }

    fn add_force(&self, at: &Configuration, _scratch: &mut Scratch, out: &mut [Vec3]) {
        for pair in at.pairs {
            let place = self.place(pair, at.time);
            let Some(forces) = self.forces(&place, &Corners::at(place.rows, at), pair, |number| number)
            else {
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
            let place = self.place(pair, at.time);
            let changes = self.change(&place, pair, at, place.rows.map(|row| delta[row as usize]), weights);
            for (row, change) in place.rows.iter().zip(changes) {
                out[*row as usize] += change;
            }
        }
    }

    fn visit_cliques(&self, pairs: &[Pair], visit: &mut dyn FnMut(&[u32])) {
        pairs.iter().for_each(|pair| visit(&self.rows(pair)));
    }

    fn add_blocks(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        _: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) {
        for pair in at.pairs {
            let place = self.place(pair, at.time);
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

    fn add_symmetric_blocks(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        _: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) {
        for pair in at.pairs {
            let place = self.place(pair, at.time);
            let Some((approach, [a, b, c])) = self.approach(&place, pair, at) else { continue };
            let Some(stiffness) = self.law.lagged_stiffness(place.share, &approach) else { continue };
            // the point moves against the nearest point of the triangle, whose weights are held too
            let (block, shares) = (stiffness.weighted(weights), [1.0, -a, -b, -c]);
            for (row, share) in place.rows.iter().zip(shares) {
                for (column, other) in place.rows.iter().zip(shares) {
                    add_block(matrix, *row as usize, *column as usize, &(block * (share * other)));
                }
            }
        }
    }

    fn find_pairs(&self, at: &Configuration, scratch: &mut Scratch, found: &mut Vec<Pair>) {
        let Some(moved) = scratch.downcast_mut::<Moved>() else {
            unreachable!("scratch is made by new_scratch")
        };
        moved.open(&self.sides, self.opened(at.time));
        moved.place(&self.sides, at.positions);
        let mut first = 0;
        for (side, other) in [(0, 1), (1, 0)] {
            let (points, touched) = (self.sides[side].phase(at.time), self.sides[other].phase(at.time));
            if let Some(surface) = &moved.sides[other] {
                let bounds = surface.surface().bounds().grown(self.reach + self.law.thickness);
                for point in &points.points {
                    let x = at.positions[self.sides[side].rows[*point as usize] as usize];
                    if bounds.contains(x) {
                        let point = first + *point as usize;
                        found.extend(self.nearest_pair(point, x, (surface, touched), at));
                    }
                }
            }
            first += self.sides[side].rows.len();
        }
    }

    /// A point that was out of reach comes to touch only if it or a corner has moved by half the reach, apart from
    /// what all move together.
    fn pairs_are_stale(&self, searched: &[Vec3], at: &Configuration, scratch: &Scratch) -> bool {
        let now = at.positions;
        let opened = self.opened(at.time);
        let Some(moved) = scratch.downcast_ref::<Moved>() else { return false };
        if moved.opened != opened {
            return true;
        }
        let rows = || {
            let sides = self.sides.iter().zip(opened);
            sides.flat_map(|(side, opened)| {
                side.phases[opened].points.iter().map(|point| side.rows[*point as usize] as usize)
            })
        };
        let count = rows().count() as f64;
        let common = rows().map(|row| now[row] - searched[row]).sum::<Vec3>() * (1.0 / count);
        let limit_sq = 0.25 * self.reach * self.reach;
        // written so that what is not finite is left to the check at the end of the step
        rows().any(|row| (now[row] - searched[row] - common).length_sq() > limit_sq)
    }

    fn recall_search(&self, searched: &Configuration, scratch: &mut Scratch) {
        if let Some(moved) = scratch.downcast_mut::<Moved>() {
            moved.open(&self.sides, self.opened(searched.time));
        }
    }

    /// The point may have been on another triangle, and goes on from there.
    fn bring_up(&self, now: &Configuration, pair: &mut Pair) {
        let Corners { positions: [x, corners @ ..], .. } = Corners::at(self.rows(pair), now);
        pair.memory = match known_pair(pair, now) {
            Some(known) => self.taken_along(known, now, corners),
            None => anchored(barycentric(x, corners), Vec3::ZERO),
        };
    }

    // k g gᵀ with g = (1, -w) over point and corners is at most k |g_i| Σ|g_j| = 2 k |g_i| on the diagonal
    fn touching_stiffness(&self) -> Option<Vec<(u32, f64)>> {
        let mut bounds = self.phase_bounds();
        let Some(mut largest) = bounds.next() else { return Some(Vec::new()) };
        // phases have the same rows in the same order
        for bound in bounds {
            largest.iter_mut().zip(bound).for_each(|(known, (_, value))| known.1 = known.1.max(value));
        }
        Some(largest)
    }

    fn accepts_pair(&self, pair: &Pair) -> bool {
        let [first, second] = &self.sides;
        let points = first.rows.len() as u64;
        let (point, limit, other) = if pair.a < points {
            (pair.a, points, second)
        } else {
            (pair.a - points, second.rows.len() as u64, first)
        };
        let triangles = other.triangles.len() as u64;
        point < limit && pair.b / REGIONS < triangles
    }

    fn advance_memory(&self, at: &Configuration, timestep: f64, memory: &mut [f64], pairs: &mut [Pair]) {
        for (before, pair) in at.pairs.iter().zip(pairs) {
            let place = self.place(before, at.time);
            let remembered =
                Vec3::new(before.memory[STRETCH], before.memory[STRETCH + 1], before.memory[STRETCH + 2]);
            let Some((approach, _)) = self.approach(&place, before, at) else { continue };
            let (stretch, heat) = self.law.advance(place.share, &approach, remembered, timestep);
            memory[0] += heat;
            let [x, triangle @ ..] = Corners::at(place.rows, at).positions;
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
        let side = |side: &Side| {
            side.phases.iter().map(Phase::bytes).sum::<usize>()
                + 4 * side.rows.capacity()
                + size_of::<[u32; 3]>() * side.triangles.capacity()
        };
        self.sides.iter().map(side).sum()
    }

    fn scratch_bytes(&self, scratch: &Scratch) -> usize {
        scratch.downcast_ref::<Moved>().map_or(0, |moved| {
            moved.sides.iter().flatten().map(SignedDistance::bytes).sum::<usize>()
                + size_of::<Vec3>() * moved.positions.capacity()
        })
    }

    fn visit_contacts(&self, at: &Configuration, visit: &mut dyn FnMut(&souple_engine::ContactPoint)) {
        for touch in self.each_touch(at) {
            let [row, a, b, c] = touch.rows;
            let [wa, wb, wc] = touch.weights;
            visit(&souple_engine::ContactPoint {
                row,
                against: &[(a, wa), (b, wb), (c, wc)],
                penetration: touch.penetration,
                normal_force: touch.force.normal,
                friction: touch.force.friction,
            });
        }
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}

impl SurfaceContact {
    /// What a point, counted over both bodies, is nearest to of a surface as it stands; `None` out of reach.
    fn nearest_pair(
        &self,
        point: usize,
        x: Vec3,
        (surface, phase): (&SignedDistance, &Phase),
        at: &Configuration,
    ) -> Option<Pair> {
        let reach = self.reach + self.law.thickness;
        // a point inside touches however deep it has come
        let inside = || surface.closest(x).filter(|closest| closest.distance < 0.0);
        let closest = surface.closest_within(x, reach).or_else(inside)?;
        let mut pair = Pair::new(point, 0, [0.0; 8]);
        let known = known_pair(&pair, at);
        // of triangles that share the nearest place, the one it was on: a pattern that flickers with rounding
        // would be made anew every step
        let (triangle, weights) = known
            .and_then(|known| phase.triangle(known.b / REGIONS))
            .and_then(|triangle| same_place(surface.surface(), triangle, x, &closest))
            .unwrap_or((closest.triangle, closest.weights));
        let corners = surface.surface().corners(triangle);
        let of_all = u64::from(phase.triangles[triangle as usize]);
        pair.b = of_all * REGIONS + region_code(x, corners, weights, closest.distance);
        pair.memory = match known {
            Some(known) => self.taken_along(known, at, corners),
            None => anchored(barycentric(x, corners), Vec3::ZERO),
        };
        Some(pair)
    }

    /// What [`Force::touching_stiffness`] says, of each time at which a surface opens.
    fn phase_bounds(&self) -> impl Iterator<Item = Vec<(u32, f64)>> {
        let starts = self.sides.iter().flat_map(|side| side.phases.iter().map(|phase| phase.from));
        starts.map(|time| {
            let mut bound = Vec::new();
            for (side, other) in [(0, 1), (1, 0)] {
                let (points, corners) = (&self.sides[side], &self.sides[other]);
                let (pressing, pressed) = (points.phase(time), corners.phase(time));
                let stiffest = 2.0 * self.law.stiffest();
                bound.extend(
                    points.rows.iter().zip(&pressing.shares).map(|(row, share)| (*row, stiffest * share)),
                );
                // as many of the other's points as fall to a corner where both surfaces are covered alike
                let area =
                    pressing.distance.as_ref().map_or(f64::INFINITY, |distance| distance.surface().area());
                let share = pressing.shares.iter().sum::<f64>() / area;
                let largest = pressing.shares.iter().copied().fold(0.0, f64::max);
                let mut areas = vec![None; corners.rows.len()];
                if let Some(distance) = &pressed.distance {
                    let of_corners = corner_areas(distance.surface());
                    pressed
                        .points
                        .iter()
                        .zip(of_corners)
                        .for_each(|(point, area)| areas[*point as usize] = Some(area));
                }
                let load = areas
                    .iter()
                    .map(|area| area.map_or(0.0, |area| stiffest * f64::max(share * area, largest)));
                bound.extend(corners.rows.iter().copied().zip(load));
            }
            bound
        })
    }

    /// Memory of a pair that was known: its anchor carried over to the triangle that the point is nearest to now.
    fn taken_along(&self, known: &Pair, at: &Configuration, corners: [Vec3; 3]) -> [f64; 8] {
        let [_, triangle @ ..] = self.rows(known).map(|row| at.positions[row as usize]);
        let anchor = triangle.into_iter().zip(anchor(known)).map(|(corner, weight)| corner * weight).sum();
        let stretch = Vec3::new(known.memory[STRETCH], known.memory[STRETCH + 1], known.memory[STRETCH + 2]);
        anchored(barycentric(anchor, corners), stretch)
    }
}

/// The pair that the point of `pair` had in the step before.
fn known_pair<'a>(pair: &Pair, at: &Configuration<'a>) -> Option<&'a Pair> {
    let start = at.pairs.partition_point(|known| known.a < pair.a);
    at.pairs.get(start).filter(|known| known.a == pair.a)
}

/// A triangle and the weights of its place nearest to `x`, if that is where `closest` is.
fn same_place(
    surface: &TriangleSurface,
    triangle: u32,
    x: Vec3,
    closest: &ClosestPoint,
) -> Option<(u32, [f64; 3])> {
    let corners = surface.corners(triangle);
    let (weights, _) = closest_point_on_triangle(x, corners);
    let position: Vec3 = corners.into_iter().zip(weights).map(|(corner, weight)| corner * weight).sum();
    let size_sq = (corners[1] - corners[0]).length_sq();
    ((position - closest.position).length_sq() <= OVER * OVER * size_sq).then_some((triangle, weights))
}
