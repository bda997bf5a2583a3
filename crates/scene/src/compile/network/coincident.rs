//! Masses that start at one place, or so near to each other that rounding tells the direction between them: there is none to push or
//! pull along.
//!
//! Each coordinate of a place `x` is known to `ε |x|`, and masses that a law wants `L` apart have places about as large as `L` as soon
//! as they part. Of a coordinate of their distance less than half the digits are known below `√ε L`, and none below `ε |x|`.

use std::ops::Range;

use souple_math::Vec3;
use souple_models::network::{Making, Span};
use souple_table::counted;

use super::super::Draft;
use super::controls::driven_parameters;
use super::{PlacedLinks, ends};
use crate::spec::body::Body;
use crate::spec::control::Driven;
use crate::spec::network::{CrowdSpec, Network};

/// What two masses are apart at most that count as at one place, along each axis [m].
fn apart(largest: f64, length: f64) -> f64 {
    (f64::EPSILON * largest).max(f64::EPSILON.sqrt() * length.abs())
}

/// The largest coordinate of places [m].
fn largest<'a>(places: impl IntoIterator<Item = &'a Vec3>) -> f64 {
    let coordinates = places.into_iter().flat_map(|place| place.to_array());
    coordinates.fold(0.0, |largest: f64, x| largest.max(x.abs()))
}

/// `start at one place`, or how far apart.
fn start(places: [Vec3; 2]) -> String {
    let [a, b] = places;
    match (a - b).length() {
        0.0 => "start at one place".to_owned(),
        apart => format!("start {apart:.1e} m from each other, which is lost in rounding"),
    }
}

/// Links that have no direction at the start: only another force can part their ends.
pub fn links(
    body: &Body,
    network: &Network,
    links: &[PlacedLinks],
    points: &[Vec3],
    draft: &Draft,
) -> Vec<String> {
    let tables = network.links.iter().zip(links);
    tables
        .filter_map(|(table, links)| {
            let meets = |(ends, rest): &(&[u32; 2], &f64)| {
                let [a, b] = ends.map(|end| points[end as usize]);
                let limit = apart(largest([&a, &b]), **rest);
                (a - b).to_array().into_iter().all(|x| x.abs() <= limit)
            };
            let mut all = links.ends.iter().zip(&links.rest_lengths);
            let (ends, _) = all.find(|link| table.span == Span::Distance && meets(link))?;
            let [a, b] = ends;
            let place = draft.place(&table.site);
            let start = start(ends.map(|end| points[end as usize]));
            Some(format!(
                "{place}: masses {a} and {b} of network `{}` {start}: a link between them has no direction",
                body.name
            ))
        })
        .collect()
}

/// Masses of crowds that start at one place, by crowds; those of which both are fixed want nothing of each other.
pub fn crowds(body: &Body, network: &Network, places: &[Vec3], draft: &Draft) -> Vec<String> {
    if network.crowds.is_empty() {
        return Vec::new();
    }
    let largest = largest(places);
    let is_fixed: Vec<bool> = network.of_each(|group| group.is_fixed).collect();
    let told = |index: usize| {
        let crowd = &network.crowds[index];
        let (first, second) = ends::groups(&crowd.of, network)?;
        let clusters = clusters(places, apart(largest, range(crowd, network, draft)));
        let met = clusters.iter().filter_map(|cluster| meeting(cluster, &first, &second, &is_fixed));
        let met: Vec<[u32; 2]> = met.collect();
        let first = *met.first()?;
        let [a, b] = first.map(|mass| called(network, mass));
        let start = start(first.map(|mass| places[mass as usize]));
        let more = match met.len() - 1 {
            0 => String::new(),
            more => format!(", and so do some at {} more", counted(more as u64, "place")),
        };
        Some(format!(
            "{}: masses {a} and {b} of network `{}` {start}{more}: they meet in this crowd, which has no direction to part \
             them along",
            draft.place(&crowd.site),
            body.name
        ))
    };
    (0..network.crowds.len()).filter_map(told).collect()
}

