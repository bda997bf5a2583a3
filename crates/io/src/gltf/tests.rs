//! What is in a file, read by the specification's own words.

use super::*;
use crate::testing::{mixed_mesh, surface_mesh};

/// The document and the numbers of a file whose lengths are as they must be.
fn opened(bytes: &[u8]) -> (Value, Vec<u8>) {
    let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
    assert_eq!((&bytes[..4], word(4), word(8)), (&b"glTF"[..], 2, bytes.len()));
    let text = word(12);
    assert_eq!((&bytes[16..20], text % 4), (&b"JSON"[..], 0));
    let numbers = 20 + text;
    assert_eq!((&bytes[numbers + 4..numbers + 8], word(numbers) % 4), (&b"BIN\0"[..], 0));
    assert_eq!(numbers + 8 + word(numbers), bytes.len());
    (serde_json::from_slice(&bytes[20..numbers]).unwrap(), bytes[numbers + 8..].to_vec())
}

/// Numbers of an accessor.
fn floats(document: &Value, numbers: &[u8], accessor: &Value) -> Vec<f32> {
    let accessor = &document["accessors"][accessor.as_u64().unwrap() as usize];
    let view = &document["bufferViews"][accessor["bufferView"].as_u64().unwrap() as usize];
    let at = view["byteOffset"].as_u64().unwrap() as usize;
    let length = view["byteLength"].as_u64().unwrap() as usize;
    let width = if accessor["type"] == "VEC3" { 3 } else { 1 };
    assert_eq!(accessor["count"].as_u64().unwrap() as usize * width * 4, length);
    numbers[at..at + length]
        .chunks_exact(4)
        .map(|four| f32::from_le_bytes(four.try_into().unwrap()))
        .collect()
}

fn swing() -> Animation {
    let mesh = surface_mesh();
    let triangles = SurfacePart::of(&Output::new(&mesh)).triangles().collect();
    let frame = |step: usize| mesh.points.iter().map(|p| *p + Vec3::Y * (0.5 * step as f64 * p.x)).collect();
    let surface = MovingSurface {
        name: "flag".into(),
        triangles,
        during: 0..4,
        frames: (0..4).map(frame).collect(),
        colour: Colour::WHITE,
        point_colours: Vec::new(),
    };
    Animation { surfaces: vec![surface], times: vec![1.0, 1.1, 1.2, 1.3], up: Vec3::Z }
}

/// At the time of each frame the weights add up its target, and rest plus target is the frame, to a part in 2²³.
#[test]
fn frames_come_back_from_targets_and_weights() {
    let animation = swing();
    let (document, numbers) = opened(&animation.to_glb().unwrap());
    let primitive = &document["meshes"][0]["primitives"][0];
    let rest = floats(&document, &numbers, &primitive["attributes"]["POSITION"]);
    let targets: Vec<Vec<f32>> = primitive["targets"]
        .as_array()
        .unwrap()
        .iter()
        .map(|target| floats(&document, &numbers, &target["POSITION"]))
        .collect();
    let sampler = &document["animations"][0]["samplers"][0];
    let times = floats(&document, &numbers, &sampler["input"]);
    let weights = floats(&document, &numbers, &sampler["output"]);
    assert!(
        times.iter().zip([0.0f32, 0.1, 0.2, 0.3]).all(|(a, b)| (a - b).abs() < 1e-6),
        "times count from zero"
    );
    assert_eq!(weights.len(), times.len() * targets.len());
    for (frame, positions) in animation.surfaces[0].frames.iter().enumerate() {
        for (index, expected) in positions.iter().flat_map(|p| p.to_array()).enumerate() {
            let moved: f32 = (0..3).map(|t| weights[3 * frame + t] * targets[t][index]).sum();
            assert!(
                (f64::from(rest[index] + moved) - expected).abs() < 2f64.powi(-22) * expected.abs().max(1.0)
            );
        }
    }
}

