//! Bodies become ranges of rows, masses and elastic forces of their systems.

use std::ops::Range;

use souple_engine::steppers::Stability;
use souple_engine::{Force, Kinematics, Mass, System, SystemState, UnknownKind};
use souple_math::{Mat3, Vec3};
use souple_mesh::{Mesh, OpeningSurface};
use souple_models::frames::ROWS_OF_FRAME;
use souple_models::loads::{Drag, LoadError, MassDamping};
use souple_models::materials::{self, Material};
use souple_models::particles::{FrictionFilter, NeighbourFriction, neighbours};
use souple_models::solids::{
    Adaptation, AdaptiveForce, DifferencedForce, FormulationError, Incompressibility, Incompressible,
    InelasticForce, RayleighDamping, SolidDescription, SolidForce, Viscosity, consistent_mass, formulated,
    lumped_mass, uniform_mass, voronoi_mass,
};

use super::frames::PlacedFrames;
use super::hanging::Hanging;
use super::levels::PlacedLevels;
use super::network::PlacedLinks;
use super::reduced::{self, PlacedReduced};
use super::{
    Draft, axes, frames, hanging, incompressible, inertial, levels, material_fields, modes, network, octree,
    section, shape, start, tissue,
};
use crate::diagnostic::{Code, Site};
use crate::reader::Chosen;
use crate::spec::body::{Body, Damping, MassKind, TangentKind};
use crate::spec::world::SystemSpec;

/// A body with its mesh and its rows in a system.
pub struct Placed<'a> {
    pub spec: &'a Body,
    pub system: usize,
    pub rows: Range<usize>,
    pub mesh: Mesh,
    /// The number that each point had in its file, ascending.
    pub point_numbers: Vec<u32>,
    pub materials: BodyMaterials,
    /// The axes of the law of each cell as columns; none: those of the world.
    pub axes: Vec<Mat3>,
    /// Which masses the links of a network join, table after table.
    pub links: Vec<PlacedLinks>,
    /// What carries it, where that is not its points.
    pub frames: Option<PlacedFrames>,
    /// The few unknowns that it moves in, where these are no points and no frames.
    pub reduced: Option<PlacedReduced>,
    /// Coarser meshes of it.
    pub levels: Option<PlacedLevels<'a>>,
    /// What some of its points hang on.
    pub hanging: Option<Hanging>,
}

impl Placed<'_> {
    /// Rows that its mass is on: those of its frames or few unknowns, or its points.
    pub fn mass_rows(&self) -> Range<usize> {
        let of_frames = self.frames.as_ref().map(PlacedFrames::row_range);
        let of_reduced = || self.reduced.as_ref().map(PlacedReduced::row_range);
        of_frames.or_else(of_reduced).unwrap_or_else(|| self.rows.clone())
    }

    /// Whether frames or few other unknowns carry its points, which are no unknowns then.
    pub fn is_carried(&self) -> bool {
        self.frames.is_some() || self.reduced.is_some()
    }

    /// Whether its pins hold points by springs; those of modes hold the frame.
    pub fn is_held_by_springs(&self) -> bool {
        self.is_carried() && !self.moves_in_modes()
    }

    pub fn moves_in_modes(&self) -> bool {
        matches!(self.reduced, Some(PlacedReduced::Modes(_)))
    }

    /// Its coarser meshes, each as if it were a body.
    pub fn levels_of(&self) -> impl Iterator<Item = &Self> {
        self.levels.iter().flat_map(|levels| &levels.coarser)
    }

    /// Whether this is one of the coarser meshes of a body.
    pub fn is_coarser(&self) -> bool {
        self.spec.levels.is_some() && self.levels.is_none()
    }

    /// Points of all its meshes, which are rows one after the other.
    fn point_count(&self) -> usize {
        self.mesh.points.len() + self.levels.as_ref().map_or(0, PlacedLevels::point_count)
    }
}

/// The materials of a body, and which of them each cell has.
#[derive(Default)]
pub struct BodyMaterials {
    pub all: Vec<Material>,
    pub of_cell: Vec<u16>,
}

