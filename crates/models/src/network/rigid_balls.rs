//! Balls that do not enter each other: contacts between all masses of a group, or of two, wherever they come near.
//!
//! Their forces, impulses where they collide, are found by the step ([`souple_engine::unilateral`]); masses have no rotation, and friction acts at their centres.
//! What is near is searched at the start of each step in the grid that crowds use: what comes nearer within a step than that is found one step later.

use std::any::Any;
use std::ops::Range;

use souple_engine::{
    Configuration, ContactPoint, Declaration, Energy, Force, ImpactLaw, Pair, Scratch, Sides, TangentWeights,
    Unilateral, make_room,
};
use souple_math::Vec3;
use souple_solve::BlockMatrix;

use super::crowd_grid::Grid;
use super::sided::visit_contacts;

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
}

/// How much farther than balls reach it is looked around, as a share of their diameter, beside how far they come in a step.
const SKIN: f64 = 0.1;

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

    /// How near balls are looked for: no two that come together in a step at twice the speed that they have are farther [m].
    fn reach(&self, velocities: &[Vec3]) -> f64 {
        let rows = |range: &Range<u32>| range.start as usize..range.end as usize;
        let groups = [rows(&self.0.first), rows(&self.0.second)];
        let fastest_sq = groups
            .into_iter()
            .flat_map(|rows| &velocities[rows])
            .fold(0.0_f64, |most, velocity| most.max(velocity.length_sq()));
        self.0.diameter * (1.0 + SKIN) + 4.0 * self.0.timestep * fastest_sq.sqrt()
    }
}

fn ends(pair: &Pair) -> [u32; 2] {
    [pair.a as u32, pair.b as u32]
}

impl Unilateral for RigidBalls {
    fn contact_count(&self, pairs: &[Pair]) -> usize {
        pairs.len()
    }

    fn sides(&self, contact: usize, pairs: &[Pair]) -> Sides {
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

impl Force for RigidBalls {
    fn name(&self) -> &str {
        &self.0.name
    }

    fn declaration(&self) -> Declaration {
        Declaration {
            conservative: false,
            velocity_terms: false,
            symmetric_tangent: true,
            internal: true,
            changing_pattern: true,
        }
    }

    fn memory_len(&self) -> usize {
        1
    }

    fn tangent_reads_memory(&self) -> bool {
        false
    }

    fn new_scratch(&self) -> Scratch {
        Box::new(Grid::default())
    }

    // what collisions and friction take
    fn energy(&self, at: &Configuration, _scratch: &mut Scratch) -> Energy {
        Energy { stored: 0.0, dissipated: -at.memory[0] }
    }

    fn add_force(&self, at: &Configuration, _scratch: &mut Scratch, out: &mut [Vec3]) {
        for (contact, pair) in at.pairs.iter().enumerate() {
            let force = Unilateral::force(self, contact, at.memory, at.pairs);
            let [a, b] = ends(pair);
            out[a as usize] += force;
            out[b as usize] -= force;
        }
    }

    fn add_differential(
        &self,
        _at: &Configuration,
        _weights: TangentWeights,
        _delta: &[Vec3],
        _scratch: &mut Scratch,
        _out: &mut [Vec3],
    ) {
    }

    fn visit_cliques(&self, pairs: &[Pair], visit: &mut dyn FnMut(&[u32])) {
        pairs.iter().for_each(|pair| visit(&ends(pair)));
    }

    fn add_blocks(
        &self,
        _at: &Configuration,
        _weights: TangentWeights,
        _scratch: &mut Scratch,
        _matrix: &mut BlockMatrix,
    ) {
    }

    fn unilateral(&self) -> Option<&dyn Unilateral> {
        Some(self)
    }

    fn find_pairs(&self, at: &Configuration, scratch: &mut Scratch, found: &mut Vec<Pair>) {
        let grid: &mut Grid =
            scratch.downcast_mut().unwrap_or_else(|| unreachable!("made by this force's own new_scratch"));
        let is_one = self.is_one();
        grid.sort(self.0.second.clone(), at.positions, self.reach(at.velocities));
        for row in self.0.first.clone() {
            grid.visit_near(at.positions[row as usize], at.positions, |other| {
                if (!is_one || other > row) && !self.is_held(row, other) {
                    make_room(found, 1);
                    found.push(Pair::new(row as usize, other as usize, [0.0; 8]));
                }
            });
        }
    }

    fn accepts_pair(&self, pair: &Pair) -> bool {
        let within =
            |row: u64, range: &Range<u32>| (u64::from(range.start)..u64::from(range.end)).contains(&row);
        within(pair.a, &self.0.first) && within(pair.b, &self.0.second) && (!self.is_one() || pair.a < pair.b)
    }

    fn visit_contacts(&self, at: &Configuration, visit: &mut dyn FnMut(&ContactPoint)) {
        visit_contacts(self, at, visit);
    }

    fn scratch_bytes(&self, scratch: &Scratch) -> usize {
        scratch.downcast_ref::<Grid>().map_or(0, Grid::bytes)
    }

    fn bytes(&self) -> usize {
        size_of_val(self.0.held.as_slice())
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}
