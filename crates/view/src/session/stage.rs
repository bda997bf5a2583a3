//! A scene on its stage: the session, and what pages need to see it.

use std::collections::BTreeMap;
use std::sync::Arc;

use serde_json::{Value, json};
use souple_engine::obstacle::{Form, Obstacle, Side};
use souple_engine::{Edit, StageTimes};
use souple_io::picture::COLOUR_MAPS;
use souple_math::{Mat3, Vec3};
use souple_run::show::obstacles_of;
use souple_run::{Options, Session};
use souple_scene::spec::picture::PictureView;
use souple_scene::{Adjustable, Scene};
use souple_table::Kind;

use super::hands::{self, Hands};
use crate::fields::{FIELDS, SurfaceCells};
use crate::hub::{Hub, Outgoing, PageId};
use crate::protocol::{self, Frame, FrameBody, Wish, document};

/// A scene that is shown.
pub struct Stage {
    session: Session,
    /// Counts the scenes of this program.
    number: u32,
    description: String,
    view: PictureView,
    obstacles: Vec<Obstacle>,
    cells: Vec<SurfaceCells>,
    hands: Hands,
    /// Numbers of the fields that pages colour by.
    fields: BTreeMap<PageId, usize>,
    frames: u32,
    /// Wall times and iterations at the last frame, and the period of it.
    before: (StageTimes, u64),
    iterations: [u64; 2],
    stages: [f64; 5],
    iterations_per_step: [f64; 2],
    /// Steps between samples.
    sample_every: u64,
    row: Vec<f64>,
}

/// Samples closer than this are not told apart in a plot [s].
const SAMPLE_DISTANCE: f64 = 4e-3;
/// Columns of samples before those of the probes.
const ENERGY_COLUMNS: [&str; 4] = ["time", "kinetic", "stored", "dissipated"];

impl Stage {
    /// # Errors
    /// The session cannot start.
    pub fn new(mut scene: Scene, name: String, number: u32, hub: &Hub) -> Result<Self, String> {
        let (view, description) = (scene.picture, std::mem::take(&mut scene.description));
        let options = Options { scene_name: name, ..Options::default() };
        let mut session = Session::start(scene, &options).map_err(|error| error.to_string())?;
        session.forecast();
        let columns = ENERGY_COLUMNS.len()
            + session.probes.iter().map(|probe| if probe.gives_vector() { 3 } else { 1 }).sum::<usize>();
        let period = session.world.model().period;
        let mut stage = Self {
            number,
            description,
            view,
            obstacles: obstacles_of(session.world.model()),
            cells: session.bodies.iter().map(SurfaceCells::new).collect(),
            hands: Hands::default(),
            fields: BTreeMap::new(),
            frames: 0,
            before: (StageTimes::default(), 0),
            iterations: [0; 2],
            stages: [0.0; 5],
            iterations_per_step: [0.0; 2],
            sample_every: (SAMPLE_DISTANCE / period).ceil().max(1.0) as u64,
            row: Vec::with_capacity(columns),
            session,
        };
        hub.samples().begin(number, columns);
        stage.sample(hub);
        Ok(stage)
    }

    pub fn session(&self) -> &Session {
        &self.session
    }

    pub fn session_mut(&mut self) -> &mut Session {
        &mut self.session
    }

    pub fn number(&self) -> u32 {
        self.number
    }

    pub fn name(&self) -> &str {
        &self.session.scene_name
    }

    /// The scene's name for files: the folder of a `scene.toml`, or the file without its ending.
    pub fn short_name(&self) -> String {
        let path = std::path::Path::new(self.name());
        let is_in_folder = path.file_name().is_some_and(|name| name == "scene.toml");
        let name =
            if is_in_folder { path.parent().and_then(|folder| folder.file_name()) } else { path.file_stem() };
        let name = name.map_or_else(|| "scene".to_owned(), |name| name.to_string_lossy().into_owned());
        name.chars().map(|c| if c.is_ascii_alphanumeric() || "-_".contains(c) { c } else { '_' }).collect()
    }

    /// [s]
    pub fn time(&self) -> f64 {
        self.session.world.time()
    }

    /// The time after the next step [s].
    pub fn next_time(&self) -> f64 {
        (self.session.world.state().period + 1) as f64 * self.session.world.model().period
    }

