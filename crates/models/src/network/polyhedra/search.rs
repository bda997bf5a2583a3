//! Which features of bodies are near each other.
//!
//! Of a convex body what touches is a corner of one on a face of the other, or two edges that cross: what else is in one plane with these is left out by
//! the cone of normals of each feature, so that no side of a step is met on the way over it.

use souple_engine::{Configuration, Pair, make_room};
use souple_math::Vec3;

use super::features::Features;
use super::meeting::{Meets, feet_of_lines, foot_on_line, foot_on_plane};

/// How far around bodies it is looked beside how far they come in a step, as a share of their shortest edge or of their radius.
const SKIN: f64 = 0.1;
/// How far over the border of a face a corner is still on it, as a share of the face.
const BORDER: f64 = 1e-6;
/// How far from its ends an edge is crossed, as a share of it: nearer to them corners are on faces, and rounding does not tell.
const ENDS: f64 = 1e-7;
/// What has entered by less touches from outside, as a share of how far it is looked; contacts are found to 1e-7 of what moves.
const TOUCHES: f64 = 1e-5;
/// Sine of the angle by which features that come to lie on each other may be tilted yet, at most; as far as they may turn in a step.
const TILT: f64 = 0.2;
/// Steps ago in which what has entered was still outside: one, and what turning makes of it.
const AGO: f64 = 1.5;
/// Sine of the angle below which two edges are parallel, and corners on faces bear.
const PARALLEL: f64 = 1e-3;
/// Sine of the angle by which an edge stands out at least.
const FLAT: f64 = 1e-6;

/// What searches work with.
#[derive(Debug, Default)]
pub(super) struct Search {
    /// Of each body, grown by how far around it is looked.
    boxes: Vec<Around>,
    /// Bodies by where their boxes begin along x.
    order: Vec<usize>,
    /// Features of two bodies that are near the other.
    near: [Near; 2],
}

/// Features of a body, by their places in the lists of all.
#[derive(Debug, Default)]
struct Near {
    corners: Vec<usize>,
    faces: Vec<usize>,
    edges: Vec<usize>,
}

/// A box, and how far around what is in it is looked [m].
#[derive(Clone, Copy, Debug)]
struct Around {
    low: Vec3,
    high: Vec3,
    reach: f64,
}

impl Around {
    const NOTHING: Self = Self {
        low: Vec3::new(f64::INFINITY, f64::INFINITY, f64::INFINITY),
        high: Vec3::new(f64::NEG_INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY),
        reach: 0.0,
    };

    fn and(self, place: Vec3) -> Self {
        Self { low: self.low.min_components(place), high: self.high.max_components(place), ..self }
    }

    fn grown(self, by: f64) -> Self {
        let by = Vec3::new(by, by, by);
        Self { low: self.low - by, high: self.high + by, ..self }
    }

    fn meets(&self, other: &Self) -> bool {
        let apart = |axis: usize| self.high[axis] < other.low[axis] || other.high[axis] < self.low[axis];
        !(0..3).any(apart)
    }
}

/// Two bodies, the second of which is met, and where all rows are.
#[derive(Clone, Copy)]
struct Met<'a> {
    features: &'a Features,
    at: &'a Configuration<'a>,
    timestep: f64,
    /// Of the balls of the first [m].
    radius: f64,
    /// How far apart features are looked for [m].
    reach: f64,
    /// Sine of the angle by which they may be tilted.
    tilt: f64,
}

impl Search {
    /// Lists what may touch within a step.
    pub fn find(&mut self, features: &Features, timestep: f64, at: &Configuration, found: &mut Vec<Pair>) {
        self.enclose(features, timestep, at);
        let order = std::mem::take(&mut self.order);
        for (place, one) in order.iter().copied().enumerate() {
            let around = self.boxes[one];
            for other in order[place + 1..].iter().copied() {
                if self.boxes[other].low.x > around.high.x {
                    break;
                }
                let bodies = [one.min(other), one.max(other)];
                if self.boxes[other].meets(&around) && features.may_meet(bodies) {
                    self.between((features, timestep), bodies, at, found);
                }
            }
        }
        self.order = order;
    }

