//! Particles of an octree: who is at work, what divides, what is kept.
#![allow(non_snake_case)]

use souple_engine::levels::{Census, Division, Levels};
use souple_engine::{Force, Rows};
use souple_formal::Formula;
use souple_math::{Mat3, Vec3};
use souple_models::materials::Lame;
use souple_models::particles::Operators;
use souple_models::particles::octree::{
    Octree, OctreeChoice, OctreeDescription, OctreeForce, OctreeOperators, PLACE_VARIABLES, Variant,
};

/// A block of particles a centimetre apart, a gram each.
fn tree(counts: [usize; 3], levels: usize) -> Octree {
    let mut points = Vec::new();
    for z in 0..counts[2] {
        for y in 0..counts[1] {
            points.extend((0..counts[0]).map(|x| Vec3::new(x as f64, y as f64, z as f64) * 0.01));
        }
    }
    let (masses, volumes) = (vec![1e-3; points.len()], vec![1e-6; points.len()]);
    Octree::new(&points, &masses, &volumes, 0.01, levels).unwrap()
}

fn force(tree: Octree, operators: OctreeOperators, variant: Variant, choice: OctreeChoice) -> OctreeForce {
    OctreeForce::new(OctreeDescription {
        name: "block".to_owned(),
        tree,
        first_row: 0,
        moduli: Lame { mu: 7000.0, lambda: 20000.0 },
        operators,
        variant,
        choice,
        mass_damping: 0.0,
    })
}

fn fixed(formula: &str) -> OctreeChoice {
    OctreeChoice::Fixed(Formula::compile(formula, &PLACE_VARIABLES).unwrap())
}

const DIVISION: Division = Division::new(1e-3, 6);

/// A body with rows and memory.
struct Body {
    force: OctreeForce,
    rows: Rows,
    memory: Vec<f64>,
    scratch: souple_engine::Scratch,
}

impl Body {
    fn new(force: OctreeForce) -> Self {
        let rest = force.tree().rest.clone();
        let velocities = vec![Vec3::ZERO; rest.len()];
        let rows = Rows { positions: rest, velocities, time: 0.0 };
        let (memory, scratch) = (vec![0.0; force.memory_len()], force.new_scratch());
        Self { force, rows, memory, scratch }
    }

    fn adapt(&mut self) -> Census {
        self.force.adapt(&DIVISION, &mut self.rows, &mut self.memory, &mut self.scratch);
        self.force.census(&self.memory, &self.scratch)
    }

    fn active(&self) -> Vec<usize> {
        self.force.active(&self.scratch).iter().map(|row| *row as usize).collect()
    }

    fn momentum(&self) -> Vec3 {
        self.active().iter().map(|at| self.rows.velocities[*at] * self.force.tree().masses[*at]).sum()
    }

    /// Neighbours in space whose levels differ by more than one.
    fn unbalanced(&self) -> usize {
        let (tree, active) = (self.force.tree(), self.active());
        let reach = |at: usize| 0.5 * tree.spacing[usize::from(tree.level_of[at])];
        let mut found = 0;
        for a in &active {
            for b in active.iter().filter(|b| *b > a) {
                let touching = (tree.rest[*a] - tree.rest[*b])
                    .to_array()
                    .iter()
                    .all(|apart| apart.abs() <= 1.01 * (reach(*a) + reach(*b)));
                let apart = tree.level_of[*a].abs_diff(tree.level_of[*b]);
                found += usize::from(touching && apart > 1);
            }
        }
        found
    }
}

/// Every zone is stood for by one particle, and neighbours differ by one level at most, whatever a formula wishes.
#[test]
fn octrees_are_restricted() {
    let choice = fixed("if(x + y < 0.015, 3, 0)");
    let mut body =
        Body::new(force(tree([16, 16, 16], 4), OctreeOperators::Energy, Variant::Adaptive, choice));
    let census = body.adapt();
    assert!(census.active.iter().all(|count| *count > 0), "{:?}", census.active);
    assert_eq!(body.unbalanced(), 0);
    let mass: f64 = body.active().iter().map(|at| body.force.tree().masses[*at]).sum();
    assert!((mass - 4.096).abs() < 1e-12, "{mass}");
}

/// A wave of displacement divides particles where it is steep, with one level between neighbours at every date; the momentum is
/// that of before.
#[test]
fn particles_come_and_go() {
    let choice = OctreeChoice::Adaptive { refine: 0.02, coarsen: 0.005 };
    let mut body =
        Body::new(force(tree([16, 16, 16], 4), OctreeOperators::Energy, Variant::Adaptive, choice));
    let at_rest = body.adapt();
    assert_eq!(at_rest.active, [8, 0, 0, 0]);
    let dent = |x: Vec3| {
        let away = (x - Vec3::new(0.0, 0.0, 0.15)).length_sq();
        Vec3::new(0.0, 0.0, -0.03 * (-away / 0.006).exp())
    };
    for step in 0..12 {
        let rest = body.force.tree().rest.clone();
        for (x, rest) in body.rows.positions.iter_mut().zip(&rest) {
            *x = *rest + dent(*rest);
        }
        for (v, x) in body.rows.velocities.iter_mut().zip(&rest) {
            *v = Vec3::new(1.0 + x.y, -x.x, 3.0 * x.x);
        }
        body.force.follow(
            souple_engine::levels::Followers::All,
            souple_engine::levels::Kinematic::Velocity,
            &body.scratch,
            &mut body.rows.velocities,
        );
        let before = body.momentum();
        let census = body.adapt();
        assert!((body.momentum() - before).length() < 1e-12 * before.length(), "{step}");
        assert_eq!(body.unbalanced(), 0, "{:?}", census.active);
        assert!(census.grading <= 1);
        assert_eq!(census.neighbours.map(|neighbours| neighbours.unlisted), Some(0));
    }
    let bent = body.force.census(&body.memory, &body.scratch);
    let levels = bent.active.iter().filter(|count| **count > 0).count();
    assert!(levels > 1, "{:?}", bent.active);
}