impl BodyMaterials {
    pub fn of(&self, cell: usize) -> &Material {
        &self.all[usize::from(self.of_cell[cell])]
    }
}

/// Name of the elastic force of a body.
pub fn solid_name(body: &str) -> String {
    format!("{body}.material")
}

/// Builds all meshes and gives out rows; `None` where one was refused.
pub fn place(draft: &mut Draft) -> Option<()> {
    let spec = draft.spec;
    // every mesh is looked at, so that each refused one is reported; tissue is built between bodies that have one
    for index in tissue::in_order(draft) {
        place_one(draft, index);
    }
    let number = |body: &Placed| spec.bodies.iter().position(|other| std::ptr::eq(other, body.spec));
    draft.bodies.sort_by_key(number);
    let is_complete = |body: &Placed| {
        body.spec.frames.is_some() == body.frames.is_some()
            && (body.spec.modes.is_some() || body.spec.polynomial.is_some()) == body.reduced.is_some()
            && (body.spec.levels.is_some() || body.spec.octree.is_some()) == body.levels.is_some()
    };
    if draft.bodies.len() < spec.bodies.len()
        || !draft.bodies.iter().all(is_complete)
        || !draft.log.is_empty()
    {
        return None;
    }
    hanging::place(draft);
    if !draft.log.is_empty() {
        return None;
    }
    give_rows(&mut draft.bodies, spec.systems.len());
    Some(())
}

/// Builds the mesh of a body of the specification and what carries it.
fn place_one(draft: &mut Draft, index: usize) {
    let spec = draft.spec;
    let body = &spec.bodies[index];
    let built = match &body.network {
        Some(network) => network::build(body, network, draft),
        None => shape::build(body, draft).map(|shape| (shape, Vec::new())),
    };
    let Some((shape, links)) = built else { return };
    let Some(system) = spec.systems.iter().position(|system| system.name == body.system) else {
        return;
    };
    draft.warnings.extend(shape.warnings);
    let (mesh, point_numbers) = (shape.mesh, shape.point_numbers);
    let materials = BodyMaterials::default();
    let mut placed = Placed {
        spec: body,
        system,
        rows: 0..0,
        mesh,
        point_numbers,
        materials,
        axes: Vec::new(),
        links,
        frames: None,
        reduced: None,
        levels: None,
        hanging: None,
    };
    if let Some(materials) = materials_of(draft, &placed) {
        placed.materials = materials;
        placed.axes = axes::of_cells(draft, &placed);
    }
    if body.frames.is_some() {
        let mut warnings = Vec::new();
        let BodyMaterials { all, of_cell } = &placed.materials;
        placed.frames = frames::place(draft, body, &placed.mesh, all, of_cell, &mut warnings);
        draft.warnings.extend(warnings);
    }
    placed.reduced = reduced::place(draft, &placed);
    let mut warnings = Vec::new();
    placed.levels = levels::place(draft, body, system, &placed.mesh, &mut warnings)
        .or_else(|| octree::place(draft, body, system, &placed.mesh));
    draft.warnings.extend(warnings);
    draft.bodies.push(placed);
}

/// Rows of unknowns come first: points of meshes, then frames, then what other bodies move in; points that these carry follow, then those of
/// bodies that hang.
fn give_rows(bodies: &mut [Placed], systems: usize) {
    let mut next = vec![0; systems];
    let mut give = |system: usize, count: usize| {
        let first = next[system];
        next[system] += count;
        first..next[system]
    };
    for body in bodies.iter_mut().filter(|body| !body.is_carried()) {
        if let Some(hanging) = &mut body.hanging {
            let count = hanging.own.points().len();
            hanging.give_rows(give(body.system, count).start);
            continue;
        }
        let rows = give(body.system, body.point_count());
        body.rows = rows.start..rows.start + body.mesh.points.len();
        if let Some(levels) = &mut body.levels {
            levels.give_rows(body.rows.end);
        }
    }
    for body in bodies.iter_mut() {
        if let Some(frames) = &mut body.frames {
            frames.give_rows(give(body.system, ROWS_OF_FRAME * frames.frames.len()).start);
        }
    }
    for body in bodies.iter_mut() {
        if let Some(reduced) = &mut body.reduced {
            reduced.give_rows(give(body.system, reduced.kind().row_count()).start);
        }
    }
    for body in bodies.iter_mut().filter(|body| body.frames.is_some()) {
        body.rows = give(body.system, body.mesh.points.len());
    }
    for body in bodies.iter_mut().filter(|body| body.reduced.is_some()) {
        body.rows = give(body.system, body.mesh.points.len());
    }
    for system in 0..systems {
        for number in hanging::in_order(bodies, system) {
            bodies[number].rows = give(system, bodies[number].mesh.points.len());
        }
    }
}

