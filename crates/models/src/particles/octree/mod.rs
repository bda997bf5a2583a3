//! A body as particles of an octree, of which at each place one level is at work (model A of Debunne 2000).
//!
//! `adaptive`: where the displacement varies a particle is divided: its daughters take its place, and where it does not they are
//! grouped again. Each zone is stood for by exactly one particle; neighbours differ by one level at most (Von Herzen & Barr 1987).
//! `hierarchical`: a divided particle stays. It goes where its daughters are, and what it feels of its own level acts on them; no
//! operator is ever evaluated across levels.
//!
//! - `tree`: cubes grouped by eight, tables of all 89 neighbours, whom daughters follow;
//! - `active`: who is at work, and whom it sees;
//! - `stencil`: what a particle and its neighbours feel;
//! - `adapt`: when particles divide and are grouped;
//! - `stepping`: what the staggered stepper asks for.

#![allow(non_snake_case)]

mod active;
mod adapt;
mod stencil;
mod stepping;
mod tree;

use std::any::Any;
use std::ops::Range;

use souple_engine::levels::Levels;
use souple_engine::state::Pair;
use souple_engine::{
    Configuration, Declaration, Editable, Energy, Force, ParameterError, Scratch, TangentWeights,
};
use souple_formal::Formula;
use souple_math::Vec3;
use souple_solve::BlockMatrix;

use super::operators::Operators;
use crate::materials::Lame;
use crate::stays;
use active::Work;

pub use tree::{MOST_LEVELS, Octree, OctreeError};

/// What a formula of levels may refer to.
pub const PLACE_VARIABLES: [&str; 3] = ["x", "y", "z"];

/// How forces are made of neighbours.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OctreeOperators {
    /// Second derivatives at each particle by itself.
    Strong(Operators),
    /// Gradients that fit the neighbours, and the energy of these.
    Energy,
}

/// What becomes of a particle that is divided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Variant {
    /// Its daughters take its place.
    Adaptive,
    /// It stays, for what it feels of its own level.
    Hierarchical,
}

/// Who decides which level is at work.
#[derive(Clone, Debug)]
pub enum OctreeChoice {
    /// `h |Δu|` above `refine` divides, below `coarsen` groups.
    Adaptive { refine: f64, coarsen: f64 },
    /// A formula of the place `x, y, z` at rest [m]: levels counted from 0, the coarsest.
    Fixed(Formula),
}

/// What a body of an octree is made of.
pub struct OctreeDescription {
    pub name: String,
    pub tree: Octree,
    /// Row of the first of the finest particles; those of the others follow, from coarse to fine.
    pub first_row: usize,
    pub moduli: Lame,
    pub operators: OctreeOperators,
    pub variant: Variant,
    pub choice: OctreeChoice,
    /// Rate at which velocities fade [1/s].
    pub mass_damping: f64,
}

/// Elastic forces of particles of an octree.
pub struct OctreeForce {
    name: String,
    tree: Octree,
    first_row: usize,
    moduli: Lame,
    operators: OctreeOperators,
    variant: Variant,
    choice: OctreeChoice,
    mass_damping: f64,
    /// The longest interval that is stable with each level alone at work, with a margin [s].
    intervals: Vec<f64>,
}

/// Of the longest stable step: what mixed levels and beats may need.
const MARGIN: f64 = 0.6;
/// Rounds by which the highest frequency of a level is found.
const ROUNDS: usize = 60;

impl OctreeForce {
    pub fn new(description: OctreeDescription) -> Self {
        let OctreeDescription { name, tree, first_row, moduli, operators, variant, choice, mass_damping } =
            description;
        let intervals = vec![0.0; tree.levels.len()];
        let mut force =
            Self { name, tree, first_row, moduli, operators, variant, choice, mass_damping, intervals };
        force.intervals = (0..force.tree.levels.len()).map(|level| force.interval_of(level)).collect();
        force
    }

