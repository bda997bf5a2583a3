//! (f) A parameter edit is a recorded command; replay repeats it to the bit.

use souple_engine::{Edit, EditError};
use souple_math::Vec3;

use super::forces::Spring;
use super::{points, stepper, world};

fn two_points(name: &str) -> souple_engine::World {
    let spring = Spring { a: 0, b: 1, stiffness: 10.0, damping: 0.1 };
    world(points(&[Vec3::ZERO, Vec3::X], &[1.0, 2.0], vec![Box::new(spring)], stepper(name)), 1e-2)
}

#[test]
fn replay_repeats_edits_bit_for_bit() {
    for name in ["symplectic_euler", "backward_euler"] {
        let mut played = two_points(name);
        let stiffen = |value: f64| Edit::SetParameter {
            system: 0,
            force: "spring".into(),
            parameter: "stiffness".into(),
            value,
        };
        for step in 0..60 {
            if step == 20 {
                played.edit(stiffen(30.0)).unwrap();
            }
            if step == 40 {
                played.edit(Edit::Pin { system: 0, block: 1 }).unwrap();
            }
            played.step().unwrap();
        }
        assert_eq!(played.model().generation, 2);
        let mut replayed = two_points(name);
        let mut commands = played.log().iter().peekable();
        for _ in 0..60 {
            while let Some(command) = commands.next_if(|command| command.period == replayed.state().period) {
                replayed.edit(command.edit.clone()).unwrap();
            }
            replayed.step().unwrap();
        }
        assert_eq!(replayed.state().hash(), played.state().hash());
        let mut unedited = two_points(name);
        (0..60).for_each(|_| unedited.step().unwrap());
        assert_ne!(unedited.state().hash(), played.state().hash(), "the edit has changed something");
    }
}

/// A state between two edits, continued in a new world that makes the earlier ones anew, ends with the bits of the
/// unbroken run; without the edits it does not.
#[test]
fn an_edited_world_resumes() {
    let stiffen =
        Edit::SetParameter { system: 0, force: "spring".into(), parameter: "stiffness".into(), value: 30.0 };
    for name in ["symplectic_euler", "backward_euler"] {
        let mut unbroken = two_points(name);
        let mut middle = None;
        for step in 0..60 {
            match step {
                10 => unbroken.edit(stiffen.clone()).unwrap(),
                20 => unbroken.edit(Edit::Pin { system: 0, block: 1 }).unwrap(),
                30 => middle = Some((unbroken.state().clone(), unbroken.log().to_vec())),
                40 => unbroken.edit(Edit::Unpin { system: 0, block: 1 }).unwrap(),
                _ => {}
            }
            unbroken.step().unwrap();
        }
        let (state, log) = middle.unwrap();
        let finish = |mut world: souple_engine::World| {
            (30..40).for_each(|_| world.step().unwrap());
            world.edit(Edit::Unpin { system: 0, block: 1 }).unwrap();
            (40..60).for_each(|_| world.step().unwrap());
            world
        };
        let mut resumed = two_points(name);
        resumed.resume_edited(state.clone(), log).unwrap();
        let resumed = finish(resumed);
        assert_eq!(resumed.state().hash(), unbroken.state().hash(), "{name}");
        assert_eq!(resumed.log(), unbroken.log(), "{name}");
        assert_eq!(resumed.model().generation, 3, "{name}");
        let mut forgetful = two_points(name);
        forgetful.resume(state).unwrap();
        assert_ne!(finish(forgetful).state().hash(), unbroken.state().hash(), "{name}");
    }
}

#[test]
fn a_wrong_edit_changes_nothing() {
    let mut world = two_points("symplectic_euler");
    let before = world.state().hash();
    let wrong =
        Edit::SetParameter { system: 0, force: "sprnig".into(), parameter: "stiffness".into(), value: 1.0 };
    assert!(matches!(world.edit(wrong), Err(EditError::NoForce { .. })));
    let negative =
        Edit::SetParameter { system: 0, force: "spring".into(), parameter: "stiffness".into(), value: -1.0 };
    assert!(matches!(world.edit(negative), Err(EditError::Parameter(_))));
    assert!(matches!(world.edit(Edit::Pin { system: 0, block: 9 }), Err(EditError::NoBlock { .. })));
    assert_eq!((world.state().hash(), world.log().len(), world.model().generation), (before, 0, 0));
}
