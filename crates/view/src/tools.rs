//! Tools that a hand may push with: shapes of the table of shapes, in a size and held from a direction.

use std::f64::consts::SQRT_2;

use souple_math::Vec3;
use souple_table::{Entry, Table};

/// Values of a shape for a size [m] and the direction it is held from.
pub type SizedValues = fn(f64, Vec3) -> Vec<(String, Vec<f64>)>;

/// How a tool of a size [m] is made, held from where `direction` points to: the name of its shape, and its values.
#[derive(Clone, Copy)]
pub struct Making {
    pub shape: &'static str,
    pub values: SizedValues,
    /// How far its front is from its origin, in its size.
    pub front: f64,
    /// Whether it is made of rounded parts, which meet triangles; others meet points.
    pub is_rounded: bool,
    /// How far about its middle a flat front reaches, in its size: it is put flat on a surface. `None`: it is held from the eye.
    pub flat: Option<f64>,
}

const fn entry(name: &'static str, summary: &'static str, build: Making) -> Entry<Making> {
    Entry { name, summary, source: "", parameters: &[], build }
}

/// All tools; adding one is an entry.
pub static TOOLS: Table<Making> = Table {
    kind: "tool",
    entries: &[
        &entry(
            "ball",
            "round: presses evenly",
            Making {
                shape: "sphere",
                values: |size, _| vec![number("radius", 0.5 * size)],
                front: 0.5,
                is_rounded: true,
                flat: None,
            },
        ),
        &entry(
            "finger",
            "a rod with a round end: pokes",
            Making {
                shape: "capsule",
                values: |size, direction| {
                    let back = direction.try_normalised().unwrap_or(Vec3::Y) * (LENGTH * size);
                    vec![number("radius", THICK * size), vector("from", Vec3::ZERO), vector("to", back)]
                },
                front: THICK,
                is_rounded: true,
                flat: None,
            },
        ),
        &entry(
            "block",
            "a cube: presses flat, with edges",
            Making {
                shape: "box",
                values: |size, direction| facing([size, size, size], direction),
                front: 0.5,
                is_rounded: false,
                flat: Some(0.5 * SQRT_2),
            },
        ),
        &entry(
            "plate",
            "flat and wide: pushes much at once",
            Making {
                shape: "box",
                values: |size, direction| facing([WIDE * size, WIDE * size, THIN * size], direction),
                front: 0.5 * THIN,
                is_rounded: false,
                flat: Some(0.5 * WIDE * SQRT_2),
            },
        ),
    ],
};

/// Of a finger, in its size, and its radius.
const LENGTH: f64 = 5.0;
const THICK: f64 = 0.25;
/// Sides and thickness of a plate, in its size. What gets beyond the middle of a box is pushed out on its other side: a plate
/// is not as thin as it could be.
const WIDE: f64 = 2.0;
const THIN: f64 = 0.5;

/// A box whose own z looks in a direction, turned the shortest way there.
fn facing(sides: [f64; 3], direction: Vec3) -> Vec<(String, Vec<f64>)> {
    let towards = direction.try_normalised().unwrap_or(Vec3::Z);
    let angle = libm::atan2(Vec3::Z.cross(towards).length(), towards.dot(Vec3::Z));
    let axis = Vec3::Z.cross(towards).try_normalised().unwrap_or(Vec3::X);
    vec![vector("size", Vec3::from_array(sides)), vector("turn", axis * angle)]
}

fn number(name: &str, value: f64) -> (String, Vec<f64>) {
    (name.to_owned(), vec![value])
}

fn vector(name: &str, value: Vec3) -> (String, Vec<f64>) {
    (name.to_owned(), value.to_array().to_vec())
}
