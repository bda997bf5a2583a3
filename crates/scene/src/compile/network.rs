//! Networks become points with masses, and links of one law one force each.

mod coincident;
mod columns;
mod constraints;
mod contradicting;
mod controls;
mod ends;
mod faces;
mod fill;
mod plan;
mod rigid;
mod steps;
mod summary;
mod table;
mod views;

pub use contradicting::warn_of_starts;
pub use controls::add as add_controls;
pub use ends::size;
pub use fill::fill_all;
pub use plan::number_of;
pub use steps::warn_of_steps;
pub use summary::{FillInfo, LawInfo, NetworkInfo, networks};
pub use table::{NumberOfMass, StateSpace};

use std::ops::Range;

use souple_engine::{Force, Mass};
use souple_formal::Formula;
use souple_math::Vec3;
use souple_mesh::{CellBlock, ElementKind, Group, Mesh};
use souple_models::network::{
    Account, AsksFor, BuildLink, Crowd, CrowdDescription, Friction, Fusible, LinkDescription, LinkKernel,
    Links, Listing, Making, PAIR_MEMORY, Slide, Span,
};
use souple_table::{MODERATE, Value, readable};

use super::bodies::Placed;
use super::shape::Shape;
use super::{Draft, memory, start};
use crate::diagnostic::Code;
use crate::measure::ContourInfo;
use crate::reader::Chosen;
use crate::scene::FacesInfo;
use crate::spec::Spec;
use crate::spec::body::Body;
use crate::spec::control::Driven;
use crate::spec::network::{
    ConstraintKind, ConstraintSpec, CrowdSpec, FacesForm, FrictionSpec, FusibleSpec, LinkTable, MassGroup,
    Network,
};
use crate::spec::world::SystemSpec;

/// Which masses links of one law join, and how long they are at rest.
pub struct PlacedLinks {
    /// The table that says their law; those of other parts that say the same are in it.
    pub table: usize,
    /// Numbers of the network's masses.
    pub ends: Vec<[u32; 2]>,
    /// [m]
    pub rest_lengths: Vec<f64>,
    /// At the start [m].
    pub lengths: Vec<f64>,
}

/// Masses as points, links as edges, groups of masses as groups; `None` where something was refused.
pub fn build(body: &Body, network: &Network, draft: &Draft) -> Option<(Shape, Vec<PlacedLinks>)> {
    let places = network.masses.iter().flat_map(|group| (0..group.places.count()).map(|i| group.place(i)));
    let points: Vec<Vec3> = places.map(|place| body.placement.place(place)).collect();
    let is_beyond = |vector: &Vec3| !vector.to_array().iter().all(|number| number.abs() <= MODERATE);
    if let Some(point) = points.iter().position(is_beyond) {
        let place = points[point].to_array().map(readable).join(", ");
        let message = format!("mass {point} starts at ({place}) m, where nothing can be computed");
        draft.log.add(Code::NotFinite, &body.site, message, format!("numbers up to {}", readable(MODERATE)));
        return None;
    }
    if let Some(mass) = network.of_each(|group| group.velocity).position(|velocity| is_beyond(&velocity)) {
        let message = format!("mass {mass} starts faster than can be computed with");
        let expected = format!("a velocity of {} m/s at most", readable(MODERATE));
        draft.log.add(Code::NotFinite, &body.site, message, expected);
        return None;
    }
    if points.is_empty() {
        draft.log.add(Code::EmptyRegion, &body.site, "the network has no masses", "at least one");
        return None;
    }
    let mut starts = start::places(body.start.as_ref(), &points);
    // links see points of view behind the masses
    let (masses, seen) = (points.len(), views::points(network, 0, draft));
    let mut places = points.clone();
    places.extend(views::places(&seen, &points));
    starts.extend(views::places(&seen, &starts));
    let mut room = memory::links_that_fit();
    let links: Vec<PlacedLinks> = network
        .links
        .iter()
        .enumerate()
        .filter_map(|(index, table)| {
            let ends = ends::of_table(table, network, &places, room, draft.log)?;
            room -= ends.len();
            let lengths_at = |points: &[Vec3]| -> Vec<f64> {
                let apart = |[a, b]: [u32; 2]| points[a as usize] - points[b as usize];
                ends.iter().map(|ends| table.span.length(apart(*ends))).collect()
            };
            let (lengths, mut rest_lengths) = (lengths_at(&starts), lengths_at(&places));
            if let Some(length) = table.rest_length {
                // along an axis lengths have a sign
                rest_lengths.iter_mut().for_each(|rest| *rest = length.copysign(*rest));
            }
            Some(PlacedLinks { table: index, rest_lengths, lengths, ends })
        })
        .collect();
    if links.len() < network.links.len() {
        return None;
    }
    let mut warnings = coincident::links(body, network, &links, &places, draft);
    warnings.extend(coincident::crowds(body, network, &starts[..masses], draft));
    let links = together(network, links);
    let is_between_masses = |ends: &&[u32; 2]| ends.iter().all(|end| (*end as usize) < masses);
    let nodes = links.iter().flat_map(|links| links.ends.iter().filter(is_between_masses).flatten().copied());
    let rods = constraints::rods(network, &points, draft)?;
    let nodes = nodes.chain(rods.into_iter().flatten()).collect();
    let mut mesh = Mesh::new(points, ElementKind::Edge2, nodes);
    mesh.blocks.retain(|block: &CellBlock| !block.is_empty());
    let presented = network.presented.iter().map(|(name, _)| name);
    for name in network.masses.iter().map(|group| &group.name).chain(presented) {
        let numbers = network.numbers_of(name).filter(|numbers| numbers.end as usize <= masses);
        let Some(numbers) = numbers else { continue };
        let points = numbers.collect();
        mesh.groups.insert(name.clone(), Group { points, ..Group::default() });
    }
    let numbered = mesh.points.len() as u32;
    let point_numbers = (0..numbered).collect();
    Some((Shape { mesh, point_numbers, numbered, warnings }, links))
}

