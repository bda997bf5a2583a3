//! Particles that know their neighbours and no mesh: Navier's equation point by point (model A of Debunne 2000).
//!
//! - `operators`: second derivatives from the values at neighbours;
//! - `formulation`: forces of a body of one resolution, by these or by the energy of gradients that fit neighbours;
//! - `friction`: of each particle against its neighbours;
//! - `octree`: particles of several levels, of which at each place one is at work.

mod formulation;
mod friction;
pub mod octree;
mod operators;

pub(crate) use formulation::ENTRY;
pub use friction::{FrictionFilter, NeighbourFriction};
pub use operators::{Coefficient, Operators, gradient_weights};

use std::collections::BTreeSet;

use souple_mesh::Mesh;

/// Points that share a cell, of each point, ascending.
pub fn neighbours(mesh: &Mesh) -> Vec<Vec<u32>> {
    let mut found = vec![BTreeSet::new(); mesh.points.len()];
    for cell in mesh.cells() {
        for a in cell.nodes {
            found[*a as usize].extend(cell.nodes.iter().copied().filter(|b| b != a));
        }
    }
    found.into_iter().map(|own| own.into_iter().collect()).collect()
}
