//! A body of several independent meshes, of which at each place one is at work (model C of Debunne 2000).
//!
//! Where the deformation varies, points of a coarse mesh are subdivided: the finer points around them take their place.
//! Between levels, *ghosts* follow the points of the other mesh. What ghosts feel comes back by the transpose, and each part
//! of the matter is stood for by one level: momentum is conserved, and there is an energy. The source's own coupling, one
//! way and with overlapping levels, is there to be compared.
//!
//! - `links`: the meshes, which tetrahedra carry which points;
//! - `roles`: who is active, and what the others follow;
//! - `matter`: what each tetrahedron stands for;
//! - `stiffness`: how much stiffer than the finest mesh a coarser one is;
//! - `supports`: which levels hold the body where it is held;
//! - `criterion`, `adapt`: when points come and go;
//! - `cuts`: what is cut through;
//! - `lists`, `elastic`: what a step goes through;
//! - `dress`: the surface that is shown.

mod adapt;
mod criterion;
mod cuts;
mod dress;
mod elastic;
mod links;
mod lists;
mod matter;
mod roles;
mod stepping;
mod stiffness;
mod supports;

use std::any::Any;
use std::ops::Range;

use souple_engine::levels::{Census, Division, Kinematic, Levels};
use souple_engine::state::Pair;
use souple_engine::{
    CellField, Configuration, Declaration, Editable, Energy, Force, ParameterError, Scratch, TangentWeights,
};
use souple_formal::Formula;
use souple_math::Vec3;
use souple_mesh::Mesh;
use souple_solve::BlockMatrix;

use crate::materials::Material;
use crate::solids::layout::LANES;
use crate::solids::sample_law::Answer;
use crate::stays;
use cuts::Cuts;
use elastic::{ALL_CORNERS, Due, LawMemory, Values};
use lists::Work;
use matter::Matter;
use souple_engine::levels::Followers;
use supports::Supports;

pub use criterion::{Criterion, Measure};
pub use dress::{Dress, Fading, Worn};
pub use links::{Hierarchy, LevelsError, Loops, MOST};
pub use roles::Role;
pub use supports::Support;

/// What becomes of the forces on ghosts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coupling {
    /// They return to the points that the ghosts follow; each part of the matter is counted once.
    Transpose,
    /// They are lost, and levels overlap, each whole around its active points: the source's.
    OneWay,
}

/// How stiff the coarser meshes are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stiffness {
    /// As linear tetrahedra of their size make them: too stiff, exact for homogeneous strain.
    Own,
    /// Their moduli brought down so that they yield to the softest loads of the body as the finest mesh does; homogeneous
    /// strain is then as much too soft.
    AsFinest,
    /// The same under the loads of a body that is held, where pins hold it: what is too stiff around them counts too.
    AsHeld,
}

/// Who decides which level is at work.
#[derive(Clone, Debug)]
pub enum Choice {
    Adaptive(Criterion),
    /// A formula of the place `x, y, z` at rest [m]: levels counted from 0, the coarsest.
    Fixed(Formula),
}

/// What a formula of levels may refer to.
pub const PLACE_VARIABLES: [&str; 3] = ["x", "y", "z"];

/// The parameter that says how many stresses a step may evaluate.
const BUDGET: &str = "budget";
/// A point on which less than this part of its matter hangs has nothing of its own to move.
const LEAST_MASS: f64 = 0.05;

/// What a body of levels is made of.
pub struct LevelsDescription<'a> {
    pub name: String,
    /// From coarse to fine; the last one is the body's shape.
    pub meshes: &'a [&'a Mesh],
    /// Row of the first point of the finest mesh; the points of the others follow, from coarse to fine.
    pub first_row: usize,
    pub materials: &'a [Material],
    /// Index into `materials` for each cell of the finest mesh.
    pub material_of_cell: &'a [u16],
    pub coupling: Coupling,
    /// Of [`Coupling::OneWay`] alone.
    pub loops: Loops,
    pub stiffness: Stiffness,
    pub choice: Choice,
    /// Kelvin–Voigt: stress per rate of strain [Pa s].
    pub viscosity: f64,
    /// Rate at which velocities fade [1/s].
    pub mass_damping: f64,
    /// Stresses that a step may evaluate.
    pub budget: Option<f64>,
    /// In any order: they are made at their dates.
    pub cuts: Vec<Cut>,
    /// What holds it, points ascending.
    pub supports: Vec<Support>,
}

/// Matter that carries nothing from a date on.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cut {
    /// [s]
    pub time: f64,
    /// Cells of the finest mesh.
    pub cells: Vec<u32>,
}

