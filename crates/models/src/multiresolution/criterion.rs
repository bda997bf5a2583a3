//! Where finer points are wanted: where the deformation varies around a point.
//!
//! Linear tetrahedra hold every affine deformation; what they miss is how the deformation gradient changes. Both measures
//! are pure numbers, zero for every affine motion, and halve with the spacing where the motion is smooth.

use souple_math::{Mat3, Vec3};

use super::links::Hierarchy;

/// How variation is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// `√(Σ V |F - F̄|² / Σ V)` over the tetrahedra around the point: sees all second derivatives.
    Jump,
    /// `h |Δu|` with the scalar Laplacian of linear elements (Debunne 2000, 5 §3.3): blind to `x² - y²` and all harmonic
    /// fields. The mean gradient is taken off first: at the border the sum would see it.
    Laplacian,
}

/// When to subdivide and when to regroup.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Criterion {
    pub measure: Measure,
    /// Above this a point is subdivided.
    pub refine: f64,
    /// Points that are all below this make place for the coarser one; at most half of `refine`, so that none comes and goes.
    pub coarsen: f64,
    /// Date until which the finest mesh alone is at work [s]; from then on the variation that a point has there counts as none.
    /// `None`: all of it counts, from the start.
    pub settled: Option<f64>,
}

impl Criterion {
    /// Whether finer points would go as soon as they came: around them the variation is about half of what called them.
    pub fn flickers(&self) -> bool {
        2.0 * self.coarsen > self.refine
    }
}

impl Measure {
    /// The variation around a point of its own mesh, at positions of all points.
    pub fn at(self, hierarchy: &Hierarchy, point: usize, positions: &[Vec3]) -> f64 {
        let around = || hierarchy.tets_of_point.get(point).iter().map(|tet| &hierarchy.tets[*tet as usize]);
        let (mut mean, mut volume) = (Mat3::ZERO, 0.0);
        for tet in around() {
            mean += tet.gradient(positions) * tet.volume;
            volume += tet.volume;
        }
        let mean = mean * (1.0 / volume);
        match self {
            Self::Jump => {
                let deviation = |sum: f64, tet: &super::links::Tet| {
                    let difference = tet.gradient(positions) - mean;
                    sum + tet.volume * difference.dot(&difference)
                };
                (around().fold(0.0, deviation) / volume).sqrt()
            }
            // Δu = -(4 / Σ V) Σ V (F - F̄) ∇N
            Self::Laplacian => {
                let mut sum = Vec3::ZERO;
                for tet in around() {
                    let place = tet.corners.iter().position(|corner| *corner as usize == point);
                    let gradient = tet.gradients[place.unwrap_or(0)];
                    sum += (tet.gradient(positions) - mean) * gradient * tet.volume;
                }
                hierarchy.spacing[point] * sum.length() * 4.0 / volume
            }
        }
    }
}
