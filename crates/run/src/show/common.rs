//! What all pictures of a show have in common, so that neither camera nor colours jump.

use std::borrow::Cow;
use std::sync::Arc;

use souple_io::picture::{ColourMap, ColourScale, Cut, Framed, MeshSurface};
use souple_math::Vec3;
use souple_mesh::BoundingBox;
use souple_table::four_digits;

use super::figure::{Arrows, Figure, Floor, Foot};
use super::{BLOOD, BodyMoment, Moment, Show, ShowError, Stage, vectors};
use crate::frames::PART;
use crate::links::{LINK_STATE, RADIUS};

/// Camera, colours and sizes.
#[derive(Clone, Debug)]
pub struct Common {
    pub(super) bounds: BoundingBox,
    /// What is farthest out in any direction, at any moment; none where the bounds must do.
    pub(super) framed: Vec<Framed>,
    /// About as much as a pixel shows [m].
    pub(super) pixel: f64,
    pub(super) range: Option<(f64, f64)>,
    /// Whether there are values below and above the range.
    pub(super) beyond: [bool; 2],
    /// Digits behind the point that tell moments apart [s].
    pub(super) time_digits: usize,
    /// Metres of arrow for each unit of the field; `None` where no arrow is longer than zero.
    pub(super) arrow_scale: Option<f64>,
    /// What is to be said of the pictures.
    pub notes: Vec<String>,
}

/// Values that differ by less than this part of the largest are one value: solvers stop some digits before rounding.
const ONE_VALUE: f64 = 1e-6;
/// Part of the lesser side of a picture that bodies fill.
const FILLED: f64 = 0.7;
/// Radii of tubes, as parts of the diagonal of the picture: thin, and as thick as they get.
const TUBES: [f64; 2] = [0.0012, 0.0035];
/// Radius of tubes, as a part of the mean length of edges, between those bounds.
const OF_EDGE: f64 = 0.12;

/// The range of colours for values from `low` to `high`: from zero where all are one value but for rounding, and to
/// `noise`, what rounding makes of zero, where there is nothing more; none but zero where that is all there is.
fn spread((low, high): (f64, f64), noise: f64) -> (f64, f64) {
    let most = low.abs().max(high.abs());
    if most == 0.0 {
        return (0.0, 0.0);
    }
    if most <= noise {
        return (if low < 0.0 { -noise } else { 0.0 }, noise);
    }
    if high - low > (ONE_VALUE * most).max(noise) { (low, high) } else { (low.min(0.0), high.max(0.0)) }
}

/// What to say of a range that has none of the values.
fn all_beyond((least, most): (f64, f64), (low, high): (f64, f64), unit: &str) -> Option<String> {
    let side = if least > high {
        "above"
    } else if most < low {
        "below"
    } else {
        return None;
    };
    let [least, most, low, high] = [least, most, low, high].map(four_digits);
    let range = format!("{low} to {high} {unit}");
    Some(format!("all values, {least} to {most} {unit}, are {side} the range {}", range.trim_end()))
}

/// What to say of a diverging map whose colours are not those of values about zero.
fn about_zero(range: Option<(f64, f64)>, found: Option<(f64, f64)>) -> Option<String> {
    match (range, found?) {
        (Some((low, high)), _) if (low + high).abs() > ONE_VALUE * (high - low) => Some(format!(
            "the middle colour of the diverging map stands for {}, the middle of the range, and not for zero",
            four_digits(0.5 * (low + high))
        )),
        (None, (low, high)) if low > 0.0 || high < 0.0 => Some(format!(
            "the values, {} to {}, are on one side of zero, which has the middle colour of the diverging map: half of its colours are not met",
            four_digits(low),
            four_digits(high)
        )),
        _ => None,
    }
}

/// Digits behind the point that tell times [s] apart: three, or more where they are closer than that.
fn time_digits(times: &[f64]) -> usize {
    let apart = times.windows(2).map(|pair| (pair[1] - pair[0]).abs());
    let apart = if times.len() > 1 { apart.fold(f64::INFINITY, f64::min) } else { times.iter().sum() };
    let digits = if apart > 0.0 && apart.is_finite() { 1.0 - libm::floor(libm::log10(apart)) } else { 0.0 };
    digits.clamp(3.0, 9.0) as usize
}

