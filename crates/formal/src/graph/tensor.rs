//! Vectors and matrices: every way to make one simplifies on the spot.
//!
//! Factors move out, transposes move in (so a matrix is symmetric where its transpose is the same [`Expr`]), traces and
//! products of dyads become dot products, determinants and cofactors of products become products.

use super::{Expr, Graph, Node, OfTensor, Shape};

/// Factors of a product that is applied to a vector one after the other; longer ones are computed first.
const FACTORS_APPLIED: usize = 16;

impl Graph {
    /// What is made of a sum or product, made once: a chain of sums that each hold the one before twice has as many ways down as
    /// two to its length.
    fn of_tensor(&mut self, what: OfTensor, tensor: Expr, make: impl FnOnce(&mut Self) -> Expr) -> Expr {
        if let Some(made) = self.of_tensors.get(&(what, tensor)) {
            return *made;
        }
        let made = make(self);
        self.of_tensors.insert((what, tensor), made);
        made
    }

    /// The sum of what is made of its terms.
    fn of_sum(
        &mut self,
        what: OfTensor,
        (sum, terms): (Expr, &[Expr]),
        make: impl Fn(&mut Self, Expr) -> Expr,
    ) -> Expr {
        self.of_tensor(what, sum, |graph| {
            let terms: Vec<Expr> = terms.iter().map(|term| make(graph, *term)).collect();
            graph.sum(&terms)
        })
    }

    /// Whether a matrix is a product of at most so many factors; what is left of them.
    fn factors_left(&self, matrix: Expr, most: usize) -> Option<usize> {
        match self.node(matrix) {
            Node::Multiply(a, b) => self.factors_left(*b, self.factors_left(*a, most)?),
            _ => most.checked_sub(1),
        }
    }

    pub fn identity(&mut self) -> Expr {
        self.intern(Node::Identity, Shape::Matrix)
    }

    /// The factor of a scaled tensor and the tensor.
    pub(crate) fn split_scale(&self, expr: Expr) -> (Option<Expr>, Expr) {
        match self.node(expr) {
            Node::Scale(factor, tensor) => (Some(*factor), *tensor),
            _ => (None, expr),
        }
    }

    /// A number times a vector or matrix.
    pub fn scale(&mut self, factor: Expr, tensor: Expr) -> Expr {
        let shape = self.shape(tensor);
        if shape == Shape::Scalar {
            return self.product(&[factor, tensor]);
        }
        if self.value(factor) == Some(1.0) {
            return tensor;
        }
        if self.is_zero(factor) || self.is_zero(tensor) {
            return self.zero(shape);
        }
        if let Node::Scale(inner, tensor) = *self.node(tensor) {
            let factor = self.product(&[factor, inner]);
            return self.scale(factor, tensor);
        }
        self.intern(Node::Scale(factor, tensor), shape)
    }

    /// `make` of the tensors without their factors, times the factors.
    fn bilinear(&mut self, a: Expr, b: Expr, make: impl FnOnce(&mut Self, Expr, Expr) -> Expr) -> Expr {
        let ((f, a), (g, b)) = (self.split_scale(a), self.split_scale(b));
        let made = make(self, a, b);
        let factors: Vec<Expr> = f.into_iter().chain(g).collect();
        if factors.is_empty() {
            return made;
        }
        let factor = self.product(&factors);
        self.scale(factor, made)
    }

    /// Product of matrices.
    pub fn multiply(&mut self, a: Expr, b: Expr) -> Expr {
        if self.is_zero(a) || self.is_zero(b) {
            return self.zero(Shape::Matrix);
        }
        self.bilinear(a, b, |graph, a, b| match (graph.node(a).clone(), graph.node(b).clone()) {
            (Node::Identity, _) => b,
            (_, Node::Identity) => a,
            (_, Node::Outer(u, v)) => {
                let u = graph.apply(a, u);
                graph.outer(u, v)
            }
            (Node::Outer(u, v), _) => {
                let transposed = graph.transpose(b);
                let v = graph.apply(transposed, v);
                graph.outer(u, v)
            }
            _ => graph.intern(Node::Multiply(a, b), Shape::Matrix),
        })
    }

    /// Matrix times vector.
    pub fn apply(&mut self, matrix: Expr, vector: Expr) -> Expr {
        if self.is_zero(matrix) || self.is_zero(vector) {
            return self.zero(Shape::Vector);
        }
        self.bilinear(matrix, vector, |graph, matrix, vector| match *graph.node(matrix) {
            Node::Identity => vector,
            // (A B) v = A (B v): two products with a vector instead of one with a matrix
            Node::Multiply(a, b) if graph.factors_left(matrix, FACTORS_APPLIED).is_some() => {
                let inner = graph.apply(b, vector);
                graph.apply(a, inner)
            }
            Node::Outer(u, v) => {
                let factor = graph.dot(v, vector);
                graph.scale(factor, u)
            }
            _ => graph.intern(Node::Apply(matrix, vector), Shape::Vector),
        })
    }

