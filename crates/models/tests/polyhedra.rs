//! Bodies with faces: slopes of their gaps, which features meet, and that they neither make momentum nor torque.

use souple_engine::{Configuration, Detection, ImpactLaw, Pair, Unilateral};
use souple_math::Vec3;
use souple_models::network::{Apart, Polyhedra, PolyhedraDescription, Polyhedron};

/// The corners of a box between two corners.
fn corners(low: [f64; 3], high: [f64; 3]) -> Vec<Vec3> {
    let of = |i: usize, axis: usize| if i >> axis & 1 == 0 { low[axis] } else { high[axis] };
    (0..8).map(|i| Vec3::new(of(i, 0), of(i, 1), of(i, 2))).collect()
}

/// The triangles of a box whose corners are rows from `first`.
fn triangles(first: u32) -> Vec<[u32; 3]> {
    let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let split = |[a, b, c, d]: [u32; 4]| [[a, b, c], [a, c, d]];
    sides.into_iter().flat_map(split).map(|corners| corners.map(|corner| first + corner)).collect()
}

fn polyhedra(bodies: Vec<Polyhedron>, rest: &[Vec3]) -> Polyhedra {
    let law = ImpactLaw { restitution: 0.0, friction: 0.5 };
    let detection = Detection::EveryStep;
    Polyhedra::new(
        PolyhedraDescription { name: "bodies".into(), bodies, law, timestep: 1e-3, detection },
        rest,
    )
}

fn found(of: &Polyhedra, positions: &[Vec3]) -> Vec<Pair> {
    let velocities = vec![Vec3::ZERO; positions.len()];
    let mut pairs = Vec::new();
    let at = Configuration {
        positions,
        velocities: &velocities,
        time: 0.0,
        load: 1.0,
        memory: &[0.0],
        pairs: &[],
        kept: souple_engine::KeptRef::default(),
        driven: &[],
        fields: &[],
    };
    of.find_pairs(&at, &mut of.new_scratch(), &mut pairs);
    pairs
}

fn turned(places: &[Vec3], axis: Vec3, angle: f64, to: Vec3) -> Vec<Vec3> {
    let axis = axis.try_normalised().unwrap();
    let (sine, cosine) = angle.sin_cos();
    let turn = |x: Vec3| x * cosine + axis.cross(x) * sine + axis * (axis.dot(x) * (1.0 - cosine));
    places.iter().map(|x| turn(*x) + to).collect()
}

/// Two boxes of 1 m, of which the second stands on the first, moved along it.
fn stacked(by: [f64; 3]) -> (Polyhedra, Vec<Vec3>) {
    let mut positions = corners([0.0; 3], [1.0; 3]);
    let [x, y, z] = by;
    positions.extend(corners([x, y, 1.0 + z], [1.0 + x, 1.0 + y, 2.0 + z]));
    let bodies = vec![Polyhedron::Faces(triangles(0)), Polyhedron::Faces(triangles(8))];
    (polyhedra(bodies, &positions), positions)
}

/// Normals and gaps of all contacts.
fn contacts(of: &Polyhedra, positions: &[Vec3]) -> Vec<(Vec3, f64)> {
    let pairs = found(of, positions);
    let contact = |contact: usize| {
        let normal = of.slope(contact, &pairs, positions, 0.0);
        (normal, of.gap(contact, &pairs, positions, 0.0))
    };
    (0..pairs.len()).map(contact).collect()
}

/// A box on another is met along the vertical alone, whether corners lie on corners, on edges or on faces, or edges cross: no side of the lower one is a step.
#[test]
fn no_side_is_met_from_above() {
    for by in [
        [0.0, 0.0, 0.0],
        [0.2, 0.0, 0.0],
        [0.2, 0.3, 0.0],
        [0.2, 0.3, -1e-9],
        [1e-9, -1e-9, 1e-10],
        [0.999, 0.5, 0.0],
    ] {
        let (bodies, positions) = stacked(by);
        let contacts = contacts(&bodies, &positions);
        assert!(contacts.len() >= 4, "{by:?}: {contacts:?}");
        for (normal, gap) in contacts {
            // from the second to the first or the other way
            assert!(normal.z.abs() > 1.0 - 1e-12, "{by:?}: {normal:?}");
            assert!((gap - by[2]).abs() < 1e-12, "{by:?}: {gap}");
        }
    }
}

