//! Steps that are broken off in their middle.

use std::any::Any;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use souple_engine::state::Pair;
use souple_engine::steppers::TABLE;
use souple_engine::{
    Configuration, Constraint, Declaration, Energy, Force, Interruption, Scratch, StepError, TangentWeights,
    World,
};
use souple_math::Vec3;
use souple_solve::BlockMatrix;

use super::forces::Spring;
use super::{points, stepper_of, world};

/// Pulls at a point, and wishes for an end of the step in which it is asked to while it is armed.
struct Wishing {
    interruption: Interruption,
    armed: Arc<AtomicBool>,
}

impl Force for Wishing {
    fn name(&self) -> &str {
        "wishing"
    }
    fn declaration(&self) -> Declaration {
        Declaration::LOAD
    }
    fn energy(&self, at: &Configuration, _: &mut Scratch) -> Energy {
        Energy { stored: -at.positions[1].y, dissipated: 0.0 }
    }
    fn add_force(&self, _: &Configuration, _: &mut Scratch, out: &mut [Vec3]) {
        out[1].y += 1.0;
        if self.armed.swap(false, Ordering::Relaxed) {
            self.interruption.wish();
        }
    }
    fn add_differential(
        &self,
        _: &Configuration,
        _: TangentWeights,
        _: &[Vec3],
        _: &mut Scratch,
        _: &mut [Vec3],
    ) {
    }
    fn visit_cliques(&self, _: &[Pair], _: &mut dyn FnMut(&[u32])) {}
    fn add_blocks(&self, _: &Configuration, _: TangentWeights, _: &mut Scratch, _: &mut BlockMatrix) {}
    fn as_any(&self) -> &dyn Any {
        self
    }
}

/// Two points on a spring, one of them held, in two steps a period.
fn pulled(stepper: Box<dyn souple_engine::Stepper>, wishing: Wishing) -> World {
    let interruption = wishing.interruption.clone();
    let spring = Spring { a: 0, b: 1, stiffness: 60.0, damping: 0.0 };
    let forces: Vec<Box<dyn Force>> = vec![Box::new(spring), Box::new(wishing)];
    let (mut system, q) = points(&[Vec3::ZERO, Vec3::X], &[0.4, 0.5], forces, stepper);
    system.constraints = vec![Constraint::pin(0, q[0])];
    system.steps_per_period = 2;
    let mut world = world((system, q), 0.01);
    world.heed(&interruption);
    world
}

/// Whatever steps, and however it solves: a step that is broken off after its first look at the forces leaves State as it
/// was, and the world goes on as if nothing had been.
#[test]
fn steps_are_broken_off_in_their_middle() {
    let names = TABLE.entries.iter().map(|entry| entry.name).filter(|name| *name != "staggered");
    for name in names {
        let solves = TABLE.find(name).unwrap().parameters.iter().any(|parameter| parameter.name == "newton");
        for newton in if solves { &["one", "full"][..] } else { &[""] } {
            let (interruption, armed) = (Interruption::default(), Arc::new(AtomicBool::new(false)));
            let wishing = Wishing { interruption: interruption.clone(), armed: Arc::clone(&armed) };
            let mut disturbed = pulled(stepper_of(name, newton), wishing);
            let unarmed = Wishing { interruption: Interruption::default(), armed: Arc::default() };
            let mut undisturbed = pulled(stepper_of(name, newton), unarmed);
            disturbed.step().unwrap();
            let before = disturbed.state().hash();
            armed.store(true, Ordering::Relaxed);
            let error = disturbed.step().unwrap_err().error;
            assert_eq!(error, StepError::Interrupted, "{name} {newton}");
            assert_eq!(disturbed.state().hash(), before, "{name} {newton}");
            interruption.withdraw();
            disturbed.step().unwrap();
            (0..2).for_each(|_| undisturbed.step().unwrap());
            assert_eq!(disturbed.state().hash(), undisturbed.state().hash(), "{name} {newton}");
        }
    }
}
