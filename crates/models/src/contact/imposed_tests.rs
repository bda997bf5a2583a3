//! Tools that move the surface.

use std::sync::Arc;

use souple_engine::{Configuration, Felt, Force, Holding, Told};
use souple_math::Vec3;
use souple_mesh::TriangleSurface;

use super::shape::{Capsule, Jaws, Sphere};
use super::{ContactLaw, Displacing, ImposedContact, ImposedLaw, Shape, ToolContact, ToolSurface};
use crate::loads::{FormulaVector, RigidMotion};

const LAW: ImposedLaw =
    ImposedLaw { fraction: 1.0, residual: 0.0, displacing: Displacing::Progressively, felt: Felt::Area };
const PERIOD: f64 = 0.01;

/// A ball against a triangle that faces up, and one that faces up in a corner far away.
struct Setting {
    contact: ImposedContact,
    positions: Vec<Vec3>,
    memory: Vec<f64>,
}

fn triangles() -> TriangleSurface {
    let points = [(0.0, 0.0), (3.0, 0.0), (0.0, 3.0), (9.0, 9.0), (10.0, 9.0), (9.0, 10.0)];
    let points = points.map(|(x, y)| Vec3::new(x, y, 0.0)).to_vec();
    TriangleSurface::new(points, vec![[0, 1, 2], [3, 4, 5]]).unwrap()
}

/// Of radius 2, 1.9 above the triangle and nearest to its second corner: a disc of it reaches in.
fn ball() -> Sphere {
    Sphere::new(Vec3::new(1.2, 0.8, 1.9), 2.0)
}

fn led(motion: &str) -> RigidMotion {
    let translation = Some(Arc::new(FormulaVector::compile(motion).unwrap()) as _);
    RigidMotion { translation, ..RigidMotion::default() }
}

impl Setting {
    fn new(motion: &str, law: ImposedLaw) -> Self {
        Self::of(Box::new(ball()), motion, law)
    }

    fn of(shape: Box<dyn Shape>, motion: &str, law: ImposedLaw) -> Self {
        let surface = triangles();
        let positions = surface.points.clone();
        let touched = ToolSurface { surface: surface.into(), rows: (0..6).collect() };
        let contact = ImposedContact::new("tool", touched, shape, led(motion), law, PERIOD).unwrap();
        let mut memory = vec![0.0; contact.memory_len()];
        contact.initial_memory(&mut memory);
        Self { contact, positions, memory }
    }

    /// Looks as the memory stands, and says what the points have been told.
    fn look(&mut self) -> Vec<Told> {
        let velocities = vec![Vec3::ZERO; 6];
        let before = self.memory.clone();
        let at = Configuration {
            positions: &self.positions,
            velocities: &velocities,
            time: 0.0,
            load: 1.0,
            memory: &before,
            pairs: &[],
            kept: souple_engine::KeptRef::default(),
            driven: &[],
            fields: &[],
        };
        self.contact.look(&at, &mut self.contact.new_scratch(), &mut self.memory);
        let mut told = Vec::new();
        self.contact.visit_told(&self.memory, &mut |point| told.push(*point));
        told
    }
}

/// The centroid of what reaches in leaves the ball, against the normal; the areas of the points in touch are shares of the disc, in
/// proportion to the weights of its centroid.
#[test]
fn centroids_are_moved_out() {
    for residual in [0.0, 0.03] {
        let mut setting = Setting::new("[0, 0, 0]", ImposedLaw { residual, ..LAW });
        let told = setting.look();
        assert!(told.iter().map(|point| point.is_held).eq([true, true, true, false, false, false]));
        let contact: f64 = told.iter().map(|point| point.contact_area).sum();
        let weights: Vec<f64> = told[..3].iter().map(|point| point.contact_area / contact).collect();
        let place: Vec3 = (0..3).map(|k| setting.positions[k] * weights[k]).sum();
        let moved: Vec3 = (0..3).map(|k| told[k].displacement * weights[k]).sum();
        // a plane at 1.9 from the middle of a ball of radius 2, straight down from there; the pieces are symmetric about it to
        // a part of their side, 3/16, and what that shifts the centroid by is of second order in the depth
        assert!((moved.z + 0.1 - residual).abs() < 1e-3 && moved.x == 0.0 && moved.y == 0.0, "{moved:?}");
        assert!((place - Vec3::new(1.2, 0.8, 0.0)).length() < 0.02, "{place:?}");
        // 2 r d - d² = 0.39: π of it, less the strips of chords as long as a piece
        let disc = std::f64::consts::PI * 0.39;
        assert!(contact < disc && contact > 0.9 * disc, "{contact} {disc}");
        assert!(told.iter().map(|point| point.area).eq([1.5, 1.5, 1.5, 1.0 / 6.0, 1.0 / 6.0, 1.0 / 6.0]));
    }
}

