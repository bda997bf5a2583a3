//! Watches elements that change their law to and fro: under either law they go over the bound that leads to the other.
//!
//! An element returns to its first law where all criteria are below a fraction `back` of their thresholds. Where a second law is that
//! much stiffer, an element at rest may exceed a threshold under the first law and fall below the fraction under the second, so that it
//! changes in every period for ever: a body that should be at rest is not. It is told once of each body.

use souple_engine::World;
use souple_models::solids::AdaptiveForce;
use souple_scene::BodyInfo;
use souple_table::{counted, readable};

/// Periods in a row in which an element changes its law before it is told: what comes to rest, or swings, stays longer with either.
const PERIODS: u32 = 10;

/// Bodies that adapt, and for how long their elements have wavered.
#[derive(Clone, Debug)]
pub struct Wavering {
    bodies: Vec<Watched>,
}

#[derive(Clone, Debug)]
struct Watched {
    /// Among the bodies of the world.
    body: usize,
    /// Of every cell, after the last period.
    laws: Vec<f64>,
    /// Periods in a row in which a cell has changed its law.
    changes: Vec<u32>,
    /// How often any has, and periods in a row in which some did and had the law of the period before again at the end.
    switches: f64,
    returns: u32,
}

impl Wavering {
    /// Watches the bodies that adapt.
    pub fn new(world: &World, bodies: &[BodyInfo]) -> Self {
        let watched = bodies.iter().enumerate().filter_map(|(body, info)| {
            let laws = laws_of(world, info)?;
            let switches = switches_of(world, info)?;
            Some(Watched { body, changes: vec![0; laws.len()], laws, switches, returns: 0 })
        });
        Self { bodies: watched.collect() }
    }

    /// Looks at the laws after a period; what there is to say of bodies whose elements waver for the first time.
    pub fn look(&mut self, world: &World, bodies: &[BodyInfo]) -> Vec<String> {
        let mut said = Vec::new();
        self.bodies.retain_mut(|watched| {
            let info = &bodies[watched.body];
            let Some(count) = watched.follow(world, info) else { return false };
            if count > 0 {
                said.push(format!(
                    "elements waver between their laws: at {} s at least {} of body `{}` changed in each of {PERIODS} periods, as under either law \
                     they go over what leads to the other; take a smaller `adapt.back`, or 0 for elements that keep the second law",
                    readable(world.time()),
                    counted(count as u64, "element"),
                    info.name,
                ));
            }
            count == 0
        });
        said
    }
}

impl Watched {
    /// Takes note of the laws of now; how many cells have changed in each of [`PERIODS`] periods.
    fn follow(&mut self, world: &World, body: &BodyInfo) -> Option<usize> {
        let (force, at) = world.force_named(body.system, &body.force)?;
        let (mut wavering, mut is_other) = (0, false);
        for (cell, (law, changes)) in self.laws.iter_mut().zip(&mut self.changes).enumerate() {
            let now = force.adapted_law(cell, &at)?;
            *changes = if now == *law { 0 } else { *changes + 1 };
            is_other |= now != *law;
            *law = now;
            wavering += usize::from(*changes >= PERIODS);
        }
        // what changes in every step of a period of several is as it was at the end
        let switches = switches_of(world, body)?;
        self.returns = if switches > self.switches && !is_other { self.returns + 1 } else { 0 };
        self.switches = switches;
        Some(wavering.max(usize::from(self.returns >= PERIODS)))
    }
}

/// The law of every cell of a body that adapts.
fn laws_of(world: &World, body: &BodyInfo) -> Option<Vec<f64>> {
    let (force, at) = world.force_named(body.system, &body.force)?;
    (0..body.mesh.cell_count()).map(|cell| force.adapted_law(cell, &at)).collect()
}

/// How often cells of a body that adapts have changed their law.
fn switches_of(world: &World, body: &BodyInfo) -> Option<f64> {
    let (force, at) = world.force_named(body.system, &body.force)?;
    Some(force.as_any().downcast_ref::<AdaptiveForce>()?.switches(&at))
}
