//! The frames of a run: a series of files for ParaView per body.

use souple_engine::{Force, Model, World};
use souple_io::{Facets, Field, Output, Precision, Series};
use souple_math::Vec3;
use souple_scene::BodyInfo;

use crate::output::{FRAMES, OutputError, OutputFolder};
use crate::show::Moment;

/// Writes frames at even distances; none where the run has no folder.
pub struct Frames {
    series: Vec<Series>,
    /// Steps between frames.
    every: u64,
    last_written: Option<u64>,
    step: u64,
    /// The last frame that can be drawn.
    drawable: Option<Moment>,
}

impl Frames {
    pub fn open(
        folder: Option<&OutputFolder>,
        bodies: &[BodyInfo],
        count: u64,
        steps: u64,
    ) -> Result<Self, OutputError> {
        let mut series = Vec::new();
        if let Some(folder) = folder.filter(|_| count > 0) {
            let folder = folder.frames()?;
            series = bodies.iter().map(|body| Series::new(&folder, &body.name)).collect();
        }
        let every = if count > 0 { steps.div_ceil(count).max(1) } else { u64::MAX };
        Ok(Self { series, every, last_written: None, step: 0, drawable: None })
    }

    /// The frame of a step, if one is due.
    pub fn write(
        &mut self,
        folder: Option<&mut OutputFolder>,
        world: &World,
        bodies: &[BodyInfo],
        step: u64,
    ) -> Result<(), OutputError> {
        self.step = step;
        match folder {
            Some(folder) if step.is_multiple_of(self.every) => self.write_now(folder, world, bodies),
            _ => Ok(()),
        }
    }

    /// The last frame, however the run ended.
    pub fn close(
        &mut self,
        folder: Option<&mut OutputFolder>,
        world: &World,
        bodies: &[BodyInfo],
    ) -> Result<(), OutputError> {
        match folder {
            Some(folder) if self.last_written != Some(self.step) => self.write_now(folder, world, bodies),
            _ => Ok(()),
        }
    }

    /// The state of a world, or the last frame before it that can be drawn.
    pub fn drawable(&self, world: &World, bodies: &[BodyInfo]) -> Option<Moment> {
        let now = Moment::of_world(world, bodies, self.drawable.as_ref());
        if now.is_drawable() { Some(now) } else { self.drawable.clone() }
    }

    fn write_now(
        &mut self,
        folder: &mut OutputFolder,
        world: &World,
        bodies: &[BodyInfo],
    ) -> Result<(), OutputError> {
        let moment = Moment::of_world(world, bodies, self.drawable.as_ref());
        for (series, body) in self.series.iter_mut().zip(&moment.bodies) {
            let output = Output {
                mesh: &body.mesh,
                positions: Some(&body.positions),
                point_fields: &body.point_fields,
                cell_fields: &body.cell_fields,
                facets: Facets::LeftOut,
                precision: precision_for(&body.positions),
            };
            for name in series.next_names() {
                folder.claim(&format!("{FRAMES}/{name}"))?;
            }
            series.push(moment.time, &output)?;
        }
        if moment.is_drawable() {
            self.drawable = Some(moment);
        }
        self.last_written = Some(self.step);
        Ok(())
    }
}

/// Single, unless a run that went astray left coordinates which would become infinite by it: such a frame could not
/// be read again.
fn precision_for(positions: &[Vec3]) -> Precision {
    let fits = positions.iter().all(|x| x.to_array().iter().all(|c| c.abs() <= f64::from(f32::MAX)));
    if fits { Precision::Single } else { Precision::Double }
}

/// Displacement and velocity of every point, and the weight of the frame that is shown; stress and energy density of every cell.
pub fn fields(world: &World, body: &BodyInfo) -> (Vec<Field>, Vec<Field>) {
    let positions = &world.rows(body.system).positions[body.rows.clone()];
    let velocities = &world.rows(body.system).velocities[body.rows.clone()];
    let displacements: Vec<Vec3> =
        positions.iter().zip(&body.mesh.points).map(|(x, rest)| *x - *rest).collect();
    let mut point_fields = vec![
        Field::new("displacement", 3, flat(&displacements)),
        Field::new("velocity", 3, flat(velocities)),
    ];
    point_fields
        .extend(body.frames.as_ref().map(|frames| Field::new("influence", 1, frames.influence.clone())));
    (point_fields, cell_fields(world, body))
}

fn flat(vectors: &[Vec3]) -> Vec<f64> {
    vectors.iter().flat_map(|vector| vector.to_array()).collect()
}

/// Whether a file in the folder of frames may be a body's: `NAME.pvd` or `NAME_0000.vtu`.
pub fn is_frame_of(body: &str, file: &str) -> bool {
    let Some(rest) = file.strip_prefix(body) else { return false };
    let number = rest.strip_prefix('_').and_then(|rest| rest.strip_suffix(".vtu"));
    rest == ".pvd"
        || number.is_some_and(|digits| digits.len() >= 4 && digits.bytes().all(|b| b.is_ascii_digit()))
}

/// The elastic force of a body.
pub fn solid_of<'a>(model: &'a Model, body: &BodyInfo) -> Option<&'a dyn Force> {
    let forces = &model.systems[body.system].forces;
    forces.iter().find(|force| force.name() == body.force).map(AsRef::as_ref)
}

/// Cauchy stress (six components xx, yy, zz, xy, yz, xz), von Mises stress and energy density of every cell.
fn cell_fields(world: &World, body: &BodyInfo) -> Vec<Field> {
    let Some(solid) = solid_of(world.model(), body) else {
        return Vec::new();
    };
    let positions = &world.rows(body.system).positions;
    let (mut stress, mut von_mises, mut energy) = (Vec::new(), Vec::new(), Vec::new());
    for cell in 0..body.mesh.cell_count() {
        let Some(field) = solid.cell_field(cell, positions) else {
            return Vec::new();
        };
        let s = field.cauchy;
        stress.extend([
            s.entry(0, 0),
            s.entry(1, 1),
            s.entry(2, 2),
            s.entry(0, 1),
            s.entry(1, 2),
            s.entry(0, 2),
        ]);
        von_mises.push(field.von_mises);
        energy.push(field.energy_density);
    }
    vec![
        Field::new("stress", 6, stress),
        Field::new("von_mises", 1, von_mises),
        Field::new("strain_energy_density", 1, energy),
    ]
}
