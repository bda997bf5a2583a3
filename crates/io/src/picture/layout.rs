//! Where title, legend and subject stand in a picture, and the writing of the first two.

use super::camera::Frame;
use super::colour::Colour;
use super::colour_scale::ColourScale;
use super::image::{Anchor, Canvas};
use super::legend::{log_scale, scale};
use super::lettering::text_width;
use super::{Image, Legend, LegendPlace, Palette, Picture, Theme};

/// All in pixels.
pub(super) struct Layout {
    pub frame: Frame,
    /// Height of capitals of plain text.
    pub letter: f64,
    pub margin: f64,
    /// The title in lines that fit, and the height of its capitals.
    title: Vec<String>,
    title_letter: f64,
    subtitle: Vec<String>,
    legend: Option<LegendBox>,
}

/// The colour bar with its writing.
struct LegendBox {
    /// Of the bar.
    left: f64,
    right: f64,
    top: f64,
    bottom: f64,
    ticks: Vec<(f64, String)>,
    /// Parts of the way through the colours, of boxes of one height from below, where values have names; the whole way where
    /// there are none.
    boxes: Vec<f64>,
    /// Of the ticks' names.
    widest: f64,
    title: Vec<String>,
    /// Left border of everything of it, and the middle under its title.
    edge: f64,
    middle: f64,
}

/// Half the height of the bar, and the height of a box with a name, as parts of the picture's.
const HALF_BAR: f64 = 0.21;
const TALLEST_BOX: f64 = 0.06;

/// Part of the width that a legend leaves to the subject at least, whose middle it would cover otherwise: a smaller picture has none.
const LEAST_LEFT: f64 = 0.35;

/// Most powers of ten that are named beside a bar.
const MOST_POWERS: usize = 7;

/// Lines of a title that does not fit in one.
const MOST_LINES: usize = 3;

impl Layout {
    pub fn of(picture: &Picture, range: (f64, f64)) -> Self {
        let [width, height] = picture.size.map(|side| side as f64);
        let letter = (0.0165 * height.min(0.8 * width)).max(8.0);
        let margin = 0.045 * width.min(height);
        let room = width - 2.0 * margin;
        // a title that is a little too long is set smaller, one that is much too long in lines
        let wanted = 1.45 * letter;
        let title_letter =
            (wanted * room / text_width(&picture.title, wanted).max(1.0)).clamp(0.75 * wanted, wanted);
        let title = wrapped(&picture.title, title_letter, room, MOST_LINES);
        let subtitle = wrapped(&picture.subtitle, letter, room, MOST_LINES);
        let beside = picture.legend.as_ref().filter(|legend| legend.place == LegendPlace::Beside);
        let legend =
            beside.map(|legend| LegendBox::of((legend, picture.scale), range, picture.size, letter, margin));
        let legend = legend.filter(|legend| legend.edge >= LEAST_LEFT * width);
        let above = title.len() as f64 * 1.65 * title_letter + subtitle.len() as f64 * 1.8 * letter;
        // room for the shade around the place of contact
        let shade = if picture.ground.is_some() { 0.07 * height } else { 0.0 };
        let right =
            legend.as_ref().map_or(width - margin, |legend| legend.edge - 1.2 * letter).max(0.5 * width);
        let top = (margin + above).min(0.4 * height);
        Self {
            frame: Frame { left: margin, top, right, bottom: (height - margin - shade).max(top + 1.0) },
            letter,
            margin,
            title,
            title_letter,
            subtitle,
            legend,
        }
    }

