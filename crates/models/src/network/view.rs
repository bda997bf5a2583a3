//! Points of view between masses and links: links act on places that are functions of masses, and their forces come back by
//! the transposed derivative, so that no work is lost.
//!
//! `x' = g(Σ w x)`, `v' = J Σ w v`, `F = w Jᵀ F'` with `J = ∂g/∂x`: a scale, another frame, cylinder coordinates, a mean.

use std::any::Any;

use souple_engine::tangent::add_block;
use souple_engine::{
    Configuration, Curvature, Declaration, Energy, Force, Kept, Pair, Scratch, TangentWeights,
};
use souple_math::{Mat3, Vec3};
use souple_solve::BlockMatrix;

use super::force::Links;

/// What is made of a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Map {
    /// `A x + b`.
    Affine { matrix: Mat3, offset: Vec3 },
    /// `(r, θ, z)` of `A (x - origin)`, the rows of `A` being the axes; θ in radians, within half a turn.
    Cylinder { axes: Mat3, origin: Vec3 },
}

/// A place that links see in the place of masses.
#[derive(Clone, Debug, PartialEq)]
pub struct ViewPoint {
    /// Rows and their weights.
    pub sources: Vec<(u32, f64)>,
    pub map: Map,
}

impl Map {
    pub fn place(&self, x: Vec3) -> Vec3 {
        match self {
            Self::Affine { matrix, offset } => *matrix * x + *offset,
            Self::Cylinder { axes, origin } => {
                let p = *axes * (x - *origin);
                Vec3::new(p.x.hypot(p.y), p.y.atan2(p.x), p.z)
            }
        }
    }

    /// `∂x'/∂x`; on the axis of a cylinder, where there is none, that of the radius alone.
    pub fn derivative(&self, x: Vec3) -> Mat3 {
        match self {
            Self::Affine { matrix, .. } => *matrix,
            Self::Cylinder { axes, origin } => {
                let p = *axes * (x - *origin);
                let r = p.x.hypot(p.y);
                let (c, s) = if r > 0.0 { (p.x / r, p.y / r) } else { (1.0, 0.0) };
                let across = if r > 0.0 { 1.0 / r } else { 0.0 };
                let radius = Vec3::new(c, s, 0.0);
                let angle = Vec3::new(-s * across, c * across, 0.0);
                (Vec3::X.outer(radius) + Vec3::Y.outer(angle) + Vec3::Z.outer(Vec3::Z)) * *axes
            }
        }
    }
}

impl ViewPoint {
    fn mean(&self, values: &[Vec3]) -> Vec3 {
        self.sources.iter().map(|(row, weight)| values[*row as usize] * *weight).sum()
    }

    /// `F = w Jᵀ F'`
    fn give_back(&self, derivative: Mat3, force: Vec3, out: &mut [Vec3]) {
        let force = derivative.transpose() * force;
        for (row, weight) in &self.sources {
            out[*row as usize] += force * *weight;
        }
    }
}

/// Links whose ends are masses or points of view on masses.
#[derive(Debug)]
pub struct ViewedLinks {
    /// Over `rows`, then `points`.
    links: Links,
    /// Masses that links act on themselves.
    rows: Vec<u32>,
    points: Vec<ViewPoint>,
}

/// What links see, and what they do there.
struct Seen {
    positions: Vec<Vec3>,
    velocities: Vec<Vec3>,
    forces: Vec<Vec3>,
    /// Of points: `∂x'/∂x`.
    derivatives: Vec<Mat3>,
    links: Scratch,
}

impl ViewedLinks {
    /// `links` have ends below `rows.len()`, which are these masses, and from there on, which are these points.
    pub fn new(links: Links, rows: Vec<u32>, points: Vec<ViewPoint>) -> Self {
        Self { links, rows, points }
    }

    pub fn links(&self) -> &Links {
        &self.links
    }

    fn look(&self, at: &Configuration, seen: &mut Seen) {
        let count = self.rows.len() + self.points.len();
        let Seen { positions, velocities, forces, derivatives, .. } = seen;
        positions.clear();
        velocities.clear();
        derivatives.clear();
        positions.extend(self.rows.iter().map(|row| at.positions[*row as usize]));
        velocities.extend(self.rows.iter().map(|row| at.velocities[*row as usize]));
        for point in &self.points {
            let x = point.mean(at.positions);
            let derivative = point.map.derivative(x);
            positions.push(point.map.place(x));
            velocities.push(derivative * point.mean(at.velocities));
            derivatives.push(derivative);
        }
        forces.clear();
        forces.resize(count, Vec3::ZERO);
    }

    /// `out += F` of what acts on what is seen.
    fn give_back(&self, seen: &Seen, out: &mut [Vec3]) {
        let (on_rows, on_points) = seen.forces.split_at(self.rows.len());
        for (row, force) in self.rows.iter().zip(on_rows) {
            out[*row as usize] += *force;
        }
        for ((point, force), derivative) in self.points.iter().zip(on_points).zip(&seen.derivatives) {
            point.give_back(*derivative, *force, out);
        }
    }

