//! Linear finite elements with one matrix on every edge, and the same with the scalar Laplacian.
//!
//! With `V` the volume of a tetrahedron and `α_i` the gradients of its shape functions, Hooke's law is
//! `K_ij = Σ_T V (μ T_Δ + (λ+μ) T_gd)` with `T_gd = α_i α_jᵀ` for `grad div` and `T_Δ = (α_i·α_j) I + α_j α_iᵀ - α_i α_jᵀ` for the
//! Laplacian. The off-diagonal part of `T_Δ` is a cross product, `V α_i × α_j = ± e_kl/6` with the opposite edge; around an inner edge
//! the opposite edges close, and it cancels. `hybrid` leaves it out everywhere: inside it is the same operator, at the border it has
//! the natural condition `μ ∂u/∂n + (λ+μ) (div u) n = 0` in the place of no stress, for its energy is
//! `½ μ |grad u|² + ½ (λ+μ) (div u)²`. It resists turning, has translations alone as rigid motions, and moves in pure shears.
//! (Cotin, Delingette & Ayache 1999; Debunne 2000, 4 §5-6.)

#![allow(non_snake_case)]

use souple_math::Mat3;
use souple_table::Entry;

use super::pairs::{PairForce, PairSums};
use super::simplices::{LinearBody, Simplex};
use super::{BuildFormulation, FormulationError};
use crate::materials::Lame;
use crate::solids::SolidDescription;

const EDGE_TENSORS: &str = "edge_tensors";
const HYBRID: &str = "hybrid";

pub(super) const ENTRY: Entry<BuildFormulation> = Entry {
    name: EDGE_TENSORS,
    summary: "one matrix on every edge of linear tetrahedra, or of triangles in plane strain: exact for the linear law",
    source: "Cotin, Delingette & Ayache 1999; Debunne 2000, 4 §5.2",
    parameters: &[],
    build: |description, _| build(EDGE_TENSORS, description, elastic),
};

pub(super) const HYBRID_ENTRY: Entry<BuildFormulation> = Entry {
    name: HYBRID,
    summary: "the same with a scalar Laplacian: moves alike on all meshes, in shears alone; resists being turned",
    source: "Debunne 2000, 4 §6",
    parameters: &[],
    build: |description, _| build(HYBRID, description, hybrid),
};

/// `K_ij/V` of a simplex.
pub type Stiffness = fn(&Simplex, usize, usize, Lame) -> Mat3;

/// `μ ((α_i·α_j) I + α_j α_iᵀ) + λ α_i α_jᵀ`.
pub fn elastic(of: &Simplex, i: usize, j: usize, Lame { mu, lambda }: Lame) -> Mat3 {
    let (a, b) = (of.alpha[i], of.alpha[j]);
    (b.outer(a) * mu + a.outer(b) * lambda).plus_diagonal(mu * a.dot(b))
}

/// `μ (α_i·α_j) I + (λ+μ) α_i α_jᵀ`.
pub fn hybrid(of: &Simplex, i: usize, j: usize, Lame { mu, lambda }: Lame) -> Mat3 {
    let (a, b) = (of.alpha[i], of.alpha[j]);
    (a.outer(b) * (lambda + mu)).plus_diagonal(mu * a.dot(b))
}

fn build(
    name: &'static str,
    description: &SolidDescription,
    stiffness: Stiffness,
) -> Result<Box<dyn souple_engine::Force>, FormulationError> {
    let body = LinearBody::of(name, description)?;
    let mut sums = PairSums::default();
    for (simplex, material) in body.simplices.iter().zip(description.material_of_cell) {
        add(
            &mut sums,
            simplex,
            body.moduli[usize::from(*material)],
            body.depth,
            stiffness,
            description.mesh.dimension(),
        );
    }
    Ok(Box::new(PairForce::new(description, &sums)))
}

/// Adds a simplex; nothing acts across a plane body.
pub fn add(
    sums: &mut PairSums,
    simplex: &Simplex,
    moduli: Lame,
    depth: f64,
    stiffness: Stiffness,
    dimension: usize,
) {
    for i in 0..simplex.nodes.len() {
        for j in (0..simplex.nodes.len()).filter(|j| *j != i) {
            let K = stiffness(simplex, i, j, moduli) * (simplex.measure * depth);
            sums.add(simplex.nodes[i], simplex.nodes[j], in_plane(-K, dimension));
        }
    }
}

/// Without rows and columns across the plane of a body of two dimensions.
pub fn in_plane(mut block: Mat3, dimension: usize) -> Mat3 {
    if dimension < 3 {
        block.columns[2] = souple_math::Vec3::ZERO;
        block.columns.iter_mut().for_each(|column| column.z = 0.0);
    }
    block
}
