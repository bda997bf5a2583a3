//! What is no fault but hardly meant: magnitudes that look like a slip of units, materials that lock.

use souple_engine::linear::Method;
use souple_engine::{Detection, Force, System};
use souple_mesh::USUAL_SIZES;
use souple_mesh::repair::diagnose;
use souple_models::materials::{Build, Material};
use souple_models::network::Crowd;
use souple_table::{Value, counted, four_digits, readable};

use super::bodies::Placed;
use super::{Draft, contact};
use crate::diagnostic::Code;
use crate::reader::Chosen;
use crate::spec::body::Body;
use crate::spec::contact::ShapeSpec;
use crate::spec::mesh::MeshSpec;

/// Young's moduli of matter [Pa]: the softest gels have tens of pascals, diamond 1.2·10¹².
const MODULI: [f64; 2] = [20.0, 2e12];
/// Densities of matter [kg/m³]: aerogels have a few, osmium 22 600.
const DENSITIES: [f64; 2] = [1.0, 3e4];
/// Moduli and densities in SI units that can be computed with, and more than there are.
const ABSURD: [f64; 2] = [1e-30, 1e30];
/// Sizes of bodies whose lengths are written in the scene [m].
const SIZES: [f64; 2] = [1e-5, 500.0];
/// `λ/μ` beyond which elements with linear shape functions are markedly too stiff: they have fewer freedoms than
/// their cells have volumes to keep. `ν = 0.475` gives 19 (Hughes 2000, §4.2).
const LOCKING: f64 = 19.0;

/// Warns of a scene that asks for late detection of collisions, and has none to detect, or none that could be late.
pub fn warn_of_detection(draft: &mut Draft) {
    let world = &draft.spec.world;
    if world.detection != Detection::OnePeriodLate {
        return;
    }
    let place = draft.place(&world.detection_site);
    // what has moved at all since a crowd was listed makes its list old, and with it all lists of its system
    for system in &draft.systems {
        let listed = |force: &dyn Force| force.as_any().is::<Crowd>() && force.declaration().changing_pattern;
        let Some(crowd) = system.forces.iter().find(|force| listed(force.as_ref())) else { continue };
        draft.warnings.push(format!(
            "{place}: no contact of system `{}` is used that is found beside its steps: its stepper `{}` searches the crowd `{}` anew in every step, and all else with it; \
             `\"every_step\"` searches once, and `t_simulation` and explicit steppers leave crowds out of it",
            system.name,
            system.stepper.name(),
            crowd.name()
        ));
    }
    let detects = |system: &System| system.has_pairs() || system.holds();
    if !draft.systems.iter().any(detects) {
        draft.warnings.push(format!(
            "{place}: nothing is detected here beside the steps: points of bodies feel shapes in every step; `detect = \"triangles\"` and contacts between bodies have something to look for"
        ));
    }
}

/// Adds warnings on all bodies.
pub fn warn(draft: &mut Draft) {
    let mut warnings = Vec::new();
    for body in &draft.bodies {
        let size = body.mesh.bounds().diagonal();
        // huge balls serve networks as walls, lone masses have no size
        let sizes = match body.spec.mesh {
            // a file knows no units
            Some(MeshSpec::File { .. } | MeshSpec::Filled { .. }) => USUAL_SIZES,
            _ => SIZES,
        };
        if body.spec.network.is_none() && !within(size, sizes) {
            let site = body.spec.mesh.as_ref().map_or(&body.spec.site, |mesh| mesh.site());
            let hint =
                if size > sizes[1] { "did you mean mm (`scale = 0.001`)?" } else { "is the scale right?" };
            let place = draft.place(site);
            warnings.push(format!(
                "{place}: body `{}` is {} m across: {hint}",
                body.spec.name,
                four_digits(size)
            ));
        }
        warnings.extend(unstrained(body).map(|doubt| format!("{}: {doubt}", draft.place(&body.spec.site))));
        let is_linear = body.mesh.blocks.iter().any(|block| block.kind.is_linear());
        for (chosen, material) in materials(body.spec) {
            let doubts = of_material(&material, locking_of(body, is_linear));
            warnings.extend(doubts.map(|doubt| format!("{}: {doubt}", draft.place(&chosen.site))));
            // at its text, where it is one
            let place = draft.place(&chosen.site_of_part("energy", None));
            warnings.extend(material.warnings().iter().map(|doubt| format!("{place}: the law: {doubt}")));
        }
    }
    warnings.extend(of_surfaces(draft));
    if draft.spec.run.monitor.is_some() {
        let names: Vec<String> = unwatched(draft);
        if !names.is_empty() {
            warnings.push(format!(
                "`run.monitor` does not know the work of {}: it may take it for growth, or growth for it",
                names.join(", ")
            ));
        }
    }
    draft.warnings.extend(warnings);
}

