//! Texts a scene is read from, and places in them.

use std::cell::RefCell;
use std::path::{Path, PathBuf};

use crate::inputs::{InputFile, InputText, Inputs, Library, fingerprint, sha256};

/// One text: a file, or an override from the command line.
#[derive(Clone, Debug)]
pub struct Source {
    /// As shown in messages: the path as given.
    pub name: String,
    /// Files named in this text are relative to this folder.
    pub folder: PathBuf,
    pub text: String,
}

/// All texts of a scene, in the order they were read, and the other files it was made from.
#[derive(Clone, Debug, Default)]
pub struct Sources {
    texts: Vec<Source>,
    /// How many of them, the last, are of the catalogue and not of the scene.
    of_catalogue: usize,
    files: RefCell<Vec<InputFile>>,
    library: Library,
}

/// Characters shown on either side of a place in a long line.
const WINDOW: usize = 60;

/// Bytes `start..end` of a source.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Place {
    pub source: usize,
    pub start: usize,
    pub end: usize,
}

impl Place {
    /// The start of a source, for what is wrong with it as a whole.
    pub fn start_of(source: usize) -> Self {
        Self { source, start: 0, end: 0 }
    }
}

impl Sources {
    /// No texts yet; what they name is looked up in a library first.
    pub(crate) fn with_library(library: Library) -> Self {
        Self { library, ..Self::default() }
    }

    pub fn add(&mut self, source: Source) -> usize {
        self.texts.push(source);
        self.texts.len() - 1
    }

    /// Adds a text that every copy of this program has; after all others.
    pub(crate) fn add_of_catalogue(&mut self, source: Source) -> usize {
        self.of_catalogue += 1;
        self.add(source)
    }

    pub fn get(&self, index: usize) -> &Source {
        &self.texts[index]
    }

    pub fn iter(&self) -> impl Iterator<Item = &Source> {
        self.texts.iter()
    }

    /// The text of a scene file that the library has.
    pub(crate) fn text_in_library(&self, path: &Path) -> Option<String> {
        self.library.texts.get(path).cloned()
    }

    /// Where a file is that the text of `source` names.
    pub(crate) fn place_of(&self, source: usize, file: &str) -> PathBuf {
        self.library.place_of(&self.texts[source].folder.join(file)).to_owned()
    }

    /// Opens a file that the text of `source` names, and keeps its fingerprint and those of the files beside it that
    /// hold parts of the same mesh; returns where it is.
    ///
    /// # Errors
    /// The file cannot be read.
    pub(crate) fn open(&self, source: usize, file: &str) -> std::io::Result<PathBuf> {
        let path = self.texts[source].folder.join(file);
        let place = self.library.place_of(&path).to_owned();
        let mut files = self.files.borrow_mut();
        for part in souple_io::files_of_mesh(&place) {
            // as it is named, wherever it is now; parts differ by their extensions
            let path = match part == place {
                true => path.clone(),
                false => path.with_extension(part.extension().unwrap_or_default()),
            };
            if !files.iter().any(|known| known.path == path) {
                files.push(InputFile { sha256: sha256(&std::fs::read(&part)?), path });
            }
        }
        Ok(place)
    }

    /// The path and the text of a file that the text of `source` names, where the library has it; its fingerprint is kept.
    pub(crate) fn text_at_hand(&self, source: usize, file: &str) -> Option<(PathBuf, String)> {
        let path = self.texts[source].folder.join(file);
        self.text_in_library(&path)?;
        Some((path, self.read(source, file).ok()?))
    }

    /// The text of a file that the text of `source` names, from the library where it has it, and keeps its fingerprint.
    ///
    /// # Errors
    /// The file cannot be read, or is no text.
    pub(crate) fn read(&self, source: usize, file: &str) -> std::io::Result<String> {
        let path = self.texts[source].folder.join(file);
        let text = match self.text_in_library(&path) {
            Some(text) => text,
            None => std::fs::read_to_string(self.library.place_of(&path))?,
        };
        let mut files = self.files.borrow_mut();
        if !files.iter().any(|known| known.path == path) {
            files.push(InputFile { sha256: sha256(text.as_bytes()), path });
        }
        Ok(text)
    }

    pub(crate) fn fingerprint(&self) -> String {
        fingerprint(self.iter().map(|source| source.text.as_str()), &self.files.borrow())
    }

    /// What was read; texts of settings stand apart.
    pub(crate) fn into_inputs(self, settings: &[String]) -> Inputs {
        // settings were read last, but for the catalogue
        let count = self.texts.len() - settings.len() - self.of_catalogue;
        let texts = self.texts.into_iter().take(count).filter(|source| !source.text.is_empty());
        let texts = texts.map(|Source { name, folder, text }| InputText { name, folder, text }).collect();
        Inputs { texts, files: self.files.into_inner(), settings: settings.to_vec() }
    }

    /// Line and column of a place, both from 1; columns count characters.
    pub fn line_column(&self, place: Place) -> (usize, usize) {
        let text = &self.texts[place.source].text;
        let before = &text[..text.floor_char_boundary(place.start)];
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        (before.matches('\n').count() + 1, before[line_start..].chars().count() + 1)
    }

    /// The line of a place with `^^^` below it; long lines are cut.
    pub fn underlined(&self, place: Place) -> String {
        let text = &self.texts[place.source].text;
        let start = text.floor_char_boundary(place.start);
        let line_start = text[..start].rfind('\n').map_or(0, |newline| newline + 1);
        let line_end = text[start..].find('\n').map_or(text.len(), |newline| start + newline);
        let end = text.ceil_char_boundary(place.end.max(start)).min(line_end).max(start);
        let before = text[line_start..start].chars().count();
        // a place far right is shown with the characters just before it
        let skipped = before.saturating_sub(WINDOW);
        // tabs and control characters would shift the marks
        let visible = |c: char| if c.is_control() { ' ' } else { c };
        let line: String =
            text[line_start..line_end].chars().skip(skipped).take(2 * WINDOW).map(visible).collect();
        let indent = before - skipped;
        let marks = text[start..end].chars().count().clamp(1, 2 * WINDOW - indent);
        format!("{}\n{}{}", line.trim_end(), " ".repeat(indent), "^".repeat(marks))
    }

    /// The text at a place, on one line and at most 80 characters of it.
    pub fn excerpt(&self, place: Place) -> String {
        let text = &self.texts[place.source].text;
        let start = text.floor_char_boundary(place.start);
        let end = text.ceil_char_boundary(place.end.max(start));
        let line: String = text[start..end].chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
        match line.char_indices().nth(80) {
            Some((cut, _)) => format!("{}…", &line[..cut]),
            None => line,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Lines and columns count from 1, columns in characters.
    #[test]
    fn places_are_counted_in_characters() {
        let mut sources = Sources::default();
        let text = "a = 1\nµ = \"zwei\"\n".to_owned();
        let source = sources.add(Source { name: "x".to_owned(), folder: PathBuf::new(), text });
        let start = "a = 1\nµ = ".len();
        let place = Place { source, start, end: start + 6 };
        assert_eq!(sources.line_column(place), (2, 5));
        assert_eq!(sources.excerpt(place), "\"zwei\"");
        assert_eq!(sources.underlined(place), "µ = \"zwei\"\n    ^^^^^^");
        assert_eq!(sources.line_column(Place { source, start: 999, end: 999 }), (3, 1));
    }
}
