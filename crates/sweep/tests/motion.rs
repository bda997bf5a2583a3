//! Commands that bring a scene to key states with the least effort (JIM-97, PA-45).

use std::path::{Path, PathBuf};

use souple_engine::Interruption;
use souple_sweep::{Ending, FoundMotion, Planner, Seen, Study, SweepError};

pub fn study(scene: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes").join(scene).join("motion.toml")
}

/// The study of a scene with some words in the place of others.
pub fn plan(scene: &str, changes: &[(&str, &str)]) -> Result<FoundMotion, SweepError> {
    let path = study(scene);
    let mut text = std::fs::read_to_string(&path).unwrap();
    for (from, to) in changes {
        assert!(text.contains(from), "{from}");
        text = text.replace(from, to);
    }
    let study = Study::parse(&path, &text, |_| unreachable!("a plan reads no table"))?;
    let (motion, stop) = (study.motion.as_ref().expect("a plan"), Interruption::default());
    let found = Planner { study: &study, motion, count: 2, stop: &stop }.run(&|_| {})?;
    Ok(found.expect("not interrupted"))
}

/// The study of `planned_cart` with some words in the place of others, in its scene and in itself, in a folder of its own.
fn plan_of_changed(
    folder: &str,
    scene: &[(&str, &str)],
    changes: &[(&str, &str)],
    count: usize,
) -> Result<FoundMotion, SweepError> {
    let changed = |mut text: String, changes: &[(&str, &str)]| {
        for (from, to) in changes {
            assert!(text.contains(from), "{from}");
            text = text.replace(from, to);
        }
        text
    };
    let path = study("planned_cart");
    let text = changed(std::fs::read_to_string(&path).unwrap(), changes);
    let scene = changed(std::fs::read_to_string(path.with_file_name("scene.toml")).unwrap(), scene);
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("plans").join(folder);
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("scene.toml"), scene).unwrap();
    let study = Study::parse(&folder.join("motion.toml"), &text, |_| unreachable!("a plan reads no table"))?;
    let (motion, stop) = (study.motion.as_ref().expect("a plan"), Interruption::default());
    let found = Planner { study: &study, motion, count, stop: &stop }.run(&|_| {})?;
    Ok(found.expect("not interrupted"))
}

/// Commands of the first control, as the file beside the study has them.
fn committed(scene: &str) -> Vec<f64> {
    let text = std::fs::read_to_string(study(scene).with_extension("plan.csv")).unwrap();
    text.lines().skip(1).map(|line| line.split(',').nth(1).unwrap().parse().unwrap()).collect()
}

/// Of a cart from rest to rest, `x_N = h²/m Σ (N − n − 1/2) u_n = d` and `Σ u_n = 0`: the least `Σ u²` is on a straight line,
/// `u_n = λ ((N − 1)/2 − n)`, `λ = 12 m d/(h² N (N² − 1))`, which costs `12 m² d²/(T³ (1 − 1/N²))`.
#[test]
fn a_cart_comes_to_rest_at_the_least_effort() {
    let found = plan("planned_cart", &[]).unwrap();
    let (mass, count, period) = (2.0, 100.0, 0.02);
    let slope = 12.0 * mass / (period * period * count * (count * count - 1.0));
    let (name, commands) = &found.commands[0];
    assert_eq!((name.as_str(), commands.len()), ("cart.drive", 100));
    for (n, command) in commands.iter().enumerate() {
        let exact = slope * ((count - 1.0) / 2.0 - n as f64);
        // differences of a linear step are as wrong as rounding over their length, 1e-16/6e-6; summed over as many periods
        assert!((command - exact).abs() < 1e-8, "{n}: {command}, not {exact}");
    }
    let cost = 12.0 * mass * mass / (8.0 * (1.0 - 1.0 / (count * count)));
    assert!((found.cost / cost - 1.0).abs() < 1e-8, "{} of {cost}", found.cost);
    // a linear network: the first step is the answer, the second finds that it is
    assert_eq!((found.ending, found.iterations), (Ending::Converged, 2));
    for (n, (command, kept)) in commands.iter().chain(&[0.0]).zip(committed("planned_cart")).enumerate() {
        assert!((command - kept).abs() < 1e-8, "{n}: {command}, not {kept}");
    }
}

