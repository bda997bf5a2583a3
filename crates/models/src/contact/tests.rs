//! Contacts against their laws.

use std::f64::consts::PI;
use std::sync::Arc;

use souple_engine::{Configuration, Force, Stepper, World};
use souple_math::{Dual, Vec3, eigen_symmetric, exponential};
use souple_mesh::TriangleSurface;
use souple_table::{Value, Values};

use super::law::Approach;
use super::shape::{Capsule, ClosedSurface, Cuboid, Jaws, Plane, Sphere};
use super::shape_contact::{derivative, dual};
use super::*;
use crate::loads::battery::{Setting, assert_force, stepper, world};
use crate::loads::{Attachments, Combination, FormulaVector, Link, PointLoad, RigidMotion, UniformForce};

pub(super) const LAW: ContactLaw = ContactLaw {
    stiffness: 300.0,
    damping: 0.4,
    friction: 0.5,
    tangential_stiffness: 200.0,
    thickness: 0.05,
};

/// Laws without friction and damping, with one, and with both.
fn laws() -> [ContactLaw; 4] {
    [
        ContactLaw { friction: 0.0, damping: 0.0, ..LAW },
        ContactLaw { damping: 0.0, ..LAW },
        ContactLaw { friction: 0.0, ..LAW },
        LAW,
    ]
}

fn points(positions: &[Vec3]) -> Vec<ContactPoint> {
    let point = |(row, start): (usize, &Vec3)| ContactPoint {
        row: row as u32,
        share: 1.0 + row as f64,
        start: *start,
    };
    positions.iter().enumerate().map(point).collect()
}

/// Two turning and two straight motions of a shape, none of them slow.
fn moving() -> RigidMotion {
    RigidMotion {
        translation: Some(Arc::new(FormulaVector::compile("[0.1 * sin(t), 0.02 * t, -0.1 * t]").unwrap())),
        rotation: Some(Arc::new(FormulaVector::compile("[0.2 * t, -0.3 * sin(2 * t), t^2]").unwrap())),
        pivot: Vec3::new(0.3, -0.2, 0.1),
    }
}

/// Sticking, sliding and separate points of every shape, at rest and moving, agree with their derivatives.
#[test]
fn shape_contacts_agree_with_energies_and_derivatives() {
    type Make = fn() -> Box<dyn Shape>;
    let shapes: [(&str, Make); 7] = [
        ("plane", || Box::new(Plane { point: Vec3::ZERO, normal: Vec3::new(0.6, 0.8, 0.0) })),
        ("sphere", || Box::new(Sphere::new(Vec3::new(0.1, 0.0, 0.2), 1.0))),
        ("capsule", || Box::new(Capsule { from: Vec3::new(-0.5, 0.0, 0.0), to: Vec3::X, radius: 0.6 })),
        ("jaws", || Box::new(Jaws::new(Vec3::new(0.0, -0.8, 0.1), [Vec3::Y, Vec3::Z], 1.6, 0.5, 0.6))),
        ("box", || {
            // turned by nearly a quarter, its sides exchanged for that: the same places are inside and outside, at an angle
            let axes = exponential(Vec3::new(0.0, 0.0, 1.5));
            Box::new(Cuboid { centre: Vec3::ZERO, half_size: Vec3::new(0.5, 0.9, 0.7), axes })
        }),
        ("height", || {
            let entry = SHAPES.find("height").unwrap();
            let values = Values::new()
                .with("height", Value::Text("0.3 * x - 0.2 * y + 0.04 * sin(2 * x) * cos(y) + 0.6"));
            (entry.build)(&entry.values(values).unwrap(), &|_| Err("there are no files here".to_owned()))
                .unwrap()
        }),
        ("closed_surface", || {
            let surface = cube(Vec3::new(-0.6, -0.5, -0.4), Vec3::new(0.1, 0.2, -0.1));
            Box::new(ClosedSurface::new(surface).unwrap())
        }),
    ];
    // a new shape of the table needs its row here
    assert_eq!(
        shapes.map(|(name, _)| name),
        SHAPES.entries.iter().map(|entry| entry.name).collect::<Vec<_>>()[..]
    );
    let positions = vec![
        Vec3::new(0.2, -0.3, 0.1),
        Vec3::new(-0.4, 0.2, 0.3),
        Vec3::new(0.5, 0.1, -0.45),
        Vec3::new(0.93, 0.52, 0.3),
        Vec3::new(9.0, 9.0, 9.0),
    ];
    let velocities: Vec<Vec3> =
        (0..5).map(|i| Vec3::new(0.3, (i as f64).sin(), 0.4 - 0.2 * i as f64)).collect();
    let (mut stuck, mut slid) = (0, 0);
    for (_, shape) in shapes {
        for law in laws() {
            for motion in [RigidMotion::default(), moving()] {
                let contact = ShapeContact::new("contact", points(&positions), shape(), motion, law).unwrap();
                for step in [0.001, 0.5] {
                    let mut setting = Setting::new(&contact, positions.clone(), velocities.clone());
                    setting.advance(&contact, 0.01);
                    for (x, v) in setting.positions.iter_mut().zip(&velocities) {
                        *x += *v * step;
                    }
                    setting.time += step;
                    assert_force(&contact, &setting);
                    let touches = contact.touches(&setting.at());
                    stuck += touches.iter().filter(|touch| !touch.force.sliding).count();
                    slid += touches.iter().filter(|touch| touch.force.sliding).count();
                }
            }
        }
    }
    assert!(stuck > 30 && slid > 30, "{stuck} {slid}");
}