    /// Rows of an end and what a change of each does to it.
    fn changes(&self, end: u32, derivatives: &[Mat3]) -> Vec<(u32, Mat3)> {
        match (end as usize).checked_sub(self.rows.len()) {
            None => vec![(self.rows[end as usize], Mat3::IDENTITY)],
            Some(point) => {
                let change = |(row, weight): &(u32, f64)| (*row, derivatives[point] * *weight);
                self.points[point].sources.iter().map(change).collect()
            }
        }
    }

    fn add_seen_blocks(
        &self,
        at: &Configuration,
        curvature: Curvature,
        weights: TangentWeights,
        seen: &mut Seen,
        matrix: &mut BlockMatrix,
    ) -> bool {
        self.look(at, seen);
        let inner = Configuration { positions: &seen.positions, velocities: &seen.velocities, ..*at };
        self.links.visit_tangents(&inner, curvature, weights, |ends, block| {
            let [a, b] = ends.map(|end| self.changes(end, &seen.derivatives));
            let signed = || a.iter().map(|change| (1.0, change)).chain(b.iter().map(|change| (-1.0, change)));
            for (sign, (row, change)) in signed() {
                for (other_sign, (other, other_change)) in signed() {
                    let part = change.transpose() * block * *other_change * (sign * other_sign);
                    add_block(matrix, *row as usize, *other as usize, &part);
                }
            }
        })
    }
}

fn seen(scratch: &mut Scratch) -> &mut Seen {
    scratch.downcast_mut().unwrap_or_else(|| unreachable!("made by this force's own new_scratch"))
}

impl Force for ViewedLinks {
    fn name(&self) -> &str {
        self.links.name()
    }

    fn declaration(&self) -> Declaration {
        // a scale takes momentum, a frame takes its moment
        Declaration { internal: false, ..self.links.declaration() }
    }

    fn memory_len(&self) -> usize {
        self.links.memory_len()
    }

    fn initial_memory(&self, memory: &mut [f64]) {
        self.links.initial_memory(memory);
    }

    fn new_scratch(&self) -> Scratch {
        Box::new(Seen {
            positions: Vec::new(),
            velocities: Vec::new(),
            forces: Vec::new(),
            derivatives: Vec::new(),
            links: self.links.new_scratch(),
        })
    }

    fn energy(&self, at: &Configuration, scratch: &mut Scratch) -> Energy {
        let seen = seen(scratch);
        self.look(at, seen);
        let inner = Configuration { positions: &seen.positions, velocities: &seen.velocities, ..*at };
        self.links.energy(&inner, &mut seen.links)
    }

    fn held(&self, at: &Configuration, scratch: &mut Scratch) -> f64 {
        let seen = seen(scratch);
        self.look(at, seen);
        let inner = Configuration { positions: &seen.positions, velocities: &seen.velocities, ..*at };
        self.links.held(&inner, &mut seen.links)
    }

    fn add_force(&self, at: &Configuration, scratch: &mut Scratch, out: &mut [Vec3]) {
        let seen = seen(scratch);
        self.look(at, seen);
        let inner = Configuration { positions: &seen.positions, velocities: &seen.velocities, ..*at };
        self.links.add_force(&inner, &mut seen.links, &mut seen.forces);
        self.give_back(seen, out);
    }

    fn add_differential(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        delta: &[Vec3],
        scratch: &mut Scratch,
        out: &mut [Vec3],
    ) {
        let seen = seen(scratch);
        self.look(at, seen);
        let inner = Configuration { positions: &seen.positions, velocities: &seen.velocities, ..*at };
        // Jᵀ K J δ: what turns with a cylinder is left to the next step
        let mut changed: Vec<Vec3> = self.rows.iter().map(|row| delta[*row as usize]).collect();
        let points = self.points.iter().zip(&seen.derivatives);
        changed.extend(points.map(|(point, derivative)| *derivative * point.mean(delta)));
        self.links.add_differential(&inner, weights, &changed, &mut seen.links, &mut seen.forces);
        self.give_back(seen, out);
    }

    fn visit_cliques(&self, pairs: &[Pair], visit: &mut dyn FnMut(&[u32])) {
        let none = vec![Mat3::IDENTITY; self.points.len()];
        self.links.visit_cliques(pairs, &mut |ends| {
            let mut rows: Vec<u32> =
                ends.iter().flat_map(|end| self.changes(*end, &none)).map(|(row, _)| row).collect();
            rows.sort_unstable();
            rows.dedup();
            visit(&rows);
        });
    }

    fn add_blocks(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        scratch: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) {
        self.add_seen_blocks(at, Curvature::Exact, weights, seen(scratch), matrix);
    }

