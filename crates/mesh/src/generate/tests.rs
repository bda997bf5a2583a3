//! Generated meshes: numbers of the reference, volumes, conformity, refusals.

use souple_math::Vec3;
use souple_table::Value;

use super::*;
use crate::ElementKind;

const ELEMENTS: [&str; 5] = ["tet4", "hex8", "prism6", "pyramid5", "mixed"];

fn bar(cells: [f64; 3], element: &'static str) -> Result<Mesh, MeshError> {
    let values = Values::new()
        .with("size", Value::Vector([1.0, 0.1, 0.1]))
        .with("cells", Value::Vector(cells))
        .with("element", Value::Text(element));
    generate("bar", values)
}

fn sphere(cells: i64, element: &'static str) -> Mesh {
    let values = Values::new()
        .with("radius", Value::Number(0.5))
        .with("cells", Value::Integer(cells))
        .with("centre", Value::Vector([1.0, 2.0, 3.0]))
        .with("element", Value::Text(element));
    generate("sphere", values).unwrap()
}

/// The published counts of the reference bar: n = 3 has 1,620 tets and 496 nodes; its first cube as defined there.
#[test]
fn reference_bar_of_tetrahedra() {
    for (n, cells, points) in [(3.0, 1620, 496), (6.0, 12960, 2989)] {
        let mesh = bar([10.0 * n, n, n], "tet4").unwrap();
        assert_eq!((mesh.cell_count(), mesh.points.len()), (cells, points));
    }
    let mesh = bar([30.0, 3.0, 3.0], "tet4").unwrap();
    let id = |i: u32, j: u32, k: u32| i + 31 * (j + 4 * k);
    // the cube (2, 1, 0), whose corner (0, 0, 0) is node (2, 1, 0)
    let corner = |a: u32, b: u32, c: u32| id(2 + a, 1 + b, c);
    let (o, xyz) = (corner(0, 0, 0), corner(1, 1, 1));
    let expected = [
        [o, corner(1, 0, 0), corner(1, 1, 0), xyz],
        [o, corner(1, 0, 0), xyz, corner(1, 0, 1)],
        [o, corner(0, 1, 0), xyz, corner(1, 1, 0)],
        [o, corner(0, 1, 0), corner(0, 1, 1), xyz],
        [o, corner(0, 0, 1), corner(1, 0, 1), xyz],
        [o, corner(0, 0, 1), xyz, corner(0, 1, 1)],
    ];
    let first = 6 * (2 + 30);
    for (local, nodes) in expected.into_iter().enumerate() {
        assert_eq!(mesh.cell(first + local as u32).unwrap().nodes, nodes);
    }
    assert_eq!(mesh.points[id(30, 3, 3) as usize], Vec3::new(1.0, 0.1, 0.1));
}

/// Each cut fills the bar exactly, without repair, in one part, conforming, with a closed boundary of known area.
#[test]
fn bars_of_every_kind_are_sound() {
    for element in ELEMENTS {
        let mut mesh = bar([7.0, 2.0, 3.0], element).unwrap();
        let repairs = mesh.validate().unwrap();
        assert_eq!(repairs, crate::Repairs { component_count: 1, ..Default::default() }, "{element}");
        // thousands of cells at most, each rounded to 1e-16
        assert!((mesh.volume() - 0.01).abs() < 1e-15, "{element} {}", mesh.volume());
        let offset = mesh.centroid() - Vec3::new(0.5, 0.05, 0.05);
        // a thousand terms, each rounded to 1e-16
        assert!(offset.length() < 1e-13, "{element} {offset:?}");
        mesh.faces().conforming().unwrap();
        let surface = mesh.boundary_surface();
        surface.check_closed().unwrap();
        assert!((surface.area() - 0.42).abs() < 1e-14, "{element}");
        assert!((surface.enclosed_volume() - 0.01).abs() < 1e-15);
    }
}

/// The mixed bar has all four kinds.
#[test]
fn mixed_bar_has_every_kind() {
    let mesh = bar([4.0, 1.0, 1.0], "mixed").unwrap();
    let counts = [ElementKind::Hex8, ElementKind::Pyramid5, ElementKind::Tet4, ElementKind::Prism6]
        .map(|kind| mesh.count_of(kind));
    // one cube each; the layer between has five pyramids and two tets
    assert_eq!(counts, [1, 5, 6 + 2, 2]);
}

