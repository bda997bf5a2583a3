//! Bodies with faces that keep out of each other.

use souple_table::Range;

use super::constraints::triangles;
use crate::diagnostic::{Code, Site};
use crate::keys::{Key, Keys, Shape};
use crate::reader::Reader;

pub(super) static FACES: Keys = Keys::new(
    "constraint_faces",
    "bodies that keep out of each other: by triangles, by their convex hull, or balls",
    &[
        Key::new("of", Shape::Texts, "groups of masses, each of which is a body; all masses where left out"),
        Key::new(
            "triangles",
            Shape::Vectors,
            "three numbers of masses within each group, counterclockwise seen from outside; they need not close",
        ),
        Key::new("hull", Shape::Boolean, "the faces of the convex hull of each group where it rests"),
        Key::number(
            "radius",
            "m",
            Range::POSITIVE,
            "in the place of these: of balls around the masses of each group, which meet the faces of others",
        ),
    ],
);

/// Groups of masses that are bodies of one form.
pub struct FacesSpec {
    /// Each a body; all masses are one where there are none.
    pub of: Vec<String>,
    pub form: FacesForm,
    /// Where the form is written.
    pub site: Site,
}

/// What of a body others meet.
pub enum FacesForm {
    /// Numbers of masses within the group.
    Triangles(Vec<[u32; 3]>),
    Hull,
    /// Of a radius [m].
    Balls(f64),
}

impl FacesSpec {
    pub(super) fn read(reader: &Reader) -> Option<Self> {
        let (form, site) = match reader.written(&["triangles", "hull", "radius"])[..] {
            ["triangles"] => (FacesForm::Triangles(triangles(reader, &[1, 0])?), reader.site_of("triangles")),
            ["hull"] => (Self::hull(reader)?, reader.site_of("hull")),
            ["radius"] => (FacesForm::Balls(reader.maybe_number("radius")?), reader.site_of("radius")),
            [] => return Self::refuse(reader, &reader.site(), "none"),
            ref several => return Self::refuse(reader, &reader.site(), &several.join(" and ")),
        };
        Some(Self { of: reader.texts("of"), form, site })
    }

    fn hull(reader: &Reader) -> Option<FacesForm> {
        // what is no boolean has been told
        match reader.reading("hull")?.boolean()? {
            true => Some(FacesForm::Hull),
            false => Self::refuse(reader, &reader.site_of("hull"), "`hull = false`"),
        }
    }

    fn refuse<T>(reader: &Reader, site: &Site, what: &str) -> Option<T> {
        let message = format!("a body has triangles, a hull, or balls of a radius: of these this has {what}");
        let expected = "`triangles`, `hull = true` or `radius`, one of them";
        reader.log().add(Code::Conflict, site, message, expected);
        None
    }
}
