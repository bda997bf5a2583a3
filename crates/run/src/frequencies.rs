//! Natural frequencies of a scene about its first state.

use std::f64::consts::TAU;

use souple_engine::modes::ModesError;
use souple_scene::Scene;
use souple_solve::SolveError;
use souple_solve::modes::Settings;

/// Natural frequencies of a system.
#[derive(Clone, Debug, PartialEq)]
pub struct NaturalFrequencies {
    pub system: String,
    /// Rising [Hz]; an unstable direction, `ω² < 0`, has a negative one.
    pub hertz: Vec<f64>,
    /// See [`souple_solve::modes::Modes::residuals`].
    pub largest_residual: f64,
    /// What is below it, of either sign, is zero to rounding [Hz].
    pub nothing: f64,
}

/// Of `ω²` of the highest frequency of a system, what rounding of its matrices leaves of none; and of the one that is looked about, what its inverse does.
const ROUNDING: f64 = 1e-14;
const ROUNDING_OF_SHIFT: f64 = 1e-8;

/// Frequencies of a system that cannot be had.
#[derive(Debug, thiserror::Error)]
#[error("system `{system}`: {source}{}", hint(.source))]
pub struct FrequencyError {
    pub system: String,
    pub source: ModesError,
}

/// What helps.
fn hint(error: &ModesError) -> &'static str {
    match error {
        ModesError::Solve(SolveError::Singular { .. }) => {
            "; what nothing holds has a stiffness and a frequency of zero, as bodies that are free to move, and masses across links that are slack or not stretched: look near another one (`--near 1`)"
        }
        _ => "",
    }
}

/// The `count` natural frequencies of each system nearest to `near` [Hz], about the scene's first state.
///
/// # Errors
/// A system has fewer, or its stiffness cannot be factorised: a body that is free to move needs a `near` that is not
/// zero.
pub fn natural_frequencies(
    scene: Scene,
    count: usize,
    near: f64,
) -> Result<Vec<NaturalFrequencies>, FrequencyError> {
    let mut world = scene.model.start(scene.state);
    let settings = Settings { count, shift: (TAU * near).powi(2), ..Settings::default() };
    let systems = world.model().systems.len();
    let of_system = |index| {
        let (system, found, highest) = world.with_system(index, |system, state, around, ws| {
            let found = souple_engine::modes::lowest(system, state, around, ws, &settings);
            let forecast = souple_engine::stability::forecast(system, state, around, ws);
            (system.name.clone(), found, forecast.highest_frequency)
        });
        let modes = match found {
            Ok(modes) => modes,
            Err(source) => return Err(FrequencyError { system, source }),
        };
        let hertz = |eigenvalue: &f64| eigenvalue.abs().sqrt().copysign(*eigenvalue) / TAU;
        let mut hertz: Vec<f64> = modes.eigenvalues.iter().map(hertz).collect();
        hertz.sort_by(f64::total_cmp);
        let largest_residual = modes.residuals.iter().copied().fold(0.0, f64::max);
        let nothing = (ROUNDING * highest * highest + ROUNDING_OF_SHIFT * settings.shift).sqrt() / TAU;
        Ok(NaturalFrequencies { system, hertz, largest_residual, nothing })
    };
    (0..systems).map(of_system).collect()
}
