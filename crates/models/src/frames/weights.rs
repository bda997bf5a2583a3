//! How much each frame has to say at a material point: the table of weights.
//!
//! Weights sum to one wherever a frame reaches (rigid motions ask for that), and gradients are those of the very
//! function that is given, so that `Σ ∇w = 0` and a deformation gradient is the derivative of the positions. Where a body is
//! strained both are used as single precision holds them (see `layout`), with the same sums: there a deformation gradient is
//! that derivative to a millionth, while positions and masses are those of the weights as they are given.

use souple_math::Vec3;
use souple_mesh::Mesh;
use souple_table::{Entry, Parameter, Range, Table, Value, Values};

use super::{Frame, FrameError};
use super::{geodesic, harmonic};

/// The part of a frame in the position of a material point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Share {
    pub frame: u32,
    pub weight: f64,
    /// By the material point [1/m].
    pub gradient: Vec3,
}

/// Weights of some frames all over a body.
pub trait Weights: Send + Sync {
    /// Shares of the frames that reach a point, by ascending frame; none where no frame does.
    fn shares(&self, point: Vec3) -> Vec<Share>;
    /// Why no frame reaches a point, and what to change, in words.
    fn out_of_reach(&self, point: Vec3, frames: &[Frame]) -> String;
}

/// What weights are made for.
pub struct Shape<'a> {
    pub frames: &'a [Frame],
    pub mesh: &'a Mesh,
    /// Of each cell: Young's modulus, or what else is proportional to it [Pa].
    pub stiffness_of_cell: &'a [f64],
}

/// Makes the weights of completed values.
pub type BuildWeights = for<'a> fn(&Values, &Shape<'a>) -> Result<Box<dyn Weights + 'a>, FrameError>;

/// The widest support that is taken, in distances to the nearest neighbour.
const MOST_SUPPORT: f64 = 100.0;

pub(super) const SUPPORT: Parameter = Parameter::number(
    "support",
    "",
    Range::closed(1.0, MOST_SUPPORT),
    "how far a frame reaches, in distances to its nearest neighbour",
)
.or(Value::Number(2.0));

/// All weights.
pub static WEIGHTS: Table<BuildWeights> = Table {
    kind: "weights",
    entries: &[
        &Entry {
            name: "wendland",
            summary: "Shepard's over `(1-u)⁴ (4u+1)`: smooth, nothing beyond the support; the first to try",
            source: "Wendland 1995; Shepard 1968",
            parameters: &[SUPPORT],
            build: |values, shape| Ok(Shepard::boxed(Kernel::Wendland, values.number("support"), shape)),
        },
        &Entry {
            name: "gaussian",
            summary: "Shepard's over `exp(-9u²/2)`: smoother still, and reaches twice the support",
            source: "Shepard 1968",
            parameters: &[SUPPORT],
            build: |values, shape| Ok(Shepard::boxed(Kernel::Gaussian, values.number("support"), shape)),
        },
        &Entry {
            name: "inverse_distance",
            summary: "Shepard's over `1/u⁴`: passes through every frame, reaches everywhere, flat at the frames",
            source: "Shepard 1968",
            parameters: &[],
            build: |_, shape| Ok(Shepard::boxed(Kernel::InverseDistance, 1.0, shape)),
        },
        &Entry {
            name: "geodesic",
            summary: "`wendland` by the way within the shape, shorter through what is stiff: keeps the sides of a slit apart, moves what is stiff as one, and bends as well",
            source: "own; Dijkstra 1959; Daniel et al. 2010; distances as of compliance after Faure et al. 2011",
            parameters: geodesic::PARAMETERS,
            build: |values, shape| geodesic::build(values, shape),
        },
        &Entry {
            name: "harmonic",
            summary: "solved on the shape's own cells: keeps the sides of a slit apart, moves what is stiff as one",
            source: "Joshi et al. 2007; Faure et al. 2011",
            parameters: &[harmonic::CORE, harmonic::LEAST],
            build: |values, shape| harmonic::build(values, shape),
        },
    ],
};

/// `φ(u)` of a distance in supports.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kernel {
    Wendland,
    Gaussian,
    InverseDistance,
}

/// Where `1/u⁴` is bounded, so that a point on a frame has a weight.
const CORE_SQ: f64 = 1e-8;
/// `exp(-9u²/2)` is below 2e-8 beyond.
const GAUSSIAN_END: f64 = 2.0;

