//! How many frames an accuracy takes: the softest motions of a body by ever more frames, against those of its own mesh. All that the body
//! hangs on is held where it is, so that the motions are its own; so that both hang alike, no frame follows a bone.

use std::f64::consts::TAU;
use std::path::Path;
use std::time::{Duration, Instant};

use serde_json::{Value, json};
use souple_engine::{Constraint, World};
use souple_math::Vec3;
use souple_models::frames::ROWS_OF_FRAME;
use souple_scene::{BodyInfo, Carriers, Scene, read_file_with_carriers};
use souple_solve::modes::Settings;

/// So many of the lowest frequencies are compared.
const MOTIONS: usize = 4;
/// A body that nothing holds has so many motions more, of frequency zero.
const RIGID_MOTIONS: usize = 6;
/// What the frames of the scene are multiplied by, one after the other.
const FACTORS: [f64; 6] = [0.5, 1.0, 1.5, 2.0, 3.0, 4.0];
/// More frames than this are not tried: factors of their matrices take seconds.
const MOST_FRAMES: usize = 500;
/// Residual of the motions, of which stiffnesses are off by the square: far below what is told.
const KNOWN: f64 = 1e-4;
/// After so long no more are begun.
const PATIENCE: Duration = Duration::from_secs(20);
/// Of the body's highest frequency, what is zero to rounding: squares of frequencies are known to 1e-16 of the greatest and some
/// hundred terms of each sum.
const ZERO: f64 = 1e-6;
/// Motions are sought about that of a frequency so far below zero, of the highest: of nothing a stiffness has no factor, and about
/// what is nearly nothing motions of the whole drown the others.
const BELOW: f64 = 1e-3;

/// What was tried for a body.
pub struct Needed {
    pub body: String,
    pub accuracy: f64,
    /// In the order in which they were.
    tries: Vec<Try>,
    /// Why nothing could be compared.
    without: Option<String>,
    /// Whether it took too long to try more.
    gave_up: bool,
}

/// So many times as many frames as the scene has.
struct Try {
    times: f64,
    found: Found,
}

enum Found {
    /// Frames, and the greatest error of stiffness against the softest motions, below zero where they are too soft.
    Off { frames: usize, error: f64 },
    /// They do not carry the body, and why.
    Refused(String),
}

impl Needed {
    /// Tries frames of a body until an accuracy is met.
    pub fn of(path: &Path, settings: &[String], body: &BodyInfo, accuracy: f64) -> Self {
        let start = Instant::now();
        let mut needed =
            Self { body: body.name.clone(), accuracy, tries: Vec::new(), without: None, gave_up: false };
        let softest = |carriers: Carriers| {
            let scene = read_file_with_carriers(path, settings, &body.name, carriers)
                .map_err(|errors| errors.0.first().map_or_else(String::new, |first| first.message.clone()))?;
            softest_motions(scene, &body.name)
        };
        let reference = match softest(Carriers::Mesh) {
            Ok((_, reference)) => reference,
            Err(why) => {
                needed.without = Some(first_line(&why));
                return needed;
            }
        };
        for times in FACTORS {
            // fewer frames may not reach all of it, more may be more than there are points
            let found = match softest(Carriers::Frames(times)) {
                Ok((frames, _)) if needed.compared().any(|(known, _)| known == frames) => continue,
                Ok((frames, found))
                    if found.free > reference.free || found.hertz.len() < reference.hertz.len() =>
                {
                    Found::Refused(format!("nothing resists some motions of {frames}"))
                }
                Ok((frames, found)) => {
                    Found::Off { frames, error: greatest_error(&found.hertz, &reference.hertz) }
                }
                Err(why) => Found::Refused(first_line(&why)),
            };
            needed.tries.push(Try { times, found });
            let last = needed.compared().last();
            needed.gave_up = needed.enough().is_none() && start.elapsed() > PATIENCE;
            if needed.enough().is_some()
                || needed.gave_up
                || last.is_some_and(|(frames, _)| frames >= MOST_FRAMES)
            {
                break;
            }
        }
        needed
    }

    /// Frames and errors of what could be compared.
    fn compared(&self) -> impl Iterator<Item = (usize, f64)> {
        self.tries.iter().filter_map(|of| match of.found {
            Found::Off { frames, error } => Some((frames, error)),
            Found::Refused(_) => None,
        })
    }

    /// The fewest tried that meet the accuracy.
    pub fn enough(&self) -> Option<usize> {
        self.compared().find(|(_, error)| error.abs() <= self.accuracy).map(|(frames, _)| frames)
    }

    pub fn to_json(&self) -> Value {
        let tried = self.tries.iter().map(|Try { times, found }| match found {
            Found::Off { frames, error } => json!({"times": times, "frames": frames, "error": error}),
            Found::Refused(why) => json!({"times": times, "refused": why}),
        });
        json!({
            "accuracy": self.accuracy,
            "tried": tried.collect::<Vec<_>>(),
            "enough": self.enough(),
            "without": self.without,
            "gave_up": self.gave_up,
        })
    }

