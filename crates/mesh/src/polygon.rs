//! Polygons as triangles.

use std::collections::BinaryHeap;

use souple_math::Vec3;

/// Most corners of a polygon that is looked at for ears, whose time goes with the square of them at worst.
pub const MOST_POLYGON_CORNERS: usize = 65_536;

/// Areas below this, relative to the square of a length, are none: rounding of a cross product.
const NO_AREA: f64 = 1e-14;

/// A corner nearer to the side of a triangle is on it, in the same measure: an ear cut there would leave corners on a line.
const ON_SIDE: f64 = 1e-12;

/// A polygon as triangles.
#[derive(Clone, Debug)]
pub struct CutPolygon {
    /// In the direction of the polygon; none that repeats a corner.
    pub triangles: Vec<[u32; 3]>,
    /// Whether some are turned over or have no area, seen along the polygon's normal: it crosses itself, has no area, or is not
    /// convex and has more than [`MOST_POLYGON_CORNERS`].
    pub is_folded: bool,
    /// Whether some are turned over, and so lie over others.
    pub overlaps: bool,
}

/// The triangles of [`cut_polygon`].
pub fn polygon_triangles(corners: &[u32], position: impl Fn(u32) -> Vec3) -> Vec<[u32; 3]> {
    if let [a, b, c] = corners {
        return vec![[*a, *b, *c]];
    }
    cut_polygon(corners, position).triangles
}

/// A polygon, flat or nearly so, convex or not, as triangles whose areas add up to its own: around its corner of lowest number
/// where none of those is turned over, elsewhere by ears cut off one after the other. Of one that is folded some overlap.
pub fn cut_polygon(corners: &[u32], position: impl Fn(u32) -> Vec3) -> CutPolygon {
    let positions: Vec<Vec3> = corners.iter().map(|corner| position(*corner)).collect();
    let around_lowest: Vec<[usize; 3]> = fan(corners).collect();
    let normal = area_vector(&positions);
    // twice the area along the polygon's normal, and what of it is none, both by the length of that
    let shown = |places: &[usize; 3]| {
        let [a, b, c] = places.map(|place| positions[place]);
        let longest_sq = (b - a).length_sq().max((c - b).length_sq()).max((a - c).length_sq());
        ((b - a).cross(c - a).dot(normal), NO_AREA * longest_sq * normal.length())
    };
    let is_over = |places: &[usize; 3]| {
        let (area, none) = shown(places);
        area <= none
    };
    let is_ready = corners.len() > MOST_POLYGON_CORNERS || !around_lowest.iter().any(is_over);
    let places = match normal.try_normalised() {
        Some(normal) if !is_ready => Ears::new(&positions, normal).cut(),
        _ => around_lowest,
    };
    let is_folded = places.iter().any(is_over);
    let overlaps = places.iter().map(shown).any(|(area, none)| area < -none);
    let triangles = places.into_iter().map(|places| places.map(|place| corners[place]));
    CutPolygon {
        triangles: triangles.filter(|[a, b, c]| a != b && b != c && c != a).collect(),
        is_folded,
        overlaps,
    }
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
    /// Corners before and after each one, of those that are left.
    beside: Vec<[usize; 2]>,
    is_left: Vec<bool>,
    grid: Grid,
    /// For each corner how well its ear is shaped; below zero where there is none.
    shape: Vec<f64>,
    /// Corners by the shape that they had when they were last looked at: one that has another by now, or is gone, is passed over.
    best: BinaryHeap<(OrderedShape, usize)>,
}

/// Shapes in the order of numbers; none is not a number.
#[derive(Clone, Copy, PartialEq)]
struct OrderedShape(f64);

impl Eq for OrderedShape {}

impl PartialOrd for OrderedShape {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for OrderedShape {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.0.total_cmp(&other.0)
    }
}

