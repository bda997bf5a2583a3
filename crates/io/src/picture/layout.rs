//! Where title, legend and subject stand in a picture, and the writing of the first two.

use super::camera::{Frame, axes};
use super::colour::Colour;
use super::colour_scale::ColourScale;
use super::image::{Anchor, Canvas};
use super::legend::{log_scale, scale};
use super::lettering::text_width;
use super::marks::{Corner, Mark, Shown};
use super::{Image, Legend, LegendPlace, Palette, Picture, Theme};

/// All in pixels.
pub(super) struct Layout {
    pub frame: Frame,
    /// Height of capitals of plain text.
    pub letter: f64,
    pub margin: f64,
    /// Of the marks, above the margin, or above a legend that lies below the subject.
    pub corner: Corner,
    /// The marks that there is room for.
    pub shown: Shown,
    /// The title in lines that fit, and the height of its capitals.
    title: Vec<String>,
    title_letter: f64,
    subtitle: Vec<String>,
    legend: Option<LegendBox>,
}

/// Where a legend may stand, and the letters that it is written in.
#[derive(Clone, Copy)]
struct Room {
    width: f64,
    height: f64,
    /// Below the title.
    top: f64,
    letter: f64,
    margin: f64,
}

/// The colour bar with its writing.
struct LegendBox {
    /// Of the bar.
    left: f64,
    right: f64,
    top: f64,
    bottom: f64,
    along: Along,
    /// Parts of the way along the bar, and what they are called.
    ticks: Vec<(f64, String)>,
    /// Parts of the way through the colours, of boxes of one length from the start of the bar, where values have names; the whole
    /// way where there are none.
    boxes: Vec<f64>,
    /// Of the ticks' names.
    widest: f64,
    title: Vec<String>,
    /// Left and upper border of everything of it, and the middle under its title.
    edge: f64,
    head: f64,
    middle: f64,
}

/// Which way the colours of a bar go.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Along {
    /// On the right of the subject.
    Upward,
    /// Below the subject.
    Rightward,
}

/// Half the height of the bar, and the height of a box with a name, as parts of the picture's.
const HALF_BAR: f64 = 0.21;
const TALLEST_BOX: f64 = 0.06;

/// Part of the width that a legend on the right leaves to the subject at least, and of the height one below: where neither does, there
/// is none.
const LEAST_LEFT: f64 = 0.5;
/// Part of the room under the title, or of the width, that marks take at most.
const MOST_OF_MARKS: f64 = 1.0 / 3.0;
/// In pictures that are this much higher than wide, a legend is better below.
const TALL: f64 = 1.2;
/// A shorter bar shows no colours, in letters.
const SHORTEST_BAR: f64 = 4.0;

/// Most numbers beside a bar, about, and most powers of ten.
const MOST_NUMBERS: usize = 5;
const MOST_POWERS: usize = 7;

/// Lines of a title that does not fit in one.
const MOST_LINES: usize = 3;

