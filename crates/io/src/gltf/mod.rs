//! glTF 2.0, binary (`.glb`): surfaces for the web, Blender and three.js; write only.
//!
//! A moving surface is one mesh with a morph target for each frame after the first, displacements of positions and of
//! normals, and an animation of the weights that lets exactly one frame show at its time and blends between. All
//! programs that play morph targets play it; numbers are of 4 bytes. A surface that is there for a part of the time has the
//! size zero before and after: a surface whose triangles change is several, one after the other.

mod buffer;

use std::io::Write;
use std::ops::Range;
use std::path::Path;

use serde_json::{Value, json};
use souple_math::Vec3;
use souple_mesh::vertex_normals;
use souple_table::Entry;

use crate::dataset::Output;
use crate::facets::SurfacePart;
use crate::format::{Format, WriteError};
use crate::holds::{Digits, Holds};
use crate::picture::Colour;
use crate::{IoError, write_file};
use buffer::{Buffer, Target};

pub(crate) static GLTF: Entry<Format> = Entry {
    name: "gltf",
    summary: "glTF 2.0 binary surface for the web, Blender and three.js; write only",
    source: "Khronos Group, glTF 2.0 Specification, 2021",
    parameters: &[],
    build: Format {
        extensions: &["glb"],
        family: &[],
        parts: &[],
        recognises: |bytes| bytes.starts_with(MAGIC),
        read: None,
        write: Some(write_mesh),
        holds: Holds { digits: Digits::Single, ..Holds::BARE },
    },
};

const MAGIC: &[u8; 4] = b"glTF";

/// A surface that moves, or stands where it has one frame.
#[derive(Clone, Debug, PartialEq)]
pub struct MovingSurface {
    pub name: String,
    /// Corners, counterclockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// Which of the times it is there at.
    pub during: Range<usize>,
    /// Positions [m] of all points at each of these, or once for all.
    pub frames: Vec<Vec<Vec3>>,
    pub colour: Colour,
    /// A colour for each point, in place of one for all; or none.
    pub point_colours: Vec<Colour>,
}

/// Surfaces over common times.
#[derive(Clone, Debug, PartialEq)]
pub struct Animation {
    pub surfaces: Vec<MovingSurface>,
    /// Time of each frame [s], increasing.
    pub times: Vec<f64>,
    /// What is up in the positions; glTF has `y` up, and the scene is turned so.
    pub up: Vec3,
}

/// Most frames of a file: the weights alone are frames times frames.
const MOST_FRAMES: usize = 4096;

impl Animation {
    /// The file as bytes.
    ///
    /// # Errors
    /// Frames of different lengths, times that do not increase, corners that do not exist, numbers that are not
    /// finite, more frames than can be played.
    pub fn to_glb(&self) -> Result<Vec<u8>, IoError> {
        self.check()?;
        let mut buffer = Buffer::default();
        let (mut meshes, mut nodes, mut materials) = (Vec::new(), Vec::new(), Vec::new());
        let seconds = self.times_from_start();
        let mut motions = Motions::default();
        for (index, surface) in self.surfaces.iter().enumerate() {
            materials.push(material(surface));
            meshes.push(mesh(surface, index, &mut buffer));
            let mut node = json!({"name": surface.name, "mesh": index});
            if surface.during.start > 0 {
                // for programs that do not play
                node["scale"] = json!([0.0, 0.0, 0.0]);
            }
            nodes.push(node);
            motions.add_blending(index, surface, &seconds, &mut buffer);
            motions.add_presence(index, &surface.during, &seconds, &mut buffer);
        }
        let children: Vec<usize> = (0..nodes.len()).collect();
        let root = nodes.len();
        nodes.push(json!({"name": "souple", "children": children, "rotation": rotation_to_y(self.up)}));
        let mut document = json!({
            "asset": {"version": "2.0", "generator": "Souple"},
            "scene": 0,
            "scenes": [{"nodes": [root]}],
            "nodes": nodes,
            "meshes": meshes,
            "materials": materials,
            "accessors": buffer.accessors,
            "bufferViews": buffer.views,
            "buffers": [{"byteLength": buffer.bytes.len()}],
        });
        if !motions.channels.is_empty() {
            let Motions { channels, samplers, .. } = motions;
            document["animations"] = json!([{"name": "run", "channels": channels, "samplers": samplers}]);
        }
        container(&document, &buffer.bytes)
    }

