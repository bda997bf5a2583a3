//! Pictures without a display and without a graphics card: a rasteriser with soft light, a colour map with its
//! legend, edges, arrows, dots, a ground that shows contact. The same bits on every run.

mod camera;
mod colour;
mod ground;
mod image;
mod legend;
mod lettering;
mod light;
mod raster;
mod stroke;
mod surface;

use souple_math::Vec3;
use souple_mesh::BoundingBox;

use crate::IoError;
use camera::{Camera, Frame};
use colour::colour_map as map_colour;
use ground::ShadedGround;
use image::{Anchor, Canvas};
use light::Lamps;
use raster::{PaintAt, Painted, Samples};

pub use camera::View;
pub use colour::{Colour, colour_map};
pub use ground::Ground;
pub use image::Image;
pub(crate) use legend::{labels, ticks};
pub use surface::{EdgeStyle, MeshSurface, Paint, Stroke, StrokeShape, Surface};

/// Everything that a picture shows and how.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    pub surfaces: Vec<Surface>,
    /// Drawn behind nothing: a stroke inside a surface shines through faintly.
    pub strokes: Vec<Stroke>,
    pub ground: Option<Ground>,
    pub view: View,
    /// Width and height [pixels].
    pub size: [usize; 2],
    /// Samples along each side of a pixel: 1 is rough, 2 good, 3 fine.
    pub samples_per_pixel: usize,
    pub theme: Theme,
    /// Written at the top, if not empty.
    pub title: String,
    /// Written under the title, smaller, if not empty.
    pub subtitle: String,
    /// What the colours mean; surfaces painted by values need one.
    pub legend: Option<Legend>,
}

/// The quantity of a colour map.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Legend {
    pub title: String,
    pub unit: String,
    /// Values of the first and the last colour; those of the surfaces where `None`.
    pub range: Option<(f64, f64)>,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Theme {
    #[default]
    Light,
    Dark,
}

impl Default for Picture {
    fn default() -> Self {
        Self {
            surfaces: Vec::new(),
            strokes: Vec::new(),
            ground: None,
            view: View::default(),
            size: [1280, 800],
            samples_per_pixel: 2,
            theme: Theme::default(),
            title: String::new(),
            subtitle: String::new(),
            legend: None,
        }
    }
}

/// Largest side of a picture [pixels].
const LARGEST_SIDE: usize = 16384;
const MOST_SAMPLES: usize = 8;
/// Rows of pixels that are sampled at once, to keep memory small.
const BAND: usize = 64;

/// Colours of a theme.
struct Palette {
    top: Colour,
    bottom: Colour,
    ink: Colour,
    /// Colour and strength of the lines of the ground.
    grid: (Colour, f32),
}

impl Theme {
    fn palette(self) -> Palette {
        let colour = Colour::from_screen;
        match self {
            Self::Light => Palette {
                top: colour([252, 252, 253]),
                bottom: colour([214, 220, 228]),
                ink: colour([34, 40, 49]),
                grid: (Colour::BLACK, 0.2),
            },
            Self::Dark => Palette {
                top: colour([58, 64, 74]),
                bottom: colour([20, 22, 27]),
                ink: colour([232, 235, 240]),
                // a little white shows far on black
                grid: (Colour::WHITE, 0.05),
            },
        }
    }
}

impl Palette {
    fn background(&self, row: f64, height: usize) -> Colour {
        self.top.mixed(self.bottom, (row / height as f64) as f32)
    }
}

impl Picture {
    /// Draws the picture.
    ///
    /// # Errors
    /// A size out of range; a surface whose lists do not fit each other.
    pub fn render(&self) -> Result<Image, IoError> {
        self.check()?;
        let [width, height] = self.size;
        let layout = Layout::of(self);
        let bounds = self.bounds();
        let camera = self.camera(bounds, &layout);
        let range = self.range();
        let triangles = self.painted(&camera, range);
        let ground = self.ground.and_then(|ground| ShadedGround::of(ground, &self.surfaces, bounds));

        let mut whole = Samples::new(width, height, 0, 1);
        triangles.iter().for_each(|triangle| whole.draw(triangle));
        let open = light::openness(&whole, &camera, 0.09 * bounds.diagonal().max(f64::MIN_POSITIVE));
        drop(whole);

        let scene = Scene {
            camera,
            lamps: Lamps::of(&camera, self.view.up),
            palette: self.theme.palette(),
            ground,
            open,
            strokes: stroke::prepared(&self.strokes, &camera),
        };
        let mut canvas = Canvas::new(width, height);
        for top in (0..height).step_by(BAND) {
            let mut samples = Samples::new(width, BAND.min(height - top), top, self.samples_per_pixel);
            triangles.iter().for_each(|triangle| samples.draw(triangle));
            scene.develop(&samples, &mut canvas);
        }
        layout.write(self, range, &scene.palette, &mut canvas);
        Ok(canvas.finish())
    }

