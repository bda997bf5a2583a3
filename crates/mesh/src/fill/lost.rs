//! What a filling has lost of its shape, and what it has joined or torn: parts, sheets and gaps thinner than its cells.
//!
//! A filling knows its shape on the points of a lattice alone, and what lies between these is lost without a trace. Here it is
//! looked at more closely: at every triangle of a surface, and of any other shape at two places for the length of a cell along
//! each axis, with the dips of its value between them. Of so large a lattice that these would be too many, fewer are looked at:
//! what is lost is told as far as they see it, and parts, which they could tear or join themselves, are not counted.

use rayon::prelude::*;
use souple_math::Vec3;
use souple_table::in_number;

use super::{Grading, Reach, Size};
use crate::implicit::{Shape, Sign, SurfaceShape};
use crate::repair::components;
use crate::sets::Sets;
use crate::{BoundingBox, Mesh, TriangleSurface};

/// A loss of less than this part of a surface or of a volume is not told: tips and edges, which every filling bevels.
const BEVELLED: f64 = 1e-3;

/// What a person may do about it.
pub(super) const REMEDY: &str = "what is thinner than a cell is lost; take a smaller size";

/// Cubes as long as the smallest cells, all over the bounds and one beyond: which of them a filling reaches into.
struct Reached<'a> {
    size: &'a Size,
    low: Vec3,
    counts: [usize; 3],
    /// How many are reached below each corner of the cubes in all three coordinates: of any box of them by eight looks.
    sums: Vec<u32>,
}

impl<'a> Reached<'a> {
    /// By boxes around what the filling is made of.
    fn new(bounds: BoundingBox, size: &'a Size, reached: impl Iterator<Item = BoundingBox>) -> Self {
        let bounds = bounds.grown(size.smallest);
        let counts = bounds.size().to_array().map(|length| (length / size.smallest) as usize + 1);
        let mut new = Self { size, low: bounds.low, counts, sums: Vec::new() };
        let [nx, ny, nz] = counts;
        let mut is_reached = vec![false; nx * ny * nz];
        for reached in reached {
            let [x, y, z] = new.range(new.place(reached.low), new.place(reached.high));
            for (k, j) in z.flat_map(|k| y.clone().map(move |j| (k, j))) {
                let row = nx * (j + ny * k);
                is_reached[row + x.start..row + x.end].fill(true);
            }
        }
        new.sums = vec![0; (nx + 1) * (ny + 1) * (nz + 1)];
        for k in 0..nz {
            for j in 0..ny {
                let mut of_row = 0;
                for i in 0..nx {
                    of_row += u32::from(is_reached[i + nx * (j + ny * k)]);
                    let [before, below, both] =
                        [[j, k + 1], [j + 1, k], [j, k]].map(|[j, k]| new.sums[new.corner([i + 1, j, k])]);
                    let corner = new.corner([i + 1, j + 1, k + 1]);
                    new.sums[corner] = of_row + before + below - both;
                }
            }
        }
        new
    }

    /// By the cells of a mesh.
    fn by_cells(mesh: &Mesh, bounds: BoundingBox, size: &'a Size) -> Self {
        let position = |node: &u32| mesh.points[*node as usize];
        Self::new(bounds, size, mesh.cells().map(|cell| BoundingBox::of(cell.nodes.iter().map(position))))
    }

    /// By the faces of a mesh's boundary.
    fn by_boundary(mesh: &Mesh, bounds: BoundingBox, size: &'a Size) -> Self {
        let boundary = mesh.boundary_surface();
        let triangles = 0..boundary.triangles.len() as u32;
        Self::new(bounds, size, triangles.map(|triangle| BoundingBox::of(boundary.corners(triangle))))
    }

    fn corner(&self, [i, j, k]: [usize; 3]) -> usize {
        i + (self.counts[0] + 1) * (j + (self.counts[1] + 1) * k)
    }

