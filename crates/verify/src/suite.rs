//! Many cases: several at once, and those that read the same runs on one of each.

use std::collections::HashMap;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use crate::Row;
use crate::bench::with_threads;
use crate::case::Case;
use crate::runs::{RunKey, Runs};

/// Rows in the order of their cases, told in that order as soon as those before are.
struct Rows<'a> {
    rows: Vec<Option<Row>>,
    told: usize,
    tell: &'a mut (dyn FnMut(&Row) + Send),
}

impl Rows<'_> {
    fn add(&mut self, place: usize, row: Row) {
        self.rows[place] = Some(row);
        while let Some(Some(row)) = self.rows.get(self.told) {
            (self.tell)(row);
            self.told += 1;
        }
    }
}

/// Runs cases, `jobs` at once, under their mutations where that is wished. What is measured does not depend on their number: cases that
/// measure time come last, one after the other.
///
/// # Errors
/// Threads cannot be made.
pub fn run(
    cases: &[&Case],
    are_mutated: bool,
    jobs: usize,
    tell: &mut (dyn FnMut(&Row) + Send),
) -> Result<Vec<Row>, String> {
    let (timed, units): (Vec<_>, Vec<_>) = units(cases, are_mutated)
        .into_iter()
        .partition(|unit| unit.iter().any(|place| cases[*place].reading.measures_time()));
    let cores = rayon::current_num_threads();
    let jobs = jobs.clamp(1, units.len().max(1));
    let rows = Mutex::new(Rows { rows: vec![None; cases.len()], told: 0, tell });
    let make = |unit: &[usize]| {
        let mut runs = Runs::default();
        for place in unit {
            let row = cases[*place].run_with(&mut runs, are_mutated);
            rows.lock().unwrap_or_else(PoisonError::into_inner).add(*place, row);
        }
    };
    let next = AtomicUsize::new(0);
    let work = || {
        with_threads((cores / jobs).max(1), || {
            while let Some(unit) = units.get(next.fetch_add(1, Ordering::Relaxed)) {
                make(unit);
            }
        })
    };
    std::thread::scope(|scope| {
        let workers: Vec<_> = (0..jobs).map(|_| scope.spawn(work)).collect();
        let ended = workers.into_iter().map(|worker| match worker.join() {
            Ok(ended) => ended,
            Err(panic) => std::panic::resume_unwind(panic),
        });
        ended.collect::<Result<Vec<()>, String>>()
    })?;
    timed.iter().for_each(|unit| make(unit));
    let rows = rows.into_inner().unwrap_or_else(PoisonError::into_inner).rows;
    Ok(rows.into_iter().flatten().collect())
}

/// Places of cases that read the same runs, in the order of the first of them.
fn units(cases: &[&Case], are_mutated: bool) -> Vec<Vec<usize>> {
    let mut units: Vec<Vec<usize>> = Vec::new();
    let mut known: HashMap<Vec<RunKey>, usize> = HashMap::new();
    for (place, case) in cases.iter().enumerate() {
        let keys = case.run_keys(are_mutated);
        match known.get(&keys) {
            Some(unit) if !keys.is_empty() => units[*unit].push(place),
            _ => {
                known.insert(keys, units.len());
                units.push(vec![place]);
            }
        }
    }
    units
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows come in the order of their cases at any number of jobs, with the same numbers; a run that two read is made once.
    #[test]
    fn cases_are_run_at_once() {
        let scene = "network_free_fall";
        let cases: Vec<&Case> = crate::all().filter(|case| case.scene == scene).collect();
        assert!(cases.len() > 1, "{scene} is read by one case");
        let units = units(&cases, false);
        assert!(units.len() < cases.len(), "{units:?}");
        let with = |jobs: usize| {
            let mut told = Vec::new();
            let rows = run(&cases, false, jobs, &mut |row| told.push(row.case.id)).expect("threads");
            assert_eq!(told, cases.iter().map(|case| case.id).collect::<Vec<_>>());
            rows.iter().map(|row| row.measured.to_bits()).collect::<Vec<u64>>()
        };
        let (one, three) = (with(1), with(3));
        assert_eq!(one, three);
        assert_eq!(one, cases.iter().map(|case| case.run().measured.to_bits()).collect::<Vec<u64>>());
    }
}
