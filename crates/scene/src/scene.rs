//! A scene ready to run, and how to come by one.

use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::fmt;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use souple_engine::{Census, FieldState, InHand, Levels, Model, State, UnknownKind, World};
use souple_formal::Formula;
use souple_haptics::{Between, DeviceChoice, Port};
use souple_io::picture::Texture;
use souple_math::Vec3;
use souple_mesh::{Mesh, OpeningSurface};
use souple_models::frames::{Carried, FramesReport};
use souple_models::marks::{Mark, Marks};
use souple_models::materials::Material;
use souple_models::multiresolution::Dress;
use souple_models::solids::keeps_texts;
use souple_skin::target::Moment;
use souple_skin::{Polygons, Skin, SkinError};

use crate::adjust::Adjustable;
use crate::compile::{BodyMaterials, NetworkInfo, NumberOfMass, OwnRows, Placed, StateSpace, compile};
use crate::diagnostic::{Diagnostics, Log};
use crate::document::Table;
use crate::include::Includer;
use crate::inputs::{Inputs, Library};
use crate::measure::{ContourInfo, ProbeInfo, Workload};
use crate::source::{Source, Sources};
use crate::spec::Spec;
use crate::spec::body::Body;
use crate::spec::control::Drives;
use crate::spec::expect::Expect;
use crate::spec::picture::PictureView;
use crate::spec::sound::Sound;
use crate::spec::world::RunSpec;
use crate::{modules, overrides, parameters};

/// A model and its first state, with what is measured and expected.
pub struct Scene {
    pub title: String,
    pub description: String,
    /// Ids of the capabilities it shows.
    pub shows: Vec<String>,
    pub model: Model,
    pub state: State,
    pub bodies: Vec<BodyInfo>,
    /// What networks are made of.
    pub networks: Vec<NetworkInfo>,
    pub skins: Vec<SkinInfo>,
    pub hands: Vec<HandInfo>,
    pub probes: Vec<ProbeInfo>,
    /// What is listened to.
    pub sounds: Vec<Sound>,
    pub expects: Vec<Expect>,
    /// Values that may be set while it runs.
    pub adjustables: Vec<Adjustable>,
    pub run: RunSpec,
    pub picture: PictureView,
    /// Of all it was made from: texts with what they include, overrides, mesh and surface files.
    pub scene_sha256: String,
    /// What it was made from.
    pub inputs: Inputs,
    /// What is not wrong but should be known.
    pub warnings: Vec<String>,
}

/// Where a body is in the state, and its shape for pictures and files.
#[derive(Clone, Debug)]
pub struct BodyInfo {
    pub name: String,
    /// Index of its system.
    pub system: usize,
    /// Its points among the rows of the system.
    pub rows: Range<usize>,
    /// Its unknowns, where some of its points hang on other bodies.
    pub own: Option<OwnRows>,
    /// At rest, placed; point `i` is row `rows.start + i`. Shared with what is shown of it.
    pub mesh: Arc<Mesh>,
    /// What is ever on the boundary of the mesh: of one that is cut, from and until its dates.
    pub surface: OpeningSurface,
    /// When each cell of the mesh is cut [s], never where that is infinite; empty of a body that nothing cuts.
    pub cut_at: Vec<f64>,
    /// Name of its elastic force.
    pub force: String,
    pub laws: LawsInfo,
    /// What carries it, where that is not its points.
    pub frames: Option<FramesInfo>,
    /// The few unknowns that it moves in, where these are no points and no frames.
    pub reduced: Option<ReducedInfo>,
    /// The surface that is shown in the place of its own.
    pub dress: Option<DressInfo>,
    /// What tools leave on its surface.
    pub marks: Option<MarksInfo>,
    /// Of its surface, and of its dress.
    pub texture: Option<Arc<Texture>>,
    /// Of each point of a network, the radius of a ball that others keep off [m]; zero of points without a size, and empty
    /// where no body is a network.
    pub radii: Vec<f64>,
    /// Where the objects of a network end.
    pub contours: Vec<ContourInfo>,
    /// Of a network in which bodies have faces.
    pub faces: Option<FacesInfo>,
}

