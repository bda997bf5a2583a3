//! The tree: cubes of a lattice, grouped by eight into mothers, with their neighbours and how daughters follow their mothers.
//!
//! Particles are numbered as rows are: the finest first, in the order of the body's points, then all others from coarse to fine.
//! Levels are counted from the coarsest. A particle of index `(I, J, K)` is the mother of those of `(2I + a, 2J + b, 2K + c)`;
//! it has their mass and stands in their centre of mass.

use std::collections::BTreeMap;
use std::ops::Range;

use souple_math::{Mat3, Vec3};
use souple_mesh::BoundingBox;

use crate::particles::operators::gradient_weights;

/// Positions off the lattice by more than this part of its spacing are none of it.
const OFF_LATTICE: f64 = 1e-6;
/// Levels at most.
pub const MOST_LEVELS: usize = 8;

/// Why points are no octree.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum OctreeError {
    #[error("point {point} is not on a lattice of cubes of {spacing:e} m along the axes")]
    OffLattice { point: usize, spacing: f64 },
    #[error("points {one} and {other} are on the same place of the lattice")]
    SamePlace { one: usize, other: usize },
    #[error("{count} levels are more than the {most} that group the points down to one")]
    TooManyLevels { count: usize, most: usize },
    #[error("there is no point")]
    Empty,
}

/// Numbers in rows of any length.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Lists<T> {
    starts: Vec<u32>,
    items: Vec<T>,
}

impl<T> Lists<T> {
    fn new() -> Self {
        Self { starts: vec![0], items: Vec::new() }
    }

    fn push(&mut self, list: impl IntoIterator<Item = T>) {
        self.items.extend(list);
        self.starts.push(self.items.len() as u32);
    }

    pub fn of(&self, at: usize) -> &[T] {
        &self.items[self.starts[at] as usize..self.starts[at + 1] as usize]
    }

    fn bytes(&self) -> usize {
        4 * self.starts.capacity() + size_of::<T>() * self.items.capacity()
    }
}

/// Particles of all levels.
#[derive(Clone, Debug)]
pub struct Octree {
    /// Particles of each level, from coarse to fine.
    pub levels: Vec<Range<usize>>,
    pub level_of: Vec<u8>,
    /// Where they rest [m].
    pub rest: Vec<Vec3>,
    /// [kg]
    pub masses: Vec<f64>,
    /// [m³]
    pub volumes: Vec<f64>,
    /// Edge of the cubes of each level [m].
    pub spacing: Vec<f64>,
    /// None of the coarsest.
    pub mother: Vec<Option<u32>>,
    pub daughters: Lists<u32>,
    /// Of the same level: those that share a face, an edge or a corner, up to 26.
    pub same: Lists<u32>,
    /// How many particles long the row or the sheet of single particles is that a particle is of: neighbours of its level do not tell
    /// all of a gradient there. 0 where they do.
    pub slenderness: Vec<f64>,
    /// Of the next finer level that touch the cube, its own daughters left out: up to 56.
    pub finer: Lists<u32>,
    /// Of the next coarser level that touch it, its mother left out: up to 7.
    pub coarser: Lists<u32>,
    /// Particles of the mother's level that a daughter follows, with weights of sum one; none of the coarsest.
    pub leaders: Lists<(u32, f64)>,
}

type Places = BTreeMap<[i64; 3], u32>;

/// A level while it is made.
struct Level {
    places: Places,
    index: Vec<[i64; 3]>,
    rest: Vec<Vec3>,
    masses: Vec<f64>,
    volumes: Vec<f64>,
}

