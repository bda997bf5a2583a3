//! Steps of their own for every point: bodies of several meshes, of which a few points are pushed often, most seldom.

use std::ops::Range;
use std::time::Instant;

use souple_math::Vec3;
use souple_table::{Parameter, Range as Allowed, Value};

use crate::holding::HeldPoints;
use crate::kept::Summed;
use crate::levels::{Division, Filter, Followers, Kinematic, Levels, Pace, Push};
use crate::state::SystemState;
use crate::system::{Rows, Surroundings, System, SystemWorkspace};

use super::{Stability, Step, StepError, StepReport, Stepper, StepperEntry};

/// A step is `2^halvings` ticks. At each tick the points of the highest rate are pushed, and of one other rate at most, in
/// turn: no tick has much more to do than another. All points move at every tick with the velocity they have, so that
/// those pushed seldom are seen where they are. Forces from outside act at every tick, but those that couple no rows:
/// nothing can make them stiff, they are evaluated once a step and act at each point's own dates. What is out of
/// reach of all it could push (see [`crate::Force::visit_reach`]) waits until it is not.
#[derive(Debug)]
pub struct Staggered {
    pub halvings: u32,
    pub schedule: Schedule,
    pub filter: Filter,
    /// [m/s]; infinite where points look at their stiffness alone.
    pub velocity_jump: f64,
}

/// Which rates are due together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Schedule {
    /// The highest, and at most one other.
    Staggered,
    /// All whose interval begins.
    Plain,
    /// All, in every tick.
    Together,
}

pub(super) const ENTRY: StepperEntry = StepperEntry {
    name: "staggered",
    summary: "of bodies with levels: modified Euler, each point with a power-of-two part of the step as its own",
    source: "Debunne 2000, 5 §4.3",
    parameters: &[
        Parameter::integer(
            "halvings",
            Allowed::closed(0.0, 12.0),
            "the shortest interval is the step halved so many times",
        )
        .or(Value::Integer(5)),
        Parameter::choice(
            "schedule",
            &["staggered", "plain", "together"],
            "the fastest points and at most one other rate at a time, all whose interval begins, or every point in every tick",
        )
        .or(Value::Text("staggered")),
        Parameter::boolean(
            "semi_implicit",
            "divide each velocity by 1 + h²K/m of its point: twice the step, all motion braked; one-way coupling only",
        )
        .or(Value::Boolean(false)),
        Parameter::number(
            "velocity_jump",
            "m/s",
            Allowed::NOT_NEGATIVE,
            "points whose velocity elastic forces would change by more in an interval take a shorter one, down to the shortest; 0: they look at their stiffness at rest alone",
        )
        .or(Value::Number(0.0)),
    ],
    build: |values| {
        Box::new(Staggered {
            halvings: values.integer("halvings") as u32,
            schedule: match values.text("schedule") {
                "plain" => Schedule::Plain,
                "together" => Schedule::Together,
                _ => Schedule::Staggered,
            },
            velocity_jump: match values.number("velocity_jump") {
                0.0 => f64::INFINITY,
                jump => jump,
            },
            filter: if values.boolean("semi_implicit") { Filter::SemiImplicit } else { Filter::None },
        })
    },
};

impl Staggered {
    fn division(&self, timestep: f64) -> Division {
        let pace = if self.schedule == Schedule::Together { Pace::Together } else { Pace::Own };
        let Self { halvings, filter, velocity_jump, .. } = *self;
        Division { timestep, halvings, filter, pace, velocity_jump }
    }
}

impl Schedule {
    /// The rates that are due at a tick, from high to low.
    pub fn due(self, tick: u32, halvings: u32) -> impl Iterator<Item = u32> {
        // rate i comes every 2^(halvings - i) ticks; staggered, it comes in the middle of its interval
        let slowest = match self {
            Self::Plain => halvings.saturating_sub(tick.trailing_zeros()),
            Self::Staggered => halvings,
            Self::Together => 0,
        };
        let other = match self {
            Self::Staggered if tick > 0 => Some(halvings - 1 - tick.trailing_zeros()),
            _ => None,
        };
        (slowest..=halvings).rev().chain(other)
    }
}

