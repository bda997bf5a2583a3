//! What tools leave on surfaces: whitening by the pressure of contacts and its refill, burns, blood, and where none of them can be.

use std::path::Path;

use souple_engine::World;
use souple_scene::{Scene, read_text};

/// A block of a metre that is held, pressed by a centimetre from below for a tenth of a second.
const PRESSED: &str = r#"format = 1
[world]
period = "10 ms"
[bodies.block]
mesh = { generate = "box", size = [1, 1, 1], cells = [2, 2, 2], element = "hex8" }
material = { name = "neo_hookean", youngs_modulus = "1 MPa", poissons_ratio = 0.3, density = 1000 }
marks = { whitening_pressure = 90, whitening_time = "0.05 s", refill_time = "0.4 s", burn_dose = 50 }
[[bodies.block.pins]]
region = "y_min"
[shapes.floor]
shape = { name = "plane", point = [0, 0.01, 0] }
motion = { times = [0.095, 0.099], offsets = [[0, 0, 0], [0, -1, 0]], interpolation = "linear" }
[[contacts]]
name = "floor"
body = "block"
shape = "floor"
region = "y_min"
stiffness = 1000
heat = 100
[probes.white]
body = "block"
region = { nearest = [0.5, 0, 0.5] }
quantity = "whitening"
[probes.whitest_above]
body = "block"
region = { half_space = { point = [0, 0.1, 0], normal = [0, -1, 0] } }
quantity = "whitening"
reduce = "max"
[probes.burnt]
body = "block"
region = "y_min"
quantity = "burn"
"#;

fn scene(text: &str) -> Result<Scene, String> {
    read_text("scene.toml", text, Path::new("."), &[]).map_err(|errors| errors.to_string())
}

/// Steps a world and gives the mean of the probe of a name.
fn stepped(scene: Scene, steps: usize) -> (World, impl Fn(&mut World, &str) -> f64) {
    let Scene { model, state, probes, .. } = scene;
    let mut world = model.start(state);
    (0..steps).for_each(|_| world.step().unwrap());
    (world, move |world: &mut World, name: &str| {
        let probe = probes.iter().find(|probe| probe.name == name).expect("a probe of that name");
        probe.measure(world).numbers()[0]
    })
}

/// The pressure of a contact is its stiffness times the depth over the mean area of its points, 9 for 2 m²: 45 Pa in the middle, half of
/// what empties it. Where nothing touches nothing happens; what is let go fills again, and what is burnt stays.
#[test]
fn surfaces_whiten_by_pressure_and_burn_by_heat() {
    let (mut world, measure) = stepped(scene(PRESSED).unwrap(), 9);
    let pressed = 0.5 * (1.0 - libm::exp(-0.09 / 0.05));
    assert!((measure(&mut world, "white") - pressed).abs() < 1e-12, "{}", measure(&mut world, "white"));
    assert_eq!(measure(&mut world, "whitest_above"), 0.0);
    assert!((measure(&mut world, "burnt") - 100.0 * 0.09).abs() < 1e-12);
    (0..40).for_each(|_| world.step().unwrap());
    let refilled = pressed * libm::exp(-0.4 / 0.4);
    assert!((measure(&mut world, "white") - refilled).abs() < 1e-12, "{}", measure(&mut world, "white"));
    assert!((measure(&mut world, "burnt") - 100.0 * 0.09).abs() < 1e-12);
}

/// On the border of what is pressed the pressed side alone bears the force, and not those beside it: pressure times the area of the side
/// around each point adds up to what the contact presses with, 10 N on a point in the mean, on the whole side and on one of its edges.
#[test]
fn pressure_is_that_of_the_pressed_side() {
    for (region, points) in [("\"y_min\"", 9.0), ("{ box = [[-0.1, -0.1, -0.1], [0.1, 0.1, 1.1]] }", 3.0)] {
        let text = PRESSED.replace("whitening_pressure = 90", "whitening_pressure = 1e4").replace(
            "shape = \"floor\"\nregion = \"y_min\"",
            &format!("shape = \"floor\"\nregion = {region}"),
        );
        let read = scene(&text).unwrap();
        let surface = read.bodies[0].surface.surface.clone();
        let mut areas = vec![0.0; surface.points.len()];
        for (triangle, corners) in surface.triangles.iter().enumerate() {
            let below = (-surface.area_vector(triangle as u32).y).max(0.0);
            corners.iter().for_each(|corner| areas[*corner as usize] += below / 3.0);
        }
        let (world, _) = stepped(read, 1);
        let values = &world.state().fields[0].values;
        let grown = 1.0 - libm::exp(-0.01 / 0.05);
        let pressure = |node: usize| values[node] / grown * 1e4;
        let force: f64 = areas.iter().enumerate().map(|(node, area)| pressure(node) * area).sum();
        assert!((force - 10.0 * points).abs() < 1e-9, "{force}");
    }
}

