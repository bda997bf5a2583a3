//! What a file format has room for, declared in the table of formats: what a writer will leave out is told by it,
//! and the tests of round trips go by it.

use souple_mesh::{CellBlock, ElementKind, Mesh};

use crate::IoError;
use crate::dataset::{Facets, Output};

/// What of a mesh a format keeps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Holds {
    pub shapes: Shapes,
    pub groups: HeldGroups,
    pub fields: HeldFields,
    pub digits: Digits,
}

/// Which elements a format keeps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shapes {
    /// Cells and facets of every kind; edges where there is nothing else.
    All,
    /// Tetrahedra as cells and triangles as facets; others are refused.
    Tetrahedra,
    /// Triangles and quadrilaterals: the facets of a mesh, or the boundary of its cells, of which edges have none.
    Facets,
    /// Triangles; quadrilaterals are cut in two.
    Triangles,
}

/// Which groups a format keeps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HeldGroups {
    All,
    /// Those of facets, by name.
    OfFacets,
    /// One number for each cell and each facet in place of names.
    OneNumber,
    None,
}

/// Which fields a format keeps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HeldFields {
    All,
    /// One number for each point.
    PointScalars,
    None,
}

/// How exactly positions are kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Digits {
    /// The same bits.
    All,
    /// Those of a number of 4 bytes: rounded to a part in 2²⁴.
    Single,
}

impl Holds {
    pub const ALL: Self =
        Self { shapes: Shapes::All, groups: HeldGroups::All, fields: HeldFields::All, digits: Digits::All };

    /// Triangles with exact positions, and no more.
    pub const BARE: Self = Self {
        shapes: Shapes::Triangles,
        groups: HeldGroups::None,
        fields: HeldFields::None,
        digits: Digits::All,
    };

    /// Whether only surfaces are kept.
    pub fn is_surface(&self) -> bool {
        matches!(self.shapes, Shapes::Facets | Shapes::Triangles)
    }

    /// Refuses what the format cannot be written from at all.
    pub(crate) fn check(&self, format: &str, output: &Output<'_>) -> Result<(), IoError> {
        let of_format = |what: &str| format!("{what} of a mesh for the format `{format}`");
        if self.is_surface() && !has_surface(output.mesh) {
            let subject = of_format("the number of facets, and of cells that have a boundary,");
            return Err(IoError::request(subject, 0, "1 or more"));
        }
        if self.shapes == Shapes::Tetrahedra {
            let facets = if output.facets == Facets::Written { &output.mesh.facet_blocks[..] } else { &[] };
            let lists = [
                ("a cell", &output.mesh.blocks[..], ElementKind::Tet4),
                ("a facet", facets, ElementKind::Tri3),
            ];
            for (what, blocks, kind) in lists {
                if let Some(block) = blocks.iter().find(|block| !block.is_empty() && block.kind != kind) {
                    return Err(IoError::request(of_format(what), block.kind.name(), kind.name()));
                }
            }
        }
        Ok(())
    }

    /// What is not kept of a mesh, in words.
    pub(crate) fn losses(&self, format: &str, output: &Output<'_>) -> Vec<String> {
        let mesh = output.mesh;
        let mut losses = Vec::new();
        let mut lose = |count: usize, what: &str| {
            if count > 0 {
                losses.push(format!("the format `{format}` does not keep {count} {what}"));
            }
        };
        if self.shapes == Shapes::All {
            let count = |is_edge: bool| -> usize {
                let blocks = output.blocks().filter(|block| (block.kind.dimension() == 1) == is_edge);
                blocks.map(CellBlock::len).sum()
            };
            if count(false) > 0 {
                lose(count(true), "edges: beside other elements they are read as lines around them");
            }
        }
        if self.is_surface() {
            let left = if mesh.facet_count() > 0 { "only facets are" } else { "their boundary is" };
            lose(mesh.cell_count(), &format!("cells: {left} written"));
        }
        if self.shapes == Shapes::Triangles {
            let quadrilaterals = |blocks: &[CellBlock]| {
                blocks
                    .iter()
                    .filter(|block| block.kind == ElementKind::Quad4)
                    .map(CellBlock::len)
                    .sum::<usize>()
            };
            lose(quadrilaterals(&mesh.facet_blocks), "quadrilaterals: each is cut into two triangles");
        }
        if self.is_surface() {
            let is_curved = |block: &&CellBlock| !block.kind.is_linear();
            let curved: usize = mesh.facet_blocks.iter().filter(is_curved).map(CellBlock::len).sum();
            lose(curved, "curved facets: each is cut into triangles at the middles of its sides");
        }
        let held = |group: &&souple_mesh::Group| match self.groups {
            HeldGroups::All => true,
            HeldGroups::None => false,
            HeldGroups::OneNumber => false,
            HeldGroups::OfFacets => {
                group.points.is_empty() && group.cells.is_empty() && output.facets == Facets::Written
            }
        };
        let lost = mesh.groups.values().filter(|group| !held(group)).count();
        match self.groups {
            HeldGroups::OneNumber => lose(
                lost,
                "groups by name: each point, cell and facet has one number, that of its first group",
            ),
            HeldGroups::OfFacets => lose(lost, "groups of points and cells"),
            _ => lose(lost, "groups"),
        }
        let scalar = output.point_fields.iter().filter(|field| field.components == 1).count();
        match self.fields {
            HeldFields::All => {}
            HeldFields::PointScalars => {
                lose(output.point_fields.len() - scalar + output.cell_fields.len(), "fields");
            }
            HeldFields::None => lose(output.point_fields.len() + output.cell_fields.len(), "fields"),
        }
        if self.digits == Digits::Single {
            let rounded = |x: &f64| f64::from(*x as f32) != *x;
            let positions = output.positions().iter();
            lose(
                positions.filter(|p| p.to_array().iter().any(rounded)).count(),
                "positions exactly: they are rounded to 4 bytes",
            );
        }
        if self.groups == HeldGroups::OneNumber {
            losses.extend(crate::tetgen::renamed(output));
        }
        losses
    }
}

/// Whether a mesh has facets, or cells with a boundary.
fn has_surface(mesh: &Mesh) -> bool {
    let bounds = |block: &CellBlock| !block.is_empty() && block.kind.dimension() > 1;
    mesh.facet_count() > 0 || mesh.blocks.iter().any(bounds)
}
