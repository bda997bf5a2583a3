//! Tetrahedral meshes of fewer cells: edges collapse, cheapest first, and what is left is fitted to the surface that was.
//!
//! The price of a collapse is the sum of squared distances to the planes of the surface around, weighted by areas (Garland & Heckbert
//! 1997), and a share of the fourth power of the edge, by which insides go evenly. A collapse is refused when it would change
//! the topology (link condition, Dey et al. 1999) or leave a tetrahedron worse than allowed. Then the points of the surface go to where the given
//! one is, by least squares in which what is farthest weighs most.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use souple_math::Vec3;

use crate::coarsen::radius_ratio;
use crate::simplify::{Candidate, Quadric};
use crate::{Aabb, AabbTree, ElementKind, Mesh, TriangleSurface, closest_point_on_triangle};

/// Rounds of fitting, and how much less than the farthest place those nearby weigh in them, as a power of the distance.
const ROUNDS: [(usize, i32); 2] = [(60, 4), (60, 8)];
/// What surrounds the mesh, as a point of links.
const OUTSIDE: u32 = u32::MAX;

/// How far edges collapse, and which first.
#[derive(Clone, Copy, Debug)]
pub struct Plan {
    /// Tetrahedra; there are more where no edge may collapse any more.
    pub wanted: usize,
    /// The least radius ratio of a tetrahedron, where it was not less before.
    pub worst: f64,
    /// What an edge costs beside the surface, of the fourth power of its length.
    pub length_share: f64,
}

/// A mesh of fewer tetrahedra, of a mesh of `tet4`; groups are not carried.
pub fn decimated(mesh: &Mesh, plan: Plan) -> Mesh {
    let mut state = Decimation::new(mesh, plan);
    state.run();
    state.finish()
}

/// The farthest that points and centres of triangles of one surface are from another [m].
pub fn farthest(from: &TriangleSurface, to: &TriangleSurface) -> f64 {
    let nearest = Nearest::new(to);
    samples(from).into_iter().map(|place| nearest.of(place).1.length()).fold(0.0, f64::max)
}

/// Points and centres of triangles.
fn samples(surface: &TriangleSurface) -> Vec<Vec3> {
    let centre = |triangle: u32| surface.corners(triangle).into_iter().sum::<Vec3>() / 3.0;
    surface.points.iter().copied().chain((0..surface.triangles.len() as u32).map(centre)).collect()
}

/// Where a surface is nearest.
struct Nearest<'a> {
    surface: &'a TriangleSurface,
    tree: AabbTree,
}

impl<'a> Nearest<'a> {
    fn new(surface: &'a TriangleSurface) -> Self {
        let count = surface.triangles.len() as u32;
        let boxes: Vec<Aabb> = (0..count).map(|triangle| Aabb::of(surface.corners(triangle))).collect();
        Self { surface, tree: AabbTree::build(&boxes) }
    }

    /// The weights of the corners of the nearest triangle, which it is, and the way from there to a place.
    fn of(&self, place: Vec3) -> (([f64; 3], u32), Vec3) {
        let way = |triangle: u32| {
            let corners = self.surface.corners(triangle);
            let (weights, _) = closest_point_on_triangle(place, corners);
            let at: Vec3 = corners.into_iter().zip(weights).map(|(corner, weight)| corner * weight).sum();
            (weights, place - at)
        };
        let found = self.tree.nearest(place, f64::INFINITY, |triangle| way(triangle).1.length_sq());
        let triangle = found.map_or(0, |(triangle, _)| triangle);
        let (weights, to) = way(triangle);
        ((weights, triangle), to)
    }
}

/// Three times the inscribed over the circumscribed radius; negative where the corners are turned over.
fn turned_ratio(corners: [Vec3; 4]) -> f64 {
    let [a, b, c, d] = corners;
    let volume = (b - a).dot((c - a).cross(d - a));
    if volume > 0.0 { radius_ratio(corners) } else { -1.0 }
}

struct Decimation {
    /// Points and planes are taken about this one, near which nothing large cancels.
    origin: Vec3,
    points: Vec<Vec3>,
    tets: Vec<[u32; 4]>,
    is_gone: Vec<bool>,
    around: Vec<Vec<u32>>,
    is_outside: Vec<bool>,
    quadrics: Vec<Quadric>,
    ages: Vec<u32>,
    left: usize,
    plan: Plan,
}

/// The link of a point or of an edge: what closes it, each list ascending.
#[derive(Default)]
struct Link {
    points: Vec<u32>,
    edges: Vec<[u32; 2]>,
    faces: Vec<[u32; 3]>,
}

