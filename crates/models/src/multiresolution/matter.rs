//! The matter of a body, as the cells of its finest mesh hold it, seen by each level.
//!
//! A tetrahedron of any level stands for the finest cells whose middles it carries: for their volumes, with their
//! materials. So all levels have the same volume and mass, a homogeneous strain has the same energy whoever is at work,
//! and parts of other materials need nothing of the coarse meshes.

use souple_math::Vec3;
use souple_mesh::{CellLocator, Mesh, recursive_bisection};

use super::links::Hierarchy;
use crate::materials::Material;
use crate::solids::law_of_samples;
use crate::solids::layout::{Chunk, LANES};
use crate::solids::sample_law::SampleLaw;

/// The part of one material that a tetrahedron stands for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    pub tet: u32,
    pub material: u16,
    /// Of all cells that it carries [m³].
    pub volume: f64,
}

/// Samples of one level and law, eight to a block.
pub struct Group {
    pub law: Box<dyn SampleLaw>,
    /// Parameters of its samples; volumes are not used.
    pub chunk: Chunk,
    /// Block of the first samples among all blocks.
    pub first_block: usize,
    pub block_count: usize,
}

/// All samples of all levels.
pub struct Matter {
    pub groups: Vec<Group>,
    /// By block and lane; lanes past the last sample of a group are empty.
    pub slots: Vec<Option<Sample>>,
    /// Of each level: the slot that stands for each cell of the finest mesh.
    pub slot_of_cell: Vec<Vec<u32>>,
    /// Of the finest mesh [m³].
    pub cell_volumes: Vec<f64>,
    pub materials: Vec<Material>,
    pub material_of_cell: Vec<u16>,
}

impl Matter {
    pub fn new(
        hierarchy: &Hierarchy,
        meshes: &[&Mesh],
        materials: &[Material],
        material_of_cell: &[u16],
    ) -> Self {
        let mut matter = Self {
            groups: Vec::new(),
            slots: Vec::new(),
            slot_of_cell: Vec::new(),
            cell_volumes: meshes[hierarchy.finest()].cell_volumes(),
            materials: materials.to_vec(),
            material_of_cell: material_of_cell.to_vec(),
        };
        for level in 0..hierarchy.level_count() {
            matter.add_level(hierarchy, meshes, level);
        }
        matter
    }

    pub fn block_count(&self) -> usize {
        self.slots.len() / LANES
    }

    pub fn material(&self, sample: &Sample) -> &Material {
        &self.materials[usize::from(sample.material)]
    }

    fn add_level(&mut self, hierarchy: &Hierarchy, meshes: &[&Mesh], level: usize) {
        let tet_of_cell = tets_of_cells(hierarchy, meshes, level);
        // cells of one material in one tetrahedron are one sample
        let key = |cell: u32| (tet_of_cell[cell as usize], self.material_of_cell[cell as usize]);
        let mut cells: Vec<u32> = (0..tet_of_cell.len() as u32).collect();
        cells.sort_by_key(|cell| (key(*cell), *cell));
        let mut samples: Vec<Sample> = Vec::new();
        let mut sample_of_cell = vec![0; cells.len()];
        for cell in cells {
            let ((tet, material), volume) = (key(cell), self.cell_volumes[cell as usize]);
            match samples.last_mut() {
                Some(last) if (last.tet, last.material) == (tet, material) => last.volume += volume,
                _ => samples.push(Sample { tet, material, volume }),
            }
            sample_of_cell[cell as usize] = samples.len() - 1;
        }
        let mut slot_of_sample = vec![0; samples.len()];
        let mut laws: Vec<&crate::materials::MaterialLaw> = Vec::new();
        for material in &self.materials {
            if !laws.contains(&&material.law) {
                laws.push(&material.law);
            }
        }
        let (mut groups, mut slots) = (Vec::new(), Vec::new());
        for law in laws {
            let is_of = |sample: &usize| self.material(&samples[*sample]).law == *law;
            let members: Vec<usize> = (0..samples.len()).filter(is_of).collect();
            if members.is_empty() {
                continue;
            }
            let middle = |sample: &usize| {
                let corners = hierarchy.tets[samples[*sample].tet as usize].corners;
                corners.iter().map(|corner| hierarchy.rest[*corner as usize]).sum::<Vec3>() * 0.25
            };
            let middles: Vec<Vec3> = members.iter().map(middle).collect();
            let order = recursive_bisection(&middles, LANES);
            let block_count = members.len().div_ceil(LANES);
            let first_slot = self.slots.len() + slots.len();
            let member = |place: usize| members[order[place.min(order.len() - 1)] as usize];
            for place in 0..block_count * LANES {
                if place < members.len() {
                    slot_of_sample[member(place)] = (first_slot + place) as u32;
                }
                slots.push((place < members.len()).then(|| samples[member(place)]));
            }
            let (law, count) = law_of_samples(law, false);
            let chunk = Chunk::of_samples(block_count, |block, lane| {
                let sample = &samples[member(block * LANES + lane)];
                (sample.volume, &self.material(sample).parameters[..count])
            });
            groups.push(Group { law, chunk, first_block: first_slot / LANES, block_count });
        }
        self.groups.extend(groups);
        self.slots.extend(slots);
        let slots_of_cells = sample_of_cell.iter().map(|sample: &usize| slot_of_sample[*sample]);
        self.slot_of_cell.push(slots_of_cells.collect());
    }

    pub fn bytes(&self) -> usize {
        let chunks: usize = self.groups.iter().map(|group| group.chunk.bytes()).sum();
        let slots: usize = self.slot_of_cell.iter().map(|slots| 4 * slots.capacity()).sum();
        chunks
            + slots
            + size_of::<Option<Sample>>() * self.slots.capacity()
            + 8 * self.cell_volumes.capacity()
            + 2 * self.material_of_cell.capacity()
    }
}

/// The tetrahedron of a level that carries the middle of each cell of the finest mesh.
fn tets_of_cells(hierarchy: &Hierarchy, meshes: &[&Mesh], level: usize) -> Vec<u32> {
    let finest = meshes[hierarchy.finest()];
    let first = hierarchy.tets_of_level[level].start as u32;
    if level == hierarchy.finest() {
        return (first..first + finest.cell_count() as u32).collect();
    }
    let locator = CellLocator::new(meshes[level]);
    let carrier = |middle: &Vec3| first + locator.carrier(*middle).map_or(0, |location| location.cell);
    finest.cell_centres().iter().map(carrier).collect()
}
