//! Trying a law before it is used: at rest, under rotations, and where it is legal but doubtful.

#![allow(non_snake_case)]

mod doubts;
mod rest;
mod rotations;

use souple_math::{Mat3, Vec3};

use super::read::Read;
use super::{EnergyLaw, LawError, LawProblem};
use crate::graph::Expr;

pub(super) fn check(law: &mut EnergyLaw, read: &Read) -> Result<(), LawError> {
    let depends = |exprs: &[Expr]| {
        let depends = law.graph.depends(exprs, &[law.deformation]);
        exprs.iter().any(|expr| depends[expr.index()])
    };
    if depends(&[law.energy]) {
        rest::value(law, read)?;
        rest::resistance(law, read)?;
        rest::slope(law, read)?;
        rest::values_where_turned(law, read)?;
        rotations::order_of_stretches(law, read)?;
        rotations::objectivity(law, read)?;
        law.warnings.extend(doubts::doubts(law));
        return Ok(());
    }
    let written: Vec<Expr> = read.origins.keys().copied().collect();
    Err(if depends(&written) { rest::no_stress(law, read) } else { whole(LawProblem::NoDeformation) })
}

fn whole(problem: LawProblem) -> LawError {
    LawError::new("energy", None, problem)
}

/// The problem at the place where `expr`, or the first thing around it, is written.
fn at(read: &Read, expr: Expr, problem: LawProblem) -> LawError {
    match read.origins.get(&expr) {
        Some((part, span)) => LawError::new(part.clone(), Some(*span), problem),
        None => whole(problem),
    }
}

/// Derivatives that became too long, told where most parts stand in one sum or product.
pub(super) fn too_long(read: &Read) -> LawError {
    let parts = |expr: &Expr| read.graph.node(*expr).operands().count();
    let written =
        read.graph.reachable(&[read.energy]).into_iter().filter(|expr| read.origins.contains_key(expr));
    let longest = written.max_by_key(parts).unwrap_or(read.energy);
    let problem = LawProblem::LongDerivatives { parts: parts(&longest), limit: super::LARGEST_DERIVATIVES };
    at(read, longest, problem)
}

fn identity() -> Mat3 {
    Mat3::identity(1.0)
}

/// Nothing but one entry, by columns, which is 1.
fn unit(entry: usize) -> Mat3 {
    let mut columns = [[0.0; 3]; 3];
    columns[entry / 3][entry % 3] = 1.0;
    let [a, b, c] = columns.map(Vec3::from_array);
    Mat3::from_columns(a, b, c)
}

/// Deformations of all kinds, the same in every run.
fn directions() -> Vec<Mat3> {
    let rows = [
        [0.3, -0.1, 0.2, 0.15, -0.25, 0.05, -0.2, 0.1, 0.35],
        [-0.3, 0.2, 0.1, -0.05, 0.15, 0.3, 0.25, -0.15, -0.1],
        [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [0.6, 0.0, 0.0, 0.0, 0.6, 0.0, 0.0, 0.0, 0.6],
    ];
    rows.iter()
        .map(|row| {
            let column = |i: usize| Vec3::new(row[3 * i], row[3 * i + 1], row[3 * i + 2]);
            Mat3::from_columns(column(0), column(1), column(2))
        })
        .collect()
}

/// Moderate deformations that change their volume and keep it positive: a law that changes where the volume is that of rest would
/// else change by rounding.
fn deformations() -> Vec<Mat3> {
    let of = |d: Mat3| [(identity() + d * 0.2) * 1.03, (identity() + d * -0.15) * 0.98];
    directions().into_iter().flat_map(of).collect()
}
