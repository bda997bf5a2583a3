//! A figure, a rabbit, a ring and an ellipsoid: bodies for trials and for play.

use souple_math::Vec3;
use souple_table::{Parameter, Range, Value, Values};

use super::blend::Solid;
use super::{Body, BodyEntry, BuildBody};
use crate::MeshError;

const HEIGHT: Parameter =
    Parameter::number("height", "m", Range::POSITIVE, "from the ground to the top").or(Value::Number(0.3));

pub(super) static CHARACTER: BodyEntry = BodyEntry {
    name: "character",
    summary: "a standing figure of gum, arms spread; groups `head`, `feet`, `hands`",
    source: "own",
    parameters: &[HEIGHT],
    build: character as BuildBody,
};

pub(super) static BUNNY: BodyEntry = BodyEntry {
    name: "bunny",
    summary: "a sitting rabbit; groups `ears`, `ground`",
    source: "own",
    parameters: &[HEIGHT],
    build: bunny as BuildBody,
};

pub(super) static TORUS: BodyEntry = BodyEntry {
    name: "torus",
    summary: "a ring around the z axis; its volume is 2π² R r²",
    source: "own",
    parameters: &[
        Parameter::number("ring", "m", Range::POSITIVE, "R, from the axis to the middle of the tube")
            .or(Value::Number(0.1)),
        Parameter::number("tube", "m", Range::POSITIVE, "r, radius of the tube").or(Value::Number(0.035)),
        Parameter::vector("centre", "m", "centre of the ring").or(Value::Vector([0.0; 3])),
    ],
    build: torus as BuildBody,
};

pub(super) static ELLIPSOID: BodyEntry = BodyEntry {
    name: "ellipsoid",
    summary: "an ellipsoid along the axes; a ball if they are equal",
    source: "own",
    parameters: &[
        Parameter::vector("semi_axes", "m", "half its lengths along x, y, z").or(Value::Vector([0.1; 3])),
        Parameter::vector("centre", "m", "its centre").or(Value::Vector([0.0; 3])),
    ],
    build: ellipsoid as BuildBody,
};

const fn at(x: f64, y: f64, z: f64) -> Vec3 {
    Vec3::new(x, y, z)
}

/// The same part on both sides of the plane `x = 0`.
fn both(part: impl Fn(f64) -> Solid) -> [Solid; 2] {
    [part(-1.0), part(1.0)]
}

fn whole(parts: Vec<Solid>, groups: Vec<(&'static str, Solid)>, scale: f64) -> Body {
    let shape = Solid::Union { parts, radius: 0.02 }.scaled(scale);
    let scaled = |(name, solid): (&'static str, Solid)| (name, Box::new(solid.scaled(scale)) as _);
    Body { shape: Box::new(shape), parts: groups.into_iter().map(scaled).collect() }
}

/// Written 0.3 m high, standing on `y = 0`, looking along z.
fn character(values: &Values) -> Result<Body, MeshError> {
    let mut parts = vec![
        Solid::ellipsoid(at(0.0, 0.125, 0.0), at(0.052, 0.062, 0.042)),
        Solid::sphere(at(0.0, 0.235, 0.004), 0.062),
        Solid::ellipsoid(at(0.0, 0.223, 0.058), at(0.022, 0.017, 0.016)),
    ];
    parts.extend(both(|s| {
        Solid::capsule(at(0.044 * s, 0.158, 0.0), at(0.118 * s, 0.182, 0.012), [0.024, 0.021])
    }));
    parts.extend(both(|s| {
        Solid::capsule(at(0.030 * s, 0.085, 0.0), at(0.042 * s, 0.028, 0.008), [0.030, 0.026])
    }));
    parts.extend(both(|s| Solid::ellipsoid(at(0.044 * s, 0.020, 0.020), at(0.026, 0.020, 0.034))));
    parts.extend(both(|s| Solid::ellipsoid(at(0.045 * s, 0.283, -0.002), at(0.020, 0.020, 0.012))));
    let groups = vec![
        ("head", Solid::sphere(at(0.0, 0.245, 0.0), 0.075)),
        ("feet", Solid::HalfSpace { point: at(0.0, 0.012, 0.0), normal: Vec3::Y }),
        (
            "hands",
            Solid::Union {
                parts: both(|s| Solid::sphere(at(0.125 * s, 0.184, 0.012), 0.022)).into(),
                radius: 0.0,
            },
        ),
    ];
    Ok(whole(parts, groups, values.number("height") / 0.3))
}

/// Written 0.3 m high with its ears, sitting on `y = 0`, looking along z.
fn bunny(values: &Values) -> Result<Body, MeshError> {
    let ears = || {
        both(|s| {
            Solid::turned_ellipsoid(
                at(0.024 * s, 0.242, 0.030),
                at(0.018, 0.058, 0.014),
                at(-0.22, 0.0, -0.14 * s),
            )
        })
    };
    let mut parts = vec![
        Solid::turned_ellipsoid(at(0.0, 0.074, -0.018), at(0.062, 0.070, 0.078), at(-0.25, 0.0, 0.0)),
        Solid::ellipsoid(at(0.0, 0.095, 0.032), at(0.042, 0.052, 0.040)),
        Solid::ellipsoid(at(0.0, 0.160, 0.056), at(0.042, 0.040, 0.046)),
        Solid::ellipsoid(at(0.0, 0.148, 0.090), at(0.023, 0.018, 0.018)),
        Solid::sphere(at(0.0, 0.058, -0.100), 0.024),
    ];
    parts.extend(ears());
    parts.extend(both(|s| Solid::ellipsoid(at(0.046 * s, 0.046, -0.022), at(0.030, 0.046, 0.048))));
    parts.extend(both(|s| {
        Solid::capsule(at(0.046 * s, 0.014, -0.030), at(0.046 * s, 0.014, 0.040), [0.016, 0.015])
    }));
    parts.extend(both(|s| {
        Solid::capsule(at(0.022 * s, 0.075, 0.054), at(0.022 * s, 0.015, 0.072), [0.018, 0.014])
    }));
    let groups = vec![
        ("ears", Solid::HalfSpace { point: at(0.0, 0.208, 0.0), normal: -Vec3::Y }),
        ("ground", Solid::HalfSpace { point: at(0.0, 0.012, 0.0), normal: Vec3::Y }),
    ];
    Ok(whole(parts, groups, values.number("height") / 0.3))
}

fn torus(values: &Values) -> Result<Body, MeshError> {
    let (ring, tube) = (values.number("ring"), values.number("tube"));
    if tube >= ring {
        let expected = format!("a radius below that of the ring, {ring} [m]");
        return Err(MeshError::Parameter { name: "tube", value: tube.to_string(), expected });
    }
    let centre = Vec3::from_array(values.vector("centre"));
    Ok(Body { shape: Box::new(Solid::Torus { centre, axis: Vec3::Z, ring, tube }), parts: Vec::new() })
}

fn ellipsoid(values: &Values) -> Result<Body, MeshError> {
    let semi_axes = values.vector("semi_axes");
    if !semi_axes.iter().all(|length| *length > 0.0) {
        let value = Value::Vector(semi_axes).to_string();
        return Err(MeshError::Parameter {
            name: "semi_axes",
            value,
            expected: "three lengths above 0 [m]".to_owned(),
        });
    }
    let centre = Vec3::from_array(values.vector("centre"));
    Ok(Body { shape: Box::new(Solid::ellipsoid(centre, Vec3::from_array(semi_axes))), parts: Vec::new() })
}
