//! Runs of scenes, which several cases may read.

use std::collections::HashMap;
use std::rc::Rc;

use souple_run::{Control, Options, Report, Trace};
use souple_scene::Scene;

use crate::row::Problem;
use crate::scenes;

/// What a run follows from.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) struct RunKey {
    pub scene: &'static str,
    /// `path=value`
    pub settings: Vec<&'static str>,
    /// World periods; the scene's duration where `None`.
    pub steps: Option<u64>,
}

/// What came of a run.
pub(crate) struct Finished {
    pub report: Report,
    pub traces: Vec<Trace>,
}

/// Runs that were made: each is made once.
#[derive(Default)]
pub(crate) struct Runs(HashMap<RunKey, Result<Rc<Finished>, Problem>>);

impl RunKey {
    /// # Errors
    /// The scene is refused.
    pub fn scene(&self) -> Result<Scene, Problem> {
        let name = self.scene;
        let text = scenes::text(name).ok_or_else(|| format!("there is no scene `{name}`"))?;
        let settings: Vec<String> = self.settings.iter().map(|setting| (*setting).to_owned()).collect();
        let read = souple_scene::read_text_with_files(name, text, &scenes::files(name), &settings);
        Ok(read.map_err(|diagnostics| diagnostics.to_string())?)
    }

    /// # Errors
    /// The scene is refused, or cannot be run.
    pub fn run(&self) -> Result<Finished, Problem> {
        let options = Options { steps: self.steps, scene_name: self.scene.to_owned(), ..Options::default() };
        let outcome = souple_run::run(self.scene()?, &options, &mut |_| Control::Continue);
        let outcome = outcome.map_err(|error| error.to_string())?;
        Ok(Finished { report: outcome.report, traces: outcome.traces })
    }
}

impl Runs {
    /// # Errors
    /// The scene is refused, or cannot be run.
    pub fn of(&mut self, key: &RunKey) -> Result<Rc<Finished>, Problem> {
        self.0.entry(key.clone()).or_insert_with(|| key.run().map(Rc::new)).clone()
    }
}
