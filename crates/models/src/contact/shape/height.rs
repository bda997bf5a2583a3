//! Ground under a height: everything below `z = f(x, y)`.

use souple_formal::Formula;
use souple_math::{Mat3, Vec3};
use souple_mesh::TriangleSurface;
use souple_table::{Parameter, Value};

use super::{Nearest, Outline, Shape, ShapeEntry, ShapeError};

/// Below the height, which goes on beyond the corners; these bound what is drawn.
///
/// The nearest place is where the line to it stands across the ground. Deep under a bend, or high above a hollow, where several
/// places may be the nearest, the plane that touches the ground below the point stands for it.
#[derive(Clone, Debug)]
pub struct Height {
    /// Of x, y [m].
    formula: Formula,
    /// Corners of what is drawn, by x and y [m].
    low: Vec3,
    high: Vec3,
}

/// Variables of the height.
const VARIABLES: [&str; 2] = ["x", "y"];
/// Feet on planes, at most.
const FEET: usize = 60;
/// Of its distance, how far the foot of a point moves when it is found.
const FOUND: f64 = 1e-14;
/// Of the size of what is drawn: where slopes are compared for their change.
const BEND: f64 = 1e-5;
/// Squares along each side of what is drawn.
const SQUARES: usize = 64;

impl Height {
    /// Place of the ground at x, y, and its normal.
    fn ground(&self, x: f64, y: f64) -> (Vec3, Vec3) {
        let along_x = self.formula.differentiate(&[x, y], 0);
        let along_y = self.formula.differentiate(&[x, y], 1).derivative;
        let normal = Vec3::new(-along_x.derivative, -along_y, 1.0);
        (Vec3::new(x, y, along_x.value), normal / normal.length())
    }

    /// The place of the ground that a point is right above or below.
    fn foot(&self, point: Vec3) -> Option<(Vec3, Vec3)> {
        let (mut place, mut normal) = self.ground(point.x, point.y);
        let mut moved = f64::INFINITY;
        for _ in 0..FEET {
            let foot = point - normal * (point - place).dot(normal);
            let (next, turned) = self.ground(foot.x, foot.y);
            let step = (next - place).length();
            // feet that do not draw together are of no one place
            if step.is_nan() || step > moved {
                return None;
            }
            (place, normal, moved) = (next, turned, step);
            if step <= FOUND * (1.0 + place.length()) {
                return Some((place, normal));
            }
        }
        None
    }

    /// `∂normal/∂x` on the ground: `-P ∇²f P/√(1 + |∇f|²)`, `P = I - n nᵀ`.
    fn bend(&self, place: Vec3, normal: Vec3) -> Mat3 {
        let step = BEND * (self.high - self.low).length().max(f64::MIN_POSITIVE);
        let slope = |x: f64, y: f64, by: usize| self.formula.differentiate(&[x, y], by).derivative;
        let (x, y) = (place.x, place.y);
        let by_x = |by| (slope(x + step, y, by) - slope(x - step, y, by)) / (2.0 * step);
        let by_y = |by| (slope(x, y + step, by) - slope(x, y - step, by)) / (2.0 * step);
        let mixed = 0.5 * (by_x(1) + by_y(0));
        let hessian =
            Mat3::from_columns(Vec3::new(by_x(0), mixed, 0.0), Vec3::new(mixed, by_y(1), 0.0), Vec3::ZERO);
        let across = Mat3::IDENTITY - normal.outer(normal);
        across * hessian * across * -normal.z
    }
}

impl Shape for Height {
    fn nearest(&self, point: Vec3, reach: f64) -> Option<Nearest> {
        if !point.is_finite() {
            return None;
        }
        let Some((place, normal)) = self.foot(point) else {
            let (place, normal) = self.ground(point.x, point.y);
            let distance = (point - place).dot(normal);
            return (distance <= reach).then_some(Nearest { distance, normal, curvature: Mat3::ZERO });
        };
        let distance = (point - place).dot(normal);
        if distance > reach {
            return None;
        }
        // seen from a distance, the normal turns by C (I + d C)⁻¹
        let bend = self.bend(place, normal);
        let curvature = (Mat3::IDENTITY + bend * distance).try_inverse().map_or(Mat3::ZERO, |far| bend * far);
        Some(Nearest { distance, normal, curvature: curvature.symmetric_part() })
    }

    fn undefined_at(&self, point: Vec3) -> Option<String> {
        let (place, normal) = self.ground(point.x, point.y);
        let text = self.formula.text();
        match (place.z.is_finite(), normal.is_finite()) {
            (true, true) => None,
            (false, _) => Some(format!("its height `{text}` is {}", place.z)),
            (true, false) => Some(format!("its height `{text}` has no slope")),
        }
    }

    fn outline(&self) -> Option<Outline> {
        let side = SQUARES as u32 + 1;
        let share = |n: u32| f64::from(n) / SQUARES as f64;
        let size = self.high - self.low;
        let place = |i: u32, j: u32| {
            let (x, y) = (self.low.x + share(i) * size.x, self.low.y + share(j) * size.y);
            Vec3::new(x, y, self.formula.evaluate(&[x, y]))
        };
        let points =
            (0..side).flat_map(|j| (0..side).map(move |i| (i, j))).map(|(i, j)| place(i, j)).collect();
        let squares = (0..side - 1).flat_map(|j| (0..side - 1).map(move |i| j * side + i));
        let triangles =
            squares.flat_map(|a| [[a, a + 1, a + side + 1], [a, a + side + 1, a + side]]).collect();
        Some(Outline::solid(TriangleSurface { points, triangles, ..TriangleSurface::default() }))
    }
}

pub(super) const ENTRY: ShapeEntry = ShapeEntry {
    name: "height",
    summary: "the ground below a height that is a formula of x and y: terrains, moulds that are open above",
    source: "Jimenez 1993, P2-III.2.2: moulding on z = f(x, y)",
    parameters: &[
        Parameter::text("height", "z of the ground [m], as a formula of x and y [m]"),
        Parameter::vector("low", "m", "a corner of what is drawn, by its x and y alone")
            .or(Value::Vector([-1.0, -1.0, 0.0])),
        Parameter::vector("high", "m", "the opposite corner, by its x and y alone")
            .or(Value::Vector([1.0, 1.0, 0.0])),
    ],
    build: |values, _| {
        let text = values.text("height");
        let unfit = |field, value, expected| ShapeError::Unfit { field, value, expected };
        let formula = Formula::compile(text, &VARIABLES).map_err(|error| ShapeError::Formula {
            field: "height",
            text: text.to_owned(),
            variables: "x and y",
            example: "\"0.1 * sin(x)\"",
            error: Box::new(error),
        })?;
        let corner = |name| Vec3::from_array(values.vector(name));
        let (low, high) = (corner("low"), corner("high"));
        if !(high.x > low.x && high.y > low.y) {
            let value = format!("{:?}", high.to_array());
            return Err(unfit("high", value, "greater than `low` in x and y"));
        }
        let middle = (low + high) * 0.5;
        if !formula.evaluate(&[middle.x, middle.y]).is_finite() {
            return Err(unfit("height", format!("\"{text}\""), "finite in the middle of what is drawn"));
        }
        Ok(Box::new(Height { formula, low, high }))
    },
};
