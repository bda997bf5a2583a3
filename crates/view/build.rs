//! Builds the page where Node is there, and says why there is none where it is not.
//!
//! The packages of `web/package-lock.json` are installed beside the build's output, never into the source tree.

use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Files of the page's source that are not in `web/src`.
const SOURCES: [&str; 6] =
    ["package.json", "package-lock.json", "build.mjs", "index.html", "style.css", "tsconfig.json"];
/// What the page consists of: path, type.
const FILES: [(&str, &str, &str); 3] = [
    ("/", "index.html", "text/html; charset=utf-8"),
    ("/page.js", "page.js", "text/javascript; charset=utf-8"),
    ("/page.css", "page.css", "text/css; charset=utf-8"),
];
const REMEDY: &str = "install Node.js 20 or later with npm, then build Souple again";

fn main() {
    // where the crate is now: the program that asks may have been made in another folder
    let web = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").expect("cargo names the folder of the crate"));
    let web = web.join("web");
    for source in SOURCES.iter().copied().chain(["src"]) {
        println!("cargo::rerun-if-changed={}", web.join(source).display());
    }
    println!("cargo::rerun-if-env-changed=PATH");
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo names the folder of the output"));
    let made = make(&web, &out.join("web"));
    let text = match &made {
        Ok(folder) => listing(folder),
        Err(problem) => {
            println!("cargo::warning=the page of `souple view` is not built: {problem}");
            format!("pub const FILES: &[File] = &[];\npub const PROBLEM: Option<&str> = Some({problem:?});\n")
        }
    };
    fs::write(out.join("page.rs"), text).expect("the output folder can be written");
}

fn listing(folder: &Path) -> String {
    let entry = |(path, file, kind): &(&str, &str, &str)| {
        let file = folder.join(file).display().to_string();
        format!("    File {{ path: {path:?}, kind: {kind:?}, content: include_bytes!({file:?}) }},\n")
    };
    let entries: String = FILES.iter().map(entry).collect();
    format!("pub const FILES: &[File] = &[\n{entries}];\npub const PROBLEM: Option<&str> = None;\n")
}

/// Installs the packages, where their lock file has changed, and bundles the page; the folder of the bundle.
fn make(web: &Path, work: &Path) -> Result<PathBuf, String> {
    run(Command::new("node").arg("--version"), "Node.js is not there")?;
    fs::create_dir_all(work).map_err(|error| error.to_string())?;
    for name in ["package.json", "package-lock.json"] {
        fs::copy(web.join(name), work.join(name)).map_err(|error| format!("{name}: {error}"))?;
    }
    let lock = fs::read(work.join("package-lock.json")).map_err(|error| error.to_string())?;
    let stamp = work.join("installed.json");
    if fs::read(&stamp).ok().as_deref() != Some(&lock) {
        let npm = if cfg!(windows) { "npm.cmd" } else { "npm" };
        let arguments = ["ci", "--omit=dev", "--no-audit", "--no-fund", "--prefer-offline"];
        run(Command::new(npm).args(arguments).current_dir(work), "its packages cannot be installed")?;
        fs::write(&stamp, &lock).map_err(|error| error.to_string())?;
    }
    let folder = work.join("page");
    let mut bundle = Command::new("node");
    bundle.arg(web.join("build.mjs")).arg(&folder).current_dir(work);
    run(&mut bundle, "the bundle cannot be made")?;
    Ok(folder)
}

fn run(command: &mut Command, what: &str) -> Result<(), String> {
    let output = command.output().map_err(|_| format!("{what}; {REMEDY}"))?;
    if output.status.success() {
        return Ok(());
    }
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    let line = text.lines().find(|line| line.contains("rror")).unwrap_or_default().trim().to_owned();
    Err(format!("{what} ({line}); {REMEDY}"))
}
