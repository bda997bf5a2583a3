//! Commands that bring a scene to key states with the least effort (JIM-97, PA-45).

use std::path::{Path, PathBuf};

use souple_engine::Interruption;
use souple_sweep::{Ending, FoundMotion, Planner, Study, SweepError};

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
    let found = Planner { study: &study, motion, stop: &stop }.run(&mut |_, _, _| {})?;
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
    let found = Planner { study: &study, motion, stop: &stop }.run(&mut |_, _, _| {});
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
            "`plan.keys.probe` is haste; expected a probe: place, speed",
        ),
        (
            "probe = \"speed\"",
            "probe = \"speed.x\"",
            "`plan.keys.probe` is speed.x; expected speed, a scalar",
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
        ("value = 1", "value = 2", "the plan asks for 5.9"),
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
