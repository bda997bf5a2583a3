//! The contour of an object that is made of points: what others see, touch and meet (Jimenez 1993, P2-III.2.3; specification
//! §2.13).
//!
//! Contours lie in a plane. Three ways lead to one: the closed line through the masses of a skin; the frontier where the
//! sum of what all balls do to a small one that comes from outside reaches the push of a single touch; the trace of a light
//! probe that runs along the balls, held to them by a band of attraction.

use std::collections::HashMap;

use souple_math::Vec3;

/// A place in the plane of a contour.
pub type Place = [f64; 2];

/// Closed lines; the last place goes on to the first.
pub type Lines = Vec<Vec<Place>>;

/// Two axes that span a plane, of which contours are counted around the third.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Plane {
    pub axes: [usize; 2],
}

impl Plane {
    /// Across an axis of space.
    pub fn across(normal: usize) -> Self {
        Self { axes: [[1, 2], [0, 2], [0, 1]][normal] }
    }

    pub fn place(self, point: Vec3) -> Place {
        self.axes.map(|axis| point[axis])
    }

    /// Over the plane [m].
    pub fn height(self, point: Vec3) -> f64 {
        point[3 - self.axes[0] - self.axes[1]]
    }

    /// Back into space, at a height over the plane.
    pub fn point(self, place: Place, height: f64) -> Vec3 {
        let mut point = [height; 3];
        for (axis, x) in self.axes.into_iter().zip(place) {
            point[axis] = x;
        }
        Vec3::from_array(point)
    }
}

fn minus(a: Place, b: Place) -> Place {
    [a[0] - b[0], a[1] - b[1]]
}

fn length(a: Place) -> f64 {
    a[0].hypot(a[1])
}

fn segments(line: &[Place]) -> impl Iterator<Item = [Place; 2]> + '_ {
    (0..line.len()).map(|i| [line[i], line[(i + 1) % line.len()]])
}

/// Of all lines together [m].
pub fn total_length(lines: &[Vec<Place>]) -> f64 {
    lines.iter().flat_map(|line| segments(line)).map(|[a, b]| length(minus(b, a))).sum()
}

/// What one line encloses, positive where it runs counterclockwise [m²].
fn signed_area(line: &[Place]) -> f64 {
    segments(line).map(|[a, b]| 0.5 * (a[0] * b[1] - a[1] * b[0])).sum()
}

/// What is enclosed: holes, whose lines run the other way, count off [m²].
pub fn enclosed_area(lines: &[Vec<Place>]) -> f64 {
    lines.iter().map(|line| signed_area(line)).sum::<f64>().abs()
}

/// How far the places of one contour are from the lines of another, at most [m]; no number where either has none.
pub fn farthest(lines: &[Vec<Place>], other: &[Vec<Place>]) -> f64 {
    let to_segment = |p: Place, [a, b]: [Place; 2]| {
        let (along, from) = (minus(b, a), minus(p, a));
        let square = along[0] * along[0] + along[1] * along[1];
        let t = if square > 0.0 { (along[0] * from[0] + along[1] * from[1]) / square } else { 0.0 };
        let t = t.clamp(0.0, 1.0);
        length(minus(from, [along[0] * t, along[1] * t]))
    };
    let segments: Vec<[Place; 2]> = other.iter().flat_map(|line| segments(line)).collect();
    if lines.iter().all(Vec::is_empty) || segments.is_empty() {
        return f64::NAN;
    }
    let (mut most, mut last) = (0.0_f64, 0);
    for place in lines.iter().flatten() {
        // from the segment that was near the place before: one no farther than the farthest known is enough
        let mut nearest = f64::INFINITY;
        for number in (last..segments.len()).chain(0..last) {
            let distance = to_segment(*place, segments[number]);
            if distance < nearest {
                (nearest, last) = (distance, number);
            }
            if nearest <= most {
                break;
            }
        }
        most = most.max(nearest);
    }
    most
}

/// Balls by the cells of a grid.
struct Balls<'a> {
    places: &'a [Place],
    size: f64,
    cells: HashMap<[i64; 2], Vec<u32>>,
}

impl<'a> Balls<'a> {
    fn new(places: &'a [Place], size: f64) -> Self {
        let mut cells: HashMap<[i64; 2], Vec<u32>> = HashMap::new();
        for (number, place) in places.iter().enumerate() {
            cells.entry(place.map(|x| (x / size).floor() as i64)).or_default().push(number as u32);
        }
        Self { places, size, cells }
    }

