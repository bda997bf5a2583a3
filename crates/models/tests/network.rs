//! Networks of masses and links: what every law promises, invariants of the scheme, the same bits for any threads.

use std::f64::consts::PI;

use souple_engine::steppers::TABLE;
use souple_engine::{
    Configuration, Force, Kinematics, Mass, Model, State, System, TangentWeights, UnknownKind, World,
};
use souple_math::Vec3;
use souple_models::network::laws::SpringDamper;
use souple_models::network::{
    Account, Crowd, CrowdDescription, DrivenLaw, Friction, Hook, InLanes, LINKS, LinkDescription, LinkEntry,
    LinkKernel, Links, Listing, Making, Moment, PAIR_MEMORY, Phase, Piecewise, Reach, Recipe, Response,
    Slide, Span, Wiring,
};
use souple_table::{Value, Values};

const TE: f64 = 1e-3;

/// A law of the table with numbers of the size of a metre and a kilonewton.
fn law(entry: &LinkEntry) -> Box<dyn LinkKernel> {
    (entry.build)(&Making { values: &values(entry), timestep: TE, span: Span::Distance, driven: &[] })
        .unwrap()
}

fn values(entry: &LinkEntry) -> Values {
    let text = |pairs: &[(&str, &str)]| -> Vec<(String, String)> {
        pairs.iter().map(|(name, text)| ((*name).to_owned(), (*text).to_owned())).collect()
    };
    let numbers = text(&[("k", "1 kN/m"), ("c", "3")]);
    let states = text(&[("free", "0"), ("touching", "k * (1 - D) - c * V")]);
    let transitions = text(&[("free -> touching", "D < 1"), ("touching -> free", "D > 1")]);
    let words =
        text(&[("free", "CHK, 0; INF, D, 1 -> touching"), ("touching", "CHK, k; CHZ, c; SUP, D, 1 -> free")]);
    let mut values = Values::new();
    for parameter in entry.parameters {
        let value = match parameter.name {
            "stiffness" => Value::Number(1000.0),
            "damping" | "viscosity" => Value::Number(3.0),
            "hardening" => Value::Number(250.0),
            "traction" => Value::Number(20.0),
            "compression" => Value::Number(30.0),
            "threshold" | "distance" => Value::Number(1.0),
            "depth" => Value::Number(0.3),
            "error" => Value::Number(5.0),
            "deepest" => Value::Number(0.5),
            "peak" => Value::Number(1.1),
            "range" => Value::Number(1.5),
            "cohesion" => Value::Number(700.0),
            "thresholds" => Value::Numbers(&[0.9, 1.2, 1.6]),
            "slopes" => Value::Numbers(&[-1000.0, -200.0, 100.0, 0.0]),
            "zero" => Value::Number(1.05),
            "lengths" => Value::Numbers(&[0.8, 1.0, 1.2, 1.5]),
            "pushes" => Value::Numbers(&[150.0, 0.0, -40.0, 0.0]),
            "solid_stiffness" => Value::Number(800.0),
            "solid_viscosity" => Value::Number(5.0),
            "fluid_stiffness" => Value::Number(1200.0),
            "fluid_viscosity" => Value::Number(50.0),
            "network" => Value::Text("spring(k) - (damper(c) | spring(2 * k))"),
            "push" => Value::Text("-k * (D - L0) - c * V"),
            "states" if entry.name == "conditional" => Value::Texts(&words),
            "states" => Value::Texts(&states),
            "transitions" => Value::Texts(&transitions),
            "parameters" => Value::Texts(&numbers),
            _ => continue,
        };
        values.set(parameter.name, value);
    }
    entry.values(values).unwrap()
}

fn links(law: Box<dyn LinkKernel>, ends: &[[u32; 2]], rest: f64, account: Account) -> Links {
    links_of(law, ends, Span::Distance, rest, account)
}

fn links_of(law: Box<dyn LinkKernel>, ends: &[[u32; 2]], span: Span, rest: f64, account: Account) -> Links {
    let lengths = vec![rest; ends.len()];
    Links::new(LinkDescription {
        name: "links".into(),
        law: law.into(),
        ends,
        span,
        rest_lengths: &lengths,
        lengths: &lengths,
        timestep: TE,
        account,
    })
}

fn at<'a>(positions: &'a [Vec3], velocities: &'a [Vec3], memory: &'a [f64]) -> Configuration<'a> {
    Configuration {
        positions,
        velocities,
        time: 0.0,
        load: 1.0,
        memory,
        pairs: &[],
        kept: souple_engine::KeptRef::default(),
        driven: &[],
        fields: &[],
    }
}

fn memory_of(force: &Links) -> Vec<f64> {
    let mut memory = vec![0.0; force.memory_len()];
    force.initial_memory(&mut memory);
    memory
}

/// Points of a cubic lattice, shaken, with velocities; neighbours are linked.
fn lattice(n: usize) -> (Vec<Vec3>, Vec<Vec3>, Vec<[u32; 2]>) {
    let shake = |i: usize, phase: f64| {
        let wave = |salt: f64| (12.9898 * i as f64 + salt + phase).sin();
        Vec3::new(wave(0.0), wave(1.3), wave(2.9))
    };
    let place = |i: usize| Vec3::new((i % n) as f64, (i / n % n) as f64, (i / n / n) as f64);
    let count = n * n * n;
    let mut ends = Vec::new();
    for i in 0..count {
        for (step, along) in [1, n, n * n].into_iter().zip(place(i).to_array()) {
            if along < (n - 1) as f64 {
                ends.push([i as u32, (i + step) as u32]);
            }
        }
    }
    let positions = (0..count).map(|i| place(i) + shake(i, 0.0) * 0.1).collect();
    (positions, (0..count).map(|i| shake(i, 5.0)).collect(), ends)
}