/// Bodies of a network that keep out of each other by their faces.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FacesInfo {
    /// Between points of the mesh, counterclockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// The points of each body that has triangles, in the order of these.
    pub bodies: Vec<Range<u32>>,
}

impl FacesInfo {
    /// Of each triangle the number of its body.
    pub fn numbers(&self) -> impl Iterator<Item = u32> {
        self.triangles.iter().map(|[corner, ..]| {
            let number = self.bodies.iter().position(|body| body.contains(corner));
            number.unwrap_or(0) as u32
        })
    }

    /// Whether both points are of one of the bodies.
    pub fn holds(&self, ends: [u32; 2]) -> bool {
        self.bodies.iter().any(|body| ends.iter().all(|end| body.contains(end)))
    }
}

/// The few unknowns that a body moves in.
#[derive(Clone, Debug, PartialEq)]
pub struct ReducedInfo {
    /// Their rows, an origin first.
    pub rows: Range<usize>,
    /// Of a body of modes: the natural frequency of each, rising [Hz].
    pub hertz: Option<Vec<f64>>,
}

/// The laws of a body's cells.
#[derive(Clone, Debug)]
pub struct LawsInfo {
    /// Of the body, then of its regions, each with the name of its region; of none where links have laws of their own.
    pub names: Vec<String>,
    /// Of each cell its number among the names.
    pub of_cell: Vec<u16>,
    /// Of a body that adapts: what takes over in cells which exceed a criterion, by the number of their name.
    pub seconds: Vec<String>,
    /// Names whose laws are texts that run as laws of the table, each with the law.
    texts_of_table: Vec<(String, &'static str)>,
}

impl LawsInfo {
    fn new(spec: &Body, materials: BodyMaterials) -> Self {
        let main = spec.material.iter().map(|law| law.entry.name.to_owned());
        // those without a law or a region have no number either
        let whole = spec.regions.iter().filter(|part| part.region.is_some());
        let parts =
            whole.filter_map(|part| Some(format!("{} ({})", part.material.as_ref()?.entry.name, part.name)));
        let names: Vec<String> = main.chain(parts).collect();
        let of_body = spec.adapt.as_ref().and_then(|adapt| adapt.material.as_ref());
        let with_law = spec.regions.iter().filter(|part| part.region.is_some() && part.material.is_some());
        let seconds: Vec<_> = of_body
            .map(|of_body| {
                let of_parts = with_law.map(|part| part.adapts_to.as_ref().unwrap_or(of_body));
                std::iter::once(of_body).chain(of_parts).collect()
            })
            .unwrap_or_default();
        let BodyMaterials { all, of_cell } = materials;
        let keeps_texts = spec.levels.is_some()
            || spec.frames.is_some()
            || spec.polynomial.is_some()
            || spec.formulation.as_ref().is_some_and(|formulation| keeps_texts(formulation.entry));
        let known = |name: &str, material: &Material| Some((name.to_owned(), material.text_runs_as()?));
        let of_seconds = seconds.iter().zip(&names).filter_map(|(law, name)| {
            let name = match name.split_once(' ') {
                Some((_, part)) => format!("{} {part} (adapt)", law.entry.name),
                None => format!("{} (adapt)", law.entry.name),
            };
            known(&name, &(law.entry.build)(&law.values).ok()?)
        });
        let of_cells = names.iter().zip(&all).filter_map(|(name, material)| known(name, material));
        let texts_of_table = if keeps_texts { Vec::new() } else { of_cells.chain(of_seconds).collect() };
        let seconds = seconds.iter().map(|law| law.entry.name.to_owned()).collect();
        Self { names, of_cell, seconds, texts_of_table }
    }

    /// The names whose laws are texts that run as laws of the table, each with that law: `"hyperelastic (adapt)"` is the second of
    /// cells that adapt.
    pub fn texts_of_table(&self) -> impl Iterator<Item = (&str, &'static str)> {
        self.texts_of_table.iter().map(|(name, law)| (name.as_str(), *law))
    }
}

/// The frames that carry a body.
#[derive(Clone, Debug)]
pub struct FramesInfo {
    /// Row of each frame's origin; the rows of its axes follow.
    pub rows: Vec<u32>,
    /// Origin and axes of each frame at rest, in the order of the rows.
    pub rest: Vec<Vec3>,
    /// How well they serve.
    pub report: FramesReport,
    /// The number of the frame whose weights are shown.
    pub shown: usize,
    /// Of each point of the mesh, the frames that carry it and their weights.
    weights: Vec<Vec<(u32, f64)>>,
}

impl FramesInfo {
    pub fn count(&self) -> usize {
        self.rows.len()
    }