/// What a force has to do with the ticks of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Part {
    /// It is the elasticity of a body with levels.
    Inside,
    /// It comes from outside and couples no rows: it is the same throughout.
    Steady,
    /// It comes from outside and couples rows: it may be stiff, and pushes in every tick.
    Coupling,
    /// It would, but is out of reach of all of them.
    OutOfReach,
}

/// Scratch of this stepper.
#[derive(Debug, Default)]
pub struct StaggeredBuffers {
    /// Rows that forces from outside couple.
    watched: Vec<u32>,
    is_watched: Vec<bool>,
    /// By force.
    parts: Vec<Part>,
    /// Whether there are rows that forces couple, but do not reach yet: these are not watched.
    leaves_out: bool,
    /// Where rows were when it was looked who reaches what.
    from: Vec<Vec3>,
    /// How far points that move by themselves may come from there until it is looked again [m].
    slack: f64,
    /// Rows of no body with levels.
    others: Vec<Range<usize>>,
    /// Accelerations that stay the same throughout the step.
    steady: Vec<Vec3>,
}

fn bodies(system: &System) -> impl Iterator<Item = (usize, &dyn Levels)> {
    system.forces.iter().enumerate().filter_map(|(index, force)| Some((index, force.levels()?)))
}

impl StaggeredBuffers {
    /// As the rows and pairs are now, where rows come no farther than `slack` [m].
    fn prepare(&mut self, stage: &Reading, slack: f64) {
        let Reading { system, around, rows, state } = stage;
        self.is_watched.clear();
        self.is_watched.resize(rows.positions.len(), false);
        self.parts.clear();
        self.leaves_out = false;
        for (index, force) in system.forces.iter().enumerate() {
            let at = system.view(index, rows, state, around);
            let (mut coupled, mut reached) = (0, 0);
            if force.levels().is_none() {
                force.visit_cliques(at.pairs, &mut |rows| coupled += rows.len());
                force.visit_reach(&at, slack, &mut |row| {
                    reached += 1;
                    self.is_watched[row as usize] = true;
                });
            }
            self.leaves_out |= reached < coupled;
            self.parts.push(match (force.levels(), coupled, reached) {
                (Some(_), ..) => Part::Inside,
                (None, _, 1..) => Part::Coupling,
                (None, 1.., 0) => Part::OutOfReach,
                // what comes and goes within a step is looked at in every tick, also where nothing touches just now
                (None, 0, 0) if force.declaration().changing_pattern => Part::OutOfReach,
                (None, 0, 0) => Part::Steady,
            });
        }
        self.watched.clear();
        self.watched.extend((0..self.is_watched.len() as u32).filter(|row| self.is_watched[*row as usize]));
    }

    fn list_others(&mut self, system: &System, row_count: usize) {
        self.others.clear();
        let mut next = 0;
        // bodies have their rows one after the other
        for (_, levels) in bodies(system) {
            let rows = levels.rows();
            self.others.push(next..rows.start);
            next = rows.end;
        }
        self.others.push(next..row_count);
    }
}

/// What forces are looked at with.
struct Reading<'a> {
    system: &'a System,
    around: &'a Surroundings<'a>,
    rows: &'a Rows,
    state: &'a SystemState,
}

/// What a step is made with.
struct Stage<'a, 'b> {
    step: &'a Step<'b>,
    division: Division,
    next: &'a mut SystemState,
    ws: &'a mut SystemWorkspace,
    buffers: &'a mut StaggeredBuffers,
    held: &'a mut HeldPoints,
}

impl Stage<'_, '_> {
    /// Sums the forces from outside that have this part; whether there is any.
    fn sum_outside(&mut self, part: Part) -> bool {
        let (Step { system, around, .. }, ws) = (*self.step, &mut *self.ws);
        let mut is_any = false;
        for (index, force) in system.forces.iter().enumerate() {
            if self.buffers.parts[index] == part {
                let at = system.view(index, &ws.rows, self.next, around);
                force.add_force(&at, &mut ws.scratches[index], &mut ws.row_force);
                is_any = true;
            }
        }
        is_any
    }