/// A surface that becomes another one: each is there, at its size, at its own times alone.
#[test]
fn surfaces_take_turns() {
    let mut animation = swing();
    let mut later = animation.surfaces[0].clone();
    later.triangles.pop();
    (later.during, later.frames) = (2..4, later.frames.split_off(2));
    animation.surfaces[0].during = 0..2;
    animation.surfaces[0].frames.truncate(2);
    animation.surfaces.push(later);
    let (document, numbers) = opened(&animation.to_glb().unwrap());
    let of = |node: u64, path: &str| {
        let animation = &document["animations"][0];
        let is_it = |channel: &&Value| channel["target"]["node"] == node && channel["target"]["path"] == path;
        let channel = animation["channels"].as_array().unwrap().iter().find(is_it).unwrap();
        let sampler = &animation["samplers"][channel["sampler"].as_u64().unwrap() as usize];
        let read = |what: &str| floats(&document, &numbers, &sampler[what]);
        (read("input"), read("output"), sampler["interpolation"].clone())
    };
    let close =
        |a: &[f32], b: &[f32]| a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-6);
    let (times, scales, how) = of(0, "scale");
    assert!(close(&times, &[0.0, 0.2]) && close(&scales, &[1.0, 1.0, 1.0, 0.0, 0.0, 0.0]) && how == "STEP");
    let (times, scales, _) = of(1, "scale");
    assert!(close(&times, &[0.0, 0.2]) && close(&scales, &[0.0, 0.0, 0.0, 1.0, 1.0, 1.0]));
    let (times, weights, _) = of(1, "weights");
    assert!(close(&times, &[0.2, 0.3]) && close(&weights, &[0.0, 1.0]));
    assert_eq!(document["nodes"][1]["scale"], json!([0.0, 0.0, 0.0]));
    assert!(document["nodes"][0].get("scale").is_none());
}

/// `up` becomes `y`: the quaternion turns it there.
#[test]
fn up_is_turned_to_y() {
    let turned = |[x, y, z, w]: [f64; 4], v: Vec3| {
        let axis = Vec3::new(x, y, z);
        let t = axis.cross(v) * 2.0;
        v + t * w + axis.cross(t)
    };
    for up in [Vec3::Z, Vec3::Y, -Vec3::Y, Vec3::new(1.0, -2.0, 0.5), -Vec3::X] {
        let unit = up.try_normalised().unwrap();
        assert!((turned(rotation_to_y(up), unit) - Vec3::Y).length() < 1e-12, "{up:?}");
    }
}

#[test]
fn a_mesh_is_written_as_its_surface() {
    let mut bytes = Vec::new();
    write_mesh(&Output::new(&mixed_mesh()), &mut bytes).unwrap();
    let (document, _) = opened(&bytes);
    assert!(document.get("animations").is_none());
    // a quadrilateral and a triangle
    assert_eq!(document["accessors"][0]["count"], 9);
}

/// Lengths are numbers of 4 bytes: what is longer is refused, by counts alone, which are those of the file.
#[test]
fn lengths_are_known_before() {
    for colours in [0, 6] {
        let mut animation = swing();
        animation.surfaces[0].point_colours = vec![Colour::BLACK; colours];
        let mut still = animation.surfaces[0].clone();
        still.frames.truncate(1);
        still.during = 1..2;
        animation.surfaces.push(still);
        let (document, _) = opened(&animation.to_glb().unwrap());
        assert_eq!(document["buffers"][0]["byteLength"], animation.number_bytes());
    }
    assert_eq!(length(u64::from(u32::MAX)).unwrap(), u32::MAX);
    let error = length(1 << 32).unwrap_err().to_string();
    assert!(
        error.starts_with("the number of bytes of the .glb file is 4294967296; expected less than 2^32"),
        "{error}"
    );
}

#[test]
fn faulty_animations_are_refused() {
    let refused = |change: fn(&mut Animation), words: &str| {
        let mut animation = swing();
        change(&mut animation);
        let message = animation.to_glb().unwrap_err().to_string();
        assert!(message.contains(words), "{message}");
    };
    refused(|a| a.times[2] = 1.1, "the time of a frame is 1.1; expected more than 1.1");
    // a millisecond after nine hours is nothing to a number of 4 bytes, whose steps are 2⁻⁸ s there
    refused(
        |a| a.times = vec![0.0, 1.0, 32768.0, 32768.001],
        "the time of a frame is 32768.001 s, 32768.0 s from the start",
    );
    refused(|a| a.times.clear(), "the number of frames is 0");
    refused(|a| a.surfaces.clear(), "the number of surfaces is 0");
    refused(|a| a.surfaces[0].triangles[0] = [0, 1, 99], "a corner of surfaces[0] is 99");
    refused(|a| a.surfaces[0].triangles.clear(), "the number of triangles");
    refused(|a| a.surfaces[0].frames.truncate(3), "the number of frames of surfaces[0] is 3");
    refused(
        |a| a.surfaces[0].during = 2..2,
        "the range of times of surfaces[0] is 2..2; expected a part of 0..4",
    );
    refused(|a| a.surfaces[0].during = 1..5, "the range of times of surfaces[0] is 1..5");
    refused(|a| a.surfaces[0].frames[1].truncate(5), "expected 6, as of the first frame");
    refused(|a| a.surfaces[0].frames[1][0].x = f64::NAN, "a position of surfaces[0] is [NaN");
    refused(|a| a.surfaces[0].point_colours.push(Colour::BLACK), "one for each point");
}
