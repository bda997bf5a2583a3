//! The surface of particles as they stand: their density on the nodes around them, and its polygons.
//!
//! Each block of nodes gathers the particles that reach it, in the order of their blocks, so the result is the same for any
//! number of threads. Where the cores of their kernels alone make all nodes inside, the rest is left out. Only blocks near the
//! surface are kept.

use rayon::prelude::*;
use souple_math::Vec3;

use crate::error::SkinError;
use crate::grid::{EDGE, FARTHEST, Grid, Lattice, NEAR, NODES, block_of, key_of, steps_to};
use crate::polygons::Polygons;
use crate::skin::{MOST_BLOCKS, MOST_SAMPLED};
use crate::surface::surface_of;
use crate::target::particles::{Cloud, REACH};
use crate::widest::{Rows, run_widest};

/// Particles by their block.
struct Sorted {
    /// Blocks with particles, ascending, and where each one's particles begin.
    blocks: Vec<(u64, u32)>,
    /// Position [voxels] and inverse of twice the radius [1/voxel], block by block.
    particles: Vec<(Vec3, f64)>,
}

/// Particles that wear a surface.
#[derive(Clone, Debug)]
pub struct Dressed {
    pub surface: Polygons,
    /// Outward, of the surface's points.
    pub normals: Vec<Vec3>,
    lattice: Lattice,
    keys: Vec<u64>,
    values: Vec<f32>,
}

impl Dressed {
    /// Whether a point is within the surface.
    pub fn holds(&self, point: Vec3) -> bool {
        let grid = Grid { keys: &self.keys, values: &self.values };
        grid.sample(self.lattice.to_voxels(point)).0 > 0.0
    }
}

/// The surface where the density of particles, position and radius [m], is `iso`.
///
/// # Errors
/// A particle is nowhere or has no radius; they are too far from each other, or `iso` too high, for any density to come up to it;
/// the voxels are too small for so large a cloud, or too large to see it.
pub fn dress(particles: &[(Vec3, f64)], voxel: f64, iso: f64) -> Result<Dressed, SkinError> {
    let is_wrong = |(x, radius): &(Vec3, f64)| !(x.is_finite() && *radius > 0.0 && radius.is_finite());
    if let Some(index) = particles.iter().position(is_wrong) {
        let (position, radius) = particles[index];
        let place = position.to_array();
        return Err(SkinError::Target(format!(
            "particle {index} is at {place:?} with the radius {radius}; expected finite numbers and a radius above 0"
        )));
    }
    let Some((origin, _)) = particles.first().copied() else {
        return Err(SkinError::Target("there is no particle".to_owned()));
    };
    let lattice = Lattice { origin, voxel };
    let reach = REACH * particles.iter().map(|(_, radius)| *radius).fold(0.0, f64::max) / voxel;
    let sorted = sort(particles, &lattice)?;
    let cloud = souple_mesh::BoundingBox::of(particles.iter().map(|(x, _)| *x)).grown(reach * voxel);
    let size = cloud.size().to_array();
    // blocks that a particle of a neighbouring block may reach
    let steps = (reach / EDGE as f64).ceil();
    let blocks = (2.0 * steps + 1.0).powi(3) * sorted.blocks.len() as f64;
    // most are named by several of their neighbours
    if blocks.is_nan() || blocks > 64.0 * MOST_BLOCKS as f64 {
        return Err(SkinError::TooManyBlocks { voxel, size, blocks });
    }
    let steps = steps as i64;
    let keys = reached(&sorted, steps);
    if keys.len() > MOST_SAMPLED {
        let blocks = keys.len() as f64;
        return Err(SkinError::TooManyBlocks { voxel, size, blocks });
    }
    let around = |key: u64| Around::of(&sorted, block_of(key), steps);
    let densities: Vec<Density> =
        keys.par_iter().map(|key| Density::of(&around(*key), iso, keys.len() <= ROOM)).collect();
    let near = near(&keys, &densities);
    let values: Vec<Box<[f32; NODES]>> =
        near.par_iter().map(|index| densities[*index].whole(|| around(keys[*index]), iso)).collect();
    if values.is_empty() {
        return Err(nothing_inside(particles, voxel, iso));
    }
    let keys: Vec<u64> = near.iter().map(|index| keys[*index]).collect();
    let values: Vec<f32> =
        values.iter().flat_map(|values| values.iter().map(|value| value.clamp(-NEAR, NEAR))).collect();
    let (surface, normals) = surface_of(Grid { keys: &keys, values: &values }, &lattice);
    Ok(Dressed { surface, normals, lattice, keys, values })
}