/// Least and greatest of finite values.
fn extremes(values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    values.filter(|value| value.is_finite()).fold(None, |range: Option<(f64, f64)>, value| match range {
        None => Some((value, value)),
        Some((low, high)) => Some((low.min(value), high.max(value))),
    })
}

/// Directions in which points are farthest out: what lies between two of them is at most `1 - cos 14°`, three hundredths
/// of the size, farther, which the margin of pictures has room for.
const DIRECTIONS: usize = 128;

/// The points and balls that are farthest out in each of many directions: a camera that has them in its picture has all.
struct Outermost(Vec<Farthest>);

/// What is farthest out in a direction.
struct Farthest {
    direction: Vec3,
    /// [m]; infinitely far back before there is anything.
    along: f64,
    ball: Framed,
}

impl Default for Outermost {
    /// Directions on a spiral, as far from each other as so many can be.
    fn default() -> Self {
        let golden = std::f64::consts::PI * (3.0 - 5f64.sqrt());
        let nothing_yet = |index: usize| {
            let z = 1.0 - (2 * index + 1) as f64 / DIRECTIONS as f64;
            let (sin, cos) = libm::sincos(golden * index as f64);
            let across = (1.0 - z * z).sqrt();
            let direction = Vec3::new(across * cos, across * sin, z);
            Farthest { direction, along: f64::NEG_INFINITY, ball: Framed::default() }
        };
        Self((0..DIRECTIONS).map(nothing_yet).collect())
    }
}

impl Outermost {
    fn add(&mut self, balls: impl IntoIterator<Item = impl Into<Framed>>) {
        let balls = balls.into_iter().map(Into::into);
        for ball in balls.filter(|ball: &Framed| ball.centre.is_finite() && ball.radius.is_finite()) {
            for farthest in &mut self.0 {
                let along = farthest.direction.dot(ball.centre) + ball.radius;
                if along > farthest.along {
                    (farthest.along, farthest.ball) = (along, ball);
                }
            }
        }
    }

    fn balls(self) -> Vec<Framed> {
        let met = self.0.into_iter().filter(|farthest| farthest.along.is_finite());
        let mut balls: Vec<Framed> = met.map(|farthest| farthest.ball).collect();
        balls.dedup();
        balls
    }
}

/// What all pictures have in common, gathered from one moment after the other.
pub struct Gathering<'a> {
    figure: &'a Figure,
    stage: &'a Stage,
    times: Vec<f64>,
    bounds: BoundingBox,
    framed: Outermost,
    /// Least and greatest of the values that have a place on the scale.
    found: Option<(f64, f64)>,
    noise: f64,
    /// Values that have no colour, of how many.
    colourless: [usize; 2],
    longest_arrow: f64,
    arrows: Vec<Foot>,
}

impl<'a> Gathering<'a> {
    pub fn new(figure: &'a Figure, stage: &'a Stage) -> Self {
        Self {
            figure,
            stage,
            times: Vec::new(),
            bounds: BoundingBox::EMPTY,
            framed: Outermost::default(),
            found: None,
            noise: 0.0,
            colourless: [0; 2],
            longest_arrow: 0.0,
            arrows: Vec::new(),
        }
    }

