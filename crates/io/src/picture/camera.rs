//! The camera: from where a picture is seen, and the distance at which everything fits.

use souple_math::Vec3;
use souple_mesh::BoundingBox;

/// From where a picture is seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Where the eye is [m]; where everything fits along the direction, if `None`.
    pub eye: Option<Vec3>,
    /// From the eye towards the subject; of any length.
    pub direction: Vec3,
    /// What is up in the picture; any vector that is not along the direction.
    pub up: Vec3,
    /// Angle between the upper and the lower border [rad].
    pub field_of_view: f64,
    /// From the lamp that throws shadows towards the scene, of any length; it hangs over the eye's left shoulder where `None`.
    pub light: Option<Vec3>,
    /// What must be in the picture; everything drawn where `None`. The same box for all frames of a series
    /// keeps the camera still.
    pub bounds: Option<BoundingBox>,
}

impl Default for View {
    /// From the front, a little from the right and above, `y` upward.
    fn default() -> Self {
        Self::along(Vec3::new(-0.5, -0.45, -1.0), Vec3::Y)
    }
}

impl View {
    /// Everything drawn, seen along a direction.
    pub fn along(direction: Vec3, up: Vec3) -> Self {
        Self { eye: None, direction, up, field_of_view: 0.5, light: None, bounds: None }
    }
}

/// A ball that must be in the picture, or a point, which is one without a radius.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Framed {
    /// [m]
    pub centre: Vec3,
    /// [m]
    pub radius: f64,
}

impl From<Vec3> for Framed {
    fn from(centre: Vec3) -> Self {
        Self { centre, radius: 0.0 }
    }
}

/// The part of the picture that the subject may fill [pixels].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Frame {
    pub left: f64,
    pub top: f64,
    pub right: f64,
    pub bottom: f64,
}

/// A pinhole camera.
#[derive(Clone, Copy, Debug)]
pub(super) struct Camera {
    pub eye: Vec3,
    pub right: Vec3,
    pub up: Vec3,
    pub forward: Vec3,
    /// Distance of the plane of pixels [pixels].
    focal: f64,
    /// Where the axis of the camera meets the picture [pixels].
    centre: [f64; 2],
    /// Nearest depth that is drawn [m].
    pub near: f64,
}

/// A point in the picture.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Projected {
    /// Pixels from the left.
    pub x: f64,
    /// Pixels from the top.
    pub y: f64,
    /// `1 / depth` [1/m]; linear in the picture along a straight line, greater means closer. Zero for points that
    /// are not in front of the camera.
    pub inverse_depth: f64,
}

/// Rounding of depths, in the nearest one of a picture of bodies a thousand times as large.
const ROUNDED: f64 = 1e-6;

/// To the right, up and away, as they are seen.
pub(super) fn axes(view: &View) -> [Vec3; 3] {
    let forward = view.direction.try_normalised().unwrap_or(-Vec3::Z);
    let right = forward.cross(view.up).try_normalised().unwrap_or_else(|| forward.any_orthogonal());
    [right, right.cross(forward), forward]
}