/// Along a normal that does not turn, the lagged stiffness is symmetric, of no negative eigenvalue, and all of the
/// derivative but `-μ s/|s| ⊗ ∂N` of a sliding point.
#[test]
fn lagged_stiffness_leaves_out_the_growth_of_friction() {
    let (n, t) = (Vec3::new(0.6, 0.8, 0.0), Vec3::new(0.8, -0.6, 0.0));
    let (share, pressed) = (2.0, 0.1);
    for (law, slip) in laws().into_iter().flat_map(|law| [(law, 0.01), (law, 0.7)]) {
        let velocity = n * -0.3 + t * 0.2;
        let approach = Approach { gap: -pressed, normal: n, from_anchor: t * slip + n * 0.03, velocity };
        let lagged = law.lagged_stiffness(share, &approach).unwrap();
        let sliding = law.force(share, &approach, |number| number).unwrap().sliding;
        assert_eq!(sliding, slip == 0.7 && law.friction > 0.0);
        for stiffness in [lagged.position, lagged.velocity] {
            let least = eigen_symmetric(&stiffness).values.z;
            assert!(stiffness == stiffness.transpose() && least >= -1e-13 * law.stiffness, "{least:e}");
        }
        let slowing = 1.0 + 0.3 * law.damping;
        for axis in Vec3::AXES {
            let change = |position: Vec3, velocity: Vec3| {
                let moving = Approach {
                    gap: Dual::new(approach.gap, n.dot(position)),
                    normal: dual(n, Vec3::ZERO),
                    from_anchor: dual(approach.from_anchor, position),
                    velocity: dual(approach.velocity, velocity),
                };
                derivative(law.force(share, &moving, |number: Dual| number.value).unwrap().total())
            };
            let along = n.dot(axis) * share * law.stiffness;
            let friction = t * if sliding { law.friction } else { 0.0 };
            let rest = change(axis, Vec3::ZERO) + lagged.position * axis - friction * (along * slowing);
            assert!(rest.length() < 1e-12 * law.stiffness, "{rest:?}");
            let rest = change(Vec3::ZERO, axis) + lagged.velocity * axis
                - friction * (along * pressed * law.damping);
            assert!(rest.length() < 1e-12 * law.stiffness, "{rest:?}");
        }
    }
}

