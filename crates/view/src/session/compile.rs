//! Scenes are read beside the world, which steps on meanwhile.

use std::collections::VecDeque;
use std::panic::{AssertUnwindSafe, catch_unwind};

use souple_run::Session;
use souple_scene::Scene;

use super::{Input, Inputs};
use crate::catalogue::Catalogue;
use crate::dropped::DroppedFile;
use crate::hub::PageId;

/// What a scene is read for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// To begin anew, with the values that were set.
    Reset,
    /// To begin another of the catalogue.
    Load(String),
    LoadText {
        name: String,
        text: String,
        mesh: Option<DroppedFile>,
    },
    /// To go on with one value changed: `path=value`.
    Set(String),
}

impl Purpose {
    /// The wish that it comes from.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Reset => "reset",
            Self::Load(_) | Self::LoadText { .. } => "load",
            Self::Set(_) => "set",
        }
    }

    /// Two of the same kind, of which the later one counts.
    fn replaces(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Set(new), Self::Set(old)) => {
                new.split_once('=').map(|p| p.0) == old.split_once('=').map(|p| p.0)
            }
            // a value of this scene is none of the next
            (Self::Load(_) | Self::LoadText { .. }, _) => true,
            (Self::Set(_), _) | (_, Self::Set(_)) => false,
            _ => true,
        }
    }
}

/// A scene that was read, or what is wrong with it.
pub struct Compiled {
    pub page: PageId,
    pub purpose: Purpose,
    pub scene: Result<Scene, String>,
}

/// Scenes that may wait to be read.
const WAITING_MAX: usize = 64;

/// Reads one scene at a time, in order.
pub struct Compiler {
    inputs: Inputs,
    busy: Option<Purpose>,
    waiting: VecDeque<(PageId, Purpose)>,
}

impl Compiler {
    pub fn new(inputs: Inputs) -> Self {
        Self { inputs, busy: None, waiting: VecDeque::new() }
    }

    /// What is being done, for the page.
    pub fn busy_with(&self) -> Option<&'static str> {
        self.busy.as_ref().map(Purpose::name)
    }

    /// # Errors
    /// Too much waits already, another scene comes before a value could be set, or the system gives no thread.
    pub fn ask(
        &mut self,
        page: PageId,
        purpose: Purpose,
        session: &Session,
        catalogue: &Catalogue,
    ) -> Result<(), String> {
        let is_load = |purpose: &Purpose| matches!(purpose, Purpose::Load(_) | Purpose::LoadText { .. });
        let mut coming = self.busy.iter().chain(self.waiting.iter().map(|(_, waiting)| waiting));
        if matches!(purpose, Purpose::Set(_)) && coming.any(is_load) {
            return Err("another scene is being read: set it there".to_owned());
        }
        self.waiting.retain(|(_, waiting)| !purpose.replaces(waiting));
        if self.waiting.len() >= WAITING_MAX {
            return Err(format!("{WAITING_MAX} changes wait already; try again when they are made"));
        }
        self.waiting.push_back((page, purpose));
        if self.busy.is_some() { Ok(()) } else { self.next(session, catalogue) }
    }

    /// The one before is done: begins the next, if any waits.
    ///
    /// # Errors
    /// The system gives no thread; what was to be read is dropped.
    pub fn next(&mut self, session: &Session, catalogue: &Catalogue) -> Result<(), String> {
        self.busy = None;
        let Some((page, purpose)) = self.waiting.pop_front() else { return Ok(()) };
        let (inputs, places) = (self.inputs.clone(), session.places().clone());
        let mut texts = session.inputs();
        let path = match &purpose {
            Purpose::Load(name) => catalogue.find(name).map(std::path::Path::to_owned),
            Purpose::Set(setting) => {
                souple_run::put_setting(&mut texts.settings, setting);
                None
            }
            Purpose::Reset | Purpose::LoadText { .. } => None,
        };
        self.busy = Some(purpose.clone());
        let work = move || {
            // whatever becomes of it, the world must hear of it: it waits
            let scene = catch_unwind(AssertUnwindSafe(|| match (&purpose, path) {
                (Purpose::LoadText { name, text, .. }, _) => {
                    souple_scene::read_text(name, text, std::path::Path::new(""), &[])
                }
                (_, Some(path)) => souple_scene::read_file(&path, &[]),
                _ => souple_scene::read_again(&texts, places),
            }));
            let scene = match scene {
                Ok(read) => read.map_err(|diagnostics| in_words(&diagnostics, &purpose)),
                Err(_) => Err("the program failed over this scene: please report it".to_owned()),
            };
            // the world may have ended
            let _ = inputs.send(Input::Compiled(Box::new(Compiled { page, purpose, scene })));
        };
        let spawned = std::thread::Builder::new().name("reader".to_owned()).spawn(work);
        spawned.map(|_| ()).map_err(|error| {
            self.busy = None;
            format!("the system gives no thread to read it: {error}")
        })
    }
}

/// The first fault, and what would be accepted in its place, and where it is in the words of whoever wished: who set a value
/// wrote no line, and who dropped a mesh no scene.
fn in_words(diagnostics: &souple_scene::Diagnostics, purpose: &Purpose) -> String {
    let Some(first) = diagnostics.0.first() else { return diagnostics.to_string() };
    let path = if first.path.is_empty() { String::new() } else { format!("{}: ", first.path) };
    let place = match purpose {
        Purpose::Set(_) => path,
        Purpose::LoadText { name, mesh: Some(_), .. } => format!("{name}: "),
        Purpose::Reset | Purpose::Load(_) | Purpose::LoadText { mesh: None, .. } => {
            format!("{}:{}: {path}", first.file, first.line)
        }
    };
    let expected =
        if first.expected.is_empty() { String::new() } else { format!("; expected {}", first.expected) };
    let more = match diagnostics.0.len() {
        1 => String::new(),
        count => format!(" (and {} more)", count - 1),
    };
    format!("{place}{}{expected}{more}", first.message)
}
