//! The rest shape of a surface as bending sees it: triangles laid out flat beside their neighbours, and what their folds tell of curvature.

use std::collections::BTreeMap;

use souple_math::{Mat3, Vec3};
use souple_mesh::{ElementKind, Mesh};

use super::fold::{Fold, Held, Turned};
use super::{BendingError, Bent, Clamp, FOLDS, Plate, ROWS};

/// How far a triangle is turned at the middle of an edge, per angle of some folds.
pub(super) type Turn = Vec<(u32, f64)>;

/// A side of a triangle at rest.
struct Side {
    length: f64,
    /// Along it and out of the triangle, in the triangle's axes.
    along: [f64; 2],
    out: [f64; 2],
    /// Where the opposite corner is from its middle, along and out [m].
    apex: [f64; 2],
    /// `None`: a free edge.
    fold: Option<u32>,
}

impl Side {
    /// `K_uv` of directions as a row of `(K₁₁, K₂₂, 2 K₁₂)`.
    fn row(u: [f64; 2], v: [f64; 2]) -> Vec3 {
        Vec3::new(u[0] * v[0], u[1] * v[1], 0.5 * (u[0] * v[1] + u[1] * v[0]))
    }

    /// `m ⊗ m` as `(κ₁₁, κ₂₂, 2 κ₁₂)`.
    fn bend(&self) -> Vec3 {
        let [x, y] = self.out;
        Vec3::new(x * x, y * y, 2.0 * x * y)
    }

    /// How much less than at the middle of the edge a triangle with a corner at `apex` slopes outwards, where the surface has
    /// a constant curvature: a row of `(K₁₁, K₂₂, 2 K₁₂)`.
    fn lag(&self, [along, out]: [f64; 2]) -> Vec3 {
        let [tt, tm, mm] = [(self.along, self.along), (self.along, self.out), (self.out, self.out)]
            .map(|(u, v)| Self::row(u, v));
        // the plane through both ends, `K_tt l²/8` high, and the corner
        let rise = tt * (0.5 * along * along - self.length * self.length / 8.0)
            + tm * (along * out)
            + mm * (0.5 * out * out);
        -(rise / out)
    }
}

/// A triangle at rest in its own axes.
pub(super) struct Triangle {
    area: f64,
    sides: [Side; 3],
    plate: Plate,
}

impl Triangle {
    fn new(places: [Vec3; 3], plate: &Plate, fold_of_side: [Option<u32>; 3]) -> Option<Self> {
        let [first, second] = plane_axes(places, plate.first)?;
        let side = |index: usize| {
            let [a, b, c] = [0, 1, 2].map(|corner| places[(index + corner) % 3]);
            let length = (b - a).length();
            let (along, normal) = ((b - a) / length, first.cross(second));
            let (out, apex) = (along.cross(normal), c - (a + b) * 0.5);
            let flat = |v: Vec3| [v.dot(first), v.dot(second)];
            let (fold, apex) = (fold_of_side[index], [apex.dot(along), apex.dot(out)]);
            Side { length, along: flat(along), out: flat(out), apex, fold }
        };
        let [a, b, c] = places;
        let area = 0.5 * (b - a).cross(c - a).length();
        Some(Self { area, sides: [side(0), side(1), side(2)], plate: *plate })
    }

    /// How far it is turned at the middle of a side where it has its natural curvature [rad].
    fn naturally_turned(&self, side: usize) -> f64 {
        let side = &self.sides[side];
        side.lag(side.apex).dot(self.plate.natural)
    }

    /// What resists changes of the angles at its edges, and what is given off by their rates, `A D` [N m³] and [N m³ s]. The slope
    /// across a free edge is the one of least energy, `κ ↦ κ - g (g·D κ)/(g·D g)`, and its rate the same of that of the curvature.
    pub fn resistance(&self) -> [Mat3; 2] {
        let mut resistance = [self.plate.rigidity, self.plate.viscosity].map(|of_area| of_area * self.area);
        for side in self.sides.iter().filter(|side| side.fold.is_none()) {
            let [stiffness, _] = resistance;
            let bend = side.bend();
            let moment = stiffness * bend;
            let resistance_across = bend.dot(moment);
            // nothing is left where the other edges are free too
            if resistance_across > 1e-12 * stiffness.largest_entry() {
                let left = Mat3::IDENTITY - bend.outer(moment) * (1.0 / resistance_across);
                resistance = resistance.map(|of| left.transpose_mul(&(of * left)).symmetric_part());
            }
        }
        resistance
    }
}

