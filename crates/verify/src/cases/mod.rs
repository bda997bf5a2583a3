//! The cases: one file and one line in [`TABLES`] for each subject.

mod adaptive;
mod bar;
mod cantilever_orders;
mod cantilevers;
mod characteristics;
mod commands;
mod conditional;
mod constraints;
mod contact;
mod courses;
mod crooked_patch;
mod derivations;
mod elements;
mod energy;
mod explicit;
mod filling;
mod fluids;
mod formulations;
mod frames;
mod frequencies;
mod ghosts;
mod hands;
mod heat;
mod implicit;
mod incompressible;
mod inelastic;
mod integrators;
mod late;
mod layers;
mod levels;
mod loads;
mod long_beam;
mod marks;
mod material_fields;
mod material_tests;
mod matter;
mod mixed_models;
mod modal;
mod motion;
mod moving_frame;
mod network;
mod network_friction;
mod network_stability;
mod octree;
mod particle_friction;
mod patch;
mod plastic_bodies;
mod point_cells;
mod polyhedra;
mod polynomial;
mod pressure;
mod resolution;
mod rheology;
mod rheometer;
mod rigid;
mod rubber;
mod shells;
mod skins;
mod sliding;
mod soft_cube;
mod splits;
mod step_limits;
mod stepper_orders;
mod strain_measures;
mod strings;
mod switching;
mod thick_sphere;
pub(crate) mod tools;
mod traction;
mod two_steppers;
mod views;
mod wall_cube;

use crate::Case;
pub use octree::STRUCK as STRUCK_ROD;

/// Every case, subject by subject, in order of cost within a subject.
pub const TABLES: &[&[Case]] = &[
    patch::CASES,
    crooked_patch::SOLIDS,
    crooked_patch::SHEETS,
    crooked_patch::LAWS,
    traction::CASES,
    traction::RESOLUTIONS,
    rubber::CASES,
    thick_sphere::CASES,
    filling::CASES,
    filling::BODIES.as_flattened(),
    cantilevers::CASES,
    cantilever_orders::CASES,
    elements::CASES,
    frequencies::CASES,
    motion::CASES,
    modal::CASES,
    polyhedra::CASES,
    polynomial::CASES,
    moving_frame::CASES,
    pressure::CASES,
    loads::CASES,
    stepper_orders::CASES,
    energy::CASES,
    explicit::CASES,
    implicit::CASES,
    incompressible::CASES,
    inelastic::CASES,
    soft_cube::CASES,
    soft_cube::IMPLICIT_STEPS,
    two_steppers::CASES,
    two_steppers::ONE_LINEARISATION,
    two_steppers::EXPLICIT_STEPS,
    splits::CASES,
    splits::KEPT_STEPS,
    step_limits::CASES,
    step_limits::EXPLICIT_LIMITS,
    long_beam::CASES,
    mixed_models::CASES,
    adaptive::CASES,
    formulations::CASES,
    derivations::CASES,
    wall_cube::CASES,
    wall_cube::SHEARED,
    wall_cube::SHEARED_MESHES,
    wall_cube::MIRRORED,
    strain_measures::CASES,
    contact::CASES,
    network::CASES,
    network_friction::CASES,
    strings::CASES,
    network_stability::CASES,
    network::STOPS.as_flattened(),
    network::RATTLE.as_flattened(),
    rheometer::CASES,
    characteristics::CASES,
    courses::MULTI_LINEAR,
    courses::MULTI_LINEAR_AT_ZERO,
    courses::COHESION,
    courses::COHESION_ENDS,
    courses::STIFFNESS_AT_REST,
    courses::REMEMBERS,
    courses::RIGID_PLASTICITY,
    courses::CASES,
    rheology::CASES,
    rheology::TREES.as_flattened(),
    conditional::CASES,
    switching::CASES,
    heat::CASES,
    constraints::CASES,
    commands::CASES,
    rigid::CASES,
    material_fields::CASES,
    matter::CASES,
    fluids::CASES,
    layers::CASES,
    sliding::CASES,
    plastic_bodies::CASES,
    plastic_bodies::BLOCKS,
    plastic_bodies::SAMPLES,
    material_tests::CASES,
    views::CASES,
    frames::CASES,
    octree::CASES,
    particle_friction::CASES,
    resolution::CASES,
    resolution::SPRINGS,
    levels::CASES,
    ghosts::CASES,
    integrators::CASES,
    integrators::LIMITS,
    point_cells::CASES,
    hands::CASES,
    late::CASES,
    tools::CASES,
    marks::CASES,
    shells::CASES,
    skins::CASES,
];

/// Every case.
pub fn all() -> impl Iterator<Item = &'static Case> {
    TABLES.iter().copied().flatten()
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use crate::scenes;

    /// Ids are not doubled, every scene is there, and orders have runs that get finer.
    #[test]
    fn cases_are_sound() {
        let mut ids = HashSet::new();
        for case in super::all() {
            assert!(ids.insert(case.id), "{} stands there twice", case.id);
            let is_derivation = matches!(case.reading, crate::Reading::Derived(_));
            assert!(is_derivation || scenes::text(case.scene).is_some(), "{} is of no scene", case.id);
            assert!(!case.what.is_empty() && case.reference.is_finite(), "{} says too little", case.id);
            if let Some(refinement) = case.refinement {
                assert!(refinement.runs.len() >= 2, "{} has no two runs", case.id);
                assert!(refinement.runs.is_sorted_by(|a, b| a.size > b.size), "{} does not refine", case.id);
            }
        }
    }
}
