//! Files of hundreds of thousands of lines: read in a time that goes with their length.

use souple_io::{FORMATS, Output, Shapes, read_dataset_bytes};
use souple_math::Vec3;
use souple_mesh::{ElementKind, Mesh};

use crate::mutator::guard;

/// A time for some MB [s]: a single pass takes a second or two without optimisation on a busy machine; a pass for each line
/// takes minutes.
const LONGEST: f64 = 60.0;

/// Points of a mesh whose lists are each some 10⁵ lines.
const POINTS: u32 = 60_000;

/// A chain of tetrahedra, or a strip of triangles.
fn mesh(shapes: Shapes) -> Mesh {
    let point = |k: u32| {
        let (sine, cosine) = f64::from(k).sin_cos();
        Vec3::new(f64::from(k), sine, cosine)
    };
    let mut mesh = Mesh { points: (0..POINTS).map(point).collect(), ..Mesh::default() };
    match shapes {
        Shapes::All | Shapes::Tetrahedra => {
            (3..POINTS).for_each(|k| mesh.push_cell(ElementKind::Tet4, &[k - 3, k - 2, k - 1, k]));
        }
        Shapes::Facets | Shapes::Triangles => {
            (2..POINTS).for_each(|k| mesh.push_facet(ElementKind::Tri3, &[k - 2, k - 1, k]));
        }
    }
    mesh
}

#[test]
fn meshes_are_read_in_one_pass() {
    for entry in FORMATS.entries {
        let (Some(read), Some(write)) = (entry.build.read, entry.build.write) else { continue };
        let mesh = mesh(entry.build.holds.shapes);
        let mut content = Vec::new();
        write(&Output::new(&mesh), &mut content).unwrap();
        guard(0, entry.name.as_bytes(), LONGEST, || {
            let back = read(&content).unwrap().mesh;
            assert_eq!(back.cell_count() + back.facet_count(), mesh.cell_count() + mesh.facet_count());
        });
    }
}

/// Lines that say nothing, and sections and names without end, cost no more than others.
#[test]
fn long_heads_are_read_in_one_pass() {
    let lines = 200_000;
    let triangle = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n\
                    property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    let ply = format!("ply\nformat ascii 1.0\n{}{triangle}", "comment c\n".repeat(lines));
    let names: String = (1..=lines).map(|tag| format!("2 {tag} \"g\"\n")).collect();
    let mesh =
        "$Nodes\n3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n$EndNodes\n$Elements\n1\n1 2 2 1 1 1 2 3\n$EndElements\n";
    let head = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
    let gmsh_names = format!("{head}$PhysicalNames\n{lines}\n{names}$EndPhysicalNames\n{mesh}");
    let gmsh_sections = format!("{head}{}{mesh}", "$Comments\n$EndComments\n".repeat(lines / 2));
    for (format, content) in [("ply", ply), ("gmsh", gmsh_names), ("gmsh", gmsh_sections)] {
        guard(0, format.as_bytes(), LONGEST, || {
            assert_eq!(read_dataset_bytes(format, content.as_bytes()).unwrap().mesh.facet_count(), 1);
        });
    }
}
