//! What reaches from before the eye to behind it: cut off at the nearest depth that is drawn, the part before it kept.

use souple_math::Vec3;

use super::camera::Camera;
use super::raster::PaintAt;

/// A corner of a triangle before it is projected.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    pub place: Vec3,
    pub normal: [f32; 3],
    pub paint: PaintAt,
    /// Blood [m].
    pub film: f32,
    /// Where it rests [m], and the normal there.
    pub rest: [Vec3; 2],
}

impl Corner {
    fn between(&self, other: &Self, share: f64) -> Self {
        let part = share as f32;
        let mixed = |a: f32, b: f32| a + (b - a) * part;
        let paint = match (self.paint, other.paint) {
            (PaintAt::Value(a), PaintAt::Value(b)) => PaintAt::Value(mixed(a, b)),
            (PaintAt::Colour(a), PaintAt::Colour(b)) => PaintAt::Colour(a.mixed(b, part)),
            (paint, _) => paint,
        };
        let rest = [0, 1].map(|of: usize| self.rest[of] + (other.rest[of] - self.rest[of]) * share);
        let normal = [0, 1, 2].map(|axis: usize| mixed(self.normal[axis], other.normal[axis]));
        Self {
            place: self.place + (other.place - self.place) * share,
            normal,
            paint,
            film: mixed(self.film, other.film),
            rest,
        }
    }
}

/// A triangle with the marks of its edges 01, 12, 20.
type Marked = ([Corner; 3], [bool; 3]);

/// What of a triangle is before the eye: nothing, itself, a triangle or two; no edge is marked where it is cut.
pub(super) fn before_eye(camera: &Camera, corners: [Corner; 3], edges: [bool; 3]) -> Vec<Marked> {
    let depths = corners.map(|corner| camera.depth(corner.place) - camera.near);
    if depths.iter().all(|depth| *depth >= 0.0) {
        return vec![(corners, edges)];
    }
    // what is not a number is not drawn
    if !depths.iter().all(|depth| depth.is_finite()) || depths.iter().all(|depth| *depth < 0.0) {
        return Vec::new();
    }
    let (mut polygon, mut marks) = (Vec::with_capacity(4), Vec::with_capacity(4));
    for k in 0..3 {
        let next = (k + 1) % 3;
        let crossing = || corners[k].between(&corners[next], depths[k] / (depths[k] - depths[next]));
        match (depths[k] >= 0.0, depths[next] >= 0.0) {
            (true, true) => {
                polygon.push(corners[k]);
                marks.push(edges[k]);
            }
            (true, false) => {
                polygon.extend([corners[k], crossing()]);
                marks.extend([edges[k], false]);
            }
            (false, true) => {
                polygon.push(crossing());
                marks.push(edges[k]);
            }
            (false, false) => {}
        }
    }
    let last = polygon.len() - 1;
    let triangle = |k: usize| {
        let own = [k == 1 && marks[0], marks[k], k + 1 == last && marks[last]];
        ([polygon[0], polygon[k], polygon[k + 1]], own)
    };
    (1..last).map(triangle).collect()
}

