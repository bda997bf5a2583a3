//! What bodies may be coloured by, and what arrows may show.

use std::sync::Arc;

use rayon::prelude::*;
use souple_engine::{CellField, LinkShown, World};
use souple_io::picture::{Colour, ColourMap};
use souple_math::Vec3;
use souple_run::Session;
use souple_scene::{BodyInfo, MarksInfo};
use souple_table::{Entry, Table};

use crate::classes::{Classes, KINDS, LAWS, LEVELS};
use crate::session::Shown;

/// A number at each point of a body, of each of its cells or links.
#[derive(Clone, Copy)]
pub struct Field {
    pub unit: &'static str,
    pub source: Source,
    /// The map whose colours its numbers have, where these are how bodies look; `None` of numbers to be read by any map.
    pub look: Option<ColourMap>,
    /// The field that comes along, of what lies over how bodies look.
    pub over: Option<&'static str>,
}

/// Where the number comes from.
#[derive(Clone, Copy)]
pub enum Source {
    /// Of a point, by its number in the mesh.
    Point(fn(&World, &BodyInfo, usize) -> f64),
    /// Of a point, by its number in the mesh, of bodies whose surfaces show what tools leave on them.
    Marks(fn(&World, &MarksInfo, usize) -> f64),
    /// The blood on a point, of bodies whose surfaces bleed.
    Blood,
    /// Of each point of the mesh, of a frame that carries it.
    Influence,
    /// Of the cells about a point, in the mean.
    Cells(fn(&CellField) -> f64),
    /// Of a link.
    Links(fn(&LinkShown) -> f64),
    /// Of a cell the number of its class.
    Classes(Classes),
}

const fn entry(
    name: &'static str,
    unit: &'static str,
    source: Source,
    summary: &'static str,
) -> Entry<Field> {
    Entry {
        name,
        summary,
        source: "",
        parameters: &[],
        build: Field { unit, source, look: None, over: None },
    }
}

/// What bodies look like, by a map whose colours mean something of their own, beneath the blood on them.
const fn look(name: &'static str, map: ColourMap, source: Source, summary: &'static str) -> Entry<Field> {
    let build = Field { unit: "", source, look: Some(map), over: Some(BLOOD) };
    Entry { name, summary, source: "", parameters: &[], build }
}

/// The field of what lies over how bodies look.
const BLOOD: &str = "blood";

/// All fields; adding one is a line.
pub static FIELDS: Table<Field> = Table {
    kind: "field",
    entries: &[
        &entry("displacement", "m", Source::Point(displacement), "how far points are from where they rest"),
        &entry("speed", "m/s", Source::Point(speed), "how fast points move"),
        &Entry {
            source: "von Mises 1913",
            ..entry("von_mises", "Pa", Source::Cells(|field| field.von_mises), "von Mises stress")
        },
        &entry(
            "strain_energy_density",
            "J/m³",
            Source::Cells(|field| field.energy_density),
            "stored energy per volume at rest",
        ),
        &entry(
            "volume_ratio",
            "",
            Source::Cells(|field| field.current_volume / field.volume),
            "volume over volume at rest",
        ),
        &entry("influence", "", Source::Influence, "the weight of one of the frames that carry a body"),
        &entry(
            "link_force",
            "N",
            Source::Links(|link| link.push),
            "of links, positive where they push their ends apart",
        ),
        &look(
            "tissue",
            ColourMap::Tissue,
            Source::Marks(|world, marks, point| marks.look_at(point, world)),
            "how surfaces look: 1 where they are white, 0 as they were, -1 where they are charred",
        ),
        &entry(
            "whitening",
            "",
            Source::Marks(|world, marks, point| marks.mark_at(point, world).unwrap_or_default().whitening),
            "how white surfaces are where they are pressed",
        ),
        &entry(
            "burn",
            "J/m²",
            Source::Marks(|world, marks, point| marks.mark_at(point, world).unwrap_or_default().dose),
            "heat per area that surfaces have taken up",
        ),
        &entry(
            BLOOD,
            "m",
            Source::Blood,
            "how thick blood lies on surfaces that bleed; pages that show how bodies look lay it over them",
        ),
        &entry("element", "", Source::Classes(KINDS), "the kinds of elements"),
        &entry("law", "", Source::Classes(LAWS), "the law of each element, also where it changes"),
        &entry("level", "", Source::Classes(LEVELS), "which of a body's meshes is at work"),
    ],
};

