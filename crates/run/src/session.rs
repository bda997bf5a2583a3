//! A world being run: stepped, measured, edited and reported, by [`crate::run`] from end to end or by a person live.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::Instant;

use souple_engine::{Edit, EditError, ResumeError, StepError, StepReport, World};
use souple_io::IoError;
use souple_scene::{
    Adjustable, BodyInfo, Diagnostics, HandInfo, Measurement, ProbeInfo, Scene, SkinInfo, inputs::Inputs,
};

use crate::failure::Failure;
use crate::frames::solid_of;
use crate::lookout::Lookout;
use crate::machine::peak_bytes;
use crate::monitor::{Grown, Monitor};
use crate::recording::{Recording, add_hash};
use crate::report::{AroundSteps, Report, SkinChange, Status, attachments, counts, skins};
use crate::show::{MOST_GROWTH, growth, growth_of_cells};
use crate::snapshot_file::{snapshot_bytes, write_snapshot};
use crate::wavering::Wavering;
use crate::{Options, RunError, forecast_warnings};

/// A world with what is measured of it, and all that a recording and a report of it need.
pub struct Session {
    pub title: String,
    pub scene_name: String,
    /// Of the scene as it is now, changes included.
    pub scene_sha256: String,
    pub world: World,
    pub bodies: Vec<BodyInfo>,
    pub skins: Vec<SkinInfo>,
    pub hands: Vec<HandInfo>,
    pub probes: Vec<ProbeInfo>,
    /// Values of the scene that may be set, see [`Session::change`].
    pub adjustables: Vec<Adjustable>,
    pub warnings: Vec<String>,
    /// What watches its energy, where the scene asks for it.
    pub monitor: Option<Monitor>,
    lookout: Lookout,
    wavering: Wavering,
    /// Most that the world was seen to hold [bytes].
    held: usize,
    /// Why it cannot go on.
    pub failure: Option<Failure>,
    pub first_step: u64,
    pub(crate) around: AroundSteps,
    pub(crate) clock: Instant,
    seed: u64,
    recording: Recording,
    skin_changes: Vec<SkinChange>,
    places: BTreeMap<PathBuf, PathBuf>,
    pub(crate) solver: StepReport,
    energy_at_start: souple_engine::EnergyReport,
    momentum_at_start: (souple_math::Vec3, souple_math::Vec3),
}

/// What became of a period that was to be stepped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stepped {
    On,
    /// [`Session::failure`] tells why; the world can go no further.
    Refused,
    /// From outside ([`Options::interruption`]): the world stands where it stood, and may go on.
    BrokenOff,
}

/// A value of the scene set while it runs: the scene is read again with it, and goes on from where it stood.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Change {
    /// The period before which it was made; edits of the same period come after it.
    pub period: u64,
    /// `path=value`
    pub setting: String,
}

/// Why a value was not set.
#[derive(Debug, thiserror::Error)]
pub enum ChangeError {
    #[error("{0}")]
    Scene(Diagnostics),
    #[error("`{setting}` makes another world, which cannot go on from where this one stands: {error}")]
    OtherWorld { setting: String, error: ResumeError },
}

/// Adds a setting, `path=value`, in the place of an earlier one of the same path.
pub fn put_setting(settings: &mut Vec<String>, setting: &str) {
    let path = |setting: &str| setting.split_once('=').map(|(path, _)| path.trim().to_owned());
    settings.retain(|earlier| path(earlier) != path(setting));
    settings.push(setting.to_owned());
}

impl Session {
    /// # Errors
    /// The snapshot or the commands to go on from do not fit the scene.
    pub fn start(scene: Scene, options: &Options) -> Result<Self, RunError> {
        let Scene { title, model, state, bodies, skins, hands, probes, adjustables, .. } = scene;
        let Scene { scene_sha256, inputs, warnings, run, .. } = scene;
        let mut world = model.start(state);
        world.heed(&options.interruption);
        world.note_on(&options.timeline);
        if let Some(snapshot) = &options.resume {
            let period = snapshot.state.period;
            let resumed = world.resume_edited(snapshot.state.clone(), snapshot.commands.clone());
            resumed.map_err(|error| match error {
                ResumeError::Edit(error) => RunError::Edit { period, error },
                ResumeError::State(error) => error.into(),
            })?;
        }
        let resumed_seed = options.resume.as_ref().map(|snapshot| snapshot.seed);
        let seed = options.seed.or(resumed_seed).unwrap_or(run.seed);
        let mut recording = Recording::new(&options.scene_name, &scene_sha256, inputs, seed);
        recording.push_hash(&world);
        Ok(Self {
            title,
            scene_name: options.scene_name.clone(),
            scene_sha256,
            first_step: world.state().period,
            energy_at_start: world.energy(),
            momentum_at_start: world.momentum(),
            wavering: Wavering::new(&world, &bodies),
            lookout: Lookout::new(&world, &bodies),
            bodies,
            skins,
            hands,
            probes,
            adjustables,
            warnings,
            monitor: run.monitor.map(|spec| Monitor::new(spec, &mut world)),
            held: 0,
            failure: None,
            around: AroundSteps::default(),
            clock: Instant::now(),
            seed,
            recording,
            skin_changes: Vec::new(),
            places: options.places.clone(),
            solver: StepReport::default(),
            world,
        })
    }