    /// The weight of the frame that is shown, of a point of the mesh.
    pub fn influence(&self, point: usize) -> f64 {
        let of_shown = |(frame, _): &&(u32, f64)| *frame as usize == self.shown;
        self.weights[point].iter().find(of_shown).map_or(0.0, |(_, weight)| *weight)
    }
}

/// What tools leave on the surface of a body, and where it is in the state.
#[derive(Clone, Debug)]
pub struct MarksInfo {
    pub body: String,
    /// Index of its field.
    pub field: usize,
    pub marks: Arc<Marks>,
}

impl MarksInfo {
    fn state<'a>(&self, world: &'a World) -> &'a FieldState {
        &world.state().fields[self.field]
    }

    /// What was done to a point of the body; `None` inside.
    pub fn mark_at(&self, point: usize, world: &World) -> Option<Mark> {
        self.marks.mark_at(point, self.state(world))
    }

    /// How a point of the body looks beneath its blood: 1 where it is white, 0 as it was and inside, -1 where it is charred.
    pub fn look_at(&self, point: usize, world: &World) -> f64 {
        self.marks.look_at(point, self.state(world))
    }
}

/// A display surface of a body with levels, and where it is in the state.
#[derive(Clone, Debug)]
pub struct DressInfo {
    pub body: String,
    /// Index of its field.
    pub field: usize,
    pub dress: Arc<Dress>,
    /// What tools leave on the surface of the body that wears it.
    pub marks: Option<CarriedMarks>,
}

/// What tools leave on the surface of a body, carried over to one that it wears.
#[derive(Clone, Debug)]
pub struct CarriedMarks {
    pub marks: MarksInfo,
    /// Of each node of the dress, points of the body and their weights: the corners of the triangle of the body's surface that is
    /// nearest to it at rest, and where that is nearest.
    pub places: Arc<[[(u32, f64); 3]]>,
}

impl CarriedMarks {
    /// What was done where a node is.
    pub fn mark_at(&self, node: usize, world: &World) -> Mark {
        let mut sum = Mark::default();
        for (point, weight) in self.places[node] {
            let mark = self.marks.mark_at(point as usize, world).unwrap_or_default();
            sum.whitening += weight * mark.whitening;
            sum.dose += weight * mark.dose;
            sum.blood += weight * mark.blood;
            sum.blood_volume += weight * mark.blood_volume;
        }
        sum
    }

    /// How a node looks beneath its blood, as [`MarksInfo::look_at`].
    pub fn look_at(&self, node: usize, world: &World) -> f64 {
        let look = |(point, weight): (u32, f64)| weight * self.marks.look_at(point as usize, world);
        self.places[node].into_iter().map(look).sum()
    }
}

impl DressInfo {
    fn state<'a>(&self, world: &'a World) -> &'a FieldState {
        &world.state().fields[self.field]
    }

    /// Where its nodes are [m].
    pub fn points(&self, world: &World) -> Vec<Vec3> {
        self.dress.points(self.state(world)).collect()
    }

    /// Of each node, the level that it hangs on.
    pub fn levels(&self, world: &World) -> Vec<f64> {
        self.dress.levels(self.state(world)).map(|level| level as f64).collect()
    }

    /// The most that a node has jumped in a period because levels changed [m].
    pub fn greatest_jump(&self, world: &World) -> f64 {
        self.dress.greatest_jump(self.state(world))
    }
}

/// A skin and where it is in the state.
#[derive(Clone)]
pub struct SkinInfo {
    pub name: String,
    /// Index of its field.
    pub field: usize,
    pub skin: Arc<Skin>,
    /// Formats that its surface is written in beside VTU, by their extensions.
    pub formats: Vec<String>,
}

