//! Names of the parts of a surface, carried onto its filling.

use std::collections::BTreeSet;

use souple_math::Vec3;

use crate::boundary::BoundaryFace;
use crate::implicit::Shape;
use crate::surface::closest_point_on_triangle;
use crate::tree::{Aabb, AabbTree};
use crate::{CellLocator, Group, Mesh, TriangleSurface};

/// The group that every filling has.
pub(super) const SURFACE: &str = "surface";

/// Areas of the triangles [m²], turned to where the shape that they enclose is not: a file may wind them either way.
pub(super) fn outward_areas(surface: &TriangleSurface, shape: &dyn Shape) -> Vec<Vec3> {
    let outward = |triangle: u32| {
        let area = surface.area_vector(triangle);
        let centre = surface.corners(triangle).into_iter().sum::<Vec3>() / 3.0;
        let aside = area.try_normalised().unwrap_or(Vec3::ZERO) * (ASIDE * area.length().sqrt());
        if shape.value(centre + aside) < shape.value(centre - aside) { -area } else { area }
    };
    (0..surface.triangles.len() as u32).map(outward).collect()
}

/// How far beside a triangle its sides are looked at, in its size.
const ASIDE: f64 = 1e-3;

/// Gives a filling the groups of the mesh whose `surface` it fills: a face of the filling belongs to those of the nearest
/// triangle that looks the same way, with its points; a cell to those of the cell of the mesh where its centre lies.
/// Returns a line for each group that cannot be carried.
pub(super) fn carry(
    source: &Mesh,
    surface: &TriangleSurface,
    outward: &[Vec3],
    filling: &mut Mesh,
) -> Vec<String> {
    let mut notes = Vec::new();
    let groups: Vec<(&String, &Group)> = source.groups.iter().filter(|(name, _)| *name != SURFACE).collect();
    if groups.len() < source.groups.len() {
        notes.push(format!(
            "the group `{SURFACE}` of the file is not kept: the filling's own holds all its surface"
        ));
    }
    if groups.is_empty() {
        return notes;
    }
    let faces = nearest_triangles(surface, outward, filling);
    let cells = cells_below(source, filling);
    for (name, group) in groups {
        let is_in = triangles_of(source, surface, group);
        let mut carried = Group::default();
        for (face, triangle) in &faces {
            if is_in[*triangle as usize] {
                let Some(cell) = filling.cell(face.cell) else { continue };
                let (kind, nodes) = cell.face_nodes(face.face.into());
                let nodes: Vec<u32> = nodes.collect();
                carried.facets.push(filling.facet_count() as u32);
                carried.points.extend(&nodes);
                filling.push_facet(kind, &nodes);
            }
        }
        for (cell, below) in cells.iter().enumerate() {
            if below.is_some_and(|below| group.cells.binary_search(&below).is_ok()) {
                carried.cells.push(cell as u32);
                carried.points.extend(filling.cell(cell as u32).iter().flat_map(|view| view.nodes));
            }
        }
        carried.points.sort_unstable();
        carried.points.dedup();
        if carried.points.is_empty() {
            notes.push(format!("the group `{name}` reaches no face of the filling; take a smaller size"));
        } else {
            filling.groups.insert(name.clone(), carried);
        }
    }
    notes
}

/// The faces of the filling's boundary, each with the triangle it stands for.
fn nearest_triangles(
    surface: &TriangleSurface,
    outward: &[Vec3],
    filling: &Mesh,
) -> Vec<(BoundaryFace, u32)> {
    let count = surface.triangles.len() as u32;
    let tree = AabbTree::build(&(0..count).map(|t| Aabb::of(surface.corners(t))).collect::<Vec<_>>());
    let nearest = |face: &BoundaryFace| {
        let corners: Vec<Vec3> = filling
            .cell(face.cell)?
            .face_corners(face.face.into())
            .map(|node| filling.points[node as usize])
            .collect();
        let centre = corners.iter().copied().sum::<Vec3>() / corners.len() as f64;
        let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
        // the other side of what is thin may be nearer than this one
        let distance_sq = |triangle: u32| {
            if outward[triangle as usize].dot(normal) <= 0.0 {
                return f64::INFINITY;
            }
            let triangle = surface.corners(triangle);
            let (weights, _) = closest_point_on_triangle(centre, triangle);
            let at = triangle[0] * weights[0] + triangle[1] * weights[1] + triangle[2] * weights[2];
            (centre - at).length_sq()
        };
        let (triangle, distance) = tree.nearest(centre, f64::INFINITY, distance_sq)?;
        distance.is_finite().then_some(triangle)
    };
    let faces = filling.faces().boundary.into_iter();
    faces.filter_map(|face| nearest(&face).map(|triangle| (face, triangle))).collect()
}

/// For each cell of the filling, the cell of a volume mesh at its centre.
fn cells_below(source: &Mesh, filling: &Mesh) -> Vec<Option<u32>> {
    if source.groups.values().all(|group| group.cells.is_empty()) {
        return Vec::new();
    }
    let locator = CellLocator::new(source);
    filling.cell_centres().into_iter().map(|centre| Some(locator.carrier(centre)?.cell)).collect()
}

/// Which triangles of a mesh's surface belong to a group: those of its facets; where a mesh has cells, or a group points
/// alone, those with all corners among its points.
fn triangles_of(source: &Mesh, surface: &TriangleSurface, group: &Group) -> Vec<bool> {
    if source.cell_count() == 0 && !group.facets.is_empty() {
        return surface.cells.iter().map(|facet| group.facets.binary_search(facet).is_ok()).collect();
    }
    let of_facets =
        source.facets().enumerate().filter(|(facet, _)| group.facets.binary_search(&(*facet as u32)).is_ok());
    let of_facets = of_facets.flat_map(|(_, view)| view.nodes.iter().copied());
    let own = if group.cells.is_empty() { &group.points[..] } else { &[] };
    let points: BTreeSet<u32> = own.iter().copied().chain(of_facets).collect();
    let is_in = |corner: u32| points.contains(&surface.mesh_points[corner as usize]);
    surface.triangles.iter().map(|corners| corners.iter().all(|corner| is_in(*corner))).collect()
}
