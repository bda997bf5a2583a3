//! The world: its constant model, its state, its scratch, and the step that joins them.

use std::sync::Arc;
use std::time::Instant;

use souple_math::Vec3;

use crate::constraint::Constraint;
use crate::control::Control;
use crate::coupling::CouplingSpring;
use crate::detection::{Detection, Detector};
use crate::edit::{Command, Edit, EditError};
use crate::force::{Configuration, ContactPoint, Force, Scratch};
use crate::hand::is_hand_name;
use crate::interruption::Interruption;
use crate::snapshot::SnapshotError;
use crate::state::{FieldState, State, SystemState};
use crate::steppers::{Step, StepError, StepReport};
use crate::system::{Rows, StageTimes, Surroundings, System, SystemWorkspace};
use crate::timeline::Timeline;
use crate::tool::Toolbox;

/// A field on a grid: steps itself in State from what rows did, and acts through ordinary forces that read
/// the committed grid.
pub trait Field: Send + Sync {
    fn name(&self) -> &str;

    /// What it is, for people.
    fn kind(&self) -> &'static str {
        "field"
    }

    /// Whether it can go on from a field read from a file, by default one of the sizes of `current`: an index beyond
    /// its grid would be a panic.
    fn accepts(&self, field: &FieldState, current: &FieldState) -> bool {
        (field.values.len(), field.indices.len()) == (current.values.len(), current.indices.len())
    }

    fn new_scratch(&self) -> Scratch {
        Box::new(())
    }

    /// Moves `field` on, reading the committed rows of all systems. What the scratch holds must not change a bit of the
    /// result.
    ///
    /// # Errors
    /// [`StepError::Field`] with what stands in the way; [`StepError::Interrupted`].
    fn step(
        &self,
        rows: CommittedRows,
        step: &FieldStep,
        field: &mut FieldState,
        scratch: &mut Scratch,
    ) -> Result<(), StepError>;

    /// Bytes of constant data and of a scratch on the heap, for the memory report.
    fn bytes(&self, _scratch: &Scratch) -> usize {
        0
    }
}

/// A step of a field: from when, how far.
pub struct FieldStep<'a> {
    /// [s]
    pub start: f64,
    /// [s]
    pub timestep: f64,
    /// What may break it off.
    pub interruption: &'a Interruption,
}

/// The rows of all systems as they stand at the end of a period.
#[derive(Clone, Copy)]
pub struct CommittedRows<'a> {
    systems: &'a [System],
    workspaces: &'a [SystemWorkspace],
    states: &'a [SystemState],
    around: Surroundings<'a>,
}

impl<'a> CommittedRows<'a> {
    pub fn of(&self, system: usize) -> &'a Rows {
        &self.workspaces[system].rows
    }

    /// All forces of a system.
    pub fn forces(&self, system: usize) -> &'a [Box<dyn Force>] {
        &self.systems[system].forces
    }

    /// Rows of the points of a body with levels that moved by themselves in the last step, ascending; `None` where the force
    /// is of no such body.
    pub fn active(&self, system: usize, force: usize) -> Option<&'a [u32]> {
        let levels = self.systems[system].forces[force].levels()?;
        Some(levels.active(&self.workspaces[system].scratches[force]))
    }

    /// How far each point of a body with levels has been moved so far because others came to be at work [m]; `None` where the force is of
    /// no such body.
    pub fn moved(&self, system: usize, force: usize) -> Option<&'a [Vec3]> {
        let levels = self.systems[system].forces[force].levels()?;
        Some(levels.moved(&self.workspaces[system].scratches[force]))
    }

    /// Calls `visit` for every point of a system that touches something, with the name of the contact.
    pub fn visit_contacts(&self, system: usize, visit: &mut dyn FnMut(&str, &ContactPoint)) {
        let (model, rows) = (&self.systems[system], &self.workspaces[system].rows);
        for (index, force) in model.forces.iter().enumerate() {
            let at = model.view(index, rows, &self.states[system], &self.around);
            force.visit_contacts(&at, &mut |point| visit(force.name(), point));
        }
    }
}

