//! Collisions that are detected beside the steps, one period late.

use std::sync::Arc;

use souple_engine::{Detected, Detection, Edit, Force, Span, State, Timeline, World};
use souple_math::Vec3;

use super::shape::Sphere;
use super::tests::{LAW, read, springs_within, two_cubes};
use super::{ContactLaw, ToolContact, ToolSurface};
use crate::loads::battery::{stepper, world_of};
use crate::loads::{Attachments, FormulaVector, GroundSpring, GroundSprings, RigidMotion};

const PERIOD: f64 = 2e-3;

/// A cube that falls on another and slides on it.
fn falling(detection: Detection) -> World {
    let law = ContactLaw { stiffness: 2e3, thickness: 0.0, ..LAW };
    let (positions, contact) = two_cubes(law, 1.2, Vec3::ZERO);
    let half = positions.len() / 2;
    let bodies = Attachments::new("bodies", springs_within(&positions, half), 200.0, 0.0).unwrap();
    let upper = Vec3::new(0.2, -1.0, 0.1);
    let velocities: Vec<Vec3> =
        (0..2 * half).map(|row| if row < half { Vec3::ZERO } else { upper }).collect();
    let forces: Vec<Box<dyn Force>> = vec![Box::new(contact), Box::new(bodies)];
    let masses = vec![0.05; 2 * half];
    world_of(detection, &positions, &velocities, &masses, forces, stepper("symplectic_euler"), PERIOD)
}

fn after(mut world: World, periods: usize) -> World {
    for _ in 0..periods {
        world.step().unwrap();
    }
    world
}

fn normal_force(world: &mut World) -> f64 {
    read(world, |contact, at| contact.total(at).0.length())
}

/// What was found where a period began is used in the next one: until then it is in State, with the rows where it was looked.
#[test]
fn what_is_detected_is_used_in_the_next_period() {
    let mut world = falling(Detection::OnePeriodLate);
    let mut largest = 0.0_f64;
    for _ in 0..150 {
        let before = world.state().systems[0].clone();
        world.step().unwrap();
        let now = &world.state().systems[0];
        assert_eq!(now.detected.positions, before.q);
        // what was left in State is what this period stepped with
        let keys = |pairs: &[souple_engine::Pair]| pairs.iter().map(|p| (p.a, p.b)).collect::<Vec<_>>();
        if !before.detected.numbers.is_empty() {
            assert_eq!(keys(&now.pairs), keys(&before.detected.pairs));
        }
        largest = largest.max(normal_force(&mut world));
    }
    assert!(largest > 0.1, "nothing was touched");
}

/// The same bits on any number of threads, and from a snapshot of any date, in and out of touch.
#[test]
fn late_detection_does_not_depend_on_threads_nor_on_snapshots() {
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| after(falling(Detection::OnePeriodLate), 400).state().hash())
    };
    let expected = run(1);
    assert_eq!(run(4), expected);
    let mut world = falling(Detection::OnePeriodLate);
    for _ in 0..40 {
        let bytes = after_in_place(&mut world, 10).state().to_bytes();
        world = falling(Detection::OnePeriodLate);
        world.resume(State::from_bytes(&bytes).unwrap()).unwrap();
    }
    assert_eq!(world.state().hash(), expected);
}

fn after_in_place(world: &mut World, periods: usize) -> &World {
    for _ in 0..periods {
        world.step().unwrap();
    }
    world
}

/// A contact that becomes thicker sees farther: what was found with the thickness before is not used, and the next period has what a search in
/// every step finds.
#[test]
fn thicker_contacts_look_anew() {
    let mut world = after(falling(Detection::OnePeriodLate), 5);
    assert!(!world.state().systems[0].detected.positions.is_empty());
    let mut in_time = falling(Detection::EveryStep);
    in_time.resume(world.state().clone()).unwrap();
    let before = world.state().systems[0].pairs.len();
    let thicken = Edit::SetParameter {
        system: 0,
        force: "contact".to_owned(),
        parameter: "thickness".to_owned(),
        // from 0.19 above the other, seen from 0.3: with this also the corners of the far side
        value: 1.5,
    };
    world.edit(thicken.clone()).unwrap();
    in_time.edit(thicken).unwrap();
    assert_eq!(world.state().systems[0].detected, Detected::default());
    world.step().unwrap();
    in_time.step().unwrap();
    let keys = |world: &World| {
        world.state().systems[0].pairs.iter().map(|pair| (pair.a, pair.b)).collect::<Vec<_>>()
    };
    assert_eq!(keys(&world), keys(&in_time));
    assert!(keys(&world).len() > before);
}