/// Why no node is inside: the density comes up to `iso` nowhere, or only between nodes.
fn nothing_inside(particles: &[(Vec3, f64)], voxel: f64, iso: f64) -> SkinError {
    let mut cloud = Cloud::default();
    if let Err(why) = cloud.place(particles.iter().copied()) {
        return SkinError::Target(why);
    }
    // a kernel is highest at its particle, and so is a sum of kernels near one of them
    let most = particles.par_iter().map(|(position, _)| cloud.density(*position)).reduce(|| 0.0, f64::max);
    if most <= iso {
        return SkinError::Sparse { most, iso };
    }
    let bounds = souple_mesh::BoundingBox::of(particles.iter().map(|(x, _)| *x));
    SkinError::Empty { low: bounds.low.to_array(), high: bounds.high.to_array(), voxel }
}

/// Blocks of which all values are kept, 134 MB; of more only those that the surface runs through, and those around these
/// are made again.
const ROOM: usize = 1 << 16;

/// The density on the nodes of a block, less the iso value.
struct Density {
    sign: Sign,
    values: Values,
}

enum Values {
    /// Of the cores of the kernels alone, by which all nodes are inside.
    OfCores(Box<[f32; NODES]>),
    Whole(Box<[f32; NODES]>),
    /// No particle reaches, or there is no room for them.
    None,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Sign {
    Inside,
    Outside,
    Both,
}

impl Density {
    fn of(around: &Around, iso: f64, has_room: bool) -> Self {
        if around.particles.is_empty() {
            return Self { sign: Sign::Outside, values: Values::None };
        }
        let mut values = Box::new([-iso as f32; NODES]);
        let inside = |values: &[f32; NODES]| values.iter().filter(|value| **value > 0.0).count();
        around.add(Part::Cores, &mut values);
        // no kernel is below zero: what cores alone make inside stays so
        if inside(&values) == NODES {
            let values = if has_room { Values::OfCores(values) } else { Values::None };
            return Self { sign: Sign::Inside, values };
        }
        around.add(Part::Rests, &mut values);
        let sign = match inside(&values) {
            0 => Sign::Outside,
            NODES => Sign::Inside,
            _ => Sign::Both,
        };
        let keeps = has_room || sign == Sign::Both;
        Self { sign, values: if keeps { Values::Whole(values) } else { Values::None } }
    }

