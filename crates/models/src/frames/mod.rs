//! Bodies without a mesh of unknowns: a few rigid or affine frames carry many material points.
//!
//! With the weights `w_i(P)` of frames at rest at `X_i` with axes `A_i`, a material point stands at
//! `x = Σ_i w_i (x_i + R_i l_i)`, `l_i = A_iᵀ (P - X_i)`, and its deformation gradient is
//! `F = Σ_i (x_i + R_i l_i) ⊗ ∇w_i + w_i R_i A_iᵀ`. Both are linear in the four rows of a frame (its origin and its axes,
//! see `souple_engine::kinematics`): the origin has the weight `w` and the gradient `∇w`, axis `k` the weight `w l_k` and
//! the gradient `l_k ∇w + w A_k`. So a body of frames is samples with a gradient for each row, as a finite element is,
//! and whether its frames are rigid or affine is told by the kinematics alone.
//!
//! Frames may lie on a line or in a plane: each carries a rotation, so that nothing is singular there.

mod cells;
mod force;
mod geodesic;
mod harmonic;
mod hold;
mod kernel;
mod layout;
mod mass;
mod matrix;
mod placement;
mod points;
mod report;
mod tangents;
mod unseen;
mod ways;
mod weights;

use souple_math::{Mat3, Vec3};

pub use force::{FramesDescription, FramesForce, TangentKind};
pub use hold::{HeldPoint, Hold, layer_stiffness};
pub use mass::{check_inertia, consistent_mass, lumped_mass};
pub use placement::{BuildPlacement, Matter, PLACEMENTS};
pub use points::{BuildPoints, POINTS, Sample, samples_of_cells};
pub use report::FramesReport;
pub use unseen::{FramesAtRest, Unseen};
pub use weights::{BuildWeights, Shape, Share, WEIGHTS, Weights, spacings};

/// A frame at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// [m]
    pub origin: Vec3,
    /// Orthonormal, by columns.
    pub axes: Mat3,
}

/// Rows of a frame: its origin and its axes.
pub const ROWS_OF_FRAME: usize = 4;

/// What rows of frames have to say at a material point, frame after frame: weight and gradient of each row.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Carried {
    pub frames: Vec<u32>,
    pub rows: Vec<[(f64, Vec3); ROWS_OF_FRAME]>,
}

impl Carried {
    /// By the shares of frames at a point at rest.
    pub fn new(frames: &[Frame], shares: &[Share], point: Vec3) -> Self {
        let rows = shares.iter().map(|share| {
            let Frame { origin, axes } = &frames[share.frame as usize];
            let local = axes.transpose_apply(point - *origin);
            let axis = |k: usize| {
                (share.weight * local[k], share.gradient * local[k] + axes.columns[k] * share.weight)
            };
            [(share.weight, share.gradient), axis(0), axis(1), axis(2)]
        });
        Self { rows: rows.collect(), frames: shares.iter().map(|share| share.frame).collect() }
    }

    /// Weights over rows, where `row_of_frame` is the row of a frame's origin.
    pub fn weights<'a>(&'a self, row_of_frame: &'a [u32]) -> impl Iterator<Item = (u32, f64)> + 'a {
        self.frames.iter().zip(&self.rows).flat_map(move |(frame, rows)| {
            let first = row_of_frame[*frame as usize];
            (first..).zip(rows).map(|(row, (weight, _))| (row, *weight))
        })
    }
}

