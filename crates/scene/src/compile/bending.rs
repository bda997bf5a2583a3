//! What makes the membrane of a body a thin shell.

use std::collections::BTreeMap;

use souple_engine::{Constraint, Force};
use souple_math::{Mat3, Vec3};
use souple_models::solids::{
    Bending, BendingDescription, BendingError, BorderEdge, Clamp, Plate, Rigidities, Section,
    SolidDescription, border_edges, lies_across, plane_axes, rigidity_of_law,
};

use super::bodies::Placed;
use super::{Draft, modes, pins};
use crate::diagnostic::Code;
use crate::spec::bending::BendingSpec;
use crate::spec::region::Region;

/// Sines of angles count as nothing up to this: rounding of formulas.
const SAME: f64 = 1e-9;

/// The bending of all bodies that have some, and what damps it, after pins, which tell how clamps are led; what cannot be is reported.
pub fn add(draft: &mut Draft) {
    let made: Vec<(usize, Box<dyn Force>)> = (draft.bodies.iter())
        .flat_map(|body| forces(draft, body).into_iter().map(move |force| (body.system, force)))
        .collect();
    made.into_iter().for_each(|(system, force)| draft.systems[system].forces.push(force));
}

fn forces(draft: &Draft, body: &Placed) -> Vec<Box<dyn Force>> {
    let Some(bending) = force(draft, body) else { return Vec::new() };
    let damping = bending.damping(format!("{}_damping", name(body)));
    let damping = damping.into_iter().map(|damping| Box::new(damping) as Box<dyn Force>);
    std::iter::once(Box::new(bending) as Box<dyn Force>).chain(damping).collect()
}

fn force(draft: &Draft, body: &Placed) -> Option<Bending> {
    let spec = body.spec.bending.as_ref()?;
    let refuse = |message: String, expected: &str| {
        draft.log.add(Code::Conflict, &spec.site, message, expected);
        None
    };
    let name = &body.spec.name;
    let Section::Membrane { thickness } = body.spec.section() else {
        let message = format!("body `{name}` is no membrane, and its cells have no normals that bend");
        return refuse(message, "`section = { name = \"membrane\", thickness = … }`");
    };
    if body.is_carried() || body.spec.levels.is_some() || body.spec.octree.is_some() {
        let message = format!("what moves body `{name}` is not its points, and bending is told by those");
        return refuse(message, "a body without frames, modes, polynomial, levels and octree");
    }
    if let Some(cell) = cell_without_axes(body, spec) {
        let message = format!(
            "the axis {:?} is straight across cell {cell} of body `{name}`, and what resists bending there is not the \
             same along all axes",
            spec.axis.to_array()
        );
        return refuse(message, "an `axis` that is along the surface everywhere, or a body for each part");
    }
    let Some(plates) = plates(body, spec, thickness) else {
        let message = format!("a law of body `{name}` has no stiffness at rest to resist bending with");
        return refuse(message, "a law with some, or `along`, `across`, `coupling` and `twist`");
    };
    let clamps = match &spec.clamped {
        Some(region) => clamps(draft, body, spec, region)?,
        None => Vec::new(),
    };
    let solid = SolidDescription { name: self::name(body), ..modes::description(body, body.rows.start) };
    match Bending::new(&solid, &BendingDescription { plates: &plates, clamps: &clamps }) {
        Ok(force) => Some(force),
        Err(error) => {
            let expected = match error {
                BendingError::Kind { .. } => "`element = \"tri3\"`",
                BendingError::Flat { .. } => "cells with area",
                BendingError::Nowhere => "cells that share edges, or an edge that is clamped",
                BendingError::Inside { .. } => "edges of the border",
                BendingError::Branches { .. } | BendingError::Turned { .. } => "a surface with two sides",
            };
            refuse(format!("body `{name}`: {error}"), expected)
        }
    }
}

/// The edges of the border within a region, as pins lead them; `None` where some cannot keep their slope, which is reported. Of what is no
/// surface there are none.
fn clamps(draft: &Draft, body: &Placed, spec: &BendingSpec, region: &Region) -> Option<Vec<Clamp>> {
    let Ok(border) = border_edges(&body.mesh) else { return Some(Vec::new()) };
    let points = draft.selector(body).points(region);
    let is_clamped = |border: &BorderEdge| border.edge.iter().all(|point| points.contains(point));
    let clamped: Vec<BorderEdge> = border.into_iter().filter(is_clamped).collect();
    let refuse = |message: String, expected: &str| {
        draft.log.add(Code::Conflict, &spec.site, message, expected);
        None
    };
    if clamped.is_empty() {
        let message = format!(
            "`clamped` of body `{}` holds {} of its points, and no edge of its border with both ends",
            body.spec.name,
            points.len()
        );
        return refuse(message, "a region with both ends of an edge of the border, or no `clamped`");
    }
    let holds = holds(draft, body);
    let times = pins::times_of(draft, body);
    let mut clamps = Vec::with_capacity(clamped.len());
    for border in clamped {
        if let Some((why, expected)) = loose(body, &border, &holds, &times) {
            return refuse(why, expected);
        }
        let [first, _] = border.edge;
        let leader = holds.get(&first).and_then(|held| held.motion.clone());
        clamps.push(Clamp { edge: border.edge, leader });
    }
    Some(clamps)
}