    /// Along each axis, cubes from one place to another, both included, as far as there are such.
    fn range(&self, from: [i64; 3], to: [i64; 3]) -> [std::ops::Range<usize>; 3] {
        [0, 1, 2].map(|axis: usize| {
            let within = |index: i64| index.clamp(0, self.counts[axis] as i64) as usize;
            within(from[axis])..within(to[axis].saturating_add(1)).max(within(from[axis]))
        })
    }

    fn place(&self, point: Vec3) -> [i64; 3] {
        ((point - self.low) * (1.0 / self.size.smallest)).to_array().map(|c| c.floor() as i64)
    }

    fn count(&self, [x, y, z]: [std::ops::Range<usize>; 3]) -> i64 {
        let sum = |i: usize, j: usize, k: usize| i64::from(self.sums[self.corner([i, j, k])]);
        let below = |k: usize| {
            sum(x.end, y.end, k) - sum(x.start, y.end, k) - sum(x.end, y.start, k) + sum(x.start, y.start, k)
        };
        below(z.end) - below(z.start)
    }

    /// Whether a point is more than a cell away from all that is reached.
    fn is_far(&self, point: Vec3) -> bool {
        let layers = match &self.size.grading {
            // as large as an integer can be where nothing limits cells: the bounds do
            Grading::Field { size, largest, reach: Reach::Everywhere } => {
                (size(point).min(*largest) / self.size.smallest).max(1.0).ceil() as i64
            }
            _ => 1,
        };
        let at = self.place(point);
        let [from, to] = [at.map(|c| c.saturating_sub(layers)), at.map(|c| c.saturating_add(layers))];
        self.count(self.range(from, to)) == 0
    }
}

/// A part of a surface that shares no point with others.
#[derive(Clone, Default)]
struct Shell {
    /// Enclosed, negative for a hollow [m³].
    volume: f64,
    /// [m²]
    area: f64,
    lost: f64,
    first_lost: Option<Vec3>,
}

impl Shell {
    fn is_lost(&self) -> bool {
        self.lost > (1.0 - BEVELLED) * self.area
    }
}

/// What to say of the filling of a surface.
pub(super) fn of_surface(
    surface: &TriangleSurface,
    shape: &SurfaceShape,
    size: &Size,
    mesh: &Mesh,
) -> Vec<String> {
    let shells = shells(surface, shape, size, mesh);
    let mut notes = Vec::new();
    let is_solid = |shell: &&Shell| shell.volume > 0.0;
    let solids = shells.iter().filter(is_solid).count();
    let lost: Vec<&Shell> = shells.iter().filter(|shell| shell.is_lost()).collect();
    let lost_solids = lost.iter().copied().filter(is_solid).count();
    if let Some(place) = lost.iter().copied().filter(is_solid).find_map(|shell| shell.first_lost) {
        notes.push(format!(
            "{} of the {solids} of the surface {} no cell, the first at {}: {REMEDY}",
            in_number(lost_solids, "part", "parts"),
            if lost_solids == 1 { "has" } else { "have" },
            written(place)
        ));
    }
    let hollows = lost.len() - lost_solids;
    if let Some(place) = lost.iter().find(|shell| !is_solid(shell)).and_then(|shell| shell.first_lost) {
        notes.push(format!(
            "{} filled up, the first at {}: {REMEDY}",
            in_number(hollows, "hollow of the surface is", "hollows of the surface are"),
            written(place)
        ));
    }
    let partly = || shells.iter().filter(|shell| !shell.is_lost());
    let share = partly().map(|shell| shell.lost).sum::<f64>() / surface.area();
    if share > BEVELLED
        && let Some(place) = partly().find_map(|shell| shell.first_lost)
    {
        notes.push(format!(
            "{} of the surface lies more than a cell away from the filling, as at {}: {REMEDY}",
            percent(share),
            written(place)
        ));
    }
    let (wanted, found) = (solids - lost_solids, mesh.components().1);
    // where parts overlap they are one, and not by the size of cells
    if shape.sign() == Sign::Normals {
        notes.extend(parts(wanted, found, "the surface"));
    } else if found > 1 {
        notes.push(format!("the filling has {found} parts that share no point"));
    }
    notes
}

