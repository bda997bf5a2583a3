//! Rows of unknowns forward and back.

use super::*;

fn frame_and_points() -> (Kinematics, Vec<Vec3>) {
    let mut kinematics = Kinematics::default();
    kinematics.add_unknowns(UnknownKind::Point, 2);
    kinematics.add_unknowns(UnknownKind::RigidFrame, 1);
    kinematics.add_unknowns(UnknownKind::AffineFrame, 1);
    kinematics.add_unknowns(UnknownKind::FloatingFrame { modes: 4 }, 1);
    kinematics.add_unknowns(UnknownKind::QuadraticFrame, 1);
    let rotation = exponential(Vec3::new(0.3, -0.2, 0.9));
    let mut q = vec![Vec3::new(1.0, 2.0, 3.0), Vec3::new(-1.0, 0.5, 0.25), Vec3::new(0.1, 0.2, 0.3)];
    q.extend(rotation.columns);
    q.extend([Vec3::ZERO, Vec3::X, Vec3::new(0.1, 1.1, 0.0), Vec3::Z]);
    let axes = exponential(Vec3::new(-0.4, 0.5, 0.1)).columns;
    q.push(Vec3::new(0.4, -0.3, 0.2));
    q.extend(axes);
    [0.3, -0.2, 0.05, 0.6].iter().for_each(|u| q.extend(axes.map(|axis| axis * *u)));
    q.extend((0..10).map(|k| Vec3::new(0.1 * f64::from(k), 1.0, -0.2 * f64::from(k))));
    (kinematics, q)
}

/// A displacement of everything that moves: components that are amplitudes of no mode stay.
fn projected(kinematics: &Kinematics, mut blocks: Vec<Vec3>) -> Vec<Vec3> {
    for (kind, range) in kinematics.unknowns() {
        for (part, block) in blocks[range].iter_mut().enumerate() {
            let idle = kind.idle_components(part);
            (0..3).filter(|component| idle[*component]).for_each(|component| block[component] = 0.0);
        }
    }
    blocks
}

fn displacement(kinematics: &Kinematics, scale: f64) -> Vec<Vec3> {
    let blocks = (0..kinematics.block_count())
        .map(|i| Vec3::new((i as f64).sin(), (2.0 * i as f64).cos(), 0.3 + 0.1 * i as f64) * scale);
    projected(kinematics, blocks.collect())
}

/// `difference` inverts `retract`, for points and frames alike.
#[test]
fn difference_inverts_retract() {
    let (kinematics, start) = frame_and_points();
    let moved_by = displacement(&kinematics, 0.7);
    let mut end = start.clone();
    kinematics.retract(&mut end, &moved_by);
    let mut back = vec![Vec3::ZERO; kinematics.block_count()];
    kinematics.difference(&end, &start, &mut back);
    for (got, wanted) in back.iter().zip(&moved_by) {
        assert!((*got - *wanted).length() < 1e-14);
    }
}

/// `velocity_map` is the derivative of `T(q) difference(q, q0)/h`, by central differences.
#[test]
fn velocity_map_is_the_derivative_of_row_velocities() {
    let (kinematics, start) = frame_and_points();
    let (h, step) = (0.1, 1e-6);
    let moved_by = displacement(&kinematics, 0.4);
    let rows_at = |extra: &[Vec3], scale: f64| {
        let mut q = start.clone();
        kinematics.retract(&mut q, &moved_by);
        kinematics.retract_scaled(&mut q, extra, scale);
        let mut v = vec![Vec3::ZERO; kinematics.block_count()];
        kinematics.difference(&q, &start, &mut v);
        v.iter_mut().for_each(|block| *block = *block * (1.0 / h));
        let mut rows = vec![Vec3::ZERO; kinematics.row_count()];
        kinematics.velocities_into(&q, &v, &mut rows);
        (q, v, rows)
    };
    let direction = displacement(&kinematics, 1.0);
    let (_, _, plus) = rows_at(&direction, step);
    let (_, _, minus) = rows_at(&direction, -step);
    let (q, v, _) = rows_at(&direction, 0.0);
    for row in 0..kinematics.free_row_count() {
        let numeric = (plus[row] - minus[row]) * (0.5 / step);
        let exact = kinematics.velocity_maps(row as u32, &q, &v, 1.0 / h).apply(&direction);
        // central differences: step² times a third derivative of order 1/h, and rounding 1e-16/step
        assert!((numeric - exact).length() < 1e-7, "row {row}: {numeric:?} {exact:?}");
    }
}

