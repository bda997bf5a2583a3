//! What joins bodies: attachments within a system, coupling springs between systems.

use souple_engine::coupling::{CouplingSpring, DRIVEN_LEN};
use souple_math::Vec3;
use souple_mesh::CellLocator;
use souple_models::frames::layer_stiffness;
use souple_models::loads::{Attachments, Combination, Link as LoadLink};
use souple_models::materials::Material;
use souple_table::counted;

use super::bodies::Placed;
use super::frames::cross_sections;
use super::freedom::Joint;
use super::{Draft, hanging, tissue};
use crate::diagnostic::Code;
use crate::spec::interaction::Link;

/// Part of a body's size under which distances are none.
pub(super) const TOUCHING: f64 = 1e-9;
/// Roundings of a place that is computed from a cell's nodes.
const ROUNDINGS: f64 = 16.0;

/// Distance under which a place touches a body: nothing next to its size, or what rounding leaves of coordinates far from the origin.
pub(super) fn touching(body: &Placed, place: Vec3) -> f64 {
    TOUCHING * body.mesh.bounds().diagonal() + ROUNDINGS * f64::EPSILON * place.length()
}

/// What a link joins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Between {
    BodiesOfOneSystem,
    Systems,
}

/// The two bodies of a link; `None` where they do not fit, which is reported.
pub(super) fn ends<'d, 'a>(
    draft: &'d Draft<'a>,
    link: &Link,
    between: Between,
) -> Option<[&'d Placed<'a>; 2]> {
    let find = |name: &str| draft.bodies.iter().find(|body| body.spec.name == name);
    let (from, to) = (find(&link.from)?, find(&link.to)?);
    let name = |body: &Placed| draft.spec.systems[body.system].name.clone();
    if link.from == link.to {
        let message = format!("body `{}` is joined to itself", link.from);
        draft.log.add(Code::Conflict, &link.to_site, message, "another body");
        return None;
    }
    if between == Between::BodiesOfOneSystem && from.system != to.system {
        let (a, b) = (name(from), name(to));
        let message = format!(
            "`{}` steps in system `{a}` and `{}` in `{b}`: attached bodies step together",
            link.from, link.to
        );
        draft.log.add(
            Code::Conflict,
            &link.site,
            message,
            "bodies of one system, or [[couplings]] between systems",
        );
        return None;
    }
    if between == Between::Systems && from.system == to.system {
        let message = format!("`{}` and `{}` are both in system `{}`", link.from, link.to, name(from));
        draft.log.add(
            Code::Conflict,
            &link.site,
            message,
            "bodies of two systems, or [[attachments]] within one",
        );
        return None;
    }
    Some([from, to])
}

/// All attachments with their names: those that are written, and those of tissue.
pub(super) fn all(draft: &Draft) -> Vec<(String, Link)> {
    let written = draft.spec.attachments.iter().cloned().enumerate();
    let named = written.map(|(index, link)| (format!("attachments[{index}]"), link));
    named.chain(tissue::attachments(draft)).collect()
}

/// Springs from points of one body to the places of another that they touch or are nearest to: those that are written,
/// and those of tissue.
pub fn attach(draft: &mut Draft) {
    let (mut added, mut joints) = (Vec::new(), hanging::joints(draft));
    for (name, link) in all(draft) {
        let Some([from, to]) = ends(draft, &link, Between::BodiesOfOneSystem) else { continue };
        let Some(region) = &link.region else { continue };
        let locator = CellLocator::new(&to.mesh);
        let points = draft.selector(from).points(region);
        if points.is_empty() {
            // said where the region was looked for
            continue;
        }
        // what hangs needs no spring
        let hangs = |point: &u32| from.hanging.is_some() && from.own_row(*point).is_none();
        let (hanging, free): (Vec<u32>, Vec<u32>) = points.into_iter().partition(hangs);
        let (links, held): (Vec<LoadLink>, Vec<Joint>) =
            free.into_iter().filter_map(|point| attachment(&locator, &link, point, from, to)).unzip();
        joints.extend(held);
        if links.is_empty() && !hanging.is_empty() {
            continue;
        }
        if links.is_empty() {
            let message = format!("no point of `{}` is within reach of `{}`", link.from, link.to);
            draft.log.add(
                Code::EmptyRegion,
                &link.site,
                message,
                "a region near the other body, or a longer reach",
            );
            continue;
        }
        let Some((links, stiffness)) = with_matter(draft, &link, [from, to], links) else { continue };
        match Attachments::new(name, links, stiffness, link.damping) {
            Ok(force) => added.push((from.system, force)),
            Err(error) => draft.log.add(Code::OutOfRange, &link.site, error.to_string(), "finite numbers"),
        }
    }
    draft.joints.extend(joints);
    for (system, force) in added {
        draft.systems[system].forces.push(Box::new(force));
    }
}