    fn enclose(&mut self, features: &Features, timestep: f64, at: &Configuration) {
        self.boxes.clear();
        self.boxes.extend(features.bodies.iter().map(|body| {
            let rows = || features.corners[body.corners.clone()].iter().map(|corner| corner.row as usize);
            let fastest = rows().map(|row| at.velocities[row].length()).fold(0.0, f64::max);
            // twice as far as it comes, as balls are looked for
            let reach = 2.0 * timestep * fastest + SKIN * body.size;
            let around =
                rows().fold(Around { reach, ..Around::NOTHING }, |all, row| all.and(at.positions[row]));
            around.grown(body.radius + reach)
        }));
        self.order.clear();
        self.order.extend(0..self.boxes.len());
        let low = |body: &usize| self.boxes[*body].low.x;
        self.order.sort_by(|one, other| low(one).total_cmp(&low(other)).then(one.cmp(other)));
    }

    /// Lists what of two bodies may touch.
    fn between(
        &mut self,
        (features, timestep): (&Features, f64),
        bodies: [usize; 2],
        at: &Configuration,
        found: &mut Vec<Pair>,
    ) {
        let reach: f64 = bodies.iter().map(|body| self.boxes[*body].reach).sum();
        let size = bodies.iter().map(|body| features.bodies[*body].size).fold(f64::INFINITY, f64::min);
        let way = reach - SKIN * bodies.iter().map(|body| features.bodies[*body].size).sum::<f64>();
        let tilt = (TOUCHES + way / size).clamp(TOUCHES, TILT);
        let met = Met { features, at, timestep, radius: 0.0, reach, tilt };
        for (side, body) in bodies.into_iter().enumerate() {
            let other = self.boxes[bodies[1 - side]];
            self.near[side].fill((features, at.positions), body, &self.boxes[body], &other);
        }
        for (side, body) in bodies.into_iter().enumerate() {
            let met = Met { radius: features.bodies[body].radius, ..met };
            let other = &self.near[1 - side];
            for corner in self.near[side].corners.iter().copied() {
                met.faces(corner, &other.faces, found);
                if met.radius > 0.0 {
                    met.borders(corner, other, found);
                }
            }
        }
        for one in self.near[0].edges.iter().copied() {
            for other in self.near[1].edges.iter().copied() {
                if met.edges_cross(one, other) {
                    push(Meets::Edges { one, other }, found);
                }
            }
        }
    }

    pub fn bytes(&self) -> usize {
        let near = self.near.iter().flat_map(|near| [&near.corners, &near.faces, &near.edges]);
        size_of::<Around>() * self.boxes.capacity()
            + 8 * (self.order.capacity() + near.map(Vec::capacity).sum::<usize>())
    }
}

impl Near {
    /// What of a body is near the box around another.
    fn fill(
        &mut self,
        (features, positions): (&Features, &[Vec3]),
        body: usize,
        own: &Around,
        other: &Around,
    ) {
        let body = &features.bodies[body];
        let is_near = |rows: &[u32]| {
            let around = rows.iter().fold(Around::NOTHING, |all, row| all.and(positions[*row as usize]));
            around.grown(body.radius + own.reach).meets(other)
        };
        self.corners.clear();
        self.corners.extend(body.corners.clone().filter(|it| is_near(&[features.corners[*it].row])));
        self.faces.clear();
        self.faces.extend(body.faces.clone().filter(|it| is_near(&features.faces[*it])));
        self.edges.clear();
        self.edges.extend(body.edges.clone().filter(|it| is_near(&features.edges[*it].ends)));
    }
}

fn push(meets: Meets, found: &mut Vec<Pair>) {
    let [a, b] = meets.key();
    make_room(found, 1);
    found.push(Pair::new(a as usize, b as usize, [0.0; 8]));
}

