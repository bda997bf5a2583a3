//! Hands on the world: how firmly they hold, and what they do becomes edits.

use souple_engine::hand::hand_name;
use souple_engine::steppers::Stability;
use souple_engine::{Edit, Grip, Hand, World};
use souple_math::Vec3;
use souple_scene::BodyInfo;

use crate::hub::PageId;
use crate::protocol::{HandShown, Wish};

/// A hand that holds something.
#[derive(Clone, Copy, Debug)]
pub struct Holding {
    pub page: PageId,
    pub hand: u32,
    pub system: usize,
    /// Number in the world.
    pub number: u32,
    /// Where it took hold [m].
    start: Vec3,
}

/// The frequency at which a whole body would swing on a hand of strength 1 [rad/s]: it follows within a quarter of a
/// second, and hangs by a hand's breadth under its own weight.
const FREQUENCY: f64 = 14.0;
/// Time over which a hand's damping takes the speed of what it holds [s].
const DAMPING_TIME: f64 = 0.02;
/// Share of the stable step's stiffness that a hand may take in an explicit system.
const EXPLICIT_SHARE: f64 = 0.1;

/// The grip of a hand on rows of a body.
pub fn grip(world: &World, body: &BodyInfo, rows: &[u32], strength: f64) -> Grip {
    let system = &world.model().systems[body.system];
    let masses = &system.mass.diagonal;
    // points that frames carry have no mass of their own
    let body_mass: f64 = match &body.frames {
        Some(frames) => frames.rows.iter().map(|row| masses[*row as usize]).sum(),
        None => masses[body.rows.clone()].iter().sum(),
    };
    let mut stiffness = strength * body_mass * FREQUENCY * FREQUENCY;
    let mut damping = stiffness * DAMPING_TIME;
    if !matches!(system.stepper.stability(), Stability::Unconditional) {
        let timestep = world.model().timestep(body.system);
        let carriers = body.frames.as_ref().map_or(rows, |frames| &frames.rows);
        let lightest = carriers.iter().map(|row| masses[*row as usize]).fold(f64::INFINITY, f64::min);
        // k/n < 0.1 m/h², c/n < 0.1 m/h: well within what the step bears
        let bearable = EXPLICIT_SHARE * lightest * rows.len() as f64 / timestep;
        stiffness = stiffness.min(bearable / timestep);
        damping = damping.min(bearable);
    }
    Grip::on(rows, &world.rows(body.system).positions, stiffness, damping)
}

/// What hands hold.
#[derive(Debug, Default)]
pub struct Hands {
    held: Vec<Holding>,
}

impl Hands {
    /// The edit by which a hand takes hold.
    pub fn grab(&mut self, page: PageId, hand: u32, system: usize, grip: Grip) -> Vec<Edit> {
        let mut edits: Vec<Edit> = self.release(page, hand).into_iter().collect();
        // the first number that no hand has
        let number =
            (0..).find(|number| self.held.iter().all(|held| held.number != *number)).unwrap_or(u32::MAX);
        self.held.push(Holding { page, hand, system, number, start: grip.place });
        edits.push(Edit::Grab { system, hand: number, grip });
        edits
    }

    pub fn lead(&self, page: PageId, hand: u32, offset: Vec3) -> Option<Edit> {
        let held = self.held.iter().find(|held| (held.page, held.hand) == (page, hand))?;
        Some(Edit::MoveHand { system: held.system, hand: held.number, place: held.start + offset })
    }

    pub fn release(&mut self, page: PageId, hand: u32) -> Option<Edit> {
        let at = self.held.iter().position(|held| (held.page, held.hand) == (page, hand))?;
        let Holding { system, number, .. } = self.held.remove(at);
        Some(Edit::Release { system, hand: number })
    }

    /// The edits by which a page that left lets go.
    pub fn release_all(&mut self, page: PageId) -> Vec<Edit> {
        let hands: Vec<u32> =
            self.held.iter().filter(|held| held.page == page).map(|held| held.hand).collect();
        hands.into_iter().filter_map(|hand| self.release(page, hand)).collect()
    }

    /// What there is to see of them.
    pub fn shown(&self, world: &World) -> Vec<HandShown> {
        let shown = |held: &Holding| {
            let name = hand_name(held.number);
            let forces = &world.model().systems[held.system].forces;
            let force = forces.iter().rev().find(|force| force.name() == name)?;
            let hand: &Hand = force.as_any().downcast_ref()?;
            let rows = world.rows(held.system);
            Some(HandShown {
                page: held.page,
                hand: held.hand,
                held: hand.middle(&rows.positions),
                place: hand.grip().place,
                force: hand.pull(&rows.positions, &rows.velocities),
            })
        };
        self.held.iter().filter_map(shown).collect()
    }
}

/// Edits that need no memory of hands.
pub fn edits_of(wish: &Wish, world: &World, body: &BodyInfo) -> Vec<Edit> {
    let system = body.system;
    let blocks = |points: &[u32]| {
        let row = |point: &u32| (body.rows.start as u32) + body.surface.mesh_points[*point as usize];
        let kinematics = &world.model().systems[system].kinematics;
        points.iter().map(row).filter_map(|row| kinematics.point_block(row)).collect::<Vec<u32>>()
    };
    match wish {
        Wish::Pin { points, .. } => {
            blocks(points).into_iter().map(|block| Edit::Pin { system, block }).collect()
        }
        Wish::Unpin { points, .. } => {
            blocks(points).into_iter().map(|block| Edit::Unpin { system, block }).collect()
        }
        Wish::Throw { velocity, .. } => {
            let kinematics = &world.model().systems[system].kinematics;
            let block = |row: usize| kinematics.point_block(row as u32);
            let ends = block(body.rows.start).zip(block(body.rows.end - 1));
            let push = |(first, last)| Edit::Push { system, blocks: first..last + 1, velocity: *velocity };
            ends.map(push).into_iter().collect()
        }
        _ => Vec::new(),
    }
}
