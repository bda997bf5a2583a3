//! Bodies whose elements change their law while they run.

use souple_models::materials;
use souple_models::solids::{Adaptation, Criterion};
use souple_table::{Range, Value};

use super::body::{MATERIAL, read_material};
use crate::diagnostic::{Code, Site};
use crate::keys::{Key, Keys, Shape};
use crate::reader::{Chosen, Reader};

pub(crate) static ADAPT: Keys = Keys::new(
    "adapt",
    "a second law for the elements that exceed a criterion; at least one criterion is needed",
    &[
        Key::new("material", Shape::Entry(MATERIAL), "the law that takes over; its density does not count")
            .required(),
        Key::number("edge_length", "", Range::POSITIVE, "greatest change of length of an edge, relative"),
        Key::number("volume", "", Range::POSITIVE, "change of volume, relative"),
        Key::number(
            "shape",
            "",
            Range::POSITIVE,
            "growth of the shape factor of a triangle of a face, relative: circumradius over twice the inradius",
        ),
        Key::number("force", "N", Range::POSITIVE, "mean over the element of the field of its nodal forces"),
        Key::number(
            "back",
            "",
            Range::closed(0.0, 1.0),
            "fraction of all thresholds below which an element takes its first law again; 0: never",
        )
        .or(Value::Number(0.8)),
    ],
);

/// When elements take a second law, and which.
pub struct AdaptSpec {
    pub material: Option<Chosen<materials::Build>>,
    pub adaptation: Adaptation,
    pub site: Site,
}

impl AdaptSpec {
    pub(crate) fn read(reader: &Reader) -> Self {
        let criteria = [
            ("edge_length", Criterion::Length),
            ("volume", Criterion::Volume),
            ("shape", Criterion::Shape),
            ("force", Criterion::Force),
        ];
        let given = |(key, criterion): (&'static str, Criterion)| {
            reader.maybe_number(key).map(|threshold| (criterion, threshold))
        };
        let thresholds: Vec<_> = criteria.into_iter().filter_map(given).collect();
        let site = reader.site();
        if thresholds.is_empty() {
            let expected = "`edge_length`, `volume`, `shape` or `force`";
            let message = "no criterion says when elements adapt";
            reader.log().add(Code::MissingKey, &site, message, expected);
        }
        let adaptation = Adaptation { thresholds, back: reader.number("back") };
        Self { material: read_material(reader, "material"), adaptation, site }
    }
}
