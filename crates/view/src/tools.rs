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
    /// How far about its middle a flat front reaches, in its size: it is put flat on a surface. 0: none, it is held from the eye.
    pub flat: f64,
}

const fn entry(
    name: &'static str,
    summary: &'static str,
    [front, flat]: [f64; 2],
    shape: &'static str,
    values: SizedValues,
) -> Entry<Making> {
    Entry { name, summary, source: "", parameters: &[], build: Making { shape, values, front, flat } }
}

/// All tools; adding one is a line.
pub static TOOLS: Table<Making> = Table {
    kind: "tool",
    entries: &[
        &entry("ball", "round: presses evenly", [0.5, 0.0], "sphere", |size, _| {
            vec![number("radius", 0.5 * size)]
        }),
        &entry("finger", "a rod with a round end: pokes", [0.25, 0.0], "capsule", |size, direction| {
            let back = direction.try_normalised().unwrap_or(Vec3::Y) * (LENGTH * size);
            vec![number("radius", 0.25 * size), vector("from", Vec3::ZERO), vector("to", back)]
        }),
        &entry("block", "a cube: presses flat, with edges", [0.5, SQRT_2 / 2.0], "box", |size, direction| {
            facing([size, size, size], direction)
        }),
        &entry(
            "plate",
            "flat and wide: pushes much at once",
            [0.5 * THIN, SQRT_2],
            "box",
            |size, direction| facing([2.0 * size, 2.0 * size, THIN * size], direction),
        ),
    ],
};

/// Of a finger, in its size.
const LENGTH: f64 = 5.0;
/// Of a plate, in its size: of what is pressed beyond the middle of a plate, its other side would get rid.
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
