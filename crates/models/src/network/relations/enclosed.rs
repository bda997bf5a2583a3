//! What masses enclose: the area within a closed line seen along an axis, the volume within a closed surface.

use souple_formal::Formula;
use souple_math::{Mat3, Vec3};

use super::{Relation, first_row};

/// `g = A − s(t) A₀` with `A = ½ n·Σ x_i × x_{i+1}` of a closed line. Its multiplier is a tension of the plane [N/m].
#[derive(Clone, Debug)]
pub struct Area {
    /// In the order of the line, whose last goes on to its first.
    pub rows: Vec<u32>,
    /// Of length 1: the line is counted counterclockwise seen against it.
    pub normal: Vec3,
    /// [m²]
    pub area: f64,
    /// The part of it that is kept, of the time.
    pub part: Formula,
}

impl Area {
    /// What is enclosed [m²].
    pub fn enclosed(&self, positions: &[Vec3]) -> f64 {
        let count = self.rows.len();
        let at = |index: usize| positions[self.rows[index % count] as usize];
        // from one of its own places: far away rounding would eat it
        let origin = at(0);
        let twice: Vec3 = (0..count).map(|i| (at(i) - origin).cross(at(i + 1) - origin)).sum();
        0.5 * self.normal.dot(twice)
    }
}

impl Relation for Area {
    fn rows(&self) -> &[u32] {
        &self.rows
    }

    fn value(&self, positions: &[Vec3], time: f64) -> Vec3 {
        Vec3::X * (self.enclosed(positions) - self.part.evaluate(&[time]) * self.area)
    }

    // ∂A/∂x_i = ½ (x_{i+1} − x_{i−1}) × n
    fn add_gradients(&self, positions: &[Vec3], _time: f64, gradients: &mut Vec<Mat3>) {
        let count = self.rows.len();
        let at = |index: usize| positions[self.rows[index % count] as usize];
        gradients
            .extend((0..count).map(|i| first_row((at(i + 1) - at(i + count - 1)).cross(self.normal) * 0.5)));
    }

    fn time_rate(&self, _positions: &[Vec3], time: f64) -> Vec3 {
        Vec3::X * (-self.part.differentiate(&[time], 0).derivative * self.area)
    }

    fn magnitude(&self, _positions: &[Vec3], time: f64) -> Vec3 {
        Vec3::X * (self.part.evaluate(&[time]) * self.area).abs()
    }

    fn describe(&self) -> String {
        format!("an area of {} m²", self.area)
    }
}

/// `g = V − s(t) V₀` with `V = Σ x_a·(x_b × x_c)/6` over the triangles of a closed surface. Its multiplier is a pressure [Pa].
#[derive(Clone, Debug)]
pub struct Volume {
    rows: Vec<u32>,
    /// Places among `rows`, counterclockwise seen from outside.
    triangles: Vec<[u32; 3]>,
    /// [m³]
    volume: f64,
    part: Formula,
}

impl Volume {
    /// Of triangles of rows, with the part of the volume that is kept, of the time; the volume is what they enclose at `positions`.
    pub fn new(triangles: &[[u32; 3]], part: Formula, positions: &[Vec3]) -> Self {
        let mut rows: Vec<u32> = triangles.iter().flatten().copied().collect();
        rows.sort_unstable();
        rows.dedup();
        let place = |row: u32| rows.partition_point(|known| *known < row) as u32;
        let triangles = triangles.iter().map(|corners| corners.map(place)).collect();
        let mut volume = Self { rows, triangles, volume: 0.0, part };
        volume.volume = volume.enclosed(positions);
        volume
    }

    /// What is enclosed, negative where triangles are clockwise [m³].
    pub fn enclosed(&self, positions: &[Vec3]) -> f64 {
        let at = self.relative_places(positions);
        self.triangles.iter().map(|[a, b, c]| at(*a).dot(at(*b).cross(at(*c))) / 6.0).sum()
    }

    /// Places from one of its own: far away rounding would eat it.
    fn relative_places<'a>(&'a self, positions: &'a [Vec3]) -> impl Fn(u32) -> Vec3 + 'a {
        let origin = self.rows.first().map_or(Vec3::ZERO, |row| positions[*row as usize]);
        move |place| positions[self.rows[place as usize] as usize] - origin
    }
}

impl Relation for Volume {
    fn rows(&self) -> &[u32] {
        &self.rows
    }

    fn value(&self, positions: &[Vec3], time: f64) -> Vec3 {
        Vec3::X * (self.enclosed(positions) - self.part.evaluate(&[time]) * self.volume)
    }

    fn add_gradients(&self, positions: &[Vec3], _time: f64, gradients: &mut Vec<Mat3>) {
        let at = self.relative_places(positions);
        let first = gradients.len();
        gradients.resize(first + self.rows.len(), Mat3::ZERO);
        for [a, b, c] in &self.triangles {
            for [one, next, last] in [[a, b, c], [b, c, a], [c, a, b]] {
                gradients[first + *one as usize] += first_row(at(*next).cross(at(*last)) / 6.0);
            }
        }
    }

    fn time_rate(&self, _positions: &[Vec3], time: f64) -> Vec3 {
        Vec3::X * (-self.part.differentiate(&[time], 0).derivative * self.volume)
    }

    fn magnitude(&self, _positions: &[Vec3], time: f64) -> Vec3 {
        Vec3::X * (self.part.evaluate(&[time]) * self.volume).abs()
    }

    fn describe(&self) -> String {
        format!("a volume of {} m³", self.volume)
    }
}
