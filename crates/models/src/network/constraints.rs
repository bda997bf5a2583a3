//! Constraints between masses: relations that are kept by forces.
//!
//! Kept exactly, the forces are those that lead a relation back as a critically damped oscillator of the time `τ` would,
//! `D'' + (2/τ) D' + D/τ² = 0` (Barzel & Barr 1988): its exact solution is `D_{n+1} = 2 r D_n − r² D_{n−1}` with `r = e^{−h/τ}`, and
//! `r (D_n + h (D'_n + D_n/τ))` where no step led to where masses are: at the start, and after edits. That is what a step is told to end at
//! ([`souple_engine::binding`]). What holds and does not change stays, at any step; with `τ = 0` what does not hold does after one.
//!
//! Such forces may have a limit, beyond which what they keep gives way and stays as it was moulded: a perfectly plastic constraint.
//!
//! By the augmented Lagrangian (Platt & Barr 1988) they are `−Jᵀ (λ + c g + z ġ)` with `λ' = k g`: an ordinary force, for any stepper, that
//! keeps the relation in the end only. A mass on such a spring is stable where `z c > k m`, with its own mass `m` and `z` from whatever damps it.

use std::any::Any;

use souple_engine::binding::{self, ConstraintSet, Earlier};
use souple_engine::tangent::add_block;
use souple_engine::{
    Configuration, Declaration, Energy, Force, LinkShown, LinkState, Pair, Scratch, TangentWeights,
};
use souple_math::{Mat3, Vec3};
use souple_solve::BlockMatrix;

use super::relations::Relation;

/// How relations are kept.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Keeping {
    /// By forces that the step solves for, approached within the time `τ` [s].
    Exact {
        time: f64,
    },
    /// Likewise, at once, by multipliers of at most `limit`; where more would be needed the relation flows.
    Yielding {
        limit: f64,
    },
    Augmented(Augmented),
}

/// In units that make each a force when it is multiplied with `g` and its gradient: N/m, N/m³ and N/m⁵ of the stiffness for `g` in m, m² and m³; what
/// the formula of a surface makes of it otherwise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Augmented {
    /// `c`.
    pub stiffness: f64,
    /// `z`, that times a second.
    pub damping: f64,
    /// `k`, that per second.
    pub rate: f64,
}

/// Relations of one kind, kept alike.
#[derive(Debug)]
pub struct Constraints {
    name: String,
    relations: Vec<Box<dyn Relation>>,
    keeping: Keeping,
}

impl Constraints {
    pub fn new(name: impl Into<String>, relations: Vec<Box<dyn Relation>>, keeping: Keeping) -> Self {
        Self { name: name.into(), relations, keeping }
    }

    pub fn relations(&self) -> &[Box<dyn Relation>] {
        &self.relations
    }

    pub fn keeping(&self) -> Keeping {
        self.keeping
    }

    /// The multipliers of a relation, in the units of its components: what pushes its masses along its gradients. By the augmented
    /// Lagrangian the whole of what does.
    pub fn multiplier(&self, relation: usize, at: &Configuration) -> Vec3 {
        self.multiplier_by(relation, at, &mut Vec::new())
    }

    /// The same; gradients are scratch.
    fn multiplier_by(&self, relation: usize, at: &Configuration, gradients: &mut Vec<Mat3>) -> Vec3 {
        let kept = binding::multiplier(at.memory, relation);
        let Keeping::Augmented(Augmented { stiffness, damping, .. }) = self.keeping else { return kept };
        let relation = &self.relations[relation];
        let rate = if damping > 0.0 { rate_at(&**relation, at, gradients) } else { Vec3::ZERO };
        -(kept + relation.value(at.positions, at.time) * stiffness + rate * damping)
    }

    /// What it takes of the stiffness that an explicit step bears at each row, `Σ (c + 2 z/h) |J_i| Σ_j |J_j|` by Gershgorin's theorem [N/m].
    pub fn visit_loads(&self, positions: &[Vec3], timestep: f64, visit: &mut dyn FnMut(u32, f64)) {
        let Keeping::Augmented(Augmented { stiffness, damping, .. }) = self.keeping else { return };
        let mut gradients = Vec::new();
        for relation in &self.relations {
            gradients.clear();
            relation.add_gradients(positions, 0.0, &mut gradients);
            for component in 0..3 {
                let slope = |gradient: &Mat3| gradient.row(component).length();
                let all: f64 = gradients.iter().map(slope).sum();
                for (row, gradient) in relation.rows().iter().zip(&gradients) {
                    visit(*row, (stiffness + 2.0 * damping / timestep) * slope(gradient) * all);
                }
            }
        }
    }