    /// Accelerations by forces that couple no rows: the same throughout the step. They come with the elastic forces, at
    /// each point's own dates, so that what is in balance does not quiver.
    fn hold_steady(&mut self) {
        self.sum_outside(Part::Steady);
        let (ws, steady) = (&mut *self.ws, &mut self.buffers.steady);
        steady.clear();
        steady.resize(ws.row_force.len(), Vec3::ZERO);
        for (index, levels) in bodies(self.step.system) {
            let scratch = &ws.scratches[index];
            levels.give_back(Followers::All, scratch, &mut ws.row_force);
            levels.kick(Push::Outer, &self.division, scratch, &mut ws.row_force, steady);
        }
        for row in self.buffers.others.iter().flat_map(Clone::clone) {
            steady[row] =
                std::mem::replace(&mut ws.row_force[row], Vec3::ZERO) / self.step.system.mass.diagonal[row];
        }
    }

    /// Pushes by the forces from outside that couple rows.
    fn push_from_outside(&mut self, tick: f64) {
        let clock = std::time::Instant::now();
        if self.sum_outside(Part::Coupling) {
            let (system, ws, buffers) = (self.step.system, &mut *self.ws, &*self.buffers);
            for row in &buffers.watched {
                ws.row_force[*row as usize] = ws.row_force[*row as usize] * tick;
            }
            for (index, levels) in bodies(system) {
                let scratch = &ws.scratches[index];
                levels.give_back(Followers::These(&buffers.watched), scratch, &mut ws.row_force);
                let (impulses, velocities) = (&mut ws.row_force, &mut ws.rows.velocities);
                levels.kick(Push::Outer, &self.division, scratch, impulses, velocities);
            }
            for row in buffers.others.iter().flat_map(Clone::clone) {
                let impulse = std::mem::replace(&mut ws.row_force[row], Vec3::ZERO);
                ws.rows.velocities[row] += impulse / system.mass.diagonal[row];
            }
        }
        for row in self.buffers.others.iter().flat_map(Clone::clone) {
            self.ws.rows.velocities[row] += self.buffers.steady[row] * tick;
        }
        self.ws.stages.forces += clock.elapsed().as_secs_f64();
    }

    /// Pushes by elastic forces of the rates that are due.
    fn push_from_inside(&mut self, tick: u32, schedule: Schedule) {
        let (system, ws) = (self.step.system, &mut *self.ws);
        let clock = std::time::Instant::now();
        for rate in schedule.due(tick, self.division.halvings) {
            for (index, levels) in bodies(system) {
                let scratch = &mut ws.scratches[index];
                let steady = &self.buffers.steady;
                levels.accelerate(rate, &self.division, scratch, steady, &mut ws.rows.velocities);
                levels.add_impulses(rate, &self.division, &ws.rows, scratch, &mut ws.row_force);
                let interval = self.division.interval(rate);
                self.held.note_rate(rate, levels.rows(), interval, &ws.row_force);
                let (impulses, velocities) = (&mut ws.row_force, &mut ws.rows.velocities);
                levels.kick(Push::Elastic { rate }, &self.division, scratch, impulses, velocities);
            }
        }
        ws.stages.forces += clock.elapsed().as_secs_f64();
    }

    /// Takes hold of points, with the forces of all rates that act on them as the step begins.
    fn take_hold(&mut self) {
        let Step { system, .. } = *self.step;
        let clock = Instant::now();
        let ws = &mut *self.ws;
        self.held.gather(system, self.next, &ws.scratches, &ws.rows);
        self.held.begin_rates(self.division.halvings as usize + 1);
        if self.held.is_empty() {
            return;
        }
        for (index, levels) in bodies(system) {
            for rate in 0..=self.division.halvings {
                levels.add_impulses(
                    rate,
                    &self.division,
                    &ws.rows,
                    &mut ws.scratches[index],
                    &mut ws.row_force,
                );
                self.held.note_rate(rate, levels.rows(), self.division.interval(rate), &ws.row_force);
                ws.row_force[levels.rows()].fill(Vec3::ZERO);
            }
        }
        ws.stages.forces += clock.elapsed().as_secs_f64();
    }

    /// Moves what is active for a tick that ends at `end`; what is led is where it is led to.
    fn drift(&mut self, timestep: f64, end: f64) {
        let Step { system, around, .. } = *self.step;
        let rows = &mut self.ws.rows;
        for (index, levels) in bodies(system) {
            levels.drift(timestep, &self.ws.scratches[index], rows);
        }
        for row in self.buffers.others.iter().flat_map(Clone::clone) {
            rows.positions[row] += rows.velocities[row] * timestep;
        }
        self.held.lead(timestep, rows);
        system.impose_constraints(&mut rows.positions, &mut rows.velocities, end, around.load);
        rows.time = end;
    }

