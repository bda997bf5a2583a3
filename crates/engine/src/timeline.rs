//! When which thread did what, by the clock: for who wants to see what goes on at the same time.
//!
//! A timeline that nobody asked for keeps nothing. What it keeps is no part of any state and changes none.

use std::collections::{HashMap, VecDeque};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::ThreadId;
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
    /// Spans that are kept at most.
    most: usize,
    noted: Mutex<Noted>,
}

#[derive(Debug, Default)]
struct Noted {
    /// Those that ended last.
    spans: VecDeque<Span>,
    /// Threads may be called alike.
    threads: HashMap<ThreadId, usize>,
    names: Vec<String>,
    left_out: u64,
}

/// Spans that are kept at most, 40 MB of them.
const MOST: usize = 1_000_000;

impl Timeline {
    /// One that keeps what is noted from now on.
    pub fn begin() -> Self {
        Self::of(MOST)
    }

    fn of(most: usize) -> Self {
        Self(Some(Arc::new(Kept { began: Instant::now(), most, noted: Mutex::default() })))
    }

    /// Notes a stage of this thread that ends now. Where there is no more room the one that ended first gives way: what is looked into is, as a
    /// rule, what came last.
    pub fn note(&self, name: &'static str, began: Instant) {
        let Some(kept) = &self.0 else { return };
        let duration = began.elapsed().as_secs_f64();
        let start = began.saturating_duration_since(kept.began).as_secs_f64();
        let current = std::thread::current();
        let mut noted = kept.lock();
        if noted.spans.len() >= kept.most {
            noted.spans.pop_front();
            noted.left_out += 1;
        }
        let thread = noted.index_of(&current);
        noted.spans.push_back(Span { name, thread, start, duration });
    }

    /// All that are kept, in the order in which they ended.
    pub fn spans(&self) -> Vec<Span> {
        self.0.as_ref().map_or_else(Vec::new, |kept| kept.lock().spans.iter().copied().collect())
    }

    /// The names of threads, of which several may have the same.
    pub fn threads(&self) -> Vec<String> {
        self.0.as_ref().map_or_else(Vec::new, |kept| kept.lock().names.clone())
    }

    /// Spans that gave way to later ones.
    pub fn left_out(&self) -> u64 {
        self.0.as_ref().map_or(0, |kept| kept.lock().left_out)
    }
}

impl Noted {
    fn index_of(&mut self, thread: &std::thread::Thread) -> usize {
        let names = &mut self.names;
        *self.threads.entry(thread.id()).or_insert_with(|| {
            names.push(thread.name().unwrap_or("unnamed").to_owned());
            names.len() - 1
        })
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

    /// Threads that are called alike are told apart.
    #[test]
    fn names_are_not_threads() {
        let timeline = Timeline::begin();
        for _ in 0..2 {
            let own = timeline.clone();
            let work = move || own.note("work", Instant::now());
            std::thread::Builder::new().name("client".to_owned()).spawn(work).unwrap().join().unwrap();
        }
        assert_eq!(timeline.threads(), ["client", "client"]);
        let of: Vec<usize> = timeline.spans().iter().map(|span| span.thread).collect();
        assert_eq!(of, [0, 1]);
    }

    /// A full timeline keeps what came last, and counts what gave way.
    #[test]
    fn the_latest_are_kept() {
        let timeline = Timeline::of(2);
        for name in ["a", "b", "c", "d", "e"] {
            timeline.note(name, Instant::now());
        }
        let names: Vec<&str> = timeline.spans().iter().map(|span| span.name).collect();
        assert_eq!((names, timeline.left_out()), (vec!["d", "e"], 3));
    }
}
