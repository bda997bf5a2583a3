//! Meshes made from shapes.

use std::time::Instant;

use super::timing::{median, with_threads};
use super::{Effort, Figure};

/// The organ on a lattice of the size that gives about a hundred thousand tetrahedra; the error is that of its volume.
pub fn fill_100k(effort: Effort) -> Result<Vec<Figure>, String> {
    use souple_mesh::fill::{Cells, Size, fill};
    let body =
        souple_mesh::implicit::body("liver", souple_table::Values::new()).map_err(|e| e.to_string())?;
    let filled = |size: f64| {
        fill(&*body.shape, &Size::uniform(size), Cells::Tetrahedra, &[]).map_err(|error| error.to_string())
    };
    let (size, finer) = (FILL_SIZE, 0.6 * FILL_SIZE);
    let mut samples = Vec::new();
    let mut cells = 0;
    let mut volume = 0.0;
    for _ in 0..effort.choose(1, 5) {
        let clock = Instant::now();
        let mesh = with_threads(1, || filled(size))??;
        samples.push(clock.elapsed().as_secs_f64());
        (cells, volume) = (mesh.cell_count(), mesh.volume());
    }
    let error = (volume / filled(finer)?.volume() - 1.0).abs();
    let count = samples.len();
    let (value, spread) = median(samples);
    Ok(vec![Figure {
        by_processor: None,
        name: "fill_100k".to_owned(),
        value,
        unit: "s",
        higher_is_better: false,
        error,
        error_of: format!("volume of {cells} tetrahedra, against three fifths of the size"),
        baseline: None,
        threads: 1,
        samples: count,
        spread,
        bytes: 0,
    }])
}

/// Edge of the lattice for about a hundred thousand tetrahedra in the liver [m].
const FILL_SIZE: f64 = 5.4e-3;
