//! A scene on its stage: the session, what pages wish of it, and what they want to see.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::Arc;

use serde_json::json;
use souple_engine::hand::is_hand_name;
use souple_engine::obstacle::{Form, Obstacle};
use souple_engine::{Edit, Interruption, Model, StageTimes, Tool};
use souple_run::show::obstacles_of;
use souple_run::{Governor, Options, Session, Stepped};
use souple_scene::spec::picture::PictureView;
use souple_scene::{BodyInfo, Scene};
use souple_table::Table;

use super::Shown;
use super::hands::{self, Hands, TouchedSurface};
use super::picture::Wanted;
use crate::dropped::DroppedFile;
use crate::fields::{ARROWS, FIELDS};
use crate::hub::{Hub, Outgoing, PageId};
use crate::protocol::{self, Wish, document};
use crate::tools::TOOLS;

/// A scene that is shown.
pub struct Stage {
    session: Session,
    governor: Governor,
    /// Counts the scenes of this program.
    number: u32,
    description: String,
    pub(super) origin: Origin,
    view: PictureView,
    obstacles: Vec<Obstacle>,
    shown: Vec<Arc<Shown>>,
    hands: Hands,
    /// The period for which they were led last.
    led: Option<u64>,
    looks: Looks,
    /// Pages that know the cells.
    pub(super) told_inside: BTreeSet<PageId>,
    /// Whether pages have not been told of the latest pins.
    are_pins_new: bool,
    frames: u32,
    /// Wall times and iterations at the last frame, and the period of it.
    before: (StageTimes, u64),
    iterations: [u64; 2],
    stages: [f64; 5],
    iterations_per_step: [f64; 2],
    /// Steps between samples.
    sample_every: u64,
    row: Vec<f64>,
}

/// Where the text of a scene is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Origin {
    /// In a file of its name.
    File,
    /// Nowhere else: it came from a page, with the mesh that it is made of.
    Text { mesh: Option<DroppedFile> },
}

impl Origin {
    /// A message about the scene, in words of whoever gave it.
    pub fn told(&self, message: &str) -> String {
        match self {
            Self::Text { mesh: Some(mesh) } => mesh.told(message),
            Self::File | Self::Text { mesh: None } => message.to_owned(),
        }
    }
}

/// How each page looks at the world.
#[derive(Clone, Debug, Default)]
pub struct Looks {
    /// Numbers of fields to colour by.
    fields: BTreeMap<PageId, usize>,
    /// Numbers of kinds of arrows.
    arrows: BTreeMap<PageId, usize>,
    /// Pages that look inside bodies.
    inside: BTreeSet<PageId>,
}

impl Looks {
    /// Pages that look inside bodies.
    pub fn inside(&self) -> impl Iterator<Item = PageId> {
        self.inside.iter().copied()
    }
}

/// Samples closer than this are not told apart in a plot [s].
const SAMPLE_DISTANCE: f64 = 4e-3;
/// Columns of samples before those of the probes.
const ENERGY_COLUMNS: [&str; 4] = ["time", "kinetic", "stored", "dissipated"];

/// What stands around the bodies; tools come and go, and are told of on their own.
fn scenery_of(model: &Model) -> Vec<Obstacle> {
    obstacles_of(
        model.systems.iter().flat_map(|system| &system.forces).filter(|force| !is_hand_name(force.name())),
    )
}

impl Stage {
    /// # Errors
    /// The session cannot start.
    pub fn new(
        mut scene: Scene,
        name: String,
        number: u32,
        interruption: &Interruption,
        hub: &Hub,
    ) -> Result<Self, String> {
        let (view, description) = (scene.picture, std::mem::take(&mut scene.description));
        let options = Options {
            scene_name: name,
            interruption: interruption.clone(),
            timeline: hub.timeline().clone(),
            ..Options::default()
        };
        let mut session = Session::start(scene, &options).map_err(|error| error.to_string())?;
        session.forecast();
        let period = session.world.model().period;
        Ok(Self {
            number,
            description,
            origin: Origin::File,
            view,
            obstacles: scenery_of(session.world.model()),
            shown: session.bodies.iter().map(|body| Arc::new(Shown::new(body))).collect(),
            hands: Hands::default(),
            led: None,
            looks: Looks::default(),
            told_inside: BTreeSet::new(),
            are_pins_new: false,
            frames: 0,
            before: (StageTimes::default(), 0),
            iterations: [0; 2],
            stages: [0.0; 5],
            iterations_per_step: [0.0; 2],
            sample_every: (SAMPLE_DISTANCE / period).ceil().max(1.0) as u64,
            row: Vec::new(),
            governor: Governor::new(session.world.model()),
            session,
        })
    }

