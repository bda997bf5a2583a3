//! How well the loop of the devices keeps its time, beside worlds that an emulated hand pokes.

use souple_run::{Control, Histogram, InTime, Options, Session, run_in_time};
use souple_scene::spec::expect::{Bound, Expect};

use super::timing::scene;
use super::{Effort, Figure};
use crate::cases::tools::SELDOM;

/// Seconds on the clock.
const QUICK: f64 = 2.0;
const FULL: f64 = 60.0;
/// Of V-36 [s].
const TEN_MINUTES: f64 = 600.0;
/// The hand that never rests, so that points come and go all the time: three centimetres in and out every three seconds.
const RESTLESS: &str = r#"hands.right.motion={ formula = [0, 0, "-0.03 * (1 - cos(2*pi*t/3))"] }"#;
/// What the organ may do in a period of 10 ms, which V-36 asks about.
const TEN_TIMES_THE_BUDGET: &str = "bodies.liver.levels.budget=500000";
/// 34,992 tetrahedra.
const CELLS_18: &str = "bodies.block.mesh.cells=[18, 18, 18]";
/// Of the devices' loop [s].
const TICK: f64 = 1e-3;
/// A period that is still one of a millisecond [s].
const IN_TIME: f64 = 1.2e-3;
/// What V-42 allows a period to be off [s].
const JITTER: f64 = 0.2e-3;
/// What V-42 allows a force to be old [s].
const AGE: f64 = 2.5e-3;

struct Kept {
    run: InTime,
    /// Of the world [s].
    period: f64,
    /// The most that the force on the hand may change by in a tick, as the scene has it [N].
    most_jump: Option<f64>,
    bytes: usize,
}

fn keep(name: &str, settings: &[&str], duration: f64) -> Result<Kept, String> {
    let settings: Vec<String> = settings.iter().map(|setting| (*setting).to_owned()).collect();
    let scene = scene(name, &settings)?;
    let most_jump = scene.expects.iter().find(|expect| expect.probe == "jump").and_then(most);
    let mut session = Session::start(scene, &Options::default()).map_err(|error| error.to_string())?;
    let (bytes, period) = (session.world.bytes(), session.world.model().period);
    let run =
        run_in_time(&mut session, duration, &mut |_| Control::Continue).map_err(|error| error.to_string())?;
    match &session.failure {
        Some(failure) => Err(failure.message()),
        None => Ok(Kept { run, period, most_jump, bytes }),
    }
}

/// What an expectation is not to exceed.
fn most(expect: &Expect) -> Option<f64> {
    match expect.bound {
        Bound::Between { max, .. } => Some(max),
        Bound::Near { .. } | Bound::NearVector { .. } => None,
    }
}

/// The greatest change of the force on the hand from tick to tick, held against what the scene states of its run without a clock; beside it the
/// share of ticks that changed it by more.
fn jump(name: &str, kept: &Kept) -> Figure {
    let served = &kept.run.served;
    let changes = served.ticks[0].windows(2).map(|pair| (pair[1].force - pair[0].force).length());
    let bound = kept.most_jump.unwrap_or(f64::INFINITY);
    let above = changes.filter(|change| *change > bound).count();
    Figure {
        value: served.ports[0].jump,
        unit: "N from tick to tick of the devices' loop, at most",
        error: above as f64 / served.ticks[0].len().max(1) as f64,
        error_of: "share of ticks above what the scene states".to_owned(),
        baseline: kept.most_jump,
        samples: served.ticks[0].len(),
        ..load(name, kept)
    }
}

/// What the periods of the world took of their time; the error is the share of periods that came late.
fn load(name: &str, kept: &Kept) -> Figure {
    let world = &kept.run.world;
    Figure {
        name: name.to_owned(),
        value: world.loads.iter().sum::<f64>() / world.loads.len().max(1) as f64,
        unit: "time of computing / time of the world",
        higher_is_better: false,
        error: world.late as f64 / world.periods.max(1) as f64,
        error_of: "share of its periods that came late".to_owned(),
        baseline: Some(1.0),
        threads: rayon::current_num_threads(),
        samples: world.loads.len(),
        spread: 0.0,
        bytes: kept.bytes,
        by_processor: None,
    }
}

/// The load that this share of periods does not exceed.
fn quantile(share: f64, kept: &Kept) -> f64 {
    let mut loads = kept.run.world.loads.clone();
    loads.sort_by(f64::total_cmp);
    let at = ((loads.len() as f64 * share) as usize).min(loads.len().saturating_sub(1));
    loads.get(at).copied().unwrap_or(0.0)
}

/// What the budget keeps below the whole time of the world, also while the hand presses.
fn worst(name: &str, kept: &Kept) -> Figure {
    Figure {
        value: quantile(0.99, kept),
        unit: "time of computing / time of the world, 99 % of periods below",
        ..load(name, kept)
    }
}

/// Periods in a row of which the budget gives way: it looks at two, and regroups in the third.
const IN_A_ROW: usize = 4;

/// The greatest load that so many periods in a row all have: a single one may be the clock's, these are what the budget has to keep below the whole time.
fn held(name: &str, kept: &Kept) -> Figure {
    let least = |loads: &[f64]| loads.iter().copied().fold(f64::INFINITY, f64::min);
    Figure {
        value: kept.run.world.loads.windows(IN_A_ROW).map(least).fold(0.0, f64::max),
        unit: "time of computing / time of the world, the most of the least of four periods in a row",
        ..load(name, kept)
    }
}

