//! Tools that move the surface they touch: displacements are imposed, and points are held (Debunne 2000, 6 §2–3).
//!
//! Where a period begins, the triangles are found that reach into the tool. Each is clipped by it: the centroid of what is
//! inside is to leave the tool the shortest way for the surface, against the normal of the triangle, and the corners are displaced
//! so that it does, but for a residual penetration within which it stays in touch. Until the next look those points are
//! held: they go as they are told, evenly, and the tool feels what their body does to them. Take it where the force of a penalty
//! is to be compared with what the source has; a penalty keeps the momentum and sees fast tools, which this does not.

use std::any::Any;

use souple_engine::{
    Configuration, ContactPoint, Declaration, Editable, Energy, Felt, Force, Holding, InHand, Obstacle, Pair,
    ParameterError, Scratch, TangentWeights, Told,
};
use souple_math::Vec3;
use souple_mesh::{Aabb, AabbTree, closest_segment_triangle};
use souple_solve::BlockMatrix;

use crate::loads::{LoadError, Pose, RigidMotion, not_negative};

use super::carrier::Carrier;
use super::clip::{Inside, inside};
use super::leading::Leading;
use super::opening::Openings;
use super::shape::Capsule;
use super::{Shape, ToolSurface};

/// When the displacement that is imposed is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Displacing {
    /// Evenly over all steps until the next look.
    Progressively,
    /// In the first of them.
    AtOnce,
}

/// How displacements are imposed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImposedLaw {
    /// Part of the way out of the tool that is made until the next look.
    pub fraction: f64,
    /// How deep a triangle stays in the tool [m].
    pub residual: f64,
    pub displacing: Displacing,
    pub felt: Felt,
}

/// A tool that moves the surface that it touches.
#[derive(Debug)]
pub struct ImposedContact {
    name: String,
    shape: Box<dyn Shape>,
    shape_name: String,
    leading: Leading,
    law: ImposedLaw,
    /// Rows of the points of the surface, ascending.
    rows: Vec<u32>,
    /// Corners of each triangle, by their numbers among `rows`.
    corners: Vec<[u32; 3]>,
    /// Places at the start, for the first search.
    tree: AabbTree,
    openings: Openings,
    /// Between two looks [s].
    period: f64,
}

/// What is felt, before the memory of what carries the tool: the force, its greatest change since the last look, whether
/// displacements are made, and what all points bear that are held.
const HEAD: usize = 8;
const JUMP: usize = 3;
const IS_MADE: usize = 4;
const BORNE: usize = 5;

/// What a point of the surface has been told, and what it bore.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Node {
    /// Until the next look [m].
    displacement: Vec3,
    /// Around it, in touch [m²].
    contact_area: f64,
    /// Around it [m²].
    area: f64,
    /// Of the deepest triangle around it [m].
    depth: f64,
    is_held: bool,
    /// Of the body on it, last [N].
    force: Vec3,
}

/// Moved by less than something, a triangle never comes out.
fn is_fraction(value: f64) -> bool {
    value > 0.0 && value <= 1.0
}

const A_FRACTION: &str = "above 0 and at most 1";
/// The core of a part comes through a triangle that is deeper than the radius around it.
const WITHIN_PARTS: &str = "less than the radius of every part of the tool";

fn least_radius(shape: &dyn Shape) -> f64 {
    shape.parts().iter().map(|part| part.radius).fold(f64::INFINITY, f64::min)
}

/// Numbers of a [`Node`].
const NODE: usize = 10;

impl Node {
    fn read(numbers: &[f64]) -> Self {
        let vector = |at: usize| Vec3::new(numbers[at], numbers[at + 1], numbers[at + 2]);
        Self {
            displacement: vector(0),
            contact_area: numbers[3],
            area: numbers[4],
            depth: numbers[5],
            is_held: numbers[6] != 0.0,
            force: vector(7),
        }
    }

    fn write(&self, numbers: &mut [f64]) {
        numbers[..3].copy_from_slice(&self.displacement.to_array());
        numbers[3] = self.contact_area;
        numbers[4] = self.area;
        numbers[5] = self.depth;
        numbers[6] = f64::from(u8::from(self.is_held));
        numbers[7..NODE].copy_from_slice(&self.force.to_array());
    }
}

