//! Tests of what yields and lands: rods of one limit, a floor, masses of 1 kg that are thrown at it.

use std::any::Any;

use souple_math::{Mat3, Vec3};
use souple_solve::BlockMatrix;

use crate::force::{Configuration, Declaration, Energy, Force, Scratch, TangentWeights};
use crate::state::{Pair, State};
use crate::steppers;
use crate::unilateral::{ImpactLaw, Sides, Unilateral};
use crate::{Kinematics, Mass, Model, System, UnknownKind, World};

use super::{ConstraintSet, Earlier, add_forces, memory_len, yielding_memory_len};

const TIMESTEP: f64 = 1e-3;

struct Rods {
    rods: Vec<[u32; 2]>,
    lengths: Vec<f64>,
    limit: f64,
}

/// Holds the first mass at the origin.
struct Nail;

/// Keeps what is above zero there.
struct Floor {
    count: usize,
    law: ImpactLaw,
}

/// Weighs masses down.
struct Weight(f64);

fn declared(conservative: bool) -> Declaration {
    Declaration {
        conservative,
        velocity_terms: false,
        symmetric_tangent: true,
        internal: false,
        changing_pattern: false,
    }
}

impl ConstraintSet for Rods {
    fn relation_count(&self) -> usize {
        self.rods.len()
    }

    fn rows(&self, relation: usize) -> &[u32] {
        &self.rods[relation]
    }

    fn value(&self, relation: usize, positions: &[Vec3], _time: f64) -> Vec3 {
        let [a, b] = self.rods[relation].map(|row| positions[row as usize]);
        Vec3::X * ((a - b).length() - self.lengths[relation])
    }

    fn add_gradients(&self, relation: usize, positions: &[Vec3], _time: f64, gradients: &mut Vec<Mat3>) {
        let [a, b] = self.rods[relation].map(|row| positions[row as usize]);
        let along = (a - b).try_normalised().unwrap_or(Vec3::ZERO);
        let gradient = Mat3::from_columns(along, Vec3::ZERO, Vec3::ZERO).transpose();
        gradients.extend([gradient, -gradient]);
    }

    fn time_rate(&self, _relation: usize, _positions: &[Vec3], _time: f64) -> Vec3 {
        Vec3::ZERO
    }

    fn magnitude(&self, relation: usize, _positions: &[Vec3], _time: f64) -> Vec3 {
        Vec3::X * self.lengths[relation]
    }

    fn is_told(&self, _relation: usize) -> bool {
        false
    }

    fn wanted(&self, _relation: usize, _earlier: Earlier, _now: Vec3, _start: f64, _timestep: f64) -> Vec3 {
        Vec3::ZERO
    }

    fn yields_at(&self, _relation: usize) -> Option<f64> {
        self.limit.is_finite().then_some(self.limit)
    }

    fn describe(&self, relation: usize) -> String {
        format!("rod {relation}")
    }
}

impl ConstraintSet for Nail {
    fn relation_count(&self) -> usize {
        1
    }

    fn rows(&self, _relation: usize) -> &[u32] {
        &[0]
    }

    fn value(&self, _relation: usize, positions: &[Vec3], _time: f64) -> Vec3 {
        positions[0]
    }

    fn add_gradients(&self, _relation: usize, _positions: &[Vec3], _time: f64, gradients: &mut Vec<Mat3>) {
        gradients.push(Mat3::IDENTITY);
    }

    fn time_rate(&self, _relation: usize, _positions: &[Vec3], _time: f64) -> Vec3 {
        Vec3::ZERO
    }

    fn magnitude(&self, _relation: usize, _positions: &[Vec3], _time: f64) -> Vec3 {
        Vec3::ZERO
    }

    fn is_told(&self, _relation: usize) -> bool {
        false
    }

    fn wanted(&self, _relation: usize, _earlier: Earlier, _now: Vec3, _start: f64, _timestep: f64) -> Vec3 {
        Vec3::ZERO
    }

    fn describe(&self, _relation: usize) -> String {
        "nail".into()
    }
}

impl Unilateral for Floor {
    fn contact_count(&self, _pairs: &[Pair]) -> usize {
        self.count
    }

    fn sides(&self, contact: usize, _pairs: &[Pair], _positions: &[Vec3]) -> Sides {
        Sides::one(contact as u32)
    }

    fn gap(&self, contact: usize, _pairs: &[Pair], positions: &[Vec3], _time: f64) -> f64 {
        positions[contact].z
    }

    fn slope(&self, _contact: usize, _pairs: &[Pair], _positions: &[Vec3], _time: f64) -> Vec3 {
        Vec3::Z
    }

    fn law(&self) -> ImpactLaw {
        self.law
    }

