//! Networks: links that a core updates in a second, what of the memory's bandwidth that takes, and how fast a string
//! sounds.

use super::timing::{Held, Timing, Triad, as_it_is, scene};
use super::{Effort, Figure, value_of};

/// Steps in a period of the world: what is done once a period is shared by them.
const STEPS_PER_PERIOD: usize = 10;

/// Bytes that a step must move for a link: two ends and a rest length.
const BYTES_OF_LINK: usize = 16;
/// The same for a mass: place and velocity read; the sum of forces cleared, added to and read; place and velocity moved on.
const BYTES_OF_MASS: usize = 2 * 24 + 4 * 24 + 4 * 24 + 8;

/// A cubic lattice of `n` masses along each edge, whose halves run into each other.
fn lattice(n: usize) -> Vec<String> {
    let half = n / 2;
    let group = |name: &str, planes: usize, below: usize| {
        let height = 0.1 * below as f64;
        format!(
            "networks.lattice.masses.{name}.lattice={{ origin = [0, 0, {height}], spacing = 0.1, counts = [{n}, {n}, {planes}] }}"
        )
    };
    vec![
        group("lower", half, 0),
        group("upper", n - half, half),
        r#"networks.lattice.links=[{ law = { name = "spring_damper", stiffness = 100, damping = 0.002 }, reach = 0.101 }]"#
            .to_owned(),
        format!("systems.main.steps_per_period={STEPS_PER_PERIOD}"),
    ]
}

pub fn springs_lattice(name: &str, n: usize, wanted: f64, effort: Effort) -> Result<Vec<Figure>, String> {
    // momentum is kept to rounding, whatever the links do
    let small = lattice(11);
    let momentum = |steps| value_of(scene("network_lattice", &small)?, steps, "momentum", 0);
    let error = (momentum(100)? / momentum(1)? - 1.0).abs();
    // of a core; what several share is told
    let held = |threads: usize| Held {
        error,
        error_of: "momentum after 1000 steps of 11 masses along each edge".to_owned(),
        baseline: (threads == 1).then_some(wanted),
    };
    let timing = Timing {
        scene: "network_lattice",
        settings: &lattice(n),
        prepare: as_it_is,
        warm_up: 1,
        samples: effort.choose(5, 20),
        steps_per_sample: 1,
    };
    let mut figures = Vec::new();
    for timed in timing.run()? {
        let own = timed.in_parts(STEPS_PER_PERIOD);
        let moved = own.cells * BYTES_OF_LINK + n.pow(3) * BYTES_OF_MASS;
        let triad = super::timing::with_threads(own.threads, Triad::measured)?;
        let told = Held { error: 0.0, error_of: String::new(), baseline: None };
        figures.push(own.links_per_second(name, &held(own.threads)));
        figures.push(own.gigabytes_per_second(&format!("{name}_bandwidth"), moved, &told));
        figures.push(own.share_of_triad(&format!("{name}_share"), moved, &triad, &told));
    }
    Ok(figures)
}

/// A thousand masses between two that are held, each linked to the next and the one after that: 2,001 links along an axis.
const LONG_STRING: [&str; 4] = [
    "networks.string.masses.ends.positions=[[0, 0, 0], [1.001, 0, 0]]",
    "networks.string.masses.string.line={ from = [0.001, 0, 0], to = [1, 0, 0], count = 1000 }",
    "networks.string.masses.string.drag=0",
    r#"networks.string.links=[{ law = { name = "spring_damper", stiffness = 6000, damping = 1e-3 }, along = [0, 0, 1], reach = 0.00201 }]"#,
];

/// How much faster it must be than it sounds.
const REAL_TIMES: f64 = 3.0;

/// `A cos(ω (n + ½) Te)/cos(ω Te/2)` of the lowest mode of ten masses where `vibrating_modes` measures it, `n = 1000` [m].
const LOWEST_MODE: f64 = 0.000_607_595_779_866_530_6;

/// How much faster a string is computed than it sounds.
pub fn string_audio(name: &str, effort: Effort) -> Result<Vec<Figure>, String> {
    let modes = scene("vibrating_modes", &[])?;
    let settings = LONG_STRING.map(str::to_owned).to_vec();
    let timing = Timing {
        scene: "string",
        settings: &settings,
        prepare: as_it_is,
        warm_up: 100,
        samples: effort.choose(5, 20),
        // a tenth of a second of sound
        steps_per_sample: 4410,
    };
    let error = (value_of(modes, 1000, "line", 0)? / LOWEST_MODE - 1.0).abs();
    let held = |baseline| Held {
        error,
        error_of: "the lowest mode of ten masses after 1000 steps".to_owned(),
        baseline: Some(baseline),
    };
    let period = scene("string", &settings)?.model.period;
    let timed = super::timing::with_threads(1, || timing.sample(1))??;
    let step = timed.microseconds_per_step(&format!("{name}_step"), &held(1e6 * period / REAL_TIMES));
    Ok(vec![timed.times_real_time(name, period, &held(REAL_TIMES)), step])
}
