//! A run to look at: bodies moment by moment and what they touch, and the pictures and animations made of it.
//!
//! A [`Show`] is read from the frames of a run's folder; [`Figure`] says how it is drawn.

mod common;
mod figure;
mod film;
mod gap;
mod quantity;
mod reel;
mod stage;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use souple_engine::World;
use souple_io::picture::ColourMap;
use souple_io::{Field, IoError};
use souple_math::Vec3;
use souple_mesh::{BoundingBox, Mesh};
use souple_scene::{BodyInfo, DressInfo, SkinInfo};

use crate::Session;
use crate::frames::Outline;

pub use common::{Common, Gathering};
pub use figure::{Arrows, Figure, Floor, FrameAxes, Worn};
pub use film::{FilmError, write_film};
pub use gap::GAP;
pub use quantity::number_of;
pub(crate) use quantity::{BLOOD, TISSUE};
pub use reel::Reel;
pub use stage::{Stage, obstacles_of};

/// The map whose colours mean what a quantity says, `element` or `adaptation`; `None` where any will do.
pub fn map_of(quantity: &str) -> Option<ColourMap> {
    quantity::Quantity::parse(quantity).own_map()
}

/// The unit of a quantity; nothing where it has none that is known.
pub fn unit_of(quantity: &str) -> &'static str {
    quantity::Quantity::parse(quantity).unit()
}

/// All bodies and skins at one time.
#[derive(Clone, Debug)]
pub struct Moment {
    /// [s]
    pub time: f64,
    pub bodies: Vec<BodyMoment>,
}

/// One body at one time.
#[derive(Clone, Debug)]
pub struct BodyMoment {
    pub name: String,
    pub mesh: Arc<Mesh>,
    /// [m]
    pub positions: Vec<Vec3>,
    pub point_fields: Vec<Field>,
    pub cell_fields: Vec<Field>,
    /// Origin and axes of the frames that carry it.
    pub frames: Vec<[Vec3; 4]>,
}

/// A run's moments on their stage.
#[derive(Clone, Debug)]
pub struct Show {
    pub stage: Stage,
    pub moments: Vec<Moment>,
}