/// A load on a rope is carried beyond small angles, and reaches its keys; what is found is what is committed.
#[test]
fn a_crane_carries_its_load_to_rest() {
    let found = plan("crane", &[]).unwrap();
    assert_eq!(found.ending, Ending::Converged, "{:?} after {}", found.ending, found.iterations);
    for (reached, value) in found.reached.iter().zip([3.0, 0.0, 3.0, 0.0]) {
        // commands changed by a millionth at most in the last step, of which keys see the square
        assert!((reached - value).abs() < 1e-6, "{reached}, not {value}");
    }
    let kept = committed("crane");
    let greatest = kept.iter().fold(0.0_f64, |most, command| most.max(command.abs()));
    for (n, (command, kept)) in found.commands[0].1.iter().chain(&[0.0]).zip(&kept).enumerate() {
        // both are within a step of the least, of a millionth of the commands, that converges at a rate of a half or better
        assert!((command - kept).abs() < 1e-4 * greatest, "{n}: {command}, not {kept}");
    }
}

/// An interruption finds nothing, and is no fault of the study.
#[test]
fn plans_are_interrupted() {
    let (study, stop) = (Study::read(&study("planned_cart")).unwrap(), Interruption::default());
    stop.wish();
    let motion = study.motion.as_ref().expect("a plan");
    let found = Planner { study: &study, motion, count: 1, stop: &stop }.run(&|_| {});
    assert!(found.unwrap().is_none());
}

/// What cannot be planned is named, with what would do.
#[test]
fn what_cannot_be_planned_is_named() {
    let speed_twice = "probe = \"speed\"\nvalue = 0\n[[plan.keys]]\ntime = 2\nprobe = \"speed\"\nvalue = 1";
    for (from, to, words) in [
        ("\"spacetime\"", "\"timespace\"", "`plan.kind` is \"timespace\"; expected \"spacetime\""),
        (
            "probe = \"speed\"",
            "probe = \"haste\"",
            "`plan.keys[1].probe` is haste; expected a probe: place, speed",
        ),
        (
            "probe = \"speed\"",
            "probe = \"speed.x\"",
            "`plan.keys[1].probe` is speed.x; expected speed, a scalar",
        ),
        (
            "time = 2",
            "time = 2.001",
            "`plan.keys[0].time` is 2.001; expected a whole number of periods of 0.02 s",
        ),
        ("time = 2", "time = -2", "`plan.keys[0].time` is -2; expected seconds above 0"),
        ("value = 1", "value = \"far\"", "`plan.keys[0].value` is \"far\"; expected a finite number"),
        (
            "probe = \"speed\"\nvalue = 0",
            speed_twice,
            "`plan.keys[2]` is what no command changes, or what other keys say",
        ),
        // a force of a period gives a place or a speed
        ("time = 2", "time = 0.02", "`plan.keys[1]` is what no command changes, or what other keys say"),
        (
            "value = 1",
            "value = 3",
            "no motion near at hand meets all keys within 5 N of `cart.drive`: `plan.keys[0]` asks for `place` to be 3 m at 2 s, and it \
             comes to 2.500000e0 m, 5.000000e-1 m short",
        ),
        (
            "value = 1",
            "least = 2\nmost = 1",
            "`plan.keys[0]` is at least 2 and at most 1; expected `least` below",
        ),
        (
            "value = 1",
            "value = 1\nleast = 1",
            "`plan.keys[0].value` is 1; expected a `value`, or `least` and `most`",
        ),
        ("value = 1", "most = \"far\"", "`plan.keys[0].most` is \"far\"; expected a finite number"),
        (
            "time = 2",
            "from = 2\nuntil = 1",
            "`plan.keys[0]` is from 2 s until 1 s; expected `from` before `until`",
        ),
        (
            "time = 2",
            "from = 1.005\nuntil = 1.015",
            "in which no period ends; expected a span with a multiple of 0.02 s",
        ),
        ("time = 2", "from = 1", "`plan.keys[0].until` is missing; expected seconds above 0"),
        (
            "time = 2",
            "time = 2\nfrom = 1",
            "`plan.keys[0].time` is 2; expected a `time`, or `from` and `until`",
        ),
        (
            "time = 2",
            "from = 1\nuntil = 1e9",
            "`plan.keys[0].until` is 1000000000; expected at most 1000000 periods",
        ),
        ("kind =", "windows = []\nkind =", "`plan.windows` is []; expected a list of"),
        (
            "kind =",
            "windows = [{ from = 2, until = 3 }]\nkind =",
            "`plan.windows[0]` is from 2 s until 3 s, in which no period of the plan begins",
        ),
        (
            "kind =",
            "windows = { length = 1, overlap = 1 }\nkind =",
            "`plan.windows.overlap` is 1; expected seconds",
        ),
        ("kind =", "starts = 0\nkind =", "`plan.starts` is 0; expected a whole number above 0"),
        ("kind =", "seed = 3\nkind =", "`plan.seed` is there beside one start"),
        (
            "time = 2",
            "from = 0\nuntil = 60",
            "`plan.keys` is 6000 keys and 3000 commands that are sought at once; expected at most 2000",
        ),
        ("kind =", "start = \"none.csv\"\nkind =", "none.csv: No such file"),
        ("kind =", "start = \"none.csv\"\nkind =", "expected a plan, as `souple sweep` writes it"),
        ("kind =", "start = \"motion.toml\"\nkind =", "motion.toml: line "),
        (
            "kind =",
            "windows = { length = 0.09, overlap = 0 }\nkind =",
            "`plan.windows.length` is 0.09; expected a whole number of periods of 0.02 s",
        ),
        (
            "kind =",
            "windows = { length = 0.1, overlap = 0.03 }\nkind =",
            "`plan.windows.overlap` is 0.03; expected a whole number of periods of 0.02 s",
        ),
        (
            "kind =",
            "weights = { \"cart.push\" = 2 }\nkind =",
            "`plan.weights` is cart.push; expected a control: cart.drive",
        ),
        ("kind =", "iterations = 0\nkind =", "`plan.iterations` is 0; expected a whole number above 0"),
        ("[plan]", "[vary]\na = [1]\n[plan]", "`vary` is there beside `plan`"),
        ("planned_cart", "commanded_carts", "`scene` is without commands that are planned"),
    ] {
        let named = ("scene = \"scene.toml\"", "scene = \"../planned_cart/scene.toml\"");
        let error = plan("planned_cart", &[named, (from, to)]).map(|_| ()).unwrap_err().to_string();
        assert!(error.contains(words), "{error}");
    }
}