/// Elastic forces of a body of levels.
pub struct LevelsForce {
    name: String,
    hierarchy: Hierarchy,
    matter: Matter,
    first_row: usize,
    coupling: Coupling,
    /// Of each level, what its moduli are multiplied by.
    share_of_moduli: Vec<f64>,
    choice: Choice,
    viscosity: f64,
    mass_damping: f64,
    budget: Option<f64>,
    cuts: Cuts,
    /// Of each point of the finest mesh [kg].
    finest_masses: Vec<f64>,
    /// Of each point of all meshes, were its level alone at work [kg].
    whole_masses: Vec<f64>,
    /// Points that never have anything to move: finer ones are always in their place.
    is_empty: Vec<bool>,
    supports: Supports,
    /// Of all points, were their level alone at work: the shortest that is longest for one of them [s].
    shortest_interval: f64,
}

impl LevelsForce {
    /// # Errors
    /// The meshes cannot be levels of one body.
    pub fn new(description: LevelsDescription) -> Result<Self, LevelsError> {
        let LevelsDescription { meshes, materials, material_of_cell, .. } = description;
        let hierarchy = Hierarchy::new(meshes, description.loops)?;
        let matter = Matter::new(&hierarchy, meshes, materials, material_of_cell);
        let mut force = Self {
            name: description.name,
            first_row: description.first_row,
            coupling: description.coupling,
            share_of_moduli: vec![1.0; hierarchy.level_count()],
            choice: description.choice,
            viscosity: description.viscosity,
            mass_damping: description.mass_damping,
            budget: description.budget,
            cuts: Cuts::default(),
            finest_masses: Vec::new(),
            whole_masses: Vec::new(),
            is_empty: Vec::new(),
            supports: Supports::default(),
            shortest_interval: f64::INFINITY,
            hierarchy,
            matter,
        };
        force.cuts = Cuts::new(&force.hierarchy, &force.matter, description.cuts);
        force.weigh();
        force.supports = Supports::new(&force.hierarchy, &force.matter, &description.supports);
        if description.stiffness != Stiffness::Own {
            let is_held = description.stiffness == Stiffness::AsHeld;
            force.share_of_moduli = stiffness::shares_of_compliance(
                &force.hierarchy,
                &force.matter,
                &force.finest_masses,
                is_held.then_some(&force.supports),
            );
        }
        force.find_empty_points();
        for level in 0..force.hierarchy.level_count() {
            force.shortest_interval = force.shortest_interval.min(force.shortest_of(level));
        }
        Ok(force)
    }

    pub fn hierarchy(&self) -> &Hierarchy {
        &self.hierarchy
    }

    /// What the moduli of each level are multiplied by, from coarse to fine; 1 for the finest.
    pub fn share_of_moduli(&self) -> &[f64] {
        &self.share_of_moduli
    }

    /// Stresses that a step so divided evaluates with the coarsest mesh at work wherever so many cuts let it: no budget comes to less.
    pub fn least_evaluations(&self, division: &Division, cuts: usize) -> usize {
        let mut memory = vec![0.0; self.memory_len()];
        memory[self.cuts_made()] = cuts as f64;
        self.evaluations_of(memory, division)
    }

    /// The same with the finest mesh at work.
    pub fn finest_evaluations(&self, division: &Division) -> usize {
        let mut memory = vec![0.0; self.memory_len()];
        memory[..self.overload()].fill(1.0);
        self.evaluations_of(memory, division)
    }

    fn evaluations_of(&self, mut memory: Vec<f64>, division: &Division) -> usize {
        let mut work = Work::new(self);
        self.give_up_empty_points(&mut memory, &mut work);
        work.refresh(self, &memory);
        work.divide(self, division);
        work.evaluations(division)
    }

    /// How many cuts are ever made.
    pub fn cut_count(&self) -> usize {
        self.cuts.by(f64::INFINITY)
    }

    /// The masses of the points of the finest mesh [kg].
    pub fn masses(&self) -> &[f64] {
        &self.finest_masses
    }

    /// Masses of the finest points; coarser ones carry what hangs on them.
    fn weigh(&mut self) {
        let (hierarchy, matter) = (&self.hierarchy, &self.matter);
        let mut masses = vec![0.0; hierarchy.point_count()];
        let finest = hierarchy.tets_of_level[hierarchy.finest()].clone();
        for (cell, tet) in hierarchy.tets[finest].iter().enumerate() {
            let density = matter.materials[usize::from(matter.material_of_cell[cell])].density;
            for corner in tet.corners {
                masses[corner as usize] += 0.25 * density * matter.cell_volumes[cell];
            }
        }
        self.finest_masses = masses[hierarchy.levels[hierarchy.finest()].clone()].to_vec();
        for points in hierarchy.levels[1..].iter().rev() {
            for point in points.clone() {
                let carrier = hierarchy.parent(point);
                for (corner, weight) in carrier.corners.into_iter().zip(carrier.weights) {
                    masses[corner as usize] += weight * masses[point];
                }
            }
        }
        self.whole_masses = masses;
    }

