//! What the tests of this crate share: folders that vanish, a mesh with everything in it.

use std::path::{Path, PathBuf};

use souple_math::Vec3;
use souple_mesh::{ElementKind, Group, Mesh};

use crate::{Dataset, Fault};

/// A folder of its own that is removed when dropped.
pub(crate) struct TemporaryFolder(PathBuf);

impl TemporaryFolder {
    pub fn new(name: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("souple-io-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("the folder of temporary files can be written to");
        Self(folder)
    }

    pub fn path(&self, name: impl AsRef<Path>) -> PathBuf {
        self.0.join(name)
    }
}

impl Drop for TemporaryFolder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// A hexahedron, a pyramid on it, a prism and a tetrahedron beside it, two facets, three groups.
pub(crate) fn mixed_mesh() -> Mesh {
    let points = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        [1.0, 0.0, 1.0],
        [1.0, 1.0, 1.0],
        [0.0, 1.0, 1.0],
        [0.5, 0.5, 1.7],
        [2.0, 0.1, 1.0 / 3.0],
        [2.0, 0.9, 0.3],
        [2.0, 0.5, -1e-7],
    ];
    let mut mesh = Mesh { points: points.map(Vec3::from_array).to_vec(), ..Mesh::default() };
    mesh.push_cell(ElementKind::Hex8, &[0, 1, 2, 3, 4, 5, 6, 7]);
    mesh.push_cell(ElementKind::Pyramid5, &[4, 5, 6, 7, 8]);
    mesh.push_cell(ElementKind::Prism6, &[1, 5, 9, 2, 6, 10]);
    mesh.push_cell(ElementKind::Tet4, &[1, 2, 9, 11]);
    mesh.push_cell(ElementKind::Tet4, &[2, 10, 9, 11]);
    mesh.push_facet(ElementKind::Quad4, &[0, 3, 2, 1]);
    mesh.push_facet(ElementKind::Tri3, &[4, 5, 8]);
    let group = |points: &[u32], cells: &[u32], facets: &[u32]| Group {
        points: points.to_vec(),
        cells: cells.to_vec(),
        facets: facets.to_vec(),
    };
    mesh.groups.insert("clamped".into(), group(&[0, 3], &[], &[0]));
    mesh.groups.insert("soft & warm".into(), group(&[], &[0, 1], &[]));
    mesh.groups.insert("tail".into(), group(&[], &[2, 3, 4], &[1]));
    mesh
}

/// The cells and facets of [`mixed_mesh`] raised to quadratic ones, middles of edges off the straight line.
pub(crate) fn quadratic_mesh() -> Mesh {
    let mut linear = mixed_mesh();
    linear.groups.clear();
    linear.raised(souple_mesh::NodePlace::Edge, |[a, b]| (a + b) * 0.5 + Vec3::new(0.01, 1.0 / 300.0, -0.02))
}

/// Cut at every byte, and with bits of every byte flipped: an answer or a fault, never a panic, and what is
/// read refers only to points that exist.
pub(crate) fn survives_faults(name: &str, content: &[u8], read: impl Fn(&[u8]) -> Result<Dataset, Fault>) {
    let check = |bytes: &[u8], what: String| {
        if let Ok(dataset) = read(bytes) {
            let count = dataset.mesh.points.len() as u32;
            let nodes = dataset.mesh.cells().chain(dataset.mesh.facets());
            assert!(nodes.flat_map(|cell| cell.nodes).all(|node| *node < count), "{name} {what}");
        }
    };
    for length in 0..content.len() {
        check(&content[..length], format!("cut at {length}"));
    }
    for place in 0..content.len() {
        for flip in [0x01, 0x04, 0x20, 0x80, 0xff] {
            let mut bytes = content.to_vec();
            bytes[place] ^= flip;
            check(&bytes, format!("byte {place} ^ {flip:#x}"));
        }
    }
}

/// The real inputs, where the environment names a folder of them.
pub(crate) fn real_input(name: &str) -> Option<Vec<u8>> {
    let folder = std::env::var_os("SOUPLE_DATA")?;
    std::fs::read(Path::new(&folder).join(name)).ok()
}

/// A quadrilateral and three triangles that use the points in their order, one in a group.
pub(crate) fn surface_mesh() -> Mesh {
    let points = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 1e-3],
        [1.0, 1.0 / 3.0, 0.0],
        [0.0, 1.0, -0.25],
        [0.5, 0.5, 1.7],
        [-1e-7, 0.9, 0.3],
    ];
    let mut mesh = Mesh { points: points.map(Vec3::from_array).to_vec(), ..Mesh::default() };
    mesh.push_facet(ElementKind::Quad4, &[0, 1, 2, 3]);
    mesh.push_facet(ElementKind::Tri3, &[0, 1, 4]);
    mesh.push_facet(ElementKind::Tri3, &[3, 4, 5]);
    mesh.push_facet(ElementKind::Tri3, &[4, 2, 5]);
    mesh.groups.insert("lid".into(), Group { facets: vec![1, 2], ..Group::default() });
    mesh
}

/// Two tetrahedra and two triangles, with groups called by number.
pub(crate) fn tetrahedra_mesh() -> Mesh {
    let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 1e-9], [0.0, 1.0, 0.0], [0.0, 1.0 / 3.0, 1.0], [1.0, 1.0, 1.0]];
    let mut mesh = Mesh { points: points.map(Vec3::from_array).to_vec(), ..Mesh::default() };
    mesh.push_cell(ElementKind::Tet4, &[0, 1, 2, 3]);
    mesh.push_cell(ElementKind::Tet4, &[4, 2, 1, 3]);
    mesh.push_facet(ElementKind::Tri3, &[0, 2, 1]);
    mesh.push_facet(ElementKind::Tri3, &[0, 1, 3]);
    mesh.groups.insert("point_2".into(), Group { points: vec![0, 3], ..Group::default() });
    mesh.groups.insert("surface_9".into(), Group { facets: vec![1], ..Group::default() });
    mesh.groups.insert("volume_7".into(), Group { cells: vec![1], ..Group::default() });
    mesh
}
