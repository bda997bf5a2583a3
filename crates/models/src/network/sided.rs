//! Constraints with a sense: relations that hold from one side alone, as walls, floors and strings do.
//!
//! A rod of which masses come no nearer than its length is what two balls do, one that they come no farther than is a string; a plane or
//! a surface keeps masses on one side. The forces, impulses where masses collide, are found by the step ([`souple_engine::unilateral`]).

use std::any::Any;

use souple_engine::unilateral::MOST_SIDES;
use souple_engine::{
    Configuration, ContactPoint, Declaration, Energy, Force, ImpactLaw, LinkShown, LinkState, Pair, Scratch,
    Sides, TangentWeights, Unilateral,
};
use souple_math::Vec3;
use souple_solve::BlockMatrix;

use super::relations::Relation;

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
}

impl SidedConstraints {
    pub fn new(name: impl Into<String>, relations: Vec<Box<dyn Relation>>, sided: Sided) -> Self {
        Self { name: name.into(), relations, sided }
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

impl Force for SidedConstraints {
    fn name(&self) -> &str {
        &self.name
    }

    fn declaration(&self) -> Declaration {
        Declaration {
            conservative: false,
            velocity_terms: false,
            symmetric_tangent: true,
            internal: false,
            changing_pattern: false,
        }
    }

    fn memory_len(&self) -> usize {
        1 + OF_EACH * self.relations.len()
    }

    fn tangent_reads_memory(&self) -> bool {
        false
    }

    // what collisions and friction take, less what moving walls give
    fn energy(&self, at: &Configuration, _scratch: &mut Scratch) -> Energy {
        Energy { stored: 0.0, dissipated: -at.memory[0] }
    }

    fn add_force(&self, at: &Configuration, _scratch: &mut Scratch, out: &mut [Vec3]) {
        for contact in 0..self.relations.len() {
            let force = Unilateral::force(self, contact, at.memory, at.pairs);
            for (row, weight) in self.sides(contact, at.pairs, at.positions).iter() {
                out[row] += force * weight;
            }
        }
    }

    fn add_differential(
        &self,
        _at: &Configuration,
        _weights: TangentWeights,
        _delta: &[Vec3],
        _scratch: &mut Scratch,
        _out: &mut [Vec3],
    ) {
    }

    fn visit_cliques(&self, _pairs: &[Pair], visit: &mut dyn FnMut(&[u32])) {
        self.relations.iter().for_each(|relation| visit(relation.rows()));
    }

    fn add_blocks(
        &self,
        _at: &Configuration,
        _weights: TangentWeights,
        _scratch: &mut Scratch,
        _matrix: &mut BlockMatrix,
    ) {
    }

    fn unilateral(&self) -> Option<&dyn Unilateral> {
        Some(self)
    }

    fn visit_contacts(&self, at: &Configuration, visit: &mut dyn FnMut(&ContactPoint)) {
        visit_contacts(self, at, visit);
    }

    fn visit_links(&self, at: &Configuration, visit: &mut dyn FnMut(&LinkShown)) {
        // what keeps masses apart is no link: nothing is between them
        if self.sided.sense == Sense::AtLeast {
            return;
        }
        for (index, relation) in self.relations.iter().enumerate() {
            let Some(ends) = relation.ends() else { continue };
            let along = relation.slope(at.positions, at.time).unwrap_or(Vec3::ZERO);
            let push = Unilateral::force(self, index, at.memory, at.pairs).dot(along);
            visit(&LinkShown { ends, state: LinkState::In(0), push });
        }
    }

    fn bytes(&self) -> usize {
        self.relations.iter().map(|relation| size_of_val(&**relation) + 4 * relation.rows().len()).sum()
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}

/// Contacts that press, as the forces that were found last and the rows as they stand have them.
pub(super) fn visit_contacts(of: &dyn Unilateral, at: &Configuration, visit: &mut dyn FnMut(&ContactPoint)) {
    for contact in 0..of.contact_count(at.pairs) {
        let force = of.force(contact, at.memory, at.pairs);
        let slope = of.slope(contact, at.pairs, at.positions, at.time);
        let Some(normal) = slope.try_normalised().filter(|_| force != Vec3::ZERO) else { continue };
        let normal_force = normal * normal.dot(force);
        let gap = of.gap(contact, at.pairs, at.positions, at.time) / slope.length();
        let sides = of.sides(contact, at.pairs, at.positions);
        let mut against = [(0, 0.0); MOST_SIDES];
        let mut count = 0;
        for (row, share) in sides.second() {
            against[count] = (row as u32, share);
            count += 1;
        }
        for (row, share) in sides.first() {
            visit(&ContactPoint {
                row: row as u32,
                against: &against[..count],
                penetration: (-gap).max(0.0),
                normal_force: normal_force * share,
                friction: (force - normal_force) * share,
            });
        }
    }
}