fn bar_of_parts(cells: [f64; 3], elements: &'static str, ends: &[f64]) -> Result<Mesh, MeshError> {
    let values = Values::new()
        .with("size", Value::Vector([8.0, 1.0, 1.0]))
        .with("cells", Value::Vector(cells))
        .with("elements", Value::Text(elements))
        .with("ends", Value::Numbers(ends));
    generate("bar_of_parts", values)
}

/// The mixed bar of the source has its counts, fills its box, and gapes only where hexahedra meet tetrahedra: each face of
/// a cube between pyramids and hexahedra is whole.
#[test]
fn bars_of_parts_have_their_counts() {
    let quarters = [0.25, 0.5, 0.75, 1.0];
    let mut mesh = bar_of_parts([48.0, 8.0, 8.0], "prism6, pyramid5, hex8, tet4", &quarters).unwrap();
    let kinds = [ElementKind::Prism6, ElementKind::Pyramid5, ElementKind::Hex8, ElementKind::Tet4];
    assert_eq!(kinds.map(|kind| mesh.count_of(kind)), [1536, 4608, 768, 4608]);
    assert_eq!(mesh.points.len(), 4737);
    mesh.validate().unwrap();
    // a sum of 11,520 terms, each rounded to 1e-16 of it
    assert!((mesh.volume() - 8.0).abs() < 1e-11, "{}", mesh.volume());
    // prisms end in triangles, pyramids begin with squares: 64 of them, and as many between hexahedra and tetrahedra
    assert_eq!(mesh.conformity().split.len(), 128);
    // along z they meet the pyramids in squares, and fill as much
    let values = Values::new()
        .with("size", Value::Vector([8.0, 1.0, 1.0]))
        .with("cells", Value::Vector([8.0, 2.0, 2.0]))
        .with("elements", Value::Text("prism6 pyramid5"))
        .with("ends", Value::Numbers(&[0.5, 1.0]));
    for (axis, split) in [("x", 4), ("y", 0), ("z", 0)] {
        let mut mesh =
            generate("bar_of_parts", values.clone().with("prism_axis", Value::Text(axis))).unwrap();
        assert!(mesh.validate().unwrap().rewound_cells.is_empty(), "{axis}");
        assert!((mesh.volume() - 8.0).abs() < 1e-13, "{axis}");
        assert_eq!(mesh.conformity().split.len(), split, "{axis}");
    }
    let refused = |elements: &'static str, ends: &[f64]| {
        bar_of_parts([4.0, 1.0, 1.0], elements, ends).unwrap_err().to_string()
    };
    assert!(refused("hex8 tet4", &[0.5]).contains("2 ascending fractions, the last of them 1"));
    assert!(refused("hex8 tet4", &[0.5, 0.4]).contains("ascending"));
    assert!(refused("hex20", &[1.0]).contains("expected names among tet4"));
}

#[test]
fn sides_are_groups() {
    let mesh = bar([4.0, 2.0, 3.0], "pyramid5").unwrap();
    let bounds = mesh.bounds();
    for (axis, letter) in ["x", "y", "z"].into_iter().enumerate() {
        for (end, at) in [("min", bounds.low[axis]), ("max", bounds.high[axis])] {
            let expected: Vec<u32> =
                (0..mesh.points.len() as u32).filter(|p| mesh.points[*p as usize][axis] == at).collect();
            assert_eq!(mesh.groups[&format!("{letter}_{end}")].points, expected);
        }
    }
}

/// Balls of every kind are valid, and their volume tends to 4/3 π r³ as the square of the cell size.
#[test]
fn balls_converge_to_the_sphere() {
    let exact = 4.0 / 3.0 * std::f64::consts::PI * 0.125;
    for element in ELEMENTS {
        let error = |cells| {
            let mut mesh = sphere(cells, element);
            let repairs = mesh.validate().unwrap();
            assert_eq!(
                repairs,
                crate::Repairs { component_count: 1, ..Default::default() },
                "{element} {cells}"
            );
            mesh.faces().conforming().unwrap();
            mesh.boundary_surface().check_closed().unwrap();
            for point in &mesh.groups["surface"].points {
                let radius = (mesh.points[*point as usize] - Vec3::new(1.0, 2.0, 3.0)).length();
                assert!((radius - 0.5).abs() < 1e-15);
            }
            exact - mesh.volume()
        };
        // the core has 4 and 8 cubes along its edge (mixed: 8 and 16)
        let coarse = if element == "mixed" { 16 } else { 8 };
        let rate = (error(coarse) / error(2 * coarse)).log2();
        assert!((rate - 2.0).abs() < 0.15, "{element} {rate}");
    }
}

