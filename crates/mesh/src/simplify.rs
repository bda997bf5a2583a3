//! Surfaces with fewer triangles: edges collapse, cheapest first, as long as the surface stays within a bound.
//!
//! The price of a collapse is the sum of squared distances to the planes of the triangles around (Garland & Heckbert
//! 1997); the new point is where that is least. A collapse is refused when it would change the topology (link
//! condition, Dey et al. 1999), turn a triangle over, or leave the bound: corners, middles of sides and centres of
//! the new triangles must be as close to the given surface as asked, and so must every given point and centre of a
//! triangle be to the new one. Points on edges that have not two triangles stay where they are.
//!
//! Two parts of the surface that come through each other are looked for at the end; where there are any, all is done again
//! and no collapse is made around them that lets triangles pass through others, until there are none.

use std::cmp::{Ordering, Reverse};
use std::collections::BinaryHeap;

use souple_math::{Mat3, Vec3};

use crate::repair::{crossings, triangles_cross};
use crate::{Aabb, AabbTree, MeshError, TriangleSurface, closest_point_on_triangle};

/// How far to go.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Goal {
    /// Largest distance between the given surface and the new one [m].
    pub distance: f64,
    /// No fewer triangles than this.
    pub triangles: usize,
}

/// A simplified surface and how far it is from the given one.
#[derive(Clone, Debug)]
pub struct Simplified {
    pub surface: TriangleSurface,
    /// Largest distance that was measured in either direction [m].
    pub distance: f64,
    /// Pairs of triangles that pass through each other; none where the given surface has none.
    pub crossings: usize,
    /// Whether there may be more of them: triangles lie within each other so densely that not all pairs were looked at.
    pub may_have_more_crossings: bool,
}

/// Cosine of the largest turn of a triangle in one collapse.
const LARGEST_TURN: f64 = 0.2;

/// Height over longest side below which a triangle is nearly flat: none is made, but of others as flat.
const FLATTEST: f64 = 1e-3;

/// Rounds in which triangles that come through others are looked for where there were any; after these, everywhere.
const MOST_ROUNDS: usize = 4;

/// # Errors
/// The bound is not a number of at least zero; there are no triangles.
pub fn simplify(surface: &TriangleSurface, goal: Goal) -> Result<Simplified, MeshError> {
    if goal.distance.is_nan() || goal.distance < 0.0 {
        let expected = "a distance of at least 0 [m]".to_owned();
        return Err(MeshError::Parameter { name: "distance", value: goal.distance.to_string(), expected });
    }
    if surface.triangles.is_empty() {
        return Err(MeshError::NoCells);
    }
    // beyond its own size nothing is left of a surface
    let bound = goal.distance.min(surface.bounds().diagonal());
    let mut watched: Vec<Aabb> = Vec::new();
    for round in 0.. {
        let mut state = Collapse::new(surface, bound, &watched);
        state.run(goal.triangles);
        let mut simplified = state.finish();
        let crossed = crossings(&simplified.surface, usize::MAX);
        simplified.crossings = crossed.pairs.len();
        simplified.may_have_more_crossings = crossed.is_cut_off;
        let pairs = crossed.pairs.into_iter().flatten();
        let boxes: Vec<Aabb> = pairs.map(|t| Aabb::of(simplified.surface.corners(t))).collect();
        // what was watched comes from the given surface, which may cross itself
        let tree = AabbTree::build(&watched);
        let is_watched = |bounds: &Aabb| {
            let mut found = false;
            tree.overlapping(*bounds, |_| found = true);
            found
        };
        if boxes.iter().all(is_watched) {
            return Ok(simplified);
        }
        if round < MOST_ROUNDS {
            // the triangles that come out next time lie beside these
            watched.extend(boxes.iter().map(|bounds| bounds.grown(0.5 * bounds.diagonal())));
        } else {
            watched = vec![Aabb::of(surface.points.iter().copied()).grown(bound)];
        }
    }
    unreachable!("all is watched after {MOST_ROUNDS} rounds")
}

/// `xᵀ A x - 2 b · x + c`: squared distances to planes, weighted.
#[derive(Clone, Copy)]
pub(crate) struct Quadric {
    a: Mat3,
    b: Vec3,
    c: f64,
}

impl Quadric {
    pub(crate) const ZERO: Self = Self { a: Mat3 { columns: [Vec3::ZERO; 3] }, b: Vec3::ZERO, c: 0.0 };

