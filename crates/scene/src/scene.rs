//! A scene ready to run, and how to come by one.

use std::ops::Range;
use std::path::{Path, PathBuf};

use souple_engine::{Model, State};
use souple_mesh::{Mesh, TriangleSurface};

use crate::compile::compile;
use crate::diagnostic::{Diagnostics, Log};
use crate::document::Table;
use crate::include::Includer;
use crate::measure::ProbeInfo;
use crate::source::{Source, Sources};
use crate::spec::Spec;
use crate::spec::probe::Expect;
use crate::spec::world::RunSpec;
use crate::{overrides, parameters};

/// A model and its first state, with what is measured and expected.
pub struct Scene {
    pub title: String,
    pub description: String,
    /// Ids of the capabilities it shows.
    pub shows: Vec<String>,
    pub model: Model,
    pub state: State,
    pub bodies: Vec<BodyInfo>,
    pub probes: Vec<ProbeInfo>,
    pub expects: Vec<Expect>,
    pub run: RunSpec,
    /// Of the texts, overrides and mesh files it was made from.
    pub scene_sha256: String,
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
    /// At rest, placed; point `i` is row `rows.start + i`.
    pub mesh: Mesh,
    /// The boundary of the mesh.
    pub surface: TriangleSurface,
    /// Name of its elastic force.
    pub force: String,
}

impl BodyInfo {
    pub(crate) fn new(name: &str, system: usize, rows: Range<usize>, mesh: Mesh) -> Self {
        let surface = mesh.boundary_surface();
        let force = crate::compile::solid_name(name);
        Self { name: name.to_owned(), system, rows, mesh, surface, force }
    }
}

/// Reads and compiles a scene file; `overrides` are `path=value`.
///
/// # Errors
/// Everything that is wrong with it.
pub fn read_file(path: &Path, overrides: &[String]) -> Result<Scene, Diagnostics> {
    read(overrides, |includer| includer.read_file(path, None))
}

/// The same from a text; files it names are relative to `folder`, and messages call it `name`.
///
/// # Errors
/// Everything that is wrong with it.
pub fn read_text(name: &str, text: &str, folder: &Path, overrides: &[String]) -> Result<Scene, Diagnostics> {
    let source = Source { name: name.to_owned(), folder: PathBuf::from(folder), text: text.to_owned() };
    read(overrides, |includer| Some(includer.read_text(source)))
}

fn read(
    overrides: &[String],
    load: impl FnOnce(&mut Includer) -> Option<Table>,
) -> Result<Scene, Diagnostics> {
    let (mut sources, log) = (Sources::default(), Log::default());
    let document = load(&mut Includer::new(&mut sources, &log));
    let mut scene = None;
    // a text that is no TOML would only give a hail of missing keys
    if let Some(mut document) = document.filter(|_| log.is_empty()) {
        overrides::apply(&mut document, overrides, &mut sources, &log);
        parameters::substitute(&mut document, &log);
        let spec = Spec::read(document, 0, &log);
        scene = compile(&spec, &sources, &log);
    }
    match scene {
        Some(scene) if log.is_empty() => Ok(scene),
        _ => Err(log.into_diagnostics(&sources)),
    }
}