#[test]
fn absurd_requests_are_refused() {
    for cells in [[1e9, 1e9, 1e9], [1e300, 1e300, 1e300], [300.0, 300.0, 300.0]] {
        assert!(matches!(bar(cells, "tet4"), Err(MeshError::TooManyCells { .. })), "{cells:?}");
    }
    for cells in [[0.0, 1.0, 1.0], [-1.0, 1.0, 1.0], [1.5, 1.0, 1.0]] {
        assert!(matches!(bar(cells, "tet4"), Err(MeshError::Parameter { name: "cells", .. })), "{cells:?}");
    }
    assert!(matches!(bar([f64::NAN, 1.0, 1.0], "tet4"), Err(MeshError::Value(_))));
    assert!(matches!(bar([3.0, 1.0, 1.0], "mixed"), Err(MeshError::Parameter { .. })));
    assert!(matches!(bar([1.0; 3], "tet5"), Err(MeshError::Value(_))));
    assert!(matches!(generate("cone", Values::new()), Err(MeshError::UnknownGenerator(_))));
    let flat =
        Values::new().with("size", Value::Vector([1.0, 0.0, 1.0])).with("cells", Value::Vector([1.0; 3]));
    assert!(matches!(generate("box", flat), Err(MeshError::Parameter { name: "size", .. })));
}

/// Each entry of the table has a page, and says what must be written.
#[test]
fn every_generator_is_described() {
    for entry in GENERATORS.entries {
        assert!(!entry.summary.is_empty() && !entry.source.is_empty());
        assert!(matches!(entry.values(Values::new()), Err(souple_table::ValueError::Missing { .. })));
    }
}

/// No cell of a ball is badly shaped, and refinement does not make it so: three blocks of the shell meet at angles
/// of 2π/3, where the half cubes of tetrahedra have the least scaled Jacobian, about 0.2. A cube mapped to the ball
/// would fall to zero with the cell size.
#[test]
fn balls_are_well_shaped() {
    for element in ELEMENTS {
        for cells in [16, 24] {
            let summary = sphere(cells, element).quality_summary(10);
            assert!(summary.scaled_jacobian.low > 0.18, "{element} {cells} {:?}", summary.scaled_jacobian);
            assert!(summary.aspect_ratio.high < 4.0, "{element} {cells} {:?}", summary.aspect_ratio);
        }
    }
}

/// The size told beforehand is that of the mesh: points exactly, cells exactly where all cubes are cut alike and from
/// above where they are not.
#[test]
fn sizes_are_known_beforehand() {
    let size = |name: &str, values: Values| {
        let entry = GENERATORS.find(name).unwrap();
        let values = entry.values(values).unwrap();
        ((entry.build.size)(&values).unwrap(), (entry.build.mesh)(&values).unwrap())
    };
    for element in ELEMENTS {
        let cells = Value::Vector([7.0, 3.0, 2.0]);
        let bar = Values::new().with("size", Value::Vector([1.0; 3])).with("cells", cells);
        let ball = Values::new().with("radius", Value::Number(1.0)).with("cells", Value::Integer(9));
        let hollow = Values::new()
            .with("radius", Value::Number(1.0))
            .with("inner_radius", Value::Number(0.5))
            .with("cells", Value::Integer(4))
            .with("layers", Value::Integer(4));
        let mut shapes = vec![("bar", bar), ("sphere", ball), ("hollow_sphere", hollow)];
        if element != "mixed" {
            let swept = Values::new()
                .with("length", Value::Number(1.0))
                .with("radius", Value::Number(0.5))
                .with("cells_along", Value::Integer(3));
            let shell = swept.clone().with("thickness", Value::Number(0.1));
            shapes.push(("cylinder", swept.with("cells", Value::Integer(7))));
            shapes.push(("shell", shell.with("cells_around", Value::Integer(9))));
        }
        for (name, values) in shapes {
            let (size, mesh) = size(name, values.with("element", Value::Text(element)));
            let cells = mesh.cell_count() as u64;
            if element == "mixed" {
                assert!(size.points >= mesh.points.len() as u64 && size.cells >= cells, "{name}: {size:?}");
            } else {
                let counted = MeshSize { points: mesh.points.len() as u64, cells };
                assert_eq!(size, counted, "{name} of {element}");
            }
        }
    }
}
/// A hollow ball of every kind: in one part, conforming, two closed spheres; its volume converges as the square of the
/// size of cells, by 4 from one to the next.
#[test]
fn hollow_balls_of_every_kind_are_sound() {
    let hollow = |cells: i64, element: &'static str| {
        let values = Values::new()
            .with("radius", Value::Number(2.0))
            .with("inner_radius", Value::Number(1.0))
            .with("cells", Value::Integer(cells))
            .with("layers", Value::Integer(3))
            .with("element", Value::Text(element));
        generate("hollow_sphere", values).unwrap()
    };
    let exact = 4.0 / 3.0 * std::f64::consts::PI * 7.0;
    for element in ELEMENTS {
        let mut mesh = hollow(4, element);
        let repairs = mesh.validate().unwrap();
        assert_eq!(repairs, crate::Repairs { component_count: 1, ..Default::default() }, "{element}");
        mesh.faces().conforming().unwrap();
        mesh.boundary_surface().check_closed().unwrap();
        for (group, radius) in [("inner", 1.0), ("surface", 2.0)] {
            let points = &mesh.groups[group].points;
            assert_eq!(points.len(), 98, "{element} {group}");
            let off = |point: &u32| (mesh.points[*point as usize].length() - radius).abs();
            assert!(points.iter().all(|point| off(point) < 1e-15 * 4.0), "{element} {group}");
        }
        let errors = [4, 8].map(|cells| exact - hollow(cells, element).volume());
        let ratio = errors[0] / errors[1];
        // the next term of the error is the square of this one: some percent
        assert!((ratio - 4.0).abs() < 0.2, "{element}: {errors:?} {ratio}");
    }
}

