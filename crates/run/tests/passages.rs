//! What runs warn of where nothing holds: masses that go through walls, and grounds without a value.

use std::path::Path;

use souple_run::{Control, Options, run};

fn warnings(text: &str, settings: &[&str]) -> Vec<String> {
    let settings: Vec<String> = settings.iter().map(|setting| (*setting).to_owned()).collect();
    let scene = souple_scene::read_text("wall.toml", text, Path::new("."), &settings);
    let scene = scene.unwrap_or_else(|errors| panic!("{errors}"));
    run(scene, &Options::default(), &mut |_| Control::Continue).expect("a run").report.warnings
}

/// A mass of 1.5 kg at 2.5 m/s against a wall of 0.1 m, of which 2 kN/m store 2.5 J of its 4.7 J.
const WALL: &str = r#"
format = 1
[world]
period = "1 ms"
[systems.main]
stepper = "symplectic_euler"
[networks.c.masses.m]
positions = [[0, 0, 0]]
mass = 1.5
velocity = [2.5, 0, 0]
[shapes.w]
shape = { name = "box", centre = [1, 0, 0], size = [0.1, 1, 1] }
[[contacts]]
name = "wall"
body = "c"
shape = "w"
stiffness = "2 kN/m"
[run]
duration = "1 s"
"#;

/// A wall that is too soft is told once, with the stiffness that holds the mass: `k (w/2)² = m v²`. One that holds it, and a floor that has no
/// other side, are not spoken of.
#[test]
fn walls_that_are_passed_are_told() {
    let through: Vec<String> =
        warnings(WALL, &[]).into_iter().filter(|text| text.contains("over the middle")).collect();
    let [told] = &through[..] else { panic!("{through:?}") };
    for words in ["mass 0 of `c`", "contact `wall`", "0.1 m thick", "2000 are given"] {
        assert!(told.contains(words), "{words}: {told}");
    }
    let wanted = told.split("about ").nth(1).and_then(|rest| rest.split(" N/m").next()).unwrap();
    let (wanted, exact) = (wanted.parse::<f64>().unwrap(), 1.5 * 2.5 * 2.5 / 0.0025);
    // the speed is that of a period, in which it changes by k w/2 h/m = 0.07 m/s of 1.7 m/s
    assert!((wanted - exact).abs() < 0.08 * (exact - 2000.0), "{wanted} {exact}");
    let holds = format!("contacts[0].stiffness={}", 1.02 * exact);
    for settings in [
        &[holds.as_str()][..],
        &["shapes.w.shape={ name = \"plane\", normal = [-1, 0, 0], point = [1, 0, 0] }"],
    ] {
        assert!(
            warnings(WALL, settings).iter().all(|text| !text.contains("over the middle")),
            "{settings:?}"
        );
    }
}

/// A mass that leaps over a wall within a step feels nothing: the step that would hold it is told, `w/(2 v)`, or `2 √(m/k)` where that is less; the stiffness
/// alone where it is not enough. What is led through a wall is not held by any.
#[test]
fn leaps_over_walls_are_told() {
    let period = "world.period=\"0.125 s\"";
    let told = |settings: &[&str]| {
        warnings(WALL, settings).into_iter().find(|text| text.contains("over the middle")).unwrap_or_default()
    };
    let stiff = told(&[period, "contacts[0].stiffness=1e5"]);
    assert!(stiff.contains("on the other side; steps of less than 0.007746 s hold it there"), "{stiff}");
    let soft = told(&[period, "contacts[0].stiffness=1e3"]);
    assert!(
        soft.contains("about 3750 N/m, where 1000 are given, in steps of less than 0.02 s hold it there"),
        "{soft}"
    );
    let led = "networks.c.pins=[{ region = \"m\", motion = { times = [0, 1], offsets = [[0, 0, 0], [2.5, 0, 0]] } }]";
    assert_eq!(told(&[led]), "");
}

/// A ground whose height has no value beyond `x = 1`: told where a mass comes there, and refused where it starts there.
#[test]
fn grounds_without_a_value_are_told() {
    let ground = "shapes.w.shape={ name = \"height\", height = \"0.2 * sqrt(1.001 - x) - 1\", low = [-1, -1, 0], high = [0.5, 1, 0] }";
    let said = warnings(WALL, &[ground]);
    let told: Vec<&String> = said.iter().filter(|text| text.contains("nothing to touch")).collect();
    let [told] = told[..] else { panic!("{said:?}") };
    for words in ["mass 0 of `c`", "contact `wall`", "`0.2 * sqrt(1.001 - x) - 1` is NaN", "at 0.401 s"] {
        assert!(told.contains(words), "{words}: {told}");
    }
    let settings = [ground.to_owned(), "networks.c.masses.m.positions=[[2, 0, 0]]".to_owned()];
    let refused =
        souple_scene::read_text("wall.toml", WALL, Path::new("."), &settings).err().expect("no ground");
    let message = refused.to_string();
    assert!(message.contains("point 0 of body `c` starts") && message.contains("is NaN"), "{message}");
}
