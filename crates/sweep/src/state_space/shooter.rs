//! Shots: a scene that is set to a state and stepped under one level.

use souple_engine::{State, World};
use souple_formal::{Condition, Formula};
use souple_scene::{NumberOfMass, Planned, PlannedControl, Scene, StateSpace};

use super::iteration::{End, Grid, MOST_NUMBERS, Place, Shot};
use super::{Tabulation, in_words, refused};
use crate::SweepError;
use crate::motion::{Coordinate, coordinates, whole};
use crate::study::Study;

/// By how much what the state does not say may be off where it is set anew, as a share of what the grid spans, and what a step may make of
/// memories, as a share of what it changes.
const ASIDE: f64 = 1e-2;
/// By how much numbers of the state may be others when they are read again, as a share of what the grid spans: roundings.
const ROUNDING: f64 = 1e-9;
/// Periods for which a level is held at most, where the study does not say.
const HOLD: usize = 100;
/// A date that nothing that repeats itself is likely to have as its period, in periods.
const LATER: u64 = 7919;

/// A scene that is set to states.
pub(super) struct Shooter<'a> {
    tabulation: &'a Tabulation,
    grid: &'a Grid,
    world: World,
    start: State,
    controls: Vec<PlannedControl>,
    /// What reads the state, of each control.
    spaces: Vec<StateSpace>,
    /// What is set of the state, by formulas of it.
    sets: Vec<(NumberOfMass, Formula)>,
    target: Condition,
    cost: Formula,
    coordinates: Vec<Coordinate>,
    /// What the grid spans of positions and of velocities of masses.
    spans: [f64; 2],
    /// Periods.
    hold: usize,
}

impl<'a> Shooter<'a> {
    /// # Errors
    /// The scene cannot be read, or is none that such a table is for.
    pub fn start(study: &Study, tabulation: &'a Tabulation, grid: &'a Grid) -> Result<Self, SweepError> {
        let (scene, controls, spaces) = read(study)?;
        let first = &spaces[0];
        let Scene { mut model, state, .. } = scene;
        model.controls.retain(|control| controls.iter().all(|planned| planned.name != control.name()));
        let wanted = || tabulation.states.iter().map(|span| span.name.as_str());
        if let Some(other) = spaces.iter().find(|space| !space.names().eq(wanted())) {
            let names: Vec<&str> = other.names().collect();
            let expected = format!("what `{}` reads, in its order: {}", other.control, names.join(", "));
            return Err(SweepError::value("plan.states", wanted().collect::<Vec<_>>().join(", "), expected));
        }
        let known: Vec<&str> = controls.iter().map(|control| control.name.as_str()).collect();
        let levels: Vec<&str> = tabulation.levels.iter().map(|(name, _)| name.as_str()).collect();
        if levels.len() != known.len() || !levels.iter().all(|name| known.contains(name)) {
            return Err(SweepError::value("plan.levels", levels.join(", "), known.join(", ")));
        }
        let coordinates = coordinates(&state)?;
        let period = model.period;
        let mut shooter = Self {
            sets: sets(tabulation, first, &controls)?,
            target: tabulation.target()?,
            cost: tabulation.cost()?,
            hold: tabulation.hold.map_or(Ok(HOLD), |hold| whole("plan.hold", hold, period))?,
            start: state.clone(),
            world: model.start(state),
            // in the order of levels
            controls: (levels.iter())
                .filter_map(|name| controls.iter().find(|control| control.name == *name).cloned())
                .collect(),
            tabulation,
            grid,
            spaces,
            coordinates,
            spans: [0.0; 2],
        };
        shooter.refuse_what_is_not_given()?;
        shooter.refuse_other_unknowns()?;
        shooter.spans = shooter.spans();
        Ok(shooter)
    }

    /// Commands that are cut off are other commands.
    fn refuse_what_is_not_given(&self) -> Result<(), SweepError> {
        for (control, (_, levels)) in self.controls.iter().zip(&self.tabulation.levels) {
            let wanted = levels.iter().fold(0.0_f64, |most, command| most.max(command.abs()));
            if wanted > control.largest {
                let expected = format!("up to the {} N that its actuator gives", control.largest);
                let place = format!("plan.levels.\"{}\"", control.name);
                return Err(SweepError::value(place, format!("{wanted} N"), expected));
            }
        }
        Ok(())
    }

