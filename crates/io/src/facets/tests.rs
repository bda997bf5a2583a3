//! Polygons of every format become the same facets.

use crate::read_dataset_bytes;

/// The same polygons are the same facets in every format that has polygons: a tetrahedron of quadrilaterals that repeat a
/// corner encloses a sixth, a pentagon is three triangles, and what encloses nothing is left out.
#[test]
fn polygons_are_read_by_one_rule() {
    let points = ["0 0 0", "1 0 0", "0 1 0", "0 0 1", "2 0 1", "3 0 1", "3 1 1", "2.5 2 1", "2 1 1"];
    let tetrahedron = [vec![0, 2, 1, 1], vec![0, 0, 1, 3], vec![1, 2, 3, 1], vec![0, 3, 3, 2]];
    let pentagon = vec![4, 5, 6, 7, 8];
    let folded = [vec![0, 1, 0, 1], vec![4, 4, 5]];
    let polygons: Vec<Vec<usize>> = tetrahedron.into_iter().chain([pentagon]).chain(folded).collect();
    let lines = |shift: usize, head: fn(usize) -> String| -> String {
        let line = |corners: &Vec<usize>| {
            let text: String = corners.iter().map(|corner| format!(" {}", corner + shift)).collect();
            format!("{}{text}\n", head(corners.len()))
        };
        polygons.iter().map(line).collect()
    };
    let counted = lines(0, |count| count.to_string());
    let (of_points, count) = (points.join("\n"), polygons.len());
    let size: usize = polygons.iter().map(|corners| corners.len() + 1).sum();
    let obj: String = points.iter().map(|point| format!("v {point}\n")).collect();
    let contents = [
        ("obj", obj + &lines(1, |_| "f".to_owned())),
        ("off", format!("OFF\n9 {count} 0\n{of_points}\n{counted}")),
        (
            "ply",
            format!(
                "ply\nformat ascii 1.0\nelement vertex 9\nproperty float x\nproperty float y\nproperty float z\n\
                 element face {count}\nproperty list uchar int vertex_indices\nend_header\n{of_points}\n{counted}"
            ),
        ),
        (
            "vtk",
            format!(
                "# vtk DataFile Version 3.0\na\nASCII\nDATASET POLYDATA\nPOINTS 9 double\n{of_points}\n\
                 POLYGONS {count} {size}\n{counted}CELL_DATA {count}\nSCALARS number double\nLOOKUP_TABLE default\n0 1 2 3 4 5 6\n"
            ),
        ),
    ];
    for (format, content) in contents {
        let dataset = read_dataset_bytes(format, content.as_bytes()).unwrap();
        let facets: Vec<Vec<u32>> = dataset.mesh.facets().map(|facet| facet.nodes.to_vec()).collect();
        let expected: [&[u32]; 7] =
            [&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[0, 3, 2], &[4, 5, 6], &[4, 6, 7], &[4, 7, 8]];
        assert_eq!(facets, expected, "{format}");
        let told = |words: &str| dataset.notes.iter().any(|note| note.contains(words));
        assert!(
            told("1 polygon of more than four corners") && told("2 facets of fewer"),
            "{:?}",
            dataset.notes
        );
        // each facet has the value of its polygon
        if format == "vtk" {
            assert_eq!(dataset.cell_fields[0].values, [0.0, 1.0, 2.0, 3.0, 4.0, 4.0, 4.0]);
        }
    }
}

/// A polygon of very many corners does not multiply the values of its cell without bound.
#[test]
fn values_of_large_polygons_are_bounded() {
    let corners = 20_000;
    let points: String =
        (0..corners).map(|k| format!("{} {} 0\n", f64::from(k).cos(), f64::from(k).sin())).collect();
    let numbers: String = (0..corners).map(|k| format!(" {k}")).collect();
    let values = "0 ".repeat(1024);
    let content = format!(
        "# vtk DataFile Version 3.0\na\nASCII\nDATASET POLYDATA\nPOINTS {corners} double\n{points}\
         POLYGONS 1 {}\n{corners}{numbers}\nCELL_DATA 1\nSCALARS many double 1024\nLOOKUP_TABLE default\n{values}\n",
        corners + 1
    );
    let dataset = read_dataset_bytes("vtk", content.as_bytes()).unwrap();
    assert_eq!((dataset.mesh.facet_count(), dataset.cell_fields.len()), (corners as usize - 2, 0));
    assert!(dataset.notes.iter().any(|note| note.contains("became 19998 facets")), "{:?}", dataset.notes);
}

/// The outline of a plate, with a notch, is a polygon of its own area in every format of polygons; a dart is cut within, whichever of
/// its corners comes first, where it is written to a file of triangles.
#[test]
fn polygons_that_are_not_convex_keep_their_area() {
    let area = |mesh: &souple_mesh::Mesh| mesh.facet_surface().unwrap().area();
    let notched = "OFF\n8 1 0\n0 0 0\n3 0 0\n3 2 0\n2 2 0\n2 1 0\n1 1 0\n1 2 0\n0 2 0\n8 0 1 2 3 4 5 6 7\n";
    let mesh = read_dataset_bytes("off", notched.as_bytes()).unwrap().mesh;
    assert_eq!((mesh.facet_count(), area(&mesh)), (6, 5.0));
    for first in 1..5 {
        let corners: String = (0..4).map(|k| format!(" {}", (first + k) % 4 + 1)).collect();
        let dart = format!("v 0 0 0\nv 2 -1 0\nv 0 3 0\nv -2 -1 0\nf{corners}\n");
        let mesh = read_dataset_bytes("obj", dart.as_bytes()).unwrap().mesh;
        let mut stl = Vec::new();
        let write = crate::FORMATS.find("stl").unwrap().build.write.unwrap();
        write(&crate::Output::new(&mesh), &mut stl).unwrap();
        let written = read_dataset_bytes("stl", &stl).unwrap().mesh;
        assert_eq!([area(&mesh), area(&written)], [6.0, 6.0]);
    }
}
