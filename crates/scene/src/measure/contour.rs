//! Contours of networks as their masses stand.

use souple_math::Vec3;
use souple_models::network::contour::{self, Lines, Place, Plane};

use crate::compile::{Draft, Placed};
use crate::diagnostic::Code;
use crate::spec::network::{ContourSpec, Way};
use crate::spec::probe::Probe;
use crate::spec::quantity::ContourQuantity;

/// A contour that knows its masses.
#[derive(Clone, Debug, PartialEq)]
pub struct ContourInfo {
    pub name: String,
    /// Masses among the rows of their system, in the order of a line.
    rows: Vec<u32>,
    way: Way,
    pub plane: Plane,
}

impl ContourInfo {
    /// `None` where masses are named that are not there, which is reported.
    pub(crate) fn of(spec: &ContourSpec, body: &Placed, draft: &Draft) -> Option<Self> {
        let network = body.spec.network.as_ref()?;
        let numbers: Vec<u32> = match &spec.way {
            Way::Through(numbers) => numbers.clone(),
            Way::Skin(group) => network.numbers_of(group)?.collect(),
            Way::Frontier(groups, _) | Way::Scan(groups, _) => {
                groups.iter().filter_map(|group| network.numbers_of(group)).flatten().collect()
            }
        };
        let count = body.mesh.points.len();
        if let Some(number) = numbers.iter().find(|number| **number as usize >= count) {
            let message =
                format!("contour `{}` goes through mass {number}, and there are {count}", spec.name);
            draft.log.add(Code::OutOfRange, &spec.site, message, format!("numbers below {count}"));
            return None;
        }
        let rows = numbers.iter().map(|number| body.rows.start as u32 + number).collect();
        Some(Self { name: spec.name.clone(), rows, way: spec.way.clone(), plane: spec.plane })
    }

    /// Its closed lines as places in space, at the mean height of its masses over the plane.
    pub fn places(&self, positions: &[Vec3]) -> Vec<Vec<Vec3>> {
        let height: f64 = self.rows.iter().map(|row| self.plane.height(positions[*row as usize])).sum();
        let height = height / self.rows.len().max(1) as f64;
        let in_space =
            |line: Vec<Place>| line.into_iter().map(|place| self.plane.point(place, height)).collect();
        self.lines(positions).into_iter().map(in_space).collect()
    }

    /// Its closed lines, with the masses where they are.
    pub fn lines(&self, positions: &[Vec3]) -> Lines {
        let places: Vec<Place> =
            self.rows.iter().map(|row| self.plane.place(positions[*row as usize])).collect();
        match &self.way {
            Way::Through(_) | Way::Skin(_) => vec![places],
            Way::Frontier(_, frontier) => frontier.lines(&places),
            Way::Scan(_, scan) => scan.lines(&places),
        }
    }
}

/// The contour of this name; `None` where there is none, which is reported.
pub(super) fn named(name: &str, probe: &Probe, body: &Placed, draft: &Draft) -> Option<ContourInfo> {
    let contours = body.spec.network.as_ref().map_or(&[][..], |network| &network.contours);
    let Some(found) = contours.iter().find(|contour| contour.name == name) else {
        let known: Vec<&str> = contours.iter().map(|contour| contour.name.as_str()).collect();
        let message = format!("`{}` has no contour `{name}`", body.spec.name);
        draft.log.add(Code::UnknownName, &probe.site, message, crate::keys::one_of(&known));
        return None;
    };
    ContourInfo::of(found, body, draft)
}

pub(super) fn measure(quantity: ContourQuantity, positions: &[Vec3], [own, from]: &[ContourInfo; 2]) -> f64 {
    let lines = own.lines(positions);
    match quantity {
        ContourQuantity::Length => contour::total_length(&lines),
        ContourQuantity::Area => contour::enclosed_area(&lines),
        ContourQuantity::Lines => lines.len() as f64,
        ContourQuantity::Roundness => {
            // of no length, as of no lines, it is none
            let square = contour::total_length(&lines).powi(2).max(f64::MIN_POSITIVE);
            4.0 * std::f64::consts::PI * contour::enclosed_area(&lines) / square
        }
        ContourQuantity::Apart => contour::farthest(&lines, &from.lines(positions)),
    }
}