    pub fn write(&self, picture: &Picture, palette: &Palette, canvas: &mut Canvas) {
        let widths = |lines: &[String], letter: f64| {
            lines.iter().map(|line| text_width(line, letter)).fold(0.0, f64::max)
        };
        let width = widths(&self.title, self.title_letter).max(widths(&self.subtitle, self.letter));
        let height = self.title.len() as f64 * 1.65 * self.title_letter
            + self.subtitle.len() as f64 * 1.8 * self.letter;
        let (pad, edge) = (0.6 * self.letter, self.margin);
        if height > 0.0 {
            veil(canvas, palette, [edge - pad, edge + width + pad], [edge - pad, edge + height]);
        }
        let mut baseline = self.margin + 0.8 * self.title_letter;
        for line in &self.title {
            canvas.text(line, [self.margin, baseline], self.title_letter, Anchor::Left, palette.ink);
            baseline += 1.65 * self.title_letter;
        }
        baseline += 0.2 * self.letter;
        for line in &self.subtitle {
            let background = palette.background(baseline, canvas.height);
            let ink = palette.ink.mixed(background, 0.25);
            canvas.text(line, [self.margin, baseline], self.letter, Anchor::Left, ink);
            baseline += 1.8 * self.letter;
        }
        if let Some(legend) = &self.legend {
            legend.write(picture, self.letter, palette, canvas);
        }
    }
}

/// Contrast from which on letters can be read (WCAG 2.2, 1.4.3).
const LEGIBLE: f32 = 4.5;
/// Part of the background in a veil.
const VEIL: f32 = 0.8;

/// A veil of the background where letters are to stand on something on which they could not be read: a subject that is
/// seen from a camera that someone placed, a shape that is larger than the bodies.
pub(super) fn veil(canvas: &mut Canvas, palette: &Palette, columns: [f64; 2], rows: [f64; 2]) {
    let range = |[from, to]: [f64; 2], most: usize| {
        let clip = |value: f64| value.clamp(0.0, most as f64) as usize;
        clip(from)..clip(to)
    };
    let (columns, rows) = (range(columns, canvas.width), range(rows, canvas.height));
    let is_legible = |colour: &Colour| palette.ink.contrast(*colour) >= LEGIBLE;
    let pixels = |row: usize| &canvas.pixels[row * canvas.width..][columns.clone()];
    if rows.clone().all(|row| pixels(row).iter().all(is_legible)) {
        return;
    }
    for row in rows {
        let background = palette.background(row as f64, canvas.height);
        canvas.fill(columns.clone(), row..row + 1, background, VEIL);
    }
}

impl LegendBox {
    fn of(
        (legend, colours): (&Legend, ColourScale),
        (low, high): (f64, f64),
        size: [usize; 2],
        letter: f64,
        margin: f64,
    ) -> Self {
        let [width, height] = size.map(|side| side as f64);
        let named = legend.names.len() as f64;
        // boxes are no higher than they need to be
        let half = if named > 0.0 { (0.5 * TALLEST_BOX * named).min(HALF_BAR) } else { HALF_BAR };
        let (top, bottom) = ((0.5 - half) * height, (0.5 + half) * height);
        let nearest = 1.8 * letter / (bottom - top);
        let scale = match colours {
            ColourScale::Linear => scale(low, high, &legend.unit, 5, nearest),
            ColourScale::Logarithmic => log_scale(low, high, &legend.unit, MOST_POWERS, nearest),
        };
        let share = |value: f64| colours.share(value, (low, high));
        let place = |share: f64| bottom - share * (bottom - top);
        let ticks: Vec<(f64, String)> = if legend.names.is_empty() {
            scale.ticks.into_iter().map(|(value, name)| (place(share(value)), name)).collect()
        } else {
            let middle = |index: usize| place((index as f64 + 0.5) / named);
            legend.names.iter().enumerate().map(|(index, (_, name))| (middle(index), name.clone())).collect()
        };
        let boxes = legend.names.iter().map(|(value, _)| share(*value)).collect();
        let widest = ticks.iter().map(|(_, name)| text_width(name, letter)).fold(0.0, f64::max);
        let title = match scale.unit.as_str() {
            "" => legend.title.clone(),
            unit => format!("{} [{unit}]", legend.title),
        };
        let bar = 1.4 * letter;
        let body = bar + 0.95 * letter + widest;
        let title = wrapped(&title, letter, body.max(0.24 * width), MOST_LINES);
        let head = title.iter().map(|line| text_width(line, letter)).fold(0.0, f64::max);
        let edge = width - margin - body.max(head);
        // under the middle of its title
        let left = edge + 0.5 * (body.max(head) - body);
        let middle = edge + 0.5 * body.max(head);
        Self { left, right: left + bar, top, bottom, ticks, boxes, widest, title, edge, middle }
    }

