//! Dots, lines and arrows over a picture, hidden where something is before them.

use super::camera::{Camera, Projected};
use super::colour::Colour;
use super::near::line_before_eye;
use super::raster::{Samples, distance_point_segment};
use super::surface::{Stroke, StrokeShape};

/// A piece of a stroke in the picture.
#[derive(Clone, Debug)]
pub(super) struct Drawn {
    from: Projected,
    to: Projected,
    /// At both ends [pixels]; a dot has no length, the head of an arrow ends in a point.
    half_widths: [f64; 2],
    colour: Colour,
    through: f32,
    /// Rows of pixels that it may touch.
    rows: std::ops::Range<usize>,
}

/// How much closer a stroke counts than it is, relative: one that lies on a surface is seen whole.
const LIFT: f64 = 4e-3;

/// Strokes as pieces in the picture; `surfaces` are what may stand before them.
///
/// An arrow whose start is seen is seen whole, also where it points into the body that it starts on.
pub(super) fn prepared(strokes: &[Stroke], camera: &Camera, surfaces: &Samples) -> Vec<Drawn> {
    let mut drawn = Vec::new();
    for stroke in strokes {
        let half = 0.5 * stroke.width.clamp(0.0, 1000.0);
        let mut push = |from: Projected, to: Projected, half_widths: [f64; 2]| {
            if from.inverse_depth > 0.0 && to.inverse_depth > 0.0 {
                let reach = half_widths[0].max(half_widths[1]) + 1.0;
                let first = (from.y.min(to.y) - reach).max(0.0) as usize;
                let last = (from.y.max(to.y) + reach).max(0.0) as usize;
                let Stroke { colour, through, .. } = *stroke;
                drawn.push(Drawn { from, to, half_widths, colour, through, rows: first..last + 1 });
            }
        };
        match &stroke.shape {
            StrokeShape::Dot(point) => {
                let place = camera.project(*point);
                push(place, place, [half; 2]);
            }
            StrokeShape::Line(points) => {
                for [from, to] in
                    points.windows(2).filter_map(|pair| line_before_eye(camera, pair[0], pair[1]))
                {
                    push(camera.project(from), camera.project(to), [half; 2]);
                }
            }
            StrokeShape::Arrow(given, to) => {
                let given = *given;
                let Some([from, seen_to]) = line_before_eye(camera, given, *to) else { continue };
                let (mut start, mut tip) = (camera.project(from), camera.project(seen_to));
                // where it starts behind the eye, what is seen of it begins before everything and says nothing
                if from == given && surfaces.shows(start, LIFT) {
                    // nearer than anything
                    (start.inverse_depth, tip.inverse_depth) = (f64::MAX, f64::MAX);
                }
                let length = (tip.x - start.x).hypot(tip.y - start.y);
                // the head is nine half widths long, but leaves a third of the shaft; one behind the eye is not seen
                let head = if seen_to == *to { (9.0 * half).min(0.66 * length) } else { 0.0 };
                let share = if length > 0.0 { 1.0 - head / length } else { 0.0 };
                let neck = Projected {
                    x: start.x + (tip.x - start.x) * share,
                    y: start.y + (tip.y - start.y) * share,
                    inverse_depth: start.inverse_depth * (1.0 - share) + tip.inverse_depth * share,
                };
                push(start, neck, [half; 2]);
                push(neck, tip, [0.4 * head, 0.0]);
            }
        }
    }
    drawn
}

pub(super) fn near_row(strokes: &[Drawn], row: usize) -> Vec<&Drawn> {
    strokes.iter().filter(|stroke| stroke.rows.contains(&row)).collect()
}

impl Drawn {
    /// The colour of a sample with the stroke over it; `inverse_depth` of what is seen there, zero for nothing.
    pub fn over(&self, below: Colour, place: [f64; 2], inverse_depth: f32) -> Colour {
        let Self { from, to, half_widths, .. } = self;
        let (distance, t) = distance_point_segment(place, [from.x, from.y], [to.x, to.y]);
        if distance > half_widths[0] + (half_widths[1] - half_widths[0]) * t {
            return below;
        }
        // not by the difference: of two that are nearer than anything it is nothing
        let own = from.inverse_depth * (1.0 - t) + to.inverse_depth * t;
        let hidden = own * (1.0 + LIFT) < f64::from(inverse_depth);
        below.mixed(self.colour, if hidden { self.through } else { 1.0 })
    }
}
