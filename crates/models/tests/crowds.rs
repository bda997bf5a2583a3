//! Multitudes step to the same bits wherever their pairs are, for any number of threads, and from any snapshot.

use souple_engine::steppers::TABLE;
use souple_engine::{Kinematics, Mass, Model, SnapshotError, State, System, UnknownKind, World};
use souple_math::Vec3;
use souple_models::network::{
    Crowd, CrowdDescription, Friction, LINKS, LinkKernel, Listing, Making, Slide, Span,
};
use souple_table::{Value, Values};

const TE: f64 = 1e-3;
const COUNT: usize = 1200;

fn number(i: usize, salt: f64) -> f64 {
    ((i as f64 * 12.9898 + salt).sin() * 43_758.545_3).fract().abs()
}

fn law(name: &str) -> Box<dyn LinkKernel> {
    let entry = LINKS.find(name).unwrap();
    let text = |pairs: &[(&str, &str)]| -> Vec<(String, String)> {
        pairs.iter().map(|(name, text)| ((*name).to_owned(), (*text).to_owned())).collect()
    };
    // sticks once it has touched, and tears
    let states = text(&[("free", "max(0, 4000 * (0.1 - D))"), ("stuck", "4000 * (0.1 - D) - V")]);
    let transitions = text(&[("free -> stuck", "D < 0.098"), ("stuck -> free", "D > 0.106")]);
    let mut values = Values::new();
    for parameter in entry.parameters {
        let value = match parameter.name {
            "hard" => Value::Number(0.098),
            "distance" | "threshold" => Value::Number(0.1),
            "peak" => Value::Number(0.103),
            "range" => Value::Number(0.12),
            "repulsion" | "stiffness" => Value::Number(10_000.0),
            "cohesion" => Value::Number(1000.0),
            "damping" => Value::Number(3.0),
            "states" => Value::Texts(&states),
            "transitions" => Value::Texts(&transitions),
            _ if parameter.default.is_some() => continue,
            other => panic!("a number for `{other}`"),
        };
        values.set(parameter.name, value);
    }
    (entry.build)(&Making {
        values: &entry.values(values).unwrap(),
        timestep: TE,
        span: Span::Distance,
        driven: &[],
    })
    .unwrap()
}

/// Balls in a lump, two of which fly at each other: some meet, some part.
fn world(name: &str, friction: bool, groups: [std::ops::Range<u32>; 2], listing: Listing) -> World {
    let mut kinematics = Kinematics::default();
    kinematics.add_unknowns(UnknownKind::Point, COUNT);
    let friction = friction.then_some(Friction {
        stiffness: 5000.0,
        damping: 2.0,
        sticking: 0.6,
        slide: Slide::Coulomb(0.5),
        hold: 1.0,
        slow: 1e-5,
    });
    let [first, second] = groups;
    let crowd = Crowd::new(CrowdDescription {
        name: "crowd".into(),
        law: law(name).into(),
        first,
        second,
        range: 0.12,
        friction,
        fusible: None,
        timestep: TE,
        listing,
    });
    let stepper = TABLE.find("t_simulation").unwrap();
    let system = System {
        name: "main".into(),
        kinematics,
        mass: Mass { diagonal: vec![0.5; COUNT], couplings: Vec::new() },
        forces: vec![Box::new(crowd)],
        constraints: Vec::new(),
        stepper: (stepper.build)(&stepper.values(Values::new()).unwrap()),
        steps_per_period: 4,
    };
    // rows are not in the order of places
    let at = |i: usize| (i * 7919) % COUNT;
    let place = |i: usize| {
        let n = at(i);
        let shaken = Vec3::new(number(n, 0.1), number(n, 1.7), number(n, 3.3)) * 0.004;
        Vec3::new((n % 10) as f64, (n / 10 % 10) as f64, (n / 100) as f64) * 0.0985 + shaken
    };
    let mut state = system.initial_state((0..COUNT).map(place).collect());
    for (i, v) in state.v.iter_mut().enumerate() {
        let towards = if at(i) / 100 < 6 { 0.8 } else { -0.8 };
        *v = Vec3::new(number(i, 5.1) - 0.5, number(i, 7.7) - 0.5, towards);
    }
    let model = Model { period: 4.0 * TE, systems: vec![system], ..Model::default() };
    model.start(State { systems: vec![state], ..State::default() })
}

fn with_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(work)
}

fn step(world: &mut World, count: usize) {
    (0..count).for_each(|_| world.step().unwrap());
}

const CASES: [(&str, bool); 4] =
    [("cohesion", true), ("ball", false), ("finite_state", false), ("finite_state", true)];

