//! Neo-Hookean elasticity in its logarithmic form: the textbook law of rubber and soft tissue.
//!
//! Resists compression without bound down to a twentieth of the rest volume. Below that the logarithm goes on
//! as a parabola, so that an inverted element has a finite force that turns it back; where elements invert as
//! a matter of course, `stable_neo_hookean` gives a softer, better conditioned way home.
//!
//! For a negative Poisson ratio (`λ < 0`) the law itself gives way below the volume ratio `J = exp(μ/λ)`, 0.14 at
//! `ν = -0.5`: what is compressed further, collapses. `stable_neo_hookean` still pushes back there.

use souple_table::Entry;

pub use super::derived::neo_hookean::NeoHookean;
use super::{AnyLaw, Build, ISOTROPIC, Material};

pub(super) const ENTRY: Entry<Build> = Entry {
    name: "neo_hookean",
    summary: "logarithmic form, for large strain; below 5 % of the rest volume ln J goes on as its Taylor polynomial \
              of degree two: flat and inverted elements stay finite and are pushed back, stiffly (not for a \
              negative Poisson ratio); one shrunk to a line or point feels no push from its volume",
    source: "Bonet & Wood 2008, Nonlinear Continuum Mechanics for Finite Element Analysis, §6.4.3",
    parameters: ISOTROPIC,
    build: |values| Material::isotropic(AnyLaw::NeoHookean, values),
};
