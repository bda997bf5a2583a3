//! Work that ends cleanly at Ctrl-C.

use std::sync::{LazyLock, OnceLock};
use std::time::{Duration, Instant};

use souple_engine::Interruption;

/// Wished by the first Ctrl-C, or by the system's wish that the program ends (SIGTERM), once [`heed`] was called.
static INTERRUPTION: LazyLock<Interruption> = LazyLock::new(Interruption::default);

/// A second wish is a second one where it comes so much later: a wrapper may hand one on that the whole group of processes has had.
const ANOTHER: Duration = Duration::from_millis(500);

/// From here on Ctrl-C asks for an end instead of making one: of steps too, that heed what is returned. A second one makes it.
pub fn heed() -> Interruption {
    // a second handler in one process would be refused: the first one does the same
    let _ = ctrlc::set_handler(|| {
        // of signals alone: a sweep wishes for an end of its own where a run cannot be stored
        static FIRST: OnceLock<Instant> = OnceLock::new();
        // what heeds nothing, as a scene of a sweep that is being made, ends at the second
        if FIRST.get().is_some_and(|first| first.elapsed() > ANOTHER) {
            std::process::exit(i32::from(super::INTERRUPTED));
        }
        FIRST.get_or_init(Instant::now);
        INTERRUPTION.wish();
    });
    INTERRUPTION.clone()
}

pub fn is_interrupted() -> bool {
    INTERRUPTION.is_wished()
}
