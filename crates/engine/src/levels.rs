//! Bodies of several meshes, of which at each place one is at work.
//!
//! The points of all meshes are unknowns, but only *active* ones move by themselves. All others follow: each is a
//! weighted sum of active points, and these are not the same ones from step to step. Which they are is told by the memory
//! of the body's force, so State holds it. [`crate::steppers::Staggered`] steps such bodies; no other stepper does.

use std::ops::Range;

use souple_math::Vec3;

use crate::force::Scratch;
use crate::system::Rows;

/// How a step is divided: into `2^halvings` ticks. Points of rate `i` are pushed `2^i` times, evenly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Division {
    /// Of the whole step [s].
    pub timestep: f64,
    pub halvings: u32,
    pub filter: Filter,
    pub pace: Pace,
    /// By how much elastic forces may change the velocity of a point from one of its dates to the next [m/s].
    pub velocity_jump: f64,
}

/// How often points are pushed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pace {
    /// Each as its rate says.
    Own,
    /// All in every tick.
    Together,
}

impl Division {
    /// A step whose points have their own rates, by their stiffness alone, and keep their velocities.
    pub const fn new(timestep: f64, halvings: u32) -> Self {
        Self { timestep, halvings, filter: Filter::None, pace: Pace::Own, velocity_jump: f64::INFINITY }
    }

    /// Whether elastic forces are asked before the step how fast they change velocities.
    pub fn asks_first(&self) -> bool {
        self.velocity_jump < f64::INFINITY
    }

    pub fn ticks(&self) -> u32 {
        1 << self.halvings
    }

    /// How often points of a rate are pushed in a step.
    pub fn dates(&self, rate: u32) -> u32 {
        match self.pace {
            Pace::Own => 1 << rate,
            Pace::Together => self.ticks(),
        }
    }

    /// Seconds between two pushes of a rate.
    pub fn interval(&self, rate: u32) -> f64 {
        self.timestep / f64::from(self.dates(rate))
    }
}

/// What becomes of a velocity after a push.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Filter {
    /// It stays: modified Euler.
    None,
    /// `v ← (1 + h²K/m)⁻¹ v` with the point's own stiffness `K` at rest: twice the step, but it brakes all motion.
    SemiImplicit,
}

impl Filter {
    /// How many times as long as the bound of modified Euler intervals of points may be: twice, as the source has it. Whole cubes bear 2.7 times their own limit
    /// where `λ/μ` is 3, and 1.9 times where it is 71; the bound itself is no more than 3/5 of that limit.
    pub fn lengthening(self) -> f64 {
        match self {
            Self::None => 1.0,
            Self::SemiImplicit => 2.0,
        }
    }
}

/// Which of the points that follow.
#[derive(Clone, Copy, Debug)]
pub enum Followers<'a> {
    /// Those that elastic forces read.
    Ghosts,
    /// These rows, as far as they follow.
    These(&'a [u32]),
    All,
}

/// What a value on rows is: positions follow with the shape at rest, velocities do not know it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kinematic {
    Position,
    Velocity,
}

/// Where impulses come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Push {
    /// The body's own elasticity, at this rate.
    Elastic { rate: u32 },
    /// All other forces.
    Outer,
}

/// Elastic forces that a step evaluates.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Evaluations {
    /// Once, before its first tick.
    pub first: usize,
    /// At each date of a rate, by rate.
    pub of_rate: Vec<usize>,
}

/// How many points do what.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Census {
    /// Active points of each level, from coarse to fine.
    pub active: Vec<usize>,
    /// Their rows, ascending.
    pub active_rows: Vec<u32>,
    /// Points of each level that follow because a force or another ghost reads them.
    pub ghosts: Vec<usize>,
    /// Tetrahedra, or particles, of each level, whether at work or not.
    pub cells: Vec<usize>,
    /// Of each point of the finest mesh: the level of the mesh that is at work there.
    pub level_of_point: Vec<u32>,
    /// One over the shortest time from when a point got finer to when it got coarser, or the other way about, so far [Hz].
    pub toggling: f64,
    /// Levels by which places next to each other differ at most.
    pub grading: u32,
    /// Of particles, which see those beside them whatever their level.
    pub neighbours: Option<Neighbours>,
}