    /// Calls `visit(rows, gradients)` for each relation of an augmented Lagrangian.
    fn for_augmented(
        &self,
        at: &Configuration,
        scratch: &mut Scratch,
        mut visit: impl FnMut(&Augmented, &[u32], &[Mat3]),
    ) {
        let Keeping::Augmented(augmented) = &self.keeping else { return };
        let gradients = gradients_of(scratch);
        for relation in &self.relations {
            gradients.clear();
            relation.add_gradients(at.positions, at.time, gradients);
            visit(augmented, relation.rows(), gradients);
        }
    }
}

fn gradients_of(scratch: &mut Scratch) -> &mut Vec<Mat3> {
    scratch.downcast_mut().unwrap_or_else(|| unreachable!("made by this force's own new_scratch"))
}

/// `ġ = J v + ∂g/∂t` of the masses, as they move; gradients are scratch.
fn rate_at(relation: &dyn Relation, at: &Configuration, gradients: &mut Vec<Mat3>) -> Vec3 {
    gradients.clear();
    relation.add_gradients(at.positions, at.time, gradients);
    let rows = relation.rows().iter().zip(gradients.iter());
    let moved: Vec3 = rows.map(|(row, gradient)| *gradient * at.velocities[*row as usize]).sum();
    moved + relation.time_rate(at.positions, at.time)
}

impl ConstraintSet for Constraints {
    fn relation_count(&self) -> usize {
        self.relations.len()
    }

    fn rows(&self, relation: usize) -> &[u32] {
        self.relations[relation].rows()
    }

    fn value(&self, relation: usize, positions: &[Vec3], time: f64) -> Vec3 {
        self.relations[relation].value(positions, time)
    }

    fn period(&self, relation: usize) -> f64 {
        self.relations[relation].period()
    }

    fn add_gradients(&self, relation: usize, positions: &[Vec3], time: f64, gradients: &mut Vec<Mat3>) {
        self.relations[relation].add_gradients(positions, time, gradients);
    }

    fn time_rate(&self, relation: usize, positions: &[Vec3], time: f64) -> Vec3 {
        self.relations[relation].time_rate(positions, time)
    }

    fn magnitude(&self, relation: usize, positions: &[Vec3], time: f64) -> Vec3 {
        self.relations[relation].magnitude(positions, time)
    }

    fn is_told(&self, relation: usize) -> bool {
        self.relations[relation].second_rate(0.0).is_some()
    }

    fn wanted(&self, relation: usize, earlier: Earlier, now: Vec3, start: f64, timestep: f64) -> Vec3 {
        if let Some(second_rate) = self.relations[relation].second_rate(start) {
            let drift = match earlier {
                Earlier::Value(before) => now - before,
                Earlier::Rate(rate) => rate * timestep,
            };
            return now + drift + second_rate * (timestep * timestep);
        }
        let Keeping::Exact { time } = self.keeping else { return Vec3::ZERO };
        let ratio = if time > 0.0 { (-timestep / time).exp() } else { 0.0 };
        match earlier {
            Earlier::Value(before) => now * (2.0 * ratio) - before * (ratio * ratio),
            Earlier::Rate(rate) if time > 0.0 => (now + (rate + now / time) * timestep) * ratio,
            Earlier::Rate(_) => Vec3::ZERO,
        }
    }

    fn yields_at(&self, _relation: usize) -> Option<f64> {
        match self.keeping {
            Keeping::Yielding { limit } => Some(limit),
            Keeping::Exact { .. } | Keeping::Augmented(_) => None,
        }
    }

    fn is_lost_between(&self, relation: usize, from: &[Vec3], to: &[Vec3]) -> Option<&'static str> {
        self.relations[relation].is_lost_between(from, to)
    }

    fn describe(&self, relation: usize) -> String {
        let it = &self.relations[relation];
        format!("{} (number {relation})", it.describe())
    }
}

impl Force for Constraints {
    fn name(&self) -> &str {
        &self.name
    }

    fn declaration(&self) -> Declaration {
        let is_damped =
            matches!(self.keeping, Keeping::Augmented(Augmented { damping, .. }) if damping > 0.0);
        Declaration {
            conservative: false,
            velocity_terms: is_damped,
            symmetric_tangent: true,
            internal: false,
            changing_pattern: false,
        }
    }

    // what the multipliers add by the second derivatives of relations
    fn leaves_out_stress(&self) -> bool {
        true
    }

