//! Bodies that move in few unknowns that are no points and no frames of `frames`: what of them the rest of a scene asks.

use std::ops::Range;

use souple_engine::{Force, Kinematics, Mass, UnknownKind};
use souple_math::Vec3;
use souple_models::solids::FlatCell;

use super::Draft;
use super::bodies::{Placed, add_point_mass};
use super::modes::{self, PlacedModes};
use super::polynomial::{self, PlacedPolynomial};

/// What a body moves in.
pub enum PlacedReduced {
    Modes(PlacedModes),
    Polynomial(PlacedPolynomial),
}

/// What a body is told to move in; `None` where it is told nothing, or that was refused.
pub fn place(draft: &Draft, body: &Placed) -> Option<PlacedReduced> {
    match body.spec.modes {
        Some(_) => modes::place(draft, body).map(PlacedReduced::Modes),
        None => polynomial::place(draft, body).map(PlacedReduced::Polynomial),
    }
}

impl PlacedReduced {
    pub fn kind(&self) -> UnknownKind {
        match self {
            Self::Modes(modes) => modes.kind(),
            Self::Polynomial(polynomial) => polynomial.kind(),
        }
    }

    /// `ω²` of each mode [1/s²]; `None` of a body that moves otherwise.
    pub fn eigenvalues(&self) -> Option<&[f64]> {
        match self {
            Self::Modes(modes) => Some(modes.eigenvalues()),
            Self::Polynomial(_) => None,
        }
    }

    pub fn give_rows(&mut self, first: usize) {
        match self {
            Self::Modes(modes) => modes.give_rows(first),
            Self::Polynomial(polynomial) => polynomial.give_rows(first),
        }
    }

    /// Rows of its unknowns, which have the body's mass; the first is an origin.
    pub fn row_range(&self) -> Range<usize> {
        match self {
            Self::Modes(modes) => modes.row_range(),
            Self::Polynomial(polynomial) => polynomial.row_range(),
        }
    }

    /// Writes the configuration at rest to the rows of its unknowns.
    pub fn rest_into(&self, q: &mut [Vec3]) {
        let rows = &mut q[self.row_range()];
        match self {
            Self::Modes(modes) => rows.iter_mut().zip(modes.configuration()).for_each(|(q, row)| *q = row),
            Self::Polynomial(polynomial) => {
                rows.iter_mut().zip(polynomial.configuration()).for_each(|(q, row)| *q = row);
            }
        }
    }

    /// Appends the points of the mesh to the rows.
    pub fn add_points(&self, points: &[Vec3], kinematics: &mut Kinematics) {
        match self {
            Self::Modes(modes) => modes.add_points(points.len(), kinematics),
            Self::Polynomial(polynomial) => polynomial.add_points(points, kinematics),
        }
    }

    /// Adds the mass of the body, and what resists and damps it.
    ///
    /// # Errors
    /// A cell is flat or inverted at rest.
    pub fn add(
        &self,
        draft: &Draft,
        body: &Placed,
        mass: &mut Mass,
        forces: &mut Vec<Box<dyn Force>>,
    ) -> Result<(), FlatCell> {
        match self {
            Self::Modes(modes) => {
                let mut of_points = Mass::new(body.mesh.points.len());
                add_point_mass(draft, body, 0, &mut of_points);
                of_points.seal();
                modes.add_mass(&of_points, mass);
                modes.forces(&modes::description(body, body.rows.start), body, forces)
            }
            Self::Polynomial(polynomial) => {
                polynomial.add_mass(body, mass);
                forces.push(polynomial.force(body));
                Ok(())
            }
        }
    }

    /// Velocity blocks of a motion `v + ω × (x - c)` of the whole.
    pub fn start_velocity(&self, kinematics: &Kinematics, motion: [Vec3; 3], v: &mut [Vec3]) {
        match self {
            Self::Modes(modes) => modes.start_velocity(kinematics, motion, v),
            Self::Polynomial(polynomial) => polynomial.start_velocity(kinematics, motion, v),
        }
    }
}
