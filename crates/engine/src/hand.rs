//! A hand on a body: damped springs from the points of a patch to where the hand holds them.
//!
//! A person's hand, a tool or a haptic device takes a patch and leads it about (see [`crate::Edit::Grab`]). Each point
//! has a spring of its own, so a patch held keeps its shape, and no rows are coupled that were not coupled before.

use std::any::Any;

use souple_math::{Mat3, Vec3};
use souple_solve::BlockMatrix;

use crate::force::{Configuration, Declaration, Energy, Force, Scratch, TangentWeights};
use crate::state::Pair;
use crate::tangent::add_block;

/// A point in a hand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Held {
    pub row: u32,
    /// Its share of the hand's stiffness and damping; those of a hand sum up to 1.
    pub share: f64,
    /// From the hand's place to where it wants the point [m].
    pub offset: Vec3,
}

/// How a hand holds.
#[derive(Clone, Debug, PartialEq)]
pub struct Grip {
    pub points: Vec<Held>,
    /// Where the hand is [m].
    pub place: Vec3,
    /// [N/m]
    pub stiffness: f64,
    /// [N s/m]
    pub damping: f64,
}

/// Why there is no such grip.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum GripError {
    #[error("a hand that holds no point; it must hold at least one")]
    Empty,
    #[error("a hand on row {row}; the system has {count} rows")]
    NoRow { row: u32, count: usize },
    #[error("`{field}` of a hand is {value}, but must be {expected}")]
    Unfit { field: &'static str, value: f64, expected: &'static str },
}

impl Grip {
    /// A grip on rows where they stand, evenly shared.
    pub fn on(rows: &[u32], positions: &[Vec3], stiffness: f64, damping: f64) -> Self {
        let share = 1.0 / rows.len() as f64;
        let place = rows.iter().map(|row| positions[*row as usize]).sum::<Vec3>() * share;
        let held = |row: &u32| Held { row: *row, share, offset: positions[*row as usize] - place };
        Self { points: rows.iter().map(held).collect(), place, stiffness, damping }
    }

    /// # Errors
    /// It holds nothing, or what is not there, or a number does not fit.
    pub fn check(&self, row_count: usize) -> Result<(), GripError> {
        if self.points.is_empty() {
            return Err(GripError::Empty);
        }
        let unfit = |field, value, expected| Err(GripError::Unfit { field, value, expected });
        let not_negative = "a finite number of at least 0";
        for Held { row, share, offset } in &self.points {
            if *row as usize >= row_count {
                return Err(GripError::NoRow { row: *row, count: row_count });
            }
            if !(share.is_finite() && *share >= 0.0) {
                return unfit("share", *share, not_negative);
            }
            check_place("offset", *offset)?;
        }
        check_place("place", self.place)?;
        for (field, value) in [("stiffness", self.stiffness), ("damping", self.damping)] {
            if !(value.is_finite() && value >= 0.0) {
                return unfit(field, value, not_negative);
            }
        }
        Ok(())
    }
}

/// Accepts places at finite coordinates.
pub(crate) fn check_place(field: &'static str, place: Vec3) -> Result<(), GripError> {
    match place.to_array().into_iter().find(|value| !value.is_finite()) {
        Some(value) => Err(GripError::Unfit { field, value, expected: "finite" }),
        None => Ok(()),
    }
}

/// A hand of a scene as it stands: where its device and its tool are, and what it feels (see [`Force::in_hand`]).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct InHand {
    /// Of the device from where it started [m].
    pub device: Vec3,
    /// Of the tool from where it started [m].
    pub tool: Vec3,
    /// [m/s]
    pub tool_velocity: Vec3,
    /// Of points that the tool holds, on it; zero of one that holds none [N].
    pub felt: Vec3,
    /// Of the device on the person [N].
    pub force: Vec3,
    /// What the person has put into the device, less what came back [J].
    pub energy: f64,
    /// The greatest change of the force from one tick of the device to the next, so far [N].
    pub jump: f64,
    /// How old what the force says of the body was when the person ceased to feel it, at most so far [s].
    pub age: f64,
}

/// The name of the force of a hand.
pub fn hand_name(hand: u32) -> String {
    format!("hand[{hand}]")
}

