//! Pictures without a display and without a graphics card: a rasteriser with soft light, a colour map with its
//! legend, edges, arrows, dots, a ground that shows contact. The same bits on every run.

mod animated_png;
mod balls;
mod blood;
mod camera;
mod colour;
mod colour_map;
mod colour_scale;
mod gif;
mod glyphs;
mod ground;
mod image;
mod images;
mod layout;
mod legend;
mod lettering;
mod light;
mod marks;
mod mesh_surface;
mod near;
mod raster;
mod shadow;
mod stroke;
mod surface;
mod texture;
mod tubes;

use souple_math::Vec3;
use souple_mesh::BoundingBox;

use crate::IoError;
use camera::Camera;
use ground::ShadedGround;
use layout::Layout;
use light::Lamps;
use marks::Placed;
use near::Corner;
use raster::{BallPaint, PaintAt, Painted, Samples, Textured};
use shadow::Shadow;

pub use animated_png::write_animated_png;
pub use balls::Ball;
pub use camera::{Framed, View};
pub use colour::Colour;
pub use colour_map::{COLOUR_MAPS, ColourMap, ELEMENT_KINDS};
pub use colour_scale::{COLOUR_SCALES, ColourScale};
pub use gif::write_gif;
pub use ground::Ground;
pub use image::Image;
pub(crate) use image::{Anchor, Canvas};
pub use images::{ImageFile, Images};
pub(crate) use legend::{labels, ticks};
pub use marks::{ArrowKey, LEGEND, Label, Marks, MarksStrip};
pub use mesh_surface::{Between, Cut, MeshSurface};
pub use surface::{EdgeStyle, Faces, Laid, Paint, Stroke, StrokeShape, Surface};
pub use texture::{MOST_TEXELS, PATTERNS, Pattern, Texture, TextureFigure, read_texture};

/// Everything that a picture shows and how.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    pub surfaces: Vec<Surface>,
    /// Drawn behind nothing: a stroke inside a surface shines through.
    pub strokes: Vec<Stroke>,
    pub ground: Option<Ground>,
    pub view: View,
    /// What the camera stands back for; the bounds of the view where there is nothing of it.
    pub framed: Vec<Framed>,
    /// Width and height [pixels].
    pub size: [usize; 2],
    /// Samples along each side of a pixel: 1 is rough, 2 good, 3 fine.
    pub samples_per_pixel: usize,
    pub theme: Theme,
    pub backdrop: Backdrop,
    /// Written at the top, if not empty.
    pub title: String,
    /// Written under the title, smaller, if not empty.
    pub subtitle: String,
    /// What the colours mean; surfaces painted by values need one.
    pub legend: Option<Legend>,
    /// From values to colours.
    pub colours: ColourMap,
    pub scale: ColourScale,
    pub marks: Marks,
    /// Text over all else, beside where a place is seen.
    pub labels: Vec<Label>,
    /// What the length of arrows means.
    pub key: Option<ArrowKey>,
    /// Height of letters, in those of a picture that is looked at by itself.
    pub letters: f64,
}

/// The quantity of a colour map.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Legend {
    pub title: String,
    pub unit: String,
    /// Values of the first and the last colour; those of the surfaces where `None`.
    pub range: Option<(f64, f64)>,
    pub place: LegendPlace,
    /// Names of values, in the place of numbers.
    pub names: Vec<(f64, String)>,
    /// Whether there are values below the first and above the last colour.
    pub beyond: [bool; 2],
}

/// Where a legend is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LegendPlace {
    /// On the right of the subject.
    #[default]
    Beside,
    /// By itself, one for several pictures, by [`Picture::legend_strip`].
    Apart,
}

/// What is behind the subject.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Backdrop {
    /// Lighter above than below.
    #[default]
    Graded,
    /// One colour: pictures that stand under each other make no bands.
    Plain,
    /// That of paper.
    White,
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
            framed: Vec::new(),
            size: [1280, 800],
            samples_per_pixel: 2,
            theme: Theme::default(),
            backdrop: Backdrop::default(),
            title: String::new(),
            subtitle: String::new(),
            legend: None,
            colours: ColourMap::default(),
            scale: ColourScale::default(),
            marks: Marks::default(),
            labels: Vec::new(),
            key: None,
            letters: 1.0,
        }
    }
}

