//! Why a run failed, in words: a refused step with its force or body and place, or what was to be done between steps.

use serde_json::{Value, json};
use souple_engine::{StepError, World, WorldError};
use souple_math::Vec3;
use souple_scene::BodyInfo;

/// What ended a run early.
#[derive(Clone, Debug, PartialEq)]
pub enum Cause {
    /// A step is refused.
    Step(WorldError),
    /// What was due between two steps, in words: an edit that does not fit, a file that cannot be written.
    Between(String),
}

/// Why a run ended early, and what of the scene it was.
#[derive(Clone, Debug, PartialEq)]
pub struct Failure {
    pub cause: Cause,
    /// Periods stepped before.
    pub period: u64,
    pub force: Option<String>,
    pub body: Option<String>,
    /// Point of the body, and where it stood before the refused step [m].
    pub point: Option<(usize, Vec3)>,
}

impl Failure {
    /// A refused step.
    pub fn of_step(error: WorldError, world: &World, bodies: &[BodyInfo]) -> Self {
        let mut systems = world.model().systems.iter();
        let system = match error.error.cause() {
            StepError::StateNotFinite { field, .. } => world.state().system_of(field),
            _ => systems.position(|system| error.place == format!("system `{}`", system.name)),
        };
        let row_of = |system: usize, block: usize| {
            let block = u32::try_from(block).ok()?;
            world.model().systems[system].kinematics.point_block_row(block).map(|row| row as usize)
        };
        let row = system.and_then(|system| match error.error.cause() {
            StepError::NewtonStalled { block, .. } => row_of(system, *block),
            StepError::ForceNotFinite { row, .. } => Some(*row),
            StepError::StateNotFinite { field, .. } if field.field.ends_with(".q") => Some(field.index),
            StepError::StateNotFinite { field, .. } if field.field.ends_with(".v") => {
                row_of(system, field.index)
            }
            _ => None,
        });
        let body = row.and_then(|row| {
            bodies.iter().find(|body| Some(body.system) == system && body.rows.contains(&row))
        });
        let force = match error.error.cause() {
            StepError::ForceNotFinite { force, .. } => Some(force.clone()),
            _ => None,
        };
        let point =
            body.zip(row).map(|(body, row)| (row - body.rows.start, world.rows(body.system).positions[row]));
        let (period, body) = (world.state().period, body.map(|body| body.name.clone()));
        Self { cause: Cause::Step(error), period, force, body, point }
    }

    /// Between two steps.
    pub fn between(message: String, period: u64) -> Self {
        Self { cause: Cause::Between(message), period, force: None, body: None, point: None }
    }

    /// One sentence, with the body and its point where they are known.
    pub fn message(&self) -> String {
        let place = match (&self.body, self.point) {
            (Some(body), Some((point, x))) => {
                format!("; worst at point {point} of body `{body}`, at ({:.4}, {:.4}, {:.4})", x.x, x.y, x.z)
            }
            _ => String::new(),
        };
        match &self.cause {
            Cause::Step(error) => format!("step {} is refused: {error}{place}", self.period + 1),
            Cause::Between(message) => format!("after step {}: {message}", self.period),
        }
    }

    /// The refused step, or the one after which it happened.
    fn step(&self) -> u64 {
        match self.cause {
            Cause::Step(_) => self.period + 1,
            Cause::Between(_) => self.period,
        }
    }

    pub fn to_json(&self) -> Value {
        json!({
            "message": self.message(),
            "step": self.step(),
            "place": match &self.cause {
                Cause::Step(error) => Some(&error.place),
                Cause::Between(_) => None,
            },
            "force": self.force,
            "body": self.body,
            "point": self.point.map(|(point, _)| point),
            "position": self.point.map(|(_, position)| position.to_array()),
        })
    }
}