/// The constant part of a world.
#[derive(Default)]
pub struct Model {
    /// Seconds in a period: all systems meet at its ends.
    pub period: f64,
    pub systems: Vec<System>,
    pub couplings: Vec<CouplingSpring>,
    /// What drives parameters of forces, in this order.
    pub controls: Vec<Box<dyn Control>>,
    pub fields: Vec<Box<dyn Field>>,
    /// When collisions are detected.
    pub detection: Detection,
    /// What makes the tools that a hand may take; none where bodies can only be held.
    pub toolbox: Option<Arc<dyn Toolbox>>,
    /// Counts the edits that made this model from the first.
    pub generation: u64,
}

/// Scratch of the world.
pub struct Workspace {
    pub systems: Vec<SystemWorkspace>,
    /// One for each system, where it detects anything beside its steps.
    detectors: Vec<Option<Detector>>,
    /// One for each field.
    field_scratches: Vec<Scratch>,
    /// What their steps have taken [s].
    field_seconds: f64,
    /// The next State, swapped in when a step is complete.
    next: State,
    /// For each coupling the number of its force in the faster system.
    fast_ends: Vec<Option<usize>>,
    interruption: Interruption,
    timeline: Timeline,
}

/// A model, its state and its scratch, stepped together.
pub struct World {
    model: Model,
    state: State,
    workspace: Workspace,
    /// All edits since the start, with the period each was made in.
    log: Vec<Command>,
    last_report: StepReport,
}

/// All steps of a system in a period.
struct Steps<'a> {
    system: &'a System,
    around: Surroundings<'a>,
    /// [s]
    start: f64,
    /// [s]
    timestep: f64,
    timeline: &'a Timeline,
}

impl Steps<'_> {
    /// One after the other, each with its search of pairs.
    fn run(&self, state: &mut SystemState, ws: &mut SystemWorkspace) -> Result<StepReport, WorldError> {
        let Self { system, around, start, .. } = self;
        if system.holds() {
            self.search(ws, |ws| {
                system.place_rows(&state.q, &state.v, *start, &mut ws.rows);
                system.look(ws, state, around);
                true
            });
        }
        self.step_on(state, ws, |system, ws, state, around| {
            system.update_pairs(ws, state, around);
            true
        })
    }

    /// The same while a detector looks at where the period begins: what it found in the period before does until it is stale.
    fn beside(
        &self,
        detector: &mut Detector,
        state: &mut SystemState,
        ws: &mut SystemWorkspace,
    ) -> Result<StepReport, WorldError> {
        let Self { system, around, start, timeline, .. } = self;
        let clock = Instant::now();
        system.place_rows(&state.q, &state.v, *start, &mut ws.rows);
        detector.begin(system, ws, state, around);
        ws.stages.pairs += clock.elapsed().as_secs_f64();
        let report = detector.beside(system, around.fields, timeline, || {
            let clock = Instant::now();
            let stepped = self.step_on(state, ws, System::refresh_pairs);
            timeline.note("steps", clock);
            stepped
        })?;
        detector.end(ws, state);
        Ok(report)
    }

    /// The steps, before each of which pairs are brought up to date, and whether by a search.
    fn step_on(
        &self,
        state: &mut SystemState,
        ws: &mut SystemWorkspace,
        bring_up: impl Fn(&System, &mut SystemWorkspace, &mut SystemState, &Surroundings) -> bool,
    ) -> Result<StepReport, WorldError> {
        let Self { system, around, start, timestep, .. } = self;
        let mut report = StepReport::default();
        let (reads_rows, ends_steps) = (ws.rows_are_the_state, system.ends_steps());
        for step in 0..system.steps_per_period {
            ws.interruption.check().map_err(|error| WorldError { place: "the world".to_owned(), error })?;
            let time = start + f64::from(step) * timestep;
            if system.has_pairs() {
                self.search(ws, |ws| {
                    system.place_rows(&state.q, &state.v, time, &mut ws.rows);
                    bring_up(system, ws, state, around)
                });
            }
            ws.rows_are_the_state = reads_rows;
            let step = Step { system, around, start: time, timestep: *timestep };
            let stepped = system.stepper.step(&step, state, ws);
            let place = || format!("system `{}`", system.name);
            report.merge(&stepped.map_err(|error| WorldError { place: place(), error })?);
            if ends_steps {
                if !reads_rows {
                    system.place_rows(&state.q, &state.v, time + timestep, &mut ws.rows);
                }
                system.end_step(&ws.rows, *timestep, state);
            }
        }
        Ok(report)
    }

    /// What may look for what touches what in the midst of the steps, and says whether it did.
    fn search(&self, ws: &mut SystemWorkspace, search: impl FnOnce(&mut SystemWorkspace) -> bool) {
        let clock = Instant::now();
        let has_looked = search(ws);
        ws.stages.pairs += clock.elapsed().as_secs_f64();
        if has_looked {
            self.timeline.note("collisions", clock);
        }
    }
}

