//! Bodies of frames: frames are placed, given weights, and asked what they have to say at every point of the body.

use std::ops::Range;
use std::sync::Arc;

use souple_engine::{DerivedRow, Feedback, Force, Kinematics, Mass, Motion, UnknownKind};
use souple_math::Vec3;
use souple_mesh::Mesh;
use souple_models::frames::{
    self, Carried, Frame, FrameError, FramesAtRest, FramesDescription, FramesForce, HeldPoint, Hold, Matter,
    POINTS, ROWS_OF_FRAME, Sample, Shape, Unseen, WEIGHTS, Weights, layer_stiffness,
};
use souple_models::materials::Material;
use souple_models::solids::{Section, lumped_mass};
use souple_table::{Entry, Table, Values, counted};

use super::bodies::{Placed, solid_name};
use super::{Draft, links};
use crate::diagnostic::Code;
use crate::spec::body::{Body, MassKind};
use crate::spec::frames::{DEFAULT_POINTS, DEFAULT_WEIGHTS, FramesSpec};

/// The frames of a body and what they have to say at its points.
pub struct PlacedFrames {
    pub kind: UnknownKind,
    pub frames: Vec<Frame>,
    /// Row of each frame's origin.
    pub rows: Vec<u32>,
    pub samples: Vec<Sample>,
    pub carried: Vec<Carried>,
    pub carried_cells: Vec<Carried>,
    /// At the points of the mesh.
    pub carried_points: Vec<Carried>,
}

/// Frames at a point beyond which steps are slow, which is said.
const MANY: f64 = 24.0;

impl PlacedFrames {
    /// Rows of all frames.
    pub fn row_range(&self) -> Range<usize> {
        let first = self.rows.first().map_or(0, |row| *row as usize);
        first..first + ROWS_OF_FRAME * self.frames.len()
    }

    pub fn give_rows(&mut self, first: usize) {
        self.rows = (0..self.frames.len()).map(|frame| (first + ROWS_OF_FRAME * frame) as u32).collect();
    }

    /// Origins and axes at rest, as rows.
    pub fn configuration(&self) -> impl Iterator<Item = Vec3> + '_ {
        self.frames.iter().flat_map(|frame| {
            let [x, y, z] = frame.axes.columns;
            [frame.origin, x, y, z]
        })
    }

    /// Appends the points of the mesh to the rows, each carried by its frames.
    pub fn add_points(&self, kinematics: &mut Kinematics) {
        for carried in &self.carried_points {
            let parents = carried.weights(&self.rows).filter(|(_, weight)| *weight != 0.0).collect();
            let row = DerivedRow { parents, feedback: Feedback::Transpose };
            // weights are finite, and frames come before points
            kinematics.add_derived_row(row).unwrap_or_else(|error| unreachable!("{error}"));
        }
    }

    pub fn add_mass(&self, kind: MassKind, density_of_cell: &dyn Fn(usize) -> f64, mass: &mut Mass) {
        let masses: Vec<f64> =
            self.samples.iter().map(|sample| density_of_cell(sample.cell as usize) * sample.volume).collect();
        match kind {
            MassKind::Consistent => frames::consistent_mass(&self.carried, &masses, &self.rows, mass),
            // refused where frames are placed: points that frames carry have no mass of their own
            MassKind::Lumped | MassKind::Uniform | MassKind::Voronoi => {
                frames::lumped_mass(&self.frames, &self.samples, &self.carried, &masses, &self.rows, mass);
            }
        }
    }

    /// The elastic force of the body.
    pub fn force(&self, body: &Placed, spec: &FramesSpec) -> Box<dyn Force> {
        Box::new(FramesForce::new(FramesDescription {
            name: solid_name(&body.spec.name),
            frames: &self.frames,
            row_of_frame: &self.rows,
            samples: &self.samples,
            carried: &self.carried,
            carried_cells: self.carried_cells.clone(),
            cell_volumes: body.mesh.cell_volumes(),
            materials: &body.materials.all,
            material_of_cell: &body.materials.of_cell,
            axes: &body.axes,
            tangent: spec.tangent,
        }))
    }

    /// Velocity blocks of a motion `v + ω × (x - c)` of the whole: origins move, axes turn.
    pub fn start_velocity(&self, kinematics: &Kinematics, motion: [Vec3; 3], v: &mut [Vec3]) {
        let [velocity, spin, centre] = motion;
        for (row, frame) in self.rows.iter().zip(&self.frames) {
            let block = kinematics.block_of(*row) as usize;
            v[block] = velocity + spin.cross(frame.origin - centre);
            match self.kind {
                UnknownKind::RigidFrame => v[block + 1] = spin,
                UnknownKind::AffineFrame => {
                    for (k, axis) in frame.axes.columns.iter().enumerate() {
                        v[block + 1 + k] = spin.cross(*axis);
                    }
                }
                // what `frames` never are
                UnknownKind::Point | UnknownKind::QuadraticFrame | UnknownKind::FloatingFrame { .. } => {}
            }
        }
    }
}

