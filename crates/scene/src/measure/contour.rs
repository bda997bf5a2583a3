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
    /// Where these are at rest.
    rest: Vec<Place>,
    way: Way,
    pub plane: Plane,
}

impl ContourInfo {
    /// `None` where masses are named that are not there, which is reported.
    pub(crate) fn of(spec: &ContourSpec, body: &Placed, draft: &Draft) -> Option<Self> {
        let network = body.spec.network.as_ref()?;
        let numbers: Vec<u32> = match &spec.way {
            Way::Through(numbers) | Way::Cross(numbers, _) => numbers.clone(),
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
        let rest =
            numbers.iter().map(|number| spec.plane.place(body.mesh.points[*number as usize])).collect();
        Some(Self { name: spec.name.clone(), rows, rest, way: spec.way.clone(), plane: spec.plane })
    }

    fn masses(&self, positions: &[Vec3]) -> Vec<Place> {
        self.rows.iter().map(|row| self.plane.place(positions[*row as usize])).collect()
    }

    /// Its closed lines as places in space, at the mean height of its masses over the plane; a cross as far before and behind
    /// them as its arms are long, where balls do not hide it.
    pub fn places(&self, positions: &[Vec3]) -> Vec<Vec<Vec3>> {
        let height: f64 = self.rows.iter().map(|row| self.plane.height(positions[*row as usize])).sum();
        let height = height / self.rows.len().max(1) as f64;
        let heights = match &self.way {
            Way::Cross(_, arm) => vec![height - arm, height + arm],
            _ => vec![height],
        };
        let lines = self.lines(positions);
        let at = |height: f64| {
            let in_space = move |line: &Vec<Place>| {
                line.iter().map(|place| self.plane.point(*place, height)).collect::<Vec<_>>()
            };
            lines.iter().map(in_space)
        };
        heights.into_iter().flat_map(at).collect()
    }

    /// Its closed lines, with the masses where they are.
    pub fn lines(&self, positions: &[Vec3]) -> Lines {
        let places = self.masses(positions);
        match &self.way {
            Way::Through(_) | Way::Skin(_) => vec![places],
            Way::Frontier(_, frontier) => frontier.lines(&places),
            Way::Scan(_, scan) => scan.lines(&places),
            // there and back
            Way::Cross(_, arm) => {
                let middle = places.first().copied().unwrap_or_default();
                let (sin, cos) = libm::sincos(turn(&self.rest, &places));
                let bar =
                    |[x, y]: Place| vec![[middle[0] - x, middle[1] - y], [middle[0] + x, middle[1] + y]];
                vec![bar([arm * cos, arm * sin]), bar([-arm * sin, arm * cos])]
            }
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
        ContourQuantity::Turn => turn(&own.rest, &own.masses(positions)),
        ContourQuantity::Apart => contour::farthest(&lines, &from.lines(positions)),
    }
}

fn mean(places: &[Place]) -> Place {
    [0, 1].map(|axis| places.iter().map(|place| place[axis]).sum::<f64>() / places.len() as f64)
}

/// The angle [rad] of the rotation that takes places nearest to others, both about their means: `atan2(Σ r × r', Σ r · r')`.
fn turn(before: &[Place], now: &[Place]) -> f64 {
    let (middle_before, middle) = (mean(before), mean(now));
    let pairs = before.iter().zip(now).map(|(a, b)| {
        let [a, b] =
            [[a[0] - middle_before[0], a[1] - middle_before[1]], [b[0] - middle[0], b[1] - middle[1]]];
        [a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1]]
    });
    let [across, along] = pairs.fold([0.0; 2], |sums, pair| [sums[0] + pair[0], sums[1] + pair[1]]);
    libm::atan2(across, along)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A triangle that is moved, turned by two radians and stretched has turned by two radians; one mass turns by nothing.
    #[test]
    fn turns_are_those_of_the_whole() {
        let before = [[1.0, 0.0], [3.0, 0.5], [2.0, 2.5]];
        let (sin, cos) = libm::sincos(2.0);
        let now = before.map(|[x, y]| [7.0 + 1.5 * (cos * x - sin * y), -2.0 + 1.5 * (sin * x + cos * y)]);
        assert!((turn(&before, &now) - 2.0).abs() < 8.0 * f64::EPSILON);
        assert_eq!(turn(&before[..1], &now[..1]), 0.0);
    }
}
