//! Potentials of solids: shapes known by name, closed surfaces from files, surfaces of bodies.
//!
//! `G = ½ − d/(2 width)` between 0 and 1, with the signed distance `d`, negative inside: no skin runs faster to a far
//! target than to a near one.

use souple_math::Vec3;
use souple_mesh::implicit::{self, JoinedSolids, Shape, Sign, SurfaceShape};
use souple_mesh::repair::{RepairLimits, repair};
use souple_mesh::{BoundingBox, MeshError, TriangleSurface};
use souple_table::{Entry, Parameter, Range, Value, Values, in_number};

use super::{Between, Followed, ISO, Moment, PartEntry, PartError, PartScratch, Potential, UNKNOWN};

const WIDTH: Parameter = Parameter::number(
    "width",
    "m",
    Range::NOT_NEGATIVE,
    "distance over which the potential goes from one half to 1 and to 0; 0: a tenth of the diagonal",
)
.or(Value::Number(0.0));

fn potential(distance: f64, width: f64) -> f64 {
    ISO + (-0.5 * distance / width).clamp(-0.5, 0.5)
}

/// Distance to a solid beyond which its potential is nowhere above `level`.
fn reach(level: f64, width: f64) -> f64 {
    width * (1.0 - level / ISO).max(0.0)
}

/// Of distances between two.
fn between([near, far]: [f64; 2], width: f64) -> Between {
    [potential(far, width), potential(near, width)]
}

/// The width asked for, or a tenth of a diagonal.
fn width(values: &Values, bounds: BoundingBox) -> f64 {
    let asked = values.number("width");
    if asked > 0.0 { asked } else { 0.1 * bounds.diagonal() }
}

struct Solid {
    shape: Box<dyn Shape + Send + Sync>,
    width: f64,
}

impl Potential for Solid {
    fn value(&self, point: Vec3, _: &PartScratch) -> f64 {
        potential(self.shape.value(point), self.width)
    }

    fn range(&self, within: BoundingBox, _: &PartScratch) -> Between {
        self.shape.range(within).map_or(UNKNOWN, |distances| between(distances, self.width))
    }

    fn bounds(&self, level: f64, _: &PartScratch) -> Option<BoundingBox> {
        (level > 0.0).then(|| self.shape.bounds().grown(reach(level, self.width)))
    }
}

pub(super) static SHAPE: PartEntry = Entry {
    name: "shape",
    summary: "a body shape by its name, such as torus, ellipsoid, bunny, liver, as it is by default or scaled",
    source: "own",
    parameters: &[
        Parameter::text("shape", "its name, see `souple list bodies`"),
        Parameter::number("scale", "", Range::POSITIVE, "times its size by default").or(Value::Number(1.0)),
        WIDTH,
    ],
    build: |values, _| {
        let name = values.text("shape");
        let body = implicit::body(name, Values::new()).map_err(|error| PartError {
            parameter: "shape",
            value: format!("\"{name}\""),
            expected: format!("the name of a shape: {error}"),
        })?;
        let scaled = Scaled { shape: body.shape, scale: values.number("scale") };
        let width = width(values, scaled.bounds());
        Ok(Box::new(Solid { shape: Box::new(scaled), width }))
    },
};

struct Scaled {
    shape: Box<dyn Shape>,
    scale: f64,
}

impl Shape for Scaled {
    fn value(&self, point: Vec3) -> f64 {
        self.shape.value(point * self.scale.recip()) * self.scale
    }

    fn range(&self, within: BoundingBox) -> Option<[f64; 2]> {
        let factor = self.scale.recip();
        let range = self.shape.range(BoundingBox { low: within.low * factor, high: within.high * factor });
        range.map(|range| range.map(|value| value * self.scale))
    }

    fn bounds(&self) -> BoundingBox {
        let bounds = self.shape.bounds();
        BoundingBox { low: bounds.low * self.scale, high: bounds.high * self.scale }
    }
}

/// What a surface encloses at least, in the cube of its diagonal: less is rounding of what is flat.
const NOTHING: f64 = 1e-9;