    /// # Errors
    /// A field that no body of the first moment has.
    pub fn add(&mut self, moment: &Moment) -> Result<(), ShowError> {
        let figure = self.figure;
        let is_first = self.times.is_empty();
        self.times.push(moment.time);
        let quantity = figure.quantity();
        if let (Some(quantity), true) = (&quantity, is_first) {
            quantity.check(moment)?;
        }
        if let (Some(arrows), true) = (&figure.arrows, is_first) {
            refuse_unknown_vectors(moment, &arrows.field)?;
        }
        for body in moment.bodies.iter().filter(|body| body.is_drawable()) {
            let grounds = body.grounds();
            let is_ground = |point: usize| grounds.get(point) == Some(&true);
            for (point, ball) in body.balls().enumerate().filter(|(point, _)| !is_ground(*point)) {
                self.bounds = self.bounds.union(BoundingBox::of([ball.centre]).grown(ball.radius));
                // what is cut away is not made room for
                if figure.is_left(body.positions[point]) {
                    self.framed.add([ball]);
                }
            }
            if let Some(quantity) = quantity.as_ref().filter(|_| !figure.hides(moment, body)) {
                self.noise = self.noise.max(quantity.noise(body, self.stage.stiffness));
                let values = quantity.at_points(body).unwrap_or_default();
                let spanning = values.iter().copied().filter(|value| figure.scale.spans(*value));
                let both = extremes(spanning).into_iter().chain(self.found);
                self.found = both.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)));
                let finite = values.iter().filter(|value| value.is_finite());
                self.colourless[0] += finite.clone().filter(|value| !figure.scale.has(**value)).count();
                self.colourless[1] += finite.count();
            }
            let feet = figure.feet_of(body);
            self.longest_arrow = feet.iter().map(|foot| foot.length()).fold(self.longest_arrow, f64::max);
            self.arrows.extend(feet);
        }
        Ok(())
    }

    /// # Errors
    /// No value has a colour on a scale of powers of ten.
    pub fn finish(mut self) -> Result<Common, ShowError> {
        let figure = self.figure;
        let [_, values] = self.colourless;
        if figure.scale == ColourScale::Logarithmic
            && values > 0
            && self.found.is_none()
            && figure.range.is_none()
        {
            return Err(ShowError::Request {
                what: "colour scale",
                value: "log, and no value is above 0".to_owned(),
                expected: "linear, or a quantity with values above 0".to_owned(),
            });
        }
        let (bounds, framed, arrow_scale) = self.frame();
        let range = self.range();
        let beyond = match (self.found, range) {
            (Some(found), Some(range)) => {
                let rounding = ONE_VALUE * (range.1 - range.0);
                [found.0 < range.0 - rounding, found.1 > range.1 + rounding]
            }
            _ => [false; 2],
        };
        let pixels = FILLED * figure.size[0].min(figure.size[1]).max(1) as f64;
        Ok(Common {
            framed,
            bounds,
            pixel: bounds.diagonal() / pixels,
            range,
            beyond,
            time_digits: time_digits(&self.times),
            arrow_scale,
            notes: self.notes(range, arrow_scale),
        })
    }

    /// What all pictures have room for, what is farthest out in it, and the scale of the arrows.
    fn frame(&mut self) -> (BoundingBox, Vec<Framed>, Option<f64>) {
        let (figure, mut bounds) = (self.figure, self.bounds);
        let mut framed = std::mem::take(&mut self.framed);
        for time in &self.times {
            let shapes = self.stage.points_near(*time, bounds);
            framed.add(shapes.iter().copied());
            if !shapes.is_empty() {
                bounds = bounds.union(BoundingBox::of(shapes));
            }
        }
        let fitted = bounds.diagonal() / (6.0 * self.longest_arrow);
        let arrows = figure.arrows.as_ref().filter(|_| self.longest_arrow > 0.0);
        let arrow_scale = arrows.map(|arrows| arrows.scale.unwrap_or(fitted));
        let tips = || arrow_scale.iter().flat_map(|scale| self.arrows.iter().map(|foot| foot.tip(*scale)));
        framed.add(tips());
        let mut framed = framed.balls();
        // exploded bodies are larger about their middles; those of all bodies together are near enough
        if figure.explode > 0.0 {
            if figure.cut.is_some() && !framed.is_empty() {
                let boxes = framed.iter().map(|ball| BoundingBox::of([ball.centre]).grown(ball.radius));
                bounds = boxes.fold(BoundingBox::EMPTY, BoundingBox::union);
            }
            bounds = bounds.grown(0.5 * figure.explode * bounds.diagonal() / 3f64.sqrt());
            bounds = bounds.union(BoundingBox::of(tips().filter(|tip| tip.is_finite())));
            framed.clear();
        }
        (bounds, framed, arrow_scale)
    }

    /// Values of the first and the last colour.
    fn range(&self) -> Option<(f64, f64)> {
        let figure = self.figure;
        if figure.range.is_some() || figure.quantity().is_none() {
            return figure.range;
        }
        let of_values = |(low, high): (f64, f64)| match figure.scale {
            ColourScale::Linear => figure.colours.spread(spread((low, high), self.noise)),
            // what rounding makes of zero is no power of ten worth a colour of its own
            ColourScale::Logarithmic => figure.scale.spread((low.max(self.noise).min(high), high)),
        };
        figure.colours.own_range().or(self.found.map(of_values))
    }

    /// What is to be said of the pictures.
    fn notes(&self, range: Option<(f64, f64)>, arrow_scale: Option<f64>) -> Vec<String> {
        let figure = self.figure;
        let mut notes = Vec::new();
        if let (Some(Arrows { field, .. }), None) = (&figure.arrows, arrow_scale) {
            notes.push(format!("there is no arrow: all values of `{field}` that are seen are zero"));
        }
        let [colourless, values] = self.colourless;
        if colourless > 0 {
            notes.push(format!(
                "{colourless} of {values} values are below 0 and have no place on a scale of powers of ten: they are grey"
            ));
        }
        if let (ColourScale::Logarithmic, Some((least, _)), Some((low, _))) =
            (figure.scale, self.found, range)
            && least < low
        {
            notes.push(format!("values go down to {least:.1e}: those below {low:.1e} have the first colour"));
        }
        let unit = figure.quantity().map_or("", |quantity| quantity.unit());
        notes.extend(self.found.zip(figure.range).and_then(|(found, range)| all_beyond(found, range, unit)));
        if figure.colours == ColourMap::Diverging {
            notes.extend(about_zero(figure.range, self.found));
        }
        let has_ground = self.times.first().is_some_and(|time| self.stage.ground(*time).is_some());
        if figure.floor == Floor::Below && has_ground {
            notes.push("the scene has a ground of its own: no floor is drawn below the bodies".to_owned());
        }
        notes
    }
}

