//! Tools against the surface of a body: rounded parts against triangles, found by a tree of boxes, also when they are fast.
//!
//! A pair is a triangle and a part of the tool. It is found while the tool is still outside: all triangles near what the
//! tool sweeps in a step make pairs, and each remembers on which side of the tool it is. So a tool that would be through the
//! body a moment later finds the triangles that it went through still in front of it, and is pushed back, however far it
//! came, until it has slid off at the side by more than its radius and the reach. Triangles that face away from the tool are
//! behind the body's own matter, and touch nothing.
//!
//! A triangle is pushed where it is nearest to the part's core (a point or a segment), in proportion to its area: triangles
//! finer or coarser make the same pressure, and a tool thinner than a triangle does not slip between its corners.
//! The corners hand the force on to whatever points are at work.
//!
//! Where the surface opens, as that of a body which is cut does, triangles make pairs from when they are on it until they are gone. A
//! date at which it does so makes what was searched before stale.

use std::any::Any;

use souple_engine::tangent::add_block;
use souple_engine::{
    Configuration, ContactPoint, Declaration, Editable, Energy, Force, InHand, Obstacle, Pair,
    ParameterError, Scratch, TangentWeights,
};
use souple_math::{Mat3, Vec3};
use souple_mesh::{Aabb, AabbTree, OpeningSurface, closest_segment_triangle};
use souple_solve::BlockMatrix;

use crate::loads::{LoadError, Pose, RigidMotion, not_negative};

use super::carrier::{Carrier, Pressed};
use super::law::Approach;
use super::leading::Leading;
use super::opening::Openings;
use super::shape::Capsule;
use super::{ContactForce, ContactLaw, Shape};

/// What a tool touches.
#[derive(Clone, Debug)]
pub struct ToolSurface {
    /// At the start, facing outward.
    pub surface: OpeningSurface,
    /// Row of each of its points.
    pub rows: Vec<u32>,
}

/// A tool against a surface, see [`ContactLaw`]; its stiffness is that of a triangle of mean area.
#[derive(Debug)]
pub struct ToolContact {
    name: String,
    shape: Box<dyn Shape>,
    /// What other contacts with the same shape call it too.
    shape_name: String,
    leading: Leading,
    law: ContactLaw,
    /// Rows of the corners of each triangle.
    corners: Vec<[u32; 3]>,
    /// Area of each at the start over the mean of those that are on the surface before it opens.
    shares: Vec<f64>,
    /// Places at the start, for the first search.
    tree: AabbTree,
    openings: Openings,
    /// Distance up to which triangles make pairs, beside what the tool sweeps [m].
    reach: f64,
    /// For how long a search looks ahead [s].
    horizon: f64,
}

/// One triangle that touches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToolTouch {
    pub triangle: u32,
    /// Weights of its corners at the place of the touch.
    pub weights: [f64; 3],
    /// [m]
    pub penetration: f64,
    /// Forces on the triangle in the world's axes [N].
    pub force: ContactForce,
}

/// Heat so far, before the memory of what carries the tool.
const HEAT: usize = 1;

/// Memory of a pair, in the tool's place: where the triangle is, and what friction holds on to.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Known {
    /// Unit, from the tool's core to the triangle, when that was last clear.
    side: Vec3,
    /// Where on the core the triangle was nearest then.
    along: f64,
    /// Where friction holds the middle of the triangle [m].
    anchor: Vec3,
}

impl Known {
    fn read(memory: &[f64; 8]) -> Self {
        let vector = |at: usize| Vec3::new(memory[at], memory[at + 1], memory[at + 2]);
        Self { side: vector(0), along: memory[3], anchor: vector(4) }
    }

    fn write(self) -> [f64; 8] {
        let Self { side, along, anchor } = self;
        [side.x, side.y, side.z, along, anchor.x, anchor.y, anchor.z, 0.0]
    }
}