impl fmt::Debug for SkinInfo {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("SkinInfo")
            .field("name", &self.name)
            .field("field", &self.field)
            .finish_non_exhaustive()
    }
}

impl SkinInfo {
    /// The skin as committed.
    pub fn view<'a>(&self, world: &'a World) -> souple_skin::View<'a> {
        self.skin.view(&world.state().fields[self.field])
    }

    /// Its surface as committed, with normals.
    pub fn surface(&self, world: &World) -> (Polygons, Vec<Vec3>) {
        self.surface_in(&world.state().fields[self.field])
    }

    /// Its surface in a state of its field, with normals.
    pub fn surface_in(&self, state: &FieldState) -> (Polygons, Vec<Vec3>) {
        souple_skin::surface_of(self.skin.view(state).grid, &self.skin.lattice)
    }

    /// The greatest distance of its surface from that of its target [m]; `None` without one.
    pub fn distance(&self, world: &World) -> Option<f64> {
        let rows = world.committed_rows();
        self.skin.distance(&Moment { time: world.time(), rows: &rows }, &world.state().fields[self.field])
    }

    /// What a step from the committed state takes.
    ///
    /// # Errors
    /// The step cannot be made.
    pub fn cost(&self, world: &World) -> Result<souple_skin::Cost, SkinError> {
        let (rows, period) = (world.committed_rows(), world.model().period);
        let end = Moment { time: world.time() + period, rows: &rows };
        self.skin.cost(&end, period, &world.state().fields[self.field])
    }

    /// What its grid will not see of its target in so much time [s], in words.
    pub fn doubts(&self, world: &World, duration: f64) -> Vec<String> {
        self.skin.doubts(&world.committed_rows(), duration)
    }
}

/// A hand with a tool, and what a loop at its device needs to know.
#[derive(Clone, Debug)]
pub struct HandInfo {
    pub name: String,
    /// Index of its system.
    pub system: usize,
    /// Name of its tool's force.
    pub force: String,
    pub device: DeviceChoice,
    pub port: Port,
    pub between: Between,
}

impl HandInfo {
    /// As committed.
    pub fn of(&self, world: &World) -> InHand {
        let force = world.force_named(self.system, &self.force);
        force.and_then(|(force, at)| force.in_hand(&at)).unwrap_or_default()
    }
}

/// Who does what in the body of a force; `None` where it has no levels.
pub fn census(world: &World, system: usize, force: &str) -> Option<Census> {
    let of = &world.model().systems[system];
    let (index, levels) = levels(world, system, force)?;
    let memory = of.memory_ranges()[index].clone();
    Some(levels.census(&world.state().systems[system].memory[memory], world.scratch(system, index)))
}

/// Rows of the active points of the body of a force, each with what its criterion compares with its thresholds; none where it has no levels.
pub(crate) fn variation(world: &World, system: usize, force: &str) -> Vec<(u32, f64)> {
    let Some((index, levels)) = levels(world, system, force) else { return Vec::new() };
    let memory = world.model().systems[system].memory_ranges()[index].clone();
    let memory = &world.state().systems[system].memory[memory];
    levels.variation(&world.rows(system).positions, memory, world.scratch(system, index))
}

/// What a step of the body of a force has to do with the points that are active; `None` where it has no levels.
pub(crate) fn workload(world: &World, system: usize, force: &str) -> Option<Workload> {
    let of = &world.model().systems[system];
    let (index, levels) = levels(world, system, force)?;
    let (division, schedule) = of.stepper.ticks(world.model().timestep(system))?;
    let memory = of.memory_ranges()[index].clone();
    let memory = &world.state().systems[system].memory[memory];
    let evaluations = levels.workload(&division, memory, world.scratch(system, index));
    Some(Workload { evaluations, schedule })
}

/// The meshes of the body of a force, and its number in its system; `None` where it has one mesh.
fn levels<'a>(world: &'a World, system: usize, force: &str) -> Option<(usize, &'a dyn Levels)> {
    let forces = &world.model().systems[system].forces;
    let index = forces.iter().position(|candidate| candidate.name() == force)?;
    Some((index, forces[index].levels()?))
}

