//! What forces have in common that keep gaps open: steps find how they push, and memory and pairs have it.

use std::any::Any;

use souple_engine::unilateral::MOST_SIDES;
use souple_engine::{
    Configuration, ContactPoint, Declaration, Energy, Force, LinkShown, Obstacle, Pair, Scratch,
    TangentWeights, Unilateral,
};
use souple_math::Vec3;
use souple_solve::BlockMatrix;

/// What of such a force is its own.
pub trait Apart: Unilateral + 'static {
    /// See [`Force::name`].
    fn name(&self) -> &str;

    /// Whether what it does to points has neither a sum nor a torque.
    fn is_internal(&self) -> bool;

    /// Whether its contacts are the pairs that it finds, and not always the same.
    fn has_pairs(&self) -> bool;

    /// Numbers of memory, the first of which is the work of its forces [J].
    fn memory_len(&self) -> usize {
        1
    }

    /// See [`Force::visit_cliques`].
    fn visit_cliques(&self, pairs: &[Pair], visit: &mut dyn FnMut(&[u32]));

    /// See [`Force::visit_links`].
    fn visit_links(&self, _at: &Configuration, _visit: &mut dyn FnMut(&LinkShown)) {}

    /// See [`Force::obstacle`].
    fn obstacle(&self) -> Option<Obstacle> {
        None
    }

    /// See [`Force::new_scratch`].
    fn new_scratch(&self) -> Scratch {
        Box::new(())
    }

    /// See [`Force::find_pairs`].
    fn find_pairs(&self, _at: &Configuration, _scratch: &mut Scratch, _found: &mut Vec<Pair>) {}

    /// See [`Force::pairs_are_stale`].
    fn pairs_are_stale(&self, _searched: &[Vec3], _now: &Configuration, _scratch: &Scratch) -> bool {
        false
    }

    /// See [`Force::recall_search`].
    fn recall_search(&self, _searched: &Configuration, _scratch: &mut Scratch) {}

    /// See [`Force::accepts_pair`].
    fn accepts_pair(&self, _pair: &Pair) -> bool {
        false
    }

    /// See [`Force::scratch_bytes`].
    fn scratch_bytes(&self, _scratch: &Scratch) -> usize {
        0
    }

    /// See [`Force::bytes`].
    fn bytes(&self) -> usize;
}

/// A force that keeps gaps open, and does nothing else.
#[derive(Debug)]
pub struct Parting<A>(pub A);

impl<A: Apart> Force for Parting<A> {
    fn name(&self) -> &str {
        self.0.name()
    }

    fn declaration(&self) -> Declaration {
        Declaration {
            conservative: false,
            velocity_terms: false,
            symmetric_tangent: true,
            internal: self.0.is_internal(),
            changing_pattern: self.0.has_pairs(),
        }
    }

    fn memory_len(&self) -> usize {
        self.0.memory_len()
    }

    fn tangent_reads_memory(&self) -> bool {
        false
    }

    fn new_scratch(&self) -> Scratch {
        self.0.new_scratch()
    }

    // what collisions and friction take, less what moving walls give
    fn energy(&self, at: &Configuration, _scratch: &mut Scratch) -> Energy {
        Energy { stored: 0.0, dissipated: -at.memory[0] }
    }

    // as steps found it last
    fn add_force(&self, at: &Configuration, _scratch: &mut Scratch, out: &mut [Vec3]) {
        for contact in 0..self.0.contact_count(at.pairs) {
            let force = self.0.force(contact, at.memory, at.pairs);
            if force != Vec3::ZERO {
                for (row, weight) in self.0.sides(contact, at.pairs, at.positions).iter() {
                    out[row] += force * weight;
                }
            }
        }
    }

    // what steps solve for is no function of places
    fn add_differential(
        &self,
        _at: &Configuration,
        _weights: TangentWeights,
        _delta: &[Vec3],
        _scratch: &mut Scratch,
        _out: &mut [Vec3],
    ) {
    }

    fn visit_cliques(&self, pairs: &[Pair], visit: &mut dyn FnMut(&[u32])) {
        self.0.visit_cliques(pairs, visit);
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
        Some(&self.0)
    }

    fn find_pairs(&self, at: &Configuration, scratch: &mut Scratch, found: &mut Vec<Pair>) {
        self.0.find_pairs(at, scratch, found);
    }

    fn pairs_are_stale(&self, searched: &[Vec3], now: &Configuration, scratch: &Scratch) -> bool {
        self.0.pairs_are_stale(searched, now, scratch)
    }

    fn recall_search(&self, searched: &Configuration, scratch: &mut Scratch) {
        self.0.recall_search(searched, scratch);
    }

    fn accepts_pair(&self, pair: &Pair) -> bool {
        self.0.accepts_pair(pair)
    }

    fn visit_contacts(&self, at: &Configuration, visit: &mut dyn FnMut(&ContactPoint)) {
        visit_contacts(&self.0, at, visit);
    }

    fn visit_links(&self, at: &Configuration, visit: &mut dyn FnMut(&LinkShown)) {
        self.0.visit_links(at, visit);
    }

    fn obstacle(&self) -> Option<Obstacle> {
        self.0.obstacle()
    }

    fn bytes(&self) -> usize {
        self.0.bytes()
    }

    fn scratch_bytes(&self, scratch: &Scratch) -> usize {
        self.0.scratch_bytes(scratch)
    }

    fn as_any(&self) -> &dyn Any {
        &self.0
    }
}

/// Contacts that press, as the forces that were found last and the rows as they stand have them.
fn visit_contacts(of: &dyn Unilateral, at: &Configuration, visit: &mut dyn FnMut(&ContactPoint)) {
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
