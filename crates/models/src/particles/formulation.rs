//! A body as particles of one resolution: `f_i = V_i (μ Δu + (λ+μ) grad div u)` from its neighbours, the points that share a cell.
//!
//! The source's operators have no boundary of their own: what is missing around a particle at the surface is just not summed. The
//! legacy pair is a positive weight on every arm, `f_i = 2 V_i/Σl Σ (μ + (λ+μ) n nᵀ)(u_j - u_i)/l`, and so it is stable everywhere. The
//! corrected pair has the energy density `½ μ |grad u|² + ¼ (λ+μ) ((div u)² + grad u : grad uᵀ)`, the same equation inside, but below
//! zero for turns when `λ > μ`: such a body runs away from its free surface. One-sided least squares have no energy at all.
//!
//! `energy` has one by construction: each particle's gradient is the one that fits its neighbours best, `G_i = Σ (u_j - u_i) ⊗ g_ij`, and
//! `E = Σ V_i (ψ(G_i) + ½ μ Σ_j w_j |(u_j - u_i)/l - G_i n|²)` with Hooke's `ψ`. The second term, with `w ∝ 1/l²` of sum one, holds what
//! gradients do not see, and falls with the square of the spacing. Momentum is kept, and there is no stress at a free surface.

#![allow(non_snake_case)]

use std::collections::BTreeSet;

use souple_engine::Mass;
use souple_math::{Mat3, Vec3};
use souple_mesh::Mesh;
use souple_table::{Entry, Parameter, Value, Values};

use super::operators::{Operators, gradient_weights};
use crate::materials::Lame;
use crate::solids::linear_pairs::{
    PairForce, PairSums, Simplex, add_simplex, depth_of, elastic, in_plane, linear_moduli,
};
use crate::solids::{BuildFormulation, FormulationError, SolidDescription, lumped_mass, uniform_mass};

const NAME: &str = "particles";

pub(crate) const ENTRY: Entry<BuildFormulation> = Entry {
    name: NAME,
    summary: "second derivatives from the points that share a cell, or gradients that fit them; linear law, any cells",
    source: "Debunne 2000, 3 §1-3; energy: own",
    parameters: &[
        Parameter::choice(
            "operators",
            &["legacy", "corrected", "least_squares", "energy"],
            "the source's, the same made exact where directions are even, exact everywhere, or with an energy",
        )
        .or(Value::Text("energy")),
        Parameter::choice("volumes", &["lumped", "uniform"], "what of the body is whose; as the body's `mass`")
            .or(Value::Text("lumped")),
    ],
    build: |description, values| Ok(Box::new(build(description, values)?)),
};

/// Rings around a point where those that share a cell with it do not tell enough.
const MOST_RINGS: usize = 3;

fn build(description: &SolidDescription, values: &Values) -> Result<PairForce, FormulationError> {
    let depth = depth_of(NAME, description)?.unwrap_or(1.0);
    let moduli = linear_moduli(NAME, description)?;
    let mesh = description.mesh;
    let volumes = volumes(mesh, depth, values.text("volumes") == "uniform");
    let moduli = point_moduli(description, &moduli);
    let around = super::neighbours(mesh);
    let operators = match values.text("operators") {
        "legacy" => Some(Operators::Legacy),
        "corrected" => Some(Operators::Corrected),
        "least_squares" => Some(Operators::LeastSquares),
        _ => None,
    };
    let mut sums = PairSums::default();
    for point in (0..mesh.points.len() as u32).filter(|point| !around[*point as usize].is_empty()) {
        let own = Particle { point, volume: volumes[point as usize], moduli: moduli[point as usize] };
        match operators {
            Some(operators) => own.add_operators(operators, mesh, &around, &mut sums)?,
            None => own.add_energy(mesh, &around, &mut sums)?,
        }
    }
    Ok(PairForce::new(description, &sums))
}

/// What of the body each point stands for [m³].
fn volumes(mesh: &Mesh, depth: f64, is_uniform: bool) -> Vec<f64> {
    let mut mass = Mass::new(mesh.points.len());
    let spread = if is_uniform { uniform_mass } else { lumped_mass };
    spread(mesh, 0, &|_| depth, &mut mass);
    mass.diagonal
}