/// The unknowns of a system and what hangs on them, in the order of [`give_rows`].
fn kinematics(draft: &Draft, index: usize) -> Kinematics {
    let bodies = || draft.bodies.iter().filter(|body| body.system == index);
    let mut kinematics = Kinematics::default();
    let unknowns = |body: &Placed| match &body.hanging {
        Some(hanging) => hanging.own.points().len(),
        None => body.point_count(),
    };
    let points = bodies().filter(|body| !body.is_carried()).map(unknowns).sum();
    kinematics.add_unknowns(UnknownKind::Point, points);
    for frames in bodies().filter_map(|body| body.frames.as_ref()) {
        kinematics.add_unknowns(frames.kind, frames.frames.len());
    }
    for reduced in bodies().filter_map(|body| body.reduced.as_ref()) {
        kinematics.add_unknowns(reduced.kind(), 1);
    }
    bodies().filter_map(|body| body.frames.as_ref()).for_each(|frames| frames.add_points(&mut kinematics));
    for body in bodies() {
        if let Some(reduced) = &body.reduced {
            reduced.add_points(&body.mesh.points, &mut kinematics);
        }
    }
    for number in hanging::in_order(&draft.bodies, index) {
        hanging::add_rows(&draft.bodies, number, &mut kinematics);
    }
    kinematics
}

/// A system with masses, elastic forces, gravity and damping of its bodies.
pub fn system(draft: &Draft, index: usize, spec: &SystemSpec) -> Option<System> {
    let bodies = || draft.bodies.iter().filter(|body| body.system == index);
    let kinematics = kinematics(draft, index);
    let mut mass = Mass::new(kinematics.row_count());
    let mut forces: Vec<Box<dyn Force>> = Vec::new();
    for body in bodies() {
        if let Some(network) = &body.spec.network {
            network::add_masses(body, network, &mut mass);
            network::add_forces(draft, body, network, spec, &mut forces);
            continue;
        }
        let materials = &body.materials;
        let section = body.spec.section();
        if !section::suits(draft, body, &materials.all) {
            continue;
        }
        let density = |cell: usize| materials.of(cell).density * section.measure();
        check_together(draft, body);
        incompressible::check(draft, body);
        if let (Some(frames), Some(spec)) = (&body.frames, &body.spec.frames) {
            frames.add_mass(body.spec.mass, &density, &mut mass);
            forces.push(frames.force(body, spec));
            continue;
        }
        if let Some(reduced) = &body.reduced {
            if let Err(error) = reduced.add(draft, body, &mut mass, &mut forces) {
                report(draft, body.spec, &error.into());
            }
            continue;
        }
        add_point_mass(draft, body, body.rows.start, &mut mass);
        if body.spec.octree.is_some() {
            forces.extend(octree::force(draft, body));
            continue;
        }
        if let Some(coarser) = &body.levels {
            forces.extend(levels::force(draft, body, coarser));
            continue;
        }
        let description = modes::description(body, body.rows.start);
        let kept = incompressible::rules(draft, body, spec);
        if let Err(error) = add_solid(body.spec, description, kept, &mut forces) {
            report(draft, body.spec, &error);
        }
    }
    mass.seal();
    add_outer_forces(draft, index, &mass, &kinematics, &mut forces);
    let stepper = spec.stepper.as_ref().map(|chosen| (chosen.entry.build)(&chosen.values))?;
    Some(System {
        name: spec.name.clone(),
        kinematics,
        mass,
        forces,
        constraints: Vec::new(),
        stepper,
        steps_per_period: spec.steps_per_period,
    })
}

