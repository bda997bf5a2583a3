//! Geometric relations between masses: one file for each kind. What keeps them is in [`super::constraints`].

mod acceleration;
mod angle;
mod direction;
mod enclosed;
mod guide;
mod joint;
mod rod;
mod surface;

pub use acceleration::Acceleration;
pub use angle::Angle;
pub use direction::Direction;
pub use enclosed::{Area, Volume};
pub use guide::Guide;
pub use joint::Joint;
pub use rod::Rod;
pub use surface::Surface;

use std::fmt::Debug;

use souple_math::{Mat3, Vec3};

/// `g(x, t)` of some masses, which is to vanish; of up to three components, of which the others are zero.
///
/// Rows are numbers of the system's rows, and positions those of all of them.
pub trait Relation: Send + Sync + Debug {
    /// The rows that it is of, each once.
    fn rows(&self) -> &[u32];

    fn value(&self, positions: &[Vec3], time: f64) -> Vec3;

    /// What `g` repeats by; 0 where it does not.
    fn period(&self) -> f64 {
        0.0
    }

    /// `∂g/∂x` for each row in turn: the gradient of a component in each row of the matrix.
    fn add_gradients(&self, positions: &[Vec3], time: f64, gradients: &mut Vec<Mat3>);

    /// `∂g/∂t` where masses stay.
    fn time_rate(&self, _positions: &[Vec3], _time: f64) -> Vec3 {
        Vec3::ZERO
    }

    /// How large the numbers are of which `g` is the difference, beside what places of masses are times gradients.
    fn magnitude(&self, _positions: &[Vec3], _time: f64) -> Vec3 {
        Vec3::ZERO
    }

    /// What `g` changes by the second time in each component, where that is told instead of `g` itself [1/s²].
    fn second_rate(&self, _time: f64) -> Option<Vec3> {
        None
    }

    /// Of a relation of one component of a mass, or of the difference of two, what it changes by with that; `None` of others, which have no sides.
    fn slope(&self, _positions: &[Vec3], _time: f64) -> Option<Vec3> {
        None
    }

    /// What of it has no meaning any more where masses went from some places to others, in words that go on from what it is; it has a cusp between.
    fn is_lost_between(&self, _from: &[Vec3], _to: &[Vec3]) -> Option<&'static str> {
        None
    }

    /// How fast what it holds its mass to moves [m/s].
    fn surface_velocity(&self, _time: f64) -> Vec3 {
        Vec3::ZERO
    }

    /// The two masses that it is a line between, for pictures.
    fn ends(&self) -> Option<[u32; 2]> {
        None
    }

    /// What it is, in words that begin with what keeps it.
    fn describe(&self) -> String;
}

/// Two directions at right angles to another and to each other; `None` for one of no length.
fn across(direction: Vec3) -> Option<[Vec3; 2]> {
    let along = direction.try_normalised()?;
    // across the axis that it is farthest from
    let least = along.to_array().map(f64::abs);
    let axis = (0..3).fold(0, |axis, other| if least[other] < least[axis] { other } else { axis });
    let across = along.cross(Vec3::AXES[axis]).try_normalised()?;
    Some([across, along.cross(across)])
}

