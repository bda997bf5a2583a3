//! From a specification to a model and a state.

mod axes;
mod bending;
mod bodies;
mod bones;
mod boundary;
mod contact;
mod depth;
mod doubts;
mod frames;
mod freedom;
mod hands;
mod hanging;
mod imposing;
mod incompressible;
mod inertial;
mod levels;
mod links;
mod marks;
mod material_fields;
mod memory;
mod modes;
mod motion;
mod network;
mod octree;
mod pins;
mod polynomial;
mod reduced;
mod section;
mod selection;
mod shape;
mod skin_shape;
mod skins;
mod start;
mod texture;
mod tissue;
mod tool_doubts;

pub(crate) use bodies::{BodyMaterials, Placed, solid_name};
pub(crate) use boundary::constant_vector;
pub(crate) use frames::hold_name;
pub use hanging::OwnRows;
pub use network::{FillInfo, LawInfo, NetworkInfo, NumberOfMass, StateSpace, number_of};

use std::collections::BTreeSet;
use std::path::Path;
use std::sync::Arc;

use souple_engine::{Model, State, System};
use souple_haptics::HandTools;

use crate::diagnostic::{Code, Log, Site};
use crate::inputs::Inputs;
use crate::measure::ProbeInfo;
use crate::scene::{BodyInfo, DressInfo, HandInfo, MarksInfo, Scene, SkinInfo};
use crate::source::Sources;
use crate::spec::Spec;
use crate::spec::world::SystemSpec;

use freedom::Joint;
use selection::Selector;

/// What is being put together: the bodies with their places, and one draft for each system.
pub(crate) struct Draft<'a> {
    pub spec: &'a Spec,
    pub sources: &'a Sources,
    pub log: &'a Log,
    /// In the order of the specification.
    pub bodies: Vec<Placed<'a>>,
    pub systems: Vec<System>,
    pub model: Model,
    pub state: State,
    pub warnings: Vec<String>,
    /// What hinders rigid motions besides pins.
    pub joints: Vec<Joint>,
    pub skins: Vec<SkinInfo>,
    pub dresses: Vec<DressInfo>,
    pub marks: Vec<MarksInfo>,
    pub hands: Vec<HandInfo>,
}

impl Draft<'_> {
    pub fn body(&self, name: &str) -> Option<&Placed<'_>> {
        self.bodies.iter().find(|body| body.spec.name == name)
    }

    /// A key and where it is written, for messages about two places.
    pub fn place(&self, site: &Site) -> String {
        let file = &self.sources.get(site.place.source).name;
        let (line, column) = self.sources.line_column(site.place);
        format!("`{}` ({file}:{line}:{column})", site.path)
    }

    /// How long a step of a system is [s].
    pub fn timestep(&self, system: &SystemSpec) -> f64 {
        self.spec.world.period / f64::from(system.steps_per_period)
    }

    /// What selects the points and cells of a body.
    pub fn selector<'b>(&'b self, body: &'b Placed<'_>) -> Selector<'b> {
        Selector {
            body: &body.spec.name,
            mesh: &body.mesh,
            point_numbers: &body.point_numbers,
            section: body.spec.section(),
            log: self.log,
        }
    }
}