impl Met<'_> {
    fn place(&self, corner: usize) -> Vec3 {
        self.at.positions[self.features.corners[corner].row as usize]
    }

    /// How deep what only touches may be [m].
    fn touch(&self) -> f64 {
        TOUCHES * self.reach
    }

    /// Whether what has entered was outside where the step before began: what comes from behind is not put out in front.
    fn came_from_outside(&self, meets: Meets) -> bool {
        let meeting = self.features.meeting(meets, self.at.positions);
        let Some(normal) = meeting.normal else { return false };
        let parting: Vec3 = meeting.sides.iter().map(|(row, weight)| self.at.velocities[row] * weight).sum();
        let before = meeting.distance - self.radius - AGO * self.timestep * normal.dot(parting);
        before >= -self.touch()
    }

    /// Faces that a corner is above, or, if it is above none, that which it has entered least.
    fn faces(&self, corner: usize, faces: &[usize], found: &mut Vec<Pair>) {
        let point = self.place(corner);
        let mut is_outside = false;
        let mut entered: Option<(f64, Meets)> = None;
        for face in faces.iter().copied() {
            let places = self.features.faces[face].map(|row| self.at.positions[row as usize]);
            let (shares, normal) = foot_on_plane(places, point);
            let Some(normal) = normal else { continue };
            let gap = normal.dot(point - places[0]) - self.radius;
            let least = shares.into_iter().fold(f64::INFINITY, f64::min);
            if gap.abs() > self.reach || least < -BORDER {
                continue;
            }
            // on its border it may be beside the face as well
            if least < BORDER && !self.bears(corner, normal) {
                continue;
            }
            let meets = Meets::Face { corner, face };
            if gap >= -self.touch() {
                is_outside = true;
                push(meets, found);
            } else if entered.is_none_or(|(before, _)| gap > before) && self.came_from_outside(meets) {
                entered = Some((gap, meets));
            }
        }
        if let Some((_, meets)) = entered.filter(|_| !is_outside) {
            push(meets, found);
        }
    }

    /// Whether a corner that is on a plane leaves its body above it.
    fn bears(&self, corner: usize, normal: Vec3) -> bool {
        let place = self.place(corner);
        self.features.neighbours_of(corner).all(|row| {
            let to = self.at.positions[row] - place;
            normal.dot(to) >= -self.tilt * to.length()
        })
    }

    /// Edges and corners that the centre of a ball is beside, and not above a face.
    fn borders(&self, corner: usize, other: &Near, found: &mut Vec<Pair>) {
        let (features, positions) = (self.features, self.at.positions);
        let point = self.place(corner);
        let take = |from: Vec3, meets: Meets, found: &mut Vec<Pair>| {
            let gap = from.length() - self.radius;
            if gap < self.reach && (gap >= -self.touch() || self.came_from_outside(meets)) {
                push(meets, found);
            }
        };
        for edge in other.edges.iter().copied() {
            let it = &features.edges[edge];
            let [a, b] = it.places(positions);
            let at = foot_on_line([a, b], point);
            let from = point - (a + (b - a) * at);
            let mut inward = it.inward(positions).into_iter().flatten();
            if (0.0..=1.0).contains(&at) && inward.all(|along| from.dot(along) <= 0.0) {
                take(from, Meets::Edge { corner, edge }, found);
            }
        }
        for other in other.corners.iter().copied() {
            let from = point - self.place(other);
            let mut neighbours = features.neighbours_of(other);
            if neighbours.all(|row| from.dot(positions[row] - self.place(other)) <= 0.0) {
                take(from, Meets::Corner { corner, other }, found);
            }
        }
    }

    /// Whether two edges cross where both stand out, and the direction that parts them leads out of the one and of the other.
    fn edges_cross(&self, one: usize, other: usize) -> bool {
        let (features, positions) = (self.features, self.at.positions);
        let edges = [one, other].map(|edge| &features.edges[edge]);
        let lines = edges.map(|edge| edge.places(positions));
        let [along, across] = lines.map(|[a, b]| b - a);
        let sine = along.cross(across).length();
        if sine <= PARALLEL * along.length() * across.length() {
            return false;
        }
        let is_between = |at: f64| at > ENDS && at < 1.0 - ENDS;
        if !feet_of_lines(lines[0], lines[1]).is_some_and(|feet| feet.into_iter().all(is_between)) {
            return false;
        }
        let meets = Meets::Edges { one, other };
        let meeting = features.meeting(meets, positions);
        let Some(normal) = meeting.normal.filter(|_| meeting.distance.abs() < self.reach) else {
            return false;
        };
        let leads_out = edges.into_iter().zip([-normal, normal]).all(|(edge, out)| {
            let [Some(left), Some(right)] = edge.inward(positions) else { return false };
            // what leads out of one triangle beside it, and along the other away from it
            let stands_out = edge.outward(positions).dot(left) < -FLAT;
            stands_out && out.dot(left) <= self.tilt && out.dot(right) <= self.tilt
        });
        leads_out && (meeting.distance >= -self.touch() || self.came_from_outside(meets))
    }
}
