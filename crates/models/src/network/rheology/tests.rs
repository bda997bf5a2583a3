//! Networks of springs, dampers and sliders against loops and sums known by hand, and what texts are refused.

use super::*;

const TE: f64 = 1.0 / 300.0;

fn network(text: &str) -> Network {
    let number = |text: &str, _: &str| text.parse::<f64>().map_err(|error| error.to_string());
    read(text, &number).unwrap()
}

/// Efforts at the ends of steps along a course.
fn efforts(network: &Network, timestep: f64, course: impl IntoIterator<Item = f64>) -> Vec<f64> {
    let mut memory = [0.0; WRITTEN_MEMORY];
    course.into_iter().map(|q| network.deform(q, timestep, &mut memory).effort).collect()
}

/// Elements in series add their compliances, in parallel their stiffnesses.
#[test]
fn springs_add_up() {
    let both = network("spring(200) - (spring(100) | spring(50) | spring(50))");
    let effort = efforts(&both, TE, [0.01])[0];
    assert!((effort - 1.0).abs() < 4.0 * f64::EPSILON, "{effort}");
    assert!((both.stiffest(TE) - 100.0).abs() < 1e-13);
    let outcome = both.deform(0.01, TE, &mut [0.0; WRITTEN_MEMORY]);
    assert!((outcome.slope - 100.0).abs() < 1e-12);
    assert!((outcome.account.stored - 0.005).abs() < 1e-17);
}

/// A slider beside a spring, in series with another: the loop of an elasto-plastic body whose thresholds move along
/// (kinematic hardening).
#[test]
fn plastic_loop() {
    let plastic = network("spring(1000) - (slider(10) | spring(250))");
    let found = efforts(&plastic, TE, [0.005, 0.010, 0.015, 0.030, 0.025, 0.010, 0.0]);
    // beyond the yield at 10 mm the slope is 1000·250/1250 = 200; unloading is elastic over 20 N
    for (found, expected) in found.iter().zip([5.0, 10.0, 11.0, 14.0, 9.0, -6.0, -8.0]) {
        assert!((found - expected).abs() < 1e-12, "{found} for {expected}");
    }
}

/// A chain bears no more than its weakest slider, a bundle as much as all together; what slips in equal parts slips once.
#[test]
fn sliders_in_chains_and_bundles() {
    let chain = network("spring(1000) - slider(3) - slider(2) - slider(2)");
    let mut memory = [0.0; WRITTEN_MEMORY];
    assert_eq!(chain.deform(1.0, TE, &mut memory).effort, 2.0);
    // 2 N stretch the spring by 2 mm; one of the two weak sliders took the rest
    assert!((memory[0]).abs() < 1e-15 && (memory[1] - 0.998).abs() < 1e-15 && memory[2] == 0.0, "{memory:?}");
    assert_eq!(chain.deform(0.0, TE, &mut memory).effort, -2.0);
    let bundle = network("spring(1000) - (slider(3) | slider(2, 1))");
    assert_eq!(efforts(&bundle, TE, [1.0, -1.0]), [5.0, -4.0]);
}

/// What is put in is stored, given off, or lost to the step, which is of the size of the step.
#[test]
fn energy_is_accounted_for() {
    let network =
        network("spring(300) | (spring(1000) - (slider(4, 2) | damper(3)) - (spring(800) | damper(20)))");
    let course = |time: f64| 0.03 * (9.0 * time).sin() + 0.01 * (31.0 * time).sin();
    let lost = |timestep: f64| {
        let (mut memory, mut work, mut heat, mut before) = ([0.0; WRITTEN_MEMORY], 0.0, 0.0, 0.0);
        let mut stored = 0.0;
        for step in 1..=(1.0 / timestep).round() as usize {
            let q = course(step as f64 * timestep);
            let Outcome { effort, account, .. } = network.deform(q, timestep, &mut memory);
            work += effort * (q - before);
            heat += account.heat;
            assert!(account.heat >= 0.0);
            (before, stored) = (q, account.stored);
        }
        (work - stored - heat, work)
    };
    let ((coarse, work), (fine, _)) = (lost(1e-3), lost(1e-4));
    assert!(fine > 0.0 && coarse < 0.1 * work, "{coarse} of {work}");
    assert!((coarse / fine - 10.0).abs() < 1.0, "{coarse} {fine}");
}