impl Layout {
    pub fn of(picture: &Picture, range: (f64, f64)) -> Self {
        let [width, height] = picture.size.map(|side| side as f64);
        let letter = (0.0165 * picture.letters * height.min(0.8 * width)).max(8.0);
        let margin = 0.045 * width.min(height);
        let Head { title, title_letter, subtitle, height: top } = Head::of(picture, letter, margin);
        let legend = legend_of(picture, range, Room { width, height, top, letter, margin });
        // room for the shade around the place of contact
        let shade = if picture.ground.is_some() { 0.07 * height } else { 0.0 };
        let (mut right, mut floor) = (width - margin, height - margin);
        match &legend {
            Some(legend) if legend.along == Along::Upward => right = legend.edge - 1.2 * letter,
            Some(legend) => floor = legend.head - 0.8 * letter,
            None => {}
        }
        // marks stand beside the subject, not on it, and leave most of the picture to it
        let mut shown =
            Shown { triad: picture.marks.triad, bar: picture.marks.scale_bar, key: picture.key.is_some() };
        let most = MOST_OF_MARKS * (floor - top);
        shown.bar &= shown.tall() * letter <= most;
        shown.key &= shown.tall() * letter <= most;
        let [wide, tall] = triad_size(picture, letter);
        let is_tall = height > TALL * width;
        let has_room = if is_tall { tall <= most } else { tall <= floor - top };
        shown.triad &= has_room && wide <= MOST_OF_MARKS * (right - margin);
        let [wide, tall] = if shown.triad { [wide + letter, tall] } else { [0.0; 2] };
        let marks = (shown.tall() * letter).max(if is_tall { tall } else { 0.0 });
        let lowest = if marks > 0.0 { floor - marks - 0.5 * letter } else { floor };
        // bar and key stand below a legend, or beside one that comes down so far
        let comes_down = |legend: &&LegendBox| {
            legend.along == Along::Upward
                && legend.bottom + 1.2 * letter > floor - (shown.tall() + 0.5) * letter
        };
        let corner = Corner {
            left: margin,
            beside: margin + wide,
            right: legend.as_ref().filter(comes_down).map_or(width - margin, |_| right),
            floor,
        };
        let left = if is_tall { margin } else { margin + wide };
        Self {
            frame: Frame { left, top, right, bottom: (floor - shade).min(lowest).max(top + 1.0) },
            letter,
            margin,
            corner,
            shown,
            title,
            title_letter,
            subtitle,
            legend,
        }
    }

    pub fn has_title(&self) -> bool {
        !self.title.is_empty()
    }

    pub fn has_subtitle(&self) -> bool {
        !self.subtitle.is_empty()
    }

    pub fn has_legend(&self) -> bool {
        self.legend.is_some()
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

/// What stands above the subject.
#[derive(Default)]
struct Head {
    title: Vec<String>,
    title_letter: f64,
    subtitle: Vec<String>,
    /// With the margin above.
    height: f64,
}

impl Head {
    /// As much as leaves half of the picture: of a title of several lines the last go first, then the time.
    fn of(picture: &Picture, letter: f64, margin: f64) -> Self {
        let [width, height] = picture.size.map(|side| side as f64);
        let room = width - 2.0 * margin;
        // a title that is a little too long is set smaller, one that is much too long in lines
        let wanted = 1.45 * letter;
        let title_letter =
            (wanted * room / text_width(&picture.title, wanted).max(1.0)).clamp(0.75 * wanted, wanted);
        let of_lines = |(lines, times): (usize, usize)| {
            let title = wrapped(&picture.title, title_letter, room, lines);
            let subtitle = wrapped(&picture.subtitle, letter, room, times);
            let above = title.len() as f64 * 1.65 * title_letter + subtitle.len() as f64 * 1.8 * letter;
            Self { title, title_letter, subtitle, height: margin + above }
        };
        let wishes = [(3, 1), (2, 1), (1, 1), (1, 0), (0, 1), (0, 0)];
        let fits = |head: &Self| head.height <= (1.0 - LEAST_LEFT) * height;
        wishes.into_iter().map(of_lines).find(fits).unwrap_or_default()
    }
}

/// The legend beside the subject, or below it where that leaves it more room; `None` where there is room for neither.
fn legend_of(picture: &Picture, range: (f64, f64), room: Room) -> Option<LegendBox> {
    let legend = picture.legend.as_ref().filter(|legend| legend.place == LegendPlace::Beside)?;
    let named = Named { legend, scale: picture.scale, range };
    let Room { width, height, .. } = room;
    let beside = LegendBox::beside(named, room).filter(|legend| legend.edge >= LEAST_LEFT * width);
    match beside {
        Some(beside) if height <= TALL * width && !beside.is_cut() => Some(beside),
        beside => LegendBox::below(named, room).or(beside),
    }
}

/// Width and height of the axes.
fn triad_size(picture: &Picture, letter: f64) -> [f64; 2] {
    let [left, top, right, bottom] =
        Mark::triad(axes(&picture.view), letter, &picture.palette()).reach(letter);
    [right - left, bottom - top]
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

/// What the colours of a legend mean.
#[derive(Clone, Copy)]
struct Named<'a> {
    legend: &'a Legend,
    scale: ColourScale,
    range: (f64, f64),
}

impl Named<'_> {
    /// Parts of the way along a bar with their names, about `count` numbers no nearer to its ends than `nearest`, and the unit.
    fn ticks(self, count: usize, nearest: f64) -> (Vec<(f64, String)>, String) {
        let Self { legend, scale: colours, range: (low, high) } = self;
        let of_numbers = match colours {
            ColourScale::Linear => scale(low, high, &legend.unit, count.min(MOST_NUMBERS), nearest),
            ColourScale::Logarithmic => {
                log_scale(low, high, &legend.unit, (count + 2).min(MOST_POWERS), nearest)
            }
        };
        if !legend.names.is_empty() {
            let middle = |index: usize| (index as f64 + 0.5) / legend.names.len() as f64;
            let names = legend.names.iter().enumerate();
            return (
                names.map(|(index, (_, name))| (middle(index), name.clone())).collect(),
                of_numbers.unit,
            );
        }
        let [below, above] = legend.beyond;
        let named = |(value, name): (f64, String)| {
            let name = match () {
                () if below && value <= low => format!("≤ {name}"),
                () if above && value >= high => format!("≥ {name}"),
                () => name,
            };
            (colours.share(value, (low, high)), name)
        };
        (of_numbers.ticks.into_iter().map(named).collect(), of_numbers.unit)
    }

    fn boxes(self) -> Vec<f64> {
        self.legend.names.iter().map(|(value, _)| self.scale.share(*value, self.range)).collect()
    }

    fn title(self, unit: &str, letter: f64, room: f64) -> Vec<String> {
        let title = match unit {
            "" => self.legend.title.clone(),
            unit => format!("{} [{unit}]", self.legend.title),
        };
        wrapped(&title, letter, room, MOST_LINES)
    }
}

fn widest<'a>(texts: impl IntoIterator<Item = &'a String>, letter: f64) -> f64 {
    texts.into_iter().map(|text| text_width(text, letter)).fold(0.0, f64::max)
}

