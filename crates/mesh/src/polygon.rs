//! Polygons as triangles.

use souple_math::Vec3;

/// Most corners of a polygon that is looked at for ears, whose time goes with the square of them.
const MOST_CORNERS: usize = 4096;

/// Areas below this, relative to the square of a length, are none: rounding of a cross product.
const NO_AREA: f64 = 1e-14;

/// A corner nearer to the side of a triangle is on it, in the same measure: an ear cut there would leave corners on a line.
const ON_SIDE: f64 = 1e-12;

/// A polygon as triangles.
pub(crate) struct CutPolygon {
    /// In the direction of the polygon; none that repeats a corner.
    pub triangles: Vec<[u32; 3]>,
    /// Whether some are turned over or have no area, seen along the polygon's normal: it crosses itself, or has none.
    pub is_folded: bool,
}

/// A polygon, flat or nearly so, convex or not, as triangles whose areas add up to its own: around its corner of lowest number
/// where none of those is turned over, elsewhere by ears cut off one after the other. Of one that crosses itself some overlap.
pub fn polygon_triangles(corners: &[u32], position: impl Fn(u32) -> Vec3) -> Vec<[u32; 3]> {
    if let [a, b, c] = corners {
        return vec![[*a, *b, *c]];
    }
    cut(corners, position).triangles
}

pub(crate) fn cut(corners: &[u32], position: impl Fn(u32) -> Vec3) -> CutPolygon {
    let positions: Vec<Vec3> = corners.iter().map(|corner| position(*corner)).collect();
    let around_lowest: Vec<[usize; 3]> = fan(corners).collect();
    let normal = area_vector(&positions);
    let is_over = |places: &[usize; 3]| {
        let [a, b, c] = places.map(|place| positions[place]);
        let longest_sq = (b - a).length_sq().max((c - b).length_sq()).max((a - c).length_sq());
        (b - a).cross(c - a).dot(normal) <= NO_AREA * longest_sq * normal.length()
    };
    let is_ready = corners.len() > MOST_CORNERS || !around_lowest.iter().any(is_over);
    let places = match normal.try_normalised() {
        Some(normal) if !is_ready => Ears::new(&positions, normal).cut(),
        _ => around_lowest,
    };
    let is_folded = places.iter().any(is_over);
    let triangles = places.into_iter().map(|places| places.map(|place| corners[place]));
    CutPolygon { triangles: triangles.filter(|[a, b, c]| a != b && b != c && c != a).collect(), is_folded }
}

/// Places of the corners of a polygon by triangles around its corner of lowest number.
pub(crate) fn fan(corners: &[u32]) -> impl Iterator<Item = [usize; 3]> + use<> {
    let n = corners.len();
    let first = (0..n).min_by_key(|corner| corners[*corner]).unwrap_or(0);
    (1..n.saturating_sub(1)).map(move |k| [first, (first + k) % n, (first + k + 1) % n])
}

/// Area times normal of a closed polygon, whatever surface it bounds [m²].
pub(crate) fn area_vector(corners: &[Vec3]) -> Vec3 {
    // ½ Σ (p - o) × (q - o), o a corner so that nothing large cancels
    let Some(origin) = corners.first() else { return Vec3::ZERO };
    corners.windows(2).map(|side| (side[0] - *origin).cross(side[1] - *origin) * 0.5).sum()
}

/// A polygon from which ears are cut: triangles of three corners in a row with no other corner within.
struct Ears {
    /// Seen along the normal, counterclockwise.
    flat: Vec<[f64; 2]>,
    /// Places of the corners that are left.
    left: Vec<usize>,
    /// For each corner how well shaped its ear is; `None` where there is none.
    shape: Vec<Option<f64>>,
}

impl Ears {
    fn new(positions: &[Vec3], normal: Vec3) -> Self {
        let across = normal.any_orthogonal();
        let up = normal.cross(across);
        let flat = positions.iter().map(|p| *p - positions[0]).map(|p| [p.dot(across), p.dot(up)]).collect();
        let mut ears =
            Self { flat, left: (0..positions.len()).collect(), shape: vec![None; positions.len()] };
        (0..positions.len()).for_each(|at| ears.look(at));
        ears
    }

    fn cut(mut self) -> Vec<[usize; 3]> {
        let mut triangles = Vec::with_capacity(self.left.len());
        while self.left.len() > 3 {
            // where a polygon that crosses itself has no ear, the corner that stands out most goes
            let best = |at: &usize| self.shape[self.left[*at]].unwrap_or_else(|| self.stands_out(*at) - 1.0);
            let at = (0..self.left.len()).max_by(|a, b| best(a).total_cmp(&best(b))).unwrap_or(0);
            triangles.push(self.ear(at));
            self.left.remove(at);
            let count = self.left.len();
            // of all others stays what they are: no corner that stands out was within their ears
            [(at + count - 1) % count, at % count].into_iter().for_each(|beside| self.look(beside));
        }
        triangles.push([self.left[0], self.left[1], self.left[2]]);
        triangles
    }

    /// Places of a corner and those beside it, by its number among those left.
    fn ear(&self, at: usize) -> [usize; 3] {
        let count = self.left.len();
        [(at + count - 1) % count, at, (at + 1) % count].map(|at| self.left[at])
    }

    /// Twice the area of a corner's triangle over the square of its longest side, negative where the polygon turns the other way.
    fn stands_out(&self, at: usize) -> f64 {
        let [a, b, c] = self.ear(at).map(|place| self.flat[place]);
        let longest_sq = longest_sq([a, b, c]);
        if longest_sq > 0.0 { area(a, b, c) / longest_sq } else { 0.0 }
    }