fn with_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(work)
}

/// Slopes are the derivatives of the push, and the push of a conservative law is minus that of its energy; nobody is pushed
/// at rest, and what is given off is not negative. Central differences err by `ε²` of a third derivative.
#[test]
fn battery_of_every_law() {
    for entry in LINKS.entries {
        let law = law(entry);
        let mut memory = [0.0; 16];
        law.begin(1.0, 1.0, &mut memory[..law.memory_len()]);
        for (length, before) in [(0.93, 0.931), (0.966, 0.964), (1.004, 1.003), (1.07, 1.072), (1.33, 1.331)]
        {
            let push = |length: f64, before: f64| {
                law.respond(&Reach { length, before, rest: 1.0 }, &Moment::of(0.0), &memory).push
            };
            let stored = |length: f64| {
                law.respond(&Reach { length, before, rest: 1.0 }, &Moment::of(0.0), &memory).stored
            };
            let step = 1e-6;
            let reach = Reach { length, before, rest: 1.0 };
            let [now, past] = law.slopes(&reach, &Moment::of(0.0), &memory);
            let numeric = |f: &dyn Fn(f64) -> f64| (f(step) - f(-step)) / (2.0 * step);
            let tolerance = 1e-6 * law.stiffest(1.0).max(1000.0);
            let differs = (now - numeric(&|e| push(length + e, before))).abs();
            assert!(differs < tolerance, "{} at {length}: ∂φ/∂D off by {differs}", entry.name);
            let differs = (past - numeric(&|e| push(length, before + e))).abs();
            assert!(differs < tolerance, "{} at {length}: ∂φ/∂D^r off by {differs}", entry.name);
            if law.is_conservative() {
                let force = -numeric(&|e| stored(length + e));
                let differs = (force - push(length, before)).abs();
                assert!(differs < tolerance, "{} at {length}: -∂E/∂D off by {differs}", entry.name);
                assert_eq!(past, 0.0, "{} looks back", entry.name);
            }
            let heat = law.respond(&reach, &Moment::of(0.0), &memory).heat;
            // rounding of a product of forces of 1e4 N and steps of 1e-3 m
            assert!(heat >= -1e-12, "{} at {length} gives off {heat}", entry.name);
        }
    }
}

/// Distances in space, along an axis of the grid and along one that leans.
fn spans() -> [Span; 3] {
    [Span::Distance, Span::Along(Vec3::Z), Span::Along(Vec3::new(0.1, -0.2, 1.0).try_normalised().unwrap())]
}

/// Lanes, stretches and what crosses them make the forces of the links one by one, in space and along an axis.
#[test]
fn forces_are_those_of_single_links() {
    let (positions, velocities, ends) = lattice(27);
    for (entry, span) in LINKS.entries.iter().flat_map(|entry| spans().map(|span| (entry, span))) {
        let force = links_of(law(entry), &ends, span, 1.0, Account::None);
        let memory = memory_of(&force);
        let at = at(&positions, &velocities, &memory);
        let mut found = vec![Vec3::ZERO; positions.len()];
        force.add_force(&at, &mut force.new_scratch(), &mut found);
        let mut expected = vec![Vec3::ZERO; positions.len()];
        let mut largest: f64 = 0.0;
        for (link, [a, b]) in ends.iter().map(|ends| ends.map(|end| end as usize)).enumerate() {
            let d = positions[a] - positions[b];
            let stance = force.stance(link, &at);
            let push = match span {
                Span::Distance => d * (stance.push / d.length()),
                Span::Along(axis) => {
                    assert!((stance.length - d.dot(axis)).abs() < 1e-14);
                    axis * stance.push
                }
            };
            largest = largest.max(push.length());
            expected[a] += push;
            expected[b] -= push;
        }
        // rounding of lengths near one over small elongations, and of the law's own sums
        let worst = found.iter().zip(&expected).map(|(f, e)| (*f - *e).length()).fold(0.0, f64::max);
        assert!(worst < 1e-10 * largest.max(1e3), "{}: {worst} of {largest}", entry.name);
        let total: Vec3 = found.iter().copied().sum();
        assert!(total.length() < 1e-12 * largest.max(1.0) * ends.len() as f64, "{}: {total:?}", entry.name);
    }
}

/// Forces and memories are the same to the last bit by any number of threads.
#[test]
fn same_bits_for_any_thread_count() {
    let (positions, velocities, ends) = lattice(30);
    let plastic = LINKS.entries.iter().find(|entry| entry.name == "elasto_plastic").unwrap();
    let step = |threads: usize, span: Span| {
        with_threads(threads, || {
            let force = links_of(law(plastic), &ends, span, 1.0, Account::Heat);
            let mut memory = memory_of(&force);
            let before = memory.clone();
            let at = at(&positions, &velocities, &before);
            let mut out = vec![Vec3::ZERO; positions.len()];
            force.add_force(&at, &mut force.new_scratch(), &mut out);
            force.advance_memory(&at, TE, &mut memory, &mut []);
            (out, memory)
        })
    };
    for span in spans() {
        let one = step(1, span);
        assert!(one == step(2, span) && one == step(5, span));
        let fresh = memory_of(&links_of(law(plastic), &ends, span, 1.0, Account::Heat));
        assert!(one.1 != fresh, "some links yield");
    }
}

