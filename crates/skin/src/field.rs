//! A skin as a field of the engine's world.

use souple_engine::{CommittedRows, Field, FieldState, Scratch};

use crate::grid::{BAND, NODES};
use crate::skin::{HEAD_INDICES, Skin, SkinScratch};
use crate::target::Moment;

impl Field for Skin {
    fn name(&self) -> &str {
        &self.name
    }

    /// Its blocks come and go: a state fits when its keys ascend and each has its values, within the band.
    fn accepts(&self, field: &FieldState, _: &FieldState) -> bool {
        let head = self.head();
        let Some(blocks) = field.indices.len().checked_sub(HEAD_INDICES) else { return false };
        let Some(values) = field.values.get(head..) else { return false };
        values.len() == NODES * blocks
            && field.indices[HEAD_INDICES..].is_sorted_by(|a, b| a < b)
            && values.iter().all(|value| value.abs() <= BAND)
    }

    fn new_scratch(&self) -> Scratch {
        Box::new(Skin::new_scratch(self))
    }

    fn step(
        &self,
        rows: CommittedRows,
        start: f64,
        timestep: f64,
        field: &mut FieldState,
        scratch: &mut Scratch,
    ) -> Result<(), String> {
        let positions = |system: usize| rows.of(system).positions.as_slice();
        let end = Moment { time: start + timestep, positions: &positions };
        let Some(scratch) = scratch.downcast_mut::<SkinScratch>() else {
            return Err("its scratch is of another field".to_owned());
        };
        Skin::step(self, &end, timestep, field, scratch).map_err(|error| error.to_string())
    }

    fn bytes(&self, scratch: &Scratch) -> usize {
        scratch.downcast_ref::<SkinScratch>().map_or(0, SkinScratch::bytes)
    }
}
