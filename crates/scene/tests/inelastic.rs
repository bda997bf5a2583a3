//! Bodies whose rest shape gives way, in scenes: what they go on from, the same bits for any number of threads.

use souple_engine::World;
use souple_models::solids::InelasticForce;

use crate::worlds::{read, started};

/// A bar that creeps, yields and tears while it is drawn out.
const DRAWN: &str = r#"
format = 1
[world]
period = "5 ms"
[systems.main]
stepper = "backward_euler"
[bodies.bar]
mesh = { generate = "bar", size = [0.6, 0.1, 0.1], cells = [6, 2, 2], element = "tet4" }
material = { name = "neo_hookean", youngs_modulus = "1 MPa", poissons_ratio = 0.3, density = 1000 }
damping = { rayleigh_mass = 20 }
[bodies.bar.inelasticity]
creep_time = "2 s"
yielding = { stress = "5 kPa", hardening = "200 kPa" }
fracture = { stress = "9 kPa", scatter = 0.3, seed = 3 }
[[bodies.bar.pins]]
region = "x_min"
[[bodies.bar.pins]]
region = "x_max"
motion = { formula = "[0.3 * t, 0, 0]" }
"#;

fn memory(world: &World) -> Vec<f64> {
    let mut found = Vec::new();
    world.visit_forces(0, &mut |force, at| {
        if force.as_any().is::<InelasticForce>() {
            found.extend_from_slice(at.memory);
        }
    });
    found
}

/// How many cells pull no more.
fn torn(world: &World) -> usize {
    let mut count = 0;
    world.visit_forces(0, &mut |force, at| {
        if force.as_any().is::<InelasticForce>() {
            let fields = (0..).map_while(|cell| force.cell_field_at(cell, at));
            count += fields.filter(|field| field.von_mises == 0.0).count();
        }
    });
    count
}

/// A run that goes on from its state makes the same bits, and so do any number of threads; what the rest shape remembers is hashed.
#[test]
fn rest_shapes_go_on_from_state() {
    let (before, after) = (20, 20);
    let step = |world: &mut World, count: usize| {
        (0..count).for_each(|_| {
            world.step().unwrap();
        });
    };
    let mut world = started(DRAWN, &[]);
    let fresh = memory(&world);
    step(&mut world, before);
    let state = world.state().clone();
    let given = memory(&world);
    assert!(given != fresh, "nothing has given way");
    let mut resumed = read(DRAWN, &[]).unwrap().model.start(state.clone());
    step(&mut world, after);
    step(&mut resumed, after);
    assert!(world.state() == resumed.state());
    assert_eq!(world.state().hash(), resumed.state().hash());

    let pool = rayon::ThreadPoolBuilder::new().num_threads(3).build().unwrap();
    let threaded = pool.install(|| {
        let mut world = started(DRAWN, &[]);
        step(&mut world, before + after);
        world.state().clone()
    });
    assert!(world.state() == &threaded);

    let torn = torn(&world);
    assert!((1..24 * 6).contains(&torn), "{torn} cells have torn");
}

/// Another memory is another hash, also of bodies that stand alike.
#[test]
fn what_rest_shapes_remember_is_hashed() {
    let mut world = started(DRAWN, &[]);
    world.step().unwrap();
    let mut changed = world.state().clone();
    let hash = changed.hash();
    // after whether the first cell is torn and what it has given off: the first entry of its `F_p⁻¹`
    let memory = &mut changed.systems[0].memory;
    memory[2] = memory[2].next_up();
    assert_ne!(changed.hash(), hash);
}

/// In statics what bears too much is torn before the step ends, and what bears more by that too, until what is left bears its load. Weak
/// springs hold what has come off.
#[test]
fn statics_tear_on_until_the_rest_bears() {
    let scene = r#"
format = 1
[world]
period = "100 ms"
[systems.main]
stepper = "static"
[bodies.bar]
mesh = { generate = "bar", size = [0.4, 0.1, 0.4], cells = [4, 1, 4], element = "hex8" }
material = { name = "neo_hookean", youngs_modulus = "1 MPa", poissons_ratio = 0, density = 1000 }
inelasticity = { fracture = { strain = 0.01, scatter = 0.5, seed = 3 } }
[[bodies.bar.pins]]
region = "x_min"
[[bodies.bar.loads]]
region = "x_max"
traction = [9000, 0, 0]
[[bodies.bar.springs]]
region = { all = true }
stiffness = "10 kN/m"
distribution = "total"
"#;
    // all bear 0.9 % where their limits are the same
    let elastic = scene.replace("scatter = 0.5", "scatter = 0");
    let mut whole = started(&elastic, &[]);
    whole.step().unwrap();
    assert_eq!(torn(&whole), 0);
    let mut world = started(scene, &[]);
    world.step().unwrap();
    let at_once = torn(&world);
    (0..3).for_each(|_| {
        world.step().unwrap();
    });
    assert!(at_once > 0);
    assert_eq!(torn(&world), at_once);
}

/// Explicit steppers end their steps at the threshold too.
#[test]
fn explicit_steps_end_at_the_threshold() {
    let settings = [
        "systems.main.stepper=symplectic_euler",
        "world.period=\"0.2 ms\"",
        "bodies.bar.inelasticity={ yielding = { stress = \"5 kPa\" } }",
    ];
    let mut world = started(DRAWN, &settings);
    let mut greatest: f64 = 0.0;
    for _ in 0..1000 {
        world.step().unwrap();
        world.visit_forces(0, &mut |force, at| {
            if force.as_any().is::<InelasticForce>() {
                let stresses =
                    (0..).map_while(|cell| force.cell_field_at(cell, at)).map(|field| field.von_mises);
                greatest = stresses.fold(greatest, f64::max);
            }
        });
    }
    // found by halving to the last place
    assert!(greatest > 4.99e3 && greatest <= 5e3 * (1.0 + 1e-9), "{greatest}");
}
