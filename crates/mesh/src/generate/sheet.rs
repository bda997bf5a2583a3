//! Sheets of triangles and quadrilaterals, lines of edges: plane bodies, membranes, bars and cables.

use std::collections::BTreeMap;

use souple_math::Vec3;
use souple_table::{Parameter, Range, Value, Values};

use super::cut::{in_order, last_place, middle};
use super::disorder::Disorder;
use super::{Build, GeneratorEntry};
use crate::{CellBlock, ElementKind, Group, MAX_CELLS, Mesh, MeshError, MeshSize, NodePlace};

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
            &["tri3", "tri6", "quad4", "quad8", "quad9", "mixed", "mixed_quadratic"],
            "kind of cells; rectangles are cut in two triangles, diagonals in a pattern of diamonds; of `mixed` those of the second half along x",
        )
        .or(Value::Text("tri3")),
        Parameter::vector("origin", "m", "the corner of least x, y").or(Value::Vector([0.0; 3])),
        Disorder::PARAMETER,
        Disorder::SEED,
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

/// Rectangles along and across, and the first column of those that are cut in two.
struct Pattern {
    along: u64,
    across: u64,
    first_cut: u64,
}

impl Pattern {
    fn of(values: &Values) -> Result<Self, MeshError> {
        let [along, across] = ["cells_along", "cells_across"].map(|name| values.integer(name));
        limited(along as f64 * across as f64 * 2.0)?;
        let (along, across) = (along as u64, across as u64);
        let first_cut = match ElementKind::from_name(values.text("element")).map(ElementKind::corners) {
            Ok(ElementKind::Tri3) => 0,
            Ok(_) => along,
            Err(_) => along.div_ceil(2),
        };
        Ok(Self { along, across, first_cut })
    }

    fn cut_count(&self) -> u64 {
        (self.along - self.first_cut) * self.across
    }
}

fn sheet_size(values: &Values) -> Result<MeshSize, MeshError> {
    let pattern = Pattern::of(values)?;
    let (nx, ny, cut) = (pattern.along, pattern.across, pattern.cut_count());
    let corners = (nx + 1) * (ny + 1);
    let of_edges = nx * (ny + 1) + ny * (nx + 1) + cut;
    let middles = match last_place(values) {
        NodePlace::Corner => 0,
        NodePlace::Edge => of_edges,
        // of quadrilaterals: triangles have none there
        _ => of_edges + pattern.first_cut * ny,
    };
    Ok(MeshSize { points: corners + middles, cells: nx * ny + cut })
}

fn sheet(values: &Values) -> Result<Mesh, MeshError> {
    let Pattern { along: nx, across: ny, first_cut } = Pattern::of(values)?;
    let (length, width) = (values.number("length"), values.number("width"));
    let origin = Vec3::from_array(values.vector("origin"));
    let mut disorder = Disorder::from_values(values);
    let mut points = Vec::with_capacity(((nx + 1) * (ny + 1)) as usize);
    for j in 0..=ny {
        for i in 0..=nx {
            let corner = Vec3::new(i as f64, j as f64, 0.0);
            let is_inside = (1..nx).contains(&i) && (1..ny).contains(&j);
            let moved = if is_inside { corner + disorder.next_in_plane() } else { corner };
            points
                .push(origin + Vec3::new(length * (moved.x / nx as f64), width * (moved.y / ny as f64), 0.0));
        }
    }
    let point = |i: u64, j: u64| (i + (nx + 1) * j) as u32;
    let (mut whole, mut cut) = (CellBlock::new(ElementKind::Quad4), CellBlock::new(ElementKind::Tri3));
    for j in 0..ny {
        for i in 0..nx {
            let [a, b, c, d] = [point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)];
            match (i < first_cut, (i + j) % 2) {
                (true, _) => whole.nodes.extend([a, b, c, d]),
                // the diagonals of neighbours meet: no direction is preferred
                (_, 0) => cut.nodes.extend([a, b, c, a, c, d]),
                _ => cut.nodes.extend([a, b, d, b, c, d]),
            }
        }
    }
    let blocks = [whole, cut].into_iter().filter(|block| !block.is_empty()).collect();
    let mut mesh = Mesh { points, blocks, ..Mesh::default() };
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
    let middles = if last_place(values) == NodePlace::Edge { cells } else { 0 };
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