/// Displacements go evenly through a period, or in its first step.
#[test]
fn displacements_are_made() {
    let mut even = Setting::new("[0, 0, 0]", LAW);
    even.look();
    assert_eq!(even.contact.pace(1e-3, &even.memory), 1.0 / PERIOD);
    let mut at_once = Setting::new("[0, 0, 0]", ImposedLaw { displacing: Displacing::AtOnce, ..LAW });
    at_once.look();
    assert_eq!(at_once.contact.pace(1e-3, &at_once.memory), 1e3);
    let before = at_once.memory.clone();
    let (positions, contact) = (&at_once.positions, &at_once.contact);
    let at = Configuration {
        positions,
        velocities: positions,
        time: 0.0,
        load: 1.0,
        memory: &before,
        pairs: &[],
        kept: souple_engine::KeptRef::default(),
        driven: &[],
        fields: &[],
    };
    contact.advance_memory(&at, 1e-3, &mut at_once.memory, &mut []);
    assert_eq!(at_once.contact.pace(1e-3, &at_once.memory), 0.0);
}

/// A tool that goes away lets go of points that would have to be pulled to come along (V-44), and of no others; those that still press
/// come after it as far as it goes, and those that do not stay.
#[test]
fn what_would_be_pulled_is_let_go() {
    let residual = ImposedLaw { residual: 0.2, ..LAW };
    for (motion, pressing, held, follows) in [
        ("[0, 0, t]", -1.0, false, false),
        ("[0, 0, t]", 1.0, true, true),
        ("[0, 0, -t]", -1.0, true, false),
        ("[0, 0, -t]", 1.0, true, false),
    ] {
        let mut setting = Setting::new(motion, residual);
        assert!(setting.look().iter().take(3).all(|point| point.displacement == Vec3::ZERO));
        setting.contact.note_forces(&[Vec3::Z * pressing; 6], &mut setting.memory);
        let told = setting.look();
        assert_eq!(told[0].is_held, held, "{motion} {pressing}");
        assert_eq!(told[0].displacement.z > 0.0, follows, "{motion} {pressing}");
    }
}

/// What is felt changes by a part of the larger of the two; the greatest since the last look is known.
#[test]
fn jumps_are_known() {
    let mut setting = Setting::new("[0, 0, 0]", LAW);
    setting.look();
    for (force, jump) in [(2.0, 1.0), (1.0, 1.0)] {
        setting.contact.feel(Vec3::Z * force, Vec3::Z, &mut setting.memory);
        assert_eq!(setting.contact.jump(&setting.memory), jump);
    }
    setting.look();
    setting.contact.feel(Vec3::Z * 0.75, Vec3::Z, &mut setting.memory);
    setting.contact.feel(Vec3::Z * 0.9, Vec3::Z, &mut setting.memory);
    assert_eq!(setting.contact.jump(&setting.memory), 0.25);
}

/// The body bears all of a tool's force, of which the hand feels a weighed part: shared among points by what is in touch around them.
#[test]
fn the_body_bears_all_of_it() {
    let mut setting = Setting::new("[0, 0, 0]", LAW);
    setting.look();
    setting.contact.feel(Vec3::Z * 0.25, Vec3::new(0.5, 0.0, 2.0), &mut setting.memory);
    let velocities = setting.positions.clone();
    let at = Configuration {
        positions: &setting.positions,
        velocities: &velocities,
        time: 0.0,
        load: 1.0,
        memory: &setting.memory,
        pairs: &[],
        kept: souple_engine::KeptRef::default(),
        driven: &[],
        fields: &[],
    };
    let mut borne = Vec3::ZERO;
    setting.contact.visit_contacts(&at, &mut |point| borne += point.normal_force + point.friction);
    assert!((borne - Vec3::new(-0.5, 0.0, -2.0)).length() < 1e-15, "{borne:?}");
    let felt = ImposedContact::force(&setting.memory);
    assert_eq!(felt, Vec3::Z * 0.25);
}