/// Differentials are differences of forces, damping included.
#[test]
fn differentials_are_differences() {
    let (positions, velocities, ends) = lattice(3);
    for (entry, span) in LINKS.entries.iter().flat_map(|entry| spans().map(|span| (entry, span))) {
        // along an axis those that lie about along it: laws of cohesion have no slope at length zero
        let upward = ends.iter().filter(|[a, b]| b - a == 9).map(|[a, b]| [*b, *a]);
        let ends = if span == Span::Distance { ends.clone() } else { upward.collect() };
        let force = links_of(law(entry), &ends, span, 1.0, Account::None);
        let memory = memory_of(&force);
        let mut scratch = force.new_scratch();
        let delta: Vec<Vec3> = (0..positions.len())
            .map(|i| Vec3::new((i as f64).sin(), (2.0 * i as f64).cos(), (3.0 + i as f64).sin()))
            .collect();
        let moved = |base: &[Vec3], scale: f64| -> Vec<Vec3> {
            base.iter().zip(&delta).map(|(x, d)| *x + *d * scale).collect()
        };
        let mut evaluate = |x: &[Vec3], v: &[Vec3]| {
            let mut out = vec![Vec3::ZERO; x.len()];
            force.add_force(&at(x, v, &memory), &mut scratch, &mut out);
            out
        };
        let step = 1e-7;
        for (position, velocity) in [(1.0, 0.0), (0.0, 1.0)] {
            let (sx, sv) = (step * position, step * velocity);
            let plus = evaluate(&moved(&positions, sx), &moved(&velocities, sv));
            let minus = evaluate(&moved(&positions, -sx), &moved(&velocities, -sv));
            let mut exact = vec![Vec3::ZERO; positions.len()];
            let weights = TangentWeights { position, velocity };
            let at = at(&positions, &velocities, &memory);
            force.add_differential(&at, weights, &delta, &mut force.new_scratch(), &mut exact);
            for ((p, m), e) in plus.iter().zip(&minus).zip(&exact) {
                let numeric = (*p - *m) * (0.5 / step);
                // rounding of forces of 1e4 N over the step, and its square times a curvature of 1e7
                assert!((numeric - *e).length() < 1e-2, "{}: {numeric:?} {e:?}", entry.name);
            }
        }
    }
}

/// Both forms of a characteristic agree; coefficients and values are those of the specification's §2.8.3.
#[test]
fn characteristics_by_tests_and_by_absolute_values() {
    let (thresholds, slopes) = ([0.9, 1.2, 1.6], [-10.0, -2.0, 1.0, 0.0]);
    let law = Piecewise::new(&thresholds, &slopes, (0.0, 0.0), 0.0).unwrap();
    let (linear, constant, bends) = law.coefficients().unwrap();
    assert!((linear + 5.0).abs() < 1e-14 && (constant + 4.6).abs() < 1e-14);
    for (found, expected) in bends.iter().zip([4.0, 1.5, -0.5]) {
        assert!((found - expected).abs() < 1e-14);
    }
    let by_tests = |length: f64| {
        let mut value = slopes[0] * length;
        for (i, threshold) in thresholds.iter().enumerate() {
            value += (slopes[i + 1] - slopes[i]) * (length - threshold).max(0.0);
        }
        value
    };
    let kernel = InLanes(law);
    for i in 0..=200 {
        let length = 0.01 * f64::from(i);
        let found = kernel.respond(&Reach { length, before: length, rest: 1.0 }, &Moment::of(0.0), &[]).push;
        assert!((found - by_tests(length)).abs() < 1e-13, "at {length}");
    }
    let error = Piecewise::new(&[1.0, 1.0], &[0.0; 3], (0.0, 0.0), 0.0).unwrap_err().to_string();
    assert!(error.contains("thresholds") && error.contains("greater"), "{error}");
}

