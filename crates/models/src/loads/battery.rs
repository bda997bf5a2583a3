//! What every load and contact must satisfy, for tests: force against energy, differential against force,
//! blocks against differential, heat never negative, no velocity terms, net force or torque where none is declared.

use std::sync::Arc;

use souple_engine::{
    Configuration, Detection, Force, Kinematics, Mass, Model, Pair, State, Stepper, System, TangentWeights,
    UnknownKind, World,
};
use souple_math::Vec3;
use souple_solve::{BlockMatrix, PatternBuilder};

/// Rows, velocities, memory and pairs that a force is asked about.
#[derive(Clone)]
pub(crate) struct Setting {
    pub positions: Vec<Vec3>,
    pub velocities: Vec<Vec3>,
    pub memory: Vec<f64>,
    pub pairs: Vec<Pair>,
    pub time: f64,
}

impl Setting {
    /// Fresh memory, no pairs.
    pub fn new(force: &dyn Force, positions: Vec<Vec3>, velocities: Vec<Vec3>) -> Self {
        let mut memory = vec![0.0; force.memory_len()];
        force.initial_memory(&mut memory);
        Self { positions, velocities, memory, pairs: Vec::new(), time: 0.3 }
    }

    pub fn at(&self) -> Configuration<'_> {
        Configuration {
            positions: &self.positions,
            velocities: &self.velocities,
            time: self.time,
            load: 0.75,
            memory: &self.memory,
            pairs: &self.pairs,
            kept: souple_engine::KeptRef::default(),
            driven: &[],
            fields: &[],
        }
    }

    pub fn force(&self, force: &dyn Force) -> Vec<Vec3> {
        let mut out = vec![Vec3::ZERO; self.positions.len()];
        force.add_force(&self.at(), &mut force.new_scratch(), &mut out);
        out
    }

    pub fn stored(&self, force: &dyn Force) -> f64 {
        force.energy(&self.at(), &mut force.new_scratch()).stored
    }

    /// Finds pairs as the stage of a step does.
    pub fn find_pairs(&mut self, force: &dyn Force) {
        let mut found = Vec::new();
        force.find_pairs(&self.at(), &mut force.new_scratch(), &mut found);
        souple_engine::state::merge_pairs(&mut self.pairs, &mut found);
    }

    pub fn advance(&mut self, force: &dyn Force, timestep: f64) {
        let before = self.clone();
        force.advance_memory(&before.at(), timestep, &mut self.memory, &mut self.pairs);
    }

    fn moved(&self, delta: &[Vec3], step: f64, weights: TangentWeights) -> Self {
        let mut moved = self.clone();
        for (row, delta) in delta.iter().enumerate() {
            moved.positions[row] += *delta * (step * weights.position);
            moved.velocities[row] += *delta * (step * weights.velocity);
        }
        moved
    }
}

/// A direction over all rows, always the same.
pub(crate) fn direction(rows: usize, seed: f64) -> Vec<Vec3> {
    let number = |i: f64| (12.9898 * (i + seed)).sin();
    (0..rows).map(|row| Vec3::from_array([0.0, 0.4, 0.7].map(|axis| number(row as f64 + axis)))).collect()
}

pub(crate) fn dot(a: &[Vec3], b: &[Vec3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.dot(*b)).sum()
}

fn norm(a: &[Vec3]) -> f64 {
    dot(a, a).sqrt()
}

/// Step of central differences: truncation of order step², rounding of order 1e-16/step.
const STEP: f64 = 1e-6;

