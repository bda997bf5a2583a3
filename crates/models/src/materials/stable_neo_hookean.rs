//! Stable neo-Hookean elasticity: a polynomial in the volume instead of a logarithm.
//!
//! Made for animation and contact: smooth and finite for every deformation, and an element that was flattened
//! or turned inside out finds back. Under strong compression it is softer than `neo_hookean`, whose energy
//! grows without bound.

use souple_table::Entry;

pub use super::derived::stable_neo_hookean::StableNeoHookean;
use super::{AnyLaw, Build, ISOTROPIC, Material};

pub(super) const ENTRY: Entry<Build> = Entry {
    name: "stable_neo_hookean",
    summary: "for large strain, contact and animation: smooth for every deformation; a flat or inverted element is \
              pushed back with bounded stiffness, one shrunk to a line or point balances there, unstably",
    source: "Smith, de Goes & Kim 2018, Stable Neo-Hookean Flesh Simulation, eq. 14 and §3.4",
    parameters: ISOTROPIC,
    build: |values| Material::isotropic(AnyLaw::StableNeoHookean, values),
};
