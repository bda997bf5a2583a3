//! What a filling has lost of its shape, and what it has joined or torn: parts, sheets and gaps thinner than its cells.
//!
//! A filling knows its shape on the points of a lattice alone, and what lies between these is lost without a trace. Here it is
//! looked at more closely: at every triangle of a surface, and at twice as many places along each axis of any other shape, with
//! the dips of its value between them.

use rayon::prelude::*;
use souple_math::Vec3;
use souple_table::in_number;

use super::{Grading, Reach, Size};
use crate::implicit::{Shape, Sign, SurfaceShape};
use crate::repair::components;
use crate::{BoundingBox, Mesh, TriangleSurface};

/// A loss of less than this part of a surface or of a volume is not told: tips and edges, which every filling bevels.
const BEVELLED: f64 = 1e-3;

const REMEDY: &str = "what is thinner than a cell is lost; take a smaller size";

/// Cubes as long as the smallest cells: which of them a filling reaches into.
struct Reached<'a> {
    size: &'a Size,
    low: Vec3,
    counts: [usize; 3],
    is_reached: Vec<bool>,
}

impl<'a> Reached<'a> {
    fn new(bounds: BoundingBox, size: &'a Size) -> Self {
        let counts = bounds.size().to_array().map(|length| (length / size.smallest) as usize + 1);
        Self { size, low: bounds.low, counts, is_reached: vec![false; counts.iter().product()] }
    }

    /// By the cells of a mesh.
    fn by_cells(mesh: &Mesh, bounds: BoundingBox, size: &'a Size) -> Self {
        let mut reached = Self::new(bounds, size);
        for cell in mesh.cells() {
            reached.mark(BoundingBox::of(cell.nodes.iter().map(|node| mesh.points[*node as usize])));
        }
        reached
    }

    /// By the faces of a mesh's boundary.
    fn by_boundary(mesh: &Mesh, bounds: BoundingBox, size: &'a Size) -> Self {
        let mut reached = Self::new(bounds, size);
        let boundary = mesh.boundary_surface();
        for triangle in 0..boundary.triangles.len() as u32 {
            reached.mark(BoundingBox::of(boundary.corners(triangle)));
        }
        reached
    }

    fn mark(&mut self, bounds: BoundingBox) {
        for cube in cubes(self.counts, self.place(bounds.low), self.place(bounds.high)) {
            self.is_reached[cube] = true;
        }
    }

    fn place(&self, point: Vec3) -> [i64; 3] {
        ((point - self.low) * (1.0 / self.size.smallest)).to_array().map(|c| c.floor() as i64)
    }

    /// Whether a point is more than a cell away from all that is reached.
    fn is_far(&self, point: Vec3) -> bool {
        let layers = match &self.size.grading {
            Grading::Field { size, largest, reach: Reach::Everywhere } => {
                (size(point).min(*largest) / self.size.smallest).max(1.0).ceil() as i64
            }
            _ => 1,
        };
        let at = self.place(point);
        cubes(self.counts, at.map(|c| c - layers), at.map(|c| c + layers)).all(|cube| !self.is_reached[cube])
    }
}

/// Cubes from one to another, both included, as far as there are such.
fn cubes(counts: [usize; 3], from: [i64; 3], to: [i64; 3]) -> impl Iterator<Item = usize> {
    let range = |axis: usize| from[axis].max(0)..(to[axis] + 1).min(counts[axis] as i64);
    let (x, y, z) = (range(0), range(1), range(2));
    let [nx, ny, _] = counts.map(|n| n as i64);
    z.flat_map(move |k| {
        let x = x.clone();
        y.clone().flat_map(move |j| x.clone().map(move |i| (i + nx * (j + ny * k)) as usize))
    })
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
            "{} filled up, the first at {}: what is thinner than a cell is lost; take a smaller size",
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

/// Values of a shape on a grid.
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
    let lost: Vec<usize> = (0..closer.values.len()).filter(|p| reached.is_far(closer.position(*p))).collect();
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
    parts(closer.parts(), mesh.components().1, "the shape").into_iter().collect()
}

impl<'a> Closer<'a> {
    /// Two places for the length of a cell, or as many as are looked at.
    fn new(shape: &'a dyn Shape, cell: f64) -> Self {
        let bounds = shape.bounds();
        let extent = bounds.size();
        let spacing = (0.5 * cell).max((extent.x * extent.y * extent.z / MOST_PLACES).cbrt());
        let counts = extent.to_array().map(|length| (length / spacing).ceil() as usize + 1);
        let whole = Vec3::from_array(counts.map(|count| (count - 1) as f64 * spacing));
        let low = bounds.centre() - whole * 0.5;
        let mut closer = Self { shape, low, spacing, counts, values: Vec::new() };
        closer.values =
            (0..counts.iter().product()).into_par_iter().map(|p| shape.value(closer.position(p))).collect();
        closer
    }

    fn position(&self, place: usize) -> Vec3 {
        let [nx, ny, _] = self.counts;
        let index = [place % nx, place / nx % ny, place / (nx * ny)];
        self.low + Vec3::from_array(index.map(|i| i as f64 * self.spacing))
    }

    /// The places before and after one along an axis.
    fn beside(&self, place: usize, axis: usize) -> Option<[usize; 2]> {
        let [nx, ny, _] = self.counts;
        let stride = [1, nx, nx * ny][axis];
        let index = place / stride % self.counts[axis];
        (index > 0 && index + 1 < self.counts[axis]).then(|| [place - stride, place + stride])
    }

    /// A place inside within the spacing of one outside, where the value has a dip that may reach below zero: by the steeper of
    /// its sides.
    fn dip(&self, place: usize) -> Option<Vec3> {
        let value = self.values[place];
        let may_hide = |axis: usize| {
            let Some(beside) = self.beside(place, axis) else { return false };
            let rises = beside.map(|other| self.values[other] - value);
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

    /// Parts of the inside that are as large as a cube of the lattice.
    fn parts(&self) -> usize {
        let mut is_seen = vec![false; self.values.len()];
        let mut count = 0;
        let mut stack = Vec::new();
        for start in 0..self.values.len() {
            if self.values[start] >= 0.0 || std::mem::replace(&mut is_seen[start], true) {
                continue;
            }
            stack.push(start);
            let mut places = 0;
            while let Some(place) = stack.pop() {
                places += 1;
                for other in (0..3).filter_map(|axis| self.beside(place, axis)).flatten() {
                    if self.values[other] < 0.0 && !std::mem::replace(&mut is_seen[other], true) {
                        stack.push(other);
                    }
                }
            }
            count += usize::from(places >= PLACES_OF_A_CUBE);
        }
        count
    }
}

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
