//! Relations between points that are kept by forces which the step solves for.
//!
//! A relation `g(x, t)` of up to three components is to have the value `w` where a step ends. The force that brings it there is
//! `Jᵀ λ` with the gradients `J = ∂g/∂x` where the step starts, so that the step ends at
//!
//! `x' = x + h v + h² W (f + Jᵀ λ)`, `g(x', t') = w`,
//!
//! with the inverse masses `W`, zero along what pins hold. The multipliers `λ` follow by Newton's method with the matrix of the
//! start, `J W Jᵀ δλ = (w − g(x', t'))/h²`, which is symmetric and as sparse as relations share points. Relations that hold at
//! both ends of a step are those of SHAKE (Ryckaert, Ciccotti & Berendsen 1977): it is symplectic, and of second order.
//!
//! Each component is scaled so that the diagonal of `J W Jᵀ` is one. Relations may repeat each other: the matrix is then singular, and its
//! diagonal is raised by `RAISE`. What is left of that is gone after a few of the solves that are made anyway, and of all forces that do the same those with the least
//! `Σ (J W Jᵀ)_cc λ_c²` are found. Relations that contradict each other are told, not shared out.
//!
//! A relation of one component may yield: `|λ| ≤ Y`, and where that is reached it gives way and what it is to be goes along, `w' = g(x', t')`, a
//! perfectly plastic flow `p` from what it was told. Which do is found by a primal–dual active set (Hintermüller, Ito & Kunisch 2003): those at their limit push with that
//! and are not solved for, the others are; one whose multiplier comes out beyond its limit is held at that, one that would flow against its push holds again.

use std::sync::Arc;

use souple_math::{Mat3, Vec3};
use souple_solve::{BlockMatrix, DirectSolver, PatternBuilder, SolveError};

use crate::force::{Configuration, Force};
use crate::state::SystemState;
use crate::steppers::{Step, StepError, StepReport};
use crate::system::{System, SystemWorkspace};
use crate::unilateral::{ContactSystem, Moving};

/// Of a diagonal entry, what is added to it: far above rounding, so that relations which repeat others have a pivot, and far
/// below the least eigenvalue of the scaled matrix of thousands of rods in a row, `(π/n)²/2`, so that solves converge.
const RAISE: f64 = 1e-8;
/// How far off a relation may be, of what it changes by when its points move by the greatest coordinate of any of them, and of what it
/// was off by before any force: places are known to `2e-16` of that, and sums over thousands of them to this.
const TOLERANCE: f64 = 1e-12;
/// Likewise, of the numbers of which it is the difference, each known to `1e-16` of itself.
const ROUNDING: f64 = 2e-15;
/// Each takes a share of the error away that is the square of the angle by which gradients turn within the step.
const MOST_SOLVES: u32 = 50;
/// On the diagonal of a component that no force can change, or that has given way: it is not solved for.
const IDLE: f64 = 1.0;
/// How often those that give way may be others before a step is given up.
const MOST_SWITCHES: u32 = 100;

/// What is known of a relation before a step starts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Earlier {
    /// Its value one step before.
    Value(Vec3),
    /// `ġ` at the start, where no step led there.
    Rate(Vec3),
}

impl Earlier {
    /// The same of what is counted from another value.
    fn from(self, value: Vec3) -> Self {
        match self {
            Self::Value(before) => Self::Value(before - value),
            rate @ Self::Rate(_) => rate,
        }
    }
}

/// In the memory of a force, what the numbers of its relations beside the multipliers are; zero where no step came before.
mod known {
    /// Values where the step before started.
    pub const VALUES: f64 = 1.0;
    /// Rates of the start, before a trajectory moved the velocity.
    pub const RATES: f64 = 2.0;
}

/// What of a force relates points.
pub trait Binding: Send + Sync {
    fn relation_count(&self) -> usize;

    /// Rows that a relation is of, each once.
    fn rows(&self, relation: usize) -> &[u32];

