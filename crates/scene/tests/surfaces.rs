//! Surfaces as found in the wild, from a folder beside the project where it is present (`SOUPLE_DATA`, else `../shared/data`): each
//! is filled from a scene and falls for a hundred steps.

use std::path::{Path, PathBuf};

/// The surface files of the folder; none where it is not there.
fn files() -> Vec<PathBuf> {
    let beside = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
    let folder = std::env::var_os("SOUPLE_DATA").map_or(beside, PathBuf::from);
    let Ok(entries) = std::fs::read_dir(&folder) else {
        println!("not tried: there is no folder {}", folder.display());
        return Vec::new();
    };
    let mut files: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    files.retain(|file| {
        file.extension().is_some_and(|e| ["obj", "stl", "vtu", "msh"].iter().any(|known| e == *known))
    });
    files.sort();
    files
}

/// What falls freely has the velocity `g t` of all its mass, whatever its shape.
#[test]
fn every_surface_falls() {
    const STEPS: usize = 100;
    for file in files() {
        let name = file.display();
        let text = format!(
            r#"
            format = 1
            title = "A surface that was found"
            [world]
            period = "1 ms"
            gravity = [0, -9.81, 0]
            [bodies.found]
            mesh = {{ fill = "{name}", count = 1000 }}
            material = {{ name = "stable_neo_hookean", youngs_modulus = "100 kPa", poissons_ratio = 0.4, density = 1000 }}
            "#
        );
        let scene = souple_scene::read_text(&name.to_string(), &text, Path::new("."), &[])
            .unwrap_or_else(|error| panic!("{name}: {error}"));
        let mut world = scene.model.start(scene.state);
        for step in 0..STEPS {
            world.step().unwrap_or_else(|error| panic!("{name}, step {step}: {error}"));
        }
        let rows = world.rows(0);
        let fall = 9.81 * 1e-3 * STEPS as f64;
        // each solve is exact to 1e-6 of the force at least, and the fall is a sum of as many
        let worst = rows.velocities.iter().map(|v| (v.y + fall).abs()).fold(0.0, f64::max);
        assert!(rows.positions.iter().all(|x| x.is_finite()), "{name}");
        assert!(worst < 1e-3 * fall, "{name}: {worst} of {fall} m/s");
    }
}
