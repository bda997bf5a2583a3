//! A fingerprint of State: equal bits, equal text.

use sha2::{Digest, Sha256};

use crate::State;

/// What a state is known by.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Fingerprint {
    /// Of the whole state: 16 hexadecimal digits.
    pub hash: String,
    /// Of each field alone, by its name, in declared order: which of them differs says where two states do.
    pub fields: Vec<(String, String)>,
}

impl State {
    /// The first 16 hexadecimal digits of SHA-256 over all fields in declared order: of each its name, its length
    /// and the SHA-256 of its bytes.
    pub fn hash(&self) -> String {
        self.fingerprint().hash
    }

    /// The hash, and that of each field.
    pub fn fingerprint(&self) -> Fingerprint {
        let mut whole = Sha256::new();
        let mut fields = Vec::new();
        for (name, field) in self.fields() {
            let bytes = field.bytes();
            let digest = Sha256::digest(bytes);
            whole.update(name.as_bytes());
            whole.update((bytes.len() as u64).to_le_bytes());
            whole.update(digest);
            fields.push((name, digits(&digest)));
        }
        Fingerprint { hash: digits(&whole.finalize()), fields }
    }
}

/// The first 16 hexadecimal digits of a digest.
fn digits(digest: &[u8]) -> String {
    digest.iter().take(8).map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use crate::{State, SystemState};
    use souple_math::Vec3;

    /// One changed number changes the hash of the state and of its field, and of no other.
    #[test]
    fn fields_tell_where_states_differ() {
        let system = SystemState { q: vec![Vec3::X], v: vec![Vec3::ZERO], ..SystemState::default() };
        let a = State { systems: vec![system], ..State::default() };
        let mut b = a.clone();
        b.systems[0].v[0].y = f64::from_bits(1);
        let (a, b) = (a.fingerprint(), b.fingerprint());
        assert_ne!(a.hash, b.hash);
        let differing: Vec<&str> =
            a.fields.iter().zip(&b.fields).filter(|(a, b)| a != b).map(|(a, _)| a.0.as_str()).collect();
        assert_eq!(differing, ["systems[0].v"]);
    }
}