/// Beyond which masses of a crowd want nothing of each other [m]; zero where that is not known.
fn range(crowd: &CrowdSpec, network: &Network, draft: &Draft) -> f64 {
    let of_law = || {
        let chosen = crowd.law.as_ref()?;
        let driven = driven_parameters(network, &Driven::Crowds(crowd.name.as_str()));
        let (values, timestep, span) = (&chosen.values, draft.spec.world.period, Span::Distance);
        let making = Making { values, timestep, span, driven: &driven };
        // what cannot be built is told elsewhere
        (chosen.entry.build)(&making).ok().map(|law| law.range())
    };
    crowd.range.or_else(of_law).filter(|range| range.is_finite()).unwrap_or(0.0)
}

/// Numbers of masses that share a place with others, place by place: those that are `apart` at most along each axis, or have others
/// between them that are.
fn clusters(places: &[Vec3], apart: f64) -> Vec<Vec<u32>> {
    let mut masses: Vec<u32> = (0..places.len() as u32).collect();
    let mut clusters = Vec::new();
    part(&mut masses, (0, 0), places, apart, &mut clusters);
    clusters.sort_unstable();
    clusters
}

/// Parts masses along an axis where nothing is between them, then along the next, until `whole` axes in turn have parted nothing.
fn part(
    masses: &mut [u32],
    (axis, whole): (usize, usize),
    places: &[Vec3],
    apart: f64,
    clusters: &mut Vec<Vec<u32>>,
) {
    if masses.len() < 2 {
        return;
    }
    if whole == 3 {
        masses.sort_unstable();
        clusters.push(masses.to_vec());
        return;
    }
    let along = |mass: u32| places[mass as usize][axis];
    masses.sort_unstable_by(|a, b| along(*a).total_cmp(&along(*b)));
    let all = masses.len();
    for run in masses.chunk_by_mut(|a, b| along(*b) - along(*a) <= apart) {
        let whole = if run.len() == all { whole + 1 } else { 1 };
        part(run, ((axis + 1) % 3, whole), places, apart, clusters);
    }
}

/// The first two masses of a place that a crowd brings together, at least one of which moves.
fn meeting(cluster: &[u32], first: &Range<u32>, second: &Range<u32>, is_fixed: &[bool]) -> Option<[u32; 2]> {
    let of = |group: &Range<u32>, fixed: bool| {
        let is_of = move |mass: &&u32| group.contains(mass) && is_fixed[**mass as usize] == fixed;
        cluster.iter().filter(is_of).copied().collect::<Vec<u32>>()
    };
    let [moving, others] = [first, second].map(|group| of(group, false));
    let [held, others_held] = [first, second].map(|group| of(group, true));
    let pair = |a: &[u32], b: &[u32]| {
        // groups may share masses
        a.iter().find_map(|a| b.iter().find(|b| *b != a).map(|b| [*a.min(b), *a.max(b)]))
    };
    pair(&moving, &others).or_else(|| pair(&moving, &others_held)).or_else(|| pair(&others, &held))
}

/// A mass by its number, and by its number within its group.
fn called(network: &Network, mass: u32) -> String {
    let group = network.masses.iter().find_map(|group| {
        let own = network.numbers_of(&group.name).filter(|own| own.contains(&mass))?;
        Some((&group.name, mass - own.start))
    });
    group.map_or_else(|| mass.to_string(), |(name, number)| format!("{mass} (`{name}` {number})"))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Masses that share a place, one by one and through others, on a lattice whose planes and lines hold many of one coordinate.
    #[test]
    fn clusters_are_those_of_all_pairs() {
        let mut places: Vec<Vec3> = (0..1000)
            .map(|i| Vec3::new(f64::from(i % 10), f64::from(i / 10 % 10), f64::from(i / 100)))
            .collect();
        let near = |place: Vec3, way: Vec3| place + way * 1e-12;
        let (one, other) = (places[345], places[7]);
        places.extend([near(one, Vec3::X), near(one, Vec3::X * 1.9), other, near(places[0], Vec3::Z * 3.0)]);
        assert_eq!(clusters(&places, 1.5e-12), [vec![7, 1002], vec![345, 1000, 1001]]);
        assert_eq!(clusters(&places, 0.0), [[7, 1002]]);
        // zero has two signs
        assert_eq!(clusters(&[Vec3::ZERO, -Vec3::ZERO], 0.0), [[0, 1]]);
    }
}
