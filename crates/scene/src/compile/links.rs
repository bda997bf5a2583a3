//! What joins bodies: attachments within a system, coupling springs between systems.

use souple_engine::coupling::{CouplingSpring, DRIVEN_LEN};
use souple_math::Vec3;
use souple_mesh::CellLocator;
use souple_models::frames::layer_stiffness;
use souple_models::loads::{Attachments, Combination, Link as LoadLink};
use souple_table::counted;

use super::bodies::Placed;
use super::frames::cross_sections;
use super::freedom::Joint;
use super::{Draft, tissue};
use crate::diagnostic::Code;
use crate::spec::interaction::Link;

/// Distance, relative to the body's size, under which a link counts as of no length: rounding of coordinates.
const TOUCHING: f64 = 1e-12;

/// What a link joins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Between {
    BodiesOfOneSystem,
    Systems,
}

/// The two bodies of a link; `None` where they do not fit, which is reported.
fn ends<'d, 'a>(draft: &'d Draft<'a>, link: &Link, between: Between) -> Option<[&'d Placed<'a>; 2]> {
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

/// Springs from points of one body to the places of another that they touch or are nearest to: those that are written,
/// and those of tissue.
pub fn attach(draft: &mut Draft) {
    let (mut added, mut joints) = (Vec::new(), Vec::new());
    let written = draft.spec.attachments.iter().cloned().enumerate();
    let named = written.map(|(index, link)| (format!("attachments[{index}]"), link));
    for (name, link) in named.chain(tissue::attachments(draft)) {
        let Some([from, to]) = ends(draft, &link, Between::BodiesOfOneSystem) else { continue };
        let Some(region) = &link.region else { continue };
        let locator = CellLocator::new(&to.mesh);
        let (links, held): (Vec<LoadLink>, Vec<Joint>) = draft
            .selector(from)
            .points(region)
            .into_iter()
            .filter_map(|point| attachment(&locator, &link, point, from, to))
            .unzip();
        joints.extend(held);
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
        let area = area_of(from, &links);
        let stiffness = link.stiffness.unwrap_or_else(|| layer_between(from, to) * area);
        let strength = link.strength * area;
        match Attachments::new(name, links, stiffness, link.damping)
            .and_then(|springs| springs.with_strength(strength))
        {
            Ok(force) => added.push((from.system, force)),
            Err(error) => draft.log.add(Code::OutOfRange, &link.site, error.to_string(), "finite numbers"),
        }
    }
    draft.joints.extend(joints);
    for (system, force) in added {
        draft.systems[system].forces.push(Box::new(force));
    }
}

/// Stiffness per area between two bodies: that of a thin layer whose modulus is the harmonic mean of theirs [N/m³].
fn layer_between(from: &Placed, to: &Placed) -> f64 {
    let modulus = |body: &Placed| {
        let material = body.spec.material.as_ref();
        let built = material.and_then(|chosen| (chosen.entry.build)(&chosen.values).ok());
        built.map_or(0.0, |material| material.small_strain.youngs_modulus())
    };
    let [a, b] = [from, to].map(modulus);
    let smallest =
        |body: &Placed| body.mesh.bounds().size().to_array().into_iter().fold(f64::INFINITY, f64::min);
    let size = f64::min(smallest(from), smallest(to));
    layer_stiffness(2.0 * a * b / (a + b), size)
}

/// Mean cross-section of the points that springs begin at [m²].
fn area_of(from: &Placed, links: &[LoadLink]) -> f64 {
    let areas = cross_sections(&from.mesh);
    let rows = links.iter().flat_map(|link| link.a.rows());
    let area: f64 = rows.map(|(row, _)| areas[*row as usize - from.rows.start]).sum();
    area / links.len() as f64
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
    let location = locator.carrier(position).filter(|location| location.distance <= link.reach)?;
    let cell = to.mesh.cell(location.cell)?;
    let first = to.rows.start as u32;
    let weights = location.weights();
    let rows: Vec<(u32, f64)> =
        cell.nodes.iter().zip(weights.iter()).map(|(node, weight)| (first + node, *weight)).collect();
    let carried =
        cell.nodes.iter().zip(weights.iter()).map(|(node, weight)| to.mesh.points[*node as usize] * *weight);
    let apart: Vec3 = position - carried.sum();
    let distance = apart.length();
    let is_touching = distance <= TOUCHING * to.mesh.bounds().diagonal();
    let rest_length = if is_touching { 0.0 } else { distance };
    let row = from.rows.start as u32 + point;
    let ends = [(row, 1.0)].into_iter().chain(rows.iter().map(|(row, weight)| (*row, -weight))).collect();
    // a spring at its rest length resists along itself only, one without length in all directions
    let direction = if is_touching { None } else { apart.try_normalised() };
    let joint = Joint { system: from.system, ends, direction };
    let a = Combination::row(row);
    // weights of a cell's shape functions are finite and not empty
    Some((LoadLink { a, b: Combination::new(rows).ok()?, rest_length }, joint))
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
