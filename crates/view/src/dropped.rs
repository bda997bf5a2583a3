//! A mesh that was dropped on the page becomes a scene: a soft body that falls on a floor.

use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError, Weak};

use souple_io::read_mesh;
use souple_mesh::fill::{Size, surface_of};
use souple_mesh::{Mesh, USUAL_SIZES};
use tempfile::TempDir;

/// Largest file that is taken [bytes].
pub const FILE_MAX: usize = 64 << 20;
/// Cells of what a surface encloses, at least and at most, about.
const CELLS: f64 = 6000.0;
const CELLS_MOST: f64 = 12_000.0;
/// How much a body sinks under its own weight: `ρ g L²/E` in its length.
const SAG: f64 = 0.05;
const DENSITY: f64 = 1000.0;
const GRAVITY: f64 = 9.81;

/// A file that was dropped, in a folder of its own that nobody else may enter; both go with the last that needs them.
#[derive(Clone, Debug)]
pub struct DroppedFile {
    folder: Arc<TempDir>,
    /// In its folder.
    name: String,
    /// As whoever dropped it knows it.
    title: String,
}

impl DroppedFile {
    pub fn path(&self) -> PathBuf {
        self.folder.path().join(&self.name)
    }

    /// A message about it, by its own name: where it is kept is nothing to whoever dropped it.
    pub fn told(&self, message: &str) -> String {
        message.replace(&self.path().display().to_string(), &self.title)
    }
}

impl PartialEq for DroppedFile {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.folder, &other.folder)
    }
}

impl Eq for DroppedFile {}

/// Files that were dropped and are needed.
#[derive(Default)]
pub struct DropFolder {
    kept: Mutex<Vec<Weak<TempDir>>>,
}

impl DropFolder {
    /// Keeps a file.
    ///
    /// # Errors
    /// There is no place for it.
    pub fn keep(&self, name: &str, content: &[u8]) -> Result<DroppedFile, String> {
        // what is removed or added under this lock is so at once
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        let is_plain = |c: char| c.is_ascii_alphanumeric() || "._-".contains(c);
        let plain: String = name.chars().map(|c| if is_plain(c) { c } else { '_' }).collect();
        let wrong = |error: std::io::Error| format!("it cannot be kept: {error}");
        let folder = tempfile::Builder::new().prefix("souple-").tempdir().map_err(wrong)?;
        let file = DroppedFile {
            folder: Arc::new(folder),
            name: plain.trim_start_matches('.').to_owned(),
            title: name.chars().filter(|c| !c.is_control()).collect(),
        };
        std::fs::write(file.path(), content).map_err(wrong)?;
        kept.retain(|folder| folder.strong_count() > 0);
        kept.push(Arc::downgrade(&file.folder));
        Ok(file)
    }

    /// Removes all files: the program ends, whatever still holds them.
    pub fn clear(&self) {
        for folder in self.kept.lock().unwrap_or_else(PoisonError::into_inner).drain(..) {
            if let Some(folder) = folder.upgrade() {
                // what cannot be removed is left to the system
                let _ = std::fs::remove_dir_all(folder.path());
            }
        }
    }
}

/// The scene of a mesh or closed surface: soft enough to be seen to sag, over a floor.
///
/// # Errors
/// The file is no mesh, or has no extent.
pub fn scene_of(dropped: &DroppedFile) -> Result<String, String> {
    let (path, title) = (dropped.path(), serde_json::Value::from(dropped.title.as_str()));
    let (mesh, _) = read_mesh(&path).map_err(|error| dropped.told(&error.to_string()))?;
    let bounds = mesh.bounds();
    let written = bounds.diagonal();
    if !(written.is_finite() && written > 0.0) {
        return Err(format!("{title} has no extent"));
    }
    // a file knows no units
    let scale = if written > USUAL_SIZES[1] { 1e-3 } else { 1.0 };
    let length = scale * written;
    let file = path.display().to_string();
    let is_solid = mesh.cell_count() > 0 && mesh.dimension() == 3;
    let (source, filled) = if is_solid {
        (format!("file = {file:?}"), String::new())
    } else {
        let count = cells_of(&mesh);
        let filled = format!(
            " It is filled with about {count} cells: a scene file of your own takes any size of them."
        );
        (format!("fill = {file:?}, count = {count}"), filled)
    };
    let youngs_modulus = DENSITY * GRAVITY * length / SAG;
    let floor = scale * bounds.low.y - 0.1 * length;
    let (x, z) = (scale * bounds.centre().x, scale * bounds.centre().z);
    Ok(format!(
        "format = 1\n\
         title = {title}\n\
         description = \"A mesh that was dropped on the page: a soft body that falls on a floor.{filled}\"\n\
         [world]\n\
         period = \"10 ms\"\n\
         gravity = [0, -{GRAVITY}, 0]\n\
         [systems.main]\n\
         stepper = {{ name = \"backward_euler\", newton = \"one\", solver_tolerance = 1e-4 }}\n\
         [bodies.body]\n\
         mesh = {{ {source}, scale = {scale} }}\n\
         material = {{ name = \"stable_neo_hookean\", youngs_modulus = {youngs_modulus}, poissons_ratio = 0.4, \
         density = {DENSITY} }}\n\
         damping = {{ rayleigh_mass = 0.5 }}\n\
         [shapes.floor]\n\
         shape = {{ name = \"plane\", point = [{x}, {floor}, {z}], normal = [0, 1, 0] }}\n\
         [[contacts]]\n\
         body = \"body\"\n\
         shape = \"floor\"\n\
         friction = 0.5\n\
         [probes.height]\n\
         body = \"body\"\n\
         quantity = \"position\"\n\
         component = \"y\"\n"
    ))
}

/// Tetrahedra that fill a surface: as many as make their lattice no coarser than twice the volume by the area, half the thickness
/// of a rod, so that what is thin does not fall into parts; few enough to be led by a hand.
fn cells_of(surface: &Mesh) -> f64 {
    let needed = surface_of(surface).map(|surface| {
        let (volume, area) = (surface.enclosed_volume().abs(), surface.area());
        Size::count_for(volume, 2.0 * volume / area)
    });
    // a surface that encloses nothing is refused when it is filled
    needed.filter(|count| count.is_finite()).unwrap_or(CELLS).clamp(CELLS, CELLS_MOST).round()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is thin is filled with more cells, `1.5 A³/V²` between the least and the most; so is nothing that encloses nothing.
    #[test]
    fn thin_surfaces_have_more_cells() {
        let folder = DropFolder::default();
        let scene_with = |depth: f64, faces: &str| {
            let corner = |i: u32| {
                format!("v {} {} {}\n", i & 1, f64::from(i >> 1 & 1) * depth, f64::from(i >> 2) * depth)
            };
            let text = (0..8).map(corner).collect::<String>() + faces;
            scene_of(&folder.keep("rod.obj", text.as_bytes()).unwrap()).unwrap()
        };
        let all = "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
        for (depth, faces, count) in [
            (1.0, all, 6000),
            (0.02, all, 6000),
            (0.014, all, 7002),
            (0.008, all, 12_000),
            (0.01, "f 1 3 4\n", 6000),
        ] {
            let scene = scene_with(depth, faces);
            assert!(scene.contains(&format!("count = {count}")), "{depth}: {scene}");
        }
    }
}