impl Link {
    fn sort(&mut self) {
        self.points.sort_unstable();
        self.points.dedup();
        self.edges.sort_unstable();
        self.edges.dedup();
        self.faces.sort_unstable();
        self.faces.dedup();
    }
}

fn common<T: Ord + Copy>(a: &[T], b: &[T]) -> Vec<T> {
    a.iter().copied().filter(|item| b.binary_search(item).is_ok()).collect()
}

impl Decimation {
    fn new(mesh: &Mesh, plan: Plan) -> Self {
        let count = mesh.points.len();
        let tets: Vec<[u32; 4]> = mesh
            .cells()
            .filter(|cell| cell.kind == ElementKind::Tet4)
            .map(|cell| [cell.nodes[0], cell.nodes[1], cell.nodes[2], cell.nodes[3]])
            .collect();
        let surface = mesh.boundary_surface();
        let mut state = Self {
            origin: surface.bounds().centre(),
            points: mesh.points.clone(),
            is_gone: vec![false; tets.len()],
            around: vec![Vec::new(); count],
            is_outside: vec![false; count],
            quadrics: vec![Quadric::ZERO; count],
            ages: vec![0; count],
            left: tets.len(),
            tets,
            plan,
        };
        for (number, tet) in state.tets.iter().enumerate() {
            tet.iter().for_each(|point| state.around[*point as usize].push(number as u32));
        }
        for (triangle, corners) in surface.triangles.iter().enumerate() {
            let area = surface.area_vector(triangle as u32);
            let Some(normal) = area.try_normalised() else { continue };
            let first = surface.points[corners[0] as usize];
            let plane = Quadric::plane(first - state.origin, normal, area.length() / 3.0);
            for corner in corners {
                let point = surface.mesh_points[*corner as usize] as usize;
                state.is_outside[point] = true;
                state.quadrics[point] = state.quadrics[point].plus(&plane);
            }
        }
        state
    }

    fn run(&mut self) {
        let mut queue = BinaryHeap::new();
        for point in 0..self.points.len() as u32 {
            let later = self.neighbours(point).into_iter().filter(|other| *other > point);
            queue.extend(later.map(|other| Reverse(self.candidate(point, other))));
        }
        while self.left > self.plan.wanted
            && let Some(Reverse(candidate)) = queue.pop()
        {
            let [a, b] = candidate.ends;
            let is_now = candidate.ages == [self.ages[a as usize], self.ages[b as usize]];
            if !is_now || !self.collapse(a, b) {
                continue;
            }
            // what may collapse and for what price has changed for all edges nearby
            let near = self.neighbours(a);
            near.iter().for_each(|point| self.ages[*point as usize] += 1);
            let mut edges: Vec<[u32; 2]> = Vec::new();
            for point in near {
                edges.extend(
                    self.neighbours(point).into_iter().map(|other| [point.min(other), point.max(other)]),
                );
            }
            edges.retain(|[a, b]| a < b);
            edges.sort_unstable();
            edges.dedup();
            queue.extend(edges.into_iter().map(|[a, b]| Reverse(self.candidate(a, b))));
        }
    }

    /// Points of the tetrahedra around a point, ascending, with itself.
    fn neighbours(&self, point: u32) -> Vec<u32> {
        let around = self.around[point as usize].iter();
        let mut points: Vec<u32> = around.flat_map(|tet| self.tets[*tet as usize]).collect();
        points.sort_unstable();
        points.dedup();
        points
    }

    fn candidate(&self, a: u32, b: u32) -> Candidate {
        let [p, q] = [a, b].map(|point| self.points[point as usize]);
        let (position, cost) = self.places(a, b)[0];
        let cost = cost + self.plan.length_share * (q - p).length_sq().powi(2);
        Candidate { cost, ends: [a, b], ages: [self.ages[a as usize], self.ages[b as usize]], position }
    }

    /// Where the ends of an edge may become one point and what that costs the surface, the cheapest first.
    fn places(&self, a: u32, b: u32) -> Vec<(Vec3, f64)> {
        let [p, q] = [a, b].map(|point| self.points[point as usize]);
        let quadric = self.quadrics[a as usize].plus(&self.quadrics[b as usize]);
        let of = |x: Vec3| (x, quadric.at(x - self.origin));
        let mut places = match [a, b].map(|point| self.is_outside[point as usize]) {
            [true, false] => return vec![of(p)],
            [false, true] => return vec![of(q)],
            _ => vec![of((p + q) * 0.5), of(p), of(q)],
        };
        let least = quadric.minimum().map(|x| x + self.origin);
        // far away planes meet nearly parallel: not there
        places.extend(least.filter(|x| (*x - (p + q) * 0.5).length_sq() <= (q - p).length_sq()).map(of));
        places.sort_by(|(_, one), (_, other)| one.total_cmp(other));
        places
    }