/// What of a line is before the eye.
pub(super) fn line_before_eye(camera: &Camera, from: Vec3, to: Vec3) -> Option<[Vec3; 2]> {
    let [a, b] = [from, to].map(|end| camera.depth(end) - camera.near);
    let crossing = from + (to - from) * (a / (a - b));
    match (a >= 0.0, b >= 0.0) {
        (true, true) => Some([from, to]),
        (true, false) => Some([from, crossing]),
        (false, true) => Some([crossing, to]),
        (false, false) => None,
    }
    .filter(|ends| ends.iter().all(|end| end.is_finite()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture::{Colour, ColourMap, Paint, Picture, Stroke, StrokeShape, Surface, View};

    /// An endless floor, as one triangle that reaches far behind the eye, fills the picture up to the horizon and nothing above
    /// it; its paint goes on evenly where it is cut.
    #[test]
    fn a_floor_reaches_under_the_eye() {
        let points =
            vec![Vec3::new(-900.0, 0.0, 100.0), Vec3::new(900.0, 0.0, 100.0), Vec3::new(0.0, 0.0, -900.0)];
        let floor = |paint: Paint| Surface {
            points: points.clone(),
            triangles: vec![[0, 1, 2]],
            paint,
            ..Surface::default()
        };
        let picture = |surface: Surface| Picture {
            surfaces: vec![surface],
            view: View { eye: Some(Vec3::new(0.0, 2.0, 0.0)), ..View::along(-Vec3::Z, Vec3::Y) },
            size: [160, 120],
            samples_per_pixel: 1,
            ..Picture::default()
        };
        let drawn = picture(floor(Paint::Plain(Colour::from_screen([200, 0, 0])))).render().unwrap();
        let is_red = |x: usize, y: usize| {
            let [r, g, b] = drawn.pixels[y * 160 + x];
            i32::from(r) > i32::from(g) + 40 && i32::from(r) > i32::from(b) + 40
        };
        // the lower border is 2 m below an eye that looks level: the floor is everywhere there, and nowhere above
        let rows: Vec<usize> = (0..120).map(|y| (20..140).filter(|x| is_red(*x, y)).count()).collect();
        assert!(rows[119] == 120 && rows[100] == 120 && rows[80] == 120, "{rows:?}");
        assert!(rows[..50].iter().all(|count| *count == 0), "{rows:?}");
        // where a row of pixels meets the floor, 2 m below the eye: a value of 0 is 100 m behind it, one of 1 at 900 m
        let values = picture(floor(Paint::PointScalar(vec![0.0, 0.0, 1.0]))).render().unwrap();
        let upper = libm::tan(0.5 * View::default().field_of_view);
        for row in [119_usize, 100, 80, 70] {
            let depth = 2.0 / (upper * (row as f64 + 0.5 - 60.0) / 60.0);
            let colour = ColourMap::default().colour((100.0 + depth) / 1000.0);
            let expected = picture(floor(Paint::Plain(colour))).render().unwrap();
            for x in [20, 80, 139] {
                let [found, expected] = [&values, &expected].map(|image| image.pixels[row * 160 + x]);
                // half a row, by which values change at most by a hundredth up to the last of these, is two steps of a colour
                let off = (0..3).map(|part| found[part].abs_diff(expected[part])).max();
                assert!(off <= Some(2), "row {row}, column {x}: {found:?}, {expected:?}");
            }
        }
    }

    /// An arrow that begins behind the eye is drawn from where it comes before it: as one that begins there.
    #[test]
    fn an_arrow_comes_from_behind_the_eye() {
        let eye = Vec3::new(0.3, 0.2, 0.0);
        let drawn = |from: Vec3| {
            let arrow = Stroke {
                shape: StrokeShape::Arrow(from, Vec3::new(0.0, 0.0, -9.0)),
                colour: Colour([1.0, 0.0, 0.0]),
                width: 3.0,
                through: Stroke::FAINTLY,
            };
            let picture = Picture {
                strokes: vec![arrow],
                view: View { eye: Some(eye), ..View::along(-Vec3::Z, Vec3::Y) },
                size: [160, 120],
                samples_per_pixel: 1,
                ..Picture::default()
            };
            picture.render().unwrap().pixels
        };
        let behind = drawn(Vec3::new(0.0, 0.0, 5.0));
        let reds = behind.iter().filter(|[r, g, _]| r.saturating_sub(*g) > 100).count();
        assert!(reds > 100, "{reds}");
        // from one metre before the eye on both are the same line
        let before = drawn(Vec3::new(0.0, 0.0, -1.0));
        let missing = before
            .iter()
            .zip(&behind)
            .filter(|(a, b)| a[0].saturating_sub(a[1]) > 100 && b[0].saturating_sub(b[1]) <= 100);
        assert_eq!(missing.count(), 0);
    }

    #[test]
    fn what_is_behind_is_nothing() {
        let camera = Camera::fitted(
            &View { eye: Some(Vec3::ZERO), ..View::along(-Vec3::Z, Vec3::Y) },
            [Vec3::X, Vec3::Y].into_iter(),
            crate::picture::camera::Frame { left: 0.0, top: 0.0, right: 10.0, bottom: 10.0 },
            10.0,
        );
        let corner = |x: f64, z: f64| Corner {
            place: Vec3::new(x, 1.0, z),
            normal: [0.0, 1.0, 0.0],
            paint: PaintAt::Value(z as f32),
            film: 0.0,
            rest: [Vec3::ZERO; 2],
        };
        let count = |z: [f64; 3]| {
            let corners = [0, 1, 2].map(|k| corner(k as f64, z[k]));
            before_eye(&camera, corners, [true; 3]).len()
        };
        assert_eq!([[1.0, 2.0, 3.0], [-1.0, -2.0, -3.0]].map(count), [0, 1]);
        assert_eq!([[1.0, 1.0, -1.0], [1.0, -1.0, -1.0], [f64::NAN, -1.0, -1.0]].map(count), [1, 2, 0]);
        let marks: Vec<[bool; 3]> =
            before_eye(&camera, [corner(0.0, 1.0), corner(1.0, -1.0), corner(2.0, -1.0)], [true; 3])
                .into_iter()
                .map(|(_, edges)| edges)
                .collect();
        // three of the four sides of what is left were sides before
        assert_eq!(marks.as_flattened().iter().filter(|mark| **mark).count(), 3);
        let line = line_before_eye(&camera, Vec3::new(0.0, 0.0, 1.0), Vec3::new(0.0, 0.0, -1.0)).unwrap();
        assert!(line[0].z < 0.0 && line[0].z > -0.1 && line[1].z == -1.0);
        assert!(line_before_eye(&camera, Vec3::Z, Vec3::Z * 2.0).is_none());
    }
}