/// What to say of a number of parts.
fn parts(wanted: usize, found: usize, whose: &str) -> Option<String> {
    let has = format!(
        "the filling has {}, where {whose} has {wanted}",
        in_number(found, "part", "parts that share no point")
    );
    match found.cmp(&wanted) {
        std::cmp::Ordering::Greater => {
            Some(format!("{has}: what joins them is thinner than a cell; take a smaller size"))
        }
        std::cmp::Ordering::Less => {
            Some(format!("{has}: gaps thinner than a cell are closed; take a smaller size"))
        }
        std::cmp::Ordering::Equal if found > 1 => {
            Some(format!("the filling has {found} parts that share no point, as has {whose}"))
        }
        std::cmp::Ordering::Equal => None,
    }
}

fn shells(surface: &TriangleSurface, shape: &SurfaceShape, size: &Size, mesh: &Mesh) -> Vec<Shell> {
    let reached = Reached::by_boundary(mesh, shape.bounds(), size);
    let (shell_of, count) = components(surface);
    let mut shells = vec![Shell::default(); count];
    let origin = surface.bounds().centre();
    for (triangle, shell) in shell_of.iter().enumerate() {
        let corners = surface.corners(triangle as u32);
        let area = surface.area_vector(triangle as u32);
        let shell = &mut shells[*shell as usize];
        let [a, b, c] = corners.map(|corner| corner - origin);
        shell.volume += a.dot(b.cross(c)) / 6.0;
        shell.area += area.length();
        let is_lost = |place: &Vec3| reached.is_far(*place) && is_border(shape, *place, area);
        let places = spread(corners, size.smallest);
        let lost: Vec<Vec3> = places.iter().copied().filter(is_lost).collect();
        shell.lost += area.length() * lost.len() as f64 / places.len() as f64;
        shell.first_lost = shell.first_lost.or(lost.first().copied());
    }
    shells
}

/// Beside a triangle, in the size of the whole: above the rounding of coordinates.
const BESIDE: f64 = 1e-9;

/// Whether the inside lies behind a place on a triangle and the outside before it: parts that overlap have triangles of which
/// that is not so.
fn is_border(shape: &SurfaceShape, place: Vec3, area: Vec3) -> bool {
    let Some(normal) = area.try_normalised() else { return false };
    let beside = normal * (BESIDE * shape.bounds().diagonal());
    shape.sign() == Sign::Normals || shape.value(place - beside) < 0.0 && shape.value(place + beside) > 0.0
}

/// Most pieces along a triangle's edge: beyond that its places are farther apart than a cell is long.
const MOST_PIECES: f64 = 64.0;

/// Places all over a triangle, about a cell apart: the middles of the triangles that its edges' pieces span.
fn spread([a, b, c]: [Vec3; 3], size: f64) -> Vec<Vec3> {
    let longest = (b - a).length().max((c - b).length()).max((a - c).length());
    let pieces = (longest / size).ceil().clamp(1.0, MOST_PIECES) as u32;
    let place = |i: u32, j: u32, third: f64| {
        let [u, v] = [i, j].map(|index| (f64::from(index) + third) / f64::from(pieces));
        a + (b - a) * u + (c - a) * v
    };
    let upward = (0..pieces).flat_map(|i| (0..pieces - i).map(move |j| (i, j, 1.0 / 3.0)));
    let downward =
        (0..pieces).flat_map(|i| (0..(pieces - i).saturating_sub(1)).map(move |j| (i, j, 2.0 / 3.0)));
    upward.chain(downward).map(|(i, j, third)| place(i, j, third)).collect()
}

/// Most places at which a shape is looked at again: as many as the lattice of a million cells has.
const MOST_PLACES: f64 = 8e6;

