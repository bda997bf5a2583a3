//! The ground: a plane that is seen by the shade of what stands on it and by a grid that fades with distance.

use souple_math::Vec3;
use souple_mesh::BoundingBox;

use super::balls::Ball;
use super::camera::Camera;
use super::colour::Colour;
use super::surface::Surface;

/// A plane under the subject.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ground {
    /// Any point of the plane [m].
    pub point: Vec3,
    /// Upward; of any length.
    pub normal: Vec3,
}

/// Cells of the map of shade along each side.
const MAP_SIDE: usize = 256;
/// Share of the map beyond the subject on each side, into which the shade spreads.
const BORDER: f64 = 0.25;
/// Rounds of blur, and its reach in cells: three boxes make nearly a bell.
const BLUR_ROUNDS: usize = 3;
const BLUR_REACH: usize = 7;

/// A ground ready to be drawn.
#[derive(Clone, Debug)]
pub(super) struct ShadedGround {
    origin: Vec3,
    normal: Vec3,
    axes: [Vec3; 2],
    /// Side of the map [m].
    side: f64,
    /// Shade, 0 to 1, row after row along the second axis.
    map: Vec<f32>,
    /// Distance of the lines of the grid [m].
    spacing: f64,
    /// Distance from the origin at which the grid has faded [m].
    horizon: f64,
}

impl ShadedGround {
    /// `None` for a ground without direction or nothing to stand on it.
    pub fn of(ground: Ground, surfaces: &[Surface], bounds: BoundingBox) -> Option<Self> {
        let normal = ground.normal.try_normalised()?;
        let size = bounds.diagonal();
        if !(size > 0.0 && size.is_finite() && ground.point.is_finite()) {
            return None;
        }
        let first = Vec3::X - normal * normal.x;
        let first = if first.length() > 0.1 { first / first.length() } else { normal.any_orthogonal() };
        let axes = [first, normal.cross(first)];
        let centre = bounds.centre();
        let origin = centre - normal * normal.dot(centre - ground.point);
        let mut shaded = Self {
            origin,
            normal,
            axes,
            side: size * (1.0 + 2.0 * BORDER),
            map: Vec::new(),
            spacing: spacing(size / 5.0),
            horizon: 1.6 * size,
        };
        shaded.map = shaded.shade_of(surfaces, size);
        Some(shaded)
    }

    /// Place on the map [cells].
    fn place(&self, point: Vec3) -> [f64; 2] {
        let relative = point - self.origin;
        self.axes.map(|axis| (axis.dot(relative) / self.side + 0.5) * MAP_SIDE as f64)
    }

    /// The lowest height of the subject over each cell makes its shade: dark in contact, none at a distance.
    fn shade_of(&self, surfaces: &[Surface], size: f64) -> Vec<f32> {
        let mut heights = vec![f32::INFINITY; MAP_SIDE * MAP_SIDE];
        for surface in surfaces {
            for corners in &surface.triangles {
                let corners = corners.map(|corner| surface.points[corner as usize]);
                let above = corners.map(|corner| self.normal.dot(corner - self.origin));
                self.drop_triangle(corners.map(|corner| self.place(corner)), above, &mut heights);
            }
            for ball in surface.balls.iter().filter(|ball| ball.is_finite()) {
                self.drop_ball(ball, &mut heights);
            }
        }
        let shade = |height: f32| libm::exp(-(f64::from(height).max(0.0) / (0.13 * size))) as f32;
        let mut map: Vec<f32> = heights.into_iter().map(shade).collect();
        for _ in 0..BLUR_ROUNDS {
            map = box_blur(&map, 1, MAP_SIDE);
            map = box_blur(&map, MAP_SIDE, 1);
        }
        map
    }

    fn drop_ball(&self, ball: &Ball, heights: &mut [f32]) {
        let above = self.normal.dot(ball.centre - self.origin);
        let (centre, metre) = (self.place(ball.centre), self.side / MAP_SIDE as f64);
        let range = |axis: usize| {
            let clip = |value: f64| value.clamp(0.0, MAP_SIDE as f64) as usize;
            let reach = ball.radius / metre + 0.5;
            clip((centre[axis] - reach).floor())..clip((centre[axis] + reach).ceil())
        };
        for row in range(1) {
            for column in range(0) {
                let off = [column, row].map(|cell| cell as f64 + 0.5);
                let (x, y) = ((off[0] - centre[0]) * metre, (off[1] - centre[1]) * metre);
                let half = ball.radius * ball.radius - x * x - y * y;
                if half >= 0.0 {
                    let slot = &mut heights[row * MAP_SIDE + column];
                    *slot = slot.min((above - half.sqrt()) as f32);
                }
            }
        }
    }

    fn drop_triangle(&self, [a, b, c]: [[f64; 2]; 3], above: [f64; 3], heights: &mut [f32]) {
        let area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
        if area == 0.0 || !area.is_finite() {
            return;
        }
        let range = |axis: usize| {
            let low = a[axis].min(b[axis]).min(c[axis]) - 0.5;
            let high = a[axis].max(b[axis]).max(c[axis]) + 0.5;
            let clip = |value: f64| value.clamp(0.0, MAP_SIDE as f64) as usize;
            clip(low.floor())..clip(high.ceil())
        };
        for row in range(1) {
            for column in range(0) {
                let (x, y) = (column as f64 + 0.5, row as f64 + 0.5);
                let u = ((b[0] - x) * (c[1] - y) - (c[0] - x) * (b[1] - y)) / area;
                let v = ((c[0] - x) * (a[1] - y) - (a[0] - x) * (c[1] - y)) / area;
                if u >= 0.0 && v >= 0.0 && u + v <= 1.0 {
                    let height = (u * above[0] + v * above[1] + (1.0 - u - v) * above[2]) as f32;
                    let slot = &mut heights[row * MAP_SIDE + column];
                    *slot = slot.min(height);
                }
            }
        }
    }

