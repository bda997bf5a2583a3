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

/// One linearised solve a step goes on where cells are turned inside out and their tangents are not definite, with friction
/// beside them: a finger goes through the organ in a third of a second, and what it leaves comes back to the ligaments.
#[test]
fn a_finger_goes_through() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/liver/scene.toml");
    let through = "[[0, 0, 0], [0, 0, -0.14], [0, 0, -0.14], [0, 0, 0]]";
    let settings = [
        "bodies.liver.mesh.size=0".to_owned(),
        "bodies.liver.mesh.count=1000".to_owned(),
        "shapes.tool.motion.times=[0, 0.3, 0.4, 0.6]".to_owned(),
        format!("shapes.tool.motion.offsets={through}"),
    ];
    let scene = souple_scene::read_file(&path, &settings).unwrap_or_else(|error| panic!("{error}"));
    let mut world = scene.model.start(scene.state);
    let mut made_definite = 0;
    for step in 0..60 {
        world.step().unwrap_or_else(|error| panic!("step {step}: {error}"));
        made_definite += world.last_report().made_definite;
    }
    assert!(made_definite > 0);
    // within the length of the organ from where it hangs
    assert!(world.rows(0).positions.iter().all(|x| x.length() < 0.5));
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
