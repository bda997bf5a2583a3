//! What no force feels and no step refuses, looked for after every period: it becomes warnings.

use souple_engine::World;
use souple_scene::BodyInfo;

use crate::leaps::Leaps;
use crate::passages::Passages;
use crate::undefined::Undefined;

/// Balls that leap over others, masses that go through walls, grounds that have no value.
#[derive(Clone, Debug)]
pub struct Lookout {
    leaps: Leaps,
    passages: Passages,
    undefined: Undefined,
}

impl Lookout {
    /// Watches a world from where it stands.
    pub fn new(world: &World, bodies: &[BodyInfo]) -> Self {
        Self {
            leaps: Leaps::default(),
            passages: Passages::new(world, bodies),
            undefined: Undefined::default(),
        }
    }

    /// Looks after a period; what there is to say for the first time.
    pub fn look(&mut self, world: &World, bodies: &[BodyInfo]) -> Vec<String> {
        let mut said = self.leaps.look(world);
        said.extend(self.passages.look(world, bodies));
        said.extend(self.undefined.look(world, bodies));
        said
    }
}
