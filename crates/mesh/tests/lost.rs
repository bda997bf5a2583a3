//! A filling says what it has lost of its shape, what it has joined, and which wishes came to nothing.

use souple_math::Vec3;
use souple_mesh::fill::{Filled, Options, PARAMETERS, fill_surface};
use souple_mesh::{TriangleSurface, generate, implicit};
use souple_table::{Value, Values};

fn options(values: Values) -> Options {
    Options::from_values(&values.completed(PARAMETERS).unwrap()).unwrap()
}

fn with_size(size: f64) -> Options {
    options(Values::new().with("size", Value::Number(size)))
}

/// A formula within ±2.
fn filled(formula: &str, options: &Options) -> Filled {
    filled_within(2.0, formula, options)
}

/// A formula within so much of the origin along each axis.
fn filled_within(reach: f64, formula: &str, options: &Options) -> Filled {
    let corner = |c: f64| Value::Vector([c; 3]);
    let values = Values::new()
        .with("formula", Value::Text(formula))
        .with("low", corner(-reach))
        .with("high", corner(reach));
    options.fill_body(&implicit::body("formula", values).unwrap()).unwrap()
}

/// Balls by centre and radius, a negative one a hollow.
fn balls(list: &[(f64, f64)]) -> TriangleSurface {
    let values = Values::new().with("radius", Value::Number(1.0)).with("cells", Value::Integer(8));
    let ball = generate("sphere", values).unwrap().boundary_surface();
    let (mut points, mut triangles) = (Vec::new(), Vec::new());
    for (x, radius) in list {
        let first = points.len() as u32;
        points.extend(ball.points.iter().map(|p| *p * radius.abs() + Vec3::X * *x));
        triangles.extend(ball.triangles.iter().map(|corners| {
            let [a, b, c] = corners.map(|corner| corner + first);
            if *radius < 0.0 { [a, c, b] } else { [a, b, c] }
        }));
    }
    TriangleSurface::new(points, triangles).unwrap()
}

fn notes_of(surface: &TriangleSurface, size: f64) -> String {
    fill_surface(surface, Default::default(), &with_size(size)).unwrap().notes.join("; ")
}

/// What is as thick as a few cells is filled without a word.
#[test]
fn nothing_is_said_of_whole_fillings() {
    let notes = filled("sqrt(x^2 + y^2 + z^2) - 1", &with_size(0.2)).notes;
    assert_eq!(notes, Vec::<String>::new());
    for entry in implicit::SHAPES.entries.iter().filter(|entry| entry.name != "formula") {
        let body = implicit::body(entry.name, Values::new()).unwrap();
        let notes =
            options(Values::new().with("count", Value::Integer(20_000))).fill_body(&body).unwrap().notes;
        assert_eq!(notes, Vec::<String>::new(), "{}", entry.name);
    }
    assert_eq!(notes_of(&balls(&[(0.0, 1.0)]), 0.15), "");
    assert_eq!(notes_of(&balls(&[(0.0, 1.0), (0.0, -0.5)]), 0.1), "");
}

/// A sheet of a fiftieth of a cell beside a ball, a needle and a ball smaller than a cell, wherever they lie between the points of
/// the lattice.
#[test]
fn sheets_and_needles_are_missed() {
    for shift in ["0.013", "0.07", "0.111"] {
        for part in [
            format!("max(abs(z + 1.4 + {shift}) - 0.002, sqrt(x^2 + y^2) - 1.5)"),
            format!("max(sqrt((x - 1.3 - {shift})^2 + (y - 0.07)^2) - 0.003, abs(z) - 1)"),
            format!("sqrt((x + 1.4 + {shift})^2 + (y - 0.31)^2 + z^2) - 0.03"),
        ] {
            let notes = filled(&format!("min(sqrt(x^2 + y^2 + z^2) - 0.6, {part})"), &with_size(0.2)).notes;
            assert!(notes.concat().contains("thinner than a cell is lost"), "{part}: {notes:?}");
        }
    }
}

/// Of two lobes the thin one is lost though both are one part; it is told with its place, from a formula and from triangles.
#[test]
fn a_lobe_is_missed() {
    let lobes = "min(sqrt(x^2 + y^2 + z^2) - 0.8, max(abs(z) - 0.06, sqrt((x - 1)^2 + y^2) - 0.9))";
    let thin = filled(lobes, &with_size(0.31)).notes.concat();
    assert!(thin.contains("lies more than a cell away") || thin.contains("has a part at"), "{thin}");
    let fine = filled(lobes, &with_size(0.05));
    assert_eq!(fine.notes, Vec::<String>::new());
    let told = notes_of(&fine.mesh.boundary_surface(), 0.31);
    assert!(told.contains("of the surface lies more than a cell away from the filling, as at"), "{told}");
}

