//! What probes read along a run as a sound.

use std::f64::consts::PI;

use serde_json::{Value, json};
use souple_io::{IoError, SampleFormat, write_wav};
use souple_scene::spec::sound::{Samples, Sound};

use crate::Trace;
use crate::output::{OutputError, OutputFolder};

/// Where the loudest sample is put where no gain is given, of full scale.
const LOUDEST: f64 = 0.9;
/// Zero crossings of the low-pass filter on each side of its middle.
const CROSSINGS: usize = 32;
/// Where the filter is at one half, of half the rate of samples: what it lets through fades to 10⁻⁴ up to that half.
const CUT_OFF: f64 = 0.92;
/// Shape of Kaiser's window for 80 dB.
const KAISER: f64 = 7.857;

/// The file of a sound.
pub fn sound_name(sound: &str) -> String {
    format!("{sound}.wav")
}

/// A sound as it will be written.
pub struct Rendered<'a> {
    sound: &'a Sound,
    /// Full scale is one.
    channels: Vec<Vec<f64>>,
    summary: SoundSummary,
}

/// What a report tells of a sound.
#[derive(Clone, Debug, PartialEq)]
pub struct SoundSummary {
    pub name: String,
    /// [1/s]
    pub rate: u32,
    pub channels: usize,
    /// Of each channel.
    pub samples: usize,
    /// Of full scale for one SI unit of the probes.
    pub gain: f64,
    /// Of full scale.
    pub loudest: f64,
}

impl SoundSummary {
    pub fn to_json(&self) -> (String, Value) {
        let of = json!({
            "file": sound_name(&self.name),
            "rate": self.rate,
            "channels": self.channels,
            "samples": self.samples,
            "seconds": self.samples as f64 / f64::from(self.rate),
            "gain": self.gain,
            "loudest": self.loudest,
        });
        (self.name.clone(), of)
    }
}

/// What probes read of a world that rests: rounding.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rounding {
    /// How far from the origin things are, at most [m].
    pub size: f64,
    /// Of the world [s].
    pub period: f64,
}

impl Rounding {
    /// What may be mere rounding of a number in this unit; zero where nobody can tell.
    fn of(&self, unit: &str) -> f64 {
        // a few roundings of places, and what they are in a period
        let of_places = 64.0 * f64::EPSILON * self.size;
        match unit {
            "m" => of_places,
            "m/s" => of_places / self.period,
            _ => 0.0,
        }
    }
}

impl Rendered<'_> {
    /// Samples of a sound, and what is to be said of them; none where a probe reads what is no number.
    pub fn new<'a>(
        sound: &'a Sound,
        traces: &[Trace],
        rounding: Rounding,
    ) -> (Option<Rendered<'a>>, Option<String>) {
        let (mut channels, mut floor) = (Vec::new(), 0.0_f64);
        for name in &sound.probes {
            let Some(trace) = traces.iter().find(|trace| trace.name == *name) else { return (None, None) };
            if let Some(at) = trace.values.iter().position(|value| !value.is_finite()) {
                let said = format!(
                    "sound `{}` is not written: probe `{name}` reads {} at {:.6} s",
                    sound.name, trace.values[at], trace.times[at]
                );
                return (None, Some(said));
            }
            floor = floor.max(rounding.of(trace.unit));
            channels.push(low_passed(&trace.values, sound.every));
        }
        let loudest = channels.iter().flatten().fold(0.0, |most: f64, sample| most.max(sample.abs()));
        // of the smallest numbers there are it would be infinite
        let loudest_gain = Some(LOUDEST / loudest).filter(|gain| gain.is_finite() && loudest > floor);
        let gain = sound.gain.or(loudest_gain).unwrap_or(1.0);
        for sample in channels.iter_mut().flatten() {
            *sample *= gain;
        }
        let said = if sound.gain.is_none() && loudest > 0.0 && loudest <= floor {
            Some(format!(
                "sound `{}` is silent: its probes read at most {loudest:.1e}, which is what rounding makes; a `gain` makes it heard",
                sound.name
            ))
        } else {
            remark(sound, &channels, loudest * gain)
        };
        let summary = SoundSummary {
            name: sound.name.clone(),
            rate: sound.rate,
            channels: channels.len(),
            samples: channels.first().map_or(0, Vec::len),
            gain,
            loudest: loudest * gain,
        };
        (Some(Rendered { sound, channels, summary }), said)
    }

    pub fn summary(&self) -> &SoundSummary {
        &self.summary
    }

    /// # Errors
    /// The file cannot be written.
    pub fn write(&self, folder: &mut OutputFolder) -> Result<(), OutputError> {
        let format = match self.sound.samples {
            Samples::Int16 => SampleFormat::Int16,
            Samples::Float32 => SampleFormat::Float32,
        };
        let path = folder.claim(&sound_name(&self.sound.name))?;
        let written: Result<(), IoError> = write_wav(&path, self.sound.rate, &self.channels, format);
        Ok(written?)
    }
}

