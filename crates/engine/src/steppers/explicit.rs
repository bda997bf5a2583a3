//! Methods that evaluate the force once a step, somewhere along a drift: two Euler methods, that of Newton and Cotes, and
//! the frame they share with Störmer–Verlet.

use std::time::Instant;

use souple_math::Vec3;
use souple_solve::reduce::{self, KickAndDrift};

use crate::binding::{Sought, bind};
use crate::inertia::{accelerations_at, sum_placed_forces, take_along};
use crate::kept::Summed;
use crate::state::SystemState;
use crate::system::{System, SystemWorkspace};

use super::{Stability, Step, StepError, StepReport, Stepper, StepperEntry};

/// `q' = q + h v`, `v' = v + h a(q, v)`: first order; for comparison. The energy of an oscillation grows by
/// `1 + (h ω)²` every step, exactly and at any step.
#[derive(Debug)]
pub struct ExplicitEuler;

/// `v' = v + h a(q, v)`, `q' = q + h v'`: first order; the cheapest way to move a body freely, called modified or
/// semi-implicit Euler too. Energy swings by `h ω / 2` of itself about a constant and does not drift below
/// `h ω = 2`: `½ m v² + ½ k q² - ½ h k q v` of a linear oscillator is kept exactly.
#[derive(Debug)]
pub struct SymplecticEuler;

/// `v' = v + h a(q, v)`, `q' = q + h v + h²/2 a`: exact under constant acceleration, and first order all the same; for
/// comparison. The amplitude of an oscillation grows by `1 + (h ω)²/4` a step, half as fast as that of explicit Euler.
#[derive(Debug)]
pub struct NewtonCotes;

pub(super) const NEWTON_COTES: StepperEntry = StepperEntry {
    name: "newton_cotes",
    summary: "first order, exact under constant acceleration; gains energy at any step, for comparison only",
    source: "Debunne 2000, app. B §3, with the half that its (B.8) lacks",
    parameters: &[],
    build: |_| Box::new(NewtonCotes),
};

pub(super) const EXPLICIT_EULER: StepperEntry = StepperEntry {
    name: "explicit_euler",
    summary: "first order, one force per step; gains energy at any step, for comparison only",
    source: "Hairer, Lubich & Wanner 2006, I.1.2",
    parameters: &[],
    build: |_| Box::new(ExplicitEuler),
};

pub(super) const SYMPLECTIC_EULER: StepperEntry = StepperEntry {
    name: "symplectic_euler",
    summary: "first order, one force per step, energy bounded below h ω = 2; the cheapest explicit method",
    source: "Hairer, Lubich & Wanner 2006, I.1.2",
    parameters: &[],
    build: |_| Box::new(SymplecticEuler),
};

/// Where in a step the force is evaluated, and which velocity moves the rest of the way.
pub(super) struct OneForce {
    /// Part of the step drifted with the velocity of the start before the force is evaluated.
    pub before: f64,
    pub drifts: Drifts,
}

/// Which velocity the drift after the force takes.
pub(super) enum Drifts {
    BeforeKick,
    AfterKick,
    /// Half of it before, half after.
    Mean,
}

