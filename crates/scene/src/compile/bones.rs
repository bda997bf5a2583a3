//! Bones at work: frames that follow one are led as a whole, their places and their axes.

use std::sync::Arc;

use souple_engine::{Constraint, Kinematics, Motion, UnknownKind};
use souple_math::Vec3;
use souple_models::loads::{NestedMotion, RigidMotion};

use super::Draft;
use super::bodies::Placed;
use super::freedom::Joint;
use super::motion::motion;
use crate::diagnostic::{Code, Log, Site};
use crate::spec::Spec;
use crate::spec::boundary::MotionSpec;

/// The motion of a bone, or of a shape, by name; `None` where it was refused. `site` is that of who follows.
pub fn motion_of(log: &Log, spec: &Spec, name: &str, site: &Site) -> Option<Arc<dyn Motion>> {
    let mut found: Option<Arc<dyn Motion>> = None;
    let (mut next, mut followed) = (Some(name.to_owned()), 0);
    while let Some(name) = next {
        let bone = spec.bones.iter().find(|bone| bone.name == name);
        let shape = spec.shapes.iter().find(|shape| shape.name == name);
        let (own, leader) = match (bone, shape) {
            (Some(bone), _) => {
                let own = rigid(log, [&bone.motion, &bone.rotation], bone.pivot, &bone.site)?;
                (own, bone.follows.clone())
            }
            (None, Some(shape)) => {
                (rigid(log, [&shape.motion, &shape.rotation], shape.pivot, &shape.site)?, None)
            }
            (None, None) => {
                let bones = spec.bones.iter().map(|bone| bone.name.as_str());
                let known: Vec<&str> =
                    bones.chain(spec.shapes.iter().map(|shape| shape.name.as_str())).collect();
                let hint = crate::keys::did_you_mean(&name, known.iter().copied());
                let message = format!("there is no bone `{name}`{hint}");
                let expected = if known.is_empty() {
                    "[bones.NAME] with its motion".to_owned()
                } else {
                    format!("one of {}", known.join(", "))
                };
                log.add(Code::UnknownName, site, message, expected);
                return None;
            }
        };
        found = Some(match found {
            Some(inner) => Arc::new(NestedMotion { inner, outer: own }),
            None => own,
        });
        followed += 1;
        if leader.is_some() && followed > spec.bones.len() {
            let message = format!("bone `{name}` follows itself");
            log.add(Code::Conflict, site, message, "a bone that nobody leads at the end of the chain");
            return None;
        }
        next = leader;
    }
    found
}

fn rigid(
    log: &Log,
    [translation, rotation]: [&Option<MotionSpec>; 2],
    pivot: Vec3,
    site: &Site,
) -> Option<Arc<dyn Motion>> {
    let translation = motion(log, translation.as_ref(), site)?;
    let rotation = motion(log, rotation.as_ref(), site)?;
    Some(Arc::new(RigidMotion { translation, rotation, pivot }))
}

/// How an axis of an affine frame is led: it turns, and stands nowhere.
#[derive(Clone, Debug)]
struct Turning(Arc<dyn Motion>);

impl Motion for Turning {
    fn offset(&self, start: Vec3, time: f64) -> Vec3 {
        self.0.turn(time) * start - start
    }

    fn velocity(&self, start: Vec3, time: f64) -> Vec3 {
        self.0.spin(time).cross(self.0.turn(time) * start)
    }
}

/// What leads the frames of a body that follow bones, and what that hinders.
pub fn bind(draft: &Draft, body: &Placed, kinematics: &Kinematics) -> (Vec<Constraint>, Vec<Joint>) {
    let (mut constraints, mut joints) = (Vec::new(), Vec::new());
    let (Some(frames), Some(spec)) = (&body.frames, &body.spec.frames) else { return (constraints, joints) };
    let mut leader = vec![None; frames.frames.len()];
    for bound in &spec.bones {
        let Some(motion) = motion_of(draft.log, draft.spec, &bound.bone, &bound.site) else { continue };
        for &number in &bound.frames {
            let refuse = |message: String, expected: String| {
                draft.log.add(Code::Conflict, &bound.site, message, expected);
            };
            let Some(frame) = frames.frames.get(number as usize) else {
                let count = frames.frames.len();
                refuse(
                    format!("body `{}` has no frame {number}", body.spec.name),
                    format!("0 to {}", count - 1),
                );
                continue;
            };
            if let Some(other) = leader[number as usize].replace(&bound.bone) {
                let message = format!("frame {number} follows `{other}` already");
                refuse(message, "one bone for each frame".to_owned());
                continue;
            }
            let block = kinematics.block_of(frames.rows[number as usize]);
            let led = |block: u32, start: Vec3, motion: Arc<dyn Motion>| Constraint {
                motion: Some(motion),
                ..Constraint::pin(block, start)
            };
            constraints.push(led(block, frame.origin, Arc::clone(&motion)));
            match frames.kind {
                UnknownKind::RigidFrame => {
                    constraints.push(Constraint::of_turn(block + 1, frame.axes, Some(Arc::clone(&motion))));
                }
                UnknownKind::AffineFrame => {
                    let axes = (block + 1..).zip(frame.axes.columns);
                    constraints.extend(
                        axes.map(|(block, axis)| led(block, axis, Arc::new(Turning(Arc::clone(&motion))))),
                    );
                }
                UnknownKind::Point => {}
            }
            let reached = (body.rows.start as u32..).zip(&frames.carried_points);
            let reached = reached.filter(|(_, carried)| carried.frames.binary_search(&number).is_ok());
            joints.extend(reached.map(|(row, _)| Joint {
                system: body.system,
                ends: vec![(row, 1.0)],
                direction: None,
            }));
        }
    }
    (constraints, joints)
}
