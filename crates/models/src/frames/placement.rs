//! Where frames stand: the table of placements.

use souple_math::{Mat3, Vec3};
use souple_mesh::BoundingBox;
use souple_table::{Entry, Parameter, Range, Table, Value, Values};

use super::cells::softest;
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
                let (count, kept) = counted(values, matter, 1)?;
                Ok(upright(farthest_points(matter.samples, count, kept)))
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
                let iterations = values.integer("iterations") as usize;
                let (count, kept) = counted(values, matter, 1 + iterations)?;
                let masses = if values.text("by") == "compliance" { compliances(matter)? } else { volumes(matter) };
                let still = kept.len();
                let mut origins = farthest_points(matter.samples, count, kept);
                for _ in 0..iterations {
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

/// Distances between frames and points that are compared at most, some ten seconds of work.
const MOST_DISTANCES: f64 = 1e10;
/// Places of a grid that are looked at at most.
const MOST_PLACES: usize = 1_000_000;

/// How many frames there shall be, and those among them that are kept where they are put; refused where there are not as many
/// points, and where `passes` over all of them are too long.
fn counted(values: &Values, matter: &Matter, passes: usize) -> Result<(usize, Vec<Vec3>), FrameError> {
    let (frames, points) = (values.integer("count") as usize, matter.samples.len());
    let kept = places(values.numbers("kept"), "kept")?;
    if kept.len() > frames {
        return Err(FrameError::TooManyKept { kept: kept.len(), count: frames });
    }
    if frames > points {
        return Err(FrameError::MoreThanPoints { frames, points });
    }
    let distances = frames as f64 * points as f64 * passes as f64;
    if distances > MOST_DISTANCES {
        return Err(FrameError::TooManyDistances { frames, points, passes, distances, most: MOST_DISTANCES });
    }
    Ok((frames, kept))
}

fn volumes(matter: &Matter) -> Vec<f64> {
    matter.samples.iter().map(|sample| sample.volume).collect()
}

/// Volumes over stiffness, next to the softest.
fn compliances(matter: &Matter) -> Result<Vec<f64>, FrameError> {
    let cells = matter.samples.iter().map(|sample| sample.cell as usize);
    let softest = softest(cells.zip(matter.stiffness.iter().copied()))?;
    let compliance = |(sample, stiffness): (&Sample, &f64)| sample.volume * softest / stiffness;
    Ok(matter.samples.iter().zip(matter.stiffness).map(compliance).collect())
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
    let places = counts.map(|count| count as usize);
    let all = places.iter().product();
    if all > MOST_PLACES {
        return Err(FrameError::TooManyPlaces { places: all, most: MOST_PLACES });
    }
    let bounds = matter.bounds;
    let (low, size, middle) = (bounds.low, bounds.size(), bounds.centre());
    let coordinate = |axis: usize, index: usize| {
        if places[axis] == 1 {
            middle[axis]
        } else {
            low[axis] + size[axis] * index as f64 / (counts[axis] - 1.0)
        }
    };
    let step = [0, 1, 2].map(|axis: usize| size[axis] / (counts[axis] - 1.0).max(1.0));
    // along an axis the places that a sample is within half a step of: one, or both where it is in the middle between two
    let beside = |sample: &Sample, axis: usize| {
        let x = sample.position[axis];
        let reach = 0.5 * step[axis] * (1.0 + 1e-9) + 1e-12 * bounds.diagonal();
        // the first of all where the box is flat: a quotient that is no number counts as zero
        let last = places[axis] - 1;
        let nearest = (((x - low[axis]) / step[axis]) as usize).min(last);
        let near = nearest.saturating_sub(1)..=(nearest + 2).min(last);
        near.filter(move |index| (x - coordinate(axis, *index)).abs() <= reach)
    };
    let mut holds = vec![false; all];
    for sample in matter.samples {
        for k in beside(sample, 2) {
            for j in beside(sample, 1) {
                for i in beside(sample, 0) {
                    holds[(k * places[1] + j) * places[0] + i] = true;
                }
            }
        }
    }
    let at = |place: usize| {
        let (i, j, k) = (place % places[0], place / places[0] % places[1], place / places[0] / places[1]);
        Vec3::new(coordinate(0, i), coordinate(1, j), coordinate(2, k))
    };
    Ok(upright((0..all).filter(|place| holds[*place]).map(at).collect()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A grid stands where a sample is within half a step along all axes, borders included, as a search through all samples
    /// finds; one place along an axis, and a box that is flat, are grids too.
    #[test]
    fn grids_stand_where_matter_is() {
        let place = |i: usize, k: usize| (0.3 * k as f64 + i as f64 * [0.618_034, 0.754_878][k]).fract();
        for (depth, counts) in [(0.4, [7.0, 5.0, 3.0]), (0.4, [1.0, 9.0, 2.0]), (0.0, [4.0, 4.0, 1.0])] {
            let bounds = BoundingBox::of([Vec3::ZERO, Vec3::new(2.0, 1.0, depth)]);
            // on a third of a step, in its middle, and anywhere in the lower half
            let regular = (0..13).map(|i| Vec3::new(f64::from(i) / 6.0, 0.5, 0.0));
            let anywhere = (0..20).map(|i| Vec3::new(2.0 * place(i, 0), 0.5 * place(i, 1), 0.5 * depth));
            let sample = |position: Vec3| Sample { position, volume: 1.0, cell: 0 };
            let samples: Vec<Sample> = regular.chain(anywhere).map(sample).collect();
            let found = grid(counts, &Matter { samples: &samples, stiffness: &[], bounds }).unwrap();
            let coordinates = |axis: usize| {
                let (count, size) = (counts[axis] as usize, bounds.size()[axis]);
                let at = move |i: usize| {
                    if count == 1 { 0.5 * size } else { size * i as f64 / (count - 1) as f64 }
                };
                (0..count).map(at)
            };
            let mut expected = Vec::new();
            for z in coordinates(2) {
                for y in coordinates(1) {
                    for x in coordinates(0) {
                        let at = Vec3::new(x, y, z);
                        let is_within = |sample: &Sample| {
                            (0..3).all(|axis: usize| {
                                let step = bounds.size()[axis] / (counts[axis] - 1.0).max(1.0);
                                (sample.position[axis] - at[axis]).abs() <= 0.5 * step * (1.0 + 1e-9) + 1e-12
                            })
                        };
                        if samples.iter().any(is_within) {
                            expected.push(at);
                        }
                    }
                }
            }
            assert!(expected.len() < counts.iter().product::<f64>() as usize || depth == 0.0);
            let origins: Vec<Vec3> = found.iter().map(|frame| frame.origin).collect();
            assert_eq!(origins, expected);
        }
    }
}
