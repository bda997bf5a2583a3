//! What is doubtful of a run that is over: values that are no numbers.

use souple_table::counted;

use crate::Trace;

/// Probes that read what is no number or has no end, and since when.
pub fn of_traces(traces: &[Trace]) -> Vec<String> {
    let doubt = |trace: &Trace| {
        let is_number = |step: &usize| trace.value(*step).is_some_and(|v| v.iter().all(|v| v.is_finite()));
        let steps = trace.times.len();
        let first = (0..steps).find(|step| !is_number(step))?;
        let lost = (first..steps).filter(|step| !is_number(step)).count();
        Some(format!(
            "probe `{}` is no number at {lost} of {}, first at {:.6} s: there is no {} then, or nothing that it can be read off",
            trace.name,
            counted(steps as u64, "time"),
            trace.times[first],
            trace.quantity,
        ))
    };
    traces.iter().filter_map(doubt).collect()
}
