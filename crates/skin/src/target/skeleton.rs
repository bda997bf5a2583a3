//! Skeletons: potentials that fall off with the distance to a point, a segment, a polyline, a triangle.

use souple_math::Vec3;
use souple_mesh::{BoundingBox, closest_point_on_triangle};
use souple_table::{Entry, Parameter, Range, Value, Values};

use super::{Between, PartEntry, PartError, PartScratch, Potential};

/// How a potential falls with `u`, the distance over the radius: 1 on the skeleton, one half at `u = 1`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Falloff {
    Compact,
    Gaussian,
    Inverse,
    Linear,
}

const FALLOFFS: &[&str] = &["compact", "gaussian", "inverse", "linear"];

impl Falloff {
    fn named(name: &str) -> Self {
        match name {
            "gaussian" => Self::Gaussian,
            "inverse" => Self::Inverse,
            "linear" => Self::Linear,
            _ => Self::Compact,
        }
    }

    fn at(self, u_sq: f64) -> f64 {
        match self {
            Self::Compact => (1.0 - COMPACT * u_sq).max(0.0).powi(3),
            Self::Gaussian => libm::exp2(-u_sq),
            Self::Inverse => 1.0 / (1.0 + u_sq),
            Self::Linear => (1.0 - 0.5 * u_sq.sqrt()).max(0.0),
        }
    }

    /// `u` beyond which it is nowhere above `level`.
    fn reach(self, level: f64) -> f64 {
        match self {
            _ if level >= 1.0 => 0.0,
            Self::Compact => ((1.0 - libm::cbrt(level)) / COMPACT).sqrt(),
            Self::Gaussian => (-libm::log2(level)).sqrt(),
            Self::Inverse => (1.0 / level - 1.0).sqrt(),
            Self::Linear => 2.0 * (1.0 - level),
        }
    }
}

/// `c = 1 − 2^(−1/3)` of `(1 − c u²)³`, which is zero from u = 2.2 on.
const COMPACT: f64 = 0.206_299_474_015_900_26;

enum Piece {
    Point(Vec3),
    /// A segment has its second corner twice.
    Triangle([Vec3; 3]),
}

struct Skeleton {
    /// A polyline is several segments.
    pieces: Vec<Piece>,
    radius: f64,
    falloff: Falloff,
}

impl Skeleton {
    fn distance_sq(&self, point: Vec3) -> f64 {
        let to_piece = |piece: &Piece| match piece {
            Piece::Point(at) => (*at - point).length_sq(),
            Piece::Triangle(corners) => {
                let ([a, b, c], _) = closest_point_on_triangle(point, *corners);
                (corners[0] * a + corners[1] * b + corners[2] * c - point).length_sq()
            }
        };
        self.pieces.iter().map(to_piece).fold(f64::INFINITY, f64::min)
    }
}

impl Potential for Skeleton {
    fn value(&self, point: Vec3, _: &PartScratch) -> f64 {
        self.falloff.at(self.distance_sq(point) / (self.radius * self.radius))
    }

    // it falls with the distance, which changes by no more than a point moves
    fn range(&self, within: BoundingBox, _: &PartScratch) -> Between {
        let (distance, reach) = (self.distance_sq(within.centre()).sqrt(), 0.5 * within.diagonal());
        let at = |distance: f64| self.falloff.at((distance / self.radius).powi(2));
        [at(distance + reach), at((distance - reach).max(0.0))]
    }

    fn bounds(&self, level: f64, _: &PartScratch) -> Option<BoundingBox> {
        let corners = self.pieces.iter().flat_map(|piece| match piece {
            Piece::Point(at) => [*at; 3],
            Piece::Triangle(corners) => *corners,
        });
        (level > 0.0).then(|| BoundingBox::of(corners).grown(self.falloff.reach(level) * self.radius))
    }
}

const RADIUS: Parameter =
    Parameter::number("radius", "m", Range::POSITIVE, "distance at which the potential is one half");
const FALLOFF: Parameter = Parameter::choice(
    "falloff",
    FALLOFFS,
    "how the potential falls: compact (1 - c u^2)^3, gaussian 2^(-u^2), inverse 1/(1 + u^2), linear 1 - u/2",
)
.or(Value::Text("compact"));

fn build(values: &Values, pieces: Vec<[Vec3; 3]>) -> Box<dyn Potential> {
    let falloff = Falloff::named(values.text("falloff"));
    let pieces = pieces.into_iter().map(|corners| match corners {
        [a, b, c] if a == b && a == c => Piece::Point(a),
        corners => Piece::Triangle(corners),
    });
    let pieces = pieces.collect();
    Box::new(Skeleton { pieces, radius: values.number("radius"), falloff })
}

fn corner(values: &Values, name: &str) -> Vec3 {
    Vec3::from_array(values.vector(name))
}

const SOURCE: &str = "Bloomenthal & Shoemake 1991, Convolution surfaces; Wyvill et al. 1986";

pub(super) static POINT: PartEntry = Entry {
    name: "point",
    summary: "falls off around a point",
    source: SOURCE,
    parameters: &[Parameter::vector("at", "m", "the point"), RADIUS, FALLOFF],
    build: |values, _| Ok(build(values, vec![[corner(values, "at"); 3]])),
};

pub(super) static SEGMENT: PartEntry = Entry {
    name: "segment",
    summary: "falls off around a segment",
    source: SOURCE,
    parameters: &[
        Parameter::vector("from", "m", "one end"),
        Parameter::vector("to", "m", "the other end"),
        RADIUS,
        FALLOFF,
    ],
    build: |values, _| {
        let (from, to) = (corner(values, "from"), corner(values, "to"));
        Ok(build(values, vec![[from, to, to]]))
    },
};

pub(super) static POLYLINE: PartEntry = Entry {
    name: "polyline",
    summary: "falls off around segments from point to point",
    source: SOURCE,
    parameters: &[
        Parameter::numbers("points", "m", Range::ANY, "coordinates x, y, z of two points or more in a row"),
        RADIUS,
        FALLOFF,
    ],
    build: |values, _| {
        let numbers = values.numbers("points");
        if numbers.len() < 6 || !numbers.len().is_multiple_of(3) {
            return Err(PartError {
                parameter: "points",
                value: format!("{} numbers", numbers.len()),
                expected: "three for each of two points or more".to_owned(),
            });
        }
        let points: Vec<Vec3> = numbers.chunks_exact(3).map(|p| Vec3::new(p[0], p[1], p[2])).collect();
        Ok(build(values, points.windows(2).map(|ends| [ends[0], ends[1], ends[1]]).collect()))
    },
};

pub(super) static TRIANGLE: PartEntry = Entry {
    name: "triangle",
    summary: "falls off around a triangle",
    source: SOURCE,
    parameters: &[
        Parameter::vector("a", "m", "first corner"),
        Parameter::vector("b", "m", "second corner"),
        Parameter::vector("c", "m", "third corner"),
        RADIUS,
        FALLOFF,
    ],
    build: |values, _| Ok(build(values, vec![["a", "b", "c"].map(|name| corner(values, name))])),
};
