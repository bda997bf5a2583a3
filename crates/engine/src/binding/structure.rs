//! What of the relations of a system stays from step to step: which share points, and the pattern of `J W Jᵀ`.

use std::sync::Arc;

use souple_math::{Mat3, Vec3};
use souple_solve::{BlockMatrix, DirectSolver, PatternBuilder, SolveError};

use crate::force::Force;
use crate::steppers::StepError;
use crate::system::System;

use super::unsolved;

/// What of the relations of a system stays from step to step.
#[derive(Debug)]
pub(crate) struct Structure {
    /// The force and the number within it of each relation.
    pub(super) relations: Vec<(usize, usize)>,
    /// Where the entries of each begin, and at the end of the list how many there are.
    pub(super) starts: Vec<usize>,
    /// The row and the relation of each entry.
    pub(super) rows: Vec<u32>,
    of_entries: Vec<u32>,
    /// Relation and entry of each row: where those of each begin.
    row_starts: Vec<usize>,
    of_rows: Vec<(u32, u32)>,
    /// The least row that relations lead to from each row.
    bodies: Vec<u32>,
    /// The least row that relations without a limit lead to.
    unyielding: Vec<u32>,
    /// Slot of the matrix, and the two entries of one row whose product goes there.
    pub(super) products: Vec<(u32, [u32; 2])>,
    pub(super) matrix: BlockMatrix,
    pub(super) solver: DirectSolver,
}

impl Structure {
    pub(super) fn new(system: &System) -> Result<Self, SolveError> {
        let (mut relations, mut starts, mut rows) = (Vec::new(), vec![0], Vec::new());
        let mut yields = Vec::new();
        let forces = system.forces.iter().map(AsRef::as_ref).enumerate();
        for (force, set) in
            forces.filter_map(|(index, force): (usize, &dyn Force)| Some((index, force.constraint_set()?)))
        {
            for relation in 0..set.relation_count() {
                relations.push((force, relation));
                yields.push(set.yields_at(relation).is_some());
                rows.extend_from_slice(set.rows(relation));
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
        let unyielding = bodies(&starts, &rows, of_row.len(), |relation| !yields[relation]);
        let bodies = bodies(&starts, &rows, of_row.len(), |_| true);
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
            unyielding,
            products,
            matrix,
            solver,
        })
    }

    pub(crate) fn relation_count(&self) -> usize {
        self.relations.len()
    }

    pub(super) fn relation_of(&self, entry: u32) -> usize {
        self.of_entries[entry as usize] as usize
    }

    /// The body of each row: rows of one body are related to each other; no relation is of two bodies.
    pub(super) fn bodies(&self) -> &[u32] {
        &self.bodies
    }

    /// The same by relations without a limit alone.
    pub(super) fn unyielding(&self) -> &[u32] {
        &self.unyielding
    }

    /// Rows of a relation, with its gradients there.
    pub(crate) fn gradients_of<'a>(
        &'a self,
        relation: usize,
        gradients: &'a [Mat3],
    ) -> impl Iterator<Item = (usize, Mat3)> + 'a {
        let entries = self.starts[relation]..self.starts[relation + 1];
        self.rows[entries.clone()].iter().map(|row| *row as usize).zip(gradients[entries].iter().copied())
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
    pub(super) fn spread(
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
fn bodies(starts: &[usize], rows: &[u32], row_count: usize, joins: impl Fn(usize) -> bool) -> Vec<u32> {
    let mut least: Vec<u32> = (0..row_count as u32).collect();
    let root = |least: &mut [u32], mut row: u32| {
        while least[row as usize] != row {
            least[row as usize] = least[least[row as usize] as usize];
            row = least[row as usize];
        }
        row
    };
    for (_, entries) in starts.windows(2).enumerate().filter(|(relation, _)| joins(*relation)) {
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
