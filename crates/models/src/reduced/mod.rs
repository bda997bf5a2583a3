//! Bodies that move in few unknowns.
//!
//! *Polynomials* are Witkin and Welch's (1990): `x = R Z(P)` with the terms `Z = (1, u, v, w)` or `(1, u, v, w, uv, uw, vw, u², v², w²)` of where
//! matter rests and 12 or 30 numbers `R`, any law, strains of any size.
//!
//! *Modes* are a floating frame and a deformation seen from it, `x = c + R (s + d)`.
//! The deformation is a sum of natural modes, `d = Σ u_i φ_i`, of a body of finite elements: Pentland and Williams's (1989), and in the
//! frame of a body that turns that of flexible multibody dynamics. With `Kφ = ω² M φ` and `φ·Mφ = 1` each amplitude is an oscillator of its
//! own, `ü + z u̇ + ω² u = f`: unknowns, masses and stiffness are as many as modes, whatever the mesh. Strains are small, whatever the turn: the law
//! is the body's own as it is at rest.
//!
//! Points of the body's mesh are rows over those of the frame and of its modes, with weights that never change (see
//! `souple_engine::kinematics`), so that loads, contacts and attachments act on them as on those of any other body. Masses of
//! points become masses between those rows: what turning and swinging do to each other (centrifugal and Coriolis forces, the inertia that a
//! bent body has) is all in them.

mod modal;
mod polynomial;
mod shapes;

use souple_engine::Mass;
use souple_math::Vec3;

pub use modal::{ModalDamping, ModalStiffness};
pub use polynomial::{Degree, Polynomial, PolynomialDescription, PolynomialForce};
pub use shapes::{GLOBAL_DEFORMATIONS, GlobalDeformation, monomials};

/// Rows of the frame itself: its origin and its axes. Those of the modes follow, three each.
const ROWS_OF_FRAME: usize = 4;

/// Natural modes of a body about a place in it.
#[derive(Clone, Debug, PartialEq)]
pub struct ModalBasis {
    /// The origin of the frame, where the body rests [m]; the frame has the axes of the world there.
    pub centre: Vec3,
    /// Of each point of the mesh at rest, from the centre [m].
    arms: Vec<Vec3>,
    /// `φ_i` of each mode at each point [1/√kg].
    shapes: Vec<Vec<Vec3>>,
    /// `ω_i²` [1/s²].
    eigenvalues: Vec<f64>,
}

/// Which masses between rows count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coupling {
    /// All: the frame may turn.
    All,
    /// None between different modes: they swing without each other where the frame stays at rest, `Σ_p m_p φ_i·φ_j = 0`. That is the trace
    /// of what is left out: the rest of it, `Σ_p m_p φ_i×φ_j`, is seen by frames that turn, and by angular momentum.
    OfOneMode,
}

impl ModalBasis {
    /// From the points of a mesh at rest, the shapes there and `ω²` of each.
    pub fn new(centre: Vec3, points: &[Vec3], shapes: Vec<Vec<Vec3>>, eigenvalues: Vec<f64>) -> Self {
        let arms = points.iter().map(|point| *point - centre).collect();
        Self { centre, arms, shapes, eigenvalues }
    }

    pub fn mode_count(&self) -> usize {
        self.shapes.len()
    }

    /// `ω_i²` [1/s²].
    pub fn eigenvalues(&self) -> &[f64] {
        &self.eigenvalues
    }

    /// Weights of a point over the rows of the frame and its modes, `(1, s, φ_1, φ_2, …)`.
    pub fn weights(&self, point: usize) -> impl Iterator<Item = f64> + '_ {
        let of_modes = self.shapes.iter().flat_map(move |shape| shape[point].to_array());
        std::iter::once(1.0).chain(self.arms[point].to_array()).chain(of_modes)
    }

    /// `Σ_q m_pq φ_i(q)` of each mode, and its moment about the centre: what the mode has of a motion of the whole, `φ_i·M v`.
    pub fn momenta(&self, of_points: &Mass) -> Vec<[Vec3; 2]> {
        let of_mode = |shape: &Vec<Vec3>| {
            let mut sums = [Vec3::ZERO; 2];
            let mut add = |at: usize, of: usize, m: f64| {
                sums[0] += shape[of] * m;
                sums[1] += self.arms[at].cross(shape[of] * m);
            };
            of_points.diagonal.iter().enumerate().for_each(|(point, m)| add(point, point, *m));
            for &(a, b, m) in &of_points.couplings {
                add(a as usize, b as usize, m);
                add(b as usize, a as usize, m);
            }
            sums
        };
        self.shapes.iter().map(of_mode).collect()
    }

    /// Adds the mass of the points to that over the rows from `first_row` on, `M_ab = Σ_pq m_pq W_pa W_qb`: their kinetic energy, exactly.
    pub fn add_mass(&self, of_points: &Mass, coupling: Coupling, first_row: u32, mass: &mut Mass) {
        let count = ROWS_OF_FRAME + 3 * self.mode_count();
        let weights: Vec<Vec<f64>> =
            (0..self.arms.len()).map(|point| self.weights(point).collect()).collect();
        // M W
        let mut products = vec![vec![0.0; count]; self.arms.len()];
        let mut add = |a: usize, b: usize, m: f64| {
            products[a].iter_mut().zip(&weights[b]).for_each(|(sum, weight)| *sum += m * weight);
        };
        of_points.diagonal.iter().enumerate().for_each(|(point, m)| add(point, point, *m));
        for &(a, b, m) in &of_points.couplings {
            add(a as usize, b as usize, m);
            add(b as usize, a as usize, m);
        }
        let mode_of = |row: usize| row.checked_sub(ROWS_OF_FRAME).map(|row| row / 3);
        let counts = |a: usize, b: usize| match (coupling, mode_of(a), mode_of(b)) {
            (Coupling::OfOneMode, Some(a), Some(b)) => a == b,
            _ => true,
        };
        for a in 0..count {
            for b in (a..count).filter(|b| counts(a, *b)) {
                let sum: f64 = weights.iter().zip(&products).map(|(w, product)| w[a] * product[b]).sum();
                mass.add(first_row + a as u32, first_row + b as u32, sum);
            }
        }
    }
}