/// By a penalty, a triangle of nine times the area is nine times as stiff, or as stiff as the other where all weigh alike.
#[test]
fn penalties_weigh_areas_or_alike() {
    let law = ContactLaw {
        stiffness: 300.0,
        damping: 0.0,
        friction: 0.0,
        tangential_stiffness: 0.0,
        thickness: 0.0,
    };
    let force = |centre: Vec3, is_alike: bool| {
        let surface = triangles();
        let positions = surface.points.clone();
        let touched = ToolSurface { surface: surface.into(), rows: (0..6).collect() };
        let shape: Box<dyn Shape> = Box::new(Sphere::new(centre, 0.25));
        let contact =
            ToolContact::new("tool", touched, shape, RigidMotion::default(), law, [0.1, PERIOD]).unwrap();
        let contact = if is_alike { contact.weighing_alike() } else { contact };
        let mut memory = vec![0.0; contact.memory_len()];
        contact.initial_memory(&mut memory);
        let mut at = Configuration {
            positions: &positions,
            velocities: &positions,
            time: 0.0,
            load: 1.0,
            memory: &memory,
            pairs: &[],
            kept: souple_engine::KeptRef::default(),
            driven: &[],
            fields: &[],
        };
        let mut pairs = Vec::new();
        contact.find_pairs(&at, &mut contact.new_scratch(), &mut pairs);
        at.pairs = &pairs;
        let mut out = vec![Vec3::ZERO; 6];
        contact.add_force(&at, &mut contact.new_scratch(), &mut out);
        out.into_iter().sum::<Vec3>().z
    };
    let places = [Vec3::new(0.9, 0.9, 0.2), Vec3::new(9.3, 9.3, 0.2)];
    let [large, small] = places.map(|place| force(place, false));
    assert!(small < 0.0 && (large / small - 9.0).abs() < 1e-12, "{large} {small}");
    let [large, small] = places.map(|place| force(place, true));
    assert!(small < 0.0 && large == small, "{large} {small}");
}

/// Jaws that are shut touch what one of their rods does, once.
#[test]
fn areas_count_once() {
    let (from, length, radius) = (Vec3::new(0.8, 0.8, 0.45), 0.5, 0.5);
    let rod = Capsule { from, to: from + Vec3::X * length, radius };
    let jaws = Jaws::new(from, [Vec3::X, Vec3::Z], length, radius, 0.0);
    let [one, both] = [Box::new(rod) as Box<dyn Shape>, Box::new(jaws)]
        .map(|shape| Setting::of(shape, "[0, 0, 0]", LAW).look());
    assert!(one[0].contact_area > 0.0);
    for (one, both) in one.iter().zip(&both) {
        assert!((one.contact_area - both.contact_area).abs() < 1e-12, "{one:?} {both:?}");
        assert!((one.displacement - both.displacement).length() < 1e-12);
    }
}

/// What cannot be is refused at the start and while running: a triangle deeper than the radius, and one that is never moved.
#[test]
fn laws_fit_the_tool() {
    let new = |law| {
        let surface = triangles();
        let touched = ToolSurface { surface: surface.into(), rows: (0..6).collect() };
        ImposedContact::new("tool", touched, Box::new(ball()), led("[0, 0, 0]"), law, PERIOD)
    };
    assert!(
        new(ImposedLaw { residual: 2.0, ..LAW }).is_err()
            && new(ImposedLaw { fraction: 0.0, ..LAW }).is_err()
    );
    let mut contact = new(ImposedLaw { residual: 1.9, ..LAW }).unwrap();
    let refused = |contact: &mut ImposedContact, name: &str, value: f64| {
        contact.set_parameter(name, value).err().map(|error| error.to_string()).unwrap_or_default()
    };
    assert!(refused(&mut contact, "residual", 2.0).contains("the least radius of the tool, 2 m"));
    assert!(refused(&mut contact, "fraction", 0.0).contains("above 0 and at most 1"));
    assert_eq!(refused(&mut contact, "fraction", 1.0), "");
}