impl OneForce {
    pub(super) fn step(
        self,
        step: &Step,
        next: &mut SystemState,
        ws: &mut SystemWorkspace,
    ) -> Result<StepReport, StepError> {
        let Step { system, around, start, timestep } = *step;
        let first = self.before * timestep;
        let rest = timestep - first;
        if first == 0.0 && matches!(self.drifts, Drifts::AfterKick) && steps_points(system) {
            return step_points(step, next, ws);
        }
        if first > 0.0 {
            system.kinematics.retract_scaled(&mut next.q, &next.v, first);
            system.place_rows(&next.q, &next.v, start + first, &mut ws.rows);
            system.refresh_pairs(ws, next, around);
        }
        let mut acceleration = std::mem::take(&mut ws.blocks[0]);
        acceleration.resize(next.v.len(), Vec3::ZERO);
        let evaluated = accelerations_at(system, around, start + first, next, ws, &mut acceleration);
        let stepped = evaluated.and_then(|mut report| {
            system.advance_memory(ws, next, around, timestep, Summed::Here);
            let [early, late] = match self.drifts {
                Drifts::BeforeKick => [rest, 0.0],
                Drifts::AfterKick => [0.0, rest],
                Drifts::Mean => [0.5 * rest; 2],
            };
            if early > 0.0 {
                system.kinematics.retract_scaled(&mut next.q, &next.v, early);
            }
            kick(&mut next.v, &acceleration, timestep);
            report.merge(&take_along(system, (start, step.end()), &next.q, &mut next.v, ws)?);
            if late > 0.0 {
                system.kinematics.retract_scaled(&mut next.q, &next.v, late);
            }
            system.impose_constraints(&mut next.q, &mut next.v, step.end(), around.load);
            Ok(report)
        });
        ws.blocks[0] = acceleration;
        stepped
    }
}

/// Whether [`step_points`] makes the steps of a system.
pub(super) fn steps_points(system: &System) -> bool {
    system.kinematics.is_trivial() && system.mass.is_lumped()
}

/// `v' = v + h f(q, v)/m`, `q' = q + h v'` of points with lumped masses: the same bits as the stages one by one, in one
/// pass over the points. Their vectors serve as rows, where they stand before the step where the world says so and after it
/// always; what is not finite is seen on the way.
fn step_points(
    step: &Step,
    next: &mut SystemState,
    ws: &mut SystemWorkspace,
) -> Result<StepReport, StepError> {
    let Step { system, around, start, timestep } = *step;
    if !std::mem::take(&mut ws.rows_are_the_state) {
        system.place_rows(&next.q, &next.v, start, &mut ws.rows);
    }
    ws.rows.time = start;
    if system.holds() {
        sum_held_forces(step, next, ws)?;
    } else {
        sum_placed_forces(system, around, next, ws)?;
    }
    system.advance_memory(ws, next, around, timestep, Summed::Here);
    system.project_free(&mut ws.row_force);
    ws.held.take_over(&mut ws.row_force, &mut ws.rows.velocities);
    let mut report = StepReport::default();
    if system.binds() {
        report.merge(&bind(step, Sought::Step, next, ws)?);
    }
    let (forces, masses, rows) = (&ws.row_force, &system.mass.diagonal, &mut ws.rows);
    let (q, v) = (&mut rows.positions, &mut rows.velocities);
    let copies = [&mut next.q[..], &mut next.v[..]];
    let moved = KickAndDrift { q, v, copies, forces, masses, timestep };
    ws.state_is_finite =
        moved.run() && system.constraints.iter().all(|constraint| constraint.motion.is_none());
    // rows are the state, constrained points too
    let (q, v) = (&mut ws.rows.positions, &mut ws.rows.velocities);
    system.impose_constraints(q, v, step.end(), around.load);
    for constraint in &system.constraints {
        let block = constraint.block as usize;
        (next.q[block], next.v[block]) = (q[block], v[block]);
    }
    Ok(report)
}

/// The accelerations `f/m` of points at the start of a step, with the forces that keep relations about it.
pub(super) fn bound_accelerations(
    step: &Step,
    next: &mut SystemState,
    ws: &mut SystemWorkspace,
    out: &mut [Vec3],
) -> Result<(), StepError> {
    let Step { system, around, start, .. } = *step;
    system.place_rows(&next.q, &next.v, start, &mut ws.rows);
    sum_placed_forces(system, around, next, ws)?;
    system.project_free(&mut ws.row_force);
    // nothing moves: no work is done, and the step that follows finds the forces anew
    let memory = next.memory.clone();
    bind(step, Sought::Accelerations, next, ws)?;
    next.memory = memory;
    ws.constraint_solver.remember_rates(step, &ws.rows.positions, &mut next.memory);
    for (out, (force, mass)) in out.iter_mut().zip(ws.row_force.iter().zip(&system.mass.diagonal)) {
        *out = *force / *mass;
    }
    Ok(())
}

