//! Natural frequencies of a system about where it stands: `K φ = ω² M φ`, constrained directions at rest.

use souple_math::Vec3;
use souple_solve::modes::lowest_modes;
pub use souple_solve::modes::{Modes, Settings};
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
    Bound { force: String },
}

impl ModesError {
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
    if let Some(force) =
        system.forces.iter().find(|force| force.binding().is_some() || force.unilateral().is_some())
    {
        return Err(ModesError::Bound { force: force.name().to_owned() });
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
    // held directions have no mass, and so take no part
    let held = system.constraints.iter().map(|constraint| (constraint.block as usize, constraint.free));
    mass.constrain_blocks(held, 0.0)?;
    let mut positions = Vec::new();
    system.block_positions_into(&rows.positions, &mut positions);
    Ok(lowest_modes(stiffness, &mass, Some(&positions), settings)?)
}