/// What is kept between looks.
#[derive(Debug)]
struct Search {
    tree: AabbTree,
    /// Triangles near the tool, each with the number of a part.
    found: Vec<(u32, u32)>,
    /// Of each point of the surface: how much the displacements that it is asked for count together.
    weights: Vec<f64>,
}

fn search(scratch: &mut Scratch) -> &mut Search {
    scratch.downcast_mut().unwrap_or_else(|| unreachable!("made by this force's own new_scratch"))
}

/// A triangle that reaches into a part of the tool.
struct Touch {
    inside: Inside,
    /// Of each corner [m].
    displacements: [Vec3; 3],
    /// How deep the centroid of what is inside is [m].
    depth: f64,
}

impl ImposedContact {
    /// `period` [s] is that of the world.
    ///
    /// # Errors
    /// The shape has no parts, the surface no triangle of area, or a number does not fit.
    pub fn new(
        name: impl Into<String>,
        touched: ToolSurface,
        shape: Box<dyn Shape>,
        motion: RigidMotion,
        law: ImposedLaw,
        period: f64,
    ) -> Result<Self, LoadError> {
        Self::led(name.into(), touched, shape, Leading::Motion(motion), law, period)
    }

    /// The same with a tool that is carried about.
    ///
    /// # Errors
    /// As of [`ImposedContact::new`].
    pub fn carried(
        name: impl Into<String>,
        touched: ToolSurface,
        shape: Box<dyn Shape>,
        carrier: Box<dyn Carrier>,
        law: ImposedLaw,
        period: f64,
    ) -> Result<Self, LoadError> {
        Self::led(name.into(), touched, shape, Leading::Carrier(carrier), law, period)
    }

    fn led(
        name: String,
        ToolSurface { surface, rows }: ToolSurface,
        shape: Box<dyn Shape>,
        leading: Leading,
        law: ImposedLaw,
        period: f64,
    ) -> Result<Self, LoadError> {
        if !is_fraction(law.fraction) {
            let field = "fraction".to_owned();
            return Err(LoadError::Unfit { field, value: law.fraction, expected: A_FRACTION });
        }
        not_negative("residual", law.residual)?;
        not_negative("period", period)?;
        if law.residual >= least_radius(shape.as_ref()) {
            let (field, value) = ("residual".to_owned(), law.residual);
            return Err(LoadError::Unfit { field, value, expected: WITHIN_PARTS });
        }
        if shape.parts().is_empty() {
            return Err(LoadError::Empty { field: "shape", expected: "rounded part of a tool" });
        }
        let openings = Openings::new(&surface, &rows);
        let surface = surface.surface;
        let triangles = 0..surface.triangles.len() as u32;
        if triangles.clone().map(|triangle| surface.area_vector(triangle).length()).sum::<f64>() <= 0.0 {
            return Err(LoadError::Empty { field: "triangles", expected: "triangle of an area" });
        }
        let boxes: Vec<Aabb> = triangles.map(|triangle| Aabb::of(surface.corners(triangle))).collect();
        let row_of = |point: &u32| rows[*point as usize];
        let mut all: Vec<u32> = surface.triangles.iter().flatten().map(row_of).collect();
        all.sort_unstable();
        all.dedup();
        let number = |point: u32| all.partition_point(|row| *row < rows[point as usize]) as u32;
        Ok(Self {
            shape_name: name.clone(),
            name,
            shape,
            leading,
            law,
            corners: surface.triangles.iter().map(|corners| corners.map(number)).collect(),
            rows: all,
            tree: AabbTree::build(&boxes),
            openings,
            period,
        })
    }

    /// With the name of the shape, by which one that several bodies touch is known as one.
    pub fn against(self, shape_name: impl Into<String>) -> Self {
        Self { shape_name: shape_name.into(), ..self }
    }

    pub fn law(&self) -> &ImposedLaw {
        &self.law
    }

    fn first_node(&self) -> usize {
        HEAD + self.leading.memory_len()
    }