    /// `1 / depth` of the ground along a ray; zero where the ray goes above it.
    pub fn inverse_depth(&self, camera: &Camera, ray: Vec3) -> f32 {
        let (descent, height) = (-self.normal.dot(ray), self.normal.dot(camera.eye - self.origin));
        // the ray is one long along the axis of the camera, so that its length to the plane is the depth
        if descent > 0.0 && height > 0.0 { (descent / height) as f32 } else { 0.0 }
    }

    /// Colour of the ground where a ray meets it, over a background, its grid in an ink of some strength.
    pub fn colour(
        &self,
        camera: &Camera,
        ray: Vec3,
        background: Colour,
        (ink, strength): (Colour, f32),
    ) -> Colour {
        let descent = self.normal.dot(ray);
        let depth = self.normal.dot(camera.eye - self.origin) / -descent;
        let point = camera.eye + ray * depth;
        let relative = point - self.origin;
        let distance = relative.length() / self.horizon;
        let fade = (1.0 - distance * distance).max(0.0) as f32;
        let footprint = depth / camera.focal();
        let mut colour = background;
        for axis in self.axes {
            let along = axis.dot(relative) / self.spacing;
            let off = (along - along.round()).abs() * self.spacing;
            // a line of one pixel across, wider where the plane is seen at a glance
            let width = footprint / (descent.abs() / ray.length()).max(0.15);
            let line = (1.0 - off / (0.6 * width)).clamp(0.0, 1.0) as f32;
            colour = colour.mixed(ink, strength * line * fade);
        }
        colour.scaled(1.0 - 0.72 * self.shade_at(point))
    }

    /// The map between its cells.
    fn shade_at(&self, point: Vec3) -> f32 {
        let [x, y] = self.place(point).map(|place| place - 0.5);
        let at = |column: f64, row: f64| {
            let inside = |value: f64| (0.0..MAP_SIDE as f64).contains(&value);
            if inside(column) && inside(row) {
                self.map[row as usize * MAP_SIDE + column as usize]
            } else {
                0.0
            }
        };
        let (column, row) = (x.floor(), y.floor());
        let (right, down) = ((x - column) as f32, (y - row) as f32);
        let top = at(column, row) * (1.0 - right) + at(column + 1.0, row) * right;
        let bottom = at(column, row + 1.0) * (1.0 - right) + at(column + 1.0, row + 1.0) * right;
        top * (1.0 - down) + bottom * down
    }
}

/// 1, 2 or 5 times a power of ten, at least `least`.
fn spacing(least: f64) -> f64 {
    let power = libm::pow(10.0, libm::floor(libm::log10(least)));
    [1.0, 2.0, 5.0]
        .map(|factor| factor * power)
        .into_iter()
        .find(|step| *step >= least)
        .unwrap_or(10.0 * power)
}

/// Mean over a window along lines whose cells are `stride` apart; lines begin `line_stride` apart.
fn box_blur(map: &[f32], stride: usize, line_stride: usize) -> Vec<f32> {
    let mut blurred = vec![0.0; map.len()];
    for line in 0..MAP_SIDE {
        for place in 0..MAP_SIDE {
            let window = place.saturating_sub(BLUR_REACH)..(place + BLUR_REACH + 1).min(MAP_SIDE);
            let sum: f32 = window.map(|at| map[line * line_stride + at * stride]).sum();
            blurred[line * line_stride + place * stride] = sum / (2 * BLUR_REACH + 1) as f32;
        }
    }
    blurred
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spacing_is_round() {
        assert_eq!([0.03, 1.0, 1.2, 6.0].map(spacing), [0.05, 1.0, 2.0, 10.0]);
    }

    /// The shade is dark under a thing in contact, lighter under one that floats, none far away.
    #[test]
    fn shade_falls_with_height() {
        let tile = |height: f64| {
            let corner = |x: f64, z: f64| Vec3::new(x, height, z);
            let points = vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
            Surface { points, triangles: vec![[0, 2, 1], [0, 3, 2]], ..Surface::default() }
        };
        let bounds = BoundingBox { low: Vec3::new(-1.0, 0.0, -1.0), high: Vec3::new(1.0, 1.0, 1.0) };
        let ground = Ground { point: Vec3::ZERO, normal: Vec3::Y };
        let shade =
            |height: f64, at: Vec3| ShadedGround::of(ground, &[tile(height)], bounds).unwrap().shade_at(at);
        let (contact, floating) = (shade(0.0, Vec3::ZERO), shade(0.5, Vec3::ZERO));
        assert!(contact > 0.95 && floating < 0.5 * contact, "{contact} {floating}");
        assert!(shade(0.0, Vec3::new(2.0, 0.0, 0.0)) < 0.05);
    }
}