    /// All of its values, those that were not kept made again from the particles around.
    fn whole(&self, around: impl FnOnce() -> Around, iso: f64) -> Box<[f32; NODES]> {
        match &self.values {
            Values::Whole(values) => values.clone(),
            Values::OfCores(values) => {
                let mut values = values.clone();
                around().add(Part::Rests, &mut values);
                values
            }
            Values::None => {
                let (mut values, around) = (Box::new([-iso as f32; NODES]), around());
                [Part::Cores, Part::Rests].into_iter().for_each(|part| around.add(part, &mut values));
                values
            }
        }
    }
}

/// Blocks that a particle may reach, ascending.
fn reached(sorted: &Sorted, steps: i64) -> Vec<u64> {
    let mut keys: Vec<u64> = Vec::new();
    for (key, _) in &sorted.blocks {
        let [x, y, z] = block_of(*key);
        let around = |c: i64| c - steps..=c + steps;
        around(z).for_each(|z| around(y).for_each(|y| keys.extend(around(x).map(|x| key_of([x, y, z])))));
    }
    keys.sort_unstable();
    keys.dedup();
    keys
}

/// Blocks with a surface in them, and those around these and on both sides of one that runs between blocks.
fn near(keys: &[u64], densities: &[Density]) -> Vec<usize> {
    // what no particle reaches is outside
    let sign_of = |key: u64| keys.binary_search(&key).map_or(Sign::Outside, |index| densities[index].sign);
    let is_near = |index: &usize| {
        let (own, place) = (densities[*index].sign, block_of(keys[*index]));
        let other = |number: usize| {
            let steps = steps_to(number);
            sign_of(key_of([0, 1, 2].map(|axis| place[axis] + i64::from(steps[axis]))))
        };
        own == Sign::Both || (0..27).any(|number| other(number) != own)
    };
    (0..keys.len()).into_par_iter().filter(is_near).collect()
}

fn sort(particles: &[(Vec3, f64)], lattice: &Lattice) -> Result<Sorted, SkinError> {
    let mut order = Vec::with_capacity(particles.len());
    for (index, (position, _)) in particles.iter().enumerate() {
        let block = (lattice.to_voxels(*position) * (1.0 / EDGE as f64)).to_array().map(f64::floor);
        if block.iter().any(|c| c.abs() > FARTHEST as f64 / 2.0) {
            return Err(SkinError::FarParticle {
                particle: index,
                place: position.to_array(),
                most: FARTHEST as f64 / 2.0 * EDGE as f64 * lattice.voxel,
                origin: lattice.origin.to_array(),
            });
        }
        order.push((key_of(block.map(|c| c as i64)), index as u32));
    }
    order.sort_unstable();
    let mut sorted = Sorted { blocks: Vec::new(), particles: Vec::with_capacity(particles.len()) };
    for (key, index) in order {
        if sorted.blocks.last().is_none_or(|(last, _)| *last != key) {
            sorted.blocks.push((key, sorted.particles.len() as u32));
        }
        let (position, radius) = particles[index as usize];
        sorted.particles.push((lattice.to_voxels(position), 0.5 * lattice.voxel / radius));
    }
    Ok(sorted)
}

impl Sorted {
    fn of_block(&self, at: usize) -> &[(Vec3, f64)] {
        let end = self.blocks.get(at + 1).map_or(self.particles.len(), |(_, first)| *first as usize);
        &self.particles[self.blocks[at].1 as usize..end]
    }
}

/// The particles that reach a block.
struct Around {
    /// Position [voxels] and inverse of twice the radius [1/voxel].
    particles: Vec<(Vec3, f64)>,
    /// Of the block's first node.
    low: Vec3,
}

impl Around {
    fn of(sorted: &Sorted, block: [i64; 3], steps: i64) -> Self {
        let low = Vec3::from_array(block.map(|c| (c * EDGE as i64) as f64));
        let high = low + Vec3::new(1.0, 1.0, 1.0) * (EDGE - 1) as f64;
        let mut particles = Vec::new();
        for z in block[2] - steps..=block[2] + steps {
            for y in block[1] - steps..=block[1] + steps {
                let row = |x: i64| key_of([x, y, z]);
                let first = sorted.blocks.partition_point(|(key, _)| *key < row(block[0] - steps));
                let ends = row(block[0] + steps);
                for at in (first..sorted.blocks.len()).take_while(|at| sorted.blocks[*at].0 <= ends) {
                    particles.extend(sorted.of_block(at).iter().copied().filter(|(position, inverse)| {
                        let outside =
                            (low - *position).max_components(*position - high).max_components(Vec3::ZERO);
                        outside.length_sq() * inverse * inverse < 4.0
                    }));
                }
            }
        }
        Self { particles, low }
    }

    /// Adds a part of their kernels to the nodes of the block.
    fn add(&self, part: Part, values: &mut [f32; NODES]) {
        run_widest(Splat { particles: &self.particles, low: self.low, part, values });
    }
}

/// Rows of nodes about a particle: those that the core of its kernel meets, and all others that it reaches.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Part {
    Cores,
    Rests,
}

/// How far the core of a kernel reaches, of the 2 lengths that all of it does: four fifths of its integral lie within. Among
/// particles at twice their radius the cores alone come to 0.65 or more.
const CORE: f32 = 1.2;