    /// The plane through `point`, whose normal has length one.
    pub(crate) fn plane(point: Vec3, normal: Vec3, weight: f64) -> Self {
        let d = normal.dot(point);
        Self { a: normal.outer(normal) * weight, b: normal * (d * weight), c: d * d * weight }
    }

    pub(crate) fn plus(&self, other: &Self) -> Self {
        Self { a: self.a + other.a, b: self.b + other.b, c: self.c + other.c }
    }

    pub(crate) fn at(&self, x: Vec3) -> f64 {
        (x.dot(self.a * x) - 2.0 * self.b.dot(x) + self.c).max(0.0)
    }

    /// Where it is least, unless the planes leave a direction free.
    pub(crate) fn minimum(&self) -> Option<Vec3> {
        let [p, q, r] = self.a.columns;
        let volume = p.dot(q.cross(r));
        let scale = self.a.columns.iter().map(|column| column.length()).fold(0.0, f64::max);
        if volume.abs() <= 1e-6 * scale.powi(3) {
            return None;
        }
        // Cramer's rule; the matrix is symmetric
        let solve = Vec3::new(self.b.dot(q.cross(r)), p.dot(self.b.cross(r)), p.dot(q.cross(self.b)));
        Some(solve / volume)
    }
}

/// A collapse to be tried; out of date when one of its ends has changed since.
pub(crate) struct Candidate {
    pub cost: f64,
    pub ends: [u32; 2],
    pub ages: [u32; 2],
    pub position: Vec3,
}

impl Ord for Candidate {
    fn cmp(&self, other: &Self) -> Ordering {
        self.cost.total_cmp(&other.cost).then(self.ends.cmp(&other.ends)).then(self.ages.cmp(&other.ages))
    }
}

impl PartialOrd for Candidate {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Candidate {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Candidate {}

struct Collapse<'a> {
    given: &'a TriangleSurface,
    tree: AabbTree,
    /// How far the surface may leave the given one [m].
    bound: f64,
    /// Boxes in which triangles may not come to pass through others.
    watched: AabbTree,
    /// Quadrics, points and bounds are taken about this point, near which nothing large cancels.
    origin: Vec3,
    points: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    is_gone: Vec<bool>,
    /// Triangles that are not as given, in the order in which they first changed.
    changed: Vec<u32>,
    is_changed: Vec<bool>,
    around: Vec<Vec<u32>>,
    quadrics: Vec<Quadric>,
    ages: Vec<u32>,
    is_fixed: Vec<bool>,
    /// Points of the given surface that each triangle is the closest to.
    carried: Vec<Vec<Vec3>>,
    left: usize,
    reached: f64,
}

impl<'a> Collapse<'a> {
    fn new(given: &'a TriangleSurface, bound: f64, watched: &[Aabb]) -> Self {
        let boxes: Vec<Aabb> =
            (0..given.triangles.len() as u32).map(|triangle| Aabb::of(given.corners(triangle))).collect();
        let mut state = Self {
            given,
            tree: AabbTree::build(&boxes),
            bound,
            watched: AabbTree::build(watched),
            origin: given.bounds().centre(),
            points: given.points.clone(),
            triangles: given.triangles.clone(),
            is_gone: vec![false; given.triangles.len()],
            changed: Vec::new(),
            is_changed: vec![false; given.triangles.len()],
            around: vec![Vec::new(); given.points.len()],
            quadrics: vec![Quadric::ZERO; given.points.len()],
            ages: vec![0; given.points.len()],
            is_fixed: vec![false; given.points.len()],
            carried: Vec::with_capacity(given.triangles.len()),
            left: given.triangles.len(),
            reached: 0.0,
        };
        for (triangle, corners) in given.triangles.iter().enumerate() {
            let [a, b, c] = given.corners(triangle as u32);
            let area = (b - a).cross(c - a);
            let quadric = area.try_normalised().map_or(Quadric::ZERO, |normal| {
                Quadric::plane(a - state.origin, normal, 0.5 * area.length())
            });
            for point in corners {
                state.around[*point as usize].push(triangle as u32);
                state.quadrics[*point as usize] = state.quadrics[*point as usize].plus(&quadric);
            }
            state.carried.push(vec![(a + b + c) / 3.0]);
        }
        for (point, triangles) in state.around.iter().enumerate() {
            if let Some(first) = triangles.first() {
                state.carried[*first as usize].push(given.points[point]);
            }
        }
        for (edge, forward, backward) in given.edge_uses() {
            if (forward, backward) != (1, 1) {
                edge.iter().for_each(|point| state.is_fixed[*point as usize] = true);
            }
        }
        state
    }

