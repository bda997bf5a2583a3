//! Volume, centroids, bounds and connected parts of a mesh.

use souple_math::Vec3;

use crate::sets::Sets;
use crate::{Cell, ElementKind, MAX_NODES, Mesh, QuadratureRule};

/// An axis-aligned box around points [m].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoundingBox {
    pub low: Vec3,
    pub high: Vec3,
}

/// Sizes of soft bodies [m], from insects' organs to large animals: what a file has beyond is more likely in other units. An
/// organ of half a centimetre and more is, in millimetres.
pub const USUAL_SIZES: [f64; 2] = [1e-4, 5.0];

impl BoundingBox {
    /// The box of no point: `low = ∞`, `high = -∞`.
    pub const EMPTY: Self = Self {
        low: Vec3::new(f64::INFINITY, f64::INFINITY, f64::INFINITY),
        high: Vec3::new(f64::NEG_INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY),
    };

    pub fn of(points: impl IntoIterator<Item = Vec3>) -> Self {
        points.into_iter().fold(Self::EMPTY, |bounds, point| bounds.with(point))
    }

    #[must_use]
    pub fn with(self, point: Vec3) -> Self {
        Self { low: self.low.min_components(point), high: self.high.max_components(point) }
    }

    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self { low: self.low.min_components(other.low), high: self.high.max_components(other.high) }
    }

    /// The box grown by `margin` on every side.
    #[must_use]
    pub fn grown(self, margin: f64) -> Self {
        let margin = Vec3::new(margin, margin, margin);
        Self { low: self.low - margin, high: self.high + margin }
    }

    pub fn size(self) -> Vec3 {
        self.high - self.low
    }

    /// What to say of the lengths of a file, which knows no units, where they are beyond [`USUAL_SIZES`].
    pub fn doubt(self) -> Option<String> {
        let Vec3 { x, y, z } = self.size();
        let largest = x.max(y).max(z);
        let is_usual = (USUAL_SIZES[0]..=USUAL_SIZES[1]).contains(&largest);
        // of nothing, or nothing finite, other things are said
        let is_told = largest > 0.0 && largest.is_finite() && !is_usual;
        let hint = if largest > USUAL_SIZES[1] { ": in millimetres it takes scale=0.001" } else { "" };
        is_told.then(|| {
            let [x, y, z] = [x, y, z].map(|length| {
                // four digits are as many as tell a size
                souple_table::readable(format!("{length:.3e}").parse().unwrap_or(length))
            });
            format!("it measures {x} x {y} x {z} m, an unusual size for a soft body{hint}")
        })
    }

    /// The eight corners [m].
    pub fn corners(self) -> impl Iterator<Item = Vec3> {
        (0..8).map(move |corner| {
            let end = |axis: usize| if corner >> axis & 1 == 0 { self.low } else { self.high };
            Vec3::new(end(0).x, end(1).y, end(2).z)
        })
    }

    pub fn centre(self) -> Vec3 {
        (self.low + self.high) * 0.5
    }

    pub fn diagonal(self) -> f64 {
        self.size().length()
    }

    pub fn contains(self, point: Vec3) -> bool {
        (0..3).all(|axis| self.low[axis] <= point[axis] && point[axis] <= self.high[axis])
    }

    pub fn overlaps(self, other: Self) -> bool {
        (0..3).all(|axis| self.low[axis] <= other.high[axis] && other.low[axis] <= self.high[axis])
    }

    /// Squared distance from a point to the box, zero inside [m²].
    pub fn distance_sq(self, point: Vec3) -> f64 {
        let outside = (self.low - point).max_components(point - self.high).max_components(Vec3::ZERO);
        outside.length_sq()
    }
}

impl Mesh {
    /// Box around all points.
    pub fn bounds(&self) -> BoundingBox {
        BoundingBox::of(self.points.iter().copied())
    }

