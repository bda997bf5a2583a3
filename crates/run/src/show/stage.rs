//! What stands around the bodies of a scene: shapes that they touch, and which way is up.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use souple_engine::obstacle::{Form, Obstacle, Side};
use souple_engine::{Force, Model};
use souple_io::picture::{Colour, EdgeStyle, Faces, Ground, Paint, Surface, Texture};
use souple_math::Vec3;
use souple_mesh::BoundingBox;
use souple_models::frames::ROWS_OF_FRAME;
use souple_scene::spec::picture::{PictureSpec, PictureView};
use souple_scene::{BodyInfo, Scene};

use crate::frames::solid_of;

/// The surroundings of a scene.
#[derive(Clone, Debug)]
pub struct Stage {
    pub title: String,
    /// From where the scene is seen, and what is up.
    pub view: PictureView,
    /// Stress for each unit of strain of the stiffest body [Pa]; zero where it is not known.
    pub stiffness: f64,
    obstacles: Vec<Obstacle>,
    /// Of bodies, by their names.
    textures: Vec<(String, Arc<Texture>)>,
}

impl Default for Stage {
    /// Nothing stands around; `y` is up.
    fn default() -> Self {
        let view = PictureSpec::default().view(Vec3::ZERO);
        Self { title: String::new(), view, stiffness: 0.0, obstacles: Vec::new(), textures: Vec::new() }
    }
}

/// What some forces keep bodies away from, each once though several bodies touch it.
pub fn obstacles_of<'a>(forces: impl Iterator<Item = &'a Box<dyn Force>>) -> Vec<Obstacle> {
    let mut obstacles: Vec<Obstacle> = Vec::new();
    for obstacle in forces.filter_map(|force| force.obstacle()) {
        if !obstacles.iter().any(|known| known.name == obstacle.name) {
            obstacles.push(obstacle);
        }
    }
    obstacles
}

/// Where the scene of a run may be: as its report names it, seen from here, or from a folder that the run's is in; runs lie below the
/// place that they were started in.
fn scenes_of(folder: &Path, name: &str) -> Vec<PathBuf> {
    let folder = folder.canonicalize().unwrap_or_else(|_| folder.to_owned());
    let above: Vec<PathBuf> = folder.ancestors().map(|above| above.join(name)).collect();
    std::iter::once(PathBuf::from(name)).chain(above).filter(|path| path.exists()).collect()
}

impl Stage {
    pub fn of(scene: &Scene) -> Self {
        Self { title: scene.title.clone(), ..Self::of_model(&scene.model, &scene.bodies, scene.picture) }
    }

    /// Without a title.
    pub fn of_model(model: &Model, bodies: &[BodyInfo], view: PictureView) -> Self {
        let obstacles = obstacles_of(model.systems.iter().flat_map(|system| &system.forces));
        let stiffness = bodies.iter().filter_map(|body| stiffness(model, body)).fold(0.0, f64::max);
        let textured = bodies.iter().filter_map(|body| Some((body.name.clone(), body.texture.clone()?)));
        Self { title: String::new(), view, stiffness, obstacles, textures: textured.collect() }
    }

    /// The stage of the scene that a run's report names; the default, and why, where it cannot be had.
    pub fn of_report(folder: &Path) -> (Self, Option<String>) {
        let path = folder.join("report.json");
        let report = std::fs::read_to_string(&path).ok();
        let report: Option<serde_json::Value> = report.and_then(|text| serde_json::from_str(&text).ok());
        let Some(report) = report else {
            return (Self::default(), Some(format!("{} cannot be read", path.display())));
        };
        let title = report["title"].as_str().unwrap_or_default().to_owned();
        let bare = Self { title, ..Self::default() };
        let name = report["scene"].as_str().unwrap_or_default();
        let settings = report["settings"].as_array().map_or(&[][..], Vec::as_slice);
        let settings: Vec<String> =
            settings.iter().filter_map(|setting| Some(setting.as_str()?.to_owned())).collect();
        let mut why = "cannot be read";
        for path in scenes_of(folder, name) {
            match souple_scene::read_file(&path, &settings) {
                Ok(scene) if report["scene_sha256"] == scene.scene_sha256.as_str() => {
                    return (Self::of(&scene), None);
                }
                Ok(_) => why = "is not as it was run",
                Err(_) => {}
            }
        }
        (bare, Some(format!("the scene `{name}` {why}: shapes are not drawn")))
    }

