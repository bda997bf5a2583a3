//! How many frames an accuracy takes: the softest motions of a body by ever more frames, against those of its own mesh.

use std::path::Path;

use serde_json::{Value, json};
use souple_scene::{BodyInfo, Carriers, Scene, read_file_with_carriers};

/// So many of the lowest frequencies are compared.
const MOTIONS: usize = 4;
/// What the frames of the scene are multiplied by, one after the other.
const FACTORS: [f64; 6] = [0.5, 1.0, 1.5, 2.0, 3.0, 4.0];
/// More frames than this are not tried: factors of their matrices take seconds.
const MOST_FRAMES: usize = 500;
/// Frequencies below this part of the greatest are motions of the whole.
const RIGID: f64 = 1e-3;

/// What was tried for a body.
pub struct Needed {
    pub body: String,
    /// Frames, and the greatest error of stiffness against the softest motions.
    pub tried: Vec<(usize, f64)>,
    pub accuracy: f64,
    /// Why nothing more could be tried.
    pub note: Option<String>,
}

impl Needed {
    /// Tries frames of a body until an accuracy is met.
    pub fn of(path: &Path, settings: &[String], body: &BodyInfo, accuracy: f64) -> Self {
        let mut needed = Self { body: body.name.clone(), tried: Vec::new(), accuracy, note: None };
        let softest = |carriers: Carriers| {
            let scene = read_file_with_carriers(path, settings, &body.name, carriers)
                .map_err(|errors| errors.to_string())?;
            let frames = scene.bodies.iter().find(|other| other.name == body.name);
            let count = frames.and_then(|body| body.frames.as_ref()).map_or(0, |frames| frames.rows.len());
            Ok::<_, String>((count, softest_motions(scene, body.system)?))
        };
        let reference = match softest(Carriers::Mesh) {
            Ok((_, reference)) => reference,
            Err(why) => {
                needed.note = Some(format!("its own mesh has no softest motions to compare with: {why}"));
                return needed;
            }
        };
        for factor in FACTORS {
            match softest(Carriers::Frames(factor)) {
                Ok((count, _)) if needed.tried.iter().any(|(known, _)| *known == count) => {}
                Ok((count, found)) => {
                    let off = |(f, of_mesh): (&f64, &f64)| ((f / of_mesh).powi(2) - 1.0).abs();
                    let error = found.iter().zip(&reference).map(off).fold(0.0, f64::max);
                    needed.tried.push((count, error));
                    if error <= accuracy || count >= MOST_FRAMES {
                        break;
                    }
                }
                // fewer frames may not reach all of it, more may be more than there are points
                Err(why) => needed.note = Some(why.lines().next().unwrap_or_default().to_owned()),
            }
        }
        needed
    }

    /// The fewest tried that meet the accuracy.
    pub fn enough(&self) -> Option<usize> {
        self.tried.iter().find(|(_, error)| *error <= self.accuracy).map(|(count, _)| *count)
    }

    pub fn to_json(&self) -> Value {
        let tried: Vec<Value> =
            self.tried.iter().map(|(frames, error)| json!({"frames": frames, "error": error})).collect();
        json!({"accuracy": self.accuracy, "tried": tried, "enough": self.enough(), "note": self.note})
    }

    /// In a line.
    pub fn told(&self) -> String {
        let tried: Vec<String> = self
            .tried
            .iter()
            .map(|(frames, error)| format!("{frames} are {:.1} % off", 100.0 * error))
            .collect();
        let end = match (self.enough(), &self.note) {
            (Some(count), _) => format!("{:.1} % takes {count}", 100.0 * self.accuracy),
            (None, Some(note)) => format!("{:.1} % was not met: {note}", 100.0 * self.accuracy),
            (None, None) => format!("{:.1} % takes more", 100.0 * self.accuracy),
        };
        let name = &self.body;
        if tried.is_empty() {
            return format!("frames of {name}: {end}");
        }
        format!(
            "frames of {name}: in its {MOTIONS} softest motions, against its own mesh, {}; {end}",
            tried.join(", ")
        )
    }
}

/// The lowest frequencies of a system that are not those of the whole [Hz].
fn softest_motions(scene: Scene, system: usize) -> Result<Vec<f64>, String> {
    let found =
        souple_run::natural_frequencies(scene, MOTIONS + 6, 1.0).map_err(|error| error.to_string())?;
    let hertz = &found.get(system).ok_or("there is no such system")?.hertz;
    let least = RIGID * hertz.last().copied().unwrap_or_default();
    Ok(hertz.iter().copied().filter(|hertz| *hertz > least).take(MOTIONS).collect())
}
