//! Springs between systems that step at different rates.
//!
//! The spring runs in the faster system, against the slower point's position extrapolated from the last
//! period, `x + v (t - t₀)`. The opposite impulse is summed over the period and acts as a constant force on
//! the slower point in the next. Momentum is exchanged exactly, one period late; the delay acts like a
//! negative damping of about `k H / 2` [N s/m] that the spring's own damping must outweigh
//! ([`CouplingSpring::forecast`]); the energy it makes is kept account of in State and reported
//! ([`CouplingSpring::energy_made`]).

use souple_math::{Mat3, Vec3};
use souple_solve::BlockMatrix;

use crate::State;
use crate::force::{Configuration, Declaration, Energy, Force, Scratch, TangentWeights};
use crate::state::Pair;
use crate::tangent::add_block;

/// Numbers a coupling keeps among the driven parameters of State.
pub const DRIVEN_LEN: usize = 11;
const SLOW_POSITION: usize = 0;
const SLOW_VELOCITY: usize = 3;
const PERIOD_START: usize = 6;
/// The force on the slow point in this period: the mean reaction of the last.
const SLOW_FORCE: usize = 7;
/// Work done on both ends so far, with what damping took, less what the spring held at first [J].
const WORK: usize = 10;

/// What the fast end remembers within a period: impulse on the fast point, work on it, energy dissipated.
const MEMORY_LEN: usize = 5;

/// A damped spring from a row of the faster system to a row of the slower one.
#[derive(Clone, Debug)]
pub struct CouplingSpring {
    pub name: String,
    pub fast_system: usize,
    pub fast_row: u32,
    pub slow_system: usize,
    pub slow_row: u32,
    /// [N/m]
    pub stiffness: f64,
    /// [N s/m]
    pub damping: f64,
    /// Where its [`DRIVEN_LEN`] numbers start in State's driven parameters.
    pub driven: usize,
}

impl CouplingSpring {
    /// The force in the fast system.
    pub fn fast_end(&self) -> Box<dyn Force> {
        Box::new(FastEnd { name: self.fast_name(), spring: self.clone() })
    }

    pub(crate) fn fast_name(&self) -> String {
        format!("{}.fast", self.name)
    }

    /// Where the slow point stood when the period started.
    pub(crate) fn published_position(&self, driven: &[f64]) -> Vec3 {
        vector(&driven[self.driven..], SLOW_POSITION)
    }

    /// The force in the slow system.
    pub fn slow_end(&self) -> Box<dyn Force> {
        let name = format!("{}.slow", self.name);
        Box::new(SlowEnd { name, row: self.slow_row, driven: self.driven + SLOW_FORCE })
    }

    /// What to expect of this spring at a period of `period` seconds, if it is doubtful.
    pub fn forecast(&self, period: f64) -> Option<String> {
        let needed = 0.5 * self.stiffness * period;
        (self.damping < needed).then(|| {
            format!(
                "coupling `{}` may make energy: its damping {} N s/m is below k H/2 = {needed} N s/m; raise it, lower the stiffness, or shorten the period of {period} s",
                self.name, self.damping
            )
        })
    }

    /// Energy the exchange has made so far [J]; negative: lost. The work on both ends, what damping took and
    /// what the spring holds sum to zero in a spring without delay.
    pub fn energy_made(&self, state: &State, fast_position: Vec3, time: f64) -> f64 {
        state.driven[self.driven + WORK] + self.stored(fast_position, time, &state.driven)
    }

    fn stored(&self, fast_position: Vec3, time: f64, driven: &[f64]) -> f64 {
        0.5 * self.stiffness * (self.slow_position(time, driven) - fast_position).length_sq()
    }

    /// Publishes where the slow point stands as a period starts; the account of energy opens with what the
    /// spring holds as the world starts.
    pub(crate) fn start_period(
        &self,
        state: &mut State,
        time: f64,
        fast: Vec3,
        position: Vec3,
        velocity: Vec3,
    ) {
        let opens = state.period == 0;
        let driven = &mut state.driven[self.driven..self.driven + DRIVEN_LEN];
        if opens {
            driven[WORK] = -0.5 * self.stiffness * (position - fast).length_sq();
        }
        driven[SLOW_POSITION..SLOW_POSITION + 3].copy_from_slice(&position.to_array());
        driven[SLOW_VELOCITY..SLOW_VELOCITY + 3].copy_from_slice(&velocity.to_array());
        driven[PERIOD_START] = time;
    }

    /// Ends a period: the opposite of its mean force acts on the slow point in the next, the work of both
    /// ends is booked, the fast end's memory starts anew.
    pub(crate) fn end_period(
        &self,
        driven: &mut [f64],
        fast_memory: &mut [f64],
        period: f64,
        slow_moved: Vec3,
    ) {
        let driven = &mut driven[self.driven..self.driven + DRIVEN_LEN];
        let acted = vector(driven, SLOW_FORCE);
        driven[WORK] += fast_memory[3] + fast_memory[4] + acted.dot(slow_moved);
        let reaction = vector(fast_memory, 0) * (-1.0 / period);
        driven[SLOW_FORCE..SLOW_FORCE + 3].copy_from_slice(&reaction.to_array());
        fast_memory.fill(0.0);
    }