    fn run(&mut self, least_triangles: usize) {
        let mut queue = BinaryHeap::new();
        for ([a, b], ..) in self.given.edge_uses() {
            queue.extend(self.candidate(a, b).map(Reverse));
        }
        while let Some(Reverse(candidate)) = queue.pop() {
            if self.left < least_triangles + 2 {
                return;
            }
            let [a, b] = candidate.ends;
            if candidate.ages != [self.ages[a as usize], self.ages[b as usize]] || !self.collapse(&candidate)
            {
                continue;
            }
            let mut neighbours: Vec<u32> = self.neighbours(a);
            neighbours.retain(|point| *point != a);
            for point in neighbours {
                queue.extend(self.candidate(a.min(point), a.max(point)).map(Reverse));
            }
        }
    }

    fn candidate(&self, a: u32, b: u32) -> Option<Candidate> {
        let [p, q] = [a, b].map(|point| self.points[point as usize]);
        let quadric = self.quadrics[a as usize].plus(&self.quadrics[b as usize]);
        let cost = |x: Vec3| quadric.at(x - self.origin);
        let fixed = [a, b].map(|point| self.is_fixed[point as usize]);
        let best = |choices: &[Vec3]| choices.iter().copied().min_by(|x, y| cost(*x).total_cmp(&cost(*y)));
        let position = match fixed {
            [true, true] => None,
            [true, false] => Some(p),
            [false, true] => Some(q),
            [false, false] => match quadric.minimum().map(|x| x + self.origin) {
                // far away planes meet nearly parallel: not there
                Some(x) if (x - (p + q) * 0.5).length_sq() <= (q - p).length_sq() => Some(x),
                _ => best(&[(p + q) * 0.5, p, q]),
            },
        }?;
        // edges of equal cost go by length
        let cost = cost(position) + 1e-12 * (q - p).length_sq().powi(2);
        Some(Candidate { cost, ends: [a, b], ages: [self.ages[a as usize], self.ages[b as usize]], position })
    }

    /// Points of the triangles around a point, ascending, with itself.
    fn neighbours(&self, point: u32) -> Vec<u32> {
        let triangles = self.around[point as usize].iter();
        let mut points: Vec<u32> = triangles.flat_map(|t| self.triangles[*t as usize]).collect();
        points.sort_unstable();
        points.dedup();
        points
    }

    /// Joins the second end to the first unless that is refused.
    fn collapse(&mut self, candidate: &Candidate) -> bool {
        let ([a, b], position) = (candidate.ends, candidate.position);
        let is_shared = |t: &u32| {
            let corners = self.triangles[*t as usize];
            corners.contains(&a) && corners.contains(&b)
        };
        let mut touched: Vec<u32> =
            self.around[a as usize].iter().chain(&self.around[b as usize]).copied().collect();
        touched.sort_unstable();
        touched.dedup();
        let (lost, kept): (Vec<u32>, Vec<u32>) = touched.iter().partition(|t| is_shared(t));
        if lost.len() != 2 || !self.keeps_topology(a, b) {
            return false;
        }
        let moved = |t: u32| {
            self.triangles[t as usize]
                .map(|point| if point == a || point == b { position } else { self.points[point as usize] })
        };
        let new: Vec<(u32, [Vec3; 3])> = kept.iter().map(|t| (*t, moved(*t))).collect();
        let turns = |(t, [p, q, r]): &(u32, [Vec3; 3])| {
            let [a, b, c] = self.triangles[*t as usize].map(|point| self.points[point as usize]);
            let (before, after) = ((b - a).cross(c - a), (*q - *p).cross(*r - *p));
            let scale = before.length() * after.length();
            // a flat triangle, before or after, turns too
            before.dot(after) <= LARGEST_TURN * scale || scale.is_nan()
        };
        if new.is_empty() || new.iter().any(turns) || self.flattens(&touched, &new) {
            return false;
        }
        let Some((carried, reached)) = self.within_bound(&touched, &new) else { return false };
        if self.comes_through(candidate, &touched, &kept) {
            return false;
        }
        self.reached = self.reached.max(reached);
        for triangle in &kept {
            if !std::mem::replace(&mut self.is_changed[*triangle as usize], true) {
                self.changed.push(*triangle);
            }
        }
        for (list, (triangle, _)) in carried.into_iter().zip(&new) {
            self.carried[*triangle as usize] = list;
        }
        for triangle in lost {
            self.is_gone[triangle as usize] = true;
            for point in self.triangles[triangle as usize] {
                self.around[point as usize].retain(|other| *other != triangle);
            }
        }
        let from_b = std::mem::take(&mut self.around[b as usize]);
        for triangle in from_b {
            for point in &mut self.triangles[triangle as usize] {
                *point = if *point == b { a } else { *point };
            }
            self.around[a as usize].push(triangle);
        }
        self.points[a as usize] = position;
        self.quadrics[a as usize] = self.quadrics[a as usize].plus(&self.quadrics[b as usize]);
        self.is_fixed[a as usize] |= self.is_fixed[b as usize];
        self.ages[a as usize] += 1;
        self.ages[b as usize] += 1;
        self.left -= 2;
        true
    }

