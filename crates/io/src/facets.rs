//! What surface formats have in common: what they write of a mesh, and how they read polygons.

use souple_math::Vec3;
use souple_mesh::{
    Cell, CutPolygon, ElementKind, MOST_POLYGON_CORNERS, Mesh, cut_polygon, facet_triangles,
    polygon_triangles,
};
use souple_table::in_number;

use crate::cursor::{Cursor, line_of, open_end};
use crate::dataset::Output;
use crate::error::{Fault, Place};

/// Where the facets of a [`SurfacePart`] came from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Origin {
    /// The facets of the mesh, in their order.
    Facets,
    /// The boundary of its cells.
    Boundary,
}

impl Origin {
    /// For the comment at the head of a file.
    pub fn remark(self) -> &'static str {
        match self {
            Self::Facets => "",
            Self::Boundary => ": the boundary of the cells",
        }
    }
}

/// A triangle or a quadrilateral.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Facet {
    corners: [u32; 4],
    count: u8,
}

impl Facet {
    fn new(nodes: &[u32]) -> Self {
        let mut corners = [0; 4];
        corners[..nodes.len()].copy_from_slice(nodes);
        Self { corners, count: nodes.len() as u8 }
    }

    /// A facet as it stands, a curved one as triangles.
    fn of(facet: Cell<'_>) -> Vec<Self> {
        if facet.kind.is_linear() {
            return vec![Self::new(facet.nodes)];
        }
        facet_triangles(facet.kind, facet.nodes).iter().map(|corners| Self::new(corners)).collect()
    }

    pub fn corners(&self) -> &[u32] {
        &self.corners[..usize::from(self.count)]
    }
}

/// A surface with points of its own.
#[derive(Clone, Debug)]
pub(crate) struct SurfacePart {
    pub positions: Vec<Vec3>,
    /// Point of the mesh that each point is.
    pub points: Vec<u32>,
    pub facets: Vec<Facet>,
    pub origin: Origin,
}

impl SurfacePart {
    /// A mesh of facets alone keeps all its points; of one with cells those that the surface uses are kept, in
    /// ascending order.
    pub fn of(output: &Output<'_>) -> Self {
        let mesh = output.mesh;
        let (mut facets, origin): (Vec<Facet>, _) = if mesh.facet_count() > 0 {
            (mesh.facets().flat_map(Facet::of).collect(), Origin::Facets)
        } else {
            let boundary = mesh.boundary_surface();
            let own = |corner: u32| boundary.mesh_points[corner as usize];
            let triangles = boundary.triangles.iter();
            (triangles.map(|corners| Facet::new(&corners.map(own))).collect(), Origin::Boundary)
        };
        let points: Vec<u32> = if mesh.cell_count() == 0 {
            (0..mesh.points.len() as u32).collect()
        } else {
            let mut used: Vec<u32> = facets.iter().flat_map(Facet::corners).copied().collect();
            used.sort_unstable();
            used.dedup();
            used
        };
        let mut number = vec![0; mesh.points.len()];
        for (new, old) in points.iter().enumerate() {
            number[*old as usize] = new as u32;
        }
        for facet in &mut facets {
            let count = usize::from(facet.count);
            facet.corners[..count].iter_mut().for_each(|corner| *corner = number[*corner as usize]);
        }
        let positions = points.iter().map(|point| output.positions()[*point as usize]).collect();
        Self { positions, points, facets, origin }
    }

    /// The facets as triangles.
    pub fn triangles(&self) -> impl Iterator<Item = [u32; 3]> + '_ {
        let position = |corner: u32| self.positions[corner as usize];
        self.facets.iter().flat_map(move |facet| polygon_triangles(facet.corners(), position))
    }
}

/// Puts polygons of any number of corners among the facets of a mesh: one rule for all formats.
#[derive(Clone, Debug, Default)]
pub(crate) struct Polygons {
    /// Corners of the polygon at hand without repetitions.
    distinct: Vec<u32>,
    /// So far.
    count: usize,
    cut: usize,
    /// Of those that were cut, the ones whose triangles overlap, and the number of the first.
    folded: usize,
    first_folded: usize,
    degenerate: usize,
}

