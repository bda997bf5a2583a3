//! A liver: two lobes under a dome, a hollow visceral side, a capsule, a portal vein, ligaments.
//!
//! Seen from the front: x to the right (the patient's left), y up, z to the viewer; 0.2 m wide for a width of 0.2.
//! Proportions after the drawings of any atlas of anatomy; no data of a person.

use souple_math::Vec3;
use souple_table::{Parameter, Range, Value, Values};

use super::blend::Solid;
use super::{Body, BodyEntry, BuildBody};
use crate::MeshError;

pub(super) static LIVER: BodyEntry = BodyEntry {
    name: "liver",
    summary: "a liver; groups `capsule` (its skin), `vein` (the portal tree), `gall_bladder`, `ligament` (where it hangs)",
    source: "proportions after the plates of Gray 1918, figs. 1085-1087",
    parameters: &[
        Parameter::number("width", "m", Range::POSITIVE, "from side to side").or(Value::Number(0.2)),
        Parameter::number("capsule", "m", Range::NOT_NEGATIVE, "thickness of the capsule's layer of cells")
            .or(Value::Number(0.005)),
    ],
    build: build as BuildBody,
};

/// Width of the solids below as they are written [m].
const WIDTH: f64 = 0.2;

fn build(values: &Values) -> Result<Body, MeshError> {
    let scale = values.number("width") / WIDTH;
    let body = body().scaled(scale);
    let depth = Solid::Offset { solid: Box::new(body.clone()), distance: -values.number("capsule") };
    Ok(Body {
        parts: vec![
            ("capsule", Box::new(Solid::Complement(Box::new(depth)))),
            ("gall_bladder", Box::new(gall_bladder().scaled(scale))),
            ("vein", Box::new(portal_vein().scaled(scale))),
            ("ligament", Box::new(ligament().scaled(scale))),
        ],
        shape: Box::new(body),
    })
}

const fn at(x: f64, y: f64, z: f64) -> Vec3 {
    Vec3::new(x, y, z)
}

fn body() -> Solid {
    let right_lobe =
        Solid::turned_ellipsoid(at(-0.032, -0.006, 0.0), at(0.066, 0.068, 0.056), at(0.0, 0.0, 0.25));
    let right_tip =
        Solid::turned_ellipsoid(at(-0.062, -0.045, 0.012), at(0.034, 0.042, 0.034), at(0.0, 0.0, 0.35));
    let left_lobe =
        Solid::turned_ellipsoid(at(0.044, 0.021, 0.008), at(0.058, 0.032, 0.030), at(0.0, 0.12, -0.14));
    let left_tip =
        Solid::turned_ellipsoid(at(0.084, 0.017, 0.006), at(0.030, 0.017, 0.014), at(0.0, 0.2, -0.35));
    let caudate =
        Solid::turned_ellipsoid(at(0.004, 0.006, -0.034), at(0.015, 0.026, 0.014), at(0.0, 0.0, 0.1));
    let lobes = Solid::Union { parts: vec![right_lobe, right_tip, left_lobe, left_tip], radius: 0.03 };
    // the stomach and the gut have pressed the visceral side hollow: a sharp lower margin remains in front
    let gut =
        Solid::turned_ellipsoid(at(0.034, -0.086, -0.052), at(0.105, 0.088, 0.062), at(0.25, 0.15, 0.32));
    let kidney =
        Solid::turned_ellipsoid(at(-0.055, -0.055, -0.066), at(0.030, 0.050, 0.034), at(0.1, 0.0, 0.15));
    let hollow = Solid::Union { parts: vec![gut, kidney], radius: 0.015 };
    let wedge = lobes.without(hollow, 0.012);
    let with_caudate = Solid::Union { parts: vec![wedge, caudate], radius: 0.012 };
    // the vena cava runs behind, the falciform ligament parts the lobes in front, the gall bladder lies below
    let vena_cava = Solid::capsule(at(-0.012, 0.08, -0.050), at(-0.016, -0.06, -0.052), [0.012, 0.012]);
    let notch = Solid::capsule(at(0.026, -0.056, 0.034), at(0.020, -0.024, 0.030), [0.009, 0.001]);
    let crease =
        Solid::turned_ellipsoid(at(0.013, 0.008, 0.060), at(0.0060, 0.056, 0.0165), at(0.22, 0.0, 0.08));
    let gall_bed = Solid::capsule(at(-0.022, -0.070, 0.020), at(-0.006, -0.024, -0.020), [0.011, 0.007]);
    let organ = with_caudate
        .without(vena_cava, 0.010)
        .without(notch, 0.007)
        .without(crease, 0.012)
        .without(gall_bed, 0.008);
    Solid::Union { parts: vec![organ, gall_bladder()], radius: 0.004 }
}

/// Grown to its bed under the right lobe, its end below the margin.
fn gall_bladder() -> Solid {
    Solid::capsule(at(-0.021, -0.063, 0.024), at(-0.008, -0.024, -0.014), [0.0095, 0.0045])
}

/// The portal vein from the hilum into both lobes.
fn portal_vein() -> Solid {
    let branch = |from, to, radii| Solid::capsule(from, to, radii);
    let (hilum, fork) = (at(0.006, -0.012, -0.022), at(-0.004, 0.002, -0.008));
    let (right, left) = (at(-0.038, 0.008, 0.004), at(0.036, 0.022, 0.006));
    Solid::Union {
        parts: vec![
            branch(hilum, fork, [0.008, 0.0075]),
            branch(fork, right, [0.0072, 0.0062]),
            branch(right, at(-0.062, 0.034, 0.006), [0.0056, 0.0035]),
            branch(right, at(-0.064, -0.020, 0.018), [0.0056, 0.0035]),
            branch(right, at(-0.034, 0.040, 0.012), [0.0052, 0.0032]),
            branch(fork, left, [0.0062, 0.0050]),
            branch(left, at(0.074, 0.020, 0.008), [0.0046, 0.0030]),
            branch(left, at(0.044, 0.006, 0.018), [0.0042, 0.0028]),
        ],
        radius: 0.006,
    }
}

/// The coronary ligament and the triangular ones beside it, at the top towards the back.
fn ligament() -> Solid {
    Solid::capsule(at(-0.060, 0.052, -0.026), at(0.030, 0.056, -0.016), [0.016, 0.013])
}