/// Slopes are those of differences, on every piece.
#[test]
fn slopes_are_differences() {
    let network = network("spring(300) | (spring(1000) - (slider(4, 2) | damper(3)))");
    let memory = [0.002, 0.001];
    for q in [-0.02, -0.001, 0.003, 0.02] {
        let effort = |q: f64| network.deform(q, TE, &mut memory.clone()).effort;
        let difference = (effort(q + 1e-7) - effort(q - 1e-7)) / 2e-7;
        let slope = network.deform(q, TE, &mut memory.clone()).slope;
        // efforts of some newtons carry 1e-15 of rounding, divided by 1e-7
        assert!((slope - difference).abs() < 1e-6, "{slope} for {difference}");
    }
}

/// Held for ever, dampers bear nothing and sliders have not moved.
#[test]
fn begins_relaxed() {
    let network = network("spring(300) - damper(3) - (slider(5) | damper(2))");
    let mut memory = [0.0; WRITTEN_MEMORY];
    network.rest_at(0.01, &mut memory);
    // a millionth of the elongation is left to the spring
    assert!((memory[0] - 0.01).abs() < 2e-8 && memory[1] == 0.0, "{memory:?}");
}

/// So do dampers without a spring, which nothing pulls back: the first step asks no force of them.
#[test]
fn dampers_alone_begin_relaxed() {
    for text in ["damper(10)", "damper(10) - damper(30)", "damper(10) - slider(2)"] {
        let network = network(text);
        let mut memory = [0.0; WRITTEN_MEMORY];
        network.rest_at(0.3, &mut memory);
        let outcome = network.deform(0.3, TE, &mut memory);
        // rounding of the 2·10⁵ m, Q/Z of the time it rests, at which its slider would give way, over a step
        assert!(outcome.effort.abs() < 10.0 * 2e5 * f64::EPSILON / TE, "{text}: {}", outcome.effort);
    }
}

/// A link that slipped and is held stands at the corner of its curve, where rounding may say that its slider would never
/// bear so much.
#[test]
fn held_where_it_slipped() {
    let mut random = random_numbers();
    for _ in 0..2000 {
        let numbers = [100.0 + 5000.0 * random(), 1.0 + 20.0 * random(), 1.0 + 20.0 * random()];
        let [k, traction, compression] = numbers;
        let network = network(&format!("spring({k}) - slider({traction}, {compression})"));
        let mut memory = [0.0; WRITTEN_MEMORY];
        let q = 2.0 * (random() - 0.3) * traction / k;
        for _ in 0..10 {
            let effort = network.deform(q, TE, &mut memory).effort;
            let bound = traction.max(compression) * (1.0 + 4.0 * f64::EPSILON);
            assert!(effort.abs() <= bound, "{numbers:?} at {q}: {effort}");
        }
    }
}

/// What has blown up has no effort; it does not stop the program.
#[test]
fn no_number_stays_none() {
    for text in ["spring(300) | (spring(1000) - (slider(4, 2) | damper(3)))", "spring(10) - slider(1)"] {
        for q in [f64::INFINITY, f64::NEG_INFINITY, f64::NAN, 1e300] {
            network(text).deform(q, TE, &mut [0.0; WRITTEN_MEMORY]);
        }
        assert!(network(text).deform(f64::NAN, TE, &mut [0.0; WRITTEN_MEMORY]).effort.is_nan());
    }
}