/// Puts links of one law that are of parts together: a module placed a thousand times is one force.
fn together(network: &Network, links: Vec<PlacedLinks>) -> Vec<PlacedLinks> {
    let is_same = |a: &LinkTable, b: &LinkTable| {
        let law = a.law.as_ref().zip(b.law.as_ref());
        let is_same_law = law.is_some_and(|(a, b)| a.entry.name == b.entry.name && a.values == b.values);
        // what a control may drive stays by itself
        let are_driven = !a.name.is_empty() || !b.name.is_empty();
        a.is_of_part && b.is_of_part && !are_driven && a.span == b.span && is_same_law
    };
    let mut all: Vec<PlacedLinks> = Vec::new();
    for more in links {
        let table = &network.links[more.table];
        match all.iter_mut().find(|known| is_same(&network.links[known.table], table)) {
            Some(known) => {
                known.ends.extend(more.ends);
                known.rest_lengths.extend(more.rest_lengths);
                known.lengths.extend(more.lengths);
            }
            None => all.push(more),
        }
    }
    all
}

/// Puts the masses of a network where they belong among the rows.
pub fn add_masses(body: &Placed, network: &Network, mass: &mut Mass) {
    for (row, own) in body.rows.clone().zip(network.of_each(|group| group.mass)) {
        mass.diagonal[row] = own;
    }
}

/// Adds the velocities that groups of masses have of their own.
pub fn add_velocities(body: &Placed, network: &Network, velocities: &mut [Vec3]) {
    for (row, own) in body.rows.clone().zip(network.of_each(|group| group.velocity)) {
        velocities[row] += own;
    }
}

/// Rows that a medium brakes, with their drag [N s/m].
pub fn drags(body: &Placed, network: &Network) -> Vec<(u32, f64)> {
    let own = network.of_each(|group| group.drag);
    let mut drags: Vec<_> = (body.rows.start as u32..).zip(own).filter(|(_, drag)| *drag > 0.0).collect();
    drags.shrink_to_fit();
    drags
}

