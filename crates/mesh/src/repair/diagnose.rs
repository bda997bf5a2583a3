//! Everything that is wrong with a surface, counted, with a first place for each.

use std::collections::{HashMap, HashSet};

use souple_table::in_number;

use super::crossing::{Crossings, crossings};
use super::is_flat;
use super::weld::equal_points;
use super::within::winds_once;
use crate::TriangleSurface;
use crate::sets::Sets;

/// Most pairs of triangles that pass through each other of which a diagnosis tells: a surface with as many is not mended by hand.
pub const MOST_CROSSINGS: usize = 1000;

/// What is wrong with a surface.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Diagnosis {
    /// Points at the place of another, exactly.
    pub duplicate_points: usize,
    /// Triangles without area.
    pub flat_triangles: Vec<u32>,
    /// Triangles with the corners of another.
    pub doubled_triangles: Vec<u32>,
    /// Edges of one triangle, by their points.
    pub open_edges: Vec<[u32; 2]>,
    /// Edges of three triangles or more.
    pub crowded_edges: Vec<[u32; 2]>,
    /// Edges along which two triangles run the same way.
    pub misoriented_edges: Vec<[u32; 2]>,
    /// Points where fans of triangles meet that share no edge there.
    pub pinched_points: Vec<u32>,
    /// Pairs of triangles that pass through each other, the first [`MOST_CROSSINGS`] of them.
    pub crossings: Crossings,
    /// Parts that share no point.
    pub component_count: usize,
    /// Whether triangles face what is inside, where none pass through each other: parts lie within each other, overlap or cross where
    /// edges meet, or some face inward.
    pub overlaps: bool,
    /// Whether the surface is closed and its enclosed volume negative.
    pub is_inside_out: bool,
}

/// Looks at a whole surface.
pub fn diagnose(surface: &TriangleSurface) -> Diagnosis {
    let first_at = equal_points(&surface.points);
    let mut diagnosis = Diagnosis {
        duplicate_points: first_at
            .iter()
            .enumerate()
            .filter(|(point, first)| *point as u32 != **first)
            .count(),
        crossings: crossings(surface, MOST_CROSSINGS),
        component_count: components(surface).1,
        is_inside_out: surface.check_closed().is_ok() && surface.enclosed_volume() < 0.0,
        ..Diagnosis::default()
    };
    let mut seen: HashMap<[u32; 3], u32> = HashMap::new();
    for (triangle, corners) in surface.triangles.iter().enumerate() {
        if is_flat(*corners, &surface.points) {
            diagnosis.flat_triangles.push(triangle as u32);
        }
        let mut key = *corners;
        key.sort_unstable();
        if seen.insert(key, triangle as u32).is_some() {
            diagnosis.doubled_triangles.push(triangle as u32);
        }
    }
    for (edge, forward, backward) in surface.edge_uses() {
        match (forward, backward) {
            (1, 1) => {}
            (1, 0) | (0, 1) => diagnosis.open_edges.push(edge),
            (2, 0) | (0, 2) => diagnosis.misoriented_edges.push(edge),
            _ => diagnosis.crowded_edges.push(edge),
        }
    }
    // at the ends of edges that are faulty the fans are so too, which is told
    let faulty = diagnosis.crowded_edges.iter().chain(&diagnosis.misoriented_edges).flatten();
    let faulty: HashSet<u32> = faulty.copied().collect();
    diagnosis.pinched_points = surface.pinched_points();
    diagnosis.pinched_points.retain(|point| !faulty.contains(point));
    // of others it is known already that normals do not tell inside from outside
    diagnosis.overlaps = !surface.triangles.is_empty() && diagnosis.is_simple() && !winds_once(surface);
    diagnosis
}

impl Diagnosis {
    /// Closed, oriented, without crossings and overlaps: normals alone tell inside from outside.
    pub fn is_simple(&self) -> bool {
        let crosses = !self.crossings.pairs.is_empty() || self.crossings.is_cut_off;
        self.is_closed() && self.flat_triangles.is_empty() && !crosses && !self.overlaps
    }

