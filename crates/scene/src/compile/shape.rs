//! From a mesh specification to a mesh that has passed every check, placed where the body starts.

use souple_mesh::fill::{FillError, fill_mesh};
use souple_mesh::repair::RepairLimits;
use souple_mesh::{Mesh, MeshError, MeshSize};
use souple_table::in_number;

use super::{Draft, memory, tissue};
use crate::diagnostic::{Code, Site};
use crate::spec::body::Body;
use crate::spec::mesh::MeshSpec;
use crate::spec::split::SplitSpec;

/// The rest shape of a body.
pub struct Shape {
    pub mesh: Mesh,
    /// The number that each point had in its file, ascending.
    pub point_numbers: Vec<u32>,
    /// How many points were numbered there, those too that no cell has.
    pub numbered: u32,
    pub warnings: Vec<String>,
}

/// Points of a plane body lie in one plane up to this part of its size: rounding of files in single precision.
const FLAT: f64 = 1e-6;

/// Least size of a body, as a part of its distance from the origin: positions keep a millionth of it then.
const NEAREST: f64 = 1e-10;

/// The mesh of a body, split where that is asked for; `None` where it was refused.
pub fn build(body: &Body, draft: &Draft) -> Option<Shape> {
    let shape = build_of(body, body.mesh.as_ref()?, draft)?;
    match &body.split {
        Some(split) => split_shape(shape, body, split, draft),
        None => Some(shape),
    }
}

/// A shape of smaller tetrahedra; new points have the numbers after those of its file.
fn split_shape(shape: Shape, body: &Body, split: &SplitSpec, draft: &Draft) -> Option<Shape> {
    let Shape { mut mesh, mut point_numbers, numbered, warnings } = shape;
    let size = MeshSize { points: mesh.points.len() as u64, cells: mesh.cell_count() as u64 };
    if memory::is_too_large(body, split.least_size(size), draft) {
        return None;
    }
    for _ in 0..split.times {
        mesh = match mesh.split(split.by) {
            Ok(mesh) => mesh,
            Err(error @ MeshError::TooManyCells { .. }) => {
                draft.log.add(Code::TooLarge, &split.site, error.to_string(), "fewer `times`");
                return None;
            }
            Err(error) => {
                let (message, accepted) = error.in_two();
                let accepted = accepted.as_deref().unwrap_or("a mesh of tetrahedra");
                draft.log.add(Code::Mesh, &split.site, message, accepted);
                return None;
            }
        };
    }
    let new = mesh.points.len() - point_numbers.len();
    point_numbers.extend((numbered..).take(new));
    Some(Shape { mesh, point_numbers, numbered: numbered + new as u32, warnings })
}

/// One of the meshes of a body; `None` where it was refused.
pub fn build_of(body: &Body, spec: &MeshSpec, draft: &Draft) -> Option<Shape> {
    let (site, log) = (spec.site(), draft.log);
    let refuse = |message: String, expected: &str| {
        log.add(Code::Mesh, site, message, expected);
        None
    };
    let mut warnings = Vec::new();
    let mut mesh = match spec {
        MeshSpec::Tissue(tissue) => tissue::build(body, tissue, draft)?,
        _ => mesh_of(spec, &body.name, draft, &mut warnings)?,
    };
    let section = body.section();
    if mesh.cell_count() == 0 && section.dimension() == 2 {
        mesh = mesh.facets_as_cells();
    }
    let repairs = match mesh.validate() {
        Ok(repairs) => repairs,
        Err(error) => return refuse(error.to_string(), "a mesh that can be computed on"),
    };
    if mesh.dimension() != section.dimension() {
        let kind =
            mesh.blocks.iter().find(|block| !block.is_empty()).map_or("none", |block| block.kind.name());
        let section = body.section.as_ref().map_or("solid", |chosen| chosen.entry.name);
        let message =
            format!("the cells are {kind}, of dimension {}; the body is a {section}", mesh.dimension());
        return refuse(
            message,
            match mesh.dimension() {
                1 => "`section = { name = \"bar\", area = … }` or a cable, or a mesh of volume cells",
                2 => {
                    "`section = { name = \"plane_stress\", thickness = … }`, plane_strain or membrane, or volume cells"
                }
                _ => "no `section` for volume cells",
            },
        );
    }
    let said = |message: String| format!("body `{}`: {message}", body.name);
    warnings.extend(repairs.messages().into_iter().map(said));
    // what generators make of one kind of cells conforms by their own tests
    if matches!(spec, MeshSpec::File { .. }) || mesh.blocks.len() > 1 {
        let found = mesh.conformity();
        if let Some(message) = found.overlap(&repairs.rewound_cells) {
            return refuse(
                message,
                "cells on both sides of each face: a point moved through a face is moved back",
            );
        }
        warnings.extend(found.messages(&mesh).into_iter().map(said));
    }
    drop_facets_of_loose_points(&mut mesh);
    // points without mass would fall through every law: they go, and the others keep their numbers in the scene
    let numbered = mesh.points.len() as u32;
    let point_numbers = mesh.remove_loose_points();
    let size = mesh.bounds().diagonal();
    mesh.points.iter_mut().for_each(|point| *point = body.placement.place(*point));
    let farthest = mesh.points.iter().flat_map(|point| point.to_array()).map(f64::abs).fold(0.0, f64::max);
    if farthest * NEAREST > size || mesh.points.iter().any(|point| !point.is_finite()) {
        let message = format!(
            "placed {farthest:.3e} m from the origin, this body of {size:.3e} m is lost in the rounding of its positions"
        );
        log.add(Code::Mesh, &body.placement.site, message, "a place nearer to the origin");
        return None;
    }
    if section.is_plane() {
        let bounds = mesh.bounds();
        if bounds.size().z > FLAT * bounds.diagonal() {
            let message =
                format!("the points of this plane body go from z = {} to {} m", bounds.low.z, bounds.high.z);
            return refuse(message, "points of one z: plane bodies lie in a plane of constant z");
        }
        let turned = mesh.face_up();
        if let Some(first) = turned.first() {
            let count = in_number(turned.len(), "cell seen from below was", "cells seen from below were");
            warnings.push(said(format!("{count} turned, the first is cells[{first}]")));
        }
    }
    Some(Shape { mesh, point_numbers, numbered, warnings })
}