/// Of what chosen rules of quadrature see too little.
fn unstrained(body: &Placed) -> impl Iterator<Item = String> {
    let is_solid = body.spec.material.is_some() && body.frames.is_none();
    body.mesh.blocks.iter().filter(move |_| is_solid).filter_map(|block| {
        let rule = body.spec.quadrature.rule(block.kind);
        let motions = block.kind.unstrained_motions(rule);
        (motions > 0).then(|| {
            format!(
                "body `{}`: the points of `{}` do not see {} of a `{}` that is held by one face alone, as in a bar one cell thick, and nothing \
                 resists {} there; choose a rule of more points, such as `{}`",
                body.spec.name,
                rule.name,
                counted(motions as u64, "motion"),
                block.kind.name(),
                if motions == 1 { "it" } else { "them" },
                block.kind.default_rule().name
            )
        })
    })
}

/// What does work that the monitor of energy knows nothing of.
fn unwatched(draft: &Draft) -> Vec<String> {
    let moves = |shape: &&ShapeSpec| shape.motion.is_some() || shape.rotation.is_some();
    let shapes = draft.spec.shapes.iter().filter(moves).map(|shape| format!("the shape `{}`", shape.name));
    let hands = draft.spec.hands.iter().map(|hand| format!("the hand `{}`", hand.name));
    let melts = |body: &&Body| {
        body.network
            .as_ref()
            .is_some_and(|network| network.crowds.iter().any(|crowd| crowd.fusible.is_some()))
    };
    let bonds =
        draft.spec.bodies.iter().filter(melts).map(|body| format!("bonds that set in `{}`", body.name));
    shapes.chain(hands).chain(bonds).collect()
}

/// What is wrong with the surface files of shapes that bodies touch: they are closed, or they would be refused.
fn of_surfaces(draft: &Draft) -> Vec<String> {
    let mut warnings = Vec::new();
    if !draft.log.is_empty() {
        return warnings;
    }
    for shape in &draft.spec.shapes {
        let Some(chosen) = shape.shape.as_ref().filter(|shape| shape.values.get("surface").is_some()) else {
            continue;
        };
        let Some(outline) = contact::built(draft, chosen).and_then(|built| built.outline()) else { continue };
        let size = outline.surface.bounds().doubt();
        let faults = diagnose(&outline.surface).messages();
        let place = draft.place(&chosen.site);
        let said = |doubt: String| format!("{place}: shape `{}`: {doubt}", shape.name);
        warnings.extend(size.into_iter().chain(faults).map(said));
    }
    warnings
}

/// Refuses materials like nothing in the world: their numbers would overflow in what is computed of them.
pub fn refuse(draft: &Draft) {
    for body in &draft.bodies {
        for (chosen, material) in materials(body.spec) {
            let modulus = material.small_strain.youngs_modulus();
            let written = |key: &str, computed: f64| match chosen.values.get(key) {
                Some(Value::Number(number)) => number,
                _ => computed,
            };
            for (key, name, computed, [low, high]) in [
                ("youngs_modulus", "Young's modulus", modulus, MODULI),
                ("density", "the density", material.density, DENSITIES),
            ] {
                let value = written(key, computed);
                let is_of_text = key == "youngs_modulus" && chosen.values.get("energy").is_some();
                if let Some((message, expected)) = gives_way(&material).filter(|_| is_of_text) {
                    draft.log.add(Code::OutOfRange, chosen.site_of("energy"), message, expected);
                } else if !within(value, ABSURD) {
                    let message = format!("{name} is {}", readable(value));
                    let expected =
                        format!("that of some matter, usually {low:e} to {high:e}; is the unit right?");
                    draft.log.add(Code::OutOfRange, chosen.site_of(key), message, expected);
                }
            }
        }
    }
}