impl Level {
    /// # Errors
    /// The points are on no lattice.
    fn finest(points: &[Vec3], masses: &[f64], volumes: &[f64], spacing: f64) -> Result<Self, OctreeError> {
        let low = points.iter().copied().reduce(Vec3::min_components).ok_or(OctreeError::Empty)?;
        let mut places = Places::new();
        let mut index = Vec::with_capacity(points.len());
        for (point, x) in points.iter().enumerate() {
            let at = ((*x - low) * (1.0 / spacing)).to_array();
            let whole = at.map(f64::round);
            if at.iter().zip(whole).any(|(at, whole)| (at - whole).abs() > OFF_LATTICE || at.is_nan()) {
                return Err(OctreeError::OffLattice { point, spacing });
            }
            let place = whole.map(|at| at as i64);
            if let Some(other) = places.insert(place, point as u32) {
                return Err(OctreeError::SamePlace { one: other as usize, other: point });
            }
            index.push(place);
        }
        Ok(Self { places, index, rest: points.to_vec(), masses: masses.to_vec(), volumes: volumes.to_vec() })
    }

    /// Mothers of all of its particles, in the order of their indices: `m = Σ m_i`, `p = Σ m_i p_i/m`.
    fn mothers(&self) -> Self {
        let mut of_mother: BTreeMap<[i64; 3], Vec<usize>> = BTreeMap::new();
        for (number, index) in self.index.iter().enumerate() {
            of_mother.entry(index.map(|i| i.div_euclid(2))).or_default().push(number);
        }
        let mut mothers = Self {
            places: Places::new(),
            index: Vec::new(),
            rest: Vec::new(),
            masses: Vec::new(),
            volumes: Vec::new(),
        };
        for (place, daughters) in of_mother {
            let mass: f64 = daughters.iter().map(|at| self.masses[*at]).sum();
            let moment: Vec3 = daughters.iter().map(|at| self.rest[*at] * self.masses[*at]).sum();
            mothers.places.insert(place, mothers.index.len() as u32);
            mothers.index.push(place);
            mothers.rest.push(moment * (1.0 / mass));
            mothers.masses.push(mass);
            mothers.volumes.push(daughters.iter().map(|at| self.volumes[*at]).sum());
        }
        mothers
    }
}

impl Octree {
    /// `count` levels above points of a lattice, with their masses and volumes.
    ///
    /// # Errors
    /// The points are on no lattice, or too few to be grouped so often.
    pub fn new(
        points: &[Vec3],
        masses: &[f64],
        volumes: &[f64],
        spacing: f64,
        count: usize,
    ) -> Result<Self, OctreeError> {
        let mut made = vec![Level::finest(points, masses, volumes, spacing)?];
        while made.len() < count {
            let finer = &made[made.len() - 1];
            if finer.index.len() == 1 {
                return Err(OctreeError::TooManyLevels { count, most: made.len() });
            }
            made.push(finer.mothers());
        }
        made.reverse();
        let finest = made.len() - 1;
        let mut levels = vec![0..0; made.len()];
        let mut next = points.len();
        levels[finest] = 0..next;
        for (level, of) in made.iter().enumerate().take(finest) {
            levels[level] = next..next + of.index.len();
            next = levels[level].end;
        }
        let mut tree = Self {
            level_of: vec![0; next],
            rest: vec![Vec3::ZERO; next],
            masses: vec![0.0; next],
            volumes: vec![0.0; next],
            spacing: (0..made.len()).map(|level| spacing * (1_u32 << (finest - level)) as f64).collect(),
            mother: vec![None; next],
            daughters: Lists::new(),
            same: Lists::new(),
            slenderness: Vec::new(),
            finer: Lists::new(),
            coarser: Lists::new(),
            leaders: Lists::new(),
            levels,
        };
        for (level, of) in made.iter().enumerate() {
            for (at, particle) in tree.levels[level].clone().enumerate() {
                tree.level_of[particle] = level as u8;
                tree.rest[particle] = of.rest[at];
                tree.masses[particle] = of.masses[at];
                tree.volumes[particle] = of.volumes[at];
            }
        }
        // in the order of numbers: the finest first
        for level in std::iter::once(finest).chain(0..finest) {
            for at in 0..made[level].index.len() {
                tree.link(&made, level, at);
            }
        }
        tree.slenderness = tree.slenderness_of_all();
        Ok(tree)
    }