/// A pair as it stands, in the tool's place.
struct Sight {
    /// From the core to the triangle, along the side [m].
    distance: f64,
    side: Vec3,
    along: f64,
    weights: [f64; 3],
    /// How far the triangle is from where the tool could push it back to [m].
    aside: f64,
}

/// Part of a radius within which the core is taken to be at the triangle: which side that is on is no more told by places.
const AT_CORE: f64 = 0.25;

impl ToolContact {
    /// `reach` [m] is about the length of an edge, `horizon` the time from one search to when the next one is of use [s].
    ///
    /// # Errors
    /// The shape has no parts, the surface no triangle of area, or a number does not fit.
    pub fn new(
        name: impl Into<String>,
        touched: ToolSurface,
        shape: Box<dyn Shape>,
        motion: RigidMotion,
        law: ContactLaw,
        [reach, horizon]: [f64; 2],
    ) -> Result<Self, LoadError> {
        Self::led(name.into(), touched, shape, Leading::Motion(motion), law, [reach, horizon])
    }

    /// The same with a tool that is carried about.
    ///
    /// # Errors
    /// As of [`ToolContact::new`].
    pub fn carried(
        name: impl Into<String>,
        touched: ToolSurface,
        shape: Box<dyn Shape>,
        carrier: Box<dyn Carrier>,
        law: ContactLaw,
        [reach, horizon]: [f64; 2],
    ) -> Result<Self, LoadError> {
        Self::led(name.into(), touched, shape, Leading::Carrier(carrier), law, [reach, horizon])
    }

    fn led(
        name: String,
        ToolSurface { surface, rows }: ToolSurface,
        shape: Box<dyn Shape>,
        leading: Leading,
        law: ContactLaw,
        [reach, horizon]: [f64; 2],
    ) -> Result<Self, LoadError> {
        law.check()?;
        not_negative("reach", reach)?;
        not_negative("horizon", horizon)?;
        if shape.parts().is_empty() {
            return Err(LoadError::Empty { field: "shape", expected: "rounded part of a tool" });
        }
        let openings = Openings::new(&surface, &rows);
        let (first, surface) = (surface.at(f64::NEG_INFINITY).collect::<Vec<_>>(), surface.surface);
        let triangles = 0..surface.triangles.len() as u32;
        let areas: Vec<f64> = triangles.clone().map(|t| surface.area_vector(t).length()).collect();
        let mean = mean_area(&areas, &first);
        if mean <= 0.0 || !mean.is_finite() {
            return Err(LoadError::Empty { field: "triangles", expected: "triangle of an area" });
        }
        let boxes: Vec<Aabb> = triangles.map(|t| Aabb::of(surface.corners(t))).collect();
        let corners: Vec<[u32; 3]> =
            surface.triangles.iter().map(|corners| corners.map(|point| rows[point as usize])).collect();
        Ok(Self {
            shape_name: name.clone(),
            name,
            shape,
            leading,
            law,
            corners,
            shares: areas.iter().map(|area| area / mean).collect(),
            tree: AabbTree::build(&boxes),
            openings,
            reach,
            horizon,
        })
    }

    /// With the name of the shape, by which one that several bodies touch is known as one.
    pub fn against(self, shape_name: impl Into<String>) -> Self {
        Self { shape_name: shape_name.into(), ..self }
    }

    /// With the same stiffness of every triangle, whatever its area.
    pub fn weighing_alike(mut self) -> Self {
        self.shares.fill(1.0);
        self
    }

    pub fn law(&self) -> &ContactLaw {
        &self.law
    }

    /// Where the tool is.
    fn pose(&self, at: &Configuration) -> Pose {
        self.leading.pose(at.time, &at.memory[HEAT..])
    }

    fn triangle(&self, pair: &Pair, pose: &Pose, at: &Configuration) -> [Vec3; 3] {
        self.corners[pair.a as usize].map(|row| pose.to_shape(at.positions[row as usize]))
    }

    /// Triangles that touch, with the forces on them.
    pub fn touches(&self, at: &Configuration) -> Vec<ToolTouch> {
        self.each_touch(at).collect()
    }