    fn check(&self) -> Result<(), IoError> {
        for (side, name) in self.size.iter().zip(["width", "height"]) {
            if !(1..=LARGEST_SIDE).contains(side) {
                let expected = format!("1 to {LARGEST_SIDE} pixels");
                return Err(IoError::request(format!("the {name} of the picture"), side, expected));
            }
        }
        if !(1..=MOST_SAMPLES).contains(&self.samples_per_pixel) {
            let expected = format!("1 to {MOST_SAMPLES}");
            return Err(IoError::request(
                "the number of samples per pixel",
                self.samples_per_pixel,
                expected,
            ));
        }
        self.surfaces.iter().enumerate().try_for_each(|(number, surface)| surface.check(number))
    }

    fn shown_points(&self) -> impl Iterator<Item = Vec3> + '_ {
        let corners = self.surfaces.iter().flat_map(|surface| {
            surface.triangles.iter().flatten().map(|corner| surface.points[*corner as usize])
        });
        let strokes = self.strokes.iter().flat_map(|stroke| stroke.shape.points());
        corners.chain(strokes).filter(|point| point.is_finite())
    }

    fn bounds(&self) -> BoundingBox {
        let shown = || BoundingBox::of(self.shown_points());
        let bounds = self.view.bounds.unwrap_or_else(shown);
        let finite = bounds.low.is_finite() && bounds.high.is_finite();
        if finite { bounds } else { BoundingBox { low: Vec3::ZERO, high: Vec3::ZERO } }
    }

    fn camera(&self, bounds: BoundingBox, layout: &Layout) -> Camera {
        let height = self.size[1] as f64;
        match self.view.bounds {
            Some(_) => Camera::fitted(&self.view, corners_of(bounds), layout.frame, height),
            None => Camera::fitted(&self.view, self.shown_points(), layout.frame, height),
        }
    }

    /// Values of the ends of the colour map.
    fn range(&self) -> (f64, f64) {
        let given = self.legend.as_ref().and_then(|legend| legend.range);
        let of_surfaces = || {
            let ranges = self.surfaces.iter().filter_map(Surface::range);
            ranges.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
        };
        let (low, high) = given.or_else(of_surfaces).unwrap_or((0.0, 1.0));
        if low < high { (low, high) } else { (low, low + low.abs().max(f64::MIN_POSITIVE)) }
    }

    fn painted(&self, camera: &Camera, (low, high): (f64, f64)) -> Vec<Painted> {
        let share = |value: f64| PaintAt::Value(((value - low) / (high - low)) as f32);
        let mut painted = Vec::new();
        for surface in &self.surfaces {
            let projected: Vec<_> = surface.points.iter().map(|point| camera.project(*point)).collect();
            let normals = surface.corner_normals();
            for (triangle, corners) in surface.triangles.iter().enumerate() {
                let paint = match &surface.paint {
                    Paint::Plain(colour) => [PaintAt::Colour(*colour); 3],
                    Paint::PointScalar(values) => corners.map(|corner| share(values[corner as usize])),
                    Paint::TriangleScalar(values) => [share(values[triangle]); 3],
                };
                let all = [surface.edge_style != EdgeStyle::Hidden; 3];
                let marked = surface.edges.get(triangle).copied().unwrap_or([true; 3]);
                painted.push(Painted {
                    corners: corners.map(|corner| projected[corner as usize]),
                    normals: normals[triangle]
                        .map(|normal| normal.to_array().map(|component| component as f32)),
                    paint,
                    edges: [0, 1, 2].map(|edge: usize| all[edge] && marked[edge]),
                    wireframe: surface.edge_style == EdgeStyle::Wireframe,
                });
            }
        }
        painted
    }
}

/// The eight corners of a box.
fn corners_of(bounds: BoundingBox) -> impl Iterator<Item = Vec3> {
    (0..8).map(move |corner| {
        let pick = |axis: usize| if corner >> axis & 1 == 0 { bounds.low[axis] } else { bounds.high[axis] };
        Vec3::new(pick(0), pick(1), pick(2))
    })
}

/// What samples are developed with.
struct Scene {
    camera: Camera,
    lamps: Lamps,
    palette: Palette,
    ground: Option<ShadedGround>,
    /// Share of the sky that each pixel sees.
    open: Vec<f32>,
    strokes: Vec<stroke::Drawn>,
}

impl Scene {
    /// Light, ground and strokes for each sample; the mean of its samples for each pixel.
    fn develop(&self, samples: &Samples, canvas: &mut Canvas) {
        let n = samples.per_pixel;
        let share = 1.0 / (n * n) as f32;
        for row in 0..samples.height {
            let pixel_row = samples.top + row / n;
            let strokes = stroke::near_row(&self.strokes, pixel_row);
            for column in 0..samples.width {
                let pixel = pixel_row * canvas.width + column / n;
                let (x, y) = samples.position(column, row);
                let sample = &samples.samples[row * samples.width + column];
                let (mut colour, inverse_depth) = self.light(sample, x, y, pixel, canvas.height);
                for stroke in &strokes {
                    colour = stroke.over(colour, [x, y], inverse_depth);
                }
                canvas.pixels[pixel] = canvas.pixels[pixel].plus(colour.scaled(share));
            }
        }
    }

