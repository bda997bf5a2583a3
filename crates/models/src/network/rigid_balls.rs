//! Balls that do not enter each other: contacts between all masses of a group, or of two, wherever they come near.
//!
//! Their forces, impulses where they collide, are found by the step ([`souple_engine::unilateral`]); masses have no rotation, and friction acts at their centres.
//! What is near is searched at the start of each step in the grid that crowds use: what comes nearer within a step than that is found one step later.
//!
//! Where it is searched beside the steps of a period, for the next one, pairs are listed from farther off, and once two balls may have come nearer
//! than that allows for steps search anew. Velocities at a late search are not in State, so that what steps rely on is a length, not a time.

use std::ops::Range;

use souple_engine::{Configuration, Detection, ImpactLaw, Pair, Scratch, Sides, Unilateral, make_room};
use souple_math::Vec3;

use super::crowd_grid::Grid;
use super::parting::Apart;

/// What rigid balls are made of.
#[derive(Debug)]
pub struct RigidBallsDescription {
    pub name: String,
    /// Rows of the one group, or of the first.
    pub first: Range<u32>,
    /// Rows of the second group, which shares none with the first; the first again where there is one.
    pub second: Range<u32>,
    /// Nearer than which no two come [m].
    pub diameter: f64,
    pub law: ImpactLaw,
    /// Pairs that do not meet, since a rod holds them; ascending, each in ascending order.
    pub held: Vec<[u32; 2]>,
    /// Of the system [s].
    pub timestep: f64,
    /// When it is searched who is near.
    pub detection: Detection,
}

/// How much farther than balls reach it is looked around, as a share of their diameter, beside how far they come in a step.
const SKIN: f64 = 0.1;
/// The same where it is searched beside the steps: what is more than [`SKIN`] is what two balls may come nearer until steps search anew.
const LATE_SKIN: f64 = 0.5;

/// What searches work with.
#[derive(Default)]
struct Search {
    grid: Grid,
    /// How far each ball was taken to come in the step after the search, those of the first group before those of the second [m]; empty
    /// where that is not known any more.
    ways: Vec<f64>,
}

fn search(scratch: &mut Scratch) -> &mut Search {
    scratch.downcast_mut().unwrap_or_else(|| unreachable!("made by this force's own new_scratch"))
}

/// Balls that keep out of each other.
#[derive(Debug)]
pub struct RigidBalls(RigidBallsDescription);

impl RigidBalls {
    pub fn new(description: RigidBallsDescription) -> Self {
        Self(description)
    }

    fn is_one(&self) -> bool {
        self.0.first == self.0.second
    }

    fn is_held(&self, a: u32, b: u32) -> bool {
        self.0.held.binary_search(&[a.min(b), a.max(b)]).is_ok()
    }

    /// Rows of both groups, those of one that meets itself once.
    fn rows(&self) -> impl Iterator<Item = usize> {
        let second = if self.is_one() { 0..0 } else { self.0.second.clone() };
        self.0.first.clone().chain(second).map(|row| row as usize)
    }

    /// How far a ball comes in a step at twice the speed that it has [m].
    fn way(&self, velocity: Vec3) -> f64 {
        2.0 * self.0.timestep * velocity.length()
    }

    /// How near balls are looked for that do not move [m].
    fn reach(&self) -> f64 {
        let skin = match self.0.detection {
            Detection::EveryStep => SKIN,
            Detection::OnePeriodLate => LATE_SKIN,
        };
        self.0.diameter * (1.0 + skin)
    }
}

fn ends(pair: &Pair) -> [u32; 2] {
    [pair.a as u32, pair.b as u32]
}

impl Unilateral for RigidBalls {
    fn contact_count(&self, pairs: &[Pair]) -> usize {
        pairs.len()
    }

    fn sides(&self, contact: usize, pairs: &[Pair], _positions: &[Vec3]) -> Sides {
        Sides::two(ends(&pairs[contact]))
    }

    fn gap(&self, contact: usize, pairs: &[Pair], positions: &[Vec3], _time: f64) -> f64 {
        let [a, b] = ends(&pairs[contact]).map(|end| positions[end as usize]);
        (a - b).length() - self.0.diameter
    }

    fn slope(&self, contact: usize, pairs: &[Pair], positions: &[Vec3], _time: f64) -> Vec3 {
        let [a, b] = ends(&pairs[contact]).map(|end| positions[end as usize]);
        (a - b).try_normalised().unwrap_or(Vec3::ZERO)
    }

