//! A material point as a weighted sum of rows.

use souple_engine::tangent::add_block;
use souple_math::{Mat3, Vec3};
use souple_solve::BlockMatrix;

use super::{LoadError, finite};

/// `x = Σ weight · row`: a node, a point inside an element or on a facet, a point of a frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Combination {
    rows: Vec<(u32, f64)>,
}

impl Combination {
    /// # Errors
    /// There is no row, or a weight is not finite.
    pub fn new(rows: Vec<(u32, f64)>) -> Result<Self, LoadError> {
        if rows.is_empty() {
            return Err(LoadError::Empty { field: "rows", expected: "row with its weight" });
        }
        for (index, (_, weight)) in rows.iter().enumerate() {
            finite(format!("rows[{index}].weight"), *weight)?;
        }
        Ok(Self { rows })
    }

    /// One row itself.
    pub fn row(row: u32) -> Self {
        Self { rows: vec![(row, 1.0)] }
    }

    pub fn rows(&self) -> &[(u32, f64)] {
        &self.rows
    }

    /// `Σ weight · values`: a position, a velocity or a displacement.
    pub fn of(&self, values: &[Vec3]) -> Vec3 {
        self.rows.iter().map(|&(row, weight)| values[row as usize] * weight).sum()
    }

    /// `out += weight · force`: the transpose of [`Combination::of`].
    pub fn spread(&self, force: Vec3, out: &mut [Vec3]) {
        for &(row, weight) in &self.rows {
            out[row as usize] += force * weight;
        }
    }

    /// `matrix += weightᵀ block weight` between the rows of `self` and those of `other`.
    pub fn add_blocks(&self, other: &Self, block: &Mat3, matrix: &mut BlockMatrix) {
        for &(a, weight_a) in &self.rows {
            for &(b, weight_b) in &other.rows {
                add_block(matrix, a as usize, b as usize, &(*block * (weight_a * weight_b)));
            }
        }
    }

    /// Sum of the weights: 1 for a point that moves with a translation of its rows.
    pub fn total_weight(&self) -> f64 {
        self.rows.iter().map(|(_, weight)| weight).sum()
    }
}
