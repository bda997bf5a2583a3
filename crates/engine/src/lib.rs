//! State, model, forces, steppers and systems: one step of the world.
