//! Points of view of a network: places that its links see in the place of masses.

use souple_math::{Mat3, Vec3};
use souple_models::network::{Links, Map, ViewPoint, ViewedLinks};

use super::super::Draft;
use crate::diagnostic::Code;
use crate::keys::one_of;
use crate::spec::network::Network;
use crate::spec::view::{ViewKind, ViewSpec};

/// What all points of view of a network see, in the order of their numbers; masses are counted from `first`.
pub fn points(network: &Network, first: u32, draft: &Draft) -> Vec<ViewPoint> {
    network.views.iter().flat_map(|view| of_view(network, view, first, draft)).collect()
}

fn of_view(network: &Network, view: &ViewSpec, first: u32, draft: &Draft) -> Vec<ViewPoint> {
    let seen = network.seen(view);
    let each = |map: Map| -> Vec<ViewPoint> {
        seen.clone().map(|mass| ViewPoint { sources: vec![(first + mass, 1.0)], map }).collect()
    };
    let refuse =
        |code: Code, message: String, expected: String| draft.log.add(code, &view.site, message, expected);
    match &view.kind {
        // x' = o + s (x - o)
        ViewKind::Scale { factor, origin } => {
            each(Map::Affine { matrix: Mat3::IDENTITY * *factor, offset: *origin * (1.0 - factor) })
        }
        // x' = R (x - o), with o at rest or the mean of masses
        ViewKind::Frame { rotation, origin, moving_with } => {
            let matrix = souple_math::exponential(*rotation);
            let fixed = each(Map::Affine { matrix, offset: matrix * *origin * -1.0 });
            let Some(name) = moving_with else { return fixed };
            let Some(others) = network.numbers_of(name).filter(|numbers| !numbers.is_empty()) else {
                let known: Vec<&str> = network.masses.iter().map(|group| group.name.as_str()).collect();
                refuse(Code::UnknownName, format!("there is no group of masses `{name}`"), one_of(&known));
                return fixed;
            };
            let share = -1.0 / others.len() as f64;
            let relative = |mut point: ViewPoint| {
                point.sources.extend(others.clone().map(|mass| (first + mass, share)));
                point
            };
            fixed.into_iter().map(relative).collect()
        }
        ViewKind::Cylinder { origin, axis } => {
            let towards = if axis.x.abs() < 0.999 { Vec3::X } else { Vec3::Y };
            let x = (towards - *axis * towards.dot(*axis)).try_normalised().unwrap_or(Vec3::X);
            let axes = Vec3::X.outer(x) + Vec3::Y.outer(axis.cross(x)) + Vec3::Z.outer(*axis);
            each(Map::Cylinder { axes, origin: *origin })
        }
        // x' = Σ w x
        ViewKind::Mean { weights } => {
            let count = seen.len();
            if !weights.is_empty() && weights.len() != count {
                let message = format!("{} weights of {count} masses", weights.len());
                refuse(Code::Conflict, message, "as many weights as masses, or none".to_owned());
            }
            let weight = |index: usize| weights.get(index).copied().unwrap_or(1.0 / count.max(1) as f64);
            let sources = seen.enumerate().map(|(index, mass)| (first + mass, weight(index))).collect();
            vec![ViewPoint { sources, map: Map::Affine { matrix: Mat3::IDENTITY, offset: Vec3::ZERO } }]
        }
    }
}

/// Where points of view are of masses that are there.
pub fn places(points: &[ViewPoint], masses: &[Vec3]) -> Vec<Vec3> {
    let mean =
        |point: &ViewPoint| point.sources.iter().map(|(row, w)| masses[*row as usize] * *w).sum::<Vec3>();
    points.iter().map(|point| point.map.place(mean(point))).collect()
}

/// Ends of links as [`ViewedLinks`] counts them, with the rows and points that they are of.
pub struct Ends {
    pub ends: Vec<[u32; 2]>,
    rows: Vec<u32>,
    points: Vec<ViewPoint>,
}

impl Ends {
    /// `ends` are numbers of masses, and behind them of points of view; masses are rows from `first` on.
    pub fn new(ends: &[[u32; 2]], masses: u32, first: u32, points: &[ViewPoint]) -> Self {
        let numbers = || ends.iter().flatten().copied();
        let mut of_masses: Vec<u32> = numbers().filter(|number| *number < masses).collect();
        let mut of_points: Vec<u32> = numbers().filter(|number| *number >= masses).collect();
        for list in [&mut of_masses, &mut of_points] {
            list.sort_unstable();
            list.dedup();
        }
        let place = |number: u32| {
            let of_mass = of_masses.binary_search(&number);
            of_mass.unwrap_or_else(|_| of_masses.len() + of_points.binary_search(&number).unwrap_or(0)) as u32
        };
        Self {
            ends: ends.iter().map(|ends| ends.map(place)).collect(),
            rows: of_masses.iter().map(|mass| first + mass).collect(),
            points: of_points.iter().map(|number| points[(number - masses) as usize].clone()).collect(),
        }
    }

    pub fn seen_by(self, links: Links) -> ViewedLinks {
        ViewedLinks::new(links, self.rows, self.points)
    }
}