    /// Times as the file has them: numbers of 4 bytes, from the first on [s].
    fn times_from_start(&self) -> Vec<f32> {
        self.times.iter().map(|time| (time - self.times[0]) as f32).collect()
    }

    /// Bytes of the numbers of the file, known before they are made.
    fn number_bytes(&self) -> u64 {
        let of_surface = |surface: &MovingSurface| {
            let [frames, points, triangles, coloured] = [
                surface.frames.len(),
                surface.frames[0].len(),
                surface.triangles.len(),
                surface.point_colours.len(),
            ]
            .map(|count| count as u64);
            // positions and normals; a weight of each target at each time
            12 * (2 * frames * points + triangles + coloured) + 4 * frames * (frames - 1)
        };
        let count = self.times.len();
        let mut ranges: Vec<&Range<usize>> = Vec::new();
        for surface in self.surfaces.iter().filter(|surface| surface.frames.len() > 1) {
            if !ranges.contains(&&surface.during) {
                ranges.push(&surface.during);
            }
        }
        let in_part = self.surfaces.iter().filter(|surface| surface.during != (0..count));
        let keys = in_part.map(|surface| turns(&surface.during, count).len() as u64).sum::<u64>();
        let times = ranges.into_iter().map(|range| range.len() as u64).sum::<u64>();
        // a time and three scales of each key
        4 * times + 16 * keys + self.surfaces.iter().map(of_surface).sum::<u64>()
    }

    /// Writes the file.
    ///
    /// # Errors
    /// Those of [`Animation::to_glb`]; the file cannot be written.
    pub fn write_glb(&self, path: &Path) -> Result<(), IoError> {
        let bytes = self.to_glb()?;
        write_file(path, |out| out.write_all(&bytes))
    }

    fn check(&self) -> Result<(), IoError> {
        let refuse = |subject: String, value: String, expected: String| {
            Err(IoError::Request { subject, value, expected })
        };
        if !(1..=MOST_FRAMES).contains(&self.times.len()) {
            let found = self.times.len().to_string();
            return refuse("the number of frames".to_owned(), found, format!("1 to {MOST_FRAMES}"));
        }
        if let Some(pair) = self.times.windows(2).find(|pair| !(pair[0] < pair[1] && pair[1].is_finite())) {
            return refuse(
                "the time of a frame".to_owned(),
                format!("{:?}", pair[1]),
                format!("more than {:?}", pair[0]),
            );
        }
        // glTF wants them to increase as it has them
        let times = self.times_from_start();
        if let Some(frame) = (1..times.len()).find(|frame| times[*frame] <= times[frame - 1]) {
            return refuse(
                "the time of a frame".to_owned(),
                format!("{:?} s, {:?} s from the start", self.times[frame], times[frame]),
                "times that are apart also as numbers of 4 bytes".to_owned(),
            );
        }
        if self.surfaces.is_empty() {
            return refuse("the number of surfaces".to_owned(), "0".to_owned(), "1 or more".to_owned());
        }
        for (index, surface) in self.surfaces.iter().enumerate() {
            let of = |what: &str| format!("{what} of surfaces[{index}]");
            let frames = surface.frames.len();
            let Range { start, end } = surface.during;
            if start >= end || end > self.times.len() {
                let expected = format!("a part of 0..{}", self.times.len());
                return refuse(of("the range of times"), format!("{start}..{end}"), expected);
            }
            if frames != 1 && frames != end - start {
                let expected = format!("1, or {}, one for each time", end - start);
                return refuse(of("the number of frames"), frames.to_string(), expected);
            }
            let count = surface.frames[0].len();
            if let Some(frame) = surface.frames.iter().find(|frame| frame.len() != count) {
                let expected = format!("{count}, as of the first frame");
                return refuse(of("the number of points of a frame"), frame.len().to_string(), expected);
            }
            if surface.triangles.is_empty() {
                return refuse(of("the number of triangles"), "0".to_owned(), "1 or more".to_owned());
            }
            if let Some(corner) = surface.triangles.iter().flatten().find(|corner| **corner as usize >= count)
            {
                return refuse(of("a corner"), corner.to_string(), format!("a number below {count}"));
            }
            if !surface.point_colours.is_empty() && surface.point_colours.len() != count {
                let found = surface.point_colours.len().to_string();
                return refuse(of("the number of colours"), found, format!("{count}, one for each point"));
            }
            let fits = |x: &Vec3| x.to_array().iter().all(|c| c.abs() <= f64::from(f32::MAX));
            if let Some(position) = surface.frames.iter().flatten().find(|position| !fits(position)) {
                let found = format!("{:?}", position.to_array());
                return refuse(of("a position"), found, "finite numbers of 4 bytes".to_owned());
            }
        }
        length(self.number_bytes()).map(drop)
    }
}