    fn force(&self, contact: usize, memory: &[f64], _pairs: &[Pair]) -> Vec3 {
        Vec3::new(memory[1 + 3 * contact], memory[2 + 3 * contact], memory[3 + 3 * contact])
    }

    fn set_force(&self, contact: usize, memory: &mut [f64], _pairs: &mut [Pair], force: Vec3) {
        memory[1 + 3 * contact..4 + 3 * contact].copy_from_slice(&force.to_array());
    }

    fn describe(&self, contact: usize, _pairs: &[Pair]) -> String {
        format!("mass {contact}")
    }
}

/// What none of the forces of these tests has but one line.
macro_rules! a_force {
    ($kind:ty, $name:literal, $conservative:literal, $($own:item)*) => {
        impl Force for $kind {
            fn name(&self) -> &str {
                $name
            }

            fn declaration(&self) -> Declaration {
                declared($conservative)
            }

            fn tangent_reads_memory(&self) -> bool {
                false
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

            fn visit_cliques(&self, _pairs: &[Pair], _visit: &mut dyn FnMut(&[u32])) {}

            fn add_blocks(
                &self,
                _at: &Configuration,
                _weights: TangentWeights,
                _scratch: &mut Scratch,
                _matrix: &mut BlockMatrix,
            ) {
            }

            fn as_any(&self) -> &dyn Any {
                self
            }

            $($own)*
        }
    };
}

a_force! { Rods, "rods", false,
    fn memory_len(&self) -> usize {
        yielding_memory_len(self.rods.len())
    }

    fn energy(&self, at: &Configuration, _scratch: &mut Scratch) -> Energy {
        Energy { stored: 0.0, dissipated: -at.memory[0] }
    }

    fn add_force(&self, at: &Configuration, _scratch: &mut Scratch, out: &mut [Vec3]) {
        add_forces(self, at, &mut Vec::new(), out);
    }

    fn constraint_set(&self) -> Option<&dyn ConstraintSet> {
        Some(self)
    }
}

a_force! { Nail, "nail", false,
    fn memory_len(&self) -> usize {
        memory_len(1)
    }

    fn energy(&self, at: &Configuration, _scratch: &mut Scratch) -> Energy {
        Energy { stored: 0.0, dissipated: -at.memory[0] }
    }

    fn add_force(&self, at: &Configuration, _scratch: &mut Scratch, out: &mut [Vec3]) {
        add_forces(self, at, &mut Vec::new(), out);
    }

    fn constraint_set(&self) -> Option<&dyn ConstraintSet> {
        Some(self)
    }
}

a_force! { Floor, "floor", false,
    fn memory_len(&self) -> usize {
        1 + 3 * self.count
    }

    fn energy(&self, at: &Configuration, _scratch: &mut Scratch) -> Energy {
        Energy { stored: 0.0, dissipated: -at.memory[0] }
    }

    fn add_force(&self, at: &Configuration, _scratch: &mut Scratch, out: &mut [Vec3]) {
        for contact in 0..self.count {
            out[contact] += Unilateral::force(self, contact, at.memory, at.pairs);
        }
    }

    fn unilateral(&self) -> Option<&dyn Unilateral> {
        Some(self)
    }
}

a_force! { Weight, "weight", true,
    fn energy(&self, at: &Configuration, _scratch: &mut Scratch) -> Energy {
        Energy { stored: at.positions.iter().map(|x| self.0 * x.z).sum(), dissipated: 0.0 }
    }

    fn add_force(&self, _at: &Configuration, _scratch: &mut Scratch, out: &mut [Vec3]) {
        out.iter_mut().for_each(|force| *force -= Vec3::Z * self.0);
    }
}

/// Masses of 1 kg on rods, thrown at a floor.
struct Thrown {
    places: Vec<Vec3>,
    rods: Vec<[u32; 2]>,
    velocity: Vec3,
    limit: f64,
    law: ImpactLaw,
    gravity: f64,
}

/// Numbers that look random, by a seed.
struct Chance(u64);

impl Chance {
    fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1)
    }

    fn between(&mut self, least: f64, most: f64) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        least + (most - least) * ((self.0 >> 11) as f64 / (1_u64 << 53) as f64)
    }

    fn vector(&mut self, most: f64) -> Vec3 {
        Vec3::from_array([0; 3].map(|_| self.between(-most, most)))
    }
}