/// A motor of `F` cuts the line off: `u_n = clamp(λ a_n, ±F)`, `a_n = (N − 1)/2 − n`, with `c` commands cut at either end
/// `h²/m · 2 (F Σ_{n<c} a_n + λ Σ_{c≤n<N/2} a_n²) = d`. In the limit it costs `F² (2 τ + 2 b/3)`, `b = √(3 (T²/4 − m d/F))`, `τ = T/2 − b`.
#[test]
fn a_cart_comes_to_rest_within_what_its_motor_gives() {
    let found = plan("bounded_cart", &[]).unwrap();
    let (mass, count, period, way, bound) = (2.0, 100, 0.02, 2.0, 5.0);
    let at = |n: usize| (count - 1) as f64 / 2.0 - n as f64;
    let slope_of = |cut: usize| {
        let of_bound: f64 = (0..cut).map(|n| bound * at(n)).sum();
        let squares: f64 = (cut..count / 2).map(|n| at(n) * at(n)).sum();
        (way * mass / (2.0 * period * period) - of_bound) / squares
    };
    let cut = (0..count / 2).find(|cut| slope_of(*cut) * at(*cut) <= bound).unwrap();
    assert_eq!(cut, 11);
    let mut cost = 0.0;
    for (n, command) in found.commands[0].1.iter().enumerate() {
        let exact = (slope_of(cut) * at(n)).clamp(-bound, bound);
        cost += period * exact * exact;
        // as without a bound
        assert!((command - exact).abs() < 1e-8, "{n}: {command}, not {exact}");
        assert!(command.abs() <= bound);
    }
    assert!((found.cost / cost - 1.0).abs() < 1e-8, "{} of {cost}", found.cost);
    let middle = (3.0_f64 * (1.0 - mass * way / bound)).sqrt();
    let limit = bound * bound * (2.0 * (1.0 - middle) + 2.0 * middle / 3.0);
    // a sum over periods of a curve with corners is off by h² of its curvature
    assert!((found.cost / limit - 1.0).abs() < period * period, "{} of {limit}", found.cost);
    assert_eq!((found.ending, found.iterations), (Ending::Converged, 2));
    for (n, (command, kept)) in
        found.commands[0].1.iter().chain(&[0.0]).zip(committed("bounded_cart")).enumerate()
    {
        assert!((command - kept).abs() < 1e-8, "{n}: {command}, not {kept}");
    }
}

