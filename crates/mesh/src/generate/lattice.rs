//! Equilateral triangles in rows, on which differences are the same in all directions; with disorder, how wrong they are elsewhere.

use std::collections::BTreeMap;

use souple_math::Vec3;
use souple_table::{Parameter, Range, Value, Values};

use super::disorder::Disorder;
use super::{Build, GeneratorEntry};
use crate::{CellBlock, ElementKind, Group, MAX_CELLS, Mesh, MeshError, MeshSize};

pub(super) static LATTICE: GeneratorEntry = GeneratorEntry {
    name: "lattice",
    summary: "equilateral triangles in a plane of constant z, every second row half an edge further; groups border, y_min, y_max",
    source: "Debunne 2000, 4 §2.6",
    parameters: &[
        Parameter::number("edge", "m", Range::POSITIVE, "of the triangles"),
        Parameter::integer("cells_along", Range::at_least(1.0), "number of edges along x"),
        Parameter::integer("rows", Range::at_least(1.0), "number of rows of triangles along y"),
        Disorder::OF_TRIANGLES,
        Disorder::SEED,
        Parameter::vector("origin", "m", "the first point of the lowest row").or(Value::Vector([0.0; 3])),
    ],
    build: Build { size: lattice_size, mesh: lattice },
};

/// Edges along a row, and rows.
fn counts(values: &Values) -> Result<(u64, u64), MeshError> {
    let [along, rows] = ["cells_along", "rows"].map(|name| values.integer(name));
    let requested = 2.0 * along as f64 * rows as f64;
    if requested > MAX_CELLS as f64 {
        return Err(MeshError::TooManyCells { requested, limit: MAX_CELLS });
    }
    Ok((along as u64, rows as u64))
}

fn lattice_size(values: &Values) -> Result<MeshSize, MeshError> {
    let (along, rows) = counts(values)?;
    Ok(MeshSize { points: (along + 1) * (rows + 1), cells: 2 * along * rows })
}

fn lattice(values: &Values) -> Result<Mesh, MeshError> {
    let (along, rows) = counts(values)?;
    let (edge, origin) = (values.number("edge"), Vec3::from_array(values.vector("origin")));
    let height = 0.75_f64.sqrt();
    let point = |i: u64, j: u64| (i + (along + 1) * j) as u32;
    let is_border = |i: u64, j: u64| i == 0 || j == 0 || i == along || j == rows;
    let mut disorder = Disorder::from_values(values);
    let mut points = Vec::with_capacity(((along + 1) * (rows + 1)) as usize);
    let mut border = Group::default();
    for j in 0..=rows {
        for i in 0..=along {
            let place = Vec3::new(i as f64 + 0.5 * (j % 2) as f64, height * j as f64, 0.0);
            let moved = if is_border(i, j) {
                border.points.push(point(i, j));
                place
            } else {
                place + disorder.next_in_plane()
            };
            points.push(origin + moved * edge);
        }
    }
    let mut cells = CellBlock::new(ElementKind::Tri3);
    for j in 0..rows {
        for i in 0..along {
            let [a, b, c, d] = [point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)];
            // the upper row is half an edge further, or half an edge behind
            let halves = if j % 2 == 0 { [a, b, d, b, c, d] } else { [a, b, c, a, c, d] };
            cells.nodes.extend(halves);
        }
    }
    let row = |j: u64| Group { points: (0..=along).map(|i| point(i, j)).collect(), ..Group::default() };
    let groups = BTreeMap::from([
        ("border".to_owned(), border),
        ("y_min".to_owned(), row(0)),
        ("y_max".to_owned(), row(rows)),
    ]);
    Ok(Mesh { points, blocks: vec![cells], facet_blocks: Vec::new(), groups })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn made(disorder: f64, seed: i64) -> Mesh {
        let values = Values::new()
            .with("edge", Value::Number(0.1))
            .with("cells_along", Value::Integer(7))
            .with("rows", Value::Integer(6))
            .with("disorder", Value::Number(disorder))
            .with("seed", Value::Integer(seed));
        crate::generate("lattice", values).unwrap()
    }

    /// The cosines of all angles.
    fn cosines(mesh: &Mesh) -> Vec<f64> {
        let mut all = Vec::new();
        for cell in mesh.cells() {
            let at = |node: usize| mesh.points[cell.nodes[node % 3] as usize];
            for node in 0..3 {
                let (a, b) = (at(node + 1) - at(node), at(node + 2) - at(node));
                all.push(a.dot(b) / (a.length() * b.length()));
            }
        }
        all
    }

    /// All angles are of 60 degrees, and of less than 90 where points are moved by 0.12 of the edge; the border stays, and the area with it.
    #[test]
    fn triangles_are_equilateral_or_acute() {
        let regular = made(0.0, 1);
        // of coordinates of ten edges
        assert!(cosines(&regular).iter().all(|cosine| (cosine - 0.5).abs() < 1e-14));
        let area = 84.0 * 0.01 * 0.75_f64.sqrt() / 2.0;
        for seed in 0..20 {
            let moved = made(0.12, seed);
            assert!(cosines(&moved).iter().all(|cosine| *cosine > 0.0));
            let measures: f64 = moved.cell_volumes().iter().sum();
            assert!((measures - area).abs() < 1e-15, "{measures} {area}");
            for point in &moved.groups["border"].points {
                assert_eq!(moved.points[*point as usize], regular.points[*point as usize]);
            }
        }
        assert_ne!(made(0.1, 1).points, made(0.1, 2).points);
        assert_eq!(made(0.1, 1).points, made(0.1, 1).points);
    }

    /// As far as points may be moved no triangle is turned over.
    #[test]
    fn no_triangle_is_turned_over() {
        for seed in 0..50 {
            let mesh = made(0.25, seed);
            let turn = |cell: crate::Cell<'_>| {
                let [a, b, c] = [0, 1, 2].map(|node: usize| mesh.points[cell.nodes[node] as usize]);
                (b - a).cross(c - a).z
            };
            assert!(mesh.cells().map(turn).all(|turn| turn > 0.0));
        }
    }
}