    /// What carries the tool remembers this.
    fn own<'a>(&self, memory: &'a [f64]) -> &'a [f64] {
        &memory[HEAD..self.first_node()]
    }

    fn node(&self, memory: &[f64], number: usize) -> Node {
        Node::read(&memory[self.first_node() + NODE * number..][..NODE])
    }

    fn write_node(&self, memory: &mut [f64], number: usize, node: &Node) {
        let first = self.first_node() + NODE * number;
        node.write(&mut memory[first..first + NODE]);
    }

    fn nodes<'a>(&'a self, memory: &'a [f64]) -> impl Iterator<Item = (u32, Node)> + 'a {
        self.rows.iter().enumerate().map(|(number, row)| (*row, self.node(memory, number)))
    }

    /// What is felt [N]: of the body on the tool.
    pub fn force(memory: &[f64]) -> Vec3 {
        Self::vector(memory, 0)
    }

    fn vector(memory: &[f64], at: usize) -> Vec3 {
        Vec3::new(memory[at], memory[at + 1], memory[at + 2])
    }

    fn places(&self, triangle: usize, at: &Configuration) -> [Vec3; 3] {
        self.corners[triangle].map(|number| at.positions[self.rows[number as usize] as usize])
    }

    /// A triangle against a part of the tool; `None` where it does not touch, faces away, or is let go.
    fn touch(&self, triangle: usize, part: &Capsule, pose: &Pose, at: &Configuration) -> Option<Touch> {
        let world = self.places(triangle, at);
        let places = world.map(|place| pose.to_shape(place));
        let [a, b, c] = places;
        let normal = (b - a).cross(c - a).try_normalised()?;
        let nearest = closest_segment_triangle([part.from, part.to], places);
        let core = part.from + (part.to - part.from) * nearest.along;
        if nearest.distance_sq >= part.radius * part.radius || (core - a).dot(normal) <= 0.0 {
            return None;
        }
        let inside = inside(part, places, nearest.weights)?;
        let weights = inside.weights();
        let centroid = a * weights[0] + b * weights[1] + c * weights[2];
        let depth = part.way_out(centroid, -normal);
        let outward = pose.direction_to_world(normal);
        // what the body presses with there
        let pressing: f64 = self.corners[triangle]
            .iter()
            .zip(weights)
            .map(|(number, weight)| weight * self.node(at.memory, *number as usize).force.dot(outward))
            .sum();
        let place = world[0] * weights[0] + world[1] * weights[1] + world[2] * weights[2];
        let leaving = pose.velocity + pose.angular_velocity.cross(place - pose.origin);
        let is_leaving = leaving.dot(outward) > 0.0;
        if is_leaving && pressing < 0.0 {
            return None;
        }
        // it comes after a tool that goes, as far as it still presses
        let way = self.law.fraction * (depth - self.law.residual);
        let way = if is_leaving && pressing > 0.0 { way } else { way.max(0.0) };
        // δ_k = b_k D / Σ b²: the centroid itself goes by D
        let squares: f64 = weights.iter().map(|weight| weight * weight).sum();
        let displacements = weights.map(|weight| outward * (-way * weight / squares));
        Some(Touch { inside, displacements, depth })
    }
}

impl Holding for ImposedContact {
    fn rows(&self) -> &[u32] {
        &self.rows
    }

