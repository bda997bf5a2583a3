//! Line plots as SVG and as PNG: probes over time, errors over mesh sizes.

mod pen;

use std::path::Path;

use crate::picture::{Anchor, Image, labels, ticks};
use crate::{IoError, write_file};
use pen::{PaintPen, Pen, SvgPen, Weight};

/// One curve.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Curve {
    /// Shown in the legend, if not empty.
    pub name: String,
    pub x: Vec<f64>,
    pub y: Vec<f64>,
    pub mark: Mark,
}

impl Curve {
    pub fn new(name: impl Into<String>, x: Vec<f64>, y: Vec<f64>) -> Self {
        Self { name: name.into(), x, y, mark: Mark::default() }
    }
}

/// How a curve is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mark {
    #[default]
    Line,
    Dashes,
    Dots,
    /// Dots joined by a line: measured values.
    DottedLine,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Scale {
    #[default]
    Linear,
    /// Base 10; values that are not positive are left out.
    Logarithmic,
}

/// One axis: what it shows, in which unit.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Axis {
    pub name: String,
    /// Written in brackets behind the name, if not empty.
    pub unit: String,
    pub scale: Scale,
}

impl Axis {
    pub fn new(name: impl Into<String>, unit: impl Into<String>) -> Self {
        Self { name: name.into(), unit: unit.into(), scale: Scale::default() }
    }

    fn label(&self) -> String {
        if self.unit.is_empty() { self.name.clone() } else { format!("{} [{}]", self.name, self.unit) }
    }
}

/// A plot of several curves over common axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Plot {
    pub title: String,
    pub x: Axis,
    pub y: Axis,
    pub curves: Vec<Curve>,
    /// Width and height [pixels].
    pub size: [f64; 2],
}

impl Default for Plot {
    fn default() -> Self {
        Self {
            title: String::new(),
            x: Axis::default(),
            y: Axis::default(),
            curves: Vec::new(),
            size: [800.0, 480.0],
        }
    }
}

/// Okabe & Ito 2008: told apart by all eyes.
const COLOURS: [[u8; 3]; 7] = [
    [0x00, 0x72, 0xb2],
    [0xd5, 0x5e, 0x00],
    [0x00, 0x9e, 0x73],
    [0xcc, 0x79, 0xa7],
    [0xe6, 0x9f, 0x00],
    [0x56, 0xb4, 0xe9],
    [0x44, 0x44, 0x44],
];
const INK: [u8; 3] = [0x22, 0x28, 0x31];
const GRID: [u8; 3] = [0xe3, 0xe6, 0xeb];
const LETTER: f64 = 13.0;
/// Share of the range left free above and below the curves.
const HEADROOM: f64 = 0.05;
/// Most points of a curve in the file: more than two for each pixel cannot be seen.
const MOST_POINTS: usize = 4000;

/// The range of one axis and where it lies in the plot.
#[derive(Clone, Copy, Debug)]
struct Span {
    scale: Scale,
    /// In the coordinate of the axis: the value or its logarithm.
    low: f64,
    high: f64,
    /// Where low and high stand [pixels].
    from: f64,
    to: f64,
}

impl Span {
    /// All finite values, with some room.
    fn of(values: impl Iterator<Item = f64>, scale: Scale, headroom: f64) -> Self {
        let mut span = Self { scale, low: f64::INFINITY, high: f64::NEG_INFINITY, from: 0.0, to: 1.0 };
        for value in values {
            if let Some(coordinate) = span.coordinate(value) {
                span.low = span.low.min(coordinate);
                span.high = span.high.max(coordinate);
            }
        }
        if span.low > span.high {
            (span.low, span.high) = (0.0, 1.0);
        } else if span.low == span.high {
            let half =
                if scale == Scale::Logarithmic || span.low == 0.0 { 0.5 } else { 0.5 * span.low.abs() };
            (span.low, span.high) = (span.low - half, span.high + half);
        } else {
            let room = headroom * (span.high - span.low);
            (span.low, span.high) = (span.low - room, span.high + room);
        }
        span
    }

