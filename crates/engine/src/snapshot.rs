//! State to bytes and back, bit for bit.

use souple_math::Vec3;

use crate::detection::Detected;
use crate::kept::Kept;
use crate::state::{FieldMut, Pair};
use crate::{FieldState, Model, State, System, SystemState};

const MAGIC: &[u8; 8] = b"SOUPLE03";

/// Bytes that are no snapshot, or not one of this model.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SnapshotError {
    #[error("this is no Souple snapshot: it starts with {found:02x?}, not with `SOUPLE03`")]
    NotASnapshot { found: Vec<u8> },
    #[error("the snapshot is cut off: {needed} bytes are needed at offset {offset}, {available} are there")]
    CutOff { offset: usize, needed: u64, available: usize },
    #[error("the snapshot goes on after its end: {extra} bytes too many")]
    TooLong { extra: usize },
    #[error("the snapshot has {found} {what}, the scene has {expected}; it is of another scene")]
    OtherModel { what: String, found: u64, expected: usize },
    #[error(
        "{field} of the snapshot holds {found}, which does not fit {reader}; it is of another scene or damaged"
    )]
    Unreadable { field: String, found: String, reader: String },
    #[error("{field} of the snapshot is not finite")]
    NotFinite { field: String },
    #[error("a {what} of {bytes} bytes is not a whole number of entries")]
    Ragged { what: &'static str, bytes: u64 },
}

impl State {
    /// The state as bytes: magic, counts, then every field with its length, little-endian.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = MAGIC.to_vec();
        bytes.extend((self.systems.len() as u64).to_le_bytes());
        bytes.extend((self.fields.len() as u64).to_le_bytes());
        for (_, field) in self.each_field() {
            let content = field.bytes();
            bytes.extend((content.len() as u64).to_le_bytes());
            bytes.extend_from_slice(content);
        }
        bytes
    }

    /// # Errors
    /// The bytes are not a complete snapshot.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, SnapshotError> {
        let mut reader = Reader { bytes, offset: 0 };
        let magic = reader.take(8).map_err(|_| SnapshotError::NotASnapshot { found: bytes.to_vec() })?;
        if magic != MAGIC {
            return Err(SnapshotError::NotASnapshot { found: magic.to_vec() });
        }
        let (systems, fields) = (reader.count()?, reader.count()?);
        let mut state = Self {
            systems: vec![SystemState::default(); systems],
            fields: vec![FieldState::default(); fields],
            ..Self::default()
        };
        for field in state.fields_mut() {
            let length = reader.length()?;
            let content = reader.take(length)?;
            match field {
                FieldMut::Integer(value) => *value = one("integer", content)?,
                FieldMut::Integers(values) => *values = entries("list of integers", content)?,
                FieldMut::Numbers(values) => *values = entries("list of numbers", content)?,
                FieldMut::Vectors(values) => *values = entries::<Vec3>("list of vectors", content)?,
                FieldMut::Pairs(values) => *values = entries::<Pair>("list of pairs", content)?,
            }
        }
        match bytes.len() - reader.offset {
            0 => Ok(state),
            extra => Err(SnapshotError::TooLong { extra }),
        }
    }
}

