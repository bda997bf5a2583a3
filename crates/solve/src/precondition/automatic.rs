//! The preconditioner that suits a matrix, chosen anew for each from its numbers alone.
//!
//! What is hard about a stiff body is to carry a load from end to end; where the inertia of a step outweighs
//! stiffness nothing is carried far, and the cheapest preconditioner wins. Nothing of earlier matrices enters
//! the choice, so it does not matter for later bits what was solved before.

use std::sync::Arc;

use souple_math::Vec3;

use super::{
    BlockJacobi, BlockRole, Geometry, IncompleteCholesky, Preconditioner, RigidModes, RigidModesSettings,
};
use crate::matrix::check_pattern;
use crate::{BlockMatrix, Pattern, SolveError, reduce};

/// What [`Automatic`] chooses between.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Choice {
    BlockJacobi,
    IncompleteCholesky,
    RigidModes,
}

/// Above this weight of the diagonal, iterations are so few that only free ones pay.
const LIGHT: f64 = 0.15;
/// Below this, loads travel farther than incomplete factors carry them.
const STIFF: f64 = 0.015;

impl Choice {
    /// For a [`weight_of_the_diagonal`].
    pub fn by_weight(weight: f64) -> Self {
        if weight > LIGHT {
            Self::BlockJacobi
        } else if weight > STIFF {
            Self::IncompleteCholesky
        } else {
            Self::RigidModes
        }
    }
}

/// Rows looked at, spread evenly over the matrix.
const SAMPLES: usize = 1024;

/// How much of the diagonal resists even a translation of the whole: the median over a sample of rows of
/// `1 · Σ_c A_rc 1 / tr A_rr` with `1 = (1, 1, 1)`. For the matrix `M/h² + K` of a step it is the part of
/// inertia, 0 in statics. Rows that are coupled to nothing (pinned ones) do not count; 1 where none is coupled.
/// `per_row` is scratch.
pub fn weight_of_the_diagonal(matrix: &BlockMatrix, per_row: &mut Vec<f64>) -> f64 {
    let pattern = matrix.pattern();
    let ones = Vec3::new(1.0, 1.0, 1.0);
    let weight = |row: usize| {
        let (mut sum, mut coupling) = (Vec3::ZERO, 0.0);
        let diagonal = pattern.diagonal_slot(row);
        for slot in pattern.slots(row) {
            let along = matrix.values()[slot] * ones;
            sum += along;
            if slot != diagonal {
                coupling += along.length_sq();
            }
        }
        let trace = matrix.values()[diagonal].trace();
        (coupling > 0.0 && trace > 0.0).then(|| ones.dot(sum) / trace)
    };
    per_row.clear();
    let stride = pattern.block_count().div_ceil(SAMPLES).max(1);
    per_row.extend((0..pattern.block_count()).step_by(stride).filter_map(weight));
    let middle = per_row.len() / 2;
    if per_row.is_empty() { 1.0 } else { *per_row.select_nth_unstable_by(middle, f64::total_cmp).1 }
}

/// See the head of this file.
pub struct Automatic {
    pattern: Arc<Pattern>,
    coordinates: Option<Vec<Vec3>>,
    roles: Option<Vec<BlockRole>>,
    /// By [`Choice`]; made when first chosen.
    made: [Option<Box<dyn Preconditioner>>; 3],
    choice: Choice,
    per_row: Vec<f64>,
    /// Where blocks are now, if that was said after their places in `coordinates`.
    followed: Option<Vec<Vec3>>,
}

impl Automatic {
    /// # Errors
    /// The coordinates do not fit, or the matrix is not positive definite to the one chosen.
    pub fn new(matrix: &BlockMatrix, geometry: Geometry<'_>) -> Result<Self, SolveError> {
        geometry.check(matrix.pattern().block_count())?;
        let mut automatic = Self {
            pattern: Arc::clone(matrix.pattern()),
            coordinates: geometry.coordinates.map(<[Vec3]>::to_vec),
            roles: geometry.roles.map(<[BlockRole]>::to_vec),
            made: [None, None, None],
            choice: Choice::BlockJacobi,
            per_row: Vec::new(),
            followed: None,
        };
        automatic.update(matrix)?;
        Ok(automatic)
    }

    /// What serves the last matrix.
    pub fn choice(&self) -> Choice {
        self.choice
    }

    fn take(&mut self, choice: Choice, matrix: &BlockMatrix) -> Result<(), SolveError> {
        self.choice = choice;
        let Self { made, coordinates, roles, followed, .. } = self;
        let made = &mut made[choice as usize];
        let geometry = Geometry { coordinates: coordinates.as_deref(), roles: roles.as_deref() };
        let preconditioner = match made {
            Some(preconditioner) => preconditioner,
            None => made.insert(match (choice, geometry.coordinates) {
                (Choice::BlockJacobi, _) => Box::new(BlockJacobi::new(matrix)?),
                (Choice::IncompleteCholesky, Some(places)) => {
                    Box::new(IncompleteCholesky::with_coordinates(matrix, places)?)
                }
                (Choice::IncompleteCholesky, None) => Box::new(IncompleteCholesky::new(matrix)?),
                (Choice::RigidModes, _) => {
                    Box::new(RigidModes::new(matrix, geometry, RigidModesSettings::default())?)
                }
            }),
        };
        if let Some(places) = followed {
            preconditioner.follow(places)?;
        }
        preconditioner.update(matrix)
    }
}

impl Preconditioner for Automatic {
    fn update(&mut self, matrix: &BlockMatrix) -> Result<(), SolveError> {
        check_pattern(&self.pattern, matrix.pattern())?;
        let choice = Choice::by_weight(weight_of_the_diagonal(matrix, &mut self.per_row));
        match self.take(choice, matrix) {
            // the coarse space of an indefinite matrix may have no factor where a shifted incomplete one exists
            Err(SolveError::NotPositiveDefinite { .. }) if choice == Choice::RigidModes => {
                self.take(Choice::IncompleteCholesky, matrix)
            }
            taken => taken,
        }
    }

    fn follow(&mut self, coordinates: &[Vec3]) -> Result<(), SolveError> {
        Geometry::points(coordinates).check(self.pattern.block_count())?;
        let places = self.followed.get_or_insert_default();
        places.clear();
        places.extend_from_slice(coordinates);
        Ok(())
    }

    fn apply(&self, r: &[Vec3], z: &mut [Vec3]) {
        match &self.made[self.choice as usize] {
            Some(preconditioner) => preconditioner.apply(r, z),
            // after a failed update
            None => z.copy_from_slice(r),
        }
    }

    fn apply_dot(&self, r: &[Vec3], z: &mut [Vec3]) -> f64 {
        match &self.made[self.choice as usize] {
            Some(preconditioner) => preconditioner.apply_dot(r, z),
            None => {
                z.copy_from_slice(r);
                reduce::dot(r, z)
            }
        }
    }

    fn bytes(&self) -> usize {
        let places = [&self.coordinates, &self.followed].into_iter().flatten().map(Vec::capacity);
        let made: usize = self.made.iter().flatten().map(|preconditioner| preconditioner.bytes()).sum();
        made + size_of::<Vec3>() * places.sum::<usize>() + 8 * self.per_row.capacity()
    }
}