/// What should be known of a sound: silence, and what is cut off.
fn remark(sound: &Sound, channels: &[Vec<f64>], loudest: f64) -> Option<String> {
    if loudest == 0.0 {
        return Some(format!("sound `{}` is silent: its probes read nothing but zero", sound.name));
    }
    let beyond = channels.iter().flatten().filter(|sample| sample.abs() > 1.0).count();
    if beyond == 0 {
        return None;
    }
    let all: usize = channels.iter().map(Vec::len).sum();
    let cut = match sound.samples {
        Samples::Int16 => "are cut off there",
        Samples::Float32 => "are kept, and players will cut them off",
    };
    Some(format!(
        "sound `{}`: {beyond} of {all} samples are beyond full scale, the loudest {loudest:.3} times, and {cut}; a gain of {:.3e} would hold them all",
        sound.name,
        sound.gain.unwrap_or(1.0) / loudest
    ))
}

/// Every `every`-th value, of what is left below half that rate: a sinc in Kaiser's window, centred, so that nothing is delayed.
/// Before the first value and behind the last these stand still.
fn low_passed(values: &[f64], every: usize) -> Vec<f64> {
    if every == 1 {
        return values.to_vec();
    }
    let half = CROSSINGS * every;
    let tap = |k: usize| {
        let (turn, edge) = (PI * CUT_OFF * k as f64 / every as f64, k as f64 / half as f64);
        let sinc = if k == 0 { 1.0 } else { turn.sin() / turn };
        sinc * bessel_i0(KAISER * (1.0 - edge * edge).sqrt())
    };
    let taps: Vec<f64> = (0..=half).map(tap).collect();
    let sum = taps[0] + 2.0 * taps[1..].iter().sum::<f64>();
    let last = values.len() - 1;
    let filtered = |middle: usize| {
        let beside = |k: usize| values[middle.saturating_sub(k)] + values[(middle + k).min(last)];
        (taps[0] * values[middle] + (1..=half).map(|k| taps[k] * beside(k)).sum::<f64>()) / sum
    };
    (0..values.len()).step_by(every).map(filtered).collect()
}

/// The modified Bessel function of order zero, by its series.
fn bessel_i0(x: f64) -> f64 {
    let (mut term, mut sum) = (1.0, 1.0);
    for k in 1..60 {
        term *= (0.5 * x / f64::from(k)).powi(2);
        sum += term;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tone(frequency: f64, count: usize) -> Vec<f64> {
        (0..count).map(|i| (2.0 * PI * frequency * i as f64).sin()).collect()
    }

    /// Below 0.84 of half the new rate tones pass at their places, from that half on they are gone by 80 dB; what stands still
    /// stays.
    #[test]
    fn tones_pass_or_do_not() {
        for every in [2, 3, 7] {
            let half_rate = 0.5 / every as f64;
            let inside = 40..200_usize;
            for part in [0.1, 0.5, 0.84] {
                let tone = tone(part * half_rate, 250 * every);
                let found = low_passed(&tone, every);
                assert_eq!(found.len(), 250);
                for i in inside.clone() {
                    assert!((found[i] - tone[every * i]).abs() < 3e-4, "{every}, {part}");
                }
            }
            for part in [1.0, 1.3, 1.9] {
                let found = low_passed(&tone(part * half_rate, 250 * every), every);
                assert!(found[inside.clone()].iter().all(|sample| sample.abs() < 3e-4), "{every}, {part}");
            }
            assert!(low_passed(&vec![0.7; 100], every).iter().all(|sample| (sample - 0.7).abs() < 1e-14));
        }
    }
}
