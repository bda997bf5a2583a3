//! A system: bodies that step together. Its constant part, its scratch, and how its forces are summed.

use std::ops::Range;

use souple_math::{Mat3, Vec3, logarithm, orthonormalised};

use crate::binding::ConstraintSolver;
use crate::constraint::Constraint;
use crate::force::{Configuration, Energy, Force, Scratch, TangentWeights, Unmet};
use crate::holding::HeldPoints;
use crate::implicit::ImplicitBuffers;
use crate::interruption::Interruption;
use crate::kept::{Kept, KeptRef, Summed, make_room};
use crate::kinematics::Kinematics;
use crate::linear::LinearSolver;
use crate::mass::Mass;
use crate::state::{FieldState, Pair, SystemState, merge_pairs, pairs_of};
use crate::steppers::{StaggeredBuffers, StepError, Stepper};
use crate::tangent::Tangent;

/// The constant part of a system.
pub struct System {
    pub name: String,
    pub kinematics: Kinematics,
    pub mass: Mass,
    pub forces: Vec<Box<dyn Force>>,
    pub constraints: Vec<Constraint>,
    pub stepper: Box<dyn Stepper>,
    /// Whole steps in a period of the world.
    pub steps_per_period: u32,
}

/// What a system reads of the world around it.
#[derive(Clone, Copy, Debug)]
pub struct Surroundings<'a> {
    pub driven: &'a [f64],
    pub fields: &'a [FieldState],
    /// Fraction of the loads that acts (see [`Configuration::load`]).
    pub load: f64,
}

/// Scratch of a system: nothing here outlives a step.
pub struct SystemWorkspace {
    pub scratches: Vec<Scratch>,
    pub rows: Rows,
    /// Said before a step: rows are of the very state that is stepped, whose configuration and velocity are not copied
    /// (see [`crate::steppers::Stepper::reads_rows`]). Who steps takes it back.
    pub rows_are_the_state: bool,
    /// Said by a step that has looked: configuration and velocity are finite.
    pub state_is_finite: bool,
    /// The rows are those of the committed state.
    pub(crate) rows_are_committed: bool,
    pub row_force: Vec<Vec3>,
    /// Where steppers read no cliques, who takes it gives it the number of rows.
    pub row_scratch: Vec<Vec3>,
    /// Buffers for steppers in the size of the velocity; who takes one gives it that size.
    pub blocks: [Vec<Vec3>; 6],
    /// Changes of velocity by masses coupled to led points.
    pub taken_along: Vec<Vec3>,
    /// A buffer for steppers in the size of the configuration, likewise.
    pub configuration: Vec<Vec3>,
    pub found_pairs: Vec<Pair>,
    /// Where a step in parts is taken back to.
    mark: Mark,
    /// Rows at the last search of pairs. Every step begins with one, or every period with what was searched where that is in State, so
    /// nothing of it outlives the period.
    pub(crate) searched: Vec<Vec3>,
    /// How often pairs were searched since the workspace was made.
    pub(crate) searches: u64,
    /// Memories and pairs while they are moved on.
    before: SystemState,
    pub tangent: Tangent,
    pub linear: LinearSolver,
    pub implicit: Option<ImplicitBuffers>,
    pub staggered: StaggeredBuffers,
    pub held: HeldPoints,
    pub(crate) constraint_solver: ConstraintSolver,
    pub stages: StageTimes,
    /// What may break a step off.
    pub interruption: Interruption,
}

/// What a solve that fails leaves other than it was.
#[derive(Default)]
struct Mark {
    q: Vec<Vec3>,
    pairs: Vec<Pair>,
    /// Multipliers are moved on between solves.
    memory: Vec<f64>,
    searched: Vec<Vec3>,
}

/// Rows as they stand for one evaluation.
#[derive(Clone, Debug, Default)]
pub struct Rows {
    pub positions: Vec<Vec3>,
    pub velocities: Vec<Vec3>,
    pub time: f64,
}

/// Wall seconds spent by stage since the workspace was made.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StageTimes {
    pub pairs: f64,
    pub forces: f64,
    pub assembly: f64,
    pub solve: f64,
    /// The rest of a step: positions and velocities moved on, energies of the line search, internal variables.
    pub advance: f64,
    /// Fields of the world, as skins and the dresses of bodies with levels.
    pub fields: f64,
    /// Of `solve`: products with the tangent where no matrix is stored.
    pub products: f64,
}