/// What a picture needs of a field, read from the world.
pub enum Read {
    /// Each number that is shown.
    Numbers(Vec<f32>),
    /// Of the cells about points, in the order of [`crate::session::Shown::cells_about`].
    OfCells(Vec<f64>),
}

impl Read {
    /// A number at each point, link or triangle that is shown.
    pub fn colours(self, shown: &Shown, with_inside: bool) -> Vec<f32> {
        match self {
            Self::Numbers(numbers) => numbers,
            Self::OfCells(values) => shown.means(&values, with_inside),
        }
    }
}

/// A vector at each point of a body.
pub type Vectors = fn(&World, &BodyInfo) -> Vec<Vec3>;

/// All that arrows show; adding one is a line. Vectors are those of all points of the mesh.
pub static ARROWS: Table<ArrowKind> = Table {
    kind: "arrow",
    entries: &[
        &arrow("displacement", "m", displacements, "from where points rest to where they are"),
        &arrow("velocity", "m/s", |world, body| rows(world, body).1.to_vec(), "how points move"),
        &arrow("contact_force", "N", contact_forces, "of all that points touch, on them"),
    ],
};

/// What arrows show.
#[derive(Clone, Copy)]
pub struct ArrowKind {
    pub unit: &'static str,
    pub vectors: Vectors,
}

const fn arrow(
    name: &'static str,
    unit: &'static str,
    vectors: Vectors,
    summary: &'static str,
) -> Entry<ArrowKind> {
    Entry { name, summary, source: "", parameters: &[], build: ArrowKind { unit, vectors } }
}

/// Positions and velocities of a body's points.
fn rows<'a>(world: &'a World, body: &BodyInfo) -> (&'a [Vec3], &'a [Vec3]) {
    let rows = world.rows(body.system);
    (&rows.positions[body.rows.clone()], &rows.velocities[body.rows.clone()])
}

fn displacement(world: &World, body: &BodyInfo, point: usize) -> f64 {
    (rows(world, body).0[point] - body.mesh.points[point]).length()
}

fn speed(world: &World, body: &BodyInfo, point: usize) -> f64 {
    rows(world, body).1[point].length()
}

fn displacements(world: &World, body: &BodyInfo) -> Vec<Vec3> {
    rows(world, body).0.iter().zip(&body.mesh.points).map(|(now, rest)| *now - *rest).collect()
}

fn contact_forces(world: &World, body: &BodyInfo) -> Vec<Vec3> {
    let mut sums = vec![Vec3::ZERO; body.rows.len()];
    let mut add = |row: u32, force: Vec3| {
        if body.rows.contains(&(row as usize)) {
            sums[row as usize - body.rows.start] += force;
        }
    };
    world.visit_forces(body.system, &mut |force, at| {
        force.visit_contacts(at, &mut |point| {
            let force = point.normal_force + point.friction;
            add(point.row, force);
            point.against.iter().for_each(|(row, weight)| add(*row, -force * *weight));
        });
    });
    sums
}

impl Field {
    /// The number of the field that comes along.
    pub fn over(&self) -> Option<usize> {
        let name = self.over?;
        FIELDS.entries.iter().position(|entry| entry.name == name)
    }

