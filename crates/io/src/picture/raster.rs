//! Triangles and strokes into samples, the nearest one wins.

use souple_math::Vec3;

use super::balls::Ball;
use super::blood;
use super::camera::{Camera, Projected};
use super::colour::Colour;
use super::colour_map::ColourMap;
use super::surface::Faces;
use super::texture::Texture;

/// What is seen at one place.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sample {
    /// `1 / depth`, zero where nothing is.
    pub inverse_depth: f32,
    pub normal: [f32; 3],
    /// The paint, without light.
    pub albedo: Colour,
    /// How much it shines as water does, 0 to 1.
    pub wet: f32,
    /// Whether the inside of the surface is seen.
    pub inside: bool,
    /// Whether it shows through what is see-through.
    pub shows_through: bool,
}

impl Sample {
    pub const NOTHING: Self = Self {
        inverse_depth: 0.0,
        normal: [0.0; 3],
        albedo: Colour::BLACK,
        wet: 0.0,
        inside: false,
        shows_through: false,
    };
}

/// A rectangle of samples: part of a picture, `per_pixel` along each side of a pixel.
#[derive(Clone, Debug)]
pub(super) struct Samples {
    pub width: usize,
    pub height: usize,
    /// First row of pixels.
    pub top: usize,
    pub per_pixel: usize,
    pub samples: Vec<Sample>,
}

/// A triangle ready to be drawn: corners in pixels, normals, paint at the corners.
#[derive(Clone, Copy, Debug)]
pub(super) struct Painted<'a> {
    pub corners: [Projected; 3],
    pub normals: [[f32; 3]; 3],
    pub paint: [PaintAt; 3],
    /// Blood at the corners [m].
    pub film: [f32; 3],
    pub textured: Option<Textured<'a>>,
    /// Whether the edges 01, 12, 20 are lines.
    pub edges: [bool; 3],
    pub wireframe: bool,
    pub map: ColourMap,
    pub faces: Faces,
    pub see_through: bool,
}

/// A texture, and of the corners where they rest [m] and the normals there.
#[derive(Clone, Copy, Debug)]
pub(super) struct Textured<'a> {
    pub texture: &'a Texture,
    pub rest: [[Vec3; 2]; 3],
}

impl Textured<'_> {
    fn colour(&self, weights: [f32; 3]) -> Colour {
        let of = |part: usize| -> Vec3 {
            self.rest.iter().zip(weights).map(|(rest, weight)| rest[part] * f64::from(weight)).sum()
        };
        self.texture.colour(of(0), of(1).try_normalised().unwrap_or(Vec3::Z))
    }
}

/// A colour, or a value that becomes a colour after interpolation.
#[derive(Clone, Copy, Debug)]
pub(super) enum PaintAt {
    Colour(Colour),
    /// Along the colour map, 0 to 1.
    Value(f32),
}

/// Half the width of the edges of a mesh [pixels].
const HALF_EDGE: f64 = 0.55;
/// How much of the paint stays under an edge.
const EDGE_SHADE: f32 = 0.22;

impl Samples {
    /// Whether a place is seen: nothing drawn here stands before it by more than `lift` of its distance.
    pub fn shows(&self, place: Projected, lift: f64) -> bool {
        let sample = |along: f64, most: usize| {
            let index = along * self.per_pixel as f64;
            (0.0..most as f64).contains(&index).then_some(index as usize)
        };
        let at = sample(place.x, self.width).zip(sample(place.y - self.top as f64, self.height));
        let before = at.map_or(0.0, |(column, row)| self.samples[row * self.width + column].inverse_depth);
        place.inverse_depth > 0.0 && place.inverse_depth * (1.0 + lift) >= f64::from(before)
    }

    pub fn new(width: usize, height: usize, top: usize, per_pixel: usize) -> Self {
        let count = width * height * per_pixel * per_pixel;
        Self {
            width: width * per_pixel,
            height: height * per_pixel,
            top,
            per_pixel,
            samples: vec![Sample::NOTHING; count],
        }
    }

