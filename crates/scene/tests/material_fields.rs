//! Numbers of a material from cell to cell: by formulas, from a file, and what of them is refused.

use std::path::Path;

use souple_scene::{Measurement, read_text};

const BAR: &str = r#"
format = 1
[world]
period = "1 ms"
[bodies.bar]
mesh = { generate = "box", size = [1, 1, 1], cells = [4, 1, 1], element = "hex8" }
material = { name = "linear", youngs_modulus = "1 MPa", poissons_ratio = 0.3, density = 1000 }
[probes.mass]
body = "bar"
quantity = "mass"
"#;

fn folder() -> std::path::PathBuf {
    let path = std::env::temp_dir().join(format!("souple_fields_{}", std::process::id()));
    std::fs::create_dir_all(&path).expect("a folder");
    path
}

fn mass(text: &str, folder: &Path) -> Result<f64, String> {
    let scene = read_text("bar.toml", text, folder, &[]).map_err(|errors| errors.to_string())?;
    let probes = scene.probes;
    match probes[0].measure(&mut scene.model.start(scene.state)) {
        Measurement::Number(mass) => Ok(mass),
        Measurement::Vector(_) => unreachable!("a mass is a number"),
    }
}

/// A formula and a file of the same numbers weigh the same; regions keep their material.
#[test]
fn cells_have_numbers_of_their_own() {
    let folder = folder();
    std::fs::write(folder.join("densities.txt"), "1000 2000\n3000\n\n4000\n").expect("a file");
    let formula = format!("{BAR}[bodies.bar.material_fields]\ndensity = {{ value = \"500 + 4000 * x\" }}\n");
    let quantity = format!("{BAR}[bodies.bar.material_fields]\ndensity = {{ value = \"2.5 g/cm^3\" }}\n");
    let file = format!("{BAR}[bodies.bar.material_fields]\ndensity = {{ file = \"densities.txt\" }}\n");
    for text in [&formula, &quantity, &file] {
        let measured = mass(text, &folder).unwrap();
        assert!((measured - 2500.0).abs() < 1e-9, "{measured}");
    }
    let part = r#"
[bodies.bar.regions.end]
region = { box = [[0.7, 0, 0], [1, 1, 1]] }
material = { name = "linear", youngs_modulus = "1 MPa", poissons_ratio = 0.3, density = 100 }
"#;
    let measured = mass(&format!("{file}{part}"), &folder).unwrap();
    assert!((measured - 1525.0).abs() < 1e-9, "{measured}");
}

/// What is wrong is named with its place and what would be right.
#[test]
fn wrong_fields_are_refused() {
    let folder = folder();
    std::fs::write(folder.join("three.txt"), "1000 2000 3000").expect("a file");
    std::fs::write(folder.join("words.txt"), "1000\n2000 heavy 3000").expect("a file");
    for (field, said) in [
        ("density = { file = \"three.txt\" }", "`three.txt` has 3 numbers"),
        ("density = { file = \"words.txt\" }", "line 2 of `words.txt`: `heavy` is no number"),
        ("density = { file = \"none.txt\" }", "`none.txt` cannot be read"),
        ("density = { value = \"1000 - 2000 * x\" }", "`density` of cell 2 is"),
        ("poissons_ratio = { value = \"x\" }", "`poissons_ratio` of cell 2 is"),
        ("density = { value = \"2 kPa\" }", "`2 kPa` is a pressure"),
        ("colour = { value = \"2 kPa\" }", "`colour` is no number of the material `linear`"),
        ("colour = { value = \"x\" }", "`colour` is no number of the material `linear`"),
        ("density = { value = \"1000\", file = \"three.txt\" }", "by a formula or by a file"),
    ] {
        let error = mass(&format!("{BAR}[bodies.bar.material_fields]\n{field}\n"), &folder).unwrap_err();
        assert!(error.contains(said), "{field}: {error}");
    }
}