    pub fn transpose(&mut self, matrix: Expr) -> Expr {
        match self.node(matrix).clone() {
            Node::Transpose(inner) => inner,
            Node::Identity | Node::Zero(_) => matrix,
            Node::Scale(factor, inner) => {
                let inner = self.transpose(inner);
                self.scale(factor, inner)
            }
            Node::Sum(terms) => self.of_sum(OfTensor::Transpose, (matrix, &terms), Self::transpose),
            Node::Multiply(a, b) => self.of_tensor(OfTensor::Transpose, matrix, |graph| {
                let (a, b) = (graph.transpose(a), graph.transpose(b));
                graph.multiply(b, a)
            }),
            Node::Outer(u, v) => self.outer(v, u),
            Node::Pack(entries) => {
                let entries: Vec<Expr> = (0..9).map(|i| entries[(i % 3) * 3 + i / 3]).collect();
                self.pack(&entries)
            }
            // symmetric operands have symmetric cofactors
            Node::Cofactor(inner) if self.transpose(inner) == inner => matrix,
            _ => self.intern(Node::Transpose(matrix), Shape::Matrix),
        }
    }

    /// `(A + Aᵀ)/2`.
    pub fn symmetric_part(&mut self, matrix: Expr) -> Expr {
        let transposed = self.transpose(matrix);
        let sum = self.add(matrix, transposed);
        self.times_number(0.5, sum)
    }

    /// Sum of products of entries.
    pub fn dot(&mut self, a: Expr, b: Expr) -> Expr {
        if self.is_zero(a) || self.is_zero(b) {
            return self.number(0.0);
        }
        self.bilinear(a, b, |graph, mut a, mut b| {
            if graph.shape(a) == Shape::Matrix {
                match (graph.node(a).clone(), graph.node(b).clone()) {
                    (Node::Identity, _) => return graph.trace(b),
                    (_, Node::Identity) => return graph.trace(a),
                    (_, Node::Outer(u, v)) => {
                        let image = graph.apply(a, v);
                        return graph.dot(u, image);
                    }
                    (Node::Outer(u, v), _) => {
                        let image = graph.apply(b, v);
                        return graph.dot(u, image);
                    }
                    _ => {}
                }
                // A : B = Aᵀ : Bᵀ; of equal pairs the one of earlier expressions is taken
                let (at, bt) = (graph.transpose(a), graph.transpose(b));
                if (at.max(bt), at.min(bt)) < (a.max(b), a.min(b)) {
                    (a, b) = (at, bt);
                }
            }
            let (a, b) = (a.min(b), a.max(b));
            graph.intern(Node::Dot(a, b), Shape::Scalar)
        })
    }

    pub fn trace(&mut self, matrix: Expr) -> Expr {
        match self.node(matrix).clone() {
            Node::Identity => self.number(3.0),
            Node::Zero(_) => self.number(0.0),
            Node::Scale(factor, inner) => {
                let inner = self.trace(inner);
                self.product(&[factor, inner])
            }
            Node::Sum(terms) => self.of_sum(OfTensor::Trace, (matrix, &terms), Self::trace),
            Node::Multiply(a, b) => {
                let a = self.transpose(a);
                self.dot(a, b)
            }
            Node::Outer(u, v) => self.dot(u, v),
            Node::Transpose(inner) => self.trace(inner),
            Node::Pack(entries) => self.sum(&[entries[0], entries[4], entries[8]]),
            _ => self.intern(Node::Trace(matrix), Shape::Scalar),
        }
    }

    pub fn determinant(&mut self, matrix: Expr) -> Expr {
        match self.node(matrix).clone() {
            Node::Identity => self.number(1.0),
            Node::Zero(_) => self.number(0.0),
            Node::Scale(factor, inner) => {
                let (cube, inner) = (self.power_number(factor, 3.0), self.determinant(inner));
                self.product(&[cube, inner])
            }
            Node::Multiply(a, b) => self.of_tensor(OfTensor::Determinant, matrix, |graph| {
                let (a, b) = (graph.determinant(a), graph.determinant(b));
                graph.product(&[a, b])
            }),
            Node::Transpose(inner) => self.determinant(inner),
            _ => self.intern(Node::Determinant(matrix), Shape::Scalar),
        }
    }