impl Ears {
    fn new(positions: &[Vec3], normal: Vec3) -> Self {
        let across = normal.any_orthogonal();
        let up = normal.cross(across);
        let flat = positions.iter().map(|p| *p - positions[0]).map(|p| [p.dot(across), p.dot(up)]);
        let flat: Vec<[f64; 2]> = flat.collect();
        let count = flat.len();
        let beside = (0..count).map(|at| [(at + count - 1) % count, (at + 1) % count]).collect();
        let grid = Grid::new(&flat);
        let (is_left, shape) = (vec![true; count], vec![0.0; count]);
        let mut ears =
            Self { flat, beside, is_left, grid, shape, best: BinaryHeap::with_capacity(3 * count) };
        (0..count).for_each(|at| ears.look(at));
        ears
    }

    fn cut(mut self) -> Vec<[usize; 3]> {
        let count = self.flat.len();
        let mut triangles = Vec::with_capacity(count);
        while triangles.len() + 2 < count
            && let Some((shape, at)) = self.best.pop()
        {
            if !self.is_left[at] || shape.0 != self.shape[at] {
                continue;
            }
            triangles.push(self.ear(at));
            self.is_left[at] = false;
            let [before, after] = self.beside[at];
            self.beside[before][1] = after;
            self.beside[after][0] = before;
            // all others stay what they are: no corner that stands out was within their ears
            [before, after].into_iter().for_each(|beside| self.look(beside));
        }
        triangles
    }

    /// A corner and those beside it.
    fn ear(&self, at: usize) -> [usize; 3] {
        let [before, after] = self.beside[at];
        [before, at, after]
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
        let is_within = |place: usize| {
            let p = self.flat[place];
            if !self.is_left[place] || ear.contains(&place) {
                return false;
            }
            // at the place of a corner another one is passed, as where a hole is joined to the outline: its sides may run through
            let within = |from: [f64; 2], to: [f64; 2], q: [f64; 2]| area(from, to, q) > -outside;
            let enters = |q: [f64; 2]| match () {
                () if p == a => within(c, a, q) && within(a, b, q),
                () if p == b => within(a, b, q) && within(b, c, q),
                () => within(b, c, q) && within(c, a, q),
            };
            if [a, b, c].contains(&p) {
                return self.beside[place].iter().any(|other| enters(self.flat[*other]));
            }
            [(a, b), (b, c), (c, a)].into_iter().all(|(from, to)| area(from, to, p) >= outside)
        };
        let is_ear = shape > NO_AREA && !self.grid.around([a, b, c]).any(is_within);
        self.shape[at] = match () {
            // there and back again: nothing is lost with it
            () if a == c => 1.0,
            () if is_ear => shape,
            // where a polygon that crosses itself has no ear, the corner that stands out most goes
            () => shape - 1.0,
        };
        self.best.push((OrderedShape(self.shape[at]), at));
    }
}

/// The corners of a polygon by the cell of a grid that they are in, about one in each.
struct Grid {
    low: [f64; 2],
    /// Cells for each metre.
    scale: [f64; 2],
    /// Cells along each side.
    count: usize,
    /// Where the corners of each cell begin, and where those of the last end.
    starts: Vec<usize>,
    corners: Vec<usize>,
}

impl Grid {
    fn new(flat: &[[f64; 2]]) -> Self {
        let count = flat.len().isqrt().max(1);
        let least = |axis: usize| flat.iter().map(|p| p[axis]).fold(f64::INFINITY, f64::min);
        let most = |axis: usize| flat.iter().map(|p| p[axis]).fold(f64::NEG_INFINITY, f64::max);
        let low = [least(0), least(1)];
        let scale = [0, 1].map(|axis| {
            let extent = most(axis) - low[axis];
            if extent > 0.0 { count as f64 / extent } else { 0.0 }
        });
        let mut grid =
            Self { low, scale, count, starts: vec![0; count * count + 1], corners: vec![0; flat.len()] };
        let cells: Vec<usize> =
            flat.iter().map(|p| grid.cell(0, p[0]) + count * grid.cell(1, p[1])).collect();
        cells.iter().for_each(|cell| grid.starts[*cell + 1] += 1);
        (0..count * count).for_each(|cell| grid.starts[cell + 1] += grid.starts[cell]);
        let mut next = grid.starts.clone();
        for (corner, cell) in cells.into_iter().enumerate() {
            grid.corners[next[cell]] = corner;
            next[cell] += 1;
        }
        grid
    }

