//! Steps taken in parts, which are halved where one finds no equilibrium.

use std::ops::Range;

use crate::state::SystemState;
use crate::system::SystemWorkspace;

use super::{StepError, StepReport};

/// Where a step in parts was given up.
pub(super) struct Stuck {
    /// As a part of the whole.
    pub reached: f64,
    pub part: f64,
    pub error: StepError,
}

/// Leads `next` from 0 to 1 in parts, of `first` to begin with. A part that fails is undone, its search of pairs too, and it and
/// those after it are half as long; after `most` halvings no more.
///
/// # Errors
/// That of the last part tried.
pub(super) fn in_parts(
    first: f64,
    most: u32,
    next: &mut SystemState,
    ws: &mut SystemWorkspace,
    mut lead: impl FnMut(Range<f64>, &mut SystemState, &mut SystemWorkspace) -> Result<StepReport, StepError>,
) -> Result<StepReport, Stuck> {
    let mut report = StepReport::default();
    let (mut reached, mut part, mut halvings) = (0.0, first, 0);
    while reached < 1.0 {
        let to = f64::min(1.0, reached + part);
        ws.mark(next);
        match lead(reached..to, next, ws) {
            Ok(led) => {
                report.merge(&led);
                reached = to;
            }
            Err(error) if halvings == most || !error.may_pass() => {
                return Err(Stuck { reached, part, error });
            }
            Err(_) => {
                ws.return_to_mark(next);
                halvings += 1;
                part *= 0.5;
            }
        }
    }
    Ok(report)
}

#[cfg(test)]
mod tests {
    use souple_math::Vec3;

    use super::*;
    use crate::kinematics::{Kinematics, UnknownKind};
    use crate::mass::Mass;
    use crate::state::Pair;
    use crate::steppers::SymplecticEuler;
    use crate::system::System;

    /// What a part that fails did to configuration and pairs is not there when it is tried again in halves.
    #[test]
    fn failures_leave_nothing() {
        let mut kinematics = Kinematics::default();
        kinematics.add_unknowns(UnknownKind::Point, 1);
        let system = System {
            name: "alone".to_owned(),
            kinematics,
            mass: Mass { diagonal: vec![1.0], couplings: Vec::new() },
            forces: Vec::new(),
            constraints: Vec::new(),
            stepper: Box::new(SymplecticEuler),
            steps_per_period: 1,
        };
        let mut ws = system.new_workspace();
        let mut next = system.initial_state(vec![Vec3::ZERO]);
        next.pairs.push(Pair::new(0, 0, [0.0; 8]));
        let mut seen = Vec::new();
        let led = in_parts(1.0, 3, &mut next, &mut ws, |part, next, _| {
            seen.push((part.clone(), next.q[0].x, next.pairs.len()));
            next.q[0].x += 1.0;
            next.pairs.clear();
            let fits = part.end - part.start <= 0.5;
            if fits { Ok(StepReport::default()) } else { Err(StepError::PairsUnsettled { searches: 1 }) }
        });
        assert!(led.is_ok());
        assert_eq!(seen, [(0.0..1.0, 0.0, 1), (0.0..0.5, 0.0, 1), (0.5..1.0, 1.0, 0)]);
    }
}