    /// Those nearer than a cell.
    fn near(&self, place: Place) -> impl Iterator<Item = Place> + '_ {
        let [x, y] = place.map(|x| (x / self.size).floor() as i64);
        let cells = (0..9)
            .filter_map(move |n| self.cells.get(&[x.saturating_add(n % 3 - 1), y.saturating_add(n / 3 - 1)]));
        let is_near = move |ball: &Place| length(minus(place, *ball)) < self.size;
        cells.flatten().map(|number| self.places[*number as usize]).filter(is_near)
    }
}

/// Balls of one radius, and what comes to them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frontier {
    /// Of the balls [m].
    pub radius: f64,
    /// Of what comes from outside [m].
    pub probe: f64,
    /// Of the grid [m].
    pub cell: f64,
}

impl Frontier {
    /// `Σ max(0, S - |x - P_i|)`, `S = R + R_probe`, less the `R_probe` of a single touch.
    fn excess(&self, near: &[Place], place: Place) -> f64 {
        let reach = self.radius + self.probe;
        near.iter().map(|ball| (reach - length(minus(place, *ball))).max(0.0)).sum::<f64>() - self.probe
    }

    /// The lines where the sum is that of a single touch, by marching squares over cells near the balls.
    pub fn lines(&self, places: &[Place]) -> Lines {
        let values = Values::of(self, places);
        // those that reach any place of an edge from either end
        let balls = Balls::new(places, self.radius + self.probe + 2.0 * self.cell);
        let squares = values.squares_on_the_way();
        // from the edge where a line enters a square to that where it leaves, inside on its left
        let mut next: HashMap<Edge, Edge> = HashMap::new();
        let mut starts = Vec::new();
        for [x, y] in squares {
            let (right, up) = (x.saturating_add(1), y.saturating_add(1));
            let ring = [[x, y], [right, y], [right, up], [x, up]];
            let values = ring.map(|corner| values.at(corner));
            let is_in = values.map(|value| value > 0.0);
            let edges: [Edge; 4] =
                std::array::from_fn(|side| Edge::between(ring[side], ring[(side + 1) % 4]));
            let leaves: Vec<usize> = (0..4).filter(|side| !is_in[*side] && is_in[(side + 1) % 4]).collect();
            for leaving in leaves {
                // two opposite corners are one or two by the middle
                let middle = values.iter().sum::<f64>() > 0.0;
                let turns = if middle { [3, 1, 2] } else { [1, 3, 2] };
                let enters = turns
                    .into_iter()
                    .map(|turn| (leaving + turn) % 4)
                    .find(|side| is_in[*side] && !is_in[(side + 1) % 4]);
                if let Some(entering) = enters {
                    next.insert(edges[entering], edges[leaving]);
                    starts.push(edges[entering]);
                }
            }
        }
        // by halves: out of reach the sum is constant, and no straight line leads to where it is zero
        let cross = |edge: Edge| {
            let [a, b] = edge.ends();
            let near: Vec<Place> = balls.near(a.map(|x| x as f64 * self.cell)).collect();
            let at = |share: f64| {
                [0, 1].map(|axis: usize| (a[axis] as f64 + share * (b[axis] - a[axis]) as f64) * self.cell)
            };
            let is_in = |share| self.excess(&near, at(share)) > 0.0;
            // as the squares have it: a corner on the line is in or out by its last bit, and both must say the same
            let first = values.at(a) > 0.0;
            let (mut low, mut high) = (0.0, 1.0);
            for _ in 0..HALVES {
                let middle = 0.5 * (low + high);
                if is_in(middle) == first { low = middle } else { high = middle }
            }
            at(0.5 * (low + high))
        };
        let mut lines = Lines::new();
        for start in starts {
            let mut line = Vec::new();
            let mut at = start;
            while let Some(to) = next.remove(&at) {
                line.push(cross(at));
                at = to;
            }
            if line.len() > 2 {
                lines.push(line);
            }
        }
        lines
    }
}

/// Corners of the grid along each edge of a tile.
const TILE: usize = 32;

/// What [`Frontier::excess`] is at the corners of a grid, tile by tile where there are balls; elsewhere none reaches.
struct Values {
    tiles: HashMap<[i64; 2], Box<[f64]>>,
    nothing: f64,
}

