//! Elastic forces of single samples: which of them, and on which of their corners, lists say.

use souple_formal::tape::BATCH;
use souple_math::{Mat3, Vec3};

use super::links::{Hierarchy, Tet};
use super::matter::{Group, Matter, Sample};
use crate::solids::layout::{LANES, LaneBlock};
use crate::solids::sample_law::{Answer, Run};

/// Samples of one block that are due, and which of their corners are to be pushed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Due {
    pub block: u32,
    /// A bit for each corner, of each lane; a lane without any is not due.
    pub corners: [u8; LANES],
}

impl Due {
    /// Slots of the samples that are due.
    pub fn slots(self) -> impl Iterator<Item = usize> {
        let first = self.block as usize * LANES;
        (0..LANES).filter(move |lane| self.corners[*lane] != 0).map(move |lane| first + lane)
    }
}

/// All corners of a sample.
pub const ALL_CORNERS: u8 = 0b1111;

/// What laws work in, one for each group.
#[derive(Debug, Default)]
pub struct LawMemory {
    of_group: Vec<Vec<LaneBlock>>,
}

/// Values at the points of a body, by their numbers over all meshes.
#[derive(Clone, Copy)]
pub struct Values<'a> {
    pub positions: &'a [Vec3],
    /// Changes of positions, where those of stresses are asked for.
    pub variation: &'a [Vec3],
}

impl LawMemory {
    pub fn new(matter: &Matter, answer: Answer) -> Self {
        let memory = |group: &Group| {
            let mut memory = vec![LaneBlock::default(); group.law.places(answer).memory_len.div_ceil(LANES)];
            group.law.prepare(answer, bytemuck::cast_slice_mut(&mut memory));
            memory
        };
        Self { of_group: matter.groups.iter().map(memory).collect() }
    }

    pub fn bytes(&self) -> usize {
        self.of_group.iter().map(|memory| size_of::<LaneBlock>() * memory.capacity()).sum()
    }

    /// Asks the laws of some samples, block after block, and hands out what they answer: `visit(lane's sample, its
    /// tetrahedron, corners, answer)`, the answer by columns of which an energy has one number.
    pub fn ask(
        &mut self,
        (hierarchy, matter): (&Hierarchy, &Matter),
        answer: Answer,
        due: impl IntoIterator<Item = Due>,
        values: Values,
        mut visit: impl FnMut(usize, &Sample, &Tet, u8, &Mat3),
    ) {
        let mut number = 0;
        for due in due {
            let block = due.block as usize;
            // groups and lists ascend
            while block >= matter.groups[number].first_block + matter.groups[number].block_count {
                number += 1;
            }
            let group = &matter.groups[number];
            let memory: &mut [f64] = bytemuck::cast_slice_mut(&mut self.of_group[number]);
            let places = group.law.places(answer);
            for lane in 0..LANES {
                let slot = block * LANES + lane;
                let sample = matter.slots[slot].as_ref().filter(|_| due.corners[lane] != 0);
                let tet = sample.map(|sample| &hierarchy.tets[sample.tet as usize]);
                let deformation = tet.map_or(Mat3::IDENTITY, |tet| tet.gradient(values.positions));
                store(&deformation, &mut memory[places.deformation + lane..]);
                if answer == Answer::Differential {
                    let variation = tet.map_or(Mat3::ZERO, |tet| tet.gradient(values.variation));
                    store(&variation, &mut memory[places.variation + lane..]);
                }
            }
            let first = block - group.first_block;
            let run = Run { chunk: &group.chunk, per_block: 1, first, end: first + 1 };
            group.law.answer(answer, &run, memory);
            for lane in 0..LANES {
                let slot = block * LANES + lane;
                let Some(sample) = matter.slots[slot].as_ref().filter(|_| due.corners[lane] != 0) else {
                    continue;
                };
                let result = &memory[places.result + lane..];
                let value = if answer == Answer::Energy { scalar(result[0]) } else { load(result) };
                visit(slot, sample, &hierarchy.tets[sample.tet as usize], due.corners[lane], &value);
            }
        }
    }
}

/// One number in the place of a matrix.
fn scalar(number: f64) -> Mat3 {
    Mat3::from_columns(Vec3::new(number, 0.0, 0.0), Vec3::ZERO, Vec3::ZERO)
}

/// Entry `e` of a matrix lies `e · BATCH` behind its first.
fn store(matrix: &Mat3, memory: &mut [f64]) {
    for (column, vector) in matrix.columns.iter().enumerate() {
        for (row, number) in vector.to_array().into_iter().enumerate() {
            memory[(3 * column + row) * BATCH] = number;
        }
    }
}

fn load(memory: &[f64]) -> Mat3 {
    let entry = |index: usize| memory[index * BATCH];
    let column = |first: usize| Vec3::new(entry(first), entry(first + 1), entry(first + 2));
    Mat3::from_columns(column(0), column(3), column(6))
}
