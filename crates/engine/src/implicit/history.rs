//! What implicit steppers keep in [`SystemState::history`]: the configuration that the solver's orders and patches refer
//! to, and behind it what a formula carries from step to step, vectors over velocity blocks.

use souple_math::Vec3;

use crate::kinematics::Kinematics;
use crate::state::SystemState;

/// What forces may read of the state while its configuration is sought: the rest of `next` is lent to it, without
/// a copy, until [`Lent::give_back`].
pub struct Lent(pub(super) SystemState);

impl Lent {
    /// Also writes down the configuration that the solver's orders and patches refer to, if there is none.
    pub fn from(next: &mut SystemState) -> Self {
        write_reference(next);
        Self(SystemState {
            memory: std::mem::take(&mut next.memory),
            pairs: std::mem::take(&mut next.pairs),
            kept: std::mem::take(&mut next.kept),
            history: std::mem::take(&mut next.history),
            ..SystemState::default()
        })
    }

    pub fn give_back(self, next: &mut SystemState) {
        next.memory = self.0.memory;
        next.pairs = self.0.pairs;
        next.kept = self.0.kept;
        next.history = self.0.history;
    }
}

fn write_reference(next: &mut SystemState) {
    if next.history.is_empty() {
        next.history.extend(next.q.iter().flat_map(|row| row.to_array()));
    }
}

fn reference_len(kinematics: &Kinematics) -> usize {
    3 * kinematics.free_row_count()
}

fn carried_len(kinematics: &Kinematics, count: usize) -> usize {
    3 * count * kinematics.block_count()
}

/// The configuration that orders and patches refer to: free rows, by components.
pub(crate) fn reference<'a>(kinematics: &Kinematics, history: &'a [f64]) -> &'a [f64] {
    &history[..reference_len(kinematics)]
}

/// Whether `history` is one that a formula leaves which carries `count` vectors: none, a reference before its first step
/// has ended, or all.
pub(crate) fn accepts(kinematics: &Kinematics, history: &[f64], count: usize) -> bool {
    let reference = reference_len(kinematics);
    [0, reference, reference + carried_len(kinematics, count)].contains(&history.len())
}

/// The `N` vectors carried from the step before; `None` before the first.
pub(crate) fn carried<'a, const N: usize>(
    kinematics: &Kinematics,
    history: &'a [f64],
) -> Option<[&'a [Vec3]; N]> {
    let numbers = history.get(reference_len(kinematics)..).filter(|numbers| !numbers.is_empty())?;
    let blocks: &[Vec3] = bytemuck::cast_slice(numbers);
    let count = kinematics.block_count();
    Some(std::array::from_fn(|vector| &blocks[vector * count..(vector + 1) * count]))
}

/// Carries `vectors` on to the next step; allocates the first time only.
pub(crate) fn carry<const N: usize>(kinematics: &Kinematics, next: &mut SystemState, vectors: [&[Vec3]; N]) {
    write_reference(next);
    next.history.truncate(reference_len(kinematics));
    for vector in vectors {
        next.history.extend_from_slice(bytemuck::cast_slice(vector));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kinematics::UnknownKind;

    /// What is carried comes back, behind a reference that stays; lengths in between belong to no formula.
    #[test]
    fn carried_vectors_come_back() {
        let mut kinematics = Kinematics::default();
        kinematics.add_unknowns(UnknownKind::Point, 2);
        let mut state = SystemState { q: vec![Vec3::X, Vec3::Y], ..SystemState::default() };
        assert_eq!(carried::<2>(&kinematics, &state.history), None);
        let (increment, velocity) = ([Vec3::Z, Vec3::X], [Vec3::Y, Vec3::ZERO]);
        for _ in 0..2 {
            carry(&kinematics, &mut state, [&increment, &velocity]);
            let back: [&[Vec3]; 2] = carried(&kinematics, &state.history).unwrap();
            assert_eq!(back, [&increment, &velocity]);
            assert_eq!(reference(&kinematics, &state.history), [1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
        }
        assert!(accepts(&kinematics, &state.history, 2));
        assert!(accepts(&kinematics, &[], 2) && accepts(&kinematics, &state.history[..6], 2));
        assert!(!accepts(&kinematics, &state.history, 1) && !accepts(&kinematics, &state.history[..17], 2));
    }
}