/// The mass of the points of a body, rows from `first_row` on.
pub fn add_point_mass(draft: &Draft, body: &Placed, first_row: usize, mass: &mut Mass) {
    let measure = body.spec.section().measure();
    let density = |cell: usize| body.materials.of(cell).density * measure;
    match body.spec.mass {
        MassKind::Lumped => lumped_mass(&body.mesh, first_row, &density, mass),
        MassKind::Consistent => consistent_mass(&body.mesh, first_row, &density, mass),
        MassKind::Uniform => uniform_mass(&body.mesh, first_row, &density, mass),
        MassKind::Voronoi => {
            if voronoi_mass(&body.mesh, first_row, &density, mass).is_none() {
                let message = "only cells of simplices are cut half way between points";
                let expected = "cells `tet4` or `tri3`, or `mass = \"lumped\"`";
                draft.log.add(Code::Conflict, &body.spec.site, message, expected);
            }
        }
    }
}

/// The elastic force of a body and what damps its strain.
fn add_solid(
    body: &Body,
    description: SolidDescription,
    kept: Option<Incompressibility>,
    forces: &mut Vec<Box<dyn Force>>,
) -> Result<(), FormulationError> {
    let (mesh, first_row) = (description.mesh, description.first_row);
    let solid = solid(body, &description)?;
    forces.push(match kept {
        Some(rules) => Box::new(Incompressible::new(solid, mesh, first_row, rules)),
        None => solid,
    });
    add_damping(body, description, forces)
}

/// The force of its material.
fn solid(body: &Body, description: &SolidDescription) -> Result<Box<dyn Force>, FormulationError> {
    if let Some(spec) = &body.inelasticity {
        return Ok(Box::new(InelasticForce::new(description, spec.rules)?));
    }
    let elastic: Box<dyn Force> = match (&body.formulation, adapted(body, description.materials.len())) {
        (Some(chosen), _) => formulated(chosen.entry.build, description, &chosen.values)?,
        (None, Some((seconds, adaptation))) => {
            Box::new(AdaptiveForce::new(description, &seconds, adaptation)?)
        }
        (None, None) => Box::new(SolidForce::new(description)?),
    };
    Ok(match body.tangent {
        TangentKind::Exact => elastic,
        TangentKind::Difference => {
            Box::new(DifferencedForce::new(elastic, description.mesh, description.first_row))
        }
    })
}

/// What damps the strain of a body.
fn add_damping(
    body: &Body,
    description: SolidDescription,
    forces: &mut Vec<Box<dyn Force>>,
) -> Result<(), FormulationError> {
    let Damping { rayleigh_stiffness, viscosity, .. } = body.damping;
    if rayleigh_stiffness > 0.0 {
        let name = format!("{}.rayleigh_stiffness", body.name);
        let description = SolidDescription { name, ..description.clone() };
        forces.push(Box::new(RayleighDamping::new(&description, rayleigh_stiffness)?));
    }
    if viscosity > 0.0 {
        let description = SolidDescription { name: format!("{}.viscosity", body.name), ..description };
        forces.push(Box::new(Viscosity::new(&description, viscosity)?));
    }
    Ok(())
}

/// The laws that take over in a body that adapts, of each of its `count` materials as [`materials_of`] orders them, and when.
fn adapted(body: &Body, count: usize) -> Option<(Vec<Material>, Adaptation)> {
    let adapt = body.adapt.as_ref()?;
    // tried when the scene was read
    let made = |chosen: &Chosen<materials::Build>| (chosen.entry.build)(&chosen.values).ok();
    let of_body = made(adapt.material.as_ref()?)?;
    let mut seconds = vec![of_body; count];
    let regions = body.regions.iter().filter(|part| part.region.is_some() && part.material.is_some());
    for (second, part) in seconds[1..].iter_mut().zip(regions) {
        if let Some(chosen) = &part.adapts_to {
            *second = made(chosen)?;
        }
    }
    Some((seconds, adapt.adaptation.clone()))
}

