//! Bodies of a polynomial: their points become rows over its terms.

use std::ops::Range;

use souple_engine::{DerivedRow, Feedback, Force, Kinematics, Mass, UnknownKind};
use souple_math::Vec3;
use souple_models::frames::samples_of_cells;
use souple_models::reduced::{Polynomial, PolynomialDescription, PolynomialForce};
use souple_models::solids::{Quadrature, Section};

use super::Draft;
use super::bodies::{Placed, solid_name};
use crate::diagnostic::{Code, Site};
use crate::spec::body::MassKind;

/// The polynomial of a body.
pub struct PlacedPolynomial {
    polynomial: Polynomial,
    /// Row of the constant term.
    first_row: usize,
}

/// Strains are linear, and energies of laws that are so too quadratic.
const DEGREE_OF_ENERGY: usize = 2;
/// Of products of two quadratic terms.
const DEGREE_OF_MASS: usize = 4;

impl PlacedPolynomial {
    pub fn kind(&self) -> UnknownKind {
        self.polynomial.degree.kind()
    }

    pub fn give_rows(&mut self, first: usize) {
        self.first_row = first;
    }

    /// Rows of the terms, which have the body's mass.
    pub fn row_range(&self) -> Range<usize> {
        self.first_row..self.first_row + self.kind().row_count()
    }

    /// The configuration at rest, as rows.
    pub fn configuration(&self) -> impl Iterator<Item = Vec3> {
        self.polynomial.rest()
    }

    /// Appends the points of the mesh to the rows.
    pub fn add_points(&self, points: &[Vec3], kinematics: &mut Kinematics) {
        for point in points {
            let weights = (self.first_row as u32..).zip(self.polynomial.terms(*point));
            let parents = weights.filter(|(_, weight)| *weight != 0.0).collect();
            let row = DerivedRow { parents, feedback: Feedback::Transpose };
            // weights are finite, and terms come before points
            kinematics.add_derived_row(row).unwrap_or_else(|error| unreachable!("{error}"));
        }
    }

    /// Adds the mass of the body's matter.
    pub fn add_mass(&self, body: &Placed, mass: &mut Mass) {
        let degrees = [DEGREE_OF_MASS, DEGREE_OF_MASS - 1, DEGREE_OF_ENERGY];
        let kinds = || body.mesh.blocks.iter().map(|block| block.kind);
        let has = |degree: &usize| kinds().all(|kind| kind.rule_of_degree(*degree).is_some());
        let samples = samples_of_cells(&body.mesh, degrees.into_iter().find(has));
        let weighted = samples
            .iter()
            .map(|sample| (sample.position, sample.volume * body.materials.of(sample.cell as usize).density));
        self.polynomial.add_mass(weighted, self.first_row as u32, mass);
    }

    /// The elastic force of the body.
    pub fn force(&self, body: &Placed) -> Box<dyn Force> {
        Box::new(PolynomialForce::new(&PolynomialDescription {
            name: solid_name(&body.spec.name),
            polynomial: self.polynomial,
            first_row: self.first_row as u32,
            samples: &samples_of_cells(&body.mesh, Some(DEGREE_OF_ENERGY)),
            materials: &body.materials.all,
            material_of_cell: &body.materials.of_cell,
            axes: &body.axes,
        }))
    }

    /// Velocity blocks of a motion `v + ω × (x - c)` of the whole.
    pub fn start_velocity(&self, kinematics: &Kinematics, motion: [Vec3; 3], v: &mut [Vec3]) {
        let [velocity, spin, centre] = motion;
        let block = kinematics.block_of(self.first_row as u32) as usize;
        for (term, row) in self.configuration().enumerate() {
            let arm = if term == 0 { row - centre } else { row };
            v[block + term] = spin.cross(arm) + if term == 0 { velocity } else { Vec3::ZERO };
        }
    }
}

/// The polynomial of a body about its middle; `None` where that was refused.
pub fn place(draft: &Draft, body: &Placed) -> Option<PlacedPolynomial> {
    let spec = body.spec.polynomial.as_ref()?;
    let own = body.spec;
    let site = |site: Option<&Site>| site.unwrap_or(&spec.site).clone();
    let others = [
        ("frames", own.frames.is_some(), site(own.frames.as_ref().map(|of| &of.site))),
        ("modes", own.modes.is_some(), site(own.modes.as_ref().map(|of| &of.site))),
        ("levels", own.levels.is_some(), site(None)),
        ("octree", own.octree.is_some(), site(None)),
        ("section", own.section() != Section::Solid, site(own.section.as_ref().map(|of| &of.site))),
        ("adapt", own.adapt.is_some(), site(own.adapt.as_ref().map(|of| &of.site))),
        ("formulation", own.formulation.is_some(), site(own.formulation.as_ref().map(|of| &of.site))),
        ("start", own.start.is_some(), site(own.start.as_ref().map(|of| &of.site))),
        ("damping.rayleigh_stiffness", own.damping.rayleigh_stiffness > 0.0, site(None)),
        ("damping.viscosity", own.damping.viscosity > 0.0, site(None)),
        ("damping.neighbour_friction", own.damping.neighbour_friction > 0.0, site(None)),
        ("quadrature", own.quadrature != Quadrature::Default, site(None)),
        ("mass", matches!(own.mass, MassKind::Uniform | MassKind::Voronoi), site(None)),
    ];
    let mut is_alone = true;
    for (key, _, site) in others.into_iter().filter(|(_, is_there, _)| *is_there) {
        let message = format!("body `{}` moves as a polynomial, which knows no such `{key}`", own.name);
        let expected = "a body of volumes with its material and `polynomial` alone";
        draft.log.add(Code::Conflict, &site, message, expected);
        is_alone = false;
    }
    let (centre, length) = (body.mesh.centroid(), 0.5 * body.mesh.bounds().diagonal());
    (is_alone && !body.materials.all.is_empty() && length > 0.0).then_some(PlacedPolynomial {
        polynomial: Polynomial { degree: spec.degree, centre, length },
        first_row: 0,
    })
}