    fn each_touch(&self, at: &Configuration) -> impl Iterator<Item = ToolTouch> {
        let pose = self.pose(at);
        let touch = move |pair: &Pair| {
            let (sight, approach, share) = self.approach(pair, &pose, at);
            let force = self.law.force(share, &approach, |number| number)?;
            let [normal, friction, stretch] =
                [force.normal, force.friction, force.stretch].map(|vector| pose.direction_to_world(vector));
            Some(ToolTouch {
                triangle: pair.a as u32,
                weights: sight.weights,
                penetration: -approach.gap,
                force: ContactForce { normal, friction, stretch, sliding: force.sliding },
            })
        };
        at.pairs.iter().filter_map(touch)
    }

    fn approach(&self, pair: &Pair, pose: &Pose, at: &Configuration) -> (Sight, Approach<f64>, f64) {
        let known = Known::read(&pair.memory);
        let triangle = self.triangle(pair, pose, at);
        let part = &self.shape.parts()[pair.b as usize];
        let sight = seen(part, triangle, &known);
        let rows = self.corners[pair.a as usize].map(|row| row as usize);
        let weighted = |values: &[Vec3]| -> Vec3 {
            rows.iter().zip(sight.weights).map(|(row, weight)| values[*row] * weight).sum()
        };
        let approach = Approach {
            gap: sight.distance - part.radius - self.law.thickness,
            normal: sight.side,
            from_anchor: middle(triangle) - known.anchor,
            velocity: if self.law.damping > 0.0 {
                pose.velocity_to_shape(weighted(at.positions), weighted(at.velocities))
            } else {
                Vec3::ZERO
            },
        };
        // what the tool passes at the side of lets go of it by and by
        let fading = self.reach.max(f64::MIN_POSITIVE);
        let held = ((part.radius + self.reach - sight.aside) / fading).clamp(0.0, 1.0);
        (sight, approach, self.shares[pair.a as usize] * held)
    }

    /// What the body does to the tool, were it there.
    fn pressed(&self, pose: &Pose, at: &Configuration) -> Pressed {
        let mut pressed = Pressed::default();
        for pair in at.pairs {
            let (_, approach, share) = self.approach(pair, pose, at);
            if let Some(force) = self.law.force(share, &approach, |number| number) {
                pressed.force -= pose.direction_to_world(force.total());
                pressed.stiffness += self.law.stiffest() * share;
            }
        }
        pressed
    }

    /// How the force of each touching pair falls, in the world's axes, with its triangle and weights.
    fn visit_stiffness(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        mut visit: impl FnMut([u32; 3], [f64; 3], &Mat3),
    ) {
        let pose = self.pose(at);
        for pair in at.pairs {
            let (sight, approach, share) = self.approach(pair, &pose, at);
            if let Some(stiffness) = self.law.lagged_stiffness(share, &approach) {
                let block = pose.tensor_to_world(&stiffness.weighted(weights));
                visit(self.corners[pair.a as usize], sight.weights, &block);
            }
        }
    }

    /// A pair that is not known: of a triangle that faces the tool's core, near enough or in its way.
    fn first_seen(&self, triangle: [Vec3; 3], part: &Capsule, within: f64) -> Option<Known> {
        let [a, b, c] = triangle;
        let nearest = closest_segment_triangle([part.from, part.to], triangle);
        let place = a * nearest.weights[0] + b * nearest.weights[1] + c * nearest.weights[2];
        let offset = place - (part.from + (part.to - part.from) * nearest.along);
        let side = offset.try_normalised()?;
        let faces = side.dot((b - a).cross(c - a)) < 0.0;
        (faces && nearest.distance_sq <= within * within).then_some(Known {
            side,
            along: nearest.along,
            anchor: middle(triangle),
        })
    }
}

