//! Laws that a skin obeys: a sphere under tension shrinks by its formula, a skin comes to rest on its target, what is held
//! constant stays, and what splits is counted.

use std::f64::consts::PI;

use souple_engine::FieldState;
use souple_math::Vec3;
use souple_mesh::BoundingBox;
use souple_skin::target::particles::Density;
use souple_skin::target::{Combine, ISO, Moment, Part, Particle, Particles, Target, WARPS};
use souple_skin::{Lattice, Polygons, Skin, SkinScratch};
use souple_table::{Value, Values};

use crate::common::{number, part, skin, term};

fn ball(skin: &Skin, radius: f64, scratch: &mut SkinScratch) -> FieldState {
    let corner = Vec3::new(1.1, 1.1, 1.1) * radius;
    skin.start(-corner, corner, &|p| radius - p.length(), scratch).unwrap()
}

fn run(skin: &Skin, field: &mut FieldState, scratch: &mut SkinScratch, steps: usize, timestep: f64) {
    for step in 1..=steps {
        skin.step(&Moment::at(step as f64 * timestep), timestep, field, scratch).unwrap();
    }
}

/// Relative error of R² after a sphere lost a share of it under tension alone, by its volume.
fn shrunk(cells_per_diameter: f64, lost: f64) -> f64 {
    let (radius, beta) = (1.0, 0.1);
    let skin = skin(2.0 * radius / cells_per_diameter, vec![term("tension", &[("strength", number(beta))])]);
    let mut scratch = skin.new_scratch();
    let mut field = ball(&skin, radius, &mut scratch);
    let time = lost * radius * radius / (4.0 * beta);
    run(&skin, &mut field, &mut scratch, 4, time / 4.0);
    let volume = skin.view(&field).measures().volume;
    (0.75 * volume / PI).powf(2.0 / 3.0) / ((1.0 - lost) * radius * radius) - 1.0
}

/// It is gone when its formula says so, also where it shrinks onto a node of the grid, about which nothing slopes: to the time
/// in which a ball of three voxels would, below which its shape is not resolved.
#[test]
fn a_sphere_under_tension_vanishes() {
    let (radius, beta, voxel) = (0.3, 0.01, 0.05);
    for offset in [Vec3::ZERO, Vec3::new(0.013, 0.007, 0.011)] {
        let mut skin = skin(voxel, vec![term("tension", &[("strength", number(beta))])]);
        skin.lattice.origin = offset;
        let mut scratch = skin.new_scratch();
        let mut field = ball(&skin, radius, &mut scratch);
        let life = (radius * radius + 9.0 * voxel * voxel) / (4.0 * beta);
        run(&skin, &mut field, &mut scratch, 300, life / 300.0);
        assert_eq!(skin.view(&field).measures().components, 0, "{offset:?}");
    }
}

/// `R² = R0² − 4 β t`: to 1 % when it has halved, at a quarter of the cells that are asked for, and to 0.25 % at all 64 of them.
#[test]
fn a_sphere_under_tension_shrinks_by_its_formula() {
    for (cells, bar) in [(16.0, 0.01), (32.0, 0.005), (64.0, 0.0025)] {
        let error = shrunk(cells, 0.5);
        assert!(error.abs() < bar, "{error} at {cells} cells");
    }
}

/// A ball that is pressed in or blown up by many voxels stays round, and has the radius that its speed makes of it, at each of its
/// points: to a tenth of a voxel, a hundredth of the way, in long sub-steps and in short ones.
#[test]
fn a_pressed_ball_stays_round() {
    let voxel = 0.05;
    for (from, speed) in [(1.0, "-1"), (0.5, "1")] {
        let to: f64 = if from > 0.75 { 0.5 } else { 1.0 };
        for steps in [10_u32, 50, 250] {
            let skin = skin(voxel, vec![term("pressure", &[("speed", Value::Text(speed))])]);
            let mut scratch = skin.new_scratch();
            let mut field = ball(&skin, from, &mut scratch);
            run(&skin, &mut field, &mut scratch, steps as usize, 0.5 / f64::from(steps));
            let radii = scratch.points().iter().map(|point| point.length());
            let off = radii.map(|radius| (radius - to).abs()).fold(0.0, f64::max);
            assert!(off < 0.1 * voxel, "{off} m from {to} m in {steps} steps");
        }
    }
}

