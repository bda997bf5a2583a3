//! The shadow of the key lamp: what the lamp sees first is lit, with a soft border.

use souple_math::Vec3;
use souple_mesh::BoundingBox;

use super::surface::{Faces, Surface};

/// Cells of the map along each side.
const SIDE: usize = 1024;
/// Half the width of the border, as a part of the map.
const SOFTNESS: f64 = 0.006;
/// Places around one that are asked, along a spiral of equal areas.
const TAPS: usize = 16;

/// Depths seen from the lamp, which is far away.
#[derive(Clone, Debug)]
pub(super) struct Shadow {
    /// Across, up and towards the lamp.
    axes: [Vec3; 3],
    /// Where the map begins, in coordinates along the axes [m].
    low: [f64; 2],
    /// Side of the map [m].
    side: f64,
    /// Height towards the lamp of what is nearest to it [m].
    heights: Vec<f32>,
    taps: [[f64; 2]; TAPS],
}

impl Shadow {
    /// `towards`: unit vector to the lamp.
    pub fn of(surfaces: &[Surface], towards: Vec3) -> Self {
        let across = towards.any_orthogonal();
        let axes = [across, towards.cross(across), towards];
        // containers, of which only the inside is seen, would leave everything in the dark
        let casting = || surfaces.iter().filter(|surface| surface.faces == Faces::Both);
        let corners = casting()
            .flat_map(|surface| surface.triangles.iter().flatten().map(|c| surface.points[*c as usize]));
        let balls = casting().flat_map(|surface| &surface.balls);
        let points = corners.chain(balls.flat_map(|ball| ball.extremes(axes)));
        let place = |x: Vec3| Vec3::new(axes[0].dot(x), axes[1].dot(x), axes[2].dot(x));
        let bounds = BoundingBox::of(points.filter(|x| x.is_finite()).map(place));
        let size = bounds.size();
        let extent = size.x.max(size.y);
        let mut shadow = Self { axes, low: [0.0; 2], side: 0.0, heights: Vec::new(), taps: spiral() };
        if !(extent > 0.0 && extent.is_finite()) {
            return shadow;
        }
        shadow.side = 1.05 * extent;
        let centre = bounds.centre();
        shadow.low = [centre.x - 0.5 * shadow.side, centre.y - 0.5 * shadow.side];
        shadow.heights = vec![f32::NEG_INFINITY; SIDE * SIDE];
        for surface in casting() {
            for corners in &surface.triangles {
                shadow.draw(corners.map(|corner| place(surface.points[corner as usize])));
            }
            for ball in &surface.balls {
                shadow.draw_ball(place(ball.centre), ball.radius);
            }
        }
        shadow
    }

    /// In cells of the map.
    fn cell(&self, along: f64, axis: usize) -> f64 {
        (along - self.low[axis]) / self.side * SIDE as f64
    }

    fn draw(&mut self, corners: [Vec3; 3]) {
        let [a, b, c] = corners.map(|p| [self.cell(p.x, 0), self.cell(p.y, 1)]);
        let area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
        if area == 0.0 || !area.is_finite() {
            return;
        }
        let range = |axis: usize| {
            let low = a[axis].min(b[axis]).min(c[axis]) - 0.5;
            let high = a[axis].max(b[axis]).max(c[axis]) + 0.5;
            let clip = |value: f64| value.clamp(0.0, SIDE as f64) as usize;
            clip(low.floor())..clip(high.ceil())
        };
        for row in range(1) {
            for column in range(0) {
                let (x, y) = (column as f64 + 0.5, row as f64 + 0.5);
                let u = ((b[0] - x) * (c[1] - y) - (c[0] - x) * (b[1] - y)) / area;
                let v = ((c[0] - x) * (a[1] - y) - (a[0] - x) * (c[1] - y)) / area;
                if u >= 0.0 && v >= 0.0 && u + v <= 1.0 {
                    let height = u * corners[0].z + v * corners[1].z + (1.0 - u - v) * corners[2].z;
                    let slot = &mut self.heights[row * SIDE + column];
                    *slot = slot.max(height as f32);
                }
            }
        }
    }