impl Camera {
    /// The closest camera along the direction of `view` that has all of what is `framed` within `frame`.
    pub fn fitted(
        view: &View,
        framed: impl Iterator<Item = impl Into<Framed>>,
        frame: Frame,
        picture_height: f64,
    ) -> Self {
        let [right, up, forward] = axes(view);
        let field_of_view = if view.field_of_view.is_finite() { view.field_of_view } else { 0.5 };
        let focal = 0.5 * picture_height / libm::tan(0.5 * field_of_view.clamp(0.01, 2.5));

        // In coordinates (a, b, c) along right, up, forward a point is within the frame, if
        // |a − a₀| ≤ k (c − c₀) with k = half the width of the frame / focal; likewise for b.
        // So a₀ ≥ max(a − k c) + k c₀ and −a₀ ≥ max(−a − k c) + k c₀, whose sum bounds c₀.
        // A ball reaches r √(1 + k²) beyond its centre, which is r along the normal of a plane of the frame.
        let slope = [0.5 * (frame.right - frame.left) / focal, 0.5 * (frame.bottom - frame.top) / focal];
        let mut most = [[f64::NEG_INFINITY; 2]; 2];
        let (mut nearest, mut extent) = (f64::INFINITY, BoundingBox::EMPTY);
        let is_finite = |ball: &Framed| ball.centre.is_finite() && ball.radius.is_finite();
        for Framed { centre, radius } in framed.map(Into::into).filter(is_finite) {
            let across = [right.dot(centre), up.dot(centre)];
            let along = forward.dot(centre);
            for axis in 0..2 {
                let reach = radius * (1.0 + slope[axis] * slope[axis]).sqrt();
                most[axis][0] = most[axis][0].max(across[axis] - slope[axis] * along + reach);
                most[axis][1] = most[axis][1].max(-across[axis] - slope[axis] * along + reach);
            }
            nearest = nearest.min(along - radius);
            extent = extent.union(BoundingBox::of([centre]).grown(radius));
        }
        if !nearest.is_finite() {
            (most, nearest, extent) = ([[0.0; 2]; 2], 0.0, extent.with(Vec3::ZERO));
        }
        let size = if extent.diagonal() > 0.0 { extent.diagonal() } else { 1.0 };
        let fit = |axis: usize| -0.5 * (most[axis][0] + most[axis][1]) / slope[axis];
        // not into the subject, however flat it is along the direction
        let along = fit(0).min(fit(1)).min(nearest - 0.2 * size);
        let across = [0, 1].map(|axis: usize| 0.5 * (most[axis][0] - most[axis][1]));
        let fitted = right * across[0] + up * across[1] + forward * along;
        let eye = view.eye.filter(|eye| eye.is_finite()).unwrap_or(fitted);
        Self {
            eye,
            right,
            up,
            forward,
            focal,
            centre: [0.5 * (frame.left + frame.right), 0.5 * (frame.top + frame.bottom)],
            near: 1e-3 * size,
        }
    }

    /// How far before the eye a point is [m].
    pub fn depth(&self, point: Vec3) -> f64 {
        self.forward.dot(point - self.eye)
    }

    pub fn project(&self, point: Vec3) -> Projected {
        let relative = point - self.eye;
        let depth = self.depth(point);
        // what is cut off at the nearest depth lies before it by rounding
        if depth.is_nan() || depth < self.near * (1.0 - ROUNDED) {
            return Projected::default();
        }
        let scale = self.focal / depth;
        Projected {
            x: self.centre[0] + scale * self.right.dot(relative),
            y: self.centre[1] - scale * self.up.dot(relative),
            inverse_depth: 1.0 / depth,
        }
    }

    /// Direction from the eye through a place of the picture, one long along `forward`.
    pub fn ray(&self, x: f64, y: f64) -> Vec3 {
        self.forward + self.right * ((x - self.centre[0]) / self.focal)
            - self.up * ((y - self.centre[1]) / self.focal)
    }

