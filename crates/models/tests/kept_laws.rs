//! Laws as text, derived once and kept for later runs.

// F as in the equations
#![allow(non_snake_case)]

use std::fs;
use std::path::Path;
use std::thread;
use std::time::{Duration, SystemTime};

use souple_formal::law::{LawParameter, LawText};
use souple_math::Mat3;
use souple_models::materials::{KeptLaws, TextLaw, WRITTEN_LAWS};
use tempfile::{TempDir, tempdir};

fn folder() -> (TempDir, KeptLaws) {
    let folder = tempdir().expect("a folder");
    let kept = KeptLaws::new(folder.path().join("laws"));
    (folder, kept)
}

/// A text for each number.
fn text(number: f64) -> LawText {
    let value = |value| LawParameter::Number { value, dimension: None };
    LawText {
        energy: "mu/2*(I1 - 3) - mu*log(J) + k/2*log(J)^2".to_owned(),
        definitions: Vec::new(),
        parameters: vec![("mu".to_owned(), value(1.0 + number)), ("k".to_owned(), value(5.0))],
    }
}

/// The same program, and the same numbers from it.
fn assert_same(a: &TextLaw, b: &TextLaw) {
    assert!(a.is_same_program(b), "{:?}", a.warnings());
    let F = Mat3::from_rows([[1.1, 0.2, -0.1], [0.05, 0.9, 0.15], [0.1, -0.05, 1.05]]);
    assert_eq!(a.energy_at(&F).to_bits(), b.energy_at(&F).to_bits());
    assert_eq!(a.stress_at(&F), b.stress_at(&F));
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("the folder of the laws");
    let mut names: Vec<String> =
        entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

/// Every law that ships is kept and found again, bit for bit what is derived, in one file each.
#[test]
fn what_is_kept_is_what_is_derived() {
    let (_folder, kept) = folder();
    for written in WRITTEN_LAWS {
        let text = written.text().expect("laws that ship are laws");
        let derived = TextLaw::compile(text.clone()).expect("a law");
        assert!(!kept.file_of(&text).exists());
        assert_same(&derived, &TextLaw::kept(text.clone(), &kept).expect("a law"));
        assert!(kept.file_of(&text).exists(), "{}", written.name);
        let found = TextLaw::kept(text.clone(), &kept).expect("a law");
        assert_same(&derived, &found);
        // expressions are not kept: who needs them has them derived
        assert_eq!(
            found.expressions().expect("a law").terms(),
            derived.expressions().expect("a law").terms()
        );
    }
}

/// A file is read, not only written: what a whole file says is taken.
#[test]
fn a_kept_law_is_not_derived_again() {
    let (_folder, kept) = folder();
    let (first, second) = (text(0.0), text(1.0));
    TextLaw::kept(first.clone(), &kept).expect("a law");
    let before = fs::metadata(kept.file_of(&first)).and_then(|data| data.modified()).expect("a time");
    thread::sleep(Duration::from_millis(20));
    TextLaw::kept(first.clone(), &kept).expect("a law");
    let after = fs::metadata(kept.file_of(&first)).and_then(|data| data.modified()).expect("a time");
    assert_eq!(before, after, "what was found is not written again");
    // another constant, another unit, another part: another law
    let mut with_unit = second.clone();
    with_unit.parameters[0].1 =
        LawParameter::Number { value: 2.0, dimension: Some(souple_formal::Dimension::new(1, -1, -2)) };
    let mut with_part = second.clone();
    with_part.definitions.push(("I".to_owned(), "I1".to_owned()));
    let files = [&first, &second, &with_unit, &with_part].map(|text| kept.file_of(text));
    for (index, file) in files.iter().enumerate() {
        assert!(!files[..index].contains(file), "{file:?}");
    }
}

/// A file that is cut off, changed in any byte, lengthened or of another law is derived anew and replaced.
#[test]
fn what_is_damaged_is_mended() {
    let (_folder, kept) = folder();
    let text = text(0.0);
    let derived = TextLaw::kept(text.clone(), &kept).expect("a law");
    let file = kept.file_of(&text);
    let whole = fs::read(&file).expect("a file");
    let other = {
        let other = self::text(1.0);
        TextLaw::kept(other.clone(), &kept).expect("a law");
        fs::read(kept.file_of(&other)).expect("a file")
    };
    let changed = (0..whole.len()).step_by(37).map(|place| {
        let mut bytes = whole.clone();
        bytes[place] ^= 0x10;
        bytes
    });
    let cut_off = [0, 7, 40, whole.len() / 2, whole.len() - 1].map(|len| whole[..len].to_vec());
    let longer = [whole.as_slice(), &[0]].concat();
    for damaged in changed.chain(cut_off).chain([longer, other]) {
        fs::write(&file, &damaged).expect("a file");
        assert_same(&derived, &TextLaw::kept(text.clone(), &kept).expect("a law"));
        assert_eq!(fs::read(&file).expect("a file"), whole, "it is whole again");
    }
}

/// Whoever writes and reads at the same time finds whole files, and leaves nothing beside them.
#[test]
fn many_may_write_at_once() {
    let (_folder, kept) = folder();
    let derived: Vec<TextLaw> =
        (0..4).map(|number| TextLaw::compile(text(f64::from(number))).expect("a law")).collect();
    thread::scope(|scope| {
        for _ in 0..8 {
            scope.spawn(|| {
                for round in 0..40 {
                    let number = round % derived.len();
                    let text = text(number as f64);
                    if round % 5 == 4 {
                        drop(fs::remove_file(kept.file_of(&text)));
                    }
                    assert_same(&derived[number], &TextLaw::kept(text, &kept).expect("a law"));
                }
            });
        }
    });
    let file = kept.file_of(&text(0.0));
    let names = names(file.parent().expect("a folder"));
    assert!(names.len() <= derived.len() && names.iter().all(|name| name.ends_with(".law")), "{names:?}");
}

/// Where nothing can be written or read, laws are derived; text that is no law is refused as ever.
#[test]
fn a_folder_that_cannot_be_used_is_none() {
    let (folder, _) = folder();
    let derived = TextLaw::compile(text(0.0)).expect("a law");
    // a file where the folder would be
    let occupied = folder.path().join("occupied");
    fs::write(&occupied, "no folder").expect("a file");
    let kept = KeptLaws::new(&occupied);
    assert_same(&derived, &TextLaw::kept(text(0.0), &kept).expect("a law"));
    assert_eq!(fs::read(&occupied).expect("the file"), b"no folder");
    // a folder where the file would be
    let kept = KeptLaws::new(folder.path().join("laws"));
    fs::create_dir_all(kept.file_of(&text(0.0))).expect("a folder");
    assert_same(&derived, &TextLaw::kept(text(0.0), &kept).expect("a law"));
    assert_eq!(names(&folder.path().join("laws")).len(), 1, "nothing is left beside");
    // a folder that may only be read; one whom no permission stops writes there all the same
    let read_only = folder.path().join("read_only");
    fs::create_dir(&read_only).expect("a folder");
    let mut permissions = fs::metadata(&read_only).expect("a folder").permissions();
    permissions.set_readonly(true);
    fs::set_permissions(&read_only, permissions).expect("its permissions");
    let kept = KeptLaws::new(&read_only);
    assert_same(&derived, &TextLaw::kept(text(0.0), &kept).expect("a law"));
    assert_same(&derived, &TextLaw::kept(text(0.0), &kept).expect("a law"));
    let wrong = LawText { energy: "mu/2*(I1 -".to_owned(), ..text(0.0) };
    assert!(TextLaw::kept(wrong.clone(), &kept).is_err() && !kept.file_of(&wrong).exists());
}

/// A law that was written long ago and is used stays; one that was written since, and not used, goes.
#[test]
fn what_is_used_stays() {
    let (_folder, kept) = folder();
    TextLaw::kept(text(0.0), &kept).expect("a law");
    let file = kept.file_of(&text(0.0));
    let folder = file.parent().expect("a folder");
    let made_at = |name: &str, age: u64| {
        let file = fs::File::options().create(true).write(true).truncate(false).open(folder.join(name));
        let modified = SystemTime::now() - Duration::from_secs(age);
        file.and_then(|file| file.set_modified(modified)).expect("a file and its time");
    };
    made_at(&file.file_name().expect("a name").to_string_lossy(), 900_000);
    for number in 0..511 {
        made_at(&format!("{number:032x}.law"), 800_000 - number);
    }
    TextLaw::kept(text(0.0), &kept).expect("a law");
    TextLaw::kept(text(1.0), &kept).expect("a law");
    assert!(file.exists() && kept.file_of(&text(1.0)).exists());
    assert!(!folder.join(format!("{:032x}.law", 0)).exists());
}

/// A folder holds so many laws, and the oldest go; files of others stay.
#[test]
fn the_oldest_are_forgotten() {
    let (_folder, kept) = folder();
    let file = kept.file_of(&text(0.0));
    let folder = file.parent().expect("a folder");
    fs::create_dir_all(folder).expect("a folder");
    let put = |name: &str, age: u64, len: u64| {
        let file = fs::File::create(folder.join(name)).expect("a file");
        file.set_len(len).expect("a length");
        file.set_modified(SystemTime::now() - Duration::from_secs(age)).expect("a time");
    };
    // files of others may be called a law too
    let others = ["notes.txt", "tissue.law", "neo_hooke.law.txt"];
    others.iter().for_each(|name| put(name, 10_000, 1));
    let ended = format!(".{:032x}.law.1.2", 9);
    put(&ended, 9_000, 1);
    let name = |number: u64| format!("{number:032x}.law");
    for number in 0..511 {
        put(&name(number), 1_000 - number, 1);
    }
    TextLaw::kept(text(0.0), &kept).expect("a law");
    let left = names(folder);
    assert_eq!(left.len(), 512 + others.len());
    assert!(others.iter().all(|name| left.contains(&(*name).to_owned())) && !left.contains(&ended));
    TextLaw::kept(text(1.0), &kept).expect("a law");
    assert!(!names(folder).contains(&name(0)) && file.exists());
    // bytes count as well
    put(&name(600), 0, 32 << 20);
    TextLaw::kept(text(2.0), &kept).expect("a law");
    let left = names(folder);
    assert_eq!(left.len(), 1 + others.len(), "{left:?}");
    assert!(kept.file_of(&text(2.0)).exists());
}
