//! How far bodies stand from those of another run.

use souple_io::Field;

use super::{BodyMoment, Moment, Show, ShowError};

/// The field of where a body stands, less where that of another run does [m].
pub const GAP: &str = "gap";

impl Show {
    /// Adds the field `gap` to bodies, from where the body of the same name of another run stands at the nearest moment. Its
    /// points are those that both have in common: the first of each.
    ///
    /// # Errors
    /// The other run has no body of a name, or none of its moments.
    pub fn against(&mut self, other: &Self) -> Result<(), ShowError> {
        for moment in &mut self.moments {
            let off = |there: &&Moment| (there.time - moment.time).abs();
            let there = other.moments.iter().min_by(|a, b| off(a).total_cmp(&off(b)));
            add_gap(moment, there.map_or(&[][..], |there| &there.bodies))?;
        }
        Ok(())
    }
}

/// Adds the field to bodies of a moment, from those of another run.
pub(super) fn add_gap(moment: &mut Moment, there: &[BodyMoment]) -> Result<(), ShowError> {
    for body in &mut moment.bodies {
        let same = there.iter().find(|there| there.name == body.name);
        let same = same.ok_or_else(|| ShowError::Request {
            what: "other run",
            value: format!("without a body `{}`", body.name),
            expected: "a run of the same bodies".to_owned(),
        })?;
        body.point_fields.push(gap(body, same));
    }
    Ok(())
}

/// Not a number at points that the other does not have.
fn gap(body: &BodyMoment, other: &BodyMoment) -> Field {
    let mut values = Vec::with_capacity(3 * body.positions.len());
    for (point, x) in body.positions.iter().enumerate() {
        let there = other.positions.get(point);
        let gap = there.map_or([f64::NAN; 3], |there| (*x - *there).to_array());
        values.extend(gap);
    }
    Field::new(GAP, 3, values)
}
