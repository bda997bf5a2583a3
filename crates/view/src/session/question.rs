//! What may be downloaded of the world.

use serde_json::Value;
use souple_run::{Recording, Status};

use super::stage::Stage;

/// A thing to download.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Question {
    Report,
    Recording,
    Snapshot,
}

/// A download, ready or still to be written: the world does not wait for that.
pub enum Answered {
    Ready(Answer),
    Recording { recording: Box<Recording>, save_as: String },
}

impl Answered {
    pub fn write(self) -> Answer {
        match self {
            Self::Ready(answer) => answer,
            Self::Recording { recording, save_as } => {
                // files are named from where the program runs
                let document = recording.to_json(std::path::Path::new(""));
                Answer { save_as: Some(save_as), ..Answer::json(&document) }
            }
        }
    }
}

/// What a client gets.
pub struct Answer {
    pub kind: String,
    pub content: Vec<u8>,
    pub save_as: Option<String>,
}

impl Answer {
    pub fn new(kind: &str, content: Vec<u8>) -> Self {
        Self { kind: kind.to_owned(), content, save_as: None }
    }

    pub fn json(document: &Value) -> Self {
        Self::new("application/json", format!("{document:#}\n").into_bytes())
    }
}

impl Question {
    pub fn of_path(path: &str) -> Option<Self> {
        match path {
            "/report" => Some(Self::Report),
            "/recording" => Some(Self::Recording),
            "/snapshot" => Some(Self::Snapshot),
            _ => None,
        }
    }
}

impl Stage {
    pub fn answer(&mut self, question: Question) -> Answered {
        let name = self.short_name();
        let period = self.session().world.state().period;
        match question {
            Question::Report => {
                let failed = self.session().failure.is_some();
                let status = if failed { Status::Failed } else { Status::Interrupted };
                let document = self.session_mut().report(status).to_json();
                let save_as = Some(format!("{name}_{period}_report.json"));
                Answered::Ready(Answer { save_as, ..Answer::json(&document) })
            }
            Question::Recording => {
                let recording = Box::new(self.session().recording());
                Answered::Recording { recording, save_as: format!("{name}_{period}.recording") }
            }
            Question::Snapshot => {
                let content = self.session().snapshot();
                let save_as = Some(format!("{name}_{period:08}.souple"));
                Answered::Ready(Answer { save_as, ..Answer::new("application/octet-stream", content) })
            }
        }
    }
}
