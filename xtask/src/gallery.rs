//! `docs/gallery.md`: a picture of every scene, made by the released program, small enough to be kept.

use std::fs;
use std::path::Path;

use crate::failure::Failure;
use crate::program;
use crate::tree::{Tree, run};

const PAGE: &str = "docs/gallery.md";
const PICTURES: &str = "docs/pictures/gallery";
/// Largest picture [bytes].
const LARGEST: u64 = 60_000;

/// Views from the front suit most scenes; what a scene needs in its place stands in its folder, `gallery.txt`.
const ARGUMENTS: &str = "--size 480,320 --samples 3 --compact";
const OWN_ARGUMENTS: &str = "gallery.txt";

/// A scene as the page shows it.
#[derive(Debug, PartialEq)]
struct Entry {
    name: String,
    title: String,
    description: String,
}

/// Draws the pictures of the named scenes, of all without names, and writes the page.
pub fn make(tree: &Tree, names: &[String]) -> Result<(), Failure> {
    let entries = entries(tree)?;
    if let Some(unknown) = names.iter().find(|name| entries.iter().all(|entry| entry.name != **name)) {
        return Err(Failure::Faults(vec![format!("there is no scene `{unknown}`")]));
    }
    let folder = tree.root.join(PICTURES);
    fs::create_dir_all(&folder).map_err(|error| Failure::File { path: folder.clone(), error })?;
    for entry in entries.iter().filter(|entry| names.is_empty() || names.contains(&entry.name)) {
        let scene = format!("scenes/{}", entry.name);
        let picture = picture(&entry.name);
        let own = tree.read_if_text(&format!("{scene}/{OWN_ARGUMENTS}")).ok().flatten().unwrap_or_default();
        let mut command =
            program::souple(tree, &["render", &scene, "--out", &picture, "--title", "", "--quiet"]);
        command.args(ARGUMENTS.split_whitespace()).args(own.split_whitespace());
        run(&mut command, program::REMEDY)?;
    }
    let path = tree.root.join(PAGE);
    fs::write(&path, page(&entries)).map_err(|error| Failure::File { path, error })?;
    check(tree)
}

/// The page shows every scene as it is called now, and every picture is there and small.
pub fn check(tree: &Tree) -> Result<(), Failure> {
    let entries = entries(tree)?;
    let mut faults = Vec::new();
    if tree.read(PAGE)? != page(&entries) {
        faults.push(format!("{PAGE} is not what the scenes say; `cargo xtask gallery` writes it"));
    }
    for entry in &entries {
        let picture = picture(&entry.name);
        match fs::metadata(tree.root.join(&picture)) {
            Ok(data) if data.len() > LARGEST => {
                faults.push(format!("{picture} has {} bytes; at most {LARGEST} are kept", data.len()));
            }
            Ok(_) => {}
            Err(_) => {
                faults.push(format!("{picture} is missing; `cargo xtask gallery {}` draws it", entry.name))
            }
        }
    }
    println!("{} scenes", entries.len());
    Failure::unless_empty(faults)
}

fn picture(name: &str) -> String {
    format!("{PICTURES}/{name}.png")
}

fn entries(tree: &Tree) -> Result<Vec<Entry>, Failure> {
    let mut entries = Vec::new();
    for file in tree.files()? {
        let Some(name) = file.strip_prefix("scenes/").and_then(|rest| rest.strip_suffix("/scene.toml"))
        else {
            continue;
        };
        let scene: toml::Table = tree
            .read(&file)?
            .parse()
            .map_err(|error: toml::de::Error| Failure::Faults(vec![format!("{file}: {error}")]))?;
        let text = |key: &str| scene.get(key).and_then(toml::Value::as_str).unwrap_or_default();
        let in_one_line = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
        entries.push(Entry {
            name: name.to_owned(),
            title: in_one_line(text("title")),
            description: in_one_line(text("description")),
        });
    }
    Ok(entries)
}

fn page(entries: &[Entry]) -> String {
    let mut page = "# Gallery\n\nEvery scene of `scenes/`, as it stands at its end, coloured by stress where it has any. Any of them is run by\n\
                    `souple run scenes/NAME --out out/NAME` and drawn by `souple render scenes/NAME --out NAME.png`. This page is\n\
                    written by `cargo xtask gallery`.\n"
        .to_owned();
    for Entry { name, title, description } in entries {
        let file = Path::new("pictures/gallery").join(format!("{name}.png"));
        page += &format!("\n## {title}\n\n![{title}]({})\n\n", file.display());
        if !description.is_empty() {
            page += &format!("{description}\n\n");
        }
        page += &format!("[scenes/{name}](../scenes/{name}/scene.toml)\n");
    }
    page
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Titles, pictures and links of all scenes are on the page.
    #[test]
    fn a_page_shows_every_scene() {
        let entry = |name: &str, description: &str| Entry {
            name: name.to_owned(),
            title: format!("The {name}"),
            description: description.to_owned(),
        };
        let page = page(&[entry("bar", "It bends."), entry("ball", "")]);
        for part in [
            "## The bar",
            "![The bar](pictures/gallery/bar.png)",
            "It bends.",
            "](../scenes/ball/scene.toml)",
        ] {
            assert!(page.contains(part), "{part}");
        }
        assert!(!page.contains("\n\n\n"));
    }
}