impl std::ops::Sub for StageTimes {
    type Output = Self;

    /// What has been spent since an earlier count.
    fn sub(self, earlier: Self) -> Self {
        Self {
            pairs: self.pairs - earlier.pairs,
            forces: self.forces - earlier.forces,
            assembly: self.assembly - earlier.assembly,
            solve: self.solve - earlier.solve,
            advance: self.advance - earlier.advance,
            fields: self.fields - earlier.fields,
            products: self.products - earlier.products,
        }
    }
}

impl StageTimes {
    pub fn total(&self) -> f64 {
        self.pairs + self.forces + self.assembly + self.solve + self.advance + self.fields
    }

    /// What derivatives of forces took: matrices, and products where none is stored.
    pub fn derivatives(&self) -> f64 {
        self.assembly + self.products
    }
}

impl SystemWorkspace {
    /// Remembers configuration and pairs of a state, and where these were searched.
    pub(crate) fn mark(&mut self, state: &SystemState) {
        self.mark.q.clone_from(&state.q);
        self.mark.pairs.clone_from(&state.pairs);
        self.mark.memory.clone_from(&state.memory);
        self.mark.searched.clone_from(&self.searched);
    }

    /// Takes a state back to the mark.
    pub(crate) fn return_to_mark(&mut self, state: &mut SystemState) {
        state.q.clone_from(&self.mark.q);
        state.pairs.clone_from(&self.mark.pairs);
        state.memory.clone_from(&self.mark.memory);
        self.searched.clone_from(&self.mark.searched);
    }

    /// Bytes held for a system, scratches of its forces included.
    pub fn bytes(&self, system: &System) -> usize {
        let Rows { positions, velocities, .. } = &self.rows;
        let marked = [&self.mark.q, &self.mark.searched];
        let buffers = [positions, velocities, &self.row_force, &self.row_scratch, &self.searched];
        let buffers = buffers
            .into_iter()
            .chain(&self.blocks)
            .chain([&self.taken_along, &self.configuration])
            .chain(marked);
        let scratches = system.forces.iter().zip(&self.scratches);
        buffers.map(|buffer| size_of::<Vec3>() * buffer.capacity()).sum::<usize>()
            + scratches.map(|(force, scratch)| force.scratch_bytes(scratch)).sum::<usize>()
            + size_of::<Pair>()
                * (self.found_pairs.capacity() + self.mark.pairs.capacity() + self.before.pairs.capacity())
            + 8 * self.before.memory.capacity()
            + self.tangent.bytes()
            + self.linear.bytes()
            + self.held.bytes()
            + self.constraint_solver.bytes()
            + self.implicit.as_ref().map_or(0, ImplicitBuffers::bytes)
    }
}

/// Whether a force can be computed with: norms are roots of sums of squares.
fn is_usable(force: Vec3) -> bool {
    force.dot(force).is_finite()
}

impl System {
    /// Why its stepper cannot step it, in words that name what stands in the way.
    pub fn refused(&self) -> Option<String> {
        let levels = self.forces.iter().find(|force| force.levels().is_some());
        if let Some(force) = levels.filter(|_| !self.stepper.steps_levels()) {
            return Some(format!(
                "`{}` has levels, of which only some points move by themselves",
                force.name()
            ));
        }
        let holds = self.forces.iter().find(|force| force.holding().is_some());
        if let Some(force) = holds.filter(|_| !self.stepper.holds_points(self)) {
            return Some(format!(
                "`{}` moves the points that it holds, which `staggered` does of bodies with levels, and `symplectic_euler` of points with lumped masses",
                force.name()
            ));
        }
        let binds =
            self.forces.iter().find(|force| force.constraint_set().is_some() || force.unilateral().is_some());
        if let Some(force) = binds.filter(|_| !self.stepper.binds_points(self)) {
            let hindered = if !self.mass.is_lumped() {
                "; masses of this system are not lumped"
            } else if self.kinematics.has_frames() {
                "; this system has frames"
            } else if !self.kinematics.is_trivial() {
                "; some points of this system follow others"
            } else {
                ""
            };
            return Some(format!(
                "`{}` relates points by forces that are solved for, which `symplectic_euler` and `t_simulation` do of points with lumped masses{hindered}",
                force.name()
            ));
        }
        self.stepper.refuses(self)
    }