/// One beside another is met along the horizontal alone, and what has come to lie apart by more than is looked around is not met.
#[test]
fn what_lies_beside_is_met_sideways() {
    let (bodies, positions) = stacked([1.0, 0.0, -1.0]);
    let sideways = contacts(&bodies, &positions);
    assert!(sideways.len() >= 4);
    assert!(sideways.iter().all(|(normal, gap)| normal.x.abs() > 1.0 - 1e-12 && gap.abs() < 1e-12));
    let (bodies, positions) = stacked([0.0, 0.0, 0.3]);
    assert!(contacts(&bodies, &positions).is_empty());
}

/// A box that stands on its edge across the edge of another meets it where these cross, by the normal of both.
#[test]
fn edges_cross() {
    let lower = turned(
        &corners([-1.0, -0.5, -0.5], [1.0, 0.5, 0.5]),
        Vec3::X,
        0.25 * std::f64::consts::PI,
        Vec3::ZERO,
    );
    let upper = turned(
        &corners([-0.5, -1.0, -0.5], [0.5, 1.0, 0.5]),
        Vec3::Y,
        0.25 * std::f64::consts::PI,
        Vec3::ZERO,
    );
    // edges are half a diagonal from the axis
    let height = 2.0 * 0.5_f64.sqrt() + 1e-4;
    let positions: Vec<Vec3> =
        lower.into_iter().chain(upper.into_iter().map(|x| x + Vec3::Z * height)).collect();
    let bodies =
        polyhedra(vec![Polyhedron::Faces(triangles(0)), Polyhedron::Faces(triangles(8))], &positions);
    let contacts = contacts(&bodies, &positions);
    assert_eq!(contacts.len(), 1, "{contacts:?}");
    assert!(
        (contacts[0].0 + Vec3::Z).length() < 1e-12 && (contacts[0].1 - 1e-4).abs() < 1e-12,
        "{contacts:?}"
    );
}

/// A ball is met by the face below it, by the edge or the corner that it is beside, and by one of these alone.
#[test]
fn a_ball_meets_what_is_nearest() {
    let mut positions = corners([0.0; 3], [1.0; 3]);
    positions.push(Vec3::ZERO);
    let bodies =
        polyhedra(vec![Polyhedron::Faces(triangles(0)), Polyhedron::Balls(vec![8], 0.2)], &positions);
    let slanted = |x: f64, y: f64, z: f64| Vec3::new(x, y, z).try_normalised().unwrap();
    for (from, direction) in [
        (Vec3::new(0.3, 0.4, 1.0), Vec3::Z),
        (Vec3::new(1.0, 0.4, 1.0), slanted(1.0, 0.0, 2.0)),
        (Vec3::new(1.0, 1.0, 1.0), slanted(1.0, 3.0, 2.0)),
    ] {
        positions[8] = from + direction * 0.201;
        let contacts = contacts(&bodies, &positions);
        assert_eq!(contacts.len(), 1, "{from:?}: {contacts:?}");
        let (normal, gap) = contacts[0];
        assert!((normal - direction).length() < 1e-12 && (gap - 1e-3).abs() < 1e-12, "{normal:?} {gap}");
    }
}