/// Active neighbours of active particles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Neighbours {
    /// Of inner particles, those with 26 others of their level around them; 0 where there is none.
    pub fewest: usize,
    pub most: usize,
    /// Pairs that lie side by side in space and do not know each other, counted from both sides.
    pub unlisted: usize,
}

/// A force whose body has several meshes.
pub trait Levels: Send + Sync {
    /// Rows of the points of all meshes.
    fn rows(&self) -> Range<usize>;

    /// The shortest interval that one of its points needs to be stable at rest, whichever of them are at work [s]: by a bound, so that it is on the safe side.
    /// Where points have rates of their own, ticks are no longer.
    fn shortest_interval(&self, filter: Filter) -> f64;

    /// Chooses the active points by the rows as they stand, and gets lists ready for steps so divided. Where others are
    /// active then, all rows follow anew; velocities are corrected by what that would do to the momentum.
    fn adapt(&self, division: &Division, rows: &mut Rows, memory: &mut [f64], scratch: &mut Scratch);

    /// Rows of the active points, ascending.
    fn active<'a>(&self, scratch: &'a Scratch) -> &'a [u32];

    /// How far each of the rows has been moved so far because others came to be at work, as the last choice left it [m]; nothing of bodies
    /// that do not tell.
    fn moved<'a>(&self, _scratch: &'a Scratch) -> &'a [Vec3] {
        &[]
    }

    /// Moves active points by `x += h v`, after their velocities have faded as long.
    fn drift(&self, timestep: f64, scratch: &Scratch, rows: &mut Rows);

    /// `v += interval · a` of the active points of a rate.
    fn accelerate(
        &self,
        rate: u32,
        division: &Division,
        scratch: &Scratch,
        accelerations: &[Vec3],
        velocities: &mut [Vec3],
    );

    /// How far a follower comes at most while no point that it follows comes farther than one; infinite where that is not known.
    fn leverage(&self, _scratch: &Scratch) -> f64 {
        f64::INFINITY
    }

    /// Brings followers to where those are that they follow.
    fn follow(&self, who: Followers, kind: Kinematic, scratch: &Scratch, values: &mut [Vec3]);

    /// Gives what acts on followers to those that they follow; followers are left with nothing.
    fn give_back(&self, who: Followers, scratch: &Scratch, impulses: &mut [Vec3]);

    /// `impulses += interval · f` of the elastic forces of a rate on active points, at placed rows.
    fn add_impulses(
        &self,
        rate: u32,
        division: &Division,
        rows: &Rows,
        scratch: &mut Scratch,
        impulses: &mut [Vec3],
    );

    /// `v += impulse / m` of active points; no impulse is left.
    fn kick(
        &self,
        push: Push,
        division: &Division,
        scratch: &Scratch,
        impulses: &mut [Vec3],
        velocities: &mut [Vec3],
    );

    /// Elastic forces of samples that a step so divided evaluates, by the last lists made.
    fn evaluations(&self, division: &Division, scratch: &Scratch) -> usize;

    /// What a step so divided has to do with this memory; what a scratch knows of the same is not made anew.
    fn workload(&self, division: &Division, memory: &[f64], scratch: &Scratch) -> Evaluations;

    /// Rows of active points, each with what its criterion compares with its thresholds, at the positions of all rows; nothing of bodies
    /// that do not tell.
    fn variation(&self, _positions: &[Vec3], _memory: &[f64], _scratch: &Scratch) -> Vec<(u32, f64)> {
        Vec::new()
    }

    /// Who does what, by the memory; likewise.
    fn census(&self, memory: &[f64], scratch: &Scratch) -> Census;
}
