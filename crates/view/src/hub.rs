//! What the world says to its pages: everything in words, of pictures the latest.
//!
//! The simulation only ever puts things down here. Each page takes them at its own pace: documents wait in a queue, of
//! frames the newest replaces the one before, and a page that has not seen what it was sent is sent no more.

use std::collections::{BTreeMap, VecDeque};
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use serde_json::Value;
use souple_engine::Timeline;

use crate::protocol::Samples;

/// Number of a page.
pub type PageId = u32;

/// Something to be sent.
#[derive(Clone, Debug)]
pub enum Outgoing {
    Text(Arc<str>),
    Binary(Arc<[u8]>),
    /// Bytes of the protocol below: answers to pings, farewells.
    Raw(Vec<u8>),
}

/// Documents that may wait for a page; one with more is gone or stuck. A scene of thousands of bodies is as many.
const DOCUMENTS_MAX: usize = 16 * 1024;
/// Frames under way to a page that it has not seen.
const IN_FLIGHT_MAX: u32 = 2;

/// All pages.
#[derive(Default)]
pub struct Hub {
    pages: Mutex<BTreeMap<PageId, Arc<Outbox>>>,
    next: AtomicU32,
    samples: Mutex<Samples>,
    health: Mutex<Value>,
    timeline: Timeline,
}

/// What waits for one page.
pub struct Outbox {
    state: Mutex<Waiting>,
    ready: Condvar,
}

#[derive(Default)]
struct Waiting {
    documents: VecDeque<Outgoing>,
    frame: Option<Arc<[u8]>>,
    in_flight: u32,
    /// The first sample that it has not been sent.
    next_sample: u64,
    /// Whether it was told what is shown: frames before that say nothing to it.
    is_welcome: bool,
    is_closed: bool,
}

/// What a page's writer is to do next.
pub enum Next {
    Send(Outgoing),
    /// Nothing for a while: see whether the page is still there.
    Ping,
    Close,
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    // nothing is left half done under these locks
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Hub {
    /// One whose threads are noted on a timeline.
    pub fn noted_on(timeline: Timeline) -> Self {
        Self { timeline, ..Self::default() }
    }

    /// Who did what when.
    pub fn timeline(&self) -> &Timeline {
        &self.timeline
    }

    pub fn join(&self) -> (PageId, Arc<Outbox>) {
        let id = self.next.fetch_add(1, Ordering::Relaxed);
        let outbox = Arc::new(Outbox { state: Mutex::default(), ready: Condvar::new() });
        lock(&self.pages).insert(id, Arc::clone(&outbox));
        (id, outbox)
    }

    /// From now on a page gets what all pages get.
    pub fn welcome(&self, page: PageId) {
        if let Some(outbox) = lock(&self.pages).get(&page) {
            lock(&outbox.state).is_welcome = true;
        }
    }

    pub fn leave(&self, page: PageId) {
        if let Some(outbox) = lock(&self.pages).remove(&page) {
            outbox.close();
        }
    }

    pub fn page_count(&self) -> usize {
        lock(&self.pages).len()
    }

    /// To one page.
    pub fn tell(&self, page: PageId, document: Outgoing) {
        if let Some(outbox) = lock(&self.pages).get(&page) {
            outbox.push(document);
        }
    }

    /// To all pages.
    pub fn tell_all(&self, document: &Outgoing) {
        for outbox in lock(&self.pages).values().filter(|outbox| lock(&outbox.state).is_welcome) {
            outbox.push(document.clone());
        }
    }

    /// The newest picture, to all pages.
    pub fn show(&self, frame: &Arc<[u8]>) {
        for outbox in lock(&self.pages).values() {
            let mut state = lock(&outbox.state);
            if state.is_welcome {
                state.frame = Some(Arc::clone(frame));
                outbox.ready.notify_one();
            }
        }
    }

    /// The samples, to be added to or begun anew.
    pub fn samples(&self) -> MutexGuard<'_, Samples> {
        lock(&self.samples)
    }

    pub fn set_health(&self, health: Value) {
        *lock(&self.health) = health;
    }

    pub fn health(&self) -> Value {
        lock(&self.health).clone()
    }
}

impl Outbox {
    pub fn push(&self, document: Outgoing) {
        let mut state = lock(&self.state);
        state.documents.push_back(document);
        state.is_closed |= state.documents.len() > DOCUMENTS_MAX;
        self.ready.notify_one();
    }

    /// The page has drawn a frame.
    pub fn seen(&self) {
        let mut state = lock(&self.state);
        state.in_flight = state.in_flight.saturating_sub(1);
        self.ready.notify_one();
    }

    pub fn close(&self) {
        lock(&self.state).is_closed = true;
        self.ready.notify_one();
    }

