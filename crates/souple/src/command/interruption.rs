//! Work that ends cleanly at Ctrl-C.

use std::sync::atomic::{AtomicBool, Ordering};

/// Set by the first Ctrl-C, or by the system's wish that the program ends (SIGTERM), once [`heed`] was called.
pub static INTERRUPTED: AtomicBool = AtomicBool::new(false);

/// From here on Ctrl-C asks for an end instead of making one.
pub fn heed() {
    // a second handler in one process would be refused: the first one does the same
    let _ = ctrlc::set_handler(|| INTERRUPTED.store(true, Ordering::Relaxed));
}

pub fn is_interrupted() -> bool {
    INTERRUPTED.load(Ordering::Relaxed)
}
