//! Points that a tool holds: they go where it says, whatever acts on them, and it feels what their body does to them.
//!
//! Where a period begins, a [`Holding`] looks at the surface and tells each of its points how far it is to go until the next
//! look, and how much of the area around it is in touch. That is memory of the force, so State holds it. What is told goes to
//! those points that move by themselves: the points of the surface, or the active points that these follow in a body with
//! levels, each of which goes by the weighted mean of what its followers are told (Debunne 2000, 6 §2.2). A point that is held computes the
//! force of its body and does not integrate it; what the tool feels is made of those forces.

use std::ops::Range;

use souple_math::{Mat3, Vec3};

use crate::force::{Configuration, Force, Scratch};
use crate::levels::{Followers, Kinematic, Levels};
use crate::state::SystemState;
use crate::system::{Rows, System};

/// What a point of the surface is told until the next look.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Told {
    pub row: u32,
    /// How far it is to go [m].
    pub displacement: Vec3,
    /// Around it, in touch [m²].
    pub contact_area: f64,
    /// Around it [m²].
    pub area: f64,
    pub is_held: bool,
}

/// What a tool feels of a point that it holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Felt {
    /// Its force times the part of the area around it that is in touch: the traction, integrated over the contact.
    Area,
    /// Its force.
    Sum,
}

/// A force that moves points by itself.
pub trait Holding: Send + Sync {
    /// Rows of the points of its surface, ascending.
    fn rows(&self) -> &[u32];

    /// Looks where a period begins which points it holds until the next one does.
    fn look(&self, at: &Configuration, scratch: &mut Scratch, memory: &mut [f64]);

    /// Takes up in `memory` what a look one period ago told, in a memory of that time.
    fn take_look(&self, looked: &[f64], memory: &mut [f64]);

    /// What each point of the surface has been told.
    fn visit_told(&self, memory: &[f64], visit: &mut dyn FnMut(&Told));

    /// Which part of the displacements is made per second in a step that is next [1/s].
    fn pace(&self, timestep: f64, memory: &[f64]) -> f64;

    fn felt(&self) -> Felt;

    /// Takes what is felt now, and what the points bear in all, on the tool [N].
    fn feel(&self, felt: Vec3, borne: Vec3, memory: &mut [f64]);

    /// Takes the forces of the body on points that are held, by row [N].
    fn note_forces(&self, forces: &[Vec3], memory: &mut [f64]);

    /// The greatest change of what is felt from one step to the next since the last look, over the larger of the two.
    fn jump(&self, memory: &[f64]) -> f64;
}

/// A point that is held.
#[derive(Clone, Copy, Debug)]
struct HeldPoint {
    row: u32,
    /// Until the next look [m].
    displacement: Vec3,
    /// Part of its force that is felt.
    share: f64,
    /// Onto the directions in which no pin bears that force.
    free: Mat3,
    /// Where it is, as long as the step lasts [m].
    place: Vec3,
    /// [m/s]
    velocity: Vec3,
    /// Of its body on it [N].
    force: Vec3,
}

/// Points whose followers' held weight is less than this are not held: they hardly carry the contact.
const LEAST_WEIGHT: f64 = 0.05;

/// The points that are held during a step, by all that hold some. Scratch: made anew in every step from the memories.
#[derive(Debug, Default)]
pub struct HeldPoints {
    points: Vec<HeldPoint>,
    /// Of each force that holds points: its number, and its points.
    holders: Vec<(usize, Range<usize>)>,
    /// By rate and point, where the forces of a body come at different dates [N].
    by_rate: Vec<Vec<Vec3>>,
    moves: Vec<Vec3>,
    /// The longest displacement that is told [m].
    longest: f64,
    weights: Vec<Vec3>,
    is_held: Vec<bool>,
    /// Rows that pins hold in part, ascending, with the projector onto the directions left free.
    partly_free: Vec<(u32, Mat3)>,
}

