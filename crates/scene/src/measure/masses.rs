//! Quantities of multitudes: what hangs together, and how close.

use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;

use souple_engine::{System, World};
use souple_math::Vec3;
use souple_mesh::Sets;
use souple_models::contact::Shape;
use souple_models::network::{Crowd, Filling};

use super::Part;
use crate::spec::body::Placement;
use crate::spec::network::Filled;
use crate::spec::quantity::MassesQuantity;

/// What masses fill.
#[derive(Clone, Debug)]
pub struct Mould {
    shape: Arc<dyn Shape>,
    filling: Filling,
    surface: Vec<Vec3>,
    /// What moved what filled it to its start, innermost first.
    placements: Vec<Placement>,
}

impl Mould {
    pub fn new(filled: &Filled, placements: Vec<Placement>) -> Self {
        let Filled { shape, filling, .. } = filled;
        let surface = filling.surface_places(shape.as_ref());
        Self { shape: shape.clone(), filling: *filling, surface, placements }
    }

    /// [m]; no number where no surface is.
    fn gap(&self, places: &[Vec3]) -> f64 {
        let Self { shape, filling, surface, placements } = self;
        let back = |place: &Vec3| {
            placements.iter().rev().fold(*place, |place, placement| placement.origin_of(place))
        };
        let places: Vec<Vec3> = places.iter().map(back).collect();
        filling.widest_gap_of(shape.as_ref(), surface, &places).map_or(f64::NAN, |gap| gap.width)
    }
}

/// What is measured of which masses.
#[derive(Clone, Debug)]
pub struct Multitude {
    quantity: MassesQuantity,
    part: Part,
    /// How far apart masses count as neighbours, or how wide columns are [m].
    within: f64,
    /// Of length 1.
    up: Vec3,
    /// Neighbours as the scene gives them, of a quantity that asks for them.
    before: Vec<[u32; 2]>,
    /// Of a quantity that asks for it.
    mould: Option<Mould>,
}

impl Multitude {
    pub fn new(quantity: MassesQuantity, part: Part, within: f64, up: Vec3, mould: Option<Mould>) -> Self {
        let is_asked = quantity == MassesQuantity::Kept;
        let before = if is_asked { neighbours(&part.starts, within) } else { Vec::new() };
        Self { quantity, part, within, up, before, mould }
    }

    pub fn measure(&self, world: &mut World) -> f64 {
        let Multitude { quantity, ref part, within, up, ref before, ref mould } = *self;
        if quantity == MassesQuantity::Pairs {
            let is_in = |row: u32| part.rows.binary_search(&row).is_ok();
            let pairs = &world.state().systems[part.system].pairs;
            let mut count = pairs.iter().filter(|pair| is_in(pair.a as u32) && is_in(pair.b as u32)).count();
            world.visit_near(part.system, &mut |rows| count += usize::from(rows.into_iter().all(is_in)));
            return count as f64;
        }
        if quantity == MassesQuantity::Interactions {
            let forces = world.model().systems[part.system].forces.iter();
            let of = |rows: &Range<u32>| {
                part.rows.partition_point(|row| *row < rows.end)
                    - part.rows.partition_point(|row| *row < rows.start)
            };
            let pairs = |crowd: &Crowd| {
                let [first, second] = crowd.rows();
                let (a, b) = (of(&first) as f64, of(&second) as f64);
                if first == second { 0.5 * a * (a - 1.0) } else { a * b }
            };
            return forces.filter_map(|force| force.as_any().downcast_ref()).map(pairs).sum();
        }
        if let MassesQuantity::Temperature | MassesQuantity::Bonds = quantity {
            return of_fusible(quantity, part, world);
        }
        let positions = &world.rows(part.system).positions;
        let places: Vec<Vec3> = part.rows.iter().map(|row| positions[*row as usize]).collect();
        if quantity == MassesQuantity::Relief {
            return relief(&places, within, up);
        }
        if let Some(mould) = mould {
            return mould.gap(&places);
        }
        let near = neighbours(&places, within);
        match quantity {
            MassesQuantity::Parts => {
                let mut sets = Sets::new(places.len());
                for [a, b] in &near {
                    sets.join(*a, *b);
                }
                sets.count() as f64
            }
            MassesQuantity::Neighbours => 2.0 * near.len() as f64 / places.len() as f64,
            MassesQuantity::Spacing => {
                let apart = |[a, b]: &[u32; 2]| (places[*a as usize] - places[*b as usize]).length();
                match near.len() {
                    // all stand at least that far apart
                    0 => within,
                    count => near.iter().map(apart).sum::<f64>() / count as f64,
                }
            }
            MassesQuantity::Kept => {
                let is_still = |[a, b]: &&[u32; 2]| {
                    (places[*a as usize] - places[*b as usize]).length_sq() < within * within
                };
                let still = before.iter().filter(is_still).count();
                // of none there is no share, which is told at the end of a run
                still as f64 / before.len() as f64
            }
            MassesQuantity::Relief
            | MassesQuantity::Gap
            | MassesQuantity::Pairs
            | MassesQuantity::Interactions
            | MassesQuantity::Temperature
            | MassesQuantity::Bonds => {
                unreachable!("measured above")
            }
        }
    }
}

