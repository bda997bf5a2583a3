//! Masses where a file has them: the points of a frame of another run, of a mesh.

use std::sync::OnceLock;

use souple_math::Vec3;
use souple_table::{Range, Value};

use crate::diagnostic::{Code, Site};
use crate::keys::{Key, Keys, Shape};
use crate::reader::Reader;

pub(super) static FROM_FILE: Keys = Keys::new(
    "mass_file",
    "masses at the points of a file: a frame that a run wrote, whose shape was kneaded there, or a mesh",
    &[
        Key::new("file", Shape::Text, "relative to the scene file that names it").required(),
        Key::number("scale", "", Range::POSITIVE, "metres in one unit of the file").or(Value::Number(1.0)),
        Key::integer("first", Range::closed(0.0, super::MASSES_MAX), "the first point that is taken, from 0")
            .or(Value::Integer(0)),
        Key::integer(
            "count",
            Range::closed(1.0, super::MASSES_MAX),
            "how many; all that follow where left out",
        ),
    ],
);

/// A file, and the places that this gave once it has been read.
pub struct FileSpec {
    pub file: String,
    /// Metres in one unit.
    pub scale: f64,
    pub first: usize,
    pub count: Option<usize>,
    /// [m]
    pub places: OnceLock<Vec<Vec3>>,
    pub site: Site,
}

impl FileSpec {
    pub(super) fn read(reader: &Reader) -> Self {
        Self {
            file: reader.text("file"),
            scale: reader.number("scale"),
            first: reader.maybe_integer("first").unwrap_or(0) as usize,
            count: reader.maybe_integer("count").map(|count| count as usize),
            places: OnceLock::new(),
            site: reader.site_of("file"),
        }
    }

    /// Takes what is asked for of the points of the file; `None` where it has fewer, which is reported.
    pub fn take(&self, points: &[Vec3], refuse: impl FnOnce(Code, String, String)) {
        let end = self.count.map_or(points.len(), |count| self.first.saturating_add(count));
        match points.get(self.first..end).filter(|taken| !taken.is_empty()) {
            Some(taken) => drop(self.places.set(taken.to_vec())),
            None => {
                let message = format!(
                    "`{}` has {} points, and masses start at those from {} to {end}",
                    self.file,
                    points.len(),
                    self.first
                );
                refuse(Code::OutOfRange, message, format!("points below {}", points.len()));
            }
        }
    }

    /// None before it has been read.
    pub fn places(&self) -> &[Vec3] {
        self.places.get().map_or(&[], Vec::as_slice)
    }
}