/// The error of that falls by the second order in space, as long as the sphere has lost little: a part of it is that of the
/// volume's chords, which a sphere at rest has too.
#[test]
fn shrinking_is_of_second_order() {
    let [coarse, fine] = [16.0, 32.0].map(|cells| shrunk(cells, 0.125));
    let order = (coarse / fine).abs().log2();
    assert!(order > 1.7, "order {order} of {coarse} and {fine}");
}

/// Mean of `κ` over a surface given by its distance, less what it must be, at three voxels.
fn curvature_errors(distance: impl Fn(Vec3) -> f64 + Sync, extent: f64, exact: f64) -> [f64; 3] {
    [1.0 / 8.0, 1.0 / 16.0, 1.0 / 32.0].map(|voxel| {
        let skin = Skin { redistance: 0.0, ..skin(voxel, Vec::new()) };
        let mut scratch = skin.new_scratch();
        let corner = Vec3::new(extent, extent, extent);
        let field = skin.start(-corner, corner, &|p| -distance(p), &mut scratch).unwrap();
        souple_skin::mean_curvature(skin.view(&field).grid, &skin.lattice) - exact
    })
}

/// The mean curvature of a sphere and of a torus to second order; point by point, and of a cylinder, in `surface.rs`.
#[test]
fn curvature_is_of_second_order() {
    let sphere = curvature_errors(|p| p.length() - 1.0, 1.2, 2.0);
    let (ring, tube) = (1.0, 0.4);
    let torus_distance = |p: Vec3| ((p.x.hypot(p.y) - ring).powi(2) + p.z * p.z).sqrt() - tube;
    // κ = 1/r + cos θ/(R + r cos θ): its integral over the area element r (R + r cos θ) is 4π² R
    let torus = curvature_errors(torus_distance, 1.5, 1.0 / tube);
    for errors in [sphere, torus] {
        println!("{errors:?}");
        // over a factor of four: how nodes lie to the surface makes each halving uneven
        let order = 0.5 * (errors[0] / errors[2]).abs().log2();
        assert!(order > 1.7, "order {order} of {errors:?}");
    }
}

/// On a fixed target the skin gets ever slower, without oscillation, until it rests, within half a voxel of it everywhere.
#[test]
fn a_skin_comes_to_rest_on_its_target() {
    // a five-hundredth of a voxel in a step [m/s], of half a metre per second at first
    const AT_REST: f64 = 1e-3;
    let voxel = 0.05;
    let point =
        |x: f64| part("point", &[("at", Value::Vector([x, 0.0, 0.0])), ("radius", Value::Number(0.5))]);
    let target = Target { parts: vec![point(-0.4), point(0.4)], iso: ISO };
    let mut skin = skin(voxel, vec![term("attraction", &[("strength", number(1.0))])]);
    skin.target = Some(target);
    let mut scratch = skin.new_scratch();
    let mut field = ball(&skin, 0.6, &mut scratch);
    let mut last = f64::INFINITY;
    for _ in 0..12 {
        run(&skin, &mut field, &mut scratch, 10, 0.1);
        let speed = skin.view(&field).speed();
        assert!(speed < last || speed < AT_REST, "{speed} after {last}: it does not only get slower");
        last = speed;
    }
    assert!(last < AT_REST, "{last}");
    let target = skin.target.as_ref().unwrap();
    let mut placed = target.new_scratch();
    target.place(&Moment::at(0.0), &mut placed).unwrap();
    for point in scratch.points() {
        // distance by the slope of the potential, to first order
        let slope = Vec3::from_array([Vec3::X, Vec3::Y, Vec3::Z].map(|e| {
            (target.excess(*point + e * 1e-5, &placed) - target.excess(*point - e * 1e-5, &placed)) / 2e-5
        }));
        let distance = target.excess(*point, &placed).abs() / slope.length();
        assert!(distance < 0.5 * voxel, "{distance}");
    }
}