/// What holds points of a body.
fn holds<'a>(draft: &'a Draft, body: &Placed) -> BTreeMap<u32, &'a Constraint> {
    let system = &draft.systems[body.system];
    let of_point = |constraint: &'a Constraint| {
        let row = system.kinematics.point_block_row(constraint.block)?;
        Some((body.point_of(row)?, constraint))
    };
    system.constraints.iter().filter_map(of_point).collect()
}

/// Why an edge of the border does not tell how a plane across it stands, in words, and what would.
fn loose(
    body: &Placed,
    border: &BorderEdge,
    holds: &BTreeMap<u32, &Constraint>,
    times: &[f64],
) -> Option<(String, &'static str)> {
    let BorderEdge { edge, across } = border;
    let numbers = edge.map(|point| body.point_numbers[point as usize]);
    let [a, b] = edge.map(|point| holds.get(&point).copied());
    let named = format!(
        "the edge of points {} and {} of body `{}` is clamped",
        numbers[0], numbers[1], body.spec.name
    );
    let is_held = |end: Option<&Constraint>| end.is_some_and(|end| (end.free * *across).length() <= SAME);
    let (Some(a), Some(b)) = (a.filter(|end| is_held(Some(end))), b.filter(|end| is_held(Some(end)))) else {
        let [x, y, z] = across.to_array();
        let message = format!(
            "{named}, and its ends may move across it, along ({x:.3}, {y:.3}, {z:.3}), where it would turn"
        );
        return Some((message, "pins that hold both ends at least along that, or no `clamped` there"));
    };
    let rest = b.start - a.start;
    let turn =
        |end: &Constraint, time: f64| end.motion.as_ref().map_or(Mat3::IDENTITY, |motion| motion.turn(time));
    let is_told = |time: &&f64| {
        let [turned, other] = [a, b].map(|end| turn(end, **time));
        let moved = |end: &Constraint| end.constrained() * (end.position(**time, 1.0) - end.start);
        let (now, expected) = (rest + moved(b) - moved(a), turned * rest);
        let is_along = now.cross(expected).length() <= SAME * now.length() * expected.length();
        is_along && now.dot(expected) > 0.0 && ((turned - other) * *across).length() <= SAME
    };
    let time = times.iter().find(|time| !is_told(time))?;
    let message = format!(
        "{named}, and at t = {time} s what leads its ends has turned it, or stretched it to nothing, and does not tell how the \
         surface turns with it"
    );
    let expected = "a pin that leads both ends along all axes by its `rotation`, or motions that leave the direction of the edge";
    Some((message, expected))
}

/// That of a body of a system that is made, if it has some.
pub fn of<'a>(draft: &'a Draft, body: &Placed) -> Option<&'a Bending> {
    let name = name(body);
    let force = draft.systems[body.system].forces.iter().find(|force| force.name() == name)?;
    force.as_any().downcast_ref()
}

fn name(body: &Placed) -> String {
    format!("{}.bending", body.spec.name)
}

/// The corners of each cell; of what is no triangle, which is reported, three of them.
fn corners(body: &Placed) -> impl Iterator<Item = [Vec3; 3]> {
    body.mesh.cells().map(move |cell| [0, 1, 2].map(|i| body.mesh.points[cell.nodes[i] as usize]))
}

/// The first cell that the axis is straight across, where what is told by axes is not the same along all of them.
fn cell_without_axes(body: &Placed, spec: &BendingSpec) -> Option<usize> {
    let [bending, across, twist] = spec.natural_curvature.to_array();
    let curls_alike = bending == across && twist == 0.0;
    if curls_alike && spec.rigidities.as_ref().is_none_or(Rigidities::are_isotropic) {
        return None;
    }
    corners(body).position(|corners| lies_across(corners, spec.axis))
}

/// Of each cell; of cells that are no triangles none is looked at.
fn plates(body: &Placed, spec: &BendingSpec, thickness: f64) -> Option<Vec<Plate>> {
    let [bending, across, twist] = spec.natural_curvature.to_array();
    let natural = Vec3::new(bending, across, 2.0 * twist);
    let of_rate = Rigidities::of_viscosity(body.spec.damping.viscosity, thickness).matrix();
    let plate = |(cell, nodes): (usize, [Vec3; 3])| {
        let rigidity = match (&spec.rigidities, plane_axes(nodes, spec.axis)) {
            (Some(rigidities), _) => rigidities.matrix(),
            (None, Some(axes)) => {
                let law = body.materials.of(cell).along(body.axes.get(cell));
                rigidity_of_law(&law, axes, thickness).filter(is_definite)?
            }
            // reported as a flat cell
            (None, None) => Mat3::IDENTITY,
        };
        let viscosity = of_rate + rigidity * spec.rayleigh_stiffness;
        Some(Plate { rigidity, first: spec.axis, natural, viscosity })
    };
    corners(body).enumerate().map(plate).collect()
}

/// Whether every curvature costs energy.
fn is_definite(rigidity: &Mat3) -> bool {
    let minor = rigidity.entry(0, 0) * rigidity.entry(1, 1) - rigidity.entry(0, 1).powi(2);
    rigidity.is_finite() && rigidity.entry(0, 0) > 0.0 && minor > 0.0 && rigidity.determinant() > 0.0
}
