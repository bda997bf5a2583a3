//! What a picture is made of, read from the world between two steps; and the picture, which needs the world no more.

use std::sync::Arc;

use souple_engine::{FieldState, LinkState};
use souple_math::{Mat3, Vec3};
use souple_scene::{DressInfo, SkinInfo};

use super::Shown;
use crate::fields::Read;
use crate::protocol::{Frame, FrameBody, FrameSkin, HandShown};

/// The world at a moment, as far as pictures show it.
pub struct Sketch {
    pub scene: u32,
    pub number: u32,
    pub period: u64,
    /// [s]
    pub time: f64,
    pub real_time_factor: f64,
    /// [ms]
    pub stages: [f64; 5],
    pub iterations: [f64; 2],
    pub hands: Vec<HandShown>,
    pub poses: Vec<(Mat3, Vec3)>,
    pub bodies: Vec<SketchBody>,
    pub skins: Vec<SketchSkin>,
    pub contours: Vec<[Vec3; 2]>,
}

/// A body, by the points that are shown of it.
pub struct SketchBody {
    pub shown: Arc<Shown>,
    pub with_inside: bool,
    pub positions: Vec<Vec3>,
    /// Numbers of fields, and what they are coloured by.
    pub fields: Vec<(u32, Read)>,
    pub arrows: Vec<(u32, Vec<Vec3>)>,
    pub link_states: Vec<LinkState>,
    pub frames: Vec<[Vec3; 4]>,
}

/// A surface that has a state of its own.
pub enum SketchSkin {
    Skin(SkinInfo, FieldState),
    /// At a time [s].
    Dress(DressInfo, FieldState, f64),
}

impl Sketch {
    /// The picture, as pages take it.
    pub fn paint(self) -> Vec<u8> {
        let bodies = self.bodies.into_iter().map(SketchBody::paint).collect();
        let frame = Frame {
            scene: self.scene,
            number: self.number,
            period: self.period,
            time: self.time,
            real_time_factor: self.real_time_factor,
            stages: self.stages,
            iterations: self.iterations,
            hands: self.hands,
            poses: self.poses,
            bodies,
            skins: self.skins.iter().map(SketchSkin::paint).collect(),
            contours: self.contours,
        };
        frame.encode()
    }
}

impl SketchBody {
    fn paint(self) -> FrameBody {
        let Self { shown, with_inside, positions, fields, arrows, link_states, frames } = self;
        let colours = |(field, read): (u32, Read)| (field, read.colours(&shown, with_inside));
        let fields = fields.into_iter().map(colours).collect();
        FrameBody { positions, fields, arrows, link_states, frames }
    }
}

impl SketchSkin {
    fn paint(&self) -> FrameSkin {
        match self {
            Self::Skin(skin, state) => {
                let (surface, normals) = skin.surface_in(state);
                FrameSkin { points: surface.points, normals, triangles: surface.triangles }
            }
            Self::Dress(info, state, time) => {
                let points: Vec<Vec3> = info.dress.points(state).collect();
                let triangles = info.dress.triangles(*time);
                FrameSkin { normals: souple_mesh::vertex_normals(&points, &triangles), points, triangles }
            }
        }
    }
}
