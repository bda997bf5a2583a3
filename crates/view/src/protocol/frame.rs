//! The message that comes with every picture.

use souple_engine::LinkState;
use souple_math::{Mat3, Vec3};

use super::{Kind, header, put_f32, put_u32, put_vector};

/// The world at a moment, as pages see it.
pub struct Frame {
    pub scene: u32,
    pub number: u32,
    /// World periods since the start.
    pub period: u64,
    /// [s]
    pub time: f64,
    /// Simulated seconds per second.
    pub real_time_factor: f64,
    /// Wall time of a step by stage, over the last steps: pairs, forces, assembly, solve, advance [ms].
    pub stages: [f64; 5],
    /// Iterations of a step, over the last steps: of Newton's method, of the linear solver.
    pub iterations: [f64; 2],
    pub hands: Vec<HandShown>,
    /// Where each bounded obstacle stands: rotation and origin.
    pub poses: Vec<(Mat3, Vec3)>,
    pub bodies: Vec<FrameBody>,
    pub skins: Vec<FrameSkin>,
    /// Ends of the straight pieces of all contours [m].
    pub contours: Vec<[Vec3; 2]>,
}

/// A hand at work.
#[derive(Clone, Copy, Debug)]
pub struct HandShown {
    pub page: u32,
    pub hand: u32,
    pub holds: Holds,
    /// The middle of what it holds [m].
    pub held: Vec3,
    /// Where it pulls that to [m].
    pub place: Vec3,
    /// On the body [N].
    pub force: Vec3,
}

/// What is in a hand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Holds {
    Body = 0,
    Tool = 1,
}

/// A body in a frame.
pub struct FrameBody {
    pub positions: Vec<Vec3>,
    /// Number of a field, and its values at each point or of each link.
    pub fields: Vec<(u32, Vec<f32>)>,
    /// Number of a kind of arrows, and its vector at each point.
    pub arrows: Vec<(u32, Vec<Vec3>)>,
    /// Of each link; empty where none ever changes.
    pub link_states: Vec<LinkState>,
    /// Origin and axes of the frames that carry it.
    pub frames: Vec<[Vec3; 4]>,
}

/// A skin in a frame: its triangles are others in each.
pub struct FrameSkin {
    pub points: Vec<Vec3>,
    pub normals: Vec<Vec3>,
    pub triangles: Vec<[u32; 3]>,
}

/// The byte that stands for the state of a link.
fn state_byte(state: LinkState) -> u8 {
    match state {
        LinkState::Apart => 0,
        LinkState::In(number) => number.saturating_add(1),
    }
}

impl Frame {
    pub fn encode(self) -> Vec<u8> {
        let per_point = |body: &FrameBody| 12 + 4 * body.fields.len() + 12 * body.arrows.len();
        let points: usize = self.bodies.iter().map(|body| body.positions.len() * per_point(body)).sum();
        let mut bytes = header(Kind::Frame, self.bodies.len() as u16, self.scene);
        bytes.reserve(256 + 64 * self.poses.len() + points);
        bytes.extend(self.period.to_le_bytes());
        bytes.extend(self.time.to_le_bytes());
        put_u32(&mut bytes, self.number as usize);
        put_f32(&mut bytes, self.real_time_factor);
        for number in self.stages.into_iter().chain(self.iterations) {
            put_f32(&mut bytes, number);
        }
        put_u32(&mut bytes, self.hands.len());
        put_u32(&mut bytes, self.poses.len());
        put_u32(&mut bytes, self.skins.len());
        for hand in &self.hands {
            for number in [hand.page, hand.hand, hand.holds as u32] {
                put_u32(&mut bytes, number as usize);
            }
            for vector in [hand.held, hand.place, hand.force] {
                put_vector(&mut bytes, vector);
            }
        }
        for (turn, origin) in &self.poses {
            turn.columns.iter().chain([origin]).for_each(|column| put_vector(&mut bytes, *column));
        }
        self.bodies.into_iter().for_each(|body| body.encode(&mut bytes));
        self.skins.iter().for_each(|skin| skin.encode(&mut bytes));
        put_u32(&mut bytes, self.contours.len());
        self.contours.iter().flatten().for_each(|end| put_vector(&mut bytes, *end));
        bytes
    }
}

impl FrameBody {
    fn encode(self, bytes: &mut Vec<u8>) {
        let counts = [
            self.positions.len(),
            self.fields.len(),
            self.arrows.len(),
            self.link_states.len(),
            self.frames.len(),
        ];
        counts.into_iter().for_each(|count| put_u32(bytes, count));
        self.positions.iter().for_each(|position| put_vector(bytes, *position));
        for (field, values) in &self.fields {
            put_u32(bytes, *field as usize);
            put_u32(bytes, values.len());
            bytes.extend_from_slice(bytemuck::cast_slice(values));
        }
        for (kind, vectors) in &self.arrows {
            put_u32(bytes, *kind as usize);
            vectors.iter().for_each(|vector| put_vector(bytes, *vector));
        }
        bytes.extend(self.link_states.iter().map(|state| state_byte(*state)));
        // numbers of four bytes begin at multiples of four
        bytes.resize(bytes.len().next_multiple_of(4), 0);
        self.frames.iter().flatten().for_each(|vector| put_vector(bytes, *vector));
    }
}

impl FrameSkin {
    fn encode(&self, bytes: &mut Vec<u8>) {
        put_u32(bytes, self.points.len());
        put_u32(bytes, self.triangles.len());
        self.points.iter().chain(&self.normals).for_each(|vector| put_vector(bytes, *vector));
        bytes.extend_from_slice(bytemuck::cast_slice(&self.triangles));
    }
}