    /// Samples are of this scene from now on, beginning with that of the world as it stands.
    pub fn begin_samples(&mut self, hub: &Hub) {
        let probes = self.session.probes.iter().map(|probe| if probe.gives_vector() { 3 } else { 1 });
        let columns = ENERGY_COLUMNS.len() + probes.sum::<usize>();
        hub.samples().begin(self.number, columns);
        self.sample(hub);
    }

    pub fn session(&self) -> &Session {
        &self.session
    }

    pub fn session_mut(&mut self) -> &mut Session {
        &mut self.session
    }

    pub fn number(&self) -> u32 {
        self.number
    }

    pub fn name(&self) -> &str {
        &self.session.scene_name
    }

    pub fn description(&self) -> &str {
        &self.description
    }

    pub fn view(&self) -> PictureView {
        self.view
    }

    /// Whether its text is in a file of its name.
    pub fn is_file(&self) -> bool {
        self.origin == Origin::File
    }

    /// The same scene begun anew: it is seen as it was, whatever gravity was set since.
    pub fn begin_anew(&mut self, before: &Stage) {
        self.view = before.view;
        self.origin = before.origin.clone();
        self.show_influence_of(&before.influence_shown());
    }

    /// Of each body the frame whose weights are shown.
    fn influence_shown(&self) -> Vec<Option<usize>> {
        self.session.bodies.iter().map(|body| Some(body.frames.as_ref()?.shown)).collect()
    }

    fn show_influence_of(&mut self, shown: &[Option<usize>]) {
        let frames = self.session.bodies.iter_mut().map(|body| body.frames.as_mut());
        for (frames, shown) in frames.zip(shown) {
            if let (Some(frames), Some(shown)) = (frames, shown)
                && *shown < frames.count()
            {
                frames.shown = *shown;
            }
        }
    }

    fn choose_influence(&mut self, body: usize, frame: usize) -> Result<(), String> {
        self.check_points(body, &[])?;
        let BodyInfo { name, frames, .. } = &mut self.session.bodies[body];
        let Some(frames) = frames else {
            return Err(format!("no frames carry `{name}`"));
        };
        if frame >= frames.count() {
            return Err(format!("`{name}` has no frame {frame}; it has {}, the first is 0", frames.count()));
        }
        frames.shown = frame;
        Ok(())
    }

    pub fn obstacles(&self) -> &[Obstacle] {
        &self.obstacles
    }

    pub fn shown(&self) -> impl ExactSizeIterator<Item = &Shown> + Clone {
        self.shown.iter().map(Arc::as_ref)
    }

    /// The same, to be kept while the stage goes on.
    pub fn shown_to_keep(&self) -> &[Arc<Shown>] {
        &self.shown
    }

    pub fn hands(&self) -> &Hands {
        &self.hands
    }

    /// Milliseconds of a step by stage, over the last steps.
    pub fn stage_times(&self) -> [f64; 5] {
        self.stages
    }

    /// Of a step: Newton's, the linear solver's.
    pub fn iterations(&self) -> [f64; 2] {
        self.iterations_per_step
    }

    /// The number of the next frame.
    pub fn next_frame(&mut self) -> u32 {
        self.frames = self.frames.wrapping_add(1);
        self.frames
    }

    /// The scene's name for files: the folder of a `scene.toml`, or the file without its ending.
    pub fn short_name(&self) -> String {
        let path = Path::new(self.name());
        let is_in_folder = path.file_name().is_some_and(|name| name == "scene.toml");
        let name =
            if is_in_folder { path.parent().and_then(|folder| folder.file_name()) } else { path.file_stem() };
        let name = name.map_or_else(|| "scene".to_owned(), |name| name.to_string_lossy().into_owned());
        name.chars().map(|c| if c.is_ascii_alphanumeric() || "-_".contains(c) { c } else { '_' }).collect()
    }

