//! Relations to first order where a step starts: gradients, what is wanted, scales, and the matrix of multipliers.

use souple_math::{Mat3, Vec3};
use souple_solve::SolveError;

use crate::state::SystemState;
use crate::steppers::{Step, StepError};
use crate::system::SystemWorkspace;

use super::memory::{earlier, flow, known, known_at};
use super::structure::Structure;
use super::{
    ConstraintSolver, Earlier, IDLE, RAISE, ROUNDING, TOLERANCE, fault, nearest, rate, unsolved, value_near,
};

impl ConstraintSolver {
    /// Where the step leads without new forces, and where a step before led here.
    pub(super) fn predict(&mut self, step: &Step, ws: &SystemWorkspace) {
        let Step { system, around, timestep, .. } = *step;
        let (q, v) = (&ws.rows.positions, &ws.rows.velocities);
        self.inverse_masses.clear();
        self.inverse_masses.extend(system.mass.diagonal.iter().map(|mass| Mat3::IDENTITY * mass.recip()));
        for constraint in &system.constraints {
            let inverse = &mut self.inverse_masses[constraint.block as usize];
            *inverse = constraint.free * *inverse;
        }
        let points = || q.iter().zip(v);
        self.before.clear();
        self.before.extend(points().map(|(x, v)| *x - *v * timestep));
        self.led.clear();
        self.led.extend_from_slice(v);
        // what is led was where it was led to, however it has been accelerated; there is nothing before the start
        let earlier = (step.start - timestep).max(0.0);
        system.impose_constraints(&mut self.before, &mut self.led, earlier, around.load);
        self.places.clear();
        self.places.extend_from_slice(q);
        system.impose_constraints(&mut self.places, &mut self.led, step.start, around.load);
        let forces = ws.row_force.iter().zip(&system.mass.diagonal);
        self.velocities.clear();
        self.velocities
            .extend(v.iter().zip(forces).map(|(v, (force, mass))| *v + *force * (timestep / mass)));
        self.places.clear();
        self.places.extend(q.iter().zip(&self.velocities).map(|(x, v)| *x + *v * timestep));
        system.impose_constraints(&mut self.places, &mut self.velocities, step.end(), around.load);
    }

    /// Gradients where the step starts, and the values that are wanted where it ends.
    pub(super) fn linearise(
        &mut self,
        step: &Step,
        structure: &Structure,
        positions: &[Vec3],
        next: &SystemState,
    ) -> Result<(), StepError> {
        let Step { system, start, timestep, .. } = *step;
        self.gradients.clear();
        self.wanted.clear();
        self.now.clear();
        for (index, (force, relation)) in structure.relations.iter().enumerate() {
            let Some(set) = system.constraint_set(*force) else { continue };
            set.add_gradients(*relation, positions, start, &mut self.gradients);
            let memory = &next.memory[system.memory_range(*force)];
            let flow = Vec3::X * flow(memory, set.relation_count(), *relation);
            let now = value_near(set, *relation, (positions, start), flow);
            self.now.push(now);
            // what yields holds at once
            let wanted = if set.yields_at(*relation).is_some() {
                flow
            } else {
                let earlier = self.earlier(step, structure, index, now, (positions, memory));
                set.wanted(*relation, earlier, now, start, timestep)
            };
            let entries = structure.starts[index]..structure.starts[index + 1];
            if !(now.is_finite() && self.gradients[entries].iter().all(|gradient| gradient.is_finite())) {
                return Err(fault(step, structure, index, "has no value, or no slope, where masses are"));
            }
            if !wanted.is_finite() {
                return Err(fault(step, structure, index, "is told what is not finite"));
            }
            self.wanted.push(wanted);
        }
        Ok(())
    }

    /// What a relation was before: its value where the last step started, if a step from there has led here; otherwise, at the start and after edits,
    /// what it changes by in a second.
    pub(super) fn earlier(
        &mut self,
        step: &Step,
        structure: &Structure,
        index: usize,
        now: Vec3,
        (positions, memory): (&[Vec3], &[f64]),
    ) -> Earlier {
        let Step { system, start, timestep, .. } = *step;
        let (force, relation) = structure.relations[index];
        let Some(set) = system.constraint_set(force) else { return Earlier::Rate(Vec3::ZERO) };
        // there is nothing before the start: a formula may have no value there
        let moment = (start - timestep).max(0.0);
        let before = || value_near(set, relation, (&self.before, moment), now);
        if set.is_told(relation) {
            return Earlier::Value(before());
        }
        let count = set.relation_count();
        let (remembered, kind) = (earlier(memory, count, relation), memory[known_at(count)]);
        if kind == known::RATES {
            return Earlier::Rate(remembered);
        }
        if kind == known::VALUES {
            let before = before();
            let remembered = nearest(remembered, set.period(relation), before);
            let near =
                self.tolerance(structure, index) + set.magnitude(relation, positions, start) * ROUNDING;
            if (0..3).all(|axis| (before[axis] - remembered[axis]).abs() <= near[axis]) {
                return Earlier::Value(before);
            }
        }
        Earlier::Rate(rate(set, relation, (positions, &self.led, start), &mut self.unscaled))
    }

