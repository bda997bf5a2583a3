//! How two features meet: how far apart they are, in which direction, and at which points.

use souple_engine::Sides;
use souple_math::Vec3;

use super::features::{Edge, Features};

/// What may touch: places in the lists of [`Features`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Meets {
    /// A corner, or the centre of a ball, a face.
    Face { corner: usize, face: usize },
    /// The centre of a ball an edge.
    Edge { corner: usize, edge: usize },
    /// The centre of a ball a corner.
    Corner { corner: usize, other: usize },
    /// An edge of the body before an edge of the one behind.
    Edges { one: usize, other: usize },
}

/// In the numbers of pairs the kind is above the place.
const PLACES: u32 = 32;
const FACE: u64 = 0;
const EDGE: u64 = 1;
const CORNER: u64 = 2;

impl Meets {
    /// As the two numbers of a pair.
    pub fn key(self) -> [u64; 2] {
        let number = |kind: u64, place: usize| kind << PLACES | place as u64;
        match self {
            Self::Face { corner, face } => [number(CORNER, corner), number(FACE, face)],
            Self::Edge { corner, edge } => [number(CORNER, corner), number(EDGE, edge)],
            Self::Corner { corner, other } => [number(CORNER, corner), number(CORNER, other)],
            Self::Edges { one, other } => [number(EDGE, one), number(EDGE, other)],
        }
    }

    /// What two numbers of a pair stand for; `None` where they are of no kind.
    pub fn of(key: [u64; 2]) -> Option<Self> {
        let [(kind, one), (other_kind, other)] =
            key.map(|number| (number >> PLACES, (number & u64::from(u32::MAX)) as usize));
        Some(match (kind, other_kind) {
            (CORNER, FACE) => Self::Face { corner: one, face: other },
            (CORNER, EDGE) => Self::Edge { corner: one, edge: other },
            (CORNER, CORNER) => Self::Corner { corner: one, other },
            (EDGE, EDGE) => Self::Edges { one, other },
            _ => return None,
        })
    }
}

/// A place on a feature and on another that is nearest to it.
pub(super) struct Meeting {
    /// Without radii, negative where they have entered [m].
    pub distance: f64,
    /// From the second to the first, of length 1; none where no direction parts them.
    pub normal: Option<Vec3>,
    pub sides: Sides,
}

/// Barycentric coordinates of what is nearest to a point on the plane of a triangle, and the normal; a third each and none where it has no area.
pub(super) fn foot_on_plane([a, b, c]: [Vec3; 3], point: Vec3) -> ([f64; 3], Option<Vec3>) {
    let across = (b - a).cross(c - a);
    let size = across.length_sq();
    let Some(normal) = across.try_normalised() else { return ([1.0 / 3.0; 3], None) };
    let from = point - a;
    let second = from.cross(c - a).dot(across) / size;
    let third = (b - a).cross(from).dot(across) / size;
    ([1.0 - second - third, second, third], Some(normal))
}

/// Where on a line through two points another is nearest, from 0 at the first to 1 at the second.
pub(super) fn foot_on_line([a, b]: [Vec3; 2], point: Vec3) -> f64 {
    let along = b - a;
    let size = along.length_sq();
    if size > 0.0 { (point - a).dot(along) / size } else { 0.5 }
}

/// Where two lines through points each are nearest to each other, likewise; `None` where they are parallel.
pub(super) fn feet_of_lines([a, b]: [Vec3; 2], [c, d]: [Vec3; 2]) -> Option<[f64; 2]> {
    let (along, other, between) = (b - a, d - c, c - a);
    let across = along.cross(other);
    let size = across.length_sq();
    if size == 0.0 {
        return None;
    }
    Some([between.cross(other).dot(across) / size, between.cross(along).dot(across) / size])
}

impl Edge {
    pub fn places(&self, positions: &[Vec3]) -> [Vec3; 2] {
        self.ends.map(|end| positions[end as usize])
    }

    /// Along each triangle beside it, away from it and at a right angle to it, of length 1.
    pub fn inward(&self, positions: &[Vec3]) -> [Option<Vec3>; 2] {
        let [a, b] = self.places(positions);
        let along = (b - a).try_normalised().unwrap_or(Vec3::ZERO);
        self.beside.map(|beside| {
            let to = positions[beside? as usize] - a;
            (to - along * along.dot(to)).try_normalised()
        })
    }

    /// The sum of the normals of the triangles beside it, outward.
    pub fn outward(&self, positions: &[Vec3]) -> Vec3 {
        let [a, b] = self.places(positions);
        let normal = |(beside, sign): (Option<u32>, f64)| {
            let across = (b - a).cross(positions[beside? as usize] - a) * sign;
            across.try_normalised()
        };
        self.beside.into_iter().zip([1.0, -1.0]).filter_map(normal).sum()
    }
}

impl Features {
    /// How what may touch meets where rows are.
    pub fn meeting(&self, meets: Meets, positions: &[Vec3]) -> Meeting {
        match meets {
            Meets::Face { corner, face } => {
                let row = self.corners[corner].row;
                let rows = self.faces[face];
                let corners = rows.map(|row| positions[row as usize]);
                let (shares, normal) = foot_on_plane(corners, positions[row as usize]);
                let from = positions[row as usize] - corners[0];
                let distance = normal.map_or(0.0, |normal| normal.dot(from));
                let on = [0, 1, 2].map(|at| (rows[at], shares[at]));
                Meeting { distance, normal, sides: Sides::between([(row, 1.0)], on) }
            }
            Meets::Edge { corner, edge } => {
                let row = self.corners[corner].row;
                let edge = &self.edges[edge];
                let [a, b] = edge.places(positions);
                let at = foot_on_line([a, b], positions[row as usize]);
                let from = positions[row as usize] - (a + (b - a) * at);
                let on = [(edge.ends[0], 1.0 - at), (edge.ends[1], at)];
                Meeting::apart(from, Sides::between([(row, 1.0)], on))
            }
            Meets::Corner { corner, other } => {
                let rows = [corner, other].map(|corner| self.corners[corner].row);
                let [a, b] = rows.map(|row| positions[row as usize]);
                Meeting::apart(a - b, Sides::two(rows))
            }
            Meets::Edges { one, other } => {
                self.edges_meeting(&self.edges[one], &self.edges[other], positions)
            }
        }
    }

    // |(d₁ × d₂) · (a₁ − a₂)| / |d₁ × d₂|, with the sign of what is outside
    fn edges_meeting(&self, one: &Edge, other: &Edge, positions: &[Vec3]) -> Meeting {
        let (places, other_places) = (one.places(positions), other.places(positions));
        let [s, t] = feet_of_lines(places, other_places).unwrap_or([0.5; 2]);
        let sides = Sides::between(
            [(one.ends[0], 1.0 - s), (one.ends[1], s)],
            [(other.ends[0], 1.0 - t), (other.ends[1], t)],
        );
        let across = (places[1] - places[0]).cross(other_places[1] - other_places[0]);
        let outward = other.outward(positions) - one.outward(positions);
        let normal = across.try_normalised().map(|n| if n.dot(outward) < 0.0 { -n } else { n });
        let distance = normal.map_or(0.0, |normal| normal.dot(places[0] - other_places[0]));
        Meeting { distance, normal, sides }
    }
}

impl Meeting {
    fn apart(from: Vec3, sides: Sides) -> Self {
        Self { distance: from.length(), normal: from.try_normalised(), sides }
    }
}
