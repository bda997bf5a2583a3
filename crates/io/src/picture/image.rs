//! A picture as pixels: blending, thin lines, letters, PNG.

use std::path::Path;

use super::colour::Colour;
use super::lettering::{text_strokes, text_width};
use super::raster::distance_point_segment;
use crate::{IoError, write_file};

/// Pixels as a screen shows them, row after row from the top: red, green, blue.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image {
    pub width: usize,
    pub height: usize,
    pub pixels: Vec<[u8; 3]>,
}

impl Image {
    /// # Errors
    /// The file cannot be written.
    pub fn write_png(&self, path: &Path) -> Result<(), IoError> {
        write_file(path, |out| {
            let mut encoder = png::Encoder::new(out, self.width as u32, self.height as u32);
            encoder.set_color(png::ColorType::Rgb);
            encoder.set_depth(png::BitDepth::Eight);
            encoder.set_compression(png::Compression::High);
            encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
            let mut writer = encoder.write_header().map_err(cause)?;
            writer.write_image_data(self.pixels.as_flattened()).map_err(cause)?;
            writer.finish().map_err(cause)
        })
    }
}

/// What the system said, which tells a full disk from other trouble.
pub(super) fn cause(error: png::EncodingError) -> std::io::Error {
    match error {
        png::EncodingError::IoError(error) => error,
        other => other.into(),
    }
}

impl Image {
    /// Several images as one, row by row, each in a cell as large as the largest; what is left free has one colour.
    pub fn sheet(images: &[Self], columns: usize, background: [u8; 3]) -> Self {
        let columns = columns.clamp(1, images.len().max(1));
        let side = |of: fn(&Self) -> usize| images.iter().map(of).max().unwrap_or(1);
        let [width, height] = [side(|image| image.width), side(|image| image.height)];
        let rows = images.len().div_ceil(columns).max(1);
        let mut sheet = Self {
            width: width * columns,
            height: height * rows,
            pixels: vec![background; width * columns * height * rows],
        };
        for (index, image) in images.iter().enumerate() {
            let (left, top) = (index % columns * width, index / columns * height);
            for row in 0..image.height {
                let to = (top + row) * sheet.width + left;
                let from = row * image.width;
                sheet.pixels[to..to + image.width].copy_from_slice(&image.pixels[from..from + image.width]);
            }
        }
        sheet
    }
}

/// Where a text is anchored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Anchor {
    Left,
    Middle,
    Right,
}

/// Pixels in linear light, to draw on.
#[derive(Clone, Debug)]
pub(crate) struct Canvas {
    pub width: usize,
    pub height: usize,
    pub pixels: Vec<Colour>,
}

impl Canvas {
    pub fn new(width: usize, height: usize) -> Self {
        Self { width, height, pixels: vec![Colour::BLACK; width * height] }
    }

    pub fn finish(self) -> Image {
        let pixels = self.pixels.into_iter().map(Colour::to_screen).collect();
        Image { width: self.width, height: self.height, pixels }
    }

    /// A line through points, round at its ends; `width` in pixels.
    pub fn line(&mut self, points: &[[f64; 2]], width: f64, colour: Colour) {
        let reach = 0.5 * width + 1.0;
        let side = |axis: usize, count: usize| {
            let low = points.iter().map(|point| point[axis]).fold(f64::INFINITY, f64::min) - reach;
            let high = points.iter().map(|point| point[axis]).fold(f64::NEG_INFINITY, f64::max) + reach;
            let clip = |value: f64| value.clamp(0.0, count as f64) as usize;
            clip(low.floor())..clip(high.ceil())
        };
        for row in side(1, self.height) {
            for column in side(0, self.width) {
                let place = [column as f64 + 0.5, row as f64 + 0.5];
                let distance = points
                    .windows(2)
                    .map(|pair| distance_point_segment(place, pair[0], pair[1]).0)
                    .fold(f64::INFINITY, f64::min);
                let cover = (0.5 * width + 0.5 - distance).clamp(0.0, 1.0) as f32;
                self.blend(column, row, colour, cover);
            }
        }
    }

    pub fn blend(&mut self, column: usize, row: usize, colour: Colour, amount: f32) {
        let pixel = &mut self.pixels[row * self.width + column];
        *pixel = pixel.mixed(colour, amount);
    }

    /// A filled rectangle of whole pixels.
    pub fn fill(
        &mut self,
        columns: std::ops::Range<usize>,
        rows: std::ops::Range<usize>,
        colour: Colour,
        amount: f32,
    ) {
        for row in rows.start..rows.end.min(self.height) {
            for column in columns.start..columns.end.min(self.width) {
                self.blend(column, row, colour, amount);
            }
        }
    }

    /// A line of text; `height` is that of capitals, `y` the baseline.
    pub fn text(&mut self, text: &str, place: [f64; 2], height: f64, anchor: Anchor, colour: Colour) {
        self.letters(text, (place, height), anchor, (colour, 0.0), |[x, y]| [x, y]);
    }

    /// What lies around the strokes of a line of text, as far as half of `width` [pixels].
    pub fn text_halo(&mut self, text: &str, place: [f64; 2], height: f64, width: f64, colour: Colour) {
        self.letters(text, (place, height), Anchor::Middle, (colour, width), |[x, y]| [x, y]);
    }

    /// The same, written from below upward: `x` is the baseline.
    pub fn text_upward(&mut self, text: &str, [x, y]: [f64; 2], height: f64, anchor: Anchor, colour: Colour) {
        let turned = |[along, below]: [f64; 2]| [x + below - y, y - (along - x)];
        self.letters(text, ([x, y], height), anchor, (colour, 0.0), turned);
    }

    fn letters(
        &mut self,
        text: &str,
        ([x, y], height): ([f64; 2], f64),
        anchor: Anchor,
        (colour, wider): (Colour, f64),
        turned: impl Fn([f64; 2]) -> [f64; 2],
    ) {
        let width = text_width(text, height);
        let left = match anchor {
            Anchor::Left => x,
            Anchor::Middle => x - 0.5 * width,
            Anchor::Right => x - width,
        };
        for stroke in text_strokes(text, left, y, height) {
            let stroke: Vec<[f64; 2]> = stroke.into_iter().map(&turned).collect();
            self.line(&stroke, (0.115 * height).max(1.15) + wider, colour);
        }
    }
}