/// Volume held against tension and area held against pressure drift by less than 0.1 % in 1,000 steps, once settled.
#[test]
fn what_is_held_constant_stays() {
    // γ_V (V0 − V)/V0 = β κ at rest: 0.1 % for γ = 2,000 β/R; γ_A (A0 − A)/A0 = p: 0.1 % for γ = 1,000 p
    let tension = || term("tension", &[("strength", number(1e-3))]);
    let pressure = || term("pressure", &[("speed", Value::Text("2e-3"))]);
    let held = |name: &str| term(name, &[("rate", number(4.0))]);
    for terms in [vec![tension(), held("constant_volume")], vec![pressure(), held("constant_area")]] {
        let holds_area = terms[0].tension() == 0.0;
        let skin = skin(1.0 / 8.0, terms);
        let mut scratch = skin.new_scratch();
        let mut field = ball(&skin, 1.0, &mut scratch);
        let of = |field: &FieldState| {
            let measures = skin.view(field).measures();
            if holds_area { measures.area } else { measures.volume }
        };
        let (start, mut worst) = (of(&field), 0.0_f64);
        for step in 1..=1000 {
            skin.step(&Moment::at(f64::from(step) * 0.01), 0.01, &mut field, &mut scratch).unwrap();
            worst = worst.max((of(&field) / start - 1.0).abs());
        }
        assert!(worst < 1e-3 && worst > 1e-5, "{worst}");
    }
}

/// Two balls that are drawn apart from one: components and Euler characteristic tell, and the surface stays whole.
#[test]
fn a_split_is_an_event() {
    let motion = |sign: &str| {
        let text = format!("[{sign}0.5*t, 0, 0]");
        Some(souple_formal::Formula::compile_vector::<3>(&text, &["t"]).unwrap())
    };
    let mut parts = Vec::new();
    for sign in ["-", ""] {
        let mut part = part("point", &[("at", Value::Vector([0.0; 3])), ("radius", Value::Number(0.3))]);
        part.motion = motion(sign);
        parts.push(part);
    }
    let mut skin = skin(0.05, vec![term("attraction", &[("strength", number(2.0))])]);
    skin.target = Some(Target { parts, iso: ISO });
    let mut scratch = skin.new_scratch();
    let mut field = ball(&skin, 0.4, &mut scratch);
    assert_eq!(skin.view(&field).measures().euler, 2);
    run(&skin, &mut field, &mut scratch, 40, 0.05);
    let view = skin.view(&field);
    assert_eq!((view.measures().euler, view.measures().components), (4, 2));
    assert!(view.events() == 1 && view.changed() > 0.5, "{} at {}", view.events(), view.changed());
}

/// The same bits by one thread and by several.
#[test]
fn threads_do_not_change_bits() {
    let result = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let terms = vec![
                term("tension", &[("strength", number(0.02))]),
                term("attraction", &[("strength", number(1.0))]),
                term("constant_volume", &[("rate", number(0.5))]),
            ];
            let mut skin = skin(0.1, terms);
            let at = Value::Vector([0.3, 0.0, 0.0]);
            let parts = vec![part("point", &[("at", at), ("radius", number(0.9))])];
            skin.target = Some(Target { parts, iso: ISO });
            let mut scratch = skin.new_scratch();
            let mut field = ball(&skin, 1.0, &mut scratch);
            run(&skin, &mut field, &mut scratch, 3, 0.1);
            field
        })
    };
    assert!(result(1) == result(4));
}

