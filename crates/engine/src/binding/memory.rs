//! What the memory of a force holds of its relations.

use souple_math::Vec3;

/// In the memory of a force, what the numbers of its relations beside the multipliers are; zero where no step came before.
pub(super) mod known {
    /// Values where the step before started.
    pub const VALUES: f64 = 1.0;
    /// Rates of the start, before a trajectory moved the velocity.
    pub const RATES: f64 = 2.0;
}

/// Numbers in the memory of a force with so many relations: the work that it has done [J], the multipliers, what is known of before, and that
/// of each relation.
pub fn memory_len(relations: usize) -> usize {
    2 + 6 * relations
}

/// The same where relations yield: with how far each has flowed from what it was told.
pub fn yielding_memory_len(relations: usize) -> usize {
    memory_len(relations) + relations
}

/// Where what is known of before stands, of so many relations.
pub(super) fn known_at(relations: usize) -> usize {
    1 + 3 * relations
}

/// What is known of a relation from before: values or rates.
pub(super) fn earlier(memory: &[f64], relations: usize, relation: usize) -> Vec3 {
    let first = known_at(relations) + 1 + 3 * relation;
    Vec3::new(memory[first], memory[first + 1], memory[first + 2])
}

/// How far a relation has flowed; not at all where none yields.
pub(super) fn flow(memory: &[f64], relations: usize, relation: usize) -> f64 {
    memory.get(memory_len(relations) + relation).copied().unwrap_or(0.0)
}

pub(super) fn set_earlier(memory: &mut [f64], (relations, relation): (usize, usize), kind: f64, value: Vec3) {
    let at = known_at(relations);
    memory[at] = kind;
    memory[at + 1 + 3 * relation..at + 4 + 3 * relation].copy_from_slice(&value.to_array());
}

/// The multipliers of a relation, by the memory of its force.
pub fn multiplier(memory: &[f64], relation: usize) -> Vec3 {
    let first = 1 + 3 * relation;
    Vec3::new(memory[first], memory[first + 1], memory[first + 2])
}

/// Sets [`multiplier`].
pub fn set_multiplier(memory: &mut [f64], relation: usize, multiplier: Vec3) {
    let first = 1 + 3 * relation;
    memory[first..first + 3].copy_from_slice(&multiplier.to_array());
}