    /// The link of a point; the outside belongs to it where the point does to the surface.
    fn link(&self, point: u32) -> Link {
        let mut link = Link::default();
        for tet in &self.around[point as usize] {
            let mut others = [0; 3];
            let corners = self.tets[*tet as usize].into_iter().filter(|corner| *corner != point);
            others.iter_mut().zip(corners).for_each(|(other, corner)| *other = corner);
            others.sort_unstable();
            let [a, b, c] = others;
            link.points.extend(others);
            link.edges.extend([[a, b], [a, c], [b, c]]);
            link.faces.push(others);
        }
        // a face of the point that only one tetrahedron has is of the surface
        link.edges.sort_unstable();
        let outer: Vec<[u32; 2]> =
            link.edges.chunk_by(|a, b| a == b).filter(|same| same.len() == 1).map(|same| same[0]).collect();
        for [a, b] in outer {
            link.points.push(OUTSIDE);
            link.edges.extend([[a, OUTSIDE], [b, OUTSIDE]]);
            link.faces.push([a, b, OUTSIDE]);
        }
        link.sort();
        link
    }

    /// The link of an edge, of that of its first end.
    fn link_of_edge(&self, of_first: &Link, b: u32) -> Link {
        let mut link = Link::default();
        for face in of_first.faces.iter().filter(|face| face.contains(&b)) {
            let mut others = face.iter().copied().filter(|point| *point != b);
            let (Some(x), Some(y)) = (others.next(), others.next()) else { continue };
            link.points.extend([x, y]);
            link.edges.push([x, y]);
        }
        link.sort();
        link
    }

    /// Joins the second end of an edge to the first unless that is refused.
    fn collapse(&mut self, a: u32, b: u32) -> bool {
        let [of_a, of_b] = [a, b].map(|point| self.link(point));
        let of_edge = self.link_of_edge(&of_a, b);
        if common(&of_a.points, &of_b.points) != of_edge.points
            || common(&of_a.edges, &of_b.edges) != of_edge.edges
            || !common(&of_a.faces, &of_b.faces).is_empty()
        {
            return false;
        }
        let mut touched: Vec<u32> =
            self.around[a as usize].iter().chain(&self.around[b as usize]).copied().collect();
        touched.sort_unstable();
        touched.dedup();
        let is_lost = |tet: &u32| {
            let corners = self.tets[*tet as usize];
            corners.contains(&a) && corners.contains(&b)
        };
        let (lost, kept): (Vec<u32>, Vec<u32>) = touched.iter().partition(|tet| is_lost(tet));
        let least = |at: Option<Vec3>| {
            let ratio = |tet: &u32| {
                turned_ratio(self.tets[*tet as usize].map(|point| match at {
                    Some(at) if point == a || point == b => at,
                    _ => self.points[point as usize],
                }))
            };
            kept.iter().map(ratio).fold(f64::INFINITY, f64::min)
        };
        let wanted = self.plan.worst.min(least(None));
        let found = self.places(a, b).into_iter().find(|(place, _)| least(Some(*place)) >= wanted);
        let Some((place, _)) = found.filter(|_| !kept.is_empty()) else { return false };
        self.points[a as usize] = place;
        self.is_outside[a as usize] |= self.is_outside[b as usize];
        self.quadrics[a as usize] = self.quadrics[a as usize].plus(&self.quadrics[b as usize]);
        for tet in lost {
            self.is_gone[tet as usize] = true;
            self.left -= 1;
            for point in self.tets[tet as usize] {
                self.around[point as usize].retain(|other| *other != tet);
            }
        }
        for tet in std::mem::take(&mut self.around[b as usize]) {
            self.tets[tet as usize] = self.tets[tet as usize].map(|point| if point == b { a } else { point });
            self.around[a as usize].push(tet);
        }
        self.ages[b as usize] += 1;
        true
    }

    fn finish(self) -> Mesh {
        let left = self.tets.into_iter().zip(&self.is_gone).filter(|(_, is_gone)| !**is_gone);
        let mut mesh = Mesh::new(self.points, ElementKind::Tet4, left.flat_map(|(tet, _)| tet).collect());
        mesh.remove_loose_points();
        mesh
    }
}

