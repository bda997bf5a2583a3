//! Tools that a hand may push with: shapes of the table of shapes, in a size and held from a direction.

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
}

const fn entry(
    name: &'static str,
    summary: &'static str,
    front: f64,
    shape: &'static str,
    values: SizedValues,
) -> Entry<Making> {
    Entry { name, summary, source: "", parameters: &[], build: Making { shape, values, front } }
}

/// All tools; adding one is a line.
pub static TOOLS: Table<Making> = Table {
    kind: "tool",
    entries: &[
        &entry("ball", "round: presses evenly", 0.5, "sphere", |size, _| vec![number("radius", 0.5 * size)]),
        &entry("finger", "a rod with a round end: pokes", 0.25, "capsule", |size, direction| {
            let back = direction.try_normalised().unwrap_or(Vec3::Y) * (LENGTH * size);
            vec![number("radius", 0.25 * size), vector("from", Vec3::ZERO), vector("to", back)]
        }),
        &entry("block", "a cube: presses flat, with edges", 0.5, "box", |size, _| {
            vec![vector("size", Vec3::new(size, size, size))]
        }),
        &entry("plate", "flat, across the view: pushes widely", 0.25, "box", |size, direction| {
            // boxes stand along the axes
            let along = direction.to_array().map(f64::abs);
            let thin = (0..3).max_by(|a, b| along[*a].total_cmp(&along[*b])).unwrap_or(0);
            let sides = [0, 1, 2].map(|axis| if axis == thin { THIN * size } else { 2.0 * size });
            vec![vector("size", Vec3::from_array(sides))]
        }),
    ],
};

/// Of a finger, in its size.
const LENGTH: f64 = 5.0;
/// Of a plate, in its size: of what is pressed beyond the middle of a plate, its other side would get rid.
const THIN: f64 = 0.5;

fn number(name: &str, value: f64) -> (String, Vec<f64>) {
    (name.to_owned(), vec![value])
}

fn vector(name: &str, value: Vec3) -> (String, Vec<f64>) {
    (name.to_owned(), value.to_array().to_vec())
}
