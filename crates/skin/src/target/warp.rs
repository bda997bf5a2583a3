//! Warps: parts twisted, bent and tapered about an axis through a point.

use souple_math::Vec3;
use souple_mesh::BoundingBox;
use souple_table::{Entry, Parameter, Range, Table, Value, Values};

/// A map of space, given by its inverse: the potential is asked where a point was before.
pub trait Warp: Send + Sync {
    /// Where a point was before.
    fn undo(&self, point: Vec3) -> Vec3;

    /// A box around what a box becomes.
    fn bounds(&self, bounds: BoundingBox) -> BoundingBox;

    /// A box around where the points of a box were before.
    fn before(&self, of: BoundingBox) -> BoundingBox;
}

/// Constructor of a warp from completed values.
pub type BuildWarp = fn(&Values) -> Box<dyn Warp>;

/// All warps.
pub static WARPS: Table<BuildWarp> = Table { kind: "skin warp", entries: &[&TWIST, &BEND, &TAPER] };

const SOURCE: &str = "Barr 1984, Global and local deformations of solid primitives";

const AXIS: Parameter =
    Parameter::choice("axis", &["x", "y", "z"], "along which it changes").or(Value::Text("x"));
const CENTRE: Parameter =
    Parameter::vector("centre", "m", "where nothing changes").or(Value::Vector([0.0; 3]));

/// An axis and the two across it, right-handed, through a point.
#[derive(Clone, Copy)]
struct Frame {
    axis: usize,
    centre: Vec3,
}

impl Frame {
    fn of(values: &Values) -> Self {
        let axis = match values.text("axis") {
            "y" => 1,
            "z" => 2,
            _ => 0,
        };
        Self { axis, centre: Vec3::from_array(values.vector("centre")) }
    }

    /// Along the axis, and across it.
    fn split(&self, point: Vec3) -> (f64, [f64; 2]) {
        let p = point - self.centre;
        (p[self.axis], [p[(self.axis + 1) % 3], p[(self.axis + 2) % 3]])
    }

    fn join(&self, along: f64, across: [f64; 2]) -> Vec3 {
        let mut p = Vec3::ZERO;
        p[self.axis] = along;
        p[(self.axis + 1) % 3] = across[0];
        p[(self.axis + 2) % 3] = across[1];
        p + self.centre
    }

    /// The ranges of a box along the axis, and its middle and half its diagonal across it.
    fn split_box(&self, of: BoundingBox) -> ([f64; 2], [f64; 2], f64) {
        let ((from, low), (to, high)) = (self.split(of.low), self.split(of.high));
        let middle = [0, 1].map(|k| 0.5 * (low[k] + high[k]));
        ([from, to], middle, 0.5 * (high[0] - low[0]).hypot(high[1] - low[1]))
    }

    /// A box around places along the axis and a disc across it.
    fn join_box(&self, along: [f64; 2], middle: [f64; 2], radius: f64) -> BoundingBox {
        BoundingBox {
            low: self.join(along[0], middle.map(|c| c - radius)),
            high: self.join(along[1], middle.map(|c| c + radius)),
        }
    }

    /// A box around a ball about the centre that holds a box.
    fn ball(&self, bounds: BoundingBox, factor: f64) -> BoundingBox {
        let centre = self.centre;
        let far = (bounds.low - centre).to_array().into_iter().zip((bounds.high - centre).to_array());
        let radius = far.map(|(low, high)| low.abs().max(high.abs()).powi(2)).sum::<f64>().sqrt() * factor;
        BoundingBox { low: centre, high: centre }.grown(radius)
    }
}

fn turned([a, b]: [f64; 2], angle: f64) -> [f64; 2] {
    let (sin, cos) = libm::sincos(angle);
    [cos * a - sin * b, sin * a + cos * b]
}

struct Twist {
    frame: Frame,
    rate: f64,
}

impl Warp for Twist {
    fn undo(&self, point: Vec3) -> Vec3 {
        let (along, across) = self.frame.split(point);
        self.frame.join(along, turned(across, -self.rate * along))
    }

    fn bounds(&self, bounds: BoundingBox) -> BoundingBox {
        self.frame.ball(bounds, 1.0)
    }

    // turned by the angle of its middle, and along an arc by what angles differ from that
    fn before(&self, of: BoundingBox) -> BoundingBox {
        let (along, middle, radius) = self.frame.split_box(of);
        let differ = (0.5 * self.rate * (along[1] - along[0])).abs().min(2.0);
        let arc = middle[0].hypot(middle[1]) * differ;
        let turned = turned(middle, -0.5 * self.rate * (along[0] + along[1]));
        self.frame.join_box(along, turned, radius + arc)
    }
}

static TWIST: Entry<BuildWarp> = Entry {
    name: "twist",
    summary: "turns about the axis by an angle that grows along it",
    source: SOURCE,
    parameters: &[AXIS, CENTRE, Parameter::number("rate", "rad/m", Range::ANY, "angle for each metre")],
    build: |values| Box::new(Twist { frame: Frame::of(values), rate: values.number("rate") }),
};

struct Bend {
    frame: Frame,
    rate: f64,
}

