//! What levels save: active points of a pressed body, adaptive and all fine, with the errors of force and surface. What they and the surface that
//! is shown take of the time that passes.

use souple_engine::World;
use souple_scene::Measurement;

use super::timing::{self, Clock, in_turn, scene, with_threads};
use super::{Effort, Figure, value_of};
use crate::cases::STRUCK_ROD;

/// A body with levels that a tool presses and holds.
struct Poke {
    name: &'static str,
    scene: &'static str,
    /// The probe of the tool's force.
    force: &'static str,
    settings: &'static [&'static str],
    /// The finest mesh everywhere, without the criterion of the scene, which levels that are fixed refuse.
    all_fine: &'static str,
    /// Periods until it is still, and of a quick look.
    periods: [u32; 2],
    /// The period from which points that are at work count: before, a body that settles is fine all over.
    counted_from: u32,
    /// Whether ten times fewer points, at 5 % of the force and 2 % of the surface, are held.
    is_promised: bool,
}

const BLOCK: Poke = Poke {
    name: "adaptive_saving",
    scene: "pressed_block",
    force: "ball",
    settings: &[],
    all_fine: r#"bodies.block.levels={ coarser = [{ mesh = { generate = "bar", size = [0.12, 0.12, 0.06], cells = [6, 6, 3], element = "tet4" } }, { mesh = { generate = "bar", size = [0.12, 0.12, 0.06], cells = [12, 12, 6], element = "tet4" } }], fixed = "2" }"#,
    periods: [98, 60],
    counted_from: 0,
    is_promised: true,
};

/// The tool of the surgical scene stays where it is, until the organ hangs still. Its 2,075 finest points leave less to save than the block's, and what
/// is saved and what it costs are printed.
const LIVER: Poke = Poke {
    name: "adaptive_saving_liver",
    scene: "surgical",
    force: "tool",
    settings: &[
        "shapes.tool.motion.times=[0, 0.4, 0.7, 6, 6.3]",
        "run.duration=\"7 s\"",
        // which levels that are fixed do not have
        "probes.variation.quantity=\"levels.active\"",
    ],
    all_fine: r#"bodies.liver.levels={ count = 3, ratio = 1.8, fixed = "2", dress = { blend = "200 ms" } }"#,
    periods: [250, 80],
    // the tool stands where it is held from 0.7 s on
    counted_from: 70,
    is_promised: false,
};

/// What is read while the tool is held.
struct Held {
    /// Points that move by themselves, the most since they count.
    active: f64,
    /// Force of the tool [N].
    force: [f64; 3],
    /// Points of the surface [m].
    surface: Vec<[f64; 3]>,
    size: f64,
    bytes: usize,
}

impl Poke {
    fn hold(&self, more: &[&str], periods: u32) -> Result<Held, String> {
        let settings: Vec<String> = self.settings.iter().chain(more).map(|text| (*text).to_owned()).collect();
        let scene = scene(self.scene, &settings)?;
        let (bodies, probes) = (scene.bodies, scene.probes);
        let body = bodies.first().ok_or("the scene has no body")?;
        let mut world: World = scene.model.start(scene.state);
        let numbers = |name: &str, world: &mut World| -> Result<Vec<f64>, String> {
            let probe = probes.iter().find(|probe| probe.name == name).ok_or("the probe is missing")?;
            let measured: Measurement = probe.measure(world);
            Ok(measured.numbers())
        };
        let mut active = 0.0_f64;
        for period in 0..periods {
            world.step().map_err(|error| error.to_string())?;
            if period >= self.counted_from {
                active = active.max(numbers("active", &mut world)?[0]);
            }
        }
        let force = numbers(self.force, &mut world)?;
        let rows = &world.rows(body.system).positions[body.rows.clone()];
        Ok(Held {
            active,
            force: [force[0], force[1], force[2]],
            surface: body
                .surface
                .surface
                .mesh_points
                .iter()
                .map(|point| rows[*point as usize].to_array())
                .collect(),
            size: body.mesh.bounds().diagonal(),
            bytes: world.bytes(),
        })
    }

    /// All fine over adaptive, and what that costs: the errors of the force, and of the surface over the size of the body.
    fn figures(&self, effort: Effort) -> Result<[Figure; 3], String> {
        let [still, quick] = self.periods;
        let periods = effort.choose(quick, still);
        let adaptive = self.hold(&[], periods)?;
        let fine = self.hold(&[self.all_fine], periods)?;
        let force = distance(adaptive.force, fine.force) / distance(fine.force, [0.0; 3]);
        let surface = adaptive.surface.iter().zip(&fine.surface).map(|(a, b)| distance(*a, *b));
        let surface = surface.fold(0.0, f64::max) / fine.size;
        let saving = Figure {
            by_processor: None,
            name: self.name.to_owned(),
            value: fine.active / adaptive.active,
            unit: "active points all-fine / adaptive",
            higher_is_better: true,
            error: force,
            error_of: "tool force, against all fine".to_owned(),
            baseline: self.is_promised.then_some(10.0),
            threads: 1,
            samples: 1,
            spread: 0.0,
            bytes: adaptive.bytes,
        };
        let cost = |what: &str, error: f64, most: f64| Figure {
            name: format!("{}_{what}", self.name),
            value: error,
            unit: "x all fine",
            higher_is_better: false,
            error,
            error_of: format!("{what}, against all fine"),
            baseline: self.is_promised.then_some(most),
            ..saving.clone()
        };
        let (force, surface) = (cost("force", force, 0.05), cost("surface", surface, 0.02));
        Ok([saving, force, surface])
    }
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
}