    pub fn chosen_fields(&self) -> BTreeMap<PageId, usize> {
        self.fields.clone()
    }

    pub fn choose_fields(&mut self, chosen: BTreeMap<PageId, usize>) {
        self.fields = chosen;
    }

    /// Steps a period.
    ///
    /// # Errors
    /// The step is refused: says which and why.
    pub fn step(&mut self, hub: &Hub) -> Result<(), String> {
        if !self.session.step() {
            return Err(self.session.failure.as_ref().map_or_else(String::new, souple_run::Failure::message));
        }
        let report = self.session.world.last_report();
        self.iterations[0] += report.newton_iterations;
        self.iterations[1] += report.linear_iterations;
        if self.session.world.state().period.is_multiple_of(self.sample_every) {
            self.sample(hub);
        }
        Ok(())
    }

    fn sample(&mut self, hub: &Hub) {
        let energy = self.session.world.energy();
        let sum = |part: fn(&souple_engine::Energy) -> f64| {
            energy.by_force.iter().map(|(_, e)| part(e)).sum::<f64>()
        };
        self.row.clear();
        self.row.extend([self.time(), energy.kinetic, sum(|e| e.stored), sum(|e| e.dissipated)]);
        let row = &mut self.row;
        self.session.measure(&mut |_, _, value| row.extend(value.numbers()));
        hub.samples().push(&self.row);
    }

    /// The world as it stands, for pages.
    pub fn frame(&mut self, real_time_factor: f64) -> Vec<u8> {
        self.average();
        self.frames = self.frames.wrapping_add(1);
        let world = &self.session.world;
        let time = world.time();
        let mut wanted: Vec<usize> = self.fields.values().copied().collect();
        wanted.sort_unstable();
        wanted.dedup();
        let values = |body: usize| {
            let info = &self.session.bodies[body];
            let at = |field: &usize| FIELDS.entries[*field].build.at_surface(world, info, &self.cells[body]);
            wanted.iter().filter_map(|field| Some((*field as u32, at(field)?))).collect::<Vec<_>>()
        };
        let mut positions: Vec<_> = self
            .session
            .bodies
            .iter()
            .map(|body| {
                let rows = &world.rows(body.system).positions[body.rows.clone()];
                body.surface.mesh_points.iter().map(move |point| rows[*point as usize])
            })
            .collect();
        let bodies = positions.iter_mut().enumerate().map(|(body, positions)| FrameBody {
            point_count: positions.len(),
            positions,
            fields: values(body),
        });
        let is_bounded = |obstacle: &&Obstacle| matches!(obstacle.form, Form::Surface { .. });
        let frame = Frame {
            scene: self.number,
            number: self.frames,
            period: world.state().period,
            time,
            real_time_factor,
            stages: self.stages,
            iterations: self.iterations_per_step,
            hands: self.hands.shown(world),
            poses: self.obstacles.iter().filter(is_bounded).map(|obstacle| pose(obstacle, time)).collect(),
            bodies: bodies.collect(),
        };
        frame.encode()
    }

    /// Wall times and iterations of a step since the last frame.
    fn average(&mut self) {
        let (now, period) = (self.session.world.stages(), self.session.world.state().period);
        let (before, last) = self.before;
        let steps = period.saturating_sub(last);
        if steps > 0 {
            let parts =
                |times: StageTimes| [times.pairs, times.forces, times.assembly, times.solve, times.advance];
            let (now, before) = (parts(now), parts(before));
            // a changed scene counts from zero again
            let part = |i: usize| 1e3 * (now[i] - before[i]).max(0.0) / steps as f64;
            self.stages = [0, 1, 2, 3, 4].map(part);
            self.iterations_per_step = self.iterations.map(|count| count as f64 / steps as f64);
            self.iterations = [0; 2];
        }
        self.before = (now, period);
    }

    /// All that a page must know before its first frame.
    pub fn describe(&self, tell: &mut dyn FnMut(Outgoing)) {
        tell(document("scene", self.to_json()));
        let of_bodies =
            self.session.bodies.iter().map(|body| (&body.surface.points, &body.surface.triangles));
        let of_obstacles = self.obstacles.iter().filter_map(|obstacle| match &obstacle.form {
            Form::Surface { points, triangles, .. } => Some((points, triangles)),
            Form::Plane { .. } => None,
        });
        for (index, (points, triangles)) in of_bodies.chain(of_obstacles).enumerate() {
            let message = protocol::surface(self.number, index as u16, points, triangles);
            tell(Outgoing::Binary(Arc::from(message)));
        }
        tell(self.adjustables());
        tell(self.pins());
    }

