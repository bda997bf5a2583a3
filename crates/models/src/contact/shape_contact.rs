//! Points of a body against a shape.
//!
//! Every point keeps its anchor in the force's memory, also while it touches nothing: a touch that begins
//! within an implicit step of any length is answered in that step, and the matrix keeps its pattern (a block
//! per point) whatever comes and goes.
//!
//! Where the surface of the body opens, the shares of its points change at the dates at which it does; a point without a share
//! touches nothing.
//!
//! What pushes on a shape that rows bear, such as the skin of a body, comes to these rows in the next step: so the momentum
//! returns exactly, one step late, and no point is tied to rows that are others at every moment, see `burden`.

use std::any::Any;

use souple_engine::tangent::add_block;
use souple_engine::{
    Configuration, Declaration, Editable, Energy, Force, InHand, Obstacle, Pair, ParameterError, Scratch,
    TangentWeights,
};
use souple_math::{Dual, Mat3, Vec3};
use souple_solve::{BlockMatrix, reduce};

use crate::loads::{LoadError, finite, not_negative};

use super::burden::{self, Push};
use super::carrier::{Carrier, Pressed};
use super::law::Approach;
use super::leading::Leading;
use super::opening::{Shares, shares_at};
use super::{ContactForce, ContactLaw, Nearest, Shape};
use crate::loads::{Pose, RigidMotion};

/// A point of the body's surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactPoint {
    pub row: u32,
    /// Its part of the law's stiffness at the start: 1, or its area over the mean area.
    pub share: f64,
    /// Where it is at the start [m]: the first anchor.
    pub start: Vec3,
}

/// A body's points against one shape, see [`ContactLaw`]. Friction acts relative to the moving shape.
#[derive(Debug)]
pub struct ShapeContact {
    name: String,
    points: Vec<ContactPoint>,
    /// Their shares from dates on at which the surface opens, ascending.
    later: Vec<Shares>,
    /// Their rows ascend, each once.
    ascends: bool,
    shape: Box<dyn Shape>,
    /// What other contacts with the same shape call it too.
    shape_name: String,
    leading: Leading,
    law: ContactLaw,
}

/// One point that touches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touch {
    pub row: u32,
    /// How deep the point is, thickness included [m].
    pub penetration: f64,
    /// Unit, out of the shape.
    pub normal: Vec3,
    /// Forces on the point in the world's axes [N].
    pub force: ContactForce,
}

/// Heat so far, before the points' own memory.
const HEAT: usize = 1;
/// Anchor and stretch of a point, in the shape's place.
const PER_POINT: usize = 6;
/// Points that are worth a second thread.
const SHARED_FROM: usize = 1024;

/// A point as the law sees it, in the shape's place.
struct Local {
    approach: Approach<f64>,
    nearest: Nearest,
    share: f64,
}

impl ShapeContact {
    /// # Errors
    /// No points, or a number that does not fit.
    pub fn new(
        name: impl Into<String>,
        points: Vec<ContactPoint>,
        shape: Box<dyn Shape>,
        motion: RigidMotion,
        law: ContactLaw,
    ) -> Result<Self, LoadError> {
        Self::led(name.into(), points, shape, Leading::Motion(motion), law)
    }

    /// The same with a shape that is carried about.
    ///
    /// # Errors
    /// As of [`ShapeContact::new`].
    pub fn carried(
        name: impl Into<String>,
        points: Vec<ContactPoint>,
        shape: Box<dyn Shape>,
        carrier: Box<dyn Carrier>,
        law: ContactLaw,
    ) -> Result<Self, LoadError> {
        Self::led(name.into(), points, shape, Leading::Carrier(carrier), law)
    }

    fn led(
        name: String,
        points: Vec<ContactPoint>,
        shape: Box<dyn Shape>,
        leading: Leading,
        law: ContactLaw,
    ) -> Result<Self, LoadError> {
        if points.is_empty() {
            return Err(LoadError::Empty { field: "points", expected: "point of a body's surface" });
        }
        for (index, point) in points.iter().enumerate() {
            not_negative(format!("points[{index}].share"), point.share)?;
            for axis in 0..3 {
                finite(format!("points[{index}].start[{axis}]"), point.start[axis])?;
            }
        }
        law.check()?;
        let ascends = points.is_sorted_by(|a, b| a.row < b.row);
        let later = Vec::new();
        Ok(Self { shape_name: name.clone(), name, points, later, ascends, shape, leading, law })
    }