    fn coordinate(&self, value: f64) -> Option<f64> {
        let coordinate = match self.scale {
            Scale::Linear => value,
            Scale::Logarithmic => libm::log10(value),
        };
        // differences of the largest numbers would overflow
        (coordinate.is_finite() && coordinate.abs() < 1e300).then_some(coordinate)
    }

    fn place(&self, coordinate: f64) -> f64 {
        self.from + (coordinate - self.low) / (self.high - self.low) * (self.to - self.from)
    }

    /// Coordinates of the ticks and what is written at them.
    fn ticks(&self, about: usize) -> Vec<(f64, String)> {
        match self.scale {
            Scale::Linear => {
                let ticks = ticks(self.low, self.high, about);
                let labels = labels(&ticks);
                ticks.into_iter().zip(labels).collect()
            }
            Scale::Logarithmic => self.logarithmic_ticks(about),
        }
    }

    /// Powers of ten where there are several, else round numbers between, and evenly spaced ones where there are less than three
    /// of these.
    fn logarithmic_ticks(&self, about: usize) -> Vec<(f64, String)> {
        let powers: Vec<f64> = match ticks(self.low, self.high, about) {
            ticks if ticks.len() > 1 && ticks.iter().all(|tick| tick.fract() == 0.0) => ticks,
            _ => (self.low.ceil() as i64..=self.high.floor() as i64).map(|power| power as f64).collect(),
        };
        if powers.len() > 1 {
            let is_short = powers.iter().all(|power| SHORT_POWERS.contains(power));
            let label =
                |power: f64| if is_short { plain(libm::pow(10.0, power)) } else { format!("1e{power}") };
            return powers.into_iter().map(|power| (power, label(power))).collect();
        }
        for digits in [&[1.0, 2.0, 5.0][..], &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0]] {
            let decades = self.low.floor() as i64..=self.high.ceil() as i64;
            let found: Vec<(f64, String)> = decades
                .flat_map(|decade| digits.iter().map(move |digit| digit * libm::pow(10.0, decade as f64)))
                .map(|value| (libm::log10(value), plain(value)))
                .filter(|(coordinate, _)| (self.low..=self.high).contains(coordinate))
                .collect();
            if found.len() > 2 {
                return found;
            }
        }
        let values = ticks(libm::pow(10.0, self.low), libm::pow(10.0, self.high), about);
        let labels = labels(&values);
        values.into_iter().map(libm::log10).zip(labels).collect()
    }
}

/// Powers of ten that are written out on a logarithmic axis.
const SHORT_POWERS: std::ops::RangeInclusive<f64> = -3.0..=3.0;

/// A number of few digits, written out where that is short.
fn plain(value: f64) -> String {
    let exponent = format!("{value:.3e}").replace(".000", "");
    if (1e-4..1e5).contains(&value) {
        // of the digits that the exponent form has
        exponent.parse::<f64>().map_or(exponent, |rounded| rounded.to_string())
    } else {
        exponent
    }
}

impl Plot {
    /// The plot as SVG.
    ///
    /// # Errors
    /// A curve whose `x` and `y` differ in length, a size that is not positive.
    pub fn to_svg(&self) -> Result<String, IoError> {
        self.check()?;
        let mut pen = SvgPen::new(self.size);
        self.draw(&mut pen);
        Ok(pen.finish())
    }
    /// The plot as pixels, `scale` of them along each unit of its size: 2 is fine enough for print.
    ///
    /// # Errors
    /// Those of [`Plot::to_svg`]; a scale out of range.
    pub fn to_image(&self, scale: f64) -> Result<Image, IoError> {
        self.check()?;
        if !(0.25..=8.0).contains(&scale) {
            return Err(IoError::request("the scale of the plot", scale, "0.25 to 8"));
        }
        let mut pen = PaintPen::new(self.size, scale);
        self.draw(&mut pen);
        Ok(pen.finish())
    }