    /// Numbers of masses are set where State holds them as they are.
    fn refuse_other_unknowns(&mut self) -> Result<(), SweepError> {
        let system = self.controls[0].system;
        let expected = "a scene of one network of masses, whose unknowns are their positions and velocities";
        if self.controls.iter().any(|control| control.system != system) {
            return Err(SweepError::value("scene", "of controls in several systems", expected));
        }
        self.resume(self.start.clone())?;
        let (rows, state) = (self.world.rows(system), &self.start.systems[system]);
        if rows.positions != state.q || rows.velocities != state.v {
            return Err(SweepError::value("scene", "of unknowns that are others", expected));
        }
        Ok(())
    }

    fn resume(&mut self, state: State) -> Result<(), SweepError> {
        self.world.resume(state).map_err(|error| SweepError::Failed {
            settings: "a state of the grid".to_owned(),
            message: error.to_string(),
        })
    }

    /// A scene at its start but for what is set.
    fn placed(&self, place: &Place) -> State {
        let mut state = self.start.clone();
        let system = &mut state.systems[self.controls[0].system];
        for (number, formula) in &self.sets {
            let rows = if number.is_velocity { &mut system.v } else { &mut system.q };
            rows[number.row][number.component] = formula.evaluate(place);
        }
        state
    }

    /// The state that the world is in.
    fn read(&self) -> Place {
        let (mut place, rows) = ([0.0; MOST_NUMBERS], self.world.rows(self.controls[0].system));
        self.spaces[0].read(&rows.positions, &rows.velocities, &mut place);
        place
    }

    /// The state that the scene starts in.
    pub fn start_state(&mut self) -> Place {
        let is_resumed = self.world.resume(self.start.clone()).is_ok();
        if is_resumed { self.read() } else { [f64::NAN; MOST_NUMBERS] }
    }

    /// What all entries span of positions and of velocities.
    fn spans(&self) -> [f64; 2] {
        let mut ends = vec![[f64::INFINITY, f64::NEG_INFINITY]; self.sets.len()];
        for entry in 0..self.grid.len() {
            let place = self.grid.place(entry);
            for ([low, high], (_, formula)) in ends.iter_mut().zip(&self.sets) {
                let number = formula.evaluate(&place);
                (*low, *high) = (low.min(number), high.max(number));
            }
        }
        [false, true].map(|is_velocity| {
            let of = ends.iter().zip(&self.sets).filter(|(_, (number, _))| number.is_velocity == is_velocity);
            of.fold(0.0_f64, |most, ([low, high], _)| most.max(high - low))
        })
    }

    /// Of each entry, whether it is in the target.
    ///
    /// # Errors
    /// Numbers of the state are others where they are set and read again.
    pub fn targets(&mut self) -> Result<Vec<bool>, SweepError> {
        let mut is_target = Vec::with_capacity(self.grid.len());
        for entry in 0..self.grid.len() {
            let place = self.grid.place(entry);
            self.refuse_what_is_not_read(&place)?;
            is_target.push(self.target.holds(&place));
        }
        Ok(is_target)
    }

    /// What is set is read as it was, by each control, but for what stands at both ends of a range, as an angle of half a turn does.
    fn refuse_what_is_not_read(&mut self, place: &Place) -> Result<(), SweepError> {
        self.resume(self.placed(place))?;
        let rows = self.world.rows(self.controls[0].system);
        for space in &self.spaces {
            let mut read = [0.0; MOST_NUMBERS];
            space.read(&rows.positions, &rows.velocities, &mut read);
            for (at, axis) in self.grid.axes.iter().enumerate() {
                let (low, high) = (axis[0], axis[axis.len() - 1]);
                let is_same = |number: f64| (read[at] - number).abs() <= ROUNDING * (high - low);
                let is_end = place[at] == low && is_same(high) || place[at] == high && is_same(low);
                if !is_same(place[at]) && !is_end {
                    let names: Vec<&str> = space.names().collect();
                    let found = format!(
                        "such that `{}` reads {} = {} where {} is set",
                        space.control,
                        names[at],
                        read[at],
                        in_words(&names, place)
                    );
                    let expected = "formulas in `plan.sets` that give the state which the inputs read";
                    return Err(SweepError::value("plan.sets", found, expected));
                }
            }
        }
        Ok(())
    }