/// A force for each table of links and for each crowd.
pub fn add_forces(
    draft: &Draft,
    body: &Placed,
    network: &Network,
    system: &SystemSpec,
    forces: &mut Vec<Box<dyn Force>>,
) {
    let timestep = draft.timestep(system);
    let first = body.rows.start as u32;
    for (index, links) in body.links.iter().enumerate() {
        let table = &network.links[links.table];
        let driven = Driven::Links(table.name.as_str());
        let parameters = controls::driven_parameters(network, &driven);
        let Some(law) = self::law(table.law.as_ref(), (timestep, table.span), &parameters, draft) else {
            continue;
        };
        let masses = body.mesh.points.len() as u32;
        let is_viewed = links.ends.iter().flatten().any(|end| *end >= masses);
        let seen = is_viewed
            .then(|| views::Ends::new(&links.ends, masses, first, &views::points(network, first, draft)));
        let ends = match &seen {
            Some(seen) => seen.ends.clone(),
            None => links.ends.iter().map(|ends| ends.map(|end| first + end)).collect(),
        };
        let law =
            controls::driven(draft, body, network, driven, (law, table.law.as_ref()), (timestep, table.span));
        let links = Links::new(LinkDescription {
            name: format!("{}.links[{index}]", body.spec.name),
            law,
            ends: &ends,
            span: table.span,
            rest_lengths: &links.rest_lengths,
            lengths: &links.lengths,
            timestep,
            account: if network.keeps_account { Account::Heat } else { Account::None },
        });
        let (asks, is_on_axis) = (links.asks_for(), table.span != Span::Distance);
        if (is_on_axis && asks.place_in_space) || (!is_on_axis && asks.place_on_axis) {
            let (message, expected) = match is_on_axis {
                true => {
                    ("a condition asks for a place in space, and these links are along an axis", "`X1`, `X2`")
                }
                false => (
                    "a condition asks for a place on an axis, and these links have none",
                    "`X1.x` to `X2.z`, or `along`",
                ),
            };
            draft.log.add(Code::Conflict, &table.site, message, expected);
        }
        match seen {
            Some(seen) => forces.push(Box::new(seen.seen_by(links))),
            None => forces.push(Box::new(links)),
        }
    }
    let stepper = system.stepper.as_ref().map(|chosen| (chosen.entry.build)(&chosen.values));
    let listing =
        if stepper.is_none_or(|stepper| stepper.reads_cliques()) { Listing::State } else { Listing::Own };
    for (index, crowd) in network.crowds.iter().enumerate() {
        let name = crowd.force_name(&body.spec.name, index);
        if let Some(crowd) = self::crowd(name, crowd, body, network, (timestep, listing), draft) {
            forces.push(Box::new(crowd));
        }
    }
    controls::add_actuators(draft, body, network, forces);
    let constraints: Vec<_> = (0..network.constraints.len())
        .filter_map(|index| constraints::of(draft, (body, network), timestep, index))
        .collect();
    constraints::check_size(network, body, &constraints, draft.log);
    forces.extend(constraints.into_iter().map(constraints::Made::into_force));
}

fn law(
    chosen: Option<&Chosen<BuildLink>>,
    (timestep, span): (f64, Span),
    driven: &[String],
    draft: &Draft,
) -> Option<Box<dyn LinkKernel>> {
    let chosen = chosen?;
    for parameter in chosen.entry.parameters {
        if let Some(Value::Number(number)) = chosen.values.get(parameter.name)
            && number.abs() > MODERATE
        {
            let message = format!("`{}` is {}: too large to compute with", parameter.name, readable(number));
            let expected = format!("{}, {} at most", parameter.expected(), readable(MODERATE));
            draft.log.add(Code::OutOfRange, chosen.site_of(parameter.name), message, expected);
            return None;
        }
    }
    match (chosen.entry.build)(&Making { values: &chosen.values, timestep, span, driven }) {
        Ok(law) => Some(law),
        Err(error) => {
            let expected = format!("a law that holds, see `souple describe {}`", chosen.entry.name);
            let (keys, part) = error.place();
            let site = chosen.site_of_part(keys, part);
            draft.log.add(Code::OutOfRange, &site, error.to_string(), expected);
            None
        }
    }
}

