//! What tells directions and lengths in a picture: a triad of the axes, a bar of a round length.

use souple_math::Vec3;
use souple_mesh::BoundingBox;

use super::camera::Camera;
use super::colour::Colour;
use super::image::{Anchor, Canvas};
use super::layout::Layout;
use super::legend::scaled_unit;
use super::lettering::text_width;
use super::{Image, LegendPlace, Palette, Picture};

/// Which marks a picture has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Marks {
    /// The axes x, y, z, in the lower left corner.
    pub triad: bool,
    /// A bar of a round length, as it is seen in the middle of the subject, in the lower right corner.
    pub scale_bar: bool,
}

/// Text about a place of what is seen.
#[derive(Clone, Debug, PartialEq)]
pub struct Label {
    /// [m]
    pub at: Vec3,
    pub text: String,
}

impl Label {
    /// A little above and to the right of the place; `None` of one that is not in front of the camera.
    pub(super) fn mark(&self, camera: &Camera, letter: f64, palette: &Palette) -> Option<Mark> {
        let seen = camera.project(self.at);
        let place = [seen.x + 0.6 * letter, seen.y - 0.4 * letter];
        let text = (self.text.clone(), place, palette.ink);
        (seen.inverse_depth > 0.0).then(|| Mark { lines: Vec::new(), texts: vec![text] })
    }
}

/// Colours of x, y, z.
const AXES: [([u8; 3], &str); 3] = [([200, 48, 48], "x"), ([40, 150, 70], "y"), ([50, 90, 210], "z")];
/// Length of an axis that lies in the picture, in heights of letters.
const AXIS: f64 = 3.2;
/// Longest bar, as a part of the width of the picture.
const LONGEST_BAR: f64 = 0.2;

/// Width of what lies around lines and letters that stand on bodies, in letters.
const HALO: f64 = 0.5;
/// Of the key of arrows above the bar of a length, in letters.
const ABOVE_BAR: f64 = 3.2;
/// What a bar with its length takes above the place of its line, in letters.
const TALL: f64 = 2.4;

/// Which marks and keys there are room for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Shown {
    pub triad: bool,
    pub bar: bool,
    pub key: bool,
}

impl Shown {
    /// How far the bar and the key reach above the floor of the marks, in letters.
    pub fn tall(self) -> f64 {
        match (self.bar, self.key) {
            (true, true) => ABOVE_BAR + TALL,
            (false, false) => 0.0,
            _ => TALL,
        }
    }
}

/// Where marks stand in a picture [pixels]: the axes on the left, bar and key on the right.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Corner {
    pub left: f64,
    /// Where the axes end, and bar and key may begin.
    pub beside: f64,
    pub right: f64,
    pub floor: f64,
}

/// Lines and letters over a picture, in a halo of its background: they are read on whatever is behind them.
#[derive(Clone, Debug, Default)]
pub(super) struct Mark {
    lines: Vec<(Vec<[f64; 2]>, f64, Colour)>,
    /// Text, the middle of its baseline, colour.
    texts: Vec<(String, [f64; 2], Colour)>,
}

impl Mark {
    pub fn write(&self, letter: f64, palette: &Palette, canvas: &mut Canvas) {
        let wider = HALO * letter;
        for (points, width, _) in &self.lines {
            let halo = palette.background(points[0][1], canvas.height);
            canvas.line(points, width + wider, halo);
        }
        for (text, place, _) in &self.texts {
            let halo = palette.background(place[1], canvas.height);
            canvas.text_halo(text, *place, letter, wider, halo);
        }
        for (points, width, colour) in &self.lines {
            canvas.line(points, *width, *colour);
        }
        for (text, place, colour) in &self.texts {
            canvas.text(text, *place, letter, Anchor::Middle, *colour);
        }
    }

    /// Left, upper, right and lower border of lines and letters.
    pub fn reach(&self, letter: f64) -> [f64; 4] {
        let lines = self.lines.iter().flat_map(|(points, width, _)| {
            points
                .iter()
                .map(move |[x, y]| [x - 0.5 * width, y - 0.5 * width, x + 0.5 * width, y + 0.5 * width])
        });
        let texts = self.texts.iter().map(|(text, [x, y], _)| {
            let half = 0.5 * text_width(text, letter);
            [x - half, y - letter, x + half, *y]
        });
        let both =
            |a: [f64; 4], b: [f64; 4]| [a[0].min(b[0]), a[1].min(b[1]), a[2].max(b[2]), a[3].max(b[3])];
        lines.chain(texts).reduce(both).unwrap_or_default()
    }

