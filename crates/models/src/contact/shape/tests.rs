//! Shapes against their formulas.

use souple_math::Vec3;
use souple_mesh::TriangleSurface;
use souple_table::{Value, Values};

use super::*;

fn no_surface(_: &str) -> Result<TriangleSurface, String> {
    Err("there are no files here".to_owned())
}

/// A cube of unit sides as a closed surface, from the generator.
fn cube(_: &str) -> Result<TriangleSurface, String> {
    let values = Values::new()
        .with("size", Value::Vector([1.0; 3]))
        .with("cells", Value::Vector([2.0; 3]))
        .with("element", Value::Text("tet4"));
    Ok(souple_mesh::generate("box", values).map_err(|error| error.to_string())?.boundary_surface())
}

fn build(name: &str, given: Values) -> Result<Box<dyn Shape>, ShapeError> {
    let entry = SHAPES.find(name).unwrap();
    (entry.build)(&entry.values(given).unwrap(), &cube)
}

fn all() -> Vec<Box<dyn Shape>> {
    let mut shapes =
        vec![build("plane", Values::new().with("normal", Value::Vector([1.0, 2.0, -1.0]))).unwrap()];
    // slopes above one half a metre about: one foot for every point that is asked about
    let height =
        Values::new().with("height", Value::Text("0.3 * x - 0.2 * y + 0.04 * sin(2 * x) * cos(y) - 0.4"));
    shapes.push(build("height", height).unwrap());
    for hollow in [false, true] {
        let sizes = Values::new().with("hollow", Value::Boolean(hollow));
        let segment = sizes
            .clone()
            .with("from", Value::Vector([0.1, 0.2, 0.3]))
            .with("to", Value::Vector([1.0, 0.4, 0.2]));
        shapes.push(build("sphere", sizes.clone().with("radius", Value::Number(0.7))).unwrap());
        shapes.push(build("capsule", segment.with("radius", Value::Number(0.4))).unwrap());
        let sides = sizes.clone().with("size", Value::Vector([1.0, 0.6, 0.8]));
        shapes.push(build("box", sides.clone()).unwrap());
        shapes.push(build("box", sides.with("turn", Value::Vector([0.3, -0.4, 0.5]))).unwrap());
        shapes.push(build("closed_surface", sizes.with("surface", Value::Text("cube"))).unwrap());
    }
    shapes
}

/// The normal is the gradient of the distance, and the curvature that of the normal.
#[test]
fn distances_agree_with_their_derivatives() {
    let step = 1e-6;
    for shape in all() {
        for i in 0..60 {
            let at = |k: f64| 2.0 * ((i as f64 + 1.0) * k).fract() - 0.7;
            let point = Vec3::new(at(0.754_877), at(0.569_840), at(0.438_579));
            let nearest = |point| shape.nearest(point, f64::INFINITY).unwrap();
            let here = nearest(point);
            for (axis, unit) in Vec3::AXES.into_iter().enumerate() {
                let (plus, minus) = (nearest(point + unit * step), nearest(point - unit * step));
                let slope = (plus.distance - minus.distance) / (2.0 * step);
                // rounding 1e-16/step, bending step²/distance², with distances above 1e-2 here
                assert!((slope - here.normal[axis]).abs() < 1e-7, "{shape:?} at {point:?}");
                let turn = (plus.normal - minus.normal) * (0.5 / step);
                let error = (turn - here.curvature.columns[axis]).length();
                assert!(error < 1e-5 * (1.0 + turn.length()), "{shape:?} at {point:?}: {turn:?}");
            }
        }
    }
}

/// Within reach the answer is the same whatever the reach; none is given up that is not beyond it.
#[test]
fn reach_gives_up_what_is_beyond() {
    for shape in all() {
        for i in 0..200 {
            let at = |k: f64| 4.0 * ((i as f64 + 1.0) * k).fract() - 2.0;
            let point = Vec3::new(at(0.618), at(0.755), at(0.570));
            let nearest = shape.nearest(point, f64::INFINITY).unwrap();
            for reach in [0.0, 0.01, 0.5] {
                match shape.nearest(point, reach) {
                    Some(within) => assert_eq!(within, nearest, "{shape:?} at {point:?}"),
                    None => assert!(nearest.distance >= reach, "{shape:?} at {point:?}: {nearest:?}"),
                }
            }
        }
    }
}

