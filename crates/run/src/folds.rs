//! Watches for matter that is turned inside out along a run: what a press folds and its release mends is not seen at the end.
//!
//! A body is looked at as often as is cheap beside its steps, at dates that no clock and no thread has a say in: after each period where an
//! implicit stepper solves for its points, else after so many periods as evaluate its forces [`EVALUATIONS`] times.

use std::ops::Range;

use serde_json::{Map, Value, json};
use souple_engine::World;
use souple_engine::steppers::Stability;
use souple_mesh::SignedVolume;
use souple_scene::BodyInfo;
use souple_table::four_digits;

/// Evaluations of forces between two glances at a body that nothing is solved for: one takes an eighth of an evaluation of the cheapest law
/// at linear tetrahedra, and a tenth at hexahedra.
const EVALUATIONS: f64 = 16.0;

/// Cells of a body that were inside out when it was looked at.
#[derive(Clone, Debug, PartialEq)]
pub struct Fold {
    pub body: String,
    /// The most at once, of how many, and when first that was [s].
    pub most: usize,
    pub of: usize,
    pub time: f64,
    /// The first of these.
    pub first_cell: usize,
    /// When any were found, first and last [s].
    pub from: f64,
    pub until: f64,
    /// Where the run ends.
    pub at_end: usize,
}

/// How closely bodies are looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Look {
    /// Where it is due, at cells whose volume between their nodes is none.
    Glance,
    /// All cells of all bodies, by the points at which they are strained.
    Close,
}

/// What of the bodies of a world has been folded so far.
#[derive(Clone, Debug)]
pub(crate) struct Folds {
    /// Of each body.
    watches: Vec<Watch>,
    found: Vec<Fold>,
}

/// How a body is looked at.
#[derive(Clone, Debug)]
struct Watch {
    /// Periods from glance to glance.
    every: u64,
    /// Of each block of its mesh; `None` where cells fill no space, and cannot be inside out.
    volumes: Vec<Option<SignedVolume>>,
}

impl Folds {
    pub fn new(world: &World, bodies: &[BodyInfo]) -> Self {
        Self { watches: bodies.iter().map(|body| Watch::new(world, body)).collect(), found: Vec::new() }
    }

    /// Looks at the bodies after a period.
    pub fn look(&mut self, look: Look, world: &World, bodies: &[BodyInfo]) {
        let Self { watches, found } = self;
        let date = world.state().period;
        for (body, watch) in bodies.iter().zip(watches) {
            if look == Look::Glance && !date.is_multiple_of(watch.every) {
                continue;
            }
            let out = watch.inside_out(look, world, body);
            let (time, at_end) = (world.time(), if look == Look::Close { out.count } else { 0 });
            let Some(first_cell) = out.first else { continue };
            let place = found.iter().position(|fold| fold.body == body.name).unwrap_or_else(|| {
                let (body, of) = (body.name.clone(), body.mesh.cell_count());
                let (from, until) = (time, time);
                found.push(Fold { body, most: 0, of, time, first_cell, from, until, at_end });
                found.len() - 1
            });
            let fold = &mut found[place];
            (fold.until, fold.at_end) = (time, at_end);
            if out.count > fold.most {
                (fold.most, fold.time, fold.first_cell) = (out.count, time, first_cell);
            }
        }
    }

    pub fn take_found(&mut self) -> Vec<Fold> {
        std::mem::take(&mut self.found)
    }
}

impl Watch {
    fn new(world: &World, body: &BodyInfo) -> Self {
        let volumes = body.mesh.blocks.iter().map(|block| SignedVolume::of(block.kind));
        Self { every: periods_between(world, body), volumes: volumes.collect() }
    }

    /// The cells of a body that are inside out now.
    fn inside_out(&self, look: Look, world: &World, body: &BodyInfo) -> Turned {
        let Some((solid, at)) = world.force_named(body.system, &body.force) else {
            return Turned::default();
        };
        let (positions, time) = (&world.rows(body.system).positions[body.rows.clone()], world.time());
        // matter that frames carry may fold where no strain is taken: of such the cell is looked at that is drawn
        let is_strained = body.frames.is_none();
        let is_out = |cell: usize| {
            // what is cut is no matter any more
            body.is_whole(cell, time)
                && (!is_strained
                    || solid
                        .cell_field_at(cell, &at)
                        .is_some_and(|field| field.volume > 0.0 && field.current_volume <= 0.0))
        };
        if look == Look::Close && is_strained {
            return Turned::among(0..body.mesh.cell_count(), &is_out);
        }
        let (mut out, mut start) = (Turned::default(), 0);
        for (block, volume) in body.mesh.blocks.iter().zip(&self.volumes) {
            let cells = start..start + block.len();
            if let Some(volume) = volume {
                let size = block.kind.node_count();
                let nodes = |cell: usize| &block.nodes[size * (cell - start)..][..size];
                let here = Turned::among(cells.clone(), &|cell| {
                    volume.at(nodes(cell), positions) <= 0.0 && is_out(cell)
                });
                out = out.and(here);
            }
            start = cells.end;
        }
        out
    }
}