    fn light(&self, sample: &raster::Sample, x: f64, y: f64, pixel: usize, height: usize) -> (Colour, f32) {
        let ray = self.camera.ray(x, y);
        let below = self.ground.as_ref().map_or(0.0, |ground| ground.inverse_depth(&self.camera, ray));
        if sample.inverse_depth <= below {
            let background = self.palette.background(y, height);
            let colour = match &self.ground {
                Some(ground) if below > 0.0 => {
                    ground.colour(&self.camera, ray, background, self.palette.grid)
                }
                _ => background,
            };
            return (colour, below);
        }
        let view = (-ray).try_normalised().unwrap_or(Vec3::Z);
        // where the pixel's own sample fell beside the surface, its share says nothing
        (self.lamps.shade(sample, view, self.open[pixel]), sample.inverse_depth)
    }
}

/// Where title, legend and subject stand [pixels].
struct Layout {
    frame: Frame,
    /// Height of capitals of plain text.
    letter: f64,
    margin: f64,
    legend_left: f64,
    legend_top: f64,
    legend_height: f64,
}

impl Layout {
    fn of(picture: &Picture) -> Self {
        let [width, height] = picture.size.map(|side| side as f64);
        let letter = (0.0165 * height).max(8.0);
        let margin = 0.045 * width.min(height);
        let legend_width = if picture.legend.is_some() { 9.5 * letter } else { 0.0 };
        let lines = usize::from(!picture.title.is_empty()) as f64 * 2.4
            + usize::from(!picture.subtitle.is_empty()) as f64 * 1.8;
        // room for the shade around the place of contact
        let shade = if picture.ground.is_some() { 0.07 * height } else { 0.0 };
        let right = (width - margin - legend_width).max(0.5 * width);
        let top = (margin + lines * letter).min(0.4 * height);
        Self {
            frame: Frame { left: margin, top, right, bottom: (height - margin - shade).max(top + 1.0) },
            letter,
            margin,
            legend_left: width - margin - 7.5 * letter,
            legend_top: 0.5 * height - 0.21 * height,
            legend_height: 0.42 * height,
        }
    }

    fn write(&self, picture: &Picture, range: (f64, f64), palette: &Palette, canvas: &mut Canvas) {
        let mut baseline = self.margin + 1.15 * self.letter;
        if !picture.title.is_empty() {
            canvas.text(
                &picture.title,
                [self.margin, baseline],
                1.45 * self.letter,
                Anchor::Left,
                palette.ink,
            );
            baseline += 2.1 * self.letter;
        }
        if !picture.subtitle.is_empty() {
            let background = palette.background(baseline, canvas.height);
            let ink = palette.ink.mixed(background, 0.25);
            canvas.text(&picture.subtitle, [self.margin, baseline], self.letter, Anchor::Left, ink);
        }
        if let Some(legend) = &picture.legend {
            self.write_legend(legend, range, palette, canvas);
        }
    }

    fn write_legend(&self, legend: &Legend, (low, high): (f64, f64), palette: &Palette, canvas: &mut Canvas) {
        let whole = |value: f64| value.max(0.0) as usize;
        let (left, right) = (whole(self.legend_left), whole(self.legend_left + 1.4 * self.letter));
        let (top, bottom) = (whole(self.legend_top), whole(self.legend_top + self.legend_height));
        let span = (bottom - top).max(2) as f64;
        canvas.fill(left.saturating_sub(1)..right + 1, top.saturating_sub(1)..bottom + 1, palette.ink, 0.8);
        for row in top..bottom {
            let share = 1.0 - (row - top) as f64 / (span - 1.0);
            canvas.fill(left..right, row..row + 1, map_colour(share), 1.0);
        }
        let ticks = ticks(low, high, 5);
        for (tick, label) in ticks.iter().zip(labels(&ticks)) {
            let y = bottom as f64 - (tick - low) / (high - low) * span;
            let x = right as f64;
            canvas.line(&[[x + 1.0, y], [x + 0.45 * self.letter, y]], 1.2, palette.ink);
            let place = [x + 0.95 * self.letter, y + 0.5 * self.letter];
            canvas.text(&label, place, self.letter, Anchor::Left, palette.ink);
        }
        let title = if legend.unit.is_empty() {
            legend.title.clone()
        } else {
            format!("{} [{}]", legend.title, legend.unit)
        };
        // centred over the bar and its numbers, but never beyond the border of the picture
        let half = 0.5 * lettering::text_width(&title, self.letter);
        let middle =
            (self.legend_left + 3.2 * self.letter).min(canvas.width as f64 - 0.4 * self.margin - half);
        let place = [middle, top as f64 - 1.4 * self.letter];
        canvas.text(&title, place, self.letter, Anchor::Middle, palette.ink);
    }
}

#[cfg(test)]
mod tests;
