//! A law at a deformation.

#![allow(non_snake_case)]

use souple_math::Mat3;

use super::{DEFORMATION, EnergyLaw, VARIATION};
use crate::graph::{Evaluation, Expr};

impl EnergyLaw {
    /// Evaluates expressions of the law at a deformation and a variation of it.
    pub fn evaluate(&self, roots: &[Expr], F: &Mat3, dF: &Mat3) -> Evaluation {
        let (F, dF) = (entries(F), entries(dF));
        self.graph.evaluate(roots, |symbol| match symbol.name.as_str() {
            DEFORMATION => &F[..],
            VARIATION => &dF[..],
            name => self.parameter(name).map_or(&[0.0; 9][..], |parameter| parameter.numbers()),
        })
    }

    /// `Ψ(F)` [J/m³].
    pub fn energy_at(&self, F: &Mat3) -> f64 {
        self.evaluate(&[self.energy], F, &Mat3::ZERO).scalar(self.energy)
    }

    /// `P(F)` [Pa].
    pub fn stress_at(&self, F: &Mat3) -> Mat3 {
        self.evaluate(&[self.stress], F, &Mat3::ZERO).matrix(self.stress)
    }

    /// `∂P/∂F : δF` [Pa].
    pub fn differential_at(&self, F: &Mat3, dF: &Mat3) -> Mat3 {
        self.evaluate(&[self.differential], F, dF).matrix(self.differential)
    }
}

/// By columns.
pub(super) fn entries(matrix: &Mat3) -> [f64; 9] {
    let mut out = [0.0; 9];
    for (three, column) in out.chunks_exact_mut(3).zip(matrix.columns) {
        three.copy_from_slice(&column.to_array());
    }
    out
}
