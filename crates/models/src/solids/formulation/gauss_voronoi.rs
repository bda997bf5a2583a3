//! Navier's equation by Gauss' theorem on the cells of points: what flows through a cell's boundary, over the cell.
//!
//! With displacements linear on every simplex `T`, and `β_iT` the sum of the outward area vectors of the part of the boundary of
//! the cell of `i` in `T`,
//!
//! - `flux = "operators"`: `f_i = μ ∫ ∂u/∂n + (λ+μ) Σ_T β_iT (div u)_T`, which is `V_i (μ Δu + (λ+μ) grad div u)`;
//! - `flux = "stress"`: `f_i = Σ_T σ_T β_iT`, the balance of the forces on the cell.
//!
//! Two duals part the body among points. Of `voronoi` cells, clipped by the body, the first integral is a sum over facets,
//! `μ Σ_j S_ij (u_j - u_i)/|ij|`, symmetric with positive weights. The second is not symmetric: `β_iT` and the gradient `α_iT` are
//! parallel only in special tetrahedra. Then no energy stands behind the forces, `M⁻¹K` has eigenvalues off the positive axis,
//! and what is left alone grows, at a rate that no timestep changes. That is the drift which the source reports and could not explain.
//!
//! Of `median` cells, through the middles of edges, faces and tetrahedra, `β_iT = -V_T α_iT` exactly: the forces are those of linear
//! finite elements (`stress`), or of the hybrid operator (`operators`), and symmetric. In two dimensions both duals cut edges in
//! their middles, only those points matter, and the two are one.
//! (Debunne 2000, 4 §1-4; the reason and the cure are the specification's, 2.8.5.)

#![allow(non_snake_case)]

use souple_math::{Mat3, Vec3};
use souple_mesh::{Mesh, VoronoiCells};
use souple_table::{Entry, Parameter, Value, Values};

use super::BuildFormulation;
use super::edge_tensors::in_plane;
use super::pairs::{PairForce, PairSums};
use super::simplices::{LinearBody, Simplex};
use crate::materials::Lame;

const NAME: &str = "gauss_voronoi";

pub(super) const ENTRY: Entry<BuildFormulation> = Entry {
    name: NAME,
    summary: "fluxes through the cells of points, Voronoi's clipped by the body or median ones; the former drift, see the theory",
    source: "Debunne 2000, 4 §1-4",
    parameters: &[
        Parameter::choice(
            "dual",
            &["voronoi", "median"],
            "the cells of points; with median ones there is an energy",
        )
        .or(Value::Text("voronoi")),
        Parameter::choice(
            "flux",
            &["operators", "stress"],
            "what is summed over boundaries: Laplacian and grad div, as the source does, or the stress",
        )
        .or(Value::Text("operators")),
        Parameter::choice("part", &["both", "laplacian", "grad_div"], "one of the two operators alone")
            .or(Value::Text("both")),
    ],
    build: |description, values| {
        let body = LinearBody::of(NAME, description)?;
        let sums = sums(description.mesh, description.material_of_cell, &body, &Choices::of(values));
        Ok(Box::new(PairForce::new(description, &sums)))
    },
};

/// Which cells points have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dual {
    Voronoi,
    Median,
}

/// What flows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Flux {
    Operators,
    Stress,
}

/// What is summed over which boundaries.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Choices {
    pub dual: Dual,
    pub flux: Flux,
    /// Of the Laplacian and of grad div: 1, or 0 where left out.
    pub parts: [f64; 2],
}

impl Choices {
    fn of(values: &Values) -> Self {
        Self {
            dual: if values.text("dual") == "median" { Dual::Median } else { Dual::Voronoi },
            flux: if values.text("flux") == "stress" { Flux::Stress } else { Flux::Operators },
            parts: match values.text("part") {
                "laplacian" => [1.0, 0.0],
                "grad_div" => [0.0, 1.0],
                _ => [1.0, 1.0],
            },
        }
    }
}

