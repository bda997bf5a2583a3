//! Bodies of particles of an octree: the coarser particles get rows behind the points of the body's mesh.

use std::collections::BTreeMap;

use souple_engine::levels::{Filter, Levels};
use souple_engine::{Force, Mass};
use souple_mesh::{Group, Mesh};
use souple_models::materials::{AnyLaw, MaterialLaw};
use souple_models::particles::octree::{Octree, OctreeDescription, OctreeForce};
use souple_models::solids::{Section, lumped_mass, uniform_mass};
use souple_table::Value;

use super::Draft;
use super::bodies::{BodyMaterials, Placed, solid_name};
use super::levels::{PlacedLevels, check_fixed};
use crate::diagnostic::Code;
use crate::spec::body::{Body, MassKind};
use crate::spec::octree::OctreeSpec;
use crate::spec::world::SystemSpec;

/// Groups the points of a body; `None` where they are on no lattice, or the body has no octree.
pub fn place<'a>(draft: &Draft, body: &'a Body, system: usize, mesh: &Mesh) -> Option<PlacedLevels<'a>> {
    let spec = body.octree.as_ref()?;
    if !suits(draft, body, spec) {
        return None;
    }
    let tree = tree_of(draft, body, spec, mesh)?;
    let level = |level: usize| {
        let points: Vec<_> = tree.levels[level].clone().map(|at| tree.rest[at]).collect();
        let point_numbers = (0..points.len() as u32).collect();
        let groups = groups_of(&tree, level, mesh);
        Placed {
            spec: body,
            system,
            rows: 0..0,
            mesh: Mesh { points, groups, ..Mesh::default() },
            point_numbers,
            materials: BodyMaterials::default(),
            axes: Vec::new(),
            links: Vec::new(),
            frames: None,
            levels: None,
            reduced: None,
            hanging: None,
        }
    };
    Some(PlacedLevels { coarser: (0..tree.finest()).map(level).collect() })
}

/// A particle is of a group if one of the points that it stands for is.
fn groups_of(tree: &Octree, level: usize, mesh: &Mesh) -> BTreeMap<String, Group> {
    let above = |point: u32| {
        let mut at = point as usize;
        while usize::from(tree.level_of[at]) > level {
            at = tree.mother[at]? as usize;
        }
        Some((at - tree.levels[level].start) as u32)
    };
    let of = |group: &Group| {
        let mut points: Vec<u32> = group.points.iter().filter_map(|point| above(*point)).collect();
        points.sort_unstable();
        points.dedup();
        Group { points, ..Group::default() }
    };
    mesh.groups.iter().map(|(name, group)| (name.clone(), of(group))).collect()
}

fn suits(draft: &Draft, body: &Body, spec: &OctreeSpec) -> bool {
    let refuse = |message: &str, expected: &str| {
        draft.log.add(Code::Conflict, &spec.site, message, expected);
        false
    };
    if body.section() != Section::Solid || body.frames.is_some() || body.levels.is_some() {
        return refuse("particles of an octree are of volumes", "no `section`, `frames` or `levels` beside");
    }
    if body.formulation.is_some() {
        return refuse(
            "an octree has operators of its own",
            "`operators` of the octree, and no `formulation`",
        );
    }
    if matches!(body.mass, MassKind::Consistent | MassKind::Voronoi) {
        return refuse("particles have masses of their own", "`mass = \"uniform\"` or `\"lumped\"`");
    }
    if !body.regions.is_empty() {
        return refuse("particles of an octree are of one material", "no `regions`");
    }
    if !body.material_fields.is_empty() {
        return refuse("particles of an octree are of one material", "no `material_fields`");
    }
    if body.damping.rayleigh_stiffness > 0.0 || body.damping.viscosity > 0.0 {
        return refuse("particles know no rates of strain", "`rayleigh_mass`");
    }
    let is_linear = body.material.as_ref().and_then(|chosen| (chosen.entry.build)(&chosen.values).ok());
    if is_linear.is_some_and(|material| material.of_table().law != MaterialLaw::Known(AnyLaw::Linear)) {
        return refuse(
            "operators on particles are of the linear law",
            "`material = { name = \"linear\", … }`",
        );
    }
    true
}

fn tree_of(draft: &Draft, body: &Body, spec: &OctreeSpec, mesh: &Mesh) -> Option<Octree> {
    let density =
        body.material.as_ref().and_then(|chosen| (chosen.entry.build)(&chosen.values).ok())?.density;
    let mut volumes = Mass::new(mesh.points.len());
    let spread = if body.mass == MassKind::Uniform { uniform_mass } else { lumped_mass };
    spread(mesh, 0, &|_| 1.0, &mut volumes);
    let masses: Vec<f64> = volumes.diagonal.iter().map(|volume| volume * density).collect();
    // the shortest edge of the first cell: of a lattice all are alike
    let cell = mesh.cells().next();
    let spacing = cell.iter().flat_map(|cell| cell.kind.edges().iter().map(move |edge| (cell, edge)));
    let length = |(cell, [a, b]): (&souple_mesh::Cell, &[u8; 2])| {
        let [a, b] = [a, b].map(|end| mesh.points[cell.nodes[usize::from(*end)] as usize]);
        (b - a).length()
    };
    let spacing = spacing.map(length).fold(f64::INFINITY, f64::min);
    match Octree::new(&mesh.points, &masses, &volumes.diagonal, spacing, spec.levels) {
        Ok(tree) => Some(tree),
        Err(error) => {
            let expected = "points of a lattice of cubes along the axes, such as a box of hex8, and fewer levels than it has";
            draft.log.add(Code::Mesh, &spec.site, error.to_string(), expected);
            None
        }
    }
}

/// The elastic force of a body of an octree.
pub fn force(draft: &Draft, body: &Placed) -> Option<Box<dyn Force>> {
    let spec = body.spec.octree.as_ref()?;
    let system = draft.spec.systems.get(body.system)?;
    let force = OctreeForce::new(OctreeDescription {
        name: solid_name(&body.spec.name),
        tree: tree_of(draft, body.spec, spec, &body.mesh)?,
        first_row: body.rows.start,
        moduli: body.materials.all.first()?.small_strain,
        operators: spec.operators,
        variant: spec.variant,
        choice: spec.choice(),
        mass_damping: body.spec.damping.rayleigh_mass,
    });
    check_fixed(draft, &spec.site, spec.fixed.as_ref(), &force.tree().rest, force.tree().levels.len());
    check_steps(draft, system, &force);
    Some(Box::new(force))
}

/// Whether the shortest interval of the stepper is short enough.
fn check_steps(draft: &Draft, system: &SystemSpec, force: &OctreeForce) {
    let Some(stepper) = &system.stepper else { return };
    let Some(Value::Integer(halvings)) = stepper.values.get("halvings") else { return };
    let step = draft.timestep(system);
    let (tick, needed) = (step / (1_u64 << halvings) as f64, force.shortest_interval(Filter::None));
    if tick > needed {
        let enough = (step / needed).log2().ceil();
        let message =
            format!("the shortest interval is {tick:.3e} s, and some particles need {needed:.3e} s");
        let expected = format!("halvings = {enough}, or a shorter period");
        draft.log.add(Code::Conflict, stepper.site_of("halvings"), message, expected);
    }
    if stepper.values.boolean("semi_implicit") {
        let message = "particles of an octree know no semi-implicit push";
        draft.log.add(Code::Conflict, stepper.site_of("semi_implicit"), message, "`semi_implicit = false`");
    }
}
