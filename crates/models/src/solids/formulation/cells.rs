//! Cells of a body whose forces are not computed cell by cell, for what is read off them.

use souple_engine::CellField;
use souple_math::{Mat3, Vec3};

use crate::materials::Material;
use crate::solids::SolidDescription;

/// Linear tetrahedra and their materials.
pub struct Cells {
    first_row: usize,
    /// Where the points of the body rest [m].
    rest: Vec<Vec3>,
    nodes: Vec<[u32; 4]>,
    materials: Vec<Material>,
    material_of_cell: Vec<u16>,
}

impl Cells {
    /// Of a body that has been found to have no other cells.
    pub fn of(description: &SolidDescription) -> Self {
        let SolidDescription { mesh, first_row, materials, material_of_cell, .. } = description;
        Self {
            first_row: *first_row,
            rest: mesh.points.clone(),
            nodes: mesh.cells().map(|cell| std::array::from_fn(|a| cell.nodes[a])).collect(),
            materials: materials.to_vec(),
            material_of_cell: material_of_cell.to_vec(),
        }
    }

    /// The law of the cell at `F = x_ξ X_ξ⁻¹`.
    pub fn field(&self, cell: usize, positions: &[Vec3]) -> Option<CellField> {
        let nodes = self.nodes.get(cell)?;
        let edges = |places: &[Vec3]| {
            let [a, b, c, d] = nodes.map(|node| places[node as usize]);
            Mat3::from_columns(b - a, c - a, d - a)
        };
        let rest = edges(&self.rest);
        let F = edges(&positions[self.first_row..]) * rest.try_inverse()?;
        let material = &self.materials[usize::from(self.material_of_cell[cell])];
        Some(material.along(None).field(&F, rest.determinant() / 6.0))
    }

    pub fn bytes(&self) -> usize {
        size_of_val(self.rest.as_slice())
            + size_of_val(self.nodes.as_slice())
            + size_of_val(self.materials.as_slice())
            + size_of_val(self.material_of_cell.as_slice())
    }
}