/// Centres, faces and points that are not finite have answers decided on purpose.
#[test]
fn degenerate_points() {
    let sphere = build("sphere", Values::new().with("radius", Value::Number(2.0))).unwrap();
    let centre = sphere.nearest(Vec3::ZERO, f64::INFINITY).unwrap();
    assert_eq!((centre.distance, centre.normal), (-2.0, Vec3::Z));
    let cuboid = build("box", Values::new().with("size", Value::Vector([2.0; 3]))).unwrap();
    let face = cuboid.nearest(Vec3::Y, f64::INFINITY).unwrap();
    assert_eq!((face.distance, face.normal), (0.0, Vec3::Y));
    let surface = build("closed_surface", Values::new().with("surface", Value::Text("cube"))).unwrap();
    let on = surface.nearest(Vec3::new(0.3, 0.2, 1.0), 0.1).unwrap();
    assert!(on.distance.abs() < 1e-15 && (on.normal - Vec3::Z).length() < 1e-15, "{on:?}");
    assert!(surface.nearest(Vec3::X * 3.0, 0.1).is_none());
    for shape in all() {
        assert!(shape.nearest(Vec3::new(f64::NAN, 0.0, 0.0), f64::INFINITY).is_none(), "{shape:?}");
    }
    let point = Values::new().with("from", Value::Vector([0.0; 3])).with("to", Value::Vector([0.0; 3]));
    let ball = build("capsule", point.with("radius", Value::Number(1.0))).unwrap();
    assert_eq!(ball.nearest(Vec3::X * 3.0, f64::INFINITY).unwrap().distance, 2.0);
}

/// The outline of a bounded shape is closed, lies on it and faces out of the solid; that of the ground, which goes on beyond what
/// is drawn, is open and faces up; only planes have none.
#[test]
fn outlines_lie_on_their_shapes() {
    for shape in all() {
        let Some(Outline { surface, bodies }) = shape.outline() else {
            assert!(shape.as_plane().is_some(), "{shape:?}");
            continue;
        };
        let size = surface.bounds().diagonal();
        for point in &surface.points {
            let distance = shape.nearest(*point, f64::INFINITY).unwrap().distance;
            assert!(distance.abs() < 1e-14 * size, "{shape:?} at {point:?}: {distance}");
        }
        if surface.check_closed().is_err() {
            let below = surface.bounds().centre() - Vec3::Z * (1e3 * size);
            assert!(shape.nearest(below, f64::INFINITY).unwrap().distance < 0.0, "{shape:?}");
            for [a, b, c] in
                surface.triangles.iter().map(|corners| corners.map(|at| surface.points[at as usize]))
            {
                assert!((b - a).cross(c - a).z > 0.0, "{shape:?}");
            }
            continue;
        }
        let volume = surface.enclosed_volume();
        assert!(if bodies == Side::Outside { volume > 0.0 } else { volume < 0.0 }, "{shape:?}: {volume}");
    }
}

#[test]
fn bad_shapes_are_named() {
    let error = build("plane", Values::new().with("normal", Value::Vector([0.0; 3]))).unwrap_err();
    assert_eq!(error.to_string(), "`normal` is [0.0, 0.0, 0.0], but must be a vector that is not zero");
    assert!(build("box", Values::new().with("size", Value::Vector([1.0, 0.0, 1.0]))).is_err());
    let entry = SHAPES.find("closed_surface").unwrap();
    let values = entry.values(Values::new().with("surface", Value::Text("bone.obj"))).unwrap();
    let error = (entry.build)(&values, &no_surface).unwrap_err();
    assert_eq!(error.to_string(), "`surface` = \"bone.obj\" cannot be read: there are no files here");
    let open = |name: &str| {
        cube(name).map(|mut surface| {
            surface.triangles.pop();
            surface
        })
    };
    assert!(matches!((entry.build)(&values, &open), Err(ShapeError::Surface { .. })));
}
