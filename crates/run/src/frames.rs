//! The frames of a run: a series of files for ParaView per body, per skin, per contour and per body's frames that carry it, and a skin's
//! surface in other formats.

use std::path::{Path, PathBuf};

use souple_engine::{Adapted, Force, Model, World};
use souple_io::{Facets, Field, Output, Precision, Series, write_mesh};
use souple_math::Vec3;
use souple_mesh::{ElementKind, Mesh};
use souple_models::marks::Mark;
use souple_scene::{BodyInfo, DressInfo, SkinInfo};

use crate::Session;
use crate::links::RADIUS;
use crate::output::{FRAMES, OutputError, OutputFolder};
use crate::show::{BLOOD, Moment, TISSUE};

/// Writes frames at even distances; none where the run has no folder.
pub struct Frames {
    folder: PathBuf,
    bodies: Vec<Series>,
    skins: Vec<Series>,
    dresses: Vec<Series>,
    /// Of all bodies, one after the other.
    outlines: Vec<Series>,
    /// Of bodies that frames carry, with their numbers.
    carriers: Vec<(usize, Series)>,
    /// Steps between frames.
    every: u64,
    last_written: Option<u64>,
    step: u64,
    /// What a picture draws of the last frame that can be drawn.
    drawable: Option<Moment>,
}

impl Frames {
    pub fn open(
        folder: Option<&OutputFolder>,
        session: &Session,
        count: u64,
        steps: u64,
    ) -> Result<Self, OutputError> {
        let (mut bodies, mut skins) = (Vec::new(), Vec::new());
        let (mut dresses, mut outlines, mut carriers) = (Vec::new(), Vec::new(), Vec::new());
        let mut path = PathBuf::new();
        if let Some(folder) = folder.filter(|_| count > 0) {
            path = folder.frames()?;
            bodies = session.bodies.iter().map(|body| Series::new(&path, &body.name)).collect();
            let name = |skin| name_of_skin(skin, &session.bodies);
            skins = session.skins.iter().map(|skin| Series::new(&path, name(skin))).collect();
            let worn = session.bodies.iter().filter_map(|body| body.dress.as_ref());
            dresses = worn.map(|dress| Series::new(&path, worn_by(&dress.body))).collect();
            outlines = names_of_outlines(&session.bodies).map(|name| Series::new(&path, name)).collect();
            let carried = session.bodies.iter().enumerate().filter(|(_, body)| body.frames.is_some());
            let series =
                |(index, body): (usize, &BodyInfo)| (index, Series::new(&path, carriers_of(&body.name)));
            carriers = carried.map(series).collect();
        }
        let every = if count > 0 { steps.div_ceil(count).max(1) } else { u64::MAX };
        Ok(Self {
            folder: path,
            bodies,
            skins,
            dresses,
            outlines,
            carriers,
            every,
            last_written: None,
            step: 0,
            drawable: None,
        })
    }

    /// The frame of a step, if one is due; whether it was.
    pub fn write(
        &mut self,
        folder: Option<&mut OutputFolder>,
        session: &mut Session,
        step: u64,
    ) -> Result<bool, OutputError> {
        self.step = step;
        match folder {
            Some(folder) if step.is_multiple_of(self.every) => {
                self.write_now(folder, session)?;
                Ok(true)
            }
            _ => Ok(false),
        }
    }

    /// The last frame, however the run ended.
    pub fn close(
        &mut self,
        folder: Option<&mut OutputFolder>,
        session: &mut Session,
    ) -> Result<(), OutputError> {
        match folder {
            Some(folder) if self.last_written != Some(self.step) => self.write_now(folder, session),
            _ => Ok(()),
        }
    }

    /// The state of a session, or the last frame before it that can be drawn.
    pub fn drawable(&self, session: &Session) -> Option<Moment> {
        let now = Moment::of_session(session);
        if now.is_drawable() { Some(now) } else { self.drawable.clone() }
    }

