//! The scenes that a page may choose from.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};

/// Folders of scenes, each a `scene.toml`.
#[derive(Clone, Debug, Default)]
pub struct Catalogue {
    scenes: Vec<(String, PathBuf)>,
}

impl Catalogue {
    /// The scenes in the folders of a folder, by name; none where there is no such folder.
    pub fn of_folder(folder: &Path) -> Self {
        let entries = std::fs::read_dir(folder).into_iter().flatten();
        let scene = |entry: std::fs::DirEntry| {
            let path = entry.path().join("scene.toml");
            let name = entry.file_name().into_string().ok()?;
            path.is_file().then_some((name, path))
        };
        let mut scenes: Vec<_> = entries.filter_map(|entry| scene(entry.ok()?)).collect();
        scenes.sort();
        Self { scenes }
    }

    /// Where the scene of a name is.
    pub fn find(&self, name: &str) -> Option<&Path> {
        self.scenes.iter().find(|(known, _)| known == name).map(|(_, path)| path.as_path())
    }

    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.scenes.iter().map(|(name, _)| name.as_str())
    }

    /// Names, titles and descriptions; a scene that cannot be read is listed with its fault.
    pub fn to_json(&self) -> Value {
        self.scenes.iter().map(|(name, path)| entry(name, path)).collect()
    }
}

fn entry(name: &str, path: &Path) -> Value {
    let folder = path.parent().unwrap_or(Path::new(""));
    let text = match std::fs::read_to_string(path) {
        Ok(text) => text,
        Err(error) => return json!({"name": name, "title": name, "description": error.to_string()}),
    };
    match souple_scene::read_spec(&path.display().to_string(), &text, folder, &[]) {
        Ok(spec) => json!({"name": name, "title": spec.title, "description": spec.description}),
        Err(error) => json!({"name": name, "title": name, "description": error.to_string()}),
    }
}
