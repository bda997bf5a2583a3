//! Loads and springs to ground become forces.

use std::collections::BTreeMap;
use std::sync::Arc;

use souple_engine::Force;
use souple_formal::Formula;
use souple_math::Vec3;
use souple_mesh::ElementKind;
use souple_models::loads::{
    ForceField, FormulaVector, GroundSpring, GroundSprings, LoadError, PointLoad, PressedFace, Pressure,
    UniformForce,
};

use super::Draft;
use super::bodies::Placed;
use crate::diagnostic::{Code, Site};
use crate::spec::boundary::{Distribution, Load, LoadKind, Spring};
use crate::spec::region::Region;

/// All loads and springs of all bodies.
pub fn add_loads(draft: &mut Draft) {
    let mut added: Vec<(usize, Box<dyn Force>)> = Vec::new();
    for body in &draft.bodies {
        for (index, load) in body.spec.loads.iter().enumerate() {
            let force = load_force(draft, body, format!("{}.loads[{index}]", body.spec.name), load);
            push(draft, body.system, force, &load.site, &mut added);
        }
        for (index, spring) in body.spec.springs.iter().enumerate() {
            let Some(region) = &spring.region else { continue };
            let rows = point_shares(draft, body, region, spring.distribution);
            let name = format!("{}.springs[{index}]", body.spec.name);
            let anchor = |row: u32| body.mesh.points[row as usize - body.rows.start];
            let force = ground_springs(name, spring, &rows, anchor);
            push(draft, body.system, force, &spring.site, &mut added);
        }
    }
    for (system, force) in added {
        draft.systems[system].forces.push(force);
    }
}

/// Whether formulas of place are finite at the start for all rows; where not, that is reported with the first such point.
fn starts_finite(
    draft: &Draft,
    body: &Placed,
    load: &Load,
    value: impl Fn(Vec3) -> Vec3,
    rows: impl IntoIterator<Item = u32>,
) -> bool {
    let faulty = rows.into_iter().find_map(|row| {
        let point = row as usize - body.rows.start;
        let force = value(body.mesh.points[point]);
        (!force.is_finite()).then_some((point, force))
    });
    let Some((point, force)) = faulty else { return true };
    let (x, number) = (body.mesh.points[point], body.point_numbers[point]);
    let message = format!(
        "the load on point {number}, at ({}, {}, {}), is ({}, {}, {}) at t = 0",
        x.x, x.y, x.z, force.x, force.y, force.z
    );
    draft.log.add(Code::NotFinite, &load.site, message, "formulas that are finite at the start");
    false
}

/// What a region or formula left out has been reported already.
type Built = Option<Result<Box<dyn Force>, LoadError>>;

fn push(draft: &Draft, system: usize, built: Built, site: &Site, added: &mut Vec<(usize, Box<dyn Force>)>) {
    match built {
        Some(Ok(force)) => added.push((system, force)),
        Some(Err(error)) => draft.log.add(Code::OutOfRange, site, error.to_string(), "finite numbers"),
        None => {}
    }
}

fn load_force(draft: &Draft, body: &Placed, name: String, load: &Load) -> Built {
    let region = load.region.as_ref()?;
    match load.kind.as_ref()? {
        LoadKind::Force(force, distribution) => {
            let shares = point_shares(draft, body, region, *distribution);
            point_load(draft, body, load, name, force, shares)
        }
        LoadKind::Traction(traction) => {
            point_load(draft, body, load, name, traction, area_shares(draft, body, region))
        }
        LoadKind::BodyForce(force) => {
            point_load(draft, body, load, name, force, volume_shares(draft, body, region))
        }
        LoadKind::Pressure(pressure) => {
            let faces = faces_of(draft, body, region);
            let pressed: Vec<PressedFace> =
                faces.iter().filter_map(|(kind, face)| PressedFace::new(*kind, face)).collect();
            if pressed.len() < faces.len() {
                let message =
                    "pressure follows faces of volumes and of membranes, and these are sides of a plane body";
                draft.log.add(Code::Conflict, &load.site, message, "`traction`, which keeps its direction");
                return None;
            }
            let rows = faces.into_iter().flat_map(|(_, face)| face);
            let value = |x: Vec3| Vec3::X * pressure.evaluate(&[x.x, x.y, x.z, 0.0]);
            if pressed.is_empty() || !starts_finite(draft, body, load, value, rows) {
                return None;
            }
            Some(Pressure::new(name, pressed, pressure.clone()).map(|force| Box::new(force) as _))
        }
    }
}