/// Gives springs their strength, and where the attachment names no stiffness that of the matter about them: of a thin layer over
/// the area of the point, whose modulus is the harmonic mean of those on its two sides. Returns the mean stiffness too [N/m].
fn with_matter(
    draft: &Draft,
    link: &Link,
    [from, to]: [&Placed; 2],
    mut springs: Vec<LoadLink>,
) -> Option<(Vec<LoadLink>, f64)> {
    if from.spec.network.is_some() && (link.stiffness.is_none() || link.strength.is_finite()) {
        let message = format!(
            "the masses of `{}` have no area, from which a stiffness or the force of a strength would follow",
            link.from
        );
        draft.log.add(
            Code::MissingKey,
            &link.site,
            message,
            "a `stiffness`, no `strength`, or the other body as `from`",
        );
        return None;
    }
    let held: Vec<u32> = springs
        .iter()
        .flat_map(|spring| spring.a.rows())
        .map(|(row, _)| *row - from.rows.start as u32)
        .collect();
    let areas = areas_held(draft, from, &held);
    let area = |spring: &LoadLink| {
        let rows = spring.a.rows().iter();
        rows.map(|(row, weight)| areas[*row as usize - from.rows.start] * weight).sum::<f64>()
    };
    for spring in &mut springs {
        spring.strength = link.strength * area(spring);
    }
    if let Some(stiffness) = link.stiffness {
        return Some((springs, stiffness));
    }
    // masses of a network have no matter about them: the layer is of the other side alone
    let sides: Vec<(&Placed, Vec<f64>)> = [from, to]
        .into_iter()
        .filter(|body| body.spec.network.is_none())
        .map(|body| (body, moduli(body)))
        .collect();
    let held_area: f64 = springs.iter().map(area).sum();
    let depth = sides.iter().map(|(body, _)| depth(body, held_area)).fold(f64::INFINITY, f64::min);
    if sides.is_empty() {
        let message = format!(
            "neither `{}` nor `{}` has matter from which a stiffness would follow",
            link.from, link.to
        );
        draft.log.add(Code::MissingKey, &link.site, message, "a `stiffness` of the springs");
        return None;
    }
    let mut stiffnesses = Vec::with_capacity(springs.len());
    for spring in &springs {
        let mut softness = 0.0;
        for (body, moduli) in &sides {
            let end = if std::ptr::eq(*body, from) { &spring.a } else { &spring.b };
            let of = |(row, weight): &(u32, f64)| moduli[*row as usize - body.rows.start] * weight;
            let modulus: f64 = end.rows().iter().map(of).sum();
            // not above zero, or no number: a law that resists nothing at rest
            if modulus.is_nan() || modulus <= 0.0 {
                let message = format!(
                    "the matter of body `{}` has a modulus of {modulus} Pa where it is attached, from which no stiffness follows",
                    body.spec.name
                );
                draft.log.add(Code::OutOfRange, &link.site, message, "a `stiffness` of the springs");
                return None;
            }
            softness += 1.0 / modulus;
        }
        stiffnesses.push(layer_stiffness(sides.len() as f64 / softness, depth) * area(spring));
    }
    let mean = stiffnesses.iter().sum::<f64>() / stiffnesses.len() as f64;
    for (spring, stiffness) in springs.iter_mut().zip(&stiffnesses) {
        spring.share = stiffness / mean;
    }
    Some((springs, mean))
}