    fn slenderness_of_all(&self) -> Vec<f64> {
        let resolves = |particle: &usize| {
            let others = self.same.of(*particle).iter();
            let arms: Vec<Vec3> =
                others.map(|other| self.rest[*other as usize] - self.rest[*particle]).collect();
            gradient_weights(&arms, 3).is_some()
        };
        let mut is_left: Vec<bool> = (0..self.count()).map(|particle| !resolves(&particle)).collect();
        let mut slenderness = vec![0.0; self.count()];
        for first in 0..self.count() {
            if !std::mem::take(&mut is_left[first]) {
                continue;
            }
            let (mut joined, mut next) = (vec![first], 0);
            while let Some(particle) = joined.get(next).copied() {
                next += 1;
                let others = self.same.of(particle).iter().map(|other| *other as usize);
                joined.extend(others.filter(|other| std::mem::take(&mut is_left[*other])));
            }
            let extent = BoundingBox::of(joined.iter().map(|particle| self.rest[*particle])).size();
            let longest = extent.to_array().into_iter().fold(0.0, f64::max);
            let spacing = self.spacing[usize::from(self.level_of[first])];
            joined.iter().for_each(|particle| slenderness[*particle] = 1.0 + longest / spacing);
        }
        slenderness
    }

    pub fn count(&self) -> usize {
        self.rest.len()
    }

    pub fn finest(&self) -> usize {
        self.levels.len() - 1
    }

    /// Particles of the coarser levels come after those of the finest.
    pub fn finest_count(&self) -> usize {
        self.levels[self.finest()].len()
    }

    /// Lists of particle `at` of a level.
    fn link(&mut self, made: &[Level], level: usize, at: usize) {
        let index = made[level].index[at];
        let find = |level: usize, place: [i64; 3], ranges: &[Range<usize>]| {
            made[level].places.get(&place).map(|found| ranges[level].start as u32 + found)
        };
        let ranges = self.levels.clone();
        let cube = |low: i64, high: i64| {
            (low..=high)
                .flat_map(move |x| (low..=high).flat_map(move |y| (low..=high).map(move |z| [x, y, z])))
        };
        let shifted = |base: [i64; 3], by: [i64; 3]| [0, 1, 2].map(|axis| base[axis] + by[axis]);
        let beside = cube(-1, 1).filter(|by| *by != [0; 3]);
        self.same.push(beside.filter_map(|by| find(level, shifted(index, by), &ranges)));
        let inside = |by: &[i64; 3]| by.iter().all(|step| (0..=1).contains(step));
        if level < self.finest() {
            let base = index.map(|i| 2 * i);
            let of = |by: [i64; 3]| find(level + 1, shifted(base, by), &ranges);
            self.daughters.push(cube(0, 1).filter_map(of));
            self.finer.push(cube(-1, 2).filter(|by| !inside(by)).filter_map(of));
        } else {
            self.daughters.push([]);
            self.finer.push([]);
        }
        if level == 0 {
            self.coarser.push([]);
            self.leaders.push([]);
            return;
        }
        let above = index.map(|i| i.div_euclid(2));
        let side = index.map(|i| if i.rem_euclid(2) == 0 { -1 } else { 1 });
        let towards = cube(0, 1).filter(|by| *by != [0; 3]).map(|by| [0, 1, 2].map(|a| by[a] * side[a]));
        self.coarser.push(towards.filter_map(|by| find(level - 1, shifted(above, by), &ranges)));
        let particle = ranges[level].start + at;
        let Some(mother) = find(level - 1, above, &ranges) else {
            unreachable!("every particle was grouped into a mother");
        };
        self.mother[particle] = Some(mother);
        let face = |axis: usize, side: [i64; 3]| -> Vec<u32> {
            let others = [(axis + 1) % 3, (axis + 2) % 3];
            let corner = |first: i64, second: i64| {
                let mut by = [0; 3];
                by[axis] = side[axis];
                by[others[0]] = first * side[others[0]];
                by[others[1]] = second * side[others[1]];
                find(level - 1, shifted(above, by), &ranges)
            };
            [(0, 0), (0, 1), (1, 0), (1, 1)].into_iter().filter_map(|(a, b)| corner(a, b)).collect()
        };
        let leaders = self.place(particle, mother, level, &|axis, mirrored| {
            face(axis, if mirrored { side.map(|s| -s) } else { side })
        });
        self.leaders.push(leaders);
    }