/// Reports what a body whose rest shape gives way cannot have besides.
fn check_inelasticity(draft: &Draft, placed: &Placed) {
    let body = placed.spec;
    let Some(spec) = &body.inelasticity else { return };
    if !placed.materials.all.iter().all(|material| material.law.is_objective()) {
        let message = format!(
            "a law of body `{}` takes rotations for strain, which would go over into its rest shape",
            body.name
        );
        draft.log.add(
            Code::Conflict,
            &spec.site,
            message,
            "a law that knows rotations, such as `corotational`",
        );
    }
    let others = [
        ("frames", body.frames.is_some()),
        ("modes", body.modes.is_some()),
        ("polynomial", body.polynomial.is_some()),
        ("levels", body.levels.is_some()),
        ("octree", body.octree.is_some()),
        ("section", body.section().dimension() < 3),
        ("formulation", body.formulation.is_some()),
        ("adapt", body.adapt.is_some()),
        ("tangent = \"difference\"", body.tangent == TangentKind::Difference),
    ];
    for (other, _) in others.into_iter().filter(|(_, is_there)| *is_there) {
        let message =
            format!("body `{}` has `{other}`, and its rest shape cannot give way besides", body.name);
        draft.log.add(Code::Conflict, &spec.site, message, "a body of volume elements that has none of it");
    }
    let Damping { rayleigh_stiffness, viscosity, .. } = body.damping;
    if spec.rules.fracture.is_some() && (rayleigh_stiffness > 0.0 || viscosity > 0.0) {
        let message = format!("what damps the strain of body `{}` would hold torn cells together", body.name);
        let expected = "`rayleigh_mass`, or no `fracture`";
        draft.log.add(Code::Conflict, &spec.site, message, expected);
    }
}

/// Reports what a body cannot have together.
fn check_together(draft: &Draft, placed: &Placed) {
    let body = placed.spec;
    let report = |site: &Site, message: String, expected: &str| {
        draft.log.add(Code::Conflict, site, message, expected);
    };
    let carriers = [
        ("frames", body.frames.is_some()),
        ("modes", body.modes.is_some()),
        ("polynomial", body.polynomial.is_some()),
        ("levels", body.levels.is_some()),
        ("octree", body.octree.is_some()),
    ];
    for (carrier, _) in carriers.into_iter().filter(|(_, is_there)| *is_there) {
        let message =
            |key: &str| format!("`{carrier}` carry body `{}`, and know one way only: no `{key}`", body.name);
        if let Some(chosen) = &body.formulation {
            report(&chosen.site, message("formulation"), "a formulation of a body of points alone");
        }
        if body.tangent == TangentKind::Difference {
            report(&body.site, message("tangent"), "`tangent = \"exact\"`");
        }
    }
    if let Some(start) = &body.start
        && (body.frames.is_some() || body.levels.is_some() || body.octree.is_some())
    {
        let message = format!("the points of body `{}` follow its frames or levels", body.name);
        report(&start.site, message, "`velocity` and `angular_velocity`, or a body of points alone");
    }
    check_inelasticity(draft, placed);
    let Some(adapt) = &body.adapt else { return };
    let others = [
        ("frames", body.frames.is_some()),
        ("levels", body.levels.is_some()),
        ("octree", body.octree.is_some()),
        // edges have no area and no faces
        ("section", body.section().dimension() == 1),
        ("formulation", body.formulation.is_some()),
    ];
    for (other, _) in others.into_iter().filter(|(_, is_there)| *is_there) {
        let message = format!("body `{}` has `{other}`, and its elements cannot adapt besides", body.name);
        let expected = match other {
            "formulation" => {
                "no `formulation`: elements that adapt are evaluated sample by sample, or by the stiffness that cells \
                              of one shape share"
            }
            _ => "`adapt` in a body of volumes or of surface elements",
        };
        report(&adapt.site, message, expected);
    }
}

