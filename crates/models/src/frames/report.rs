//! How well the frames of a body serve: how many have a say at a point, how well each can be told from what it carries, and
//! what moving least squares over the same places would have to invert.

use souple_math::Vec3;

use super::mass::Moments;
use super::{Carried, Frame, Sample};

/// The frames of a body in numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FramesReport {
    pub frames: usize,
    /// Integration points.
    pub points: usize,
    /// Frames that reach a point, in the mean.
    pub reaching: f64,
    /// Frames that have a say at a point, in the mean: `1/Σ w²`, which is `n` where `n` share alike.
    pub effective: f64,
    /// The least of that at any point.
    pub least_effective: f64,
    /// The greatest ratio of the largest to the smallest moment of the matter that a frame carries, against the motions that
    /// it is free to make: of inertia against turns, of second moments where it stretches too.
    pub inertia_condition: f64,
    /// The least condition, over all points, of the moment matrix `Σ_i w_i p pᵀ`, `p = (1, (X_i - P)/d)`, that moving least
    /// squares would invert, `d` the mean distance of what reaches the point; above 1e15 it is singular to rounding.
    pub moment_condition: f64,
}

impl FramesReport {
    pub fn new(frames: &[Frame], samples: &[Sample], carried: &[Carried], is_affine: bool) -> Self {
        let count = carried.len().max(1) as f64;
        let effective = |point: &Carried| 1.0 / point.rows.iter().map(|rows| rows[0].0.powi(2)).sum::<f64>();
        let conditions =
            samples.iter().zip(carried).map(|(sample, point)| moment_condition(frames, sample, point));
        Self {
            frames: frames.len(),
            points: samples.len(),
            reaching: carried.iter().map(|point| point.frames.len() as f64).sum::<f64>() / count,
            effective: carried.iter().map(effective).sum::<f64>() / count,
            least_effective: carried.iter().map(effective).fold(f64::INFINITY, f64::min),
            inertia_condition: inertia_condition(frames, samples, carried, is_affine),
            moment_condition: conditions.fold(f64::INFINITY, f64::min),
        }
    }
}

fn inertia_condition(frames: &[Frame], samples: &[Sample], carried: &[Carried], is_affine: bool) -> f64 {
    let of_frame = |moments: Moments| {
        let [least, middle, most] = moments.principal();
        // about the axis along which it is longest a body turns most easily
        if is_affine { ratio(most, least) } else { ratio(middle + most, least + middle) }
    };
    Moments::of_frames(frames, samples, carried).into_iter().map(of_frame).fold(1.0, f64::max)
}

/// A condition, with what is below rounding taken for rounding.
fn ratio(most: f64, least: f64) -> f64 {
    most / least.max(f64::EPSILON * most)
}

fn moment_condition(frames: &[Frame], sample: &Sample, point: &Carried) -> f64 {
    let arms = || point.frames.iter().map(|frame| frames[*frame as usize].origin - sample.position);
    let distance = arms().map(Vec3::length).sum::<f64>() / point.frames.len().max(1) as f64;
    let mut moments = [[0.0; 4]; 4];
    for (arm, rows) in arms().zip(&point.rows) {
        let arm = arm * (1.0 / distance.max(f64::MIN_POSITIVE));
        let p = [1.0, arm.x, arm.y, arm.z];
        for (line, a) in moments.iter_mut().zip(p) {
            line.iter_mut().zip(p).for_each(|(entry, b)| *entry += rows[0].0 * a * b);
        }
    }
    let values = eigenvalues(moments);
    let most = values.iter().copied().fold(0.0, f64::max);
    ratio(most, values.iter().copied().fold(f64::INFINITY, f64::min))
}

/// Eigenvalues of a symmetric matrix by cyclic Jacobi: quadratic convergence, five sweeps do.
fn eigenvalues(matrix: [[f64; 4]; 4]) -> [f64; 4] {
    let mut a = matrix;
    for _ in 0..12 {
        for p in 0..4 {
            for q in p + 1..4 {
                if a[p][q] == 0.0 {
                    continue;
                }
                let theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
                let sign = if theta < 0.0 { -1.0 } else { 1.0 };
                let t = sign / (theta.abs() + (theta * theta + 1.0).sqrt());
                let c = 1.0 / (t * t + 1.0).sqrt();
                let s = t * c;
                for k in 0..4 {
                    let (x, y) = (a[k][p], a[k][q]);
                    (a[k][p], a[k][q]) = (c * x - s * y, s * x + c * y);
                }
                for k in 0..4 {
                    let (x, y) = (a[p][k], a[q][k]);
                    (a[p][k], a[q][k]) = (c * x - s * y, s * x + c * y);
                }
            }
        }
    }
    [a[0][0], a[1][1], a[2][2], a[3][3]]
}