    /// `g(x, t)`; zero in the components that it has not.
    fn value(&self, relation: usize, positions: &[Vec3], time: f64) -> Vec3;

    /// What its value repeats by, where it is one number of which whole turns make no difference; 0 of others.
    fn period(&self, _relation: usize) -> f64 {
        0.0
    }

    /// `∂g/∂x` for each of its rows in turn: the gradient of a component in each row of the matrix.
    fn add_gradients(&self, relation: usize, positions: &[Vec3], time: f64, gradients: &mut Vec<Mat3>);

    /// `ġ = J v + ∂g/∂t` of points that move so.
    fn rate(&self, relation: usize, positions: &[Vec3], velocities: &[Vec3], time: f64) -> Vec3;

    /// How large the numbers are of which `g` is the difference.
    fn magnitude(&self, relation: usize, positions: &[Vec3], time: f64) -> Vec3;

    /// Whether what it changes by the second time is told, and not what it is to be.
    fn is_told(&self, relation: usize) -> bool;

    /// The value that it is to have where a step of `timestep` from `start` ends, by what was before and its value where it starts.
    fn wanted(&self, relation: usize, earlier: Earlier, now: Vec3, start: f64, timestep: f64) -> Vec3;

    /// The greatest multiplier, of either sign, by which a relation of one component is kept: where more would be needed it gives way, and stays
    /// as it was then. `None` where it is kept by whatever is needed.
    fn yields_at(&self, _relation: usize) -> Option<f64> {
        None
    }

    /// What it is, in words.
    fn describe(&self, relation: usize) -> String;
}

/// The value of a relation where whole periods make no difference: the one nearest to another, so that what flows on does not come back.
fn value_near(binding: &dyn Binding, relation: usize, (positions, time): (&[Vec3], f64), near: Vec3) -> Vec3 {
    nearest(binding.value(relation, positions, time), binding.period(relation), near)
}

fn nearest(value: Vec3, period: f64, near: Vec3) -> Vec3 {
    if period > 0.0 { value - Vec3::X * (period * ((value.x - near.x) / period).round()) } else { value }
}

/// Numbers in the memory of a force with so many relations: the work that it has done [J], the multipliers, what is known of before, and that
/// of each relation.
pub fn memory_len(relations: usize) -> usize {
    2 + 6 * relations
}

/// The same where relations yield: with how far each has flowed from what it was told.
pub fn yielding_memory_len(relations: usize) -> usize {
    memory_len(relations) + relations
}

/// Where what is known of before stands, of so many relations.
fn known_at(relations: usize) -> usize {
    1 + 3 * relations
}

/// What is known of a relation from before: values or rates.
fn earlier(memory: &[f64], relations: usize, relation: usize) -> Vec3 {
    let first = known_at(relations) + 1 + 3 * relation;
    Vec3::new(memory[first], memory[first + 1], memory[first + 2])
}

/// How far a relation has flowed; not at all where none yields.
fn flow(memory: &[f64], relations: usize, relation: usize) -> f64 {
    memory.get(memory_len(relations) + relation).copied().unwrap_or(0.0)
}

fn set_earlier(memory: &mut [f64], (relations, relation): (usize, usize), kind: f64, value: Vec3) {
    let at = known_at(relations);
    memory[at] = kind;
    memory[at + 1 + 3 * relation..at + 4 + 3 * relation].copy_from_slice(&value.to_array());
}

/// The multipliers of a relation, by the memory of its force.
pub fn multiplier(memory: &[f64], relation: usize) -> Vec3 {
    let first = 1 + 3 * relation;
    Vec3::new(memory[first], memory[first + 1], memory[first + 2])
}

/// Sets [`multiplier`].
pub fn set_multiplier(memory: &mut [f64], relation: usize, multiplier: Vec3) {
    let first = 1 + 3 * relation;
    memory[first..first + 3].copy_from_slice(&multiplier.to_array());
}