    /// The same so many pixels to the right.
    fn moved(self, by: f64) -> Self {
        let Self { left, right, edge, middle, .. } = self;
        Self { left: left + by, right: right + by, edge: edge + by, middle: middle + by, ..self }
    }

    fn write(&self, picture: &Picture, letter: f64, palette: &Palette, canvas: &mut Canvas) {
        let whole = |value: f64| value.max(0.0) as usize;
        let (left, right) = (whole(self.left), whole(self.right));
        let (top, bottom) = (whole(self.top), whole(self.bottom));
        let above = (1.4 + 1.6 * self.title.len() as f64) * letter;
        let rows = [self.top - above, self.bottom + 1.2 * letter];
        veil(canvas, palette, [self.edge - 0.8 * letter, canvas.width as f64], rows);
        canvas.fill(left.saturating_sub(1)..right + 1, top.saturating_sub(1)..bottom + 1, palette.ink, 0.8);
        for row in top..bottom {
            let along = 1.0 - (row - top) as f64 / ((bottom - top).max(2) as f64 - 1.0);
            let of_box =
                self.boxes.get(((along * self.boxes.len() as f64) as usize).min(self.boxes.len().max(1) - 1));
            let share = of_box.copied().unwrap_or(along);
            canvas.fill(left..right, row..row + 1, picture.colours.colour(share), 1.0);
        }
        for (y, label) in &self.ticks {
            canvas.line(&[[self.right + 1.0, *y], [self.right + 0.45 * letter, *y]], 1.2, palette.ink);
            canvas.text(
                label,
                // one under the other by their last digits
                [self.right + 0.95 * letter + self.widest, y + 0.5 * letter],
                letter,
                Anchor::Right,
                palette.ink,
            );
        }
        for (index, line) in self.title.iter().rev().enumerate() {
            let y = self.top - 1.4 * letter - 1.6 * letter * index as f64;
            canvas.text(line, [self.middle, y], letter, Anchor::Middle, palette.ink);
        }
    }
}

impl Picture {
    /// The legend alone, as a strip of that height to stand beside a sheet of pictures; `None` where there is none.
    pub fn legend_strip(&self, height: usize) -> Option<Image> {
        let letter = (0.018 * height as f64).clamp(8.0, 16.0);
        let margin = 2.0 * letter;
        // laid out in a strip that is wide enough for any title, of which the free part is left out
        let wide = 4 * height.max(64);
        let legend = (self.legend.as_ref()?, self.scale);
        let of = LegendBox::of(legend, self.range(), [wide, height], letter, margin);
        let spare = of.edge - margin;
        let mut canvas = Canvas::new((wide as f64 - spare).ceil() as usize, height);
        let palette = self.palette();
        canvas.fill(0..canvas.width, 0..height, palette.bottom, 1.0);
        of.moved(-spare).write(self, letter, &palette, &mut canvas);
        Some(canvas.finish())
    }
}

impl Image {
    /// The same with another of the same height on its right.
    pub fn beside(&self, other: &Self) -> Self {
        let width = self.width + other.width;
        let mut pixels = Vec::with_capacity(width * self.height);
        let rows =
            self.pixels.chunks_exact(self.width.max(1)).zip(other.pixels.chunks_exact(other.width.max(1)));
        rows.for_each(|(left, right)| {
            pixels.extend(left);
            pixels.extend(right);
        });
        let height = pixels.len() / width.max(1);
        Self { width, height, pixels }
    }

    /// The same below a strip with a title, the background of a picture of that theme going on under it.
    pub fn titled(&self, title: &str, theme: Theme) -> Self {
        let (palette, width) = (theme.palette(), self.width as f64);
        let letter = (0.011 * width).max(8.0);
        let margin = 1.4 * letter;
        let lines = wrapped(title, letter, width - 2.0 * margin, MOST_LINES);
        let height = margin + lines.len() as f64 * 1.65 * letter;
        let mut strip = Canvas::new(self.width, height as usize);
        strip.fill(0..self.width, 0..strip.height, palette.top, 1.0);
        for (index, line) in lines.iter().enumerate() {
            let baseline = margin + (0.8 + 1.65 * index as f64) * letter;
            strip.text(line, [margin, baseline], letter, Anchor::Left, palette.ink);
        }
        let Self { height, mut pixels, .. } = strip.finish();
        pixels.extend(&self.pixels);
        Self { width: self.width, height: height + self.height, pixels }
    }
}

