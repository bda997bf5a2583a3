//! Checks that cargo makes: format, lints, tests, documentation.

use crate::failure::Failure;
use crate::tree::{Tree, run};

/// What is to be there.
pub const TOOLCHAIN: &str = "install Rust with its usual components: `rustup component add clippy rustfmt`";

pub fn format(tree: &Tree) -> Result<(), Failure> {
    run(&mut tree.cargo(&["fmt", "--all", "--check"]), TOOLCHAIN)
}

pub fn lint(tree: &Tree) -> Result<(), Failure> {
    let arguments = ["clippy", "--workspace", "--all-targets", "--locked", "--", "--deny", "warnings"];
    run(&mut tree.cargo(&arguments), TOOLCHAIN)
}

/// By `cargo nextest` where it is installed: it names slow tests and runs those of all crates side by side.
pub fn tests(tree: &Tree) -> Result<(), Failure> {
    let has_nextest =
        tree.cargo(&["nextest", "--version"]).output().is_ok_and(|output| output.status.success());
    let runner: &[&str] = if has_nextest {
        &["nextest", "run", "--no-fail-fast", "--status-level", "slow", "--final-status-level", "fail"]
    } else {
        // library, binaries, examples and tests; the examples of the documentation are a check of their own
        &["test", "--no-fail-fast", "--quiet", "--lib", "--bins", "--examples", "--tests"]
    };
    run(tree.cargo(runner).args(["--workspace", "--locked"]), TOOLCHAIN)
}

pub fn doc_tests(tree: &Tree) -> Result<(), Failure> {
    run(&mut tree.cargo(&["test", "--doc", "--quiet", "--workspace", "--locked"]), TOOLCHAIN)
}

pub fn docs(tree: &Tree) -> Result<(), Failure> {
    let mut command = tree.cargo(&["doc", "--workspace", "--no-deps", "--locked"]);
    run(command.env("RUSTDOCFLAGS", "--deny warnings"), TOOLCHAIN)
}
