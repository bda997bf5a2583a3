//! The course of a run: its steps, and what is written between and after them.
//!
//! Whatever goes wrong once the first step is due ends the run as failed, and costs neither the report nor anything
//! else that can still be written.

use std::iter::Peekable;
use std::time::Instant;

use souple_engine::{Command, World};
use souple_scene::spec::expect::Expect;
use souple_scene::spec::picture::PictureView;
use souple_scene::spec::sound::Sound;
use souple_table::{counted, four_digits};

use crate::doubts;
use crate::expect::Span;
use crate::folds::{Fold, Folds, Look};
use crate::frames::Frames;
use crate::machine::peak_bytes;
use crate::output::{OutputError, OutputFolder};
use crate::sound::{Rendered, Rounding};
use crate::{
    Change, Control, Options, Outcome, Progress, Report, RunError, Session, Status, Stepped, Trace, Verdict,
};
use crate::{picture, report, snapshot_name};

/// A run on its way.
pub(crate) struct Course {
    pub session: Session,
    /// Where its files go; nothing is written where `None`.
    pub folder: Option<OutputFolder>,
    pub frames: Frames,
    pub traces: Vec<Trace>,
    pub folds: Folds,
}

/// What of a scene is looked at when its run is over.
pub(crate) struct Aims {
    pub expects: Vec<Expect>,
    pub sounds: Vec<Sound>,
    /// End of the scene [s].
    pub scene_end: f64,
    pub view: PictureView,
}

/// What is done to the world along the way, in order.
struct Dues<'a, C: Iterator<Item = &'a Command>> {
    commands: Peekable<C>,
    changes: Peekable<std::slice::Iter<'a, Change>>,
}

impl<'a, C: Iterator<Item = &'a Command>> Dues<'a, C> {
    /// What is due now: before the next step, and after the last.
    fn make(&mut self, session: &mut Session) -> Result<(), RunError> {
        let now = session.world.state().period;
        while let Some(change) = self.changes.next_if(|change| change.period <= now) {
            let error = |error| RunError::Change { period: change.period, error };
            session.change(&change.setting).map_err(error)?;
        }
        while let Some(command) = self.commands.next_if(|command| command.period <= now) {
            let error = |error| RunError::Edit { period: command.period, error };
            session.edit(command.edit.clone()).map_err(error)?;
        }
        Ok(())
    }
}

impl Course {
    /// All steps, and what is left of them.
    pub fn run(
        mut self,
        steps: u64,
        options: &Options,
        aims: &Aims,
        watch: &mut dyn FnMut(&Progress) -> Control,
    ) -> Outcome {
        let mut status = match self.steps(steps, options, watch) {
            Ok(status) => status,
            Err(error) => self.session.fail(&error),
        };
        if let Err(error) = self.frames.close(self.folder.as_mut(), &mut self.session) {
            status = self.session.fail(&error.into());
        }
        if let Err(error) = self.session.check_growth() {
            status = self.session.fail(&error);
        }
        let recording = self.session.recording();
        if let Some(Err(error)) = options.record.as_ref().map(|path| recording.write(path)) {
            status = self.session.fail(&RunError::Recording(error));
        }
        let report = self.conclude(status, aims);
        let replaced = self.folder.as_ref().map_or(0, OutputFolder::replaced);
        let Session { world, bodies, skins, .. } = self.session;
        Outcome { report, traces: self.traces, recording, world, bodies, skins, replaced }
    }