/// Largest side of a picture [pixels].
const LARGEST_SIDE: usize = 16384;
const MOST_SAMPLES: usize = 8;
/// Share of the light of the ground that comes from the lamp that throws shadows.
const GROUND_SHADOW: f32 = 0.3;
/// Rows of pixels that are sampled at once, to keep memory small.
const BAND: usize = 64;

/// From the origin, in sizes of what is shown.
const FAR: f64 = 1e3;

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
        if let Some(near) = self.about_origin() {
            return near.render();
        }
        let [width, height] = self.size;
        let range = self.range();
        let layout = Layout::of(self, range);
        let bounds = self.bounds();
        let camera = self.camera(bounds, &layout);
        let triangles = self.painted(&camera, range);
        let draw_balls = |samples: &mut Samples, of: fn(&Surface) -> bool| {
            for surface in self.surfaces.iter().filter(|surface| of(surface)) {
                for (ball, paint) in self.painted_balls(surface, range) {
                    samples.draw_ball(&camera, &ball, &paint);
                }
            }
        };
        let ground = self.ground.and_then(|ground| ShadedGround::of(ground, &self.surfaces, bounds));

        let mut whole = Samples::new(width, height, 0, 1);
        // what is seen through shades no corners
        triangles.iter().filter(|triangle| !triangle.see_through).for_each(|triangle| whole.draw(triangle));
        draw_balls(&mut whole, |surface| !surface.see_through);
        let open = light::openness(&whole, &camera, 0.09 * bounds.diagonal().max(f64::MIN_POSITIVE));
        let strokes = stroke::prepared(&self.strokes, &camera, &whole);
        drop(whole);

        let lamps = Lamps::of(&camera, &self.view);
        let scene = Scene {
            camera,
            shadow: Shadow::of(&self.surfaces, lamps.key()),
            lamps,
            palette: self.palette(),
            ground,
            fades: self.backdrop != Backdrop::Graded,
            open,
            strokes,
        };
        let mut canvas = Canvas::new(width, height);
        for top in (0..height).step_by(BAND) {
            let mut samples = Samples::new(width, BAND.min(height - top), top, self.samples_per_pixel);
            triangles
                .iter()
                .filter(|triangle| !triangle.see_through)
                .for_each(|triangle| samples.draw(triangle));
            draw_balls(&mut samples, |surface| !surface.see_through);
            triangles
                .iter()
                .filter(|triangle| triangle.see_through)
                .for_each(|triangle| samples.draw(triangle));
            draw_balls(&mut samples, |surface| surface.see_through);
            scene.develop(&samples, &mut canvas);
        }
        layout.write(self, &scene.palette, &mut canvas);
        let marks = Placed::of(self, &scene.camera, &layout, &scene.palette);
        marks.write(layout.letter, &scene.palette, &mut canvas);
        for mark in
            self.labels.iter().filter_map(|label| label.mark(&scene.camera, layout.letter, &scene.palette))
        {
            mark.write(layout.letter, &scene.palette, &mut canvas);
        }
        Ok(canvas.finish())
    }

    /// What is behind the subject, at the bottom.
    pub fn background(&self) -> [u8; 3] {
        self.palette().bottom.to_screen()
    }

    fn palette(&self) -> Palette {
        let palette = self.theme.palette();
        match self.backdrop {
            Backdrop::Graded => palette,
            Backdrop::Plain => Palette { top: palette.bottom, ..palette },
            Backdrop::White => Palette { top: Colour::WHITE, bottom: Colour::WHITE, ..palette },
        }
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

    /// The same about the origin, of what stands so far from it that maps of shadow and depth would round it away.
    fn about_origin(&self) -> Option<Self> {
        let bounds = self.bounds();
        let by = -bounds.centre();
        if !by.is_finite() || by.length() <= FAR * bounds.diagonal() {
            return None;
        }
        let mut near = self.clone();
        let points = near.surfaces.iter_mut().flat_map(|surface| {
            surface.points.iter_mut().chain(surface.balls.iter_mut().map(|ball| &mut ball.centre))
        });
        let points = points.chain(near.strokes.iter_mut().flat_map(|stroke| stroke.shape.points_mut()));
        let points = points.chain(near.labels.iter_mut().map(|label| &mut label.at));
        let points = points.chain(near.framed.iter_mut().map(|ball| &mut ball.centre));
        let points = points.chain(near.ground.iter_mut().map(|ground| &mut ground.point));
        points.chain(near.view.eye.iter_mut()).for_each(|point| *point += by);
        if let Some(bounds) = &mut near.view.bounds {
            *bounds = BoundingBox { low: bounds.low + by, high: bounds.high + by };
        }
        Some(near)
    }

    fn shown_points(&self) -> impl Iterator<Item = Vec3> + '_ {
        let corners = self.surfaces.iter().flat_map(|surface| {
            surface.triangles.iter().flatten().map(|corner| surface.points[*corner as usize])
        });
        let strokes = self.strokes.iter().flat_map(|stroke| stroke.shape.points());
        let balls = self.surfaces.iter().flat_map(|surface| &surface.balls);
        let balls = balls.flat_map(|ball| ball.extremes([Vec3::X, Vec3::Y, Vec3::Z]));
        corners.chain(balls).chain(strokes).filter(|point| point.is_finite())
    }

    fn bounds(&self) -> BoundingBox {
        let shown = || BoundingBox::of(self.shown_points());
        let bounds = self.view.bounds.unwrap_or_else(shown);
        let finite = bounds.low.is_finite() && bounds.high.is_finite();
        if finite { bounds } else { BoundingBox { low: Vec3::ZERO, high: Vec3::ZERO } }
    }

    fn camera(&self, bounds: BoundingBox, layout: &Layout) -> Camera {
        let height = self.size[1] as f64;
        let framed = self.framed.iter().copied().filter(|ball| ball.centre.is_finite());
        match self.view.bounds {
            _ if framed.clone().next().is_some() => Camera::fitted(&self.view, framed, layout.frame, height),
            Some(_) => Camera::fitted(&self.view, bounds.corners(), layout.frame, height),
            None => Camera::fitted(&self.view, self.shown_points(), layout.frame, height),
        }
    }

    /// Values of the ends of the colour map.
    fn range(&self) -> (f64, f64) {
        let given = self.legend.as_ref().and_then(|legend| legend.range).or(self.colours.own_range());
        let of_surfaces = || {
            let ranges = self.surfaces.iter().filter_map(|surface| surface.range(self.scale));
            ranges.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
        };
        let (low, high) = given.or_else(of_surfaces).unwrap_or((0.0, 1.0));
        let spread = |range| self.scale.spread(self.colours.spread(range));
        let (low, high) = if given.is_some() { (low, high) } else { spread((low, high)) };
        match () {
            () if low < high => (low, high),
            // zeros have the colour of zero
            () if low == 0.0 => self.colours.spread((0.0, f64::MIN_POSITIVE)),
            () => (low, low + low.abs()),
        }
    }

    fn painted(&self, camera: &Camera, range: (f64, f64)) -> Vec<Painted<'_>> {
        let share = |value: f64| PaintAt::Value(self.scale.share(value, range) as f32);
        let mut painted = Vec::new();
        for surface in &self.surfaces {
            let normals = surface.corner_normals();
            for (triangle, corners) in surface.triangles.iter().enumerate() {
                let paint = match &surface.paint {
                    Paint::Plain(colour) => [PaintAt::Colour(*colour); 3],
                    Paint::PointScalar(values) => corners.map(|corner| share(values[corner as usize])),
                    Paint::TriangleScalar(values) => [share(values[triangle]); 3],
                };
                let all = [surface.edge_style != EdgeStyle::Hidden; 3];
                let marked = surface.edges.get(triangle).copied().unwrap_or([true; 3]);
                let corner = |k: usize| Corner {
                    place: surface.points[corners[k] as usize],
                    normal: normals[triangle][k].to_array().map(|component| component as f32),
                    paint: paint[k],
                    film: surface.film.get(corners[k] as usize).map_or(0.0, |film| *film as f32),
                    rest: surface.texture.as_ref().map_or([Vec3::ZERO; 2], |laid| laid.at(corners[k])),
                };
                let edges = [0, 1, 2].map(|edge: usize| all[edge] && marked[edge]);
                let before = near::before_eye(camera, [0, 1, 2].map(corner), edges);
                painted.extend(before.into_iter().map(|(corners, edges)| Painted {
                    corners: corners.map(|corner| camera.project(corner.place)),
                    normals: corners.map(|corner| corner.normal),
                    paint: corners.map(|corner| corner.paint),
                    film: corners.map(|corner| corner.film),
                    textured: surface.texture.as_ref().map(|laid| Textured {
                        texture: &laid.texture,
                        rest: corners.map(|corner| corner.rest),
                    }),
                    edges,
                    wireframe: surface.edge_style == EdgeStyle::Wireframe,
                    map: self.colours,
                    faces: surface.faces,
                    see_through: surface.see_through,
                }));
            }
        }
        painted
    }
}