    /// What there is to a value at each point that is shown of a body, or at each of its `links`, or at each triangle of its surface and
    /// then at each cell if the inside is shown; `None` where it has no such field.
    pub fn read(
        &self,
        session: &Session,
        body: &BodyInfo,
        shown: &Shown,
        with_inside: bool,
        links: &[LinkShown],
    ) -> Option<Read> {
        let world = &session.world;
        let points = shown.points_at(world.time(), with_inside);
        match self.source {
            Source::Point(value) => {
                let value = |point: &u32| value(world, body, *point as usize) as f32;
                Some(Read::Numbers(points.iter().map(value).collect()))
            }
            Source::Marks(value) => {
                let marks = body.marks.as_ref()?;
                let value = |point: &u32| value(world, marks, *point as usize) as f32;
                Some(Read::Numbers(points.iter().map(value).collect()))
            }
            Source::Blood => {
                let marks = body.marks.as_ref().filter(|marks| marks.marks.bleeds())?;
                let value =
                    |point: &u32| marks.mark_at(*point as usize, world).unwrap_or_default().blood as f32;
                Some(Read::Numbers(points.iter().map(value).collect()))
            }
            Source::Influence => {
                let frames = body.frames.as_ref()?;
                let value = |point: &u32| frames.influence(*point as usize) as f32;
                Some(Read::Numbers(points.iter().map(value).collect()))
            }
            Source::Cells(value) => {
                let (solid, at) = world.force_named(body.system, &body.force)?;
                // what is cut carries nothing that those beside it could be mixed with
                let is_whole = |cell: u32| body.is_whole(cell as usize, world.time());
                let of_cell = |cell: &u32| {
                    let value = value(&solid.cell_field_at(*cell as usize, &at)?);
                    Some(if is_whole(*cell) { value } else { f64::NAN })
                };
                let about = shown.cells_about(body, with_inside);
                let values: Option<Vec<f64>> = about.cells.par_iter().map(of_cell).collect();
                Some(Read::OfCells(values?))
            }
            Source::Links(value) if !links.is_empty() => {
                Some(Read::Numbers(links.iter().map(|link| value(link) as f32).collect()))
            }
            Source::Classes(_) if shown.triangles.is_empty() => None,
            Source::Classes(classes) => {
                let of_cells = (classes.of)(session, body)?;
                let outer = body.surface.surface.cells.iter().map(|cell| of_cells[*cell as usize]);
                let inner = if with_inside { &of_cells[..] } else { &[] };
                let numbers = outer.chain(inner.iter().copied()).map(|class| class as f32);
                Some(Read::Numbers(numbers.collect()))
            }
            Source::Links(_) => None,
        }
    }

    /// Whether anything in a world has it, as [`Field::read`] would find.
    pub fn is_in(&self, session: &Session, shown: &[Arc<Shown>]) -> bool {
        let bodies = &session.bodies;
        match self.source {
            Source::Point(_) => !bodies.is_empty(),
            Source::Marks(_) => bodies.iter().any(|body| body.marks.is_some()),
            Source::Blood => {
                bodies.iter().any(|body| body.marks.as_ref().is_some_and(|marks| marks.marks.bleeds()))
            }
            Source::Influence => bodies.iter().any(|body| body.frames.is_some()),
            Source::Cells(_) => {
                let has_cells = |body: &BodyInfo| {
                    let force = session.world.force_named(body.system, &body.force);
                    force.is_some_and(|(solid, at)| solid.cell_field_at(0, &at).is_some())
                };
                bodies.iter().any(has_cells)
            }
            Source::Links(_) => {
                bodies.iter().any(|body| !souple_run::links_of(&session.world, body).is_empty())
            }
            Source::Classes(classes) => bodies.iter().zip(shown).any(|(body, shown)| {
                !shown.triangles.is_empty() && (classes.of)(session, body).is_some_and(|of| !of.is_empty())
            }),
        }
    }

    /// What the values belong to, for pages.
    pub fn of(&self) -> &'static str {
        match self.source {
            Source::Links(_) => "links",
            Source::Classes(_) => "cells",
            Source::Point(_) | Source::Marks(_) | Source::Blood | Source::Influence | Source::Cells(_) => {
                "points"
            }
        }
    }

    /// What it is of, where its name does not say it: of which frame of which body.
    pub fn title(&self, session: &Session) -> Option<String> {
        if !matches!(self.source, Source::Influence) {
            return None;
        }
        let carried =
            session.bodies.iter().filter_map(|body| Some((&body.name, body.frames.as_ref()?.shown)));
        let carried: Vec<(&String, usize)> = carried.collect();
        let (_, first) = carried.first()?;
        if carried.iter().all(|(_, shown)| shown == first) {
            return Some(format!("influence of frame {first}"));
        }
        let of_each: Vec<String> = carried.iter().map(|(name, shown)| format!("{shown} of {name}")).collect();
        Some(format!("influence of frames {}", of_each.join(", ")))
    }

    /// Names and colours of what its numbers stand for; `None` where they are quantities.
    pub fn classes(&self, session: &Session) -> Option<Vec<(String, Colour)>> {
        match self.source {
            Source::Classes(classes) => Some((classes.all)(session)),
            _ => None,
        }
    }
}