    /// Warns of what stands against stability; the wall clock starts anew after it.
    pub fn forecast(&mut self) {
        self.warnings.extend(forecast_warnings(&mut self.world));
        self.clock = Instant::now();
    }

    /// Steps a period.
    pub fn step(&mut self) -> Stepped {
        let events = |world: &World, skins: &[SkinInfo]| -> Vec<u64> {
            skins.iter().map(|skin| skin.view(world).events()).collect()
        };
        let before = events(&self.world, &self.skins);
        match self.world.step() {
            Ok(()) => {
                self.solver.merge(self.world.last_report());
                self.note_changes(&before);
                self.warnings.extend(self.lookout.look(&self.world, &self.bodies));
                self.warnings.extend(self.wavering.look(&self.world, &self.bodies));
                Stepped::On
            }
            Err(error) if error.error == StepError::Interrupted => Stepped::BrokenOff,
            Err(error) => {
                self.failure = Some(Failure::of_step(error, &self.world, &self.bodies));
                Stepped::Refused
            }
        }
    }

    /// Gives back what the world holds for its steps alone.
    pub(crate) fn free_workspace(&mut self) {
        self.held = self.held.max(self.world.bytes());
        self.world.free_workspace();
    }

    /// Looks at its energy, where that is watched, and warns once where it grows.
    ///
    /// # Errors
    /// It grows without work, and the run is to stop there.
    pub fn watch_energy(&mut self) -> Result<(), RunError> {
        let Some(monitor) = &mut self.monitor else { return Ok(()) };
        let Some(message) = monitor.look(&mut self.world, &self.bodies).map(Grown::message) else {
            return Ok(());
        };
        if monitor.stops() {
            return Err(RunError::Grown(message));
        }
        self.warnings.push(format!("energy grew without work: {message}"));
        Ok(())
    }

    /// Notes the skins that count more changes of their topology than before.
    fn note_changes(&mut self, before: &[u64]) {
        for (skin, before) in self.skins.iter().zip(before) {
            let view = skin.view(&self.world);
            if view.events() > *before {
                let (euler, components) = view.counted_topology();
                self.skin_changes.push(SkinChange {
                    skin: skin.name.clone(),
                    time: view.changed(),
                    euler,
                    components,
                });
            }
        }
    }

    /// Whether all solids are of a size that a solid may have; masses of a network may fly apart as they like.
    ///
    /// # Errors
    /// The first that has blown up: its points are no results, though they are finite.
    pub fn check_growth(&self) -> Result<(), RunError> {
        for body in self.bodies.iter().filter(|body| solid_of(self.world.model(), body).is_some()) {
            let positions = &self.world.rows(body.system).positions[body.rows.clone()];
            let growth = if body.cut_at.is_empty() {
                growth(&body.mesh.points, positions)
            } else {
                growth_of_cells(&body.mesh, positions, |cell| body.is_whole(cell, self.world.time()))
            };
            if growth > MOST_GROWTH {
                let stability = self.world.model().systems[body.system].stepper.stability();
                return Err(RunError::BlownUp { body: body.name.clone(), growth, stability });
            }
        }
        Ok(())
    }

    /// Notes what ends the run between two steps; what comes after a first failure is a warning.
    pub(crate) fn fail(&mut self, error: &RunError) -> Status {
        match self.failure {
            None => {
                self.failure = Some(Failure::between(error.to_string(), self.world.state().period));
            }
            Some(_) => self.warnings.push(error.to_string()),
        }
        Status::Failed
    }

    /// Reads all probes: their number, the time, the value.
    pub fn measure(&mut self, take: &mut dyn FnMut(usize, f64, Measurement)) {
        let clock = Instant::now();
        let time = self.world.time();
        for (index, probe) in self.probes.iter().enumerate() {
            take(index, time, probe.measure(&mut self.world));
        }
        self.around.measure += clock.elapsed().as_secs_f64();
    }

