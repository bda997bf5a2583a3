//! Pictures whose colours have a meaning of their own: kinds of elements, changed laws, gaps between runs.

use std::sync::Arc;

use souple_io::Field;
use souple_io::picture::{ColourMap, Paint, Picture, Stroke, StrokeShape};
use souple_math::Vec3;
use souple_mesh::{ElementKind, Mesh};
use souple_run::show::{Arrows, BodyMoment, Figure, GAP, Moment, Show, Stage, map_of};
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

/// A dress of triangles is no part of its body's mesh: where kinds of elements are asked for the body is seen, without it, and its cells alone
/// are counted; where the dress has the field the body is hidden, and neither is where nothing is asked for.
#[test]
fn dresses_are_hidden_where_elements_are_seen() {
    let mut show = show(Vec3::ZERO);
    let corners = vec![Vec3::ZERO, Vec3::X, Vec3::Y];
    let tissue = Field::new("tissue", 1, vec![0.0; 3]);
    let dress = BodyMoment {
        name: "bar.skin".to_owned(),
        positions: corners.clone(),
        mesh: Arc::new(Mesh::new(corners, ElementKind::Tri3, vec![0, 1, 2])),
        point_fields: vec![tissue],
        cell_fields: Vec::new(),
        frames: Vec::new(),
    };
    show.moments[0].bodies.push(dress);
    let moment = &show.moments[0];
    let hidden =
        |figure: &Figure| moment.bodies.iter().map(|body| figure.hides(moment, body)).collect::<Vec<_>>();
    assert_eq!(hidden(&coloured_by("element")), [false, true]);
    assert_eq!(hidden(&coloured_by("tissue")), [true, false]);
    assert_eq!(hidden(&coloured_by("adaptation")), [false, true]);
    assert_eq!(hidden(&Figure { colour_by: None, ..Figure::default() }), [false, false]);
    let picture = coloured_by("element").picture(&show, moment).unwrap();
    let names = &picture.legend.as_ref().unwrap().names;
    assert_eq!(names, &[(0.0, "6 tet".to_owned()), (1.0, "1 hex".to_owned())]);
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

/// Balls of several radii without cells, at several moments, that move with `velocity` at the last of them.
fn balls(velocity: Vec3) -> Show {
    let places = [(0.0, 0.0, 0.0), (3.0, 0.5, 0.0), (1.0, 2.0, -1.0)].map(|(x, y, z)| Vec3::new(x, y, z));
    let radii = [1.2, 0.4, 0.8];
    let moment = |time: f64| {
        let positions: Vec<Vec3> = places.iter().map(|x| *x + Vec3::Y * time).collect();
        let velocities = positions.iter().flat_map(|_| (velocity * time).to_array()).collect();
        let body = BodyMoment {
            name: "balls".to_owned(),
            mesh: Arc::new(Mesh { points: positions.clone(), ..Mesh::default() }),
            positions,
            point_fields: vec![
                Field::new("radius", 1, radii.to_vec()),
                Field::new("velocity", 3, velocities),
            ],
            cell_fields: Vec::new(),
            frames: Vec::new(),
        };
        Moment { time, bodies: vec![body] }
    };
    Show { stage: Stage::default(), moments: vec![moment(0.0), moment(0.5), moment(1.0)] }
}

fn arrows_of(picture: &Picture) -> Vec<[Vec3; 2]> {
    let arrow = |stroke: &Stroke| match stroke.shape {
        StrokeShape::Arrow(from, to) => Some([from, to]),
        _ => None,
    };
    picture.strokes.iter().filter_map(arrow).collect()
}

/// Along any direction what the camera stands back for reaches as far as every ball with its radius and every arrow with its tip do
/// at any moment, but for the three hundredths of the size that the margin has room for.
#[test]
fn balls_and_arrows_are_framed() {
    let show = balls(Vec3::new(0.0, 2.0, 0.3));
    for scale in [None, Some(3.0)] {
        let arrows = Some(Arrows { field: "velocity".to_owned(), scale });
        let (pictures, notes) = Figure { arrows, ..coloured_by("radius") }.pictures(&show).unwrap();
        assert!(notes.is_empty(), "{notes:?}");
        let reach = |direction: Vec3, picture: &Picture| {
            let balls = picture.framed.iter().map(|ball| ball.centre.dot(direction) + ball.radius);
            balls.fold(f64::NEG_INFINITY, f64::max)
        };
        let size = pictures[0].view.bounds.unwrap().diagonal();
        for picture in &pictures {
            let seen = picture.surfaces.iter().flat_map(|surface| &surface.points).copied();
            let tips = arrows_of(picture).into_iter().flatten();
            for point in seen.chain(tips) {
                let middle = picture.view.bounds.unwrap().centre();
                let out = (point - middle).try_normalised().unwrap();
                assert!(reach(out, picture) > point.dot(out) - 0.03 * size, "{point:?}");
            }
        }
    }
}

/// Particles have arrows, each as long as the key says, that begin where they leave their ball; one of length zero is none.
#[test]
fn particles_have_arrows() {
    let show = balls(Vec3::new(0.0, 2.0, 0.0));
    let arrows = Some(Arrows { field: "velocity".to_owned(), scale: Some(0.25) });
    let (pictures, _) = Figure { arrows, ..coloured_by("radius") }.pictures(&show).unwrap();
    assert!(arrows_of(&pictures[0]).is_empty());
    let drawn = arrows_of(&pictures[2]);
    assert_eq!(drawn.len(), 3);
    for ([from, to], (x, radius)) in
        drawn.iter().zip(show.moments[2].bodies[0].positions.iter().zip([1.2, 0.4, 0.8]))
    {
        assert!(((*from - *x) - Vec3::Y * radius).length() < 1e-12, "{from:?}");
        assert!(((*to - *from) - Vec3::Y * 0.5).length() < 1e-12, "{to:?}");
    }
    assert_eq!(pictures[2].key.as_ref().unwrap().scale, 0.25);
}

/// Of a field that is zero everywhere the legend says zero, and there are no arrows, which is said, and no key of their length.
#[test]
fn zeros_are_told() {
    let show = balls(Vec3::ZERO);
    for scale in [None, Some(1.0)] {
        let arrows = Some(Arrows { field: "velocity".to_owned(), scale });
        let (pictures, notes) = Figure { arrows, ..coloured_by("velocity") }.pictures(&show).unwrap();
        assert!(
            notes.concat().contains("there is no arrow: all values of `velocity` that are seen are zero"),
            "{notes:?}"
        );
        for picture in &pictures {
            assert!(picture.strokes.is_empty() && picture.key.is_none());
            assert_eq!(picture.legend.as_ref().unwrap().range, Some((0.0, 0.0)));
            picture.render().unwrap();
        }
    }
}