impl Polygons {
    /// Corners that coincide with their neighbour make no side and are dropped: a quadrilateral may stand for a triangle. What
    /// is left is a triangle, a quadrilateral, or triangles that cut it; none where it encloses nothing. Returns how many facets
    /// it has become. Points stand before facets in every format; of one that is not there the reader tells.
    pub fn push(&mut self, mesh: &mut Mesh, corners: &[u32]) -> usize {
        let number = self.count;
        self.count += 1;
        let distinct = &mut self.distinct;
        distinct.clear();
        distinct.extend_from_slice(corners);
        distinct.dedup();
        while distinct.len() > 1 && distinct.first() == distinct.last() {
            distinct.pop();
        }
        match distinct.as_slice() {
            [_, _, _] => {
                mesh.push_facet(ElementKind::Tri3, distinct);
                1
            }
            [a, b, c, d] if a != c && b != d => {
                mesh.push_facet(ElementKind::Quad4, distinct);
                1
            }
            [_, _, _, _, _, ..] => {
                let position = |corner: u32| mesh.points.get(corner as usize).copied().unwrap_or(Vec3::ZERO);
                let CutPolygon { triangles, overlaps, .. } = cut_polygon(distinct, position);
                if triangles.is_empty() {
                    self.degenerate += 1;
                    return 0;
                }
                self.cut += 1;
                if overlaps {
                    if self.folded == 0 {
                        self.first_folded = number;
                    }
                    self.folded += 1;
                }
                triangles.iter().for_each(|corners| mesh.push_facet(ElementKind::Tri3, corners));
                triangles.len()
            }
            _ => {
                self.degenerate += 1;
                0
            }
        }
    }

    /// What was not taken as it stands.
    pub fn notes(&self) -> Vec<String> {
        let told = [
            (
                self.cut,
                "polygon of more than four corners was cut into triangles",
                "polygons of more than four corners were cut into triangles",
            ),
            (
                self.degenerate,
                "facet of fewer than three different corners, or folded onto itself, was left out",
                "facets of fewer than three different corners, or folded onto themselves, were left out",
            ),
        ];
        let told = told.into_iter().filter(|(count, ..)| *count > 0);
        let folded = (self.folded > 0).then(|| {
            format!(
                "{} into triangles that overlap, the first is facets[{}]: expected polygons that do not cross themselves, and of more \
                 than {MOST_POLYGON_CORNERS} corners convex ones",
                in_number(self.folded, "polygon was cut", "polygons were cut"),
                self.first_folded
            )
        });
        told.map(|(count, one, many)| in_number(count, one, many)).chain(folded).collect()
    }
}

/// Refuses facets of points that are not there, and a surface without facets.
pub(crate) fn check_facets(cursor: &Cursor<'_>, mesh: &Mesh) -> Result<(), Fault> {
    let count = mesh.points.len();
    for (facet, view) in mesh.facets().enumerate() {
        if let Some(corner) = view.nodes.iter().find(|corner| **corner as usize >= count) {
            let expected = format!("the number of a point: below {count}");
            return Err(cursor.fault(format!("a corner of facet {facet}"), corner.to_string(), expected));
        }
    }
    if mesh.facet_blocks.is_empty() {
        return Err(cursor.fault("the number of facets", "0", "1 or more"));
    }
    Ok(())
}

/// What the end of a text tells of whether it is all of the file: one that ends within a line, with points that no facet has
/// come to use, is cut off; either alone may be meant, and is told.
pub(crate) fn check_end(bytes: &[u8], mesh: &Mesh, notes: &mut Vec<String>) -> Result<(), Fault> {
    let mut is_used = vec![false; mesh.points.len()];
    for facet in mesh.facets() {
        facet.nodes.iter().for_each(|node| is_used[*node as usize] = true);
    }
    let loose = is_used.iter().filter(|used| !**used).count();
    match (open_end(bytes, "the last line"), is_used.iter().position(|used| !used)) {
        (open, None) => notes.extend(open),
        (None, Some(first)) => notes.push(format!(
            "{} in no facet, the first is points[{first}]: a file that is cut off looks like that",
            in_number(loose, "point is", "points are")
        )),
        (Some(_), Some(_)) => {
            let place = Place::Line(line_of(bytes, bytes.len()));
            let loose = in_number(loose, "point is", "points are");
            let subject = format!("the last line has no end, and {loose} in no facet yet: the next facet");
            return Err(Fault::cut_off(place, subject, "facets of all points, and an end of the last line"));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests;