    /// Where the shape is.
    fn pose(&self, at: &Configuration) -> Pose {
        self.leading.pose(at.time, self.carrier_memory(at.memory))
    }

    /// The part of the memory that belongs to what carries the shape.
    fn carrier_memory<'m>(&self, memory: &'m [f64]) -> &'m [f64] {
        &memory[self.burdens().end..]
    }

    /// What the points do to the shape, were it there.
    fn pressed(&self, pose: &Pose, at: &Configuration) -> Pressed {
        let mut pressed = Pressed::default();
        for (_, local) in self.touching(pose, at) {
            if let Some(force) = self.law.force(local.share, &local.approach, |number| number) {
                pressed.force -= pose.direction_to_world(force.total());
                pressed.stiffness += self.law.stiffest() * local.share;
            }
        }
        pressed
    }

    /// On a point [N]; none where it does not touch.
    fn force_on(&self, index: usize, pose: &Pose, at: &Configuration) -> Vec3 {
        let local = self.local(index, pose, at).filter(|local| local.approach.gap < 0.0);
        let force = local.and_then(|local| self.law.force(local.share, &local.approach, |number| number));
        force.map_or(Vec3::ZERO, |force| pose.direction_to_world(force.total()))
    }

    /// Adds the forces on points whose rows ascend, each to its own row, so that threads may share them; `out` begins with row
    /// `first`.
    fn add_forces(
        &self,
        points: std::ops::Range<usize>,
        pose: &Pose,
        at: &Configuration,
        first: usize,
        out: &mut [Vec3],
    ) {
        if points.len() < SHARED_FROM || rayon::current_num_threads() == 1 {
            for index in points {
                out[self.points[index].row as usize - first] += self.force_on(index, pose, at);
            }
            return;
        }
        let middle = points.start + points.len() / 2;
        let row = self.points[middle].row as usize;
        let (head, tail) = out.split_at_mut(row - first);
        rayon::join(
            || self.add_forces(points.start..middle, pose, at, first, head),
            || self.add_forces(middle..points.end, pose, at, row, tail),
        );
    }

    /// With other shares of its points from dates on, at which their surface opens; in the order of the dates.
    ///
    /// # Errors
    /// There are not as many as points, or a number does not fit.
    pub fn opening(self, later: Vec<Shares>) -> Result<Self, LoadError> {
        for shares in &later {
            let (found, expected) = (shares.of_points.len(), self.points.len());
            if found != expected {
                return Err(LoadError::Count {
                    field: "shares",
                    found,
                    expected,
                    of: "the contact's points",
                });
            }
            for (index, share) in shares.of_points.iter().enumerate() {
                not_negative(format!("shares[{index}]"), *share)?;
            }
        }
        Ok(Self { later, ..self })
    }

    /// The part of the law's stiffness that a point has at a time [s].
    fn share(&self, index: usize, time: f64) -> f64 {
        shares_at(&self.later, time).map_or(self.points[index].share, |shares| shares[index])
    }

    /// With the name of the shape, by which one that several bodies touch is known as one.
    pub fn against(self, shape_name: impl Into<String>) -> Self {
        Self { shape_name: shape_name.into(), ..self }
    }

    pub fn law(&self) -> &ContactLaw {
        &self.law
    }

    /// What is touched, where it stands when it does not move.
    pub fn shape(&self) -> &dyn Shape {
        self.shape.as_ref()
    }

    /// Where its points are in the place of the shape [m], in their order.
    pub fn places<'a>(&'a self, at: &'a Configuration) -> impl Iterator<Item = Vec3> + 'a {
        let pose = self.pose(at);
        self.points.iter().map(move |point| pose.to_shape(at.positions[point.row as usize]))
    }

    /// Its points, as they were at the start.
    pub fn points(&self) -> &[ContactPoint] {
        &self.points
    }

    /// Points that touch, with the forces on them.
    pub fn touches(&self, at: &Configuration) -> Vec<Touch> {
        self.each_touch(at).collect()
    }

    fn each_touch(&self, at: &Configuration) -> impl Iterator<Item = Touch> {
        let pose = self.pose(at);
        let touch = move |(index, point): (usize, &ContactPoint)| {
            let local = self.local(index, &pose, at)?;
            let force = self.law.force(local.share, &local.approach, |number| number)?;
            let [normal, friction, stretch] =
                [force.normal, force.friction, force.stretch].map(|vector| pose.direction_to_world(vector));
            Some(Touch {
                row: point.row,
                penetration: -local.approach.gap,
                normal: pose.direction_to_world(local.approach.normal),
                force: ContactForce { normal, friction, stretch, sliding: force.sliding },
            })
        };
        self.points.iter().enumerate().filter_map(touch)
    }

    /// Normal force and friction on the body [N]; the shape bears their opposite.
    pub fn total(&self, at: &Configuration) -> (Vec3, Vec3) {
        let touches = self.touches(at);
        (touches.iter().map(|t| t.force.normal).sum(), touches.iter().map(|t| t.force.friction).sum())
    }

    /// `None` where the point is out of reach.
    fn local(&self, index: usize, pose: &Pose, at: &Configuration) -> Option<Local> {
        let (anchor, _) = remembered(at.memory, index);
        self.local_from(anchor, index, pose, at)
    }

    /// The same with the anchor given, in the shape's place [m].
    fn local_from(&self, anchor: Vec3, index: usize, pose: &Pose, at: &Configuration) -> Option<Local> {
        let share = self.share(index, at.time);
        // what is not on the surface touches nothing
        if share == 0.0 {
            return None;
        }
        let row = self.points[index].row as usize;
        let position = pose.to_shape(at.positions[row]);
        let nearest = self.shape.nearest_in(at, position, self.law.thickness)?;
        let gap = nearest.distance - self.law.thickness;
        let is_damped = self.law.damping > 0.0 && gap < 0.0;
        let under = if is_damped { self.velocity_under(at, position) } else { Vec3::ZERO };
        let approach = Approach {
            gap,
            normal: nearest.normal,
            from_anchor: position - anchor,
            velocity: pose.velocity_to_shape(at.positions[row], at.velocities[row] - under),
        };
        Some(Local { approach, nearest, share })
    }

    /// The velocity of those that bear the shape at a point of it [m/s].
    fn velocity_under(&self, at: &Configuration, point: Vec3) -> Vec3 {
        let (bearers, mut velocity) = (self.shape.bearers(), Vec3::ZERO);
        self.shape.visit_shares(at, point, &mut |bearer, share| {
            velocity += at.velocities[bearers[bearer] as usize] * share;
        });
        velocity
    }

    /// What the points do to the bearers.
    fn burden(&self, pose: &Pose, at: &Configuration, out: &mut [f64]) {
        let push = |(point, local): (&ContactPoint, Local)| {
            let force = self.law.force(local.share, &local.approach, |number| number)?;
            let place = at.positions[point.row as usize];
            let force = pose.direction_to_world(force.total());
            Some(Push { force, at: place, in_shape: pose.to_shape(place) })
        };
        burden::collect(self.shape.as_ref(), at, self.touching(pose, at).filter_map(push), out);
    }

    /// The part of the memory that belongs to the bearers.
    fn burdens(&self) -> std::ops::Range<usize> {
        let first = HEAT + PER_POINT * self.points.len();
        first..first + burden::memory_len(self.shape.as_ref())
    }

    /// Change of the force on a touching point for changes of its position and velocity.
    fn change(&self, local: &Local, pose: &Pose, position: Vec3, velocity: Vec3) -> Vec3 {
        let Local { approach, nearest, share } = local;
        let moved = pose.direction_to_shape(position);
        let gap = Dual::new(approach.gap, nearest.normal.dot(moved));
        let dual = Approach {
            gap,
            normal: dual(approach.normal, nearest.curvature * moved),
            from_anchor: dual(approach.from_anchor, moved),
            velocity: dual(approach.velocity, pose.velocity_change_to_shape(position, velocity)),
        };
        let force = self.law.force(*share, &dual, |number: Dual| number.value);
        force.map_or(Vec3::ZERO, |force| pose.direction_to_world(derivative(force.total())))
    }

    /// Points that touch, as the law sees them.
    fn touching<'a>(
        &'a self,
        pose: &'a Pose,
        at: &'a Configuration,
    ) -> impl Iterator<Item = (&'a ContactPoint, Local)> {
        let local = move |(index, point)| Some((point, self.local(index, pose, at)?));
        self.points.iter().enumerate().filter_map(local).filter(|(_, local)| local.approach.gap < 0.0)
    }
}

