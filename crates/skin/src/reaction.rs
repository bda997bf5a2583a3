//! What a tense skin does to the particles it dresses: its tension and the pressure of its volume as forces on rows.
//!
//! The force on a point of the surface is that of its triangles, `-σ ∂A/∂x + p n A/3` with `p = k (V0 - V)/V0`. It is shared
//! among the particles around by their kernels, with weights whose sum is one: since the surface is closed, the forces on
//! all rows add up to nothing. Sharing moves forces from the surface to the particles within, which makes a couple; where the forces
//! act, those of a rotation take it out again, so that the angular momentum stays too. They are computed on the committed grid at the end of a step, kept in State, and act in the
//! next.

use std::any::Any;

use souple_engine::{Configuration, Declaration, Energy, Force, Pair, Scratch, TangentWeights};
use souple_math::{Vec3, couple};
use souple_solve::BlockMatrix;

use crate::skin::HEAD;
use crate::target::Moment;
use crate::target::particles::{Cloud, REACH, kernel};

/// How a skin pushes back.
#[derive(Clone, Debug, PartialEq)]
pub struct Reaction {
    pub system: usize,
    /// Rows it acts on, with the radii of their particles [m].
    pub rows: Vec<(u32, f64)>,
    /// Tension `σ` [N/m].
    pub tension: f64,
    /// Pressure `k` for each relative loss of volume [Pa].
    pub pressure: f64,
}

/// Scratch of [`Reaction::act`].
#[derive(Clone, Debug, Default)]
pub struct ReactionScratch {
    cloud: Cloud,
    forces: Vec<Vec3>,
    shares: Vec<(u32, f64)>,
}

impl ReactionScratch {
    pub fn bytes(&self) -> usize {
        24 * self.forces.capacity() + 16 * self.shares.capacity() + self.cloud.bytes()
    }
}

/// A closed surface with the volume it has and should have [m³].
#[derive(Clone, Copy, Debug)]
pub struct Tense<'a> {
    pub points: &'a [Vec3],
    pub triangles: &'a [[u32; 3]],
    pub volume: f64,
    pub rest_volume: f64,
}

impl Reaction {
    /// Forces on the rows [N], three numbers each.
    ///
    /// # Errors
    /// A row is nowhere.
    pub fn act(
        &self,
        surface: Tense,
        at: &Moment,
        scratch: &mut ReactionScratch,
        out: &mut [f64],
    ) -> Result<(), String> {
        let positions = at.rows.positions(self.system);
        scratch.cloud.place(self.rows.iter().map(|(row, radius)| (positions[*row as usize], *radius)))?;
        let pressure = self.pressure * (surface.rest_volume - surface.volume) / surface.rest_volume;
        scratch.forces.clear();
        scratch.forces.resize(surface.points.len(), Vec3::ZERO);
        for corners in surface.triangles {
            let [a, b, c] = corners.map(|corner| surface.points[corner as usize]);
            let area_vector = (b - a).cross(c - a) * 0.5;
            let normal = area_vector.try_normalised().unwrap_or(Vec3::ZERO);
            let push = area_vector * (pressure / 3.0);
            // ∂A/∂a = n × (c − b)/2
            for (corner, opposite) in corners.iter().zip([c - b, a - c, b - a]) {
                scratch.forces[*corner as usize] += push - normal.cross(opposite) * (0.5 * self.tension);
            }
        }
        out.fill(0.0);
        for (point, force) in surface.points.iter().zip(&scratch.forces) {
            let total = shares(&scratch.cloud, *point, &mut scratch.shares);
            for (particle, share) in &scratch.shares {
                let part = *force * (share / total);
                let numbers = &mut out[3 * *particle as usize..][..3];
                numbers.iter_mut().zip(part.to_array()).for_each(|(sum, part)| *sum += part);
            }
        }
        Ok(())
    }
}