impl Model {
    /// Whether `state` can be stepped by this model; `like` is a state that can.
    ///
    /// # Errors
    /// Names the first count that differs, the first number that is not finite, and what forces, fields and steppers
    /// cannot read.
    pub fn check_state(&self, state: &State, like: &State) -> Result<(), SnapshotError> {
        let differ = |what: &str, found: usize, expected: usize| {
            let error = SnapshotError::OtherModel { what: what.to_owned(), found: found as u64, expected };
            if found == expected { Ok(()) } else { Err(error) }
        };
        differ("systems", state.systems.len(), self.systems.len())?;
        differ("driven parameters", state.driven.len(), like.driven.len())?;
        differ("random generators", state.generators.len(), like.generators.len())?;
        differ("fields", state.fields.len(), like.fields.len())?;
        for (index, (system, state)) in self.systems.iter().zip(&state.systems).enumerate() {
            let (rows, blocks) = (system.kinematics.free_row_count(), system.kinematics.block_count());
            differ(&format!("free rows in system {index}"), state.q.len(), rows)?;
            differ(&format!("velocity blocks in system {index}"), state.v.len(), blocks)?;
            let memory = system.forces.iter().map(|force| force.memory_len()).sum();
            differ(&format!("numbers of memory in system {index}"), state.memory.len(), memory)?;
            check_pairs(index, "pairs", system, &state.pairs)?;
            check_detected(index, system, &state.detected)?;
            check_kept(index, system, &state.kept)?;
            if !system.stepper.accepts_history(system, &state.history) {
                let (field, found) = (format!("systems[{index}].history"), state.history.len());
                return Err(SnapshotError::Unreadable {
                    field,
                    found: format!("{found} numbers"),
                    reader: format!("stepper `{}`", system.stepper.name()),
                });
            }
        }
        for (index, ((field, found), current)) in
            self.fields.iter().zip(&state.fields).zip(&like.fields).enumerate()
        {
            if !field.accepts(found, current) {
                let (values, indices) = (found.values.len(), found.indices.len());
                return Err(SnapshotError::Unreadable {
                    field: format!("fields[{index}]"),
                    found: format!("{values} values and {indices} indices"),
                    reader: format!("{} `{}`", field.kind(), field.name()),
                });
            }
        }
        state
            .first_not_finite()
            .map_or(Ok(()), |place| Err(SnapshotError::NotFinite { field: place.to_string() }))
    }
}

/// Pairs ascend, and each is one that its force could have found.
fn check_pairs(index: usize, name: &str, system: &System, pairs: &[Pair]) -> Result<(), SnapshotError> {
    let unreadable = |at: usize, reader: String| {
        let Pair { force, a, b, .. } = pairs[at];
        let field = format!("systems[{index}].{name}[{at}]");
        SnapshotError::Unreadable { field, found: format!("pair ({force}, {a}, {b})"), reader }
    };
    if let Some(at) = pairs.windows(2).position(|pair| pair[0].key() >= pair[1].key()) {
        return Err(unreadable(at + 1, "a list that ascends".to_owned()));
    }
    for (at, pair) in pairs.iter().enumerate() {
        let force = usize::try_from(pair.force).ok().and_then(|force| system.forces.get(force));
        match force {
            Some(force) if force.accepts_pair(pair) => {}
            Some(force) => return Err(unreadable(at, format!("force `{}`", force.name()))),
            None => return Err(unreadable(at, format!("any of the {} forces", system.forces.len()))),
        }
    }
    Ok(())
}

/// There is as much of what was detected as there are rows and memories, or nothing.
fn check_detected(index: usize, system: &System, detected: &Detected) -> Result<(), SnapshotError> {
    let Detected { pairs, positions, numbers } = detected;
    let differ = |what: &str, found: usize, expected: usize| {
        let what = format!("{what} in system {index}");
        let error = SnapshotError::OtherModel { what, found: found as u64, expected };
        if found == expected { Ok(()) } else { Err(error) }
    };
    check_pairs(index, "detected.pairs", system, pairs)?;
    if !positions.is_empty() {
        differ("rows where it was detected", positions.len(), system.kinematics.row_count())?;
    }
    if !numbers.is_empty() || !positions.is_empty() {
        let memory: usize = system.forces.iter().map(|force| force.memory_len()).sum();
        differ("numbers of what was detected", numbers.len(), 1 + memory)?;
    }
    Ok(())
}

/// Each force has as many entries as numbers for them, with keys that ascend and are its own.
fn check_kept(index: usize, system: &System, kept: &Kept) -> Result<(), SnapshotError> {
    let unreadable = |place: &str, found: String, reader: String| SnapshotError::Unreadable {
        field: format!("systems[{index}].kept{place}"),
        found,
        reader,
    };
    let lens: Vec<usize> = system.forces.iter().map(|force| force.kept_len().unwrap_or(0)).collect();
    let of = |counts: &[u64]| {
        let sums = counts.iter().zip(&lens).try_fold((0_u64, 0_u64), |(keys, numbers), (count, len)| {
            Some((keys.checked_add(*count)?, numbers.checked_add(count.checked_mul(*len as u64)?)?))
        });
        sums.filter(|_| counts.len() <= lens.len())
    };
    if of(&kept.counts) != Some((kept.keys.len() as u64, kept.numbers.len() as u64)) {
        let found = format!("{} keys and {} numbers", kept.keys.len(), kept.numbers.len());
        return Err(unreadable("", found, format!("{} forces by the counts beside them", lens.len())));
    }
    let mut first = 0;
    for (force, count) in system.forces.iter().zip(&kept.counts) {
        let keys = &kept.keys[first..first + *count as usize];
        let is_read = |at: usize| (at == 0 || keys[at - 1] < keys[at]) && force.accepts_key(keys[at]);
        if let Some(at) = (0..keys.len()).find(|at| !is_read(*at)) {
            let (place, reader) = (format!(".keys[{}]", first + at), format!("force `{}`", force.name()));
            return Err(unreadable(&place, format!("key {:#x}", keys[at]), reader));
        }
        first += keys.len();
    }
    Ok(())
}

