//! Constraints with a sense: relations that hold from one side alone, as walls, floors and strings do.
//!
//! A rod of which masses come no nearer than its length is what two balls do, one that they come no farther than is a string; a plane or
//! a surface keeps masses on one side. The forces, impulses where masses collide, are found by the step ([`souple_engine::unilateral`]).

use std::sync::Arc;

use souple_engine::obstacle::Form;
use souple_engine::{
    Configuration, ImpactLaw, LinkShown, LinkState, Motion, Obstacle, Pair, Sides, Unilateral,
};
use souple_math::Vec3;

use super::parting::Apart;
use super::relations::Relation;
use crate::loads::RigidMotion;

/// From which side a relation `g` holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sense {
    /// `g ≥ 0`.
    AtLeast,
    /// `g ≤ 0`.
    AtMost,
}

impl Sense {
    fn sign(self) -> f64 {
        match self {
            Self::AtLeast => 1.0,
            Self::AtMost => -1.0,
        }
    }
}

/// How far from a relation masses stay, on which side, and how they meet it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sided {
    pub sense: Sense,
    /// Of the balls that masses are the centres of [m]; in the unit of its formula for a surface.
    pub radius: f64,
    pub law: ImpactLaw,
}

/// Numbers of memory of each relation: the force on its mass, or on the first of two [N].
const OF_EACH: usize = 3;

/// Relations of one kind that hold from one side.
#[derive(Debug)]
pub struct SidedConstraints {
    name: String,
    /// All have a [`Relation::slope`].
    relations: Vec<Box<dyn Relation>>,
    sided: Sided,
    /// The wall that all of its masses are kept from, for pictures.
    wall: Option<Obstacle>,
}

impl SidedConstraints {
    pub fn new(name: impl Into<String>, relations: Vec<Box<dyn Relation>>, sided: Sided) -> Self {
        Self { name: name.into(), relations, sided, wall: None }
    }

    /// One plane for all of its masses, to be drawn.
    ///
    /// # Parameters
    /// - `normal`: of length 1, to the side where relations are positive.
    pub fn drawn_as_plane(mut self, point: Vec3, normal: Vec3, motion: Option<Arc<dyn Motion>>) -> Self {
        let free = normal * self.sided.sense.sign();
        let motion = motion.unwrap_or_else(|| Arc::new(RigidMotion::default()));
        self.wall =
            Some(Obstacle { name: self.name.clone(), form: Form::Plane { point, normal: free }, motion });
        self
    }

    pub fn relations(&self) -> &[Box<dyn Relation>] {
        &self.relations
    }

    /// How far a relation is from where it holds its masses [m], or in the unit of its formula; negative beyond.
    pub fn gap_of(&self, relation: usize, positions: &[Vec3], time: f64) -> f64 {
        self.sided.sense.sign() * self.relations[relation].value(positions, time).x - self.sided.radius
    }
}

impl Unilateral for SidedConstraints {
    fn contact_count(&self, _pairs: &[Pair]) -> usize {
        self.relations.len()
    }

    fn sides(&self, contact: usize, _pairs: &[Pair], _positions: &[Vec3]) -> Sides {
        match self.relations[contact].rows() {
            [row] => Sides::one(*row),
            [a, b, ..] => Sides::two([*a, *b]),
            [] => unreachable!("relations are of rows"),
        }
    }

    fn gap(&self, contact: usize, _pairs: &[Pair], positions: &[Vec3], time: f64) -> f64 {
        self.gap_of(contact, positions, time)
    }

    fn slope(&self, contact: usize, _pairs: &[Pair], positions: &[Vec3], time: f64) -> Vec3 {
        let slope = self.relations[contact].slope(positions, time).unwrap_or(Vec3::ZERO);
        slope * self.sided.sense.sign()
    }

    fn surface_velocity(&self, contact: usize, time: f64) -> Vec3 {
        self.relations[contact].surface_velocity(time)
    }

    fn law(&self) -> ImpactLaw {
        self.sided.law
    }

    fn force(&self, contact: usize, memory: &[f64], _pairs: &[Pair]) -> Vec3 {
        let first = 1 + OF_EACH * contact;
        Vec3::new(memory[first], memory[first + 1], memory[first + 2])
    }

    fn set_force(&self, contact: usize, memory: &mut [f64], _pairs: &mut [Pair], force: Vec3) {
        let first = 1 + OF_EACH * contact;
        memory[first..first + OF_EACH].copy_from_slice(&force.to_array());
    }

    fn describe(&self, contact: usize, _pairs: &[Pair]) -> String {
        let side = match self.sided.sense {
            Sense::AtLeast => "at least",
            Sense::AtMost => "at most",
        };
        format!("{} (number {contact}, {side})", self.relations[contact].describe())
    }
}

impl Apart for SidedConstraints {
    fn name(&self) -> &str {
        &self.name
    }

    fn is_internal(&self) -> bool {
        false
    }

    fn has_pairs(&self) -> bool {
        false
    }

    fn memory_len(&self) -> usize {
        1 + OF_EACH * self.relations.len()
    }

    fn obstacle(&self) -> Option<Obstacle> {
        self.wall.clone()
    }

    fn visit_cliques(&self, _pairs: &[Pair], visit: &mut dyn FnMut(&[u32])) {
        self.relations.iter().for_each(|relation| visit(relation.rows()));
    }

    fn visit_links(&self, at: &Configuration, visit: &mut dyn FnMut(&LinkShown)) {
        // what keeps masses apart is no link: nothing is between them
        if self.sided.sense == Sense::AtLeast {
            return;
        }
        for (index, relation) in self.relations.iter().enumerate() {
            let Some(ends) = relation.ends() else { continue };
            let along = relation.slope(at.positions, at.time).unwrap_or(Vec3::ZERO);
            let push = self.force(index, at.memory, at.pairs).dot(along);
            visit(&LinkShown { ends, state: LinkState::In(0), push });
        }
    }

    fn bytes(&self) -> usize {
        self.relations.iter().map(|relation| size_of_val(&**relation) + 4 * relation.rows().len()).sum()
    }
}
