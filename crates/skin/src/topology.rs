//! When the topology of a skin changes.

use souple_engine::FieldState;

use crate::skin::{CHANGED, COMPONENTS, COUNTED, EULER, EVENTS, LEFT, WANDERED};

/// Surfaces in a row after which what is no longer as it was counts, though no two of them were alike.
pub(crate) const LONGEST: u64 = 8;

/// Notes the Euler characteristic and the components of a surface at a time [s].
///
/// A neck that parts, or a hole that opens, may go through a state of its own within one voxel, there for a step and gone in
/// the next: what counts as a change has stood for two surfaces in a row, and began when the old state was left. Where
/// every surface differs from the one before, as in a spray, the newest counts after so many.
pub fn note(field: &mut FieldState, now: [u64; 2], time: f64) {
    let indices = &mut field.indices;
    let before = [EULER, COMPONENTS].map(|index| indices[index]);
    let counted = COUNTED.map(|index| indices[index]);
    if now == counted {
        indices[WANDERED] = 0;
    } else {
        if before == counted {
            field.values[LEFT] = time;
        }
        indices[WANDERED] += 1;
        if now == before || indices[WANDERED] >= LONGEST {
            indices[EVENTS] += 1;
            indices[WANDERED] = 0;
            field.values[CHANGED] = field.values[LEFT];
            COUNTED.into_iter().zip(now).for_each(|(index, now)| indices[index] = now);
        }
    }
    [EULER, COMPONENTS].into_iter().zip(now).for_each(|(index, now)| indices[index] = now);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::skin::{HEAD, HEAD_INDICES};

    /// Times at which changes began, of topologies one after the other, a second apart.
    fn changes(topologies: &[[u64; 2]]) -> Vec<f64> {
        let mut field = FieldState { values: vec![0.0; HEAD], indices: vec![0; HEAD_INDICES] };
        for (index, first) in [EULER, COMPONENTS].into_iter().chain(COUNTED).zip(topologies[0].repeat(2)) {
            field.indices[index] = first;
        }
        let mut times = Vec::new();
        for (second, topology) in topologies.iter().enumerate().skip(1) {
            let before = field.indices[EVENTS];
            note(&mut field, *topology, second as f64);
            if field.indices[EVENTS] > before {
                times.push(field.values[CHANGED]);
            }
        }
        times
    }

    /// A state that is there for one step counts with the one after it, or not at all where it goes back.
    #[test]
    fn what_is_there_for_a_step_counts_once() {
        let (ball, ring, bubble) = ([2, 1], [0, 1], [4, 2]);
        assert_eq!(changes(&[ball, ball, ring, ring, ring, ball, ball]), [2.0, 5.0]);
        assert_eq!(changes(&[ring, bubble, ball, ball]), [1.0]);
        assert_eq!(changes(&[ball, ring, ball, ball, ring, ring]), [4.0]);
        assert_eq!(changes(&[ring, ring, bubble, bubble, ball, ball]), [2.0, 4.0]);
        // the last step of a run is not known to stand
        assert!(changes(&[ball, ball, ring]).is_empty());
    }

    /// A spray, of which no two surfaces in a row are alike, counts as often as it has lasted so long; what returns does not.
    #[test]
    fn what_never_stands_counts_too() {
        let drops = |count: u64| [2 * count, count];
        let spray: Vec<[u64; 2]> = (1..=2 + 2 * LONGEST).map(drops).collect();
        assert_eq!(changes(&spray), [1.0, 1.0 + LONGEST as f64]);
        let returns: Vec<[u64; 2]> = (0..6 * LONGEST).map(|k| drops(1 + k % (LONGEST - 1))).collect();
        assert!(changes(&returns).is_empty());
    }
}