/// `out += Jᵀ λ` of the multipliers in a force's memory.
pub fn add_forces(binding: &dyn Binding, at: &Configuration, out: &mut [Vec3]) {
    let mut gradients = Vec::new();
    for relation in 0..binding.relation_count() {
        let multiplier = multiplier(at.memory, relation);
        if multiplier == Vec3::ZERO {
            continue;
        }
        gradients.clear();
        binding.add_gradients(relation, at.positions, at.time, &mut gradients);
        for (row, gradient) in binding.rows(relation).iter().zip(&gradients) {
            out[*row as usize] += gradient.transpose_apply(multiplier);
        }
    }
}

/// Scratch of the relations of a system, kept between steps.
#[derive(Debug, Default)]
pub(crate) struct Bound {
    structure: Option<Structure>,
    /// For each entry of the structure, scaled.
    gradients: Vec<Mat3>,
    /// Of each component `1/√(J W Jᵀ)_cc`, one where no force changes it.
    scales: Vec<Vec3>,
    /// How far off each component may be.
    near: Vec<Vec3>,
    /// What relations are where the step starts.
    now: Vec<Vec3>,
    /// By row [1/kg].
    inverse_masses: Vec<Mat3>,
    /// One step before, and where the step leads [m].
    before: Vec<Vec3>,
    places: Vec<Vec3>,
    /// Where it led before contacts pushed last [m].
    unpushed: Vec<Vec3>,
    /// Of points where the step starts, and where it leads [m/s].
    velocities: Vec<Vec3>,
    led: Vec<Vec3>,
    wanted: Vec<Vec3>,
    /// Of each relation, in the units of its components.
    off: Vec<Vec3>,
    change: Vec<Vec3>,
    /// Scaled, as are those of the step before.
    multipliers: Vec<Vec3>,
    /// The multipliers that the step before ended with.
    before_step: Vec<Vec3>,
    /// Ones in the components that forces change, and that have not given way.
    active: Vec<Vec3>,
    /// Of each relation.
    flowing: Vec<Flowing>,
    contacts: ContactSystem,
}

/// Whether a relation has given way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Flowing {
    Not,
    /// Its multiplier is at the limit.
    Pushing,
    /// It is at the opposite of the limit.
    Pulling,
}

impl Flowing {
    fn sign(self) -> f64 {
        match self {
            Self::Not => 0.0,
            Self::Pushing => 1.0,
            Self::Pulling => -1.0,
        }
    }

    /// Of a multiplier against its limit.
    fn of(multiplier: f64, limit: f64) -> Self {
        match multiplier {
            beyond if beyond >= limit => Self::Pushing,
            beyond if beyond <= -limit => Self::Pulling,
            _ => Self::Not,
        }
    }
}

/// What of the relations of a system stays from step to step.
#[derive(Debug)]
pub(crate) struct Structure {
    /// The force and the number within it of each relation.
    relations: Vec<(usize, usize)>,
    /// Where the entries of each begin, and at the end of the list how many there are.
    starts: Vec<usize>,
    /// The row and the relation of each entry.
    rows: Vec<u32>,
    of_entries: Vec<u32>,
    /// Relation and entry of each row: where those of each begin.
    row_starts: Vec<usize>,
    of_rows: Vec<(u32, u32)>,
    /// The least row that relations lead to from each row.
    bodies: Vec<u32>,
    /// Slot of the matrix, and the two entries of one row whose product goes there.
    products: Vec<(u32, [u32; 2])>,
    matrix: BlockMatrix,
    solver: DirectSolver,
}

impl System {
    /// Whether forces relate points, or keep gaps open, that a step is to solve for.
    pub fn binds(&self) -> bool {
        self.has_contacts() || self.forces.iter().any(|force| force.binding().is_some())
    }

    fn binding(&self, force: usize) -> Option<&dyn Binding> {
        self.forces[force].binding()
    }
}

