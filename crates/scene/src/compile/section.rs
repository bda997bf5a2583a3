//! What a section asks of the law of a body: that the stress it leaves out be none.

#![allow(non_snake_case)] // symbols of the mathematics: F

use souple_math::{Mat3, Vec3, exponential};
use souple_mesh::Mesh;
use souple_models::materials::Material;
use souple_models::solids::Section;

use super::Draft;
use super::bodies::Placed;
use crate::diagnostic::Code;

/// Relative change of the energy that rounding may make.
const ROUNDING: f64 = 1e-9;

/// Whether materials and damping can be those of the body's section; what cannot is reported.
pub fn suits(draft: &Draft, body: &Placed, materials: &[Material]) -> bool {
    let section = body.spec.section();
    let site = body.spec.section.as_ref().map_or(&body.spec.site, |chosen| &chosen.site);
    let turns = section != Section::Solid && !section.is_plane();
    let is_membrane = matches!(section, Section::Membrane { .. });
    if is_membrane && !materials.iter().all(|material| material.law.is_objective()) {
        let message = "a membrane turns in space, and a law of small strain would resist that";
        draft.log.add(Code::Conflict, site, message, "an objective law, such as corotational or neo_hookean");
        return false;
    }
    if turns && body.spec.damping.rayleigh_stiffness > 0.0 {
        let message =
            "rayleigh_stiffness damps by the stiffness at rest, which bodies that turn leave behind";
        draft.log.add(
            Code::Conflict,
            site,
            message,
            "`viscosity` or `rayleigh_mass` for membranes, bars and cables",
        );
        return false;
    }
    if let Some(across) = materials.iter().find_map(|material| leans(material, section, &body.mesh)) {
        let message =
            format!("the law is not the same on both sides of {across}: its stress there would be left out");
        let accepted = "a law without directions, or with directions along the cells or straight across them";
        draft.log.add(Code::Conflict, site, message, accepted);
        return false;
    }
    true
}

/// What of the cells the law leans against, if it does: mirrored there, or turned about the bar, its energy is another.
fn leans(material: &Material, section: Section, mesh: &Mesh) -> Option<String> {
    if !material.knows_directions() {
        return None;
    }
    let is_changed = |symmetry: &Mat3| {
        DEFORMATIONS.iter().any(|rows| {
            let F = Mat3::from_rows(*rows);
            let (before, after) =
                (material.energy_density(&F), material.along(Some(symmetry)).energy_density(&F));
            // what has no value there is told by other checks
            (before - after).abs() > ROUNDING * (before.abs() + after.abs())
        })
    };
    match section {
        Section::Solid | Section::PlaneStrain { .. } => None,
        Section::PlaneStress { .. } => is_changed(&half_turn(Vec3::AXES[2])).then(|| "its plane".to_owned()),
        // the law's x is along the bar
        Section::Bar { .. } | Section::Cable { .. } => {
            let turns =
                [0.5, 1.0].map(|share| exponential(Vec3::AXES[0] * (share * std::f64::consts::FRAC_PI_2)));
            let is_bent = turns.iter().chain([&half_turn(Vec3::AXES[2])]).any(is_changed);
            is_bent.then(|| "the bar".to_owned())
        }
        Section::Membrane { .. } => {
            let is_isotropic = !is_changed(&exponential(Vec3::new(0.7, -1.1, 0.4)));
            let mut cells = mesh.cells().enumerate();
            let found = cells.find(|(_, cell)| {
                let corner = |i: usize| mesh.points[cell.nodes[i] as usize];
                let normal = (corner(1) - corner(0)).cross(corner(2) - corner(0));
                !is_isotropic && is_changed(&half_turn(normal * (1.0 / normal.length())))
            });
            found.map(|(cell, _)| format!("cell {cell}"))
        }
    }
}

/// `2 n nᵀ - I`, half a turn about `n`: to `C = FᵀF` the same as the mirror across it, but with a volume that is positive, where
/// laws have their values.
fn half_turn(n: Vec3) -> Mat3 {
    n.outer(n) * 2.0 - Mat3::IDENTITY
}

/// Deformations without symmetry; the last one large enough for fibres that bear from some stretch on.
const DEFORMATIONS: [[[f64; 3]; 3]; 3] = [
    [[1.15, 0.08, -0.05], [0.11, 0.93, 0.07], [-0.04, 0.12, 1.06]],
    [[0.9, -0.1, 0.14], [0.03, 1.12, -0.09], [0.16, -0.02, 1.2]],
    [[2.7, 0.4, -0.3], [0.2, 2.1, 0.5], [-0.6, 0.3, 3.2]],
];
