//! What a run against the clock leaves: its report, what each hand did and felt, how well the loop kept its time.

use std::fs;
use std::path::Path;

use serde_json::{Value, json};
use souple_haptics::{Ages, Histogram, TICK, Tick};
use souple_io::plot::{Axis, Curve, Plot, Scale};
use souple_io::{Column, IoError};
use souple_math::Vec3;

use crate::{InTime, Session, write_csv};

/// A period of the loop that is still one of a millisecond [s].
const IN_TIME: f64 = 1.2 * TICK;

fn quantile(sorted: &[f64], share: f64) -> f64 {
    let last = sorted.len().saturating_sub(1);
    sorted.get((share * last as f64).round() as usize).copied().unwrap_or(0.0)
}

/// `wanted`: how long each is to be [s].
fn of_periods(periods: &Histogram, wanted: f64) -> Value {
    json!({
        "count": periods.count(),
        "mean_ms": 1e3 * periods.mean(),
        "p50_ms": 1e3 * periods.quantile(0.5),
        "p99_ms": 1e3 * periods.quantile(0.99),
        "p99_9_ms": 1e3 * periods.quantile(0.999),
        "longest_ms": 1e3 * periods.longest(),
        "jitter_99_9_ms": 1e3 * periods.jitter(wanted, 0.999),
        "share_within_1_2_ms": periods.share_within(IN_TIME),
        "histogram": periods.bins().iter().map(|(end, count)| json!([1e3 * end, count])).collect::<Vec<_>>(),
    })
}

fn of_ages(ages: &Histogram) -> Value {
    json!({
        "mean_ms": 1e3 * ages.mean(),
        "p50_ms": 1e3 * ages.quantile(0.5),
        "p99_ms": 1e3 * ages.quantile(0.99),
        "p99_9_ms": 1e3 * ages.quantile(0.999),
        "greatest_ms": 1e3 * ages.longest(),
    })
}

/// Less than the limit by this part, a force is at it: it is the length of a vector that was shortened to it.
const AT_LIMIT: f64 = 1e-9;

/// `limit`: of the force [N].
fn of_hand(ticks: &[Tick], limit: f64, jump: f64, refused: u64, ages: &Ages) -> Value {
    let share = |counts: &dyn Fn(&&Tick) -> bool| {
        ticks.iter().filter(counts).count() as f64 / ticks.len().max(1) as f64
    };
    let first_lost = ticks.iter().find(|tick| tick.is_lost).map(|tick| tick.time);
    let greatest = ticks.iter().map(|tick| tick.force.length()).fold(0.0, f64::max);
    let least_energy = ticks.iter().map(|tick| tick.energy).fold(0.0, f64::min);
    json!({
        "ticks": ticks.len(),
        "greatest_force_n": greatest,
        "greatest_jump_n": jump,
        "limit_n": limit,
        "share_at_limit": share(&|tick| tick.force.length() >= limit * (1.0 - AT_LIMIT)),
        "share_lost": share(&|tick| tick.is_lost),
        "first_lost_seconds": first_lost,
        "least_energy_j": least_energy,
        "energy_j": ticks.last().map_or(0.0, |tick| tick.energy),
        "refused": refused,
        "age": of_ages(&ages.of_body),
        "answer": of_ages(&ages.of_answer),
    })
}

impl InTime {
    /// The report.
    pub fn to_json(&self, session: &Session) -> Value {
        let (world, toll, stages) = (&self.world, &self.served.toll, self.world.stages);
        let mut loads = world.loads.clone();
        loads.sort_by(f64::total_cmp);
        let mean = loads.iter().sum::<f64>() / loads.len().max(1) as f64;
        let period = session.world.model().period;
        let computing = (loads.iter().sum::<f64>() * period).max(f64::MIN_POSITIVE);
        let served = &self.served;
        let felt = served.ticks.iter().zip(&served.ports).zip(&served.refused).zip(&served.ages);
        let hands = session.hands.iter().zip(felt).map(|(hand, (((ticks, port), refused), ages))| {
            let limit = hand.port.coupling.limit;
            (hand.name.clone(), of_hand(ticks, limit, port.jump, *refused, ages))
        });
        let status = match &session.failure {
            Some(_) => "failed",
            None if self.was_stopped => "interrupted",
            None => "done",
        };
        json!({
            "version": env!("CARGO_PKG_VERSION"),
            "status": status,
            "scene": session.scene_name,
            "scene_sha256": session.scene_sha256,
            "failure": session.failure.as_ref().map(crate::Failure::message),
            "warnings": session.warnings,
            "devices": {
                "priority": toll.priority,
                "periods": of_periods(&toll.periods, TICK),
                "left_out": toll.left_out,
                "load": toll.busy / (toll.periods.count().max(1) as f64 * toll.periods.mean()).max(TICK),
            },
            "hands": hands.collect::<serde_json::Map<String, Value>>(),
            "world": {
                "priority": world.priority,
                "periods": world.periods,
                "seconds_between_measures": world.between_measures,
                "simulated_seconds": world.periods as f64 * period,
                "load": {
                    "mean": mean,
                    "p50": quantile(&loads, 0.5),
                    "p99": quantile(&loads, 0.99),
                    "greatest": loads.last(),
                    "share_above_95_percent":
                        loads.iter().filter(|load| **load > 0.95).count() as f64 / loads.len().max(1) as f64,
                },
                "late": world.late,
                "lost_seconds": world.lost,
                "drift_seconds": world.drift,
                // of the time of computing: what is inside, what touches and what follows
                "shares": {
                    "pairs": stages.pairs / computing,
                    "forces": stages.forces / computing,
                    "solve": (stages.assembly + stages.solve) / computing,
                    "advance": stages.advance / computing,
                    "fields": stages.fields / computing,
                    "rest": 1.0 - stages.total() / computing,
                },
                "budgets_set": world.budgets,
                "begun": of_periods(&world.begun, period),
            },
        })
    }