    /// Box around the points that cells and facets have: a file may hold others.
    pub fn bounds_of_cells(&self) -> BoundingBox {
        let nodes = self.cells().chain(self.facets()).flat_map(|cell| cell.nodes.iter());
        BoundingBox::of(nodes.map(|node| self.points[*node as usize]))
    }

    /// Volume of a cell [m³], area of a surface cell [m²], length of an edge [m]; exact for linear volumes, the
    /// Jacobian determinant being a polynomial that the rule integrates on hexahedra and prisms, and in the variables
    /// of the conical product on pyramids, and for quadratic ones with straight edges.
    pub fn cell_volume(&self, cell: Cell<'_>) -> f64 {
        let mut buffer = [Vec3::ZERO; MAX_NODES];
        let positions = self.positions_into(cell.nodes, &mut buffer);
        let rule = volume_rule(cell.kind);
        rule.points.iter().map(|p| p.weight * cell.kind.jacobian(positions, p.position).determinant()).sum()
    }

    /// Volumes of all cells, in their order [m³].
    pub fn cell_volumes(&self) -> Vec<f64> {
        self.cells().map(|cell| self.cell_volume(cell)).collect()
    }

    /// Total volume [m³].
    pub fn volume(&self) -> f64 {
        self.cells().map(|cell| self.cell_volume(cell)).sum()
    }

    /// Centre of volume `∫ x dV / ∫ dV` [m].
    pub fn centroid(&self) -> Vec3 {
        let mut moment = Vec3::ZERO;
        let mut volume = 0.0;
        let mut buffer = [Vec3::ZERO; MAX_NODES];
        for cell in self.cells() {
            let positions = self.positions_into(cell.nodes, &mut buffer);
            for point in &volume_rule(cell.kind).points {
                let weight = point.weight * cell.kind.jacobian(positions, point.position).determinant();
                moment += cell.kind.position(positions, point.position) * weight;
                volume += weight;
            }
        }
        moment / volume
    }

    /// Means of the nodes of each cell [m].
    pub fn cell_centres(&self) -> Vec<Vec3> {
        let mean = |nodes: &[u32]| {
            nodes.iter().map(|node| self.points[*node as usize]).sum::<Vec3>() / nodes.len() as f64
        };
        self.cells().map(|cell| mean(cell.nodes)).collect()
    }

    /// Connected parts: the part of each cell, parts numbered by their first cell, and how many there are.
    /// Two cells are of one part when a chain of cells that share points joins them.
    pub fn components(&self) -> (Vec<u32>, usize) {
        let mut joined = Sets::new(self.points.len());
        for cell in self.cells() {
            for &node in &cell.nodes[1..] {
                joined.join(cell.nodes[0], node);
            }
        }
        let mut number = vec![u32::MAX; self.points.len()];
        let mut count = 0;
        let mut part_of = |root: u32| {
            let slot = &mut number[root as usize];
            if *slot == u32::MAX {
                *slot = count;
                count += 1;
            }
            *slot
        };
        let parts = self.cells().map(|cell| part_of(joined.of(cell.nodes[0]))).collect();
        (parts, count as usize)
    }
}

/// Curved cells have determinants of a higher degree than their strains.
pub(crate) fn volume_rule(kind: ElementKind) -> &'static QuadratureRule {
    if kind.is_linear() { kind.default_rule() } else { kind.mass_rule() }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An organ in metres is usual, in millimetres it is not; of nothing nothing is said.
    #[test]
    fn lengths_in_millimetres_are_told() {
        let of = |size: f64| BoundingBox::of([Vec3::ZERO, Vec3::new(size, 0.5 * size, 0.2 * size)]).doubt();
        assert!(of(0.2).is_none() && of(4.9).is_none() && of(0.0).is_none() && of(f64::INFINITY).is_none());
        assert!(of(200.0).is_some_and(|doubt| doubt.contains("scale=0.001")));
        assert!(of(1e-6).is_some_and(|doubt| !doubt.contains("scale")));
    }
}
