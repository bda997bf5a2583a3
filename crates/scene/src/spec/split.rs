//! Tetrahedra of a body that are split into smaller ones.

use souple_mesh::{MeshSize, SplitBy};
use souple_table::{Range, Value};

use crate::diagnostic::Site;
use crate::keys::{Key, Keys, Shape};
use crate::reader::Reader;

pub(crate) static SPLIT: Keys = Keys::new(
    "split",
    "tetrahedra of a mesh split into smaller ones",
    &[
        Key::integer("times", Range::closed(0.0, 6.0), "how often each is split, at least")
            .or(Value::Integer(1)),
        Key::new(
            "by",
            Shape::Choice(&["regular", "longest_edge"]),
            "regular: in eight by the middles of all edges; longest_edge: in two by the middle of the longest, and others for it",
        )
        .or(Value::Text("regular")),
    ],
);

/// How often and how tetrahedra are split.
pub struct SplitSpec {
    pub times: u32,
    pub by: SplitBy,
    pub site: Site,
}

impl SplitSpec {
    pub(crate) fn read(reader: &Reader) -> Self {
        let by = match reader.choice("by") {
            "longest_edge" => SplitBy::LongestEdge,
            _ => SplitBy::Regular,
        };
        Self { times: reader.maybe_integer("times").unwrap_or(1) as u32, by, site: reader.site() }
    }

    /// What a mesh of that size has at least once it is split.
    pub fn least_size(&self, size: MeshSize) -> MeshSize {
        let factor = match self.by {
            SplitBy::Regular => 8_u64,
            SplitBy::LongestEdge => 2,
        }
        .saturating_pow(self.times);
        let cells = size.cells.saturating_mul(factor);
        // a large mesh has a point for six tetrahedra or fewer
        MeshSize { points: size.points.max(cells / 6), cells }
    }
}
