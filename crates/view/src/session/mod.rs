//! The thread of the world: steps in real time, does what pages wish, says what they are to know.

mod compile;
mod describe;
mod hands;
mod inputs;
mod pace;
mod painter;
mod picture;
mod question;
mod shown;
mod sketch;
mod stage;

use std::sync::Arc;
use std::sync::mpsc::{RecvTimeoutError, TryRecvError};
use std::time::{Duration, Instant};

use serde_json::{Value, json};
use souple_engine::Interruption;
use souple_run::Stepped;
use souple_scene::Scene;

pub use inputs::{Inbox, Input, Inputs};
pub use question::{Answer, Question};
pub use shown::Shown;
pub use stage::{Origin, Stage};

use crate::catalogue::Catalogue;
use crate::hub::{Hub, PageId};
use crate::protocol::{Wish, document, refusal};
use compile::{Compiled, Compiler, Purpose};
use pace::Pace;
use painter::Painter;

/// Pictures a second, at most.
const FRAME: Duration = Duration::from_nanos(1_000_000_000 / 60);
/// How often the state of affairs is noted for `/health` and for pages, at least.
const NOTE: Duration = Duration::from_millis(500);

/// What the world is doing.
#[derive(Clone, Debug, PartialEq)]
enum Mode {
    /// For its first page.
    Waiting,
    Playing,
    Paused,
    /// One step of a paused world.
    Stepping,
    /// A step was refused; says which and why.
    Failed(String),
}

impl Mode {
    fn name(&self) -> &'static str {
        match self {
            Self::Waiting => "waiting",
            Self::Playing => "playing",
            Self::Paused => "paused",
            Self::Stepping => "stepping",
            Self::Failed(_) => "failed",
        }
    }
}

/// The world and its surroundings.
pub struct Live {
    hub: Arc<Hub>,
    catalogue: Catalogue,
    /// What breaks off the step that goes on.
    interruption: Interruption,
    compiler: Compiler,
    stage: Stage,
    painter: Painter,
    mode: Mode,
    pace: Pace,
    /// What this thread has worked since the last period was ready, of which budgets take account.
    worked: Duration,
    /// Whether pages have not seen the world as it stands.
    is_changed: bool,
    /// Whether pages have not been told how it stands.
    is_status_new: bool,
    /// Of the program, the same for every page; made when the first one comes.
    greeting: Option<Value>,
    next_frame: Instant,
    next_note: Instant,
}

/// Whether the thread goes on.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Course {
    On,
    Ends,
}

impl Live {
    /// A world that waits for its first page.
    ///
    /// # Errors
    /// The scene cannot start.
    pub fn new(
        scene: Scene,
        name: String,
        catalogue: Catalogue,
        hub: Arc<Hub>,
        inputs: Inputs,
    ) -> Result<Self, String> {
        let interruption = inputs.interruption().clone();
        let mut stage = Stage::new(scene, name, 0, &interruption, &hub)?;
        stage.begin_samples(&hub);
        let painter = Painter::start(Arc::clone(&hub));
        let painter = painter.map_err(|error| format!("no thread for pictures: {error}"))?;
        let now = Instant::now();
        let live = Self {
            hub,
            catalogue,
            interruption,
            compiler: Compiler::new(inputs),
            stage,
            painter,
            mode: Mode::Waiting,
            pace: Pace::new(now),
            worked: Duration::ZERO,
            is_changed: true,
            is_status_new: false,
            greeting: None,
            next_frame: now,
            next_note: now,
        };
        live.note();
        Ok(live)
    }

    /// The world until it is told to stop.
    pub fn run(mut self, inbox: &Inbox) {
        loop {
            // not longer than a picture lasts, however much is wished for
            let until = Instant::now() + FRAME;
            while Instant::now() < until {
                match inbox.try_take() {
                    Ok(input) => {
                        if self.take(input) == Course::Ends {
                            return;
                        }
                    }
                    Err(TryRecvError::Empty) => break,
                    Err(TryRecvError::Disconnected) => return,
                }
            }
            if self.painter.take_fault() {
                let message = "the program failed over a picture: please report it";
                self.set_mode(Mode::Failed(message.to_owned()));
            }
            self.tell_news();
            let mut now = Instant::now();
            let is_due = self.mode == Mode::Playing && self.pace.due(self.stage.next_time()) <= now;
            if is_due {
                self.step();
                now = Instant::now();
            }
            if self.is_changed && now >= self.next_frame {
                self.show(now);
            }
            if now >= self.next_note {
                self.next_note = now + NOTE;
                self.note();
            }
            if is_due {
                continue;
            }
            match inbox.take_within(self.patience(now)) {
                Ok(input) => {
                    if self.take(input) == Course::Ends {
                        return;
                    }
                }
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => return,
            }
        }
    }