/// What nothing keeps: whether a body that does not adapt is in time period by period.
fn worst_of_thousand(name: &str, kept: &Kept) -> Figure {
    Figure {
        value: quantile(0.999, kept),
        unit: "time of computing / time of the world, 99.9 % of periods below",
        ..load(name, kept)
    }
}

/// Ten minutes of a hand that never rests (V-36): how far the world is from the clock at the end, in its periods, with the time that was given up;
/// and its loads, with the share of periods that came late, and the greatest that it held for four periods (DEB-39).
pub fn ten_minutes(effort: Effort) -> Result<Vec<Figure>, String> {
    let settings = [&[RESTLESS, TEN_TIMES_THE_BUDGET], &SELDOM[..]].concat();
    let liver = keep("hand_on_liver", &settings, effort.choose(QUICK, TEN_MINUTES))?;
    let world = &liver.run.world;
    Ok(vec![
        Figure {
            name: "real_time_drift".to_owned(),
            // what was given up is behind too
            value: (world.drift + world.lost).abs() / liver.period,
            unit: "periods of the world that the clock is ahead at the end",
            error: world.lost,
            error_of: "s given up".to_owned(),
            ..load("", &liver)
        },
        Figure { baseline: Some(1e-3), ..late("real_time_late", &liver) },
        load("real_time_load", &liver),
        worst("real_time_load_99", &liver),
        held("real_time_load_held", &liver),
    ])
}

/// How old what the force says of the body is when the next one comes, and how long after the device was somewhere comes the force that answers to
/// that; the error is the share of forces that are older than V-42 allows.
fn ages(of_body: &str, of_answer: &str, kept: &Kept) -> [Figure; 2] {
    let ages = &kept.run.served.ages[0];
    let figure = |name: &str, ages: &Histogram, unit| Figure {
        name: name.to_owned(),
        value: 1e3 * ages.quantile(0.999),
        unit,
        higher_is_better: false,
        error: 1.0 - ages.share_within(AGE),
        error_of: "share of forces above 2.5 ms".to_owned(),
        baseline: Some(1e3 * AGE),
        samples: ages.count() as usize,
        ..load("", kept)
    };
    [
        figure(
            of_body,
            &ages.of_body,
            "ms from the body to the end of what the force says of it, 99.9 % below",
        ),
        figure(
            of_answer,
            &ages.of_answer,
            "ms from the device to the force that answers to it, 99.9 % below",
        ),
    ]
}

/// The share of periods that came late; the error is that of periods above 95 % of their time.
fn late(name: &str, kept: &Kept) -> Figure {
    let world = &kept.run.world;
    let above = world.loads.iter().filter(|load| **load > 0.95).count();
    Figure {
        value: world.late as f64 / world.periods.max(1) as f64,
        unit: "share of its periods that came late",
        error: above as f64 / world.loads.len().max(1) as f64,
        error_of: "share of its periods with a load above 95 %".to_owned(),
        ..load(name, kept)
    }
}

/// The period that 99.9 % do not exceed, the greatest change of the force, and what the worlds needed of their time; the error beside the first is the share
/// of periods above 1.2 ms, that beside the loads the share of periods of the world that came late.
pub fn period(effort: Effort) -> Result<Vec<Figure>, String> {
    let duration = effort.choose(QUICK, FULL);
    let liver = keep("hand_on_liver", &[], duration)?;
    let block = keep("hand_on_block", &[CELLS_18], duration)?;
    let periods = &liver.run.served.toll.periods;
    let threads = rayon::current_num_threads();
    let mut figures = vec![
        Figure {
            name: "haptic_period_99_9".to_owned(),
            value: 1e3 * periods.quantile(0.999),
            unit: "ms",
            higher_is_better: false,
            error: 1.0 - periods.share_within(IN_TIME),
            error_of: "share of periods above 1.2 ms".to_owned(),
            baseline: Some(1e3 * IN_TIME),
            threads,
            samples: periods.count() as usize,
            spread: (periods.quantile(0.75) - periods.quantile(0.25)) / (2.0 * periods.quantile(0.5)),
            bytes: liver.bytes,
            by_processor: None,
        },
        Figure {
            name: "haptic_jitter_99_9".to_owned(),
            value: 1e3 * periods.jitter(TICK, 0.999),
            unit: "ms off a millisecond, 99.9 % of periods below",
            higher_is_better: false,
            error: 1e3 * periods.jitter(TICK, 1.0),
            error_of: "ms off at most".to_owned(),
            baseline: Some(1e3 * JITTER),
            threads,
            samples: periods.count() as usize,
            spread: 0.0,
            bytes: liver.bytes,
            by_processor: None,
        },
        jump("haptic_jump_liver", &liver),
        load("haptic_load_liver", &liver),
        worst("haptic_load_liver_99", &liver),
        load("haptic_load_block_30k", &block),
        worst_of_thousand("haptic_load_block_30k_99_9", &block),
    ];
    figures.extend(ages("haptic_age_99_9", "haptic_answer_99_9", &liver));
    figures.extend(ages("haptic_age_block_30k_99_9", "haptic_answer_block_30k_99_9", &block));
    Ok(figures)
}
