//! Where frames stand: the table of placements.

use souple_math::{Mat3, Vec3};
use souple_mesh::BoundingBox;
use souple_table::{Entry, Parameter, Range, Table, Value, Values};

use super::points::Sample;
use super::{Frame, FrameError};

/// What frames are placed in.
pub struct Matter<'a> {
    pub samples: &'a [Sample],
    /// Of each sample, as [`super::weights::Shape::stiffness_of_cell`].
    pub stiffness: &'a [f64],
    /// Of the shape.
    pub bounds: BoundingBox,
}

/// Places frames by completed values.
pub type BuildPlacement = fn(&Values, &Matter) -> Result<Vec<Frame>, FrameError>;

const COUNT: Parameter = Parameter::integer("count", Range::closed(1.0, 100_000.0), "frames");

const KEPT: Parameter = Parameter::numbers(
    "kept",
    "m",
    Range::ANY,
    "frames that stand where they are put, at the ends of bones or of what is held: x, y, z of one after the other; they come first, and count",
)
.or(Value::Numbers(&[]));

/// All placements.
pub static PLACEMENTS: Table<BuildPlacement> = Table {
    kind: "placement",
    entries: &[
        &Entry {
            name: "farthest_point",
            summary: "one after the other as far as can be from those before: ends and corners first",
            source: "Gonzalez 1985",
            parameters: &[COUNT, KEPT],
            build: |values, matter| {
                let kept = places(values.numbers("kept"), "kept")?;
                Ok(upright(farthest_points(matter.samples, count(values, matter)?, kept)))
            },
        },
        &Entry {
            name: "lloyd",
            summary: "each in the middle of what is nearest to it: even spread, away from the surface",
            source: "Lloyd 1982",
            parameters: &[
                COUNT,
                Parameter::integer("iterations", Range::closed(0.0, 1000.0), "moves to the middle")
                    .or(Value::Integer(30)),
                Parameter::choice(
                    "by",
                    &["volume", "compliance"],
                    "what the middle is of: matter, or matter over its stiffness, which puts more frames into soft parts",
                )
                .or(Value::Text("volume")),
                KEPT,
            ],
            build: |values, matter| {
                let kept = places(values.numbers("kept"), "kept")?;
                let still = kept.len();
                let mut origins = farthest_points(matter.samples, count(values, matter)?, kept);
                let by_compliance = values.text("by") == "compliance";
                let softest = matter.stiffness.iter().copied().fold(f64::INFINITY, f64::min);
                let masses: Vec<f64> = matter
                    .samples
                    .iter()
                    .zip(matter.stiffness)
                    .map(|(s, stiffness)| if by_compliance { s.volume * softest / stiffness } else { s.volume })
                    .collect();
                for _ in 0..values.integer("iterations") {
                    move_to_middles(matter.samples, &masses, &mut origins, still);
                }
                Ok(upright(origins))
            },
        },
        &Entry {
            name: "line",
            summary: "evenly along a line between two points, both ends included: ligaments",
            source: "own",
            parameters: &[
                COUNT,
                Parameter::vector("from", "m", "the first frame"),
                Parameter::vector("to", "m", "the last frame"),
            ],
            build: |values, _| {
                let [from, to] = ["from", "to"].map(|name| Vec3::from_array(values.vector(name)));
                let last = (values.integer("count") - 1).max(1) as f64;
                let at = |index: i64| from + (to - from) * (index as f64 / last);
                Ok(upright((0..values.integer("count")).map(at).collect()))
            },
        },
        &Entry {
            name: "grid",
            summary: "a regular grid over the box of the shape, its corners included; those that reach no matter are left out",
            source: "own",
            parameters: &[Parameter::vector("counts", "", "frames along x, y and z; 1 stands in the middle")],
            build: |values, matter| grid(values.vector("counts"), matter),
        },
        &Entry {
            name: "given",
            summary: "at places that are listed",
            source: "own",
            parameters: &[Parameter::numbers(
                "at",
                "m",
                Range::ANY,
                "x, y, z of one frame after the other, such as [0, 0, 0, 0.1, 0, 0] for two",
            )],
            build: |values, _| Ok(upright(places(values.numbers("at"), "at")?)),
        },
    ],
};

