//! Why a run failed, in words: a refused step with its force or body and place, or what was to be done between steps.

use serde_json::{Value, json};
use souple_engine::{StepError, World, WorldError};
use souple_math::Vec3;
use souple_models::frames::ROWS_OF_FRAME;
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
    /// Where in the body.
    pub spot: Option<Spot>,
}

/// What of a body a step is refused for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spot {
    pub part: Part,
    /// Where it stood before the refused step [m].
    pub position: Vec3,
}

/// A part of a body, by its number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Part {
    Point(usize),
    /// One of those that carry the body.
    Frame(usize),
}

impl Part {
    /// The part of a body that a row of its system is of, and the row of its place.
    fn of_row(row: usize, body: &BodyInfo) -> Option<(Self, usize)> {
        if let Some(point) = u32::try_from(row).ok().and_then(|row| body.point_of(row)) {
            return Some((Self::Point(point as usize), row));
        }
        let origins = body.frames.as_ref()?.rows.iter().map(|origin| *origin as usize);
        let of_frame = |(_, origin): &(usize, usize)| (*origin..*origin + ROWS_OF_FRAME).contains(&row);
        origins.enumerate().find(of_frame).map(|(frame, origin)| (Self::Frame(frame), origin))
    }
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
            world.model().systems[system].kinematics.row_of_block(block).map(|row| row as usize)
        };
        let row = system.and_then(|system| match error.error.cause() {
            StepError::NewtonStalled { block, .. }
            | StepError::Linear { block: Some(block), .. }
            | StepError::MotionNotFinite { block, .. } => row_of(system, *block),
            StepError::ForceNotFinite { row, .. }
            | StepError::SlopeNotFinite { row, .. }
            | StepError::Fault { row, .. }
            | StepError::LimitsUnsettled { row, .. }
            | StepError::Unkept { row, .. }
            | StepError::Unmet { row, .. } => Some(*row),
            StepError::StateNotFinite { field, .. } if field.field.ends_with(".q") => Some(field.index),
            StepError::StateNotFinite { field, .. } if field.field.ends_with(".v") => {
                row_of(system, field.index)
            }
            _ => None,
        });
        let found = row.and_then(|row| {
            let mut own = bodies.iter().filter(|body| Some(body.system) == system);
            own.find_map(|body| Some((body, Part::of_row(row, body)?)))
        });
        let force = match error.error.cause() {
            StepError::ForceNotFinite { force, .. }
            | StepError::EnergyNotFinite { force, .. }
            | StepError::SlopeNotFinite { force, .. }
            | StepError::Fault { force, .. }
            | StepError::Unmet { force, .. } => Some(force.clone()),
            _ => None,
        };
        let spot = found.map(|(body, (part, row))| {
            let position = world.rows(body.system).positions[row];
            Spot { part, position }
        });
        let (period, body) = (world.state().period, found.map(|(body, _)| body.name.clone()));
        Self { cause: Cause::Step(error), period, force, body, spot }
    }

    /// Between two steps.
    pub fn between(message: String, period: u64) -> Self {
        Self { cause: Cause::Between(message), period, force: None, body: None, spot: None }
    }

    /// One sentence, with the body and its point where they are known.
    pub fn message(&self) -> String {
        let place = match (&self.body, self.spot) {
            (Some(body), Some(Spot { part, position: x })) => {
                let part = match part {
                    Part::Point(point) => format!("point {point}"),
                    Part::Frame(frame) => format!("frame {frame}"),
                };
                format!("; worst at {part} of body `{body}`, at ({:.4}, {:.4}, {:.4})", x.x, x.y, x.z)
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
            "point": self.spot.and_then(|spot| match spot.part {
                Part::Point(point) => Some(point),
                Part::Frame(_) => None,
            }),
            "frame": self.spot.and_then(|spot| match spot.part {
                Part::Frame(frame) => Some(frame),
                Part::Point(_) => None,
            }),
            "position": self.spot.map(|spot| spot.position.to_array()),
        })
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    /// What a body of frames fails of is a frame of it: where the force is largest, where numbers end.
    #[test]
    fn failures_of_frames_name_their_body() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/ligament");
        let text = std::fs::read_to_string(folder.join("scene.toml")).expect("the scene");
        let failure = |stepper: &str| {
            let settings = [format!("systems.main.stepper={stepper}"), "world.period=\"50 ms\"".to_owned()];
            let scene = souple_scene::read_text("ligament", &text, &folder, &settings);
            let scene = scene.unwrap_or_else(|errors| panic!("{errors}"));
            let mut world = scene.model.start(scene.state);
            let error = (0..1000).find_map(|_| world.step().err()).expect("a refused step");
            Failure::of_step(error, &world, &scene.bodies)
        };
        let stalled = "{ name = \"backward_euler\", newton_tolerance = 1e-300, newton_iterations = 1 }";
        for stepper in [stalled, "\"symplectic_euler\""] {
            let failure = failure(stepper);
            assert_eq!(failure.body.as_deref(), Some("ligament"), "{failure:?}");
            assert!(matches!(failure.spot, Some(Spot { part: Part::Frame(_), .. })), "{failure:?}");
            assert!(failure.message().contains("of body `ligament`, at ("), "{}", failure.message());
            assert!(failure.to_json()["frame"].is_u64());
        }
    }

    /// Forces without a slope, and laws beyond their range, are named in the place of the linear system that they spoil.
    #[test]
    fn what_spoils_a_linear_system_is_named() {
        let body = "format = 1\n[world]\nperiod = \"10 ms\"\n[bodies.cube]\n\
                    mesh = { generate = \"box\", size = [1, 1, 1], cells = [2, 2, 2], element = \"hex8\" }\n";
        let steep = "material = { name = \"neo_hookean\", youngs_modulus = \"1 MPa\", poissons_ratio = 0.3, density = 1000 }\n\
                     [[bodies.cube.pins]]\nregion = \"y_min\"\n\
                     [[bodies.cube.loads]]\nregion = \"x_min\"\nforce = [\"sqrt(x)\", 0, 0]\n";
        let ended = "material = { name = \"hyperelastic\", density = 1000, parameters = { m = \"1 kPa\", most = 0.1 }, \
                     energy = \"-m*most/2*ln(1 - (I1 - 3)/most) - m*ln(J) + m/2*ln(J)^2\" }\n\
                     [[bodies.cube.pins]]\nregion = \"x_min\"\n[[bodies.cube.pins]]\nregion = \"x_max\"\n\
                     motion = { formula = [\"100*t\", 0, 0] }\n[systems.main]\nstepper = \"static\"\n";
        for (rest, force, words) in
            [(steep, "cube.loads[0]", "the slope of force"), (ended, "cube.material", "is not finite")]
        {
            let scene = souple_scene::read_text("cube", &format!("{body}{rest}"), Path::new("."), &[]);
            let scene = scene.unwrap_or_else(|errors| panic!("{errors}"));
            let mut world = scene.model.start(scene.state);
            let failure = Failure::of_step(world.step().expect_err("a refused step"), &world, &scene.bodies);
            assert_eq!(failure.force.as_deref(), Some(force), "{failure:?}");
            assert!(failure.message().contains(words), "{}", failure.message());
        }
    }
}
