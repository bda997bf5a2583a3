//! When which thread did what, by the clock: for who wants to see what goes on at the same time.
//!
//! A timeline that nobody asked for keeps nothing. What it keeps is no part of any state and changes none.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Instant;

/// A stage of a thread's work.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    pub name: &'static str,
    /// Index among [`Timeline::threads`].
    pub thread: usize,
    /// Since the timeline began [s].
    pub start: f64,
    /// [s]
    pub duration: f64,
}

/// Spans of all threads; clones share them.
#[derive(Clone, Debug, Default)]
pub struct Timeline(Option<Arc<Kept>>);

#[derive(Debug)]
struct Kept {
    began: Instant,
    noted: Mutex<Noted>,
}

#[derive(Debug, Default)]
struct Noted {
    spans: Vec<Span>,
    /// By their names.
    threads: BTreeMap<String, usize>,
    left_out: u64,
}

/// Spans that are kept at most, 40 MB of them.
const MOST: usize = 1_000_000;

impl Timeline {
    /// One that keeps what is noted from now on.
    pub fn begin() -> Self {
        Self(Some(Arc::new(Kept { began: Instant::now(), noted: Mutex::default() })))
    }

    /// Notes a stage of this thread that ends now.
    pub fn note(&self, name: &'static str, began: Instant) {
        let Some(kept) = &self.0 else { return };
        let duration = began.elapsed().as_secs_f64();
        let start = began.saturating_duration_since(kept.began).as_secs_f64();
        let mut noted = kept.lock();
        if noted.spans.len() >= MOST {
            noted.left_out += 1;
            return;
        }
        let (current, next) = (std::thread::current(), noted.threads.len());
        let called = current.name().unwrap_or("unnamed").to_owned();
        let thread = *noted.threads.entry(called).or_insert(next);
        noted.spans.push(Span { name, thread, start, duration });
    }

    /// All that were noted, in the order in which they ended.
    pub fn spans(&self) -> Vec<Span> {
        self.0.as_ref().map_or_else(Vec::new, |kept| kept.lock().spans.clone())
    }

    /// The names of threads.
    pub fn threads(&self) -> Vec<String> {
        let Some(kept) = &self.0 else { return Vec::new() };
        let mut named: Vec<(usize, String)> =
            kept.lock().threads.iter().map(|(name, index)| (*index, name.clone())).collect();
        named.sort_unstable();
        named.into_iter().map(|(_, name)| name).collect()
    }

    /// Spans for which there was no more room.
    pub fn left_out(&self) -> u64 {
        self.0.as_ref().map_or(0, |kept| kept.lock().left_out)
    }
}

impl Kept {
    fn lock(&self) -> MutexGuard<'_, Noted> {
        // nothing is left half done under this lock
        self.noted.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two threads that work at the same time are seen to: their spans overlap. One that keeps nothing has none.
    #[test]
    fn spans_are_of_their_threads() {
        let timeline = Timeline::begin();
        let both = std::sync::Barrier::new(2);
        std::thread::scope(|scope| {
            for name in ["a", "b"] {
                let (timeline, both) = (timeline.clone(), &both);
                let work = move || {
                    let began = Instant::now();
                    both.wait();
                    timeline.note("work", began);
                };
                std::thread::Builder::new().name(name.to_owned()).spawn_scoped(scope, work).unwrap();
            }
        });
        let (spans, mut threads) = (timeline.spans(), timeline.threads());
        threads.sort_unstable();
        assert_eq!(threads, ["a", "b"]);
        let [first, second] = spans[..] else { panic!("{spans:?}") };
        assert!(first.thread != second.thread);
        assert!(
            first.start <= second.start + second.duration && second.start <= first.start + first.duration
        );
        assert_eq!((Timeline::default().spans(), timeline.left_out()), (Vec::new(), 0));
    }
}
