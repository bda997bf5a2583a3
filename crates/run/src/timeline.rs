//! Timelines as files, which trace viewers draw: `chrome://tracing`, Perfetto.

use std::io::Write;
use std::path::Path;

use serde_json::json;
use souple_engine::Timeline;
use souple_io::IoError;

/// Writes a timeline in the format of trace events: complete events in microseconds, and the names of threads.
///
/// # Errors
/// The file cannot be written.
pub fn write_timeline(path: &Path, timeline: &Timeline) -> Result<(), IoError> {
    souple_io::write_file(path, |out| write_events(out, timeline))
}

/// One event after the other: a million of them as one document would be a gigabyte.
fn write_events(out: &mut dyn Write, timeline: &Timeline) -> std::io::Result<()> {
    let told = json!({"version": env!("CARGO_PKG_VERSION"), "left_out": timeline.left_out()});
    write!(out, r#"{{"displayTimeUnit":"ms","otherData":{told},"traceEvents":["#)?;
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
    for (number, event) in named.chain(spans).enumerate() {
        let before = if number == 0 { "" } else { "," };
        write!(out, "{before}\n{event}")?;
    }
    writeln!(out, "\n]}}")
}

#[cfg(test)]
mod tests {
    use std::time::Instant;

    use serde_json::Value;

    use super::*;

    fn document(timeline: &Timeline) -> Value {
        let mut bytes = Vec::new();
        write_events(&mut bytes, timeline).unwrap();
        serde_json::from_slice(&bytes).unwrap()
    }

    /// A timeline on which nothing was noted is a document too.
    #[test]
    fn nothing_is_no_event() {
        assert_eq!(document(&Timeline::begin())["traceEvents"], json!([]));
    }

    /// Every span is an event with a beginning and a length, and every thread has a name.
    #[test]
    fn spans_are_events() {
        let timeline = Timeline::begin();
        let began = Instant::now();
        timeline.note("step", began);
        timeline.note("picture", began);
        let events = document(&timeline);
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