fn assert_same(found: &FoundMotion, other: &FoundMotion, tolerance: f64) {
    for (n, (one, other)) in found.commands[0].1.iter().zip(&other.commands[0].1).enumerate() {
        assert!((one - other).abs() < tolerance, "{n}: {one}, not {other}");
    }
}

/// A band with room asks for nothing; one that is reached asks for its side, at one time or as long as it lasts.
#[test]
fn bands_ask_for_as_much_as_they_hold() {
    let with = |key: &str| {
        let text = format!("kind = \"spacetime\"\n[[plan.keys]]\nprobe = \"place\"\n{key}");
        plan("planned_cart", &[("kind = \"spacetime\"", &text)]).unwrap()
    };
    let free = plan("planned_cart", &[]).unwrap();
    // halfway after a second, by symmetry; differences of a linear step tell commands to 1e-8
    assert_same(&with("time = 1\nleast = 0.4\nmost = 0.6"), &free, 1e-8);
    assert_same(&with("time = 1\nleast = 0.6"), &with("time = 1\nvalue = 0.6"), 1e-8);
    assert_same(&with("time = 1\nleast = 0.1\nmost = 0.3"), &with("time = 1\nvalue = 0.3"), 1e-8);
    assert_same(&with("from = 0\nuntil = 2\nmost = 1.1\nleast = -0.1"), &free, 1e-8);
    // ¾ m/s at most in the middle without a bound; with one it goes at it, without a force
    let slow = "kind = \"spacetime\"\n[[plan.keys]]\nprobe = \"speed\"\nfrom = 0\nuntil = 2\nmost = 0.6";
    let slow = plan("planned_cart", &[("kind = \"spacetime\"", slow)]).unwrap();
    assert_eq!(slow.ending, Ending::Converged);
    assert!((slow.reached[0] - 0.6).abs() < 1e-9, "{:?}", slow.reached);
    let commands = &slow.commands[0].1;
    assert!(commands[45..55].iter().all(|command| command.abs() < 1e-7), "{:?}", &commands[45..55]);
    assert!(slow.cost > free.cost);
}

/// Windows that overlap come to the answer of the whole; a window alone changes nothing outside.
#[test]
fn windows_come_to_the_answer_of_the_whole() {
    let with = |windows: &str| {
        let kind = format!("windows = {windows}\niterations = 500\ntolerance = 1e-7\nkind = ");
        plan("bounded_cart", &[("kind = ", &kind)]).unwrap()
    };
    let whole = plan("bounded_cart", &[]).unwrap();
    for windows in
        ["{ length = 1.2, overlap = 0.8 }", "[{ from = 0.6, until = 2 }, { from = 0, until = 1.4 }]"]
    {
        let found = with(windows);
        assert_eq!(found.ending, Ending::Converged, "{windows}: {}", found.iterations);
        // a round changed commands by no more than 1e-7 of their length, 50 N, and a round leaves nine tenths at most
        assert_same(&found, &whole, 1e-5);
    }
    let again = "start = \"motion.plan.csv\"\nwindows = [{ from = 0.5, until = 1 }]\nkind = ";
    let key = "value = 2\n[[plan.keys]]\ntime = 0.8\nprobe = \"speed\"\nvalue = 1.5";
    let found = plan("bounded_cart", &[("kind = ", again), ("value = 2", key)]).unwrap();
    for (n, (command, kept)) in found.commands[0].1.iter().zip(committed("bounded_cart")).enumerate() {
        assert!((25..50).contains(&n) || *command == kept, "{n}: {command}, not {kept}");
    }
    assert!(
        (found.reached[1] - 1.5).abs() < 1e-9 && (found.reached[0] - 2.0).abs() < 1e-9,
        "{:?}",
        found.reached
    );
}

/// Windows of 45 periods overlap by 22 where that is left to them.
#[test]
fn windows_of_an_odd_length_overlap_by_half_rounded_down() {
    let with = |windows: &str| {
        let kind = format!("windows = {windows}\niterations = 3\nkind = ");
        plan("planned_cart", &[("kind = ", &kind)]).unwrap().commands
    };
    assert_eq!(with("{ length = 0.9 }"), with("{ length = 0.9, overlap = 0.44 }"));
    assert_ne!(with("{ length = 0.9 }"), with("{ length = 0.9, overlap = 0.46 }"));
    // one of a single period goes on by it
    assert_eq!(with("{ length = 0.02 }"), with("{ length = 0.02, overlap = 0 }"));
}

