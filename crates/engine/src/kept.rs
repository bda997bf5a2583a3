//! What forces remember of things that come and go and are too many to remember all of: numbers under keys.
//!
//! A heap of a million balls has millions of neighbours, of which those alone are written down that stick. A force finds
//! what is near by itself; here it finds what it knows of it. Unlike [`crate::state::Pair`] an entry is as short as its
//! force says.

/// Entries of the forces of a system, one force after the other; of each its keys ascend.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Kept {
    /// Entries of each force; forces beyond the end have none.
    pub counts: Vec<u64>,
    pub keys: Vec<u64>,
    /// Of each entry as many as its force says.
    pub numbers: Vec<f64>,
}

/// Entries of one force.
#[derive(Clone, Copy, Debug, Default)]
pub struct KeptRef<'a> {
    pub keys: &'a [u64],
    pub numbers: &'a [f64],
}

impl Kept {
    /// Those of force number `force`, given how many numbers each force keeps of an entry.
    pub fn of_force(&self, force: usize, len: impl Fn(usize) -> usize) -> KeptRef<'_> {
        if self.keys.is_empty() {
            return KeptRef::default();
        }
        let count = |force: usize| self.counts.get(force).map_or(0, |count| *count as usize);
        let (first, number) = (0..force).fold((0, 0), |(first, number), index| {
            (first + count(index), number + count(index) * len(index))
        });
        KeptRef {
            keys: &self.keys[first..first + count(force)],
            numbers: &self.numbers[number..number + count(force) * len(force)],
        }
    }

    /// Leaves nothing, and room for as much as before.
    pub fn clear(&mut self) {
        self.counts.clear();
        self.keys.clear();
        self.numbers.clear();
    }

    /// Room for so many entries more, with so many numbers in all.
    pub fn make_room(&mut self, keys: usize, numbers: usize) {
        make_room(&mut self.keys, keys);
        make_room(&mut self.numbers, numbers);
    }

    pub(crate) fn copy_from(&mut self, other: &Self) {
        self.clear();
        self.make_room(other.keys.len(), other.numbers.len());
        self.counts.clone_from(&other.counts);
        self.keys.clone_from(&other.keys);
        self.numbers.clone_from(&other.numbers);
    }
}

/// Room for `more` entries behind those of a list, and a sixteenth beyond where there was too little: a long list that grows
/// a little every now and then is neither doubled, as lists are by themselves, nor moved each time.
pub fn make_room<T>(list: &mut Vec<T>, more: usize) {
    if list.capacity() - list.len() < more {
        list.reserve_exact(more + (list.len() + more) / 16);
    }
}

/// Where forces were summed last before memories move on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Summed {
    /// At the very configuration and memory: what scratches hold of that sum holds.
    Here,
    Elsewhere,
}