fn chosen_or<'a, B: Copy>(
    chosen: &'a Option<crate::reader::Chosen<B>>,
    default: &'static Entry<B>,
    defaults: &'a Values,
) -> (B, &'a Values) {
    chosen.as_ref().map_or((default.build, defaults), |chosen| (chosen.entry.build, &chosen.values))
}

/// An entry that is there.
fn named<B>(table: &'static Table<B>, name: &str) -> &'static Entry<B> {
    table.find(name).unwrap_or_else(|_| unreachable!("`{name}` is in its table"))
}

/// Places the frames of a body; `None` where that was refused.
pub fn place(
    draft: &Draft,
    body: &Body,
    mesh: &Mesh,
    materials: &[Material],
    material_of_cell: &[u16],
    warnings: &mut Vec<String>,
) -> Option<PlacedFrames> {
    let spec = body.frames.as_ref()?;
    if body.section() != Section::Solid {
        let message = "frames carry volumes, and this body is a section";
        draft.log.add(Code::Conflict, &spec.site, message, "a mesh of volume cells, without `section`");
        return None;
    }
    if body.damping.rayleigh_stiffness > 0.0 || body.damping.viscosity > 0.0 {
        let message = "a body of frames has no damping by strain";
        draft.log.add(Code::Conflict, &spec.site, message, "`rayleigh_mass`, or `drag`");
        return None;
    }
    if matches!(body.mass, MassKind::Uniform | MassKind::Voronoi) {
        let message = "a body of frames has its mass in its frames, not in points that are alike";
        draft.log.add(Code::Conflict, &spec.site, message, "`mass = \"lumped\"` or `mass = \"consistent\"`");
        return None;
    }
    match placed(spec, mesh, materials, material_of_cell) {
        Ok(placed) => {
            let count = placed.frames.len();
            if spec.shown >= count {
                let message = format!("body `{}` has no frame {}", body.name, spec.shown);
                draft.log.add(Code::OutOfRange, &spec.shown_site, message, format!("0 to {}", count - 1));
                return None;
            }
            warnings.extend(unseen(draft, body, spec, &placed, mesh));
            let per_point = placed.carried.iter().map(|carried| carried.frames.len() as f64).sum::<f64>()
                / placed.carried.len() as f64;
            if per_point > MANY {
                warnings.push(format!(
                    "{}: {per_point:.0} frames reach each point of body `{}` on the average: a step costs as the square \
                     of that; a smaller `support` of the weights is faster",
                    draft.place(&spec.site),
                    body.name
                ));
            }
            Some(placed)
        }
        Err((stage, error)) => {
            let (site, expected) = match stage {
                Stage::Points => (
                    spec.points.as_ref().map(|chosen| &chosen.site),
                    "points within the body, some for each frame",
                ),
                Stage::Placement => (
                    spec.placement.as_ref().map(|chosen| &chosen.site),
                    "frames apart from each other, within the body",
                ),
                Stage::Weights => (
                    spec.weights.as_ref().map(|chosen| &chosen.site),
                    "frames that reach all of the body, each with matter of its own",
                ),
            };
            draft.log.add(Code::Conflict, site.unwrap_or(&spec.site), error.to_string(), expected);
            None
        }
    }
}

/// What of a body of frames cannot be.
#[derive(Clone, Copy, Debug)]
enum Stage {
    Points,
    Placement,
    Weights,
}

/// A motion of the frames that no point sees, in words: it costs no energy.
fn unseen(
    draft: &Draft,
    body: &Body,
    spec: &FramesSpec,
    placed: &PlacedFrames,
    mesh: &Mesh,
) -> Option<String> {
    let cell_volumes = mesh.cell_volumes();
    let mut of_points = Mass::new(mesh.points.len());
    lumped_mass(mesh, 0, &|_| 1.0, &mut of_points);
    // cells and points stand for half of the volume each
    let half = |volumes: &[f64]| -> Vec<f64> { volumes.iter().map(|volume| 0.5 * volume).collect() };
    let (of_cells, of_points) = (half(&cell_volumes), half(&of_points.diagonal));
    let led: Vec<u32> = spec.bones.iter().flat_map(|bound| bound.frames.iter().copied()).collect();
    let at_rest = FramesAtRest {
        frames: &placed.frames,
        is_affine: spec.kind == UnknownKind::AffineFrame,
        led: &led,
        samples: &placed.samples,
        carried: &placed.carried,
        of_mesh: [(&placed.carried_cells, &of_cells), (&placed.carried_points, &of_points)],
    };
    let Unseen { frame, times } = at_rest.unseen()?;
    let strain = if times < 1e4 { format!("{times:.0} times as much") } else { "by any amount".to_owned() };
    let remedy = match spec.points {
        Some(_) => "more `points`",
        None => "a finer mesh (`points` only makes them fewer)",
    };
    let most = frame.map_or_else(String::new, |frame| format!(", frame {frame} the most,"));
    Some(format!(
        "{}: the {} of body `{}` may move{most} so that its matter strains {strain} between the {} integration points as at them: hardly \
         anything resists that; take {remedy} or fewer frames",
        draft.place(&spec.site),
        counted(placed.frames.len() as u64, "frame"),
        body.name,
        placed.samples.len(),
    ))
}

fn placed(
    spec: &FramesSpec,
    mesh: &Mesh,
    materials: &[Material],
    material_of_cell: &[u16],
) -> Result<PlacedFrames, (Stage, FrameError)> {
    let stiffness_of_cell: Vec<f64> = material_of_cell
        .iter()
        .map(|number| materials[usize::from(*number)].small_strain.youngs_modulus())
        .collect();
    let defaults = Values::new();
    let of = |stage: Stage| move |error: FrameError| (stage, error);
    let (build, values) = chosen_or(&spec.points, named(&POINTS, DEFAULT_POINTS), &defaults);
    let samples = build(values, mesh, material_of_cell);
    let stiffness: Vec<f64> = samples.iter().map(|sample| stiffness_of_cell[sample.cell as usize]).collect();
    let matter = Matter { samples: &samples, stiffness: &stiffness, bounds: mesh.bounds() };
    // a placement that was refused is reported
    let placement = spec.placement.as_ref().ok_or((Stage::Placement, FrameError::NoFrames))?;
    let frames = (placement.entry.build)(&placement.values, &matter).map_err(of(Stage::Placement))?;
    let shape = Shape { frames: &frames, mesh, stiffness_of_cell: &stiffness_of_cell };
    frames::check_apart(&shape).map_err(of(Stage::Placement))?;
    // the entry's own defaults, which its parameters all have
    let entry = named(&WEIGHTS, DEFAULT_WEIGHTS);
    let of_default = entry.values(Values::new()).unwrap_or_default();
    let (build, values) = chosen_or(&spec.weights, entry, &of_default);
    let weights = build(values, &shape).map_err(of(Stage::Weights))?;
    let centres = mesh.cell_centres();
    let places = || samples.iter().map(|sample| sample.position).chain(mesh.points.iter().copied());
    frames::check_reach(&shape, weights.as_ref(), places().chain(centres.iter().copied()))
        .map_err(of(Stage::Weights))?;
    let at = |weights: &dyn Weights, point: Vec3| Carried::new(&frames, &weights.shares(point), point);
    let carried: Vec<Carried> = samples.iter().map(|sample| at(weights.as_ref(), sample.position)).collect();
    let carried_cells = centres.iter().map(|centre| at(weights.as_ref(), *centre)).collect();
    let carried_points = mesh.points.iter().map(|point| at(weights.as_ref(), *point)).collect();
    drop(weights);
    let is_affine = spec.kind == UnknownKind::AffineFrame;
    frames::check_inertia(&frames, &samples, &carried, is_affine).map_err(of(Stage::Points))?;
    Ok(PlacedFrames {
        kind: spec.kind,
        frames,
        rows: Vec::new(),
        samples,
        carried,
        carried_cells,
        carried_points,
    })
}

/// Name of what holds the pinned points of a body of frames.
pub fn hold_name(body: &str) -> String {
    format!("{body}.pins")
}

/// A point of the mesh, along which axes it is held, and how it is led.
pub type HeldAxes = (u32, [bool; 3], Option<Arc<dyn Motion>>);

/// Springs that hold the points of a body of frames: each as stiff as a thin layer of the material around it, over the area that
/// the point has of the faces that are held.
pub fn hold(draft: &Draft, body: &Placed, held: Vec<HeldAxes>) -> Option<Hold> {
    if held.is_empty() {
        return None;
    }
    let numbers: Vec<u32> = held.iter().map(|(point, ..)| *point).collect();
    let (areas, moduli) = (links::areas_held(draft, body, &numbers), links::moduli(body));
    let depth = links::depth(body, numbers.iter().map(|point| areas[*point as usize]).sum());
    let resists_nothing = |modulus: f64| modulus.is_nan() || modulus <= 0.0;
    if let Some((point, ..)) = held.iter().find(|(point, ..)| resists_nothing(moduli[*point as usize])) {
        let message = format!(
            "the matter of body `{}` has a modulus of {} Pa at pinned points: the springs that hold points of frames have no stiffness",
            body.spec.name, moduli[*point as usize]
        );
        let site = body.spec.pins.first().map_or(&body.spec.site, |pin| &pin.site);
        draft.log.add(Code::OutOfRange, site, message, "a law that resists at rest, or no pins");
        return None;
    }
    let points = held.into_iter().map(|(point, axes, motion)| HeldPoint {
        row: body.rows.start as u32 + point,
        stiffness: layer_stiffness(moduli[point as usize], depth) * areas[point as usize],
        start: body.mesh.points[point as usize],
        axes,
        motion,
    });
    Some(Hold::new(hold_name(&body.spec.name), points.collect()))
}

/// Of each point of a mesh: the area of its share of the volume, seen from any side [m²].
pub fn cross_sections(mesh: &Mesh) -> Vec<f64> {
    let mut volumes = Mass::new(mesh.points.len());
    lumped_mass(mesh, 0, &|_| 1.0, &mut volumes);
    volumes.diagonal.iter().map(|volume| volume.cbrt().powi(2)).collect()
}