/// Periods from glance to glance at a body.
fn periods_between(world: &World, body: &BodyInfo) -> u64 {
    let model = world.model();
    let stepper = &model.systems[body.system].stepper;
    let has_points = body.frames.is_none() && body.reduced.is_none();
    if has_points && stepper.stability() == Stability::Unconditional {
        return 1;
    }
    let evaluations = model.period / stepper.interval(model.timestep(body.system));
    (EVALUATIONS / evaluations.round()).ceil().max(1.0) as u64
}

/// Cells that are inside out: how many, and the first.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Turned {
    count: usize,
    first: Option<usize>,
}

/// Fewer cells are not shared among threads (some tens of microseconds).
const SHARED: usize = 2048;

impl Turned {
    fn among(cells: Range<usize>, is_out: &(impl Fn(usize) -> bool + Sync)) -> Self {
        if cells.len() >= SHARED && rayon::current_num_threads() > 1 {
            let middle = cells.start + cells.len() / 2;
            let (head, tail) = rayon::join(
                || Self::among(cells.start..middle, is_out),
                || Self::among(middle..cells.end, is_out),
            );
            return head.and(tail);
        }
        let out = cells.filter(|cell| is_out(*cell));
        out.fold(Self::default(), |known, cell| known.and(Self { count: 1, first: Some(cell) }))
    }

    /// With cells that come later.
    fn and(self, later: Self) -> Self {
        Self { count: self.count + later.count, first: self.first.or(later.first) }
    }
}

impl Fold {
    pub fn message(&self) -> String {
        let Self { body, most, of, time, first_cell, from, until, at_end } = self;
        let cells = |count: &usize| format!("{count} of {of} cells of body `{body}`");
        let are = |count: &usize| if *count == 1 { "is" } else { "are" };
        let were = if *most == 1 { "was" } else { "were" };
        let [time, from, until] = [*time, *from, *until].map(four_digits);
        let what = match at_end {
            0 if from == until => {
                format!("{} {were} found inside out at {time} s, and none at the end", cells(most))
            }
            0 => format!(
                "{} {were} found inside out at {time} s, the most of what was found from {from} s to {until} s, and none at the end",
                cells(most)
            ),
            count if count == most => format!(
                "{} {} inside out at the end, the most that were found; any were first found at {from} s",
                cells(count),
                are(count)
            ),
            count => format!(
                "{} {} inside out at the end, and {most} {were} at {time} s, the most that were found",
                cells(count),
                are(count)
            ),
        };
        format!(
            "{what}; the first of the most is cell {first_cell}; no matter does that, and what is read off the body there is not to be trusted: take shorter steps, \
             smaller loads, a finer mesh, or a law that resists it"
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

#[cfg(test)]
mod tests {
    use super::*;

    /// The words tell the worst that was found, and whether it is still so.
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
        let starts = |fold: Fold, words: &str| {
            let said = fold.message();
            assert!(said.starts_with(words) && said.contains("cell 12"), "{said}");
        };
        starts(
            fold.clone(),
            "3 of 900 cells of body `liver` were found inside out at 0.7 s, the most of what was found from 0.6 s to 0.8 s, and none at the end",
        );
        starts(
            Fold { most: 1, from: 0.7, until: 0.7, ..fold.clone() },
            "1 of 900 cells of body `liver` was found inside out at 0.7 s, and none at the end",
        );
        starts(
            Fold { at_end: 3, ..fold.clone() },
            "3 of 900 cells of body `liver` are inside out at the end, the most that were found; any were first found at 0.6 s",
        );
        starts(
            Fold { at_end: 1, ..fold },
            "1 of 900 cells of body `liver` is inside out at the end, and 3 were at 0.7 s, the most that were found",
        );
    }

    /// Threads count and order as one does.
    #[test]
    fn threads_find_the_same_cells() {
        for threads in [1, 3] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let among = |first: usize| Turned::among(first..9 * SHARED, &|cell| cell % 1000 == 999);
            let [all, later] = [0, 5000].map(|first| pool.install(|| among(first)));
            assert_eq!(all, Turned { count: 9 * SHARED / 1000, first: Some(999) });
            assert_eq!(later, Turned { count: 9 * SHARED / 1000 - 5, first: Some(5999) });
            assert_eq!(pool.install(|| Turned::among(0..999, &|cell| cell % 1000 == 999)), Turned::default());
        }
    }
}
