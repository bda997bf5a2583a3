//! What may be downloaded of the world.

use serde_json::Value;
use souple_run::Status;

use super::stage::Stage;
use crate::http::Rejection;

/// A thing to download.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Question {
    Report,
    Recording,
    Snapshot,
}

/// A download.
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
    pub fn answer(&mut self, question: Question) -> Result<Answer, Rejection> {
        let name = self.short_name();
        let period = self.session().world.state().period;
        Ok(match question {
            Question::Report => {
                let failed = self.session().failure.is_some();
                let status = if failed { Status::Failed } else { Status::Interrupted };
                Answer::json(&self.session_mut().report(status).to_json())
            }
            Question::Recording => {
                // files are named from where the program runs
                let recording = self.session().recording().to_json(std::path::Path::new(""));
                let save_as = Some(format!("{name}_{period}.recording"));
                Answer { save_as, ..Answer::json(&recording) }
            }
            Question::Snapshot => {
                let content = self.session().snapshot();
                let save_as = Some(format!("{name}_{period:08}.souple"));
                Answer { save_as, ..Answer::new("application/octet-stream", content) }
            }
        })
    }
}
