//! What tells directions and lengths in a picture: a triad of the axes, a bar of a round length.

use souple_mesh::BoundingBox;

use super::Palette;
use super::camera::Camera;
use super::colour::Colour;
use super::image::{Anchor, Canvas};
use super::layout::Layout;
use super::legend::scaled_unit;
use super::lettering::text_width;

/// Which marks a picture has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Marks {
    /// The axes x, y, z, in the lower left corner.
    pub triad: bool,
    /// A bar of a round length, as it is seen in the middle of the subject, in the lower right corner.
    pub scale_bar: bool,
}

/// Colours of x, y, z.
const AXES: [([u8; 3], &str); 3] = [([200, 48, 48], "x"), ([40, 150, 70], "y"), ([50, 90, 210], "z")];
/// Length of an axis that lies in the picture, in heights of letters.
const AXIS: f64 = 3.2;
/// Longest bar, as a part of the width of the picture.
const LONGEST_BAR: f64 = 0.2;

impl Marks {
    pub(super) fn write(
        self,
        (camera, bounds): (&Camera, BoundingBox),
        layout: &Layout,
        palette: &Palette,
        canvas: &mut Canvas,
    ) {
        if self.triad {
            write_triad(camera, layout, palette, canvas);
        }
        if self.scale_bar {
            write_bar((camera, bounds), layout, palette, canvas);
        }
    }
}

/// Width of what lies around lines and letters that stand on bodies, in letters.
const HALO: f64 = 0.5;

/// Lines and letters over a picture, in a halo of its background: they are read on whatever is behind them.
#[derive(Default)]
struct Drawing {
    lines: Vec<(Vec<[f64; 2]>, f64, Colour)>,
    /// Text, the middle of its baseline, colour.
    texts: Vec<(String, [f64; 2], Colour)>,
}

impl Drawing {
    fn write(&self, letter: f64, palette: &Palette, canvas: &mut Canvas) {
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
}

fn write_triad(camera: &Camera, layout: &Layout, palette: &Palette, canvas: &mut Canvas) {
    let letter = layout.letter;
    let length = AXIS * letter;
    // letters stand a little beyond the ends
    let room = 1.5 * length;
    let [x, y] = [layout.margin + room, layout.floor - room];
    // in the camera's directions: to the right, up, away
    let seen = |axis: usize| [camera.right[axis], camera.up[axis], camera.forward[axis]];
    let mut axes = [0, 1, 2];
    axes.sort_by(|a, b| seen(*b)[2].total_cmp(&seen(*a)[2]));
    let mut drawing = Drawing::default();
    for axis in axes {
        let [across, up, _] = seen(axis);
        let (colour, name) = AXES[axis];
        let at = |part: f64| [x + part * length * across, y - part * length * up];
        drawing.lines.push((vec![at(0.0), at(1.0)], 0.16 * letter, Colour::from_screen(colour)));
        let [left, base] = at(1.3);
        drawing.texts.push((name.to_owned(), [left, base + 0.5 * letter], palette.ink));
    }
    drawing.write(letter, palette, canvas);
}

fn write_bar(
    (camera, bounds): (&Camera, BoundingBox),
    layout: &Layout,
    palette: &Palette,
    canvas: &mut Canvas,
) {
    let per_metre = pixels_of_metre(camera, bounds);
    let Some(length) = round_below(LONGEST_BAR * canvas.width as f64 / per_metre) else { return };
    let text = in_words(length, "m");
    let letter = layout.letter;
    let right = canvas.width as f64 - layout.margin;
    let (left, y) = (right - length * per_metre, layout.floor);
    let line = |points: [[f64; 2]; 2]| (points.to_vec(), 0.2 * letter, palette.ink);
    let end = |x: f64| line([[x, y - 0.4 * letter], [x, y + 0.4 * letter]]);
    let drawing = Drawing {
        lines: vec![line([[left, y], [right, y]]), end(left), end(right)],
        texts: vec![(text, [0.5 * (left + right), y - 0.8 * letter], palette.ink)],
    };
    drawing.write(letter, palette, canvas);
}

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

/// Above the bar of a length, in letters.
const ABOVE_BAR: f64 = 3.2;

impl ArrowKey {
    pub(super) fn write(
        &self,
        (camera, bounds): (&Camera, BoundingBox),
        (layout, marks): (&Layout, Marks),
        palette: &Palette,
        canvas: &mut Canvas,
    ) {
        let pixels = pixels_of_metre(camera, bounds) * self.scale;
        let Some(value) = round_below(LONGEST_BAR * canvas.width as f64 / pixels) else { return };
        let letter = layout.letter;
        let (right, long) = (canvas.width as f64 - layout.margin, value * pixels);
        let y = layout.floor - if marks.scale_bar { ABOVE_BAR * letter } else { 0.0 };
        let text = format!("{} {}", self.title, in_words(value, &self.unit));
        // what is written is wider than the arrow: both in the middle of one box
        let middle = right - 0.5 * long.max(text_width(&text, letter));
        let (from, to) = (middle - 0.5 * long, middle + 0.5 * long);
        let back = (0.9 * letter).min(0.5 * long);
        let line = |points: Vec<[f64; 2]>| (points, 0.16 * letter, palette.ink);
        let drawing = Drawing {
            lines: vec![
                line(vec![[from, y], [to, y]]),
                line(vec![[to - back, y - 0.4 * letter], [to, y], [to - back, y + 0.4 * letter]]),
            ],
            texts: vec![(text, [middle, y - 0.9 * letter], palette.ink)],
        };
        drawing.write(letter, palette, canvas);
    }
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
    use souple_math::Vec3;

    use super::*;
    use crate::picture::{Picture, Surface, View};

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
        let marked = Picture { marks: Marks { triad: true, scale_bar: true }, ..plain.clone() };
        let [plain, image] = [&plain, &marked].map(|picture| picture.render().unwrap());
        let differs = |x: usize, y: usize| plain.pixels[y * 600 + x] != image.pixels[y * 600 + x];
        // along a line just above the bar its two ends differ alone
        let layout = Layout::of(&marked, (0.0, 1.0));
        let row = (400.0 - layout.margin - 0.3 * layout.letter) as usize;
        let ends: Vec<usize> = (300..600).filter(|x| differs(*x, row)).collect();
        let long = (ends[ends.len() - 1] - ends[0]) as f64;
        let camera = marked.camera(marked.bounds(), &layout);
        let [from, to] = [Vec3::ZERO, Vec3::new(0.05, 0.0, 0.0)].map(|x| camera.project(x).x);
        // lines are a few pixels wide
        assert!((long - (to - from)).abs() < 4.0, "{long} {}", to - from);
        let red = |x: usize, y: usize| {
            let [r, g, b] = image.pixels[y * 600 + x];
            differs(x, y) && i32::from(r) > i32::from(g) + 80 && i32::from(r) > i32::from(b) + 80
        };
        let is_red: Vec<usize> = (0..400).filter(|y| (0..300).filter(|x| red(*x, *y)).count() > 10).collect();
        assert!(!is_red.is_empty() && is_red.len() < 5, "x lies across: {is_red:?}");
    }
}
