//! Laws as text that were derived before, kept in a folder for later runs.
//!
//! A file holds all that a run needs of a law, under a name that hashes the text, its constants and the version of what derives. It
//! is written whole beside and renamed: whoever reads at the same time finds none of it or all. What is damaged, cut off or of
//! another version is none, and is replaced. Nothing here fails a run: where the folder cannot be read or written, laws are derived.

use std::fs;
use std::path::{Path, PathBuf};
use std::process;
use std::sync::LazyLock;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, SystemTime};

use sha2::{Digest, Sha256};
use souple_formal::DERIVATION;
use souple_formal::law::{LawParameter, LawText, Strain};
use souple_formal::tape::Tape;

use super::hyperelastic::Derived;

/// A file begins with it; another number says that what follows is laid out otherwise.
const MAGIC: [u8; 8] = *b"souplaw1";
/// Bytes of a hash.
const HASH_LEN: usize = 32;
/// Of the names of files.
const EXTENSION: &str = "law";
/// Files and bytes that a folder holds at most; the oldest go. A law takes some kilobytes, the largest less than a megabyte.
const MOST_FILES: usize = 512;
const MOST_BYTES: u64 = 32 << 20;

/// For how long a file is as good as just used: reading one is to write nothing, most times.
const FRESH: Duration = Duration::from_secs(3600);

/// A folder of derived laws.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct KeptLaws {
    folder: PathBuf,
}

impl KeptLaws {
    /// In a folder that need not be there.
    pub fn new(folder: impl Into<PathBuf>) -> Self {
        Self { folder: folder.into() }
    }

    /// The file of a text, there or not.
    pub fn file_of(&self, text: &LawText) -> PathBuf {
        self.folder.join(name_of(&key_of(text)))
    }

    /// What a text was derived to, if that is here.
    pub(super) fn find(&self, text: &LawText) -> Option<Derived> {
        self.find_as(&key_of(text), read)
    }

    /// Keeps what a text was derived to.
    pub(super) fn keep(&self, text: &LawText, derived: &Derived) {
        self.keep_as(key_of(text), |bytes| write(derived, bytes));
    }

    /// What is here under a key, if `read` takes all of it.
    pub(crate) fn find_as<T>(&self, key: &[u8], read: impl FnOnce(&mut &[u8]) -> Option<T>) -> Option<T> {
        let path = self.folder.join(name_of(key));
        // what is no file may never end
        let data = path.metadata().ok().filter(fs::Metadata::is_file)?;
        let file = fs::read(&path).ok()?;
        let (magic, file) = file.split_first_chunk()?;
        let (hash, content) = file.split_first_chunk::<HASH_LEN>()?;
        if *magic != MAGIC || Sha256::digest(content).as_slice() != hash {
            return None;
        }
        let mut rest = content.strip_prefix(key)?;
        let found = read(&mut rest)?;
        if !rest.is_empty() {
            return None;
        }
        // those go first that nobody has used for the longest
        let now = SystemTime::now();
        let is_old = data
            .modified()
            .ok()
            .and_then(|time| now.duration_since(time).ok())
            .is_some_and(|age| age > FRESH);
        if is_old && let Ok(file) = fs::File::options().write(true).open(&path) {
            // what may only be read keeps its time
            drop(file.set_modified(now));
        }
        Some(found)
    }

    /// Keeps what `write` appends under a key, which it stands behind.
    pub(crate) fn keep_as(&self, key: Vec<u8>, write: impl FnOnce(&mut Vec<u8>)) {
        static WRITTEN: AtomicU64 = AtomicU64::new(0);
        let mut content = key;
        let name = name_of(&content);
        write(&mut content);
        let file = [&MAGIC[..], Sha256::digest(&content).as_slice(), &content].concat();
        let number = WRITTEN.fetch_add(1, Ordering::Relaxed);
        let beside = self.folder.join(format!(".{name}.{}.{number}", process::id()));
        let written = fs::create_dir_all(&self.folder)
            .and_then(|()| fs::write(&beside, file))
            .and_then(|()| fs::rename(&beside, self.folder.join(name)));
        match written {
            Ok(()) => self.forget_the_oldest(),
            // what is half written, on a full disk, must not stay; where nothing was written there is nothing to remove
            Err(_) => drop(fs::remove_file(beside)),
        }
    }

    /// Removes the oldest files beyond [`MOST_FILES`] and [`MOST_BYTES`].
    fn forget_the_oldest(&self) {
        let Ok(entries) = fs::read_dir(&self.folder) else { return };
        let mut files: Vec<(SystemTime, u64, PathBuf)> = entries
            .flatten()
            .filter(|entry| is_of_laws(&entry.path()))
            .filter_map(|entry| {
                let data = entry.metadata().ok().filter(fs::Metadata::is_file)?;
                Some((data.modified().ok()?, data.len(), entry.path()))
            })
            .collect();
        files.sort_unstable_by(|a, b| b.cmp(a));
        let mut bytes = 0;
        for (number, (_, len, path)) in files.into_iter().enumerate() {
            bytes += len;
            if number >= MOST_FILES || bytes > MOST_BYTES {
                // another process may have removed it already
                drop(fs::remove_file(path));
            }
        }
    }
}

