//! Forces to accelerations: `TᵀMT a = Tᵀ(f - M ẍ_bias)`, constrained components zero.

use souple_math::Vec3;
use souple_solve::{BlockMatrix, reduce};

use crate::constraint::Constraint;
use crate::state::SystemState;
use crate::steppers::{StepError, StepReport};
use crate::system::{Rows, Surroundings, System, SystemWorkspace};
use crate::tangent::{add_congruent, constrain};

/// `out = a(q, v)` of the state at `time`; leaves the rows placed there.
///
/// # Errors
/// A force is not finite, or the mass matrix cannot be solved with.
pub fn accelerations_at(
    system: &System,
    around: &Surroundings,
    time: f64,
    state: &SystemState,
    ws: &mut SystemWorkspace,
    out: &mut [Vec3],
) -> Result<StepReport, StepError> {
    sum_forces(system, around, time, state, ws)?;
    from_forces(system, state, ws, out)
}

/// The same with led components, whose acceleration over `timestep` about `time` is that of their motion, and which take
/// along what a mass that couples points joins to them.
///
/// # Errors
/// As [`accelerations_at`].
pub fn led_accelerations_at(
    system: &System,
    around: &Surroundings,
    (time, timestep): (f64, f64),
    state: &SystemState,
    ws: &mut SystemWorkspace,
    out: &mut [Vec3],
) -> Result<StepReport, StepError> {
    sum_forces(system, around, time, state, ws)?;
    let led =
        |constraint: &Constraint| constraint.constrained() * constraint.mean_acceleration(time, timestep);
    // f - M a over what is led
    ws.row_scratch.clear();
    ws.row_scratch.resize(ws.rows.positions.len(), Vec3::ZERO);
    for constraint in &system.constraints {
        system.add_led(constraint, led(constraint), &state.q, &mut ws.row_scratch);
    }
    system.kinematics.derive_rows(&mut ws.row_scratch);
    system.mass.add_scaled_product(-1.0, &ws.row_scratch, &mut ws.row_force);
    let report = from_forces(system, state, ws, out)?;
    for constraint in &system.constraints {
        out[constraint.block as usize] += led(constraint);
    }
    Ok(report)
}

/// The accelerations of all rows: of unknowns as in [`led_accelerations_at`], of axes with their turning, of rows that hang on others with
/// these.
///
/// # Errors
/// As [`accelerations_at`].
pub fn row_accelerations_at(
    system: &System,
    around: &Surroundings,
    when: (f64, f64),
    state: &SystemState,
    ws: &mut SystemWorkspace,
    out: &mut [Vec3],
) -> Result<(), StepError> {
    let mut of_blocks = vec![Vec3::ZERO; system.kinematics.block_count()];
    led_accelerations_at(system, around, when, state, ws, &mut of_blocks)?;
    system.kinematics.velocities_into(&state.q, &of_blocks, out);
    if system.kinematics.has_turning_frames() {
        bias_into(system, state, &ws.rows, &mut ws.row_scratch);
        reduce::add_scaled(out, 1.0, &ws.row_scratch);
    }
    Ok(())
}

/// Sums forces over the rows placed at the state.
fn sum_forces(
    system: &System,
    around: &Surroundings,
    time: f64,
    state: &SystemState,
    ws: &mut SystemWorkspace,
) -> Result<(), StepError> {
    system.place_rows(&state.q, &state.v, time, &mut ws.rows);
    sum_placed_forces(system, around, state, ws)
}

/// Sums forces over the rows as they are placed.
///
/// # Errors
/// A force is not finite.
pub(crate) fn sum_placed_forces(
    system: &System,
    around: &Surroundings,
    state: &SystemState,
    ws: &mut SystemWorkspace,
) -> Result<(), StepError> {
    let clock = std::time::Instant::now();
    system.sum_row_forces(&ws.rows, state, around, &mut ws.scratches, &mut ws.row_force);
    ws.stages.forces += clock.elapsed().as_secs_f64();
    if !reduce::all_finite(&ws.row_force)
        && let Some(error) = system.first_force_not_finite(&ws.rows, state, around, &mut ws.scratches)
    {
        return Err(error);
    }
    Ok(())
}

/// Solves for the accelerations of free components under the summed forces.
fn from_forces(
    system: &System,
    state: &SystemState,
    ws: &mut SystemWorkspace,
    out: &mut [Vec3],
) -> Result<StepReport, StepError> {
    if system.kinematics.has_turning_frames() {
        bias_into(system, state, &ws.rows, &mut ws.row_scratch);
        system.mass.add_scaled_product(-1.0, &ws.row_scratch, &mut ws.row_force);
    }
    solve_mass(system, &state.q, ws, out)
}