/// Of a block, and of the liver.
pub fn adaptive_saving(effort: Effort) -> Result<Vec<Figure>, String> {
    let mut all = Vec::new();
    for poke in [BLOCK, LIVER] {
        all.extend(poke.figures(effort)?);
    }
    Ok(all)
}

/// V-07: what the rod of particles that is struck and calms takes, over the finest level alone and over the coarse one.
pub fn octree_rod(effort: Effort) -> Result<Vec<Figure>, String> {
    let periods = effort.choose(200, 1000);
    let variants = ["fixed=\"1\"", "fixed=\"0\"", ""];
    let settings = variants.map(|level| {
        let level = Some(level).filter(|level| !level.is_empty());
        let level = level.map(|level| format!("bodies.rod.octree.{level}"));
        STRUCK_ROD.iter().map(|text| (*text).to_owned()).chain(level).collect::<Vec<String>>()
    });
    let timed = in_turn("octree_rod", &settings, periods, effort.choose(1, 3))?;
    let tip = |settings: &[String]| value_of(scene("octree_rod", settings)?, periods as u64, "tip", 2);
    let error = tip(&settings[2])? / tip(&settings[0])? - 1.0;
    let [finest, coarse, adaptive] = timed.as_slice() else { return Ok(Vec::new()) };
    let held = |baseline| timing::Held {
        error: error.abs(),
        error_of: "sag, against the finest level".to_owned(),
        baseline: Some(baseline),
    };
    Ok(vec![
        adaptive.times_as_fast("octree_rod_finest", finest, &held(6.0)),
        // as fast as the coarse level but for two fifths
        adaptive.times_as_fast("octree_rod_coarse", coarse, &held(1.0 / 1.4)),
    ])
}

/// The organ of particles with the finest everywhere (V-08): time of computing over the time of the world, on one thread; the share of time above one
/// beside it.
pub fn octree_in_time(effort: Effort) -> Result<Vec<Figure>, String> {
    let scene = scene("octree_liver", &[r#"bodies.liver.octree.fixed="2""#.to_owned()])?;
    let mut world: World = scene.model.start(scene.state);
    let periods = effort.choose(20, 200);
    with_threads(1, || {
        let (mut seconds, mut processor) = (Vec::new(), Vec::new());
        let period = world.model().period;
        for _ in 0..periods {
            let clock = Clock::start();
            world.step().map_err(|error| error.to_string())?;
            clock.stop(&mut seconds, &mut processor, 1);
        }
        let load = |samples: &[f64]| samples.iter().sum::<f64>() / (samples.len() as f64 * period);
        let late = seconds.iter().filter(|taken| **taken > period).count();
        Ok(vec![Figure {
            name: "octree_in_time".to_owned(),
            value: load(&seconds),
            by_processor: (!processor.is_empty()).then(|| load(&processor)),
            unit: "time of computing / time of the world",
            higher_is_better: false,
            error: late as f64 / seconds.len() as f64,
            error_of: "share of its periods that took longer than they are".to_owned(),
            baseline: Some(1.0),
            threads: 1,
            samples: seconds.len(),
            spread: 0.0,
            bytes: world.bytes(),
        }])
    })?
}

/// The share of a period that the dress of the organ takes while it is poked (V-40).
pub fn dress_share(effort: Effort) -> Result<Vec<Figure>, String> {
    let scene = scene("surgical", &[])?;
    let mut world: World = scene.model.start(scene.state);
    let periods = effort.choose(20, 130);
    for _ in 0..periods {
        world.step().map_err(|error| error.to_string())?;
    }
    Ok(vec![Figure {
        name: "dress_share".to_owned(),
        value: world.stages().fields / world.time(),
        by_processor: None,
        unit: "time of the surface / time of the world",
        higher_is_better: false,
        error: 0.0,
        error_of: String::new(),
        baseline: Some(0.1),
        threads: rayon::current_num_threads(),
        samples: periods,
        spread: 0.0,
        bytes: world.bytes(),
    }])
}

#[cfg(test)]
mod tests {
    use super::{BLOCK, LIVER, scene};

    /// Scenes change, and what is set here must go on fitting them.
    #[test]
    fn scenes_take_what_is_set() {
        for poke in [BLOCK, LIVER] {
            for more in [&[][..], &[poke.all_fine]] {
                let settings: Vec<String> =
                    poke.settings.iter().chain(more).map(|setting| (*setting).to_owned()).collect();
                let taken = scene(poke.scene, &settings).map(|scene| scene.probes.len());
                assert!(taken.is_ok_and(|probes| probes > 0), "{} with {settings:?}", poke.scene);
            }
        }
    }
}