    /// Where each force's numbers stand in [`SystemState::memory`].
    pub fn memory_ranges(&self) -> Vec<Range<usize>> {
        let mut start = 0;
        let next = |force: &dyn Force| {
            let range = start..start + force.memory_len();
            start = range.end;
            range
        };
        self.forces.iter().map(AsRef::as_ref).map(next).collect()
    }

    /// Where the numbers of one force stand.
    pub(crate) fn memory_range(&self, force: usize) -> Range<usize> {
        let start = self.forces[..force].iter().map(|force| force.memory_len()).sum();
        start..start + self.forces[force].memory_len()
    }

    /// The state at rest in configuration `q`, with fresh memories.
    pub fn initial_state(&self, q: Vec<Vec3>) -> SystemState {
        let mut memory = vec![0.0; self.forces.iter().map(|force| force.memory_len()).sum()];
        for (force, range) in self.forces.iter().zip(self.memory_ranges()) {
            force.initial_memory(&mut memory[range]);
        }
        let v = vec![Vec3::ZERO; self.kinematics.block_count()];
        SystemState { q, v, memory, ..SystemState::default() }
    }

    pub fn new_workspace(&self) -> SystemWorkspace {
        let zeros = |count: usize| vec![Vec3::ZERO; count];
        let rows = self.kinematics.row_count();
        SystemWorkspace {
            scratches: self.forces.iter().map(|force| force.new_scratch()).collect(),
            rows: Rows { positions: zeros(rows), velocities: zeros(rows), time: 0.0 },
            rows_are_the_state: false,
            state_is_finite: false,
            rows_are_committed: false,
            row_force: zeros(rows),
            // explicit methods seldom need it
            row_scratch: zeros(if self.stepper.reads_cliques() { rows } else { 0 }),
            blocks: Default::default(),
            taken_along: Vec::new(),
            configuration: Vec::new(),
            found_pairs: Vec::new(),
            mark: Mark::default(),
            searched: Vec::new(),
            searches: 0,
            before: SystemState::default(),
            tangent: Tangent::default(),
            linear: LinearSolver::new(self.stepper.solver_settings()),
            implicit: None,
            staggered: StaggeredBuffers::default(),
            held: HeldPoints::default(),
            constraint_solver: ConstraintSolver::default(),
            stages: StageTimes::default(),
            interruption: Interruption::default(),
        }
    }

    /// Brings rows to `(q, v)` at `time`.
    pub fn place_rows(&self, q: &[Vec3], v: &[Vec3], time: f64, rows: &mut Rows) {
        self.kinematics.rows_into(q, v, &mut rows.positions, &mut rows.velocities);
        rows.time = time;
    }

