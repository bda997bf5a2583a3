//! The message that describes a surface once: its triangles, and where its points rest.

use souple_math::Vec3;

use super::{Kind, header, put_u32, put_vector};

/// Surface `index` of a scene: of bodies first, then of obstacles.
pub fn surface(scene: u32, index: u16, points: &[Vec3], triangles: &[[u32; 3]]) -> Vec<u8> {
    let mut bytes = header(Kind::Surface, index, scene);
    bytes.reserve(8 + 12 * (points.len() + triangles.len()));
    put_u32(&mut bytes, points.len());
    put_u32(&mut bytes, triangles.len());
    points.iter().for_each(|point| put_vector(&mut bytes, *point));
    bytes.extend_from_slice(bytemuck::cast_slice(triangles));
    bytes
}
