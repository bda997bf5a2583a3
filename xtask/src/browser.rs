//! The page in a real browser: what it needs is set up, or said in one line.

use std::path::PathBuf;
use std::process::Command;

use crate::failure::Failure;
use crate::program;
use crate::tree::{Tree, run};

const WEB: &str = "crates/view/web";
const NODE: &str = "install Node.js 20 or later with npm";
const MISSING: &str =
    "there is no Chromium: install it (`apt-get install chromium`), or name it by SOUPLE_CHROMIUM";
/// Names under which systems know the browser.
const BROWSERS: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "chrome"];

/// Checks the types of the page, then drives it in a headless browser before the released program.
pub fn check(tree: &Tree) -> Result<(), Failure> {
    drive(tree, "test")
}

/// Looks at a world for an hour.
pub fn soak(tree: &Tree) -> Result<(), Failure> {
    drive(tree, "soak")
}

/// Runs a script of the page's package.
fn drive(tree: &Tree, script: &str) -> Result<(), Failure> {
    let browser = browser()?;
    let npm = |arguments: &[&str]| {
        let mut command = Command::new(if cfg!(windows) { "npm.cmd" } else { "npm" });
        command.args(arguments).current_dir(tree.root.join(WEB));
        command
    };
    run(&mut npm(&["ci", "--no-audit", "--no-fund"]), NODE)?;
    run(&mut npm(&["run", "check"]), NODE)?;
    let mut tests = npm(&["run", script]);
    tests.env("SOUPLE_PROGRAM", program::souple(tree, &[]).get_program()).env("SOUPLE_CHROMIUM", browser);
    run(&mut tests, program::REMEDY)
}

/// The browser that is named, or found by name; where there is none, the one that the system's packages have.
fn browser() -> Result<PathBuf, Failure> {
    if let Some(named) = std::env::var_os("SOUPLE_CHROMIUM") {
        return Ok(named.into());
    }
    if let Some(found) = find() {
        return Ok(found);
    }
    // whatever comes of it, what counts is whether the browser is there then
    let _ = run(Command::new("apt-get").args(["update", "-q"]), MISSING);
    let _ = run(
        Command::new("apt-get").args(["install", "-y", "-q", "--no-install-recommends", "chromium"]),
        MISSING,
    );
    find().ok_or_else(|| Failure::Faults(vec![MISSING.to_owned()]))
}

fn find() -> Option<PathBuf> {
    let folders: Vec<PathBuf> = std::env::var_os("PATH")
        .iter()
        .flat_map(|path| std::env::split_paths(path).collect::<Vec<_>>())
        .collect();
    let found = BROWSERS.iter().flat_map(|name| {
        let file = PathBuf::from(name).with_extension(std::env::consts::EXE_EXTENSION);
        folders.iter().map(move |folder| folder.join(&file))
    });
    found.into_iter().find(|path| path.is_file())
}