/// Along an axis the force is `-K (u_a - u_b) - Z (u_a - u_b - before)` of the displacements along it and nothing else: nothing
/// is felt of what happens across, an energy is there, and the tangent by places is `-K a aᵀ`. What is shorter than nothing is a
/// negative length.
#[test]
fn links_along_an_axis_are_one_dimensional() {
    let axis = Vec3::new(0.6, 0.0, 0.8);
    let spring_damper = SpringDamper { stiffness: 1000.0, damping: 300.0 };
    let force = links_of(Box::new(InLanes(spring_damper)), &[[0, 1]], Span::Along(axis), 0.0, Account::Heat);
    let memory = memory_of(&force);
    let across = Vec3::new(0.8, 5.0, -0.6);
    for apart in [0.01, -0.02] {
        let positions = [axis * apart + across, across * -3.0];
        let velocities = [axis * 2.0 + across, across * 7.0];
        let at = at(&positions, &velocities, &memory);
        let (mut out, mut scratch) = (vec![Vec3::ZERO; 2], force.new_scratch());
        force.add_force(&at, &mut scratch, &mut out);
        let expected = axis * (-1000.0 * apart - 300.0 * 2.0 * TE);
        assert!((out[0] - expected).length() < 1e-11 && out[1] == -out[0], "{out:?}");
        assert!((force.energy(&at, &mut scratch).stored - 500.0 * apart * apart).abs() < 1e-12);
        let (mut change, weights) = (vec![Vec3::ZERO; 2], TangentWeights { position: 1.0, velocity: 0.0 });
        force.add_differential(&at, weights, &[across + axis, Vec3::ZERO], &mut scratch, &mut change);
        assert!((change[0] + axis * 1000.0).length() < 1e-9, "{change:?}");
        let mut next = memory.clone();
        force.advance_memory(&at, TE, &mut next, &mut []);
        // Z (D - D^r)²
        assert!((next[0] - 300.0 * (2.0 * TE).powi(2)).abs() < 1e-12);
    }
    assert!(!force.declaration().internal && force.declaration().symmetric_tangent);
}

/// Lanes without a link give nothing along an axis either, whatever the law does at `D = 0`: a ball of radius 1 pushes there.
#[test]
fn empty_lanes_give_nothing_along_an_axis() {
    for count in [1, 5, 8, 13, 64, 67, 131] {
        let ends: Vec<[u32; 2]> = (0..count).map(|i| [i, i + 1]).collect();
        let ball = LINKS.find("ball").unwrap();
        let force = links_of(law(ball), &ends, Span::Along(Vec3::X), 0.0, Account::Heat);
        // all in reach, so that every mass between two others is pushed by both
        let positions: Vec<Vec3> = (0..=count).map(|i| Vec3::new(-0.37 * f64::from(i), 0.0, 0.0)).collect();
        let still = vec![Vec3::ZERO; positions.len()];
        let mut out = still.clone();
        let memory = memory_of(&force);
        let at = at(&positions, &still, &memory);
        force.add_force(&at, &mut force.new_scratch(), &mut out);
        let push = force.stance(0, &at).push;
        assert!(push > 100.0 && (out[0].x - push).abs() < 1e-9 && out[count as usize].x < -100.0);
        let inner = &out[1..count as usize];
        assert!(inner.iter().all(|force| force.length() < 1e-9), "{count} links: {inner:?}");
    }
}

/// A chain of masses between fixed ends, along x, stepped by `t_simulation`.
fn chain(count: usize, stiffness: f64, start: impl Fn(usize) -> f64) -> World {
    let ends: Vec<[u32; 2]> = (0..count as u32 + 1).map(|i| [i, i + 1]).collect();
    let values = Values::new().with("stiffness", Value::Number(stiffness));
    let spring = LINKS.find("spring").unwrap();
    let law = (spring.build)(&Making {
        values: &spring.values(values).unwrap(),
        timestep: TE,
        span: Span::Distance,
        driven: &[],
    })
    .unwrap();
    let mut kinematics = Kinematics::default();
    kinematics.add_unknowns(UnknownKind::Point, count + 2);
    let mut mass = Mass::new(count + 2);
    mass.diagonal.fill(1.0);
    let stepper = TABLE.find("t_simulation").unwrap();
    let fixed = |row: usize| souple_engine::Constraint::pin(row as u32, Vec3::new(row as f64, 0.0, 0.0));
    let system = System {
        name: "main".into(),
        kinematics,
        mass,
        forces: vec![Box::new(links(law, &ends, 1.0, Account::None))],
        constraints: vec![fixed(0), fixed(count + 1)],
        stepper: (stepper.build)(&stepper.values(Values::new()).unwrap()),
        steps_per_period: 1,
    };
    let place = |i: usize| Vec3::new(i as f64 + start(i), 0.0, 0.0);
    let state = system.initial_state((0..count + 2).map(place).collect());
    let model = Model { period: TE, systems: vec![system], ..Model::default() };
    model.start(State { systems: vec![state], ..State::default() })
}

/// `ω Te = 2 asin(√(K/M) sin(p π/(2 (n + 1))))` of mode `p` of a chain: `q_n = A cos(ω (n + ½) Te)/cos(ω Te/2)` from rest.
#[test]
fn modes_of_a_chain() {
    let count = 10;
    for mode in [1, 3, 10] {
        let shape = |i: usize| (mode as f64 * PI * i as f64 / (count + 1) as f64).sin();
        // K/M = k Te²/m = 0.5
        let mut world = chain(count, 0.5 / (TE * TE), |i| 0.01 * shape(i));
        for _ in 0..1000 {
            world.step().unwrap();
        }
        let angle = 2.0 * (0.5_f64.sqrt() * (mode as f64 * PI / (2.0 * (count + 1) as f64)).sin()).asin();
        let factor = (angle * 1000.5).cos() / (0.5 * angle).cos();
        for i in 1..=count {
            let moved = world.rows(0).positions[i].x - i as f64;
            // rounding of places of ten metres over 1000 steps
            assert!((moved - 0.01 * shape(i) * factor).abs() < 1e-11, "mode {mode}, mass {i}");
        }
    }
}