    /// How far off a relation may be by the coordinates of its own points, by gradients that are not scaled.
    fn tolerance(&self, structure: &Structure, index: usize) -> Vec3 {
        let entries = structure.starts[index]..structure.starts[index + 1];
        let rows = structure.rows[entries.clone()].iter().map(|row| *row as usize);
        let coordinates = rows.flat_map(|row| [self.before[row], self.places[row]]).flat_map(Vec3::to_array);
        let reach = coordinates.fold(0.0_f64, |largest, x| largest.max(x.abs()));
        let gradients = &self.gradients[entries];
        let slope = |component: usize| -> f64 {
            gradients.iter().map(|gradient| gradient.row(component).length()).sum()
        };
        Vec3::from_array([0, 1, 2].map(|component| TOLERANCE * slope(component) * reach))
    }

    /// Scales components so that each changes by one under its own multiplier.
    pub(super) fn scale(&mut self, step: &Step, structure: &Structure) -> Result<(), StepError> {
        self.scales.clear();
        self.active.clear();
        self.near.clear();
        for index in 0..structure.relations.len() {
            self.near.push(self.tolerance(structure, index));
            let entries = structure.starts[index]..structure.starts[index + 1];
            let of = |entry: usize| {
                let inverse = self.inverse_masses[structure.rows[entry] as usize];
                (self.gradients[entry] * inverse).mul_transpose(&self.gradients[entry]).diagonal()
            };
            let diagonal: Vec3 = entries.clone().map(of).sum();
            if !diagonal.is_finite() {
                return Err(fault(step, structure, index, "is too steep to compute with where masses are"));
            }
            let diagonal = diagonal.to_array();
            let is_active = diagonal.map(|entry| entry > 0.0);
            self.active.push(Vec3::from_array(is_active.map(|it| if it { 1.0 } else { 0.0 })));
            let scale = Vec3::from_array(diagonal.map(|it| if it > 0.0 { it.sqrt().recip() } else { 1.0 }));
            self.scales.push(scale);
            for gradient in &mut self.gradients[entries] {
                *gradient = Mat3::from_diagonal(scale) * *gradient;
            }
        }
        Ok(())
    }

    /// Lets relations be off by a share of what they are before any force too: the way to where they hold may be longer than places are far.
    /// What is near the origin is not known better than what others bring it on.
    pub(super) fn allow_rounding(&mut self, step: &Step, structure: &Structure, positions: &[Vec3]) {
        self.allow_way(structure, longest_way(&self.places, positions));
        for (index, (force, relation)) in structure.relations.iter().enumerate() {
            let Some(set) = step.system.constraint_set(*force) else { continue };
            let wanted = self.wanted[index];
            let off = wanted - value_near(set, *relation, (&self.places, step.end()), wanted);
            let magnitude = set.magnitude(*relation, &self.places, step.end());
            self.near[index] += Vec3::from_array(off.to_array().map(|off| TOLERANCE * off.abs()));
            self.near[index] += magnitude * ROUNDING;
        }
    }

    /// Lets relations be off by rounding of a way on which masses come and go in the step.
    pub(super) fn allow_way(&mut self, structure: &Structure, way: f64) {
        for index in 0..structure.relation_count() {
            let mut slopes = Vec3::ZERO;
            for (_, gradient) in structure.gradients_of(index, &self.gradients) {
                slopes += Vec3::from_array([0, 1, 2].map(|component| gradient.row(component).length()));
            }
            let (near, scale) = (self.near[index], self.scales[index]);
            let allowed = |axis: usize| near[axis].max(TOLERANCE * way * slopes[axis] / scale[axis]);
            self.near[index] = Vec3::from_array([0, 1, 2].map(allowed));
        }
    }

    // J W Jᵀ
    fn assemble(&mut self, structure: &mut Structure) {
        structure.matrix.set_zero();
        for (slot, [a, b]) in &structure.products {
            let inverse = &self.inverse_masses[structure.rows[*a as usize] as usize];
            let product =
                (self.gradients[*a as usize] * *inverse).mul_transpose(&self.gradients[*b as usize]);
            let [row, column] =
                [a, b].map(|entry| Mat3::from_diagonal(self.active[structure.relation_of(*entry)]));
            structure.matrix.add_at(*slot as usize, &(row * product * column));
        }
        for (relation, active) in self.active.iter().enumerate() {
            let slot = structure.matrix.pattern().diagonal_slot(relation);
            let raised = active.to_array().map(|active| if active > 0.0 { RAISE } else { IDLE });
            structure.matrix.add_at(slot, &Mat3::from_diagonal(Vec3::from_array(raised)));
        }
    }

    pub(super) fn factorize(&mut self, step: &Step, structure: &mut Structure) -> Result<(), StepError> {
        self.assemble(structure);
        structure.solver.factorize(&structure.matrix).map_err(|error| match error {
            SolveError::NotPositiveDefinite { block, .. } | SolveError::Singular { block, .. }
                if block < structure.relations.len() =>
            {
                fault(
                    step,
                    structure,
                    block,
                    "leaves no force that keeps it: its gradients vanish, or are too unlike those of others",
                )
            }
            error => unsolved(error),
        })
    }
}

/// The greatest coordinate of ways between places.
pub(super) fn longest_way(to: &[Vec3], from: &[Vec3]) -> f64 {
    let ways = to.iter().zip(from).flat_map(|(to, from)| (*to - *from).to_array());
    ways.fold(0.0, |most, way| most.max(way.abs()))
}
