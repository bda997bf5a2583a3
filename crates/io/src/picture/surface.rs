//! What a picture shows: surfaces with their paint, and strokes.

use std::sync::Arc;

use souple_math::Vec3;

use super::balls::Ball;
use super::colour::Colour;
use super::colour_scale::ColourScale;
use super::texture::Texture;
use crate::IoError;

/// Triangles with their paint.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Surface {
    /// Positions [m].
    pub points: Vec<Vec3>,
    /// Corners, counterclockwise seen from outside; the inside is shown too, a little darker.
    pub triangles: Vec<[u32; 3]>,
    /// For each triangle whether its edges 01, 12, 20 are edges of the mesh, and drawn where edges are; empty:
    /// all are.
    pub edges: Vec<[bool; 3]>,
    /// Spheres beside the triangles.
    pub balls: Vec<Ball>,
    pub paint: Paint,
    /// Thickness of the blood on the points [m], which is seen over the paint and shines; empty: none.
    pub film: Vec<f64>,
    /// In the place of a plain colour, and of the colour of tissue that nothing was done to; of a paint by other values there is none.
    pub texture: Option<Laid>,
    pub edge_style: EdgeStyle,
    pub faces: Faces,
    /// Other surfaces behind it show through; where there are none, it is solid. Such surfaces come last in a picture.
    pub see_through: bool,
}

/// A texture as it lies on a surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Laid {
    pub texture: Arc<Texture>,
    /// Where the points rest [m].
    pub places: Vec<Vec3>,
    /// Of the surface there, of any length.
    pub normals: Vec<Vec3>,
}

impl Laid {
    /// Where a point rests, and the normal there.
    pub(super) fn at(&self, point: u32) -> [Vec3; 2] {
        [self.places[point as usize], self.normals[point as usize]]
    }
}

/// Which sides of a surface are seen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Faces {
    #[default]
    Both,
    /// Triangles seen from their inside are left out: one looks into a container.
    Front,
}

/// What a surface is painted with.
#[derive(Clone, Debug, PartialEq)]
pub enum Paint {
    Plain(Colour),
    /// Values on the points, then on the balls, painted by the colour map; NaN is grey.
    PointScalar(Vec<f64>),
    /// Values on the triangles.
    TriangleScalar(Vec<f64>),
}

impl Default for Paint {
    fn default() -> Self {
        Self::Plain(Colour::tissue())
    }
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum EdgeStyle {
    #[default]
    Hidden,
    /// Thin lines on the surface.
    Drawn,
    /// Lines alone, the surface left out.
    Wireframe,
}

/// Lines, arrows and dots: pins, loads, tracks.
#[derive(Clone, Debug, PartialEq)]
pub struct Stroke {
    pub shape: StrokeShape,
    pub colour: Colour,
    /// Width, or diameter of a dot [pixels].
    pub width: f64,
    /// Share of the colour that is seen through what stands before it.
    pub through: f32,
}

impl Stroke {
    /// What is seen of strokes that belong on a surface.
    pub const FAINTLY: f32 = 0.16;
    /// Of those that belong inside one.
    pub const PLAINLY: f32 = 0.7;
}

#[derive(Clone, Debug, PartialEq)]
pub enum StrokeShape {
    Dot(Vec3),
    Line(Vec<Vec3>),
    /// From, to [m]; the head is at the latter.
    Arrow(Vec3, Vec3),
}

impl StrokeShape {
    pub(super) fn points(&self) -> Vec<Vec3> {
        match self {
            Self::Dot(point) => vec![*point],
            Self::Line(points) => points.clone(),
            Self::Arrow(from, to) => vec![*from, *to],
        }
    }

