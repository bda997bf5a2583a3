//! Tables of commands over a state space, by dynamic programming (JIM-97, PA-46).

use std::path::{Path, PathBuf};

use souple_engine::Interruption;
use souple_sweep::{FoundTable, Study, SweepError, Tabulator};

fn study(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes").join(name)
}

/// The study of a scene with some words in the place of others, on so many threads.
fn table(name: &str, count: usize, changes: &[(&str, &str)]) -> Result<FoundTable, SweepError> {
    let path = study(name);
    let mut text = std::fs::read_to_string(&path).unwrap();
    for (from, to) in changes {
        assert!(text.contains(from), "{from}");
        text = text.replace(from, to);
    }
    let study = Study::parse(&path, &text, |_| unreachable!("a plan reads no table"))?;
    let (tabulation, stop) = (study.tabulation.as_ref().expect("a table"), Interruption::default());
    let found = Tabulator { study: &study, tabulation, count, stop: &stop }.run(&|_, _| {})?;
    Ok(found.expect("not interrupted"))
}

fn bits(found: &FoundTable) -> Vec<u64> {
    let columns = found.columns();
    columns.iter().flat_map(|column| column.values.iter().map(|value| value.to_bits())).collect()
}

/// What is found is what is committed.
fn assert_committed(file: &str, found: &FoundTable) {
    let text = std::fs::read_to_string(study(file)).unwrap();
    let mut lines = text.lines();
    let columns = found.columns();
    let names: Vec<&str> = columns.iter().map(|column| column.name.as_str()).collect();
    assert_eq!(lines.next(), Some(names.join(",").as_str()));
    let rows: Vec<Vec<f64>> =
        lines.map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect()).collect();
    assert_eq!(rows.len(), columns[0].values.len());
    for (at, column) in columns.iter().enumerate() {
        for (row, value) in rows.iter().zip(&column.values) {
            // values are found to a millionth; levels are the same but where two are as good
            let is_same = row[at] == *value || (row[at] - value).abs() < 1e-9;
            assert!(is_same, "{}: {value}, not {}", column.name, row[at]);
        }
    }
}

/// The least time from rest a metre away to the box `|x| ≤ a`, `|v| ≤ b` under `|u| ≤ A`: ahead up to a speed `V`, back down to `b` where
/// `x = −a`, `(2 V² − b²)/2A = d − a`, `(2 V − b)/A` in all. Values tend to it as entries get denser; there is no way from where the cart is
/// too fast to be stopped before the end of the grid, `x + v²/2A > 1.2`.
#[test]
fn the_least_time_is_approached() {
    let (most, a, b) = (4.0_f64, 0.06, 0.24);
    let speed = (most * (1.0 - a) + 0.5 * b * b).sqrt();
    let exact = (2.0 * speed - b) / most;
    let coarse = table("fastest_cart/coarse.toml", 2, &[]).unwrap();
    let fine = table("fastest_cart/fine.toml", 2, &[]).unwrap();
    assert!(coarse.is_converged && fine.is_converged);
    let errors = [&coarse, &fine].map(|found| found.from_start.unwrap() - exact);
    let order = (errors[0] / errors[1]).log2();
    // across the line where levels switch the least is a root, for which semi-Lagrangian schemes have an order of 1/2 at least
    assert!(errors[1] > 0.0 && order >= 0.5, "{errors:?}, order {order}");
    for found in [&coarse, &fine] {
        let columns = found.columns();
        let [x, v, command, value] = [0, 1, 2, 3].map(|at| &columns[at].values);
        let apart = v[1] - v[0];
        for entry in 0..x.len() {
            let (x, v) = (x[entry], v[entry]);
            // what a speed that is off by two entries makes of the way on full brakes
            let off = 2.0 * apart * (v.abs() + apart) / most;
            let past = x.abs() + v * v / (2.0 * most) - 1.2;
            let is_away = x * v >= 0.0;
            if is_away && past > off {
                assert!(value[entry].is_infinite(), "a way from {x}, {v}");
            } else if !is_away || past < -off {
                assert!(value[entry].is_finite(), "no way from {x}, {v}");
            }
            // where brakes lead to rest says which way to go, but for the goal and an entry; at its greatest speed a shot ahead leaves the grid
            let rests = x + v * v.abs() / (2.0 * most);
            let is_clear = rests.abs() > a + 0.5 * apart + off && v.abs() < 2.3;
            if value[entry].is_finite() && is_clear {
                assert_eq!(command[entry], -8.0 * rests.signum(), "at {x}, {v}");
            }
        }
    }
    assert_committed("fastest_cart/coarse.table.csv", &coarse);
    assert_committed("fastest_cart/fine.table.csv", &fine);
}