/// `½ Σ M V² + ½ X_nᵀ K X_{n-1}` of an undamped linear network stays: to rounding over 20 000 steps.
#[test]
fn discrete_energy_is_kept() {
    let (count, stiffness) = (10, 0.9 / (TE * TE));
    let mut world = chain(count, stiffness, |i| if i == 3 { 0.05 } else { 0.0 });
    let energy = |world: &World| {
        let rows = world.rows(0);
        let kinetic: f64 = rows.velocities.iter().map(|v| 0.5 * v.length_sq()).sum();
        let before = |i: usize| rows.positions[i] - rows.velocities[i] * TE;
        let bilinear = |i: usize| {
            let now = rows.positions[i + 1].x - rows.positions[i].x - 1.0;
            0.5 * stiffness * now * (before(i + 1).x - before(i).x - 1.0)
        };
        kinetic + (0..=count).map(bilinear).sum::<f64>()
    };
    world.step().unwrap();
    let start = energy(&world);
    for _ in 0..20_000 {
        world.step().unwrap();
    }
    // places of ten metres round to 2e-15 m, elongations are 0.05 m: 4e-14 of the energy a step, growing as a random walk
    let drift = (energy(&world) / start - 1.0).abs();
    assert!(drift < 4e-14 * 20_000_f64.sqrt(), "{drift}");
}

/// What is found in the grid is all that acts: forces of a crowd are those of links between every pair, of one group and of
/// two.
#[test]
fn crowds_are_all_pairs() {
    let count = 240;
    let number = |i: usize, salt: f64| ((i as f64 * 12.9898 + salt).sin() * 43_758.545_3).fract().abs();
    let positions: Vec<Vec3> =
        (0..count).map(|i| Vec3::new(number(i, 0.1), number(i, 1.7), number(i, 3.3)) * 5.0).collect();
    let velocities: Vec<Vec3> = (0..count).map(|i| Vec3::new(number(i, 5.1), -number(i, 7.7), 0.0)).collect();
    for name in ["ball", "cohesion", "exponential_stop"] {
        let entry = LINKS.find(name).unwrap();
        for (first, second) in [(0..240, 0..240), (0..100, 100..240)] {
            let range = law(entry).range();
            assert!((1.0..=1.5).contains(&range), "{name} ends at {range}");
            let crowd = Crowd::new(CrowdDescription {
                name: "crowd".into(),
                law: law(entry).into(),
                first: first.clone(),
                second: second.clone(),
                range,
                friction: None,
                fusible: None,
                timestep: TE,
                listing: Listing::State,
            });
            let mut pairs = Vec::new();
            let mut scratch = crowd.new_scratch();
            crowd.find_pairs(&at(&positions, &velocities, &[0.0]), &mut scratch, &mut pairs);
            assert!(pairs.is_sorted_by_key(|pair| (pair.a, pair.b)) && pairs.len() > 100);
            let with_pairs = Configuration { pairs: &pairs, ..at(&positions, &velocities, &[0.0]) };
            let mut found = vec![Vec3::ZERO; count];
            crowd.add_force(&with_pairs, &mut scratch, &mut found);
            let is_one = first == second;
            let ends: Vec<[u32; 2]> = first
                .flat_map(|a| second.clone().map(move |b| [a, b]))
                .filter(|[a, b]| !is_one || a < b)
                .collect();
            let force = links(law(entry), &ends, 1.0, Account::None);
            let mut expected = vec![Vec3::ZERO; count];
            force.add_force(&at(&positions, &velocities, &[]), &mut force.new_scratch(), &mut expected);
            for (found, expected) in found.iter().zip(&expected) {
                // rounding of some ten forces of a kilonewton
                assert!((*found - *expected).length() < 1e-9, "{name}: {found:?} {expected:?}");
            }
        }
    }
}

/// A hook pulls back by its stiffness, tears at the static coefficient, slides at the kinetic one, and hooks again when slow.
#[test]
fn friction_sticks_slides_and_sticks() {
    let friction = Friction {
        stiffness: 1000.0,
        damping: 0.0,
        sticking: 0.6,
        slide: Slide::Coulomb(0.4),
        hold: 1.0,
        slow: 1e-4,
    };
    let (up, normal) = (Vec3::new(0.0, 0.0, 1.0), 10.0);
    let start = friction.grip(Hook::FREE, up, up, normal);
    assert_eq!((start.next.phase, start.force), (Phase::Stick, Vec3::ZERO));
    let shifted = |x: f64| Vec3::new(x, 0.0, 1.0);
    let held = friction.grip(start.next, shifted(1e-3), shifted(0.9e-3), normal);
    // D_acc is the part of a millimetre across a line that has turned by a thousandth
    assert!((held.force.x + 1.0).abs() < 1e-5 && held.next.phase == Phase::Stick);
    let slid = friction.grip(held.next, shifted(7e-3), shifted(6e-3), normal);
    assert!(slid.next.phase == Phase::Slide && (slid.force.length() - 4.0).abs() < 1e-12 && slid.heat > 0.0);
    let again = friction.grip(slid.next, shifted(7e-3), shifted(7e-3), normal);
    assert_eq!((again.next.phase, again.next.began), (Phase::Stick, shifted(7e-3)));
    assert_eq!(friction.grip(again.next, up, up, 0.0).next, Hook::FREE);
}