#[test]
fn hollow_balls_without_a_wall_are_refused() {
    let values = Values::new()
        .with("radius", Value::Number(1.0))
        .with("inner_radius", Value::Number(1.0))
        .with("cells", Value::Integer(2))
        .with("layers", Value::Integer(1));
    let error = generate("hollow_sphere", values).unwrap_err();
    assert!(error.to_string().contains("less than the radius"), "{error}");
}

/// Cylinders and shells of every kind of cell are sound, and their volumes are those of their polygons.
#[test]
fn cylinders_and_shells() {
    let number = |x: f64| Value::Number(x);
    for element in ["tet4", "hex8", "prism6", "pyramid5"] {
        let common = Values::new()
            .with("length", number(0.5))
            .with("radius", number(0.2))
            .with("cells_along", Value::Integer(4))
            .with("element", Value::Text(element));
        let cylinder = common.clone().with("cells", Value::Integer(9));
        let shell = common
            .with("thickness", number(0.05))
            .with("cells_around", Value::Integer(12))
            .with("cells_through", Value::Integer(2));
        let slab = shell.clone().with("angle", number(1.0));
        // n chords of a circle enclose n/2 r² sin(2π/n); five squares along an edge of the core make twenty chords
        let polygon = |chords: f64, angle: f64| 0.5 * chords * (angle / chords).sin();
        let whole = std::f64::consts::TAU;
        let cases = [
            ("cylinder", cylinder, 0.5 * 0.04 * polygon(20.0, whole), true),
            ("shell", shell, 0.5 * (0.04 - 0.0225) * polygon(12.0, whole), false),
            ("shell", slab, 0.5 * (0.04 - 0.0225) * polygon(12.0, 1.0), false),
        ];
        for (name, values, volume, is_equal_angled) in cases {
            let mut mesh = generate(name, values).unwrap();
            let repairs = mesh.validate().unwrap();
            assert_eq!(
                repairs,
                crate::Repairs { component_count: 1, ..Default::default() },
                "{name} {element}"
            );
            mesh.faces().conforming().unwrap();
            mesh.boundary_surface().check_closed().unwrap();
            // equal angles between the columns from the core: tan is exact there to rounding
            let bound = if is_equal_angled { 1e-14 } else { 1e-15 };
            assert!((mesh.volume() - volume).abs() < bound, "{name} {element} {} {volume}", mesh.volume());
            assert!(mesh.groups.values().all(|group| !group.points.is_empty()));
        }
    }
}

#[test]
fn cylinder_refusals() {
    let values = Values::new()
        .with("length", Value::Number(1.0))
        .with("radius", Value::Number(0.1))
        .with("thickness", Value::Number(0.1))
        .with("cells_around", Value::Integer(8))
        .with("cells_along", Value::Integer(1));
    let refused = generate("shell", values.clone()).unwrap_err();
    assert!(matches!(refused, MeshError::Parameter { name: "thickness", .. }));
    let two = values.with("thickness", Value::Number(0.01)).with("cells_around", Value::Integer(2));
    assert!(matches!(generate("shell", two), Err(MeshError::Parameter { name: "cells_around", .. })));
}

