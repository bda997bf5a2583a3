//! What a hand does and feels, and what its tool does.

use souple_engine::World;
use souple_math::Vec3;

use super::Measurement;
use crate::scene::HandInfo;
use crate::spec::quantity::HandQuantity;

pub fn measure(quantity: HandQuantity, hand: &HandInfo, world: &World) -> Measurement {
    use HandQuantity::{ToolForce, ToolJump, ToolPenetration};
    let (mut force, mut penetration, mut jump) = (Vec3::ZERO, 0.0_f64, 0.0);
    if matches!(quantity, ToolForce | ToolPenetration | ToolJump)
        && let Some((tool, at)) = world.force_named(hand.system, &hand.force)
    {
        jump = tool.holding().map_or(0.0, |holding| holding.jump(at.memory));
        tool.visit_contacts(&at, &mut |point| {
            force += point.normal_force + point.friction;
            penetration = penetration.max(point.penetration);
        });
    }
    let held = hand.of(world);
    match quantity {
        HandQuantity::Position => Measurement::Vector(held.device),
        HandQuantity::Force => Measurement::Vector(held.force),
        HandQuantity::Energy => Measurement::Number(held.energy),
        HandQuantity::Jump => Measurement::Number(held.jump),
        HandQuantity::Age => Measurement::Number(held.age),
        HandQuantity::ToolPosition => Measurement::Vector(held.tool),
        HandQuantity::ToolForce => Measurement::Vector(force),
        HandQuantity::ToolPenetration => Measurement::Number(penetration),
        HandQuantity::ToolJump => Measurement::Number(jump),
    }
}