/// What a gap changes by with each row is its slope times the weight of the row, wherever the features are: the derivative against differences.
#[test]
fn slopes_are_derivatives_of_gaps() {
    let mut seen = [0; 3];
    for turn in 0..60 {
        let turn = f64::from(turn);
        let lower = corners([-0.5, -0.5, -0.5], [0.5, 0.5, 0.5]);
        let axis = Vec3::new(turn.sin(), (2.0 * turn).cos(), (3.0 * turn).sin());
        let upper = turned(&lower, axis, 0.7 * turn, Vec3::ZERO);
        let lowest = upper.iter().map(|x| x.z).fold(0.0, f64::min);
        let aside = Vec3::new(0.6 * (1.3 * turn).sin(), 0.6 * (1.7 * turn).cos(), 0.52 - lowest);
        let mut positions = lower;
        positions.extend(upper.into_iter().map(|x| x + aside));
        positions.push(Vec3::new(0.55 * turn.sin(), 0.55 * turn.cos(), 0.55));
        let bodies = vec![
            Polyhedron::Faces(triangles(0)),
            Polyhedron::Faces(triangles(8)),
            Polyhedron::Balls(vec![16], 0.05),
        ];
        let bodies = polyhedra(bodies, &positions);
        let pairs = found(&bodies, &positions);
        for contact in 0..pairs.len() {
            let slope = bodies.slope(contact, &pairs, &positions, 0.0);
            let sides = bodies.sides(contact, &pairs, &positions);
            seen[sides.iter().count() - 2] += 1;
            for (row, weight) in sides.iter() {
                for axis in 0..3 {
                    let step = 1e-5;
                    let gap_at = |by: f64| {
                        let mut moved = positions.clone();
                        moved[row][axis] += by;
                        bodies.gap(contact, &pairs, &moved, 0.0)
                    };
                    let difference = (gap_at(step) - gap_at(-step)) / (2.0 * step);
                    // the third derivative of distances over some tenths of a metre is below 1e3 /m²
                    assert!(
                        (difference - weight * slope[axis]).abs() < 1e-6,
                        "{:?} {row} {axis}: {difference}",
                        pairs[contact]
                    );
                }
            }
        }
    }
    // balls on corners, on edges, and corners on faces and edges on edges
    assert!(seen[1] > 0 && seen[2] > 10, "{seen:?}");
}

/// A snapshot with features that are not there, of one body, or of edges for what is no ball, is refused.
#[test]
fn pairs_are_of_features() {
    let (bodies, positions) = stacked([0.2, 0.3, 0.0]);
    let pairs = found(&bodies, &positions);
    assert!(pairs.iter().all(|pair| bodies.accepts_pair(pair)));
    let kind = |kind: usize| kind << 32;
    let pair = |a: usize, b: usize| Pair::new(a, b, [0.0; 8]);
    for wrong in [
        pair(kind(2), 0),
        pair(kind(2), 24),
        pair(kind(2) + 16, 12),
        pair(kind(2), kind(1) + 20),
        pair(kind(1) + 20, kind(1)),
        pair(kind(3), 12),
        pair(0, 12),
    ] {
        assert!(!bodies.accepts_pair(&wrong), "{wrong:?}");
    }
}

/// What begins within another is told: an edge through a face, a corner, a whole body, a ball; what touches is not.
#[test]
fn what_has_entered_is_told() {
    let entered = |by: [f64; 3]| {
        let (bodies, positions) = stacked(by);
        bodies.entered(&positions, 1e-9)
    };
    for touches in [[0.0; 3], [0.2, 0.3, 0.0], [1.0, 0.0, -1.0], [1.0, 1.0, 0.0], [0.0, 0.0, 0.5]] {
        assert_eq!(entered(touches), None, "{touches:?}");
    }
    for within in [[0.2, 0.3, -1e-6], [0.2, 0.3, -0.5], [0.1, 0.1, -0.9], [0.0, 0.3, -0.01]] {
        assert!(entered(within).is_some(), "{within:?}");
    }
    // with all corners on faces of the other, or in their planes
    for aligned in
        [[0.0, 0.0, -0.5], [0.0, 0.0, -1.0], [0.5, 0.0, -1.0], [0.5, 0.0, -0.5], [0.995, 0.005, -1.0]]
    {
        assert!(entered(aligned).is_some(), "{aligned:?}");
    }
    let mut positions = corners([0.0; 3], [1.0; 3]);
    positions.extend(corners([0.3; 3], [0.7; 3]));
    positions.push(Vec3::new(0.5, 0.5, 1.1));
    let whole = vec![Polyhedron::Faces(triangles(0)), Polyhedron::Faces(triangles(8))];
    assert_eq!(polyhedra(whole, &positions).entered(&positions, 1e-9).map(|it| it.bodies), Some([1, 0]));
    let ball = |radius: f64| vec![Polyhedron::Faces(triangles(0)), Polyhedron::Balls(vec![16], radius)];
    assert_eq!(polyhedra(ball(0.1), &positions).entered(&positions, 1e-9), None);
    assert!(polyhedra(ball(0.11), &positions).entered(&positions, 1e-9).is_some());
}
