//! From a specification to a model and a state.

mod bodies;
mod boundary;
mod contact;
mod links;
mod motion;
mod selection;
mod shape;

pub(crate) use bodies::solid_name;

use std::collections::BTreeSet;

use sha2::{Digest, Sha256};
use souple_engine::{Model, State, System};

use crate::diagnostic::{Code, Log, Site};
use crate::measure::ProbeInfo;
use crate::scene::{BodyInfo, Scene};
use crate::source::Sources;
use crate::spec::Spec;
use crate::spec::world::SystemSpec;

use bodies::Placed;
use selection::Selector;

/// What is being put together: the bodies with their places, and one draft for each system.
pub(crate) struct Draft<'a> {
    pub spec: &'a Spec,
    pub log: &'a Log,
    /// In the order of the specification.
    pub bodies: Vec<Placed<'a>>,
    pub systems: Vec<System>,
    pub model: Model,
    pub state: State,
    pub warnings: Vec<String>,
}

impl Draft<'_> {
    pub fn body(&self, name: &str) -> Option<&Placed<'_>> {
        self.bodies.iter().find(|body| body.spec.name == name)
    }

    /// What selects the points and cells of a body.
    pub fn selector<'b>(&'b self, body: &'b Placed<'_>) -> Selector<'b> {
        Selector {
            body: &body.spec.name,
            mesh: &body.mesh,
            point_numbers: &body.point_numbers,
            log: self.log,
        }
    }
}

/// Builds a scene; what is wrong goes to the log, and nothing comes back then.
pub fn compile(spec: &Spec, sources: &Sources, log: &Log) -> Option<Scene> {
    if !log.is_empty() {
        return None;
    }
    let mut hash = Sha256::new();
    for source in sources.iter() {
        hash.update((source.text.len() as u64).to_le_bytes());
        hash.update(&source.text);
    }
    let mut warnings = Vec::new();
    let bodies = bodies::place(spec, sources, &mut hash, &mut warnings, log)?;
    let model = Model { period: spec.world.period, ..Model::default() };
    let mut draft =
        Draft { spec, log, bodies, systems: Vec::new(), model, state: State::default(), warnings };
    for (index, system) in spec.systems.iter().enumerate() {
        let system = bodies::system(&draft, index, system)?;
        draft.systems.push(system);
    }
    boundary::add_loads(&mut draft);
    boundary::add_pins(&mut draft);
    contact::add(&mut draft, sources);
    links::attach(&mut draft);
    links::couple(&mut draft);
    check_force_names(&draft);
    let probes: Vec<ProbeInfo> =
        spec.probes.iter().filter_map(|probe| ProbeInfo::compile(probe, &draft)).collect();
    if !log.is_empty() {
        return None;
    }
    for (system, spec) in draft.systems.iter().zip(&spec.systems) {
        check_stepper(system, spec, log);
        let state = bodies::initial_state(&draft, system, draft.state.systems.len());
        draft.state.systems.push(state);
    }
    if !log.is_empty() {
        return None;
    }
    let Draft { bodies, systems, mut model, state, warnings, .. } = draft;
    model.systems = systems;
    let scene_sha256 = hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect();
    let bodies =
        bodies.into_iter().map(|body| BodyInfo::new(&body.spec.name, body.system, body.rows, body.mesh));
    Some(Scene {
        title: spec.title.clone(),
        description: spec.description.clone(),
        shows: spec.shows.clone(),
        bodies: bodies.collect(),
        model,
        state,
        probes,
        expects: spec.expects.clone(),
        run: spec.run,
        scene_sha256,
        warnings,
    })
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
    if let Some(why) = system.stepper.refuses(system) {
        let site: &Site = spec.stepper.as_ref().map_or(&spec.site, |stepper| &stepper.site);
        let message = format!("`{}` cannot step system `{}`: {why}", system.stepper.name(), system.name);
        log.add(Code::Conflict, site, message, "another stepper, or a system without what stands in its way");
    }
}
