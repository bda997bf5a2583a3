//! Whether a scene fits into the memory of the machine: asked before anything large is made, since a system that runs
//! out of memory ends the program without a word.
//!
//! The estimate counts what every scene of that size needs, and no more: it refuses what cannot fit, and lets pass
//! what may. Contacts, factors of direct solvers and pictures come on top.

use souple_mesh::{MeshSize, available_memory, gigabytes};

use super::Draft;
use super::bodies::Placed;
use super::network::size as network_size;
use crate::diagnostic::{Code, Log, Site};
use crate::source::Sources;
use crate::spec::Spec;
use crate::spec::body::Body;
use crate::spec::mesh::MeshSpec;

/// Vectors of three numbers that a point has: configuration and velocity of two states, four of rows, twelve of
/// steppers, rest positions of two meshes.
const VECTORS_OF_POINT: u64 = 22;
/// The same of implicit steppers: forces, residuals and directions of Newton's method and of its solver.
const VECTORS_OF_IMPLICIT_POINT: u64 = 12;
const VECTOR: u64 = 24;
/// Blocks in a row of the matrix, at least: a point of a regular mesh of tetrahedra and its fourteen neighbours.
const BLOCKS_OF_ROW: u64 = 15;
/// A block of 3×3 numbers with its column; once in the matrix, once in what preconditions it.
const BLOCK: u64 = 2 * (72 + 4);
/// What a tetrahedron, the smallest cell, has: nodes in two meshes, gradients, volume and law, places and forces of
/// its corners.
const CELL: u64 = 250;
/// What a link has: its ends in two lists and as a cell of two meshes, two lengths; with its force, its ends and length
/// once more, and where it stands in four orders.
const LINK: u64 = 80;
/// What a pair of a crowd has, in a list by either ball and as a force; what it remembers comes on top.
const PAIR: u64 = 2 * size_of::<u32>() as u64 + VECTOR;
/// Links are told apart by 32 bits.
const LINKS_MAX: u64 = 500_000_000;

/// What a body needs.
struct Needs<'a> {
    body: &'a str,
    site: &'a Site,
    bytes: u64,
    /// How large it is, in words.
    size: String,
    /// What to have less of.
    of: &'static str,
}

impl<'a> Needs<'a> {
    fn of_network(body: &'a Body, size: MeshSize, spec: &Spec) -> Self {
        Self {
            body: &body.name,
            site: &body.site,
            bytes: bytes_of(size, LINK, matrix_of(spec, &body.system)),
            size: format!("{} masses and at least {} links", size.points, size.cells),
            of: "masses and links",
        }
    }
}

/// Bytes of what a frame has to say at a point.
const SHARE: u64 = 16;
/// Bytes of the place of a pair of frames in a matrix.
const PLACE: u64 = 4;
/// Points that share such places.
const POINTS_OF_BLOCK: u64 = 8;

/// Whether the stepper of a body stores a matrix.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Matrix {
    Stored,
    None,
}

/// Refuses generated meshes, and files, that cannot fit, before they are made.
pub fn check_specified(spec: &Spec, sources: &Sources, log: &Log) {
    let needs = spec.bodies.iter().filter_map(|body| {
        if let Some(network) = &body.network {
            return Some(Needs::of_network(body, network_size(network), spec));
        }
        let mesh = body.mesh.as_ref()?;
        let (bytes, size) = match mesh {
            MeshSpec::Generated(chosen) => {
                let size = (chosen.entry.build.size)(&chosen.values).ok()?;
                let size = body.split.as_ref().map_or(size, |split| split.least_size(size));
                (bytes_of(size, CELL, matrix_of(spec, &body.system)), counts(size))
            }
            // no more is known of a file than that it is read as a whole
            MeshSpec::File { file, site, .. } | MeshSpec::Filled { file, site, .. } => {
                let path = sources.place_of(site.place.source, file);
                let bytes = std::fs::metadata(path).ok()?.len();
                (bytes, format!("a file of {}", gigabytes(bytes)))
            }
            // fillings bound the number of their points by themselves, and are counted when they are made; so is tissue
            MeshSpec::Shape { .. } | MeshSpec::Tissue(_) => return None,
        };
        Some(Needs { body: &body.name, site: mesh.site(), bytes, size, of: "cells" })
    });
    check(&needs.collect::<Vec<_>>(), available_memory(), log);
}

/// The same when all is known of the meshes, before forces and matrices are made.
pub fn check_placed(spec: &Spec, bodies: &[Placed], log: &Log) {
    let needs = bodies.iter().map(|body| {
        let mesh = &body.mesh;
        let size = MeshSize { points: mesh.points.len() as u64, cells: mesh.cell_count() as u64 };
        if body.spec.network.is_some() {
            return Needs::of_network(body.spec, size, spec);
        }
        Needs {
            body: &body.spec.name,
            site: body.spec.mesh.as_ref().map_or(&body.spec.site, MeshSpec::site),
            bytes: bytes_of(size, CELL, matrix_of(spec, &body.spec.system))
                .saturating_add(bytes_of_frames(body)),
            size: counts(size),
            of: "cells",
        }
    });
    check(&needs.collect::<Vec<_>>(), available_memory(), log);
}