impl Common {
    pub(super) fn of(figure: &Figure, show: &Show, moments: &[&Moment]) -> Result<Self, ShowError> {
        let mut gathering = Gathering::new(figure, &show.stage);
        moments.iter().try_for_each(|moment| gathering.add(moment))?;
        gathering.finish()
    }
}

impl BodyMoment {
    /// Whether its cells are edges, which have no surface.
    pub(super) fn is_of_edges(&self) -> bool {
        self.mesh.dimension() == 1
    }

    /// Whether it is a skin, whose triangles mean nothing by themselves: they come and go with the nodes of its grid.
    pub(super) fn is_skin(&self) -> bool {
        self.point_fields.iter().any(|field| field.name == crate::frames::NORMAL)
    }

    /// Its edges, thick enough to be seen and thin enough to be told apart where pixels allow it; those of links in one
    /// state, or all that hold their ends together.
    pub(super) fn tubes(&self, common: &Common, cut: Option<Cut>, state: Option<f64>) -> MeshSurface {
        let whole = common.bounds.diagonal();
        let cells = self.mesh.cell_count().max(1) as f64;
        let length: f64 = self
            .mesh
            .cells()
            .map(|cell| {
                let [from, to] = [0, 1].map(|end: usize| self.mesh.points[cell.nodes[end] as usize]);
                (to - from).length()
            })
            .sum();
        let [thin, thick] = TUBES.map(|part| part * whole);
        let radius = (OF_EDGE * length / cells).clamp(thin, thick).max(common.pixel);
        let states = self.link_states();
        let is_drawn = |cell: usize| {
            let own = states.map_or(0.0, |states| states[cell]);
            state.map_or(own >= 0.0, |state| own == state)
        };
        let of_cell = |cell: usize| if is_drawn(cell) { radius } else { 0.0 };
        MeshSurface::tubes(&self.mesh, &self.positions, of_cell, cut)
    }

