//! Quantities of multitudes: what hangs together, and how close.

use std::collections::HashMap;

use souple_engine::World;
use souple_math::Vec3;
use souple_mesh::Sets;

use super::Part;
use crate::spec::quantity::MassesQuantity;

/// `within`: how far apart masses count as neighbours [m].
pub fn measure(quantity: MassesQuantity, part: &Part, within: f64, world: &World) -> f64 {
    if quantity == MassesQuantity::Pairs {
        let is_in = |row: u32| part.rows.binary_search(&row).is_ok();
        let pairs = &world.state().systems[part.system].pairs;
        let mut count = pairs.iter().filter(|pair| is_in(pair.a as u32) && is_in(pair.b as u32)).count();
        world.visit_near(part.system, &mut |rows| count += usize::from(rows.into_iter().all(is_in)));
        return count as f64;
    }
    let positions = &world.rows(part.system).positions;
    let places: Vec<Vec3> = part.rows.iter().map(|row| positions[*row as usize]).collect();
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
            let before = neighbours(&part.starts, within);
            let is_still = |[a, b]: &&[u32; 2]| {
                (places[*a as usize] - places[*b as usize]).length_sq() < within * within
            };
            let still = before.iter().filter(is_still).count();
            // of none there is no share, which is told at the end of a run
            still as f64 / before.len() as f64
        }
        MassesQuantity::Pairs => unreachable!("counted above"),
    }
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
