//! Faulty scenes: each gives its error, at its place, in its words, and none panics.

use std::fs;
use std::path::{Path, PathBuf};

use souple_scene::{Diagnostics, read_file, read_text};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/faults")
}

/// What follows `# key: ` at the head of a scene.
fn wanted<'a>(text: &'a str, key: &str) -> Option<&'a str> {
    let heads = text.lines().take_while(|line| line.starts_with('#'));
    heads.filter_map(|line| line.strip_prefix("# ")?.strip_prefix(key)?.strip_prefix(": ")).next()
}

fn errors_of(text: &str) -> Diagnostics {
    match read_text("scene.toml", text, &folder(), &[]) {
        Ok(_) => panic!("accepted: {text}"),
        Err(errors) => errors,
    }
}

/// Every file of `faults` is refused with the code, line and words that its first lines say.
#[test]
fn faulty_scenes_are_refused_in_words() {
    let mut paths: Vec<PathBuf> = fs::read_dir(folder())
        .expect("the folder of faults")
        .map(|entry| entry.expect("an entry").path())
        .collect();
    paths.sort();
    assert!(paths.len() >= 40, "{} faults", paths.len());
    let mut failures = Vec::new();
    for path in paths {
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let text = fs::read_to_string(&path).expect("a text");
        let overrides: Vec<String> = wanted(&text, "set").map(str::to_owned).into_iter().collect();
        let Err(errors) = read_file(&path, &overrides) else {
            failures.push(format!("{name}: accepted"));
            continue;
        };
        let (code, words, line) =
            (wanted(&text, "code"), wanted(&text, "words").unwrap_or(""), wanted(&text, "line"));
        let is_met = errors.0.iter().any(|error| {
            Some(error.code.as_str()) == code
                && format!("{error}").contains(words)
                && (line == Some("any") || line == Some(&error.line.to_string()))
        });
        if !is_met {
            failures.push(format!("{name}: wanted {code:?} at line {line:?} with `{words}`, got\n{errors}"));
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n\n"));
}

/// All that is wrong is said at once, each with the fields of the contract.
#[test]
fn all_errors_are_collected() {
    let text = "format = 1\n[world]\nperiod = -1\ngravty = 3\n[bodies.a]\nmesh = 7\nmaterial = \"nothing\"\n";
    let errors = errors_of(text);
    let codes: Vec<&str> = errors.0.iter().map(|error| error.code.as_str()).collect();
    for code in ["unknown_key", "out_of_range", "wrong_type", "unknown_name"] {
        assert!(codes.contains(&code), "{code} in {codes:?}");
    }
    let json = errors.to_json();
    for error in json["errors"].as_array().expect("a list") {
        for key in ["code", "file", "path", "value", "expected", "message"] {
            assert!(error[key].is_string(), "{key} in {error}");
        }
        assert!(error["line"].is_u64() && error["column"].is_u64(), "{error}");
    }
    let period =
        json["errors"].as_array().and_then(|all| all.iter().find(|error| error["path"] == "world.period"));
    let period = period.expect("an error about the period");
    assert_eq!((&period["line"], &period["column"], &period["value"]), (&3.into(), &10.into(), &"-1".into()));
}

/// The line is shown with the place underlined.
#[test]
fn the_place_is_underlined() {
    let text = format!("{}", errors_of("format = 1\n[world]\nperiod = \"5 parsec\"\n"));
    assert!(text.contains("scene.toml:3:10: world.period: "), "{text}");
    assert!(text.contains("3 | period = \"5 parsec\"\n    |          ^^^^^^^^^^"), "{text}");
}

/// An empty text, garbage, a folder and a missing file are errors.
#[test]
fn what_is_no_scene_is_refused() {
    assert_eq!(errors_of("").0[0].code.as_str(), "missing_key");
    assert_eq!(errors_of("\u{1}\u{2}\u{3}").0[0].code.as_str(), "syntax");
    let code = |path: &Path| read_file(path, &[]).err().map(|errors| errors.0[0].code.as_str());
    assert_eq!(code(&folder()), Some("unreadable"));
    assert_eq!(code(&folder().join("nowhere.toml")), Some("not_found"));
    let garbage = std::env::temp_dir().join(format!("souple_garbage_{}.toml", std::process::id()));
    fs::write(&garbage, [0xff, 0x00, 0xfe, 0x80]).expect("a file");
    let found = code(&garbage);
    fs::remove_file(&garbage).expect("the file again");
    assert_eq!(found, Some("not_text"));
}

/// A parameter that names itself twice, or thirty that each name the one before twice, end at once: found by mutated
/// scenes, which took 2³² steps and all memory.
#[test]
fn parameters_do_not_grow_without_bound() {
    let circle = errors_of("format = 1\n[parameters]\na = \"$a + $a\"\n[world]\nperiod = \"$a + 1\"\n");
    assert!(circle.to_string().contains("made of itself"), "{circle}");
    let doubled = |one: &str, two: &dyn Fn(usize) -> String| {
        let lines: String = (1..30).map(|i| format!("p{i} = {}\n", two(i - 1))).collect();
        format!("format = 1\n[parameters]\np0 = {one}\n{lines}[world]\nperiod = \"$p29\"\n")
    };
    for text in [
        doubled("\"x\"", &|i| format!("\"$p{i} $p{i}\"")),
        doubled("[1]", &|i| format!("[\"$p{i}\", \"$p{i}\"]")),
    ] {
        let errors = errors_of(&text).to_string();
        assert!(errors.contains("makes the scene too large"), "{}", &errors[..errors.len().min(2000)]);
    }
}

/// A scene cut anywhere, or with any byte changed, is accepted or refused, never a panic.
#[test]
fn damaged_scenes_do_not_panic() {
    let text = include_str!("bar.toml").replace("[30, 3, 3]", "[2, 1, 1]");
    for end in (0..text.len()).step_by(3) {
        let _outcome = read_text("cut", &text[..end], &folder(), &[]);
    }
    for at in (0..text.len()).step_by(5) {
        for replacement in ["\"", "[", "}", "9", "-", "$", "\n", "."] {
            let damaged = format!("{}{replacement}{}", &text[..at], &text[at + 1..]);
            if !damaged.contains("99") {
                let _outcome = read_text("damaged", &damaged, &folder(), &[]);
            }
        }
    }
}
