//! Multipliers under which a step ends where relations hold, and contacts with them.

use souple_math::{Mat3, Vec3};

use crate::state::SystemState;
use crate::steppers::{Step, StepError, StepReport};
use crate::system::SystemWorkspace;

use super::limits::Flowing;
use super::structure::Structure;
use super::{ConstraintSolver, MOST_SOLVES, fault, unsolved, value_near};

/// How relations were solved for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Solved {
    AsBefore,
    /// Some gave way, or hold again, since forces were last found.
    WithOthers,
}

/// What forces are sought for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Sought {
    /// A step: relations and contacts.
    Step,
    /// The accelerations at its start, of relations alone: what collides there has none.
    Accelerations,
}

/// Adds the forces that keep relations, and gaps open, to the forces on the placed rows, and remembers them. For steps from `x` and `v` to
/// `v' = v + h f/m`, `x' = x + h v'` of points with lumped masses.
///
/// # Errors
/// Relations that no forces keep, contacts whose forces are not found.
pub(crate) fn bind(
    step: &Step,
    sought: Sought,
    next: &mut SystemState,
    ws: &mut SystemWorkspace,
) -> Result<StepReport, StepError> {
    let clock = std::time::Instant::now();
    let mut solver = std::mem::take(&mut ws.constraint_solver);
    let kept = solver.keep(step, sought, next, ws);
    ws.constraint_solver = solver;
    ws.stages.solve += clock.elapsed().as_secs_f64();
    kept
}

impl ConstraintSolver {
    fn keep(
        &mut self,
        step: &Step,
        sought: Sought,
        next: &mut SystemState,
        ws: &mut SystemWorkspace,
    ) -> Result<StepReport, StepError> {
        let mut structure = match self.structure.take() {
            Some(structure) => structure,
            None => Structure::new(step.system).map_err(unsolved)?,
        };
        let kept = self.keep_in(&mut structure, (step, sought), next, ws);
        self.structure = Some(structure);
        kept
    }

    fn keep_in(
        &mut self,
        structure: &mut Structure,
        (step, sought): (&Step, Sought),
        next: &mut SystemState,
        ws: &mut SystemWorkspace,
    ) -> Result<StepReport, StepError> {
        self.predict(step, ws);
        self.linearise(step, structure, &ws.rows.positions, next)?;
        self.scale(step, structure)?;
        self.remove_forces_before(step, structure, next);
        self.multipliers.clear();
        self.multipliers.resize(structure.relations.len(), Vec3::ZERO);
        self.flow_on(step, structure, next)?;
        if structure.relation_count() > 0 {
            self.factorize(step, structure)?;
        }
        if sought == Sought::Accelerations || !step.system.has_contacts() {
            self.allow_rounding(step, structure, &ws.rows.positions);
            self.flow_as_led(step, structure)?;
            self.solve(step, structure)?;
            self.check_flows(step, structure, &ws.rows.positions)?;
            self.commit((step, structure), &ws.rows.positions, next, &mut ws.row_force);
            return Ok(StepReport::default());
        }
        self.keep_with_contacts(step, structure, next, ws)
    }

    /// Relations and contacts in turns, until all of them hold where the step leads.
    fn keep_with_contacts(
        &mut self,
        step: &Step,
        structure: &mut Structure,
        next: &mut SystemState,
        ws: &mut SystemWorkspace,
    ) -> Result<StepReport, StepError> {
        let (mut contacts, mut places) =
            (std::mem::take(&mut self.contacts), std::mem::take(&mut self.places));
        let before = self.moving(step, structure, &ws.rows.positions, Solved::AsBefore);
        contacts.begin(&before, next, &mut places)?;
        self.places = places;
        self.allow_rounding(step, structure, &ws.rows.positions);
        self.flow_as_led(step, structure)?;
        loop {
            let solved = self.solve(step, structure)?;
            if structure.relation_count() > 0 {
                // to rounding: contacts of one body are to agree about where it is
                self.correct(step, structure)?;
            }
            let positions = &ws.rows.positions;
            if !self.push_contacts((step, structure, solved), &mut contacts, next, positions)? {
                break;
            }
        }
        self.check_flows(step, structure, &ws.rows.positions)?;
        self.commit((step, structure), &ws.rows.positions, next, &mut ws.row_force);
        let moving = self.moving(step, structure, &ws.rows.positions, Solved::AsBefore);
        let report = contacts.commit(&moving, next, (&self.places, &mut ws.row_force));
        self.contacts = contacts;
        Ok(report)
    }

