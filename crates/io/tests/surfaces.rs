//! Surfaces as found in the wild, from a folder beside the project where it is present (`SOUPLE_DATA`, else `../shared/data`): each
//! is filled, with angles within the proven bounds.

use std::path::PathBuf;

use souple_mesh::Mesh;
use souple_mesh::fill::{Options, PARAMETERS, fill_surface, surface_of};
use souple_mesh::repair::{RepairLimits, diagnose};
use souple_table::{Value, Values};

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

fn angles(mesh: &Mesh) -> [f64; 2] {
    let quality = mesh.quality();
    let least = quality.iter().map(|cell| cell.smallest_dihedral).fold(f64::INFINITY, f64::min);
    let greatest = quality.iter().map(|cell| cell.largest_dihedral).fold(0.0, f64::max);
    [least, greatest].map(f64::to_degrees)
}

#[test]
fn every_surface_is_filled() {
    let values = Values::new().with("count", Value::Integer(3000)).completed(PARAMETERS).unwrap();
    let options = Options::from_values(&values).unwrap();
    for file in files() {
        let name = file.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let (mesh, _) = souple_io::read_mesh(&file).unwrap_or_else(|error| panic!("{name}: {error}"));
        let surface = surface_of(&mesh).unwrap_or_else(|| panic!("{name} has no triangles"));
        println!("{name}: {} triangles, {:?}", surface.triangles.len(), diagnose(&surface).messages());
        match fill_surface(&surface, RepairLimits::default(), &options) {
            Ok(filled) => {
                let mut mesh = filled.mesh;
                let [least, greatest] = angles(&mesh);
                println!(
                    "  {} cells, {least:.1} to {greatest:.1} degrees, volume {:.4e} ({:.4e} enclosed), {:?}",
                    mesh.cell_count(),
                    mesh.volume(),
                    surface.enclosed_volume(),
                    filled.notes
                );
                assert!(least > 10.7 && greatest < 164.8, "{name}: {least} {greatest}");
                mesh.faces().conforming().unwrap_or_else(|error| panic!("{name}: {error}"));
                mesh.validate().unwrap_or_else(|error| panic!("{name}: {error}"));
                if diagnose(&surface).is_simple() {
                    let ratio = mesh.volume() / surface.enclosed_volume();
                    // a tube as thin as two cells loses half to its chords, and that is said; an inside out would lose all
                    let is_told = filled.notes.iter().any(|note| note.contains("the filling holds"));
                    assert!((ratio - 1.0).abs() < 0.2 || is_told, "{name}: {ratio} of the enclosed volume");
                    assert!((0.3..1.2).contains(&ratio), "{name}: {ratio} of the enclosed volume");
                }
            }
            Err(error) => panic!("{name}: {error}"),
        }
    }
}
