//! Scene files: text to specification to model and state.
//!
//! [`read_file`] puts texts, includes, overrides and parameters together, reads what they say as a [`Spec`] and
//! compiles it to a [`Scene`] ready to run. Whatever is wrong is collected in [`Diagnostics`], each with its place,
//! what was read and what would be accepted.

mod adjust;
mod compile;
pub mod diagnostic;
mod document;
mod ground;
mod include;
pub mod inputs;
mod keys;
mod layout;
mod measure;
mod modules;
mod overrides;
mod parameters;
pub mod path;
mod plan_file;
mod reader;
mod scene;
mod schema;
pub mod source;
pub mod spec;
mod values;

pub use adjust::Adjustable;
pub use compile::{FillInfo, LawInfo, NetworkInfo, NumberOfMass, StateSpace};
pub use diagnostic::{Code, Diagnostic, Diagnostics};
pub use ground::grounds;
pub use measure::{ContourInfo, Measurement, ProbeInfo, power_from_outside};
pub use modules::MODULES;
pub use plan_file::{PlanFault, PlanFile};
pub use scene::{
    BodyInfo, CarriedMarks, Carriers, DressInfo, FramesInfo, HandInfo, LawsInfo, MarksInfo, Planned,
    PlannedControl, ReducedInfo, Scene, SkinInfo, read_again, read_file, read_file_to_plan,
    read_file_with_carriers, read_spec, read_text, read_text_with_files,
};
pub use schema::{SceneKey, SceneTable, scene_tables, schema};
pub use spec::Spec;