/// Reports why a body has no such force.
fn report(draft: &Draft, body: &Body, error: &FormulationError) {
    let (code, site, expected) = match error {
        FormulationError::Flat(_) => {
            (Code::Mesh, body.mesh.as_ref().map(|mesh| mesh.site()), "cells with volume")
        }
        FormulationError::Cut { .. } => (
            Code::OutOfRange,
            body.formulation.as_ref().map(|chosen| chosen.site_of("cut")),
            "none, all, or letters of L, G, N, D",
        ),
        _ => (
            Code::Conflict,
            body.formulation.as_ref().map(|chosen| &chosen.site),
            "another formulation: `samples` takes all laws on all elements",
        ),
    };
    draft.log.add(code, site.unwrap_or(&body.site), error.to_string(), expected);
}

/// Forces on the whole system, drag and damping of its bodies.
fn add_outer_forces(
    draft: &Draft,
    index: usize,
    mass: &Mass,
    kinematics: &Kinematics,
    forces: &mut Vec<Box<dyn Force>>,
) {
    inertial::add(draft, index, mass, kinematics, forces);
    for body in draft.bodies.iter().filter(|body| body.system == index) {
        let (name, damping) = (&body.spec.name, body.spec.damping);
        let mut added: Vec<Result<Box<dyn Force>, LoadError>> = Vec::new();
        // points of levels fade by themselves
        if damping.rayleigh_mass > 0.0 && body.levels.is_none() {
            let part = part_of_mass(mass, &body.mass_rows());
            let force = MassDamping::new(format!("{name}.rayleigh_mass"), part, damping.rayleigh_mass);
            added.push(force.map(|force| Box::new(force) as _));
        }
        if damping.neighbour_friction > 0.0 {
            added.extend(neighbour_friction(draft, body, mass).map(|force| Ok(Box::new(force) as _)));
        }
        if body.spec.drag > 0.0 {
            let force = Drag::new(format!("{name}.drag"), surface_shares(body), body.spec.drag);
            added.push(force.map(|force| Box::new(force) as _));
        }
        if let Some(network) = &body.spec.network {
            let shares = network::drags(body, network);
            if !shares.is_empty() {
                added.push(Drag::new(format!("{name}.drag"), shares, 1.0).map(|force| Box::new(force) as _));
            }
        }
        for force in added {
            match force {
                Ok(force) => forces.push(force),
                Err(error) => {
                    draft.log.add(Code::OutOfRange, &body.spec.site, error.to_string(), "finite numbers")
                }
            }
        }
    }
}

/// Friction of a body's points against their neighbours; `None` of a body whose points follow others.
fn neighbour_friction(draft: &Draft, body: &Placed, mass: &Mass) -> Option<NeighbourFriction> {
    let refuse = |message: &str, expected: &str| {
        draft.log.add(Code::Conflict, &body.spec.site, message, expected);
        None
    };
    if body.is_carried() || body.levels.is_some() || body.spec.network.is_some() {
        return refuse("`neighbour_friction` is of points that move by themselves", "a body of points alone");
    }
    let system = draft.spec.systems.get(body.system)?;
    let filter = if body.spec.damping.friction_filter {
        let is_explicit = system.stepper.as_ref().is_none_or(|chosen| {
            (chosen.entry.build)(&chosen.values).stability() != Stability::Unconditional
        });
        if !is_explicit {
            return refuse("`friction_filter` has no tangent", "an explicit stepper, or no filter");
        }
        let timestep = draft.timestep(system);
        FrictionFilter::Drop { timestep }
    } else {
        FrictionFilter::None
    };
    Some(NeighbourFriction::new(
        format!("{}.neighbour_friction", body.spec.name),
        body.rows.start,
        body.spec.damping.neighbour_friction,
        neighbours(&body.mesh),
        mass.diagonal[body.rows.clone()].to_vec(),
        filter,
    ))
}

/// The mass of some rows.
fn part_of_mass(mass: &Mass, rows: &Range<usize>) -> Mass {
    let mut part = Mass::new(mass.diagonal.len());
    part.diagonal[rows.clone()].copy_from_slice(&mass.diagonal[rows.clone()]);
    part.couplings =
        mass.couplings.iter().copied().filter(|(a, _, _)| rows.contains(&(*a as usize))).collect();
    part
}

