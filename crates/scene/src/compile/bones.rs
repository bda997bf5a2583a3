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
use crate::spec::bone::BoneSpec;
use crate::spec::boundary::MotionSpec;

/// Reports bones that follow nobody there is, or themselves, that have the name of a shape, or that are nowhere at the start.
pub fn check(spec: &Spec, log: &Log) {
    for bone in &spec.bones {
        if spec.shapes.iter().any(|shape| shape.name == bone.name) {
            let message = format!("there is a shape `{}` too, and a shape is a bone", bone.name);
            log.add(Code::Conflict, &bone.site, message, "names that differ");
        }
        let leader = bone.follows.as_deref();
        if let Some(name) = leader.filter(|name| !is_known(spec, name)) {
            report_unknown(log, spec, name, &bone.follows_site);
        } else if follows_itself(spec, bone) {
            let message = format!("bone `{}` follows itself", bone.name);
            log.add(
                Code::Conflict,
                &bone.follows_site,
                message,
                "a bone that nobody leads at the end of the chain",
            );
        }
    }
    if !log.is_empty() {
        return;
    }
    for bone in &spec.bones {
        let Some(motion) = motion_of(log, spec, &bone.name, &bone.site) else { continue };
        let place = bone.pivot + motion.offset(bone.pivot, 0.0);
        let numbers = [place, motion.velocity(bone.pivot, 0.0), motion.spin(0.0)].map(Vec3::to_array);
        if !(numbers.iter().flatten().all(|number| number.is_finite()) && motion.turn(0.0).is_finite()) {
            let [place, velocity, spin] = numbers;
            let message = format!(
                "at t = 0 the pivot of the bone is at {place:?} m, moves by {velocity:?} m/s and turns by {spin:?} rad/s"
            );
            log.add(Code::NotFinite, &bone.site, message, "formulas that are finite at the start");
        }
    }
}

fn is_known(spec: &Spec, name: &str) -> bool {
    spec.bones.iter().any(|bone| bone.name == name) || spec.shapes.iter().any(|shape| shape.name == name)
}

fn follows_itself(spec: &Spec, bone: &BoneSpec) -> bool {
    let leader = |bone: &&'_ BoneSpec| {
        let name = bone.follows.as_deref()?;
        spec.bones.iter().find(|other| other.name == name)
    };
    let chain = std::iter::successors(leader(&bone), leader).take(spec.bones.len());
    chain.into_iter().any(|other| other.name == bone.name)
}

fn report_unknown(log: &Log, spec: &Spec, name: &str, site: &Site) {
    let bones = spec.bones.iter().map(|bone| bone.name.as_str());
    let known: Vec<&str> = bones.chain(spec.shapes.iter().map(|shape| shape.name.as_str())).collect();
    let hint = crate::keys::did_you_mean(name, known.iter().copied());
    let message = format!("there is no bone `{name}`{hint}");
    let expected = if known.is_empty() {
        "[bones.NAME] with its motion".to_owned()
    } else {
        format!("one of {}", known.join(", "))
    };
    log.add(Code::UnknownName, site, message, expected);
}

/// The motion of a bone, or of a shape, by name, where chains of bones end; `None` where it was refused. `site` is that of who
/// follows.
pub fn motion_of(log: &Log, spec: &Spec, name: &str, site: &Site) -> Option<Arc<dyn Motion>> {
    let mut found: Option<Arc<dyn Motion>> = None;
    let mut next = Some(name);
    while let Some(name) = next {
        let bone = spec.bones.iter().find(|bone| bone.name == name);
        let shape = spec.shapes.iter().find(|shape| shape.name == name);
        let (own, leader) = match (bone, shape) {
            (Some(bone), _) => {
                let own = rigid(log, [&bone.motion, &bone.rotation], bone.pivot, &bone.site)?;
                (own, bone.follows.as_deref())
            }
            (None, Some(shape)) => {
                (rigid(log, [&shape.motion, &shape.rotation], shape.pivot, &shape.site)?, None)
            }
            (None, None) => {
                report_unknown(log, spec, name, site);
                return None;
            }
        };
        found = Some(match found {
            Some(inner) => Arc::new(NestedMotion { inner, outer: own }),
            None => own,
        });
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
                // what `frames` never are
                UnknownKind::Point | UnknownKind::QuadraticFrame | UnknownKind::FloatingFrame { .. } => {}
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
