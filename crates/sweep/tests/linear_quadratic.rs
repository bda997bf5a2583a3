//! Commands and gains by linear-quadratic control (JIM-97, PA-44).

use souple_sweep::{Ending, FoundMotion};

use crate::motion::{plan, study};

/// What is found is what is committed: as exact as differences of a linear step, of numbers up to `scale`.
fn assert_committed(scene: &str, found: &FoundMotion, scale: f64) {
    let text = std::fs::read_to_string(study(scene).with_extension("plan.csv")).unwrap();
    let mut lines = text.lines();
    let columns = found.columns();
    let names: Vec<&str> = columns.iter().map(|column| column.name.as_str()).collect();
    assert_eq!(lines.next(), Some(names.join(",").as_str()));
    let rows: Vec<Vec<f64>> =
        lines.map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect()).collect();
    for (at, column) in columns.iter().enumerate() {
        assert_eq!(column.values.len(), rows.len());
        for (row, value) in rows.iter().zip(&column.values) {
            assert!((row[at] - value).abs() < 1e-8 * scale, "{}: {value}, not {}", column.name, row[at]);
        }
    }
}

/// Gains, commands and cost are those of the discrete Riccati equation of `x' = x + h v + h² u/2m`, and the motion is what they make.
#[test]
fn a_cart_is_regulated_at_the_least_cost() {
    let found = plan("regulated_cart", &[]).unwrap();
    assert_eq!((found.ending, found.iterations), (Ending::Converged, 2));
    // the recursion in 60 digits; slopes are as exact as differences of a linear step, and so are 300 periods of a law that forgets
    let exact = [9.620_136_807_718_263_f64, 7.549_169_071_540_919];
    let names: Vec<&str> = found.gains.iter().map(|gain| gain.number.as_str()).collect();
    assert_eq!(names, ["cart[0].x", "cart[0].v.x"]);
    for (gain, exact) in found.gains.iter().zip(exact) {
        assert!((gain.gains[0] - exact).abs() < 1e-8 * exact, "{} of {exact}", gain.gains[0]);
    }
    assert!((found.cost / 78.472_574_960_338_17 - 1.0).abs() < 1e-8, "{}", found.cost);
    // without keys nothing but the state asks for commands
    for (n, command) in found.commands[0].1.iter().enumerate() {
        let answer: f64 = found.gains.iter().map(|gain| gain.gains[n] * gain.planned[n]).sum();
        // sought first with commands that differ by 6e-6 m d/T² = 3e-7 N, which speeds of a metre per second, exact to 1e-16, tell h/m from
        // to 1.5e-8: so exact are these, of up to 10 N
        assert!((command + answer).abs() < 1.5e-7, "{n}: {command}, not {answer}");
    }
    assert_committed("regulated_cart", &found, 15.0);
}

/// Of no costs but commands, and keys that are met, it is the motion of spacetime constraints; a key with a price is met as that is high.
#[test]
fn keys_are_met_or_have_a_price() {
    let found = plan("steered_cart", &[]).unwrap();
    assert_eq!((found.ending, found.iterations), (Ending::Converged, 2));
    let (mass, count, period) = (2.0, 100.0, 0.02);
    let slope = 12.0 * mass / (period * period * count * (count * count - 1.0));
    for (n, command) in found.commands[0].1.iter().enumerate() {
        let exact = slope * ((count - 1.0) / 2.0 - n as f64);
        assert!((command - exact).abs() < 1e-8, "{n}: {command}, not {exact}");
    }
    // gains are of two periods to go at the most: m/h²
    assert_committed("steered_cart", &found, mass / (period * period));
    let priced = plan("steered_cart", &[("value = 1", "value = 1\nweight = 30")]).unwrap();
    // of miss ε: 30 ε² + C (1 − ε)² is the least, C = 12 m² d²/(T³ (1 − 1/N²))
    let cost = 12.0 * mass * mass / (8.0 * (1.0 - 1.0 / (count * count)));
    let miss = cost / (cost + 30.0);
    assert!((priced.reached[0] - (1.0 - miss)).abs() < 1e-8, "{:?}, not {}", priced.reached, 1.0 - miss);
    assert!((priced.cost - 30.0 * cost / (30.0 + cost)).abs() < 1e-7, "{}", priced.cost);
    assert!(priced.reached[1].abs() < 1e-9, "{:?}", priced.reached);
}

/// Both kinds look for the same motion of what is not linear, in different ways.
#[test]
fn both_kinds_find_the_same_motion_of_a_crane() {
    let of_spacetime = plan("crane", &[]).unwrap();
    let found = plan("crane", &[("\"spacetime\"", "\"linear_quadratic\"")]).unwrap();
    assert_eq!(found.ending, Ending::Converged);
    for (reached, value) in found.reached.iter().zip([3.0, 0.0, 3.0, 0.0]) {
        // commands changed by a millionth at most in the last step, of which keys see the square
        assert!((reached - value).abs() < 1e-6, "{reached}, not {value}");
    }
    let greatest = of_spacetime.commands[0].1.iter().fold(0.0_f64, |most, command| most.max(command.abs()));
    for (n, (one, other)) in found.commands[0].1.iter().zip(&of_spacetime.commands[0].1).enumerate() {
        // each is within a step of the least, of a millionth of the commands, that converges at a rate of a half or better
        assert!((one - other).abs() < 1e-4 * greatest, "{n}: {one}, not {other}");
    }
}

/// What cannot be planned is named, with what would do.
#[test]
fn what_cannot_be_regulated_is_named() {
    for (from, to, words) in [
        ("duration = 6", "", "`plan.keys` is missing; expected tables `[[plan.keys]]`, or `[[plan.costs]]`"),
        ("duration = 6", "duration = -6", "`plan.duration` is -6; expected seconds above 0"),
        ("duration = 6", "duration = 6.001", "`plan.duration` is 6.001; expected a whole number of periods"),
        ("weight = 100", "weight = 0", "`plan.costs[0].weight` is 0; expected a number above 0"),
        ("weight = 100", "", "`plan.costs[0].weight` is missing"),
        ("weight = 100", "wait = 100", "plan.costs[0].wait"),
        ("\"speed\"", "\"haste\"", "`plan.costs[1].probe` is haste; expected a probe: place, speed"),
        ("\"linear_quadratic\"", "\"spacetime\"", "plan.costs"),
        (
            "\"linear_quadratic\"",
            "\"quadratic\"",
            "expected \"spacetime\", \"linear_quadratic\" or \"state_space\"",
        ),
        ("weight = 100", "weight = 1000", "the plan asks for "),
    ] {
        let error = plan("regulated_cart", &[(from, to)]).map(|_| ()).unwrap_err().to_string();
        assert!(error.contains(words), "{error}");
    }
    let twice = "value = 1\n[[plan.keys]]\ntime = 2\nprobe = \"place\"\nvalue = 1";
    let error = plan("steered_cart", &[("value = 1", twice)]).map(|_| ()).unwrap_err().to_string();
    assert!(error.contains("what other keys say already"), "{error}");
}