    /// Coarse points outside of the shape, around which there is next to nothing of the finest mesh.
    fn find_empty_points(&mut self) {
        let (hierarchy, matter) = (&self.hierarchy, &self.matter);
        let density = self.finest_masses.iter().sum::<f64>() / matter.cell_volumes.iter().sum::<f64>();
        let is_empty = |point: usize| {
            let around =
                hierarchy.tets_of_point.get(point).iter().map(|tet| hierarchy.tets[*tet as usize].volume);
            self.whole_masses[point] < LEAST_MASS * density * 0.25 * around.sum::<f64>()
        };
        self.is_empty = (0..hierarchy.point_count())
            .map(|point| usize::from(hierarchy.level_of[point]) < hierarchy.finest() && is_empty(point))
            .collect();
    }

    /// The shortest interval that a point of a level needs, were that alone at work [s].
    fn shortest_of(&self, level: usize) -> f64 {
        let mut memory = vec![0.0; self.memory_len()];
        for points in &self.hierarchy.levels[..self.hierarchy.finest()] {
            for point in points.clone() {
                self.subdivide(&mut memory, point, usize::from(self.hierarchy.level_of[point]) < level);
            }
        }
        let mut work = Work::new(self);
        work.refresh(self, &memory);
        work.shortest_interval(self)
    }

    /// Whether finer points are to take the place of a point.
    fn is_subdivided(&self, memory: &[f64], point: usize) -> bool {
        point >= self.finest_count()
            && (self.is_empty[point]
                || self.supports.gives_way[point]
                || memory[point - self.finest_count()] != 0.0
                || self.cuts.is_beside(point, memory[self.cuts_made()]))
    }

    fn subdivide(&self, memory: &mut [f64], point: usize, is_subdivided: bool) {
        memory[point - self.finest_count()] = f64::from(u8::from(is_subdivided));
    }

    fn finest_count(&self) -> usize {
        self.finest_masses.len()
    }

    /// Where memory counts the steps for which the budget has been overdrawn: behind what says who is subdivided.
    fn overload(&self) -> usize {
        self.hierarchy.point_count() - self.finest_count()
    }

    /// Where memory counts the cuts that are made; what follows says nothing of who is at work.
    fn cuts_made(&self) -> usize {
        self.overload() + 1
    }

    /// Where memory keeps how long points stay.
    fn stays(&self) -> usize {
        self.cuts_made() + 1
    }

    /// Where memory has, of each point, the least rate that its velocity asks for.
    fn urges(&self) -> usize {
        self.stays() + stays::len(self.hierarchy.point_count())
    }

    /// Where memory sums up how far each point has been moved because others came to be at work.
    fn moved(&self) -> usize {
        self.urges() + self.hierarchy.point_count()
    }

    /// Where memory keeps, of a criterion with a date, whether the variation at that date is taken, and that of each point.
    fn references(&self) -> usize {
        self.moved() + 3 * self.hierarchy.point_count()
    }

    /// Values of this body's points among those on rows.
    fn own<'a>(&self, values: &'a [Vec3]) -> &'a [Vec3] {
        &values[self.rows()]
    }

    fn work<'a>(&self, scratch: &'a mut Scratch) -> &'a mut Work {
        scratch.downcast_mut().unwrap_or_else(|| unreachable!("made by this force's own new_scratch"))
    }

    /// All samples whose volumes are above zero.
    fn all_due<'a>(&'a self, volumes: &'a [f64]) -> impl Iterator<Item = Due> + 'a {
        (0..self.matter.block_count()).filter_map(move |block| {
            let volumes = &volumes[block * LANES..(block + 1) * LANES];
            let corners = std::array::from_fn(|lane| if volumes[lane] > 0.0 { ALL_CORNERS } else { 0 });
            (corners != [0; LANES]).then_some(Due { block: block as u32, corners })
        })
    }

    /// Sums of stresses, or of their changes, over all samples that are at work, on the rows of active points.
    fn add_all(&self, answer: Answer, values: Values, scale: f64, work: &mut Work, out: &mut [Vec3]) {
        let mut memory = LawMemory::new(&self.matter, answer);
        let mut sums = std::mem::take(&mut work.sums);
        self.sum_all(answer, values, work, &mut memory, &mut sums);
        for point in &work.active {
            out[self.first_row + *point as usize] += sums[*point as usize] * scale;
        }
        work.sums = sums;
    }

    /// The same of each point by its number; those that follow are left with nothing where they give back.
    fn sum_all(
        &self,
        answer: Answer,
        values: Values,
        work: &Work,
        memory: &mut LawMemory,
        sums: &mut Vec<Vec3>,
    ) {
        sums.clear();
        sums.resize(self.hierarchy.point_count(), Vec3::ZERO);
        let parts = (&self.hierarchy, &self.matter);
        memory.ask(parts, answer, self.all_due(&work.acting), values, |slot, _, tet, _, stress| {
            for (corner, gradient) in tet.corners.iter().zip(tet.gradients) {
                sums[*corner as usize] -= *stress * gradient * work.acting[slot];
            }
        });
        if self.coupling == Coupling::Transpose {
            self.return_all(work, Followers::All, sums);
        }
    }
}

