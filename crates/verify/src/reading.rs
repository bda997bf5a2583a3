//! What is read: of a scene a probe of a run, a natural frequency, the highest frequency; or a count of a derivation.

use souple_models::materials::Lame;
use souple_models::solids::{OperatorQuality, operator_quality};
use souple_run::{Report, Status, Trace};
use souple_scene::Scene;

use crate::bench::{Clock, with_threads};
use crate::derivation::{self, Count};
use crate::row::Problem;
use crate::runs::{RunKey, Runs};

/// What is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reading {
    /// A number of a run, as `report.json` has it.
    Probe(Observation),
    /// A component of one probe at the end over that of another, as `report.json` has both.
    Ratio { of: &'static str, to: &'static str, component: usize },
    /// A natural frequency [Hz] of the first system, the lowest being number 1, as `souple modes` prints it.
    NaturalFrequency(usize),
    /// The same of a body that is free to move, which has frequencies of zero: of those nearest to 1 Hz.
    FreeFrequency(usize),
    /// What an operator makes of the mesh of the first body, as `souple mesh operators` prints it.
    Operator { operator: &'static str, number: OperatorNumber },
    /// The least scaled Jacobian of the mesh of the first body, as `souple mesh quality` prints it.
    ScaledJacobian,
    /// The highest angular frequency [rad/s] of the first system, as `souple check --json` forecasts it.
    HighestFrequency,
    /// The condition of the moments that moving least squares over the places of a body's frames would invert, as
    /// `souple check --json` forecasts it.
    MomentCondition(&'static str),
    /// What a step and its probes take of one processor [ms]: `wall_seconds` over `steps` of `report.json` where nothing else works
    /// on the machine.
    StepMilliseconds,
    /// Newton iterations of a step in the mean: `solver.newton_iterations` over `steps` of `report.json`.
    NewtonIterations,
    /// How many steps a run came through, also one that was refused before its end: `steps` of `report.json`.
    Steps,
    /// A count of a derivation; there is no scene, and settings are arguments of `souple derive`.
    Derived(Count),
}

/// A number of [`OperatorQuality`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OperatorNumber {
    Asymmetry,
    GradDivAsymmetry,
    LaplacianError,
    GradDivError,
    InnerCrossTerms,
    BorderCrossTerms,
}

impl OperatorNumber {
    fn of(self, quality: &OperatorQuality) -> f64 {
        match self {
            Self::Asymmetry => quality.asymmetry,
            Self::GradDivAsymmetry => quality.grad_div_asymmetry,
            Self::LaplacianError => quality.laplacian_error,
            Self::GradDivError => quality.grad_div_error,
            Self::InnerCrossTerms => quality.inner_cross_terms,
            Self::BorderCrossTerms => quality.border_cross_terms,
        }
    }
}

/// A number of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Observation {
    pub probe: &'static str,
    /// Component of a vector.
    pub component: Option<usize>,
    pub statistic: Statistic,
    /// World periods to step; the scene's duration where `None`.
    pub steps: Option<u64>,
}

/// What is taken of a probe's values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Statistic {
    Last,
    Min,
    Max,
    /// The greatest less the least.
    Span,
    /// Over all periods but the start, of the course in `probes.csv`.
    Mean,
    /// The span from so many world periods on, of the course in `probes.csv`.
    LateSpan(u64),
    /// The last over that after so many world periods.
    LastOver(u64),
    /// The strongest frequency [Hz].
    Frequency,
}

impl Reading {
    /// The last value of a probe that gives a number, at the scene's end.
    pub const fn last(probe: &'static str) -> Self {
        Self::Probe(Observation { probe, component: None, statistic: Statistic::Last, steps: None })
    }

    /// The last value of a vector's component.
    pub const fn component(probe: &'static str, component: usize) -> Self {
        Self::Probe(Observation {
            probe,
            component: Some(component),
            statistic: Statistic::Last,
            steps: None,
        })
    }

    /// The same after so many world periods.
    pub const fn after(self, steps: u64) -> Self {
        match self {
            Self::Probe(observation) => Self::Probe(Observation { steps: Some(steps), ..observation }),
            other => other,
        }
    }

    /// Another statistic of the same.
    pub const fn taking(self, statistic: Statistic) -> Self {
        match self {
            Self::Probe(observation) => Self::Probe(Observation { statistic, ..observation }),
            other => other,
        }
    }