    /// A ball, its centre along the axes.
    fn draw_ball(&mut self, centre: Vec3, radius: f64) {
        if !(centre.is_finite() && radius.is_finite()) {
            return;
        }
        let range = |along: f64, axis: usize| {
            let clip = |value: f64| value.clamp(0.0, SIDE as f64) as usize;
            clip((self.cell(along - radius, axis) - 0.5).floor())
                ..clip((self.cell(along + radius, axis) + 0.5).ceil())
        };
        let (columns, rows) = (range(centre.x, 0), range(centre.y, 1));
        let metre = |cell: usize, axis: usize| self.low[axis] + (cell as f64 + 0.5) / SIDE as f64 * self.side;
        for (row, y) in rows.map(|row| (row, metre(row, 1) - centre.y)) {
            for (column, x) in columns.clone().map(|column| (column, metre(column, 0) - centre.x)) {
                let half = radius * radius - x * x - y * y;
                if half >= 0.0 {
                    let slot = &mut self.heights[row * SIDE + column];
                    *slot = slot.max((centre.z + half.sqrt()) as f32);
                }
            }
        }
    }

    /// Share of the lamp that a place sees. `normal` is that of the surface the place is on; `column` and `row`, its
    /// place in the picture, turn the spiral, so that too few taps are grain and not bands.
    pub fn lit(&self, place: Vec3, normal: Option<Vec3>, column: f64, row: f64) -> f32 {
        if self.heights.is_empty() {
            return 1.0;
        }
        let facing = normal.map_or(1.0, |normal| normal.dot(self.axes[2]));
        // turned away: light does not come there in any case
        if facing <= 0.0 {
            return 1.0;
        }
        let [x, y, height] = self.axes.map(|axis| axis.dot(place));
        let (x, y) = (self.cell(x, 0), self.cell(y, 1));
        let reach = SOFTNESS * SIDE as f64;
        // beside the map nothing hides the lamp
        if [x, y].iter().any(|along| !(-reach..SIDE as f64 + reach).contains(along)) {
            return 1.0;
        }
        // off the surface by what it rises over the border, so that a slanted one does not shade itself
        let slope = (1.0 - facing * facing).max(0.0).sqrt() / facing.max(0.15);
        let bias = self.side * (1.5 / SIDE as f64 + SOFTNESS * slope);
        let turn = std::f64::consts::TAU * (0.754_877_666 * column + 0.569_840_291 * row).fract();
        let (sin, cos) = (libm::sin(turn), libm::cos(turn));
        let mut open = 0;
        for [a, b] in self.taps {
            let (column, row) = (x + reach * (a * cos - b * sin), y + reach * (a * sin + b * cos));
            let inside = |value: f64| (0.0..SIDE as f64).contains(&value);
            let hidden = inside(column)
                && inside(row)
                && f64::from(self.heights[row as usize * SIDE + column as usize]) > height + bias;
            open += u32::from(!hidden);
        }
        open as f32 / TAPS as f32
    }
}

fn spiral() -> [[f64; 2]; TAPS] {
    let mut taps = [[0.0; 2]; TAPS];
    for (index, tap) in taps.iter_mut().enumerate() {
        let radius = ((index as f64 + 0.5) / TAPS as f64).sqrt();
        let angle = 2.399_963_229_728_653 * index as f64;
        *tap = [radius * libm::cos(angle), radius * libm::sin(angle)];
    }
    taps
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Under a square plate there is shadow, beside it and on it there is light, at its border half of it.
    #[test]
    fn a_plate_throws_a_square() {
        let points =
            [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[x, z]| Vec3::new(x, 1.0, z)).to_vec();
        let plate = Surface { points, triangles: vec![[0, 2, 1], [0, 3, 2]], ..Surface::default() };
        let shadow = Shadow::of(&[plate], Vec3::Y);
        let lit = |x: f64, y: f64, z: f64| shadow.lit(Vec3::new(x, y, z), Some(Vec3::Y), 3.0, 5.0);
        assert_eq!([lit(0.0, 0.0, 0.0), lit(0.9, 0.5, -0.9)], [0.0; 2]);
        assert_eq!([lit(0.0, 1.0, 0.0), lit(1.2, 0.0, 0.0), lit(50.0, 0.0, 0.0)], [1.0; 3]);
        // a tap or two more or less on one side of the border
        assert!((lit(1.0, 0.0, 0.0) - 0.5).abs() < 0.2, "{}", lit(1.0, 0.0, 0.0));
        assert_eq!(Shadow::of(&[], Vec3::Y).lit(Vec3::ZERO, None, 0.0, 0.0), 1.0);
    }
}