    /// Position of a sample in the picture [pixels].
    pub fn position(&self, column: usize, row: usize) -> (f64, f64) {
        let scale = 1.0 / self.per_pixel as f64;
        ((column as f64 + 0.5) * scale, self.top as f64 + (row as f64 + 0.5) * scale)
    }

    /// Samples whose positions may lie between `low` and `high` pixels, along one side.
    fn span(&self, low: f64, high: f64, origin: f64, count: usize) -> std::ops::Range<usize> {
        let scale = self.per_pixel as f64;
        let first = ((low - origin) * scale - 0.5).ceil().clamp(0.0, count as f64);
        let last = ((high - origin) * scale - 0.5).floor().clamp(-1.0, count as f64 - 1.0);
        first as usize..(last + 1.0) as usize
    }

    /// Every second sample, alike in all pixels that have several: these keep what is behind something see-through.
    fn is_of_pattern(&self, row: usize, column: usize) -> bool {
        let n = if self.per_pixel > 1 { self.per_pixel } else { 2 };
        (row % n + column % n).is_multiple_of(2)
    }

    pub fn draw(&mut self, triangle: &Painted) {
        let [a, b, c] = triangle.corners;
        if [a, b, c].iter().any(|corner| corner.inverse_depth <= 0.0) {
            return;
        }
        // twice the signed area; y points downward, so a front seen from outside is negative
        let area = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
        if area == 0.0 || !area.is_finite() || (area > 0.0 && triangle.faces == Faces::Front) {
            return;
        }
        let extent = |of: fn(&Projected) -> f64| {
            let values = [of(&a), of(&b), of(&c)];
            values.into_iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
                (low.min(value), high.max(value))
            })
        };
        let ((left, right), (top, bottom)) = (extent(|p| p.x), extent(|p| p.y));
        let columns = self.span(left, right, 0.0, self.width);
        let rows = self.span(top, bottom, self.top as f64, self.height);
        let heights = edge_heights([a, b, c], area);
        for row in rows {
            for column in columns.clone() {
                let (x, y) = self.position(column, row);
                // weights of the corners in the picture
                let u = ((b.x - x) * (c.y - y) - (c.x - x) * (b.y - y)) / area;
                let v = ((c.x - x) * (a.y - y) - (a.x - x) * (c.y - y)) / area;
                let w = 1.0 - u - v;
                if u < 0.0 || v < 0.0 || w < 0.0 {
                    continue;
                }
                let inverse_depth = u * a.inverse_depth + v * b.inverse_depth + w * c.inverse_depth;
                let is_kept = triangle.see_through && self.is_of_pattern(row, column);
                let slot = &mut self.samples[row * self.width + column];
                if inverse_depth as f32 <= slot.inverse_depth || (is_kept && slot.shows_through) {
                    continue;
                }
                // distances to the edges 01, 12, 20 are those of the weights of the opposite corners
                let to_edge = [w * heights[2], u * heights[0], v * heights[1]];
                let on_edge = (0..3).any(|edge| triangle.edges[edge] && to_edge[edge] < HALF_EDGE);
                if triangle.wireframe && !on_edge {
                    continue;
                }
                // weights on the triangle itself: perspective undone
                let weights = [u * a.inverse_depth, v * b.inverse_depth, w * c.inverse_depth]
                    .map(|weight| (weight / inverse_depth) as f32);
                *slot = triangle.sample(weights, inverse_depth as f32, area > 0.0);
                if on_edge && !triangle.wireframe {
                    slot.albedo = slot.albedo.scaled(EDGE_SHADE);
                }
            }
        }
    }
}

/// What a ball is drawn with.
#[derive(Clone, Copy, Debug)]
pub(super) struct BallPaint {
    pub paint: PaintAt,
    pub map: ColourMap,
    pub see_through: bool,
}

