//! Functions of the principal stretches `σ`, from `F = U diag(σ) Vᵀ`.
//!
//! An isotropic energy is a symmetric function of the stretches; its stress is `U diag(g) Vᵀ` with `g = ∂Ψ/∂σ`.

use super::{Expr, Graph, Node, Shape};

/// Where the stretches lie in a decomposition.
pub(crate) const STRETCHES: u8 = 18;

impl Graph {
    pub fn decompose(&mut self, matrix: Expr) -> Expr {
        self.intern(Node::Decompose(matrix), Shape::Decomposition)
    }

    /// The `index`-th stretch of a decomposition.
    pub fn stretch(&mut self, decomposition: Expr, index: u8) -> Expr {
        self.entry(decomposition, STRETCHES + index)
    }

    /// `U diag(g) Vᵀ`.
    pub fn compose(&mut self, decomposition: Expr, g: Expr) -> Expr {
        if self.is_zero(g) {
            return self.zero(Shape::Matrix);
        }
        self.intern(Node::Compose(decomposition, g), Shape::Matrix)
    }

    /// `diag(Uᵀ A V)`.
    pub fn stretch_rates(&mut self, decomposition: Expr, matrix: Expr) -> Expr {
        if self.is_zero(matrix) {
            return self.zero(Shape::Vector);
        }
        self.intern(Node::StretchRates(decomposition, matrix), Shape::Vector)
    }

    /// `δ(U diag(g) Vᵀ) = U D Vᵀ` of `[decomposition, g, δg, k, δF]`. With `M = Uᵀ δF V`: `D_ii = δg_i`, and the symmetric
    /// and skew parts of `M` outside the diagonal are multiplied by `(g_i - g_j)/(σ_i - σ_j)` and
    /// `(g_i + g_j)/(σ_i + σ_j)`. `k` holds what the first quotient tends to for equal stretches,
    /// `∂g_i/∂σ_i - ∂g_i/∂σ_j`, for the pairs (0, 1), (1, 2), (2, 0).
    pub fn compose_differential(&mut self, operands: [Expr; 5]) -> Expr {
        if self.is_zero(operands[4]) {
            return self.zero(Shape::Matrix);
        }
        self.intern(Node::ComposeDifferential(Box::new(operands)), Shape::Matrix)
    }

    /// `k` of [`Self::compose_differential`] for `g` of the stretches of `decomposition`, the mean of both ends: exact
    /// to the second order in the distance of the stretches.
    pub(crate) fn quotient_limits(&mut self, decomposition: Expr, g: Expr) -> Expr {
        let mut limits = Vec::with_capacity(3);
        for (i, j) in [(0, 1), (1, 2), (2, 0)] {
            let (si, sj) = (self.stretch(decomposition, i), self.stretch(decomposition, j));
            let (gi, gj) = (self.entry(g, i), self.entry(g, j));
            let parts = [
                (0.5, self.derivative(gi, si)),
                (-0.5, self.derivative(gi, sj)),
                (0.5, self.derivative(gj, sj)),
                (-0.5, self.derivative(gj, si)),
            ];
            let parts = parts.map(|(factor, part)| self.times_number(factor, part));
            limits.push(self.sum(&parts));
        }
        self.pack(&limits)
    }
}