    fn to_json(&self) -> Value {
        let Session { title, bodies, probes, warnings, world, .. } = &self.session;
        let body = |body: &souple_scene::BodyInfo| {
            json!({
                "name": body.name,
                "points": body.mesh.points.len(),
                "cells": body.mesh.cell_count(),
                "surface_points": body.surface.points.len(),
                "surface_triangles": body.surface.triangles.len(),
            })
        };
        let probe = |probe: &souple_scene::ProbeInfo| {
            json!({
                "name": probe.name, "unit": probe.unit, "quantity": probe.quantity,
                "components": if probe.gives_vector() { 3 } else { 1 },
            })
        };
        let field = |field: &&souple_table::Entry<crate::fields::Field>| json!({"name": field.name, "summary": field.summary, "unit": field.build.unit});
        json!({
            "scene": self.number,
            "name": self.name(),
            "title": title,
            "description": self.description,
            "period": world.model().period,
            "up": self.view.up.to_array(),
            "direction": self.view.direction.to_array(),
            "bodies": bodies.iter().map(body).collect::<Vec<_>>(),
            "obstacles": self.obstacles.iter().map(obstacle_to_json).collect::<Vec<_>>(),
            "probes": probes.iter().map(probe).collect::<Vec<_>>(),
            "fields": FIELDS.entries.iter().map(field).collect::<Vec<_>>(),
            "counts": souple_run::counts(world, bodies),
            "warnings": warnings,
        })
    }

    /// What may be set, as it is now, and the command that comes to the same scene.
    pub fn adjustables(&self) -> Outgoing {
        let all: Vec<Value> = self.session.adjustables.iter().map(adjustable_to_json).collect();
        let command = json!({"adjustables": all, "settings": self.session.inputs().settings});
        document("adjustables", command)
    }

    /// Which points of surfaces are held.
    fn pins(&self) -> Outgoing {
        let world = &self.session.world;
        let of_body = |body: &souple_scene::BodyInfo| -> Vec<u32> {
            let system = &world.model().systems[body.system];
            let row = |block: u32| system.kinematics.point_block_row(block).map(|row| row as usize);
            let mut held = vec![false; body.mesh.points.len()];
            for row in system.constraints.iter().filter_map(|constraint| row(constraint.block)) {
                if body.rows.contains(&row) {
                    held[row - body.rows.start] = true;
                }
            }
            let points = body.surface.mesh_points.iter().enumerate();
            points.filter(|(_, point)| held[**point as usize]).map(|(index, _)| index as u32).collect()
        };
        document("pins", json!({"pins": self.session.bodies.iter().map(of_body).collect::<Vec<_>>()}))
    }

    /// What a page does to the world.
    ///
    /// # Errors
    /// It names what is not there, or the world cannot take it.
    pub fn fulfil(&mut self, page: PageId, wish: Wish, hub: &Hub) -> Result<(), String> {
        match &wish {
            Wish::Colour(None) => {
                self.fields.remove(&page);
            }
            Wish::Colour(Some(name)) => {
                let found = FIELDS.entries.iter().position(|entry| entry.name == name);
                let unknown = || FIELDS.find(name).err().map_or_else(String::new, |error| error.to_string());
                self.fields.insert(page, found.ok_or_else(unknown)?);
            }
            Wish::Grab { hand, body, points, strength } => {
                self.check_points(*body, points)?;
                let info = &self.session.bodies[*body];
                let row = |point: &u32| info.rows.start as u32 + info.surface.mesh_points[*point as usize];
                let rows: Vec<u32> = points.iter().map(row).collect();
                let grip = hands::grip(&self.session.world, info, &rows, *strength);
                let edits = self.hands.grab(page, *hand, info.system, grip);
                if let Err(message) = self.edit(edits) {
                    self.hands.release(page, *hand);
                    return Err(message);
                }
            }
            Wish::Move { hand, offset } => {
                // a hand that let go may still be told to move
                self.edit(self.hands.lead(page, *hand, *offset).into_iter().collect())?;
            }
            Wish::Release(hand) => {
                let released = self.hands.release(page, *hand);
                self.edit(released.into_iter().collect())?;
            }
            Wish::Pin { body, points } | Wish::Unpin { body, points } => {
                self.check_points(*body, points)?;
                self.edit(hands::edits_of(&wish, &self.session.world, &self.session.bodies[*body]))?;
                hub.tell_all(&self.pins());
            }
            Wish::Throw { body, .. } => {
                self.check_points(*body, &[])?;
                self.edit(hands::edits_of(&wish, &self.session.world, &self.session.bodies[*body]))?;
            }
            _ => {}
        }
        Ok(())
    }