/// What probes read is what acts.
#[test]
fn touches_sum_to_the_force() {
    let positions = vec![Vec3::new(0.0, -0.1, 0.0), Vec3::new(1.0, -0.2, 0.0), Vec3::Y];
    let plane = Box::new(Plane { point: Vec3::ZERO, normal: Vec3::Y });
    let contact =
        ShapeContact::new("contact", points(&positions), plane, RigidMotion::default(), LAW).unwrap();
    let mut setting = Setting::new(&contact, positions, vec![Vec3::ZERO; 3]);
    setting.positions[0].x += 0.01;
    let (normal, friction) = contact.total(&setting.at());
    let sum: Vec3 = setting.force(&contact).into_iter().sum();
    assert!((normal + friction - sum).length() < 1e-13 * sum.length());
    // k p of share 1 and of share 2, thickness included
    assert!((normal - Vec3::Y * (300.0 * 0.15 + 600.0 * 0.25)).length() < 1e-12, "{normal:?}");
    assert!((friction - Vec3::X * -2.0).length() < 1e-12, "{friction:?}");
    assert_eq!(contact.touches(&setting.at()).len(), 2);
}

/// A body of springs on an incline of `angle`, friction coefficient `μ`.
fn incline(angle: f64, friction: f64, stepper: Box<dyn Stepper>, period: f64) -> World {
    let (side, mass) = (0.1, 0.1);
    let corner = |i: usize| Vec3::new((i & 1) as f64, (i >> 1 & 1) as f64, (i >> 2) as f64) * side;
    let positions: Vec<Vec3> = (0..8).map(corner).collect();
    let mut links = Vec::new();
    for a in 0..8 {
        for b in 0..a {
            let rest_length = (positions[a] - positions[b]).length();
            links.push(Link::new(Combination::row(a as u32), Combination::row(b as u32), rest_length));
        }
    }
    let weight = UniformForce(Vec3::new(angle.sin(), -angle.cos(), 0.0) * (9.81 * mass));
    let law =
        ContactLaw { stiffness: 2e3, damping: 10.0, friction, tangential_stiffness: 2e3, thickness: 0.0 };
    let bottom: Vec<ContactPoint> = points(&positions)
        .into_iter()
        .filter(|point| point.start.y == 0.0)
        .map(|point| ContactPoint { share: 1.0, ..point })
        .collect();
    let plane = Box::new(Plane { point: Vec3::ZERO, normal: Vec3::Y });
    let forces: Vec<Box<dyn Force>> = vec![
        Box::new(Attachments::new("body", links, 1e3, 1.0).unwrap()),
        Box::new(PointLoad::new("weight", (0..8).map(|row| (row, 1.0)).collect(), Arc::new(weight)).unwrap()),
        Box::new(ShapeContact::new("contact", bottom, plane, RigidMotion::default(), law).unwrap()),
    ];
    world(&positions, &[Vec3::ZERO; 8], &[mass; 8], forces, stepper, period)
}

fn mean(vectors: &[Vec3]) -> Vec3 {
    vectors.iter().copied().sum::<Vec3>() * (1.0 / vectors.len() as f64)
}

/// A block sticks below the friction angle and slides beyond it with `g (sin α - μ cos α)`, at 2 % to either
/// side, explicit and implicit.
#[test]
fn a_block_slides_beyond_the_friction_angle() {
    let friction: f64 = 0.5;
    for (name, period, steps) in [("symplectic_euler", 5e-4, 4000), ("backward_euler", 5e-3, 400)] {
        for (factor, slides) in [(0.98, false), (1.02, true)] {
            let angle = friction.atan() * factor;
            let mut world = incline(angle, friction, stepper(name), period);
            (0..steps / 2).for_each(|_| world.step().unwrap_or_else(|error| panic!("{name}: {error}")));
            let before = mean(&world.state().systems[0].v).x;
            let place = mean(&world.state().systems[0].q).x;
            (0..steps / 2).for_each(|_| world.step().unwrap());
            let moved = mean(&world.state().systems[0].q).x - place;
            if !slides {
                // it hangs on the springs of sticking and may swing about where they balance:
                // twice m g sin α over 4 points of 2e3 N/m
                let swing = 2.0 * 0.8 * 9.81 * angle.sin() / (4.0 * 2e3);
                assert!(moved.abs() < swing, "{name}: moved {moved}");
                continue;
            }
            let seconds = period * f64::from(steps / 2);
            let measured = (mean(&world.state().systems[0].v).x - before) / seconds;
            let expected = 9.81 * (angle.sin() - friction * angle.cos());
            // 2 % of the angle make 0.09 m/s²; rocking of the block averages out over its periods
            assert!((measured - expected).abs() < 0.02 * expected, "{name}: {measured} {expected}");
        }
    }
}

