//! The world as it stands, for pages: what a picture needs of each body and skin.

use std::sync::Arc;

use souple_engine::World;
use souple_engine::obstacle::{Form, Obstacle};
use souple_math::{Mat3, Vec3};
use souple_run::Session;
use souple_scene::BodyInfo;

use super::Shown;
use super::sketch::{Sketch, SketchBody, SketchSkin};
use super::stage::Stage;
use crate::fields::{ARROWS, FIELDS};

/// What pages want to see: numbers of fields and of kinds of arrows, and whether any looks inside.
pub struct Wanted {
    pub fields: Vec<usize>,
    pub arrows: Vec<usize>,
    pub inside: bool,
}

impl Stage {
    /// The world as it stands, for a picture.
    pub fn sketch(&mut self, real_time_factor: f64) -> Sketch {
        self.average();
        let number = self.next_frame();
        let wanted = self.wanted();
        let session = self.session();
        let world = &session.world;
        let time = world.time();
        let bodies = session.bodies.iter().zip(self.shown_to_keep());
        let is_bounded = |obstacle: &&Obstacle| matches!(obstacle.form, Form::Surface { .. });
        let obstacles = self.obstacles().iter().filter(is_bounded);
        let field = |index: usize| world.state().fields[index].clone();
        let skins = session.skins.iter().map(|skin| SketchSkin::Skin(skin.clone(), field(skin.field)));
        let dresses = session.bodies.iter().filter_map(|body| body.dress.as_ref());
        let dresses = dresses.map(|dress| SketchSkin::Dress(dress.clone(), field(dress.field), time));
        Sketch {
            scene: self.number(),
            number,
            period: world.state().period,
            time,
            real_time_factor,
            stages: self.stage_times(),
            iterations: self.iterations(),
            hands: self.hands().shown(world),
            poses: obstacles.map(|obstacle| pose(obstacle, time)).collect(),
            bodies: bodies.map(|(body, shown)| of_body(session, body, shown, &wanted)).collect(),
            skins: skins.chain(dresses).collect(),
            contours: session.bodies.iter().flat_map(|body| pieces_of_contours(world, body)).collect(),
        }
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

fn of_body(session: &Session, body: &BodyInfo, shown: &Arc<Shown>, wanted: &Wanted) -> SketchBody {
    let world = &session.world;
    let links = souple_run::links_of(world, body);
    let points = shown.points_at(world.time(), wanted.inside);
    let field = |field: &usize| {
        let read = FIELDS.entries[*field].build.read(session, body, shown, wanted.inside, &links);
        Some((*field as u32, read?))
    };
    let arrow = |kind: &usize| {
        let vectors = (ARROWS.entries[*kind].build.vectors)(world, body);
        (*kind as u32, points.iter().map(|point| vectors[*point as usize]).collect())
    };
    let all = &world.rows(body.system).positions;
    let rows = &all[body.rows.clone()];
    let frames = body.frames.iter().flat_map(|frames| &frames.rows);
    SketchBody {
        shown: Arc::clone(shown),
        with_inside: wanted.inside,
        positions: points.iter().map(|point| rows[*point as usize]).collect(),
        fields: wanted.fields.iter().filter_map(field).collect(),
        arrows: wanted.arrows.iter().map(arrow).collect(),
        link_states: links.iter().map(|link| link.state).collect(),
        frames: frames.map(|row| std::array::from_fn(|k| all[*row as usize + k])).collect(),
    }
}

/// How an obstacle stands at a time: the axes of its shape, and where its origin is.
fn pose(obstacle: &Obstacle, time: f64) -> (Mat3, Vec3) {
    let axis = |axis: Vec3| obstacle.direction(Vec3::ZERO, axis, time);
    (Mat3::from_columns(axis(Vec3::X), axis(Vec3::Y), axis(Vec3::Z)), obstacle.place(Vec3::ZERO, time))
}