/// A body that comes farther within two periods than a search looks makes its steps search anew: it does not pass, and what it does to
/// the other one is what it does with a search in every step.
#[test]
fn fast_bodies_do_not_pass() {
    let impact = |detection| {
        let law = ContactLaw { stiffness: 2e3, friction: 0.0, damping: 0.0, thickness: 0.0, ..LAW };
        let (positions, contact) = two_cubes(law, 2.0, Vec3::ZERO);
        let half = positions.len() / 2;
        let bodies = Attachments::new("bodies", springs_within(&positions, half), 200.0, 0.0).unwrap();
        let velocities: Vec<Vec3> =
            (0..2 * half).map(|row| if row < half { Vec3::ZERO } else { Vec3::Y * -20.0 }).collect();
        let forces: Vec<Box<dyn Force>> = vec![Box::new(contact), Box::new(bodies)];
        // 0.2 in a period, two thirds of the reach: two periods go farther than a search sees
        let stepper = stepper("symplectic_euler");
        let masses = vec![0.05; 2 * half];
        let world = world_of(detection, &positions, &velocities, &masses, forces, stepper, 0.01);
        after(world, 6).state().systems[0].v.clone()
    };
    let (late, in_time) = (impact(Detection::OnePeriodLate), impact(Detection::EveryStep));
    assert!(in_time[0].length() > 0.0 || in_time.iter().any(|v| v.y < 0.0 && v.y > -20.0));
    assert_eq!(late, in_time);
}

/// A square sheet on springs to the ground, and a small ball that is shot at it from afar.
fn shot(detection: Detection, motion: &str) -> World {
    let points: Vec<Vec3> = (0..=8)
        .flat_map(|i| (0..=8).map(move |j| Vec3::new(f64::from(i), f64::from(j), 0.0) * 0.1))
        .collect();
    let corner = |i: u32, j: u32| i * 9 + j;
    let triangles = (0..8)
        .flat_map(|i| {
            (0..8).flat_map(move |j| {
                [
                    [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1)],
                    [corner(i, j), corner(i + 1, j + 1), corner(i, j + 1)],
                ]
            })
        })
        .collect();
    let surface = souple_mesh::TriangleSurface::new(points.clone(), triangles).unwrap();
    let touched = ToolSurface { surface: surface.into(), rows: (0..points.len() as u32).collect() };
    let translation = Some(Arc::new(FormulaVector::compile(motion).unwrap()) as _);
    let led = RigidMotion { translation, ..RigidMotion::default() };
    let law = ContactLaw { stiffness: 200.0, friction: 0.3, tangential_stiffness: 100.0, ..LAW };
    let ball = Box::new(Sphere::new(Vec3::new(0.41, 0.43, 0.3), 0.03));
    let horizon = match detection {
        Detection::EveryStep => PERIOD,
        Detection::OnePeriodLate => 2.0 * PERIOD,
    };
    let tool = ToolContact::new("tool", touched, ball, led, law, [0.1, horizon]).unwrap();
    let springs = points.iter().enumerate();
    let springs =
        springs.map(|(row, at)| GroundSpring { row: row as u32, share: 1.0, anchor: *at }).collect();
    let ground = GroundSprings::new("ground", springs, 5.0, 0.1).unwrap();
    let forces: Vec<Box<dyn Force>> = vec![Box::new(tool), Box::new(ground)];
    let (still, masses) = (vec![Vec3::ZERO; points.len()], vec![0.01; points.len()]);
    world_of(detection, &points, &still, &masses, forces, stepper("symplectic_euler"), PERIOD)
}

/// A ball at 60 m/s, twelve centimetres in a period and four times its radius beyond the sheet in the next, is in front of it: two
/// periods ahead are looked through. Its triangles go as they do with a search in every step, also where its path bends.
#[test]
fn fast_tools_do_not_pass() {
    for motion in ["[0, 0, -60 * min(t, 0.0065)]", "[0, 2 * t, -0.25 * sin(200 * t)]"] {
        let run = |detection| after(shot(detection, motion), 20).state().systems[0].q.clone();
        let (late, in_time) = (run(Detection::OnePeriodLate), run(Detection::EveryStep));
        assert!(in_time.iter().any(|point| point.z < -0.01), "{motion}: nothing was touched");
        let apart = late.iter().zip(&in_time).map(|(a, b)| (*a - *b).length()).fold(0.0, f64::max);
        // triangles beside the ball's way are known one period later, or longer: where they touch the same of them do
        assert!(apart < 1e-12, "{motion}: {apart}");
    }
}

/// Detection runs while the steps do, on a thread of its own.
#[test]
fn detection_runs_beside_steps() {
    let timeline = Timeline::begin();
    let mut world = falling(Detection::OnePeriodLate);
    world.note_on(&timeline);
    let is_beside = |a: &Span, b: &Span| {
        let (start, end) = (a.start.max(b.start), (a.start + a.duration).min(b.start + b.duration));
        a.thread != b.thread && end > start
    };
    for _ in 0..2000 {
        world.step().unwrap();
        let (spans, threads) = (timeline.spans(), timeline.threads());
        let of = |name: &'static str| spans.iter().filter(move |span| span.name == name);
        assert!(of("collisions").all(|span| threads[span.thread] == "collisions"));
        if of("collisions").any(|look| of("steps").any(|steps| is_beside(look, steps))) {
            return;
        }
    }
    panic!("no search of 2000 ran beside the steps");
}
