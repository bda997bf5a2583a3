//! Orders of the method itself: values at the nodes against exact distances, without triangles between.

use std::f64::consts::PI;

use souple_engine::FieldState;
use souple_math::Vec3;
use souple_skin::target::particles::Density;
use souple_skin::target::{ISO, Moment, Part, Particle, Particles, Target};
use souple_skin::{Skin, surface_of};
use souple_table::Value;

use crate::common::{nodes, number, skin, term};

/// What tension makes of a surface in a time [s], by its nodes: where `exact` is 0 the surface must be.
struct Shrinking {
    skin: Skin,
    field: FieldState,
}

const BETA: f64 = 0.1;

impl Shrinking {
    /// From the zero level of a distance, positive inside.
    fn run(
        voxel: f64,
        distance: &(dyn Fn(Vec3) -> f64 + Sync),
        extent: Vec3,
        time: f64,
        steps: usize,
    ) -> Self {
        let skin = skin(voxel, vec![term("tension", &[("strength", number(BETA))])]);
        let mut scratch = skin.new_scratch();
        let mut field = skin.start(-extent, extent, distance, &mut scratch).unwrap();
        for step in 1..=steps {
            let timestep = time / steps as f64;
            skin.step(&Moment::at(step as f64 * timestep), timestep, &mut field, &mut scratch).unwrap();
        }
        Self { skin, field }
    }

    /// Mean and greatest error of the nodes nearer than a voxel [m].
    fn errors(&self, exact: impl Fn(Vec3) -> f64) -> [f64; 2] {
        let (mut sum, mut count, mut worst) = (0.0, 0.0, 0.0_f64);
        for (place, value) in nodes(&self.skin, &self.field) {
            if value.abs() < self.skin.lattice.voxel {
                let error = value - exact(place);
                (sum, count, worst) = (sum + error, count + 1.0, worst.max(error.abs()));
            }
        }
        [sum / count, worst]
    }
}

/// The order at which errors fall from one voxel to half of it.
fn order([coarse, fine]: [f64; 2]) -> f64 {
    (coarse / fine).abs().log2()
}

/// Where nothing is left of triangles, a sphere that has lost an eighth of `R²` is where `R² = R0² − 4 β t` has it to second order.
#[test]
fn a_sphere_shrinks_to_second_order_at_its_nodes() {
    let lost: f64 = 0.125;
    let radius = (1.0 - lost).sqrt();
    let corner = Vec3::new(1.1, 1.1, 1.1);
    let mean = |cells: f64| {
        let ball = |p: Vec3| 1.0 - p.length();
        let run = Shrinking::run(2.0 / cells, &ball, corner, lost / (4.0 * BETA), 4);
        run.errors(|p| radius - p.length())[0]
    };
    let means = [16.0, 32.0, 64.0].map(mean);
    println!("{means:?} m");
    for pair in means.windows(2) {
        let order = order([pair[0], pair[1]]);
        assert!(order > 1.7, "order {order} of {means:?}");
    }
}

/// What a skin begins with are distances, the greatest error of a node beside the surface to second order at least.
#[test]
fn a_beginning_is_of_second_order_at_its_nodes() {
    let worst = |cells: f64| {
        let ball = |p: Vec3| 1.0 - p.length();
        let run = Shrinking::run(2.0 / cells, &ball, Vec3::new(1.1, 1.1, 1.1), 0.0, 0);
        run.errors(ball)[1]
    };
    let worst = [16.0, 32.0].map(worst);
    assert!(order(worst) > 1.7, "{worst:?}");
}

/// A convex body of revolution about x under tension alone, by its support function `h(θ)` at the angle `θ` between its normal and x:
/// `∂h/∂t = −β (1/ρ₁ + 1/ρ₂)` with `ρ₁ = h + h″`, `ρ₂ = h + h′ cot θ`, by finite differences of second order between the pole and the
/// equator, of which it is the mirror. No grid knows of it.
struct Support {
    values: Vec<f64>,
}

impl Support {
    /// Of the semi-axes along x and across.
    fn of_ellipsoid(along: f64, across: f64, count: usize) -> Self {
        let value = |k: usize| {
            let (sin, cos) = Self::angle(k, count).sin_cos();
            (along * cos).hypot(across * sin)
        };
        Self { values: (0..count).map(value).collect() }
    }

    fn angle(k: usize, count: usize) -> f64 {
        (k as f64 + 0.5) * 0.5 * PI / count as f64
    }

    /// Both radii of curvature at each angle.
    fn radii(values: &[f64]) -> impl Iterator<Item = [f64; 2]> {
        let count = values.len();
        let step = 0.5 * PI / count as f64;
        (0..count).map(move |k| {
            let (before, h, after) = (values[k.saturating_sub(1)], values[k], values[(k + 1).min(count - 1)]);
            let bend = (before - 2.0 * h + after) / (step * step);
            let slope = (after - before) / (2.0 * step);
            [h + bend, h + slope / Self::angle(k, count).tan()]
        })
    }