impl Samples {
    /// Draws a ball that stands before the eye as a whole.
    pub fn draw_ball(&mut self, camera: &Camera, ball: &Ball, with: &BallPaint) {
        let depth = camera.depth(ball.centre);
        if !(ball.is_finite() && depth.is_finite()) || depth - ball.radius <= camera.near {
            return;
        }
        let middle = camera.project(ball.centre);
        // of what is nearer than the centre, and beside the axis of the camera
        let stretched = camera.ray(middle.x, middle.y).length() / (depth - ball.radius);
        let reach = camera.focal() * ball.radius * stretched;
        let columns = self.span(middle.x - reach, middle.x + reach, 0.0, self.width);
        let rows = self.span(middle.y - reach, middle.y + reach, self.top as f64, self.height);
        for row in rows {
            for column in columns.clone() {
                let (x, y) = self.position(column, row);
                // the ray is one long along the axis of the camera: its length to the ball is the depth
                let Some((depth, normal)) = ball.met_by(camera.eye, camera.ray(x, y)) else { continue };
                let inverse_depth = (1.0 / depth) as f32;
                let is_kept = with.see_through && self.is_of_pattern(row, column);
                let slot = &mut self.samples[row * self.width + column];
                if inverse_depth <= slot.inverse_depth || (is_kept && slot.shows_through) {
                    continue;
                }
                let albedo = match with.paint {
                    PaintAt::Colour(colour) => colour,
                    PaintAt::Value(at) => with.map.colour(f64::from(at)),
                };
                *slot = Sample {
                    inverse_depth,
                    normal: normal.to_array().map(|component| component as f32),
                    albedo,
                    wet: 0.0,
                    inside: false,
                    shows_through: !with.see_through,
                };
            }
        }
    }
}

/// Heights of a triangle over the edges opposite to its corners [pixels].
fn edge_heights([a, b, c]: [Projected; 3], area: f64) -> [f64; 3] {
    let length = |p: Projected, q: Projected| (p.x - q.x).hypot(p.y - q.y);
    [length(b, c), length(c, a), length(a, b)].map(|side| if side > 0.0 { area.abs() / side } else { 0.0 })
}

impl Painted<'_> {
    fn sample(&self, weights: [f32; 3], inverse_depth: f32, inside: bool) -> Sample {
        let mut normal = [0.0; 3];
        for (weight, corner) in weights.iter().zip(&self.normals) {
            for axis in 0..3 {
                normal[axis] += weight * corner[axis];
            }
        }
        if inside {
            normal = normal.map(|component| -component);
        }
        let film: f32 = weights.iter().zip(self.film).map(|(weight, film)| weight * film).sum();
        let (normal, bare) = (normalised(normal), self.albedo(weights));
        let (albedo, wet) =
            if film > 0.0 { (blood::seen_through(bare, film), blood::wetness(film)) } else { (bare, 0.0) };
        // lines are seen from all sides, and have no inside that lies in the dark
        let inside = inside && !self.wireframe;
        Sample { inverse_depth, normal, albedo, wet, inside, shows_through: !self.see_through }
    }

    fn albedo(&self, weights: [f32; 3]) -> Colour {
        let own = self.textured.as_ref().map(|textured| textured.colour(weights));
        let mut value = 0.0;
        for (weight, paint) in weights.iter().zip(&self.paint) {
            match paint {
                PaintAt::Colour(colour) => return own.unwrap_or(*colour),
                PaintAt::Value(at) => value += weight * at,
            }
        }
        match own {
            Some(own) => ColourMap::tissue_of(own, f64::from(value)),
            None => self.map.colour(f64::from(value)),
        }
    }
}

pub(super) fn normalised(v: [f32; 3]) -> [f32; 3] {
    let length = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
    if length > 0.0 { v.map(|component| component / length) } else { [0.0, 0.0, 1.0] }
}

/// Distance of a point to a segment in the picture, and how far along the segment the closest point is, 0 to 1.
pub(super) fn distance_point_segment(p: [f64; 2], a: [f64; 2], b: [f64; 2]) -> (f64, f64) {
    let (along, to) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
    let length_sq = along[0] * along[0] + along[1] * along[1];
    let t = if length_sq > 0.0 {
        ((to[0] * along[0] + to[1] * along[1]) / length_sq).clamp(0.0, 1.0)
    } else {
        0.0
    };
    ((to[0] - t * along[0]).hypot(to[1] - t * along[1]), t)
}