    /// How long nothing is due.
    fn patience(&self, now: Instant) -> Duration {
        let mut next = self.next_note;
        if self.mode == Mode::Playing {
            next = next.min(self.pace.due(self.stage.next_time()));
        }
        if self.is_changed {
            next = next.min(self.next_frame);
        }
        next.saturating_duration_since(now)
    }

    fn step(&mut self) {
        self.is_changed = true;
        let began = Instant::now();
        match self.stage.step(&self.hub) {
            Ok(Stepped::BrokenOff) => return,
            Ok(_) => {}
            Err(message) => self.set_mode(Mode::Failed(message)),
        }
        let now = Instant::now();
        let worked = std::mem::take(&mut self.worked) + (now - began);
        if self.mode == Mode::Playing {
            self.stage.govern(self.pace.load(worked, self.stage.period()));
        }
        self.pace.stepped(now, self.stage.time());
    }

    fn show(&mut self, now: Instant) {
        // a picture that is late by less than one keeps the beat; a later one does not hurry the next
        let next = self.next_frame + FRAME;
        self.next_frame = if next > now { next } else { now + FRAME };
        if self.painter.is_behind() {
            return;
        }
        self.is_changed = false;
        if self.hub.page_count() > 0 {
            let factor = if self.mode == Mode::Playing { self.pace.factor(now) } else { 0.0 };
            self.painter.paint(self.stage.sketch(factor));
            self.hub.timeline().note("sketch", now);
            if self.mode == Mode::Playing {
                self.worked += now.elapsed();
            }
        }
    }

    /// Tells all pages what has changed since they were told, once, however often it did.
    fn tell_news(&mut self) {
        if std::mem::take(&mut self.is_status_new) {
            self.hub.tell_all(&document("status", self.status()));
        }
        self.stage.tell_news(&self.hub);
    }

    fn set_mode(&mut self, mode: Mode) {
        if mode == Mode::Playing {
            self.worked = Duration::ZERO;
            self.pace.start(Instant::now(), self.stage.time());
        }
        self.mode = mode;
        self.note();
        self.is_status_new = true;
    }

    fn status(&self) -> Value {
        json!({
            "mode": self.mode.name(),
            "speed": self.pace.speed(),
            "busy": self.compiler.busy_with(),
            "message": match &self.mode { Mode::Failed(message) => Some(message), _ => None },
        })
    }

    /// Leaves word for `/health`.
    fn note(&self) {
        let mut health = self.status();
        health["status"] = "ok".into();
        health["version"] = env!("CARGO_PKG_VERSION").into();
        health["scene"] = self.stage.name().into();
        health["time"] = self.stage.time().into();
        self.hub.set_health(health);
    }

    fn take(&mut self, input: Input) -> Course {
        match input {
            Input::Joined(page) => self.welcome(page),
            Input::Left(page) => {
                self.stage.forget(page);
                self.is_changed = true;
            }
            Input::Said(page, wish) => {
                let about = wish.name();
                if let Err(message) = self.fulfil(page, wish) {
                    self.hub.tell(page, refusal(about, &message));
                }
            }
            Input::Asked(question, answer) => {
                // who asked may have gone
                let _ = answer.send(self.stage.answer(question));
            }
            Input::Compiled(compiled) => self.receive(*compiled),
            Input::Stop => return Course::Ends,
        }
        Course::On
    }

    fn welcome(&mut self, page: PageId) {
        let greeting = self.greeting.get_or_insert_with(|| {
            json!({
                "version": env!("CARGO_PKG_VERSION"),
                "colour_maps": describe::colour_maps(),
                "tools": describe::tools(),
                "scenes": self.catalogue.to_json(),
            })
        });
        greeting["page"] = page.into();
        self.hub.tell(page, document("hello", greeting.clone()));
        self.stage.describe(&mut |message| self.hub.tell(page, message));
        if self.mode == Mode::Waiting {
            self.set_mode(Mode::Playing);
        }
        self.hub.tell(page, document("status", self.status()));
        // pictures are shown by another thread: none may come before what they are of
        self.hub.welcome(page);
        self.is_changed = true;
    }