fn crowd(
    name: String,
    spec: &CrowdSpec,
    body: &Placed,
    network: &Network,
    (timestep, listing): (f64, Listing),
    draft: &Draft,
) -> Option<Crowd> {
    let parameters = controls::driven_parameters(network, &Driven::Crowds(spec.name.as_str()));
    let law = self::law(spec.law.as_ref(), (timestep, Span::Distance), &parameters, draft)?;
    if law.asks_for() != AsksFor::default() {
        let message =
            "a condition asks where the ends are, and pairs of a crowd know how far apart they are alone";
        draft.log.add(Code::Conflict, &spec.site, message, "conditions on `D`, `V` and the like, or `links`");
        return None;
    }
    // a bond is one number more
    let most = PAIR_MEMORY - usize::from(spec.fusible.is_some());
    if law.memory_len() > most {
        let message = format!("the law remembers {} numbers of a pair", law.memory_len());
        let expected = format!("at most {most}, or `links`, which are always there");
        draft.log.add(Code::Conflict, &spec.site, message, expected);
        return None;
    }
    let range = spec.range.unwrap_or_else(|| law.range());
    if !range.is_finite() {
        let message = "this law acts at any distance, and no `range` is given";
        draft.log.add(
            Code::MissingKey,
            &spec.site,
            message,
            "range = …, or a law with an end, such as ball or cohesion",
        );
        return None;
    }
    let (first, second) = ends::groups(&spec.of, network)?;
    let masses = body.mesh.points.len() as u32;
    if first.end > masses || second.end > masses {
        let message = "crowds are of masses: points of view do not come near each other";
        draft.log.add(Code::Conflict, &spec.site, message, "groups, parts or ports");
        return None;
    }
    if !ends::may_crowd(first.clone(), second.clone(), range, &body.mesh.points) {
        let message = format!("more pairs are within {range} m of each other at the start than memory holds");
        draft.log.add(Code::TooLarge, &spec.site, message, "a shorter range, or fewer masses");
        return None;
    }
    let fusible = match &spec.fusible {
        Some(fusible) => {
            let of_second = if first == second { 0..0 } else { second.clone() };
            let masses = first.clone().chain(of_second).map(|mass| body.mesh.points[mass as usize]);
            Some(fusible_of(fusible, (range, timestep), masses, spec, draft)?)
        }
        None => None,
    };
    let driven = Driven::Crowds(spec.name.as_str());
    let law =
        controls::driven(draft, body, network, driven, (law, spec.law.as_ref()), (timestep, Span::Distance));
    let rows = |numbers: Range<u32>| {
        let base = body.rows.start as u32;
        base + numbers.start..base + numbers.end
    };
    let (first, second) = (rows(first), rows(second));
    let friction = spec.friction.as_ref().map(|friction| friction_of(friction, timestep));
    let description =
        CrowdDescription { name, law, first, second, range, friction, fusible, timestep, listing };
    Some(Crowd::new(description))
}

/// Bonds that melt, with the temperatures that masses at these places start with.
fn fusible_of(
    spec: &FusibleSpec,
    (range, timestep): (f64, f64),
    masses: impl Iterator<Item = Vec3>,
    crowd: &CrowdSpec,
    draft: &Draft,
) -> Option<Fusible> {
    let refuse = |code: Code, message: String, expected: &str| {
        draft.log.add(code, &crowd.site, message, expected);
        None
    };
    if spec.reach > range {
        let message = format!("masses set that are {} m apart, and the crowd ends at {range} m", spec.reach);
        return refuse(Code::OutOfRange, message, "a `reach` up to the range of the crowd");
    }
    let temperature = spec.temperature.as_ref()?;
    let places: Vec<Vec3> = masses.collect();
    let temperatures: Vec<f64> = places.iter().map(|place| temperature.evaluate(&place.to_array())).collect();
    if let Some(wrong) = temperatures.iter().find(|kelvins| !(kelvins.is_finite() && **kelvins >= 0.0)) {
        let message = format!("a mass starts at {wrong} K");
        return refuse(Code::NotFinite, message, "temperatures from 0 K");
    }
    let at_start = |formula: &Formula, is_well: fn(f64) -> bool| {
        let values = places.iter().map(|place| formula.evaluate(&[place.x, place.y, place.z, 0.0]));
        values.into_iter().find(|value| !is_well(*value))
    };
    if let Some(wrong) = spec.heating.as_ref().and_then(|heating| at_start(heating, f64::is_finite)) {
        let message = format!("a mass is heated by {wrong} W at the start");
        return refuse(Code::NotFinite, message, "a finite `heating`");
    }
    if let Some([exchange, ambient]) = &spec.exchange {
        // heat that flows from cold to warm runs away
        if let Some(wrong) = at_start(exchange, |value| value.is_finite() && value >= 0.0) {
            let message = format!("a mass exchanges {wrong} W/K with what is around it at the start");
            return refuse(Code::OutOfRange, message, "an `exchange` from 0 W/K");
        }
        if let Some(wrong) = at_start(ambient, |value| value.is_finite() && value >= 0.0) {
            let message = format!("what is around a mass has {wrong} K at the start");
            return refuse(Code::OutOfRange, message, "an `ambient` from 0 K");
        }
    }
    Some(Fusible {
        capacity: spec.capacity,
        conductance: spec.conductance,
        softening: spec.softening,
        melting: spec.melting,
        stiffness: spec.stiffness,
        damping: spec.damping / timestep,
        reach: spec.reach,
        heating: spec.heating.clone(),
        exchange: spec.exchange.clone(),
        temperatures,
    })
}

