//! The message that shows the world as it stands.

use souple_math::{Mat3, Vec3};

use super::{Kind, header, put_f32, put_u32, put_vector};

/// The world at a moment, as pages see it.
pub struct Frame<'a> {
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
    pub bodies: Vec<FrameBody<'a>>,
}

/// A hand at work.
#[derive(Clone, Copy, Debug)]
pub struct HandShown {
    pub page: u32,
    pub hand: u32,
    /// The middle of what it holds [m].
    pub held: Vec3,
    /// Where it pulls that to [m].
    pub place: Vec3,
    /// [N]
    pub force: Vec3,
}

/// A body in a frame.
pub struct FrameBody<'a> {
    pub positions: &'a mut dyn Iterator<Item = Vec3>,
    /// Number of a field, and its value at each point.
    pub fields: Vec<(u32, Vec<f32>)>,
    pub point_count: usize,
}

impl Frame<'_> {
    pub fn encode(self) -> Vec<u8> {
        let per_point = |body: &FrameBody| 12 + 4 * body.fields.len();
        let points: usize = self.bodies.iter().map(|body| body.point_count * per_point(body)).sum();
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
        for hand in &self.hands {
            put_u32(&mut bytes, hand.page as usize);
            put_u32(&mut bytes, hand.hand as usize);
            for vector in [hand.held, hand.place, hand.force] {
                put_vector(&mut bytes, vector);
            }
        }
        for (turn, origin) in &self.poses {
            turn.columns.iter().chain([origin]).for_each(|column| put_vector(&mut bytes, *column));
        }
        for body in self.bodies {
            put_u32(&mut bytes, body.point_count);
            put_u32(&mut bytes, body.fields.len());
            body.positions.for_each(|position| put_vector(&mut bytes, position));
            for (field, values) in &body.fields {
                put_u32(&mut bytes, *field as usize);
                bytes.extend_from_slice(bytemuck::cast_slice(values));
            }
        }
        bytes
    }
}