/// Vessels that are torn let out blood at their rate as long as something holds them open, less what is charred; an edge tears what a
/// blunt thing of the same pressure does not, and what is pressed white gives none.
#[test]
fn torn_vessels_bleed() {
    let bleeding = "burn_dose = 50, bleeding = { pressure = 30, rate = \"1 mm/s\", clotting_time = 1e12, drying_time = 1e12 } }
[probes.blood]
body = \"block\"
region = \"y_min\"
quantity = \"blood\"
[probes.volume]
body = \"block\"
quantity = \"blood_volume\"
";
    let text = PRESSED
        .replace("burn_dose = 50 }", bleeding)
        .replace("whitening_pressure = 90", "whitening_pressure = 1e15");
    let let_out = |text: &str| {
        let (mut world, measure) = stepped(scene(text).unwrap(), 9);
        (measure(&mut world, "blood"), measure(&mut world, "volume"))
    };
    let cold = text.replace("heat = 100", "heat = 0");
    let (blood, volume) = let_out(&cold);
    assert!((blood / (1e-3 * 0.09) - 1.0).abs() < 1e-9, "{blood}");
    // the areas around the points of this side are 2 m²
    assert!((volume / (2e-3 * 0.09) - 1.0).abs() < 1e-9, "{volume}");
    // charred by a dose of 1 J/m² more in each step
    let charring: f64 = (1..=9).map(|step| 1e-3 * 0.01 * libm::exp(-f64::from(step) / 50.0)).sum();
    assert!((let_out(&text).0 / charring - 1.0).abs() < 1e-9, "{}", let_out(&text).0);
    let blunt = cold.replace("pressure = 30,", "pressure = 1e6,");
    assert_eq!(let_out(&blunt).0, 0.0);
    let sharp = blunt.replace("heat = 0", "tears_at = 1");
    assert!((let_out(&sharp).0 - blood).abs() < 1e-18);
    let white = cold.replace("whitening_pressure = 1e15", "whitening_pressure = 1").replace("0.05 s", "1 us");
    assert!(let_out(&white).0 < 1e-18, "{}", let_out(&white).0);
}

/// The same bits from a snapshot on, whatever the threads: marks are State.
#[test]
fn marks_are_state() {
    let (mut one, _) = stepped(scene(PRESSED).unwrap(), 5);
    let (mut two, _) = stepped(scene(PRESSED).unwrap(), 0);
    assert_eq!(one.state().fields.len(), 1);
    two.resume(one.state().clone()).unwrap();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(3).build().unwrap();
    pool.install(|| (0..9).for_each(|_| two.step().unwrap()));
    (0..9).for_each(|_| one.step().unwrap());
    assert!(one.state().fields[0].values.iter().any(|value| *value > 0.0));
    assert_eq!(one.state().fields[0].values, two.state().fields[0].values);
}

#[test]
fn marks_that_cannot_be_are_refused() {
    let refused = |from: &str, to: &str, words: &str| {
        assert!(PRESSED.contains(from), "`{from}`");
        let message = scene(&PRESSED.replacen(from, to, 1)).err().expect("the scene is refused");
        assert!(message.contains(words), "`{words}` is not in:\n{message}");
    };
    refused("whitening_pressure = 90", "whitening_pressure = 0", "whitening_pressure");
    refused(
        "region = { half_space = { point = [0, 0.1, 0], normal = [0, -1, 0] } }",
        "region = { nearest = [0.5, 0.5, 0.5] }",
        "on the surface",
    );
    let marks = "marks = { whitening_pressure = 90, whitening_time = \"0.05 s\", refill_time = \"0.4 s\", burn_dose = 50 }\n";
    refused(marks, "", "gives heat to nothing that burns");
    refused(marks, "", "shows no marks");
    refused("heat = 100", "tears_at = 100", "tears nothing that bleeds");
    refused("quantity = \"burn\"", "quantity = \"blood\"", "does not bleed");
    let bleeding = |key: &str| format!("burn_dose = 50, bleeding = {{ {key} }} }}");
    for (key, words) in [("rate = 0", "rate"), ("clinging = -1", "clinging"), ("colour = 1", "colour")] {
        refused("burn_dose = 50 }", &bleeding(key), words);
    }
}