/// Rows of a body's surface with their shares of its area; of a body of edges, with their shares of its length.
fn surface_shares(body: &Placed) -> Vec<(u32, f64)> {
    if body.mesh.dimension() == 1 {
        let mut lengths = Mass::new(body.mesh.points.len());
        lumped_mass(&body.mesh, 0, &|_| 1.0, &mut lengths);
        let total: f64 = lengths.diagonal.iter().sum();
        return (body.rows.start as u32..).zip(&lengths.diagonal).map(|(row, l)| (row, l / total)).collect();
    }
    let surface = OpeningSurface::from(body.mesh.boundary_surface());
    let areas = surface.point_areas(0.0);
    let total: f64 = areas.iter().sum();
    let first = body.rows.start as u32;
    let points = surface.surface.mesh_points.iter();
    points.zip(&areas).map(|(point, area)| (first + point, area / total)).collect()
}

fn materials_of(draft: &Draft, body: &Placed) -> Option<BodyMaterials> {
    let main = body.spec.material.as_ref()?;
    // tried when the scene was read
    let mut materials = vec![(main.entry.build)(&main.values).ok()?];
    let mut material_of_cell = vec![0_u16; body.mesh.cell_count()];
    for part in &body.spec.regions {
        let (Some(region), Some(chosen)) = (&part.region, &part.material) else { continue };
        let number = match u16::try_from(materials.len()) {
            Ok(number) => number,
            Err(_) => {
                let message = format!("body `{}` has more than {} materials", body.spec.name, u16::MAX);
                draft.log.add(Code::TooLarge, &region.site, message, "fewer regions");
                return None;
            }
        };
        materials.push((chosen.entry.build)(&chosen.values).ok()?);
        for cell in draft.selector(body).cells(region) {
            material_of_cell[cell as usize] = number;
        }
    }
    material_fields::spread(draft, body, BodyMaterials { all: materials, of_cell: material_of_cell })
}

/// Rest positions and initial velocities. Pinned points stand where their pins want them, but for steppers that look for
/// equilibrium: those lead them there with all others, from rest.
pub fn initial_state(draft: &Draft, system: &System, index: usize) -> SystemState {
    let bodies = || draft.bodies.iter().filter(|body| body.system == index);
    let mut q = vec![Vec3::ZERO; system.kinematics.free_row_count()];
    for body in bodies() {
        match (&body.frames, &body.reduced) {
            (Some(frames), _) => {
                q[frames.row_range()].iter_mut().zip(frames.configuration()).for_each(|(q, row)| *q = row);
            }
            (None, Some(reduced)) => reduced.rest_into(&mut q),
            (None, None) => {
                for (point, x) in (0..).zip(&body.mesh.points) {
                    if let Some(row) = body.own_row(point) {
                        q[row as usize] = *x;
                    }
                }
            }
        }
    }
    let mut state = system.initial_state(q);
    for body in bodies() {
        // v + ω × (x - c)
        let points = &body.mesh.points;
        let centre = match body.spec.network {
            Some(_) => points.iter().copied().sum::<Vec3>() / points.len() as f64,
            None => body.mesh.centroid(),
        };
        let (velocity, angular_velocity) = (body.spec.velocity, body.spec.angular_velocity);
        if let Some(coarser) = &body.levels {
            levels::start(coarser, [velocity, angular_velocity, centre], &mut state.q, &mut state.v);
        }
        let motion = [velocity, angular_velocity, centre];
        match (&body.frames, &body.reduced) {
            (Some(frames), _) => frames.start_velocity(&system.kinematics, motion, &mut state.v),
            (None, Some(reduced)) => reduced.start_velocity(&system.kinematics, motion, &mut state.v),
            (None, None) => {
                for (point, x) in (0..).zip(points) {
                    if let Some(row) = body.own_row(point) {
                        state.v[row as usize] = velocity + angular_velocity.cross(*x - centre);
                    }
                }
            }
        }
        start::apply(draft, body, &mut state);
        if let Some(network) = &body.spec.network {
            network::add_velocities(body, network, &mut state.v);
        }
    }
    let load = if system.stepper.has_inertia() { 1.0 } else { 0.0 };
    system.impose_constraints(&mut state.q, &mut state.v, 0.0, load);
    state
}