/// What moves in a file, channel by channel.
#[derive(Default)]
struct Motions {
    channels: Vec<Value>,
    samplers: Vec<Value>,
    /// Accessor of the times of a range, shared by all surfaces that have it.
    inputs: Vec<(Range<usize>, usize)>,
}

impl Motions {
    fn add(&mut self, node: usize, path: &str, input: usize, output: usize, interpolation: &str) {
        self.channels.push(json!({"sampler": self.samplers.len(), "target": {"node": node, "path": path}}));
        self.samplers.push(json!({"input": input, "output": output, "interpolation": interpolation}));
    }

    /// Lets each frame show at its time, and blends between.
    fn add_blending(&mut self, node: usize, surface: &MovingSurface, times: &[f32], buffer: &mut Buffer) {
        let frames = surface.frames.len();
        if frames < 2 {
            return;
        }
        let targets = frames - 1;
        let mut weights = vec![0.0; frames * targets];
        for frame in 1..frames {
            weights[frame * targets + frame - 1] = 1.0;
        }
        let known = self.inputs.iter().find(|(range, _)| *range == surface.during).map(|(_, input)| *input);
        let input = known.unwrap_or_else(|| {
            let input = buffer.scalars(&times[surface.during.clone()], Target::None);
            self.inputs.push((surface.during.clone(), input));
            input
        });
        let output = buffer.scalars(&weights, Target::None);
        self.add(node, "weights", input, output, "LINEAR");
    }

    /// Lets a surface be there for its part of the time.
    fn add_presence(&mut self, node: usize, during: &Range<usize>, times: &[f32], buffer: &mut Buffer) {
        if *during == (0..times.len()) {
            return;
        }
        let there = |at: usize| if during.contains(&at) { 1.0 } else { 0.0 };
        let keys = turns(during, times.len());
        let seconds: Vec<f32> = keys.iter().map(|at| times[*at]).collect();
        let input = buffer.scalars(&seconds, Target::None);
        let output =
            buffer.vectors(keys.iter().map(|at| Vec3::new(1.0, 1.0, 1.0) * there(*at)), Target::None);
        self.add(node, "scale", input, output, "STEP");
    }
}

/// When it is said whether a surface is there: at the first time, and where it comes and goes.
fn turns(during: &Range<usize>, count: usize) -> Vec<usize> {
    let mut keys = vec![0, during.start, during.end];
    keys.retain(|at| *at < count);
    keys.dedup();
    keys
}

