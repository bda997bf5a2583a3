//! The laws of links: one file each and one line in [`LINKS`].

mod conditional;
mod elasto_plastic;
mod finite_state;
mod flowing;
mod formula;
mod lennard_jones;
mod piecewise;
mod rheological;
mod spring_damper;
mod stops;

use souple_table::Table;

use super::law::BuildLink;

pub use piecewise::Piecewise;
pub use spring_damper::SpringDamper;

/// All laws.
pub const LINKS: Table<BuildLink> = Table {
    kind: "link",
    entries: &[
        &spring_damper::SPRING_DAMPER,
        &spring_damper::SPRING,
        &spring_damper::DAMPER,
        &spring_damper::TUNED_SPRING,
        &piecewise::PIECEWISE_LINEAR,
        &piecewise::COHESION,
        &lennard_jones::ENTRY,
        &stops::BALL,
        &stops::BUBBLE,
        &stops::EXPONENTIAL_STOP,
        &stops::EXPONENTIAL_PIECES,
        &elasto_plastic::ENTRY,
        &flowing::MAXWELL,
        &flowing::BINGHAM,
        &flowing::BURGER,
        &rheological::ENTRY,
        &formula::ENTRY,
        &finite_state::ENTRY,
        &conditional::ENTRY,
    ],
};