    /// `cof A = ∂ det A/∂A = det A · A⁻ᵀ`.
    pub fn cofactor(&mut self, matrix: Expr) -> Expr {
        match self.node(matrix).clone() {
            Node::Identity | Node::Zero(_) => matrix,
            Node::Scale(factor, inner) => {
                let (square, inner) = (self.power_number(factor, 2.0), self.cofactor(inner));
                self.scale(square, inner)
            }
            Node::Multiply(a, b) => self.of_tensor(OfTensor::Cofactor, matrix, |graph| {
                let (a, b) = (graph.cofactor(a), graph.cofactor(b));
                graph.multiply(a, b)
            }),
            Node::Transpose(inner) => {
                let inner = self.cofactor(inner);
                self.transpose(inner)
            }
            Node::Outer(..) => self.zero(Shape::Matrix),
            _ => self.intern(Node::Cofactor(matrix), Shape::Matrix),
        }
    }

    /// `A⁻¹ = (cof A)ᵀ / det A`.
    pub fn inverse(&mut self, matrix: Expr) -> Expr {
        let (cofactor, determinant) = (self.cofactor(matrix), self.determinant(matrix));
        let (adjugate, reciprocal) = (self.transpose(cofactor), self.power_number(determinant, -1.0));
        self.scale(reciprocal, adjugate)
    }

    /// `A ⨯ B` with `cof(A + B) = cof A + A ⨯ B + cof B`.
    pub fn cross(&mut self, a: Expr, b: Expr) -> Expr {
        if self.is_zero(a) || self.is_zero(b) {
            return self.zero(Shape::Matrix);
        }
        self.bilinear(a, b, |graph, a, b| {
            if a == b {
                let cofactor = graph.cofactor(a);
                return graph.times_number(2.0, cofactor);
            }
            let identity = graph.identity();
            if a == identity || b == identity {
                // A ⨯ I = tr(A) I - Aᵀ
                let other = if a == identity { b } else { a };
                let (trace, transposed) = (graph.trace(other), graph.transpose(other));
                let spherical = graph.scale(trace, identity);
                return graph.subtract(spherical, transposed);
            }
            graph.intern(Node::Cross(a.min(b), a.max(b)), Shape::Matrix)
        })
    }

    /// `a bᵀ`.
    pub fn outer(&mut self, a: Expr, b: Expr) -> Expr {
        if self.is_zero(a) || self.is_zero(b) {
            return self.zero(Shape::Matrix);
        }
        self.bilinear(a, b, |graph, a, b| graph.intern(Node::Outer(a, b), Shape::Matrix))
    }

    /// One number of a tensor; matrices by columns.
    pub fn entry(&mut self, tensor: Expr, index: u8) -> Expr {
        let (row, column) = (index % 3, index / 3);
        match self.node(tensor).clone() {
            Node::Identity => self.number(if row == column { 1.0 } else { 0.0 }),
            Node::Zero(_) => self.number(0.0),
            Node::Scale(factor, inner) => {
                let inner = self.entry(inner, index);
                self.product(&[factor, inner])
            }
            Node::Sum(terms) => {
                self.of_sum(OfTensor::Entry(index), (tensor, &terms), |graph, term| graph.entry(term, index))
            }
            Node::Transpose(inner) => self.entry(inner, 3 * row + column),
            Node::Outer(u, v) => {
                let (u, v) = (self.entry(u, row), self.entry(v, column));
                self.product(&[u, v])
            }
            Node::Pack(entries) => entries[usize::from(index)],
            // of a symmetric matrix the entries below the diagonal are taken
            _ if self.shape(tensor) == Shape::Matrix && row < column && self.transpose(tensor) == tensor => {
                self.entry(tensor, 3 * row + column)
            }
            _ => self.intern(Node::Entry(tensor, index), Shape::Scalar),
        }
    }

    /// A vector of three numbers or a matrix of nine, by columns.
    pub fn pack(&mut self, entries: &[Expr]) -> Expr {
        let shape = if entries.len() == 3 { Shape::Vector } else { Shape::Matrix };
        assert_eq!(entries.len(), shape.size(), "three or nine entries");
        if entries.iter().all(|entry| self.is_zero(*entry)) {
            return self.zero(shape);
        }
        // the entries of one tensor in order are that tensor
        if let Node::Entry(tensor, 0) = *self.node(entries[0])
            && self.shape(tensor) == shape
            && (0..shape.size()).all(|i| self.entry(tensor, i as u8) == entries[i])
        {
            return tensor;
        }
        self.intern(Node::Pack(entries.into()), shape)
    }
}
