//! Cubes cut in twelve tetrahedra around their centres.

use souple_mesh::{ElementKind, generate};
use souple_table::{Value, Values};

/// In boxes and balls: valid, conforming, closed, as many points and cells as told beforehand, all of them tetrahedra.
#[test]
fn twelve_tetrahedra_fill_a_cube() {
    let cells = Value::Vector([3.0, 2.0, 2.0]);
    let shapes = [
        ("bar", Values::new().with("size", Value::Vector([3.0, 2.0, 2.0])).with("cells", cells), 12.0),
        ("sphere", Values::new().with("radius", Value::Number(1.0)).with("cells", Value::Integer(8)), 4.189),
    ];
    for (name, values, volume) in shapes {
        let mut mesh = generate(name, values.with("element", Value::Text("tet4_centred"))).unwrap();
        let repairs = mesh.validate().unwrap();
        assert_eq!(repairs, souple_mesh::Repairs { component_count: 1, ..Default::default() }, "{name}");
        mesh.faces().conforming().unwrap();
        mesh.boundary_surface().check_closed().unwrap();
        assert_eq!(mesh.count_of(ElementKind::Tet4), mesh.cell_count(), "{name}");
        // chords of few cells cut a sixth off at most
        assert!(
            mesh.volume() <= volume * (1.0 + 1e-3) && mesh.volume() > 0.84 * volume,
            "{name} {}",
            mesh.volume()
        );
    }
    let bar = Values::new().with("size", Value::Vector([1.0; 3])).with("cells", Value::Vector([1.0; 3]));
    let cube = generate("bar", bar.with("element", Value::Text("tet4_centred"))).unwrap();
    assert_eq!((cube.points.len(), cube.cell_count()), (9, 12));
}