    /// Writes `report.json`, `probes.csv`, and for each hand `hand_NAME.csv` and its force as `hand_NAME.svg`; the periods of
    /// the loop as `periods.svg`.
    ///
    /// # Errors
    /// A file or the folder cannot be written.
    pub fn write(&self, folder: &Path, session: &Session) -> Result<(), IoError> {
        fs::create_dir_all(folder).map_err(|source| IoError::Write { path: folder.to_owned(), source })?;
        let report = format!("{:#}\n", self.to_json(session));
        souple_io::write_file(&folder.join("report.json"), |out| out.write_all(report.as_bytes()))?;
        write_csv(&folder.join("probes.csv"), &self.traces)?;
        for (hand, ticks) in session.hands.iter().zip(&self.served.ticks) {
            write_ticks(&folder.join(format!("hand_{}.csv", hand.name)), ticks)?;
            force_plot(&hand.name, ticks).write_svg(&folder.join(format!("hand_{}.svg", hand.name)))?;
        }
        periods_plot(&self.served.toll.periods).write_svg(&folder.join("periods.svg"))
    }
}

fn write_ticks(path: &Path, ticks: &[Tick]) -> Result<(), IoError> {
    let numbers = |of: &dyn Fn(&Tick) -> f64| ticks.iter().map(of).collect::<Vec<f64>>();
    let mut columns = vec![Column::new("time [s]", numbers(&|tick| tick.time))];
    let mut vector = |name: &str, unit: &str, of: fn(&Tick) -> Vec3| {
        for (axis, letter) in ["x", "y", "z"].into_iter().enumerate() {
            columns.push(Column::new(format!("{name}.{letter} [{unit}]"), numbers(&|tick| of(tick)[axis])));
        }
    };
    vector("device", "m", |tick| tick.device);
    vector("tool", "m", |tick| tick.tool);
    vector("force", "N", |tick| tick.force);
    columns.push(Column::new("energy [J]", numbers(&|tick| tick.energy)));
    souple_io::write_csv(path, &columns)
}

fn force_plot(hand: &str, ticks: &[Tick]) -> Plot {
    let times: Vec<f64> = ticks.iter().map(|tick| tick.time).collect();
    let curve = |(axis, name): (usize, &str)| {
        Curve::new(name, times.clone(), ticks.iter().map(|tick| tick.force[axis]).collect())
    };
    Plot {
        title: format!("force on hand {hand}"),
        x: Axis::new("time", "s"),
        y: Axis::new("force", "N"),
        curves: ["x", "y", "z"].into_iter().enumerate().map(curve).collect(),
        ..Plot::default()
    }
}

fn periods_plot(periods: &Histogram) -> Plot {
    let (ends, counts) = periods.bins().into_iter().map(|(end, count)| (1e3 * end, count as f64)).unzip();
    Plot {
        title: "periods of the devices' loop".to_owned(),
        x: Axis::new("period", "ms"),
        y: Axis { scale: Scale::Logarithmic, ..Axis::new("count", "") },
        curves: vec![Curve { mark: souple_io::plot::Mark::DottedLine, ..Curve::new("", ends, counts) }],
        ..Plot::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of ten ticks three are at the limit, one of them up to rounding, and four without a device, the first at 6 ms.
    #[test]
    fn limits_and_losses_are_shares_of_ticks() {
        let tick = |number: u32| Tick {
            time: 1e-3 * f64::from(number),
            force: Vec3::new(
                0.0,
                [0.5, 1.0, 2.0, 2.0, 2.0 * (1.0 - 1e-12), 1.99][number.min(5) as usize],
                0.0,
            ),
            is_lost: number >= 6,
            ..Tick::default()
        };
        let ticks: Vec<Tick> = (0..10).map(tick).collect();
        let told = of_hand(&ticks, 2.0, 0.0, 0, &Ages::default());
        assert_eq!((told["limit_n"].as_f64(), told["greatest_force_n"].as_f64()), (Some(2.0), Some(2.0)));
        assert_eq!((told["share_at_limit"].as_f64(), told["share_lost"].as_f64()), (Some(0.3), Some(0.4)));
        assert_eq!(told["first_lost_seconds"].as_f64(), Some(6e-3));
        let told = of_hand(&ticks[..6], 20.0, 0.0, 0, &Ages::default());
        assert_eq!((told["share_at_limit"].as_f64(), told["share_lost"].as_f64()), (Some(0.0), Some(0.0)));
        assert!(told["first_lost_seconds"].is_null());
        assert_eq!(of_hand(&[], 2.0, 0.0, 0, &Ages::default())["share_lost"].as_f64(), Some(0.0));
    }
}