    /// What is read, in a word.
    pub fn name(&self) -> String {
        match self {
            Self::Probe(observation) => observation.probe.to_owned(),
            Self::Ratio { of, to, .. } => format!("{of} / {to}"),
            Self::NaturalFrequency(number) => format!("natural frequency {number}"),
            Self::FreeFrequency(number) => format!("free frequency {number}"),
            Self::Operator { operator, number } => format!("{number:?} of {operator}").to_lowercase(),
            Self::ScaledJacobian => "smallest_scaled_jacobian".to_owned(),
            Self::HighestFrequency => "highest frequency".to_owned(),
            Self::MomentCondition(body) => format!("moment_condition of {body}"),
            Self::StepMilliseconds => "wall_seconds / steps".to_owned(),
            Self::NewtonIterations => "newton_iterations / steps".to_owned(),
            Self::Steps => "steps".to_owned(),
            Self::Derived(count) => format!("{count:?}").to_lowercase(),
        }
    }

    /// The command line that gives the same number.
    pub fn command(&self, scene: &str, settings: &[&str]) -> String {
        let (verb, end) = match self {
            Self::Probe(Observation { steps, .. }) => {
                ("run", steps.map(|steps| format!(" --steps {steps}")).unwrap_or_default())
            }
            Self::NaturalFrequency(number) => ("modes", format!(" --count {number}")),
            Self::FreeFrequency(number) => ("modes", format!(" --near 1 --count {number}")),
            Self::Operator { .. } => ("mesh operators", " --json".to_owned()),
            Self::ScaledJacobian => ("mesh quality", " --json".to_owned()),
            Self::HighestFrequency | Self::MomentCondition(_) => ("check", " --json".to_owned()),
            Self::StepMilliseconds => ("run", " --threads 1 --json".to_owned()),
            Self::Ratio { .. } | Self::NewtonIterations | Self::Steps => ("run", " --json".to_owned()),
            Self::Derived(_) => return derivation::command(settings),
        };
        let settings: String = settings.iter().map(|setting| format!(" --set '{setting}'")).collect();
        format!("souple {verb} scenes/{scene}{settings}{end}")
    }

    /// World periods to step; the scene's duration where `None`.
    pub(crate) fn steps(&self) -> Option<u64> {
        match self {
            Self::Probe(observation) => observation.steps,
            _ => None,
        }
    }

    /// Whether others may read the same run.
    pub(crate) fn reads_a_run(&self) -> bool {
        matches!(self, Self::Probe(_) | Self::Ratio { .. } | Self::NewtonIterations | Self::Steps)
    }

    /// Whether what else the machine does at the same time has a part in it.
    pub(crate) fn measures_time(&self) -> bool {
        matches!(self, Self::StepMilliseconds)
    }

