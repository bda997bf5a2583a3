//! Collisions that are detected beside the steps, one period late (Debunne 2000, 5 §5.1).
//!
//! While a system makes the steps of period `n`, a thread of its own looks for what may touch where that period began. What it
//! finds is used from the beginning of period `n + 1` on: no step waits for a search. Until then it is in State, so that what
//! goes on from a snapshot uses the very same, and nothing depends on which thread is ready first.
//!
//! - Pairs say what *may* touch; how deep it does is seen in every step. A search that is late sees as far ahead as two periods go,
//!   and where rows or tools moved by more than it allowed for, steps search anew at once (see [`Force::pairs_are_stale`]): lateness
//!   then costs time, and lets nothing through.
//! - What a tool holds is told one period late: it is that period's way of the tool deeper. The look takes points to be where they
//!   were told to be by the end of the period, or what is told twice would make the surface swing.

use std::ops::Range;
use std::time::Instant;

use rayon::{ThreadPool, ThreadPoolBuilder};
use souple_math::Vec3;

use crate::force::{Configuration, Force, Scratch};
use crate::hand::is_hand_name;
use crate::kept::KeptRef;
use crate::state::{FieldState, Pair, SystemState, merge_pairs, pairs_of, sort_pairs};
use crate::system::{Rows, Surroundings, System, SystemWorkspace};
use crate::timeline::Timeline;

/// When collisions are detected.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Detection {
    /// Where each step of a system begins; what tools hold where each period does.
    #[default]
    EveryStep,
    /// Beside the steps of a period, for the next one.
    OnePeriodLate,
}

/// What was detected where the last period began, for the next one; empty where collisions are detected in every step.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Detected {
    /// By ascending keys.
    pub pairs: Vec<Pair>,
    /// Rows where it was looked [m]; none where the last period had to search anew: the next one begins with a search.
    pub positions: Vec<Vec3>,
    /// When it was looked [s], and the memories of all forces then, those that hold points with what they tell them.
    pub numbers: Vec<f64>,
}

impl Detected {
    pub(crate) fn copy_from(&mut self, other: &Self) {
        self.pairs.clone_from(&other.pairs);
        self.positions.clone_from(&other.positions);
        self.numbers.clone_from(&other.numbers);
    }

    fn time(&self) -> f64 {
        self.numbers.first().copied().unwrap_or_default()
    }

    fn memory(&self, range: Range<usize>) -> &[f64] {
        &self.numbers[1 + range.start..1 + range.end]
    }
}

/// Detects the collisions of one system beside its steps.
pub(crate) struct Detector {
    /// `None` where there is none to be had: it is looked after the steps then, with the same result.
    thread: Option<ThreadPool>,
    /// Of each force that detects anything; steps work with others.
    scratches: Vec<Option<Scratch>>,
    scene: Scene,
    found: Vec<Pair>,
    /// When it was looked, and memories of forces after their looks.
    looked: Vec<f64>,
    /// Searches of pairs that the steps have made by the beginning of the period.
    searches: u64,
}

/// A system as it stands where a period begins.
#[derive(Default)]
struct Scene {
    rows: Rows,
    /// Where points are told to be when the period ends [m].
    expected: Vec<Vec3>,
    /// Memories and pairs.
    state: SystemState,
    driven: Vec<f64>,
}

/// Whether a force has anything to detect.
fn detects(force: &dyn Force) -> bool {
    force.declaration().changing_pattern || force.holding().is_some()
}

impl Detector {
    /// `None` where no force of the system detects anything.
    pub(crate) fn of(system: &System) -> Option<Self> {
        if !system.detects() {
            return None;
        }
        let thread = ThreadPoolBuilder::new().num_threads(1).thread_name(|_| "collisions".to_owned()).build();
        let mut detector = Self {
            thread: thread.ok(),
            scratches: Vec::new(),
            scene: Scene::default(),
            found: Vec::new(),
            looked: Vec::new(),
            searches: 0,
        };
        detector.fit(system);
        Some(detector)
    }

    /// A scratch for each force: those of hands and tools, which come and go behind all others, are made anew.
    pub(crate) fn fit(&mut self, system: &System) {
        let first_hand = system.forces.iter().position(|force| is_hand_name(force.name()));
        self.scratches.truncate(first_hand.unwrap_or(system.forces.len()));
        let new = system.forces[self.scratches.len()..].iter();
        self.scratches.extend(new.map(|force| detects(force.as_ref()).then(|| force.new_scratch())));
    }

    /// Takes what was detected in the period before into the state, and looks at where this one begins; rows are placed there.
    pub(crate) fn begin(
        &mut self,
        system: &System,
        ws: &mut SystemWorkspace,
        state: &mut SystemState,
        around: &Surroundings,
    ) {
        system.take_detected(ws, state, around);
        self.searches = ws.searches;
        let Scene { rows, expected, state: seen, driven } = &mut self.scene;
        rows.positions.clone_from(&ws.rows.positions);
        rows.velocities.clone_from(&ws.rows.velocities);
        rows.time = ws.rows.time;
        seen.memory.clone_from(&state.memory);
        seen.pairs.clone_from(&state.pairs);
        driven.clear();
        driven.extend_from_slice(around.driven);
        expected.clone_from(&rows.positions);
        for (index, force) in system.forces.iter().enumerate() {
            let Some(holding) = force.holding() else { continue };
            holding.visit_told(&state.memory[system.memory_range(index)], &mut |told| {
                if told.is_held {
                    expected[told.row as usize] += told.displacement;
                }
            });
        }
    }