/// Faulty automata are refused in words.
#[test]
fn automata_are_checked() {
    let entry = LINKS.find("finite_state").unwrap();
    let text = |pairs: &[(&str, &str)]| -> Vec<(String, String)> {
        pairs.iter().map(|(name, text)| ((*name).to_owned(), (*text).to_owned())).collect()
    };
    let refused = |states: &[(&str, &str)], transitions: &[(&str, &str)], entries: &[(&str, &str)]| {
        let (states, transitions, entries) = (text(states), text(transitions), text(entries));
        let values = Values::new()
            .with("states", Value::Texts(&states))
            .with("transitions", Value::Texts(&transitions))
            .with("entries", Value::Texts(&entries));
        let values = entry.values(values).unwrap();
        (entry.build)(&Making { values: &values, timestep: TE, span: Span::Distance, driven: &[] })
            .unwrap_err()
            .to_string()
    };
    let two = [("a", "0"), ("b", "-D")];
    let cases = [
        (refused(&two, &[("a -> c", "D > 1")], &[]), ["the state `c`", "there are a, b"]),
        (refused(&two, &[], &[]), ["states.b", "never entered"]),
        (refused(&two, &[("a b", "D > 1")], &[]), ["no transition", "a -> b"]),
        (refused(&two, &[("a -> b", "D +")], &[]), ["transitions", "a -> b"]),
        (refused(&two, &[("a -> b", "D > 1")], &[("b", "K = 1")]), ["sets `K`", "remembered are L0"]),
        (refused(&[("a", "x")], &[], &[]), ["states.a", "x"]),
        (refused(&two, &[("a -> b", "1 > 2")], &[]), ["states.a", "to `b` that never fires"]),
        (
            refused(&two, &[("a -> b", "D > 1"), ("a -> a", "1 < 2")], &[]),
            ["to `b` that never fires", "the last that holds wins"],
        ),
    ];
    for (message, words) in cases {
        for word in words {
            assert!(message.contains(word), "`{word}` is not in: {message}");
        }
    }
}

