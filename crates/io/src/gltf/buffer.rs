//! The numbers of a glTF file: views of one buffer, and what each of them holds.

use serde_json::{Value, json};
use souple_math::Vec3;

use crate::picture::Colour;

/// What a view is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Target {
    None,
    Vertices,
    Indices,
}

const FLOAT: u32 = 5126;
const UNSIGNED_INT: u32 = 5125;

#[derive(Debug, Default)]
pub(super) struct Buffer {
    pub bytes: Vec<u8>,
    pub views: Vec<Value>,
    pub accessors: Vec<Value>,
}

impl Buffer {
    /// Numbers of the accessor of these values, all of 4 bytes.
    fn push(&mut self, values: impl Iterator<Item = [u8; 4]>, target: Target, mut accessor: Value) -> usize {
        let start = self.bytes.len();
        self.bytes.extend(values.flatten());
        let mut view = json!({"buffer": 0, "byteOffset": start, "byteLength": self.bytes.len() - start});
        match target {
            Target::None => {}
            Target::Vertices => view["target"] = json!(34962),
            Target::Indices => view["target"] = json!(34963),
        }
        accessor["bufferView"] = json!(self.views.len());
        self.views.push(view);
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    pub fn indices(&mut self, indices: &[u32]) -> usize {
        let accessor = json!({"componentType": UNSIGNED_INT, "count": indices.len(), "type": "SCALAR"});
        self.push(indices.iter().map(|index| index.to_le_bytes()), Target::Indices, accessor)
    }

    pub fn scalars(&mut self, values: &[f32], target: Target) -> usize {
        let range = |least: f32, value: &f32| (least.min(*value), least.max(*value));
        let low = values.iter().fold(f32::INFINITY, |low, value| range(low, value).0);
        let high = values.iter().fold(f32::NEG_INFINITY, |high, value| range(high, value).1);
        let accessor = json!({
            "componentType": FLOAT, "count": values.len(), "type": "SCALAR", "min": [low], "max": [high],
        });
        self.push(values.iter().map(|value| value.to_le_bytes()), target, accessor)
    }

    pub fn vectors(&mut self, vectors: impl Iterator<Item = Vec3>, target: Target) -> usize {
        let vectors: Vec<[f32; 3]> =
            vectors.map(|v| v.to_array().map(|component| component as f32)).collect();
        let bound = |pick: fn(f32, f32) -> f32| {
            [0, 1, 2].map(|axis| vectors.iter().map(|v| v[axis]).reduce(pick).unwrap_or(0.0))
        };
        let accessor = json!({
            "componentType": FLOAT, "count": vectors.len(), "type": "VEC3",
            "min": bound(f32::min), "max": bound(f32::max),
        });
        self.push(vectors.as_flattened().iter().map(|value| value.to_le_bytes()), target, accessor)
    }

    pub fn colours(&mut self, colours: &[Colour]) -> usize {
        let accessor = json!({"componentType": FLOAT, "count": colours.len(), "type": "VEC3"});
        let values = colours.iter().flat_map(|colour| colour.0.map(|value| value.clamp(0.0, 1.0)));
        self.push(values.map(f32::to_le_bytes), Target::Vertices, accessor)
    }
}
