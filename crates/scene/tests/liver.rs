//! The organ: filled at any resolution, it hangs, is poked, and keeps a finite energy.

use std::path::Path;

/// A scene with the organ of about so many cells, stepped; energies and positions stay finite.
fn assert_steps(settings: &[&str], steps: usize) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/liver/scene.toml");
    let settings: Vec<String> = settings.iter().map(|text| (*text).to_owned()).collect();
    let scene = souple_scene::read_file(&path, &settings).unwrap_or_else(|error| panic!("{error}"));
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
    let mut world = scene.model.start(scene.state);
    for step in 0..steps {
        world.step().unwrap_or_else(|error| panic!("step {step}: {error}"));
    }
    let rows = world.rows(0);
    assert!(rows.positions.iter().all(|x| x.is_finite() && x.length() < 0.5));
}

#[test]
fn a_thousand_tetrahedra_hang() {
    assert_steps(&["bodies.liver.mesh.size=0", "bodies.liver.mesh.count=1000"], 20);
}

/// One linearised solve a step is held back where cells are turned inside out: a finger goes through the organ in a third of a
/// second, and a second after it has left all hangs as if it had not been there.
#[test]
fn a_finger_goes_through() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/liver/scene.toml");
    let hanging = |offsets: &str| {
        let settings = [
            "bodies.liver.mesh.size=0".to_owned(),
            "bodies.liver.mesh.count=1000".to_owned(),
            "shapes.tool.motion.times=[0, 0.3, 0.4, 0.6]".to_owned(),
            format!("shapes.tool.motion.offsets={offsets}"),
        ];
        let scene = souple_scene::read_file(&path, &settings).unwrap_or_else(|error| panic!("{error}"));
        let mut world = scene.model.start(scene.state);
        for step in 0..80 {
            world.step().unwrap_or_else(|error| panic!("step {step}: {error}"));
        }
        world.rows(0).positions.clone()
    };
    let alone = hanging("[[0, 0, 0], [0, 0, 0], [0, 0, 0], [0, 0, 0]]");
    let after = hanging("[[0, 0, 0], [0, 0, -0.14], [0, 0, -0.14], [0, 0, 0]]");
    let farthest = alone.iter().zip(&after).map(|(a, b)| (*a - *b).length()).fold(0.0, f64::max);
    // it swings, damped by 1/s, from some centimetres
    assert!(farthest < 0.01, "{farthest}");
}

#[test]
fn hexahedra_hang() {
    assert_steps(&[r#"bodies.liver.mesh.element="hex_dominant""#], 5);
}

/// Minutes without optimisation: with `SOUPLE_SLOW=1` in the environment.
#[test]
fn ten_and_a_hundred_thousand_tetrahedra_hang() {
    if std::env::var_os("SOUPLE_SLOW").is_some_and(|value| value == "1") {
        for count in [10_000, 100_000] {
            assert_steps(&["bodies.liver.mesh.size=0", &format!("bodies.liver.mesh.count={count}")], 100);
        }
    }
}