    /// Looks which rows forces reach, as far as these come until the end of the step, `left` [s], at twice their speed.
    fn look_around(&mut self, left: f64) {
        let Step { system, around, .. } = *self.step;
        let leverage = bodies(system)
            .map(|(index, levels)| levels.leverage(&self.ws.scratches[index]))
            .fold(1.0, f64::max);
        // as the step begins all rows are in place; what feeds itself a tick late is not asked more often than once a tick
        if left < self.step.timestep && leverage.is_finite() {
            follow(system, Followers::All, self.ws);
        }
        let fastest = self.most(|rows, row| rows.velocities[row].length_sq()).sqrt();
        self.buffers.slack = 2.0 * fastest * left;
        // what may come from anywhere is reached everywhere
        let slack = if leverage.is_finite() { self.buffers.slack * leverage } else { f64::INFINITY };
        let reading = Reading { system, around, rows: &self.ws.rows, state: self.next };
        self.buffers.prepare(&reading, slack);
        self.buffers.from.clone_from(&self.ws.rows.positions);
    }

    /// Whether points may come farther in this tick than it was looked for: at twice their speed, since pushes come before they move.
    fn is_slack_used(&self, tick_length: f64) -> bool {
        let from = &self.buffers.from;
        let farthest = self.most(|rows, row| (rows.positions[row] - from[row]).length_sq()).sqrt();
        let fastest = self.most(|rows, row| rows.velocities[row].length_sq()).sqrt();
        farthest + 2.0 * fastest * tick_length > self.buffers.slack
    }

    /// The greatest value of the points that move by themselves.
    fn most(&self, value: impl Fn(&Rows, usize) -> f64) -> f64 {
        let active = bodies(self.step.system)
            .flat_map(|(index, levels)| levels.active(&self.ws.scratches[index]))
            .map(|row| *row as usize);
        let others = self.buffers.others.iter().flat_map(Clone::clone);
        active.chain(others).map(|row| value(&self.ws.rows, row)).fold(0.0, f64::max)
    }

    /// Moves memories on. What is out of reach waits for the last tick, where all rows are in place: its memory is then as if it had been
    /// asked all along.
    fn advance_memory(&mut self, tick_length: f64, is_last: bool) {
        let Step { system, around, .. } = *self.step;
        if is_last && self.buffers.leaves_out {
            follow(system, Followers::All, self.ws);
        }
        let moves_on = |index: usize| {
            let waits = self.buffers.parts[index] == Part::OutOfReach;
            is_last || !waits || system.forces[index].declaration().changing_pattern
        };
        system.advance_memory_of(&moves_on, self.ws, self.next, around, tick_length, Summed::Elsewhere);
    }

    /// # Errors
    /// It is broken off.
    fn run(&mut self, schedule: Schedule) -> Result<(), StepError> {
        let Step { system, around, start, timestep } = *self.step;
        for (index, levels) in bodies(system) {
            let memory = &mut self.next.memory[system.memory_range(index)];
            let scratch = &mut self.ws.scratches[index];
            levels.adapt(&self.division, &mut self.ws.rows, memory, scratch);
        }
        self.look_around(timestep);
        self.ws.row_force.fill(Vec3::ZERO);
        let holds = system.holds();
        if holds {
            self.take_hold();
        }
        let ticks = self.division.ticks();
        let tick_length = timestep / f64::from(ticks);
        self.hold_steady();
        for tick in 0..ticks {
            self.ws.interruption.check()?;
            let left = f64::from(ticks - tick) * tick_length;
            if system.refresh_pairs(self.ws, self.next, around)
                || (tick > 0 && self.buffers.leaves_out && self.is_slack_used(tick_length))
            {
                self.look_around(left);
            }
            self.push_from_outside(tick_length);
            self.push_from_inside(tick, schedule);
            if holds {
                self.held.sum_rates();
                self.held.feel(system, self.next, tick_length);
            }
            self.advance_memory(tick_length, tick + 1 == ticks);
            self.drift(tick_length, start + f64::from(tick + 1) * tick_length);
            follow(system, Followers::Ghosts, self.ws);
            follow(system, Followers::These(&self.buffers.watched), self.ws);
        }
        if holds {
            self.held.note_forces(system, self.next, &self.ws.scratches);
        }
        follow(system, Followers::All, self.ws);
        // what is held is where it is held, also where coarser points carry it
        let rows = &mut self.ws.rows;
        system.impose_constraints(&mut rows.positions, &mut rows.velocities, self.step.end(), around.load);
        Ok(())
    }
}

