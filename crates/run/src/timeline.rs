//! Timelines as files, which trace viewers draw: `chrome://tracing`, Perfetto.

use std::path::Path;

use serde_json::{Value, json};
use souple_engine::Timeline;
use souple_io::IoError;

/// A timeline in the format of trace events: complete events in microseconds, and the names of threads.
pub fn trace_events(timeline: &Timeline) -> Value {
    let named = timeline.threads().into_iter().enumerate().map(|(thread, name)| {
        json!({"name": "thread_name", "ph": "M", "pid": 1, "tid": thread, "args": {"name": name}})
    });
    let spans = timeline.spans().into_iter().map(|span| {
        json!({
            "name": span.name,
            "cat": "souple",
            "ph": "X",
            "pid": 1,
            "tid": span.thread,
            "ts": 1e6 * span.start,
            "dur": 1e6 * span.duration,
        })
    });
    json!({
        "displayTimeUnit": "ms",
        "otherData": {"version": env!("CARGO_PKG_VERSION"), "left_out": timeline.left_out()},
        "traceEvents": named.chain(spans).collect::<Vec<Value>>(),
    })
}

/// # Errors
/// The file cannot be written.
pub fn write_timeline(path: &Path, timeline: &Timeline) -> Result<(), IoError> {
    let document = trace_events(timeline);
    souple_io::write_file(path, |out| writeln!(out, "{document}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Instant;

    /// Every span is an event with a beginning and a length, and every thread has a name.
    #[test]
    fn spans_are_events() {
        let timeline = Timeline::begin();
        let began = Instant::now();
        timeline.note("step", began);
        timeline.note("picture", began);
        let events = trace_events(&timeline);
        let events = events["traceEvents"].as_array().unwrap();
        let complete: Vec<&Value> = events.iter().filter(|event| event["ph"] == "X").collect();
        assert_eq!(events.len(), 3);
        assert_eq!([&complete[0]["name"], &complete[1]["name"]], ["step", "picture"]);
        assert!(
            complete
                .iter()
                .all(|event| event["ts"].as_f64() >= Some(0.0) && event["dur"].as_f64() >= Some(0.0))
        );
        assert!(events[0]["args"]["name"].is_string());
    }
}