struct Reader<'a> {
    bytes: &'a [u8],
    offset: usize,
}

impl<'a> Reader<'a> {
    fn take(&mut self, length: u64) -> Result<&'a [u8], SnapshotError> {
        let available = self.bytes.len() - self.offset;
        if length > available as u64 {
            return Err(SnapshotError::CutOff { offset: self.offset, needed: length, available });
        }
        let content = &self.bytes[self.offset..self.offset + length as usize];
        self.offset += length as usize;
        Ok(content)
    }

    fn length(&mut self) -> Result<u64, SnapshotError> {
        one("length", self.take(8)?)
    }

    /// A count of things that each take at least eight bytes, so that a garbled count cannot ask for more
    /// memory than the file is long.
    fn count(&mut self) -> Result<usize, SnapshotError> {
        let count = self.length()?;
        let available = self.bytes.len() - self.offset;
        if count > (available / 8) as u64 {
            let needed = count.saturating_mul(8);
            return Err(SnapshotError::CutOff { offset: self.offset, needed, available });
        }
        Ok(count as usize)
    }
}

fn one(what: &'static str, content: &[u8]) -> Result<u64, SnapshotError> {
    content
        .try_into()
        .map(u64::from_le_bytes)
        .map_err(|_| SnapshotError::Ragged { what, bytes: content.len() as u64 })
}

fn entries<T: bytemuck::Pod>(what: &'static str, content: &[u8]) -> Result<Vec<T>, SnapshotError> {
    if !content.len().is_multiple_of(size_of::<T>()) {
        return Err(SnapshotError::Ragged { what, bytes: content.len() as u64 });
    }
    Ok(bytemuck::allocation::pod_collect_to_vec(content))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn state() -> State {
        let system = SystemState {
            q: vec![Vec3::new(1.0, f64::MIN_POSITIVE, -0.0)],
            v: vec![Vec3::X, Vec3::Y],
            memory: vec![0.1],
            pairs: vec![Pair::new(1, 2, [0.5; 8])],
            kept: Kept { counts: vec![0, 2], keys: vec![3, 5], numbers: vec![0.5; 6] },
            history: vec![],
            detected: Detected {
                pairs: vec![Pair::new(1, 3, [0.25; 8])],
                positions: vec![Vec3::Z],
                numbers: vec![2.0, 0.1],
            },
        };
        let fields = vec![FieldState { values: vec![1.0, 2.0], indices: vec![7] }];
        State { period: 9, systems: vec![system], driven: vec![3.0], fields, generators: vec![u64::MAX] }
    }

    #[test]
    fn bytes_give_back_the_same_bits() {
        let state = state();
        let back = State::from_bytes(&state.to_bytes()).unwrap();
        assert_eq!(back, state);
        assert_eq!(back.hash(), state.hash());
    }

    /// Every truncation and every single flipped byte ends in an error or in a state, never in a panic.
    #[test]
    fn damaged_bytes_are_refused() {
        let bytes = state().to_bytes();
        for length in 0..bytes.len() {
            assert!(State::from_bytes(&bytes[..length]).is_err(), "{length} bytes were accepted");
        }
        for at in 0..bytes.len() {
            let mut damaged = bytes.clone();
            damaged[at] ^= 0x80;
            if let Ok(other) = State::from_bytes(&damaged) {
                assert!(at < 8 || other.hash() != state().hash());
            }
        }
        let longer = [bytes.as_slice(), &[0]].concat();
        assert_eq!(State::from_bytes(&longer), Err(SnapshotError::TooLong { extra: 1 }));
    }
}