    /// Whether its cells join the same points as those of another moment.
    pub(super) fn has_mesh_of(&self, other: &Self) -> bool {
        let (a, b) = (&self.mesh, &other.mesh);
        Arc::ptr_eq(a, b)
            || (a.points.len() == b.points.len() && a.blocks == b.blocks && a.facet_blocks == b.facet_blocks)
    }

    /// Of each link, see [`LINK_STATE`]; `None` of a body that is no network.
    pub(super) fn link_states(&self) -> Option<&[f64]> {
        let field = self.cell_fields.iter().find(|field| field.name == LINK_STATE)?;
        (field.values.len() == self.mesh.cell_count()).then_some(field.values.as_slice())
    }

    /// Of the faces of bodies in a network the number of its body; `None` of what is no such thing.
    pub(super) fn parts(&self) -> Option<&[f64]> {
        let field = self.cell_fields.iter().find(|field| field.name == PART)?;
        (field.values.len() == self.mesh.cell_count()).then_some(field.values.as_slice())
    }

    /// The faces of each body in a network, in the order of their numbers.
    pub(super) fn split_by_part(&self) -> Vec<Self> {
        let parts = self.parts().unwrap_or_default();
        let last = parts.iter().copied().fold(-1.0, f64::max);
        let part = |number: i64| self.clone().of_cells(|cell| parts[cell] == number as f64);
        (0..=last as i64).map(part).collect()
    }

    /// Its points, each with its radius where it is a ball.
    fn balls(&self) -> impl Iterator<Item = Framed> + '_ {
        let radius = |point: usize| self.radii().map_or(0.0, |radii| radii[point].max(0.0));
        self.positions.iter().enumerate().map(move |(point, x)| Framed { centre: *x, radius: radius(point) })
    }

    /// Of each point of a network whether it stands for ground or a wall, which nothing makes room for and which throws no shade.
    pub(super) fn grounds(&self) -> Vec<bool> {
        souple_scene::grounds(&self.mesh, self.radii().unwrap_or_default())
    }

    /// Where its points rest [m]; as its mesh has them, of what tells no displacement.
    pub(super) fn rest(&self) -> Cow<'_, [Vec3]> {
        match vectors(self, crate::frames::DISPLACEMENT) {
            Some(moved) => self.positions.iter().zip(moved).map(|(x, moved)| *x - moved).collect(),
            None => Cow::Borrowed(&self.mesh.points),
        }
    }

    /// How thick blood lies on each point [m]; `None` where nothing bleeds.
    pub(super) fn film(&self) -> Option<&[f64]> {
        let field = self.point_fields.iter().find(|field| field.name == BLOOD)?;
        (field.values.len() == self.positions.len()).then_some(field.values.as_slice())
    }

    /// Of each point that is a ball [m]; `None` where none is.
    pub(super) fn radii(&self) -> Option<&[f64]> {
        let field = self.point_fields.iter().find(|field| field.name == RADIUS)?;
        (field.values.len() == self.positions.len()).then_some(field.values.as_slice())
    }
}

