//! Bodies become ranges of rows, masses and elastic forces of their systems.

use std::ops::Range;

use souple_engine::{Force, Kinematics, Mass, System, SystemState, UnknownKind};
use souple_math::Vec3;
use souple_mesh::{Mesh, TriangleSurface};
use souple_models::loads::{Drag, Gravity, LoadError, MassDamping};
use souple_models::materials::Material;
use souple_models::solids::{
    FlatCell, RayleighDamping, Section, SolidDescription, SolidForce, Viscosity, consistent_mass, lumped_mass,
};

use super::boundary::constant_vector;
use super::network::PlacedLinks;
use super::{Draft, network, shape};
use crate::diagnostic::Code;
use crate::spec::body::{Body, Damping, MassKind};
use crate::spec::world::SystemSpec;

/// A body with its mesh and its rows in a system.
pub struct Placed<'a> {
    pub spec: &'a Body,
    pub system: usize,
    pub rows: Range<usize>,
    pub mesh: Mesh,
    /// The number that each point had in its file, ascending.
    pub point_numbers: Vec<u32>,
    /// Which masses the links of a network join, table after table.
    pub links: Vec<PlacedLinks>,
}

/// Name of the elastic force of a body.
pub fn solid_name(body: &str) -> String {
    format!("{body}.material")
}

/// Builds all meshes and gives out rows; `None` where one was refused.
pub fn place(draft: &mut Draft) -> Option<()> {
    let spec = draft.spec;
    let mut next_row = vec![0; spec.systems.len()];
    // every mesh is looked at, so that each refused one is reported
    for body in &spec.bodies {
        let built = match &body.network {
            Some(network) => network::build(body, network, draft),
            None => shape::build(body, draft).map(|shape| (shape, Vec::new())),
        };
        let Some((shape, links)) = built else { continue };
        let Some(system) = spec.systems.iter().position(|system| system.name == body.system) else {
            continue;
        };
        draft.warnings.extend(shape.warnings);
        let first = next_row[system];
        next_row[system] += shape.mesh.points.len();
        let rows = first..next_row[system];
        draft.bodies.push(Placed {
            spec: body,
            system,
            rows,
            mesh: shape.mesh,
            point_numbers: shape.point_numbers,
            links,
        });
    }
    (draft.bodies.len() == spec.bodies.len() && draft.log.is_empty()).then_some(())
}

