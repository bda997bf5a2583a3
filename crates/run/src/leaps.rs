//! Watches balls that move farther in a step than their law reaches: they jump over each other, and no force feels it.
//!
//! What a crowd does to a ball depends on where it is between two steps only. A ball that goes by the range or more in one step, against
//! the mean of those of its crowd, passes through any that is in its way, near or not: whether one is, is not looked at. After steps that
//! are too long this is how a heap bursts. It is told once of each crowd.

use std::ops::Range;

use souple_engine::World;
use souple_math::Vec3;
use souple_models::network::Crowd;
use souple_table::{counted, four_digits, readable};

/// Crowds of which it was told, by their systems and forces.
#[derive(Clone, Debug, Default)]
pub struct Leaps {
    told: Vec<(usize, usize)>,
}

impl Leaps {
    /// Looks at the velocities of now; what there is to say of crowds that leap for the first time.
    pub fn look(&mut self, world: &World) -> Vec<String> {
        let mut said = Vec::new();
        for (index, system) in world.model().systems.iter().enumerate() {
            let timestep = world.model().timestep(index);
            for (number, force) in system.forces.iter().enumerate() {
                let Some(crowd) = force.as_any().downcast_ref::<Crowd>() else { continue };
                if self.told.contains(&(index, number)) {
                    continue;
                }
                let farthest = crowd.range() / timestep;
                let (count, fastest) = faster(crowd.rows(), &world.rows(index).velocities, farthest);
                if count > 0 {
                    self.told.push((index, number));
                    said.push(format!(
                        "may have passed through each other: at {} s {} of crowd `{}` moved farther in a step than its range of {} m, the fastest {} m: \
                         what jumps over others does not feel them; if any were in the way, take shorter steps \
                         (`souple check` tells which a dense heap bears)",
                        readable(world.time()),
                        counted(count as u64, "ball"),
                        force.name(),
                        four_digits(crowd.range()),
                        four_digits(fastest * timestep),
                    ));
                }
            }
        }
        said
    }
}

/// Balls of a crowd that are at least so fast against the mean of those they may meet, and the speed of the fastest [m/s].
fn faster(groups: [Range<u32>; 2], velocities: &[Vec3], speed: f64) -> (usize, f64) {
    let [first, second] = groups.map(|rows| &velocities[rows.start as usize..rows.end as usize]);
    let is_one = std::ptr::eq(first, second);
    let (mut count, mut fastest_sq) = (0, 0.0_f64);
    let mut meet = |own: &[Vec3], others: &[Vec3]| {
        let sum: Vec3 = others.iter().copied().sum();
        let others = others.len().saturating_sub(usize::from(is_one));
        if others == 0 {
            return;
        }
        for velocity in own {
            let of_others = if is_one { sum - *velocity } else { sum };
            let speed_sq = (*velocity - of_others * (1.0 / others as f64)).length_sq();
            if speed_sq >= speed * speed {
                count += 1;
                fastest_sq = fastest_sq.max(speed_sq);
            }
        }
    };
    meet(first, second);
    if !is_one {
        meet(second, first);
    }
    (count, fastest_sq.sqrt())
}
