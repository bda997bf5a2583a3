//! What plots are drawn with: SVG, or pixels.

use std::fmt::Write as _;

use super::{INK, LETTER};
use crate::picture::{Anchor, Canvas, Colour, Image};
use crate::vtk::escape;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Weight {
    Plain,
    Title,
    /// Plain, written from below upward.
    Upward,
}

const TITLE: f64 = 17.0;

/// Draws lines, dots and letters; places in units of the plot, `y` downward.
pub(super) trait Pen {
    fn line(&mut self, points: &[[f64; 2]], width: f64, colour: [u8; 3]);
    fn dashes(&mut self, points: &[[f64; 2]], width: f64, colour: [u8; 3]);
    fn dot(&mut self, place: [f64; 2], radius: f64, colour: [u8; 3]);
    fn text(&mut self, place: [f64; 2], anchor: Anchor, weight: Weight, content: &str);
}

/// Dash and gap.
const DASH: [f64; 2] = [6.0, 4.0];

pub(super) struct SvgPen {
    svg: String,
}

fn hexadecimal([r, g, b]: [u8; 3]) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

impl SvgPen {
    pub fn new([width, height]: [f64; 2]) -> Self {
        let ink = hexadecimal(INK);
        let svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
             viewBox=\"0 0 {width} {height}\" font-family=\"Helvetica, Arial, sans-serif\" \
             font-size=\"{LETTER}\" fill=\"{ink}\">\n<rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>\n"
        );
        Self { svg }
    }

    pub fn finish(mut self) -> String {
        self.svg.push_str("</svg>\n");
        self.svg
    }

    fn polyline(&mut self, points: &[[f64; 2]], width: f64, colour: [u8; 3], more: &str) {
        let points: Vec<String> = points.iter().map(|[x, y]| format!("{x:.2},{y:.2}")).collect();
        let (points, colour) = (points.join(" "), hexadecimal(colour));
        // writing to a string cannot fail
        let _ = writeln!(
            self.svg,
            "<polyline points=\"{points}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width}\" \
             stroke-linejoin=\"round\"{more}/>"
        );
    }
}

impl Pen for SvgPen {
    fn line(&mut self, points: &[[f64; 2]], width: f64, colour: [u8; 3]) {
        self.polyline(points, width, colour, "");
    }

    fn dashes(&mut self, points: &[[f64; 2]], width: f64, colour: [u8; 3]) {
        let [dash, gap] = DASH;
        self.polyline(points, width, colour, &format!(" stroke-dasharray=\"{dash} {gap}\""));
    }

    fn dot(&mut self, [x, y]: [f64; 2], radius: f64, colour: [u8; 3]) {
        let colour = hexadecimal(colour);
        let _ = writeln!(self.svg, "<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"{radius}\" fill=\"{colour}\"/>");
    }

    fn text(&mut self, [x, y]: [f64; 2], anchor: Anchor, weight: Weight, content: &str) {
        let anchor = match anchor {
            Anchor::Left => "start",
            Anchor::Middle => "middle",
            Anchor::Right => "end",
        };
        let more = match weight {
            Weight::Plain => String::new(),
            Weight::Title => format!(" font-size=\"{TITLE}\" font-weight=\"600\""),
            Weight::Upward => format!(" transform=\"rotate(-90 {x:.2} {y:.2})\""),
        };
        let content = escape(content);
        let _ = writeln!(
            self.svg,
            "<text x=\"{x:.2}\" y=\"{y:.2}\" text-anchor=\"{anchor}\"{more}>{content}</text>"
        );
    }
}

pub(super) struct PaintPen {
    canvas: Canvas,
    scale: f64,
}

/// Height of capitals of a letter of size one.
const CAPITAL: f64 = 0.7;

impl PaintPen {
    pub fn new(size: [f64; 2], scale: f64) -> Self {
        let [width, height] = size.map(|side| (side * scale).round() as usize);
        let mut canvas = Canvas::new(width, height);
        canvas.fill(0..width, 0..height, Colour::WHITE, 1.0);
        Self { canvas, scale }
    }

    pub fn finish(self) -> Image {
        self.canvas.finish()
    }

    fn place(&self, place: [f64; 2]) -> [f64; 2] {
        place.map(|coordinate| coordinate * self.scale)
    }
}

impl Pen for PaintPen {
    fn line(&mut self, points: &[[f64; 2]], width: f64, colour: [u8; 3]) {
        // piece by piece: each looks only at the pixels around it
        for pair in points.windows(2) {
            let pair = [self.place(pair[0]), self.place(pair[1])];
            self.canvas.line(&pair, width * self.scale, Colour::from_screen(colour));
        }
    }

    fn dashes(&mut self, points: &[[f64; 2]], width: f64, colour: [u8; 3]) {
        let mut walked = 0.0;
        for pair in points.windows(2) {
            let [from, to] = [pair[0], pair[1]];
            let length = (to[0] - from[0]).hypot(to[1] - from[1]);
            let at =
                |distance: f64| [0, 1].map(|axis| from[axis] + (to[axis] - from[axis]) * distance / length);
            let mut here = 0.0;
            while here < length {
                let phase = (walked + here) % (DASH[0] + DASH[1]);
                let (ends, drawn) =
                    if phase < DASH[0] { (DASH[0], true) } else { (DASH[0] + DASH[1], false) };
                // a step that rounding would make none
                let next = (here + (ends - phase).max(1e-6)).min(length);
                if drawn {
                    self.line(&[at(here), at(next)], width, colour);
                }
                here = next;
            }
            walked += length;
        }
    }

    fn dot(&mut self, place: [f64; 2], radius: f64, colour: [u8; 3]) {
        let place = self.place(place);
        self.canvas.line(&[place, place], 2.0 * radius * self.scale, Colour::from_screen(colour));
    }

    fn text(&mut self, place: [f64; 2], anchor: Anchor, weight: Weight, content: &str) {
        let place = self.place(place);
        let ink = Colour::from_screen(INK);
        match weight {
            Weight::Plain => self.canvas.text(content, place, CAPITAL * LETTER * self.scale, anchor, ink),
            Weight::Title => self.canvas.text(content, place, CAPITAL * TITLE * self.scale, anchor, ink),
            Weight::Upward => {
                self.canvas.text_upward(content, place, CAPITAL * LETTER * self.scale, anchor, ink);
            }
        }
    }
}