    fn look(&mut self, at: usize) {
        let ear = self.ear(at);
        let [a, b, c] = ear.map(|place| self.flat[place]);
        let shape = self.stands_out(at);
        let outside = -ON_SIDE * longest_sq([a, b, c]);
        let is_within = |place: &usize| {
            let p = self.flat[*place];
            // a corner at the place of another is passed twice, as where a hole is joined to the outline
            !ear.contains(place)
                && ![a, b, c].contains(&p)
                && [(a, b), (b, c), (c, a)].into_iter().all(|(from, to)| area(from, to, p) >= outside)
        };
        let is_ear = shape > NO_AREA && !self.left.iter().any(is_within);
        self.shape[ear[1]] = is_ear.then_some(shape);
    }
}

fn longest_sq([a, b, c]: [[f64; 2]; 3]) -> f64 {
    let length_sq = |[x, y]: [f64; 2], [u, v]: [f64; 2]| (u - x).powi(2) + (v - y).powi(2);
    length_sq(a, b).max(length_sq(b, c)).max(length_sq(c, a))
}

/// Twice the area of a triangle, positive counterclockwise.
fn area([ax, ay]: [f64; 2], [bx, by]: [f64; 2], [cx, cy]: [f64; 2]) -> f64 {
    (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    /// Triangles face as the polygon does, and their areas add up to its own.
    fn assert_cut(points: &[Vec3], corners: &[u32]) {
        let position = |corner: u32| points[corner as usize];
        let found = cut(corners, position);
        assert!(!found.is_folded && found.triangles.len() == corners.len() - 2, "{:?}", found.triangles);
        let surface = crate::TriangleSurface::new(points.to_vec(), found.triangles).unwrap();
        let whole = area_vector(&corners.iter().map(|corner| position(*corner)).collect::<Vec<_>>()).length();
        let bound = f64::EPSILON * 8.0 * corners.len() as f64 * whole;
        assert!((surface.area() - whole).abs() < bound, "{} {whole}", surface.area());
    }

    /// A flat outline, turned in space.
    fn turned(outline: impl IntoIterator<Item = [f64; 2]>) -> Vec<Vec3> {
        let (across, up) = (Vec3::new(0.6, 0.0, 0.8), Vec3::new(0.0, 1.0, 0.0));
        outline.into_iter().map(|[x, y]| Vec3::new(3.0, 2.0, 1.0) + across * x + up * y).collect()
    }

    /// Stars, darts, combs and outlines of any radius, from any first corner and in both directions.
    #[test]
    fn areas_add_up() {
        let mut noise = 1_u64;
        let mut noise = || {
            noise = noise.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (noise >> 11) as f64 / (1_u64 << 53) as f64
        };
        let mut around = |count: usize, radius: &mut dyn FnMut(usize, f64) -> f64| -> Vec<Vec3> {
            turned((0..count).map(|k| {
                let angle = TAU * k as f64 / count as f64;
                let radius = radius(k, noise());
                [radius * angle.cos(), radius * angle.sin()]
            }))
        };
        let mut outlines = vec![
            turned([[0.0, 0.0], [1.0, 1.0], [0.0, 3.0], [-1.0, 1.0]]),
            turned([[0.0, 0.0], [2.0, -1.0], [0.0, 3.0], [-2.0, -1.0]]),
            // a corner on a straight side
            turned([[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [0.0, 2.0]]),
            turned([[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]]),
            around(10, &mut |k, _| if k % 2 == 0 { 1.0 } else { 0.4 }),
            turned(
                (0..21)
                    .map(|k| [f64::from(k), if k % 2 == 0 { 9.0 } else { 1.0 }])
                    .chain([[20.0, 0.0], [0.0, 0.0]]),
            ),
        ];
        outlines.extend((4..60).map(|count| around(count, &mut |_, noise| 0.05 + noise)));
        for outline in outlines {
            let count = outline.len() as u32;
            for first in 0..count.min(12) {
                let corners: Vec<u32> = (0..count).map(|k| (first + k) % count).collect();
                let points: Vec<Vec3> =
                    (0..count).map(|k| outline[((k + count - first) % count) as usize]).collect();
                assert_cut(&points, &corners);
                assert_cut(&points, &corners.iter().rev().copied().collect::<Vec<_>>());
            }
        }
    }

    /// A hole that is joined to the outline by a side passed twice is left out.
    #[test]
    fn holes_are_joined_to_the_outline() {
        let points = turned([
            [0.0, 0.0],
            [3.0, 0.0],
            [3.0, 3.0],
            [0.0, 3.0],
            [1.0, 1.0],
            [1.0, 2.0],
            [2.0, 2.0],
            [2.0, 1.0],
        ]);
        assert_cut(&points, &[0, 1, 2, 3, 0, 4, 5, 6, 7, 4]);
    }

    /// What crosses itself, is a line or a point, or has too many corners, becomes triangles of its corners all the same.
    #[test]
    fn what_has_no_inside_ends() {
        let star =
            turned((0..5).map(|k| [(0.4 * TAU * f64::from(k)).cos(), (0.4 * TAU * f64::from(k)).sin()]));
        let line: Vec<Vec3> = (0..5).map(|k| Vec3::X * f64::from(k)).collect();
        let many = turned((0..9000).map(|k| [f64::from(k).cos(), f64::from(k).sin()]));
        for points in [star, line, vec![Vec3::ZERO; 6], many] {
            let corners: Vec<u32> = (0..points.len() as u32).collect();
            let found = cut(&corners, |corner| points[corner as usize]);
            assert_eq!(found.triangles.len(), corners.len() - 2);
        }
        let found = cut(&[0, 1, 0, 1, 2], |corner| Vec3::X * f64::from(corner));
        assert!(found.is_folded && found.triangles.iter().all(|[a, b, c]| a != b && b != c && c != a));
    }
}
