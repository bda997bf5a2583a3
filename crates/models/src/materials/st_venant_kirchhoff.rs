//! St. Venant–Kirchhoff elasticity: energy quadratic in Green strain.
//!
//! Cheap, good for large rotations with moderate strain. It softens and then collapses under strong
//! compression (below a stretch of 0.58 along one axis); `neo_hookean` does not.

use souple_table::Entry;

pub use super::derived::st_venant_kirchhoff::StVenantKirchhoff;
use super::{AnyLaw, Build, ISOTROPIC, Material};

pub(super) const ENTRY: Entry<Build> = Entry {
    name: "st_venant_kirchhoff",
    summary: "quadratic in Green strain: cheap, large rotations, moderate strain; weak under compression, and an \
              inverted element is as content as its mirror image: nothing drives it back",
    source: "Sifakis & Barbič 2012, FEM Simulation of 3D Deformable Solids, §3.3",
    parameters: ISOTROPIC,
    build: |values| Material::isotropic(AnyLaw::StVenantKirchhoff, values),
};
