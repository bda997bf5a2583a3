//! Scene files: text to specification to model and state.