/// Forces come back by the transpose: the power `f·ẋ` on rows equals that on blocks.
#[test]
fn virtual_work_is_conserved() {
    let (mut kinematics, q) = frame_and_points();
    let parents = vec![(0, 0.25), (3, 0.5), (7, -0.25)];
    kinematics.add_derived_row(DerivedRow { parents, feedback: Feedback::Transpose }).unwrap();
    let v = displacement(&kinematics, 1.0);
    let mut rows = vec![Vec3::ZERO; kinematics.row_count()];
    kinematics.velocities_into(&q, &v, &mut rows);
    let mut force: Vec<Vec3> = (0..rows.len()).map(|i| Vec3::new(1.0, i as f64, -0.5)).collect();
    let row_power: f64 = force.iter().zip(&rows).map(|(f, x)| f.dot(*x)).sum();
    let mut generalised = vec![Vec3::ZERO; kinematics.block_count()];
    kinematics.forces_into(&q, &mut force, &mut generalised);
    let block_power: f64 = generalised.iter().zip(&v).map(|(f, x)| f.dot(*x)).sum();
    assert!((row_power - block_power).abs() < 1e-13 * row_power.abs().max(1.0));
}

/// `geometric` is the derivative of generalised forces at constant row forces, and `bias` the acceleration of rows while velocities of
/// blocks stay, both by central differences.
#[test]
fn forces_and_rows_turn_with_frames() {
    let (kinematics, q) = frame_and_points();
    let step = 1e-6;
    let moved = |direction: &[Vec3], scale: f64| {
        let mut moved = q.clone();
        kinematics.retract_scaled(&mut moved, direction, scale);
        moved
    };
    let direction = displacement(&kinematics, 1.0);
    let force: Vec<Vec3> = (0..q.len()).map(|i| Vec3::new(1.0, 0.2 * i as f64, -0.5)).collect();
    let generalised = |q: &[Vec3]| {
        let mut blocks = vec![Vec3::ZERO; kinematics.block_count()];
        kinematics.forces_into(q, &mut force.clone(), &mut blocks);
        blocks
    };
    let mut exact = vec![Vec3::ZERO; kinematics.block_count()];
    for (row, force) in force.iter().enumerate() {
        let Some(Geometric { turn, coupling }) = kinematics.geometric(row as u32, &q, *force) else {
            continue;
        };
        exact[turn.0 as usize] += turn.1 * direction[turn.0 as usize];
        if let Some((amplitude, by_amplitude)) = coupling {
            exact[turn.0 as usize] += by_amplitude * direction[amplitude as usize];
            exact[amplitude as usize] += by_amplitude.transpose_apply(direction[turn.0 as usize]);
        }
    }
    let (plus, minus) = (generalised(&moved(&direction, step)), generalised(&moved(&direction, -step)));
    for (exact, (plus, minus)) in exact.iter().zip(plus.iter().zip(&minus)) {
        // as above, with forces of some ten
        assert!((*exact - (*plus - *minus) * (0.5 / step)).length() < 1e-7);
    }
    let velocities = |scale: f64| {
        let mut rows = vec![Vec3::ZERO; kinematics.row_count()];
        kinematics.velocities_into(&moved(&direction, scale), &direction, &mut rows);
        rows
    };
    let (plus, minus) = (velocities(step), velocities(-step));
    for row in 0..q.len() {
        let numeric = (plus[row] - minus[row]) * (0.5 / step);
        let exact = kinematics.bias(row as u32, &q, &direction);
        assert!((numeric - exact).length() < 1e-7, "row {row}: {numeric:?} {exact:?}");
    }
}

/// Rows of modes stay `u a` however far a floating frame goes, and components without a mode take no part.
#[test]
fn modes_turn_with_their_frame() {
    let (kinematics, mut q) = frame_and_points();
    let first = kinematics.unknowns().take(4).map(|(kind, _)| kind.row_count()).sum::<usize>();
    let step = displacement(&kinematics, 0.3);
    let amplitude = |q: &[Vec3], mode: usize| q[first + 1].dot(q[first + 4 + 3 * mode]);
    let before: Vec<f64> = (0..4).map(|mode| amplitude(&q, mode)).collect();
    (0..50).for_each(|_| kinematics.retract(&mut q, &step));
    let amplitudes = kinematics.block_of(first as u32) as usize + 2;
    for mode in 0..4 {
        let moved = step[amplitudes + mode / 3][mode % 3];
        let u = amplitude(&q, mode);
        // fifty sums of numbers of order ten
        assert!((u - before[mode] - 50.0 * moved).abs() < 1e-12, "{u}");
        for axis in 0..3 {
            assert!((q[first + 4 + 3 * mode + axis] - q[first + 1 + axis] * u).length() < 1e-12);
        }
    }
    let idle = UnknownKind::FloatingFrame { modes: 4 };
    assert_eq!(
        [1, 2, 3].map(|part| idle.idle_components(part)),
        [[false; 3], [false; 3], [false, true, true]]
    );
}

#[test]
fn a_row_must_follow_its_parents() {
    let (mut kinematics, _) = frame_and_points();
    let row = kinematics.row_count();
    let cyclic = DerivedRow { parents: vec![(row as u32, 1.0)], feedback: Feedback::None };
    let error = kinematics.add_derived_row(cyclic).unwrap_err();
    assert_eq!(error, KinematicsError::NotEarlier { row, parent: row as u32 });
}