    /// Finds the multipliers under which the step leads to where all relations are what they are to be, but for those that give way.
    fn solve(&mut self, step: &Step, structure: &mut Structure) -> Result<Solved, StepError> {
        let mut solved = Solved::AsBefore;
        let mut solves = 0;
        loop {
            let worst = self.farthest_off(step, structure)?;
            if worst.is_none() && self.is_within_limits() {
                return Ok(solved);
            }
            if solves == MOST_SOLVES {
                return Err(self.unkept(step, structure, worst.unwrap_or(0)));
            }
            solves += 1;
            if self.hold_or_flow(step, structure)? == Solved::WithOthers {
                solved = Solved::WithOthers;
            }
        }
    }

    /// Changes multipliers by what relations are off, and where the step leads with them.
    pub(super) fn correct(&mut self, step: &Step, structure: &Structure) -> Result<(), StepError> {
        let square = step.timestep * step.timestep;
        self.change.clear();
        let active = self.off.iter().zip(self.active.iter().zip(&self.scales));
        let scaled = |(off, (active, scale)): (&Vec3, (&Vec3, &Vec3))| {
            Mat3::from_diagonal(*active) * (Mat3::from_diagonal(*scale) * *off) / square
        };
        self.change.extend(active.map(scaled));
        self.apply(step, structure)
    }

    /// Changes multipliers so that relations change by `h²` times what stands in their change, and where the step leads with them.
    pub(super) fn apply(&mut self, step: &Step, structure: &Structure) -> Result<(), StepError> {
        structure.solve(&mut self.change)?;
        self.push(step, structure);
        Ok(())
    }

    /// Changes multipliers, and where the step leads with them.
    pub(super) fn push(&mut self, step: &Step, structure: &Structure) {
        let square = step.timestep * step.timestep;
        structure.spread(square, &self.change, &self.gradients, &self.inverse_masses, &mut self.places);
        for (multiplier, change) in self.multipliers.iter_mut().zip(&self.change) {
            *multiplier += *change;
        }
    }

    /// The relation that is farthest from what it is to be where the step leads; `None` where all are near enough.
    pub(super) fn farthest_off(
        &mut self,
        step: &Step,
        structure: &Structure,
    ) -> Result<Option<usize>, StepError> {
        self.off.clear();
        let mut worst: Option<(usize, f64)> = None;
        for (index, (force, relation)) in structure.relations.iter().enumerate() {
            let Some(set) = step.system.constraint_set(*force) else { continue };
            let wanted = self.wanted[index];
            let off = wanted - value_near(set, *relation, (&self.places, step.end()), wanted);
            if !off.is_finite() {
                return Err(fault(step, structure, index, "has no value where the step leads"));
            }
            self.off.push(off);
            for component in 0..3 {
                if component == 0 && self.flowing[index] != Flowing::Not {
                    continue;
                }
                let (off, near) = (off[component].abs(), self.near[index][component]);
                let by = if off <= near { 0.0 } else { off / near };
                if by > 0.0 && worst.is_none_or(|(_, known)| by > known) {
                    worst = Some((index, by));
                }
            }
        }
        Ok(worst.map(|(index, _)| index))
    }

    fn unkept(&self, step: &Step, structure: &Structure, worst: usize) -> StepError {
        let (force, relation) = structure.relations[worst];
        StepError::Unkept {
            force: step.system.forces[force].name().to_owned(),
            relation: step.system.constraint_set(force).map_or_else(String::new, |it| it.describe(relation)),
            off: self.off[worst].length(),
            row: structure.rows[structure.starts[worst]] as usize,
            time: step.end(),
        }
    }
}