/// The body with levels that has these rows.
fn levels_of<'a>(system: &'a System, rows: &[u32]) -> Option<(usize, &'a dyn Levels)> {
    let first = *rows.first()? as usize;
    let forces = system.forces.iter().map(AsRef::as_ref).enumerate();
    let mut bodies =
        forces.filter_map(|(index, force): (usize, &'a dyn Force)| Some((index, force.levels()?)));
    bodies.find(|(_, levels)| levels.rows().contains(&first))
}

impl System {
    /// Whether any force moves points by itself.
    pub fn holds(&self) -> bool {
        self.forces.iter().any(|force| force.holding().is_some())
    }

    /// Whether all points that forces may hold are of bodies with levels.
    pub fn holds_levels_alone(&self) -> bool {
        let mut holdings = self.forces.iter().filter_map(|force| force.holding());
        holdings.all(|holding| levels_of(self, holding.rows()).is_some())
    }
}

impl HeldPoints {
    pub fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// The points that are held from now on, at the placed rows.
    pub fn gather(&mut self, system: &System, state: &SystemState, scratches: &[Scratch], rows: &Rows) {
        self.points.clear();
        self.holders.clear();
        self.is_held.clear();
        self.is_held.resize(rows.positions.len(), false);
        self.leave_pins(system);
        for (index, force) in system.forces.iter().enumerate() {
            let Some(holding) = force.holding() else { continue };
            let first = self.points.len();
            let memory = &state.memory[system.memory_range(index)];
            self.spread(holding, memory, rows.positions.len());
            match levels_of(system, holding.rows()) {
                Some((body, levels)) => {
                    let scratch = &scratches[body];
                    for values in [&mut self.moves, &mut self.weights] {
                        levels.give_back(Followers::These(holding.rows()), scratch, values);
                    }
                    levels.active(scratch).iter().for_each(|row| self.hold(*row, holding.felt(), rows));
                }
                None => holding.rows().iter().for_each(|row| self.hold(*row, holding.felt(), rows)),
            }
            self.holders.push((index, first..self.points.len()));
        }
    }

    /// What pins hold goes where these say, and they bear its force: such a point is held by nobody else, or felt along free directions alone.
    fn leave_pins(&mut self, system: &System) {
        self.partly_free.clear();
        for constraint in &system.constraints {
            let Some(row) = system.kinematics.point_block_row(constraint.block) else { continue };
            if constraint.free == Mat3::ZERO {
                self.is_held[row as usize] = true;
            } else {
                self.partly_free.push((row, constraint.free));
            }
        }
        self.partly_free.sort_unstable_by_key(|(row, _)| *row);
    }

    /// What is told, on the rows of the surface: displacements; areas in touch and around, and who is held.
    fn spread(&mut self, holding: &dyn Holding, memory: &[f64], row_count: usize) {
        for values in [&mut self.moves, &mut self.weights] {
            values.clear();
            values.resize(row_count, Vec3::ZERO);
        }
        self.longest = 0.0;
        holding.visit_told(memory, &mut |told| {
            let (row, held) = (told.row as usize, f64::from(u8::from(told.is_held)));
            self.moves[row] = told.displacement * held;
            self.longest = self.longest.max(self.moves[row].length());
            self.weights[row] = Vec3::new(told.contact_area * held, told.area, held);
        });
    }

    /// Holds a point that is told to move, by the mean of what comes to it; of two who would hold it, the first does.
    fn hold(&mut self, row: u32, felt: Felt, rows: &Rows) {
        let at = row as usize;
        let Vec3 { x: touching, y: around, z: weight } = self.weights[at];
        if weight < LEAST_WEIGHT || std::mem::replace(&mut self.is_held[at], true) {
            return;
        }
        let share = match felt {
            // weights of points that extrapolate may be negative
            Felt::Area if around > 0.0 => (touching / around).clamp(0.0, 1.0),
            Felt::Area => 0.0,
            Felt::Sum => 1.0,
        };
        // weights of followers that extrapolate cancel, displacements need not: no mean is longer than the longest
        let mean = self.moves[at] / weight;
        let pinned = self.partly_free.binary_search_by_key(&row, |(row, _)| *row);
        let free = pinned.map_or(Mat3::IDENTITY, |at| self.partly_free[at].1);
        let shortened = (self.longest / mean.length()).min(1.0);
        self.points.push(HeldPoint {
            row,
            displacement: if shortened < 1.0 { mean * shortened } else { mean },
            share,
            free,
            place: rows.positions[at],
            velocity: Vec3::ZERO,
            force: Vec3::ZERO,
        });
    }

    /// Takes the forces of bodies on the points that are held, which are all there.
    pub fn note(&mut self, forces: &[Vec3]) {
        for point in &mut self.points {
            point.force = forces[point.row as usize];
        }
    }

    /// Forgets the forces of all rates; there are so many.
    pub fn begin_rates(&mut self, rates: usize) {
        self.by_rate.resize_with(rates, Vec::new);
        for forces in &mut self.by_rate {
            forces.clear();
            forces.resize(self.points.len(), Vec3::ZERO);
        }
    }

    /// Takes the impulses of a rate on the points of a body, which act for `interval` [s].
    pub fn note_rate(&mut self, rate: u32, body: Range<usize>, interval: f64, impulses: &[Vec3]) {
        if self.points.is_empty() {
            return;
        }
        let forces = &mut self.by_rate[rate as usize];
        for (force, point) in forces.iter_mut().zip(&self.points) {
            if body.contains(&(point.row as usize)) {
                *force = impulses[point.row as usize] / interval;
            }
        }
    }

    /// The forces of all rates, as they were last noted.
    pub fn sum_rates(&mut self) {
        for (number, point) in self.points.iter_mut().enumerate() {
            point.force = self.by_rate.iter().map(|forces| forces[number]).sum();
        }
    }

    /// Lets all who hold points feel them, and says how fast these go in a step that is next.
    pub fn feel(&mut self, system: &System, state: &mut SystemState, timestep: f64) {
        for (index, range) in &self.holders {
            let Some(holding) = system.forces[*index].holding() else { continue };
            let points = &mut self.points[range.clone()];
            let memory = &mut state.memory[system.memory_range(*index)];
            let borne = points.iter().map(|point| (point.free * point.force, point.share));
            let felt = borne.clone().map(|(force, share)| force * share).sum();
            holding.feel(felt, borne.map(|(force, _)| force).sum(), memory);
            let pace = holding.pace(timestep, memory);
            points.iter_mut().for_each(|point| point.velocity = point.displacement * pace);
        }
    }

    /// Gives the points that are held the velocity that they are led with, and nothing that would change it.
    pub fn take_over(&self, forces: &mut [Vec3], velocities: &mut [Vec3]) {
        for point in &self.points {
            forces[point.row as usize] = Vec3::ZERO;
            velocities[point.row as usize] = point.velocity;
        }
    }

    /// Brings the points that are held to where they are after `timestep`, whatever has become of them.
    pub fn lead(&mut self, timestep: f64, rows: &mut Rows) {
        for point in &mut self.points {
            point.place += point.velocity * timestep;
            rows.positions[point.row as usize] = point.place;
            rows.velocities[point.row as usize] = point.velocity;
        }
    }

    /// Tells those who hold points which forces these bore last: also of points of the surface that follow them.
    pub fn note_forces(&mut self, system: &System, state: &mut SystemState, scratches: &[Scratch]) {
        for (index, range) in &self.holders {
            let Some(holding) = system.forces[*index].holding() else { continue };
            self.moves.fill(Vec3::ZERO);
            for point in &self.points[range.clone()] {
                self.moves[point.row as usize] = point.force;
            }
            if let Some((body, levels)) = levels_of(system, holding.rows()) {
                let these = Followers::These(holding.rows());
                levels.follow(these, Kinematic::Velocity, &scratches[body], &mut self.moves);
            }
            holding.note_forces(&self.moves, &mut state.memory[system.memory_range(*index)]);
        }
    }

    pub fn bytes(&self) -> usize {
        size_of::<HeldPoint>() * self.points.capacity()
            + size_of::<Vec3>()
                * (self.moves.capacity()
                    + self.weights.capacity()
                    + self.by_rate.iter().map(Vec::capacity).sum::<usize>())
            + self.is_held.capacity()
            + size_of::<(u32, Mat3)>() * self.partly_free.capacity()
    }
}