impl Force for LevelsForce {
    fn name(&self) -> &str {
        &self.name
    }

    fn declaration(&self) -> Declaration {
        let is_objective = self.matter.materials.iter().all(|material| material.law.is_objective());
        let is_conservative = self.coupling == Coupling::Transpose;
        Declaration {
            conservative: is_conservative
                && self.cuts.is_none()
                && self.viscosity == 0.0
                && self.mass_damping == 0.0,
            velocity_terms: self.viscosity > 0.0 || self.mass_damping > 0.0,
            symmetric_tangent: is_conservative,
            internal: is_conservative && is_objective,
            changing_pattern: false,
        }
    }

    /// Which points are subdivided, for how many steps the budget has been overdrawn, how many cuts are made; then how long points stay,
    /// the rates that their velocities ask for, how far others coming to be at work have moved them, and the variation that does not count.
    fn memory_len(&self) -> usize {
        let settles = matches!(self.choice, Choice::Adaptive(Criterion { settled: Some(_), .. }));
        self.references() + if settles { 1 + self.hierarchy.point_count() } else { 0 }
    }

    fn new_scratch(&self) -> Scratch {
        Box::new(Work::new(self))
    }

    fn energy(&self, at: &Configuration, scratch: &mut Scratch) -> Energy {
        let work = self.work(scratch);
        work.refresh(self, at.memory);
        let values = Values { positions: self.own(at.positions), variation: &[] };
        let mut stored = 0.0;
        let mut memory = LawMemory::new(&self.matter, Answer::Energy);
        memory.ask(
            (&self.hierarchy, &self.matter),
            Answer::Energy,
            self.all_due(&work.shares),
            values,
            |slot, _, _, _, density| {
                stored += work.shares[slot] * density.columns[0].x;
            },
        );
        Energy { stored, dissipated: 0.0 }
    }

    fn add_force(&self, at: &Configuration, scratch: &mut Scratch, out: &mut [Vec3]) {
        let work = self.work(scratch);
        work.refresh(self, at.memory);
        let values = Values { positions: self.own(at.positions), variation: &[] };
        self.add_all(Answer::Stress, values, 1.0, work, out);
    }

    fn add_differential(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        delta: &[Vec3],
        scratch: &mut Scratch,
        out: &mut [Vec3],
    ) {
        let work = self.work(scratch);
        work.refresh(self, at.memory);
        let mut variation = self.own(delta).to_vec();
        self.place(work, Followers::All, Kinematic::Velocity, &mut variation);
        let values = Values { positions: self.own(at.positions), variation: &variation };
        self.add_all(Answer::Differential, values, weights.position, work, out);
    }

    /// None: no stepper that makes matrices takes a body of levels.
    fn visit_cliques(&self, _pairs: &[Pair], _visit: &mut dyn FnMut(&[u32])) {}

    fn add_blocks(&self, _: &Configuration, _: TangentWeights, _: &mut Scratch, _: &mut BlockMatrix) {}

    fn is_effort(&self, parameter: &str) -> bool {
        parameter == BUDGET
    }

    fn editable(&self) -> Vec<Editable> {
        let mut all = Vec::new();
        if let Choice::Adaptive(Criterion { refine, coarsen, .. }) = self.choice {
            all.push(Editable { name: "refine", unit: "", value: refine });
            all.push(Editable { name: "coarsen", unit: "", value: coarsen });
        }
        all.extend(self.budget.map(|value| Editable { name: BUDGET, unit: "", value }));
        all
    }

