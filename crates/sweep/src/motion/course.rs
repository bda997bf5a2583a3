//! A scene whose commands are given from outside, and what keys come to under them.

use souple_engine::{Interruption, State, World};
use souple_run::Lookout;
use souple_scene::{BodyInfo, PlannedControl, ProbeInfo, Scene};

use super::slopes::{Coordinate, coordinates};
use super::{FoundMotion, Gain, KeyState, Motion, When};
use crate::SweepError;
use crate::least_squares::Ending;
use crate::study::Study;

/// How far a date may be from a whole number of periods, in periods: what decimals of a file do.
pub(super) const OFF: f64 = 1e-6;
/// Periods, at most: a state is kept of each.
const MOST_PERIODS: usize = 1_000_000;
/// By how much a step may be another where what laws and the stepper remember is that of the start: a share of what it changes, and of what
/// the motion spans.
const FORGOTTEN: [f64; 2] = [1e-2, 1e-9];

/// A scene whose commands are given from outside.
pub(super) struct Course {
    pub world: World,
    pub start: State,
    pub controls: Vec<PlannedControl>,
    pub probes: Vec<ProbeInfo>,
    bodies: Vec<BodyInfo>,
    /// Of the commands of a period.
    pub weights: Vec<f64>,
    pub periods: usize,
    pub keys: Vec<Key>,
    pub coordinates: Vec<Coordinate>,
    pub steps: usize,
    /// What should be known of the plan.
    pub warnings: Vec<String>,
    stop: Interruption,
}

/// What a probe is to be at the end of a period.
#[derive(Clone)]
pub(super) struct Key {
    /// Its number among those of the study, several of one that lasts.
    pub of: usize,
    /// How many periods it is the end of.
    pub period: usize,
    pub measured: Measured,
    pub band: [f64; 2],
}

/// A probe, and which of its numbers.
pub(super) type Measured = (ProbeInfo, usize);

/// A motion: commands, period by period, the states between periods, and what keys come to.
#[derive(Clone)]
pub(super) struct Trajectory {
    pub commands: Vec<f64>,
    pub states: Vec<State>,
    pub reached: Vec<f64>,
}

impl Course {
    /// A scene at its start, planned for up to the last key, and for `duration` [s] at least.
    pub fn start(
        study: &Study,
        motion: &Motion,
        stop: Interruption,
        duration: Option<f64>,
    ) -> Result<Self, SweepError> {
        let refuse =
            |message: String| SweepError::Scene { run: 0, settings: study.settings.join(", "), message };
        let (scene, controls) = souple_scene::read_file_to_plan(&study.scene, &study.settings)
            .map_err(|found| refuse(found.to_string()))?;
        let Scene { mut model, state, probes, bodies, run, .. } = scene;
        if controls.is_empty() {
            let expected = "controls of actuators with `plan = \"FILE.csv\"`";
            return Err(SweepError::value("scene", "without commands that are planned", expected));
        }
        model.controls.retain(|control| controls.iter().all(|planned| planned.name != control.name()));
        if let Some((name, _)) =
            motion.weights.iter().find(|(name, _)| controls.iter().all(|it| it.name != *name))
        {
            let known: Vec<&str> = controls.iter().map(|control| control.name.as_str()).collect();
            return Err(SweepError::value("plan.weights", name, format!("a control: {}", known.join(", "))));
        }
        let (mut keys, mut warnings) = (Vec::new(), Vec::new());
        for (of, key) in motion.keys.iter().enumerate() {
            let measured = key.probe.among(&probes)?;
            key.quantities.iter().try_for_each(|quantity| quantity.check(measured.0.unit))?;
            for period in periods_of(of, key, model.period)? {
                keys.push(Key { of, period, measured: measured.clone(), band: key.band });
            }
            if key.when.end() > run.duration * (1.0 + OFF) {
                warnings.push(format!(
                    "`plan.keys[{of}]` is {}, and a run of the scene is over after {} s",
                    key.when, run.duration
                ));
            }
        }
        let last = duration.map(|time| whole("plan.duration", time, model.period)).transpose()?;
        let periods = keys.iter().map(|key| key.period).chain(last).max().unwrap_or(0);
        let coordinates = coordinates(&state)?;
        let weight = |control: &PlannedControl| {
            motion.weights.iter().find(|(name, _)| *name == control.name).map_or(1.0, |(_, weight)| *weight)
        };
        Ok(Self {
            weights: controls.iter().map(weight).collect(),
            start: state.clone(),
            world: model.start(state),
            controls,
            probes,
            bodies,
            periods,
            keys,
            coordinates,
            steps: 0,
            warnings,
            stop,
        })
    }