    /// [s]
    pub fn time(&self) -> f64 {
        self.session.world.time()
    }

    /// Of the world [s].
    pub fn period(&self) -> f64 {
        self.session.world.model().period
    }

    /// The time after the next step [s].
    pub fn next_time(&self) -> f64 {
        (self.session.world.state().period + 1) as f64 * self.period()
    }

    pub fn looks(&self) -> &Looks {
        &self.looks
    }

    /// Goes on being looked at as another stage was.
    pub fn set_looks(&mut self, looks: Looks) {
        self.looks = looks;
    }

    /// What any page wants to see.
    pub fn wanted(&self) -> Wanted {
        let all = |chosen: &BTreeMap<PageId, usize>| {
            chosen.values().copied().collect::<BTreeSet<usize>>().into_iter().collect()
        };
        let Looks { fields, arrows, inside } = &self.looks;
        let mut chosen: Vec<usize> = all(fields);
        let over: Vec<usize> =
            chosen.iter().filter_map(|field| FIELDS.entries[*field].build.over()).collect();
        chosen.extend(over);
        chosen.sort_unstable();
        chosen.dedup();
        Wanted { fields: chosen, arrows: all(arrows), inside: !inside.is_empty() }
    }

    /// Steps a period, or breaks that off.
    ///
    /// # Errors
    /// The step is refused: says which and why.
    pub fn step(&mut self, hub: &Hub) -> Result<Stepped, String> {
        self.lead_hands()?;
        match self.session.step() {
            Stepped::On => {}
            Stepped::BrokenOff => return Ok(Stepped::BrokenOff),
            Stepped::Refused => {
                return Err(self
                    .session
                    .failure
                    .as_ref()
                    .map_or_else(String::new, souple_run::Failure::message));
            }
        }
        let report = self.session.world.last_report();
        self.iterations[0] += report.newton_iterations;
        self.iterations[1] += report.linear_iterations;
        if self.session.world.state().period.is_multiple_of(self.sample_every) {
            self.session.check_growth().map_err(|error| error.to_string())?;
            self.sample(hub);
        }
        Ok(Stepped::On)
    }

    /// Lets bodies with levels do less while the world is late, and more again when it is not: the last period took `load` of the
    /// time that there is for one.
    pub fn govern(&mut self, load: f64) {
        self.governor.after(&mut self.session, load);
    }

    /// Brings hands nearer to where they are led, once in a period: also where its step was broken off.
    fn lead_hands(&mut self) -> Result<(), String> {
        let period = self.session.world.state().period;
        if self.led.replace(period) == Some(period) {
            return Ok(());
        }
        let edits = self.hands.advance(self.session.world.model().period);
        self.edit(edits)
    }

    /// Tells all pages what has changed since they were told.
    pub fn tell_news(&mut self, hub: &Hub) {
        if std::mem::take(&mut self.are_pins_new) {
            hub.tell_all(&self.pins());
        }
    }

    fn sample(&mut self, hub: &Hub) {
        let energy = self.session.world.energy();
        let sum = |part: fn(&souple_engine::Energy) -> f64| {
            energy.by_force.iter().map(|(_, e)| part(e)).sum::<f64>()
        };
        self.row.clear();
        self.row.extend([self.time(), energy.kinetic, sum(|e| e.stored), sum(|e| e.dissipated)]);
        let row = &mut self.row;
        self.session.measure(&mut |_, _, value| row.extend(value.numbers()));
        hub.samples().push(&self.row);
    }

    /// Wall times and iterations of a step since the last frame.
    pub fn average(&mut self) {
        let (now, period) = (self.session.world.stages(), self.session.world.state().period);
        let (before, last) = self.before;
        let steps = period.saturating_sub(last);
        if steps > 0 {
            let parts = |times: StageTimes| {
                let rest = times.advance + times.fields;
                [times.pairs, times.forces, times.assembly, times.solve, rest]
            };
            let (now, before) = (parts(now), parts(before));
            // a changed scene counts from zero again
            let part = |i: usize| 1e3 * (now[i] - before[i]).max(0.0) / steps as f64;
            self.stages = [0, 1, 2, 3, 4].map(part);
            self.iterations_per_step = self.iterations.map(|count| count as f64 / steps as f64);
            self.iterations = [0; 2];
        }
        self.before = (now, period);
    }

