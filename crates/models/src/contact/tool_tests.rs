//! Tools against triangles.

use std::sync::Arc;

use souple_engine::{Configuration, Force, Pair, TangentWeights};
use souple_math::Vec3;
use souple_mesh::{TriangleSurface, closest_segment_triangle};

use super::shape::{Capsule, Jaws, Sphere};
use super::{ContactLaw, Shape, ToolContact, ToolSurface};
use crate::loads::{FormulaVector, RigidMotion};

const SMOOTH: ContactLaw =
    ContactLaw { stiffness: 300.0, damping: 0.0, friction: 0.0, tangential_stiffness: 0.0, thickness: 0.0 };

/// A square sheet about the origin that faces up, of `count²` squares of side `size`, with a swell in it.
fn sheet(count: usize, size: f64) -> TriangleSurface {
    let at = |i: usize, j: usize| {
        let [x, y] = [i, j].map(|k| (k as f64 - 0.5 * count as f64) * size);
        Vec3::new(x, y, 0.03 * libm::sin(9.0 * x) * libm::cos(7.0 * y))
    };
    let points = (0..=count).flat_map(|i| (0..=count).map(move |j| at(i, j))).collect();
    let corner = |i: usize, j: usize| (i * (count + 1) + j) as u32;
    let mut triangles = Vec::new();
    for i in 0..count {
        for j in 0..count {
            triangles.push([corner(i, j), corner(i + 1, j), corner(i + 1, j + 1)]);
            triangles.push([corner(i, j), corner(i + 1, j + 1), corner(i, j + 1)]);
        }
    }
    TriangleSurface::new(points, triangles).unwrap()
}

/// A tool over a sheet whose points are the rows, led as a formula says.
struct Setting {
    contact: ToolContact,
    positions: Vec<Vec3>,
    velocities: Vec<Vec3>,
    memory: Vec<f64>,
}

impl Setting {
    fn new(shape: Box<dyn Shape>, motion: &str, law: ContactLaw, horizon: f64) -> Self {
        let surface = sheet(12, 0.1);
        let positions = surface.points.clone();
        let rows = (0..positions.len() as u32).collect();
        let translation = Some(Arc::new(FormulaVector::compile(motion).unwrap()) as _);
        let motion = RigidMotion { translation, ..RigidMotion::default() };
        let contact = ToolContact::new(
            "tool",
            ToolSurface { surface: surface.into(), rows },
            shape,
            motion,
            law,
            [0.1, horizon],
        )
        .unwrap();
        let mut memory = vec![0.0; contact.memory_len()];
        contact.initial_memory(&mut memory);
        Self { velocities: vec![Vec3::ZERO; positions.len()], contact, positions, memory }
    }

    fn at<'a>(&'a self, time: f64, pairs: &'a [Pair]) -> Configuration<'a> {
        Configuration {
            positions: &self.positions,
            velocities: &self.velocities,
            time,
            load: 1.0,
            memory: &self.memory,
            pairs,
            kept: souple_engine::KeptRef::default(),
            driven: &[],
            fields: &[],
        }
    }

    /// Pairs found at a time, with those known.
    fn search(&self, time: f64, known: &[Pair]) -> Vec<Pair> {
        let (mut scratch, mut found) = (self.contact.new_scratch(), Vec::new());
        self.contact.find_pairs(&self.at(time, known), &mut scratch, &mut found);
        found.sort_unstable_by_key(|pair| (pair.a, pair.b));
        found
    }

    fn force(&self, time: f64, pairs: &[Pair]) -> Vec<Vec3> {
        let mut out = vec![Vec3::ZERO; self.positions.len()];
        self.contact.add_force(&self.at(time, pairs), &mut self.contact.new_scratch(), &mut out);
        out
    }
}

fn rod() -> Capsule {
    Capsule { from: Vec3::new(-0.13, 0.02, 0.14), to: Vec3::new(0.22, 0.05, 0.07), radius: 0.1 }
}

/// The triangles that touch are those that a look at each of them finds.
#[test]
fn touching_triangles_are_those_of_brute_force() {
    let jaws = Jaws::new(Vec3::new(0.0, 0.0, 0.26), [-Vec3::Z, Vec3::X], 0.25, 0.06, 1.0);
    let shapes: [Box<dyn Shape>; 3] =
        [Box::new(Sphere::new(Vec3::new(0.04, 0.07, 0.1), 0.2)), Box::new(rod()), Box::new(jaws)];
    for shape in shapes {
        let parts = shape.parts().to_vec();
        let setting = Setting::new(shape, "[0, 0, 0]", SMOOTH, 0.01);
        let pairs = setting.search(0.0, &[]);
        let found: Vec<(u32, f64)> = setting
            .contact
            .touches(&setting.at(0.0, &pairs))
            .iter()
            .map(|touch| (touch.triangle, touch.penetration))
            .collect();
        let surface = sheet(12, 0.1);
        let mut expected = Vec::new();
        for triangle in 0..surface.triangles.len() as u32 {
            for part in &parts {
                let nearest = closest_segment_triangle([part.from, part.to], surface.corners(triangle));
                let depth = part.radius - nearest.distance_sq.sqrt();
                if depth > 0.0 {
                    expected.push((triangle, depth));
                }
            }
        }
        assert!(expected.len() > 4);
        assert_eq!(found.len(), expected.len(), "{parts:?}");
        for (found, expected) in found.iter().zip(&expected) {
            assert!(found.0 == expected.0 && (found.1 - expected.1).abs() < 1e-12, "{found:?} {expected:?}");
        }
    }
}

