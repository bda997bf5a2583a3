//! A scene starts from what another has kneaded: its masses are where a frame of that run has them.

use std::path::Path;

use souple_run::{Control, Options, run};

const KNEADED: &str = r#"
format = 1
[world]
period = "10 ms"
gravity = [0, 0, -9.81]
[systems.main]
stepper = "t_simulation"
steps_per_period = 10
[networks.clay.masses.clay]
lattice = { origin = [0.3, 0, 1], spacing = 1, counts = [3, 3, 2] }
mass = 1
[[networks.clay.crowds]]
law = { name = "cohesion", distance = 1, peak = 1.1, range = 1.4, cohesion = 10000, damping = 40 }
[shapes.ground]
shape = { name = "plane", point = [0, 0, 0], normal = [0.1, 0, 1] }
[[contacts]]
body = "clay"
shape = "ground"
stiffness = "20 kN/m"
damping = 0.3
"#;

fn goes_on(from: &str) -> String {
    format!(
        "format = 1\n[world]\nperiod = \"10 ms\"\n[networks.again.masses.clay]\nmass = 1\nfrom = {from}\n[systems.main]\nstepper = \"t_simulation\"\n"
    )
}

#[test]
fn kneaded_shapes_start_scenes() {
    let out = std::env::temp_dir().join(format!("souple-kneaded-{}", std::process::id()));
    let scene = souple_scene::read_text("kneaded", KNEADED, Path::new("."), &[]);
    let scene = scene.unwrap_or_else(|errors| panic!("{errors}"));
    let options = Options { out: Some(out.clone()), steps: Some(40), frames: Some(1), ..Options::default() };
    let kneaded = run(scene, &options, &mut |_| Control::Continue).expect("a run");
    let frame = "\"frames/clay_0001.vtu\"";
    let read = |from: &str| souple_scene::read_text("again", &goes_on(from), &out, &[]);
    let again = read(&format!("{{ file = {frame} }}")).unwrap_or_else(|errors| panic!("{errors}"));
    let (found, left) = (&again.bodies[0].mesh.points, &kneaded.world.rows(0).positions);
    let size = left.iter().map(|place| place.length()).fold(0.0, f64::max);
    assert_eq!(found.len(), 18);
    // frames hold numbers of eight bytes or of four
    let apart = found.iter().zip(left).map(|(a, b)| (*a - *b).length()).fold(0.0, f64::max);
    assert!(apart <= f64::from(f32::EPSILON) * size, "{apart}");
    let part = read(&format!("{{ file = {frame}, first = 9, count = 4, scale = 2 }}"));
    let part = part.unwrap_or_else(|errors| panic!("{errors}"));
    assert_eq!(part.bodies[0].mesh.points[3], found[12] * 2.0);
    for (from, words) in [
        (format!("{{ file = {frame}, first = 18 }}"), "has 18 points"),
        (format!("{{ file = {frame}, first = 9, count = 10 }}"), "those from 9 to 19"),
        ("{ file = \"frames/dough.vtu\" }".to_owned(), "there is no file"),
    ] {
        let errors = read(&from).err().expect("refused").to_string();
        assert!(errors.contains(words), "{from}: {errors}");
    }
    // what cannot be removed from a folder of temporary files does no harm
    let _ = std::fs::remove_dir_all(&out);
}
