//! Bases that are orthonormal in the norm of a mass.

use souple_math::Vec3;

use crate::{BlockMatrix, LinearOperator, reduce};

/// What is left of a vector beside a basis, relative to the vector, counts as rounding below this.
const ROUNDING: f64 = 1e-10;

/// Vectors with `v_i · M v_j = δ_ij`, and `M v_i`.
pub(crate) struct MassBasis<'a> {
    mass: &'a BlockMatrix,
    pub vectors: Vec<Vec<Vec3>>,
    pub weighted: Vec<Vec<Vec3>>,
}

impl<'a> MassBasis<'a> {
    pub fn new(mass: &'a BlockMatrix) -> Self {
        Self { mass, vectors: Vec::new(), weighted: Vec::new() }
    }

    pub fn clear(&mut self) {
        self.vectors.clear();
        self.weighted.clear();
    }

    pub fn len(&self) -> usize {
        self.vectors.len()
    }

    /// Adds what is new in a vector, as one of the basis; returns whether anything was.
    pub fn add(&mut self, mut v: Vec<Vec3>) -> bool {
        let mut weighted = vec![Vec3::ZERO; v.len()];
        self.mass.apply(&v, &mut weighted);
        let length = length_of(reduce::dot(&v, &weighted));
        // v −= V (Vᵀ M v), twice against rounding
        for _ in 0..2 {
            for (basis, basis_weighted) in self.vectors.iter().zip(&self.weighted) {
                let projection = reduce::dot(basis_weighted, &v);
                reduce::add_scaled(&mut v, -projection, basis);
            }
        }
        self.mass.apply(&v, &mut weighted);
        let rest = length_of(reduce::dot(&v, &weighted));
        if rest.is_nan() || rest <= ROUNDING * length {
            return false;
        }
        for vector in [&mut v, &mut weighted] {
            vector.iter_mut().for_each(|entry| *entry = *entry / rest);
        }
        self.vectors.push(v);
        self.weighted.push(weighted);
        true
    }
}

/// The root of a square that rounding may have made negative; of what is not a number, that.
pub(crate) fn length_of(square: f64) -> f64 {
    if square < 0.0 { 0.0 } else { square.sqrt() }
}

/// `Σ w_i v_i`, of as many entries as `count`.
pub(crate) fn combination(vectors: &[Vec<Vec3>], weights: &[f64], count: usize) -> Vec<Vec3> {
    let mut sum = vec![Vec3::ZERO; count];
    for (vector, weight) in vectors.iter().zip(weights) {
        reduce::add_scaled(&mut sum, *weight, vector);
    }
    sum
}