/// Pairs in State and lists of the crowd's own lead to the same places and heat, of one group and of two.
#[test]
fn lists_change_no_bit() {
    for (name, friction) in CASES {
        for groups in [[0..1200, 0..1200], [0..500, 500..1200]] {
            let mut worlds =
                [Listing::State, Listing::Own].map(|listing| world(name, friction, groups.clone(), listing));
            let [by_pairs, by_lists] = worlds.each_mut().map(|world| world.energy().by_force[0].1.stored);
            assert!((by_pairs - by_lists).abs() <= 1e-9 * by_pairs.abs(), "{name}: {by_pairs} {by_lists}");
            for period in 0..30 {
                worlds.iter_mut().for_each(|world| step(world, 1));
                let [state, own] = worlds.each_ref().map(|world| &world.state().systems[0]);
                assert!(state.q == own.q && state.v == own.v, "{name} {friction} {period}");
                // summed in another order
                let heat = (own.memory[0] - state.memory[0]).abs();
                assert!(
                    heat <= 1e-12 * state.memory[0].abs(),
                    "{name} {friction}: {heat} of {}",
                    state.memory[0]
                );
                let mut near = 0;
                worlds[1].visit_near(0, &mut |_| near += 1);
                assert!(near > 0 && own.pairs.is_empty());
            }
        }
    }
}

/// A snapshot holds all that is remembered: a world made anew goes on to the same bits, with another number of threads and
/// lists made at another date.
#[test]
fn snapshots_remember_pairs() {
    for (name, friction) in CASES {
        let new = || world(name, friction, [0..1200, 0..1200], Listing::Own);
        let mut through = new();
        with_threads(1, || step(&mut through, 12));
        let bytes = through.state().to_bytes();
        let kept = &through.state().systems[0].kept;
        assert_eq!(kept.keys.is_empty(), name == "ball", "{name}");
        let mut resumed = new();
        resumed.resume(State::from_bytes(&bytes).unwrap()).unwrap();
        with_threads(1, || step(&mut through, 20));
        with_threads(3, || step(&mut resumed, 20));
        assert_eq!(through.state().hash(), resumed.state().hash(), "{name}");
        assert_eq!(through.state(), resumed.state());
    }
}

/// A world that gives back what its steps work with holds less, and goes on to the same bits.
#[test]
fn freeing_workspaces_changes_no_bit() {
    for (name, friction) in CASES {
        let [mut kept, mut given] = [(); 2].map(|()| world(name, friction, [0..1200, 0..1200], Listing::Own));
        for _ in 0..5 {
            [&mut kept, &mut given].into_iter().for_each(|world| step(world, 4));
            let before = given.bytes();
            given.free_workspace();
            // half of all State at least, which there was twice
            let held = before - given.bytes();
            assert!(held > given.state().bytes() / 2, "{name}: {held} of {before} bytes");
            assert_eq!(kept.state(), given.state(), "{name} {friction}");
        }
    }
}

/// What sticks and nothing else is in State: a few numbers for each.
#[test]
fn state_is_small() {
    let [pairs, own] = [Listing::State, Listing::Own].map(|listing| {
        let mut world = world("cohesion", true, [0..1200, 0..1200], listing);
        step(&mut world, 20);
        world
    });
    let sticking = pairs.state().systems[0].pairs.iter().filter(|pair| pair.memory[0] == 1.0).count();
    let kept = &own.state().systems[0].kept;
    assert_eq!((kept.keys.len(), kept.numbers.len()), (sticking, 3 * sticking));
    assert!(sticking > 100 && 4 * own.state().bytes() < 3 * pairs.state().bytes());
}

/// What no crowd could have written is refused with its place.
#[test]
fn damaged_memories_are_refused() {
    let mut good = world("cohesion", true, [0..1200, 0..1200], Listing::Own);
    step(&mut good, 5);
    let state = good.state().clone();
    assert!(state.systems[0].kept.keys.len() > 2);
    type Spoil = fn(&mut souple_engine::Kept);
    let spoils: [(&str, Spoil); 6] = [
        ("systems[0].kept.keys[1]", |kept| kept.keys[1] = kept.keys[0]),
        ("systems[0].kept.keys[0]", |kept| kept.keys[0] = 5 << 32 | 5),
        ("systems[0].kept.keys", |kept| *kept.keys.last_mut().unwrap() = 1300 << 32 | 1301),
        ("systems[0].kept", |kept| kept.counts[0] += 1),
        ("systems[0].kept", |kept| kept.counts = vec![0, u64::MAX]),
        ("systems[0].kept", |kept| kept.numbers.truncate(4)),
    ];
    for (place, spoil) in spoils {
        let mut damaged = state.clone();
        spoil(&mut damaged.systems[0].kept);
        let mut world = world("cohesion", true, [0..1200, 0..1200], Listing::Own);
        match world.resume(damaged) {
            Err(SnapshotError::Unreadable { field, .. }) => assert!(field.starts_with(place), "{field}"),
            other => panic!("{place}: {other:?}"),
        }
    }
    good.resume(state).unwrap();
}