    /// Exactly the two points opposite to the edge are neighbours of both ends.
    fn keeps_topology(&self, a: u32, b: u32) -> bool {
        let (of_a, of_b) = (self.neighbours(a), self.neighbours(b));
        let common = of_a.iter().filter(|point| of_b.binary_search(point).is_ok()).count();
        // both ends are in both lists; four triangles are the least that enclose anything
        common == 4 && self.left > 4
    }

    /// Whether a triangle becomes nearly flat, and none that it comes from was as flat.
    fn flattens(&self, touched: &[u32], new: &[(u32, [Vec3; 3])]) -> bool {
        let flattest =
            new.iter().map(|(_, corners)| height_over_side(*corners)).fold(f64::INFINITY, f64::min);
        let before = touched.iter().map(|t| self.triangles[*t as usize].map(|p| self.points[p as usize]));
        flattest < FLATTEST && flattest < before.map(height_over_side).fold(f64::INFINITY, f64::min)
    }

    /// Whether a triangle of a collapse, where that is watched, would pass through one that none of those it comes from
    /// passes through.
    fn comes_through(&self, candidate: &Candidate, touched: &[u32], kept: &[u32]) -> bool {
        let ([a, b], position) = (candidate.ends, candidate.position);
        let joined = |t: &u32| self.triangles[*t as usize].map(|point| if point == b { a } else { point });
        let new_position = |point: u32| if point == a { position } else { self.points[point as usize] };
        let old_position = |point: u32| self.points[point as usize];
        kept.iter().map(joined).enumerate().any(|(index, triangle)| {
            let bounds = Aabb::of(triangle.map(new_position));
            let mut is_watched = false;
            self.watched.overlapping(bounds, |_| is_watched = true);
            if !is_watched {
                return false;
            }
            let crosses = |other: &[u32; 3]| triangles_cross(triangle, *other, new_position);
            if kept[index + 1..].iter().map(joined).any(|other| crosses(&other)) {
                return true;
            }
            self.live_near(bounds).into_iter().filter(|other| touched.binary_search(other).is_err()).any(
                |other| {
                    let other = self.triangles[other as usize];
                    let crossed = |t: &u32| triangles_cross(self.triangles[*t as usize], other, old_position);
                    crosses(&other) && !touched.iter().any(crossed)
                },
            )
        })
    }

    /// Triangles that are left and whose boxes overlap one.
    fn live_near(&self, bounds: Aabb) -> Vec<u32> {
        let mut near = Vec::new();
        self.tree.overlapping(bounds, |triangle| {
            if !self.is_gone[triangle as usize] && !self.is_changed[triangle as usize] {
                near.push(triangle);
            }
        });
        let is_near = |triangle: &&u32| {
            let corners = self.triangles[**triangle as usize].map(|point| self.points[point as usize]);
            !self.is_gone[**triangle as usize] && Aabb::of(corners).overlaps(bounds)
        };
        near.extend(self.changed.iter().filter(is_near));
        near
    }