    fn moved(mut self, [right, down]: [f64; 2]) -> Self {
        let places = self.texts.iter_mut().map(|(_, place, _)| place);
        for place in self.lines.iter_mut().flat_map(|(points, ..)| points).chain(places) {
            *place = [place[0] + right, place[1] + down];
        }
        self
    }

    /// The axes about the origin, in a camera's directions: to the right, up, away.
    pub fn triad([right, up, forward]: [Vec3; 3], letter: f64, palette: &Palette) -> Self {
        let length = AXIS * letter;
        let seen = |axis: usize| [right[axis], up[axis], forward[axis]];
        let mut axes = [0, 1, 2];
        axes.sort_by(|a, b| seen(*b)[2].total_cmp(&seen(*a)[2]));
        let mut mark = Self::default();
        for axis in axes {
            let [across, up, _] = seen(axis);
            let (colour, name) = AXES[axis];
            // letters stand a little beyond the ends
            let at = |part: f64| [part * length * across, -part * length * up];
            mark.lines.push((vec![at(0.0), at(1.0)], 0.16 * letter, Colour::from_screen(colour)));
            let [left, base] = at(1.3);
            mark.texts.push((name.to_owned(), [left, base + 0.5 * letter], palette.ink));
        }
        mark
    }

    /// A bar of a round length in a picture of a width, left of the origin; `None` where a metre has no length in the picture.
    fn bar(pixels_of_metre: f64, width: f64, letter: f64, palette: &Palette) -> Option<Self> {
        let length = round_below(LONGEST_BAR * width / pixels_of_metre)?;
        let text = in_words(length, "m");
        let long = length * pixels_of_metre;
        // what is written may be wider than the bar: both in the middle of one box
        let middle = -0.5 * long.max(text_width(&text, letter));
        let (from, to) = (middle - 0.5 * long, middle + 0.5 * long);
        let line = |points: [[f64; 2]; 2]| (points.to_vec(), 0.2 * letter, palette.ink);
        let end = |x: f64| line([[x, -0.4 * letter], [x, 0.4 * letter]]);
        Some(Self {
            lines: vec![line([[from, 0.0], [to, 0.0]]), end(from), end(to)],
            texts: vec![(text, [middle, -0.8 * letter], palette.ink)],
        })
    }

    /// An arrow of a round length with what it means, left of the origin; `None` where it has no length in the picture.
    fn key(key: &ArrowKey, pixels_of_metre: f64, width: f64, letter: f64, palette: &Palette) -> Option<Self> {
        let pixels = pixels_of_metre * key.scale;
        let value = round_below(LONGEST_BAR * width / pixels)?;
        let long = value * pixels;
        let text = format!("{} {}", key.title, in_words(value, &key.unit));
        let middle = -0.5 * long.max(text_width(&text, letter));
        let (from, to) = (middle - 0.5 * long, middle + 0.5 * long);
        let back = (0.9 * letter).min(0.5 * long);
        let line = |points: Vec<[f64; 2]>| (points, 0.16 * letter, palette.ink);
        Some(Self {
            lines: vec![
                line(vec![[from, 0.0], [to, 0.0]]),
                line(vec![[to - back, -0.4 * letter], [to, 0.0], [to - back, 0.4 * letter]]),
            ],
            texts: vec![(text, [middle, -0.9 * letter], palette.ink)],
        })
    }
}

/// The marks of a picture where they stand; what has no room is not among them.
#[derive(Clone, Debug, Default)]
pub(super) struct Placed {
    pub triad: Option<Mark>,
    pub bar: Option<Mark>,
    pub key: Option<Mark>,
}

impl Placed {
    pub fn of(picture: &Picture, camera: &Camera, layout: &Layout, palette: &Palette) -> Self {
        let (letter, corner, shown) = (layout.letter, layout.corner, layout.shown);
        let wanted = Marks { triad: shown.triad, scale_bar: shown.bar };
        let key = picture.key.as_ref().filter(|_| shown.key);
        let [triad, bar, key] = about_origins(picture, (wanted, key), camera, letter, palette);
        let at = |mark: Mark, y: f64| {
            let mark = mark.moved([corner.right, y]);
            (mark.reach(letter)[0] >= corner.beside).then_some(mark)
        };
        let above = if shown.bar { ABOVE_BAR * letter } else { 0.0 };
        Self {
            triad: triad.map(|mark| {
                let [left, _, _, bottom] = mark.reach(letter);
                mark.moved([corner.left - left, corner.floor - bottom])
            }),
            bar: bar.and_then(|bar| at(bar, corner.floor)),
            key: key.and_then(|key| at(key, corner.floor - above)),
        }
    }

