//! Bodies of levels go on from a snapshot as though nothing had happened: who is at work, what lags, what is cut, how long points stay.

use std::path::Path;

use souple_run::{Control, Options, Outcome, read_snapshot, run};

/// A bar bends under its weight, which ceases: points come, and some go and come again. Followers lag, velocities shorten intervals, and
/// near its end it is cut.
const BAR: &str = r#"
format = 1
[world]
period = "5 ms"
gravity = [0, 0, "-9.81 * step(t, 0.06)"]
[systems.main]
stepper = { name = "staggered", halvings = 6, velocity_jump = "2 cm/s" }
[bodies.bar]
mesh = { generate = "bar", size = [0.3, 0.1, 0.1], cells = [12, 4, 4], element = "tet4" }
material = { name = "st_venant_kirchhoff", youngs_modulus = "40 kPa", poissons_ratio = 0.35, density = 1000 }
damping = { rayleigh_mass = 30 }
[bodies.bar.levels]
coarser = [{ mesh = { generate = "bar", size = [0.3, 0.1, 0.1], cells = [6, 2, 2], element = "tet4" } }]
coupling = "one_way"
loops = "lagged"
refine = 0.008
coarsen = 0.004
cuts = [{ region = { box = [[0.25, 0, 0.075], [0.275, 0.1, 0.1]] }, time = 0.12 }]
[[bodies.bar.pins]]
region = "x_min"
[probes.end]
body = "bar"
region = { nearest = [0.3, 0, 0] }
quantity = "position"
[probes.active]
body = "bar"
quantity = "levels.active"
[probes.toggling]
body = "bar"
quantity = "levels.toggling"
[probes.evaluations]
body = "bar"
quantity = "levels.evaluations"
[run]
duration = "0.2 s"
"#;

fn go(settings: &[&str], options: &Options) -> Outcome {
    let settings: Vec<String> = settings.iter().map(|setting| (*setting).to_owned()).collect();
    let scene = souple_scene::read_text("bar.toml", BAR, Path::new("."), &settings).unwrap();
    run(scene, options, &mut |_| Control::Continue).unwrap()
}

fn with_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(work)
}

/// From any snapshot, before the cut and after it, by any number of threads: the same hashes, the same probes.
#[test]
fn levels_resume_with_all_they_remember() {
    let folder = std::env::temp_dir().join(format!("souple_levels_resume_{}", std::process::id()));
    let options = Options {
        out: Some(folder.clone()),
        hash_every: Some(4),
        snapshot_every: Some(16),
        ..Options::default()
    };
    let whole = with_threads(1, || go(&[], &options));
    for period in [16_u64, 32] {
        let path = folder.join(format!("snapshot_{period:08}.souple"));
        let snapshot = read_snapshot(&path, &whole.report.scene_sha256).unwrap();
        let resumed = with_threads(3, || {
            go(&[], &Options { out: None, snapshot_every: None, resume: Some(snapshot), ..options.clone() })
        });
        let from = |outcome: &Outcome| -> Vec<_> {
            outcome.report.hashes.iter().filter(|hash| hash.0 >= period).cloned().collect()
        };
        assert_eq!(from(&whole), from(&resumed), "hashes from {period} on");
        assert_eq!(whole.world.state(), resumed.world.state());
        for (trace, again) in whole.traces.iter().zip(&resumed.traces) {
            let read = &trace.values[period as usize * trace.components..];
            assert_eq!(read, again.values, "what `{}` reads from {period} on", trace.name);
        }
    }
    std::fs::remove_dir_all(folder).unwrap();
}

/// All of it is in use by the first snapshot, the cut by the second: without any of it the bar is elsewhere.
#[test]
fn all_of_it_is_in_use() {
    let at =
        |settings: &[&str], steps: u64| go(settings, &Options { steps: Some(steps), ..Options::default() });
    let last = |outcome: &Outcome, name: &str| {
        let trace = outcome.traces.iter().find(|trace| trace.name == name).unwrap();
        *trace.values.last().unwrap()
    };
    let first = at(&[], 16);
    assert!(last(&first, "toggling") > 0.0, "no point has come and gone");
    for without in [r#"bodies.bar.levels.loops="activated""#, "systems.main.stepper.velocity_jump=0"] {
        assert_ne!(
            first.world.state().systems[0].q,
            at(&[without], 16).world.state().systems[0].q,
            "{without}"
        );
    }
    let cut = at(&[], 32).world;
    let whole = at(&["bodies.bar.levels.cuts[0].time=99"], 32).world;
    assert_ne!(cut.state().systems[0].q, whole.state().systems[0].q);
}