impl Thrown {
    /// A ladder, or a tower with a triangle for its section, whose bays are braced by both diagonals.
    fn random(seed: u64) -> Self {
        let mut chance = Chance::new(seed);
        let bays = chance.between(1.0, 5.0) as usize;
        let section = if chance.between(0.0, 1.0) < 0.5 { 2 } else { 3 };
        let mut places = Vec::new();
        for level in 0..=bays {
            for corner in 0..section {
                let angle = std::f64::consts::TAU * corner as f64 / section as f64;
                let place = Vec3::new(0.6 * angle.cos(), 0.6 * angle.sin(), level as f64);
                places.push(place + chance.vector(0.1));
            }
        }
        let at = |corner: usize, level: usize| (section * level + corner % section) as u32;
        let mut rods = Vec::new();
        for level in 0..=bays {
            for corner in 0..section {
                if section > 2 || corner == 0 {
                    rods.push([at(corner, level), at(corner + 1, level)]);
                }
                if level < bays {
                    rods.push([at(corner, level), at(corner, level + 1)]);
                    rods.push([at(corner, level), at(corner + 1, level + 1)]);
                    if section > 2 {
                        rods.push([at(corner + 1, level), at(corner, level + 1)]);
                    }
                }
            }
        }
        let turn = souple_math::exponential(chance.vector(1.0) * chance.between(0.0, 2.0));
        let lowest = places.iter().map(|place| (turn * *place).z).fold(f64::INFINITY, f64::min);
        let rise = Vec3::Z * (chance.between(0.001, 0.02) - lowest);
        let places = places.into_iter().map(|place| turn * place + rise).collect();
        let velocity = chance.vector(0.5) - Vec3::Z * chance.between(1.0, 2.0);
        let limit = 10_f64.powf(chance.between(0.0, 2.5));
        let friction = if chance.between(0.0, 1.0) < 0.5 { 0.0 } else { chance.between(0.1, 0.6) };
        let restitution = if chance.between(0.0, 1.0) < 0.7 { 0.0 } else { 0.4 };
        Self { places, rods, velocity, limit, law: ImpactLaw { restitution, friction }, gravity: 9.81 }
    }

    /// Numbers the lowest mass first, and brings it to the origin.
    fn begin_with_lowest(&mut self) {
        let lowest = (0..self.places.len()).min_by(|a, b| self.places[*a].z.total_cmp(&self.places[*b].z));
        let lowest = lowest.unwrap();
        let place = self.places[lowest];
        self.places.iter_mut().for_each(|x| *x -= place);
        self.places.swap(0, lowest);
        let number = |end: u32| match end as usize {
            0 => lowest as u32,
            it if it == lowest => 0,
            _ => end,
        };
        self.rods.iter_mut().for_each(|rod| *rod = rod.map(number));
    }

    /// Lands with one mass after another.
    fn triangle() -> Self {
        Self {
            places: vec![Vec3::Z * 0.01, Vec3::new(1.0, 0.0, 0.013), Vec3::new(0.4, 0.0, 1.01)],
            rods: vec![[0, 1], [1, 2], [0, 2]],
            velocity: -Vec3::Z,
            limit: 1.0,
            law: ImpactLaw { restitution: 0.0, friction: 0.0 },
            gravity: 0.3,
        }
    }

    fn world(&self) -> World {
        self.world_with(Vec::new())
    }

    fn world_with(&self, others: Vec<Box<dyn Force>>) -> World {
        let count = self.places.len();
        let mut kinematics = Kinematics::default();
        kinematics.add_unknowns(UnknownKind::Point, count);
        let mut mass = Mass::new(count);
        mass.diagonal.fill(1.0);
        let length = |[a, b]: &[u32; 2]| (self.places[*a as usize] - self.places[*b as usize]).length();
        let lengths = self.rods.iter().map(length).collect();
        let entry = steppers::TABLE.find("t_simulation").unwrap();
        let mut forces: Vec<Box<dyn Force>> = vec![
            Box::new(Weight(self.gravity)),
            Box::new(Rods { rods: self.rods.clone(), lengths, limit: self.limit }),
            Box::new(Floor { count, law: self.law }),
        ];
        forces.extend(others);
        let system = System {
            name: "main".into(),
            kinematics,
            mass,
            forces,
            constraints: Vec::new(),
            stepper: (entry.build)(&entry.values(souple_table::Values::new()).unwrap()),
            steps_per_period: 1,
        };
        let mut state = system.initial_state(self.places.clone());
        state.v.fill(self.velocity);
        let state = State { systems: vec![state], ..State::default() };
        Model { period: TIMESTEP, systems: vec![system], ..Model::default() }.start(state)
    }
}