/// Refuses a vector field that no body has.
fn refuse_unknown_vectors(moment: &Moment, name: &str) -> Result<(), ShowError> {
    if moment.bodies.iter().any(|body| vectors(body, name).is_some()) {
        return Ok(());
    }
    let fields =
        moment.bodies.iter().flat_map(|body| &body.point_fields).filter(|field| field.components == 3);
    let mut known: Vec<&str> = fields.map(|field| field.name.as_str()).collect();
    known.sort_unstable();
    known.dedup();
    let expected = if known.is_empty() {
        "a body with vectors on its points, as those of a run's frames are".to_owned()
    } else {
        format!("a vector of each point: {}", known.join(", "))
    };
    Err(ShowError::UnknownField { name: name.to_owned(), expected })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of a ball whose points are up to 1.5° apart from any direction, every point is within `14° + 1.5°` of one that is
    /// kept; of a box all corners are kept.
    #[test]
    fn the_outermost_points_are_kept() {
        let ball = |i: usize| {
            let (z, turn) = (1.0 - (2 * i + 1) as f64 / 5000.0, 2.4 * i as f64);
            Vec3::new((1.0 - z * z).sqrt() * turn.cos(), (1.0 - z * z).sqrt() * turn.sin(), z)
        };
        let points: Vec<Vec3> = (0..5000).map(ball).collect();
        let mut outermost = Outermost::default();
        outermost.add(points.iter().copied());
        let kept = outermost.balls();
        for direction in &points {
            let farthest = kept.iter().map(|ball| ball.centre.dot(*direction)).fold(0.0, f64::max);
            assert!(farthest > 15.5_f64.to_radians().cos(), "{farthest} along {direction:?}");
        }
        let corners: Vec<Vec3> = (0..8)
            .map(|i| Vec3::new((i & 1) as f64, (i >> 1 & 1) as f64 * 0.3, (i >> 2) as f64 * 2.0))
            .collect();
        let mut outermost = Outermost::default();
        outermost.add([&corners[..], &[Vec3::new(0.5, 0.1, 1.0)]].concat());
        let kept = outermost.balls();
        assert!(corners.iter().all(|corner| kept.contains(&Framed::from(*corner))), "{kept:?}");
        // a ball within others is kept where it reaches out of them
        let mut outermost = Outermost::default();
        outermost.add(corners);
        outermost.add([Framed { centre: Vec3::new(0.5, 0.1, 1.0), radius: 1.5 }]);
        assert!(outermost.balls().iter().any(|ball| ball.radius == 1.5));
    }

    /// The middle of a diverging map is zero, or it is said what it is.
    #[test]
    fn diverging_maps_are_about_zero() {
        let said = |range, found| about_zero(range, Some(found)).unwrap_or_default();
        assert_eq!(said(None, (-1.0, 3.0)) + &said(Some((-2.0, 2.0)), (1.0, 3.0)), "");
        assert!(said(None, (1.0, 3.0)).contains("the values, 1 to 3, are on one side of zero"));
        assert!(said(Some((-0.1, 0.02)), (-1.0, 3.0)).contains("stands for -0.04, the middle of the range"));
    }

    /// A range that has none of the values is told with its unit, in which it may have been mistaken.
    #[test]
    fn ranges_without_values_are_told() {
        let said = |found, range| all_beyond(found, range, "Pa").unwrap_or_default();
        assert_eq!(said((2e3, 5e3), (0.0, 1e4)) + &said((2e3, 5e3), (0.0, 3e3)), "");
        assert!(said((2e3, 5e3), (0.0, 1.0)).ends_with("5000 Pa, are above the range 0 to 1 Pa"));
        assert!(said((0.0, 0.5), (1.0, 2.0)).contains("are below the range"));
    }

    /// Times of a picture, and of several, differ where they are written.
    #[test]
    fn moments_are_told_apart() {
        for (times, digits) in [
            (&[0.0][..], 3),
            (&[2.5], 3),
            (&[0.00042], 5),
            (&[0.0, 0.25, 0.5], 3),
            (&[0.0, 0.000125, 0.00025], 5),
            (&[1.0, 1.0], 3),
        ] {
            assert_eq!(time_digits(times), digits, "{times:?}");
        }
    }

    /// Values are spread over the colours; one value has its colour between zero and itself; what rounding makes of
    /// zero is near zero.
    #[test]
    fn rounding_has_no_colours() {
        assert_eq!(spread((2.0, 3.0), 1e-9), (2.0, 3.0));
        assert_eq!(spread((3.0, 3.0 + 1e-9), 1e-12), (0.0, 3.0 + 1e-9));
        assert_eq!(spread((1e-12, 8e-12), 1e-9), (0.0, 1e-9));
        assert_eq!(spread((-1e-12, 8e-12), 1e-9), (-1e-9, 1e-9));
        assert_eq!([spread((0.0, 0.0), 0.0), spread((0.0, 0.0), 1e-9)], [(0.0, 0.0); 2]);
    }
}
