//! The preconditioners by name.

use souple_table::{Entry, Parameter, Range, Table, Value, Values};

use super::{
    Automatic, BlockJacobi, Geometry, Identity, IncompleteCholesky, LaggedFactor, Preconditioner, RigidModes,
    RigidModesSettings, Smoother,
};
use crate::{BlockMatrix, SolveError};

/// Builds a preconditioner from completed values, for a matrix and the places of its blocks.
pub type Build = fn(&Values, &BlockMatrix, Geometry<'_>) -> Result<Box<dyn Preconditioner>, SolveError>;

/// All preconditioners.
pub static TABLE: Table<Build> = Table {
    kind: "preconditioner",
    entries: &[&AUTO, &NONE, &BLOCK_JACOBI, &INCOMPLETE_CHOLESKY, &RIGID_MODES, &LAGGED_FACTOR],
};

static AUTO: Entry<Build> = Entry {
    name: "auto",
    summary: "block_jacobi, incomplete_cholesky or rigid_modes, by how much inertia outweighs stiffness",
    source: "measured on bars from soft to stiff (examples/beam.rs)",
    parameters: &[],
    build: |_, matrix, geometry| Ok(Box::new(Automatic::new(matrix, geometry)?)),
};

static NONE: Entry<Build> = Entry {
    name: "none",
    summary: "the residual itself; for comparison",
    source: "Hestenes & Stiefel 1952",
    parameters: &[],
    build: |_, _, _| Ok(Box::new(Identity)),
};

static BLOCK_JACOBI: Entry<Build> = Entry {
    name: "block_jacobi",
    summary: "inverse of the diagonal blocks; nearly free, for stiffness that mass outweighs",
    source: "Saad 2003, §10.2",
    parameters: &[],
    build: |_, matrix, _| Ok(Box::new(BlockJacobi::new(matrix)?)),
};

static INCOMPLETE_CHOLESKY: Entry<Build> = Entry {
    name: "incomplete_cholesky",
    summary: "triangular factors without fill, by 3x3 blocks; three times fewer iterations than block_jacobi",
    source: "Meijerink & van der Vorst 1977; shift: Manteuffel 1980",
    parameters: &[],
    build: |_, matrix, geometry| {
        Ok(Box::new(match geometry.coordinates {
            Some(coordinates) => IncompleteCholesky::with_coordinates(matrix, coordinates)?,
            None => IncompleteCholesky::new(matrix)?,
        }))
    },
};

static RIGID_MODES: Entry<Build> = Entry {
    name: "rigid_modes",
    summary: "rigid motions of patches solved exactly, the rest smoothed; iterations hardly grow with the mesh",
    source: "Mandel 1993; Tang, Nabben, Vuik & Erlangga 2009 (balancing)",
    parameters: &[
        Parameter::choice("smoother", &["incomplete_cholesky", "block_jacobi"], "what acts within patches")
            .or(Value::Text("incomplete_cholesky")),
        Parameter::integer(
            "patch_size",
            Range::NOT_NEGATIVE,
            "blocks per patch at most; 0: by the size of the system",
        )
        .or(Value::Integer(0)),
    ],
    build: |values, matrix, geometry| {
        let smoother = match values.text("smoother") {
            "block_jacobi" => Smoother::BlockJacobi,
            _ => Smoother::IncompleteCholesky,
        };
        let patch_size = usize::try_from(values.integer("patch_size")).ok().filter(|&size| size > 0);
        Ok(Box::new(RigidModes::new(matrix, geometry, RigidModesSettings { smoother, patch_size })?))
    },
};

static LAGGED_FACTOR: Entry<Build> = Entry {
    name: "lagged_factor",
    summary: "direct factor of an earlier matrix; for small or slowly changing systems",
    source: "Davis 2006, §4 (the factor)",
    parameters: &[Parameter::integer("period", Range::at_least(1.0), "updates served by one factor")
        .or(Value::Integer(10))],
    build: |values, matrix, geometry| {
        let period = usize::try_from(values.integer("period")).unwrap_or(1);
        Ok(Box::new(LaggedFactor::new(matrix, geometry.coordinates, period)?))
    },
};
