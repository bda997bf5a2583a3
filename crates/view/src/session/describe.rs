//! What pages must know of a scene before its first frame, as documents and as messages of shapes.

use std::sync::Arc;

use serde_json::{Value, json};
use souple_engine::obstacle::{Form, Obstacle, Side};
use souple_io::picture::{COLOUR_MAPS, Colour, ColourMap};
use souple_run::Session;
use souple_scene::{Adjustable, BodyInfo, ProbeInfo, SkinInfo};
use souple_table::{Entry, Kind};

use super::shown::has_inside;
use super::stage::Stage;
use crate::fields::{ARROWS, ArrowKind, FIELDS, Field};
use crate::hub::{Hub, Outgoing, PageId};
use crate::protocol::{self, SurfaceShape, document};
use crate::tools::{Making, TOOLS};

impl Stage {
    /// All that a page must know before its first frame.
    pub fn describe(&self, tell: &mut dyn FnMut(Outgoing)) {
        tell(document("scene", self.to_json()));
        let mut binary = |message: Vec<u8>| tell(Outgoing::Binary(Arc::from(message)));
        let bodies = self.session().bodies.iter().zip(self.shown());
        for (index, (body, shown)) in bodies.clone().enumerate() {
            if !shown.links.is_empty() || !body.radii.is_empty() {
                let radius = |point: &u32| body.radii.get(*point as usize).copied();
                let radii: Vec<f64> = shown.points.iter().filter_map(radius).collect();
                binary(protocol::network(self.number(), index as u16, &shown.links, &radii));
            }
        }
        let rest = |body: &BodyInfo, shown: &super::Shown| {
            let points = shown.points[..shown.outer_count].iter();
            points.map(|point| body.mesh.points[*point as usize]).collect::<Vec<_>>()
        };
        let of_bodies = bodies.map(|(body, shown)| SurfaceShape {
            points: rest(body, shown),
            triangles: &shown.triangles,
            edges: &shown.edges,
            spans: &body.surface.spans,
            edge_spans: &shown.edge_spans,
        });
        let of_obstacles = self.obstacles().iter().filter_map(|obstacle| match &obstacle.form {
            Form::Surface { points, triangles, .. } => {
                Some(SurfaceShape { points: points.clone(), triangles, ..SurfaceShape::default() })
            }
            Form::Plane { .. } => None,
        });
        for (index, shape) in of_bodies.chain(of_obstacles).enumerate() {
            binary(protocol::surface(self.number(), index as u16, &shape));
        }
        for (index, body) in self.session().bodies.iter().enumerate() {
            let texture = body.texture.iter();
            texture.for_each(|texture| binary(protocol::texture(self.number(), index as u16, texture)));
        }
        self.tools().into_iter().for_each(&mut binary);
        tell(self.adjustables());
        tell(self.pins());
        tell(self.influence());
    }

    /// The cells of all bodies that have any inside, to those who look there and have not been told of them.
    pub fn describe_inside(&mut self, hub: &Hub) {
        let pages: Vec<PageId> =
            self.looks().inside().filter(|page| !self.told_inside.contains(page)).collect();
        if pages.is_empty() {
            return;
        }
        for (index, (body, shown)) in self.session().bodies.iter().zip(self.shown()).enumerate() {
            if let Some(inside) = shown.inside(&body.mesh) {
                let super::shown::Inside { tetrahedra, triangles } = &inside;
                let message =
                    protocol::inside(self.number(), index as u16, tetrahedra, triangles, &body.cut_at);
                let message = Outgoing::Binary(Arc::from(message));
                pages.iter().for_each(|page| hub.tell(*page, message.clone()));
            }
        }
        self.told_inside.extend(pages);
    }

    fn to_json(&self) -> Value {
        let Session { title, bodies, skins, probes, warnings, world, .. } = self.session();
        let view = self.view();
        let is_worn =
            |body: &BodyInfo| body.dress.is_some() || skins.iter().any(|skin| skin.name == body.name);
        let body = |(body, shown): (&BodyInfo, &super::Shown)| {
            json!({
                "name": body.name,
                "points": body.mesh.points.len(),
                "cells": body.mesh.cell_count(),
                "surface_points": shown.outer_count,
                "surface_triangles": shown.triangles.len(),
                "links": shown.links.len(),
                "is_network": !shown.links.is_empty() || !body.radii.is_empty(),
                "is_sheet": shown.is_sheet,
                "is_worn": is_worn(body),
                "has_inside": has_inside(&body.mesh),
            })
        };
        let skin = |skin: &SkinInfo| {
            let worn_by = bodies.iter().position(|body| body.name == skin.name);
            json!({"name": skin.name, "worn_by": worn_by})
        };
        let dress = |(index, body): (usize, &BodyInfo)| {
            body.dress.as_ref().map(|_| json!({"name": body.name, "worn_by": index}))
        };
        let skins = skins.iter().map(skin).chain(bodies.iter().enumerate().filter_map(dress));
        let skins: Vec<Value> = skins.collect();
        let probe = |probe: &ProbeInfo| {
            json!({
                "name": probe.name, "unit": probe.unit, "quantity": probe.quantity,
                "components": if probe.gives_vector() { 3 } else { 1 },
            })
        };
        json!({
            "scene": self.number(),
            "name": self.name(),
            "short_name": self.short_name(),
            "is_file": self.is_file(),
            "title": title,
            "description": self.description(),
            "period": world.model().period,
            "up": view.up.to_array(),
            "direction": view.direction.to_array(),
            "bodies": bodies.iter().zip(self.shown()).map(body).collect::<Vec<_>>(),
            "skins": skins,
            "obstacles": self.obstacles().iter().map(obstacle_to_json).collect::<Vec<_>>(),
            "probes": probes.iter().map(probe).collect::<Vec<_>>(),
            "fields": FIELDS.entries.iter().map(|field| self.field_to_json(field)).collect::<Vec<_>>(),
            "arrows": ARROWS.entries.iter().map(arrow_to_json).collect::<Vec<_>>(),
            "counts": souple_run::counts(world, bodies),
            "warnings": warnings.iter().map(|warning| self.origin.told(warning)).collect::<Vec<_>>(),
        })
    }