impl LegendBox {
    /// On the right; `None` where the bar would be too short for its colours.
    fn beside(named: Named, room: Room) -> Option<Self> {
        let Room { width, height, letter, margin, .. } = room;
        let boxes = named.boxes();
        // boxes are no higher than they need to be
        let wanted = match boxes.len() {
            0 => 2.0 * HALF_BAR * height,
            count => {
                let of_box = (TALLEST_BOX * height).min(2.0 * HALF_BAR * height / count as f64);
                of_box.max(1.6 * letter) * count as f64
            }
        };
        let of_title = |title: &[String]| (1.4 + 1.6 * title.len() as f64) * letter;
        // how wide numbers are says how the title is wrapped, and that how long the bar may be, which says how many there are
        let mut long = wanted;
        for _ in 0..4 {
            let (ticks, unit) = named.ticks((long / (2.0 * letter)) as usize, 1.8 * letter / long);
            let widest = widest(ticks.iter().map(|(_, name)| name), letter);
            let bar = 1.4 * letter;
            let body = bar + 0.95 * letter + widest;
            let title = named.title(&unit, letter, body.max(0.24 * width));
            let highest = room.top + of_title(&title);
            let lowest = height - margin - 0.5 * letter;
            if wanted.min(lowest - highest) < long {
                long = lowest - highest;
                let least = (1.6 * boxes.len() as f64).max(SHORTEST_BAR);
                if long < least * letter {
                    return None;
                }
                continue;
            }
            let top = (0.5 * (height - long)).max(highest);
            let across = body.max(self::widest(&title, letter));
            let edge = width - margin - across;
            // under the middle of its title
            let left = edge + 0.5 * (across - body);
            return Some(Self {
                left,
                right: left + bar,
                top,
                bottom: top + long,
                along: Along::Upward,
                ticks,
                head: top - of_title(&title),
                boxes,
                widest,
                title,
                edge,
                middle: edge + 0.5 * across,
            });
        }
        None
    }