/// What a tool gives is minus the gradient of what it stores.
#[test]
fn forces_are_slopes_of_the_energy() {
    let mut setting = Setting::new(Box::new(rod()), "[0, 0, 0]", SMOOTH, 0.01);
    let pairs = setting.search(0.0, &[]);
    let force = setting.force(0.0, &pairs);
    let energy = |setting: &Setting| {
        setting.contact.energy(&setting.at(0.0, &pairs), &mut setting.contact.new_scratch()).stored
    };
    let step = 1e-6;
    let largest = force.iter().map(|force| force.length()).fold(0.0, f64::max);
    assert!(largest > 1.0);
    for row in 0..setting.positions.len() {
        let start = setting.positions[row];
        let along = |sign: f64, setting: &mut Setting| {
            setting.positions[row] = start + Vec3::Z * (sign * step);
            energy(setting)
        };
        let slope = (along(1.0, &mut setting) - along(-1.0, &mut setting)) / (2.0 * step);
        setting.positions[row] = start;
        // E''' h² and rounding of energies of some joules
        assert!((force[row].z + slope).abs() < 1e-5 * largest, "{row}: {} {slope}", force[row].z);
    }
}

/// A tool that is through the sheet within one step finds it still in front, and is pushed back the harder the farther it is.
#[test]
fn fast_tools_do_not_pass() {
    let tip = Capsule { from: Vec3::new(0.04, 0.03, 1.0), to: Vec3::new(0.03, 0.05, 0.2), radius: 0.02 };
    let shapes: [(Box<dyn Shape>, f64); 2] =
        [(Box::new(Sphere::new(Vec3::new(0.04, 0.03, 0.4), 0.05)), 0.4), (Box::new(tip), 0.2)];
    for (shape, height) in shapes {
        let setting = Setting::new(shape, "[0, 0, -100 * t]", SMOOTH, 0.01);
        let pairs = setting.search(0.0, &[]);
        assert!(setting.force(0.0, &pairs).iter().all(|force| *force == Vec3::ZERO));
        let mut before = 0.0;
        for time in [0.005, 0.0055, 0.006] {
            let force: Vec3 = setting.force(time, &pairs).into_iter().sum();
            // the sheet is pushed on, at least by the triangle in the way with what it is behind; those beside it let go
            let behind = 100.0 * time - height - 0.05;
            assert!(force.z < -200.0 * behind, "{time}: {force:?}");
            before = force.z;
        }
        // one that is far off and fast stays known until it comes
        let early = setting.search(-0.02, &[]);
        let mut pairs = setting.search(-0.01, &early);
        pairs = setting.search(0.0, &pairs);
        let force: Vec3 = setting.force(0.006, &pairs).into_iter().sum();
        assert!(force.z < 0.5 * before, "{force:?}");
        // and what it went through is still known when searched again
        let again = setting.search(0.006, &pairs);
        let found: Vec3 = setting.force(0.006, &again).into_iter().sum();
        assert_eq!(found, force);
    }
}

/// A needle between the corners of a triangle touches it, which points would not see.
#[test]
fn thin_tools_touch_triangles() {
    let needle =
        Capsule { from: Vec3::new(0.065, 0.03, 1.0), to: Vec3::new(0.065, 0.03, 0.02), radius: 0.01 };
    let setting = Setting::new(Box::new(needle), "[0, 0, -t]", SMOOTH, 0.01);
    let pairs = setting.search(0.0, &[]);
    let force: Vec3 = setting.force(0.02, &pairs).into_iter().sum();
    assert!(force.z < 0.0, "{force:?}");
    // which is handed on to the corners by the weights of the place: the moment is kept
    let moment: Vec3 = setting
        .force(0.02, &pairs)
        .iter()
        .zip(&setting.positions)
        .map(|(force, place)| (*place - Vec3::new(0.065, 0.03, 0.0)).cross(*force))
        .sum();
    assert!(moment.length() < 0.02 * force.length());
}

/// Sticking triangles are held by the tangent, sliding ones slip, and the anchor follows within what friction can hold.
#[test]
fn friction_holds_up_to_its_limit() {
    let law = ContactLaw { friction: 0.5, tangential_stiffness: 300.0, ..SMOOTH };
    let setting = Setting::new(Box::new(Sphere::new(Vec3::new(0.0, 0.0, 0.15), 0.2)), "[t, 0, 0]", law, 0.01);
    let mut pairs = setting.search(0.0, &[]);
    let mut memory = setting.memory.clone();
    let (mut least, mut ratio) = (f64::INFINITY, 0.0_f64);
    for step in 1..=20 {
        let time = f64::from(step) * 1e-3;
        let at = setting.at(time, &pairs);
        for touch in setting.contact.touches(&at) {
            let share = touch.force.friction.length() / touch.force.normal.length();
            ratio = ratio.max(share);
            least = least.min(touch.force.friction.x);
        }
        let mut next = pairs.clone();
        setting.contact.advance_memory(&at, 1e-3, &mut memory, &mut next);
        pairs = next;
    }
    // drawn along with the tool, by no more than the limit
    assert!(least > -1e-9 && ratio > 0.3 && ratio <= 0.5 * (1.0 + 1e-12), "{least} {ratio}");
    assert!(memory[0] > 0.0);
    // blocks say what differentials say
    let at = setting.at(0.02, &pairs);
    let delta: Vec<Vec3> = (0..setting.positions.len()).map(|row| Vec3::X * (row as f64).sin()).collect();
    let mut out = vec![Vec3::ZERO; delta.len()];
    let weights = TangentWeights { position: 1.0, velocity: 0.0 };
    setting.contact.add_differential(&at, weights, &delta, &mut setting.contact.new_scratch(), &mut out);
    let work: f64 = out.iter().zip(&delta).map(|(force, delta)| force.dot(*delta)).sum();
    assert!(work < 0.0);
}