impl Values {
    /// Ball by ball, each at the corners that it reaches.
    fn of(frontier: &Frontier, places: &[Place]) -> Self {
        let (reach, cell) = (frontier.radius + frontier.probe, frontier.cell);
        let mut tiles: HashMap<[i64; 2], Box<[f64]>> = HashMap::new();
        let tile = TILE as i64;
        for place in places {
            let low = place.map(|x| ((x - reach) / cell).floor() as i64);
            let high = place.map(|x| ((x + reach) / cell).ceil() as i64);
            let [columns, rows] = [0, 1].map(|i: usize| low[i].div_euclid(tile)..=high[i].div_euclid(tile));
            for [i, j] in rows.flat_map(|j| columns.clone().map(move |i| [i, j])) {
                let values = tiles
                    .entry([i, j])
                    .or_insert_with(|| vec![-frontier.probe; TILE * TILE].into_boxed_slice());
                let within = |axis: usize, number: i64| {
                    let first = number * tile;
                    low[axis].max(first)..=high[axis].min(first + (tile - 1))
                };
                for y in within(1, j) {
                    let up = y as f64 * cell - place[1];
                    for x in within(0, i) {
                        let along = x as f64 * cell - place[0];
                        let index = (y - j * tile) as usize * TILE + (x - i * tile) as usize;
                        values[index] += (reach - (along * along + up * up).sqrt()).max(0.0);
                    }
                }
            }
        }
        Self { tiles, nothing: -frontier.probe }
    }

    fn at(&self, [x, y]: [i64; 2]) -> f64 {
        let tile = TILE as i64;
        let values = self.tiles.get(&[x.div_euclid(tile), y.div_euclid(tile)]);
        let index = y.rem_euclid(tile) as usize * TILE + x.rem_euclid(tile) as usize;
        values.map_or(self.nothing, |values| values[index])
    }

    /// Squares with corners on both sides, by their lower corners, in order.
    fn squares_on_the_way(&self) -> Vec<[i64; 2]> {
        let tile = TILE as i64;
        let mut squares = Vec::new();
        for ([i, j], values) in &self.tiles {
            let is_in = |x: usize, y: usize| {
                if x < TILE && y < TILE {
                    values[y * TILE + x] > 0.0
                } else {
                    // grids end with the whole numbers
                    self.at([(i * tile).saturating_add(x as i64), (j * tile).saturating_add(y as i64)]) > 0.0
                }
            };
            for (y, x) in (0..TILE).flat_map(|y| (0..TILE).map(move |x| (y, x))) {
                let first = is_in(x, y);
                if is_in(x + 1, y) != first || is_in(x, y + 1) != first || is_in(x + 1, y + 1) != first {
                    squares.push([i * tile + x as i64, j * tile + y as i64]);
                }
            }
            // squares of tiles without balls to the left and below, whose upper corners are in this one
            for (di, dj) in [(-1, 0), (0, -1), (-1, -1)] {
                if self.tiles.contains_key(&[i + di, j + dj]) {
                    continue;
                }
                let columns = if di == 0 { 0..tile } else { -1..0 };
                let rows = if dj == 0 { 0..tile } else { -1..0 };
                for [x, y] in rows.flat_map(|y| {
                    columns.clone().map(move |x| [(i * tile).saturating_add(x), (j * tile).saturating_add(y)])
                }) {
                    let (right, up) = (x.saturating_add(1), y.saturating_add(1));
                    let corners = [[x, y], [right, y], [x, up], [right, up]];
                    if corners.into_iter().any(|corner| self.at(corner) > 0.0) {
                        squares.push([x, y]);
                    }
                }
            }
        }
        squares.sort_unstable();
        squares.dedup();
        squares
    }
}

/// Of an edge of the grid, until a crossing is found.
const HALVES: usize = 24;

/// An edge of the grid: its lower corner, and whether it goes along the second axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
struct Edge([i64; 2], bool);

impl Edge {
    fn between(a: [i64; 2], b: [i64; 2]) -> Self {
        Self(a.min(b), a[0] == b[0])
    }

    fn ends(self) -> [[i64; 2]; 2] {
        let Self([x, y], is_second) = self;
        [[x, y], if is_second { [x, y.saturating_add(1)] } else { [x.saturating_add(1), y] }]
    }
}

/// A light mass that runs along balls: a wall at their radius, a band of attraction beyond, a speed that is kept.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scan {
    /// Of the balls [m].
    pub radius: f64,
    /// Of the band [m].
    pub band: f64,
    /// Way in a step [m].
    pub step: f64,
}

/// Ways that a probe may run, in lengths around all balls one by one.
const ROUNDS: f64 = 2.0;
/// Of the wall and the band: `k Te²/m`, and as much of the speed towards the balls that a step takes.
const STIFFNESS: f64 = 0.25;
const DAMPING: f64 = 0.9;

