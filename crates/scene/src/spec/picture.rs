//! From where pictures of a scene are seen.

use souple_math::Vec3;

use super::region::direction;
use crate::diagnostic::Code;
use crate::keys::{Key, Keys};
use crate::reader::Reader;

pub(crate) static PICTURE: Keys = Keys::new(
    "picture",
    "from where pictures are seen",
    &[
        Key::vector(
            "direction",
            "",
            "from the eye towards the scene; from the front, a little right and above, where left out",
        ),
        Key::vector(
            "up",
            "",
            "what is up in the picture; against gravity where left out, or y without gravity",
        ),
    ],
);

/// What the scene says of its pictures.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PictureSpec {
    /// Of length one.
    pub direction: Option<Vec3>,
    /// Of length one.
    pub up: Option<Vec3>,
}

/// From where pictures are seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PictureView {
    /// From the eye towards the scene.
    pub direction: Vec3,
    /// Unit.
    pub up: Vec3,
}

/// From the front, a little right and above: along a level axis, up, and towards the eye.
const DIRECTION: [f64; 3] = [-0.5, -0.45, -1.0];
/// Sine of the angle between two directions below which they count as one.
const PARALLEL: f64 = 1e-6;

impl PictureSpec {
    pub(crate) fn read(reader: &Reader) -> Self {
        let read = |key: &str| reader.has(key).then(|| direction(reader, key)).flatten();
        let picture = Self { direction: read("direction"), up: read("up") };
        if let (Some(towards), Some(up)) = (picture.direction, picture.up)
            && towards.cross(up).length() < PARALLEL
        {
            let message = "the picture is seen along what is up in it";
            reader.log().add(
                Code::Conflict,
                &reader.site_of("up"),
                message,
                "an `up` across the `direction`",
            );
        }
        picture
    }

    /// The view, completed from gravity [m/s²].
    pub fn view(&self, gravity: Vec3) -> PictureView {
        let up = self.up.or_else(|| (-gravity).try_normalised()).unwrap_or(Vec3::Y);
        // level axes to the right and towards the eye: x and z where y is up, x and -y where z is
        let across = if up.cross(Vec3::X).length() > 0.5 { Vec3::X } else { -Vec3::Y };
        let right = (across - up * across.dot(up)).try_normalised().unwrap_or(Vec3::X);
        let towards_eye = right.cross(up);
        let [x, y, z] = DIRECTION;
        let usual = right * x + up * y + towards_eye * z;
        let direction = self.direction.unwrap_or(usual);
        // seen straight from above or below, gravity says nothing of what is up in the picture
        let is_along = direction.cross(up).length() < PARALLEL * direction.length();
        PictureView { direction, up: if is_along { -towards_eye } else { up } }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Up is against gravity, or y without; the usual direction turns with it, and a direction along gravity still
    /// gives a picture.
    #[test]
    fn up_is_against_gravity() {
        let usual = PictureSpec::default();
        let y_up = PictureView { direction: Vec3::from_array(DIRECTION), up: Vec3::Y };
        assert_eq!(usual.view(Vec3::ZERO), y_up);
        assert_eq!(usual.view(Vec3::new(0.0, -9.81, 0.0)), y_up);
        let z_up = usual.view(Vec3::new(0.0, 0.0, -9.81));
        assert_eq!((z_up.direction, z_up.up), (Vec3::new(-0.5, 1.0, -0.45), Vec3::Z));
        assert_eq!(usual.view(Vec3::new(-9.81, 0.0, 0.0)).up, Vec3::X);
        let from_above = PictureSpec { direction: Some(-Vec3::Y), up: None }.view(Vec3::new(0.0, -1.0, 0.0));
        assert!(from_above.up.cross(from_above.direction).length() > 0.9, "{from_above:?}");
        let own = PictureSpec { direction: None, up: Some(Vec3::Z) }.view(Vec3::new(0.0, -1.0, 0.0));
        assert_eq!(own.up, Vec3::Z);
    }
}
