//! The checks that a mesh passes before anything is computed on it, and the repairs that are made on the way.
//!
//! Wrong winding is repaired and said; loose points and separate parts are said; anything else is refused.

use souple_math::Vec3;
use souple_table::in_number;

use crate::{Cell, CellBlock, ElementKind, Group, MAX_NODES, Mesh, MeshError};

/// What [`Mesh::validate`] repaired or noticed.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Repairs {
    /// Cells whose nodes were reordered because they were inverted.
    pub rewound_cells: Vec<u32>,
    /// Points that no volume cell refers to.
    pub loose_points: Vec<u32>,
    /// Number of parts that share no point.
    pub component_count: usize,
}

impl Repairs {
    /// One line for each thing that a user should know; empty for a mesh in order.
    pub fn messages(&self) -> Vec<String> {
        let mut messages = Vec::new();
        if let Some(first) = self.rewound_cells.first() {
            let count = self.rewound_cells.len();
            let were = in_number(count, "inverted cell was", "inverted cells were");
            messages.push(format!("{were} rewound, the first is cells[{first}]"));
        }
        if let Some(first) = self.loose_points.first() {
            let count = self.loose_points.len();
            let points = in_number(count, "point belongs", "points belong");
            messages.push(format!("{points} to no cell, the first is points[{first}]"));
        }
        if self.component_count > 1 {
            messages.push(format!("the mesh has {} parts that share no point", self.component_count));
        }
        messages
    }
}

/// A cell is flat below this volume (area, length), relative to that power of its size: rounding of the coordinates then decides
/// its sign.
const FLAT: f64 = 1e-14;

impl Mesh {
    /// Checks everything, rewinds inverted cells.
    ///
    /// # Errors
    /// The first fault, naming the cell, point or group.
    pub fn validate(&mut self) -> Result<Repairs, MeshError> {
        if self.points.is_empty() {
            return Err(MeshError::NoPoints);
        }
        if self.points.len() > u32::MAX as usize {
            return Err(MeshError::TooManyPoints { count: self.points.len() });
        }
        if self.cell_count() == 0 {
            return Err(MeshError::NoCells);
        }
        if let Some(point) = self.points.iter().position(|point| !point.is_finite()) {
            let position = self.points[point].to_array();
            return Err(MeshError::PointNotFinite { point: point as u32, position });
        }
        check_blocks("cells", &self.blocks, self.dimension(), self.points.len())?;
        check_blocks("facets", &self.facet_blocks, 2, self.points.len())?;
        for (name, group) in &self.groups {
            self.check_group(name, group)?;
        }
        let rewound_cells = self.rewind()?;
        let (_, component_count) = self.components();
        Ok(Repairs { rewound_cells, loose_points: self.loose_points(), component_count })
    }

    fn check_group(&self, name: &str, group: &Group) -> Result<(), MeshError> {
        let lists = [
            ("points", &group.points, self.points.len()),
            ("cells", &group.cells, self.cell_count()),
            ("facets", &group.facets, self.facet_count()),
        ];
        for (list, indices, count) in lists {
            if let Some(&index) = indices.iter().find(|index| **index as usize >= count) {
                return Err(MeshError::GroupOutOfRange { group: name.to_owned(), list, index, count });
            }
        }
        Ok(())
    }

    /// Turns inverted cells, refuses flat and tangled ones.
    fn rewind(&mut self) -> Result<Vec<u32>, MeshError> {
        let points = &self.points;
        let mut rewound = Vec::new();
        let mut cell = 0;
        for block in &mut self.blocks {
            let kind = block.kind;
            for nodes in block.nodes.chunks_exact_mut(kind.node_count()) {
                match orientation(points, Cell { kind, nodes }) {
                    Orientation::Good => {}
                    Orientation::Inverted => {
                        let mut mirrored = [0; MAX_NODES];
                        for (slot, node) in mirrored.iter_mut().zip(kind.mirrored()) {
                            *slot = nodes[usize::from(*node)];
                        }
                        nodes.copy_from_slice(&mirrored[..nodes.len()]);
                        rewound.push(cell);
                    }
                    Orientation::Flat { volume, size } => {
                        return Err(MeshError::FlatCell { cell, kind, volume, size });
                    }
                    Orientation::Tangled { lowest, highest } => {
                        return Err(MeshError::TangledCell { cell, kind, lowest, highest });
                    }
                }
                cell += 1;
            }
        }
        Ok(rewound)
    }

