//! Steps that are broken off from outside: by who ends the program, or shows another scene.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::steppers::StepError;

/// A wish that the step that goes on ends without a result; clones share it. A world heeds one by
/// [`crate::World::heed`].
#[derive(Clone, Debug, Default)]
pub struct Interruption(Arc<AtomicBool>);

impl Interruption {
    /// From now on every step ends as soon as it can.
    pub fn wish(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// From now on steps go on.
    pub fn withdraw(&self) {
        self.0.store(false, Ordering::Relaxed);
    }

    pub fn is_wished(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }

    /// Goes on with a step, between parts of it that may last.
    ///
    /// # Errors
    /// [`StepError::Interrupted`] while it is wished.
    pub fn check(&self) -> Result<(), StepError> {
        if self.is_wished() { Err(StepError::Interrupted) } else { Ok(()) }
    }
}