    /// What a daughter follows: the frame that its mother spans with the middles of the faces of particles on the daughter's side.
    ///
    /// `x_d = x_M + Σ_k c_k a_k` with the axes `a_k = x̄_face - x_M`, and `c` so that it holds at rest. Where a face has no particle, the
    /// opposite one is taken, mirrored; where that has none, or axes are near to one plane, an axis of the world, which stays.
    fn place(
        &self,
        particle: usize,
        mother: u32,
        level: usize,
        face: &dyn Fn(usize, bool) -> Vec<u32>,
    ) -> Vec<(u32, f64)> {
        let from = self.rest[mother as usize];
        let middle = |face: &[u32]| {
            let mass: f64 = face.iter().map(|at| self.masses[*at as usize]).sum();
            let moment: Vec3 =
                face.iter().map(|at| self.rest[*at as usize] * self.masses[*at as usize]).sum();
            moment * (1.0 / mass)
        };
        // particles of the face, and the sign of the axis
        let mut faces: Vec<(Vec<u32>, f64)> = (0..3)
            .map(|axis| match face(axis, false) {
                own if !own.is_empty() => (own, 1.0),
                _ => (face(axis, true), -1.0),
            })
            .collect();
        let axes = |faces: &[(Vec<u32>, f64)]| {
            let mut columns = [Vec3::ZERO; 3];
            for (axis, (face, sign)) in faces.iter().enumerate() {
                columns[axis] = if face.is_empty() {
                    Vec3::AXES[axis] * self.spacing[level - 1]
                } else {
                    (middle(face) - from) * *sign
                };
            }
            Mat3 { columns }
        };
        let volume = self.spacing[level - 1].powi(3);
        if axes(&faces).determinant().abs() < 1e-3 * volume {
            // the one that leans most against its own axis of the world
            let leans = |axis: usize| {
                let a = axes(&faces).columns[axis];
                a.dot(Vec3::AXES[axis]).abs() / a.length().max(f64::MIN_POSITIVE)
            };
            let worst = (0..3).min_by(|a, b| leans(*a).total_cmp(&leans(*b))).unwrap_or(0);
            faces[worst].0.clear();
        }
        let arm = self.rest[particle] - from;
        let Some(inverse) = axes(&faces).try_inverse().filter(|inverse| inverse.is_finite()) else {
            return vec![(mother, 1.0)];
        };
        let c = (inverse * arm).to_array();
        let mut weights: BTreeMap<u32, f64> = BTreeMap::from([(mother, 1.0)]);
        for ((face, sign), c) in faces.iter().zip(c).filter(|((face, _), _)| !face.is_empty()) {
            let mass: f64 = face.iter().map(|at| self.masses[*at as usize]).sum();
            for at in face {
                *weights.entry(*at).or_insert(0.0) += sign * c * self.masses[*at as usize] / mass;
            }
            *weights.entry(mother).or_insert(0.0) -= sign * c;
        }
        weights.into_iter().filter(|(_, weight)| *weight != 0.0).collect()
    }

    pub fn bytes(&self) -> usize {
        let lists = [&self.daughters, &self.same, &self.finer, &self.coarser];
        lists.iter().map(|lists| lists.bytes()).sum::<usize>() + self.leaders.bytes() + 56 * self.count()
    }
}

#[cfg(test)]
pub mod tests {
    use super::*;

    /// Particles of a block of a lattice, of unit mass and volume.
    pub fn block(counts: [usize; 3], levels: usize) -> Octree {
        let mut points = Vec::new();
        for z in 0..counts[2] {
            for y in 0..counts[1] {
                points.extend((0..counts[0]).map(|x| Vec3::new(x as f64, y as f64, z as f64)));
            }
        }
        let ones = vec![1.0; points.len()];
        Octree::new(&points, &ones, &ones, 1.0, levels).unwrap()
    }

