//! Sheets of triangles and quadrilaterals, lines of edges: plane bodies, membranes, bars and cables.

use std::collections::BTreeMap;

use souple_math::Vec3;
use souple_table::{Parameter, Range, Value, Values};

use super::cut::{in_order, middle};
use super::{Build, GeneratorEntry};
use crate::{ElementKind, Group, MAX_CELLS, Mesh, MeshError, MeshSize};

pub(super) static SHEET: GeneratorEntry = GeneratorEntry {
    name: "sheet",
    summary: "rectangle in a plane of constant z; groups x_min, x_max, y_min, y_max",
    source: "own",
    parameters: &[
        Parameter::number("length", "m", Range::POSITIVE, "along x"),
        Parameter::number("width", "m", Range::POSITIVE, "along y"),
        Parameter::integer("cells_along", Range::at_least(1.0), "number of cells along x"),
        Parameter::integer("cells_across", Range::at_least(1.0), "number of cells along y"),
        Parameter::choice(
            "element",
            &["tri3", "tri6", "quad4", "quad8"],
            "kind of cells; each rectangle is cut in two triangles, diagonals in a pattern of diamonds",
        )
        .or(Value::Text("tri3")),
        Parameter::vector("origin", "m", "the corner of least x, y").or(Value::Vector([0.0; 3])),
    ],
    build: Build { size: sheet_size, mesh: sheet },
};

pub(super) static LINE: GeneratorEntry = GeneratorEntry {
    name: "line",
    summary: "straight chain of edges; groups `start`, `end`",
    source: "own",
    parameters: &[
        Parameter::vector("from", "m", "where it starts"),
        Parameter::vector("to", "m", "where it ends"),
        Parameter::integer("cells", Range::at_least(1.0), "number of edges"),
        Parameter::choice("element", &["edge2", "edge3"], "kind of cells").or(Value::Text("edge2")),
    ],
    build: Build { size: line_size, mesh: line },
};

fn limited(requested: f64) -> Result<(), MeshError> {
    if requested > MAX_CELLS as f64 {
        return Err(MeshError::TooManyCells { requested, limit: MAX_CELLS });
    }
    Ok(())
}

/// Cells along and across, and how many each rectangle is cut into.
fn counts(values: &Values) -> Result<([u64; 2], u64), MeshError> {
    let cells = ["cells_along", "cells_across"].map(|name| values.integer(name));
    let per_rectangle = if values.text("element").starts_with("tri") { 2 } else { 1 };
    limited(cells[0] as f64 * cells[1] as f64 * per_rectangle as f64)?;
    Ok((cells.map(|count| count as u64), per_rectangle))
}

fn sheet_size(values: &Values) -> Result<MeshSize, MeshError> {
    let ([nx, ny], per_rectangle) = counts(values)?;
    let corners = (nx + 1) * (ny + 1);
    let diagonals = if per_rectangle == 2 { nx * ny } else { 0 };
    let middles = match values.text("element") {
        "tri6" | "quad8" => nx * (ny + 1) + ny * (nx + 1) + diagonals,
        _ => 0,
    };
    Ok(MeshSize { points: corners + middles, cells: nx * ny * per_rectangle })
}

fn sheet(values: &Values) -> Result<Mesh, MeshError> {
    let ([nx, ny], per_rectangle) = counts(values)?;
    let (length, width) = (values.number("length"), values.number("width"));
    let origin = Vec3::from_array(values.vector("origin"));
    let mut points = Vec::with_capacity(((nx + 1) * (ny + 1)) as usize);
    for j in 0..=ny {
        for i in 0..=nx {
            let (x, y) = (i as f64 / nx as f64, j as f64 / ny as f64);
            points.push(origin + Vec3::new(length * x, width * y, 0.0));
        }
    }
    let point = |i: u64, j: u64| (i + (nx + 1) * j) as u32;
    let mut nodes = Vec::new();
    for j in 0..ny {
        for i in 0..nx {
            let [a, b, c, d] = [point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)];
            match (per_rectangle, (i + j) % 2) {
                (1, _) => nodes.extend([a, b, c, d]),
                // the diagonals of neighbours meet: no direction is preferred
                (_, 0) => nodes.extend([a, b, c, a, c, d]),
                _ => nodes.extend([a, b, d, b, c, d]),
            }
        }
    }
    let kind = if per_rectangle == 2 { ElementKind::Tri3 } else { ElementKind::Quad4 };
    let mut mesh = Mesh::new(points, kind, nodes);
    let group = |points: Vec<u32>| Group { points, ..Group::default() };
    mesh.groups = BTreeMap::from([
        ("x_min".to_owned(), group((0..=ny).map(|j| point(0, j)).collect())),
        ("x_max".to_owned(), group((0..=ny).map(|j| point(nx, j)).collect())),
        ("y_min".to_owned(), group((0..=nx).map(|i| point(i, 0)).collect())),
        ("y_max".to_owned(), group((0..=nx).map(|i| point(i, ny)).collect())),
    ]);
    Ok(in_order(values, mesh, middle))
}

fn line_size(values: &Values) -> Result<MeshSize, MeshError> {
    let cells = values.integer("cells") as u64;
    limited(cells as f64)?;
    let middles = if values.text("element") == "edge3" { cells } else { 0 };
    Ok(MeshSize { points: cells + 1 + middles, cells })
}

fn line(values: &Values) -> Result<Mesh, MeshError> {
    let cells = line_size(values)?.cells as u32;
    let [from, to] = ["from", "to"].map(|name| Vec3::from_array(values.vector(name)));
    let place = |i: u32| {
        let share = f64::from(i) / f64::from(cells);
        from * (1.0 - share) + to * share
    };
    let nodes = (0..cells).flat_map(|i| [i, i + 1]).collect();
    let mut mesh = Mesh::new((0..=cells).map(place).collect(), ElementKind::Edge2, nodes);
    for (name, point) in [("start", 0), ("end", cells)] {
        mesh.groups.insert(name.to_owned(), Group { points: vec![point], ..Group::default() });
    }
    Ok(in_order(values, mesh, middle))
}