/// A mesh as it is made or read, of the body of this name; `None` where it was refused.
pub fn mesh_of(spec: &MeshSpec, body: &str, draft: &Draft, warnings: &mut Vec<String>) -> Option<Mesh> {
    let (site, log) = (spec.site(), draft.log);
    let built = match spec {
        MeshSpec::Generated(chosen) => (chosen.entry.build.mesh)(&chosen.values),
        MeshSpec::Shape { shape, options } => {
            let filled = (shape.entry.build)(&shape.values).and_then(|body| options.fill_body(&body));
            filled.map(|filled| {
                warnings.extend(filled.notes.into_iter().map(|note| format!("body `{body}`: {note}")));
                filled.mesh
            })
        }
        MeshSpec::Tissue(_) => {
            let message = "tissue is the mesh of a body of its own, which it attaches".to_owned();
            log.add(Code::Conflict, site, message, "`generate`, `file`, `shape` or `fill`");
            return None;
        }
        MeshSpec::File { file, scale, .. } => Ok(of_file(draft, spec.site(), file, *scale, warnings)?),
        MeshSpec::Filled { file, scale, options, .. } => {
            let mesh = of_file(draft, spec.site(), file, *scale, warnings)?;
            fill_mesh(&mesh, RepairLimits::default(), options).map(|filled| {
                warnings.extend(filled.notes.into_iter().map(|note| format!("{file}: {note}")));
                filled.mesh
            })
        }
    };
    match built {
        Ok(mesh) => Some(mesh),
        Err(error @ (MeshError::TooManyCells { .. } | MeshError::Fill(FillError::TooManyPoints { .. }))) => {
            log.add(Code::TooLarge, spec.site_of("cells"), error.to_string(), "fewer cells");
            None
        }
        Err(MeshError::Parameter { name, value, expected }) => {
            let message = format!("`{name}` is {value}, of which no mesh can be made");
            log.add(Code::Mesh, spec.site_of(name), message, expected);
            None
        }
        Err(error) => {
            let (message, accepted) = error.in_two();
            log.add(Code::Mesh, site, message, accepted.as_deref().unwrap_or("a mesh that can be made"));
            None
        }
    }
}

/// The mesh of a file; `None` where it was refused.
pub fn of_file(
    draft: &Draft,
    site: &Site,
    file: &str,
    scale: f64,
    warnings: &mut Vec<String>,
) -> Option<Mesh> {
    let read = match draft.sources.text_at_hand(site.place.source, file) {
        Some((path, text)) => Ok(souple_io::read_mesh_content(&path, text.as_bytes())),
        None => draft.sources.open(site.place.source, file).map(|path| souple_io::read_mesh(&path)),
    };
    let read = match read {
        Ok(read) => read,
        Err(error) => {
            let path = draft.sources.get(site.place.source).folder.join(file);
            let (code, message) = match error.kind() {
                std::io::ErrorKind::NotFound => {
                    (Code::NotFound, format!("there is no file `{}`", path.display()))
                }
                _ => (Code::Unreadable, format!("`{}` cannot be read: {error}", path.display())),
            };
            draft.log.add(code, site, message, "an existing mesh file");
            return None;
        }
    };
    match read {
        Ok((mut mesh, notes)) => {
            warnings.extend(notes.into_iter().map(|note| format!("{file}: {note}")));
            mesh.points.iter_mut().for_each(|point| *point = *point * scale);
            Some(mesh)
        }
        Err(error) => {
            draft.log.add(Code::Mesh, site, error.to_string(), "a complete mesh");
            None
        }
    }
}

/// Facets on points that no cell uses would keep those points: all facets go then, and their groups keep the
/// points of the facets.
fn drop_facets_of_loose_points(mesh: &mut Mesh) {
    let loose = mesh.loose_points();
    let is_loose = |node: &u32| loose.binary_search(node).is_ok();
    if !mesh.facets().any(|facet| facet.nodes.iter().any(is_loose)) {
        return;
    }
    let nodes: Vec<Vec<u32>> = mesh.facets().map(|facet| facet.nodes.to_vec()).collect();
    for group in mesh.groups.values_mut() {
        let facets = std::mem::take(&mut group.facets);
        group.points.extend(facets.iter().flat_map(|facet| &nodes[*facet as usize]));
        group.points.sort_unstable();
        group.points.dedup();
    }
    mesh.facet_blocks.clear();
}