/// Bad beginnings end in words.
#[test]
fn bad_targets_end_in_words() {
    let skin = skin(0.1, Vec::new());
    let mut scratch = skin.new_scratch();
    let corner = Vec3::new(1.0, 1.0, 1.0);
    let mut refused = |value: &(dyn Fn(Vec3) -> f64 + Sync)| {
        skin.start(-corner, corner, value, &mut scratch).expect_err("it is refused").to_string()
    };
    assert!(refused(&|_| -1.0).contains("inside nowhere"));
    assert!(refused(&|_| 1.0).contains("on the border"));
    assert!(refused(&|p| if p.x > 0.3 { f64::NAN } else { -1.0 }).contains("expected a number"));
    // a thread thinner than a voxel, between nodes
    assert!(refused(&|p| 0.004 - (p.y - 0.071).hypot(p.z - 0.093)).contains("inside nowhere"));
    let fine = Skin { lattice: Lattice { voxel: 1e-9, origin: Vec3::ZERO }, ..skin };
    let error = fine.start(-corner, corner, &|p| 0.5 - p.length(), &mut fine.new_scratch()).unwrap_err();
    assert!(error.to_string().contains("larger voxels"), "{error}");
}

/// Particles that become eight of half their radius each do not show: in the step of the split the skin moves by what the change
/// of the density drives it in that time, where the level itself jumps; by less than half a voxel in all, and it stays in one piece.
#[test]
fn splitting_particles_do_not_show() {
    let (radius, split) = (0.1, 1.0);
    let mut particles = Vec::new();
    for i in 0..125_i32 {
        let place = Vec3::new((i % 5).into(), (i / 5 % 5).into(), (i / 25).into()) * (2.0 * radius);
        let led = |position: Vec3, radius: f64, during: [f64; 2]| Particle {
            position,
            velocity: Vec3::ZERO,
            radius,
            during,
        };
        particles.push(led(place, radius, [f64::NEG_INFINITY, split]));
        for corner in 0..8 {
            let sign = |bit: i32| if corner >> bit & 1 == 1 { 0.5 * radius } else { -0.5 * radius };
            let child = place + Vec3::new(sign(0), sign(1), sign(2));
            particles.push(led(child, 0.5 * radius, [split, f64::INFINITY]));
        }
    }
    let terms = vec![
        term("attraction", &[("strength", number(0.5))]),
        term("tension", &[("strength", number(0.002))]),
    ];
    let mut skin = skin(0.05, terms);
    let density = Density { particles: Particles::Led(particles) };
    skin.target = Some(Target { parts: vec![Part::new(Box::new(density))], iso: ISO });
    let target = skin.target.as_ref().unwrap();
    let mut placed = target.new_scratch();
    target.place(&Moment::at(0.0), &mut placed).unwrap();
    let bounds = target.bounds(&placed).unwrap();
    let mut scratch = skin.new_scratch();
    let mut field =
        skin.start(bounds.low, bounds.high, &|p| target.excess(p, &placed), &mut scratch).unwrap();
    let timestep = 0.05;
    // where the level that the skin is drawn to goes when all split at once
    let mut finer = target.new_scratch();
    target.place(&Moment::at(split), &mut finer).unwrap();
    let (mut before, mut settled, mut speed) = (Polygons::default(), 0.0, 0.0);
    let (mut change, mut jump) = (0.0_f64, 0.0_f64);
    for step in 1..=60 {
        skin.step(&Moment::at(f64::from(step) * timestep), timestep, &mut field, &mut scratch).unwrap();
        let view = skin.view(&field);
        assert_eq!((view.measures().components, view.events()), (1, 0));
        let now = Polygons { points: scratch.points().to_vec(), triangles: scratch.triangles().to_vec() };
        let moved = now.farthest_from(&before).unwrap_or(0.0).max(before.farthest_from(&now).unwrap_or(0.0));
        match step {
            19 => {
                (settled, speed) = (view.measures().volume, view.speed());
                let mut mean = 0.0;
                for p in &now.points {
                    let difference = (target.excess(*p, &finer) - target.excess(*p, &placed)).abs();
                    let far = difference / target.slope(*p, 0.5 * skin.lattice.voxel, &placed);
                    (change, jump) = (change.max(difference), jump.max(far));
                    mean += far / now.points.len() as f64;
                }
                // kernels of half the length round edges and corners by half as much: a third of a radius on the mean of this
                // cube, which is nearly all edges
                assert!(mean < radius / 3.0, "{mean}");
            }
            20 => {
                // α ΔG Δt, beside what it still did before; over corners as round as a particle that is right to (h/r)², as
                // `corners_of_particles_move_to_second_order` measures
                let known = (skin.lattice.voxel / radius).powi(2);
                let driven = (0.5 * change + speed) * timestep * (1.0 + known);
                assert!(moved < driven, "{moved} of {driven}");
                // which is a part of a voxel, and a small one of the way of the level itself
                assert!(moved < 0.25 * skin.lattice.voxel && moved < 0.2 * jump, "{moved} of {jump}");
            }
            _ => {}
        }
        before = now;
    }
    let after = skin.view(&field).measures().volume;
    // the finer kernel follows edges and corners more closely: on the mean by less than half a voxel
    let moved = (after - settled).abs() / skin.view(&field).measures().area;
    assert!(moved < 0.5 * skin.lattice.voxel, "{moved}");
}