impl Warp for Bend {
    // the axis becomes a circle of radius 1/rate about a centre on the first axis across
    fn undo(&self, point: Vec3) -> Vec3 {
        let (along, [a, b]) = self.frame.split(point);
        if self.rate == 0.0 {
            return point;
        }
        let radius = 1.0 / self.rate;
        let angle = libm::atan2(along * radius.signum(), (radius - a) * radius.signum());
        let distance = along.hypot(radius - a) * radius.signum();
        self.frame.join(angle * radius, [radius - distance, b])
    }

    // with c = 1 − cos(s/R) ≤ (s/R)²/2 a point at (s, a) comes to a² + 2 R (R − a) c ≤ a² + (1 + |a/R|) s²
    fn bounds(&self, bounds: BoundingBox) -> BoundingBox {
        let across = [bounds.low, bounds.high].map(|p| self.frame.split(p).1[0].abs());
        self.frame.ball(bounds, (1.0 + across[0].max(across[1]) * self.rate.abs()).sqrt())
    }

    // as seen from the centre of the circle: within a ball around its middle distances differ by its radius, and angles by what
    // a ball there is seen under
    fn before(&self, of: BoundingBox) -> BoundingBox {
        if self.rate == 0.0 {
            return of;
        }
        let (sign, turn) = (self.rate.signum(), std::f64::consts::PI);
        let radius = 1.0 / self.rate;
        let ((from, low), (to, high)) = (self.frame.split(of.low), self.frame.split(of.high));
        let seen = [0.5 * (from + to) * sign, (radius - 0.5 * (low[0] + high[0])) * sign];
        let (distance, reach) = (seen[0].hypot(seen[1]), 0.5 * (to - from).hypot(high[0] - low[0]));
        let angle = libm::atan2(seen[0], seen[1]);
        let width = if distance > reach { libm::asin(reach / distance) } else { turn };
        // beyond half a turn an angle goes on from the other side
        let is_cut = angle.abs() + width >= turn;
        let angles = if is_cut { [-turn, turn] } else { [angle - width, angle + width] };
        let ends = |a: f64, b: f64| [a.min(b), a.max(b)];
        let along = ends(angles[0] * radius, angles[1] * radius);
        let across = ends(radius - (distance - reach).max(0.0) * sign, radius - (distance + reach) * sign);
        BoundingBox {
            low: self.frame.join(along[0], [across[0], low[1]]),
            high: self.frame.join(along[1], [across[1], high[1]]),
        }
    }
}

static BEND: Entry<BuildWarp> = Entry {
    name: "bend",
    summary: "bends the axis to a circle, towards the next axis in the order x, y, z",
    source: SOURCE,
    parameters: &[
        AXIS,
        CENTRE,
        Parameter::number("rate", "rad/m", Range::ANY, "angle for each metre, 1/radius"),
    ],
    build: |values| Box::new(Bend { frame: Frame::of(values), rate: values.number("rate") }),
};

struct Taper {
    frame: Frame,
    rate: f64,
}

/// Scales stay above this: what would turn over becomes a thread.
const THINNEST: f64 = 0.05;
/// And below its inverse.
const THICKEST: f64 = 20.0;

impl Warp for Taper {
    fn undo(&self, point: Vec3) -> Vec3 {
        let (along, across) = self.frame.split(point);
        let scale = (1.0 + self.rate * along).clamp(THINNEST, THICKEST);
        self.frame.join(along, across.map(|c| c / scale))
    }

    fn bounds(&self, bounds: BoundingBox) -> BoundingBox {
        let [low, high] = [bounds.low, bounds.high].map(|p| self.frame.split(p));
        let scale = |along: f64| (1.0 + self.rate * along).clamp(THINNEST, THICKEST);
        let scales = [scale(low.0), scale(high.0)];
        // what is at an end goes by the scale there, and what is between by one between
        let spread = |c: f64| scales.map(|scale| c * scale);
        let least = low.1.map(|c| spread(c)[0].min(spread(c)[1]));
        let most = high.1.map(|c| spread(c)[0].max(spread(c)[1]));
        BoundingBox { low: self.frame.join(low.0, least), high: self.frame.join(high.0, most) }
    }

    fn before(&self, of: BoundingBox) -> BoundingBox {
        let [low, high] = [of.low, of.high].map(|p| self.frame.split(p));
        let scales = [low.0, high.0].map(|along| (1.0 + self.rate * along).clamp(THINNEST, THICKEST));
        let ends = |c: f64| scales.map(|scale| c / scale);
        let least = low.1.map(|c| ends(c)[0].min(ends(c)[1]));
        let most = high.1.map(|c| ends(c)[0].max(ends(c)[1]));
        BoundingBox { low: self.frame.join(low.0, least), high: self.frame.join(high.0, most) }
    }
}

static TAPER: Entry<BuildWarp> = Entry {
    name: "taper",
    summary: "scales across the axis by a factor that grows along it",
    source: SOURCE,
    parameters: &[
        AXIS,
        CENTRE,
        Parameter::number("rate", "1/m", Range::ANY, "growth of the factor for each metre"),
    ],
    build: |values| Box::new(Taper { frame: Frame::of(values), rate: values.number("rate") }),
};