    fn law(&self) -> ImpactLaw {
        self.0.law
    }

    fn force(&self, contact: usize, _memory: &[f64], pairs: &[Pair]) -> Vec3 {
        let [x, y, z, ..] = pairs[contact].memory;
        Vec3::new(x, y, z)
    }

    fn set_force(&self, contact: usize, _memory: &mut [f64], pairs: &mut [Pair], force: Vec3) {
        pairs[contact].memory[..3].copy_from_slice(&force.to_array());
    }

    fn describe(&self, contact: usize, pairs: &[Pair]) -> String {
        let [a, b] = ends(&pairs[contact]);
        format!("balls of {} m at rows {a} and {b}", self.0.diameter)
    }
}

impl Apart for RigidBalls {
    fn name(&self) -> &str {
        &self.0.name
    }

    fn is_internal(&self) -> bool {
        // at centres friction leaves a pair a torque
        self.0.law.friction == 0.0
    }

    fn has_pairs(&self) -> bool {
        true
    }

    fn visit_cliques(&self, pairs: &[Pair], visit: &mut dyn FnMut(&[u32])) {
        pairs.iter().for_each(|pair| visit(&ends(pair)));
    }

    fn new_scratch(&self) -> Scratch {
        Box::new(Search::default())
    }

    fn find_pairs(&self, at: &Configuration, scratch: &mut Scratch, found: &mut Vec<Pair>) {
        let Search { grid, ways } = search(scratch);
        let is_one = self.is_one();
        ways.clear();
        ways.extend(self.rows().map(|row| self.way(at.velocities[row])));
        let longest = ways.iter().copied().fold(0.0, f64::max);
        let reach = self.reach();
        grid.sort(self.0.second.clone(), at.positions, reach + 2.0 * longest);
        for row in self.0.first.clone() {
            let [place, velocity] = [at.positions, at.velocities].map(|all| all[row as usize]);
            let own_reach = reach + self.way(velocity);
            grid.visit_near(place, at.positions, |other| {
                // one that flies off makes no contacts of all others
                let within = own_reach + self.way(at.velocities[other as usize]);
                let is_near = (at.positions[other as usize] - place).length_sq() < within * within;
                if is_near && (!is_one || other > row) && !self.is_held(row, other) {
                    make_room(found, 1);
                    found.push(Pair::new(row as usize, other as usize, [0.0; 8]));
                }
            });
        }
    }

    /// Two that were not listed come to touch within a step only if one of them has come half the way that the search allowed for nearer,
    /// or comes by that much more in this step than it would have then; what all move together leaves them where they are.
    fn pairs_are_stale(&self, searched: &[Vec3], at: &Configuration, scratch: &Scratch) -> bool {
        let (Detection::OnePeriodLate, Some(Search { ways, .. })) =
            (self.0.detection, scratch.downcast_ref())
        else {
            return false;
        };
        let moved = |row: usize| at.positions[row] - searched[row];
        let common = self.rows().map(moved).sum::<Vec3>() * (1.0 / self.rows().count().max(1) as f64);
        let limit = 0.5 * (LATE_SKIN - SKIN) * self.0.diameter;
        // written so that what is not finite is left to the check at the end of the step
        self.rows().enumerate().any(|(index, row)| {
            let allowed = ways.get(index).copied().unwrap_or(0.0);
            (moved(row) - common).length() + self.way(at.velocities[row]) - allowed > limit
        })
    }

    fn recall_search(&self, _searched: &Configuration, scratch: &mut Scratch) {
        search(scratch).ways.clear();
    }

    fn accepts_pair(&self, pair: &Pair) -> bool {
        let within =
            |row: u64, range: &Range<u32>| (u64::from(range.start)..u64::from(range.end)).contains(&row);
        within(pair.a, &self.0.first)
            && within(pair.b, &self.0.second)
            && (!self.is_one() || pair.a < pair.b)
            && !self.is_held(pair.a as u32, pair.b as u32)
    }

    fn scratch_bytes(&self, scratch: &Scratch) -> usize {
        scratch.downcast_ref().map_or(0, |Search { grid, ways }| grid.bytes() + 8 * ways.capacity())
    }

    fn bytes(&self) -> usize {
        size_of_val(self.0.held.as_slice())
    }
}