    pub fn tree(&self) -> &Octree {
        &self.tree
    }

    /// Particles that can be divided: memory has a number for each, and then how long particles stay.
    fn coarser_count(&self) -> usize {
        self.tree.count() - self.tree.finest_count()
    }

    /// Memory with one level at work everywhere.
    fn memory_of_level(&self, level: usize) -> Vec<f64> {
        let mut memory = vec![0.0; self.memory_len()];
        for above in 0..level.min(self.tree.finest()) {
            for particle in self.tree.levels[above].clone() {
                memory[particle - self.tree.finest_count()] = active::DIVIDED;
            }
        }
        memory
    }

    /// `2/ω` of the highest frequency of a level alone, by powers of `M⁻¹K`, with a margin [s].
    fn interval_of(&self, level: usize) -> f64 {
        let mut work = Work::new(&self.tree);
        work.refresh(self, &self.memory_of_level(level));
        let number = |i: usize, salt: f64| ((i as f64 + salt) * 12.9898).sin();
        let mut u = vec![Vec3::ZERO; self.tree.count()];
        for particle in self.tree.levels[level].clone() {
            u[particle] = Vec3::new(number(particle, 0.1), number(particle, 0.2), number(particle, 0.3));
        }
        let mut highest = 0.0;
        let mut next = vec![Vec3::ZERO; u.len()];
        for _ in 0..ROUNDS {
            next.fill(Vec3::ZERO);
            self.add_pushes(&work, &u, 1.0, &mut next);
            let mut size = 0.0;
            for (particle, next) in next.iter_mut().enumerate() {
                *next = *next * (1.0 / self.tree.masses[particle]);
                size += next.length_sq();
            }
            let before = u.iter().map(|u| u.length_sq()).sum::<f64>().sqrt();
            size = size.sqrt();
            if !(size > 0.0 && before > 0.0) {
                return f64::INFINITY;
            }
            highest = size / before;
            u.iter_mut().zip(&next).for_each(|(u, next)| *u = *next * (1.0 / size));
        }
        MARGIN * 2.0 / highest.sqrt()
    }

    /// Adds forces of all stencils at displacements of all particles.
    fn add_pushes(&self, work: &Work, u: &[Vec3], scale: f64, out: &mut [Vec3]) {
        for particle in &work.working {
            let own = u[*particle as usize];
            work.stencils[*particle as usize].push(
                self.operators,
                *particle,
                |other| u[other as usize] - own,
                |whom, f| out[whom as usize] += f * scale,
            );
        }
        self.hand_down(work, out);
    }

    /// What divided particles feel acts on the active ones below them, by their masses.
    fn hand_down(&self, work: &Work, out: &mut [Vec3]) {
        if self.variant == Variant::Adaptive {
            return;
        }
        for level in 0..self.tree.finest() {
            for particle in self.tree.levels[level].clone().filter(|at| work.is_divided(*at)) {
                let felt = std::mem::replace(&mut out[particle], Vec3::ZERO);
                for daughter in self.tree.daughters.of(particle) {
                    let share = self.tree.masses[*daughter as usize] / self.tree.masses[particle];
                    out[*daughter as usize] += felt * share;
                }
            }
        }
    }

    fn row_range(&self) -> Range<usize> {
        self.first_row..self.first_row + self.tree.count()
    }

    fn displacements(&self, positions: &[Vec3], out: &mut Vec<Vec3>) {
        out.clear();
        out.extend(positions[self.row_range()].iter().zip(&self.tree.rest).map(|(x, rest)| *x - *rest));
    }

    fn work<'a>(&self, scratch: &'a mut Scratch) -> &'a mut Work {
        scratch.downcast_mut().unwrap_or_else(|| unreachable!("made by this force's own new_scratch"))
    }

    fn add_all(&self, work: &Work, u: &[Vec3], scale: f64, out: &mut [Vec3]) {
        let mut forces = vec![Vec3::ZERO; self.tree.count()];
        self.add_pushes(work, u, scale, &mut forces);
        for particle in &work.active {
            out[self.first_row + *particle as usize] += forces[*particle as usize];
        }
    }
}

