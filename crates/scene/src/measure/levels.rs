//! Who does what in a body with levels, and what it costs.

use souple_engine::levels::{Evaluations, Neighbours};
use souple_engine::steppers::Schedule;
use souple_engine::{Census, World};
use souple_mesh::Mesh;
use souple_mesh::coarsen::{radius_ratios, surfaces_apart};

use super::LevelsPart;
use crate::scene::{census, variation, workload};
use crate::spec::quantity::LevelsQuantity;

pub fn measure(quantity: LevelsQuantity, part: &LevelsPart, world: &World) -> f64 {
    let census = || census(world, part.system, &part.force);
    let count = |counts: Vec<usize>| match part.level {
        Some(level) => counts[level] as f64,
        None => counts.iter().sum::<usize>() as f64,
    };
    match quantity {
        LevelsQuantity::Active => census().map_or(0.0, |census| {
            census.active_rows.iter().filter(|row| part.rows.binary_search(row).is_ok()).count() as f64
        }),
        LevelsQuantity::Variation => variation(world, part.system, &part.force)
            .into_iter()
            .filter(|(row, _)| part.rows.binary_search(row).is_ok())
            .map(|(_, variation)| variation)
            .fold(0.0, f64::max),
        LevelsQuantity::Ghosts => census().map_or(0.0, |census| count(census.ghosts)),
        LevelsQuantity::Cells => census().map_or(0.0, |census| count(census.cells)),
        LevelsQuantity::RadiusRatio | LevelsQuantity::Distance => part.of_meshes,
        LevelsQuantity::Jump => part.dress.as_ref().map_or(0.0, |dress| dress.greatest_jump(world)),
        LevelsQuantity::Nearness => census().map_or(0.0, |census| {
            let levels: Vec<f64> = census.level_of_point.iter().map(|level| f64::from(*level)).collect();
            rank_correlation(&levels, &part.distances)
        }),
        LevelsQuantity::Toggling => census().map_or(0.0, |census| census.toggling),
        LevelsQuantity::Grading => census().map_or(0.0, |census| f64::from(census.grading)),
        LevelsQuantity::FewestNeighbours => neighbours(census()).fewest as f64,
        LevelsQuantity::MostNeighbours => neighbours(census()).most as f64,
        LevelsQuantity::UnlistedNeighbours => neighbours(census()).unlisted as f64,
        LevelsQuantity::Evaluations => workload(world, part.system, &part.force)
            .map_or(0.0, |load| load.by_tick().iter().sum::<usize>() as f64),
        LevelsQuantity::Peak => workload(world, part.system, &part.force).map_or(0.0, |load| {
            let ticks = load.by_tick();
            let (most, sum) = (ticks.iter().copied().max().unwrap_or(0), ticks.iter().sum::<usize>());
            if sum == 0 { 0.0 } else { most as f64 * ticks.len() as f64 / sum as f64 }
        }),
    }
}

/// What a quantity says of the meshes of a body at rest, the last being its own, of which some are looked at.
pub fn of_meshes(quantity: LevelsQuantity, own: &Mesh, meshes: &[&Mesh]) -> f64 {
    if quantity == LevelsQuantity::RadiusRatio {
        return meshes.iter().flat_map(|mesh| radius_ratios(mesh)).fold(f64::INFINITY, f64::min);
    }
    let outside = own.boundary_surface();
    let apart = meshes.iter().map(|mesh| surfaces_apart(&outside, &mesh.boundary_surface()));
    apart.fold(0.0, f64::max)
}

fn neighbours(census: Option<Census>) -> Neighbours {
    census.and_then(|census| census.neighbours).unwrap_or_default()
}

/// What a step does with the points as they are.
pub struct Workload {
    pub evaluations: Evaluations,
    pub schedule: Schedule,
}

impl Workload {
    /// Forces of each tick of a step.
    fn by_tick(&self) -> Vec<usize> {
        let Evaluations { first, of_rate } = &self.evaluations;
        let halvings = of_rate.len().saturating_sub(1) as u32;
        let at = |tick| {
            let begins = if tick == 0 { *first } else { 0 };
            begins + self.schedule.due(tick, halvings).map(|rate| of_rate[rate as usize]).sum::<usize>()
        };
        (0..1_u32 << halvings).map(at).collect()
    }
}

/// Spearman's: the correlation of ranks, of which equal values share the mean. Zero where one of them does not vary.
fn rank_correlation(a: &[f64], b: &[f64]) -> f64 {
    let (a, b) = (ranks(a), ranks(b));
    let mean = (a.len() as f64 - 1.0) / 2.0;
    let product =
        |x: &[f64], y: &[f64]| -> f64 { x.iter().zip(y).map(|(x, y)| (x - mean) * (y - mean)).sum() };
    let scale = (product(&a, &a) * product(&b, &b)).sqrt();
    if scale > 0.0 { product(&a, &b) / scale } else { 0.0 }
}

fn ranks(values: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|a, b| values[*a].total_cmp(&values[*b]));
    let mut ranks = vec![0.0; values.len()];
    let mut first = 0;
    for equal in order.chunk_by(|a, b| values[*a] == values[*b]) {
        let rank = first as f64 + 0.5 * (equal.len() as f64 - 1.0);
        equal.iter().for_each(|place| ranks[*place] = rank);
        first += equal.len();
    }
    ranks
}

#[cfg(test)]
mod tests {
    use super::rank_correlation;

    /// One for whatever rises with the other, minus one for what falls; ties count as their mean: by hand.
    #[test]
    fn ranks_correlate() {
        let rising = [1.0, 4.0, 9.0, 100.0];
        assert!((rank_correlation(&rising, &[0.0, 1.0, 2.0, 3.0]) - 1.0).abs() < 1e-15);
        assert!((rank_correlation(&rising, &[3.0, 2.0, 1.0, 0.0]) + 1.0).abs() < 1e-15);
        // ranks 0.5 0.5 2 3 against 0 1 2 3: 4.5/√(4.5 · 5)
        assert!((rank_correlation(&[1.0, 1.0, 2.0, 3.0], &rising) - (4.5_f64 / 5.0).sqrt()).abs() < 1e-15);
        assert_eq!(rank_correlation(&[1.0; 4], &rising), 0.0);
    }
}