    fn fulfil(&mut self, page: PageId, wish: Wish) -> Result<(), String> {
        // a hand is led by the next step: a picture before that would keep the one after it waiting
        self.is_changed |= self.mode != Mode::Playing || !matches!(wish, Wish::Move { .. });
        match wish {
            Wish::Seen => {}
            Wish::Play => match &self.mode {
                Mode::Failed(message) => return Err(format!("{message}; reset the world first")),
                _ => self.set_mode(Mode::Playing),
            },
            Wish::Pause => {
                if !matches!(self.mode, Mode::Failed(_)) {
                    self.set_mode(Mode::Paused);
                }
            }
            Wish::Step => {
                if let Mode::Failed(message) = &self.mode {
                    return Err(format!("{message}; reset the world first"));
                }
                // it may last
                self.set_mode(Mode::Stepping);
                self.tell_news();
                self.step();
                if self.mode == Mode::Stepping {
                    self.set_mode(Mode::Paused);
                }
            }
            Wish::Speed(speed) => {
                self.pace.set_speed(speed, Instant::now(), self.stage.time());
                self.is_status_new = true;
            }
            Wish::Reset => self.compile(page, Purpose::Reset)?,
            Wish::Load(name) => {
                if self.catalogue.find(&name).is_none() {
                    let known: Vec<&str> = self.catalogue.names().collect();
                    return Err(format!("there is no scene `{name}`; there are: {}", known.join(", ")));
                }
                self.compile(page, Purpose::Load(name))?;
            }
            Wish::LoadText { name, text, mesh } => {
                self.compile(page, Purpose::LoadText { name, text, mesh })?;
            }
            Wish::Set { path, value } => {
                // others may change what pages were told of the scene
                if !self.stage.session().adjustables.iter().any(|known| known.path == path) {
                    return Err(format!(
                        "`{path}` cannot be set while the scene is shown; what can is under Parameters"
                    ));
                }
                self.compile(page, Purpose::Set(format!("{path}={value}")))?;
            }
            wish => self.stage.fulfil(page, wish, &self.hub)?,
        }
        Ok(())
    }

    fn compile(&mut self, page: PageId, purpose: Purpose) -> Result<(), String> {
        self.is_status_new = true;
        self.compiler.ask(page, purpose, self.stage.session(), &self.catalogue)
    }

    /// A scene has been read: goes on with it, or says what is wrong with it.
    fn receive(&mut self, compiled: Compiled) {
        let (page, purpose) = (compiled.page, compiled.purpose.clone());
        let about = purpose.name();
        let result = match (compiled.scene, &purpose) {
            (Err(message), Purpose::LoadText { mesh: Some(mesh), .. }) => Err(mesh.told(&message)),
            (Err(message), _) => Err(message),
            (Ok(scene), Purpose::Set(setting)) => self.stage.change(scene, setting, &self.hub),
            (Ok(scene), _) => self.begin(scene, &purpose),
        };
        if let Err(message) = result {
            self.hub.tell(page, refusal(about, &message));
            // whoever wished sees the old value again
            self.hub.tell_all(&self.stage.adjustables());
        }
        if let Err(message) = self.compiler.next(self.stage.session(), &self.catalogue) {
            self.hub.tell(page, refusal(about, &message));
        }
        self.is_changed = true;
        self.is_status_new = true;
        self.note();
    }

    /// Another world, or this one anew.
    fn begin(&mut self, scene: Scene, purpose: &Purpose) -> Result<(), String> {
        let name = match purpose {
            Purpose::Load(name) => match self.catalogue.find(name) {
                Some(path) => path.display().to_string(),
                None => name.clone(),
            },
            Purpose::LoadText { name, .. } => name.clone(),
            Purpose::Reset | Purpose::Set(_) => self.stage.name().to_owned(),
        };
        let mut stage = Stage::new(scene, name, self.stage.number() + 1, &self.interruption, &self.hub)?;
        match purpose {
            Purpose::LoadText { mesh, .. } => stage.origin = Origin::Text { mesh: mesh.clone() },
            Purpose::Reset => stage.begin_anew(&self.stage),
            Purpose::Load(_) | Purpose::Set(_) => {}
        }
        let looks = self.stage.looks().clone();
        self.stage = stage;
        self.stage.set_looks(looks);
        self.stage.describe(&mut |message| self.hub.tell_all(&message));
        // they go with pictures, also with one of the scene before: none may come before what they are of
        self.stage.begin_samples(&self.hub);
        self.stage.describe_inside(&self.hub);
        // who asks for another world wants to see it go
        if matches!(self.mode, Mode::Failed(_)) || !matches!(purpose, Purpose::Reset) {
            self.mode = Mode::Playing;
        }
        self.pace.start(Instant::now(), self.stage.time());
        Ok(())
    }
}
