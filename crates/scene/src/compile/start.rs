//! Points that start away from rest.

use souple_engine::SystemState;
use souple_formal::Formula;
use souple_math::Vec3;

use super::Draft;
use super::bodies::Placed;
use crate::diagnostic::Code;
use crate::spec::start::StartSpec;

/// Displaces the points of a body and adds to their velocities, as its `start` says.
pub fn apply(draft: &Draft, body: &Placed, state: &mut SystemState) {
    let Some(start) = &body.spec.start else { return };
    for (formulas, field) in [(&start.displacement, &mut state.q), (&start.velocity, &mut state.v)] {
        let Some(formulas) = formulas else { continue };
        for (point, x) in (0..).zip(&body.mesh.points) {
            let Some(row) = body.own_row(point) else { continue };
            let value = at(formulas, *x);
            if !value.is_finite() {
                let message = format!("at {:?} this is {:?}", x.to_array(), value.to_array());
                let expected = "formulas that are finite at every point of the body";
                draft.log.add(Code::NotFinite, &start.site, message, expected);
                return;
            }
            field[row as usize] += value;
        }
    }
}

/// Where points start that rest at `points`; what is not finite there is reported by [`apply`].
pub fn places(start: Option<&StartSpec>, points: &[Vec3]) -> Vec<Vec3> {
    let displacement = start.and_then(|start| start.displacement.as_ref());
    points.iter().map(|x| displacement.map_or(*x, |formulas| *x + at(formulas, *x))).collect()
}

/// Formulas of a place, there.
pub fn at(formulas: &[Formula; 3], x: Vec3) -> Vec3 {
    Vec3::from_array([0, 1, 2].map(|axis: usize| formulas[axis].evaluate(&x.to_array())))
}