    /// The slow point as the fast system sees it, extrapolated from the period's start.
    fn slow_position(&self, time: f64, driven: &[f64]) -> Vec3 {
        let driven = &driven[self.driven..self.driven + DRIVEN_LEN];
        vector(driven, SLOW_POSITION) + vector(driven, SLOW_VELOCITY) * (time - driven[PERIOD_START])
    }

    fn slow_velocity(&self, driven: &[f64]) -> Vec3 {
        vector(&driven[self.driven..], SLOW_VELOCITY)
    }

    /// The force on the fast point, and its damping part [N].
    fn force_on_fast(&self, at: &Configuration) -> (Vec3, Vec3) {
        let row = self.fast_row as usize;
        let damping = (self.slow_velocity(at.driven) - at.velocities[row]) * self.damping;
        ((self.slow_position(at.time, at.driven) - at.positions[row]) * self.stiffness + damping, damping)
    }
}

fn vector(numbers: &[f64], at: usize) -> Vec3 {
    Vec3::new(numbers[at], numbers[at + 1], numbers[at + 2])
}

struct FastEnd {
    name: String,
    spring: CouplingSpring,
}

impl FastEnd {
    fn stiffness(&self, weights: TangentWeights) -> f64 {
        -(weights.position * self.spring.stiffness + weights.velocity * self.spring.damping)
    }
}

impl Force for FastEnd {
    fn name(&self) -> &str {
        &self.name
    }

    fn declaration(&self) -> Declaration {
        Declaration { conservative: false, velocity_terms: true, ..Declaration::LOAD }
    }

    fn memory_len(&self) -> usize {
        MEMORY_LEN
    }

    fn energy(&self, at: &Configuration, _scratch: &mut Scratch) -> Energy {
        let position = at.positions[self.spring.fast_row as usize];
        Energy { stored: self.spring.stored(position, at.time, at.driven), dissipated: 0.0 }
    }

    fn add_force(&self, at: &Configuration, _scratch: &mut Scratch, out: &mut [Vec3]) {
        out[self.spring.fast_row as usize] += self.spring.force_on_fast(at).0;
    }

    fn advance_memory(&self, at: &Configuration, timestep: f64, memory: &mut [f64], _pairs: &mut [Pair]) {
        let (force, damping) = self.spring.force_on_fast(at);
        let velocity = at.velocities[self.spring.fast_row as usize];
        let impulse = vector(memory, 0) + force * timestep;
        memory[..3].copy_from_slice(&impulse.to_array());
        memory[3] += force.dot(velocity) * timestep;
        memory[4] += damping.dot(self.spring.slow_velocity(at.driven) - velocity) * timestep;
    }

    fn add_differential(
        &self,
        _at: &Configuration,
        weights: TangentWeights,
        delta: &[Vec3],
        _scratch: &mut Scratch,
        out: &mut [Vec3],
    ) {
        let row = self.spring.fast_row as usize;
        out[row] += delta[row] * self.stiffness(weights);
    }

    fn visit_cliques(&self, _pairs: &[Pair], visit: &mut dyn FnMut(&[u32])) {
        visit(&[self.spring.fast_row]);
    }

    fn add_blocks(
        &self,
        _at: &Configuration,
        weights: TangentWeights,
        _: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) {
        let row = self.spring.fast_row as usize;
        add_block(matrix, row, row, &(Mat3::IDENTITY * self.stiffness(weights)));
    }

    fn as_any(&self) -> &dyn std::any::Any {
        self
    }
}

/// A constant force over a period, read from State.
struct SlowEnd {
    name: String,
    row: u32,
    driven: usize,
}

impl Force for SlowEnd {
    fn name(&self) -> &str {
        &self.name
    }

    fn declaration(&self) -> Declaration {
        Declaration { conservative: false, ..Declaration::LOAD }
    }

    fn energy(&self, _at: &Configuration, _scratch: &mut Scratch) -> Energy {
        Energy::default()
    }

    fn add_force(&self, at: &Configuration, _scratch: &mut Scratch, out: &mut [Vec3]) {
        let force = &at.driven[self.driven..self.driven + 3];
        out[self.row as usize] += Vec3::new(force[0], force[1], force[2]);
    }

    fn add_differential(
        &self,
        _: &Configuration,
        _: TangentWeights,
        _: &[Vec3],
        _: &mut Scratch,
        _: &mut [Vec3],
    ) {
    }

    fn visit_cliques(&self, _pairs: &[Pair], visit: &mut dyn FnMut(&[u32])) {
        visit(&[self.row]);
    }

    fn add_blocks(&self, _: &Configuration, _: TangentWeights, _: &mut Scratch, _: &mut BlockMatrix) {}

    fn as_any(&self) -> &dyn std::any::Any {
        self
    }
}