impl BodyInfo {
    /// Whether its points are the masses of a network.
    pub fn is_network(&self) -> bool {
        !self.radii.is_empty()
    }

    /// Of each point of its mesh: the level at work there, where the body has levels.
    pub fn level_of_point(&self, world: &World) -> Option<Vec<u32>> {
        Some(census(world, self.system, &self.force)?.level_of_point)
    }

    /// Rows that are moved to move it: origins of its frames or of that of its modes, points of all its meshes, or its own.
    pub fn moving_rows(&self, world: &World) -> Vec<u32> {
        if let Some(frames) = &self.frames {
            return frames.rows.clone();
        }
        if let Some(reduced) = &self.reduced {
            return vec![reduced.rows.start as u32];
        }
        if let Some(own) = &self.own {
            return own.rows().collect();
        }
        let levels = levels(world, self.system, &self.force);
        let rows = levels.map_or_else(|| self.rows.clone(), |(_, levels)| levels.rows());
        (rows.start as u32..rows.end as u32).collect()
    }

    /// The row of the unknown that a point is; `None` where it hangs on another body, or frames or modes carry it.
    pub fn own_row(&self, point: u32) -> Option<u32> {
        match &self.own {
            Some(own) => own.row_of(point),
            None => {
                let is_carried = self.frames.is_some() || self.reduced.is_some();
                (!is_carried).then_some(self.rows.start as u32 + point)
            }
        }
    }

    /// The point that a row is, of an unknown or of its own.
    pub fn point_of(&self, row: u32) -> Option<u32> {
        let of_unknown = self.own.as_ref().and_then(|own| own.point_of(row));
        of_unknown.or_else(|| self.rows.contains(&(row as usize)).then(|| row - self.rows.start as u32))
    }

    /// How many of its points hang on other bodies.
    pub fn hanging_count(&self) -> usize {
        self.own.as_ref().map_or(0, |own| self.rows.len() - own.points().len())
    }

    /// Whether a cell of the mesh carries something at a time of the world [s].
    pub fn is_whole(&self, cell: usize, time: f64) -> bool {
        self.cut_at.get(cell).is_none_or(|cut| *cut > time)
    }

    /// How many meshes it has, where it has levels.
    pub fn level_count(&self, world: &World) -> Option<usize> {
        Some(census(world, self.system, &self.force)?.active.len())
    }

    pub(crate) fn new(placed: Placed, radii: Vec<f64>, contours: Vec<ContourInfo>, cut_at: Vec<f64>) -> Self {
        let Placed { spec, system, rows, mesh, frames, reduced, materials, hanging, .. } = placed;
        let laws = LawsInfo::new(spec, materials);
        let surface = mesh.opening_surface(&cut_at);
        let force = crate::compile::solid_name(&spec.name);
        let shown = spec.frames.as_ref().map_or(0, |frames| frames.shown);
        let frames = frames.map(|frames| {
            let weights = |carried: &Carried| {
                carried.frames.iter().zip(&carried.rows).map(|(frame, [(w, _), ..])| (*frame, *w)).collect()
            };
            let is_affine = frames.kind == UnknownKind::AffineFrame;
            FramesInfo {
                report: FramesReport::new(&frames.frames, &frames.samples, &frames.carried, is_affine),
                shown,
                weights: frames.carried_points.iter().map(weights).collect(),
                rest: frames.configuration().collect(),
                rows: frames.rows,
            }
        });
        let reduced = reduced.map(|reduced| {
            let hertz = |eigenvalues: &[f64]| eigenvalues.iter().map(|square| square.sqrt() / TAU).collect();
            ReducedInfo { rows: reduced.row_range(), hertz: reduced.eigenvalues().map(hertz) }
        });
        let name = spec.name.clone();
        let own = hanging.map(|hanging| hanging.own);
        let mesh = Arc::new(mesh);
        Self {
            name,
            system,
            rows,
            own,
            mesh,
            surface,
            cut_at,
            force,
            laws,
            frames,
            reduced,
            dress: None,
            marks: None,
            texture: None,
            radii,
            contours,
            faces: None,
        }
    }
}