    /// The state a period after `state` under commands.
    pub fn step(&mut self, mut state: State, commands: &[f64]) -> Result<State, SweepError> {
        for (control, command) in self.controls.iter().zip(commands) {
            state.driven[control.driven] = *command;
        }
        if self.stop.is_wished() {
            return Err(failed("it was interrupted"));
        }
        self.steps += 1;
        self.world.resume(state).map_err(failed)?;
        self.world.step().map_err(failed)?;
        Ok(self.world.state().clone())
    }

    pub fn measure(&mut self, (probe, number): &Measured, state: &State) -> Result<f64, SweepError> {
        self.world.resume(state.clone()).map_err(failed)?;
        Ok(probe.measure(&mut self.world).numbers()[*number])
    }

    /// What keys come to where these are the states between periods.
    pub fn reached(&mut self, states: &[State]) -> Result<Vec<f64>, SweepError> {
        let keys = self.keys.clone();
        keys.iter().map(|key| self.measure(&key.measured, &states[key.period])).collect()
    }

    pub fn follow(&mut self, commands: Vec<f64>) -> Result<Trajectory, SweepError> {
        self.follow_from(0, vec![self.start.clone()], commands)
    }

    /// The same from a period on, up to whose start states are known.
    pub fn follow_from(
        &mut self,
        first: usize,
        mut states: Vec<State>,
        commands: Vec<f64>,
    ) -> Result<Trajectory, SweepError> {
        let count = self.controls.len();
        for period in first..self.periods {
            let next = self.step(states[period].clone(), &commands[period * count..(period + 1) * count])?;
            states.push(next);
        }
        let reached = self.reached(&states)?;
        Ok(Trajectory { commands, states, reached })
    }

    /// `Σ w u²` of commands, the first being of the first control.
    pub fn cost(&self, commands: &[f64]) -> f64 {
        commands
            .iter()
            .zip(self.weights.iter().cycle())
            .map(|(command, weight)| weight * command * command)
            .sum()
    }

    /// What a run of a motion warns of.
    pub fn warnings_of(&mut self, now: &Trajectory) -> Result<Vec<String>, SweepError> {
        self.world.resume(self.start.clone()).map_err(failed)?;
        let (mut lookout, mut said) = (Lookout::new(&self.world, &self.bodies), Vec::new());
        for state in &now.states[1..] {
            self.world.resume(state.clone()).map_err(failed)?;
            said.extend(lookout.look(&self.world, &self.bodies));
        }
        Ok(said)
    }

    /// The first contact that presses in a motion, and when [s].
    pub fn first_touch(&mut self, now: &Trajectory) -> Result<Option<(String, f64)>, SweepError> {
        for state in &now.states {
            self.world.resume(state.clone()).map_err(failed)?;
            let mut touching = None;
            for system in 0..self.world.model().systems.len() {
                self.world.visit_forces(system, &mut |force, at| {
                    force.visit_contacts(at, &mut |_| {
                        touching = touching.take().or(Some(force.name().to_owned()))
                    });
                });
            }
            if let Some(name) = touching {
                return Ok(Some((name, self.world.time())));
            }
        }
        Ok(None)
    }

    pub fn is_stopped(&self) -> bool {
        self.stop.is_wished()
    }

    /// Keys that are the end of `period` periods, by their numbers.
    pub fn keys_at(&self, period: usize) -> Vec<(usize, Measured)> {
        let keys = self.keys.iter().enumerate().filter(|(_, key)| key.period == period);
        keys.map(|(at, key)| (at, key.measured.clone())).collect()
    }

    pub fn key_that_is_not_reached(&self, key: usize) -> SweepError {
        SweepError::value(
            format!("plan.keys[{}]", self.keys[key].of),
            "what no command changes, or what other keys say already or contradict",
            "keys that commands reach each by itself, with at least as many commands as keys",
        )
    }

    /// Slopes are by positions and velocities alone: a step has to be the same with what laws and the stepper remembered at the start.
    pub fn refuse_what_remembers(&mut self, now: &Trajectory) -> Result<(), SweepError> {
        let count = self.controls.len();
        let spans = [false, true].map(|is_velocity| {
            let some = self.coordinates.iter().filter(|coordinate| coordinate.is_velocity() == is_velocity);
            some.map(|coordinate| super::slopes::span(*coordinate, &now.states)).fold(0.0, f64::max)
        });
        for period in 1..self.periods {
            let came = &now.states[period];
            let mut blank = State { period: came.period, ..self.start.clone() };
            for (blank, came) in blank.systems.iter_mut().zip(&came.systems) {
                (blank.q, blank.v) = (came.q.clone(), came.v.clone());
            }
            let next = self.step(blank, &now.commands[period * count..(period + 1) * count]);
            let is_off = |coordinate: &&Coordinate| {
                let to = coordinate.of(&now.states[period + 1]);
                let off = next.as_ref().map_or(f64::NAN, |next| (coordinate.of(next) - to).abs());
                let allowed = FORGOTTEN[0] * (to - coordinate.of(came)).abs()
                    + FORGOTTEN[1] * spans[usize::from(coordinate.is_velocity())];
                // what is no number is not the same either
                let is_same = off <= allowed;
                !is_same
            };
            if let Some(coordinate) = self.coordinates.iter().find(is_off) {
                if self.stop.is_wished() {
                    return Err(failed("it was interrupted"));
                }
                let found = format!(
                    "of steps that follow from what laws or the stepper remember besides the state, as {coordinate} shows after {} s",
                    period as f64 * self.world.model().period
                );
                let expected =
                    "laws without memory on the way, and a stepper whose state is positions and velocities";
                return Err(SweepError::value("scene", found, expected));
            }
        }
        Ok(())
    }