fn mesh(surface: &MovingSurface, material: usize, buffer: &mut Buffer) -> Value {
    let rest = &surface.frames[0];
    let rest_normals = unit_normals(rest, &surface.triangles);
    let indices = buffer.indices(surface.triangles.as_flattened());
    let mut attributes = json!({
        "POSITION": buffer.vectors(rest.iter().copied(), Target::Vertices),
        "NORMAL": buffer.vectors(rest_normals.iter().copied(), Target::Vertices),
    });
    if !surface.point_colours.is_empty() {
        attributes["COLOR_0"] = json!(buffer.colours(&surface.point_colours));
    }
    let mut primitive =
        json!({"attributes": attributes, "indices": indices, "material": material, "mode": 4});
    let mut mesh = json!({"name": surface.name});
    if surface.frames.len() > 1 {
        let mut targets = Vec::new();
        for frame in &surface.frames[1..] {
            let normals = unit_normals(frame, &surface.triangles);
            let difference = |(now, then): (&Vec3, &Vec3)| *now - *then;
            targets.push(json!({
                "POSITION": buffer.vectors(frame.iter().zip(rest).map(difference), Target::Vertices),
                "NORMAL": buffer.vectors(normals.iter().zip(&rest_normals).map(difference), Target::Vertices),
            }));
        }
        mesh["weights"] = json!(vec![0.0; targets.len()]);
        let names: Vec<String> = (1..=targets.len()).map(|frame| format!("frame {frame}")).collect();
        mesh["extras"] = json!({"targetNames": names});
        primitive["targets"] = json!(targets);
    }
    mesh["primitives"] = json!([primitive]);
    mesh
}

/// Points of no triangle have no normal; any unit vector will do.
fn unit_normals(positions: &[Vec3], triangles: &[[u32; 3]]) -> Vec<Vec3> {
    let normals = vertex_normals(positions, triangles).into_iter();
    normals.map(|normal| normal.try_normalised().unwrap_or(Vec3::Y)).collect()
}

fn material(surface: &MovingSurface) -> Value {
    let [r, g, b] = if surface.point_colours.is_empty() { surface.colour.0 } else { Colour::WHITE.0 };
    json!({
        "name": surface.name,
        "doubleSided": true,
        "pbrMetallicRoughness": {"baseColorFactor": [r, g, b, 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.6},
    })
}

/// Quaternion `[x, y, z, w]` of the shortest turn that takes `up` to `y`.
fn rotation_to_y(up: Vec3) -> [f64; 4] {
    let Some(up) = up.try_normalised() else { return [0.0, 0.0, 0.0, 1.0] };
    let axis = up.cross(Vec3::Y);
    let w = 1.0 + up.y;
    // straight down: half a turn about x
    if w < 1e-9 {
        return [1.0, 0.0, 0.0, 0.0];
    }
    let length = (axis.length_sq() + w * w).sqrt();
    [axis.x / length, axis.y / length, axis.z / length, w / length]
}

/// A length as glTF writes it.
fn length(bytes: u64) -> Result<u32, IoError> {
    u32::try_from(bytes).map_err(|_| {
        let expected = "less than 2^32, the most that a .glb file holds: fewer frames, or smaller surfaces";
        IoError::request("the number of bytes of the .glb file", bytes, expected)
    })
}

/// Head, document and numbers as one file; lengths are multiples of four.
fn container(document: &Value, numbers: &[u8]) -> Result<Vec<u8>, IoError> {
    let mut text = document.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let padded = numbers.len().next_multiple_of(4);
    let total = 12 + 8 + text.len() + 8 + padded;
    // the parts are shorter than the whole
    let whole = length(total as u64)?;
    let mut bytes = Vec::with_capacity(total);
    let word = |bytes: &mut Vec<u8>, number: u32| bytes.extend(number.to_le_bytes());
    bytes.extend(MAGIC);
    word(&mut bytes, 2);
    word(&mut bytes, whole);
    word(&mut bytes, text.len() as u32);
    bytes.extend(b"JSON");
    bytes.extend(text);
    word(&mut bytes, padded as u32);
    bytes.extend(b"BIN\0");
    bytes.extend(numbers);
    bytes.resize(total, 0);
    Ok(bytes)
}

fn write_mesh(output: &Output<'_>, out: &mut dyn Write) -> Result<(), WriteError> {
    let part = SurfacePart::of(output);
    let surface = MovingSurface {
        name: "surface".to_owned(),
        triangles: part.triangles().collect(),
        during: 0..1,
        frames: vec![part.positions],
        colour: Colour::tissue(),
        point_colours: Vec::new(),
    };
    let animation = Animation { surfaces: vec![surface], times: vec![0.0], up: Vec3::Y };
    Ok(out.write_all(&animation.to_glb()?)?)
}

#[cfg(test)]
mod tests;
