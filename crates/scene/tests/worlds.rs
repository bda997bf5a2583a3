//! Worlds of scenes that are written in tests, and what is asked of several of them.

use std::path::Path;

use souple_engine::World;
use souple_scene::Scene;

/// How most of these scenes begin.
pub const T_SIMULATION: &str = r#"
format = 1
[world]
period = "10 ms"
[systems.main]
stepper = "t_simulation"
"#;

/// A module: a cube of 0.2 m whose corners have 0.1 kg each.
pub const DIE: &str = "
[modules.die.masses.corners]
lattice = { origin = [-0.1, -0.1, -0.1], spacing = 0.2, counts = [2, 2, 2] }
mass = 0.1
";

pub fn read(text: &str, settings: &[&str]) -> Result<Scene, String> {
    let settings: Vec<String> = settings.iter().map(|setting| (*setting).to_owned()).collect();
    souple_scene::read_text("constraints", text, Path::new("."), &settings)
        .map_err(|errors| errors.to_string())
}

pub fn started(text: &str, settings: &[&str]) -> World {
    let scene = read(text, settings).unwrap_or_else(|message| panic!("{message}"));
    scene.model.start(scene.state)
}

/// Steps a world so many times.
pub fn stepped(mut world: World, steps: u32) -> World {
    for step in 1..=steps {
        world.step().unwrap_or_else(|error| panic!("step {step}: {error}"));
    }
    world
}

/// A run that goes on from its state makes the same bits, and so do any number of threads. Returns the world after twice as many steps.
pub fn assert_goes_on(text: &str, steps: u32) -> World {
    let half = stepped(started(text, &[]), steps);
    let resumed = read(text, &[]).unwrap().model.start(half.state().clone());
    let (world, resumed) = (stepped(half, steps), stepped(resumed, steps));
    assert!(world.state() == resumed.state());
    let pool = rayon::ThreadPoolBuilder::new().num_threads(3).build().unwrap();
    let threaded = pool.install(|| stepped(started(text, &[]), 2 * steps).state().clone());
    assert!(*world.state() == threaded);
    world
}

/// By all forces [J].
pub fn dissipated(world: &mut World) -> f64 {
    world.energy().by_force.iter().map(|(_, energy)| energy.dissipated).sum()
}
