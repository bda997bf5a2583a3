//! The stiffness between two nodes, from the differential of the stress.

#![allow(non_snake_case)]

use std::collections::HashMap;

use super::EnergyLaw;
use crate::graph::{Expr, Graph, Node, Shape};

/// `K` with `K u = (∂P/∂F : (u ⊗ b)) a`, in a graph of its own.
#[derive(Clone, Debug)]
pub struct Block {
    pub graph: Graph,
    /// The gradients `a` and `b` of the shape functions of two nodes, symbols.
    pub gradients: [Expr; 2],
    pub stiffness: Expr,
}

/// What blocks are made of.
struct Blocks<'a> {
    graph: &'a mut Graph,
    /// `δF`.
    variation: Expr,
    /// `δF = u ⊗ b`.
    b: Expr,
    /// What depends on `δF`.
    depends: Vec<bool>,
    /// `∂s/∂δF` of numbers `s`.
    slopes: HashMap<Expr, Expr>,
}

impl EnergyLaw {
    /// The differential along `δF = u ⊗ b`, times `a`, as a matrix in front of `u`: no product of three by three is needed for it where
    /// the differential is made of products of tensors. `None` where it is written by entries, by directions or by stretches: then
    /// three differentials make a block.
    pub fn block(&self) -> Option<Block> {
        let mut graph = self.graph.clone();
        let [a, b] = ["g_a", "g_b"].map(|name| graph.own_vector(name));
        let depends = graph.depends(&[self.differential], &[self.variation]);
        let variation = self.variation;
        let mut blocks = Blocks { graph: &mut graph, variation, b, depends, slopes: HashMap::new() };
        let stiffness = blocks.of(self.differential, None, a)?;
        Some(Block { graph, gradients: [a, b], stiffness })
    }
}

impl Blocks<'_> {
    fn varies(&self, expr: Expr) -> bool {
        self.depends.get(expr.index()).copied().unwrap_or(false)
    }

    /// `left · v`; nothing on the left is the identity.
    fn applied(&mut self, left: Option<Expr>, vector: Expr) -> Expr {
        left.map_or(vector, |left| self.graph.apply(left, vector))
    }

    /// `left · matrix`.
    fn times(&mut self, left: Option<Expr>, matrix: Expr) -> Expr {
        left.map_or(matrix, |left| self.graph.multiply(left, matrix))
    }

    /// The vector `c` with `s(u ⊗ b) = c·u`: the gradient of a number that is linear in `δF`, times `b`.
    fn slope(&mut self, number: Expr) -> Expr {
        let slope = match self.slopes.get(&number) {
            Some(known) => *known,
            None => self.graph.gradient(number, self.variation),
        };
        self.slopes.insert(number, slope);
        self.graph.apply(slope, self.b)
    }

    /// `K` with `K u = left · X(u ⊗ b) · r`.
    fn of(&mut self, X: Expr, left: Option<Expr>, r: Expr) -> Option<Expr> {
        if X == self.variation {
            let length = self.graph.dot(self.b, r);
            let identity = self.graph.identity();
            return Some(self.graph.scale(length, left.unwrap_or(identity)));
        }
        match self.graph.node(X).clone() {
            Node::Sum(terms) => self.sum(&terms, |blocks, term| blocks.of(term, left, r)),
            Node::Scale(number, tensor) if self.varies(number) => {
                // a product of two that vary is not linear
                let image = self.graph.apply(tensor, r);
                Some(self.rank_one(left, image, number))
            }
            Node::Scale(number, tensor) => {
                let r = self.graph.scale(number, r);
                self.of(tensor, left, r)
            }
            Node::Multiply(A, B) if self.varies(B) => {
                let left = self.times(left, A);
                self.of(B, Some(left), r)
            }
            Node::Multiply(A, B) => {
                let r = self.graph.apply(B, r);
                self.of(A, left, r)
            }
            Node::Transpose(inner) => self.of_transpose(inner, left, r),
            // (A ⨯ (u ⊗ b)) r = (A (b × r)) × u
            Node::Cross(A, B) if A == self.variation || B == self.variation => {
                let other = if A == self.variation { B } else { A };
                let (number, r) = self.graph.split_scale(r);
                let normal = self.vector_product(self.b, r);
                let axis = self.graph.apply(other, normal);
                let axis = number.map_or(axis, |number| self.graph.scale(number, axis));
                let turning = self.cross_matrix(axis);
                Some(self.times(left, turning))
            }
            _ => None,
        }
    }

    /// `K` with `K u = left · X(u ⊗ b)ᵀ · r`.
    fn of_transpose(&mut self, X: Expr, left: Option<Expr>, r: Expr) -> Option<Expr> {
        if X == self.variation {
            let image = self.applied(left, self.b);
            return Some(self.graph.outer(image, r));
        }
        match self.graph.node(X).clone() {
            Node::Sum(terms) => self.sum(&terms, |blocks, term| blocks.of_transpose(term, left, r)),
            Node::Scale(number, tensor) if self.varies(number) => {
                let transposed = self.graph.transpose(tensor);
                let image = self.graph.apply(transposed, r);
                Some(self.rank_one(left, image, number))
            }
            Node::Scale(number, tensor) => {
                let r = self.graph.scale(number, r);
                self.of_transpose(tensor, left, r)
            }
            Node::Multiply(A, B) if self.varies(B) => {
                let transposed = self.graph.transpose(A);
                let r = self.graph.apply(transposed, r);
                self.of_transpose(B, left, r)
            }
            Node::Multiply(A, B) => {
                let transposed = self.graph.transpose(B);
                let left = self.times(left, transposed);
                self.of_transpose(A, Some(left), r)
            }
            Node::Transpose(inner) => self.of(inner, left, r),
            _ => None,
        }
    }

    /// `left · v ⊗ c` with `number(u ⊗ b) = c·u`.
    fn rank_one(&mut self, left: Option<Expr>, vector: Expr, number: Expr) -> Expr {
        let slope = self.slope(number);
        let image = self.applied(left, vector);
        self.graph.outer(image, slope)
    }

    fn sum(&mut self, terms: &[Expr], mut of: impl FnMut(&mut Self, Expr) -> Option<Expr>) -> Option<Expr> {
        let blocks: Option<Vec<Expr>> = terms.iter().map(|term| of(self, *term)).collect();
        Some(self.graph.sum(&blocks?))
    }

    fn entries(&mut self, vector: Expr) -> [Expr; 3] {
        [0, 1, 2].map(|index| self.graph.entry(vector, index))
    }

    /// `v × w`.
    fn vector_product(&mut self, v: Expr, w: Expr) -> Expr {
        let (v, w) = (self.entries(v), self.entries(w));
        let entries = [0, 1, 2].map(|i| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            let [first, second] = [(j, k), (k, j)].map(|(j, k)| self.graph.times(v[j], w[k]));
            self.graph.subtract(first, second)
        });
        self.graph.pack(&entries)
    }

    /// The matrix that takes `u` to `w × u`.
    fn cross_matrix(&mut self, w: Expr) -> Expr {
        let [x, y, z] = self.entries(w);
        let zero = self.graph.zero(Shape::Scalar);
        let [mx, my, mz] = [x, y, z].map(|entry| self.graph.negate(entry));
        self.graph.pack(&[zero, z, my, mz, zero, x, y, mx, zero])
    }
}