    /// Detects what there is while `step` runs.
    pub(crate) fn beside<T>(
        &mut self,
        system: &System,
        fields: &[FieldState],
        timeline: &Timeline,
        step: impl FnOnce() -> T,
    ) -> T {
        let Some(thread) = self.thread.take() else {
            let stepped = step();
            self.detect(system, fields, timeline);
            return stepped;
        };
        let stepped = thread.in_place_scope(|scope| {
            scope.spawn(|_| self.detect(system, fields, timeline));
            step()
        });
        self.thread = Some(thread);
        stepped
    }

    fn detect(&mut self, system: &System, fields: &[FieldState], timeline: &Timeline) {
        let began = Instant::now();
        let Scene { rows, expected, state, driven } = &self.scene;
        let around = Surroundings { driven, fields, load: 1.0 };
        self.found.clear();
        self.looked.clear();
        self.looked.push(rows.time);
        self.looked.extend_from_slice(&state.memory);
        for (index, (force, scratch)) in system.forces.iter().zip(&mut self.scratches).enumerate() {
            let Some(scratch) = scratch else { continue };
            let at = system.view(index, rows, state, &around);
            let first = self.found.len();
            force.find_pairs(&at, scratch, &mut self.found);
            self.found[first..].iter_mut().for_each(|pair| pair.force = index as u64);
            if let Some(holding) = force.holding() {
                let Range { start, end } = system.memory_range(index);
                let at = Configuration { positions: expected, ..at };
                holding.look(&at, scratch, &mut self.looked[1 + start..1 + end]);
            }
        }
        sort_pairs(&mut self.found);
        timeline.note("collisions", began);
    }

    /// Leaves what was detected in the state for the next period. Where steps had to search anew what was found beside them is
    /// older than what they know.
    pub(crate) fn end(&mut self, ws: &SystemWorkspace, state: &mut SystemState) {
        let Detected { pairs, positions, numbers } = &mut state.detected;
        std::mem::swap(numbers, &mut self.looked);
        pairs.clear();
        positions.clear();
        if ws.searches == self.searches {
            std::mem::swap(pairs, &mut self.found);
            positions.extend_from_slice(&self.scene.rows.positions);
        }
    }

    /// Bytes on the heap, scratches of forces included.
    pub(crate) fn bytes(&self, system: &System) -> usize {
        let Scene { rows, expected, state, driven } = &self.scene;
        let scratches = system.forces.iter().zip(&self.scratches);
        let scratches = scratches.filter_map(|(force, scratch)| Some(force.scratch_bytes(scratch.as_ref()?)));
        scratches.sum::<usize>()
            + size_of::<Vec3>()
                * (rows.positions.capacity() + rows.velocities.capacity() + expected.capacity())
            + size_of::<Pair>() * (state.pairs.capacity() + self.found.capacity())
            + 8 * (state.memory.capacity() + driven.capacity() + self.looked.capacity())
    }
}

impl System {
    /// Whether a force of it has anything to detect.
    pub(crate) fn detects(&self) -> bool {
        self.forces.iter().any(|force| detects(force.as_ref()))
    }

    /// Brings what was detected in the period before to the placed rows; where nothing was, as before the first period and after
    /// edits of forces, looks there.
    fn take_detected(&self, ws: &mut SystemWorkspace, state: &mut SystemState, around: &Surroundings) {
        let detected = std::mem::take(&mut state.detected);
        if detected.numbers.is_empty() {
            self.look(ws, state, around);
        } else {
            for (index, force) in self.forces.iter().enumerate() {
                let Some(holding) = force.holding() else { continue };
                let range = self.memory_range(index);
                holding.take_look(detected.memory(range.clone()), &mut state.memory[range]);
            }
        }
        if self.has_pairs() && detected.positions.is_empty() {
            self.update_pairs(ws, state, around);
        } else if self.has_pairs() {
            self.take_pairs(&detected, ws, state, around);
        }
        state.detected = detected;
    }

    fn take_pairs(
        &self,
        detected: &Detected,
        ws: &mut SystemWorkspace,
        state: &mut SystemState,
        around: &Surroundings,
    ) {
        ws.found_pairs.clone_from(&detected.pairs);
        for (index, force) in self.forces.iter().enumerate() {
            let now = self.view(index, &ws.rows, state, around);
            let searched = Configuration {
                positions: &detected.positions,
                velocities: &[],
                time: detected.time(),
                memory: detected.memory(self.memory_range(index)),
                pairs: &[],
                kept: KeptRef::default(),
                ..now
            };
            force.recall_search(&searched, &mut ws.scratches[index]);
            let own = pairs_of(&ws.found_pairs, index);
            let known = |pair: &Pair| {
                now.pairs.binary_search_by_key(&(pair.a, pair.b), |known| (known.a, known.b)).is_ok()
            };
            for pair in ws.found_pairs[own].iter_mut().filter(|pair| !known(pair)) {
                force.bring_up(&now, pair);
            }
        }
        merge_pairs(&mut state.pairs, &mut ws.found_pairs);
        ws.searched.clone_from(&detected.positions);
    }
}
