//! All that evolves. Whatever is here is saved, hashed, compared and replayed without further work.

use std::fmt;

use souple_math::Vec3;
use souple_solve::reduce;

use crate::detection::Detected;
use crate::kept::Kept;

/// Two things that touch, with what the contact remembers (an anchor, a phase).
#[derive(Clone, Copy, Debug, PartialEq, Default)]
#[repr(C)]
pub struct Pair {
    /// Index of the force in its system.
    pub force: u64,
    pub a: u64,
    pub b: u64,
    pub memory: [f64; 8],
}

// SAFETY: three u64 and eight f64 in declared order without padding; any bits are valid.
unsafe impl bytemuck::Zeroable for Pair {}
// SAFETY: as above.
unsafe impl bytemuck::Pod for Pair {}

impl Pair {
    pub fn new(a: usize, b: usize, memory: [f64; 8]) -> Self {
        Self { force: 0, a: a as u64, b: b as u64, memory }
    }

    pub(crate) fn key(&self) -> (u64, u64, u64) {
        (self.force, self.a, self.b)
    }
}

/// Merges the pairs found now into those remembered: a pair that is still there keeps its memory, a new one
/// starts with the memory it was found with, one that is gone is forgotten. Sorted by `(force, a, b)`.
pub fn merge_pairs(remembered: &mut Vec<Pair>, found: &mut Vec<Pair>) {
    sort_pairs(found);
    let mut known = remembered.iter().peekable();
    for pair in found.iter_mut() {
        let key = pair.key();
        while known.next_if(|known| known.key() < key).is_some() {}
        if let Some(same) = known.next_if(|known| known.key() == key) {
            pair.memory = same.memory;
        }
    }
    std::mem::swap(remembered, found);
}

/// Brings pairs into the order of State, each once.
pub(crate) fn sort_pairs(found: &mut Vec<Pair>) {
    // most forces find them in order
    if !found.is_sorted_by(|a, b| a.key() < b.key()) {
        found.sort_unstable_by_key(Pair::key);
        found.dedup_by_key(|pair| pair.key());
    }
}

/// The pairs of one force among the sorted pairs of its system.
pub fn pairs_of(pairs: &[Pair], force: usize) -> std::ops::Range<usize> {
    let force = force as u64;
    pairs.partition_point(|pair| pair.force < force)..pairs.partition_point(|pair| pair.force <= force)
}

/// The evolving part of one system.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SystemState {
    /// Configuration: free rows of the unknowns [m]; axes of frames are pure numbers.
    pub q: Vec<Vec3>,
    /// Velocity blocks [m/s], angular ones [rad/s].
    pub v: Vec<Vec3>,
    /// Memories of the forces, one after the other.
    pub memory: Vec<f64>,
    pub pairs: Vec<Pair>,
    /// What forces remember of things that come and go without pairs.
    pub kept: Kept,
    /// What the stepper carries from step to step (earlier configurations, warm starts, dates of factors).
    pub history: Vec<f64>,
    /// What was detected beside the last period, for the next.
    pub detected: Detected,
}

/// A field on a grid (a skin, a temperature): values and whatever integers describe its active set.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FieldState {
    pub values: Vec<f64>,
    pub indices: Vec<u64>,
}

/// The world as it stands between two periods.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct State {
    /// World periods since the start.
    pub period: u64,
    pub systems: Vec<SystemState>,
    /// Driven parameters, and what systems exchange (see [`crate::coupling`]).
    pub driven: Vec<f64>,
    pub fields: Vec<FieldState>,
    /// States of random generators.
    pub generators: Vec<u64>,
}

/// The name of a field of State, written out only where it is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FieldName {
    World(&'static str),
    /// Index of the system.
    System(usize, &'static str),
    /// Index of the field.
    Field(usize, &'static str),
}

impl fmt::Display for FieldName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::World(name) => f.write_str(name),
            Self::System(index, name) => write!(f, "systems[{index}].{name}"),
            Self::Field(index, name) => write!(f, "fields[{index}].{name}"),
        }
    }
}