/// Quadratic meshes: fewer points than foretold, sound, and on round surfaces the middles lie on them, so that the
/// volume converges at the fourth order of the cell size.
#[test]
fn quadratic_meshes_are_sound_and_round() {
    for element in ["tet10", "hex20", "hex27", "prism15", "pyramid13", "mixed_quadratic"] {
        let entry = GENERATORS.find("bar").unwrap();
        let values = Values::new()
            .with("size", Value::Vector([1.0, 0.1, 0.1]))
            .with("cells", Value::Vector([7.0, 2.0, 3.0]))
            .with("element", Value::Text(element));
        let values = entry.values(values).unwrap();
        let (size, mut mesh) = ((entry.build.size)(&values).unwrap(), (entry.build.mesh)(&values).unwrap());
        assert!(
            size.points >= mesh.points.len() as u64 && size.cells >= mesh.cell_count() as u64,
            "{element}"
        );
        assert!(mesh.validate().unwrap().messages().is_empty());
        assert!((mesh.volume() - 0.01).abs() < 1e-15, "{element} {}", mesh.volume());

        let exact = std::f64::consts::PI / 6.0;
        let [coarse, fine] = [8, 16].map(|cells| {
            let mut ball = sphere(cells, element);
            ball.validate().unwrap();
            (ball.volume() - exact).abs()
        });
        assert!(coarse < 1e-2 * exact && coarse / fine > 10.0, "{element}: {coarse:e} {fine:e}");
    }
}

/// Sheets and lines: exact sizes, area and length, cells that look up.
#[test]
fn sheets_and_lines() {
    for element in ["tri3", "tri6", "quad4", "quad8", "quad9", "mixed", "mixed_quadratic"] {
        let entry = GENERATORS.find("sheet").unwrap();
        let values = Values::new()
            .with("length", Value::Number(2.0))
            .with("width", Value::Number(0.5))
            .with("cells_along", Value::Integer(5))
            .with("cells_across", Value::Integer(3))
            .with("element", Value::Text(element));
        let values = entry.values(values).unwrap();
        let (size, mut mesh) = ((entry.build.size)(&values).unwrap(), (entry.build.mesh)(&values).unwrap());
        assert_eq!(size, MeshSize { points: mesh.points.len() as u64, cells: mesh.cell_count() as u64 });
        assert!(mesh.validate().unwrap().messages().is_empty() && mesh.face_up().is_empty());
        assert!((mesh.volume() - 1.0).abs() < 1e-14, "{element} {}", mesh.volume());
        assert_eq!(mesh.conformity(), crate::Conformity::default(), "{element}");
        mesh.faces().conforming().unwrap();
        assert_eq!(mesh.faces().boundary.len(), 16);
        assert!((mesh.boundary_surface().area() - 1.0).abs() < 1e-14);
        assert!(mesh.groups["x_max"].points.iter().all(|point| mesh.points[*point as usize].x == 2.0));
    }
    for (element, points) in [("edge2", 5), ("edge3", 9)] {
        let values = Values::new()
            .with("from", Value::Vector([1.0, 0.0, 0.0]))
            .with("to", Value::Vector([1.0, 3.0, 4.0]))
            .with("cells", Value::Integer(4))
            .with("element", Value::Text(element));
        let mut mesh = generate("line", values).unwrap();
        mesh.validate().unwrap();
        assert_eq!(mesh.points.len(), points);
        assert!((mesh.volume() - 5.0).abs() < 1e-14);
    }
}

/// Cubes are each other's mirror images across the faces that they share: valid, conforming, of the bar's volume, with as many cells and
/// points as parallel ones. In the middle of 2 x 2 x 2 cubes all cells meet, of parallel ones half.
#[test]
fn mirrored_tetrahedra_conform() {
    let mut mesh = bar([4.0, 3.0, 2.0], "tet4_mirrored").unwrap();
    assert_eq!(mesh.validate().unwrap(), crate::Repairs { component_count: 1, ..Default::default() });
    mesh.faces().conforming().unwrap();
    mesh.boundary_surface().check_closed().unwrap();
    assert_eq!((mesh.cell_count(), mesh.points.len()), (144, 60));
    assert!((mesh.volume() - 0.01).abs() < 1e-15);
    // the middle point of 27, number 13, is where the diagonals of all eight cubes end, or of two
    for (element, cells) in [("tet4_mirrored", 48), ("tet4", 24)] {
        let mesh = bar([2.0, 2.0, 2.0], element).unwrap();
        let meets = mesh.cells().filter(|cell| cell.nodes.contains(&13)).count();
        assert_eq!(meets, cells, "{element}");
    }
}