    fn memory_len(&self) -> usize {
        match self.keeping {
            Keeping::Yielding { .. } => binding::yielding_memory_len(self.relations.len()),
            Keeping::Exact { .. } | Keeping::Augmented(_) => binding::memory_len(self.relations.len()),
        }
    }

    fn tangent_reads_memory(&self) -> bool {
        false
    }

    // E = Σ ½ c g²
    fn energy(&self, at: &Configuration, _scratch: &mut Scratch) -> Energy {
        let stored = match self.keeping {
            Keeping::Exact { .. } | Keeping::Yielding { .. } => 0.0,
            Keeping::Augmented(Augmented { stiffness, .. }) => {
                let values = self.relations.iter().map(|relation| relation.value(at.positions, at.time));
                values.map(|g| 0.5 * stiffness * g.length_sq()).sum()
            }
        };
        // what multipliers do to masses comes from nowhere else
        Energy { stored, dissipated: -at.memory[0] }
    }

    fn new_scratch(&self) -> Scratch {
        Box::new(Vec::<Mat3>::new())
    }

    fn add_force(&self, at: &Configuration, scratch: &mut Scratch, out: &mut [Vec3]) {
        let gradients = gradients_of(scratch);
        if self.constraint_set().is_some() {
            binding::add_forces(self, at, gradients, out);
            return;
        }
        for (index, relation) in self.relations.iter().enumerate() {
            let multiplier = self.multiplier_by(index, at, gradients);
            gradients.clear();
            relation.add_gradients(at.positions, at.time, gradients);
            for (row, gradient) in relation.rows().iter().zip(gradients.iter()) {
                out[*row as usize] += gradient.transpose_apply(multiplier);
            }
        }
    }

    // −Jᵀ (a c + b z) J δ
    fn add_differential(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        delta: &[Vec3],
        scratch: &mut Scratch,
        out: &mut [Vec3],
    ) {
        self.for_augmented(at, scratch, |Augmented { stiffness, damping, .. }, rows, gradients| {
            let rows = || rows.iter().zip(gradients);
            let change: Vec3 = rows().map(|(row, gradient)| *gradient * delta[*row as usize]).sum();
            let push = change * -(weights.position * stiffness + weights.velocity * damping);
            for (row, gradient) in rows() {
                out[*row as usize] += gradient.transpose_apply(push);
            }
        });
    }

    fn visit_cliques(&self, _pairs: &[Pair], visit: &mut dyn FnMut(&[u32])) {
        self.relations.iter().for_each(|relation| visit(relation.rows()));
    }

    fn add_blocks(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        scratch: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) {
        self.for_augmented(at, scratch, |Augmented { stiffness, damping, .. }, rows, gradients| {
            let scale = -(weights.position * stiffness + weights.velocity * damping);
            for (row, of_row) in rows.iter().zip(gradients) {
                for (column, of_column) in rows.iter().zip(gradients) {
                    let block = of_row.transpose_mul(of_column) * scale;
                    add_block(matrix, *row as usize, *column as usize, &block);
                }
            }
        });
    }

    // λ' = k g; the work of λ and of the damper on masses, and of what moves the relation on its spring
    fn advance_memory(&self, at: &Configuration, timestep: f64, memory: &mut [f64], _pairs: &mut [Pair]) {
        let Keeping::Augmented(Augmented { stiffness, damping, rate: growth }) = self.keeping else {
            return;
        };
        let mut gradients = Vec::new();
        for (index, relation) in self.relations.iter().enumerate() {
            let (rate, kept) =
                (rate_at(&**relation, at, &mut gradients), binding::multiplier(at.memory, index));
            let (value, led) =
                (relation.value(at.positions, at.time), relation.time_rate(at.positions, at.time));
            memory[0] -= timestep * (kept + rate * damping).dot(rate - led);
            memory[0] += timestep * stiffness * value.dot(led);
            let grown = kept + value * (growth * timestep);
            binding::set_multiplier(memory, index, grown);
        }
    }

    fn constraint_set(&self) -> Option<&dyn ConstraintSet> {
        matches!(self.keeping, Keeping::Exact { .. } | Keeping::Yielding { .. })
            .then_some(self as &dyn ConstraintSet)
    }

    fn visit_links(&self, at: &Configuration, visit: &mut dyn FnMut(&LinkShown)) {
        for (index, relation) in self.relations.iter().enumerate() {
            if let Some(ends) = relation.ends() {
                visit(&LinkShown { ends, state: LinkState::In(0), push: self.multiplier(index, at).x });
            }
        }
    }

    fn bytes(&self) -> usize {
        self.relations.iter().map(|relation| size_of_val(&**relation) + 4 * relation.rows().len()).sum()
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}
