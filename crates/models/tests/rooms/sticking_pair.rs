//! (d) A pair that sticks: created on touch, saved with its anchor, resumed, destroyed on leaving.

use std::any::Any;

use souple_engine::state::Pair;
use souple_engine::tangent::add_block;
use souple_engine::{Configuration, Declaration, Energy, Force, Scratch, State, TangentWeights, World};
use souple_math::{Mat3, Vec3};
use souple_solve::BlockMatrix;

use super::forces::Push;
use super::{points, stepper, world};

/// Ground at y = 0 that holds a touching point where it first touched.
struct StickyGround {
    stiffness: f64,
}

impl StickyGround {
    fn anchor(pair: &Pair) -> Vec3 {
        Vec3::new(pair.memory[0], pair.memory[1], pair.memory[2])
    }
}

impl Force for StickyGround {
    fn name(&self) -> &str {
        "ground"
    }
    fn declaration(&self) -> Declaration {
        Declaration { changing_pattern: true, ..Declaration::LOAD }
    }
    fn energy(&self, at: &Configuration, _: &mut Scratch) -> Energy {
        let stretch = |pair: &Pair| (at.positions[pair.a as usize] - Self::anchor(pair)).length_sq();
        Energy { stored: 0.5 * self.stiffness * at.pairs.iter().map(stretch).sum::<f64>(), dissipated: 0.0 }
    }
    fn add_force(&self, at: &Configuration, _: &mut Scratch, out: &mut [Vec3]) {
        for pair in at.pairs {
            out[pair.a as usize] += (Self::anchor(pair) - at.positions[pair.a as usize]) * self.stiffness;
        }
    }
    fn add_differential(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        delta: &[Vec3],
        _: &mut Scratch,
        out: &mut [Vec3],
    ) {
        for pair in at.pairs {
            out[pair.a as usize] -= delta[pair.a as usize] * (weights.position * self.stiffness);
        }
    }
    fn visit_cliques(&self, pairs: &[Pair], visit: &mut dyn FnMut(&[u32])) {
        pairs.iter().for_each(|pair| visit(&[pair.a as u32]));
    }
    fn add_blocks(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        _: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) {
        for pair in at.pairs {
            let row = pair.a as usize;
            add_block(matrix, row, row, &(Mat3::IDENTITY * (-weights.position * self.stiffness)));
        }
    }
    fn accepts_pair(&self, pair: &Pair) -> bool {
        (pair.a, pair.b) == (0, 0)
    }
    fn find_pairs(&self, at: &Configuration, _: &mut Scratch, found: &mut Vec<Pair>) {
        for (row, x) in at.positions.iter().enumerate().filter(|(_, x)| x.y < 0.0) {
            found.push(Pair::new(row, 0, [x.x, 0.0, x.z, 0.0, 0.0, 0.0, 0.0, 0.0]));
        }
    }
    fn as_any(&self) -> &dyn Any {
        self
    }
}

fn falling(name: &str) -> World {
    let forces: Vec<Box<dyn Force>> = vec![
        Box::new(StickyGround { stiffness: 1e3 }),
        Box::new(Push { row: 0, force: Vec3::new(1.0, -10.0, 0.0) }),
    ];
    world(points(&[Vec3::new(0.3, 0.05, 0.0)], &[1.0], forces, stepper(name)), 5e-3)
}

#[test]
fn a_pair_is_created_saved_resumed_and_destroyed() {
    for name in ["symplectic_euler", "backward_euler"] {
        let mut through = falling(name);
        assert!(through.state().systems[0].pairs.is_empty());
        let mut steps = 0;
        while through.state().systems[0].pairs.is_empty() {
            through.step().unwrap();
            steps += 1;
            assert!(steps < 1000, "{name}: never touched");
        }
        let anchor = StickyGround::anchor(&through.state().systems[0].pairs[0]);
        assert!(anchor.x > 0.3 && anchor.y == 0.0, "{anchor:?}");
        through.step().unwrap();
        // resumed, the pair keeps its anchor and the run its bits
        let mut resumed = falling(name);
        resumed.resume(State::from_bytes(&through.state().to_bytes()).unwrap()).unwrap();
        let mut destroyed = false;
        for _ in 0..400 {
            through.step().unwrap();
            resumed.step().unwrap();
            let pairs = &through.state().systems[0].pairs;
            destroyed |= pairs.is_empty();
            if !destroyed {
                assert_eq!(StickyGround::anchor(&pairs[0]), anchor, "an anchor moved");
            }
        }
        assert!(destroyed || name == "backward_euler", "{name}: the point never left the ground again");
        assert_eq!(resumed.state().hash(), through.state().hash());
    }
}

/// A pair that has gone is forgotten: touching again starts with a new anchor.
#[test]
fn touching_again_makes_a_new_anchor() {
    let mut remembered = vec![Pair { force: 1, ..Pair::new(4, 0, [1.0; 8]) }];
    let mut found =
        vec![Pair { force: 1, ..Pair::new(5, 0, [2.0; 8]) }, Pair { force: 1, ..Pair::new(4, 0, [3.0; 8]) }];
    souple_engine::state::merge_pairs(&mut remembered, &mut found);
    assert_eq!(
        remembered.iter().map(|pair| (pair.a, pair.memory[0])).collect::<Vec<_>>(),
        [(4, 1.0), (5, 2.0)]
    );
    souple_engine::state::merge_pairs(&mut remembered, &mut Vec::new());
    let mut again = vec![Pair { force: 1, ..Pair::new(4, 0, [9.0; 8]) }];
    souple_engine::state::merge_pairs(&mut remembered, &mut again);
    assert_eq!(remembered[0].memory[0], 9.0);
}