/// The radius of a ball of as much volume.
fn radius_of(skin: &Skin, field: &FieldState) -> f64 {
    (0.75 / PI * skin.view(field).measures().volume).cbrt()
}

/// A speed that is the same everywhere moves a ball by as much, in short steps and in the longest.
#[test]
fn a_uniform_speed_moves_a_ball_by_as_much() {
    for cells in [8.0, 16.0] {
        for step in [0.1, 0.5] {
            let voxel = 1.0 / cells;
            let skin = skin(voxel, vec![term("pressure", &[("speed", Value::Text("1"))])]);
            let mut scratch = skin.new_scratch();
            let mut field = ball(&skin, 1.0, &mut scratch);
            let before = radius_of(&skin, &field);
            let steps = (0.5 * cells / step) as usize;
            run(&skin, &mut field, &mut scratch, steps, step * voxel);
            // to second order in the voxel over the radius, which is less than a hundredth for each voxel of the way
            let off = (radius_of(&skin, &field) - before) / voxel - steps as f64 * step;
            assert!(off.abs() < 0.1, "{off} voxels, {cells} cells, steps of {step}");
        }
    }
}

/// A speed that goes to and fro leaves the ball as it was: ten times by three voxels each way.
#[test]
fn a_pulsing_speed_comes_back() {
    let (voxel, step) = (0.05, 0.2);
    let speed = Value::Text("cos(6.283185307179586*t)");
    let skin = skin(voxel, vec![term("pressure", &[("speed", speed)])]);
    let mut scratch = skin.new_scratch();
    let mut field = ball(&skin, 0.4, &mut scratch);
    let before = radius_of(&skin, &field);
    run(&skin, &mut field, &mut scratch, (10.0 / (voxel * step)) as usize, voxel * step);
    // it went 127 voxels in all
    let off = (radius_of(&skin, &field) - before) / voxel;
    assert!(off.abs() < 0.3, "{off} voxels");
}

