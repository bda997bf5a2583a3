//! Why a skin cannot start or go on, in words.

use crate::grid::FARTHEST;
use crate::polygons::Torn;
use crate::skin::{MOST_BLOCKS, MOST_SAMPLED, MOST_SUBSTEPS};

/// Why a skin cannot start or go on.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SkinError {
    #[error("its step was broken off")]
    Interrupted,
    #[error("its target cannot be placed: {0}")]
    Target(String),
    #[error("{part}its target is {value} at {place:?}; expected a number")]
    TargetNotANumber { value: f64, place: [f64; 3], part: String },
    #[error(
        "its target is inside nowhere in the box from {low:?} to {high:?} at voxels of {voxel} m; expected an inside: an `iso` that it comes up to, below 1 for skeletons, or smaller voxels where it is thinner than one"
    )]
    Empty { low: [f64; 3], high: [f64; 3], voxel: f64 },
    #[error(
        "its density is {most:.3} at most, and {iso} on the skin: where particles fill a space at twice their radius from each \
         other it is 1, in a line of such 0.477, of one alone 0.318; expected an `iso` below {most:.3}, a larger radius, or \
         more particles"
    )]
    Sparse { most: f64, iso: f64 },
    #[error(
        "its target is inside at {place:?}, on the border of the box it is looked for in; expected one that ends within, or a larger `domain`"
    )]
    BeyondDomain { place: [f64; 3] },
    #[error(
        "voxels of {voxel} m do not show what it begins as, in a box of {size:?} m; expected voxels smaller than it, such as {} m",
        0.1 * size.iter().fold(0.0_f64, |most, side| most.max(*side))
    )]
    Coarse { voxel: f64, size: [f64; 3] },
    #[error(
        "its target does not say where it ends; expected a `domain`, or an `iso` above 0 where its parts end"
    )]
    NoDomain,
    #[error(
        "at voxels of {voxel} m {cubes} cubes of {edge} m may hold its surface, in a box of {size:?} m; expected at most {most}: larger voxels"
    )]
    TooManyCubes { voxel: f64, size: [f64; 3], cubes: usize, most: usize, edge: f64 },
    #[error(
        "voxels of {voxel} m in a box of {size:?} m make {blocks:.3e} blocks of 8³ nodes; expected at most {MOST_SAMPLED}: larger voxels"
    )]
    TooManyBlocks { voxel: f64, size: [f64; 3], blocks: f64 },
    #[error(
        "the box from {low:?} to {high:?} is farther from the origin of its grid than {FARTHEST} blocks of 8 voxels of {voxel} m; expected an `origin` near it, or larger voxels"
    )]
    TooFar { low: [f64; 3], high: [f64; 3], voxel: f64 },
    #[error(
        "it grew to {blocks} blocks of 8³ nodes at t = {time} s; at most {MOST_BLOCKS} are kept: larger voxels, or less growth"
    )]
    Grown { blocks: usize, time: f64 },
    #[error(
        "it left its space, {FARTHEST} blocks of 8 voxels to each side, at t = {time} s; expected less growth, larger voxels, or \
         an `origin` near it"
    )]
    Runaway { time: f64 },
    #[error(
        "particle {particle}, at {place:?}, is farther than {most:.3e} m from {origin:?}; expected particles nearer to each \
         other, or larger voxels"
    )]
    FarParticle { particle: usize, place: [f64; 3], most: f64, origin: [f64; 3] },
    #[error("{term}its speed is {speed} m/s at {place:?} at t = {time} s; expected a number")]
    Speed { speed: f64, place: [f64; 3], time: f64, term: String },
    #[error(
        "terms[{term}] is {speed} m/s at t = {time} s, where the area is {area} m² and the volume {volume} m³; expected {expected}"
    )]
    Term { term: usize, speed: f64, area: f64, volume: f64, time: f64, expected: String },
    #[error(
        "a step of {timestep} s would be more than {MOST_SUBSTEPS} sub-steps of {substep:.3e} s: larger voxels, slower terms or shorter steps"
    )]
    TooManySubsteps { timestep: f64, substep: f64 },
    #[error("{torn} at t = {time} s")]
    Torn { torn: Torn, time: f64 },
}