/// The particles that bear a point of the surface, and the sum of their shares.
fn shares(cloud: &Cloud, point: Vec3, shares: &mut Vec<(u32, f64)>) -> f64 {
    shares.clear();
    cloud.around(point, |position, radius, index| {
        let distance = (position - point).length();
        if distance < REACH * radius {
            shares.push((index, kernel(0.5 * distance / radius)));
        }
    });
    let total: f64 = shares.iter().map(|(_, share)| share).sum();
    if total > 0.0 {
        return total;
    }
    // out of reach of all: the nearest bears it
    let distance = |(position, _): &(Vec3, f64)| (*position - point).length_sq();
    let particles = cloud.particles().iter().enumerate();
    let nearest = particles.min_by(|(_, a), (_, b)| distance(a).total_cmp(&distance(b)));
    shares.clear();
    shares.extend(nearest.map(|(index, _)| (index as u32, 1.0)));
    1.0
}

/// Shares of particles, position and radius [m], in a force at a point, looked for among all of them: those of their
/// kernels, or all of it to the nearest where none reaches.
pub fn visit_shares(
    particles: impl Iterator<Item = (Vec3, f64)> + Clone,
    point: Vec3,
    visit: &mut dyn FnMut(usize, f64),
) {
    let weight = |(position, radius): (Vec3, f64)| kernel(0.5 * (position - point).length() / radius);
    let total: f64 = particles.clone().map(weight).sum();
    if total > 0.0 {
        let weights = particles.map(weight).enumerate();
        weights.filter(|(_, weight)| *weight > 0.0).for_each(|(index, weight)| visit(index, weight / total));
        return;
    }
    let distances = particles.map(|(position, _)| (position - point).length_sq()).enumerate();
    if let Some((nearest, _)) = distances.min_by(|(_, a), (_, b)| a.total_cmp(b)) {
        visit(nearest, 1.0);
    }
}

/// The forces of a skin on the rows of its particles, as they stand in State.
#[derive(Debug)]
pub struct SkinPush {
    pub name: String,
    /// Index of the skin's field.
    pub field: usize,
    pub rows: Vec<u32>,
}

impl Force for SkinPush {
    fn name(&self) -> &str {
        &self.name
    }

    fn declaration(&self) -> Declaration {
        Declaration { conservative: false, ..Declaration::LOAD }
    }

    fn energy(&self, _: &Configuration, _: &mut Scratch) -> Energy {
        Energy::default()
    }

    fn add_force(&self, at: &Configuration, _: &mut Scratch, out: &mut [Vec3]) {
        let forces = at.fields[self.field].values[HEAD..].chunks_exact(3);
        let forces = forces.map(|force| Vec3::new(force[0], force[1], force[2]));
        let rows = self.rows.iter().map(|row| *row as usize).zip(forces);
        // about a place among them: their sum is nothing, but for roundings
        let about = self.rows.first().map_or(Vec3::ZERO, |row| at.positions[*row as usize]);
        let made: Vec3 = rows.clone().map(|(row, force)| (at.positions[row] - about).cross(force)).sum();
        let (centre, rate) = couple(rows.clone().map(|(row, _)| at.positions[row]), -made);
        for (row, force) in rows {
            out[row] += force + rate.cross(at.positions[row] - centre);
        }
    }

    // what a skin does in a step is what it was at its start; that the couple depends on where the rows are by now is left out
    fn add_differential(
        &self,
        _: &Configuration,
        _: TangentWeights,
        _: &[Vec3],
        _: &mut Scratch,
        _: &mut [Vec3],
    ) {
    }

    fn visit_cliques(&self, _: &[Pair], _: &mut dyn FnMut(&[u32])) {}

    fn add_blocks(&self, _: &Configuration, _: TangentWeights, _: &mut Scratch, _: &mut BlockMatrix) {}

    fn bytes(&self) -> usize {
        4 * self.rows.capacity()
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}
