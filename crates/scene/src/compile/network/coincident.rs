//! Masses that start at one place: between them there is no direction to push or pull along.

use std::ops::Range;

use souple_math::Vec3;
use souple_models::network::Span;
use souple_table::counted;

use super::super::Draft;
use super::{PlacedLinks, ends};
use crate::spec::body::Body;
use crate::spec::network::Network;

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
            let meets = |[a, b]: &&[u32; 2]| points[*a as usize] == points[*b as usize];
            let ends = links.ends.iter().find(|ends| table.span == Span::Distance && meets(ends))?;
            let [a, b] = ends;
            let place = draft.place(&table.site);
            Some(format!(
                "{place}: masses {a} and {b} of network `{}` start at one place: a link between them has no direction",
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
    let clusters = clusters(places);
    let is_fixed: Vec<bool> = network.of_each(|group| group.is_fixed).collect();
    let told = |index: usize| {
        let crowd = &network.crowds[index];
        let (first, second) = ends::groups(&crowd.of, network)?;
        let met = clusters.iter().filter_map(|cluster| meeting(cluster, &first, &second, &is_fixed));
        let met: Vec<[u32; 2]> = met.collect();
        let [a, b] = met.first()?.map(|mass| called(network, mass));
        let more = match met.len() - 1 {
            0 => String::new(),
            more => format!(", and so do some at {} more", counted(more as u64, "place")),
        };
        Some(format!(
            "{}: masses {a} and {b} of network `{}` start at one place{more}: they meet in this crowd, which has no direction to part \
             them along",
            draft.place(&crowd.site),
            body.name
        ))
    };
    (0..network.crowds.len()).filter_map(told).collect()
}

/// Numbers of masses that share a place with others, place by place.
fn clusters(places: &[Vec3]) -> Vec<Vec<u32>> {
    // zero has two signs
    let key = |mass: &u32| places[*mass as usize].to_array().map(|x| (x + 0.0).to_bits());
    let mut masses: Vec<u32> = (0..places.len() as u32).collect();
    masses.sort_unstable_by_key(|mass| (key(mass), *mass));
    let of_one_place = masses.chunk_by(|a, b| key(a) == key(b)).filter(|cluster| cluster.len() > 1);
    let mut clusters: Vec<Vec<u32>> = of_one_place.map(<[u32]>::to_vec).collect();
    clusters.sort_unstable();
    clusters
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
