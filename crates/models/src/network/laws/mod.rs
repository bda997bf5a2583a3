//! The laws of links: one file each and one line in [`LINKS`].

mod ball;
mod bingham;
mod bubble;
mod burger;
mod cohesion;
mod conditional;
mod damper;
mod elasto_plastic;
mod exponential_pieces;
mod exponential_stop;
mod finite_state;
mod formula;
mod lennard_jones;
mod maxwell;
mod measured_curve;
mod piecewise_linear;
mod rheological;
mod spring;
mod spring_damper;
mod stop;
mod tuned_spring;

use souple_table::Table;

use super::law::BuildLink;

pub use spring_damper::SpringDamper;

/// All laws.
pub const LINKS: Table<BuildLink> = Table {
    kind: "link",
    entries: &[
        &spring_damper::ENTRY,
        &spring::ENTRY,
        &damper::ENTRY,
        &tuned_spring::ENTRY,
        &piecewise_linear::ENTRY,
        &measured_curve::ENTRY,
        &cohesion::ENTRY,
        &lennard_jones::ENTRY,
        &ball::ENTRY,
        &bubble::ENTRY,
        &exponential_stop::ENTRY,
        &exponential_pieces::ENTRY,
        &elasto_plastic::ENTRY,
        &maxwell::ENTRY,
        &bingham::ENTRY,
        &burger::ENTRY,
        &rheological::ENTRY,
        &formula::ENTRY,
        &finite_state::ENTRY,
        &conditional::ENTRY,
    ],
};