/// The mean of the cells around each point.
fn point_moduli(description: &SolidDescription, moduli: &[Lame]) -> Vec<Lame> {
    let mut sums = vec![(0.0, Lame { mu: 0.0, lambda: 0.0 }); description.mesh.points.len()];
    for (cell, material) in description.mesh.cells().zip(description.material_of_cell) {
        let Lame { mu, lambda } = moduli[usize::from(*material)];
        for node in cell.nodes {
            let (count, sum) = &mut sums[*node as usize];
            *count += 1.0;
            sum.mu += mu;
            sum.lambda += lambda;
        }
    }
    sums.into_iter()
        .map(|(count, sum)| Lame {
            mu: sum.mu / f64::max(count, 1.0),
            lambda: sum.lambda / f64::max(count, 1.0),
        })
        .collect()
}

/// A particle and what it stands for.
struct Particle {
    point: u32,
    /// [m³]
    volume: f64,
    moduli: Lame,
}

impl Particle {
    /// Answers from the neighbours, from more rings of them where these do not tell enough.
    fn ask_rings<T>(
        &self,
        mesh: &Mesh,
        around: &[Vec<u32>],
        answer: impl Fn(&[Vec3]) -> Option<T>,
    ) -> Result<(Vec<u32>, Vec<Vec3>, T), FormulationError> {
        let mut reached: BTreeSet<u32> = around[self.point as usize].iter().copied().collect();
        let mut ring = 1;
        loop {
            let origin = mesh.points[self.point as usize];
            let arms: Vec<Vec3> = reached.iter().map(|other| mesh.points[*other as usize] - origin).collect();
            if let Some(found) = answer(&arms) {
                return Ok((reached.into_iter().collect(), arms, found));
            }
            if ring == MOST_RINGS {
                return Err(FormulationError::Neighbours { point: self.point, count: reached.len() });
            }
            let next: Vec<u32> =
                reached.iter().flat_map(|other| around[*other as usize].iter().copied()).collect();
            reached.extend(next.into_iter().filter(|other| *other != self.point));
            ring += 1;
        }
    }

    fn add_operators(
        &self,
        operators: Operators,
        mesh: &Mesh,
        around: &[Vec<u32>],
        sums: &mut PairSums,
    ) -> Result<(), FormulationError> {
        let dimension = mesh.dimension();
        let (others, _, coefficients) = self.ask_rings(mesh, around, |arms| operators.of(arms, dimension))?;
        let Lame { mu, lambda } = self.moduli;
        for (other, coefficient) in others.into_iter().zip(coefficients) {
            let block = (coefficient.grad_div * (lambda + mu)).plus_diagonal(mu * coefficient.laplacian);
            sums.add(self.point, other, in_plane(block * self.volume, dimension));
        }
        Ok(())
    }

    fn add_energy(
        &self,
        mesh: &Mesh,
        around: &[Vec<u32>],
        sums: &mut PairSums,
    ) -> Result<(), FormulationError> {
        let dimension = mesh.dimension();
        let (others, arms, gradients) =
            self.ask_rings(mesh, around, |arms| gradient_weights(arms, dimension))?;
        // the particle and its neighbours as one element with a constant gradient
        let own = -gradients.iter().copied().sum::<Vec3>();
        let stencil = Simplex {
            nodes: std::iter::once(self.point).chain(others).collect(),
            alpha: std::iter::once(own).chain(gradients).collect(),
            measure: self.volume,
        };
        add_simplex(sums, &stencil, self.moduli, 1.0, elastic, dimension);
        let share = self.moduli.mu * self.volume / arms.iter().map(|arm| 1.0 / arm.length_sq()).sum::<f64>();
        for (neighbour, arm) in arms.iter().enumerate() {
            // (u_j - u_i)/l - G n, a weighted sum over the element
            let length = arm.length();
            let weight = share / (length * length);
            let of = |node: usize| {
                let plain = if node == 0 { -1.0 } else { f64::from(u8::from(node == neighbour + 1)) };
                (plain - stencil.alpha[node].dot(*arm)) / length
            };
            let weights: Vec<f64> = (0..stencil.nodes.len()).map(of).collect();
            for (a, by) in weights.iter().enumerate() {
                for b in (0..weights.len()).filter(|b| *b != a) {
                    let block = Mat3::IDENTITY * (-weight * by * weights[b]);
                    sums.add(stencil.nodes[a], stencil.nodes[b], in_plane(block, dimension));
                }
            }
        }
        Ok(())
    }
}