/// While a block sticks, kinetic, elastic and potential energy never exceed those of the start;
/// what friction took is on its account.
#[test]
fn sticking_makes_no_energy() {
    let friction = 0.8;
    let mut world = incline(0.2, friction, stepper("backward_euler"), 2e-3);
    let start = world.energy().total();
    let mut last = start;
    for step in 0..200 {
        world.step().unwrap();
        let total = world.energy().total();
        // backward Euler only ever loses; rounding of energies of this size is 1e-16
        assert!(total <= last + 1e-12 * start.abs().max(1.0), "step {step}: {last} {total}");
        last = total;
    }
    assert!(world.energy().by_force[2].1.dissipated >= 0.0);
}

/// A point that slides to rest on a plane loses its kinetic energy to friction, to the first order of the step.
#[test]
fn friction_turns_motion_to_heat() {
    let (mass, speed, friction, gravity, period) = (2.0, 1.5, 0.4, 9.81, 1e-3);
    let law =
        ContactLaw { stiffness: 1e4, damping: 0.0, friction, tangential_stiffness: 1e4, thickness: 0.0 };
    // at rest on the plane: k p = m g
    let start = Vec3::Y * (-mass * gravity / law.stiffness);
    let plane = Box::new(Plane { point: Vec3::ZERO, normal: Vec3::Y });
    let point = ContactPoint { row: 0, share: 1.0, start };
    let forces: Vec<Box<dyn Force>> = vec![
        Box::new(ShapeContact::new("contact", vec![point], plane, RigidMotion::default(), law).unwrap()),
        Box::new(
            PointLoad::new("weight", vec![(0, mass)], Arc::new(UniformForce(Vec3::Y * -gravity))).unwrap(),
        ),
    ];
    let mut world = world(&[start], &[Vec3::X * speed], &[mass], forces, stepper("symplectic_euler"), period);
    // stopped after v/(μ g) = 0.38 s; counted before the point swings about its anchor
    let (energy, mut heat) = (0.5 * mass * speed * speed, 0.0);
    let mut place = 0.0;
    for _ in 0..500 {
        world.step().unwrap();
        heat = world.energy().by_force[0].1.dissipated;
        place = world.state().systems[0].q[0].x;
    }
    // stopping distance v²/(2 μ g); the step blurs it by v h, the spring by μ m g/k_t
    let blur = speed * period + friction * mass * gravity / law.tangential_stiffness;
    assert!((place - speed * speed / (2.0 * friction * gravity)).abs() < 2.0 * blur, "{place}");
    assert!((heat - energy).abs() < 2.0 * friction * mass * gravity * blur, "{heat} {energy}");
}

/// The surface of a cube of tetrahedra, turned and moved.
fn cube(at: Vec3, turn: Vec3) -> TriangleSurface {
    let values = Values::new()
        .with("size", Value::Vector([1.0; 3]))
        .with("cells", Value::Vector([2.0; 3]))
        .with("element", Value::Text("tet4"));
    let mut surface = souple_mesh::generate("box", values).unwrap().boundary_surface();
    let turn = souple_math::exponential(turn);
    surface.points.iter_mut().for_each(|point| *point = turn * *point + at);
    surface
}

/// Two cubes, the second above the first with its bottom at `height`, and their contact.
pub(super) fn two_cubes(law: ContactLaw, height: f64, turn: Vec3) -> (Vec<Vec3>, SurfaceContact) {
    let (low, high) = (cube(Vec3::ZERO, Vec3::ZERO), cube(Vec3::new(0.23, height, 0.17), turn));
    let first = low.points.len() as u32;
    let positions = [low.points.clone(), high.points.clone()].concat();
    let side = |surface: TriangleSurface, first: u32| {
        let count = surface.points.len();
        let rows = (first..first + count as u32).collect();
        ContactSurface { surface: surface.into(), rows, shares: vec![1.0; count], later: Vec::new() }
    };
    (positions, SurfaceContact::new("contact", side(low, 0), side(high, first), law, 0.3).unwrap())
}