/// Builds a scene; what is wrong goes to the log, and nothing comes back then.
pub fn compile(spec: &Spec, sources: &Sources, log: &Log) -> Option<Scene> {
    if !log.is_empty() {
        return None;
    }
    let mut draft = Draft {
        spec,
        sources,
        log,
        bodies: Vec::new(),
        systems: Vec::new(),
        model: Model {
            period: spec.world.period,
            detection: spec.world.detection,
            toolbox: Some(Arc::new(HandTools { period: spec.world.period })),
            ..Model::default()
        },
        state: State::default(),
        warnings: Vec::new(),
        joints: Vec::new(),
        skins: Vec::new(),
        dresses: Vec::new(),
        marks: Vec::new(),
        hands: Vec::new(),
    };
    bones::check(spec, log);
    network::fill_all(&mut draft);
    memory::check_specified(spec, sources, log);
    if !log.is_empty() {
        return None;
    }
    bodies::place(&mut draft)?;
    memory::check_placed(spec, &draft.bodies, log);
    doubts::refuse(&draft);
    if !log.is_empty() {
        return None;
    }
    for (index, system) in spec.systems.iter().enumerate() {
        let system = bodies::system(&draft, index, system)?;
        draft.systems.push(system);
    }
    network::add_controls(&mut draft);
    boundary::add_loads(&mut draft);
    pins::add(&mut draft);
    bending::add(&mut draft);
    skins::add(&mut draft);
    levels::add_dresses(&mut draft);
    marks::add(&mut draft);
    contact::add(&mut draft);
    hands::add(&mut draft);
    links::attach(&mut draft);
    links::couple(&mut draft);
    check_force_names(&draft);
    pins::warn_of_idle(&mut draft);
    network::warn_of_steps(&mut draft);
    network::warn_of_starts(&mut draft);
    network::warn_of_heat(&mut draft);
    doubts::warn(&mut draft);
    reduced::warn(&mut draft);
    levels::warn(&mut draft);
    imposing::warn(&mut draft);
    doubts::warn_of_detection(&mut draft);
    freedom::check(&mut draft);
    let probes: Vec<ProbeInfo> =
        spec.probes.iter().filter_map(|probe| ProbeInfo::compile(probe, &draft)).collect();
    if !log.is_empty() {
        return None;
    }
    for (system, spec) in draft.systems.iter().zip(&spec.systems) {
        check_stepper(system, spec, log);
        let site = spec.stepper.as_ref().map_or(&spec.site, |stepper| &stepper.site);
        if draft.spec.run.monitor.is_some() && !system.stepper.has_inertia() {
            let message = "this stepper moves no masses, and `run.monitor` watches what moves";
            log.add(Code::Conflict, site, message, "a stepper with inertia, or no `run.monitor`");
        }
        if let Some(doubt) = doubts::of_solver(system) {
            draft.warnings.push(format!("{}: {doubt}", draft.place(site)));
        }
        let state = bodies::initial_state(&draft, system, draft.state.systems.len());
        draft.state.systems.push(state);
    }
    if !log.is_empty() {
        return None;
    }
    depth::warn(&mut draft);
    tool_doubts::warn(&mut draft);
    let contours = network::contours(&draft);
    if !log.is_empty() {
        return None;
    }
    let networks = network::networks(&draft);
    let faces = network::faces(&draft);
    let textures: Vec<_> = draft.bodies.iter().map(|body| texture::texture(&draft, body)).collect();
    if !log.is_empty() {
        return None;
    }
    let cuts: Vec<Vec<f64>> = draft.bodies.iter().map(|body| levels::cut_at(&draft, body)).collect();
    let Draft { bodies, systems, mut model, state, warnings, skins, hands, dresses, marks, .. } = draft;
    model.systems = systems;
    let bodies = bodies.into_iter().zip(contours).zip(faces).zip(cuts).zip(textures);
    let bodies = bodies.map(|((((body, contours), faces), cut_at), texture)| {
        let radii = network::radii(&body, spec);
        let dress = dresses.iter().find(|dress| dress.body == body.spec.name).cloned();
        let marks = marks.iter().find(|marks| marks.body == body.spec.name).cloned();
        BodyInfo { dress, marks, texture, faces, ..BodyInfo::new(body, radii, contours, cut_at) }
    });
    Some(Scene {
        title: title(spec, sources),
        description: spec.description.clone(),
        shows: spec.shows.clone(),
        bodies: bodies.collect(),
        networks,
        skins,
        hands,
        model,
        state,
        probes,
        sounds: spec.sounds.clone(),
        expects: spec.expects.clone(),
        adjustables: spec.adjustables(),
        run: spec.run,
        picture: spec.picture_view(),
        scene_sha256: sources.fingerprint(),
        inputs: Inputs::default(),
        warnings,
    })
}

/// The scene's title, or what its file is called.
fn title(spec: &Spec, sources: &Sources) -> String {
    if !spec.title.is_empty() {
        return spec.title.clone();
    }
    let path = Path::new(&sources.get(0).name);
    let folder = path.parent().and_then(Path::file_name).filter(|_| path.ends_with("scene.toml"));
    folder.or(path.file_stem()).unwrap_or_default().to_string_lossy().into_owned()
}

/// Forces are told apart by their names, which contacts may choose.
fn check_force_names(draft: &Draft) {
    for system in &draft.systems {
        let mut names = BTreeSet::new();
        for force in &system.forces {
            let name = force.name();
            if !names.insert(name) {
                let contact = draft.spec.contacts.iter().rev().find(|contact| contact.name == name);
                let site = contact.map_or(&draft.spec.world.site, |contact| &contact.site);
                let message = format!("there are two forces `{name}` in system `{}`", system.name);
                draft.log.add(Code::Conflict, site, message, "names that differ");
            }
        }
    }
}

fn check_stepper(system: &System, spec: &SystemSpec, log: &Log) {
    if let Some(why) = system.refused() {
        let site: &Site = spec.stepper.as_ref().map_or(&spec.site, |stepper| &stepper.site);
        let message = format!("`{}` cannot step system `{}`: {why}", system.stepper.name(), system.name);
        log.add(Code::Conflict, site, message, "another stepper, or a system without what stands in its way");
    }
}
