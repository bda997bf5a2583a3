//! What is cut through: cells of the finest mesh that carry nothing any more.
//!
//! Coarser tetrahedra lose what these cells held of them, so their stiffness falls with every cell; and where a cut runs the
//! finest points are at work, as no coarse tetrahedron can open. Masses stay where they are.

use super::Cut;
use super::links::Hierarchy;
use super::matter::Matter;

/// The cuts of a body.
#[derive(Clone, Debug, Default)]
pub struct Cuts {
    /// By their dates.
    times: Vec<f64>,
    /// Of each cell of the finest mesh: the first cut through it, counted from 1; 0 where there is none.
    of_cell: Vec<u32>,
    /// Of each point: the first cut in whose way it would be, as that of a coarse mesh.
    beside: Vec<u32>,
}

/// Notes the first cut of one of some things.
fn mark(of: &mut u32, cut: u32) -> bool {
    let is_new = *of == 0;
    if is_new {
        *of = cut;
    }
    is_new
}

impl Cuts {
    pub fn new(hierarchy: &Hierarchy, matter: &Matter, mut cuts: Vec<Cut>) -> Self {
        if cuts.is_empty() {
            return Self::default();
        }
        cuts.sort_by(|a, b| a.time.total_cmp(&b.time));
        let mut made = Self {
            times: cuts.iter().map(|cut| cut.time).collect(),
            of_cell: vec![0; matter.cell_volumes.len()],
            beside: vec![0; hierarchy.point_count()],
        };
        let mut parents = vec![u32::MAX; hierarchy.point_count()];
        for coarse in hierarchy.levels[..hierarchy.finest()].iter().flat_map(Clone::clone) {
            hierarchy.children.get(coarse).iter().for_each(|child| parents[*child as usize] = coarse as u32);
        }
        for (number, cut) in (1..).zip(&cuts) {
            for cell in &cut.cells {
                mark(&mut made.of_cell[*cell as usize], number);
                made.clear_way(hierarchy, matter, &parents, *cell as usize, number);
            }
        }
        made
    }

    /// Coarse points that a tetrahedron with this cell is hung on, those around them, and whoever finer points must have
    /// subdivided to be at work there.
    fn clear_way(
        &mut self,
        hierarchy: &Hierarchy,
        matter: &Matter,
        parents: &[u32],
        cell: usize,
        number: u32,
    ) {
        for level in 0..hierarchy.level_count() {
            let Some(sample) = matter.slots[matter.slot_of_cell[level][cell] as usize] else { continue };
            for corner in hierarchy.tets[sample.tet as usize].corners {
                let around = hierarchy.tets_of_point.get(corner as usize).iter();
                let ring = around.flat_map(|tet| hierarchy.tets[*tet as usize].corners);
                for point in ring.chain([corner]) {
                    let mut point = point as usize;
                    // up to the coarsest; what is marked has been gone through
                    while mark(&mut self.beside[point], number) && parents[point] != u32::MAX {
                        point = parents[point] as usize;
                    }
                }
            }
        }
    }

    pub fn is_none(&self) -> bool {
        self.times.is_empty()
    }

    /// How many are made by a date.
    pub fn by(&self, time: f64) -> usize {
        self.times.iter().take_while(|date| **date <= time).count()
    }

    /// Whether a cell is cut when so many are made.
    pub fn is_through(&self, cell: usize, made: f64) -> bool {
        self.of_cell.get(cell).is_some_and(|cut| *cut > 0 && f64::from(*cut) <= made)
    }

    /// Whether finer points must be in the place of a coarse one when so many are made.
    pub fn is_beside(&self, point: usize, made: f64) -> bool {
        self.beside.get(point).is_some_and(|cut| *cut > 0 && f64::from(*cut) <= made)
    }
}