    /// What a page does to the world.
    ///
    /// # Errors
    /// It names what is not there, or the world cannot take it.
    pub fn fulfil(&mut self, page: PageId, wish: Wish, hub: &Hub) -> Result<(), String> {
        match &wish {
            Wish::Colour(name) => choose(&FIELDS, name.as_deref(), page, &mut self.looks.fields)?,
            Wish::Arrows(name) => choose(&ARROWS, name.as_deref(), page, &mut self.looks.arrows)?,
            Wish::Influence { body, frame } => {
                self.choose_influence(*body, *frame)?;
                hub.tell_all(&self.influence());
            }
            Wish::Inside(true) => {
                self.looks.inside.insert(page);
                self.describe_inside(hub);
            }
            Wish::Inside(false) => {
                self.looks.inside.remove(&page);
            }
            Wish::Grab { hand, body, points, strength } => {
                self.check_points(*body, points)?;
                let (info, shown) = (&self.session.bodies[*body], &self.shown[*body]);
                let row = |point: &u32| info.rows.start as u32 + shown.points[*point as usize];
                let rows: Vec<u32> = points.iter().map(row).collect();
                let grip = hands::grip(&self.session.world, info, &rows, *strength);
                let edits = self.hands.grab(page, *hand, info.system, grip);
                self.take(page, *hand, edits)?;
            }
            Wish::Touch { .. } => self.touch(page, &wish, hub)?,
            Wish::Move { hand, offset } => {
                // a hand that let go may still be told to move
                self.hands.lead(page, *hand, *offset);
            }
            Wish::Release(hand) => {
                let released = self.hands.release(page, *hand);
                self.edit(released)?;
            }
            Wish::Pin { body, points } | Wish::Unpin { body, points } => {
                self.check_points(*body, points)?;
                self.edit(self.edits_of(*body, &wish)?)?;
                self.are_pins_new = true;
            }
            Wish::Throw { body, .. } => {
                self.check_points(*body, &[])?;
                self.edit(self.edits_of(*body, &wish)?)?;
            }
            _ => {}
        }
        Ok(())
    }

    fn edits_of(&self, body: usize, wish: &Wish) -> Result<Vec<Edit>, String> {
        hands::edits_of(wish, &self.session.world, &self.session.bodies[body], &self.shown[body])
    }

    /// Presses on all bodies with a tool; pages are told its shape.
    fn touch(&mut self, page: PageId, wish: &Wish, hub: &Hub) -> Result<(), String> {
        let Wish::Touch { hand, tool, size, place, direction, strength } = wish else { return Ok(()) };
        let entry = TOOLS.find(tool).map_err(|error| error.to_string())?;
        let values = (entry.build.values)(*size, *direction);
        let system_count = self.session.world.model().systems.len();
        let surfaces: Vec<TouchedSurface> = (0..system_count).map(|system| self.surface_of(system)).collect();
        // one spring holds it: in several systems it would be in several places
        let is_in_one = surfaces.iter().filter(|surface| !surface.rows.is_empty()).count() == 1;
        let mut tools = Vec::new();
        for (system, surface) in surfaces.into_iter().enumerate() {
            if surface.rows.is_empty() {
                continue;
            }
            let bodies = self.session.bodies.iter().filter(|body| body.system == system);
            let touched = hands::Touched::new(&self.session.world, bodies);
            // a hand without strength has no spring, and steps that are solved for seek long where triangles come and go
            let is_held = entry.build.is_rounded
                && is_in_one
                && surface.is_closed
                && *strength > 0.0
                && !touched.is_implicit();
            let (stiffness, held) = if is_held {
                let (stiffness, held) = touched.held_tool(&surface, *size, *strength);
                (stiffness, Some(held))
            } else {
                (touched.stiffness_of_points(surface.rows.len(), *strength), None)
            };
            let (shape, values, spans) = (entry.build.shape.to_owned(), values.clone(), surface.row_spans());
            let rows = surface.rows;
            tools.push((system, Tool { shape, values, place: *place, stiffness, rows, spans, held }));
        }
        let edits = self.hands.touch(page, *hand, *size, tools);
        self.take(page, *hand, edits)?;
        let shape = self.tool_shape(page, *hand);
        shape.into_iter().for_each(|message| hub.tell_all(&Outgoing::Binary(message.into())));
        Ok(())
    }