/// Of what has no temperature there is no mean, which is told at the end of a run.
fn of_fusible(quantity: MassesQuantity, part: &Part, world: &mut World) -> f64 {
    let is_in = |row: u32| part.rows.binary_search(&row).is_ok();
    world.with_system(part.system, |system: &System, state, around, ws| {
        let (mut sum, mut count, mut bonds) = (0.0, 0, 0);
        for (index, force) in system.forces.iter().enumerate() {
            let Some(crowd) = force.as_any().downcast_ref::<Crowd>() else { continue };
            let at = system.view(index, &ws.rows, state, around);
            crowd.visit_bonds(&at, |ends| bonds += usize::from(ends.into_iter().all(is_in)));
            for temperature in part.rows.iter().filter_map(|row| crowd.temperature(*row, at.memory)) {
                sum += temperature;
                count += 1;
            }
        }
        if quantity == MassesQuantity::Bonds { bonds as f64 } else { sum / f64::from(count) }
    })
}

/// Of the topmost places in columns along `up`; no number of none.
fn relief(places: &[Vec3], width: f64, up: Vec3) -> f64 {
    let mut tops: HashMap<[i64; 2], f64> = HashMap::new();
    // two axes across, the first across `up` and the axis of space that is farthest from it
    let along = up.to_array().map(f64::abs);
    let least = (0..3).min_by(|a, b| along[*a].total_cmp(&along[*b])).unwrap_or(0);
    let first = [Vec3::X, Vec3::Y, Vec3::Z][least];
    let first = (first - up * up.dot(first)).try_normalised().unwrap_or(Vec3::ZERO);
    let axes = [first, up.cross(first)];
    for place in places {
        let height = place.dot(up);
        let column = axes.map(|axis| (place.dot(axis) / width).floor() as i64);
        let top = tops.entry(column).or_insert(height);
        *top = top.max(height);
    }
    // in an order that is the same every time
    let mut heights: Vec<f64> = tops.into_values().collect();
    heights.sort_unstable_by(f64::total_cmp);
    let mean = heights.iter().sum::<f64>() / heights.len() as f64;
    (heights.iter().map(|height| (height - mean).powi(2)).sum::<f64>() / heights.len() as f64).sqrt()
}

/// Pairs of places nearer to each other than `within`, in order.
pub fn neighbours(places: &[Vec3], within: f64) -> Vec<[u32; 2]> {
    let cell = |place: Vec3| place.to_array().map(|x| (x / within).floor() as i64);
    let mut cells: HashMap<[i64; 3], Vec<u32>> = HashMap::new();
    for (number, place) in places.iter().enumerate() {
        cells.entry(cell(*place)).or_default().push(number as u32);
    }
    let mut found = Vec::new();
    for (a, place) in places.iter().enumerate() {
        let first = found.len();
        let here = cell(*place);
        for offset in (0..27).map(|n| [n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1]) {
            // cells of a tiny distance end with the whole numbers
            let Some(others) = cells.get(&std::array::from_fn(|i| here[i].wrapping_add(offset[i]))) else {
                continue;
            };
            let is_near =
                |b: &&u32| **b as usize > a && (places[**b as usize] - *place).length_sq() < within * within;
            found.extend(others.iter().filter(is_near).map(|b| [a as u32, *b]));
        }
        found[first..].sort_unstable();
    }
    found
}