/// Parts that are lost as a whole are counted, hollows apart; parts that grow together or fall apart are told.
#[test]
fn parts_are_compared() {
    let told = notes_of(&balls(&[(0.0, 1.0), (1.6, 0.02), (1.9, 0.03)]), 0.3);
    assert!(told.contains("2 parts of the 3 of the surface have no cell"), "{told}");
    let told = notes_of(&balls(&[(0.0, 1.0), (1.6, 0.02)]), 0.3);
    assert!(told.contains("1 part of the 2 of the surface has no cell"), "{told}");
    let told = notes_of(&balls(&[(0.0, 1.0), (0.07, -0.03)]), 0.3);
    assert!(told.contains("1 hollow of the surface is filled up"), "{told}");
    let told = notes_of(&balls(&[(0.0, 1.0), (2.02, 1.0)]), 0.3);
    assert!(told.contains("gaps thinner than a cell are closed"), "{told}");
    let told = notes_of(&balls(&[(0.0, 1.0), (3.0, 1.0)]), 0.3);
    assert!(told.contains("2 parts that share no point, as has the surface"), "{told}");
    let bridge = "min(min(sqrt((x-1)^2+y^2+z^2), sqrt((x+1)^2+y^2+z^2)) - 0.8, \
                  max(sqrt((y-0.03)^2+(z-0.04)^2) - 0.08, abs(x) - 1))";
    let told = filled(bridge, &with_size(0.25)).notes.concat();
    assert!(told.contains("what joins them is thinner than a cell"), "{told}");
}

/// Bounds that a body touches or passes by less than a cell cut nothing off its parts.
#[test]
fn parts_at_the_bounds_are_whole() {
    for reach in [0.9, 1.0, 1.05] {
        let notes = filled_within(reach, "sqrt(x^2 + y^2 + z^2) - 1", &with_size(0.2)).notes;
        assert_eq!(notes, Vec::<String>::new(), "{reach}");
    }
}

/// Two balls with a rod of 0.3 cells radius between them, along the diagonal of cubes: the shape is one part however the rod lies
/// to the grid; so thin a gap between two balls is one all the same.
#[test]
fn parts_hold_together_along_diagonals() {
    let size = 0.2;
    for shift in [0.0, 0.013, 0.05, 0.071] {
        let (x, y) = (format!("(x - {shift})"), format!("(y + 0.7*{shift})"));
        let along = format!("({x} + {y} + z)/sqrt(3)");
        let ball = |side: &str| format!("sqrt(({x} {side} 1)^2 + ({y} {side} 1)^2 + (z {side} 1)^2) - 0.7");
        let rod = format!(
            "max(sqrt(max({x}^2 + {y}^2 + z^2 - ({along})^2, 0)) - {}, abs({along}) - 1.5)",
            0.3 * size
        );
        let balls = format!("min({}, {})", ball("-"), ball("+"));
        let joined = filled_within(2.4, &format!("min({balls}, {rod})"), &with_size(size)).notes.concat();
        assert!(!joined.contains("as has the shape") && !joined.contains("gaps"), "{shift}: {joined}");
        let apart = filled_within(2.4, &balls, &with_size(size)).notes.concat();
        assert!(apart.contains("2 parts that share no point, as has the shape"), "{shift}: {apart}");
    }
}

/// Cells as large as they like, of a size far above all lengths: what is far from them is looked for as fast as ever.
#[test]
fn sizes_without_a_bound_are_looked_at() {
    let values = Values::new()
        .with("size", Value::Number(0.1))
        .with("size_everywhere", Value::Text("0.1 + 1e30*max(0.9 - sqrt(x^2 + y^2 + z^2), 0)"))
        .with("largest", Value::Number(1e30));
    let notes = filled("sqrt(x^2 + y^2 + z^2) - 1", &options(values)).notes.concat();
    assert!(!notes.contains("away from the filling") && !notes.contains("has a part at"), "{notes}");
}

/// Growth without room, formulas that allow nothing larger or ask for what is smaller, hexahedra that do not fit, counts that are
/// not met.
#[test]
fn wishes_that_come_to_nothing() {
    let ball = "sqrt(x^2 + y^2 + z^2) - 1";
    let told = |name: &'static str, value: Value<'static>, size: f64| {
        let values = Values::new().with("size", Value::Number(size)).with(name, value);
        filled(ball, &options(values)).notes.concat()
    };
    let growth = told("growth", Value::Number(0.3), 0.4);
    assert!(growth.contains("`growth`: all cells have one size, 0.4 m"), "{growth}");
    assert_eq!(told("growth", Value::Number(0.6), 0.07), "");
    let inside = told("size_inside", Value::Text("0.1 + 0.05*abs(x)"), 0.1);
    assert!(inside.contains("all cells have one size"), "{inside}");
    let smaller = told("size_everywhere", Value::Text("0.05 + 0.3*abs(x)"), 0.1);
    assert!(smaller.contains("and no cell is smaller than `size`, 0.1 m"), "{smaller}");
    assert_eq!(told("size_everywhere", Value::Text("0.1 + 0.3*abs(x)"), 0.1), "");
    let hexes = told("element", Value::Text("hex_dominant"), 1.2);
    assert!(hexes.contains("there are no hexahedra"), "{hexes}");
    let one = filled(ball, &options(Values::new().with("count", Value::Integer(7)))).notes.concat();
    assert!(one.contains("as near to 7 as was found"), "{one}");
}