    pub fn write(&self, letter: f64, palette: &Palette, canvas: &mut Canvas) {
        let marks = [&self.triad, &self.bar, &self.key].into_iter().flatten();
        marks.for_each(|mark| mark.write(letter, palette, canvas));
    }
}

/// The axes, the bar and the key that are wanted of a picture, each about an origin of its own.
fn about_origins(
    picture: &Picture,
    (marks, key): (Marks, Option<&ArrowKey>),
    camera: &Camera,
    letter: f64,
    palette: &Palette,
) -> [Option<Mark>; 3] {
    let (pixels, width) = (pixels_of_metre(camera, picture.bounds()), picture.size[0] as f64);
    let directions = [camera.right, camera.up, camera.forward];
    [
        marks.triad.then(|| Mark::triad(directions, letter, palette)),
        marks.scale_bar.then(|| Mark::bar(pixels, width, letter, palette)).flatten(),
        key.and_then(|key| Mark::key(key, pixels, width, letter, palette)),
    ]
}

/// The marks that pictures of a sheet have in common.
#[derive(Clone, Debug, PartialEq)]
pub struct MarksStrip {
    pub image: Image,
    /// What has no room in it.
    pub left_out: Vec<&'static str>,
}

impl Picture {
    /// Marks and key alone, as a strip to stand below a sheet of pictures like this one, which has none of them itself, in letters
    /// that suit a sheet of a width and a height; `None` where none is asked for. How high it is does not depend on the size of
    /// the pictures.
    pub fn marks_strip(
        &self,
        marks: Marks,
        key: Option<&ArrowKey>,
        [width, height]: [usize; 2],
    ) -> Option<MarksStrip> {
        if marks == Marks::default() && key.is_none() {
            return None;
        }
        let palette = self.palette();
        let letter = (0.011 * width as f64).min(0.02 * height as f64).max(8.0);
        let margin = 1.4 * letter;
        let camera = self.camera(self.bounds(), &Layout::of(self, self.range()));
        let [triad, bar, key] = about_origins(self, (marks, key), &camera, letter, &palette);
        let tall = triad.as_ref().map_or(0.0, |mark| {
            let [_, top, _, bottom] = mark.reach(letter);
            bottom - top
        });
        let tall = tall.max((0.6 + TALL) * letter);
        let height = (tall + 1.6 * letter).ceil();
        let (mut left, mut right) = (margin, width as f64 - margin);
        let mut left_out = Vec::new();
        let mut canvas = Canvas::new(width, height as usize);
        canvas.fill(0..width, 0..canvas.height, palette.bottom, 1.0);
        if let Some(mark) = triad {
            let [low, top, high, bottom] = mark.reach(letter);
            if left + high - low > right {
                left_out.push(TRIAD);
            } else {
                let down = 0.5 * (height - top - bottom);
                mark.moved([left - low, down]).write(letter, &palette, &mut canvas);
                left += high - low + letter;
            }
        }
        for (mark, name) in [(bar, SCALE_BAR), (key, KEY)] {
            let Some(mark) = mark else { continue };
            let mark = mark.moved([right, height - 1.3 * letter]);
            let edge = mark.reach(letter)[0];
            if edge < left {
                left_out.push(name);
            } else {
                mark.write(letter, &palette, &mut canvas);
                right = edge - 2.0 * letter;
            }
        }
        Some(MarksStrip { image: canvas.finish(), left_out })
    }

    /// What is asked for and has no room in a picture of this size.
    pub fn left_out(&self) -> Vec<&'static str> {
        let layout = Layout::of(self, self.range());
        let palette = self.palette();
        let placed = Placed::of(self, &self.camera(self.bounds(), &layout), &layout, &palette);
        let legend = self.legend.as_ref().is_some_and(|legend| legend.place == LegendPlace::Beside);
        let [title, subtitle] = [&self.title, &self.subtitle].map(|text| !text.trim().is_empty());
        let lost = [
            (title && !layout.has_title(), "title"),
            (subtitle && !layout.has_subtitle(), "time"),
            (legend && !layout.has_legend(), LEGEND),
            (self.key.is_some() && placed.key.is_none(), KEY),
            (self.marks.scale_bar && placed.bar.is_none(), SCALE_BAR),
            (self.marks.triad && placed.triad.is_none(), TRIAD),
        ];
        lost.into_iter().filter(|(is_lost, _)| *is_lost).map(|(_, name)| name).collect()
    }
}