    fn check(&self) -> Result<(), IoError> {
        for (index, curve) in self.curves.iter().enumerate() {
            if curve.x.len() != curve.y.len() {
                let expected = format!("{}, as of `x`", curve.x.len());
                return Err(IoError::request(
                    format!("the length of `y` of curves[{index}]"),
                    curve.y.len(),
                    expected,
                ));
            }
        }
        if let Some(side) = self.size.iter().find(|side| !(100.0..=20_000.0).contains(*side)) {
            return Err(IoError::request("a side of the plot", side, "100 to 20000 pixels"));
        }
        Ok(())
    }

    /// Writes the plot as SVG.
    ///
    /// # Errors
    /// Those of [`Plot::to_svg`]; the file cannot be written.
    pub fn write_svg(&self, path: &Path) -> Result<(), IoError> {
        let text = self.to_svg()?;
        write_file(path, |out| out.write_all(text.as_bytes()))
    }

    fn draw(&self, pen: &mut dyn Pen) {
        let [width, height] = self.size;
        let named: Vec<(usize, &Curve)> =
            self.curves.iter().enumerate().filter(|(_, curve)| !curve.name.is_empty()).collect();
        let values = |of: fn(&Curve) -> &Vec<f64>| self.curves.iter().flat_map(of).copied();
        // dots at the ends would lie on the frame
        let has_dots = self.curves.iter().any(|curve| matches!(curve.mark, Mark::Dots | Mark::DottedLine));
        let beside = if has_dots { HEADROOM } else { 0.0 };
        let mut x = Span::of(values(|curve| &curve.x), self.x.scale, beside);
        let mut y = Span::of(values(|curve| &curve.y), self.y.scale, HEADROOM);
        let y_ticks = y.ticks((height / 70.0) as usize);
        let x_ticks = x.ticks((width / 110.0) as usize);

        let longest =
            |texts: &mut dyn Iterator<Item = usize>| texts.max().unwrap_or(0) as f64 * 0.56 * LETTER;
        let label_width = longest(&mut y_ticks.iter().map(|tick| tick.1.chars().count()));
        // names beside the plot hide nothing of it
        let legend_width = match longest(&mut named.iter().map(|(_, curve)| curve.name.chars().count())) {
            0.0 => 0.0,
            text => (text + 52.0).min(0.4 * width),
        };
        let top = if self.title.is_empty() { 20.0 } else { 46.0 };
        let (left, right) = (label_width + 48.0, width - 22.0 - legend_width);
        (x.from, x.to) = (left, right);
        (y.from, y.to) = (height - 58.0, top);

        if !self.title.is_empty() {
            pen.text([left, 28.0], Anchor::Left, Weight::Title, &self.title);
        }
        for (coordinate, label) in &x_ticks {
            let at = x.place(*coordinate);
            pen.line(&[[at, y.from], [at, y.to]], 1.0, GRID);
            pen.text([at, y.from + 19.0], Anchor::Middle, Weight::Plain, label);
        }
        for (coordinate, label) in &y_ticks {
            let at = y.place(*coordinate);
            pen.line(&[[x.from, at], [x.to, at]], 1.0, GRID);
            pen.text([x.from - 8.0, at + 0.35 * LETTER], Anchor::Right, Weight::Plain, label);
        }
        pen.line(&[[x.from, y.from], [x.to, y.from]], 1.0, INK);
        pen.line(&[[x.from, y.from], [x.from, y.to]], 1.0, INK);
        pen.text([0.5 * (x.from + x.to), height - 14.0], Anchor::Middle, Weight::Plain, &self.x.label());
        let middle = 0.5 * (y.from + y.to);
        pen.text([18.0, middle], Anchor::Middle, Weight::Upward, &self.y.label());

        for (index, curve) in self.curves.iter().enumerate() {
            draw_curve(pen, curve, COLOURS[index % COLOURS.len()], x, y);
        }
        for (row, (index, curve)) in named.iter().enumerate() {
            let at = y.to + 12.0 + 21.0 * row as f64;
            let sample = Curve { x: vec![0.0, 1.0], y: vec![0.0, 0.0], ..(*curve).clone() };
            let across =
                Span { scale: Scale::Linear, low: 0.0, high: 1.0, from: x.to + 16.0, to: x.to + 40.0 };
            let flat = Span { low: -1.0, from: at, to: at, ..across };
            draw_curve(pen, &sample, COLOURS[index % COLOURS.len()], across, flat);
            pen.text([x.to + 47.0, at + 0.35 * LETTER], Anchor::Left, Weight::Plain, &curve.name);
        }
    }
}