/// A body of frames that cannot be.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FrameError {
    #[error(
        "{frames} frames are more than the {points} integration points they are placed among; take fewer frames, or more points"
    )]
    MoreThanPoints { frames: usize, points: usize },
    #[error("`{key}` holds {count} numbers; each frame takes three")]
    NoTriples { key: &'static str, count: usize },
    #[error("`counts` holds {count}; each is a whole number from 1 to 1000")]
    NoGrid { count: f64 },
    #[error("`counts` makes {places} places; at most {most} are looked at, take smaller ones")]
    TooManyPlaces { places: usize, most: usize },
    #[error(
        "`kept` lists {kept} frames and `count` is {count}, in which those that are kept count; keep fewer, or take a `count` of at least {kept}"
    )]
    TooManyKept { kept: usize, count: usize },
    #[error(
        "{frames} frames times {points} integration points times {passes} (one, and each of the `iterations` of `lloyd`) are {distances:.1e} distances, and at most {most:.0e} are compared; take fewer of them"
    )]
    TooManyDistances { frames: usize, points: usize, passes: usize, distances: f64, most: f64 },
    #[error("there are no frames; place at least one")]
    NoFrames,
    #[error(
        "frames {} and {} are on top of each other, at ({}, {}, {}): {distance:.3e} m apart; they would move as one, take fewer frames or move one",
        .frames[0], .frames[1], .at.x, .at.y, .at.z
    )]
    OneFrameTwice { frames: [usize; 2], at: Vec3, distance: f64 },
    #[error(
        "frames {} and {} both claim the mesh point at ({}, {}, {}): `harmonic` weights are solved on the body's mesh, which is too coarse for frames this close; take a finer mesh, or fewer frames",
        .frames[0], .frames[1], .at.x, .at.y, .at.z
    )]
    OneNode { frames: [u32; 2], at: Vec3 },
    #[error(
        "no frame reaches {count} of the body's points, the first at ({}, {}, {}): {why}",
        .at.x, .at.y, .at.z
    )]
    OutOfReach { count: usize, at: Vec3, why: String },
    #[error(
        "no cell of the mesh carries frame {frame}, at ({}, {}, {}), and the weights go by the cells; place it in the shape, and mend cells there that are flat",
        .at.x, .at.y, .at.z
    )]
    NotCarried { frame: usize, at: Vec3 },
    #[error(
        "no frame is in the part of the mesh with a cell at ({}, {}, {}), and the weights do not leave the part that a frame is in; place a frame there, or join the parts",
        .at.x, .at.y, .at.z
    )]
    PartWithoutFrame { at: Vec3 },
    #[error("cell {cell} of the mesh is flat at ({}, {}, {}), and the weights are solved on the cells; mend the mesh", .at.x, .at.y, .at.z)]
    FlatCell { cell: usize, at: Vec3 },
    #[error(
        "the material of cell {cell} has a Young's modulus of {stiffness} Pa at rest, with which others cannot be compared; take a material with one above zero, or what does not go by stiffness: `wendland` weights, frames placed `by = \"volume\"`"
    )]
    NoStiffness { cell: usize, stiffness: f64 },
    #[error(
        "frame {frame}, at ({}, {}, {}), reaches no integration point: it would have no mass; take more points, fewer frames, or a wider support of weights that have one",
        .at.x, .at.y, .at.z
    )]
    NoMatter { frame: usize, at: Vec3 },
    #[error(
        "the matter of frame {frame}, at ({}, {}, {}), lies on a {shape}: it has no inertia against {motions}; take more integration points there, or a wider support of weights that have one",
        .at.x, .at.y, .at.z
    )]
    NoInertia { frame: usize, at: Vec3, shape: &'static str, motions: &'static str },
    #[error("the weights could not be solved for: {0}")]
    Unsolved(String),
}

/// Whether all points are in reach of a frame.
///
/// # Errors
/// The first that is not, in the words of the weights.
pub fn check_reach(
    shape: &Shape,
    weights: &dyn Weights,
    points: impl Iterator<Item = Vec3>,
) -> Result<(), FrameError> {
    let (mut count, mut first) = (0, None);
    for point in points {
        if weights.shares(point).is_empty() {
            count += 1;
            first.get_or_insert(point);
        }
    }
    match first {
        Some(at) => Err(FrameError::OutOfReach { count, at, why: weights.out_of_reach(at, shape.frames) }),
        None => Ok(()),
    }
}

/// Distance, relative to the body's size, below which two frames are one.
const APART: f64 = 1e-6;

/// Whether there are frames, and no two at one place.
///
/// # Errors
/// The first two that are.
pub fn check_apart(shape: &Shape) -> Result<(), FrameError> {
    if shape.frames.is_empty() {
        return Err(FrameError::NoFrames);
    }
    let size = shape.mesh.bounds().diagonal();
    for (b, frame) in shape.frames.iter().enumerate() {
        for (a, other) in shape.frames[..b].iter().enumerate() {
            let distance = (frame.origin - other.origin).length();
            if distance <= APART * size {
                return Err(FrameError::OneFrameTwice { frames: [a, b], at: frame.origin, distance });
            }
        }
    }
    Ok(())
}