/// How deep a body is behind an area that is held [m]: its volume over that, and no more than it is long.
pub(super) fn depth(body: &Placed, held_area: f64) -> f64 {
    let longest = body.mesh.bounds().size().to_array().into_iter().fold(0.0, f64::max);
    (body.mesh.volume() / held_area).min(longest)
}

/// The stiffest modulus at rest about each point of a body: the mean over its cells [Pa]; zero where matter has none.
pub(super) fn moduli(body: &Placed) -> Vec<f64> {
    let mut sums = vec![(0.0, 0_u32); body.mesh.points.len()];
    if body.materials.all.is_empty() {
        return vec![0.0; sums.len()];
    }
    let of_materials: Vec<f64> = body.materials.all.iter().map(Material::stiffest_modulus).collect();
    for (material, cell) in body.materials.of_cell.iter().zip(body.mesh.cells()) {
        let modulus = of_materials[usize::from(*material)];
        for node in cell.nodes {
            let (sum, count) = &mut sums[*node as usize];
            *sum += modulus;
            *count += 1;
        }
    }
    sums.into_iter().map(|(sum, count)| sum / f64::from(count.max(1))).collect()
}

/// The area that each point of a body stands for where some of them are held [m²]: its part of the faces whose points are all held;
/// of points without such, of all faces about them; within the body, a side of its part of the volume.
pub(super) fn areas_held(draft: &Draft, body: &Placed, held: &[u32]) -> Vec<f64> {
    let inside = cross_sections(&body.mesh);
    if body.spec.network.is_some() {
        return inside;
    }
    let mut is_held = vec![false; body.mesh.points.len()];
    held.iter().for_each(|point| is_held[*point as usize] = true);
    let (mut within, mut about) = (vec![0.0; is_held.len()], vec![0.0; is_held.len()]);
    for (kind, face) in draft.selector(body).all_faces() {
        let nodes: Vec<Vec3> = face.iter().map(|point| body.mesh.points[*point as usize]).collect();
        let shares = souple_mesh::node_measures(kind, &nodes);
        // corners of curved faces have less than nothing: what holds them has its part
        let (area, total): (f64, f64) = (shares.iter().sum(), shares.iter().map(|share| share.abs()).sum());
        let is_within = face.iter().all(|point| is_held[*point as usize]);
        for (point, share) in face.iter().zip(shares) {
            let part = area * share.abs() / total;
            about[*point as usize] += part;
            within[*point as usize] += if is_within { part } else { 0.0 };
        }
    }
    let first = |areas: [f64; 3]| areas.into_iter().find(|area| *area > 0.0).unwrap_or(0.0);
    within
        .into_iter()
        .zip(about)
        .zip(inside)
        .map(|((within, about), inside)| first([within, about, inside]))
        .collect()
}