/// A part of the kernels of particles on the nodes of a block.
struct Splat<'a> {
    particles: &'a [(Vec3, f64)],
    low: Vec3,
    part: Part,
    values: &'a mut [f32; NODES],
}

impl Rows for Splat<'_> {
    #[inline(always)]
    fn run(self) {
        let (rows, _) = self.values.as_chunks_mut::<EDGE>();
        for &(position, inverse) in self.particles {
            let inverse = inverse as f32;
            let square = |reach: f32| (reach / inverse) * (reach / inverse);
            let (core_sq, whole_sq) = (square(CORE), square(2.0));
            let within = match self.part {
                Part::Cores => [0.0, core_sq],
                Part::Rests => [core_sq, whole_sq],
            };
            let [x, y, z] = (position - self.low).to_array().map(|c| c as f32);
            // from the nodes of all rows, along them
            let beside = (x - (EDGE - 1) as f32).max(-x).max(0.0);
            for k in 0..EDGE {
                let dz = k as f32 - z;
                if dz * dz >= within[1] {
                    continue;
                }
                let across: [f32; EDGE] = std::array::from_fn(|j| {
                    let dy = j as f32 - y;
                    dy * dy + dz * dz
                });
                let mut met = 0_u32;
                for (j, across) in across.iter().enumerate() {
                    // both parts compare the same numbers, so each row is in one of them
                    let away = beside * beside + across;
                    met |= u32::from((away >= within[0]) & (away < within[1])) << j;
                }
                while met != 0 {
                    let j = met.trailing_zeros() as usize;
                    met &= met - 1;
                    add_kernels(&mut rows[j + EDGE * k], x, across[j], inverse);
                }
            }
        }
    }
}