    /// Makes an edit, recorded.
    ///
    /// # Errors
    /// See [`World::edit`].
    pub fn edit(&mut self, edit: Edit) -> Result<(), EditError> {
        self.world.edit(edit)
    }

    /// What the scene is read from, with the changes made so far: of those of one path the last.
    pub fn inputs(&self) -> Inputs {
        let mut inputs = self.recording.inputs.clone();
        for change in &self.recording.changes {
            put_setting(&mut inputs.settings, &change.setting);
        }
        inputs
    }

    /// Where the files of the scene are, if not where it says.
    pub fn places(&self) -> &BTreeMap<PathBuf, PathBuf> {
        &self.places
    }

    /// Sets a value of the scene, recorded.
    ///
    /// # Errors
    /// The value does not fit, or makes another world; this one stays as it was.
    pub fn change(&mut self, setting: &str) -> Result<(), ChangeError> {
        let mut inputs = self.inputs();
        put_setting(&mut inputs.settings, setting);
        let scene = souple_scene::read_again(&inputs, self.places.clone()).map_err(ChangeError::Scene)?;
        self.take_over(scene, setting)
    }

    /// Goes on with a scene that was read from [`Session::inputs`] and one more setting.
    ///
    /// # Errors
    /// It makes another world; this one stays as it was.
    pub fn take_over(&mut self, scene: Scene, setting: &str) -> Result<(), ChangeError> {
        let mut world = scene.model.start(scene.state);
        let (state, log) = (self.world.state().clone(), self.world.log().to_vec());
        let other = |error| ChangeError::OtherWorld { setting: setting.to_owned(), error };
        world.resume_edited(state, log).map_err(other)?;
        world.inherit(&self.world);
        let told = scene.warnings.into_iter().chain(forecast_warnings(&mut world));
        let new: Vec<String> = told.filter(|warning| !self.warnings.contains(warning)).collect();
        self.warnings.extend(new);
        let period = world.state().period;
        self.recording.changes.push(Change { period, setting: setting.to_owned() });
        (self.world, self.bodies, self.skins) = (world, scene.bodies, scene.skins);
        self.hands = scene.hands;
        self.probes = scene.probes;
        self.adjustables = scene.adjustables;
        self.scene_sha256 = scene.scene_sha256;
        Ok(())
    }

    /// Notes the state's hash in the recording.
    pub fn push_hash(&mut self) {
        self.recording.push_hash(&self.world);
    }

    /// The recording up to now.
    pub fn recording(&self) -> Recording {
        let mut recording = self.recording.clone();
        recording.push_hash(&self.world);
        recording.finish(&self.world);
        recording
    }

    /// The state as a file to go on from holds it.
    pub fn snapshot(&self) -> Vec<u8> {
        snapshot_bytes(&self.scene_sha256, self.seed, self.world.state(), self.world.log())
    }

    /// # Errors
    /// The file cannot be written.
    pub fn write_snapshot(&self, path: &Path) -> Result<(), IoError> {
        write_snapshot(path, &self.scene_sha256, self.seed, self.world.state(), self.world.log())
    }

    /// The report up to now, without probes and expectations.
    pub fn report(&mut self, status: Status) -> Report {
        let period = self.world.model().period;
        let steps = self.world.state().period - self.first_step;
        let mut hashes = self.recording.hashes.clone();
        add_hash(&mut hashes, &self.world);
        let energy = self.world.energy();
        let given = self.wavering.given(&self.world, &energy, &self.bodies);
        Report {
            status,
            title: self.title.clone(),
            scene: self.scene_name.clone(),
            scene_sha256: self.scene_sha256.clone(),
            settings: self.inputs().settings,
            seed: self.seed,
            threads: rayon::current_num_threads(),
            first_step: self.first_step,
            steps,
            simulated_seconds: steps as f64 * period,
            wall_seconds: self.clock.elapsed().as_secs_f64(),
            counts: counts(&self.world, &self.bodies),
            skins: skins(&self.world, &self.skins, &self.skin_changes),
            attachments: attachments(&self.world),
            skin_changes: self.skin_changes.clone(),
            stages: self.world.stages(),
            around: self.around,
            energy: (self.energy_at_start.clone(), energy),
            momentum: (self.momentum_at_start, self.world.momentum()),
            solver: self.solver,
            peak_bytes: peak_bytes(),
            solver_bytes: self.held.max(self.world.bytes()),
            probes: Vec::new(),
            sounds: Vec::new(),
            folds: Vec::new(),
            hashes: hashes.into_iter().map(|hashed| (hashed.period, hashed.fingerprint.hash)).collect(),
            expectations: Vec::new(),
            failure: self.failure.clone(),
            warnings: self.warnings.iter().cloned().chain(given).collect(),
        }
    }
}