/// Anchor and stretch of a point in the shape's place [m].
fn remembered(memory: &[f64], point: usize) -> (Vec3, Vec3) {
    recalled(&memory[HEAT + PER_POINT * point..])
}

/// The same from the numbers of the point.
fn recalled(numbers: &[f64]) -> (Vec3, Vec3) {
    (Vec3::new(numbers[0], numbers[1], numbers[2]), Vec3::new(numbers[3], numbers[4], numbers[5]))
}

fn remember(numbers: &mut [f64], anchor: Vec3, stretch: Vec3) {
    numbers[..3].copy_from_slice(&anchor.to_array());
    numbers[3..].copy_from_slice(&stretch.to_array());
}

pub(super) fn dual(value: Vec3, change: Vec3) -> Vec3<Dual> {
    Vec3::new(Dual::new(value.x, change.x), Dual::new(value.y, change.y), Dual::new(value.z, change.z))
}

pub(super) fn derivative(vector: Vec3<Dual>) -> Vec3 {
    Vec3::new(vector.x.derivative, vector.y.derivative, vector.z.derivative)
}

impl Force for ShapeContact {
    fn name(&self) -> &str {
        &self.name
    }

    fn declaration(&self) -> Declaration {
        let law = &self.law;
        Declaration {
            conservative: law.is_conservative(),
            velocity_terms: law.damping > 0.0,
            // sliding friction grows with the normal force, but not the other way round; damping acts along
            // a normal that turns
            symmetric_tangent: law.is_conservative(),
            internal: false,
            changing_pattern: false,
        }
    }

