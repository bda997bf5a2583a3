//! Messages that describe once what frames move: surfaces, links and balls, the inside of bodies, tools.

use souple_io::picture::{Colour, PATTERNS, Texture, TextureFigure};
use souple_math::Vec3;
use souple_mesh::Span;

use super::{Kind, header, put_f32, put_f64, put_u32, put_vector};

/// A surface as pages are told of it.
#[derive(Clone, Debug, Default)]
pub struct SurfaceShape<'a> {
    pub points: Vec<Vec3>,
    pub triangles: &'a [[u32; 3]],
    /// Of its elements.
    pub edges: &'a [[u32; 2]],
    /// When each triangle is there; none where all stay.
    pub spans: &'a [Span],
    /// When each edge is.
    pub edge_spans: &'a [Span],
}

/// Surface `index` of a scene, of bodies first, then of obstacles.
pub fn surface(scene: u32, index: u16, shape: &SurfaceShape) -> Vec<u8> {
    let SurfaceShape { points, triangles, edges, spans, edge_spans } = shape;
    let mut bytes = header(Kind::Surface, index, scene);
    let numbers = 12 * (points.len() + triangles.len()) + 8 * edges.len();
    bytes.reserve(20 + numbers + 16 * (spans.len() + edge_spans.len()));
    put_surface(&mut bytes, points, triangles);
    put_u32(&mut bytes, edges.len());
    bytes.extend_from_slice(bytemuck::cast_slice(edges));
    for spans in [spans, edge_spans] {
        put_u32(&mut bytes, spans.len());
        spans.iter().flat_map(|span| [span.from, span.until]).for_each(|date| put_f64(&mut bytes, date));
    }
    bytes
}

fn put_surface(bytes: &mut Vec<u8>, points: &[Vec3], triangles: &[[u32; 3]]) {
    put_u32(bytes, points.len());
    put_u32(bytes, triangles.len());
    points.iter().for_each(|point| put_vector(bytes, *point));
    bytes.extend_from_slice(bytemuck::cast_slice(triangles));
}

/// Links and radii of balls of body `index`.
pub fn network(scene: u32, index: u16, links: &[[u32; 2]], radii: &[f64]) -> Vec<u8> {
    let mut bytes = header(Kind::Network, index, scene);
    put_u32(&mut bytes, links.len());
    put_u32(&mut bytes, radii.len());
    bytes.extend_from_slice(bytemuck::cast_slice(links));
    radii.iter().for_each(|radius| put_f32(&mut bytes, *radius));
    bytes
}

/// The texture of body `index`: a picture, from its upper row, or the number of its pattern, from one, with its two colours.
pub fn texture(scene: u32, index: u16, texture: &Texture) -> Vec<u8> {
    let mut bytes = header(Kind::Texture, index, scene);
    let (figure, size, colours) = match &texture.figure {
        TextureFigure::Picture(image) => (0, [image.width, image.height], [Colour::BLACK; 2]),
        TextureFigure::Pattern(pattern, colours) => {
            let number = PATTERNS.entries.iter().position(|entry| entry.build == *pattern);
            (1 + number.unwrap_or(0), [0, 0], *colours)
        }
    };
    put_u32(&mut bytes, figure);
    put_f32(&mut bytes, texture.size);
    size.into_iter().for_each(|side| put_u32(&mut bytes, side));
    colours.iter().flat_map(|colour| colour.0).for_each(|part| put_f32(&mut bytes, part.into()));
    if let TextureFigure::Picture(image) = &texture.figure {
        bytes.extend(image.pixels.iter().flat_map(|[red, green, blue]| [*red, *green, *blue, 255]));
    }
    bytes
}

/// Tetrahedra and faces of the cells of body `index`, each followed by its cell, and when each cell goes [s]; no dates where all stay.
pub fn inside(
    scene: u32,
    index: u16,
    tetrahedra: &[([u32; 4], u32)],
    triangles: &[([u32; 3], u32)],
    dates: &[f64],
) -> Vec<u8> {
    let mut bytes = header(Kind::Inside, index, scene);
    put_u32(&mut bytes, tetrahedra.len());
    put_u32(&mut bytes, triangles.len());
    for (corners, cell) in tetrahedra {
        corners.iter().chain([cell]).for_each(|number| put_u32(&mut bytes, *number as usize));
    }
    for (corners, cell) in triangles {
        corners.iter().chain([cell]).for_each(|number| put_u32(&mut bytes, *number as usize));
    }
    put_u32(&mut bytes, dates.len());
    dates.iter().for_each(|date| put_f64(&mut bytes, *date));
    bytes
}

/// The surface of the tool in a hand of a page, about its own origin.
pub fn tool(scene: u32, [page, hand]: [u32; 2], points: &[Vec3], triangles: &[[u32; 3]]) -> Vec<u8> {
    let mut bytes = header(Kind::Tool, 0, scene);
    put_u32(&mut bytes, page as usize);
    put_u32(&mut bytes, hand as usize);
    put_surface(&mut bytes, points, triangles);
    bytes
}