pub(super) static MESH: PartEntry = Entry {
    name: "mesh",
    summary: "what the triangles of a file enclose: parts that overlap by more than a voxel are joined, holes are closed, with a warning; what crosses itself is known by winding numbers",
    source: "Baerentzen & Aanaes 2005, Signed distance computation using the angle weighted pseudonormal",
    parameters: &[
        Parameter::text("file", "a surface, relative to the scene file that names it"),
        Parameter::number("scale", "", Range::POSITIVE, "metres in one unit of the file")
            .or(Value::Number(1.0)),
        WIDTH,
    ],
    build: |values, around| {
        let file = values.text("file");
        let refuse = |message: String| PartError {
            parameter: "file",
            value: format!("\"{file}\""),
            expected: format!("a file of triangles that enclose something: {message}"),
        };
        let mut surface = around.surface(file).map_err(refuse)?;
        let scale = values.number("scale");
        surface.points.iter_mut().for_each(|point| *point = *point * scale);
        let (surface, warning) = closed(surface);
        let (volume, diagonal) = (surface.enclosed_volume().abs(), surface.bounds().diagonal());
        if volume <= NOTHING * diagonal.powi(3) {
            return Err(refuse(format!("this surface encloses {volume} m³")));
        }
        if let Some(warning) = warning {
            around.warn(format!("`{file}` {warning}"));
        }
        let shape = solid(surface).map_err(|error| refuse(error.to_string()))?;
        let width = width(values, shape.bounds());
        Ok(Box::new(Solid { shape, width }))
    },
};

/// A surface with its holes closed, however large they are, and its triangles facing as their neighbours do, and what there is to
/// say of that. Across an open hole the sign of a distance changes where the distance does not vanish: a skin would find no rest
/// there.
fn closed(surface: TriangleSurface) -> (TriangleSurface, Option<String>) {
    let open_edges =
        |surface: &TriangleSurface| surface.edge_uses().iter().filter(|(_, up, down)| up + down == 1).count();
    let is_sound = |(_, up, down): &([u32; 2], u32, u32)| up + down != 1 && (up + down != 2 || up == down);
    if surface.edge_uses().iter().all(is_sound) {
        return (surface, None);
    }
    let (mended, repairs) = repair(&surface, RepairLimits { hole: f64::INFINITY, ..RepairLimits::default() });
    let closed = in_number(repairs.closed_holes, "hole was closed", "holes were closed");
    let turned = (repairs.turned_triangles > 0).then(|| {
        let turned = in_number(repairs.turned_triangles, "triangle was turned", "triangles were turned");
        format!("faces both ways: {turned} to agree with those beside")
    });
    let opened = match (open_edges(&mended), repairs.closed_holes) {
        // points at one place were several
        (0, 0) => None,
        (0, _) => Some(format!("is open: {closed} by triangles within their rims")),
        (open, _) => {
            let edges = in_number(open, "edge has", "edges have");
            Some(format!("is open: {closed}, {edges} one triangle still, and a skin finds no rest there"))
        }
    };
    let told: Vec<String> = turned.into_iter().chain(opened).collect();
    (mended, (!told.is_empty()).then(|| told.join("; it ")))
}

/// What triangles enclose: closed parts that overlap are joined, others are known by winding numbers.
fn solid(surface: TriangleSurface) -> Result<Box<dyn Shape>, MeshError> {
    let shape = SurfaceShape::new(surface.clone())?;
    if shape.sign() == Sign::WindingNumber
        && let Ok(joined) = JoinedSolids::new(&surface)
        && joined.separates(&surface)
    {
        return Ok(Box::new(joined));
    }
    Ok(Box::new(shape))
}

/// The inside of a closed surface whose points follow rows.
pub struct SurfacePart {
    surface: TriangleSurface,
    system: usize,
    /// For each point of the surface.
    rows: Vec<u32>,
    /// Outward by this [m].
    offset: f64,
    width: f64,
}

impl SurfacePart {
    /// # Errors
    /// The surface is not closed, or a part of it that faces inward crosses another; says why.
    pub fn new(
        surface: TriangleSurface,
        system: usize,
        rows: Vec<u32>,
        offset: f64,
        width: f64,
    ) -> Result<Self, String> {
        let width = if width > 0.0 { width } else { 0.1 * surface.bounds().diagonal() };
        JoinedSolids::new(&surface).map_err(|error| error.to_string())?;
        Ok(Self { surface, system, rows, offset, width })
    }
}

