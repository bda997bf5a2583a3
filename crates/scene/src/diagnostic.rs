//! What is wrong with a scene: place, value, what would be accepted.
//!
//! Everything wrong is collected in a [`Log`] as [`Fault`]s; at the end they become [`Diagnostic`]s with file, line
//! and column, for people ([`Diagnostics`] displays itself) and for programs ([`Diagnostics::to_json`]).

use std::cell::RefCell;
use std::fmt;

use crate::overrides;
use crate::source::{Place, Sources};

/// The kind of a fault, for programs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Code {
    NotFound,
    Unreadable,
    NotText,
    Syntax,
    Format,
    CyclicInclude,
    UnknownKey,
    MissingKey,
    WrongType,
    WrongUnit,
    OutOfRange,
    UnknownName,
    UnknownParameter,
    UnknownPath,
    BadFormula,
    BadName,
    BadOverride,
    Mesh,
    NotFinite,
    EmptyRegion,
    Conflict,
    TooLarge,
}

impl Code {
    pub fn as_str(self) -> &'static str {
        match self {
            Self::NotFound => "not_found",
            Self::Unreadable => "unreadable",
            Self::NotText => "not_text",
            Self::Syntax => "syntax",
            Self::Format => "format",
            Self::CyclicInclude => "cyclic_include",
            Self::UnknownKey => "unknown_key",
            Self::MissingKey => "missing_key",
            Self::WrongType => "wrong_type",
            Self::WrongUnit => "wrong_unit",
            Self::OutOfRange => "out_of_range",
            Self::UnknownName => "unknown_name",
            Self::UnknownParameter => "unknown_parameter",
            Self::UnknownPath => "unknown_path",
            Self::BadFormula => "bad_formula",
            Self::BadName => "bad_name",
            Self::BadOverride => "bad_override",
            Self::Mesh => "mesh",
            Self::NotFinite => "not_finite",
            Self::EmptyRegion => "empty_region",
            Self::Conflict => "conflict",
            Self::TooLarge => "too_large",
        }
    }
}

/// Where a value of a scene was written, and its path.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Site {
    pub place: Place,
    /// Such as `bodies.bar.pins[0].region`.
    pub path: String,
}

/// One thing that is wrong.
#[derive(Clone, Debug, PartialEq)]
pub struct Fault {
    pub code: Code,
    pub site: Site,
    /// What was read, where it is not the text at the place.
    pub value: Option<String>,
    pub expected: String,
    pub message: String,
}

/// Collects faults.
#[derive(Debug, Default)]
pub struct Log(RefCell<Vec<Fault>>);

impl Log {
    pub fn add(&self, code: Code, site: &Site, message: impl Into<String>, expected: impl Into<String>) {
        let fault = Fault {
            code,
            site: site.clone(),
            value: None,
            expected: expected.into(),
            message: message.into(),
        };
        self.push(fault);
    }

    /// A fault found twice (by two readers of one value, or by two uses of a parameter) is kept once.
    pub fn push(&self, fault: Fault) {
        let mut faults = self.0.borrow_mut();
        let is_told = |told: &Fault| {
            let is_of_text = fault.site.place.end > fault.site.place.start;
            *told == fault
                || (is_of_text && told.site.place == fault.site.place && told.message == fault.message)
        };
        if !faults.iter().any(is_told) {
            faults.push(fault);
        }
    }

    pub fn is_empty(&self) -> bool {
        self.0.borrow().is_empty()
    }

    pub fn into_diagnostics(self, sources: &Sources) -> Diagnostics {
        let mut faults = self.0.into_inner();
        // as they stand in the texts
        faults.sort_by_key(|fault| (fault.site.place.source, fault.site.place.start));
        Diagnostics(faults.into_iter().map(|fault| Diagnostic::new(fault, sources)).collect())
    }
}

/// A fault with its place spelt out.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagnostic {
    pub code: Code,
    pub file: String,
    /// From 1.
    pub line: usize,
    /// From 1, in characters.
    pub column: usize,
    /// Path of the key; empty for what concerns a file as a whole.
    pub path: String,
    /// What was read.
    pub value: String,
    /// What would be accepted.
    pub expected: String,
    pub message: String,
    /// The line of the file with the place underlined.
    picture: String,
    /// Settings of the command line of parts of what is underlined, whose text says something else.
    settings: Vec<String>,
}

/// All that is wrong with a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagnostics(pub Vec<Diagnostic>);

impl Diagnostic {
    fn new(fault: Fault, sources: &Sources) -> Self {
        let Fault { code, site, value, expected, message } = fault;
        let file = sources.get(site.place.source).name.clone();
        let (line, column) = sources.line_column(site.place);
        let has_place = site.place.end > site.place.start;
        let value = value.unwrap_or_else(|| sources.excerpt(site.place));
        let picture = if has_place { sources.underlined(site.place) } else { String::new() };
        let settings = match overrides::is_one(sources.get(site.place.source)) {
            true => Vec::new(),
            false => overrides::within(&site.path, sources).map(str::to_owned).collect(),
        };
        Self { code, file, line, column, path: site.path, value, expected, message, picture, settings }
    }

    pub fn to_json(&self) -> serde_json::Value {
        serde_json::json!({
            "code": self.code.as_str(),
            "file": self.file,
            "line": self.line,
            "column": self.column,
            "path": self.path,
            "value": self.value,
            "expected": self.expected,
            "message": self.message,
            "settings": self.settings,
        })
    }
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}:{}: ", self.file, self.line, self.column)?;
        if !self.path.is_empty() {
            write!(f, "{}: ", self.path)?;
        }
        write!(f, "{}", self.message)?;
        let gutter = self.line.to_string();
        for (index, line) in self.picture.lines().enumerate() {
            let number = if index == 0 { gutter.clone() } else { " ".repeat(gutter.len()) };
            write!(f, "\n  {number} | {line}")?;
        }
        for setting in &self.settings {
            write!(f, "\n  {} = with --set {setting}", " ".repeat(gutter.len()))?;
        }
        if !self.expected.is_empty() {
            write!(f, "\n  {} = expected {}", " ".repeat(gutter.len()), self.expected)?;
        }
        Ok(())
    }
}

impl Diagnostics {
    /// `{"errors": […]}`.
    pub fn to_json(&self) -> serde_json::Value {
        serde_json::json!({ "errors": self.0.iter().map(Diagnostic::to_json).collect::<Vec<_>>() })
    }
}

impl fmt::Display for Diagnostics {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, diagnostic) in self.0.iter().enumerate() {
            let separator = if index == 0 { "" } else { "\n\n" };
            write!(f, "{separator}{diagnostic}")?;
        }
        Ok(())
    }
}

impl std::error::Error for Diagnostics {}