/// The mean of some areas, of all where these are none.
fn mean_area(areas: &[f64], of: &[usize]) -> f64 {
    if of.is_empty() {
        return areas.iter().sum::<f64>() / areas.len() as f64;
    }
    of.iter().map(|triangle| areas[*triangle]).sum::<f64>() / of.len() as f64
}

fn middle([a, b, c]: [Vec3; 3]) -> Vec3 {
    (a + b + c) * (1.0 / 3.0)
}

/// How a triangle lies to a part, by where it was when that was clear.
fn seen(part: &Capsule, triangle: [Vec3; 3], known: &Known) -> Sight {
    let at =
        |weights: [f64; 3]| triangle[0] * weights[0] + triangle[1] * weights[1] + triangle[2] * weights[2];
    let core = |along: f64| part.from + (part.to - part.from) * along;
    let nearest = closest_segment_triangle([part.from, part.to], triangle);
    let offset = at(nearest.weights) - core(nearest.along);
    let distance = nearest.distance_sq.sqrt();
    if distance > AT_CORE * part.radius && offset.dot(known.side) > 0.0 {
        let side = offset * (1.0 / distance);
        return Sight { distance, side, along: nearest.along, weights: nearest.weights, aside: 0.0 };
    }
    // the core is at the triangle or through it: what counts is how far it went along the side that it came from
    let place = core(known.along);
    let (weights, _) = souple_mesh::closest_point_on_triangle(place, triangle);
    let offset = at(weights) - place;
    let distance = offset.dot(known.side);
    let aside = (offset - known.side * distance).length();
    Sight { distance, side: known.side, along: known.along, weights, aside }
}

/// What is kept between searches.
#[derive(Debug)]
struct Search {
    tree: AabbTree,
    /// Where the tool was at the last one, and where it was expected to be at the horizon.
    from: Vec3,
    to: Vec3,
    /// How often the surface had opened.
    opened: usize,
}

fn search(scratch: &mut Scratch) -> &mut Search {
    scratch.downcast_mut().unwrap_or_else(|| unreachable!("made by this force's own new_scratch"))
}

impl Force for ToolContact {
    fn name(&self) -> &str {
        &self.name
    }

    fn declaration(&self) -> Declaration {
        Declaration {
            conservative: self.law.is_conservative(),
            velocity_terms: self.law.damping > 0.0,
            // that of the triangle as it is touched, the turning of its normal left out
            symmetric_tangent: true,
            internal: false,
            changing_pattern: true,
        }
    }

    fn memory_len(&self) -> usize {
        HEAT + self.leading.memory_len()
    }

    fn initial_memory(&self, memory: &mut [f64]) {
        memory.fill(0.0);
        self.leading.begin(&mut memory[HEAT..]);
    }

    fn new_scratch(&self) -> Scratch {
        Box::new(Search { tree: self.tree.clone(), from: Vec3::ZERO, to: Vec3::ZERO, opened: 0 })
    }

    fn energy(&self, at: &Configuration, _scratch: &mut Scratch) -> Energy {
        let pose = self.pose(at);
        let stored = |pair: &Pair| {
            let (_, approach, share) = self.approach(pair, &pose, at);
            self.law.stored(share, &approach)
        };
        Energy { stored: at.pairs.iter().map(stored).sum(), dissipated: at.memory[0] }
    }

