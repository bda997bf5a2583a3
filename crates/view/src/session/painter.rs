//! The thread that makes pictures, beside that of the world: what is read of the world between two steps becomes bytes for pages while the
//! next step goes on.

use std::panic::{AssertUnwindSafe, catch_unwind};
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
    /// A picture could not be made, and nobody has heard of it.
    has_failed: bool,
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
        Self::who_makes(Sketch::paint, hub)
    }

    fn who_makes(paint: impl Fn(Sketch) -> Vec<u8> + Send + 'static, hub: Arc<Hub>) -> std::io::Result<Self> {
        let easel = Arc::<Easel>::default();
        let of_thread = Arc::clone(&easel);
        let thread = std::thread::Builder::new().name("painter".to_owned()).spawn(move || {
            while let Some(sketch) = of_thread.take() {
                let began = Instant::now();
                // whatever becomes of it, the next one is made, and the world hears of it
                match catch_unwind(AssertUnwindSafe(|| paint(sketch))) {
                    Ok(picture) => {
                        hub.timeline().note("picture", began);
                        hub.show(&picture.into());
                    }
                    Err(_) => of_thread.lock().has_failed = true,
                }
            }
        })?;
        Ok(Self { easel, thread: Some(thread) })
    }

    /// Whether the sketch that it was given last has not been begun: another would take its place.
    pub fn is_behind(&self) -> bool {
        self.easel.lock().sketch.is_some()
    }

    /// Whether a picture could not be made, by a fault of the program; told once.
    pub fn take_fault(&self) -> bool {
        std::mem::take(&mut self.easel.lock().has_failed)
    }

    /// Has a picture made.
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

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;
    use crate::hub::{Next, Outgoing};

    fn sketch(number: u32) -> Sketch {
        Sketch {
            scene: 0,
            number,
            period: 0,
            time: 0.0,
            real_time_factor: 0.0,
            stages: [0.0; 5],
            iterations: [0.0; 2],
            hands: Vec::new(),
            poses: Vec::new(),
            bodies: Vec::new(),
            skins: Vec::new(),
            contours: Vec::new(),
        }
    }

    /// A picture that cannot be made is told of once, and the next one is made.
    #[test]
    fn a_fault_ends_no_pictures() {
        let hub = Arc::<Hub>::default();
        let (page, outbox) = hub.join();
        hub.welcome(page);
        let paint = |sketch: Sketch| {
            assert!(sketch.number > 0, "the fault that is meant");
            sketch.paint()
        };
        let painter = Painter::who_makes(paint, Arc::clone(&hub)).expect("a thread");
        assert!(!painter.take_fault());
        let clock = Instant::now();
        painter.paint(sketch(0));
        while !painter.take_fault() {
            assert!(clock.elapsed() < Duration::from_secs(30));
            std::thread::yield_now();
        }
        painter.paint(sketch(1));
        let next = outbox.next(&hub, Duration::from_secs(30));
        assert!(matches!(next, Next::Send(Outgoing::Binary(_))));
        assert!(!painter.take_fault());
    }
}
