//! Hands become contacts of shapes that are carried: what carries them is the hand.

use std::sync::Arc;

use souple_engine::{Force, Motion};
use souple_haptics::{Between, HandCarrier, Rest};
use souple_math::Vec3;
use souple_models::contact::{ImposedContact, ShapeContact, ToolContact};
use souple_models::loads::RigidMotion;

use super::Draft;
use super::contact::{built, imposed, law, modulus_of, stiff, tool_surface, touching, weighed};
use super::motion::motion;
use crate::diagnostic::Code;
use crate::scene::HandInfo;
use crate::spec::hand::HandSpec;

/// All hands.
pub fn add(draft: &mut Draft) {
    let made: Vec<(HandInfo, Box<dyn Force>)> =
        draft.spec.hands.iter().filter_map(|hand| hand_of(draft, hand)).collect();
    for (info, force) in made {
        draft.systems[info.system].forces.push(force);
        draft.hands.push(info);
    }
}

/// `None` where it was refused.
fn hand_of(draft: &Draft, hand: &HandSpec) -> Option<(HandInfo, Box<dyn Force>)> {
    let body = draft.body(&hand.touch.body)?;
    let touching = touching(draft, body, &hand.touch)?;
    let shape = built(draft, hand.tool.as_ref()?)?;
    let law = law(&hand.touch, modulus_of(draft, &hand.touch, body, &touching)?, touching.mean_area);
    let intent = motion(draft.log, hand.motion.as_ref(), &hand.site)?;
    let intent: Arc<dyn Motion> = intent.unwrap_or_else(|| Arc::new(RigidMotion::default()));
    let start = [intent.offset(Vec3::ZERO, 0.0), intent.velocity(Vec3::ZERO, 0.0)];
    if start.iter().any(|vector| !vector.is_finite()) {
        let message = format!("the motion of hand `{}` is not finite at t = 0", hand.name);
        let expected = "formulas that are finite with their derivative by t";
        draft.log.add(Code::NotFinite, &hand.site, message, expected);
        return None;
    }
    let chosen = hand.device.as_ref()?;
    let device = (chosen.entry.build)(&chosen.values, intent);
    let is_held = hand.between == Between::Hold;
    let rest = Rest {
        port: hand.port,
        mass: hand.mass,
        period: draft.spec.world.period,
        is_held,
        weight: hand.weight,
    };
    let carrier = Box::new(HandCarrier::new(rest, device.arm().cloned()));
    let force = hand.touch.name.clone();
    let made: Result<Box<dyn Force>, _> =
        match tool_surface(draft, &hand.touch, body, &touching, shape.as_ref())? {
            Some((surface, numbers)) => match imposed(draft, &hand.touch) {
                Some((law, period)) => {
                    ImposedContact::carried(force.clone(), surface, shape, carrier, law, period)
                        .map(|contact| Box::new(contact) as _)
                }
                None => {
                    let law = stiff(&hand.touch, law);
                    ToolContact::carried(force.clone(), surface, shape, carrier, law, numbers)
                        .map(|contact| Box::new(weighed(&hand.touch, contact)) as _)
                }
            },
            None => ShapeContact::carried(force.clone(), touching.points, shape, carrier, law)
                .and_then(|contact| contact.opening(touching.later))
                .map(|contact| Box::new(contact) as _),
        };
    match made {
        Ok(contact) => {
            let info = HandInfo {
                name: hand.name.clone(),
                system: body.system,
                force,
                device,
                port: hand.port,
                between: hand.between,
            };
            Some((info, contact))
        }
        Err(error) => {
            draft.log.add(Code::OutOfRange, &hand.site, error.to_string(), "finite numbers");
            None
        }
    }
}
