//! Sounds: probes that are listened to, each a file that any player takes.

use souple_table::{Range, Value, readable};

use super::probe::Probe;
use super::quantity::Rank;
use crate::diagnostic::{Code, Site};
use crate::keys::{Key, Keys, Shape};
use crate::reader::Reader;

/// Greatest rate of samples [Hz].
const MOST_RATE: f64 = 192_000.0;
/// How far, relative to it, a rate may be from a whole number of hertz: a pitch that nobody tells from the right one.
const OFF_RATE: f64 = 1e-6;

pub(crate) static SOUND: Keys = Keys::new(
    "sound",
    "what probes read at the end of every period, as samples of a WAV file, `NAME.wav`",
    &[
        Key::new("probes", Shape::Texts, "one, or left and right; each gives one number").required(),
        Key::integer(
            "every",
            Range::closed(1.0, 1000.0),
            "periods to a sample; from two on a low-pass filter comes first, which ends at half the rate of the samples",
        )
        .or(Value::Integer(1)),
        Key::number(
            "gain",
            "",
            Range::POSITIVE,
            "of full scale for one SI unit of the probes; the loudest sample is at 0.9 of full scale where left out",
        ),
        Key::new(
            "samples",
            Shape::Choice(&["int16", "float32"]),
            "as they are kept; `int16` is cut off at full scale",
        )
        .or(Value::Text("int16")),
    ],
);

/// Probes that are listened to.
#[derive(Clone, Debug)]
pub struct Sound {
    pub name: String,
    /// One, or left and right.
    pub probes: Vec<String>,
    /// Periods to a sample.
    pub every: usize,
    /// Of samples [Hz].
    pub rate: u32,
    /// Of full scale for one unit of the probes; the loudest sample is at 0.9 of it where `None`.
    pub gain: Option<f64>,
    pub samples: Samples,
    pub site: Site,
}

/// How samples are kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Samples {
    Int16,
    Float32,
}

impl Sound {
    /// `period` is that of the world [s]; what is wrong goes to the log.
    pub(crate) fn read(name: String, reader: &Reader, probes: &[Probe], period: f64) -> Self {
        let listened = reader.texts("probes");
        if reader.has("probes") && !(1..=2).contains(&listened.len()) {
            let message = format!("a sound of {} probes", listened.len());
            reader.log().add(
                Code::Conflict,
                &reader.site_of("probes"),
                message,
                "one probe, or two for left and right",
            );
        }
        for probe in &listened {
            check_probe(probe, reader, probes);
        }
        let every = reader.maybe_integer("every").unwrap_or(1).max(1);
        Self {
            name,
            probes: listened,
            every: every as usize,
            rate: rate(reader, period, every).unwrap_or(0),
            gain: reader.maybe_number("gain"),
            samples: if reader.choice("samples") == "float32" { Samples::Float32 } else { Samples::Int16 },
            site: reader.site(),
        }
    }
}

fn check_probe(name: &str, reader: &Reader, probes: &[Probe]) {
    let refuse = |code: Code, message: String, expected: String| {
        reader.log().add(code, &reader.site_of("probes"), message, expected);
    };
    match probes.iter().find(|probe| probe.name == name) {
        Some(probe) if probe.rank() == Rank::Vector => {
            let message = format!("probe `{name}` gives a vector, and a sample is one number");
            refuse(Code::Conflict, message, "a probe with a `component`".to_owned());
        }
        Some(_) => {}
        None => {
            let known: Vec<&str> = probes.iter().map(|probe| probe.name.as_str()).collect();
            let hint = crate::keys::did_you_mean(name, known.iter().copied());
            let message = format!("there is no probe `{name}`{hint}");
            refuse(Code::UnknownName, message, crate::keys::one_of(&known));
        }
    }
}

/// Samples in a second; `None` where they are not a whole number that players take.
fn rate(reader: &Reader, period: f64, every: i64) -> Option<u32> {
    // what is wrong with the period is said there
    let rate = Some(1.0 / (period * every as f64)).filter(|rate| rate.is_finite() && *rate > 0.0)?;
    let whole = rate.round();
    if (1.0..=MOST_RATE).contains(&whole) && (rate - whole).abs() <= OFF_RATE * rate {
        return Some(whole as u32);
    }
    let periods = if every == 1 { "a period".to_owned() } else { format!("{every} periods") };
    let message = format!(
        "{periods} of {} s to a sample would be {} samples in a second",
        readable(period),
        readable(format!("{rate:.9e}").parse().unwrap_or(rate))
    );
    let expected = format!(
        "a whole number from 1 to {MOST_RATE}, as of a period of 2.2675736961451247e-5 s (44100 Hz), or `every` above 1 where it is too high"
    );
    reader.log().add(Code::OutOfRange, &reader.site(), message, expected);
    None
}
