//! The density that particles induce: `G(x) = Σ V_i W(x − x_i, h_i)` with `V_i = (2 r_i)³`, `h_i = 2 r_i` and the cubic spline.
//!
//! Where particles of one radius stand at twice that distance it is near 1, and one half near the border of what they
//! fill. A particle that becomes eight of half its radius keeps its volume, so splitting and merging does not show.

use souple_math::Vec3;
use souple_mesh::BoundingBox;
use souple_table::{Entry, Parameter, Range, Value, counted, readable};

use super::{Between, Followed, Moment, PartEntry, PartError, PartScratch, Potential, UNKNOWN};

/// A particle that is led.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Particle {
    /// At the time 0 [m].
    pub position: Vec3,
    /// [m/s]
    pub velocity: Vec3,
    /// Half the distance to its neighbours [m].
    pub radius: f64,
    /// There from the first to before the second [s].
    pub during: [f64; 2],
}

impl Particle {
    /// Where it is at a time, and its radius [m], while it is there.
    pub fn at(&self, time: f64) -> Option<(Vec3, f64)> {
        let is_there = self.during[0] <= time && time < self.during[1];
        is_there.then(|| (self.position + self.velocity * time, self.radius))
    }
}

/// Where particles are.
#[derive(Clone, Debug, PartialEq)]
pub enum Particles {
    Led(Vec<Particle>),
    /// Rows of a system, each with its radius [m].
    Rows {
        system: usize,
        rows: Vec<(u32, f64)>,
    },
    /// Points of a body with levels, as long as they move by themselves: particles that split and merge.
    Levels {
        system: usize,
        force: usize,
        /// The body's first row.
        first: u32,
        /// Of the points of all its meshes, its own before the coarser ones [m].
        radii: Vec<f64>,
        /// Points of its own mesh, which stand for it before the first step.
        own: usize,
    },
}

/// Kernels reach so far, in radii of their particle.
pub const REACH: f64 = 4.0;

/// `V W` at the distance `q h`: 1/π of `(2 − q)³/4 − (1 − q)³`, each where positive, since `V = h³`.
#[inline(always)]
pub fn kernel(q: f64) -> f64 {
    let (far, near) = ((2.0 - q).max(0.0), (1.0 - q).max(0.0));
    std::f64::consts::FRAC_1_PI * (0.25 * far * far * far - near * near * near)
}

/// Particles in cells as large as the farthest reach, sorted by cell.
#[derive(Clone, Debug, Default)]
pub struct Cloud {
    /// Position and radius [m].
    placed: Vec<(Vec3, f64)>,
    sorted: Vec<(u64, u32)>,
    cell: f64,
    low: Vec3,
    high: Vec3,
}

/// How many cells the particles in one of them may fill, which stands for eight to each along each axis: every place in it sums
/// over all of them.
const MOST_FILLINGS: f64 = 512.0;
/// Particles in a cell at most, however small.
const MOST_IN_CELL: usize = 65_536;
/// Rows of cells that are gone through for a range, at most: of a box of more nothing is said.
const MOST_ROWS: u64 = 1 << 10;
/// Cells along each axis at most: three coordinates in a key.
const MOST_CELLS: f64 = 1_048_576.0;

impl Cloud {
    /// Sorts particles given by position and radius.
    ///
    /// # Errors
    /// One is nowhere, or has no radius; too many are at one place.
    pub fn place(&mut self, particles: impl Iterator<Item = (Vec3, f64)>) -> Result<(), String> {
        self.placed.clear();
        self.placed.extend(particles);
        let is_wrong =
            |(position, radius): &(Vec3, f64)| !(position.is_finite() && *radius > 0.0 && radius.is_finite());
        if let Some(index) = self.placed.iter().position(is_wrong) {
            let (position, radius) = self.placed[index];
            return Err(format!(
                "particle {index} is at {:?} with the radius {radius}; expected finite numbers and a radius above 0",
                position.to_array()
            ));
        }
        let Some((first, _)) = self.placed.first() else {
            return Err("there is no particle at this time; expected one or more from the first to the last"
                .to_owned());
        };
        (self.low, self.high) = self
            .placed
            .iter()
            .fold((*first, *first), |(low, high), (p, _)| (low.min_components(*p), high.max_components(*p)));
        let reach = REACH * self.placed.iter().map(|(_, radius)| *radius).fold(0.0, f64::max);
        let extent = (self.high - self.low).largest_component();
        self.cell = reach.max(extent / (MOST_CELLS - 4.0));
        self.sorted.clear();
        for (index, (position, _)) in self.placed.iter().enumerate() {
            let [x, y, z] = self.cell_of(*position);
            self.sorted.push((key(x, y, z), index as u32));
        }
        self.sorted.sort_unstable();
        self.check_crowds()
    }