    /// The state a period on, under a combination of levels.
    fn step(&mut self) -> Result<(), String> {
        self.world.step().map_err(|error| error.to_string())
    }

    /// Sets the world to a state under commands.
    fn set(&mut self, mut state: State, commands: &[f64]) -> Result<(), SweepError> {
        for (control, command) in self.controls.iter().zip(commands) {
            state.driven[control.driven] = *command;
        }
        self.resume(state)
    }

    /// Holds a level from an entry; within the target it is looked for where that leads, out of it too.
    ///
    /// # Errors
    /// What it costs is no number or below nothing, or the state does not say all.
    pub fn shoot(
        &mut self,
        entry: usize,
        level: usize,
        is_target: bool,
        failed: &mut Vec<String>,
    ) -> Result<Shot, SweepError> {
        let (start, commands) = (self.grid.place(entry), self.tabulation.commands(level));
        self.set(self.placed(&start), &commands)?;
        let (period, mut cost, mut now) = (self.world.model().period, 0.0, start);
        for held in 1..=self.hold {
            let paid = cost + period * (1.0 + self.price(&now, &commands)?);
            if let Err(message) = self.step() {
                failed.push(message);
                return Ok(Shot { cost, end: End::Outside });
            }
            let next = self.read();
            if !is_target && self.target.holds(&next) {
                return Ok(Shot { cost: paid, end: End::Target });
            }
            if !self.grid.contains(&next) {
                // as far as it was within
                return Ok(Shot { cost, end: if held > 1 { End::At(now) } else { End::Outside } });
            }
            (cost, now) = (paid, next);
            if self.has_gone_an_entry(&start, &now) {
                break;
            }
        }
        self.refuse_what_it_does_not_say(&start, &now)?;
        Ok(Shot { cost, end: End::At(now) })
    }

    /// What a second costs besides itself.
    fn price(&self, place: &Place, commands: &[f64]) -> Result<f64, SweepError> {
        let count = self.grid.axes.len();
        let values: Vec<f64> = place[..count].iter().chain(commands).copied().collect();
        let price = self.cost.evaluate(&values);
        if price >= 0.0 && price.is_finite() {
            return Ok(price);
        }
        let names: Vec<&str> = self.spaces[0].names().collect();
        let found = format!("{price} at {}", in_words(&names, place));
        Err(SweepError::value("plan.cost", found, "a finite number of at least 0"))
    }

    /// Whether a number of the state is as far from an entry as the next one.
    fn has_gone_an_entry(&self, from: &Place, to: &Place) -> bool {
        self.grid.axes.iter().zip(from.iter().zip(to)).any(|(axis, (from, to))| {
            let apart = (axis[axis.len() - 1] - axis[0]) / (axis.len() - 1) as f64;
            (to - from).abs() >= apart
        })
    }

    /// What the world has come to is what it would be set to.
    fn refuse_what_it_does_not_say(&self, start: &Place, now: &Place) -> Result<(), SweepError> {
        let (came, told) = (self.world.state(), self.placed(now));
        for coordinate in &self.coordinates {
            let off = (coordinate.of(came) - coordinate.of(&told)).abs();
            let span = self.spans[usize::from(coordinate.is_velocity())];
            if off > ASIDE * span {
                let names: Vec<&str> = self.spaces[0].names().collect();
                let found = format!(
                    "numbers that do not say all: {} of {coordinate} after a way from {}",
                    coordinate.of(came),
                    in_words(&names, start)
                );
                let expected =
                    "states and `plan.sets` that give the place and the velocity of whatever moves";
                return Err(SweepError::value("plan.states", found, expected));
            }
        }
        Ok(())
    }

