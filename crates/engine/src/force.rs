//! A force is a term in a list: what it declares, and what it answers.
//!
//! Forces address *rows* (see [`crate::kinematics`]) and are pure: `(positions, velocities, time, memory)` in,
//! energy, force and derivatives out, as often as a stepper likes within one step. What a force remembers
//! lives in [`crate::State`] and moves on once a step, in [`Force::advance_memory`].

use std::any::Any;

use souple_math::{Mat3, Vec3};
use souple_solve::BlockMatrix;

use crate::Obstacle;
use crate::binding::ConstraintSet;
use crate::hand::InHand;
use crate::holding::Holding;
use crate::kept::{Kept, KeptRef};
use crate::levels::Levels;
use crate::state::{FieldState, Pair};
use crate::unilateral::Unilateral;

/// What a force reads: the rows as they stand, and its own memory.
#[derive(Clone, Copy, Debug)]
pub struct Configuration<'a> {
    /// Row positions [m].
    pub positions: &'a [Vec3],
    /// Row velocities [m/s].
    pub velocities: &'a [Vec3],
    /// [s]
    pub time: f64,
    /// Fraction of the loads that acts: 1 in dynamics, growing to 1 over the load steps of `static`.
    pub load: f64,
    /// This force's own memory.
    pub memory: &'a [f64],
    /// This force's own pairs, sorted by `(a, b)`.
    pub pairs: &'a [Pair],
    /// What this force remembers of things that come and go without pairs.
    pub kept: KeptRef<'a>,
    /// Driven parameters and exchanged quantities of the whole world.
    pub driven: &'a [f64],
    /// Committed fields of the whole world.
    pub fields: &'a [FieldState],
}

/// What a force is, so that steppers and solvers can refuse what they cannot treat.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Declaration {
    /// The force is minus the gradient of [`Energy::stored`] at fixed memory and time.
    pub conservative: bool,
    /// The force depends on velocities.
    pub velocity_terms: bool,
    /// `∂f/∂x` and `∂f/∂v` are symmetric.
    pub symmetric_tangent: bool,
    /// Internal: no net force or torque on the world.
    pub internal: bool,
    /// The rows it couples change with its pairs.
    pub changing_pattern: bool,
}

impl Declaration {
    /// A conservative internal force without velocity terms.
    pub const ELASTIC: Self = Self {
        conservative: true,
        velocity_terms: false,
        symmetric_tangent: true,
        internal: true,
        changing_pattern: false,
    };
    /// A conservative force from outside.
    pub const LOAD: Self = Self { internal: false, ..Self::ELASTIC };
}

/// Energy that a force accounts for [J].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energy {
    pub stored: f64,
    /// Given off since the start, as far as the force's memory keeps account of it.
    pub dissipated: f64,
}

/// `position · ∂f/∂x + velocity · ∂f/∂v`: what an implicit method asks of a force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TangentWeights {
    pub position: f64,
    pub velocity: f64,
}

/// A parameter that may be edited while the world runs.
#[derive(Clone, Debug, PartialEq)]
pub struct Editable {
    pub name: &'static str,
    pub unit: &'static str,
    pub value: f64,
}

/// Why a parameter was not changed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ParameterError {
    #[error("force `{force}` has no parameter `{name}` that can be changed while running; it has: {}", .known.join(", "))]
    Unknown { force: String, name: String, known: Vec<String> },
    #[error("`{name}` of force `{force}` cannot be {value}; it must be {expected}")]
    Unfit { force: String, name: String, value: f64, expected: String },
}

/// What a force knows of a cell of its mesh: means over the cell's volume.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CellField {
    /// Deformation gradient.
    pub deformation: Mat3,
    /// First Piola–Kirchhoff stress [Pa].
    pub stress: Mat3,
    /// Cauchy stress [Pa]; zero where the cell has no volume.
    pub cauchy: Mat3,
    /// `√(3/2 s:s)` of the deviator `s` of the Cauchy stress [Pa].
    pub von_mises: f64,
    /// Stored energy per rest volume [J/m³].
    pub energy_density: f64,
    /// Rest volume [m³].
    pub volume: f64,
    /// Volume as the cell stands, negative where it is inside out [m³].
    pub current_volume: f64,
}

/// What law a cell has, of a force whose cells change theirs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Adapted {
    /// 0 for the first law, 1 for the second.
    pub law: f64,
    /// The greatest criterion over its threshold: above 1 the second law is wanted.
    pub excess: f64,
}

/// What changes of law there were, of a force whose cells change theirs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LawChanges {
    pub count: f64,
    /// What they took from what is stored [J]; below zero: gave.
    pub taken: f64,
}

