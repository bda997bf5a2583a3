//! Fills what triangles enclose: mended first, everything said.

use souple_math::Vec3;
use souple_table::four_digits;

use super::{FillError, Options, groups, lost};
use crate::implicit::{Shape, Sign, SurfaceShape};
use crate::repair::{RepairLimits, SurfaceRepairs, components, repair};
use crate::{Group, Mesh, MeshError, TriangleSurface};

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

/// Part of the enclosed volume below which a filling is said to have lost some: cells cut corners off, a twentieth at most
/// where they are fit for the shape.
const KEPT: f64 = 0.95;

/// A surface that measures less than this along an axis, relative to its greatest length, is flat: rounding of coordinates with
/// seven digits.
const FLAT: f64 = 1e-7;

/// Share of its inside that a surface may leave undefined: of a ball without a quarter of its surface that is a third, of half a
/// ball more than all of it.
const UNDEFINED: f64 = 0.6;
/// Above this it is said.
const UNDEFINED_SAID: f64 = 0.02;

/// Mends a surface and fills it.
///
/// # Errors
/// There is no triangle, or nothing that they enclose; as [`fill`](super::fill).
pub fn fill_surface(
    surface: &TriangleSurface,
    limits: RepairLimits,
    options: &Options,
) -> Result<FilledSurface, MeshError> {
    Ok(filled(surface, limits, options)?.0)
}

/// Turns what of a surface is open, where it faces inward as a whole, as loose triangles may: it has no inside of its own, but to
/// fill it means that it has one. Closed parts know theirs.
fn turn_open_outward(surface: &mut TriangleSurface) -> Option<String> {
    let (parts, count) = components(surface);
    let mut part_of_point = vec![0; surface.points.len()];
    for (corners, part) in surface.triangles.iter().zip(&parts) {
        corners.iter().for_each(|point| part_of_point[*point as usize] = *part as usize);
    }
    let mut is_open = vec![false; count];
    for ([point, _], up, down) in surface.edge_uses() {
        is_open[part_of_point[point as usize]] |= up + down == 1;
    }
    let of_triangle = surface.triangles.iter().zip(&parts);
    let open =
        of_triangle.filter(|(_, part)| is_open[**part as usize]).map(|(corners, _)| *corners).collect();
    let open = TriangleSurface { triangles: open, ..surface.clone() };
    if open.triangles.is_empty() || open.enclosed_volume() >= 0.0 {
        return None;
    }
    let of_triangle = surface.triangles.iter_mut().zip(&parts);
    of_triangle.filter(|(_, part)| is_open[**part as usize]).for_each(|(corners, _)| corners.swap(1, 2));
    Some("what of the surface is open faced inward, and was turned".to_owned())
}

/// The filling, and the shape that the mended surface encloses.
fn filled(
    surface: &TriangleSurface,
    limits: RepairLimits,
    options: &Options,
) -> Result<(FilledSurface, SurfaceShape), MeshError> {
    let (mut mended, repairs) = repair(surface, limits);
    if mended.triangles.is_empty() {
        return Err(FillError::NoArea { triangles: surface.triangles.len() }.into());
    }
    let mut notes = repairs.messages();
    notes.extend(turn_open_outward(&mut mended));
    let enclosed = mended.enclosed_volume().abs();
    let extent = mended.bounds().size();
    if extent.to_array().iter().any(|length| *length <= FLAT * extent.largest_component()) {
        return Err(FillError::Flat { extent: extent.to_array() }.into());
    }
    let shape = SurfaceShape::new(mended.clone())?;
    let undefined = shape.undefined_share();
    if undefined > UNDEFINED {
        let causes = shape.diagnosis().messages();
        return Err(FillError::Undefined { share: undefined.min(1.0), causes }.into());
    }
    if undefined > UNDEFINED_SAID {
        let percent = 100.0 * undefined;
        notes.push(format!(
            "the inside is not certain around holes, crossings or loose sheets: {percent:.0} % of it is by a winding \
             number that is no whole one"
        ));
    }
    if shape.sign() == Sign::WindingNumber {
        notes.extend(shape.diagnosis().messages());
        notes
            .push("the surface is not simple: its inside is where it winds around more than half".to_owned());
    }
    let (mesh, size) = options.cells_of(&shape, &[])?;
    let lost = lost::of_surface(&mended, &shape, &size, &mesh);
    if lost.is_empty() {
        notes.extend(lost_reach(&shape, &mesh));
    }
    notes.extend(lost);
    notes.extend(options.unmet(&size, &mesh));
    let volume = mesh.volume();
    if volume < KEPT * enclosed {
        let percent = 100.0 * volume / enclosed;
        notes.push(format!(
            "the filling holds {} m³ of the {} m³ that the surface encloses, {percent:.0} %: {}",
            four_digits(volume),
            four_digits(enclosed),
            if shape.sign() == Sign::WindingNumber {
                "parts that overlap count once, and what is thinner than its cells is lost"
            } else {
                lost::REMEDY
            }
        ));
    }
    Ok((FilledSurface { mesh, repairs, notes }, shape))
}

/// Part of a surface's extent that a filling may not reach without a word: cells cut off what is thinner than they are.
const REACHED: f64 = 0.9;

/// What to say where a whole end of the surface is not filled.
fn lost_reach(shape: &SurfaceShape, mesh: &Mesh) -> Option<String> {
    let (wanted, found) = (shape.bounds().size().to_array(), mesh.bounds().size().to_array());
    let axis = (0..3).find(|axis| found[*axis] < REACHED * wanted[*axis])?;
    Some(format!(
        "the filling is {} m long along {}, where the surface is {} m: ends that are thinner than its cells, or around \
         which the surface does not wind, are not filled",
        four_digits(found[axis]),
        ["x", "y", "z"][axis],
        four_digits(wanted[axis])
    ))
}

/// Fills the surface of a mesh and carries its groups along.
///
/// # Errors
/// The mesh has neither facets nor cells; as [`fill_surface`].
pub fn fill_mesh(mesh: &Mesh, limits: RepairLimits, options: &Options) -> Result<FilledSurface, MeshError> {
    let surface = surface_of(mesh).ok_or(MeshError::NoCells)?;
    let (mut filled, shape) = filled(&surface, limits, options)?;
    let outward = groups::outward_areas(&surface, &shape);
    filled.notes.extend(groups::carry(mesh, &surface, &outward, &mut filled.mesh));
    Ok(filled)
}

/// Carries the groups of a mesh of volumes to another of the same body, which has none. A group too small for any cell or face of it
/// is of the points there that are nearest to its own.
pub(crate) fn carry_groups(source: &Mesh, target: &mut Mesh) {
    let surface = source.boundary_surface();
    let outward: Vec<Vec3> = (0..surface.triangles.len() as u32).map(|t| surface.area_vector(t)).collect();
    let points = target.boundary_surface().mesh_points;
    target.groups.insert(groups::SURFACE.to_owned(), Group { points, ..Group::default() });
    groups::carry(source, &surface, &outward, target);
    for (name, group) in &source.groups {
        if target.groups.contains_key(name) {
            continue;
        }
        let nearest = |point: &u32| {
            let distance =
                |other: &u32| (target.points[*other as usize] - source.points[*point as usize]).length_sq();
            (0..target.points.len() as u32).min_by(|a, b| distance(a).total_cmp(&distance(b)))
        };
        let mut points: Vec<u32> = group.points.iter().filter_map(nearest).collect();
        points.sort_unstable();
        points.dedup();
        target.groups.insert(name.clone(), Group { points, ..Group::default() });
    }
}
