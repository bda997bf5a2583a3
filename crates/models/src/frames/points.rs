//! Integration points: where a body of frames is strained and has its mass.

use std::collections::BTreeMap;

use souple_math::Vec3;
use souple_mesh::{Cell, ElementKind, MAX_NODES, Mesh};
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
            summary: "one for each voxel that holds quadrature points of the shape's cells, in the middle of their matter: no more than these, four or eight a cell",
            source: "Faure et al. 2011, §4.2",
            parameters: &[Parameter::number("size", "m", Range::POSITIVE, "edge of a voxel")],
            build: |values, mesh, groups| {
                voxels(mesh, groups, &samples_of_cells(mesh, Some(2)), values.number("size"))
            },
        },
        &Entry {
            name: "count",
            summary: "voxels of the size that makes about so many of the body's volume, cut out of the shape's cells however coarse these are",
            source: "Faure et al. 2011, §4.2",
            parameters: &[Parameter::integer("count", Range::closed(1.0, 1e6), "about how many")],
            build: |values, mesh, groups| {
                let volume = mesh.volume() / values.integer("count") as f64;
                voxels(mesh, groups, &fine_samples(mesh, volume / SAMPLES_PER_VOXEL), volume.cbrt())
            },
        },
    ],
};

/// Samples of every cell by a rule of some degree, or by its default rule, cell after cell.
pub fn samples_of_cells(mesh: &Mesh, degree: Option<usize>) -> Vec<Sample> {
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

/// Samples that a voxel is put together of, on the average at least: few of those inside the shape stay without any.
const SAMPLES_PER_VOXEL: f64 = 4.0;

/// Samples of degree two of all cells, of less than `volume` on the average of a cell: cells that are too coarse are cut.
fn fine_samples(mesh: &Mesh, volume: f64) -> Vec<Sample> {
    let mut fine = Vec::new();
    for samples in samples_of_cells(mesh, Some(2)).chunk_by(|a, b| a.cell == b.cell) {
        let of_cell: f64 = samples.iter().map(|sample| sample.volume).sum();
        match mesh.cell(samples[0].cell) {
            Some(cell) if of_cell > volume * samples.len() as f64 => {
                fine.extend(cut(mesh, cell, samples, volume));
            }
            _ => fine.extend_from_slice(samples),
        }
    }
    fine
}

/// Pieces of a cell of at most about `volume`, with the volume and the middle of its `samples` together.
fn cut(mesh: &Mesh, cell: Cell, samples: &[Sample], volume: f64) -> Vec<Sample> {
    let mut buffer = [Vec3::ZERO; MAX_NODES];
    let corners = mesh.positions_into(cell.nodes, &mut buffer);
    let number = samples[0].cell;
    let sample = |tetrahedron: [Vec3; 4]| {
        let [a, b, c, d] = tetrahedron;
        let middle = (a + b + c + d) * 0.25;
        let reference = (b - a).dot((c - a).cross(d - a)).abs() / 6.0;
        Sample {
            position: cell.kind.position(corners, middle),
            volume: cell.kind.jacobian(corners, middle).determinant() * reference,
            cell: number,
        }
    };
    let mut pieces = Vec::new();
    let mut left = tetrahedra(cell.kind);
    while let Some(tetrahedron) = left.pop() {
        let piece = sample(tetrahedron);
        if piece.volume > volume {
            left.extend(halves(tetrahedron, |at| cell.kind.position(corners, at)));
        } else {
            pieces.push(piece);
        }
    }
    // what is taken for constant in a piece, and varies in a cell that is no parallelepiped
    let sums = |of: &[Sample]| {
        of.iter().fold((0.0, Vec3::ZERO), |(volume, moment), s| {
            (volume + s.volume, moment + s.position * s.volume)
        })
    };
    let ((whole, moment), (of_pieces, moment_of_pieces)) = (sums(samples), sums(&pieces));
    let shift = moment / whole - moment_of_pieces / of_pieces;
    for piece in &mut pieces {
        piece.volume *= whole / of_pieces;
        piece.position += shift;
    }
    pieces
}

/// The tetrahedra between the middle of a reference cell and the triangles of its faces.
fn tetrahedra(kind: ElementKind) -> Vec<[Vec3; 4]> {
    let nodes = kind.element().nodes;
    let at = |corner: u8| Vec3::from_array(nodes[usize::from(corner)]);
    let corners = 0..kind.corner_count() as u8;
    let middle = corners.map(at).sum::<Vec3>() / kind.corner_count() as f64;
    let of_face = |face: &&[u8]| {
        let face = face.to_vec();
        (2..face.len()).map(move |k| [middle, at(face[0]), at(face[k - 1]), at(face[k])])
    };
    kind.element().faces.iter().flat_map(of_face).collect()
}

/// Halves of a tetrahedron of a reference cell, cut through the middle of the edge that is longest in space.
fn halves(tetrahedron: [Vec3; 4], position: impl Fn(Vec3) -> Vec3) -> [[Vec3; 4]; 2] {
    let placed = tetrahedron.map(position);
    let mut longest = (0.0, [0, 1]);
    for i in 0..4 {
        for j in i + 1..4 {
            let length_sq = (placed[i] - placed[j]).length_sq();
            if length_sq > longest.0 {
                longest = (length_sq, [i, j]);
            }
        }
    }
    let ends = longest.1;
    let middle = (tetrahedron[ends[0]] + tetrahedron[ends[1]]) * 0.5;
    ends.map(|end| {
        let mut half = tetrahedron;
        half[end] = middle;
        half
    })
}

/// Samples of one voxel and group put together: volume and first moment stay exact.
fn voxels(mesh: &Mesh, groups: &[u16], fine: &[Sample], size: f64) -> Vec<Sample> {
    let corner = mesh.bounds().low;
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
            let samples = voxels(&mesh, &groups, &samples_of_cells(&mesh, Some(2)), size);
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

    /// As many points as are asked for are had of a mesh of few cells, of every kind, with its volume and its centroid; where cells are
    /// fine enough points are put together of their samples as they are.
    #[test]
    fn counts_are_had_of_coarse_meshes() {
        let entry = POINTS.find("count").expect("a way to choose points");
        let count_of = |mesh: &Mesh, count: i64| {
            let values = Values::new().with("count", Value::Integer(count));
            (entry.build)(&values, mesh, &vec![0; mesh.cell_count()])
        };
        for element in ["tet4", "hex8", "prism6", "pyramid5", "hex20"] {
            let values = Values::new()
                .with("size", Value::Vector([2.0, 1.0, 0.5]))
                .with("cells", Value::Vector([2.0, 1.0, 1.0]))
                .with("element", Value::Text(element));
            let mesh = souple_mesh::generate("bar", values).expect("a bar");
            for count in [500, 4000] {
                let samples = count_of(&mesh, count);
                // 16 x 8 x 4 voxels and 31.7 x 15.9 x 7.9; a few stay without a sample, cut ones count as whole
                let ratio = samples.len() as f64 / count as f64;
                assert!((0.9..1.2).contains(&ratio), "{element}: {} of {count}", samples.len());
                let volume: f64 = samples.iter().map(|sample| sample.volume).sum();
                let middle =
                    samples.iter().map(|sample| sample.position * sample.volume).sum::<Vec3>() / volume;
                // sums of some thousand numbers of order one
                assert!((volume - 1.0).abs() < 1e-12, "{element}: {volume}");
                assert!((middle - Vec3::new(1.0, 0.5, 0.25)).length() < 1e-12, "{element}: {middle:?}");
            }
        }
        let values = Values::new()
            .with("size", Value::Vector([2.0, 1.0, 0.5]))
            .with("cells", Value::Vector([8.0, 4.0, 2.0]))
            .with("element", Value::Text("tet4"));
        let mesh = souple_mesh::generate("bar", values).expect("a bar");
        let as_they_are = voxels(&mesh, &vec![0; mesh.cell_count()], &samples_of_cells(&mesh, Some(2)), 0.25);
        assert_eq!(count_of(&mesh, 64), as_they_are);
    }

    /// Pieces of a cell that is no parallelepiped have its volume and its middle.
    #[test]
    fn pieces_keep_volume_and_middle() {
        let values = Values::new()
            .with("size", Value::Vector([1.0; 3]))
            .with("cells", Value::Vector([1.0; 3]))
            .with("element", Value::Text("hex8"));
        let mut mesh = souple_mesh::generate("box", values).expect("a box");
        mesh.points[0] += Vec3::new(0.2, -0.1, 0.3);
        let samples = samples_of_cells(&mesh, Some(2));
        let pieces = fine_samples(&mesh, 1e-3);
        let sums = |samples: &[Sample]| {
            let moments = samples.iter().map(|sample| sample.position * sample.volume);
            (samples.iter().map(|sample| sample.volume).sum::<f64>(), moments.sum::<Vec3>())
        };
        let ((volume, moment), (of_pieces, moment_of_pieces)) = (sums(&samples), sums(&pieces));
        assert!(pieces.len() > 1000 && pieces.iter().all(|piece| piece.volume < 1.01e-3));
        // sums of some thousand numbers of order one
        assert!((of_pieces - volume).abs() < 1e-12 && (moment_of_pieces - moment).length() < 1e-12);
    }
}