    fn check_points(&self, body: usize, points: &[u32]) -> Result<(), String> {
        let bodies = &self.session.bodies;
        let count = bodies.len();
        let info = bodies.get(body).ok_or_else(|| format!("there is no body {body}; there are {count}"))?;
        let count = info.surface.mesh_points.len();
        match points.iter().find(|point| **point as usize >= count) {
            Some(point) => Err(format!("`{}` has no surface point {point}; it has {count}", info.name)),
            None => Ok(()),
        }
    }

    fn edit(&mut self, edits: Vec<Edit>) -> Result<(), String> {
        edits.into_iter().try_for_each(|edit| self.session.edit(edit).map_err(|error| error.to_string()))
    }

    /// A page has gone: its hands let go.
    pub fn forget(&mut self, page: PageId) {
        self.fields.remove(&page);
        let edits = self.hands.release_all(page);
        // what a hand held is there to be let go of
        let _ = self.edit(edits);
    }

    /// Goes on with the scene read anew with a setting.
    ///
    /// # Errors
    /// The scene is another world now; this one goes on as it was.
    pub fn change(&mut self, scene: Scene, setting: &str, hub: &Hub) -> Result<(), String> {
        self.session.take_over(scene, setting).map_err(|error| error.to_string())?;
        self.obstacles = obstacles_of(self.session.world.model());
        hub.tell_all(&self.adjustables());
        Ok(())
    }
}

/// How an obstacle stands at a time: the axes of its shape, and where its origin is.
fn pose(obstacle: &Obstacle, time: f64) -> (Mat3, Vec3) {
    let axis = |axis: Vec3| obstacle.direction(Vec3::ZERO, axis, time);
    (Mat3::from_columns(axis(Vec3::X), axis(Vec3::Y), axis(Vec3::Z)), obstacle.place(Vec3::ZERO, time))
}

fn obstacle_to_json(obstacle: &Obstacle) -> Value {
    match &obstacle.form {
        Form::Plane { point, normal } => {
            json!({"form": "plane", "point": point.to_array(), "normal": normal.to_array()})
        }
        Form::Surface { bodies, .. } => json!({"form": "surface", "is_around": *bodies == Side::Inside}),
    }
}

fn adjustable_to_json(adjustable: &Adjustable) -> Value {
    let Adjustable { path, group, name, summary, unit, kind, range, value } = adjustable;
    let (kind, choices) = match kind {
        Kind::Number => ("number", &[][..]),
        Kind::Integer => ("integer", &[][..]),
        Kind::Boolean => ("boolean", &[][..]),
        Kind::Vector => ("vector", &[][..]),
        Kind::Choice(choices) => ("choice", *choices),
        Kind::Text | Kind::Texts | Kind::Numbers => ("text", &[][..]),
    };
    let finite = |number: f64| number.is_finite().then_some(number);
    json!({
        "path": path, "group": group, "name": name, "summary": summary, "unit": unit, "type": kind,
        "choices": choices, "low": finite(range.low), "high": finite(range.high), "value": value,
    })
}

/// Colour maps as 256 colours of six hexadecimal digits, the same as in pictures.
pub fn colour_maps() -> Value {
    let map = |entry: &&souple_table::Entry<souple_io::picture::ColourMap>| {
        let colour = |step: i32| {
            let [red, green, blue] = entry.build.colour(f64::from(step) / 255.0).to_screen();
            format!("{red:02x}{green:02x}{blue:02x}")
        };
        json!({"name": entry.name, "summary": entry.summary, "colours": (0..256).map(colour).collect::<String>()})
    };
    COLOUR_MAPS.entries.iter().map(map).collect()
}
