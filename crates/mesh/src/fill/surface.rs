//! Fills what triangles enclose: mended first, everything said.

use super::Options;
use crate::implicit::{Sign, SurfaceShape};
use crate::repair::{RepairLimits, SurfaceRepairs, repair};
use crate::{Mesh, MeshError, TriangleSurface};

/// The inside of a surface.
#[derive(Clone, Debug)]
pub struct FilledSurface {
    pub mesh: Mesh,
    /// What was mended before.
    pub repairs: SurfaceRepairs,
    /// One line for each thing that a user should know.
    pub notes: Vec<String>,
}

/// The triangles of a mesh: its facets, or the boundary of its cells where it has none. `None` for neither.
pub fn surface_of(mesh: &Mesh) -> Option<TriangleSurface> {
    if mesh.cell_count() > 0 { Some(mesh.boundary_surface()) } else { mesh.facet_surface() }
}

/// Mends a surface and fills it.
///
/// # Errors
/// There is no triangle, or nothing that they enclose; as [`fill`](super::fill).
pub fn fill_surface(
    surface: &TriangleSurface,
    limits: RepairLimits,
    options: &Options,
) -> Result<FilledSurface, MeshError> {
    let (mended, repairs) = repair(surface, limits);
    let mut notes = repairs.messages();
    let shape = SurfaceShape::new(mended)?;
    if shape.sign() == Sign::WindingNumber {
        notes.extend(shape.diagnosis().messages());
        notes
            .push("the surface is not simple: its inside is where it winds around more than half".to_owned());
    }
    let mesh = options.fill(&shape, &[])?;
    let parts = mesh.components().1;
    if parts > 1 {
        notes.push(format!("the filling has {parts} parts that share no point"));
    }
    Ok(FilledSurface { mesh, repairs, notes })
}