    /// A step follows from the state alone: from a place where it came under a level it is the same with memories of the start in place of its
    /// own, and at another date.
    ///
    /// # Errors
    /// It is not.
    pub fn refuse_what_is_not_of_the_state(&mut self, entry: usize, level: usize) -> Result<(), SweepError> {
        let commands = self.tabulation.commands(level);
        self.set(self.placed(&self.grid.place(entry)), &commands)?;
        if self.step().is_err() {
            // that is told of the shot
            return Ok(());
        }
        let came = self.world.state().clone();
        let mut blank = self.start.clone();
        for (blank, came) in blank.systems.iter_mut().zip(&came.systems) {
            (blank.q, blank.v) = (came.q.clone(), came.v.clone());
        }
        let later = State { period: came.period + LATER, ..came.clone() };
        let Some(next) = self.after(came.clone(), &commands)? else { return Ok(()) };
        let of_memory = "steps that follow from what laws or the stepper remember besides the state";
        let of_time = "steps that follow from the time besides the state";
        for (other, found, expected) in [
            (blank, of_memory, "laws without memory, and a stepper whose state is positions and velocities"),
            (later, of_time, "a scene in which nothing is told by the time"),
        ] {
            let other = self.after(other, &commands)?;
            let is_off = |coordinate: &Coordinate| {
                let way = coordinate.of(&next) - coordinate.of(&came);
                let of_other = other.as_ref().map_or(f64::NAN, |other| coordinate.of(other));
                let span = self.spans[usize::from(coordinate.is_velocity())];
                let off = (of_other - coordinate.of(&next)).abs();
                // what is no number is not the same either
                let is_same = off <= ASIDE * way.abs() + ROUNDING * span;
                !is_same
            };
            if let Some(coordinate) = self.coordinates.iter().find(|coordinate| is_off(coordinate)) {
                let found = format!("of {found}, as {coordinate} shows");
                return Err(SweepError::value("scene", found, expected));
            }
        }
        Ok(())
    }

    /// The state a period after another; `None` where it cannot be stepped.
    fn after(&mut self, state: State, commands: &[f64]) -> Result<Option<State>, SweepError> {
        self.set(state, commands)?;
        Ok(self.step().is_ok().then(|| self.world.state().clone()))
    }
}

/// A scene with the controls that have a table, and what reads the state of each.
fn read(study: &Study) -> Result<(Scene, Vec<PlannedControl>, Vec<StateSpace>), SweepError> {
    let refuse = |message: String| SweepError::Scene { run: 0, settings: study.settings.join(", "), message };
    let (scene, controls) = souple_scene::read_file_to_plan(&study.scene, &study.settings)
        .map_err(|found| refuse(found.to_string()))?;
    let spaces = controls.iter().filter_map(|control| match &control.by {
        Planned::State(space) => Some(space.clone()),
        Planned::Time => None,
    });
    let spaces: Vec<StateSpace> = spaces.collect();
    if spaces.is_empty() || spaces.len() != controls.len() {
        let expected = "controls of actuators with `table = \"FILE.csv\"`, and none with a `plan`";
        return Err(SweepError::value("scene", "without commands of such a table", expected));
    }
    Ok((scene, controls, spaces))
}

/// Names of the state that the controls of a scene read, in their order.
pub(super) fn names(study: &Study) -> Result<Vec<String>, SweepError> {
    let (_, _, spaces) = read(study)?;
    Ok(spaces[0].names().map(str::to_owned).collect())
}

/// Numbers of masses that are set, by the study or as inputs have them.
fn sets(
    tabulation: &Tabulation,
    space: &StateSpace,
    controls: &[PlannedControl],
) -> Result<Vec<(NumberOfMass, Formula)>, SweepError> {
    let names: Vec<&str> = space.names().collect();
    if tabulation.sets.is_empty() {
        let numbers = space.numbers_of_masses();
        let each = names.iter().zip(numbers).map(|(name, number)| {
            let formula = Formula::compile(name, &names).ok();
            number.zip(formula).ok_or_else(|| {
                let expected =
                    format!("formulas by which numbers of masses follow from {}", names.join(", "));
                let found = format!("missing, and `{name}` is no place or velocity of one mass");
                SweepError::value("plan.sets", found, expected)
            })
        });
        return each.collect();
    }
    let each = tabulation.sets.iter().map(|(name, text)| {
        let place = format!("plan.sets.\"{name}\"");
        let number = controls.iter().find_map(|control| control.number(name)).ok_or_else(|| {
            let control = &controls[0];
            let last = control.rows.len().saturating_sub(1);
            let expected = format!("`{0}[0].x` to `{0}[{last}].v.z`", control.body);
            SweepError::value(&place, "no number of a mass", expected)
        })?;
        let formula = Formula::compile(text, &names)
            .map_err(|error| refused(&place, text, &error, &format!("a formula of {}", names.join(", "))))?;
        Ok((number, formula))
    });
    each.collect()
}