    fn add_definite_blocks(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        scratch: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) -> bool {
        self.add_seen_blocks(at, Curvature::Definite, weights, seen(scratch), matrix)
    }

    fn fault(&self, at: &Configuration) -> Option<(usize, String)> {
        let (end, what) = self.links.fault(at)?;
        let none = vec![Mat3::IDENTITY; self.points.len()];
        Some((self.changes(end as u32, &none).first()?.0 as usize, what))
    }

    /// Nothing comes and goes; but what is seen is computed in the scratch.
    fn kept_len(&self) -> Option<usize> {
        (self.links.memory_len() > 0).then_some(0)
    }

    fn advance_kept(&self, at: &Configuration, scratch: &mut Scratch, memory: &mut [f64], _kept: &mut Kept) {
        let seen = seen(scratch);
        self.look(at, seen);
        let inner = Configuration { positions: &seen.positions, velocities: &seen.velocities, ..*at };
        self.links.advance_memory(&inner, 0.0, memory, &mut []);
    }

    fn bytes(&self) -> usize {
        let sources: usize = self.points.iter().map(|point| 16 * point.sources.capacity()).sum();
        self.links.bytes() + 4 * self.rows.capacity() + sources + size_of_val(self.points.as_slice())
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Derivatives are those of places, and forces that come back by them do the work that was done on what is seen.
    #[test]
    fn work_is_kept() {
        let axes = Mat3::IDENTITY;
        let turned = souple_math::exponential(Vec3::new(0.3, -0.2, 0.9));
        let maps = [
            Map::Affine { matrix: Mat3::IDENTITY * 10.0, offset: Vec3::new(1.0, 2.0, 3.0) },
            Map::Affine { matrix: turned, offset: Vec3::ZERO },
            Map::Cylinder { axes, origin: Vec3::new(0.1, 0.0, 0.0) },
            Map::Cylinder { axes: turned, origin: Vec3::new(0.1, 0.2, -0.3) },
        ];
        let x = Vec3::new(0.7, -0.4, 0.2);
        let force = Vec3::new(3.0, -1.0, 0.5);
        for map in maps {
            let derivative = map.derivative(x);
            for dx in [Vec3::X, Vec3::Y, Vec3::Z, Vec3::new(0.3, 0.5, -0.8)] {
                let step = 1e-6;
                let moved = (map.place(x + dx * step) - map.place(x - dx * step)) * (0.5 / step);
                // central differences: ε²/6 of a third derivative, and rounding over ε
                assert!((moved - derivative * dx).length() < 1e-9, "{map:?}");
                let (seen, back) = (force.dot(derivative * dx), (derivative.transpose() * force).dot(dx));
                assert!((seen - back).abs() < 1e-12);
            }
        }
    }

    /// What a mean of a hundred masses, and a frame that turns and drives, give back does the work that was done on what is seen:
    /// the sum of `F dx` over all rows is `F' dx'`.
    #[test]
    fn sums_keep_work() {
        let scatter = |i: usize, s: f64| {
            Vec3::new((s * i as f64).sin(), (1.7 * s * i as f64).cos(), (0.3 * i as f64).sin())
        };
        let places: Vec<Vec3> = (0..100).map(|i| scatter(i, 0.9)).collect();
        let moves: Vec<Vec3> = (0..100).map(|i| scatter(i, 2.3)).collect();
        let weights: Vec<f64> = (0..100).map(|i| 1.0 + (i % 7) as f64).collect();
        let whole: f64 = weights.iter().sum();
        let sources: Vec<(u32, f64)> =
            (0..100).zip(&weights).map(|(row, weight)| (row, weight / whole)).collect();
        let turned = souple_math::exponential(Vec3::new(0.3, -0.2, 0.9));
        // of a frame that masses carry: the place less theirs
        let carried: Vec<(u32, f64)> = vec![(0, 1.0), (1, -0.5), (2, -0.5)];
        let points = [
            (sources.clone(), Map::Affine { matrix: Mat3::IDENTITY, offset: Vec3::ZERO }),
            (sources, Map::Cylinder { axes: turned, origin: Vec3::new(1.0, 0.2, -0.3) }),
            (carried, Map::Affine { matrix: turned, offset: Vec3::new(0.1, 0.2, 0.3) }),
        ];
        let force = Vec3::new(3.0, -1.0, 0.5);
        for (sources, map) in points {
            let point = ViewPoint { sources, map };
            let derivative = point.map.derivative(point.mean(&places));
            let seen = force.dot(derivative * point.mean(&moves));
            let mut back = vec![Vec3::ZERO; 100];
            point.give_back(derivative, force, &mut back);
            let done: f64 = back.iter().zip(&moves).map(|(force, dx)| force.dot(*dx)).sum();
            assert!((seen - done).abs() < 1e-12, "{seen} {done}");
        }
    }
}