impl Kernel {
    /// `φ` and `φ'(u)/u`, which has a limit at zero; `None` beyond its end.
    pub fn at(self, u: f64) -> Option<(f64, f64)> {
        match self {
            Self::Wendland => {
                let rest = 1.0 - u;
                (rest > 0.0).then(|| (rest.powi(4) * (4.0 * u + 1.0), -20.0 * rest.powi(3)))
            }
            Self::Gaussian => (u < GAUSSIAN_END).then(|| {
                let value = libm::exp(-4.5 * u * u);
                (value, -9.0 * value)
            }),
            Self::InverseDistance => {
                let inverse = 1.0 / (u * u + CORE_SQ);
                Some((inverse * inverse, -4.0 * inverse.powi(3)))
            }
        }
    }

    fn end(self) -> f64 {
        match self {
            Self::Wendland => 1.0,
            Self::Gaussian => GAUSSIAN_END,
            Self::InverseDistance => f64::INFINITY,
        }
    }
}

/// `w_i = φ(|P - X_i|/h_i) / Σ_j φ(|P - X_j|/h_j)`.
struct Shepard {
    kernel: Kernel,
    /// In distances to the nearest neighbour.
    support: f64,
    /// Origin and support of each frame [m].
    centres: Vec<(Vec3, f64)>,
}

impl Shepard {
    fn boxed<'a>(kernel: Kernel, support: f64, shape: &Shape) -> Box<dyn Weights + 'a> {
        let spacings = spacings(shape);
        let centres = shape.frames.iter().zip(spacings);
        let centres = centres.map(|(frame, spacing)| (frame.origin, support * spacing)).collect();
        Box::new(Self { kernel, support, centres })
    }
}

impl Weights for Shepard {
    fn shares(&self, point: Vec3) -> Vec<Share> {
        let mut shares = Vec::new();
        let (mut sum, mut sum_gradient) = (0.0, Vec3::ZERO);
        for (frame, &(centre, support)) in self.centres.iter().enumerate() {
            let arm = point - centre;
            // most frames are far away, which squares tell; the kernel decides near its end
            let end = support * self.kernel.end();
            if arm.length_sq() > 1.001 * end * end {
                continue;
            }
            let Some((value, slope)) = self.kernel.at(arm.length() / support) else { continue };
            let gradient = arm * (slope / (support * support));
            shares.push(Share { frame: frame as u32, weight: value, gradient });
            sum += value;
            sum_gradient += gradient;
        }
        if sum <= 0.0 {
            return Vec::new();
        }
        // w = φ/S,  ∇w = (∇φ - w ∇S)/S
        for share in &mut shares {
            share.weight /= sum;
            share.gradient = (share.gradient - sum_gradient * share.weight) / sum;
        }
        shares
    }

    // not by inverse distance, which reaches everywhere: all others have a support
    fn out_of_reach(&self, point: Vec3, _: &[Frame]) -> String {
        let beyond = |(frame, (centre, support)): (usize, &(Vec3, f64))| {
            (frame, (point - *centre).length(), support * self.kernel.end())
        };
        let frames = self.centres.iter().enumerate().map(beyond);
        let nearest = frames.min_by(|a, b| a.1.total_cmp(&b.1));
        nearest.map_or_else(
            || FrameError::NoFrames.to_string(),
            |(frame, distance, reach)| too_far(frame, distance, reach, self.support),
        )
    }
}

/// That the nearest frame does not reach, and what would [m].
pub(super) fn too_far(frame: usize, distance: f64, reach: f64, support: f64) -> String {
    // rounded upwards
    let wider = (100.0 * support * distance / reach).ceil() / 100.0;
    let told = format!(
        "the nearest frame, {frame}, is {distance:.3e} m away and reaches {reach:.3e} m; place frames there"
    );
    if wider > MOST_SUPPORT || wider.is_nan() {
        return told;
    }
    format!(
        "{told}, or take a `support` above {wider}, counted in distances between frames: more of them on a line reach less far across it"
    )
}

/// Distance of each frame to its nearest neighbour; that of a lone frame is the size of the body [m].
pub fn spacings(shape: &Shape) -> Vec<f64> {
    let size = shape.mesh.bounds().diagonal();
    let origins = || shape.frames.iter().map(|frame| frame.origin).enumerate();
    origins()
        .map(|(frame, origin)| {
            let others = origins().filter(|(other, _)| *other != frame);
            others.map(|(_, other)| (other - origin).length()).fold(size, f64::min)
        })
        .collect()
}
