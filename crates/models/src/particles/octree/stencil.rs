//! The force of one particle and its neighbours, as the operators of this room have it.

#![allow(non_snake_case)]

use souple_math::{Mat3, Vec3};

use super::OctreeOperators;
use crate::materials::Lame;
use crate::particles::operators::{Operators, gradient_weights, least_gradient_weights};

/// A particle with its neighbours.
#[derive(Clone, Debug)]
pub struct Stencil {
    pub neighbours: Vec<u32>,
    /// What each neighbour's relative displacement does to the particle [N/m]; of an energy none.
    blocks: Vec<Mat3>,
    /// Weights of neighbours in the gradient that fits them; none where they do not tell one.
    gradients: Vec<Vec3>,
    /// The same for the criterion, as far as they tell one.
    slopes: Vec<Vec3>,
    /// Arms at rest [m].
    arms: Vec<Vec3>,
    /// What holds that part of displacements which gradients do not see [N/m].
    holds: Vec<f64>,
    /// Weights of neighbours in the Laplacian [1/m²].
    laplacian: Vec<f64>,
    volume: f64,
    moduli: Lame,
}

impl Default for Stencil {
    fn default() -> Self {
        Self {
            neighbours: Vec::new(),
            blocks: Vec::new(),
            gradients: Vec::new(),
            slopes: Vec::new(),
            arms: Vec::new(),
            holds: Vec::new(),
            laplacian: Vec::new(),
            volume: 0.0,
            moduli: Lame { mu: 0.0, lambda: 0.0 },
        }
    }
}

impl Stencil {
    /// Takes other neighbours.
    pub fn set(
        &mut self,
        operators: OctreeOperators,
        neighbours: impl Iterator<Item = u32>,
        particle: usize,
        rest: &[Vec3],
        (volume, moduli): (f64, Lame),
    ) {
        self.neighbours.clear();
        self.neighbours.extend(neighbours);
        self.arms.clear();
        self.arms.extend(self.neighbours.iter().map(|other| rest[*other as usize] - rest[particle]));
        (self.volume, self.moduli) = (volume, moduli);
        self.blocks.clear();
        self.holds.clear();
        self.gradients.clear();
        self.gradients.extend(gradient_weights(&self.arms, 3).into_iter().flatten());
        self.slopes.clear();
        if self.gradients.is_empty() {
            self.slopes.extend(least_gradient_weights(&self.arms));
        } else {
            self.slopes.extend_from_slice(&self.gradients);
        }
        self.laplacian.clear();
        let laplacian = Operators::Corrected.of(&self.arms, 3);
        self.laplacian.extend(laplacian.into_iter().flatten().map(|coefficient| coefficient.laplacian));
        let Lame { mu, lambda } = moduli;
        match operators {
            OctreeOperators::Strong(wanted) => {
                // where the arms do not tell second derivatives, those along the arms
                let told = wanted.of(&self.arms, 3).or_else(|| Operators::Legacy.of(&self.arms, 3));
                self.blocks.extend(told.into_iter().flatten().map(|coefficient| {
                    (coefficient.grad_div * (lambda + mu)).plus_diagonal(mu * coefficient.laplacian) * volume
                }));
            }
            OctreeOperators::Energy if self.gradients.is_empty() => {
                // in a plane or on a line: along the arms, half from either end
                let total: f64 = self.arms.iter().map(|arm| arm.length()).sum();
                self.blocks.extend(self.arms.iter().map(|arm| {
                    let length = arm.length();
                    let n = *arm * (1.0 / length);
                    (n.outer(n) * (lambda + mu)).plus_diagonal(mu) * (volume / (total * length))
                }));
            }
            OctreeOperators::Energy => {
                let total: f64 = self.arms.iter().map(|arm| 1.0 / arm.length_sq()).sum();
                self.holds.extend(self.arms.iter().map(|arm| {
                    let inverse = 1.0 / arm.length_sq();
                    mu * volume * inverse * inverse / total
                }));
            }
        }
    }

    /// Leaves out neighbours, and what they do; the others do what they did.
    pub fn keep(&mut self, is_kept: impl Fn(u32) -> bool) {
        let kept: Vec<bool> = self.neighbours.iter().map(|other| is_kept(*other)).collect();
        let mut at = kept.iter();
        self.blocks.retain(|_| at.next() == Some(&true));
        let mut at = kept.iter();
        self.neighbours.retain(|_| at.next() == Some(&true));
        let mut at = kept.iter();
        self.arms.retain(|_| at.next() == Some(&true));
        let mut at = kept.iter();
        self.gradients.retain(|_| at.next() == Some(&true));
        let mut at = kept.iter();
        self.slopes.retain(|_| at.next() == Some(&true));
        let mut at = kept.iter();
        self.laplacian.retain(|_| at.next() == Some(&true));
    }

