//! Who does what in a body with levels.

use souple_engine::World;

use super::LevelsPart;
use crate::scene::census;
use crate::spec::quantity::LevelsQuantity;

pub fn measure(quantity: LevelsQuantity, part: &LevelsPart, world: &World) -> f64 {
    let Some(census) = census(world, part.system, &part.force) else { return 0.0 };
    let counts = match quantity {
        LevelsQuantity::Active => census.active,
        LevelsQuantity::Ghosts => census.ghosts,
        LevelsQuantity::Jump => return part.dress.as_ref().map_or(0.0, |dress| dress.greatest_jump(world)),
    };
    match part.level {
        Some(level) => counts[level] as f64,
        None => counts.iter().sum::<usize>() as f64,
    }
}
