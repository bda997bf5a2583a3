//! How well the loop of the devices keeps its time, beside worlds that an emulated hand pokes.

use souple_run::{Control, InTime, Options, Session, run_in_time};

use super::timing::scene;
use super::{Effort, Figure};

/// Seconds on the clock.
const QUICK: f64 = 2.0;
const FULL: f64 = 60.0;
/// A period that is still one of a millisecond [s].
const IN_TIME: f64 = 1.2e-3;

struct Kept {
    run: InTime,
    bytes: usize,
}

fn keep(name: &str, duration: f64) -> Result<Kept, String> {
    let mut session =
        Session::start(scene(name, &[])?, &Options::default()).map_err(|error| error.to_string())?;
    let bytes = session.world.bytes();
    let run =
        run_in_time(&mut session, duration, &mut |_| Control::Continue).map_err(|error| error.to_string())?;
    match &session.failure {
        Some(failure) => Err(failure.message()),
        None => Ok(Kept { run, bytes }),
    }
}

/// The period that 99.9 % do not exceed, and what the worlds needed of their time; the error beside the first is the share
/// of periods above 1.2 ms, that beside the loads the share of periods of the world that came late.
pub fn period(effort: Effort) -> Result<Vec<Figure>, String> {
    let duration = effort.choose(QUICK, FULL);
    let liver = keep("hand_on_liver", duration)?;
    let block = keep("hand_on_block", duration.min(10.0))?;
    let periods = &liver.run.served.toll.periods;
    let threads = rayon::current_num_threads();
    let load = |name: &str, kept: &Kept| {
        let world = &kept.run.world;
        Figure {
            name: name.to_owned(),
            value: world.loads.iter().sum::<f64>() / world.loads.len().max(1) as f64,
            unit: "time of computing / time of the world",
            higher_is_better: false,
            error: world.late as f64 / world.periods.max(1) as f64,
            error_of: "share of its periods that came late".to_owned(),
            baseline: Some(1.0),
            threads,
            samples: world.loads.len(),
            spread: 0.0,
            bytes: kept.bytes,
            by_processor: None,
        }
    };
    // what the budget keeps below the whole time of the world, also while the hand presses
    let worst = |name: &str, kept: &Kept| {
        let mut loads = kept.run.world.loads.clone();
        loads.sort_by(f64::total_cmp);
        let at = ((loads.len() as f64 * 0.99) as usize).min(loads.len().saturating_sub(1));
        Figure {
            value: loads.get(at).copied().unwrap_or(0.0),
            unit: "time of computing / time of the world, 99 % of periods below",
            ..load(name, kept)
        }
    };
    Ok(vec![
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
        load("haptic_load_liver", &liver),
        worst("haptic_load_liver_99", &liver),
        load("haptic_load_block_30k", &block),
    ])
}
