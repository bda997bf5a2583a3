//! Scenes from text to motion.

use std::path::Path;

use souple_scene::{Measurement, Scene, read_file, read_text};

fn scene(text: &str) -> Scene {
    read_text("scene.toml", text, Path::new(env!("CARGO_MANIFEST_DIR")), &[]).unwrap_or_else(|errors| panic!("{errors}"))
}

/// The scene of the contract falls by gravity and is held by its pins.
#[test]
fn the_clamped_bar_sags() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/bar.toml");
    let Scene { model, state, probes, bodies, .. } = read_file(&path, &[]).unwrap_or_else(|errors| panic!("{errors}"));
    assert_eq!(bodies[0].mesh.points.len(), 31 * 4 * 4);
    let mut world = model.start(state);
    for _ in 0..5 {
        world.step().expect("a step");
    }
    let Measurement::Vector(tip) = probes[0].measure(&mut world) else { panic!("a vector") };
    // free fall for 50 ms in five steps of backward Euler would give g h² n (n + 1) / 2
    let fall = 9.81 * 1e-4 * 15.0;
    assert!(tip.y < -0.2 * fall && tip.y > -fall, "{tip:?}");
    let clamped = bodies[0].mesh.points.iter().position(|point| point.x == 0.0).expect("a point of the clamp");
    assert_eq!(world.rows(0).positions[clamped], bodies[0].mesh.points[clamped]);
}