impl Structure {
    fn new(system: &System) -> Result<Self, SolveError> {
        let (mut relations, mut starts, mut rows) = (Vec::new(), vec![0], Vec::new());
        let forces = system.forces.iter().map(AsRef::as_ref).enumerate();
        for (force, binding) in
            forces.filter_map(|(index, force): (usize, &dyn Force)| Some((index, force.binding()?)))
        {
            for relation in 0..binding.relation_count() {
                relations.push((force, relation));
                rows.extend_from_slice(binding.rows(relation));
                starts.push(rows.len());
            }
        }
        let mut of_row: Vec<Vec<(u32, u32)>> = vec![Vec::new(); system.kinematics.row_count()];
        for (relation, entries) in starts.windows(2).enumerate() {
            for entry in entries[0]..entries[1] {
                of_row[rows[entry] as usize].push((relation as u32, entry as u32));
            }
        }
        let mut pattern = PatternBuilder::new(relations.len());
        for related in &of_row {
            let clique: Vec<u32> = related.iter().map(|(relation, _)| *relation).collect();
            pattern.add_clique(&clique)?;
        }
        let pattern = Arc::new(pattern.build()?);
        let mut products = Vec::new();
        for related in &of_row {
            for (a, entry_a) in related {
                for (b, entry_b) in related {
                    let (row, column) = (*a as usize, *b as usize);
                    let slot = pattern.slot(row, column).ok_or(SolveError::NoSlot { row, column })?;
                    products.push((slot as u32, [*entry_a, *entry_b]));
                }
            }
        }
        let solver = DirectSolver::analyse(&pattern, None)?;
        let of_entries = starts
            .windows(2)
            .enumerate()
            .flat_map(|(relation, entries)| std::iter::repeat_n(relation as u32, entries[1] - entries[0]))
            .collect();
        let mut row_starts = vec![0];
        row_starts.extend(of_row.iter().scan(0, |sum, related| {
            *sum += related.len();
            Some(*sum)
        }));
        let bodies = bodies(&starts, &rows, of_row.len());
        let of_rows = of_row.concat();
        let matrix = BlockMatrix::zeros(pattern);
        Ok(Self {
            relations,
            starts,
            rows,
            of_entries,
            row_starts,
            of_rows,
            bodies,
            products,
            matrix,
            solver,
        })
    }

    pub(crate) fn relation_count(&self) -> usize {
        self.relations.len()
    }

    fn relation_of(&self, entry: u32) -> usize {
        self.of_entries[entry as usize] as usize
    }

    /// Rows of one body are related to each other; no relation is of two bodies.
    pub(crate) fn body(&self, row: usize) -> u32 {
        self.bodies[row]
    }

    /// The relations of a row, with the entry of each.
    pub(crate) fn entries_of(&self, row: usize) -> impl Iterator<Item = (usize, usize)> + '_ {
        let entries = &self.of_rows[self.row_starts[row]..self.row_starts[row + 1]];
        entries.iter().map(|(relation, entry)| (*relation as usize, *entry as usize))
    }

    /// `(J W Jᵀ)⁻¹` of numbers of relations, scaled.
    pub(crate) fn solve(&self, of_relations: &mut [Vec3]) -> Result<(), StepError> {
        self.solver.solve(of_relations).map_err(unsolved)
    }

    /// `W Jᵀ λ` of all relations, times a number and added to rows.
    fn spread(
        &self,
        scale: f64,
        multipliers: &[Vec3],
        gradients: &[Mat3],
        inverse: &[Mat3],
        rows: &mut [Vec3],
    ) {
        for (entries, multiplier) in self.starts.windows(2).zip(multipliers) {
            for entry in entries[0]..entries[1] {
                let row = self.rows[entry] as usize;
                rows[row] += inverse[row] * gradients[entry].transpose_apply(*multiplier) * scale;
            }
        }
    }
}

