//! Edges at which a surface is folded: their angle, and how it changes with the corners around it.

use std::f64::consts::TAU;

use souple_engine::{Configuration, Motion};
use souple_math::{Mat3, Vec3, exponential, logarithm};

/// An edge at which the surface is folded, from `rows[0]` to `rows[1]`, with the corners opposite to it on both sides: that of the
/// triangle that runs round the edge this way, then the other.
#[derive(Clone, Debug)]
pub(super) struct Fold {
    pub rows: [u32; 4],
    /// Beyond the edge, where the last corner is no point.
    pub held: Option<Held>,
    /// The angle of the rest shape [rad].
    pub flat: f64,
    /// The angle without moments: that of the rest shape, and what natural curvatures add [rad].
    pub rest: f64,
}

/// The plane that a clamped edge keeps its slope to.
#[derive(Clone, Copy, Debug)]
pub(super) struct Held {
    /// Out of the surface and across the edge at rest, as long as the triangle is high there [m].
    pub across: Vec3,
    /// Which of the leaders turns it.
    pub leader: Option<u32>,
}

/// How a leader has turned, and how fast it turns [rad/s].
#[derive(Clone, Copy, Debug)]
pub(super) struct Turned {
    turn: Mat3,
    spin: Vec3,
}

impl Turned {
    /// Of what stays.
    pub const NOT: Self = Self { turn: Mat3::IDENTITY, spin: Vec3::ZERO };

    /// As [`souple_engine::Constraint`] leads frames: of a part of the load, a part of the turn.
    pub fn of(leader: &dyn Motion, time: f64, load: f64) -> Self {
        let turn = leader.turn(time);
        let turn = if load == 1.0 { turn } else { exponential(logarithm(&turn) * load) };
        Self { turn, spin: leader.spin(time) * load }
    }
}

/// An angle and its slopes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Angle {
    /// From -π to π [rad].
    pub value: f64,
    pub gradient: [Vec3; 4],
    /// How fast it changes with what leads its clamp [rad/s].
    pub drift: f64,
}

/// How an angle changes with one of its triangles.
pub(super) struct Flap {
    /// Slope of the angle by the opposite corner: the normal over the height [1/m].
    pub apex: Vec3,
    /// Where the foot of the height is along the edge, from 0 to 1.
    pub foot: f64,
    edge: Vec3,
    side: Vec3,
    /// Twice the area as a vector, and the sign that turns it to the side of the normal.
    area: Vec3,
    sign: f64,
}

impl Flap {
    pub fn new(edge: Vec3, side: Vec3, sign: f64) -> Self {
        let area = edge.cross(side);
        let apex = area * (sign * edge.length() / area.length_sq());
        Self { apex, foot: edge.dot(side) / edge.length_sq(), edge, side, area, sign }
    }

    /// Adds the slopes by the ends of the edge and the opposite corner, which is number `corner`.
    fn add_gradient(&self, corner: usize, gradient: &mut [Vec3; 4]) {
        gradient[corner] += self.apex;
        gradient[1] -= self.apex * self.foot;
        gradient[0] -= self.apex * (1.0 - self.foot);
    }

    /// Adds how those slopes change with the points.
    fn add_hessian(&self, corner: usize, hessian: &mut [[Mat3; 4]; 4]) {
        let (length, size) = (self.edge.length(), self.area.length_sq());
        // δu = s |e|/|N|² (I - 2 N Nᵀ/|N|²) δN + s N/|N|² (e/|e|)·δe,  δN = e × δp - p × δe
        let turning =
            (Mat3::IDENTITY - self.area.outer(self.area) * (2.0 / size)) * (self.sign * length / size);
        let by_side = turning * self.edge.cross_matrix();
        let lengthening = self.area.outer(self.edge) * (self.sign / (size * length));
        let by_edge = lengthening - turning * self.side.cross_matrix();
        // δa = ((p - 2 a e)·δe + e·δp) / |e|²
        let foot_by_edge = (self.side - self.edge * (2.0 * self.foot)) / self.edge.length_sq();
        let foot_by_side = self.edge / self.edge.length_sq();
        let second_by_edge = -(by_edge * self.foot) - self.apex.outer(foot_by_edge);
        let second_by_side = -(by_side * self.foot) - self.apex.outer(foot_by_side);
        let of_ends = [
            (corner, by_edge, by_side),
            (1, second_by_edge, second_by_side),
            (0, -(by_edge + second_by_edge), -(by_side + second_by_side)),
        ];
        for (row, by_edge, by_side) in of_ends {
            hessian[row][1] += by_edge;
            hessian[row][corner] += by_side;
            hessian[row][0] -= by_edge + by_side;
        }
    }
}