    fn write_now(&mut self, folder: &mut OutputFolder, session: &mut Session) -> Result<(), OutputError> {
        // beside what is written of a million balls there is no room for the work of steps
        session.free_workspace();
        let moment = Moment::of_session(session);
        for (series, body) in self.bodies.iter_mut().zip(&moment.bodies) {
            let output = Output {
                mesh: &body.mesh,
                positions: Some(&body.positions),
                point_fields: &body.point_fields,
                cell_fields: &body.cell_fields,
                facets: Facets::LeftOut,
                precision: precision_for(&body.positions),
            };
            push(folder, series, moment.time, &output)?;
        }
        for (series, skin) in self.skins.iter_mut().zip(&session.skins) {
            let (mesh, normals) = mesh_of_skin(skin, &session.world);
            // of a skin that is gone there is no surface to write
            for format in skin.formats.iter().filter(|_| mesh.facet_count() + mesh.cell_count() > 0) {
                let [frame, _] = series.next_names();
                let name = frame.replace(".vtu", &format!(".{format}"));
                folder.claim(&format!("{FRAMES}/{name}"))?;
                write_mesh(&self.folder.join(Path::new(&name)), &mesh)?;
            }
            push(folder, series, moment.time, &as_it_stands(&mesh, &[normal_field(&normals)]))?;
        }
        let worn = session.bodies.iter().filter_map(|body| body.dress.as_ref());
        for (series, dress) in self.dresses.iter_mut().zip(worn) {
            let (mesh, fields) = mesh_of_dress(dress, &session.world);
            push(folder, series, moment.time, &as_it_stands(&mesh, &fields))?;
        }
        let own = moment.bodies.iter().rev().take(self.outlines.len()).rev();
        for (series, outline) in self.outlines.iter_mut().zip(own) {
            let output = Output {
                cell_fields: &outline.cell_fields,
                ..as_it_stands(&outline.mesh, &outline.point_fields)
            };
            push(folder, series, moment.time, &output)?;
        }
        for (index, series) in &mut self.carriers {
            let (mesh, fields) = mesh_of_carriers(&moment.bodies[*index].frames);
            push(folder, series, moment.time, &as_it_stands(&mesh, &fields))?;
        }
        if moment.is_drawable() {
            self.drawable = Some(as_drawn(moment));
        }
        self.last_written = Some(self.step);
        Ok(())
    }
}

/// Without fields that no picture of the end of a run shows: of a million balls each of them is 24 MB.
fn as_drawn(mut moment: Moment) -> Moment {
    for body in &mut moment.bodies {
        body.point_fields.retain(|field| ![DISPLACEMENT, VELOCITY].contains(&field.name.as_str()));
    }
    moment
}

/// A mesh whose own points are where it stands.
fn as_it_stands<'a>(mesh: &'a Mesh, point_fields: &'a [Field]) -> Output<'a> {
    Output {
        mesh,
        positions: None,
        point_fields,
        cell_fields: &[],
        facets: Facets::LeftOut,
        precision: precision_for(&mesh.points),
    }
}

fn push(
    folder: &mut OutputFolder,
    series: &mut Series,
    time: f64,
    output: &Output,
) -> Result<(), OutputError> {
    for name in series.next_names() {
        folder.claim(&format!("{FRAMES}/{name}"))?;
    }
    series.push(time, output)?;
    Ok(())
}

/// The name of the files of the skin that a body wears.
pub fn worn_by(body: &str) -> String {
    format!("{body}.skin")
}

/// The field of the faces of a network that tells which body each is of.
pub const PART: &str = "part";

/// What the name of the files of a network's faces ends in.
const FACES: &str = "faces";

/// The name of the files of the faces of bodies in a network.
pub fn faces_of(network: &str) -> String {
    format!("{network}.{FACES}")
}

/// The name of the files of the frames that carry a body.
pub fn carriers_of(body: &str) -> String {
    format!("{body}.frames")
}

/// Fields of the points of these files.
const AXES: [&str; 3] = ["axis_x", "axis_y", "axis_z"];

/// Frames as points with their axes.
fn mesh_of_carriers(frames: &[[Vec3; 4]]) -> (Mesh, Vec<Field>) {
    let mesh = Mesh { points: frames.iter().map(|frame| frame[0]).collect(), ..Mesh::default() };
    let axis = |(k, name): (usize, &&str)| {
        let axes: Vec<Vec3> = frames.iter().map(|frame| frame[k + 1]).collect();
        Field::new(*name, 3, flat(&axes))
    };
    (mesh, AXES.iter().enumerate().map(axis).collect())
}

/// Frames from points with their axes; none where fields of the axes are missing.
pub fn carriers_from(points: &[Vec3], fields: &[Field]) -> Vec<[Vec3; 4]> {
    let axis = |name: &str| {
        let field = fields.iter().find(|field| field.name == name && field.components == 3)?;
        Some(field.values.chunks_exact(3).map(|v| Vec3::new(v[0], v[1], v[2])).collect::<Vec<_>>())
    };
    let [Some(x), Some(y), Some(z)] = AXES.map(axis) else { return Vec::new() };
    let axes = x.into_iter().zip(y).zip(z);
    points.iter().zip(axes).map(|(origin, ((x, y), z))| [*origin, x, y, z]).collect()
}

/// The name of a skin's files: its own, `NAME.skin` for that of a body.
pub fn name_of_skin(skin: &SkinInfo, bodies: &[BodyInfo]) -> String {
    let is_worn = bodies.iter().any(|body| body.name == skin.name);
    if is_worn { worn_by(&skin.name) } else { skin.name.clone() }
}