/// A point that touches, and what that does to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactPoint<'a> {
    /// Row of the point.
    pub row: u32,
    /// Rows that bear the opposite force, with their shares; none of a shape.
    pub against: &'a [(u32, f64)],
    /// How deep the point is, thickness included [m].
    pub penetration: f64,
    /// Along the normal, on the point [N].
    pub normal_force: Vec3,
    /// Across it, on the point [N].
    pub friction: Vec3,
}

/// How far something that multipliers keep was off.
#[derive(Clone, Debug, PartialEq)]
pub struct Unmet {
    /// In words: what, and of what it is a share.
    pub what: &'static str,
    pub off: f64,
    pub wanted: f64,
    /// Where it is off most.
    pub row: usize,
}

/// A link between two rows as it stands, for pictures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinkShown {
    pub ends: [u32; 2],
    pub state: LinkState,
    /// Positive where it pushes its ends apart [N].
    pub push: f64,
}

/// What holds the ends of a link together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LinkState {
    /// Nothing: it is torn, or its ends are out of its reach.
    Apart,
    /// Its law, in the state of this number; 0 is that of the start.
    In(u8),
}

/// Buffers of one force, kept between calls; made by [`Force::new_scratch`], opaque to everyone else.
pub type Scratch = Box<dyn Any + Send + Sync>;

/// One term of the sum of forces.
pub trait Force: Send + Sync {
    /// Unique within a system: the body and what the force is, as `bar.material`.
    fn name(&self) -> &str;

    fn declaration(&self) -> Declaration;

    /// Whether its tangent is that of the material alone, without what its stress adds where it turns.
    fn leaves_out_stress(&self) -> bool {
        false
    }

    /// Numbers of memory it keeps in State.
    fn memory_len(&self) -> usize {
        0
    }

    /// Whether its tangent follows from its memory too, and not from rows alone; false where that is an account of energy.
    fn tangent_reads_memory(&self) -> bool {
        self.memory_len() > 0
    }

    fn initial_memory(&self, memory: &mut [f64]) {
        memory.fill(0.0);
    }

    fn new_scratch(&self) -> Scratch {
        Box::new(())
    }

    fn energy(&self, at: &Configuration, scratch: &mut Scratch) -> Energy;

    /// `out += f(x, v)` on rows [N].
    fn add_force(&self, at: &Configuration, scratch: &mut Scratch, out: &mut [Vec3]);

    /// `out += (a ∂f/∂x + b ∂f/∂v) δ` with row displacements `delta`.
    fn add_differential(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        delta: &[Vec3],
        scratch: &mut Scratch,
        out: &mut [Vec3],
    );

    /// The groups of rows it couples: each is a clique of the matrix pattern.
    fn visit_cliques(&self, pairs: &[Pair], visit: &mut dyn FnMut(&[u32]));

    /// Calls `visit` for the rows that it may push as long as no row is farther than `slack` [m] from where it is at `at`; by default
    /// all of its cliques. Steppers that ask forces many times in a step leave the others behind meanwhile, and do not ask a force
    /// that visits none: neither of the rows left out nor of a memory that was moved on without them may anything be seen in what it
    /// gives before it reaches them.
    fn visit_reach(&self, at: &Configuration, _slack: f64, visit: &mut dyn FnMut(u32)) {
        self.visit_cliques(at.pairs, &mut |rows| rows.iter().for_each(|row| visit(*row)));
    }

    /// Whether all rows that it reads are unknowns or in its cliques, for what carries no unknown of its own and is only
    /// looked at need not be placed then where a step tries things out.
    fn reads_cliques_alone(&self) -> bool {
        false
    }

    /// `matrix += a ∂f/∂x + b ∂f/∂v` over rows, in blocks of the pattern that its cliques made.
    fn add_blocks(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        scratch: &mut Scratch,
        matrix: &mut BlockMatrix,
    );

    /// `matrix += a ∂f/∂x + b ∂f/∂v` near enough to precondition with, but symmetric, and of one sign where the exact
    /// blocks are so only for want of symmetry. Asked of forces whose tangent is not symmetric.
    fn add_symmetric_blocks(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        scratch: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) {
        self.add_blocks(at, weights, scratch, matrix);
    }

    /// `matrix += a ∂f/∂x + b ∂f/∂v` for weights that are not positive, without negative curvature: where the matrix of
    /// a part (an element, a link) has negative eigenvalues, their absolute values take their place. Asked of forces whose
    /// tangent is symmetric; those that keep their blocks as they are may leave the sum indefinite. Returns whether there
    /// was anything to turn round.
    fn add_definite_blocks(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        scratch: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) -> bool {
        self.add_blocks(at, weights, scratch, matrix);
        false
    }