/// However strongly it is drawn, a skin rests on its target: sub-steps are as short as the slope of the target asks.
#[test]
fn a_skin_rests_however_strongly_it_is_drawn() {
    for strength in [1.0, 100.0, 2000.0] {
        let voxel = 0.05;
        let mut skin = skin(voxel, vec![term("attraction", &[("strength", number(strength))])]);
        let point = part("point", &[("at", Value::Vector([0.0; 3])), ("radius", number(0.4))]);
        skin.target = Some(Target { parts: vec![point], iso: ISO });
        let mut scratch = skin.new_scratch();
        let mut field = ball(&skin, 0.45, &mut scratch);
        // twenty times what it takes to come nearer by a factor e, in steps that are long for the strongest
        run(&skin, &mut field, &mut scratch, 30, (0.2 / strength).max(2e-3));
        let view = skin.view(&field);
        // a tenth of what it keeps running at in steps that overshoot
        assert!(view.speed() < 1e-3 * strength, "{} m/s at {strength}", view.speed());
        assert!((radius_of(&skin, &field) - 0.4).abs() < 0.1 * voxel, "{strength}");
    }
}

/// Each way to combine two parts says of every place what it says of sets; nothing can be taken from nothing.
#[test]
fn parts_combine_as_sets() {
    let point = |x: f64, combine: Combine| {
        let at = ("at", Value::Vector([x, 0.0, 0.0]));
        Part { combine, ..part("point", &[at, ("radius", number(0.5))]) }
    };
    let is_in = |x: f64, p: Vec3| (p - Vec3::X * x).length() < 0.5;
    for (combine, holds) in [
        (Combine::Union, (|a, b| a || b) as fn(bool, bool) -> bool),
        (Combine::Difference, |a, b| a && !b),
        (Combine::Intersection, |a, b| a && b),
    ] {
        let target = Target { parts: vec![point(0.0, Combine::Blend), point(0.4, combine)], iso: ISO };
        let mut placed = target.new_scratch();
        target.place(&Moment::at(0.0), &mut placed).unwrap();
        for i in 0..1000_i32 {
            let steps = Vec3::new((i % 10).into(), (i / 10 % 10).into(), (i / 100).into());
            let p = steps * 0.183 - Vec3::new(0.7, 0.81, 0.79);
            let expected = holds(is_in(0.0, p), is_in(0.4, p));
            assert_eq!(target.excess(p, &placed) > 0.0, expected, "{combine:?} at {p:?}");
        }
        let alone = Target { parts: vec![point(0.0, combine)], iso: ISO };
        let placed = alone.place(&Moment::at(0.0), &mut alone.new_scratch());
        assert_eq!(placed.is_ok(), combine == Combine::Union, "{combine:?}");
    }
}

/// What a warp makes of a box lies in the box that it tells: points of the box are found where the warp brings them.
#[test]
fn warps_stay_in_their_bounds() {
    let low = Vec3::new(-0.6, -0.3, -0.2);
    let high = Vec3::new(0.5, 0.3, 0.4);
    for (name, rate) in
        [("twist", 3.0), ("bend", 1.5), ("bend", -2.0), ("taper", 1.0), ("taper", -3.0), ("taper", 10.0)]
    {
        let entry = WARPS.find(name).unwrap();
        let mut values = Values::new();
        values.set("rate".to_owned(), number(rate));
        let warp = (entry.build)(&entry.values(values).unwrap());
        let bounds = warp.bounds(BoundingBox { low, high });
        let far = bounds.grown(0.5);
        let size = far.high - far.low;
        for i in 0..64_000_i32 {
            let share = Vec3::new((i % 40).into(), (i / 40 % 40).into(), (i / 1600).into()) * (1.0 / 39.0);
            let p = far.low + Vec3::new(share.x * size.x, share.y * size.y, share.z * size.z);
            let before = warp.undo(p);
            let was_inside = (0..3).all(|axis| low[axis] <= before[axis] && before[axis] <= high[axis]);
            let is_told = (0..3).all(|axis| bounds.low[axis] <= p[axis] && p[axis] <= bounds.high[axis]);
            assert!(is_told || !was_inside, "{name} {rate}: {p:?} was {before:?}");
        }
    }
}