/// Commands to begin with are those of a file whose last row goes on, where no window has others sought; a row of another date is named.
#[test]
fn starts_of_a_file_are_rows_of_periods() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("plans").join("start");
    let with = |rows: &[(f64, f64)]| {
        std::fs::create_dir_all(&folder).unwrap();
        let rows: String = rows.iter().map(|(date, command)| format!("{date},7,{command}\n")).collect();
        let text = format!("time [s],cart.other [N],cart.drive [N]\n{rows}");
        std::fs::write(folder.join("begin.csv"), text).unwrap();
        let kind = "start = \"begin.csv\"\nwindows = [{ from = 0, until = 0.5 }]\nkind = ";
        // a quarter of the time takes more than the motor gives
        plan_of_changed("start", &[("largest = \"5 N\"\n", "")], &[("kind = ", kind)], 1)
    };
    let mut rows: Vec<(f64, f64)> =
        (0..30).map(|row| (0.02 * f64::from(row), 0.01 * f64::from(row))).collect();
    let found = with(&rows).unwrap();
    for (n, command) in found.commands[0].1.iter().enumerate().skip(25) {
        assert_eq!(*command, rows[n.min(29)].1, "{n}");
    }
    rows.remove(20);
    let message = with(&rows).unwrap_err().to_string();
    assert!(message.contains("begin.csv") && message.contains("line 22 is of 0.42 s"), "{message}");
    assert!(message.contains("0.4 s: a row for each period of 0.02 s"), "{message}");
    let message = with(&[(0.02, 1.0)]).unwrap_err().to_string();
    assert!(message.contains("line 2 is of 0.02 s"), "{message}");
    let message = with(&[]).unwrap_err().to_string();
    assert!(message.contains("it has no rows"), "{message}");
}

/// A gate that is shut from 0.15 m to 0.75 m halfway is passed early or late: `|x − 0.45| ≥ 0.3` at `T/2`, on either side of which the least
/// effort has a cost of its own, `Σ u² = yᵀ (G Gᵀ)⁻¹ y`. The motion at rest is before it, and so one start comes to the dearer.
#[test]
fn several_starts_find_the_better_of_two() {
    let probe = "[probes.gate]\nbody = \"cart\"\nquantity = \"position\"\ncomponent = \"length\"\n\
                 against = { formula = \"[0.45, 0, 0]\" }\n\n[probes.place]";
    let scene = [("largest = \"5 N\"\n", ""), ("[probes.place]", probe)];
    let with = |key: &str, count: usize| {
        let key = format!("kind = \"spacetime\"\n{key}");
        plan_of_changed("gate", &scene, &[("kind = \"spacetime\"", &key)], count).unwrap()
    };
    let gated = |starts: &str, count: usize| {
        with(&format!("{starts}\n[[plan.keys]]\ntime = 1\nprobe = \"gate\"\nleast = 0.3"), count)
    };
    // least effort through a place halfway, with the same keys at the end: one more equality
    let through =
        |place: f64| with(&format!("[[plan.keys]]\ntime = 1\nprobe = \"place\"\nvalue = {place}"), 1).cost;
    let (late, early) = (through(0.15), through(0.75));
    // 12 m² d²/T³ + 192 m² δ²/T³ of a beam that is bent by δ in its middle
    assert!((late / (6.0 + 96.0 * 0.35 * 0.35) - 1.0).abs() < 1e-3 && late > early, "{late} {early}");
    let one = gated("", 1);
    assert!((one.cost / late - 1.0).abs() < 1e-6, "{} of {late}", one.cost);
    let several = gated("starts = 6", 1);
    assert!((several.cost / early - 1.0).abs() < 1e-6, "{} of {early}", several.cost);
    let answers = several.answers();
    assert_eq!(answers.len(), 2, "{answers:?}");
    assert!(answers[0].1 + answers[1].1 == 6 && answers[0].1 > 0 && (answers[1].0 / late - 1.0).abs() < 1e-6);
    // what comes to nothing is told once, with how many starts came to it
    let far = "kind = \"spacetime\"\nstarts = 3\n[[plan.keys]]\ntime = 1\nprobe = \"place\"\nvalue = 100";
    let none = plan("bounded_cart", &[("kind = \"spacetime\"", far)]).unwrap_err().to_string();
    assert!(
        none.contains("none of 3 starts comes to a motion that meets its keys: 3 starts: no motion"),
        "{none}"
    );
    // and each is told when it is over, with what it came to
    let told = std::sync::Mutex::new(Vec::new());
    let watch = |seen: Seen| told.lock().unwrap().extend(seen.starts.map(|starts| (starts, seen.came_to)));
    let path = study("bounded_cart");
    let text = std::fs::read_to_string(&path).unwrap().replace("kind = \"spacetime\"", far);
    let of_far = Study::parse(&path, &text, |_| unreachable!("a plan reads no table")).unwrap();
    let (motion, stop) = (of_far.motion.as_ref().expect("a plan"), Interruption::default());
    assert!(Planner { study: &of_far, motion, count: 1, stop: &stop }.run(&watch).is_err());
    assert_eq!(told.into_inner().unwrap(), [1, 2, 3].map(|over| ([over, 3], None)));
    // the same bits at any number of jobs, and others of another seed
    let at_once = gated("starts = 6", 3);
    assert_eq!((at_once.commands, at_once.attempts), (several.commands, several.attempts.clone()));
    assert_ne!(gated("starts = 6\nseed = 2", 2).attempts, several.attempts);
}