    /// The texture of what has a name among the parts of a moment: of a body, or of the one that wears it.
    pub(super) fn texture(&self, part: &str) -> Option<&Arc<Texture>> {
        let is_of = |body: &str| part == body || part == crate::frames::worn_by(body);
        self.textures.iter().find(|(body, _)| is_of(body)).map(|(_, texture)| texture)
    }

    /// The plane that is most level, if any is.
    pub(super) fn ground(&self, time: f64) -> Option<Ground> {
        let planes = self.planes(time).filter(|(_, normal)| normal.dot(self.view.up) > LEVEL);
        let best = planes.max_by(|a, b| a.1.dot(self.view.up).total_cmp(&b.1.dot(self.view.up)));
        best.map(|(point, normal)| Ground { point, normal })
    }

    fn planes(&self, time: f64) -> impl Iterator<Item = (Vec3, Vec3)> + '_ {
        self.obstacles.iter().filter_map(move |obstacle| match obstacle.form {
            Form::Plane { point, normal } => {
                Some((obstacle.place(point, time), obstacle.direction(point, normal, time)))
            }
            Form::Surface { .. } => None,
        })
    }

    /// Everything but the ground: bounded shapes, and of other planes the part around the bodies.
    pub(super) fn surfaces(&self, time: f64, bodies: BoundingBox) -> Vec<Surface> {
        let ground = self.ground(time);
        let walls = self
            .planes(time)
            .filter(|(point, normal)| Some(Ground { point: *point, normal: *normal }) != ground);
        let walls = walls.map(|(point, normal)| wall(point, normal, bodies));
        let bounded = self.obstacles.iter().filter_map(|obstacle| match &obstacle.form {
            Form::Plane { .. } => None,
            Form::Surface { triangles, bodies, .. } => Some(Surface {
                points: points_of(obstacle, time),
                triangles: triangles.clone(),
                paint: hard(),
                edge_style: EdgeStyle::Hidden,
                faces: if *bodies == Side::Inside { Faces::Front } else { Faces::Both },
                // a tool does not hide what it touches
                see_through: true,
                ..Surface::default()
            }),
        });
        walls.chain(bounded).collect()
    }

    /// Points of the bounded shapes that are not much larger than the bodies.
    pub(super) fn points_near(&self, time: f64, bodies: BoundingBox) -> Vec<Vec3> {
        let shapes = self.obstacles.iter().map(|obstacle| points_of(obstacle, time));
        let is_near = |points: &Vec<Vec3>| {
            BoundingBox::of(points.iter().copied()).diagonal() < MUCH_LARGER * bodies.diagonal()
        };
        shapes.filter(|points| !points.is_empty()).filter(is_near).flatten().collect()
    }
}

/// Strains by which the stiffness of a body is felt: all stretches, so that cables are taut, and not alike, so that
/// there is shear.
const FEELERS: [f64; 3] = [1e-3, 2e-3, 4e-3];
/// Cells of a body at which its stiffness is felt.
const FELT_CELLS: usize = 8;

/// Stress for each unit of strain of a body, to an order of magnitude [Pa]; `None` where its force tells no stress.
fn stiffness(model: &Model, body: &BodyInfo) -> Option<f64> {
    let solid = solid_of(model, body)?;
    let mut positions = vec![Vec3::ZERO; body.rows.end];
    let stretched =
        |rest: &Vec3| *rest + Vec3::new(FEELERS[0] * rest.x, FEELERS[1] * rest.y, FEELERS[2] * rest.z);
    for (position, rest) in positions[body.rows.clone()].iter_mut().zip(&body.mesh.points) {
        *position = stretched(rest);
    }
    if let Some(frames) = &body.frames {
        // axes are stretched with the origins: all points are then, whatever the weights
        let rows = frames.rows.iter().flat_map(|origin| *origin as usize..*origin as usize + ROWS_OF_FRAME);
        rows.zip(&frames.rest).for_each(|(row, rest)| positions[row] = stretched(rest));
    }
    let count = body.mesh.cell_count();
    let felt = (0..count).step_by(count.div_ceil(FELT_CELLS).max(1));
    let stresses = felt.filter_map(|cell| Some(solid.cell_field(cell, &positions)?.von_mises));
    stresses.filter(|stress| stress.is_finite()).map(|stress| stress / FEELERS[0]).reduce(f64::max)
}

