//! Buffers of calls on `&self`.

use std::sync::{Mutex, PoisonError};

/// A buffer that calls lend each other. It is taken out while it is used: a lock that is held while threads share work waits for itself
/// where one of them is given another call meanwhile, as rayon gives work to whoever waits.
#[derive(Debug)]
pub struct Spare<T>(Mutex<T>);

impl<T: Default> Spare<T> {
    pub fn new(buffer: T) -> Self {
        Self(Mutex::new(buffer))
    }

    /// Runs `work` with the buffer, or with one that is empty where another call has it.
    pub fn lend<R>(&self, work: impl FnOnce(&mut T) -> R) -> R {
        let mut buffer = std::mem::take(&mut *self.0.lock().unwrap_or_else(PoisonError::into_inner));
        let result = work(&mut buffer);
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = buffer;
        result
    }
}