    /// After a time, by the midpoint rule.
    fn shrunk(mut self, time: f64) -> Self {
        let count = self.values.len();
        let step = 0.5 * PI / count as f64;
        let least = Self::radii(&self.values).flatten().fold(f64::INFINITY, f64::min);
        // half of what diffusion by β/ρ² along the angle bears, since radii shrink on the way
        let steps = (time / (0.1 * step * step * least * least / BETA)).ceil();
        let timestep = time / steps;
        let rates = |values: &[f64]| -> Vec<f64> {
            Self::radii(values).map(|[along, around]| -BETA * (1.0 / along + 1.0 / around)).collect()
        };
        for _ in 0..steps as usize {
            let rate = rates(&self.values);
            let middle: Vec<f64> =
                self.values.iter().zip(&rate).map(|(h, rate)| h + 0.5 * timestep * rate).collect();
            self.values.iter_mut().zip(rates(&middle)).for_each(|(h, rate)| *h += timestep * rate);
        }
        self
    }

    /// The distance of a point, positive inside: the least from the planes that bear the body, inside and outside.
    fn distance(&self, point: Vec3) -> f64 {
        let (along, across) = (point.x.abs(), point.y.hypot(point.z));
        let count = self.values.len();
        let to_plane = |k: usize| {
            let (sin, cos) = Self::angle(k, count).sin_cos();
            self.values[k] - along * cos - across * sin
        };
        let nearest = (0..count).min_by(|a, b| to_plane(*a).total_cmp(&to_plane(*b))).unwrap();
        // the lowest point of a parabola through three planes
        let (before, at, after) =
            (to_plane(nearest.saturating_sub(1)), to_plane(nearest), to_plane((nearest + 1).min(count - 1)));
        let bend = before - 2.0 * at + after;
        if bend > 0.0 { at - 0.125 * (after - before).powi(2) / bend } else { at }
    }

    fn volume(&self) -> f64 {
        let count = self.values.len();
        let step = 0.5 * PI / count as f64;
        // a third of h dA with dA = 2π ρ₁ ρ₂ sin θ dθ, on both sides of the equator
        let part = |(k, [along, around]): (usize, [f64; 2])| {
            self.values[k] * along * around * Self::angle(k, count).sin()
        };
        4.0 / 3.0 * PI * step * Self::radii(&self.values).enumerate().map(part).sum::<f64>()
    }
}

/// A body that is no ball shrinks as its support function does, of which the reference knows to four digits more than the coarser grid.
#[test]
fn an_ellipsoid_shrinks_to_second_order_at_its_nodes() {
    let (time, count) = (0.4, 200);
    let start = Support::of_ellipsoid(1.2, 0.8, count);
    // 4/3 π a b², to the square of the angle's step
    let exact = 4.0 / 3.0 * PI * 1.2 * 0.64;
    assert!((start.volume() / exact - 1.0).abs() < (0.5 * PI / count as f64).powi(2), "{}", start.volume());
    let end = Support::of_ellipsoid(1.2, 0.8, count).shrunk(time);
    let mean = |voxel: f64| {
        let corner = Vec3::new(1.3, 0.9, 0.9);
        Shrinking::run(voxel, &|p| start.distance(p), corner, time, 4).errors(|p| end.distance(p))[0]
    };
    let means = [1.0 / 8.0, 1.0 / 16.0].map(mean);
    println!("{means:?} m");
    assert!(order(means) > 1.7, "order {} of {means:?}", order(means));
}

/// A speed that is the same everywhere moves a skin over corners as round as a particle by as much, to second order in the voxel over
/// the radius of a particle, and less than the square of that off. `splitting_particles_do_not_show` stands on it.
#[test]
fn corners_of_particles_move_to_second_order() {
    let (radius, way) = (0.1, 0.01);
    let particle = |i: i32| Particle {
        position: Vec3::new((i % 5).into(), (i / 5 % 5).into(), (i / 25).into()) * (2.0 * radius),
        velocity: Vec3::ZERO,
        radius,
        during: [f64::NEG_INFINITY, f64::INFINITY],
    };
    let density = Density { particles: Particles::Led((0..125).map(particle).collect()) };
    let target = Target { parts: vec![Part::new(Box::new(density))], iso: ISO };
    let mut placed = target.new_scratch();
    target.place(&Moment::at(0.0), &mut placed).unwrap();
    let bounds = target.bounds(&placed).unwrap();
    let worst = |share: f64| {
        let skin = skin(share * radius, vec![term("pressure", &[("speed", Value::Text("1"))])]);
        let mut scratch = skin.new_scratch();
        let excess = |p: Vec3| target.excess(p, &placed);
        let mut field = skin.start(bounds.low, bounds.high, &excess, &mut scratch).unwrap();
        let before = surface_of(skin.view(&field).grid, &skin.lattice).0;
        skin.step(&Moment::at(way), way, &mut field, &mut scratch).unwrap();
        // by the values where the surface was: triangles would add their chords
        let grid = skin.view(&field).grid;
        let moved = |p: &Vec3| grid.sample(skin.lattice.to_voxels(*p)).0 * skin.lattice.voxel;
        before.points.iter().map(|p| (moved(p) / way - 1.0).abs()).fold(0.0, f64::max)
    };
    let shares = [1.0 / 2.0, 1.0 / 4.0];
    let errors = shares.map(worst);
    println!("{errors:?} of the way");
    assert!(order(errors) > 1.7, "order {} of {errors:?}", order(errors));
    for (share, error) in shares.into_iter().zip(errors) {
        assert!(error < share * share, "{error} at {share} radii");
    }
}
