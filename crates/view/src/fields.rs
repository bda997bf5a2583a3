//! What surfaces may be coloured by.

use rayon::prelude::*;
use souple_engine::{CellField, World};
use souple_scene::BodyInfo;
use souple_table::{Entry, Table};

/// A number at each point of a surface.
#[derive(Clone, Copy)]
pub struct Field {
    pub unit: &'static str,
    pub source: Source,
}

/// Where the number comes from.
#[derive(Clone, Copy)]
pub enum Source {
    /// Of a point, by its number in the body.
    Point(fn(&World, &BodyInfo, usize) -> f64),
    /// Of the cells about a point, in the mean.
    Cells(fn(&CellField) -> f64),
}

/// All fields; adding one is a line.
pub static FIELDS: Table<Field> = Table {
    kind: "field",
    entries: &[
        &Entry {
            name: "displacement",
            summary: "how far points are from where they rest",
            source: "",
            parameters: &[],
            build: Field { unit: "m", source: Source::Point(displacement) },
        },
        &Entry {
            name: "speed",
            summary: "how fast points move",
            source: "",
            parameters: &[],
            build: Field { unit: "m/s", source: Source::Point(speed) },
        },
        &Entry {
            name: "von_mises",
            summary: "von Mises stress",
            source: "von Mises 1913",
            parameters: &[],
            build: Field { unit: "Pa", source: Source::Cells(|field| field.von_mises) },
        },
        &Entry {
            name: "strain_energy_density",
            summary: "stored energy per volume at rest",
            source: "",
            parameters: &[],
            build: Field { unit: "J/m³", source: Source::Cells(|field| field.energy_density) },
        },
        &Entry {
            name: "volume_ratio",
            summary: "volume over volume at rest",
            source: "",
            parameters: &[],
            build: Field { unit: "", source: Source::Cells(|field| field.current_volume / field.volume) },
        },
    ],
};

fn displacement(world: &World, body: &BodyInfo, point: usize) -> f64 {
    (world.rows(body.system).positions[body.rows.start + point] - body.mesh.points[point]).length()
}

fn speed(world: &World, body: &BodyInfo, point: usize) -> f64 {
    world.rows(body.system).velocities[body.rows.start + point].length()
}

/// The cells about the points of a body's surface.
pub struct SurfaceCells {
    /// Each once.
    cells: Vec<u32>,
    /// Where those of each point begin in `of_points`, and the end of the last.
    starts: Vec<u32>,
    /// Places in `cells`.
    of_points: Vec<u32>,
}

impl SurfaceCells {
    pub fn new(body: &BodyInfo) -> Self {
        let mut surface_point = vec![u32::MAX; body.mesh.points.len()];
        for (index, point) in body.surface.mesh_points.iter().enumerate() {
            surface_point[*point as usize] = index as u32;
        }
        let mut cells = Vec::new();
        let mut pairs = Vec::new();
        for (number, cell) in body.mesh.cells().enumerate() {
            let on_surface = cell.nodes.iter().map(|node| surface_point[*node as usize]);
            let before = pairs.len();
            pairs.extend(
                on_surface.filter(|point| *point != u32::MAX).map(|point| (point, cells.len() as u32)),
            );
            if pairs.len() > before {
                cells.push(number as u32);
            }
        }
        pairs.sort_unstable();
        let mut starts = vec![0; body.surface.mesh_points.len() + 1];
        pairs.iter().for_each(|(point, _)| starts[*point as usize + 1] += 1);
        for point in 1..starts.len() {
            starts[point] += starts[point - 1];
        }
        Self { cells, starts, of_points: pairs.into_iter().map(|(_, cell)| cell).collect() }
    }
}

impl Field {
    /// A value at each point of a body's surface; `None` where the body has no such field.
    pub fn at_surface(&self, world: &World, body: &BodyInfo, cells: &SurfaceCells) -> Option<Vec<f32>> {
        match self.source {
            Source::Point(value) => {
                let points = body.surface.mesh_points.iter();
                Some(points.map(|point| value(world, body, *point as usize) as f32).collect())
            }
            Source::Cells(value) => {
                let (solid, at) = world.force_named(body.system, &body.force)?;
                let of_cell = |cell: &u32| Some(value(&solid.cell_field_at(*cell as usize, &at)?));
                let values: Option<Vec<f64>> = cells.cells.par_iter().map(of_cell).collect();
                let values = values?;
                let mean = |range: &[u32]| {
                    let about = &cells.of_points[range[0] as usize..range[1] as usize];
                    let sum: f64 = about.iter().map(|cell| values[*cell as usize]).sum();
                    (sum / about.len() as f64) as f32
                };
                Some(cells.starts.windows(2).map(mean).collect())
            }
        }
    }
}
