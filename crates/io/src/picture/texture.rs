//! Textures of surfaces: colours that stick to the matter, by where it rests.

use std::fs::File;
use std::io::{BufReader, ErrorKind};
use std::path::Path;
use std::sync::Arc;

use souple_math::Vec3;
use souple_table::{Entry, Table};

use super::colour::Colour;
use super::image::Image;
use crate::IoError;
use crate::error::{Fault, Place};

/// Most pixels along a side of the picture of a texture: what graphics cards take everywhere.
pub const MOST_TEXELS: usize = 4096;

/// The colour of a surface, by where it rests.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    pub figure: TextureFigure,
    /// After which a picture repeats itself; of a pattern that of its parts [m].
    pub size: f64,
}

/// What a texture shows.
#[derive(Clone, Debug, PartialEq)]
pub enum TextureFigure {
    /// Laid on along the three axes; between them each counts by how much a surface faces it.
    Picture(Arc<Image>),
    /// Between two colours.
    Pattern(Pattern, [Colour; 2]),
}

/// Patterns of tissue, made of noise (Perlin 2002).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pattern {
    /// Noise of several sizes, as it is.
    Mottled,
    /// Round spots.
    Spots,
    /// Drawn out along x.
    Fibres,
}

/// All patterns.
pub static PATTERNS: Table<Pattern> = Table {
    kind: "pattern",
    entries: &[
        &pattern("mottled", Pattern::Mottled, "blotches of several sizes, as of a liver"),
        &pattern("spots", Pattern::Spots, "round spots on an even ground, as of lobules"),
        &pattern("fibres", Pattern::Fibres, "drawn out along x, ten times as long as wide, as of a muscle"),
    ],
};

const fn pattern(name: &'static str, build: Pattern, summary: &'static str) -> Entry<Pattern> {
    Entry { name, summary, source: "noise: Perlin 2002", parameters: &[], build }
}

/// How much longer fibres are than wide.
const DRAWN_OUT: f64 = 10.0;
/// Sizes of noise, each half the one before and half as strong.
const OCTAVES: i32 = 4;

impl Pattern {
    /// How much of the second colour there is at a place, in sizes of the pattern, 0 to 1.
    pub fn share(self, place: Vec3) -> f64 {
        match self {
            Self::Mottled => (0.5 + 0.7 * octaves(place)).clamp(0.0, 1.0),
            Self::Spots => smooth_step(0.12, 0.32, noise(place)),
            Self::Fibres => {
                let drawn = Vec3::new(place.x / DRAWN_OUT, place.y, place.z);
                smooth_step(-0.3, 0.3, octaves(drawn))
            }
        }
    }
}

