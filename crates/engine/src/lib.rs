//! State, model, forces, steppers and systems: one step of the world.
//!
//! A [`Model`] is constant, a [`State`] holds all that evolves, a [`Workspace`] is scratch; a [`World`] steps
//! the three together. A [`Force`] is a term in a list; unknowns, rows and samples are in [`kinematics`].

pub mod binding;
pub mod constraint;
mod control;
pub mod coupling;
mod detection;
pub mod edit;
pub mod force;
mod frame_mass;
pub mod hand;
pub mod hash;
pub mod holding;
pub mod implicit;
pub mod inertia;
pub mod interruption;
pub mod kept;
pub mod kinematics;
pub mod levels;
pub mod linear;
pub mod mass;
pub mod modes;
pub mod obstacle;
mod reference_factor;
pub mod snapshot;
pub mod stability;
pub mod state;
pub mod steppers;
pub mod system;
pub mod tangent;
mod timeline;
pub mod tool;
pub mod unilateral;
pub mod world;

pub use binding::ConstraintSet;
pub use constraint::{Constraint, Motion};
pub use control::{CONTROL_LEN, Control};
pub use detection::{Detected, Detection};
pub use edit::{Command, Edit, EditError};
pub use force::{
    Adapted, CellField, Configuration, ContactPoint, Declaration, Editable, Energy, Force, LawChanges,
    LinkShown, LinkState, ParameterError, Scratch, TangentWeights, Unmet,
};
pub use hand::{Grip, Hand, Held, InHand};
pub use hash::Fingerprint;
pub use holding::{Felt, Holding, Told};
pub use interruption::Interruption;
pub use kept::{Kept, KeptRef, Summed, make_room};
pub use kinematics::{DerivedRow, Feedback, Kinematics, KinematicsError, UnknownKind, UnknownRange};
pub use levels::{Census, Levels};
pub use mass::Mass;
pub use obstacle::Obstacle;
pub use snapshot::SnapshotError;
pub use state::{FieldName, FieldRef, FieldState, Pair, Place, State, SystemState};
pub use steppers::{Step, StepError, StepReport, Stepper};
pub use system::{Rows, StageTimes, Surroundings, System, SystemWorkspace};
pub use tangent::Curvature;
pub use timeline::{Span, Timeline};
pub use tool::{HeldTool, Tool, Toolbox};
pub use unilateral::{ImpactLaw, Sides, Unilateral};
pub use world::{
    CommittedRows, EnergyReport, Field, FieldStep, Model, ResumeError, Workspace, World, WorldError,
};