    fn memory_len(&self) -> usize {
        self.burdens().end + self.leading.memory_len()
    }

    fn initial_memory(&self, memory: &mut [f64]) {
        memory.fill(0.0);
        let pose = self.leading.begin(&mut memory[self.burdens().end..]);
        for (index, point) in self.points.iter().enumerate() {
            let numbers = &mut memory[HEAT + PER_POINT * index..][..PER_POINT];
            remember(numbers, pose.to_shape(point.start), Vec3::ZERO);
        }
    }

    fn energy(&self, at: &Configuration, _scratch: &mut Scratch) -> Energy {
        let pose = self.pose(at);
        let stored = self.touching(&pose, at).map(|(_, local)| self.law.stored(local.share, &local.approach));
        Energy { stored: stored.sum(), dissipated: at.memory[0] }
    }

    fn add_force(&self, at: &Configuration, _scratch: &mut Scratch, out: &mut [Vec3]) {
        let pose = self.pose(at);
        if self.ascends {
            self.add_forces(0..self.points.len(), &pose, at, 0, out);
        } else {
            for index in 0..self.points.len() {
                out[self.points[index].row as usize] += self.force_on(index, &pose, at);
            }
        }
        burden::add(self.shape.as_ref(), &at.memory[self.burdens()], at.positions, out);
    }

    // what is borne is known from the step before; that its moment depends on where the bearers are by now is left out: it is
    // the moment of what they moved in a step
    fn add_differential(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        delta: &[Vec3],
        _scratch: &mut Scratch,
        out: &mut [Vec3],
    ) {
        let pose = self.pose(at);
        for (point, local) in self.touching(&pose, at) {
            let delta = delta[point.row as usize];
            let (position, velocity) = (delta * weights.position, delta * weights.velocity);
            out[point.row as usize] += self.change(&local, &pose, position, velocity);
        }
    }

    fn visit_cliques(&self, _pairs: &[Pair], visit: &mut dyn FnMut(&[u32])) {
        self.points.iter().for_each(|point| visit(&[point.row]));
    }

    // a point that touches nothing draws its anchor with it: it is seen first where that touches
    fn visit_reach(&self, at: &Configuration, slack: f64, visit: &mut dyn FnMut(u32)) {
        let is_told = self.shape.is_distance() && self.shape.bearers().is_empty() && self.leading.rests();
        let (pose, reach) = (self.pose(at), self.law.thickness + slack);
        let may_touch = |point: &&ContactPoint| {
            let place = pose.to_shape(at.positions[point.row as usize]);
            self.shape.nearest_in(at, place, reach).is_some_and(|nearest| nearest.distance <= reach)
        };
        self.points.iter().filter(|point| !is_told || may_touch(point)).for_each(|point| visit(point.row));
    }