    /// Below the subject; `None` where that leaves too little of the picture, or the bar is too short for its numbers.
    fn below(named: Named, room: Room) -> Option<Self> {
        let Room { width, height, top, letter, margin } = room;
        let boxes = named.boxes();
        let (mut ticks, mut unit) = named.ticks(MOST_NUMBERS, 0.0);
        let mut widest = widest(ticks.iter().map(|(_, name)| name), letter);
        let long = |widest: f64| width - 2.0 * margin - widest;
        // fewer numbers may be narrower, never wider
        if boxes.is_empty() {
            let count = (long(widest) / (1.5 * widest + letter)) as usize;
            (ticks, unit) = named.ticks(count.max(1), (1.2 * widest + letter) / long(widest).max(1.0));
            widest = self::widest(ticks.iter().map(|(_, name)| name), letter);
        }
        let between = widest + 0.7 * letter;
        let places = match boxes.len() {
            0 => ticks.windows(2).map(|pair| pair[1].0 - pair[0].0).fold(1.0, f64::min),
            count => 1.0 / count as f64,
        };
        let long = long(widest);
        if long < SHORTEST_BAR * letter || places * long < between {
            return None;
        }
        let title = named.title(&unit, letter, width - 2.0 * margin);
        let bar_bottom = height - margin - 1.7 * letter;
        let bar_top = bar_bottom - 1.1 * letter;
        let head = bar_top - (0.2 + 1.6 * title.len() as f64) * letter;
        (head - top >= LEAST_LEFT * (height - top)).then_some(Self {
            left: margin + 0.5 * widest,
            right: width - margin - 0.5 * widest,
            top: bar_top,
            bottom: bar_bottom,
            along: Along::Rightward,
            ticks,
            boxes,
            widest,
            title,
            edge: margin,
            head,
            middle: 0.5 * width,
        })
    }

    /// Whether its title has more words than room.
    fn is_cut(&self) -> bool {
        self.title.iter().any(|line| line.ends_with('…'))
    }

    /// The same so many pixels to the right.
    fn moved(self, by: f64) -> Self {
        let Self { left, right, edge, middle, .. } = self;
        Self { left: left + by, right: right + by, edge: edge + by, middle: middle + by, ..self }
    }

    /// The same so many pixels higher.
    fn raised(self, by: f64) -> Self {
        let Self { top, bottom, head, .. } = self;
        Self { top: top - by, bottom: bottom - by, head: head - by, ..self }
    }

    fn write(&self, picture: &Picture, letter: f64, palette: &Palette, canvas: &mut Canvas) {
        let whole = |value: f64| value.max(0.0) as usize;
        let (left, right) = (whole(self.left), whole(self.right));
        let (top, bottom) = (whole(self.top), whole(self.bottom));
        let lowest = match self.along {
            Along::Upward => self.bottom + 1.2 * letter,
            Along::Rightward => canvas.height as f64,
        };
        veil(canvas, palette, [self.edge - 0.8 * letter, canvas.width as f64], [self.head, lowest]);
        canvas.fill(left.saturating_sub(1)..right + 1, top.saturating_sub(1)..bottom + 1, palette.ink, 0.8);
        let colour = |along: f64| {
            let of_box =
                self.boxes.get(((along * self.boxes.len() as f64) as usize).min(self.boxes.len().max(1) - 1));
            picture.colours.colour(of_box.copied().unwrap_or(along))
        };
        let share = |index: usize, count: usize| index as f64 / (count.max(2) as f64 - 1.0);
        match self.along {
            Along::Upward => {
                for row in top..bottom {
                    let of_row = colour(1.0 - share(row - top, bottom - top));
                    canvas.fill(left..right, row..row + 1, of_row, 1.0);
                }
            }
            Along::Rightward => {
                for column in left..right {
                    let of_column = colour(share(column - left, right - left));
                    canvas.fill(column..column + 1, top..bottom, of_column, 1.0);
                }
            }
        }
        for (along, label) in &self.ticks {
            let (line, place, anchor) = match self.along {
                Along::Upward => {
                    let y = self.bottom - along * (self.bottom - self.top);
                    // one under the other by their last digits
                    let place = [self.right + 0.95 * letter + self.widest, y + 0.5 * letter];
                    ([[self.right + 1.0, y], [self.right + 0.45 * letter, y]], place, Anchor::Right)
                }
                Along::Rightward => {
                    let x = self.left + along * (self.right - self.left);
                    let line = [[x, self.bottom + 1.0], [x, self.bottom + 0.35 * letter]];
                    (line, [x, self.bottom + 1.7 * letter], Anchor::Middle)
                }
            };
            canvas.line(&line, 1.2, palette.ink);
            canvas.text(label, place, letter, anchor, palette.ink);
        }
        let above = match self.along {
            Along::Upward => 1.4,
            Along::Rightward => 0.7,
        };
        for (index, line) in self.title.iter().rev().enumerate() {
            let y = self.top - (above + 1.6 * index as f64) * letter;
            canvas.text(line, [self.middle, y], letter, Anchor::Middle, palette.ink);
        }
    }
}