/// Warns of masses that exchange more heat in a step than they hold, with the neighbours and the exchange of the start: of temperatures that
/// would swing. Refuses masses of two fusible crowds, each of which would give them a temperature.
pub fn warn_of_heat(draft: &mut Draft) {
    let mut warnings = Vec::new();
    for body in draft.bodies.iter().filter(|body| body.spec.network.is_some()) {
        let positions: Vec<Vec3> = std::iter::repeat_n(Vec3::ZERO, body.rows.start)
            .chain(body.mesh.points.iter().copied())
            .collect();
        let is_here = |crowd: &&Crowd| {
            let [first, second] = crowd.rows();
            [first, second]
                .iter()
                .all(|rows| body.rows.start <= rows.start as usize && rows.end as usize <= body.rows.end)
        };
        let forces = draft.systems[body.system].forces.iter();
        let mut before: Vec<&Crowd> = Vec::new();
        for crowd in forces.filter_map(|force| force.as_any().downcast_ref::<Crowd>()).filter(is_here) {
            let Some((share, row)) = crowd.heat_share(&positions) else { continue };
            let both = before.iter().find_map(|other| Some((other, shared(crowd.rows(), other.rows())?)));
            if let Some((other, row)) = both {
                let message = format!(
                    "mass {} of network `{}` is in the fusible crowds `{}` and `{}`",
                    row as usize - body.rows.start,
                    body.spec.name,
                    other.name(),
                    crowd.name(),
                );
                draft.log.add(Code::Conflict, &body.spec.site, message, "one temperature of each mass");
            }
            before.push(crowd);
            if share > 1.0 {
                warnings.push(format!(
                    "{}: in a step mass {} of network `{}` exchanges {share:.3} of the heat that it holds: temperatures may swing; \
                     take shorter steps, or a greater `capacity`",
                    draft.place(&body.spec.site),
                    row as usize - body.rows.start,
                    body.spec.name,
                ));
            }
        }
    }
    draft.warnings.extend(warnings);
}

/// The first row that is in both.
fn shared(rows: [Range<u32>; 2], others: [Range<u32>; 2]) -> Option<u32> {
    let pairs = rows.iter().flat_map(|a| others.iter().map(move |b| a.start.max(b.start)..a.end.min(b.end)));
    pairs.filter(|both| !both.is_empty()).map(|both| both.start).min()
}

/// What of each body is drawn as faces of its parts.
pub fn faces(draft: &Draft) -> Vec<Option<FacesInfo>> {
    let of_body = |body: &Placed| faces::shown(body.spec.network.as_ref()?, &body.mesh.points);
    draft.bodies.iter().map(of_body).collect()
}

/// The contours of each body.
pub fn contours(draft: &Draft) -> Vec<Vec<ContourInfo>> {
    let of_body = |body: &Placed| {
        let contours = body.spec.network.as_ref().map_or(&[][..], |network| &network.contours);
        contours.iter().filter_map(|contour| ContourInfo::of(contour, body, draft)).collect()
    };
    draft.bodies.iter().map(of_body).collect()
}