/// `out = (TᵀMT)⁻¹ Tᵀ f` over free components, with `f` over rows in `ws.row_force`.
///
/// # Errors
/// The mass matrix cannot be solved with.
pub fn solve_mass(
    system: &System,
    q: &[Vec3],
    ws: &mut SystemWorkspace,
    out: &mut [Vec3],
) -> Result<StepReport, StepError> {
    if system.kinematics.is_trivial() && system.mass.is_lumped() {
        // a = f / m
        let (forces, masses) = (&ws.row_force, &system.mass.diagonal);
        reduce::for_each_chunk(out, &|first, out: &mut [Vec3]| {
            for ((a, f), mass) in out.iter_mut().zip(&forces[first..]).zip(&masses[first..]) {
                *a = *f * (1.0 / mass);
            }
        });
        system.project_free(out);
        return Ok(StepReport::default());
    }
    let mut rhs = std::mem::take(&mut ws.blocks[5]);
    rhs.resize(out.len(), Vec3::ZERO);
    system.kinematics.forces_into(q, &mut ws.row_force, &mut rhs);
    system.project_free(&mut rhs);
    let mut matrix = ws.tangent.take_mass_matrix(system);
    matrix.set_zero();
    add_generalised_mass(system, q, &mut matrix);
    constrain(system, &mut matrix);
    let solved = ws.linear.solve_mass(&matrix, &rhs, out);
    ws.tangent.put_mass_matrix(matrix);
    ws.blocks[5] = rhs;
    let solved = solved?;
    Ok(StepReport {
        linear_iterations: u64::from(solved.iterations),
        linear_residual: solved.residual,
        ..StepReport::default()
    })
}

/// What led components give to the free ones while their velocity changes from that at `from` to that at `to` seconds, for
/// methods that kick velocities with [`accelerations_at`]: with the momentum `p = M_ff v_f + M_fc v_c` of the free
/// components, `ṗ = f` is left for the kicks, and `v -= M_ff⁻¹ M_fc Δv_c` holds exactly however the motion goes. Nothing
/// where the mass couples no points.
///
/// # Errors
/// The mass matrix cannot be solved with.
pub fn take_along(
    system: &System,
    (from, to): (f64, f64),
    q: &[Vec3],
    v: &mut [Vec3],
    ws: &mut SystemWorkspace,
) -> Result<StepReport, StepError> {
    if system.mass.is_lumped() || system.constraints.iter().all(|constraint| constraint.motion.is_none()) {
        return Ok(StepReport::default());
    }
    ws.row_scratch.clear();
    ws.row_scratch.resize(ws.rows.positions.len(), Vec3::ZERO);
    for constraint in &system.constraints {
        let change = constraint.velocity(to) - constraint.velocity(from);
        system.add_led(constraint, constraint.constrained() * change, q, &mut ws.row_scratch);
    }
    system.kinematics.derive_rows(&mut ws.row_scratch);
    ws.row_force.fill(Vec3::ZERO);
    system.mass.add_scaled_product(-1.0, &ws.row_scratch, &mut ws.row_force);
    let mut change = std::mem::take(&mut ws.taken_along);
    change.resize(v.len(), Vec3::ZERO);
    let solved = solve_mass(system, q, ws, &mut change);
    reduce::add_scaled(v, 1.0, &change);
    ws.taken_along = change;
    solved
}

/// `matrix += TᵀMT`.
pub fn add_generalised_mass(system: &System, q: &[Vec3], matrix: &mut BlockMatrix) {
    let kinematics = &system.kinematics;
    let map = |row: u32| kinematics.position_maps(row, q);
    for (row, mass) in system.mass.diagonal.iter().enumerate().filter(|(_, mass)| **mass != 0.0) {
        add_congruent(kinematics, matrix, (row, row), &map, &map, |left, right| {
            left.transpose_mul(right) * *mass
        });
    }
    for &(a, b, mass) in &system.mass.couplings {
        for pair in [(a as usize, b as usize), (b as usize, a as usize)] {
            add_congruent(kinematics, matrix, pair, &map, &map, |left, right| {
                left.transpose_mul(right) * mass
            });
        }
    }
}

/// `ẍ_bias`, the acceleration rows have while velocity blocks stay as they are.
fn bias_into(system: &System, state: &SystemState, rows: &Rows, bias: &mut Vec<Vec3>) {
    bias.clear();
    bias.resize(rows.positions.len(), Vec3::ZERO);
    let mut row = 0;
    for (kind, _) in system.kinematics.unknowns() {
        let next = row + kind.row_count();
        if kind.turns() {
            for (row, bias) in (row..next).zip(&mut bias[row..next]) {
                *bias = system.kinematics.bias(row as u32, &rows.positions, &state.v);
            }
        }
        row = next;
    }
    system.kinematics.derive_rows(bias);
}
