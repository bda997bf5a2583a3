//! What the values of a probe are the differences from: a formula, or another body at the same places.

use souple_engine::World;
use souple_formal::Formula;
use souple_math::Vec3;
use souple_mesh::{Aabb, CellLocator};

use super::{Part, PointValues, part, points};
use crate::compile::{Draft, Placed};
use crate::diagnostic::{Code, Site};
use crate::spec::probe::{Against, Probe};
use crate::spec::quantity::PointQuantity;

/// Two meshes of one curved shape part by the height of an arc over its chord: 0.21 of the chord where a cell spans a
/// quarter of a turn, coarser than any that is of use.
const APART: f64 = 0.21;

/// Values to take from those of a probe, point by point.
#[derive(Clone, Debug)]
pub enum Reference {
    /// Of `x`, `y`, `z` where a point rests [m] and of time [s].
    Formula(Box<[Formula; 3]>),
    Body(Box<Carriers>),
}

/// A body whose cells at the start hold the points of a probe.
#[derive(Clone, Debug)]
pub struct Carriers {
    /// All its points.
    part: Part,
    /// For each point of the probe, points of `part` and the weights of the shape functions there.
    places: Vec<Vec<(usize, f64)>>,
}

impl Reference {
    /// `None` where a formula is not finite at the start, or a body is unknown or does not hold the points, which is reported.
    pub fn compile(against: &Against, probe: &Probe, draft: &Draft) -> Option<Self> {
        match against {
            Against::Formula { formulas, site } => {
                let is_finite = starts_finite(formulas, &part(probe, draft)?, site, draft);
                is_finite.then(|| Self::Formula(formulas.clone()))
            }
            Against::Body { name, site } => {
                // names of bodies are checked when the scene is read
                let other = draft.body(name)?;
                Carriers::compile(other, &part(probe, draft)?, site, draft)
                    .map(|carriers| Self::Body(Box::new(carriers)))
            }
        }
    }

    /// Leaves the differences.
    pub fn take_from(&self, values: &mut [Vec3], quantity: PointQuantity, part: &Part, world: &mut World) {
        match self {
            Self::Formula(formulas) => {
                let time = world.time();
                for (value, start) in values.iter_mut().zip(&part.starts) {
                    let place = [start.x, start.y, start.z, time];
                    *value -= Vec3::from_array([0, 1, 2].map(|axis: usize| formulas[axis].evaluate(&place)));
                }
            }
            Self::Body(carriers) => {
                // checked when the probe is read: the quantities that bodies are held against are vectors
                let PointValues::Vectors(others) = points::measure(quantity, &carriers.part, world) else {
                    return;
                };
                for (value, place) in values.iter_mut().zip(&carriers.places) {
                    *value -= place.iter().map(|(point, weight)| others[*point] * *weight).sum::<Vec3>();
                }
            }
        }
    }
}

/// Whether formulas are finite at the start for all points; where not, that is reported with the first such point.
fn starts_finite(formulas: &[Formula; 3], part: &Part, site: &Site, draft: &Draft) -> bool {
    let at = |rest: &Vec3| {
        let place = [rest.x, rest.y, rest.z, 0.0];
        Vec3::from_array([0, 1, 2].map(|axis: usize| formulas[axis].evaluate(&place)))
    };
    let bad = part.starts.iter().map(|rest| (rest, at(rest))).find(|(_, value)| !value.is_finite());
    if let Some((rest, value)) = bad {
        let message = format!(
            "what the point that rests at ({}, {}, {}) is held against is ({}, {}, {}) at t = 0",
            rest.x, rest.y, rest.z, value.x, value.y, value.z
        );
        draft.log.add(Code::NotFinite, site, message, "formulas that are finite at the start");
    }
    bad.is_none()
}

impl Carriers {
    fn compile(other: &Placed, own: &Part, site: &Site, draft: &Draft) -> Option<Self> {
        let locator = CellLocator::new(&other.mesh);
        let mut places = Vec::with_capacity(own.starts.len());
        for start in &own.starts {
            let carrier = locator.carrier(*start).and_then(|location| {
                let cell = other.mesh.cell(location.cell)?;
                let corners = cell.nodes.iter().map(|node| other.mesh.points[*node as usize]);
                (location.distance <= APART * Aabb::of(corners).diagonal()).then(|| {
                    let weights = location.weights();
                    cell.nodes.iter().map(|node| *node as usize).zip(weights.iter().copied()).collect()
                })
            });
            let Some(carrier) = carrier else {
                let message = format!(
                    "the point that rests at ({}, {}, {}) is outside of body `{}`",
                    start.x, start.y, start.z, other.spec.name
                );
                let expected = "a body of the same shape and place, or a `region` within it";
                draft.log.add(Code::Conflict, site, message, expected);
                return None;
            };
            places.push(carrier);
        }
        let first = other.rows.start as u32;
        let count = other.mesh.points.len() as u32;
        let part = Part {
            system: other.system,
            rows: (first..first + count).collect(),
            coarser: Vec::new(),
            marks: None,
            starts: other.mesh.points.clone(),
            whole: other.mass_rows(),
            contact: None,
            constraint: None,
            about: None,
            hold: None,
            held: Vec::new(),
            hangs: false,
        };
        Some(Self { part, places })
    }
}
