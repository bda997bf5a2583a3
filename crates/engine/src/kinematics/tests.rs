//! Rows of unknowns forward and back.

use super::*;

fn frame_and_points() -> (Kinematics, Vec<Vec3>) {
    let mut kinematics = Kinematics::default();
    kinematics.add_unknowns(UnknownKind::Point, 2);
    kinematics.add_unknowns(UnknownKind::RigidFrame, 1);
    kinematics.add_unknowns(UnknownKind::AffineFrame, 1);
    let rotation = exponential(Vec3::new(0.3, -0.2, 0.9));
    let mut q = vec![Vec3::new(1.0, 2.0, 3.0), Vec3::new(-1.0, 0.5, 0.25), Vec3::new(0.1, 0.2, 0.3)];
    q.extend(rotation.columns);
    q.extend([Vec3::ZERO, Vec3::X, Vec3::new(0.1, 1.1, 0.0), Vec3::Z]);
    (kinematics, q)
}

fn displacement(kinematics: &Kinematics, scale: f64) -> Vec<Vec3> {
    (0..kinematics.block_count())
        .map(|i| Vec3::new((i as f64).sin(), (2.0 * i as f64).cos(), 0.3 + 0.1 * i as f64) * scale)
        .collect()
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
        let map = kinematics.velocity_map(row as u32, &q, &v, 1.0 / h);
        let exact = map * direction[kinematics.block_of(row as u32) as usize];
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

#[test]
fn a_row_must_follow_its_parents() {
    let (mut kinematics, _) = frame_and_points();
    let row = kinematics.row_count();
    let cyclic = DerivedRow { parents: vec![(row as u32, 1.0)], feedback: Feedback::None };
    let error = kinematics.add_derived_row(cyclic).unwrap_err();
    assert_eq!(error, KinematicsError::NotEarlier { row, parent: row as u32 });
}