    fn look(&self, at: &Configuration, scratch: &mut Scratch, memory: &mut [f64]) {
        let pose = self.leading.pose(at.time, self.own(at.memory));
        let Search { tree, found, weights } = search(scratch);
        let is_there = |triangle: usize| self.openings.has(triangle, at.time);
        tree.refit((0..self.corners.len()).map(|triangle| {
            // what is not there has no box that anything could overlap
            let places = is_there(triangle).then(|| self.places(triangle, at));
            places.map_or(Aabb::EMPTY, Aabb::of)
        }));
        weights.fill(0.0);
        (memory[JUMP], memory[IS_MADE]) = (0.0, 0.0);
        for number in 0..self.rows.len() {
            let force = self.node(at.memory, number).force;
            self.write_node(memory, number, &Node { force, ..Node::default() });
        }
        for (triangle, corners) in self.corners.iter().enumerate().filter(|(triangle, _)| is_there(*triangle))
        {
            let [a, b, c] = self.places(triangle, at);
            let third = (b - a).cross(c - a).length() / 6.0;
            for number in corners {
                let node = Node::read(&memory[self.first_node() + NODE * *number as usize..][..NODE]);
                self.write_node(memory, *number as usize, &Node { area: node.area + third, ..node });
            }
        }
        let parts = self.shape.parts();
        found.clear();
        for (number, part) in parts.iter().enumerate() {
            let ends = [part.from, part.to].map(|end| pose.to_world(end));
            tree.overlapping(Aabb::of(ends).grown(part.radius), |triangle| {
                found.push((triangle, number as u32));
            });
        }
        found.sort_unstable();
        for of_triangle in found.chunk_by(|(a, _), (b, _)| a == b) {
            let triangle = of_triangle[0].0 as usize;
            let touches = of_triangle
                .iter()
                .filter_map(|(_, part)| self.touch(triangle, &parts[*part as usize], &pose, at));
            // where parts overlap, as jaws do at their hinge, they touch the same area: it counts once
            let widest = touches.reduce(|a, b| if b.inside.area > a.inside.area { b } else { a });
            let Some(touch) = widest else { continue };
            for (k, number) in self.corners[triangle].iter().enumerate() {
                let number = *number as usize;
                let mut node = self.node(memory, number);
                // a mean over triangles, by what is in touch of each: one that comes to it adds no jump
                let weight = match self.law.felt {
                    Felt::Area => touch.inside.shares[k],
                    Felt::Sum => 1.0,
                };
                node.displacement += touch.displacements[k] * weight;
                weights[number] += weight;
                node.contact_area += touch.inside.shares[k];
                node.depth = node.depth.max(touch.depth);
                node.is_held = true;
                self.write_node(memory, number, &node);
            }
        }
        for (number, weight) in weights.iter().enumerate() {
            let mut node = self.node(memory, number);
            if *weight > 0.0 {
                node.displacement = node.displacement / *weight;
            }
            if !node.is_held {
                node.force = Vec3::ZERO;
            }
            self.write_node(memory, number, &node);
        }
    }

    /// What points bear is what they bore last.
    fn take_look(&self, looked: &[f64], memory: &mut [f64]) {
        (memory[JUMP], memory[IS_MADE]) = (0.0, 0.0);
        for number in 0..self.rows.len() {
            let node = self.node(looked, number);
            let force = if node.is_held { self.node(memory, number).force } else { Vec3::ZERO };
            self.write_node(memory, number, &Node { force, ..node });
        }
    }

    fn visit_told(&self, memory: &[f64], visit: &mut dyn FnMut(&Told)) {
        for (row, Node { displacement, contact_area, area, is_held, .. }) in self.nodes(memory) {
            visit(&Told { row, displacement, contact_area, area, is_held });
        }
    }

    fn pace(&self, timestep: f64, memory: &[f64]) -> f64 {
        match self.law.displacing {
            Displacing::Progressively => 1.0 / self.period,
            Displacing::AtOnce if memory[IS_MADE] == 0.0 => 1.0 / timestep,
            Displacing::AtOnce => 0.0,
        }
    }

    fn felt(&self) -> Felt {
        self.law.felt
    }

    fn feel(&self, felt: Vec3, borne: Vec3, memory: &mut [f64]) {
        let before = Self::force(memory);
        let larger = felt.length().max(before.length());
        if larger > 0.0 {
            memory[JUMP] = memory[JUMP].max((felt - before).length() / larger);
        }
        memory[..3].copy_from_slice(&felt.to_array());
        memory[BORNE..HEAD].copy_from_slice(&borne.to_array());
    }

    fn note_forces(&self, forces: &[Vec3], memory: &mut [f64]) {
        for (number, row) in self.rows.iter().enumerate() {
            let node = self.node(memory, number);
            if node.is_held {
                self.write_node(memory, number, &Node { force: forces[*row as usize], ..node });
            }
        }
    }

    fn jump(&self, memory: &[f64]) -> f64 {
        memory[JUMP]
    }
}

impl Force for ImposedContact {
    fn name(&self) -> &str {
        &self.name
    }

    /// No force at all: the points are moved.
    fn declaration(&self) -> Declaration {
        Declaration { conservative: false, velocity_terms: false, ..Declaration::LOAD }
    }

    fn memory_len(&self) -> usize {
        self.first_node() + NODE * self.rows.len()
    }

    fn tangent_reads_memory(&self) -> bool {
        false
    }

    fn initial_memory(&self, memory: &mut [f64]) {
        memory.fill(0.0);
        let own = HEAD..self.first_node();
        self.leading.begin(&mut memory[own]);
    }