/// The spring of a point, and what it hinders; `None` beyond reach.
fn attachment(
    locator: &CellLocator,
    link: &Link,
    point: u32,
    from: &Placed,
    to: &Placed,
) -> Option<(LoadLink, Joint)> {
    let position = from.mesh.points[point as usize];
    let first = to.rows.start as u32;
    let (rows, distance_to): (Vec<(u32, f64)>, f64) = if to.spec.network.is_some() {
        // masses are where they are, and nothing is between them
        let distance = |mass: &u32| (to.mesh.points[*mass as usize] - position).length();
        let nearest = (0..to.mesh.points.len() as u32).min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
        (vec![(first + nearest, 1.0)], distance(&nearest))
    } else {
        let location = locator.carrier(position)?;
        let cell = to.mesh.cell(location.cell)?;
        let weights = location.weights();
        (
            cell.nodes.iter().zip(weights.iter()).map(|(node, weight)| (first + node, *weight)).collect(),
            location.distance,
        )
    };
    if distance_to > link.reach {
        return None;
    }
    let carried = rows.iter().map(|(row, weight)| to.mesh.points[(row - first) as usize] * *weight);
    let apart: Vec3 = position - carried.sum();
    let distance = apart.length();
    let is_touching = distance <= touching(to, position);
    let rest_length = if is_touching { 0.0 } else { distance };
    let row = from.rows.start as u32 + point;
    let ends = [(row, 1.0)].into_iter().chain(rows.iter().map(|(row, weight)| (*row, -weight))).collect();
    // a spring at its rest length resists along itself only, one without length in all directions
    let direction = if is_touching { None } else { apart.try_normalised() };
    let joint = Joint { system: from.system, ends, direction };
    let a = Combination::row(row);
    // weights of a cell's shape functions are finite and not empty
    Some((LoadLink::new(a, Combination::new(rows).ok()?, rest_length), joint))
}

/// What to expect of couplings: one line for the springs of each, which are alike.
fn forecasts(springs: &[CouplingSpring], period: f64) -> Vec<String> {
    let of_coupling = springs.chunk_by(|a, b| coupling_of(a) == coupling_of(b));
    of_coupling
        .filter_map(|springs| {
            let forecast = springs.first()?.forecast(period)?;
            let others = springs.len() - 1;
            let more = || format!("{forecast} (and {} more of it)", counted(others as u64, "spring"));
            Some(if others > 0 { more() } else { forecast.clone() })
        })
        .collect()
}

/// The name of a spring without that of its point.
fn coupling_of(spring: &CouplingSpring) -> &str {
    spring.name.rsplit_once('.').map_or(&spring.name, |(coupling, _)| coupling)
}

/// Coupling springs from points of one body to the nearest points of a body in another system.
pub fn couple(draft: &mut Draft) {
    let (mut springs, mut joints) = (Vec::new(), Vec::new());
    for (index, link) in draft.spec.couplings.iter().enumerate() {
        let Some([from, to]) = ends(draft, link, Between::Systems) else { continue };
        let Some(region) = &link.region else { continue };
        for point in draft.selector(from).points(region) {
            let position = from.mesh.points[point as usize];
            let distance = |other: &u32| (to.mesh.points[*other as usize] - position).length_sq();
            let nearest = (0..to.mesh.points.len() as u32).min_by(|a, b| distance(a).total_cmp(&distance(b)));
            let Some(nearest) = nearest else { continue };
            let ends =
                [(from.system, from.rows.start as u32 + point), (to.system, to.rows.start as u32 + nearest)];
            // the other system is the ground to each: it is somewhere at every step
            joints.extend(ends.map(|(system, row)| Joint {
                system,
                ends: vec![(row, 1.0)],
                direction: None,
            }));
            let steps = |end: (usize, u32)| draft.spec.systems[end.0].steps_per_period;
            let [fast, slow] = if steps(ends[0]) >= steps(ends[1]) { ends } else { [ends[1], ends[0]] };
            springs.push(CouplingSpring {
                name: format!("couplings[{index}].{point}"),
                fast_system: fast.0,
                fast_row: fast.1,
                slow_system: slow.0,
                slow_row: slow.1,
                // couplings must say theirs
                stiffness: link.stiffness.unwrap_or(f64::NAN),
                damping: link.damping,
                // behind what controls keep
                driven: draft.state.driven.len() + springs.len() * DRIVEN_LEN,
            });
        }
    }
    draft.joints.extend(joints);
    let period = draft.spec.world.period;
    draft.warnings.extend(forecasts(&springs, period));
    let driven = draft.state.driven.len() + springs.len() * DRIVEN_LEN;
    draft.state.driven.resize(driven, 0.0);
    for spring in springs {
        draft.systems[spring.fast_system].forces.push(spring.fast_end());
        draft.systems[spring.slow_system].forces.push(spring.slow_end());
        draft.model.couplings.push(spring);
    }
}