    fn add_force(&self, at: &Configuration, _scratch: &mut Scratch, out: &mut [Vec3]) {
        let pose = self.pose(at);
        for pair in at.pairs {
            let (sight, approach, share) = self.approach(pair, &pose, at);
            let Some(force) = self.law.force(share, &approach, |number| number) else { continue };
            let force = pose.direction_to_world(force.total());
            for (row, weight) in self.corners[pair.a as usize].iter().zip(sight.weights) {
                out[*row as usize] += force * weight;
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
        self.visit_stiffness(at, weights, |rows, shares, block| {
            let moved: Vec3 = rows.iter().zip(shares).map(|(row, share)| delta[*row as usize] * share).sum();
            for (row, share) in rows.iter().zip(shares) {
                out[*row as usize] += *block * moved * share;
            }
        });
    }

    fn visit_cliques(&self, pairs: &[Pair], visit: &mut dyn FnMut(&[u32])) {
        pairs.iter().for_each(|pair| visit(&self.corners[pair.a as usize]));
    }

    fn add_blocks(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        _: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) {
        self.visit_stiffness(at, weights, |rows, shares, block| {
            for (row, share) in rows.iter().zip(shares) {
                for (column, other) in rows.iter().zip(shares) {
                    add_block(matrix, *row as usize, *column as usize, &(*block * (share * other)));
                }
            }
        });
    }

    /// Pairs that touch stay; new ones are of triangles near what the tool sweeps up to the horizon.
    fn find_pairs(&self, at: &Configuration, scratch: &mut Scratch, found: &mut Vec<Pair>) {
        let pose = self.pose(at);
        let Search { tree, from, to, opened } = search(scratch);
        *opened = self.openings.by(at.time);
        let is_there = |triangle: usize| self.openings.has(triangle, at.time);
        tree.refit(self.corners.iter().enumerate().map(|(triangle, rows)| {
            // what is not there has no box that anything could overlap
            let corners = is_there(triangle).then(|| rows.map(|row| at.positions[row as usize]));
            corners.map_or(Aabb::EMPTY, Aabb::of)
        }));
        let swept = pose.velocity * self.horizon;
        let turned = pose.angular_velocity.length() * self.horizon;
        // how far beyond its own size a part may come up to the horizon
        let margin = |ends: [Vec3; 2]| {
            let arm = ends.iter().map(|end| (*end - pose.origin).length()).fold(0.0, f64::max);
            self.law.thickness + self.reach + turned * arm
        };
        let ends = |part: &Capsule| [part.from, part.to].map(|end| pose.to_world(end));
        for pair in at.pairs.iter().filter(|pair| is_there(pair.a as usize)) {
            let (sight, approach, _) = self.approach(pair, &pose, at);
            let part = &self.shape.parts()[pair.b as usize];
            // what slid off at the side has let go
            let is_near = approach.gap < margin(ends(part)) + swept.length();
            if is_near && sight.aside <= part.radius + self.reach {
                found.push(*pair);
            }
        }
        (*from, *to) = (pose.origin, pose.origin + swept);
        for (number, part) in self.shape.parts().iter().enumerate() {
            let [from, to] = ends(part);
            let around = part.radius + margin([from, to]);
            let way = Aabb::of([from, to, from + swept, to + swept]).grown(around);
            let within = around + swept.length();
            tree.overlapping(way, |triangle| {
                let mut pair = Pair::new(triangle as usize, number, [0.0; 8]);
                if at.pairs.binary_search_by_key(&(pair.a, pair.b), |known| (known.a, known.b)).is_err()
                    && let Some(known) = self.first_seen(self.triangle(&pair, &pose, at), part, within)
                {
                    pair.memory = known.write();
                    found.push(pair);
                }
            });
        }
    }

    /// Half the reach is for what the body moves, half for what the tool moves beside its way.
    fn pairs_are_stale(&self, searched: &[Vec3], at: &Configuration, scratch: &Scratch) -> bool {
        let limit_sq = 0.25 * self.reach * self.reach;
        let Some(Search { from, to, opened, .. }) = scratch.downcast_ref() else { return false };
        if *opened != self.openings.by(at.time) {
            return true;
        }
        let (way, now) = (*to - *from, self.pose(at).origin - *from);
        let share = (now.dot(way) / way.length_sq().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        let moved = |row: &u32| (at.positions[*row as usize] - searched[*row as usize]).length_sq();
        (now - way * share).length_sq() > limit_sq
            || self.openings.rows(at.time).iter().any(|row| moved(row) > limit_sq)
    }

    fn recall_search(&self, searched: &Configuration, scratch: &mut Scratch) {
        let pose = self.pose(searched);
        let Search { from, to, opened, .. } = search(scratch);
        (*from, *to) = (pose.origin, pose.origin + pose.velocity * self.horizon);
        *opened = self.openings.by(searched.time);
    }

    /// On which side it is was seen in time, where friction holds it is where it is now.
    fn bring_up(&self, now: &Configuration, pair: &mut Pair) {
        let known = Known::read(&pair.memory);
        let anchor = middle(self.triangle(pair, &self.pose(now), now));
        pair.memory = Known { anchor, ..known }.write();
    }

    // k n nᵀ shared by weights of sum one is at most k on each corner
    fn touching_stiffness(&self) -> Option<Vec<(u32, f64)>> {
        let stiffest = self.law.stiffest();
        let bound =
            |triangle: usize| self.corners[triangle].map(|row| (row, stiffest * self.shares[triangle]));
        Some(self.openings.largest_sums(self.corners.len(), |triangles| triangles.flat_map(bound).collect()))
    }

    fn accepts_pair(&self, pair: &Pair) -> bool {
        pair.a < self.corners.len() as u64 && pair.b < self.shape.parts().len() as u64
    }

    fn advance_memory(&self, at: &Configuration, timestep: f64, memory: &mut [f64], pairs: &mut [Pair]) {
        let pose = self.pose(at);
        for pair in pairs {
            let (sight, approach, share) = self.approach(pair, &pose, at);
            let place = middle(self.triangle(pair, &pose, at));
            let stretch = match self.law.force(share, &approach, |number| number) {
                Some(force) => {
                    let pressed = -self.law.stiffness * share * approach.gap;
                    let rate = -approach.normal.dot(approach.velocity);
                    // what damping takes, and what sliding does: T |s - held|
                    memory[0] += (force.normal.dot(approach.normal) - pressed) * rate * timestep;
                    let tangent = approach.from_anchor - sight.side * sight.side.dot(approach.from_anchor);
                    let slid = (tangent - force.stretch).dot(force.stretch);
                    memory[0] += self.law.tangential_stiffness * share * slid;
                    force.stretch
                }
                None => Vec3::ZERO,
            };
            pair.memory = Known { side: sight.side, along: sight.along, anchor: place - stretch }.write();
        }
        if let Leading::Carrier(carrier) = &self.leading {
            carrier.advance(&|pose| self.pressed(pose, at), at.time, timestep, &mut memory[HEAT..]);
        }
    }

    fn editable(&self) -> Vec<Editable> {
        let mut all = self.law.editable();
        all.extend(self.leading.editable());
        all
    }

    fn set_parameter(&mut self, name: &str, value: f64) -> Result<(), ParameterError> {
        match self.leading.owner_of(name) {
            Some(carrier) => carrier.set_parameter(&self.name, name, value),
            None => self.law.set_parameter(&self.name, name, value),
        }
    }

    fn bytes(&self) -> usize {
        12 * self.corners.capacity() + 8 * self.shares.capacity() + self.openings.bytes() + self.tree.bytes()
    }

    fn scratch_bytes(&self, scratch: &Scratch) -> usize {
        scratch.downcast_ref::<Search>().map_or(0, |search| search.tree.bytes())
    }

    fn visit_contacts(&self, at: &Configuration, visit: &mut dyn FnMut(&ContactPoint)) {
        for touch in self.each_touch(at) {
            for (row, weight) in self.corners[touch.triangle as usize].iter().zip(touch.weights) {
                visit(&ContactPoint {
                    row: *row,
                    against: &[],
                    penetration: touch.penetration,
                    normal_force: touch.force.normal * weight,
                    friction: touch.force.friction * weight,
                });
            }
        }
    }

    fn lead(&mut self, place: Vec3) {
        self.leading.lead(place);
    }

    fn in_hand(&self, at: &Configuration) -> Option<InHand> {
        self.leading.in_hand(&at.memory[HEAT..])
    }

    fn obstacle(&self) -> Option<Obstacle> {
        self.leading.obstacle(self.shape.as_ref(), &self.shape_name)
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}