/// Cosine of 45 degrees: steeper planes are walls.
const LEVEL: f64 = 0.7;
const MUCH_LARGER: f64 = 4.0;

/// The colour of what does not deform.
fn hard() -> Paint {
    Paint::Plain(Colour::from_screen([150, 158, 170]))
}

/// Where the points of a bounded shape are at a time; a plane has none.
fn points_of(obstacle: &Obstacle, time: f64) -> Vec<Vec3> {
    match &obstacle.form {
        Form::Plane { .. } => Vec::new(),
        Form::Surface { points, .. } => points.iter().map(|point| obstacle.place(*point, time)).collect(),
    }
}

/// A square of a plane, beside the middle of the bodies.
fn wall(point: Vec3, normal: Vec3, bodies: BoundingBox) -> Surface {
    let centre = bodies.centre();
    let centre = centre - normal * normal.dot(centre - point);
    let first = normal.any_orthogonal();
    let half = 0.6 * bodies.diagonal();
    let corner = |a: f64, b: f64| centre + (first * a + normal.cross(first) * b) * half;
    Surface {
        points: vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        // pale: a wall is scenery, and letters may stand before it
        paint: Paint::Plain(Colour::from_screen([226, 229, 235])),
        faces: Faces::Front,
        ..Surface::default()
    }
}

#[cfg(test)]
mod tests {
    use souple_scene::read_text;

    use super::*;

    fn shipped(name: &str, setting: &str) -> Scene {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes").join(name);
        let text = std::fs::read_to_string(folder.join("scene.toml")).expect("the scene");
        read_text(name, &text, &folder, &[setting.to_owned()]).unwrap_or_else(|errors| panic!("{errors}"))
    }

    /// Under one stretch a body of affine frames has the stress of the body of its mesh, to the last digits.
    #[test]
    fn frames_are_as_stiff_as_their_matter() {
        let stiffness = |scene: Scene| Stage::of(&scene).stiffness;
        let frames = stiffness(shipped("frames_cantilever", "title=\"frames\""));
        let points = stiffness(shipped("cantilever", "bodies.bar.material.name=\"st_venant_kirchhoff\""));
        assert!((frames / points - 1.0).abs() < 1e-9, "{frames} {points}");
    }

    /// Two shapes of one form are two; one that two bodies touch is one.
    #[test]
    fn shapes_are_told_apart_by_name() {
        let body = |name: &str, x: f64| {
            let mesh =
                "mesh = { generate = \"box\", size = [1, 1, 1], cells = [1, 1, 1], element = \"hex8\" }";
            let material =
                "material = { name = \"linear\", youngs_modulus = 1e4, poissons_ratio = 0, density = 1 }";
            format!("[bodies.{name}]\n{mesh}\n{material}\ntranslate = [{x}, 0, 0]\n")
        };
        let shape = |name: &str, motion: &str| {
            format!(
                "[shapes.{name}]\nshape = {{ name = \"sphere\", centre = [0, 9, 0], radius = 1 }}\n{motion}\n"
            )
        };
        let touch = |body: &str, shape: &str| {
            format!("[[contacts]]\nname = \"{body}_{shape}\"\nbody = \"{body}\"\nshape = \"{shape}\"\n")
        };
        let text = format!(
            "format = 1\n[world]\nperiod = 1\n{}{}{}{}{}{}{}",
            body("a", 0.0),
            body("b", 5.0),
            shape("still", ""),
            shape("moving", "motion = { formula = [\"t\", \"0\", \"0\"] }"),
            touch("a", "still"),
            touch("b", "still"),
            touch("a", "moving"),
        );
        let scene =
            read_text("spheres", &text, Path::new("."), &[]).unwrap_or_else(|errors| panic!("{errors}"));
        let names: Vec<String> =
            Stage::of(&scene).obstacles.into_iter().map(|obstacle| obstacle.name).collect();
        assert_eq!(names, ["still", "moving"]);
    }
}