    fn check_crowds(&self) -> Result<(), String> {
        // of twice the radius, as the kernel counts it
        let volume = |radius: f64| (2.0 * radius).powi(3);
        let most = MOST_FILLINGS * self.cell.powi(3);
        let filled = |crowd: &[(u64, u32)]| {
            crowd.iter().map(|(_, index)| volume(self.placed[*index as usize].1)).sum::<f64>()
        };
        let Some(crowd) = self
            .sorted
            .chunk_by(|a, b| a.0 == b.0)
            .find(|crowd| crowd.len() > MOST_IN_CELL || filled(crowd) > most)
        else {
            return Ok(());
        };
        if crowd.len() > MOST_IN_CELL {
            return Err(format!(
                "{} are in a cube of {} m, four times the largest radius; expected {MOST_IN_CELL} at most: radii more alike, or \
                 fewer particles",
                counted(crowd.len() as u64, "particle"),
                readable(self.cell),
            ));
        }
        Err(format!(
            "{} are in a cube of {} m about {:?} and would fill {:.0} such; expected {MOST_FILLINGS} at most: a smaller \
             radius, or fewer particles",
            counted(crowd.len() as u64, "particle"),
            readable(self.cell),
            self.placed[crowd[0].1 as usize].0.to_array(),
            filled(crowd) / self.cell.powi(3),
        ))
    }

    /// Coordinates of the cell of a place, from 1 for those of particles.
    fn cell_of(&self, point: Vec3) -> [u64; 3] {
        ((point - self.low) * self.cell.recip()).to_array().map(|c| (c + 1.0).clamp(0.0, MOST_CELLS) as u64)
    }

    /// Visits the particles in the cells around a place, in their sorted order.
    pub fn around(&self, point: Vec3, mut visit: impl FnMut(Vec3, f64, u32)) {
        let [x, y, z] = self.cell_of(point);
        for z in z.saturating_sub(1)..=z + 1 {
            for y in y.saturating_sub(1)..=y + 1 {
                let (from, to) = (key(x.saturating_sub(1), y, z), key(x + 1, y, z));
                let first = self.sorted.partition_point(|(cell, _)| *cell < from);
                for (cell, index) in &self.sorted[first..] {
                    if *cell > to {
                        break;
                    }
                    let (position, radius) = self.placed[*index as usize];
                    visit(position, radius, *index);
                }
            }
        }
    }

    pub fn density(&self, point: Vec3) -> f64 {
        let mut sum = 0.0;
        self.around(point, |position, radius, _| {
            let distance_sq = (position - point).length_sq();
            if distance_sq < REACH * REACH * radius * radius {
                sum += kernel(distance_sq.sqrt() / (2.0 * radius));
            }
        });
        sum
    }

    /// Numbers that the density lies between within a box: with each particle as far away as it may be, and as near.
    pub fn range(&self, within: BoundingBox) -> Between {
        let (from, to) = (self.cell_of(within.low), self.cell_of(within.high));
        let along = |axis: usize| from[axis].saturating_sub(1)..=to[axis] + 1;
        if (to[1] - from[1] + 3) * (to[2] - from[2] + 3) > MOST_ROWS {
            return [0.0, f64::INFINITY];
        }
        let (mut least, mut most) = (0.0, 0.0);
        for z in along(2) {
            for y in along(1) {
                let (first, last) = (key(*along(0).start(), y, z), key(*along(0).end(), y, z));
                let first = self.sorted.partition_point(|(cell, _)| *cell < first);
                for (_, index) in self.sorted[first..].iter().take_while(|(cell, _)| *cell <= last) {
                    let (p, radius) = self.placed[*index as usize];
                    let (below, above) = (within.low - p, p - within.high);
                    let near = below.max_components(above).max_components(Vec3::ZERO).length();
                    // from a corner: the farther end along each axis
                    let far = (-below).max_components(-above).length();
                    let at = |distance: f64| {
                        let is_reached = distance < REACH * radius;
                        if is_reached { kernel(distance / (2.0 * radius)) } else { 0.0 }
                    };
                    (least, most) = (least + at(far), most + at(near));
                }
            }
        }
        [least, most]
    }