    /// The given points that each new triangle carries, and the largest distance measured; `None` beyond the bound.
    fn within_bound(&self, touched: &[u32], new: &[(u32, [Vec3; 3])]) -> Option<(Vec<Vec<Vec3>>, f64)> {
        let bound = self.bound;
        let mut reached = 0.0_f64;
        let mut carried = vec![Vec::new(); new.len()];
        for point in touched.iter().flat_map(|triangle| &self.carried[*triangle as usize]) {
            let distances = new.iter().map(|(_, corners)| distance_sq(*point, *corners));
            let (nearest, least) = distances.enumerate().min_by(|a, b| a.1.total_cmp(&b.1))?;
            reached = reached.max(least);
            if least.is_nan() || least > bound * bound {
                return None;
            }
            carried[nearest].push(*point);
        }
        for (_, [a, b, c]) in new {
            let samples = [*a, (*a + *b) * 0.5, (*b + *c) * 0.5, (*c + *a) * 0.5, (*a + *b + *c) / 3.0];
            for sample in samples {
                let distance = |triangle| distance_sq(sample, self.given.corners(triangle));
                let (_, least) = self.tree.nearest(sample, bound * bound, distance)?;
                reached = reached.max(least);
            }
        }
        Some((carried, reached.sqrt()))
    }

    fn finish(self) -> Simplified {
        let kept: Vec<[u32; 3]> =
            self.triangles.iter().zip(&self.is_gone).filter(|(_, gone)| !**gone).map(|(t, _)| *t).collect();
        let mut surface = TriangleSurface::from_mesh(&self.points, &kept, Vec::new());
        surface.mesh_points.clear();
        Simplified { surface, distance: self.reached, crossings: 0, may_have_more_crossings: false }
    }
}

/// The height of a triangle over its longest side, relative to that; zero where all corners are at one place.
fn height_over_side([a, b, c]: [Vec3; 3]) -> f64 {
    let longest_sq = (b - a).length_sq().max((c - b).length_sq()).max((a - c).length_sq());
    if longest_sq > 0.0 { (b - a).cross(c - a).length() / longest_sq } else { 0.0 }
}

fn distance_sq(point: Vec3, corners: [Vec3; 3]) -> f64 {
    let ([u, v, w], _) = closest_point_on_triangle(point, corners);
    (corners[0] * u + corners[1] * v + corners[2] * w - point).length_sq()
}

#[cfg(test)]
mod tests {
    use souple_table::{Value, Values};

    use super::*;
    use crate::repair::diagnose;

    fn ball() -> TriangleSurface {
        let values = Values::new().with("radius", Value::Number(1.0)).with("cells", Value::Integer(16));
        crate::generate("sphere", values).unwrap().boundary_surface()
    }

    /// Flat sides lose all their inner points without moving at all.
    #[test]
    fn a_cube_becomes_twelve_triangles() {
        let values = Values::new()
            .with("size", Value::Vector([1.0; 3]))
            .with("cells", Value::Vector([6.0; 3]))
            .with("element", Value::Text("hex8"));
        let cube = crate::generate("box", values).unwrap().boundary_surface();
        let simple = simplify(&cube, Goal { distance: 1e-9, triangles: 0 }).unwrap();
        assert!(diagnose(&simple.surface).is_simple());
        assert_eq!(simple.surface.triangles.len(), 12);
        assert!((simple.surface.enclosed_volume() - 1.0).abs() < 1e-8);
    }

    /// The bound holds in both directions at points that were not looked at, and topology stays.
    #[test]
    fn the_bound_holds() {
        let ball = ball();
        let mut last = ball.triangles.len();
        for distance in [1e-2, 3e-2, 0.1] {
            let simple = simplify(&ball, Goal { distance, triangles: 0 }).unwrap();
            assert!(simple.distance <= distance);
            assert!(diagnose(&simple.surface).is_simple());
            assert!(simple.surface.triangles.len() * 3 < last * 2, "{}", simple.surface.triangles.len());
            last = simple.surface.triangles.len();
            let surface = &simple.surface;
            for [a, b, c] in (0..last as u32).map(|t| surface.corners(t)) {
                for (u, v) in [(0.2, 0.3), (0.6, 0.1), (0.1, 0.8)] {
                    let p = a * u + b * v + c * (1.0 - u - v);
                    let near = (0..ball.triangles.len() as u32).map(|t| distance_sq(p, ball.corners(t)));
                    // between samples half a side apart a chord is at most a third deeper than at them
                    assert!(near.fold(f64::INFINITY, f64::min).sqrt() < 1.34 * distance);
                }
            }
        }
    }