/// The body of each row: rows that relations join have the least of them.
fn bodies(starts: &[usize], rows: &[u32], row_count: usize) -> Vec<u32> {
    let mut least: Vec<u32> = (0..row_count as u32).collect();
    let root = |least: &mut [u32], mut row: u32| {
        while least[row as usize] != row {
            least[row as usize] = least[least[row as usize] as usize];
            row = least[row as usize];
        }
        row
    };
    for entries in starts.windows(2) {
        for pair in rows[entries[0]..entries[1]].windows(2) {
            let [a, b] = [root(&mut least, pair[0]), root(&mut least, pair[1])];
            least[a.max(b) as usize] = a.min(b);
        }
    }
    for row in 0..row_count as u32 {
        least[row as usize] = root(&mut least, row);
    }
    least
}

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
    let mut bound = std::mem::take(&mut ws.bound);
    let kept = bound.keep(step, sought, next, ws);
    ws.bound = bound;
    ws.stages.solve += clock.elapsed().as_secs_f64();
    kept
}

fn unsolved(error: SolveError) -> StepError {
    StepError::Linear { error: error.to_string(), block: None }
}

/// What of a relation a step cannot go on from.
fn fault(step: &Step, structure: &Structure, relation: usize, what: &str) -> StepError {
    let (force, number) = structure.relations[relation];
    let described = step.system.binding(force).map_or_else(String::new, |it| it.describe(number));
    StepError::Fault {
        force: step.system.forces[force].name().to_owned(),
        row: structure.rows[structure.starts[relation]] as usize,
        what: format!("{described} {what}"),
        time: step.start,
    }
}

impl Bound {
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
        self.lead(step, ws);
        self.look(step, structure, &ws.rows.positions, next)?;
        self.scale(step, structure)?;
        self.take_off(step, structure, next);
        self.multipliers.clear();
        self.multipliers.resize(structure.relations.len(), Vec3::ZERO);
        self.flow_on(step, structure, next);
        if structure.relation_count() > 0 {
            self.factorize(step, structure)?;
        }
        if sought == Sought::Accelerations || !step.system.has_contacts() {
            self.allow(step, structure);
            self.solve(step, structure)?;
            self.give(step, structure, next, &mut ws.row_force);
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
        self.allow(step, structure);
        loop {
            let solved = self.solve(step, structure)?;
            if structure.relation_count() > 0 {
                // to rounding: contacts of one body are to agree about where it is
                self.correct(step, structure)?;
            }
            let mut places = std::mem::take(&mut self.places);
            self.unpushed.clone_from(&places);
            let moving = self.moving(step, structure, &ws.rows.positions, solved);
            let improved = contacts.improve(&moving, next, &mut places);
            self.places = places;
            if !improved? {
                break;
            }
            self.yield_to_contacts(step, structure)?;
        }
        self.give(step, structure, next, &mut ws.row_force);
        let moving = self.moving(step, structure, &ws.rows.positions, Solved::AsBefore);
        let report = contacts.give(&moving, next, (&self.places, &mut ws.row_force));
        self.contacts = contacts;
        Ok(report)
    }

    /// Moves what contacts have pushed as relations let it move, by their gradients where the step starts. A push on one mass of a body would else bring
    /// it as much farther as the body is heavier than it, where the body has no shape any more and what relations are off by says nothing of
    /// the forces that they ask for.
    fn yield_to_contacts(&mut self, step: &Step, structure: &Structure) -> Result<(), StepError> {
        if structure.relation_count() == 0 {
            return Ok(());
        }
        let square = step.timestep * step.timestep;
        self.change.clear();
        for (entries, active) in structure.starts.windows(2).zip(&self.active) {
            let moved: Vec3 = (entries[0]..entries[1])
                .map(|entry| {
                    let row = structure.rows[entry] as usize;
                    self.gradients[entry] * (self.places[row] - self.unpushed[row])
                })
                .sum();
            self.change.push(Mat3::from_diagonal(*active) * moved * (-1.0 / square));
        }
        self.apply(step, structure)
    }