    /// # Errors
    /// A change or a command does not fit, a frame or a snapshot cannot be written.
    fn steps(
        &mut self,
        steps: u64,
        options: &Options,
        watch: &mut dyn FnMut(&Progress) -> Control,
    ) -> Result<Status, RunError> {
        let Self { session, folder, frames, traces, folds } = self;
        let period = session.world.model().period;
        let commands = commands_left(options, &session.world).peekable();
        let mut dues = Dues { commands, changes: options.changes.iter().peekable() };
        session.measure(&mut |probe, time, value| traces[probe].push(time, value));
        frames.write(folder.as_mut(), session, 0)?;
        if steps == 0 {
            dues.make(session)?;
        }
        for step in 1..=steps {
            dues.make(session)?;
            match session.step() {
                Stepped::On => {}
                Stepped::Refused => return Ok(Status::Failed),
                Stepped::BrokenOff => {
                    keep_state(session, folder.as_mut().filter(|_| options.snapshot_every.is_some()))?;
                    session.push_hash();
                    return Ok(Status::Interrupted);
                }
            }
            session.measure(&mut |probe, time, value| traces[probe].push(time, value));
            let clock = Instant::now();
            folds.look(Look::Glance, &session.world, &session.bodies);
            session.around.inside_out += clock.elapsed().as_secs_f64();
            // told when what there is has been written
            let watched = session.watch_energy();
            let last = step == steps;
            let write_clock = Instant::now();
            if last {
                // what was done to a live world after its last step
                dues.make(session)?;
            }
            // by the date in the world, so that runs from snapshots stop to write where the whole run does
            let date = session.world.state().period;
            if last || watched.is_err() || options.hash_every.is_some_and(|every| date.is_multiple_of(every))
            {
                session.push_hash();
            }
            let clock = Instant::now();
            if frames.write(folder.as_mut(), session, step)? {
                options.timeline.note("write", clock);
            }
            let wall_seconds = session.clock.elapsed().as_secs_f64();
            let progress = Progress { step, steps, simulated_seconds: step as f64 * period, wall_seconds };
            let stops = watch(&progress) == Control::Stop && !last;
            let is_due = |every: u64| last || stops || watched.is_err() || date.is_multiple_of(every);
            keep_state(session, folder.as_mut().filter(|_| options.snapshot_every.is_some_and(is_due)))?;
            session.around.write += write_clock.elapsed().as_secs_f64();
            watched?;
            if stops {
                session.push_hash();
                return Ok(Status::Interrupted);
            }
        }
        Ok(Status::Done)
    }