impl Scan {
    /// One closed trace around each part of the balls; a part whose trace does not close has none.
    pub fn lines(&self, places: &[Place]) -> Lines {
        let mut left: Vec<Place> = places.to_vec();
        let mut lines = Lines::new();
        while let Some(first) =
            left.iter().copied().min_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])))
        {
            if let Some(line) = self.trace(places, [first[0] - self.radius, first[1]]) {
                lines.push(line);
            }
            // those that hang together with it have been run around
            let balls = Balls::new(&left, 2.0 * (self.radius + self.band));
            let (mut part, mut front) = (vec![first], vec![first]);
            while let Some(ball) = front.pop() {
                let new: Vec<Place> = balls.near(ball).filter(|other| !part.contains(other)).collect();
                part.extend(&new);
                front.extend(new);
            }
            left.retain(|ball| !part.contains(ball));
        }
        lines
    }

    /// From a place left of all balls of a part, with them on its left.
    fn trace(&self, places: &[Place], start: Place) -> Option<Vec<Place>> {
        let balls = Balls::new(places, self.radius + self.band);
        let most = ROUNDS * std::f64::consts::TAU * self.radius * places.len() as f64 / self.step;
        let (mut at, mut speed) = (start, [0.0, -self.step]);
        let mut line = vec![at];
        while (line.len() as f64) < most + 100.0 {
            // all walls push, the nearest ball alone attracts
            let mut push = [0.0, 0.0];
            let mut nearest: Option<(f64, Place)> = None;
            for ball in balls.near(at) {
                let away = minus(at, ball);
                let distance = length(away);
                let along = away.map(|x| x / distance.max(f64::MIN_POSITIVE));
                let gap = distance - self.radius;
                if gap < 0.0 {
                    push = [push[0] - along[0] * gap * STIFFNESS, push[1] - along[1] * gap * STIFFNESS];
                }
                if nearest.is_none_or(|(known, _)| gap < known) {
                    nearest = Some((gap, along));
                }
            }
            // lost
            let (gap, along) = nearest?;
            if gap > 0.0 {
                push = [push[0] - along[0] * gap * STIFFNESS, push[1] - along[1] * gap * STIFFNESS];
            }
            let towards = speed[0] * along[0] + speed[1] * along[1];
            speed = [0, 1].map(|axis: usize| speed[axis] + push[axis] - DAMPING * towards * along[axis]);
            // the speed along the balls is kept, with them on the left
            let tangent = [-along[1], along[0]];
            let (out, on) = (speed[0] * along[0] + speed[1] * along[1], self.step);
            speed = [0, 1].map(|axis: usize| along[axis] * out + tangent[axis] * on);
            at = [at[0] + speed[0], at[1] + speed[1]];
            line.push(at);
            let home = length(minus(at, start));
            if line.len() > 8 && home < self.step && speed[1] < 0.0 {
                return Some(line);
            }
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    /// Around one ball, two that overlap and a ring: lengths, areas, holes and parts as geometry has them; the probe agrees.
    #[test]
    fn contours_of_known_figures() {
        let frontier = Frontier { radius: 1.0, probe: 1e-3, cell: 0.05 };
        let scan = Scan { radius: 1.0, band: 0.3, step: 0.02 };
        let one = [[0.3, -0.2]];
        for lines in [frontier.lines(&one), scan.lines(&one)] {
            assert_eq!(lines.len(), 1);
            // chords and crossings on straight lines between corners
            assert!((total_length(&lines) / (2.0 * PI) - 1.0).abs() < 5e-3, "{}", total_length(&lines));
            assert!((enclosed_area(&lines) / PI - 1.0).abs() < 5e-3, "{}", enclosed_area(&lines));
        }
        // two circles with centres one radius apart: 2 r² (π - acos ½ + ½ √¾)
        let two = [[0.0, 0.0], [1.0, 0.0]];
        let area = 2.0 * (PI - PI / 3.0 + 0.5 * 0.75_f64.sqrt());
        let (lines, trace) = (frontier.lines(&two), scan.lines(&two));
        assert!((enclosed_area(&lines) / area - 1.0).abs() < 1e-2, "{}", enclosed_area(&lines));
        assert!((enclosed_area(&trace) / area - 1.0).abs() < 2e-2, "{}", enclosed_area(&trace));
        assert!(farthest(&trace, &[]).is_nan() && farthest(&[], &lines).is_nan());
        assert!(farthest(&trace, &lines) < 0.1, "{}", farthest(&trace, &lines));
        let apart = [[0.0, 0.0], [5.0, 0.0]];
        assert_eq!([frontier.lines(&apart).len(), scan.lines(&apart).len()], [2, 2]);
        let ring: Vec<Place> =
            (0..12).map(|i| (f64::from(i) * PI / 6.0).sin_cos()).map(|(s, c)| [3.0 * c, 3.0 * s]).collect();
        let lines = frontier.lines(&ring);
        assert_eq!(lines.len(), 2);
        // at the ends of the grid, which are those of whole numbers
        for far in [1e300, -1e300] {
            assert!(frontier.lines(&[[far, 0.0], [0.0, far]]).len() <= 2);
        }
        // the hole counts off: less than the outer disc, more than the chain of discs
        assert!(enclosed_area(&lines) < PI * 16.0 - PI * 3.0, "{}", enclosed_area(&lines));
    }
}