    /// A thin shell: its two sides come through each other where each alone may leave its place by the shell's thickness.
    #[test]
    fn nothing_comes_through_itself() {
        let outer = ball();
        let mut shell = outer.clone();
        let count = outer.points.len() as u32;
        shell.points.extend(outer.points.iter().map(|point| *point * 0.97));
        shell.triangles.extend(outer.triangles.iter().map(|[a, b, c]| [c + count, b + count, a + count]));
        let goal = Goal { distance: 0.1, triangles: 0 };
        let mut free = Collapse::new(&shell, goal.distance, &[]);
        free.run(0);
        assert!(!crossings(&free.finish().surface, 1).pairs.is_empty(), "the case is no case");
        let simple = simplify(&shell, goal).unwrap();
        assert!(simple.crossings == 0 && !simple.may_have_more_crossings);
        assert!(diagnose(&simple.surface).is_simple());
        assert!(
            4 * simple.surface.triangles.len() < 3 * shell.triangles.len(),
            "{}",
            simple.surface.triangles.len()
        );
    }

    /// Two balls that cross as given keep crossing, and the bound all the same.
    #[test]
    fn surfaces_that_cross_keep_the_bound() {
        let mut two = ball();
        let count = two.points.len() as u32;
        two.points.extend(ball().points.iter().map(|point| *point + Vec3::X));
        two.triangles.extend(ball().triangles.iter().map(|corners| corners.map(|corner| corner + count)));
        let simple = simplify(&two, Goal { distance: 0.02, triangles: 0 }).unwrap();
        assert!(simple.crossings > 0 && simple.distance <= 0.02, "{} m", simple.distance);
        assert!(simple.surface.triangles.len() < two.triangles.len());
    }

    /// Limbs that lie side by side: they would come through each other where few triangles are left, and the count is met all the
    /// same, with no triangle that is flat.
    #[test]
    fn the_count_is_met_where_parts_are_near() {
        let long = ball();
        let mut limbs = ball();
        limbs.points.clear();
        limbs.triangles.clear();
        for k in 0..4 {
            let first = limbs.points.len() as u32;
            let place = |x: Vec3| {
                Vec3::new(0.1 * x.x + 0.22 * f64::from(k), 0.1 * x.y, x.z + 0.4 * x.x * f64::from(k % 2))
            };
            limbs.points.extend(long.points.iter().map(|x| place(*x)));
            limbs.triangles.extend(long.triangles.iter().map(|corners| corners.map(|corner| corner + first)));
        }
        for triangles in [1000, 200, 80, 40] {
            let simple = simplify(&limbs, Goal { distance: f64::INFINITY, triangles }).unwrap();
            let left = simple.surface.triangles.len();
            assert!((triangles..triangles + 2).contains(&left), "{left} of {triangles}");
            assert_eq!(simple.crossings, 0, "{triangles}");
            let flattest = (0..left as u32).map(|t| height_over_side(simple.surface.corners(t)));
            assert!(flattest.fold(f64::INFINITY, f64::min) >= FLATTEST, "{triangles}");
        }
    }

    #[test]
    fn the_count_holds_and_bad_bounds_are_refused() {
        let simple = simplify(&ball(), Goal { distance: f64::INFINITY, triangles: 200 }).unwrap();
        assert!((200..=201).contains(&simple.surface.triangles.len()), "{}", simple.surface.triangles.len());
        assert!(simplify(&ball(), Goal { distance: f64::NAN, triangles: 0 }).is_err());
    }

    /// The rim of an open surface stays where it is.
    #[test]
    fn rims_stay() {
        let mut half = ball();
        let points = half.points.clone();
        half.triangles.retain(|corners| corners.iter().all(|point| points[*point as usize].z > -1e-9));
        let rim = |surface: &TriangleSurface| -> Vec<[u64; 3]> {
            let open = surface.edge_uses().into_iter().filter(|(_, f, b)| f + b == 1);
            let mut rim: Vec<_> = open
                .flat_map(|(edge, ..)| edge)
                .map(|point| surface.points[point as usize].to_array().map(f64::to_bits))
                .collect();
            rim.sort_unstable();
            rim.dedup();
            rim
        };
        let simple = simplify(&half, Goal { distance: 0.05, triangles: 0 }).unwrap();
        assert!(simple.surface.triangles.len() < half.triangles.len() / 2);
        assert_eq!(rim(&simple.surface), rim(&half));
    }
}
