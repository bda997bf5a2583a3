//! Bodies of a polynomial: their points become rows over its terms.

use std::ops::Range;

use souple_engine::{Force, Kinematics, Mass, UnknownKind};
use souple_math::Vec3;
use souple_models::frames::samples_of_cells;
use souple_models::reduced::{Polynomial, PolynomialDescription, PolynomialForce};
use souple_models::solids::Quadrature;

use super::Draft;
use super::bodies::{Placed, solid_name};
use super::reduced::{Moving, add_point};
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
            add_point(self.first_row, self.polynomial.terms(*point), kinematics);
        }
    }

    /// Adds the mass of the body's matter.
    pub fn add_mass(&self, body: &Placed, mass: &mut Mass) {
        let samples = samples_of_cells(&body.mesh, Some(DEGREE_OF_MASS));
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
    let own = [
        ("modes", body.spec.modes.as_ref().map(|of| &of.site)),
        ("damping.rayleigh_stiffness", (body.spec.damping.rayleigh_stiffness > 0.0).then_some(&spec.site)),
        ("quadrature", (body.spec.quadrature != Quadrature::Default).then_some(&spec.site)),
        ("mass", matches!(body.spec.mass, MassKind::Uniform | MassKind::Voronoi).then_some(&spec.site)),
    ];
    let moving = Moving {
        key: "polynomial",
        site: &spec.site,
        knows_no: "moves as a polynomial, which knows no such",
    };
    let is_alone = moving.is_alone(draft, body, &own);
    let (centre, length) = (body.mesh.centroid(), 0.5 * body.mesh.bounds().diagonal());
    (is_alone && !body.materials.all.is_empty() && length > 0.0).then_some(PlacedPolynomial {
        polynomial: Polynomial { degree: spec.degree, centre, length },
        first_row: 0,
    })
}