/// Asserts all that a force's declaration promises, in `setting`; differences cancel to `1e-16/STEP` of the
/// energy's and force's size, and bend by `STEP²` times third derivatives of order 1/size².
pub(crate) fn assert_force(force: &dyn Force, setting: &Setting) {
    let rows = setting.positions.len();
    let declaration = force.declaration();
    let value = setting.force(force);
    let along = direction(rows, 0.1);
    let position = TangentWeights { position: 1.0, velocity: 0.0 };
    if declaration.conservative {
        let [plus, minus] = [STEP, -STEP].map(|step| setting.moved(&along, step, position).stored(force));
        let slope = (plus - minus) / (2.0 * STEP);
        let scale = norm(&value) * norm(&along) + plus.abs();
        let error = (slope + dot(&value, &along)).abs();
        assert!(
            error <= 1e-8 * scale,
            "{}: force is not -dE/dx: {slope} {}",
            force.name(),
            dot(&value, &along)
        );
    }
    let mut builder = PatternBuilder::new(rows);
    force.visit_cliques(&setting.pairs, &mut |rows| builder.add_clique(rows).unwrap());
    let pattern = Arc::new(builder.build().unwrap());
    for (position, velocity) in [(1.0, 0.0), (0.0, 1.0), (0.7, -0.4)] {
        let weights = TangentWeights { position, velocity };
        let mut exact = vec![Vec3::ZERO; rows];
        force.add_differential(&setting.at(), weights, &along, &mut force.new_scratch(), &mut exact);
        let [plus, minus] = [STEP, -STEP].map(|step| setting.moved(&along, step, weights).force(force));
        let numeric: Vec<Vec3> = plus.iter().zip(&minus).map(|(p, m)| (*p - *m) * (0.5 / STEP)).collect();
        let difference: Vec<Vec3> = numeric.iter().zip(&exact).map(|(n, e)| *n - *e).collect();
        let tolerance = 1e-6 * norm(&exact) + 1e-8 * norm(&value);
        assert!(norm(&difference) <= tolerance, "{} at {weights:?}: {numeric:?} {exact:?}", force.name());
        let mut matrix = BlockMatrix::zeros(pattern.clone());
        force.add_blocks(&setting.at(), weights, &mut force.new_scratch(), &mut matrix);
        let product = multiply(&matrix, &along);
        let apart: Vec<Vec3> = product.iter().zip(&exact).map(|(p, e)| *p - *e).collect();
        assert!(norm(&apart) <= 1e-12 * norm(&exact), "{}: blocks {product:?} {exact:?}", force.name());
        if declaration.symmetric_tangent {
            let other = direction(rows, 0.9);
            let asymmetry = dot(&other, &product) - dot(&along, &multiply(&matrix, &other));
            assert!(
                asymmetry.abs() <= 1e-12 * norm(&product) * norm(&other),
                "{}: not symmetric",
                force.name()
            );
        }
    }
    assert_dissipation(force, setting);
    if declaration.internal {
        let (mut net, mut torque) = (Vec3::ZERO, Vec3::ZERO);
        for (f, x) in value.iter().zip(&setting.positions) {
            net += *f;
            torque += x.cross(*f);
        }
        let size = setting.positions.iter().map(|x| x.length()).fold(0.0, f64::max);
        assert!(net.length() <= 1e-14 * norm(&value) * rows as f64, "{}: net force {net:?}", force.name());
        assert!(
            torque.length() <= 1e-13 * norm(&value) * size * rows as f64,
            "{}: torque {torque:?}",
            force.name()
        );
    }
}

/// Heat of a step is never negative, none where the force is conservative; and it is not the velocity that makes a force
/// without velocity terms.
fn assert_dissipation(force: &dyn Force, setting: &Setting) {
    let heat = |setting: &Setting| force.energy(&setting.at(), &mut force.new_scratch()).dissipated;
    let mut after = setting.clone();
    after.advance(force, 0.01);
    let (gained, size) = (heat(&after) - heat(setting), setting.stored(force).abs() + heat(setting).abs());
    // sums of terms of the size of the energies
    assert!(gained >= -1e-13 * size, "{}: {gained} J of heat", force.name());
    if force.declaration().conservative {
        assert!(gained <= 1e-13 * size, "{}: {gained} J of heat of a conservative force", force.name());
    }
    if !force.declaration().velocity_terms {
        let still = Setting { velocities: vec![Vec3::ZERO; setting.positions.len()], ..setting.clone() };
        assert_eq!(setting.force(force), still.force(force), "{}: velocity terms", force.name());
    }
}

pub(crate) fn multiply(matrix: &BlockMatrix, x: &[Vec3]) -> Vec<Vec3> {
    let pattern = matrix.pattern();
    let row = |a: usize| {
        pattern.slots(a).map(|slot| matrix.values()[slot] * x[pattern.columns()[slot] as usize]).sum()
    };
    (0..x.len()).map(row).collect()
}

/// A world of free points under forces.
pub(crate) fn world(
    positions: &[Vec3],
    velocities: &[Vec3],
    masses: &[f64],
    forces: Vec<Box<dyn Force>>,
    stepper: Box<dyn Stepper>,
    period: f64,
) -> World {
    world_of(Detection::EveryStep, positions, velocities, masses, forces, stepper, period)
}

/// The same with collisions detected so.
pub(crate) fn world_of(
    detection: Detection,
    positions: &[Vec3],
    velocities: &[Vec3],
    masses: &[f64],
    forces: Vec<Box<dyn Force>>,
    stepper: Box<dyn Stepper>,
    period: f64,
) -> World {
    let mut kinematics = Kinematics::default();
    kinematics.add_unknowns(UnknownKind::Point, positions.len());
    let mut mass = Mass::new(positions.len());
    mass.diagonal.copy_from_slice(masses);
    let system = System {
        name: "main".into(),
        kinematics,
        mass,
        forces,
        constraints: vec![],
        stepper,
        steps_per_period: 1,
    };
    let mut start = system.initial_state(positions.to_vec());
    start.v.copy_from_slice(velocities);
    let state = State { systems: vec![start], ..State::default() };
    Model { period, detection, systems: vec![system], ..Model::default() }.start(state)
}

pub(crate) fn stepper(name: &str) -> Box<dyn Stepper> {
    let entry = souple_engine::steppers::TABLE.find(name).unwrap();
    (entry.build)(&entry.values(souple_table::Values::new()).unwrap())
}

/// A stepper that solves `newton = "full"` or `"one"`.
pub(crate) fn stepper_of(name: &str, newton: &str) -> Box<dyn Stepper> {
    let entry = souple_engine::steppers::TABLE.find(name).unwrap();
    let given = souple_table::Values::new().with("newton", souple_table::Value::Text(newton));
    (entry.build)(&entry.values(given).unwrap())
}
