//! The part of a tangent that stands for the stress itself, for those who want to do without.
//!
//! `∂P/∂F : δF = δF S + F (∂S/∂E : δE)` with the second Piola–Kirchhoff stress `S = F⁻¹ P`. The first part makes the
//! tangent of compressed matter indefinite; without it the tangent is that of the material alone (Bosman, Duriez & Cotin,
//! eq. 19–21): positive definite wherever the law is, and Newton's method is no longer quadratic. Laws of small strain, whose
//! stress does not turn with the matter, have no such part.

use souple_formal::tape::BATCH;
use souple_math::{Mat3, Vec3};

fn matrix(lanes: &[f64], lane: usize) -> Mat3 {
    let column = |at: usize| {
        let entry = |i: usize| lanes[(3 * at + i) * BATCH + lane];
        Vec3::new(entry(0), entry(1), entry(2))
    };
    Mat3::from_columns(column(0), column(1), column(2))
}

/// `S = F⁻¹ P` of every lane, in the place of `P`; zero where `F` has no inverse.
pub fn second_stress(deformation: &[f64], stress: &mut [f64], lanes: usize) {
    for lane in 0..lanes {
        let inverse = matrix(deformation, lane).try_inverse().unwrap_or(Mat3::ZERO);
        let S = inverse * matrix(stress, lane);
        for (entry, number) in S.columns.iter().flat_map(|column| column.to_array()).enumerate() {
            stress[entry * BATCH + lane] = number;
        }
    }
}

/// Takes `δF S` off `δP`.
pub fn subtract_from_differential(second: &[f64], variation: &[f64], differential: &mut [f64], lanes: usize) {
    for lane in 0..lanes {
        let part = matrix(variation, lane) * matrix(second, lane);
        for (entry, number) in part.columns.iter().flat_map(|column| column.to_array()).enumerate() {
            differential[entry * BATCH + lane] -= number;
        }
    }
}

/// Takes `∂(F S)/∂F` at constant `S` off `∂P/∂F`: `∂(F S)_iJ/∂F_kL = δ_ik S_LJ`.
pub fn subtract_from_tangents(second: &[f64], tangents: &mut [f64], lanes: usize) {
    for L in 0..3 {
        for J in 0..3 {
            for k in 0..3 {
                let at = (9 * (3 * L + k) + 3 * J + k) * BATCH;
                let S = &second[(3 * J + L) * BATCH..];
                for lane in 0..lanes {
                    tangents[at + lane] -= S[lane];
                }
            }
        }
    }
}
