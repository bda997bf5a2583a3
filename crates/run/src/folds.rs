//! Watches for matter that is turned inside out along a run: what a press folds and its release mends is not seen at the end.

use serde_json::{Map, Value, json};
use souple_engine::World;
use souple_math::{Mat3, Vec3};
use souple_mesh::{Cell, ElementKind, Mesh};
use souple_scene::BodyInfo;
use souple_table::{counted, four_digits};

/// Cells of a body that were inside out where a period ended.
#[derive(Clone, Debug, PartialEq)]
pub struct Fold {
    pub body: String,
    /// The most at once, of how many, and when first that was [s].
    pub most: usize,
    pub of: usize,
    pub time: f64,
    /// The first of these.
    pub first_cell: usize,
    /// When there were any, first and last [s].
    pub from: f64,
    pub until: f64,
    /// Where the run ends.
    pub at_end: usize,
}

/// How closely bodies are looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Look {
    /// By the volumes between the nodes of cells that fill space: at little cost.
    Glance,
    /// All cells, by the points at which they are strained.
    Close,
}

/// What of the bodies of a world has been folded so far.
#[derive(Clone, Debug, Default)]
pub(crate) struct Folds {
    found: Vec<Fold>,
}

impl Folds {
    /// Looks at all bodies after a period.
    pub fn look(&mut self, look: Look, world: &World, bodies: &[BodyInfo]) {
        self.found.iter_mut().for_each(|fold| fold.at_end = 0);
        for body in bodies {
            let out = inside_out(look, world, body);
            let Some(first_cell) = out.first().copied() else { continue };
            let (count, time) = (out.len(), world.time());
            let known = self.found.iter().position(|fold| fold.body == body.name);
            let place = known.unwrap_or_else(|| {
                let (body, of) = (body.name.clone(), body.mesh.cell_count());
                self.found.push(Fold {
                    body,
                    most: 0,
                    of,
                    time,
                    first_cell,
                    from: time,
                    until: time,
                    at_end: 0,
                });
                self.found.len() - 1
            });
            let fold = &mut self.found[place];
            (fold.until, fold.at_end) = (time, count);
            if count > fold.most {
                (fold.most, fold.time, fold.first_cell) = (count, time, first_cell);
            }
        }
    }

    pub fn into_found(self) -> Vec<Fold> {
        self.found
    }
}

impl Fold {
    pub fn message(&self) -> String {
        let Self { body, most, of, time, first_cell, from, until, at_end } = self;
        let cells = counted(*most as u64, "cell");
        let of_body = format!("of {of} of body `{body}`");
        let are = |count: usize| if count == 1 { "is" } else { "are" };
        let were = if *most == 1 { "was" } else { "were" };
        let time = four_digits(*time);
        let what = match at_end {
            0 if from == until => format!(
                "{cells} {of_body} {were} inside out at {time} s, and at no other time: the first cell {first_cell}"
            ),
            0 => format!(
                "{cells} {of_body} {were} inside out at {time} s, the most of a run in which some were from {} s to {} s: the first cell {first_cell}",
                four_digits(*from),
                four_digits(*until)
            ),
            count if count == most => format!(
                "{cells} {of_body} {} inside out at the end, as many as ever, some since {} s: the first cell {first_cell}",
                are(*count),
                four_digits(*from)
            ),
            count => format!(
                "{count} {of_body} {} inside out at the end, and {most} at {time} s, the most of the run: the first cell {first_cell}",
                are(*count)
            ),
        };
        format!(
            "{what}; no matter does that, and what is read off the body there is not to be trusted: take shorter steps, smaller loads, a finer mesh, \
             or a law that resists it"
        )
    }
}

/// The folds of a run, by body.
pub fn to_json(folds: &[Fold]) -> Map<String, Value> {
    let told = |fold: &Fold| {
        let numbers = json!({
            "most": fold.most,
            "cells": fold.of,
            "at_seconds": fold.time,
            "from_seconds": fold.from,
            "until_seconds": fold.until,
            "at_end": fold.at_end,
        });
        (fold.body.clone(), numbers)
    };
    folds.iter().map(told).collect()
}

/// The cells of a body that are inside out now, ascending.
fn inside_out(look: Look, world: &World, body: &BodyInfo) -> Vec<usize> {
    let Some((solid, at)) = world.force_named(body.system, &body.force) else { return Vec::new() };
    let positions = &world.rows(body.system).positions[body.rows.clone()];
    // what is cut is no matter any more
    let is_whole = |cell: &usize| body.is_whole(*cell, world.time());
    let mut out = match look {
        Look::Close if body.frames.is_none() => (0..body.mesh.cell_count()).collect(),
        _ => turned(&body.mesh, positions),
    };
    out.retain(is_whole);
    // matter that frames carry may fold where no strain is taken: of such the cell is looked at that is drawn
    if body.frames.is_none() {
        out.retain(|cell| {
            solid
                .cell_field_at(*cell, &at)
                .is_some_and(|field| field.volume > 0.0 && field.current_volume <= 0.0)
        });
    }
    out
}

/// Cells without a volume of their own where a mesh stands, ascending.
fn turned(mesh: &Mesh, positions: &[Vec3]) -> Vec<usize> {
    let is_linear = mesh.blocks.iter().all(|block| block.kind == ElementKind::Tet4);
    if is_linear {
        let is_turned = |cell: &Cell<'_>| {
            let [a, b, c, d] = [0, 1, 2, 3].map(|node: usize| positions[cell.nodes[node] as usize]);
            Mat3::from_columns(b - a, c - a, d - a).determinant() <= 0.0
        };
        let cells = mesh.cells().enumerate();
        return cells.filter(|(_, cell)| is_turned(cell)).map(|(number, _)| number).collect();
    }
    // only matter that fills space can be inside out
    if mesh.dimension() < 3 {
        return Vec::new();
    }
    let standing = Mesh { points: positions.to_vec(), ..Mesh::clone(mesh) };
    let volumes = standing.cell_volumes().into_iter().enumerate();
    volumes.filter(|(_, volume)| *volume <= 0.0).map(|(number, _)| number).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The words tell the worst, and whether it is still so.
    #[test]
    fn the_worst_is_told() {
        let fold = Fold {
            body: "liver".to_owned(),
            most: 3,
            of: 900,
            time: 0.7,
            first_cell: 12,
            from: 0.6,
            until: 0.8,
            at_end: 0,
        };
        let said = fold.message();
        assert!(said.starts_with("3 cells of 900 of body `liver` were inside out at 0.7 s"), "{said}");
        assert!(said.contains("from 0.6 s to 0.8 s"), "{said}");
        let said = Fold { at_end: 3, ..fold.clone() }.message();
        assert!(said.contains("inside out at the end, as many as ever"), "{said}");
        let said = Fold { at_end: 1, ..fold }.message();
        assert!(
            said.starts_with("1 of 900 of body `liver` is inside out at the end, and 3 at 0.7 s"),
            "{said}"
        );
    }

    /// A tetrahedron whose tip goes through its base.
    #[test]
    fn what_is_turned_is_found() {
        let mut mesh = Mesh { points: vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z], ..Mesh::default() };
        mesh.blocks.push(souple_mesh::CellBlock { kind: ElementKind::Tet4, nodes: vec![0, 1, 2, 3] });
        assert!(turned(&mesh, &mesh.points).is_empty());
        let through = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z * -0.1];
        assert_eq!(turned(&mesh, &through), [0]);
    }
}