    /// The number and its unit.
    ///
    /// # Errors
    /// Why there is none, in words.
    pub(crate) fn read(&self, key: RunKey, runs: &mut Runs) -> Result<(f64, &'static str), Problem> {
        match self {
            Self::Probe(observation) => {
                let finished = runs.of(&key)?;
                done(&finished.report)?;
                observation.read(&finished.traces)
            }
            Self::Ratio { of, to, component } => {
                let finished = runs.of(&key)?;
                let report = done(&finished.report)?;
                let value = |probe: &str| {
                    let found = report.probes.iter().find(|summary| summary.name == probe);
                    let value = found.and_then(|summary| summary.last.get(*component).copied());
                    value.ok_or_else(|| format!("the scene has no such probe `{probe}`"))
                };
                Ok((value(of)? / value(to)?, ""))
            }
            Self::NaturalFrequency(number) => frequency(key.scene()?, *number, 0.0),
            Self::FreeFrequency(number) => frequency(key.scene()?, *number, 1.0),
            Self::Operator { operator, number } => {
                let scene = key.scene()?;
                let mesh = &scene.bodies.first().ok_or("the scene has no body")?.mesh;
                // V-01's, as `souple mesh operators` has them
                let moduli = Lame { mu: 7000.0, lambda: 20000.0 };
                let all = operator_quality(mesh, moduli, 1000.0).map_err(|error| error.to_string())?;
                let quality = all.iter().find(|quality| quality.operator == *operator);
                Ok((number.of(quality.ok_or_else(|| format!("there is no operator `{operator}`"))?), ""))
            }
            Self::Derived(count) => {
                let settings: Vec<String> =
                    key.settings.iter().map(|setting| (*setting).to_owned()).collect();
                Ok((derivation::count(*count, &settings)?, ""))
            }
            Self::ScaledJacobian => {
                let scene = key.scene()?;
                let mesh = &scene.bodies.first().ok_or("the scene has no body")?.mesh;
                let shapes = mesh.quality().into_iter().map(|cell| cell.scaled_jacobian);
                Ok((shapes.fold(f64::INFINITY, f64::min), ""))
            }
            Self::HighestFrequency => {
                let scene = key.scene()?;
                let mut world = scene.model.start(scene.state);
                let forecast = world.with_system(0, |system, state, around, ws| {
                    souple_engine::stability::forecast(system, state, around, ws)
                });
                Ok((forecast.highest_frequency, "rad/s"))
            }
            Self::MomentCondition(name) => {
                let scene = key.scene()?;
                let body = scene.bodies.iter().find(|body| body.name == *name);
                let frames = body.and_then(|body| body.frames.as_ref());
                Ok((frames.ok_or("the scene has no such body of frames")?.report.moment_condition, ""))
            }
            Self::StepMilliseconds => {
                let run = || {
                    let clock = Clock::start();
                    (key.run(), clock.seconds())
                };
                let (finished, seconds) = with_threads(1, run)?;
                Ok((1e3 * seconds / done(&finished?.report)?.steps as f64, "ms"))
            }
            Self::NewtonIterations => {
                let finished = runs.of(&key)?;
                let report = done(&finished.report)?;
                Ok((report.solver.newton_iterations as f64 / report.steps as f64, ""))
            }
            Self::Steps => Ok((runs.of(&key)?.report.steps as f64, "")),
        }
    }
}

/// Of the first system, of those nearest to another [Hz].
fn frequency(scene: Scene, number: usize, near: f64) -> Result<(f64, &'static str), Problem> {
    let systems = souple_run::natural_frequencies(scene, number, near).map_err(|error| error.to_string())?;
    let hertz = systems.first().and_then(|system| system.hertz.get(number.checked_sub(1)?));
    Ok((*hertz.ok_or("the scene has no such frequency")?, "Hz"))
}

/// Of a run that went to its end.
fn done(report: &Report) -> Result<&Report, Problem> {
    match report.status {
        Status::Done => Ok(report),
        _ => Err(Problem { message: report.warnings.join("; "), has_run: true }),
    }
}

impl Observation {
    fn read(&self, traces: &[Trace]) -> Result<(f64, &'static str), Problem> {
        let trace = traces.iter().find(|trace| trace.name == self.probe);
        let trace = trace.ok_or_else(|| format!("the scene has no probe `{}`", self.probe))?;
        let value = self.statistic.of(trace, self.component.unwrap_or(0));
        let unit = match self.statistic {
            Statistic::Frequency => "Hz",
            Statistic::LastOver(_) => "",
            _ => trace.unit,
        };
        Ok((value.ok_or("the probe has no such component, or does not swing")?, unit))
    }
}

impl Statistic {
    fn of(self, trace: &Trace, component: usize) -> Option<f64> {
        let summary = trace.summary();
        let of = |values: &[f64]| values.get(component).copied();
        match self {
            Self::Last => of(&summary.last),
            Self::Min => of(&summary.min),
            Self::Max => of(&summary.max),
            Self::Span => Some(of(&summary.max)? - of(&summary.min)?),
            Self::Mean => {
                let all = (1..trace.times.len()).map(|step| of(trace.value(step)?));
                let all: Vec<f64> = all.collect::<Option<_>>()?;
                (!all.is_empty()).then(|| all.iter().sum::<f64>() / all.len() as f64)
            }
            Self::LateSpan(from) => {
                let late = (from as usize..trace.times.len()).map(|step| of(trace.value(step)?));
                let late: Vec<f64> = late.collect::<Option<_>>()?;
                let greatest = late.iter().copied().reduce(f64::max)?;
                Some(greatest - late.iter().copied().reduce(f64::min)?)
            }
            Self::LastOver(period) => {
                let then = trace.value(period as usize)?.get(component)?;
                Some(of(&summary.last)? / then)
            }
            Self::Frequency => summary.frequency.get(component).copied().flatten(),
        }
    }
}
