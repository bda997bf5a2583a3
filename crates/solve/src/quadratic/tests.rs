//! Programs whose answer is known, and conditions of a least of others.

use super::*;

/// Numbers between -1 and 1 (splitmix).
fn random(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mut mixed = (*seed ^ (*seed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    (mixed ^ (mixed >> 31)) as f64 / u64::MAX as f64 * 2.0 - 1.0
}

fn never() -> bool {
    false
}

const OPEN: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

fn row(slopes: &[f64], band: [f64; 2], price: f64) -> Row {
    Row { slopes: slopes.to_vec(), band, price }
}

/// `min ½ Σ h x²` with one row that is met: `x = μ g/h`, `μ = b/Σ g²/h`.
#[test]
fn one_row_is_met_at_the_least() {
    let program = QuadraticProgram {
        curvature: vec![1.0, 4.0, 100.0],
        gradient: vec![0.0; 3],
        bounds: vec![OPEN; 3],
        rows: vec![row(&[1.0, 2.0, -5.0], [7.0, 7.0], 1e6)],
    };
    let least = program.solve(&never).unwrap();
    let mu = 7.0 / (1.0 + 1.0 + 0.25);
    for (value, exact) in least.values.iter().zip([mu, mu / 2.0, -mu / 20.0]) {
        assert!((value - exact).abs() < 1e-13, "{:?}", least);
    }
    assert!((least.multipliers[0] - mu).abs() < 1e-13);
}

/// A projection on what lies within bounds on a plane: `x = clamp(μ g)`, `Σ g clamp(μ g) = b`.
#[test]
fn bounds_cut_what_a_row_asks_for() {
    let slopes: Vec<f64> = (0..50).map(|n| 24.5 - f64::from(n)).collect();
    let program = QuadraticProgram {
        curvature: vec![1.0; 50],
        gradient: vec![0.0; 50],
        bounds: vec![[-1.0, 1.0]; 50],
        rows: vec![row(&slopes, [550.0, f64::INFINITY], 1e6), row(&[1.0; 50], [0.0, 0.0], 1e6)],
    };
    let least = program.solve(&never).unwrap();
    let at = |mu: f64| slopes.iter().map(|g| g * (mu * g).clamp(-1.0, 1.0)).sum::<f64>();
    let (mut low, mut high) = (0.0, 10.0);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if at(middle) < 550.0 { low = middle } else { high = middle }
    }
    for (value, slope) in least.values.iter().zip(&slopes) {
        assert!((value - (low * slope).clamp(-1.0, 1.0)).abs() < 1e-12, "{value}");
    }
    assert!(least.residual < 1e-12, "{}", least.residual);
}

/// Bands that hold nothing change nothing, however wide: of 100 steps of a mass that goes a way and comes to rest, `x = λ (49.5 − n)` with `λ = 1/Σ (49.5 − n)²`,
/// interior steps alone come there too.
#[test]
fn wide_bands_change_nothing() {
    let way: Vec<f64> = (0..100).map(|n| 99.5 - f64::from(n)).collect();
    let gain = 1.0 / (0..100).map(|n| (49.5 - f64::from(n)).powi(2)).sum::<f64>();
    for width in [0.1, 10.0, 1e3, 1e6, 1e9] {
        let mut rows = vec![row(&way, [1.0, 1.0], 1e6), row(&[1.0; 100], [0.0, 0.0], 1e6)];
        // how far it has come after each step
        rows.extend((1..100_i32).map(|count| {
            let until: Vec<f64> = (0..100).map(|n| (f64::from(count - n) - 0.5).max(0.0)).collect();
            row(&until, [-1.0 - width, 1.0 + width], 1e6)
        }));
        let program = QuadraticProgram {
            curvature: vec![1.0; 100],
            gradient: vec![0.0; 100],
            bounds: vec![[-1.0, 1.0]; 100],
            rows,
        };
        let scaled = Scaled::of(&program).unwrap();
        let interior = interior::least(&scaled, &never).unwrap();
        assert!(interior.residual < 1e-8, "{width}: {}", interior.residual);
        let least = program.solve(&never).unwrap();
        for (n, value) in least.values.iter().enumerate() {
            let exact = gain * (49.5 - n as f64);
            assert!((value - exact).abs() < 1e-10 * gain * 49.5, "{width}: {n}: {value} {exact}");
        }
    }
}

/// What cannot be is missed by the least; what is dear is met, what is cheap is not.
#[test]
fn rows_that_contradict_are_missed_by_the_least() {
    let mut program = QuadraticProgram {
        curvature: vec![1.0, 1.0],
        gradient: vec![0.0, 0.0],
        bounds: vec![[-1.0, 1.0]; 2],
        rows: vec![row(&[1.0, 1.0], [5.0, 5.0], 1e5)],
    };
    let least = program.solve(&never).unwrap();
    assert_eq!(least.values, [1.0, 1.0]);
    assert!((least.multipliers[0] / 1e5 - 1.0).abs() < 1e-9, "{least:?}");
    // the same twice with other values, the second at twice the price
    program.rows = vec![row(&[1.0, 1.0], [0.5, 0.5], 1e5), row(&[1.0, 1.0], [1.5, 1.5], 2e5)];
    let least = program.solve(&never).unwrap();
    assert!(least.values.iter().all(|value| (value - 0.75).abs() < 1e-9), "{least:?}");
    // a price below what it is worth, ½ x² + 0.3 (1 − x)
    program.rows = vec![row(&[1.0, 0.0], [1.0, 1.0], 0.3)];
    let least = program.solve(&never).unwrap();
    assert!((least.values[0] - 0.3).abs() < 1e-12, "{least:?}");
}

/// A band with room changes no bit that tells; a side that holds does what a value there does.
#[test]
fn bands_hold_where_they_are_reached() {
    let with = |band: [f64; 2]| {
        let slopes: Vec<f64> = (0..30).map(|n| (0.3 * f64::from(n)).sin()).collect();
        QuadraticProgram {
            curvature: (0..30).map(|n| 1.0 + f64::from(n % 3)).collect(),
            gradient: vec![0.0; 30],
            bounds: vec![[-0.4, 0.4]; 30],
            rows: vec![row(&[1.0; 30], [3.0, 3.0], 1e6), row(&slopes, band, 1e6)],
        }
        .solve(&never)
        .unwrap()
    };
    let close = |a: &Least, b: &Least| a.values.iter().zip(&b.values).all(|(a, b)| (a - b).abs() < 1e-12);
    let free = with(OPEN.map(|side: f64| side.clamp(-1e9, 1e9)));
    let sum =
        |least: &Least| (0..30).map(|n| (0.3 * f64::from(n)).sin() * least.values[n as usize]).sum::<f64>();
    let at = sum(&free);
    assert!(close(&with([at - 0.1, at + 0.1]), &free));
    assert!(close(&with([at + 0.2, at + 0.5]), &with([at + 0.2, at + 0.2])));
    assert!(close(&with([f64::NEG_INFINITY, at - 0.2]), &with([at - 0.2, at - 0.2])));
}

/// Programs at random meet the conditions of a least, of rows that repeat each other and of those that cannot be met too.
#[test]
fn conditions_of_a_least_are_met() {
    let mut seed = 7;
    for case in 0..300 {
        let (count, rows) = (1 + case % 40, case % 13);
        let mut slopes: Vec<Vec<f64>> =
            (0..rows).map(|_| (0..count).map(|_| random(&mut seed)).collect()).collect();
        if rows > 2 {
            slopes[rows - 1] = slopes[0].clone();
            slopes[1] = slopes[0].iter().map(|slope| slope + 1e-5 * random(&mut seed)).collect();
        }
        let width = |at: usize, seed: &mut u64| if at.is_multiple_of(2) { 0.0 } else { random(seed).abs() };
        let program = QuadraticProgram {
            curvature: (0..count).map(|_| (2.0 * random(&mut seed)).exp()).collect(),
            gradient: (0..count).map(|_| random(&mut seed)).collect(),
            bounds: (0..count)
                .map(|at| {
                    if at % 3 == 0 {
                        OPEN
                    } else {
                        [-random(&mut seed).abs() - 1e-3, random(&mut seed).abs()]
                    }
                })
                .collect(),
            rows: slopes
                .iter()
                .enumerate()
                .map(|(at, slopes)| {
                    let low = 2.0 * random(&mut seed);
                    row(slopes, [low, low + width(at, &mut seed)], 10_f64.powf(4.0 + 4.0 * random(&mut seed)))
                })
                .collect(),
        };
        let least = program.solve(&never).unwrap();
        // rounding of prices of up to 1e8
        assert!(least.residual < 1e-8, "{case}: {}", least.residual);
        assert!(
            program
                .bounds
                .iter()
                .zip(&least.values)
                .all(|([low, high], value)| (low..=high).contains(&value))
        );
    }
}

#[test]
fn what_is_no_number_has_no_least() {
    let program = QuadraticProgram {
        curvature: vec![1.0],
        gradient: vec![f64::NAN],
        bounds: vec![OPEN],
        rows: Vec::new(),
    };
    assert_eq!(program.solve(&never).err(), Some(NoLeast::Unsolved));
}

/// It ends where that is wished within a system.
#[test]
fn it_ends_where_that_is_wished() {
    let slopes: Vec<Vec<f64>> = (0..20).map(|i| (0..30).map(|j| f64::from((i * j) % 7)).collect()).collect();
    let program = QuadraticProgram {
        curvature: vec![1.0; 30],
        gradient: vec![0.0; 30],
        bounds: vec![[-1.0, 1.0]; 30],
        rows: slopes.iter().map(|slopes| row(slopes, [1.0, 2.0], 10.0)).collect(),
    };
    let asked = std::cell::Cell::new(0);
    let wish = || asked.replace(asked.get() + 1) >= 25;
    assert_eq!(program.solve(&wish).err(), Some(NoLeast::Interrupted));
    assert_eq!(asked.get(), 26);
}