struct Moved {
    distance: Option<JoinedSolids>,
    positions: Vec<Vec3>,
}

impl Potential for SurfacePart {
    fn new_scratch(&self) -> PartScratch {
        let distance = JoinedSolids::new(&self.surface).ok();
        Box::new(Moved { distance, positions: self.surface.points.clone() })
    }

    fn place(&self, at: &Moment, scratch: &mut PartScratch) -> Result<(), String> {
        let Some(moved) = scratch.downcast_mut::<Moved>() else { return Ok(()) };
        let positions = at.rows.positions(self.system);
        for (place, row) in moved.positions.iter_mut().zip(&self.rows) {
            *place = positions[*row as usize];
        }
        if let Some(distance) = &mut moved.distance {
            distance.move_points(&moved.positions);
        }
        Ok(())
    }

    fn value(&self, point: Vec3, scratch: &PartScratch) -> f64 {
        let distance = scratch.downcast_ref::<Moved>().and_then(|moved| moved.distance.as_ref());
        distance.map_or(f64::NAN, |distance| potential(distance.distance(point) - self.offset, self.width))
    }

    fn range(&self, within: BoundingBox, scratch: &PartScratch) -> Between {
        let distance = scratch.downcast_ref::<Moved>().and_then(|moved| moved.distance.as_ref());
        let Some(distance) = distance else { return UNKNOWN };
        let (middle, reach) = (distance.distance(within.centre()) - self.offset, 0.5 * within.diagonal());
        if middle.is_nan() { UNKNOWN } else { between([middle - reach, middle + reach], self.width) }
    }

    fn bounds(&self, level: f64, scratch: &PartScratch) -> Option<BoundingBox> {
        let moved = scratch.downcast_ref::<Moved>().filter(|_| level > 0.0)?;
        let around = (self.offset + reach(level, self.width)).max(0.0);
        Some(BoundingBox::of(moved.positions.iter().copied()).grown(around))
    }

    fn followed(&self) -> Vec<Followed> {
        // each point stands for its part of the area
        let area: f64 =
            (0..self.surface.triangles.len() as u32).map(|t| self.surface.area_vector(t).length()).sum();
        let radius = 0.5 * (area / self.rows.len() as f64).sqrt();
        self.rows.iter().map(|row| Followed { system: self.system, row: *row, radius }).collect()
    }
}

pub(super) static SURFACE: PartEntry = Entry {
    name: "surface",
    summary: "the inside of the surface of a body of the scene, as it moves; parts of it that overlap by more than a voxel are joined",
    source: "Baerentzen & Aanaes 2005, Signed distance computation using the angle weighted pseudonormal",
    parameters: &[
        Parameter::text("body", "its name"),
        Parameter::number("offset", "m", Range::ANY, "outward by this").or(Value::Number(0.0)),
        WIDTH,
    ],
    build: |values, around| {
        let body = values.text("body");
        let refuse = |message: String| PartError {
            parameter: "body",
            value: format!("\"{body}\""),
            expected: format!("a body with a closed surface: {message}"),
        };
        let (surface, system, rows) = around.body_surface(body).map_err(refuse)?;
        let part = SurfacePart::new(surface, system, rows, values.number("offset"), values.number("width"));
        Ok(Box::new(part.map_err(refuse)?))
    },
};

#[cfg(test)]
mod tests {
    use souple_math::Vec3;

    use super::*;

    /// A closed surface of which some triangles are turned over encloses what it should, and that is told; of a sound one
    /// nothing is.
    #[test]
    fn triangles_that_face_otherwise_are_turned() {
        let corner = |i: u32| Vec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2));
        let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let triangles: Vec<[u32; 3]> =
            quads.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
        let sound = TriangleSurface::new((0..8).map(corner).collect(), triangles).unwrap();
        assert_eq!(closed(sound.clone()).1, None);
        let mut mixed = sound;
        mixed.triangles.iter_mut().step_by(2).for_each(|corners| corners.swap(1, 2));
        let (mended, told) = closed(mixed);
        assert!((mended.enclosed_volume() - 1.0).abs() < 1e-14);
        assert_eq!(told.unwrap(), "faces both ways: 6 triangles were turned to agree with those beside");
    }
}