fn smooth_step(low: f64, high: f64, value: f64) -> f64 {
    let t = ((value - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

fn octaves(place: Vec3) -> f64 {
    (0..OCTAVES).map(|octave| noise(place * f64::from(1 << octave)) / f64::from(1 << octave)).sum()
}

/// Gradient noise, about -0.7 to 0.7: zero at whole numbers, smooth between them.
fn noise(place: Vec3) -> f64 {
    let low = [place.x.floor(), place.y.floor(), place.z.floor()];
    let within = [place.x - low[0], place.y - low[1], place.z - low[2]];
    let fade = within.map(|t| t * t * t * (t * (t * 6.0 - 15.0) + 10.0));
    let mut sum = 0.0;
    for corner in 0..8 {
        let at = [0, 1, 2].map(|axis: usize| (corner >> axis) & 1);
        let [i, j, k] = [0, 1, 2].map(|axis: usize| (low[axis] as i64).wrapping_add(at[axis]) as u32);
        let [x, y, z] = [0, 1, 2].map(|axis: usize| within[axis] - at[axis] as f64);
        let weight: f64 =
            (0..3).map(|axis| if at[axis] == 1 { fade[axis] } else { 1.0 - fade[axis] }).product();
        sum += weight * along_gradient(hash(i, j, k), x, y, z);
    }
    sum
}

/// One of twelve gradients, to the middles of the edges of a cube (Perlin 2002).
fn along_gradient(hash: u32, x: f64, y: f64, z: f64) -> f64 {
    let h = hash & 15;
    let u = if h < 8 { x } else { y };
    let v = if h < 4 {
        y
    } else if h == 12 || h == 14 {
        x
    } else {
        z
    };
    (if h & 1 == 0 { u } else { -u }) + (if h & 2 == 0 { v } else { -v })
}

/// Of a place on the lattice; the page has the same (PCG, O'Neill 2014).
fn hash(i: u32, j: u32, k: u32) -> u32 {
    let mixed = |number: u32| {
        let state = number.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
        let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
        (word >> 22) ^ word
    };
    mixed(i.wrapping_add(mixed(j.wrapping_add(mixed(k)))))
}

impl Texture {
    /// The colour where something rests [m], of a surface with this normal there.
    pub fn colour(&self, place: Vec3, normal: Vec3) -> Colour {
        let place = place / self.size;
        match &self.figure {
            TextureFigure::Pattern(pattern, [first, second]) => {
                first.mixed(*second, pattern.share(place) as f32)
            }
            TextureFigure::Picture(image) => {
                // to the fourth power of how much the surface faces an axis: between two of them pictures go over into each other fast
                let [x, y, z] = normal.to_array().map(|part| part.powi(4));
                let sum = x + y + z;
                let [x, y, z] = if sum > 0.0 { [x / sum, y / sum, z / sum] } else { [0.0, 0.0, 1.0] };
                let along = [(x, [place.z, place.y]), (y, [place.x, place.z]), (z, [place.x, place.y])];
                let seen = along.into_iter().filter(|(share, _)| *share > 0.0);
                seen.fold(Colour::BLACK, |sum, (share, at)| {
                    sum.plus(between_pixels(image, at).scaled(share as f32))
                })
            }
        }
    }
}

/// The colour of a picture that repeats itself, at a place in its widths: up is up.
fn between_pixels(image: &Image, [across, up]: [f64; 2]) -> Colour {
    let size = image.width as f64;
    let (column, row) = (across * size - 0.5, -up * size - 0.5);
    let (left, top) = (column.floor(), row.floor());
    let pixel = |column: f64, row: f64| {
        let at = |along: f64, count: usize| along.rem_euclid(count as f64) as usize % count;
        Colour::from_screen(image.pixels[at(row, image.height) * image.width + at(column, image.width)])
    };
    let (right, below) = ((column - left) as f32, (row - top) as f32);
    let upper = pixel(left, top).mixed(pixel(left + 1.0, top), right);
    let lower = pixel(left, top + 1.0).mixed(pixel(left + 1.0, top + 1.0), right);
    upper.mixed(lower, below)
}

/// Reads the picture of a texture, a PNG of at most [`MOST_TEXELS`] along a side; what one sees through it is white.
///
/// # Errors
/// The file cannot be read, is no PNG, is cut off, or is too large.
pub fn read_texture(path: &Path) -> Result<Image, IoError> {
    let read = |source: std::io::Error| IoError::Read { path: path.to_owned(), source };
    let faulty = |error: png::DecodingError| match error {
        png::DecodingError::IoError(source) if source.kind() != ErrorKind::UnexpectedEof => read(source),
        other => IoError::content(
            path,
            Fault::new(Place::Byte(0), "the picture", other.to_string(), "a whole PNG file"),
        ),
    };
    let mut decoder = png::Decoder::new(BufReader::new(File::open(path).map_err(read)?));
    decoder.set_transformations(png::Transformations::normalize_to_color8());
    let mut reader = decoder.read_info().map_err(faulty)?;
    let [width, height] = [reader.info().width, reader.info().height].map(|side| side as usize);
    if width.max(height) > MOST_TEXELS {
        let size = format!("{width} x {height} pixels");
        let expected = format!("at most {MOST_TEXELS} along a side");
        return Err(IoError::request(format!("the picture {}", path.display()), size, expected));
    }
    let (kind, _) = reader.output_color_type();
    let channels = kind.samples();
    let mut bytes = vec![0; width * height * channels];
    reader.next_frame(&mut bytes).map_err(faulty)?;
    let pixel = |parts: &[u8]| {
        let over_white = |part: u8, alpha: u8| 255 - ((255 - u32::from(part)) * u32::from(alpha) / 255) as u8;
        match *parts {
            [grey] => [grey; 3],
            [grey, alpha] => [over_white(grey, alpha); 3],
            [red, green, blue] => [red, green, blue],
            [red, green, blue, alpha] => [red, green, blue].map(|part| over_white(part, alpha)),
            _ => [0; 3],
        }
    };
    let pixels = bytes.chunks_exact(channels).map(pixel).collect();
    Ok(Image { width, height, pixels })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::TemporaryFolder;

    fn chequers() -> Image {
        let pixels =
            (0..16).map(|at| if (at % 4 / 2 + at / 8) % 2 == 0 { [250, 20, 30] } else { [10, 20, 200] });
        Image { width: 4, height: 4, pixels: pixels.collect() }
    }

    /// A picture comes back as it was written; what is missing, no picture, cut off or too large is refused with words.
    #[test]
    fn pictures_are_read_or_refused() {
        let folder = TemporaryFolder::new("textures");
        let path = folder.path("chequers.png");
        chequers().write_png(&path).unwrap();
        assert_eq!(read_texture(&path).unwrap(), chequers());
        let refused = |name: &str, bytes: Option<&[u8]>, words: &str| {
            let path = folder.path(name);
            bytes.iter().for_each(|bytes| std::fs::write(&path, bytes).unwrap());
            let message = read_texture(&path).unwrap_err().to_string();
            assert!(message.contains(words) && message.contains(name), "{message}");
        };
        refused("missing.png", None, "cannot read");
        refused("no.png", Some(b"a jpeg, say"), "expected a whole PNG file");
        let whole = std::fs::read(&path).unwrap();
        refused("cut.png", Some(&whole[..whole.len() / 2]), "expected a whole PNG file");
        let wide = Image { width: 5000, height: 1, pixels: vec![[0; 3]; 5000] };
        wide.write_png(&folder.path("wide.png")).unwrap();
        refused("wide.png", None, "5000 x 1 pixels; expected at most 4096 along a side");
    }

    /// A picture is laid on along the axis that a surface faces, and repeats itself; its pixels are where they belong.
    #[test]
    fn pictures_are_laid_on_along_axes() {
        let texture = Texture { figure: TextureFigure::Picture(Arc::new(chequers())), size: 0.4 };
        let at = |column: f64, row: f64| Vec3::new(0.1 * (column + 0.5), -0.1 * (row + 0.5), 7.0);
        for (column, row) in [(0, 0), (1, 3), (3, 1), (2, 2)] {
            let expected = Colour::from_screen(chequers().pixels[4 * row + column]);
            for turns in [0.0, 4.0, -8.0] {
                let seen = texture.colour(at(column as f64 + turns, row as f64 - turns), -Vec3::Z);
                let near = seen.0.iter().zip(expected.0).all(|(a, b)| (a - b).abs() < 1e-5);
                assert!(near, "{column} {row} {seen:?} {expected:?}");
            }
        }
        // along x only y and z count
        let seen = |x: f64| texture.colour(Vec3::new(x, 0.13, 0.21), Vec3::X);
        assert_eq!(seen(0.0), seen(0.17));
    }

    /// Patterns are between their colours, go over without jumps, and are the same wherever they are asked: sums of noise at whole
    /// numbers are zero.
    #[test]
    fn patterns_are_smooth() {
        for entry in PATTERNS.entries {
            let share = |x: f64| entry.build.share(Vec3::new(x, 0.37 * x + 0.2, 1.0 - 0.61 * x));
            let shares: Vec<f64> = (-2000..2000).map(|step| share(f64::from(step) * 5e-3)).collect();
            assert!(shares.iter().all(|share| (0.0..=1.0).contains(share)));
            let [least, most] = [f64::min, f64::max].map(|of| shares.iter().copied().reduce(of).unwrap());
            assert!(least < 0.25 && most > 0.75, "{} {least} {most}", entry.name);
            let jump = shares.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f64::max);
            assert!(jump < 0.2, "{} {jump}", entry.name);
        }
        assert_eq!(noise(Vec3::new(3.0, -7.0, 11.0)), 0.0);
        assert_eq!(Pattern::Mottled.share(Vec3::new(-4.0, 2.0, 0.0)), 0.5);
    }
}
