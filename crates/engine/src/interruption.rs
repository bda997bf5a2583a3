//! Steps that are broken off from outside: by who ends the program, or shows another scene.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use crate::steppers::StepError;

/// Wishes that the step that goes on ends without a result, as many as are not taken back; clones share them. A world heeds
/// them by [`crate::World::heed`].
#[derive(Clone, Debug, Default)]
pub struct Interruption(Arc<AtomicUsize>);

impl Interruption {
    /// Until this wish is taken back every step ends as soon as it can.
    pub fn wish(&self) {
        self.0.fetch_add(1, Ordering::Relaxed);
    }

    /// Takes one wish back.
    pub fn withdraw(&self) {
        // one that was never made is none
        let _ = self.0.fetch_update(Ordering::Relaxed, Ordering::Relaxed, |wishes| wishes.checked_sub(1));
    }

    pub fn is_wished(&self) -> bool {
        self.0.load(Ordering::Relaxed) > 0
    }

    /// Goes on with a step, between parts of it that may last.
    ///
    /// # Errors
    /// [`StepError::Interrupted`] while it is wished.
    pub fn check(&self) -> Result<(), StepError> {
        if self.is_wished() { Err(StepError::Interrupted) } else { Ok(()) }
    }
}