/// Whether a body whose cells are about to be split cannot fit as large as it becomes at least, which is reported.
pub fn is_too_large(body: &Body, size: MeshSize, draft: &Draft) -> bool {
    let needs = Needs {
        body: &body.name,
        site: body.split.as_ref().map_or(&body.site, |split| &split.site),
        bytes: bytes_of(size, CELL, matrix_of(draft.spec, &body.system)),
        size: counts(size),
        of: "cells",
    };
    check(&[needs], available_memory(), draft.log)
}

/// What frames need at the points of a body: four numbers of each frame that reaches a point, and a place in the matrix for each pair
/// of them, which eight points share.
fn bytes_of_frames(body: &Placed) -> u64 {
    let Some(frames) = &body.frames else { return 0 };
    let reach = frames.carried.iter().map(|carried| carried.frames.len() as u64);
    reach.map(|count| count * SHARE + count * count * PLACE / POINTS_OF_BLOCK).sum()
}

/// Links for which there is memory.
pub fn links_that_fit() -> usize {
    available_memory().map_or(LINKS_MAX, |bytes| LINKS_MAX.min(bytes / LINK)) as usize
}

/// Pairs of a crowd for which there is memory.
pub fn pairs_that_fit() -> usize {
    available_memory().map_or(u64::MAX, |bytes| bytes / PAIR) as usize
}

/// What a body of that size needs at least, with so many bytes for each cell [bytes].
fn bytes_of(size: MeshSize, cell: u64, matrix: Matrix) -> u64 {
    let of_point = match matrix {
        Matrix::None => VECTORS_OF_POINT * VECTOR,
        Matrix::Stored => (VECTORS_OF_POINT + VECTORS_OF_IMPLICIT_POINT) * VECTOR + BLOCKS_OF_ROW * BLOCK,
    };
    size.points.saturating_mul(of_point).saturating_add(size.cells.saturating_mul(cell))
}

fn counts(size: MeshSize) -> String {
    format!("{} points and about {} cells", size.points, size.cells)
}

/// Whether it is too much, which is reported.
fn check(needs: &[Needs], available: Option<u64>, log: &Log) -> bool {
    let total = needs.iter().fold(0_u64, |sum, needs| sum.saturating_add(needs.bytes));
    let (Some(largest), Some(available)) = (needs.iter().max_by_key(|needs| needs.bytes), available) else {
        return false;
    };
    if total <= available {
        return false;
    }
    let message = format!(
        "the scene needs at least {} of memory, and {} are available on this machine; the largest body is `{}`: {}",
        gigabytes(total),
        gigabytes(available),
        largest.body,
        largest.size
    );
    let expected = format!("fewer {}, or an explicit stepper, which stores no matrix", largest.of);
    log.add(Code::TooLarge, largest.site, message, expected);
    true
}

/// Implicit steppers store a matrix, unless they are told to do without.
fn matrix_of(spec: &Spec, system: &str) -> Matrix {
    let stepper = spec.systems.iter().find(|candidate| candidate.name == system);
    let stepper = stepper.and_then(|system| system.stepper.as_ref());
    match stepper.and_then(|chosen| chosen.values.get("matrix_free")) {
        Some(souple_table::Value::Boolean(false)) => Matrix::Stored,
        _ => Matrix::None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::Source;

    /// What fits passes; what does not is refused with both figures and the largest body.
    #[test]
    fn what_does_not_fit_is_refused() {
        let site = Site::default();
        let needs = |body, points, matrix| {
            let size = MeshSize { points, cells: 5 * points };
            Needs { body, site: &site, bytes: bytes_of(size, CELL, matrix), size: counts(size), of: "cells" }
        };
        let explicit = needs("small", 1000, Matrix::None);
        assert_eq!(explicit.bytes, 1000 * 22 * 24 + 5000 * 250);
        let scene = [explicit, needs("large", 10_000_000, Matrix::Stored)];
        let faults = |available| {
            let log = Log::default();
            check(&scene, available, &log);
            let mut sources = Sources::default();
            sources.add(Source { name: "x".into(), folder: "".into(), text: String::new() });
            log.into_diagnostics(&sources).0
        };
        assert!(faults(None).is_empty() && faults(Some(1 << 40)).is_empty());
        let refused = faults(Some(8_000_000_000));
        assert_eq!((refused.len(), refused[0].code), (1, Code::TooLarge));
        for words in ["needs at least 43.5 GB", "8.0 GB are available", "`large`", "10000000 points"] {
            assert!(refused[0].message.contains(words), "{}", refused[0].message);
        }
    }
}