/// Values of a shape on a grid that reaches one place beyond its bounds.
struct Closer<'a> {
    shape: &'a dyn Shape,
    low: Vec3,
    spacing: f64,
    counts: [usize; 3],
    values: Vec<f64>,
}

/// What to say of the filling of a shape.
pub(super) fn of_shape(shape: &dyn Shape, size: &Size, mesh: &Mesh) -> Vec<String> {
    let bounds = shape.bounds();
    let reached = Reached::by_cells(mesh, bounds, size);
    let closer = Closer::new(shape, size.smallest);
    let inside = closer.values.iter().filter(|value| **value < 0.0).count();
    let places = (0..closer.values.len()).into_par_iter();
    let lost: Vec<usize> = places.filter(|place| reached.is_far(closer.position(*place))).collect();
    let lost_inside = lost.iter().filter(|place| closer.values[**place] < 0.0);
    let share = lost_inside.clone().count() as f64 / inside.max(1) as f64;
    let deepest = lost_inside.min_by(|a, b| closer.values[**a].total_cmp(&closer.values[**b]));
    if let Some(deepest) = deepest.filter(|_| share > BEVELLED) {
        return vec![format!(
            "{} of the shape lies more than a cell away from the filling, as at {}: {REMEDY}",
            percent(share),
            written(closer.position(*deepest))
        )];
    }
    let dip = lost.par_iter().find_map_first(|place| closer.dip(*place).filter(|dip| reached.is_far(*dip)));
    if let Some(place) = dip {
        return vec![format!(
            "the shape has a part at {}, and the filling has not: {REMEDY}",
            written(place)
        )];
    }
    // of places that are farther apart, what is as thin as a cell falls apart by itself
    if closer.spacing > 0.5 * size.smallest {
        return Vec::new();
    }
    parts(closer.parts(), mesh.components().1, "the shape").into_iter().collect()
}

impl<'a> Closer<'a> {
    /// Two places for the length of a cell, or as many as are looked at.
    fn new(shape: &'a dyn Shape, cell: f64) -> Self {
        let bounds = shape.bounds();
        let extent = bounds.size();
        let spacing = (0.5 * cell).max((extent.x * extent.y * extent.z / MOST_PLACES).cbrt());
        let counts = extent.to_array().map(|length| (length / spacing).ceil() as usize + 3);
        let whole = Vec3::from_array(counts.map(|count| (count - 1) as f64 * spacing));
        let low = bounds.centre() - whole * 0.5;
        let mut closer = Self { shape, low, spacing, counts, values: Vec::new() };
        closer.values =
            (0..counts.iter().product()).into_par_iter().map(|p| shape.value(closer.position(p))).collect();
        closer
    }

    fn index(&self, place: usize) -> [usize; 3] {
        let [nx, ny, _] = self.counts;
        [place % nx, place / nx % ny, place / (nx * ny)]
    }

    fn position(&self, place: usize) -> Vec3 {
        self.low + Vec3::from_array(self.index(place).map(|i| i as f64 * self.spacing))
    }

    /// The place so many steps away along each axis, where there is one.
    fn beside(&self, place: usize, steps: [isize; 3]) -> Option<usize> {
        let index = self.index(place);
        let mut moved = [0; 3];
        for axis in 0..3 {
            moved[axis] =
                index[axis].checked_add_signed(steps[axis]).filter(|index| *index < self.counts[axis])?;
        }
        let ([i, j, k], [nx, ny, _]) = (moved, self.counts);
        Some(i + nx * (j + ny * k))
    }

    /// A place inside within the spacing of one outside, where the value has a dip that may reach below zero: by the steeper of
    /// its sides.
    fn dip(&self, place: usize) -> Option<Vec3> {
        let value = self.values[place];
        let may_hide = |axis: usize| {
            let mut step = [0; 3];
            step[axis] = 1;
            let after = self.beside(place, step);
            let Some((before, after)) = self.beside(place, step.map(|s: isize| -s)).zip(after) else {
                return false;
            };
            let rises = [before, after].map(|other| self.values[other] - value);
            rises.iter().all(|rise| *rise >= 0.0) && value <= rises[0].max(rises[1])
        };
        if value < 0.0 || !(0..3).any(may_hide) {
            return None;
        }
        let mut lowest = self.position(place);
        for axis in [0, 1, 2, 0, 1, 2] {
            lowest = self.lowest_along(lowest, axis);
            if self.shape.value(lowest) < 0.0 {
                return Some(lowest);
            }
        }
        None
    }