/// A load of each row's share times the field.
fn point_load(
    draft: &Draft,
    body: &Placed,
    load: &Load,
    name: String,
    formulas: &[Formula; 3],
    rows: Vec<(u32, f64)>,
) -> Built {
    let field = FormulaVector::from_components(formulas.clone());
    let points = rows.iter().map(|(row, _)| *row);
    if rows.is_empty() || !starts_finite(draft, body, load, |x| field.value(x, 0.0), points) {
        return None;
    }
    let field: Arc<dyn ForceField> = match constant_vector(formulas) {
        Some(force) => Arc::new(UniformForce(force)),
        None => Arc::new(field),
    };
    Some(PointLoad::new(name, rows, field).map(|force| Box::new(force) as _))
}

/// The value of formulas that depend on nothing.
pub fn constant_vector(formulas: &[Formula; 3]) -> Option<Vec3> {
    let values = |formula: &Formula| vec![0.0; formula.variables().len()];
    let depends =
        |formula: &Formula| (0..formula.variables().len()).any(|variable| formula.depends_on(variable));
    (!formulas.iter().any(depends)).then(|| {
        Vec3::from_array([0, 1, 2].map(|axis: usize| formulas[axis].evaluate(&values(&formulas[axis]))))
    })
}

/// Rows of the points of a region, each with its share.
fn point_shares(
    draft: &Draft,
    body: &Placed,
    region: &Region,
    distribution: Distribution,
) -> Vec<(u32, f64)> {
    let points = draft.selector(body).points(region);
    let share = distribution.share(points.len());
    points.into_iter().map(|point| (body.rows.start as u32 + point, share)).collect()
}

/// Rows of the faces of a region, corners in order.
fn faces_of(draft: &Draft, body: &Placed, region: &Region) -> Vec<(ElementKind, Vec<u32>)> {
    let first = body.rows.start as u32;
    let faces = draft.selector(body).faces(region);
    let rows = |face: Vec<u32>| face.into_iter().map(|point| first + point).collect();
    faces.into_iter().map(|(kind, face)| (kind, rows(face))).collect()
}

/// Rows of the faces of a region with `∫ N_a dA` over the rest shape [m²]; sides of a plane body are as wide as it is
/// thick.
fn area_shares(draft: &Draft, body: &Placed, region: &Region) -> Vec<(u32, f64)> {
    let mut areas: BTreeMap<u32, f64> = BTreeMap::new();
    let section = body.spec.section();
    let width = if section.is_plane() { section.measure() } else { 1.0 };
    for (kind, face) in draft.selector(body).faces(region) {
        let nodes: Vec<Vec3> = face.iter().map(|point| body.mesh.points[*point as usize]).collect();
        for (point, share) in face.iter().zip(souple_mesh::node_measures(kind, &nodes)) {
            *areas.entry(body.rows.start as u32 + point).or_default() += share * width;
        }
    }
    areas.into_iter().collect()
}

/// Rows of the cells of a region with `∫ N_a dV` over the rest shape [m³].
fn volume_shares(draft: &Draft, body: &Placed, region: &Region) -> Vec<(u32, f64)> {
    let mut volumes: BTreeMap<u32, f64> = BTreeMap::new();
    for cell in draft.selector(body).cells(region) {
        let Some(cell) = body.mesh.cell(cell) else { continue };
        let nodes: Vec<Vec3> = cell.nodes.iter().map(|point| body.mesh.points[*point as usize]).collect();
        for (point, share) in cell.nodes.iter().zip(souple_mesh::node_measures(cell.kind, &nodes)) {
            let volume = share * body.spec.section().measure();
            *volumes.entry(body.rows.start as u32 + point).or_default() += volume;
        }
    }
    volumes.into_iter().collect()
}

fn ground_springs(name: String, spring: &Spring, rows: &[(u32, f64)], anchor: impl Fn(u32) -> Vec3) -> Built {
    if rows.is_empty() {
        return None;
    }
    let springs = rows.iter().map(|&(row, share)| GroundSpring { row, share, anchor: anchor(row) }).collect();
    Some(
        GroundSprings::new(name, springs, spring.stiffness, spring.damping).map(|force| Box::new(force) as _),
    )
}
