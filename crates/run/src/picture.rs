//! The picture of the last state, and the plots of the probes.

use std::path::Path;

use souple_engine::World;
use souple_io::IoError;
use souple_io::picture::{EdgeStyle, Ground, Legend, MeshSurface, Picture};
use souple_io::plot::{Axis, Curve, Plot};
use souple_math::Vec3;
use souple_models::contact::ShapeContact;
use souple_scene::BodyInfo;

use crate::Trace;
use crate::frames::solid_of;

/// All bodies as they stand, coloured by the von Mises stress of their cells, on the floor they touch.
///
/// # Errors
/// The file cannot be written.
pub fn write_picture(path: &Path, title: &str, world: &World, bodies: &[BodyInfo]) -> Result<(), IoError> {
    let mut surfaces = Vec::new();
    for body in bodies {
        let positions = &world.rows(body.system).positions[body.rows.clone()];
        if positions.iter().any(|x| !x.is_finite()) {
            continue;
        }
        let mut surface = MeshSurface::of(&body.mesh);
        surface.move_to(positions);
        let rows = &world.rows(body.system).positions;
        if let Some(solid) = solid_of(world, body) {
            let stress = |cell| solid.cell_field(cell, rows).map_or(f64::NAN, |field| field.von_mises);
            let cells: Vec<f64> = (0..body.mesh.cell_count()).map(stress).collect();
            surface.paint_points(&mean_at_points(body, &cells));
        }
        surface.surface.edge_style = EdgeStyle::Drawn;
        surfaces.push(surface.surface);
    }
    let picture = Picture {
        surfaces,
        ground: floor(world),
        title: title.to_owned(),
        subtitle: format!("{:.3} s", world.time()),
        legend: Some(Legend { title: "von Mises stress".to_owned(), unit: "Pa".to_owned(), range: None }),
        ..Picture::default()
    };
    picture.render()?.write_png(path)
}

/// Values of cells as means over the cells around each point, so that colours run smoothly.
fn mean_at_points(body: &BodyInfo, cells: &[f64]) -> Vec<f64> {
    let mut sums = vec![(0.0, 0.0); body.mesh.points.len()];
    for (cell, value) in body.mesh.cells().zip(cells) {
        for node in cell.nodes {
            let (sum, count) = &mut sums[*node as usize];
            *sum += value;
            *count += 1.0;
        }
    }
    sums.into_iter().map(|(sum, count)| sum / count).collect()
}

/// The first plane that a body may touch.
fn floor(world: &World) -> Option<Ground> {
    let forces = world.model().systems.iter().flat_map(|system| &system.forces);
    let planes = forces.filter_map(|force| force.as_any().downcast_ref::<ShapeContact>()?.shape().as_plane());
    let (point, normal) = planes.into_iter().find(|(_, normal)| normal.dot(Vec3::Y) > 0.5)?;
    Some(Ground { point, normal })
}

/// A plot over time for each probe, `NAME.svg`.
///
/// # Errors
/// A file cannot be written.
pub fn write_plots(folder: &Path, traces: &[Trace]) -> Result<(), IoError> {
    for trace in traces.iter().filter(|trace| trace.times.len() > 1) {
        let component = |c: usize| trace.values.iter().skip(c).step_by(trace.components).copied().collect();
        let curves = match trace.components {
            1 => vec![Curve::new("", trace.times.clone(), component(0))],
            _ => ["x", "y", "z"]
                .into_iter()
                .enumerate()
                .map(|(c, name)| Curve::new(name, trace.times.clone(), component(c)))
                .collect(),
        };
        let plot = Plot {
            title: trace.name.clone(),
            x: Axis::new("time", "s"),
            y: Axis::new(trace.quantity.replace('_', " "), trace.unit),
            curves,
            ..Plot::default()
        };
        plot.write_svg(&folder.join(format!("{}.svg", trace.name)))?;
    }
    Ok(())
}