    /// Waits for something to send: frames that it may not send yet do not count.
    pub fn next(&self, hub: &Hub, patience: Duration) -> Next {
        let deadline = Instant::now() + patience;
        let mut state = lock(&self.state);
        loop {
            if let Some(document) = state.documents.pop_front() {
                return Next::Send(document);
            }
            if state.is_closed {
                return Next::Close;
            }
            if state.in_flight < IN_FLIGHT_MAX
                && let Some(frame) = state.frame.take()
            {
                state.in_flight += 1;
                // samples go with pictures, all of them, however many pictures were left out
                let mut next_sample = state.next_sample;
                if let Some(samples) = hub.samples().since(&mut next_sample) {
                    state.documents.push_back(Outgoing::Binary(samples));
                }
                state.next_sample = next_sample;
                return Next::Send(Outgoing::Binary(frame));
            }
            let left = deadline.saturating_duration_since(Instant::now());
            if left.is_zero() {
                return Next::Ping;
            }
            (state, _) = self.ready.wait_timeout(state, left).unwrap_or_else(PoisonError::into_inner);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame(number: u8) -> Arc<[u8]> {
        Arc::from([number].as_slice())
    }

    fn sent(outbox: &Outbox, hub: &Hub) -> Option<u8> {
        match outbox.next(hub, Duration::from_millis(1)) {
            Next::Send(Outgoing::Binary(bytes)) => bytes.first().copied(),
            _ => None,
        }
    }

    /// A page that has not seen two frames gets no third; when it has, it gets the newest; documents all come.
    #[test]
    fn slow_pages_get_the_newest_frame_and_every_document() {
        let hub = Hub::default();
        let (page, outbox) = hub.join();
        hub.show(&frame(0));
        assert_eq!(sent(&outbox, &hub), None, "not yet welcome");
        hub.welcome(page);
        for number in 1..=2 {
            hub.show(&frame(number));
            assert_eq!(sent(&outbox, &hub), Some(number));
        }
        for number in 3..=9 {
            hub.show(&frame(number));
            hub.tell(page, Outgoing::Binary(frame(100 + number)));
        }
        for number in 3..=9 {
            assert_eq!(sent(&outbox, &hub), Some(100 + number));
        }
        assert_eq!(sent(&outbox, &hub), None);
        outbox.seen();
        assert_eq!(sent(&outbox, &hub), Some(9));
        hub.leave(page);
        assert!(matches!(outbox.next(&hub, Duration::from_millis(1)), Next::Close));
    }

    /// Before a page is welcome, which it is when it was described the world, it gets neither pictures nor samples; with the first picture
    /// after that it gets all samples.
    #[test]
    fn samples_wait_for_the_description() {
        let hub = Hub::default();
        let (page, outbox) = hub.join();
        hub.samples().begin(7, 1);
        hub.samples().push(&[0.5]);
        hub.show(&frame(0));
        hub.tell(page, Outgoing::Binary(frame(100)));
        assert_eq!(sent(&outbox, &hub), Some(100), "the description");
        assert_eq!(sent(&outbox, &hub), None, "what was shown before it");
        hub.welcome(page);
        hub.samples().push(&[1.5]);
        hub.show(&frame(1));
        assert_eq!(sent(&outbox, &hub), Some(1));
        let Next::Send(Outgoing::Binary(samples)) = outbox.next(&hub, Duration::from_millis(1)) else {
            panic!("no samples");
        };
        assert_eq!(Some(samples), hub.samples().since(&mut 0));
    }

    /// A page that draws nothing, as hidden ones do, is asked whether it is there while frames go on.
    #[test]
    fn silent_pages_are_asked() {
        let hub = Arc::new(Hub::default());
        let (page, outbox) = hub.join();
        hub.welcome(page);
        for number in 0..IN_FLIGHT_MAX {
            hub.show(&frame(number as u8));
            assert!(sent(&outbox, &hub).is_some());
        }
        let frames = Arc::clone(&hub);
        let shows = std::thread::spawn(move || {
            while frames.page_count() > 0 {
                frames.show(&frame(9));
                std::thread::yield_now();
            }
        });
        assert!(matches!(outbox.next(&hub, Duration::from_millis(20)), Next::Ping));
        hub.leave(page);
        shows.join().unwrap();
    }

    #[test]
    fn a_stuck_page_is_given_up() {
        let hub = Hub::default();
        let (page, outbox) = hub.join();
        hub.welcome(page);
        let note = Outgoing::Text(Arc::from("note"));
        for _ in 0..=DOCUMENTS_MAX {
            hub.tell_all(&note);
        }
        assert!(lock(&outbox.state).is_closed);
    }
}
