//! What a probe read along a run.

use std::path::Path;

use souple_io::{Column, IoError};
use souple_scene::{Measurement, ProbeInfo};

use crate::spectrum::strongest_frequency;

/// The values of a probe, one for each step and one before the first.
#[derive(Clone, Debug, PartialEq)]
pub struct Trace {
    pub name: String,
    pub unit: &'static str,
    pub quantity: &'static str,
    /// The trace that its plot is over; over time where `None`.
    pub over: Option<String>,
    /// 1 or 3.
    pub components: usize,
    /// The date from which on extremes are taken [s].
    pub since: f64,
    /// [s]
    pub times: Vec<f64>,
    /// Value after value.
    pub values: Vec<f64>,
}

/// First, last and extreme values; of vectors component by component.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    pub name: String,
    pub unit: &'static str,
    pub first: Vec<f64>,
    pub last: Vec<f64>,
    pub min: Vec<f64>,
    pub max: Vec<f64>,
    /// When these were met first [s].
    pub min_at: Vec<f64>,
    pub max_at: Vec<f64>,
    /// Of vectors, the greatest length and when it was met first [s].
    pub longest: Option<(f64, f64)>,
    /// The strongest frequency of each [Hz]; `None` of what does not swing.
    pub frequency: Vec<Option<f64>>,
}

impl Trace {
    pub fn new(probe: &ProbeInfo) -> Self {
        Self {
            name: probe.name.clone(),
            unit: probe.unit,
            quantity: probe.quantity,
            over: probe.over.clone(),
            components: if probe.gives_vector() { 3 } else { 1 },
            since: probe.since,
            times: Vec::new(),
            values: Vec::new(),
        }
    }

    pub fn push(&mut self, time: f64, measurement: Measurement) {
        self.times.push(time);
        self.values.extend(measurement.numbers());
    }

    /// The value of a step, from 0.
    pub fn value(&self, step: usize) -> Option<&[f64]> {
        self.values.get(step * self.components..(step + 1) * self.components)
    }

    /// The last value.
    pub fn last(&self) -> Option<&[f64]> {
        self.value(self.times.len().checked_sub(1)?)
    }

    /// The time of the step nearest to a time, and the value there.
    pub fn at(&self, time: f64) -> Option<(f64, &[f64])> {
        let nearest = (0..self.times.len())
            .min_by(|a, b| (self.times[*a] - time).abs().total_cmp(&(self.times[*b] - time).abs()))?;
        Some((self.times[nearest], self.value(nearest)?))
    }

    pub fn summary(&self) -> Summary {
        // dates are products of counts and periods, right to a rounding; of a run that ends before that date, the last one
        let early = self.times.iter().take_while(|time| **time < self.since * (1.0 - 1e-12)).count();
        let first = early.min(self.times.len().saturating_sub(1));
        let counted =
            || self.times[first..].iter().zip(self.values[first * self.components..].chunks(self.components));
        let pick = |is_better: fn(f64, f64) -> bool| -> (Vec<f64>, Vec<f64>) {
            let of = |c: usize| best(counted().map(|(time, values)| (values[c], *time)), is_better);
            // of no value there is none
            (0..self.components).filter_map(of).unzip()
        };
        let (min, min_at) = pick(|a, b| a < b);
        let (max, max_at) = pick(|a, b| a > b);
        let length = |values: &[f64]| values.iter().map(|value| value * value).sum::<f64>().sqrt();
        let longest = best(counted().map(|(time, values)| (length(values), *time)), |a, b| a > b);
        Summary {
            name: self.name.clone(),
            unit: self.unit,
            first: self.value(0).map(<[f64]>::to_vec).unwrap_or_default(),
            last: self.last().map(<[f64]>::to_vec).unwrap_or_default(),
            min,
            max,
            min_at,
            max_at,
            longest: longest.filter(|_| self.components > 1),
            frequency: self.frequencies(),
        }
    }

    fn frequencies(&self) -> Vec<Option<f64>> {
        let interval = match (self.times.first(), self.times.last(), self.times.len()) {
            (Some(first), Some(last), count) if count > 1 => (last - first) / (count - 1) as f64,
            _ => 0.0,
        };
        let of = |c: usize| {
            let values: Vec<f64> = self.values.iter().skip(c).step_by(self.components).copied().collect();
            strongest_frequency(&values, interval)
        };
        (0..self.components).map(of).collect()
    }
}

/// The best of values with their times, and when it was met first. A value that is not a number is not passed over.
fn best(
    mut values: impl Iterator<Item = (f64, f64)>,
    is_better: impl Fn(f64, f64) -> bool,
) -> Option<(f64, f64)> {
    let first = values.next()?;
    Some(values.fold(first, |best, (value, time)| {
        let is_kept = best.0.is_nan() || !(value.is_nan() || is_better(value, best.0));
        if is_kept { best } else { (value, time) }
    }))
}

/// All traces as one table: a column of times, then one or three for each probe, named with units.
///
/// # Errors
/// The file cannot be written.
pub fn write_csv(path: &Path, traces: &[Trace]) -> Result<(), IoError> {
    let mut columns =
        vec![Column::new("time [s]", traces.first().map_or(Vec::new(), |trace| trace.times.clone()))];
    for trace in traces {
        for (c, suffix) in
            if trace.components == 3 { &[".x", ".y", ".z"][..] } else { &[""][..] }.iter().enumerate()
        {
            let values = trace.values.iter().skip(c).step_by(trace.components).copied().collect();
            columns.push(Column::new(format!("{}{suffix} [{}]", trace.name, trace.unit), values));
        }
    }
    souple_io::write_csv(path, &columns)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn trace(components: usize, since: f64, values: &[f64]) -> Trace {
        let count = values.len() / components;
        Trace {
            name: "tip".to_owned(),
            unit: "m",
            quantity: "position",
            over: None,
            components,
            since,
            times: (0..count).map(|step| 0.5 * step as f64).collect(),
            values: values.to_vec(),
        }
    }

    /// Extremes have the date at which they were met first, also where no value is beyond the first of those that count, is no number, or
    /// has no end.
    #[test]
    fn extremes_have_their_dates() {
        let [inf, nan] = [f64::INFINITY, f64::NAN];
        for (values, since, min, max) in [
            (&[2.0, 1.0, 3.0, 1.0, 3.0][..], 0.0, (1.0, 0.5), (3.0, 1.0)),
            (&[0.0, 2.0, 2.0, 2.0], 0.5, (2.0, 0.5), (2.0, 0.5)),
            (&[0.0, inf, inf], 0.5, (inf, 0.5), (inf, 0.5)),
            (&[0.0, -inf, -inf], 1.0, (-inf, 1.0), (-inf, 1.0)),
        ] {
            let told = trace(1, since, values).summary();
            assert_eq!((told.min[0], told.min_at[0]), min, "{values:?}");
            assert_eq!((told.max[0], told.max_at[0]), max, "{values:?}");
            assert_eq!(told.longest, None);
        }
        let told = trace(1, 0.0, &[1.0, nan, 2.0]).summary();
        assert!(told.min[0].is_nan() && told.max[0].is_nan());
        assert_eq!((told.min_at[0], told.max_at[0]), (0.5, 0.5));
        let told = trace(3, 0.5, &[9.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]).summary();
        assert_eq!((told.longest, told.min_at), (Some((0.0, 0.5)), vec![0.5; 3]));
    }
}