/// Trusses of chance run to their end, and none enters the floor by more than rounding and 1e-7 of the 2 mm that it falls in a step.
#[test]
fn random_trusses_land() {
    // those of the last met their limits in turns, in steps without length
    for seed in (1..=48).chain([242]) {
        let truss = Thrown::random(seed);
        let mut world = truss.world();
        for step in 0..70 {
            world.step().unwrap_or_else(|error| panic!("seed {seed}, step {step}: {error}"));
            let lowest = world.state().systems[0].q.iter().map(|x| x.z).fold(f64::INFINITY, f64::min);
            assert!(lowest > -1e-9, "seed {seed}, step {step}: {lowest}");
        }
    }
}

/// A triangle comes to rest as it was moulded, and what it had is the work of its flow and of impacts.
#[test]
fn triangles_land_and_rest() {
    let mut world = Thrown::triangle().world();
    let all = world.energy();
    let all = all.kinetic + all.by_force.iter().map(|(_, energy)| energy.stored).sum::<f64>();
    let mut flow = 0.0;
    for step in 0..1500 {
        world.step().unwrap_or_else(|error| panic!("step {step}: {error}"));
        let given_off = world.energy().by_force[1].1.dissipated;
        assert!(given_off >= flow, "step {step}: {given_off} after {flow}");
        flow = given_off;
    }
    let energy = world.energy();
    assert!(energy.kinetic < 1e-12, "{energy:?}");
    let kept: f64 = energy.by_force.iter().map(|(_, energy)| energy.stored + energy.dissipated).sum();
    // flow is counted as it is and other work by mean velocities, which differ by h Δv/2 times 1 N of three rods and 0.3 N of three weights;
    // each velocity changes by 1 m/s and back at most
    assert!((energy.kinetic + kept - all).abs() < 3.0 * 1.3 * TIMESTEP, "{energy:?} {all}");
    assert!(flow > 0.1, "{energy:?}");
}

/// A weight on two oblique legs stops when these have taken what it brings: `2 Y δ = ½ m v²`. Its feet stick.
#[test]
fn oblique_legs_take_what_a_weight_brings() {
    let height = 0.75_f64.sqrt();
    let thrown = Thrown {
        places: vec![Vec3::Z * height, Vec3::X * 0.5, Vec3::X * -0.5],
        rods: vec![[0, 1], [0, 2]],
        velocity: -Vec3::Z,
        limit: 5.0,
        law: ImpactLaw { restitution: 0.0, friction: 0.8 },
        gravity: 0.0,
    };
    let mut world = thrown.world();
    for step in 0..400 {
        world.step().unwrap_or_else(|error| panic!("step {step}: {error}"));
    }
    let crushed: f64 = 0.5 / (2.0 * 5.0);
    let expected = ((1.0 - crushed).powi(2) - 0.25).sqrt();
    let q = &world.state().systems[0].q;
    // braked before it moves in each step: v h/2
    assert!((q[0].z - expected - 0.5 * TIMESTEP).abs() < 0.2 * TIMESTEP, "{q:?} {expected}");
    assert!((q[1] - Vec3::X * 0.5).length() < 1e-9 && (q[2] + Vec3::X * 0.5).length() < 1e-9, "{q:?}");
}

/// A leg that stands on the floor at the origin is met on its other end by less than its places are known to: it holds.
#[test]
fn touches_of_rounding_are_borne() {
    let mut thrown = Thrown::triangle();
    thrown.places = vec![Vec3::ZERO, Vec3::Z, Vec3::X, Vec3::Y];
    thrown.rods = vec![[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];
    (thrown.velocity, thrown.limit) = (Vec3::Z * -1e-13, 7.0);
    let mut world = thrown.world();
    for step in 0..20 {
        world.step().unwrap_or_else(|error| panic!("step {step}: {error}"));
        for (x, place) in world.state().systems[0].q.iter().zip(&thrown.places) {
            // gaps are found to 1e-11 of a metre
            assert!((*x - *place).length() < 2e-11, "step {step}: {x:?} from {place:?}");
        }
    }
}

/// A mass that is nailed at the origin stays there, to what rounds of the impacts beside it, and not of its own place, which is nothing.
#[test]
fn nails_at_the_origin_hold_beside_impacts() {
    for seed in [13, 17, 28, 39] {
        let mut thrown = Thrown::random(seed);
        thrown.limit = f64::INFINITY;
        thrown.law.restitution = 0.0;
        thrown.begin_with_lowest();
        let mut world = thrown.world_with(vec![Box::new(Nail)]);
        for step in 0..300 {
            world.step().unwrap_or_else(|error| panic!("seed {seed}, step {step}: {error}"));
            // 1e-12 of the longest way in a step: none flies faster than 10 m/s
            let away = world.state().systems[0].q[0].length();
            assert!(away < 1e-12 * 10.0 * TIMESTEP, "seed {seed}, step {step}: {away}");
        }
    }
}
