//! Faults that were found, and must not come back.

use std::path::Path;

/// A stiff, barely loaded neo-Hookean bar: its energy is a small difference of large terms, whose rounding hid
/// every decrease from the line search, and Newton's method stalled in the very first step.
#[test]
fn line_search_survives_cancelling_energies() {
    for (law, gravity, period) in [
        ("neo_hookean", "-0.1", "10 ms"),
        ("stable_neo_hookean", "-0.1", "10 ms"),
        ("neo_hookean", "-9.81", "5 ms"),
    ] {
        let text = format!(
            r#"
            format = 1
            [world]
            period = "{period}"
            gravity = [0, {gravity}, 0]
            [bodies.bar]
            mesh = {{ generate = "bar", size = [1, 0.1, 0.1], cells = [10, 1, 1], element = "hex8" }}
            material = {{ name = "{law}", youngs_modulus = "10 MPa", poissons_ratio = 0.3, density = 1000 }}
            [[bodies.bar.pins]]
            region = {{ group = "x_min" }}
            "#
        );
        let scene = souple::scene::read_text("bar", &text, Path::new("."), &[]).unwrap();
        let mut world = scene.model.start(scene.state);
        for step in 0..200 {
            world.step().unwrap_or_else(|error| panic!("{law} at {gravity} m/s², step {step}: {error}"));
        }
    }
}
