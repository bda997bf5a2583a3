//! Tetrahedra of a body that are split into smaller ones.

use std::path::Path;

use souple_scene::read_text;

const BLOCK: &str = r#"format = 1
[world]
period = "1 ms"
[bodies.block]
material = { name = "linear", youngs_modulus = "100 kPa", poissons_ratio = 0.3, density = 1000 }
"#;

fn cells(keys: &str) -> Result<usize, String> {
    let scene = read_text("block.toml", &format!("{BLOCK}{keys}\n"), Path::new("."), &[]);
    scene.map(|scene| scene.bodies[0].mesh.cell_count()).map_err(|diagnostics| diagnostics.to_string())
}

/// A body is of smaller tetrahedra, so often split as is said; regular once where nothing is said.
#[test]
fn tetrahedra_are_split() {
    let mesh = "mesh = { generate = \"box\", size = [1, 1, 1], cells = [1, 1, 1], element = \"tet4\" }\n";
    for (split, count) in [
        ("", 6),
        ("split = {}", 48),
        ("split = { times = 0 }", 6),
        ("split = { times = 2 }", 384),
        // all around the diagonal of the cube, which is longest in each
        ("split = { by = \"longest_edge\" }", 12),
        ("split = { times = 3, by = \"longest_edge\" }", 48),
    ] {
        assert_eq!(cells(&format!("{mesh}{split}")), Ok(count), "{split}");
    }
}

/// What cannot be split, and what would be too many, is refused where it is written.
#[test]
fn wrong_splits_are_refused() {
    let cube = |count: u32, element: &str, split: &str| {
        cells(&format!(
            "mesh = {{ generate = \"box\", size = [1, 1, 1], cells = [{count}, {count}, {count}], element = \"{element}\" }}\nsplit = {split}"
        ))
    };
    for (found, said) in [
        (cube(1, "hex8", "{}"), "cells has a block of hex8, which is not split"),
        (cube(1, "tet10", "{}"), "expected tet4 only"),
        (cube(1, "tet4", "{ times = 9 }"), "bodies.block.split.times"),
        (cube(1, "tet4", "{ by = \"halves\" }"), "bodies.block.split.by"),
        (cube(100, "tet4", "{ times = 6 }"), "memory"),
    ] {
        let error = found.unwrap_err();
        assert!(error.contains(said), "{said}: {error}");
    }
}