    pub fn bytes(&self) -> usize {
        4 * self.neighbours.capacity()
            + 72 * self.blocks.capacity()
            + 24 * (self.gradients.capacity() + self.slopes.capacity() + self.arms.capacity())
            + 8 * (self.holds.capacity() + self.laplacian.capacity())
    }

    /// `G = Σ (u_j - u_i) ⊗ g_j`.
    fn gradient(&self, weights: &[Vec3], relative: impl Fn(u32) -> Vec3) -> Mat3 {
        let mut G = Mat3::ZERO;
        for (other, g) in self.neighbours.iter().zip(weights) {
            G += relative(*other).outer(*g);
        }
        G
    }

    /// Calls `push` with what acts on whom; `relative` are displacements of neighbours against the particle.
    ///
    /// `particle` is pushed by all of it; of an energy neighbours are pushed back.
    pub fn push(
        &self,
        operators: OctreeOperators,
        particle: u32,
        relative: impl Fn(u32) -> Vec3,
        mut push: impl FnMut(u32, Vec3),
    ) {
        if let OctreeOperators::Strong(_) = operators {
            let sum = self
                .neighbours
                .iter()
                .zip(&self.blocks)
                .map(|(other, block)| *block * relative(*other))
                .sum();
            return push(particle, sum);
        }
        if self.holds.is_empty() {
            for (other, block) in self.neighbours.iter().zip(&self.blocks) {
                let f = *block * relative(*other);
                push(particle, f);
                push(*other, -f);
            }
            return;
        }
        let G = self.gradient(&self.gradients, &relative);
        let Lame { mu, lambda } = self.moduli;
        // σ V less Σ c_j r_j ⊗ l_j, with r_j = d_j - G l_j
        let strain = G.symmetric_part();
        let mut S = (strain * (2.0 * mu)).plus_diagonal(lambda * strain.trace()) * self.volume;
        let residual = |at: usize| relative(self.neighbours[at]) - G * self.arms[at];
        for (at, hold) in self.holds.iter().enumerate() {
            S += (residual(at) * -*hold).outer(self.arms[at]);
        }
        for (at, other) in self.neighbours.iter().enumerate() {
            let f = S * self.gradients[at] + residual(at) * self.holds[at];
            push(*other, -f);
            push(particle, f);
        }
    }

    /// Stored energy [J].
    pub fn energy(&self, operators: OctreeOperators, own: Vec3, relative: impl Fn(u32) -> Vec3) -> f64 {
        if let OctreeOperators::Strong(_) = operators {
            let force: Vec3 = self
                .neighbours
                .iter()
                .zip(&self.blocks)
                .map(|(other, block)| *block * relative(*other))
                .sum();
            return -0.5 * own.dot(force);
        }
        if self.holds.is_empty() {
            let of = |(other, block): (&u32, &Mat3)| 0.5 * relative(*other).dot(*block * relative(*other));
            return self.neighbours.iter().zip(&self.blocks).map(of).sum();
        }
        let G = self.gradient(&self.gradients, &relative);
        let strain = G.symmetric_part();
        let Lame { mu, lambda } = self.moduli;
        let held: f64 = (0..self.holds.len())
            .map(|at| {
                let residual = relative(self.neighbours[at]) - G * self.arms[at];
                0.5 * self.holds[at] * residual.length_sq()
            })
            .sum();
        held + self.volume * (mu * strain.dot(&strain) + 0.5 * lambda * strain.trace().powi(2))
    }

    /// `|∇u|`, as far as neighbours tell it.
    pub fn slope(&self, relative: impl Fn(u32) -> Vec3) -> f64 {
        let G = self.gradient(&self.slopes, relative);
        G.dot(&G).sqrt()
    }

    /// `|Δu|` less what the mean gradient gives on a set that leans to one side [1/m]; zero of every affine motion.
    pub fn variation(&self, relative: impl Fn(u32) -> Vec3) -> f64 {
        let G = self.gradient(&self.slopes, &relative);
        let part = |at: usize| (relative(self.neighbours[at]) - G * self.arms[at]) * self.laplacian[at];
        (0..self.neighbours.len()).map(part).sum::<Vec3>().length()
    }
}