/// A system with masses, elastic forces, gravity and damping of its bodies.
pub fn system(draft: &Draft, index: usize, spec: &SystemSpec) -> Option<System> {
    let bodies = || draft.bodies.iter().filter(|body| body.system == index);
    let mut kinematics = Kinematics::default();
    let row_count = bodies().map(|body| body.mesh.points.len()).sum();
    kinematics.add_unknowns(UnknownKind::Point, row_count);
    let mut mass = Mass::new(row_count);
    let mut forces: Vec<Box<dyn Force>> = Vec::new();
    for body in bodies() {
        if let Some(network) = &body.spec.network {
            network::add_masses(body, network, &mut mass);
            network::add_forces(draft, body, network, spec, &mut forces);
            continue;
        }
        let Some((materials, material_of_cell)) = materials_of(draft, body) else { continue };
        let section = body.spec.section();
        if !suits(draft, body, &materials) {
            continue;
        }
        let density =
            |cell: usize| materials[usize::from(material_of_cell[cell])].density * section.measure();
        match body.spec.mass {
            MassKind::Lumped => lumped_mass(&body.mesh, body.rows.start, &density, &mut mass),
            MassKind::Consistent => consistent_mass(&body.mesh, body.rows.start, &density, &mut mass),
        }
        let description = SolidDescription {
            name: solid_name(&body.spec.name),
            mesh: &body.mesh,
            first_row: body.rows.start,
            materials: &materials,
            material_of_cell: &material_of_cell,
            quadrature: body.spec.quadrature,
            section,
        };
        if let Err(error) = add_solid(body.spec, description, &mut forces) {
            let site = body.spec.mesh.as_ref().map_or(&body.spec.site, |mesh| mesh.site());
            draft.log.add(Code::Mesh, site, error.to_string(), "cells with volume");
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

/// Whether materials and damping can be those of the body's section; what cannot is reported.
fn suits(draft: &Draft, body: &Placed, materials: &[Material]) -> bool {
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
    true
}

/// The elastic force of a body and what damps its strain.
fn add_solid(
    body: &Body,
    description: SolidDescription,
    forces: &mut Vec<Box<dyn Force>>,
) -> Result<(), FlatCell> {
    forces.push(Box::new(SolidForce::new(&description)?));
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

/// Gravity of the whole system, drag and damping of its bodies.
fn add_outer_forces(
    draft: &Draft,
    index: usize,
    mass: &Mass,
    kinematics: &Kinematics,
    forces: &mut Vec<Box<dyn Force>>,
) {
    let world = &draft.spec.world;
    if let Some(formulas) = &world.gravity {
        match constant_vector(formulas) {
            None => {
                let [x, y, z] = [0, 1, 2].map(|axis: usize| formulas[axis].evaluate(&[0.0]));
                if ![x, y, z].into_iter().all(f64::is_finite) {
                    let message = format!("gravity is ({x}, {y}, {z}) at t = 0");
                    draft.log.add(
                        Code::NotFinite,
                        &world.site,
                        message,
                        "formulas that are finite at the start",
                    );
                }
                forces.push(Box::new(Gravity::varying("gravity", formulas.clone(), mass, kinematics)));
            }
            Some(Vec3::ZERO) => {}
            Some(constant) => match Gravity::new("gravity", constant, mass, kinematics) {
                Ok(gravity) => forces.push(Box::new(gravity)),
                Err(error) => {
                    draft.log.add(Code::OutOfRange, &world.site, error.to_string(), "finite numbers")
                }
            },
        }
    }
    for body in draft.bodies.iter().filter(|body| body.system == index) {
        let (name, damping) = (&body.spec.name, body.spec.damping);
        let mut added: Vec<Result<Box<dyn Force>, LoadError>> = Vec::new();
        if damping.rayleigh_mass > 0.0 {
            let part = part_of_mass(mass, &body.rows);
            let force = MassDamping::new(format!("{name}.rayleigh_mass"), part, damping.rayleigh_mass);
            added.push(force.map(|force| Box::new(force) as _));
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
    let surface = body.mesh.boundary_surface();
    let areas = point_areas(&surface);
    let total: f64 = areas.iter().sum();
    let first = body.rows.start as u32;
    surface.mesh_points.iter().zip(&areas).map(|(point, area)| (first + point, area / total)).collect()
}

/// A third of the triangles around each point of a surface [m²].
pub fn point_areas(surface: &TriangleSurface) -> Vec<f64> {
    let mut areas = vec![0.0; surface.points.len()];
    for (triangle, corners) in surface.triangles.iter().enumerate() {
        let third = surface.area_vector(triangle as u32).length() / 3.0;
        corners.iter().for_each(|corner| areas[*corner as usize] += third);
    }
    areas
}

/// The materials of a body and the number of each cell's among them.
fn materials_of(draft: &Draft, body: &Placed) -> Option<(Vec<Material>, Vec<u16>)> {
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
    Some((materials, material_of_cell))
}

/// Rest positions and initial velocities. Pinned points stand where their pins want them, but for steppers that look for
/// equilibrium: those lead them there with all others, from rest.
pub fn initial_state(draft: &Draft, system: &System, index: usize) -> SystemState {
    let bodies = || draft.bodies.iter().filter(|body| body.system == index);
    let q: Vec<Vec3> = bodies().flat_map(|body| body.mesh.points.iter().copied()).collect();
    let mut state = system.initial_state(q);
    for body in bodies() {
        // v + ω × (x - c)
        let points = &body.mesh.points;
        let centre = match body.spec.network {
            Some(_) => points.iter().copied().sum::<Vec3>() / points.len() as f64,
            None => body.mesh.centroid(),
        };
        for (row, x) in body.rows.clone().zip(&body.mesh.points) {
            state.v[row] = body.spec.velocity + body.spec.angular_velocity.cross(*x - centre);
        }
        if let Some(network) = &body.spec.network {
            network::add_velocities(body, network, &mut state.v);
        }
    }
    let load = if system.stepper.has_inertia() { 1.0 } else { 0.0 };
    system.impose_constraints(&mut state.q, &mut state.v, 0.0, load);
    state
}