fn upright(origins: Vec<Vec3>) -> Vec<Frame> {
    origins.into_iter().map(|origin| Frame { origin, axes: Mat3::IDENTITY }).collect()
}

/// Places of which the coordinates are listed.
fn places(numbers: &[f64], key: &'static str) -> Result<Vec<Vec3>, FrameError> {
    if !numbers.len().is_multiple_of(3) {
        return Err(FrameError::NoTriples { key, count: numbers.len() });
    }
    Ok(numbers.chunks(3).map(|at| Vec3::new(at[0], at[1], at[2])).collect())
}

fn count(values: &Values, matter: &Matter) -> Result<usize, FrameError> {
    let (frames, points) = (values.integer("count") as usize, matter.samples.len());
    if frames > points { Err(FrameError::MoreThanPoints { frames, points }) } else { Ok(frames) }
}

/// Where none is `kept`, the first is the farthest from the middle; of several as far, the first in the list.
fn farthest_points(samples: &[Sample], count: usize, kept: Vec<Vec3>) -> Vec<Vec3> {
    let volume: f64 = samples.iter().map(|sample| sample.volume).sum();
    let middle = samples.iter().map(|sample| sample.position * sample.volume).sum::<Vec3>() / volume;
    let to_nearest = |sample: &Sample| {
        let distances = kept.iter().map(|origin| (sample.position - *origin).length_sq());
        distances.reduce(f64::min).unwrap_or_else(|| (sample.position - middle).length_sq())
    };
    let mut distances: Vec<f64> = samples.iter().map(to_nearest).collect();
    let mut origins = kept;
    while origins.len() < count {
        let mut farthest = 0;
        for (index, distance) in distances.iter().enumerate() {
            if *distance > distances[farthest] {
                farthest = index;
            }
        }
        let origin = samples[farthest].position;
        let is_first = origins.is_empty();
        for (sample, distance) in samples.iter().zip(&mut distances) {
            let here = (sample.position - origin).length_sq();
            *distance = if is_first { here } else { distance.min(here) };
        }
        origins.push(origin);
    }
    origins
}

/// Moves each origin, but the first ones that stand `still`, to the middle of the masses that are nearest to it.
fn move_to_middles(samples: &[Sample], masses: &[f64], origins: &mut [Vec3], still: usize) {
    let mut sums = vec![(0.0, Vec3::ZERO); origins.len()];
    for (sample, mass) in samples.iter().zip(masses) {
        let distance = |index: &usize| (origins[*index] - sample.position).length_sq();
        let nearest = (0..origins.len()).min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(0);
        sums[nearest].0 += mass;
        sums[nearest].1 += sample.position * *mass;
    }
    for (origin, (mass, moment)) in origins.iter_mut().zip(sums).skip(still) {
        if mass > 0.0 {
            *origin = moment / mass;
        }
    }
}

fn grid(counts: [f64; 3], matter: &Matter) -> Result<Vec<Frame>, FrameError> {
    if let Some(count) =
        counts.into_iter().find(|count| !(1.0..=1000.0).contains(count) || count.fract() != 0.0)
    {
        return Err(FrameError::NoGrid { count });
    }
    let bounds = matter.bounds;
    let (low, size, middle) = (bounds.low, bounds.size(), bounds.centre());
    let coordinate = |axis: usize, index: usize| {
        if counts[axis] == 1.0 {
            middle[axis]
        } else {
            low[axis] + size[axis] * index as f64 / (counts[axis] - 1.0)
        }
    };
    let step = Vec3::from_array([0, 1, 2].map(|axis: usize| size[axis] / (counts[axis] - 1.0).max(1.0)));
    let mut origins = Vec::new();
    for k in 0..counts[2] as usize {
        for j in 0..counts[1] as usize {
            for i in 0..counts[0] as usize {
                let at = Vec3::new(coordinate(0, i), coordinate(1, j), coordinate(2, k));
                let holds = |sample: &Sample| {
                    let apart = sample.position - at;
                    (0..3).all(|axis: usize| {
                        apart[axis].abs() <= 0.5 * step[axis] * (1.0 + 1e-9) + 1e-12 * bounds.diagonal()
                    })
                };
                if matter.samples.iter().any(holds) {
                    origins.push(at);
                }
            }
        }
    }
    Ok(upright(origins))
}