    fn moving<'a>(
        &'a self,
        step: &'a Step,
        structure: &'a Structure,
        positions: &'a [Vec3],
        solved: Solved,
    ) -> Moving<'a> {
        Moving {
            step,
            structure,
            positions,
            solved,
            before: &self.before,
            inverse_masses: &self.inverse_masses,
            gradients: &self.gradients,
            active: &self.active,
        }
    }

    fn factorize(&mut self, step: &Step, structure: &mut Structure) -> Result<(), StepError> {
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

    /// Takes the forces of the step before, which are among those that were summed, off where the step leads: such as do what others do
    /// too would never leave.
    fn take_off(&mut self, step: &Step, structure: &Structure, next: &SystemState) {
        self.before_step.clear();
        self.before_step.extend(structure.relations.iter().zip(&self.scales).map(
            |((force, relation), scale)| {
                let multiplier = multiplier(&next.memory[step.system.memory_range(*force)], *relation);
                Vec3::from_array([0, 1, 2].map(|axis| multiplier[axis] / scale[axis]))
            },
        ));
        let scale = -step.timestep * step.timestep;
        structure.spread(scale, &self.before_step, &self.gradients, &self.inverse_masses, &mut self.places);
    }

    /// Begins with those relations yielding that did so in the step before.
    fn flow_on(&mut self, step: &Step, structure: &Structure, next: &SystemState) {
        self.flowing.clear();
        self.change.clear();
        for (index, (force, relation)) in structure.relations.iter().enumerate() {
            let limit = step.system.binding(*force).and_then(|it| it.yields_at(*relation));
            let before = multiplier(&next.memory[step.system.memory_range(*force)], *relation).x;
            let flowing = match limit {
                Some(limit) if self.active[index].x > 0.0 => Flowing::of(before, limit),
                _ => Flowing::Not,
            };
            self.flowing.push(flowing);
            let mut change = Vec3::ZERO;
            if flowing != Flowing::Not {
                change.x = flowing.sign() * limit.unwrap_or(0.0) / self.scales[index].x;
                self.active[index].x = 0.0;
            }
            self.change.push(change);
        }
        self.push(step, structure);
    }

    /// Changes multipliers, and where the step leads with them.
    fn push(&mut self, step: &Step, structure: &Structure) {
        let square = step.timestep * step.timestep;
        structure.spread(square, &self.change, &self.gradients, &self.inverse_masses, &mut self.places);
        for (multiplier, change) in self.multipliers.iter_mut().zip(&self.change) {
            *multiplier += *change;
        }
    }

    /// Finds the multipliers under which the step leads to where all relations are what they are to be, but for those that give way.
    fn solve(&mut self, step: &Step, structure: &mut Structure) -> Result<Solved, StepError> {
        let mut solved = Solved::AsBefore;
        for _ in 0..MOST_SWITCHES {
            self.solve_held(step, structure)?;
            if !self.switch(step, structure) {
                return Ok(solved);
            }
            solved = Solved::WithOthers;
            self.factorize(step, structure)?;
        }
        let is_yielding = |index: &usize| self.flowing[*index] != Flowing::Not;
        let worst = (0..self.flowing.len()).find(is_yielding).unwrap_or(0);
        Err(self.unkept(step, structure, worst))
    }

    /// Lets relations give way whose multipliers are beyond their limits, and hold again those that would flow against what they push with;
    /// whether there were any.
    fn switch(&mut self, step: &Step, structure: &Structure) -> bool {
        let mut is_any = false;
        self.change.clear();
        for (index, (force, relation)) in structure.relations.iter().enumerate() {
            let mut change = Vec3::ZERO;
            let limit = step.system.binding(*force).and_then(|it| it.yields_at(*relation));
            if let Some(limit) = limit.map(|limit| limit / self.scales[index].x) {
                let (multiplier, is_active) = (self.multipliers[index].x, self.active[index].x > 0.0);
                let is_against = self.off[index].x * self.flowing[index].sign() < -self.near[index].x;
                if is_active && multiplier.abs() > limit {
                    self.flowing[index] = Flowing::of(multiplier, limit);
                    change.x = self.flowing[index].sign() * limit - multiplier;
                    self.active[index].x = 0.0;
                    is_any = true;
                } else if is_against {
                    self.flowing[index] = Flowing::Not;
                    self.active[index].x = 1.0;
                    is_any = true;
                }
            }
            self.change.push(change);
        }
        if is_any {
            self.push(step, structure);
        }
        is_any
    }

    /// The same with those that have given way pushing as they do.
    fn solve_held(&mut self, step: &Step, structure: &Structure) -> Result<(), StepError> {
        let mut solves = 0;
        while let Some(worst) = self.farthest_off(step, structure)? {
            if solves == MOST_SOLVES {
                return Err(self.unkept(step, structure, worst));
            }
            solves += 1;
            self.correct(step, structure)?;
        }
        Ok(())
    }

    /// Changes multipliers by what relations are off, and where the step leads with them.
    fn correct(&mut self, step: &Step, structure: &Structure) -> Result<(), StepError> {
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
    fn apply(&mut self, step: &Step, structure: &Structure) -> Result<(), StepError> {
        structure.solve(&mut self.change)?;
        self.push(step, structure);
        Ok(())
    }

    fn unkept(&self, step: &Step, structure: &Structure, worst: usize) -> StepError {
        let (force, relation) = structure.relations[worst];
        StepError::Unkept {
            force: step.system.forces[force].name().to_owned(),
            relation: step.system.binding(force).map_or_else(String::new, |it| it.describe(relation)),
            off: self.off[worst].length(),
            row: structure.rows[structure.starts[worst]] as usize,
            time: step.end(),
        }
    }

    /// Where the step leads without new forces, and where a step before led here.
    fn lead(&mut self, step: &Step, ws: &SystemWorkspace) {
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
    fn look(
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
            let Some(binding) = system.binding(*force) else { continue };
            binding.add_gradients(*relation, positions, start, &mut self.gradients);
            let memory = &next.memory[system.memory_range(*force)];
            let flow = Vec3::X * flow(memory, binding.relation_count(), *relation);
            let now = value_near(binding, *relation, (positions, start), flow);
            self.now.push(now);
            let earlier = self.earlier(step, structure, index, now, (positions, memory)).from(flow);
            let wanted = flow + binding.wanted(*relation, earlier, now - flow, start, timestep);
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
    fn earlier(
        &self,
        step: &Step,
        structure: &Structure,
        index: usize,
        now: Vec3,
        (positions, memory): (&[Vec3], &[f64]),
    ) -> Earlier {
        let Step { system, start, timestep, .. } = *step;
        let (force, relation) = structure.relations[index];
        let Some(binding) = system.binding(force) else { return Earlier::Rate(Vec3::ZERO) };
        // there is nothing before the start: a formula may have no value there
        let moment = (start - timestep).max(0.0);
        let before = || value_near(binding, relation, (&self.before, moment), now);
        if binding.is_told(relation) {
            return Earlier::Value(before());
        }
        let count = binding.relation_count();
        let (remembered, kind) = (earlier(memory, count, relation), memory[known_at(count)]);
        if kind == known::RATES {
            return Earlier::Rate(remembered);
        }
        if kind == known::VALUES {
            let before = before();
            let remembered = nearest(remembered, binding.period(relation), before);
            let near =
                self.tolerance(structure, index) + binding.magnitude(relation, positions, start) * ROUNDING;
            if (0..3).all(|axis| (before[axis] - remembered[axis]).abs() <= near[axis]) {
                return Earlier::Value(before);
            }
        }
        Earlier::Rate(binding.rate(relation, positions, &self.led, start))
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
    fn scale(&mut self, step: &Step, structure: &Structure) -> Result<(), StepError> {
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

    /// Lets relations be off by a share of what they are before any force too: the way to where they hold may be longer than places are far.
    fn allow(&mut self, step: &Step, structure: &Structure) {
        for (index, (force, relation)) in structure.relations.iter().enumerate() {
            let Some(binding) = step.system.binding(*force) else { continue };
            let wanted = self.wanted[index];
            let off = wanted - value_near(binding, *relation, (&self.places, step.end()), wanted);
            let magnitude = binding.magnitude(*relation, &self.places, step.end());
            self.near[index] += Vec3::from_array(off.to_array().map(|off| TOLERANCE * off.abs()));
            self.near[index] += magnitude * ROUNDING;
        }
    }

    /// The relation that is farthest from what it is to be where the step leads; `None` where all are near enough.
    fn farthest_off(&mut self, step: &Step, structure: &Structure) -> Result<Option<usize>, StepError> {
        self.off.clear();
        let mut worst: Option<(usize, f64)> = None;
        for (index, (force, relation)) in structure.relations.iter().enumerate() {
            let Some(binding) = step.system.binding(*force) else { continue };
            let wanted = self.wanted[index];
            let off = wanted - value_near(binding, *relation, (&self.places, step.end()), wanted);
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

    /// Adds the change of forces to those on rows, along what is free, and remembers multipliers, flows and work.
    fn give(&self, step: &Step, structure: &Structure, next: &mut SystemState, row_force: &mut [Vec3]) {
        let system = step.system;
        for (index, (force, relation)) in structure.relations.iter().enumerate() {
            let Some(binding) = system.binding(*force) else { continue };
            let memory = &mut next.memory[system.memory_range(*force)];
            let count = binding.relation_count();
            let mut multiplier = Mat3::from_diagonal(self.scales[index]) * self.multipliers[index];
            if let Some(limit) = binding.yields_at(*relation).filter(|_| self.flowing[index] != Flowing::Not)
            {
                // the limit itself, by which the next step knows that it flows
                multiplier.x = self.flowing[index].sign() * limit;
                let wanted = self.wanted[index];
                let value = value_near(binding, *relation, (&self.places, step.end()), wanted);
                memory[memory_len(count) + relation] += (value - wanted).x;
            }
            set_multiplier(memory, *relation, multiplier);
            set_earlier(memory, (count, *relation), known::VALUES, self.now[index]);
            for entry in structure.starts[index]..structure.starts[index + 1] {
                let row = structure.rows[entry] as usize;
                let whole = self.gradients[entry].transpose_apply(self.multipliers[index]);
                let change = self.multipliers[index] - self.before_step[index];
                let change = self.gradients[entry].transpose_apply(change);
                // m (W f) is f along what is free
                row_force[row] += self.inverse_masses[row] * change * system.mass.diagonal[row];
                // ½ m v'² − ½ m v² = f·(v + v') h/2
                memory[0] += 0.5 * whole.dot(self.places[row] - self.before[row]);
            }
        }
    }

    /// Remembers what relations change by in a second where a step was last sought from: a trajectory is about to move the velocity.
    pub(crate) fn remember_rates(&self, step: &Step, positions: &[Vec3], memory: &mut [f64]) {
        let relations = self.structure.iter().flat_map(|structure| &structure.relations);
        for (force, relation) in relations {
            let Some(binding) = step.system.binding(*force) else { continue };
            let rate = binding.rate(*relation, positions, &self.led, step.start);
            let memory = &mut memory[step.system.memory_range(*force)];
            set_earlier(memory, (binding.relation_count(), *relation), known::RATES, rate);
        }
    }

    pub(crate) fn bytes(&self) -> usize {
        let vectors = [
            &self.before,
            &self.places,
            &self.unpushed,
            &self.velocities,
            &self.wanted,
            &self.off,
            &self.change,
            &self.multipliers,
            &self.before_step,
            &self.active,
            &self.scales,
            &self.near,
            &self.now,
            &self.led,
        ];
        let matrices = self.gradients.capacity() + self.inverse_masses.capacity();
        vectors.into_iter().map(|vector| size_of::<Vec3>() * vector.capacity()).sum::<usize>()
            + size_of::<Mat3>() * matrices
            + size_of::<Flowing>() * self.flowing.capacity()
            + self.contacts.bytes()
            + self.structure.as_ref().map_or(0, |structure| {
                size_of_val(structure.products.as_slice())
                    + structure.matrix.bytes()
                    + structure.solver.bytes()
            })
    }
}