/// Friction by displacements in a step.
fn friction_of(spec: &FrictionSpec, timestep: f64) -> Friction {
    let slide = match (&spec.curve, spec.fall) {
        (Some(points), _) => {
            Slide::Curve(points.iter().map(|[speed, coefficient]| [speed * timestep, *coefficient]).collect())
        }
        (None, None) if spec.growth == 0.0 => Slide::Coulomb(spec.sliding),
        (None, fall) => Slide::Stribeck {
            kinetic: spec.sliding,
            // fallen at once, as far as numbers tell
            sticking: if fall.is_some() { spec.sticking } else { spec.sliding },
            fall: fall.unwrap_or(1.0) * timestep,
            growth: spec.growth / timestep,
        },
    };
    // B = z/(k Te + z)
    let hold = spec.hook_viscosity.map_or(1.0, |z| z / (spec.stiffness * timestep + z));
    Friction {
        stiffness: spec.stiffness,
        damping: spec.damping / timestep,
        sticking: spec.sticking,
        slide,
        hold,
        slow: spec.speed * timestep,
    }
}

/// Half the distance at which balls of a group keep from each other, or from those of another group, for each mass [m], by a law or by a
/// constraint; else the radius by which planes keep off; zero where nothing does. Empty of a body that is no network.
pub fn radii(body: &Placed, spec: &Spec) -> Vec<f64> {
    let Some(network) = &body.spec.network else { return Vec::new() };
    let timestep = spec.world.period / f64::from(spec.systems[body.system].steps_per_period);
    let distance = |crowd: &CrowdSpec| {
        let chosen = crowd.law.as_ref()?;
        let driven = controls::driven_parameters(network, &Driven::Crowds(crowd.name.as_str()));
        let (values, span) = (&chosen.values, Span::Distance);
        (chosen.entry.build)(&Making { values, timestep, span, driven: &driven }).ok()?.rest_distance()
    };
    let holds = |name: &String, group: &Range<u32>| {
        let numbers = network.numbers_of(name).unwrap_or(0..0);
        numbers.start <= group.start && group.end <= numbers.end
    };
    let is_in = |crowd: &CrowdSpec, group: &str| {
        let group = network.numbers_of(group).unwrap_or(0..0);
        crowd.of.is_empty() || crowd.of.iter().any(|name| holds(name, &group))
    };
    let rigid_radius = |group: &MassGroup| {
        let own = network.numbers_of(&group.name).unwrap_or(0..0);
        let of = |spec: &&ConstraintSpec| spec.of.is_empty() || spec.of.iter().any(|name| holds(name, &own));
        let of_balls = |spec: &ConstraintSpec| match spec.kind {
            Some(ConstraintKind::Balls(diameter)) => Some(0.5 * diameter),
            _ => None,
        };
        // what others meet of a group by their faces
        let of_faces = |spec: &ConstraintSpec| {
            let Some(ConstraintKind::Faces(bodies)) = &spec.kind else { return None };
            let bodies = bodies
                .iter()
                .find(|bodies| bodies.of.is_empty() || bodies.of.iter().any(|name| holds(name, &own)))?;
            if let FacesForm::Balls(radius) = bodies.form { Some(radius) } else { None }
        };
        let of_plane = |spec: &ConstraintSpec| {
            matches!(spec.kind, Some(ConstraintKind::Plane(..))).then_some(spec.radius)
        };
        let constraints = || network.constraints.iter().filter(of);
        let by_balls = constraints().find_map(|spec| of_balls(spec).or_else(|| of_faces(spec)));
        by_balls.or_else(|| constraints().filter_map(of_plane).max_by(f64::total_cmp)).unwrap_or(0.0)
    };
    // those of one group among themselves tell more than those with another
    let radius = |group: &MassGroup| {
        let of = |crowd: &&CrowdSpec| is_in(crowd, &group.name);
        let alone = network.crowds.iter().filter(of).find(|crowd| crowd.of.len() < 2);
        let found = alone.or_else(|| network.crowds.iter().find(of));
        let by_law = found.and_then(distance).map(|distance| 0.5 * distance);
        by_law.unwrap_or_else(|| rigid_radius(group))
    };
    let each = network.masses.iter().map(|group| (radius(group), group.places.count() as usize));
    each.flat_map(|(radius, count)| std::iter::repeat_n(radius, count)).collect()
}
