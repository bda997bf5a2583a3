//! All that evolves. Whatever is here is saved, hashed, compared and replayed without further work.

use souple_math::Vec3;

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

    fn key(&self) -> (u64, u64, u64) {
        (self.force, self.a, self.b)
    }
}

/// Merges the pairs found now into those remembered: a pair that is still there keeps its memory, a new one
/// starts with the memory it was found with, one that is gone is forgotten. Sorted by `(force, a, b)`.
pub fn merge_pairs(remembered: &mut Vec<Pair>, found: &mut Vec<Pair>) {
    found.sort_unstable_by_key(Pair::key);
    found.dedup_by_key(|pair| pair.key());
    for pair in found.iter_mut() {
        if let Ok(at) = remembered.binary_search_by_key(&pair.key(), Pair::key) {
            pair.memory = remembered[at].memory;
        }
    }
    std::mem::swap(remembered, found);
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
    /// What the stepper carries from step to step (earlier configurations, warm starts, dates of factors).
    pub history: Vec<f64>,
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
    /// Every field with its name, in the declared order of hashes, snapshots and comparisons.
    pub fn fields(&self) -> Vec<(String, FieldRef<'_>)> {
        let mut all = vec![("period".to_owned(), FieldRef::Integer(&self.period))];
        for (index, system) in self.systems.iter().enumerate() {
            let name = |field: &str| format!("systems[{index}].{field}");
            all.push((name("q"), FieldRef::Vectors(&system.q)));
            all.push((name("v"), FieldRef::Vectors(&system.v)));
            all.push((name("memory"), FieldRef::Numbers(&system.memory)));
            all.push((name("pairs"), FieldRef::Pairs(&system.pairs)));
            all.push((name("history"), FieldRef::Numbers(&system.history)));
        }
        all.push(("driven".to_owned(), FieldRef::Numbers(&self.driven)));
        for (index, field) in self.fields.iter().enumerate() {
            all.push((format!("fields[{index}].values"), FieldRef::Numbers(&field.values)));
            all.push((format!("fields[{index}].indices"), FieldRef::Integers(&field.indices)));
        }
        all.push(("generators".to_owned(), FieldRef::Integers(&self.generators)));
        all
    }

    /// [`State::fields`] to be written to, in the same order.
    pub fn fields_mut(&mut self) -> Vec<FieldMut<'_>> {
        let mut all = vec![FieldMut::Integer(&mut self.period)];
        for system in &mut self.systems {
            all.push(FieldMut::Vectors(&mut system.q));
            all.push(FieldMut::Vectors(&mut system.v));
            all.push(FieldMut::Numbers(&mut system.memory));
            all.push(FieldMut::Pairs(&mut system.pairs));
            all.push(FieldMut::Numbers(&mut system.history));
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
        self.period = other.period;
        self.systems.resize_with(other.systems.len(), SystemState::default);
        for (mine, other) in self.systems.iter_mut().zip(&other.systems) {
            mine.q.clone_from(&other.q);
            mine.v.clone_from(&other.v);
            mine.memory.clone_from(&other.memory);
            mine.pairs.clone_from(&other.pairs);
            mine.history.clone_from(&other.history);
        }
        self.driven.clone_from(&other.driven);
        self.fields.resize_with(other.fields.len(), FieldState::default);
        for (mine, other) in self.fields.iter_mut().zip(&other.fields) {
            mine.values.clone_from(&other.values);
            mine.indices.clone_from(&other.indices);
        }
        self.generators.clone_from(&other.generators);
    }

    /// The first field that is not finite, as `name[index]`.
    pub fn first_not_finite(&self) -> Option<String> {
        self.fields().into_iter().find_map(|(name, field)| {
            let numbers: &[f64] = match field {
                FieldRef::Numbers(values) => values,
                FieldRef::Vectors(values) => bytemuck::cast_slice(values),
                _ => return None,
            };
            let at = numbers.iter().position(|number| !number.is_finite())?;
            Some(match field {
                FieldRef::Vectors(_) => format!("{name}[{}]", at / 3),
                _ => format!("{name}[{at}]"),
            })
        })
    }
}