fn disordered(generator: &str, element: &'static str, disorder: f64, seed: i64) -> Result<Mesh, MeshError> {
    let values = Values::new()
        .with("element", Value::Text(element))
        .with("disorder", Value::Number(disorder))
        .with("seed", Value::Integer(seed));
    let values = match generator {
        "sheet" => values
            .with("length", Value::Number(2.0))
            .with("width", Value::Number(0.5))
            .with("cells_along", Value::Integer(8))
            .with("cells_across", Value::Integer(6)),
        _ => {
            values.with("size", Value::Vector([2.0, 0.5, 1.0])).with("cells", Value::Vector([6.0, 3.0, 4.0]))
        }
    };
    generate(generator, values)
}

const DISORDERED: [(&str, &[&str]); 2] = [
    (
        "box",
        &[
            "tet4",
            "tet4_centred",
            "tet4_mirrored",
            "hex8",
            "prism6",
            "pyramid5",
            "mixed",
            "tet10",
            "hex20",
            "hex27",
            "prism15",
            "pyramid13",
            "mixed_quadratic",
        ],
    ),
    ("sheet", &["tri3", "tri6", "quad4", "quad8", "quad9", "mixed", "mixed_quadratic"]),
];

/// As far as points may be moved no cell of any kind is turned over, in part either; sides stay, cells conform and fill what they
/// filled, and edges are straight.
#[test]
fn disorder_turns_no_cell_over() {
    for (generator, elements) in DISORDERED {
        for element in elements {
            let regular = disordered(generator, element, 0.0, 1).unwrap();
            let edges =
                if generator == "sheet" { [0.25, 1.0 / 12.0, 1.0] } else { [1.0 / 3.0, 0.5 / 3.0, 0.25] };
            for seed in 0..10 {
                let mut mesh = disordered(generator, element, 0.2, seed).unwrap();
                let repairs = mesh.validate().unwrap();
                assert_eq!(repairs, crate::Repairs { component_count: 1, ..Default::default() }, "{element}");
                let worst = mesh.quality().iter().map(|cell| cell.scaled_jacobian).fold(1.0, f64::min);
                assert!(worst > 0.0, "{element} {seed}: {worst}");
                // hundreds of cells, each rounded to 1e-16
                assert!((mesh.volume() - 1.0).abs() < 1e-13, "{element} {}", mesh.volume());
                mesh.faces().conforming().unwrap();
                let mut most: f64 = 0.0;
                for (before, after) in regular.points.iter().zip(&mesh.points) {
                    let by = *after - *before;
                    let by = Vec3::new(by.x / edges[0], by.y / edges[1], by.z / edges[2]);
                    most = most.max(by.length());
                }
                assert!(most > 0.1 && most <= 0.2 * (1.0 + 1e-14), "{element}: {most}");
                for group in regular.groups.values() {
                    for point in &group.points {
                        assert_eq!(mesh.points[*point as usize], regular.points[*point as usize]);
                    }
                }
                for cell in mesh.cells() {
                    let at = |node: usize| mesh.points[cell.nodes[node] as usize];
                    let middles = cell.kind.middles().iter().zip(cell.kind.corner_count()..);
                    for (ends, node) in middles.filter(|(ends, _)| ends.len() == 2) {
                        let [a, b] = [0, 1].map(|end| at(usize::from(ends[end])));
                        assert_eq!(at(node), super::cut::middle([a, b]), "{element}");
                    }
                }
            }
        }
    }
}

/// The same numbers give the same mesh, another seed another one, and more than is safe is refused.
#[test]
fn disorder_is_the_same_again() {
    let made = |amount, seed| disordered("bar", "mixed", amount, seed).unwrap().points;
    assert_eq!(made(0.1, 1), made(0.1, 1));
    assert_ne!(made(0.1, 1), made(0.1, 2));
    assert_eq!(made(0.0, 1), made(0.0, 2));
    for generator in ["bar", "sheet"] {
        let refused = disordered(generator, "mixed", 0.21, 1).unwrap_err().to_string();
        assert!(refused.contains("`disorder`") && refused.contains("0.2"), "{refused}");
    }
}