/// A step of the world that was refused; State is as it was.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("in {place}: {error}")]
pub struct WorldError {
    /// The system or field.
    pub place: String,
    pub error: StepError,
}

/// Energies of a world [J].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EnergyReport {
    pub kinetic: f64,
    /// Stored and dissipated, by the name of the force.
    pub by_force: Vec<(String, crate::Energy)>,
    /// What the exchange between systems has made so far, by the name of the coupling spring; negative: lost
    /// (see [`crate::coupling`]).
    pub made_by_coupling: Vec<(String, f64)>,
    /// What controls have made so far by what they changed, by their names; negative: taken away (see [`crate::Control`]).
    pub made_by_control: Vec<(String, f64)>,
}

impl EnergyReport {
    /// Kinetic and stored.
    pub fn total(&self) -> f64 {
        self.kinetic + self.by_force.iter().map(|(_, energy)| energy.stored).sum::<f64>()
    }
}

impl Model {
    /// Starts a world at `state`, which was made for this model; one from a file goes through [`World::resume`].
    pub fn start(self, state: State) -> World {
        let systems = self.systems.iter().map(System::new_workspace).collect();
        let is_late = self.detection == Detection::OnePeriodLate;
        let detector = |system| if is_late { Detector::of(system) } else { None };
        let detectors = self.systems.iter().map(detector).collect();
        let fast_end = |coupling: &CouplingSpring| {
            let (forces, name) = (&self.systems[coupling.fast_system].forces, coupling.fast_name());
            forces.iter().position(|force| force.name() == name)
        };
        let fast_ends = self.couplings.iter().map(fast_end).collect();
        let field_scratches = self.fields.iter().map(|field| field.new_scratch()).collect();
        let workspace = Workspace {
            systems,
            detectors,
            field_scratches,
            field_seconds: 0.0,
            next: state.clone(),
            fast_ends,
            interruption: Interruption::default(),
            timeline: Timeline::default(),
        };
        let mut world =
            World { model: self, state, workspace, log: Vec::new(), last_report: StepReport::default() };
        world.place_all_rows();
        if world.state.period == 0 {
            // couplings hold what they are stretched by from the start on
            let mut state = std::mem::take(&mut world.state);
            world.publish_slow_points(0.0, &mut state);
            world.find_first_pairs(&mut state);
            world.state = state;
        }
        world
    }

    /// Seconds of a step of a system.
    pub fn timestep(&self, system: usize) -> f64 {
        self.period / f64::from(self.systems[system].steps_per_period)
    }

    /// Changes the model as an edit says.
    ///
    /// # Errors
    /// The edit names what is not there or a value that does not fit; nothing is changed then.
    pub fn apply(&mut self, state: &mut State, edit: &Edit) -> Result<(), EditError> {
        edit.apply(self, state)?;
        self.generation += 1;
        Ok(())
    }
}