/// Reads and compiles a scene file; `overrides` are `path=value`.
///
/// # Errors
/// Everything that is wrong with it.
pub fn read_file(path: &Path, overrides: &[String]) -> Result<Scene, Diagnostics> {
    read(Library::default(), overrides, |includer| includer.read_file(path, None), |_| ())
}

/// What carries a body of frames in place of the frames that its scene gives it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Carriers {
    /// The points of its mesh.
    Mesh,
    /// So many times as many frames.
    Frames(f64),
}

/// The same with other carriers of one body, to compare them; none of them follows a bone, since a mesh has nothing that would be led
/// as a frame is.
///
/// # Errors
/// Everything that is wrong with it then.
pub fn read_file_with_carriers(
    path: &Path,
    overrides: &[String],
    body: &str,
    carriers: Carriers,
) -> Result<Scene, Diagnostics> {
    let change = |spec: &mut Spec| {
        // what is measured may ask for the very frames that are gone
        spec.probes.clear();
        spec.expects.clear();
        spec.sounds.clear();
        for body in spec.bodies.iter_mut().filter(|other| other.name == body) {
            match carriers {
                Carriers::Mesh => body.frames = None,
                Carriers::Frames(times) => {
                    if let Some(frames) = &mut body.frames {
                        frames.bones.clear();
                        frames.multiply(times);
                    }
                }
            }
        }
    };
    read(Library::default(), overrides, |includer| includer.read_file(path, None), change)
}

/// A control whose commands are planned.
#[derive(Clone, Debug)]
pub struct PlannedControl {
    /// `BODY.CONTROL`
    pub name: String,
    /// Where its command stands among the driven parameters of State.
    pub driven: usize,
    /// Magnitude that its actuator gives at most [N].
    pub largest: f64,
    /// Its network, whose masses its gains may be of, with their system and their rows there.
    pub body: String,
    pub system: usize,
    pub rows: Range<usize>,
    pub by: Planned,
}

impl PlannedControl {
    /// The number that is called `BODY[MASS].x`, or `BODY[MASS].v.x` of a velocity, of a mass of its network.
    pub fn number(&self, name: &str) -> Option<NumberOfMass> {
        crate::compile::number_of(&self.body, &self.rows, name)
    }
}

/// What commands of a control are planned by.
#[derive(Clone, Debug)]
pub enum Planned {
    /// The time.
    Time,
    /// The state of its network.
    State(StateSpace),
}

/// The same without the files of planned commands, which there need not be yet, and the controls that would read them: they command nothing.
///
/// # Errors
/// Everything else that is wrong with it.
pub fn read_file_to_plan(
    path: &Path,
    overrides: &[String],
) -> Result<(Scene, Vec<PlannedControl>), Diagnostics> {
    let mut planned: Vec<PlannedControl> = Vec::new();
    let change = |spec: &mut Spec| {
        for body in &mut spec.bodies {
            let Some(network) = &mut body.network else { continue };
            for index in 0..network.controls.len() {
                let control = &mut network.controls[index];
                match &mut control.drives {
                    Some(Drives::Plan { .. }) => {
                        control.drives = Some(Drives::Command(Formula::constant(0.0)));
                    }
                    Some(Drives::Table { file, .. }) => *file = None,
                    _ => continue,
                }
                let control = &network.controls[index];
                planned.push(PlannedControl {
                    name: format!("{}.{}", body.name, control.name),
                    driven: 0,
                    largest: network.largest(control.of.name()),
                    body: body.name.clone(),
                    system: 0,
                    rows: 0..0,
                    by: Planned::Time,
                });
            }
        }
    };
    let scene = read(Library::default(), overrides, |includer| includer.read_file(path, None), change)?;
    for control in &mut planned {
        let found = scene.model.controls.iter().find(|other| other.name() == control.name);
        control.driven = found.map_or(0, |found| found.driven());
        if let Some(body) = scene.bodies.iter().find(|body| body.name == control.body) {
            (control.system, control.rows) = (body.system, body.rows.clone());
        }
        let mut spaces = scene.networks.iter().flat_map(|network| &network.state_spaces);
        if let Some(space) = spaces.find(|space| space.control == control.name) {
            control.by = Planned::State(space.clone());
        }
    }
    Ok((scene, planned))
}