impl Fold {
    fn corners(&self, positions: &[Vec3], leader: impl Fn(u32) -> Turned) -> [Vec3; 4] {
        let [a, b, c] = [0, 1, 2].map(|corner| positions[self.rows[corner] as usize]);
        let beyond = match &self.held {
            Some(held) => a + held.stands(leader),
            None => positions[self.rows[3] as usize],
        };
        [a, b, c, beyond]
    }

    fn flaps(&self, positions: &[Vec3], leader: impl Fn(u32) -> Turned) -> [Flap; 2] {
        let [a, b, c, d] = self.corners(positions, leader);
        [Flap::new(b - a, c - a, 1.0), Flap::new(b - a, d - a, -1.0)]
    }

    pub fn angle(&self, positions: &[Vec3], leader: impl Fn(u32) -> Turned) -> Angle {
        let flaps = self.flaps(positions, &leader);
        let [own, other] = &flaps;
        let (normal, beyond) = (own.area, -other.area);
        let sine = beyond.cross(normal).dot(own.edge) / own.edge.length();
        let (gradient, drift) = self.slopes(&flaps, leader);
        Angle { value: libm::atan2(sine, normal.dot(beyond)), gradient, drift }
    }

    /// How fast the angle changes [rad/s].
    pub fn rate(&self, at: &Configuration, leader: impl Fn(u32) -> Turned) -> f64 {
        let (gradient, drift) = self.slopes(&self.flaps(at.positions, &leader), leader);
        let moved = |corner: usize| gradient[corner].dot(at.velocities[self.rows[corner] as usize]);
        (0..self.point_count()).map(moved).sum::<f64>() + drift
    }

    /// The slopes of the angle by the corners, and how fast it changes with what leads its clamp.
    fn slopes(&self, [own, other]: &[Flap; 2], leader: impl Fn(u32) -> Turned) -> ([Vec3; 4], f64) {
        let mut gradient = [Vec3::ZERO; 4];
        own.add_gradient(2, &mut gradient);
        other.add_gradient(3, &mut gradient);
        let Some(held) = &self.held else { return (gradient, 0.0) };
        // slopes by the corner that is no point belong to the point that it goes with
        let moved = std::mem::take(&mut gradient[3]);
        gradient[0] += moved;
        (gradient, moved.dot(held.moves(leader)))
    }

    pub fn hessian(&self, positions: &[Vec3], leader: impl Fn(u32) -> Turned) -> [[Mat3; 4]; 4] {
        let [own, other] = self.flaps(positions, leader);
        let mut hessian = [[Mat3::ZERO; 4]; 4];
        own.add_hessian(2, &mut hessian);
        other.add_hessian(3, &mut hessian);
        if self.held.is_some() {
            for row in &mut hessian {
                let moved = std::mem::replace(&mut row[3], Mat3::ZERO);
                row[0] += moved;
            }
            let moved = std::mem::replace(&mut hessian[3], [Mat3::ZERO; 4]);
            for (entry, moved) in hessian[0].iter_mut().zip(moved) {
                *entry += moved;
            }
        }
        hessian
    }

    /// The angle that is `principal` up to whole turns, within half a turn of where it was.
    pub fn continued(principal: f64, before: f64) -> f64 {
        principal + TAU * ((before - principal) / TAU).round()
    }

    /// How many of its corners are points.
    pub fn point_count(&self) -> usize {
        if self.held.is_some() { 3 } else { 4 }
    }
}

impl Held {
    fn stands(&self, leader: impl Fn(u32) -> Turned) -> Vec3 {
        self.leader.map_or(self.across, |number| leader(number).turn * self.across)
    }

    fn moves(&self, leader: impl Fn(u32) -> Turned) -> Vec3 {
        self.leader.map(&leader).map_or(Vec3::ZERO, |turned| turned.spin.cross(turned.turn * self.across))
    }
}