/// A text in lines no wider than `room` where its words allow it; the last of at most `most` lines ends in an
/// ellipsis if words are left.
fn wrapped(text: &str, letter: f64, room: f64, most: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if text_width(&format!("{line} {word}"), letter) <= room => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    let is_cut = lines.len() > most;
    lines.truncate(most);
    // cut words that are wider than the room, too
    for (index, line) in lines.iter_mut().enumerate() {
        let ends = is_cut && index + 1 == most;
        if !ends && text_width(line, letter) <= room {
            continue;
        }
        let mut short: String = line.clone();
        while !short.is_empty() && text_width(&format!("{short}…"), letter) > room {
            short.pop();
        }
        *line = format!("{}…", short.trim_end());
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    /// No line is wider than the room; all words are there where lines are left, an ellipsis where not.
    #[test]
    fn long_titles_are_wrapped() {
        let title =
            "A rubber bar twisted by three quarters of a turn, clamped at one end, with a very long name";
        let lines = wrapped(title, 10.0, 300.0, 9);
        assert!(lines.len() > 2 && lines.iter().all(|line| text_width(line, 10.0) <= 300.0));
        assert_eq!(lines.join(" "), title);
        let cut = wrapped(title, 10.0, 300.0, 2);
        assert!(cut.len() == 2 && cut[1].ends_with('…') && text_width(&cut[1], 10.0) <= 300.0);
        assert!(text_width(&wrapped("incomprehensibilities", 10.0, 60.0, 2)[0], 10.0) <= 60.0);
        assert!(wrapped("", 10.0, 60.0, 2).is_empty());
    }

    /// Letters on a dark wall that fills the picture are veiled from it; on the background alone nothing is.
    #[test]
    fn letters_can_be_read_on_anything() {
        let palette = Theme::Light.palette();
        let veiled = |colour: Colour| {
            let mut canvas = Canvas::new(40, 30);
            canvas.fill(0..40, 0..30, colour, 1.0);
            veil(&mut canvas, &palette, [10.0, 20.0], [5.0, 12.0]);
            canvas.pixels
        };
        assert!(veiled(Colour::WHITE).iter().all(|pixel| *pixel == Colour::WHITE));
        for (index, pixel) in veiled(Colour::BLACK).iter().enumerate() {
            let is_inside = (10..20).contains(&(index % 40)) && (5..12).contains(&(index / 40));
            assert_eq!(palette.ink.contrast(*pixel) >= LEGIBLE, is_inside, "{index}");
        }
    }

    /// However wide its numbers and its title: the legend is within the picture and the subject beside it.
    #[test]
    fn the_subject_stands_beside_the_legend() {
        let tiny = Picture { size: [48, 40], legend: Some(Legend::default()), ..Picture::default() };
        assert!(Layout::of(&tiny, (0.0, 1234.5)).legend.is_none());
        for (title, high, size) in [
            ("von Mises stress", 3.5e-7, [1280, 800]),
            ("s", 1.0, [300, 900]),
            ("a very long name of a quantity", 99_999.0, [640, 400]),
        ] {
            let legend = Legend { title: title.to_owned(), unit: "Pa".to_owned(), ..Legend::default() };
            let picture = Picture { size, legend: Some(legend), ..Picture::default() };
            let layout = Layout::of(&picture, (-high, high));
            let legend = layout.legend.as_ref().unwrap();
            let widest =
                legend.ticks.iter().map(|tick| text_width(&tick.1, layout.letter)).fold(0.0, f64::max);
            assert!(legend.right + 0.95 * layout.letter + widest <= size[0] as f64);
            assert!(
                legend.edge <= legend.left
                    && (layout.frame.right < legend.edge || layout.frame.right <= 0.5 * size[0] as f64)
            );
        }
    }
}