    /// Whether every edge has two triangles of opposite direction.
    pub fn is_closed(&self) -> bool {
        self.open_edges.is_empty() && self.crowded_edges.is_empty() && self.misoriented_edges.is_empty()
    }

    /// One line for each kind of fault; empty for a surface in order.
    pub fn messages(&self) -> Vec<String> {
        let mut messages = Vec::new();
        let mut say = |count: usize, [one, many]: [&str; 2], first: String| {
            if count > 0 {
                messages.push(in_number(count, one, many) + &first);
            }
        };
        let edge = |list: &[[u32; 2]]| {
            list.first().map(|[a, b]| format!(", the first between points {a} and {b}")).unwrap_or_default()
        };
        let triangle =
            |list: &[u32]| list.first().map(|t| format!(", the first is triangles[{t}]")).unwrap_or_default();
        say(
            self.duplicate_points,
            ["point lies at the place of another", "points lie at the place of another"],
            String::new(),
        );
        say(
            self.flat_triangles.len(),
            ["triangle has no area", "triangles have no area"],
            triangle(&self.flat_triangles),
        );
        say(
            self.doubled_triangles.len(),
            ["triangle repeats another", "triangles repeat another"],
            triangle(&self.doubled_triangles),
        );
        say(
            self.open_edges.len(),
            [
                "edge has one triangle only: the surface has a hole",
                "edges have one triangle only: the surface has holes",
            ],
            edge(&self.open_edges),
        );
        say(
            self.crowded_edges.len(),
            ["edge has three triangles or more", "edges have three triangles or more"],
            edge(&self.crowded_edges),
        );
        say(
            self.misoriented_edges.len(),
            [
                "edge lies between triangles of opposite orientation",
                "edges lie between triangles of opposite orientation",
            ],
            edge(&self.misoriented_edges),
        );
        let point =
            |list: &[u32]| list.first().map(|p| format!(", the first is points[{p}]")).unwrap_or_default();
        say(
            self.pinched_points.len(),
            [
                "point joins triangles that share no edge there",
                "points join triangles that share no edge there",
            ],
            point(&self.pinched_points),
        );
        let pairs = &self.crossings.pairs;
        let pair = pairs.first().map(|[s, t]| format!(", the first are triangles[{s}] and triangles[{t}]"));
        say(
            pairs.len(),
            ["pair of triangles passes through each other", "pairs of triangles pass through each other"],
            pair.unwrap_or_default(),
        );
        if self.crossings.is_cut_off {
            messages.push(if pairs.len() < MOST_CROSSINGS {
                "triangles lie within each other so densely that not all pairs of them were looked at"
                    .to_owned()
            } else {
                format!("after the first {MOST_CROSSINGS} such pairs it was not looked for more")
            });
        }
        if self.overlaps {
            let faults = "parts lie within each other, overlap, cross where edges meet, or face inward";
            messages.push(format!("some triangles face what is inside: {faults}"));
        }
        if self.component_count > 1 {
            messages.push(format!("the surface has {} parts that share no point", self.component_count));
        }
        if self.is_inside_out {
            messages.push("the surface is inside out".to_owned());
        }
        messages
    }
}

/// The part of each triangle, parts numbered by their first triangle, and how many there are; triangles of a part
/// are joined by shared points.
pub(crate) fn components(surface: &TriangleSurface) -> (Vec<u32>, usize) {
    let mut joined = Sets::new(surface.points.len());
    for [a, b, c] in &surface.triangles {
        joined.join(*a, *b);
        joined.join(*a, *c);
    }
    let mut number: HashMap<u32, u32> = HashMap::new();
    let mut parts = Vec::with_capacity(surface.triangles.len());
    for [a, ..] in &surface.triangles {
        let next = number.len() as u32;
        parts.push(*number.entry(joined.of(*a)).or_insert(next));
    }
    (parts, number.len())
}