    /// What is handed back of a motion.
    pub fn found(
        &self,
        motion: &Motion,
        now: Trajectory,
        (iterations, ending): (usize, Ending),
        cost: f64,
        gains: Vec<Gain>,
    ) -> FoundMotion {
        let count = self.controls.len();
        let of = |index: usize| now.commands.iter().skip(index).step_by(count).copied().collect();
        let controls = self.controls.iter().enumerate();
        let units = motion.keys.iter().enumerate().map(|(of, _)| {
            let key = self.keys.iter().find(|key| key.of == of);
            key.map_or("", |key| key.measured.0.unit)
        });
        FoundMotion {
            commands: controls.map(|(index, control)| (control.name.clone(), of(index))).collect(),
            period: self.world.model().period,
            gains,
            cost,
            units: units.collect(),
            reached: (0..motion.keys.len()).map(|of| self.farthest(of, &now.reached)).collect(),
            iterations,
            steps: self.steps,
            ending,
            warnings: self.warnings.clone(),
            attempts: Vec::new(),
        }
    }

    /// What a key comes to; of one that lasts, where it is farthest out of its band, or nearest to going out of it.
    fn farthest(&self, of: usize, reached: &[f64]) -> f64 {
        let out = |value: f64, [low, high]: [f64; 2]| f64::max(low - value, value - high);
        let all = self.keys.iter().zip(reached).filter(|(key, _)| key.of == of);
        let worst = all.max_by(|(a, x), (b, y)| out(**x, a.band).total_cmp(&out(**y, b.band)));
        worst.map_or(f64::NAN, |(_, value)| *value)
    }

    /// Commands that an actuator would cut off make another motion.
    pub fn refuse_what_is_cut(&self, now: &Trajectory) -> Result<(), SweepError> {
        for (index, control) in self.controls.iter().enumerate() {
            let of = now.commands.iter().skip(index).step_by(self.controls.len());
            let wanted = of.fold(0.0_f64, |most, command| most.max(command.abs()));
            if wanted > control.largest {
                let (name, largest) = (control.name.clone(), control.largest);
                return Err(SweepError::Beyond { name, wanted, largest });
            }
        }
        Ok(())
    }
}

pub(super) fn failed(message: impl ToString) -> SweepError {
    SweepError::Failed { settings: "these commands".to_owned(), message: message.to_string() }
}

/// How many periods a time is.
pub(crate) fn whole(place: &str, time: f64, period: f64) -> Result<usize, SweepError> {
    let periods = time / period;
    if (periods - periods.round()).abs() > OFF * periods || periods < 0.5 {
        let expected = format!("a whole number of periods of {period} s");
        return Err(SweepError::value(place, time.to_string(), expected));
    }
    if periods > MOST_PERIODS as f64 {
        let expected = format!("at most {MOST_PERIODS} periods of {period} s");
        return Err(SweepError::value(place, time.to_string(), expected));
    }
    Ok(periods.round() as usize)
}

/// Periods whose end a key is of.
fn periods_of(of: usize, key: &KeyState, period: f64) -> Result<Vec<usize>, SweepError> {
    match key.when {
        When::At(time) => Ok(vec![whole(&format!("plan.keys[{of}].time"), time, period)?]),
        When::During([from, until]) => {
            let first = ((from / period - OFF).ceil() as usize).max(1);
            let last = (until / period + OFF).floor() as usize;
            if last > MOST_PERIODS {
                let expected = format!("at most {MOST_PERIODS} periods of {period} s");
                return Err(SweepError::value(format!("plan.keys[{of}].until"), until.to_string(), expected));
            }
            if first > last {
                let found = format!("from {from} s to {until} s, in which no period ends");
                let expected = format!("a span with a multiple of {period} s above 0 in it");
                return Err(SweepError::value(format!("plan.keys[{of}]"), found, expected));
            }
            Ok((first..=last).collect())
        }
    }
}