    fn add_blocks(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        _: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) {
        let pose = self.pose(at);
        for (point, local) in self.touching(&pose, at) {
            let column = |e: Vec3| self.change(&local, &pose, e * weights.position, e * weights.velocity);
            let block = Mat3::from_columns(column(Vec3::X), column(Vec3::Y), column(Vec3::Z));
            add_block(matrix, point.row as usize, point.row as usize, &block);
        }
    }

    fn add_symmetric_blocks(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        _: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) {
        let pose = self.pose(at);
        for (point, local) in self.touching(&pose, at) {
            if let Some(stiffness) = self.law.lagged_stiffness(local.share, &local.approach) {
                let block = pose.tensor_to_world(&stiffness.weighted(weights));
                add_block(matrix, point.row as usize, point.row as usize, &block);
            }
        }
    }

    // what points do to bearers and to what carries the shape reads the anchors of all before they move on
    fn advances_in_place(&self) -> bool {
        self.shape.bearers().is_empty() && matches!(self.leading, Leading::Motion(_))
    }

    fn advance_memory(&self, at: &Configuration, timestep: f64, memory: &mut [f64], _pairs: &mut [Pair]) {
        let pose = self.leading.pose(at.time, self.carrier_memory(memory));
        let (heat, own) = memory[..self.burdens().start].split_at_mut(HEAT);
        let (own, _) = own.as_chunks_mut::<PER_POINT>();
        let advance = |index: usize, numbers: &mut [f64; PER_POINT]| {
            let point = &self.points[index];
            let (anchor, before) = recalled(numbers);
            let position = pose.to_shape(at.positions[point.row as usize]);
            let local = self.local_from(anchor, index, &pose, at);
            let (stretch, heat) = match &local {
                Some(local) => self.law.advance(local.share, &local.approach, before, timestep),
                // out of reach, so is whatever was stretched
                None => {
                    let share = self.share(index, at.time);
                    (Vec3::ZERO, 0.5 * self.law.tangential_stiffness * share * before.length_sq())
                }
            };
            // what sticks to something that is borne goes with it
            let sticks = self.law.friction > 0.0 && local.is_some_and(|local| local.approach.gap < 0.0);
            let carried = if sticks { self.velocity_under(at, position) * timestep } else { Vec3::ZERO };
            remember(numbers, position - stretch + carried, stretch);
            heat
        };
        heat[0] += reduce::sum_mut(0, own, &|first, own: &mut [[f64; PER_POINT]]| {
            (first..).zip(own).map(|(index, numbers)| advance(index, numbers)).sum::<f64>()
        });
        if !self.shape.bearers().is_empty() {
            self.burden(&pose, at, &mut memory[self.burdens()]);
        }
        if let Leading::Carrier(carrier) = &self.leading {
            let own = &mut memory[self.burdens().end..];
            carrier.advance(&|pose| self.pressed(pose, at), at.time, timestep, own);
        }
    }

    // k n nᵀ + k_t (I - n nᵀ)
    fn touching_stiffness(&self) -> Option<Vec<(u32, f64)>> {
        let stiffness = self.law.stiffest();
        let largest = |(index, point): (usize, &ContactPoint)| {
            let later = self.later.iter().map(|shares| shares.of_points[index]);
            (point.row, stiffness * later.fold(point.share, f64::max))
        };
        Some(self.points.iter().enumerate().map(largest).collect())
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
        size_of_val(self.points.as_slice())
            + self.later.iter().map(|shares| 8 * shares.of_points.capacity()).sum::<usize>()
    }

    fn visit_contacts(&self, at: &Configuration, visit: &mut dyn FnMut(&souple_engine::ContactPoint)) {
        for touch in self.each_touch(at) {
            visit(&souple_engine::ContactPoint {
                row: touch.row,
                against: &[],
                penetration: touch.penetration,
                normal_force: touch.force.normal,
                friction: touch.force.friction,
            });
        }
    }

    fn lead(&mut self, place: Vec3) {
        self.leading.lead(place);
    }

    fn in_hand(&self, at: &Configuration) -> Option<InHand> {
        self.leading.in_hand(self.carrier_memory(at.memory))
    }

    fn obstacle(&self) -> Option<Obstacle> {
        self.leading.obstacle(self.shape.as_ref(), &self.shape_name)
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}