/// Points that stick and slide on faces, edges and corners agree with their derivatives, and neither push nor
/// turn the whole.
#[test]
fn surface_contacts_agree_with_energies_and_derivatives() {
    let (mut stuck, mut slid, mut over_edges) = (0, 0, 0);
    for law in laws().map(|law| ContactLaw { friction: 0.1 * law.friction, ..law }) {
        for turn in [Vec3::new(0.02, 0.3, 0.01), Vec3::new(PI / 4.0, 0.2, 0.5)] {
            for height in [0.97, 1.02] {
                let (positions, contact) = two_cubes(law, height, turn);
                let count = positions.len();
                let velocities: Vec<Vec3> = (0..count)
                    .map(|i| Vec3::new(0.3, (i as f64).sin(), (0.4 * i as f64).cos()) * 0.3)
                    .collect();
                for step in [1e-4, 0.1] {
                    let mut setting = Setting::new(&contact, positions.clone(), velocities.clone());
                    setting.find_pairs(&contact);
                    setting.advance(&contact, 0.01);
                    for (x, v) in setting.positions.iter_mut().zip(&velocities) {
                        *x += *v * step;
                    }
                    assert_force(&contact, &setting);
                    let touches = contact.touches(&setting.at());
                    stuck += touches.iter().filter(|touch| !touch.force.sliding).count();
                    slid += touches.iter().filter(|touch| touch.force.sliding).count();
                    over_edges += touches.iter().filter(|touch| touch.weights.contains(&0.0)).count();
                }
            }
        }
    }
    assert!(stuck > 20 && slid > 20 && over_edges > 5, "{stuck} {slid} {over_edges}");
}

/// Springs between all points of each of two bodies, the second of which starts at row `half`.
pub(super) fn springs_within(positions: &[Vec3], half: usize) -> Vec<Link> {
    let mut links = Vec::new();
    for a in 0..positions.len() {
        for b in (0..a).filter(|b| (*b < half) == (a < half)) {
            let rest_length = (positions[a] - positions[b]).length();
            links.push(Link::new(Combination::row(a as u32), Combination::row(b as u32), rest_length));
        }
    }
    links
}

/// Two cubes held in shape by springs, the upper one on its way to hit the lower one off its centre.
fn collision(stepper: Box<dyn Stepper>, period: f64) -> World {
    let law = ContactLaw { stiffness: 2e3, tangential_stiffness: 1e3, thickness: 0.0, ..LAW };
    let (positions, contact) = two_cubes(law, 1.1, Vec3::new(0.1, 0.3, 0.05));
    let half = positions.len() / 2;
    let links = springs_within(&positions, half);
    let forces: Vec<Box<dyn Force>> =
        vec![Box::new(contact), Box::new(Attachments::new("bodies", links, 200.0, 0.0).unwrap())];
    let velocities: Vec<Vec3> = (0..positions.len())
        .map(|row| if row < half { Vec3::ZERO } else { Vec3::new(0.3, -1.0, 0.1) })
        .collect();
    let masses = vec![0.05; positions.len()];
    world(&positions, &velocities, &masses, forces, stepper, period)
}

