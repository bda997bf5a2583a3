//! The world as it stands, for pages: what a frame holds of each body and skin.

use souple_engine::World;
use souple_engine::obstacle::{Form, Obstacle};
use souple_math::{Mat3, Vec3};
use souple_run::Session;
use souple_scene::{BodyInfo, DressInfo, SkinInfo};

use super::Shown;
use super::stage::Stage;
use crate::fields::{ARROWS, FIELDS};
use crate::protocol::{Frame, FrameBody, FrameSkin};

/// What pages want to see: numbers of fields and of kinds of arrows, and whether any looks inside.
pub struct Wanted {
    pub fields: Vec<usize>,
    pub arrows: Vec<usize>,
    pub inside: bool,
}

impl Stage {
    /// The world as it stands, for pages.
    pub fn frame(&mut self, real_time_factor: f64) -> Vec<u8> {
        self.average();
        let number = self.next_frame();
        let wanted = self.wanted();
        let session = self.session();
        let world = &session.world;
        let time = world.time();
        let bodies = session.bodies.iter().zip(self.shown());
        let mut positions: Vec<_> =
            bodies.clone().map(|(body, shown)| positions(world, body, shown, wanted.inside)).collect();
        let bodies = bodies
            .zip(&mut positions)
            .map(|((body, shown), positions)| of_body(session, body, shown, &wanted, positions))
            .collect();
        let is_bounded = |obstacle: &&Obstacle| matches!(obstacle.form, Form::Surface { .. });
        let obstacles = self.obstacles().iter().filter(is_bounded);
        let frame = Frame {
            scene: self.number(),
            number,
            period: world.state().period,
            time,
            real_time_factor,
            stages: self.stage_times(),
            iterations: self.iterations(),
            hands: self.hands().shown(world),
            poses: obstacles.map(|obstacle| pose(obstacle, time)).collect(),
            bodies,
            skins: session
                .skins
                .iter()
                .map(|skin| of_skin(world, skin))
                .chain(session.bodies.iter().filter_map(|body| Some(of_dress(world, body.dress.as_ref()?))))
                .collect(),
            contours: session.bodies.iter().flat_map(|body| pieces_of_contours(world, body)).collect(),
        };
        frame.encode()
    }
}

/// Ends of the straight pieces of a body's contours, each closed line by line.
fn pieces_of_contours(world: &World, body: &BodyInfo) -> Vec<[Vec3; 2]> {
    let positions = &world.rows(body.system).positions;
    let lines = body.contours.iter().flat_map(|contour| contour.places(positions));
    let pieces = |line: Vec<Vec3>| {
        let next = line.iter().cycle().skip(1);
        line.iter().zip(next).map(|(from, to)| [*from, *to]).collect::<Vec<_>>()
    };
    lines.flat_map(pieces).collect()
}

/// Where the points of a body are that are shown.
fn positions<'a>(
    world: &'a World,
    body: &BodyInfo,
    shown: &'a Shown,
    with_inside: bool,
) -> impl ExactSizeIterator<Item = Vec3> + 'a {
    let rows = &world.rows(body.system).positions[body.rows.clone()];
    shown.points[..shown.count(with_inside)].iter().map(move |point| rows[*point as usize])
}

fn of_body<'a>(
    session: &Session,
    body: &BodyInfo,
    shown: &Shown,
    wanted: &Wanted,
    positions: &'a mut impl ExactSizeIterator<Item = Vec3>,
) -> FrameBody<'a> {
    let world = &session.world;
    let links = souple_run::links_of(world, body);
    let field = |field: &usize| {
        let values = FIELDS.entries[*field].build.values(session, body, shown, wanted.inside, &links);
        Some((*field as u32, values?))
    };
    let arrow = |kind: &usize| {
        let vectors = (ARROWS.entries[*kind].build.vectors)(world, body);
        let points = &shown.points[..shown.count(wanted.inside)];
        (*kind as u32, points.iter().map(|point| vectors[*point as usize]).collect())
    };
    let all = &world.rows(body.system).positions;
    let frames = body.frames.iter().flat_map(|frames| &frames.rows);
    FrameBody {
        point_count: positions.len(),
        positions,
        fields: wanted.fields.iter().filter_map(field).collect(),
        arrows: wanted.arrows.iter().map(arrow).collect(),
        link_states: links.iter().map(|link| link.state).collect(),
        frames: frames.map(|row| std::array::from_fn(|k| all[*row as usize + k])).collect(),
    }
}

fn of_skin(world: &World, skin: &SkinInfo) -> FrameSkin {
    let (surface, normals) = skin.surface(world);
    FrameSkin { points: surface.points, normals, triangles: surface.triangles }
}

fn of_dress(world: &World, info: &DressInfo) -> FrameSkin {
    let (points, triangles) = (info.points(world), info.dress.triangles().to_vec());
    FrameSkin { normals: souple_mesh::vertex_normals(&points, &triangles), points, triangles }
}

/// How an obstacle stands at a time: the axes of its shape, and where its origin is.
fn pose(obstacle: &Obstacle, time: f64) -> (Mat3, Vec3) {
    let axis = |axis: Vec3| obstacle.direction(Vec3::ZERO, axis, time);
    (Mat3::from_columns(axis(Vec3::X), axis(Vec3::Y), axis(Vec3::Z)), obstacle.place(Vec3::ZERO, time))
}
