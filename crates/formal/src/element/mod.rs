//! Laws on elements: energy, forces and force differentials of an element, written out.
//!
//! From data alone (shape gradients and weights at the samples, and a law) the expressions of the tensor-mass method are
//! made (Faure 2014): `F = I + U_ξ X_ξ⁻¹`, `W = Σ ω Ψ(F)`, `f_n = -∂W/∂U_n`, `δf = (∂f/∂U) V`. What depends on rest
//! positions and material only is grouped into constants. A [`Cut`] splits the expressions into addends.

mod cut;
mod derive;
mod direct;
mod separable;
mod steps;

pub use cut::{Axis, Cut, Derivative, Fragment};
pub use derive::{Derived, ElementExpressions, Symbols};
pub(crate) use derive::{WEIGHT, terms};
pub use direct::Direct;
pub use steps::{ConstantPlaces, Step, Steps};

/// What is known of an element.
#[derive(Clone, Debug)]
pub struct ElementData {
    pub name: String,
    /// 2 (plane strain, unit thickness) or 3.
    pub dimension: usize,
    pub node_count: usize,
    /// Shape function of each node: coefficients of `ξ^x η^y ζ^z / (1 - ζ)^w` by `[x, y, z, w]`.
    pub shapes: Vec<Vec<(f64, [u8; 4])>>,
    pub samples: Vec<Sample>,
    pub map: RestMap,
}

/// One point of the rule of quadrature.
#[derive(Clone, Debug)]
pub struct Sample {
    /// `ξ`.
    pub position: [f64; 3],
    pub weight: f64,
    /// `∂N_n/∂ξ` of each node.
    pub gradients: Vec<[f64; 3]>,
}

/// How reference coordinates become rest positions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RestMap {
    /// By the shape functions.
    Nodes,
    /// A box along the axes of the world, between these two nodes; reference coordinates run from -1 to 1.
    Box { low: usize, high: usize },
}

impl ElementData {
    /// Energy, forces and differential in numbers. The decomposition into principal stretches, which has no formula, is one operation on
    /// nine of them.
    pub fn derive(&self, law: &crate::law::EnergyLaw, cut: Cut) -> Derived {
        derive::derive(self, law, cut)
    }

    /// The differential derived in physical coordinates; `None` where the element is no box with a node in each corner.
    pub fn derive_directly(&self, law: &crate::law::EnergyLaw) -> Option<Direct> {
        direct::derive(self, law)
    }

    /// What is computed at each step, in tensors and without writing them out: any law.
    pub fn steps(&self, law: &crate::law::EnergyLaw, cut: Cut) -> Steps {
        steps::steps(self, law, cut)
    }
}

#[cfg(test)]
mod tests;
