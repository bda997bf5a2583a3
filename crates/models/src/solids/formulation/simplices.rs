//! Linear tetrahedra and triangles as the operators of this room take them: gradients of shape functions and measures.

use souple_math::{Mat3, Vec3};
use souple_mesh::{ElementKind, Mesh};

use super::{FormulationError, moduli_of, name_of};
use crate::materials::{AnyLaw, Lame};
use crate::solids::{FlatCell, Section, SolidDescription};

/// A linear tetrahedron, or a linear triangle in a plane of constant z.
#[derive(Clone, Debug, PartialEq)]
pub struct Simplex {
    /// Four, or three.
    pub nodes: Vec<u32>,
    /// `∂N_j/∂X` of each [1/m].
    pub alpha: Vec<Vec3>,
    /// [m³]; of a triangle [m²].
    pub measure: f64,
}

impl Simplex {
    /// Those of a mesh that has no other cells.
    ///
    /// # Errors
    /// A cell is flat or inverted at rest.
    pub fn all(mesh: &Mesh) -> Result<Vec<Self>, FlatCell> {
        (0_u32..)
            .zip(mesh.cells())
            .map(|(number, cell)| {
                let corner = |at: usize| mesh.points[cell.nodes[at] as usize];
                let (b, c) = (corner(1) - corner(0), corner(2) - corner(0));
                // a triangle with an edge of one metre across
                let is_flat = cell.kind == ElementKind::Tri3;
                let d = if is_flat { Vec3::AXES[2] } else { corner(3) - corner(0) };
                let jacobian = Mat3::from_columns(b, c, d);
                let determinant = jacobian.determinant();
                let inverse =
                    jacobian.try_inverse().filter(|inverse| determinant > 0.0 && inverse.is_finite());
                let flat = FlatCell { kind: cell.kind, cell: number, sample: 0, determinant };
                let inverse = inverse.ok_or(flat)?;
                let rows = [0, 1, 2].map(|row| inverse.row(row));
                let own = &rows[..cell.nodes.len() - 1];
                let first = -own.iter().copied().sum::<Vec3>();
                let alpha = std::iter::once(first).chain(own.iter().copied()).collect();
                let measure = determinant / if is_flat { 2.0 } else { 6.0 };
                Ok(Self { nodes: cell.nodes.to_vec(), alpha, measure })
            })
            .collect()
    }
}

/// A body of linear simplices under Hooke's law.
pub struct LinearBody {
    pub simplices: Vec<Simplex>,
    /// By material.
    pub moduli: Vec<Lame>,
    /// What makes a volume of a measure: 1, or a thickness [m].
    pub depth: f64,
}

impl LinearBody {
    /// # Errors
    /// The body has other cells, another law, or another section.
    pub fn of(formulation: &'static str, description: &SolidDescription) -> Result<Self, FormulationError> {
        let depth = depth_of(formulation, description)?;
        let wanted = if depth.is_some() { ElementKind::Tri3 } else { ElementKind::Tet4 };
        if let Some(cell) = description.mesh.cells().find(|cell| cell.kind != wanted) {
            let accepted = "tet4, and tri3 in plane strain";
            return Err(FormulationError::Element { formulation, kind: cell.kind, accepted });
        }
        Ok(Self {
            simplices: Simplex::all(description.mesh)?,
            moduli: linear_moduli(formulation, description)?,
            depth: depth.unwrap_or(1.0),
        })
    }
}

/// The thickness of a body in plane strain; none of one of volumes.
pub fn depth_of(
    formulation: &'static str,
    description: &SolidDescription,
) -> Result<Option<f64>, FormulationError> {
    match description.section {
        Section::Solid => Ok(None),
        Section::PlaneStrain { thickness } => Ok(Some(thickness)),
        _ => Err(FormulationError::PlaneStrain { formulation }),
    }
}

/// Moduli of materials that all have the linear law.
pub fn linear_moduli(
    formulation: &'static str,
    description: &SolidDescription,
) -> Result<Vec<Lame>, FormulationError> {
    moduli_of(formulation, description.materials, &[AnyLaw::Linear], name_of_linear())
}

fn name_of_linear() -> &'static str {
    name_of(&crate::materials::MaterialLaw::Known(AnyLaw::Linear))
}