/// Threads share the states of the grid; what comes of it is the same to the bit.
#[test]
fn tables_are_the_same_on_any_number_of_threads() {
    let [one, three] = [1, 3].map(|count| table("fastest_cart/coarse.toml", count, &[]).unwrap());
    assert_eq!(bits(&one), bits(&three));
}

/// An interruption finds nothing, and is no fault of the study.
#[test]
fn tables_are_interrupted() {
    let (study, stop) = (Study::read(&study("fastest_cart/coarse.toml")).unwrap(), Interruption::default());
    stop.wish();
    let tabulation = study.tabulation.as_ref().expect("a table");
    let found = Tabulator { study: &study, tabulation, count: 1, stop: &stop }.run(&|_, _| {});
    assert!(found.unwrap().is_none());
}

/// What no table can be made for is named, with what would do.
#[test]
fn what_cannot_be_tabulated_is_named() {
    let target = "target = \"abs(x) <= 0.06 and abs(v) <= 0.24\"";
    let scene = "scene = \"scene.toml\"";
    let moving = "scene = \"scene.toml\"\nsettings = [\"networks.cart.masses.cart.velocity=[0, 1, 0]\"]";
    for (from, to, words) in [
        ("points = 21", "points = 4000", "which takes 4.800e7 shots and "),
        ("points = 21", "points = 1", ".points` is 1; expected a whole number of at least 2"),
        ("from = -1.2", "from = 3", "`plan.states.x` is from 3 to 1.2; expected `from` below `to`"),
        ("v = {", "w = {", "expected what `cart.drive` reads, in its order: x, v"),
        (target, "target = \"x > 5\"", "`plan.target` is a condition that no state meets"),
        (target, "target = \"y < 5\"", "expected a condition on x, v"),
        (target, "", "`plan.target` is missing"),
        (
            target,
            "target = \"abs(x) < 5\"",
            "`plan.target` is a condition that every state of the grid meets",
        ),
        (
            target,
            &format!("{target}\nhold = \"0.1 ms\""),
            "`plan.hold` is 0.0001; expected a whole number of periods",
        ),
        (target, "target = \"x < -1.19 and v > 2.3\"", "`plan.target` is where nothing leads from"),
        ("[-8, 0, 8]", "[-9, 0, 8]", "is 9 N; expected up to the 8 N that its actuator gives"),
        ("[-8, 0, 8]", "[8, 8]", "expected a list of different finite commands"),
        ("cart.drive", "cart.drives", "`plan.levels` is cart.drives; expected cart.drive"),
        (target, &format!("{target}\ncost = \"drive - 9\""), "`plan.cost` is -17 at x = -1.2, v = -2.4"),
        (target, &format!("{target}\ncost = \"thrust\""), "expected a formula of x, v, drive"),
        (
            target,
            &format!("{target}\nsets.\"cart[0].x\" = \"x\""),
            "such that `cart.drive` reads v = 0 where",
        ),
        (target, &format!("{target}\nsets.\"cart[1].x\" = \"x\""), "expected `cart[0].x` to `cart[0].v.z`"),
        (scene, moving, "numbers that do not say all: "),
        (scene, "scene = \"../planned_cart/scene.toml\"", "without commands of such a table"),
        ("[plan]", "[plan]\nkeys = 1", "`plan.keys` is unknown"),
    ] {
        let found = table("fastest_cart/coarse.toml", 1, &[(from, to)]);
        let error = found.err().unwrap_or_else(|| panic!("{to} is taken")).to_string();
        assert!(error.contains(words), "{to}: {error}");
    }
}