    fn set_parameter(&mut self, name: &str, value: f64) -> Result<(), ParameterError> {
        let force = self.name.clone();
        let known: Vec<String> = self.editable().iter().map(|editable| editable.name.to_owned()).collect();
        let unfit = |force, expected: String| {
            Err(ParameterError::Unfit { force, name: name.to_owned(), value, expected })
        };
        match (name, &mut self.choice, &mut self.budget) {
            ("refine" | "coarsen", Choice::Adaptive(criterion), _) => {
                let mut changed = *criterion;
                *(if name == "refine" { &mut changed.refine } else { &mut changed.coarsen }) = value;
                if !(value.is_finite() && value >= 0.0) {
                    return unfit(force, "a finite number of at least 0".to_owned());
                }
                if changed.flickers() {
                    let expected = match name {
                        "refine" => format!("at least twice `coarsen`, {}", 2.0 * criterion.coarsen),
                        _ => format!("at most half of `refine`, {}", 0.5 * criterion.refine),
                    };
                    return unfit(force, expected);
                }
                *criterion = changed;
            }
            (BUDGET, _, Some(budget)) => {
                if !(value.is_finite() && value > 0.0) {
                    return unfit(force, "a finite number above 0".to_owned());
                }
                *budget = value;
            }
            _ => return Err(ParameterError::Unknown { force, name: name.to_owned(), known }),
        }
        Ok(())
    }

    fn cell_field(&self, cell: usize, positions: &[Vec3]) -> Option<CellField> {
        let finest = self.hierarchy.tets_of_level.last()?.clone();
        let tet = self.hierarchy.tets[finest].get(cell)?;
        let material = &self.matter.materials[usize::from(self.matter.material_of_cell[cell])];
        // rows of the finest mesh are enough
        let F = tet.gradient(&positions[self.first_row..]);
        Some(material.along(None).field(&F, tet.volume))
    }

    fn levels(&self) -> Option<&dyn Levels> {
        Some(self)
    }

    fn bytes(&self) -> usize {
        let Hierarchy { rest, tets, .. } = &self.hierarchy;
        self.matter.bytes()
            + size_of::<Vec3>() * rest.capacity()
            + size_of::<links::Tet>() * tets.capacity()
            + 8 * (self.finest_masses.capacity() + self.whole_masses.capacity())
    }

    fn scratch_bytes(&self, scratch: &Scratch) -> usize {
        scratch.downcast_ref().map_or(0, Work::bytes)
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}

impl LevelsForce {
    /// Rows of all points, see [`LevelsDescription::first_row`].
    fn row_range(&self) -> Range<usize> {
        self.first_row..self.first_row + self.hierarchy.point_count()
    }

    /// Who does what, by a memory of this force.
    fn counted(&self, memory: &[f64], work: &Work) -> Census {
        let (hierarchy, matter) = (&self.hierarchy, &self.matter);
        let ghosts = work.roles.ghosts(hierarchy);
        let count = |is_counted: &dyn Fn(usize) -> bool| {
            let of_level = |points: &Range<usize>| points.clone().filter(|point| is_counted(*point)).count();
            hierarchy.levels.iter().map(of_level).collect()
        };
        // a point is of the finest level at work in a cell at it
        let (mut level_of_point, mut coarsest_at_point) =
            (vec![0; self.finest_count()], vec![u32::MAX; self.finest_count()]);
        let finest = hierarchy.tets_of_level[hierarchy.finest()].clone();
        for (cell, tet) in hierarchy.tets[finest].iter().enumerate() {
            let is_live = |level: &usize| {
                let slot = matter.slot_of_cell[*level][cell] as usize;
                matter.slots[slot].is_some_and(|sample| work.roles.is_live[sample.tet as usize])
            };
            let level = (0..hierarchy.level_count()).rev().find(is_live).unwrap_or(0) as u32;
            for corner in tet.corners {
                let known = &mut level_of_point[corner as usize];
                *known = level.max(*known);
                let coarsest = &mut coarsest_at_point[corner as usize];
                *coarsest = level.min(*coarsest);
            }
        }
        Census {
            active: count(&|point| work.roles.is_active(point)),
            active_rows: work.active_rows.clone(),
            ghosts: count(&|point| ghosts[point]),
            cells: hierarchy.tets_of_level.iter().map(Range::len).collect(),
            toggling: stays::rate(&memory[self.stays()..self.urges()]),
            // cells that share a corner lie side by side; a point of no cell is beside nothing
            grading: level_of_point
                .iter()
                .zip(coarsest_at_point)
                .map(|(finest, coarsest)| finest.saturating_sub(coarsest))
                .max()
                .unwrap_or(0),
            neighbours: None,
            level_of_point,
        }
    }
}