/// The names of the files of what networks have beside masses and links, body by body: `NETWORK.faces` and `NETWORK.CONTOUR`.
pub fn names_of_outlines(bodies: &[BodyInfo]) -> impl Iterator<Item = String> + '_ {
    bodies.iter().flat_map(|body| {
        let faces = body.faces.as_ref().map(|_| FACES).into_iter();
        let contours = body.contours.iter().map(|contour| contour.name.as_str());
        faces.chain(contours).map(|name| format!("{}.{name}", body.name))
    })
}

/// What a network has beside masses and links, as it stands, with its fields.
#[derive(Default)]
pub struct Outline {
    pub mesh: Mesh,
    pub point_fields: Vec<Field>,
    pub cell_fields: Vec<Field>,
}

/// The faces and the lines of contours as they stand, body by body.
pub fn outlines(bodies: &[BodyInfo], world: &World) -> Vec<Outline> {
    let of_body = |body: &BodyInfo| {
        let positions = &world.rows(body.system).positions;
        let faces = body.faces.as_ref().map(|faces| {
            let points = positions[body.rows.clone()].to_vec();
            let mesh = Mesh::new(points, ElementKind::Tri3, faces.triangles.as_flattened().to_vec());
            let numbers = faces.numbers().map(f64::from).collect();
            let (point_fields, _) = fields(world, body);
            let point_fields = point_fields.into_iter().filter(|field| field.name != RADIUS).collect();
            Outline { mesh, point_fields, cell_fields: vec![Field::new(PART, 1, numbers)] }
        });
        let contours = body
            .contours
            .iter()
            .map(|contour| Outline { mesh: closed_lines(&contour.places(positions)), ..Outline::default() });
        faces.into_iter().chain(contours).collect::<Vec<_>>()
    };
    bodies.iter().flat_map(of_body).collect()
}

fn closed_lines(lines: &[Vec<Vec3>]) -> Mesh {
    let mut mesh = Mesh::default();
    for line in lines {
        let first = mesh.points.len() as u32;
        mesh.points.extend(line);
        let last = mesh.points.len() as u32 - 1;
        for at in first..=last {
            mesh.push_cell(ElementKind::Edge2, &[at, if at == last { first } else { at + 1 }]);
        }
    }
    mesh
}

/// A skin's triangles as they stand, and its normals.
pub fn mesh_of_skin(skin: &SkinInfo, world: &World) -> (Mesh, Vec<Vec3>) {
    let (surface, normals) = skin.surface(world);
    let mut mesh = Mesh { points: surface.points, ..Mesh::default() };
    surface.triangles.iter().for_each(|corners| mesh.push_cell(ElementKind::Tri3, corners));
    (mesh, normals)
}

/// A display surface as it stands: its triangles, displacements, levels, normals and the marks that are carried over to it.
pub fn mesh_of_dress(info: &DressInfo, world: &World) -> (Mesh, Vec<Field>) {
    let mut mesh = Mesh { points: info.points(world), ..Mesh::default() };
    let triangles = info.dress.triangles(world.time());
    gather_loose(&mut mesh.points, &triangles);
    triangles.iter().for_each(|corners| mesh.push_cell(ElementKind::Tri3, corners));
    let normals = souple_mesh::vertex_normals(&mesh.points, &triangles);
    let moved = mesh.points.iter().zip(info.dress.rest()).map(|(x, rest)| *x - *rest);
    let displacements: Vec<Vec3> = moved.collect();
    let mut fields = vec![
        Field::new(DISPLACEMENT, 3, flat(&displacements)),
        Field::new("level", 1, info.levels(world)),
        normal_field(&normals),
    ];
    fields.extend(info.marks.iter().flat_map(|carried| {
        let mark = |node: usize| carried.mark_at(node, world);
        let look = |node: usize| carried.look_at(node, world);
        fields_of_marks(mesh.points.len(), carried.marks.marks.bleeds(), mark, look)
    }));
    (mesh, fields)
}

/// Puts points of no triangle, which hang on what has been cut away, where the first one of a triangle is.
fn gather_loose(points: &mut [Vec3], triangles: &[[u32; 3]]) {
    let Some(there) = triangles.first().map(|corners| points[corners[0] as usize]) else { return };
    let mut is_held = vec![false; points.len()];
    triangles.iter().flatten().for_each(|corner| is_held[*corner as usize] = true);
    points.iter_mut().zip(is_held).filter(|(_, is_held)| !is_held).for_each(|(point, _)| *point = there);
}

/// What points of all bodies have.
pub(crate) const DISPLACEMENT: &str = "displacement";
const VELOCITY: &str = "velocity";