/// What parts of a picture are called where they have no room.
pub const LEGEND: &str = "legend";
const KEY: &str = "key of the arrows";
const SCALE_BAR: &str = "scale bar";
const TRIAD: &str = "axes";

/// As it is seen in the middle of the subject.
fn pixels_of_metre(camera: &Camera, bounds: BoundingBox) -> f64 {
    camera.focal() / camera.forward.dot(bounds.centre() - camera.eye)
}

/// A round number with a unit that suits it.
fn in_words(value: f64, unit: &str) -> String {
    let (factor, unit) = scaled_unit(value, unit);
    // round: few digits, but for what division makes of them
    let number = (value / factor * 1e3).round() / 1e3;
    // a power of ten is one number with what stands before it
    let between = if unit.starts_with("10") { "·" } else { " " };
    format!("{number}{between}{unit}").trim_end().to_owned()
}

/// An arrow of a round length with what it means, in the lower right corner, above the bar of a length.
#[derive(Clone, Debug, PartialEq)]
pub struct ArrowKey {
    pub title: String,
    pub unit: String,
    /// Metres of arrow for each unit.
    pub scale: f64,
}

/// The largest of 1, 2, 5 times a power of ten that is not above a length; `None` where there is no such length.
fn round_below(most: f64) -> Option<f64> {
    if !(most > 0.0 && most.is_finite()) {
        return None;
    }
    let power = libm::pow(10.0, libm::floor(libm::log10(most)));
    [5.0, 2.0, 1.0].into_iter().map(|digit| digit * power).find(|length| *length <= most)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture::{Surface, View};

    #[test]
    fn bars_are_round() {
        let cases = [(0.034, 0.02), (0.999, 0.5), (1.0, 1.0), (7e5, 5e5)];
        assert!(
            cases.iter().all(|(most, length)| (round_below(*most).unwrap() / length - 1.0).abs() < 1e-12)
        );
        assert!([0.0, -1.0, f64::NAN, f64::INFINITY].iter().all(|most| round_below(*most).is_none()));
    }

    /// A power of ten is one number with what stands before it.
    #[test]
    fn lengths_are_told_in_words() {
        for (value, unit, words) in [
            (0.05, "m", "50 mm"),
            (2.0, "m/s", "2 m/s"),
            (5e-11, "m", "50·10⁻¹² m"),
            (0.2, "", "0.2"),
            (2000.0, "", "2·10³"),
        ] {
            assert_eq!(in_words(value, unit), words);
        }
    }

    /// The bar is as long as a thing of its length in the middle of what is shown, and the triad's axes run as the things along
    /// them do.
    #[test]
    fn marks_tell_lengths_and_directions() {
        let points = vec![Vec3::ZERO, Vec3::new(0.3, 0.0, 0.0), Vec3::new(0.0, 0.2, 0.0)];
        let surface = Surface { points, triangles: vec![[0, 1, 2]], ..Surface::default() };
        let plain = Picture {
            surfaces: vec![surface],
            view: View::along(-Vec3::Z, Vec3::Y),
            size: [600, 400],
            samples_per_pixel: 1,
            ..Picture::default()
        };
        let marked = Picture { marks: Marks { triad: true, scale_bar: true }, ..plain };
        let image = marked.render().unwrap();
        // ink is darker than anything beside and below the subject
        let is_ink = |x: usize, y: usize| image.pixels[y * 600 + x].iter().all(|part| *part < 120);
        // along a line just above the bar its two ends differ alone
        let layout = Layout::of(&marked, (0.0, 1.0));
        let row = (400.0 - layout.margin - 0.3 * layout.letter) as usize;
        let ends: Vec<usize> = (300..600).filter(|x| is_ink(*x, row)).collect();
        let long = (ends[ends.len() - 1] - ends[0]) as f64;
        let camera = marked.camera(marked.bounds(), &layout);
        let [from, to] = [Vec3::ZERO, Vec3::new(0.05, 0.0, 0.0)].map(|x| camera.project(x).x);
        // lines are a few pixels wide
        assert!((long - (to - from)).abs() < 4.0, "{long} {}", to - from);
        let red = |x: usize, y: usize| {
            let [r, g, b] = image.pixels[y * 600 + x];
            // of a line between two rows of pixels each has a half
            i32::from(r) > i32::from(g) + 40 && i32::from(r) > i32::from(b) + 40
        };
        let beside = layout.corner.beside as usize;
        let is_red: Vec<usize> =
            (0..400).filter(|y| (0..beside).filter(|x| red(*x, *y)).count() > 10).collect();
        assert!(!is_red.is_empty() && is_red.len() < 5, "x lies across: {is_red:?}");
    }
}
