//! Watches elements that change their law to and fro: under either law they go over the bound that leads to the other.
//!
//! An element returns to its first law where all criteria are below a fraction `back` of their thresholds. Where the laws differ much
//! there, an element may exceed a threshold under the first law and fall below the fraction under the second, so that it changes for
//! ever: a body that should be at rest is not, and one that moves is fed at every change. It is told once of each body, and at the end
//! where changes have made more energy than the body stores.

use souple_engine::{EnergyReport, World};
use souple_scene::BodyInfo;
use souple_table::{counted, four_digits, readable};

/// A change counts [`OF_CHANGE`], a period without one takes 1 off: what is told changes in ten periods in a row, or for long in more than
/// a third of them. What comes to rest, or swings, stays longer with either law.
const TOLD: u32 = 10 * OF_CHANGE;
const OF_CHANGE: u32 = 2;

/// Bodies that adapt, and for how long their elements have wavered.
#[derive(Clone, Debug)]
pub struct Wavering {
    bodies: Vec<Watched>,
    /// Bodies that adapt, those that were told of as well.
    adapting: Vec<usize>,
}

#[derive(Clone, Debug)]
struct Watched {
    /// Among the bodies of the world.
    body: usize,
    /// Of every cell, after the last period.
    laws: Vec<f64>,
    /// Of every cell, how much its law has changed of late.
    changes: Vec<u32>,
    /// How often any has changed, and how much of late some did and had the law of the period before again at the end.
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
        let bodies: Vec<Watched> = watched.collect();
        let adapting = bodies.iter().map(|watched| watched.body).collect();
        Self { bodies, adapting }
    }

    /// Looks at the laws after a period; what there is to say of bodies whose elements waver for the first time.
    pub fn look(&mut self, world: &World, bodies: &[BodyInfo]) -> Vec<String> {
        let mut said = Vec::new();
        self.bodies.retain_mut(|watched| {
            let info = &bodies[watched.body];
            let Some(count) = watched.follow(world, info) else { return false };
            if count > 0 {
                said.push(format!(
                    "elements waver between their laws: at {} s at least {} of body `{}` changed in ten periods in a row, or in more than a third of \
                     them, as under either law they go over what leads to the other; take `adapt.back = 0`, under which elements keep the second law",
                    readable(world.time()),
                    counted(count as u64, "element"),
                    info.name,
                ));
            }
            count == 0
        });
        said
    }

    /// What there is to say of bodies to which changes of law have given more energy than they store. Where nothing has inertia the next
    /// equilibrium is found whatever they gave.
    pub fn given(&self, world: &World, energy: &EnergyReport, bodies: &[BodyInfo]) -> Vec<String> {
        let of = |body: &usize| {
            let info = &bodies[*body];
            if !world.model().systems[info.system].stepper.has_inertia() {
                return None;
            }
            let (_, of_law) = energy.by_force.iter().find(|(name, _)| *name == info.force)?;
            let (force, at) = world.force_named(info.system, &info.force)?;
            let given = -force.law_changes(&at)?.taken;
            (given > of_law.stored).then(|| {
                format!(
                    "changes of law have given body `{}` {} J, more than the {} J that it stores: its elements take a law where this stores \
                     more than the one before; take `adapt.back = 0`, or lower thresholds, at which laws differ less",
                    info.name,
                    four_digits(given),
                    four_digits(of_law.stored),
                )
            })
        };
        self.adapting.iter().filter_map(of).collect()
    }
}

/// How much has changed of late, after a period more.
fn counted_on(changes: u32, has_changed: bool) -> u32 {
    if has_changed { changes + OF_CHANGE } else { changes.saturating_sub(1) }
}

impl Watched {
    /// Takes note of the laws of now; how many cells have changed in each of [`PERIODS`] periods.
    fn follow(&mut self, world: &World, body: &BodyInfo) -> Option<usize> {
        let (force, at) = world.force_named(body.system, &body.force)?;
        let (mut wavering, mut is_other) = (0, false);
        for (cell, (law, changes)) in self.laws.iter_mut().zip(&mut self.changes).enumerate() {
            let now = force.adapted_law(cell, &at)?;
            *changes = counted_on(*changes, now != *law);
            is_other |= now != *law;
            *law = now;
            wavering += usize::from(*changes >= TOLD);
        }
        // what changes in every step of a period of several is as it was at the end
        let switches = switches_of(world, body)?;
        self.returns = counted_on(self.returns, switches > self.switches && !is_other);
        self.switches = switches;
        Some(wavering.max(usize::from(self.returns >= TOLD)))
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
    Some(force.law_changes(&at)?.count)
}
