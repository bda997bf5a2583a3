//! Bodies that move in few unknowns that are no points and no frames of `frames`: what of them the rest of a scene asks.

use std::ops::Range;

use souple_engine::{DerivedRow, Feedback, Force, Kinematics, Mass, UnknownKind};
use souple_math::Vec3;
use souple_models::solids::{FlatCell, Section};

use super::Draft;
use super::bodies::{Placed, add_point_mass};
use super::modes::{self, PlacedModes};
use super::polynomial::{self, PlacedPolynomial};
use crate::diagnostic::{Code, Site};

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

/// Adds warnings on what bodies of few unknowns may not be as meant.
pub fn warn(draft: &mut Draft) {
    let mut warnings = Vec::new();
    for body in &draft.bodies {
        let (Some(PlacedReduced::Modes(modes)), Some(spec)) = (&body.reduced, &body.spec.modes) else {
            continue;
        };
        let place = draft.place(&spec.site);
        warnings.extend(modes.doubts().iter().map(|doubt| format!("{place}: {doubt}")));
    }
    draft.warnings.extend(warnings);
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

/// Appends a point of the mesh to the rows, of these weights over those of the unknowns from `first_row` on.
pub fn add_point(first_row: usize, weights: impl IntoIterator<Item = f64>, kinematics: &mut Kinematics) {
    let parents = (first_row as u32..).zip(weights).filter(|(_, weight)| *weight != 0.0).collect();
    let row = DerivedRow { parents, feedback: Feedback::Transpose };
    // weights are finite, and unknowns come before points
    kinematics.add_derived_row(row).unwrap_or_else(|error| unreachable!("{error}"));
}

/// What a body is told to move in, as messages have it.
pub struct Moving<'a> {
    pub key: &'a str,
    pub site: &'a Site,
    pub knows_no: &'a str,
}

impl Moving<'_> {
    /// Whether a body has nothing beside, of what no such body knows and of its `own`, each with its place where it is there; what it has is
    /// reported.
    pub fn is_alone(&self, draft: &Draft, body: &Placed, own: &[(&str, Option<&Site>)]) -> bool {
        let spec = body.spec;
        let here = |is_there: bool| is_there.then_some(self.site);
        let section = (spec.section() != Section::Solid)
            .then(|| spec.section.as_ref().map_or(self.site, |section| &section.site));
        let others = [
            ("frames", spec.frames.as_ref().map(|of| &of.site)),
            ("levels", here(spec.levels.is_some())),
            ("octree", here(spec.octree.is_some())),
            ("section", section),
            ("adapt", spec.adapt.as_ref().map(|of| &of.site)),
            ("formulation", spec.formulation.as_ref().map(|of| &of.site)),
            ("start", spec.start.as_ref().map(|of| &of.site)),
            ("damping.viscosity", here(spec.damping.viscosity > 0.0)),
            ("damping.neighbour_friction", here(spec.damping.neighbour_friction > 0.0)),
        ];
        let mut is_alone = true;
        for (key, site) in others.iter().chain(own) {
            let Some(site) = site else { continue };
            let message = format!("body `{}` {} `{key}`", spec.name, self.knows_no);
            let expected = format!("a body of volumes with its material and `{}` alone", self.key);
            draft.log.add(Code::Conflict, site, message, &expected);
            is_alone = false;
        }
        is_alone
    }
}
