//! The energy of a linear tetrahedron as a polynomial of its displacements:
//! `W = Σ U_j·B^{jk} U_k + Σ (U_j·C^{jkl}) (U_k·U_l) + Σ D^{jklm} (U_j·U_k) (U_l·U_m)`.
//!
//! St. Venant–Kirchhoff has all three sums, Hooke's law the first. With the gradients `α_j` of the shape functions and the
//! volume `V` taken in,
//! `B^{jk} = V/2 (λ α_j α_kᵀ + μ α_k α_jᵀ + μ α_j·α_k I)`, `C^{jkl} = V/2 (λ α_j (α_k·α_l) + μ α_l (α_j·α_k) + μ α_k (α_j·α_l))`,
//! `D^{jklm} = V/8 (λ (α_j·α_k)(α_l·α_m) + 2μ (α_j·α_m)(α_k·α_l))`.
//! (Picinbono, Delingette & Ayache 2003, Non-linear anisotropic elasticity for real-time surgery simulation; Faure 2014,
//! eq. 2.17, with `B` halved and `α` of either orientation.)

use souple_math::{Mat3, Vec3};
use souple_mesh::{Cell, ElementKind, Mesh};

use super::{FormulationError, check_cells, moduli_of};
use crate::materials::{AnyLaw, Lame, MaterialLaw};
use crate::solids::{FlatCell, SolidDescription};

/// The constants of a tetrahedron, computed where they are asked for.
pub struct Polynomial {
    /// `∂N_j/∂X` [1/m].
    alpha: [Vec3; 4],
    /// [m³]
    volume: f64,
    moduli: Lame,
    /// Whether cubic and quartic terms are there.
    pub is_quartic: bool,
}

impl Polynomial {
    pub fn quadratic(&self, j: usize, k: usize) -> Mat3 {
        let (a, b, Lame { mu, lambda }) = (self.alpha[j], self.alpha[k], self.moduli);
        let sum = a.outer(b) * lambda + b.outer(a) * mu;
        sum.plus_diagonal(mu * a.dot(b)) * (0.5 * self.volume)
    }

    pub fn cubic(&self, j: usize, k: usize, l: usize) -> Vec3 {
        let ([a, b, c], Lame { mu, lambda }) = ([j, k, l].map(|n| self.alpha[n]), self.moduli);
        let sum = a * (lambda * b.dot(c)) + c * (mu * a.dot(b)) + b * (mu * a.dot(c));
        sum * if self.is_quartic { 0.5 * self.volume } else { 0.0 }
    }

    pub fn quartic(&self, j: usize, k: usize, l: usize, m: usize) -> f64 {
        let ([a, b, c, d], Lame { mu, lambda }) = ([j, k, l, m].map(|n| self.alpha[n]), self.moduli);
        let sum = lambda * a.dot(b) * c.dot(d) + 2.0 * mu * a.dot(d) * b.dot(c);
        sum * if self.is_quartic { 0.125 * self.volume } else { 0.0 }
    }
}

/// Nodes and polynomial of every cell of a body of linear tetrahedra.
pub fn tetrahedra<'a>(
    formulation: &'static str,
    description: &'a SolidDescription,
) -> Result<impl Iterator<Item = Result<([u32; 4], Polynomial), FlatCell>> + 'a, FormulationError> {
    check_cells(formulation, description, |kind| kind == ElementKind::Tet4, "tet4")?;
    let laws = [AnyLaw::Linear, AnyLaw::StVenantKirchhoff];
    let moduli = moduli_of(formulation, description.materials, &laws, "linear and st_venant_kirchhoff")?;
    let SolidDescription { mesh, materials, material_of_cell, .. } = description;
    Ok((0_u32..).zip(mesh.cells()).map(move |(number, cell)| {
        let material = usize::from(material_of_cell[number as usize]);
        let (alpha, volume) = shape_of(mesh, number, &cell)?;
        let is_quartic = materials[material].law == MaterialLaw::Known(AnyLaw::StVenantKirchhoff);
        let nodes = std::array::from_fn(|a| cell.nodes[a]);
        Ok((nodes, Polynomial { alpha, volume, moduli: moduli[material], is_quartic }))
    }))
}

/// Gradients of the shape functions, and the volume.
fn shape_of(mesh: &Mesh, number: u32, cell: &Cell) -> Result<([Vec3; 4], f64), FlatCell> {
    let [x, y, z, w] = std::array::from_fn(|a| mesh.points[cell.nodes[a] as usize]);
    let jacobian = Mat3::from_columns(y - x, z - x, w - x);
    let determinant = jacobian.determinant();
    let inverse = jacobian.try_inverse().filter(|inverse| determinant > 0.0 && inverse.is_finite());
    let flat = FlatCell { kind: cell.kind, cell: number, sample: 0, determinant };
    let inverse = inverse.ok_or(flat)?;
    let [b, c, d] = [0, 1, 2].map(|row| inverse.row(row));
    Ok(([-(b + c + d), b, c, d], determinant / 6.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A tetrahedron of no symmetry.
    fn example(is_quartic: bool) -> Polynomial {
        let points = vec![
            Vec3::new(0.1, 0.0, 0.2),
            Vec3::new(1.2, 0.1, 0.0),
            Vec3::new(0.3, 0.9, -0.1),
            Vec3::new(0.2, 0.3, 1.4),
        ];
        let mesh = Mesh::new(points, ElementKind::Tet4, vec![0, 1, 2, 3]);
        let (alpha, volume) = shape_of(&mesh, 0, &mesh.cell(0).unwrap()).unwrap();
        Polynomial { alpha, volume, moduli: Lame { mu: 3.0, lambda: 5.0 }, is_quartic }
    }

    /// The symmetries that constants on edges and faces rest on.
    #[test]
    fn constants_have_their_symmetries() {
        let p = example(true);
        for (j, k, l, m) in (0..256).map(|n| (n & 3, n >> 2 & 3, n >> 4 & 3, n >> 6)) {
            assert_eq!(p.quadratic(j, k), p.quadratic(k, j).transpose());
            // sums of three products in another order
            assert!((p.cubic(j, k, l) - p.cubic(j, l, k)).length() < 1e-14);
            let of = p.quartic(j, k, l, m);
            for other in [p.quartic(k, j, m, l), p.quartic(l, m, j, k), p.quartic(m, l, k, j)] {
                assert!((of - other).abs() < 1e-14);
            }
        }
    }
}