    /// What force number `force` sees.
    pub fn view<'a>(
        &self,
        force: usize,
        rows: &'a Rows,
        state: &'a SystemState,
        around: &Surroundings<'a>,
    ) -> Configuration<'a> {
        Configuration {
            memory: &state.memory[self.memory_range(force)],
            kept: state.kept.of_force(force, |force| self.forces[force].kept_len().unwrap_or(0)),
            ..Self::view_of_pairs(force, rows, &state.pairs, around)
        }
    }

    /// The same of a force that remembers nothing but pairs.
    fn view_of_pairs<'a>(
        force: usize,
        rows: &'a Rows,
        pairs: &'a [Pair],
        around: &Surroundings<'a>,
    ) -> Configuration<'a> {
        Configuration {
            positions: &rows.positions,
            velocities: &rows.velocities,
            time: rows.time,
            load: around.load,
            memory: &[],
            pairs: &pairs[pairs_of(pairs, force)],
            kept: KeptRef::default(),
            driven: around.driven,
            fields: around.fields,
        }
    }

    /// `row_force = Σ f` at the placed rows.
    pub fn sum_row_forces(
        &self,
        rows: &Rows,
        state: &SystemState,
        around: &Surroundings,
        scratches: &mut [Scratch],
        row_force: &mut [Vec3],
    ) {
        row_force.fill(Vec3::ZERO);
        for (index, force) in self.forces.iter().enumerate() {
            force.add_force(&self.view(index, rows, state, around), &mut scratches[index], row_force);
        }
    }

    /// The first force that is not finite, or whose norm is not, at the placed rows, evaluated one by one; `None` where all are.
    pub fn first_force_not_finite(
        &self,
        rows: &Rows,
        state: &SystemState,
        around: &Surroundings,
        scratches: &mut [Scratch],
    ) -> Option<StepError> {
        self.find_force(rows, state, around, scratches, |force, alone| {
            let row = alone.iter().position(|f| !is_usable(*f))?;
            let (force, value) = (force.name().to_owned(), alone[row].to_array());
            Some(StepError::ForceNotFinite { force, row, value, time: rows.time })
        })
    }

    /// The first force whose energy is not finite at the placed rows; `None` where all are.
    pub fn first_energy_not_finite(
        &self,
        rows: &Rows,
        state: &SystemState,
        around: &Surroundings,
        scratches: &mut [Scratch],
    ) -> Option<StepError> {
        self.forces.iter().zip(scratches).enumerate().find_map(|(index, (force, scratch))| {
            let energy = force.energy(&self.view(index, rows, state, around), scratch).stored;
            let force = || force.name().to_owned();
            (!energy.is_finite()).then(|| StepError::EnergyNotFinite { force: force(), time: rows.time })
        })
    }

    /// The first force whose differential is not finite, or has no finite norm, at the placed rows, evaluated one by one; `None` where all are.
    pub fn first_slope_not_finite(
        &self,
        rows: &Rows,
        state: &SystemState,
        around: &Surroundings,
        weights: TangentWeights,
        scratches: &mut [Scratch],
    ) -> Option<StepError> {
        // of no direction that a slope might vanish in
        let delta: Vec<Vec3> = (0..rows.positions.len())
            .map(|row| Vec3::new(1.0, 2.0_f64.sqrt(), 3.0_f64.sqrt()) * (1.0 + (row as f64).sin().abs()))
            .collect();
        let add = |force: &dyn Force, at: &Configuration, scratch: &mut Scratch, out: &mut [Vec3]| {
            force.add_differential(at, weights, &delta, scratch, out);
        };
        self.find_alone(rows, state, around, scratches, add, |force, alone| {
            let row = alone.iter().position(|f| !is_usable(*f))?;
            Some(StepError::SlopeNotFinite { force: force.name().to_owned(), row, time: rows.time })
        })
    }

    /// The norm of the largest force at the placed rows, evaluated one by one: what is balanced where the sum is nothing [N].
    pub fn largest_force(
        &self,
        rows: &Rows,
        state: &SystemState,
        around: &Surroundings,
        scratches: &mut [Scratch],
    ) -> f64 {
        let mut largest = 0.0_f64;
        self.find_force(rows, state, around, scratches, |_, alone| -> Option<()> {
            largest = largest.max(souple_solve::reduce::norm(alone));
            None
        });
        largest
    }

    /// What is found first by a look at each force alone, at the placed rows.
    fn find_force<T>(
        &self,
        rows: &Rows,
        state: &SystemState,
        around: &Surroundings,
        scratches: &mut [Scratch],
        look: impl FnMut(&dyn Force, &[Vec3]) -> Option<T>,
    ) -> Option<T> {
        let add = |force: &dyn Force, at: &Configuration, scratch: &mut Scratch, out: &mut [Vec3]| {
            force.add_force(at, scratch, out);
        };
        self.find_alone(rows, state, around, scratches, add, look)
    }

    /// The same of whatever is added up of each force.
    fn find_alone<T>(
        &self,
        rows: &Rows,
        state: &SystemState,
        around: &Surroundings,
        scratches: &mut [Scratch],
        add: impl Fn(&dyn Force, &Configuration, &mut Scratch, &mut [Vec3]),
        mut look: impl FnMut(&dyn Force, &[Vec3]) -> Option<T>,
    ) -> Option<T> {
        let mut alone = vec![Vec3::ZERO; rows.positions.len()];
        self.forces.iter().enumerate().find_map(|(index, force)| {
            alone.fill(Vec3::ZERO);
            let at = self.view(index, rows, state, around);
            add(force.as_ref(), &at, &mut scratches[index], &mut alone);
            look(force.as_ref(), &alone)
        })
    }

    /// Whether any force acts on pairs that come and go.
    pub fn has_pairs(&self) -> bool {
        self.forces.iter().any(|force| force.declaration().changing_pattern)
    }

    /// `(a ∂f/∂x + b ∂f/∂v) δ` summed over forces, for row displacements `delta`.
    pub fn sum_row_differentials(
        &self,
        ws: &mut SystemWorkspace,
        state: &SystemState,
        around: &Surroundings,
        weights: TangentWeights,
        delta: &[Vec3],
        out: &mut [Vec3],
    ) {
        out.fill(Vec3::ZERO);
        for (index, force) in self.forces.iter().enumerate() {
            let at = self.view(index, &ws.rows, state, around);
            force.add_differential(&at, weights, delta, &mut ws.scratches[index], out);
        }
    }

    /// Stored and dissipated energy of each force [J].
    pub fn energies(
        &self,
        ws: &mut SystemWorkspace,
        state: &SystemState,
        around: &Surroundings,
    ) -> Vec<Energy> {
        let scratches = &mut ws.scratches;
        self.forces
            .iter()
            .enumerate()
            .map(|(index, force)| {
                force.energy(&self.view(index, &ws.rows, state, around), &mut scratches[index])
            })
            .collect()
    }

    /// The new list of pairs at `(q, v)`: those still there keep their memory.
    pub fn update_pairs(&self, ws: &mut SystemWorkspace, state: &mut SystemState, around: &Surroundings) {
        ws.found_pairs.clear();
        for (index, force) in self.forces.iter().enumerate() {
            let first = ws.found_pairs.len();
            let at = self.view(index, &ws.rows, state, around);
            force.find_pairs(&at, &mut ws.scratches[index], &mut ws.found_pairs);
            for pair in &mut ws.found_pairs[first..] {
                pair.force = index as u64;
            }
        }
        merge_pairs(&mut state.pairs, &mut ws.found_pairs);
        ws.searched.clone_from(&ws.rows.positions);
        ws.searches += 1;
    }

    /// [`System::update_pairs`] at the placed rows if those of the last search are stale there; whether they were.
    pub fn refresh_pairs(
        &self,
        ws: &mut SystemWorkspace,
        state: &mut SystemState,
        around: &Surroundings,
    ) -> bool {
        let stale = |(index, force): (usize, &dyn Force)| {
            let at = self.view(index, &ws.rows, state, around);
            let scratch = &ws.scratches[index];
            force.declaration().changing_pattern && force.pairs_are_stale(&ws.searched, &at, scratch)
        };
        let is_stale = self.forces.iter().map(AsRef::as_ref).enumerate().any(stale);
        if is_stale {
            self.update_pairs(ws, state, around);
        }
        is_stale
    }

    /// Moves memories and pair states on at the placed rows.
    pub fn advance_memory(
        &self,
        ws: &mut SystemWorkspace,
        state: &mut SystemState,
        around: &Surroundings,
        timestep: f64,
        summed: Summed,
    ) {
        self.advance_memory_of(&|_| true, ws, state, around, timestep, summed);
    }

    /// The same of some forces, by their numbers; memories of the others stay.
    pub fn advance_memory_of(
        &self,
        moves_on: &dyn Fn(usize) -> bool,
        ws: &mut SystemWorkspace,
        state: &mut SystemState,
        around: &Surroundings,
        timestep: f64,
        summed: Summed,
    ) {
        // forces read the memory as it was: they are pure, and see their own part only
        let before = &mut ws.before;
        before.pairs.clone_from(&state.pairs);
        self.copy_memory(&state.memory, &mut before.memory);
        // what is kept is written anew over what was, which sums of forces have read
        if summed == Summed::Elsewhere {
            for (index, force) in
                self.forces.iter().enumerate().filter(|(_, force)| force.kept_len().is_some())
            {
                force.look_at_kept(&self.view(index, &ws.rows, state, around), &mut ws.scratches[index]);
            }
        }
        state.kept.clear();
        let (mut own, mut copied) = (0..0, 0..0);
        for (index, force) in self.forces.iter().enumerate() {
            let len = force.memory_len();
            own = own.end..own.end + len;
            copied = copied.end..copied.end + if force.advances_in_place() { 0 } else { len };
            let at = Configuration {
                memory: &before.memory[copied.clone()],
                ..Self::view_of_pairs(index, &ws.rows, &before.pairs, around)
            };
            let memory = &mut state.memory[own.clone()];
            if force.kept_len().is_some() {
                let Kept { counts, keys, .. } = &mut state.kept;
                let first = keys.len();
                counts.resize(index + 1, 0);
                force.advance_kept(&at, &mut ws.scratches[index], memory, &mut state.kept);
                state.kept.counts[index] = (state.kept.keys.len() - first) as u64;
                continue;
            }
            if !moves_on(index) {
                continue;
            }
            let pairs = pairs_of(&state.pairs, index);
            force.advance_memory(&at, timestep, memory, &mut state.pairs[pairs]);
        }
    }

    /// The memories of the forces that do not advance theirs in place, one after the other.
    fn copy_memory(&self, memory: &[f64], copy: &mut Vec<f64>) {
        copy.clear();
        let mut own = 0..0;
        for force in &self.forces {
            own = own.end..own.end + force.memory_len();
            if !force.advances_in_place() {
                make_room(copy, own.len());
                copy.extend_from_slice(&memory[own.clone()]);
            }
        }
    }

    /// Breaks what bears too much at the placed rows; names of the forces of which something broke.
    pub fn give_way(
        &self,
        ws: &mut SystemWorkspace,
        state: &mut SystemState,
        around: &Surroundings,
    ) -> Vec<String> {
        ws.before.memory.clone_from(&state.memory);
        ws.before.pairs.clone_from(&state.pairs);
        let mut broke = Vec::new();
        for (index, force) in self.forces.iter().enumerate() {
            let at = self.view(index, &ws.rows, &ws.before, around);
            if force.give_way(&at, &mut state.memory[self.memory_range(index)]) {
                broke.push(force.name().to_owned());
            }
        }
        broke
    }

    /// Lets forces move their multipliers on at the placed rows; what is off most of what it may be, and the number of its force.
    pub fn augment(&self, rows: &Rows, state: &mut SystemState) -> Option<(usize, Unmet)> {
        let mut worst: Option<(usize, Unmet)> = None;
        for (index, force) in self.forces.iter().enumerate() {
            let memory = &mut state.memory[self.memory_range(index)];
            let Some(unmet) = force.augment(&rows.positions, memory) else { continue };
            let share = |unmet: &Unmet| unmet.off / unmet.wanted;
            if worst.as_ref().is_none_or(|(_, known)| share(known) < share(&unmet)) {
                worst = Some((index, unmet));
            }
        }
        worst
    }

    /// What of a force cannot be at the placed rows.
    pub fn fault(&self, rows: &Rows, state: &SystemState, around: &Surroundings) -> Option<StepError> {
        self.forces.iter().enumerate().find_map(|(index, force)| {
            let (row, what) = force.fault(&self.view(index, rows, state, around))?;
            Some(StepError::Fault { force: force.name().to_owned(), row, what, time: rows.time })
        })
    }

    /// Whether forces change their memory between steps.
    pub fn ends_steps(&self) -> bool {
        self.forces.iter().any(|force| force.ends_steps())
    }

    /// Lets forces change their memory at the placed rows, those that a step came to.
    pub fn end_step(&self, rows: &Rows, timestep: f64, state: &mut SystemState) {
        let mut jumped = false;
        for (index, force) in self.forces.iter().enumerate().filter(|(_, force)| force.ends_steps()) {
            jumped |= force.end_step(&rows.positions, timestep, &mut state.memory[self.memory_range(index)]);
        }
        if jumped {
            self.stepper.forget_forces(state);
        }
    }

    /// Lets forces that hold points look which, at the placed rows, where a period begins.
    pub fn look(&self, ws: &mut SystemWorkspace, state: &mut SystemState, around: &Surroundings) {
        ws.before.memory.clone_from(&state.memory);
        ws.before.pairs.clone_from(&state.pairs);
        for (index, force) in self.forces.iter().enumerate() {
            let Some(holding) = force.holding() else { continue };
            let at = self.view(index, &ws.rows, &ws.before, around);
            holding.look(&at, &mut ws.scratches[index], &mut state.memory[self.memory_range(index)]);
        }
    }

    /// Kinetic energy at the placed rows [J].
    pub fn kinetic_energy(&self, rows: &Rows) -> f64 {
        self.mass.kinetic_energy(&rows.velocities)
    }

    /// Linear [kg m/s] and angular momentum about the origin [kg m²/s] at the placed rows.
    pub fn momentum(&self, rows: &Rows) -> (Vec3, Vec3) {
        let mut momentum = vec![Vec3::ZERO; rows.velocities.len()];
        self.mass.add_product(&rows.velocities, &mut momentum);
        let linear =
            (0..momentum.len()).map(|row| momentum[row] * self.kinematics.translation_weight(row)).sum();
        let angular = rows.positions.iter().zip(&momentum).map(|(x, p)| x.cross(*p)).sum();
        (linear, angular)
    }

    /// Sets the constrained components of a configuration and its velocity to where they are led.
    pub fn impose_constraints(&self, q: &mut [Vec3], v: &mut [Vec3], time: f64, load: f64) {
        for constraint in &self.constraints {
            let block = constraint.block as usize;
            v[block] = constraint.free * v[block] + constraint.constrained() * constraint.velocity(time);
            if let (Some(axes), Some(row)) =
                (&constraint.axes, self.kinematics.row_of_block(constraint.block))
            {
                let turned = orthonormalised(&constraint.turned(axes, time, load));
                q[row as usize..row as usize + 3].copy_from_slice(&turned.columns);
            } else if let Some(row) = self.kinematics.point_block_row(constraint.block) {
                let q = &mut q[row as usize];
                *q += constraint.constrained() * (constraint.position(time, load) - *q);
            }
        }
    }

    /// The first motion that is not finite at a time.
    pub fn motion_not_finite(&self, time: f64) -> Option<StepError> {
        self.constraints.iter().find_map(|constraint| {
            let motion = constraint.motion.as_ref()?;
            let offset = motion.offset(constraint.start, time);
            let velocity = motion.velocity(constraint.start, time);
            let (what, value) = if is_usable(offset) { ("velocity", velocity) } else { ("motion", offset) };
            let (block, value) =
                (constraint.block as usize, (!is_usable(value)).then_some(value.to_array())?);
            Some(StepError::MotionNotFinite { what, block, value, time })
        })
    }

    /// How far the block of a constraint is from where it is led: the displacement that [`Kinematics::retract`] takes it
    /// there by, along directions that are left free too.
    pub fn to_go(&self, constraint: &Constraint, q: &[Vec3], time: f64, load: f64) -> Vec3 {
        if let Some(axes) = &constraint.axes {
            let Some(row) = self.kinematics.row_of_block(constraint.block) else { return Vec3::ZERO };
            let now = Mat3::from_columns(q[row as usize], q[row as usize + 1], q[row as usize + 2]);
            return logarithm(&constraint.turned(axes, time, load).mul_transpose(&now));
        }
        let row = self.kinematics.point_block_row(constraint.block);
        row.map_or(Vec3::ZERO, |row| constraint.position(time, load) - q[row as usize])
    }

    /// Adds to rows what velocity blocks `led` of a constraint move: a point, or the axes of a frame that turns.
    pub fn add_led(&self, constraint: &Constraint, led: Vec3, q: &[Vec3], rows: &mut [Vec3]) {
        if let Some(row) = self.kinematics.point_block_row(constraint.block) {
            rows[row as usize] += led;
        } else if let Some(row) = self.kinematics.row_of_block(constraint.block) {
            (row as usize..row as usize + 3).for_each(|row| rows[row] += led.cross(q[row]));
        }
    }

    /// Removes the constrained components of a vector over velocity blocks.
    pub fn project_free(&self, blocks: &mut [Vec3]) {
        for constraint in &self.constraints {
            let block = &mut blocks[constraint.block as usize];
            *block = constraint.free * *block;
        }
    }

    /// Removes the constrained components of row displacements, where rows are points.
    pub fn project_free_rows(&self, rows: &mut [Vec3]) {
        for constraint in &self.constraints {
            if let Some(row) = self.kinematics.point_block_row(constraint.block) {
                let row = &mut rows[row as usize];
                *row = constraint.free * *row;
            }
        }
    }

    /// A position for every velocity block (the frame's origin for all of its blocks), for orderings and
    /// rigid modes.
    pub fn block_positions_into(&self, row_positions: &[Vec3], positions: &mut Vec<Vec3>) {
        positions.resize(self.kinematics.block_count(), Vec3::ZERO);
        let mut row = 0;
        for (kind, blocks) in self.kinematics.unknowns() {
            positions[blocks].fill(row_positions[row]);
            row += kind.row_count();
        }
    }
}