    /// Mass and centre of mass are those of the body on every level; inner particles have 26, 56 and 7 neighbours.
    #[test]
    fn levels_weigh_alike_and_tables_are_complete() {
        for (counts, levels) in [([8, 8, 8], 4), ([5, 7, 4], 3)] {
            let tree = block(counts, levels);
            let of = |level: usize| {
                let mass: f64 = tree.levels[level].clone().map(|at| tree.masses[at]).sum();
                let moment: Vec3 = tree.levels[level].clone().map(|at| tree.rest[at] * tree.masses[at]).sum();
                (mass, moment * (1.0 / mass))
            };
            let (mass, centre) = of(tree.finest());
            for level in 0..tree.finest() {
                assert!((of(level).0 - mass).abs() < 1e-12 * mass);
                assert!((of(level).1 - centre).length() < 1e-12);
            }
        }
        let tree = block([16, 16, 16], 3);
        // well inside the middle level
        let inner = tree.levels[1].clone().filter(|at| tree.same.of(*at).len() == 26).collect::<Vec<_>>();
        assert_eq!(inner.len(), 6 * 6 * 6);
        for at in inner {
            assert_eq!((tree.finer.of(at).len(), tree.coarser.of(at).len()), (56, 7));
            assert_eq!(tree.daughters.of(at).len(), 8);
            // who is someone's neighbour has that one for a neighbour
            assert!(
                tree.finer.of(at).iter().all(|finer| tree.coarser.of(*finer as usize).contains(&(at as u32)))
            );
        }
    }

    /// Daughters follow every affine motion of the mothers' level exactly, also at borders, where no axis is missing.
    #[test]
    fn daughters_follow_affine_motions() {
        let turn = Mat3::from_rows([[0.9, 0.3, -0.2], [0.1, 1.1, 0.4], [-0.3, 0.2, 1.2]]);
        for (counts, levels) in [([8, 8, 8], 3), ([5, 7, 9], 2)] {
            let tree = block(counts, levels);
            for at in 0..tree.count() {
                let leaders = tree.leaders.of(at);
                if leaders.is_empty() {
                    assert_eq!(usize::from(tree.level_of[at]), 0);
                    continue;
                }
                assert!((leaders.iter().map(|(_, weight)| weight).sum::<f64>() - 1.0).abs() < 1e-12);
                let placed: Vec3 =
                    leaders.iter().map(|(leader, weight)| turn * tree.rest[*leader as usize] * *weight).sum();
                assert!((placed - turn * tree.rest[at]).length() < 1e-12, "{at}");
            }
        }
    }

    /// A row of four is one, a sheet of three by two is as long as its longer side; their daughters tell gradients.
    #[test]
    fn rows_and_sheets_are_slender() {
        for (counts, levels, expected) in [([16, 4, 4], 3, vec![4.0; 4]), ([6, 4, 2], 2, vec![3.0; 6])] {
            let tree = block(counts, levels);
            let of = |level: usize| &tree.slenderness[tree.levels[level].clone()];
            let apart = of(0).iter().zip(&expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(of(0).len() == expected.len() && apart < 1e-12, "{:?}", of(0));
            assert!((1..levels).all(|level| of(level).iter().all(|slender| *slender == 0.0)));
        }
    }

    /// What is on no lattice is refused, and what is one particle is not grouped.
    #[test]
    fn what_is_no_octree_is_refused() {
        let points = [Vec3::ZERO, Vec3::new(1.0, 0.1, 0.0)];
        let refused = Octree::new(&points, &[1.0; 2], &[1.0; 2], 1.0, 2).unwrap_err();
        assert_eq!(refused, OctreeError::OffLattice { point: 1, spacing: 1.0 });
        let points = [Vec3::ZERO, Vec3::AXES[0]];
        let refused = Octree::new(&points, &[1.0; 2], &[1.0; 2], 1.0, 3).unwrap_err();
        assert_eq!(refused, OctreeError::TooManyLevels { count: 3, most: 2 });
    }
}
