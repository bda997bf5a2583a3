//! A skin as a field of the engine's world.

use std::sync::Arc;

use souple_engine::{CommittedRows, Field, FieldState, FieldStep, Scratch, StepError};
use souple_math::Vec3;

use crate::error::SkinError;
use crate::grid::{Grid, NEAR, WORDS};
use crate::skin::{HEAD_INDICES, Skin, SkinScratch};
use crate::target::{Moment, Rows};

impl Rows for CommittedRows<'_> {
    fn positions(&self, system: usize) -> &[Vec3] {
        &self.of(system).positions
    }

    fn active(&self, system: usize, force: usize) -> &[u32] {
        CommittedRows::active(self, system, force).unwrap_or_default()
    }
}

/// A skin in a world, which those who read its state share.
pub struct SkinField(pub Arc<Skin>);

impl Field for SkinField {
    fn name(&self) -> &str {
        &self.0.name
    }

    fn kind(&self) -> &'static str {
        "skin"
    }

    /// Its blocks come and go: a state fits when its keys ascend and each has its values, within the band.
    fn accepts(&self, field: &FieldState, _: &FieldState) -> bool {
        let Some(words) = field.indices.get(HEAD_INDICES..) else { return false };
        let grid = Grid::of_words(words);
        field.values.len() == self.0.head()
            && words.len() == (1 + WORDS) * grid.keys.len()
            && grid.keys.is_sorted_by(|a, b| a < b)
            && grid.values.iter().all(|value| value.abs() <= NEAR)
    }

    fn new_scratch(&self) -> Scratch {
        Box::new(self.0.new_scratch())
    }

    fn step(
        &self,
        rows: CommittedRows,
        &FieldStep { start, timestep, interruption }: &FieldStep,
        field: &mut FieldState,
        scratch: &mut Scratch,
    ) -> Result<(), StepError> {
        let Some(scratch) = scratch.downcast_mut::<SkinScratch>() else {
            return Err(StepError::Field("its scratch is of another field".to_owned()));
        };
        let end = Moment { time: start + timestep, rows: &rows };
        self.0.step_heeding(interruption, &end, timestep, field, scratch).map_err(|error| match error {
            SkinError::Interrupted => StepError::Interrupted,
            error => StepError::Field(error.to_string()),
        })
    }

    fn bytes(&self, scratch: &Scratch) -> usize {
        scratch.downcast_ref::<SkinScratch>().map_or(0, SkinScratch::bytes)
    }
}