    /// In a line.
    pub fn told(&self) -> String {
        let (name, accuracy) = (&self.body, 100.0 * self.accuracy);
        if let Some(why) = &self.without {
            return format!("frames of {name}: its own mesh has no softest motions to compare with: {why}");
        }
        let tried: Vec<String> = self
            .tries
            .iter()
            .map(|Try { times, found }| match found {
                Found::Off { frames, error } => {
                    let way = if *error < 0.0 { "soft" } else { "stiff" };
                    format!("{frames} are {:.1} % too {way}", 100.0 * error.abs())
                }
                Found::Refused(why) => format!("{times} times as many do not do ({why})"),
            })
            .collect();
        let end = match self.enough() {
            Some(frames) => format!("{accuracy:.1} % takes {frames}"),
            None if self.gave_up => {
                format!(
                    "{accuracy:.1} % takes more or other weights, and no more were tried after {} s",
                    PATIENCE.as_secs()
                )
            }
            None => format!("{accuracy:.1} % takes more, or other weights"),
        };
        format!(
            "frames of {name}: in its {MOTIONS} softest motions, against its own mesh, {}; {end}",
            tried.join(", ")
        )
    }
}

/// The softest motions of a body.
struct Softest {
    /// So many of those looked at that nothing resists.
    free: usize,
    /// Frequencies of the others, from the lowest [Hz].
    hertz: Vec<f64>,
}

fn first_line(text: &str) -> String {
    text.lines().next().unwrap_or_default().to_owned()
}

/// Of stiffness, which is the square of a frequency.
fn greatest_error(found: &[f64], reference: &[f64]) -> f64 {
    let off = |(f, of_mesh): (&f64, &f64)| (f / of_mesh).powi(2) - 1.0;
    found.iter().zip(reference).map(off).max_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap_or(0.0)
}

/// How many frames carry a body, and the lowest frequencies of it that are not zero [Hz], all else being held.
fn softest_motions(mut scene: Scene, body: &str) -> Result<(usize, Softest), String> {
    let body = scene.bodies.iter().find(|other| other.name == body).ok_or("the body is gone")?;
    let (frames, index) = (body.frames.as_ref().map_or(0, |frames| frames.rows.len()), body.system);
    let system = &mut scene.model.systems[index];
    let kinematics = &system.kinematics;
    let is_own: Vec<bool> = (0..kinematics.block_count() as u32)
        .map(|block| kinematics.row_of_block(block).is_some_and(|row| is_of(body, row)))
        .collect();
    system.constraints.retain(|constraint| is_own[constraint.block as usize]);
    let q = &scene.state.systems[index].q;
    for block in (0..).zip(&is_own).filter(|(_, is_own)| !**is_own).map(|(block, _)| block) {
        // the turn of a rigid frame has no place
        let stands = kinematics.point_block_row(block).map_or(Vec3::ZERO, |row| q[row as usize]);
        system.constraints.push(Constraint::pin(block, stands));
    }
    lowest_frequencies(&mut scene.model.start(scene.state), index).map(|softest| (frames, softest))
}

/// Whether a row is one of the body's unknowns.
fn is_of(body: &BodyInfo, row: u32) -> bool {
    match &body.frames {
        Some(frames) => {
            frames.rows.iter().any(|origin| (*origin..*origin + ROWS_OF_FRAME as u32).contains(&row))
        }
        None => body.point_of(row).is_some(),
    }
}

fn lowest_frequencies(world: &mut World, system: usize) -> Result<Softest, String> {
    world.with_system(system, |system, state, around, ws| {
        let highest = souple_engine::stability::forecast(system, state, around, ws).highest_frequency;
        let [zero, below] = [ZERO, BELOW].map(|part| (part * highest).powi(2));
        let settings = Settings {
            count: MOTIONS + RIGID_MOTIONS,
            shift: -below,
            tolerance: KNOWN,
            ..Settings::default()
        };
        let modes = souple_engine::modes::lowest(system, state, around, ws, &settings)
            .map_err(|error| error.to_string())?;
        if modes.eigenvalues.iter().any(|eigenvalue| *eigenvalue < -zero) {
            return Err("it does not stand where it begins".to_owned());
        }
        let sought = modes.eigenvalues.len();
        let mut elastic: Vec<f64> =
            modes.eigenvalues.into_iter().filter(|eigenvalue| *eigenvalue > zero).collect();
        elastic.sort_by(f64::total_cmp);
        let free = sought - elastic.len();
        elastic.truncate(MOTIONS);
        Ok(Softest { free, hertz: elastic.into_iter().map(|eigenvalue| eigenvalue.sqrt() / TAU).collect() })
    })
}
