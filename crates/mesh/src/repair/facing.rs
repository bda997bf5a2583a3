//! Triangles that lie back to back: where parts touch, and copies that are turned over.

use std::collections::HashMap;

use souple_math::Vec3;

use super::{SurfaceRepairs, edges_of, from_lowest};
use crate::TriangleSurface;
use crate::winding::WindingNumber;

/// Drops pairs of triangles that lie back to back where two closed parts touch: what is left is closed again.
///
/// Pairs that hang together by edges of no other triangle are a patch. Around a place of contact the edges keep an even number of
/// triangles, around a copy of a part of one surface that is turned over they have three, and around a sheet or a shell of two
/// sides there is nothing. Of a copy, and of a shell that is not within another part, one triangle of each pair stays.
pub(super) fn drop_pairs(points: &[Vec3], triangles: &mut Vec<[u32; 3]>, repairs: &mut SurfaceRepairs) {
    let pairs = pairs(triangles);
    if pairs.is_empty() {
        return;
    }
    let mut uses: HashMap<[u32; 2], Uses> = HashMap::new();
    triangles.iter().flat_map(edges_of).for_each(|edge| uses.entry(edge).or_default().all += 1);
    for [first, _] in &pairs {
        edges_of(&triangles[*first]).iter().for_each(|edge| uses.entry(*edge).or_default().of_pairs += 2);
    }
    let mut around = vec![Around::default(); pairs.len()];
    let patch_of = patches(&pairs, triangles, &uses);
    for ([first, _], patch) in pairs.iter().zip(&patch_of) {
        edges_of(&triangles[*first]).iter().for_each(|edge| around[*patch].add(uses[edge]));
    }
    let is_alone = |pair: usize| around[patch_of[pair]] == Around::default();
    let mut is_of_alone = vec![false; triangles.len()];
    for (pair, [first, second]) in pairs.iter().enumerate() {
        (is_of_alone[*first], is_of_alone[*second]) = (is_alone(pair), is_alone(pair));
    }
    let others: Vec<[u32; 3]> = triangles
        .iter()
        .zip(&is_of_alone)
        .filter(|(_, alone)| !**alone)
        .map(|(corners, _)| *corners)
        .collect();
    let others = (0..pairs.len())
        .any(is_alone)
        .then(|| WindingNumber::new(&TriangleSurface::from_mesh(points, &others, Vec::new())));
    // one place of a patch tells of all of it
    let mut is_within: HashMap<usize, bool> = HashMap::new();
    let mut is_dropped = vec![false; triangles.len()];
    for (pair, [first, second]) in pairs.iter().enumerate() {
        let patch = patch_of[pair];
        let both = match &others {
            Some(others) if is_alone(pair) => *is_within.entry(patch).or_insert_with(|| {
                let corners = triangles[*first].map(|point| points[point as usize]);
                others.at(corners.into_iter().sum::<Vec3>() / 3.0).abs() > 0.5
            }),
            _ => around[patch].even > around[patch].odd,
        };
        (is_dropped[*first], is_dropped[*second]) = (both, true);
        if both {
            repairs.facing_triangles += 2;
        } else {
            repairs.doubled_triangles += 1;
        }
    }
    let mut dropped = is_dropped.into_iter();
    triangles.retain(|_| dropped.next() != Some(true));
}

/// Triangles at an edge, all and those of pairs.
#[derive(Clone, Copy, Debug, Default)]
struct Uses {
    all: usize,
    of_pairs: usize,
}

/// Edges of a patch that other triangles have too, by how many there are.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Around {
    even: usize,
    odd: usize,
}

impl Around {
    fn add(&mut self, Uses { all, of_pairs }: Uses) {
        if all == of_pairs {
            return;
        }
        let count = if all.is_multiple_of(2) { &mut self.even } else { &mut self.odd };
        *count += 1;
    }
}

/// Triangles of the same corners that run around them in opposite directions, the first of each pair before the second.
fn pairs(triangles: &[[u32; 3]]) -> Vec<[usize; 2]> {
    let mut open: HashMap<[u32; 3], usize> = HashMap::new();
    let mut pairs = Vec::new();
    for (index, [a, b, c]) in triangles.iter().enumerate() {
        match open.remove(&from_lowest([*a, *c, *b])) {
            Some(other) => pairs.push([other, index]),
            None => {
                open.insert(from_lowest([*a, *b, *c]), index);
            }
        }
    }
    pairs
}

/// The patch of each pair, called by its first pair.
fn patches(pairs: &[[usize; 2]], triangles: &[[u32; 3]], uses: &HashMap<[u32; 2], Uses>) -> Vec<usize> {
    let mut at_edge: HashMap<[u32; 2], Vec<usize>> = HashMap::new();
    for (pair, [first, _]) in pairs.iter().enumerate() {
        let own =
            edges_of(&triangles[*first]).into_iter().filter(|edge| uses[edge].all == uses[edge].of_pairs);
        own.for_each(|edge| at_edge.entry(edge).or_default().push(pair));
    }
    let mut patch_of = vec![usize::MAX; pairs.len()];
    for start in 0..pairs.len() {
        let mut reached = if patch_of[start] == usize::MAX { vec![start] } else { Vec::new() };
        while let Some(pair) = reached.pop() {
            patch_of[pair] = start;
            let beside =
                edges_of(&triangles[pairs[pair][0]]).into_iter().filter_map(|edge| at_edge.get(&edge));
            reached.extend(beside.flatten().filter(|other| patch_of[**other] == usize::MAX));
        }
    }
    patch_of
}
