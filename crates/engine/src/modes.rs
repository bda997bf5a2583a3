//! Natural frequencies of a system about where it stands: `K φ = ω² M φ`, constrained directions at rest.

use souple_math::{Mat3, Vec3};
use souple_solve::modes::lowest_modes;
pub use souple_solve::modes::{Modes, Settings};
pub use souple_solve::ritz::RitzPairs;
use souple_solve::ritz::{pairs_within, vanishing};
use souple_solve::{BlockMatrix, SolveError};

use crate::implicit::Rates;
use crate::inertia::add_generalised_mass;
use crate::state::SystemState;
use crate::system::{Surroundings, System, SystemWorkspace};
use crate::tangent::Linearisation;

/// Modes that cannot be had.
#[derive(Debug, thiserror::Error)]
pub enum ModesError {
    #[error(transparent)]
    Solve(#[from] SolveError),
    #[error(
        "`{force}` relates points by forces that are solved for in steps, which have no stiffness that modes could be found of; a stiff link, or a constraint with `augmented`, has one"
    )]
    ConstraintSolver { force: String },
    #[error("what is held leaves {motions} rigid motions free")]
    Loose { motions: usize },
}

impl ModesError {
    /// More modes asked for than there are.
    pub fn too_many(wanted: usize, available: usize) -> Self {
        Self::Solve(SolveError::TooManyModes { wanted, available })
    }

    /// How many modes there are, where more were asked for.
    pub fn available(&self) -> Option<usize> {
        match self {
            Self::Solve(SolveError::TooManyModes { available, .. }) => Some(*available),
            _ => None,
        }
    }
}

/// The lowest modes about the placed rows; shapes are over velocity blocks.
///
/// # Errors
/// More modes asked for than there are, points that relations bind, or a stiffness that cannot be factorised: a body that is free to move
/// has modes of frequency zero and needs a small negative shift.
pub fn lowest(
    system: &System,
    state: &SystemState,
    around: &Surroundings,
    ws: &mut SystemWorkspace,
    settings: &Settings,
) -> Result<Modes, ModesError> {
    let mut positions = Vec::new();
    system.block_positions_into(&ws.rows.positions, &mut positions);
    let (stiffness, mass) = matrices(system, state, around, ws)?;
    Ok(lowest_modes(stiffness, &mass, Some(&positions), settings)?)
}

/// Modes within the span of `fields` over velocity blocks, of what in it vanishes where the system is held and is orthogonal to the fields
/// `apart_from` in the norm of the mass.
///
/// # Errors
/// Points that relations bind, or fields that do not fit.
pub fn within(
    system: &System,
    state: &SystemState,
    around: &Surroundings,
    ws: &mut SystemWorkspace,
    fields: &[Vec<Vec3>],
    apart_from: &[Vec<Vec3>],
) -> Result<RitzPairs, ModesError> {
    let (stiffness, mass) = matrices(system, state, around, ws)?;
    Ok(pairs_within(stiffness, &mass, &vanishing(fields, &free(system)), apart_from)?)
}

/// Whether constraints hold the points of a system as a whole, which are its velocity blocks, from where they are in coordinates of about one: spaces of modes
/// that are given show rigid motions as frequencies of rounding alone.
///
/// # Errors
/// They leave rigid motions.
pub fn refuse_loose(system: &System, places: &[Vec3]) -> Result<(), ModesError> {
    let motions = vanishing(&rigid_motions(places), &free(system)).len();
    if motions == 0 { Ok(()) } else { Err(ModesError::Loose { motions }) }
}

/// The six fields of points that move together, and turn about the origin.
pub fn rigid_motions(places: &[Vec3]) -> Vec<Vec<Vec3>> {
    let moved = Vec3::AXES.map(|axis| vec![axis; places.len()]);
    let turned = Vec3::AXES.map(|axis| places.iter().map(|x| axis.cross(*x)).collect());
    [moved, turned].concat()
}

/// Held blocks, with what projects them to where they may go.
fn free(system: &System) -> Vec<(usize, Mat3)> {
    system.constraints.iter().map(|constraint| (constraint.block as usize, constraint.free)).collect()
}

/// Stiffness and mass about the placed rows. Held directions have no mass, and so take no part.
fn matrices<'a>(
    system: &System,
    state: &SystemState,
    around: &Surroundings,
    ws: &'a mut SystemWorkspace,
) -> Result<(&'a BlockMatrix, BlockMatrix), ModesError> {
    if let Some(force) =
        system.forces.iter().find(|force| force.constraint_set().is_some() || force.unilateral().is_some())
    {
        return Err(ModesError::ConstraintSolver { force: force.name().to_owned() });
    }
    let balanced = vec![Vec3::ZERO; system.kinematics.row_count()];
    let SystemWorkspace { scratches, rows, tangent, .. } = ws;
    let at = Linearisation {
        system,
        state,
        around: *around,
        rows,
        q: &state.q,
        v: &state.v,
        rates: Rates::STATIC,
        unbalanced: &balanced,
    };
    let stiffness = tangent.assemble(&at, scratches);
    let mut mass = BlockMatrix::zeros(stiffness.pattern().clone());
    add_generalised_mass(system, &state.q, &mut mass);
    let held = system.constraints.iter().map(|constraint| (constraint.block as usize, constraint.free));
    mass.constrain_blocks(held, 0.0)?;
    Ok((stiffness, mass))
}