/// What a skin's points have and no body's do.
pub const NORMAL: &str = "normal";

pub fn normal_field(normals: &[Vec3]) -> Field {
    Field::new(NORMAL, 3, flat(normals))
}

/// Single, unless a run that went astray left coordinates which would become infinite by it: such a frame could not
/// be read again.
fn precision_for(positions: &[Vec3]) -> Precision {
    let fits = positions.iter().all(|x| x.to_array().iter().all(|c| c.abs() <= f64::from(f32::MAX)));
    if fits { Precision::Single } else { Precision::Double }
}

/// Displacement and velocity of every point, the weight of the frame that is shown, the level at work, the radius of a ball; stress and
/// energy density of every cell, state and force of every link.
pub fn fields(world: &World, body: &BodyInfo) -> (Vec<Field>, Vec<Field>) {
    let positions = &world.rows(body.system).positions[body.rows.clone()];
    let velocities = &world.rows(body.system).velocities[body.rows.clone()];
    let moved = positions.iter().zip(&body.mesh.points);
    let displacements = moved.flat_map(|(x, rest)| (*x - *rest).to_array()).collect();
    let mut point_fields =
        vec![Field::new(DISPLACEMENT, 3, displacements), Field::new(VELOCITY, 3, flat(velocities))];
    let influence = body
        .frames
        .as_ref()
        .map(|frames| (0..positions.len()).map(|point| frames.influence(point)).collect());
    point_fields.extend(influence.map(|influence| Field::new("influence", 1, influence)));
    let levels = body.level_of_point(world);
    point_fields
        .extend(levels.map(|levels| Field::new("level", 1, levels.iter().map(|l| f64::from(*l)).collect())));
    let (radius, of_links) = crate::links::fields(world, body);
    point_fields.extend(radius);
    point_fields.extend(body.marks.iter().flat_map(|marks| {
        let mark = |point: usize| marks.mark_at(point, world).unwrap_or_default();
        let look = |point: usize| marks.look_at(point, world);
        fields_of_marks(positions.len(), marks.marks.bleeds(), mark, look)
    }));
    let mut of_cells = cell_fields(world, body);
    of_cells.extend(of_links);
    (point_fields, of_cells)
}

/// What tools left on a surface, nothing inside: whitening, dose, how both look, and the blood on it where it bleeds.
fn fields_of_marks(
    count: usize,
    bleeds: bool,
    mark: impl Fn(usize) -> Mark,
    look: impl Fn(usize) -> f64,
) -> Vec<Field> {
    let field = |name: &str, number: fn(&Mark) -> f64| {
        Field::new(name, 1, (0..count).map(|point| number(&mark(point))).collect())
    };
    let mut fields = vec![
        field("whitening", |mark| mark.whitening),
        field("burn", |mark| mark.dose),
        Field::new(TISSUE, 1, (0..count).map(look).collect()),
    ];
    fields.extend(bleeds.then(|| field(BLOOD, |mark| mark.blood)));
    fields
}

fn flat(vectors: &[Vec3]) -> Vec<f64> {
    vectors.iter().flat_map(|vector| vector.to_array()).collect()
}

/// Whether a file in the folder of frames may be a body's or a skin's: `NAME.pvd` or `NAME_0000.vtu`.
pub fn is_frame_of(name: &str, format: &str, file: &str) -> bool {
    let Some(rest) = file.strip_prefix(name) else { return false };
    let number = rest.strip_prefix('_').and_then(|rest| rest.strip_suffix(format)?.strip_suffix('.'));
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
    let Some((solid, at)) = world.force_named(body.system, &body.force) else {
        return Vec::new();
    };
    let (mut stress, mut von_mises, mut energy) = (Vec::new(), Vec::new(), Vec::new());
    for cell in 0..body.mesh.cell_count() {
        let Some(field) = solid.cell_field_at(cell, &at) else {
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
    let mut fields = vec![
        Field::new("stress", 6, stress),
        Field::new("von_mises", 1, von_mises),
        Field::new("strain_energy_density", 1, energy),
    ];
    let adapted: Option<Vec<_>> = (0..body.mesh.cell_count()).map(|cell| solid.adapted(cell, &at)).collect();
    if let Some(adapted) = adapted {
        fields.push(Field::new("law", 1, adapted.iter().map(|adapted| adapted.law).collect()));
        fields.push(Field::new("excess", 1, adapted.iter().map(|adapted| adapted.excess).collect()));
        // for one map of colours: from 0 to 1 as a criterion nears its threshold, -1 where the second law is
        let shown = |adapted: &Adapted| if adapted.law == 0.0 { adapted.excess.min(1.0) } else { -1.0 };
        fields.push(Field::new("adaptation", 1, adapted.iter().map(shown).collect()));
    }
    fields
}