/// Which triangles meet at an edge: the one that runs round it from the first point to the second, and the other.
struct Meeting {
    edge: [u32; 2],
    own: (usize, usize),
    other: Beyond,
}

#[derive(Clone, Copy)]
enum Beyond {
    Triangle((usize, usize)),
    Clamp { leader: Option<u32> },
}

/// The rest shape of a surface as bending sees it.
pub(super) struct Surface<'a> {
    mesh: &'a Mesh,
    corners: Vec<[u32; 3]>,
    pub triangles: Vec<Triangle>,
    folds: Vec<Meeting>,
    /// From end to end of it [m].
    extent: f64,
}

impl<'a> Surface<'a> {
    /// Of clamps, each with the leader that turns it.
    pub fn new(
        mesh: &'a Mesh,
        plates: &[Plate],
        clamps: impl Iterator<Item = ([u32; 2], Option<u32>)>,
    ) -> Result<Self, BendingError> {
        let corners = corners_of(mesh)?;
        let folds = meetings(&corners, clamps.collect())?;
        let mut fold_of_side = vec![[None; 3]; corners.len()];
        for (number, fold) in folds.iter().enumerate() {
            let other = match fold.other {
                Beyond::Triangle(other) => Some(other),
                Beyond::Clamp { .. } => None,
            };
            for (triangle, side) in [Some(fold.own), other].into_iter().flatten() {
                fold_of_side[triangle][side] = Some(number as u32);
            }
        }
        let mut triangles = Vec::with_capacity(corners.len());
        for (cell, (nodes, plate)) in corners.iter().zip(plates).enumerate() {
            let places = nodes.map(|point| mesh.points[point as usize]);
            let triangle = Triangle::new(places, plate, fold_of_side[cell]);
            triangles.push(triangle.ok_or(BendingError::Flat { cell })?);
        }
        Ok(Self { mesh, corners, triangles, folds, extent: mesh.bounds().diagonal() })
    }

    /// Its folds, by rows of points.
    pub fn folds(&self, row: impl Fn(u32) -> u32) -> Vec<Fold> {
        self.folds.iter().map(|meeting| self.fold(meeting, &row)).collect()
    }

    /// The other triangle at a fold and its side there; `None` where it is clamped.
    fn beyond(&self, fold: u32, triangle: usize) -> Option<(usize, usize)> {
        match self.folds[fold as usize] {
            Meeting { own, other, .. } if own.0 == triangle => match other {
                Beyond::Triangle(other) => Some(other),
                Beyond::Clamp { .. } => None,
            },
            Meeting { own, .. } => Some(own),
        }
    }

    fn fold(&self, meeting: &Meeting, row: impl Fn(u32) -> u32) -> Fold {
        let opposite = |(triangle, side): (usize, usize)| self.corners[triangle][(side + 2) % 3];
        let [a, b] = meeting.edge;
        let c = opposite(meeting.own);
        let turned = |(triangle, side): (usize, usize)| self.triangles[triangle].naturally_turned(side);
        let mut natural = turned(meeting.own);
        let mut fold = Fold { rows: [a, b, c, c], held: None, flat: 0.0, rest: 0.0 };
        match meeting.other {
            Beyond::Triangle(other) => {
                fold.rows[3] = opposite(other);
                natural += turned(other);
                fold.flat = fold.angle(&self.mesh.points, |_| Turned::NOT).value;
            }
            // in the plane of the triangle, so that the angle is none
            Beyond::Clamp { leader } => {
                let [a, b, c] = [a, b, c].map(|point| self.mesh.points[point as usize]);
                fold.held = Some(Held { across: out_of(a, b, c), leader });
            }
        }
        fold.rest = fold.flat + natural;
        fold.rows = fold.rows.map(row);
        fold
    }