    /// The report, written with tables and pictures where the run has a folder.
    fn conclude(&mut self, status: Status, aims: &Aims) -> Report {
        let Self { session, folder, traces, frames, folds } = self;
        let drawable = folder.as_ref().and_then(|_| frames.drawable(session));
        if let Some(moment) = &drawable
            && moment.time < session.world.time()
        {
            let vanished =
                session.skins.iter().filter(|skin| skin.view(&session.world).measures().components == 0);
            let names: Vec<String> = vanished.map(|skin| format!("`{}`", skin.name)).collect();
            let why = match &names[..] {
                [] => "the bodies have run away".to_owned(),
                names => format!("nothing is left of the skin {}", names.join(", ")),
            };
            session.warnings.push(format!(
                "{why}: the picture shows {:.6} s, the last frame that can be drawn",
                moment.time
            ));
        }
        let period = session.world.model().period;
        let measured = (session.first_step as f64 * period, session.world.time());
        let span = Span { scene_end: aims.scene_end, period, status, measured };
        // nothing is heard where nothing is written, nor of a run that failed: it would be scaled by what it failed of
        let is_heard = folder.is_some() && status != Status::Failed;
        let sounds = aims.sounds.iter().filter(|_| is_heard);
        let places = session.bodies.iter().flat_map(|body| &body.mesh.points);
        let size = places.fold(0.0, |size: f64, place| size.max(place.length()));
        let rounding = Rounding { size, period };
        if folder.is_some() {
            let cut =
                aims.sounds.iter().filter_map(|sound| cut_short(&sound.name, status, session.world.time()));
            session.warnings.extend(cut);
        }
        let (sounds, said): (Vec<_>, Vec<_>) =
            sounds.map(|sound| Rendered::new(sound, traces, rounding)).unzip();
        session.warnings.extend(said.into_iter().flatten());
        session.warnings.extend(doubts::of_traces(traces));
        let clock = Instant::now();
        folds.look(Look::Close, &session.world, &session.bodies);
        session.around.inside_out += clock.elapsed().as_secs_f64();
        let folds = folds.take_found();
        session.warnings.extend(folds.iter().map(Fold::message));
        if session.solver.shortened > 0 {
            session.warnings.push(format!(
                "{} of one linearised solve went up in potential and {} taken in part, which costs momentum and energy: take shorter steps, or \
                 `newton = \"full\"`",
                counted(session.solver.shortened, "step"),
                if session.solver.shortened == 1 { "was" } else { "were" },
            ));
        }
        if session.solver.contacts_wedged > 0.0 {
            session.warnings.push(format!(
                "bodies were jammed by friction, or contradicted by several contacts, in {}: of these collisions gave nothing back, and contacts were let pass off by up to \
                 {} m; less friction, less restitution or other steps may help",
                counted(session.solver.wedged_steps, "step"),
                four_digits(session.solver.contacts_wedged)
            ));
        }
        let mut report = Report {
            probes: traces.iter().map(Trace::summary).collect(),
            sounds: sounds.iter().flatten().map(|sound| sound.summary().clone()).collect(),
            expectations: aims.expects.iter().map(|expect| Verdict::of(expect, traces, &span)).collect(),
            folds,
            ..session.report(status)
        };
        let Some(folder) = folder else { return report };
        // energies were asked for with lists of neighbours, and pictures are large
        session.free_workspace();
        // numbers first: should the program be ended while it draws, they are there
        let written = [
            report::write_report(folder, &report),
            report::write_tables(folder, &report, traces),
            sounds.iter().flatten().try_for_each(|sound| sound.write(folder)),
            picture::write_plots(folder, traces),
            drawable.map_or(Ok(()), |moment| {
                picture::write_last(folder, &report.title, aims.view, session, moment)
            }),
        ];
        let mut errors: Vec<OutputError> = written.into_iter().filter_map(Result::err).collect();
        if errors.is_empty() {
            // what is drawn may have taken most
            report.peak_bytes = peak_bytes();
            errors.extend(report::write_report(folder, &report).err());
        }
        if errors.is_empty() {
            return report;
        }
        for error in errors {
            report.status = session.fail(&error.into());
        }
        (report.failure, report.warnings) = (session.failure.clone(), session.warnings.clone());
        // where even this cannot be written, the failure at hand tells of it
        let _ = report::write_report(folder, &report);
        report
    }
}

/// What is to be said of the sound of a run that did not come to its end.
fn cut_short(sound: &str, status: Status, time: f64) -> Option<String> {
    match status {
        Status::Done => None,
        Status::Failed => Some(format!("sound `{sound}` is not written: the run failed at {time:.6} s")),
        Status::Interrupted => {
            Some(format!("sound `{sound}` ends at {time:.6} s, where the run was interrupted"))
        }
    }
}

/// Writes a snapshot, where there is a folder for it.
fn keep_state(session: &mut Session, folder: Option<&mut OutputFolder>) -> Result<(), RunError> {
    let Some(folder) = folder else { return Ok(()) };
    let path = folder.claim(&snapshot_name(session.world.state().period))?;
    session.write_snapshot(&path).map_err(OutputError::from)?;
    Ok(())
}

/// Commands that the world has not seen: those after its state, and those at its state's period that came later
/// than what its log holds.
fn commands_left<'a>(options: &'a Options, world: &World) -> impl Iterator<Item = &'a Command> + use<'a> {
    let now = world.state().period;
    let done = world.log().iter().filter(|command| command.period == now).count();
    let from = if options.resume.is_some() { now } else { 0 };
    options.commands.iter().filter(move |command| command.period >= from).skip(done)
}
