//! The thread that makes pictures, beside that of the world: what is read of the world between two steps becomes bytes for pages while the
//! next step goes on.

use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::Instant;

use super::sketch::Sketch;
use crate::hub::Hub;

/// Makes one picture after the other, and shows each to all pages.
pub struct Painter {
    easel: Arc<Easel>,
    thread: Option<JoinHandle<()>>,
}

/// What the two threads share.
#[derive(Default)]
struct Easel {
    waiting: Mutex<Waiting>,
    changed: Condvar,
}

#[derive(Default)]
struct Waiting {
    sketch: Option<Sketch>,
    is_over: bool,
}

impl Easel {
    fn lock(&self) -> MutexGuard<'_, Waiting> {
        // nothing is left half done under this lock
        self.waiting.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The next sketch; `None` when there are to be no more.
    fn take(&self) -> Option<Sketch> {
        let mut waiting = self.lock();
        loop {
            if waiting.is_over {
                return None;
            }
            if let Some(sketch) = waiting.sketch.take() {
                return Some(sketch);
            }
            waiting = self.changed.wait(waiting).unwrap_or_else(PoisonError::into_inner);
        }
    }
}

impl Painter {
    /// # Errors
    /// The system gives no thread.
    pub fn start(hub: Arc<Hub>) -> std::io::Result<Self> {
        let easel = Arc::<Easel>::default();
        let of_thread = Arc::clone(&easel);
        let thread = std::thread::Builder::new().name("painter".to_owned()).spawn(move || {
            while let Some(sketch) = of_thread.take() {
                let began = Instant::now();
                let picture = sketch.paint();
                hub.timeline().note("picture", began);
                hub.show(&picture.into());
            }
        })?;
        Ok(Self { easel, thread: Some(thread) })
    }

    /// Whether the sketch that it was given last has not been begun: another would take its place.
    pub fn is_behind(&self) -> bool {
        self.easel.lock().sketch.is_some()
    }

    /// Has a picture made; one that was not begun gives way to it.
    pub fn paint(&self, sketch: Sketch) {
        self.easel.lock().sketch = Some(sketch);
        self.easel.changed.notify_one();
    }
}

impl Drop for Painter {
    fn drop(&mut self) {
        self.easel.lock().is_over = true;
        self.easel.changed.notify_one();
        if let Some(thread) = self.thread.take() {
            // whoever drops it asks for no account
            let _ = thread.join();
        }
    }
}