    pub(super) fn points_mut(&mut self) -> Vec<&mut Vec3> {
        match self {
            Self::Dot(point) => vec![point],
            Self::Line(points) => points.iter_mut().collect(),
            Self::Arrow(from, to) => vec![from, to],
        }
    }
}

impl Surface {
    pub(super) fn check(&self, number: usize) -> Result<(), IoError> {
        let refuse = |what: &str, value: usize, expected: String| {
            Err(IoError::request(format!("{what} of surfaces[{number}]"), value, expected))
        };
        let count = self.points.len();
        if let Some(corner) = self.triangles.iter().flatten().find(|corner| **corner as usize >= count) {
            return refuse("a corner", *corner as usize, format!("a number below {count}"));
        }
        if !self.edges.is_empty() && self.edges.len() != self.triangles.len() {
            return refuse("the number of edge marks", self.edges.len(), format!("{}", self.triangles.len()));
        }
        if !self.film.is_empty() && self.film.len() != count {
            return refuse(
                "the number of thicknesses",
                self.film.len(),
                format!("{count}, one for each point"),
            );
        }
        if let Some(Laid { places, normals, .. }) = &self.texture
            && (places.len(), normals.len()) != (count, count)
        {
            let expected = format!("{count}, one for each point");
            return refuse("the number of places at rest", places.len().min(normals.len()), expected);
        }
        match &self.paint {
            Paint::PointScalar(values) if values.len() != count + self.balls.len() => {
                let expected = format!("{}, one for each point and ball", count + self.balls.len());
                refuse("the number of values", values.len(), expected)
            }
            Paint::TriangleScalar(values) if values.len() != self.triangles.len() => {
                let expected = format!("{}, one for each triangle", self.triangles.len());
                refuse("the number of values", values.len(), expected)
            }
            _ => Ok(()),
        }
    }

    /// Values of the paint that have a place on a scale: least and greatest.
    pub(super) fn range(&self, scale: ColourScale) -> Option<(f64, f64)> {
        let values = match &self.paint {
            Paint::Plain(_) => return None,
            Paint::PointScalar(values) | Paint::TriangleScalar(values) => values,
        };
        let spanning = values.iter().copied().filter(|value| scale.spans(*value));
        spanning.fold(None, |range, value| match range {
            None => Some((value, value)),
            Some((low, high)) => Some((f64::min(low, value), f64::max(high, value))),
        })
    }

    /// Unit normals at the corners of each triangle: those of the triangles around the point that are bent from
    /// it by less than the crease, weighted by area. So a ball is round and a box keeps its edges.
    pub(super) fn corner_normals(&self) -> Vec<[Vec3; 3]> {
        let areas: Vec<Vec3> = self
            .triangles
            .iter()
            .map(|corners| {
                let [a, b, c] = corners.map(|corner| self.points[corner as usize]);
                (b - a).cross(c - a)
            })
            .collect();
        let units: Vec<Option<Vec3>> = areas.iter().map(|area| area.try_normalised()).collect();
        // triangles around each point, in one list with the start of each point
        let mut starts = vec![0u32; self.points.len() + 1];
        for corner in self.triangles.iter().flatten() {
            starts[*corner as usize + 1] += 1;
        }
        for point in 0..self.points.len() {
            starts[point + 1] += starts[point];
        }
        let mut next = starts.clone();
        let mut around = vec![0u32; 3 * self.triangles.len()];
        for (triangle, corners) in self.triangles.iter().enumerate() {
            for corner in corners {
                around[next[*corner as usize] as usize] = triangle as u32;
                next[*corner as usize] += 1;
            }
        }
        let normal_at = |triangle: usize, corner: u32| {
            let Some(own) = units[triangle] else { return Vec3::ZERO };
            let point = corner as usize;
            let mut sum = Vec3::ZERO;
            // a point of thousands of triangles (the tip of a fan) needs no more than the first few hundred
            for other in around[starts[point] as usize..starts[point + 1] as usize].iter().take(MOST_AROUND) {
                let other = *other as usize;
                if units[other].is_some_and(|unit| unit.dot(own) > CREASE) {
                    sum += areas[other];
                }
            }
            sum.try_normalised().unwrap_or(own)
        };
        let triangles = self.triangles.iter().enumerate();
        triangles.map(|(triangle, corners)| corners.map(|corner| normal_at(triangle, corner))).collect()
    }
}

/// Cosine of 40 degrees.
const CREASE: f64 = 0.766;
const MOST_AROUND: usize = 256;
