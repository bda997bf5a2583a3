//! A fingerprint of State: equal bits, equal text.

use sha2::{Digest, Sha256};

use crate::State;

impl State {
    /// The first 16 hexadecimal digits of SHA-256 over all fields in declared order, each preceded by its
    /// name and length.
    pub fn hash(&self) -> String {
        let mut digest = Sha256::new();
        for (name, field) in self.fields() {
            let bytes = field.bytes();
            digest.update(name.as_bytes());
            digest.update((bytes.len() as u64).to_le_bytes());
            digest.update(bytes);
        }
        digest.finalize().iter().take(8).map(|byte| format!("{byte:02x}")).collect()
    }
}
