//! What goes over the wire: see `docs/protocol.md`.
//!
//! Documents and wishes are JSON in text messages; surfaces, frames and samples are little-endian numbers in binary ones.

mod frame;
mod samples;
mod shapes;
mod wish;

use std::sync::Arc;

use serde_json::{Value, json};

pub use frame::{Frame, FrameBody, FrameSkin, HandShown, Holds};
pub use samples::Samples;
pub use shapes::{SurfaceShape, inside, network, surface, texture, tool};
pub use wish::Wish;

use crate::hub::Outgoing;

macro_rules! version {
    () => {
        5
    };
}

/// Version of the documents and of binary messages.
pub const VERSION: u8 = version!();
/// Asked for and given in the handshake: pages of another version are told to load again.
pub const SUBPROTOCOL: &str = concat!("souple.v", version!());

/// Kinds of binary messages.
#[derive(Clone, Copy, Debug)]
pub enum Kind {
    Surface = 1,
    Frame = 2,
    Samples = 3,
    Network = 4,
    Inside = 5,
    Tool = 6,
    Texture = 7,
}

/// A document of a kind.
pub fn document(kind: &str, mut content: Value) -> Outgoing {
    content["kind"] = kind.into();
    Outgoing::Text(Arc::from(content.to_string()))
}

/// Says why a wish was not fulfilled; `about` is what was wished for.
pub fn refusal(about: &str, message: &str) -> Outgoing {
    document("refused", json!({"about": about, "message": message}))
}

/// The first words of a binary message.
fn header(kind: Kind, count: u16, scene: u32) -> Vec<u8> {
    let mut bytes = vec![kind as u8, VERSION];
    bytes.extend(count.to_le_bytes());
    bytes.extend(scene.to_le_bytes());
    bytes
}

fn put_u32(bytes: &mut Vec<u8>, number: usize) {
    // counts of what is on a screen
    bytes.extend((number as u32).to_le_bytes());
}

fn put_f32(bytes: &mut Vec<u8>, number: f64) {
    bytes.extend((number as f32).to_le_bytes());
}

fn put_f64(bytes: &mut Vec<u8>, number: f64) {
    bytes.extend(number.to_le_bytes());
}

fn put_vector(bytes: &mut Vec<u8>, vector: souple_math::Vec3) {
    vector.to_array().into_iter().for_each(|number| put_f32(bytes, number));
}
