//! Integration points: where a body of frames is strained and has its mass.

use std::collections::BTreeMap;

use souple_math::Vec3;
use souple_mesh::{MAX_NODES, Mesh};
use souple_table::{Entry, Parameter, Range, Table, Values};

/// A material point that stands for the matter around it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// At rest [m].
    pub position: Vec3,
    /// [m³]
    pub volume: f64,
    /// The cell of the shape that it lies in, or the one nearest to the middle of its matter.
    pub cell: u32,
}

/// Makes the points of a shape; those of two groups of cells are never put together.
pub type BuildPoints = fn(&Values, &Mesh, &[u16]) -> Vec<Sample>;

/// All ways to choose integration points.
pub static POINTS: Table<BuildPoints> = Table {
    kind: "points",
    entries: &[
        &Entry {
            name: "cells",
            summary: "the samples of the shape's own cells: one in a tetrahedron, eight in a hexahedron",
            source: "own",
            parameters: &[],
            build: |_, mesh, _| samples_of_cells(mesh, None),
        },
        &Entry {
            name: "voxels",
            summary: "one for each voxel that holds matter: its volume and the middle of it, cut by the shape's cells",
            source: "Faure et al. 2011, §4.2",
            parameters: &[Parameter::number("size", "m", Range::POSITIVE, "edge of a voxel")],
            build: |values, mesh, groups| voxels(mesh, groups, values.number("size")),
        },
        &Entry {
            name: "count",
            summary: "voxels of the size that makes about so many of the body's volume",
            source: "Faure et al. 2011, §4.2",
            parameters: &[Parameter::integer("count", Range::closed(1.0, 1e7), "about how many")],
            build: |values, mesh, groups| {
                voxels(mesh, groups, (mesh.volume() / values.integer("count") as f64).cbrt())
            },
        },
    ],
};

/// Samples of every cell by a rule of some degree, or by its default rule.
fn samples_of_cells(mesh: &Mesh, degree: Option<usize>) -> Vec<Sample> {
    let mut samples = Vec::new();
    let mut buffer = [Vec3::ZERO; MAX_NODES];
    for (index, cell) in mesh.cells().enumerate() {
        let rule = degree.and_then(|degree| cell.kind.rule_of_degree(degree));
        let rule = rule.unwrap_or_else(|| cell.kind.default_rule());
        let corners = mesh.positions_into(cell.nodes, &mut buffer);
        for point in &rule.points {
            let volume = cell.kind.jacobian(corners, point.position).determinant() * point.weight;
            let shape = cell.kind.shape(point.position);
            let position = corners.iter().zip(shape.iter()).map(|(x, n)| *x * *n).sum();
            samples.push(Sample { position, volume, cell: index as u32 });
        }
    }
    samples
}

/// Samples of degree two of all cells, those of one voxel and group put together: volume and first moment stay exact.
fn voxels(mesh: &Mesh, groups: &[u16], size: f64) -> Vec<Sample> {
    let corner = mesh.bounds().low;
    let fine = samples_of_cells(mesh, Some(2));
    let mut found: BTreeMap<(u16, [i64; 3]), Vec<usize>> = BTreeMap::new();
    for (index, sample) in fine.iter().enumerate() {
        let place = ((sample.position - corner) / size).to_array().map(|x| x.floor() as i64);
        found.entry((groups[sample.cell as usize], place)).or_default().push(index);
    }
    let merged = |members: Vec<usize>| {
        let of = || members.iter().map(|index| &fine[*index]);
        let volume: f64 = of().map(|sample| sample.volume).sum();
        let position = of().map(|sample| sample.position * sample.volume).sum::<Vec3>() / volume;
        let distance = |sample: &&Sample| (sample.position - position).length_sq();
        let nearest = of().min_by(|a, b| distance(a).total_cmp(&distance(b)));
        Sample { position, volume, cell: nearest.map_or(0, |sample| sample.cell) }
    };
    found.into_values().map(merged).collect()
}

#[cfg(test)]
mod tests {
    use souple_table::Value;

    use super::*;

    /// Voxels keep the volume and the centroid of the shape, however they cut it, and never join two groups.
    #[test]
    fn voxels_keep_volume_and_centroid() {
        let values = Values::new()
            .with("size", Value::Vector([2.0, 1.0, 0.5]))
            .with("cells", Value::Vector([8.0, 4.0, 2.0]))
            .with("element", Value::Text("tet4"));
        let mesh = souple_mesh::generate("bar", values).expect("a bar");
        let groups: Vec<u16> = mesh.cell_centres().iter().map(|centre| u16::from(centre.x > 0.9)).collect();
        for size in [0.1, 0.3, 0.7] {
            let samples = voxels(&mesh, &groups, size);
            let volume: f64 = samples.iter().map(|sample| sample.volume).sum();
            let middle = samples.iter().map(|sample| sample.position * sample.volume).sum::<Vec3>() / volume;
            // sums of some thousand numbers of order one
            assert!((volume - 1.0).abs() < 1e-12, "{volume}");
            assert!((middle - Vec3::new(1.0, 0.5, 0.25)).length() < 1e-12, "{middle:?}");
            let whole = samples.iter().filter(|sample| groups[sample.cell as usize] == 0);
            let of_group: f64 = whole.map(|sample| sample.volume).sum();
            let expected: f64 = (0..)
                .zip(&groups)
                .filter(|(_, group)| **group == 0)
                .map(|(cell, _)| mesh.cell_volumes()[cell])
                .sum();
            assert!((of_group - expected).abs() < 1e-12);
        }
    }
}
