//! Bodies of several meshes: the coarser ones are made or read, and get rows behind those of the body's own mesh.

use souple_engine::Force;
use souple_math::Vec3;
use souple_mesh::Mesh;
use souple_mesh::coarsen::{coarser, mean_edge};
use souple_models::multiresolution::{Coupling, LevelsDescription, LevelsForce};
use souple_models::solids::Section;
use souple_table::Value;

use super::bodies::{BodyMaterials, Placed, solid_name};
use super::{Draft, shape};
use crate::diagnostic::Code;
use crate::spec::body::{Body, MassKind};
use crate::spec::levels::LevelsSpec;
use crate::spec::world::SystemSpec;

/// The coarser meshes of a body, from coarse to fine.
pub struct PlacedLevels<'a> {
    /// Each like a body with the keys of the whole one, for what is chosen on it by regions.
    pub coarser: Vec<Placed<'a>>,
}

impl PlacedLevels<'_> {
    pub fn point_count(&self) -> usize {
        self.coarser.iter().map(|level| level.mesh.points.len()).sum()
    }

    pub fn give_rows(&mut self, first: usize) {
        let mut next = first;
        for level in &mut self.coarser {
            level.rows = next..next + level.mesh.points.len();
            next = level.rows.end;
        }
    }
}

/// Makes or reads the coarser meshes of a body; `None` where one was refused, or is none of a body with levels.
pub fn place<'a>(
    draft: &Draft,
    body: &'a Body,
    system: usize,
    mesh: &Mesh,
    warnings: &mut Vec<String>,
) -> Option<PlacedLevels<'a>> {
    let spec = body.levels.as_ref()?;
    if !suits(draft, body, spec) {
        return None;
    }
    let level = |mesh: Mesh, point_numbers: Vec<u32>| Placed {
        spec: body,
        system,
        rows: 0..0,
        mesh,
        point_numbers,
        materials: BodyMaterials::default(),
        links: Vec::new(),
        frames: None,
        levels: None,
    };
    let mut placed = Vec::new();
    for mesh in &spec.coarser {
        let shape = shape::build_of(body, mesh, draft)?;
        warnings.extend(shape.warnings);
        placed.push(level(shape.mesh, shape.point_numbers));
    }
    if spec.coarser.is_empty() {
        let edge = mean_edge(mesh);
        for finer in (1..spec.count).rev() {
            match coarser(mesh, edge * spec.ratio.powi(finer as i32)) {
                Ok(mesh) => placed.push(level(mesh.clone(), (0..mesh.points.len() as u32).collect())),
                Err(error) => {
                    let expected = "fewer levels, or a smaller ratio";
                    draft.log.add(Code::Mesh, &spec.site, error.to_string(), expected);
                    return None;
                }
            }
        }
    }
    Some(PlacedLevels { coarser: placed })
}

fn suits(draft: &Draft, body: &Body, spec: &LevelsSpec) -> bool {
    let refuse = |message: &str, expected: &str| {
        draft.log.add(Code::Conflict, &spec.site, message, expected);
        false
    };
    if body.section() != Section::Solid || body.frames.is_some() {
        return refuse(
            "levels are of volumes that their points carry",
            "no `section` and no `frames` beside",
        );
    }
    if body.mass != MassKind::Lumped {
        return refuse("points of levels have masses of their own", "`mass = \"lumped\"`");
    }
    if body.damping.rayleigh_stiffness > 0.0 {
        return refuse("levels have no damping by the stiffness at rest", "`viscosity` or `rayleigh_mass`");
    }
    true
}

/// The elastic force of a body of levels; `None` where its meshes were refused.
pub fn force(draft: &Draft, body: &Placed, levels: &PlacedLevels) -> Option<Box<dyn Force>> {
    let spec = body.spec.levels.as_ref()?;
    let meshes: Vec<&Mesh> = levels.coarser.iter().map(|level| &level.mesh).chain([&body.mesh]).collect();
    let system = draft.spec.systems.get(body.system)?;
    let description = LevelsDescription {
        name: solid_name(&body.spec.name),
        meshes: &meshes,
        first_row: body.rows.start,
        materials: &body.materials.all,
        material_of_cell: &body.materials.of_cell,
        coupling: spec.coupling,
        choice: spec.choice(),
        viscosity: body.spec.damping.viscosity,
        mass_damping: body.spec.damping.rayleigh_mass,
        budget: spec.budget,
    };
    match LevelsForce::new(description) {
        Ok(force) => {
            check_steps(draft, system, spec, &force);
            Some(Box::new(force))
        }
        Err(error) => {
            let expected = "tetrahedra of one body, from coarse to fine";
            draft.log.add(Code::Mesh, &spec.site, error.to_string(), expected);
            None
        }
    }
}

/// Whether the shortest interval of the stepper is short enough, and its filter one for this coupling.
fn check_steps(draft: &Draft, system: &SystemSpec, spec: &LevelsSpec, force: &LevelsForce) {
    let Some(stepper) = &system.stepper else { return };
    let Some(Value::Integer(halvings)) = stepper.values.get("halvings") else { return };
    let step = draft.spec.world.period / f64::from(system.steps_per_period);
    let (tick, needed) = (step / (1_u64 << halvings) as f64, force.shortest_interval());
    if tick > needed {
        let enough = (step / needed).log2().ceil();
        let message = format!("the shortest interval is {tick:.3e} s, and some points need {needed:.3e} s");
        let expected = format!("halvings = {enough}, or a shorter period");
        draft.log.add(Code::Conflict, stepper.site_of("halvings"), message, expected);
    }
    if stepper.values.boolean("semi_implicit") && spec.coupling == Coupling::Transpose {
        let message = "semi-implicit points brake all motion, and this coupling keeps its momentum";
        draft.log.add(Code::Conflict, stepper.site_of("semi_implicit"), message, "`coupling = \"one_way\"`");
    }
}

/// Rest positions and start velocities of the coarser points: `v + ω × (x - c)` as those of the body.
pub fn start(levels: &PlacedLevels, motion: [Vec3; 3], q: &mut [Vec3], v: &mut [Vec3]) {
    let [velocity, spin, centre] = motion;
    for level in &levels.coarser {
        for (row, x) in level.rows.clone().zip(&level.mesh.points) {
            q[row] = *x;
            v[row] = velocity + spin.cross(*x - centre);
        }
    }
}