    fn new_scratch(&self) -> Scratch {
        let weights = vec![0.0; self.rows.len()];
        Box::new(Search { tree: self.tree.clone(), found: Vec::new(), weights })
    }

    fn energy(&self, _: &Configuration, _: &mut Scratch) -> Energy {
        Energy::default()
    }

    fn add_force(&self, _: &Configuration, _: &mut Scratch, _: &mut [Vec3]) {}

    fn add_differential(
        &self,
        _: &Configuration,
        _: TangentWeights,
        _: &[Vec3],
        _: &mut Scratch,
        _: &mut [Vec3],
    ) {
    }

    fn visit_cliques(&self, _: &[Pair], _: &mut dyn FnMut(&[u32])) {}

    fn add_blocks(&self, _: &Configuration, _: TangentWeights, _: &mut Scratch, _: &mut BlockMatrix) {}

    fn advance_memory(&self, at: &Configuration, timestep: f64, memory: &mut [f64], _: &mut [Pair]) {
        memory[IS_MADE] = 1.0;
        if let Leading::Carrier(carrier) = &self.leading {
            let own = HEAD..self.first_node();
            carrier.advance_held(Self::force(at.memory), at.time, timestep, &mut memory[own]);
        }
    }

    fn editable(&self) -> Vec<Editable> {
        let mut all = vec![
            Editable { name: "fraction", unit: "", value: self.law.fraction },
            Editable { name: "residual", unit: "m", value: self.law.residual },
        ];
        all.extend(self.leading.editable());
        all
    }

    fn set_parameter(&mut self, name: &str, value: f64) -> Result<(), ParameterError> {
        if let Some(carrier) = self.leading.owner_of(name) {
            return carrier.set_parameter(&self.name, name, value);
        }
        let (force, name) = (self.name.clone(), name.to_owned());
        let known = self.editable().iter().map(|editable| editable.name.to_owned()).collect();
        let least = least_radius(self.shape.as_ref());
        let (number, is_fit, expected) = match name.as_str() {
            "fraction" => (&mut self.law.fraction, is_fraction(value), A_FRACTION.to_owned()),
            "residual" => {
                let expected = format!("at least 0, and less than the least radius of the tool, {least} m");
                (&mut self.law.residual, (0.0..least).contains(&value), expected)
            }
            _ => return Err(ParameterError::Unknown { force, name, known }),
        };
        if !is_fit {
            return Err(ParameterError::Unfit { force, name, value, expected });
        }
        *number = value;
        Ok(())
    }

    fn bytes(&self) -> usize {
        12 * self.corners.capacity() + 4 * self.rows.capacity() + self.openings.bytes() + self.tree.bytes()
    }

    fn scratch_bytes(&self, scratch: &Scratch) -> usize {
        scratch.downcast_ref::<Search>().map_or(0, |search| {
            search.tree.bytes() + 8 * search.found.capacity() + 8 * search.weights.capacity()
        })
    }

    /// What is felt, shared out over the contact; evenly where that has no area.
    fn visit_contacts(&self, at: &Configuration, visit: &mut dyn FnMut(&ContactPoint)) {
        // the body bears it, whatever part is felt
        let force = -Self::vector(at.memory, BORNE);
        let held = || self.nodes(at.memory).filter(|(_, node)| node.is_held);
        let (area, count) =
            held().fold((0.0, 0.0), |(area, count), (_, node)| (area + node.contact_area, count + 1.0));
        for (row, node) in held() {
            let share = if area > 0.0 { node.contact_area / area } else { 1.0 / count };
            visit(&ContactPoint {
                row,
                against: &[],
                penetration: node.depth,
                normal_force: force * share,
                friction: Vec3::ZERO,
            });
        }
    }

    fn holding(&self) -> Option<&dyn Holding> {
        Some(self)
    }

    fn lead(&mut self, place: Vec3) {
        self.leading.lead(place);
    }

    fn in_hand(&self, at: &Configuration) -> Option<InHand> {
        let in_hand = self.leading.in_hand(self.own(at.memory))?;
        Some(InHand { felt: Self::force(at.memory), ..in_hand })
    }

    fn obstacle(&self) -> Option<Obstacle> {
        self.leading.obstacle(self.shape.as_ref(), &self.shape_name)
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}