/// The puck goes round its posts on the side that costs less, of two that one start does not choose from; what is found is what is committed.
#[test]
fn a_puck_goes_round_two_posts() {
    let one = plan("two_posts", &[("starts = 8", "starts = 1")]).unwrap();
    let found = plan("two_posts", &[]).unwrap();
    assert_eq!((one.ending, found.ending), (Ending::Converged, Ending::Converged));
    assert!(found.cost < 0.7 * one.cost, "{} and {}", found.cost, one.cost);
    // a change of a millionth of the commands in the last step, that keys are met by
    assert!(found.reached[4] > 0.4 - 1e-6 && found.reached[5] > 0.4 - 1e-6, "{:?}", found.reached);
    let text = std::fs::read_to_string(study("two_posts").with_extension("plan.csv")).unwrap();
    for (row, n) in text.lines().skip(1).zip(0..50) {
        let kept: Vec<f64> = row.split(',').skip(1).map(|cell| cell.parse().unwrap()).collect();
        for (kept, (_, commands)) in kept.iter().zip(&found.commands) {
            assert!((kept - commands[n]).abs() < 1e-4, "{n}: {}, not {kept}", commands[n]);
        }
    }
}

/// A key that a run does not come to, and a control whose actuator pushes what is held, are planned and warned of.
#[test]
fn what_comes_to_nothing_is_warned_of() {
    let post = "[networks.cart.masses.post]\npositions = [[0, 1, 0]]\nmass = 1\nfixed = true\n\n\
                [networks.cart.actuators.other]\nof = \"post\"\ndirection = [1, 0, 0]\nlargest = \"5 N\"\n\n\
                [networks.cart.controls.idle]\nactuator = \"other\"\nplan = \"motion.plan.csv\"\n\n[probes.place]";
    let probes = ("body = \"cart\"", "body = \"cart\"\nregion = \"cart\"");
    let scene = [("[probes.place]", post), probes, ("\"2.5 s\"", "\"1.5 s\"")];
    let found = plan_of_changed("idle", &scene, &[], 1).unwrap();
    let words = [
        "`plan.keys[0]` is at 2 s, and a run of the scene is over after 1.5 s",
        "`plan.keys[1]` is at 2 s, and a run of the scene is over after 1.5 s",
        "no key depends on the commands of `cart.idle`",
    ];
    assert_eq!(found.warnings.len(), words.len(), "{:?}", found.warnings);
    assert!(
        found.warnings.iter().zip(words).all(|(warning, words)| warning.starts_with(words)),
        "{:?}",
        found.warnings
    );
    assert_eq!(found.ending, Ending::Converged);
    assert!(found.commands[1].1.iter().all(|command| *command == 0.0));
    assert_same(&found, &plan("planned_cart", &[]).unwrap(), 1e-8);
}

