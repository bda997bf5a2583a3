//! Bodies whose volume is kept: what they cannot have besides, and when their multipliers take over.

use souple_engine::Stepper;
use souple_engine::steppers::Stability;
use souple_models::solids::{Incompressibility, Multipliers, Pressures};

use super::{Draft, Placed};
use crate::diagnostic::Code;
use crate::spec::incompressible::IncompressibleSpec;
use crate::spec::world::SystemSpec;

/// By what share of itself a volume may change where the scene does not say.
const TOLERANCE: f64 = 1e-6;

/// Reports `incompressible` of a body that cannot have it.
pub fn check(draft: &Draft, body: &Placed) {
    let Some(spec) = &body.spec.incompressible else { return };
    let refuse =
        |message: String, expected: &str| draft.log.add(Code::Conflict, &spec.site, message, expected);
    let tears = body.spec.inelasticity.as_ref().is_some_and(|spec| spec.rules.fracture.is_some());
    let others = [
        ("frames", body.spec.frames.is_some()),
        ("modes", body.spec.modes.is_some()),
        ("polynomial", body.spec.polynomial.is_some()),
        ("levels", body.spec.levels.is_some()),
        ("octree", body.spec.octree.is_some()),
        ("section", body.spec.section().dimension() < 3),
        ("inelasticity.fracture", tears),
    ];
    for (other, _) in others.into_iter().filter(|(_, is_there)| *is_there) {
        let message =
            format!("body `{}` has `{other}`, and its volume cannot be kept besides", body.spec.name);
        refuse(message, "a body of volume elements that has none of it");
    }
    let is_quadratic = body.mesh.blocks.iter().any(|block| !block.kind.is_linear());
    if spec.pressures == Pressures::Points && is_quadratic {
        let message = format!(
            "the points of body `{}` are not all corners, which share out the volume of cells",
            body.spec.name
        );
        refuse(message, "`pressures = \"cells\"`, or elements with linear shape functions");
    }
}

/// How the volume of a body is kept under the stepper of its system.
pub fn rules(draft: &Draft, body: &Placed, system: &SystemSpec) -> Option<Incompressibility> {
    let spec = body.spec.incompressible.as_ref()?;
    let stepper = system.stepper.as_ref().map(|chosen| (chosen.entry.build)(&chosen.values))?;
    let multipliers = multipliers(draft, body, spec, stepper.as_ref())?;
    Some(Incompressibility { penalty: spec.penalty, multipliers, pressures: spec.pressures })
}

fn multipliers(
    draft: &Draft,
    body: &Placed,
    spec: &IncompressibleSpec,
    stepper: &dyn Stepper,
) -> Option<Multipliers> {
    let name = &body.spec.name;
    let refuse = |message: String, expected: &str| {
        draft.log.add(Code::Conflict, &spec.site, message, expected);
        None
    };
    if stepper.augments() {
        if spec.time.is_some() {
            let message =
                format!("`{}` solves for the volume of body `{name}` in every step", stepper.name());
            return refuse(message, "`tolerance`, and no `time`");
        }
        return Some(Multipliers::Solved { tolerance: spec.tolerance.unwrap_or(TOLERANCE) });
    }
    if stepper.stability() == Stability::Unconditional {
        let message = format!("one linearised solve in a step does not keep the volume of body `{name}`");
        return refuse(message, "`newton = \"full\"`");
    }
    let Some(time) = spec.time else {
        let message = format!(
            "`{}` solves no equations, from which multipliers of body `{name}` would follow",
            stepper.name()
        );
        return refuse(message, "a `time` in which they take over");
    };
    if spec.tolerance.is_some() {
        let message = format!(
            "under `{}` the volume of body `{name}` comes to be kept, to no tolerance",
            stepper.name()
        );
        return refuse(message, "`time`, and no `tolerance`");
    }
    let damping = body.spec.damping.rayleigh_mass;
    if time * damping < 1.0 {
        let message = format!(
            "multipliers that take over in {time} s would make the volume of body `{name}` swing ever wider: its `rayleigh_mass` damps by {damping}/s"
        );
        return refuse(message, &format!("`rayleigh_mass` of at least {}/s, or more `time`", 1.0 / time));
    }
    Some(Multipliers::Relaxed { time })
}