impl Picture {
    fn painted_balls<'a>(
        &'a self,
        surface: &'a Surface,
        range: (f64, f64),
    ) -> impl Iterator<Item = (Ball, BallPaint)> + 'a {
        surface.balls.iter().enumerate().map(move |(number, ball)| {
            let share = |value: f64| PaintAt::Value(self.scale.share(value, range) as f32);
            let paint = match &surface.paint {
                Paint::Plain(colour) => PaintAt::Colour(*colour),
                Paint::PointScalar(values) => share(values[surface.points.len() + number]),
                // of triangles
                Paint::TriangleScalar(_) => share(f64::NAN),
            };
            (*ball, BallPaint { paint, map: self.colours, see_through: surface.see_through })
        })
    }
}

/// Part of a side of a picture over which its ground fades at either end.
const FADED: f64 = 0.12;

/// How far a place along a side is from both of its ends: nothing at them, one beyond the part that fades.
fn inside(along: f64, side: usize) -> f32 {
    let part = along / side as f64;
    let near = (part.min(1.0 - part) / FADED).clamp(0.0, 1.0);
    // without a crease where it begins
    (near * near * (3.0 - 2.0 * near)) as f32
}

/// What samples are developed with.
struct Scene {
    camera: Camera,
    lamps: Lamps,
    shadow: Shadow,
    palette: Palette,
    ground: Option<ShadedGround>,
    /// Whether the ground goes over into the background towards the borders, as those of pictures that stand side by side.
    fades: bool,
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
                let (mut colour, inverse_depth) =
                    self.light(sample, [x, y], pixel, [canvas.width, canvas.height]);
                for stroke in &strokes {
                    colour = stroke.over(colour, [x, y], inverse_depth);
                }
                canvas.pixels[pixel] = canvas.pixels[pixel].plus(colour.scaled(share));
            }
        }
    }

    /// `size`: of the picture [pixels].
    fn light(
        &self,
        sample: &raster::Sample,
        [x, y]: [f64; 2],
        pixel: usize,
        size: [usize; 2],
    ) -> (Colour, f32) {
        let ray = self.camera.ray(x, y);
        let below = self.ground.as_ref().map_or(0.0, |ground| ground.inverse_depth(&self.camera, ray));
        if sample.inverse_depth <= below {
            let background = self.palette.background(y, size[1]);
            let colour = match &self.ground {
                Some(ground) if below > 0.0 => {
                    let colour = ground.colour(&self.camera, ray, background, self.palette.grid);
                    let place = self.camera.eye + ray * (1.0 / f64::from(below));
                    let shadow = GROUND_SHADOW * (1.0 - self.shadow.lit(place, None, x, y));
                    let seen = if self.fades { inside(x, size[0]).min(inside(y, size[1])) } else { 1.0 };
                    background.mixed(colour.scaled(1.0 - shadow), seen)
                }
                _ => background,
            };
            return (colour, below);
        }
        let view = (-ray).try_normalised().unwrap_or(Vec3::Z);
        let place = self.camera.eye + ray * (1.0 / f64::from(sample.inverse_depth));
        let [nx, ny, nz] = sample.normal.map(f64::from);
        let lit = self.shadow.lit(place, Some(Vec3::new(nx, ny, nz)), x, y);
        // where the pixel's own sample fell beside the surface, its share says nothing
        (self.lamps.shade(sample, view, self.open[pixel], lit), sample.inverse_depth)
    }
}

#[cfg(test)]
mod tests;