/// The matrices of all pairs of a body.
pub fn sums(mesh: &Mesh, material_of_cell: &[u16], body: &LinearBody, choices: &Choices) -> PairSums {
    let moduli = |cell: usize| body.moduli[usize::from(material_of_cell[cell])];
    let mut flow =
        Flow { sums: PairSums::default(), choices, depth: body.depth, dimension: mesh.dimension() };
    match choices.dual {
        Dual::Median => {
            for (cell, simplex) in body.simplices.iter().enumerate() {
                for (point, alpha) in simplex.nodes.iter().zip(&simplex.alpha) {
                    let wall = *alpha * -simplex.measure;
                    flow.through(*point, wall, simplex, moduli(cell));
                    flow.along_gradient(*point, wall, simplex, moduli(cell));
                }
            }
        }
        Dual::Voronoi => {
            // simplices alone come here
            let Some(cells) = VoronoiCells::of(mesh) else { return flow.sums };
            for wall in &cells.walls {
                let cell = wall.element as usize;
                flow.through(wall.point, wall.area, &body.simplices[cell], moduli(cell));
            }
            for ([i, j], share, mu) in shared_facets(&cells, body, &moduli) {
                let apart = (mesh.points[j as usize] - mesh.points[i as usize]).length();
                let block = flow.scalar(choices.parts[0] * mu * share / apart);
                flow.sums.add(i, j, block);
                flow.sums.add(j, i, block);
            }
        }
    }
    flow.sums
}

/// Facets with the shear modulus there: that of the simplices around both of their points, by volume.
fn shared_facets(
    cells: &VoronoiCells,
    body: &LinearBody,
    moduli: &impl Fn(usize) -> Lame,
) -> Vec<([u32; 2], f64, f64)> {
    let mut around = vec![[0.0; 2]; cells.volumes.len()];
    for (cell, simplex) in body.simplices.iter().enumerate() {
        for node in &simplex.nodes {
            let [stiffness, volume] = &mut around[*node as usize];
            *stiffness += moduli(cell).mu * simplex.measure;
            *volume += simplex.measure;
        }
    }
    let mean = |ends: [u32; 2]| {
        let [a, b] = ends.map(|end| around[end as usize]);
        (a[0] + b[0]) / (a[1] + b[1])
    };
    cells.facets.iter().map(|(ends, area)| (*ends, *area, mean(*ends))).collect()
}

struct Flow<'a> {
    sums: PairSums,
    choices: &'a Choices,
    depth: f64,
    dimension: usize,
}

impl Flow<'_> {
    /// `s I`, of which nothing acts across a plane body.
    fn scalar(&self, s: f64) -> Mat3 {
        in_plane(Mat3::IDENTITY * (s * self.depth), self.dimension)
    }

    fn add(&mut self, point: u32, simplex: &Simplex, block: impl Fn(Vec3) -> Mat3) {
        for (other, alpha) in simplex.nodes.iter().zip(&simplex.alpha).filter(|(other, _)| **other != point) {
            let block = in_plane(block(*alpha) * self.depth, self.dimension);
            self.sums.add(point, *other, block);
        }
    }

    /// What goes through a wall but for the gradient along its normal: `(λ+μ) β div u`, or `λ β div u + μ (grad u)ᵀ β`.
    fn through(&mut self, point: u32, wall: Vec3, simplex: &Simplex, Lame { mu, lambda }: Lame) {
        let weight = self.choices.parts[1];
        match self.choices.flux {
            Flux::Operators => self.add(point, simplex, |alpha| wall.outer(alpha) * (weight * (lambda + mu))),
            Flux::Stress => self
                .add(point, simplex, |alpha| (wall.outer(alpha) * lambda + alpha.outer(wall) * mu) * weight),
        }
    }

    /// `μ (grad u) β`.
    fn along_gradient(&mut self, point: u32, wall: Vec3, simplex: &Simplex, Lame { mu, .. }: Lame) {
        let weight = self.choices.parts[0] * mu;
        self.add(point, simplex, |alpha| Mat3::IDENTITY * (weight * alpha.dot(wall)));
    }
}
