//! Pictures whose colours have a meaning of their own: kinds of elements, changed laws, gaps between runs.

use std::sync::Arc;

use souple_io::Field;
use souple_io::picture::{ColourMap, Paint};
use souple_math::Vec3;
use souple_mesh::Mesh;
use souple_run::show::{BodyMoment, Figure, GAP, Moment, Show, Stage, map_of};
use souple_table::{Value, Values};

/// A bar of a hexahedron, then six tetrahedra, moved by `shift`.
fn show(shift: Vec3) -> Show {
    let values = Values::new()
        .with("size", Value::Vector([2.0, 1.0, 1.0]))
        .with("cells", Value::Vector([2.0, 1.0, 1.0]))
        .with("elements", Value::Text("hex8 tet4"))
        .with("ends", Value::Numbers(&[0.5, 1.0]));
    let mesh: Mesh = souple_mesh::generate("bar_of_parts", values).unwrap();
    // the law of one cell has changed, others near their threshold by their number
    let adaptation = (0..mesh.cell_count()).map(|cell| if cell == 0 { -1.0 } else { cell as f64 / 6.0 });
    let body = BodyMoment {
        name: "bar".to_owned(),
        positions: mesh.points.iter().map(|x| *x + shift).collect(),
        point_fields: Vec::new(),
        cell_fields: vec![Field::new("adaptation", 1, adaptation.collect())],
        frames: Vec::new(),
        mesh: Arc::new(mesh),
    };
    Show { stage: Stage::default(), moments: vec![Moment { time: 0.0, bodies: vec![body] }] }
}

fn coloured_by(quantity: &str) -> Figure {
    let colours = map_of(quantity).unwrap_or_default();
    Figure { colour_by: Some(quantity.to_owned()), colours, ..Figure::default() }
}

/// Each cell has a colour of its own: blue where the law has changed, green to red elsewhere, nothing mixed.
#[test]
fn changed_laws_are_blue() {
    let show = show(Vec3::ZERO);
    let picture = coloured_by("adaptation").picture(&show, &show.moments[0]).unwrap();
    let Paint::TriangleScalar(values) = &picture.surfaces[0].paint else {
        panic!("{:?}", picture.surfaces[0].paint)
    };
    assert!(values.contains(&-1.0) && values.contains(&1.0));
    let (low, high) = ColourMap::Adaptation.own_range().unwrap();
    let colour = |value: f64| picture.colours.colour((value - low) / (high - low)).to_screen();
    let [blue, green, red] = [-1.0, 0.01, 1.0].map(colour);
    assert!(
        blue[2] > 2 * blue[0] && green[1] > 2 * green[0] && red[0] > 2 * red[2],
        "{blue:?} {green:?} {red:?}"
    );
    picture.render().unwrap();
}

/// Kinds of elements have their colours, names and counts; cells may be drawn smaller, all of their faces then.
#[test]
fn kinds_of_elements_have_colours() {
    let show = show(Vec3::ZERO);
    let whole = coloured_by("element").picture(&show, &show.moments[0]).unwrap();
    let names = &whole.legend.as_ref().unwrap().names;
    assert_eq!(names, &[(0.0, "6 tet".to_owned()), (1.0, "1 hex".to_owned())]);
    let figure = Figure { shrink: 0.25, ..coloured_by("element") };
    let shrunk = figure.picture(&show, &show.moments[0]).unwrap();
    // six squares of two triangles, and six tetrahedra of four
    assert_eq!(shrunk.surfaces[0].triangles.len(), 12 + 24);
    // the hexahedron about (1/2, 1/2, 1/2)
    let corner = Vec3::new(0.125, 0.125, 0.125);
    assert!(shrunk.surfaces[0].points.iter().any(|point| (*point - corner).length() < 1e-12));
    shrunk.render().unwrap();
}

/// The gap is where one run stands less where another does; a run of other bodies has none.
#[test]
fn gaps_are_distances() {
    let (mut one, other) = (show(Vec3::new(0.0, 0.5, 0.0)), show(Vec3::ZERO));
    one.against(&other).unwrap();
    let gap = &one.moments[0].bodies[0].point_fields[0];
    assert_eq!((gap.name.as_str(), &gap.values[..3]), (GAP, &[0.0, 0.5, 0.0][..]));
    coloured_by(GAP).picture(&one, &one.moments[0]).unwrap().render().unwrap();
    let mut strangers = other;
    strangers.moments[0].bodies[0].name = "beam".to_owned();
    assert!(one.against(&strangers).unwrap_err().to_string().contains("without a body `bar`"));
}