/// Whether a force is that of a hand, by its name.
pub fn is_hand_name(name: &str) -> bool {
    name.starts_with("hand[")
}

/// `f_i = share_i (k (place + offset_i - x_i) - c ẋ_i)` on each point held.
#[derive(Clone, Debug)]
pub struct Hand {
    name: String,
    grip: Grip,
}

impl Hand {
    pub fn new(hand: u32, grip: Grip) -> Self {
        Self { name: hand_name(hand), grip }
    }

    pub fn grip(&self) -> &Grip {
        &self.grip
    }

    /// The middle of the points held [m].
    pub fn middle(&self, positions: &[Vec3]) -> Vec3 {
        self.grip.points.iter().map(|held| positions[held.row as usize] * held.share).sum()
    }

    /// The pull on the body [N].
    pub fn pull(&self, positions: &[Vec3], velocities: &[Vec3]) -> Vec3 {
        self.grip.points.iter().map(|held| self.force_on(held, positions, velocities)).sum()
    }

    fn force_on(&self, held: &Held, positions: &[Vec3], velocities: &[Vec3]) -> Vec3 {
        let row = held.row as usize;
        let stretch = self.grip.place + held.offset - positions[row];
        (stretch * self.grip.stiffness - velocities[row] * self.grip.damping) * held.share
    }

    fn factor(&self, weights: TangentWeights) -> f64 {
        -(weights.position * self.grip.stiffness + weights.velocity * self.grip.damping)
    }
}

impl Force for Hand {
    fn name(&self) -> &str {
        &self.name
    }

    fn declaration(&self) -> Declaration {
        let damped = self.grip.damping > 0.0;
        Declaration { conservative: !damped, velocity_terms: damped, ..Declaration::LOAD }
    }

    fn memory_len(&self) -> usize {
        1
    }

    // heat; where the hand is led to is not in the tangent either
    fn tangent_reads_memory(&self) -> bool {
        false
    }

    // E = Σ share k/2 |place + offset - x|²
    fn energy(&self, at: &Configuration, _scratch: &mut Scratch) -> Energy {
        let stretch_sq = |held: &Held| {
            held.share * (self.grip.place + held.offset - at.positions[held.row as usize]).length_sq()
        };
        let sum: f64 = self.grip.points.iter().map(stretch_sq).sum();
        Energy { stored: 0.5 * self.grip.stiffness * sum, dissipated: at.memory[0] }
    }

    fn add_force(&self, at: &Configuration, _scratch: &mut Scratch, out: &mut [Vec3]) {
        for held in &self.grip.points {
            out[held.row as usize] += self.force_on(held, at.positions, at.velocities);
        }
    }

    fn add_differential(
        &self,
        _at: &Configuration,
        weights: TangentWeights,
        delta: &[Vec3],
        _scratch: &mut Scratch,
        out: &mut [Vec3],
    ) {
        for held in &self.grip.points {
            out[held.row as usize] += delta[held.row as usize] * (held.share * self.factor(weights));
        }
    }

    fn visit_cliques(&self, _pairs: &[Pair], visit: &mut dyn FnMut(&[u32])) {
        self.grip.points.iter().for_each(|held| visit(&[held.row]));
    }

    fn add_blocks(
        &self,
        _at: &Configuration,
        weights: TangentWeights,
        _: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) {
        for held in &self.grip.points {
            let row = held.row as usize;
            add_block(matrix, row, row, &(Mat3::IDENTITY * (held.share * self.factor(weights))));
        }
    }

    // heat: ∫ c Σ share |ẋ|² dt
    fn advance_memory(&self, at: &Configuration, timestep: f64, memory: &mut [f64], _pairs: &mut [Pair]) {
        let speed_sq = |held: &Held| held.share * at.velocities[held.row as usize].length_sq();
        memory[0] += timestep * self.grip.damping * self.grip.points.iter().map(speed_sq).sum::<f64>();
    }

    fn lead(&mut self, place: Vec3) {
        self.grip.place = place;
    }

    fn bytes(&self) -> usize {
        size_of::<Held>() * self.grip.points.capacity()
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}