/// Why a world does not go on from a state.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ResumeError {
    #[error(transparent)]
    Edit(#[from] EditError),
    #[error(transparent)]
    State(#[from] SnapshotError),
}

impl World {
    pub fn model(&self) -> &Model {
        &self.model
    }

    pub fn state(&self) -> &State {
        &self.state
    }

    /// The rows of all systems as fields read them.
    pub fn committed_rows(&self) -> CommittedRows<'_> {
        CommittedRows {
            systems: &self.model.systems,
            workspaces: &self.workspace.systems,
            states: &self.state.systems,
            around: Surroundings { driven: &self.state.driven, fields: &self.state.fields, load: 1.0 },
        }
    }

    /// Rows of a system as committed.
    pub fn rows(&self, system: usize) -> &Rows {
        &self.workspace.systems[system].rows
    }

    /// The scratch of a force of a system.
    pub fn scratch(&self, system: usize, force: usize) -> &Scratch {
        &self.workspace.systems[system].scratches[force]
    }

    /// Calls `visit` for every two rows of a system that forces let act on each other without pairs in State.
    pub fn visit_near(&self, system: usize, visit: &mut dyn FnMut([u32; 2])) {
        let (model, state, ws) =
            (&self.model.systems[system], &self.state.systems[system], &self.workspace.systems[system]);
        let around = Surroundings { driven: &self.state.driven, fields: &self.state.fields, load: 1.0 };
        for (index, force) in model.forces.iter().enumerate() {
            force.visit_near(&model.view(index, &ws.rows, state, &around), &ws.scratches[index], visit);
        }
    }

    /// Simulated seconds.
    pub fn time(&self) -> f64 {
        self.state.period as f64 * self.model.period
    }

    /// All edits since the start.
    pub fn log(&self) -> &[Command] {
        &self.log
    }

    /// What the last step had to do.
    pub fn last_report(&self) -> &StepReport {
        &self.last_report
    }

    /// Wall time by stage, summed over systems and fields.
    pub fn stages(&self) -> StageTimes {
        let start = StageTimes { fields: self.workspace.field_seconds, ..StageTimes::default() };
        self.workspace.systems.iter().fold(start, |mut sum, ws| {
            sum.pairs += ws.stages.pairs;
            sum.forces += ws.stages.forces;
            sum.assembly += ws.stages.assembly;
            sum.solve += ws.stages.solve;
            sum.advance += ws.stages.advance;
            sum.products += ws.stages.products;
            sum
        })
    }

    /// Bytes held on the heap: both states, masses and maps, constants and scratch of forces, matrices, solvers and
    /// buffers of steppers. Counted, not estimated; what a force leaves out of [`crate::Force::bytes`] is not in it.
    pub fn bytes(&self) -> usize {
        let systems = self.model.systems.iter().zip(&self.workspace.systems).map(|(system, ws)| {
            let forces: usize = system.forces.iter().map(|force| force.bytes()).sum();
            let constraints = size_of::<Constraint>() * system.constraints.capacity();
            forces + constraints + system.mass.bytes() + system.kinematics.bytes() + ws.bytes(system)
        });
        let fields = self.model.fields.iter().zip(&self.workspace.field_scratches);
        let fields: usize = fields.map(|(field, scratch)| field.bytes(scratch)).sum();
        let detectors = self.model.systems.iter().zip(&self.workspace.detectors);
        let detectors = detectors.filter_map(|(system, detector)| Some(detector.as_ref()?.bytes(system)));
        systems.sum::<usize>()
            + detectors.sum::<usize>()
            + fields
            + self.state.bytes()
            + self.workspace.next.bytes()
    }

    /// Changes the world between steps, and keeps the command for replay.
    ///
    /// # Errors
    /// See [`Model::apply`].
    pub fn edit(&mut self, edit: Edit) -> Result<(), EditError> {
        let edit = edit.resolved(&self.model, &self.state);
        self.model.apply(&mut self.state, &edit)?;
        if edit.changes_forces(&self.model) {
            self.fit_workspace();
            self.forget_couplings();
        }
        let period = self.state.period;
        match (self.log.last_mut(), &edit) {
            // of the places that a hand passes within a period the last one counts
            (
                Some(Command { period: last, edit: Edit::MoveHand { system: s, hand: h, place: to } }),
                Edit::MoveHand { system, hand, place },
            ) if (*last, *s, *h) == (period, *system, *hand) => *to = *place,
            _ => self.log.push(Command { period, edit }),
        }
        self.place_all_rows();
        Ok(())
    }

    /// Continues a world that had been edited: makes its edits anew, so that the model is of its generation, and
    /// takes its state. Edits in a log mean the same at any state (see [`Edit::PinAt`]).
    ///
    /// # Errors
    /// An edit cannot be made (see [`Model::apply`]), or the state is none of the edited model.
    pub fn resume_edited(&mut self, state: State, log: Vec<Command>) -> Result<(), ResumeError> {
        for command in &log {
            self.model.apply(&mut self.state, &command.edit)?;
        }
        self.fit_workspace();
        self.forget_couplings();
        self.log = log;
        Ok(self.resume(state)?)
    }

    /// What was made of the forces as they were: a hand that takes hold anew leaves as many as there were.
    fn forget_couplings(&mut self) {
        for ws in &mut self.workspace.systems {
            ws.tangent.forget_patterns();
            ws.implicit = None;
            ws.linear.forget_reference();
        }
    }

    /// A scratch for each force. Only hands and tools come and go, after all other forces: theirs are made anew, whoever stood there before.
    fn fit_workspace(&mut self) {
        for (system, ws) in self.model.systems.iter().zip(&mut self.workspace.systems) {
            let first_hand = system.forces.iter().position(|force| is_hand_name(force.name()));
            ws.scratches.truncate(first_hand.unwrap_or(system.forces.len()));
            let first_new = ws.scratches.len();
            ws.scratches.extend(system.forces[first_new..].iter().map(|force| force.new_scratch()));
        }
        self.fit_detectors();
    }

    /// A detector for each system, by the forces as they are: an edit may give a system the first that detects anything, or take the last.
    fn fit_detectors(&mut self) {
        if self.model.detection == Detection::EveryStep {
            return;
        }
        for (system, detector) in self.model.systems.iter().zip(&mut self.workspace.detectors) {
            match detector {
                Some(detector) if system.detects() => detector.fit(system),
                _ => *detector = Detector::of(system),
            }
        }
    }

    /// From here on steps end without a result ([`StepError::Interrupted`]) while it is wished.
    pub fn heed(&mut self, interruption: &Interruption) {
        self.workspace.interruption = interruption.clone();
        for ws in &mut self.workspace.systems {
            ws.interruption = interruption.clone();
        }
    }

    /// From here on a timeline has its stages: each `step` with the looks for what touches what in it (`collisions`, on a thread of their
    /// own where they are a period late), and the steps of fields, of which surfaces that are shown are some (`surface`).
    pub fn note_on(&mut self, timeline: &Timeline) {
        self.workspace.timeline = timeline.clone();
    }

    /// Goes on counting the time of stages where another world left off, and heeds and tells what that did.
    pub fn inherit(&mut self, other: &Self) {
        self.heed(&other.workspace.interruption);
        self.note_on(&other.workspace.timeline);
        for (own, before) in self.workspace.systems.iter_mut().zip(&other.workspace.systems) {
            own.stages = before.stages;
        }
        self.workspace.field_seconds = other.workspace.field_seconds;
    }

    /// Continues from another state of the same model.
    ///
    /// # Errors
    /// The state is none of this model, see [`Model::check_state`]; the world stays where it was.
    pub fn resume(&mut self, state: State) -> Result<(), SnapshotError> {
        self.model.check_state(&state, &self.state)?;
        self.state = state;
        self.place_all_rows();
        Ok(())
    }

    /// Gives back what only steps work with and make anew, with the same result: the next State, lists of neighbours. For who needs
    /// the room between steps, to write or to draw what is there.
    pub fn free_workspace(&mut self) {
        self.workspace.next = State::default();
        for (system, ws) in self.model.systems.iter().zip(&mut self.workspace.systems) {
            for (force, scratch) in system.forces.iter().zip(&mut ws.scratches) {
                force.free_scratch(scratch);
            }
        }
    }

    /// One period of the world.
    ///
    /// # Errors
    /// A system or field could not step; State is as it was.
    pub fn step(&mut self) -> Result<(), WorldError> {
        let (start, began) = (self.time(), Instant::now());
        let mut next = std::mem::take(&mut self.workspace.next);
        self.choose_what_reads_rows(start);
        let systems = &self.workspace.systems;
        next.copy_what_stays(&self.state, |index| systems[index].rows_are_the_state);
        let stepped = self.step_into(start, &mut next);
        match stepped {
            Ok(report) => {
                next.period += 1;
                std::mem::swap(&mut self.state, &mut next);
                self.last_report = report;
            }
            Err(_) => self.place_all_rows(),
        }
        self.workspace.next = next;
        self.workspace.timeline.note("step", began);
        match stepped {
            Err(error) if error.error != StepError::Interrupted => {
                Err(self.led_nowhere(start).unwrap_or(error))
            }
            other => other.map(|_| ()),
        }
    }

    /// The first motion that is not finite within a period: what a step that failed is about then.
    fn led_nowhere(&self, start: f64) -> Option<WorldError> {
        self.model.systems.iter().enumerate().find_map(|(index, system)| {
            let timestep = self.model.timestep(index);
            let ends = (1..=system.steps_per_period).map(|step| start + f64::from(step) * timestep);
            let error = ends.into_iter().find_map(|end| system.motion_not_finite(end))?;
            Some(WorldError { place: format!("system `{}`", system.name), error })
        })
    }

    /// Systems whose next step reads the committed rows in the place of a copy of the state.
    fn choose_what_reads_rows(&mut self, start: f64) {
        for ((system, state), ws) in
            self.model.systems.iter().zip(&self.state.systems).zip(&mut self.workspace.systems)
        {
            ws.state_is_finite = false;
            ws.rows_are_the_state = !system.has_pairs() && system.stepper.reads_rows(system, state);
            if ws.rows_are_the_state && !ws.rows_are_committed {
                system.place_rows(&state.q, &state.v, start, &mut ws.rows);
            }
            ws.rows_are_committed = false;
        }
    }

    fn step_into(&mut self, start: f64, next: &mut State) -> Result<StepReport, WorldError> {
        let mut report = StepReport::default();
        self.publish_slow_points(start, next);
        self.drive(start, next);
        for index in 0..self.model.systems.len() {
            report.merge(&self.step_system(index, start, next)?);
        }
        self.exchange_impulses(next);
        self.step_fields(start, next)?;
        let systems = &self.workspace.systems;
        if let Some(field) = next.first_not_finite_but(|index| systems[index].state_is_finite) {
            let error = StepError::StateNotFinite { field, time: start + self.model.period };
            return Err(WorldError { place: "the world".to_owned(), error });
        }
        Ok(report)
    }

    /// All steps of one system in a period.
    fn step_system(&mut self, index: usize, start: f64, next: &mut State) -> Result<StepReport, WorldError> {
        let system = &self.model.systems[index];
        let ws = &mut self.workspace.systems[index];
        let timestep = self.model.timestep(index);
        let (clock, before) = (Instant::now(), ws.stages.total());
        let reads_rows = ws.rows_are_the_state;
        // the very time that a resumed world has here, not `start + period`
        let end = (next.period + 1) as f64 * self.model.period;
        let around = Surroundings { driven: &next.driven, fields: &next.fields, load: 1.0 };
        let state = &mut next.systems[index];
        let steps = Steps { system, around, start, timestep, timeline: &self.workspace.timeline };
        let report = match &mut self.workspace.detectors[index] {
            Some(detector) => steps.beside(detector, state, ws),
            None => steps.run(state, ws),
        }?;
        if reads_rows {
            ws.rows.time = end;
        } else {
            system.place_rows(&state.q, &state.v, end, &mut ws.rows);
        }
        ws.rows_are_committed = true;
        if let Some(error) = system.fault(&ws.rows, state, &around) {
            return Err(WorldError { place: format!("system `{}`", system.name), error });
        }
        // what no stage has claimed
        let claimed = ws.stages.total() - before;
        ws.stages.advance += (clock.elapsed().as_secs_f64() - claimed).max(0.0);
        Ok(report)
    }

    /// Those that are near each other from the start on: their energy is there before the first step.
    fn find_first_pairs(&mut self, state: &mut State) {
        let State { systems, driven, fields, .. } = state;
        let around = Surroundings { driven, fields, load: 1.0 };
        for ((system, state), ws) in self.model.systems.iter().zip(systems).zip(&mut self.workspace.systems) {
            if system.has_pairs() {
                system.update_pairs(ws, state, &around);
            }
        }
    }

    fn publish_slow_points(&self, start: f64, next: &mut State) {
        for coupling in &self.model.couplings {
            let rows = &self.workspace.systems[coupling.slow_system].rows;
            let row = coupling.slow_row as usize;
            let fast =
                self.workspace.systems[coupling.fast_system].rows.positions[coupling.fast_row as usize];
            coupling.start_period(next, start, fast, rows.positions[row], rows.velocities[row]);
        }
    }

    /// Gives controls their values of this period, and keeps account of the energy that this makes.
    fn drive(&mut self, start: f64, next: &mut State) {
        for control in &self.model.controls {
            let slot = control.driven();
            let before = next.driven[slot];
            let value = control.value(start, self.model.period, self.committed_rows(), before);
            if value == before {
                continue;
            }
            let system = &self.model.systems[control.system()];
            let (ws, state) =
                (&mut self.workspace.systems[control.system()], &self.state.systems[control.system()]);
            let mut stored = |driven: &[f64]| -> f64 {
                let around = Surroundings { driven, fields: &self.state.fields, load: 1.0 };
                let is_driven = |force: &&str| control.forces().iter().any(|name| name == force);
                let forces = system.forces.iter().enumerate();
                forces
                    .filter(|(_, force)| is_driven(&force.name()))
                    .map(|(index, force)| {
                        let at = system.view(index, &ws.rows, state, &around);
                        force.held(&at, &mut ws.scratches[index])
                    })
                    .sum()
            };
            let held = stored(&next.driven);
            next.driven[slot] = value;
            next.driven[slot + 1] += stored(&next.driven) - held;
        }
    }

    fn exchange_impulses(&mut self, next: &mut State) {
        for (coupling, fast_end) in self.model.couplings.iter().zip(&self.workspace.fast_ends) {
            let Some(force) = *fast_end else { continue };
            let range = self.model.systems[coupling.fast_system].memory_range(force);
            let row = coupling.slow_row as usize;
            let moved = self.workspace.systems[coupling.slow_system].rows.positions[row]
                - coupling.published_position(&next.driven);
            let memory = &mut next.systems[coupling.fast_system].memory[range];
            coupling.end_period(&mut next.driven, memory, self.model.period, moved);
        }
    }

    fn step_fields(&mut self, start: f64, next: &mut State) -> Result<(), WorldError> {
        if self.model.fields.is_empty() {
            return Ok(());
        }
        let clock = Instant::now();
        let State { systems: states, fields, driven, .. } = next;
        let rows = CommittedRows {
            systems: &self.model.systems,
            workspaces: &self.workspace.systems,
            states,
            around: Surroundings { driven, fields: &self.state.fields, load: 1.0 },
        };
        let scratches = &mut self.workspace.field_scratches;
        for ((field, state), scratch) in self.model.fields.iter().zip(fields).zip(scratches) {
            let step =
                FieldStep { start, timestep: self.model.period, interruption: &self.workspace.interruption };
            let stepped = field.step(rows, &step, state, scratch);
            stepped.map_err(|error| WorldError {
                place: format!("{} `{}`", field.kind(), field.name()),
                error,
            })?;
        }
        self.workspace.field_seconds += clock.elapsed().as_secs_f64();
        self.workspace.timeline.note("surface", clock);
        Ok(())
    }

    fn place_all_rows(&mut self) {
        let time = self.time();
        for ((system, state), ws) in
            self.model.systems.iter().zip(&self.state.systems).zip(&mut self.workspace.systems)
        {
            system.place_rows(&state.q, &state.v, time, &mut ws.rows);
            ws.rows_are_committed = true;
        }
    }

    /// Energies at the committed state.
    pub fn energy(&mut self) -> EnergyReport {
        let mut report = EnergyReport::default();
        let around = Surroundings { driven: &self.state.driven, fields: &self.state.fields, load: 1.0 };
        for ((system, state), ws) in
            self.model.systems.iter().zip(&self.state.systems).zip(&mut self.workspace.systems)
        {
            report.kinetic += system.kinetic_energy(&ws.rows);
            let energies = system.energies(ws, state, &around);
            report.by_force.extend(system.forces.iter().map(|force| force.name().to_owned()).zip(energies));
        }
        let time = self.time();
        for coupling in &self.model.couplings {
            let rows = &self.workspace.systems[coupling.fast_system].rows;
            let fast = rows.positions[coupling.fast_row as usize];
            // before the first period nothing has been exchanged, and the account is not open yet
            let made =
                if self.state.period == 0 { 0.0 } else { coupling.energy_made(&self.state, fast, time) };
            report.made_by_coupling.push((coupling.name.clone(), made));
        }
        for control in &self.model.controls {
            report.made_by_control.push((control.name().to_owned(), self.state.driven[control.driven() + 1]));
        }
        report
    }

    /// Linear [kg m/s] and angular momentum about the origin [kg m²/s].
    pub fn momentum(&self) -> (Vec3, Vec3) {
        self.model.systems.iter().zip(&self.workspace.systems).fold(
            (Vec3::ZERO, Vec3::ZERO),
            |sum, (system, ws)| {
                let (linear, angular) = system.momentum(&ws.rows);
                (sum.0 + linear, sum.1 + angular)
            },
        )
    }

    /// A force of a system by its name, and what it sees of the committed state.
    pub fn force_named(&self, system: usize, name: &str) -> Option<(&dyn Force, Configuration<'_>)> {
        let model = &self.model.systems[system];
        let index = model.forces.iter().position(|force| force.name() == name)?;
        let around = Surroundings { driven: &self.state.driven, fields: &self.state.fields, load: 1.0 };
        let rows = &self.workspace.systems[system].rows;
        let at = model.view(index, rows, &self.state.systems[system], &around);
        Some((model.forces[index].as_ref(), at))
    }

    /// Calls `visit` for every force of a system with what it reads of the committed state.
    pub fn visit_forces(&self, system: usize, visit: &mut dyn FnMut(&dyn Force, &Configuration)) {
        let around = Surroundings { driven: &self.state.driven, fields: &self.state.fields, load: 1.0 };
        let (model, rows) = (&self.model.systems[system], &self.workspace.systems[system].rows);
        for (index, force) in model.forces.iter().enumerate() {
            visit(force.as_ref(), &model.view(index, rows, &self.state.systems[system], &around));
        }
    }

    /// Lends system `index`, its state and its workspace to a reader (probes, forecasts).
    pub fn with_system<T>(
        &mut self,
        index: usize,
        read: impl FnOnce(&System, &crate::SystemState, &Surroundings, &mut SystemWorkspace) -> T,
    ) -> T {
        let around = Surroundings { driven: &self.state.driven, fields: &self.state.fields, load: 1.0 };
        let ws = &mut self.workspace.systems[index];
        // who reads may place them elsewhere
        ws.rows_are_committed = false;
        read(&self.model.systems[index], &self.state.systems[index], &around, ws)
    }
}
