//! What levels save: active points of the poked organ, adaptive and all fine, with the errors of force and surface.

use souple_engine::World;
use souple_scene::Measurement;

use super::timing::scene;
use super::{Effort, Figure};

/// What is read while the tool is held.
struct Held {
    /// Points that move by themselves, the most up to then.
    active: f64,
    /// Force of the tool [N].
    force: [f64; 3],
    /// Points of the surface [m].
    surface: Vec<[f64; 3]>,
    size: f64,
    bytes: usize,
}

fn poke(settings: &[String], periods: u32) -> Result<Held, String> {
    let scene = scene("surgical", settings)?;
    let (bodies, probes) = (scene.bodies, scene.probes);
    let body = bodies.first().ok_or("the scene has no body")?;
    let mut world: World = scene.model.start(scene.state);
    let numbers = |name: &str, world: &mut World| -> Result<Vec<f64>, String> {
        let probe = probes.iter().find(|probe| probe.name == name).ok_or("the probe is missing")?;
        let measured: Measurement = probe.measure(world);
        Ok(measured.numbers())
    };
    let mut active = 0.0_f64;
    for _ in 0..periods {
        world.step().map_err(|error| error.to_string())?;
        active = active.max(numbers("active", &mut world)?[0]);
    }
    let force = numbers("tool", &mut world)?;
    let rows = &world.rows(body.system).positions[body.rows.clone()];
    Ok(Held {
        active,
        force: [force[0], force[1], force[2]],
        surface: body.surface.mesh_points.iter().map(|point| rows[*point as usize].to_array()).collect(),
        size: body.mesh.bounds().diagonal(),
        bytes: world.bytes(),
    })
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
}

/// All fine over adaptive; errors of the force and of the surface, over the size of the body.
pub fn adaptive_saving(effort: Effort) -> Result<Vec<Figure>, String> {
    // the tool stays where it is, until the organ hangs still
    let periods = effort.choose(120, 250);
    let hold = ["shapes.tool.motion.times=[0, 0.4, 0.7, 6, 6.3]", "run.duration=\"7 s\""].map(str::to_owned);
    let adaptive = poke(&hold, periods)?;
    // without the criterion of the scene, which levels that are fixed refuse
    let all_fine =
        r#"bodies.liver.levels={ count = 3, ratio = 1.8, fixed = "2", dress = { blend = "200 ms" } }"#;
    let [times, duration] = hold;
    let fine = poke(&[times, duration, all_fine.to_owned()], periods)?;
    let force = distance(adaptive.force, fine.force) / distance(fine.force, [0.0; 3]);
    let surface = adaptive.surface.iter().zip(&fine.surface).map(|(a, b)| distance(*a, *b));
    let surface = surface.fold(0.0, f64::max) / fine.size;
    let figure = |name: &str, error: f64, error_of: &str| Figure {
        by_processor: None,
        name: name.to_owned(),
        value: fine.active / adaptive.active,
        unit: "active points all-fine / adaptive",
        higher_is_better: true,
        error,
        error_of: error_of.to_owned(),
        baseline: Some(10.0),
        threads: 1,
        samples: 1,
        spread: 0.0,
        bytes: adaptive.bytes,
    };
    Ok(vec![
        figure("adaptive_saving", force, "tool force, against all fine"),
        figure("adaptive_saving_surface", surface, "surface, the farthest point over the size of the body"),
    ])
}
