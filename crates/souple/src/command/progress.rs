//! Progress of long work: a bar on a terminal, a line every few seconds elsewhere, nothing where it is to be quiet.

use std::fmt::Display;
use std::sync::Mutex;
use std::sync::mpsc::{self, RecvTimeoutError, Sender};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use super::{on_terminal, print_note};

const TICK: Duration = Duration::from_millis(120);
/// Time between lines.
const LINES: Duration = Duration::from_secs(5);

/// Tells that work goes on of which nobody knows how long it takes: turning on a terminal, by a line now and then elsewhere.
pub struct Pulse {
    bar: ProgressBar,
    /// Ends the lines when dropped; `None` where none are written.
    _lines: Option<Sender<()>>,
}

impl Pulse {
    pub fn new(work: &'static str, quiet: bool) -> Self {
        let is_drawn = !quiet && on_terminal();
        let target = if is_drawn { ProgressDrawTarget::stderr() } else { ProgressDrawTarget::hidden() };
        let bar = ProgressBar::with_draw_target(None, target);
        if let Ok(style) = ProgressStyle::with_template("{spinner} {msg}  {elapsed}") {
            bar.set_style(style);
        }
        bar.set_message(work);
        bar.enable_steady_tick(TICK);
        Self { bar, _lines: (!quiet && !is_drawn).then(|| Self::lines(work)) }
    }

    /// Lines after ever longer times, until the other end is dropped.
    fn lines(work: &'static str) -> Sender<()> {
        let (running, end) = mpsc::channel();
        std::thread::spawn(move || {
            let (start, mut wait) = (Instant::now(), LINES);
            while end.recv_timeout(wait) == Err(RecvTimeoutError::Timeout) {
                print_note(format_args!("{work}, for {} s so far", start.elapsed().as_secs()));
                wait *= 2;
            }
        });
        running
    }
}

impl Drop for Pulse {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

/// Tells how far some work is.
pub struct Meter {
    bar: ProgressBar,
    /// What is counted: `steps`.
    unit: &'static str,
    /// When the next line is due; `None` where none is written.
    next_line: Option<Mutex<Instant>>,
}

impl Meter {
    pub fn new(unit: &'static str, quiet: bool) -> Self {
        let is_drawn = !quiet && on_terminal();
        let target = if is_drawn { ProgressDrawTarget::stderr() } else { ProgressDrawTarget::hidden() };
        let bar = ProgressBar::with_draw_target(None, target);
        let template = format!("{{bar:32}} {{pos}}/{{len}} {unit}  {{msg}}  {{elapsed}} left {{eta}}");
        if let Ok(style) = ProgressStyle::with_template(&template) {
            bar.set_style(style);
        }
        let next_line = (!quiet && !is_drawn).then(|| Mutex::new(Instant::now() + LINES));
        Self { bar, unit, next_line }
    }

    /// `done` of `all` is done; `message` says more, or nothing.
    pub fn show(&self, done: u64, all: u64, message: impl Display) {
        self.bar.set_length(all);
        self.bar.set_position(done);
        let message = message.to_string();
        // a line that another thread is writing is line enough
        if let Some(Ok(mut next)) = self.next_line.as_ref().map(Mutex::try_lock)
            && Instant::now() >= *next
        {
            *next = Instant::now() + LINES;
            let more = if message.is_empty() { String::new() } else { format!(", {message}") };
            print_note(format_args!("{done}/{all} {}{more}", self.unit));
        }
        self.bar.set_message(message);
    }
}

impl Drop for Meter {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