/// The same from a text; files it names are relative to `folder`, and messages call it `name`.
///
/// # Errors
/// Everything that is wrong with it.
pub fn read_text(name: &str, text: &str, folder: &Path, overrides: &[String]) -> Result<Scene, Diagnostics> {
    let source = Source { name: name.to_owned(), folder: PathBuf::from(folder), text: text.to_owned() };
    read(Library::default(), overrides, |includer| Some(includer.read_text(source)), |_| ())
}

/// The same of a text whose files, such as plans and meshes that are texts, are at hand too: names of files, as the text has them, with their texts.
///
/// # Errors
/// Everything that is wrong with it.
pub fn read_text_with_files(
    name: &str,
    text: &str,
    files: &[(&str, &str)],
    overrides: &[String],
) -> Result<Scene, Diagnostics> {
    let folder = PathBuf::from(".");
    let texts = files.iter().map(|(file, text)| (folder.join(file), (*text).to_owned())).collect();
    let library = Library { texts, ..Library::default() };
    let source = Source { name: name.to_owned(), folder, text: text.to_owned() };
    read(library, overrides, |includer| Some(includer.read_text(source)), |_| ())
}

/// Reads a scene again from what it was read from before, wherever that is now: texts are taken from `inputs`, other
/// files from `places` (the path of each in `inputs` to where it is), or from where they were.
///
/// # Errors
/// Everything that is wrong with it.
pub fn read_again(inputs: &Inputs, places: BTreeMap<PathBuf, PathBuf>) -> Result<Scene, Diagnostics> {
    let mut texts = inputs.texts.iter();
    let first = texts.next().cloned().unwrap_or_default();
    let library = Library {
        texts: texts.map(|text| (PathBuf::from(&text.name), text.text.clone())).collect(),
        files: places,
    };
    let source = Source { name: first.name, folder: first.folder, text: first.text };
    read(library, &inputs.settings, |includer| Some(includer.read_text(source)), |_| ())
}

/// What a text says, with what it includes, checked key by key; nothing is built. For editors and for asking a scene
/// what it would cost.
///
/// # Errors
/// What is wrong with its keys and values; meshes, regions and what else needs building is not looked at.
pub fn read_spec(name: &str, text: &str, folder: &Path, overrides: &[String]) -> Result<Spec, Diagnostics> {
    let source = Source { name: name.to_owned(), folder: PathBuf::from(folder), text: text.to_owned() };
    let (mut sources, log) = (Sources::default(), Log::default());
    let document = Includer::new(&mut sources, &log).read_text(source);
    match specify(document, overrides, &mut sources, &log) {
        Some(spec) if log.is_empty() => Ok(spec),
        _ => Err(log.into_diagnostics(&sources)),
    }
}

/// The specification of a document with overrides and parameters put in; `None` for a text that is no TOML, which would
/// only give a hail of missing keys.
fn specify(mut document: Table, overrides: &[String], sources: &mut Sources, log: &Log) -> Option<Spec> {
    if !log.is_empty() {
        return None;
    }
    overrides::apply(&mut document, overrides, sources, log);
    let modules = document.remove("modules");
    let parameters = parameters::substitute(&mut document, log);
    modules::expand(&mut document, modules, &parameters, sources, log);
    Some(Spec::read(document, 0, log))
}

fn read(
    library: Library,
    overrides: &[String],
    load: impl FnOnce(&mut Includer) -> Option<Table>,
    change: impl FnOnce(&mut Spec),
) -> Result<Scene, Diagnostics> {
    let (mut sources, log) = (Sources::with_library(library), Log::default());
    let document = load(&mut Includer::new(&mut sources, &log));
    let spec = document.and_then(|document| specify(document, overrides, &mut sources, &log));
    let scene = spec.and_then(|mut spec| {
        change(&mut spec);
        compile(&spec, &sources, &log)
    });
    match scene {
        Some(scene) if log.is_empty() => Ok(Scene { inputs: sources.into_inputs(overrides), ..scene }),
        _ => Err(log.into_diagnostics(&sources)),
    }
}
