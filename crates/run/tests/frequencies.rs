//! Natural frequencies of what nothing holds.

use std::path::Path;

use souple_run::natural_frequencies;

const FREE: &str = r#"
format = 1
[world]
period = "1 ms"
[bodies.bar]
mesh = { generate = "bar", size = [0.4, 0.1, 0.1], cells = [8, 2, 2], element = "hex8" }
material = { name = "linear", youngs_modulus = "100 kPa", poissons_ratio = 0.3, density = 1000 }
"#;

/// The six ways of a free body have frequencies of nothing to rounding, of either sign, however many others are asked for; bending has not.
#[test]
fn free_bodies_have_six_frequencies_of_nothing() {
    for count in [5, 10] {
        let scene = souple_scene::read_text("free.toml", FREE, Path::new("."), &[]).unwrap();
        let found = natural_frequencies(scene, count, 1.0).unwrap().remove(0);
        let none = found.hertz.iter().filter(|hertz| hertz.abs() <= found.nothing).count();
        assert_eq!(none, count.min(6), "{found:?}");
        assert!(
            found.hertz.iter().all(|hertz| hertz.abs() <= found.nothing || *hertz > 1e3 * found.nothing),
            "{found:?}"
        );
    }
}
