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
        let counted = &self.values[first * self.components..];
        // a value that is not a number is not passed over
        let pick = |fold: fn(f64, f64) -> f64, start: f64| -> Vec<f64> {
            let keep = |a: f64, b: f64| if a.is_nan() || b.is_nan() { f64::NAN } else { fold(a, b) };
            (0..self.components)
                .map(|c| counted.iter().skip(c).step_by(self.components).fold(start, |a, b| keep(a, *b)))
                .collect()
        };
        Summary {
            name: self.name.clone(),
            unit: self.unit,
            first: self.value(0).map(<[f64]>::to_vec).unwrap_or_default(),
            last: self.last().map(<[f64]>::to_vec).unwrap_or_default(),
            min: pick(f64::min, f64::INFINITY),
            max: pick(f64::max, f64::NEG_INFINITY),
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
