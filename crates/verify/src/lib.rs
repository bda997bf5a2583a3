//! Validation cases, benchmarks and the battery over all tables.