    /// Moves memory and pair states on by one step that ended (implicit) or started (explicit) at `at`.
    fn advance_memory(&self, _at: &Configuration, _timestep: f64, _memory: &mut [f64], _pairs: &mut [Pair]) {}

    /// Whether [`Force::advance_memory`] reads its memory where it writes it, and none in `at`: a memory of many numbers is not
    /// copied for it then.
    fn advances_in_place(&self) -> bool {
        false
    }

    /// Breaks at once what bears more than it can where the rows stand, in its memory; whether anything broke. For steppers that know
    /// equilibrium alone, which seek it again then; what does not answer here breaks in [`Force::advance_memory`], when the step has ended.
    fn give_way(&self, _at: &Configuration, _memory: &mut [f64]) -> bool {
        false
    }

    /// Where what it is to keep is farther off than it may be, moves its multipliers on, in its memory, by what its penalty bears where the
    /// rows stand, and says how far off it was; `None` where it is near enough, and nothing of its memory changed. For steppers that
    /// [augment](crate::steppers::Stepper::augments), which solve on then.
    fn augment(&self, _positions: &[Vec3], _memory: &mut [f64]) -> Option<Unmet> {
        None
    }

    /// Whether its [`Force::end_step`] does anything.
    fn ends_steps(&self) -> bool {
        false
    }

    /// What of its memory changes between one step and the next, at the rows that a step of `timestep` [s] came to, whatever the
    /// stepper: a change of what energy is stored there is a jump at that very state, which can be booked exactly. Returns whether its
    /// force has jumped.
    fn end_step(&self, _positions: &[Vec3], _timestep: f64, _memory: &mut [f64]) -> bool {
        false
    }

    /// Numbers of an entry of [`Kept`] of a force that has such; it finds by itself what acts on what, without pairs, and
    /// its [`Force::advance_kept`] is asked in the place of [`Force::advance_memory`].
    fn kept_len(&self) -> Option<usize> {
        None
    }

    /// Brings its scratch to what a sum of forces at `at` leaves there, for a stepper that summed them elsewhere: what was kept is
    /// read here for the last time.
    fn look_at_kept(&self, _at: &Configuration, _scratch: &mut Scratch) {}

    /// Moves memory on, and writes what it keeps after this step behind the entries of other forces, by ascending keys, from
    /// what the sum of forces left in its scratch. There is nothing kept in `at`: what is written takes its place.
    fn advance_kept(
        &self,
        _at: &Configuration,
        _scratch: &mut Scratch,
        _memory: &mut [f64],
        _kept: &mut Kept,
    ) {
    }

    /// What a change of its numbers makes or takes [J]: what it stores, and of laws that remember what they are about to give off of it.
    fn held(&self, at: &Configuration, scratch: &mut Scratch) -> f64 {
        self.energy(at, scratch).stored
    }

    /// The row and, in words, what of its memory or of what it is told by formulas cannot be at the end of a period; such a step is refused.
    fn fault(&self, _at: &Configuration) -> Option<(usize, String)> {
        None
    }

    /// Whether a key read from a file is one that it could have written: an index beyond its data would be a panic.
    fn accepts_key(&self, _key: u64) -> bool {
        false
    }

    /// Calls `visit` for every two rows that act on each other without pairs in State.
    fn visit_near(&self, _at: &Configuration, _scratch: &Scratch, _visit: &mut dyn FnMut([u32; 2])) {}

    /// Pairs that may interact at this configuration, in any order; each comes with its initial state.
    fn find_pairs(&self, _at: &Configuration, _scratch: &mut Scratch, _found: &mut Vec<Pair>) {}

    /// Whether pairs found at the rows `searched` may miss what touches now: the list is then searched again, in explicit
    /// steps before the force, in implicit ones between solves, never while one iterates. The scratch is that of the search.
    fn pairs_are_stale(&self, _searched: &[Vec3], _now: &Configuration, _scratch: &Scratch) -> bool {
        false
    }

    /// Brings its scratch to what [`Force::find_pairs`] left there at `searched`, of which velocities, pairs and what is kept are not
    /// known any more: for pairs that were found elsewhere.
    fn recall_search(&self, _searched: &Configuration, _scratch: &mut Scratch) {}

    /// Brings the memory of a pair that was found one period ago, and was not known yet, to what it begins with now.
    fn bring_up(&self, _now: &Configuration, _pair: &mut Pair) {}