/// Numbers between 0 and 1, always the same.
fn random_numbers() -> impl FnMut() -> f64 {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// A complex number.
type Complex = [f64; 2];

fn inverse([re, im]: Complex) -> Complex {
    let square = re * re + im * im;
    [re / square, -im / square]
}

/// [s]
const LONG_STEP: f64 = 0.05;

/// What the rate of `exp(i ω t)` is by the difference of two steps `h`, `(1 - exp(-i ω h))/h`, `turn = ω h`.
fn by_steps(turn: f64, h: f64) -> Complex {
    [(1.0 - turn.cos()) / h, turn.sin() / h]
}

/// A random network of `elements` springs and dampers, and its effort per deformation at `exp(i ω t)`, whose rate is given:
/// parallel ones add up, of those in series the inverses do.
fn random_tree(random: &mut impl FnMut() -> f64, elements: usize, rate: Complex) -> (String, Complex) {
    if elements == 1 {
        let number = 1.0 + 9.0 * random();
        return if random() < 0.5 {
            (format!("spring({number})"), [number, 0.0])
        } else {
            (format!("damper({number})"), rate.map(|part| number * part))
        };
    }
    let first = 1 + (random() * (elements - 1) as f64) as usize;
    let (a, b) = (random_tree(random, first, rate), random_tree(random, elements - first, rate));
    let add = |a: Complex, b: Complex| [a[0] + b[0], a[1] + b[1]];
    if random() < 0.5 {
        (format!("({} | {})", a.0, b.0), add(a.1, b.1))
    } else {
        (format!("({} - {})", a.0, b.0), inverse(add(inverse(a.1), inverse(b.1))))
    }
}

/// Any network of springs and dampers answers an oscillation as its transfer function says, once it has forgotten how
/// the oscillation began.
#[test]
fn random_trees_have_their_transfer_function() {
    let mut random = random_numbers();
    // springs and dampers of 1 to 10: eight of them relax within 80 s at most, of which a course has 25
    let (turn, steps) = (0.01, 40_000);
    for round in 0..40 {
        let (text, transfer) = random_tree(&mut random, 1 + round % 8, by_steps(turn, LONG_STEP));
        let (network, size) = (network(&text), transfer[0].hypot(transfer[1]));
        let mut memory = [0.0; WRITTEN_MEMORY];
        for step in 0..steps {
            let phase = turn * f64::from(step);
            let effort = network.deform(phase.sin(), LONG_STEP, &mut memory).effort;
            let expected = transfer[0] * phase.sin() + transfer[1] * phase.cos();
            // rounding of the deformations of many periods, which dampers add up
            if step > steps - 700 {
                assert!((effort - expected).abs() < 1e-6 * size, "{text}: {effort} for {expected}");
            }
        }
    }
}

/// What a step makes wrong of any network of springs and dampers is in proportion to it (EXP-45): half a step, half the error
/// against the network in continuous time, whose dampers know the rate `i ω`.
#[test]
fn errors_of_random_trees_are_in_proportion_to_steps() {
    let (turn, steps) = (0.01, 40_000);
    let with = |round: usize, rate: Complex| {
        let mut random = random_numbers();
        // another network each round
        for _ in 0..round {
            random();
        }
        random_tree(&mut random, 2 + round % 7, rate)
    };
    let mut of_order_one = 0;
    for round in 0..20 {
        let (text, exact) = with(round, [0.0, turn / LONG_STEP]);
        if !text.contains("damper") || !text.contains("spring") {
            continue;
        }
        let network = network(&text);
        // the greatest error of the last period, at the dates that both have
        let error = |halves: i32| {
            let h = LONG_STEP / f64::from(halves);
            let mut memory = [0.0; WRITTEN_MEMORY];
            let mut greatest = 0.0_f64;
            for step in 0..halves * steps {
                let phase = turn / f64::from(halves) * f64::from(step);
                let effort = network.deform(phase.sin(), h, &mut memory).effort;
                if step % halves == 0 && step > halves * (steps - 700) {
                    greatest = greatest.max((effort - exact[0] * phase.sin() - exact[1] * phase.cos()).abs());
                }
            }
            greatest
        };
        let ratio = error(1) / error(2);
        // the rate is `i ω (1 - i ω h/2)`: each of the elements adds no more than that to the next term
        let next = 8.0 * turn / 2.0;
        assert!((ratio - 2.0).abs() < 2.0 * next, "{text}: {ratio}");
        of_order_one += 1;
    }
    assert!(of_order_one > 10, "{of_order_one} networks of both kinds");
}

#[test]
fn faults_are_told() {
    let number = |text: &str, _: &str| text.parse::<f64>().map_err(|error| error.to_string());
    let problem = |text: &str| read(text, &number).unwrap_err().to_string();
    assert!(problem("sprong(1)").contains("did you mean `spring`?"));
    assert!(problem("spring(1) -").contains("the end was read at byte 11"));
    assert!(problem("spring(1) + spring(2)").contains("`+` was read at byte 10, where `-`, `|` or the end"));
    assert!(problem("(spring(1) | damper(2)").contains("`)`"));
    assert!(problem("spring(1, 2)").contains("2 number(s)"));
    assert!(problem("spring(0)").contains("above zero"));
    assert!(problem("spring(x)").contains("`spring` at byte 7"));
    assert!(problem("spring").contains("`(` and a number"));
    assert!(problem("").contains("spring(…)"));
    assert!(problem("spring(1) | slider(2)").contains("put a spring or a damper in series"));
    assert!(problem(&"(".repeat(1000)).contains("more than 32 deep"));
    assert!(problem(&vec!["damper(1)"; 17].join("-")).contains("at most 16"));
}