    /// Where the value is least within the spacing of a point along an axis, by thirds.
    fn lowest_along(&self, point: Vec3, axis: usize) -> Vec3 {
        let at = |offset: f64| {
            let mut moved = point;
            moved[axis] += offset;
            moved
        };
        let (mut low, mut high) = (-self.spacing, self.spacing);
        for _ in 0..THIRDS {
            let third = (high - low) / 3.0;
            if self.shape.value(at(low + third)) <= self.shape.value(at(high - third)) {
                high -= third;
            } else {
                low += third;
            }
        }
        at(0.5 * (low + high))
    }

    /// Parts of the inside that are as large as a cube of the lattice: places beside each other are joined, and places across a
    /// square or a cube where the middle between them is inside too.
    fn parts(&self) -> usize {
        let is_inside = |place: &usize| self.values[*place] < 0.0;
        // joined along the axes first: what is left to be looked at between others is little
        let mut part = vec![NO_PART; self.values.len()];
        let mut places: Vec<usize> = Vec::new();
        let mut stack = Vec::new();
        for start in 0..self.values.len() {
            if !is_inside(&start) || part[start] != NO_PART {
                continue;
            }
            let own = places.len() as u32;
            places.push(0);
            part[start] = own;
            stack.push(start);
            while let Some(place) = stack.pop() {
                places[own as usize] += 1;
                for other in BESIDE_ALONG_AXES.iter().filter_map(|steps| self.beside(place, *steps)) {
                    if is_inside(&other) && part[other] == NO_PART {
                        part[other] = own;
                        stack.push(other);
                    }
                }
            }
        }
        let mut joined = Sets::new(places.len());
        for place in (0..self.values.len()).filter(is_inside) {
            for other in ACROSS.iter().filter_map(|steps| self.beside(place, *steps)).filter(is_inside) {
                if part[place] == part[other] {
                    continue;
                }
                let [a, b] = [place, other].map(|place| joined.of(part[place]));
                let middle = (self.position(place) + self.position(other)) * 0.5;
                if a != b && self.shape.value(middle) < 0.0 {
                    joined.join(a, b);
                }
            }
        }
        let mut of_all = vec![0; places.len()];
        for (part, places) in places.iter().enumerate() {
            of_all[joined.of(part as u32) as usize] += places;
        }
        of_all.iter().filter(|places| **places >= PLACES_OF_A_CUBE).count()
    }
}

const NO_PART: u32 = u32::MAX;
const BESIDE_ALONG_AXES: [[isize; 3]; 6] =
    [[-1, 0, 0], [1, 0, 0], [0, -1, 0], [0, 1, 0], [0, 0, -1], [0, 0, 1]];
/// Across squares and cubes, each pair from one of its ends.
const ACROSS: [[isize; 3]; 10] = [
    [1, 1, 0],
    [1, -1, 0],
    [1, 0, 1],
    [1, 0, -1],
    [0, 1, 1],
    [0, 1, -1],
    [1, 1, 1],
    [1, 1, -1],
    [1, -1, 1],
    [1, -1, -1],
];

/// The interval left of the first is then a ten thousandth of it.
const THIRDS: usize = 23;
const PLACES_OF_A_CUBE: usize = 8;

fn written(x: Vec3) -> String {
    format!("({:.4}, {:.4}, {:.4})", x.x, x.y, x.z)
}

fn percent(share: f64) -> String {
    let percent = 100.0 * share;
    if percent < 1.0 { format!("{percent:.1} %") } else { format!("{percent:.0} %") }
}