/// The values of one field of State, in place.
#[derive(Debug)]
pub enum FieldRef<'a> {
    Integer(&'a u64),
    Integers(&'a Vec<u64>),
    Numbers(&'a Vec<f64>),
    Vectors(&'a Vec<Vec3>),
    Pairs(&'a Vec<Pair>),
}

/// The same to be written to.
#[derive(Debug)]
pub enum FieldMut<'a> {
    Integer(&'a mut u64),
    Integers(&'a mut Vec<u64>),
    Numbers(&'a mut Vec<f64>),
    Vectors(&'a mut Vec<Vec3>),
    Pairs(&'a mut Vec<Pair>),
}

impl FieldRef<'_> {
    /// The field's bytes, little-endian on every platform Souple runs on.
    pub fn bytes(&self) -> &[u8] {
        match self {
            Self::Integer(value) => bytemuck::bytes_of(*value),
            Self::Integers(values) => bytemuck::cast_slice(values),
            Self::Numbers(values) => bytemuck::cast_slice(values),
            Self::Vectors(values) => bytemuck::cast_slice(values),
            Self::Pairs(values) => bytemuck::cast_slice(values),
        }
    }

    /// Bytes that its list holds, beyond its length too.
    fn capacity(&self) -> usize {
        match self {
            Self::Integer(_) => 0,
            Self::Integers(values) => 8 * values.capacity(),
            Self::Numbers(values) => 8 * values.capacity(),
            Self::Vectors(values) => size_of::<Vec3>() * values.capacity(),
            Self::Pairs(values) => size_of::<Pair>() * values.capacity(),
        }
    }

    /// The field's numbers for comparing two states; integers as numbers.
    pub fn numbers(&self) -> Vec<f64> {
        match self {
            Self::Integer(value) => vec![**value as f64],
            Self::Integers(values) => values.iter().map(|value| *value as f64).collect(),
            Self::Numbers(values) => values.to_vec(),
            Self::Vectors(values) => bytemuck::cast_slice(values).to_vec(),
            Self::Pairs(values) => values.iter().flat_map(|pair| pair.memory).collect(),
        }
    }
}

impl State {
    /// Every field, in the declared order of hashes, snapshots and comparisons; allocates nothing.
    pub fn each_field(&self) -> impl Iterator<Item = (FieldName, FieldRef<'_>)> {
        let systems = self.systems.iter().enumerate().flat_map(|(index, system)| {
            [
                (FieldName::System(index, "q"), FieldRef::Vectors(&system.q)),
                (FieldName::System(index, "v"), FieldRef::Vectors(&system.v)),
                (FieldName::System(index, "memory"), FieldRef::Numbers(&system.memory)),
                (FieldName::System(index, "pairs"), FieldRef::Pairs(&system.pairs)),
                (FieldName::System(index, "kept.counts"), FieldRef::Integers(&system.kept.counts)),
                (FieldName::System(index, "kept.keys"), FieldRef::Integers(&system.kept.keys)),
                (FieldName::System(index, "kept.numbers"), FieldRef::Numbers(&system.kept.numbers)),
                (FieldName::System(index, "history"), FieldRef::Numbers(&system.history)),
                (FieldName::System(index, "detected.pairs"), FieldRef::Pairs(&system.detected.pairs)),
                (
                    FieldName::System(index, "detected.positions"),
                    FieldRef::Vectors(&system.detected.positions),
                ),
                (FieldName::System(index, "detected.numbers"), FieldRef::Numbers(&system.detected.numbers)),
            ]
        });
        let fields = self.fields.iter().enumerate().flat_map(|(index, field)| {
            [
                (FieldName::Field(index, "values"), FieldRef::Numbers(&field.values)),
                (FieldName::Field(index, "indices"), FieldRef::Integers(&field.indices)),
            ]
        });
        let one = |name, field| std::iter::once((FieldName::World(name), field));
        one("period", FieldRef::Integer(&self.period))
            .chain(systems)
            .chain(one("driven", FieldRef::Numbers(&self.driven)))
            .chain(fields)
            .chain(one("generators", FieldRef::Integers(&self.generators)))
    }

    /// [`State::each_field`] with names written out.
    pub fn fields(&self) -> Vec<(String, FieldRef<'_>)> {
        self.each_field().map(|(name, field)| (name.to_string(), field)).collect()
    }

    /// [`State::fields`] to be written to, in the same order.
    pub fn fields_mut(&mut self) -> Vec<FieldMut<'_>> {
        let mut all = vec![FieldMut::Integer(&mut self.period)];
        for system in &mut self.systems {
            all.push(FieldMut::Vectors(&mut system.q));
            all.push(FieldMut::Vectors(&mut system.v));
            all.push(FieldMut::Numbers(&mut system.memory));
            all.push(FieldMut::Pairs(&mut system.pairs));
            all.push(FieldMut::Integers(&mut system.kept.counts));
            all.push(FieldMut::Integers(&mut system.kept.keys));
            all.push(FieldMut::Numbers(&mut system.kept.numbers));
            all.push(FieldMut::Numbers(&mut system.history));
            all.push(FieldMut::Pairs(&mut system.detected.pairs));
            all.push(FieldMut::Vectors(&mut system.detected.positions));
            all.push(FieldMut::Numbers(&mut system.detected.numbers));
        }
        all.push(FieldMut::Numbers(&mut self.driven));
        for field in &mut self.fields {
            all.push(FieldMut::Numbers(&mut field.values));
            all.push(FieldMut::Integers(&mut field.indices));
        }
        all.push(FieldMut::Integers(&mut self.generators));
        all
    }

    /// Copies `other` into the buffers at hand: no allocation while shapes stay.
    pub fn copy_from(&mut self, other: &Self) {
        self.copy_what_stays(other, |_| false);
    }

    /// The same without configuration and velocity of the systems that are `overwritten`.
    pub(crate) fn copy_what_stays(&mut self, other: &Self, overwritten: impl Fn(usize) -> bool) {
        self.period = other.period;
        self.systems.resize_with(other.systems.len(), SystemState::default);
        for (index, (mine, other)) in self.systems.iter_mut().zip(&other.systems).enumerate() {
            for (mine, other) in [(&mut mine.q, &other.q), (&mut mine.v, &other.v)] {
                mine.resize(other.len(), Vec3::ZERO);
                if !overwritten(index) {
                    reduce::copy(mine, other);
                }
            }
            mine.memory.clone_from(&other.memory);
            mine.pairs.clone_from(&other.pairs);
            mine.kept.copy_from(&other.kept);
            mine.history.clone_from(&other.history);
            mine.detected.copy_from(&other.detected);
        }
        self.driven.clone_from(&other.driven);
        self.fields.resize_with(other.fields.len(), FieldState::default);
        for (mine, other) in self.fields.iter_mut().zip(&other.fields) {
            mine.values.clone_from(&other.values);
            mine.indices.clone_from(&other.indices);
        }
        self.generators.clone_from(&other.generators);
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.each_field().map(|(_, field)| field.capacity()).sum()
    }

    /// The first entry that is not finite; allocates nothing where all are.
    pub fn first_not_finite(&self) -> Option<Place> {
        self.first_not_finite_but(|_| false)
    }

    /// The same where configuration and velocity of some systems are known to be finite.
    pub(crate) fn first_not_finite_but(&self, known: impl Fn(usize) -> bool) -> Option<Place> {
        self.each_field().find_map(|(name, field)| {
            if matches!(name, FieldName::System(index, "q" | "v") if known(index)) {
                return None;
            }
            let not_finite = |number: &f64| !number.is_finite();
            let at = match field {
                FieldRef::Numbers(values) => values.iter().position(not_finite),
                FieldRef::Vectors(values) if reduce::all_finite(values) => None,
                FieldRef::Vectors(values) => values.iter().position(|vector| !vector.is_finite()),
                FieldRef::Pairs(pairs) => pairs.iter().position(|pair| pair.memory.iter().any(not_finite)),
                FieldRef::Integer(_) | FieldRef::Integers(_) => None,
            };
            at.map(|index| Place { field: name.to_string(), index })
        })
    }

    /// The system that a place belongs to; `None` for what is of the whole world.
    pub fn system_of(&self, place: &Place) -> Option<usize> {
        (0..self.systems.len()).find(|index| place.field.starts_with(&format!("systems[{index}].")))
    }
}

/// An entry of State: a vector or a number of a field.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// A name of [`State::fields`].
    pub field: String,
    pub index: usize,
}

impl std::fmt::Display for Place {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}[{}]", self.field, self.index)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whatever kind of field is not finite is named with its index, memories of pairs too.
    #[test]
    fn what_is_not_finite_is_named() {
        let finite = State {
            systems: vec![SystemState {
                q: vec![Vec3::X; 2],
                v: vec![Vec3::Y; 2],
                memory: vec![1.0; 3],
                pairs: vec![Pair::default(); 2],
                kept: Kept { counts: vec![1], keys: vec![5], numbers: vec![0.5] },
                history: vec![0.0],
                detected: Detected::default(),
            }],
            driven: vec![0.0; 2],
            fields: vec![FieldState { values: vec![0.0; 2], indices: vec![3] }],
            ..State::default()
        };
        assert_eq!(finite.first_not_finite(), None);
        type Spoil = fn(&mut State);
        let spoils: [(&str, Spoil); 7] = [
            ("systems[0].q[1]", |state| state.systems[0].q[1].z = f64::NAN),
            ("systems[0].v[0]", |state| state.systems[0].v[0].y = f64::INFINITY),
            ("systems[0].memory[2]", |state| state.systems[0].memory[2] = f64::NAN),
            ("systems[0].pairs[1]", |state| state.systems[0].pairs[1].memory[7] = f64::NAN),
            ("systems[0].kept.numbers[0]", |state| state.systems[0].kept.numbers[0] = f64::NAN),
            ("driven[0]", |state| state.driven[0] = f64::NEG_INFINITY),
            ("fields[0].values[1]", |state| state.fields[0].values[1] = f64::NAN),
        ];
        for (name, spoil) in spoils {
            let mut state = finite.clone();
            spoil(&mut state);
            assert_eq!(state.first_not_finite().map(|place| place.to_string()).as_deref(), Some(name));
        }
    }

    /// Names to read and places to write stand in the same order.
    #[test]
    fn fields_to_write_are_those_to_read() {
        let mut state = State {
            systems: vec![SystemState::default(); 2],
            fields: vec![FieldState::default()],
            ..State::default()
        };
        assert_eq!(state.fields().len(), state.fields_mut().len());
        assert_eq!(state.fields()[4].0, "systems[0].pairs");
    }
}
