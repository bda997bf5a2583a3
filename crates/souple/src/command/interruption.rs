//! Work that ends cleanly at Ctrl-C.

use std::sync::LazyLock;

use souple_engine::Interruption;

/// Wished by the first Ctrl-C, or by the system's wish that the program ends (SIGTERM), once [`heed`] was called.
static INTERRUPTION: LazyLock<Interruption> = LazyLock::new(Interruption::default);

/// From here on Ctrl-C asks for an end instead of making one: of steps too, that heed what is returned. A second one makes it.
pub fn heed() -> Interruption {
    // a second handler in one process would be refused: the first one does the same
    let _ = ctrlc::set_handler(|| {
        // what heeds nothing, as a scene of a sweep that is being made, ends at the second wish
        if INTERRUPTION.is_wished() {
            std::process::exit(i32::from(super::INTERRUPTED));
        }
        INTERRUPTION.wish();
    });
    INTERRUPTION.clone()
}

pub fn is_interrupted() -> bool {
    INTERRUPTION.is_wished()
}