/// Whether a file is one of these, or what a process that was ended left beside one.
fn is_of_laws(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let (beside, name) = match name.strip_prefix('.') {
        Some(name) => (true, name),
        None => (false, &*name),
    };
    let parts: Vec<&str> = name.split('.').collect();
    let is_number = |part: &str| !part.is_empty() && part.bytes().all(|byte| byte.is_ascii_digit());
    let is_hash = |part: &str| part.len() == DIGITS && part.bytes().all(|byte| byte.is_ascii_hexdigit());
    match parts[..] {
        [hash, EXTENSION] => !beside && is_hash(hash),
        [hash, EXTENSION, process, number] => {
            beside && is_hash(hash) && is_number(process) && is_number(number)
        }
        _ => false,
    }
}

/// Digits of a hash in a name.
const DIGITS: usize = 32;

fn name_of(key: &[u8]) -> String {
    let hash = Sha256::digest(key);
    let digits: String = hash.iter().take(DIGITS / 2).map(|byte| format!("{byte:02x}")).collect();
    format!("{digits}.{EXTENSION}")
}

/// All that a derivation depends on, without a doubt where one part ends.
pub(crate) fn key_of(text: &LawText) -> Vec<u8> {
    let LawText { energy, definitions, parameters } = text;
    let mut key = Vec::new();
    // what makes programs of derivations, and lays them out here
    static MAKERS: LazyLock<String> = LazyLock::new(|| {
        let mut hash = Sha256::new();
        hash.update(include_bytes!("hyperelastic.rs"));
        hash.update(include_bytes!("kept.rs"));
        format!("{:x}", hash.finalize())
    });
    for said in [DERIVATION, MAKERS.as_str(), std::env::consts::ARCH, energy] {
        put_text(said, &mut key);
    }
    put_count(definitions.len(), &mut key);
    for (name, part) in definitions {
        put_text(name, &mut key);
        put_text(part, &mut key);
    }
    put_count(parameters.len(), &mut key);
    for (name, parameter) in parameters {
        put_text(name, &mut key);
        match parameter {
            LawParameter::Number { value, dimension } => {
                let powers = dimension.map(|dimension| [dimension.mass, dimension.length, dimension.time]);
                key.push(u8::from(powers.is_some()));
                key.extend(powers.unwrap_or_default().map(i8::cast_unsigned));
                put_numbers(&[*value], &mut key);
            }
            LawParameter::Direction(direction) => {
                key.push(2);
                put_numbers(direction, &mut key);
            }
        }
    }
    key
}

pub(crate) fn put_count(count: usize, bytes: &mut Vec<u8>) {
    bytes.extend((count as u32).to_le_bytes());
}

pub(crate) fn put_text(text: &str, bytes: &mut Vec<u8>) {
    put_count(text.len(), bytes);
    bytes.extend(text.as_bytes());
}

pub(crate) fn put_numbers(numbers: &[f64], bytes: &mut Vec<u8>) {
    numbers.iter().for_each(|number| bytes.extend(number.to_bits().to_le_bytes()));
}

pub(crate) fn take_count(bytes: &mut &[u8]) -> Option<usize> {
    let (count, rest) = bytes.split_first_chunk()?;
    *bytes = rest;
    Some(u32::from_le_bytes(*count) as usize)
}

pub(crate) fn take_text(bytes: &mut &[u8]) -> Option<String> {
    let len = take_count(bytes)?;
    let (text, rest) = bytes.split_at_checked(len)?;
    *bytes = rest;
    String::from_utf8(text.to_vec()).ok()
}

/// Entries of `F`, and of what an answer gives.
const MATRIX: usize = 9;

fn write(derived: &Derived, bytes: &mut Vec<u8>) {
    let Derived { energy, stress, differential, strain, is_linear, warnings, stiffness } = derived;
    bytes.extend([u8::from(*strain == Strain::Small), u8::from(*is_linear)]);
    put_numbers(&stiffness[..], bytes);
    put_count(warnings.len(), bytes);
    warnings.iter().for_each(|warning| put_text(warning, bytes));
    [energy, stress, differential].iter().for_each(|tape| tape.store(bytes));
}

fn read(bytes: &mut &[u8]) -> Option<Derived> {
    let ([is_small, is_linear], rest) = bytes.split_first_chunk()?;
    let (strain, is_linear) = (if *is_small == 1 { Strain::Small } else { Strain::Finite }, *is_linear == 1);
    *bytes = rest;
    let mut stiffness = Box::new([0.0; 81]);
    for entry in stiffness.iter_mut() {
        let (bits, rest) = bytes.split_first_chunk()?;
        *entry = f64::from_bits(u64::from_le_bytes(*bits));
        *bytes = rest;
    }
    let warnings = (0..take_count(bytes)?).map(|_| take_text(bytes)).collect::<Option<Vec<String>>>()?;
    let mut tape = |len: usize| Tape::restore(bytes, [&[MATRIX], &[MATRIX]], &[len]).ok();
    let (energy, stress, differential) = (tape(1)?, tape(MATRIX)?, tape(MATRIX)?);
    Some(Derived { energy, stress, differential, strain, is_linear, warnings, stiffness })
}