    /// What a tool may meet of the bodies of a system.
    fn surface_of(&self, system: usize) -> TouchedSurface {
        let bodies = self.session.bodies.iter().zip(self.shown());
        TouchedSurface::of(bodies.filter(|(body, _)| body.system == system))
    }

    /// Makes the edits by which a hand takes something; a hand whose edits are refused holds nothing.
    fn take(&mut self, page: PageId, hand: u32, edits: Vec<Edit>) -> Result<(), String> {
        self.edit(edits).inspect_err(|_| {
            let released = self.hands.release(page, hand);
            // of several systems some may have taken it
            released.into_iter().for_each(|edit| drop(self.session.edit(edit)));
        })
    }

    /// The message of the shape of each tool.
    pub fn tools(&self) -> Vec<Vec<u8>> {
        self.hands.tools().filter_map(|(page, hand)| self.tool_shape(page, hand)).collect()
    }

    fn tool_shape(&self, page: PageId, hand: u32) -> Option<Vec<u8>> {
        let force = self.hands.force_of(&self.session.world, page, hand)?;
        let Form::Surface { points, triangles, .. } = force.obstacle()?.form else { return None };
        Some(protocol::tool(self.number, [page, hand], &points, &triangles))
    }

    fn check_points(&self, body: usize, points: &[u32]) -> Result<(), String> {
        let count = self.shown.len();
        let shown =
            self.shown.get(body).ok_or_else(|| format!("there is no body {body}; there are {count}"))?;
        let count = shown.outer_count;
        match points.iter().find(|point| **point as usize >= count) {
            Some(point) => {
                let name = &self.session.bodies[body].name;
                Err(format!("`{name}` has no surface point {point}; it has {count}"))
            }
            None => Ok(()),
        }
    }

    fn edit(&mut self, edits: Vec<Edit>) -> Result<(), String> {
        edits.into_iter().try_for_each(|edit| self.session.edit(edit).map_err(|error| error.to_string()))
    }

    /// A page has gone: its hands let go.
    pub fn forget(&mut self, page: PageId) {
        self.looks.fields.remove(&page);
        self.looks.arrows.remove(&page);
        self.looks.inside.remove(&page);
        self.told_inside.remove(&page);
        for edit in self.hands.release_all(page) {
            // what a hand held is there to be let go of
            let _ = self.session.edit(edit);
        }
    }

    /// Goes on with the scene read anew with a setting.
    ///
    /// # Errors
    /// The scene is another world now; this one goes on as it was.
    pub fn change(&mut self, scene: Scene, setting: &str, hub: &Hub) -> Result<(), String> {
        let told = self.session.warnings.len();
        let influence = self.influence_shown();
        // of the scene, before what the clock has set since is done again
        let governor = Governor::new(&scene.model);
        self.session.take_over(scene, setting).map_err(|error| error.to_string())?;
        self.show_influence_of(&influence);
        self.governor = governor.at(self.session.world.model());
        for warning in &self.session.warnings[told..] {
            hub.tell_all(&document("warning", json!({"message": self.origin.told(warning)})));
        }
        self.obstacles = scenery_of(self.session.world.model());
        hub.tell_all(&self.adjustables());
        Ok(())
    }
}

/// Notes which entry of a table a page wants to see.
fn choose<B>(
    table: &'static Table<B>,
    name: Option<&str>,
    page: PageId,
    chosen: &mut BTreeMap<PageId, usize>,
) -> Result<(), String> {
    let Some(name) = name else {
        chosen.remove(&page);
        return Ok(());
    };
    table.find(name).map_err(|error| error.to_string())?;
    chosen.extend(table.names().position(|known| known == name).map(|number| (page, number)));
    Ok(())
}