    /// Points that no volume cell refers to, ascending.
    pub fn loose_points(&self) -> Vec<u32> {
        let mut used = vec![false; self.points.len()];
        for block in &self.blocks {
            for node in &block.nodes {
                used[*node as usize] = true;
            }
        }
        (0..self.points.len() as u32).filter(|point| !used[*point as usize]).collect()
    }

    /// Removes the points that neither a cell nor a facet refers to; returns the old number of each point kept.
    pub fn remove_loose_points(&mut self) -> Vec<u32> {
        let mut new_number = vec![u32::MAX; self.points.len()];
        for block in self.blocks.iter().chain(&self.facet_blocks) {
            for node in &block.nodes {
                new_number[*node as usize] = 0;
            }
        }
        let kept: Vec<u32> =
            (0..self.points.len() as u32).filter(|point| new_number[*point as usize] == 0).collect();
        for (new, old) in kept.iter().enumerate() {
            new_number[*old as usize] = new as u32;
        }
        self.points = kept.iter().map(|old| self.points[*old as usize]).collect();
        for block in self.blocks.iter_mut().chain(&mut self.facet_blocks) {
            for node in &mut block.nodes {
                *node = new_number[*node as usize];
            }
        }
        for group in self.groups.values_mut() {
            group.points.retain(|point| new_number[*point as usize] != u32::MAX);
            for point in &mut group.points {
                *point = new_number[*point as usize];
            }
        }
        kept
    }
}

fn check_blocks(
    list: &'static str,
    blocks: &[CellBlock],
    dimension: usize,
    point_count: usize,
) -> Result<(), MeshError> {
    let mut cell = 0;
    for block in blocks {
        let kind = block.kind;
        if kind.dimension() != dimension {
            return Err(MeshError::WrongDimension { list, kind, dimension });
        }
        if !block.nodes.len().is_multiple_of(kind.node_count()) {
            return Err(MeshError::BlockLength { kind, count: block.nodes.len() });
        }
        for nodes in block.cells() {
            for (place, &point) in nodes.iter().enumerate() {
                if point as usize >= point_count {
                    return Err(MeshError::MissingPoint { list, cell, kind, point, point_count });
                }
                if nodes[..place].contains(&point) {
                    return Err(MeshError::DuplicateNode { list, cell, kind, point });
                }
            }
            cell += 1;
        }
    }
    Ok(())
}

enum Orientation {
    Good,
    Inverted,
    Flat { volume: f64, size: f64 },
    Tangled { lowest: f64, highest: f64 },
}

/// Judged by the Jacobian determinants at the points of the default rule.
fn orientation(points: &[Vec3], cell: Cell<'_>) -> Orientation {
    let mut buffer = [Vec3::ZERO; MAX_NODES];
    for (slot, node) in buffer.iter_mut().zip(cell.nodes) {
        *slot = points[*node as usize];
    }
    let positions = &buffer[..cell.nodes.len()];
    let (mut lowest, mut highest, mut volume) = (f64::INFINITY, f64::NEG_INFINITY, 0.0);
    for point in &cell.kind.default_rule().points {
        let determinant = cell.kind.jacobian(positions, point.position).determinant();
        lowest = lowest.min(determinant);
        highest = highest.max(determinant);
        volume += point.weight * determinant;
    }
    let low = positions.iter().fold(positions[0], |low, p| low.min_components(*p));
    let high = positions.iter().fold(positions[0], |high, p| high.max_components(*p));
    let size = (high - low).length();
    let negligible = FLAT * size.powi(cell.kind.dimension() as i32);
    // coordinates so large that their cube overflows leave no volume that could be trusted either
    if volume.abs() <= negligible || !volume.is_finite() {
        Orientation::Flat { volume, size }
    } else if lowest > 0.0 {
        Orientation::Good
    } else if highest < 0.0 {
        Orientation::Inverted
    } else {
        Orientation::Tangled { lowest, highest }
    }
}

impl Cell<'_> {
    /// Corners of face `face`, in order, normal outward.
    pub fn face_corners(&self, face: usize) -> impl Iterator<Item = u32> + '_ {
        let face = &self.kind.faces()[face];
        face.nodes[..face.kind.corner_count()].iter().map(|node| self.nodes[usize::from(*node)])
    }

    /// Node numbers of face `face`, in the order of the face's own element, normal outward.
    pub fn face_nodes(&self, face: usize) -> (ElementKind, impl Iterator<Item = u32> + '_) {
        let face = &self.kind.faces()[face];
        (face.kind, face.nodes.iter().map(|node| self.nodes[usize::from(*node)]))
    }
}