/// A gradient of the first component alone.
fn first_row(gradient: Vec3) -> Mat3 {
    Mat3::from_columns(gradient, Vec3::ZERO, Vec3::ZERO).transpose()
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use souple_formal::Formula;

    use super::*;
    use crate::loads::{FormulaVector, RigidMotion};

    const VARIABLES: [&str; 4] = ["x", "y", "z", "t"];

    /// About an axis that moves.
    fn turning() -> Arc<dyn souple_engine::Motion> {
        let rotation = FormulaVector::compile("[t, sin(2 * t), 0.5]").unwrap();
        Arc::new(RigidMotion { rotation: Some(Arc::new(rotation)), ..RigidMotion::default() })
    }

    fn all(positions: &[Vec3]) -> Vec<Box<dyn Relation>> {
        let formula = |text: &str| Formula::compile(text, &VARIABLES).unwrap();
        let part = || Formula::compile("1 + t", &["t"]).unwrap();
        let told = Arc::new(FormulaVector::compile("[t, 2, 3]").unwrap());
        vec![
            Box::new(Rod { ends: [0, 2], length: 0.7 }),
            Box::new(Joint { ends: [1, 3] }),
            Box::new(Guide::nail(1, Vec3::X)),
            Box::new(Guide::line(2, Vec3::Y, Vec3::new(1.0, -2.0, 0.5)).unwrap()),
            Box::new(Guide::plane(3, Vec3::Z, Vec3::new(0.3, 1.0, 2.0)).unwrap()),
            Box::new(Surface { row: [1], zeros: [formula("x^2 + y * z - t"), formula("sin(x) + z")].into() }),
            Box::new(Acceleration {
                row: [2],
                axes: Vec3::new(1.0, 0.0, 1.0),
                start: Vec3::ZERO,
                value: told,
            }),
            Box::new(Area { rows: vec![0, 1, 2, 3], normal: Vec3::Z, area: 0.5, part: part() }),
            Box::new(Volume::new(&[[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]], part(), positions)),
            Box::new(Direction::new([3, 1], Vec3::new(1.0, -2.0, 0.5), Some(turning())).unwrap()),
            Box::new(Angle { rows: [1, 0, 3], axis: None, angle: part() }),
            Box::new(Angle {
                rows: [3, 2, 0],
                axis: Vec3::new(0.3, 1.0, -0.5).try_normalised(),
                angle: part(),
            }),
        ]
    }

    /// Gradients are the derivatives of values, row by row and component by component.
    #[test]
    fn gradients_are_derivatives() {
        let positions = [
            Vec3::new(0.1, 0.2, -0.1),
            Vec3::new(1.1, 0.0, 0.2),
            Vec3::new(0.2, 0.9, 0.1),
            Vec3::new(0.3, 0.4, 1.2),
        ];
        let (time, step) = (0.4, 1e-5);
        for relation in all(&positions) {
            let mut gradients = Vec::new();
            relation.add_gradients(&positions, time, &mut gradients);
            assert_eq!(gradients.len(), relation.rows().len(), "{}", relation.describe());
            for (row, gradient) in relation.rows().iter().zip(&gradients) {
                for axis in 0..3 {
                    let at = |by: f64| {
                        let mut moved = positions;
                        moved[*row as usize][axis] += by;
                        relation.value(&moved, time)
                    };
                    let difference = (at(step) - at(-step)) / (2.0 * step);
                    // differences are off by step²/6 of third derivatives of the order of one, and by rounding over the step
                    let off = (difference - *gradient * Vec3::AXES[axis]).length();
                    assert!(off < 1e-9, "{} by {row} along {axis}: {off}", relation.describe());
                }
            }
        }
    }

    /// Relations that have sides change along their slopes as their gradients say.
    #[test]
    fn slopes_are_gradients() {
        let positions = [
            Vec3::new(0.1, 0.2, -0.1),
            Vec3::new(1.1, 0.0, 0.2),
            Vec3::new(0.2, 0.9, 0.1),
            Vec3::new(0.3, 0.4, 1.2),
        ];
        let single = Surface { row: [1], zeros: [Formula::compile("x^2 + z", &VARIABLES).unwrap()].into() };
        let mut sided = 0;
        for relation in all(&positions).into_iter().chain([Box::new(single) as Box<dyn Relation>]) {
            let Some(slope) = relation.slope(&positions, 0.4) else { continue };
            sided += 1;
            let mut gradients = Vec::new();
            relation.add_gradients(&positions, 0.4, &mut gradients);
            for (gradient, sign) in gradients.iter().zip([1.0, -1.0]) {
                // the same numbers by another way
                assert!((gradient.row(0) - slope * sign).length() < 1e-15, "{}", relation.describe());
            }
        }
        // a rod, a plane and a surface
        assert_eq!(sided, 3);
    }

    /// What relations change by where masses stay is their derivative by time.
    #[test]
    fn time_rates_are_derivatives() {
        let positions = [
            Vec3::new(0.1, 0.2, -0.1),
            Vec3::new(1.1, 0.0, 0.2),
            Vec3::new(0.2, 0.9, 0.1),
            Vec3::new(0.3, 0.4, 1.2),
        ];
        let (time, step) = (0.4, 1e-5);
        let moving = Guide { motion: Some(Arc::new(Swinging)), ..Guide::nail(1, Vec3::X) };
        for relation in all(&positions).into_iter().chain([Box::new(moving) as Box<dyn Relation>]) {
            let at = |by: f64| relation.value(&positions, time + by);
            let difference = (at(step) - at(-step)) / (2.0 * step);
            // as above
            let off = (difference - relation.time_rate(&positions, time)).length();
            assert!(off < 1e-9, "{}: {off}", relation.describe());
        }
    }

    /// An angle about an axis is told beyond whole turns, one without between its two legs alone.
    #[test]
    fn angles_go_on_beyond_whole_turns() {
        let positions = [Vec3::X, Vec3::ZERO, Vec3::Y];
        for (axis, angle, off) in [
            (Some(Vec3::Z), "20 * pi + 0.5 * pi", 0.0),
            (Some(-Vec3::Z), "-0.6 * pi", 0.1 * std::f64::consts::PI),
            (None, "0.25 * pi", 0.25 * std::f64::consts::PI),
        ] {
            let angle = Formula::compile(angle, &["t"]).unwrap();
            let found = Angle { rows: [0, 1, 2], axis, angle }.value(&positions, 0.0).x;
            // rounding of ten turns
            assert!((found - off).abs() < 2e-14, "{axis:?}: {found}");
        }
    }

    #[derive(Debug)]
    struct Swinging;

    impl souple_engine::Motion for Swinging {
        fn offset(&self, _start: Vec3, time: f64) -> Vec3 {
            Vec3::X * time.sin()
        }

        fn velocity(&self, _start: Vec3, time: f64) -> Vec3 {
            Vec3::X * time.cos()
        }
    }

    /// Where nothing is told of what is kept, motion of the whole changes no rod, joint, area, volume, direction or angle.
    #[test]
    fn what_is_between_masses_does_not_see_them_move_together() {
        let positions = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
        let moved = positions.map(|x| x + Vec3::new(100.0, -50.0, 30.0));
        for relation in [0, 1, 7, 8, 9, 10, 11].map(|index| all(&positions).swap_remove(index)) {
            let off = (relation.value(&positions, 0.0) - relation.value(&moved, 0.0)).length();
            // places are known to 1e-14
            assert!(off < 1e-13, "{}: {off}", relation.describe());
        }
    }
}