/// Runs of finite points; what lies between them is left out, not joined.
fn draw_curve(pen: &mut dyn Pen, curve: &Curve, colour: [u8; 3], x: Span, y: Span) {
    let stride = curve.x.len().div_ceil(MOST_POINTS).max(1);
    let places: Vec<Option<[f64; 2]>> = thinned(curve, stride)
        .map(|(at, value)| Some([x.place(x.coordinate(at)?), y.place(y.coordinate(value)?)]))
        .collect();
    if curve.mark != Mark::Dots {
        for run in places.split(Option::is_none).filter(|run| run.len() > 1) {
            let points: Vec<[f64; 2]> = run.iter().flatten().copied().collect();
            if curve.mark == Mark::Dashes {
                pen.dashes(&points, CURVE, colour);
            } else {
                pen.line(&points, CURVE, colour);
            }
        }
    }
    if matches!(curve.mark, Mark::Dots | Mark::DottedLine) {
        places.iter().flatten().for_each(|place| pen.dot(*place, 3.2, colour));
    }
}

/// Width of a curve.
const CURVE: f64 = 1.8;

/// Least and greatest value of each `2 stride` points in their order: peaks stay. All points for a stride of one.
fn thinned(curve: &Curve, stride: usize) -> Box<dyn Iterator<Item = (f64, f64)> + '_> {
    let all = curve.x.iter().copied().zip(curve.y.iter().copied());
    if stride == 1 {
        return Box::new(all);
    }
    let window = 2 * stride;
    Box::new(curve.y.chunks(window).enumerate().flat_map(move |(index, values)| {
        let by_value = |a: &usize, b: &usize| values[*a].total_cmp(&values[*b]);
        let low = (0..values.len()).min_by(by_value).unwrap_or(0);
        let high = (0..values.len()).max_by(by_value).unwrap_or(0);
        [low.min(high), low.max(high)].map(|place| (curve.x[index * window + place], values[place]))
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sine() -> Curve {
        let x: Vec<f64> = (0..200).map(|index| f64::from(index) * 0.01).collect();
        let y = x.iter().map(|x| (6.0 * x).sin()).collect();
        Curve::new("tip & <root>", x, y)
    }

    #[test]
    fn axes_curves_and_names_are_there() {
        let (x, y) = (Axis::new("time", "s"), Axis::new("displacement", "m"));
        let plot = Plot { title: "Probe".into(), x, y, curves: vec![sine(), sine()], ..Plot::default() };
        let svg = plot.to_svg().unwrap();
        assert_eq!(svg.matches("stroke-width=\"1.8\"").count(), 4, "two curves, two samples in the legend");
        for part in
            [">time [s]<", ">displacement [m]<", ">Probe<", "tip &amp; &lt;root&gt;", ">0.5<", ">−0.5<"]
        {
            assert!(svg.contains(part), "{part}");
        }
    }

    /// Points lie where the axes say: the ends of the curve at the ends of the horizontal axis.
    #[test]
    fn places_follow_the_axes() {
        let span = Span { from: 50.0, to: 250.0, ..Span::of([1.0, 3.0].into_iter(), Scale::Linear, 0.0) };
        assert_eq!([1.0, 2.0, 3.0].map(|value| span.place(value)), [50.0, 150.0, 250.0]);
        let decades = Span::of([1e-3, 1e2].into_iter(), Scale::Logarithmic, 0.0);
        let labels: Vec<_> = decades.ticks(6).into_iter().map(|tick| tick.1).collect();
        assert_eq!(labels, ["0.001", "0.01", "0.1", "1", "10", "100"]);
        let wide = Span::of([1e-6, 1e2].into_iter(), Scale::Logarithmic, 0.0);
        assert!(wide.ticks(6).iter().all(|tick| tick.1.starts_with("1e")));
        let narrow = Span::of([2.0, 30.0].into_iter(), Scale::Logarithmic, 0.0);
        assert_eq!(narrow.ticks(4).len(), 4);
    }

    /// However short a range is, two numbers at least tell its scale.
    #[test]
    fn axes_have_two_numbers() {
        let ranges = [[0.011, 0.03], [0.021, 0.039], [0.041, 0.0412], [0.9, 1.1], [7e7, 7.3e7], [1.0, 1e9]];
        for (scale, [low, high]) in
            [Scale::Linear, Scale::Logarithmic].into_iter().flat_map(|s| ranges.map(|r| (s, r)))
        {
            for about in [4, 7] {
                let span = Span::of([low, high].into_iter(), scale, 0.0);
                let mut labels: Vec<String> = span.ticks(about).into_iter().map(|tick| tick.1).collect();
                let count = labels.len();
                labels.dedup();
                assert!(count > 1 && labels.len() == count, "{low} to {high}: {labels:?}");
            }
        }
    }

    /// The same plot as pixels: a curve along the top of the range is drawn in its colour where the axes say.
    #[test]
    fn pixels_follow_the_axes() {
        let curve = Curve::new("", vec![0.0, 1.0], vec![1.0, 1.0]);
        let floor = Curve { mark: Mark::Dots, ..Curve::new("", vec![0.0, 1.0], vec![0.0, 0.0]) };
        let plot = Plot { curves: vec![curve, floor], y: Axis::new("µ [10⁻³]", ""), ..Plot::default() };
        let image = plot.to_image(2.0).unwrap();
        assert_eq!((image.width, image.height), (1600, 960));
        let rows: Vec<usize> =
            (0..image.height).filter(|row| image.pixels[row * image.width + 900] == COLOURS[0]).collect();
        // from the top of the plot, 20, to its foot, 422, with headroom of 0.05 of the range above and below
        let expected = 2.0 * (20.0 + (422.0 - 20.0) * 0.05 / 1.1);
        assert!(
            !rows.is_empty() && rows.iter().all(|row| (*row as f64 - expected).abs() < 3.0),
            "{rows:?} {expected}"
        );
        assert!(plot.to_image(f64::NAN).is_err());
    }

    #[test]
    fn gaps_are_not_joined_and_peaks_survive_thinning() {
        let gap = Curve::new("", vec![0.0, 1.0, 2.0, 3.0, 4.0], vec![1.0, 2.0, f64::NAN, 2.0, 1.0]);
        let svg = Plot { curves: vec![gap], ..Plot::default() }.to_svg().unwrap();
        assert_eq!(svg.matches("stroke-width=\"1.8\"").count(), 2);
        let mut y = vec![0.0; 100_001];
        y[77_777] = 5.0;
        let curve = Curve::new("", (0..y.len()).map(|index| index as f64).collect(), y);
        let kept: Vec<_> = thinned(&curve, curve.x.len().div_ceil(MOST_POINTS)).collect();
        assert!(kept.len() <= MOST_POINTS + 2 && kept.contains(&(77_777.0, 5.0)));
        assert!(kept.windows(2).all(|pair| pair[0].0 <= pair[1].0));
    }

    #[test]
    fn strange_data_are_drawn_or_refused() {
        let curve = Curve::new("a", vec![0.0; 3], vec![0.0; 2]);
        assert!(Plot { curves: vec![curve], ..Plot::default() }.to_svg().is_err());
        assert!(Plot { size: [f64::NAN, 400.0], ..Plot::default() }.to_svg().is_err());
        for y in [vec![], vec![0.0], vec![f64::MAX, f64::MIN], vec![f64::NAN; 4], vec![1e-320, 0.0]] {
            for scale in [Scale::Linear, Scale::Logarithmic] {
                let x = (0..y.len()).map(|index| index as f64).collect();
                let mut plot = Plot { curves: vec![Curve::new("a", x, y.clone())], ..Plot::default() };
                plot.y.scale = scale;
                assert!(!plot.to_svg().unwrap().contains("NaN"));
            }
        }
    }
}