    fn field_to_json(&self, field: &Entry<Field>) -> Value {
        let Entry { name, summary, build, .. } = field;
        let class = |(name, colour): (String, Colour)| json!({"name": name, "colour": hexadecimal(colour)});
        let classes = build.classes(self.session()).map(|all| all.into_iter().map(class).collect::<Vec<_>>());
        let scale = build.look.and_then(|map| Some((map, map.own_range()?)));
        let scale =
            scale.map(|(map, (low, high))| json!({"colours": colours(map), "low": low, "high": high}));
        json!({
            "name": name, "title": build.title(self.session()), "summary": summary, "unit": build.unit,
            "of": build.of(), "classes": classes, "scale": scale, "over": build.over(),
            "is_here": build.is_in(self.session(), self.shown_to_keep()),
        })
    }

    /// What may be set, as it is now, and the command that comes to the same scene.
    pub fn adjustables(&self) -> Outgoing {
        let all: Vec<Value> = self.session().adjustables.iter().map(adjustable_to_json).collect();
        let command = json!({"adjustables": all, "settings": self.session().inputs().settings});
        document("adjustables", command)
    }

    /// Of each body how many frames carry it and whose weights are shown; null where none do.
    pub fn influence(&self) -> Outgoing {
        let of_body = |body: &BodyInfo| {
            let frames = body.frames.as_ref();
            frames.map(|frames| json!({"frames": frames.count(), "shown": frames.shown}))
        };
        let session = self.session();
        let title = FIELDS.entries.iter().find_map(|field| field.build.title(session));
        let bodies: Vec<Option<Value>> = session.bodies.iter().map(of_body).collect();
        document("influence", json!({"bodies": bodies, "title": title}))
    }

    /// Which of the points shown are held.
    pub fn pins(&self) -> Outgoing {
        let world = &self.session().world;
        let of_body = |(body, shown): (&BodyInfo, &super::Shown)| -> Vec<u32> {
            let system = &world.model().systems[body.system];
            let row = |block: u32| system.kinematics.point_block_row(block);
            let mut held = vec![false; body.mesh.points.len()];
            for row in system.constraints.iter().filter_map(|constraint| row(constraint.block)) {
                if let Some(point) = body.point_of(row) {
                    held[point as usize] = true;
                }
            }
            let points = shown.points[..shown.outer_count].iter().enumerate();
            points.filter(|(_, point)| held[**point as usize]).map(|(index, _)| index as u32).collect()
        };
        let bodies = self.session().bodies.iter().zip(self.shown());
        document("pins", json!({"pins": bodies.map(of_body).collect::<Vec<_>>()}))
    }
}

fn hexadecimal(colour: Colour) -> String {
    let [red, green, blue] = colour.to_screen();
    format!("{red:02x}{green:02x}{blue:02x}")
}

fn arrow_to_json(arrow: &&Entry<ArrowKind>) -> Value {
    json!({"name": arrow.name, "summary": arrow.summary, "unit": arrow.build.unit})
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

/// 256 colours of a map, of six hexadecimal digits each.
fn colours(map: ColourMap) -> String {
    (0..256).map(|step| hexadecimal(map.colour(f64::from(step) / 255.0))).collect()
}

/// Colour maps for quantities, the same as in pictures.
pub fn colour_maps() -> Value {
    let map = |entry: &&souple_table::Entry<ColourMap>| {
        let Entry { name, summary, build, .. } = entry;
        json!({"name": name, "summary": summary, "colours": colours(*build)})
    };
    // what has a range of its own stands for classes or for a look, which fields bring themselves
    COLOUR_MAPS.entries.iter().filter(|entry| entry.build.own_range().is_none()).map(map).collect()
}

/// What a hand may push with.
pub fn tools() -> Value {
    let tool = |tool: &&Entry<Making>| {
        let Making { front, flat, .. } = tool.build;
        json!({"name": tool.name, "summary": tool.summary, "front": front, "flat": flat})
    };
    TOOLS.entries.iter().map(tool).collect()
}