/// What cannot be shown.
#[derive(Debug, thiserror::Error)]
pub enum ShowError {
    #[error(transparent)]
    Io(#[from] IoError),
    #[error("{}: {found}; expected the folder of a run with its series in `frames`, or a list of frames, whose bodies have the same times", .folder.display())]
    NoFrames { folder: PathBuf, found: String },
    #[error("no body has the field `{name}`; expected {expected}")]
    UnknownField { name: String, expected: String },
    #[error("the {what} is {value}; expected {expected}")]
    Request { what: &'static str, value: String, expected: String },
}

impl Show {
    /// The frames of a run's folder.
    ///
    /// # Errors
    /// There are none, their times differ from body to body, or a file cannot be read.
    pub fn of_run(folder: &Path, stage: Stage) -> Result<Self, ShowError> {
        let reel = Reel::of_run(folder, stage)?;
        let all: Vec<usize> = (0..reel.times().len()).collect();
        reel.show(&all)
    }

    /// A mesh by itself, as it stands.
    pub fn of_mesh(name: &str, mesh: Mesh) -> Self {
        let mut stage = Stage::default();
        name.clone_into(&mut stage.title);
        let mesh = if mesh.cell_count() == 0 { mesh.facets_as_cells() } else { mesh };
        let body = BodyMoment {
            name: name.to_owned(),
            positions: mesh.points.clone(),
            mesh: Arc::new(mesh),
            point_fields: Vec::new(),
            cell_fields: Vec::new(),
            frames: Vec::new(),
        };
        Self { stage, moments: vec![Moment { time: 0.0, bodies: vec![body] }] }
    }

    /// Of all bodies at all moments.
    pub fn bounds(&self) -> BoundingBox {
        let positions =
            self.moments.iter().flat_map(|moment| &moment.bodies).flat_map(|body| &body.positions);
        BoundingBox::of(positions.copied().filter(|x| x.is_finite()))
    }
}

impl BodyMoment {
    /// Of its cells those that are kept, with their points; all points where no cell is.
    fn of_cells(self, is_kept: impl Fn(usize) -> bool) -> Self {
        let cells: Vec<usize> = (0..self.mesh.cell_count()).filter(|cell| is_kept(*cell)).collect();
        let mut mesh = self.mesh.of_cells(is_kept);
        let mut is_there = vec![cells.is_empty(); mesh.points.len()];
        mesh.cells().flat_map(|cell| cell.nodes).for_each(|node| is_there[*node as usize] = true);
        let points: Vec<usize> = (0..is_there.len()).filter(|point| is_there[*point]).collect();
        let left = |field: Field, kept: &[usize]| {
            let of_one = |one: &usize| &field.values[one * field.components..][..field.components];
            let values = kept.iter().flat_map(of_one).copied().collect();
            Field { values, ..field }
        };
        mesh.keep_points(&points);
        Self {
            mesh: Arc::new(mesh),
            positions: points.iter().map(|point| self.positions[*point]).collect(),
            point_fields: self.point_fields.into_iter().map(|field| left(field, &points)).collect(),
            cell_fields: self.cell_fields.into_iter().map(|field| left(field, &cells)).collect(),
            ..self
        }
    }
}

/// Size of a body that can be drawn, and of a solid that has not blown up, in sizes of its mesh.
pub(crate) const MOST_GROWTH: f64 = 100.0;

/// How large a body is, in sizes of its mesh; 1 where the mesh has none: masses that start at one place may go
/// anywhere.
pub(crate) fn growth(mesh: &[Vec3], positions: &[Vec3]) -> f64 {
    let extent = |points: &[Vec3]| BoundingBox::of(points.iter().copied()).diagonal();
    let rest = extent(mesh);
    if rest > 0.0 { extent(positions) / rest } else { 1.0 }
}

/// The size of the largest of some cells of a mesh, in sizes of it: of a body that is cut, parts may be anywhere.
pub(crate) fn growth_of_cells(mesh: &Mesh, positions: &[Vec3], is_kept: impl Fn(usize) -> bool) -> f64 {
    let extent =
        |nodes: &[u32]| BoundingBox::of(nodes.iter().map(|node| positions[*node as usize])).diagonal();
    let kept = mesh.cells().enumerate().filter(|(cell, _)| is_kept(*cell));
    let largest = kept.map(|(_, cell)| extent(cell.nodes)).fold(0.0, f64::max);
    largest / mesh.bounds().diagonal()
}

/// A field of three numbers on the points.
fn vectors(body: &BodyMoment, name: &str) -> Option<Vec<Vec3>> {
    let field = body.point_fields.iter().find(|field| field.name == name && field.components == 3)?;
    Some(field.values.chunks_exact(3).map(|v| Vec3::new(v[0], v[1], v[2])).collect())
}

impl Moment {
    /// Whether a body has a field of this name, on points or cells.
    pub fn has_field(&self, name: &str) -> bool {
        self.bodies.iter().any(|body| body.has_field(name))
    }

    /// Whether all of it can be drawn.
    pub fn is_drawable(&self) -> bool {
        self.bodies.iter().all(BodyMoment::is_drawable)
    }

    /// The present state of a session, all bodies, then all skins, then all dresses, then all faces and contours.
    pub fn of_session(session: &Session) -> Self {
        let world = &session.world;
        let body = |info: &BodyInfo| {
            let (point_fields, cell_fields) = crate::frames::fields(world, info);
            let whole = BodyMoment {
                name: info.name.clone(),
                mesh: Arc::clone(&info.mesh),
                positions: world.rows(info.system).positions[info.rows.clone()].to_vec(),
                point_fields,
                cell_fields,
                frames: frames_of(world, info),
            };
            // a cut opens the surface that is drawn: it is that of the cells which are left
            let is_whole = |cell: usize| info.is_whole(cell, world.time());
            if (0..info.cut_at.len()).all(is_whole) { whole } else { whole.of_cells(is_whole) }
        };
        let skin = |info: &SkinInfo| {
            let (mesh, normals) = crate::frames::mesh_of_skin(info, world);
            BodyMoment {
                name: crate::frames::name_of_skin(info, &session.bodies),
                positions: mesh.points.clone(),
                mesh: Arc::new(mesh),
                point_fields: vec![crate::frames::normal_field(&normals)],
                cell_fields: Vec::new(),
                frames: Vec::new(),
            }
        };
        let dress = |info: &DressInfo| {
            let (mesh, point_fields) = crate::frames::mesh_of_dress(info, world);
            BodyMoment {
                name: crate::frames::worn_by(&info.body),
                positions: mesh.points.clone(),
                mesh: Arc::new(mesh),
                point_fields,
                cell_fields: Vec::new(),
                frames: Vec::new(),
            }
        };
        let outline = |(name, outline): (String, Outline)| BodyMoment {
            name,
            positions: outline.mesh.points.clone(),
            mesh: Arc::new(outline.mesh),
            point_fields: outline.point_fields,
            cell_fields: outline.cell_fields,
            frames: Vec::new(),
        };
        let names = crate::frames::names_of_outlines(&session.bodies);
        let outlines = names.zip(crate::frames::outlines(&session.bodies, world)).map(outline);
        let bodies = session.bodies.iter().map(body);
        let skins = session.skins.iter().map(skin);
        let dresses = session.bodies.iter().filter_map(|body| body.dress.as_ref()).map(dress);
        Self { time: world.time(), bodies: bodies.chain(skins).chain(dresses).chain(outlines).collect() }
    }

    /// The skin or the dress that a body wears.
    pub(super) fn skin_of(&self, body: &BodyMoment) -> Option<&BodyMoment> {
        let skin = crate::frames::worn_by(&body.name);
        self.bodies.iter().find(|other| other.name == skin)
    }

    /// The body that wears one as its skin.
    pub(super) fn wearer_of(&self, skin: &BodyMoment) -> Option<&BodyMoment> {
        self.bodies.iter().find(|other| crate::frames::worn_by(&other.name) == skin.name)
    }

    /// The faces of bodies in a network.
    pub(super) fn faces_of(&self, network: &BodyMoment) -> Option<&BodyMoment> {
        let faces = crate::frames::faces_of(&network.name);
        self.bodies.iter().find(|other| other.name == faces)
    }

    /// Without the bodies that wear a skin, which hides them.
    #[must_use]
    pub fn without_worn(mut self) -> Self {
        let skins: Vec<String> = self.bodies.iter().map(|body| body.name.clone()).collect();
        self.bodies.retain(|body| !skins.contains(&crate::frames::worn_by(&body.name)));
        self
    }
}

fn frames_of(world: &World, info: &BodyInfo) -> Vec<[Vec3; 4]> {
    let positions = &world.rows(info.system).positions;
    let rows = info.frames.iter().flat_map(|frames| &frames.rows);
    rows.map(|row| std::array::from_fn(|k| positions[*row as usize + k])).collect()
}

impl BodyMoment {
    /// Whether it has a field of this name, on points or cells.
    pub fn has_field(&self, name: &str) -> bool {
        self.point_fields.iter().chain(&self.cell_fields).any(|field| field.name == name)
    }

    /// Whether it can be drawn: it is finite, and has not grown beyond all bounds; of one that has, a point or two
    /// would be seen.
    fn is_drawable(&self) -> bool {
        self.positions.iter().all(|x| x.is_finite())
            && growth(&self.mesh.points, &self.positions) <= MOST_GROWTH
    }
}