    /// Along an axis the cell that a place is in: rounded alike for corners and for boxes that have them within.
    fn cell(&self, axis: usize, place: f64) -> usize {
        (((place - self.low[axis]) * self.scale[axis]) as usize).min(self.count - 1)
    }

    /// The corners in all cells that the box of a triangle meets.
    fn around(&self, triangle: [[f64; 2]; 3]) -> impl Iterator<Item = usize> + '_ {
        let along = |axis: usize| triangle.map(|p| self.cell(axis, p[axis]));
        let range = |[a, b, c]: [usize; 3]| a.min(b).min(c)..=a.max(b).max(c);
        let (columns, rows) = (range(along(0)), range(along(1)));
        let in_row = move |row: usize| {
            let first = self.count * row;
            &self.corners[self.starts[first + columns.start()]..self.starts[first + columns.end() + 1]]
        };
        rows.flat_map(in_row).copied()
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
        let found = cut_polygon(corners, position);
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
        outlines.push(around(10_000, &mut |_, noise| 0.05 + noise));
        for outline in outlines {
            let count = outline.len() as u32;
            for first in 0..count.min(12).min(100_000 / count) {
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

    /// A hole that touches the outline where that has a corner is left out: what is there and back again has no triangle.
    #[test]
    fn holes_may_touch_the_outline() {
        let points = turned([[0.0, 0.0], [3.0, 0.0], [3.0, 3.0], [0.0, 3.0], [2.0, 1.0], [1.0, 2.0]]);
        let corners = [0, 1, 2, 4, 0, 5, 4, 2, 3];
        let whole = area_vector(&corners.map(|corner| points[corner as usize])).length();
        assert!((whole - 7.5).abs() < 1e-12);
        for first in 0..corners.len() {
            let mut corners = corners;
            corners.rotate_left(first);
            let found = cut_polygon(&corners, |corner| points[corner as usize]);
            let surface = crate::TriangleSurface::new(points.clone(), found.triangles).unwrap();
            assert!(!found.overlaps && surface.triangles.len() == 5, "{:?}", surface.triangles);
            assert!((surface.area() - whole).abs() < 1e-12, "{:?}", surface.triangles);
        }
    }

    /// What crosses itself, is a line or a point, or has too many corners, becomes triangles of its corners all the same.
    #[test]
    fn what_has_no_inside_ends() {
        let star =
            turned((0..5).map(|k| [(0.4 * TAU * f64::from(k)).cos(), (0.4 * TAU * f64::from(k)).sin()]));
        let line: Vec<Vec3> = (0..5).map(|k| Vec3::X * f64::from(k)).collect();
        let many =
            turned((0..MOST_POLYGON_CORNERS as u32 + 1).map(|k| [f64::from(k).cos(), f64::from(k).sin()]));
        for (points, overlaps) in [(star, true), (line, false), (vec![Vec3::ZERO; 6], false), (many, true)] {
            let corners: Vec<u32> = (0..points.len() as u32).collect();
            let found = cut_polygon(&corners, |corner| points[corner as usize]);
            assert_eq!(found.triangles.len(), corners.len() - 2);
            assert!(found.is_folded && found.overlaps == overlaps);
        }
        let found = cut_polygon(&[0, 1, 0, 1, 2], |corner| Vec3::X * f64::from(corner));
        assert!(found.is_folded && found.triangles.iter().all(|[a, b, c]| a != b && b != c && c != a));
    }
}
