//! How often a surface winds around what lies before its triangles.

use super::diagnose::components;
use crate::TriangleSurface;
use crate::winding::WindingNumber;

/// Places on triangles at which it is asked how often the surface winds around what lies before them, at least.
const SAMPLES: usize = 256;
/// Triangles of each part at which it is asked, and parts of which it is asked, the first of them.
const OF_EACH_PART: usize = 8;
const MOST_PARTS: usize = 512;
/// So far before a triangle, in its size and in that of the surface: parts that are farther apart are apart.
const BEFORE: [f64; 2] = [1e-3, 1e-6];
/// A place on a triangle is as much nearer to its middle than to the edges: before an edge that is concave other triangles are.
const INWARD: f64 = 0.9;

/// Whether what lies before its triangles is outside of all of it, by some places on each part: parts within each other that face the
/// same way, and parts that overlap where no triangles cross, have normals that tell nothing.
pub(super) fn winds_once(surface: &TriangleSurface) -> bool {
    let winding = WindingNumber::new(surface);
    let most = BEFORE[1] * surface.bounds().diagonal();
    let outside = |triangle: usize, place: usize| {
        let [a, b, c] = surface.corners(triangle as u32);
        let normal = (b - a).cross(c - a);
        let size = normal.length().sqrt();
        let offset = normal * ((BEFORE[0] * size).min(most) / (size * size));
        let [u, v] = spread(place).map(|part| INWARD * part + (1.0 - INWARD) / 3.0);
        winding.at(a + (b - a) * u + (c - a) * v + offset).round()
    };
    let first = outside(0, 0);
    let count = surface.triangles.len();
    let places = SAMPLES.div_ceil(count);
    let (part_of, part_count) = components(surface);
    let mut of_parts = vec![0; part_count.min(MOST_PARTS)];
    let first_of_parts = part_of.iter().enumerate().filter(|(_, part)| {
        let looks = of_parts.get_mut(**part as usize);
        looks.is_some_and(|looks| {
            *looks += 1;
            *looks <= OF_EACH_PART
        })
    });
    let first_of_parts: Vec<usize> = first_of_parts.map(|(triangle, _)| triangle).collect();
    let spread_out = (0..count).step_by(count.div_ceil(SAMPLES));
    let triangles = spread_out.chain(first_of_parts);
    let mut looked_at = triangles.flat_map(|triangle| (0..places).map(move |k| (triangle, k)));
    // a surface that faces inward has the outside behind it
    (first == 0.0 || first == -1.0) && looked_at.all(|(triangle, place)| outside(triangle, place) == first)
}

/// Places on a triangle, as parts of two of its sides: the first is its middle, each of the others far from those before
/// (Roberts 2018, by multiples of powers of the plastic number).
fn spread(place: usize) -> [f64; 2] {
    let [u, v] = [0.754_877_666_246_692_7, 0.569_840_290_998_053_3]
        .map(|part| (1.0 / 3.0 + part * place as f64).fract());
    if u + v > 1.0 { [1.0 - u, 1.0 - v] } else { [u, v] }
}