/// Affine displacements, turns among them, divide nothing.
#[test]
fn affine_motions_divide_nothing() {
    let choice = OctreeChoice::Adaptive { refine: 1e-9, coarsen: 0.0 };
    let mut body = Body::new(force(tree([8, 8, 8], 3), OctreeOperators::Energy, Variant::Adaptive, choice));
    let A = Mat3::from_rows([[1.1, 0.2, 0.0], [-0.1, 0.9, 0.3], [0.05, 0.0, 1.0]]);
    body.adapt();
    body.rows.positions.iter_mut().for_each(|x| *x = A * *x);
    assert_eq!(body.adapt().active, [8, 0, 0]);
}

/// A row of single particles is divided where it turns, which it cannot tell from what bends; its daughters tell it, and are not. Straight
/// again, they are grouped.
#[test]
fn rows_divide_where_they_turn() {
    let choice = OctreeChoice::Adaptive { refine: 0.02, coarsen: 0.01 };
    let tree = tree([16, 4, 4], 3);
    let mut body = Body::new(force(tree, OctreeOperators::Energy, Variant::Adaptive, choice));
    assert_eq!(body.adapt().active, [4, 0, 0]);
    let turned = |body: &mut Body, slope: f64| {
        body.rows.positions.iter_mut().for_each(|x| x.y += slope * x.x);
        body.adapt();
        body.adapt().active
    };
    // 2/3 n² of it, in a row of four: just below, and above
    assert_eq!(turned(&mut body, 0.99 * 0.02 / (2.0 / 3.0 * 16.0)), [4, 0, 0]);
    assert_eq!(turned(&mut body, 0.02), [0, 32, 0]);
    let straight = -0.99 * 0.02 / (2.0 / 3.0 * 16.0) - 0.02;
    assert_eq!(turned(&mut body, straight), [4, 0, 0]);
}

/// The energy's force has no sum, across levels too; it is minus its gradient.
#[test]
fn energies_keep_momentum_across_levels() {
    let choice = fixed("if(x < 0.03, 2, 1)");
    let mut body = Body::new(force(tree([8, 8, 8], 3), OctreeOperators::Energy, Variant::Adaptive, choice));
    body.adapt();
    let number = |i: usize, salt: f64| ((i as f64 + salt) * 12.9898).sin() * 1e-3;
    for (at, x) in body.rows.positions.iter_mut().enumerate() {
        *x += Vec3::new(number(at, 0.1), number(at, 0.2), number(at, 0.3));
    }
    let at = |positions: &[Vec3]| {
        let velocities = vec![Vec3::ZERO; positions.len()];
        let configuration = souple_engine::Configuration {
            positions,
            velocities: &velocities,
            time: 0.0,
            load: 1.0,
            memory: &body.memory,
            pairs: &[],
            kept: souple_engine::KeptRef::default(),
            driven: &[],
            fields: &[],
        };
        let (mut scratch, mut out) = (body.force.new_scratch(), vec![Vec3::ZERO; positions.len()]);
        body.force.add_force(&configuration, &mut scratch, &mut out);
        (body.force.energy(&configuration, &mut scratch).stored, out)
    };
    let (_, forces) = at(&body.rows.positions);
    let size: f64 = forces.iter().map(|f| f.length()).sum();
    assert!(forces.iter().copied().sum::<Vec3>().length() < 1e-13 * size);
    for (particle, axis) in body.active().into_iter().step_by(7).zip([0, 1, 2].into_iter().cycle()) {
        let step = 1e-6;
        let mut moved = body.rows.positions.clone();
        moved[particle] += Vec3::AXES[axis] * step;
        let ahead = at(&moved).0;
        moved[particle] += Vec3::AXES[axis] * (-2.0 * step);
        // a quadratic energy has exact differences, to rounding
        let slope = (ahead - at(&moved).0) / (2.0 * step);
        assert!((slope + forces[particle].to_array()[axis]).abs() < 1e-6 * size, "{particle}");
    }
}

/// V-10: with levels of 4, 32, 256 and 2048 of which half is divided, 340 forces of the hierarchical variant against 298.
#[test]
fn hierarchies_cost_a_seventh_more() {
    let count = |variant| {
        // half of 4 x 1 x 1, of 8 x 2 x 2, of 16 x 4 x 4
        let choice = fixed("if(x < 0.155, 1, 0) + if(x < 0.075, 1, 0) + if(x < 0.035, 1, 0)");
        let operators = OctreeOperators::Strong(Operators::Legacy);
        let mut body = Body::new(force(tree([32, 8, 8], 4), operators, variant, choice));
        let census = body.adapt();
        let division = Division::new(1e-6, 0);
        body.force.adapt(&division, &mut body.rows, &mut body.memory, &mut body.scratch);
        (body.force.evaluations(&division, &body.scratch), census)
    };
    let (adaptive, census) = count(Variant::Adaptive);
    assert_eq!(census.active, [2, 8, 32, 256]);
    assert_eq!(adaptive, 298);
    let (hierarchical, census) = count(Variant::Hierarchical);
    assert_eq!((census.active, census.ghosts), (vec![2, 8, 32, 256], vec![2, 8, 32, 0]));
    assert_eq!(hierarchical, 340);
}