/// Sums forces over the placed rows, and lets who holds points feel what bodies do to these.
///
/// # Errors
/// A force is not finite.
fn sum_held_forces(step: &Step, next: &mut SystemState, ws: &mut SystemWorkspace) -> Result<(), StepError> {
    let Step { system, around, timestep, .. } = *step;
    let clock = Instant::now();
    ws.held.gather(system, next, &ws.scratches, &ws.rows);
    ws.row_force.fill(Vec3::ZERO);
    for within in [true, false] {
        for (index, force) in system.forces.iter().enumerate() {
            if force.acts_within() == within {
                let at = system.view(index, &ws.rows, next, around);
                force.add_force(&at, &mut ws.scratches[index], &mut ws.row_force);
            }
        }
        if within {
            ws.held.note(&ws.row_force);
            ws.held.feel(system, next, timestep);
            ws.held.note_forces(system, next, &ws.scratches);
        }
    }
    ws.stages.forces += clock.elapsed().as_secs_f64();
    if reduce::all_finite(&ws.row_force) {
        return Ok(());
    }
    let found = system.first_force_not_finite(&ws.rows, next, around, &mut ws.scratches);
    found.map_or(Ok(()), Err)
}

/// `v += h a`.
pub(super) fn kick(v: &mut [Vec3], acceleration: &[Vec3], timestep: f64) {
    reduce::add_scaled(v, timestep, acceleration);
}

impl Stepper for ExplicitEuler {
    fn reads_cliques(&self) -> bool {
        false
    }

    fn name(&self) -> &'static str {
        EXPLICIT_EULER.name
    }

    fn stability(&self) -> Stability {
        Stability::Growing { factor: 0.5, power: 1 }
    }

    // q' = q + h v,  v' = v + h a(q, v)
    fn step(
        &self,
        step: &Step,
        next: &mut SystemState,
        ws: &mut SystemWorkspace,
    ) -> Result<StepReport, StepError> {
        let method = OneForce { before: 0.0, drifts: Drifts::BeforeKick };
        method.step(step, next, ws)
    }
}

impl Stepper for NewtonCotes {
    fn reads_cliques(&self) -> bool {
        false
    }

    fn name(&self) -> &'static str {
        NEWTON_COTES.name
    }

    fn stability(&self) -> Stability {
        Stability::Growing { factor: 0.25, power: 1 }
    }

    // v' = v + h a(q, v),  q' = q + h/2 (v + v')
    fn step(
        &self,
        step: &Step,
        next: &mut SystemState,
        ws: &mut SystemWorkspace,
    ) -> Result<StepReport, StepError> {
        let method = OneForce { before: 0.0, drifts: Drifts::Mean };
        method.step(step, next, ws)
    }
}

impl Stepper for SymplecticEuler {
    fn reads_cliques(&self) -> bool {
        false
    }

    fn name(&self) -> &'static str {
        SYMPLECTIC_EULER.name
    }

    fn stability(&self) -> Stability {
        Stability::Limited(2.0)
    }

    fn reads_rows(&self, system: &System, _: &SystemState) -> bool {
        steps_points(system) && !system.holds()
    }

    fn holds_points(&self, system: &System) -> bool {
        steps_points(system)
    }

    fn binds_points(&self, system: &System) -> bool {
        steps_points(system)
    }

    // v' = v + h a(q, v),  q' = q + h v'
    fn step(
        &self,
        step: &Step,
        next: &mut SystemState,
        ws: &mut SystemWorkspace,
    ) -> Result<StepReport, StepError> {
        let method = OneForce { before: 0.0, drifts: Drifts::AfterKick };
        method.step(step, next, ws)
    }
}