impl Force for OctreeForce {
    fn name(&self) -> &str {
        &self.name
    }

    fn declaration(&self) -> Declaration {
        let has_energy = self.operators == OctreeOperators::Energy && self.mass_damping == 0.0;
        Declaration {
            conservative: has_energy,
            velocity_terms: self.mass_damping > 0.0,
            symmetric_tangent: self.operators == OctreeOperators::Energy,
            internal: false,
            changing_pattern: false,
        }
    }

    /// Which particles are divided, or are to be for their neighbours' sake, and how long particles stay.
    fn memory_len(&self) -> usize {
        self.coarser_count() + stays::len(self.tree.count())
    }

    fn new_scratch(&self) -> Scratch {
        Box::new(Work::new(&self.tree))
    }

    fn energy(&self, at: &Configuration, scratch: &mut Scratch) -> Energy {
        let work = self.work(scratch);
        work.refresh(self, at.memory);
        let mut u = Vec::new();
        self.displacements(at.positions, &mut u);
        let of = |particle: &u32| {
            let own = u[*particle as usize];
            let relative = |other: u32| u[other as usize] - own;
            work.stencils[*particle as usize].energy(self.operators, own, relative)
        };
        Energy { stored: work.working.iter().map(of).sum(), dissipated: 0.0 }
    }

    fn add_force(&self, at: &Configuration, scratch: &mut Scratch, out: &mut [Vec3]) {
        let work = self.work(scratch);
        work.refresh(self, at.memory);
        let mut u = Vec::new();
        self.displacements(at.positions, &mut u);
        self.add_all(work, &u, 1.0, out);
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
        self.add_all(work, &delta[self.row_range()], weights.position, out);
    }

    /// None: no stepper that makes matrices takes a body of levels.
    fn visit_cliques(&self, _: &[Pair], _: &mut dyn FnMut(&[u32])) {}

    fn add_blocks(&self, _: &Configuration, _: TangentWeights, _: &mut Scratch, _: &mut BlockMatrix) {}

    fn editable(&self) -> Vec<Editable> {
        match self.choice {
            OctreeChoice::Adaptive { refine, coarsen } => vec![
                Editable { name: "refine", unit: "", value: refine },
                Editable { name: "coarsen", unit: "", value: coarsen },
            ],
            OctreeChoice::Fixed(_) => Vec::new(),
        }
    }

    fn set_parameter(&mut self, name: &str, value: f64) -> Result<(), ParameterError> {
        let force = self.name.clone();
        let known: Vec<String> = self.editable().iter().map(|editable| editable.name.to_owned()).collect();
        if let OctreeChoice::Adaptive { refine, coarsen } = &mut self.choice {
            let (own, fits, expected) = match name {
                "refine" => (&mut *refine, value > *coarsen, format!("above `coarsen`, {coarsen}")),
                "coarsen" => {
                    let fits = value >= 0.0 && value < *refine;
                    (&mut *coarsen, fits, format!("from 0 to `refine`, {refine}"))
                }
                _ => return Err(ParameterError::Unknown { force, name: name.to_owned(), known }),
            };
            if !fits || !value.is_finite() {
                return Err(ParameterError::Unfit { force, name: name.to_owned(), value, expected });
            }
            *own = value;
            return Ok(());
        }
        Err(ParameterError::Unknown { force, name: name.to_owned(), known })
    }

    fn levels(&self) -> Option<&dyn Levels> {
        Some(self)
    }

    fn bytes(&self) -> usize {
        self.tree.bytes()
    }

    fn scratch_bytes(&self, scratch: &Scratch) -> usize {
        scratch.downcast_ref().map_or(0, Work::bytes)
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}
