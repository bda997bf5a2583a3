//! What is in a file: a mesh, values on its points and cells, and remarks about how it was read.

use souple_mesh::{CellBlock, ElementKind, Mesh};

use crate::IoError;
use crate::facets::Polygons;

/// A mesh with fields, as read from a file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Dataset {
    pub mesh: Mesh,
    /// One tuple for each point.
    pub point_fields: Vec<Field>,
    /// One tuple for each volume cell, then one for each facet.
    pub cell_fields: Vec<Field>,
    /// What a user should know: parts that were skipped, what was taken for what.
    pub notes: Vec<String>,
    /// What the file holds beside that no mesh takes and a copy of it is without: of use to who writes one.
    pub unread: Option<String>,
}

/// Named values, `components` for each point or cell.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Field {
    pub name: String,
    pub components: usize,
    /// Tuple after tuple.
    pub values: Vec<f64>,
}

impl Field {
    pub fn new(name: impl Into<String>, components: usize, values: Vec<f64>) -> Self {
        Self { name: name.into(), components, values }
    }

    /// Number of points or cells.
    pub fn tuple_count(&self) -> usize {
        self.values.len() / self.components.max(1)
    }
}

/// Whether the facets of a mesh go into a file beside its cells.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Facets {
    #[default]
    Written,
    LeftOut,
}

/// Width of numbers in a binary file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Precision {
    /// 4 bytes, 7 digits: enough to look at.
    Single,
    /// 8 bytes: reads back as the same bits.
    #[default]
    Double,
}

/// What to write: a mesh with fields, borrowed.
#[derive(Clone, Copy, Debug)]
pub struct Output<'a> {
    pub mesh: &'a Mesh,
    /// Positions to write in place of the rest positions [m].
    pub positions: Option<&'a [souple_math::Vec3]>,
    /// One tuple for each point.
    pub point_fields: &'a [Field],
    /// One tuple for each volume cell, then one for each facet that is written.
    pub cell_fields: &'a [Field],
    pub facets: Facets,
    pub precision: Precision,
}

impl<'a> Output<'a> {
    /// The mesh alone, in full precision.
    pub fn new(mesh: &'a Mesh) -> Self {
        Self {
            mesh,
            positions: None,
            point_fields: &[],
            cell_fields: &[],
            facets: Facets::default(),
            precision: Precision::default(),
        }
    }

    pub(crate) fn positions(&self) -> &'a [souple_math::Vec3] {
        self.positions.unwrap_or(&self.mesh.points)
    }

    /// The blocks to write: cells, then facets.
    pub(crate) fn blocks(&self) -> impl Iterator<Item = &'a CellBlock> + Clone + use<'a> {
        let facets: &[CellBlock] = match self.facets {
            Facets::Written => &self.mesh.facet_blocks,
            Facets::LeftOut => &[],
        };
        self.mesh.blocks.iter().chain(facets)
    }

    /// Number of cells and facets to write.
    pub(crate) fn cell_count(&self) -> usize {
        self.blocks().map(CellBlock::len).sum()
    }

    /// Refuses what a reader would refuse.
    ///
    /// # Errors
    /// Node numbers, positions or lengths of fields that do not fit the mesh.
    pub fn check(&self) -> Result<(), IoError> {
        let point_count = self.mesh.points.len();
        if let Some(positions) = self.positions
            && positions.len() != point_count
        {
            return Err(IoError::request(
                "the number of positions",
                positions.len(),
                format!("{point_count}"),
            ));
        }
        for (list, blocks) in [("cells", &self.mesh.blocks), ("facets", &self.mesh.facet_blocks)] {
            for (cell, nodes) in blocks.iter().flat_map(CellBlock::cells).enumerate() {
                if let Some(node) = nodes.iter().find(|node| **node as usize >= point_count) {
                    let expected = format!("a point of the mesh, which has {point_count}");
                    return Err(IoError::request(format!("a node of {list}[{cell}]"), node, expected));
                }
            }
        }
        let lists = [
            ("point field", self.point_fields, point_count),
            ("cell field", self.cell_fields, self.cell_count()),
        ];
        for (list, fields, count) in lists {
            for field in fields {
                let wanted = count * field.components;
                if field.components == 0 || field.values.len() != wanted {
                    return Err(IoError::request(
                        format!("the number of values of the {list} `{}`", field.name),
                        field.values.len(),
                        format!("{count} tuples of {} numbers", field.components.max(1)),
                    ));
                }
            }
        }
        Ok(())
    }
}

/// Where a cell of a file went.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Destination {
    Cell(u32),
    /// A polygon may have become several, or none.
    Facets {
        first: u32,
        count: u32,
    },
    Skipped,
}

impl Destination {
    /// Cells and facets that it has become.
    pub fn count(&self) -> usize {
        match self {
            Self::Cell(_) => 1,
            Self::Facets { count, .. } => *count as usize,
            Self::Skipped => 0,
        }
    }
}

/// Puts cells of a file among the cells or the facets of a mesh, and counts them.
#[derive(Debug, Default)]
pub(crate) struct Sorter {
    cell_count: u32,
    facet_count: u32,
    polygons: Polygons,
}

impl Sorter {
    pub fn push(&mut self, mesh: &mut Mesh, kind: ElementKind, nodes: &[u32]) -> Destination {
        // edges bound no volume
        if kind.dimension() != 2 {
            mesh.push_cell(kind, nodes);
            self.cell_count += 1;
            Destination::Cell(self.cell_count - 1)
        } else {
            mesh.push_facet(kind, nodes);
            self.facets(1)
        }
    }

    /// A polygon, as the facets that it becomes.
    pub fn push_polygon(&mut self, mesh: &mut Mesh, corners: &[u32]) -> Destination {
        let count = self.polygons.push(mesh, corners) as u32;
        self.facets(count)
    }

    fn facets(&mut self, count: u32) -> Destination {
        let first = self.facet_count;
        self.facet_count += count;
        Destination::Facets { first, count }
    }

    /// What of the polygons was not taken as it stands.
    pub fn notes(&self) -> Vec<String> {
        self.polygons.notes()
    }
}

/// Sorts the lists of all groups and drops repetitions.
pub(crate) fn tidy_groups(mesh: &mut Mesh) {
    for group in mesh.groups.values_mut() {
        for list in [&mut group.points, &mut group.cells, &mut group.facets] {
            list.sort_unstable();
            list.dedup();
        }
    }
}
