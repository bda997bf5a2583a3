//! Linear elasticity of small strain.
//!
//! The reference of analytic solutions, and the cheapest law: its stiffness is constant. A rotation counts as
//! strain (by `1 - cos` of the angle), so bodies that turn grow; `corotational` does not.

use souple_table::Entry;

pub use super::derived::linear::Linear;
use super::{AnyLaw, Build, ISOTROPIC, Material};

pub(super) const ENTRY: Entry<Build> = Entry {
    name: "linear",
    summary: "small strain: constant stiffness, exact only for small rotations; an inverted element is driven back \
              by a force linear in its displacement",
    source: "Love 1892, A Treatise on the Mathematical Theory of Elasticity",
    parameters: ISOTROPIC,
    build: |values| Material::isotropic(AnyLaw::Linear, values),
};
