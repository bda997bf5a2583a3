//! How long it takes to find what a tool touches.

use souple_engine::World;

use super::timing::{Clock, scene};
use super::{Effort, Figure};

/// What 10,000 triangles may take [ms] (V-41).
const ALLOWED: f64 = 1.0;

/// One search of a tool among ten thousand moving triangles: the tree is refitted, and those near the sweep are looked at.
pub fn detection(effort: Effort) -> Result<Vec<Figure>, String> {
    let settings = [
        "bodies.slab.mesh.cells=[49, 49, 1]",
        "systems.main.stepper.halvings=12",
        "shapes.needle.motion={ formula = [0, 0, \"-0.0115 + 0 * t\"] }",
    ]
    .map(str::to_owned);
    let scene = scene("fast_tool", &settings)?;
    let triangles = scene.bodies[0].surface.surface.triangles.len();
    let mut world: World = scene.model.start(scene.state);
    let samples = effort.choose(20, 200);
    let (mut seconds, mut processor) = (Vec::new(), Vec::new());
    let bytes = world.bytes();
    let found = world.with_system(0, |system, state, around, ws| {
        let mut state = state.clone();
        system.place_rows(&state.q, &state.v, 0.0, &mut ws.rows);
        for _ in 0..samples {
            let clock = Clock::start();
            system.update_pairs(ws, &mut state, around);
            clock.stop(&mut seconds, &mut processor, 1);
        }
        state.pairs.len()
    });
    if found == 0 {
        return Err("the tool finds nothing".to_owned());
    }
    seconds.sort_by(f64::total_cmp);
    let quantile = |share: f64| seconds[((seconds.len() - 1) as f64 * share) as usize];
    let work = (!processor.is_empty()).then(|| 1e3 * processor.iter().sum::<f64>() / processor.len() as f64);
    Ok(vec![Figure {
        name: "tool_detection_10k".to_owned(),
        value: 1e3 * quantile(0.5) * 1e4 / triangles as f64,
        by_processor: work,
        unit: "ms for 10,000 triangles",
        higher_is_better: false,
        error: 0.0,
        error_of: "triangles missed, see the test `touching_triangles_are_those_of_brute_force`".to_owned(),
        baseline: Some(ALLOWED),
        threads: 1,
        samples,
        spread: (quantile(0.75) - quantile(0.25)) / (2.0 * quantile(0.5)),
        bytes,
    }])
}