    pub fn bytes(&self) -> usize {
        size_of::<(Vec3, f64)>() * self.placed.capacity() + 16 * self.sorted.capacity()
    }

    /// Position and radius of each [m].
    pub fn particles(&self) -> &[(Vec3, f64)] {
        &self.placed
    }

    /// A box around all that the kernels reach.
    pub fn bounds(&self) -> BoundingBox {
        BoundingBox { low: self.low, high: self.high }.grown(self.cell)
    }
}

fn key(x: u64, y: u64, z: u64) -> u64 {
    z << 42 | y << 21 | x
}

/// The density of particles as a potential.
pub struct Density {
    pub particles: Particles,
}

impl Potential for Density {
    fn new_scratch(&self) -> PartScratch {
        Box::new(Cloud::default())
    }

    fn place(&self, at: &Moment, scratch: &mut PartScratch) -> Result<(), String> {
        let Some(cloud) = scratch.downcast_mut::<Cloud>() else { return Ok(()) };
        match &self.particles {
            Particles::Led(particles) => {
                cloud.place(particles.iter().filter_map(|particle| particle.at(at.time)))
            }
            Particles::Rows { system, rows } => {
                let positions = at.rows.positions(*system);
                cloud.place(rows.iter().map(|(row, radius)| (positions[*row as usize], *radius)))
            }
            Particles::Levels { system, force, first, radii, own } => {
                let positions = at.rows.positions(*system);
                let radius = |row: u32| radii[(row - first) as usize];
                let particle = |row: u32| (positions[row as usize], radius(row));
                match at.rows.active(*system, *force) {
                    [] => cloud.place((*first..first + *own as u32).map(particle)),
                    active => cloud.place(active.iter().map(|row| particle(*row))),
                }
            }
        }
    }

    fn value(&self, point: Vec3, scratch: &PartScratch) -> f64 {
        scratch.downcast_ref::<Cloud>().map_or(f64::NAN, |cloud| cloud.density(point))
    }

    fn range(&self, within: BoundingBox, scratch: &PartScratch) -> Between {
        scratch.downcast_ref::<Cloud>().map_or(UNKNOWN, |cloud| cloud.range(within))
    }

    // a kernel is highest at its particle, and so is a sum of kernels near one of them
    fn peaks(&self, scratch: &PartScratch) -> Option<Vec<Vec3>> {
        let cloud = scratch.downcast_ref::<Cloud>()?;
        Some(cloud.placed.iter().map(|(position, _)| *position).collect())
    }

    // kernels end
    fn bounds(&self, level: f64, scratch: &PartScratch) -> Option<BoundingBox> {
        scratch.downcast_ref::<Cloud>().filter(|_| level > 0.0).map(Cloud::bounds)
    }

    fn followed(&self) -> Vec<Followed> {
        match &self.particles {
            Particles::Led(_) => Vec::new(),
            Particles::Rows { system, rows } => {
                let followed =
                    |(row, radius): &(u32, f64)| Followed { system: *system, row: *row, radius: *radius };
                rows.iter().map(followed).collect()
            }
            // points of its own mesh follow those that move by themselves, and give them what acts on them
            Particles::Levels { system, first, radii, own, .. } => (*first..)
                .zip(&radii[..*own])
                .map(|(row, radius)| Followed { system: *system, row, radius: *radius })
                .collect(),
        }
    }
}

pub(super) static PARTICLES: PartEntry = Entry {
    name: "particles",
    summary: "the density of particles: points of a body as they move, or a file",
    source: "Monaghan 1992, Smoothed particle hydrodynamics; Desbrun & Cani-Gascuel 1998",
    parameters: &[
        Parameter::text("from", "a body, or a file of points, relative to the scene file that names it"),
        Parameter::number("radius", "m", Range::POSITIVE, "half the distance between neighbours"),
        Parameter::text("group", "only those of a group of the body's points; empty: all")
            .or(Value::Text("")),
    ],
    build: |values, around| {
        let (from, radius) = (values.text("from"), values.number("radius"));
        let particles =
            around.particles(from, values.text("group"), radius).map_err(|message| PartError {
                parameter: "from",
                value: format!("\"{from}\""),
                expected: format!("a body or a file of particles: {message}"),
            })?;
        Ok(Box::new(Density { particles }))
    },
};