/// Adds the kernel of a particle that stands at `x` along a row of nodes, and `across` from it, squared [voxels].
#[inline(always)]
fn add_kernels(nodes: &mut [f32; EDGE], x: f32, across: f32, inverse: f32) {
    let mut sums = *nodes;
    for (node, sum) in sums.iter_mut().enumerate() {
        let dx = node as f32 - x;
        let q = (dx * dx + across).sqrt() * inverse;
        // the kernel of particles, in 32 bits: sums of some tens of it are right to 1e-6
        let (far, near) = ((2.0 - q).max(0.0), (1.0 - q).max(0.0));
        *sum += std::f32::consts::FRAC_1_PI * (0.25 * far * far * far - near * near * near);
    }
    *nodes = sums;
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygons::{Audit, area_and_volume};

    /// A cube of particles at twice their radius is dressed by one closed surface of about its volume; two far apart by two.
    #[test]
    fn particles_are_dressed() {
        let cube = |at: Vec3| {
            (0..512).map(move |i: i32| {
                let place = Vec3::new((i % 8).into(), (i / 8 % 8).into(), (i / 64).into());
                (place * 0.02 + at, 0.01)
            })
        };
        let mut audit = Audit::default();
        let one: Vec<(Vec3, f64)> = cube(Vec3::ZERO).collect();
        let Dressed { surface, normals, .. } = dress(&one, 0.01, 0.5).unwrap();
        assert_eq!(normals.len(), surface.points.len());
        assert_eq!(audit.check(surface.points.len(), &surface.triangles).unwrap(), (2, 1));
        let volume = area_and_volume(&surface.points, &surface.triangles).1;
        // corners are rounded, by less than a tenth of the cube
        assert!((volume / 0.16_f64.powi(3) - 1.0).abs() < 0.1, "{volume}");
        let two: Vec<(Vec3, f64)> = cube(Vec3::ZERO).chain(cube(Vec3::X)).collect();
        let Dressed { surface, .. } = dress(&two, 0.01, 0.5).unwrap();
        assert_eq!(audit.check(surface.points.len(), &surface.triangles).unwrap(), (4, 2));
    }

    /// A particle apart from all others is outside the surface of those, and so is one that is between the nodes.
    #[test]
    fn particles_outside_are_known() {
        let row = |count: i32| (0..count).map(|i| (Vec3::X * f64::from(i), 0.8));
        let particles: Vec<(Vec3, f64)> = row(10).chain([(Vec3::Y * 9.0, 0.8)]).collect();
        let dressed = dress(&particles, 0.2, 0.5).unwrap();
        let outside: Vec<usize> =
            (0..particles.len()).filter(|index| !dressed.holds(particles[*index].0)).collect();
        assert_eq!(outside, [10]);
        // deep inside, where no block is kept
        let ball: Vec<(Vec3, f64)> = (0..32_768)
            .map(|i: i32| (Vec3::new((i % 32).into(), (i / 32 % 32).into(), (i / 1024).into()), 0.5))
            .collect();
        let dressed = dress(&ball, 0.5, 0.5).unwrap();
        assert!(ball.iter().all(|(position, _)| dressed.holds(*position)));
    }

    /// Cores and rests of kernels add up to the density on all nodes of a block; a block that cores alone make inside has the same
    /// values from what was kept and made anew.
    #[test]
    fn parts_of_kernels_are_the_density() {
        let mut noise = 7_u64;
        let mut random = || {
            noise = noise.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (noise >> 11) as f64 / (1_u64 << 53) as f64
        };
        // two to five voxels from their neighbours
        let particles: Vec<(Vec3, f64)> = (0..2000)
            .map(|_| (Vec3::new(random(), random(), random()) * 40.0, 1.0 + 1.5 * random()))
            .collect();
        let lattice = Lattice { origin: Vec3::ZERO, voxel: 1.0 };
        let sorted = sort(&particles, &lattice).unwrap();
        let mut signs = Vec::new();
        for block in (0..125).map(|i: i64| [i % 5, i / 5 % 5, i / 25]) {
            let around = || Around::of(&sorted, block, 2);
            let kept = Density::of(&around(), 0.5, true);
            let values = kept.whole(around, 0.5);
            assert_eq!(values, Density::of(&around(), 0.5, false).whole(around, 0.5));
            signs.push(matches!(kept.values, Values::OfCores(_)));
            for (node, value) in values.iter().enumerate() {
                let at =
                    |axis: usize| (node / EDGE.pow(axis as u32) % EDGE) as f64 + 8.0 * block[axis] as f64;
                let place = Vec3::new(at(0), at(1), at(2));
                let of_each = |(x, radius): &(Vec3, f64)| {
                    crate::target::particles::kernel((*x - place).length() / (2.0 * radius))
                };
                let density: f64 = particles.iter().map(of_each).sum();
                // some tens of kernels in 32 bits
                assert!(
                    (f64::from(*value) + 0.5 - density).abs() < 64.0 * f64::from(f32::EPSILON),
                    "{value} {density}"
                );
            }
        }
        assert!(signs.contains(&true) && signs.contains(&false));
    }

    /// What cannot be dressed is said.
    #[test]
    fn bad_particles_end_in_words() {
        let refused =
            |particles: &[(Vec3, f64)], voxel: f64| dress(particles, voxel, 0.5).unwrap_err().to_string();
        assert!(refused(&[], 1.0).contains("no particle"));
        assert!(refused(&[(Vec3::X * f64::NAN, 1.0)], 1.0).contains("particle 0"));
        assert!(refused(&[(Vec3::ZERO, 0.0)], 1.0).contains("radius above 0"));
        // one particle alone has a density of 1/π
        assert!(refused(&[(Vec3::ZERO, 1.0)], 1.0).contains("0.318 at most"));
        // one of 64 in a cube of two spacings is a node; the others fall through a grid of ten
        let cube: Vec<(Vec3, f64)> = (0..64)
            .map(|i: i32| {
                (Vec3::new((i % 4).into(), (i / 4 % 4).into(), (i / 16).into()) + Vec3::X * 5.0, 0.5)
            })
            .chain([(Vec3::ZERO, 0.5)])
            .rev()
            .collect();
        assert!(refused(&cube, 10.0).contains("inside nowhere"));
        assert!(refused(&[(Vec3::ZERO, 1.0)], 1e-4).contains("larger voxels"));
    }
}