    /// Stiffness that comes to act on rows when all that may touch does, `(row, [N/m])`: a bound from above by a diagonal
    /// matrix, which forecasts take in place of the tangent as it stands. `None`: the tangent tells all.
    fn touching_stiffness(&self) -> Option<Vec<(u32, f64)>> {
        None
    }

    /// Whether a pair read from a file is one that it could have found: an index beyond its data would be a panic.
    fn accepts_pair(&self, _pair: &Pair) -> bool {
        false
    }

    fn editable(&self) -> Vec<Editable> {
        Vec::new()
    }

    /// # Errors
    /// There is no such parameter, or the value does not fit.
    fn set_parameter(&mut self, name: &str, _value: f64) -> Result<(), ParameterError> {
        Err(ParameterError::Unknown {
            force: self.name().to_owned(),
            name: name.to_owned(),
            known: self.editable().iter().map(|parameter| parameter.name.to_owned()).collect(),
        })
    }

    /// Stress and energy of cell number `cell` at row positions, of a force that deforms cells.
    fn cell_field(&self, _cell: usize, _positions: &[Vec3]) -> Option<CellField> {
        None
    }

    /// The same where what the force remembers of the cell matters.
    fn cell_field_at(&self, cell: usize, at: &Configuration) -> Option<CellField> {
        self.cell_field(cell, at.positions)
    }

    /// Volume at rest of cell number `cell` [m³], of a force whose cells change their law.
    fn rest_volume(&self, _cell: usize) -> Option<f64> {
        None
    }

    /// The number of the law that cell number `cell` has, of a force whose cells change theirs.
    fn adapted_law(&self, cell: usize, at: &Configuration) -> Option<f64> {
        self.adapted(cell, at).map(|adapted| adapted.law)
    }

    /// The same, with how far the cell is from changing it.
    fn adapted(&self, _cell: usize, _at: &Configuration) -> Option<Adapted> {
        None
    }

    /// How often its cells have changed their law so far; `None` where they have one law.
    fn law_changes(&self, _at: &Configuration) -> Option<LawChanges> {
        None
    }

    /// Calls `visit` for every point that touches something; never where the force is no contact.
    fn visit_contacts(&self, _at: &Configuration, _visit: &mut dyn FnMut(&ContactPoint)) {}

    /// What steps the points of a body of several meshes, of which at each place one is at work.
    fn levels(&self) -> Option<&dyn Levels> {
        None
    }

    /// Whether a parameter says how much work it may do, and changes nothing about how it pushes.
    fn is_effort(&self, _parameter: &str) -> bool {
        false
    }

    /// Whether it acts within one body: its elasticity, its damping, and nothing from outside.
    fn acts_within(&self) -> bool {
        false
    }

    /// What moves points by itself and feels what they resist with; `None` of a force that only acts on them.
    fn holding(&self) -> Option<&dyn Holding> {
        None
    }

    /// What of it relates points by forces that a step solves for; `None` of a force that says itself how it pushes. Between steps such a
    /// force gives what was found last.
    fn constraint_set(&self) -> Option<&dyn ConstraintSet> {
        None
    }

    /// What of it keeps gaps open by forces that a step solves for, likewise.
    fn unilateral(&self) -> Option<&dyn Unilateral> {
        None
    }

    /// Calls `visit` for every link, in the order they were made in; never where the force is none of links.
    fn visit_links(&self, _at: &Configuration, _visit: &mut dyn FnMut(&LinkShown)) {}

    /// Leads what a hand holds to a place [m]; forces that no hand holds stay where they are.
    fn lead(&mut self, _place: Vec3) {}

    /// What a person does and feels with the tool that this force is of; `None` where it is of none.
    fn in_hand(&self, _at: &Configuration) -> Option<InHand> {
        None
    }

    /// What this force keeps bodies away from, where that is something rigid, for pictures.
    fn obstacle(&self) -> Option<Obstacle> {
        None
    }

    /// Bytes of constant data on the heap, for the memory report.
    fn bytes(&self) -> usize {
        0
    }

    /// Gives back what a scratch holds much of and the next evaluation makes anew with the same result, for who needs the room
    /// between steps.
    fn free_scratch(&self, _scratch: &mut Scratch) {}

    /// Bytes that a scratch of this force holds on the heap, for the memory report.
    fn scratch_bytes(&self, _scratch: &Scratch) -> usize {
        0
    }

    /// The concrete force, for tests of it. Programs ask the questions above, which every force may answer.
    fn as_any(&self) -> &dyn Any;
}