/// What of a law as text does not hold a body together at rest, and what would.
fn gives_way(material: &Material) -> Option<(String, &'static str)> {
    let [bulk, shear] = material.bulk_and_shear();
    let lacks = |modulus: f64| modulus.is_nan() || modulus <= 0.0;
    let told = |what: &str, modulus: f64, name: &str| {
        // beside what is far stiffer a small modulus may be meant and not be seen
        let lost = if modulus == 0.0 {
            format!(", to the rounding of its largest stiffness ({:.0e} Pa)", material.modulus_rounding())
        } else {
            String::new()
        };
        let modulus = readable(modulus);
        format!("at rest this energy does not resist {what}: its {name} modulus is {modulus} Pa{lost}")
    };
    if lacks(shear) {
        let expected = "a term that grows with the square of every shear, such as mu/2*(I1_bar - 3)";
        Some((told("shear", shear, "shear"), expected))
    } else if lacks(bulk) {
        let expected = "a term that grows with the square of the change of volume, such as k/2*(J - 1)^2";
        Some((told("a change of volume", bulk, "bulk"), expected))
    } else {
        None
    }
}

fn within(value: f64, [low, high]: [f64; 2]) -> bool {
    (low..=high).contains(&value)
}

/// The materials of a body as they are written and as they are.
fn materials(body: &Body) -> Vec<(&Chosen<Build>, Material)> {
    let parts = body.regions.iter().map(|part| &part.material);
    let chosen = [&body.material].into_iter().chain(parts).flatten();
    // what cannot be built was refused where it was read
    chosen.filter_map(|chosen| Some((chosen, (chosen.entry.build)(&chosen.values).ok()?))).collect()
}

/// What is too stiff of a body that keeps its volume almost, and what to compare with; nothing of elements that are not linear.
fn locking_of(body: &Placed, is_linear: bool) -> Option<&'static str> {
    match (&body.frames, is_linear) {
        (Some(_), _) => {
            Some("a few frames have fewer freedoms than there are volumes to keep: compare with more frames")
        }
        (None, true) => Some(
            "linear elements lock, and the body may be too stiff, tetrahedra most of all; compare with quadratic elements, a finer mesh",
        ),
        (None, false) => None,
    }
}

/// `locking`: what would be too stiff, and what to compare with.
fn of_material(material: &Material, locking: Option<&'static str>) -> impl Iterator<Item = String> {
    let (density, modulus) = (material.density, material.small_strain.youngs_modulus());
    let [bulk, shear] = material.bulk_and_shear();
    let ratio = bulk / shear - 2.0 / 3.0;
    let modulus_doubt = (!within(modulus, MODULI)).then(|| {
        let hint = if modulus < MODULI[0] {
            "did you mean kPa or MPa?"
        } else {
            "more than that of any matter; is the unit right?"
        };
        format!("Young's modulus is {modulus:.3e} Pa: {hint}")
    });
    let density_doubt = (!within(density, DENSITIES)).then(|| {
        let hint = if density < DENSITIES[0] { "did you mean g/cm^3?" } else { "did you mean kg/m^3?" };
        format!("the density is {density:.3e} kg/m³: {hint}")
    });
    let locking = locking.filter(|_| ratio > LOCKING).map(|locking| {
        // ν = λ / (2 (λ + μ))
        let poisson = 0.5 * ratio / (ratio + 1.0);
        format!(
            "nearly incompressible, with a Poisson's ratio of {poisson:.4} or a bulk modulus of {:.0} shear moduli: {locking}, or at most \
             0.475, 20 shear moduli",
            ratio + 2.0 / 3.0
        )
    });
    [modulus_doubt, density_doubt, locking].into_iter().flatten()
}

/// What is asked of a solver that another one will have to do.
pub fn of_solver(system: &System) -> Option<String> {
    let settings = system.stepper.solver_settings();
    let needs_symmetry = matches!(settings.method, Method::Cg);
    let general = system.forces.iter().find(|force| !force.declaration().symmetric_tangent);
    if let (true, Some(force)) = (needs_symmetry, general) {
        let name = force.name();
        return Some(format!(
            "`cg` solves symmetric systems, but the stiffness of `{name}` is not symmetric: `gmres` takes its place"
        ));
    }
    let (asked, taken) = (settings.preconditioner, settings.preconditioner_instead()?);
    Some(format!("without a stored matrix there is no `{asked}`: `{taken}` takes its place"))
}