impl Picture {
    /// The legend alone, as a strip of that width to stand below a sheet of pictures; `None` where there is none, or no room for it.
    pub fn legend_below(&self, width: usize) -> Option<Image> {
        let letter = (0.018 * width as f64).clamp(8.0, 20.0);
        let margin = 1.4 * letter;
        let named = Named { legend: self.legend.as_ref()?, scale: self.scale, range: self.range() };
        // laid out in a strip that is high enough for any title, of which the free part is left out
        let high = 40.0 * letter;
        let room = Room { width: width as f64, height: high, top: 0.0, letter, margin };
        let of = LegendBox::below(named, room)?;
        let spare = of.head - 0.8 * letter;
        let mut canvas = Canvas::new(width, (high - spare).ceil() as usize);
        let palette = self.palette();
        canvas.fill(0..width, 0..canvas.height, palette.bottom, 1.0);
        of.raised(spare).write(self, letter, &palette, &mut canvas);
        Some(canvas.finish())
    }

    /// The legend alone, as a strip of that height to stand beside a sheet of pictures; `None` where there is none.
    pub fn legend_strip(&self, height: usize) -> Option<Image> {
        let letter = (0.018 * height as f64).clamp(8.0, 20.0);
        let margin = 2.0 * letter;
        // laid out in a strip that is wide enough for any title, of which the free part is left out
        let wide = (1.6 * height as f64).max(44.0 * letter) as usize;
        let named = Named { legend: self.legend.as_ref()?, scale: self.scale, range: self.range() };
        let room = Room { width: wide as f64, height: height as f64, top: letter, letter, margin };
        let of = LegendBox::beside(named, room)?;
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

    /// A strip with a title to stand above a sheet, the background of a picture of that theme going on under it.
    pub fn title_strip(title: &str, width: usize, theme: Theme) -> Self {
        let palette = theme.palette();
        let letter = (0.011 * width as f64).max(8.0);
        let margin = 1.4 * letter;
        let lines = wrapped(title, letter, width as f64 - 2.0 * margin, MOST_LINES);
        let height = margin + lines.len() as f64 * 1.65 * letter;
        let mut strip = Canvas::new(width, height as usize);
        strip.fill(0..width, 0..strip.height, palette.top, 1.0);
        for (index, line) in lines.iter().enumerate() {
            let baseline = margin + (0.8 + 1.65 * index as f64) * letter;
            strip.text(line, [margin, baseline], letter, Anchor::Left, palette.ink);
        }
        strip.finish()
    }

    /// The same with another of the same width below.
    pub fn above(&self, other: &Self) -> Self {
        let pixels = [&self.pixels[..], &other.pixels[..]].concat();
        Self { width: self.width, height: self.height + other.height, pixels }
    }

    /// The same in a size that is a little larger, in one colour on its right and below.
    pub fn grown(&self, [width, height]: [usize; 2], background: [u8; 3]) -> Self {
        let mut pixels = vec![background; width * height];
        for (to, from) in
            pixels.chunks_exact_mut(width.max(1)).zip(self.pixels.chunks_exact(self.width.max(1)))
        {
            let both = width.min(self.width);
            to[..both].copy_from_slice(&from[..both]);
        }
        Self { width, height, pixels }
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
    use souple_math::Vec3;

    use super::super::marks::Placed;
    use super::super::{ArrowKey, LEGEND, Marks, Surface};
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

    /// However wide its numbers and its title, and however small or narrow the picture: the legend is within it, its numbers do not
    /// touch, and the subject stands beside or above it; where there is no room for both there is no legend.
    #[test]
    fn the_subject_stands_beside_the_legend() {
        let tiny = Picture { size: [48, 40], legend: Some(Legend::default()), ..Picture::default() };
        assert!(Layout::of(&tiny, (0.0, 1234.5)).legend.is_none() && tiny.left_out() == [LEGEND]);
        let names = vec![(0.0, "1234 tet".to_owned()), (1.0, "56 hex".to_owned())];
        for size in [[1280, 800], [300, 900], [640, 400], [200, 150], [120, 400], [160, 120], [240, 100]] {
            for (title, high, names) in [
                ("von Mises stress", 3.5e-7, &[][..]),
                ("s", 1.0, &[]),
                ("a very long name of a quantity", 99_999.0, &[]),
                ("element", 1.0, &names),
            ] {
                let title = title.to_owned();
                let (unit, names) = ("Pa".to_owned(), names.to_vec());
                let legend = Legend { title, unit, names, beyond: [true; 2], ..Legend::default() };
                let picture = Picture {
                    size,
                    title: "A title of several words".to_owned(),
                    subtitle: "0.125 s".to_owned(),
                    legend: Some(legend),
                    ..Picture::default()
                };
                let layout = Layout::of(&picture, (-high, high));
                let Some(legend) = &layout.legend else {
                    assert!(size[0] < 250 || size[1] < 150, "{size:?}");
                    continue;
                };
                let letter = layout.letter;
                let [width, height] = size.map(|side| side as f64);
                assert!(legend.edge >= 0.0 && legend.edge <= legend.left);
                assert!(legend.head >= layout.frame.top - 1e-9);
                let mut ends: Vec<[f64; 2]> = legend
                    .ticks
                    .iter()
                    .map(|(along, name)| match legend.along {
                        Along::Upward => {
                            assert!(legend.right + 0.95 * letter + legend.widest <= width);
                            let y = along * (legend.bottom - legend.top);
                            [y - 0.5 * letter, y + 0.5 * letter]
                        }
                        Along::Rightward => {
                            let x = legend.left + along * (legend.right - legend.left);
                            let half = 0.5 * text_width(name, letter);
                            assert!(x - half >= 0.0 && x + half <= width);
                            [x - half, x + half]
                        }
                    })
                    .collect();
                ends.sort_by(|a, b| a[0].total_cmp(&b[0]));
                assert!(ends.windows(2).all(|pair| pair[0][1] < pair[1][0]), "{size:?} {:?}", legend.ticks);
                match legend.along {
                    Along::Upward => {
                        assert!(layout.frame.right < legend.edge && legend.bottom < height);
                    }
                    Along::Rightward => assert!(layout.frame.bottom < legend.head),
                }
            }
        }
    }

    /// However small or narrow a picture is, and whatever it has of them: title, legend, axes, bar, key and the subject are within
    /// it and none overlaps another; what has no room is left out, and told.
    #[test]
    fn nothing_overlaps() {
        let points = [[0.0, 0.0, 0.0], [0.3, 0.1, 0.0], [0.0, 0.2, 0.1]].map(Vec3::from_array).to_vec();
        let surface = Surface { points, triangles: vec![[0, 1, 2]], ..Surface::default() };
        let key = |title: &str| ArrowKey { title: title.to_owned(), unit: "m/s".to_owned(), scale: 0.7 };
        let mut told = 0;
        for size in [
            [1280, 800],
            [600, 450],
            [300, 200],
            [120, 90],
            [48, 32],
            [300, 600],
            [300, 900],
            [400, 800],
            [1500, 400],
            [160, 120],
            [240, 160],
            [99, 400],
            [2000, 2000],
        ] {
            for (marks, key) in [
                (Marks { triad: true, scale_bar: true }, Some(key("displacement"))),
                (Marks { triad: false, scale_bar: true }, Some(key("a field of a very long name indeed"))),
                (Marks { triad: true, scale_bar: false }, None),
            ] {
                let (wanted_key, wanted_marks) = (key.is_some(), marks);
                let picture = Picture {
                    surfaces: vec![surface.clone()],
                    size,
                    title: "A bar of rubber that is bent by its own weight".to_owned(),
                    subtitle: "0.125 s".to_owned(),
                    legend: Some(Legend {
                        title: "von Mises stress".to_owned(),
                        range: Some((0.0, 1234.5)),
                        ..Legend::default()
                    }),
                    marks,
                    key,
                    ..Picture::default()
                };
                let layout = Layout::of(&picture, (0.0, 1234.5));
                let (letter, margin) = (layout.letter, layout.margin);
                let [width, height] = size.map(|side| side as f64);
                let widths = |lines: &[String], letter: f64| widest(lines, letter);
                let title_bottom = margin
                    + layout.title.len() as f64 * 1.65 * layout.title_letter
                    + layout.subtitle.len() as f64 * 1.8 * letter;
                let title_right =
                    margin + widths(&layout.title, layout.title_letter).max(widths(&layout.subtitle, letter));
                let camera = picture.camera(picture.bounds(), &layout);
                let placed = Placed::of(&picture, &camera, &layout, &picture.palette());
                let Frame { left, top, right, bottom } = layout.frame;
                let mut boxes = vec![("title", [margin, margin, title_right, title_bottom])];
                boxes.push(("subject", [left, top, right, bottom]));
                boxes.extend(layout.legend.as_ref().map(|legend| {
                    (
                        "legend",
                        match legend.along {
                            Along::Upward => {
                                [legend.edge, legend.head, width - margin, legend.bottom + 0.5 * letter]
                            }
                            Along::Rightward => [legend.edge, legend.head, width - margin, height - margin],
                        },
                    )
                }));
                let marks = [("axes", &placed.triad), ("bar", &placed.bar), ("key", &placed.key)];
                boxes.extend(
                    marks.iter().filter_map(|(name, mark)| Some((*name, mark.as_ref()?.reach(letter)))),
                );
                for (index, (name, a)) in boxes.iter().enumerate() {
                    // lines end half of their width, a part of a letter, beyond the margin
                    let within = a[0] >= 0.0 && a[1] >= 0.0 && a[2] <= width && a[3] <= height + 0.5 * letter;
                    assert!(within && a[0] <= a[2] && a[1] <= a[3], "{size:?} {name} {a:?}");
                    for (other, b) in &boxes[index + 1..] {
                        let apart = a[2] <= b[0] + 1e-9
                            || b[2] <= a[0] + 1e-9
                            || a[3] <= b[1] + 1e-9
                            || b[3] <= a[1] + 1e-9;
                        assert!(apart, "{size:?} {name} {a:?} {other} {b:?}");
                    }
                }
                let lost = picture.left_out();
                let is_lost = |name: &str| lost.contains(&name);
                assert_eq!(is_lost("axes"), wanted_marks.triad && placed.triad.is_none());
                assert_eq!(is_lost("key of the arrows"), wanted_key && placed.key.is_none());
                assert_eq!(is_lost(LEGEND), layout.legend.is_none());
                if size[0] >= 1280 {
                    assert!(lost.is_empty(), "{size:?} {lost:?}");
                }
                told += lost.len();
            }
        }
        assert!(told > 0);
    }
}