    /// How far a triangle is turned at its edges where its curvature is constant over its neighbours: exact then. `None` at free
    /// edges, and where its neighbours do not tell a curvature well.
    ///
    /// Angles are of what is beside natural curvatures, so that there is no moment across free edges.
    pub fn estimates(&self, number: usize) -> [Option<Turn>; 3] {
        let triangle = &self.triangles[number];
        let rigidity = triangle.plate.rigidity;
        let largest = rigidity.largest_entry();
        // angles by curvature
        let rows = triangle.sides.each_ref().map(|side| match side.fold {
            Some(fold) => match self.beyond(fold, number) {
                Some(beyond) => side.lag(side.apex) - side.lag(self.apex_beyond(beyond)),
                None => side.lag(side.apex),
            },
            None => (rigidity * side.bend()) * (side.length / largest),
        });
        let Some(curvature) = Mat3::from_rows(rows.map(Vec3::to_array)).try_inverse() else {
            return [None, None, None];
        };
        let longest = triangle.sides.iter().map(|side| side.length).fold(0.0, f64::max);
        triangle.sides.each_ref().map(|side| {
            side.fold?;
            let by_side = curvature.transpose_apply(side.lag(side.apex)).to_array();
            let share = |(side, turn): (&Side, f64)| side.fold.map(|fold| (fold, turn));
            let turn: Turn = triangle.sides.iter().zip(by_side).filter_map(share).collect();
            let weight: f64 = turn.iter().map(|(_, by_angle)| by_angle.abs()).sum();
            (weight * longest <= self.extent).then_some(turn)
        })
    }

    /// Where the corner beyond an edge is from the edge's middle, laid out flat, along and out as this side sees it.
    fn apex_beyond(&self, (triangle, side): (usize, usize)) -> [f64; 2] {
        self.triangles[triangle].sides[side].apex.map(|coordinate| -coordinate)
    }

    /// How far a triangle is turned at an edge of its own, after both sides have been heard.
    fn turn(&self, number: usize, side: usize, fold: u32, estimates: &[[Option<Turn>; 3]]) -> Turn {
        let Some((other, beyond)) = self.beyond(fold, number) else { return vec![(fold, 1.0)] };
        let own = estimates[number][side].iter().map(|turn| (turn, 1.0));
        // φ_T = θ - φ_N
        let others = estimates[other][beyond].iter().map(|turn| (turn, -1.0));
        let heard: Vec<(&Turn, f64)> = own.chain(others).collect();
        if heard.is_empty() {
            let [own, other] = [number, other].map(|triangle| self.triangles[triangle].area);
            return vec![(fold, own / (own + other))];
        }
        let share = 1.0 / heard.len() as f64;
        let mut turn = Turn::new();
        for (estimate, sign) in heard {
            turn.extend(estimate.iter().map(|(fold, angle)| (*fold, sign * share * angle)));
            if sign < 0.0 {
                turn.push((fold, share));
            }
        }
        turn
    }

    pub fn bent(&self, number: usize, estimates: &[[Option<Turn>; 3]], folds: &[Fold]) -> Bent {
        let triangle = &self.triangles[number];
        let mut bent = Bent {
            fold_count: 0,
            row_count: 0,
            folds: [0; FOLDS],
            curvature: [Vec3::ZERO; FOLDS],
            corners: [[0; 4]; FOLDS],
            rows: [0; ROWS],
        };
        for (index, side) in triangle.sides.iter().enumerate() {
            let Some(fold) = side.fold else { continue };
            let bend = side.bend() * (side.length / triangle.area);
            for (fold, angle) in self.turn(number, index, fold, estimates) {
                bent.add_fold(fold, bend * angle, &folds[fold as usize]);
            }
        }
        bent
    }
}

impl Bent {
    fn add_fold(&mut self, number: u32, curvature: Vec3, fold: &Fold) {
        let count = usize::from(self.fold_count);
        if let Some(known) = self.folds[..count].iter().position(|known| *known == number) {
            self.curvature[known] += curvature;
            return;
        }
        self.folds[count] = number;
        self.curvature[count] = curvature;
        self.corners[count] = fold.rows.map(|row| self.add_row(row));
        self.fold_count += 1;
    }

    fn add_row(&mut self, row: u32) -> u8 {
        if let Some(known) = self.rows().iter().position(|known| *known == row) {
            return known as u8;
        }
        self.rows[usize::from(self.row_count)] = row;
        self.row_count += 1;
        self.row_count - 1
    }
}

/// Two directions across each other in the plane of a triangle, the first as near to `first` as may be; where that [lies
/// across](lies_across) the plane, along the first edge. `None` of a triangle without area.
pub fn plane_axes([a, b, c]: [Vec3; 3], first: Vec3) -> Option<[Vec3; 2]> {
    let normal = (b - a).cross(c - a).try_normalised()?;
    let in_plane = first - normal * first.dot(normal);
    let wanted = if lies_across([a, b, c], first) { b - a } else { in_plane };
    let first = wanted.try_normalised()?;
    Some([first, normal.cross(first)])
}