/// A link that yields on the way makes the next step one that positions and velocities do not tell.
#[test]
fn scenes_that_remember_are_refused() {
    let spring = |traction: &str| {
        format!(
            "[networks.cart.masses.post]\npositions = [[-1, 0, 0]]\nmass = 1\nfixed = true\n\n[[networks.cart.links]]\n\
             law = {{ name = \"elasto_plastic\", stiffness = 5, hardening = 1, traction = {traction} }}\nof = [\"post\", \"cart\"]\n\
             paired = true\n\n[probes.place]"
        )
    };
    let with = |folder: &str, traction: &str| {
        let spring = spring(traction);
        let scene = [
            ("largest = \"5 N\"\n", ""),
            ("body = \"cart\"", "body = \"cart\"\nregion = \"cart\""),
            ("[probes.place]", &spring),
        ];
        // there and back: what a link that yields is stretched to tells its force until it is let go
        let back = "value = 0.2\n[[plan.keys]]\ntime = 1\nprobe = \"place\"\nvalue = 1";
        plan_of_changed(folder, &scene, &[("value = 1", back)], 1)
    };
    let error = with("yields", "2").unwrap_err().to_string();
    assert!(
        error.contains(
            "motion.toml:2:1: `scene` is of steps that follow from what laws or the stepper remember"
        ),
        "{error}"
    );
    // as long as it does not yield it is a spring
    assert_eq!(with("springs", "20").unwrap().ending, Ending::Converged);
}

/// A wall on the way to a key stops the cart, with no way on however it is pushed: the key that is missed is named, and what stands in the way.
#[test]
fn a_wall_on_the_way_is_told() {
    let wall = |place: f64, how: &str| {
        format!(
            "[[networks.cart.constraints]]\nplane = {{ place = [{place}, 0, 0], normal = [-1, 0, 0] }}\nsense = \"at_least\"\n{how}\n[probes.place]"
        )
    };
    let with = |folder: &str, wall: &str| {
        let scene = [("[probes.place]", wall), ("\"verlet\"", "\"symplectic_euler\"")];
        plan_of_changed(folder, &scene, &[], 1)
    };
    for (folder, place, how) in
        [("stopped", 0.7, ""), ("bounced", 0.7, "restitution = 0.5"), ("held", 0.0, "")]
    {
        let found = with(folder, &wall(place, how)).unwrap();
        assert_eq!(found.ending, Ending::Stalled, "{folder}: {:?}", found.warnings);
        let key = "`plan.keys[0]` asks for `place` to be 1 m at 2 s, and it comes to ";
        for words in [key, "stops the motion"] {
            assert!(
                found.warnings.iter().any(|warning| warning.contains(words)),
                "{folder}: {:?}",
                found.warnings
            );
        }
        assert!(found.reached[0] < place + 1e-6, "{folder}: {:?}", found.reached);
    }
}

/// Values of keys have units of what their probe measures; those of another kind, and numbers that cannot be computed with, are refused at their line.
#[test]
fn keys_have_units_and_places() {
    let in_cm = plan("planned_cart", &[("value = 1", "value = \"100 cm\"")]).unwrap();
    assert_same(&in_cm, &plan("planned_cart", &[]).unwrap(), 1e-12);
    for (to, words) in [
        (
            "value = \"100 s\"",
            "`plan.keys[0].value` is \"100 s\"; expected a finite number in m, or with a unit of its kind",
        ),
        ("least = \"1 kg\"", "`plan.keys[0].least` is \"1 kg\"; expected a finite number in m"),
        ("value = 1e200", "expected a finite number, 1e100 at most, or one with its unit"),
    ] {
        let error = plan("planned_cart", &[("value = 1", to)]).map(|_| ()).unwrap_err().to_string();
        // its own line, below that of its table
        let place = format!("motion.toml:{}:1: ", line_of("value = 1"));
        assert!(error.contains(words) && error.contains(&place), "{error}");
    }
    let weights = ("kind =", "weights = { \"cart.drive\" = 1e308 }\nkind =");
    let error = plan("planned_cart", &[weights]).map(|_| ()).unwrap_err().to_string();
    assert!(error.contains("expected a number above 0, 1e100 at most"), "{error}");
}

/// From 1, in the study of `planned_cart`.
fn line_of(words: &str) -> usize {
    let text = std::fs::read_to_string(study("planned_cart")).unwrap();
    1 + text.lines().position(|line| line.contains(words)).unwrap()
}
