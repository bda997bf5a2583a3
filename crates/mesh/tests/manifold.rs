//! Fillings hang together by whole faces: their boundaries are manifolds, for every shape, size and kind of cells.

use souple_mesh::fill::{Options, PARAMETERS};
use souple_mesh::{Mesh, implicit};
use souple_table::{Value, Values};

fn options(values: Values) -> Options {
    Options::from_values(&values.completed(PARAMETERS).unwrap()).unwrap()
}

fn assert_manifold(mesh: &Mesh, name: &str) {
    let found = mesh.conformity();
    assert_eq!((found.pinched, found.hinged_parts), (Vec::new(), 0), "{name}");
}

/// Every shape of the table, of few cells and more, in tetrahedra and mixed: the boundary is a manifold, and the body one part
/// joined by faces. Ears of the bunny are thinner than cells of the coarse ones.
#[test]
fn bodies_are_one_part() {
    for entry in implicit::SHAPES.entries.iter().filter(|entry| entry.name != "formula") {
        let body = implicit::body(entry.name, Values::new()).unwrap();
        let counts: &[i64] =
            if entry.name == "bunny" { &[500, 2000, 5000, 20_000] } else { &[500, 2000, 5000] };
        for (element, count) in
            ["tet4", "hex_dominant"].into_iter().flat_map(|e| counts.iter().map(move |c| (e, *c)))
        {
            let values =
                Values::new().with("count", Value::Integer(count)).with("element", Value::Text(element));
            let mesh = options(values).fill_body(&body).unwrap().mesh;
            let name = format!("{} of {count} {element}", entry.name);
            assert_manifold(&mesh, &name);
            assert_eq!(mesh.components().1, 1, "{name}");
        }
    }
}

/// Bubbles, bridges and walls thinner than a cell, of sizes that lie to the lattice in every way: manifold, however many parts
/// it comes to; tetrahedra of one size keep their bounds on angles, and a point where the formula is exactly zero is a
/// point like others.
#[test]
fn walls_thinner_than_cells() {
    let formulas = [
        "max(sqrt(x^2+y^2+z^2) - 2.2, sin(7.3*x+0.4)*sin(8*y+0.8)*sin(6.6*z) + 0.8*sin(11.9*x+1.7)*sin(13.1*y+3.4)*sin(10.7*z))",
        // two balls that touch in the middle of the lattice, and the walls of a grid on its points
        "min(sqrt((x-1)^2+y^2+z^2), sqrt((x+1)^2+y^2+z^2)) - 1",
        "max(sqrt(x^2+y^2+z^2) - 2, sin(3.141592653589793*2.5*x)*sin(3.141592653589793*2.5*y)*sin(3.141592653589793*2.5*z))",
    ];
    for formula in formulas {
        let corner = |c: f64| Value::Vector([c; 3]);
        let values = Values::new()
            .with("formula", Value::Text(formula))
            .with("low", corner(-2.4))
            .with("high", corner(2.4));
        let body = implicit::body("formula", values).unwrap();
        for element in ["tet4", "hex_dominant"] {
            for size in [0.2, 0.23, 0.31, 0.4] {
                let values =
                    Values::new().with("size", Value::Number(size)).with("element", Value::Text(element));
                let mesh = options(values).fill_body(&body).unwrap().mesh;
                assert_manifold(&mesh, &format!("{formula} at {size} {element}"));
                if element == "tet4" {
                    let least = mesh
                        .quality()
                        .iter()
                        .map(|cell| cell.smallest_dihedral)
                        .fold(f64::INFINITY, f64::min);
                    assert!(least.to_degrees() > 10.7, "{}", least.to_degrees());
                }
            }
        }
    }
}

/// What is pinched is found: two tetrahedra that share a point, an edge, or a face.
#[test]
fn pinches_are_found() {
    let of = |points: &[[f64; 3]], cells: [[u32; 4]; 2]| {
        let points = points.iter().map(|x| souple_math::Vec3::from_array(*x)).collect();
        let mesh = Mesh::new(points, souple_mesh::ElementKind::Tet4, cells.as_flattened().to_vec());
        mesh.conformity().pinched
    };
    let corner = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let beyond = [[-1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]];
    let points: Vec<[f64; 3]> = corner.into_iter().chain(beyond).collect();
    assert_eq!(of(&points, [[0, 1, 2, 3], [0, 5, 4, 6]]), [0]);
    assert_eq!(of(&points, [[0, 1, 2, 3], [0, 3, 4, 5]]), [0, 3]);
    assert_eq!(of(&points, [[0, 1, 2, 3], [0, 2, 4, 3]]), [0; 0]);
}
