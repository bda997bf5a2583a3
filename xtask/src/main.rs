//! The project's own chores: `cargo xtask test` runs every check.
//!
//! A check is a line in [`STEPS`]; quick ones stand first. One of them alone: `cargo xtask test licences`. Pages that
//! are made by the program are written by `cargo xtask gallery`, `cargo xtask reference` and `cargo xtask kernels`.

mod browser;
mod capabilities;
mod cargo;
mod failure;
mod gallery;
mod kernels;
mod licences;
mod program;
mod reference;
mod snippets;
mod texts;
mod tree;

use std::process::ExitCode;
use std::time::Instant;

use failure::Failure;
use tree::Tree;

/// One check.
struct Step {
    name: &'static str,
    summary: &'static str,
    run: fn(&Tree) -> Result<(), Failure>,
}

const STEPS: &[Step] = &[
    Step {
        name: "texts",
        summary: "no path of a machine, no foreign registry, a head on every file",
        run: texts::check,
    },
    Step {
        name: "capabilities",
        summary: "docs/capabilities.md names what exists",
        run: capabilities::check,
    },
    Step {
        name: "gallery",
        summary: "docs/gallery.md shows every scene by a small picture",
        run: gallery::check,
    },
    Step { name: "licences", summary: "every dependency's licence is on the list", run: licences::check },
    Step { name: "format", summary: "rustfmt changes nothing", run: cargo::format },
    Step { name: "lint", summary: "clippy has nothing to say on any target", run: cargo::lint },
    Step { name: "docs", summary: "the documentation of the code builds without warnings", run: cargo::docs },
    Step { name: "build", summary: "the released program", run: program::build },
    Step {
        name: "claims",
        summary: "the validation cases that docs/capabilities.md names show what it says",
        run: program::claims,
    },
    Step { name: "tests", summary: "every test", run: cargo::tests },
    Step {
        name: "doctests",
        summary: "every example in the documentation of the code",
        run: cargo::doc_tests,
    },
    Step { name: "reference", summary: "docs/reference is what the tables say", run: reference::check },
    Step { name: "kernels", summary: "derived laws are what their texts say", run: kernels::check },
    Step {
        name: "browser",
        summary: "the page of the released program in a headless Chromium",
        run: browser::check,
    },
    Step { name: "snippets", summary: "every command and scene in README and docs/", run: snippets::check },
    Step { name: "verify", summary: "the validation cases of the released program", run: program::verify },
    Step { name: "mutations", summary: "every validation case fails where it must", run: program::mutations },
];

/// Checks that are made only by name: they last long, or want a machine for themselves.
const BY_NAME: &[Step] = &[
    Step {
        name: "soak",
        summary: "neither program nor page grows while it is looked at (SOUPLE_SOAK_MINUTES)",
        run: browser::soak,
    },
    Step {
        name: "speed",
        summary: "laws and elements of the released program are as fast as they must be",
        run: program::speed,
    },
];

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let Some((command, names)) = arguments.split_first() else {
        print!("{}", usage());
        return ExitCode::SUCCESS;
    };
    let tree = Tree::of_this_project();
    match command.as_str() {
        "test" => {}
        "gallery" => return written(gallery::make(&tree, names)),
        "reference" => return written(reference::make(&tree)),
        "kernels" => return written(kernels::make(&tree)),
        _ => {
            eprintln!("there is no chore `{command}`\n\n{}", usage());
            return ExitCode::from(2);
        }
    }
    match chosen(names) {
        Ok(steps) => run(&steps),
        Err(unknown) => {
            eprintln!("there is no check `{unknown}`\n\n{}", usage());
            ExitCode::from(2)
        }
    }
}

/// How a chore that writes pages ended.
fn written(result: Result<(), Failure>) -> ExitCode {
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("\n{failure}");
            ExitCode::FAILURE
        }
    }
}

fn usage() -> String {
    let mut text = "cargo xtask gallery         docs/gallery.md and its pictures, by the released program\n\
                    cargo xtask gallery NAME…   the pictures of some scenes\n\
                    cargo xtask reference       docs/reference, by the released program\n\
                    cargo xtask kernels         laws as Rust from their texts, by the released program\n\
                    cargo xtask test            every check, in this order\n\
                    cargo xtask test NAME…      some of them\n\n"
        .to_owned();
    for step in STEPS {
        text += &format!("  {:<14}{}\n", step.name, step.summary);
    }
    text += "\nonly by name:\n\n";
    for step in BY_NAME {
        text += &format!("  {:<14}{}\n", step.name, step.summary);
    }
    text
}

/// The named steps in the order of [`STEPS`]; all of them without names. Errs with a name that is none.
fn chosen(names: &[String]) -> Result<Vec<&'static Step>, String> {
    if names.is_empty() {
        return Ok(STEPS.iter().collect());
    }
    let all = || STEPS.iter().chain(BY_NAME);
    if let Some(unknown) = names.iter().find(|name| all().all(|step| step.name != **name)) {
        return Err(unknown.clone());
    }
    Ok(all().filter(|step| names.iter().any(|name| name == step.name)).collect())
}

/// Runs the steps until one fails.
fn run(steps: &[&Step]) -> ExitCode {
    let tree = Tree::of_this_project();
    let start = Instant::now();
    let mut done = Vec::new();
    for step in steps {
        println!("\n== {}: {}", step.name, step.summary);
        let clock = Instant::now();
        let result = (step.run)(&tree);
        done.push((step.name, clock.elapsed().as_secs_f64()));
        if let Err(failure) = result {
            eprintln!("\n{failure}\n");
            print_times(&done);
            eprintln!("`{}` failed; `cargo xtask test {}` runs it alone", step.name, step.name);
            return ExitCode::FAILURE;
        }
    }
    println!();
    print_times(&done);
    println!("all passed in {:.0} s", start.elapsed().as_secs_f64());
    ExitCode::SUCCESS
}

fn print_times(done: &[(&str, f64)]) {
    for (name, seconds) in done {
        println!("{name:<14}{seconds:>8.1} s");
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Steps run in the order of the table, whatever the order they are asked for in.
    #[test]
    fn steps_keep_their_order() {
        let names = |steps: Vec<&Step>| steps.iter().map(|step| step.name).collect::<Vec<_>>();
        let asked = ["verify".to_owned(), "texts".to_owned()];
        assert_eq!(chosen(&asked).map(names), Ok(vec!["texts", "verify"]));
        assert_eq!(chosen(&[]).map(|steps| steps.len()), Ok(STEPS.len()));
        assert_eq!(chosen(&["tset".to_owned()]).map(names), Err("tset".to_owned()));
    }
}