/// Whether a direction is so near to the normal of a triangle that the one in its plane is lost in rounding.
pub fn lies_across([a, b, c]: [Vec3; 3], direction: Vec3) -> bool {
    let Some(normal) = (b - a).cross(c - a).try_normalised() else { return false };
    let in_plane = direction - normal * direction.dot(normal);
    in_plane.length() <= 1e-6 * direction.length()
}

/// An edge of the border of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BorderEdge {
    /// As its triangle runs round it.
    pub edge: [u32; 2],
    /// Across the edge in the plane of its triangle, out of the surface; of length one.
    pub across: Vec3,
}

/// The edges of the border of a surface of triangles, by ascending points.
///
/// # Errors
/// Cells that are no triangles with area, or do not make an oriented surface.
pub fn border_edges(mesh: &Mesh) -> Result<Vec<BorderEdge>, BendingError> {
    let corners = corners_of(mesh)?;
    let users = users_of_edges(&corners);
    let lone = users.values().filter_map(|users| match users[..] {
        [own] => Some(own),
        _ => None,
    });
    lone.map(|(cell, side)| {
        let nodes = [0, 1, 2].map(|corner| corners[cell][(side + corner) % 3]);
        let [a, b, c] = nodes.map(|point| mesh.points[point as usize]);
        let across = out_of(a, b, c).try_normalised().ok_or(BendingError::Flat { cell })?;
        Ok(BorderEdge { edge: [nodes[0], nodes[1]], across })
    })
    .collect()
}

/// From the foot of the height of a triangle over an edge, as far to the other side as the corner is on this one.
fn out_of(a: Vec3, b: Vec3, c: Vec3) -> Vec3 {
    let along = b - a;
    along * ((c - a).dot(along) / along.length_sq()) - (c - a)
}

fn corners_of(mesh: &Mesh) -> Result<Vec<[u32; 3]>, BendingError> {
    let of = |(number, cell): (usize, souple_mesh::Cell)| match cell.nodes {
        [a, b, c] if cell.kind == ElementKind::Tri3 => Ok([*a, *b, *c]),
        _ => Err(BendingError::Kind { cell: number, kind: cell.kind }),
    };
    mesh.cells().enumerate().map(of).collect()
}

/// Triangles and their sides by the edges that these are.
fn users_of_edges(corners: &[[u32; 3]]) -> BTreeMap<[u32; 2], Vec<(usize, usize)>> {
    let mut users: BTreeMap<[u32; 2], Vec<(usize, usize)>> = BTreeMap::new();
    for (triangle, nodes) in corners.iter().enumerate() {
        for side in 0..3 {
            let [a, b] = [nodes[side], nodes[(side + 1) % 3]];
            users.entry([a.min(b), a.max(b)]).or_default().push((triangle, side));
        }
    }
    users
}

/// Where triangles meet, and where the border is clamped, by ascending points of edges.
fn meetings(
    corners: &[[u32; 3]],
    clamps: BTreeMap<[u32; 2], Option<u32>>,
) -> Result<Vec<Meeting>, BendingError> {
    let users = users_of_edges(corners);
    if let Some((edge, _)) =
        clamps.iter().find(|(edge, _)| users.get(*edge).is_none_or(|users| users.len() != 1))
    {
        return Err(BendingError::Inside { edge: *edge });
    }
    let from = |(triangle, side): (usize, usize)| corners[triangle][side];
    let mut found = Vec::new();
    for ([low, high], users) in users {
        let edge = |user: (usize, usize)| if from(user) == low { [low, high] } else { [high, low] };
        match users[..] {
            [own] => {
                if let Some(leader) = clamps.get(&[low, high]) {
                    let other = Beyond::Clamp { leader: *leader };
                    found.push(Meeting { edge: edge(own), own, other });
                }
            }
            [own, other] if from(own) == from(other) => {
                return Err(BendingError::Turned { edge: [low, high] });
            }
            [own, other] => {
                found.push(Meeting { edge: edge(own), own, other: Beyond::Triangle(other) });
            }
            _ => return Err(BendingError::Branches { edge: [low, high] }),
        }
    }
    Ok(found)
}

/// By ascending points.
pub(super) fn ascending(clamp: &Clamp) -> [u32; 2] {
    let [a, b] = clamp.edge;
    [a.min(b), a.max(b)]
}
