//! From a mesh specification to a mesh that has passed every check, placed where the body starts.

use std::path::PathBuf;

use sha2::{Digest, Sha256};
use souple_mesh::{Mesh, MeshError};

use crate::diagnostic::{Code, Log};
use crate::source::Sources;
use crate::spec::body::{Body, MeshSpec};

/// The rest shape of a body.
pub struct Shape {
    pub mesh: Mesh,
    /// The number that each point had in its file, ascending.
    pub point_numbers: Vec<u32>,
    pub warnings: Vec<String>,
}

/// The mesh of a body; `None` where it was refused.
pub fn build(body: &Body, sources: &Sources, hash: &mut Sha256, log: &Log) -> Option<Shape> {
    let spec = body.mesh.as_ref()?;
    let site = spec.site();
    let refuse = |message: String, expected: &str| {
        log.add(Code::Mesh, site, message, expected);
        None
    };
    let mut warnings = Vec::new();
    let mut mesh = match spec {
        MeshSpec::Generated(chosen) => match (chosen.entry.build)(&chosen.values) {
            Ok(mesh) => mesh,
            Err(error @ MeshError::TooManyCells { .. }) => {
                log.add(Code::TooLarge, site, error.to_string(), "fewer cells");
                return None;
            }
            Err(error) => return refuse(error.to_string(), "a mesh that can be made"),
        },
        MeshSpec::File { file, scale, .. } => {
            let path: PathBuf = sources.get(site.place.source).folder.join(file);
            if !path.exists() {
                log.add(
                    Code::NotFound,
                    site,
                    format!("there is no file `{}`", path.display()),
                    "an existing mesh file",
                );
                return None;
            }
            if let Ok(bytes) = std::fs::read(&path) {
                hash.update(&bytes);
            }
            let (mut mesh, notes) = match souple_io::read_mesh(&path) {
                Ok(read) => read,
                Err(error) => return refuse(error.to_string(), "a complete mesh of volume cells"),
            };
            warnings.extend(notes.into_iter().map(|note| format!("{file}: {note}")));
            mesh.points.iter_mut().for_each(|point| *point = *point * *scale);
            mesh
        }
    };
    let repairs = match mesh.validate() {
        Ok(repairs) => repairs,
        Err(error) => return refuse(error.to_string(), "a mesh that can be computed on"),
    };
    warnings.extend(repairs.messages().into_iter().map(|message| format!("body `{}`: {message}", body.name)));
    drop_facets_of_loose_points(&mut mesh);
    // points without mass would fall through every law: they go, and the others keep their numbers in the scene
    let point_numbers = mesh.remove_loose_points();
    mesh.points.iter_mut().for_each(|point| *point = body.placement.place(*point));
    if mesh.points.iter().any(|point| !point.is_finite()) {
        return refuse(
            "placed, the mesh has points that are not finite".to_owned(),
            "a smaller scale or translation",
        );
    }
    Some(Shape { mesh, point_numbers, warnings })
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