    /// Pixels of a length of one metre across at a depth of one metre.
    pub fn focal(&self) -> f64 {
        self.focal
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The fitted box touches two opposite borders of the frame and crosses none.
    #[test]
    fn fits_the_frame() {
        let frame = Frame { left: 20.0, top: 60.0, right: 500.0, bottom: 380.0 };
        let bounds = BoundingBox { low: Vec3::new(-3.0, 1.0, 0.0), high: Vec3::new(5.0, 2.0, 1.5) };
        let corners: Vec<Vec3> = bounds.corners().collect();
        for direction in [Vec3::new(-0.5, -0.4, -1.0), Vec3::new(1.0, 0.0, 0.2), Vec3::new(0.0, -1.0, 0.0)] {
            let view = View { direction, ..View::default() };
            let camera = Camera::fitted(&view, corners.iter().copied(), frame, 400.0);
            let places: Vec<_> = corners.iter().map(|corner| camera.project(*corner)).collect();
            let least = |of: fn(&Projected) -> f64| places.iter().map(of).fold(f64::INFINITY, f64::min);
            let (left, top) = (least(|p| p.x) - frame.left, least(|p| p.y) - frame.top);
            let (right, bottom) = (frame.right + least(|p| -p.x), frame.bottom + least(|p| -p.y));
            let margins = [left, top, right, bottom];
            // rounding of coordinates of a few hundred pixels
            assert!(margins.iter().all(|margin| *margin > -1e-9), "{margins:?}");
            assert!((left + right).min(top + bottom) < 1e-9, "{margins:?}");
            let centre = camera.ray(0.5 * (frame.left + frame.right), 0.5 * (frame.top + frame.bottom));
            assert!((centre - camera.forward).length() < 1e-12);
        }
    }

    /// Every ball is within the frame with its whole radius, from any side, in frames of any shape, and one touches each of two
    /// opposite borders. What is seen of a ball is bounded by the planes through the eye that touch it.
    #[test]
    fn balls_are_framed_with_their_radius() {
        let balls = [(-3.0, 1.0, 0.0, 1.5), (5.0, 2.0, 1.5, 0.2), (0.0, -4.0, 2.0, 0.7)]
            .map(|(x, y, z, radius)| Framed { centre: Vec3::new(x, y, z), radius });
        for [width, height] in [[400.0, 300.0], [1280.0, 800.0], [300.0, 900.0], [900.0, 120.0]] {
            let frame = Frame { left: 20.0, top: 60.0, right: width - 40.0, bottom: height - 20.0 };
            for direction in [Vec3::new(-0.5, -0.4, -1.0), Vec3::X, -Vec3::Y, Vec3::new(0.3, 2.0, -1.0)] {
                let view = View { direction, ..View::along(direction, Vec3::new(0.1, 0.9, 0.3)) };
                let camera = Camera::fitted(&view, balls.into_iter(), frame, height);
                let inward = [
                    (camera.ray(frame.left, camera.centre[1]), camera.up, -1.0),
                    (camera.ray(frame.right, camera.centre[1]), camera.up, 1.0),
                    (camera.ray(camera.centre[0], frame.top), camera.right, -1.0),
                    (camera.ray(camera.centre[0], frame.bottom), camera.right, 1.0),
                ]
                .map(|(ray, along, side)| ray.cross(along).try_normalised().unwrap() * side);
                let inward = inward.map(|normal| normal * normal.dot(camera.forward).signum());
                let rooms = inward.map(|normal| {
                    let room = |ball: &Framed| normal.dot(ball.centre - camera.eye) - ball.radius;
                    balls.iter().map(room).fold(f64::INFINITY, f64::min)
                });
                // rounding of lengths of some metres
                assert!(rooms.iter().all(|room| *room > -1e-12), "{width} {height} {rooms:?}");
                assert!((rooms[0] + rooms[1]).min(rooms[2] + rooms[3]) < 1e-9, "{rooms:?}");
            }
        }
    }

    #[test]
    fn nothing_and_a_point_make_a_camera() {
        let frame = Frame { left: 0.0, top: 0.0, right: 10.0, bottom: 10.0 };
        for points in [vec![], vec![Vec3::X], vec![Vec3::new(f64::NAN, 0.0, 0.0)]] {
            let camera = Camera::fitted(&View::default(), points.into_iter(), frame, 10.0);
            assert!(camera.eye.is_finite());
        }
        let straight = View { direction: Vec3::Y, up: Vec3::Y, ..View::default() };
        let camera = Camera::fitted(&straight, [Vec3::ZERO, Vec3::X].into_iter(), frame, 10.0);
        assert!(camera.eye.is_finite() && camera.project(camera.eye) == Projected::default());
    }
}
