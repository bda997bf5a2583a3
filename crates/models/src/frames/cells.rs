//! Places in the cells of a shape, for weights that are known at its points.

use souple_math::Vec3;
use souple_mesh::{CellLocator, MAX_NODES, Mesh, NodeValues};

use super::{Frame, FrameError};

/// The cells of a shape, found by place.
pub struct Cells<'a> {
    mesh: &'a Mesh,
    locator: CellLocator<'a>,
}

/// A material point as a cell carries it.
pub struct Spot<'a> {
    pub cell: u32,
    pub nodes: &'a [u32],
    /// Of each node: its shape function.
    pub values: NodeValues<f64>,
    /// Of each node: the gradient of that by the material point [1/m].
    pub gradients: Vec<Vec3>,
}

/// Why weights that are known at points of the mesh have nothing to say where [`Cells::spot`] finds nothing.
pub const NOT_CARRIED: &str = "no cell of the mesh carries it, or one that is flat there; mend the mesh";

impl<'a> Cells<'a> {
    pub fn new(mesh: &'a Mesh) -> Self {
        Self { mesh, locator: CellLocator::new(mesh) }
    }

    /// `None` where no cell carries the point, or one that is flat there.
    pub fn spot(&self, point: Vec3) -> Option<Spot<'a>> {
        let location = self.locator.carrier(point)?;
        let cell = self.mesh.cell(location.cell)?;
        let mut buffer = [Vec3::ZERO; MAX_NODES];
        let corners = self.mesh.positions_into(cell.nodes, &mut buffer);
        let inverse = cell.kind.jacobian(corners, location.reference).try_inverse()?;
        let slopes = cell.kind.shape_gradients(location.reference);
        Some(Spot {
            cell: location.cell,
            nodes: cell.nodes,
            values: cell.kind.shape(location.reference),
            gradients: slopes.iter().map(|slope| inverse.transpose_apply(*slope)).collect(),
        })
    }

    /// The cell that carries a frame.
    fn carrier(&self, (index, frame): (usize, &Frame)) -> Result<u32, FrameError> {
        let location = self.locator.carrier(frame.origin);
        location
            .map(|location| location.cell)
            .ok_or(FrameError::NotCarried { frame: index, at: frame.origin })
    }

    /// The cell that carries each frame.
    ///
    /// # Errors
    /// A frame that no cell carries, or a part of the mesh that holds no frame.
    pub fn carriers(&self, frames: &[Frame]) -> Result<Vec<u32>, FrameError> {
        let carriers: Vec<u32> =
            frames.iter().enumerate().map(|frame| self.carrier(frame)).collect::<Result<_, _>>()?;
        let (part_of_cell, count) = self.mesh.components();
        let mut holds_frame = vec![false; count];
        carriers.iter().for_each(|cell| holds_frame[part_of_cell[*cell as usize] as usize] = true);
        match part_of_cell.iter().position(|part| !holds_frame[*part as usize]) {
            Some(cell) => Err(FrameError::PartWithoutFrame { at: self.mesh.cell_centres()[cell] }),
            None => Ok(carriers),
        }
    }
}

/// The least of the stiffnesses of some cells [Pa], which others are compared with.
///
/// # Errors
/// A cell without a stiffness that others could be compared with.
pub fn softest(stiffnesses: impl Iterator<Item = (usize, f64)>) -> Result<f64, FrameError> {
    let mut softest = f64::INFINITY;
    for (cell, stiffness) in stiffnesses {
        if !(stiffness > 0.0 && stiffness.is_finite()) {
            return Err(FrameError::NoStiffness { cell, stiffness });
        }
        softest = softest.min(stiffness);
    }
    Ok(softest)
}