/// Two cubes held in shape by springs collide off-centre with friction and part again: momentum and angular
/// momentum stay to rounding, and a second run gives the same bits.
#[test]
fn a_collision_conserves_momentum() {
    let run = || collision(stepper("symplectic_euler"), 1e-3);
    let (mut once, mut again) = (run(), run());
    let half = once.state().systems[0].v.len() / 2;
    let (linear, angular) = once.momentum();
    let mut touched = false;
    for step in 0..800 {
        once.step().unwrap();
        again.step().unwrap();
        let forces: Vec<Vec3> =
            read(&mut once, |contact, at| contact.touches(at).iter().map(|t| t.force.normal).collect());
        touched |= !forces.is_empty();
        let (l, a) = once.momentum();
        // a rounding of every point's momentum per step
        let rounding = 1e-16 * 2.0 * half as f64 * f64::from(step + 1);
        assert!((l - linear).length() < rounding, "step {step}: {:?}", l - linear);
        assert!((a - angular).length() < 2.0 * rounding, "step {step}: {:?}", a - angular);
    }
    let v = &once.state().systems[0].v;
    assert!(touched && mean(&v[half..]).y > mean(&v[..half]).y, "the cubes did not part");
    assert!(read(&mut once, |contact, at| contact.touches(at).is_empty()));
    assert_eq!(once.state().hash(), again.state().hash());
}

/// The same collision in long implicit steps: every step finds its equilibrium, pairs come and go, and momentum
/// stays to what Newton's method leaves.
#[test]
fn an_implicit_collision_conserves_momentum() {
    let period = 0.01;
    let mut world = collision(stepper("backward_euler"), period);
    let (linear, _) = world.momentum();
    let mut most = 0;
    for step in 0..80 {
        world.step().unwrap_or_else(|error| panic!("step {step}: {error}"));
        most = most.max(read(&mut world, |contact, at| contact.touches(at).len()));
        // unbalanced forces of 1e-8 of those at work, some 100 N, for a step each
        let tolerance = 1e-8 * 100.0 * period * f64::from(step + 1);
        assert!((world.momentum().0 - linear).length() < tolerance, "step {step}");
    }
    assert!(most > 1, "{most}");
}

pub(super) fn read<T>(world: &mut World, ask: impl FnOnce(&SurfaceContact, &Configuration) -> T) -> T {
    world.with_system(0, |system, state, around, ws| {
        let contact = system.forces[0].as_any().downcast_ref::<SurfaceContact>().unwrap();
        ask(contact, &system.view(0, &ws.rows, state, around))
    })
}

/// A point on the surface itself, and triangles squeezed to a line, give finite forces.
#[test]
fn degenerate_surfaces() {
    let (mut positions, contact) = two_cubes(LAW, 1.0, Vec3::ZERO);
    // a corner of the upper cube's bottom on an edge of the lower one's top, and a triangle without area
    positions[30] = Vec3::new(0.5, 1.0, 0.25);
    positions[1] = positions[0];
    let count = positions.len();
    let mut setting = Setting::new(&contact, positions, vec![Vec3::ZERO; count]);
    setting.find_pairs(&contact);
    assert!(!setting.pairs.is_empty());
    assert!(setting.force(&contact).iter().all(|force| force.is_finite()));
    setting.advance(&contact, 0.01);
    assert!(setting.pairs.iter().all(|pair| pair.memory.iter().all(|number| number.is_finite())));
}

#[test]
fn bad_contacts_are_named() {
    let plane = || Box::new(Plane { point: Vec3::ZERO, normal: Vec3::Y });
    let bad = ContactLaw { friction: -0.1, ..LAW };
    let error = ShapeContact::new("contact", points(&[Vec3::ZERO]), plane(), RigidMotion::default(), bad);
    assert_eq!(
        error.unwrap_err().to_string(),
        "`friction` is -0.1, but must be a finite number of at least 0"
    );
    assert!(ShapeContact::new("contact", vec![], plane(), RigidMotion::default(), LAW).is_err());
    let side = |rows: std::ops::Range<u32>| {
        let surface = cube(Vec3::ZERO, Vec3::ZERO);
        let shares = vec![1.0; surface.points.len()];
        ContactSurface { surface: surface.into(), rows: rows.collect(), shares, later: Vec::new() }
    };
    let error = SurfaceContact::new("contact", side(0..26), side(25..51), LAW, 0.1).unwrap_err();
    assert_eq!(error, SurfaceContactError::SharedRow { row: 25 });
    let error = SurfaceContact::new("contact", side(0..20), side(30..56), LAW, 0.1).unwrap_err();
    assert_eq!(
        error.to_string(),
        "surface a of the contact: `rows` has 20 entries, but there are 26 of the surface's points; give as many"
    );
}