/// Numbers of texts have the unit of what they are for, or one of its kind; names are nobody else's.
#[test]
fn texts_of_laws_are_checked() {
    let text = |pairs: &[(&str, &str)]| -> Vec<(String, String)> {
        pairs.iter().map(|(name, text)| ((*name).to_owned(), (*text).to_owned())).collect()
    };
    let build =
        |law: &str, texts: &[(&'static str, &[(&str, &str)])], words: &[(&'static str, &'static str)]| {
            let entry = LINKS.find(law).unwrap();
            let texts: Vec<_> = texts.iter().map(|(name, pairs)| (*name, text(pairs))).collect();
            let mut values = Values::new();
            words.iter().for_each(|(name, text)| values.set(*name, Value::Text(text)));
            texts.iter().for_each(|(name, pairs)| values.set(*name, Value::Texts(pairs)));
            let values = entry.values(values).unwrap();
            (entry.build)(&Making { values: &values, timestep: TE, span: Span::Distance, driven: &[] })
                .map(|_| ())
                .map_err(|error| error.to_string())
        };
    let network = |network: &'static str, parameters: &[(&str, &str)]| {
        build("rheological", &[("parameters", parameters)], &[("network", network)])
    };
    let states = |state: &str| build("conditional", &[("states", &[("a", state), ("b", "")])], &[]);
    let automaton = |texts: &[(&'static str, &[(&str, &str)])]| build("finite_state", texts, &[]);
    let formula =
        |parameters: &[(&str, &str)]| build("formula", &[("parameters", parameters)], &[("push", "-k * D")]);
    for taken in [
        network("spring(1 kN/m) - (damper(10 N s/m) | slider(5 N))", &[]),
        network("spring(k) - damper(2 * z)", &[("k", "1 kN/m"), ("z", "3")]),
        states("CHK, 50 N/mm; CHZ, 3 N s/m; SUP, L, 5 mm -> b; INF, dV, 1 m/s -> b"),
        formula(&[("k", "5 N/m")]),
    ] {
        assert_eq!(taken, Ok(()));
    }
    let a = [("a", "0")];
    for (result, words) in [
        (network("spring(10 kg)", &[]), "`10 kg` is a mass"),
        (formula(&[("k", "5 kg")]), "`k` is a mass"),
        (network("spring(1) - damper(3 N/m)", &[]), "`3 N/m` is"),
        (network("slider(2 Pa) - spring(1)", &[]), "`2 Pa` is a pressure"),
        (network("spring(k)", &[("k", "2 m")]), "`2 m` is a length"),
        (states("CHK, 50 s; SUP, L, 1 -> b"), "`50 s` is a time"),
        (states("CHZ, 3 m; SUP, L, 1 -> b"), "`3 m` is a length"),
        (states("SUP, L, 5 kg -> b"), "`5 kg` is a mass"),
        (states("SUP, dV, 5 m -> b"), "`5 m` is a length"),
        (formula(&[("D", "2")]), "`parameters.D` has the name of a variable"),
        (formula(&[("pi", "2")]), "`parameters.pi` has the name of a constant"),
        (formula(&[("sin", "2")]), "`parameters.sin` has the name of a function"),
        (automaton(&[("states", &a), ("memory", &[("L0", "2")])]), "`memory.L0` has the name of a variable"),
        (automaton(&[("states", &a), ("parameters", &[("L0", "2")])]), "`parameters.L0` has the name"),
        (
            automaton(&[("states", &a), ("memory", &[("k", "2")]), ("parameters", &[("k", "3")])]),
            "`parameters.k` has the name of a variable",
        ),
    ] {
        let message = result.expect_err(words);
        assert!(message.contains(words), "`{words}` is not in: {message}");
    }
}

/// Two masses that part at a speed and come back, under a force; where they are and what was given off after each step.
fn swing(force: Box<dyn Force>, speed: f64) -> Vec<[f64; 2]> {
    let mut kinematics = Kinematics::default();
    kinematics.add_unknowns(UnknownKind::Point, 2);
    let stepper = TABLE.find("t_simulation").unwrap();
    let system = System {
        name: "main".into(),
        kinematics,
        mass: Mass { diagonal: vec![1.0; 2], couplings: Vec::new() },
        forces: vec![force],
        constraints: Vec::new(),
        stepper: (stepper.build)(&stepper.values(Values::new()).unwrap()),
        steps_per_period: 1,
    };
    let mut state = system.initial_state(vec![Vec3::ZERO, Vec3::X]);
    state.v[1] = Vec3::X * speed;
    let model = Model { period: TE, systems: vec![system], ..Model::default() };
    let mut world = model.start(State { systems: vec![state], ..State::default() });
    let step = |_| {
        world.step().unwrap();
        let [a, b] = [0, 1].map(|row| world.state().systems[0].q[row].x);
        [b - a, world.energy().by_force[0].1.dissipated]
    };
    (0..400).map(step).collect()
}

/// What a pair of a crowd remembers moves on as it does of a link: both swing alike, whatever the law and wherever pairs stand.
#[test]
fn pairs_remember_as_links_do() {
    const RANGE: f64 = 1.4;
    let few = |entry: &&&LinkEntry| (1..=PAIR_MEMORY).contains(&law(entry).memory_len());
    let laws: Vec<_> = LINKS.entries.iter().filter(few).collect();
    assert!(laws.len() >= 5, "{} laws remember", laws.len());
    for entry in laws {
        let link = Links::new(LinkDescription {
            name: "link".into(),
            law: law(entry).into(),
            ends: &[[0, 1]],
            span: Span::Distance,
            rest_lengths: &[RANGE],
            lengths: &[1.0],
            timestep: TE,
            account: Account::None,
        });
        let alone = swing(Box::new(link), 2.0);
        for listing in [Listing::State, Listing::Own] {
            let crowd = Crowd::new(CrowdDescription {
                name: "crowd".into(),
                law: law(entry).into(),
                first: 0..2,
                second: 0..2,
                range: RANGE,
                friction: None,
                fusible: None,
                timestep: TE,
                listing,
            });
            let together = swing(Box::new(crowd), 2.0);
            // what flows, and what swings about the range, leaves it; a link goes on
            let within = alone.iter().take_while(|[apart, _]| *apart < RANGE).count();
            assert!(within >= 20, "{}: {within} steps", entry.name);
            for (one, other) in alone.iter().zip(&together).take(within) {
                // directions are made of other roundings
                let is_near = |i: usize| (one[i] - other[i]).abs() <= 1e-11 * one[i].abs().max(1.0);
                assert!(is_near(0) && is_near(1), "{}, {listing:?}: {one:?}, {other:?}", entry.name);
            }
        }
    }
}

/// Whatever number of a law is driven, and to what: the law that is made so in the first place.
#[test]
fn driven_laws_are_laws_made_so() {
    for entry in LINKS.entries {
        let recipe = Recipe { entry, values: values(entry), timestep: TE, span: Span::Distance };
        let drivable = recipe.drivable(&*law(entry));
        assert!(!drivable.is_empty(), "{}", entry.name);
        for name in drivable {
            let wiring = Wiring { gain: None, parameters: vec![(name.clone(), 1)] };
            let driven = DrivenLaw::new(law(entry), recipe.clone(), &wiring);
            for factor in [1.0, 1.01, 0.99] {
                let (of_list, number) = (name.split_once('['), |value: f64| value * factor);
                let mut values = values(entry);
                let mut to = f64::NAN;
                if let Some((list, index)) = of_list {
                    let index: usize = index.trim_end_matches(']').parse().unwrap();
                    let mut numbers = values.numbers(list).to_vec();
                    (to, numbers[index]) = (number(numbers[index]), number(numbers[index]));
                    values.set(list.to_owned(), Value::Numbers(&numbers));
                } else if let Some(Value::Number(value)) = values.get(&name) {
                    to = number(value);
                    values.set(name.clone(), Value::Number(to));
                } else if let Some(Value::Integer(value)) = values.get(&name) {
                    to = value as f64;
                } else {
                    let mut texts = values.texts("parameters").to_vec();
                    for (_, text) in texts.iter_mut().filter(|(known, _)| *known == name) {
                        to = number(if text == "1 kN/m" { 1000.0 } else { text.parse().unwrap() });
                        *text = to.to_string();
                    }
                    values.set("parameters", Value::Texts(&texts));
                }
                let made = (entry.build)(&Making {
                    values: &values,
                    timestep: TE,
                    span: Span::Distance,
                    driven: &[],
                });
                // where these numbers make no law together, the driven one is at fault too
                let Ok(made) = made else {
                    assert!(driven.fault(&[0.0, to]).is_some(), "{} {name} {to}", entry.name);
                    continue;
                };
                assert_eq!(driven.fault(&[0.0, to]), None, "{} {name}", entry.name);
                let mut numbers = [(); 2].map(|()| vec![0.0; made.memory_len()]);
                for (length, before) in [(1.02, 1.0), (0.93, 0.95), (1.3, 1.29), (0.6, 0.7)] {
                    let (reach, moment) = (Reach { length, before, rest: 1.0 }, Moment::of(0.0));
                    let [own, other] = &mut numbers;
                    made.begin(1.0, 1.0, own);
                    let expected = made.respond_and_remember(&reach, &moment, own);
                    driven.acting(&[0.0, to], &mut |law| {
                        law.begin(1.0, 1.0, other);
                        let response = law.respond_and_remember(&reach, &moment, other);
                        let both = |r: &Response| [r.push.to_bits(), r.stored.to_bits(), r.heat.to_bits()];
                        assert_eq!(both(&response), both(&expected), "{} {name} {to}", entry.name);
                    });
                    assert_eq!(own, other, "{} {name}", entry.name);
                }
            }
        }
    }
}

/// Numbers that make no law are told with what would be accepted, and a damper that is driven from nothing keeps no energy.
#[test]
fn wrong_numbers_are_faults() {
    let recipe = |name: &str| {
        let entry = LINKS.find(name).unwrap();
        Recipe { entry, values: values(entry), timestep: TE, span: Span::Distance }
    };
    let driven = |name: &str, parameter: &str| {
        let wiring = Wiring { gain: None, parameters: vec![(parameter.to_owned(), 0)] };
        DrivenLaw::new(law(LINKS.find(name).unwrap()), recipe(name), &wiring)
    };
    let told = |name: &str, parameter: &str, number: f64| driven(name, parameter).fault(&[number]).unwrap();
    assert_eq!(
        told("spring", "stiffness", -5.0),
        "`stiffness` is -5, but must be a number of at least 0 [N/m]"
    );
    assert!(told("spring", "stiffness", f64::NAN).contains("`stiffness` is NaN"));
    assert!(told("elasto_plastic", "rupture", 10.0).contains("it must be greater than `traction`, 20"));
    assert!(driven("spring", "stiffness").is_conservative());
    let entry = LINKS.find("spring_damper").unwrap();
    let values = entry.values(values(entry).with("damping", Value::Number(0.0))).unwrap();
    let undamped =
        (entry.build)(&Making { values: &values, timestep: TE, span: Span::Distance, driven: &[] }).unwrap();
    assert!(undamped.is_conservative());
    let wiring = Wiring { gain: None, parameters: vec![("damping".to_owned(), 0)] };
    let recipe = Recipe { entry, values, timestep: TE, span: Span::Distance };
    assert!(!DrivenLaw::new(undamped, recipe, &wiring).is_conservative());
}

/// What a law with memory stores in a pair is given off where the pair leaves the range, once, wherever pairs stand; and what a state
/// stored where a link switches to one that stores less.
#[test]
fn what_was_stored_is_given_off() {
    let text = |pairs: &[(&str, &str)]| -> Vec<(String, String)> {
        pairs.iter().map(|(name, text)| ((*name).to_owned(), (*text).to_owned())).collect()
    };
    let entry = LINKS.find("finite_state").unwrap();
    let automaton = |states: &[(&str, &str)], transitions: &[(&str, &str)]| {
        let values = Values::new()
            .with("states", Value::Texts(&text(states)))
            .with("transitions", Value::Texts(&text(transitions)))
            .with("energies", Value::Texts(&text(&[("held", "20 * (D - 1)^2 / 2")])));
        let values = entry.values(values).unwrap();
        (entry.build)(&Making { values: &values, timestep: TE, span: Span::Distance, driven: &[] }).unwrap()
    };
    let held = ("held", "-20 * (D - 1)");
    // parts at 5 m/s, and is at 1.2 m after 40 ms
    let stored = |apart: f64| 10.0 * (apart - 1.0) * (apart - 1.0);
    for listing in [Listing::State, Listing::Own] {
        let crowd = Crowd::new(CrowdDescription {
            name: "crowd".into(),
            law: automaton(&[held], &[]).into(),
            first: 0..2,
            second: 0..2,
            range: 1.2,
            friction: None,
            fusible: None,
            timestep: TE,
            listing,
        });
        let steps = swing(Box::new(crowd), 5.0);
        let gone = steps.iter().position(|[apart, _]| *apart >= 1.2).unwrap();
        let expected = stored(steps[gone - 1][0]);
        assert_eq!(steps[gone][1], 0.0, "{listing:?}: it is looked at one step later");
        for [apart, heat] in &steps[gone + 1..] {
            assert!((heat - expected).abs() < 1e-12, "{listing:?}: {heat} J for {expected} J at {apart} m");
        }
    }
    let torn = automaton(&[held, ("torn", "0")], &[("held -> torn", "D > 1.2")]);
    let steps = swing(Box::new(links(torn, &[[0, 1]], 1.0, Account::None)), 5.0);
    let gone = steps.iter().position(|[apart, _]| *apart > 1.2).unwrap();
    let expected = stored(steps[gone][0]);
    let last = steps[steps.len() - 1][1];
    assert!((last - expected).abs() < 1e-12, "{last} J for {expected} J");
}