fn follow(system: &System, who: Followers, ws: &mut SystemWorkspace) {
    for (index, levels) in bodies(system) {
        let scratch = &ws.scratches[index];
        levels.follow(who, Kinematic::Position, scratch, &mut ws.rows.positions);
        levels.follow(who, Kinematic::Velocity, scratch, &mut ws.rows.velocities);
    }
}

impl Stepper for Staggered {
    fn name(&self) -> &'static str {
        ENTRY.name
    }

    fn refuses(&self, system: &System) -> Option<String> {
        let has_levels = bodies(system).next().is_some();
        (!has_levels || !system.kinematics.is_trivial() || !system.mass.is_lumped())
            .then(|| "it steps points with lumped masses, of bodies with `levels`".to_owned())
    }

    fn steps_levels(&self) -> bool {
        true
    }

    fn holds_points(&self, system: &System) -> bool {
        system.holds_levels_alone()
    }

    fn ticks(&self, timestep: f64) -> Option<(Division, Schedule)> {
        Some((self.division(timestep), self.schedule))
    }

    /// Of modified Euler, in its shortest intervals.
    fn stability(&self) -> Stability {
        Stability::Limited(2.0)
    }

    /// Points of levels choose theirs by themselves; all others, and what acts from outside, have the shortest.
    fn interval(&self, timestep: f64) -> f64 {
        timestep / (1_u32 << self.halvings) as f64
    }

    fn step(
        &self,
        step: &Step,
        next: &mut SystemState,
        ws: &mut SystemWorkspace,
    ) -> Result<StepReport, StepError> {
        let division = self.division(step.timestep);
        let (mut buffers, mut held) = (std::mem::take(&mut ws.staggered), std::mem::take(&mut ws.held));
        buffers.list_others(step.system, next.q.len());
        // all rows are points: they move where they stand
        std::mem::swap(&mut next.q, &mut ws.rows.positions);
        std::mem::swap(&mut next.v, &mut ws.rows.velocities);
        ws.rows.time = step.start;
        let mut stage =
            Stage { step, division, next: &mut *next, ws: &mut *ws, buffers: &mut buffers, held: &mut held };
        let ran = stage.run(self.schedule);
        std::mem::swap(&mut next.q, &mut ws.rows.positions);
        std::mem::swap(&mut next.v, &mut ws.rows.velocities);
        (ws.staggered, ws.held) = (buffers, held);
        ran.map(|()| StepReport::default())
    }
}

#[cfg(test)]
mod tests {
    use super::Schedule;

    /// Rate `i` is due `2^i` times a step, evenly; staggered, no tick has more than two rates, plain ticks have up to all. Together, all are
    /// due in every tick.
    #[test]
    fn every_rate_has_its_dates() {
        let halvings = 3;
        for (schedule, most) in [(Schedule::Staggered, 2), (Schedule::Plain, 4)] {
            let mut dates = vec![Vec::new(); halvings as usize + 1];
            for tick in 0..1 << halvings {
                let due: Vec<u32> = schedule.due(tick, halvings).collect();
                assert!(due.len() <= most, "{schedule:?} {tick}: {due:?}");
                due.iter().for_each(|rate| dates[*rate as usize].push(tick));
            }
            for (rate, dates) in dates.iter().enumerate() {
                assert_eq!(dates.len(), 1 << rate, "{schedule:?} {rate}");
                let apart = (1 << halvings) >> rate;
                assert!(dates.windows(2).all(|pair| pair[1] - pair[0] == apart));
            }
        }
        for tick in 0..1 << halvings {
            assert!(Schedule::Together.due(tick, halvings).eq([3, 2, 1, 0]));
        }
        let staggered: Vec<Vec<u32>> =
            (0..8).map(|tick| Schedule::Staggered.due(tick, 3).collect()).collect();
        assert_eq!(
            staggered,
            [vec![3], vec![3, 2], vec![3, 1], vec![3, 2], vec![3, 0], vec![3, 2], vec![3, 1], vec![3, 2]]
        );
    }
}