/// Brings the surface of a mesh nearer to another where that leaves no tetrahedron worse than allowed.
pub fn fit(mesh: &mut Mesh, goal: &TriangleSurface, worst: f64) {
    let tets: Vec<[u32; 4]> =
        mesh.cells().map(|cell| [cell.nodes[0], cell.nodes[1], cell.nodes[2], cell.nodes[3]]).collect();
    let mut around = vec![Vec::new(); mesh.points.len()];
    for (number, tet) in tets.iter().enumerate() {
        tet.iter().for_each(|point| around[*point as usize].push(number));
    }
    let least = |points: &[Vec3], of: &[usize]| {
        let ratio = |tet: &usize| turned_ratio(tets[*tet].map(|point| points[point as usize]));
        of.iter().map(ratio).fold(f64::INFINITY, f64::min)
    };
    let places = samples(goal);
    let mut best = (f64::INFINITY, mesh.points.clone());
    for power in ROUNDS.into_iter().flat_map(|(rounds, power)| std::iter::repeat_n(power, rounds)) {
        let surface = mesh.boundary_surface();
        let nearest = Nearest::new(&surface);
        let found: Vec<(([f64; 3], u32), Vec3)> = places.iter().map(|place| nearest.of(*place)).collect();
        let there = found.iter().map(|(_, way)| way.length()).fold(0.0, f64::max);
        let back = farthest(&surface, goal);
        if there.max(back) < best.0 {
            best = (there.max(back), mesh.points.clone());
        }
        if there == 0.0 {
            break;
        }
        // x += Σ w b r / Σ w b of what is nearest to the triangles of a point
        let mut sums = vec![(Vec3::ZERO, 0.0); surface.points.len()];
        for ((weights, triangle), way) in &found {
            let weight = (way.length() / there).powi(power) + 1e-3;
            for (corner, share) in surface.triangles[*triangle as usize].iter().zip(weights) {
                let (sum, of) = &mut sums[*corner as usize];
                *sum += *way * (weight * share);
                *of += weight * share;
            }
        }
        for (corner, (sum, of)) in sums.into_iter().enumerate().filter(|(_, (_, of))| *of > 0.0) {
            let point = surface.mesh_points[corner] as usize;
            let (before, bound) = (mesh.points[point], worst.min(least(&mesh.points, &around[point])));
            // the whole way, or half of it, or a quarter
            for share in [1.0, 0.5, 0.25] {
                mesh.points[point] = before + sum * (share / of);
                if least(&mesh.points, &around[point]) >= bound {
                    break;
                }
                mesh.points[point] = before;
            }
        }
    }
    mesh.points = best.1;
}

#[cfg(test)]
mod tests {
    use souple_table::{Value, Values};

    use super::*;
    use crate::coarsen::radius_ratios;
    use crate::fill::{Options, PARAMETERS};
    use crate::implicit::SHAPES;

    /// A ball of 40 tetrahedra and a torus of 200: closed as they were, of one piece, no cell bad, the surface within what chords of as many
    /// triangles leave.
    #[test]
    fn shape_and_topology_are_kept() {
        for (shape, wanted, near) in [("ellipsoid", 40, 0.1), ("torus", 200, 0.1)] {
            let entry = SHAPES.find(shape).unwrap();
            let values = entry.values(Values::new()).unwrap();
            let body = (entry.build)(&values).unwrap();
            let size = 0.06 * body.shape.bounds().diagonal();
            let size = Values::new().with("size", Value::Number(size)).completed(PARAMETERS).unwrap();
            let fine = Options::from_values(&size).unwrap().fill_body(&body).unwrap().mesh;
            let plan = Plan { wanted, worst: 0.12, length_share: 0.01 };
            let mut coarse = decimated(&fine, plan);
            fit(&mut coarse, &fine.boundary_surface(), plan.worst);
            let count = coarse.cell_count();
            assert!((count as f64 / wanted as f64 - 1.0).abs() < 0.2, "{shape}: {count}");
            assert!(radius_ratios(&coarse).into_iter().all(|ratio| ratio > 0.1), "{shape}");
            let [before, after] = [&fine, &coarse].map(Mesh::boundary_surface);
            // V - E + F with E = 3 F / 2 of a closed surface
            let euler =
                |surface: &TriangleSurface| surface.points.len() as i64 - surface.triangles.len() as i64 / 2;
            assert_eq!(euler(&after), euler(&before), "{shape}");
            let apart = farthest(&before, &after).max(farthest(&after, &before));
            assert!(apart < near * fine.bounds().diagonal(), "{shape}: {apart}");
        }
    }
}
