//! What goes on at the same time.

use std::time::{Duration, Instant};

use serde_json::json;
use souple_engine::{Span, Timeline};

use crate::client::{Page, World};

/// A block whose steps last longer than the time that they make.
const BUSY: &str = r#"
    format = 1
    [world]
    period = "10 ms"
    gravity = [0, 0, -9.81]
    [systems.main]
    stepper = "symplectic_euler"
    steps_per_period = 40
    [bodies.block]
    mesh = { generate = "box", size = [0.1, 0.1, 0.1], cells = [12, 12, 12], element = "tet4" }
    material = { name = "stable_neo_hookean", youngs_modulus = "10 kPa", poissons_ratio = 0.3, density = 1000 }
    [[bodies.block.pins]]
    region = "z_min"
"#;

/// How long must pass at the same time [s]; spans that only meet by rounding do not overlap.
const AT_ONCE: f64 = 1e-6;

fn overlap(a: &Span, b: &Span) -> bool {
    let (start, end) = (a.start.max(b.start), (a.start + a.duration).min(b.start + b.duration));
    end - start > AT_ONCE
}

/// While a picture is made and sent the world steps on: their spans overlap, those of steps and of what is read for pictures never do. What
/// was stepped meanwhile replays bit for bit.
#[test]
fn pictures_are_made_beside_steps() {
    let timeline = Timeline::begin();
    let world = World::noted_on(BUSY, &timeline);
    let mut page = Page::open(&world);
    page.wish(json!({"do": "colour", "field": "von_mises"}));
    let clock = Instant::now();
    let of = |spans: &[Span], name: &str| -> Vec<Span> {
        spans.iter().filter(|span| span.name == name).copied().collect()
    };
    let found = loop {
        page.frame();
        let spans = timeline.spans();
        let (steps, sent) = (of(&spans, "step"), of(&spans, "send"));
        let is_beside = |picture: &Span| steps.iter().any(|step| overlap(picture, step));
        let pictures = of(&spans, "picture");
        if pictures.iter().any(is_beside) && sent.iter().any(is_beside) {
            break spans;
        }
        assert!(clock.elapsed() < Duration::from_secs(60), "{} pictures", pictures.len());
    };
    let (steps, sketches, pictures) = (of(&found, "step"), of(&found, "sketch"), of(&found, "picture"));
    assert!(!sketches.is_empty());
    assert!(sketches.iter().all(|sketch| !steps.iter().any(|step| overlap(sketch, step))));
    assert!(steps.iter().chain(&sketches).all(|span| span.thread == steps[0].thread));
    assert!(pictures.iter().all(|span| span.thread != steps[0].thread));
    page.wish(json!({"do": "pause"}));
    world.assert_replayed();
}

/// A ball that presses a block, whose triangles are looked for beside its steps.
const PRESSED: &str = r#"
    format = 1
    [world]
    period = "10 ms"
    collisions = "one_period_late"
    [systems.main]
    stepper = "symplectic_euler"
    steps_per_period = 40
    [bodies.block]
    mesh = { generate = "box", size = [0.1, 0.1, 0.1], cells = [12, 12, 12], element = "tet4" }
    material = { name = "stable_neo_hookean", youngs_modulus = "10 kPa", poissons_ratio = 0.3, density = 1000 }
    [[bodies.block.pins]]
    region = "z_min"
    [shapes.ball]
    shape = { name = "sphere", centre = [0.05, 0.05, 0.119], radius = 0.02 }
    [[contacts]]
    body = "block"
    shape = "ball"
    detect = "triangles"
    stiffness = "200 N/m"
"#;

/// Collisions are detected on a thread of their own while the world's makes its steps; what was stepped replays bit for bit.
#[test]
fn collisions_are_detected_beside_steps() {
    let timeline = Timeline::begin();
    let world = World::noted_on(PRESSED, &timeline);
    let mut page = Page::open(&world);
    let clock = Instant::now();
    loop {
        page.frame();
        let (spans, threads) = (timeline.spans(), timeline.threads());
        let of = |name: &'static str| spans.iter().filter(move |span| span.name == name);
        assert!(of("collisions").all(|look| threads[look.thread] == "collisions"));
        if of("collisions").any(|look| of("steps").any(|steps| overlap(look, steps))) {
            break;
        }
        assert!(clock.elapsed() < Duration::from_secs(60), "{} looks", of("collisions").count());
    }
    page.wish(json!({"do": "pause"}));
    world.assert_replayed();
}
